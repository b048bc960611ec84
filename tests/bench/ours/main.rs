//! Our own times, for `tests/bench/run.py`: proofs by the zero test, products and divisors of polynomials.

mod identity;
mod polynomial;
mod protocol;

use std::process::ExitCode;

use protocol::JobOptions;
use serde_json::Value;

fn main() -> ExitCode {
    protocol::serve(|job: &Value, how: &JobOptions| match job["kind"].as_str() {
        Some("model") => identity::derivation(job),
        Some("zero") => identity::proof(job, how.alone),
        Some("product") => polynomial::product(job),
        Some("gcd") => polynomial::gcd(job),
        Some("power") => polynomial::power(job),
        Some("square_free") => polynomial::square_free(job),
        _ => Err("an unknown kind of job".to_owned()),
    })
}

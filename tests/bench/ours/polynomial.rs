//! Jobs about polynomials: products with a known number of terms, and known divisors.

use pebo_gen::cas::integer::Integer;
use pebo_gen::cas::poly::{Monomial, Poly, TooLarge, Work as Limit};
use serde_json::Value;

use crate::protocol::{Work, number, terms};

/// A product, checked by its number of terms and the sum of its coefficients.
pub(crate) fn product(job: &Value) -> Result<Work, String> {
    let (a, b) = if job["base"].is_array() {
        let power = u32::try_from(number(job, "power")?).map_err(|error| error.to_string())?;
        let a = poly(job, "base")?.pow(power, &Limit::new(u64::MAX)).map_err(too_large)?;
        let b = &a + &Poly::one();
        (a, b)
    } else {
        (poly(job, "a")?, poly(job, "b")?)
    };
    let (count, sum) = (number(job, "terms")?, job["sum"].as_str().and_then(Integer::from_digits));
    Ok(Box::new(move || {
        let product = a.mul(&b, &Limit::new(u64::MAX));
        Box::new(move || {
            let product = product.map_err(too_large)?;
            let mut total = Integer::ZERO;
            for (_, coefficient) in product.terms() {
                total += coefficient;
            }
            let right = u64::try_from(product.term_count()) == Ok(count) && Some(total) == sum;
            if right { Ok(()) } else { Err("WRONG".to_owned()) }
        })
    }))
}

/// A greatest common divisor, which is known up to its sign.
pub(crate) fn gcd(job: &Value) -> Result<Work, String> {
    let (a, b, known) = (poly(job, "a")?, poly(job, "b")?, poly(job, "gcd")?);
    Ok(Box::new(move || {
        let found = a.gcd(&b, &Limit::new(u64::MAX));
        Box::new(move || {
            let found = found.map_err(too_large)?;
            if found == known || found == -&known { Ok(()) } else { Err("WRONG".to_owned()) }
        })
    }))
}

fn poly(job: &Value, key: &str) -> Result<Poly, String> {
    let term = |(coefficient, exponents): (i64, Vec<u32>)| (Monomial::new((0..).zip(exponents)), coefficient.into());
    Poly::from_terms(terms(job, key).into_iter().map(term)).map_err(too_large)
}

fn too_large(error: TooLarge) -> String {
    error.to_string()
}

//! The host's part. `host` prints the results that the board must print too; `host errors` prints them in plain numbers.

use pebo_firmware::host::Words;
use pebo_firmware::report::Report;
use pebo_firmware::{converter, motor};
use pebo_runtime::Fault;
use pebo_runtime::nalgebra::Vector2;

/// Writes estimates with their errors.
struct Numbers;

impl Report for Numbers {
    fn write(&mut self, text: &str) {
        print!("{text}");
    }

    fn estimate(&mut self, estimate: &Vector2<f32>, truth: &Vector2<f32>) {
        let error = estimate - truth;
        println!("  {:12.6} {:12.6}   error {:10.2e} {:10.2e}", estimate.x, estimate.y, error.x, error.y);
    }
}

fn results(report: &mut impl Report) -> Result<(), Fault> {
    converter::all(report)?;
    motor::run(report)
}

fn main() -> Result<(), Fault> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    match arguments.iter().map(String::as_str).collect::<Vec<_>>().as_slice() {
        [] => results(&mut Words),
        ["errors"] => results(&mut Numbers),
        _ => {
            eprintln!("usage: host [errors]");
            std::process::exit(2);
        }
    }
}

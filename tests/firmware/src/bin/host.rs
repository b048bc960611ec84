//! The host's part. `host` prints the results that the board must print too; `host errors` prints them in plain
//! numbers;
//! `host count emitted` and `host count hand` run rounds of steps for an instruction counter.

use pebo_firmware::by_hand::ByHand;
use pebo_firmware::report::Report;
use pebo_firmware::steps::{WARM_UP, agree, emitted_round, hand_round, samples};
use pebo_firmware::{converter, motor};
use pebo_runtime::Fault;
use pebo_runtime::nalgebra::Vector2;

/// Writes results as the board does.
struct Words;

impl Report for Words {
    fn write(&mut self, text: &str) {
        print!("{text}");
    }
}

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
    motor::run(report)?;
    report.name("by hand");
    report.flag(agree()?);
    Ok(())
}

fn main() -> Result<(), Fault> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    match arguments.iter().map(String::as_str).collect::<Vec<_>>().as_slice() {
        [] => results(&mut Words),
        ["errors"] => results(&mut Numbers),
        ["count", which] => {
            let samples = std::hint::black_box(samples());
            let (mut emitted, mut hand) = (converter::counted()?, ByHand::new());
            for _ in 0..=WARM_UP {
                let good = match *which {
                    "emitted" => emitted_round(&mut emitted, &samples),
                    _ => hand_round(&mut hand, &samples),
                };
                assert!(good, "a step of the round was refused");
            }
            Ok(())
        }
        _ => {
            eprintln!("usage: host [errors | count emitted | count hand]");
            std::process::exit(2);
        }
    }
}

//! The program: the library's command line with the arguments of the process.

use std::process::ExitCode;

fn main() -> ExitCode {
    ExitCode::from(pebo_gen::cli::run(std::env::args_os()) as u8)
}

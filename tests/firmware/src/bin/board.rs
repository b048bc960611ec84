//! The board's part: prints the results by semihosting.
#![no_std]
#![no_main]

use cortex_m_rt::entry;
use pebo_firmware::{board, converter, motor};

#[entry]
fn main() -> ! {
    board::run(|report| {
        converter::all(report)?;
        motor::run(report)
    })
}

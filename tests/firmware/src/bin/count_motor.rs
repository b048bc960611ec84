//! Counts the steps of the motor's observers: an image of its own, as in firmware. On the host, `count_motor` compares them
//! as the board does, and `count_motor emitted` and `count_motor hand` run them for an instruction counter.
#![cfg_attr(feature = "board", no_std)]
#![cfg_attr(feature = "board", no_main)]

use pebo_firmware::counted::motor::Motor;

#[cfg(feature = "board")]
#[cortex_m_rt::entry]
fn main() -> ! {
    pebo_firmware::board::run(pebo_firmware::board::count::<Motor>)
}

#[cfg(not(feature = "board"))]
fn main() -> Result<(), pebo_runtime::Fault> {
    pebo_firmware::host::count::<Motor>()
}

//! Counts the steps of the arm's observers: an image of its own, as in firmware. On the host, `count_arm` compares them
//! as the board does, and `count_arm emitted` and `count_arm hand` run them for an instruction counter.
#![cfg_attr(feature = "board", no_std)]
#![cfg_attr(feature = "board", no_main)]

use pebo_firmware::counted::arm::Arm;

#[cfg(feature = "board")]
#[cortex_m_rt::entry]
fn main() -> ! {
    pebo_firmware::board::run(pebo_firmware::board::count::<Arm>)
}

#[cfg(not(feature = "board"))]
fn main() -> Result<(), pebo_runtime::Fault> {
    pebo_firmware::host::count::<Arm>()
}

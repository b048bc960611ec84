//! Counts the steps of the converter's observers: an image of its own, as in firmware. On the host, `count_cuk` compares them
//! as the board does, and `count_cuk emitted` and `count_cuk hand` run them for an instruction counter.
#![cfg_attr(feature = "board", no_std)]
#![cfg_attr(feature = "board", no_main)]

use pebo_firmware::counted::cuk::Cuk;

#[cfg(feature = "board")]
#[cortex_m_rt::entry]
fn main() -> ! {
    pebo_firmware::board::run(pebo_firmware::board::count::<Cuk>)
}

#[cfg(not(feature = "board"))]
fn main() -> Result<(), pebo_runtime::Fault> {
    pebo_firmware::host::count::<Cuk>()
}

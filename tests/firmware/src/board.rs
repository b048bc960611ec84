//! Common code of the programs for the board: they print by semihosting, and count in ticks of its clock.

use core::panic::PanicInfo;

use cortex_m::peripheral::SYST;
use cortex_m::peripheral::syst::SystClkSource;
use cortex_m_semihosting::debug;
use cortex_m_semihosting::hio::{HostStream, hstdout};
use pebo_runtime::Fault;

use crate::counted::{Plant, WARM_UP, compare, emitted_round, hand_round, samples};
use crate::report::Report;

/// Required by the language; `run` checks that nothing in an image calls it.
#[panic_handler]
fn panic(_: &PanicInfo) -> ! {
    loop {
        debug::exit(debug::EXIT_FAILURE);
    }
}

/// The host's standard output.
pub struct Semihosting(HostStream);

impl Report for Semihosting {
    fn write(&mut self, text: &str) {
        // Output that is lost fails the comparison on the host.
        let _ = self.0.write_all(text.as_bytes());
    }
}

/// The ticks that something takes: under `-icount shift=6` an instruction is 64 ns and a tick of the AN386's SysTick 40
/// ns.
#[inline(never)]
fn ticks(work: impl FnOnce() -> bool) -> Option<u32> {
    let before = SYST::get_current();
    let good = work();
    let after = SYST::get_current();
    good.then_some(before.wrapping_sub(after) & 0x00ff_ffff)
}

/// Compares both observers of a plant, then counts a round of steps of each.
///
/// # Errors
/// A fault where none should be.
pub fn count<P: Plant>(report: &mut Semihosting) -> Result<(), Fault> {
    compare::<P>(report)?;
    let samples = core::hint::black_box(samples::<P>());
    let (mut emitted, mut hand) = P::observers()?;
    for _ in 0..WARM_UP {
        if !emitted_round::<P>(&mut emitted, &samples) || !hand_round::<P>(&mut hand, &samples) {
            return Err(Fault::Estimate);
        }
    }
    let counts = [
        ("ticks nothing ", ticks(|| true)),
        ("ticks emitted ", ticks(|| emitted_round::<P>(&mut emitted, &samples))),
        ("ticks hand ", ticks(|| hand_round::<P>(&mut hand, &samples))),
    ];
    for (name, count) in counts {
        report.write(name);
        report.word(count.ok_or(Fault::Estimate)?);
        report.write("\n");
    }
    Ok(())
}

/// Starts the clock, runs a program, and leaves the emulator with its result.
pub fn run(program: impl FnOnce(&mut Semihosting) -> Result<(), Fault>) -> ! {
    let good = cortex_m::Peripherals::take().zip(hstdout().ok()).is_some_and(|(mut peripherals, stream)| {
        let clock = &mut peripherals.SYST;
        clock.set_clock_source(SystClkSource::Core);
        clock.set_reload(0x00ff_ffff);
        clock.clear_current();
        clock.enable_counter();
        program(&mut Semihosting(stream)) == Ok(())
    });
    loop {
        debug::exit(if good { debug::EXIT_SUCCESS } else { debug::EXIT_FAILURE });
    }
}

//! The board's part: prints the results by semihosting, then how many SysTick ticks a round of steps takes.
#![no_std]
#![no_main]

use core::panic::PanicInfo;

use cortex_m::peripheral::SYST;
use cortex_m::peripheral::syst::SystClkSource;
use cortex_m_rt::entry;
use cortex_m_semihosting::debug;
use cortex_m_semihosting::hio::{HostStream, hstdout};
use pebo_firmware::by_hand::ByHand;
use pebo_firmware::report::Report;
use pebo_firmware::steps::{WARM_UP, agree, emitted_round, hand_round, samples};
use pebo_firmware::{converter, motor};
use pebo_runtime::Fault;

/// Required by the language; `run` checks that nothing in the image calls it.
#[panic_handler]
fn panic(_: &PanicInfo) -> ! {
    loop {
        debug::exit(debug::EXIT_FAILURE);
    }
}

/// The host's standard output.
struct Semihosting(HostStream);

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

fn run(report: &mut Semihosting) -> Result<bool, Fault> {
    converter::all(report)?;
    motor::run(report)?;
    report.name("by hand");
    report.flag(agree()?);

    let samples = core::hint::black_box(samples());
    let (mut emitted, mut hand) = (converter::counted()?, ByHand::new());
    for _ in 0..WARM_UP {
        if !emitted_round(&mut emitted, &samples) || !hand_round(&mut hand, &samples) {
            return Ok(false);
        }
    }
    let counts = [
        ("ticks nothing ", ticks(|| true)),
        ("ticks emitted ", ticks(|| emitted_round(&mut emitted, &samples))),
        ("ticks hand ", ticks(|| hand_round(&mut hand, &samples))),
    ];
    for (name, count) in counts {
        let Some(count) = count else { return Ok(false) };
        report.write(name);
        report.word(count);
        report.write("\n");
    }
    Ok(true)
}

#[entry]
fn main() -> ! {
    let good = cortex_m::Peripherals::take().zip(hstdout().ok()).is_some_and(|(mut peripherals, stream)| {
        let clock = &mut peripherals.SYST;
        clock.set_clock_source(SystClkSource::Core);
        clock.set_reload(0x00ff_ffff);
        clock.clear_current();
        clock.enable_counter();
        run(&mut Semihosting(stream)) == Ok(true)
    });
    loop {
        debug::exit(if good { debug::EXIT_SUCCESS } else { debug::EXIT_FAILURE });
    }
}

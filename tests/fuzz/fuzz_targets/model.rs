//! Any text as a model file: read, resolved, derived, emitted, typeset and reported without a panic.
#![no_main]

use libfuzzer_sys::fuzz_target;
use pebo_gen::emit::Scalar;
use pebo_gen::source::{Colour, Source, render};
use pebo_gen::{Request, Standing, answer};

fuzz_target!(|bytes: &[u8]| {
    let Ok(source) = Source::from_bytes("fuzz", bytes.to_vec()) else { return };
    let answer = answer(&source, &Request::new().emit(Scalar::F32).mathml());
    assert!(answer.standing == Standing::Accepted || !answer.diagnostics.is_empty());
    let _ = answer.report.line();
    let _ = render(&answer.diagnostics, &source, Colour::Never);
});

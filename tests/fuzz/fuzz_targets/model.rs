//! Any text as a model file: read, resolved, derived and reported without a panic.
#![no_main]

use libfuzzer_sys::fuzz_target;
use pebo_gen::source::{Colour, Source, render};
use pebo_gen::{derive, report};

fuzz_target!(|bytes: &[u8]| {
    let Ok(source) = Source::from_bytes("fuzz", bytes.to_vec()) else { return };
    match derive(&source) {
        Ok(derived) => {
            let _ = report::check(&derived.plant, &derived.derivation, &source);
            let _ = report::summary(&derived.plant, &derived.derivation);
            let _ = render(&derived.derivation.diagnostics, &source, Colour::Never);
        }
        Err(diagnostics) => {
            assert!(!diagnostics.is_empty());
            let _ = render(&diagnostics, &source, Colour::Never);
        }
    }
});

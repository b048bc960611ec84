//! The start of a simulation among the values that satisfy identities.

use super::derive;
use crate::source::Code;

/// An identity that drawn values do not satisfy within the assumption.
fn far(start: &str) -> String {
    format!(
        "parameters: {{k: 2}}\nx: [a, b]\ny: [c]\nf_x: {{a: 0, b: 0}}\nf_y: {{c: 0}}\nidentities: [a*b - c]\n\
         assume: [c > 1000000]\nphi: [a, b]\nsimulation: {{initial: {{{start}}}}}"
    )
}

#[test]
fn a_start_shows_that_identities_have_a_point() {
    let is_open = |start: &str| {
        let (_, derivation) = derive(&far(start));
        derivation.diagnostics.iter().any(|diagnostic| diagnostic.code == Code::IdentityUndecided)
    };
    assert!(is_open("") && is_open("a: 1, b: 2, c: 2"));
    assert!(!is_open("a: 1000*k, b: 1000, c: 2e6"));
    // What the identity gives need not be written, nor be rational.
    assert!(!is_open("a: 1000*exp(k), b: 1000"));
}

#[test]
fn the_start_has_the_values_of_outputs() {
    let lines =
        "x: [a, b]\ny: [c]\nf_x: {a: b, b: 0}\ng_y: {c: a*b}\nphi: [a, b]\nsimulation: {initial: {a: 0.5, b: 3}}";
    let (plant, _) = derive(lines);
    let arena = &plant.arena;
    let value = |name: &str| plant.start.get(&arena.symbol(name)).map(|value| arena.print(*value));
    assert_eq!(["a", "b", "c"].map(value), ["1/2", "3", "3/2"].map(|text| Some(text.to_owned())));
}

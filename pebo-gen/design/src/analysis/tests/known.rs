//! Starts that are known: what they identify that the outputs do not.

use super::{codes, derive};
use crate::analysis::{Excitation, Outcome};
use crate::source::Code;

/// The verdict, and the positions of the unknowns that the start fixes.
fn decided(lines: &str) -> (Outcome, Vec<usize>) {
    let (_, derivation) = derive(lines);
    (derivation.outcome, derivation.identifiability.result.map(|result| result.by_start).unwrap_or_default())
}

const CART: &str = "parameters: {m: 2, b: 0.5}\nx: [p, d]\ny: [v]\nu: [F]\nassume: [m > 0, b > 0]\n\
                    f_x: {p: v, d: 0}\nf_y: {v: (F - b*v + d)/m}";

#[test]
fn a_state_that_no_output_shows_is_known_by_its_start() {
    assert_eq!(decided(&format!("{CART}\nphi: [p, d]")).0, Outcome::Rejected);
    assert_eq!(decided(&format!("{CART}\nphi: [p, d]\nknown: {{p: 1}}")), (Outcome::Accepted, vec![0]));
    // A component of both is not fixed by one of them; what the outputs show needs no start.
    let (_, mixed) = derive(&format!("{CART}\nphi: [p + d, d]\nknown: {{p: 1}}"));
    assert_eq!((mixed.outcome, codes(&mixed)), (Outcome::Rejected, vec![Code::NeverIdentifiable]));
    assert_eq!(decided(&format!("{CART}\nphi: [p + d, d]\nknown: {{p: 1, d: 0}}")), (Outcome::Accepted, vec![0]));
    assert_eq!(decided(&format!("{CART}\nphi: [p, d]\nknown: {{d: 0}}")).0, Outcome::Rejected);
}

#[test]
fn outputs_that_show_a_state_are_used_where_its_start_is_known_too() {
    let shown = "x: [p]\ny: [q]\nu: [v]\nf_x: {p: v}\nf_y: {q: p}\nphi: [p]\nknown: {p: 0}";
    assert_eq!(decided(shown), (Outcome::Accepted, Vec::new()));
}

#[test]
fn a_regression_without_unknowns_needs_no_output() {
    let odometry = "x: [a, b]\ny: [q]\nu: [v, w]\nf_x: {a: v*cos(q), b: v*sin(q)}\nf_y: {q: w}\nphi: [a, b]";
    assert_eq!(decided(&format!("{odometry}\nknown: {{a: 0, b: 0}}")), (Outcome::Accepted, vec![0, 1]));
    assert_eq!(decided(&format!("{odometry}\nknown: {{a: 0}}")).0, Outcome::Rejected);
}

#[test]
fn components_that_feed_one_another_are_known_together() {
    // h' = v, v' = T k - g, k = 1/m by the accelerometer.
    let rocket = "parameters: {g: 9.81}\nx: [h, v, k]\ny: [a]\nu: [T]\nf_x: {h: v, v: T*k - g, k: 0}\ng_y: {a: T*k}\n\
                  phi: [k, h, v]";
    assert_eq!(decided(&format!("{rocket}\nknown: {{h: 0, v: 0}}")), (Outcome::Accepted, vec![1, 2]));
    // Of two that nothing shows, both have to be known.
    assert_eq!(decided(&format!("{rocket}\nknown: {{h: 0}}")).0, Outcome::Rejected);
}

#[test]
fn a_start_at_which_nothing_is_shown_identifies_nothing() {
    // a*b shows nothing of b where a is zero at the start, and remains so.
    let product = "x: [a, b, p]\ny: [s]\nu: [v]\nf_x: {a: 0, b: 0, p: v}\nf_y: {s: a*b*v + a}\nphi: [a, b, p]";
    let (_, derivation) = derive(&format!("{product}\nknown: {{a: 0, p: 0}}"));
    assert_ne!(derivation.outcome, Outcome::Accepted, "{derivation:?}");
    // A proof that needs a condition is worth nothing where the start violates it.
    let quotient = "x: [a, b]\ny: [s]\nu: [v]\nf_x: {a: 0, b: 0}\nf_y: {s: a*b*v}\nphi: [a, a*b]";
    let (_, at_zero) = derive(&format!("{quotient}\nknown: {{a: 0}}"));
    assert_eq!((at_zero.outcome, codes(&at_zero)), (Outcome::Undecided, vec![Code::LeftInverseUndecided]));
    assert_eq!(decided(&format!("{quotient}\nknown: {{a: 2}}")), (Outcome::Accepted, vec![0]));
}

#[test]
fn what_the_start_does_not_fix_has_exceptions_of_its_own() {
    let scaled = "x: [p, d]\ny: [v]\nu: [F]\nf_x: {p: v, d: 0}\nf_y: {v: F*d}\nphi: [p, d]\nknown: {p: 0}";
    let (_, derivation) = derive(scaled);
    let identified = derivation.identifiability.result.expect("accepted");
    assert_eq!((identified.kind, identified.singular_where), (Excitation::Instant, vec!["F = 0".to_owned()]));
}

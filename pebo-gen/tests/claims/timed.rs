//! Plants whose formulas hold the time: it is known, and of all that is known from outside it alone has a rate.

use pebo_gen::source::Code;

use super::table::Answer::{Accepted, Rejected};
use super::table::Row;

pub(super) const TIMED: &[Row] = &[
    (
        "a wave of known frequency with unknown amplitude and phase",
        "x: [p, s]\ny: [q]\nf_x: {p: 0, s: 0}\nf_y: {q: p*sin(t) + s*cos(t)}\nphi: [p, s]",
        Accepted("dynamic linear excitation"),
    ),
    (
        "an oscillator seen by a multiplier that turns with it: only one amplitude passes",
        "parameters: {w: 3}\nx: [p, s]\ny: [q]\nf_x: {p: -w*s, s: w*p}\nf_y: {q: p*cos(w*t) + s*sin(w*t)}\nphi: [p, s]",
        Rejected(Code::NeverIdentifiable),
    ),
    (
        "the same with a multiplier that turns at another speed",
        "parameters: {w: 3}\nx: [p, s]\ny: [q]\nf_x: {p: -w*s, s: w*p}\nf_y: {q: p*cos(t) + s*sin(t)}\nphi: [p, s]",
        Accepted("gpebo dynamic linear excitation"),
    ),
    (
        "a rate that grows as the state that it adds to falls",
        "x: [p, s]\ny: [q]\nassume: [t > 0]\nf_x: {p: p/t, s: 0}\nf_y: {q: p + s*t}\nphi: [p, s]",
        Rejected(Code::NeverIdentifiable),
    ),
    (
        "the same of an input, which may vary otherwise",
        "x: [p, s]\ny: [q]\nu: [v]\nassume: [v > 0]\nf_x: {p: p/v, s: 0}\nf_y: {q: p + s*v}\nphi: [p, s]",
        Accepted("gpebo dynamic linear excitation"),
    ),
    (
        "an output by its value whose derivative along the plant vanishes",
        "x: [p, s]\ny: [q]\nf_x: {p: -sin(t)*s, s: 0}\ng_y: {q: p - s*cos(t)}\nphi: [p, s]",
        Rejected(Code::NeverIdentifiable),
    ),
    (
        "an output by its value with the time in it has a rate",
        "x: [p, s]\ny: [q]\nf_x: {p: s, s: 0}\ng_y: {q: s*t + p}\nphi: [p + q, s]",
        Accepted("gpebo static linear excitation"),
    ),
    (
        "an identity that the time leaves behind",
        "x: [p, s]\ny: [q]\nidentities: [p - s*t]\nf_x: {p: 2*s, s: 0}\nf_y: {q: p}\nphi: [p, s]",
        Rejected(Code::IdentityRefuted),
    ),
    (
        "an identity that holds as the time goes on",
        "x: [p, s]\ny: [q]\nassume: [t > 0]\nidentities: [p - s*t]\nf_x: {p: s, s: 0}\nf_y: {q: p}\nphi: [p, s]",
        Accepted("gpebo dynamic linear excitation"),
    ),
];

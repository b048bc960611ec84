//! Rates with the unknown in a denominator, and others without a linear form: accepted ones, and ones that are not
//! refuted.

use pebo_gen::source::Code;

use super::table::Answer::{Accepted, Undecided};
use super::table::Row;

pub(super) const IMPLICIT: &[Row] = &[
    // With exp(2 z) + 1 and 1 + z^2 for multipliers they are linear in functions of theta under the derivative, a form
    // that is not sought; refuted they are not.
    ("tanh", "x: [x]\ny: [y]\nu: [u]\nf_x: {x: u}\nf_y: {y: tanh(x)}\nphi: [x]", Undecided(Code::RegressionUndecided)),
    (
        "rational",
        "x: [x]\ny: [y]\nu: [u]\nf_x: {x: u}\nf_y: {y: 1/(1 + x^2)}\nphi: [x]",
        Undecided(Code::RegressionUndecided),
    ),
    (
        "rational, its square beside it",
        "x: [x]\ny: [y]\nu: [u]\nf_x: {x: u}\nf_y: {y: 1/(1 + x^2)}\nphi: [x, x^2]",
        Accepted("gpebo implicit linear excitation"),
    ),
    (
        "what is known below stays there",
        "x: [x]\ny: [l, y]\nu: [u]\nassume: [l > 0, x > 0]\nf_x: {x: u}\nf_y: {l: u, y: (u - y)/(l*(2 + x))}\nphi: [x]",
        Accepted("implicit linear instant"),
    ),
    (
        "another output in what multiplies the rate",
        "x: [x]\ny: [y, q]\nu: [u]\nassume: [x > 0, y > 0, q > 0]\nf_x: {x: 0}\nf_y: {y: u/(q + y*x), q: 1}\nphi: [x]",
        Accepted("implicit linear instant"),
    ),
    (
        "two rates with one unknown below, of which one has the form",
        "parameters: {F: 10}\nx: [m, k]\ny: [s, q]\nu: [d]\nassume: [s > 0, q > 0, k > 0, m > 0]\nf_x: {m: 0, k: 0}\n\
         f_y: {s: d*(F - s) - 2*m*s*q/(k + s), q: m*s*q/(k + s) - d*q}\nphi: [m, k]",
        Accepted("implicit linear excitation"),
    ),
    (
        "a cosine of the sum of two unknown angles, which has four summands at z = chi + theta",
        "x: [p, s]\ny: [q, r]\nu: [v, w]\nf_x: {p: v, s: w}\nf_y: {q: cos(p + s), r: s}\nphi: [p, s]\n\
         angles: {p: 2*pi, s: 2*pi}",
        Accepted("dynamic over-parameterised excitation"),
    ),
    (
        "a function of a constant",
        "x: [x]\ny: [y]\nu: [u]\nassume: [x > 0]\nf_x: {x: 0}\nf_y: {y: u*sqrt(x)}\nphi: [x]",
        Undecided(Code::RegressionUndecided),
    ),
    (
        "a rate without a usable form beside one that tells all",
        "x: [x]\ny: [y, q]\nu: [u]\nf_x: {x: u}\nf_y: {y: x, q: exp(-x^2)}\nphi: [x]",
        Accepted("dynamic linear instant"),
    ),
    (
        "a rate without a usable form beside one in functions of theta",
        "x: [x]\ny: [y, q]\nu: [u]\nf_x: {x: u}\nf_y: {y: x^2 + x, q: exp(sin(x))}\nphi: [x]",
        Accepted("dynamic over-parameterised excitation"),
    ),
    (
        "a light sensor on a unicycle",
        "x: [a]\ny: [p, q, s]\nu: [v, w]\nangles: {a: 2*pi}\nassume: [v > 0]\nf_x: {a: w}\n\
         f_y: {p: v*cos(a), q: v*sin(a), s: exp(cos(a)) - s}\nphi: [a]",
        Accepted("dynamic over-parameterised instant"),
    ),
];

//! Non-smooth formulas: unknowns identifiable at a point are so in its cell of the domain, and the unknowns of two
//! cells combine only on a trajectory that passes from one into the other.

use pebo_gen::source::Code;

use super::table::Answer::{Accepted, Rejected, Undecided};
use super::table::Row;

pub(super) const NON_SMOOTH: &[Row] = &[
    (
        "Coulomb friction and a load, told apart once the speed has had both signs",
        "x: [f, l]\ny: [w]\nu: [u]\nf_x: {f: 0, l: 0}\nf_y: {w: u - f*sign(w) - l}\nphi: [f, l]",
        Accepted("dynamic linear excitation"),
    ),
    (
        "a dead zone",
        "x: [x]\ny: [y]\nu: [u]\nf_x: {x: u}\nf_y: {y: x*(y - sat(y))}\nphi: [x]",
        Accepted("dynamic linear excitation"),
    ),
    (
        "a dead zone that the assumptions leave behind",
        "x: [x]\ny: [y]\nu: [u]\nassume: [y > 1]\nf_x: {x: u}\nf_y: {y: x*(y - sat(y))}\nphi: [x]",
        Accepted("dynamic linear instant"),
    ),
    (
        "a regressor of which each side shows one unknown, where no motion changes the side",
        "x: [a, b]\ny: [q, r]\nu: [u]\nf_x: {a: u, b: u*q}\nf_y: {q: a*(q - abs(q)), r: b*(q + abs(q))}\nphi: [a, b]",
        Undecided(Code::IdentifiabilityUndecided),
    ),
    (
        "the same where the input changes it",
        "x: [a, b]\ny: [q, r]\nu: [u]\nf_x: {a: u, b: u*q}\nf_y: {q: u, r: a*(q - abs(q)) + b*(q + abs(q))}\nphi: [a, b]",
        Accepted("dynamic linear excitation"),
    ),
    (
        "a sign that every motion keeps",
        "x: [p, s]\ny: [q, r]\nu: [v]\nf_x: {p: 0, s: 0}\nf_y: {q: q*v, r: p + s*sign(q)}\nphi: [p, s]",
        Undecided(Code::IdentifiabilityUndecided),
    ),
    (
        "three intervals that every motion stays in",
        "x: [p, s, c]\ny: [q, r]\nu: [v]\nf_x: {p: 0, s: 0, c: 0}\n\
         f_y: {q: q*v*(q - 1), r: p + s*sign(q) + c*sign(q - 1)}\nphi: [p, s, c]",
        Undecided(Code::IdentifiabilityUndecided),
    ),
    (
        "the sign of a constant",
        "x: [p, s]\ny: [m, r]\nu: [v]\nf_x: {p: 0, s: 0}\nf_y: {m: 0, r: p + s*sign(m)}\nphi: [p, s]",
        Undecided(Code::IdentifiabilityUndecided),
    ),
    (
        "the magnitude of a constant, as a root",
        "x: [p, s]\ny: [m, r]\nu: [v]\nf_x: {p: 0, s: 0}\nf_y: {m: 0, r: p*m + s*sqrt(m^2)}\nphi: [p, s]",
        Undecided(Code::IdentifiabilityUndecided),
    ),
    (
        "a border that the assumptions leave out",
        "x: [p, s]\ny: [q, r]\nu: [v]\nassume: [q^2 > 1]\nf_x: {p: 0, s: 0}\nf_y: {q: v, r: p + s*sign(q)}\nphi: [p, s]",
        Undecided(Code::IdentifiabilityUndecided),
    ),
    (
        "a constant that is the same on both sides",
        "x: [p, s]\ny: [q, m, r]\nu: [v]\nf_x: {p: 0, s: 0}\nf_y: {q: v, m: 0, r: (m*p + s)*sign(q)}\nphi: [p, s]",
        Undecided(Code::IdentifiabilityUndecided),
    ),
    (
        "a border that attracts from both sides",
        "x: [p, s]\ny: [q, r]\nu: [v]\nf_x: {p: 0, s: 0}\nf_y: {q: -sign(q)*(1 + v^2), r: p + s*sign(q)}\nphi: [p, s]",
        Undecided(Code::IdentifiabilityUndecided),
    ),
    (
        "a regressor that vanishes on both sides",
        "x: [x]\ny: [y]\nu: [u]\nf_x: {x: u}\nf_y: {y: x*(y + abs(y))*(y - abs(y)) + u}\nphi: [x]",
        Rejected(Code::NeverIdentifiable),
    ),
    (
        "one direction that no side sees",
        "x: [a, b]\ny: [y]\nu: [u]\nf_x: {a: u, b: u}\nf_y: {y: (a + b)*(2 + sign(y))}\nphi: [a, b]",
        Rejected(Code::NeverIdentifiable),
    ),
    (
        "a magnitude whose side depends on the sign of a parameter",
        "parameters: [k]\nx: [p]\ny: [q, s]\nu: [v]\nf_x: {p: 0}\nf_y: {q: v*q, s: p*(sqrt(k^2*q^2) - k*q)}\nphi: [p]",
        Accepted("dynamic linear excitation"),
    ),
    // Absolute values that are written as other functions.
    (
        "the root of a square through a logarithm, which vanishes on one side",
        "x: [p]\ny: [q, s]\nu: [v]\nassume: [q != 0]\nf_x: {p: 0}\nf_y: {q: v*q, s: p*(exp(log(q^2)/2) - q)}\nphi: [p]",
        Accepted("dynamic linear excitation"),
    ),
    (
        "a root within a root",
        "x: [p]\ny: [q, s]\nu: [v]\nassume: [q != 0]\nf_x: {p: 0}\n\
         f_y: {q: v*q, s: p*(sqrt(q^2 + 1 - 2*sqrt(q^2)) - sqrt(q^2) + 1)}\nphi: [p]",
        Accepted("dynamic linear excitation"),
    ),
    (
        "the sine of half an angle as a root",
        "x: [p]\ny: [q, s]\nu: [v]\nf_x: {p: 0}\nf_y: {q: v*q, s: p*(sqrt((1 - cos(q))/2) - sin(q/2))}\nphi: [p]",
        Accepted("dynamic linear excitation"),
    ),
    (
        "two unknowns of which one side shows the sum, the other the difference",
        "x: [p, s]\ny: [r]\nu: [v]\nf_x: {p: 0, s: 0}\nf_y: {r: p*exp(log(v^2)/2) + s*v}\nphi: [p, s]",
        Accepted("dynamic linear excitation"),
    ),
    (
        "the same of half an angle",
        "x: [p, s]\ny: [r]\nu: [v]\nf_x: {p: 0, s: 0}\nf_y: {r: p*sqrt((1 - cos(v))/2) + s*sin(v/2)}\nphi: [p, s]",
        Undecided(Code::IdentifiabilityUndecided),
    ),
    (
        "a root within a root of an input",
        "x: [p, s]\ny: [r]\nu: [v]\nassume: [v > 1]\nf_x: {p: 0, s: 0}\n\
         f_y: {r: p*sqrt(v - 2*sqrt(v - 1)) + s*(1 - sqrt(v - 1))}\nphi: [p, s]",
        Undecided(Code::IdentifiabilityUndecided),
    ),
    (
        "two unknowns, told apart once a difference of outputs has had both signs",
        "x: [p, s]\ny: [q, r, m]\nu: [v]\nf_x: {p: 0, s: 0}\nf_y: {q: v, r: 1, m: p*sqrt((q - r)^2) + s*(q - r)}\nphi: [p, s]",
        Accepted("dynamic linear excitation"),
    ),
    (
        "a direction that is constant along every motion",
        "x: [p, s]\ny: [q, w, r]\nf_x: {p: 0, s: 0}\nf_y: {q: w, w: -q, r: p + s*(q^2 + w^2)}\nphi: [p, s]",
        Rejected(Code::NeverIdentifiable),
    ),
];

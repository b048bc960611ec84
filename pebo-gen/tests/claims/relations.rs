//! Verdicts on equations between the components of the transform and the outputs that hold at every instant.

use pebo_gen::source::Code;

use super::table::Answer::{Accepted, Rejected, Undecided};
use super::table::Row;

pub(super) const RELATIONS: &[Row] = &[
    // Static regressions under a generalised cascade.
    (
        "a sum of decays",
        "parameters: [k, m]\nassume: [k > 0, m > 0, k != m]\nx: [a, b]\ny: [s]\nu: [u]\nf_x: {a: u - k*a, b: u - m*b}\n\
         phi: [a, b]\nidentities: [s - a - b]",
        Accepted("gpebo static linear excitation"),
    ),
    (
        "a sum of equal decays",
        "parameters: [k]\nassume: [k > 0]\nx: [a, b]\ny: [s]\nu: [u]\nf_x: {a: u - k*a, b: u - k*b}\n\
         phi: [a, b]\nidentities: [s - a - b]",
        Rejected(Code::NeverIdentifiable),
    ),
    (
        "a bearing",
        "x: [p, v]\ny: [s, c, o]\nf_x: {p: v, v: 0}\nphi: [p, v]\nidentities: [(p - o)*s - c]",
        Accepted("gpebo static linear excitation"),
    ),
    (
        "a square under a generalised cascade, whose derivative is affine by itself",
        "x: [a]\ny: [s]\nu: [u]\nf_x: {a: u - a}\nphi: [a]\nidentities: [s - a^2]",
        Accepted("gpebo implicit linear instant"),
    ),
    (
        "a circle under a cascade that turns",
        "x: [a, b]\ny: [c, d]\nu: [w, v]\nclass: gpebo\nf_x: {a: w*b + v, b: -w*a}\nphi: [a, b]\n\
         identities: [(a - c)^2 + (b - d)^2 - 4]",
        Accepted("gpebo implicit linear excitation"),
    ),
    (
        "a square under a generalised cascade with an unequal one",
        "x: [a, b]\ny: [s]\nu: [u]\nf_x: {a: u - a, b: u - 2*b}\nphi: [a, b]\nidentities: [s - a^2 - b^2]",
        Accepted("gpebo static over-parameterised excitation"),
    ),
    // The terms around the states in an output's value are removed.
    (
        "a share",
        "assume: [p > 0]\nx: [p]\ny: [V]\nu: [v]\nf_x: {p: v}\ng_y: {V: p/(1 + p)}\nphi: [p]",
        Accepted("static linear instant"),
    ),
    (
        "a root",
        "assume: [p > 0]\nx: [p]\ny: [V]\nu: [v]\nf_x: {p: v}\ng_y: {V: sqrt(p)}\nphi: [p]",
        Accepted("static linear instant"),
    ),
    (
        "a range",
        "x: [p, s]\ny: [V]\nu: [v, w]\nf_x: {p: v, s: w}\ng_y: {V: 'sqrt(p^2 + s^2)'}\nphi: [p, s]",
        Accepted("static over-parameterised excitation"),
    ),
    (
        "a bearing by its angle",
        "x: [p, s]\ny: [V]\nu: [v, w]\nf_x: {p: v, s: w}\ng_y: {V: 'atan2(p, s)'}\nphi: [p, s]",
        Accepted("static linear excitation"),
    ),
    (
        "a ratio of unknowns that move alike is all that it shows",
        "assume: [s > 0]\nx: [p, s]\ny: [V]\nu: [v]\nf_x: {p: 0, s: 0}\ng_y: {V: p/s}\nphi: [p, s]",
        Rejected(Code::NeverIdentifiable),
    ),
    (
        "a logarithm under a generalised cascade",
        "parameters: {U: 3.5, a: 0.03}\nassume: [0 < c < 1]\nx: [b, c]\ny: [V]\nu: [I]\n\
         f_x: {b: c - b, c: b - c - I}\ng_y: {V: U + a*log((1 - c)/c)}\nphi: [b, c]",
        Accepted("gpebo static linear excitation"),
    ),
    (
        "a state that its voltage tells, in a charge that is quadratic in it",
        "parameters: [C, k, R]\nassume: [C > 0, k > 0, v > 0]\nx: [v]\ny: [V]\nu: [I]\nf_x: {v: -I/(C + k*v)}\n\
         g_y: {V: v - R*I}\nphi: [C*v + k*v^2/2]",
        Accepted("static linear instant"),
    ),
    // A rate that holds the unknown in a denominator.
    (
        "a denominator under a generalised cascade",
        "assume: [p > 0, q > 0]\nx: [p]\ny: [q]\nu: [v]\nf_x: {p: v - q*p}\nf_y: {q: 1/(p + q)}\nphi: [p]",
        Accepted("gpebo implicit linear instant"),
    ),
    (
        "a denominator beside a rate that is affine",
        "assume: [p > 0, q > 0]\nx: [p, s]\ny: [q, r]\nu: [v]\nf_x: {p: v, s: 0}\nf_y: {q: 1/(p + q), r: s - p}\n\
         phi: [p, s]",
        Accepted("implicit linear instant"),
    ),
    (
        "the heading of a trailer, by a relation under the derivative, beside a rate that tells nothing",
        "x: [p]\ny: [a, b, h]\nu: [v, w]\nangles: {p: 2*pi}\nf_x: {p: v*sin(h - p)}\n\
         f_y: {a: v*cos(h - p)*cos(p), b: v*cos(h - p)*sin(p), h: v*w}\nphi: [cos(p) + a, sin(p) + b]",
        Accepted("implicit linear excitation"),
    ),
    // An output's value tells more than the rate that follows from it.
    (
        "an inclination that is measured, beside a position",
        "parameters: [m, g, c]\nassume: [m > 0, g > 0]\nx: [v, a]\ny: [s, n]\nu: [f]\nf_x: {v: f/m - g*a - c*v/m, a: 0}\n\
         f_y: {s: v}\ng_y: {n: a}\nphi: [v, a]",
        Accepted("gpebo implicit linear instant"),
    ),
    (
        "the same by its rate, which the author gives",
        "parameters: [m, g, c]\nassume: [m > 0, g > 0]\nx: [v, a]\ny: [s, n]\nu: [f]\nf_x: {v: f/m - g*a - c*v/m, a: 0}\n\
         f_y: {s: v, n: 0}\ng_y: {n: a}\nphi: [v, a]",
        Accepted("gpebo dynamic linear excitation"),
    ),
    (
        "two values that show the states at once",
        "x: [v, a]\ny: [s, n]\nu: [f]\nf_x: {v: f - a, a: f}\ng_y: {s: v + a, n: 2*a}\nphi: [v, a]",
        Accepted("gpebo static linear instant"),
    ),
    (
        "a value that is not affine stands by its rate",
        "x: [v]\ny: [q, s]\nu: [f]\nf_x: {v: f}\nf_y: {q: v}\ng_y: {s: sin(q)}\nphi: [v]",
        Accepted("dynamic linear instant"),
    ),
    // A relation under the derivative.
    (
        "a circle of which the derivative is asked for",
        "x: [a, b]\ny: [c, d]\nu: [u, v]\nf_x: {a: u, b: v}\nphi: [a, b]\nregression: differentiated\n\
         identities: [(a - c)^2 + (b - d)^2 - 4]",
        Accepted("implicit linear excitation"),
    ),
    (
        "an angle on a circle that was found",
        "x: [q]\ny: [c, d]\nu: [u, v]\nw: [r]\nf_x: {q: r}\nf_y: {c: u + r*sin(q), d: v - r*cos(q)}\n\
         phi: [cos(q) + c, sin(q) + d]\nangles: {q: 2*pi}",
        Accepted("implicit linear excitation"),
    ),
    (
        "an angle on a circle as it stands",
        "x: [q]\ny: [c, d]\nu: [u, v]\nw: [r]\nf_x: {q: r}\nf_y: {c: u + r*sin(q), d: v - r*cos(q)}\n\
         phi: [cos(q) + c, sin(q) + d]\nangles: {q: 2*pi}\nregression: static",
        Accepted("static over-parameterised excitation"),
    ),
    // The form that the model names, whatever the outputs' rates would give.
    (
        "a circle beside rates",
        "x: [q]\ny: [c, d]\nu: [u, v, r]\nf_x: {q: r}\nf_y: {c: u + r*sin(q), d: v - r*cos(q)}\n\
         phi: [cos(q) + c, sin(q) + d]\nangles: {q: 2*pi}",
        Accepted("dynamic linear instant"),
    ),
    (
        "a circle in place of rates",
        "x: [q]\ny: [c, d]\nu: [u, v, r]\nf_x: {q: r}\nf_y: {c: u + r*sin(q), d: v - r*cos(q)}\n\
         phi: [cos(q) + c, sin(q) + d]\nangles: {q: 2*pi}\nregression: static",
        Accepted("static over-parameterised excitation"),
    ),
    (
        "a circle under the derivative in place of rates",
        "x: [q]\ny: [c, d]\nu: [u, v, r]\nf_x: {q: r}\nf_y: {c: u + r*sin(q), d: v - r*cos(q)}\n\
         phi: [cos(q) + c, sin(q) + d]\nangles: {q: 2*pi}\nregression: differentiated",
        Accepted("implicit linear excitation"),
    ),
    (
        "rates that no relation can stand for",
        "x: [v]\ny: [q]\nf_x: {v: -q}\nf_y: {q: v}\nphi: [v]\nregression: static",
        Undecided(Code::RegressionUndecided),
    ),
    (
        "rates of which no derivative of a relation is to be had",
        "x: [v]\ny: [q]\nf_x: {v: -q}\nf_y: {q: v}\nphi: [v]\nregression: differentiated",
        Undecided(Code::RegressionUndecided),
    ),
    (
        "a square whose coefficient moves has no such derivative",
        "x: [a]\ny: [s, k]\nu: [u]\nf_x: {a: u}\nphi: [a]\nregression: differentiated\nidentities: [s - k*a^2]",
        Undecided(Code::RegressionUndecided),
    ),
    (
        "what bends cancels from two rates",
        "x: [p]\ny: [q, r]\nu: [v]\nf_x: {p: v}\nf_y: {q: p + 2*abs(p), r: abs(p)}\nphi: [p]",
        Accepted("implicit linear instant"),
    ),
    (
        "an unknown road cancels from the travel and the wheel: quarter car",
        "parameters: {ms: 300, mu: 40, ks: 16000, kt: 160000, c: 1000}\nx: [vs, vu]\ny: [d, zu]\nu: [F]\nw: [zr]\n\
         f_x: {vs: (-ks*d - c*(vs - vu) + F)/ms, vu: (ks*d + c*(vs - vu) - kt*(zu - zr) - F)/mu}\n\
         f_y: {d: vs - vu, zu: vu}\nphi: [vs + c*d/ms]\nphi_left: {vs: z1 - c*d/ms}",
        Accepted("implicit linear instant"),
    ),
    (
        "what cancels with a coefficient that moves is not refuted",
        "x: [p]\ny: [q, r, m]\nu: [v]\nf_x: {p: v}\nf_y: {q: p + m*exp(p^2), r: exp(p^2), m: v}\nphi: [p]",
        Undecided(Code::RegressionNonlinear),
    ),
    (
        "value with a product that is a component of phi",
        "x: [a, b]\ny: [s]\nu: [v]\nf_x: {a: 0, b: 0}\ng_y: {s: a + v*b + v^2*a*b}\nphi: [a, b, a*b]",
        Accepted("static linear excitation"),
    ),
    (
        "value of a state that is a quotient of components of phi",
        "x: [a, b]\ny: [s, r]\nu: [v]\nassume: [a > 0, b > 0]\nf_x: {a: 0, b: 0}\nf_y: {s: a*b*v - s}\ng_y: {r: b*v}\n\
         phi: [a, a*b]",
        Accepted("implicit linear instant"),
    ),
];

//! A row for each verdict: the plant, and the expected answer.

use pebo_gen::Derived;
use pebo_gen::analysis::{Class, Outcome};
use pebo_gen::source::Code;

use super::derived;
use super::implicit::IMPLICIT;
use super::non_smooth::NON_SMOOTH;
use super::relations::RELATIONS;
use super::timed::TIMED;

/// The expected answer: every claim proved, or the code of the first refusal.
pub(super) enum Answer {
    Accepted(&'static str),
    Rejected(Code),
    Undecided(Code),
}
use Answer::{Accepted, Rejected, Undecided};

/// The class of an accepted derivation in a few words.
fn class(derived: &Derived) -> String {
    let derivation = &derived.derivation;
    let regression = derivation.regression.result.as_ref().expect("a regression");
    let (kind, parameterisation) = (regression.kind.word(), regression.parameterisation(&derived.plant));
    let cascade = if derivation.class == Class::Pebo { "" } else { "gpebo " };
    let excitation = derivation.identifiability.result.as_ref().expect("identifiability").kind.word();
    format!("{cascade}{kind} {parameterisation} {excitation}")
}

/// A name, the lines of the model, and the expected answer.
pub(super) type Row = (&'static str, &'static str, Answer);

const TABLE: &[Row] = &[
    // Rates of the output as functions of z = x, with x' = u.
    ("affine", "x: [x]\ny: [y]\nu: [u]\nf_x: {x: u}\nf_y: {y: 2*x + y}\nphi: [x]", Accepted("dynamic linear instant")),
    (
        "rate that depends on time",
        "x: [x]\ny: [y]\nf_x: {x: sin(3*t) - y}\nf_y: {y: (2 + cos(t))*x + t}\nphi: [x]",
        Accepted("dynamic linear instant"),
    ),
    (
        "product with an input",
        "x: [x]\ny: [y]\nu: [u]\nf_x: {x: u}\nf_y: {y: u*x}\nphi: [x]",
        Accepted("dynamic linear instant"),
    ),
    (
        "square",
        "x: [x]\ny: [y]\nu: [u]\nf_x: {x: u}\nf_y: {y: x^2}\nphi: [x]",
        Accepted("dynamic over-parameterised excitation"),
    ),
    (
        "sine",
        "x: [x]\ny: [y]\nu: [u]\nf_x: {x: u}\nf_y: {y: sin(x)}\nphi: [x]",
        Accepted("dynamic over-parameterised excitation"),
    ),
    (
        "sine and cosine",
        "x: [x]\ny: [a, b]\nu: [u]\nf_x: {x: u}\nf_y: {a: cos(x), b: sin(x)}\nphi: [x]",
        Accepted("dynamic over-parameterised instant"),
    ),
    (
        "exponential",
        "x: [x]\ny: [y]\nu: [u]\nf_x: {x: u}\nf_y: {y: exp(x)}\nphi: [x]",
        Accepted("dynamic over-parameterised instant"),
    ),
    (
        "hyperbolic",
        "x: [x]\ny: [y]\nu: [u]\nf_x: {x: u}\nf_y: {y: cosh(x)}\nphi: [x]",
        Accepted("dynamic over-parameterised excitation"),
    ),
    (
        "polynomial times exponential",
        "x: [x]\ny: [y]\nu: [u]\nf_x: {x: u}\nf_y: {y: x*exp(x)}\nphi: [x]",
        Accepted("dynamic over-parameterised excitation"),
    ),
    (
        "gaussian",
        "x: [x]\ny: [y]\nu: [u]\nf_x: {x: u}\nf_y: {y: exp(-x^2)}\nphi: [x]",
        Rejected(Code::RegressionNonlinear),
    ),
    // The unknown multiplies the rate: not linear as a dynamic regression, but as an implicit one.
    (
        "reciprocal",
        "x: [x]\ny: [y]\nu: [u]\nf_x: {x: u}\nf_y: {y: 1/x}\nphi: [x]\nassume: [x > 0]",
        Accepted("implicit linear instant"),
    ),
    (
        "root",
        "x: [x]\ny: [y]\nu: [u]\nf_x: {x: u}\nf_y: {y: sqrt(x)}\nphi: [x]\nassume: [x > 0]",
        Rejected(Code::RegressionNonlinear),
    ),
    (
        "absolute value",
        "x: [x]\ny: [y]\nu: [u]\nf_x: {x: u}\nf_y: {y: abs(x)}\nphi: [x]",
        Rejected(Code::RegressionNonlinear),
    ),
    (
        "absolute value of known sign",
        "x: [x]\ny: [y]\nu: [u]\nf_x: {x: u}\nf_y: {y: abs(x)}\nphi: [x]\nassume: [x > 0]",
        Accepted("dynamic linear instant"),
    ),
    ("nothing to estimate from", "x: [x]\ny: [y]\nu: [u]\nf_x: {x: u}\nphi: [x]", Rejected(Code::RegressionNonlinear)),
    // Definitions mean what they say wherever they stand: p' = u + x^2 is not free of x.
    (
        "a definition that uses a later one",
        "x: [x]\ny: [y]\nu: [u]\ndefine: {a: b, b: x^2}\nf_x: {x: u + a}\nf_y: {y: x}\nphi: [x]",
        Rejected(Code::CascadeRefuted),
    ),
    (
        "a definition that uses a later one, rightly",
        "x: [x]\ny: [y]\nu: [u]\ndefine: {a: 2*b, b: y^2}\nf_x: {x: u + a}\nf_y: {y: x}\nphi: [x]",
        Accepted("dynamic linear instant"),
    ),
    // An output that is given by its value: a static regression, and its rate where no input moves it.
    ("a value", "x: [x]\ny: [y]\nu: [u]\nf_x: {x: u}\ng_y: {y: 2*x + 1}\nphi: [x]", Accepted("static linear instant")),
    (
        "a value that an input moves",
        "x: [x]\ny: [y]\nu: [u]\nf_x: {x: u}\ng_y: {y: 2*x - 3*u}\nphi: [x]",
        Accepted("static linear instant"),
    ),
    (
        "the rate of a value in the transform",
        "x: [x]\ny: [y, v]\nu: [u]\nf_x: {x: u + 2*v*x}\nf_y: {v: x}\ng_y: {y: v^2}\nphi: [x - y]",
        Accepted("dynamic linear instant"),
    ),
    // Transforms and their inverses.
    (
        "coupled",
        "x: [a, b]\ny: [c, d]\nu: [u]\nf_x: {a: u, b: c}\nf_y: {c: a + b, d: a - b}\nphi: [a + b, a - b]",
        Accepted("dynamic linear instant"),
    ),
    (
        "logarithm",
        "x: [x]\ny: [y]\nu: [u]\nf_x: {x: u*x}\nf_y: {y: y*log(x)}\nphi: [log(x)]\nassume: [x > 0]",
        Accepted("dynamic linear instant"),
    ),
    (
        "exponential transform",
        "x: [x]\ny: [y]\nu: [u]\nf_x: {x: u*exp(-x)}\nf_y: {y: exp(x)}\nphi: [exp(x)]",
        Accepted("dynamic linear instant"),
    ),
    (
        "even transform",
        "x: [x]\ny: [y]\nu: [u]\nf_x: {x: u/x}\nf_y: {y: x^2}\nphi: [x^2/2]",
        Rejected(Code::LeftInverseRefuted),
    ),
    (
        "even transform, positive state",
        "x: [x]\ny: [y]\nu: [u]\nf_x: {x: u/x}\nf_y: {y: x^2}\nphi: [x^2/2]\nassume: [x > 0]",
        Accepted("dynamic linear instant"),
    ),
    (
        "even transform, negative state",
        "x: [x]\ny: [y]\nu: [u]\nf_x: {x: u/x}\nf_y: {y: x^2}\nphi: [x^2/2]\nassume: [x < 0]",
        Accepted("dynamic linear instant"),
    ),
    (
        "root of either sign",
        "x: [x]\ny: [y]\nu: [u]\nf_x: {x: u/(3*x^2)}\nf_y: {y: x^3}\nphi: [x^3]\nphi_left: {x: z1^(1/3)}",
        Undecided(Code::LeftInverseUndecided),
    ),
    (
        "sine on its branch",
        "x: [x]\ny: [y]\nu: [u]\nf_x: {x: u/cos(x)}\nf_y: {y: sin(x)}\nphi: [sin(x)]\nassume: [-pi/2 < x < pi/2]",
        Accepted("dynamic linear instant"),
    ),
    (
        "sine off its branch",
        "x: [x]\ny: [y]\nu: [u]\nf_x: {x: u/cos(x)}\nf_y: {y: sin(x)}\nphi: [sin(x)]\nphi_left: {x: asin(z1)}",
        Rejected(Code::LeftInverseRefuted),
    ),
    (
        "tangent on its branch",
        "x: [x]\ny: [y]\nu: [u]\nf_x: {x: u*cos(x)^2}\nf_y: {y: tan(x)}\nphi: [tan(x)]\nassume: [-pi/2 < x < pi/2]",
        Accepted("dynamic linear instant"),
    ),
    (
        "angle",
        "x: [q]\ny: [a, b]\nu: [w]\nf_x: {q: w}\nf_y: {a: -w*sin(q), b: w*cos(q)}\nphi: [a - cos(q), b - sin(q)]\nangles: {q: 2*pi}",
        Accepted("dynamic linear instant"),
    ),
    (
        "angle on one turn",
        "x: [q]\ny: [a, b]\nu: [w]\nf_x: {q: w}\nf_y: {a: -w*sin(q), b: w*cos(q)}\nphi: [a - cos(q), b - sin(q)]\nassume: [-pi < q < pi]",
        Accepted("dynamic linear instant"),
    ),
    (
        "too few components",
        "x: [a, b]\ny: [y]\nu: [u]\nf_x: {a: u, b: u}\nf_y: {y: a + b}\nphi: [a + b]",
        Rejected(Code::LeftInverseRefuted),
    ),
    (
        "partial observer",
        "x: [a, b]\ny: [y]\nu: [u]\nf_x: {a: u, b: -b}\nf_y: {y: a}\nphi: [a]\nphi_left: {a: z1}",
        Accepted("dynamic linear instant"),
    ),
    (
        "wrong left inverse",
        "x: [x]\ny: [y]\nu: [u]\nf_x: {x: u}\nf_y: {y: x}\nphi: [2*x]\nphi_left: {x: z1}",
        Rejected(Code::LeftInverseRefuted),
    ),
    (
        "angle of too short a period",
        "x: [q]\ny: [a, b]\nu: [w]\nf_x: {q: w}\nf_y: {a: -w*sin(q), b: w*cos(q)}\nphi: [a - cos(q), b - sin(q)]\nangles: {q: pi}",
        Rejected(Code::LeftInverseRefuted),
    ),
    (
        "inverse sine of what may exceed one",
        "x: [x]\ny: [y]\nu: [u]\nf_x: {x: u}\nf_y: {y: x}\nphi: [x]\nphi_left: {x: 1000*sin(asin(z1/1000))}",
        Undecided(Code::LeftInverseUndecided),
    ),
    (
        "identity beside an output that sees nothing",
        "x: [a, b]\ny: [c, d]\nu: [u, v]\nf_x: {a: u, b: v}\nf_y: {c: v}\nphi: [a, b]\nidentities: [(a - c)^2 + (b - d)^2 - 4]",
        Accepted("static over-parameterised excitation"),
    ),
    // The cascade.
    (
        "rate depends on x",
        "x: [x]\ny: [y]\nu: [u]\nclass: pebo\nf_x: {x: u - x}\nf_y: {y: x}\nphi: [x]",
        Rejected(Code::CascadeRefuted),
    ),
    (
        "rate affine in x",
        "x: [x]\ny: [y]\nu: [u]\nf_x: {x: u - x}\nf_y: {y: x}\nphi: [x]",
        Accepted("gpebo dynamic linear instant"),
    ),
    (
        "rate free of x, the generalised cascade asked for",
        "x: [x]\ny: [y]\nu: [u]\nclass: gpebo\nf_x: {x: u}\nf_y: {y: x}\nphi: [x]",
        Accepted("gpebo dynamic linear instant"),
    ),
    (
        "rate bent in x, the generalised cascade asked for",
        "x: [x]\ny: [y]\nu: [u]\nclass: gpebo\nf_x: {x: u - x^2}\nf_y: {y: x}\nphi: [x]",
        Rejected(Code::CascadeRefuted),
    ),
    (
        "rate affine in one component, bent in another",
        "x: [a, b]\ny: [y]\nu: [u]\nf_x: {a: u - a, b: a*b}\nf_y: {y: a + b}\nphi: [a, b]",
        Rejected(Code::CascadeRefuted),
    ),
    (
        "rate depends on an unmeasured signal",
        "x: [x]\ny: [y]\nu: [u]\nw: [w]\nf_x: {x: u + w}\nf_y: {y: x}\nphi: [x]",
        Rejected(Code::CascadeRefuted),
    ),
    (
        "cancels by trigonometry",
        "x: [x]\ny: [q]\nu: [u]\nf_x: {x: u + x*(sin(2*q) - 2*sin(q)*cos(q))}\nf_y: {q: x}\nphi: [x]",
        Accepted("dynamic linear instant"),
    ),
    (
        "polar coordinates",
        "x: [p, l]\ny: [r, q]\nu: [u, v]\nparameters: {m: null}\nassume: [r > 0, m > 0]\nf_x: {p: l^2/(m*r^3) + u, l: v}\nf_y: {r: p/m, q: l/(m*r^2)}\nphi: [p*cos(q) - l*sin(q)/r, p*sin(q) + l*cos(q)/r]",
        Accepted("dynamic linear instant"),
    ),
    (
        "rotating frame",
        "x: [a, b]\ny: [y]\nu: [w, u]\nf_x: {a: w*b + u, b: -w*a}\nf_y: {y: a}\nphi: [a, b]",
        Accepted("gpebo dynamic linear excitation"),
    ),
    (
        "growing frame",
        "x: [a, b]\ny: [y]\nu: [w, u]\nf_x: {a: w*b + u, b: w*a}\nf_y: {y: a}\nphi: [a, b]",
        Accepted("gpebo dynamic linear excitation"),
    ),
    (
        "growing frame, the plain cascade asked for",
        "x: [a, b]\ny: [y]\nu: [w, u]\nclass: pebo\nf_x: {a: w*b + u, b: w*a}\nf_y: {y: a}\nphi: [a, b]",
        Rejected(Code::CascadeRefuted),
    ),
    // Identifiability.
    (
        "two unknowns, one output",
        "x: [a, b]\ny: [y]\nu: [u, v]\nf_x: {a: u, b: v}\nf_y: {y: u*a + v*b}\nphi: [a, b]",
        Accepted("dynamic linear excitation"),
    ),
    (
        "regressor moved by the output",
        "x: [a, b]\ny: [y]\nu: [u]\nf_x: {a: u, b: -u*y}\nf_y: {y: a + y*b}\nphi: [a, b]",
        Accepted("dynamic linear excitation"),
    ),
    (
        "sum of unknowns",
        "x: [a, b]\ny: [y]\nu: [u]\nf_x: {a: u, b: 0}\nf_y: {y: u*(a + b)}\nphi: [a, b]",
        Rejected(Code::NeverIdentifiable),
    ),
    (
        "unseen state",
        "x: [x]\ny: [y]\nu: [u]\nf_x: {x: u}\nf_y: {y: y + u}\nphi: [x]",
        Rejected(Code::NeverIdentifiable),
    ),
    (
        "static",
        "x: [a, b]\ny: [c, d]\nu: [u, v]\nf_x: {a: u, b: v}\nphi: [a, b]\nidentities: [(a - c)^2 + (b - d)^2 - 4]",
        Accepted("static over-parameterised excitation"),
    ),
    // Many unknowns: ranks are proved at points, not by exact elimination.
    (
        "ninth power",
        "x: [x]\ny: [y]\nu: [u]\nf_x: {x: u}\nf_y: {y: u*x - y*x^9}\nphi: [x]",
        Accepted("dynamic over-parameterised excitation"),
    ),
    // Claims are made on the manifold of the identities.
    (
        "a factor that an identity makes zero",
        "x: [p]\ny: [a, b, c]\nu: [v]\nf_x: {p: v}\nf_y: {a: b, b: -a, c: (a^2 + b^2 - 1)*p}\nphi: [p]\n\
         identities: [a^2 + b^2 - 1]",
        Rejected(Code::NeverIdentifiable),
    ),
    (
        "a cascade by an identity",
        "x: [p]\ny: [a, b, q]\nu: [v]\nf_x: {p: v + (a^2 + b^2 - 1)*p}\nf_y: {a: b*v, b: -a*v, q: p}\nphi: [p]\n\
         identities: [a^2 + b^2 - 1]",
        Accepted("dynamic linear instant"),
    ),
    (
        "a cascade by an identity without rational points",
        "x: [p]\ny: [a, b, q]\nu: [v]\nf_x: {p: v + (a^2 + b^2 - 3)*p}\nf_y: {a: b*v, b: -a*v, q: p}\nphi: [p]\n\
         identities: [a^2 + b^2 - 3]",
        Accepted("dynamic linear instant"),
    ),
    (
        "a cascade that fails on the manifold",
        "x: [p]\ny: [a, b, q]\nu: [v]\nf_x: {p: v + a*p^2}\nf_y: {a: b*v, b: -a*v, q: p}\nphi: [p]\n\
         identities: [a^2 + b^2 - 1]",
        Rejected(Code::CascadeRefuted),
    ),
    (
        "a regression by an identity",
        "x: [p]\ny: [a, b, q]\nu: [v]\nf_x: {p: v}\nf_y: {a: b*v, b: -a*v, q: p + (a^2 + b^2 - 1)*p^3}\nphi: [p]\n\
         identities: [a^2 + b^2 - 1]",
        Accepted("dynamic linear instant"),
    ),
    (
        "an identity that eliminates a state",
        "x: [s]\ny: [c, w]\nu: [v]\nf_x: {s: v + w - 2*s}\nf_y: {c: s}\nphi: [s]\nidentities: [w - 2*s]",
        Accepted("dynamic linear instant"),
    ),
    (
        "a left inverse by an identity",
        "x: [s, t]\ny: [c, w]\nu: [v]\nf_x: {s: v, t: v}\nf_y: {c: t}\nphi: [t]\nidentities: [w - s - t]",
        Accepted("dynamic linear instant"),
    ),
    (
        "an identity in an input",
        "x: [p]\ny: [c, d]\nu: [v, w]\nf_x: {p: v}\nf_y: {c: p}\nphi: [p]\nidentities: [d - w*p]",
        Accepted("dynamic linear instant"),
    ),
    (
        "an output that an identity holds still",
        "x: [p, q]\ny: [c, w]\nu: [v]\nf_x: {p: v, q: v}\nf_y: {c: p + w*q}\nphi: [p, q]\nidentities: [w - 3]",
        Rejected(Code::NeverIdentifiable),
    ),
    (
        "an output that nothing holds still",
        "x: [p, q]\ny: [c, w]\nu: [v]\nf_x: {p: v, q: v}\nf_y: {c: p + w*q}\nphi: [p, q]",
        Accepted("dynamic linear excitation"),
    ),
    (
        "an identity that the plant does not keep",
        "x: [p]\ny: [a, b]\nu: [v]\nf_x: {p: v}\nf_y: {a: b*p, b: a*p}\nphi: [p]\nidentities: [a^2 + b^2 - 1]",
        Rejected(Code::IdentityRefuted),
    ),
    (
        "an identity without a real solution",
        "x: [p]\ny: [a]\nu: [v]\nf_x: {p: v}\nf_y: {a: p}\nphi: [p]\nidentities: [p^2 + 1]",
        Rejected(Code::IdentityRefuted),
    ),
    (
        "an identity that could not be solved",
        "x: [p]\ny: [a, b]\nu: [v]\nf_x: {p: v}\nf_y: {a: p}\nphi: [p]\nidentities: [b + exp(b) - 3]",
        Accepted("dynamic linear instant"),
    ),
    (
        "an identity without a change of sign",
        "x: [p]\ny: [a, b]\nu: [v]\nf_x: {p: v}\nf_y: {a: p}\nphi: [p]\nidentities: [(b + exp(b) - 3)^2]",
        Undecided(Code::IdentityUndecided),
    ),
    (
        "a circle and its centre",
        "x: [a, b]\ny: [s]\nu: [w]\nf_x: {a: w*b, b: -w*a}\ng_y: {s: a}\nphi: [a, b]\n\
         identities: [(a^2 + b^2)^2 - 4*(a^2 + b^2)]",
        Accepted("gpebo static linear excitation"),
    ),
    (
        "an irreducible quartic, the flux of a salient motor",
        "parameters: {L: 1, D: 0.5}\nx: [l, m]\ny: [i, j]\nu: [v, w]\nf_x: {l: v - i, m: w - j}\nphi: [l, m]\n\
         define: {a: l - L*i, b: m - L*j}\nidentities: [(a^2 + b^2 - D*(i*a + j*b))^2 - a^2 - b^2]",
        Accepted("static over-parameterised excitation"),
    ),
    (
        "identity of ninth degree",
        "x: [l, m]\ny: [i, j]\nu: [v, w]\nf_x: {l: v - i, m: w - i}\nphi: [l, m]\nidentities: [(l - i)^9 + (m - j)^2 - 2]",
        Accepted("static over-parameterised excitation"),
    ),
    // Plants from elsewhere.
    (
        "epidemic",
        "parameters: [b, c]\nassume: [b > 0, S > 0, I > 0]\nx: [S]\ny: [I]\nf_x: {S: -b*S*I}\nf_y: {I: b*S*I - c*I}\n\
         phi: [log(S)]",
        Accepted("dynamic over-parameterised instant"),
    ),
    (
        "induction motor in stator fluxes",
        "parameters: [r, l, m, s, q, n]\nassume: [l > 0, m > 0, s > 0]\nx: [a, b]\ny: [i, j]\nu: [v, w, o]\n\
         f_x: {a: -r/l*a - n*o*b + r*m/l*i, b: -r/l*b + n*o*a + r*m/l*j}\n\
         f_y: {i: (v - q*i - m/l*(-r/l*a - n*o*b + r*m/l*i))/s, j: (w - q*j - m/l*(-r/l*b + n*o*a + r*m/l*j))/s}\n\
         phi: [m/l*a + s*i, m/l*b + s*j]",
        Accepted("dynamic linear instant"),
    ),
    (
        "attitude by quaternions",
        "parameters: [J, K, L]\nassume: [J > 0, K > 0, L > 0]\nx: [a, b, c]\ny: [p, q, r, s]\nu: [t, v, w]\n\
         f_x: {a: ((K - L)*b*c + t)/J, b: ((L - J)*a*c + v)/K, c: ((J - K)*a*b + w)/L}\n\
         f_y: {p: -(q*a + r*b + s*c)/2, q: (p*a - s*b + r*c)/2, r: (s*a + p*b - q*c)/2, s: (q*b - r*a + p*c)/2}\n\
         identities: [p^2 + q^2 + r^2 + s^2 - 1]\nphi:\n  \
         - (p^2 + q^2 - r^2 - s^2)*J*a + 2*(q*r - p*s)*K*b + 2*(q*s + p*r)*L*c\n  \
         - 2*(q*r + p*s)*J*a + (p^2 - q^2 + r^2 - s^2)*K*b + 2*(r*s - p*q)*L*c\n  \
         - 2*(q*s - p*r)*J*a + 2*(r*s + p*q)*K*b + (p^2 - q^2 - r^2 + s^2)*L*c",
        Accepted("dynamic linear instant"),
    ),
    // Points of the domain refute, with the same y, u and parameters.
    (
        "rate that varies with x where the domain is not",
        "x: [p]\ny: [q]\nu: [v]\nassume: [0 < p < 1]\nf_x: {p: v + abs(p - 2) + p}\nf_y: {q: p}\nphi: [p]",
        Accepted("dynamic linear instant"),
    ),
    (
        "rate that varies with x far from 0",
        "x: [p]\ny: [q]\nu: [v]\nassume: [p > 3]\nf_x: {p: v - p^2}\nf_y: {q: p}\nphi: [p]",
        Rejected(Code::CascadeRefuted),
    ),
    (
        "bend outside the domain",
        "x: [p]\ny: [q]\nu: [v]\nassume: [p > 3]\nf_x: {p: v}\nf_y: {q: abs(p - 2) + p}\nphi: [p]",
        Accepted("dynamic linear instant"),
    ),
    (
        "bend inside the domain",
        "x: [p]\ny: [q]\nu: [v]\nassume: [p > 3]\nf_x: {p: v}\nf_y: {q: abs(p - 5) + p}\nphi: [p]",
        Rejected(Code::RegressionNonlinear),
    ),
    (
        "even transform, its other state outside the domain",
        "x: [x]\ny: [y]\nu: [u]\nf_x: {x: u/x}\nf_y: {y: x^2}\nphi: [x^2/2]\nassume: [x + 1 > 0, x != 0]",
        Rejected(Code::LeftInverseRefuted),
    ),
    // Relations between the components of phi and the outputs identify, too.
    (
        "three phases",
        "x: [q]\ny: [a, b, c, w]\nu: [u, v]\nangles: {q: 2*pi}\nf_x: {q: w}\n\
         f_y: {a: u + w*sin(q), b: v + w*sin(q - 2*pi/3), c: -u - v + w*sin(q + 2*pi/3)}\n\
         phi: [cos(q) + a, cos(q - 2*pi/3) + b, cos(q + 2*pi/3) + c]",
        Accepted("implicit linear instant"),
    ),
    (
        "redundant component",
        "x: [x]\ny: [y]\nu: [u]\nf_x: {x: u}\nf_y: {y: x}\nphi: [x, 2*x]",
        Rejected(Code::NeverIdentifiable),
    ),
    (
        "component that is a square of another",
        "x: [p]\ny: [q]\nu: [v]\nf_x: {p: 0}\nf_y: {q: p}\nphi: [p, p^2]",
        Accepted("implicit over-parameterised instant"),
    ),
    // Functions of the unknowns that are not identifiable while the unknowns are.
    (
        "product with a state that rests",
        "x: [p, s]\ny: [q]\nu: [v]\nassume: [s > 0]\nf_x: {p: v, s: 0}\nf_y: {q: p*s}\nphi: [p, s]",
        Undecided(Code::IdentifiabilityUndecided),
    ),
    (
        "product of states that rest",
        "x: [p, s]\ny: [q]\nu: [v]\nassume: [s > 0]\nf_x: {p: 0, s: 0}\nf_y: {q: v*p*s}\nphi: [p, s]",
        Rejected(Code::NeverIdentifiable),
    ),
    (
        "factor that is a constant combination of others",
        "x: [a, b, c]\ny: [y]\nu: [u, v]\nf_x: {a: u, b: v, c: u - v}\nf_y: {y: u*a^2 + v*b^2 + (u + v)*c^3}\n\
         phi: [a, b, c]",
        Accepted("dynamic over-parameterised excitation"),
    ),
    // Signals that nobody measures.
    (
        "unmeasured signal that cancels between outputs",
        "x: [p]\ny: [q, r]\nu: [v]\nw: [d]\nf_x: {p: v}\nf_y: {q: p + d, r: d}\nphi: [p]",
        Accepted("implicit linear instant"),
    ),
    (
        "unmeasured signal that cancels by a parameter",
        "x: [p]\ny: [q, r]\nu: [v]\nw: [d]\nparameters: [k]\nassume: [k > 0]\nf_x: {p: v}\n\
         f_y: {q: v*p + k*d*r, r: d*r}\nphi: [p]",
        Accepted("implicit linear instant"),
    ),
    (
        "two unmeasured signals between three outputs",
        "x: [p]\ny: [a, b, c]\nu: [v]\nw: [d, e]\nf_x: {p: v}\nf_y: {a: p + d + e, b: d - e, c: d}\nphi: [p]",
        Accepted("implicit linear instant"),
    ),
    (
        "unmeasured signal that cancels from a square",
        "x: [p]\ny: [q, r]\nu: [v]\nw: [d]\nf_x: {p: v}\nf_y: {q: p^2 + sin(d), r: sin(d)}\nphi: [p]",
        Accepted("implicit over-parameterised excitation"),
    ),
    (
        "unmeasured signals in as many outputs",
        "x: [p]\ny: [q, r]\nu: [v]\nw: [d, e]\nf_x: {p: v}\nf_y: {q: p + d, r: p + e}\nphi: [p]",
        Rejected(Code::RegressionNonlinear),
    ),
    (
        "unmeasured signal that cancels with the state",
        "x: [p]\ny: [q, r]\nu: [v]\nw: [d]\nf_x: {p: v}\nf_y: {q: p + d, r: p + d}\nphi: [p]",
        Rejected(Code::NeverIdentifiable),
    ),
    (
        "unmeasured signal that cancels by a moving factor",
        "x: [p]\ny: [q, r]\nu: [v]\nw: [d]\nf_x: {p: v}\nf_y: {q: p + v*d, r: d}\nphi: [p]",
        Undecided(Code::RegressionUndecided),
    ),
    (
        "unmeasured signal that cancels beside an output that sees nothing",
        "x: [p]\ny: [q, r, s]\nu: [v]\nw: [d]\nf_x: {p: v}\nf_y: {q: p + d, r: d, s: v}\nphi: [p]",
        Accepted("implicit linear instant"),
    ),
    (
        "Lorenz",
        "parameters: [s, r, b]\nassume: [b > 0]\nx: [y, z]\ny: [x]\nf_x: {y: r*x - y - x*z, z: x*y - b*z}\n\
         f_y: {x: s*(y - x)}\nphi: [y, z]",
        Accepted("gpebo dynamic linear excitation"),
    ),
];

/// All of them.
pub(super) fn rows() -> impl Iterator<Item = &'static Row> {
    TABLE.iter().chain(NON_SMOOTH).chain(IMPLICIT).chain(RELATIONS).chain(TIMED)
}

#[test]
fn verdicts() {
    let mut wrong = Vec::new();
    for (what, lines, answer) in rows() {
        let derived = derived(lines);
        let derivation = &derived.derivation;
        let has = |code: &Code| derivation.diagnostics.iter().any(|d| d.code == *code);
        let right = match answer {
            Accepted(words) => derivation.outcome == Outcome::Accepted && class(&derived) == *words,
            Rejected(code) => derivation.outcome == Outcome::Rejected && has(code),
            Undecided(code) => derivation.outcome == Outcome::Undecided && has(code),
        };
        if !right {
            let found: Vec<&str> = derivation.diagnostics.iter().map(|d| d.code.name()).collect();
            let class = if derivation.outcome == Outcome::Accepted { class(&derived) } else { String::new() };
            wrong.push(format!("{what}: {:?} {class} {found:?}", derivation.outcome));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

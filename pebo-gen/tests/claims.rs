//! Small plants for every verdict on every claim.

use pebo_gen::analysis::{Class, Equilibrium, Excitation, Fundamental, Outcome, RegressionKind, Verdict};
use pebo_gen::cas::asks::Want;
use pebo_gen::cas::facts::Relation;
use pebo_gen::cas::{Expr, Symbol};
use pebo_gen::report::summary;
use pebo_gen::source::{Code, Source};
use pebo_gen::{Derived, derive};

fn derived(lines: &str) -> Derived {
    let text = format!("model: m\n{lines}\n");
    derive(&Source::new("m", text.as_str()).expect("a text")).unwrap_or_else(|d| panic!("{lines}: {}", d[0].message))
}

/// What is expected of a plant: every claim proved, or the code of the first refusal.
enum Answer {
    Accepted(&'static str),
    Rejected(Code),
    Undecided(Code),
}
use Answer::{Accepted, Rejected, Undecided};

/// The class of an accepted derivation in a few words.
fn class(derived: &Derived) -> String {
    let derivation = &derived.derivation;
    let regression = derivation.regression.result.as_ref().expect("a regression");
    let kind = match regression.kind {
        RegressionKind::Dynamic => "dynamic",
        RegressionKind::Static => "static",
        RegressionKind::Implicit => "implicit",
    };
    let linear = if regression.is_linear(&derived.plant) { "linear" } else { "over-parameterised" };
    let cascade = if derivation.class == Class::Pebo { "" } else { "gpebo " };
    let excitation = match derivation.identifiability.result.as_ref().expect("identifiability").kind {
        Excitation::Instant => "instant",
        Excitation::Excitation => "excitation",
        Excitation::Never => "never",
    };
    format!("{cascade}{kind} {linear} {excitation}")
}

const TABLE: &[(&str, &str, Answer)] = &[
    // Rates of the output as functions of z = x, with x' = u.
    ("affine", "x: [x]\ny: [y]\nu: [u]\nf_x: {x: u}\nf_y: {y: 2*x + y}\nphi: [x]", Accepted("dynamic linear instant")),
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
    ("tanh", "x: [x]\ny: [y]\nu: [u]\nf_x: {x: u}\nf_y: {y: tanh(x)}\nphi: [x]", Rejected(Code::RegressionNonlinear)),
    (
        "gaussian",
        "x: [x]\ny: [y]\nu: [u]\nf_x: {x: u}\nf_y: {y: exp(-x^2)}\nphi: [x]",
        Rejected(Code::RegressionNonlinear),
    ),
    (
        "rational",
        "x: [x]\ny: [y]\nu: [u]\nf_x: {x: u}\nf_y: {y: 1/(1 + x^2)}\nphi: [x]",
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
    (
        "a value",
        "x: [x]\ny: [y]\nu: [u]\nf_x: {x: u}\ng_y: {y: 2*x + 1}\nphi: [x]",
        Accepted("static over-parameterised instant"),
    ),
    (
        "a value that an input moves",
        "x: [x]\ny: [y]\nu: [u]\nf_x: {x: u}\ng_y: {y: 2*x - 3*u}\nphi: [x]",
        Accepted("static over-parameterised instant"),
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
        "a square under a generalised cascade",
        "x: [a]\ny: [s]\nu: [u]\nf_x: {a: u - a}\nphi: [a]\nidentities: [s - a^2]",
        Undecided(Code::RegressionUndecided),
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
    // Many unknowns: ranks are seen at points, not by exact elimination.
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
        Undecided(Code::IdentityUndecided),
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
    // Refuted is what points of the domain show, with the same y, u and parameters.
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
    // What relates the components of phi to the outputs identifies, too.
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
    // Functions of the unknowns that are not told apart while the unknowns are.
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

#[test]
fn verdicts() {
    let mut wrong = Vec::new();
    for (what, lines, answer) in TABLE {
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

#[test]
fn a_refusal_says_what_and_how_to_mend_it() {
    for (what, lines, answer) in TABLE {
        if matches!(answer, Accepted(_)) {
            continue;
        }
        for diagnostic in &derived(lines).derivation.diagnostics {
            assert!(diagnostic.help.is_some(), "{what}: {}", diagnostic.message);
            assert!(
                !diagnostic.primary.text.is_empty() || !diagnostic.notes.is_empty(),
                "{what}: {}",
                diagnostic.message
            );
        }
    }
}

#[test]
fn a_witness_is_a_point_where_the_residual_is_not_zero() {
    let plant = derived("x: [x]\ny: [y]\nu: [u]\nparameters: {g: 3}\nf_x: {x: u - g*x^2}\nf_y: {y: u}\nphi: [x]");
    let cascade = plant.derivation.cascade.result.as_ref().expect("a residual");
    let witness = cascade.witness.as_ref().expect("a witness");
    let value = |name: &str| {
        let symbol = plant.plant.arena.symbol(name);
        let (_, value) = witness.point.iter().find(|(s, _)| *s == symbol).expect("a coordinate");
        plant.plant.arena.as_number(*value).expect("a rational coordinate").to_f64()
    };
    assert_eq!(plant.plant.arena.print(cascade.residual[0]), "-g*x^2");
    let again = -value("g") * value("x") * value("x");
    // A product of small rationals, up to the rounding of two multiplications.
    assert!((again - witness.bounds.0).abs() < 1e-12 && (again - witness.bounds.1).abs() < 1e-12);
    assert!((value("g") - 3.0).abs() < f64::EPSILON);
}

/// Two points of the domain, which differ in x alone.
#[test]
fn a_refutation_compares_points_of_the_domain() {
    let plant = derived("x: [p]\ny: [y]\nu: [u]\nassume: [p > 3, u > 1]\nf_x: {p: u - p^2}\nf_y: {y: u}\nphi: [p]");
    let cascade = plant.derivation.cascade.result.as_ref().expect("a residual");
    let compared = cascade.witness.as_ref().and_then(|witness| witness.compared.as_ref()).expect("two points");
    let [here, there] = compared.points.as_slice() else { panic!("{compared:?}") };
    let value = |point: &[(Symbol, Expr)]| plant.plant.arena.as_number(point[0].1).expect("a rational").to_f64();
    let (here, there, u) = (value(here), value(there), value(&compared.known));
    assert!(here > 3.0 && there > 3.0 && u > 1.0);
    // The values are of small rationals, up to rounding.
    for (p, (low, high)) in [here, there].into_iter().zip(compared.values.iter().copied()) {
        let rate = u - p * p;
        assert!((rate - low).abs() < 1e-12 * rate.abs() && (rate - high).abs() < 1e-12 * rate.abs());
    }
    let said = plant.derivation.diagnostics[0].notes.join("\n");
    assert!(said.contains("z1' is about") && said.contains("with the same u = "), "{said}");
}

#[test]
fn what_builds_on_a_failed_claim_is_skipped() {
    let plant = derived("x: [x]\ny: [y]\nu: [u]\nf_x: {x: u - x}\nf_y: {y: x*y}\nphi: [x*y]");
    assert_eq!(plant.derivation.cascade.verdict, Verdict::Refuted);
    assert_eq!(plant.derivation.regression.verdict, Verdict::Skipped);
    assert_eq!(plant.derivation.identifiability.verdict, Verdict::Skipped);
}

#[test]
fn conditions_are_listed_unless_the_assumptions_discharge_them() {
    let remaining = |assume: &str| {
        let plant = derived(&format!(
            "x: [x]\ny: [y, r]\nu: [u]\nparameters: {{m: 2, k: null}}\nassume: [{assume}]\n\
             f_x: {{x: u/(m*k*r^2)}}\nf_y: {{y: x*sqrt(r) + r/r, r: u}}\nphi: [x]"
        ));
        let arena = &plant.plant.arena;
        let shown = |(e, relation): &(_, Relation)| format!("{} {relation:?}", arena.print(*e));
        plant.derivation.conditions.iter().map(shown).collect::<Vec<_>>()
    };
    // m has a value, so its sign is known; the cancelled r of r/r is remembered.
    assert_eq!(remaining("k > 0"), ["r Positive"]);
    assert_eq!(remaining("k != 0, r >= 0"), ["r NonZero"]);
    assert_eq!(remaining("k < 0, r > 0"), Vec::<String>::new());
}

/// No rule of algebra knows the sign of `u^3 - u + exp(-u)`; enclosures over the assumed box do.
#[test]
fn conditions_are_discharged_by_enclosures_over_the_assumed_box() {
    let remaining = |assume: &str| {
        let plant = derived(&format!(
            "x: [x]\ny: [y]\nu: [u]\nassume: [{assume}]\n\
             f_x: {{x: sqrt(u^3 - u + exp(-u))}}\nf_y: {{y: x*(2 + sin(3*u))}}\nphi: [x]"
        ));
        plant.derivation.conditions.len()
    };
    assert_eq!(remaining("0 < u < 1"), 0);
    // At u = -2 the radicand is 1.4, at u = -3 it is -3.9.
    assert_eq!(remaining("-3 < u < 1"), 1);
    assert_eq!(remaining("u > 0"), 1);
}

/// `sqrt(x)^2` is x only where it exists: a point with a negative x must not count against the claim.
#[test]
fn points_without_a_value_refute_nothing() {
    let plant = derived("x: [p]\ny: [x]\nu: [u]\nf_x: {p: u + p*(sqrt(x)^2 - abs(x))}\nf_y: {x: p}\nphi: [p]");
    assert_eq!(plant.derivation.outcome, Outcome::Accepted);
    let conditions: Vec<String> =
        plant.derivation.conditions.iter().map(|(e, r)| format!("{} {r:?}", plant.plant.arena.print(*e))).collect();
    assert_eq!(conditions, ["x NonNegative"]);
}

/// A root can vanish: what is divided by it stays a condition.
#[test]
fn a_root_below_a_fraction_bar_is_a_condition() {
    let plant = derived("x: [p]\ny: [r]\nu: [u]\nassume: [r >= 0]\nf_x: {p: u/sqrt(r)}\nf_y: {r: p}\nphi: [p]");
    let conditions: Vec<String> =
        plant.derivation.conditions.iter().map(|(e, r)| format!("{} {r:?}", plant.plant.arena.print(*e))).collect();
    assert_eq!(conditions, ["r NonZero"]);
}

/// Only the component that fits neither cascade is refused, and the other class is named where it would do.
#[test]
fn a_refusal_is_about_what_fits_neither_cascade() {
    let both = derived("x: [a, b]\ny: [y]\nu: [u]\nf_x: {a: u - a, b: a*b}\nf_y: {y: a + b}\nphi: [a, b]");
    let said: Vec<&str> = both.derivation.diagnostics.iter().map(|d| &*d.message).collect();
    assert_eq!(said.len(), 1, "{said:?}");
    assert!(said[0].contains("component 2"), "{said:?}");
    let plain = derived("x: [a]\ny: [y]\nu: [u]\nclass: pebo\nf_x: {a: u - a}\nf_y: {y: a}\nphi: [a]");
    assert!(plain.derivation.diagnostics[0].notes.iter().any(|note| note.contains("without `class: pebo`")));
}

/// A lambda of three components, what becomes of Psi, and of what.
const MATRICES: &[(&str, &str, Fundamental)] = &[
    // Energy, also where it is only semidefinite.
    ("0, 0, 0; 0, 0, 0; 0, 0, 0", "stands still", Fundamental::Bounded { fades: false }),
    ("-v^2, 0, 0; 0, 0, 0; 0, 0, -exp(v)", "semidefinite", Fundamental::Bounded { fades: false }),
    ("0, v, -p; -v, 0, u; p, -u, 0", "turns", Fundamental::Bounded { fades: false }),
    ("-k, v, 0; -v, -m, 0; 0, 0, 0", "dies out in part", Fundamental::Bounded { fades: true }),
    ("-k, v, 0; -k*v, -m, 0; 0, 0, -v^4", "turns with weights", Fundamental::Bounded { fades: true }),
    // Flows.
    ("-k - m, 1, 0; k, -2, m; 0, 1, -m", "flows with a loss", Fundamental::Bounded { fades: true }),
    ("-k, 1, 0; k, -2, m; 0, 1, -m", "flows without a loss", Fundamental::Bounded { fades: false }),
    ("-k, 1, 0; k, -1, m; 0, 1, -m", "flows with a source", Fundamental::Grows),
    // Hurwitz.
    ("0, k, 0; -k, -m, k; 0, 0, 0", "a damped spring with a load", Fundamental::Bounded { fades: true }),
    ("0, 1, 0; 0, 0, 1; -1, -2, -1", "all roots to the left", Fundamental::Bounded { fades: true }),
    ("0, 1, 0; 0, 0, 1; -3, -2, -1", "a pair to the right", Fundamental::Grows),
    ("m, -2*k, 0; m, -m, 0; 0, 0, 0", "signs say nothing", Fundamental::NotShown),
    ("1, -2, 0; 1, -1, 0; 0, 0, 0", "an oscillation", Fundamental::Bounded { fades: false }),
    ("0, 1, 0; k, 0, 0; 0, 0, -m", "a saddle", Fundamental::Grows),
    // Blocks that feed others.
    ("-k, -m, 0; 0, 0, 0; 0, 0, 0", "fed by a constant", Fundamental::Bounded { fades: true }),
    ("0, 0, 0; 0, -k, 0; 1, m, 0", "integrates a constant", Fundamental::Grows),
    ("0, k, 0; 0, -m, 0; 0, 0, 0", "integrates what dies out", Fundamental::Bounded { fades: true }),
    ("0, k, 0; 0, 0, 0; 0, 0, -m", "a double integrator", Fundamental::Grows),
    ("-k, v, 0; 0, 0, 0; 0, 0, 0", "fed through a signal", Fundamental::NotShown),
    ("-v^2, 1, 0; 0, -k, 0; 0, 0, -k", "semidefinite, fed by what dies out", Fundamental::Bounded { fades: true }),
    ("-v^2, 1, 0; 0, 0, 0; 0, 0, 0", "semidefinite, fed by a constant", Fundamental::NotShown),
    // The trace.
    ("k, v, u; u, 0, v; p, v, 0", "a positive trace", Fundamental::Grows),
    ("v, 0, 0; 0, 0, 0; 0, 0, 0", "a signal of any sign", Fundamental::NotShown),
    ("v^2, 0, 0; 0, 0, 0; 0, 0, 0", "a signal that may vanish", Fundamental::NotShown),
];

#[test]
fn boundedness_of_the_fundamental_matrix_is_shown_or_not_and_never_a_reason_to_refuse() {
    for (matrix, what, fate) in MATRICES {
        let rates: Vec<String> = matrix
            .split(';')
            .zip(["a", "b", "c"])
            .map(|(row, name)| {
                let terms: Vec<String> =
                    row.split(',').zip(["a", "b", "c"]).map(|(e, z)| format!("({e})*{z}")).collect();
                format!("{name}: {}", terms.join(" + "))
            })
            .collect();
        let plant = derived(&format!(
            "x: [a, b, c]\ny: [p, q, r]\nu: [u, v]\nparameters: [k, m]\nassume: [k > 0, m > 0]\nclass: gpebo\n\
             f_x: {{{}}}\nf_y: {{p: a, q: b, r: c}}\nphi: [a, b, c]",
            rates.join(", ")
        ));
        assert_eq!(plant.derivation.outcome, Outcome::Accepted, "{what}: {matrix}");
        assert_eq!(
            plant.derivation.cascade.result.as_ref().and_then(|c| c.fundamental),
            Some(*fate),
            "{what}: {matrix}"
        );
    }
}

/// Where a plain cascade is near, it is offered, and only there.
#[test]
fn a_mend_to_a_plain_cascade_is_offered_beside_a_generalised_one() {
    let mend = |rates: &str| {
        let plant = derived(&format!(
            "x: [a, b]\ny: [p, q]\nu: [u]\nparameters: [k]\nf_x: {{a: u - 2*a, b: k*u}}\n{rates}\nphi: [a, b]"
        ));
        let mend = plant.derivation.cascade.result.as_ref().and_then(|c| c.mend.clone());
        mend.map(|mend| mend.iter().map(|e| plant.plant.arena.print(*e)).collect::<Vec<_>>())
    };
    assert_eq!(mend("f_y: {p: a + u, q: b}").expect("a mend"), ["2*p + a", "b"]);
    assert_eq!(mend("f_y: {p: u*a, q: b}"), None);
}

/// Where the claims hold: what is listed, for plants whose formulas have no value, or no derivative, somewhere.
const LISTED: &[(&str, &str, Outcome, &[&str])] = &[
    (
        "a root is not differentiated at zero",
        "x: [p]\ny: [q]\nassume: [p >= 0]\nf_x: {p: -sqrt(p)}\nf_y: {q: sqrt(p)}\nphi: [sqrt(p)]",
        Outcome::Accepted,
        &["p > 0"],
    ),
    (
        "nor is one behind a definition",
        "define: {level: sqrt(p), twice: 2*level}\nx: [p]\ny: [q]\nassume: [p >= 0]\nf_x: {p: -sqrt(p)}\n\
         f_y: {q: sqrt(p)}\nphi: [twice]",
        Outcome::Accepted,
        &["p > 0"],
    ),
    (
        "a power above one is",
        "x: [p]\ny: [q]\nu: [v]\nassume: [q >= 0]\nf_x: {p: v - 3/2*sqrt(q)*p}\nf_y: {q: p}\nphi: [p + q^(3/2)]",
        Outcome::Accepted,
        &[],
    ),
    (
        "what a derived left inverse divides by",
        "x: [p]\ny: [q, r]\nu: [v, w]\nf_x: {p: v - p*w}\nf_y: {q: q*w, r: p}\nphi: [p*q]",
        Outcome::Accepted,
        &["q != 0"],
    ),
    (
        "and what a given one divides by, each factor once",
        "x: [p]\ny: [q, r]\nu: [v]\nf_x: {p: v}\nf_y: {q: p*r, r: 0}\nphi: [p]\n\
         phi_left: {p: z1*(q*r - q + 1)/(q*r - q) - z1/(q*r - q)}",
        Outcome::Accepted,
        &["q != 0", "r - 1 != 0"],
    ),
    (
        "an excluded denominator is not listed",
        "x: [p]\ny: [q, r]\nu: [v, w]\nassume: [q < 0]\nf_x: {p: v - p*w}\nf_y: {q: q*w, r: p}\nphi: [p*q]",
        Outcome::Accepted,
        &[],
    ),
    (
        "nor one that is never zero",
        "x: [p]\ny: [q, r]\nu: [v]\nf_x: {p: v/(1 + r^2) + v/cosh(q)}\nf_y: {q: p/(2 + sin(q)), r: p}\nphi: [p]",
        Outcome::Accepted,
        &[],
    ),
    (
        "a tangent is asked for its cosine",
        "x: [p]\ny: [q]\nu: [v]\nf_x: {p: v}\nf_y: {q: p}\nphi: [p]\nphi_left: {p: z1 + tan(q) - sin(q)/cos(q)}",
        Outcome::Accepted,
        &["cos(q) != 0"],
    ),
    (
        "a normal form does not divide by what the author does not",
        "x: [p]\ny: [q, s]\nu: [v]\nassume: [q > 0]\nf_x: {p: v}\nf_y: {q: 0, s: p*q}\nphi: [p*(1 + sqrt(q))]",
        Outcome::Accepted,
        &[],
    ),
    (
        "nor does it in h",
        "x: [p]\ny: [q, w]\nu: [v]\nf_x: {p: v - w*sqrt(1 + w^2)/(1 + sqrt(1 + w^2)) - p}\nf_y: {q: p, w: v}\n\
         phi: [p + q]",
        Outcome::Accepted,
        &[],
    ),
    (
        "the extension may be anywhere, whatever the range of phi",
        "x: [p]\ny: [q]\nu: [v]\nassume: [0.1 < p, p < 3]\nf_x: {p: v/sin(p)}\nf_y: {q: cos(p)}\nphi: [cos(p)]",
        Outcome::Accepted,
        &[],
    ),
];

#[test]
fn conditions_are_those_of_every_formula() {
    for (what, lines, outcome, expected) in LISTED {
        let found = derived(lines);
        assert_eq!(found.derivation.outcome, *outcome, "{what}: {:?}", found.derivation.diagnostics);
        let arena = &found.plant.arena;
        let listed: Vec<String> =
            found.derivation.conditions.iter().map(|(e, r)| format!("{} {}", arena.print(*e), r.sign())).collect();
        assert_eq!(listed, *expected, "{what}");
        if let (Outcome::Accepted, Some(regression)) = (outcome, &found.derivation.regression.result) {
            let rows = regression.phi_1.iter().flatten().chain(&regression.phi_0).copied();
            let rows: Vec<_> = rows.collect();
            for (part, _) in arena.asks(&rows, Want::Value) {
                let used = arena.symbols_of(&[part]);
                assert!(!used.iter().any(|s| found.plant.is_of_extension(*s)), "{what}: {}", arena.print(part));
            }
        }
    }
}

/// A plant does not rest where a formula of its observer has no value.
#[test]
fn an_operating_point_meets_the_conditions() {
    let found = derived("x: [p]\ny: [q, r]\nu: [v, w]\nf_x: {p: v - p*w}\nf_y: {q: q*w, r: p}\nphi: [p*q]");
    if let Some(Equilibrium::At(point)) = found.derivation.operating_point(&found.plant) {
        let arena = &found.plant.arena;
        let zero = point.values.iter().find(|(s, value)| arena.name(*s) == "q" && arena.is_zero(*value));
        assert!(zero.is_none());
    }
}

/// A parameter that is given as zero is zero: it multiplies to nothing, and nothing is divided by it.
#[test]
fn a_parameter_given_as_zero_is_zero() {
    let plant = |value: &str| {
        format!("parameters: {{a: {value}}}\nx: [p]\ny: [q]\nu: [v]\nf_x: {{p: v}}\nf_y: {{q: a*p}}\nphi: [a*p]")
    };
    assert_eq!(derived(&plant("0")).derivation.left_inverse.verdict, Verdict::Refuted);
    assert_eq!(derived(&plant("2")).derivation.outcome, Outcome::Accepted);
    let free = derived(&plant("null"));
    let arena = &free.plant.arena;
    let listed: Vec<String> = free.derivation.conditions.iter().map(|(e, _)| arena.print(*e)).collect();
    assert_eq!((free.derivation.outcome, listed), (Outcome::Accepted, vec!["a".to_owned()]));
    let divided = "model: m\nparameters: {a: 0}\nx: [p]\ny: [q]\nu: [v]\nf_x: {p: v/a}\nf_y: {q: p}\nphi: [p]\n";
    let refused = derive(&Source::new("m", divided).expect("a text")).expect_err("a refusal");
    assert_eq!(refused[0].code, Code::DivisionByZero);
}

#[test]
fn the_headline_speaks_of_the_claims_alone() {
    let said = |lines: &str| {
        let derived = derived(lines);
        summary(&derived.plant, &derived.derivation)
    };
    let undecided =
        said("x: [x]\ny: [y]\nu: [u]\nf_x: {x: y + sin(y) - u*y}\nf_y: {y: x + exp(y)}\nphi: [x]\nassume: [y > 0]");
    assert!(undecided.starts_with("m: accepted: all four claims are proved\n"), "{undecided}");
    // An open remark is no open claim: it stands under no verdict.
    assert!(undecided.contains("\n  operating point           "), "{undecided}");
    let conditional = said("x: [x]\ny: [y]\nu: [u]\nf_x: {x: u}\nf_y: {y: x/u}\nphi: [x]");
    let headline = "m: accepted: all four claims are proved where the conditions below hold\n";
    assert!(conditional.starts_with(headline), "{conditional}");
    assert!(conditional.contains("\n  conditions                u != 0\n"), "{conditional}");
}

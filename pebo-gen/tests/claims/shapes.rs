//! Derived formulas keep the author's form, so that they compute with the digits and the range of the author's.

use pebo_gen::Derived;

use super::derived;

/// The plant, and of its results the parts that the author's shape decides: `h`, Lambda, the left inverse, `phi_0`.
const SHAPES: &[(&str, &str, &[&str])] = &[
    (
        "a power of a shifted output is not expanded",
        "x: [p]\ny: [T]\nu: [v]\nf_x: {p: v - 3*(T - 300)^2*p}\nf_y: {T: p}\nphi: [p + (T - 300)^3]",
        &["h: v", "p: z1 - (T - 300)^3", "phi_0: chi1 - (T - 300)^3"],
    ),
    (
        "nor by a parameter",
        "parameters: {q0: 1000, k: 2}\nx: [p]\ny: [q]\nu: [v]\nf_y: {q: p}\nphi: [p]\n\
         f_x: {p: v - k*(q - q0)^2*p/(1 + (q - q0)^2) - (q - q0)^4}",
        &["h: v - (q - q0)^4", "lambda: -k*(q - q0)^2/((q - q0)^2 + 1)", "p: z1", "phi_0: xi1"],
    ),
    (
        "nor where an affine rate is written over the transform",
        "x: [p]\ny: [q]\nu: [v]\nf_x: {p: v - (q - 1000)^8}\nf_y: {q: p*(1 + (q - 1000)^2)}\n\
         phi: [p + (q - 1000)^3]",
        &[
            "h: v - (q - 1000)^5*(3*(q - 1000)^2 + (q - 1000)^3 + 3)",
            "lambda: 3*(q - 1000)^2*((q - 1000)^2 + 1)",
            "p: z1 - (q - 1000)^3",
            "phi_0: ((q - 1000)^2 + 1)*(xi1 - (q - 1000)^3)",
        ],
    ),
    (
        "an exponential of a sum is one",
        "x: [p]\ny: [q]\nu: [v]\nassume: [p > 0]\nf_x: {p: (v + 2*q*log(1 + p))*(1 + p)}\nf_y: {q: log(1 + p)}\n\
         phi: [log(1 + p) - q^2]",
        &["h: v", "p: exp(z1 + q^2) - 1", "phi_0: chi1 + q^2"],
    ),
    (
        "a square of a sum is one",
        "x: [p]\ny: [q]\nu: [v]\nassume: [p > 0]\nf_x: {p: (v + 2*q*sqrt(1 + p^2))*sqrt(1 + p^2)/p}\n\
         f_y: {q: sqrt(1 + p^2)}\nphi: [sqrt(1 + p^2) - q^2]",
        &["h: v", "p: sqrt((z1 + q^2)^2 - 1)", "phi_0: chi1 + q^2"],
    ),
    (
        "a component that is the state is the state",
        "x: [a]\ny: [q]\nu: [v]\nassume: [a > 0]\nf_x: {a: v}\nf_y: {q: a^2}\nphi: [a^2, a]",
        &["h: 0", "h: v", "lambda: 0", "lambda: 2*v", "lambda: 0", "lambda: 0", "a: z2", "phi_0: xi1"],
    ),
    (
        "a sign has a value where its argument has none to divide by",
        "x: [p]\ny: [q]\nu: [v]\nf_x: {p: v}\nf_y: {q: p}\nphi: [p + sign(q)]",
        &["h: v", "p: z1 - sign(q)", "phi_0: chi1 - sign(q)"],
    ),
    (
        "a transform that is searched for has the powers of the rates",
        "parameters: {q0: 5000, k: 0.01}\nx: [p]\ny: [q]\nu: [v]\nf_x: {p: v - k*(1 + (q - q0)^4)*p}\nf_y: {q: p}",
        &["h: v", "p: z1 - k*(q + (q - q0)^5/5)", "phi_0: chi1 - k*(q + (q - q0)^5/5)"],
    ),
];

/// The formulas of a derivation in a fixed order.
fn shown(derived: &Derived) -> Vec<String> {
    let (arena, derivation) = (&derived.plant.arena, &derived.derivation);
    let cascade = derivation.cascade.result.as_ref().expect("a cascade");
    let inverse = derivation.left_inverse.result.as_ref().expect("a left inverse");
    let regression = derivation.regression.result.as_ref().expect("a regression");
    let all = |name: &str, formulas: &[_]| -> Vec<String> {
        formulas.iter().map(|formula| format!("{name}: {}", arena.print(*formula))).collect()
    };
    let lambda: Vec<_> = cascade.lambda.iter().flatten().flatten().copied().collect();
    let states = inverse.x.iter().map(|(state, formula)| format!("{}: {}", arena.name(*state), arena.print(*formula)));
    let first = [all("h", &cascade.h), all("lambda", &lambda)].concat();
    first.into_iter().chain(states).chain(all("phi_0", &regression.phi_0)).collect()
}

#[test]
fn results_keep_the_shape_of_the_written_formulas() {
    for (what, lines, expected) in SHAPES {
        assert_eq!(shown(&derived(lines)), *expected, "{what}");
    }
}

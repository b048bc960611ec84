//! The generalised cascade: the fate of its fundamental matrix, and the nearest plain cascade.

use pebo_gen::analysis::{Fundamental, Outcome};

use super::derived;

/// A lambda of three components, its name, and the fate of Psi.
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
    ("-1, -8, 0; 0, -1, 8; 8, 0, -1", "a cycle one way round", Fundamental::Grows),
    ("m, -2*k, 0; m, -m, 0; 0, 0, 0", "signs say nothing", Fundamental::Undecided),
    ("1, -2, 0; 1, -1, 0; 0, 0, 0", "an oscillation", Fundamental::Bounded { fades: false }),
    ("0, 1, 0; k, 0, 0; 0, 0, -m", "a saddle", Fundamental::Grows),
    // Blocks that feed others.
    ("-k, -m, 0; 0, 0, 0; 0, 0, 0", "fed by a constant", Fundamental::Bounded { fades: true }),
    ("0, 0, 0; 0, -k, 0; 1, m, 0", "integrates a constant", Fundamental::Grows),
    ("0, k, 0; 0, -m, 0; 0, 0, 0", "integrates what dies out", Fundamental::Bounded { fades: true }),
    ("0, k, 0; 0, 0, 0; 0, 0, -m", "a double integrator", Fundamental::Grows),
    ("-k, v, 0; 0, 0, 0; 0, 0, 0", "fed through a signal", Fundamental::Undecided),
    ("-v^2, 1, 0; 0, -k, 0; 0, 0, -k", "semidefinite, fed by what dies out", Fundamental::Bounded { fades: true }),
    ("-v^2, 1, 0; 0, 0, 0; 0, 0, 0", "semidefinite, fed by a constant", Fundamental::Undecided),
    // The trace.
    ("k, v, u; u, 0, v; p, v, 0", "a positive trace", Fundamental::Grows),
    ("v, 0, 0; 0, 0, 0; 0, 0, 0", "a signal of any sign", Fundamental::Undecided),
    ("v^2, 0, 0; 0, 0, 0; 0, 0, 0", "a signal that may vanish", Fundamental::Undecided),
];

#[test]
fn boundedness_of_the_fundamental_matrix_is_proved_or_not_and_never_a_reason_to_refuse() {
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

/// A plain cascade is offered if one is near, and only then.
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

/// Only the component that fits neither cascade is refused, and the other class is named where it would do.
#[test]
fn a_refusal_names_the_terms_that_fit_neither_cascade() {
    let both = derived("x: [a, b]\ny: [y]\nu: [u]\nf_x: {a: u - a, b: a*b}\nf_y: {y: a + b}\nphi: [a, b]");
    let said: Vec<&str> = both.derivation.diagnostics.iter().map(|d| &*d.message).collect();
    assert_eq!(said.len(), 1, "{said:?}");
    assert!(said[0].contains("component 2"), "{said:?}");
    let plain = derived("x: [a]\ny: [y]\nu: [u]\nclass: pebo\nf_x: {a: u - a}\nf_y: {y: a}\nphi: [a]");
    assert!(plain.derivation.diagnostics[0].notes.iter().any(|note| note.contains("without `class: pebo`")));
}

//! One budget for a model: a longer derivation is undecided and names the phase, whatever the machine.
#![cfg(feature = "yaml")]

use std::cell::Cell;

use pebo_cas::Budget;
use pebo_gen::analysis::{Outcome, Verdict};
use pebo_gen::source::{Code, Diagnostic, Source};
use pebo_gen::{Derived, derive_within};

/// As many steps as a fast machine does in a fraction of a second.
const SECONDS: f64 = 0.1;

fn derived(text: &str, budget: Budget) -> Result<Derived, Vec<Diagnostic>> {
    derive_within(&Source::new("m.yaml", text).expect("a text"), budget)
}

/// The phase that the budget ended in, if it did.
fn phase(outcome: &Result<Derived, Vec<Diagnostic>>) -> Option<String> {
    let diagnostics = match outcome {
        Ok(derived) => &derived.derivation.diagnostics,
        Err(diagnostics) => diagnostics,
    };
    let reached = diagnostics.iter().find(|diagnostic| diagnostic.code == Code::LimitReached)?;
    reached.message.split_once("reached in ").map(|(_, phase)| phase.to_owned())
}

fn plant(f_x: &str, f_y: &str, phi: &str) -> String {
    format!("model: m\nx: [p]\ny: [q]\nu: [v]\nf_x: {{p: \"{f_x}\"}}\nf_y: {{q: \"{f_y}\"}}\nphi: [\"{phi}\"]\n")
}

/// A formula put into itself.
fn nested(first: &str, level: &str, times: usize) -> String {
    (0..times).fold(first.to_owned(), |inner, _| level.replace('_', &inner))
}

/// A class whose matrices have a parameter of its own in every entry.
fn matrices(size: usize) -> String {
    let list = |name: &str| (0..size).map(|i| format!("{name}{i}")).collect::<Vec<_>>().join(", ");
    let matrix =
        |name: &str| (0..size).map(|i| format!("[{}]", list(&format!("{name}{i}_")))).collect::<Vec<_>>().join(", ");
    let [a, b] = ["a", "b"].map(matrix);
    format!(
        "model: m\nparameters: [{}]\nx: [{}]\ny: [{}]\nlti: {{A11: [{a}], A12: [{a}], A21: [{b}], A22: [{b}]}}\n",
        format!("{a}, {b}").replace(['[', ']'], ""),
        list("x"),
        list("y")
    )
}

/// Functions times polynomials, each of whose derivatives is many times as long as the one before.
fn products() -> String {
    [
        "model: m",
        "x: [a, b, c]",
        "y: [v, q]",
        "u: [d, m, n]",
        "f_x: {a: 3*sin(v)*sin(d) + exp(d), b: m*m^2, c: sin(q)}",
        "g_y: {v: m^2*sin(d + d)*exp(2*a) - cos(a)*sin(c)*b, q: cos(2*d)*n^3 + exp(c)*n*m^2}",
        "phi: [a, b, c]",
    ]
    .join("\n")
}

#[test]
fn natural_models_that_take_long_are_undecided_and_name_the_phase() {
    let powers = "(q + v + 1)^60*(q - v + 2)^60*(q*v + 3)^60";
    let tangents = format!("v*{}", nested("q", "tan(_ + v)", 18));
    let roots = format!("p*({})", nested("q", "sqrt(1 + (_)^2) + abs(q)", 20));
    for (what, text, expected) in [
        ("long powers", plant(powers, "p + q", "p"), &["the cascade"][..]),
        ("nested tangents", plant(&tangents, "p", "p"), &["the cascade"]),
        ("nested roots", plant("v", &roots, "p"), &["the regression", "identifiability"]),
        ("a matrix of parameters", matrices(8), &["the expansion of the class"]),
        ("products of functions", products(), &["identifiability"]),
    ] {
        let outcome = derived(&text, Budget::of_seconds(SECONDS));
        let phase = phase(&outcome).unwrap_or_default();
        assert!(expected.contains(&phase.as_str()), "{what}: {phase}");
        if let Ok(derived) = outcome {
            assert_eq!(derived.derivation.outcome, Outcome::Undecided, "{what}");
            assert!(derived.plant.arena.budget().is_exhausted(), "{what}");
        }
    }
}

/// A plant of which a symmetry proves that no observer recovers its states, whatever else the search had no time for.
#[test]
fn a_rejection_is_never_said_to_be_for_want_of_time() {
    let scaled =
        "model: m\nx: [mx, my, s, b]\ny: [h]\nu: [om]\nf_x: {mx: om*my, my: -om*mx, s: 0, b: 0}\ng_y: {h: s*mx + b}";
    let mut rejected = 0;
    for hundredths in 12..=30 {
        let outcome = derived(scaled, Budget::of_seconds(f64::from(hundredths) / 100.0));
        let limited = phase(&outcome);
        let Ok(derived) = outcome else { panic!("{limited:?}") };
        let is_rejected = derived.derivation.outcome == Outcome::Rejected;
        assert_eq!(is_rejected, limited.is_none(), "{hundredths}: {limited:?}");
        rejected += usize::from(is_rejected);
    }
    assert!(rejected > 0);
}

/// Whatever the number of steps, a model is accepted or undecided, and proved claims remain proved.
#[test]
fn a_budget_never_makes_a_true_claim_false() {
    let models = ["cuk", "motor"].map(|name| {
        let path = format!("{}/../models/{name}.yaml", env!("CARGO_MANIFEST_DIR"));
        std::fs::read_to_string(path).expect("a shipped model")
    });
    for text in &models {
        let (mut accepted, mut proved) = (false, 0);
        for power in 0..24 {
            let outcome = derived(text, Budget::of_seconds(2e-8 * f64::from(1 << power)));
            let reached = phase(&outcome);
            let Ok(derived) = outcome else {
                assert!(reached.is_some());
                continue;
            };
            let derivation = &derived.derivation;
            let verdicts = [
                derivation.cascade.verdict,
                derivation.left_inverse.verdict,
                derivation.regression.verdict,
                derivation.identifiability.verdict,
            ];
            assert!(!verdicts.contains(&Verdict::Refuted), "{verdicts:?} with {reached:?}");
            assert_eq!(derivation.outcome == Outcome::Accepted, reached.is_none(), "{verdicts:?} with {reached:?}");
            assert!(!accepted || reached.is_none(), "accepted with fewer steps");
            accepted = reached.is_none();
            let count = verdicts.iter().filter(|verdict| **verdict == Verdict::Proved).count();
            assert!(count >= proved, "{verdicts:?} with {reached:?}: fewer than with fewer steps");
            proved = count;
        }
        assert!(accepted);
    }
}

/// The identifiability of a target that is seen by its bearing alone takes long, and the other claims do not.
#[test]
fn claims_before_the_one_in_which_the_budget_ends_remain_proved() {
    let path = format!("{}/../tests/cases/plants/bearing_only.yaml", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(path).expect("a plant");
    let mut times = 0;
    for power in 8..24 {
        let outcome = derived(&text, Budget::of_seconds(2e-8 * f64::from(1 << power)));
        if phase(&outcome).as_deref() != Some("identifiability") {
            continue;
        }
        times += 1;
        let derivation = outcome.expect("a plant").derivation;
        let before = [derivation.cascade.verdict, derivation.left_inverse.verdict, derivation.regression.verdict];
        assert_eq!(before, [Verdict::Proved; 3], "of {power}");
    }
    assert!(times > 0, "the budget never ended there");
}

#[test]
fn a_watch_ends_it_too() {
    let looks = std::rc::Rc::new(Cell::new(0));
    let count = looks.clone();
    let budget = Budget::with_watch(1e6, move || {
        count.set(count.get() + 1);
        count.get() > 20
    });
    let tangents = format!("v*{}", nested("q", "tan(_ + v)", 18));
    let outcome = derived(&plant(&tangents, "p", "p"), budget);
    assert_eq!(phase(&outcome).as_deref(), Some("the cascade"));
    assert!(looks.get() > 20);
}

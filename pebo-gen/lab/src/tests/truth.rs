//! Noise, and a plant that differs from its model.

use crate::Overrides;
use pebo_design::source::Code;

use super::{SPRING, resolve, run, with};

fn seeded(seed: u64) -> Overrides {
    Overrides { seed: Some(seed), duration: Some(5.0), every: Some(0.01), ..Overrides::default() }
}

/// The spring with this beside its initial state.
fn spring(more: &str) -> String {
    with(SPRING, "initial: {v: 0, q: 1}", &format!("initial: {{v: 0, q: 1}}, {more}"))
}

#[test]
fn noise_is_in_the_samples_and_not_in_the_plant() {
    let noisy = spring("noise: {q: 0.5}");
    let (quiet, first, second) = (run(SPRING, &seeded(1)), run(&noisy, &seeded(1)), run(&noisy, &seeded(2)));
    let of = |trace: &crate::Trace, name: &str| trace.column(name).unwrap();
    assert_eq!(of(&quiet, "v"), of(&first, "v"));
    assert_ne!(of(&first, "q"), of(&second, "q"));
    assert_ne!(of(&first, "v_hat"), of(&quiet, "v_hat"));
    assert_eq!(first.csv(), run(&noisy, &seeded(1)).csv());
    let squares = of(&first, "q").iter().zip(of(&quiet, "q")).map(|(a, b)| (a - b).powi(2)).sum::<f64>();
    // Of 501 samples: the deviation is known within a thirtieth, and this is four times that.
    assert!(((squares / 501.0).sqrt() - 0.5).abs() < 0.07, "{squares}");
    // Of zero deviation it is none.
    assert_eq!(run(&spring("noise: {q: 0}"), &seeded(1)).csv(), quiet.csv());
}

#[test]
fn a_parameter_steps_in_the_plant_alone() {
    // From 1 s on four times as stiff: the energy v^2 + k q^2 is kept with the k of the moment. The instant is no
    // sample's.
    let trace = run(&spring("plant: {k: {0: k, 1.005: 4*k}}"), &seeded(1));
    let column = |name: &str| trace.column(name).unwrap();
    let (t, v, q) = (column("t"), column("v"), column("q"));
    let energy = |row: usize, k: f64| v[row].powi(2) + k * q[row].powi(2);
    let expected = {
        let (q, v) = ((2.0_f64 * 1.005).cos(), -2.0 * (2.0_f64 * 1.005).sin());
        v.powi(2) + 16.0 * q.powi(2)
    };
    for (row, t) in t.iter().enumerate() {
        let (found, expected) = if *t < 1.005 { (energy(row, 4.0), 4.0) } else { (energy(row, 16.0), expected) };
        assert!((found - expected).abs() < 1e-8, "{t} {found} {expected}");
    }
}

/// A constant among the states that steps, and an output given by value that a parameter and an input change.
const LEVEL: &str = "
model: level
x: [a, c]
y: [p, q]
u: [v]
parameters: {k: 2, r: 3}
f_x: {a: c - v, c: 0}
f_y: {q: k*a}
g_y: {p: a + r*v}
phi: [a, c]
observer: {estimator: least-squares, covariance: 1e4, filter: 5, rebase: 1, forgetting: 5}
simulation:
  duration: 5
  step: 0.01
  initial: {a: 1, q: 0}
  plant: {c: {0: 0.5, 2: 1.5}, r: {0: 3, 4.5: 4}}
  control: {v: 1}
";

#[test]
fn a_constant_state_steps_and_an_output_has_its_value() {
    let trace = run(LEVEL, &Overrides { every: Some(0.01), ..Overrides::default() });
    let column = |name: &str| trace.column(name).unwrap();
    let (t, a, c, p) = (column("t"), column("a"), column("c"), column("p"));
    for (row, &t) in t.iter().enumerate() {
        let late = (t - 2.0).max(0.0);
        assert!((a[row] - (1.0 - 0.5 * t + late)).abs() < 1e-9, "{}", t);
        assert!((c[row] - if t < 2.0 { 0.5 } else { 1.5 }).abs() < 1e-12, "{}", t);
        let factor = if t < 4.5 { 3.0 } else { 4.0 };
        assert!((p[row] - (a[row] + factor)).abs() < 1e-12, "{}", t);
    }
    let error = column("c_error");
    // It forgets in 0.2 s, ten times over before the other step, of a parameter that the observer does not know of.
    assert!(error[199].abs() < 1e-3 && error[200].abs() > 0.9 && error[449].abs() < 1e-2, "{error:?}");
}

/// Proofs hold for the zero of the model; the plant has the parameter all the same.
#[test]
fn a_parameter_that_is_zero_in_the_model_moves_in_the_plant() {
    let zero = with(LEVEL, "{k: 2, r: 3}", "{k: 2, r: 0}").replace("r: {0: 3, 4.5: 4}", "r: {0: 0, 4.5: 4}");
    let [zero, small] = [zero.clone(), zero.replace("r: 0}\n", "r: 1e-12}\n")].map(|text| run(&text, &seeded(1)));
    let [a, p, found] = ["a", "p", "a_hat"].map(|name| zero.column(name).unwrap());
    let t = zero.column("t").unwrap();
    for (row, t) in t.iter().enumerate() {
        let r = if *t < 4.5 { 0.0 } else { 4.0 };
        assert!((p[row] - a[row] - r).abs() < 1e-9, "{t}: {} {}", p[row], a[row]);
    }
    // The observer takes it for zero, or for next to zero.
    let other = small.column("a_hat").unwrap();
    assert!(found.iter().zip(&other).all(|(found, other)| (found - other).abs() < 1e-6));
}

#[test]
fn a_contradictory_truth_is_refused() {
    for (text, code, message) in [
        (spring("noise: {v: 1}"), Code::UnknownEntry, "`v` under `noise` is not an output of y"),
        (spring("noise: {q: -1}"), Code::NumberOutOfRange, "a standard deviation must not be negative"),
        (spring("noise: [1]"), Code::WrongShape, "expected a map from names to numbers"),
        (spring("plant: {kk: 1}"), Code::UnknownEntry, "`kk` under `plant` is not a parameter or a state of x"),
        (spring("plant: {q: 1}"), Code::UnknownEntry, "`q` under `plant` is not a parameter or a state of x"),
        (spring("plant: {k: q}"), Code::UnknownName, "`q`"),
        (spring("plant: {k: {1: 2}}"), Code::SimulationIncomplete, "`k` has no value before 1 s"),
        (spring("plant: {k: {0: 2, 0: 3}}"), Code::DuplicateKey, "`0`"),
        (spring("plant: {k: {0: 2, 2: 3, 1: 2}}"), Code::NumberOutOfRange, "not in ascending order"),
        (spring("plant: {v: 1}"), Code::SettingConflict, "`v` moves by its own rate"),
        (with(LEVEL, "{a: 1, q: 0}", "{a: 1, q: 0, c: 1}"), Code::SettingConflict, "`c` has a value of its own"),
        (with(LEVEL, "{a: 1, q: 0}", "{a: 1, q: 0, p: 1}"), Code::SettingConflict, "`p` has a value of its own"),
        (
            with(
                &with(LEVEL, "f_y: {q: k*a}", "f_y: {q: k*a, p: 2*k*a, s: k*a}"),
                "y: [p, q]\nu: [v]\nparameters: {k: 2, r: 3}",
                "y: [p, q, s]\nu: [v]\nparameters: {k: 2, r: 3}",
            )
            .replace("g_y: {p: a + r*v}", "g_y: {p: 2*s, s: p/2}"),
            Code::CircularDefinition,
            "the values of `p`, `s` need one another",
        ),
    ] {
        let found = resolve(&text, &Overrides::default()).expect_err(&text);
        let hit = found.iter().find(|d| d.code == code && d.message.contains(message));
        assert!(hit.is_some_and(|d| d.help.is_some()), "{message}: {found:#?}");
    }
}

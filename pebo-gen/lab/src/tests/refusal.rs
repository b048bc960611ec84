use crate::settings::tests::EXCHANGER;
use crate::{Failure, Overrides, Scenario};
use pebo_design::source::{Code, Diagnostic, Source, Span};

use super::{CUK, CUK_CASE_2, SPRING, resolve, with};

/// Model, part, replacement, code, message, underlined text.
const MISTAKES: &[(&str, &str, &str, Code, &str, &str)] = &[
    (SPRING, "{k: 4}", "[k]", Code::SimulationIncomplete, "parameter `k`", "k"),
    (SPRING, "duration: 10, ", "", Code::SimulationIncomplete, "no duration", "0.01"),
    (SPRING, "step: 0.01, ", "", Code::SimulationIncomplete, "no step", "10"),
    (
        SPRING,
        "step: 0.01",
        "step: 11",
        Code::NumberOutOfRange,
        "`step`, 11 s, is longer than the duration of 10 s",
        "11",
    ),
    (SPRING, "step: 0.01", "step: 1e-30", Code::SimulationTooLong, "1.000e31 samples", "1e-30"),
    (SPRING, "{v: 0, q: 1}", "{v: 0}", Code::SimulationIncomplete, "no entry for `q`", "10"),
    (SPRING, "v: 0, q: 1", "v: q, q: 1", Code::UnknownName, "`q`", "q"),
    (SPRING, "gain: 50, ", "", Code::SimulationIncomplete, "gain", "10"),
    (SPRING, "gain: 50, filter: 5", "gain: 50", Code::SimulationIncomplete, "filter", "10"),
    (SPRING, "gain: 50", "gain: [1, 2]", Code::WrongShape, "2 values", "1, 2"),
    (SPRING, "gain: 50", "estimator: kalman, gain: 50", Code::WrongChoice, "kalman", "kalman"),
    (SPRING, "gain: 50, ", "estimator: least-squares, ", Code::SimulationIncomplete, "`covariance`", "10"),
    (SPRING, "gain: 50", "estimator: drem, gain: 50", Code::SimulationIncomplete, "`regressor_gain`", "10"),
    (
        SPRING,
        "gain: 50",
        "estimator: finite-time-drem, regressor_gain: 1, gain: 50",
        Code::SimulationIncomplete,
        "`clip`",
        "10",
    ),
    (SPRING, "gain: 50", "estimator: least-squares, covariance: [1, 2]", Code::WrongShape, "2 values", "1, 2"),
    (SPRING, "gain: 50", "gain: 50, bounds: {lower: [1, 2]}", Code::WrongShape, "2 values", "1, 2"),
    (SPRING, "gain: 50", "gain: 50, bounds: {lower: 2, upper: 1}", Code::NumberOutOfRange, "unknown 1", "2"),
    (SPRING, "gain: 50", "gain: 50, within: {lower: [1, 2]}", Code::WrongShape, "2 values", "1, 2"),
    (SPRING, "gain: 50", "gain: 50, within: {lower: 2, upper: 1}", Code::NumberOutOfRange, "recovered state 1", "2"),
    (
        SPRING,
        "{gain: 50, filter: 5}",
        "{bounds: {lower: 2, upper: 1}}",
        Code::SettingConflict,
        "chooses no estimator",
        "2",
    ),
    (
        SPRING,
        "{gain: 50, filter: 5}",
        "{bounds: {upper: 1}, gate: 25}",
        Code::SettingConflict,
        "chooses no estimator",
        "1",
    ),
    (
        SPRING,
        "{gain: 50, filter: 5}",
        "{hold: zero-order}",
        Code::SettingConflict,
        "each sample by itself",
        "zero-order",
    ),
    (SPRING, "filter: 5", "window: 1025", Code::SimulationUnsupported, "1025 samples", "1025"),
    (SPRING, "filter: 5", "window: 1e300", Code::SimulationUnsupported, "1e300 samples", "1e300"),
    (CUK, "d: V_d/(V_d + E) + lambda*s/(1 + s^2)", "d: d", Code::UnknownName, "`d`", "d"),
    (CUK, "d: V_d/(V_d + E) + lambda*s/(1 + s^2)", "d: V_d/40 + i1", Code::UnknownName, "`i1`", "i1"),
    (CUK, "d: V_d/(V_d + E) + lambda*s/(1 + s^2)", "d: V_e/40", Code::UnknownName, "`V_e`", "V_e"),
    (CUK, "d: V_d/(V_d + E) + lambda*s/(1 + s^2)", "d: hat(v2)/40", Code::UnknownName, "`v2`", "hat(v2)"),
    (CUK, "hat(i3) - hat(i1))", "hat(i3) - i2)", Code::UnknownName, "`i2`", "i2"),
    (CUK, "V_d: {0: 25", "V_d: {0.1: 25", Code::SimulationIncomplete, "no value before 0.1 s", "0.1"),
    (CUK, "V_d: {0: 25", "V_d: {0: 25*v2", Code::UnknownName, "`v2`", "v2"),
    (CUK, "curves: [d]", "curves: [duty]", Code::UnknownName, "`duty`", "duty"),
    (CUK_CASE_2, "d*v2 + hat(v4))\n", "d*v2 + v4)\n", Code::UnknownName, "`v4`", "v4"),
    (CUK_CASE_2, "i1: zeta_1 + C2*gamma_1*v2", "i1: zeta_1 + hat(v4)", Code::UnknownName, "`v4`", "hat(v4)"),
    (CUK_CASE_2, "zeta_2: L3*gamma_2*i3", "zeta_2: zeta_1", Code::UnknownName, "`zeta_1`", "zeta_1"),
];

fn refusals(text: &str) -> Vec<Diagnostic> {
    resolve(text, &Overrides::default()).err().unwrap_or_default()
}

#[test]
fn a_section_that_does_not_say_enough_is_refused_with_help() {
    for (text, part, other, code, message, underlined) in MISTAKES {
        let text = with(text, part, other);
        let found = refusals(&text);
        let source = Source::new("test", text.as_str()).unwrap();
        let hit = found.iter().find(|diagnostic| diagnostic.code == *code && diagnostic.message.contains(message));
        let hit = hit.unwrap_or_else(|| panic!("{other}: {found:#?}"));
        assert_eq!(source.slice(hit.primary.span), *underlined, "{other}");
        assert!(hit.help.is_some(), "{other}");
    }
}

#[test]
fn a_parameter_without_a_value_is_reported_once() {
    assert_eq!(refusals(&with(SPRING, "{k: 4}", "[k]")).len(), 1);
}

#[test]
fn a_model_without_the_section_is_reported() {
    let text = with(SPRING, "simulation: {duration: 10, step: 0.01, initial: {v: 0, q: 1}}", "");
    let found = refusals(&text);
    assert_eq!(found.len(), 1);
    assert_eq!(found[0].code, Code::SimulationMissing);
}

#[test]
fn a_refuted_derivation_is_not_simulated() {
    let found = refusals(&with(SPRING, "{v: -k*q}", "{v: -k*q - v^2}"));
    assert!(found.iter().any(|diagnostic| diagnostic.code == Code::CascadeRefuted), "{found:?}");
}

#[test]
fn settings_of_a_call_are_refused_too() {
    let ask = |overrides: &Overrides| resolve(SPRING, overrides).err().unwrap_or_default();
    for value in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        for overrides in [
            Overrides { step: Some(value), ..Overrides::default() },
            Overrides { duration: Some(value), ..Overrides::default() },
            Overrides { every: Some(value), ..Overrides::default() },
        ] {
            let found = ask(&overrides);
            assert_eq!(
                (found[0].code, found[0].primary.span),
                (Code::NumberOutOfRange, Span::NOWHERE),
                "{overrides:?}"
            );
        }
    }
    let found = ask(&Overrides { feedback: Some("obsever".to_owned()), ..Overrides::default() });
    assert_eq!(found[0].code, Code::WrongChoice);
    assert_eq!(found[0].help.as_deref(), Some("did you mean `observer`?"));
    let found = ask(&Overrides { every: Some(11.0), ..Overrides::default() });
    assert_eq!(found[0].code, Code::NumberOutOfRange);
    let found = ask(&Overrides { step: Some(1e-11), ..Overrides::default() });
    assert_eq!(found[0].code, Code::SimulationTooLong);
    let found = ask(&Overrides { step: Some(1e-6), every: Some(1e-6), ..Overrides::default() });
    assert_eq!(found[0].code, Code::SimulationTooLong);
}

fn failure(scenario: &Scenario) -> Failure {
    let failure = scenario.run().unwrap_err();
    let diagnostic = scenario.explain(&failure);
    assert_eq!(diagnostic.code, Code::SimulationFailed);
    assert!(diagnostic.help.is_some());
    failure
}

#[test]
fn a_run_that_cannot_go_on_says_where_and_when() {
    // The control law leaves its domain as soon as V_d is below 25.
    let text = with(CUK, "d: V_d/(V_d + E) + lambda*s/(1 + s^2)", "d: sqrt(V_d - 25)/10");
    let scenario = resolve(&text, &Overrides { step: Some(1e-4), ..Overrides::default() }).unwrap();
    assert_eq!(failure(&scenario), Failure::NotFinite { name: "d".to_owned(), at: 0.4 });
    // An escape to infinity at t = 1.
    let text = with(&with(SPRING, "{v: -k*q}", "{v: q^2*k}"), "{q: v}", "{q: v + q^3}");
    let Failure::Diverged { at, .. } = failure(&resolve(&text, &Overrides::default()).unwrap()) else { panic!() };
    assert!(at > 0.1 && at < 1.0, "{at}");
}

#[test]
fn a_start_without_a_left_inverse_is_refused_with_one_that_has_it() {
    let scenario = "simulation: {duration: 1, step: 0.01, initial: {Th: 50, U: 3, Tc: 20}, \
                    control: {qh: 1, qc: 1, Thin: 60, Tcin: 15}}\n";
    let exchanger = &format!("{EXCHANGER}observer: {{extension: [0, 0]}}\n{scenario}");
    let scenario = resolve(exchanger, &Overrides::default()).unwrap();
    let failure = scenario.run().unwrap_err();
    let help = scenario.explain(&failure).help.unwrap();
    assert!(help.contains("`observer: {extension: [1.5, 67.5]}`") && help.contains("phi = [U, "), "{help}");
    let mended = with(exchanger, "extension: [0, 0]", "extension: [1.5, 67.5]");
    assert!(resolve(&mended, &Overrides::default()).unwrap().run().is_ok());
    assert!(
        resolve(&with(exchanger, "observer: {extension: [0, 0]}\n", ""), &Overrides::default()).unwrap().run().is_ok()
    );
}

/// A motor whose driver settles within a nanosecond.
const DRIVEN: &str = "
model: driven
parameters: {R: 1, L: 5e-3, K: 0.1, J: 1e-3, tau: 1e-9}
x: [i, e]
y: [omega]
u: [v]
f_x: {i: (e - R*i - K*omega)/L, e: (v - e)/tau}
f_y: {omega: K*i/J}
phi: [i, e]
simulation: {duration: 1, step: 1e-3, initial: {i: 1, e: 0, omega: 0}, control: {v: 12*sin(10*t)}}
";

#[test]
fn a_state_that_settles_within_a_step_is_to_be_left_out_of_the_model() {
    let scenario = resolve(DRIVEN, &Overrides::default()).expect("a scenario");
    let failure = scenario.run().expect_err("the observer's step is too long");
    let help = scenario.explain(&failure).help.expect("what to do");
    assert!(help.contains("in its steady state"), "{failure}: {help}");
    let mended = DRIVEN
        .replace("x: [i, e]", "x: [i]")
        .replace("phi: [i, e]", "phi: [i + R*J*omega/(L*K)]")
        .replace("(e - R*i", "(v - R*i")
        .replace(", e: (v - e)/tau", "");
    let mended = mended.replace(", e: 0", "").replace(", tau: 1e-9", "");
    let trace = super::run(&mended, &Overrides::default());
    assert!(trace.summary().unsettled().is_empty(), "{}", trace.summary().text());
}

#[test]
fn a_run_that_would_take_minutes_is_given_up_within_seconds() {
    // Two million radians a second for 100 s: each takes some steps.
    let text =
        super::with(&super::with(SPRING, "k: 4", "k: 4e12"), "duration: 10, step: 0.01", "duration: 100, step: 1e-3");
    let failure = resolve(&text, &Overrides::default()).expect("a scenario").run().expect_err("it is too fast");
    let said = failure.to_string();
    assert!(said.starts_with("the run would take minutes: 2") && said.contains("time constant of 5.00e-7 s"), "{said}");
    assert!(failure.help().contains("in its steady state"), "{}", failure.help());
}

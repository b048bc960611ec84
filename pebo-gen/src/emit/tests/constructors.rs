//! The constructor of the observer that a model describes.

use super::fixtures::{CUK, vanishes};
use super::*;
use pebo_design::plant::settings::{Covariance, Estimator, Extension, FiniteTime, Late, Limits, Operator, Rebase};

fn number(text: &str) -> Rational {
    Rational::from_decimal(text).unwrap()
}

fn numbers(texts: [&str; 2]) -> Vec<Rational> {
    texts.map(number).to_vec()
}

fn settings(estimator: Estimator<Rational>) -> Settings<Rational> {
    let operator = Operator::Filter(number("0.5"));
    Settings {
        operator,
        output: false,
        expected: None,
        errors_in_variables: None,
        feedthrough: None,
        late: None,
        straight: true,
        estimator,
        lower: None,
        upper: None,
        within: [None, None],
        rebase: None,
        chi_0: numbers(["0", "-2"]),
        gate: None,
        limits: None,
    }
}

fn gradient() -> Settings<Rational> {
    settings(Estimator::Gradient(numbers(["0.001", "2e-6"])))
}

/// The text of the module for the Cuk converter.
fn tuned(settings: &Settings<Rational>) -> String {
    let (plant, derivation) = CUK.build();
    emit(&plant, &derivation, Some(settings), Scalar::F64, vanishes).unwrap().text
}

/// The module has the given settings, and each change of its text is found.
fn refuse_changed(given: &Settings<Rational>, changes: &[(&str, &str)]) {
    let (plant, derivation) = CUK.build();
    let definitions = Definitions::of(&plant, &derivation, Some(given)).unwrap();
    let asked = derivation.conditions_on_parameters(&plant);
    let confirm = |text: &str| {
        let tokens = text.parse().unwrap();
        read_back::confirm(&plant, &definitions, (&asked, Some(given)), Scalar::F64, &tokens, vanishes)
    };
    let text = tuned(given);
    assert_eq!(confirm(&text), Ok(()));
    for (from, to) in changes {
        assert!(text.contains(from), "{from}");
        assert!(confirm(&text.replacen(from, to, 1)).is_err(), "{from} -> {to}");
    }
}

/// The statements of the constructor.
fn statements(text: &str) -> Vec<String> {
    function(text, "observer").lines().skip(1).map(|line| line.trim().to_owned()).collect()
}

#[test]
fn the_constructor_has_the_numbers_of_the_model() {
    let text = tuned(&gradient());
    assert!(text.contains("pub type Tuned = Observer<Gradient<f64, NE>>;"), "{text}");
    let expected = [
        "let model = Self::try_new(parameters)?;",
        "let gain = SVector::from([0.001, 2e-6]);",
        "let estimator = Gradient::diagonal(&gain)?;",
        "let filter = Filter::new(0.5, Hold::First)?;",
        "let chi_0 = SVector::from([0.0, -2.0]);",
        "Tuned::new(model, estimator, filter, chi_0)",
    ];
    assert_eq!(statements(&text), expected);
}

#[test]
fn without_settings_there_is_only_the_check() {
    let text = emitted(CUK);
    assert!(text.contains("pub fn try_new(") && !text.contains("Tuned") && !text.contains("Filter"), "{text}");
}

/// Emitted settings are read back and are the given ones, for every estimator.
#[test]
fn every_estimator_is_built() {
    let gain = || numbers(["1", "2"]);
    let covariance = || Covariance { start: numbers(["3", "4"]), forgetting: number("0.5"), process_noise: None };
    let wandering = || Covariance { process_noise: Some(numbers(["0", "7e-3"])), ..covariance() };
    let drem = |extension| Estimator::Drem { gain: gain(), extension };
    let kreisselmeier =
        |finite_time| Extension::Kreisselmeier { gain: numbers(["3", "4"]), forgetting: number("0.5"), finite_time };
    let finite = |period| Some(FiniteTime { clip: number("0.1"), period });
    for (estimator, last) in [
        (
            Estimator::NormalisedGradient { gain: gain(), mu: number("7") },
            "let estimator = NormalisedGradient::new(gradient, 7.0)?;",
        ),
        (Estimator::LeastSquares(covariance()), "let estimator = LeastSquares::diagonal(&covariance, 0.5)?;"),
        (Estimator::LeastSquares(wandering()), "let estimator = estimator.with_process_noise(&process_noise)?;"),
        (
            Estimator::AdaptiveLeastSquares(wandering(), numbers(["8", "9e-4"])),
            "let estimator = AdaptiveLeastSquares::new(estimator, &guess)?;",
        ),
        (drem(kreisselmeier(None)), "let estimator = Drem::new(extension, &gain)?;"),
        (drem(kreisselmeier(finite(None))), "let estimator = FiniteTime::once(estimator, 0.1)?;"),
        (drem(kreisselmeier(finite(Some(number("6"))))), "let estimator = FiniteTime::tracking(estimator, 0.1, 6.0)?;"),
        (drem(Extension::Gradient(gain())), "let estimator = Drem::new(extension, &gain)?;"),
        (drem(Extension::LeastSquares(covariance())), "let estimator = Drem::new(extension, &gain)?;"),
    ] {
        let plain = settings(estimator);
        let text = tuned(&plain);
        let statements = statements(&text);
        assert_eq!(statements[statements.len() - 4], last, "{text}");
        let operator = Operator::Window(number("20"));
        let text = tuned(&Settings { operator, straight: false, lower: Some(numbers(["1", "1.5"])), ..plain });
        for part in [
            "pub const NW: usize = 20;",
            "    WindowedRegression<f64, NR, NE, NW>,\n>;",
            "let lower = SVector::from([1.0, 1.5]);",
            "let upper = SVector::repeat(f64::INFINITY);",
            "let window = WindowedRegression::new(Hold::Zero);",
        ] {
            assert!(text.contains(part), "{part}: {text}");
        }
        assert!(text.lines().all(|line| line.chars().count() <= 100), "{text}");
    }
}

/// The states within bounds: the model is, and nothing else changes.
#[test]
fn states_are_kept_within_bounds() {
    let within = [Some(numbers(["0", "-3"])), None];
    let text = tuned(&Settings { within: within.clone(), ..gradient() });
    assert!(text.contains("pebo_runtime::Observer<Within<Cuk, f64, NX>, Gradient<f64, NE>, NX,"), "{text}");
    let expected = [
        "let model = Self::try_new(parameters)?;",
        "let least = SVector::from([0.0, -3.0]);",
        "let greatest = SVector::repeat(f64::INFINITY);",
        "let model = Within::new(model, &least, &greatest)?;",
        "let gain = SVector::from([0.001, 2e-6]);",
    ];
    assert_eq!(statements(&text)[..5], expected);
    let text = tuned(&Settings { within, operator: Operator::Window(number("20")), ..gradient() });
    assert!(text.contains("Within<Cuk, f64, NX>,"), "{text}");
}

/// Least squares in the output form.
fn output_form() -> Settings<Rational> {
    let start = ["0.01", "0.01", "25", "400"].map(number).to_vec();
    let covariance = Covariance { start, forgetting: number("0"), process_noise: None };
    Settings {
        operator: Operator::Sampled(numbers(["0.1", "0.1"])),
        output: true,
        chi_0: vec![number("0"); 4],
        rebase: Some(Rebase::Samples(number("1"))),
        ..settings(Estimator::LeastSquares(covariance))
    }
}

#[test]
fn the_output_form_may_expect_its_outputs() {
    let given = Settings { expected: Some(vec![0, 1]), ..output_form() };
    let text = tuned(&given);
    assert!(text.contains("pub const ROWS: [usize; NR] = [0, 1];"), "{text}");
    let expected = [
        "let deviations = SVector::from([0.1, 0.1]);",
        "let model = OutputForm::expecting(model, ROWS, &deviations)?;",
    ];
    assert_eq!(statements(&text)[1..3], expected);
    assert_eq!(text.matches("let deviations").count(), 1, "{text}");
    refuse_changed(&given, &[("SVector::from([0.1, 0.1])", "SVector::from([0.1, 0.2])")]);
}

#[test]
fn noise_in_the_factor_has_the_deviations_of_the_sensors() {
    let given = Settings { errors_in_variables: Some(numbers(["0.1", "0.2"])), ..output_form() };
    let text = tuned(&given);
    let expected = [
        "let sensors = SVector::from([0.1, 0.2]);",
        "let observer = Tuned::with_regression(model, estimator, sampled, chi_0)?;",
        "let observer = observer.with_errors_in_variables(&sensors)?;",
        "observer.rebasing(1)",
    ];
    let found = statements(&text);
    assert_eq!(found[found.len() - 4..], expected);
    refuse_changed(&given, &[("[0.1, 0.2]", "[0.1, 0.3]"), (".with_errors_in_variables(&sensors)?", "")]);
}

#[test]
fn outputs_that_jump_with_an_input_are_named_by_their_rows() {
    let given = Settings { feedthrough: Some(vec![None, Some(1)]), ..output_form() };
    let text = tuned(&given);
    assert!(text.contains("after a jump of an input"), "{text}");
    let expected = [
        "let observer = Tuned::with_regression(model, estimator, sampled, chi_0)?;",
        "let observer = observer.with_feedthrough([None, Some(1)])?;",
        "observer.rebasing(1)",
    ];
    let found = statements(&text);
    assert_eq!(found[found.len() - 3..], expected);
    refuse_changed(&given, &[("[None, Some(1)]", "[Some(1), None]"), (".with_feedthrough([None, Some(1)])?", "")]);
}

#[test]
fn late_outputs_have_their_delays_and_a_past() {
    let (delays, rows) = (numbers(["0", "2e-6"]), vec![0, 1]);
    let late = Late { delays, rows, is_expected: vec![true, false], instants: 7 };
    let given = Settings { late: Some(late), ..output_form() };
    let text = tuned(&given);
    for expected in ["pub const NP: usize = 7;", "pub type Tuned = pebo_runtime::LateObserver<", "late `v4` by 2e-6 s"]
    {
        assert!(text.contains(expected), "{expected}: {text}");
    }
    let expected = [
        "let observer = pebo_runtime::Observer::with_regression(model, estimator, sampled, chi_0)?;",
        "let on_time = observer.rebasing(1)?;",
        "let delays = SVector::from([0.0, 2e-6]);",
        "let late = Late {",
        "delays,",
        "rows: [0, 1],",
        "is_expected: [true, false],",
        "};",
        "Tuned::new(on_time, late)",
    ];
    let found = statements(&text);
    assert_eq!(found[found.len() - 9..], expected);
    let changes = [
        ("NP: usize = 7", "NP: usize = 8"),
        ("[0.0, 2e-6]", "[0.0, 3e-6]"),
        ("rows: [0, 1]", "rows: [1, 0]"),
        ("[true, false]", "[true, true]"),
        ("Tuned::new(on_time, late)", "Ok(on_time)"),
    ];
    refuse_changed(&given, &changes);
}

#[test]
fn the_output_form_has_the_slopes_of_all_rates() {
    let given = output_form();
    let slopes = function(&tuned(&given), "output_slopes");
    // The columns of the one matrix have other names than those of the other.
    assert!(slopes.contains("rates: SMatrix::from([column_1, column_2])"), "{slopes}");
    assert!(slopes.contains("cascade: SMatrix::from([column_3, column_4])"), "{slopes}");
    refuse_changed(&given, &[("from([column_3, column_4])", "from([column_1, column_2])")]);
    assert!(!tuned(&gradient()).contains("output_slopes"), "a filter has none");
}

#[test]
fn what_samples_may_be_is_emitted_beside_the_observer() {
    let range = |least, most| Some([number(least), number(most)]);
    let limits = Limits { outputs: vec![range("-50", "50"), None], inputs: Vec::new(), gap: Some(number("1e-3")) };
    let given = Settings { limits: Some(limits), ..gradient() };
    let text = tuned(&given);
    assert!(text.contains("pub fn limits() -> Result<Limits<f64, NY, NU>, Fault> {"), "{text}");
    let expected = [
        "let limits = Limits::none();",
        "let least = SVector::from([-50.0, f64::NEG_INFINITY]);",
        "let greatest = SVector::from([50.0, f64::INFINITY]);",
        "let limits = limits.outputs(&least, &greatest)?;",
        "limits.gap(0.001)",
    ];
    let lines: Vec<String> = function(&text, "limits").lines().skip(1).map(|line| line.trim().to_owned()).collect();
    assert_eq!(lines, expected);
    let inputs = Limits { outputs: Vec::new(), inputs: vec![range("0", "1")], gap: None };
    let text = tuned(&Settings { limits: Some(inputs), ..gradient() });
    assert!(function(&text, "limits").ends_with("Ok(limits)"), "{text}");

    let changes = [
        ("[-50.0, f64::NEG_INFINITY]", "[f64::NEG_INFINITY, -50.0]"),
        ("[-50.0, f64::NEG_INFINITY]", "[-50.0, f64::INFINITY]"),
        ("[50.0, f64::INFINITY]", "[50.0, 60.0]"),
        ("[50.0, f64::INFINITY]", "[51.0, f64::INFINITY]"),
        ("limits.outputs(&least, &greatest)?", "limits.outputs(&greatest, &least)?"),
        ("limits.outputs(&least, &greatest)?", "limits.inputs(&least, &greatest)?"),
        ("limits.gap(0.001)", "limits.gap(0.01)"),
        ("limits.gap(0.001)", "Ok(limits)"),
    ];
    refuse_changed(&given, &changes);
}

#[test]
fn an_extension_is_kept_bounded_in_the_form_that_is_asked_for() {
    for (form, call, words, other) in [
        (Rebase::Above(number("100")), "without_drift(Drift::Above(100.0))", "exceeds 100", "Drift::Leak(100.0)"),
        (Rebase::Leak(number("0.5")), "without_drift(Drift::Leak(0.5))", "a leak of 0.5/s", "Drift::Leak(0.25)"),
    ] {
        let given = Settings { rebase: Some(form), ..gradient() };
        let text = tuned(&given);
        assert!(text.contains(&format!("observer.{call}")) && text.contains(words), "{text}");
        assert!(text.contains("Drift, Extension"), "{text}");
        let inner = call.trim_start_matches("without_drift(").trim_end_matches(')').to_owned() + ")";
        refuse_changed(&given, &[(inner.as_str(), other)]);
    }
}

#[test]
fn a_constructor_with_other_settings_is_refused() {
    let within = [None, Some(numbers(["7", "8"]))];
    let given =
        Settings { within, upper: Some(numbers(["5", "6"])), rebase: Some(Rebase::Samples(number("3"))), ..gradient() };
    let changes = [
        ("from([0.001, 2e-6])", "from([0.001, 2e-5])"),
        ("Filter::new(0.5", "Filter::new(0.6"),
        ("Hold::First", "Hold::Zero"),
        ("[0.0, -2.0]", "[0.0, 2.0]"),
        ("f64::NEG_INFINITY", "f64::INFINITY"),
        ("&lower, &upper", "&upper, &lower"),
        ("[7.0, 8.0]", "[7.0, 9.0]"),
        ("&least, &greatest", "&greatest, &least"),
        ("let model = Within::new(model, &least, &greatest)?;", ""),
        ("parameters.check()?;", ""),
        ("Gradient::diagonal(&gain)", "Gradient::diagonal(&upper)"),
        ("Tuned::new", "Tuned::with_regression"),
        ("rebasing(3)", "rebasing(4)"),
    ];
    refuse_changed(&given, &changes);
}

#[test]
fn a_setting_out_of_range_is_an_error() {
    let (plant, derivation) = CUK.build();
    let given = settings(Estimator::Gradient(numbers(["1e-60", "1"])));
    let error = emit(&plant, &derivation, Some(&given), Scalar::F32, vanishes).unwrap_err();
    assert!(matches!(error, EmitError::OutOfRange { .. }), "{error}");
}

//! The pieces of Rust that the manual shows and no example has: that the text is here is tested by
//! `pebo-gen/tests/manual`, that it does what the manual says, here.

use pebo_gen::emit::Scalar;
use pebo_gen::source::Source;
use pebo_runtime::nalgebra::SVector;
use pebo_runtime::{Bounded, Fault, Gate, Hold, LeastSquares, OutputForm, SampledRegression, WindowedRegression};
use tests::emitted::{boost_f64 as boost, cuk_f64 as cuk};

fn estimate_with_a_window() -> Result<cuk::X, Fault> {
    let estimator = LeastSquares::diagonal(&SVector::from([1e6, 1e10]), 100.0)?;
    let mut observer = pebo_runtime::Observer::with_regression(
        cuk::Cuk::new(&cuk::Parameters::default()),
        Bounded::new(estimator, &SVector::repeat(-100.0), &SVector::from([50.0, 100.0]))?,
        WindowedRegression::<f64, { cuk::NR }, { cuk::NE }, 100>::new(Hold::First),
        SVector::zeros(),
    )?;
    observer.step(cuk::Y { v2: 10.0, v4: -12.0 }, cuk::U { d: 0.68 }, 10e-6)
}

fn estimate_with_confidence() -> Result<Option<cuk::X>, Fault> {
    let squares = LeastSquares::diagonal(&SVector::from([0.01, 0.01, 25.0, 400.0]), 0.0)?
        .with_process_noise(&SVector::from([0.9, 4e-3, 0.01, 3.0]))?;
    let mut observer = pebo_runtime::Observer::with_regression(
        OutputForm::<_, _, { cuk::NR }, { cuk::NZ }>::new(cuk::Cuk::new(&cuk::Parameters::default())),
        squares,
        SampledRegression::<f64, { cuk::NR }, 4>::new(&SVector::from([0.1, 0.1]))?,
        SVector::zeros(),
    )?
    .rebasing(1)?;
    let mut gate = Gate::new(25.0, 20)?;
    observer.step(cuk::Y { v2: 10.0, v4: -12.0 }, cuk::U { d: 0.68 }, 10e-6)?;
    let (y, u) = (cuk::Y { v2: 10.1, v4: -12.0 }, cuk::U { d: 0.68 });
    // Far from the expected output: not taken. The next sample covers the gap.
    gate.admit(&observer.innovation(y, u, 10e-6)?)?;
    observer.step(y, u, 10e-6)?;
    // A sensor with a period of its own: a missing value is NaN.
    let y = cuk::Y { v2: 10.1, v4: f64::NAN };
    gate.admit(&observer.innovation_partly(y, &[0, 1], u, 10e-6)?)?;
    observer.step_partly(y, &[0, 1], u, 10e-6)?;
    Ok(observer.standard_error().map(cuk::X::from))
}

fn current(voltages: &[f64], duty: f64) -> Result<f64, Fault> {
    let mut observer = boost::Boost::observer(&boost::Parameters::default())?;
    let mut current = 0.0;
    for &v in voltages {
        // The voltage now, the duty cycle since the sample before, the period in seconds.
        current = observer.step(boost::Y { v }, boost::U { d: duty }, 1e-5)?.i;
    }
    Ok(current)
}

#[test]
fn the_examples_run() {
    assert_eq!(estimate_with_a_window(), Ok(cuk::X { i1: 0.0, i3: 0.0 }));
    let errors = estimate_with_confidence().expect("good samples").expect("a linear left inverse");
    assert!(errors.i1 > 0.0 && errors.i1 < 5.0 && errors.i3 > 0.0 && errors.i3 < 20.0, "{errors:?}");
    // At rest the voltage is 24 V for a duty cycle of one half, and the coil's current twice that of 50 ohms. The
    // observer of the model takes a tenth of a second.
    let current = current(&vec![24.0; 100_000], 0.5).expect("good samples");
    assert!((current - 0.96).abs() < 1e-6, "{current}");
}

/// The derivation and the module, step by step, as a build script may call them.
#[test]
fn a_build_script_may_derive_and_emit_by_itself() {
    for (model, name) in [("../models/cuk.yaml", "Cuk"), ("../models/motor.yaml", "Motor")] {
        let text = std::fs::read_to_string(model).expect("a model");
        let source = Source::new(model, text).expect("a text");
        let derived = pebo_gen::derive(&source).unwrap_or_else(|d| panic!("{model}: {}", d[0].message));
        let emitted = derived.emit(Scalar::F32).unwrap_or_else(|e| panic!("{model}: {e}"));
        assert!(emitted.text.contains(&format!("pub struct {name}")));
    }
}

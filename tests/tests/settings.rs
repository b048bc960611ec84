//! The constructor with the settings of a model, for every estimator that a model file can name: it compiles, and its
//! observer converges.

use pebo_runtime::nalgebra::SVector;

/// Seconds between samples.
const STEP: f64 = 1e-3;

/// The solution of `a' = s`, `b' = -s`, `v' = a + s b` at `t` for `s = cos t`, from `a = 2`, `b = -1`, `v = -1`.
fn plant(t: f64) -> ([f64; 2], f64, f64) {
    let (sine, cosine) = t.sin_cos();
    ([2.0 + sine, -1.0 - sine], 2.0 * t - cosine - sine - sine * sine / 2.0, cosine)
}

macro_rules! converge {
    ($($name:ident: $file:literal,)+) => {$(
        mod $name {
            #[pebo_macros::pebo_model($file)]
            pub(crate) mod plant {}
        }

        #[test]
        fn $name() {
            use $name::plant::{Pair, Parameters, U, Y};
            let mut observer = Pair::observer(&Parameters::default()).expect("the settings of the model");
            let mut worst = f64::INFINITY;
            for sample in 0..40_000_u32 {
                let t = STEP * f64::from(sample);
                let (x, v, s) = plant(t);
                let estimate = observer.step(Y { v }, U { s }, STEP).expect("a finite sample");
                worst = (SVector::from(estimate) - SVector::from(x)).abs().max();
            }
            // An input that is held over a step moves the extension by STEP/2 for each unit that it changes, here two;
            // the unknowns follow that with a gain of about one.
            assert!(worst < 2.0 * STEP, "{worst}");
            assert_eq!(
                Pair::try_new(&Parameters { k: -1.0 }).err(),
                Some(pebo_runtime::Fault::Parameter { index: 0 }),
            );
        }
    )+};
}

converge! {
    gradient_by_window: "tests/settings/gradient_by_window.yaml",
    normalised_gradient: "tests/settings/normalised_gradient.yaml",
    least_squares: "tests/settings/least_squares.yaml",
    drem: "tests/settings/drem.yaml",
    finite_time_drem: "tests/settings/finite_time_drem.yaml",
    gradient_drem: "tests/settings/gradient_drem.yaml",
    least_squares_drem: "tests/settings/least_squares_drem.yaml",
}

/// Each estimator of the language has its row above.
#[test]
fn every_estimator_is_among_them() {
    let here = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/settings");
    let files = std::fs::read_dir(here).expect("the folder").map(|entry| entry.expect("a file").path());
    let texts: Vec<String> = files.map(|file| std::fs::read_to_string(file).expect("a text")).collect();
    for name in pebo_gen::model::Estimator::NAMES {
        assert!(texts.iter().any(|text| text.contains(&format!("estimator: {name},"))), "{name}");
    }
}

//! Emitted observers beside the interpreter: fed with the samples of a run, both have the same estimates.

use std::path::Path;

use pebo_gen::derive;
use pebo_gen::simulate::{Overrides, Trace};
use pebo_gen::source::Source;
use pebo_runtime::nalgebra::SVector;

/// Every sample of a run of the model, for so many seconds.
fn run(file: &str, duration: f64) -> Trace {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(file);
    let text = std::fs::read_to_string(path).expect("a model");
    // A trace has the outputs, and not what noise makes of them.
    let text: String =
        text.lines().filter(|line| !line.starts_with("  noise:")).flat_map(|line| [line, "\n"]).collect();
    let derived = derive(&Source::new("model", text).expect("a text")).expect("a model of the project");
    let overrides = Overrides { duration: Some(duration), every: Some(1e-9), ..Overrides::default() };
    derived.scenario(&overrides).expect("a scenario").run().expect("a run to the end")
}

macro_rules! follow {
    ($($name:ident: $module:ident::$model:ident, $file:literal, $duration:literal, $y:tt, $u:tt, $x:tt;)+) => {$(
        #[test]
        fn $name() {
            use tests::emitted::$module::{$model, NU, NX, NY, Parameters};
            let trace = run($file, $duration);
            let column = |name: &str| trace.column(name).unwrap_or_else(|| panic!("no column {name}"));
            let columns = |names: &[&str]| names.iter().map(|name| column(name)).collect::<Vec<_>>();
            let (t, y, u) = (column("t"), columns(&$y), columns(&$u));
            let hat = columns(&$x);
            let mut observer = $model::observer(&Parameters::default()).expect("the settings of the model");
            for k in 0..t.len() {
                let sample = SVector::<f64, NY>::from_fn(|i, _| y[i][k]);
                // The input during the interval that the sample ends.
                let held = SVector::<f64, NU>::from_fn(|i, _| u[i][k.saturating_sub(1)]);
                let dt = if k == 0 { 1.0 } else { t[k] - t[k - 1] };
                let estimate = SVector::<f64, NX>::from(observer.step(sample, held, dt).expect("a good sample"));
                for (state, hat) in hat.iter().enumerate() {
                    // Formulas of both are the same but for their order: some hundred operations a step, each rounded,
                    // and the filter forgets.
                    let size = hat.iter().fold(1e-3, |size: f64, value| size.max(value.abs()));
                    let off = (estimate[state] - hat[k]).abs() / size;
                    assert!(off < 1e-8, "{k} {state}: {} {}", estimate[state], hat[k]);
                }
            }
        }
    )+};
}

follow! {
    late_outputs: late_cart_f64::LateCart, "models/late_cart.yaml", 20.0, ["p", "s"], ["a"], ["v_hat", "b_hat"];
    noise_in_the_factor: bearing_only_f64::BearingOnly, "../models/bearing_only.yaml", 400.0, ["beta"], ["wx", "wy"],
        ["rx_hat", "ry_hat", "vx_hat", "vy_hat"];
    components_that_depend_on_one_another: range_only_f64::RangeOnly, "../models/range_only.yaml", 60.0, ["r"],
        ["wx", "wy"], ["px_hat", "py_hat", "cx_hat", "cy_hat"];
    slopes_at_the_estimate: feed_axis_f64::FeedAxis, "../models/feed_axis.yaml", 10.0, ["v"], ["F"],
        ["F_c_hat", "F_s_hat", "v_s_hat"];
    a_monotone_torque: wind_turbine_f64::WindTurbine, "../models/wind_turbine.yaml", 60.0, ["w"], ["T"], ["v_hat"];
    a_table_in_the_slopes: battery_curve_f64::BatteryCurve, "../models/battery_curve.yaml", 600.0, ["V"], ["I"],
        ["soc_hat", "v1_hat"];
    rates_at_expected_outputs: enzyme_f64::Enzyme, "models/enzyme.yaml", 10.0, ["S", "P"], ["v"], ["C_hat"];
}

//! Emitted code: its text, and its values against exact enclosures of the derived formulas.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use pebo_cas::Rational;
use pebo_cas::number::interval::{Interval, Precision};
use pebo_cas::{Expr, Symbol};
use pebo_gen::analysis::{Class, RegressionKind};
use pebo_gen::emit::Scalar;
use pebo_gen::source::Source;
use pebo_gen::{Derived, derive};
use tests::{Point, emitted};

fn models() -> Vec<PathBuf> {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut paths = Vec::new();
    for folder in ["../models", "models"] {
        let entries = std::fs::read_dir(here.join(folder)).expect("a folder of models");
        paths.extend(entries.flatten().map(|e| e.path()).filter(|p| p.extension().is_some_and(|e| e == "yaml")));
    }
    paths.sort();
    paths
}

fn derived(path: &Path) -> Derived {
    let text = std::fs::read_to_string(path).expect("a model");
    derive(&Source::new("model", text).expect("a text")).expect("a model of the project")
}

/// The snapshots are in double precision. In single precision the text is the same but for the name of the type; of two
/// models it is kept for all to see.
#[test]
fn text_of_every_model() {
    const BOTH: [&str; 2] = ["cuk", "motor"];
    for path in models() {
        let derived = derived(&path);
        let [double, single] =
            [Scalar::F64, Scalar::F32].map(|scalar| derived.emit(scalar).expect("an accepted model").text);
        let name = &derived.plant.name;
        let differing = single.lines().zip(double.lines()).find(|(single, double)| *single != in_single(double));
        assert_eq!(differing, None, "{name}");
        assert_eq!(single.lines().count(), double.lines().count(), "{name}");
        insta::with_settings!({ omit_expression => true, prepend_module_to_snapshot => false }, {
            insta::assert_snapshot!(format!("{name}_f64"), double);
            if BOTH.contains(&name.as_str()) {
                insta::assert_snapshot!(format!("{name}_f32"), single);
            }
        });
    }
}

/// A line of text as it is in single precision. The table of accuracies has a column for either.
fn in_single(line: &str) -> String {
    if line == "//! | function | `f32` | `f64` |" { line.to_owned() } else { line.replace("f64", "f32") }
}

/// Faults found in the Rust of other generators.
#[test]
fn text_is_free_of_known_faults() {
    for path in models() {
        let text = derived(&path).emit(Scalar::F64).expect("an accepted model").text;
        let code: String = text.lines().filter(|l| !l.trim_start().starts_with("//")).collect::<Vec<_>>().join("\n");
        for fault in ["powi", "mul_add", "unwrap", "expect(", "unsafe", "std::", "panic", "vec!", "consts::E"] {
            assert!(!code.contains(fault), "{} contains {fault}", path.display());
        }
        // A formula may be longer than a line; prose is not.
        let mut in_formulas = false;
        for line in text.lines() {
            in_formulas ^= line.contains("```");
            assert!(in_formulas || line.chars().count() <= 100, "{}: {line}", path.display());
        }
    }
}

/// Reproducible values between 1/8 and 2: positive, so that roots exist, and of one size, so that a
/// tolerance relative to the largest intermediate value makes sense.
struct Draw(u64);

impl Draw {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        // Sixteenths are exact in both scalars.
        let sixteenths = u32::try_from(2 + (self.0 >> 33) % 31).expect("a small number");
        f64::from(sixteenths) / 16.0
    }

    fn values(&mut self, count: usize) -> Vec<f64> {
        (0..count).map(|_| self.next()).collect()
    }
}

#[test]
fn values_of_every_model() {
    let models: BTreeMap<String, Derived> =
        models().iter().map(|path| derived(path)).map(|derived| (derived.plant.name.clone(), derived)).collect();
    let mut compared = 0;
    for (model, scalar, evaluate) in emitted::ALL {
        let derived = &models[*model];
        // An operation rounds by half a unit in the last place; a function of the runtime's `libm` by one.
        // The formulas here have fewer than 64 operations, and values grow by at most the largest of them.
        let unit = if *scalar == "f32" { f64::from(f32::EPSILON) } else { f64::EPSILON };
        for trial in 0..20 {
            compared += compare(derived, *evaluate, 64.0 * unit, trial);
        }
    }
    assert!(compared > 1000, "only {compared} values were compared");
}

/// All parameters of the Cuk converter are positive.
#[test]
fn parameters_beside_the_proofs_are_refused() {
    use pebo_runtime::Fault;
    use tests::emitted::cuk_f32::Parameters;
    let given = Parameters::default();
    assert_eq!(given.check(), Ok(()));
    let refused = [
        (0, Parameters { l1: 0.0, ..given.clone() }),
        (1, Parameters { c2: -1.0, ..given.clone() }),
        (4, Parameters { g: f32::NAN, ..given.clone() }),
        (5, Parameters { e: f32::INFINITY, ..given.clone() }),
        (0, Parameters { l1: f32::NAN, e: f32::NAN, ..given.clone() }),
    ];
    for (index, parameters) in refused {
        assert_eq!(parameters.check(), Err(Fault::Parameter { index }), "{parameters:?}");
    }
}

/// The leakage inductance is `L_s - L_m^2/L_r` and what is assumed `L_s*L_r - L_m^2 > 0`: rounded, one can be 0 where
/// the other is positive.
#[test]
fn parameters_that_divide_by_zero_as_they_are_rounded_are_refused() {
    use pebo_runtime::Fault;
    use tests::emitted::induction_motor_f64::{InductionMotor, Parameters};
    let given = Parameters::default();
    assert_eq!(given.check(), Ok(()));
    let rounded = Parameters { l_s: 0.003_235_690_235_690_236, l_r: 0.297, l_m: 0.031, ..given };
    assert!(rounded.l_s * rounded.l_r - rounded.l_m * rounded.l_m > 0.0);
    assert_eq!(rounded.check(), Err(Fault::Parameter { index: 9 }));
    assert_eq!(InductionMotor::try_new(&rounded), Err(Fault::Parameter { index: 9 }));
}

/// `observer` builds the observers that the model files describe.
#[test]
fn an_observer_with_the_settings_of_the_model_runs() {
    use pebo_runtime::Fault;
    use pebo_runtime::nalgebra::SVector;
    use tests::emitted::{cuk_f32, cuk_f64};
    let given = cuk_f64::Parameters::default();
    let mut observer = cuk_f64::Cuk::observer(&given).expect("the model's own settings");
    let sample = (cuk_f64::Y { v2: 10.0, v4: -12.0 }, cuk_f64::U { d: 0.68 });
    let cuk_f64::X { i1, i3 } = observer.step(sample.0, sample.1, 1e-5).expect("a good sample");
    assert!(i1.is_finite() && i3.is_finite(), "{i1} {i3}");
    // Vectors do as well, in the order of the model.
    let mut same = cuk_f64::Cuk::observer(&given).expect("the model's own settings");
    let vectors = (SVector::from([10.0, -12.0]), SVector::from([0.68]));
    assert_eq!(same.step(vectors.0, vectors.1, 1e-5), Ok(SVector::from([i1, i3]).into()));
    assert!(cuk_f32::Cuk::observer(&cuk_f32::Parameters::default()).is_ok());
    let wrong = cuk_f64::Parameters { c2: -1.0, ..given };
    assert_eq!(cuk_f64::Cuk::observer(&wrong).err(), Some(Fault::Parameter { index: 1 }));
    assert_eq!(cuk_f64::Cuk::try_new(&wrong), Err(Fault::Parameter { index: 1 }));
}

/// The velocities of a mechanical model are the rates of its outputs: the regression at z without theta.
#[test]
fn velocities_are_the_rates_of_the_outputs() {
    use pebo_runtime::Model as _;
    use pebo_runtime::nalgebra::SVector;
    macro_rules! velocities {
        ($($module:ident :: $model:ident),*) => {$({
            use tests::emitted::$module::{$model, NY, NZ, Parameters, U};
            let model = $model::new(&Parameters::default());
            for trial in 0..20 {
                let mut draw = Draw(trial);
                let z = SVector::<f64, NZ>::from_fn(|_, _| draw.next());
                let y = SVector::<f64, NY>::from_fn(|_, _| draw.next());
                let velocity = model.velocity(&z, &model.terms(&y));
                let rates = SVector::from(model.phi_0(z.into(), y.into(), U::from(SVector::zeros())));
                // Two ways to round some 64 operations, as above.
                let off = (velocity - rates).norm() / rates.norm();
                assert!(off < 128.0 * f64::EPSILON, "{}: {velocity} {rates}", stringify!($module));
            }
        })*};
    }
    velocities!(cart_pendulum_f64::CartPendulum, inertia_wheel_f64::InertiaWheel, robotic_leg_f64::RoboticLeg);
}

/// Compares every value that the emitted functions return with an enclosure of the derived formula.
fn compare(derived: &Derived, evaluate: tests::Evaluate, tolerance: f64, trial: u64) -> usize {
    let plant = &derived.plant;
    let derivation = &derived.derivation;
    let mut draw = Draw(trial);
    // No model here with an equation without unknowns has a gate or the output form, which it would serve.
    let regression = derivation.regression.result.as_ref().expect("a regression").computed(&plant.arena, false);
    let (chi, y, u) = (draw.values(plant.z.len()), draw.values(plant.y.len()), draw.values(plant.u.len()));
    let (eta, z) = (draw.values(regression.eta.len()), draw.values(plant.z.len()));
    let found: RefCell<BTreeMap<String, Vec<f64>>> = RefCell::default();
    let results = |name: &str, _: usize, value: f64| found.borrow_mut().entry(name.to_owned()).or_default().push(value);
    evaluate(Point { chi: &chi, y: &y, u: &u, eta: &eta, z: &z, results: &results });

    let generalised = derivation.class == Class::Gpebo;
    let mut values: Vec<(Symbol, f64)> = Vec::new();
    values.extend((if generalised { &plant.xi } else { &plant.chi }).iter().copied().zip(chi.iter().copied()));
    values.extend(plant.y.iter().map(|o| o.symbol).zip(y));
    values.extend(plant.u.iter().copied().zip(u));
    values.extend(regression.eta_symbols.iter().copied().zip(eta));
    values.extend(plant.z.iter().copied().zip(z));
    for (row, line) in plant.psi.iter().enumerate() {
        values.extend(line.iter().enumerate().map(|(column, s)| (*s, f64::from(u8::from(row == column)))));
    }
    let precision = Precision::new(128);
    let mut exact: BTreeMap<Symbol, Interval> = BTreeMap::new();
    for (symbol, value) in values {
        let value = Rational::from_f64_exact(value).expect("a finite value");
        exact.insert(symbol, Interval::from_rational(&value, precision).expect("an enclosure"));
    }
    for parameter in &plant.parameters {
        let value = parameter.value.as_ref().expect("models of the project have values");
        exact.insert(parameter.symbol, Interval::from_rational(value, precision).expect("an enclosure"));
    }

    let cascade = derivation.cascade.result.as_ref().expect("a cascade");
    let inverse = derivation.left_inverse.result.as_ref().expect("a left inverse");
    let outputs = regression.rows().into_iter().map(|row| plant.arena.of_symbol(plant.y[row].symbol));
    // Without a primitive of its own, the outputs themselves stand under the derivative.
    let primitive_0 = match regression.kind {
        RegressionKind::Dynamic => outputs.collect(),
        _ => regression.primitive_0.clone(),
    };
    let mut expected: Vec<(&str, Vec<Expr>)> = vec![
        ("h", cascade.h.clone()),
        ("phi_0", regression.phi_0.clone()),
        ("phi_1", regression.phi_1.concat()),
        ("primitive_0", primitive_0),
        ("primitive_1", regression.primitive_1.concat()),
        ("theta", regression.theta.clone()),
        ("phi_left", inverse.x.iter().map(|(_, e)| *e).collect()),
        ("own h", cascade.h.clone()),
        ("own phi_0", regression.phi_0.clone()),
        ("own phi_1", regression.phi_1.concat()),
        ("own phi_left", inverse.x.iter().map(|(_, e)| *e).collect()),
    ];
    expected.extend(cascade.lambda.iter().map(|lambda| ("lambda", lambda.concat())));
    let mut compared = 0;
    for (name, exprs) in expected {
        let found = found.borrow();
        let (found, factors) = (&found[name], &found["phi_1"]);
        // Without such a function of the model, the trait's own gives zeros.
        if exprs.is_empty() {
            assert!(found.iter().all(|value| *value == 0.0), "{} {name}", plant.name);
            continue;
        }
        assert_eq!(found.len(), exprs.len(), "{} {name}", plant.name);
        for (entry, (expr, value)) in exprs.iter().zip(found).enumerate() {
            // The value, and those of all its parts: where these cancel, their rounding is what is left.
            let parts = plant.arena.postorder(&[*expr]);
            let Some(parts) = plant.arena.enclose_over(&parts, &exact, precision) else { continue };
            let Some(whole) = parts.last() else { continue };
            let mut size = parts.iter().map(|p| p.hi().abs().max(p.lo().abs())).fold(1.0, f64::max);
            if name.ends_with("phi_0") && regression.eta.len() == chi.len() {
                // It may be computed by the factors of the regressor, each times its coordinate.
                let row = factors.iter().skip(entry * chi.len()).zip(&chi);
                size = row.map(|(factor, chi)| (factor * chi).abs()).fold(size, f64::max);
            }
            let slack = tolerance * size;
            assert!(
                *value >= whole.lo() - slack && *value <= whole.hi() + slack,
                "{} {name}: {value} is not {whole}, trial {trial}",
                plant.name
            );
            compared += 1;
        }
    }
    compared
}

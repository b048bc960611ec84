//! Values of accepted random models as compiled code, compared with enclosures of the derived formulas.
//!
//! All models are modules of one scratch crate, which prints the bits of each value. `PEBO_EMITTED` is the number of
//! models, `PEBO_FIRST_MODEL` the first seed; without it a few are taken.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::Command;

use pebo_cas::Rational;
use pebo_cas::number::interval::{Interval, Precision};
use pebo_cas::{Expr, Symbol};
use pebo_gen::Derived;
use pebo_gen::analysis::{Class, Outcome, RegressionKind};
use pebo_gen::emit::{Emitted, Scalar};
use pebo_gen::source::Source;

use super::draw::Draw;
use super::formula::Values;
use super::plant::Plant;
use super::{make, setting};

/// The default number of models.
const MODELS: u64 = 12;

/// Points of each model; the second half has signals at 0, 1 and -1.
const POINTS: usize = 20;

/// Bits of the enclosures, which are absolute: values down to 1e-60 keep the digits of `f64`.
const BITS: u32 = 256;

/// The relative variation of a value that measures its effect: far above the enclosures' width, far below any
/// curvature.
const MOVE: f64 = 1.0 / 1_073_741_824.0;

/// The errors that the header states are the largest at its own points. Elsewhere one may be larger, but not beyond the
/// limit at which an emission is refused.
const MOST: f64 = 100.0;

/// Below, a unit is the width of the enclosures: the value is 0 whatever the arguments, and the rounding of numbers in
/// the formula is left.
const NO_UNIT: f64 = 1e-70;

/// Values of the arguments of all functions, in the order of their vectors.
struct Point {
    y: Vec<f64>,
    u: Vec<f64>,
    extension: Vec<f64>,
    z: Vec<f64>,
    eta: Vec<f64>,
}

/// An accepted model.
struct Case {
    seed: u64,
    derived: Derived,
    emitted: Emitted,
    scalar: Scalar,
    points: Vec<Point>,
}

impl Case {
    /// None where the model is not accepted; why, where its code is refused because it would lose too many digits.
    fn new(seed: u64) -> Option<Result<Self, String>> {
        let source = Source::new("m", make::model(seed).text).expect("a text");
        let derived = pebo_gen::derive(&source).ok()?;
        if derived.derivation.outcome != Outcome::Accepted {
            return None;
        }
        let scalar = if seed.is_multiple_of(2) { Scalar::F32 } else { Scalar::F64 };
        let emitted = match derived.emit(scalar) {
            Ok(emitted) => emitted,
            Err(refusal) => {
                return Some(Err(format!("seed {seed} in {}: {refusal}\n{}", scalar.name(), make::model(seed).text)));
            }
        };
        let plant = Plant::read(&source, &derived.model).expect("a plant by its equations");
        let points = points(&plant, &derived, seed);
        Some(Ok(Self { seed, derived, emitted, scalar, points }))
    }

    /// The derived results of the functions: function of `Model`, value, entries.
    fn expected(&self) -> Vec<(&'static str, &'static str, Vec<Expr>)> {
        let (plant, derivation) = (&self.derived.plant, &self.derived.derivation);
        let cascade = derivation.cascade.result.as_ref().expect("a cascade");
        // The model has no settings, by which equations without an unknown would serve a gate.
        let regression = derivation.regression.result.as_ref().expect("a regression").computed(&plant.arena, false);
        let inverse = derivation.left_inverse.result.as_ref().expect("a left inverse");
        let outputs = regression.rows().into_iter().map(|row| plant.arena.of_symbol(plant.y[row].symbol));
        let primitive_0 = match regression.kind {
            RegressionKind::Dynamic => outputs.collect(),
            _ => regression.primitive_0.clone(),
        };
        vec![
            ("flow", "h", cascade.h.clone()),
            ("flow", "lambda", cascade.lambda.iter().flatten().flatten().copied().collect()),
            ("regression", "phi_0", regression.phi_0.clone()),
            ("regression", "phi_1", regression.phi_1.concat()),
            ("primitive", "primitive_0", primitive_0),
            ("primitive", "primitive_1", regression.primitive_1.concat()),
            ("theta", "theta", regression.theta.clone()),
            ("recover", "phi_left", inverse.x.iter().map(|state| state.1).collect()),
        ]
    }

    /// Exact values of the symbols at a point: the fundamental matrix is the identity.
    fn values(&self, point: &Point) -> BTreeMap<Symbol, Rational> {
        let (plant, derivation) = (&self.derived.plant, &self.derived.derivation);
        let extension = if derivation.class == Class::Gpebo { &plant.xi } else { &plant.chi };
        let eta = derivation.regression.result.as_ref().map(|regression| regression.eta_symbols.clone());
        let mut values: Vec<(Symbol, f64)> = Vec::new();
        values.extend(plant.y.iter().map(|output| output.symbol).zip(point.y.iter().copied()));
        values.extend(plant.u.iter().copied().zip(point.u.iter().copied()));
        values.extend(extension.iter().copied().zip(point.extension.iter().copied()));
        values.extend(plant.z.iter().copied().zip(point.z.iter().copied()));
        values.extend(eta.unwrap_or_default().into_iter().zip(point.eta.iter().copied()));
        for (row, entries) in plant.psi.iter().enumerate() {
            values.extend(entries.iter().enumerate().map(|(column, s)| (*s, f64::from(u8::from(row == column)))));
        }
        let exact = |value| Rational::from_f64_exact(value).expect("a finite value");
        let mut values: BTreeMap<Symbol, Rational> = values.into_iter().map(|(s, value)| (s, exact(value))).collect();
        let given = |parameter: &pebo_gen::plant::Parameter| Some((parameter.symbol, parameter.value.clone()?));
        values.extend(plant.parameters.iter().filter_map(given));
        values
    }

    /// Value and unit of an expression: the error by rounding of its arguments and of the result.
    fn value_and_unit(&self, expr: Expr, values: &BTreeMap<Symbol, Rational>) -> Option<(Interval, f64)> {
        let arena = &self.derived.plant.arena;
        let precision = Precision::new(BITS);
        let at = |moved: Option<(Symbol, f64)>| {
            let mut exact = BTreeMap::new();
            for (&symbol, value) in values {
                let part = moved.filter(|moved| moved.0 == symbol).map_or(0.0, |moved| moved.1);
                let value = value + &(value * &Rational::from_f64_exact(part)?);
                exact.insert(symbol, Interval::from_rational(&value, precision)?);
            }
            arena.enclose_over(&[expr], &exact, precision)?.pop()
        };
        let still = at(None)?;
        let effect = |symbol: Symbol| {
            let moved = [MOVE, -MOVE].into_iter().filter_map(|part| at(Some((symbol, part)))?.sub(&still, precision));
            moved.map(|move_| move_.lo().abs().max(move_.hi().abs())).fold(0.0, f64::max) / MOVE
        };
        let condition: f64 = arena.symbols_of(&[expr]).into_iter().map(effect).sum();
        let roundoff = match self.scalar {
            Scalar::F32 => f64::from(f32::EPSILON) / 2.0,
            _ => f64::EPSILON / 2.0,
        };
        let size = still.lo().abs().max(still.hi().abs());
        Some((still, roundoff * (condition + size)))
    }

    /// The units of error that the header states for a function.
    fn bound(&self, function: &str) -> f64 {
        let loss = self.emitted.accuracy.losses.iter().find(|loss| loss.function == function);
        let worst = loss.map(|loss| match self.scalar {
            Scalar::F32 => loss.single.units,
            _ => loss.double.units,
        });
        // An entry that is not measured is a copy, or a part, of its argument.
        worst.unwrap_or(1.0).max(1.0).log2().ceil().exp2()
    }
}

/// Points of the domain that both scalars hold.
fn points(plant: &Plant, derived: &Derived, seed: u64) -> Vec<Point> {
    let mut draw = Draw::new(seed);
    let mut points = Vec::new();
    let arena = &derived.plant.arena;
    let y = derived.plant.y.iter().map(|output| output.symbol);
    let signals: Vec<String> = y.chain(derived.plant.u.iter().copied()).map(|symbol| arena.name(symbol)).collect();
    let states = derived.plant.x.iter().map(|state| arena.name(state.symbol));
    let names: Vec<String> = states.chain(signals.iter().cloned()).collect();
    let mut draws = 0;
    while points.len() < POINTS && draws < 2000 {
        draws += 1;
        let Some(mut values) = plant.point(&mut draw) else { continue };
        for parameter in &derived.plant.parameters {
            let value = parameter.value.as_ref().expect("models of the generator have values");
            values.insert(arena.name(parameter.symbol), (value.to_f64(), 0.0));
        }
        for name in &names {
            let value = &mut values.get_mut(name).expect("a drawn value").0;
            *value = single(*value);
        }
        if points.len() >= POINTS / 2 {
            let name = &signals[draw.below(signals.len())];
            let special = [0.0, 1.0, -1.0][draw.below(3)];
            values.insert(name.clone(), (special, 0.0));
        }
        if plant.admits(&values) {
            points.extend(point(derived, &values, &mut draw));
        }
    }
    points
}

/// The nearest number of `f32`.
fn single(value: f64) -> f64 {
    value.to_string().parse::<f32>().map_or(f64::NAN, f64::from)
}

/// The arguments at values of the signals: z as the transform has it, and the extension half of that.
fn point(derived: &Derived, values: &Values, draw: &mut Draw) -> Option<Point> {
    let plant = &derived.plant;
    let arena = &plant.arena;
    let precision = Precision::new(BITS);
    let value = |symbol: Symbol| values.get(&arena.name(symbol)).map(|value| value.0);
    let interval = |value: f64| Interval::from_rational(&Rational::from_f64_exact(value)?, precision);
    let transform = plant.transform();
    let known = arena.symbols_of(&transform).into_iter().map(|symbol| Some((symbol, interval(value(symbol)?)?)));
    let known: BTreeMap<Symbol, Interval> = known.collect::<Option<_>>()?;
    let z = arena.enclose_over(&transform, &known, precision)?;
    let z: Vec<f64> = z.iter().map(|z| single(z.lo())).collect();
    if z.iter().any(|z| !z.is_finite()) {
        return None;
    }
    let unknowns = derived.derivation.regression.result.as_ref()?.eta_symbols.len();
    Some(Point {
        y: plant.y.iter().map(|output| value(output.symbol)).collect::<Option<_>>()?,
        u: plant.u.iter().map(|&input| value(input)).collect::<Option<_>>()?,
        extension: z.iter().map(|z| 0.5 * z).collect(),
        eta: (0..unknowns).map(|_| single(draw.unit())).collect(),
        z,
    })
}

/// Evaluates each function of a model; goes into the scratch crate as it is.
const DRIVER: &str = r#"
use pebo_runtime::nalgebra::{SMatrix, SVector};
use pebo_runtime::{Extension, Model, Real};

fn vector<S: Real, const N: usize>(values: &[f64; N]) -> SVector<S, N> {
    SVector::from_fn(|row, _| Real::from_f64(values[row]))
}

fn print<S: Real, const R: usize, const C: usize>(model: u64, point: usize, name: &str, values: &SMatrix<S, R, C>) {
    for value in values.transpose().iter() {
        println!("{model} {point} {name} {:016x}", Real::to_f64(*value).to_bits());
    }
}

type Arguments<const NY: usize, const NU: usize, const NZ: usize, const NE: usize> =
    ([f64; NY], [f64; NU], [f64; NZ], [f64; NZ], [f64; NE]);

fn run<M, const NX: usize, const NY: usize, const NU: usize, const NZ: usize, const NR: usize, const NE: usize>(
    number: u64,
    model: &M,
    points: &[Arguments<NY, NU, NZ, NE>],
) where
    M: Model<NX, NY, NU, NZ, NR, NE>,
{
    for (index, (y, u, start, z, eta)) in points.iter().enumerate() {
        let (y, u, extension) = (vector(y), vector(u), M::Extension::new(vector(start)));
        print(number, index, "h", &model.h(&y, &u));
        print(number, index, "lambda", &model.lambda(&y, &u));
        print(number, index, "phi_0", &model.phi_0(&extension, &y, &u));
        print(number, index, "phi_1", &model.phi_1(&extension, &y, &u));
        print(number, index, "primitive_0", &model.primitive_0(&extension, &y));
        print(number, index, "primitive_1", &model.primitive_1(&extension, &y));
        print(number, index, "theta", &model.theta(&vector(eta)));
        print(number, index, "phi_left", &model.phi_left(&vector(z), &y));
    }
}
"#;

/// Writes the crate, and returns its folder.
fn write_crate(cases: &[Case]) -> PathBuf {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("emitted");
    let source = folder.join("src");
    std::fs::create_dir_all(&source).expect("a folder for the crate");
    let runtime = here.join("../pebo-runtime").display().to_string();
    let manifest = format!(
        "[package]\nname = \"emitted\"\nversion = \"0.0.0\"\nedition = \"2024\"\n\n[workspace]\n\n\
         [dependencies]\npebo-runtime = {{ path = {runtime:?} }}\n"
    );
    std::fs::write(folder.join("Cargo.toml"), manifest).expect("a manifest");
    // The versions of the project: nothing is looked up.
    std::fs::copy(here.join("../Cargo.lock"), folder.join("Cargo.lock")).expect("the lock file");
    let (mut modules, mut calls) = (String::new(), String::new());
    for case in cases {
        let (seed, type_name) = (case.seed, &case.emitted.type_name);
        std::fs::write(source.join(format!("m{seed}.rs")), &case.emitted.text).expect("a module");
        writeln!(modules, "pub mod m{seed};").expect("a string");
        let points: Vec<String> = case
            .points
            .iter()
            .map(|Point { y, u, extension, z, eta }| format!("({y:?}, {u:?}, {extension:?}, {z:?}, {eta:?})"))
            .collect();
        writeln!(
            calls,
            "    run({seed}, &emitted::m{seed}::{type_name}::new(&emitted::m{seed}::Parameters::default()), &[{}]);",
            points.join(", ")
        )
        .expect("a string");
    }
    // Functions of a library without callers are no dead code.
    std::fs::write(source.join("lib.rs"), modules).expect("a library");
    std::fs::write(source.join("main.rs"), format!("{DRIVER}\nfn main() {{\n{calls}}}\n")).expect("a program");
    folder
}

/// Runs the crate: model, point and name with the values by rows.
fn run(cases: &[Case]) -> BTreeMap<(u64, usize, String), Vec<f64>> {
    let folder = write_crate(cases);
    let mut cargo = Command::new(env!("CARGO"));
    cargo.args(["run", "--quiet", "--offline", "--manifest-path"]).arg(folder.join("Cargo.toml"));
    cargo.env("CARGO_TARGET_DIR", folder.join("target"));
    let ran = cargo.output().expect("cargo runs");
    assert!(ran.status.success(), "{}", String::from_utf8_lossy(&ran.stderr));
    let mut found: BTreeMap<(u64, usize, String), Vec<f64>> = BTreeMap::new();
    for line in String::from_utf8(ran.stdout).expect("a text").lines() {
        let [model, point, name, bits] = line.split(' ').collect::<Vec<_>>()[..] else { panic!("{line}") };
        let key = (model.parse().expect("a number"), point.parse().expect("a number"), name.to_owned());
        let bits = u64::from_str_radix(bits, 16).expect("a number");
        found.entry(key).or_default().push(f64::from_bits(bits));
    }
    found
}

#[test]
fn compiled_code_computes_the_derived_formulas() {
    let (first, models) = (setting("PEBO_FIRST_MODEL", 1), setting("PEBO_EMITTED", MODELS));
    let models = usize::try_from(models).expect("a number of models");
    // At least one in four seeds is accepted.
    let seeds = first..first + 4 * u64::try_from(models).expect("a number of models") + 40;
    let mut refused = Vec::new();
    let cases = seeds.filter_map(Case::new).filter_map(|case| case.map_err(|refusal| refused.push(refusal)).ok());
    let cases: Vec<Case> = cases.take(models).collect();
    assert_eq!(cases.len(), models, "too few models are accepted");
    let found = run(&cases);
    let (mut compared, mut beyond, mut wrong, mut largest) = (0, 0, Vec::new(), 0.0_f64);
    for case in &cases {
        for (index, point) in case.points.iter().enumerate() {
            let values = case.values(point);
            for (function, name, exprs) in case.expected() {
                let computed = &found[&(case.seed, index, name.to_owned())];
                // Without such a function of the model, the trait's own gives zeros.
                if exprs.is_empty() {
                    assert!(computed.iter().all(|value| *value == 0.0), "{} {name}", case.seed);
                    continue;
                }
                assert_eq!(computed.len(), exprs.len(), "{} {name}", case.seed);
                for (expr, value) in exprs.iter().zip(computed) {
                    let Some((exact, unit)) = case.value_and_unit(*expr, &values) else { continue };
                    let error = (value - exact.lo()).abs().max((value - exact.hi()).abs());
                    let least =
                        if case.scalar == Scalar::F32 { f64::from(f32::MIN_POSITIVE) } else { f64::MIN_POSITIVE };
                    compared += 1;
                    if unit < NO_UNIT {
                        continue;
                    }
                    let units = if error <= least { 0.0 } else { error / unit };
                    let share = units / case.bound(function);
                    beyond += usize::from(share > 1.0);
                    if units.is_nan() || units > MOST {
                        let text = make::model(case.seed).text;
                        wrong.push(format!(
                            "seed {}, {} in {}: {value:e} for {exact}, {units:.1} units of at most {}, at {:?} {:?} {:?}\n{text}",
                            case.seed, name, case.scalar.name(), case.bound(function), point.y, point.u, point.z
                        ));
                    } else {
                        largest = largest.max(share);
                    }
                }
            }
        }
    }
    println!(
        "{compared} values of {models} models: {beyond} beyond the largest error that the header states of its places, the \
         worst by a factor of {largest:.1}; {} more are accepted, but their code is refused:\n{}",
        refused.len(),
        refused.join("\n")
    );
    assert!(wrong.is_empty(), "{} of {compared} values:\n{}", wrong.len(), wrong.join("\n"));
    assert!(compared > 40 * models, "only {compared} values were compared");
}

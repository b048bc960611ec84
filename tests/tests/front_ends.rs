//! A plant in plain Rust is the plant in a model file: the same tokens, and functions that can be called. That the
//! command line gives them too is a test beside its program (`pebo-gen/tests/front/answer.rs`).

use std::path::Path;

use pebo_gen::analysis::Outcome;
use pebo_gen::emit::{Emitted, Scalar};
use pebo_gen::model::Model;
use pebo_gen::model::rust::TokenSpans;
use pebo_gen::source::{Code, Source};
use pebo_gen::{Builder, Derived, Request, Standing, answer};
use pebo_runtime::nalgebra::SVector;
use pebo_runtime::{Extension as _, Fundamental};
use tests::emitted::{cuk_f64, prey_f64, rotating_frame_f64};

/// Compiles the plants, and keeps their texts.
macro_rules! plants {
    ($($name:literal in $folder:literal,)*) => {
        $(include!(concat!("plants/", $name, ".rs"));)*

        /// Name, text in Rust, model file.
        const PLANTS: &[(&str, &str, &str)] = &[$((
            $name,
            include_str!(concat!("plants/", $name, ".rs")),
            concat!($folder, $name, ".yaml"),
        )),*];
    };
}

plants! {
    "ball" in "models/",
    "cuk" in "../models/",
    "motor_flux" in "../models/",
    "pendulum" in "../models/",
    "pmsm" in "models/",
    "prey" in "models/",
    "rotating_frame" in "models/",
}

/// From the text of a module, as the attribute reads and writes it.
fn from_rust(text: &str, scalar: Scalar) -> Emitted {
    let module: syn::ItemMod = syn::parse_str(text).expect("a module");
    let attribute = module.attrs.iter().find(|a| a.path().segments.last().is_some_and(|s| s.ident == "pebo_model"));
    let arguments = match &attribute.expect("the attribute").meta {
        syn::Meta::List(list) => list.tokens.clone(),
        _ => proc_macro2::TokenStream::new(),
    };
    let model = Model::read_rust(arguments, &module, &mut TokenSpans::new()).expect("a model");
    Derived::of(model).and_then(|derived| derived.admitted(scalar)).expect("accepted")
}

/// The text of a model file without its sections `observer` and `simulation`: a module of plain Rust has none, and what
/// would be derived of them are settings.
fn unsettled(path: &str) -> String {
    let text = std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join(path)).expect("a model file");
    let mut within = false;
    let lines = text.lines().filter(|line| {
        if line.starts_with(char::is_alphabetic) {
            within = line.starts_with("observer:") || line.starts_with("simulation:");
        }
        !within
    });
    lines.fold(String::new(), |text, line| text + line + "\n")
}

/// From the text of a model file, in one call.
fn from_file(path: &str, text: &str, scalar: Scalar) -> Emitted {
    let answer = answer(&Source::new(path, text).expect("a text"), &Request::new().emit(scalar));
    assert_eq!(answer.standing, Standing::Accepted, "{}", answer.summary);
    answer.emitted.expect("accepted")
}

/// The attribute names a class of cascade as a model file does.
#[test]
fn the_class_that_is_asked_for_is_read() {
    let (_, text, _) = PLANTS.iter().find(|plant| plant.0 == "rotating_frame").expect("a plant");
    let asked = |class: &str| {
        let module: syn::ItemMod = syn::parse_str(text).expect("a module");
        let arguments = format!("class = \"{class}\", assume(k > 0)").parse().expect("tokens");
        Model::read_rust(arguments, &module, &mut TokenSpans::new())
    };
    assert_eq!(Derived::of(asked("gpebo").expect("a model")).expect("a plant").derivation.outcome, Outcome::Accepted);
    assert_eq!(Derived::of(asked("pebo").expect("a model")).expect("a plant").derivation.outcome, Outcome::Rejected);
    assert_eq!(asked("pbo").expect_err("no such class")[0].code, Code::WrongChoice);
}

#[test]
fn three_ways_give_the_same_code() {
    let out = tempfile::tempdir().expect("a folder");
    for (name, text, file) in PLANTS {
        let unsettled = unsettled(file);
        let path = out.path().join(format!("{name}.yaml"));
        std::fs::write(&path, &unsettled).expect("a file");
        for scalar in [Scalar::F64, Scalar::F32] {
            let (rust, yaml) = (from_rust(text, scalar), from_file(file, &unsettled, scalar));
            assert_eq!(rust.tokens.to_string(), yaml.tokens.to_string(), "{name}");
            assert_eq!((&rust.text, &rust.type_name), (&yaml.text, &yaml.type_name), "{name}");
            for (format, expected) in [(true, rust.text), (false, rust.tokens.to_string())] {
                let builder = Builder::new().out_dir(out.path()).emit_rerun_if_changed(false);
                let built = builder.scalar(scalar).format(format).compile(&[&path]).expect("accepted");
                assert!(std::fs::read_to_string(&built[0].path).expect("a file") == expected, "{name}");
            }
        }
    }
}

#[test]
fn the_authors_functions_and_those_added_can_be_called() {
    let (x, y, u) = (cuk::X { i1: 0.5, i3: -1.0 }, cuk::Y { v2: 10.0, v4: -12.0 }, cuk::U { d: 0.25 });
    let rate = cuk::f_x(&y, u);
    assert_eq!(rate, cuk::X { i1: (12.0 - 0.75 * 10.0) / 10e-3, i3: -(0.25 * 10.0 - 12.0) / 10e-3 });
    let [h1, h3] = cuk::h(&y, &u);
    assert!((h1 - rate.i1).abs() < 1e-9 && (h3 - rate.i3).abs() < 1e-9);
    assert_eq!(cuk::phi_left(cuk::phi(&x), &y), x);
    // y' = phi_0 + phi_1 theta, where chi + theta = phi(x, y).
    let chi = [0.25, 2.0];
    let theta = [0.25, -3.0];
    let (phi_0, phi_1) = (cuk::phi_0(chi, &y, &u), cuk::phi_1(chi, &y, &u));
    let f_y = cuk::f_y(&x, &y, u);
    for (row, rate) in [f_y.v2, f_y.v4].into_iter().enumerate() {
        let regression = phi_0[row] + phi_1[row][0] * theta[0] + phi_1[row][1] * theta[1];
        assert!((regression - rate).abs() < 1e-9 * rate.abs(), "row {row}: {regression} and {rate}");
    }
}

/// Two arrays, bit by bit.
fn same(a: &[f64], b: &[f64]) {
    let bits = |values: &[f64]| values.iter().map(|value| value.to_bits()).collect::<Vec<u64>>();
    assert_eq!(bits(a), bits(b), "{a:?} and {b:?}");
}

/// Those of a module of plain Rust, for its own structures, and those of a model file have the same values: with inputs
/// and without, with either extension.
#[test]
fn the_papers_functions_agree() {
    let model = cuk_f64::Cuk::new(&cuk_f64::Parameters::default());
    let (y, u) = (cuk::Y { v2: 10.0, v4: -12.0 }, cuk::U { d: 0.25 });
    let (own_y, own_u) = (cuk_f64::Y { v2: 10.0, v4: -12.0 }, cuk_f64::U { d: 0.25 });
    let chi = [0.25, 2.0];
    same(&cuk::h(&y, &u), &model.h(own_y, own_u));
    same(&cuk::phi_0(chi, &y, &u), &model.phi_0(chi, own_y, own_u));
    same(cuk::phi_1(chi, &y, &u).as_flattened(), model.phi_1(chi, own_y, own_u).as_flattened());
    let (x, own_x) = (cuk::phi_left(chi, &y), model.phi_left(chi, own_y));
    same(&[x.i1, x.i3], &[own_x.i1, own_x.i3]);

    let model = prey_f64::Prey::new(&prey_f64::Parameters::default());
    let (y, own_y, own_u) = (prey::Y { y: 0.75 }, prey_f64::Y { y_: 0.75 }, prey_f64::U);
    same(&prey::h(&y), &model.h(own_y, own_u));
    same(&prey::phi_0([0.5], &y), &model.phi_0([0.5], own_y, own_u));
    same(prey::phi_1([0.5], &y).as_flattened(), model.phi_1([0.5], own_y, own_u).as_flattened());
    same(&[prey::phi_left([0.5], &y).x], &[model.phi_left([0.5], own_y).x]);

    let model = rotating_frame_f64::RotatingFrame::new(&rotating_frame_f64::Parameters::default());
    let (y, u) = (rotating_frame::Y { s: 1.5 }, rotating_frame::U { w: 3.0, v: -0.5 });
    let (own_y, own_u) = (rotating_frame_f64::Y { s: 1.5 }, rotating_frame_f64::U { w: 3.0, v: -0.5 });
    let extension = Fundamental::new(SVector::from(chi));
    same(&rotating_frame::h(&y, &u), &model.h(own_y, own_u));
    same(&model.h(own_y, own_u), &[-0.5, 0.0]);
    same(model.lambda(own_y, own_u).as_flattened(), &[0.0, 3.0, -3.0, 0.0]);
    same(&rotating_frame::phi_0(&extension, &y, &u), &model.phi_0(&extension, own_y, own_u));
    let phi_1 = model.phi_1(&extension, own_y, own_u);
    same(rotating_frame::phi_1(&extension, &y, &u).as_flattened(), phi_1.as_flattened());
    same(phi_1.as_flattened(), &[2.0, 0.0]);
}

#[test]
fn the_type_and_the_observer_stand_in_the_module() {
    let model = cuk::Cuk::new(&cuk::Parameters { e: 24.0, ..cuk::Parameters::default() });
    let (y, u) = (&cuk::Y { v2: 10.0, v4: -12.0 }, &cuk::U { d: 0.25 });
    let [h, _] = model.h(y.into(), u.into());
    assert!((h - (24.0 - 7.5) / 10e-3).abs() < 1e-9);
    assert_eq!(model.phi_0([0.0; 2], y.into(), u.into()).len(), cuk::NR);
    assert!(size_of::<cuk::Observer>() > size_of::<cuk::Cuk>());
}

//! The attribute with the path of a model file gives what the command line gives.

use pebo_runtime::Model as _;
use pebo_runtime::nalgebra::SVector;
use tests::emitted::{cuk_case2_f32, cuk_f64};

#[pebo_macros::pebo_model("../models/cuk.yaml")]
mod cuk {}

/// The other case.
#[pebo_macros::pebo_model("../models/cuk_case2.yaml", scalar = f32)]
struct CukCase2;

/// A name of the author's own.
#[pebo_macros::pebo_model("../models/cuk.yaml")]
struct Converter;

#[test]
fn a_module_is_filled() {
    let attribute = cuk::Cuk::new(&cuk::Parameters::default());
    let emitted = cuk_f64::Cuk::new(&cuk_f64::Parameters::default());
    let (y, u) = (SVector::from([10.0, -12.0]), SVector::from([0.68]));
    assert_eq!(attribute.h(&y, &u), emitted.h(&y, &u));
    assert_eq!(cuk::NX, cuk_f64::NX);
}

#[test]
fn a_struct_becomes_the_models_type() {
    let attribute = CukCase2::new(&cuk_case2::Parameters::default());
    let emitted = cuk_case2_f32::CukCase2::new(&cuk_case2_f32::Parameters::default());
    let (y, u) = (SVector::from([10.0_f32, -1.0]), SVector::from([0.68_f32]));
    assert_eq!(attribute.h(&y, &u), emitted.h(&y, &u));
}

#[test]
fn a_struct_keeps_its_name() {
    let renamed = Converter::new(&converter::Parameters::default());
    let emitted = cuk_f64::Cuk::new(&cuk_f64::Parameters::default());
    let (y, u) = (SVector::from([10.0, -12.0]), SVector::from([0.68]));
    assert_eq!(renamed.h(&y, &u), emitted.h(&y, &u));
}

/// What cargo looks at when it decides whether to build again.
#[test]
fn the_compiler_is_told_of_the_files() {
    let program = std::env::current_exe().expect("this test");
    let listed = std::fs::read_to_string(program.with_extension("d")).expect("cargo writes what a program depends on");
    for file in ["models/cuk.yaml", "models/cuk_case2.yaml"] {
        assert!(listed.contains(file), "{file} is not in {listed}");
    }
}

//! The attribute with the path of a model file gives what the command line gives.

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
    let (y, u) = (cuk::Y { v2: 10.0, v4: -12.0 }, cuk::U { d: 0.68 });
    let (same_y, same_u) = (cuk_f64::Y { v2: 10.0, v4: -12.0 }, cuk_f64::U { d: 0.68 });
    assert_eq!(SVector::from(attribute.h(y, u)), SVector::from(emitted.h(same_y, same_u)));
    assert_eq!(cuk::NX, cuk_f64::NX);
}

#[test]
fn a_struct_becomes_the_models_type() {
    let attribute = CukCase2::new(&cuk_case2::Parameters::default());
    let emitted = cuk_case2_f32::CukCase2::new(&cuk_case2_f32::Parameters::default());
    let h = attribute.h(cuk_case2::Y { v2: 10.0, i3: -1.0 }, cuk_case2::U { d: 0.68 });
    let same = emitted.h(cuk_case2_f32::Y { v2: 10.0, i3: -1.0 }, cuk_case2_f32::U { d: 0.68 });
    assert_eq!(SVector::from(h), SVector::from(same));
}

#[test]
fn a_struct_keeps_its_name() {
    let renamed = Converter::new(&converter::Parameters::default());
    let emitted = cuk_f64::Cuk::new(&cuk_f64::Parameters::default());
    let h = renamed.h(converter::Y { v2: 10.0, v4: -12.0 }, converter::U { d: 0.68 });
    let same = emitted.h(cuk_f64::Y { v2: 10.0, v4: -12.0 }, cuk_f64::U { d: 0.68 });
    assert_eq!(SVector::from(h), SVector::from(same));
}

/// The files whose change makes cargo build again.
#[test]
fn the_compiler_knows_the_files() {
    let program = std::env::current_exe().expect("this test");
    let listed = std::fs::read_to_string(program.with_extension("d")).expect("cargo writes what a program depends on");
    for file in ["models/cuk.yaml", "models/cuk_case2.yaml"] {
        assert!(listed.contains(file), "{file} is not in {listed}");
    }
}

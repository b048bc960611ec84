//! The attribute gives what the command line gives.

use pebo_runtime::Model as _;
use pebo_runtime::nalgebra::SVector;
use tests::emitted::cuk_f64;

#[pebo_macros::pebo_model("../models/cuk.yaml")]
mod cuk {}

#[test]
fn the_attribute_emits_the_same_functions() {
    let attribute = cuk::Cuk::new(&cuk::Parameters::default());
    let emitted = cuk_f64::Cuk::new(&cuk_f64::Parameters::default());
    let (y, u) = (SVector::from([10.0, -12.0]), SVector::from([0.68]));
    assert_eq!(attribute.h(&y, &u), emitted.h(&y, &u));
    assert_eq!(cuk::NX, cuk_f64::NX);
}

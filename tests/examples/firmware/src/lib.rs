//! An observer without `std` and without an allocator, for single precision.
#![no_std]

use pebo_runtime::nalgebra::SVector;
use pebo_runtime::{Fault, Filter, Gradient, Hold};

/// The converter that is observed.
#[pebo_macros::pebo_model("models/cuk.yaml", scalar = f32)]
pub struct Cuk;

/// The observer with its gains.
///
/// # Errors
/// None with these gains, which are positive.
pub fn observer() -> Result<cuk::Observer, Fault> {
    cuk::Observer::new(
        Cuk::new(&cuk::Parameters::default()),
        Gradient::diagonal(&SVector::from([0.001, 0.001]))?,
        Filter::new(0.5, Hold::First)?,
        SVector::zeros(),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sample_is_taken() {
        let mut observer = observer().expect("positive gains");
        let estimate = observer.step(cuk::Y { v2: 10.0, v4: -12.0 }, cuk::U { d: 0.68 }, 1e-5);
        assert_eq!(estimate, Ok(cuk::X { i1: 0.0, i3: 0.0 }));
    }
}

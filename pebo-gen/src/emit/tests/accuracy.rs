//! Measurements of emitted functions.

use super::fixtures::{CUK, PENDULUM, Sketch, vanishes};
use crate::emit::{Accuracy, Cause, EmitError, Scalar, emit};

/// This loses its digits where `v2` is small, and so does any form in functions that the tool has.
const LOSING: &str = "(v2*Real::cos(v2) - Real::sin(v2))/(v2*v2)";
/// This does not.
const KEEPING: &str = "v2/(3.0 + v2*v2)";

/// The outputs are not zero: both sides of 0 are looked at.
fn with_h(formula: &'static str, rate: &'static str) -> Sketch {
    let leak = |text: &'static str| -> &'static [&'static str] { Box::leak(Box::new([text, "0.0"])) };
    let states: &'static [(&str, &str)] = Box::leak(Box::new([("i1", rate), ("i3", "0.0")]));
    Sketch { h: leak(formula), x: states, assume: &["L1", "C2", "L3", "C4", "d", "1.0 - d", "v2"], ..CUK }
}

fn accuracy(sketch: Sketch, scalar: Scalar) -> Result<Accuracy, EmitError> {
    let (plant, derivation) = sketch.build();
    emit(&plant, &derivation, None, scalar, vanishes).map(|emitted| emitted.accuracy)
}

#[test]
fn a_form_that_loses_digits_is_refused_unless_the_author_wrote_it() {
    for scalar in Scalar::ALL {
        let refused = accuracy(with_h(LOSING, KEEPING), scalar).unwrap_err();
        let EmitError::Inaccurate { function, place, scalar: name, .. } = &refused else { panic!("{refused}") };
        assert_eq!((function.as_str(), *name), ("flow", scalar.name()));
        assert!(place.contains("v2 = 6.1016"), "{place}");
        assert!(refused.to_string().contains("write in another form what cancels there"), "{refused}");
        let own = accuracy(with_h(LOSING, LOSING), scalar).unwrap();
        let (_, worst) = own.of(scalar).find(|(function, _)| *function == "flow").unwrap();
        assert!(worst.cause == Cause::Model && worst.units > 1e3, "{worst:?}");
        let kept = accuracy(with_h(KEEPING, KEEPING), scalar).unwrap();
        assert!(kept.of(scalar).all(|(_, worst)| worst.units < 4.0), "{kept:?}");
    }
}

#[test]
fn a_value_that_is_not_finite_is_refused() {
    // exp(100)^2 is beyond f32, the quotient is not.
    let overflowing = "Real::exp(100.0*d)*Real::exp(100.0*d)/(1.0 + Real::exp(200.0*d))";
    let sketch = || with_h(overflowing, "0.0");
    assert!(
        matches!(accuracy(sketch(), Scalar::F32), Err(EmitError::Inaccurate { function, .. }) if function == "flow")
    );
    let double = accuracy(sketch(), Scalar::F64).unwrap();
    let (_, worst) = double.of(Scalar::F32).find(|(function, _)| *function == "flow").unwrap();
    assert!(worst.units.is_infinite());
}

#[test]
fn functions_of_a_few_operations_lose_a_few_roundings() {
    for sketch in [CUK, PENDULUM] {
        let found = accuracy(sketch, Scalar::F64).unwrap();
        assert!(found.places > 12, "{}", found.places);
        for scalar in Scalar::ALL {
            // Some operations, a rounding each.
            assert!(found.of(scalar).all(|(_, worst)| worst.units < 8.0), "{found:?}");
        }
    }
}

#[test]
fn a_loss_of_the_author_hides_no_other() {
    // The author's own rate loses digits beside v2 = 0, more than the second entry of h does beside v4 = 0.
    let ours = "(v4*Real::cos(v4) - Real::sin(v4))/(v4*v4)";
    let h: &'static [&'static str] = Box::leak(Box::new([LOSING, ours]));
    let x: &'static [(&str, &str)] = &[("i1", LOSING), ("i3", "0.0")];
    let assume = &["L1", "C2", "L3", "C4", "d", "1.0 - d", "v2", "v4"];
    let refused = accuracy(Sketch { x, assume, h, ..CUK }, Scalar::F64).unwrap_err();
    let EmitError::Inaccurate { place, .. } = &refused else { panic!("{refused}") };
    // Beside v4 = 0, be it alone or with all others.
    assert!(["v4 = 6.1016", "v4 = 9.8726"].iter().any(|small| place.contains(small)), "{place}");
}

#[test]
fn a_sum_that_the_author_wrote_may_lose_its_digits_alone() {
    // The author adds it to something large; h is the sum alone.
    let sum = "v2*Real::cos(v2) - Real::sin(v2)";
    let within = "1000000.0 + v4*(v2*Real::cos(v2) - Real::sin(v2))";
    let found = accuracy(with_h(sum, within), Scalar::F64).unwrap();
    let (_, worst) = found.of(Scalar::F64).find(|(function, _)| *function == "flow").unwrap();
    assert!(worst.cause == Cause::Model && worst.units > 100.0, "{worst:?}");
    // If the author has no such sum, its error is a rounding of the sum's size elsewhere.
    let found = accuracy(with_h(sum, "1000000.0 + v4"), Scalar::F64).unwrap();
    let (_, worst) = found.of(Scalar::F64).find(|(function, _)| *function == "flow").unwrap();
    assert!(worst.cause == Cause::Small && worst.units > 100.0, "{worst:?}");
    // The error of a quotient with a small denominator is not small beside the quotient elsewhere.
    let quotient = "(v2*Real::cos(v2) - Real::sin(v2))/(v2*v2*v2)";
    assert!(accuracy(with_h(quotient, "1000000.0 + v4"), Scalar::F64).is_err());
}

#[test]
fn of_two_parts_that_lose_digits_at_a_place_each_has_to_be_the_authors() {
    const OTHER: &str = "(3.0*v2*Real::cos(3.0*v2) - Real::sin(3.0*v2))/(v2*v2)";
    let h: &'static [&'static str] = Box::leak(Box::new([LOSING, OTHER]));
    let assume = &["L1", "C2", "L3", "C4", "d", "1.0 - d", "v2"];
    let sketch = |x| Sketch { x, assume, h, ..CUK };
    assert!(accuracy(sketch(&[("i1", LOSING), ("i3", "0.0")]), Scalar::F64).is_err());
    assert!(accuracy(sketch(&[("i1", LOSING), ("i3", OTHER)]), Scalar::F64).is_ok());
}

#[test]
fn a_form_that_keeps_the_digits_is_found() {
    for losing in [
        "(Real::sqrt(1.0 + v2*v2) - 1.0)/v2",
        "(1.0 - Real::cos(v2))/v2",
        "Real::sqrt(1.0 + v2*v2) + Real::cosh(v2) - 2.0 + Real::ln(1.0 + v2*v2)",
        "(1.0 + v2)*(1.0 + v2) - 1.0 - 2.0*v2",
        "(Real::cos(v4) - Real::cos(v2)*Real::cos(v4 + v2))/(1.0 - Real::cos(v2)*Real::cos(v2))",
    ] {
        // Also where the author wrote the other one.
        for rate in [losing, "0.0"] {
            let assume = &["L1", "C2", "L3", "C4", "d", "1.0 - d", "v2", "Real::sin(v2)"];
            let (plant, derivation) = Sketch { assume, ..with_h(losing, rate) }.build();
            for scalar in Scalar::ALL {
                let emitted = emit(&plant, &derivation, None, scalar, vanishes).unwrap();
                // Up to ten operations, a rounding each.
                assert!(emitted.accuracy.of(scalar).all(|(_, worst)| worst.units < 10.0), "{:?}", emitted.accuracy);
            }
        }
    }
}

#[test]
fn a_left_inverse_that_loses_digits_beside_a_limit_of_its_state_is_written_another_way() {
    // The author's own: z1 = 3 i1 + i1^2 for i1 > 0.
    let phi_left = &[("i1", "(Real::sqrt(4.0*z1 + 9.0) - 3.0)/2.0"), ("i3", "z2")];
    let assume = &["L1", "C2", "L3", "C4", "d", "1.0 - d", "i1"];
    let (plant, derivation) = Sketch { assume, phi: &["3.0*i1 + i1*i1", "i3"], phi_left, ..CUK }.build();
    for scalar in Scalar::ALL {
        let emitted = emit(&plant, &derivation, None, scalar, vanishes).unwrap();
        let (_, worst) = emitted.accuracy.of(scalar).find(|(function, _)| *function == "recover").unwrap();
        // Five operations, a rounding each.
        assert!(worst.units < 8.0, "{worst:?}");
        assert!(emitted.text.contains("+ 9.0) + 3.0)"), "{}", emitted.text);
    }
}

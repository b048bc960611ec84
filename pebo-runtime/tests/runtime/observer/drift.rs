//! Re-basing: the remedy against the drift of the open integrator (the paper, remark R5).

use pebo_runtime::nalgebra::Vector2;
use pebo_runtime::{Drift, Fault, Rebase};
use proptest::prelude::*;

use crate::converter::{Case, CaseOne, CaseTwo, CaseTwoGeneralised, CukObserver, Loop};
use crate::random::vector;

/// A loop after 2 ms, in the middle of its transient.
fn running<M: Case<f64>>() -> Loop<f64, M> {
    let mut closed = Loop::new(1.0, [0.01, 0.1], 1e-5).unwrap();
    closed.run(2e-3).unwrap();
    closed
}

/// The distance of the estimates after re-basing one of two equal observers: at once, and during 5 ms after.
fn distances<M: Case<f64> + Rebase<2, 2, 1, 2, 2>>(shift: &Vector2<f64>) -> [f64; 2] {
    let (mut plain, mut moved) = (running::<M>(), running::<M>());
    let (theta, chi) = (moved.observer.theta(), *moved.observer.extension());
    moved.observer.rebase(shift).unwrap();
    assert!((moved.observer.theta() - theta - shift).norm() <= 1e-15 * (1.0 + shift.norm()));
    assert!(*moved.observer.extension() != chi);
    let at_once = (moved.error() - plain.error()).norm();
    let mut later = 0.0_f64;
    for _ in 0..500 {
        plain.advance().unwrap();
        moved.advance().unwrap();
        later = later.max((moved.error() - plain.error()).norm());
    }
    [at_once, later]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]
    #[test]
    fn estimates_are_those_of_an_observer_never_moved(shift in vector::<2>(-100.0..100.0)) {
        // At once: a few roundings of numbers up to 100, and of i3 G L3/C4 = 20 V in case II. Later: the innovation is
        // the difference of numbers 100 times larger, on a filtered regressor of either; the loop feeds it back for 5
        // ms.
        for [at_once, later] in [
            distances::<CaseOne<f64>>(&shift), distances::<CaseTwo<f64>>(&shift), distances::<CaseTwoGeneralised<f64>>(&shift),
        ] {
            prop_assert!(at_once < 1e-13, "{}", at_once);
            prop_assert!(later < 1e-9, "{}", later);
        }
    }
}

#[test]
fn shift_by_powers_of_two_is_exact() {
    let chi = Vector2::new(0.75, -3.5);
    let estimate = |shifts: &[Vector2<f64>]| {
        let mut observer: CukObserver<f64, CaseOne<f64>> = Loop::new(1.0, [0.01, 0.1], 1e-5).unwrap().observer;
        observer.restart(chi, &Vector2::new(-0.25, 1.5)).unwrap();
        for shift in shifts {
            observer.rebase(shift).unwrap();
        }
        observer.estimate_at(Vector2::new(10.0, -12.0))
    };
    // Dyadic numbers throughout: nothing rounds, so nothing may change.
    for exponent in [-40, -3, 0, 5, 40] {
        let shift = Vector2::new(2.0_f64.powi(exponent), -(2.0_f64.powi(exponent + 1)));
        assert_eq!(estimate(&[shift]), Vector2::new(0.5, -2.0));
    }
    // Where the sum itself cannot hold both numbers, the carried error does: there and back is the identity.
    let shift = Vector2::new(1e20, -1e20);
    assert_eq!(estimate(&[shift, -shift]), Vector2::new(0.5, -2.0));
}

#[test]
fn extension_stays_bounded_under_a_bias() {
    // A sensor offset makes h non-zero in steady state and chi run away; re-based, it stays at what one period adds.
    let drift = |periods: u32, rebase: bool| {
        let mut observer = Loop::<f64, CaseOne<f64>>::new(1.0, [0.01, 0.1], 1e-5).unwrap().observer;
        let (mut largest, mut last) = (0.0_f64, Vector2::zeros());
        for _ in 0..periods * 100 {
            last = observer.step(Vector2::new(30.0, -20.0), [0.7], 1e-5).unwrap();
            largest = largest.max(observer.extension().chi().norm());
            if rebase && observer.extension().chi().norm() > 1.0 {
                let chi = *observer.extension().chi();
                observer.rebase(&chi).unwrap();
                // The error carried beyond the sum's rounded value is not shifted.
                assert!(observer.extension().chi().norm() <= f64::EPSILON * chi.norm());
            }
        }
        (largest, last)
    };
    let ((free, without), (bounded, with)) = (drift(100, false), drift(100, true));
    assert!(free > 10.0 && bounded < 1.01, "{free} {bounded}");
    // Roundings of numbers up to 40, ten thousand times.
    assert!((without - with).norm() < 1e-9, "{without} {with}");
}

#[test]
fn bad_shift_is_refused() {
    let mut closed = running::<CaseOne<f64>>();
    let before = format!("{:?}", closed.observer);
    for (shift, fault) in [(f64::NAN, Fault::Start), (f64::INFINITY, Fault::Start), (f64::MAX, Fault::State)] {
        assert_eq!(closed.observer.rebase(&Vector2::new(0.0, shift)), Err(fault));
        assert_eq!(format!("{:?}", closed.observer), before);
    }
}

#[test]
fn a_leak_takes_its_share_of_each_step() {
    let (rate, dt) = (50.0, 1e-3);
    let mut observer = Loop::<f64, CaseOne<f64>>::new(1.0, [0.01, 0.1], dt).unwrap().observer;
    observer.rebase(&Vector2::new(-1.0, 2.0)).unwrap();
    // At v2 = E, v4 = 0 and d = 0 this converter's h is zero: nothing but the leak moves chi.
    let mut step = || {
        observer.step_without_drift(Vector2::new(12.0, 0.0), [0.0], dt, Drift::Leak(rate)).unwrap();
        *observer.extension().chi()
    };
    let mut before = step();
    assert!(before.norm() > 1.0);
    for _ in 0..20 {
        let after = step();
        assert!((after - before * (-rate * dt).exp()).norm() < 1e-14, "{before} {after}");
        before = after;
    }
}

#[test]
fn an_observer_without_drift_steps_as_one_that_is_asked_each_time() {
    for form in [Drift::Above(0.3), Drift::Leak(50.0), Drift::Free] {
        let new = || Loop::<f64, CaseOne<f64>>::new(1.0, [0.01, 0.1], 1e-5).unwrap().observer;
        let (mut told, mut built) = (new(), new().without_drift(form).unwrap());
        let mut largest = 0.0_f64;
        for k in 0..1000 {
            let y = Vector2::new(30.0 + f64::from(k % 7), -20.0);
            let one = told.step_without_drift(y, [0.7], 1e-5, form).unwrap();
            let other = built.step(y, [0.7], 1e-5).unwrap();
            // The same operations: bit for bit.
            assert_eq!((one, told.extension().chi()), (other, built.extension().chi()), "{form:?} {k}");
            largest = largest.max(other.norm());
        }
        assert!(largest > 0.0);
    }
}

#[test]
fn a_form_that_is_none_is_refused_when_it_is_chosen() {
    for form in [Drift::Above(0.0), Drift::Above(f64::NAN), Drift::Leak(-1.0), Drift::Leak(f64::NAN)] {
        let observer = Loop::<f64, CaseOne<f64>>::new(1.0, [0.01, 0.1], 1e-5).unwrap().observer;
        assert_eq!(observer.without_drift(form).err(), Some(Fault::Gain), "{form:?}");
    }
}

//! Bad samples: refused, without a trace in the state.

use pebo_runtime::nalgebra::{Matrix1, SVector, Vector1, Vector2};
use pebo_runtime::{Fault, Filter, Flow, Gradient, Hold, Integrator, Model, Observer, Real, Regression, Sides};
use proptest::prelude::*;

use crate::converter::{Case, CaseOne, CaseTwoGeneralised, CukObserver, Loop};

/// The reciprocal of `z` as a left inverse, and a square root in the regression: both leave their domain.
#[derive(Clone, Debug)]
struct Narrow;

impl Model<1, 1, 1, 1, 1, 1> for Narrow {
    type Scalar = f64;
    type Extension = Integrator<f64, 1>;
    type X = SVector<Self::Scalar, 1>;
    type Y = SVector<Self::Scalar, 1>;
    type U = SVector<Self::Scalar, 1>;
    type Terms = Vector1<f64>;
    const REGRESSION: Regression = Regression::Static;

    fn terms(&self, y: &Vector1<f64>) -> Vector1<f64> {
        *y
    }
    fn flow(&self, _: &Vector1<f64>, u: &Vector1<f64>) -> Flow<f64, 1> {
        Flow::plain(*u)
    }
    fn regression(&self, _: &Self::Extension, y: &Vector1<f64>, _: &Vector1<f64>) -> Sides<f64, 1, 1> {
        Sides { known: y.map(Real::sqrt), factor: Matrix1::new(1e-3) }
    }
    fn theta(&self, eta: &Vector1<f64>) -> Vector1<f64> {
        *eta
    }
    fn recover(&self, z: &Vector1<f64>, y: &Vector1<f64>) -> Vector1<f64> {
        Vector1::new(y.x / z.x)
    }
}

type NarrowObserver = Observer<Narrow, Gradient<f64, 1>, 1, 1, 1, 1, 1, 1>;

fn narrow(chi_0: f64) -> Result<NarrowObserver, Fault> {
    let gradient = Gradient::diagonal(&Vector1::new(1.0))?;
    Observer::new(Narrow, gradient, Filter::new(1.0, Hold::First)?, Vector1::new(chi_0))
}

/// A step that must be refused and leave no trace: the printed state tells every bit of a finite number.
fn refused(observer: &mut NarrowObserver, y: f64, u: f64, dt: f64) -> Fault {
    let before = format!("{observer:?}");
    let fault = observer.step(Vector1::new(y), Vector1::new(u), dt).unwrap_err();
    assert_eq!(format!("{observer:?}"), before);
    fault
}

#[test]
fn every_fault_leaves_the_state_as_it_was() {
    let mut observer = narrow(1.0).unwrap();
    // Before the first sample and after some: the same rules.
    for _ in 0..3 {
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            assert_eq!(refused(&mut observer, bad, 0.0, 0.1), Fault::Output { index: 0 });
            assert_eq!(refused(&mut observer, 1.0, bad, 0.1), Fault::Input { index: 0 });
            assert_eq!(refused(&mut observer, 1.0, 0.0, bad), Fault::Step);
        }
        for bad in [0.0, -0.0, -0.1] {
            assert_eq!(refused(&mut observer, 1.0, 0.0, bad), Fault::Step);
        }
        observer.step(Vector1::new(1.0), Vector1::new(0.0), 0.1).unwrap();
    }
    // The square root of a negative number, an integral that overflows, a left inverse at its pole.
    assert_eq!(refused(&mut observer, -1.0, 0.0, 0.1), Fault::State);
    assert_eq!(refused(&mut observer, 1.0, 1e200, 1e200), Fault::State);
    assert_eq!(refused(&mut narrow(0.0).unwrap(), 1.0, 0.0, 0.1), Fault::Estimate);
    assert_eq!(narrow(f64::NAN).unwrap_err(), Fault::Start);
}

#[test]
fn index_names_the_bad_channel() {
    let mut observer: CukObserver<f64, CaseOne<f64>> = Loop::new(1.0, [0.01, 0.1], 1e-5).unwrap().observer;
    let fault = observer.step(Vector2::new(1.0, f64::NAN), Vector1::new(0.5), 1e-5);
    assert_eq!(fault, Err(Fault::Output { index: 1 }));
    assert_eq!(Fault::Output { index: 1 }.to_string(), "output sample 1 is not finite");
    let _: &dyn core::error::Error = &Fault::Step;
}

#[test]
fn step_after_a_refused_one_covers_both_intervals() {
    let (mut seeing, mut blind) = (narrow(1.0).unwrap(), narrow(1.0).unwrap());
    for observer in [&mut seeing, &mut blind] {
        observer.step(Vector1::new(4.0), Vector1::new(0.0), 0.1).unwrap();
    }
    refused(&mut blind, f64::NAN, 0.5, 0.1);
    let whole = |observer: &mut NarrowObserver| observer.step(Vector1::new(9.0), Vector1::new(0.5), 0.2).unwrap();
    assert_eq!(whole(&mut blind), whole(&mut seeing));
    assert_eq!(format!("{blind:?}"), format!("{seeing:?}"));
}

#[test]
fn first_sample_only_sets_the_clock() {
    let mut observer = narrow(2.0).unwrap();
    assert_eq!(observer.estimate(), None);
    assert_eq!(observer.estimate_at(Vector1::new(3.0)), Vector1::new(1.5));
    let estimate = observer.step(Vector1::new(3.0), Vector1::new(1e9), 1e9).unwrap();
    assert_eq!((estimate, observer.estimate()), (Vector1::new(1.5), Some(Vector1::new(1.5))));
    assert_eq!(*observer.extension().chi(), Vector1::new(2.0));
    assert_eq!(*observer.regression().regressor(), Matrix1::new(0.0));
}

#[test]
fn restart_is_a_new_observer() {
    let mut observer = narrow(1.0).unwrap();
    let new = format!("{:?}", narrow(5.0).unwrap());
    for y in [4.0, 9.0, 1.0] {
        observer.step(Vector1::new(y), Vector1::new(0.5), 0.1).unwrap();
    }
    assert_eq!(observer.restart(Vector1::new(f64::NAN), &Vector1::new(0.0)), Err(Fault::Start));
    observer.restart(Vector1::new(5.0), &Vector1::new(0.0)).unwrap();
    // The filter keeps the weights of its last step: take one to make the two comparable.
    assert_eq!(observer.estimate(), None);
    let mut other = narrow(5.0).unwrap();
    assert_eq!(format!("{other:?}"), new);
    for observer in [&mut observer, &mut other] {
        for y in [4.0, 9.0] {
            observer.step(Vector1::new(y), Vector1::new(0.5), 0.1).unwrap();
        }
    }
    assert_eq!(format!("{observer:?}"), format!("{other:?}"));
}

/// Any bit pattern, and ordinary numbers between them.
fn storm() -> impl Strategy<Value = f64> {
    prop_oneof![
        any::<u64>().prop_map(f64::from_bits),
        prop::sample::select(vec![
            0.0,
            -0.0,
            f64::NAN,
            f64::INFINITY,
            -f64::INFINITY,
            f64::MAX,
            f64::MIN_POSITIVE,
            5e-324
        ]),
        -100.0..100.0,
    ]
}

fn survives<S: Real, M: Case<S>>(samples: &[[f64; 4]]) -> Result<(), TestCaseError>
where
    CukObserver<S, M>: core::fmt::Debug,
{
    let real = |x: f64| -> S { Real::from_f64(x) };
    let mut observer: CukObserver<S, M> = Loop::new(1.0, [1.0, 10.0], 1e-5).unwrap().observer;
    for &[y1, y2, u, dt] in samples {
        let before = format!("{observer:?}");
        let y = Vector2::new(real(y1), real(y2));
        if let Ok(estimate) = observer.step(y, Vector1::new(real(u)), real(dt)) {
            prop_assert!(estimate.iter().all(|&x| Real::is_finite(x)));
            prop_assert_eq!(Some(estimate), observer.estimate());
        } else {
            prop_assert_eq!(format!("{:?}", observer), before);
        }
        prop_assert!(observer.eta().iter().chain(observer.theta().iter()).all(|&x| Real::is_finite(x)));
    }
    Ok(())
}

proptest! {
    #[test]
    fn storms_neither_panic_nor_enter_the_state(samples in prop::collection::vec([storm(), storm(), storm(), storm()], 1..40)) {
        survives::<f64, CaseOne<f64>>(&samples)?;
        survives::<f32, CaseOne<f32>>(&samples)?;
        survives::<f64, CaseTwoGeneralised<f64>>(&samples)?;
        survives::<f32, CaseTwoGeneralised<f32>>(&samples)?;
    }
}

#[test]
fn a_constant_that_is_not_finite_is_a_fault_with_its_place() {
    // 1/(I1 I2 - I12^2) of moments of inertia of 1e-20 kg m^2: the product has no digits left in f32, and all in f64.
    let divided = 1.0 / (2e-20_f32 * 3e-20 - 1e-20 * 1e-20);
    assert_eq!(Fault::of_constants([1.0, divided]), Err(Fault::Constant { index: 1 }));
    assert_eq!(Fault::of_constants([f32::NAN, divided]), Err(Fault::Constant { index: 0 }));
    assert_eq!(Fault::of_constants([1.0, 1.0 / (2e-20_f64 * 3e-20 - 1e-20 * 1e-20)]), Ok(()));
}

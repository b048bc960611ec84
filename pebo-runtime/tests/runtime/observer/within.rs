//! Bounds of the state that goes out.

use pebo_runtime::nalgebra::{Vector1, Vector2};
use pebo_runtime::{Fault, Gradient, Observer, Within};

use crate::converter::{Case, CaseOne, Loop};

#[test]
fn a_state_within_its_bounds_is_never_further_away() {
    // The currents of this run stay between -3 and 3 A; at the start the observer is far off.
    let bounds = (Vector2::new(0.0, -3.0), Vector2::new(3.0, 0.0));
    let build = |model| {
        let gradient = Gradient::diagonal(&Vector2::new(1.0, 10.0)).unwrap();
        let filter = pebo_runtime::Filter::new(1.0, pebo_runtime::Hold::First).unwrap();
        Observer::<_, _, 2, 2, 1, 2, 2, 2>::new(model, gradient, filter, Vector2::new(-5.0, 7.0)).unwrap()
    };
    let mut bounded = build(Within::new(CaseOne::<f64>::new(), &bounds.0, &bounds.1).unwrap());
    let mut plain = build(Within::new(CaseOne::<f64>::new(), &Vector2::repeat(-1e9), &Vector2::repeat(1e9)).unwrap());
    let mut closed = Loop::<f64, CaseOne<f64>>::new(1.0, [1.0, 10.0], 1e-5).unwrap();
    let mut cut = 0;
    for k in 0..2000 {
        let u = Vector1::new(closed.duty());
        if k > 0 {
            closed.advance().unwrap();
        }
        let y = closed.outputs();
        let (one, other) = (bounded.step(y, u, 1e-5).unwrap(), plain.step(y, u, 1e-5).unwrap());
        let truth = CaseOne::<f64>::unmeasured(&closed.circuit);
        for i in 0..2 {
            if (bounds.0[i]..=bounds.1[i]).contains(&truth[i]) {
                assert!((one[i] - truth[i]).abs() <= (other[i] - truth[i]).abs());
            }
            assert!((bounds.0[i]..=bounds.1[i]).contains(&one[i]));
        }
        cut += u32::from(one != other);
        // The estimate of the unknown knows nothing of it.
        assert_eq!(bounded.theta(), plain.theta());
    }
    assert!(cut > 10, "{cut}");
}

#[test]
fn what_has_no_value_stays_a_fault() {
    let model = Within::new(CaseOne::<f64>::new(), &Vector2::repeat(-1.0), &Vector2::repeat(1.0)).unwrap();
    let gradient = Gradient::diagonal(&Vector2::new(1.0, 10.0)).unwrap();
    let filter = pebo_runtime::Filter::new(1.0, pebo_runtime::Hold::First).unwrap();
    let start = Vector2::new(f64::MAX, 0.0);
    let gradient = gradient.starting_at(&start).unwrap();
    let mut observer = Observer::<_, _, 2, 2, 1, 2, 2, 2>::new(model, gradient, filter, start).unwrap();
    assert_eq!(observer.step(Vector2::new(10.0, 0.0), Vector1::new(0.5), 1e-5), Err(Fault::Estimate));
    for (lower, upper) in [(1.0, 0.0), (f64::NAN, 0.0)] {
        let refused = Within::new(CaseOne::<f64>::new(), &Vector2::repeat(lower), &Vector2::repeat(upper));
        assert_eq!(refused.err(), Some(Fault::Start));
    }
}

//! DREM: its extensions hold exactly, and its speed is that of its gains, whatever the units and however many unknowns.

use pebo_runtime::nalgebra::{SMatrix, SVector, Vector2, Vector3};
use pebo_runtime::{Drem, Estimator, Kreisselmeier, LeastSquares, Real, RegressorExtension, Response};

/// Regressors that turn, so that the data determine all unknowns equally well.
fn turning<S: Real, const N: usize>(k: u32) -> SMatrix<S, 1, N> {
    let rates = [1.0, 1.7, 2.3, 3.1, 4.3, 5.9];
    SMatrix::from_fn(|_, j| Real::from_f64((0.05 * rates[j] * f64::from(k)).sin()))
}

#[test]
fn response_starts_with_the_data_of_the_estimator() {
    // After a hundred samples least squares hardly moves: the response of an estimator that is still free is another.
    let truth = Vector3::new(1.0, -2.0, 0.5);
    let mut squares = LeastSquares::<f64, 3>::diagonal(&Vector3::new(10.0, 10.0, 10.0), 0.1).unwrap();
    for k in 0..100 {
        let phi = turning::<f64, 3>(k);
        squares.advance(&phi, &(phi * Vector3::new(3.0, 3.0, 3.0)), 0.01).unwrap();
    }
    let mut extension = Response::<f64, _, 1, 3>::new(squares).unwrap();
    let mut largest = 0.0_f64;
    for k in 100..300 {
        let phi = turning::<f64, 3>(k);
        extension.advance(&phi, &(phi * truth), 0.01).unwrap();
        largest = largest.max((extension.matrix() * truth - extension.vector()).norm());
    }
    // Some roundings of numbers up to 3 in each of 200 steps.
    assert!(largest < 1e-13, "{largest:e}");
    // Started again it has no memory, as the estimator then has none.
    RegressorExtension::<f64, 1, 3>::reset(&mut extension);
    squares = LeastSquares::diagonal(&Vector3::new(10.0, 10.0, 10.0), 0.1).unwrap();
    let mut fresh = Response::<f64, _, 1, 3>::new(squares).unwrap();
    let phi = turning::<f64, 3>(7);
    for response in [&mut extension, &mut fresh] {
        response.advance(&phi, &(phi * truth), 0.01).unwrap();
    }
    assert_eq!((extension.matrix(), extension.vector()), (fresh.matrix(), fresh.vector()));
}

/// Seconds until a hundredth of the error is left, with all gains at 1000/s and an extension that has long been full.
fn settles<const N: usize>() -> f64 {
    let truth = SVector::<f64, N>::repeat(1.0);
    let mut drem =
        Drem::new(Kreisselmeier::new(&SVector::repeat(1e6), 0.0).unwrap(), &SVector::<f64, N>::repeat(1e-9)).unwrap();
    let fill = |drem: &mut Drem<f64, Kreisselmeier<f64, N>, N>, k: u32| {
        let phi = turning::<f64, N>(k);
        drem.advance(&phi, &(phi * truth), 1e-5).unwrap();
    };
    (0..20_000).for_each(|k| fill(&mut drem, k));
    let mut drem = Drem::new(*drem.extension(), &SVector::repeat(1000.0)).unwrap();
    let mut steps = 0_u32;
    while (drem.estimate() - truth).norm() > 0.01 * truth.norm() && steps < 1_000_000 {
        fill(&mut drem, 20_000 + steps);
        steps += 1;
    }
    f64::from(steps) * 1e-5
}

#[test]
fn speed_does_not_fall_with_the_number_of_unknowns() {
    // e^(-1000 Delta^2 t) = 1/100 after 4.6 ms with Delta = 1. The directions are seen almost equally well and almost
    // independently, so Delta is almost 1.
    for seconds in [settles::<1>(), settles::<2>(), settles::<3>(), settles::<4>(), settles::<6>()] {
        assert!((4.6e-3..6e-3).contains(&seconds), "{seconds}");
    }
}

/// The largest error left after 20 time constants, in shares of each unknown, with unknowns of very unequal units.
fn left<const N: usize>(units: [f32; N]) -> f32 {
    let truth = SVector::<f32, N>::from(units);
    // Gains of the extension that know the units, as their docs ask for.
    let gains = truth.map(|unit| unit * unit * 1e3);
    let mut drem = Drem::new(Kreisselmeier::new(&gains, 0.0).unwrap(), &SVector::repeat(100.0)).unwrap();
    equal_gains(&truth);
    for k in 0..20_000 {
        let phi = turning::<f32, N>(k).component_div(&truth.transpose());
        drem.advance(&phi, &(phi * truth), 1e-5).unwrap();
    }
    (drem.estimate() - truth).component_div(&truth).abs().max()
}

/// The same where the gains of the extension know nothing of the units, but are high enough for all.
fn equal_gains<const N: usize>(truth: &SVector<f32, N>) {
    let mut drem =
        Drem::new(Kreisselmeier::new(&SVector::repeat(1e15), 0.0).unwrap(), &SVector::repeat(100.0)).unwrap();
    for k in 0..20_000 {
        let phi = turning::<f32, N>(k).component_div(&truth.transpose());
        drem.advance(&phi, &(phi * truth), 1e-5).unwrap();
    }
    let left = (drem.estimate() - truth).component_div(truth).abs().max();
    assert!(left < 1e-3, "{left}");
}

#[test]
fn units_of_the_unknowns_do_not_matter() {
    // A flux of 1 mWb beside a speed of 1000 rad/s, and worse. e^-20 is 2e-9; the Gramian is known to 20000 roundings
    // of single precision at most, of which the conditioning makes a few percent of the distance left, not of the
    // limit.
    for left in [left([1e-3, 1e3]), left([1e-6, 1e6])] {
        assert!(left < 1e-3, "{left}");
    }
    for left in [left([1e-4, 1.0, 1e4]), left([1e-3, 1.0, 1e3, 1e-2])] {
        assert!(left < 1e-3, "{left}");
    }
}

#[test]
fn determinant_is_a_measure_between_zero_and_one() {
    let mut drem =
        Drem::new(Kreisselmeier::new(&Vector2::new(1e6, 1e6), 0.0).unwrap(), &Vector2::new(1.0, 1.0)).unwrap();
    for k in 0..10_000 {
        let phi = turning::<f64, 2>(k);
        drem.advance(&phi, &(phi * Vector2::new(1.0, 1.0)), 1e-3).unwrap();
        let delta = drem.determinant::<1>();
        // A rounding of products up to 1.
        assert!((-1e-15..=1.0).contains(&delta), "{delta}");
    }
    assert!(drem.determinant::<1>() > 0.99);
    // One direction alone: nothing is determined.
    let mut drem =
        Drem::new(Kreisselmeier::new(&Vector2::new(1e6, 1e6), 0.0).unwrap(), &Vector2::new(1.0, 1.0)).unwrap();
    for _ in 0..1000 {
        let phi = SMatrix::<f64, 1, 2>::new(1.0, 2.0);
        drem.advance(&phi, &(phi * Vector2::new(1.0, 1.0)), 1e-3).unwrap();
        // Of two rows that are multiples of each other up to rounding.
        assert!(drem.determinant::<1>().abs() < 1e-12);
    }
}

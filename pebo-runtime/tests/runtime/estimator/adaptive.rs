//! Process noise that follows the innovations: a guess that is far off, an unknown that wanders, one that is constant and
//! one that steps.

use pebo_runtime::nalgebra::{Matrix1, Matrix2, SMatrix, Vector1, Vector2};
use pebo_runtime::{AdaptiveLeastSquares, Estimator, Fault, LeastSquares};

use crate::noise::Noise;

/// The sampling period, and the standard deviation of a sample.
const PERIOD: f64 = 0.1;
const SENSOR: f64 = 0.1;

/// Least squares of one unknown whose estimate starts at 0, uncertain by 10, with the variance of its drift in a second.
fn guessed(drift: f64) -> LeastSquares<f64, 1> {
    let squares = LeastSquares::diagonal(&Vector1::new(100.0), 0.0).unwrap();
    squares.with_process_noise(&Vector1::new(drift)).unwrap()
}

/// The same with that variance as a guess.
fn adaptive(guess: f64) -> AdaptiveLeastSquares<f64, 1, 1> {
    AdaptiveLeastSquares::new(guessed(0.0), &Vector1::new(guess)).unwrap()
}

/// The root mean squares of the error over each thousand samples of an unknown that wanders by `drift` as a variance in a
/// second, and steps by 1 after 5000 samples if it is to. Samples are weighed as if the sensor erred by `believed`.
fn errors<E: Estimator<f64, 1, 1>>(estimator: &mut E, believed: f64, (drift, step): (f64, bool)) -> [f64; 10] {
    let (mut noise, mut truth) = (Noise::new(3), 2.0);
    let weight = 1.0 / (believed * PERIOD.sqrt());
    let mut squares = [0.0; 10];
    for square in squares.iter_mut().enumerate() {
        for k in 0..1000 {
            truth += noise.normal() * (drift * PERIOD).sqrt();
            if step && square.0 == 5 && k == 0 {
                truth += 1.0;
            }
            let sample = truth + SENSOR * noise.normal();
            estimator.advance(&Matrix1::new(weight), &Vector1::new(weight * sample), PERIOD).unwrap();
            *square.1 += (estimator.estimate().x - truth).powi(2) / 1000.0;
        }
    }
    squares.map(f64::sqrt)
}

#[test]
fn an_unknown_that_wanders_is_followed_as_with_its_true_drift() {
    let drift = 4e-5;
    let told = errors(&mut guessed(drift), SENSOR, (drift, false));
    // The drift is guessed four hundred times too large, or the sensor's variance a hundred times too small.
    for (guess, believed) in [(400.0 * drift, SENSOR), (drift, 0.1 * SENSOR)] {
        let plain = errors(&mut guessed(guess), believed, (drift, false));
        let mut adaptive = adaptive(guess);
        let followed = errors(&mut adaptive, believed, (drift, false));
        let last = |errors: [f64; 10]| errors[5..].iter().sum::<f64>();
        let (best, plain, followed) = (last(told), last(plain), last(followed));
        println!("{guess:e} {believed:e}: told {best:.3}, guessed {plain:.3}, adaptive {followed:.3}");
        // The factor moves by some tenths around its best value, where the error is flat.
        assert!(followed < 1.15 * best && plain > 1.5 * best, "{guess} {believed}: {best} {plain} {followed}");
    }
}

#[test]
fn a_constant_is_known_ever_better_and_a_step_of_it_is_seen() {
    // A guess of its own order of magnitude within a thousand samples, as of an observer without numbers.
    let guess = 4.0 / (1000.0 * PERIOD);
    let plain = errors(&mut guessed(guess), SENSOR, (0.0, true));
    let mut adaptive = adaptive(guess);
    let followed = errors(&mut adaptive, SENSOR, (0.0, true));
    println!("guessed {plain:?}\nadaptive {followed:?}, factor {}", adaptive.factor());
    assert!(followed[4] < plain[4] / 3.0 && followed[9] < plain[9] / 3.0);
    // Of the step of ten standard deviations nothing is left after a dozen samples: 1 in 12 of 1000 is 0.11.
    assert!(followed[5] < 0.12 && followed[6] < plain[6] / 10.0);
    // A filter that takes the unknown for a constant has half of the step left after as many samples again.
    let constant = errors(&mut guessed(0.0), SENSOR, (0.0, true));
    assert!(constant[9] > 10.0 * followed[9]);
}

#[test]
fn without_noise_a_step_is_followed() {
    let mut adaptive = adaptive(0.04);
    for (truth, left) in [(2.0, 1e-5), (3.0, 1e-9)] {
        for _ in 0..1000 {
            adaptive.advance(&Matrix1::new(10.0), &Vector1::new(10.0 * truth), PERIOD).unwrap();
        }
        // At first the weight of the start is left, 1e-4 of that of a sample; after the step the gain is near 1/3.
        let error = (Estimator::<f64, 1, 1>::estimate(&adaptive).x - truth).abs();
        assert!(error < left, "{truth}: {error}");
    }
}

#[test]
fn a_missing_row_says_nothing() {
    let squares = LeastSquares::diagonal(&Vector2::repeat(100.0), 0.0).unwrap();
    let fresh = AdaptiveLeastSquares::new(squares, &Vector2::repeat(0.04)).unwrap();
    let (mut whole, mut parted) = (fresh, fresh);
    let (both, first) = (Matrix2::identity() * 30.0, Matrix2::new(30.0, 0.0, 0.0, 0.0));
    let mut noise = Noise::new(1);
    for k in 0..500_u32 {
        // Both go on, which the estimator does not expect.
        let y = Vector2::repeat(0.01 * f64::from(k)) + Vector2::new(noise.normal(), noise.normal()) * 0.1;
        whole.advance(&both, &(both * y), PERIOD).unwrap();
        parted.advance(&first, &(first * y), PERIOD).unwrap();
        // Nothing at all.
        let factor = parted.factor();
        parted.advance(&SMatrix::zeros(), &Vector2::zeros(), PERIOD).unwrap();
        assert_eq!(parted.factor().to_bits(), factor.to_bits());
    }
    assert!(whole.factor() > 100.0 * fresh.factor() && parted.factor() > 100.0 * fresh.factor());
    // Begun anew it has its guess again.
    Estimator::<f64, 2, 2>::reset(&mut whole, &Vector2::zeros());
    assert_eq!(whole.factor().to_bits(), fresh.factor().to_bits());
}

#[test]
fn data_that_are_not_finite_show() -> Result<(), Fault> {
    // A square that overflows too: the mean square would say nothing from then on.
    for bad in [f64::NAN, f64::INFINITY, 1e300] {
        let mut adaptive = adaptive(0.04);
        adaptive.advance(&Matrix1::new(1.0), &Vector1::new(1.0), PERIOD)?;
        adaptive.advance(&Matrix1::new(1.0), &Vector1::new(bad), PERIOD)?;
        assert!(!Estimator::<f64, 1, 1>::is_finite(&adaptive), "{bad}");
    }
    for bad in [-1.0, f64::NAN, f64::INFINITY] {
        assert_eq!(AdaptiveLeastSquares::<f64, 1, 1>::new(guessed(0.0), &Vector1::new(bad)), Err(Fault::Gain));
    }
    Ok(())
}

#[test]
fn an_outlier_is_forgotten() {
    let mut hit = adaptive(0.04);
    errors(&mut hit, SENSOR, (4e-5, false));
    let before = hit.factor();
    hit.advance(&Matrix1::new(30.0), &Vector1::new(3e7), PERIOD).unwrap();
    let moved = Estimator::<f64, 1, 1>::estimate(&hit).x;
    assert!(moved > 1e3, "{moved}");
    Estimator::<f64, 1, 1>::shift(&mut hit, &Vector1::new(2.0 - moved));
    let mut noise = Noise::new(2);
    for _ in 0..100 {
        hit.advance(&Matrix1::new(30.0), &Vector1::new(60.0 + 3.0 * noise.normal()), PERIOD).unwrap();
    }
    // It counted as three standard deviations; and the estimate begins at a value that is not quite the one before.
    let ratio = hit.factor() / before;
    assert!((0.2..5.0).contains(&ratio), "{ratio}");
}

//! Least squares whose process noise follows from what the samples show.

use nalgebra::{SMatrix, SVector};

use super::{Estimator, Information, LeastSquares, Uncertain};
use crate::numeric::sum::all_finite;
use crate::{Fault, Real, Turn};

/// Least squares of an unknown that wanders nobody knows how much: up to a guess of it, as the innovations tell.
///
/// Too much process noise and the estimate follows the noise of the sensors, too little and it does not follow the plant.
/// Innovations tell the two apart, whatever their size. With the best gain they are independent of each other; with too
/// large a gain each undoes a part of the one before, with too small a gain they have the same sign. So the guess counts
/// with a factor, which grows while an innovation and the mean of those before it have the same sign, fast where they are
/// far out, and shrinks while they have not.
///
/// Holds when: the equations are samples with independent errors, as of a
/// [`SampledRegression`](crate::SampledRegression); a filter would correlate them by itself. The factor is between `1e-6`,
/// where it begins, and 1, one for all components. For an unknown that wanders as white noise adds up it settles around
/// the one with which innovations are white, whatever weights the samples were given. A constant is known ever better, up
/// to a thousandth of the guessed drift.
///
/// A step shows at once in the mean of the last innovations: beyond five of its own standard deviations, what the unknown is
/// guessed to wander in a thousand samples has happened, and the covariance gains it. So it is at most once in as many, and
/// the unknown never wanders more than twice the guess.
///
/// Units and everything else are those of [`LeastSquares`]. A sample whose row is zero, as of a missing output, says
/// nothing of the factor.
///
/// Source: whiteness of the innovations as the mark of the best gain: Mehra, *On the identification of variances and
/// adaptive Kalman filtering*, IEEE TAC, 1970; a rate that follows the sign of successive corrections: Jacobs, *Increased
/// rates of convergence through learning rate adaptation*, Neural Networks, 1988.
#[derive(Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct AdaptiveLeastSquares<S: Real, const NR: usize, const NE: usize> {
    /// With the process noise that is known.
    squares: LeastSquares<S, NE>,
    /// The intensity of what the unknown is guessed to wander besides, of each component.
    guess: SVector<S, NE>,
    /// What it wanders, as a multiple of the guess.
    factor: S,
    /// The mean of each row's last innovations.
    mean: SVector<S, NR>,
    /// The mean of their squares.
    square: SVector<S, NR>,
    /// The number of them in that mean.
    seen: SVector<S, NR>,
    /// The samples since the last step of the unknown, or the start.
    since: S,
}

/// The share of an innovation in the mean of those before: a memory of some ten samples.
const IN_MEAN: f64 = 0.1;

/// The innovations in the mean of their squares, which is to stand still while the other mean moves. The factor waits for
/// as many: before, nothing is known of their size.
const IN_SQUARE: f64 = 50.0;

/// An innovation beyond three standard deviations counts as three: a step of the unknown stands out of their mean square,
/// and an outlier is forgotten with the samples after it.
const LARGEST: f64 = 3.0;

/// The relative change of the factor where innovation and mean agree or disagree by one standard deviation.
const PACE: f64 = 0.05;

/// The mean of innovations that shows a step, in their standard deviations: 5.2 of its own where they are independent, as
/// the variance of a mean with this memory is `IN_MEAN / (2 - IN_MEAN)` of theirs.
const STEP: f64 = 1.2;

/// The samples whose guessed drift a step is, and after which there may be another.
const IN_STEP: f64 = 1000.0;

/// The bounds of the factor. It begins at the lower one, with a thousandth of the guessed deviation: an unknown is taken
/// for constant until samples contradict that.
const RANGE: [f64; 2] = [1e-6, 1.0];

#[allow(clippy::expl_impl_clone_on_copy, reason = "as one block: member by member each matrix is copied twice")]
impl<S: Real, const NR: usize, const NE: usize> Clone for AdaptiveLeastSquares<S, NR, NE> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<S: Real, const NR: usize, const NE: usize> AdaptiveLeastSquares<S, NR, NE> {
    /// The same estimator with a guess of what the unknown wanders beyond its process noise, which is known, as the noise
    /// of outputs that drive a cascade: a diagonal, in units of `P` per second.
    ///
    /// # Errors
    /// [`Fault::Gain`] unless each entry is finite and not negative.
    pub fn new(squares: LeastSquares<S, NE>, guess: &SVector<S, NE>) -> Result<Self, Fault> {
        squares.with_process_noise(guess)?;
        let (mean, square, seen) = (SVector::zeros(), SVector::zeros(), SVector::zeros());
        let (factor, since) = (Real::from_f64(RANGE[0]), S::zero());
        Ok(Self { squares, guess: *guess, factor, mean, square, seen, since })
    }

    /// What the unknown wanders at present, as a multiple of the guess.
    pub fn factor(&self) -> S {
        self.factor
    }

    /// `R = P^-1`, in triangular form.
    pub fn information(&self) -> &Information<S, NE> {
        self.squares.information()
    }

    /// Takes the innovations of a sample, each in its standard deviations and with the share of the sensor's noise in its
    /// variance; zero where a row is missing.
    fn learn(&mut self, innovations: &SVector<S, NR>, shares: &SVector<S, NR>) {
        let [in_mean, in_square, largest, pace] = [IN_MEAN, IN_SQUARE, LARGEST, PACE].map(<S as Real>::from_f64);
        let (mut agreement, mut rows) = (S::zero(), S::zero());
        for (row, &innovation) in innovations.iter().enumerate().filter(|(_, innovation)| **innovation != S::zero()) {
            let (mean, before, mut innovation) = (self.mean[row], self.square[row], innovation);
            if self.seen[row] < in_square {
                self.seen[row] += S::one();
            } else if before > S::zero() {
                let most = largest * Real::sqrt(before);
                innovation = Real::larger(Real::smaller(innovation, most), -most);
                let product = innovation * mean / before;
                // Where little is known of the unknown the gain is large already, and more drift would not change it.
                agreement += if product > S::zero() { product * shares[row] } else { product };
                rows += S::one();
            }
            self.square[row] = before + (innovation * innovation - before) / self.seen[row];
            self.mean[row] = mean + in_mean * (innovation - mean);
        }
        if rows > S::zero() {
            let change = Real::larger(pace * agreement / rows, -pace);
            let [least, most] = RANGE.map(<S as Real>::from_f64);
            self.factor = Real::smaller(Real::larger(self.factor * (S::one() + change), least), most);
        }
    }
}

impl<S: Real, const NR: usize, const NE: usize> Estimator<S, NR, NE> for AdaptiveLeastSquares<S, NR, NE> {
    fn advance(&mut self, regressor: &SMatrix<S, NR, NE>, regressand: &SVector<S, NR>, dt: S) -> Result<(), Fault> {
        let [mut innovations, mut shares] = [SVector::zeros(); 2];
        let seen = |row: usize, rest: S, weight, share| {
            innovations[row] = rest * Real::sqrt(weight);
            shares[row] = share;
        };
        let noise = self.squares.noise() + self.guess * self.factor;
        self.squares.take(regressor, regressand, dt, &noise, seen)?;
        self.learn(&innovations, &shares);
        let [step, in_step] = [STEP, IN_STEP].map(<S as Real>::from_f64);
        if self.since < in_step {
            self.since += S::one();
        } else if (0..NR).any(|row| shares[row] * self.mean[row] * self.mean[row] > step * step * self.square[row]) {
            self.squares.diffuse(&self.guess, in_step * dt);
            (self.mean, self.since) = (SVector::zeros(), S::zero());
        }
        Ok(())
    }

    fn estimate(&self) -> SVector<S, NE> {
        *self.squares.estimate()
    }

    fn shift(&mut self, shift: &SVector<S, NE>) {
        Estimator::<S, NR, NE>::shift(&mut self.squares, shift);
    }

    fn information(&self) -> Option<&Information<S, NE>> {
        Estimator::<S, NR, NE>::information(&self.squares)
    }

    fn turn(&mut self, turn: &Turn<S, NE>) {
        Estimator::<S, NR, NE>::turn(&mut self.squares, turn);
    }

    fn reset(&mut self, estimate: &SVector<S, NE>) {
        Estimator::<S, NR, NE>::reset(&mut self.squares, estimate);
        self.factor = Real::from_f64(RANGE[0]);
        [self.mean, self.square, self.seen] = [SVector::zeros(); 3];
        self.since = S::zero();
    }

    fn is_finite(&self) -> bool {
        let is_finite = all_finite(&self.mean) && all_finite(&self.square) && Real::is_finite(self.factor);
        is_finite && Estimator::<S, NR, NE>::is_finite(&self.squares)
    }
}

impl<S: Real, const NR: usize, const NE: usize> Uncertain<S, NE> for AdaptiveLeastSquares<S, NR, NE> {
    fn covariance_root(&self, dt: S) -> Option<SMatrix<S, NE, NE>> {
        let mut squares = self.squares;
        squares.diffuse(&self.guess, self.factor * dt);
        squares.covariance_root(dt)
    }
}

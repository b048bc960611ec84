//! Advances a linear system with constant coefficients over one step: `z_new = z + gained`.

use nalgebra::{SMatrix, SVector};

use crate::numeric::dense::{add_product, applied, largest, largest_row, product};
use crate::{Fault, Real, Turn};

/// More halvings than any step needs that is not 1e19 times too long.
const HALVINGS: u32 = 64;

/// The map of a step of `z' = Lambda z + h`, forth and back.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Propagator<S: Real, const N: usize> {
    /// `e^q`, `q = Lambda dt`.
    pub(crate) turn: Turn<S, N>,
    /// What the state gains: `(e^q - 1) q^-1 (q z + h dt)`, whether or not `q` has an inverse.
    pub(crate) gained: SVector<S, N>,
    /// `e^q` itself after a long step: where it dies out, rounding beside the identity would leave nothing of it.
    pub(crate) whole: Option<SMatrix<S, N, N>>,
}

impl<S: Real, const N: usize> Propagator<S, N> {
    /// That of no time.
    pub(crate) fn nothing() -> Self {
        Self { turn: Turn::nothing(), gained: SVector::zeros(), whole: None }
    }

    /// Becomes the step with `q = Lambda dt` of a state that changes at `rate = q z + h dt`, from that of no time.
    ///
    /// Method: the series of the hyperbolic sine and cosine of `q`, whose sum and difference are both maps: from `q^3` up
    /// to `q^9`, as far as rounding shows a term. That errs by `|q|^10/3628800`; `q` is halved until `|q| <= 1` and the
    /// result squared as often, which keeps its sign and decay at any step. Source: Higham, *The scaling and squaring
    /// method for the matrix exponential revisited*, SIAM J. Matrix Anal. Appl., 2005.
    ///
    /// # Errors
    /// [`Fault::Singular`] if `q` is so large that no number of halvings will do.
    #[inline]
    pub(crate) fn set(&mut self, q: &mut SMatrix<S, N, N>, rate: &mut SVector<S, N>) -> Result<(), Fault> {
        let real = |number: f64| -> S { Real::from_f64(number) };
        let [mut square, mut fourth] = [SMatrix::<S, N, N>::zeros(); 2];
        add_product(&mut square, q, q);
        let largest_2 = largest_row(&square);
        if largest_2 * largest_2 <= real(24.0) * S::EPSILON {
            self.sum(q, rate, [&square, &fourth], Order::Third);
            return Ok(());
        }
        add_product(&mut fourth, &square, &square);
        let largest_4 = largest_row(&fourth);
        let halvings = if largest_4 > S::one() { halvings_of(size_in_any_units(q))? } else { 0 };
        if halvings > 0 {
            let share = Real::powi(real(0.5), halvings.cast_signed());
            *q *= share;
            *rate *= share;
            square = product(q, q);
            fourth = product(&square, &square);
            self.sum(q, rate, [&square, &fourth], Order::Ninth);
            self.double(halvings);
            return Ok(());
        }
        let order = if largest_4 * largest_2 <= real(720.0) * S::EPSILON {
            Order::Fifth
        } else if largest_4 * largest_4 <= real(40320.0) * S::EPSILON {
            Order::Seventh
        } else {
            Order::Ninth
        };
        self.sum(q, rate, [&square, &fourth], order);
        Ok(())
    }

    /// The series, from the second and fourth power of `q`.
    #[inline]
    fn sum(
        &mut self,
        q: &SMatrix<S, N, N>,
        rate: &SVector<S, N>,
        [square, fourth]: [&SMatrix<S, N, N>; 2],
        order: Order,
    ) {
        let real = |number: f64| -> S { Real::from_f64(number) };
        let [of_2, of_4, of_6, of_8] = [2.0, 24.0, 720.0, 40320.0].map(|factorial| real(1.0 / factorial));
        let [of_3, of_5, of_7, of_9] = [6.0, 120.0, 5040.0, 362_880.0].map(|factorial| real(1.0 / factorial));
        let even = &mut self.turn.gained;
        let mut beyond = SMatrix::<S, N, N>::zeros();
        let mut rate_odd = rate * of_2;
        accumulate(even, &mut beyond, square, [of_2, of_3]);
        if order > Order::Third {
            accumulate(even, &mut beyond, fourth, [of_4, of_5]);
            let rate_2 = applied(square, rate);
            rate_odd += rate_2 * of_4;
            if order > Order::Fifth {
                let mut power = SMatrix::<S, N, N>::zeros();
                add_product(&mut power, fourth, square);
                accumulate(even, &mut beyond, &power, [of_6, of_7]);
                rate_odd += applied(fourth, rate) * of_6;
                if order > Order::Seventh {
                    power.fill(S::zero());
                    add_product(&mut power, fourth, fourth);
                    accumulate(even, &mut beyond, &power, [of_8, of_9]);
                    rate_odd += applied(fourth, &rate_2) * of_8;
                }
            }
        }
        let odd = &mut self.turn.lost;
        *odd = *q;
        add_product(odd, &beyond, q);
        self.gained = rate + applied(&beyond, rate) + applied(q, &rate_odd);
        for (evens, odds) in even.data.0.iter_mut().zip(&mut odd.data.0) {
            for (even, odd) in evens.iter_mut().zip(odds) {
                (*even, *odd) = (*odd + *even, *odd - *even);
            }
        }
    }

    /// The map of a step that is so many times twice as long.
    fn double(&mut self, halvings: u32) {
        let identity = SMatrix::<S, N, N>::identity();
        let (mut whole, mut back) = (identity + self.turn.gained, identity - self.turn.lost);
        for _ in 0..halvings {
            self.gained += applied(&whole, &self.gained);
            whole = product(&whole, &whole);
            back = product(&back, &back);
        }
        self.turn.gained = whole - identity;
        self.turn.lost = identity - back;
        self.whole = Some(whole);
    }
}

/// The last power of `q` in the series.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
enum Order {
    Third,
    Fifth,
    Seventh,
    Ninth,
}

/// Adds a power of `q` to both series, with its factor in each.
#[inline]
fn accumulate<S: Real, const N: usize>(
    even: &mut SMatrix<S, N, N>,
    beyond: &mut SMatrix<S, N, N>,
    power: &SMatrix<S, N, N>,
    [of_even, of_odd]: [S; 2],
) {
    for ((evens, beyonds), powers) in even.data.0.iter_mut().zip(&mut beyond.data.0).zip(&power.data.0) {
        for ((even, beyond), &power) in evens.iter_mut().zip(beyonds).zip(powers) {
            *even += power * of_even;
            *beyond += power * of_odd;
        }
    }
}

/// How often a number has to be halved to be 1 at most.
fn halvings_of<S: Real>(mut size: S) -> Result<u32, Fault> {
    let mut halvings = 0;
    while size > S::one() {
        if halvings == HALVINGS {
            return Err(Fault::Singular);
        }
        size *= Real::from_f64(0.5);
        halvings += 1;
    }
    Ok(halvings)
}

/// A bound of `|q|` in the units of the coordinates that make it smallest, or nearly so, as far down as 1. 0 for a `q` that
/// is not a number, which the observer finds in the result.
fn size_in_any_units<S: Real, const N: usize>(q: &SMatrix<S, N, N>) -> S {
    // The largest ratio bounds the spectral radius for any positive weights (Collatz); these approach the best ones.
    let sizes = q.map(Real::abs);
    let mut weights = SVector::<S, N>::repeat(S::one());
    // None becomes 0, which would bound nothing.
    let least = S::EPSILON * S::EPSILON * S::EPSILON * S::EPSILON;
    let mut size = S::zero();
    for _ in 0..=2 * N {
        let ahead = applied(&sizes, &weights);
        size = largest(ahead.zip_map(&weights, |ahead, weight| ahead / weight).as_slice());
        if size <= S::one() || !Real::is_finite(size) {
            break;
        }
        weights += ahead;
        let most = largest(weights.as_slice());
        weights.apply(|weight| *weight = Real::larger(*weight / most, least));
    }
    size
}

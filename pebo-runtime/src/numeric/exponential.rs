//! Advances a linear system with constant coefficients over one step: `z_new = z + gained z + driven`.

use nalgebra::{SMatrix, SVector};

use crate::numeric::linear::solve;
use crate::{Fault, Real};

/// More halvings than any step needs that is not 1e19 times too long.
const HALVINGS: u32 = 64;

/// The map of a step of `z' = Lambda z + h`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Propagator<S: Real, const N: usize> {
    /// `e^q - 1`, `q = Lambda dt`.
    pub(crate) gained: SMatrix<S, N, N>,
    /// `(e^q - 1) q^-1 h dt`, whether or not `q` has an inverse.
    pub(crate) driven: SVector<S, N>,
    /// `e^q` itself after a long step: where it dies out, rounding beside the identity would leave nothing of it.
    pub(crate) whole: Option<SMatrix<S, N, N>>,
}

impl<S: Real, const N: usize> Propagator<S, N> {
    /// The step with `q = Lambda dt` and `drive = h dt`.
    ///
    /// Method: `(e^q - 1) q^-1` by the diagonal Pade approximant of order (3, 3) of the exponential, whose relative
    /// error is `|q|^7/1e5`; `q` is halved until `|q| <= 1` and the result squared as often, which keeps its sign and
    /// decay at any step. Source: Higham, *The scaling and squaring method for the matrix exponential revisited*, SIAM
    /// J. Matrix Anal. Appl., 2005.
    ///
    /// # Errors
    /// [`Fault::Singular`] if `q` is so large that no number of halvings will do.
    pub(crate) fn new(mut q: SMatrix<S, N, N>, mut drive: SVector<S, N>) -> Result<Self, Fault> {
        let real = |number: f64| -> S { Real::from_f64(number) };
        let half = real(0.5);
        let mut square = q * q;
        let mut halvings = 0;
        while is_long(&q, &square) {
            if halvings == HALVINGS {
                return Err(Fault::Singular);
            }
            q *= half;
            drive *= half;
            square = q * q;
            halvings += 1;
        }
        let identity = SMatrix::<S, N, N>::identity();
        let odd = (identity * half + square / real(120.0)) * q;
        let even = identity + square / real(10.0);
        let mean = solve(even - odd, identity + square / real(60.0))?;
        let (gained, mut driven) = (mean * q, mean * drive);
        if halvings == 0 {
            return Ok(Self { gained, driven, whole: None });
        }
        let mut whole = identity + gained;
        for _ in 0..halvings {
            driven += whole * driven;
            whole *= whole;
        }
        Ok(Self { gained: whole - identity, driven, whole: Some(whole) })
    }
}

/// True if `|q| > 1` in the units of the coordinates that make it smallest, or nearly so. False for a `q` that is not
/// finite, which the observer finds in the result.
fn is_long<S: Real, const N: usize>(q: &SMatrix<S, N, N>, square: &SMatrix<S, N, N>) -> bool {
    let rows = square.map(Real::abs) * SVector::<S, N>::repeat(S::one());
    if !rows.iter().any(|&row| row > S::one()) {
        return false;
    }
    // The largest ratio bounds the spectral radius for any positive weights (Collatz); these approach the best ones.
    let sizes = q.map(Real::abs);
    let mut weights = SVector::<S, N>::repeat(S::one());
    for _ in 0..2 * N {
        weights += sizes * weights;
        weights /= weights.iter().fold(S::one(), |largest, &weight| largest.max(weight));
    }
    let ahead = sizes * weights;
    // Weights that became 0 beside others bound nothing.
    !ahead.iter().zip(weights.iter()).all(|(&ahead, &weight)| ahead <= weight && weight > S::zero())
}

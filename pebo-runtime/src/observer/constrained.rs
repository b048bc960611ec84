//! Finds the value of functions that is nearest to an estimate of them.
//!
//! In: an estimate of `eta` with its information matrix, and `eta` as a function of parameters: of `theta`, or of the states
//! through `phi`. Out: the value of that function which is nearest in the norm of the information, with its slopes, found
//! by Gauss and Newton's method from given parameters, with shorter steps where a whole one leads away; and the error
//! that it has by an error of the estimate.

use nalgebra::{SMatrix, SVector};

use crate::numeric::sum::all_finite;
use crate::{Functions, Information, Real};

/// The most iterations, as a step takes a bounded time. Of a beacon's distances after a start far away, twelve and thirty
/// found hardly more than six.
const ITERATIONS: usize = 6;

/// The decrease of the squared distance from which on it is found: the next step is a thousandth of a standard deviation.
const FOUND: f64 = 1e-6;

/// The greatest distance, in standard deviations. The true value, which is among these, is farther away with ten
/// components in one case of ten thousand: beyond it the search has not found the true one, or the covariance is not
/// true, and the estimate stays as it is.
const MOST_DEVIATIONS: f64 = 6.0;

/// The value of functions that is nearest to an estimate, from these parameters on; none where there are no such
/// functions, or it is not found.
pub(super) fn nearest<S: Real, const NE: usize, const NZ: usize>(
    functions: impl Fn(&SVector<S, NZ>) -> Option<Functions<S, NE, NZ>>,
    mut parameters: SVector<S, NZ>,
    eta: &SVector<S, NE>,
    information: &Information<S, NE>,
) -> Option<Functions<S, NE, NZ>> {
    let mut at = functions(&parameters)?;
    let mut misfit = information.misfit(&(at.values - eta));
    let found: S = Real::from_f64(FOUND);
    let mut share = S::one();
    for _ in 0..ITERATIONS {
        let Ok(step) = information.along(&(at.values - eta), &at.slopes).solve() else { break };
        let next = parameters + step * share;
        let Some(there) = functions(&next) else { break };
        let left = information.misfit(&(there.values - eta));
        let is_found = Real::abs(misfit - left) <= found;
        // False for a NaN too.
        let is_nearer = left < misfit;
        if is_nearer {
            (parameters, at, misfit, share) = (next, there, left, S::one());
        } else {
            // Too far for functions that are not straight.
            share *= Real::from_f64(0.5);
        }
        if is_found {
            break;
        }
    }
    let most: S = Real::from_f64(MOST_DEVIATIONS * MOST_DEVIATIONS);
    (misfit <= most && all_finite(&at.values)).then_some(at)
}

/// The map from a change of an estimate to that of the nearest value of functions with these slopes, which are taken for
/// constant: `J (J^T W J)^-1 J^T W`. None where it is not finite.
pub(super) fn projection<S: Real, const NE: usize, const NZ: usize>(
    slopes: &SMatrix<S, NE, NZ>,
    information: &Information<S, NE>,
) -> Option<SMatrix<S, NE, NE>> {
    let mut projection = SMatrix::<S, NE, NE>::zeros();
    for j in 0..NE {
        let mut change = SVector::<S, NE>::zeros();
        change[j] = -S::one();
        projection.set_column(j, &(slopes * information.along(&change, slopes).solve().ok()?));
    }
    all_finite(&projection).then_some(projection)
}

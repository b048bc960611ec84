//! Finds the value of functions that is nearest to an estimate of them.
//!
//! In: an estimate of `eta` with its information matrix, and `eta` as a function of parameters: of `theta`, or of the states
//! through `phi`. Out: the value of that function which is nearest in the norm of the information, with its slopes, found
//! by Gauss and Newton's method from given parameters; and the error that it has by an error of the estimate.

use nalgebra::{SMatrix, SVector};

use crate::numeric::sum::all_finite;
use crate::{Functions, Information, Real};

/// The number of iterations: the estimate was a value of the function one sample before, so that few are needed, and a
/// step takes a bounded time.
const ITERATIONS: usize = 3;

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
    for _ in 0..ITERATIONS {
        let Ok(step) = information.along(&(at.values - eta), &at.slopes).solve() else { break };
        let next = parameters + step;
        let Some(there) = functions(&next) else { break };
        let left = information.misfit(&(there.values - eta));
        // False for a NaN too.
        let is_nearer = left < misfit;
        if !is_nearer {
            break;
        }
        (parameters, at, misfit) = (next, there, left);
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

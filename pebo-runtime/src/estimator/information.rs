//! Weighted least squares, one equation after another, in triangular form.

use nalgebra::{SMatrix, SVector};

use crate::numeric::sum::all_finite;
use crate::{Fault, Real, Turn};

/// A weighted least-squares problem, kept in triangular form.
///
/// It minimises `sum_i w_i (v_i - row_i d)^2` and has the information matrix `sum_i w_i row_i^T row_i = U^T D U`, `U`
/// unit upper triangular and `D` diagonal.
///
/// Method: Givens rotations without square roots. Nothing is subtracted from `D`, so it remains positive and no row,
/// weight or ratio between them makes the problem singular. The matrix itself is never formed: that would square the
/// ratios. Reference: Gentleman, *Least squares computations by Givens transformations without square roots*, J. Inst.
/// Maths Applics, 1973, and algorithm AS 75, 1974.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Information<S: Real, const N: usize> {
    /// `U^T`: column `i` is row `i` of U, with its 1 on the diagonal.
    rows: SMatrix<S, N, N>,
    weight: SVector<S, N>,
    /// The right side of `U d = target`.
    target: SVector<S, N>,
}

impl<S: Real, const N: usize> Information<S, N> {
    /// The equations `d_i = 0` with weights `1 / variance_i`.
    ///
    /// # Errors
    /// [`Fault::Gain`] unless each variance and its inverse is positive and finite.
    pub fn from_variances(variances: &SVector<S, N>) -> Result<Self, Fault> {
        let weight = variances.map(|variance| S::one() / variance);
        let positive = |&number: &S| number > S::zero() && Real::is_finite(number);
        if variances.iter().all(positive) && weight.iter().all(positive) {
            Ok(Self { weight, ..Self::vague() })
        } else {
            Err(Fault::Gain)
        }
    }

    /// The equation `d = 0` with the weight matrix `covariance^-1`.
    ///
    /// # Errors
    /// [`Fault::Gain`] unless the covariance is symmetric (up to rounding), positive definite and finite.
    pub fn from_covariance(covariance: &SMatrix<S, N, N>) -> Result<Self, Fault> {
        if !is_symmetric(covariance) {
            return Err(Fault::Gain);
        }
        // covariance = V E V^T with V unit upper triangular, from the last column to the first; then U = V^-1, D =
        // E^-1.
        let mut v = *covariance;
        let mut variances = SVector::<S, N>::zeros();
        for j in (0..N).rev() {
            let pivot = v[(j, j)];
            // The rest of the diagonal after elimination must exceed its rounding error.
            let positive = pivot > S::EPSILON * covariance[(j, j)];
            if !positive {
                return Err(Fault::Gain);
            }
            variances[j] = pivot;
            for i in 0..j {
                let factor = v[(i, j)] / pivot;
                for k in 0..=i {
                    let eliminated = factor * v[(k, j)];
                    v[(k, i)] -= eliminated;
                }
            }
            for i in 0..j {
                v[(i, j)] /= pivot;
            }
        }
        let mut information = Self::from_variances(&variances)?;
        for j in 0..N {
            for i in (0..j).rev() {
                let mut inverse = v[(i, j)];
                for k in i + 1..j {
                    inverse += v[(i, k)] * information.rows[(j, k)];
                }
                information.rows[(j, i)] = -inverse;
            }
        }
        if information.is_finite() { Ok(information) } else { Err(Fault::Gain) }
    }

    /// Adds the equation `row * d = value` with a weight, `weight >= 0`.
    #[inline]
    pub fn absorb(&mut self, row: &SVector<S, N>, value: S, weight: S) {
        self.rotate::<false>(row, value, weight);
    }

    /// The same; returns what the equation says beyond those before it, value and weight: the least sum of weighted
    /// squares grows by `weight * value^2`.
    #[inline]
    pub(crate) fn absorb_with_rest(&mut self, row: &SVector<S, N>, value: S, weight: S) -> (S, S) {
        self.rotate::<false>(row, value, weight)
    }

    /// [`absorb_with_rest`](Self::absorb_with_rest). `VAGUE` if weights may be zero before: a constant, as each step of an
    /// estimator comes here.
    #[inline]
    fn rotate<const VAGUE: bool>(&mut self, row: &SVector<S, N>, value: S, weight: S) -> (S, S) {
        let [mut row] = row.data.0;
        let (mut value, mut weight) = (value, weight);
        for i in 0..N {
            let (above, lead) = (&mut self.rows.data.0[i], row[i]);
            if lead != S::zero() {
                let before = self.weight[i];
                let after = before + weight * lead * lead;
                // Of nothing and next to nothing, nothing.
                if VAGUE && after == S::zero() {
                    continue;
                }
                let kept = before / after;
                let taken = weight * lead / after;
                self.weight[i] = after;
                weight *= kept;
                for k in i + 1..N {
                    let (entry_before, above_before) = (row[k], above[k]);
                    row[k] = entry_before - lead * above_before;
                    above[k] = kept * above_before + taken * entry_before;
                }
                let (entry, above) = (value, self.target[i]);
                value = entry - lead * above;
                self.target[i] = kept * above + taken * entry;
                // Of a row that was all there was of a component, nothing is left.
                if VAGUE && weight == S::zero() {
                    break;
                }
            }
        }
        (value, weight)
    }

    /// The same problem in `d_new = T d`: each row times `T^-1`.
    pub fn turn(&mut self, turn: &Turn<S, N>) {
        let before = core::mem::replace(self, Self::vague());
        for i in 0..N {
            let whole = &before.rows.data.0[i];
            let mut row = *whole;
            for (entry, lost) in row.iter_mut().zip(&turn.lost.data.0) {
                for (&factor, &lost) in whole.iter().zip(lost) {
                    *entry -= factor * lost;
                }
            }
            self.rotate::<true>(&SVector::from(row), before.target[i], before.weight[i]);
        }
        // A component that dies out is known ever better; the cap keeps its weight from overflowing, a fault for ever.
        let most = S::max_value().map_or(S::one() / S::EPSILON, |largest| largest * S::EPSILON);
        self.diffuse_beyond(&SVector::repeat(most));
    }

    /// No equation.
    fn vague() -> Self {
        Self { rows: SMatrix::identity(), weight: SVector::zeros(), target: SVector::zeros() }
    }

    /// Takes no component for known better than with its weight here, given those after it.
    pub(crate) fn diffuse_beyond(&mut self, most: &SVector<S, N>) {
        if self.weight.iter().zip(most.iter()).any(|(weight, most)| weight > most) {
            (0..N).for_each(|i| self.diffuse(i, S::one() / most[i]));
        }
    }

    /// Component `i` of `d` has moved by an unknown step of this variance, `variance >= 0`: the covariance gains it on
    /// its diagonal.
    ///
    /// Method: the step is one more unknown with an equation of its own, eliminated by rotations from row `i` upwards,
    /// which keeps the form triangular; nothing is subtracted from a weight. Reference: Bierman, *Factorization methods
    /// for discrete sequential estimation*, 1977, chapter VI (the square-root information filter's time update).
    pub fn diffuse(&mut self, i: usize, variance: S) {
        let mut variance = variance;
        let mut above = [S::zero(); N];
        let mut above_target = S::zero();
        let equations = self.rows.data.0.iter_mut().zip(self.weight.as_mut_slice()).zip(self.target.as_mut_slice());
        for (r, ((row, weight), target)) in equations.enumerate().rev().filter(|(r, _)| *r <= i) {
            let Some(&lead) = row.get(i).filter(|&&lead| lead != S::zero()) else { continue };
            let across = variance * *weight * lead;
            let against = across * lead;
            // Where the product overflows, the step is all that is known of the component.
            let known = Real::is_finite(against);
            let kept = if known { S::one() / (S::one() + against) } else { S::zero() };
            let taken = if known { -(across * kept) } else { -S::one() / lead };
            *weight = if known { *weight * kept } else { S::one() / variance / (lead * lead) };
            for (k, (entry, above)) in row.iter_mut().zip(&mut above).enumerate() {
                if k > r {
                    let (entry_before, above_before) = (*entry, *above);
                    *entry = entry_before + above_before * lead;
                    *above = above_before * kept + entry_before * taken;
                } else if k == r {
                    *above = taken;
                }
            }
            let target_before = *target;
            *target += lead * above_target;
            above_target = above_target * kept + target_before * taken;
            variance *= kept;
        }
    }

    /// Row `i` of `U`; none of its entries are left of `i`.
    fn row(&self, i: usize) -> SVector<S, N> {
        self.rows.column(i).into_owned()
    }

    /// Multiplies every weight by a factor, `factor > 0`; the vector that fits best stays the same.
    pub fn scale(&mut self, factor: S) {
        self.weight *= factor;
    }

    /// Adds the equations of another problem, with their right sides, its weights multiplied by `factor >= 0`.
    pub fn absorb_information(&mut self, other: &Self, factor: S) {
        for i in 0..N {
            self.absorb(&other.row(i), other.target[i], factor * other.weight[i]);
        }
    }

    /// The equations of `s` in `d = offset + slopes s`.
    ///
    /// Where the weights say nothing of a component of `s`, its own weight is 0, and it is 0 in what fits best.
    #[must_use]
    pub fn along<const M: usize>(&self, offset: &SVector<S, N>, slopes: &SMatrix<S, N, M>) -> Information<S, M> {
        let mut along = Information::vague();
        for i in 0..N {
            let row = self.row(i);
            along.rotate::<true>(&slopes.tr_mul(&row), self.target[i] - row.dot(offset), self.weight[i]);
        }
        along
    }

    /// The sum of weighted squares that a vector leaves, less the least one.
    pub fn misfit(&self, d: &SVector<S, N>) -> S {
        let mut misfit = S::zero();
        for i in 0..N {
            let rest = self.row(i).dot(d) - self.target[i];
            misfit += self.weight[i] * rest * rest;
        }
        misfit
    }

    /// The same weights with right sides of 0, which the compiler then knows and need not fetch.
    pub(crate) fn without_target(&self) -> Self {
        Self { target: SVector::zeros(), ..*self }
    }

    /// The vector that fits best, from which the unknown is counted from now on: every right side becomes 0.
    ///
    /// # Errors
    /// [`Fault::State`] as in [`solve`](Self::solve).
    pub fn take_solution(&mut self) -> Result<SVector<S, N>, Fault> {
        let solution = self.solve()?;
        self.target = SVector::zeros();
        Ok(solution)
    }

    /// The vector that fits best.
    ///
    /// # Errors
    /// [`Fault::State`] if an equation had infinite or NaN factors or its weight overflowed. A right side that is not
    /// finite is no fault here: the vector is not finite then either.
    pub fn solve(&self) -> Result<SVector<S, N>, Fault> {
        let mut solution = self.target;
        for i in (0..N).rev() {
            for k in i + 1..N {
                let known = self.rows[(k, i)] * solution[k];
                solution[i] -= known;
            }
        }
        if all_finite(&self.weight) { Ok(solution) } else { Err(Fault::State) }
    }

    /// A root of the inverse of the information matrix: `L = U^-1 D^-1/2`, so that `(U^T D U)^-1 = L L^T`. None where
    /// it is not finite.
    pub fn covariance_root(&self) -> Option<SMatrix<S, N, N>> {
        let mut root = SMatrix::identity();
        for j in 0..N {
            for i in (0..j).rev() {
                let mut entry = self.rows[(j, i)];
                for k in i + 1..j {
                    entry += self.rows[(k, i)] * root[(k, j)];
                }
                root[(i, j)] = -entry;
            }
        }
        for (j, &weight) in self.weight.iter().enumerate() {
            let scale = S::one() / Real::sqrt(weight);
            (0..=j).for_each(|i| root[(i, j)] *= scale);
        }
        Some(root).filter(all_finite)
    }

    /// The diagonal of `D`: the weight of each component given those after it.
    pub fn weight(&self) -> &SVector<S, N> {
        &self.weight
    }

    /// True if every number of the state is finite.
    pub fn is_finite(&self) -> bool {
        all_finite(&self.rows) && all_finite(&self.weight) && all_finite(&self.target)
    }
}

/// True if the matrix is its transpose, up to the rounding of a product computed in either order.
fn is_symmetric<S: Real, const N: usize>(matrix: &SMatrix<S, N, N>) -> bool {
    let largest = matrix.iter().fold(S::zero(), |largest, &element| largest.max(Real::abs(element)));
    let four: S = Real::from_f64(4.0);
    let tolerance = four * S::EPSILON * largest;
    (0..N).all(|i| (0..i).all(|j| Real::abs(matrix[(i, j)] - matrix[(j, i)]) <= tolerance))
}

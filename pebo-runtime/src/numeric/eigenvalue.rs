//! The smallest eigenvalue of a symmetric matrix, without panics and in a bounded number of sweeps.

use nalgebra::SMatrix;

use crate::Real;

/// More sweeps than any matrix of a dozen rows needs in double precision: convergence is quadratic from the third on.
const SWEEPS: usize = 12;

/// The smallest eigenvalue of a symmetric matrix, up to rounding of its largest entry.
///
/// Method: Jacobi's, by rows (Golub and Van Loan, *Matrix computations*, 2013, Section 8.5).
pub(crate) fn smallest_eigenvalue<S: Real, const N: usize>(matrix: &SMatrix<S, N, N>) -> S {
    const { assert!(N > 0, "a matrix without entries has no eigenvalue") };
    let mut a = *matrix;
    for _ in 0..SWEEPS {
        let mut rotated = false;
        for p in 0..N {
            for q in p + 1..N {
                let off = a[(p, q)];
                // An entry that no longer changes either diagonal element is zero.
                let small = S::EPSILON * Real::sqrt(Real::abs(a[(p, p)])) * Real::sqrt(Real::abs(a[(q, q)]));
                if Real::abs(off) <= small {
                    continue;
                }
                rotated = true;
                rotate(&mut a, p, q);
            }
        }
        if !rotated {
            break;
        }
    }
    (1..N).fold(a[(0, 0)], |smallest, i| smallest.min(a[(i, i)]))
}

/// The rotation in the plane of rows `p` and `q` that makes their common entry zero.
fn rotate<S: Real, const N: usize>(a: &mut SMatrix<S, N, N>, p: usize, q: usize) {
    let two: S = Real::from_f64(2.0);
    let cotangent = (a[(q, q)] - a[(p, p)]) / (two * a[(p, q)]);
    let root = Real::abs(cotangent) + Real::sqrt(S::one() + cotangent * cotangent);
    let tangent = if cotangent < S::zero() { -S::one() / root } else { S::one() / root };
    let cosine = S::one() / Real::sqrt(S::one() + tangent * tangent);
    let sine = tangent * cosine;
    for k in 0..N {
        let (left, right) = (a[(k, p)], a[(k, q)]);
        a[(k, p)] = cosine * left - sine * right;
        a[(k, q)] = sine * left + cosine * right;
    }
    for k in 0..N {
        let (upper, lower) = (a[(p, k)], a[(q, k)]);
        a[(p, k)] = cosine * upper - sine * lower;
        a[(q, k)] = sine * upper + cosine * lower;
    }
}

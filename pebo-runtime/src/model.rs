//! The functions of one plant: what emitted code provides and an [`Observer`](crate::Observer) runs.

use nalgebra::{SMatrix, SVector};

use crate::{Extension, Real};

/// The kind of equation that the unknown is estimated from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Regression {
    /// `d/dt [primitive_0 + primitive_1 eta] = phi_0 + phi_1 eta`.
    ///
    /// With `primitive_0 = y` and `primitive_1 = 0` this is `y' = phi_0 + phi_1 eta` (the paper, Section 3,
    /// remark R2); a
    /// `primitive_1` admits an unknown that multiplies a derivative.
    Dynamic,
    /// `phi_0 = phi_1 eta` at every instant (the paper, Section 5.2: `Y = S^T eta`).
    Static,
}

/// A plant `x' = f_x(x, y, u)`, `y' = f_y(x, y, u)` with its transform `z = phi(x, y)`, as an observer needs it.
///
/// Sizes: `NX` recovered states, `NY` outputs, `NU` inputs, `NZ` coordinates, `NR` equations of the regression, `NE`
/// unknowns in them. Units are the plant's own, time is in seconds. A function that leaves its domain returns NaN or
/// infinity; the observer refuses that sample.
pub trait Model<const NX: usize, const NY: usize, const NU: usize, const NZ: usize, const NR: usize, const NE: usize> {
    /// `f32` or `f64`.
    type Scalar: Real;
    /// What is integrated: [`Integrator`](crate::Integrator) (`z = chi + theta`) or
    /// [`Fundamental`](crate::Fundamental) (`z = xi + Psi theta`).
    type Extension: Extension<Self::Scalar, NZ>;
    /// Which equation `phi_0` and `phi_1` are the sides of.
    const REGRESSION: Regression;

    /// `h` of the cascade `z' = Lambda z + h(y, u)`.
    fn h(&self, y: &SVector<Self::Scalar, NY>, u: &SVector<Self::Scalar, NU>) -> SVector<Self::Scalar, NZ>;

    /// `Lambda` of the cascade; zero unless the extension is [`Fundamental`](crate::Fundamental).
    fn lambda(&self, _y: &SVector<Self::Scalar, NY>, _u: &SVector<Self::Scalar, NU>) -> SMatrix<Self::Scalar, NZ, NZ> {
        SMatrix::zeros()
    }

    /// What is known in the regression, see [`Regression`].
    fn phi_0(
        &self,
        extension: &Self::Extension,
        y: &SVector<Self::Scalar, NY>,
        u: &SVector<Self::Scalar, NU>,
    ) -> SVector<Self::Scalar, NR>;

    /// The factor of the unknown `eta`, see [`Regression`].
    fn phi_1(
        &self,
        extension: &Self::Extension,
        y: &SVector<Self::Scalar, NY>,
        u: &SVector<Self::Scalar, NU>,
    ) -> SMatrix<Self::Scalar, NR, NE>;

    /// What is known under the derivative of a dynamic regression: as a rule the outputs whose equations are used.
    /// Not read if the regression is static.
    fn primitive_0(&self, _extension: &Self::Extension, _y: &SVector<Self::Scalar, NY>) -> SVector<Self::Scalar, NR> {
        SVector::zeros()
    }

    /// The factor of the unknown under the derivative of a dynamic regression. Not read if the regression is static.
    fn primitive_1(
        &self,
        _extension: &Self::Extension,
        _y: &SVector<Self::Scalar, NY>,
    ) -> SMatrix<Self::Scalar, NR, NE> {
        SMatrix::zeros()
    }

    /// `theta` from the estimated unknown: `eta` itself in a linear parameterisation, a part of it in an
    /// over-parameterised one.
    fn theta(&self, eta: &SVector<Self::Scalar, NE>) -> SVector<Self::Scalar, NZ>;

    /// The left inverse: `x` such that `z = phi(x, y)`. Of an estimate of `z` beyond the range of `phi` it may have no
    /// value: an observer then refuses the step with [`Fault::Estimate`](crate::Fault::Estimate) and changes nothing.
    fn phi_left(&self, z: &SVector<Self::Scalar, NZ>, y: &SVector<Self::Scalar, NY>) -> SVector<Self::Scalar, NX>;
}

/// A promise: this model can be re-based exactly.
///
/// It holds if `theta(eta) = eta` and the regression knows `z` only as an affine function: for every shift `c`, moving
/// `c` from the extension into `theta` (see [`Extension::rebase`]) leaves `phi_1` and `primitive_1` as they are and
///
/// ```text
/// phi_0       becomes  phi_0       - phi_1 c          (dynamic)      phi_0 becomes phi_0 + phi_1 c   (static)
/// primitive_0 becomes  primitive_0 - primitive_1 c
/// ```
///
/// That is so wherever the regression was found as `f_y = A(y, u) + B(y, u) phi`: then `phi_0 = A + B chi`,
/// `phi_1 = B` (with [`Fundamental`](crate::Fundamental): `A + B xi` and `B Psi`). In both kinds the filtered regressand
/// then moves by the filtered regressor times `c`, since filtering is linear.
pub trait Rebase<const NX: usize, const NY: usize, const NU: usize, const NZ: usize, const NR: usize>:
    Model<NX, NY, NU, NZ, NR, NZ>
{
}

//! The functions of one plant, provided by emitted code and run by an [`Observer`](crate::Observer).

use core::fmt::Debug;

use nalgebra::{SMatrix, SVector};

use crate::{Extension, Flow, Real, Sides};

/// The kind of equation that the unknown is estimated from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Regression {
    /// `d/dt [primitive_0 + primitive_1 eta] = phi_0 + phi_1 eta`.
    ///
    /// With `primitive_0 = y` and `primitive_1 = 0` this is `y' = phi_0 + phi_1 eta` (the paper, Section 3, remark R2);
    /// a `primitive_1` admits an unknown that multiplies a derivative.
    Dynamic,
    /// `phi_0 = phi_1 eta` at every instant (the paper, Section 5.2: `Y = S^T eta`).
    Static,
}

/// A plant `x' = f_x(x, y, u)`, `y' = f_y(x, y, u)` with its transform `z = phi(x, y)`, as an observer needs it.
///
/// Sizes: `NX` recovered states, `NY` outputs, `NU` inputs, `NZ` coordinates, `NR` equations of the regression, `NE`
/// unknowns in them. Units are the plant's own, time is in seconds. A function that leaves its domain returns NaN or
/// infinity; the observer refuses that sample.
///
/// Samples and estimates may have names: where [`Y`](Self::Y), [`U`](Self::U) and [`X`](Self::X) are structures, two
/// signals in the wrong order do not compile. The functions below compute with vectors.
///
/// An observer calls the functions in groups that share their work:
///
/// | call | values | when |
/// |---|---|---|
/// | [`terms`](Self::terms) | the terms of the output that the others need | once for each sample |
/// | [`flow`](Self::flow) | `h`, `lambda` | at both ends of an interval |
/// | [`regression`](Self::regression) | `phi_0`, `phi_1` | at both ends |
/// | [`primitive`](Self::primitive) | `primitive_0`, `primitive_1` | at both ends, unless the regression is static |
/// | [`output_slopes`](Self::output_slopes) | slopes of the rates by outputs | at both ends, in the output form |
/// | [`theta`](Self::theta) | `theta` from the estimate of `eta` | once for each sample |
/// | [`functions`](Self::functions) | `eta` as a function of `theta`, if it has more components | up to seven times |
/// | [`recover`](Self::recover) | `phi_left` | once for each sample |
/// | [`transform`](Self::transform) | `phi`, if its components depend on one another | up to seven times |
///
/// [`h`](Self::h), [`phi_0`](Self::phi_0), [`phi_1`](Self::phi_1), [`phi_left`](Self::phi_left) and the others give one
/// of these values from the output itself.
pub trait Model<const NX: usize, const NY: usize, const NU: usize, const NZ: usize, const NR: usize, const NE: usize> {
    /// `f32` or `f64`.
    type Scalar: Real;
    /// The dynamic extension: [`Integrator`](crate::Integrator) (`z = chi + theta`) or
    /// [`Fundamental`](crate::Fundamental) (`z = xi + Psi theta`).
    type Extension: Extension<Self::Scalar, NZ>;
    /// The recovered states as an estimate gives them: `SVector<Self::Scalar, NX>`, or a structure that names them.
    type X: From<SVector<Self::Scalar, NX>> + Into<SVector<Self::Scalar, NX>>;
    /// The outputs as a sample gives them, likewise.
    type Y: From<SVector<Self::Scalar, NY>> + Into<SVector<Self::Scalar, NY>>;
    /// The inputs as a sample gives them, likewise.
    type U: From<SVector<Self::Scalar, NU>> + Into<SVector<Self::Scalar, NU>>;
    /// The terms of an output that the functions share: `SVector<Self::Scalar, NY>`, or more, computed from it once.
    type Terms: Copy + Debug;
    /// The equation that has `phi_0` and `phi_1` for its sides.
    const REGRESSION: Regression;
    /// The number of rows of a dynamic regression that hold at every instant, `0 = phi_0 + phi_1 eta`: its last ones,
    /// whose primitives are zero. An output that is given by its value has such a row beside the rates of others.
    const INSTANTS: usize = 0;

    /// The number of rows, the first ones, that say something of an interval and nothing of an instant: none of a static
    /// regression, all of a dynamic one. The others count at the first sample too.
    fn rates(&self) -> usize {
        if matches!(Self::REGRESSION, Regression::Static) { 0 } else { NR }
    }

    /// The periods of the outputs that are angles, 0 for the others: the observer counts the turns of their sensors,
    /// see [`unwrapped`](crate::unwrapped). By default none is an angle.
    fn periods(&self) -> SVector<Self::Scalar, NY> {
        SVector::zeros()
    }

    /// The terms of the output `y` that the functions share.
    fn terms(&self, y: &SVector<Self::Scalar, NY>) -> Self::Terms;

    /// `h` and `Lambda` of the cascade `z' = Lambda z + h(y, u)`; `Lambda` is zero unless the extension is
    /// [`Fundamental`](crate::Fundamental).
    fn flow(&self, terms: &Self::Terms, u: &SVector<Self::Scalar, NU>) -> Flow<Self::Scalar, NZ>;

    /// Both sides of the regression, see [`Regression`]: `phi_0`, which is known, and `phi_1`, the factor of the
    /// unknown `eta`.
    fn regression(
        &self,
        extension: &Self::Extension,
        terms: &Self::Terms,
        u: &SVector<Self::Scalar, NU>,
    ) -> Sides<Self::Scalar, NR, NE>;

    /// True if the regression is one to first order in `theta`: `phi_0` is the equation where the extension is `z`, and
    /// `phi_1` its slope by `theta` there. The observer must then be [re-based](crate::Observer::rebasing) at every
    /// sample. With least squares it is recursive Gauss-Newton (Ljung, *System identification*, 1999, Section 11.4), and
    /// converges from a neighbourhood; with a gradient it converges from farther where the equations are monotone.
    const LOCAL: bool = false;

    /// [`LOCAL`](Self::LOCAL), for a model of which only the run knows it.
    fn is_local(&self) -> bool {
        Self::LOCAL
    }

    /// Both sides under the derivative of a dynamic regression: `primitive_0`, as a rule the outputs whose equations
    /// are used, and `primitive_1`, the factor of the unknown. Not read if the regression is static.
    fn primitive(&self, _extension: &Self::Extension, _terms: &Self::Terms) -> Sides<Self::Scalar, NR, NE> {
        Sides { known: SVector::zeros(), factor: SMatrix::zeros() }
    }

    /// True if [`flow_near`](Self::flow_near) depends on the estimate.
    const LINEARISED: bool = false;

    /// The flow, for a model that linearises it in the noise of its outputs: at an estimate of `z`, which changes
    /// nothing where the outputs are those of `z`. By default it is that of [`flow`](Self::flow).
    fn flow_near(
        &self,
        terms: &Self::Terms,
        u: &SVector<Self::Scalar, NU>,
        _z: &SVector<Self::Scalar, NZ>,
    ) -> Flow<Self::Scalar, NZ> {
        self.flow(terms, u)
    }

    /// The coordinates expected after `dt` seconds, at which a [`LINEARISED`](Self::LINEARISED) model is asked for its flow
    /// at the end of an interval; from the flow at the start. By default those at the start.
    fn ahead(
        &self,
        _start: &Flow<Self::Scalar, NZ>,
        z: &SVector<Self::Scalar, NZ>,
        _dt: Self::Scalar,
    ) -> SVector<Self::Scalar, NZ> {
        *z
    }

    /// The slopes of the rates by the outputs whose rates the regression has, at an estimate of `z`, for the [output
    /// form](crate::OutputForm), which has these outputs among its states. By default there are none: measured outputs
    /// alone drive the model.
    fn output_slopes(
        &self,
        _terms: &Self::Terms,
        _u: &SVector<Self::Scalar, NU>,
        _z: &SVector<Self::Scalar, NZ>,
    ) -> OutputSlopes<Self::Scalar, NR, NZ> {
        OutputSlopes { rates: SMatrix::zeros(), cascade: SMatrix::zeros() }
    }

    /// `theta` from the estimated unknown: `eta` itself in a linear parameterisation, a part of it in an
    /// over-parameterised one.
    fn theta(&self, eta: &SVector<Self::Scalar, NE>) -> SVector<Self::Scalar, NZ>;

    /// The unknown `eta` as a function of `theta`, where it has more components: the estimate that goes out is then
    /// the nearest of the values of this function, see [`Observer`](crate::Observer). None where `eta` is `theta`.
    fn functions(&self, _theta: &SVector<Self::Scalar, NZ>) -> Option<Functions<Self::Scalar, NE, NZ>> {
        None
    }

    /// True if [`transform`](Self::transform) is there.
    const RELATED: bool = false;

    /// The transform `phi` of the recovered states at this sample, where its components depend on one another whatever
    /// the outputs and parameters are, as `x1`, `x2` and `x1 x2`: the estimate that goes out is then the state whose
    /// transform is nearest, see [`Observer`](crate::Observer). Nothing else asks for it.
    fn transform(
        &self,
        _x: &SVector<Self::Scalar, NX>,
        _terms: &Self::Terms,
    ) -> Option<Functions<Self::Scalar, NZ, NX>> {
        None
    }

    /// Parameters of the range of the transform near these coordinates: the recovered states, then zeros.
    fn parameters(&self, z: &SVector<Self::Scalar, NZ>, terms: &Self::Terms) -> SVector<Self::Scalar, NZ> {
        let states = self.recover_unbounded(z, terms);
        SVector::from_fn(|i, _| states.get(i).copied().unwrap_or_else(nalgebra::zero))
    }

    /// The coordinates at such parameters.
    fn range(
        &self,
        parameters: &SVector<Self::Scalar, NZ>,
        terms: &Self::Terms,
    ) -> Option<Functions<Self::Scalar, NZ, NZ>> {
        let of_states = self.transform(&SVector::from_fn(|i, _| parameters[i]), terms)?;
        let mut slopes = SMatrix::<Self::Scalar, NZ, NZ>::zeros();
        of_states.slopes.column_iter().enumerate().for_each(|(j, column)| slopes.set_column(j, &column));
        Some(Functions { values: of_states.values, slopes })
    }

    /// The left inverse `phi_left`: `x` such that `z = phi(x, y)`. It may have no value at an estimate of `z` beyond
    /// the range of `phi`: an observer then refuses the step with [`Fault::Estimate`](crate::Fault::Estimate) and
    /// changes nothing.
    fn recover(&self, z: &SVector<Self::Scalar, NZ>, terms: &Self::Terms) -> SVector<Self::Scalar, NX>;

    /// The left inverse without the bounds of [`Within`](crate::Within) on its states. Standard errors use it, as an
    /// estimate that is moved to a bound is no better known there.
    fn recover_unbounded(&self, z: &SVector<Self::Scalar, NZ>, terms: &Self::Terms) -> SVector<Self::Scalar, NX> {
        self.recover(z, terms)
    }

    /// The extension at the first sample, made of the one that the observer starts with: a model whose coordinates are
    /// measured adds the sample. By default the extension does not change.
    fn begin(&self, extension: &Self::Extension, _terms: &Self::Terms) -> Self::Extension {
        *extension
    }

    /// `h` of the cascade `z' = Lambda z + h(y, u)`.
    fn h(&self, y: &SVector<Self::Scalar, NY>, u: &SVector<Self::Scalar, NU>) -> SVector<Self::Scalar, NZ> {
        self.flow(&self.terms(y), u).h
    }

    /// `Lambda` of the cascade.
    fn lambda(&self, y: &SVector<Self::Scalar, NY>, u: &SVector<Self::Scalar, NU>) -> SMatrix<Self::Scalar, NZ, NZ> {
        self.flow(&self.terms(y), u).lambda
    }

    /// The known side of the regression.
    fn phi_0(
        &self,
        extension: &Self::Extension,
        y: &SVector<Self::Scalar, NY>,
        u: &SVector<Self::Scalar, NU>,
    ) -> SVector<Self::Scalar, NR> {
        self.regression(extension, &self.terms(y), u).known
    }

    /// The factor of the unknown in the regression.
    fn phi_1(
        &self,
        extension: &Self::Extension,
        y: &SVector<Self::Scalar, NY>,
        u: &SVector<Self::Scalar, NU>,
    ) -> SMatrix<Self::Scalar, NR, NE> {
        self.regression(extension, &self.terms(y), u).factor
    }

    /// The known side under the derivative of the regression.
    fn primitive_0(&self, extension: &Self::Extension, y: &SVector<Self::Scalar, NY>) -> SVector<Self::Scalar, NR> {
        self.primitive(extension, &self.terms(y)).known
    }

    /// The factor of the unknown under the derivative of the regression.
    fn primitive_1(&self, extension: &Self::Extension, y: &SVector<Self::Scalar, NY>) -> SMatrix<Self::Scalar, NR, NE> {
        self.primitive(extension, &self.terms(y)).factor
    }

    /// The left inverse, from the output itself.
    fn phi_left(&self, z: &SVector<Self::Scalar, NZ>, y: &SVector<Self::Scalar, NY>) -> SVector<Self::Scalar, NX> {
        self.recover(z, &self.terms(y))
    }
}

/// A function at one value of its argument, with its derivatives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Functions<S: Real, const NE: usize, const NZ: usize> {
    /// Its components.
    pub values: SVector<S, NE>,
    /// Their derivatives: a row for each, a column for each component of the argument.
    pub slopes: SMatrix<S, NE, NZ>,
}

/// The slopes of the rates by `primitive_0`, the outputs whose rates the regression has: an entry may be any function of
/// the sample. One that is the derivative of its rate keeps the sensor's noise out of that rate, to first order.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OutputSlopes<S: Real, const NR: usize, const NZ: usize> {
    /// Those of the regression's rows, in 1/s times the ratio of the outputs' units; those of a row that holds at every
    /// instant, in that ratio, are the same at all z.
    pub rates: SMatrix<S, NR, NR>,
    /// Those of the cascade's, a column for each output.
    pub cascade: SMatrix<S, NZ, NR>,
}

/// Marks a model that can be re-based exactly, or that [is local](Model::is_local), so that it has to be.
///
/// The first holds if `theta(eta) = eta` and the regression knows `z` only as an affine function: for every shift `c`, moving
/// `c` from the extension into `theta` (see [`Extension::rebase`]) leaves `phi_1` and `primitive_1` as they are and
///
/// ```text
/// phi_0       becomes  phi_0       - phi_1 c          (dynamic)      phi_0 becomes phi_0 + phi_1 c   (static)
/// primitive_0 becomes  primitive_0 - primitive_1 c
/// ```
///
/// That is so wherever the regression was found as `f_y = A(y, u) + B(y, u) phi`: then `phi_0 = A + B chi`,
/// `phi_1 = B` (with [`Fundamental`](crate::Fundamental): `A + B xi` and `B Psi`). In both kinds the filtered
/// regressand then moves by the filtered regressor times `c`, since filtering is linear.
pub trait Rebase<const NX: usize, const NY: usize, const NU: usize, const NZ: usize, const NR: usize>:
    Model<NX, NY, NU, NZ, NR, NZ>
{
}

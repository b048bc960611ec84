//! Runtime of parameter-estimation-based observers (PEBO), the library of emitted code.
//!
//! For a plant `x' = f_x(x, y, u)`, `y' = f_y(x, y, u)` with unmeasured `x`, and a transform `z = phi(x, y)` that
//! turns it into a cascade, the observer is
//!
//! ```text
//! (y, u) -> dynamic extension -> regression -> filter -> estimator -> left inverse -> estimate of x
//!            chi' = h(y, u)      phi_0, phi_1   alpha     theta_hat    phi_left(chi + theta_hat, y)
//! ```
//!
//! - [`Model`]: the functions of one plant, written by hand or emitted by the generator;
//! - [`Extension`]: [`Integrator`] (PEBO) or [`Fundamental`] (generalised PEBO);
//! - [`Filter`]: `alpha / (p + alpha)`, advanced exactly over a step; or [`WindowedRegression`], the integral form;
//! - [`Estimator`]: [`Gradient`], [`LeastSquares`], DREM and others of [`estimator`], or one of your own;
//! - [`Monitor`]: whether the data so far determine the unknown, and how well;
//! - [`Observer::standard_error`], [`Observer::innovation`] and [`Gate`]: how far an estimate and a sample can be
//!   trusted;
//! - [`OutputForm`] and [`SampledRegression`]: the outputs themselves as the regressand, nothing differentiated;
//! - [`Limits`], [`Gap`], [`Drift`], [`State`]: ranges of samples, intervals without one, forms without drift, saving;
//! - [`Within`]: bounds of the state;
//! - [`Observer`]: one [`step`](Observer::step) a sample, which never panics and answers a bad sample with a [`Fault`].
//!
//! No heap, no `std`, no `unsafe`; `f32` and `f64`; every size is a constant.
//!
//! Features: `serde` writes and reads states and faults, `defmt` prints faults over a debug probe.
//!
//! Vectors and matrices are those of [`nalgebra`], which is part of this interface and exported again: write
//! `pebo_runtime::nalgebra`, and the versions agree. A release with another major or zero-major version of it is a
//! breaking release of this crate. Nothing else of it is in the interface: not its solvers, which may panic or
//! allocate.
//!
//! Source of the method: Ortega, Bobtsov, Pyrkin, Aranovskiy, *A parameter estimation approach to state observation of
//! nonlinear systems*, Systems & Control Letters, 2015, named "the paper" throughout.
//!
//! # Example
//!
//! A mass whose position `y` is measured and whose speed `x` is not: `x' = u`, `y' = x`. With `phi = x` the extension
//! is `chi' = u` and the regression `y' = chi + theta`.
//!
//! ```
//! use pebo_runtime::nalgebra::{SMatrix, SVector};
//! use pebo_runtime::{Filter, Flow, Gradient, Hold, Integrator, Model, Observer, Regression, Sides};
//!
//! type Scalar = SVector<f64, 1>;
//! struct Mass;
//!
//! impl Model<1, 1, 1, 1, 1, 1> for Mass {
//!     type Scalar = f64;
//!     type Extension = Integrator<f64, 1>;
//!     // Emitted code has structures here, with a name for each signal.
//!     type X = Scalar;
//!     type Y = Scalar;
//!     type U = Scalar;
//!     type Terms = Scalar;
//!     const REGRESSION: Regression = Regression::Dynamic;
//!
//!     fn terms(&self, y: &Scalar) -> Scalar {
//!         *y
//!     }
//!     fn flow(&self, _y: &Scalar, u: &Scalar) -> Flow<f64, 1> {
//!         Flow::plain(*u)
//!     }
//!     fn regression(&self, extension: &Self::Extension, _y: &Scalar, _u: &Scalar) -> Sides<f64, 1, 1> {
//!         Sides { known: *extension.chi(), factor: SMatrix::identity() }
//!     }
//!     fn primitive(&self, _: &Self::Extension, y: &Scalar) -> Sides<f64, 1, 1> {
//!         Sides { known: *y, factor: SMatrix::zeros() }
//!     }
//!     fn theta(&self, eta: &Scalar) -> Scalar {
//!         *eta
//!     }
//!     fn recover(&self, z: &Scalar, _y: &Scalar) -> Scalar {
//!         *z
//!     }
//! }
//!
//! # fn main() -> Result<(), pebo_runtime::Fault> {
//! let gradient = Gradient::diagonal(&Scalar::new(50.0))?;
//! let filter = Filter::new(5.0, Hold::First)?;
//! let mut observer = Observer::new(Mass, gradient, filter, Scalar::zeros())?;
//!
//! // The mass moves at 2 m/s and nothing pushes it.
//! let dt = 0.01;
//! let mut estimate = Scalar::zeros();
//! for k in 0..200 {
//!     let position = Scalar::new(2.0 * dt * f64::from(k));
//!     estimate = observer.step(position, Scalar::zeros(), dt)?;
//! }
//! assert!((estimate[0] - 2.0).abs() < 1e-6);
//! # Ok(())
//! # }
//! ```
#![no_std]
#![forbid(unsafe_code)]

pub use nalgebra;

#[cfg(feature = "serde")]
mod array;
pub mod estimator;
mod extension;
mod fault;
mod interface;
mod model;
mod monitor;
mod numeric;
mod observer;
mod output_form;
mod regression;
mod samples;
mod within;

pub use estimator::{
    AdaptiveLeastSquares, Bounded, Drem, Estimator, FiniteTime, Gradient, Information, Kreisselmeier, LeastSquares,
    NormalisedGradient, RegressorExtension, Response, Uncertain,
};
pub use extension::{Drift, Extension, Flow, Fundamental, Integrator, Turn};
pub use fault::Fault;
pub use interface::{INTERFACE, emitted_for};
pub use model::{Functions, Model, OutputSlopes, Rebase, Regression};
pub use monitor::{Excitation, Monitor};
pub use numeric::{Real, Sum, Table};
pub use observer::{Innovation, Late, LateObserver, Observer, State};
pub use output_form::{Measured, OutputForm};
pub use regression::{
    Filter, Filtered, FilteredRegression, Hold, Moved, Outcome, RegressionOperator, Rows, SampledRegression, Sides,
    Weights, WindowedRegression,
};
pub use samples::{Arrivals, Gap, Gate, Instant, Limits, unwrapped};
pub use within::Within;

/// The package's front page, whose example is a test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
mod front_page {}

//! Runtime of parameter-estimation-based observers (PEBO): what emitted code links against.
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
//! - [`Limits`], [`Gap`], [`Drift`], [`State`]: what samples may be, intervals without one, forms without drift, saving;
//! - [`Observer`]: one [`step`](Observer::step) a sample, which never panics and answers a bad sample with a [`Fault`].
//!
//! No heap, no `std`, no `unsafe`; `f32` and `f64`; every size is a constant.
//!
//! Source of the method: Ortega, Bobtsov, Pyrkin, Aranovskiy, *A parameter estimation approach to state observation of
//! nonlinear systems*, Systems & Control Letters, 2015, named "the paper" throughout.
//!
//! # Example
//!
//! A mass whose position `y` is measured and whose speed `x` is not: `x' = u`, `y' = x`. With `phi = x` the extension is
//! `chi' = u` and the regression `y' = chi + theta`.
//!
//! ```
//! use pebo_runtime::nalgebra::{SMatrix, SVector};
//! use pebo_runtime::{Filter, Gradient, Hold, Integrator, Model, Observer, Regression};
//!
//! type Scalar = SVector<f64, 1>;
//! struct Mass;
//!
//! impl Model<1, 1, 1, 1, 1, 1> for Mass {
//!     type Scalar = f64;
//!     type Extension = Integrator<f64, 1>;
//!     const REGRESSION: Regression = Regression::Dynamic;
//!
//!     fn h(&self, _y: &Scalar, u: &Scalar) -> Scalar {
//!         *u
//!     }
//!     fn phi_0(&self, extension: &Self::Extension, _y: &Scalar, _u: &Scalar) -> Scalar {
//!         *extension.chi()
//!     }
//!     fn phi_1(&self, _: &Self::Extension, _y: &Scalar, _u: &Scalar) -> SMatrix<f64, 1, 1> {
//!         SMatrix::identity()
//!     }
//!     fn primitive_0(&self, _: &Self::Extension, y: &Scalar) -> Scalar {
//!         *y
//!     }
//!     fn theta(&self, eta: &Scalar) -> Scalar {
//!         *eta
//!     }
//!     fn phi_left(&self, z: &Scalar, _y: &Scalar) -> Scalar {
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
//!     estimate = observer.step(&position, &Scalar::zeros(), dt)?;
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
mod decay;
mod drift;
mod eigenvalue;
pub mod estimator;
mod extension;
mod fault;
mod filter;
mod gap;
mod limits;
mod linear;
mod model;
mod monitor;
mod observer;
mod real;
mod regression;
mod single;
mod sum;
mod window;

pub use drift::Drift;
pub use estimator::{
    Bounded, Drem, Estimator, FiniteTime, Gradient, Information, Kreisselmeier, LeastSquares, NormalisedGradient,
    RegressorExtension, Response,
};
pub use extension::{Extension, Flow, Fundamental, Integrator};
pub use fault::Fault;
pub use filter::{Filter, Filtered, Hold, Weights};
pub use gap::Gap;
pub use limits::Limits;
pub use model::{Model, Rebase, Regression};
pub use monitor::{Excitation, Monitor};
pub use observer::{Observer, State};
pub use real::Real;
pub use regression::{FilteredRegression, RegressionOperator, Sides};
pub use sum::Sum;
pub use window::WindowedRegression;

//! Every model of the project as emitted code, ready to be called. Does without `std`, as firmware does.
#![no_std]

use pebo_runtime::nalgebra::{SMatrix, SVector};
use pebo_runtime::{Extension as _, Fundamental, Integrator, Model, Real};

/// A point at which to evaluate the functions of a model: values of each argument, as many as it takes.
#[derive(Clone, Copy)]
pub struct Point<'a> {
    /// The extension at its start.
    pub chi: &'a [f64],
    /// The outputs.
    pub y: &'a [f64],
    /// The inputs.
    pub u: &'a [f64],
    /// The unknowns of the regression.
    pub eta: &'a [f64],
    /// The coordinates of the transform.
    pub z: &'a [f64],
    /// The sink of results: `h`, `lambda`, `phi_0`, `phi_1` by rows, `theta`, `phi_left`; behind `own` those of the
    /// model's own functions.
    pub results: &'a dyn Fn(&str, usize, f64),
}

/// Calls every function of one emitted model.
pub type Evaluate = fn(Point<'_>);

/// Calls every function of a model at a point.
pub fn evaluate<
    M,
    const NX: usize,
    const NY: usize,
    const NU: usize,
    const NZ: usize,
    const NR: usize,
    const NE: usize,
>(
    model: &M,
    point: Point<'_>,
) where
    M: Model<NX, NY, NU, NZ, NR, NE>,
{
    let (y, u) = (vector::<M::Scalar, NY>(point.y), vector::<M::Scalar, NU>(point.u));
    let extension = extension(model, point);
    let report = |name: &str, values: &[M::Scalar]| report(point, name, values);
    report("h", model.h(&y, &u).as_slice());
    report("lambda", model.lambda(&y, &u).transpose().as_slice());
    report("phi_0", model.phi_0(&extension, &y, &u).as_slice());
    report("phi_1", rows(&model.phi_1(&extension, &y, &u)).as_slice());
    report("primitive_0", model.primitive_0(&extension, &y).as_slice());
    report("primitive_1", rows(&model.primitive_1(&extension, &y)).as_slice());
    report("theta", model.theta(&vector(point.eta)).as_slice());
    report("phi_left", model.phi_left(&vector(point.z), &y).as_slice());
}

fn rows<S: Real, const R: usize, const C: usize>(matrix: &SMatrix<S, R, C>) -> SMatrix<S, C, R> {
    matrix.transpose()
}

/// The extension of a model at its start.
fn extension<M, const NX: usize, const NY: usize, const NU: usize, const NZ: usize, const NR: usize, const NE: usize>(
    _model: &M,
    point: Point<'_>,
) -> M::Extension
where
    M: Model<NX, NY, NU, NZ, NR, NE>,
{
    M::Extension::new(vector(point.chi))
}

/// Hands over the result of a function.
fn report<S: Real>(point: Point<'_>, name: &str, values: &[S]) {
    for (index, value) in values.iter().enumerate() {
        (point.results)(name, index, value.to_f64());
    }
}

fn vector<S: Real, const N: usize>(values: &[f64]) -> SVector<S, N> {
    SVector::from(array::<S, N>(values))
}

fn array<S: Real, const N: usize>(values: &[f64]) -> [S; N] {
    core::array::from_fn(|index| Real::from_f64(values.get(index).copied().unwrap_or(f64::NAN)))
}

/// An extension as the model's own functions take it.
trait Given {
    type Argument<'a>
    where
        Self: 'a;

    fn given(&self) -> Self::Argument<'_>;
}

impl<S: Real, const NZ: usize> Given for Integrator<S, NZ> {
    type Argument<'a> = [S; NZ];

    fn given(&self) -> [S; NZ] {
        (*self.chi()).into()
    }
}

impl<S: Real, const NZ: usize> Given for Fundamental<S, NZ> {
    type Argument<'a> = &'a Self;

    fn given(&self) -> &Self {
        self
    }
}

/// Calls every function of a model at a point, and those that the paper names as its own.
macro_rules! evaluated {
    ($module:ident :: $model:ident) => {
        |point| {
            let model = $module::$model::new(&crate::defaults());
            crate::evaluate(&model, point);
            let extension = crate::extension(&model, point);
            let y = $module::Y::from(crate::vector(point.y));
            let u = $module::U::from(crate::vector(point.u));
            crate::report(point, "own h", &model.h(y, u));
            crate::report(point, "own phi_0", &model.phi_0(extension.given(), y, u));
            crate::report(point, "own phi_1", model.phi_1(extension.given(), y, u).as_flattened());
            let x = crate::SVector::from(model.phi_left(crate::array(point.z), y));
            crate::report(point, "own phi_left", x.as_slice());
        }
    };
}

/// The emitted modules, and a table of them: model, scalar, evaluation.
pub mod emitted {
    use crate::Given as _;

    include!(concat!(env!("OUT_DIR"), "/emitted.rs"));
}

/// The values of a model's parameters, if it has any.
pub(crate) fn defaults<P: Default>() -> P {
    P::default()
}

//! A derived model that is interpreted, padded with zeros to a size of the runtime's.

use std::cell::RefCell;
use std::fmt;
use std::marker::PhantomData;
use std::rc::Rc;

use pebo_runtime::nalgebra::{SMatrix, SVector};
use pebo_runtime::{
    Extension, Flow, Functions, Fundamental, Integrator, Model, OutputForm, OutputSlopes, Regression, Sides,
};

use pebo_design::program::{Interpreter, Program};

use super::design::Design;
use super::setup::{Operator, Settings};
use super::sizes::pad;

/// The kind of a regression, as a type.
pub(super) trait RegressionType: Clone + fmt::Debug + 'static {
    const REGRESSION: Regression;
}

/// A regression of rates.
#[derive(Clone, Copy, Debug)]
pub(super) struct Dynamic;

/// A regression of samples.
#[derive(Clone, Copy, Debug)]
pub(super) struct Static;

impl RegressionType for Dynamic {
    const REGRESSION: Regression = Regression::Dynamic;
}

impl RegressionType for Static {
    const REGRESSION: Regression = Regression::Static;
}

/// An extension whose numbers the regression can read.
pub(super) trait ReadableExtension<const N: usize>: Extension<f64, N> + 'static {
    /// A number of an extension of `n` coordinates: one of these, or after them of its fundamental matrix by rows.
    fn value(&self, n: usize, place: usize) -> f64;

    /// The offset of z, and the factor of theta.
    fn parts(&self) -> (SVector<f64, N>, SMatrix<f64, N, N>);

    /// The extension with a matrix before theta; of one without a fundamental matrix, which no output form has, itself.
    fn mapped(&self, map: &SMatrix<f64, N, N>) -> Self;
}

impl<const N: usize> ReadableExtension<N> for Integrator<f64, N> {
    fn value(&self, _: usize, place: usize) -> f64 {
        self.chi()[place]
    }

    fn parts(&self) -> (SVector<f64, N>, SMatrix<f64, N, N>) {
        (*self.chi(), SMatrix::identity())
    }

    fn mapped(&self, _: &SMatrix<f64, N, N>) -> Self {
        *self
    }
}

impl<const N: usize> ReadableExtension<N> for Fundamental<f64, N> {
    fn value(&self, n: usize, place: usize) -> f64 {
        if place < n { self.xi()[place] } else { self.psi()[((place - n) / n, (place - n) % n)] }
    }

    fn parts(&self) -> (SVector<f64, N>, SMatrix<f64, N, N>) {
        (*self.xi(), *self.psi())
    }

    fn mapped(&self, map: &SMatrix<f64, N, N>) -> Self {
        Fundamental::mapped(self, map)
    }
}

/// The model of a design. The trait's methods take `&self`, but an interpreter needs its table mutable: hence the
/// cells, which copies of the model share.
#[derive(Clone, Debug)]
pub(super) struct Derived<X, K, const N: usize> {
    ny: usize,
    inputs: usize,
    /// True if after the inputs of the interval those of the instant at its end follow.
    with_instant: bool,
    nz: usize,
    nr: usize,
    ne: usize,
    /// The numbers of the extension that the functions read.
    known: usize,
    rows: Vec<usize>,
    periods: SVector<f64, N>,
    cascade: Rc<RefCell<Interpreter>>,
    regression: Rc<RefCell<Interpreter>>,
    primitive: Option<Rc<RefCell<Interpreter>>>,
    slopes: Option<Rc<RefCell<Interpreter>>>,
    theta: Rc<RefCell<Interpreter>>,
    functions: Option<Rc<RefCell<Interpreter>>>,
    /// The number of recovered states, and the transform as a function of them.
    transform: Option<(usize, Rc<RefCell<Interpreter>>)>,
    phi_left: Rc<RefCell<Interpreter>>,
    /// In the output form: the rows of the regression with a rate, and the model's own extension, which its functions read at its
    /// start. That of the output form is another.
    output: Option<(usize, X)>,
    /// True for a regression of first order, at the extension.
    is_local: bool,
    /// In the output form: the indices of the outputs at whose expected values the model is evaluated, with the distance
    /// from the sample up to which they drive the rates.
    expected: Option<Vec<(usize, f64)>>,
    kind: PhantomData<(X, K)>,
}

impl<X: ReadableExtension<N>, K: RegressionType, const N: usize> Derived<X, K, N> {
    pub(super) fn new(design: &Design) -> Self {
        let nz = design.coordinates;
        Self {
            expected: expected(&design.settings),
            output: design.settings.output.then(|| (design.rates(), X::new(SVector::zeros()))),
            is_local: design.is_local,
            known: if design.is_generalised { nz + nz * nz } else { nz },
            ny: design.outputs,
            inputs: design.inputs,
            with_instant: design.with_instant,
            nz: design.coordinates,
            nr: design.equations,
            ne: design.unknowns,
            rows: design.rows.clone(),
            periods: pad(&design.periods),
            cascade: interpreter(&design.cascade),
            regression: interpreter(&design.regression),
            primitive: design.primitive.as_ref().map(interpreter),
            slopes: design.slopes.as_ref().map(interpreter),
            theta: interpreter(&design.theta),
            functions: design.functions.as_ref().map(interpreter),
            transform: design.transform.as_ref().map(|program| (design.recovered.len(), interpreter(program))),
            phi_left: interpreter(&design.phi_left),
            kind: PhantomData,
        }
    }

    /// The cascade of the model itself.
    fn cascade(&self, y: &SVector<f64, N>, u: &SVector<f64, N>) -> Flow<f64, N> {
        let mut cascade = self.cascade.borrow_mut();
        let mut values = cascade.evaluate(|place| if place < self.ny { y[place] } else { u[place - self.ny] });
        let h = column(&mut values, self.nz);
        Flow { lambda: rows(&mut values, self.nz), h }
    }

    /// The flow, linearised at these outputs and at this estimate.
    fn flow_at(&self, y: &SVector<f64, N>, u: &SVector<f64, N>, z: &SVector<f64, N>) -> Flow<f64, N> {
        let inner = self.cascade(y, u);
        let Some((rows, _)) = self.output else { return inner };
        // As the runtime's `OutputForm`, whose sizes are constants.
        let inner_z = self.inner(z, rows);
        let (rate, held) = (self.affine(&inner_z, y, u), self.primitive(&X::new(SVector::zeros()), y));
        let slopes = self.output_slopes(y, u, &inner_z);
        let [known, rest] = [(rate.known, slopes.rates), (inner.h, slopes.cascade)].map(|(h, s)| h - s * held.known);
        let [factor, plain] =
            [(rate.factor, slopes.rates), (inner.lambda, slopes.cascade)].map(|(factor, s)| factor - s * held.factor);
        let (mut lambda, mut h) = (SMatrix::zeros(), SVector::zeros());
        for i in 0..rows + self.nz {
            h[i] = if i < rows { known[i] } else { rest[i - rows] };
            for j in 0..rows {
                lambda[(i, j)] = if i < rows { slopes.rates[(i, j)] } else { slopes.cascade[(i - rows, j)] };
            }
            for j in 0..self.nz {
                lambda[(i, rows + j)] = if i < rows { factor[(i, j)] } else { plain[(i - rows, j)] };
            }
        }
        Flow { lambda, h }
    }

    /// The number of outputs among the coordinates, in the output form.
    fn leading_outputs(&self) -> usize {
        self.output.as_ref().map_or(0, |(rates, _)| *rates)
    }

    /// The outputs of a sample, in the output form as an estimate has them.
    fn expected_at(&self, z: &SVector<f64, N>, y: &SVector<f64, N>) -> SVector<f64, N> {
        let mut y = *y;
        for (row, (place, _)) in self.expected.iter().flatten().take(self.leading_outputs()).enumerate() {
            y[*place] = z[row];
        }
        y
    }

    /// The model's own coordinates, after those of outputs.
    fn inner(&self, z: &SVector<f64, N>, outputs: usize) -> SVector<f64, N> {
        SVector::from_fn(|i, _| if i < self.nz { z[outputs + i] } else { 0.0 })
    }

    /// The sides of the model's own regression.
    fn sides(&self, extension: &X, y: &SVector<f64, N>, u: &SVector<f64, N>) -> Sides<f64, N, N> {
        self.both(&mut self.regression.borrow_mut(), extension, y, u)
    }

    /// In the output form: the same as affine functions of z, those of a local one at this estimate.
    fn affine(&self, z: &SVector<f64, N>, y: &SVector<f64, N>, u: &SVector<f64, N>) -> Sides<f64, N, N> {
        if !self.is_local {
            return self.sides(&X::new(SVector::zeros()), y, u);
        }
        let Sides { known, factor } = self.sides(&X::new(*z), y, u);
        Sides { known: known - factor * z, factor }
    }

    /// Both sides of equations by a program: the known side, then the factor by rows.
    fn both(
        &self,
        function: &mut Interpreter,
        extension: &X,
        y: &SVector<f64, N>,
        u: &SVector<f64, N>,
    ) -> Sides<f64, N, N> {
        let mut values = function.evaluate(|place| match place.checked_sub(self.known) {
            None => extension.value(self.nz, place),
            Some(place) if place < self.ny => y[place],
            Some(place) => u[place - self.ny],
        });
        let known = column(&mut values, self.nr);
        Sides { known, factor: rows(&mut values, self.ne) }
    }
}

/// The expected outputs of settings, as the runtime's `OutputForm` has them.
fn expected(settings: &Settings) -> Option<Vec<(usize, f64)>> {
    let Operator::Sampled(deviations) = &settings.operator else { return None };
    let reach = deviations.iter().map(|deviation| OutputForm::<(), f64, 0, 0>::NEAR * deviation);
    Some(settings.expected.as_ref()?.iter().copied().zip(reach).collect())
}

fn interpreter(program: &Program) -> Rc<RefCell<Interpreter>> {
    Rc::new(RefCell::new(Interpreter::new(program)))
}

/// The next `n` values, padded with zeros.
fn column<const N: usize>(values: &mut impl Iterator<Item = f64>, n: usize) -> SVector<f64, N> {
    let mut padded = SVector::zeros();
    for (place, value) in values.take(n).enumerate() {
        padded[place] = value;
    }
    padded
}

/// All remaining values as rows of this number of columns, padded with zeros.
fn rows<const N: usize>(values: &mut impl Iterator<Item = f64>, columns: usize) -> SMatrix<f64, N, N> {
    let mut padded = SMatrix::zeros();
    let (mut row, mut column) = (0, 0);
    for value in values {
        padded[(row, column)] = value;
        column += 1;
        if column == columns {
            (row, column) = (row + 1, 0);
        }
    }
    padded
}

impl<X: ReadableExtension<N>, K: RegressionType, const N: usize> Model<N, N, N, N, N, N> for Derived<X, K, N> {
    type Scalar = f64;
    type Extension = X;
    type X = SVector<Self::Scalar, N>;
    type Y = SVector<Self::Scalar, N>;
    type U = SVector<Self::Scalar, N>;
    type Terms = SVector<f64, N>;
    const REGRESSION: Regression = K::REGRESSION;

    fn rates(&self) -> usize {
        match (&self.output, K::REGRESSION) {
            (Some((rates, _)), _) => *rates,
            (None, Regression::Static) => 0,
            (None, Regression::Dynamic) => N,
        }
    }

    fn periods(&self) -> SVector<f64, N> {
        self.periods
    }

    fn is_local(&self) -> bool {
        self.is_local
    }

    fn terms(&self, y: &SVector<f64, N>) -> SVector<f64, N> {
        *y
    }

    const LINEARISED: bool = true;
    const RELATED: bool = true;

    fn flow(&self, y: &SVector<f64, N>, u: &SVector<f64, N>) -> Flow<f64, N> {
        self.flow_at(y, u, &SVector::zeros())
    }

    fn flow_near(&self, y: &SVector<f64, N>, u: &SVector<f64, N>, z: &SVector<f64, N>) -> Flow<f64, N> {
        let (Some(expected), Some((rates, _))) = (&self.expected, &self.output) else { return self.flow_at(y, u, z) };
        let mut near = *y;
        for (row, (place, reach)) in expected.iter().enumerate().take(*rates) {
            if (z[row] - y[*place]).abs() <= *reach {
                near[*place] = z[row];
            }
        }
        let flow = self.flow_at(&near, u, z);
        let is_finite = flow.h.iter().chain(flow.lambda.iter()).all(|entry| entry.is_finite());
        if is_finite { flow } else { self.flow_at(y, u, z) }
    }

    fn ahead(&self, start: &Flow<f64, N>, z: &SVector<f64, N>, dt: f64) -> SVector<f64, N> {
        if self.expected.is_some() { z + (start.lambda * z + start.h) * dt } else { *z }
    }

    fn output_slopes(&self, y: &SVector<f64, N>, u: &SVector<f64, N>, z: &SVector<f64, N>) -> OutputSlopes<f64, N, N> {
        let Some(slopes) = &self.slopes else {
            return OutputSlopes { rates: SMatrix::zeros(), cascade: SMatrix::zeros() };
        };
        let mut slopes = slopes.borrow_mut();
        let inputs = self.inputs;
        let mut values = slopes.evaluate(|place| match place.checked_sub(self.ny) {
            None => y[place],
            Some(place) if place < inputs => u[place],
            Some(place) => z[place - inputs],
        });
        let rates = rows(&mut values.by_ref().take(self.nr * self.nr), self.nr);
        OutputSlopes { rates, cascade: rows(&mut values, self.nr) }
    }

    fn regression(&self, extension: &X, y: &SVector<f64, N>, u: &SVector<f64, N>) -> Sides<f64, N, N> {
        let at_instant =
            self.with_instant.then(|| SVector::from_iterator(u.iter().copied().cycle().skip(self.inputs).take(N)));
        let u = at_instant.as_ref().unwrap_or(u);
        let Some((rows, _)) = self.output else { return self.sides(extension, y, u) };
        let mut held = self.primitive(extension, y);
        let mut through = SMatrix::<f64, N, N>::zeros();
        (0..rows).for_each(|row| through[(row, row)] = 1.0);
        if rows < self.nr {
            let instant = self.affine(&self.inner(&extension.parts().0, rows), y, u);
            let slopes = self.output_slopes(y, u, &SVector::zeros()).rates;
            let (known, factor) = (instant.known - slopes * held.known, instant.factor - slopes * held.factor);
            for row in rows..self.nr {
                held.known[row] = known[row];
                held.factor.set_row(row, &factor.row(row));
                through.set_row(row, &-slopes.row(row));
            }
        }
        for i in 0..self.nr {
            for j in 0..self.nz {
                through[(i, rows + j)] = -held.factor[(i, j)];
            }
        }
        let (offset, map) = extension.parts();
        Sides { known: held.known - through * offset, factor: through * map }
    }

    fn primitive(&self, extension: &X, y: &SVector<f64, N>) -> Sides<f64, N, N> {
        if let Some(primitive) = &self.primitive {
            let extension = self.output.as_ref().map_or(extension, |(_, start)| start);
            return self.both(&mut primitive.borrow_mut(), extension, y, &SVector::zeros());
        }
        let mut used = SVector::zeros();
        for (row, &output) in self.rows.iter().enumerate() {
            used[row] = y[output];
        }
        Sides { known: used, factor: SMatrix::zeros() }
    }

    fn theta(&self, eta: &SVector<f64, N>) -> SVector<f64, N> {
        if self.output.is_some() {
            return *eta;
        }
        column(&mut self.theta.borrow_mut().evaluate(|place| eta[place]), self.nz)
    }

    fn functions(&self, theta: &SVector<f64, N>) -> Option<Functions<f64, N, N>> {
        let mut functions = self.functions.as_ref()?.borrow_mut();
        let mut values = functions.evaluate(|place| theta[place]);
        let eta = column(&mut values, self.ne);
        Some(Functions { values: eta, slopes: rows(&mut values, self.nz) })
    }

    fn begin(&self, extension: &X, y: &SVector<f64, N>) -> X {
        if self.output.is_none() {
            return *extension;
        }
        let known = self.regression(extension, y, &SVector::zeros()).known;
        let rates = self.leading_outputs();
        let mut begun = *extension;
        begun.rebase(&SVector::from_fn(|row, _| if row < rates { -known[row] } else { 0.0 }));
        let held = self.primitive(extension, y).factor;
        let mut map = SMatrix::<f64, N, N>::identity();
        map.view_mut((0, rates), (rates, self.nz)).copy_from(&held.view((0, 0), (rates, self.nz)));
        begun.mapped(&map)
    }

    fn parameters(&self, z: &SVector<f64, N>, y: &SVector<f64, N>) -> SVector<f64, N> {
        let Some((states, _)) = self.transform else { return *z };
        let (first, x) = (self.leading_outputs(), self.recover(z, y));
        let state = |i: usize| i.checked_sub(first).filter(|i| *i < states).map_or(0.0, |i| x[i]);
        SVector::from_fn(|i, _| if i < first { z[i] } else { state(i) })
    }

    fn range(&self, parameters: &SVector<f64, N>, y: &SVector<f64, N>) -> Option<Functions<f64, N, N>> {
        let (states, transform) = self.transform.as_ref()?;
        let (first, y) = (self.leading_outputs(), self.expected_at(parameters, y));
        let mut transform = transform.borrow_mut();
        let of = |place: usize| if place < *states { parameters[first + place] } else { y[place - states] };
        let mut found = transform.evaluate(of);
        let (inner, inner_slopes): (SVector<f64, N>, SMatrix<f64, N, N>) =
            (column(&mut found, self.nz), rows(&mut found, *states));
        let mut values = *parameters;
        let mut slopes = SMatrix::identity();
        for i in 0..self.nz {
            values[first + i] = inner[i];
            (0..self.nz).for_each(|j| slopes[(first + i, first + j)] = inner_slopes[(i, j)]);
        }
        // Beyond its size nothing is a coordinate.
        (first + self.nz..N).for_each(|i| (values[i], slopes[(i, i)]) = (0.0, 0.0));
        Some(Functions { values, slopes })
    }

    fn recover(&self, z: &SVector<f64, N>, y: &SVector<f64, N>) -> SVector<f64, N> {
        let (first, y) = (self.leading_outputs(), self.expected_at(z, y));
        let of = |place: usize| if place < self.nz { z[first + place] } else { y[place - self.nz] };
        column(&mut self.phi_left.borrow_mut().evaluate(of), N)
    }
}

/// A design is re-based only where the condition is proved.
impl<X: ReadableExtension<N>, K: RegressionType, const N: usize> pebo_runtime::Rebase<N, N, N, N, N>
    for Derived<X, K, N>
{
}

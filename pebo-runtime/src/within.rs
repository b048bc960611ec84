//! Known bounds of the state.

use nalgebra::SVector;

use crate::{Fault, Flow, Functions, Model, OutputSlopes, Real, Rebase, Regression, Sides};

/// A model whose recovered state is projected onto bounds `lower <= x <= upper`, component by component.
///
/// Holds when: the state obeys the bounds. Then the projection brings every component of the error closer to 0 or
/// leaves it. Only the estimate that goes out is projected: `theta`, the extension and the estimator know nothing of
/// it, so what is proved of them remains true. Bounds of the regression's unknown are for [`Bounded`](crate::Bounded).
///
/// A left inverse without a value is a fault as before, bounds or not.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Within<M, S: Real, const NX: usize> {
    model: M,
    lower: SVector<S, NX>,
    upper: SVector<S, NX>,
}

impl<M, S: Real, const NX: usize> Within<M, S, NX> {
    /// Bounds on every recovered state, in its units; an infinite one does not bind.
    ///
    /// # Errors
    /// [`Fault::Start`] unless `lower <= upper` in every component.
    pub fn new(model: M, lower: &SVector<S, NX>, upper: &SVector<S, NX>) -> Result<Self, Fault> {
        let ordered = lower.iter().zip(upper.iter()).all(|(lower, upper)| lower <= upper);
        if ordered { Ok(Self { model, lower: *lower, upper: *upper }) } else { Err(Fault::Start) }
    }

    /// The model within.
    pub fn model(&self) -> &M {
        &self.model
    }
}

impl<M, S, const NX: usize, const NY: usize, const NU: usize, const NZ: usize, const NR: usize, const NE: usize>
    Model<NX, NY, NU, NZ, NR, NE> for Within<M, S, NX>
where
    S: Real,
    M: Model<NX, NY, NU, NZ, NR, NE, Scalar = S>,
{
    type Scalar = S;
    type Extension = M::Extension;
    type X = M::X;
    type Y = M::Y;
    type U = M::U;
    type Terms = M::Terms;
    const REGRESSION: Regression = M::REGRESSION;
    const INSTANTS: usize = M::INSTANTS;
    const LINEARISED: bool = M::LINEARISED;
    const RELATED: bool = M::RELATED;
    const LOCAL: bool = M::LOCAL;

    fn is_local(&self) -> bool {
        self.model.is_local()
    }

    fn rates(&self) -> usize {
        self.model.rates()
    }

    fn periods(&self) -> SVector<S, NY> {
        self.model.periods()
    }

    fn terms(&self, y: &SVector<S, NY>) -> M::Terms {
        self.model.terms(y)
    }

    fn flow(&self, terms: &M::Terms, u: &SVector<S, NU>) -> Flow<S, NZ> {
        self.model.flow(terms, u)
    }

    fn regression(&self, extension: &M::Extension, terms: &M::Terms, u: &SVector<S, NU>) -> Sides<S, NR, NE> {
        self.model.regression(extension, terms, u)
    }

    fn primitive(&self, extension: &M::Extension, terms: &M::Terms) -> Sides<S, NR, NE> {
        self.model.primitive(extension, terms)
    }

    fn flow_near(&self, terms: &M::Terms, u: &SVector<S, NU>, z: &SVector<S, NZ>) -> Flow<S, NZ> {
        self.model.flow_near(terms, u, z)
    }

    fn ahead(&self, start: &Flow<S, NZ>, z: &SVector<S, NZ>, dt: S) -> SVector<S, NZ> {
        self.model.ahead(start, z, dt)
    }

    fn output_slopes(&self, terms: &M::Terms, u: &SVector<S, NU>, z: &SVector<S, NZ>) -> OutputSlopes<S, NR, NZ> {
        self.model.output_slopes(terms, u, z)
    }

    fn theta(&self, eta: &SVector<S, NE>) -> SVector<S, NZ> {
        self.model.theta(eta)
    }

    fn functions(&self, theta: &SVector<S, NZ>) -> Option<Functions<S, NE, NZ>> {
        self.model.functions(theta)
    }

    fn transform(&self, x: &SVector<S, NX>, terms: &M::Terms) -> Option<Functions<S, NZ, NX>> {
        self.model.transform(x, terms)
    }

    fn parameters(&self, z: &SVector<S, NZ>, terms: &M::Terms) -> SVector<S, NZ> {
        self.model.parameters(z, terms)
    }

    fn range(&self, parameters: &SVector<S, NZ>, terms: &M::Terms) -> Option<Functions<S, NZ, NZ>> {
        self.model.range(parameters, terms)
    }

    fn begin(&self, extension: &M::Extension, terms: &M::Terms) -> M::Extension {
        self.model.begin(extension, terms)
    }

    fn recover_unbounded(&self, z: &SVector<S, NZ>, terms: &M::Terms) -> SVector<S, NX> {
        self.model.recover_unbounded(z, terms)
    }

    fn recover(&self, z: &SVector<S, NZ>, terms: &M::Terms) -> SVector<S, NX> {
        let x = self.model.recover(z, terms);
        SVector::from_fn(|i, _| match (x[i], self.lower[i], self.upper[i]) {
            // Neither holds for a NaN; no bound mends an infinite estimate.
            (x, lower, _) if x < lower && Real::is_finite(x) => lower,
            (x, _, upper) if x > upper && Real::is_finite(x) => upper,
            (x, ..) => x,
        })
    }
}

impl<M, S, const NX: usize, const NY: usize, const NU: usize, const NZ: usize, const NR: usize>
    Rebase<NX, NY, NU, NZ, NR> for Within<M, S, NX>
where
    S: Real,
    M: Rebase<NX, NY, NU, NZ, NR> + Model<NX, NY, NU, NZ, NR, NZ, Scalar = S>,
{
}

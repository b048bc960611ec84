//! The output form of a model: its outputs are the regressand, and nothing is differentiated.

use nalgebra::{SMatrix, SVector};

use crate::numeric::dense::product;
use crate::{Extension, Fault, Flow, Fundamental, Model, Real, Rebase, Regression, Sides};

/// The output form of a model with a dynamic regression.
///
/// `d/dt [p_0 + p_1 z] = A + B z` and `z' = Lambda z + h` combined are a generalised cascade in `(w, z)` with
/// `w = p_0(y) + p_1(y) z`, and the measurements are a static regression in it:
///
/// ```text
/// w' = A + B z        z' = Lambda z + h        p_0(y) = w - p_1(y) z
/// ```
///
/// A row that holds at every instant, `0 = A + B z`, is one of these measurements already: it has no `w`.
///
/// With `p_0 = y` and `p_1 = 0`, as in most models, this is `y = y_0 + xi_y + Psi_y theta` with `y_0` among the
/// unknowns: `xi_y' = phi_0` and `Psi_y' = phi_1` along the run. Nothing is differentiated, so white noise of the
/// sensors stays white, and with [`SampledRegression`](crate::SampledRegression), [`LeastSquares`](crate::LeastSquares)
/// with process noise and [re-basing](crate::Observer::rebasing) at each sample the observer is a Kalman filter of the
/// transformed plant.
///
/// Outputs in the rates are states of the observer too where the model gives their slopes at its estimate, see
/// [`Model::output_slopes`]: with `S_w` and `S_z`
///
/// ```text
/// w' = A + B z - S_w p_0 + S_w (w - p_1 z)        z' = Lambda z + h - S_z p_0 + S_z (w - p_1 z)
/// ```
///
/// which is the same along every trajectory, where `p_0 = w - p_1 z`, whatever the estimate is, and free of the noise of
/// `p_0` to first order where it is right. Where the rates are affine in the outputs with such slopes the observer is *the*
/// continuous-discrete Kalman filter; near the truth it is the extended one, whose slopes these are.
///
/// Sizes: `NW = NR - M::INSTANTS + NZ` unknowns, those of `w` first. The unknown is `(w, z)` at the start less `chi_0`,
/// which has this length; the first sample is added to the entries of `chi_0` for `w`, whose unknown is then the error
/// of that sample: its variance at the start is the sensor's, and where `p_1` is not 0, `Psi` starts with it, as `w`
/// holds z.
///
/// Source: the output-error form of the regression, as in Ljung, *System identification*, 1999, chapter 4; re-based,
/// the Kalman filter in the form of Jazwinski, *Stochastic processes and filtering theory*, 1970, chapter 7.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OutputForm<M, const NR: usize, const NZ: usize> {
    model: M,
    /// The index in `y` of each row's output, where estimates are made of expected outputs. Rows without a `w` expect
    /// none.
    rows: Option<[usize; NR]>,
}

/// The terms of a sample that the functions of an [`OutputForm`] share.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measured<T, S: Real, const NY: usize> {
    terms: T,
    y: SVector<S, NY>,
}

impl<M, const NR: usize, const NZ: usize> OutputForm<M, NR, NZ> {
    /// The output form of a model, whose regression must be dynamic.
    pub fn new<const NX: usize, const NY: usize, const NU: usize>(model: M) -> Self
    where
        M: Rebase<NX, NY, NU, NZ, NR>,
    {
        const {
            assert!(matches!(M::REGRESSION, Regression::Dynamic), "a static regression has no rate to integrate");
        }
        Self { model, rows: None }
    }

    /// The same for a model whose `p_0` are outputs, at these indices in `y`, and whose `p_1` is 0. Its estimates are
    /// made of the outputs as the observer expects them, `phi_left(z, w)`, and not of samples with their noise: worth
    /// it where `phi_left` depends on outputs.
    ///
    /// # Errors
    /// [`Fault::Limits`] if an index is out of `y`.
    pub fn expecting<const NX: usize, const NY: usize, const NU: usize>(
        model: M,
        rows: [usize; NR],
    ) -> Result<Self, Fault>
    where
        M: Rebase<NX, NY, NU, NZ, NR>,
    {
        if rows.iter().any(|&place| place >= NY) {
            return Err(Fault::Limits);
        }
        Ok(Self { rows: Some(rows), ..Self::new(model) })
    }

    /// The outputs, those with rows as expected; none where estimates are made of samples.
    fn expected<S: Real, const NY: usize, const NW: usize>(
        &self,
        z: &SVector<S, NW>,
        y: &SVector<S, NY>,
        rates: usize,
    ) -> Option<SVector<S, NY>> {
        let mut expected = *y;
        for (row, &place) in self.rows.as_ref()?.iter().enumerate().take(rates) {
            if let Some(output) = expected.get_mut(place) {
                *output = z[row];
            }
        }
        Some(expected)
    }

    /// The model within.
    pub fn model(&self) -> &M {
        &self.model
    }
}

impl<M, const NX: usize, const NY: usize, const NU: usize, const NZ: usize, const NR: usize, const NW: usize>
    Model<NX, NY, NU, NW, NR, NW> for OutputForm<M, NR, NZ>
where
    M: Rebase<NX, NY, NU, NZ, NR>,
{
    type Scalar = M::Scalar;
    type Extension = Fundamental<M::Scalar, NW>;
    type X = M::X;
    type Y = M::Y;
    type U = M::U;
    type Terms = Measured<M::Terms, M::Scalar, NY>;
    const REGRESSION: Regression = Regression::Static;
    const LINEARISED: bool = true;

    fn periods(&self) -> SVector<M::Scalar, NY> {
        self.model.periods()
    }

    fn terms(&self, y: &SVector<M::Scalar, NY>) -> Self::Terms {
        Measured { terms: self.model.terms(y), y: *y }
    }

    fn flow(&self, terms: &Self::Terms, u: &SVector<M::Scalar, NU>) -> Flow<M::Scalar, NW> {
        self.flow_near(terms, u, &SVector::zeros())
    }

    fn flow_near(
        &self,
        Measured { terms, .. }: &Self::Terms,
        u: &SVector<M::Scalar, NU>,
        z: &SVector<M::Scalar, NW>,
    ) -> Flow<M::Scalar, NW> {
        const { assert!(NW + M::INSTANTS == NR + NZ, "the unknowns are those of the outputs with rates and those of z") };
        let rates = NW - NZ;
        let inner = self.model.flow(terms, u);
        // At the extension's start `z = theta`: the regression is then known as a function of z.
        let start = M::Extension::new(SVector::zeros());
        let rate = self.model.regression(&start, terms, u);
        let held = self.model.primitive(&start, terms);
        let slopes = self.model.output_slopes(terms, u, &SVector::from_fn(|i, _| z[NW - NZ + i]));
        let known = rate.known - product(&slopes.rates, &held.known);
        let h = inner.h - product(&slopes.cascade, &held.known);
        let factor = rate.factor - product(&slopes.rates, &held.factor);
        let plain = inner.lambda - product(&slopes.cascade, &held.factor);
        let mut flow = Flow { lambda: SMatrix::zeros(), h: SVector::zeros() };
        fill(&mut flow.h.data.0[0], &known.data.0[0], &h.data.0[0], rates);
        for (j, column) in flow.lambda.data.0.iter_mut().enumerate() {
            match j.checked_sub(rates) {
                None => fill(column, &slopes.rates.data.0[j], &slopes.cascade.data.0[j], rates),
                Some(j) => fill(column, &factor.data.0[j], &plain.data.0[j], rates),
            }
        }
        flow
    }

    fn regression(
        &self,
        extension: &Self::Extension,
        Measured { terms, .. }: &Self::Terms,
        u: &SVector<M::Scalar, NU>,
    ) -> Sides<M::Scalar, NR, NW> {
        let rates = NW - NZ;
        let start = M::Extension::new(SVector::zeros());
        let mut held = self.model.primitive(&start, terms);
        if M::INSTANTS > 0 {
            let instant = self.model.regression(&start, terms, u);
            for row in rates..NR {
                held.known[row] = instant.known[row];
                held.factor.set_row(row, &instant.factor.row(row));
            }
        }
        let through = SMatrix::<M::Scalar, NR, NW>::from_fn(|i, j| match j.checked_sub(rates) {
            None if i == j => nalgebra::one(),
            None => nalgebra::zero(),
            Some(j) => -held.factor[(i, j)],
        });
        Sides { known: held.known - product(&through, extension.xi()), factor: product(&through, extension.psi()) }
    }

    fn theta(&self, eta: &SVector<M::Scalar, NW>) -> SVector<M::Scalar, NW> {
        *eta
    }

    fn begin(&self, extension: &Self::Extension, terms: &Self::Terms) -> Self::Extension {
        // The unknown of the outputs is then the error of the first sample, also where `w` holds z: `w = p_0 + p_1 z`.
        let rates = NW - NZ;
        let seen = self.regression(extension, terms, &SVector::zeros()).known;
        let mut begun = *extension;
        begun.rebase(&SVector::from_fn(|i, _| if i < rates { -seen[i] } else { nalgebra::zero() }));
        let held = self.model.primitive(&M::Extension::new(SVector::zeros()), &terms.terms).factor;
        if held == SMatrix::<M::Scalar, NR, NZ>::zeros() {
            return begun;
        }
        begun.mapped(&SMatrix::from_fn(|i, j| match j.checked_sub(rates) {
            Some(column) if i < rates => held[(i, column)],
            _ if i == j => nalgebra::one(),
            _ => nalgebra::zero(),
        }))
    }

    fn recover(&self, z: &SVector<M::Scalar, NW>, measured: &Self::Terms) -> SVector<M::Scalar, NX> {
        let inner = SVector::from_fn(|i, _| z[NW - NZ + i]);
        match self.expected(z, &measured.y, NW - NZ) {
            Some(expected) => self.model.recover(&inner, &self.model.terms(&expected)),
            None => self.model.recover(&inner, &measured.terms),
        }
    }

    fn recover_unbounded(&self, z: &SVector<M::Scalar, NW>, measured: &Self::Terms) -> SVector<M::Scalar, NX> {
        let inner = SVector::from_fn(|i, _| z[NW - NZ + i]);
        match self.expected(z, &measured.y, NW - NZ) {
            Some(expected) => self.model.recover_unbounded(&inner, &self.model.terms(&expected)),
            None => self.model.recover_unbounded(&inner, &measured.terms),
        }
    }
}

impl<M, const NX: usize, const NY: usize, const NU: usize, const NZ: usize, const NR: usize, const NW: usize>
    Rebase<NX, NY, NU, NW, NR> for OutputForm<M, NR, NZ>
where
    M: Rebase<NX, NY, NU, NZ, NR>,
{
}

/// Makes a column of as many entries of the outputs with rates, and then those of the cascade.
#[inline]
fn fill<S: Real, const NW: usize>(column: &mut [S; NW], outputs: &[S], cascade: &[S], rates: usize) {
    for (entry, &value) in column.iter_mut().zip(outputs.iter().take(rates).chain(cascade)) {
        *entry = value;
    }
}

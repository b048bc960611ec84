//! The output form of a model: its outputs are the regressand, and nothing is differentiated.

use nalgebra::{SMatrix, SVector};

use crate::numeric::dense::{applied, product};
use crate::numeric::sum::all_finite;
use crate::{Extension, Fault, Flow, Functions, Fundamental, Model, Real, Rebase, Regression, Sides};

/// The output form of a model with a dynamic regression.
///
/// `d/dt [p_0 + p_1 z] = A + B z` and `z' = Lambda z + h` combined are a generalised cascade in `(w, z)` with
/// `w = p_0(y) + p_1(y) z`, and the measurements are a static regression in it:
///
/// ```text
/// w' = A + B z        z' = Lambda z + h        p_0(y) = w - p_1(y) z
/// ```
///
/// A row that holds at every instant, `0 = A + B z`, is one of these measurements already: it has no `w` of its own.
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
/// `p_0` to first order where it is right. So it is with a row that holds at every instant, in which such an output
/// stands beside others. Where the rates are affine in outputs and `z` combined, with such slopes the
/// observer is *the* continuous-discrete Kalman filter.
///
/// Elsewhere the square of the noise is in these rates, a bias. A form that is [`expecting`](Self::expecting) outputs
/// takes the rates at the outputs that it expects, `w` itself, as long as these are near the sample: it is then the
/// extended Kalman filter. What drives it is always within so many standard deviations of the sample, however wrong the
/// estimate is.
///
/// Sizes: `NW = NR - M::INSTANTS + NZ` unknowns, those of `w` first. The unknown is `(w, z)` at the start less `chi_0`,
/// which has this length; the first sample is added to the entries of `chi_0` for `w`, whose unknown is then the error
/// of that sample: its variance at the start is the sensor's, and where `p_1` is not 0, `Psi` starts with it, as `w`
/// holds z.
///
/// Source: the output-error form of the regression, as in Ljung, *System identification*, 1999, chapter 4; re-based,
/// the Kalman filter in the form of Jazwinski, *Stochastic processes and filtering theory*, 1970, chapter 7.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OutputForm<M, S: Real, const NR: usize, const NZ: usize> {
    model: M,
    /// The outputs of the rows, where the model is evaluated at expected outputs.
    expected: Option<ExpectedOutputs<S, NR>>,
}

/// The outputs that are expected. Rows without a `w` expect none.
#[derive(Clone, Copy, Debug, PartialEq)]
struct ExpectedOutputs<S: Real, const NR: usize> {
    /// The index in `y` of each row's output.
    rows: [usize; NR],
    /// The distance from the sample up to which the expected output drives the rates.
    reach: SVector<S, NR>,
}

/// The terms of a sample that the functions of an [`OutputForm`] share.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measured<T, S: Real, const NY: usize> {
    terms: T,
    y: SVector<S, NY>,
}

impl<M, S: Real, const NR: usize, const NZ: usize> OutputForm<M, S, NR, NZ> {
    /// The standard deviations of a sensor within which an expected output is preferred to its sample: beyond, the estimate
    /// is on its way, or the model is wrong. Where it is right, one sample in 370 is that far off.
    pub const NEAR: f64 = 3.0;

    /// The output form of a model, whose regression must be dynamic.
    pub fn new<const NX: usize, const NY: usize, const NU: usize>(model: M) -> Self
    where
        M: Rebase<NX, NY, NU, NZ, NR, Scalar = S>,
    {
        const {
            assert!(matches!(M::REGRESSION, Regression::Dynamic), "a static regression has no rate to integrate");
        }
        Self { model, expected: None }
    }

    /// The same for a model whose `p_0` are outputs, at these indices in `y`, with samples of these standard deviations,
    /// and whose `p_1` is 0. Its rates and estimates are those of the outputs as the observer expects them, and not of
    /// samples with their noise: worth it where `phi_left` depends on outputs, or the rates on them otherwise than by a
    /// constant factor. An output that is expected further than [`NEAR`](Self::NEAR) from its sample does not drive the
    /// rates, nor do expected outputs at which these have no value: the sample does.
    ///
    /// # Errors
    /// [`Fault::Limits`] if an index is out of `y`, [`Fault::Gain`] if a standard deviation is negative or not finite.
    pub fn expecting<const NX: usize, const NY: usize, const NU: usize>(
        model: M,
        rows: [usize; NR],
        deviations: &SVector<S, NR>,
    ) -> Result<Self, Fault>
    where
        M: Rebase<NX, NY, NU, NZ, NR, Scalar = S>,
    {
        if rows.iter().any(|&place| place >= NY) {
            return Err(Fault::Limits);
        }
        if !deviations.iter().all(|&deviation| deviation >= S::zero() && Real::is_finite(deviation)) {
            return Err(Fault::Gain);
        }
        let reach = deviations * <S as Real>::from_f64(Self::NEAR);
        Ok(Self { expected: Some(ExpectedOutputs { rows, reach }), ..Self::new(model) })
    }

    /// The model within.
    pub fn model(&self) -> &M {
        &self.model
    }
}

impl<M, const NX: usize, const NY: usize, const NU: usize, const NZ: usize, const NR: usize, const NW: usize>
    Model<NX, NY, NU, NW, NR, NW> for OutputForm<M, M::Scalar, NR, NZ>
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
    const RELATED: bool = M::RELATED;

    /// The first sample of outputs with rates is where these begin.
    fn rates(&self) -> usize {
        NR - M::INSTANTS
    }

    fn periods(&self) -> SVector<M::Scalar, NY> {
        self.model.periods()
    }

    fn terms(&self, y: &SVector<M::Scalar, NY>) -> Self::Terms {
        Measured { terms: self.model.terms(y), y: *y }
    }

    fn flow(&self, terms: &Self::Terms, u: &SVector<M::Scalar, NU>) -> Flow<M::Scalar, NW> {
        let mut flow = Flow { lambda: SMatrix::zeros(), h: SVector::zeros() };
        self.linearise(&mut flow, &terms.terms, u, &SVector::zeros());
        flow
    }

    fn flow_near(
        &self,
        measured: &Self::Terms,
        u: &SVector<M::Scalar, NU>,
        z: &SVector<M::Scalar, NW>,
    ) -> Flow<M::Scalar, NW> {
        const { assert!(NW + M::INSTANTS == NR + NZ, "the unknowns are those of the outputs with rates and those of z") };
        let mut flow = Flow { lambda: SMatrix::zeros(), h: SVector::zeros() };
        let near = match &self.expected {
            Some(expected) => self.model.terms(&expected.near(z, &measured.y, NW - NZ)),
            None => measured.terms,
        };
        // One call for both, compiled in place.
        for terms in [&near, &measured.terms] {
            self.linearise(&mut flow, terms, u, z);
            if self.expected.is_none() || (all_finite(&flow.h) && all_finite(&flow.lambda)) {
                break;
            }
        }
        flow
    }

    fn ahead(&self, start: &Flow<M::Scalar, NW>, z: &SVector<M::Scalar, NW>, dt: M::Scalar) -> SVector<M::Scalar, NW> {
        if self.expected.is_some() { z + (applied(&start.lambda, z) + start.h) * dt } else { *z }
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
        let mut outputs = SMatrix::<M::Scalar, NR, NR>::identity();
        if M::INSTANTS > 0 {
            let z = SVector::from_fn(|i, _| extension.xi()[rates + i]);
            let instant = self.affine(terms, u, &z);
            let slopes = self.model.output_slopes(terms, u, &SVector::zeros()).rates;
            let known = instant.known - product(&slopes, &held.known);
            let factor = instant.factor - product(&slopes, &held.factor);
            for row in rates..NR {
                held.known[row] = known[row];
                held.factor.set_row(row, &factor.row(row));
                outputs.set_row(row, &-slopes.row(row));
            }
        }
        let through = SMatrix::<M::Scalar, NR, NW>::from_fn(|i, j| match j.checked_sub(rates) {
            None => outputs[(i, j)],
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

    /// Those of the model within, after the outputs.
    fn parameters(&self, z: &SVector<M::Scalar, NW>, measured: &Self::Terms) -> SVector<M::Scalar, NW> {
        let rates = NW - NZ;
        let inner = self.model.parameters(&SVector::from_fn(|i, _| z[rates + i]), &self.terms_at(z, measured));
        SVector::from_fn(|i, _| if i < rates { z[i] } else { inner[i - rates] })
    }

    fn range(
        &self,
        parameters: &SVector<M::Scalar, NW>,
        measured: &Self::Terms,
    ) -> Option<Functions<M::Scalar, NW, NW>> {
        let rates = NW - NZ;
        let terms = self.terms_at(parameters, measured);
        let inner = self.model.range(&SVector::from_fn(|i, _| parameters[rates + i]), &terms)?;
        let values = SVector::from_fn(|i, _| if i < rates { parameters[i] } else { inner.values[i - rates] });
        let slopes = SMatrix::from_fn(|i, j| match (i.checked_sub(rates), j.checked_sub(rates)) {
            (Some(i), Some(j)) => inner.slopes[(i, j)],
            _ if i == j => nalgebra::one(),
            _ => nalgebra::zero(),
        });
        Some(Functions { values, slopes })
    }

    fn recover(&self, z: &SVector<M::Scalar, NW>, measured: &Self::Terms) -> SVector<M::Scalar, NX> {
        self.model.recover(&SVector::from_fn(|i, _| z[NW - NZ + i]), &self.terms_at(z, measured))
    }

    fn recover_unbounded(&self, z: &SVector<M::Scalar, NW>, measured: &Self::Terms) -> SVector<M::Scalar, NX> {
        self.model.recover_unbounded(&SVector::from_fn(|i, _| z[NW - NZ + i]), &self.terms_at(z, measured))
    }
}

impl<M, const NX: usize, const NY: usize, const NU: usize, const NZ: usize, const NR: usize, const NW: usize>
    Rebase<NX, NY, NU, NW, NR> for OutputForm<M, M::Scalar, NR, NZ>
where
    M: Rebase<NX, NY, NU, NZ, NR>,
{
}

impl<M, S: Real, const NR: usize, const NZ: usize> OutputForm<M, S, NR, NZ> {
    /// The terms of the outputs that an estimate is made of.
    #[inline]
    fn terms_at<const NX: usize, const NY: usize, const NU: usize, const NW: usize>(
        &self,
        z: &SVector<S, NW>,
        measured: &Measured<M::Terms, S, NY>,
    ) -> M::Terms
    where
        M: Rebase<NX, NY, NU, NZ, NR, Scalar = S>,
    {
        match &self.expected {
            Some(expected) => self.model.terms(&expected.of(z, &measured.y, NW - NZ)),
            None => measured.terms,
        }
    }

    /// The model's regression as an affine function of z: where its extension starts, `z = theta`; a local one is linearised
    /// at this estimate.
    #[inline]
    fn affine<const NX: usize, const NY: usize, const NU: usize>(
        &self,
        terms: &M::Terms,
        u: &SVector<S, NU>,
        z: &SVector<S, NZ>,
    ) -> Sides<S, NR, NZ>
    where
        M: Rebase<NX, NY, NU, NZ, NR, Scalar = S>,
    {
        if !self.model.is_local() {
            return self.model.regression(&M::Extension::new(SVector::zeros()), terms, u);
        }
        let Sides { known, factor } = self.model.regression(&M::Extension::new(*z), terms, u);
        Sides { known: known - applied(&factor, z), factor }
    }

    /// Makes the flow that of these outputs, linearised at this estimate.
    #[inline]
    fn linearise<const NX: usize, const NY: usize, const NU: usize, const NW: usize>(
        &self,
        flow: &mut Flow<S, NW>,
        terms: &M::Terms,
        u: &SVector<S, NU>,
        z: &SVector<S, NW>,
    ) where
        M: Rebase<NX, NY, NU, NZ, NR, Scalar = S>,
    {
        let rates = NW - NZ;
        let inner = self.model.flow(terms, u);
        let z = SVector::from_fn(|i, _| z[rates + i]);
        let rate = self.affine(terms, u, &z);
        let held = self.model.primitive(&M::Extension::new(SVector::zeros()), terms);
        let slopes = self.model.output_slopes(terms, u, &z);
        let known = rate.known - product(&slopes.rates, &held.known);
        let h = inner.h - product(&slopes.cascade, &held.known);
        let factor = rate.factor - product(&slopes.rates, &held.factor);
        let plain = inner.lambda - product(&slopes.cascade, &held.factor);
        fill(&mut flow.h.data.0[0], &known.data.0[0], &h.data.0[0], rates);
        for (j, column) in flow.lambda.data.0.iter_mut().enumerate() {
            match j.checked_sub(rates) {
                None => fill(column, &slopes.rates.data.0[j], &slopes.cascade.data.0[j], rates),
                Some(j) => fill(column, &factor.data.0[j], &plain.data.0[j], rates),
            }
        }
    }
}

impl<S: Real, const NR: usize> ExpectedOutputs<S, NR> {
    /// The outputs of a sample, those of the first `rates` rows as expected.
    fn of<const NY: usize, const NW: usize>(
        &self,
        z: &SVector<S, NW>,
        y: &SVector<S, NY>,
        rates: usize,
    ) -> SVector<S, NY> {
        self.chosen(z, y, rates, |_, _| true)
    }

    /// The same where they are near those of the sample.
    fn near<const NY: usize, const NW: usize>(
        &self,
        z: &SVector<S, NW>,
        y: &SVector<S, NY>,
        rates: usize,
    ) -> SVector<S, NY> {
        self.chosen(z, y, rates, |row, distance| Real::abs(distance) <= self.reach[row])
    }

    fn chosen<const NY: usize, const NW: usize>(
        &self,
        z: &SVector<S, NW>,
        y: &SVector<S, NY>,
        rates: usize,
        is_chosen: impl Fn(usize, S) -> bool,
    ) -> SVector<S, NY> {
        let mut chosen = *y;
        for (row, &place) in self.rows.iter().enumerate().take(rates) {
            if let Some(output) = chosen.get_mut(place)
                && is_chosen(row, z[row] - *output)
            {
                *output = z[row];
            }
        }
        chosen
    }
}

/// Makes a column of as many entries of the outputs with rates, and then those of the cascade.
#[inline]
fn fill<S: Real, const NW: usize>(column: &mut [S; NW], outputs: &[S], cascade: &[S], rates: usize) {
    for (entry, &value) in column.iter_mut().zip(outputs.iter().take(rates).chain(cascade)) {
        *entry = value;
    }
}

//! An observer whose outputs arrive late.
//!
//! In: samples of outputs of different ages. Out: the estimate of now, made of the one of the last instant whose outputs
//! are all there, and from there on of those that are there already.

use nalgebra::SVector;

use super::{Innovation, Observer, StateOf, check};
use crate::numeric::sum::all_finite;
use crate::regression::Rows;
use crate::samples::{Arrivals, Instant};
use crate::{Estimator, Fault, Model, Real, RegressionOperator, Uncertain};

/// An observer whose outputs arrive late, at most `N` samples after their time.
///
/// ```text
/// instants        t-5   t-4   t-3   t-2   t-1    t          y_1 is on time, y_2 three samples late
/// y_1              *     *     *     *     *     *
/// y_2              *     *     *
///                           past ----- expected -> now
/// ```
///
/// One observer takes each sample when it is whole, as if nothing had been late: all that was proved holds for it. A copy
/// of it goes on to the present, with the outputs that are there already and the model's expectation of the others. So the
/// estimate is that of a filter that has the past among its states. It begins when the first sample is whole.
///
/// Delays need not be whole numbers of samples: see [`Arrivals`]. They may come with the samples,
/// [`step_with_delays`](Self::step_with_delays).
///
/// Holds when: the observer takes samples one by one ([`SampledRegression`](crate::SampledRegression)), and each late output
/// that its functions need has a row that is `y_i - (..)` with no `y_i` in the factor of the unknown.
///
/// Cost: a step for each sample and one for each instant that is on its way, of at most [`FORWARD`](Self::FORWARD) parts;
/// memory of a second observer and `N` samples. With more than `N` on their way the newest are joined.
///
/// # Faults
///
/// A sample that is refused for itself ([`Fault::Output`], [`Fault::Input`], [`Fault::Step`]) changes nothing. Any other
/// fault is that of a sample which has become whole, or of the way to the present: that sample is left out, its interval is
/// joined to the next one's, and the estimate is the last one.
///
/// Source: estimation from delayed measurements by filtering again from the time that they are of: Larsen, Andersen, Ravn,
/// Poulsen, *Incorporation of time delayed measurements in a discrete-time Kalman filter*, CDC 1998, section 2.
#[derive(Clone, Debug)]
pub struct LateObserver<
    M,
    E,
    const NX: usize,
    const NY: usize,
    const NU: usize,
    const NZ: usize,
    const NR: usize,
    const NE: usize,
    R,
    const N: usize,
> where
    M: Model<NX, NY, NU, NZ, NR, NE>,
    E: Estimator<M::Scalar, NR, NE>,
    R: RegressionOperator<M::Scalar, NR, NE>,
{
    /// At the last instant that was whole.
    past: Observer<M, E, NX, NY, NU, NZ, NR, NE, R>,
    /// At the present, once there was one.
    now: Option<Observer<M, E, NX, NY, NU, NZ, NR, NE, R>>,
    arrivals: Arrivals<M::Scalar, NY, NU, N>,
    late: Late<M::Scalar, NY, NR>,
}

/// The outputs that arrive late, and the rows of the regression by which others stand in for them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Late<S: Real, const NY: usize, const NR: usize> {
    /// The age of each output's samples as they arrive, in seconds; 0 for one on time.
    pub delays: SVector<S, NY>,
    /// The index in `y` of the output of each row: without its sample the row is left out.
    pub rows: [usize; NR],
    /// True for an output that the observer expects by its row where its sample is missing; else the last one stands in
    /// for it, which does for an output that no function of the model needs but its row.
    pub is_expected: [bool; NY],
}

impl<
    M,
    E,
    R,
    const NX: usize,
    const NY: usize,
    const NU: usize,
    const NZ: usize,
    const NR: usize,
    const NE: usize,
    const N: usize,
> LateObserver<M, E, NX, NY, NU, NZ, NR, NE, R, N>
where
    M: Model<NX, NY, NU, NZ, NR, NE> + Clone,
    E: Estimator<M::Scalar, NR, NE>,
    R: RegressionOperator<M::Scalar, NR, NE>,
    R::Step: Rows<M::Scalar, NR>,
{
    /// The most parts of the way to the present: of more instants, some are taken as one.
    pub const FORWARD: usize = 128;

    /// The observer before its first sample, from one that would take its samples on time.
    ///
    /// # Errors
    /// [`Fault::Gain`] unless each delay is finite and not negative.
    pub fn new(
        observer: Observer<M, E, NX, NY, NU, NZ, NR, NE, R>,
        late: Late<M::Scalar, NY, NR>,
    ) -> Result<Self, Fault> {
        if !late.delays.iter().all(is_delay) {
            return Err(Fault::Gain);
        }
        Ok(Self { past: observer, now: None, arrivals: Arrivals::default(), late })
    }

    /// Takes what arrives at the end of an interval of `dt` seconds during which the input was held at `u`, and returns the
    /// estimate of the state at that end. Before the first sample is whole it is that of the start.
    ///
    /// # Errors
    /// A [`Fault`], see [`LateObserver`].
    pub fn step(&mut self, y: impl Into<M::Y>, u: impl Into<M::U>, dt: M::Scalar) -> Result<M::X, Fault> {
        let delays = self.late.delays;
        self.step_with_delays(y, &delays, u, dt)
    }

    /// [`step`](Self::step) with samples that tell their age, in seconds for each output.
    ///
    /// # Errors
    /// A [`Fault`]; [`Fault::Output`] of an output whose age is negative or not finite.
    pub fn step_with_delays(
        &mut self,
        y: impl Into<M::Y>,
        delays: &SVector<M::Scalar, NY>,
        u: impl Into<M::U>,
        dt: M::Scalar,
    ) -> Result<M::X, Fault> {
        let (y, u) = (y.into().into(), u.into().into());
        check(&y, &u, dt)?;
        if let Some(index) = delays.iter().position(|delay| !is_delay(delay)) {
            return Err(Fault::Output { index });
        }
        self.arrive(&y, delays, &u, dt)
    }

    /// [`step`](Self::step) with outputs that are missing, NaN, as of sensors with different periods.
    ///
    /// # Errors
    /// A [`Fault`]; [`Fault::Output`] of an output that is missing, is not expected, and is no late one.
    pub fn step_partly(&mut self, y: impl Into<M::Y>, u: impl Into<M::U>, dt: M::Scalar) -> Result<M::X, Fault> {
        let (y, u): (SVector<M::Scalar, NY>, SVector<M::Scalar, NU>) = (y.into().into(), u.into().into());
        let Late { delays, is_expected, .. } = self.late;
        let is_missing = |output: usize| !Real::is_finite(y[output]);
        let is_replaced = |output: usize| is_expected[output] || delays[output] > nalgebra::zero();
        if let Some(index) = (0..NY).find(|output| is_missing(*output) && !is_replaced(*output)) {
            return Err(Fault::Output { index });
        }
        check(&SVector::<M::Scalar, NY>::zeros(), &u, dt)?;
        self.arrive(
            &y.map(|output| if Real::is_finite(output) { output } else { Real::from_f64(f64::NAN) }),
            &delays,
            &u,
            dt,
        )
    }

    fn arrive(
        &mut self,
        y: &SVector<M::Scalar, NY>,
        delays: &SVector<M::Scalar, NY>,
        u: &SVector<M::Scalar, NU>,
        dt: M::Scalar,
    ) -> Result<M::X, Fault> {
        self.arrivals.take(y, [delays, &self.past.model().periods()], u, dt);
        while let Some(instant) = self.arrivals.whole() {
            // The first sample must have all outputs: what comes before it is not of this observer's time.
            if self.past.terms().is_none() && !instant.is_complete() {
                self.arrivals.pass();
                continue;
            }
            if let Err(fault) = self.past.take_instant(&instant, &self.late) {
                self.arrivals.skip();
                return Err(fault);
            }
            self.arrivals.pass();
        }
        if self.past.terms().is_none() {
            let there = y.map(|y| if Real::is_finite(y) { y } else { nalgebra::zero() });
            let estimate: SVector<M::Scalar, NX> = self.past.estimate_at(there).into();
            return if all_finite(&estimate) { Ok(estimate.into()) } else { Err(Fault::Estimate) };
        }
        let mut now = self.past.clone();
        let count = self.arrivals.count();
        let part = count.div_ceil(Self::FORWARD).max(1);
        for from in (0..count).step_by(part) {
            if let Some(instant) = self.arrivals.joined(from..count.min(from + part)) {
                now.take_instant(&instant, &self.late)?;
            }
        }
        let estimate = now.estimate().ok_or(Fault::State)?;
        self.now = Some(now);
        Ok(estimate)
    }

    /// The innovation of the sample that becomes whole with what arrives, without taking it; to be called before a
    /// [`step`](Self::step) with the same arguments. It is 0 where none does, and of one that lacks an output.
    ///
    /// # Errors
    /// A [`Fault`] as of [`Observer::innovation`].
    pub fn innovation(
        &self,
        y: impl Into<M::Y>,
        u: impl Into<M::U>,
        dt: M::Scalar,
    ) -> Result<Innovation<M::Scalar, NR>, Fault>
    where
        E: Uncertain<M::Scalar, NE>,
    {
        let (y, u) = (y.into().into(), u.into().into());
        check(&y, &u, dt)?;
        let whole = self.arrivals.whole_with(&y, [&self.late.delays, &self.past.model().periods()], &u, dt);
        match whole.filter(Instant::is_complete) {
            Some(Instant { y, u, dt, .. }) => self.past.innovation(y, u, dt),
            None => Ok(Innovation::nothing()),
        }
    }

    /// The observer at the present; none before the first sample is whole.
    pub fn now(&self) -> Option<&Observer<M, E, NX, NY, NU, NZ, NR, NE, R>> {
        self.now.as_ref()
    }

    /// The observer at the last instant that was whole.
    pub fn past(&self) -> &Observer<M, E, NX, NY, NU, NZ, NR, NE, R> {
        &self.past
    }

    /// The estimate of the state at the present; none before the first sample is whole.
    pub fn estimate(&self) -> Option<M::X> {
        self.now.as_ref()?.estimate()
    }

    /// Its standard errors, see [`Observer::standard_error`].
    pub fn standard_error(&self) -> Option<SVector<M::Scalar, NX>>
    where
        E: Uncertain<M::Scalar, NE>,
    {
        self.now.as_ref()?.standard_error()
    }

    /// Starts again before the first sample, see [`Observer::restart`]; what is on its way is forgotten.
    ///
    /// # Errors
    /// [`Fault::Start`] unless both are finite; the observer is then exactly as before.
    pub fn restart(&mut self, chi_0: SVector<M::Scalar, NZ>, eta: &SVector<M::Scalar, NE>) -> Result<(), Fault> {
        self.past.restart(chi_0, eta)?;
        self.now = None;
        self.arrivals = Arrivals::default();
        Ok(())
    }

    /// Everything that a step changes, to be saved: the state of the past and what is on its way.
    pub fn state(&self) -> (&StateOf<M, E, R, NX, NY, NU, NZ, NR, NE>, &Arrivals<M::Scalar, NY, NU, N>) {
        (self.past.state(), &self.arrivals)
    }

    /// Goes on from a saved state; the estimate of the present is there again after the next step.
    ///
    /// # Errors
    /// [`Fault::State`] if it is not finite; the observer is then exactly as before.
    pub fn restore(
        &mut self,
        state: StateOf<M, E, R, NX, NY, NU, NZ, NR, NE>,
        arrivals: Arrivals<M::Scalar, NY, NU, N>,
    ) -> Result<(), Fault> {
        if !arrivals.is_sound() {
            return Err(Fault::State);
        }
        self.past.restore(state)?;
        self.now = None;
        self.arrivals = arrivals;
        Ok(())
    }
}

impl<M, E, R, const NX: usize, const NY: usize, const NU: usize, const NZ: usize, const NR: usize, const NE: usize>
    Observer<M, E, NX, NY, NU, NZ, NR, NE, R>
where
    M: Model<NX, NY, NU, NZ, NR, NE>,
    E: Estimator<M::Scalar, NR, NE>,
    R: RegressionOperator<M::Scalar, NR, NE>,
    R::Step: Rows<M::Scalar, NR>,
{
    /// Takes an instant with the outputs that are there.
    fn take_instant(
        &mut self,
        instant: &Instant<M::Scalar, NY, NU>,
        late: &Late<M::Scalar, NY, NR>,
    ) -> Result<(), Fault> {
        let Instant { y, u, dt, .. } = instant;
        if instant.is_complete() {
            self.step(*y, *u, *dt).map(|_| ())
        } else {
            self.step_lacking(*y, (&late.rows, &late.is_expected), u, *dt).map(|_| ())
        }
    }
}

/// True for an age.
fn is_delay<S: Real>(delay: &S) -> bool {
    *delay >= S::zero() && Real::is_finite(*delay)
}

//! Runs observer and baselines over the samples of a source, one after the other, and scores their estimates.
//!
//! In: an experiment, and a source. Out: the table at each sample, and the summary. Excitation and certainty are evaluated
//! now and then, where the source says. Keeps no table but the present one.

use pebo_runtime::Fault;

use super::formulas::Formulas;
use super::setup::Experiment;
use super::source::{Arrival, Due, Sample, Source};
use crate::closed_loop::baseline::Follower;
use crate::observe::certainty::CertaintyMonitor;
use crate::observe::driver::ObserverDriver;
use crate::observe::excitation::ExcitationMonitor;
use crate::observe::padded::observer;
use crate::score::Scorer;
use crate::score::domain::DomainMonitor;
use crate::score::expected::ExpectedErrors;
use crate::summary::{EstimateScore, Summary};

/// An experiment at one sample.
#[derive(Debug)]
pub(crate) struct ExperimentState<'a> {
    experiment: &'a Experiment,
    /// All values, see [`Layout`](super::layout::Layout).
    pub(crate) table: Vec<f64>,
    pub(crate) driver: ObserverDriver,
    /// None before the first sample that they take.
    followers: Option<Vec<Box<dyn Follower>>>,
    errors: Formulas,
    scores: Vec<Scorer>,
    /// True for an estimate whose state was beyond its bounds.
    outside: Vec<bool>,
    excitation: ExcitationMonitor,
    certainty: CertaintyMonitor<'a>,
    expected: ExpectedErrors,
    assumed: DomainMonitor<'a>,
    samples: u64,
    /// The samples of which there are estimates, with the time of the last of them.
    pub(crate) estimated: u64,
    last: f64,
}

impl<'a> ExperimentState<'a> {
    /// The experiment before its first sample.
    ///
    /// # Errors
    /// The fault of settings with which no observer can be made.
    pub(crate) fn start(experiment: &'a Experiment) -> Result<Self, Fault> {
        let Experiment { design, layout, scored, .. } = experiment;
        Ok(Self {
            experiment,
            table: vec![0.0; layout.symbols.len()],
            driver: ObserverDriver::new(observer(design)?, design.names.clone()),
            followers: None,
            errors: Formulas::new(&experiment.errors),
            scores: scored.iter().map(|scored| Scorer::new(scored.period)).collect(),
            outside: vec![false; scored.len()],
            excitation: ExcitationMonitor::beside(&design.fixed),
            certainty: CertaintyMonitor::new(&design.wanted),
            expected: ExpectedErrors::default(),
            assumed: experiment.assumed.watch(),
            samples: 0,
            estimated: 0,
            last: 0.0,
        })
    }

    /// Takes all samples of a source, and passes the table of each to `show`.
    pub(crate) fn follow<S: Source>(
        mut self,
        source: &mut S,
        mut show: impl FnMut(&S, &[f64]) -> Result<(), S::Failure>,
    ) -> Result<Self, S::Failure> {
        while self.step(source)? {
            show(source, &self.table)?;
        }
        self.look(self.driver.standard_errors());
        Ok(self)
    }

    /// Takes the next sample; false if there is none.
    pub(crate) fn step<S: Source>(&mut self, source: &mut S) -> Result<bool, S::Failure> {
        let Some(sample) = source.next(&mut self.table)? else { return Ok(false) };
        let elapsed = sample.elapsed;
        let taken = self.observe(&sample);
        let due = source.settle(&mut self.table, &self.driver, taken)?;
        self.judge(elapsed, due);
        Ok(true)
    }

    /// Passes a sample to observer and baselines.
    fn observe(&mut self, sample: &Sample<'_>) -> Option<Result<(), Fault>> {
        let Experiment { layout, design, followers, .. } = self.experiment;
        let Sample { dt, inputs, .. } = *sample;
        let hat = &mut self.table[layout.hat.clone()];
        let taken = match sample.own {
            Arrival::Whole(outputs) => Some(self.driver.arrive(outputs, inputs, dt, hat)),
            Arrival::Lost => {
                self.driver.miss(design.outputs, inputs, dt, hat);
                None
            }
            Arrival::Early => return None,
        };
        let after = if design.with_instant { &inputs[design.inputs..] } else { inputs };
        match (&mut self.followers, sample.outputs) {
            (Some(running), outputs) => {
                for follower in running {
                    follower.sample(outputs, [inputs, after], dt);
                }
            }
            // They begin with the observer, or where the truth says how wrong they are.
            (None, Some(outputs)) if taken == Some(Ok(())) || sample.truth.is_some() => {
                let begun = followers.iter().map(|(_, baseline)| baseline.follower(sample.truth, outputs));
                self.followers = Some(begun.collect());
            }
            (None, _) => {}
        }
        for ((place, _), follower) in followers.iter().zip(self.followers.iter().flatten()) {
            follower.write(&mut self.table[place.clone()]);
        }
        taken
    }

    /// Scores the estimates of a sample.
    fn judge(&mut self, elapsed: f64, due: Due) {
        let Experiment { layout, design, scored, has_truth, .. } = self.experiment;
        self.samples += 1;
        self.assumed.look(elapsed, &self.table);
        if due.scores {
            (self.estimated, self.last) = (self.estimated + 1, elapsed);
            let errors = self.errors.of(&self.table);
            self.table[layout.errors.clone()].copy_from_slice(errors);
            let places = self.scores.iter_mut().zip(&mut self.outside).zip(scored).zip(errors);
            for (((score, outside), scored), error) in places {
                let truth = self.table[scored.truth];
                // A cell of a recording may have no number.
                if *has_truth || error.is_finite() {
                    score.add(elapsed, *error, truth);
                }
                *outside |= *has_truth && scored.own.is_some_and(|own| design.is_outside(own, truth));
            }
        } else {
            self.table[layout.errors.clone()].fill(f64::NAN);
        }
        if !(due.standard_errors || due.monitors) {
            return;
        }
        let predicted = self.driver.standard_errors();
        if due.standard_errors {
            let known = predicted.iter().flatten().copied().filter(|_| due.scores).chain(std::iter::repeat(f64::NAN));
            self.table[layout.standard_errors.clone()].iter_mut().zip(known).for_each(|(cell, value)| *cell = value);
        }
        if due.monitors {
            self.look(predicted);
        }
    }

    /// Evaluates excitation and certainty.
    fn look(&mut self, predicted: Option<Vec<f64>>) {
        self.excitation.look(self.last, &self.driver.observer.component_information(), predicted.as_deref());
        self.certainty.look(self.last, predicted.as_deref());
        self.expected.add(self.last, predicted);
    }

    /// The summary after the last sample; `contradiction` is how many times as large as expected innovations are, if that
    /// contradicts the observer's numbers.
    pub(crate) fn summary(&self, contradiction: Option<f64>) -> Summary {
        let Experiment { design, scored, .. } = self.experiment;
        let rated = scored.iter().zip(&self.scores).zip(&self.outside).map(|((scored, score), outside)| {
            let score = score.finish();
            let own = scored.own.filter(|_| contradiction.is_none());
            EstimateScore {
                estimate: scored.estimate.clone(),
                score,
                expected: own.and_then(|own| self.expected.beside(&score, own)),
                step: scored.step,
                outside: *outside,
            }
        });
        Summary {
            end: self.last,
            samples: self.samples.saturating_sub(1),
            estimates: rated.collect(),
            excitation: self.excitation.excitation(&design.unknown_names),
            faults: self.driver.faults.clone(),
            dropped: self.driver.dropped,
            parted: self.driver.parted,
            stateless: self.driver.stateless,
            restarts: self.driver.observer.restarts(),
            outside: self.assumed.outside(),
            surprise: self.driver.surprise(),
            typical: self.driver.typical(),
            contradiction,
            certainty: self.certainty.certainty(),
            known: design.settings.known.clone(),
        }
    }
}

//! Runs a scenario, and keeps its rows and curves.

use std::ops::ControlFlow;

use super::failure::Failure;
use super::scenario::Scenario;
use super::simulated::SimulatedPlant;
use super::trace::Trace;
use crate::experiment::curves::Curves;
use crate::experiment::follow::ExperimentState;
use crate::experiment::layout::TIME;
use crate::figure::curve::Curve;
use crate::summary::{Summary, contradiction};

impl Scenario {
    /// Runs the loop from its start to its end.
    pub fn run(&self) -> Result<Trace, Failure> {
        self.run_while(&mut |_| ControlFlow::Continue(()))
    }

    /// [`run`](Self::run) with reports: `progress` gets the finished share, 0 to 1, now and then, and may end the run
    /// with [`Failure::Stopped`].
    pub fn run_while(&self, progress: &mut dyn FnMut(f64) -> ControlFlow<()>) -> Result<Trace, Failure> {
        let (mut rows, mut curves) = (Vec::new(), Curves::<Curve>::new(&self.experiment));
        let show = &mut |plant: &SimulatedPlant<'_>, table: &[f64]| {
            curves.add(table, |curve, value| {
                curve.add(plant.sample(), self.timing.samples, (table[TIME], value));
            });
            if plant.is_row {
                rows.extend(self.experiment.columns.row(table));
            }
        };
        let summary = self.follow(show, progress)?;
        Ok(Trace::new((self.experiment.columns.names.clone(), rows), curves.finish(Curve::finish), summary))
    }

    /// Runs the loop, passes its table at each sample to `show`, and returns the summary.
    pub(crate) fn follow(
        &self,
        show: &mut dyn FnMut(&SimulatedPlant<'_>, &[f64]),
        progress: &mut dyn FnMut(f64) -> ControlFlow<()>,
    ) -> Result<Summary, Failure> {
        let refused = |fault| Failure::Refused { at: 0.0, samples: 1, fault };
        let start = ExperimentState::start(&self.experiment).map_err(refused)?;
        let mut plant = SimulatedPlant::new(self, progress);
        let end = start.follow(&mut plant, |plant, table| {
            show(plant, table);
            Ok(())
        })?;
        Ok(end.summary(contradiction(&end.driver, self.is_noisy())))
    }
}

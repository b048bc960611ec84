//! The curves of an experiment's figure, from its table at each sample.

use super::formulas::Formulas;
use super::setup::Experiment;
use crate::figure::curve::{DrawnCurve, drawn};
use crate::figure::panel::Panel;

/// The curves so far, of a kind that thins them out.
#[derive(Debug)]
pub(crate) struct Curves<'a, C> {
    panels: &'a [Panel],
    values: Formulas,
    growing: Vec<C>,
}

impl<'a, C: Clone + Default> Curves<'a, C> {
    /// The curves before the first sample.
    pub(crate) fn new(experiment: &'a Experiment) -> Self {
        let growing = vec![C::default(); experiment.curves.outputs.len()];
        Self { panels: &experiment.panels, values: Formulas::new(&experiment.curves), growing }
    }

    /// Adds the values of a table by `add`.
    pub(crate) fn add(&mut self, table: &[f64], add: impl Fn(&mut C, f64)) {
        self.growing.iter_mut().zip(self.values.of(table)).for_each(|(curve, value)| add(curve, *value));
    }

    /// Adds one value to all, which may be none.
    pub(crate) fn add_to_all(&mut self, add: impl Fn(&mut C)) {
        self.growing.iter_mut().for_each(add);
    }

    /// Each panel's curves.
    pub(crate) fn finish(self, points: impl Fn(C) -> Vec<(f64, f64)>) -> Vec<Vec<DrawnCurve>> {
        drawn(self.panels, self.growing.into_iter().map(points))
    }
}

//! The standard errors that an observer predicts for its estimates, as a run goes on.

/// The predicted standard errors at some instants.
#[derive(Clone, Debug, Default)]
pub(crate) struct ExpectedErrors {
    instants: Vec<(f64, Vec<f64>)>,
}

/// The most instants that are kept; more are thinned out.
const MOST: usize = 4096;

impl ExpectedErrors {
    /// Takes the prediction at an instant, if there is one.
    pub(crate) fn add(&mut self, t: f64, errors: Option<Vec<f64>>) {
        let Some(errors) = errors else { return };
        if self.instants.len() == MOST {
            let mut is_odd = false;
            self.instants.retain(|_| {
                is_odd = !is_odd;
                is_odd
            });
        }
        self.instants.push((t, errors));
    }

    /// The root mean square of an estimate's predicted errors from an instant on.
    pub(crate) fn since(&self, t: f64, estimate: usize) -> Option<f64> {
        let later = || self.instants.iter().filter(|(at, _)| *at >= t).filter_map(|(_, errors)| errors.get(estimate));
        let count = crate::timing::real(u64::try_from(later().count()).ok()?);
        let squares: f64 = later().map(|error| error * error).sum();
        (count > 0.0).then(|| (squares / count).sqrt())
    }
}

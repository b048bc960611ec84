//! The standard errors that an observer predicts for its estimates, as a run goes on.

use super::Score;

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

    /// The root mean square of an estimate's predicted errors while its own are scored. One that never errs by more than
    /// [`UNKNOWN`] times what is predicted in the second half is right by its start: then without the first predictions,
    /// if these are so large, as nothing was known of it.
    pub(crate) fn beside(&self, score: &Score, estimate: usize) -> Option<f64> {
        let later = self.instants.iter().filter(|(at, _)| *at >= score.since);
        let later: Vec<f64> = later.filter_map(|(_, errors)| errors.get(estimate).copied()).collect();
        let in_the_end = root_mean_square(&later[later.len() / 2..])?;
        let largest = UNKNOWN * in_the_end;
        let is_right = score.since <= 0.0 && score.worst <= largest;
        let known = later.iter().position(|error| !is_right || *error <= largest);
        root_mean_square(&later[known.unwrap_or(0)..])
    }
}

/// While noise averages out, an error falls with the root of time: to a tenth of it in a hundred times the time, of which
/// what is left out is a share too small to matter.
const UNKNOWN: f64 = 10.0;

fn root_mean_square(values: &[f64]) -> Option<f64> {
    let count = crate::timing::real(u64::try_from(values.len()).ok()?);
    (count > 0.0).then(|| (values.iter().map(|value| value * value).sum::<f64>() / count).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_not_known_yet_of_an_estimate_that_starts_right_is_left_out() {
        let mut expected = ExpectedErrors::default();
        for (t, error) in [(0.0, 10.0), (1.0, 0.05), (2.0, 0.01), (3.0, 0.01), (4.0, 1e-6), (5.0, 1e-6)] {
            expected.add(t, Some(vec![error]));
        }
        let score =
            |since: f64, worst: f64| Score { first: 0.0, last: 0.0, settled: None, since, rms: 0.0, worst, trend: 1.0 };
        let is = |since: f64, worst: f64, errors: &[f64]| {
            let mean = root_mean_square(errors).expect("errors");
            let found = expected.beside(&score(since, worst), 0).expect("later instants");
            assert!((found - mean).abs() < 1e-15, "{since}");
        };
        is(0.0, 0.02, &[0.05, 0.01, 0.01, 1e-6, 1e-6]);
        // One that errs at first has settled at once if its state grows so large.
        is(0.0, 3.0, &[10.0, 0.05, 0.01, 0.01, 1e-6, 1e-6]);
        // Of one that settled later nothing is left out.
        is(3.0, 0.02, &[0.01, 1e-6, 1e-6]);
        is(4.0, 0.02, &[1e-6, 1e-6]);
        assert_eq!(expected.beside(&score(6.0, 0.02), 0), None);
    }
}

//! Judges whether the data determine the unknown.
//!
//! In: the regressors of an estimator. Out: the time since which they distinguish all components of the unknown, or the
//! one that they do not. Computed from their Gramian, with the estimator's own forgetting:
//!
//! ```text
//! G' = -beta G + Phi^T Phi        1 - R^2 of component i = 1/(G_ii (G^-1)_ii)
//! ```
//!
//! which is the share of a component's data that the other components do not explain. It says little where the extension
//! starts again from the estimate and data of long ago are almost all of one component. So standard errors count too,
//! where they are predicted: data that halve that of each state determine the unknown.
//!
//! Source: Belsley, Kuh, Welsch, *Regression diagnostics*, 1980, chapter 3 (variance inflation).

use pebo_runtime::Turn;
use pebo_runtime::nalgebra::SMatrix;
use serde::Serialize;

use super::certainty::State;

/// The share below which a component is not distinguished: its standard error is then a thousand times as large as with
/// the other components known.
const ENOUGH: f64 = 1e-6;

/// A share below this is rounding.
const ROUNDING: f64 = 1e-14;

/// A Gramian beyond this is scaled down: turns by a dying fundamental matrix let it grow without end.
const LARGE: f64 = 1e150;

/// The excitation by the data.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "state", rename_all = "kebab-case")]
pub enum Excitation {
    /// They never determined the unknown.
    NotYet {
        /// The component of the unknown that is distinguished least.
        weakest: String,
    },
    /// The data determine the unknown.
    Converged {
        /// The time since then, in seconds.
        since: f64,
    },
    /// They did, and the estimator has forgotten them since.
    Lost {
        /// The time since then, in seconds.
        since: f64,
        /// The component of the unknown that is distinguished least.
        weakest: String,
    },
}

/// The Gramian of the regressors.
#[derive(Clone, Debug)]
pub(crate) struct Gramian<const N: usize> {
    unknowns: usize,
    forgetting: f64,
    value: SMatrix<f64, N, N>,
    /// True while its size measures the amount of data.
    is_measure: bool,
}

impl<const N: usize> Gramian<N> {
    /// The Gramian before any data; forgetting is in 1/s.
    pub(crate) fn new(unknowns: usize, forgetting: f64) -> Self {
        Self { unknowns, forgetting, value: SMatrix::zeros(), is_measure: forgetting > 0.0 }
    }

    /// Takes the regressor of a step.
    pub(crate) fn add(&mut self, regressor: &SMatrix<f64, N, N>, dt: f64) {
        let kept = if self.forgetting > 0.0 { (-self.forgetting * dt).exp() } else { 1.0 };
        for i in 0..self.unknowns {
            for j in 0..=i {
                let product = regressor.column(i).dot(&regressor.column(j)) * dt;
                self.value[(i, j)] = self.value[(i, j)] * kept + product;
                self.value[(j, i)] = self.value[(i, j)];
            }
        }
    }

    /// Follows a change of the unknown, as an estimator does.
    pub(crate) fn turn(&mut self, turn: &Turn<f64, N>) {
        self.value += turn.of_gramian(&self.value);
        if self.value.amax() > LARGE {
            self.value /= LARGE;
            self.is_measure = false;
        }
    }

    /// Starts again without data.
    pub(crate) fn reset(&mut self) {
        self.value.fill(0.0);
    }

    /// The information on each component.
    pub(crate) fn component_information(&self) -> ComponentInformation {
        let data: Vec<f64> = (0..self.unknowns).map(|i| self.value[(i, i)]).collect();
        let shares = (0..self.unknowns).map(|i| if data[i] > 0.0 { self.share(i, &data) } else { 0.0 }).collect();
        // Without forgetting nothing is lost.
        ComponentInformation { data: if self.is_measure { data } else { Vec::new() }, shares }
    }

    /// The share of a component's data that the others do not explain, 0 to 1.
    ///
    /// Method: Gauss elimination of the correlations, the largest pivot first and the component last, whose pivot it
    /// is.
    fn share(&self, component: usize, data: &[f64]) -> f64 {
        let mut rest = SMatrix::<f64, N, N>::zeros();
        for i in (0..self.unknowns).filter(|i| data[*i] > 0.0) {
            for j in (0..self.unknowns).filter(|j| data[*j] > 0.0) {
                rest[(i, j)] = self.value[(i, j)] / (data[i] * data[j]).sqrt();
            }
        }
        let mut open: Vec<usize> = (0..self.unknowns).filter(|i| *i != component).collect();
        let largest = |rest: &SMatrix<f64, N, N>, open: &[usize]| {
            (0..open.len()).max_by(|a, b| rest[(open[*a], open[*a])].total_cmp(&rest[(open[*b], open[*b])]))
        };
        while let Some(place) = largest(&rest, &open) {
            let pivot = open.swap_remove(place);
            let size = rest[(pivot, pivot)];
            // The others explain it, to rounding.
            if size.is_nan() || size <= ROUNDING {
                break;
            }
            for &i in open.iter().chain([&component]) {
                let factor = rest[(i, pivot)] / size;
                for &j in open.iter().chain([&component]) {
                    rest[(i, j)] -= factor * rest[(pivot, j)];
                }
            }
        }
        rest[(component, component)].max(0.0)
    }
}

/// The information of the data on each component of the unknown.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct ComponentInformation {
    /// The shares that the others do not explain, 0 to 1.
    shares: Vec<f64>,
    /// The sum of squares; empty where nothing is forgotten.
    data: Vec<f64>,
}

/// The share of each state's first standard error that is left where data determine the unknown. A sum of two unknowns
/// leaves 0.7 of the error of either.
const TOLD: f64 = 0.5;

/// The excitation as time goes on.
#[derive(Debug, Default)]
pub(crate) struct ExcitationMonitor {
    state: State,
    /// The components that the known start of the plant fixes: no data have to show them.
    fixed: Vec<usize>,
    /// The first standard errors of the states.
    first: Option<Vec<f64>>,
    weakest: usize,
    /// The variance of each component that was just enough when all were determined first, in units of the noise.
    enough: Vec<f64>,
}

impl ExcitationMonitor {
    /// The monitor of the components beside these, which are fixed.
    pub(crate) fn beside(fixed: &[usize]) -> Self {
        Self { fixed: fixed.to_vec(), ..Self::default() }
    }

    /// Takes the information at this instant, and the standard errors of the states where these are predicted.
    ///
    /// Loss is judged by a component's data, and not by its share alone: where the extension starts again from the
    /// estimate, old data of a state that dies out become ever more certain, and all others small beside them.
    pub(crate) fn look(&mut self, t: f64, information: &ComponentInformation, errors: Option<&[f64]>) {
        let is_told = errors
            .zip(self.first.as_ref())
            .is_some_and(|(errors, first)| errors.iter().zip(first).all(|(error, first)| *error <= TOLD * first));
        self.first = self.first.take().or_else(|| errors.map(<[f64]>::to_vec));
        let least = |values: &mut dyn Iterator<Item = f64>| {
            values.enumerate().min_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or((0, 0.0))
        };
        let open = |(place, share): (usize, &f64)| if self.fixed.contains(&place) { 1.0 } else { *share };
        let (weakest, share) = least(&mut information.shares.iter().enumerate().map(open));
        let known = information.data.iter().zip(&information.shares).map(|(data, share)| data * share.max(ROUNDING));
        let (faintest, certainty) = least(&mut known.zip(&self.enough).map(|(known, enough)| known * enough));
        let is_lost = !information.data.is_empty() && certainty < 0.5;
        match self.state {
            State::NotYet => {
                self.weakest = weakest;
                if share >= ENOUGH || is_told {
                    self.state = State::Converged(t);
                    let enough = information.data.iter().map(|data| 1.0 / (data * ENOUGH));
                    self.enough = if share >= ENOUGH { enough.collect() } else { Vec::new() };
                }
            }
            State::Converged(_) if is_lost && !self.enough.is_empty() => {
                (self.state, self.weakest) = (State::Lost(t), faintest);
            }
            State::Lost(_) if !is_lost && certainty >= 1.0 => self.state = State::Converged(t),
            State::Converged(_) | State::Lost(_) => {}
        }
    }

    /// The excitation, with the names of the components.
    pub(crate) fn excitation(&self, names: &[String]) -> Excitation {
        let weakest = names.get(self.weakest).cloned().unwrap_or_default();
        match self.state {
            State::NotYet => Excitation::NotYet { weakest },
            State::Converged(since) => Excitation::Converged { since },
            State::Lost(since) => Excitation::Lost { since, weakest },
        }
    }
}

#[cfg(test)]
mod tests {
    use pebo_runtime::nalgebra::{SMatrix, SVector};

    use super::{Excitation, ExcitationMonitor, Gramian};

    /// One equation `[cos a, sin a, 0]` of two unknowns, padded.
    fn row(angle: f64) -> SMatrix<f64, 3, 3> {
        let mut regressor = SMatrix::<f64, 3, 3>::zeros();
        regressor.set_row(0, &SVector::<f64, 3>::from([angle.cos(), 1e3 * angle.sin(), 0.0]).transpose());
        regressor
    }

    fn names() -> Vec<String> {
        ["theta1", "theta2"].map(str::to_owned).to_vec()
    }

    #[test]
    fn a_component_that_the_start_fixes_needs_no_data() {
        let mut information = Gramian::<3>::new(2, 0.0);
        information.add(&row(0.0), 0.1);
        for (fixed, is_determined) in [(&[][..], false), (&[1], true), (&[0], false)] {
            let mut watch = ExcitationMonitor::beside(fixed);
            watch.look(1.0, &information.component_information(), None);
            let excitation = watch.excitation(&names());
            assert_eq!(matches!(excitation, Excitation::Converged { .. }), is_determined, "{fixed:?}: {excitation:?}");
        }
    }

    #[test]
    fn the_share_is_unexplained_by_the_others() {
        let mut information = Gramian::<3>::new(2, 0.0);
        for angle in [0.3, 0.9] {
            information.add(&row(angle), 0.1);
        }
        // 1 - cos^2 of the angle between the columns, whatever their units are.
        let columns = [[0.3_f64.cos(), 0.9_f64.cos()], [0.3_f64.sin(), 0.9_f64.sin()]];
        let dot = |a: [f64; 2], b: [f64; 2]| a[0] * b[0] + a[1] * b[1];
        let expected =
            1.0 - dot(columns[0], columns[1]).powi(2) / dot(columns[0], columns[0]) / dot(columns[1], columns[1]);
        let information = information.component_information();
        assert!(information.shares.iter().all(|share| (share - expected).abs() < 1e-12), "{information:?} {expected}");
    }

    #[test]
    fn excitation_comes_and_goes_with_the_data() {
        let (mut information, mut watch) = (Gramian::<3>::new(2, 1.0), ExcitationMonitor::default());
        let mut states = Vec::new();
        for step in 0..600_u32 {
            let t = f64::from(step) * 0.1;
            // The regressor turns between 10 and 20 s, and stands at 0.5 before and after.
            let angle = 0.5 + (t - 10.0).clamp(0.0, 10.0);
            information.add(&row(angle), 0.1);
            watch.look(t, &information.component_information(), None);
            states.push(watch.excitation(&names()));
        }
        assert!(matches!(&states[99], Excitation::NotYet { .. }), "{:?}", states[99]);
        assert!(
            matches!(&states[250], Excitation::Converged { since } if (10.0..10.5).contains(since)),
            "{:?}",
            states[250]
        );
        // exp(-t) of the turning remains: a millionth after 14 s or so.
        let Excitation::Lost { since, .. } = &states[599] else { panic!("{:?}", states[599]) };
        assert!((30.0..40.0).contains(since), "{since}");
    }

    #[test]
    fn standard_errors_that_data_halve_are_enough() {
        let (mut information, mut watch) = (Gramian::<3>::new(2, 0.0), ExcitationMonitor::default());
        information.add(&row(0.3), 1.0);
        let mut after = |errors: [f64; 2]| {
            watch.look(1.0, &information.component_information(), Some(&errors));
            matches!(watch.excitation(&names()), Excitation::Converged { .. })
        };
        assert_eq!([[2.0, 4.0], [0.1, 3.0], [0.1, 2.0]].map(&mut after), [false, false, true]);
    }

    #[test]
    fn a_component_without_data_is_named() {
        let (mut information, mut watch) = (Gramian::<3>::new(2, 0.0), ExcitationMonitor::default());
        information.add(&row(0.0), 1.0);
        watch.look(0.0, &information.component_information(), None);
        assert_eq!(watch.excitation(&names()), Excitation::NotYet { weakest: "theta2".to_owned() });
    }
}

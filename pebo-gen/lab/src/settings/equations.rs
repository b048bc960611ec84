//! The equations of an observer, and the output that each says something of.
//!
//! In: a regression and the kind of the observer. Out: the output of each row, and the outputs that the observer expects
//! where their samples are missing: by an equation `y_i = (..)` that is free of `y_i` on the right.

use std::collections::BTreeSet;

use pebo_cas::{Expr, Rational, Symbol};
use pebo_design::analysis::{Derivation, Regression, RegressionKind};
use pebo_design::plant::Plant;

use super::kind::ObserverKind;

/// What the rows of a regression say of the outputs.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct SampleRows {
    /// The index in y of the output of each row.
    pub(crate) rows: Vec<usize>,
    /// True for an output that the observer expects by its row.
    pub(crate) is_expected: Vec<bool>,
}

impl SampleRows {
    /// The rows of an observer of samples, in the output form or of a static regression.
    #[cfg(feature = "simulate")]
    pub(crate) fn of(plant: &Plant, regression: &Regression, is_output_form: bool) -> Self {
        let kind = if is_output_form { ObserverKind::Output } else { ObserverKind::Sampled };
        Equations::of(plant, regression, kind).rows(plant, &vec![Rational::from(0); plant.y.len()])
    }
}

/// The equations of an observer.
pub(super) struct Equations {
    /// Those of samples: what is known in each, and the factors of the unknowns.
    samples: Vec<Equation>,
    /// The outputs that each is made of.
    sources: Vec<Vec<usize>>,
    /// The rows of outputs that are states of the observer.
    states: usize,
    /// The rates of these outputs.
    rates: Vec<Expr>,
}

struct Equation {
    known: Expr,
    factors: Vec<Expr>,
}

impl Equation {
    /// True if it depends on an output.
    fn has(&self, plant: &Plant, output: Symbol) -> bool {
        let own = BTreeSet::from([output]);
        plant.arena.depends_on(self.known, &own) || self.has_in_factor(plant, output)
    }

    fn has_in_factor(&self, plant: &Plant, output: Symbol) -> bool {
        let own = BTreeSet::from([output]);
        self.factors.iter().any(|factor| plant.arena.depends_on(*factor, &own))
    }

    /// True if it is `output = ..`, so that it says what the output is.
    fn expects(&self, plant: &Plant, output: Symbol) -> bool {
        let slope = plant.arena.as_number(plant.arena.derivative(self.known, output));
        slope == Some(Rational::ONE) && !self.has_in_factor(plant, output)
    }
}

impl Equations {
    /// Those of an observer of this kind.
    pub(super) fn of(plant: &Plant, regression: &Regression, kind: ObserverKind) -> Self {
        let arena = &plant.arena;
        let rates = match kind {
            ObserverKind::Output => regression.phi_0.len() - regression.instants(arena),
            ObserverKind::Sampled | ObserverKind::Filtered => 0,
        };
        let row = |row: usize| match regression.kind {
            RegressionKind::Dynamic if row < rates => {
                let output = plant.y[regression.rows()[row]].symbol;
                Equation { known: arena.of_symbol(output), factors: Vec::new() }
            }
            _ if row < rates => {
                Equation { known: regression.primitive_0[row], factors: regression.primitive_1[row].clone() }
            }
            _ => Equation { known: regression.phi_0[row], factors: regression.phi_1[row].clone() },
        };
        let of_rates = regression.phi_0.iter().zip(&regression.phi_1).take(rates);
        Self {
            samples: (0..regression.phi_0.len()).map(row).collect(),
            sources: regression.sources.clone(),
            states: rates,
            rates: of_rates.flat_map(|(known, factors)| std::iter::once(known).chain(factors)).copied().collect(),
        }
    }

    /// True if the rates of the observer depend on an output: those of the cascade and of outputs that are its states.
    pub(super) fn drive(&self, plant: &Plant, derivation: &Derivation, output: Symbol) -> bool {
        let own = BTreeSet::from([output]);
        let cascade = derivation.cascade.result.iter();
        let flow = cascade.flat_map(|cascade| cascade.h.iter().chain(cascade.lambda.iter().flatten().flatten()));
        flow.chain(&self.rates).any(|rate| plant.arena.depends_on(*rate, &own))
    }

    /// For each row the output that it gives by its value with an input in it.
    pub(super) fn with_inputs(
        &self,
        plant: &Plant,
        SampleRows { rows, is_expected }: &SampleRows,
    ) -> Vec<Option<usize>> {
        let inputs = plant.u.iter().copied().collect();
        let holds = |formula: &Expr| plant.arena.depends_on(*formula, &inputs);
        let output = |(row, equation): (usize, &Equation)| {
            let output = rows[row];
            // By its value a row says what an output is, by the first of its rows; the rate of an output holds no input.
            let is_its_own = is_expected[output] && rows.iter().position(|other| *other == output) == Some(row);
            let is_held = holds(&equation.known) || equation.factors.iter().any(holds);
            (is_its_own && is_held).then_some(output)
        };
        self.samples.iter().enumerate().map(output).collect()
    }

    /// The rows that lack something without each output, of outputs with these delays.
    pub(super) fn rows(&self, plant: &Plant, delays: &[Rational]) -> SampleRows {
        let mut rows: Vec<usize> = Vec::new();
        for (equation, sources) in self.samples.iter().zip(&self.sources) {
            // Without the latest of its outputs an equation says nothing yet.
            let own = || (0..plant.y.len()).filter(|output| equation.has(plant, plant.y[*output].symbol));
            let latest = own().reduce(|late, output| if delays[output] > delays[late] { output } else { late });
            // Beside outputs that are states of the observer an equation lacks nothing but the one that it says: what is
            // expected of the others stands in for them, and the observer knows how well.
            let of_states = &rows[..self.states.min(rows.len())];
            let mut others = own().filter(|output| !of_states.contains(output));
            let said = others.next().filter(|output| {
                others.next().is_none()
                    && equation.expects(plant, plant.y[*output].symbol)
                    && latest.is_some_and(|latest| delays[latest] <= delays[*output])
            });
            rows.push(said.or(latest).or(sources.first().copied()).unwrap_or(0));
        }
        // By the same row as in a run: the first that waits for the output.
        let expects = |output: usize| {
            let row = rows.iter().position(|row| *row == output);
            row.is_some_and(|row| self.samples[row].expects(plant, plant.y[output].symbol))
        };
        let is_expected = (0..plant.y.len()).map(expects).collect();
        SampleRows { rows, is_expected }
    }
}

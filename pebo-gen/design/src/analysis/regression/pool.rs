//! The pool of a plant's equations, from which a regression is selected.
//!
//! In: the plant with its proved cascade. Out: rates of outputs, as affine functions of z or others, with their
//! denominators cleared, in combinations; identities, relations among the components of the transform, and these under
//! the derivative. Each is reduced once, when it is asked for.

use std::cell::OnceCell;

use super::cancelling::{self, Combination, moved_freely};
use super::equation::Equation;
use super::premises::Premises;
use super::{affine_rate, cleared, differentiated, implicit, relations};
use crate::plant::Formula;
use pebo_cas::tower::Obstacle;

/// The equations of a plant.
pub(super) struct Pool<'a> {
    pub(super) premises: Premises<'a>,
    /// The rates that the plant gives.
    pub(super) rates: Vec<Rate>,
    cleared: OnceCell<Vec<Equation>>,
    relations: OnceCell<Vec<Equation>>,
    identities: OnceCell<Vec<Equation>>,
    affine_combinations: OnceCell<(Vec<Option<Equation>>, bool)>,
}

/// The rate of an output.
pub(super) struct Rate {
    pub(super) output: usize,
    pub(super) formula: Formula,
    /// The rate as an affine function of z, or as another one by the left inverse, if there is one; none where an
    /// unmeasured signal moves it.
    pub(super) equation: Option<Equation>,
    /// The obstacle to deciding whether it is affine in the transform.
    pub(super) obstacle: Option<Obstacle>,
}

/// The equations that a selection leaves out.
pub(super) struct Rest {
    pub(super) equations: Vec<Equation>,
    /// True if no equation is left that could say more of the unknowns.
    pub(super) complete: bool,
}

impl<'a> Pool<'a> {
    pub(super) fn of(premises: Premises<'a>) -> Self {
        let of_output = |(output, formula): (usize, Formula)| {
            let affine = affine_rate::equation(&premises, (premises.output(output), formula.expr), vec![output]);
            let is_moved = premises.is_moved(formula.expr);
            let in_z = || premises.in_z(formula.expr).unwrap_or(formula.expr);
            let (equation, obstacle) = match affine {
                Ok(Some(equation)) => (Some(equation), None),
                other => ((!is_moved).then(|| Equation::curved(&premises, output, in_z())), other.err()),
            };
            Rate { output, formula, equation, obstacle }
        };
        let given = premises.plant.y.iter().enumerate().filter_map(|(output, declared)| Some((output, declared.rate?)));
        let rates = given.map(of_output).collect();
        let [cleared, relations, identities] = [const { OnceCell::new() }; 3];
        Self { premises, rates, cleared, relations, identities, affine_combinations: OnceCell::new() }
    }

    /// The rates that no unmeasured signal moves.
    pub(super) fn unmoved(&self) -> impl Iterator<Item = &Equation> {
        self.rates.iter().filter_map(|rate| rate.equation.as_ref())
    }

    /// The rates that are affine in the transform.
    pub(super) fn affine(&self) -> impl Iterator<Item = &Equation> {
        self.unmoved().filter(|equation| equation.is_linear())
    }

    /// The rates that are not affine in the transform, and not moved either.
    pub(super) fn curved(&self) -> impl Iterator<Item = &Rate> {
        self.rates.iter().filter(|rate| rate.equation.as_ref().is_some_and(|equation| !equation.is_linear()))
    }

    /// These times their denominators, where that is an equation in z.
    pub(super) fn cleared(&self) -> &[Equation] {
        let cleared = |rate: &Rate| {
            let in_z = rate.equation.as_ref()?.rate;
            implicit::equation(&self.premises, (rate.output, rate.formula.expr), in_z).ok()?
        };
        self.cleared.get_or_init(|| self.curved().filter_map(cleared).collect())
    }

    /// The identities, or else relations among the components of the transform: these hold at every instant.
    pub(super) fn of_states(&self) -> &[Equation] {
        if self.premises.plant.identities.is_empty() {
            return self.relations();
        }
        self.identities.get_or_init(|| cleared::in_z(&self.premises))
    }

    fn relations(&self) -> &[Equation] {
        let found = || relations::among(&self.premises).unwrap_or_default();
        self.relations.get_or_init(|| if relations::possible(&self.premises) { found() } else { Vec::new() })
    }

    /// The same under the derivative, where that is affine in z.
    pub(super) fn differentiated(&self) -> Vec<Equation> {
        let equations = self.of_states().iter().filter_map(|of| differentiated::equation(&self.premises, of));
        let equations: Vec<Equation> = equations.collect();
        if equations.iter().all(Equation::is_linear) { equations } else { Vec::new() }
    }

    /// Combinations of these outputs from whose rates unmeasured signals cancel; none for one that is no function of z.
    pub(super) fn combinations(&self, outputs: &[usize]) -> Vec<Option<Equation>> {
        cancelling::unmoved(&self.premises, outputs).into_iter().map(|combination| self.in_z(combination)).collect()
    }

    /// Combinations of rates that are affine in phi, none for one that is no function of z; and true if there may be
    /// others.
    pub(super) fn affine_combinations(&self) -> &(Vec<Option<Equation>>, bool) {
        self.affine_combinations.get_or_init(|| {
            let outputs: Vec<usize> = self.unmoved().flat_map(|rate| rate.outputs.clone()).collect();
            let found = cancelling::affine(&self.premises, &outputs);
            let (found, moving) = found.unwrap_or((Vec::new(), outputs.len() > 1));
            (found.into_iter().map(|combination| self.in_z(combination)).collect(), moving)
        })
    }

    /// The equation of a combination of outputs, by its decomposition over phi or else by the left inverse.
    fn in_z(&self, Combination { output, formula: rate, outputs }: Combination) -> Option<Equation> {
        let premises = &self.premises;
        if let Ok(Some(equation)) = affine_rate::equation(premises, (output, rate), outputs.clone()) {
            return Some(equation);
        }
        let in_z = premises.at_left_inverse(rate).filter(|rate| !premises.is_hidden(*rate))?;
        Some(Equation::new(premises, output, in_z, outputs))
    }

    /// The equations that these leave out: combinations of outputs, relations among z, y and u, identities.
    pub(super) fn without(&self, given: &[Equation]) -> Rest {
        let premises = &self.premises;
        let is_used = |output: usize| given.iter().any(|e| e.is_rate(premises) && e.outputs == [output]);
        let unused: Vec<usize> = self.rates.iter().map(|rate| rate.output).filter(|output| !is_used(*output)).collect();
        let combined = self.combinations(&unused);
        let mut complete = moved_freely(premises, &unused, combined.len()) && combined.iter().all(Option::is_some);
        let mut rest: Vec<Equation> = combined.into_iter().flatten().collect();
        if given.iter().all(|equation| equation.is_instant(premises)) {
            // These are what the given ones are made of.
            complete &= premises.plant.identities.is_empty() || !relations::possible(premises);
        } else {
            let (instants, are_all) = self.instants();
            complete &= are_all;
            rest.extend(instants);
        }
        rest.retain(|equation| !given.iter().any(|given| given.is_same(equation, premises)));
        Rest { equations: rest, complete }
    }

    /// The relations at every instant that restrict the unknowns, of the components of the transform with measured
    /// signals, and identities; and true if these are all.
    fn instants(&self) -> (Vec<Equation>, bool) {
        let (premises, arena) = (&self.premises, self.premises.arena());
        let relations = self.relations();
        let mut complete = relations::are_all(premises, relations);
        let signals = premises.plant.y.iter().map(|o| o.symbol).chain(premises.plant.u.iter().copied()).collect();
        // One that is linear with constant coefficients and a constant right side only makes a component of phi redundant.
        let is_informative = |e: &Equation| !e.is_linear() || arena.depends_on(e.rate, &signals);
        let mut found: Vec<Equation> = relations.iter().filter(|e| is_informative(e)).cloned().collect();
        if !premises.plant.identities.is_empty() {
            let (open, known): (Vec<&Equation>, Vec<&Equation>) =
                self.of_states().iter().partition(|equation| premises.is_hidden(equation.rate));
            complete &= open.is_empty();
            let unknown = premises.unknown();
            found.extend(known.into_iter().filter(|e| arena.depends_on(e.rate, &unknown)).cloned());
        }
        (found, complete)
    }
}

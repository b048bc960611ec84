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
    of_states: OnceCell<Vec<Equation>>,
    affine: OnceCell<AffineCombinations>,
}

/// The rate of an output.
pub(super) struct Rate {
    pub(super) output: usize,
    pub(super) formula: Formula,
    pub(super) form: Form,
}

/// The form of a rate.
pub(super) enum Form {
    /// Affine in the transform.
    Affine(Equation),
    /// Another function of z, known as one by the left inverse; with the obstacle to a decision.
    Curved(Option<Equation>, Option<Obstacle>),
    /// Moved by an unmeasured signal.
    Moved,
}

/// Combinations of outputs whose rates are affine in phi.
struct AffineCombinations {
    equations: Option<Vec<Equation>>,
    /// Their number is larger than that of the rates that are affine themselves.
    are_more: bool,
    /// There are others, with coefficients that move.
    moving: bool,
}

/// The equations that a selection leaves out.
pub(super) struct Rest {
    /// Those that are affine in z.
    pub(super) linear: Vec<Equation>,
    /// The others.
    pub(super) curved: Vec<Equation>,
    /// True if no equation is left that could say more of the unknowns.
    pub(super) complete: bool,
}

impl<'a> Pool<'a> {
    pub(super) fn of(premises: Premises<'a>) -> Self {
        let of_output = |(output, formula): (usize, Formula)| {
            let affine = affine_rate::equation(&premises, (premises.output(output), formula.expr), vec![output]);
            let in_z = || Some(Equation::curved(&premises, output, premises.in_z(formula.expr)?));
            let form = match affine {
                Ok(Some(equation)) => Form::Affine(equation),
                _ if premises.is_moved(formula.expr) => Form::Moved,
                other => Form::Curved(in_z(), other.err()),
            };
            Rate { output, formula, form }
        };
        let given = premises.plant.y.iter().enumerate().filter_map(|(output, declared)| Some((output, declared.rate?)));
        let rates = given.map(of_output).collect();
        Self { premises, rates, of_states: OnceCell::new(), affine: OnceCell::new() }
    }

    /// The rates that no unmeasured signal moves.
    pub(super) fn unmoved(&self) -> impl Iterator<Item = &Rate> {
        self.rates.iter().filter(|rate| !matches!(rate.form, Form::Moved))
    }

    /// The equations of rates that are affine in the transform.
    pub(super) fn affine(&self) -> Vec<Equation> {
        self.rates.iter().filter_map(Rate::affine).cloned().collect()
    }

    /// Tests whether a rate is not affine in the transform, and not moved either.
    pub(super) fn has_curved(&self) -> bool {
        self.unmoved().any(|rate| rate.affine().is_none())
    }

    /// The rates whose denominators hold unknowns, times these: those that are affine in phi as formulas in x, then
    /// others.
    pub(super) fn cleared(&self) -> [Vec<Equation>; 2] {
        let premises = &self.premises;
        let in_z = |rate: &Rate| Some((rate.output, rate.in_z()?.rate)).filter(|(_, rate)| !premises.is_hidden(*rate));
        let rates: Option<Vec<_>> = self.unmoved().map(in_z).collect();
        let Some(rates) = rates.filter(|_| premises.left_inverse.is_some()) else { return [Vec::new(), Vec::new()] };
        let (mut linear, mut others) = (Vec::new(), Vec::new());
        for (rate, in_z) in self.unmoved().zip(&rates).filter(|(rate, _)| rate.affine().is_none()) {
            if let Some(equation) = self.cleared_affine(rate) {
                linear.push(equation);
            } else if let Ok(Some(equation)) = implicit::equation(premises, *in_z, &rates) {
                others.push(equation);
            }
        }
        [linear, others]
    }

    /// A rate times its denominator, where that is affine in phi as a formula in x.
    pub(super) fn cleared_affine(&self, rate: &Rate) -> Option<Equation> {
        implicit::affine_equation(&self.premises, (rate.output, rate.in_z()?.rate)).ok()?
    }

    /// What the states fulfil at every instant: the identities, or else relations among the components of the transform.
    pub(super) fn of_states(&self) -> &[Equation] {
        self.of_states.get_or_init(|| {
            if self.premises.plant.identities.is_empty() { self.relations() } else { cleared::in_z(&self.premises) }
        })
    }

    fn relations(&self) -> Vec<Equation> {
        let possible = relations::possible(&self.premises);
        if possible { relations::among(&self.premises).unwrap_or_default() } else { Vec::new() }
    }

    /// The same under the derivative, where that is an equation in z.
    pub(super) fn differentiated(&self) -> Vec<Equation> {
        self.of_states().iter().filter_map(|relation| differentiated::equation(&self.premises, relation)).collect()
    }

    /// Combinations of these outputs from whose rates unmeasured signals cancel; none for one that is no function of z.
    pub(super) fn combinations(&self, outputs: &[usize]) -> Vec<Option<Equation>> {
        cancelling::unmoved(&self.premises, outputs).into_iter().map(|combination| self.in_z(combination)).collect()
    }

    /// Combinations of rates that are affine in phi, where that is so of more than of rates themselves.
    pub(super) fn affine_combinations(&self) -> Vec<Equation> {
        let found = self.found_affine();
        found.equations.iter().filter(|_| found.are_more).flatten().cloned().collect()
    }

    /// Tests whether there may be combinations of rates that are affine in phi, which were not found.
    pub(super) fn may_have_affine_combinations(&self) -> bool {
        self.found_affine().are_more || self.found_affine().moving
    }

    fn found_affine(&self) -> &AffineCombinations {
        self.affine.get_or_init(|| {
            let outputs: Vec<usize> = self.unmoved().map(|rate| rate.output).collect();
            let (found, moving) =
                cancelling::affine(&self.premises, &outputs).unwrap_or((Vec::new(), outputs.len() > 1));
            let are_more = found.len() > self.affine().len();
            let equations = found.into_iter().map(|combination| self.in_z(combination)).collect();
            AffineCombinations { equations, are_more, moving }
        })
    }

    /// The equation of a combination of outputs, by its decomposition over phi or else by the left inverse.
    fn in_z(&self, Combination { output, rate, outputs }: Combination) -> Option<Equation> {
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
        let is_same =
            |a: &Equation, b: &Equation| a.primitive == b.primitive && (!a.is_instant(premises) || a.rate == b.rate);
        rest.retain(|equation| !given.iter().any(|given| is_same(given, equation)));
        let (linear, curved) = rest.into_iter().partition(Equation::is_linear);
        Rest { linear, curved, complete }
    }

    /// The relations at every instant that restrict the unknowns, of the components of the transform with measured
    /// signals, and identities; and true if these are all.
    fn instants(&self) -> (Vec<Equation>, bool) {
        let (premises, arena) = (&self.premises, self.premises.arena());
        let relations = self.relations();
        let mut complete = relations::are_all(premises, &relations);
        let signals = premises.plant.y.iter().map(|o| o.symbol).chain(premises.plant.u.iter().copied()).collect();
        // One that is linear with constant coefficients and a constant right side only makes a component of phi redundant.
        let is_informative = |e: &Equation| !e.is_linear() || arena.depends_on(e.rate, &signals);
        let mut found: Vec<Equation> = relations.into_iter().filter(is_informative).collect();
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

impl Rate {
    /// The equation, where the rate is affine in the transform.
    pub(super) fn affine(&self) -> Option<&Equation> {
        if let Form::Affine(equation) = &self.form { Some(equation) } else { None }
    }

    /// The rate as a function of z, if it is known as one.
    pub(super) fn in_z(&self) -> Option<&Equation> {
        match &self.form {
            Form::Affine(equation) => Some(equation),
            Form::Curved(equation, _) => equation.as_ref(),
            Form::Moved => None,
        }
    }
}

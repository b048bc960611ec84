//! A transform that was found, with its derivation.

use std::collections::BTreeSet;

use crate::analysis::{Class, Derivation, Excitation, Outcome, Verdict};
use crate::plant::Plant;
use pebo_cas::domain::zero::is_zero;
use pebo_cas::{Arena, Expr, Relation, Symbol};

use super::problem::Problem;

/// A transform with the verdicts on its claims.
#[derive(Debug)]
pub struct Candidate {
    /// The plant with this transform.
    pub plant: Plant,
    /// The derivation.
    pub derivation: Derivation,
    /// Conditions on signals that come with the transform.
    pub(super) conditions: Vec<(Expr, Relation)>,
}

impl Candidate {
    /// Derives the claims of a transform.
    pub(super) fn of(problem: &Problem<'_>, phi: &[Expr]) -> Self {
        let plant = problem.plant.with_transform(phi);
        Self::derive(plant, problem)
    }

    /// Derives the claims of a plant with its transform.
    pub(super) fn derive(plant: Plant, problem: &Problem<'_>) -> Self {
        let derivation = Derivation::derive(&plant);
        let arena = &plant.arena;
        // The plant may state that a radicand is not negative and that it is not zero.
        let is_of_plant = |(expr, relation): (Expr, Relation)| {
            let parts = [Relation::NonNegative, Relation::NonZero];
            let parts = if relation == Relation::Positive { &parts[..] } else { &[relation] };
            parts.iter().all(|part| problem.domain.grants(arena, (expr, *part)))
        };
        let is_own = |condition: &&(Expr, Relation)| {
            !arena.symbols_of(&[condition.0]).is_disjoint(&problem.signals) && !is_of_plant(**condition)
        };
        let conditions = derivation.conditions.iter().filter(is_own).copied().collect();
        Self { plant, derivation, conditions }
    }

    /// Tests whether every claim is proved and every state is recovered.
    pub fn is_full(&self) -> bool {
        self.derivation.outcome == Outcome::Accepted && self.recovered() == self.plant.x.len()
    }

    /// Tests whether its components are coordinates of the states: the cascade and the left inverse are proved.
    pub(super) fn has_coordinates(&self) -> bool {
        let [cascade, inverse] = [self.derivation.cascade.verdict, self.derivation.left_inverse.verdict];
        cascade == Verdict::Proved && inverse == Verdict::Proved
    }

    /// Tests whether the rates of the outputs are a linear regression for theta itself.
    pub fn is_linear(&self) -> bool {
        self.derivation.regression.result.as_ref().is_some_and(|regression| regression.is_linear(&self.plant))
    }

    /// Tests whether it proves that no transform serves: it recovers all states without a redundant component, and the
    /// outputs do not depend on a direction of its unknowns.
    pub fn hides_states(&self) -> bool {
        let is_proved = |verdict| verdict == Verdict::Proved;
        self.has_coordinates()
            && is_proved(self.derivation.regression.verdict)
            && self.derivation.identifiability.verdict == Verdict::Refuted
            && self.plant.phi.len() == self.plant.x.len()
            && self.recovered() == self.plant.x.len()
    }

    /// The states that move along a direction of the unknowns which the outputs do not depend on, if there is one.
    pub(super) fn hidden_states(&self) -> Option<Vec<Symbol>> {
        let (arena, plant) = (&self.plant.arena, &self.plant);
        if !self.hides_states() || !self.is_linear() {
            return None;
        }
        let direction = self.derivation.identifiability.result.as_ref()?.direction.as_ref()?;
        let moves = |formula: Expr| {
            let slopes = plant.z.iter().map(|z| arena.derivative(formula, *z));
            !arena.is_zero(arena.sum(slopes.zip(direction).map(|(slope, along)| arena.mul(slope, *along))))
        };
        let inverse = self.derivation.left_inverse.result.as_ref()?;
        Some(inverse.x.iter().filter(|(_, formula)| moves(*formula)).map(|(state, _)| *state).collect())
    }

    /// The number of recovered states.
    pub fn recovered(&self) -> usize {
        self.derivation.left_inverse.result.as_ref().map_or(0, |inverse| inverse.x.len())
    }

    /// The order of candidates: an accepted one, that recovers all states, filters all measured states, has outputs
    /// affine in z and leaves few out, has few exceptions, takes few samples as they are, multiplies few, and has the
    /// plainer form.
    pub(super) fn merit(&self) -> impl Ord + use<> {
        (self.standing(), self.unused(), self.conditions.len(), self.unfiltered().len(), self.multiplied(), self.form())
    }

    /// The order of candidates by what they are worth whatever the noise of the sensors is.
    pub(super) fn standing(&self) -> impl Ord + use<> {
        let accepted = match self.derivation.outcome {
            Outcome::Accepted => 0,
            Outcome::Undecided => 1,
            Outcome::Rejected => 2,
        };
        let missing = self.plant.x.len() - self.recovered().min(self.plant.x.len());
        (accepted, missing, self.copies_an_output(), !self.is_linear())
    }

    /// The number of outputs whose equations its regression leaves out.
    pub(super) fn unused(&self) -> usize {
        self.derivation.regression.result.as_ref().map_or(0, |regression| regression.unused.len())
    }

    /// What it does without: outputs, and the values for which a condition does not hold.
    pub(super) fn exceptions(&self) -> (usize, usize) {
        (self.unused(), self.conditions.len())
    }

    /// Tests whether it holds wherever the plant's own formulas have values: near an exception, estimates are lost.
    pub(super) fn is_everywhere(&self) -> bool {
        self.conditions.is_empty()
    }

    /// The order of candidates by their form: a plain cascade, few components, unknowns identifiable at once, and short.
    pub(super) fn form(&self) -> impl Ord + use<> {
        let kind = self.derivation.identifiability.result.as_ref().map(|result| result.kind);
        (
            self.derivation.class != Class::Pebo,
            self.plant.phi.len(),
            kind != Some(Excitation::Instant),
            size(&self.plant.arena, &self.plant.transform()),
        )
    }

    /// The states that the left inverse makes of samples of outputs which are given by their values, each with such an
    /// output. In the regression, where the value is an equation, the noise of samples is averaged; here it is not.
    pub(super) fn unfiltered(&self) -> Vec<(Symbol, Symbol)> {
        let arena = &self.plant.arena;
        let given: Vec<Symbol> = self.given().collect();
        let taken = |(state, formula): &(Symbol, Expr)| {
            let held = arena.symbols_of(&[*formula]);
            let state = *state;
            given.iter().copied().filter(move |output| held.contains(output)).map(move |output| (state, output))
        };
        self.derivation.left_inverse.result.iter().flat_map(|inverse| &inverse.x).flat_map(taken).collect()
    }

    /// The number of states that are made of samples of an output whose rate is no equation of the observer: with its rate,
    /// it is a state of the observer, and filtered.
    pub(super) fn taken(&self) -> usize {
        self.unfiltered().iter().filter(|(_, output)| !self.is_state(*output)).count()
    }

    /// Tests whether an output is a state of the observer: by its rate.
    fn is_state(&self, output: Symbol) -> bool {
        let regression = self.derivation.regression.result.as_ref();
        let with_rates = regression.and_then(|regression| regression.outputs_with_rates(&self.plant));
        with_rates.unwrap_or_default().iter().any(|place| self.plant.y[*place].symbol == output)
    }

    /// Tests whether a state is a sample as it is, and samples of outputs given by value are factors of the unknowns:
    /// their noise does not average out.
    pub(super) fn multiplies_samples(&self) -> bool {
        let given = self.given().collect();
        let holds_samples = |row: &Vec<Expr>| row.iter().any(|entry| self.plant.arena.depends_on(*entry, &given));
        let regression = self.derivation.regression.result.as_ref();
        self.copies_an_output() && regression.is_some_and(|regression| regression.phi_1.iter().any(holds_samples))
    }

    /// The outputs given by their values.
    fn given(&self) -> impl Iterator<Item = Symbol> {
        self.plant.y.iter().filter(|output| output.value.is_some()).map(|output| output.symbol)
    }

    /// The number of outputs given by value of which each equation has samples among the factors of the unknowns: their
    /// noise does not average out.
    pub(super) fn multiplied(&self) -> usize {
        let Some(regression) = &self.derivation.regression.result else { return 0 };
        let (arena, given): (_, BTreeSet<Symbol>) = (&self.plant.arena, self.given().collect());
        let rows = || regression.phi_0.iter().zip(&regression.phi_1);
        let is_multiplied = |output: &Symbol| {
            let own = BTreeSet::from([*output]);
            let holds = |row: &[Expr], symbols| row.iter().any(|factor| arena.depends_on(*factor, symbols));
            let is_used = rows().any(|(known, row)| arena.depends_on(*known, &own) || holds(row, &own));
            let is_plain = |(known, row): (&Expr, &Vec<Expr>)| arena.depends_on(*known, &own) && !holds(row, &given);
            is_used && !rows().any(is_plain)
        };
        given.iter().filter(|output| is_multiplied(output)).count()
    }

    /// Tests whether a state is recovered with all the noise of an output that determines it: by a component that is
    /// zero by the identities, as a state less the output that measures it, or by that output alone.
    pub(super) fn copies_an_output(&self) -> bool {
        let arena = &self.plant.arena;
        if self.plant.identities.is_empty() {
            return false;
        }
        let domain = self.plant.domain();
        let vanishes = |component: &Expr| is_zero(arena, *component, &domain);
        let z = self.plant.z.iter().copied().collect();
        let inverse = self.derivation.left_inverse.result.as_ref();
        inverse.is_some_and(|inverse| inverse.x.iter().any(|(_, formula)| !arena.depends_on(*formula, &z)))
            || self.plant.transform().iter().any(vanishes)
    }
}

/// The printed length of a transform.
pub(super) fn size(arena: &Arena, phi: &[Expr]) -> usize {
    phi.iter().map(|component| arena.print(*component).len()).sum()
}

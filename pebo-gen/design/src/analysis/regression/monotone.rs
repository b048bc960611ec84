//! The regression that is monotone in theta.
//!
//! In: the pool of a plant's equations. Out: those that are functions of one component of z, and strictly monotone in it
//! wherever it may be, with their slopes at the estimate, if these identify theta. Holds after: along the gradient
//! `theta' = Gamma Phi_1^T (y' - Phi_0)` with a diagonal gain no component's error grows, from whatever estimate the
//! assumptions admit, as `Phi_1` at the estimate and the mean slope between the estimate and z have the sign of the same
//! known factor (arXiv 2205.00099, where a constant matrix takes the place of `Phi_1^T`). Several unknowns in one function
//! are as good as lost to a gradient where its slopes hardly turn, as are a factor and an exponent.

use std::collections::BTreeSet;

use super::equation::Equation;
use super::local::{self, Rates};
use super::pool::Pool;
use super::premises::Premises;
use super::trial::Trial;
use crate::analysis::design::{AtEstimate, UnusedOutput, UnusedReason};
use pebo_cas::domain::cells::Cell;
use pebo_cas::graph::conditions::Regularity;
use pebo_cas::{Domain, Expr, Facts, Node, Rational, Relation, Symbol};

/// The monotone regression, if one is admitted and identifies theta.
pub(super) fn decided(pool: &Pool<'_>) -> Option<Trial> {
    let (premises, plant) = (&pool.premises, pool.premises.plant);
    let inverse = premises.left_inverse?;
    // Under a fundamental matrix the gradient of z is not that of theta; components that depend on one another have no
    // values between two estimates.
    let is_admitted = plant.monotone_regression
        && plant.relation_form.is_none()
        && premises.cascade.lambda.is_none()
        && plant.phi.len() == plant.x.len()
        && inverse.x.len() == plant.x.len();
    let estimates = is_admitted.then(|| Estimates::of(premises)).flatten()?;
    let identified = |rates: Rates| {
        let all = local::equations(pool, rates);
        if all.iter().all(Equation::is_linear) {
            return None;
        }
        let (taken, others): (Vec<Equation>, Vec<Equation>) =
            all.into_iter().partition(|equation| estimates.have_slope(equation));
        let mut trial = Trial::at_estimate(premises, taken, AtEstimate::Monotone).ok().filter(Trial::is_identified)?;
        let used: BTreeSet<usize> = trial.regression.sources.iter().flatten().copied().collect();
        let unused: BTreeSet<usize> = others.into_iter().flat_map(|equation| equation.outputs).collect();
        let left_out = |output: &usize| UnusedOutput { output: *output, reason: UnusedReason::NotMonotone };
        trial.regression.unused = unused.difference(&used).map(left_out).collect();
        Some(trial)
    };
    identified(Rates::OfOthers).or_else(|| identified(Rates::OfAll))
}

/// The values that estimates of z have for given outputs: those of all states that the assumptions admit.
struct Estimates<'a> {
    premises: &'a Premises<'a>,
    /// The assumptions alone: an estimate does not agree with the outputs.
    domain: Domain,
    hidden: BTreeSet<Symbol>,
}

impl<'a> Estimates<'a> {
    /// The estimates, if they are proved to be connected: the states between planes, and phi continuous on them.
    fn of(premises: &'a Premises<'a>) -> Option<Self> {
        let (arena, plant) = (premises.arena(), premises.plant);
        let (domain, hidden) = (premises.domain.without_equations(), plant.hidden());
        let mut signed = Domain { facts: Facts::new(), ..domain.clone() };
        for (fact, relation) in domain.facts.iter().filter(|(_, relation)| *relation != Relation::NonZero) {
            signed.facts.assume(fact, relation);
        }
        let is_plane = |(fact, relation): (Expr, Relation)| {
            if relation == Relation::NonZero {
                return signed.implies(arena, fact, relation);
            }
            let slopes = hidden.iter().map(|state| premises.shortest(arena.derivative(fact, *state)));
            slopes.into_iter().all(|slope| !arena.depends_on(slope, &hidden))
        };
        let about_states = |(fact, _): &(Expr, Relation)| arena.depends_on(*fact, &hidden);
        let are_between_planes = domain.facts.iter().filter(about_states).all(is_plane);
        let estimates = Self { premises, domain, hidden };
        let is_continuous = |phi: Expr| estimates.is_continuous(phi);
        (are_between_planes && plant.transform().into_iter().all(is_continuous)).then_some(estimates)
    }

    fn varies(&self, expr: Expr) -> bool {
        self.premises.arena().depends_on(expr, &self.hidden)
    }

    /// Tests whether a function of the states has a value and is continuous wherever the assumptions hold.
    fn is_continuous(&self, expr: Expr) -> bool {
        let arena = self.premises.arena();
        let conditions = arena.domain_conditions(&[expr], Regularity::Defined);
        let are_granted = conditions.into_iter().all(|condition| self.domain.grants(arena, condition));
        are_granted && self.domain.jumps(arena, expr, |e| self.varies(e)).is_ok_and(|jumps| jumps.is_empty())
    }

    /// Tests whether an equation is a strictly monotone function of one component of z.
    fn have_slope(&self, equation: &Equation) -> bool {
        let (premises, arena) = (self.premises, self.premises.arena());
        let unknown = premises.unknown();
        let slopes = unknown.iter().map(|z| premises.shortest(arena.derivative(equation.rate, *z)));
        let slopes: Vec<Expr> = slopes.filter(|slope| !arena.is_zero(*slope)).collect();
        let rate = premises.at_phi(equation.rate);
        let [slope] = slopes[..] else { return false };
        let is_curved = || self.is_continuous(rate) && self.has_one_sign(rate, slope);
        !arena.depends_on(equation.primitive, &unknown) && (equation.is_linear() || is_curved())
    }

    /// Tests whether the slope of a rate is a known factor, the same everywhere, times an expression that is positive for
    /// all estimates.
    fn has_one_sign(&self, rate: Expr, slope: Expr) -> bool {
        let (arena, slope) = (self.premises.arena(), self.premises.at_phi(slope));
        let Ok(cells) = self.domain.cells(arena, &[rate, slope], |divider| self.varies(divider)) else { return false };
        // Up to its walls: where the slope goes to zero there, the estimate comes to rest on them.
        let closed = |cell: &Cell| {
            let mut domain = self.domain.clone();
            for (divider, side) in &cell.sides {
                domain.facts.assume(side.positive(arena, *divider), Relation::NonNegative);
            }
            domain
        };
        let of_cell = |cell: &Cell| match cell.domain.analytic(arena, &[slope])[..] {
            [there] => self.known_factor(&closed(cell), there),
            _ => None,
        };
        let mut factors = cells.iter().map(of_cell);
        let first = factors.next().flatten();
        first.is_some() && factors.all(|factor| factor == first)
    }

    /// The known factor of a product whose other factors are positive on the domain.
    fn known_factor(&self, domain: &Domain, product: Expr) -> Option<Expr> {
        let arena = self.premises.arena();
        let is_positive = |expr: Expr| domain.grants(arena, (expr, Relation::Positive));
        let opposite = arena.number(Rational::from(-1));
        let sign = |expr: Expr| match (is_positive(expr), is_positive(arena.neg(expr))) {
            (true, _) => Some(arena.one()),
            (_, true) => Some(opposite),
            _ => None,
        };
        if let Some(sign) = sign(product) {
            return Some(sign);
        }
        let Node::Product(parts) = arena.node(product) else { return None };
        let of_part = |(base, exponent): &(Expr, Rational)| {
            if !self.varies(*base) {
                return Some(arena.power(*base, exponent));
            }
            let is_even =
                exponent.is_integer() && Rational::new(1, 2).is_some_and(|half| (exponent * half).is_integer());
            if is_even && domain.implies(arena, *base, Relation::NonZero) {
                return Some(arena.one());
            }
            sign(*base).filter(|sign| *sign != opposite || exponent.is_integer())
        };
        let known = parts.factors.iter().map(of_part).collect::<Option<Vec<Expr>>>()?;
        // Of the number only its sign: on another cell the slope is another multiple.
        let number = if parts.coefficient.is_negative() { opposite } else { arena.one() };
        Some(known.into_iter().fold(number, |product, factor| arena.mul(product, factor)))
    }
}

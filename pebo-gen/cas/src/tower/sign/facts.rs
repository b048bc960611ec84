//! Known signs: the assumed inequalities, and the conditions for the expressions to have values.
//!
//! In: facts. Out: signs of polynomials that are positive combinations of facts plus a non-negative polynomial. Most
//! problems need no sign, so nothing is read before the first query.

use std::collections::BTreeSet;

use crate::Relation;
use crate::graph::expr::{Expr, Node};
use crate::graph::function::Function;
use crate::poly::Poly;

use super::{Sign, Signs};
use crate::tower::Obstacle;

/// The greatest number of facts that are combined to prove a sign.
const MOST_FACTS: usize = 3;

impl Signs<'_, '_> {
    /// Takes in the usable facts: polynomial ones, those about functions that occur in the problem, and those learned
    /// in earlier rounds.
    ///
    /// Most problems need no sign, so this waits for the first query.
    pub(super) fn learn(&self) -> Result<(), Obstacle> {
        if self.memory.round.read.replace(true) {
            return Ok(());
        }
        let occurring: BTreeSet<Expr> = self.field.arena.postorder(&self.field.roots).into_iter().collect();
        for (expr, comparison) in self.field.domain.facts.iter() {
            let foreign = |e: &Expr| match self.field.arena.node(*e) {
                Node::Call(..) => !occurring.contains(e),
                Node::Product(product) => {
                    product.factors.iter().any(|(_, exponent)| !exponent.is_integer()) && !occurring.contains(e)
                }
                _ => false,
            };
            if self.field.arena.postorder(&[expr]).iter().any(foreign) {
                continue;
            }
            self.learn_sign(expr, comparison)?;
        }
        let learned = self.memory.learned.borrow().clone();
        for (expr, comparison) in learned {
            self.learn_sign(expr, comparison)?;
        }
        Ok(())
    }

    /// True if there is any fact to prove a sign with.
    pub(in crate::tower) fn has_facts(&self) -> Result<bool, Obstacle> {
        self.learn()?;
        Ok(!self.memory.round.facts.borrow().is_empty())
    }

    /// Records that a kernel depends on a part whose sign is not known.
    pub(in crate::tower) fn leave_open(&self, part: &Poly) {
        self.memory.round.undecided.borrow_mut().insert(part.clone());
    }

    fn learn_sign(&self, expr: Expr, comparison: Relation) -> Result<(), Obstacle> {
        let fraction = self.field.fraction(expr)?;
        if fraction.den.is_constant() {
            self.memory.round.facts.borrow_mut().push((fraction.num, comparison));
            return Ok(());
        }
        // n/d > 0 has the sign of n*d. But a denominator may have been cleared of roots by a factor that vanishes where
        // the fact holds: then n*d is zero there.
        let cleared = self.field.has_relations(&fraction);
        let comparison = match comparison {
            Relation::Positive | Relation::NonNegative if cleared => Relation::NonNegative,
            Relation::NonZero if cleared => return Ok(()),
            exact => exact,
        };
        let product = fraction.num.mul(&fraction.den, self.field.limit())?;
        self.memory.round.facts.borrow_mut().push((product, comparison));
        Ok(())
    }

    /// Learns a sign that must hold for the expressions to have values. If a kernel was already made with the sign
    /// unknown, the field starts again.
    pub(in crate::tower) fn learn_from_existence(&self, poly: &Poly, comparison: Relation) -> Result<(), Obstacle> {
        let known = self.of_polynomial(poly)?;
        let enough = match comparison {
            Relation::Positive => known == Some(Sign::Positive),
            _ => known.is_some_and(Sign::is_positive_or_zero),
        };
        if enough || known == Some(Sign::Negative) {
            return Ok(());
        }
        let entry = (self.field.show_polynomial(poly), comparison);
        if !self.memory.learned.borrow().contains(&entry) {
            self.memory.learned.borrow_mut().push(entry);
            if !self.memory.round.undecided.borrow().is_empty() {
                self.field.round.finer.set(true);
            }
        }
        self.memory.round.facts.borrow_mut().push((poly.clone(), comparison));
        Ok(())
    }

    /// As a positive combination of facts plus a non-negative polynomial, or the negation of that; also after
    /// `cos^2 = 1 - sin^2`, which turns `c - b^2 cos^2` into `c - b^2 + b^2 sin^2`.
    pub(in crate::tower) fn by_facts(&self, poly: &Poly) -> Result<Option<Sign>, Obstacle> {
        let facts = self.facts_about(poly);
        let mut found = None;
        for form in [Some(poly.clone()), self.field.with_sines(poly)?].into_iter().flatten() {
            if let Some(sign) = self.by_terms(&form) {
                return Ok(Some(sign));
            }
            match self.above_facts(&form, &facts, MOST_FACTS) {
                Some(Sign::Positive) => return Ok(Some(Sign::Positive)),
                // Another form may prove more.
                Some(sign) => found = Some(sign),
                None => {}
            }
            if self.above_facts(&-&form, &facts, MOST_FACTS) == Some(Sign::Positive) {
                return Ok(Some(Sign::Negative));
            }
        }
        Ok(found)
    }

    /// The facts, and that no sine or cosine exceeds one.
    fn facts_about(&self, poly: &Poly) -> Vec<(Poly, Relation)> {
        let mut facts = self.memory.round.facts.borrow().clone();
        for &variable in poly.variables() {
            if let Node::Call(Function::Sin | Function::Cos, _) = self.field.arena.node(self.field.kernel(variable)) {
                let value = Poly::variable(variable);
                facts.push((&Poly::one() - &value, Relation::NonNegative));
                facts.push((&Poly::one() + &value, Relation::NonNegative));
            }
        }
        facts
    }

    /// The sign of `poly = k * fact + rest` for a k > 0 that cancels a term, if the rest is not negative.
    fn above_facts(&self, poly: &Poly, facts: &[(Poly, Relation)], most: usize) -> Option<Sign> {
        let mut found = None;
        for (fact, comparison) in facts {
            // Most facts are irrelevant: their variables exclude them before any term is examined.
            if *comparison == Relation::NonZero || !shares_a_variable(poly, fact) {
                continue;
            }
            let effort = poly.term_count() * fact.term_count();
            if self.field.limit().spend(effort as u64).is_err() {
                continue;
            }
            for (monomial, wanted) in fact.terms() {
                let Some(present) = poly.coefficient(&monomial) else { continue };
                if monomial.is_one() || wanted.is_negative() != present.is_negative() {
                    continue;
                }
                // |wanted| * poly - |present| * fact
                let rest = &poly.scale(&wanted.abs()) - &fact.scale(&present.abs());
                let mut sign = self.by_terms(&rest);
                if sign.is_none() && most > 1 && rest.term_count() <= poly.term_count() {
                    sign = self.above_facts(&rest, facts, most - 1);
                }
                match sign {
                    Some(Sign::Positive) => return Some(Sign::Positive),
                    Some(Sign::NonNegative | Sign::Zero) if *comparison == Relation::Positive => {
                        return Some(Sign::Positive);
                    }
                    Some(Sign::NonNegative | Sign::Zero) => found = Some(Sign::NonNegative),
                    _ => {}
                }
            }
        }
        found
    }
}

/// True if a variable occurs in both: without one they have no term in common but a constant.
fn shares_a_variable(a: &Poly, b: &Poly) -> bool {
    let (few, many) = if a.variables().len() < b.variables().len() { (a, b) } else { (b, a) };
    few.variables().iter().any(|variable| many.variables().binary_search(variable).is_ok())
}

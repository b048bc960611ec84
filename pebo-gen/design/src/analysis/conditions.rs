//! The conditions under which the formulas have values, less those that the assumptions discharge.
//!
//! In: the domain conditions of the plant's formulas and of the derived ones. Out: one list of the open conditions, by
//! factors: the proofs hold wherever these hold. Two kinds cannot be listed and are reported separately: a condition on
//! an extension, which may have any values, and a sign that the plant itself does not need.

use std::collections::BTreeMap;

use crate::plant::Plant;
use pebo_cas::graph::conditions::Regularity;
use pebo_cas::tower::{Field, Obstacle};
use pebo_cas::{Arena, Domain, Expr, Function, Node, Rational, Relation, Symbol};

use super::design::{Cascade, LeftInverse, Regression};

/// A comparison with zero.
pub(super) type DomainCondition = (Expr, Relation);

/// The points of a domain at which the formulas of these claims have values.
pub(super) fn where_valued(
    plant: &Plant,
    domain: &Domain,
    (cascade, left_inverse, regression): (&Cascade, Option<&LeftInverse>, &Regression),
) -> Domain {
    let mut conditions = Conditions { listed: Vec::new(), known: domain.clone() };
    // One that cannot be listed leaves its claim open.
    let _ = conditions.list_cascade(plant, cascade);
    let _ = left_inverse.and_then(|inverse| conditions.list_left_inverse(plant, inverse));
    let _ = conditions.list_regression(plant, regression);
    conditions.known
}

/// The conditions of the proofs besides the assumptions, each once.
pub(super) struct Conditions {
    /// The listed conditions, in the order of their discovery, each with a key that is the same for equal ones.
    listed: Vec<(Expr, DomainCondition)>,
    /// The assumptions, and the signs that are listed.
    known: Domain,
}

impl Conditions {
    /// The domain conditions of the plant's own formulas.
    pub(super) fn of(plant: &Plant) -> Self {
        let mut conditions = Self { listed: Vec::new(), known: plant.assumed() };
        // Signs first: they may show that something does not vanish.
        let (signs, others): (Vec<_>, Vec<_>) = plant
            .conditions
            .iter()
            .map(|c| (c.expr, c.relation))
            .partition(|condition| condition.1 != Relation::NonZero);
        let strict_first = |condition: &&DomainCondition| condition.1 == Relation::Positive;
        signs.iter().filter(strict_first).for_each(|condition| conditions.list(&plant.arena, *condition));
        signs
            .iter()
            .filter(|condition| !strict_first(condition))
            .for_each(|condition| conditions.list(&plant.arena, *condition));
        for condition in others {
            conditions.list(&plant.arena, condition);
        }
        conditions
    }

    /// Lists a condition that the domain does not imply: of an expression that must not vanish, each factor. An
    /// absolute value or a square is never negative; its condition is that it does not vanish.
    pub(super) fn list(&mut self, arena: &Arena, condition: DomainCondition) {
        let only_zero = condition.1 == Relation::Positive && is_absolute_value(arena, condition.0);
        let relation = if only_zero { Relation::NonZero } else { condition.1 };
        let parts = match relation {
            Relation::NonZero => factors(arena, &self.known, condition.0),
            _ => vec![(condition.0, condition.0)],
        };
        for (key, part) in parts {
            let known = self.listed.iter().any(|(other, (_, listed))| *other == key && *listed == relation);
            if !known && !self.known.grants(arena, (part, relation)) {
                self.listed.push((key, (part, relation)));
                self.known.facts.assume(part, relation);
            }
        }
        if only_zero {
            self.known.facts.assume(condition.0, condition.1);
        }
    }

    /// The assumptions with the listed conditions.
    pub(super) fn domain(&self) -> &Domain {
        &self.known
    }

    /// The list: an expression that is nonnegative and nonzero is listed as positive.
    pub(super) fn listed(&self) -> Vec<DomainCondition> {
        let has =
            |key: Expr, wanted: Relation| self.listed.iter().any(|(k, (_, relation))| (*k, *relation) == (key, wanted));
        let merged = |(key, (part, relation)): &(Expr, DomainCondition)| match relation {
            Relation::NonZero if has(*key, Relation::NonNegative) => None,
            Relation::NonNegative if has(*key, Relation::NonZero) => Some((*part, Relation::Positive)),
            _ => Some((*part, *relation)),
        };
        self.listed.iter().filter_map(merged).collect()
    }

    /// Lists the domain conditions of the cascade's formulas.
    pub(super) fn list_cascade(&mut self, plant: &Plant, cascade: &Cascade) -> Option<DomainCondition> {
        let formulas: Vec<Expr> = cascade.h.iter().chain(cascade.lambda.iter().flatten().flatten()).copied().collect();
        self.list_formulas(plant, &formulas, &BTreeMap::new())
    }

    /// Lists the domain conditions of the left inverse at z = phi(x, y); estimates of z may lie elsewhere.
    pub(super) fn list_left_inverse(&mut self, plant: &Plant, inverse: &LeftInverse) -> Option<DomainCondition> {
        let transform = plant.z.iter().copied().zip(plant.transform()).collect();
        let formulas: Vec<Expr> = inverse.x.iter().map(|(_, formula)| *formula).collect();
        self.list_formulas(plant, &formulas, &transform)
    }

    /// Lists the domain conditions of the regression, for all values of the extension, or of a local one where it is
    /// phi(x, y); and of its way back to theta from the functions of theta.
    pub(super) fn list_regression(&mut self, plant: &Plant, regression: &Regression) -> Option<DomainCondition> {
        let regression = &regression.with_extension(plant, &plant.transform());
        let rows = [&regression.phi_1, &regression.primitive_1].into_iter().flatten().flatten();
        let formulas = rows.chain(&regression.phi_0).chain(&regression.primitive_0).chain(&regression.eta).copied();
        let back = regression.eta_symbols.iter().copied().zip(regression.eta.iter().copied()).collect();
        let formulas: Vec<Expr> = formulas.collect();
        self.list_formulas(plant, &formulas, &BTreeMap::new())
            .or_else(|| self.list_formulas(plant, &regression.theta, &back))
    }

    /// Lists the domain conditions of the formulas at these values; returns the first condition that cannot be listed.
    ///
    /// The conditions are read off the formulas as written: at the values they may simplify.
    fn list_formulas(
        &mut self,
        plant: &Plant,
        formulas: &[Expr],
        values: &BTreeMap<Symbol, Expr>,
    ) -> Option<DomainCondition> {
        let arena = &plant.arena;
        for (part, relation) in arena.domain_conditions(formulas, Regularity::Defined) {
            let condition = (arena.substitute(part, values), relation);
            if self.known.grants(arena, condition) {
                continue;
            }
            let free = arena.symbols_of(&[condition.0]).iter().any(|symbol| plant.is_of_extension(*symbol));
            if free || relation != Relation::NonZero {
                return Some(condition);
            }
            self.list(arena, condition);
        }
        None
    }
}

/// The factors of an expression that must not vanish, each with a key that is the same for factors with the same zeros.
fn factors(arena: &Arena, domain: &Domain, expr: Expr) -> Vec<(Expr, Expr)> {
    let written: Vec<Expr> = match arena.node(expr) {
        Node::Product(product) => product.factors.iter().map(|(base, _)| *base).collect(),
        _ => vec![expr],
    };
    let written = written.into_iter().map(|base| inside(arena, base));
    written.flat_map(|base| split(arena, domain, base).unwrap_or_else(|_| vec![(base, base)])).collect()
}

/// Tests whether it is a product of absolute values and even powers.
fn is_absolute_value(arena: &Arena, expr: Expr) -> bool {
    match arena.node(expr) {
        Node::Call(Function::Abs, _) => true,
        Node::Product(product) => {
            let is_even = |exponent: &Rational| exponent.to_i64().is_some_and(|exponent| exponent % 2 == 0);
            product.coefficient.signum() > 0
                && product.factors.iter().all(|(base, exponent)| is_even(exponent) || is_absolute_value(arena, *base))
        }
        _ => false,
    }
}

/// An expression with the same zeros: the argument of an absolute value.
fn inside(arena: &Arena, expr: Expr) -> Expr {
    match arena.node(expr) {
        Node::Call(Function::Abs, arguments) => inside(arena, arguments[0]),
        _ => expr,
    }
}

/// The factors of a sum; itself, as it is written, where it has but one.
fn split(arena: &Arena, domain: &Domain, expr: Expr) -> Result<Vec<(Expr, Expr)>, Obstacle> {
    let field = Field::over(arena, &domain.facts, &[expr])?;
    let fraction = field.fraction(expr)?;
    let mut parts = Vec::new();
    for factor in fraction.numerator().distinct_factors(field.limit())? {
        parts.push(inside(arena, field.show(&field.of_polynomial(&factor)?)));
    }
    Ok(match parts.as_slice() {
        [] => vec![(expr, expr)],
        [only] => vec![(*only, expr)],
        _ => parts.into_iter().map(|part| (part, part)).collect(),
    })
}

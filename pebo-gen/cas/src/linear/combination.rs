//! Combinations with coefficients in a form for readers and for floating point.
//!
//! In: a target and a basis. Out: the coefficients as expressions, in the author's own functions and sums where that is
//! enough.

use std::collections::BTreeSet;

use super::comparison::combine;
use crate::Domain;
use crate::forms::opaque::OpaqueTerms;
use crate::forms::tidy::{shorter, shortest, with_fewer_conditions};
use crate::graph::arena::Arena;
use crate::graph::expr::{Expr, Node, Symbol};
use crate::graph::function::Function;
use crate::tower::{Field, Fraction, Obstacle};

/// As [`combine`], on the domain: coefficients as expressions, with which the combination holds everywhere, else on the
/// manifold of the domain.
pub fn combine_on(
    arena: &Arena,
    domain: &Domain,
    target: Expr,
    basis: &[Expr],
    x: &BTreeSet<Symbol>,
) -> Result<Option<Vec<Expr>>, Obstacle> {
    let roots = [basis, &[target]].concat();
    // In the author's own functions and sums of known terms, if that is enough.
    let mut opaque = OpaqueTerms::new(arena, x);
    let signals = opaque.replace(&roots);
    if !opaque.is_empty()
        && let Some((target, basis)) = signals.split_last()
        && let Ok(field) = Field::over(arena, &domain.facts, &signals)
        && let Ok(Some(coefficients)) = combine(&field, *target, basis, x)
    {
        let shown = CoefficientForms::new(&field, domain, &signals, x);
        return Ok(Some(coefficients.iter().map(|c| shown.form(c, |form| opaque.restore(form))).collect()));
    }
    let combined = |field: Result<Field<'_>, Obstacle>| {
        let field = field?;
        let coefficients = combine(&field, target, basis, x)?;
        let shown = CoefficientForms::new(&field, domain, &roots, x);
        Ok(coefficients.map(|all| all.iter().map(|c| shown.form(c, |form| form)).collect()))
    };
    match combined(Field::over(arena, &domain.facts, &roots)) {
        Ok(None) | Err(_) if !domain.manifold.is_empty() => combined(Field::on(arena, domain, &roots)),
        found => found,
    }
}

/// The greatest number of divisors that are tried.
const MOST_DIVISORS: usize = 8;

/// The context in which coefficients are written.
struct CoefficientForms<'f, 'a> {
    field: &'f Field<'a>,
    domain: &'f Domain,
    /// Sums with roots or absolute values, free of x, that the formulas or equations hold: allowed divisors.
    divisors: Vec<Expr>,
}

impl<'f, 'a> CoefficientForms<'f, 'a> {
    fn new(field: &'f Field<'a>, domain: &'f Domain, formulas: &[Expr], x: &BTreeSet<Symbol>) -> Self {
        let arena = field.arena();
        let is_folded = |part: Expr| match arena.node(part) {
            Node::Call(function, _) => function == Function::Abs,
            Node::Product(product) => product.factors.iter().any(|(_, power)| !power.is_integer()),
            _ => false,
        };
        let is_divisor = |part: &Expr| {
            matches!(arena.node(*part), Node::Sum(_))
                && !arena.depends_on(*part, x)
                && arena.postorder(&[*part]).into_iter().any(is_folded)
        };
        let formulas = [formulas, domain.manifold.equations()].concat();
        let divisors = arena.postorder(&formulas).into_iter().filter(is_divisor).take(MOST_DIVISORS).collect();
        Self { field, domain, divisors }
    }

    /// A coefficient as the shortest of its forms; over sums of the formulas if that has fewer domain conditions: the
    /// normal form has `(1 - abs(q))/(1 - q^2)` for `1/(1 + abs(q))`.
    fn form(&self, coefficient: &Fraction, restore: impl Fn(Expr) -> Expr) -> Expr {
        let arena = self.field.arena();
        let forms = |fraction: &Fraction| [self.field.show(fraction), self.field.show_apart(fraction)].map(&restore);
        let [whole, apart] = forms(coefficient);
        let shown = shortest(arena, self.domain, shorter(arena, whole, apart));
        let Some((rest, divisor)) = self.over_divisors(coefficient).ok().flatten() else { return shown };
        let [whole, apart] = forms(&rest).map(|form| arena.div(form, restore(divisor)));
        with_fewer_conditions(arena, self.domain, shown, &[shortest(arena, self.domain, shorter(arena, whole, apart))])
    }

    /// A coefficient as a quotient by such sums, if some make its denominator shorter.
    fn over_divisors(&self, coefficient: &Fraction) -> Result<Option<(Fraction, Expr)>, Obstacle> {
        let mut rest = coefficient.clone();
        let mut divisors = Vec::new();
        for divisor in &self.divisors {
            let factor = self.field.fraction(*divisor)?;
            while !rest.denominator().is_constant() {
                let next = self.field.mul(&rest, &factor)?;
                if next.denominator().total_degree() >= rest.denominator().total_degree() {
                    break;
                }
                rest = next;
                divisors.push(*divisor);
            }
        }
        Ok((!divisors.is_empty()).then(|| (rest, self.field.arena().product(divisors))))
    }
}

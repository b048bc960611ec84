//! The central problem of all claims: an expression as a combination of given functions of x, with coefficients that
//! are free of x.
//!
//! ```text
//! target, basis, x -> coefficients c with target = sum of c_k * basis_k, each c_k free of x
//! ```
//!
//! Over a common denominator, target and basis are polynomials in the kernels that depend on x, with coefficients in
//! all others. Comparing them monomial by monomial gives a linear system over the field of functions of the other
//! symbols. If the kernels are independent and the system has no solution, there is no combination; a solution is an
//! identity in any case.

use std::collections::{BTreeMap, BTreeSet};

use super::{Echelon, solve};
use crate::Domain;
use crate::forms::opaque::OpaqueTerms;
use crate::forms::tidy::{shorter, shortest, with_fewer_conditions};
use crate::graph::arena::Arena;
use crate::graph::expr::{Expr, Node, Symbol};
use crate::graph::function::Function;
use crate::poly::{Monomial, Poly};
use crate::tower::{Field, Fraction, Obstacle};

/// Solves for the coefficients of `target` over `basis`; none if the comparison has no solution.
pub fn combine(
    field: &Field<'_>,
    target: Expr,
    basis: &[Expr],
    x: &BTreeSet<Symbol>,
) -> Result<Option<Vec<Fraction>>, Obstacle> {
    let hidden: Vec<u32> = field.kernels_of(x).into_iter().collect();
    let mut fractions = basis.iter().map(|b| field.fraction(*b)).collect::<Result<Vec<_>, _>>()?;
    fractions.push(field.fraction(target)?);
    // One row for each monomial in the hidden kernels, the target in the last column.
    let columns = fractions.len();
    let mut rows: BTreeMap<Monomial, Vec<Fraction>> = BTreeMap::new();
    for (column, numerator) in over_common_denominator(field, &fractions)?.iter().enumerate() {
        for (monomial, coefficient) in numerator.collect(&hidden) {
            let row = rows.entry(monomial).or_insert_with(|| vec![Fraction::zero(); columns]);
            row[column] = field.of_polynomial(&coefficient)?;
        }
    }
    solve(field, rows.into_values().collect(), basis.len())
}

/// The combinations, with coefficients free of x, in which the symbols to cancel no longer occur; a basis of them.
///
/// The symbols to cancel are among x. If the kernels are independent there are no others.
pub fn cancelling(
    field: &Field<'_>,
    exprs: &[Expr],
    x: &BTreeSet<Symbol>,
    cancel: &BTreeSet<Symbol>,
) -> Result<Vec<Vec<Fraction>>, Obstacle> {
    let hidden: Vec<u32> = field.kernels_of(x).into_iter().collect();
    let gone = field.kernels_of(cancel);
    let fractions = exprs.iter().map(|e| field.fraction(*e)).collect::<Result<Vec<_>, _>>()?;
    if fractions.iter().any(|fraction| fraction.denominator().variables().iter().any(|v| gone.contains(v))) {
        return Err(Obstacle::Kernel("a denominator that is to cancel".to_owned()));
    }
    let mut rows: BTreeMap<Monomial, Vec<Fraction>> = BTreeMap::new();
    for (column, numerator) in over_common_denominator(field, &fractions)?.iter().enumerate() {
        for (monomial, coefficient) in numerator.collect(&hidden) {
            if monomial.powers().iter().any(|(kernel, _)| gone.contains(kernel)) {
                let row = rows.entry(monomial).or_insert_with(|| vec![Fraction::zero(); exprs.len()]);
                row[column] = field.of_polynomial(&coefficient)?;
            }
        }
    }
    let (echelon, _) = Echelon::of(field, rows.into_values().collect(), exprs.len())?;
    Ok(echelon.null_space())
}

/// The combinations of expressions, with coefficients free of x, that vanish; a basis of them.
///
/// If the kernels are independent there are no others.
pub fn relations(field: &Field<'_>, exprs: &[Expr], x: &BTreeSet<Symbol>) -> Result<Vec<Vec<Fraction>>, Obstacle> {
    let rows = equations(field, &[exprs.to_vec()], x)?;
    let (echelon, _) = Echelon::of(field, rows, exprs.len())?;
    Ok(echelon.null_space())
}

/// The equations for coefficients free of the symbols under which the combination of each row of expressions vanishes,
/// an expression for each coefficient.
///
/// If the kernels are independent it vanishes nowhere else.
pub fn equations(
    field: &Field<'_>,
    rows: &[Vec<Expr>],
    symbols: &BTreeSet<Symbol>,
) -> Result<Vec<Vec<Fraction>>, Obstacle> {
    let moving: Vec<u32> = field.kernels_of(symbols).into_iter().collect();
    let columns = rows.first().map_or(0, Vec::len);
    let mut matrix = Vec::new();
    for row in rows {
        let fractions = row.iter().map(|e| field.fraction(*e)).collect::<Result<Vec<_>, _>>()?;
        let mut equations: BTreeMap<Monomial, Vec<Fraction>> = BTreeMap::new();
        for (column, numerator) in over_common_denominator(field, &fractions)?.iter().enumerate() {
            for (monomial, coefficient) in numerator.collect(&moving) {
                let equation = equations.entry(monomial).or_insert_with(|| vec![Fraction::zero(); columns]);
                equation[column] = field.of_polynomial(&coefficient)?;
            }
        }
        matrix.extend(equations.into_values());
    }
    Ok(matrix)
}

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

/// The numerators of fractions over their least common denominator.
fn over_common_denominator(field: &Field<'_>, fractions: &[Fraction]) -> Result<Vec<Poly>, Obstacle> {
    let work = field.limit();
    let mut common = Poly::one();
    for fraction in fractions {
        common = common.lcm(fraction.denominator(), work)?;
    }
    fractions.iter().map(|fraction| field.over_denominator(fraction, &common)).collect()
}

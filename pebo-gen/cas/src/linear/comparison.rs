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
use crate::graph::expr::{Expr, Symbol};
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

/// The numerators of fractions over their least common denominator.
fn over_common_denominator(field: &Field<'_>, fractions: &[Fraction]) -> Result<Vec<Poly>, Obstacle> {
    let work = field.limit();
    let mut common = Poly::one();
    for fraction in fractions {
        common = common.lcm(fraction.denominator(), work)?;
    }
    fractions.iter().map(|fraction| field.over_denominator(fraction, &common)).collect()
}

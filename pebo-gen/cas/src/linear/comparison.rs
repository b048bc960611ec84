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

use super::echelon::Echelon;
use super::fractions::solve;
use super::matrix::Matrix;
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
    // The target in the last column.
    let row = [basis, &[target]].concat();
    solve(field, equations(field, &[row], x)?, basis.len())
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
    let gone = field.kernels_of(cancel);
    let fractions = exprs.iter().map(|e| field.fraction(*e)).collect::<Result<Vec<_>, _>>()?;
    if fractions.iter().any(|fraction| fraction.denominator().variables().iter().any(|v| gone.contains(v))) {
        return Err(Obstacle::Kernel("a denominator that is to cancel".to_owned()));
    }
    let is_gone = |monomial: &Monomial| monomial.powers().iter().any(|(kernel, _)| gone.contains(kernel));
    let hidden: Vec<u32> = field.kernels_of(x).into_iter().collect();
    let rows = coefficients(field, &fractions, &hidden, is_gone)?;
    let (echelon, _) = Echelon::of(field, Matrix::new(rows), exprs.len())?;
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
) -> Result<Matrix<Fraction>, Obstacle> {
    let moving: Vec<u32> = field.kernels_of(symbols).into_iter().collect();
    let mut matrix = Vec::new();
    for row in field.matrix(rows)?.rows() {
        matrix.extend(coefficients(field, row, &moving, |_| true)?);
    }
    Ok(Matrix::new(matrix))
}

/// The coefficients of fractions over their common denominator: a row for each wanted monomial in the moving kernels.
fn coefficients(
    field: &Field<'_>,
    fractions: &[Fraction],
    moving: &[u32],
    is_wanted: impl Fn(&Monomial) -> bool,
) -> Result<Vec<Vec<Fraction>>, Obstacle> {
    let (numerators, _) = field.over_common_denominator(fractions)?;
    let wanted = |numerator: &Poly| numerator.collect(moving).into_iter().filter(|(m, _)| is_wanted(m)).collect();
    Ok(by_monomials(field, &numerators.iter().map(wanted).collect::<Vec<_>>())?.into_rows())
}

/// A row for each monomial, of the coefficients that it has in collected polynomials, a column for each.
pub fn by_monomials(field: &Field<'_>, columns: &[Vec<(Monomial, Poly)>]) -> Result<Matrix<Fraction>, Obstacle> {
    let mut rows: BTreeMap<&Monomial, Vec<Fraction>> = BTreeMap::new();
    for (column, collected) in columns.iter().enumerate() {
        for (monomial, coefficient) in collected {
            let row = rows.entry(monomial).or_insert_with(|| vec![Fraction::zero(); columns.len()]);
            row[column] = field.of_polynomial(coefficient)?;
        }
    }
    Ok(Matrix::new(rows.into_values().collect()))
}

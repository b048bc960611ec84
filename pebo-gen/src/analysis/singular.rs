//! Where a regressor loses rank, as conditions a reader can check.
//!
//! In: `Phi_1` of full generic column rank. Out: the zero set of det(`Phi_1`' `Phi_1`) by factors, each
//! solved for a signal where it is linear in one (`d = 1`); factors without signals are left out.

use std::collections::BTreeSet;

use crate::cas::domain::Domain;
use crate::cas::field::{Field, Fraction, Obstacle};
use crate::cas::poly::Poly;
use crate::cas::{Arena, Expr, Symbol};
use crate::plant::Plant;
use crate::plant::matrix::determinant;

/// The conditions under which the columns of the regressor become dependent.
pub(super) fn singular_where(plant: &Plant, domain: &Domain, phi_1: &[Vec<Expr>]) -> Vec<String> {
    conditions(plant, domain, phi_1).unwrap_or_default()
}

/// Combinations of the parameters whose vanishing would make the columns dependent, and of which no sign is known:
/// nothing that a signal could mend.
pub(super) fn constant_factors(plant: &Plant, domain: &Domain, phi_1: &[Vec<Expr>]) -> Vec<Expr> {
    let arena = &plant.arena;
    let constants: BTreeSet<Symbol> = plant.parameters.iter().map(|p| p.symbol).collect();
    let found = || -> Result<Vec<Expr>, Obstacle> {
        let field = Field::over(arena, &domain.facts, &phi_1.concat())?;
        let mut found = Vec::new();
        for factor in factors(&field, volume(&field, phi_1)?.numerator())? {
            let value = field.of_polynomial(&factor)?;
            let expr = field.show(&value);
            let signed = field.is_positive(&value)? || field.is_positive(&value.opposite())?;
            if arena.symbols_of(&[expr]).is_subset(&constants) && !signed {
                found.push(expr);
            }
        }
        Ok(found)
    };
    found().unwrap_or_default()
}

/// The determinant of a square matrix, of any other that of `Phi' Phi`.
fn volume(field: &Field<'_>, phi_1: &[Vec<Expr>]) -> Result<Fraction, Obstacle> {
    let matrix = phi_1
        .iter()
        .map(|row| row.iter().map(|e| field.fraction(*e)).collect::<Result<Vec<_>, _>>())
        .collect::<Result<Vec<_>, _>>()?;
    let columns = matrix.first().map_or(0, Vec::len);
    let square = if matrix.len() == columns { matrix } else { gram(field, &matrix, columns)? };
    determinant(field, square)
}

fn conditions(plant: &Plant, domain: &Domain, phi_1: &[Vec<Expr>]) -> Result<Vec<String>, Obstacle> {
    let arena = &plant.arena;
    let field = Field::over(arena, &domain.facts, &phi_1.concat())?;
    let determinant = volume(&field, phi_1)?;
    let constants: BTreeSet<Symbol> = plant.parameters.iter().map(|p| p.symbol).collect();
    let mut found = Vec::new();
    for factor in factors(&field, determinant.numerator())? {
        let expr = field.show(&field.of_polynomial(&factor)?);
        if arena.symbols_of(&[expr]).is_subset(&constants) || field.never_zero(&factor) {
            continue;
        }
        found.push(condition(arena, &field, &factor, expr, &constants)?);
    }
    Ok(found)
}

/// The factors that are cheap to find: kernels, and square-free parts of the rest.
fn factors(field: &Field<'_>, poly: &Poly) -> Result<Vec<Poly>, Obstacle> {
    let mut found = Vec::new();
    for (factor, _) in poly.square_free(field.limit())?.factors {
        let mut rest = factor.clone();
        for &(variable, _) in factor.monomial_content().powers() {
            let kernel = Poly::variable(variable);
            if let Some(quotient) = rest.div_exact(&kernel, field.limit())? {
                rest = quotient;
                found.push(kernel);
            }
        }
        if !rest.is_constant() {
            found.push(rest);
        }
    }
    Ok(found)
}

/// `signal = value` where the factor is linear in one signal and nothing else varies, else `factor = 0`.
fn condition(
    arena: &Arena,
    field: &Field<'_>,
    factor: &Poly,
    expr: Expr,
    constants: &BTreeSet<Symbol>,
) -> Result<String, Obstacle> {
    let moving: Vec<u32> = factor
        .variables()
        .iter()
        .copied()
        .filter(|v| !arena.symbols_of(&[field.kernel(*v)]).is_subset(constants))
        .collect();
    if let [variable] = moving.as_slice()
        && factor.degree(*variable) == 1
    {
        let mut slope = Poly::zero();
        let mut rest = Poly::zero();
        for (power, coefficient) in factor.coefficients_in(*variable) {
            if power == 1 { slope = coefficient } else { rest = coefficient }
        }
        let value = field.quotient(&-&rest, &slope)?;
        return Ok(format!("{} = {}", arena.print(field.kernel(*variable)), arena.print(field.show(&value))));
    }
    Ok(format!("{} = 0", arena.print(expr)))
}

/// `Phi' Phi`
pub(super) fn gram(
    field: &Field<'_>,
    matrix: &[Vec<Fraction>],
    columns: usize,
) -> Result<Vec<Vec<Fraction>>, Obstacle> {
    let mut gram = vec![vec![Fraction::zero(); columns]; columns];
    for (i, line) in gram.iter_mut().enumerate() {
        for (j, entry) in line.iter_mut().enumerate() {
            for row in matrix {
                *entry = field.add(entry, &field.mul(&row[i], &row[j])?)?;
            }
        }
    }
    Ok(gram)
}

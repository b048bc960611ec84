//! The observable part of a transform.
//!
//! In: functions of x and y whose rates are affine in themselves, and in which the rates of the outputs are affine.
//! Out: the combinations of them with constant coefficients that occur in the outputs' rates as factors of different
//! functions of y and u, with those that occur in their rates, and so on: the others are unobservable. `b*S - g` of
//! b*S, b and g, where an output's rate is `(b*S - g)*I - b*I^2`, with b.

use pebo_cas::Expr;
use pebo_cas::linear::comparison::{combine, equations};
use pebo_cas::linear::{Echelon, Matrix};
use pebo_cas::tower::{Field, Fraction, Obstacle};

use crate::search::problem::Problem;

/// The observable functions, in terms of the given ones; the given ones themselves where all are, or the rates are not
/// affine in them.
pub(in crate::search) fn observable(problem: &Problem<'_>, functions: &[Expr]) -> Result<Vec<Expr>, Obstacle> {
    let arena = problem.arena;
    let rates = functions.iter().map(|function| problem.rate(*function));
    let targets: Vec<Expr> = problem.output_rates().into_iter().chain(rates).collect();
    let Some(rows) = rows(problem, &targets, functions)? else { return Ok(functions.to_vec()) };
    let (outputs, flow) = rows.split_at(rows.len() - functions.len());
    let field = Field::over(arena, &problem.domain.facts, &rows.concat())?;
    let (flow, columns) = (Matrix::new(flow.to_vec()).transpose(), functions.len());
    let spanned = |known: Vec<Vec<Fraction>>, rows: &[Vec<Expr>]| -> Result<Echelon, Obstacle> {
        // Factors of different functions of the signals, which are constants.
        let vectors = [known, equations(&field, rows, &problem.signals)?.into_rows()].concat();
        Ok(Echelon::of(&field, Matrix::new(vectors), columns)?.0)
    };
    let mut span = spanned(Vec::new(), outputs)?;
    loop {
        // The rate of a combination, as a combination.
        let along = |(_, vector): (usize, &[Fraction])| flow.apply(arena, &field.show_all(vector));
        let rates: Vec<Vec<Expr>> = span.rows().map(along).collect();
        let known = span.rows().map(|(_, vector)| vector.to_vec()).collect();
        let next = spanned(known, &rates)?;
        if next.rank() == span.rank() {
            break;
        }
        span = next;
    }
    if span.rank() == 0 || span.rank() == columns {
        return Ok(functions.to_vec());
    }
    let combined = |(_, vector): (usize, &[Fraction])| arena.dot(&field.show_all(vector), functions);
    Ok(span.rows().map(combined).collect())
}

/// The coefficients of the functions in each target, functions of y and u; none where a target is not affine in them.
fn rows(problem: &Problem<'_>, targets: &[Expr], functions: &[Expr]) -> Result<Option<Vec<Vec<Expr>>>, Obstacle> {
    let arena = problem.arena;
    let basis = [&[arena.one()], functions].concat();
    let field = Field::over(arena, &problem.domain.facts, &[basis.as_slice(), targets].concat())?;
    let mut rows = Vec::new();
    for target in targets {
        let Some(row) = combine(&field, *target, &basis, &problem.hidden)? else { return Ok(None) };
        rows.push(field.show_all(&row[1..]));
    }
    Ok(Some(rows))
}

//! Combinations of outputs whose rates or values lose what no regression can use: unmeasured signals, or terms that are
//! not affine in phi.

use std::collections::BTreeSet;

use super::premises::Premises;
use pebo_cas::linear::comparison::{cancelling, relations};
use pebo_cas::linear::pivots::pivots;
use pebo_cas::number::interval::{Interval, Precision};
use pebo_cas::tower::{Field, Fraction, Obstacle};
use pebo_cas::{Expr, Symbol};

/// Points at which a rank is looked for.
const MOST_POINTS: usize = 8;

/// A combination of outputs with constant coefficients.
pub(super) struct Combination {
    /// The combination.
    pub(super) output: Expr,
    /// Its rate, or its value.
    pub(super) formula: Expr,
    /// Positions of the outputs in it.
    pub(super) outputs: Vec<usize>,
}

/// Combinations in whose rates no unmeasured signal occurs, as many as were found.
pub(super) fn unmoved(premises: &Premises<'_>, outputs: &[usize]) -> Vec<Combination> {
    let unmeasured: BTreeSet<Symbol> = premises.plant.w.iter().copied().collect();
    let rates = rates(premises, outputs);
    let found = || {
        let field = Field::over(premises.arena(), &premises.domain.facts, &rates)?;
        let vectors = cancelling(&field, &rates, &premises.plant.hidden(), &unmeasured)?;
        combined(premises, &field, (outputs, &rates), &vectors)
    };
    let mut found: Vec<Combination> = found().unwrap_or_default().into_iter().flatten().collect();
    found.retain(|combination| !premises.is_moved(combination.formula));
    found
}

/// Combinations of rates that are affine in phi, as many as were found; and whether there are others, with coefficients
/// that move.
pub(super) fn affine(premises: &Premises<'_>, outputs: &[usize]) -> Result<(Vec<Combination>, bool), Obstacle> {
    let found = all_affine(premises, outputs, &rates(premises, outputs))?;
    let moving = found.iter().any(Option::is_none);
    Ok((found.into_iter().flatten().collect(), moving))
}

/// Combinations of outputs given by their values, of which the values are affine in phi, as many as were found. The last
/// output of each is in no other.
pub(super) fn of_values(premises: &Premises<'_>, outputs: &[usize]) -> Result<Vec<Combination>, Obstacle> {
    let value = |output: &usize| Some((*output, premises.plant.y[*output].value?.expr));
    let (outputs, values): (Vec<usize>, Vec<Expr>) = outputs.iter().filter_map(value).unzip();
    Ok(all_affine(premises, &outputs, &values)?.into_iter().flatten().collect())
}

/// Combinations of outputs of which these formulas are affine in phi; none for one with coefficients that move.
fn all_affine(
    premises: &Premises<'_>,
    outputs: &[usize],
    formulas: &[Expr],
) -> Result<Vec<Option<Combination>>, Obstacle> {
    // The formulas come last, so that each relation has one of its own, and of the others only their terms that are not
    // affine.
    let basis = [&[premises.arena().one()], premises.plant.transform().as_slice(), formulas].concat();
    let field = Field::over(premises.arena(), &premises.domain.facts, &basis)?;
    let vectors = relations(&field, &basis, &premises.plant.hidden())?.into_iter();
    let mut of_formulas: Vec<Vec<Fraction>> =
        vectors.map(|mut vector| vector.split_off(basis.len() - formulas.len())).collect();
    of_formulas.retain(|vector| vector.iter().any(|entry| !entry.is_zero()));
    combined(premises, &field, (outputs, formulas), &of_formulas)
}

/// The combinations with these coefficients, scaled by the first one; none for coefficients that move: these would bring
/// in their own rates.
fn combined(
    premises: &Premises<'_>,
    field: &Field<'_>,
    (outputs, formulas): (&[usize], &[Expr]),
    vectors: &[Vec<Fraction>],
) -> Result<Vec<Option<Combination>>, Obstacle> {
    let (arena, constants) = (premises.arena(), premises.constants());
    let symbols: Vec<Expr> = outputs.iter().map(|output| premises.output(*output)).collect();
    let mut found = Vec::new();
    for vector in vectors {
        let Some(pivot) = vector.iter().find(|entry| !entry.is_zero()) else { continue };
        let scaled = vector.iter().map(|entry| field.div(entry, pivot)).collect::<Result<Vec<_>, _>>()?;
        let scaled: Vec<Expr> = scaled.iter().map(|entry| field.show(entry)).collect();
        let is_constant = arena.symbols_of(&scaled).is_subset(&constants);
        let (whole, of_output) = (arena.dot(&scaled, formulas), outputs.iter().copied().zip(&scaled));
        let formula = premises.shortest(whole);
        found.push((is_constant && premises.are_equal(whole, formula)).then(|| Combination {
            output: arena.dot(&scaled, &symbols),
            formula,
            outputs: of_output.filter(|(_, factor)| !arena.is_zero(**factor)).map(|(output, _)| output).collect(),
        }));
    }
    Ok(found)
}

/// Tests whether at a point of the domain the unmeasured signals move these rates freely, up to so many combinations:
/// whatever the states are, values of these signals explain the rates, so that they do not determine the states.
pub(super) fn moved_freely(premises: &Premises<'_>, outputs: &[usize], but: usize) -> bool {
    const PRECISION: Precision = Precision::new(128);
    let arena = premises.arena();
    let rates = rates(premises, outputs);
    let of_signal = |w: &Symbol| rates.iter().map(|rate| arena.derivative(*rate, *w)).collect::<Vec<Expr>>();
    let slopes: Vec<Expr> = premises.plant.w.iter().flat_map(of_signal).collect();
    let columns = rates.len();
    let free = |values: Vec<Interval>| {
        let rows = values.chunks(columns).map(<[Interval]>::to_vec).collect();
        pivots(rows, columns, PRECISION, arena.budget()).is_some_and(|chosen| chosen.len() + but >= columns)
    };
    columns == 0
        || premises
            .domain
            .points(arena, &[slopes.as_slice(), &rates].concat())
            .take(MOST_POINTS)
            .any(|point| arena.enclose_all(&slopes, &point, PRECISION).is_some_and(free))
}

fn rates(premises: &Premises<'_>, outputs: &[usize]) -> Vec<Expr> {
    outputs.iter().filter_map(|index| premises.plant.y[*index].rate.map(|rate| rate.expr)).collect()
}

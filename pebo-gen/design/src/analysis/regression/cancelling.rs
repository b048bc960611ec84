//! Combinations of outputs from whose rates the unmeasured signals cancel.

use std::collections::BTreeSet;

use crate::plant::Plant;
use crate::plant::matrix::dot;
use pebo_cas::domain::zero::decide;
use pebo_cas::forms::tidy::shortest;
use pebo_cas::linear::comparison::{cancelling, relations};
use pebo_cas::linear::pivots::pivots;
use pebo_cas::number::interval::{Interval, Precision};
use pebo_cas::tower::{Field, Obstacle};
use pebo_cas::{Domain, Expr, Symbol};

/// Points at which a rank is looked for.
const MOST_POINTS: usize = 8;

/// A combination of outputs with a rate that is free of unmeasured signals.
pub(super) struct Combination {
    /// The combination.
    pub(super) output: Expr,
    /// Its rate.
    pub(super) rate: Expr,
    /// Positions of the outputs in it.
    pub(super) outputs: Vec<usize>,
}

/// The outputs with a rate, but for some.
pub(super) fn outputs_but(plant: &Plant, used: &[usize]) -> Vec<usize> {
    (0..plant.y.len()).filter(|index| plant.y[*index].rate.is_some() && !used.contains(index)).collect()
}

/// Combinations with constant coefficients in whose rates no unmeasured signal occurs, as many as were found.
///
/// A coefficient that moves would bring in its own rate; such combinations are left out.
pub(super) fn combinations(plant: &Plant, domain: &Domain, outputs: &[usize]) -> Vec<Combination> {
    found(plant, domain, outputs).unwrap_or_default()
}

fn found(plant: &Plant, domain: &Domain, outputs: &[usize]) -> Result<Vec<Combination>, Obstacle> {
    let arena = &plant.arena;
    let unmeasured: BTreeSet<Symbol> = plant.w.iter().copied().collect();
    let constants: BTreeSet<Symbol> = plant.parameters.iter().map(|p| p.symbol).collect();
    let rates = rates(plant, outputs);
    let part_of = |factors: &[Expr]| -> Vec<usize> {
        outputs.iter().zip(factors).filter(|(_, factor)| !arena.is_zero(**factor)).map(|(output, _)| *output).collect()
    };
    let symbols: Vec<Expr> = outputs.iter().map(|index| arena.of_symbol(plant.y[*index].symbol)).collect();
    let field = Field::over(arena, &domain.facts, &rates)?;
    let mut found = Vec::new();
    for vector in cancelling(&field, &rates, &plant.hidden(), &unmeasured)? {
        for pivot in vector.iter().filter(|entry| !entry.is_zero()) {
            let scaled = vector.iter().map(|entry| field.div(entry, pivot)).collect::<Result<Vec<_>, _>>()?;
            let scaled: Vec<Expr> = scaled.iter().map(|entry| field.show(entry)).collect();
            if !arena.symbols_of(&scaled).is_subset(&constants) {
                continue;
            }
            let whole = dot(arena, &scaled, &rates);
            let rate = shortest(arena, domain, whole);
            if !arena.depends_on(rate, &unmeasured) && decide(arena, arena.sub(whole, rate), domain).is_zero() {
                found.push(Combination { output: dot(arena, &scaled, &symbols), rate, outputs: part_of(&scaled) });
                break;
            }
        }
    }
    Ok(found)
}

/// Combinations with constant coefficients of rates that are not affine in phi which are affine, as many as were found;
/// and whether there are others, with coefficients that move.
pub(super) fn affine_combinations(
    plant: &Plant,
    domain: &Domain,
    outputs: &[usize],
) -> Result<(Vec<Combination>, bool), Obstacle> {
    let arena = &plant.arena;
    let constants: BTreeSet<Symbol> = plant.parameters.iter().map(|p| p.symbol).collect();
    let rates = rates(plant, outputs);
    let part_of = |factors: &[Expr]| -> Vec<usize> {
        outputs.iter().zip(factors).filter(|(_, factor)| !arena.is_zero(**factor)).map(|(output, _)| *output).collect()
    };
    let symbols: Vec<Expr> = outputs.iter().map(|index| arena.of_symbol(plant.y[*index].symbol)).collect();
    // The rates come last, so that each relation has one rate of its own, and of the others only their terms that are
    // not affine.
    let basis = [&[arena.one()], plant.transform().as_slice(), &rates].concat();
    let field = Field::over(arena, &domain.facts, &basis)?;
    let (mut found, mut moving) = (Vec::new(), false);
    for vector in relations(&field, &basis, &plant.hidden())? {
        let of_rates = &vector[basis.len() - rates.len()..];
        let Some(pivot) = of_rates.iter().rfind(|entry| !entry.is_zero()) else { continue };
        let scaled = of_rates.iter().map(|entry| field.div(entry, pivot)).collect::<Result<Vec<_>, _>>()?;
        let scaled: Vec<Expr> = scaled.iter().map(|entry| field.show(entry)).collect();
        if !arena.symbols_of(&scaled).is_subset(&constants) {
            moving = true;
            continue;
        }
        let rate = shortest(arena, domain, dot(arena, &scaled, &rates));
        found.push(Combination { output: dot(arena, &scaled, &symbols), rate, outputs: part_of(&scaled) });
    }
    Ok((found, moving))
}

/// Tests whether at a point of the domain the unmeasured signals move these rates freely, up to so many combinations:
/// whatever the states are, values of these signals explain the rates, so that they do not determine the states.
pub(super) fn moved_freely(plant: &Plant, domain: &Domain, outputs: &[usize], but: usize) -> bool {
    const PRECISION: Precision = Precision::new(128);
    let arena = &plant.arena;
    let rates = rates(plant, outputs);
    let slopes: Vec<Expr> = plant.w.iter().flat_map(|w| rates.iter().map(|rate| arena.derivative(*rate, *w))).collect();
    let columns = rates.len();
    let free = |values: Vec<Interval>| {
        let rows = values.chunks(columns).map(<[Interval]>::to_vec).collect();
        pivots(rows, columns, PRECISION, arena.budget()).is_some_and(|chosen| chosen.len() + but >= columns)
    };
    columns == 0
        || domain
            .points(arena, &[slopes.as_slice(), &rates].concat())
            .take(MOST_POINTS)
            .any(|point| arena.enclose_all(&slopes, &point, PRECISION).is_some_and(free))
}

fn rates(plant: &Plant, outputs: &[usize]) -> Vec<Expr> {
    outputs.iter().filter_map(|index| plant.y[*index].rate.map(|rate| rate.expr)).collect()
}

//! Combines the observations on two cells of a domain along one trajectory.
//!
//! In: cells, none of which identifies all unknowns, with the rows of each. Out: true if every cell has others into
//! which trajectories pass and with which it identifies them all: a neighbour, or all cells along a signal that is an
//! input or that an input drives. With `p + s*sign(q)` a trajectory on which q changes its sign identifies p and s; if
//! q' = q*v there is none. Trajectories pass from one cell into another where the expression of the wall between them
//! vanishes and moves the same way on both sides. The rows of both cells are taken at one such point, so that constants
//! of the trajectory are the same in both. A wall of inputs alone is passed at once: then all but the inputs is the same.

use std::collections::BTreeSet;

use crate::analysis::design::Cascade;
use crate::plant::Plant;
use pebo_cas::domain::cells::{Cell, Side, wall_between};
use pebo_cas::domain::manifold::Manifold;
use pebo_cas::domain::zero::{MOST_POINTS, is_zero};
use pebo_cas::graph::enclosure::Point;
use pebo_cas::linear::rank::{full_rank, full_rank_at, null_vectors};
use pebo_cas::tower::{Field, Obstacle};
use pebo_cas::{Arena, Domain, Expr, Relation, Symbol};

use super::flow::Flow;

/// A cell and its rows.
pub(super) struct CellRows<'a> {
    pub(super) cell: &'a Cell,
    pub(super) rows: Vec<Vec<Expr>>,
    /// The directions that they do not observe.
    pub(super) hidden: Vec<Vec<Expr>>,
}

impl CellRows<'_> {
    /// Tests whether the cell identifies all unknowns by itself.
    pub(super) fn is_identified(&self) -> bool {
        self.hidden.is_empty()
    }
}

/// Tests whether every cell identifies all unknowns with another into which trajectories pass.
pub(super) fn all_identified(
    plant: &Plant,
    cascade: &Cascade,
    varies: impl Fn(Expr) -> bool,
    cells: &[&CellRows<'_>],
    unknowns: usize,
) -> Result<bool, Obstacle> {
    let mut identified = along_signals(plant, &varies, cells, unknowns)?;
    for first in 0..cells.len() {
        for second in first + 1..cells.len() {
            let pair = [cells[first], cells[second]];
            let is_open = !identified[first] || !identified[second];
            if is_open && passes(plant, cascade, &varies, pair, unknowns)? {
                identified[first] = true;
                identified[second] = true;
            }
        }
    }
    Ok(identified.into_iter().all(|identified| identified))
}

/// Tests for each cell whether it identifies all unknowns with the others along a signal that takes all values: an
/// input, or an output or state whose rate an input sets. The directions that they hide are constants, so that rows of
/// several instants compare.
fn along_signals(
    plant: &Plant,
    varies: &impl Fn(Expr) -> bool,
    cells: &[&CellRows<'_>],
    unknowns: usize,
) -> Result<Vec<bool>, Obstacle> {
    let arena = &plant.arena;
    let mut identified = vec![false; cells.len()];
    let signals: BTreeSet<Symbol> =
        cells.iter().flat_map(|cell| &cell.cell.sides).filter_map(|(divider, _)| driven(plant, *divider)).collect();
    for signal in signals {
        let others = |cell: &CellRows<'_>| -> BTreeSet<(Expr, Side)> {
            let sides = cell.cell.sides.iter().filter(|(divider, _)| driven(plant, *divider) != Some(signal));
            sides.copied().collect()
        };
        for (index, cell) in cells.iter().enumerate() {
            let line: Vec<&CellRows<'_>> =
                cells.iter().copied().filter(|other| others(other) == others(cell)).collect();
            let hidden = line.iter().flat_map(|cell| cell.hidden.concat());
            if line.len() < 2 || hidden.into_iter().any(varies) || !is_connected(plant, signal, &line) {
                continue;
            }
            let mut observed = Vec::new();
            for cell in &line {
                observed.extend(null_vectors(arena, &cell.cell.domain, &cell.hidden, unknowns)?);
            }
            identified[index] |= full_rank(arena, &plant.assumed(), &observed, unknowns);
        }
    }
    Ok(identified)
}

/// Tests whether trajectories reach each of the cells along a signal from each other one: an input takes its values at
/// once; any other signal passes a wall where the domain has points on it.
fn is_connected(plant: &Plant, signal: Symbol, line: &[&CellRows<'_>]) -> bool {
    if plant.u.contains(&signal) {
        return true;
    }
    let meets = |pair: [&CellRows<'_>; 2]| {
        wall(pair).is_some_and(|wall| on_wall(plant, pair, wall).points(&plant.arena, &[wall]).next().is_some())
    };
    let mut reached = vec![false; line.len()];
    let mut open = vec![0];
    while let Some(index) = open.pop() {
        if !std::mem::replace(&mut reached[index], true) {
            open.extend((0..line.len()).filter(|&other| !reached[other] && meets([line[index], line[other]])));
        }
    }
    reached.into_iter().all(|reached| reached)
}

/// The only signal of a wall, which is affine in it, if it is an input, or one whose rate an input sets.
pub(super) fn driven(plant: &Plant, wall: Expr) -> Option<Symbol> {
    let arena = &plant.arena;
    let is_constant = |symbol: &Symbol| plant.parameters.iter().any(|parameter| parameter.symbol == *symbol);
    let [signal] = arena.symbols_of(&[wall]).into_iter().filter(|s| !is_constant(s)).collect::<Vec<_>>()[..] else {
        return None;
    };
    let is_affine = arena.symbols_of(&[arena.derivative(wall, signal)]).iter().all(is_constant);
    let rate = plant.rates().get(&signal).copied();
    let facts: Vec<Expr> = plant.assumed().facts.iter().map(|(fact, _)| fact).collect();
    let identities = plant.identities.iter().map(|identity| identity.expr);
    let bounded = arena.symbols_of(&facts.into_iter().chain(identities).collect::<Vec<_>>());
    // A bounded input may not be strong enough.
    let sets = |input: &Symbol| {
        !bounded.contains(input)
            && rate
                .is_some_and(|rate| plant.assumed().implies(arena, arena.derivative(rate, *input), Relation::NonZero))
    };
    (is_affine && (plant.u.contains(&signal) || plant.u.iter().any(sets))).then_some(signal)
}

/// The wall between two cells.
fn wall(pair: [&CellRows<'_>; 2]) -> Option<Expr> {
    wall_between(&pair[0].cell.sides, &pair[1].cell.sides)
}

/// Tests whether trajectories pass from one of the cells into the other at a point at which their combined rows have
/// full rank.
fn passes(
    plant: &Plant,
    cascade: &Cascade,
    varies: &impl Fn(Expr) -> bool,
    pair: [&CellRows<'_>; 2],
    unknowns: usize,
) -> Result<bool, Obstacle> {
    let arena = &plant.arena;
    let Some(wall) = wall(pair) else { return Ok(false) };
    let inputs: BTreeSet<Symbol> = plant.commanded().collect();
    let parameters: BTreeSet<Symbol> = plant.parameters.iter().map(|parameter| parameter.symbol).collect();
    if arena.symbols_of(&[wall]).difference(&parameters).all(|symbol| inputs.contains(symbol)) {
        return Ok(jumps(arena, &inputs, pair, unknowns));
    }
    let mut rates = Vec::new();
    let mut rows = Vec::new();
    for cell in pair {
        let domain = &cell.cell.domain;
        let rate = Flow::new(plant, domain, cascade)?.rate(arena, wall);
        let entries: Vec<Expr> = cell.rows.iter().flatten().copied().chain([rate]).collect();
        let mut sides = as_on(arena, domain, &entries)?;
        if arena.dividers(&sides).into_iter().any(varies) {
            // Not one formula up to the wall.
            return Ok(false);
        }
        rates.extend(sides.pop());
        rows.extend(sides);
    }
    let there = on_wall(plant, pair, wall);
    let product = arena.product(rates);
    let all: Vec<Expr> = rows.iter().copied().chain([product, wall]).collect();
    let found = there.points(arena, &all).take(MOST_POINTS).any(|point| {
        let same_way = arena.separated_from_zero(product, &point).is_some_and(|product| product.is_positive());
        same_way && full_rank_at(arena, &rows, unknowns, &point)
    });
    Ok(found)
}

/// Tests whether the combined rows of two cells have full rank at points that differ in the inputs alone.
fn jumps(arena: &Arena, inputs: &BTreeSet<Symbol>, pair: [&CellRows<'_>; 2], unknowns: usize) -> bool {
    let [here, there] = pair.map(|cell| cell.rows.concat());
    let both = [here.as_slice(), &there].concat();
    // The derivatives of inputs are other symbols, and are the same: that is enough.
    pair[0].cell.domain.points(arena, &both).take(MOST_POINTS).any(|point| {
        let domain = pair[1].cell.domain.beside(&point, inputs);
        domain.points(arena, &both).next().is_some_and(|other| {
            let values = [arena.substitute_all(&here, &point), arena.substitute_all(&there, &other)].concat();
            full_rank_at(arena, &values, unknowns, &Point::new())
        })
    })
}

/// Formulas as they are on a cell, which have values at its walls too.
pub(super) fn as_on(arena: &Arena, domain: &Domain, exprs: &[Expr]) -> Result<Vec<Expr>, Obstacle> {
    let field = Field::on(arena, &domain.without_radicand_facts(arena, exprs), exprs)?;
    exprs.iter().map(|expr| Ok(field.show(&field.fraction(*expr)?))).collect()
}

/// The points of a wall, with the other assumptions of both cells.
fn on_wall(plant: &Plant, pair: [&CellRows<'_>; 2], wall: Expr) -> Domain {
    let arena = &plant.arena;
    let assumed = plant.assumed();
    let equations: Vec<Expr> = assumed.manifold.equations().iter().copied().chain([wall]).collect();
    let symbols: BTreeSet<Symbol> = arena.symbols_of(&equations);
    let parameters: BTreeSet<Symbol> = plant.parameters.iter().map(|parameter| parameter.symbol).collect();
    let signals = symbols.difference(&parameters).copied().collect();
    let manifold = Manifold::new(arena, &assumed.facts, equations, vec![signals, parameters]);
    let met = Domain { manifold: manifold.clone(), ..assumed.clone() };
    let mut facts = assumed.facts.clone();
    let [own, other] = pair.map(|cell| cell.cell.domain.facts.iter());
    for (fact, relation) in own.chain(other) {
        let is_known = facts.iter().any(|known| known == (fact, relation));
        // The wall is excluded as a wall alone, unless the author excludes it too.
        if !is_known && !is_zero(arena, fact, &met) {
            facts.assume(fact, relation);
        }
    }
    Domain { facts, manifold, ..pair[0].cell.domain.clone() }
}

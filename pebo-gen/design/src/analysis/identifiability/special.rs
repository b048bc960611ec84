//! Finds values of the parameters at which the cells of a domain do not identify the unknowns.
//!
//! In: the cells of a domain, with the rows of those that do not identify all unknowns by themselves. Out: combinations
//! of the parameters that must not be zero, and whether others were excluded. A cell has no points where two of its
//! walls coincide, as `w < a < s` at `w = s`, or where one is not there, as `w*a > 1` at `w = 0`: what it identifies
//! must follow from the others then. Where cells identify the unknowns only combined, their rows must not be dependent
//! for all signals.

use std::collections::BTreeSet;

use crate::plant::Plant;
use pebo_cas::domain::cells::walls;
use pebo_cas::domain::manifold::Manifold;
use pebo_cas::linear::Matrix;
use pebo_cas::linear::comparison::by_monomials;
use pebo_cas::linear::determinant::largest_minors;
use pebo_cas::linear::rank::full_rank;
use pebo_cas::poly::{Monomial, Poly};
use pebo_cas::tower::{Field, Fraction, Obstacle};
use pebo_cas::{Arena, Domain, Expr, Relation, Symbol};

use super::crossing::{CellRows, as_on};
use super::flow::varies;

/// Conditions on the parameters.
pub(super) struct SpecialValues {
    /// Combinations that must not be zero.
    pub(super) nonzero: Vec<Expr>,
    /// True if no other values are special.
    pub(super) complete: bool,
}

impl SpecialValues {
    /// None are known.
    pub(super) fn none(complete: bool) -> Self {
        Self { nonzero: Vec::new(), complete }
    }

    fn add(&mut self, combination: Expr) {
        if !self.nonzero.contains(&combination) {
            self.nonzero.push(combination);
        }
    }
}

/// The values of the parameters at which the cells do not identify all unknowns although they do at others.
pub(super) fn of_cells(plant: &Plant, domain: &Domain, cells: &[CellRows<'_>], unknowns: usize) -> SpecialValues {
    let found = || -> Result<SpecialValues, Obstacle> {
        let is_whole = |cell: &&CellRows<'_>| cell.is_identified();
        let mut special = match cells.iter().find(is_whole) {
            Some(_) => SpecialValues::none(true),
            None => of_dependent_rows(plant, domain, cells, unknowns)?,
        };
        let boundaries = of_coinciding_walls(plant, domain, cells)?;
        special.complete &= boundaries.complete;
        let mut harmless = 0;
        for boundary in boundaries.nonzero {
            let there = |domain: &Domain| on_boundary(plant, domain, &[boundary]);
            let is_left = |cell: &&CellRows<'_>| {
                let sides: Vec<Expr> = cell.cell.sides.iter().map(|(divider, _)| *divider).collect();
                there(&cell.cell.domain).points(&plant.arena, &sides).next().is_some()
            };
            let left: Vec<&CellRows<'_>> = cells.iter().filter(is_left).collect();
            let is_identified = left.iter().any(|cell| cell.is_identified())
                || coefficients(plant, domain, &left)?
                    .is_some_and(|rows| full_rank(&plant.arena, &there(domain), &rows, unknowns));
            if is_identified { harmless += 1 } else { special.add(boundary) }
        }
        // Where several hold at once more cells are gone.
        special.complete &= harmless < 2;
        Ok(special)
    };
    found().unwrap_or_else(|_| SpecialValues::none(false))
}

/// A domain at values of the parameters at which combinations of them are zero.
pub(super) fn on_boundary(plant: &Plant, domain: &Domain, boundaries: &[Expr]) -> Domain {
    let arena = &plant.arena;
    let equations = domain.manifold.equations().iter().chain(boundaries).copied().collect();
    let mut there = domain.clone();
    for parameter in arena.symbols_of(boundaries) {
        there.fixed.remove(&parameter);
    }
    there.manifold = Manifold::new(arena, &there.facts, equations, plant.elimination_order());
    there
}

/// The combinations that are zero where two walls coincide, or a wall and an assumption, or where a wall loses a term.
fn of_coinciding_walls(plant: &Plant, domain: &Domain, cells: &[CellRows<'_>]) -> Result<SpecialValues, Obstacle> {
    let arena = &plant.arena;
    let own: Vec<_> = cells.iter().map(|cell| cell.cell.clone()).collect();
    let walls = walls(&own);
    let facts = domain.facts.iter().map(|(fact, _)| fact).filter(|fact| varies(plant, *fact));
    let borders: Vec<Expr> = walls.iter().copied().chain(facts).collect();
    let parameters: BTreeSet<Symbol> = plant.parameters.iter().map(|parameter| parameter.symbol).collect();
    let mut special = SpecialValues::none(true);
    if arena.symbols_of(&borders).is_disjoint(&parameters) {
        return Ok(special);
    }
    // A cell of several signals may vanish where no two of its walls coincide.
    let signals = |border: &Expr| arena.symbols_of(&[*border]).difference(&parameters).count();
    special.complete &= borders.iter().all(|border| signals(border) == 1);
    let field = Field::over(arena, &domain.facts, &borders)?;
    let parted = Coefficients { plant, field: &field };
    let rows = borders.iter().map(|border| parted.of(*border)).collect::<Result<Vec<_>, _>>()?;
    for (index, first) in rows.iter().enumerate().take(walls.len()) {
        // A wall without a term of its own is elsewhere, or nowhere.
        let of_signals = first.iter().flatten().filter(|(monomial, _)| !monomial.powers().is_empty());
        for (_, coefficient) in of_signals {
            let zeros = common_zeros(&field, domain, std::slice::from_ref(coefficient))?;
            zeros.nonzero.into_iter().for_each(|zero| special.add(zero));
        }
        for second in &rows[index + 1..] {
            let Some((first, second)) = first.as_ref().zip(second.as_ref()) else {
                special.complete = false;
                continue;
            };
            let both = by_monomials(&field, &[first.clone(), second.clone()])?;
            let columns = Matrix::build(2, both.height(), |column, row| both.at(row, column));
            let zeros = common_zeros(&field, domain, &largest_minors(&field, &columns)?)?;
            special.complete &= zeros.complete;
            zeros.nonzero.into_iter().for_each(|zero| special.add(zero));
        }
    }
    Ok(special)
}

/// The combinations that are zero where the rows of all cells are dependent for all signals.
fn of_dependent_rows(
    plant: &Plant,
    domain: &Domain,
    cells: &[CellRows<'_>],
    unknowns: usize,
) -> Result<SpecialValues, Obstacle> {
    let cells: Vec<&CellRows<'_>> = cells.iter().collect();
    let Some(rows) = coefficients(plant, domain, &cells)? else { return Ok(SpecialValues::none(false)) };
    let field = Field::over(&plant.arena, &domain.facts, &rows.concat())?;
    let matrix = field.matrix(&rows)?;
    let columns = Matrix::build(unknowns, matrix.height(), |column, row| matrix.at(row, column));
    let minors = largest_minors(&field, &columns)?;
    if minors.is_empty() {
        return Ok(SpecialValues::none(false));
    }
    common_zeros(&field, domain, &minors)
}

/// Rows of parameters alone, whose combinations of the unknowns are those that the cells identify while the signals
/// take all values there; none where the parameters are not apart from the signals, or a fundamental matrix varies.
fn coefficients(plant: &Plant, domain: &Domain, cells: &[&CellRows<'_>]) -> Result<Option<Vec<Vec<Expr>>>, Obstacle> {
    let arena = &plant.arena;
    let mut found: Vec<Vec<Expr>> = Vec::new();
    for cell in cells {
        let width = cell.rows.first().map_or(0, Vec::len);
        let entries = as_on(arena, &cell.cell.domain, &cell.rows.concat())?;
        let holds_psi = || arena.symbols_of(&entries).iter().any(|symbol| plant.psi.concat().contains(symbol));
        if !arena.dividers(&entries).is_empty() || holds_psi() {
            return Ok(None);
        }
        let field = Field::over(arena, &domain.facts, &entries)?;
        let parted = Coefficients { plant, field: &field };
        for row in entries.chunks(width.max(1)) {
            let Some(parts) = parted.of_row(row)? else { return Ok(None) };
            for part in parts.into_iter().filter(|part| part.iter().any(|entry| !entry.is_zero())) {
                let part: Vec<Expr> = part.iter().map(|entry| field.show(entry)).collect();
                if !found.contains(&part) {
                    found.push(part);
                }
            }
        }
    }
    Ok(Some(found))
}

/// Formulas as polynomials in what varies, with coefficients of parameters.
struct Coefficients<'a> {
    plant: &'a Plant,
    field: &'a Field<'a>,
}

impl Coefficients<'_> {
    /// The coefficients of a numerator; none if parameters and signals are not apart in it.
    fn of(&self, expr: Expr) -> Result<Option<Vec<(Monomial, Poly)>>, Obstacle> {
        Ok(self.of_numerator(self.field.fraction(expr)?.numerator()))
    }

    fn of_numerator(&self, numerator: &Poly) -> Option<Vec<(Monomial, Poly)>> {
        let arena = &self.plant.arena;
        let parameters: BTreeSet<Symbol> = self.plant.parameters.iter().map(|parameter| parameter.symbol).collect();
        let is_moving = |v: &u32| varies(self.plant, self.field.kernel(*v));
        let moving: Vec<u32> = numerator.variables().iter().copied().filter(is_moving).collect();
        let is_apart = |v: &u32| arena.symbols_of(&[self.field.kernel(*v)]).is_disjoint(&parameters);
        moving.iter().all(is_apart).then(|| numerator.collect(&moving))
    }

    /// The same of a row, one for each power product: a common denominator changes no combination.
    fn of_row(&self, row: &[Expr]) -> Result<Option<Vec<Vec<Fraction>>>, Obstacle> {
        let entries = row.iter().map(|entry| self.field.fraction(*entry)).collect::<Result<Vec<_>, _>>()?;
        let (numerators, _) = self.field.over_common_denominator(&entries)?;
        let parts: Option<Vec<_>> = numerators.iter().map(|numerator| self.of_numerator(numerator)).collect();
        let Some(parts) = parts else { return Ok(None) };
        Ok(Some(by_monomials(self.field, &parts)?.into_rows()))
    }
}

/// The factors that polynomials in the parameters have in common; complete if they are zero at once nowhere else. Of no
/// polynomials, none.
fn common_zeros(field: &Field<'_>, domain: &Domain, polys: &[Poly]) -> Result<SpecialValues, Obstacle> {
    let mut special = SpecialValues::none(true);
    let Some((first, others)) = polys.split_first() else { return Ok(special) };
    let arena = field.arena();
    let shown = |poly: &Poly| Ok::<_, Obstacle>(field.show(&field.of_polynomial(poly)?));
    let never_zero = |arena: &Arena, poly: &Poly| -> Result<bool, Obstacle> {
        Ok(poly.is_constant()
            || field.signs().never_zero(poly)
            || domain.implies(arena, shown(poly)?, Relation::NonZero))
    };
    let mut common = first.clone();
    for other in others {
        common = common.gcd(other, field.limit())?;
    }
    for (factor, _) in common.factored(field.limit())?.factors {
        if !never_zero(arena, &factor)? {
            special.add(shown(&factor)?);
        }
    }
    special.complete = others.is_empty();
    for poly in polys {
        if let Some(rest) = poly.div_exact(&common, field.limit())? {
            special.complete |= never_zero(arena, &rest)?;
        }
    }
    Ok(special)
}

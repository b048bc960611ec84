//! The zero test: proved, refuted with a witness, or open with the obstacle.
//!
//! Proved: the normal form is zero, and the expression has a value at a point of the domain (so that
//! the proof is not about nothing). Refuted: at an exact point of the domain a rigorous enclosure of
//! the value excludes zero. Neither relies on floating point or on the kernels being independent.

use super::cells::Cell;
use crate::Domain;
use crate::forms::shared_sums::vanishes_over_shared_sums;
use crate::graph::arena::Arena;
use crate::graph::conditions::Regularity;
use crate::graph::enclosure::Point;
use crate::graph::expr::Expr;
use crate::linear::comparison::combine;
use crate::number::interval::{Interval, Precision};
use crate::tower::{Field, Obstacle};

/// The greatest number of domain points that a search examines: if an analytic expression vanishes or has no value at
/// so many, more of them would not help.
pub const MOST_POINTS: usize = 64;

/// Points that are evaluated at the least precision before the normal form.
const GLIMPSES: usize = 3;

/// The answer of the zero test.
#[derive(Clone, Debug)]
pub enum Answer {
    /// It is zero wherever it has a value.
    Zero,
    /// It is not zero at a point.
    NonZero(Witness),
    /// It could not be decided.
    Open(Obstacle),
}

/// A point at which an expression provably is not zero.
#[derive(Clone, Debug)]
pub struct Witness {
    /// The values of the symbols.
    pub point: Point,
    /// An enclosure of the value, which excludes zero.
    pub value: Interval,
}

impl Answer {
    /// True if the expression was proved to be zero.
    pub fn is_zero(&self) -> bool {
        matches!(self, Self::Zero)
    }
}

/// Decides whether the expression is zero on the domain: as it is written, and else on each cell on which it is
/// analytic.
pub fn decide(arena: &Arena, expr: Expr, domain: &Domain) -> Answer {
    match decide_as_written(arena, expr, domain) {
        Answer::Open(obstacle) if !arena.dividers(&[expr]).is_empty() => {
            on_cells(arena, expr, domain).unwrap_or(Answer::Open(obstacle))
        }
        answer => answer,
    }
}

/// Tests whether the expression is proved to be zero on the domain. False says nothing: unlike [`decide`] it looks for no
/// point that refutes it.
pub fn is_zero(arena: &Arena, expr: Expr, domain: &Domain) -> bool {
    let on_cell = |cell: &Cell| by_normal_form(arena, cell.domain.analytic(arena, &[expr])[0], &cell.domain).is_zero();
    match by_normal_form(arena, expr, domain) {
        Answer::Zero => true,
        Answer::NonZero(_) => false,
        Answer::Open(_) => {
            !arena.dividers(&[expr]).is_empty()
                && domain
                    .cells(arena, &[expr], |_| true)
                    .is_ok_and(|cells| !cells.is_empty() && cells.iter().all(on_cell))
        }
    }
}

/// The answer on the cells of the domain; none if these are not found, or one of them has no answer.
fn on_cells(arena: &Arena, expr: Expr, domain: &Domain) -> Option<Answer> {
    // Over no cell at all everything would be zero.
    let cells = domain.cells(arena, &[expr], |_| true).ok().filter(|cells| !cells.is_empty())?;
    for cell in cells {
        let branch = cell.domain.analytic(arena, &[expr])[0];
        match decide_as_written(arena, branch, &cell.domain) {
            Answer::Zero => {}
            // A cell of other values than those that are given refutes nothing at these. The branch may hold fewer
            // symbols than the expression: a witness has the values of all.
            Answer::NonZero(_) if cell.domain.fixed == domain.fixed => {
                return refute(arena, expr, &cell.domain).map(Answer::NonZero);
            }
            Answer::NonZero(_) | Answer::Open(_) => return None,
        }
    }
    Some(Answer::Zero)
}

/// Decides it by the normal form of the expression as it is written, and else by points.
fn decide_as_written(arena: &Arena, expr: Expr, domain: &Domain) -> Answer {
    match by_normal_form(arena, expr, domain) {
        Answer::Open(Obstacle::NoPoint) => Answer::Open(Obstacle::NoPoint),
        Answer::Open(obstacle) => refute(arena, expr, domain).map_or(Answer::Open(obstacle), Answer::NonZero),
        answer => answer,
    }
}

/// Decides it by the normal form of the expression as it is written.
fn by_normal_form(arena: &Arena, expr: Expr, domain: &Domain) -> Answer {
    if arena.is_zero(expr) {
        return Answer::Zero;
    }
    // A cheap trial first: a plainly non-zero expression needs no normal form.
    let mut exists = false;
    for point in domain.points(arena, &[expr]).take(GLIMPSES) {
        let Some(value) = arena.enclose(expr, &point, Precision::new(64)) else { continue };
        if !value.contains_zero() {
            return Answer::NonZero(Witness { point, value });
        }
        exists = true;
    }
    let vanishes = |field: Result<Field<'_>, Obstacle>| {
        let field = field?;
        let fraction = field.fraction(expr)?;
        if fraction.is_zero() { Ok(()) } else { Err(field.doubt(&fraction)) }
    };
    let mut normal = if vanishes_over_shared_sums(arena, &domain.facts, expr) {
        Ok(())
    } else {
        vanishes(Field::of_long_sums(arena, &domain.facts, &[expr]))
    };
    // An expression that vanishes everywhere does so on the manifold; the converse is false.
    if normal.is_err() && !domain.manifold.is_empty() {
        let unsolved = domain.manifold.open().map(|equation| Obstacle::Unsolved(arena.print(equation)));
        normal = match (vanishes(Field::on(arena, domain, &[expr])), unsolved) {
            (Err(_), Some(_)) if exists && is_combination(arena, expr, domain).unwrap_or(false) => Ok(()),
            (Err(_), Some(unsolved)) => Err(unsolved),
            (normal, _) => normal,
        };
        // With the values of symbols as formulas of the others in their places.
        let by_values = arena.substitute(expr, &domain.manifold.given_values(arena));
        if normal.is_err() && by_values != expr {
            let field = Field::of_long_sums(arena, &domain.facts, &[by_values]);
            let is_zero = field.and_then(|field| Ok(field.fraction(by_values)?.is_zero()));
            normal = if is_zero == Ok(true) { Ok(()) } else { normal };
        }
    }
    match normal {
        Ok(()) if exists || point_of(arena, expr, domain).is_some() => Answer::Zero,
        Ok(()) => Answer::Open(Obstacle::NoPoint),
        Err(obstacle) => Answer::Open(obstacle),
    }
}

/// True if the expression is a combination of the equations of the domain, with coefficients that are free of what must
/// not occur in results and have values throughout.
fn is_combination(arena: &Arena, expr: Expr, domain: &Domain) -> Result<bool, Obstacle> {
    let equations = domain.manifold.equations();
    let field = Field::over(arena, &domain.facts, &[equations, &[expr]].concat())?;
    let Some(coefficients) = combine(&field, expr, equations, domain.manifold.hidden())? else { return Ok(false) };
    let coefficients: Vec<Expr> = coefficients.iter().map(|coefficient| field.show(coefficient)).collect();
    let conditions = arena.domain_conditions(&coefficients, Regularity::Defined);
    Ok(conditions.into_iter().all(|(condition, relation)| domain.implies(arena, condition, relation)))
}

/// True if all of the expressions are proved to be zero, over the kernels of all at once: shared terms are brought to
/// normal form once. False says nothing of any.
pub fn all_zero(arena: &Arena, exprs: &[Expr], domain: &Domain) -> bool {
    let values = |point: Point| arena.enclose_all(exprs, &point, Precision::new(64));
    let Some(values) = domain.points(arena, exprs).take(GLIMPSES).find_map(values) else { return false };
    values.iter().all(Interval::contains_zero)
        && Field::of_long_sums(arena, &domain.facts, exprs)
            .is_ok_and(|field| exprs.iter().all(|e| field.fraction(*e).is_ok_and(|fraction| fraction.is_zero())))
}

/// Searches for a point of the domain at which the expression provably is not zero.
pub fn refute(arena: &Arena, expr: Expr, domain: &Domain) -> Option<Witness> {
    domain.points(arena, &[expr]).take(MOST_POINTS).find_map(|point| {
        let value = arena.separated_from_zero(expr, &point)?;
        Some(Witness { point, value })
    })
}

/// Searches for a point of the domain at which the expression provably has a value.
pub fn point_of(arena: &Arena, expr: Expr, domain: &Domain) -> Option<Point> {
    domain.points(arena, &[expr]).take(MOST_POINTS).find(|point| arena.exists_at(expr, point))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Function, Rational, Relation};

    #[test]
    fn a_witness_on_a_cell_has_the_values_of_all_symbols() {
        let arena = Arena::new();
        let [u, z, p] = ["u", "z", "p"].map(|name| arena.variable(name));
        let mut domain = Domain::default();
        domain.facts.assume(p, Relation::Positive);
        // The signs differ where 1 + p/4 < z^2 < 1 + p/3 alone.
        let side = |share: i64| {
            let part = arena.scale(p, &Rational::new(1, share).unwrap());
            let above = arena.sub(arena.sub(arena.mul(z, z), part), arena.one());
            arena.mul(u, arena.sub(arena.one(), arena.call(Function::Sign, &[above])))
        };
        let difference = arena.sub(side(3), side(4));
        let Answer::NonZero(witness) = decide(&arena, difference, &domain) else { panic!("it is not zero") };
        assert_eq!(
            witness.point.keys().copied().collect::<Vec<_>>(),
            arena.symbols_of(&[difference]).into_iter().collect::<Vec<_>>()
        );
        assert!(arena.separated_from_zero(difference, &witness.point).is_some());
    }
}

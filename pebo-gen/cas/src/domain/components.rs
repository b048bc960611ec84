//! The components of the points of a domain at which further equations hold, cut into cells.
//!
//! In: a domain, equations, formulas, and the symbols that the equations are solved for. Out: cells, each with equations
//! that no rule found to be a product, on which the formulas are analytic. Together they hold every point of the domain
//! at which the equations hold: `a*(s - 1) = 0` is `a = 0` or `s = 1`, and `a = 0` is left out where `a > 0` is assumed;
//! `a*|b| = a*b` is `b > 0`, `a = 0` with `b < 0`, and `b = 0`. An equation that is solved for a symbol is cut only if it
//! is among the formulas too. A property of analytic formulas that is proved at a point of such a cell holds almost
//! everywhere in it.

use std::collections::BTreeSet;

use super::cells::{Cell, MOST_CELLS, Side};
use super::manifold::Manifold;
use super::reducible::{Factors, factors};
use super::zero::is_zero;
use crate::graph::conditions::Regularity;
use crate::graph::expr::{Expr, Symbol};
use crate::tower::Obstacle;
use crate::{Arena, Domain, Relation};

/// A cell whose equations are still to be taken apart.
struct OpenCell {
    cell: Cell,
    /// Equations of the cell: those that are given, by the branches of the cell, or factors of these.
    equations: Vec<Expr>,
    /// The dividers that vanish on the cell.
    walls: Vec<Expr>,
}

impl Domain {
    /// The cells of the components on which the equations hold too, solved for symbols of the groups, the last of which
    /// are constants. On each of them the formulas are analytic in what varies. None of them is known to be empty. An
    /// obstacle if there are too many, or if an equation remains that may hold in several ways.
    pub fn components(
        &self,
        arena: &Arena,
        equations: &[Expr],
        formulas: &[Expr],
        groups: &[BTreeSet<Symbol>],
    ) -> Result<Vec<Cell>, Obstacle> {
        let own = self.manifold.equations().iter().chain(equations).copied().collect();
        let cell = Cell { domain: self.without_equations(), sides: Vec::new() };
        let mut open = vec![OpenCell { cell, equations: own, walls: Vec::new() }];
        let mut found = Vec::new();
        while let Some(next) = open.pop() {
            match next.finer(arena, formulas, groups)? {
                Finer::Cells(finer) => open.extend(finer.into_iter().rev()),
                Finer::Whole(cell) => found.push(*cell),
            }
            if open.len() + found.len() > MOST_CELLS {
                return Err(Obstacle::TooLarge);
            }
        }
        Ok(found)
    }
}

/// A cell, as it is taken apart.
enum Finer {
    Cells(Vec<OpenCell>),
    Whole(Box<Cell>),
}

impl OpenCell {
    /// The finer cells that hold the same points; the cell itself if there are none.
    fn finer(mut self, arena: &Arena, formulas: &[Expr], groups: &[BTreeSet<Symbol>]) -> Result<Finer, Obstacle> {
        let manifold =
            |equations: &[Expr]| Manifold::new(arena, &self.cell.domain.facts, equations.to_vec(), groups.to_vec());
        // An equation says nothing of its own branches: the walls are other equations.
        let on_walls = Domain { manifold: manifold(&self.walls), ..self.cell.domain.clone() };
        self.equations = on_walls.analytic(arena, &self.equations);
        let there = Domain {
            manifold: manifold(&[self.equations.as_slice(), &self.walls].concat()),
            ..self.cell.domain.clone()
        };
        if self.cell.sides.iter().any(|side| there.excludes(arena, *side)) || there.contradicts_its_facts(arena) {
            return Ok(Finer::Cells(Vec::new()));
        }
        // An equation that is solved for a symbol has one branch, however many its value has.
        let unsolved = there.manifold.unsolved(arena);
        let analytic = [unsolved, there.analytic(arena, formulas)].concat();
        let constants = groups.last();
        let varies = |expr: Expr| {
            let is_constant = |symbol: &Symbol| constants.is_some_and(|constants| constants.contains(symbol));
            !arena.symbols_of(&[expr]).iter().all(is_constant)
        };
        // As it is on the manifold: there it may be a constant.
        let determined = there.manifold.determined();
        let dividers = there.dividers(arena, &analytic)?.into_iter();
        let dividers = dividers.map(|divider| arena.substitute(divider, &determined));
        if let Some(divider) = dividers.into_iter().find(|divider| !there.has_sign(arena, *divider)) {
            if self.walls.contains(&divider) {
                return Err(Obstacle::Unsolved(arena.print(divider)));
            }
            // Constants have almost all values; where an equation binds them, they may be on a wall.
            let is_bound = |equation: &Expr| !varies(*equation) && !arena.symbols_of(&[*equation]).is_empty();
            let has_wall = varies(divider) || self.equations.iter().chain(&self.walls).any(is_bound);
            return Ok(Finer::Cells(self.divided(arena, divider, has_wall)));
        }
        let reduced = there.manifold.reduced(arena);
        for (index, equation) in reduced.iter().enumerate() {
            let replaced = |factors: Vec<Expr>| {
                let mut equations = reduced.clone();
                equations.splice(index..=index, factors);
                Self { cell: self.cell.clone(), equations, walls: self.walls.clone() }
            };
            match factors(arena, &self.cell.domain, *equation)? {
                Factors::One => {}
                Factors::Several(factors) => return Ok(Finer::Cells(factors.into_iter().map(replaced).collect())),
                Factors::Open => return Err(Obstacle::Unsolved(arena.print(*equation))),
            }
        }
        if let Some(equation) = there.manifold.coupled(arena) {
            return Err(Obstacle::Unsolved(arena.print(equation)));
        }
        let shorter = self.without_excluded_factors(arena);
        if shorter == self.equations {
            return Ok(Finer::Whole(Box::new(Cell { domain: there, sides: self.cell.sides })));
        }
        let manifold = manifold(&[shorter.as_slice(), &self.walls].concat());
        let domain = Domain { manifold, ..self.cell.domain.clone() };
        Ok(Finer::Whole(Box::new(Cell { domain, sides: self.cell.sides })))
    }

    /// The equations without factors that have no zeros in the cell: a point drawn on `r*u = 0` at `r > 0` must not be
    /// one of `r = 0`. An equation with a denominator is solved as it stands.
    fn without_excluded_factors(&self, arena: &Arena) -> Vec<Expr> {
        let is_plain = |equation: Expr| arena.domain_conditions(&[equation], Regularity::Defined).is_empty();
        let shorter = |equation: &Expr| match factors(arena, &self.cell.domain, *equation) {
            Ok(Factors::Several(mut ways)) if ways.len() == 1 && is_plain(*equation) => ways.remove(0),
            _ => vec![*equation],
        };
        self.equations.iter().flat_map(shorter).collect()
    }

    /// The cells on both sides of a divider, and on it.
    fn divided(&self, arena: &Arena, divider: Expr, has_wall: bool) -> Vec<Self> {
        let side = |side: Side| {
            let mut cell = self.cell.clone();
            cell.domain.facts.assume(side.positive(arena, divider), Relation::Positive);
            cell.sides.push((divider, side));
            Self { cell, equations: self.equations.clone(), walls: self.walls.clone() }
        };
        let mut cells = vec![side(Side::Positive), side(Side::Negative)];
        if has_wall && !self.cell.domain.implies(arena, divider, Relation::NonZero) {
            let walls = [self.walls.as_slice(), &[divider]].concat();
            cells.push(Self { cell: self.cell.clone(), equations: self.equations.clone(), walls });
        }
        cells
    }
}

impl Domain {
    /// True if no point has this side.
    fn excludes(&self, arena: &Arena, (divider, side): (Expr, Side)) -> bool {
        self.implies(arena, arena.neg(side.positive(arena, divider)), Relation::NonNegative)
    }

    /// True if an expression that is assumed not to be zero is, where the equations give its symbols values.
    fn contradicts_its_facts(&self, arena: &Arena) -> bool {
        let determined = self.manifold.determined();
        let mut assumed = self.facts.iter().filter(|(_, relation)| *relation != Relation::NonNegative);
        assumed.any(|(fact, _)| {
            let there = arena.substitute(fact, &determined);
            there != fact && is_zero(arena, there, &self.without_equations())
        })
    }

    /// True if the expression is positive, negative or zero throughout.
    fn has_sign(&self, arena: &Arena, expr: Expr) -> bool {
        self.implies(arena, expr, Relation::Positive)
            || self.implies(arena, arena.neg(expr), Relation::Positive)
            || is_zero(arena, expr, self)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Function, Rational};

    /// The equations of a cell, then its sides.
    fn shown(arena: &Arena, there: &Cell) -> String {
        let equations = there.domain.manifold.reduced(arena);
        let equations = equations.iter().map(|e| arena.print(*e));
        let sides = there.distinct_sides(arena, &Domain::default()).into_iter();
        let sides = sides.map(|(e, side)| format!("{} {}", arena.print(e), side.sign()));
        equations.chain(sides).collect::<Vec<_>>().join(", ")
    }

    #[test]
    fn components_have_points_where_a_factor_of_an_equation_is_excluded() {
        let arena = Arena::new();
        let [r, u, v] = ["r", "u", "v"].map(|name| arena.variable(name));
        let mut domain = Domain::default();
        domain.facts.assume(r, Relation::Positive);
        let groups: Vec<BTreeSet<Symbol>> =
            [r, u, v].iter().map(|e| arena.as_symbol(*e).into_iter().collect()).chain([BTreeSet::new()]).collect();
        let factored = arena.mul(r, arena.sub(u, v));
        let expanded = arena.sub(arena.mul(r, u), arena.mul(r, v));
        for equation in [arena.mul(r, u), factored, expanded] {
            let cells = domain.components(&arena, &[equation], &[], &groups).unwrap();
            let has_point = |cell: &Cell| cell.domain.points(&arena, &[r, u]).next().is_some();
            assert_eq!((cells.len(), cells.iter().all(has_point)), (1, true), "{}", arena.print(equation));
        }
    }

    #[test]
    fn products_of_equations_are_taken_apart() {
        let arena = Arena::new();
        let [a, b, c] = ["a", "b", "c"].map(|name| arena.variable(name));
        let one = arena.one();
        let square = |e| arena.mul(e, e);
        let components = |equations: &[Expr], positive: &[Expr]| -> Option<Vec<String>> {
            let mut domain = Domain::default();
            for fact in positive {
                domain.facts.assume(*fact, Relation::Positive);
            }
            let symbols = [a, b, c].iter().filter_map(|e| arena.as_symbol(*e)).collect();
            let groups = [BTreeSet::new(), symbols, BTreeSet::new()];
            Some(
                domain
                    .components(&arena, equations, &[], &groups)
                    .ok()?
                    .into_iter()
                    .map(|there| shown(&arena, &there))
                    .collect(),
            )
        };
        let product = arena.mul(a, arena.sub(b, one));
        assert_eq!(components(&[product], &[]).unwrap(), ["a", "b - 1"]);
        assert_eq!(components(&[product], &[a]).unwrap(), ["b - 1"]);
        assert_eq!(components(&[product], &[a, b]).unwrap(), ["b - 1"]);
        assert_eq!(components(&[product], &[a, arena.sub(b, arena.number(Rational::from(2)))]).unwrap(), [""; 0]);
        // An assumption on both is not one on either.
        assert_eq!(components(&[a, b], &[arena.sub(a, b)]).unwrap(), [""; 0]);
        // A product after another equation is solved.
        assert_eq!(components(&[arena.sub(arena.mul(a, c), a), arena.sub(c, b)], &[]).unwrap().len(), 2);
        assert_eq!(components(&[arena.sub(square(a), square(b))], &[]).unwrap().len(), 2);
        assert_eq!(components(&[arena.add(square(a), one)], &[]).unwrap(), [""; 0]);
        let sum = arena.add(square(a), square(b));
        assert_eq!(components(&[arena.mul(sum, arena.sub(sum, one))], &[]).unwrap(), ["a^2 + b^2 - 1", "a, b"]);
        // Three values of one symbol are not told apart.
        let cubic = arena.sum([arena.mul(a, square(a)), arena.scale(a, &Rational::from(-3)), one]);
        assert_eq!(components(&[cubic], &[]), None);
    }

    #[test]
    fn equations_are_taken_apart_on_each_cell_and_on_its_walls() {
        let arena = Arena::new();
        let [a, b, c] = ["a", "b", "c"].map(|name| arena.variable(name));
        let one = arena.one();
        let call = |function, arguments: &[Expr]| arena.call(function, arguments);
        let symbols: BTreeSet<Symbol> = [a, b].iter().filter_map(|e| arena.as_symbol(*e)).collect();
        let groups = [BTreeSet::new(), symbols, arena.symbols_of(&[c])];
        let components = |equations: &[Expr], formulas: &[Expr]| {
            let cells = Domain::default().components(&arena, equations, formulas, &groups).unwrap();
            cells.into_iter().map(|there| shown(&arena, &there)).collect::<Vec<_>>()
        };
        let size = |e| call(Function::Abs, &[e]);
        assert_eq!(components(&[size(a)], &[]), ["a"]);
        assert_eq!(components(&[arena.add(a, size(b))], &[]), ["a + abs(b)"]);
        let sum = arena.add(a, size(b));
        assert_eq!(components(&[sum], &[sum]), ["a + b, b > 0", "a - b, b < 0", "b, a"]);
        let product = arena.sub(arena.mul(a, size(b)), arena.mul(a, b));
        assert_eq!(components(&[product], &[]), ["b > 0", "a, b < 0", "b"]);
        // An equation does not imply itself.
        assert_eq!(components(&[arena.sub(a, size(a))], &[]), ["a > 0", "a"]);
        // Walls with a constant; a saturation has two.
        assert_eq!(components(&[call(Function::Sat, &[arena.sub(a, c)])], &[]), ["a - c"]);
        assert_eq!(components(&[b], &[size(arena.sub(a, c))]), ["b, a - c > 0", "b, a - c < 0", "b, a - c"]);
        assert_eq!(components(&[b], &[size(c)]), ["b, c > 0", "b, c < 0"]);
        // Constants that an equation binds.
        let constants = arena.add(size(c), size(arena.sub(c, one)));
        assert_eq!(components(&[constants], &[]), [""; 0]);
        assert_eq!(components(&[size(c)], &[]), ["c"]);
        // A root of a square is an absolute value too.
        let root = arena.sqrt(arena.mul(b, b));
        assert_eq!(components(&[arena.add(arena.mul(a, b), root)], &[]), ["a + 1, b > 0", "a - 1, b < 0", "b"]);
        assert_eq!(
            components(&[arena.sub(a, one)], &[size(arena.sub(a, c))]),
            ["a - 1, c - 1 > 0", "a - 1, c - 1 < 0"]
        );
    }
}

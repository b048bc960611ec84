//! The cells of a domain on which formulas are analytic.
//!
//! In: a domain, and formulas with absolute values, signs, least and greatest values, tables, roots of squares and
//! inverse sines. Out: the domain divided by the signs of their arguments. A property proved at a point of a cell holds almost
//! everywhere in that cell, but not in others: `q + |q|` is not the zero function, and vanishes wherever q is negative.
//!
//! An angle recovered from its functions, as `asin(sin(q))`, is a different straight line on each of infinitely many
//! intervals. This is an obstacle where the normal form cannot decide the interval.

use crate::graph::expr::{Expr, Node};
use crate::graph::function::Function;
use crate::graph::function::pieces::Pieces;
use crate::tower::{Field, Obstacle};
use crate::{Arena, Domain, Facts, Rational, Relation};

/// The greatest number of cells that are examined one by one: three saturations divide a domain into 27, and an equation
/// each of them into two components.
pub(super) const MOST_CELLS: usize = 54;

/// A cell of a domain.
#[derive(Clone, Debug)]
pub struct Cell {
    /// The points of the cell.
    pub domain: Domain,
    /// The expressions that divide it from other cells, with their signs in this cell.
    pub sides: Vec<(Expr, Side)>,
}

/// The sign of a dividing expression.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub enum Side {
    /// `> 0`
    Positive,
    /// `< 0`
    Negative,
}

impl Side {
    /// As a formula writes it.
    pub fn sign(self) -> &'static str {
        match self {
            Self::Positive => "> 0",
            Self::Negative => "< 0",
        }
    }

    /// The expression that is positive where a divider has this sign.
    pub fn positive(self, arena: &Arena, divider: Expr) -> Expr {
        match self {
            Self::Positive => divider,
            Self::Negative => arena.neg(divider),
        }
    }
}

impl Domain {
    /// The cells on which the formulas are analytic in the varying symbols; one cell if they are analytic everywhere.
    /// An obstacle if there are too many, or if it is open that one of them has points.
    pub fn cells(&self, arena: &Arena, exprs: &[Expr], varies: impl Fn(Expr) -> bool) -> Result<Vec<Cell>, Obstacle> {
        let mut cells = Vec::new();
        let mut open = vec![Cell { domain: self.clone(), sides: Vec::new() }];
        while let Some(cell) = open.pop() {
            // Of `sqrt((|q| - 1)^2)` each side of q = 0 has a border of its own.
            let there = cell.domain.analytic(arena, exprs);
            let mut dividers = cell.domain.dividers(arena, &there)?.into_iter().filter(|divider| varies(*divider));
            let finer = dividers.find_map(|divider| match cell.divide(arena, divider) {
                Ok(finer) => (finer.len() > 1).then_some(Ok(finer)),
                Err(obstacle) => Some(Err(obstacle)),
            });
            match finer {
                Some(finer) => open.extend(finer?.into_iter().rev()),
                None => cells.push(cell),
            }
            if cells.len() + open.len() > MOST_CELLS {
                return Err(Obstacle::TooLarge);
            }
        }
        for cell in &cells {
            cell.domain.check_angles(arena, &cell.domain.analytic(arena, exprs), &varies)?;
        }
        Ok(cells)
    }

    /// The cells on which each of these expressions has a sign.
    pub fn divided_by(&self, arena: &Arena, dividers: &[Expr]) -> Result<Vec<Cell>, Obstacle> {
        let mut cells = vec![Cell { domain: self.clone(), sides: Vec::new() }];
        for divider in dividers {
            let finer: Vec<_> = cells.iter().map(|cell| cell.divide(arena, *divider)).collect::<Result<_, _>>()?;
            cells = finer.concat();
        }
        Ok(cells)
    }

    /// The factors of the arguments of absolute values, also where these are written as roots of squares or as other
    /// functions: `exp(log(q^2)/2)` is `|q|`.
    pub(crate) fn dividers(&self, arena: &Arena, exprs: &[Expr]) -> Result<Vec<Expr>, Obstacle> {
        let mut under = arena.dividers(exprs);
        let mut absolute_values: Vec<Expr> =
            arena.absolute_values(exprs).into_iter().filter(|root| !arena.symbols_of(&[*root]).is_empty()).collect();
        absolute_values.extend(arena.branched(exprs));
        let field = Field::on(arena, &self.without_radicand_facts(arena, &absolute_values), &absolute_values)?;
        for value in &absolute_values {
            field.fraction(*value)?;
        }
        let argument_of = |kernel: Expr| match arena.node(kernel) {
            Node::Call(Function::Abs, argument) => Some(argument[0]),
            _ => None,
        };
        under.extend(field.kernels().into_iter().filter_map(argument_of));
        let field = Field::on(arena, self, &under)?;
        let mut found = Vec::new();
        for divider in under {
            let fraction = field.fraction(divider)?;
            for poly in [fraction.numerator(), fraction.denominator()] {
                for (factor, _) in poly.factored(field.limit())?.factors {
                    let factor = field.show(&field.of_polynomial(&factor)?);
                    if !found.contains(&factor) {
                        found.push(factor);
                    }
                }
            }
        }
        Ok(found)
    }

    /// The domain without the assumptions that radicands are non-negative: that a root has a value says nothing of its
    /// non-smooth points.
    #[must_use]
    pub fn without_radicand_facts(&self, arena: &Arena, exprs: &[Expr]) -> Self {
        let is_root = |(base, power): &(Expr, Rational)| (!power.is_integer()).then_some(*base);
        let radicands: Vec<Expr> = arena
            .postorder(exprs)
            .into_iter()
            .filter_map(|expr| match arena.node(expr) {
                Node::Product(product) => Some(product.factors.iter().filter_map(is_root).collect::<Vec<Expr>>()),
                _ => None,
            })
            .flatten()
            .filter(|base| arena.as_symbol(*base).is_none())
            .collect();
        let mut facts = Facts::new();
        for (fact, relation) in self.facts.iter().filter(|(fact, _)| !radicands.contains(fact)) {
            facts.assume(fact, relation);
        }
        Self { facts, ..self.clone() }
    }

    /// An obstacle if an inverse circular function that remains in the normal form varies as a multiple of its
    /// arguments or of another one: their difference is then a different number on each of many intervals. Equations of
    /// the domain are ignored: an output given as an angle is no other function of its arguments.
    fn check_angles(&self, arena: &Arena, exprs: &[Expr], varies: &impl Fn(Expr) -> bool) -> Result<(), Obstacle> {
        let is_angle = |e: &Expr| {
            let inverse = [Function::Asin, Function::Acos, Function::Atan, Function::Atan2];
            matches!(arena.node(*e), Node::Call(function, _) if inverse.contains(&function)) && varies(*e)
        };
        let angles: Vec<Expr> = arena.postorder(exprs).into_iter().filter(is_angle).collect();
        let mut known: Vec<(Expr, Vec<Expr>)> = Vec::new();
        for angle in angles {
            let field = Field::over(arena, &self.facts, &[angle])?;
            let normal = field.show(&field.fraction(angle)?);
            if !arena.postorder(&[normal]).iter().any(is_angle) {
                continue;
            }
            let signals: Vec<_> =
                arena.symbols_of(&[angle]).into_iter().filter(|symbol| varies(arena.of_symbol(*symbol))).collect();
            if signals.is_empty() {
                continue;
            }
            let slopes: Vec<Expr> = signals.iter().map(|signal| arena.derivative(normal, *signal)).collect();
            let field = Field::over(arena, &self.facts, &slopes)?;
            let shown = slopes.iter().map(|slope| Ok(field.show(&field.fraction(*slope)?)));
            let shown = shown.collect::<Result<Vec<Expr>, Obstacle>>()?;
            if shown.iter().all(|slope| !varies(*slope)) {
                return Err(Obstacle::Kernel(arena.print(angle)));
            }
            for (other, slopes) in &known {
                let twice = |slope: &Expr| arena.scale(*slope, &Rational::from(2));
                let alike = |own: &[Expr], other: &[Expr]| {
                    let minus: Vec<Expr> = other.iter().map(|slope| arena.neg(*slope)).collect();
                    own == other || own == minus
                };
                let (double, others): (Vec<Expr>, Vec<Expr>) =
                    (shown.iter().map(twice).collect(), slopes.iter().map(twice).collect());
                if alike(&shown, slopes) || alike(&double, slopes) || alike(&shown, &others) {
                    return Err(Obstacle::Related(arena.print(*other), arena.print(angle)));
                }
            }
            known.push((angle, shown));
        }
        Ok(())
    }
}

/// The expressions that divide cells, in the order of the cells.
pub fn walls(cells: &[Cell]) -> Vec<Expr> {
    let mut found = Vec::new();
    for (divider, _) in cells.iter().flat_map(|cell| &cell.sides) {
        if !found.contains(divider) {
            found.push(*divider);
        }
    }
    found
}

/// The expression that alone has other signs on the one side of a wall than on the other.
pub fn wall_between(own: &[(Expr, Side)], other: &[(Expr, Side)]) -> Option<Expr> {
    let is_opposed =
        |(divider, side): &&(Expr, Side)| other.iter().any(|(same, there)| same == divider && there != side);
    let mut opposed = own.iter().filter(is_opposed);
    let (wall, _) = opposed.next()?;
    opposed.next().is_none().then_some(*wall)
}

impl Cell {
    /// The sides that determine the cell within a domain, and with its own equations: none of them follows from the
    /// others.
    pub fn distinct_sides(&self, arena: &Arena, whole: &Domain) -> Vec<(Expr, Side)> {
        let mut sides = self.sides.clone();
        let mut index = 0;
        while index < sides.len() {
            let (divider, side) = sides.remove(index);
            let mut by_others = Domain { facts: whole.facts.clone(), ..self.domain.clone() };
            for (other, side) in &sides {
                by_others.facts.assume(side.positive(arena, *other), Relation::Positive);
            }
            if !by_others.implies(arena, side.positive(arena, divider), Relation::Positive) {
                sides.insert(index, (divider, side));
                index += 1;
            }
        }
        sides
    }

    /// The two cells of this one on either side of a divider, if they have points: at the given values, or else at
    /// others, which are then not given in the cell.
    fn divide(&self, arena: &Arena, divider: Expr) -> Result<Vec<Self>, Obstacle> {
        let sides = [Side::Positive, Side::Negative];
        let positive = |side: Side| side.positive(arena, divider);
        if sides.iter().any(|side| self.domain.implies(arena, positive(*side), Relation::NonNegative)) {
            return Ok(vec![self.clone()]);
        }
        let one = |side: Side| {
            let mut cell = self.clone();
            cell.domain.facts.assume(positive(side), Relation::Positive);
            cell.domain = cell.domain.with_branches(arena);
            cell.sides.push((divider, side));
            let has_point = |cell: &Self| cell.domain.points(arena, &[divider]).next().is_some();
            if !has_point(&cell) && !cell.domain.fixed.is_empty() {
                cell.domain.fixed.clear();
            }
            if has_point(&cell) { Ok(cell) } else { Err(Obstacle::NoPoint) }
        };
        sides.into_iter().map(one).collect()
    }
}

impl Arena {
    /// The arguments of absolute values, also where these are written as other functions: formulas are non-smooth or
    /// jump at their zeros.
    pub fn dividers(&self, exprs: &[Expr]) -> Vec<Expr> {
        let mut found = Vec::new();
        let mut open = exprs.to_vec();
        while !open.is_empty() {
            let nodes = self.postorder(&std::mem::take(&mut open));
            for node in nodes {
                let Node::Call(function, arguments) = self.node(node) else { continue };
                if let Some((table, argument)) = Pieces::of(self, node) {
                    let knots = table.meeting(None).into_iter();
                    found.extend(knots.map(|knot| self.sub(argument, self.number(knot))));
                    continue;
                }
                match function.row().in_terms {
                    Some(in_terms) => open.push(in_terms(self, &arguments)),
                    None if function == Function::Abs && !found.contains(&arguments[0]) => found.push(arguments[0]),
                    None => {}
                }
            }
        }
        found
    }

    /// The expressions that hold roots or logarithms: their combination may be an absolute value.
    pub fn branched(&self, exprs: &[Expr]) -> Vec<Expr> {
        let is_one = |expr: Expr| match self.node(expr) {
            Node::Product(product) => product.factors.iter().any(|(_, power)| !power.is_integer()),
            Node::Call(function, _) => matches!(function, Function::Log | Function::Acosh),
            _ => false,
        };
        let holds =
            |expr: &Expr| !self.symbols_of(&[*expr]).is_empty() && self.postorder(&[*expr]).into_iter().any(is_one);
        exprs.iter().copied().filter(holds).collect()
    }

    /// Candidates for absolute values: even roots, and the cosines of inverse sines and cosines.
    fn absolute_values(&self, exprs: &[Expr]) -> Vec<Expr> {
        let mut found = Vec::new();
        for node in self.postorder(exprs) {
            match self.node(node) {
                Node::Product(product) => {
                    let is_even_root = |power: &Rational| power.denominator().trailing_zeros() > 0;
                    let roots = product.factors.iter().filter(|(_, power)| is_even_root(power));
                    found.extend(roots.map(|(base, power)| self.power(*base, power)));
                }
                Node::Call(Function::Asin | Function::Acos, argument) => {
                    let square = self.mul(argument[0], argument[0]);
                    found.push(self.sqrt(self.sub(self.one(), square)));
                }
                _ => {}
            }
        }
        found
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cells(assumed: &[fn(&Arena, Expr) -> Expr], formula: fn(&Arena, [Expr; 2]) -> Expr) -> Vec<String> {
        let arena = Arena::new();
        let [a, b] = ["a", "b"].map(|name| arena.variable(name));
        let mut domain = Domain::default();
        for fact in assumed {
            domain.facts.assume(fact(&arena, b), Relation::Positive);
        }
        let shown = |cell: Cell| {
            let sides = cell.sides.iter().map(|(divisor, side)| format!("{} {}", arena.print(*divisor), side.sign()));
            sides.collect::<Vec<_>>().join(", ")
        };
        domain.cells(&arena, &[formula(&arena, [a, b])], |_| true).unwrap().into_iter().map(shown).collect()
    }

    #[test]
    fn a_domain_is_divided_at_non_smooth_points_and_has_points_on_both_sides() {
        let size = |arena: &Arena, [a, b]: [Expr; 2]| arena.add(a, arena.call(Function::Abs, &[b]));
        assert_eq!(cells(&[], |arena, [a, b]| arena.mul(a, arena.call(Function::Sin, &[b]))), [""]);
        assert_eq!(cells(&[], size), ["b > 0", "b < 0"]);
        assert_eq!(cells(&[|arena, b| arena.sub(b, arena.one())], size), [""]);
        let both = |arena: &Arena, [a, b]: [Expr; 2]| {
            arena.mul(arena.call(Function::Sign, &[a]), arena.call(Function::Max, &[a, b]))
        };
        assert_eq!(cells(&[], both).len(), 4);
        // Three of four: a > 1 and a < -1 exclude each other.
        assert_eq!(cells(&[], |arena, [a, _]| arena.call(Function::Sat, &[a])).len(), 3);
    }

    #[test]
    fn a_wall_is_between_cells_that_one_divider_tells_apart() {
        let arena = Arena::new();
        let [a, b, c] = ["a", "b", "c"].map(|name| arena.variable(name));
        let (above, below) = (|e| (e, Side::Positive), |e| (e, Side::Negative));
        assert_eq!(wall_between(&[above(a), above(b)], &[above(a), below(b)]), Some(b));
        assert_eq!(wall_between(&[above(a), above(b)], &[below(a), below(b)]), None);
        assert_eq!(wall_between(&[above(a), above(b)], &[above(a), above(b)]), None);
        // A side that the others imply is not written.
        assert_eq!(wall_between(&[above(a), above(b)], &[below(a)]), Some(a));
        assert_eq!(wall_between(&[above(a)], &[below(b), above(c)]), None);
    }

    #[test]
    fn absolute_values_are_found_in_any_form() {
        let by_logarithm = |arena: &Arena, [a, _]: [Expr; 2]| {
            let log = arena.call(Function::Log, &[arena.mul(a, a)]);
            arena.call(Function::Exp, &[arena.scale(log, &Rational::new(1, 2).unwrap())])
        };
        assert_eq!(cells(&[], by_logarithm), ["a > 0", "a < 0"]);
        // sqrt((|a| - 1)^2)
        let within = |arena: &Arena, [a, _]: [Expr; 2]| {
            let square = arena.mul(a, a);
            let root = arena.sqrt(square);
            arena.sqrt(arena.sum([square, arena.one(), arena.scale(root, &Rational::from(-2))]))
        };
        assert_eq!(cells(&[], within).len(), 4, "{:?}", cells(&[], within));
    }
}

//! Solves the equations of a manifold for some of their symbols, by the normal form.
//!
//! In: expressions that are zero, and symbols in groups, in the order in which they are solved for. Out: steps, each
//! for one symbol s that the later ones do not contain,
//!
//! ```text
//! s = middle                              if s has degree one
//! s = middle +- radicand^(1/degree)       if s has degree two, or occurs in one power alone
//! ```
//!
//! Where steps do not suffice, the equations are solved near the values that are drawn: as written, since eliminating
//! symbols makes degrees grow. Only those that give a symbol which no other holds are steps after that.

use std::collections::{BTreeMap, BTreeSet};
use std::rc::Rc;

use super::certified::System;
use super::manifold::{Manifold, Plans};
use super::solution::{Partner, Root, Solution, Step};
use crate::graph::arena::Arena;
use crate::graph::enclosure::Point;
use crate::graph::expr::{Expr, Symbol};
use crate::poly::Poly;
use crate::tower::{Field, Fraction, Obstacle};
use crate::{Facts, Rational};

/// A kernel, and the coefficients of its powers.
type KernelCoefficients = (u32, BTreeMap<u32, Fraction>);

/// The greatest power of a symbol for which a root is taken.
const MOST_DEGREE: u32 = 12;

impl Manifold {
    /// The manifold of these equations. The first of the groups must not occur in results, the last are constants.
    pub fn new(arena: &Arena, facts: &Facts, equations: Vec<Expr>, groups: Vec<BTreeSet<Symbol>>) -> Self {
        let solver = Solver { arena, facts, groups: &groups, confined: &BTreeSet::new(), exact: true };
        let exact = solver
            .solve(equations.clone())
            .unwrap_or_else(|_| Solution { open: equations.clone(), ..Solution::default() });
        Self { equations, groups, exact, plans: Plans::default() }
    }

    /// The manifold with values of symbols.
    pub(crate) fn substituted(&self, arena: &Arena, facts: &Facts, values: &Point) -> Self {
        self.of(arena, facts, arena.substitute_all(&self.equations, values))
    }

    /// The manifold of other equations, solved for the same symbols.
    #[must_use]
    pub fn of(&self, arena: &Arena, facts: &Facts, equations: Vec<Expr>) -> Self {
        Self::new(arena, facts, equations, self.groups.clone())
    }

    /// An equation that no exact step solves, if another one that is not solved for a single value shares a symbol with
    /// it, and no steps at all solve them: together they may hold in several ways though each of them does not.
    pub(crate) fn coupled(&self, arena: &Arena) -> Option<Expr> {
        let unsolved = self.unsolved(arena);
        let shares = |equation: &Expr| {
            let own = arena.symbols_of(&[*equation]);
            unsolved.iter().any(|other| other != equation && !arena.symbols_of(&[*other]).is_disjoint(&own))
        };
        let equation = self.exact.open.iter().copied().find(shares)?;
        let plan = self.plan(arena, &unsolved, &Point::new(), &BTreeSet::new());
        plan.is_none_or(|plan| plan.is_search()).then_some(equation)
    }

    /// True if every equation that concerns the point's symbols holds there exactly.
    pub(crate) fn contains(&self, arena: &Arena, point: &Point) -> bool {
        let concerned = |e: &&Expr| arena.symbols_of(&[**e]).iter().any(|symbol| point.contains_key(symbol));
        self.equations.iter().filter(concerned).all(|equation| {
            let value = arena.substitute(*equation, point);
            arena.symbols_of(&[value]).is_empty() && vanishes(arena, value)
        })
    }

    /// Steps that complete a point with these values; none where an equation cannot be solved, or cannot hold. They are
    /// for symbols between no bounds where that is possible: the value that a step gives rarely lies within narrow ones.
    pub(crate) fn plan(
        &self,
        arena: &Arena,
        equations: &[Expr],
        fixed: &Point,
        confined: &BTreeSet<Symbol>,
    ) -> Option<Rc<Solution>> {
        let equations = (arena.substitute_all(equations, fixed), confined.clone());
        if let Some(plan) = self.plans.borrow().get(&equations) {
            return plan.clone();
        }
        let facts = Facts::new();
        let solver = Solver { arena, facts: &facts, groups: &self.groups, confined, exact: false };
        let solution = solver.solve(equations.0.clone()).ok();
        let plan = solution.filter(|solution| solution.open.is_empty()).map(Rc::new);
        // With more work there may be one.
        if plan.is_some() || !arena.budget().is_exhausted() {
            self.plans.borrow_mut().insert(equations, plan.clone());
        }
        plan
    }
}

/// Tests whether an expression without symbols is zero.
fn vanishes(arena: &Arena, constant: Expr) -> bool {
    arena.is_zero(constant)
        || arena.is_satisfied(constant)
        || Field::over(arena, &Facts::new(), &[constant])
            .and_then(|field| field.fraction(constant))
            .is_ok_and(|fraction| fraction.is_zero())
}

impl Step {
    /// Tests whether the symbol has its value at a point, and a root of it is not zero.
    fn is_taken(&self, arena: &Arena, point: &Point) -> bool {
        let distance = arena.sub(arena.of_symbol(self.symbol), self.middle);
        let is_regular = self.root.is_none() || arena.separated_from_zero(distance, point).is_some();
        is_regular
            && arena.exists_at(self.middle, point)
            && vanishes(arena, arena.substitute(self.equation(arena), point))
    }
}

impl Solution {
    /// The values of the symbols that the steps give, where those of a start satisfy every step and no root vanishes.
    pub(crate) fn at(&self, arena: &Arena, point: &Point, start: &Point) -> Option<Point> {
        if self.is_search() {
            return None;
        }
        let values = self.steps.iter().map(|step| Some((step.symbol, *start.get(&step.symbol)?)));
        let values: Point = values.collect::<Option<_>>()?;
        let whole: Point = point.iter().chain(&values).map(|(symbol, value)| (*symbol, *value)).collect();
        self.steps.iter().all(|step| step.is_taken(arena, &whole)).then_some(values)
    }
}

/// Solves equations for symbols.
struct Solver<'a> {
    arena: &'a Arena,
    facts: &'a Facts,
    groups: &'a [BTreeSet<Symbol>],
    /// The symbols that are solved for last.
    confined: &'a BTreeSet<Symbol>,
    /// True if every solution has to be kept.
    exact: bool,
}

/// A candidate for a step; the one with the least cost is taken.
struct Candidate {
    /// True if the symbol is confined; true if the divisor is no number; the symbol's group; terms of the equation.
    cost: (bool, bool, usize, usize),
    equation: usize,
    step: Step,
}

impl Solver<'_> {
    fn solve(&self, equations: Vec<Expr>) -> Result<Solution, Obstacle> {
        let arena = self.arena;
        let mut open = equations.clone();
        let mut steps: Vec<Step> = Vec::new();
        loop {
            let ways = self.candidates(&mut open, &|degree| degree == 1)?;
            let Some(way) = ways.into_iter().min_by_key(|way| way.cost) else { break };
            open.remove(way.equation);
            let value = BTreeMap::from([(way.step.symbol, way.step.middle)]);
            open = arena.substitute_all(&open, &value);
            for step in &mut steps {
                step.middle = arena.substitute(step.middle, &value);
            }
            steps.push(way.step);
        }
        // Roots are not substituted into one another: each takes symbols that the roots before it do not contain.
        let mut held: BTreeSet<Symbol> = BTreeSet::new();
        loop {
            let mut ways = self.candidates(&mut open, &|degree| degree > 1)?;
            ways.retain(|way| !held.contains(&way.step.symbol));
            let Some(way) = ways.into_iter().min_by_key(|way| way.cost) else { break };
            held.extend(arena.symbols_of(&[open.remove(way.equation)]));
            steps.push(way.step);
        }
        if !self.exact && !open.is_empty() {
            let (steps, rest) = self.given(equations)?;
            if let Some(system) = System::new(arena, rest) {
                return Ok(Solution { steps, system, ..Solution::default() });
            }
        }
        self.join_partners(&mut steps)?;
        Ok(Solution { steps, open, ..Solution::default() })
    }

    /// Steps for symbols that one equation gives and no other holds, and the other equations. What they give is not drawn:
    /// a drawn value would draw the symbols of its formula to it.
    fn given(&self, mut equations: Vec<Expr>) -> Result<(Vec<Step>, Vec<Expr>), Obstacle> {
        let mut steps = Vec::new();
        loop {
            let mut ways = self.candidates(&mut equations, &|degree| degree == 1)?;
            let holders = |symbol| equations.iter().filter(|e| self.arena.symbols_of(&[**e]).contains(&symbol)).count();
            ways.retain(|way| !way.cost.1 && holders(way.step.symbol) == 1);
            let Some(way) = ways.into_iter().min_by_key(|way| way.cost) else { return Ok((steps, equations)) };
            equations.remove(way.equation);
            steps.push(way.step);
        }
    }

    /// The ways to solve the equations; those that hold everywhere are dropped.
    fn candidates(&self, open: &mut Vec<Expr>, wanted: &dyn Fn(u32) -> bool) -> Result<Vec<Candidate>, Obstacle> {
        let field = Field::over(self.arena, self.facts, open)?;
        let mut numerators = Vec::new();
        let mut left = Vec::new();
        for equation in open.iter() {
            let fraction = field.fraction(*equation)?;
            if !fraction.is_zero() && !self.arena.is_satisfied(*equation) {
                numerators.push(fraction.numerator().clone());
                left.push(self.without_idle_symbols(&field, *equation, &fraction)?);
            }
        }
        *open = left;
        let mut ways = Vec::new();
        for (equation, numerator) in numerators.iter().enumerate() {
            let occurring = self.arena.symbols_of(&[open[equation]]);
            let groups = self.groups.iter().enumerate().filter(|(place, _)| self.admits(*place, &occurring));
            for (place, symbol) in groups.flat_map(|(place, group)| group.iter().map(move |symbol| (place, *symbol))) {
                if !occurring.contains(&symbol) {
                    continue;
                }
                let step = match self.step(&field, numerator, symbol, wanted) {
                    // Of `a + |a|`, which is zero on one side: no divisor.
                    Err(Obstacle::DivisionByZero) => continue,
                    step => step?,
                };
                if let Some((step, divided)) = step {
                    let cost = (self.confined.contains(&symbol), !divided, place, numerator.term_count());
                    ways.push(Candidate { cost, equation, step });
                }
            }
        }
        Ok(ways)
    }

    /// The equation without symbols that cancel, if what it loses vanishes nowhere: `(v - w)/(2*k)` holds where `v - w`
    /// is zero, and so binds no k.
    fn without_idle_symbols(&self, field: &Field<'_>, equation: Expr, fraction: &Fraction) -> Result<Expr, Obstacle> {
        let kernels: Vec<Expr> = fraction.numerator().variables().iter().map(|kernel| field.kernel(*kernel)).collect();
        if self.arena.symbols_of(&kernels).len() >= self.arena.symbols_of(&[equation]).len() {
            return Ok(equation);
        }
        let denominator = field.of_polynomial(fraction.denominator())?;
        let is_safe = denominator.to_constant().is_some() || field.signs().is_positive(&denominator)?;
        Ok(if is_safe { field.show(&field.of_polynomial(fraction.numerator())?) } else { equation })
    }

    /// True if an equation with these symbols may be solved for those of a group: for constants if it holds no others.
    fn admits(&self, place: usize, occurring: &BTreeSet<Symbol>) -> bool {
        if !self.exact {
            return true;
        }
        let hidden = self.groups.first().is_some_and(|hidden| !hidden.is_disjoint(occurring));
        let is_of_constants = || self.groups.last().is_some_and(|constants| occurring.is_subset(constants));
        (place == 0 || !hidden) && (place + 1 < self.groups.len() || is_of_constants())
    }

    /// The step for a symbol that occurs in no kernel but its own, and true if its divisor is a number.
    fn step(
        &self,
        field: &Field<'_>,
        numerator: &Poly,
        symbol: Symbol,
        wanted: &dyn Fn(u32) -> bool,
    ) -> Result<Option<(Step, bool)>, Obstacle> {
        let Some((kernel, powers)) = self.powers_of(field, numerator, symbol)? else { return Ok(None) };
        let degree = numerator.degree(kernel);
        let inner = powers.iter().any(|(power, _)| *power > 0 && *power < degree);
        if !wanted(degree) || degree > MOST_DEGREE || (degree > 2 && inner) {
            return Ok(None);
        }
        let at = |power: u32| powers.get(&power).cloned().unwrap_or_else(Fraction::zero);
        let leading = at(degree);
        let number = leading.to_constant().is_some();
        if self.exact
            && !number
            && !field.signs().is_positive(&leading)?
            && !field.signs().is_positive(&leading.opposite())?
        {
            return Ok(None);
        }
        let constant = field.div(&at(0), &leading)?.opposite();
        if degree == 1 {
            return Ok(Some((Step { symbol, middle: field.show(&constant), root: None }, number)));
        }
        // Only a quadratic has a middle.
        let middle = match degree {
            2 => field.scale(&field.div(&at(1), &leading)?, &Rational::new(-1, 2).unwrap_or(Rational::ONE))?,
            _ => Fraction::zero(),
        };
        let radicand = field.show(&field.add(&constant, &field.mul(&middle, &middle)?)?);
        let root = Some(Root { degree, radicand, partner: None });
        Ok(Some((Step { symbol, middle: field.show(&middle), root }, number)))
    }

    /// The coefficients of the powers of a symbol, if it occurs in no kernel but its own.
    fn powers_of(
        &self,
        field: &Field<'_>,
        poly: &Poly,
        symbol: Symbol,
    ) -> Result<Option<KernelCoefficients>, Obstacle> {
        let kernels = field.kernels_of(&BTreeSet::from([symbol]));
        let mut kernels = poly.variables().iter().copied().filter(|kernel| kernels.contains(kernel));
        let (Some(kernel), None) = (kernels.next(), kernels.next()) else { return Ok(None) };
        if self.arena.as_symbol(field.kernel(kernel)) != Some(symbol) {
            return Ok(None);
        }
        let powers = poly.coefficients_in(kernel).into_iter();
        let powers = powers.map(|(power, coefficient)| Ok((power, field.of_polynomial(&coefficient)?)));
        Ok(Some((kernel, powers.collect::<Result<_, Obstacle>>()?)))
    }

    /// Gives each square root a symbol that no other step needs and in which the radicand is quadratic.
    fn join_partners(&self, steps: &mut [Step]) -> Result<(), Obstacle> {
        let arena = self.arena;
        if self.exact {
            return Ok(());
        }
        for index in 0..steps.len() {
            let Some(Root { degree: 2, radicand, .. }) = steps[index].root else { continue };
            let others = steps.iter().enumerate().filter(|(other, _)| *other != index);
            let taken: BTreeSet<Symbol> = others.flat_map(|(_, step)| step.needs(arena)).collect();
            let own: BTreeSet<Symbol> = steps.iter().map(|step| step.symbol).collect();
            let field = Field::over(arena, self.facts, &[radicand])?;
            let fraction = field.fraction(radicand)?;
            for symbol in arena.symbols_of(&[radicand]) {
                let kernels = field.kernels_of(&BTreeSet::from([symbol]));
                let divides = fraction.denominator().variables().iter().any(|kernel| kernels.contains(kernel));
                if divides || taken.contains(&symbol) || own.contains(&symbol) {
                    continue;
                }
                let Some((kernel, powers)) = self.powers_of(&field, fraction.numerator(), symbol)? else { continue };
                if fraction.numerator().degree(kernel) != 2 {
                    continue;
                }
                let denominator = field.of_polynomial(fraction.denominator())?;
                let shown = |power: u32| match powers.get(&power) {
                    Some(coefficient) => field.div(coefficient, &denominator).map(|quotient| field.show(&quotient)),
                    None => Ok(arena.zero()),
                };
                let coefficients = [shown(0)?, shown(1)?, shown(2)?];
                if let Some(root) = &mut steps[index].root {
                    root.partner = Some(Partner { symbol, coefficients });
                }
                break;
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Domain;
    use crate::Relation;
    use crate::domain::zero::{Answer, decide, is_zero};

    /// The domain of equations in a, b, c; p must not occur in results.
    fn domain(arena: &Arena, equations: &[Expr]) -> Domain {
        let group = |names: &[&str]| names.iter().map(|name| arena.symbol(name)).collect();
        let groups = vec![group(&["p"]), group(&["a", "b", "c"]), group(&["r"])];
        let manifold = Manifold::new(arena, &Facts::new(), equations.to_vec(), groups);
        Domain { manifold, ..Domain::default() }
    }

    fn symbols(arena: &Arena) -> [Expr; 4] {
        ["a", "b", "c", "p"].map(|name| arena.variable(name))
    }

    fn circle(arena: &Arena, squared: i64) -> Expr {
        let [a, b, ..] = symbols(arena);
        arena.sub(arena.add(arena.mul(a, a), arena.mul(b, b)), arena.number(squared))
    }

    #[test]
    fn expressions_on_a_circle_are_zero_or_have_a_witness_on_it() {
        let arena = Arena::new();
        let [a, b, c, p] = symbols(&arena);
        // A circle with rational points, one without.
        for squared in [1, 3] {
            let circle = circle(&arena, squared);
            let domain = domain(&arena, &[circle]);
            assert!(is_zero(&arena, arena.mul(circle, p), &domain));
            let quotient = arena.sub(arena.div(arena.number(squared), a), arena.add(a, arena.div(arena.mul(b, b), a)));
            assert!(is_zero(&arena, quotient, &domain));
            let Answer::NonZero(witness) = decide(&arena, arena.mul(a, c), &domain) else { panic!("a*c is not zero") };
            assert!(domain.contains(&arena, &witness.point), "{squared}: {:?}", witness.point);
            // Off the circle only: at its points this is r - squared = 0.
            assert!(!matches!(decide(&arena, arena.mul(circle, c), &domain), Answer::NonZero(_)));
        }
    }

    /// A symbol that one equation gives is not drawn: its value would draw the others to a point near it.
    #[test]
    fn what_one_equation_gives_follows_from_the_point() {
        let arena = Arena::new();
        let [a, b, c, _] = symbols(&arena);
        let r = arena.variable("r");
        // No formula solves the first: a^4 + b^4 + a b - 1.
        let power = |e| arena.power(e, &4.into());
        let oval = arena.sub(arena.sum([power(a), power(b), arena.mul(a, b)]), arena.one());
        let scaled = arena.sub(c, arena.scale(a, &1000.into()));
        let domain = domain(&arena, &[oval, scaled, arena.sub(r, arena.add(c, b))]);
        let plan =
            domain.manifold.plan(&arena, domain.manifold.equations(), &Point::new(), &BTreeSet::new()).expect("a plan");
        assert!(plan.is_search() && plan.symbols().len() == 2, "{:?}", plan.symbols());
        let points: Vec<Point> = domain.points(&arena, &[a, r]).take(5).collect();
        assert_eq!(points.len(), 5);
        assert!(points.iter().all(|point| domain.contains(&arena, point)));
    }

    /// A value that follows from others would rarely lie between its bounds.
    #[test]
    fn a_symbol_between_narrow_bounds_is_drawn() {
        let arena = Arena::new();
        let [a, b, c, p] = symbols(&arena);
        let mut domain = domain(&arena, &[arena.sub(a, arena.add(p, arena.mul(b, c)))]);
        let bound = |number: i64| arena.number(Rational::new(number, 1000).unwrap());
        domain.facts.assume(arena.sub(p, bound(100)), Relation::Positive);
        domain.facts.assume(arena.sub(bound(101), p), Relation::Positive);
        assert_eq!(domain.points(&arena, &[p]).take(5).count(), 5);
    }

    #[test]
    fn small_circles_have_points_too() {
        let arena = Arena::new();
        let [a, b, ..] = symbols(&arena);
        let far = arena.sub(a, arena.number(1000));
        let size = arena.number(Rational::new(1, 1_000_000).unwrap());
        let domain = domain(&arena, &[arena.sub(arena.add(arena.mul(far, far), arena.mul(b, b)), size)]);
        let points: Vec<Point> = domain.points(&arena, &[a]).take(5).collect();
        assert_eq!(points.len(), 5);
        for point in points {
            assert!(domain.contains(&arena, &point));
            assert!(point.values().all(|value| arena.as_number(*value).is_some()), "{point:?}");
        }
    }

    #[test]
    fn a_factor_that_may_vanish_loses_no_solution() {
        let arena = Arena::new();
        let [a, b, ..] = symbols(&arena);
        // a*b = 0 has two branches: neither a nor b is zero on both.
        let domain = domain(&arena, &[arena.mul(a, b)]);
        assert!(domain.manifold.open().is_some());
        assert!(!is_zero(&arena, a, &domain) && !is_zero(&arena, b, &domain));
        // a^2 = b^2 likewise: a - b vanishes on one branch, and one over it has no value there.
        let squares = arena.sub(arena.mul(a, a), arena.mul(b, b));
        let lines = self::domain(&arena, &[squares]);
        let difference = arena.sub(a, b);
        assert!(matches!(decide(&arena, difference, &lines), Answer::NonZero(_)));
        assert!(is_zero(&arena, squares, &lines));
    }

    #[test]
    fn an_equation_of_the_hidden_is_solved_for_the_hidden() {
        let arena = Arena::new();
        let [a, b, _, p] = symbols(&arena);
        // p = a - b, although a comes first by name.
        let domain = domain(&arena, &[arena.sub(arena.sub(a, b), p)]);
        assert_eq!(domain.manifold.steps()[0].symbol, arena.symbol("p"));
        assert!(domain.manifold.open().is_none());
        // For y = exp(p) the normal form has no p, but points exist.
        let curve = self::domain(&arena, &[arena.sub(a, arena.call(crate::Function::Exp, &[p]))]);
        assert!(curve.manifold.open().is_some());
        assert!(curve.points(&arena, &[a]).next().is_some());
    }

    #[test]
    fn signs_are_decided_on_the_manifold() {
        let arena = Arena::new();
        let [a, b, ..] = symbols(&arena);
        let sum = arena.add(arena.mul(a, a), arena.mul(b, b));
        assert!(domain(&arena, &[circle(&arena, 1)]).implies(&arena, sum, Relation::Positive));
        assert!(!Domain::default().implies(&arena, sum, Relation::Positive));
    }

    /// The domain with these values to start from.
    fn started(domain: Domain, start: &[(Expr, i64)], arena: &Arena) -> Domain {
        let start = start.iter().filter_map(|(e, value)| Some((arena.as_symbol(*e)?, arena.number(*value)))).collect();
        Domain { start, ..domain }
    }

    #[test]
    fn a_start_on_the_manifold_is_the_first_point() {
        let arena = Arena::new();
        let [a, b, c, _] = symbols(&arena);
        // A circle by steps, and a product far from values that are drawn.
        let mut far = domain(&arena, &[arena.sub(arena.mul(a, b), c)]);
        far.facts.assume(arena.sub(c, arena.number(1_000_000)), Relation::Positive);
        let circle = domain(&arena, &[circle(&arena, 25)]);
        assert!(far.points(&arena, &[a]).next().is_none());
        for (domain, start) in [(far, vec![(a, 2000), (b, 1000), (c, 2_000_000)]), (circle, vec![(a, -3), (b, 4)])] {
            let domain = started(domain, &start, &arena);
            let point = domain.points(&arena, &[a]).next().expect("the start");
            assert_eq!(point, domain.start);
        }
    }

    #[test]
    fn a_start_beside_the_manifold_leads_to_a_point_of_it() {
        let arena = Arena::new();
        let [a, b, c, _] = symbols(&arena);
        let mut far = domain(&arena, &[arena.sub(arena.mul(a, b), c)]);
        far.facts.assume(arena.sub(c, arena.number(1_000_000)), Relation::Positive);
        let far = started(far, &[(a, 2000), (b, 1000), (c, 5)], &arena);
        let point = far.points(&arena, &[a]).next().expect("a point near the start");
        assert!(far.contains(&arena, &point) && point != far.start);
        // Where a root vanishes, the manifold is no graph.
        let [tip, square] = [circle(&arena, 25), arena.mul(a, a)].map(|equation| domain(&arena, &[equation]));
        let tip = started(tip, &[(a, 0), (b, 5)], &arena);
        assert!(tip.points(&arena, &[a]).all(|point| tip.contains(&arena, &point)));
        let square = started(square, &[(a, 0)], &arena);
        assert!(square.points(&arena, &[a]).next().is_none());
    }

    #[test]
    fn equations_that_exclude_one_another_have_no_point() {
        let arena = Arena::new();
        let [a, b, ..] = symbols(&arena);
        let line = arena.add(a, b);
        let domain = domain(&arena, &[arena.sub(line, arena.one()), arena.sub(line, arena.number(2))]);
        assert!(domain.points(&arena, &[a]).next().is_none());
        let two = self::domain(&arena, &[circle(&arena, 1), arena.sub(a, arena.mul(b, b))]);
        // Solved one after the other or not at all: nothing outside counts as a point.
        assert!(two.points(&arena, &[a]).all(|point| two.contains(&arena, &point)));
    }
}

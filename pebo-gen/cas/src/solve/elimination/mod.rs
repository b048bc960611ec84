//! Symbols that solve equations: one equation at a time, for one symbol at a time.
//!
//! In: formulas that are to vanish, states and inputs to determine, and a check of the result. Out: the first values
//! that the check accepts, in symbols that remain free, or a formula that no rule makes vanish.
//!
//! Linear equations are solved combined first (`joint`). Then an equation is taken for a symbol in which one of its
//! factors is linear, which is replaced in all others; if there is none, a factor may be quadratic, or inverse
//! functions may help. A divisor that vanishes somewhere can lose solutions, never add one, and if a product vanishes,
//! each factor in turn is tried. So this is a search, and no elimination of a matrix, whose pivots might vanish.

mod joint;
mod values;

use std::cell::Cell;
use std::collections::{BTreeMap, BTreeSet};

use crate::poly::Poly;
use crate::tower::{Field, Fraction, Obstacle};
use crate::{Arena, Domain, Expr, Rational, Relation, Symbol};

use super::{Equation, solve};
use values::Values;

/// The problem: symbols to determine on a domain.
pub struct Elimination<'a> {
    /// Owns the formulas.
    pub arena: &'a Arena,
    /// The domain of the symbols.
    pub domain: &'a Domain,
    /// Symbols to determine first.
    pub states: BTreeSet<Symbol>,
    /// Symbols to determine by equations that the states leave over: the author would rather choose them.
    pub inputs: BTreeSet<Symbol>,
}

/// A factor of an equation.
struct EquationFactor {
    equation: usize,
    poly: Poly,
}

/// A symbol that makes a factor of an equation vanish.
struct EliminationStep {
    cost: Cost,
    equation: usize,
    symbol: Symbol,
    /// The factor's coefficients by powers of the symbol, the constant first: two, or three.
    coefficients: Vec<Fraction>,
}

/// The assumptions of a step; the step with the least is taken.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Cost {
    /// The factor's degree in the symbol: the number of its values.
    degree: u32,
    /// True if the symbol's factor holds states, which may vanish.
    divides_by_states: bool,
    /// True if the symbol is an input.
    input: bool,
    /// True if the factor holds inputs.
    holds_inputs: bool,
    /// Terms of factor and rest.
    terms: usize,
}

/// The greatest number of partial solutions of a search from one start. A search without alternatives visits as many as
/// there are symbols to determine.
const MOST_VISITS: usize = 100;

/// The greatest number of subexpressions of all equations combined: elimination makes them longer at each step, and
/// nobody reads a longer result.
const MOST_NODES: usize = 600;

/// The progress of the search from one start.
struct Progress {
    visits: Cell<usize>,
    /// True while linear equations are solved combined, until a consequence of that fails.
    combined: Cell<bool>,
}

/// The kernels of undetermined symbols.
struct UnknownKernels {
    symbols: BTreeSet<Symbol>,
    /// Those that depend on each symbol.
    of_each: BTreeMap<Symbol, BTreeSet<u32>>,
    of_states: BTreeSet<u32>,
    of_inputs: BTreeSet<u32>,
}

impl Elimination<'_> {
    /// The first solution that the check accepts, by the first of the starts that has one; else a formula that was not
    /// made to vanish. A start is a set of initial values.
    pub fn run<T>(
        &self,
        equations: &[Expr],
        starts: &[Values],
        accept: &mut impl FnMut(&Values) -> Option<T>,
    ) -> Result<Result<T, Expr>, Obstacle> {
        let mut stuck = None;
        let mut obstacle = None;
        for start in starts {
            let progress = Progress { visits: Cell::new(0), combined: Cell::new(true) };
            match self.search(equations, start, accept, &progress, &mut stuck) {
                Ok(Some(found)) => return Ok(Ok(found)),
                Ok(None) => {}
                Err(other) => obstacle = obstacle.or(Some(other)),
            }
        }
        match (stuck, obstacle) {
            (Some(stuck), _) => Ok(Err(stuck)),
            (None, Some(obstacle)) => Err(obstacle),
            (None, None) => Err(Obstacle::TooLarge),
        }
    }

    fn search<T>(
        &self,
        equations: &[Expr],
        values: &Values,
        accept: &mut impl FnMut(&Values) -> Option<T>,
        progress: &Progress,
        stuck: &mut Option<Expr>,
    ) -> Result<Option<T>, Obstacle> {
        progress.visits.set(progress.visits.get() + 1);
        if progress.visits.get() > MOST_VISITS {
            return Ok(None);
        }
        let arena = self.arena;
        let equations = arena.substitute_all(equations, values);
        if arena.postorder(&equations).len() > MOST_NODES {
            return Err(Obstacle::TooLarge);
        }
        let field = Field::over(arena, &self.domain.facts, &equations)?;
        let mut open = Vec::new();
        for equation in &equations {
            let fraction = field.fraction(*equation)?;
            if !fraction.is_zero() {
                open.push((field.show(&fraction), fraction));
            }
        }
        let Some((first, _)) = open.first() else { return Ok(accept(values)) };
        let formulas: Vec<Expr> = open.iter().map(|(formula, _)| *formula).collect();
        let unknown = self.unknown(&field, values);
        if progress.combined.get() {
            // Symbols without a combined solution may be found one at a time.
            let found = self.combined_states(&field, &open, &unknown).unwrap_or_default();
            // No equation is left if each gave a state: the check decides about them.
            if found.len() > 1
                && found.len() == open.len()
                && let Some(accepted) = accept(&extended(arena, values, &found))
            {
                return Ok(Some(accepted));
            }
            if found.len() > 1
                && let Ok(Some(accepted)) = self.advance(&formulas, values, &found, accept, (progress, &mut *stuck))
            {
                return Ok(Some(accepted));
            }
        }
        let mut factors = Vec::new();
        let kernels: Vec<u32> = unknown.of_states.union(&unknown.of_inputs).copied().collect();
        for (equation, (_, fraction)) in open.iter().enumerate() {
            let polys = fraction.numerator().factors_in(&kernels, field.limit())?;
            // No choice of the unknowns makes this one vanish.
            if polys.is_empty() {
                stuck.get_or_insert(open[equation].0);
                return Ok(None);
            }
            factors.extend(polys.into_iter().map(|poly| EquationFactor { equation, poly }));
        }
        let alternatives = self.alternatives(&field, &open, &factors, &unknown, progress.combined.get())?;
        for found in alternatives {
            // If another equation has no value, or is not understood, there may be a better alternative.
            match self.advance(&formulas, values, &found, accept, (progress, &mut *stuck)) {
                Ok(None) | Err(Obstacle::DivisionByZero | Obstacle::Kernel(_)) => {}
                found => return found,
            }
        }
        stuck.get_or_insert(*first);
        Ok(None)
    }

    /// Continues with the values found. If several at once fail, the search continues one at a time, as if they had not
    /// been tried.
    fn advance<T>(
        &self,
        formulas: &[Expr],
        values: &Values,
        found: &Values,
        accept: &mut impl FnMut(&Values) -> Option<T>,
        (progress, stuck): (&Progress, &mut Option<Expr>),
    ) -> Result<Option<T>, Obstacle> {
        let (visits, before) = (progress.visits.get(), *stuck);
        let result = self.search(formulas, &extended(self.arena, values, found), accept, progress, stuck);
        if found.len() > 1 && !matches!(result, Ok(Some(_))) {
            progress.combined.set(false);
            progress.visits.set(visits);
            *stuck = before;
            return Ok(None);
        }
        result
    }

    /// The states that linear equations combined determine, with inputs in their coefficients.
    fn combined_states(
        &self,
        field: &Field<'_>,
        open: &[(Expr, Fraction)],
        unknown: &UnknownKernels,
    ) -> Result<Values, Obstacle> {
        let equations = open.iter().map(|(_, fraction)| fraction.numerator().clone());
        joint::solved(self.arena, field, equations, &unknown.of_states, [&BTreeSet::new(), &unknown.of_inputs])
    }

    /// The undetermined symbols, states and inputs, and their kernels.
    fn unknown(&self, field: &Field<'_>, values: &Values) -> UnknownKernels {
        let open = |symbols: &BTreeSet<Symbol>| -> BTreeSet<Symbol> {
            symbols.iter().copied().filter(|s| !values.contains_key(s)).collect()
        };
        let (states, inputs) = (open(&self.states), open(&self.inputs));
        let symbols: BTreeSet<Symbol> = states.union(&inputs).copied().collect();
        let of_each = symbols.iter().map(|symbol| (*symbol, field.kernels_of(&BTreeSet::from([*symbol])))).collect();
        UnknownKernels { of_each, of_states: field.kernels_of(&states), of_inputs: field.kernels_of(&inputs), symbols }
    }

    /// The alternatives to make one equation vanish, the one that assumes least first; before them several at once, if
    /// inputs are to be found.
    fn alternatives(
        &self,
        field: &Field<'_>,
        open: &[(Expr, Fraction)],
        factors: &[EquationFactor],
        unknown: &UnknownKernels,
        combined: bool,
    ) -> Result<Vec<Values>, Obstacle> {
        let mut steps = Vec::new();
        for factor in factors {
            self.steps(field, factor, unknown, &mut steps)?;
        }
        steps.sort_by_key(|step| step.cost);
        let chosen = steps.first().map(|step| step.equation);
        let mut found = Vec::new();
        let mut several = Values::new();
        if combined
            && steps
                .first()
                .is_some_and(|step| step.cost.input && step.cost.degree == 1 && !step.cost.divides_by_states)
        {
            let equations = open.iter().map(|(_, fraction)| fraction.numerator().clone());
            let solved =
                joint::solved(self.arena, field, equations, &unknown.of_inputs, [&unknown.of_states, &BTreeSet::new()]);
            several = solved.unwrap_or_default();
        }
        for step in steps.iter().filter(|step| Some(step.equation) == chosen) {
            found.extend(self.values(field, step)?.into_iter().map(|value| (step.symbol, value)));
        }
        if chosen.is_none() {
            let combined: Vec<Expr> = open.iter().map(|(formula, _)| *formula).collect();
            found.extend(self.inverted(&combined, &unknown.symbols)?);
        }
        for factor in factors.iter().filter(|factor| chosen.is_none_or(|chosen| factor.equation == chosen)) {
            let formula = field.show(&field.of_polynomial(&factor.poly)?);
            found.extend(self.inverted(&[formula], &unknown.symbols)?);
            // For each state by itself too, as if the others were given.
            for symbol in &unknown.symbols {
                found.extend(self.inverted(&[formula], &BTreeSet::from([*symbol]))?);
            }
        }
        let several = Some(several).filter(|several| several.len() > 1);
        Ok(several.into_iter().chain(found.into_iter().map(|one| Values::from([one]))).collect())
    }

    /// The symbols with first or second power in a factor, in no kernel but themselves.
    fn steps(
        &self,
        field: &Field<'_>,
        factor: &EquationFactor,
        unknown: &UnknownKernels,
        steps: &mut Vec<EliminationStep>,
    ) -> Result<(), Obstacle> {
        let arena = self.arena;
        for (symbol, kernels) in &unknown.of_each {
            let mut kernels = factor.poly.variables().iter().copied().filter(|kernel| kernels.contains(kernel));
            let (Some(kernel), None) = (kernels.next(), kernels.next()) else { continue };
            let degree = factor.poly.degree(kernel);
            if degree > 2 || arena.as_symbol(field.kernel(kernel)) != Some(*symbol) {
                continue;
            }
            let mut coefficients = vec![Fraction::zero(); degree as usize + 1];
            for (power, coefficient) in factor.poly.collect(&[kernel]) {
                let exponent = power.powers().first().map_or(0, |(_, exponent)| *exponent);
                coefficients[exponent as usize] = field.of_polynomial(&coefficient)?;
            }
            let nowhere_zero = || self.domain.implies(arena, arena.of_symbol(*symbol), Relation::NonZero);
            if coefficients[0].is_zero() && nowhere_zero() {
                continue;
            }
            let slope = &coefficients[degree as usize];
            let holds = |kernels: &BTreeSet<u32>| slope.variables().any(|kernel| kernels.contains(&kernel));
            let cost = Cost {
                degree,
                divides_by_states: holds(&unknown.of_states),
                input: self.inputs.contains(symbol),
                holds_inputs: holds(&unknown.of_inputs),
                terms: coefficients.iter().map(|c| c.numerator().term_count()).sum(),
            };
            steps.push(EliminationStep { cost, equation: factor.equation, symbol: *symbol, coefficients });
        }
        Ok(())
    }

    /// The roots of a step's polynomial.
    fn values(&self, field: &Field<'_>, step: &EliminationStep) -> Result<Vec<Expr>, Obstacle> {
        let arena = self.arena;
        let [constant, slope, curvature @ ..] = step.coefficients.as_slice() else { return Ok(Vec::new()) };
        let [curvature] = curvature else { return Ok(vec![field.show(&field.div(constant, slope)?.opposite())]) };
        let middle = field.div(slope, &field.scale(curvature, &Rational::from(-2))?)?;
        let apart = field.sub(&field.mul(&middle, &middle)?, &field.div(constant, curvature)?)?;
        let (middle, apart) = (field.show(&middle), arena.sqrt(field.show(&apart)));
        Ok(vec![arena.add(middle, apart), arena.sub(middle, apart)])
    }

    /// States that inverse functions give.
    fn inverted(&self, formulas: &[Expr], unknown: &BTreeSet<Symbol>) -> Result<Vec<(Symbol, Expr)>, Obstacle> {
        let arena = self.arena;
        let unknown: Vec<Symbol> = unknown.intersection(&self.states).copied().collect();
        let equations: Vec<Equation> =
            formulas.iter().map(|formula| Equation { formula: *formula, value: arena.zero() }).collect();
        let candidates = solve(arena, self.domain, &equations, &unknown)?;
        let free = |(symbol, values): (Symbol, Vec<Expr>)| {
            values
                .into_iter()
                .filter(|value| !arena.depends_on(*value, &BTreeSet::from([symbol])))
                .map(|value| (symbol, value))
                .collect::<Vec<_>>()
        };
        Ok(candidates.into_iter().flat_map(free).collect())
    }
}

/// Values with more of them, which replace their symbols in the others.
fn extended(arena: &Arena, values: &Values, more: &Values) -> Values {
    let known = values.iter().map(|(symbol, known)| (*symbol, arena.substitute(*known, more)));
    known.chain(more.iter().map(|(symbol, value)| (*symbol, *value))).collect()
}

//! Conditions under which rows of full rank, with constant inputs or at rest, lose it: values of inputs, values of
//! parameters, and zeros of formulas of several signals. They are read off the determinant of the rows, and off their
//! entries.

use std::collections::{BTreeMap, BTreeSet};

use crate::analysis::design::{BlindTrajectory, TrajectoryCondition};
use crate::analysis::identifiability::flow::{Flow, without_psi};
use crate::analysis::identifiability::singular::{Volume, ZeroSet};
use pebo_cas::poly::Poly;
use pebo_cas::tower::{Field, Obstacle};
use pebo_cas::{Arena, Domain, Expr, Relation, Symbol};

use super::problem::{Restriction, TrajectoryProblem};

impl TrajectoryProblem<'_> {
    /// Values of parameters at which rows that have full rank with constant inputs lose it, but for those that are
    /// conditions.
    pub(super) fn coincidences(&self, stack: &[Vec<Expr>], conditions: &[Expr]) -> Vec<(Symbol, Expr)> {
        let arena = &self.plant.arena;
        let zero_set = self.check_size(stack).and_then(|()| self.zero_set(self.domain, stack)).unwrap_or_default();
        let open = zero_set.constants.into_iter().filter(|formula| !conditions.contains(formula));
        let value = |formula: Expr| {
            let mut parameters = arena.symbols_of(&[formula]).into_iter();
            parameters.find_map(|parameter| Some((parameter, solved(arena, formula, parameter)?)))
        };
        open.filter_map(value).collect()
    }

    /// Further conditions under which rows of full rank with constant inputs may lose it: where an input is a function
    /// of others, the unknowns are decided there; the rest is undecided. And true if there are no other such
    /// trajectories: a trajectory that leaves the zero at once is none, and a zero of several signals is listed only if
    /// it is invariant.
    pub(super) fn doubtful(&self, listed: &[BlindTrajectory], stack: &[Vec<Expr>]) -> (Vec<BlindTrajectory>, bool) {
        let &Self { plant, domain, .. } = self;
        let arena = &plant.arena;
        if self.is_constant(stack) {
            return (Vec::new(), true);
        }
        let Ok(zero_set) = self.zero_set(domain, stack) else { return (Vec::new(), false) };
        let constants: BTreeSet<Symbol> = plant.parameters.iter().map(|p| p.symbol).collect();
        let held: BTreeSet<Symbol> = plant.commanded().collect();
        let known: BTreeSet<Symbol> = constants.union(&held).copied().collect();
        let flow = Flow::along(plant, domain, self.cascade, &held, &BTreeMap::new());
        let mut found = Vec::new();
        let mut all = zero_set.all;
        for zero in zero_set.zeros {
            let undecided = || BlindTrajectory::undecided(TrajectoryCondition::Undecided(zero));
            if !arena.symbols_of(&[zero]).is_subset(&known) {
                let is_one = || arena.symbols_of(&[zero]).difference(&constants).count() == 1;
                let is_kept = || flow.as_ref().is_ok_and(|flow| self.is_invariant(zero, flow.rate(arena, zero)));
                match self.at_zero(zero, &held, listed) {
                    Ok((decided, complete)) => {
                        all &= complete;
                        found.extend(decided);
                    }
                    Err(_) if is_one() || is_kept() => found.push(undecided()),
                    Err(_) => all = false,
                }
                continue;
            }
            let one = |input: Symbol| {
                let steep = domain.implies(arena, arena.derivative(zero, input), Relation::NonZero);
                solved(arena, zero, input).filter(|_| steep)
            };
            let Some((input, value)) = plant.commanded().find_map(|input| Some((input, one(input)?))) else {
                found.push(undecided());
                continue;
            };
            if is_listed(arena, listed, zero) {
                continue;
            }
            let equal = BTreeMap::from([(input, value)]);
            match self.solve(&Restriction { equal, ..Restriction::default() }) {
                // Inputs that identify unknowns by their variation may not do so as constants.
                Ok(observed) if observed.hidden.is_empty() => match self.steady(input, value) {
                    Ok(observed) if observed.hidden.is_empty() => {}
                    Ok(observed) => found.push(self.blind(TrajectoryCondition::Steady(input, value), &observed)),
                    Err(Obstacle::NoPoint) => {}
                    Err(_) => found.push(undecided()),
                },
                Ok(observed) => found.push(self.blind(TrajectoryCondition::Value(input, value), &observed)),
                // The domain holds no such trajectory.
                Err(Obstacle::NoPoint) => {}
                Err(_) => found.push(undecided()),
            }
        }
        (found, all)
    }

    /// Factors in inputs alone that all entries of a column have: while one is zero, that unknown moves no output.
    pub(super) fn columns(&self) -> Result<Vec<Expr>, Obstacle> {
        let &Self { plant, domain, regression, unknowns, .. } = self;
        let arena = &plant.arena;
        let rows = [without_psi(plant, &regression.phi_1), without_psi(plant, &regression.primitive_1)].concat();
        let constants: BTreeSet<Symbol> = plant.parameters.iter().map(|p| p.symbol).collect();
        let commanded: BTreeSet<Symbol> = plant.commanded().collect();
        let of_inputs = |formula: Expr| {
            let symbols = arena.symbols_of(&[formula]);
            !symbols.is_disjoint(&commanded) && symbols.iter().all(|s| commanded.contains(s) || constants.contains(s))
        };
        let field = Field::over(arena, &domain.facts, &rows.concat())?;
        let mut found = Vec::new();
        for column in 0..unknowns {
            let entries = rows.iter().map(|row| field.fraction(row[column])).collect::<Result<Vec<_>, _>>()?;
            let Some(first) = entries.iter().find(|entry| !entry.is_zero()) else { continue };
            for (factor, _) in first.numerator().factored(field.limit())?.factors {
                let formula = field.show(&field.of_polynomial(&factor)?);
                if !of_inputs(formula) || found.contains(&formula) || domain.implies(arena, formula, Relation::NonZero)
                {
                    continue;
                }
                let mut divides = true;
                for entry in &entries {
                    divides &= entry.is_zero() || entry.numerator().div_exact(&factor, field.limit())?.is_some();
                }
                if divides {
                    found.push(formula);
                }
            }
        }
        Ok(found)
    }

    /// Zeros at which rows lose their rank and that no input moves: an output that is constant, or one that multiplies
    /// its own rate.
    pub(super) fn kept(&self, stack: &[Vec<Expr>]) -> Vec<Expr> {
        let &Self { plant, domain, .. } = self;
        let arena = &plant.arena;
        // A signal without a rate is as free as an input.
        let constants = plant.parameters.iter().map(|p| p.symbol);
        let determined: BTreeSet<Symbol> =
            constants.chain(plant.rates().into_keys()).chain(plant.chi.clone()).collect();
        let found = || -> Result<Vec<Expr>, Obstacle> {
            self.check_size(stack)?;
            let zeros = self.zero_set(domain, stack)?.zeros;
            let flow = Flow::along(plant, domain, self.cascade, &BTreeSet::new(), &BTreeMap::new())?;
            let is_kept = |zero: &Expr| {
                arena.symbols_of(&[*zero]).is_subset(&determined) && self.is_invariant(*zero, flow.rate(arena, *zero))
            };
            Ok(zeros.into_iter().filter(is_kept).collect())
        };
        found().unwrap_or_default()
    }

    /// Tests whether the rows are the same on all trajectories.
    fn is_constant(&self, stack: &[Vec<Expr>]) -> bool {
        let constants: BTreeSet<Symbol> = self.plant.parameters.iter().map(|p| p.symbol).collect();
        self.plant.arena.symbols_of(&stack.concat()).is_subset(&constants)
    }

    /// Tests whether a zero is invariant: the formula divides its rate.
    fn is_invariant(&self, zero: Expr, rate: Expr) -> bool {
        let &Self { plant, domain, .. } = self;
        let divides = || -> Result<bool, Obstacle> {
            let field = Field::on(&plant.arena, domain, &[zero, rate])?;
            let (zero, rate) = (field.fraction(zero)?, field.fraction(rate)?);
            Ok(rate.numerator().div_exact(zero.numerator(), field.limit())?.is_some())
        };
        divides().unwrap_or(false)
    }

    /// The zeros of the determinant of rows of full rank.
    fn zero_set(&self, domain: &Domain, stack: &[Vec<Expr>]) -> Result<ZeroSet, Obstacle> {
        Volume::of(&self.plant.arena, domain, stack)?.zero_set(self.plant, domain)
    }

    /// Zeros at which rows that have full rank on a family of equilibria lose it; and true if there are no others.
    pub(super) fn doubtful_at_rest(&self, domain: &Domain, stack: &[Vec<Expr>]) -> (Vec<Expr>, bool) {
        if self.is_constant(stack) {
            return (Vec::new(), true);
        }
        let zero_set = self.check_size(stack).and_then(|()| self.zero_set(domain, stack));
        let Ok(zero_set) = zero_set else { return (Vec::new(), false) };
        (zero_set.zeros, zero_set.all)
    }

    /// Values of inputs at which an entry vanishes.
    pub(super) fn values(&self, stack: &[Vec<Expr>]) -> Result<Vec<(Symbol, Expr)>, Obstacle> {
        let arena = &self.plant.arena;
        let constants: BTreeSet<Symbol> = self.plant.parameters.iter().map(|p| p.symbol).collect();
        let commanded: BTreeSet<Symbol> = self.plant.commanded().collect();
        let entries: Vec<Expr> = stack.concat();
        let field = Field::over(arena, &self.domain.facts, &entries)?;
        let mut found = Vec::new();
        for entry in entries {
            for (factor, _) in field.fraction(entry)?.numerator().factored(field.limit())?.factors {
                for &variable in factor.variables().iter().filter(|v| factor.degree(**v) == 1) {
                    let Some(input) = arena.as_symbol(field.kernel(variable)) else { continue };
                    let coefficients = factor.coefficients_in(variable);
                    let (slope, rest) = match coefficients.as_slice() {
                        [(_, slope), (_, rest)] => (slope.clone(), rest.clone()),
                        [(_, slope)] => (slope.clone(), Poly::zero()),
                        _ => continue,
                    };
                    if !field.signs().never_zero(&slope) {
                        continue;
                    }
                    let value = field.show(&field.quotient(&-&rest, &slope)?);
                    let plain = arena.symbols_of(&[value]).is_subset(&constants);
                    if plain && commanded.contains(&input) && !found.contains(&(input, value)) {
                        found.push((input, value));
                    }
                }
            }
        }
        Ok(found)
    }

    /// Combinations of the parameters at which rows that have full rank on some trajectories lose it on all, and true
    /// if there are no other such values.
    pub(super) fn constants(&self, stack: &[Vec<Expr>]) -> Result<(Vec<Expr>, bool), Obstacle> {
        let arena = &self.plant.arena;
        let own: BTreeSet<Symbol> = self.plant.parameters.iter().map(|p| p.symbol).collect();
        let degenerate = self.degenerate_identities(&own)?;
        if arena.symbols_of(&stack.concat()).is_disjoint(&own) && degenerate.is_empty() {
            return Ok((Vec::new(), true));
        }
        let zero_set = self.zero_set(self.domain, stack)?;
        let mut all = zero_set.all && !zero_set.joint;
        let mut lost = Vec::new();
        let others = degenerate.into_iter().filter(|formula| !zero_set.constants.contains(formula));
        for formula in others.chain(zero_set.constants.iter().copied()) {
            let parameters = arena.symbols_of(&[formula]);
            let solved =
                parameters.iter().find_map(|parameter| Some((*parameter, solved(arena, formula, *parameter)?)));
            let there = solved.map(|solved| Restriction { equal: BTreeMap::from([solved]), ..Restriction::default() });
            let Some(there) = there else {
                lost.push(formula);
                continue;
            };
            match self.further_values(&there) {
                // Other trajectories identify them all the same, but perhaps not for further values.
                Ok(Some(further)) => all &= !further,
                Ok(None) => lost.push(formula),
                // Undecided: the verdict says that such values were not all worked out.
                Err(_) => all = false,
            }
        }
        Ok((lost, all))
    }

    /// Combinations of the parameters at whose zeros an identity does not determine the rate that it is solved for: the
    /// rows, which hold that rate, are others there.
    fn degenerate_identities(&self, parameters: &BTreeSet<Symbol>) -> Result<Vec<Expr>, Obstacle> {
        let (arena, domain) = (&self.plant.arena, self.domain);
        let divisors = Flow::new(self.plant, domain, self.cascade)?.divisors;
        let field = Field::over(arena, &domain.facts, &divisors)?;
        let mut found = Vec::new();
        for divisor in divisors {
            for (factor, _) in field.fraction(divisor)?.numerator().factored(field.limit())?.factors {
                let formula = field.show(&field.of_polynomial(&factor)?);
                let is_constant = arena.symbols_of(&[formula]).is_subset(parameters);
                if is_constant && !found.contains(&formula) && !domain.implies(arena, formula, Relation::NonZero) {
                    found.push(formula);
                }
            }
        }
        Ok(found)
    }

    /// Tests whether further values of the parameters may hide unknowns that are identifiable with a restriction; none
    /// if they are not identifiable.
    fn further_values(&self, restriction: &Restriction) -> Result<Option<bool>, Obstacle> {
        let &Self { plant, domain, .. } = self;
        // At values of the parameters that the formula allows, not at those of the file, where it need not vanish.
        let parameters = restriction.equal.iter().flat_map(|(symbol, value)| {
            plant.arena.symbols_of(&[*value]).into_iter().chain([*symbol]).collect::<Vec<_>>()
        });
        let mut free = domain.clone();
        for parameter in parameters {
            free.fixed.remove(&parameter);
        }
        let domain = free.restricted(&plant.arena, &restriction.equal).ok_or(Obstacle::NoPoint)?;
        let observed = self.solve_on(&domain, restriction)?;
        if !observed.hidden.is_empty() {
            return Ok(None);
        }
        let zero_set = self.zero_set(&domain, &observed.stack).ok();
        Ok(Some(zero_set.is_none_or(|zero_set| !zero_set.all || zero_set.joint || !zero_set.constants.is_empty())))
    }
}

/// Tests whether a zero at a value of an input is already listed.
pub(super) fn is_listed(arena: &Arena, listed: &[BlindTrajectory], zero: Expr) -> bool {
    listed.iter().any(|other| match &other.condition {
        TrajectoryCondition::Value(one, at) => arena.is_zero(arena.substitute(zero, &BTreeMap::from([(*one, *at)]))),
        _ => false,
    })
}

/// The value of the symbol at the zero of a formula that is linear in it.
fn solved(arena: &Arena, formula: Expr, symbol: Symbol) -> Option<Expr> {
    let slope = arena.derivative(formula, symbol);
    let linear = !arena.is_zero(slope) && !arena.depends_on(slope, &BTreeSet::from([symbol]));
    let rest = arena.substitute(formula, &BTreeMap::from([(symbol, arena.zero())]));
    linear.then(|| arena.neg(arena.div(rest, slope)))
}

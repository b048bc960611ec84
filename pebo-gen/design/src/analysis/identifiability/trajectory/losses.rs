//! Conditions under which rows of full rank, with constant inputs or at rest, lose it: values of inputs, values of
//! parameters, and zeros of formulas of several signals. They are read off the determinant of the rows, and off their
//! entries.

use std::collections::{BTreeMap, BTreeSet};

use crate::analysis::design::{Blind, Place};
use crate::analysis::identifiability::flow::{Flow, without_psi};
use crate::analysis::identifiability::singular::Volume;
use pebo_cas::poly::Poly;
use pebo_cas::tower::{Field, Obstacle};
use pebo_cas::{Arena, Expr, Relation, Symbol};

use super::problem::{Question, Restriction, Shown, seen};

/// Size of the rows up to which their determinant is worked out.
pub(super) const MOST_OF_DETERMINANT: usize = 150;

impl Question<'_> {
    /// Values of parameters at which rows that have full rank with constant inputs lose it, but for those that are
    /// conditions.
    pub(super) fn coincidences(&self, stack: &[Vec<Expr>], conditions: &[Expr]) -> Vec<(Symbol, Expr)> {
        let arena = &self.plant.arena;
        if arena.postorder(&stack.concat()).len() > MOST_OF_DETERMINANT {
            return Vec::new();
        }
        let volume = Volume::of(arena, self.domain, stack);
        let places = volume.and_then(|volume| volume.places(self.plant, self.domain)).unwrap_or_default();
        let open = places.constants.into_iter().filter(|formula| !conditions.contains(formula));
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
    pub(super) fn doubtful(&self, listed: &[Blind], symbols: &[Symbol], stack: &[Vec<Expr>]) -> (Vec<Blind>, bool) {
        let &Self { plant, domain, .. } = self;
        let arena = &plant.arena;
        if self.is_constant(stack) {
            return (Vec::new(), true);
        }
        let volume = Volume::of(arena, domain, stack);
        let Ok(places) = volume.and_then(|volume| volume.places(plant, domain)) else { return (Vec::new(), false) };
        let constants: BTreeSet<Symbol> = plant.parameters.iter().map(|p| p.symbol).collect();
        let held: BTreeSet<Symbol> = plant.commanded().collect();
        let known: BTreeSet<Symbol> = constants.union(&held).copied().collect();
        let flow = Flow::along(plant, domain, self.cascade, &held, &BTreeMap::new());
        let blind = |place: Place, shown: Shown| Blind {
            place,
            seen: seen(arena, symbols, &shown.hidden),
            hidden: shown.hidden,
        };
        let mut found = Vec::new();
        let mut all = places.all;
        for zero in places.zeros {
            let unshown = || Blind { place: Place::Unshown(zero), seen: Vec::new(), hidden: Vec::new() };
            let symbols_there = arena.symbols_of(&[zero]);
            if !symbols_there.is_subset(&known) {
                let alone = symbols_there.difference(&constants).count() == 1;
                let rate = flow.as_ref().ok().map(|flow| flow.rate(arena, zero));
                if rate.is_some_and(|rate| self.leaves(zero, rate)) {
                    continue;
                }
                if alone || rate.is_some_and(|rate| self.stays(zero, rate)) {
                    found.push(unshown());
                } else {
                    all = false;
                }
                continue;
            }
            let one = |input: Symbol| {
                let steep = domain.implies(arena, arena.derivative(zero, input), Relation::NonZero);
                solved(arena, zero, input).filter(|_| steep)
            };
            let Some((input, value)) = plant.commanded().find_map(|input| Some((input, one(input)?))) else {
                found.push(unshown());
                continue;
            };
            if is_listed(arena, listed, zero) {
                continue;
            }
            let equal = BTreeMap::from([(input, value)]);
            match self.shown(&Restriction { equal, ..Restriction::default() }) {
                // Inputs that identify unknowns by their variation may not do so as constants.
                Ok(shown) if shown.hidden.is_empty() => match self.steady(input, value) {
                    Ok(shown) if shown.hidden.is_empty() => {}
                    Ok(shown) => found.push(blind(Place::Steady(input, value), shown)),
                    Err(Obstacle::NoPoint) => {}
                    Err(_) => found.push(unshown()),
                },
                Ok(shown) => found.push(blind(Place::Value(input, value), shown)),
                // The domain holds no such trajectory.
                Err(Obstacle::NoPoint) => {}
                Err(_) => found.push(unshown()),
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
        if arena.postorder(&stack.concat()).len() > MOST_OF_DETERMINANT {
            return Vec::new();
        }
        // A signal without a rate is as free as an input.
        let constants = plant.parameters.iter().map(|p| p.symbol);
        let determined: BTreeSet<Symbol> =
            constants.chain(plant.rates().into_keys()).chain(plant.chi.clone()).collect();
        let found = || -> Result<Vec<Expr>, Obstacle> {
            let zeros = Volume::of(arena, domain, stack)?.places(plant, domain)?.zeros;
            let flow = Flow::along(plant, domain, self.cascade, &BTreeSet::new(), &BTreeMap::new())?;
            let is_kept = |zero: &Expr| {
                arena.symbols_of(&[*zero]).is_subset(&determined) && self.stays(*zero, flow.rate(arena, *zero))
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

    /// Tests whether every trajectory leaves a zero at once.
    fn leaves(&self, zero: Expr, rate: Expr) -> bool {
        let &Self { plant, domain, .. } = self;
        let arena = &plant.arena;
        let there = |symbol: Symbol| {
            let equal = BTreeMap::from([(symbol, solved(arena, zero, symbol)?)]);
            let is_one = domain.implies(arena, arena.derivative(zero, symbol), Relation::NonZero);
            let domain = domain.restricted(arena, &equal).filter(|_| is_one)?;
            Some(domain.implies(arena, arena.substitute(rate, &equal), Relation::NonZero))
        };
        if arena.postorder(&[rate]).len() > MOST_OF_DETERMINANT {
            return false;
        }
        domain.implies(arena, rate, Relation::NonZero)
            || arena.symbols_of(&[zero]).into_iter().find_map(there).unwrap_or(false)
    }

    /// Tests whether a zero is invariant: the formula divides its rate.
    fn stays(&self, zero: Expr, rate: Expr) -> bool {
        let &Self { plant, domain, .. } = self;
        let divides = || -> Result<bool, Obstacle> {
            let field = Field::on(&plant.arena, domain, &[zero, rate])?;
            let (zero, rate) = (field.fraction(zero)?, field.fraction(rate)?);
            Ok(rate.numerator().div_exact(zero.numerator(), field.limit())?.is_some())
        };
        divides().unwrap_or(false)
    }

    /// Zeros at which rows that have full rank at rest lose it, each of which is invariant there; and true if there are
    /// no others.
    pub(super) fn doubtful_at_rest(&self, stack: &[Vec<Expr>]) -> (Vec<Expr>, bool) {
        let &Self { plant, domain, .. } = self;
        let arena = &plant.arena;
        if self.is_constant(stack) {
            return (Vec::new(), true);
        }
        if arena.postorder(&stack.concat()).len() > MOST_OF_DETERMINANT {
            return (Vec::new(), false);
        }
        let volume = Volume::of(arena, domain, stack);
        let Ok(places) = volume.and_then(|volume| volume.places(plant, domain)) else { return (Vec::new(), false) };
        let constants: BTreeSet<Symbol> = plant.parameters.iter().map(|p| p.symbol).collect();
        let commanded: BTreeSet<Symbol> = plant.commanded().collect();
        // Functions of inputs alone are tested on all trajectories.
        let of_outputs = |zero: &Expr| {
            let symbols = arena.symbols_of(&[*zero]);
            symbols.difference(&constants).any(|signal| !commanded.contains(signal))
        };
        (places.zeros.into_iter().filter(of_outputs).collect(), places.all)
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
        if arena.symbols_of(&stack.concat()).is_disjoint(&own) {
            return Ok((Vec::new(), true));
        }
        let places = Volume::of(arena, self.domain, stack)?.places(self.plant, self.domain)?;
        let mut all = places.all && !places.together;
        let mut lost = Vec::new();
        for formula in places.constants {
            let solved = arena
                .symbols_of(&[formula])
                .into_iter()
                .find_map(|parameter| Some((parameter, solved(arena, formula, parameter)?)));
            let there = solved.map(|solved| Restriction { equal: BTreeMap::from([solved]), ..Restriction::default() });
            let Some(there) = there else {
                lost.push(formula);
                continue;
            };
            match self.shown_with(&there) {
                // Other trajectories identify them all the same, but perhaps not for further values.
                Ok(Some(further)) => all &= !further,
                Ok(None) => lost.push(formula),
                // Undecided: the verdict says that such values were not all worked out.
                Err(_) => all = false,
            }
        }
        Ok((lost, all))
    }

    /// Tests whether further values of the parameters may hide unknowns that are identifiable with a restriction; none
    /// if they are not identifiable.
    fn shown_with(&self, restriction: &Restriction) -> Result<Option<bool>, Obstacle> {
        let &Self { plant, domain, .. } = self;
        let shown = self.shown(restriction)?;
        if !shown.hidden.is_empty() {
            return Ok(None);
        }
        let places = || {
            let domain = domain.restricted(&plant.arena, &restriction.equal)?;
            Volume::of(&plant.arena, &domain, &shown.stack).and_then(|volume| volume.places(plant, &domain)).ok()
        };
        Ok(Some(places().is_none_or(|places| !places.all || places.together || !places.constants.is_empty())))
    }
}

/// Tests whether a zero at a value of an input is already listed.
pub(super) fn is_listed(arena: &Arena, listed: &[Blind], zero: Expr) -> bool {
    listed.iter().any(|other| match &other.place {
        Place::Value(one, at) => arena.is_zero(arena.substitute(zero, &BTreeMap::from([(*one, *at)]))),
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

//! Zeros of formulas at which rows of full rank lose it: those of their determinant and of their entries, and
//! combinations of the parameters.

use std::collections::BTreeSet;

use crate::analysis::design::Still;
use crate::analysis::identifiability::flow::{Flow, only_signal, varies, without_psi};
use crate::analysis::identifiability::singular::{Volume, ZeroSet};
use pebo_cas::linear::determinant::largest_minors;
use pebo_cas::linear::rank::{full_rank_throughout, proved_rank};
use pebo_cas::tower::{Field, Obstacle};
use pebo_cas::{Arena, Domain, Expr, Relation, Symbol};

use super::family::Family;
use crate::analysis::identifiability::observation::{Observation, free_columns};
use crate::analysis::identifiability::problem::ObservabilityProblem;

impl ObservabilityProblem<'_> {
    pub(super) fn parameters(&self) -> BTreeSet<Symbol> {
        self.plant.parameters.iter().map(|parameter| parameter.symbol).collect()
    }

    /// The zeros on a domain at which observations have a lower rank: those of the determinant of the rows without the
    /// columns that follow from the others.
    pub(super) fn zero_set(&self, domain: &Domain, observed: &Observation) -> Result<ZeroSet, Obstacle> {
        self.check_size(&observed.stack)?;
        let arena = &self.plant.arena;
        let free = free_columns(arena, &observed.hidden, self.unknowns());
        let columns: Vec<usize> = (0..self.unknowns()).filter(|column| !free.contains(&Some(*column))).collect();
        let rows = observed.stack.iter().map(|row| columns.iter().map(|column| row[*column]).collect::<Vec<Expr>>());
        let rows: Vec<Vec<Expr>> = rows.filter(|row| row.iter().any(|entry| !arena.is_zero(*entry))).collect();
        // A row may have no zeros where the determinant of all does.
        if full_rank_throughout(arena, domain, &rows, columns.len()).unwrap_or(false) {
            return Ok(ZeroSet { all: true, ..ZeroSet::default() });
        }
        let zero_set = |rows: &[Vec<Expr>]| Volume::of(arena, domain, rows)?.zero_set(self.plant, domain);
        // The first rows are the shortest: where they suffice everywhere, the others say nothing.
        let is_longer = rows.len() > columns.len();
        let first = if is_longer { independent(arena, domain, &rows, columns.len()) } else { Vec::new() };
        let is_square = first.len() == columns.len();
        let of_first = is_square.then(|| zero_set(&first)).and_then(Result::ok).filter(ZeroSet::are_none);
        of_first.map_or_else(|| zero_set(&rows), Ok)
    }

    /// Tests whether a formula holds inputs, and no other signals.
    pub(super) fn is_of_inputs(&self, formula: Expr) -> bool {
        let mut signals = self.plant.arena.symbols_of(&[formula]);
        signals.retain(|symbol| varies(self.plant, self.plant.arena.of_symbol(*symbol)));
        !signals.is_empty() && signals.into_iter().all(|signal| self.plant.commanded().any(|input| input == signal))
    }

    /// The factors of entries that hold inputs alone.
    pub(super) fn zeros_of_entries(&self, rows: &[Vec<Expr>]) -> Result<Vec<Expr>, Obstacle> {
        let &Self { plant, domain, .. } = self;
        let arena = &plant.arena;
        let field = Field::over(arena, &domain.facts, &rows.concat())?;
        let mut found = Vec::new();
        for entry in rows.concat() {
            for (factor, _) in field.fraction(entry)?.numerator().factored(field.limit())?.factors {
                let zero = field.show(&field.of_polynomial(&factor)?);
                if self.is_of_inputs(zero) && !found.contains(&zero) && !domain.implies(arena, zero, Relation::NonZero)
                {
                    found.push(zero);
                }
            }
        }
        Ok(found)
    }

    /// The rows of the regression without their derivatives.
    pub(super) fn rows(&self) -> Vec<Vec<Expr>> {
        let rows = [&self.regression.phi_1, &self.regression.primitive_1];
        rows.into_iter().flat_map(|rows| without_psi(self.plant, rows)).collect()
    }

    /// Tests whether an unknown moves no output while a formula is zero: it divides all factors of the unknown.
    pub(super) fn hides_an_unknown(&self, zero: Expr) -> bool {
        let rows = self.rows();
        (0..self.unknowns()).any(|column| rows.iter().all(|row| self.divides(zero, row[column])))
    }

    /// Tests whether trajectories may remain at a zero while these do not move: it is one of a single signal, or the
    /// formula divides its rate.
    pub(super) fn may_remain(&self, zero: Expr, held: &BTreeSet<Symbol>) -> bool {
        let flow = Flow::along(self.plant, self.domain, self.cascade, held);
        only_signal(self.plant, zero).is_some()
            || flow.is_ok_and(|flow| self.divides(zero, flow.rate(&self.plant.arena, zero)))
    }

    /// Tests whether a family may hide more where a formula is zero: it divides all minors of rows of the family's rank.
    pub(super) fn may_hide_more(&self, family: &Family, zero: Expr) -> bool {
        let Family { set, observed, .. } = family;
        let (arena, domain) = (&self.plant.arena, &set.domain);
        let minors = || -> Result<Vec<Expr>, Obstacle> {
            let rows = independent(arena, domain, &observed.stack, self.unknowns());
            let field = Field::on(arena, domain, &rows.concat())?;
            let minors = largest_minors(&field, &field.matrix(&rows)?)?;
            minors.iter().map(|minor| Ok(field.show(&field.of_polynomial(minor)?))).collect()
        };
        let vanishes = |minor: Expr| self.on(domain).divides(zero, minor);
        minors().map_or(true, |minors| minors.into_iter().all(vanishes))
    }

    fn divides(&self, zero: Expr, expr: Expr) -> bool {
        let found = || -> Result<bool, Obstacle> {
            let field = Field::on(&self.plant.arena, self.domain, &[zero, expr])?;
            let (zero, expr) = (field.fraction(zero)?, field.fraction(expr)?);
            Ok(expr.numerator().div_exact(zero.numerator(), field.limit())?.is_some())
        };
        found().unwrap_or(false)
    }

    /// Combinations of the parameters at which rows that have full rank on some trajectories lose it on all, and true
    /// if there are no other such values.
    pub(super) fn constants(&self, observed: &Observation) -> Result<(Vec<Expr>, bool), Obstacle> {
        let arena = &self.plant.arena;
        let own = self.parameters();
        let degenerate = self.degenerate_identities(&own)?;
        if arena.symbols_of(&observed.stack.concat()).is_disjoint(&own) && degenerate.is_empty() {
            return Ok((Vec::new(), true));
        }
        let zero_set = self.zero_set(self.domain, observed)?;
        let mut all = zero_set.all && !zero_set.joint;
        let mut lost = Vec::new();
        let others = degenerate.into_iter().filter(|formula| !zero_set.constants.contains(formula));
        for formula in others.chain(zero_set.constants.iter().copied()) {
            match self.further_values(formula) {
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

    /// Tests whether further values of the parameters may hide unknowns that are identifiable where a combination of
    /// them is zero; none if they are not identifiable.
    fn further_values(&self, zero: Expr) -> Result<Option<bool>, Obstacle> {
        // At values of the parameters that the formula allows, not at those of the file, where it need not vanish.
        let mut free = self.whole(Still::Nothing);
        for parameter in self.plant.arena.symbols_of(&[zero]) {
            free.domain.fixed.remove(&parameter);
        }
        let families = self.at_zero(&free, zero, &BTreeSet::new())?;
        if families.iter().any(|family| !family.observed.is_full()) {
            return Ok(None);
        }
        let is_further = |family: &Family| {
            let zero_set = self.zero_set(&family.set.domain, &family.observed);
            zero_set.map_or(true, |zero_set| !zero_set.all || zero_set.joint || !zero_set.constants.is_empty())
        };
        Ok(Some(families.iter().any(is_further)))
    }
}

/// The first rows that are independent at a point.
fn independent(arena: &Arena, domain: &Domain, rows: &[Vec<Expr>], columns: usize) -> Vec<Vec<Expr>> {
    let mut first: Vec<Vec<Expr>> = Vec::new();
    for row in rows {
        let longer = [first.as_slice(), std::slice::from_ref(row)].concat();
        if longer.len() <= columns && proved_rank(arena, domain, &longer, columns) == longer.len() {
            first = longer;
        }
    }
    first
}

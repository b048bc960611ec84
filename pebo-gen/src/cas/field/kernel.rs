//! The table of kernels: what polynomials take as variables, with the relations among them.

use super::fraction::Fraction;
use super::{Family, Field, Obstacle};
use crate::cas::expr::Expr;
use crate::cas::poly::Poly;
use crate::cas::rational::Rational;

/// A variable of the polynomials.
#[derive(Debug)]
pub(super) struct Kernel {
    /// What it stands for.
    pub expr: Expr,
    /// Its algebraic relation to earlier kernels, if there is one.
    pub relation: Option<Relation>,
    /// Whether its value is positive wherever it exists.
    pub positive: bool,
}

/// `kernel ^ degree = value`, the value in earlier kernels.
#[derive(Clone, Debug)]
pub(super) struct Relation {
    pub degree: u32,
    pub value: Poly,
}

impl Field<'_> {
    /// The number of the kernel that stands for an expression, entered if it is new.
    pub(super) fn enter(&self, expr: Expr, relation: Option<Relation>, positive: bool) -> u32 {
        if let Some(&number) = self.numbers.borrow().get(&expr) {
            return number;
        }
        let mut kernels = self.kernels.borrow_mut();
        let number = u32::try_from(kernels.len()).unwrap_or(u32::MAX);
        kernels.push(Kernel { expr, relation, positive });
        self.numbers.borrow_mut().insert(expr, number);
        number
    }

    /// The kernel as a fraction.
    pub(super) fn entered(&self, expr: Expr, relation: Option<Relation>, positive: bool) -> Fraction {
        Fraction::polynomial(Poly::variable(self.enter(expr, relation, positive)))
    }

    /// Whether an algebraic relation says something of a kernel that occurs.
    pub(super) fn has_relations(&self, fraction: &Fraction) -> bool {
        let kernels = self.kernels.borrow();
        let mut variables = fraction.num.variables().iter().chain(fraction.den.variables());
        variables.any(|variable| kernels[*variable as usize].relation.is_some())
    }

    /// How many units of its basis argument a multiple is; refines the unit where it is none.
    pub(super) fn multiple(&self, family: Family, key: Expr, factor: &Rational) -> Result<(Rational, i64), Obstacle> {
        const MOST: i64 = 1 << 10;
        let mut units = self.units.borrow_mut();
        let unit = units.entry((family, key)).or_insert_with(|| factor.abs());
        let finer = unit.gcd(factor);
        if finer != *unit {
            *unit = finer;
            *self.refined.borrow_mut() = true;
        }
        let times = factor.checked_div(unit).and_then(|n| n.to_i64()).ok_or(Obstacle::TooLarge)?;
        if times.abs() > MOST {
            return Err(Obstacle::TooLarge);
        }
        Ok((unit.clone(), times))
    }
}

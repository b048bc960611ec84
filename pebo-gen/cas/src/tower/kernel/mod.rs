//! The table of kernels: the variables of polynomials, with the relations among them.

mod absolute_value;

pub(super) mod absolute_angles;
pub(super) mod argument;
mod cyclotomic;
mod elements;
mod exponential;
pub(super) mod inverse;
mod logarithm;
pub(super) mod radical;
pub(super) mod range;
mod symbol;
pub(super) mod trigonometric;

use std::ops::Index;

use rustc_hash::FxHashMap;

use super::Field;
use super::fraction::Fraction;
use crate::graph::expr::Expr;
use crate::poly::Poly;

/// A variable of the polynomials.
#[derive(Debug)]
pub(in crate::tower) struct Kernel {
    /// Its expression.
    pub expr: Expr,
    /// Its algebraic relation to earlier kernels, if there is one.
    pub relation: Option<AlgebraicRelation>,
    /// True if its value is positive wherever it exists.
    pub positive: bool,
}

/// `kernel ^ degree = value`, the value in earlier kernels.
#[derive(Clone, Debug)]
pub(in crate::tower) struct AlgebraicRelation {
    pub degree: u32,
    pub value: Poly,
}

/// The kernels of a round, numbered in the order of entry: a relation holds only earlier ones.
#[derive(Default, Debug)]
pub(in crate::tower) struct Kernels {
    entries: Vec<Kernel>,
    numbers: FxHashMap<Expr, u32>,
}

impl Kernels {
    /// The number of the kernel of an expression.
    pub(in crate::tower) fn number_of(&self, expr: Expr) -> Option<u32> {
        self.numbers.get(&expr).copied()
    }

    /// The same, entered if it is new; a known kernel is unchanged.
    pub(in crate::tower) fn enter(&mut self, kernel: Kernel) -> u32 {
        let next = self.count();
        let number = *self.numbers.entry(kernel.expr).or_insert(next);
        if number == next {
            self.entries.push(kernel);
        }
        number
    }

    /// Adds the relation of a kernel that could not be computed before it had a number.
    pub(in crate::tower) fn relate(&mut self, number: u32, relation: AlgebraicRelation) {
        self.entries[number as usize].relation = Some(relation);
    }

    /// The number of kernels: the number that the next will have.
    pub(in crate::tower) fn count(&self) -> u32 {
        u32::try_from(self.entries.len()).unwrap_or(u32::MAX)
    }

    /// The kernels with their numbers.
    pub(in crate::tower) fn iter(&self) -> impl Iterator<Item = (u32, &Kernel)> {
        (0..).zip(&self.entries)
    }
}

impl Index<u32> for Kernels {
    type Output = Kernel;

    fn index(&self, number: u32) -> &Kernel {
        &self.entries[number as usize]
    }
}

impl Field<'_> {
    /// The number of the kernel of an expression, entered if it is new.
    pub(in crate::tower) fn enter(&self, expr: Expr, relation: Option<AlgebraicRelation>, positive: bool) -> u32 {
        self.round.kernels.borrow_mut().enter(Kernel { expr, relation, positive })
    }

    /// The kernel as a fraction.
    pub(in crate::tower) fn entered(
        &self,
        expr: Expr,
        relation: Option<AlgebraicRelation>,
        positive: bool,
    ) -> Fraction {
        Fraction::polynomial(Poly::variable(self.enter(expr, relation, positive)))
    }

    /// True if a kernel with an algebraic relation occurs.
    pub(crate) fn has_relations(&self, fraction: &Fraction) -> bool {
        let kernels = self.round.kernels.borrow();
        let mut variables = fraction.num.variables().iter().chain(fraction.den.variables());
        variables.any(|variable| kernels[*variable].relation.is_some())
    }
}

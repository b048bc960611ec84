//! The table of kernels: the variables of polynomials, with the relations among them.

mod absolute_value;

pub(super) mod absolute_angles;
mod angle_range;
mod argument;
mod cyclotomic;
mod elements;
mod exponential;
mod inverse;
mod logarithm;
mod radical;
pub(super) mod range;
mod symbol;
mod trigonometric;
pub(super) mod units;

use std::ops::Index;

use rustc_hash::FxHashMap;

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

/// A root of a product of parts whose signs are not known.
#[derive(Clone, Debug)]
pub(in crate::tower) struct ProductRoot {
    pub degree: u32,
    pub negative: bool,
    pub powers: Vec<(Poly, i64)>,
    pub kernel: u32,
}

//! The cost of a program: its operations, counted.

use std::fmt;
use std::ops::Add;

use super::straight::{Operation, Program};
use pebo_cas::Function;

/// The number of operations of each kind.
#[derive(Clone, Copy, PartialEq, Eq, Default, Debug)]
pub struct Cost {
    /// Additions, subtractions and negations.
    pub sums: usize,
    /// Multiplications.
    pub products: usize,
    /// Divisions.
    pub quotients: usize,
    /// Square roots.
    pub roots: usize,
    /// Calls of other functions, general powers among them.
    pub calls: usize,
}

impl Cost {
    /// The cost of one run.
    pub fn of(program: &Program) -> Self {
        let mut cost = Self::default();
        for (index, operation) in program.operations.iter().enumerate() {
            // Sine and cosine of an angle are one call.
            if let Some(other) = operation.companion()
                && program.operations[..index].contains(&other)
            {
                continue;
            }
            let counter = match operation {
                Operation::Neg(_) | Operation::Add(..) | Operation::Sub(..) => &mut cost.sums,
                Operation::Mul(..) => &mut cost.products,
                Operation::Div(..) => &mut cost.quotients,
                Operation::Unary(Function::Sqrt, _) => &mut cost.roots,
                Operation::Power(..)
                | Operation::ExpM1(..)
                | Operation::Ln1P(..)
                | Operation::Unary(..)
                | Operation::Binary(..)
                | Operation::Table(..) => &mut cost.calls,
            };
            *counter += 1;
        }
        cost
    }

    /// All operations in units of an addition, as on processors with a floating-point unit: a division or root about 8,
    /// a call about 40.
    pub fn weighted(self) -> usize {
        self.sums + self.products + 8 * (self.quotients + self.roots) + 40 * self.calls
    }

    /// The number of all operations.
    pub fn total(self) -> usize {
        self.sums + self.products + self.quotients + self.roots + self.calls
    }
}

impl Add for Cost {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            sums: self.sums + other.sums,
            products: self.products + other.products,
            quotients: self.quotients + other.quotients,
            roots: self.roots + other.roots,
            calls: self.calls + other.calls,
        }
    }
}

/// The operations that there are, as in `2 add, 3 mul, 1 div`.
impl fmt::Display for Cost {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let counts = [
            (self.sums, "add"),
            (self.products, "mul"),
            (self.quotients, "div"),
            (self.roots, "sqrt"),
            (self.calls, "call"),
        ];
        let mut separator = "";
        for (count, name) in counts.into_iter().filter(|entry| entry.0 > 0) {
            write!(f, "{separator}{count} {name}")?;
            separator = ", ";
        }
        if separator.is_empty() { f.write_str("none") } else { Ok(()) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn costs_are_added_and_weighted() {
        let cost = Cost { sums: 1, products: 2, quotients: 3, roots: 4, calls: 5 };
        assert_eq!((cost.total(), cost.weighted()), (15, 3 + 8 * 7 + 40 * 5));
        assert_eq!(cost + cost, Cost { sums: 2, products: 4, quotients: 6, roots: 8, calls: 10 });
    }
}

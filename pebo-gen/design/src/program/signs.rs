//! Negations that cost nothing: `-(a - b)` is `b - a`, `-(2*x)` is `(-2)*x`.
//!
//! In: a program. Out: a program of the same value with fewer negations. Only values that are used once change their
//! sign: nothing is computed twice.

use super::straight::{Constant, Operand, Operation, Program};

/// The depth to which a sign is carried into a product.
const DEEPEST: usize = 16;

impl Program {
    /// The program without negations that its other operations can take over.
    pub(super) fn with_signs_absorbed(mut self) -> Self {
        let mut uses = self.uses();
        let mut replaced: Vec<Operand> = (0..self.operations.len()).map(Operand::Result).collect();
        for index in 0..self.operations.len() {
            let current = |operand| match operand {
                Operand::Result(result) => replaced[result],
                other => other,
            };
            self.operations[index] = self.operations[index].map(current);
            if let Operation::Neg(inner) = self.operations[index]
                && self.flip(inner, &uses, DEEPEST)
            {
                replaced[index] = inner;
                if let Operand::Result(inner_result) = inner {
                    uses[inner_result] = uses[index];
                }
            }
        }
        for output in &mut self.outputs {
            if let Operand::Result(result) = *output {
                *output = replaced[result];
            }
        }
        self
    }

    /// Changes the sign of a value, if that takes no operation and nothing else uses it.
    fn flip(&mut self, operand: Operand, uses: &[usize], depth: usize) -> bool {
        let Operand::Result(index) = operand else {
            return false;
        };
        if uses[index] != 1 || depth == 0 {
            return false;
        }
        let flipped = match self.operations[index] {
            Operation::Sub(a, b) => Some(Operation::Sub(b, a)),
            Operation::Mul(a, b) => self
                .opposite_constant(a)
                .map(|a| Operation::Mul(a, b))
                .or_else(|| self.opposite_constant(b).map(|b| Operation::Mul(a, b))),
            Operation::Div(a, b) => self.opposite_constant(a).map(|a| Operation::Div(a, b)),
            _ => None,
        };
        if let Some(flipped) = flipped {
            self.operations[index] = flipped;
            return true;
        }
        match self.operations[index] {
            Operation::Mul(a, b) | Operation::Div(a, b) => {
                self.flip(a, uses, depth - 1) || self.flip(b, uses, depth - 1)
            }
            _ => false,
        }
    }

    /// The constant of the opposite value; of pi there is none.
    fn opposite_constant(&mut self, operand: Operand) -> Option<Operand> {
        let Operand::Constant(index) = operand else {
            return None;
        };
        let Constant::Number(value) = &self.constants[index] else {
            return None;
        };
        let opposite = Constant::Number(-value);
        let position = self.constants.iter().position(|constant| *constant == opposite);
        Some(Operand::Constant(position.unwrap_or_else(|| {
            self.constants.push(opposite);
            self.constants.len() - 1
        })))
    }
}

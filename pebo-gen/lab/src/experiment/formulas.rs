//! A program with room for its values.

use pebo_design::program::{Interpreter, Program};

/// A program with room for its values.
#[derive(Debug)]
pub(crate) struct Formulas {
    interpreter: Interpreter,
    values: Vec<f64>,
}

impl Formulas {
    pub(crate) fn new(program: &Program) -> Self {
        Self { interpreter: Interpreter::new(program), values: vec![0.0; program.outputs.len()] }
    }

    /// The values for this table.
    pub(crate) fn of(&mut self, table: &[f64]) -> &[f64] {
        self.interpreter.run(table, &mut self.values);
        &self.values
    }
}

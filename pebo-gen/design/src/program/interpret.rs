//! The reference interpreter: a program and numbers in, numbers out.
//!
//! One flat table of values, filled in order: the inputs that are read, then constants, then results. A run neither
//! allocates nor branches on anything but the kind of operation.

use super::straight::{Operand, Operation, Program};
use pebo_cas::Function;
use pebo_cas::graph::function::Value;
use pebo_cas::graph::function::pieces::FloatTable;

/// Runs one program at `f64`, repeatedly.
#[derive(Clone, Debug)]
pub struct Interpreter {
    values: Vec<f64>,
    tables: Vec<FloatTable>,
    /// The number of inputs.
    inputs: usize,
    /// The positions of the inputs that are read: a caller gives all that it has, and few programs need them all.
    read: Vec<usize>,
    /// The position of the first result.
    first: usize,
    instructions: Vec<Instruction>,
    outputs: Vec<usize>,
}

/// An operation on positions in the table of values.
#[derive(Clone, Copy, Debug)]
enum Instruction {
    Neg(usize),
    Add(usize, usize),
    Sub(usize, usize),
    Mul(usize, usize),
    Div(usize, usize),
    Power(usize, usize),
    Unary(fn(f64) -> f64, usize),
    Binary(fn(f64, f64) -> f64, usize, usize),
    Table(usize, usize),
}

impl Interpreter {
    /// An interpreter for this program.
    pub fn new(program: &Program) -> Self {
        let read: Vec<usize> = (0..program.inputs.len()).filter(|input| program.reads(*input)).collect();
        let (constant, first) = (read.len(), read.len() + program.constants.len());
        let slot = |operand| match operand {
            Operand::Input(index) => read.partition_point(|input| *input < index),
            Operand::Constant(index) => constant + index,
            Operand::Result(index) => first + index,
        };
        let mut values = vec![0.0; constant];
        values.extend(program.constants.iter().map(super::Constant::to_f64));
        values.resize(first + program.operations.len(), 0.0);
        let instructions = program
            .operations
            .iter()
            .map(|&operation| match operation {
                Operation::Neg(a) => Instruction::Neg(slot(a)),
                Operation::Add(a, b) => Instruction::Add(slot(a), slot(b)),
                Operation::Sub(a, b) => Instruction::Sub(slot(a), slot(b)),
                Operation::Mul(a, b) => Instruction::Mul(slot(a), slot(b)),
                Operation::Div(a, b) => Instruction::Div(slot(a), slot(b)),
                Operation::Power(a, b) => Instruction::Power(slot(a), slot(b)),
                Operation::ExpM1(a) => Instruction::Unary(f64::exp_m1, slot(a)),
                Operation::Ln1P(a) => Instruction::Unary(f64::ln_1p, slot(a)),
                Operation::Unary(function, a) => Instruction::Unary(unary(function), slot(a)),
                Operation::Binary(function, a, b) => Instruction::Binary(binary(function), slot(a), slot(b)),
                Operation::Table(table, a) => Instruction::Table(table, slot(a)),
            })
            .collect();
        let outputs = program.outputs.iter().copied().map(slot).collect();
        let tables = program.tables.iter().map(FloatTable::of).collect();
        Self { values, tables, inputs: program.inputs.len(), read, first, instructions, outputs }
    }

    /// The outputs for these inputs.
    ///
    /// # Panics
    /// Panics unless there are as many inputs and outputs as the program has.
    pub fn run(&mut self, inputs: &[f64], outputs: &mut [f64]) {
        assert_eq!(inputs.len(), self.inputs, "number of inputs");
        assert_eq!(outputs.len(), self.outputs.len(), "number of outputs");
        for (index, value) in self.evaluate(|input| inputs[input]).enumerate() {
            outputs[index] = value;
        }
    }

    /// The outputs in their order, for inputs given by their positions where they are read.
    pub fn evaluate(&mut self, input: impl Fn(usize) -> f64) -> impl Iterator<Item = f64> {
        let values = self.values.as_mut_slice();
        for (slot, &read) in self.read.iter().enumerate() {
            values[slot] = input(read);
        }
        for (index, instruction) in self.instructions.iter().enumerate() {
            values[self.first + index] = match *instruction {
                Instruction::Neg(a) => -values[a],
                Instruction::Add(a, b) => values[a] + values[b],
                Instruction::Sub(a, b) => values[a] - values[b],
                Instruction::Mul(a, b) => values[a] * values[b],
                Instruction::Div(a, b) => values[a] / values[b],
                Instruction::Power(a, b) => values[a].powf(values[b]),
                Instruction::Unary(function, a) => function(values[a]),
                Instruction::Binary(function, a, b) => function(values[a], values[b]),
                Instruction::Table(table, a) => self.tables[table].value(values[a]),
            };
        }
        self.outputs.iter().map(|&slot| values[slot])
    }
}

fn unary(function: Function) -> fn(f64) -> f64 {
    match function.row().value {
        Value::Unary(value) => value,
        Value::Binary(_) | Value::Tabulated(_) => unreachable!("{function:?} was lowered with one argument"),
    }
}

fn binary(function: Function) -> fn(f64, f64) -> f64 {
    match function.row().value {
        Value::Binary(value) => value,
        Value::Unary(_) | Value::Tabulated(_) => unreachable!("{function:?} was lowered with two arguments"),
    }
}

//! A program as the target computes it: each operation rounded to the scalar.
//!
//! In: a program, and values of its inputs in the scalar. Out: its outputs in the scalar. The result of one operation
//! in `f64`, rounded to `f32`, is that operation in `f32`, since `f64` has more than twice its digits. Functions are
//! those of the host, and a table with its few operations is rounded once: a unit or two in the last place from the
//! target's, which is small beside the losses in question.

use super::super::literal::Scalar;
use pebo_cas::Function;
use pebo_cas::graph::function::Value;
use pebo_cas::graph::function::pieces::FloatTable;
use pebo_design::program::{Constant, Operand, Operation, Program};

/// The nearest number of the scalar.
pub(super) fn round(scalar: Scalar, value: f64) -> f64 {
    match scalar {
        #[expect(clippy::cast_possible_truncation, reason = "rounding is the purpose")]
        Scalar::F32 => f64::from(value as f32),
        Scalar::F64 => value,
    }
}

/// The outputs.
pub(super) fn run(program: &Program, scalar: Scalar, inputs: &[f64]) -> Vec<f64> {
    let constants: Vec<f64> =
        program.constants.iter().map(|constant| round(scalar, Constant::to_f64(constant))).collect();
    let mut results: Vec<f64> = Vec::with_capacity(program.operations.len());
    let at = |operand: Operand, results: &[f64]| match operand {
        Operand::Input(index) => inputs[index],
        Operand::Constant(index) => constants[index],
        Operand::Result(index) => results[index],
    };
    for operation in &program.operations {
        let of = |operand| at(operand, &results);
        let value = match *operation {
            Operation::Neg(a) => -of(a),
            Operation::Add(a, b) => of(a) + of(b),
            Operation::Sub(a, b) => of(a) - of(b),
            Operation::Mul(a, b) => of(a) * of(b),
            Operation::Div(a, b) => of(a) / of(b),
            Operation::Power(a, b) => of(a).powf(of(b)),
            Operation::ExpM1(a) => of(a).exp_m1(),
            Operation::Ln1P(a) => of(a).ln_1p(),
            Operation::Unary(function, a) => unary(function, of(a)),
            Operation::Binary(function, a, b) => binary(function, of(a), of(b)),
            Operation::Table(table, a) => FloatTable::of(&program.tables[table]).value(of(a)),
        };
        results.push(round(scalar, value));
    }
    program.outputs.iter().map(|&output| at(output, &results)).collect()
}

fn unary(function: Function, a: f64) -> f64 {
    match function.row().value {
        Value::Unary(value) => value(a),
        Value::Binary(_) | Value::Tabulated(_) => f64::NAN,
    }
}

fn binary(function: Function, a: f64, b: f64) -> f64 {
    match function.row().value {
        Value::Binary(value) => value(a, b),
        Value::Unary(_) | Value::Tabulated(_) => f64::NAN,
    }
}

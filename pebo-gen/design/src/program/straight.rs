//! The program itself: inputs, constants, one operation after another, outputs.
//!
//! Holds: an operation uses inputs, constants and results of earlier operations only; no two constants
//! are the same, and each operation and constant is used.

use pebo_cas::graph::function::pieces::Pieces;
use pebo_cas::{Arena, Expr, Function, Rational, Symbol};

/// The source of a value.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub enum Operand {
    /// The input at this position.
    Input(usize),
    /// The constant at this position.
    Constant(usize),
    /// The result of the operation at this position.
    Result(usize),
}

/// A number that the program contains.
#[derive(Clone, PartialEq, Eq, Hash, Debug)]
pub enum Constant {
    /// An exact rational.
    Number(Rational),
    /// The circle constant.
    Pi,
}

impl Constant {
    /// The nearest `f64`.
    pub fn to_f64(&self) -> f64 {
        match self {
            Self::Number(value) => value.to_f64(),
            Self::Pi => std::f64::consts::PI,
        }
    }
}

/// One operation on values that are known by then.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Operation {
    /// `-a`
    Neg(Operand),
    /// `a + b`
    Add(Operand, Operand),
    /// `a - b`
    Sub(Operand, Operand),
    /// `a * b`
    Mul(Operand, Operand),
    /// `a / b`
    Div(Operand, Operand),
    /// `a ^ b` for a constant `b` that is neither an integer nor a half; `a` is not negative.
    Power(Operand, Operand),
    /// `e^a - 1`, with all digits also where `a` is small.
    ExpM1(Operand),
    /// `ln(1 + a)`, with all digits also where `a` is small.
    Ln1P(Operand),
    /// A function of one argument, the square root among them.
    Unary(Function, Operand),
    /// A function of two arguments.
    Binary(Function, Operand, Operand),
    /// The table at this position, at an argument.
    Table(usize, Operand),
}

impl Operation {
    /// The operands of the operation, in order.
    pub(crate) fn operands(self) -> impl Iterator<Item = Operand> {
        let (first, second) = match self {
            Self::Neg(a) | Self::ExpM1(a) | Self::Ln1P(a) | Self::Unary(_, a) | Self::Table(_, a) => (a, None),
            Self::Add(a, b)
            | Self::Sub(a, b)
            | Self::Mul(a, b)
            | Self::Div(a, b)
            | Self::Power(a, b)
            | Self::Binary(_, a, b) => (a, Some(b)),
        };
        std::iter::once(first).chain(second)
    }

    /// The cosine that goes with a sine, and the other way round: both come from one call.
    pub fn companion(self) -> Option<Self> {
        match self {
            Self::Unary(Function::Sin, angle) => Some(Self::Unary(Function::Cos, angle)),
            Self::Unary(Function::Cos, angle) => Some(Self::Unary(Function::Sin, angle)),
            _ => None,
        }
    }

    /// The same operation on other operands.
    pub(super) fn map(self, mut change: impl FnMut(Operand) -> Operand) -> Self {
        match self {
            Self::Neg(a) => Self::Neg(change(a)),
            Self::Add(a, b) => Self::Add(change(a), change(b)),
            Self::Sub(a, b) => Self::Sub(change(a), change(b)),
            Self::Mul(a, b) => Self::Mul(change(a), change(b)),
            Self::Div(a, b) => Self::Div(change(a), change(b)),
            Self::Power(a, b) => Self::Power(change(a), change(b)),
            Self::ExpM1(a) => Self::ExpM1(change(a)),
            Self::Ln1P(a) => Self::Ln1P(change(a)),
            Self::Unary(function, a) => Self::Unary(function, change(a)),
            Self::Binary(function, a, b) => Self::Binary(function, change(a), change(b)),
            Self::Table(table, a) => Self::Table(table, change(a)),
        }
    }
}

/// Straight-line code for a tuple of outputs.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Program {
    /// The symbols whose values are given, in the order in which they are given.
    pub inputs: Vec<Symbol>,
    /// The numbers that the operations use.
    pub constants: Vec<Constant>,
    /// The tables that the operations use.
    pub tables: Vec<Pieces>,
    /// The operations, in order.
    pub operations: Vec<Operation>,
    /// The outputs.
    pub outputs: Vec<Operand>,
}

impl Program {
    /// The number of uses of each operation's result, outputs included.
    pub fn uses(&self) -> Vec<usize> {
        let mut uses = vec![0; self.operations.len()];
        let operands = self.operations.iter().flat_map(|operation| operation.operands());
        for operand in operands.chain(self.outputs.iter().copied()) {
            if let Operand::Result(index) = operand {
                uses[index] += 1;
            }
        }
        uses
    }

    /// The value of each operation as a formula in the inputs.
    pub(super) fn formulas(&self, arena: &Arena) -> Vec<Expr> {
        let mut formulas: Vec<Expr> = Vec::with_capacity(self.operations.len());
        for &operation in &self.operations {
            let formula = |operand| match operand {
                Operand::Input(input) => arena.of_symbol(self.inputs[input]),
                Operand::Result(result) => formulas[result],
                Operand::Constant(index) => match &self.constants[index] {
                    Constant::Number(value) => arena.number(value.clone()),
                    Constant::Pi => arena.pi(),
                },
            };
            formulas.push(match operation {
                Operation::Neg(a) => arena.neg(formula(a)),
                Operation::Add(a, b) => arena.add(formula(a), formula(b)),
                Operation::Sub(a, b) => arena.sub(formula(a), formula(b)),
                Operation::Mul(a, b) => arena.mul(formula(a), formula(b)),
                Operation::Div(a, b) => arena.div(formula(a), formula(b)),
                Operation::Power(a, b) => match arena.as_number(formula(b)) {
                    Some(exponent) => arena.power(formula(a), &exponent),
                    None => unreachable!("the exponent of a power is a number"),
                },
                Operation::ExpM1(a) => arena.sub(arena.call(Function::Exp, &[formula(a)]), arena.one()),
                Operation::Ln1P(a) => arena.call(Function::Log, &[arena.add(arena.one(), formula(a))]),
                Operation::Unary(function, a) => arena.call(function, &[formula(a)]),
                Operation::Binary(function, a, b) => arena.call(function, &[formula(a), formula(b)]),
                Operation::Table(table, a) => self.tables[table].call(arena, formula(a)),
            });
        }
        formulas
    }

    /// The program with the operations of another on the same inputs, and where the results of these are in it.
    pub(super) fn joined(&self, other: &Self) -> (Self, Vec<Operand>) {
        let mut joined = self.clone();
        let constants: Vec<Operand> = other
            .constants
            .iter()
            .map(|constant| Operand::Constant(position(&mut joined.constants, constant.clone())))
            .collect();
        let tables: Vec<usize> = other.tables.iter().map(|table| position(&mut joined.tables, table.clone())).collect();
        let mut operands: Vec<Operand> = Vec::with_capacity(other.operations.len());
        for operation in &other.operations {
            let own = match *operation {
                Operation::Table(table, a) => Operation::Table(tables[table], a),
                other => other,
            };
            let moved = own.map(|operand| match operand {
                Operand::Input(_) => operand,
                Operand::Constant(index) => constants[index],
                Operand::Result(index) => operands[index],
            });
            operands.push(Operand::Result(position(&mut joined.operations, moved)));
        }
        (joined, operands)
    }

    /// Tests whether the value of the input matters.
    pub fn reads(&self, input: usize) -> bool {
        let operands = self.operations.iter().flat_map(|operation| operation.operands());
        operands.chain(self.outputs.iter().copied()).any(|operand| operand == Operand::Input(input))
    }

    /// The program without operations that no output needs.
    pub(super) fn pruned(self) -> Self {
        let mut needed = vec![false; self.operations.len()];
        let mut used = vec![false; self.constants.len()];
        let mut mark = |operand: Operand, needed: &mut Vec<bool>| match operand {
            Operand::Input(_) => {}
            Operand::Constant(index) => used[index] = true,
            Operand::Result(index) => needed[index] = true,
        };
        for &output in &self.outputs {
            mark(output, &mut needed);
        }
        for (index, operation) in self.operations.iter().enumerate().rev() {
            if needed[index] {
                operation.operands().for_each(|operand| mark(operand, &mut needed));
            }
        }
        let (result, constant) = (positions(&needed), positions(&used));
        let moved = |operand| match operand {
            Operand::Input(index) => Operand::Input(index),
            Operand::Constant(index) => Operand::Constant(constant[index]),
            Operand::Result(index) => Operand::Result(result[index]),
        };
        Self {
            inputs: self.inputs,
            constants: kept(self.constants, &used),
            tables: self.tables,
            operations: kept(self.operations, &needed).into_iter().map(|operation| operation.map(moved)).collect(),
            outputs: self.outputs.into_iter().map(moved).collect(),
        }
    }
}

/// The index of an entry, which is added if it is not there.
fn position<T: PartialEq>(entries: &mut Vec<T>, entry: T) -> usize {
    entries.iter().position(|other| *other == entry).unwrap_or_else(|| {
        entries.push(entry);
        entries.len() - 1
    })
}

/// The position of each kept entry among the kept ones.
fn positions(keep: &[bool]) -> Vec<usize> {
    keep.iter()
        .scan(0, |next, &keep| {
            let position = *next;
            *next += usize::from(keep);
            Some(position)
        })
        .collect()
}

fn kept<T>(entries: Vec<T>, keep: &[bool]) -> Vec<T> {
    entries.into_iter().zip(keep).filter_map(|(entry, &keep)| keep.then_some(entry)).collect()
}

//! Rounded denominators and arguments of roots and logarithms in a program.
//!
//! In: the program from the parameters to the constants, those that the constants go into, and a program whose outputs
//! are compared with zero. Out: that program with the further values that have to be compared. Two forms of a value, as
//! `a - b/c` and `a*c - b`, differ in floating point: one can be positive where the other is zero. A product of nonzero
//! values vanishes below the range of the numbers alone: it is compared only where no constant reveals that, by not
//! being finite.

use super::straight::{Constant, Operand, Operation, Program};
use pebo_cas::{Arena, Expr, Function, Relation};

/// Facts about a value as it is computed.
#[derive(Clone, Copy)]
struct ValueFacts {
    relation: Relation,
    /// True if underflow may make it zero.
    may_vanish: bool,
}

impl ValueFacts {
    fn sure(relation: Relation) -> Self {
        Self { relation, may_vanish: false }
    }

    /// Tests whether it satisfies the relation; `is_revealed` if a constant is not finite where it underflows.
    fn meets(self, wanted: Relation, is_revealed: bool) -> bool {
        match wanted {
            Relation::NonNegative => self.relation != Relation::NonZero,
            Relation::Positive => self.relation == Relation::Positive && (is_revealed || !self.may_vanish),
            Relation::NonZero => self.relation != Relation::NonNegative && (is_revealed || !self.may_vanish),
        }
    }
}

/// A program that compares, and the compared values after its own outputs.
#[derive(Clone, Debug)]
pub struct GuardedProgram {
    /// From the arguments to the outputs, and behind these to the guarded values.
    pub program: Program,
    /// The guarded values, each with its comparison.
    pub guards: Vec<(Expr, Relation)>,
}

/// `checked`, whose outputs compare so with zero, with the conditions of `setup` and the users of its outputs on its
/// values.
pub(super) fn guarded(
    arena: &Arena,
    setup: &Program,
    users: &[&Program],
    (checked, wanted): (&Program, &[Option<Relation>]),
) -> GuardedProgram {
    let (mut program, joined_operands) = checked.joined(setup);
    let joined_operand = |operand| match operand {
        Operand::Result(index) => joined_operands[index],
        Operand::Constant(_) | Operand::Input(_) => operand,
    };
    let compared = |operand: Operand| {
        let mut same = checked.outputs.iter().zip(wanted).filter(|(output, _)| **output == joined_operand(operand));
        same.find_map(|(_, relation)| *relation).map(ValueFacts::sure)
    };
    let formulas = setup.formulas(arena);
    let mut values = Values { setup, of_inputs: Vec::new(), of_results: Vec::new() };
    values.of_inputs = (0..setup.inputs.len()).map(|input| compared(Operand::Input(input))).collect();
    let mut guards = Vec::new();
    let mut guard = |values: &mut Values, value: Operand, wanted: Relation, is_revealed: bool| {
        if values.known(value).is_some_and(|known| known.meets(wanted, is_revealed)) {
            return;
        }
        let formula = match value {
            Operand::Result(index) => formulas[index],
            Operand::Input(input) => arena.of_symbol(setup.inputs[input]),
            Operand::Constant(_) => return,
        };
        values.learn(value, ValueFacts::sure(wanted));
        program.outputs.push(joined_operand(value));
        guards.push((formula, wanted));
    };
    let revealed = setup.revealed();
    for (index, &operation) in setup.operations.iter().enumerate() {
        if let Some((value, wanted)) = operation.demand(setup) {
            guard(&mut values, value, wanted, revealed[index]);
        }
        let known = compared(Operand::Result(index)).or_else(|| values.of(operation));
        values.of_results.push(known);
    }
    for (user, operation) in
        users.iter().flat_map(|user| user.operations.iter().map(move |operation| (user, operation)))
    {
        if let Some((Operand::Input(input), wanted)) = operation.demand(user)
            && let Some(&value) = setup.outputs.get(input)
        {
            guard(&mut values, value, wanted, false);
        }
    }
    GuardedProgram { program: program.pruned(), guards }
}

impl Operation {
    /// The value that must not be zero or negative, and its relation to zero.
    fn demand(self, program: &Program) -> Option<(Operand, Relation)> {
        match self {
            Self::Div(_, divisor) => Some((divisor, Relation::NonZero)),
            Self::Unary(Function::Sqrt, radicand) => Some((radicand, Relation::NonNegative)),
            Self::Unary(Function::Log, argument) => Some((argument, Relation::Positive)),
            Self::Power(base, Operand::Constant(exponent)) => match &program.constants[exponent] {
                Constant::Number(exponent) if exponent.is_negative() => Some((base, Relation::Positive)),
                _ => Some((base, Relation::NonNegative)),
            },
            _ => None,
        }
    }

    /// Tests whether the result is not finite where this operand is not.
    fn passes_on(self, operand: Operand) -> bool {
        match self {
            Self::Neg(_) | Self::Add(..) | Self::Sub(..) | Self::Mul(..) | Self::Unary(Function::Sqrt, _) => true,
            Self::Div(above, below) => above == operand && below != operand,
            _ => false,
        }
    }
}

impl Program {
    /// For each operation, true if some output is not finite where its result is not.
    fn revealed(&self) -> Vec<bool> {
        let mut revealed = vec![false; self.operations.len()];
        let mark = |revealed: &mut Vec<bool>, operand: Operand| {
            if let Operand::Result(index) = operand {
                revealed[index] = true;
            }
        };
        for &output in &self.outputs {
            mark(&mut revealed, output);
        }
        for (index, operation) in self.operations.iter().enumerate().rev() {
            if revealed[index] {
                let passing = operation.operands().filter(|operand| operation.passes_on(*operand));
                passing.for_each(|operand| mark(&mut revealed, operand));
            }
        }
        revealed
    }
}

/// Facts about the values of a program, as far as computed.
struct Values<'a> {
    setup: &'a Program,
    of_inputs: Vec<Option<ValueFacts>>,
    of_results: Vec<Option<ValueFacts>>,
}

impl Values<'_> {
    fn known(&self, operand: Operand) -> Option<ValueFacts> {
        match operand {
            Operand::Input(input) => self.of_inputs[input],
            Operand::Result(index) => self.of_results[index],
            Operand::Constant(index) => Some(ValueFacts::sure(match &self.setup.constants[index] {
                Constant::Number(number) if number.is_zero() => Relation::NonNegative,
                Constant::Number(number) if number.is_negative() => Relation::NonZero,
                Constant::Number(_) | Constant::Pi => Relation::Positive,
            })),
        }
    }

    fn learn(&mut self, operand: Operand, known: ValueFacts) {
        match operand {
            Operand::Input(input) => self.of_inputs[input] = Some(known),
            Operand::Result(index) => self.of_results[index] = Some(known),
            Operand::Constant(_) => {}
        }
    }

    /// The facts about the result of an operation.
    fn of(&self, operation: Operation) -> Option<ValueFacts> {
        use Relation::{NonNegative, NonZero, Positive};
        match operation {
            Operation::Neg(value) => self
                .known(value)
                .filter(|known| known.relation != NonNegative)
                .map(|known| ValueFacts { relation: NonZero, ..known }),
            Operation::Add(a, b) => {
                let (a, b) = (self.known(a)?, self.known(b)?);
                let is_sure = |known: ValueFacts| known.relation == Positive && !known.may_vanish;
                match (a.relation, b.relation) {
                    (NonZero, _) | (_, NonZero) => None,
                    (NonNegative, NonNegative) => Some(ValueFacts::sure(NonNegative)),
                    _ => Some(ValueFacts { relation: Positive, may_vanish: !is_sure(a) && !is_sure(b) }),
                }
            }
            Operation::Mul(a, b) | Operation::Div(a, b) => {
                let is_square = a == b && matches!(operation, Operation::Mul(..));
                let (a, b) = match (self.known(a), self.known(b)) {
                    (Some(a), Some(b)) => (a.relation, b.relation),
                    _ if is_square => return Some(ValueFacts::sure(NonNegative)),
                    _ => return None,
                };
                let relation = match (a, b) {
                    (Positive, Positive) => Positive,
                    (NonZero, NonZero) if is_square => Positive,
                    (NonNegative, NonNegative | Positive) | (Positive, NonNegative) => NonNegative,
                    (NonZero, NonZero | Positive) | (Positive, NonZero) => NonZero,
                    (NonNegative, NonZero) | (NonZero, NonNegative) => return None,
                };
                Some(ValueFacts { relation, may_vanish: true })
            }
            Operation::Unary(Function::Sqrt, value) => self.known(value).filter(|known| known.relation != NonZero),
            Operation::Unary(Function::Exp, _) => Some(ValueFacts { relation: Positive, may_vanish: true }),
            Operation::Power(value, _) => self
                .known(value)
                .filter(|known| known.relation == Positive)
                .map(|known| ValueFacts { may_vanish: true, ..known }),
            _ => None,
        }
    }
}

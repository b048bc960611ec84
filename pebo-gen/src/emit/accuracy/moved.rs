//! Variations of values when their arguments are rounded: to first order, and for all arguments in one pass.
//!
//! In: expressions, operands first, with enclosures of their values at a point. Out: the sum of `|a df/da|` over the
//! arguments `a`. Tangents are carried forward in `f64` beside exact values. Holds after: an effect that is given has
//! the first of its digits right; where tangents cancel, or a value is not linear over a move of [`MOVE`], none is
//! given.

use std::collections::BTreeMap;

use rustc_hash::FxHashMap;

use pebo_cas::number::interval::{Interval, Precision};
use pebo_cas::{Arena, Expr, Function, Node, Rational, Symbol};

/// Bits of the enclosures: those of `f64`, and as many to be lost.
pub(super) const BITS: u32 = 128;

/// The relative move of an argument by which its effect is found where it is not found to first order.
pub(super) const MOVE: f64 = 1.0 / 1_073_741_824.0;

/// A sum of tangents that is less than this part of its summands is not taken: their roundings in `f64`, some hundred
/// of 1e-16 each, have to be small beside it.
const LEAST: f64 = 1.0 / 68_719_476_736.0;

/// A base, or an argument at whose zero a function has no derivative, has to be so many variations away from zero.
const AWAY: f64 = 64.0;

/// Values with their tangents.
pub(super) struct Moves<'a> {
    arena: &'a Arena,
    place: &'a BTreeMap<Symbol, Interval>,
    values: FxHashMap<Expr, &'a Interval>,
    tangents: FxHashMap<Expr, Option<Tangent>>,
}

/// The variation of a value when each argument varies by itself as a whole.
#[derive(Clone, Debug)]
struct Tangent {
    by_argument: Vec<f64>,
    /// The absolute values of all products in these sums, added.
    gross: f64,
}

impl<'a> Moves<'a> {
    /// Those of all parts, which come after their operands.
    pub(super) fn of(
        arena: &'a Arena,
        place: &'a BTreeMap<Symbol, Interval>,
        parts: &[Expr],
        values: &'a [Interval],
    ) -> Self {
        let values = parts.iter().copied().zip(values).collect();
        let mut moves = Self { arena, place, values, tangents: FxHashMap::default() };
        for &part in parts {
            let tangent = moves.tangent(part).filter(|tangent| tangent.gross.is_finite());
            moves.tangents.insert(part, tangent);
        }
        moves
    }

    /// The effect of all arguments on a part, where it is known.
    pub(super) fn effect(&self, part: Expr) -> Option<f64> {
        let tangent = self.tangents.get(&part)?.as_ref()?;
        let effect: f64 = tangent.by_argument.iter().map(|part| part.abs()).sum();
        (effect + self.value(part)?.abs() >= LEAST * tangent.gross).then_some(effect)
    }

    fn value(&self, part: Expr) -> Option<f64> {
        self.values.get(&part).map(|value| f64::midpoint(value.lo(), value.hi()))
    }

    fn tangent(&self, part: Expr) -> Option<Tangent> {
        let mut tangent = Tangent { by_argument: vec![0.0; self.place.len()], gross: 0.0 };
        match self.arena.node(part) {
            Node::Number(_) | Node::Pi => {}
            Node::Symbol(symbol) => {
                let position = self.place.keys().position(|argument| *argument == symbol)?;
                let value = self.value(part)?;
                tangent.by_argument[position] = value;
                tangent.gross = value.abs();
            }
            Node::Sum(sum) => {
                for (term, coefficient) in &sum.terms {
                    self.add(&mut tangent, *term, coefficient.to_f64())?;
                }
            }
            Node::Product(product) => {
                for (index, (base, exponent)) in product.factors.iter().enumerate() {
                    let is_power = exponent.is_integer() && !exponent.is_negative();
                    if !is_power && !self.is_away(self.value(*base)?, [*base])? {
                        return None;
                    }
                    let mut partial = product.coefficient.to_f64() * exponent.to_f64();
                    for (other, (base, exponent)) in product.factors.iter().enumerate() {
                        let less = if other == index { exponent - &Rational::ONE } else { exponent.clone() };
                        partial *= power(self.value(*base)?, &less);
                    }
                    self.add(&mut tangent, *base, partial)?;
                }
            }
            Node::Call(function, arguments) => {
                for (argument, partial) in arguments.iter().zip(self.partials(function, &arguments)?) {
                    self.add(&mut tangent, *argument, partial)?;
                }
            }
        }
        Some(tangent)
    }

    /// Adds the contribution of an operand.
    fn add(&self, tangent: &mut Tangent, operand: Expr, partial: f64) -> Option<()> {
        let moved = self.tangents.get(&operand)?.as_ref()?;
        for (total, part) in tangent.by_argument.iter_mut().zip(&moved.by_argument) {
            *total += partial * part;
        }
        tangent.gross += partial.abs() * moved.gross;
        Some(())
    }

    /// The partial derivatives of a function at its arguments; none near where it has none.
    fn partials(&self, function: Function, arguments: &[Expr]) -> Option<Vec<f64>> {
        let (arena, row) = (self.arena, function.row());
        let symbols: Vec<Symbol> = (0..arguments.len()).map(|index| arena.generated(&format!("a{index}"))).collect();
        let alone: Vec<Expr> = symbols.iter().map(|symbol| arena.of_symbol(*symbol)).collect();
        let partials = (row.derivative)(arena, &alone);
        let limits = std::iter::once(row.conditions).chain(row.smooth).flat_map(|asks| asks(arena, &alone));
        let limits: Vec<Expr> = limits.map(|(limit, _)| limit).collect();
        let place: Option<BTreeMap<Symbol, Interval>> = symbols
            .iter()
            .zip(arguments)
            .map(|(&s, argument)| Some((s, (*self.values.get(argument)?).clone())))
            .collect();
        let values = arena.enclose_over(&[limits.as_slice(), &partials].concat(), &place?, Precision::new(BITS))?;
        let values: Vec<f64> = values.iter().map(|value| f64::midpoint(value.lo(), value.hi())).collect();
        let (limits, partials) = values.split_at(limits.len());
        for limit in limits {
            if !self.is_away(*limit, arguments.iter().copied())? {
                return None;
            }
        }
        Some(partials.to_vec())
    }

    /// The value of these operands is away from zero throughout their variation.
    fn is_away(&self, value: f64, operands: impl IntoIterator<Item = Expr>) -> Option<bool> {
        let moves: f64 = operands.into_iter().map(|operand| self.effect(operand)).sum::<Option<f64>>()?;
        Some(value.abs() > AWAY * MOVE * moves)
    }
}

fn power(base: f64, exponent: &Rational) -> f64 {
    match exponent.to_i64().and_then(|exponent| i32::try_from(exponent).ok()) {
        Some(exponent) => base.powi(exponent),
        None => base.powf(exponent.to_f64()),
    }
}

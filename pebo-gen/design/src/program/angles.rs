//! Sines and cosines of sums, from those of the summands: six operations instead of two calls.
//!
//! In: the expressions that are lowered together. Out: the arguments of sines and cosines that are the sum or
//! difference of two others, so that only the rest needs calls. Near a zero of the value the error is a rounding of the
//! two angles, which the sum of the angles has lost already.

use rustc_hash::{FxHashMap, FxHashSet};

use super::lower::{Lowering, Signed};
use super::straight::{Operand, Operation};
use pebo_cas::{Arena, Expr, Function, Node, Rational};

/// Two angles that make up another.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Parts {
    first: Expr,
    second: Expr,
    /// True if the second is subtracted.
    minus: bool,
}

/// The composition of each angle; an absent one needs a call.
#[derive(Debug, Default)]
pub(super) struct Angles {
    parts: FxHashMap<Expr, Parts>,
    /// Computed values: each angle is a part of many others.
    known: FxHashMap<(Function, Expr), Operand>,
}

/// More angles are called for one by one: pairs are searched.
const MOST_ANGLES: usize = 64;

impl Angles {
    /// The angles in all expressions that the roots consist of.
    pub(super) fn of(arena: &Arena, roots: &[Expr]) -> Self {
        let mut angles: Vec<Expr> = Vec::new();
        for expr in arena.postorder(roots) {
            if let Node::Call(Function::Sin | Function::Cos, arguments) = arena.node(expr)
                && !angles.contains(&arguments[0])
                && angles.len() <= MOST_ANGLES
            {
                angles.push(arguments[0]);
            }
        }
        if angles.len() > MOST_ANGLES {
            return Self::default();
        }
        // The simplest first; a sort that is stable keeps the order of first use among equals.
        angles.sort_by_key(|&angle| summands(arena, angle));
        let mut parts: FxHashMap<Expr, Parts> = FxHashMap::default();
        let mut known: FxHashSet<Expr> = FxHashSet::default();
        // All angles composed of known ones, before another call.
        while !angles.is_empty() {
            let index = angles.iter().position(|angle| parts.contains_key(angle)).unwrap_or(0);
            let newest = angles.remove(index);
            known.insert(newest);
            for angle in &angles {
                if !parts.contains_key(angle)
                    && let Some(made) = made_of(arena, *angle, newest, &known)
                {
                    parts.insert(*angle, made);
                }
            }
        }
        Self { parts, known: FxHashMap::default() }
    }
}

/// The expressions with the sine of a doubled angle as a product, where the single angle is called for: its number
/// joins others.
pub(super) fn halved(arena: &Arena, roots: &[Expr]) -> Vec<Expr> {
    let two = Rational::from(2);
    let parts = arena.postorder(roots);
    let there: FxHashSet<Expr> = parts.iter().copied().collect();
    let mut known: FxHashMap<Expr, Expr> = FxHashMap::default();
    for call in parts {
        let Node::Call(Function::Sin, arguments) = arena.node(call) else { continue };
        let Some(half) = two.recip().map(|share| arena.scale(arguments[0], &share)) else { continue };
        let both = [Function::Sin, Function::Cos].map(|function| arena.call(function, &[half]));
        if both.iter().any(|single| there.contains(single)) {
            known.insert(call, arena.multiply(&two, both.map(|single| (single, Rational::ONE))));
        }
    }
    roots.iter().map(|root| arena.replace(*root, &known)).collect()
}

/// The newest and another of the known angles, if they make up this one.
fn made_of(arena: &Arena, angle: Expr, newest: Expr, known: &FxHashSet<Expr>) -> Option<Parts> {
    let rest = arena.sub(angle, newest);
    let (less, more) = (arena.neg(rest), arena.add(angle, newest));
    if known.contains(&rest) {
        return Some(Parts { first: newest, second: rest, minus: false });
    }
    if known.contains(&less) {
        return Some(Parts { first: newest, second: less, minus: true });
    }
    known.contains(&more).then_some(Parts { first: more, second: newest, minus: true })
}

/// The number of an angle's summands.
fn summands(arena: &Arena, angle: Expr) -> usize {
    match arena.node(angle) {
        Node::Sum(sum) => sum.terms.len() + usize::from(!sum.constant.is_zero()),
        _ => 1,
    }
}

impl Lowering<'_> {
    /// The sine and cosine of an angle.
    fn sine_and_cosine(&mut self, angle: Expr) -> [Operand; 2] {
        [Function::Sin, Function::Cos].map(|function| self.trigonometric(function, angle))
    }

    /// The sine or cosine of an angle.
    pub(super) fn trigonometric(&mut self, function: Function, angle: Expr) -> Operand {
        if let Some(known) = self.angles.known.get(&(function, angle)) {
            return *known;
        }
        let value = self.worked_out(function, angle);
        self.angles.known.insert((function, angle), value);
        value
    }

    fn worked_out(&mut self, function: Function, angle: Expr) -> Operand {
        let Some(&Parts { first, second, minus }) = self.angles.parts.get(&angle) else {
            let argument = self.lowered(angle);
            return self.operation(Operation::Unary(function, argument));
        };
        let [sin_a, cos_a] = self.sine_and_cosine(first);
        let [sin_b, cos_b] = self.sine_and_cosine(second);
        let (left, right, takes) = match function {
            Function::Sin => ((sin_a, cos_b), (cos_a, sin_b), minus),
            _ => ((cos_a, cos_b), (sin_a, sin_b), !minus),
        };
        let left = self.operation(Operation::Mul(left.0, left.1));
        let right = self.operation(Operation::Mul(right.0, right.1));
        self.operation(if takes { Operation::Sub(left, right) } else { Operation::Add(left, right) })
    }

    /// The value of an expression that need not have been met yet.
    pub(super) fn lowered(&mut self, expr: Expr) -> Operand {
        for part in self.arena.postorder(&[expr]) {
            if !self.known.contains_key(&part) {
                let value: Signed = self.value(part);
                self.known.insert(part, value);
            }
        }
        let value = self.known[&expr];
        self.plain(value)
    }
}

//! Signs of kernels: by their functions, by the ranges of their arguments, or by a fact about one alone.

use crate::Rational;
use crate::graph::expr::{Expr, Node};
use crate::graph::function::Function;
use crate::graph::function::pieces::Pieces;
use crate::number::rational::half;
use crate::poly::Poly;
use crate::tower::Fraction;
use crate::{Integer, Relation};

use super::{Sign, Signs};

impl Signs<'_, '_> {
    /// The sign of a kernel: by its function or by a fact about it alone.
    pub(in crate::tower) fn of_kernel(&self, variable: u32) -> Option<Sign> {
        if self.field.round.kernels.borrow()[variable].positive {
            return Some(Sign::Positive);
        }
        if let Some(sign) = self.by_function(variable) {
            return Some(sign);
        }
        for (fact, comparison) in self.memory.round.facts.borrow().iter() {
            if fact.variables() != [variable] {
                continue;
            }
            // c v + d > 0 fixes the sign of v if the constant helps.
            if fact.degree(variable) != 1 || *comparison == Relation::NonZero {
                continue;
            }
            let constant = fact
                .terms()
                .find(|(monomial, _)| monomial.is_one())
                .map_or(Integer::ZERO, |(_, coefficient)| coefficient.clone());
            let rising = !fact.leading_coefficient().is_negative();
            // v > -d/c with d <= 0: positive; v < d/|c| with d <= 0: negative.
            let strict = *comparison == Relation::Positive || !constant.is_zero();
            match (rising, constant.is_zero() || constant.is_negative()) {
                (true, true) if strict => return Some(Sign::Positive),
                (true, true) => return Some(Sign::NonNegative),
                (false, true) if strict => return Some(Sign::Negative),
                _ => {}
            }
        }
        None
    }

    /// Roots and absolute values are not negative; a root of a positive radicand is positive. A cosine is positive if
    /// its angle is within the right half, a sine if it is within the upper one.
    fn by_function(&self, variable: u32) -> Option<Sign> {
        let (expr, radicand) = {
            let kernels = self.field.round.kernels.borrow();
            let kernel = &kernels[variable];
            (kernel.expr, kernel.relation.as_ref().map(|relation| relation.value.clone()))
        };
        let root = self.field.is_plain_root(expr);
        if !root && !matches!(self.field.arena.node(expr), Node::Call(..)) {
            return None;
        }
        // A fact may have the kernel itself in it: then only its form is known.
        let by_form =
            (root || matches!(self.field.arena.node(expr), Node::Call(Function::Abs, _))).then_some(Sign::NonNegative);
        let state = (variable, self.memory.round.facts.borrow().len());
        let memo = &self.memory.round.memo;
        if let Some(sign) = memo.borrow().answer(state) {
            return *sign;
        }
        if !memo.borrow_mut().begin(variable) {
            return by_form;
        }
        let sign = self.by_arguments(expr, radicand).or(by_form);
        memo.borrow_mut().end(state, sign, self.memory.round.depth.get() == 0);
        sign
    }

    fn by_arguments(&self, expr: Expr, radicand: Option<Poly>) -> Option<Sign> {
        match self.field.arena.node(expr) {
            Node::Call(function @ (Function::Sin | Function::Cos), arguments) => self.by_angle(function, arguments[0]),
            Node::Call(function @ (Function::Asin | Function::Acos | Function::Atan | Function::Atan2), arguments) => {
                self.field.range_of_inverse(function, &arguments).ok()?.sign()
            }
            Node::Call(Function::Log, arguments) => self.by_logarithm(arguments[0]),
            Node::Call(Function::Table, _) => self.by_table(expr),
            Node::Call(..) => None,
            _ => self.of_polynomial(&radicand?).ok()?.filter(|sign| *sign == Sign::Positive),
        }
    }

    /// The sign of a table that has one for all arguments.
    fn by_table(&self, expr: Expr) -> Option<Sign> {
        let (least, most) = Pieces::of(self.field.arena, expr)?.0.range()?;
        match (least.signum(), most.signum()) {
            (1, _) => Some(Sign::Positive),
            (_, -1) => Some(Sign::Negative),
            (0, _) => Some(Sign::NonNegative),
            _ => None,
        }
    }

    /// The sign of a sine or cosine by the range of its angle: one half turn about an extremum.
    fn by_angle(&self, function: Function, angle: Expr) -> Option<Sign> {
        if self.memory.round.facts.borrow().is_empty() {
            return None;
        }
        let right = self.field.scale(&self.field.fraction(self.field.arena.pi()).ok()?, &half()).ok()?;
        let angle = self.field.fraction(angle).ok()?;
        let turned = |angle: &Fraction, quarters: i64| {
            self.field.sub(angle, &self.field.scale(&right, &Rational::from(quarters)).ok()?).ok()
        };
        // From the nearest maximum, then from the minima beside it.
        let maximum = turned(&angle, i64::from(function == Function::Sin))?;
        let nearest = self.within(&maximum, &right);
        nearest.or_else(|| {
            let beside = |quarters| self.within(&turned(&maximum, quarters)?, &right);
            // A negative sign is known of what is not zero alone.
            [2, -2].into_iter().find_map(beside).filter(|sign| *sign == Sign::Positive).map(|_| Sign::Negative)
        })
    }

    /// The sign of the cosine of an angle within a right angle of zero.
    fn within(&self, angle: &Fraction, right: &Fraction) -> Option<Sign> {
        let mut strict = true;
        for distance in [self.field.sub(right, angle).ok()?, self.field.add(right, angle).ok()?] {
            match self.of(&distance).ok()?? {
                Sign::Positive => {}
                Sign::NonNegative => strict = false,
                _ => return None,
            }
        }
        Some(if strict { Sign::Positive } else { Sign::NonNegative })
    }

    /// True if the polynomial is known to vanish nowhere by its kernels: exponentials, and roots of positive radicands.
    pub fn never_zero(&self, poly: &Poly) -> bool {
        let never = |variable: &u32| {
            let (positive, radicand) = {
                let kernel = &self.field.round.kernels.borrow()[*variable];
                let root = kernel.relation.as_ref().filter(|_| self.field.is_plain_root(kernel.expr));
                (kernel.positive, root.map(|relation| relation.value.clone()))
            };
            let rooted = |radicand: Poly| self.of_polynomial(&radicand).is_ok_and(|sign| sign == Some(Sign::Positive));
            positive || radicand.is_some_and(rooted)
        };
        poly.term_count() == 1 && poly.variables().iter().all(never)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Facts;
    use crate::tower::Field;
    use crate::{Arena, Expr};

    #[test]
    fn exponentials_and_roots_of_positive_radicands_vanish_nowhere() {
        let arena = Arena::new();
        let [x, y] = ["x", "y"].map(|name| arena.variable(name));
        let mut facts = Facts::new();
        facts.assume(x, Relation::Positive);
        let exp = arena.call(Function::Exp, &[y]);
        let never = |expr: Expr| {
            let field = Field::over(&arena, &facts, &[expr]).unwrap();
            field.signs().never_zero(field.fraction(expr).unwrap().numerator())
        };
        assert!(never(arena.number(2)) && never(exp) && never(arena.mul(exp, arena.sqrt(x))));
        assert!(!never(y) && !never(arena.sqrt(y)) && !never(arena.mul(exp, y)));
        assert!(!never(arena.sub(exp, arena.one())), "a sum may vanish");
    }
}

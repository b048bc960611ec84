//! Expressions to fractions, operands first.

use crate::Integer;
use crate::graph::expr::{Expr, Node, Sum};
use crate::graph::function::Function;
use crate::number::rational::half;
use crate::poly::{Poly, steps};

use super::fraction::Fraction;
use super::{Field, Obstacle};

impl Field<'_> {
    /// The normal form of an expression.
    pub fn fraction(&self, expr: Expr) -> Result<Fraction, Obstacle> {
        if self.round.fractions.borrow().contains_key(&expr) {
            return self.get(expr);
        }
        for e in self.arena.postorder(&[expr]) {
            if self.round.fractions.borrow().contains_key(&e) {
                continue;
            }
            let fraction = self.convert(e)?;
            self.round.fractions.borrow_mut().insert(e, fraction);
        }
        self.get(expr)
    }

    fn get(&self, expr: Expr) -> Result<Fraction, Obstacle> {
        match self.round.fractions.borrow().get(&expr) {
            Some(found) => {
                self.limit().spend(1 + steps(found.weight()))?;
                Ok(found.clone())
            }
            None => Err(Obstacle::Kernel(self.arena.print(expr))),
        }
    }

    fn convert(&self, expr: Expr) -> Result<Fraction, Obstacle> {
        match self.arena.node(expr) {
            Node::Number(value) => Ok(Fraction::constant(&value)),
            Node::Pi => Ok(self.entered(expr, None, true)),
            Node::Symbol(symbol) => self.of_symbol(expr, symbol),
            Node::Sum(sum) => self.of_sum(&sum),
            Node::Product(product) => {
                let mut total = Fraction::constant(&product.coefficient);
                for (base, exponent) in &product.factors {
                    let power = match exponent.to_i64() {
                        Some(integer) => self.pow(&self.get(*base)?, integer)?,
                        None => self.root(&self.get(*base)?, exponent)?,
                    };
                    total = self.mul(&total, &power)?;
                }
                Ok(total)
            }
            Node::Call(function, arguments) => {
                let first = self.get(arguments[0])?;
                self.applied(expr, function, &first)
            }
        }
    }

    /// A sum: summands with numeric denominators first, all at once, then those of equal denominators, so that a long
    /// sum is not brought to lowest terms at each step.
    fn of_sum(&self, sum: &Sum) -> Result<Fraction, Obstacle> {
        let mut common = sum.constant.denominator();
        let mut parts = Vec::with_capacity(sum.terms.len() + 1);
        // By their denominators.
        let mut others: Vec<(Poly, Vec<Poly>)> = Vec::new();
        for (term, coefficient) in &sum.terms {
            let term = self.get(*term)?;
            if let Some(denominator) = term.den.to_constant() {
                let denominator = &denominator * &coefficient.denominator();
                common = common.lcm(&denominator);
                parts.push((term.num, coefficient.numerator(), denominator));
            } else {
                let denominator = coefficient.denominator();
                let denominator = if denominator.is_one() { term.den } else { term.den.scale(&denominator) };
                let numerator = term.num.scale(&coefficient.numerator());
                match others.iter_mut().find(|(known, _)| *known == denominator) {
                    Some((_, numerators)) => numerators.push(numerator),
                    None => others.push((denominator, vec![numerator])),
                }
            }
        }
        parts.push((Poly::one(), sum.constant.numerator(), sum.constant.denominator()));
        let over = |(poly, numerator, denominator): &(Poly, Integer, Integer)| {
            let missing = common.div_exact(denominator).unwrap_or_default();
            poly.scale(&(numerator * &missing))
        };
        let num = total(parts.iter().map(over).collect());
        self.limit().spend(steps(num.term_count()))?;
        let mut result = self.quotient(&num, &Poly::constant(common))?;
        for (denominator, numerators) in others {
            result = self.add(&result, &self.quotient(&total(numerators), &denominator)?)?;
        }
        Ok(result)
    }

    /// A function of the table at an argument.
    fn applied(&self, expr: Expr, function: Function, argument: &Fraction) -> Result<Fraction, Obstacle> {
        let opposed = || -> Result<(Fraction, Fraction), Obstacle> {
            Ok((self.exponential(argument)?, self.exponential(&argument.opposite())?))
        };
        match function {
            Function::Sin => Ok(self.angle(argument)?.0),
            Function::Cos => Ok(self.angle(argument)?.1),
            Function::Tan => {
                let (sin, cos) = self.angle(argument)?;
                self.div(&sin, &cos)
            }
            Function::Exp => self.exponential(argument),
            Function::Sinh => {
                let (up, down) = opposed()?;
                self.scale(&self.sub(&up, &down)?, &half())
            }
            Function::Cosh => {
                let (up, down) = opposed()?;
                self.scale(&self.add(&up, &down)?, &half())
            }
            Function::Tanh => {
                let (up, down) = opposed()?;
                self.div(&self.sub(&up, &down)?, &self.add(&up, &down)?)
            }
            Function::Log => self.logarithm(argument),
            Function::Sqrt => self.root(argument, &half()),
            Function::Abs => self.absolute(argument),
            Function::Asin | Function::Acos | Function::Atan | Function::Atan2 => self.inverse_function(expr),
            _ => match (function.row().in_terms, self.arena.node(expr)) {
                (Some(in_terms), Node::Call(_, arguments)) => self.fraction(in_terms(self.arena, &arguments)),
                // A function without rules that relate it to others is a kernel of its own.
                _ => Ok(self.entered(self.tidy_call(expr)?, None, false)),
            },
        }
    }

    /// The same call over arguments in normal form, so that equal arguments make equal kernels.
    pub(in crate::tower) fn tidy_call(&self, expr: Expr) -> Result<Expr, Obstacle> {
        let Node::Call(function, arguments) = self.arena.node(expr) else { return Ok(expr) };
        let mut tidied = Vec::with_capacity(arguments.len());
        for argument in arguments.iter() {
            tidied.push(self.show(&self.get(*argument)?));
        }
        Ok(self.arena.call(function, &tidied))
    }
}

/// The sum of polynomials, in pairs: each term is moved a few times, and not once for every summand.
fn total(mut parts: Vec<Poly>) -> Poly {
    while parts.len() > 1 {
        parts =
            parts.chunks(2).map(|pair| pair.get(1).map_or_else(|| pair[0].clone(), |other| &pair[0] + other)).collect();
    }
    parts.pop().unwrap_or_default()
}

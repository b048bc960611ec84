//! Expressions to fractions, operands first.

use crate::cas::expr::{Expr, Node};
use crate::cas::function::Function;
use crate::cas::poly::steps;
use crate::cas::rational::half;

use crate::cas::field::fraction::{Fraction, negated};
use crate::cas::field::{Field, Obstacle};

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
                self.work().spend(1 + steps(found.weight()))?;
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
            Node::Sum(sum) => {
                let mut total = Fraction::constant(&sum.constant);
                for (term, coefficient) in &sum.terms {
                    let term = self.scale(&self.get(*term)?, coefficient)?;
                    total = self.add(&total, &term)?;
                }
                Ok(total)
            }
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

    /// A function of the table at an argument.
    fn applied(&self, expr: Expr, function: Function, argument: &Fraction) -> Result<Fraction, Obstacle> {
        let opposed = || -> Result<(Fraction, Fraction), Obstacle> {
            Ok((self.exponential(argument)?, self.exponential(&negated(argument))?))
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
        }
    }

    /// The same call over arguments in normal form, so that equal arguments make equal kernels.
    pub(in crate::cas::field) fn tidy_call(&self, expr: Expr) -> Result<Expr, Obstacle> {
        let Node::Call(function, arguments) = self.arena.node(expr) else { return Ok(expr) };
        let mut tidied = Vec::with_capacity(arguments.len());
        for argument in arguments.iter() {
            tidied.push(self.show(&self.get(*argument)?));
        }
        Ok(self.arena.call(function, &tidied))
    }
}

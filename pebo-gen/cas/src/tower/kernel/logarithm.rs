//! Logarithms: for a product, the sum of the logarithms of the absolute values of its parts.
//!
//! `log(a*b) = log|a| + log|b|` holds wherever the left side has a value. A part of known sign needs no absolute value;
//! a single part of unknown sign is positive wherever the logarithm has a value, which is learned as a fact.

use crate::graph::expr::Node;
use crate::graph::function::Function;
use crate::poly::Poly;
use crate::{Rational, Relation};

use super::elements::UnsignedFactors;
use crate::tower::fraction::Fraction;
use crate::tower::{Field, Obstacle};

impl Field<'_> {
    /// The logarithm of an argument.
    pub(in crate::tower) fn logarithm(&self, argument: &Fraction) -> Result<Fraction, Obstacle> {
        if argument.is_zero() {
            return Err(Obstacle::DivisionByZero);
        }
        let with = |total: &Fraction, part: &Poly, times: i64| {
            self.add(total, &self.scale(&self.log_of_part(part)?, &Rational::from(times))?)
        };
        let mut total = Fraction::zero();
        let UnsignedFactors { negative, parts: unknown } = self.elements_of(argument, &mut |part, times| {
            total = with(&total, part, times)?;
            Ok(())
        })?;
        let odd: Vec<usize> = (0..unknown.len()).filter(|&index| unknown[index].1 % 2 != 0).collect();
        if odd.is_empty() && negative {
            let shown = self.arena.print(self.show(argument));
            return Err(Obstacle::Kernel(format!("the logarithm of {shown}, which is not positive")));
        }
        for (index, (part, times)) in unknown.iter().enumerate() {
            let size = if odd == [index] {
                let size = if negative { -part } else { part.clone() };
                self.signs().learn_from_existence(&size, Relation::Positive)?;
                size
            } else {
                self.size(part)?.num
            };
            total = with(&total, &size, *times)?;
        }
        Ok(total)
    }

    /// The logarithm of a part that is positive where the logarithm has a value.
    fn log_of_part(&self, part: &Poly) -> Result<Fraction, Obstacle> {
        if let ([variable], true) = (part.variables(), part.term_count() == 1 && part.total_degree() == 1) {
            let expr = self.kernel(*variable);
            match self.arena.node(expr) {
                Node::Call(Function::Exp, inside) => return self.fraction(inside[0]),
                // log(a^(1/q)) = log(a)/q: both have values where a is positive.
                Node::Product(product) if self.is_plain_root(expr) => {
                    let (base, exponent) = &product.factors[0];
                    return self.scale(&self.logarithm(&self.fraction(*base)?)?, exponent);
                }
                _ => {}
            }
        }
        Ok(self.log_kernel(part))
    }

    fn log_kernel(&self, part: &Poly) -> Fraction {
        let call = self.arena.call(Function::Log, &[self.show_polynomial(part)]);
        match self.arena.as_number(call) {
            Some(value) => Fraction::constant(&value),
            None => self.entered(call, None, false),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Arena;
    use crate::Facts;

    /// If x^2*y has a logarithm, y is positive, and nothing is known of x.
    #[test]
    fn a_single_odd_factor_is_positive() {
        let arena = Arena::new();
        let [x, y, z] = ["x", "y", "z"].map(|name| arena.variable(name));
        let square = arena.mul(x, x);
        for (argument, shown, learned) in [
            (square, "2*log(abs(x))", 0),
            (arena.mul(square, y), "2*log(abs(x)) + log(y)", 1),
            (arena.neg(arena.mul(square, y)), "2*log(abs(x)) + log(-y)", 1),
            (arena.product([square, y, z]), "2*log(abs(x)) + log(abs(y)) + log(abs(z))", 0),
        ] {
            let field = Field::over(&arena, &Facts::new(), &[x, y, z]).unwrap();
            let log = field.logarithm(&field.fraction(argument).unwrap()).unwrap();
            assert_eq!(arena.print(field.show(&log)), shown);
            assert_eq!(field.signs().count_learned(), learned, "{shown}");
        }
    }
}

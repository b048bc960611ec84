//! Logarithms: of a product, the sum of the logarithms of the magnitudes of its parts.
//!
//! `log(a*b) = log|a| + log|b|` holds wherever the left side has a value. A part of known sign needs no
//! magnitude; a single part of unknown sign is positive where the logarithm has a value, which is
//! learned as a fact.

use crate::cas::expr::Node;
use crate::cas::facts::Relation as Compared;
use crate::cas::function::Function;
use crate::cas::integer::Integer;
use crate::cas::poly::Poly;
use crate::cas::rational::Rational;

use crate::cas::field::fraction::{Fraction, primitive};
use crate::cas::field::sign::Sign;
use crate::cas::field::{Field, Obstacle};

impl Field<'_> {
    /// The logarithm of an argument.
    pub(in crate::cas::field) fn logarithm(&self, argument: &Fraction) -> Result<Fraction, Obstacle> {
        if argument.is_zero() {
            return Err(Obstacle::DivisionByZero);
        }
        let mut total = Fraction::zero();
        let mut negative = false;
        let mut unknown: Vec<(Poly, i64)> = Vec::new();
        let add = |total: &Fraction, log: &Fraction, times: i64| -> Result<Fraction, Obstacle> {
            self.add(total, &self.scale(log, &Rational::from(times))?)
        };
        for (poly, direction) in [(&argument.num, 1), (&argument.den, -1)] {
            let (content, rest) = primitive(poly);
            for (prime, times) in prime_powers(&content) {
                let log = self.log_kernel(&Poly::constant(prime));
                total = add(&total, &log, direction * i64::from(times))?;
            }
            let product = self.product_of(&rest)?;
            negative ^= product.negative;
            for (prime, times) in prime_powers(&product.divisor) {
                let log = self.log_kernel(&Poly::constant(prime));
                total = add(&total, &log, -direction * i64::from(times))?;
            }
            for (part, times) in product.powers {
                let times = direction * i64::from(times);
                match self.sign_of_part(&part)? {
                    Some(sign) => {
                        let below = sign == Sign::Negative;
                        negative ^= below && times % 2 != 0;
                        total = add(&total, &self.log_of_part(&if below { -&part } else { part })?, times)?;
                    }
                    None => unknown.push((part, times)),
                }
            }
        }
        let odd: Vec<usize> = (0..unknown.len()).filter(|&index| unknown[index].1 % 2 != 0).collect();
        if odd.is_empty() && negative {
            let shown = self.arena.print(self.show(argument));
            return Err(Obstacle::Kernel(format!("the logarithm of {shown}, which is not positive")));
        }
        for (index, (part, times)) in unknown.iter().enumerate() {
            let log = if odd == [index] {
                let size = if negative { -part } else { part.clone() };
                self.learn_from_existence(&size, Compared::Positive)?;
                self.log_of_part(&size)?
            } else {
                self.log_of_part(&self.size(part)?.num)?
            };
            total = add(&total, &log, *times)?;
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

/// The prime factors of a positive integer, small ones by trial; what remains counts as one.
pub(in crate::cas::field) fn prime_powers(number: &Integer) -> Vec<(Integer, u32)> {
    const LARGEST: i64 = 1000;
    let mut rest = number.abs();
    let mut powers = Vec::new();
    let mut candidate = 2;
    while candidate <= LARGEST && !rest.is_one() && !rest.is_zero() {
        let prime = Integer::from(candidate);
        let mut times = 0;
        while let Some(quotient) = rest.div_exact(&prime) {
            rest = quotient;
            times += 1;
        }
        if times > 0 {
            powers.push((prime, times));
        }
        candidate += 1;
    }
    if !rest.is_one() && !rest.is_zero() {
        powers.push((rest, 1));
    }
    powers
}

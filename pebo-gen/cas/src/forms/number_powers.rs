//! Powers of numbers, and logarithms of numbers.
//!
//! In: an expression as the normal form has it, with logarithms of primes: `exp(x*log(2))*exp(x*log(5))`,
//! `log(2) + log(5)`. Out: the same with one number, `exp(x*log(10))` and `log(10)`; and `exp(x*log(10))` taken apart
//! as the power `10^x`, which is how it is written.

use rustc_hash::{FxHashMap, FxHashSet};

use crate::graph::expr::{Expr, Node};
use crate::graph::function::Function;
use crate::{Arena, Rational};

/// Numbers of more bits are longer than the logarithms that they replace.
const MOST_BITS: u64 = 64;

/// The exponential of an argument as a power of a number: `10` and `-x` for `exp(-x*log(10))`.
pub(crate) fn as_power(arena: &Arena, argument: Expr) -> Option<(Rational, Expr)> {
    let Multiple { number, coefficient, rest } = Multiple::of(arena, argument)?;
    Some((number, arena.scale(rest, &coefficient)))
}

/// The parts of an expression in the order of printing: those that a power of a number is written with come before it.
pub(crate) fn printed_parts(arena: &Arena, expr: Expr) -> Vec<Expr> {
    let mut roots = vec![expr];
    let mut placed: FxHashSet<Expr> = FxHashSet::default();
    loop {
        let mut met: FxHashSet<Expr> = FxHashSet::default();
        let in_order = roots.iter().flat_map(|root| arena.postorder(&[*root]));
        let parts: Vec<Expr> = in_order.filter(|part| met.insert(*part)).collect();
        let exponent = |part: &Expr| match arena.node(*part) {
            Node::Call(Function::Exp, argument) => Some(as_power(arena, argument[0])?.1),
            _ => None,
        };
        // A part that comes by itself may come too late.
        let mut open: Vec<Expr> =
            parts.iter().filter_map(exponent).filter(|exponent| placed.insert(*exponent)).collect();
        if open.is_empty() {
            return parts;
        }
        open.append(&mut roots);
        roots = open;
    }
}

/// The expression with one logarithm for several of numbers, wherever their sum or the product of their exponentials has
/// one.
pub(crate) fn joined(arena: &Arena, expr: Expr) -> Expr {
    let mut known: FxHashMap<Expr, Expr> = FxHashMap::default();
    for part in arena.postorder(&[expr]) {
        let rebuilt = arena.rebuild(part, &known);
        let joined = match arena.node(rebuilt) {
            Node::Product(product) => {
                let (exponents, others) = parted(&product.factors, |(base, power)| match arena.node(*base) {
                    Node::Call(Function::Exp, argument) => Some(Multiple::of(arena, argument[0])?.times(power)),
                    _ => None,
                });
                Multiple::joined(arena, exponents).map(|exponents| {
                    let powers = exponents.into_iter().map(|exponent| {
                        let argument = exponent.expr(arena);
                        (arena.call(Function::Exp, &[argument]), Rational::ONE)
                    });
                    arena.multiply(&product.coefficient, powers.chain(others))
                })
            }
            Node::Sum(sum) => {
                let (logarithms, others) =
                    parted(&sum.terms, |(term, times)| Some(Multiple::of(arena, *term)?.times(times)));
                Multiple::joined(arena, logarithms).map(|logarithms| {
                    let terms = logarithms.into_iter().map(|multiple| (multiple.expr(arena), Rational::ONE));
                    arena.combine(&sum.constant, terms.chain(others))
                })
            }
            _ => None,
        };
        known.insert(part, joined.unwrap_or(rebuilt));
    }
    known[&expr]
}

/// Multiples of logarithms of numbers, and the others.
fn parted(
    entries: &[(Expr, Rational)],
    of: impl Fn(&(Expr, Rational)) -> Option<Multiple>,
) -> (Vec<Multiple>, Vec<(Expr, Rational)>) {
    let (mut found, mut others) = (Vec::new(), Vec::new());
    for entry in entries {
        match of(entry) {
            Some(multiple) => found.push(multiple),
            None => others.push(entry.clone()),
        }
    }
    (found, others)
}

/// `coefficient * rest * log(number)`.
struct Multiple {
    number: Rational,
    coefficient: Rational,
    rest: Expr,
}

impl Multiple {
    fn of(arena: &Arena, expr: Expr) -> Option<Self> {
        let logarithm = |e: Expr| match arena.node(e) {
            Node::Call(Function::Log, argument) => arena.as_number(argument[0]),
            _ => None,
        };
        let Node::Product(product) = arena.node(expr) else {
            let number = logarithm(expr)?;
            return Some(Self { number, coefficient: Rational::ONE, rest: arena.one() });
        };
        let mut found = None;
        let mut others = Vec::new();
        for (base, power) in &product.factors {
            match logarithm(*base).filter(|_| power.is_one() && found.is_none()) {
                Some(number) => found = Some(number),
                None => others.push((*base, power.clone())),
            }
        }
        let rest = arena.multiply(&Rational::ONE, others);
        Some(Self { number: found?, coefficient: product.coefficient.clone(), rest })
    }

    fn times(self, factor: &Rational) -> Self {
        Self { coefficient: &self.coefficient * factor, ..self }
    }

    fn expr(&self, arena: &Arena) -> Expr {
        let logarithm = arena.call(Function::Log, &[arena.number(self.number.clone())]);
        arena.scale(arena.mul(self.rest, logarithm), &self.coefficient)
    }

    /// The multiples with those of one rest as one; none where each has a rest of its own.
    fn joined(arena: &Arena, multiples: Vec<Self>) -> Option<Vec<Self>> {
        let count = multiples.len();
        let mut joined: Vec<Self> = Vec::new();
        for multiple in multiples {
            let same = joined.iter().position(|known| known.rest == multiple.rest);
            match same.and_then(|place| Some((place, joined[place].with(&multiple)?))) {
                Some((place, both)) => joined[place] = both,
                None => joined.push(multiple),
            }
        }
        let is_nonzero = |multiple: &Self| !multiple.number.is_one() && !arena.is_zero(multiple.rest);
        (joined.len() < count && joined.iter().all(is_nonzero)).then_some(joined)
    }

    /// `a*log(m) + b*log(n)` as a multiple of one logarithm.
    fn with(&self, other: &Self) -> Option<Self> {
        let unit = self.coefficient.gcd(&other.coefficient);
        let power = |multiple: &Self| {
            let times = i32::try_from(multiple.coefficient.checked_div(&unit)?.to_i64()?).ok()?;
            let bits = u64::from(times.unsigned_abs()).checked_mul(multiple.number.bits())?;
            (bits <= MOST_BITS).then(|| multiple.number.pow(times))?
        };
        let number = &power(self)? * &power(other)?;
        // Of a number and its inverse the greater one.
        Some(match number.recip().filter(|inverse| *inverse > number) {
            Some(inverse) => Self { number: inverse, coefficient: -&unit, rest: self.rest },
            None => Self { number, coefficient: unit, rest: self.rest },
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn logarithms_and_powers_of_primes_are_joined() {
        let arena = Arena::new();
        let [x, a] = ["x", "a"].map(|name| arena.variable(name));
        let log = |n: i64| arena.call(Function::Log, &[arena.number(n)]);
        let power = |n: i64, e: Expr| arena.raise(arena.number(n), e);
        let by = |e: Expr, n: i64, d: i64| arena.scale(e, &Rational::new(n, d).unwrap());
        let cases = [
            (arena.add(log(2), log(5)), "log(10)"),
            (arena.sum([by(log(2), 3, 1), log(5), a]), "a + log(40)"),
            (arena.add(by(arena.mul(x, log(2)), 1, 2), by(arena.mul(x, log(5)), 1, 2)), "x*log(10)/2"),
            (arena.sub(log(5), log(2)), "log(5/2)"),
            (arena.sub(log(2), log(5)), "-log(5/2)"),
            (arena.product([a, power(2, x), power(5, x)]), "a*10^x"),
            (arena.mul(arena.power(power(2, x), &2.into()), arena.power(power(5, x), &2.into())), "10^(2*x)"),
            (arena.div(a, arena.mul(power(2, x), power(5, x))), "a*10^(-x)"),
            (arena.mul(power(2, x), power(5, a)), "2^x*5^a"),
            (arena.add(arena.mul(x, log(2)), log(5)), "log(5) + x*log(2)"),
            (arena.call(Function::Exp, &[x]), "exp(x)"),
            // The exponent is a part of its own, behind the power.
            (arena.add(power(10, arena.mul(a, x)), arena.mul(a, x)), "x*a + 10^(x*a)"),
            (power(2, power(2, power(2, x))), "2^(2^(2^x))"),
            (arena.power(power(10, arena.add(a, x)), &2.into()), "(10^(x + a))^2"),
            (power(10, by(x, 1, 2)), "10^(x/2)"),
            (arena.raise(arena.number(Rational::new(1, 3).unwrap()), x), "(1/3)^x"),
        ];
        for (expr, expected) in cases {
            assert_eq!(arena.print(joined(&arena, expr)), expected);
        }
        // Too long a number.
        let long = arena.add(by(log(2), 99, 1), log(3));
        assert_eq!(joined(&arena, long), long);
    }
}

//! Values of kernels modulo a prime that agree with their relations.
//!
//! In: a field of kernels, and random words. Out: a residue for each kernel, so that `r^2 = a` holds of roots and
//! `sin^2 + cos^2 = 1` of angles, and the residues of fractions there. An identity among the fractions holds at every
//! such point; a relation at random ones is an identity unless the words were unlucky, which directs a search and
//! proves nothing.

use super::{Field, Fraction};
use crate::poly::{Poly, PrimeField, Residue};

/// The greatest number of times that the kernels are drawn anew because a root has no value.
const MOST_DRAWS: usize = 200;

/// The largest prime p below 2^62 for which (p - 1)/2 is prime as well: every root of odd degree exists once, and every
/// root of even degree exists of each square.
const PRIME: u64 = (1 << 62) - 10_565;

/// Each such prime is 11 modulo 12.
const STEP: usize = 12;

/// Random words (`SplitMix64`, Steele, Lea and Flood 2014), the same ones every time.
#[derive(Debug)]
pub struct Words(u64);

impl Words {
    /// Draws from a seed.
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    pub(crate) fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }
}

/// The prime field in which kernels have values.
pub fn prime_of_kernels() -> Option<PrimeField> {
    PrimeField::new(PRIME)
}

impl Field<'_> {
    /// The primes modulo which the kernels may have values, the largest first: the square roots of numbers exist there,
    /// as that of 2 does modulo every other.
    pub fn primes(&self) -> impl Iterator<Item = PrimeField> {
        let kernels = self.round.kernels.borrow();
        let relations = kernels.iter().filter_map(|(_, kernel)| kernel.relation.as_ref());
        let of_numbers = relations.filter(|relation| relation.degree % 2 == 0 && relation.value.variables().is_empty());
        let radicands: Vec<Poly> = of_numbers.map(|relation| relation.value.clone()).collect();
        let fits = move |prime: &PrimeField| {
            let value = |radicand: &Poly| radicand.evaluate_mod(prime, |_| Residue::ZERO);
            radicands.iter().all(|radicand| prime.is_square(value(radicand)))
        };
        let safe = |prime: u64| PrimeField::new(prime >> 1).and_then(|_| PrimeField::new(prime));
        (1..=PRIME).rev().step_by(STEP).filter_map(safe).filter(fits)
    }

    /// Residues of all kernels, which are kept where they are given; none if a relation cannot be met.
    pub fn draw(
        &self,
        prime: &PrimeField,
        words: &mut Words,
        kept: impl Fn(u32) -> Option<Residue>,
    ) -> Option<Vec<Residue>> {
        (0..MOST_DRAWS).find_map(|_| self.drawn(prime, words, &kept))
    }

    fn drawn(
        &self,
        prime: &PrimeField,
        words: &mut Words,
        kept: &impl Fn(u32) -> Option<Residue>,
    ) -> Option<Vec<Residue>> {
        let kernels = self.round.kernels.borrow();
        let mut values: Vec<Residue> = Vec::new();
        for (number, kernel) in kernels.iter() {
            let value = match (&kernel.relation, kept(number)) {
                (_, Some(value)) => value,
                (None, None) => prime.from_u64(words.next()),
                (Some(relation), None) => {
                    if relation.value.variables().iter().any(|variable| *variable >= number) {
                        return None;
                    }
                    let radicand = relation.value.evaluate_mod(prime, |variable| values[variable as usize]);
                    root(prime, radicand, relation.degree)?
                }
            };
            values.push(value);
        }
        Some(values)
    }
}

impl Fraction {
    /// The residue if kernels have these values; none if the denominator vanishes, or a kernel has no value.
    pub(crate) fn residue(&self, prime: &PrimeField, values: &[Residue]) -> Option<Residue> {
        if self.variables().any(|variable| variable as usize >= values.len()) {
            return None;
        }
        let at = |variable: u32| values[variable as usize];
        let above = self.numerator().evaluate_mod(prime, at);
        if self.denominator().is_one() {
            return Some(above);
        }
        Some(prime.mul(above, prime.inv(self.denominator().evaluate_mod(prime, at))?))
    }
}

/// A root of that degree, if there is one.
fn root(prime: &PrimeField, value: Residue, degree: u32) -> Option<Residue> {
    // The squares are a group of this order, which is prime.
    let order = prime.prime() >> 1;
    let degree = u64::from(degree);
    // The inverse of the degree modulo that order.
    let inverse = (1..degree.max(2)).find_map(|turn| {
        let multiple = u128::from(turn) * u128::from(order) + 1;
        multiple.is_multiple_of(u128::from(degree)).then_some(multiple / u128::from(degree))
    });
    let inverse = u64::try_from(inverse?).ok()?;
    if prime.is_square(value) {
        return Some(prime.pow(value, inverse));
    }
    // -1 is no square.
    (degree % 2 == 1).then(|| prime.neg(prime.pow(prime.neg(value), inverse)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Facts;
    use crate::Rational;
    use crate::{Arena, Function};

    #[test]
    fn square_roots_of_numbers_have_values_modulo_one_of_the_primes() {
        let arena = Arena::new();
        let h = arena.variable("h");
        let number =
            |numerator: i64, denominator: i64| arena.number(Rational::new(numerator, denominator).expect("a rational"));
        let roots = [number(2, 1), number(3, 1), number(5, 7), number(981, 50), number(1, 11), number(13, 1)];
        let nested = arena.sqrt(arena.add(arena.sqrt(number(2, 1)), number(2, 1)));
        let roots: Vec<_> =
            roots.into_iter().map(|radicand| arena.sqrt(arena.mul(radicand, h))).chain([nested]).collect();
        let field = Field::over(&arena, &Facts::new(), &roots).expect("a field");
        let values = |prime: PrimeField| field.draw(&prime, &mut Words::new(1), |_| None);
        assert!(values(prime_of_kernels().expect("a prime")).is_none());
        assert!(field.primes().take(16).any(|prime| values(prime).is_some()));
    }

    #[test]
    fn residues_agree_with_the_relations_of_kernels() {
        let arena = Arena::new();
        let [a, b] = ["a", "b"].map(|name| arena.variable(name));
        let third = crate::Rational::new(1, 3).expect("a rational");
        let roots = [
            arena.call(Function::Sin, &[a]),
            arena.call(Function::Cos, &[arena.scale(a, &2.into())]),
            arena.sqrt(arena.add(b, arena.one())),
            arena.power(b, &third),
            arena.call(Function::Exp, &[arena.add(a, b)]),
        ];
        let field = Field::over(&arena, &Facts::new(), &roots).expect("a field");
        let prime = prime_of_kernels().expect("prime");
        let mut words = Words::new(1);
        let square = |e| arena.mul(e, e);
        let identities = [
            arena.sum([arena.scale(square(roots[0]), &2.into()), roots[1], arena.number(-1)]),
            arena.sum([square(roots[2]), arena.neg(b), arena.number(-1)]),
            arena.sub(arena.power(roots[3], &3.into()), b),
        ];
        for _ in 0..5 {
            let values = field.draw(&prime, &mut words, |_| None).expect("values");
            let residue = |e| field.fraction(e).expect("a fraction").residue(&prime, &values).expect("a value");
            assert!(identities.iter().all(|e| residue(*e).is_zero()));
            assert!(roots.iter().all(|e| !residue(*e).is_zero()));
        }
    }
}

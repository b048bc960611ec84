//! Trigonometric polynomials over sums of angles: `sin(a)*cos(b) + cos(a)*sin(b)` is `sin(a + b)`.
//!
//! In: a fraction whose kernels are sines and cosines of basis angles, as the addition theorems leave them. Out: the
//! same with each product of them as a sum of sines and cosines of sums and differences (its finite Fourier series),
//! for printing: an arm whose author writes `sin(y1 + y2)` gets that back.

use std::collections::BTreeMap;

use crate::graph::expr::{Expr, Node};
use crate::graph::function::Function;
use crate::number::rational::half;
use crate::poly::{Monomial, Poly};
use crate::{Integer, Rational};

use super::Field;
use super::fraction::Fraction;

/// A product of n sines and cosines has up to 2^(n-1) summands.
const MOST_FACTORS: u32 = 8;

/// The greatest number of terms of a polynomial in this form.
const MOST_TERMS: usize = 200;

/// A sine or cosine of a sum of multiples of the basis angles.
type Wave = (Vec<i32>, Function);

impl Field<'_> {
    /// The fraction with its products of sines and cosines written as sums; none if there are none, or too many.
    pub fn show_by_angles(&self, fraction: &Fraction) -> Option<Expr> {
        let mut angles: Vec<Expr> = Vec::new();
        let mut factors: BTreeMap<u32, (usize, Function)> = BTreeMap::new();
        for variable in fraction.variables() {
            if let Node::Call(function @ (Function::Sin | Function::Cos), arguments) =
                self.arena.node(self.kernel(variable))
            {
                let index = angles.iter().position(|angle| *angle == arguments[0]).unwrap_or(angles.len());
                if index == angles.len() {
                    angles.push(arguments[0]);
                }
                factors.insert(variable, (index, function));
            }
        }
        let degree = |monomial: &Monomial| -> u32 {
            monomial.powers().iter().filter(|(v, _)| factors.contains_key(v)).map(|(_, exponent)| *exponent).sum()
        };
        let degrees = |poly: &Poly| poly.terms().map(|(monomial, _)| degree(&monomial)).max().unwrap_or(0);
        let (numerator, denominator) = (degrees(&fraction.num), degrees(&fraction.den));
        let long = fraction.num.term_count().max(fraction.den.term_count()) > MOST_TERMS;
        if numerator.max(denominator) < 2 || numerator.max(denominator) > MOST_FACTORS || long {
            return None;
        }
        let series = |poly: &Poly| self.series(poly, &angles, &factors);
        Some(self.arena.div(series(&fraction.num), series(&fraction.den)))
    }

    fn series(&self, poly: &Poly, angles: &[Expr], factors: &BTreeMap<u32, (usize, Function)>) -> Expr {
        // By the other kernels of a term, and by wave.
        let mut terms: BTreeMap<(Monomial, Wave), Rational> = BTreeMap::new();
        for (monomial, coefficient) in poly.terms() {
            let start = (vec![0; angles.len()], Function::Cos);
            let mut waves = BTreeMap::from([(start, Rational::from(coefficient.clone()))]);
            for (variable, exponent) in monomial.powers() {
                let Some((angle, function)) = factors.get(variable) else { continue };
                for _ in 0..*exponent {
                    waves = times(&waves, *angle, *function);
                }
            }
            let others = monomial.powers().iter().copied().filter(|(v, _)| !factors.contains_key(v));
            let others = Monomial::new(others);
            for (wave, amplitude) in waves {
                let total = terms.entry((others.clone(), wave)).or_insert(Rational::ZERO);
                *total = &*total + &amplitude;
            }
        }
        terms.retain(|_, amplitude| !amplitude.is_zero());
        // Each wave as a variable of its own, and amplitudes over one denominator: the grouping of terms takes
        // integers.
        let mut waves: Vec<Wave> = terms.keys().map(|(_, wave)| wave.clone()).collect();
        waves.sort();
        waves.dedup();
        let first = self.round.kernels.borrow().count();
        let number = |wave: &Wave| (first..).zip(&waves).find(|(_, own)| *own == wave).map(|(number, _)| number);
        let scale = terms.values().fold(Integer::ONE, |scale, amplitude| {
            let denominator = amplitude.denominator();
            let common = scale.gcd(&denominator);
            &scale * &denominator.div_exact(&common).unwrap_or(denominator)
        });
        let whole = Rational::from(scale.clone());
        let grouped = terms.iter().filter_map(|((others, wave), amplitude)| {
            let constant = wave.1 == Function::Cos && wave.0.iter().all(|multiple| *multiple == 0);
            let own = if constant { None } else { Some((number(wave)?, 1)) };
            Some((Monomial::new(others.powers().iter().copied().chain(own)), (amplitude * &whole).numerator()))
        });
        let named = |variable: u32| match waves.get(variable.wrapping_sub(first) as usize) {
            Some((multiples, function)) if variable >= first => {
                let angle = angles
                    .iter()
                    .zip(multiples)
                    .map(|(angle, multiple)| (*angle, Rational::from(i64::from(*multiple))));
                self.arena.call(*function, &[self.arena.combine(&Rational::ZERO, angle)])
            }
            _ => self.kernel(variable),
        };
        let sum = self.grouped(grouped.collect(), &named);
        self.arena.scale(sum, &Rational::new(Integer::ONE, scale).unwrap_or(Rational::ONE))
    }
}

/// A sum of waves times the sine or cosine of a basis angle.
fn times(waves: &BTreeMap<Wave, Rational>, angle: usize, function: Function) -> BTreeMap<Wave, Rational> {
    let mut product: BTreeMap<Wave, Rational> = BTreeMap::new();
    let mut add = |mut multiples: Vec<i32>, function: Function, mut amplitude: Rational| {
        // cos(-a) = cos(a), sin(-a) = -sin(a)
        let first = multiples.iter().find(|multiple| **multiple != 0).copied();
        if first.is_none() && function == Function::Sin {
            return;
        }
        if first.is_some_and(|first| first < 0) {
            multiples = multiples.into_iter().map(|multiple| -multiple).collect();
            if function == Function::Sin {
                amplitude = -&amplitude;
            }
        }
        let total = product.entry((multiples, function)).or_insert(Rational::ZERO);
        *total = &*total + &amplitude;
    };
    for ((multiples, own), amplitude) in waves {
        let moved = |by: i32| {
            let mut moved = multiples.clone();
            moved[angle] += by;
            moved
        };
        let share = amplitude * &half();
        let opposite = -&share;
        match (own, function) {
            (Function::Sin, Function::Sin) => {
                add(moved(-1), Function::Cos, share);
                add(moved(1), Function::Cos, opposite);
            }
            (Function::Sin, _) => {
                add(moved(1), Function::Sin, share.clone());
                add(moved(-1), Function::Sin, share);
            }
            (_, Function::Sin) => {
                add(moved(1), Function::Sin, share);
                add(moved(-1), Function::Sin, opposite);
            }
            _ => {
                add(moved(1), Function::Cos, share.clone());
                add(moved(-1), Function::Cos, share);
            }
        }
    }
    product.retain(|_, amplitude| !amplitude.is_zero());
    product
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Arena;
    use crate::Domain;
    use crate::Facts;
    use crate::domain::zero::is_zero;

    #[test]
    fn products_of_waves_are_shown_as_waves_of_sums() {
        let arena = Arena::new();
        let [a, b, x] = ["a", "b", "x"].map(|name| arena.variable(name));
        let [sin, cos] =
            [Function::Sin, Function::Cos].map(|function| move |arena: &Arena, e| arena.call(function, &[e]));
        let sum = arena.add(a, b);
        for (written, expected) in [
            (sin(&arena, sum), "sin(a + b)"),
            (cos(&arena, sum), "cos(a + b)"),
            (arena.mul(x, arena.add(sin(&arena, a), sin(&arena, sum))), "x*(sin(a + b) + sin(a))"),
            (arena.mul(sin(&arena, a), cos(&arena, a)), "sin(2*a)/2"),
            (arena.mul(sin(&arena, a), sin(&arena, a)), "(1 - cos(2*a))/2"),
        ] {
            let field = Field::over(&arena, &Facts::new(), &[written]).unwrap();
            let shown = field.show_by_angles(&field.fraction(written).unwrap()).unwrap();
            assert_eq!(arena.print(shown), expected, "{}", arena.print(written));
        }
        let field = Field::over(&arena, &Facts::new(), &[sin(&arena, a)]).unwrap();
        assert_eq!(field.show_by_angles(&field.fraction(sin(&arena, a)).unwrap()), None, "nothing to be written so");
    }

    #[test]
    fn printed_fractions_are_equal() {
        let arena = Arena::new();
        let symbols = ["a", "b", "x"].map(|name| arena.variable(name));
        let wave = |function, n: i64| {
            let angle = arena.add(symbols[0], arena.scale(symbols[1], &Rational::from(n)));
            arena.call(function, &[angle])
        };
        for (n, m) in [(0, 1), (1, -1), (2, 0), (-2, 0)] {
            let written = arena.sum([
                arena.product([wave(Function::Sin, n), wave(Function::Cos, m), wave(Function::Sin, m), symbols[2]]),
                arena.scale(wave(Function::Cos, n + m), &Rational::new(2, 3).unwrap()),
                arena.one(),
            ]);
            let field = Field::over(&arena, &Facts::new(), &[written]).unwrap();
            let shown = field.show_by_angles(&field.fraction(written).unwrap()).unwrap();
            let difference = arena.sub(shown, written);
            assert!(is_zero(&arena, difference, &Domain::default()), "{}", arena.print(shown));
        }
    }
}

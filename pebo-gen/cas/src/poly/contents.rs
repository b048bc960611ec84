//! Contents and coefficients of a polynomial in some of its variables.

use std::cmp::Ordering;

use smallvec::SmallVec;

use super::work::{TooLarge, Work};
use super::{Monomial, Poly};
use crate::Integer;

impl Poly {
    /// The greatest common divisor of the coefficients: positive, zero of zero.
    pub fn content(&self) -> Integer {
        let mut content = Integer::ZERO;
        for coefficient in &self.coefficients {
            content = content.gcd(coefficient);
            if content.is_one() {
                break;
            }
        }
        content
    }

    /// The integer and the polynomial whose product this is, the latter with coefficients without a
    /// common divisor and a positive leading one. Both are zero of zero.
    pub fn primitive(&self) -> (Integer, Self) {
        let absolute = self.content();
        let content = if self.leading_coefficient().is_negative() { -absolute } else { absolute };
        let part = if content.is_one() { None } else { self.div_integer(&content) };
        (content, part.unwrap_or_else(|| self.clone()))
    }

    /// The product of the powers of variables that divide every term; 1 of zero.
    pub fn monomial_content(&self) -> Monomial {
        Monomial::new(self.variables().iter().copied().zip(self.layout.least(&self.keys)))
    }

    /// The coefficient of a power product, if it is among the terms: found by bisection.
    pub fn coefficient(&self, monomial: &Monomial) -> Option<&Integer> {
        let words = self.layout.words();
        let mut key = SmallVec::<[u64; 8]>::from_elem(0, words);
        for (variable, exponent) in monomial.powers() {
            let index = self.layout.position(*variable)?;
            if u64::from(*exponent) > self.layout.mask() {
                return None;
            }
            self.layout.add(&mut key, index, *exponent);
        }
        let (mut low, mut high) = (0, self.coefficients.len());
        while low < high {
            let middle = low.midpoint(high);
            match self.key(middle).cmp(&key) {
                Ordering::Equal => return self.coefficients.get(middle),
                // Terms descend.
                Ordering::Greater => low = middle + 1,
                Ordering::Less => high = middle,
            }
        }
        None
    }

    /// The quotient by a power product that divides every term.
    pub(super) fn over_monomial(&self, divisor: &Monomial) -> Self {
        if divisor.is_one() {
            return self.clone();
        }
        let mut keys = self.keys.clone();
        for (variable, exponent) in divisor.powers() {
            if let Some(index) = self.layout.position(*variable) {
                let (word, shift) = self.layout.place(index);
                for key in keys.chunks_exact_mut(self.layout.words()) {
                    key[word] -= u64::from(*exponent) << shift;
                }
            }
        }
        Self::from_sorted(self.layout.clone(), keys, self.coefficients.clone())
    }

    /// The product with a power product and an integer.
    pub fn mul_term(&self, monomial: &Monomial, coefficient: &Integer, work: &Work) -> Result<Self, TooLarge> {
        self.mul(&Self::from_terms([(monomial.clone(), coefficient.clone())])?, work)
    }

    /// The coefficients of this as a polynomial in some variables, with the power products of those
    /// variables in descending order. No coefficient is zero, and none has the variables.
    pub fn collect(&self, variables: &[u32]) -> Vec<(Monomial, Self)> {
        let words = self.layout.words();
        let mut mask = vec![0; words];
        for variable in variables {
            if let Some(index) = self.layout.position(*variable) {
                let (word, shift) = self.layout.place(index);
                mask[word] |= self.layout.mask() << shift;
            }
        }
        let selected: Vec<u64> = self.keys().flat_map(|key| key.iter().zip(&mask).map(|(word, m)| word & m)).collect();
        let part = |term: usize| &selected[term * words..][..words];
        let mut order: Vec<usize> = (0..self.term_count()).collect();
        // Stable: terms that agree in the selected variables still descend in the others.
        order.sort_by(|a, b| part(*b).cmp(part(*a)));
        let coefficient = |run: &[usize]| {
            let keys = run.iter().flat_map(|term| self.key(*term).iter().zip(&mask).map(|(word, m)| word & !m));
            let coefficients = run.iter().map(|term| self.coefficients[*term].clone());
            Self::from_sorted(self.layout.clone(), keys.collect(), coefficients.collect())
        };
        order
            .chunk_by(|a, b| part(*a) == part(*b))
            .map(|run| (self.layout.monomial(part(run[0])), coefficient(run)))
            .collect()
    }

    /// The coefficients of the powers of one variable, highest first, those that are not zero.
    pub fn coefficients_in(&self, variable: u32) -> Vec<(u32, Self)> {
        self.collect(&[variable])
            .into_iter()
            .map(|(monomial, coefficient)| (monomial.exponent(variable), coefficient))
            .collect()
    }

    /// The coefficient of the highest power of a variable.
    pub fn leading_coefficient_in(&self, variable: u32) -> Self {
        let degree = self.degree(variable);
        let Some(index) = self.layout.position(variable) else {
            return self.clone();
        };
        let (mut keys, mut coefficients) = (Vec::new(), Vec::new());
        for (key, coefficient) in self.keys().zip(&self.coefficients) {
            if self.layout.get(key, index) == degree {
                let start = keys.len();
                keys.extend_from_slice(key);
                let (word, shift) = self.layout.place(index);
                keys[start + word] &= !(self.layout.mask() << shift);
                coefficients.push(coefficient.clone());
            }
        }
        Self::from_sorted(self.layout.clone(), keys, coefficients)
    }

    /// The partial derivative.
    pub fn derivative(&self, variable: u32) -> Self {
        let Some(index) = self.layout.position(variable) else {
            return Self::zero();
        };
        let (word, shift) = self.layout.place(index);
        let (mut keys, mut coefficients) = (Vec::new(), Vec::new());
        for (key, coefficient) in self.keys().zip(&self.coefficients) {
            let exponent = self.layout.get(key, index);
            if exponent > 0 {
                let start = keys.len();
                keys.extend_from_slice(key);
                keys[start + word] -= 1 << shift;
                coefficients.push(coefficient * &Integer::from(i64::from(exponent)));
            }
        }
        Self::from_sorted(self.layout.clone(), keys, coefficients)
    }
}

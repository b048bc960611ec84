//! Sparse polynomials in several variables over the integers.
//!
//! ```text
//! kernel numbers, integers -> Poly -> sum, product, quotient, gcd, roots, coefficients, values
//! ```
//!
//! A polynomial carries its own list of variables (plain numbers, whose meaning is the caller's),
//! exactly those that occur in it. So a polynomial in variables 0 and 3 can meet one in variable 1
//! without a common ring, and a new variable costs nothing to the polynomials that lack it.
//!
//! Holds after every operation: terms descend in the lexicographic order (the variable of the
//! smallest index weighs most), no coefficient is zero, and variables and exponent fields are the
//! fewest and the narrowest that hold the terms. Equal polynomials are therefore stored equally,
//! and equality, order and hash are those of the stored form. The order is lexicographic and not
//! graded because nearly everything here looks at a polynomial as one in a main variable, whose
//! coefficients are then contiguous runs of terms.
//!
//! Operations whose cost can explode take a [`Work`] limit and fail with [`TooLarge`]; all others
//! are linear in the number of terms, up to sorting.

mod boxed;
mod contents;
mod divide;
mod evaluate;
mod factors;
mod field;
mod gcd;
mod hashed;
mod irreducible;
mod layout;
mod linear_combination;
mod monomial;
mod multiply;
mod packed;
mod root;
mod square_free;
mod substitute;
mod sums;
mod work;

use std::cmp::Ordering;
use std::fmt;

use crate::Integer;
use layout::{Layout, MAX_EXPONENT, Variables};

pub use field::{PrimeField, Residue};
pub use monomial::Monomial;
pub use square_free::SquareFree;
pub use work::{TooLarge, Work, steps};

/// A polynomial with integer coefficients.
#[derive(Clone, PartialEq, Eq, Hash)]
#[must_use = "arithmetic returns a new polynomial"]
pub struct Poly {
    layout: Layout,
    /// The packed exponents of every term, `layout.words()` each.
    keys: Vec<u64>,
    /// The coefficient of every term.
    coefficients: Vec<Integer>,
}

impl Poly {
    /// The zero polynomial.
    pub fn zero() -> Self {
        Self { layout: Layout::new(Variables::new(), 0), keys: Vec::new(), coefficients: Vec::new() }
    }

    /// The polynomial 1.
    pub fn one() -> Self {
        Self::constant(1)
    }

    /// A constant.
    pub fn constant(value: impl Into<Integer>) -> Self {
        let value = value.into();
        if value.is_zero() {
            return Self::zero();
        }
        let layout = Layout::new(Variables::new(), 0);
        Self { keys: vec![0; layout.words()], layout, coefficients: vec![value] }
    }

    /// A variable.
    pub fn variable(variable: u32) -> Self {
        let layout = Layout::new(Variables::from_elem(variable, 1), 1);
        let mut keys = vec![0; layout.words()];
        layout.add(&mut keys, 0, 1);
        Self { layout, keys, coefficients: vec![Integer::ONE] }
    }

    /// The sum of the given terms, in any order; equal monomials are added up. Fails on exponents
    /// of 2^31 and more.
    pub fn from_terms(terms: impl IntoIterator<Item = (Monomial, Integer)>) -> Result<Self, TooLarge> {
        let terms: Vec<_> = terms.into_iter().collect();
        let powers = || terms.iter().flat_map(|(monomial, _)| monomial.powers());
        let largest = powers().map(|(_, exponent)| *exponent).max().unwrap_or(0);
        if largest > MAX_EXPONENT {
            return Err(TooLarge);
        }
        let mut variables: Vec<u32> = powers().map(|(variable, _)| *variable).collect();
        variables.sort_unstable();
        variables.dedup();
        let layout = Layout::new(variables.into(), largest);
        let mut keys = vec![0; terms.len() * layout.words()];
        for ((monomial, _), key) in terms.iter().zip(keys.chunks_exact_mut(layout.words())) {
            for (variable, exponent) in monomial.powers() {
                if let Some(index) = layout.position(*variable) {
                    layout.add(key, index, *exponent);
                }
            }
        }
        let coefficients = terms.into_iter().map(|(_, coefficient)| coefficient).collect();
        Ok(Self::from_unsorted(layout, &keys, coefficients))
    }

    /// From terms in any order, with possible repetitions and zeros.
    fn from_unsorted(layout: Layout, keys: &[u64], mut coefficients: Vec<Integer>) -> Self {
        let words = layout.words();
        let key = |term: usize| &keys[term * words..][..words];
        let mut order: Vec<usize> = (0..coefficients.len()).collect();
        order.sort_by(|a, b| key(*b).cmp(key(*a)));
        let mut sorted = Vec::with_capacity(keys.len());
        let mut sums: Vec<Integer> = Vec::with_capacity(coefficients.len());
        for run in order.chunk_by(|a, b| key(*a) == key(*b)) {
            let mut sum = std::mem::take(&mut coefficients[run[0]]);
            for term in &run[1..] {
                sum += &coefficients[*term];
            }
            if !sum.is_zero() {
                sorted.extend_from_slice(key(run[0]));
                sums.push(sum);
            }
        }
        Self::from_sorted(layout, sorted, sums)
    }

    /// From descending terms without zeros: brings the layout to its smallest.
    fn from_sorted(layout: Layout, keys: Vec<u64>, coefficients: Vec<Integer>) -> Self {
        let poly = match layout.shrunk(&keys) {
            Some(smallest) => Self { keys: layout.convert(&keys, &smallest), layout: smallest, coefficients },
            None => Self { layout, keys, coefficients },
        };
        debug_assert!(poly.is_canonical(), "{poly:?}");
        poly
    }

    fn is_canonical(&self) -> bool {
        let words = self.layout.words();
        self.keys.len() == self.coefficients.len() * words
            && self.layout.shrunk(&self.keys).is_none()
            && self.coefficients.iter().all(|coefficient| !coefficient.is_zero())
            && self.keys().zip(self.keys().skip(1)).all(|(high, low)| high > low)
    }

    fn keys(&self) -> std::slice::ChunksExact<'_, u64> {
        self.keys.chunks_exact(self.layout.words())
    }

    fn key(&self, term: usize) -> &[u64] {
        &self.keys[term * self.layout.words()..][..self.layout.words()]
    }

    /// The number of terms.
    pub fn term_count(&self) -> usize {
        self.coefficients.len()
    }

    /// True if this is zero.
    pub fn is_zero(&self) -> bool {
        self.coefficients.is_empty()
    }

    /// True if this is the polynomial 1.
    pub fn is_one(&self) -> bool {
        self.to_constant().is_some_and(|value| value.is_one())
    }

    /// True if no variable occurs.
    pub fn is_constant(&self) -> bool {
        self.layout.variables().is_empty()
    }

    /// The value, if no variable occurs.
    pub fn to_constant(&self) -> Option<Integer> {
        let value = || self.coefficients.first().cloned().unwrap_or(Integer::ZERO);
        self.is_constant().then(value)
    }

    /// The variables that occur, ascending.
    pub fn variables(&self) -> &[u32] {
        self.layout.variables()
    }

    /// The terms, leading term first.
    pub fn terms(&self) -> impl DoubleEndedIterator<Item = (Monomial, &Integer)> {
        let monomials = self.keys().map(|key| self.layout.monomial(key));
        monomials.zip(&self.coefficients)
    }

    /// The first term in lexicographic order, unless this is zero.
    pub fn leading_term(&self) -> Option<(Monomial, &Integer)> {
        self.terms().next()
    }

    /// The coefficient of the leading term; zero of zero.
    pub fn leading_coefficient(&self) -> Integer {
        self.coefficients.first().cloned().unwrap_or(Integer::ZERO)
    }

    /// The largest exponent of a variable; 0 if it does not occur.
    pub fn degree(&self, variable: u32) -> u32 {
        let Some(index) = self.layout.position(variable) else {
            return 0;
        };
        self.keys().map(|key| self.layout.get(key, index)).max().unwrap_or(0)
    }

    /// The largest sum of exponents of a term; 0 of zero.
    pub fn total_degree(&self) -> u64 {
        let degree = |key| self.layout.exponents(key).iter().map(|e| u64::from(*e)).sum();
        self.keys().map(degree).max().unwrap_or(0)
    }

    /// The largest exponent of each variable, in the order of [`Self::variables`].
    fn degrees(&self) -> layout::Exponents {
        self.layout.degrees(&self.keys)
    }

    /// The memory of its terms, except for coefficients beyond a word.
    pub(crate) fn bytes(&self) -> usize {
        size_of_val(self.keys.as_slice()) + size_of_val(self.coefficients.as_slice())
    }

    /// The number of bits of the largest coefficient.
    pub fn bits(&self) -> u64 {
        self.coefficients.iter().map(Integer::bits).max().unwrap_or(0)
    }
}

impl Default for Poly {
    fn default() -> Self {
        Self::zero()
    }
}

impl PartialOrd for Poly {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

/// An order to sort by: that of the terms, leading terms first.
impl Ord for Poly {
    fn cmp(&self, other: &Self) -> Ordering {
        self.terms().cmp(other.terms())
    }
}

/// For messages and tests; the variables are written `x0`, `x1` and so on.
impl fmt::Display for Poly {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.is_zero() {
            return f.write_str("0");
        }
        for (index, (monomial, coefficient)) in self.terms().enumerate() {
            let sign = match (coefficient.is_negative(), index) {
                (true, 0) => "-",
                (true, _) => " - ",
                (false, 0) => "",
                (false, _) => " + ",
            };
            let absolute = coefficient.abs();
            f.write_str(sign)?;
            let mut separator = "";
            if monomial.is_one() || !absolute.is_one() {
                write!(f, "{absolute}")?;
                separator = "*";
            }
            for (variable, exponent) in monomial.powers() {
                write!(f, "{separator}x{variable}")?;
                if *exponent > 1 {
                    write!(f, "^{exponent}")?;
                }
                separator = "*";
            }
        }
        Ok(())
    }
}

impl fmt::Debug for Poly {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

#[cfg(test)]
mod tests;

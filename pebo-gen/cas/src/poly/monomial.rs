//! Power products of variables, outside any polynomial.

use std::cmp::Ordering;

use smallvec::SmallVec;

/// A product of powers of variables.
///
/// Holds always: variables ascend, exponents are positive. The order is the lexicographic one of
/// the polynomials: `1 < y < x < x y < x^2` where `x` has a smaller index than `y`.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash)]
pub struct Monomial(SmallVec<[(u32, u32); 4]>);

impl Monomial {
    /// The empty product.
    pub fn one() -> Self {
        Self::default()
    }

    /// The product of the given powers `(variable, exponent)`, in any order, without repetition of
    /// a variable; zero exponents are dropped.
    pub fn new(powers: impl IntoIterator<Item = (u32, u32)>) -> Self {
        let mut powers: SmallVec<[(u32, u32); 4]> = powers.into_iter().filter(|(_, exponent)| *exponent > 0).collect();
        powers.sort_unstable();
        debug_assert!(powers.windows(2).all(|pair| pair[0].0 < pair[1].0), "{powers:?}");
        Self(powers)
    }

    /// The powers `(variable, exponent)`, variables ascending, exponents positive.
    pub fn powers(&self) -> &[(u32, u32)] {
        &self.0
    }

    /// True if this is the empty product.
    pub fn is_one(&self) -> bool {
        self.0.is_empty()
    }

    /// The exponent of a variable.
    pub fn exponent(&self, variable: u32) -> u32 {
        self.0.binary_search_by_key(&variable, |power| power.0).map_or(0, |index| self.0[index].1)
    }

    /// The sum of the exponents.
    pub fn degree(&self) -> u64 {
        self.0.iter().map(|(_, exponent)| u64::from(*exponent)).sum()
    }
}

impl PartialOrd for Monomial {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Monomial {
    fn cmp(&self, other: &Self) -> Ordering {
        for (a, b) in self.0.iter().zip(&other.0) {
            // The smaller variable weighs more, so having it at all decides.
            match b.0.cmp(&a.0).then(a.1.cmp(&b.1)) {
                Ordering::Equal => {}
                decided => return decided,
            }
        }
        self.0.len().cmp(&other.0.len())
    }
}

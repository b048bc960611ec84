//! The packing of exponents into words.
//!
//! A key is the exponents of one term side by side, the variable of the smallest index in the
//! highest bits of the first word: comparing keys as numbers is the lexicographic order, adding
//! them multiplies the monomials. Fields are 4, 8, 16 or 32 bits wide and never straddle words;
//! the highest bit of a field stays clear, so that a borrow shows (Monagan and Pearce, 2007).

use smallvec::SmallVec;

use super::monomial::Monomial;
use super::work::TooLarge;

/// One packed monomial is a run of this many words at most in products and quotients.
pub(super) const MAX_WORDS: usize = 32;

/// No exponent exceeds this.
pub(super) const MAX_EXPONENT: u32 = i32::MAX.cast_unsigned();

/// The variables of a polynomial, ascending.
pub(super) type Variables = SmallVec<[u32; 8]>;
/// One number for each variable of a layout.
pub(super) type Exponents = SmallVec<[u32; 8]>;

/// The variables of a polynomial and the width of their fields.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(super) struct Layout {
    variables: Variables,
    /// The logarithm of the number of bits of a field: every access divides by it.
    log_width: u32,
    words: usize,
}

impl Layout {
    /// For the given variables, ascending, with exponents up to `largest`.
    pub(super) fn new(variables: Variables, largest: u32) -> Self {
        debug_assert!(variables.windows(2).all(|pair| pair[0] < pair[1]));
        debug_assert!(largest <= MAX_EXPONENT);
        let log_width = (2..5).find(|log| largest >> ((1 << log) - 1) == 0).unwrap_or(5);
        Self::with_width(variables, log_width)
    }

    fn with_width(variables: Variables, log_width: u32) -> Self {
        // A power of two, so that a handful of compiled lengths cover all of them.
        let words = variables.len().div_ceil(64 >> log_width).next_power_of_two();
        Self { variables, log_width, words }
    }

    /// The layout that holds the keys of both, without change of any exponent.
    pub(super) fn union(&self, other: &Self) -> Self {
        if self.variables == other.variables {
            return Self::with_width(self.variables.clone(), self.log_width.max(other.log_width));
        }
        let both = self.variables.iter().chain(&other.variables);
        let mut variables: Variables = both.copied().collect();
        variables.sort_unstable();
        variables.dedup();
        Self::with_width(variables, self.log_width.max(other.log_width))
    }

    /// The same variables with fields for exponents up to `largest`.
    pub(super) fn widened(&self, largest: u64) -> Result<Self, TooLarge> {
        match u32::try_from(largest) {
            Ok(largest) if largest <= MAX_EXPONENT => Ok(Self::new(self.variables.clone(), largest)),
            _ => Err(TooLarge),
        }
    }

    pub(super) fn variables(&self) -> &[u32] {
        &self.variables
    }

    /// Words in a key.
    pub(super) fn words(&self) -> usize {
        self.words
    }

    /// The index of a variable among those of the layout.
    pub(super) fn position(&self, variable: u32) -> Option<usize> {
        self.variables.binary_search(&variable).ok()
    }

    /// Word and shift of the field at an index.
    pub(super) fn place(&self, index: usize) -> (usize, u32) {
        let within = index & ((64 >> self.log_width) - 1);
        #[expect(clippy::cast_possible_truncation, reason = "below the 16 fields of a word")]
        let end = (within as u32 + 1) << self.log_width;
        (index >> (6 - self.log_width), 64 - end)
    }

    /// The bits of a field, at shift zero.
    pub(super) fn mask(&self) -> u64 {
        (1 << (1 << self.log_width)) - 1
    }

    /// The highest bit of every field: clear in every key.
    pub(super) fn guard(&self) -> u64 {
        (u64::MAX / self.mask()) << ((1 << self.log_width) - 1)
    }

    /// The exponent of the variable at an index.
    pub(super) fn get(&self, key: &[u64], index: usize) -> u32 {
        let (word, shift) = self.place(index);
        #[expect(clippy::cast_possible_truncation, reason = "a field has at most 32 bits")]
        let exponent = (key[word] >> shift & self.mask()) as u32;
        exponent
    }

    /// Adds to the exponent of the variable at an index.
    pub(super) fn add(&self, key: &mut [u64], index: usize, exponent: u32) {
        let (word, shift) = self.place(index);
        key[word] += u64::from(exponent) << shift;
    }

    /// All exponents of a key.
    pub(super) fn exponents(&self, key: &[u64]) -> Exponents {
        (0..self.variables.len()).map(|index| self.get(key, index)).collect()
    }

    /// The exponents of a key that are not zero, each with the index of its variable, ascending: of many variables a
    /// term has few.
    pub(super) fn powers<'a>(&'a self, key: &'a [u64]) -> impl Iterator<Item = (usize, u32)> + 'a {
        key.iter().enumerate().flat_map(move |(word, &bits)| {
            let mut rest = bits;
            std::iter::from_fn(move || {
                let within = rest.leading_zeros() >> self.log_width;
                let index = (word << (6 - self.log_width)) + within as usize;
                let (_, shift) = (rest != 0).then(|| self.place(index))?;
                let field = self.mask() << shift;
                #[expect(clippy::cast_possible_truncation, reason = "a field has at most 32 bits")]
                let exponent = ((rest & field) >> shift) as u32;
                rest &= !field;
                Some((index, exponent))
            })
        })
    }

    /// The monomial of a key.
    pub(super) fn monomial(&self, key: &[u64]) -> Monomial {
        Monomial::new(self.powers(key).map(|(index, exponent)| (self.variables[index], exponent)))
    }

    /// The largest exponent of each variable in descending keys.
    pub(super) fn degrees(&self, keys: &[u64]) -> Exponents {
        self.folded(self.largest(keys), |largest, other, kept| largest & kept | other & !kept)
    }

    /// The smallest exponent of each variable.
    pub(super) fn least(&self, keys: &[u64]) -> Exponents {
        self.folded(keys, |least, other, left| other & left | least & !left)
    }

    /// The exponents of all keys joined into one, all fields of a word at a time: the third word has all bits of the
    /// fields in which the first is at least as large as the second.
    fn folded(&self, keys: &[u64], join: impl Fn(u64, u64, u64) -> u64) -> Exponents {
        let guard = self.guard();
        let join = |joined: u64, other: u64| {
            let at_least = ((joined | guard) - other) & guard;
            let fields = at_least | (at_least - (at_least >> ((1 << self.log_width) - 1)));
            join(joined, other, fields)
        };
        let of_word = |word| keys.chunks_exact(self.words).map(move |key| key[word]).reduce(join).unwrap_or(0);
        self.exponents(&(0..self.words).map(of_word).collect::<SmallVec<[u64; 8]>>())
    }

    /// The same keys in the layout `to`, which must have room for every exponent that is not zero.
    pub(super) fn convert(&self, keys: &[u64], to: &Self) -> Vec<u64> {
        if self == to {
            return keys.to_vec();
        }
        // The new field of each variable; a variable without one has only zeros.
        let places: SmallVec<[_; 8]> =
            self.variables.iter().map(|v| to.position(*v).map(|index| to.place(index))).collect();
        let mut converted = vec![0; keys.len() / self.words * to.words];
        for (old, new) in keys.chunks_exact(self.words).zip(converted.chunks_exact_mut(to.words)) {
            for (index, exponent) in self.powers(old) {
                if let Some((word, shift)) = places[index] {
                    new[word] |= u64::from(exponent) << shift;
                }
            }
        }
        converted
    }

    /// The descending keys that hold the largest exponents: in one variable the first.
    fn largest<'k>(&self, keys: &'k [u64]) -> &'k [u64] {
        if self.variables.len() == 1 { &keys[..keys.len().min(self.words)] } else { keys }
    }

    /// The smallest layout for these descending keys, if this is not it.
    pub(super) fn shrunk(&self, keys: &[u64]) -> Option<Self> {
        let keys = self.largest(keys);
        let of_word = |word| keys.chunks_exact(self.words).fold(0, |seen, key| seen | key[word]);
        let seen: SmallVec<[u64; 8]> = (0..self.words).map(of_word).collect();
        // The union of the bits is zero where every exponent is, and as long as the longest.
        let union = self.exponents(&seen);
        let largest = union.iter().copied().max().unwrap_or(0);
        let used = self.variables.iter().zip(&union).filter(|(_, bits)| **bits > 0);
        let smallest = Self::new(used.map(|(v, _)| *v).collect(), largest);
        (smallest != *self).then_some(smallest)
    }
}

/// The quotient of two keys, if the second divides the first.
#[inline]
pub(super) fn key_quotient(guard: u64, key: &[u64], divisor: &[u64], quotient: &mut [u64]) -> bool {
    let mut borrowed = 0;
    for ((word, other), result) in key.iter().zip(divisor).zip(quotient) {
        let difference = (word | guard).wrapping_sub(*other);
        borrowed |= !difference & guard;
        *result = difference & !guard;
    }
    borrowed == 0
}

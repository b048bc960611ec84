//! Products and quotients of sparse polynomials, with the sums in a hash table.

use std::collections::BinaryHeap;

use super::layout::{MAX_WORDS, key_quotient};
use super::sums::{CoefficientSum, Division, Outcome, PackedFactor, PackedTerms, RemainderSum};
use super::work::{TooLarge, steps};
use crate::Integer;

/// The product of two polynomials with keys of the given number of words.
pub(super) fn product<S: CoefficientSum>(
    words: usize,
    left: &PackedFactor<'_, S::Factor>,
    right: &PackedFactor<'_, S::Factor>,
) -> Result<PackedTerms, TooLarge> {
    match words {
        1 => of_length::<1, S>(left, right),
        2 => of_length::<2, S>(left, right),
        4 => of_length::<4, S>(left, right),
        8 => of_length::<8, S>(left, right),
        16 => of_length::<16, S>(left, right),
        MAX_WORDS => of_length::<MAX_WORDS, S>(left, right),
        _ => Err(TooLarge),
    }
}

fn of_length<const N: usize, S: CoefficientSum>(
    left: &PackedFactor<'_, S::Factor>,
    right: &PackedFactor<'_, S::Factor>,
) -> Result<PackedTerms, TooLarge> {
    let mut table = Table::<N, S>::new(left.coefficients.len() + right.coefficients.len());
    for (x, a) in left.keys.as_chunks::<N>().0.iter().zip(left.coefficients) {
        table.reserve(right.coefficients.len())?;
        for (y, b) in right.keys.as_chunks::<N>().0.iter().zip(right.coefficients) {
            table.sum(monomial_product(x, y)).add_product(a, b);
        }
    }
    Ok(table.into_terms())
}

/// The product of two monomials.
#[inline]
fn monomial_product<const N: usize>(a: &[u64; N], b: &[u64; N]) -> [u64; N] {
    let mut key = *a;
    for (word, other) in key.iter_mut().zip(b) {
        *word += other;
    }
    key
}

impl Division<'_> {
    /// The quotient, with the remainder in a table. The dividend's terms are there from the start
    /// and in order; only the terms that come in between have to be queued.
    pub(super) fn in_table<const N: usize, S: RemainderSum>(
        &self,
        dividend: &[Integer],
        divisor: &[S::Factor],
    ) -> Result<Outcome<S::Factor>, TooLarge> {
        let keys = self.divisor.as_chunks::<N>().0;
        let (Some(leading_key), Some(leading)) = (keys.first(), divisor.first()) else {
            return Ok(Outcome::Remainder);
        };
        let negative = divisor[1..].iter().map(S::negative);
        let others: Vec<(&[u64; N], S::Factor)> = keys[1..].iter().zip(negative).collect();
        let mut table = Table::<N, S>::new(dividend.len() * 2);
        for (key, value) in self.dividend.as_chunks::<N>().0.iter().zip(dividend) {
            match S::begin(value) {
                Some(sum) => *table.sum(*key) = sum,
                None => return Ok(Outcome::Overflow),
            }
        }
        let limit = self.limit::<N>();
        let mut given = (0..dividend.len()).peekable();
        let mut queue: BinaryHeap<([u64; N], usize)> = BinaryHeap::new();
        let (mut monomials, mut quotient) = (Vec::new(), Vec::new());
        loop {
            let queued = queue.peek().map(|top| top.0);
            let entry = match given.next_if(|entry| Some(table.entries[*entry].0) > queued) {
                Some(entry) => entry,
                None => match queue.pop() {
                    Some((_, entry)) => entry,
                    None => break,
                },
            };
            let (key, rest) = &table.entries[entry];
            if rest.vanishes() {
                continue;
            }
            let Some(monomial) = self.quotient_key(key, leading_key, &limit) else {
                return Ok(Outcome::Remainder);
            };
            let coefficient = match rest.over(leading) {
                Ok(coefficient) => coefficient,
                Err(outcome) => return Ok(outcome),
            };
            self.work.spend(self.weight.saturating_mul(steps(divisor.len())))?;
            table.reserve(others.len())?;
            for (key, value) in &others {
                let before = table.entries.len();
                let entry = table.entry(monomial_product(&monomial, key));
                table.entries[entry].1.add_product(&coefficient, value);
                if entry == before {
                    queue.push((table.entries[entry].0, entry));
                }
            }
            monomials.push(monomial);
            quotient.push(coefficient);
        }
        Ok(Outcome::Quotient(monomials.into_flattened(), quotient))
    }

    /// The quotient of two monomials, if there is one within the limit: then no product with it
    /// leaves the layout.
    fn quotient_key<const N: usize>(&self, key: &[u64; N], divisor: &[u64; N], limit: &[u64; N]) -> Option<[u64; N]> {
        let guard = self.layout.guard();
        let (mut monomial, mut room) = ([0; N], [0; N]);
        let within =
            key_quotient(guard, key, divisor, &mut monomial) && key_quotient(guard, limit, &monomial, &mut room);
        within.then_some(monomial)
    }

    /// The largest exponents of the quotient as a key.
    fn limit<const N: usize>(&self) -> [u64; N] {
        let mut limit = [0; N];
        for (index, degree) in self.degrees.iter().enumerate() {
            self.layout.add(&mut limit, index, *degree);
        }
        limit
    }
}

/// No table has more entries than fit here; growing and sorting them takes about as much again.
const MOST_BYTES: usize = 1 << 24;

/// Open addressing by linear probing; a slot holds the number of its entry plus one.
struct Table<const N: usize, S> {
    slots: Vec<u32>,
    entries: Vec<([u64; N], S)>,
}

impl<const N: usize, S: CoefficientSum> Table<N, S> {
    fn new(expected: usize) -> Self {
        Self { slots: vec![0; (expected * 2).next_power_of_two().max(16)], entries: Vec::with_capacity(expected) }
    }

    /// Makes room for some more entries, so that `sum` need not look.
    fn reserve(&mut self, more: usize) -> Result<(), TooLarge> {
        if self.entries.len() > MOST_BYTES / size_of::<([u64; N], S)>() {
            return Err(TooLarge);
        }
        let needed = ((self.entries.len() + more) * 2).next_power_of_two();
        if needed > self.slots.len() {
            self.slots = vec![0; needed * 2];
            for (number, (key, _)) in (1..).zip(&self.entries) {
                let mut slot = self.first(key);
                while self.slots[slot] != 0 {
                    slot = (slot + 1) & (self.slots.len() - 1);
                }
                self.slots[slot] = number;
            }
        }
        Ok(())
    }

    #[inline]
    fn first(&self, key: &[u64; N]) -> usize {
        #[expect(clippy::cast_possible_truncation, reason = "less than the number of slots")]
        let slot = first_slot(key, self.slots.len() as u64) as usize;
        slot
    }

    #[inline]
    fn sum(&mut self, key: [u64; N]) -> &mut S {
        let entry = self.entry(key);
        &mut self.entries[entry].1
    }

    /// The index of the entry for a key. A new one is the last.
    #[inline]
    fn entry(&mut self, key: [u64; N]) -> usize {
        let mask = self.slots.len() - 1;
        let mut slot = self.first(&key);
        loop {
            match self.slots[slot] as usize {
                0 => {
                    let entry = self.entries.len();
                    self.entries.push((key, S::default()));
                    #[expect(clippy::cast_possible_truncation, reason = "an entry has at least 16 bytes")]
                    let number = entry as u32 + 1;
                    self.slots[slot] = number;
                    return entry;
                }
                number if self.entries[number - 1].0 == key => return number - 1,
                _ => slot = (slot + 1) & mask,
            }
        }
    }

    fn into_terms(mut self) -> PackedTerms {
        self.entries.sort_unstable_by_key(|entry| std::cmp::Reverse(entry.0));
        let mut keys = Vec::with_capacity(self.entries.len() * N);
        let mut coefficients = Vec::with_capacity(self.entries.len());
        for (key, sum) in self.entries {
            if !sum.vanishes() {
                keys.extend_from_slice(&key);
                coefficients.push(sum.into_integer());
            }
        }
        (keys, coefficients)
    }
}

/// The slot where the search for a key begins, among so many, which are a power of two and at least two. Hosts whose
/// addresses have 32 bits get the same slots as those of 64.
#[inline]
fn first_slot(key: &[u64], slots: u64) -> u64 {
    let mixed = key.iter().fold(0_u64, |hash, word| (hash.rotate_left(5) ^ word).wrapping_mul(0x9e37_79b9_7f4a_7c15));
    // The high bits of a product are the ones that depend on all of its factor's.
    mixed >> (slots.leading_zeros() + 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_are_spread_over_all_slots_and_no_more() {
        for log in 1..=12 {
            let slots = 1_u64 << log;
            let mut found = vec![0_u32; 1 << log];
            for key in 0..8 * slots {
                let slot = first_slot(&[key, key << 32], slots);
                found[usize::try_from(slot).expect("a slot")] += 1;
            }
            // Eight on average: none without a key would be luck, many times the average a bad mixture.
            assert!(found.iter().all(|keys| *keys < 64), "{slots}: {found:?}");
            assert!(found.iter().filter(|keys| **keys == 0).count() * 20 <= found.len(), "{slots}: {found:?}");
        }
        for log in 1..64 {
            assert!(first_slot(&[u64::MAX, 1, 3], 1 << log) < 1 << log);
        }
    }

    #[test]
    fn a_table_finds_what_it_holds() {
        let keys: Vec<[u64; 2]> = (0..3000).map(|n| [n * n, n]).collect();
        let mut table = Table::<2, Integer>::new(0);
        for key in &keys {
            table.reserve(1).expect("room");
            table.entry(*key);
        }
        assert_eq!(table.entries.len(), keys.len());
        for (place, key) in keys.iter().enumerate() {
            assert_eq!(table.entry(*key), place);
        }
    }
}

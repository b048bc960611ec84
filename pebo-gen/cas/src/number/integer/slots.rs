//! Many integers as the digits of one: a long product of such is one product of long integers, which the library does
//! in less than quadratic time (Kronecker's substitution).

use dashu_int::ops::UnsignedAbs;
use dashu_int::{IBig, UBig};

use super::Integer;
use super::Repr::{Big, Small};

/// Bytes of a word: entries are written and read so many bytes at a time.
const WORD: usize = 8;

impl Integer {
    /// The sum of `entry * 256^(slot * place)` over entries by ascending places; the absolute value of each fits so
    /// many bytes.
    pub(crate) fn packed<'a>(entries: impl Iterator<Item = (usize, &'a Self)>, slot: usize, places: usize) -> Self {
        let length = slot * places + WORD;
        let [mut positive, mut negative] = [vec![0_u8; length], Vec::new()];
        for (place, entry) in entries {
            let digits = if entry.is_negative() {
                negative.resize(length, 0);
                &mut negative
            } else {
                &mut positive
            };
            let digits = &mut digits[slot * place..];
            match &entry.0 {
                // Bytes beyond the slot are zero, and the next entry overwrites them.
                Small(value) => digits[..WORD].copy_from_slice(&value.unsigned_abs().to_le_bytes()),
                Big(value) => {
                    let bytes = value.as_ref().unsigned_abs().to_le_bytes();
                    digits[..bytes.len()].copy_from_slice(&bytes);
                }
            }
        }
        let whole = |bytes: &[u8]| IBig::from(UBig::from_le_bytes(bytes));
        if negative.is_empty() {
            return Self::from_big(whole(&positive));
        }
        Self::from_big(whole(&positive) - whole(&negative))
    }

    /// The entries of such a sum by their places, if each is less than half of `256^slot`.
    pub(crate) fn unpacked(&self, slot: usize, places: usize) -> Vec<Self> {
        let negative = self.is_negative();
        let mut bytes = self.big().as_ref().unsigned_abs().to_le_bytes().into_vec();
        bytes.resize(slot * places + WORD, 0);
        if slot <= WORD {
            return of_words(&bytes, slot, places, negative);
        }
        bytes.truncate(slot * places);
        let mut carry = false;
        let entry = |digits: &mut [u8]| {
            if carry {
                // The borrow for the entry before.
                carry = digits.iter_mut().all(|digit| {
                    *digit = digit.wrapping_add(1);
                    *digit == 0
                });
            }
            let below = digits.last().is_some_and(|digit| *digit >= 0x80);
            carry |= below;
            let value = signed(digits, below);
            if negative { -value } else { value }
        };
        bytes.chunks_exact_mut(slot).map(entry).collect()
    }
}

/// The entries of slots that are no longer than a word, with the opposite sign if required.
fn of_words(bytes: &[u8], slot: usize, places: usize, negative: bool) -> Vec<Integer> {
    // The digits in the highest bits: the sign is in place, and bytes beyond the slot are gone.
    let shift = 64 - 8 * slot;
    let mut borrowed = 0;
    let mut entries = Vec::with_capacity(places);
    for place in 0..places {
        let mut word = [0; WORD];
        word.copy_from_slice(&bytes[slot * place..][..WORD]);
        let digits = i64::from_le_bytes(word) << shift;
        let value = digits.wrapping_add(borrowed << shift);
        borrowed = i64::from(digits < 0 || value < 0);
        let value = Integer::from(value >> shift);
        entries.push(if negative { -value } else { value });
    }
    entries
}

/// Digits in two's complement.
fn signed(digits: &[u8], negative: bool) -> Integer {
    let fill = if negative { 0xff } else { 0 };
    match digits.len() {
        ..=16 => {
            let mut bytes = [fill; 16];
            bytes[..digits.len()].copy_from_slice(digits);
            Integer::from(i128::from_le_bytes(bytes))
        }
        _ => Integer::from_big(IBig::from_le_bytes(digits)),
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::number::integer::tests::pair;

    proptest! {
        #[test]
        fn packing_is_inverted(
            entries in prop::collection::vec(pair(), 1..12),
            more in 1_usize..9,
        ) {
            let entries: Vec<Integer> = entries.into_iter().map(|(entry, _)| entry).collect();
            let bits = entries.iter().map(Integer::bits).max().unwrap_or(0);
            let slot = usize::try_from(bits).unwrap() / 8 + more;
            let packed = Integer::packed(entries.iter().enumerate(), slot, entries.len());
            let scale = Integer::from(256).pow(u32::try_from(slot).unwrap());
            let expected = entries.iter().rev().fold(Integer::ZERO, |sum, entry| &(&sum * &scale) + entry);
            prop_assert_eq!(&packed, &expected);
            prop_assert_eq!(packed.unpacked(slot, entries.len()), entries);
        }
    }
}

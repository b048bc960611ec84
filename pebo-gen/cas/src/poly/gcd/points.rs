//! Points for evaluation: pseudo-random, the same in every run.

use super::super::field::{PrimeField, Residue};

/// A sequence of numbers without apparent pattern (Steele, Lea and Flood, 2014).
pub(super) struct Points(u64);

impl Points {
    pub(super) fn new() -> Self {
        Self(0x5eed)
    }

    fn next_word(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ (mixed >> 31)
    }

    /// A residue that is not zero.
    pub(super) fn residue(&mut self, field: &PrimeField) -> Residue {
        loop {
            let residue = field.from_u64(self.next_word());
            if !residue.is_zero() {
                return residue;
            }
        }
    }

    /// Residues that are not zero.
    pub(super) fn residues(&mut self, field: &PrimeField, count: usize) -> Vec<Residue> {
        (0..count).map(|_| self.residue(field)).collect()
    }
}

//! Minors of polynomials, row by row: each is computed once, and nothing is divided.

use std::collections::BTreeMap;

use super::poly::{Poly, TooLarge, Work};

/// The minors of one more row than these, each named by the set of its columns, a bit each.
pub(super) fn larger_minors(
    minors: &BTreeMap<u64, Poly>,
    row: &[&Poly],
    work: &Work,
) -> Result<BTreeMap<u64, Poly>, TooLarge> {
    let mut larger: BTreeMap<u64, Poly> = BTreeMap::new();
    for (columns, minor) in minors {
        for (column, entry) in row.iter().enumerate() {
            let bit = 1 << column;
            if entry.is_zero() || columns & bit != 0 {
                continue;
            }
            let product = entry.mul(minor, work)?;
            let odd = (columns >> column).count_ones() % 2 == 1;
            let sum = larger.entry(columns | bit).or_default();
            *sum = if odd { &*sum - &product } else { &*sum + &product };
        }
    }
    Ok(larger)
}

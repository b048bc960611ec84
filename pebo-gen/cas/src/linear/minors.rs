//! Minors of polynomials, row by row: each is computed once, and nothing is divided.
//!
//! In: the minors of some rows, and one more row. Out: the minors of all of these; too large, if they take more memory
//! than one problem of many may have, for any time they take.

use std::collections::BTreeMap;

use crate::poly::{Poly, TooLarge, Work};

/// The memory limit of all minors of one size.
const MOST_BYTES: usize = 1 << 26;

/// The minors of one more row than these, each named by the set of its columns, a bit each.
pub(crate) fn larger_minors(
    minors: &BTreeMap<u64, Poly>,
    row: &[&Poly],
    work: &Work,
) -> Result<BTreeMap<u64, Poly>, TooLarge> {
    let mut larger: BTreeMap<u64, Poly> = BTreeMap::new();
    let mut bytes = 0;
    for (columns, minor) in minors {
        for (column, entry) in row.iter().enumerate() {
            let bit = 1 << column;
            if entry.is_zero() || columns & bit != 0 {
                continue;
            }
            let product = entry.mul(minor, work)?;
            let odd = (columns >> column).count_ones() % 2 == 1;
            let sum = larger.entry(columns | bit).or_default();
            bytes -= sum.bytes();
            *sum = if odd { &*sum - &product } else { &*sum + &product };
            bytes += sum.bytes();
            if bytes > MOST_BYTES {
                return Err(TooLarge);
            }
        }
    }
    Ok(larger)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Integer;
    use crate::poly::Monomial;

    #[test]
    fn minors_that_take_much_memory_are_given_up_in_time() {
        // A variable of its own for each of so many summands of each entry.
        let entry = |row: u32, column: u32, summands: u32| {
            let of = |k: u32| (Monomial::new([((row * 6 + column) * summands + k, 1)]), Integer::ONE);
            Poly::from_terms((0..summands).map(of)).unwrap()
        };
        let largest = |summands: u32| {
            let mut minors = BTreeMap::from([(0_u64, Poly::one())]);
            for row in 0..6 {
                let entries: Vec<Poly> = (0..6).map(|column| entry(row, column, summands)).collect();
                minors = larger_minors(&minors, &entries.iter().collect::<Vec<_>>(), &Work::new(u64::MAX))?;
            }
            Ok(minors.into_values().map(|minor| minor.term_count()).max())
        };
        assert_eq!(largest(1), Ok(Some(720)), "6!");
        assert_eq!(largest(6), Err(TooLarge));
    }
}

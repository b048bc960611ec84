//! Lower bounds of ranks by enclosures: elimination whose pivots exclude zero.
//!
//! No entry is ever known to be zero here: one that may be is passed over, the largest is the pivot because its quotients
//! widen least, and each step may fail.

use super::elimination::{PlacedRow, Reach, by_columns, eliminate};
use crate::Budget;
use crate::number::interval::{Interval, Precision};
use crate::poly::TooLarge;

/// Pivots of provably independent rows, as many as the elimination finds, in the order of their columns; none if an
/// entry is too large to be represented, or the budget ends.
///
/// A row more or less than these proves nothing: an enclosure that contains zero may enclose another number.
pub fn pivots(rows: Vec<Vec<Interval>>, columns: usize, precision: Precision, budget: &Budget) -> Option<Vec<usize>> {
    let largest = |rest: &[PlacedRow<Interval>], column: usize| {
        let candidates = rest.iter().enumerate().filter(|(_, (_, row))| !row[column].contains_zero());
        let best = candidates.max_by(|(_, (_, a)), (_, (_, b))| size(&a[column]).total_cmp(&size(&b[column])));
        best.map(|(index, _)| index)
    };
    let clear = |row: &mut [Interval], pivot: &[Interval], column: usize| {
        // A product and a difference for each entry.
        let has_budget = budget.take(precision.steps().saturating_mul(2 * (columns - column) as u64));
        let factor = row[column].div(&pivot[column], precision).filter(|_| has_budget).ok_or(TooLarge)?;
        for other in column..columns {
            let product = factor.mul(&pivot[other], precision);
            let difference = product.and_then(|product| row[other].sub(&product, precision));
            row[other] = difference.ok_or(TooLarge)?;
        }
        Ok::<_, TooLarge>(())
    };
    let found = eliminate(rows, Reach::Below, by_columns(columns, largest), |row, _| Ok(row), clear);
    Some(found.ok()?.pivots.iter().map(|pivot| pivot.place).collect())
}

fn size(value: &Interval) -> f64 {
    value.lo().abs().min(value.hi().abs())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Rational;

    const PRECISION: Precision = Precision::new(64);

    fn chosen(rows: &[&[i64]]) -> Vec<usize> {
        let entry = |value: &i64| Interval::from_rational(&Rational::from(*value), PRECISION).unwrap();
        let rows = rows.iter().map(|row| row.iter().map(entry).collect()).collect();
        pivots(rows, 3, PRECISION, &Budget::unlimited()).unwrap()
    }

    #[test]
    fn dependent_rows_are_no_pivots() {
        assert_eq!(chosen(&[&[1, 2, 3], &[2, 4, 6], &[0, 0, 0]]).len(), 1);
        assert_eq!(chosen(&[&[1, 2, 3], &[2, 4, 7], &[3, 6, 10]]).len(), 2);
        assert_eq!(chosen(&[&[1, 2, 3], &[2, 4, 7], &[3, 5, 10]]).len(), 3);
        // The largest entry of the first column, then of the reduced others.
        assert_eq!(chosen(&[&[0, 1, 0], &[5, 0, 0], &[1, 0, 0]]), [1, 0]);
    }
}

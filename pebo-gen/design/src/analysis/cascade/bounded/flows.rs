//! Flows between compartments.
//!
//! In: a constant block of Lambda whose components feed one another. Out: a proof that it is bounded because no
//! component feeds others more than it loses itself: with nonnegative entries off the diagonal, the sum of absolute
//! values never grows if no column has a positive sum. It dies out if one loses more than it feeds: the discs of
//! Gershgorin touch the imaginary axis at zero alone, and zero is no eigenvalue then (Taussky 1949).

use super::fate::Fate;
use pebo_cas::tower::{Field, Fraction, Obstacle};

pub(super) fn fate(field: &Field<'_>, entries: &[Vec<Fraction>], block: &[usize]) -> Result<Fate, Obstacle> {
    let mut fate = Fate::Bounded;
    for &from in block {
        let mut gain = Fraction::zero();
        for &to in block {
            let entry = &entries[to][from];
            // One that is not zero must be positive for all values of the parameters: else the components may be apart.
            if to != from && !entry.is_zero() && !field.signs().is_positive(entry)? {
                return Ok(Fate::Open);
            }
            gain = field.add(&gain, entry)?;
        }
        let loss = gain.opposite();
        if field.signs().is_positive(&loss)? {
            fate = Fate::Fades;
        } else if !field.signs().is_not_negative(&loss)? {
            return Ok(Fate::Open);
        }
    }
    Ok(fate)
}

//! Atoms of arguments, and their units.
//!
//! In: the rational multiples of an atom in which it occurs. Out: a unit, the finest so far, of which each is a whole
//! multiple, and true where it had to become finer.

use std::collections::BTreeMap;

use crate::Rational;
use crate::graph::expr::Expr;
use crate::tower::Obstacle;
use crate::tower::fraction::Fraction;

/// The arguments that a basis serves.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub(in crate::tower) enum Family {
    /// Arguments of sine and cosine.
    Angle,
    /// Arguments of the exponential.
    Exponent,
    /// Radicands.
    Root,
}

/// The greatest multiple of a unit, as in `sin(n*q)`: the polynomials have that degree.
const MOST_MULTIPLES: i64 = 1 << 10;

/// The atoms of arguments, each as an expression and a fraction.
pub(in crate::tower) type Atoms = BTreeMap<Family, Vec<(Expr, Fraction)>>;

/// The units of atoms: all multiples of an atom that occur are whole multiples of its unit.
#[derive(Default, Debug)]
pub(in crate::tower) struct Units(BTreeMap<(Family, Expr), Rational>);

/// A multiple of an atom in its units.
#[derive(PartialEq, Eq, Debug)]
pub(in crate::tower) struct Multiple {
    pub(in crate::tower) unit: Rational,
    pub(in crate::tower) times: i64,
    /// True if the unit had to become finer: kernels made of the one before do not go with it.
    pub(in crate::tower) finer: bool,
}

impl Units {
    /// The number of units in a multiple of an atom; a finer unit is taken if it is no integer.
    pub(in crate::tower) fn multiple(
        &mut self,
        family: Family,
        atom: Expr,
        factor: &Rational,
    ) -> Result<Multiple, Obstacle> {
        let unit = self.0.entry((family, atom)).or_insert_with(|| factor.abs());
        let common = unit.gcd(factor);
        let finer = common != *unit;
        *unit = common;
        let times = factor.checked_div(unit).and_then(|n| n.to_i64()).ok_or(Obstacle::TooLarge)?;
        if times.abs() > MOST_MULTIPLES {
            return Err(Obstacle::TooLarge);
        }
        Ok(Multiple { unit: unit.clone(), times, finer })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Arena;

    #[test]
    fn units_become_as_fine_as_their_multiples_need() {
        let arena = Arena::new();
        let [x, y] = ["x", "y"].map(|name| arena.variable(name));
        let mut units = Units::default();
        let mut of = |atom, n, d| {
            let Multiple { unit, times, finer } =
                units.multiple(Family::Angle, atom, &Rational::new(n, d).unwrap()).unwrap();
            (unit.to_string(), times, finer)
        };
        assert_eq!(of(x, 1, 2), ("1/2".to_owned(), 1, false));
        assert_eq!(of(x, -3, 2), ("1/2".to_owned(), -3, false));
        assert_eq!(of(x, 1, 3), ("1/6".to_owned(), 2, true), "what had units of a half is made anew");
        assert_eq!(of(x, 1, 2), ("1/6".to_owned(), 3, false));
        assert_eq!(of(y, 5, 1), ("5".to_owned(), 1, false), "each atom has its own");
        let huge = units.multiple(Family::Angle, x, &Rational::from(MOST_MULTIPLES));
        assert_eq!(huge, Err(Obstacle::TooLarge));
    }
}

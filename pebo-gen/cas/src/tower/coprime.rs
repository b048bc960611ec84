//! A coprime base: polynomials over which others are products of powers.
//!
//! In: square-free polynomials. Out: elements of the base whose product each is; where a new polynomial shares a factor
//! with an element, that one is split. Holds after: any two elements that occur are coprime.

use crate::graph::expr::Expr;
use crate::poly::{Poly, TooLarge, Work};

/// A coprime base: square-free polynomials without common factors.
#[derive(Default, Debug)]
pub(in crate::tower) struct CoprimeBase {
    /// The polynomials of this round.
    entered: Vec<Poly>,
    /// Elements of earlier rounds that are yet to be entered in this one, as expressions: kernels may get other
    /// numbers.
    pending: Vec<Expr>,
}

/// A polynomial over a coprime base.
pub(in crate::tower) struct Splitting {
    /// Elements of the base, whose product it is.
    pub parts: Vec<Poly>,
    /// True if an element had to be split: kernels made of it before do not go with its parts.
    pub finer: bool,
}

impl CoprimeBase {
    /// Writes a square-free polynomial over the base, which grows by its new factors.
    pub(in crate::tower) fn split(&mut self, poly: Poly, work: &Work) -> Result<Splitting, TooLarge> {
        let (mut rest, mut parts, mut finer) = (poly, Vec::new(), false);
        let mut index = 0;
        while let Some(element) = self.entered.get(index).filter(|_| !rest.is_constant()).cloned() {
            let common = rest.gcd(&element, work)?;
            if !common.is_constant() {
                rest = rest.div_exact(&common, work)?.unwrap_or(rest);
                if common != element
                    && let Some(other) = element.div_exact(&common, work)?
                {
                    self.entered[index] = common.clone();
                    self.entered.push(other.primitive().1);
                    finer = true;
                }
                parts.push(common);
            }
            index += 1;
        }
        if !rest.is_constant() {
            self.entered.push(rest.clone());
            parts.push(rest);
        }
        Ok(Splitting { parts, finer })
    }

    /// An element of an earlier round that is yet to be entered.
    pub(in crate::tower) fn next_pending(&mut self) -> Option<Expr> {
        self.pending.pop()
    }

    /// Enters an element of an earlier round.
    pub(in crate::tower) fn enter(&mut self, poly: Poly) {
        if !poly.is_constant() && !self.entered.contains(&poly) {
            self.entered.push(poly);
        }
    }

    /// Keeps the elements of this round for the next one.
    pub(in crate::tower) fn keep(&mut self, shown: impl Fn(&Poly) -> Expr) {
        self.pending.extend(std::mem::take(&mut self.entered).iter().map(shown));
        self.pending.sort_unstable();
        self.pending.dedup();
        self.pending.reverse();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A product of `x + n`, one for each number.
    fn product(numbers: &[i64]) -> Poly {
        let work = Work::new(1_000_000);
        numbers.iter().fold(Poly::one(), |product, number| {
            product.mul(&(&Poly::variable(0) + &Poly::constant(*number)), &work).unwrap()
        })
    }

    #[test]
    fn elements_of_a_base_have_no_factor_in_common() {
        let work = Work::new(1_000_000);
        let mut base = CoprimeBase::default();
        let mut split = |numbers: &[i64]| {
            let split = base.split(product(numbers), &work).unwrap();
            let whole = split.parts.iter().fold(Poly::one(), |product, part| product.mul(part, &work).unwrap());
            assert_eq!(whole, product(numbers));
            for (index, one) in base.entered.iter().enumerate() {
                assert!(base.entered[..index].iter().all(|other| one.gcd(other, &work).unwrap().is_constant()));
            }
            (split.parts.len(), split.finer)
        };
        assert_eq!(split(&[1, 2]), (1, false), "new as a whole");
        assert_eq!(split(&[1, 2]), (1, false), "known as a whole");
        assert_eq!(split(&[2, 3]), (2, true), "shares a factor with what is known");
        assert_eq!(split(&[1, 3]), (2, false), "of elements that are there");
        assert_eq!(split(&[1, 2, 3, 4, 5]), (4, false), "with something new");
        assert_eq!(split(&[5]), (1, true));
    }

    #[test]
    fn the_next_round_begins_with_what_this_one_found() {
        let arena = crate::Arena::new();
        let work = Work::new(1_000_000);
        let mut base = CoprimeBase::default();
        base.split(product(&[1]), &work).unwrap();
        base.split(product(&[2]), &work).unwrap();
        let names = [arena.variable("a"), arena.variable("b")];
        base.keep(|poly| names[usize::from(*poly == product(&[2]))]);
        assert!(base.entered.is_empty());
        assert_eq!(base.pending.len(), 2);
        base.enter(product(&[1]));
        base.enter(product(&[1]));
        base.enter(Poly::one());
        assert_eq!(base.entered, [product(&[1])], "once each, and no numbers");
    }
}

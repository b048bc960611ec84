//! Arguments as rational combinations of atoms that are linearly independent over the rationals.
//!
//! In: the argument of a sine, cosine or exponential. Out: atoms with rational factors, whose sum it is. An argument is
//! first divided by its denominator and split into its monomials, so that `sin(x + u)` separates x from u; if a piece
//! is a combination of earlier pieces, as `y^2/(1 + y^2)` is of 1 and `1/(1 + y^2)`, it is written so. Holds after: no
//! atom of a family is a rational combination of the others.

use std::collections::BTreeMap;

use crate::graph::expr::Expr;
use crate::linear::{Matrix, rational_matrix};
use crate::poly::{Monomial, Poly};
use crate::{Integer, Rational};

use super::units::Multiple;
use crate::tower::fraction::{Fraction, primitive};
use crate::tower::{Family, Field, Obstacle};

/// The sine of a sum of n angles has 2^(n-1) terms: a longer sum is one atom.
const MOST_SUMMANDS: usize = 8;

/// The greatest number of atoms in the search for a linear dependence.
const MOST_ATOMS: usize = 40;

impl Field<'_> {
    /// The number of an atom's units in a multiple.
    pub(in crate::tower) fn multiple(
        &self,
        family: Family,
        atom: Expr,
        factor: &Rational,
    ) -> Result<(Rational, i64), Obstacle> {
        let Multiple { unit, times, finer } = self.units.borrow_mut().multiple(family, atom, factor)?;
        if finer {
            self.round.finer.set(true);
        }
        Ok((unit, times))
    }

    /// Splits an argument into rational multiples of atoms.
    pub(in crate::tower) fn split(
        &self,
        family: Family,
        argument: &Fraction,
    ) -> Result<Vec<(Expr, Rational)>, Obstacle> {
        let mut pieces = self.pieces(argument)?;
        if pieces.len() > MOST_SUMMANDS {
            pieces = vec![argument.clone()];
        }
        let mut total: BTreeMap<Expr, Rational> = BTreeMap::new();
        for piece in &pieces {
            for (atom, factor) in self.over_atoms(family, piece)? {
                let entry = total.entry(atom).or_insert(Rational::ZERO);
                *entry = &*entry + &factor;
            }
        }
        Ok(total.into_iter().filter(|(_, factor)| !factor.is_zero()).collect())
    }

    /// Enters an argument as an atom, before others are split into atoms; it is independent of earlier ones.
    pub(in crate::tower) fn take_for_atom(&self, family: Family, argument: Expr) -> Result<(), Obstacle> {
        let (key, bare, _) = self.undivided(&self.fraction(argument)?)?;
        self.round.atoms.borrow_mut().entry(family).or_default().push((key, bare));
        Ok(())
    }

    /// The terms of the quotient and of the remainder of numerator by denominator.
    fn pieces(&self, argument: &Fraction) -> Result<Vec<Fraction>, Obstacle> {
        let mut pieces = Vec::new();
        let mut rest = argument.num.clone();
        let mut scale = Integer::ONE;
        if argument.den.term_count() > 1
            && let Some((leading, coefficient)) = argument.den.leading_term()
        {
            // scale * num = sum of quotient * den + rest, over the integers
            let mut remainder = Vec::new();
            while let Some((monomial, own)) = rest.leading_term() {
                let own = own.clone();
                let Some(quotient) = over(&monomial, &leading) else {
                    let term = Poly::from_terms([(monomial, own)])?;
                    rest = &rest - &term;
                    remainder.push(term);
                    continue;
                };
                let value = Rational::new(own.clone(), &scale * coefficient).ok_or(Obstacle::DivisionByZero)?;
                let bare = Fraction::polynomial(Poly::from_terms([(quotient.clone(), Integer::ONE)])?);
                pieces.push(self.scale(&bare, &value)?);
                let quotient = Poly::from_terms([(quotient, own)])?;
                rest = &rest.scale(coefficient) - &quotient.mul(&argument.den, self.limit())?;
                for part in &mut remainder {
                    *part = Poly::scale(part, coefficient);
                }
                scale = &scale * coefficient;
            }
            let den = argument.den.scale(&scale);
            for term in remainder {
                pieces.push(self.quotient(&term, &den)?);
            }
        } else {
            for (monomial, coefficient) in argument.num.terms() {
                let term = Poly::from_terms([(monomial, coefficient.clone())])?;
                pieces.push(self.quotient(&term, &argument.den)?);
            }
        }
        Ok(pieces)
    }

    /// A piece as a combination of atoms; a new atom if there is none.
    fn over_atoms(&self, family: Family, piece: &Fraction) -> Result<Vec<(Expr, Rational)>, Obstacle> {
        let (key, bare, factor) = self.undivided(piece)?;
        let atoms = self.round.atoms.borrow().get(&family).cloned().unwrap_or_default();
        if atoms.iter().any(|(atom, _)| *atom == key) {
            return Ok(vec![(key, factor)]);
        }
        // Different monomials are independent of each other; only sums can depend.
        let simple = |f: &Fraction| f.num.term_count() == 1 && f.den.term_count() == 1;
        if atoms.len() <= MOST_ATOMS
            && !(simple(&bare) && atoms.iter().all(|(_, atom)| simple(atom)))
            && let Some(combination) = self.dependence(&bare, &atoms)?
        {
            return Ok(combination.into_iter().map(|(atom, share)| (atom, &share * &factor)).collect());
        }
        self.round.atoms.borrow_mut().entry(family).or_default().push((key, bare));
        Ok(vec![(key, factor)])
    }

    /// A fraction as a rational multiple of one that is primitive with a positive leading coefficient.
    fn undivided(&self, argument: &Fraction) -> Result<(Expr, Fraction, Rational), Obstacle> {
        let (numerator, num) = primitive(&argument.num);
        let (denominator, den) = primitive(&argument.den);
        let mut factor = Rational::new(numerator, denominator).ok_or(Obstacle::DivisionByZero)?;
        let mut key = Fraction { num, den };
        if key.num.leading_coefficient().is_negative() {
            factor = -&factor;
            key = key.opposite();
        }
        Ok((self.show(&key), key, factor))
    }

    /// The fraction as a rational combination of atoms, if it is one.
    fn dependence(
        &self,
        wanted: &Fraction,
        atoms: &[(Expr, Fraction)],
    ) -> Result<Option<Vec<(Expr, Rational)>>, Obstacle> {
        let (columns, _) = self.over_common_denominator(atoms.iter().map(|(_, atom)| atom).chain([wanted]))?;
        let mut rows: BTreeMap<Monomial, Vec<Rational>> = BTreeMap::new();
        for (column, poly) in columns.iter().enumerate() {
            for (monomial, coefficient) in poly.terms() {
                let row = rows.entry(monomial).or_insert_with(|| vec![Rational::ZERO; columns.len()]);
                row[column] = Rational::from(coefficient.clone());
            }
        }
        let matrix = Matrix::new(rows.into_values().collect());
        let Some(solution) = rational_matrix::solution(&matrix, atoms.len(), self.limit())? else { return Ok(None) };
        let used = atoms.iter().zip(solution).filter(|(_, share)| !share.is_zero());
        Ok(Some(used.map(|((atom, _), share)| (*atom, share)).collect()))
    }
}

/// The monomial divided by another, if that divides it.
fn over(monomial: &Monomial, divisor: &Monomial) -> Option<Monomial> {
    let fits = divisor.powers().iter().all(|&(v, e)| monomial.exponent(v) >= e);
    fits.then(|| Monomial::new(monomial.powers().iter().map(|&(v, e)| (v, e - divisor.exponent(v)))))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Arena;

    #[test]
    fn an_argument_is_the_sum_of_its_pieces() {
        use crate::Facts;

        let arena = Arena::new();
        let y = arena.variable("y");
        let denominator = arena.add(arena.scale(y, &Rational::from(3)), arena.one());
        let cases = [
            (arena.add(arena.mul(y, y), y), vec!["y^2", "y"]),
            (arena.div(arena.mul(y, y), denominator), vec!["y/3", "-1/9", "1/(9*(3*y + 1))"]),
            (arena.div(arena.one(), denominator), vec!["1/(3*y + 1)"]),
        ];
        for (argument, expected) in cases {
            let field = Field::over(&arena, &Facts::new(), &[argument]).unwrap();
            let pieces = field.pieces(&field.fraction(argument).unwrap()).unwrap();
            let shown: Vec<String> = pieces.iter().map(|piece| arena.print(field.show(piece))).collect();
            assert_eq!(shown, expected);
        }
    }
}

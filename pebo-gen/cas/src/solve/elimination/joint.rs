//! The linear part of a system of equations, as one linear system.
//!
//! In: formulas that are to vanish, and the symbols to determine. Out: values of those symbols by the equations that
//! are linear in all of them combined, for any form of the other equations; none if these are inconsistent. A value
//! divides by a determinant, and as elsewhere in elimination a solution may be lost at its zeros.

use std::collections::{BTreeMap, BTreeSet};

use crate::linear::{Echelon, Matrix};
use crate::poly::{Monomial, Poly};
use crate::tower::{Field, Fraction, Obstacle};
use crate::{Arena, Expr, Integer, Rational, Symbol};

use super::values::Values;

/// The greatest number of monomials on the right sides for every unknown, for elimination with a column for each.
const MOST_COLUMNS_EACH: usize = 4;

/// An equation: coefficients of unknowns, and the value of their sum.
struct LinearEquation {
    coefficients: BTreeMap<u32, Poly>,
    right: Poly,
}

/// Linear equations in unknowns.
struct System<'a> {
    field: &'a Field<'a>,
    /// The kernels that are unknowns, with their symbols.
    unknowns: Vec<(u32, Symbol)>,
    rows: Vec<LinearEquation>,
}

/// The values that linear equations combined determine of the symbols, whose kernels are given; coefficients are free
/// of the barred kernels, and divisors with reluctant kernels are taken last.
pub(super) fn solved(
    arena: &Arena,
    field: &Field<'_>,
    equations: impl Iterator<Item = Poly>,
    kernels: &BTreeSet<u32>,
    [barred, reluctant]: [&BTreeSet<u32>; 2],
) -> Result<Values, Obstacle> {
    let unknowns =
        kernels.iter().filter_map(|&kernel| Some((kernel, arena.as_symbol(field.kernel(kernel))?))).collect();
    let mut system = System { field, unknowns, rows: Vec::new() };
    for equation in equations {
        system.rows.extend(system.row(&equation, kernels, barred));
    }
    let occurring: BTreeSet<u32> = system.rows.iter().flat_map(|row| row.coefficients.keys().copied()).collect();
    system.unknowns.retain(|(kernel, _)| occurring.contains(kernel));
    // A single one is found without this system too.
    if system.unknowns.len() < 2 || system.rows.len() < 2 {
        return Ok(Values::new());
    }
    system.solve(arena, reluctant)
}

impl System<'_> {
    /// The row of an equation, if it is linear in the unknowns and holds any.
    fn row(&self, equation: &Poly, kernels: &BTreeSet<u32>, barred: &BTreeSet<u32>) -> Option<LinearEquation> {
        let kernels: Vec<u32> = kernels.iter().copied().collect();
        let mut row = LinearEquation { coefficients: BTreeMap::new(), right: Poly::zero() };
        for (monomial, coefficient) in equation.collect(&kernels) {
            match monomial.powers() {
                [] => row.right = -&coefficient,
                [(kernel, 1)] if self.unknowns.iter().any(|(unknown, _)| unknown == kernel) => {
                    if coefficient.variables().iter().any(|variable| barred.contains(variable)) {
                        return None;
                    }
                    row.coefficients.insert(*kernel, coefficient);
                }
                _ => return None,
            }
        }
        (!row.coefficients.is_empty()).then_some(row)
    }

    /// Over numbers, by elimination; over other coefficients, by one equation after another, if each has one unknown
    /// that those before do not. That gives products of terms of the equations: the normal form of elimination would
    /// expand their factors.
    fn solve(&self, arena: &Arena, reluctant: &BTreeSet<u32>) -> Result<Values, Obstacle> {
        match self.rights() {
            Some(monomials) => self.eliminated(arena, &monomials),
            None => self.one_by_one(arena, reluctant),
        }
    }

    /// Divides by reluctant kernels last.
    fn one_by_one(&self, arena: &Arena, reluctant: &BTreeSet<u32>) -> Result<Values, Obstacle> {
        let field = self.field;
        let mut known: BTreeMap<u32, Expr> = BTreeMap::new();
        let mut open: Vec<&LinearEquation> = self.rows.iter().collect();
        loop {
            let candidates = open.iter().enumerate().filter_map(|(index, row)| {
                let mut unknowns = row.coefficients.iter().filter(|(kernel, _)| !known.contains_key(kernel));
                let (Some((kernel, slope)), None) = (unknowns.next(), unknowns.next()) else { return None };
                let driven = slope.variables().iter().any(|variable| reluctant.contains(variable));
                let terms = row.coefficients.values().chain([&row.right]).map(Poly::term_count).sum::<usize>();
                Some(((driven, terms), index, *kernel))
            });
            let Some((_, index, unknown)) = candidates.min() else { break };
            let row = open.remove(index);
            let mut terms = vec![field.show(&field.of_polynomial(&row.right)?)];
            for (kernel, factor) in row.coefficients.iter().filter(|(kernel, _)| **kernel != unknown) {
                let factor = field.show(&field.of_polynomial(factor)?);
                terms.push(arena.neg(arena.mul(factor, known[kernel])));
            }
            let slope = field.show(&field.of_polynomial(&row.coefficients[&unknown])?);
            known.insert(unknown, arena.div(arena.sum(terms), slope));
        }
        let symbol = |(kernel, symbol): &(u32, Symbol)| Some((*symbol, *known.get(kernel)?));
        Ok(self.unknowns.iter().filter_map(symbol).collect())
    }

    /// By elimination, with a column for each of the monomials on the right.
    fn eliminated(&self, arena: &Arena, monomials: &BTreeSet<Monomial>) -> Result<Values, Obstacle> {
        let width = self.unknowns.len();
        let number = |n: Option<&Integer>| Fraction::constant(&Rational::from(n.cloned().unwrap_or_default()));
        let row = |row: &LinearEquation| {
            let left = self.unknowns.iter().map(|(kernel, _)| number(row.coefficients.get(kernel).and_then(constant)));
            left.chain(monomials.iter().map(|monomial| number(row.right.coefficient(monomial)))).collect()
        };
        let matrix = self.rows.iter().map(row).collect();
        let (echelon, rest) = Echelon::of(self.field, Matrix::new(matrix), width)?;
        if rest.rows().iter().flatten().any(|entry| !entry.is_zero()) {
            return Ok(Values::new());
        }
        let basis = monomials.iter().map(|monomial| self.shown(monomial)).collect::<Result<Vec<_>, _>>()?;
        let mut values = Values::new();
        for (pivot, row) in echelon.determined() {
            let terms = row[width..].iter().zip(&basis).filter(|(factor, _)| !factor.is_zero());
            let value = arena.sum(terms.map(|(factor, part)| arena.mul(self.field.show(factor), *part)));
            values.insert(self.unknowns[pivot].1, value);
        }
        Ok(values)
    }

    /// The monomials of all right sides, if every coefficient is a number and they are not too many: with a column for
    /// each, elimination remains among numbers.
    fn rights(&self) -> Option<BTreeSet<Monomial>> {
        let numbers = |row: &LinearEquation| row.coefficients.values().all(Poly::is_constant);
        if !self.rows.iter().all(numbers) {
            return None;
        }
        let monomials: BTreeSet<Monomial> =
            self.rows.iter().flat_map(|row| row.right.terms().map(|(m, _)| m)).collect();
        (monomials.len() <= MOST_COLUMNS_EACH * self.unknowns.len()).then_some(monomials)
    }

    fn shown(&self, monomial: &Monomial) -> Result<Expr, Obstacle> {
        let poly = Poly::from_terms([(monomial.clone(), Integer::ONE)])?;
        Ok(self.field.show(&self.field.of_polynomial(&poly)?))
    }
}

/// The coefficient of the monomial 1.
fn constant(poly: &Poly) -> Option<&Integer> {
    poly.coefficient(&Monomial::one())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Facts;

    /// The values that equations determine of x, y and z.
    fn of(build: impl Fn(&Arena, [Expr; 3], [Expr; 2]) -> Vec<Expr>) -> String {
        let arena = Arena::new();
        let unknowns = ["x", "y", "z"].map(|name| arena.variable(name));
        let parameters = ["a", "b"].map(|name| arena.variable(name));
        let equations = build(&arena, unknowns, parameters);
        let field = Field::over(&arena, &Facts::new(), &equations).unwrap();
        let symbols = unknowns.iter().filter_map(|unknown| arena.as_symbol(*unknown)).collect();
        let numerators = equations.iter().map(|equation| field.fraction(*equation).unwrap().numerator().clone());
        let none = BTreeSet::new();
        let values = solved(&arena, &field, numerators, &field.kernels_of(&symbols), [&none, &none]).unwrap();
        let shown = values.iter().map(|(symbol, value)| format!("{} = {}", arena.name(*symbol), arena.print(*value)));
        shown.collect::<Vec<_>>().join(", ")
    }

    #[test]
    fn equations_of_one_unknown_each_keep_their_factors() {
        let chain = of(|arena, [x, y, z], [a, b]| {
            let one = arena.one();
            let mixed = arena.sub(arena.mul(arena.sub(one, b), y), x);
            vec![mixed, arena.sub(arena.mul(arena.sub(one, a), x), one), arena.sub(z, y)]
        });
        assert_eq!(chain, "x = 1/(1 - a), y = 1/((1 - b)*(1 - a)), z = 1/((1 - b)*(1 - a))");
    }

    #[test]
    fn numbers_remain_numbers_beside_any_right_side() {
        let plane = of(|arena, [x, y, z], [a, b]| {
            vec![arena.sum([x, y, arena.neg(a)]), arena.sum([x, arena.neg(y), arena.neg(b)]), arena.sub(z, x)]
        });
        assert_eq!(plane, "x = a/2 + b/2, y = a/2 - b/2, z = a/2 + b/2");
    }

    #[test]
    fn free_unknowns_and_contradictions_remain() {
        // x and y are not identifiable, z is; and an equation of the second degree says nothing here.
        let open = of(|arena, [x, y, z], [a, _]| {
            vec![arena.sum([x, y, z]), arena.sum([x, y, arena.neg(z), a]), arena.sub(arena.mul(x, x), y)]
        });
        assert_eq!(open, "z = a/2");
        let wrong = of(|arena, [x, y, _], [a, b]| vec![arena.sum([x, y, a]), arena.sum([x, y, b])]);
        assert_eq!(wrong, "");
    }
}

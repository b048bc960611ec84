//! Products of unknowns: as polar coordinates, and by their exponents.
//!
//! In: products of unknown kernels with their values. Out: the kernels alone: from `m*sin(a)` and `m*cos(a)` the angle
//! and the amplitude, from `p*s` and `p*s^2` the quotient of the two.

use std::convert::Infallible;

use super::equation::{Equation, Inverse, angle_of, unpower};
use crate::graph::expr::Expr;
use crate::graph::function::Function;
use crate::linear::elimination::{Pivot, Reach, by_columns, eliminate, first};
use crate::tower::Field;
use crate::{Arena, Domain, Node, Rational};

/// The kernels that products determine.
pub(super) fn apart(arena: &Arena, domain: &Domain, known: &[Equation]) -> Vec<Inverse> {
    let products: Vec<KernelProduct> =
        known.iter().filter_map(|equation| KernelProduct::of(arena, *equation)).collect();
    let mut found = polar(arena, domain, &products);
    found.extend(by_exponents(arena, domain, &products));
    found
}

/// A product of kernels with its value.
struct KernelProduct {
    factors: Vec<(Expr, Rational)>,
    value: Expr,
}

impl KernelProduct {
    fn of(arena: &Arena, Equation { formula, value }: Equation) -> Option<Self> {
        match arena.node(formula) {
            Node::Product(product) => Some(Self { factors: product.factors.clone(), value }),
            Node::Symbol(_) | Node::Call(..) => Some(Self { factors: vec![(formula, Rational::ONE)], value }),
            _ => None,
        }
    }
}

/// Amplitude and angle, if both `m*sin(a)` and `m*cos(a)` and the sign of m are known.
fn polar(arena: &Arena, domain: &Domain, products: &[KernelProduct]) -> Vec<Inverse> {
    let mut found = Vec::new();
    for KernelProduct { factors, value: across } in products {
        for (at, (factor, exponent)) in factors.iter().enumerate() {
            let Node::Call(Function::Sin, argument) = arena.node(*factor) else { continue };
            let mut others = factors.clone();
            drop(others.remove(at));
            if !exponent.is_one() || others.is_empty() {
                continue;
            }
            let amplitude = arena.multiply(&Rational::ONE, others);
            let wanted = arena.mul(amplitude, arena.call(Function::Cos, &argument));
            let along = products.iter().find(|p| arena.multiply(&Rational::ONE, p.factors.iter().cloned()) == wanted);
            let (Some(along), Some(positive)) = (along, sign(arena, domain, amplitude)) else { continue };
            let turned = |value| if positive { value } else { arena.neg(value) };
            let [across, along] = [*across, along.value].map(turned);
            let angle = angle_of(arena, domain, across, along);
            found.push(Inverse::unique(Equation { formula: argument[0], value: angle }));
            let length = arena.sqrt(arena.add(arena.mul(across, across), arena.mul(along, along)));
            found.extend(single(arena, domain, amplitude, turned(length)));
        }
    }
    found
}

/// The sign of a non-zero expression throughout the domain: positive (true) or negative (false).
fn sign(arena: &Arena, domain: &Domain, expr: Expr) -> Option<bool> {
    let field = Field::over(arena, &domain.facts, &[expr]).ok()?;
    let fraction = field.fraction(expr).ok()?;
    let opposite = fraction.opposite();
    let mut signs = [(&fraction, true), (&opposite, false)].into_iter();
    signs.find_map(|(part, positive)| field.signs().is_positive(part).ok()?.then_some(positive))
}

/// A power of a kernel turned into the kernel; a product of several is unchanged.
fn single(arena: &Arena, domain: &Domain, formula: Expr, value: Expr) -> Option<Inverse> {
    match arena.node(formula) {
        Node::Product(product) => match product.factors.as_slice() {
            [(base, exponent)] => unpower(arena, domain, *base, exponent, value),
            _ => Some(Inverse::unique(Equation { formula, value })),
        },
        _ => Some(Inverse::unique(Equation { formula, value })),
    }
}

/// Kernels as products of powers of the values, if the exponents determine them.
fn by_exponents(arena: &Arena, domain: &Domain, products: &[KernelProduct]) -> Vec<Inverse> {
    let mut kernels: Vec<Expr> = products.iter().flat_map(|p| p.factors.iter().map(|(base, _)| *base)).collect();
    kernels.sort_unstable();
    kernels.dedup();
    // Rows of exponents, each before powers of the values.
    let mut rows: Vec<Vec<Rational>> = Vec::new();
    for (index, product) in products.iter().enumerate() {
        let of = |kernel: &Expr| {
            let factor = product.factors.iter().find(|(base, _)| base == kernel);
            factor.map_or(Rational::ZERO, |(_, exponent)| exponent.clone())
        };
        let powers = (0..products.len()).map(|other| Rational::from(i64::from(other == index)));
        rows.push(kernels.iter().map(of).chain(powers).collect());
    }
    if products.iter().filter(|product| product.factors.len() > 1).count() < 2 {
        // Each of the others is inverted alone.
        return Vec::new();
    }
    let choose = by_columns(kernels.len(), first(Rational::is_zero));
    let clear = |other: &mut [Rational], row: &[Rational], column: usize| {
        let factor = &other[column] / &row[column];
        for (own, above) in other.iter_mut().zip(row) {
            *own = &*own - &(&factor * above);
        }
        Ok::<_, Infallible>(())
    };
    let Ok(found) = eliminate(rows, Reach::All, choose, |row, _| Ok(row), clear);
    let alone = |Pivot { column, row, .. }: &Pivot<Rational>| {
        let (exponents, powers) = row.split_at(kernels.len());
        if exponents.iter().filter(|exponent| !exponent.is_zero()).count() > 1 {
            return None;
        }
        // Integer exponents on both sides: only then is a root a matter of signs.
        let whole = powers.iter().chain([&exponents[*column]]).try_fold(Rational::ONE, |whole, power| {
            let denominator = Rational::new((power * &whole).denominator(), 1)?;
            Some(&whole * &denominator)
        })?;
        let value = products.iter().zip(powers).map(|(product, power)| (product.value, power * &whole));
        let value = arena.multiply(&Rational::ONE, value.filter(|(_, power)| !power.is_zero()));
        unpower(arena, domain, kernels[*column], &(&exponents[*column] * &whole), value)
    };
    found.pivots.iter().filter_map(alone).collect()
}

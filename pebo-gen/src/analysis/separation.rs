//! Separating unknown constants from known signals: the over-parameterised regression.
//!
//! In: expressions in z. Out: with z = chi + theta, each as a sum of products of a known function of
//! chi, y and u with a function of theta alone, where polynomials, exponentials, sines and cosines
//! allow it; and theta recovered from those functions (Ortega et al. 2015, remark R4 and eq. 28).

use std::collections::{BTreeMap, BTreeSet};

use crate::cas::domain::Domain;
use crate::cas::field::{Field, Fraction, Obstacle};
use crate::cas::poly::Monomial;
use crate::cas::rational::Rational;
use crate::cas::zero::decide;
use crate::cas::{Expr, Symbol};
use crate::plant::Plant;

use super::solve::{Equation, solve};
use super::tidy::shortest;

/// Expressions as `known + factors * eta`.
#[derive(Clone, Debug)]
pub(super) struct Separated {
    /// What is known of each expression.
    pub known: Vec<Expr>,
    /// The factors of each eta, a row for each expression.
    pub factors: Vec<Vec<Expr>>,
    /// The functions of theta.
    pub eta: Vec<Expr>,
}

/// Separates expressions in z at z = chi + theta; none where a kernel mixes theta with signals.
pub(super) fn separate(plant: &Plant, domain: &Domain, in_z: &[Expr]) -> Result<Option<Separated>, Obstacle> {
    let arena = &plant.arena;
    let shifted: BTreeMap<Symbol, Expr> = plant
        .z
        .iter()
        .zip(plant.chi.iter().zip(&plant.theta))
        .map(|(z, (chi, theta))| (*z, arena.add(arena.of_symbol(*chi), arena.of_symbol(*theta))))
        .collect();
    let exprs = arena.substitute_all(in_z, &shifted);
    let unknown: BTreeSet<Symbol> = plant.theta.iter().copied().collect();
    if exprs.iter().any(|e| arena.depends_on(*e, &plant.hidden())) {
        return Ok(None);
    }
    let field = Field::over(arena, &domain.facts, &exprs)?;
    let kernels: Vec<u32> = field.kernels_of(&unknown).into_iter().collect();
    let constants: BTreeSet<Symbol> = plant.parameters.iter().map(|p| p.symbol).chain(unknown).collect();
    if kernels.iter().any(|k| !arena.symbols_of(&[field.kernel(*k)]).is_subset(&constants)) {
        return Ok(None);
    }
    let mut columns: Vec<Monomial> = Vec::new();
    let mut rows: Vec<BTreeMap<Monomial, Fraction>> = Vec::new();
    for expr in &exprs {
        let fraction = field.fraction(*expr)?;
        if fraction.denominator().variables().iter().any(|v| kernels.contains(v)) {
            return Ok(None);
        }
        let mut row = BTreeMap::new();
        for (monomial, coefficient) in fraction.numerator().collect(&kernels) {
            if !monomial.is_one() && !columns.contains(&monomial) {
                columns.push(monomial.clone());
            }
            row.insert(monomial, field.quotient(&coefficient, fraction.denominator())?);
        }
        rows.push(row);
    }
    // theta itself first, then by degree.
    columns.sort_by_key(|monomial| (monomial.degree(), monomial.powers().to_vec()));
    let show = |row: &BTreeMap<Monomial, Fraction>, monomial: &Monomial| {
        row.get(monomial).map_or_else(|| arena.zero(), |fraction| field.show(fraction))
    };
    let separated = Separated {
        known: rows.iter().map(|row| show(row, &Monomial::one())).collect(),
        factors: rows.iter().map(|row| columns.iter().map(|m| show(row, m)).collect()).collect(),
        eta: columns
            .iter()
            .map(|m| {
                let powers = m.powers().iter().map(|&(k, e)| (field.kernel(k), Rational::from(i64::from(e))));
                arena.multiply(&Rational::ONE, powers)
            })
            .collect(),
    };
    Ok(proved(plant, domain, &exprs, &separated).then_some(separated))
}

/// Whether the separation is an identity.
fn proved(plant: &Plant, domain: &Domain, exprs: &[Expr], separated: &Separated) -> bool {
    let arena = &plant.arena;
    exprs.iter().zip(separated.known.iter().zip(&separated.factors)).all(|(expr, (known, factors))| {
        let products = factors.iter().zip(&separated.eta).map(|(f, e)| arena.mul(*f, *e));
        let rebuilt = arena.add(*known, arena.sum(products));
        decide(arena, arena.sub(*expr, rebuilt), domain).is_zero()
    })
}

/// Joins all functions of theta whose factors are constants of the plant into one, together with the
/// constants of the known part: `|chi + theta - L i|^2 - m^2` then has the unknown `|theta|^2 - m^2`.
pub(super) fn absorb_constants(plant: &Plant, domain: &Domain, separated: Separated) -> Separated {
    let arena = &plant.arena;
    // With several rows the constants would differ from row to row.
    let [factors] = separated.factors.as_slice() else { return separated };
    let constants: BTreeSet<Symbol> = plant.parameters.iter().map(|p| p.symbol).collect();
    let is_constant = |e: Expr| arena.symbols_of(&[e]).is_subset(&constants);
    let (joined, kept): (Vec<usize>, Vec<usize>) = (0..factors.len()).partition(|i| is_constant(factors[*i]));
    if joined.is_empty() {
        return separated;
    }
    // What the known part is where every signal is zero, if it has a value there, is a constant of it.
    let signals = arena.symbols_of(&separated.known).into_iter().filter(|s| !constants.contains(s));
    let origin: BTreeMap<Symbol, Expr> = signals.map(|s| (s, arena.zero())).collect();
    let constant = arena.substitute(separated.known[0], &origin);
    let constant = match crate::cas::zero::point_of(arena, constant, domain) {
        Some(_) => constant,
        None => arena.zero(),
    };
    let mut sum: Vec<Expr> = joined.iter().map(|i| arena.mul(factors[*i], separated.eta[*i])).collect();
    sum.push(constant);
    let joint = shortest(arena, domain, arena.neg(arena.sum(sum)));
    let mut eta: Vec<Expr> = kept.iter().map(|i| separated.eta[*i]).collect();
    let mut row: Vec<Expr> = kept.iter().map(|i| factors[*i]).collect();
    eta.push(joint);
    row.push(arena.number(-1));
    let known = shortest(arena, domain, arena.sub(separated.known[0], constant));
    Separated { known: vec![known], factors: vec![row], eta }
}

/// theta as functions of the eta symbols, each proved.
pub(super) fn recover(plant: &Plant, domain: &Domain, eta: &[Expr]) -> Option<Vec<Expr>> {
    let arena = &plant.arena;
    let symbols = plant.eta(eta.len());
    let equations: Vec<Equation> =
        eta.iter().zip(&symbols).map(|(f, s)| Equation { formula: *f, value: arena.of_symbol(*s) }).collect();
    let direct: BTreeMap<Symbol, Expr> = equations
        .iter()
        .filter_map(|e| Some((arena.as_symbol(e.formula)?, e.value)))
        .filter(|(s, _)| plant.theta.contains(s))
        .collect();
    let rest: Vec<Symbol> = plant.theta.iter().copied().filter(|t| !direct.contains_key(t)).collect();
    let mut solved = if rest.is_empty() { BTreeMap::new() } else { solve(arena, domain, &equations, &rest).ok()? };
    solved.extend(direct);
    let values: BTreeMap<Symbol, Expr> = symbols.iter().copied().zip(eta.iter().copied()).collect();
    plant
        .theta
        .iter()
        .map(|theta| {
            let formula = *solved.get(theta)?;
            let difference = arena.sub(arena.substitute(formula, &values), arena.of_symbol(*theta));
            decide(arena, difference, domain).is_zero().then_some(formula)
        })
        .collect()
}

//! Separating unknown constants from known signals: the over-parameterised regression.
//!
//! In: expressions in z. Out: with z = chi + theta, each as a sum of products of a known function of
//! chi, y and u with a function of theta alone, where polynomials, exponentials, sines and cosines
//! allow it (Ortega et al. 2015, remark R4 and eq. 28).

use std::collections::{BTreeMap, BTreeSet};

use super::premises::Premises;
use pebo_cas::domain::zero::{Answer, decide, point_of};
use pebo_cas::forms::opaque::OpaqueTerms;
use pebo_cas::linear::comparison::combine;
use pebo_cas::poly::Monomial;
use pebo_cas::tower::{Field, Fraction, Obstacle};
use pebo_cas::{Arena, Expr, Rational, Symbol};

/// Expressions as `known + factors * eta`.
#[derive(Clone, Debug)]
pub(super) struct Separation {
    /// The known term of each expression.
    pub known: Vec<Expr>,
    /// The factors of each eta, a row for each expression.
    pub factors: Vec<Vec<Expr>>,
    /// The functions of theta.
    pub eta: Vec<Expr>,
}

/// Separates expressions in z at z = chi + theta; none where a kernel mixes theta with signals.
pub(super) fn separate(premises: &Premises<'_>, in_z: &[Expr]) -> Result<Option<Separation>, Obstacle> {
    let (arena, plant) = (premises.arena(), premises.plant);
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
    let Some(mut separated) = apart(premises, &unknown, &exprs)? else { return Ok(None) };
    // Functions of known signals are kept as written, where no relation among them is needed: `tanh(5*u)` by
    // exponentials overflows where it is 1.
    let mut frozen = OpaqueTerms::new(arena, &unknown);
    let signals = frozen.replace(&exprs);
    if !frozen.is_empty()
        && let Ok(Some(kept)) = apart(premises, &unknown, &signals)
        && kept.eta == separated.eta
    {
        let thaw = |exprs: &[Expr]| -> Vec<Expr> { exprs.iter().map(|expr| frozen.restore(*expr)).collect() };
        separated.known = thaw(&kept.known);
        separated.factors = kept.factors.iter().map(|row| thaw(row)).collect();
    }
    prove(premises, &exprs, &separated)?;
    Ok(Some(separated))
}

/// Separates expressions at z = chi + theta; none where a kernel mixes theta with signals.
fn apart(premises: &Premises<'_>, unknown: &BTreeSet<Symbol>, exprs: &[Expr]) -> Result<Option<Separation>, Obstacle> {
    let arena = premises.arena();
    let field = Field::over(arena, &premises.domain.facts, exprs)?;
    let kernels: Vec<u32> = field.kernels_of(unknown).into_iter().collect();
    let constants: BTreeSet<Symbol> = premises.constants().union(unknown).copied().collect();
    if kernels.iter().any(|k| !arena.symbols_of(&[field.kernel(*k)]).is_subset(&constants)) {
        return Ok(None);
    }
    let mut columns: Vec<Powers> = Vec::new();
    let mut rows: Vec<BTreeMap<Powers, Fraction>> = Vec::new();
    for expr in exprs {
        let fraction = field.fraction(*expr)?;
        // A product of kernels of theta may be a denominator, as exp(theta) in cosh; a sum may not.
        let denominator = fraction.denominator().collect(&kernels);
        let [(below, known)] = denominator.as_slice() else { return Ok(None) };
        let below = powers(below, -1);
        let mut row = BTreeMap::new();
        for (monomial, coefficient) in fraction.numerator().collect(&kernels) {
            let column = product(&powers(&monomial, 1), &below);
            let coefficient = field.quotient(&coefficient, known)?;
            if !column.is_empty() && !columns.contains(&column) {
                columns.push(column.clone());
            }
            row.insert(column, coefficient);
        }
        rows.push(row);
    }
    // theta itself first, then by degree.
    columns.sort_by_key(|column| (column.iter().map(|(_, e)| e.abs()).sum::<i64>(), column.clone()));
    let show = |row: &BTreeMap<Powers, Fraction>, column: &Powers| {
        row.get(column).map_or_else(|| arena.zero(), |fraction| field.show(fraction))
    };
    Ok(Some(Separation {
        known: rows.iter().map(|row| show(row, &Powers::new())).collect(),
        factors: rows.iter().map(|row| columns.iter().map(|c| show(row, c)).collect()).collect(),
        eta: columns
            .iter()
            .map(|c| arena.multiply(&Rational::ONE, c.iter().map(|&(k, e)| (field.kernel(k), Rational::from(e)))))
            .collect(),
    }))
}

/// Kernels with their exponents, ascending, no exponent zero.
type Powers = Vec<(u32, i64)>;

/// The powers of a monomial, to a common exponent.
fn powers(monomial: &Monomial, exponent: i64) -> Powers {
    monomial
        .powers()
        .iter()
        .map(|&(kernel, times)| (kernel, exponent * i64::from(times)))
        .filter(|p| p.1 != 0)
        .collect()
}

fn product(a: &Powers, b: &Powers) -> Powers {
    let mut total: BTreeMap<u32, i64> = BTreeMap::new();
    for &(kernel, exponent) in a.iter().chain(b) {
        *total.entry(kernel).or_default() += exponent;
    }
    total.into_iter().filter(|p| p.1 != 0).collect()
}

impl Separation {
    /// The expressions themselves.
    fn rebuilt(&self, arena: &Arena) -> Vec<Expr> {
        let rows = self.known.iter().zip(&self.factors);
        rows.map(|(known, factors)| arena.add(*known, arena.dot(factors, &self.eta))).collect()
    }
}

/// Proves that the separation is an identity.
fn prove(premises: &Premises<'_>, exprs: &[Expr], separated: &Separation) -> Result<(), Obstacle> {
    let arena = premises.arena();
    for (expr, rebuilt) in exprs.iter().zip(separated.rebuilt(arena)) {
        match decide(arena, arena.sub(*expr, rebuilt), premises.domain) {
            Answer::Zero => {}
            Answer::Open(obstacle) => return Err(obstacle),
            Answer::NonZero(_) => return Err(Obstacle::NoWitness),
        }
    }
    Ok(())
}

/// Tests whether a function of z is a sum of known signals times functions of theta.
pub(super) fn is_separable(premises: &Premises<'_>, in_z: Expr) -> bool {
    matches!(separate(premises, &[in_z]), Ok(Some(_)))
}

/// Joins all functions of theta whose factors are constants of the plant into one, with the constants of the known
/// term: `|chi + theta - L i|^2 - m^2` then has the unknown `|theta|^2 - m^2`.
pub(super) fn absorb_constants(premises: &Premises<'_>, separated: Separation) -> Separation {
    let arena = premises.arena();
    // With several rows the constants would differ from row to row.
    let [factors] = separated.factors.as_slice() else { return separated };
    let constants = premises.constants();
    let is_constant = |e: Expr| arena.symbols_of(&[e]).is_subset(&constants);
    let (joined, kept): (Vec<usize>, Vec<usize>) = (0..factors.len()).partition(|i| is_constant(factors[*i]));
    if joined.is_empty() {
        return separated;
    }
    // The value of the known term at zero signals, if there is one, is a constant of it.
    let signals = arena.symbols_of(&separated.known).into_iter().filter(|s| !constants.contains(s));
    let origin: BTreeMap<Symbol, Expr> = signals.map(|s| (s, arena.zero())).collect();
    let constant = arena.substitute(separated.known[0], &origin);
    let has_value = point_of(arena, constant, premises.domain).is_some();
    let constant = if has_value { constant } else { arena.zero() };
    let mut sum: Vec<Expr> = joined.iter().map(|i| arena.mul(factors[*i], separated.eta[*i])).collect();
    sum.push(constant);
    let joint = premises.shortest(arena.neg(arena.sum(sum)));
    let mut eta: Vec<Expr> = kept.iter().map(|i| separated.eta[*i]).collect();
    let mut row: Vec<Expr> = kept.iter().map(|i| factors[*i]).collect();
    eta.push(joint);
    row.push(arena.number(-1));
    let known = premises.shortest(arena.sub(separated.known[0], constant));
    Separation { known: vec![known], factors: vec![row], eta }
}

/// Joins functions of theta whose factors are constant combinations of other factors: only their sums are identifiable,
/// as `theta1 + theta2^2` in a rate `a + b^2`.
pub(super) fn join_dependent(premises: &Premises<'_>, separated: &Separation) -> Result<Separation, Obstacle> {
    let arena = premises.arena();
    // A symbol for each row, so that one expression holds a column.
    let marks: Vec<Symbol> = (0..separated.factors.len()).map(|row| arena.generated(&format!("row {row}"))).collect();
    let column = |j: usize| {
        arena.sum(marks.iter().zip(&separated.factors).map(|(mark, row)| arena.mul(arena.of_symbol(*mark), row[j])))
    };
    let columns: Vec<Expr> = (0..separated.eta.len()).map(column).collect();
    let field = Field::over(arena, &premises.domain.facts, &columns)?;
    let constants = premises.constants();
    let signals: BTreeSet<Symbol> = arena.symbols_of(&columns).difference(&constants).copied().collect();
    let mut kept: Vec<(usize, Expr)> = Vec::new();
    for (j, &eta) in separated.eta.iter().enumerate() {
        let basis: Vec<Expr> = kept.iter().map(|(k, _)| columns[*k]).collect();
        match combine(&field, columns[j], &basis, &signals)? {
            Some(coefficients) => {
                for ((_, sum), coefficient) in kept.iter_mut().zip(&coefficients) {
                    *sum = arena.add(*sum, arena.mul(field.show(coefficient), eta));
                }
            }
            None => kept.push((j, eta)),
        }
    }
    let result = Separation {
        known: separated.known.clone(),
        factors: separated.factors.iter().map(|row| kept.iter().map(|(j, _)| row[*j]).collect()).collect(),
        eta: kept.into_iter().map(|(_, sum)| sum).collect(),
    };
    prove(premises, &separated.rebuilt(arena), &result)?;
    Ok(result)
}

//! Rates that are affine in the transform: `f_y = A(y, u) + B(y, u) phi`, and the linear regression they make.

use std::collections::{BTreeMap, BTreeSet};

use crate::analysis::affine;
use crate::analysis::design::{Cascade, LeftInverse, Regression, RegressionKind};
use crate::plant::Plant;
use crate::plant::matrix::dot;
use pebo_cas::domain::zero::decide;
use pebo_cas::forms::tidy::{functions, shortest, shortest_equal, with_fewer_conditions};
use pebo_cas::graph::conditions::Regularity;
use pebo_cas::tower::Obstacle;
use pebo_cas::{Domain, Expr, Symbol};

/// One output as an affine function of the transform.
pub(super) struct OutputRate {
    /// The term free of x.
    pub(super) known: Expr,
    /// The coefficients of the components of the transform, free of x.
    pub(super) factors: Vec<Expr>,
}

/// Writes an output's rate over {1, phi}, and proves it: with the left inverse where that has fewer domain conditions,
/// since with more components than states there are many ways.
pub(super) fn decompose(
    plant: &Plant,
    domain: &Domain,
    left_inverse: Option<&LeftInverse>,
    (index, rate): (usize, Expr),
) -> Result<Option<OutputRate>, Obstacle> {
    let others = || {
        let inverse = left_inverse.filter(|_| plant.phi.len() > plant.x.len())?;
        by_left_inverse(plant, domain, inverse, rate)
    };
    Ok(decomposed(plant, domain, index, rate)?.map(|row| match others() {
        Some(other) if open_conditions(plant, domain, &other) < open_conditions(plant, domain, &row) => other,
        _ => row,
    }))
}

/// The number of a row's domain conditions that the domain does not imply.
fn open_conditions(plant: &Plant, domain: &Domain, row: &OutputRate) -> usize {
    let arena = &plant.arena;
    let formulas = [row.factors.as_slice(), &[row.known]].concat();
    let conditions = arena.domain_conditions(&formulas, Regularity::Defined).into_iter();
    conditions.filter(|condition| !domain.grants(arena, *condition)).count()
}

/// The rate at the left inverse, where that is affine in z; proved.
fn by_left_inverse(plant: &Plant, domain: &Domain, inverse: &LeftInverse, rate: Expr) -> Option<OutputRate> {
    let arena = &plant.arena;
    let states: BTreeMap<Symbol, Expr> = inverse.x.iter().copied().collect();
    let z: BTreeSet<Symbol> = plant.z.iter().copied().collect();
    let in_z = arena.substitute(rate, &states);
    let slope = |z: &Symbol| shortest(arena, domain, arena.derivative(in_z, *z));
    let factors: Vec<Expr> = plant.z.iter().map(slope).collect();
    let nowhere: BTreeMap<Symbol, Expr> = plant.z.iter().map(|z| (*z, arena.zero())).collect();
    let known = shortest(arena, domain, arena.substitute(in_z, &nowhere));
    let foreign: BTreeSet<Symbol> = plant.hidden().union(&z).copied().collect();
    let is_free = |formula: &Expr| !arena.depends_on(*formula, &foreign);
    let rebuilt = arena.add(known, dot(arena, &factors, &plant.transform()));
    let is_right =
        factors.iter().chain([&known]).all(is_free) && decide(arena, arena.sub(rate, rebuilt), domain).is_zero();
    is_right.then_some(OutputRate { known, factors })
}

fn decomposed(plant: &Plant, domain: &Domain, index: usize, rate: Expr) -> Result<Option<OutputRate>, Obstacle> {
    let arena = &plant.arena;
    let phi = plant.transform();
    if let Some((known, factors)) = plant.proposal.rates.get(&plant.y[index].symbol) {
        let rebuilt = arena.add(*known, dot(arena, factors, &phi));
        if decide(arena, arena.sub(rate, rebuilt), domain).is_zero() {
            return Ok(Some(OutputRate { known: *known, factors: factors.clone() }));
        }
    }
    let Some(row) = affine::of(plant, domain, rate)? else { return Ok(None) };
    let (known, factors) = (row[0], &row[1..]);
    // If the transform is the state itself, the author's own coefficients may be shorter.
    let factors = factors
        .iter()
        .zip(&phi)
        .map(|(factor, component)| match arena.as_symbol(*component) {
            Some(state) => shortest_equal(arena, domain, *factor, &[arena.derivative(rate, state)]),
            None => *factor,
        })
        .collect();
    Ok(Some(OutputRate { known, factors }))
}

/// `Phi_0` and `Phi_1` of affine rows.
pub(super) fn linear(
    plant: &Plant,
    domain: &Domain,
    cascade: &Cascade,
    left_inverse: Option<&LeftInverse>,
    rows: Vec<usize>,
    affine: &[OutputRate],
) -> Regression {
    let arena = &plant.arena;
    let extension = if cascade.lambda.is_some() { &plant.xi } else { &plant.chi };
    let chi: Vec<Expr> = extension.iter().map(|s| arena.of_symbol(*s)).collect();
    let theta: Vec<Expr> = plant.theta.iter().map(|s| arena.of_symbol(*s)).collect();
    // The left inverse at chi: where the rate is affine in z, the author's formula there is `Phi_0`.
    let at_chi: BTreeMap<Symbol, Expr> = plant.z.iter().copied().zip(chi.iter().copied()).collect();
    let states: BTreeMap<Symbol, Expr> =
        left_inverse.iter().flat_map(|l| &l.x).map(|(s, formula)| (*s, arena.substitute(*formula, &at_chi))).collect();
    let mut phi_0 = Vec::new();
    let mut phi_1 = Vec::new();
    for (row, output) in affine.iter().zip(&rows) {
        let known =
            arena.add(row.known, arena.sum(row.factors.iter().zip(&chi).map(|(factor, chi)| arena.mul(*factor, *chi))));
        let written = plant.y[*output].rate.map(|rate| arena.substitute(rate.expr, &states));
        let written: Vec<Expr> = written.into_iter().filter(|w| !arena.depends_on(*w, &plant.hidden())).collect();
        // In the author's own shape, if there is one, each state is a coordinate, and no function falls away.
        let is_coordinate =
            |symbol: &Symbol| states.get(symbol).is_none_or(|formula| arena.as_symbol(*formula).is_some());
        let own = plant.y[*output].rate.filter(|rate| arena.symbols_of(&[rate.expr]).iter().all(is_coordinate));
        let own = own.filter(|_| plant.class.is_none()).and_then(|_| written.first().copied());
        let own = own.filter(|own| decide(arena, arena.sub(*own, known), domain).is_zero());
        let calls = |form: Expr| functions(arena, &[form]).len();
        let tidied = || {
            let candidates = [written.as_slice(), &[shortest(arena, domain, known)]].concat();
            with_fewer_conditions(arena, domain, shortest_equal(arena, domain, known, &candidates), &written)
        };
        phi_0.push(match own {
            Some(own) if calls(own) == 0 => own,
            Some(own) => Some(tidied()).filter(|tidied| calls(*tidied) < calls(own)).unwrap_or(own),
            None => tidied(),
        });
        // The slopes of a formula affine in z are the factors.
        let factors: Vec<Expr> = row
            .factors
            .iter()
            .zip(extension)
            .map(|(factor, symbol)| {
                let slopes: Vec<Expr> = written.iter().map(|w| arena.derivative(*w, *symbol)).collect();
                with_fewer_conditions(arena, domain, *factor, &slopes)
            })
            .collect();
        phi_1.push(match &cascade.lambda {
            None => factors,
            Some(_) => (0..theta.len())
                .map(|column| {
                    let terms = factors.iter().zip(&plant.psi);
                    arena.sum(terms.map(|(factor, psi)| arena.mul(*factor, arena.of_symbol(psi[column]))))
                })
                .collect(),
        });
    }
    Regression {
        kind: RegressionKind::Dynamic,
        sources: rows.into_iter().map(|row| vec![row]).collect(),
        phi_0,
        phi_1,
        primitive_0: Vec::new(),
        primitive_1: Vec::new(),
        eta: theta.clone(),
        theta: plant.eta(theta.len()).iter().map(|s| arena.of_symbol(*s)).collect(),
        eta_symbols: plant.eta(theta.len()),
        steps: Vec::new(),
        alternative: None,
        unused: Vec::new(),
    }
}

//! Rates that are affine in the transform: `f_y = A(y, u) + B(y, u) phi`.
//!
//! The decomposition needs no left inverse, and finds the linear form where substituting the left inverse would hide
//! it. The equation is printed in the author's shape where that is one.

use std::collections::BTreeMap;

use super::equation::Equation;
use super::premises::Premises;
use crate::analysis::affine::{self, Row};
use pebo_cas::forms::tidy::{functions, shortest_equal, with_fewer_conditions};
use pebo_cas::graph::conditions::Regularity;
use pebo_cas::tower::Obstacle;
use pebo_cas::{Expr, Symbol};

/// The equation for the rate of one output, or of a combination of several; none if it is not affine in phi.
pub(super) fn equation(
    premises: &Premises<'_>,
    (primitive, rate): (Expr, Expr),
    outputs: Vec<usize>,
) -> Result<Option<Equation>, Obstacle> {
    let arena = premises.arena();
    let first = outputs.first().map(|output| premises.plant.y[*output].symbol);
    let Some(row) = decompose(premises, first, rate)? else { return Ok(None) };
    // The rate at the left inverse: where it is affine in z, the author's formula, whose slopes are the factors.
    let written = premises.at_left_inverse(rate).unwrap_or(rate);
    let written: Vec<Expr> = Some(written).into_iter().filter(|written| !premises.is_hidden(*written)).collect();
    let factor = |(factor, z): (&Expr, &Symbol)| {
        let slopes: Vec<Expr> = written.iter().map(|written| arena.derivative(*written, *z)).collect();
        with_fewer_conditions(arena, premises.domain, *factor, &slopes)
    };
    let factors = row[1..].iter().zip(&premises.plant.z).map(factor).collect();
    let in_z = in_authors_shape(premises, rate, premises.of_row(&row), &written);
    let none = vec![arena.zero(); premises.plant.z.len()];
    Ok(Some(Equation { primitive, rate: in_z, outputs, factors: Some([none, factors]) }))
}

/// An affine function of z as the author wrote it, if each state is a coordinate and no function falls away; else in
/// its shortest form.
fn in_authors_shape(premises: &Premises<'_>, rate: Expr, in_z: Expr, written: &[Expr]) -> Expr {
    let (arena, domain) = (premises.arena(), premises.domain);
    let states: BTreeMap<Symbol, Expr> = premises.left_inverse.iter().flat_map(|l| l.x.iter().copied()).collect();
    let is_coordinate = |symbol: &Symbol| states.get(symbol).is_none_or(|formula| arena.as_symbol(*formula).is_some());
    let is_own = premises.plant.class.is_none() && arena.symbols_of(&[rate]).iter().all(is_coordinate);
    let own = written.first().copied().filter(|own| is_own && premises.are_equal(*own, in_z));
    let calls = |form: Expr| functions(arena, &[form]).len();
    let tidied = || {
        let candidates = [written, &[premises.shortest(in_z)]].concat();
        with_fewer_conditions(arena, domain, shortest_equal(arena, domain, in_z, &candidates), written)
    };
    match own {
        Some(own) if calls(own) == 0 => own,
        Some(own) => Some(tidied()).filter(|tidied| calls(*tidied) < calls(own)).unwrap_or(own),
        None => tidied(),
    }
}

/// A rate over {1, phi}, proved: with the left inverse where that has fewer domain conditions, since with more
/// components than states there are many ways.
fn decompose(premises: &Premises<'_>, output: Option<Symbol>, rate: Expr) -> Result<Option<Row>, Obstacle> {
    let (arena, plant) = (premises.arena(), premises.plant);
    let open_conditions = |row: &Row| {
        let conditions = arena.domain_conditions(row, Regularity::Defined).into_iter();
        conditions.filter(|condition| !premises.domain.grants(arena, *condition)).count()
    };
    let Some(row) = over_transform(premises, output, rate)? else { return Ok(None) };
    let is_free = |row: &Row| !row.iter().any(|entry| premises.is_hidden(*entry));
    let by_left_inverse = || {
        let row = premises.row(premises.at_left_inverse(rate)?).filter(is_free)?;
        premises.are_equal(rate, premises.at_phi(premises.of_row(&row))).then_some(row)
    };
    let others = if plant.phi.len() > plant.x.len() { by_left_inverse() } else { None };
    Ok(Some(others.filter(|other| open_conditions(other) < open_conditions(&row)).unwrap_or(row)))
}

fn over_transform(premises: &Premises<'_>, output: Option<Symbol>, rate: Expr) -> Result<Option<Row>, Obstacle> {
    let (arena, plant, phi) = (premises.arena(), premises.plant, premises.plant.transform());
    if let Some((known, factors)) = output.and_then(|output| plant.proposal.rates.get(&output))
        && premises.are_equal(rate, arena.add(*known, arena.dot(factors, &phi)))
    {
        return Ok(Some([&[*known], factors.as_slice()].concat()));
    }
    let Some(mut row) = affine::of(plant, premises.domain, rate)? else { return Ok(None) };
    // If the transform is the state itself, the author's own coefficients may be shorter.
    for (factor, component) in row[1..].iter_mut().zip(&phi) {
        if let Some(state) = arena.as_symbol(*component) {
            *factor = shortest_equal(arena, premises.domain, *factor, &[arena.derivative(rate, state)]);
        }
    }
    Ok(Some(row))
}

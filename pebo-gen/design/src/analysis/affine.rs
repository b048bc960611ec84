//! Formulas as affine combinations of the transform, `A(y, u) + B(y, u) phi`. The generalised cascade, the linear
//! regression and the use of identities depend on them.
//!
//! In: a formula. Out: its coefficients, free of x and proved; or points that show that there are none.

use std::collections::BTreeSet;

use crate::plant::Plant;
use pebo_cas::domain::zero::{Answer, decide};
use pebo_cas::linear::combination::combine_on;
use pebo_cas::linear::contrast::{Contrast, contrast};
use pebo_cas::tower::Obstacle;
use pebo_cas::{Domain, Expr, Symbol};

/// The known term, then the factor of each component.
pub(super) type Row = Vec<Expr>;

/// An expression as an affine combination of the transform with coefficients free of x, proved: the known term, then
/// the factors; none where there is no such combination.
pub(super) fn of(plant: &Plant, domain: &Domain, expr: Expr) -> Result<Option<Row>, Obstacle> {
    let mut basis = vec![plant.arena.one()];
    basis.extend(plant.transform());
    over(plant, domain, expr, &basis)
}

/// The same over any basis that begins with 1.
fn over(plant: &Plant, domain: &Domain, expr: Expr, basis: &[Expr]) -> Result<Option<Row>, Obstacle> {
    let arena = &plant.arena;
    let places = connected(plant, expr, basis);
    let some: Vec<Expr> = places.iter().map(|place| basis[*place]).collect();
    let combined = |expr: Expr| combine_on(arena, domain, expr, &some, &plant.hidden());
    // Through the transform a sample is filtered: the output itself takes part only where it has to.
    let known = || plant.shown(domain, expr).ok().filter(|known| *known != expr);
    let found = match combined(expr) {
        Ok(Some(found)) => found,
        other => match known().map(combined).transpose() {
            Ok(Some(Some(found))) => found,
            _ => return other.map(|_| None),
        },
    };
    let mut row = vec![arena.zero(); basis.len()];
    for (place, coefficient) in places.into_iter().zip(found) {
        row[place] = coefficient;
    }
    match decide(arena, arena.sub(expr, arena.dot(&row, basis)), domain) {
        Answer::Zero => Ok(Some(row)),
        Answer::Open(obstacle) => Err(obstacle),
        Answer::NonZero(_) => Err(Obstacle::NoWitness),
    }
}

/// Indices of 1 and of the functions that share unmeasured signals with an expression, or with one another. The other
/// functions are free of these signals, so that 1 is among them; identities tie signals to one another.
fn connected(plant: &Plant, expr: Expr, basis: &[Expr]) -> Vec<usize> {
    if !plant.identities.is_empty() {
        return (0..basis.len()).collect();
    }
    let arena = &plant.arena;
    let hidden = plant.hidden();
    let of = |expr: Expr| -> BTreeSet<Symbol> { arena.symbols_of(&[expr]).intersection(&hidden).copied().collect() };
    let mut reached = of(expr);
    let mut open: Vec<(usize, BTreeSet<Symbol>)> = basis.iter().map(|b| of(*b)).enumerate().skip(1).collect();
    let mut places = vec![0];
    loop {
        let (near, far): (Vec<_>, Vec<_>) = open.into_iter().partition(|(_, symbols)| !symbols.is_disjoint(&reached));
        if near.is_empty() {
            places.sort_unstable();
            return places;
        }
        for (place, symbols) in near {
            places.push(place);
            reached.extend(symbols);
        }
        open = far;
    }
}

/// Points of the domain with the same y, u and parameters at which no affine function of the transform takes the values
/// of an expression.
pub(super) fn refuted(plant: &Plant, domain: &Domain, expr: Expr) -> Option<Contrast> {
    let mut basis = vec![plant.arena.one()];
    basis.extend(independent(plant, domain));
    contrast(&plant.arena, expr, &basis, &plant.hidden(), domain)
}

/// The components of the transform that are no combination of 1 and earlier components with coefficients free of x, on
/// the domain: where an output is given by value, one may be a function of y and u.
fn independent(plant: &Plant, domain: &Domain) -> Vec<Expr> {
    let mut basis = vec![plant.arena.one()];
    for component in plant.transform() {
        // An undecided component is kept: then nothing that it hides is refuted.
        if !matches!(over(plant, domain, component, &basis), Ok(Some(_))) {
            basis.push(component);
        }
    }
    basis.split_off(1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::Model;
    use crate::source::Source;

    #[test]
    fn a_redundant_component_neither_hides_nor_makes_curvature() {
        for phi in ["a, b", "a, 2*a, b", "a, b, a - y*b"] {
            let text =
                format!("model: m\nx: [a, b]\ny: [y]\nu: [u]\nf_x: {{a: 0, b: 0}}\nf_y: {{y: a}}\nphi: [{phi}]\n");
            let plant = Plant::resolve(&Model::parse(&Source::new("m", text).unwrap()).unwrap()).unwrap();
            let (arena, domain) = (&plant.arena, plant.domain());
            let [a, b, u] = ["a", "b", "u"].map(|name| arena.of_symbol(arena.symbol(name)));
            let straight = arena.add(arena.mul(u, a), b);
            assert!(refuted(&plant, &domain, straight).is_none() && of(&plant, &domain, straight).unwrap().is_some());
            assert!(refuted(&plant, &domain, arena.mul(a, b)).is_some(), "{phi}");
        }
    }

    #[test]
    fn a_component_given_by_an_output_hides_no_curvature() {
        let text =
            "model: m\nx: [a, b]\ny: [y]\nu: [u]\nw: [v]\nf_x: {a: u - b, b: a - v}\ng_y: {y: u - a}\nphi: [a, b]\n";
        let plant = Plant::resolve(&Model::parse(&Source::new("m", text).unwrap()).unwrap()).unwrap();
        let (arena, domain) = (&plant.arena, plant.domain());
        let [a, b, v] = ["a", "b", "v"].map(|name| arena.of_symbol(arena.symbol(name)));
        assert!(refuted(&plant, &domain, arena.sub(a, v)).is_some());
        assert!(refuted(&plant, &domain, arena.mul(a, b)).is_none(), "it is known times b");
        assert!(refuted(&plant, &domain, arena.mul(b, b)).is_some());
    }
}

//! A transform with functions of its components.
//!
//! In: a transform whose generalised cascade and left inverse are proved, in which the outputs are not affine. Out: its
//! components, followed by the functions of them in the outputs, in the rates of these, and so on; accepted with all
//! states recovered, or none. `r^2 = p^2 + q^2` is affine in no function of `z = (p, q)`, and in `p^2 + q^2` it is.

use super::candidate::Candidate;
use super::problem::Problem;
use super::sample::is_affine_in;
use super::{closure, functions};
use crate::analysis::{Class, Derivation, Verdict};
use crate::plant::Plant;
use pebo_cas::Expr;
use pebo_cas::tower::Obstacle;

/// The accepted transform that begins with the components of this plant's.
pub(super) fn lifted(problem: &Problem<'_>, plant: &Plant, derivation: &Derivation) -> Option<Candidate> {
    // Functions of components that do not determine the states are another transform, not this one.
    if derivation.class != Class::Gpebo || derivation.left_inverse.verdict != Verdict::Proved {
        return None;
    }
    let written = plant.transform();
    let of_outputs = || {
        let values = plant.identities.iter().map(|identity| functions::without_roots(problem, identity.expr));
        let by_rate = plant.y.iter().filter(|output| output.value.is_none());
        let rates = by_rate.filter_map(|output| output.rate).map(|rate| rate.expr);
        closure::closure_of_values(problem, &values.chain(rates).chain(written.iter().copied()).collect::<Vec<_>>())
    };
    let of_products = || closure::coordinates::closure(problem, plant, derivation);
    let with = |functions: Result<Option<Vec<Expr>>, Obstacle>| {
        let mut components = written.clone();
        for function in functions.ok()?? {
            if !is_affine_in(problem, &[function], &components).ok()? {
                components.push(function);
            }
        }
        let candidate = Candidate::derive(plant.lifted(&components[written.len()..]), problem);
        Some(candidate).filter(Candidate::is_full)
    };
    // The functions of x of the outputs are the fewest; they may not close where those of z do.
    with(of_outputs()).or_else(|| with(of_products()))
}

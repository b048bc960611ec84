//! Relations under the derivative.
//!
//! In: relations between z, y and parameters, of degree two in z with constant coefficients at the squares,
//!
//! ```text
//! a(y) + b(y).z + z'C z = 0
//! ```
//!
//! Out: the equations `d/dt (-(a + b.z)/2) = z'C (Lambda z + h)`. Where the right side is affine in z, as always under
//! a plain cascade, or becomes so by the relation itself (`z'C Lambda z = mu z'C z`), the regression that they make has
//! theta itself for its unknowns, and `theta'C theta`, which the relation itself would add to these, is gone. The
//! motor's fluxes lie on a circle, `|z - L i|^2 = lambda_m^2` (Ortega et al. 2015, eq. 28): `d/dt (L i.z - L^2 |i|^2/2)
//! = z.h`.

use super::equation::Equation;
use super::premises::Premises;
use pebo_cas::Expr;
use pebo_cas::domain::zero::point_of;
use pebo_cas::number::rational::half;

/// The equation that a relation becomes; none where squares have coefficients that move, or nothing moves at all.
pub(super) fn equation(premises: &Premises<'_>, relation: &Equation) -> Option<Equation> {
    let (arena, plant, constants) = (premises.arena(), premises.plant, premises.constants());
    let (z, of_outputs) = (premises.z(), plant.y.iter().map(|output| output.symbol));
    let known = constants.iter().chain(&plant.z).copied().chain(of_outputs).collect();
    let (mut squares, mut rate, mut witness) = (Vec::new(), Vec::new(), None);
    for (i, first) in plant.z.iter().enumerate() {
        let slope = arena.derivative(relation.rate, *first);
        for (j, second) in plant.z.iter().enumerate() {
            let curvature = premises.shortest(arena.derivative(slope, *second));
            if !arena.symbols_of(&[curvature]).is_subset(&constants) {
                return None;
            }
            if !arena.is_zero(curvature) {
                witness.get_or_insert((curvature, *first, *second));
            }
            let curvature = arena.scale(curvature, &half());
            squares.push(arena.product([curvature, z[i], z[j]]));
            rate.push(arena.product([curvature, z[j], premises.velocity(i)]));
        }
    }
    let rest = without_constant(premises, arena.sub(relation.rate, arena.sum(squares)));
    let primitive = premises.shortest(arena.neg(arena.scale(rest, &half())));
    let rate = arena.sum(rate);
    // The relation is zero: a multiple of it takes the square away, and with it all others, if they are in proportion.
    let (curvature, first, second) = witness?;
    let multiple = arena.div(arena.derivative(arena.derivative(rate, first), second), curvature);
    let rate = premises.shortest(arena.sub(rate, arena.mul(multiple, relation.rate)));
    let moves = !arena.is_zero(primitive) || !arena.is_zero(rate);
    // The rate of an input is not known.
    (moves && arena.symbols_of(&[primitive]).is_subset(&known))
        .then(|| Equation::new(premises, primitive, rate, relation.outputs.clone()))
}

/// An expression less its value at z = 0 and y = 0, if it has a value there without an input: a constant has no rate.
fn without_constant(premises: &Premises<'_>, expr: Expr) -> Expr {
    let (arena, plant) = (premises.arena(), premises.plant);
    let signals = plant.z.iter().copied().chain(plant.y.iter().map(|output| output.symbol));
    let constant = arena.substitute(expr, &signals.map(|signal| (signal, arena.zero())).collect());
    let is_constant = arena.symbols_of(&[constant]).is_subset(&premises.constants());
    if is_constant && point_of(arena, constant, premises.domain).is_some() { arena.sub(expr, constant) } else { expr }
}

//! Relations between the components of the transform, for a static regression.
//!
//! In: the plant. Out: polynomials of degree two at most in z, with coefficients in y and parameters, that
//! vanish at z = phi(x, y); each proved. The motor's `|z - L i|^2 = lambda_m^2` is one (Ortega et al. 2015,
//! eq. 28): its position is gone from it.

use super::equation::{Equation, outputs_in};
use super::premises::Premises;
use pebo_cas::linear::comparison::combine;
use pebo_cas::tower::{Field, Obstacle};
use pebo_cas::{Expr, Symbol};

use pebo_cas::linear::rank::proved_rank;

/// With more components the products are too many to be compared.
const MOST_COMPONENTS: usize = 6;

/// The relations, by their leading monomials.
pub(super) fn among(premises: &Premises<'_>) -> Result<Vec<Equation>, Obstacle> {
    let (arena, plant) = (premises.arena(), premises.plant);
    let phi = plant.transform();
    if phi.len() > MOST_COMPONENTS {
        return Ok(Vec::new());
    }
    let z = premises.z();
    let product = |monomial: &[usize], of: &[Expr]| arena.product(monomial.iter().map(|i| of[*i]));
    let mut roots = phi.clone();
    roots.extend(squares(phi.len()).iter().map(|monomial| product(monomial, &phi)));
    let field = Field::over(arena, &premises.domain.facts, &roots)?;
    let linear = (0..phi.len()).map(|i| vec![i]);
    // 1 comes first, then each monomial is looked for in the span of earlier ones.
    let mut before: Vec<Vec<usize>> = vec![Vec::new()];
    let mut leading: Vec<Vec<usize>> = Vec::new();
    let mut found = Vec::new();
    for monomial in linear.chain(squares(phi.len())) {
        // A multiple of a relation says nothing new.
        if leading.iter().any(|known| known.iter().all(|i| monomial.contains(i))) {
            continue;
        }
        let target = product(&monomial, &phi);
        let basis: Vec<Expr> = before.iter().map(|m| product(m, &phi)).collect();
        if let Some(coefficients) = combine(&field, target, &basis, &plant.hidden())? {
            let coefficients: Vec<Expr> = coefficients.iter().map(|c| field.show(c)).collect();
            if premises.are_equal(target, arena.dot(&coefficients, &basis)) {
                let in_z: Vec<Expr> = before.iter().map(|m| product(m, &z)).collect();
                let relation = arena.sub(product(&monomial, &z), arena.dot(&coefficients, &in_z));
                found.push(Equation::instant(premises, relation, outputs_in(plant, relation)));
                leading.push(monomial);
                continue;
            }
        }
        before.push(monomial);
    }
    Ok(found)
}

/// Tests whether the components of the transform may be related: a point where they move independently with x excludes
/// it.
pub(super) fn possible(premises: &Premises<'_>) -> bool {
    independent_directions(premises) < premises.plant.phi.len()
}

/// Tests whether the relations are complete: at a point of the domain they leave z no more directions than x has.
pub(super) fn are_all(premises: &Premises<'_>, relations: &[Equation]) -> bool {
    let z = &premises.plant.z;
    let slope = |relation: Expr, z: &Symbol| premises.at_phi(premises.arena().derivative(relation, *z));
    let rows: Vec<Vec<Expr>> = relations.iter().map(|r| z.iter().map(|z| slope(r.rate, z)).collect()).collect();
    proved_rank(premises.arena(), premises.domain, &rows, z.len()) + independent_directions(premises) >= z.len()
}

/// The rank of the transform's derivative in x, as far as points prove it.
fn independent_directions(premises: &Premises<'_>) -> usize {
    let (arena, plant) = (premises.arena(), premises.plant);
    let slopes = |phi: Expr| plant.x.iter().map(|x| arena.derivative(phi, x.symbol)).collect::<Vec<Expr>>();
    let rows: Vec<Vec<Expr>> = plant.transform().into_iter().map(slopes).collect();
    proved_rank(arena, premises.domain, &rows, plant.x.len())
}

/// The products of two components, as their positions.
fn squares(count: usize) -> Vec<Vec<usize>> {
    (0..count).flat_map(|i| (0..=i).map(move |j| vec![j, i])).collect()
}

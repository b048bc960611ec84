//! Relations between the components of the transform, for a static regression.
//!
//! In: the plant. Out: polynomials of degree two at most in z, with coefficients in y and parameters, that
//! vanish at z = phi(x, y); each proved. The motor's `|z - L i|^2 = lambda_m^2` is one (Ortega et al. 2015,
//! eq. 28): its position is gone from it.

use std::collections::BTreeMap;

use crate::plant::Plant;
use crate::plant::matrix::dot;
use pebo_cas::domain::zero::decide;
use pebo_cas::linear::comparison::combine;
use pebo_cas::tower::{Field, Obstacle};
use pebo_cas::{Domain, Expr, Symbol};

use pebo_cas::linear::rank::proved_rank;

/// With more components the products are too many to be compared.
const MOST_COMPONENTS: usize = 6;

/// The relations, by their leading monomials.
pub(super) fn among(plant: &Plant, domain: &Domain) -> Result<Vec<Expr>, Obstacle> {
    let arena = &plant.arena;
    let phi = plant.transform();
    if phi.len() > MOST_COMPONENTS {
        return Ok(Vec::new());
    }
    let z: Vec<Expr> = plant.z.iter().map(|s| arena.of_symbol(*s)).collect();
    let product = |monomial: &[usize], of: &[Expr]| arena.product(monomial.iter().map(|i| of[*i]));
    let mut roots = phi.clone();
    roots.extend(squares(phi.len()).iter().map(|monomial| product(monomial, &phi)));
    let field = Field::over(arena, &domain.facts, &roots)?;
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
            let difference = arena.sub(target, dot(arena, &coefficients, &basis));
            if decide(arena, difference, domain).is_zero() {
                let in_z: Vec<Expr> = before.iter().map(|m| product(m, &z)).collect();
                found.push(arena.sub(product(&monomial, &z), dot(arena, &coefficients, &in_z)));
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
pub(super) fn possible(plant: &Plant, domain: &Domain) -> bool {
    independent_directions(plant, domain) < plant.phi.len()
}

/// Tests whether the relations are complete: at a point of the domain they leave z no more directions than x has.
pub(super) fn are_all(plant: &Plant, domain: &Domain, relations: &[Expr]) -> bool {
    let arena = &plant.arena;
    let transform: BTreeMap<Symbol, Expr> = plant.z.iter().copied().zip(plant.transform()).collect();
    let slopes = relations.iter().map(|relation| {
        let slope = |z: &Symbol| arena.substitute(arena.derivative(*relation, *z), &transform);
        plant.z.iter().map(slope).collect::<Vec<Expr>>()
    });
    let rows: Vec<Vec<Expr>> = slopes.collect();
    proved_rank(arena, domain, &rows, plant.z.len()) + independent_directions(plant, domain) >= plant.z.len()
}

/// The rank of the transform's derivative in x, as far as points prove it.
fn independent_directions(plant: &Plant, domain: &Domain) -> usize {
    let arena = &plant.arena;
    let slopes = |phi: Expr| plant.x.iter().map(|x| arena.derivative(phi, x.symbol)).collect::<Vec<Expr>>();
    let rows: Vec<Vec<Expr>> = plant.transform().into_iter().map(slopes).collect();
    proved_rank(arena, domain, &rows, plant.x.len())
}

/// The products of two components, as their positions.
fn squares(count: usize) -> Vec<Vec<usize>> {
    (0..count).flat_map(|i| (0..=i).map(move |j| vec![j, i])).collect()
}

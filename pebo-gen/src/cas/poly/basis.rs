//! Gcd-free bases.

use super::Poly;
use super::work::{TooLarge, Work};

/// Polynomials without common factors, pairwise, of whose powers all the given polynomials are
/// products, up to integers and zeros (Bach, Driscoll and Shallit, 1993). Each is primitive with a
/// positive leading coefficient, none is constant; they ascend.
pub fn gcd_free_basis(polys: &[Poly], work: &Work) -> Result<Vec<Poly>, TooLarge> {
    let mut basis: Vec<Poly> = Vec::new();
    let mut pending: Vec<Poly> = polys.iter().rev().cloned().collect();
    'next: while let Some(poly) = pending.pop() {
        if poly.is_constant() {
            continue;
        }
        let (_, poly) = poly.primitive();
        for index in 0..basis.len() {
            let common = basis[index].gcd(&poly, work)?;
            if common.is_constant() {
                continue;
            }
            // Both split into the common factor and the rest, which are smaller: this ends.
            let other = basis.swap_remove(index);
            if common != other {
                pending.extend(other.div_exact(&common, work)?);
            }
            pending.extend(poly.div_exact(&common, work)?);
            pending.push(common);
            continue 'next;
        }
        basis.push(poly);
    }
    basis.sort();
    Ok(basis)
}

//! The generalised cascade: z' = Lambda(y, u) z + h(y, u).
//!
//! In: the derivative of the transform. Out: Lambda and h, if the derivative is an affine combination of
//! the transform itself with coefficients free of x, and the fundamental matrix Psi' = Lambda Psi
//! provably stays bounded (Ortega, Bobtsov, Nikolaev, Schiffer, Dochain 2021). Without that, Psi would
//! amplify whatever error the extension has, and the transform is not accepted.

use crate::cas::Expr;
use crate::cas::combination::combine;
use crate::cas::domain::Domain;
use crate::cas::field::{Field, Fraction, Obstacle};
use crate::cas::zero::decide;
use crate::plant::Plant;

use super::design::Cascade;

/// The generalised cascade, if there is one with a bounded fundamental matrix.
pub(super) fn generalised(plant: &Plant, domain: &Domain, rates: &[Expr]) -> Option<Cascade> {
    let arena = &plant.arena;
    let phi = plant.transform();
    let mut basis = vec![arena.one()];
    basis.extend(&phi);
    let mut h = Vec::new();
    let mut lambda = Vec::new();
    for &rate in rates {
        let mut roots = phi.clone();
        roots.push(rate);
        let field = Field::over(arena, &domain.facts, &roots).ok()?;
        let row: Vec<Expr> =
            combine(&field, rate, &basis, &plant.hidden()).ok()??.iter().map(|c| field.show(c)).collect();
        let rebuilt = arena.sum(row.iter().zip(&basis).map(|(c, b)| arena.mul(*c, *b)));
        if !decide(arena, arena.sub(rate, rebuilt), domain).is_zero() {
            return None;
        }
        h.push(row[0]);
        lambda.push(row[1..].to_vec());
    }
    dissipative(plant, domain, &lambda).ok()?.then_some(Cascade {
        h,
        lambda: Some(lambda),
        residual: Vec::new(),
        witness: None,
    })
}

/// Whether a quadratic form with a constant positive diagonal P never grows: P Lambda + Lambda' P is
/// diagonal without a positive entry. For circuits and mechanisms P is the stored energy.
fn dissipative(plant: &Plant, domain: &Domain, lambda: &[Vec<Expr>]) -> Result<bool, Obstacle> {
    let arena = &plant.arena;
    let roots: Vec<Expr> = lambda.iter().flatten().copied().collect();
    let field = Field::over(arena, &domain.facts, &roots)?;
    let entries = lambda
        .iter()
        .map(|row| row.iter().map(|e| field.fraction(*e)).collect::<Result<Vec<_>, _>>())
        .collect::<Result<Vec<_>, _>>()?;
    let size = entries.len();
    let mut weights: Vec<Option<Fraction>> = vec![None; size];
    for start in 0..size {
        if weights[start].is_some() {
            continue;
        }
        weights[start] = Some(Fraction::one());
        let mut open = vec![start];
        while let Some(i) = open.pop() {
            let Some(weight) = weights[i].clone() else { continue };
            for j in 0..size {
                let (out, back) = (&entries[i][j], &entries[j][i]);
                if i == j || (out.is_zero() && back.is_zero()) {
                    continue;
                }
                if out.is_zero() || back.is_zero() {
                    return Ok(false);
                }
                // P_j = -P_i Lambda_ij / Lambda_ji
                let other = field.div(&field.mul(&weight, out)?, &back.opposite())?;
                if !field.is_positive(&other)? || !is_constant(plant, field.show(&other)) {
                    return Ok(false);
                }
                match &weights[j] {
                    Some(known) if *known != other => return Ok(false),
                    Some(_) => {}
                    None => {
                        weights[j] = Some(other);
                        open.push(j);
                    }
                }
            }
        }
    }
    for (index, row) in entries.iter().enumerate() {
        if !row[index].is_zero() && !field.is_positive(&row[index].opposite())? {
            return Ok(false);
        }
    }
    Ok(true)
}

/// Whether the expression consists of parameters alone, their values known or not.
fn is_constant(plant: &Plant, expr: Expr) -> bool {
    plant.arena.symbols_of(&[expr]).iter().all(|symbol| plant.parameters.iter().any(|p| p.symbol == *symbol))
}

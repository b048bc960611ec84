//! Linear plants: observability, and the reason for a missing transform.
//!
//! The test of Popov, Belevitch and Hautus requires full column rank of `[s I - A11; A21]` at every s. Its kernels over
//! all s are the eigenvectors within the largest subspace of ker A21 that A11 maps into itself; that subspace is the
//! kernel of `A21, A21 A11, .., A21 A11^(n-1)`, which takes no eigenvalues to compute, so the answer is exact.

use crate::plant::Matrix;
use crate::plant::class::Linear;
use crate::plant::{Class, Plant};
use crate::source::{Code, Diagnostic};
use pebo_cas::domain::zero::{Answer, decide, is_zero};
use pebo_cas::tower::Obstacle;
use pebo_cas::{Arena, Domain, Expr};

use super::design::{Cascade, Claim, Verdict, Witness};

/// A basis of the unobservable states, as columns; none if the plant is observable.
///
/// At the parameters' values where they have one.
pub(super) fn unobservable(plant: &Plant, domain: &Domain, linear: &Linear) -> Result<Vec<Vec<Expr>>, Obstacle> {
    let arena = &plant.arena;
    let (a11, a21) = (valued(arena, domain, &linear.a11), valued(arena, domain, &linear.a21));
    let mut stack = a21.rows().to_vec();
    let mut latest = a21;
    for _ in 1..a11.height() {
        latest = latest.mul(arena, &a11).normal(arena, &domain.facts)?;
        stack.extend_from_slice(latest.rows());
    }
    Matrix::new(stack).null_space(arena, &domain.facts)
}

/// The unobservable directions, as a sentence; none if the plant is observable.
pub(super) fn unobservable_states(plant: &Plant, domain: &Domain, linear: &Linear) -> Result<Option<String>, Obstacle> {
    let arena = &plant.arena;
    let basis = unobservable(plant, domain, linear)?;
    let [vector, others @ ..] = basis.as_slice() else { return Ok(None) };
    let printed = |vector: &[Expr]| {
        let entries: Vec<String> = vector.iter().map(|e| arena.print(*e)).collect();
        format!("({})", entries.join(", "))
    };
    if !others.is_empty() {
        let vectors: Vec<String> = basis.iter().map(|v| printed(v)).collect();
        return Ok(Some(format!(
            "the plant is not observable: [s I - A11; A21] loses rank at {} eigenvalues of A11, whose eigenvectors are \
             combinations of {}",
            basis.len(),
            vectors.join(", ")
        )));
    }
    // A11 maps the line into itself: its factor is the eigenvalue. The free entry of the vector is 1.
    let image = valued(arena, domain, &linear.a11).apply(arena, vector);
    let free = vector.iter().position(|e| *e == arena.one()).unwrap_or(0);
    let eigenvalue = Matrix::new(vec![vec![image[free]]]).normal(arena, &domain.facts)?.at(0, 0);
    Ok(Some(format!(
        "the plant is not observable: [s I - A11; A21] loses rank at s = {}, along x = {}",
        arena.print(eigenvalue),
        printed(vector)
    )))
}

/// The refusal of a linear plant that has no transform: a state that A21 does not see and A11 moves.
///
/// With `A21 v = 0` and `A11 v != 0`, `T1 A11 + T2 A21 = 0` gives `T1 A11 v = 0`, hence T1 has not rank n.
pub(super) fn refuse(plant: &Plant, domain: &Domain, found: &mut Vec<Diagnostic>) -> Option<Claim<Cascade>> {
    let Some(Class::Linear(linear)) = &plant.class else { return None };
    if linear.unsolved.is_empty() {
        return None;
    }
    Some(witnessed(plant, domain, linear, found).unwrap_or_else(|obstacle| {
        found.push(
            Diagnostic::error(
                Code::CascadeUndecided,
                linear.span,
                "it could not be decided whether a transform exists",
            )
            .note(format!("obstacle: {obstacle}"))
            .help("give the parameters values"),
        );
        Claim { verdict: Verdict::Undecided, result: None }
    }))
}

fn witnessed(
    plant: &Plant,
    domain: &Domain,
    linear: &Linear,
    found: &mut Vec<Diagnostic>,
) -> Result<Claim<Cascade>, Obstacle> {
    let arena = &plant.arena;
    let hidden = linear.a21.null_space(arena, &domain.facts)?;
    for vector in hidden {
        let zero = linear.a21.apply(arena, &vector);
        if !zero.iter().all(|e| is_zero(arena, *e, domain)) {
            continue;
        }
        for moved in linear.a11.apply(arena, &vector) {
            let Answer::NonZero(point) = decide(arena, moved, domain) else { continue };
            let witness = Witness::of(moved, &point);
            found.push(refused(plant, domain, linear, &vector, &witness)?);
            let residual = plant.phi.iter().enumerate().map(|(row, _)| remainder(plant, linear, row)).collect();
            let result = Cascade { residual, witness: Some(witness), ..Cascade::default() };
            return Ok(Claim { verdict: Verdict::Refuted, result: Some(result) });
        }
    }
    Err(Obstacle::NoWitness)
}

/// The dependence of a component's rate on x, with the T2 that is left.
fn remainder(plant: &Plant, linear: &Linear, row: usize) -> Expr {
    let arena = &plant.arena;
    if !linear.unsolved.contains(&row) {
        return arena.zero();
    }
    let x: Vec<Expr> = plant.x.iter().map(|s| arena.of_symbol(s.symbol)).collect();
    arena.dot(&linear.a11.rows()[row], &x)
}

fn refused(
    plant: &Plant,
    domain: &Domain,
    linear: &Linear,
    vector: &[Expr],
    witness: &Witness,
) -> Result<Diagnostic, Obstacle> {
    let arena = &plant.arena;
    let entries: Vec<String> = vector.iter().map(|e| arena.print(*e)).collect();
    let observability = match unobservable_states(plant, domain, linear)? {
        None => "the plant is observable (PBH), which does not give a transform (Proposition 2, claim C1)".to_owned(),
        Some(blind) => blind,
    };
    let refusal = Diagnostic::error(
        Code::CascadeRefuted,
        linear.span,
        "no transform T1 x + T2 y of this plant has a rate that is free of x: no PEBO exists",
    )
    .label("T1 A11 + T2 A21 = 0 has no solution with T1 of full column rank")
    .note(format!(
        "along x = ({}) the rates of the outputs do not depend on x (A21 x = 0), but A11 x is not zero",
        entries.join(", ")
    ));
    // A number needs no witness.
    let refusal = if arena.as_number(witness.expr).is_some() { refusal } else { refusal.note(witness.sentence(arena)) };
    Ok(refusal.note(observability).help("measure more outputs, until every row of A11 is a combination of rows of A21"))
}

/// The matrix at the values of the parameters that have one.
fn valued(arena: &Arena, domain: &Domain, matrix: &Matrix) -> Matrix {
    matrix.map(|entry| arena.substitute(*entry, &domain.fixed))
}

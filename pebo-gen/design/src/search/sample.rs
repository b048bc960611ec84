//! Values modulo a prime at random points: heuristics before a proof.
//!
//! In: formulas. Out: their residues at points that share the parameters, or all but the unmeasured states and signals.

use std::collections::BTreeSet;

use pebo_cas::linear::residues::ResidueRows;
use pebo_cas::poly::{PrimeField, Residue};
use pebo_cas::tower::Obstacle;
use pebo_cas::tower::residue::{Words, prime_of_kernels};
use pebo_cas::tower::straight_line::StraightLineProgram;
use pebo_cas::{Budget, Expr};

use super::problem::Problem;

/// Points that are given up because a denominator vanishes there.
const MOST_POLES: usize = 50;

/// Primes that are tried where kernels have no values modulo the first: a root of a root has one modulo every fourth or
/// so.
const MOST_PRIMES: usize = 16;

/// Rows that bring nothing new, after which no more are looked at.
const IDLE: usize = 3;

/// Formulas with the data to evaluate them.
#[derive(Debug)]
pub(super) struct Sample<'a> {
    pub(super) prime: PrimeField,
    formulas: StraightLineProgram<'a>,
    hidden: BTreeSet<u32>,
    /// The kernels of constants, with their values.
    constants: Vec<Option<Residue>>,
    words: Words,
    budget: Budget,
}

/// The residues of all formulas at a point.
pub(super) type Values = Vec<Residue>;

impl<'a> Sample<'a> {
    pub(super) fn of(problem: &Problem<'a>, formulas: &[Expr]) -> Result<Self, Obstacle> {
        let mut words = Words::new(0x5eed);
        let of = |prime: &PrimeField| StraightLineProgram::of(problem.arena, &problem.domain.facts, prime, formulas);
        let first_prime = prime_of_kernels().ok_or(Obstacle::TooLarge)?;
        let mut straight = of(&first_prime)?;
        let mut found = straight.field().draw(&first_prime, &mut words, |_| None).map(|values| (first_prime, values));
        if found.is_none() {
            let at = |prime: PrimeField| Some((prime.clone(), straight.field().draw(&prime, &mut words, |_| None)?));
            found = straight.field().primes().take(MOST_PRIMES).find_map(at);
            if let Some((prime, _)) = &found {
                straight = of(prime)?;
            }
        }
        let (prime, first) = found.ok_or(Obstacle::NoResidue)?;
        let formulas = straight;
        let field = formulas.field();
        let hidden = field.kernels_of(&problem.hidden);
        let moving = field.kernels_of(&problem.signals);
        let constant = |(number, value): (u32, Residue)| (!moving.contains(&number)).then_some(value);
        let constants = (0..).zip(first).map(constant).collect();
        Ok(Self { prime, formulas, hidden, constants, words, budget: problem.arena.budget().clone() })
    }

    /// The values at so many points that differ in the unmeasured states and signals alone; the parameters are those of
    /// every point of this sample.
    pub(super) fn fibre(&mut self, points: usize) -> Option<Vec<Values>> {
        if !self.budget.take((points * self.formulas.length()) as u64) {
            return None;
        }
        (0..MOST_POLES).find_map(|_| {
            let constants = &self.constants;
            let base = self.formulas.field().draw(&self.prime, &mut self.words, |kernel| constants[kernel as usize])?;
            let mut found = Vec::with_capacity(points);
            let mut kernels = base.clone();
            while found.len() < points {
                found.push(self.formulas.residues(&self.prime, &kernels)?);
                let hidden = &self.hidden;
                let kept = |kernel: u32| (!hidden.contains(&kernel)).then(|| base[kernel as usize]);
                kernels = self.formulas.field().draw(&self.prime, &mut self.words, kept)?;
            }
            Some(found)
        })
    }

    /// The rows that a fibre of so many points gives, each with so many columns, until they bring nothing new.
    pub(super) fn rows(
        &mut self,
        columns: usize,
        points: usize,
        row: impl Fn(&PrimeField, &[Values]) -> Option<Values>,
    ) -> Option<Vec<(usize, Values)>> {
        let prime = self.prime.clone();
        let mut rows = ResidueRows::new(&prime, columns);
        let mut idle = 0;
        while idle < IDLE && rows.rank() < columns {
            if !self.budget.take((columns * (rows.rank() + 1)) as u64) {
                return None;
            }
            let fibre = self.fibre(points)?;
            if rows.insert(row(&prime, &fibre)?) { idle = 0 } else { idle += 1 }
        }
        Some(rows.null_space())
    }
}

/// The functions that, according to random points, are no combinations of earlier ones with constant coefficients.
pub(super) fn independent(problem: &Problem<'_>, functions: &[Expr]) -> Result<Vec<Expr>, Obstacle> {
    let mut sample = Sample::of(problem, functions)?;
    let columns = functions.len();
    let dependent = sample.rows(columns, 1, |_, fibre| fibre.first().cloned()).ok_or(Obstacle::OutOfBudget)?;
    let is_free = |column: &usize| dependent.iter().all(|(free, _)| free != column);
    Ok(functions.iter().enumerate().filter(|(column, _)| is_free(column)).map(|(_, e)| *e).collect())
}

/// The rank over the functions of y and u of the gradients of these functions by the states, as far as a random point
/// tells.
pub(super) fn rank_of_gradients(problem: &Problem<'_>, functions: &[Expr]) -> Result<usize, Obstacle> {
    let (arena, width) = (problem.arena, problem.x.len());
    let slopes: Vec<Expr> = functions.iter().flat_map(|e| problem.x.iter().map(|x| arena.derivative(*e, *x))).collect();
    let mut sample = Sample::of(problem, &slopes)?;
    let fibre = sample.fibre(1).ok_or(Obstacle::NoPoint)?;
    let prime = &sample.prime;
    let mut rows = ResidueRows::new(prime, width);
    for row in fibre[0].chunks(width) {
        rows.insert(row.to_vec());
    }
    Ok(rows.rank())
}

/// Tests whether, according to random points, each of the targets is an affine combination of the functions with
/// coefficients free of hidden symbols.
pub(super) fn is_affine_in(problem: &Problem<'_>, targets: &[Expr], functions: &[Expr]) -> Result<bool, Obstacle> {
    let count = functions.len();
    let mut sample = Sample::of(problem, &[functions, targets].concat())?;
    let fibre = sample.fibre(count + targets.len() + 2).ok_or(Obstacle::NoPoint)?;
    let prime = &sample.prime;
    let mut rows = ResidueRows::new(prime, 1 + count + targets.len());
    for values in &fibre {
        rows.insert([&[prime.one()], values.as_slice()].concat());
    }
    // A target that is a combination of the columns left of it, none of them a target.
    let vectors = rows.null_space();
    Ok((0..targets.len()).all(|target| {
        let column = 1 + count + target;
        vectors
            .iter()
            .any(|(free, vector)| *free == column && vector[1 + count..column].iter().all(|entry| entry.is_zero()))
    }))
}

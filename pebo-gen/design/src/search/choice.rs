//! The choice among transforms of one form.
//!
//! In: all solutions of an ansatz, simple ones first. Out: few of them whose gradients by x have full rank, and whose
//! span holds the rates of the outputs if the span of all does.

use crate::plant::Matrix;
use pebo_cas::tower::Obstacle;
use pebo_cas::{Expr, Relation};

use super::problem::Problem;
use super::sample::{is_affine_in, rank_of_gradients};

/// So many solutions beyond the number of states are chosen among.
const MOST_BEYOND: usize = 11;

/// Subsets of more solutions than this are not looked at.
const MOST_IN_SUBSETS: usize = 12;

/// More sets of components than this are not looked at for one that is a transform everywhere.
const MOST_SUBSETS: usize = 40;

/// Transforms to be proved, the most promising first, with the rank that their gradients reach.
#[derive(Debug, Default)]
pub(super) struct Choice {
    pub(super) transforms: Vec<Vec<Expr>>,
    pub(super) rank: usize,
    /// True if the rates of the outputs are affine in the first of them.
    pub(super) affine: bool,
}

/// All of the solutions as one transform.
pub(super) fn whole(problem: &Problem<'_>, solutions: &[Expr]) -> Result<Choice, Obstacle> {
    let rank = rank_of_gradients(problem, solutions)?;
    let rates = problem.output_rates();
    let mut affine = is_affine_in(problem, &rates, solutions)?;
    if !affine && !problem.plant.identities.is_empty() {
        let shown = rates.into_iter().map(|rate| problem.plant.shown(&problem.domain, rate));
        affine = is_affine_in(problem, &shown.collect::<Result<Vec<_>, _>>()?, solutions)?;
    }
    Ok(Choice { transforms: vec![solutions.to_vec()], rank, affine })
}

/// Chooses among solutions.
pub(super) fn choose(problem: &Problem<'_>, solutions: &[Expr]) -> Result<Choice, Obstacle> {
    let mut all: Vec<Expr> = Vec::new();
    for solution in solutions {
        if all.len() == problem.x.len() + MOST_BEYOND {
            break;
        }
        // One that is free of x, as a sum of roots that cancel, says nothing.
        if !is_affine_in(problem, &[*solution], &[])? {
            all.push(*solution);
        }
    }
    let mut few: Vec<Expr> = Vec::new();
    for solution in &all {
        let more = [few.as_slice(), &[*solution]].concat();
        if rank_of_gradients(problem, &more)? == more.len() {
            few = more;
        }
        if few.len() == problem.x.len() {
            break;
        }
    }
    let rank = few.len();
    let outputs = problem.output_rates();
    let affine = |phi: &[Expr]| is_affine_in(problem, &outputs, phi);
    if rank == problem.x.len() && rank < all.len() && !is_everywhere(problem, &few) {
        // Perhaps there are others whose gradients are independent everywhere.
        for subset in subsets(&all[..all.len().min(MOST_IN_SUBSETS)], rank).take(MOST_SUBSETS) {
            let linear = affine(&subset)? || !affine(&few)?;
            if linear && rank_of_gradients(problem, &subset)? == rank && is_everywhere(problem, &subset) {
                few = subset;
                break;
            }
        }
    }
    if few.len() == all.len() || affine(&few)? {
        let affine = affine(&few)?;
        return Ok(Choice { transforms: vec![few], rank, affine });
    }
    if !affine(&all)? {
        // All of them may be related, which is a regression as well.
        let together = (all.len() <= MOST_IN_SUBSETS).then(|| all.clone());
        return Ok(Choice { transforms: [few].into_iter().chain(together).collect(), rank, affine: false });
    }
    // The longest is dropped first: the shortest that suffice are left.
    let mut kept = all.clone();
    for solution in all.iter().rev() {
        let without: Vec<Expr> = kept.iter().copied().filter(|e| e != solution).collect();
        if without.len() >= rank && rank_of_gradients(problem, &without)? == rank && affine(&without)? {
            kept = without;
        }
    }
    Ok(Choice { transforms: vec![kept, few], rank, affine: true })
}

/// Tests whether the gradients by x are provably independent on the whole domain.
fn is_everywhere(problem: &Problem<'_>, phi: &[Expr]) -> bool {
    let (arena, domain) = (problem.arena, &problem.domain);
    let slopes = Matrix::build(phi.len(), phi.len(), |row, column| arena.derivative(phi[row], problem.x[column]));
    let volume = slopes.determinant(arena, &domain.facts);
    volume.is_ok_and(|volume| domain.implies(arena, volume, Relation::NonZero))
}

/// The subsets of this size, those of the first elements first.
fn subsets(all: &[Expr], size: usize) -> impl Iterator<Item = Vec<Expr>> {
    let chosen = move |mask: u32| {
        let kept = all.iter().enumerate().filter(move |(index, _)| (mask >> index) & 1 == 1);
        kept.map(|(_, e)| *e).collect()
    };
    (0..1_u32 << all.len()).filter(move |mask| mask.count_ones() as usize == size).map(chosen)
}

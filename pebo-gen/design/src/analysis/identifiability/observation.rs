//! What the rows of a regression with their derivatives show on a trajectory.

use pebo_cas::{Arena, Expr};

/// The observations of the rows with their derivatives on a trajectory.
#[derive(Clone, Default)]
pub(super) struct Observation {
    /// Rows of the same rank as all derivatives, with a fundamental matrix at its initial value.
    pub(super) stack: Vec<Vec<Expr>>,
    /// Directions that are unobservable in them.
    pub(super) hidden: Vec<Vec<Expr>>,
    /// True if they are unobservable for the given values of the parameters alone.
    pub(super) is_special: bool,
}

impl Observation {
    /// Tests whether all unknowns are identifiable.
    pub(super) fn is_full(&self) -> bool {
        self.hidden.is_empty()
    }
}

/// The column of each hidden direction in which it has one, and the others zero: the rank is that of the other columns.
pub(super) fn free_columns(arena: &Arena, hidden: &[Vec<Expr>], unknowns: usize) -> Vec<Option<usize>> {
    let own = |index: usize| {
        (0..unknowns).find(|&column| {
            let entry = |(other, vector): (usize, &Vec<Expr>)| {
                vector[column] == if other == index { arena.one() } else { arena.zero() }
            };
            hidden.iter().enumerate().all(entry)
        })
    };
    (0..hidden.len()).map(own).collect()
}

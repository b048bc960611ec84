//! The work limit: a counter that every operation that can explode draws from.
//!
//! One step is about one product of machine words with its bookkeeping: one to some tens of
//! nanoseconds. A computation that would draw more than is left stops before it does the work.

use std::cell::Cell;
use std::fmt;

/// Steps that are left to spend.
#[derive(Debug)]
pub struct Work {
    left: Cell<u64>,
}

impl Work {
    /// A budget of the given number of steps.
    pub fn new(steps: u64) -> Self {
        Self { left: Cell::new(steps) }
    }

    /// The steps that remain.
    pub fn left(&self) -> u64 {
        self.left.get()
    }

    /// Draws steps; once there are too few, nothing is left for anything else either.
    pub fn spend(&self, steps: u64) -> Result<(), TooLarge> {
        let rest = self.left.get().checked_sub(steps);
        self.left.set(rest.unwrap_or(0));
        rest.map(|_| ()).ok_or(TooLarge)
    }
}

/// A computation was given up: out of steps, or past the largest exponent or number of variables
/// that polynomials are built for. It says nothing about the answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TooLarge;

impl fmt::Display for TooLarge {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("the polynomials involved grow too large")
    }
}

impl std::error::Error for TooLarge {}

/// A length as a number of steps.
pub(super) fn steps(length: usize) -> u64 {
    u64::try_from(length).unwrap_or(u64::MAX)
}

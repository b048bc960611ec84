//! The work limit: a counter that every operation that can explode draws from.
//!
//! One step is about one product of machine words with its bookkeeping: one to some tens of
//! nanoseconds. A computation that would draw more than is left stops before it does the work.

use std::cell::Cell;
use std::fmt;

use crate::Budget;

/// Steps that an operation takes for any operands.
const STEPS_OF_AN_OPERATION: u64 = 32;

/// Steps that are left to spend.
#[derive(Debug)]
pub struct Work {
    left: Cell<u64>,
    whole: Budget,
}

impl Work {
    /// A limit of so many steps.
    pub fn new(steps: u64) -> Self {
        Self::within(steps, &Budget::unlimited())
    }

    /// A limit of so many steps for one problem, which draw from the whole budget too.
    pub fn within(steps: u64, whole: &Budget) -> Self {
        Self { left: Cell::new(steps), whole: whole.clone() }
    }

    /// The steps that remain.
    pub fn left(&self) -> u64 {
        self.left.get()
    }

    /// Draws the work of an operation besides its products from the whole budget alone: memory, and a pass over the
    /// terms of its operands. A problem's own steps bound the multiplications.
    pub fn begin(&self, terms: u64) -> Result<(), TooLarge> {
        if self.whole.take(terms.saturating_add(STEPS_OF_AN_OPERATION)) { Ok(()) } else { Err(TooLarge) }
    }

    /// Draws steps; once there are too few, nothing is left for anything else either.
    pub fn spend(&self, steps: u64) -> Result<(), TooLarge> {
        let rest = self.left.get().checked_sub(steps).filter(|_| self.whole.take(steps));
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
pub fn steps(length: usize) -> u64 {
    u64::try_from(length).unwrap_or(u64::MAX)
}

//! The state of a parse, and what the formula may use.

use std::sync::Arc;

use super::Table;
use super::lexer::{Lexer, Token};

/// Permission for `hat(x)` in a formula.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Estimates {
    /// In the plant and its observer there are no estimates.
    Refused,
    /// In a simulation's control law, definitions, baselines and panels there are.
    Allowed,
}

/// What a formula may use beside names and functions.
#[derive(Clone, Copy, Debug)]
pub struct Permitted<'a> {
    /// Estimates.
    pub estimates: Estimates,
    /// The tables that it may call.
    pub tables: &'a [Arc<Table>],
}

impl From<Estimates> for Permitted<'_> {
    fn from(estimates: Estimates) -> Self {
        Self { estimates, tables: &[] }
    }
}

/// The state of a parse. Its diagnostics are worded in [`complaints`](super::complaints), out of the way of the recursion,
/// whose frames on the stack stay small.
pub(super) struct Parser<'a> {
    pub(super) lexer: Lexer<'a>,
    pub(super) permitted: Permitted<'a>,
    /// The token to be read next, and the one before it.
    pub(super) next: Token,
    pub(super) last: Token,
    /// Calls of `expression` under way.
    pub(super) depth: usize,
}

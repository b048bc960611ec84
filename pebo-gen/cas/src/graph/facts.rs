//! Assumptions on real values: inequalities with zero.

use super::expr::Expr;

/// The comparison of an assumed expression with zero.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Relation {
    /// Greater than zero.
    Positive,
    /// Greater than or equal to zero.
    NonNegative,
    /// Different from zero.
    NonZero,
}

impl Relation {
    /// The relation as a formula writes it.
    pub fn sign(self) -> &'static str {
        match self {
            Self::Positive => "> 0",
            Self::NonNegative => ">= 0",
            Self::NonZero => "!= 0",
        }
    }
}

/// The assumed inequalities.
#[derive(Clone, Debug, Default)]
pub struct Facts {
    entries: Vec<(Expr, Relation)>,
}

impl Facts {
    /// No assumption.
    pub fn new() -> Self {
        Self::default()
    }

    /// Assumes that the expression compares so with zero.
    pub fn assume(&mut self, expr: Expr, relation: Relation) {
        self.entries.push((expr, relation));
    }

    /// The assumptions in the order they were made.
    pub fn iter(&self) -> impl Iterator<Item = (Expr, Relation)> + '_ {
        self.entries.iter().copied()
    }
}

//! A symmetry that was found, as a value and in words.

use pebo_cas::{Arena, Expr, Symbol};

use crate::source::listed;

/// A change of the states that no output shows.
#[derive(Clone, Debug)]
pub struct Symmetry {
    /// The change.
    pub kind: SymmetryKind,
    /// The states that change: each with its speed, or with its other value.
    pub states: Vec<(Symbol, Expr)>,
    /// True if unmeasured signals may have to change with them.
    pub with_signals: bool,
}

/// A kind of changes of the states.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum SymmetryKind {
    /// The states move along a direction.
    Direction,
    /// The states change their signs.
    Signs,
    /// The states change their places.
    Exchange,
}

impl SymmetryKind {
    /// The kind, in a word.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Direction => "direction",
            Self::Signs => "signs",
            Self::Exchange => "exchange",
        }
    }
}

impl Symmetry {
    /// The shortest of several.
    pub(super) fn shortest(arena: &Arena, found: Vec<Self>) -> Option<Self> {
        found.into_iter().min_by_key(|symmetry| symmetry.entries(arena).join(", ").len())
    }

    /// The first two states that are exchanged.
    pub(in crate::search) fn exchanged(&self, arena: &Arena) -> Option<(Symbol, Symbol)> {
        let (state, other) = self.states.first().filter(|_| self.kind == SymmetryKind::Exchange)?;
        Some((*state, arena.as_symbol(*other)?))
    }

    /// The speeds or values of the states that change.
    #[must_use]
    pub fn entries(&self, arena: &Arena) -> Vec<String> {
        self.states.iter().map(|(_, entry)| arena.print(*entry)).collect()
    }

    /// The symmetry in a line.
    #[must_use]
    pub fn sentence(&self, arena: &Arena) -> String {
        let them = if self.states.len() == 1 { "it" } else { "them" };
        let unless = match (self.kind, self.states.len()) {
            (SymmetryKind::Direction, _) => "",
            (SymmetryKind::Signs, 1) => " unless its sign is known",
            (SymmetryKind::Signs, _) => " unless one of the signs is known",
            (SymmetryKind::Exchange, _) => " unless their order is known",
        };
        format!("{}: no observer recovers {them}{unless}: proved", self.same_outputs(arena))
    }

    /// The states with the same outputs.
    #[must_use]
    pub fn same_outputs(&self, arena: &Arena) -> String {
        let names: Vec<String> = self.states.iter().map(|(state, _)| arena.name(*state)).collect();
        let names_listed = listed(names.iter().map(String::as_str));
        let signals = if self.with_signals { ", and unmeasured signals with them" } else { "" };
        let change = match (self.kind, names.len()) {
            (SymmetryKind::Direction, 1) => format!("{names_listed} moves along ({})", self.entries(arena).join(", ")),
            (SymmetryKind::Direction, _) => format!("{names_listed} move along ({})", self.entries(arena).join(", ")),
            (SymmetryKind::Signs, 1) => format!("{names_listed} changes its sign"),
            (SymmetryKind::Signs, _) => format!("{names_listed} change their signs"),
            (SymmetryKind::Exchange, 2) => format!("{names_listed} are exchanged"),
            (SymmetryKind::Exchange, _) => format!("{names_listed} become ({})", self.entries(arena).join(", ")),
        };
        format!("the outputs are the same where {change}{signals}")
    }
}

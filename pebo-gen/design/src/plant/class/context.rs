//! What the expansion of each class reads and gives.

use std::collections::{BTreeMap, BTreeSet};

use crate::model::{self, Model};
use crate::plant::Scope;
use crate::plant::formula::lower;
use crate::plant::parts::{Assumption, Formula, Output, State, confined};
use crate::source::{Code, Diagnostic, Span};
use pebo_cas::tower::Obstacle;
use pebo_cas::{Arena, Domain, Expr, Symbol};

/// The proposals of a class, unproved.
#[derive(Clone, Debug, Default)]
pub struct Proposal {
    /// States in z and y.
    pub phi_left: Vec<(Symbol, Expr)>,
    /// Outputs with their rates as `known + factors * phi`.
    pub rates: BTreeMap<Symbol, (Expr, Vec<Expr>)>,
}

/// The plant of a class, with its matrices.
#[derive(Debug, Default)]
pub(in crate::plant) struct Expansion<C> {
    pub(in crate::plant) x: Vec<State>,
    pub(in crate::plant) y: Vec<Output>,
    pub(in crate::plant) phi: Vec<Formula>,
    pub(in crate::plant) proposal: Proposal,
    pub(in crate::plant) class: C,
    /// The domain conditions of the class on its matrices besides those of their formulas.
    pub(in crate::plant) conditions: Vec<Assumption>,
}

impl<C> Expansion<C> {
    /// The same as one of any class.
    pub(super) fn of_any<D>(self, any: impl FnOnce(C) -> D) -> Expansion<D> {
        let Self { x, y, phi, proposal, class, conditions } = self;
        Expansion { x, y, phi, proposal, class: any(class), conditions }
    }
}

/// The declared names by their roles.
pub(in crate::plant) struct Names<'a> {
    pub(in crate::plant) x: &'a [Symbol],
    pub(in crate::plant) y: &'a [Symbol],
    pub(in crate::plant) u: &'a [Symbol],
    pub(in crate::plant) w: &'a [Symbol],
    pub(in crate::plant) constants: &'a BTreeSet<Symbol>,
}

/// The context in which the formulas of a class are resolved.
#[derive(Clone, Copy)]
pub(in crate::plant) struct ClassContext<'a> {
    pub(in crate::plant) arena: &'a Arena,
    pub(in crate::plant) scope: &'a Scope,
    pub(in crate::plant) model: &'a Model,
    pub(in crate::plant) domain: &'a Domain,
    /// The coordinates of the transform.
    pub(in crate::plant) z: &'a [Symbol],
}

/// The reason for the end of an expansion.
pub(super) enum Stop {
    /// Mistakes that are reported already.
    Reported,
    /// A mistake.
    Mistake(Box<Diagnostic>),
}

impl From<Diagnostic> for Stop {
    fn from(diagnostic: Diagnostic) -> Self {
        Self::Mistake(Box::new(diagnostic))
    }
}

impl ClassContext<'_> {
    /// A formula that may depend on constants and these symbols.
    pub(super) fn formula(
        &self,
        written: &model::Formula,
        allowed: &BTreeSet<Symbol>,
        what: &str,
    ) -> Result<Expr, Diagnostic> {
        let expr = lower(self.arena, self.scope, written)?;
        Ok(confined(self.arena, expr, written.span, allowed, what)?.expr)
    }
}

/// The algebra met an obstacle while it expanded a class.
pub(super) fn unresolved(what: &str, span: Span, obstacle: &Obstacle) -> Diagnostic {
    Diagnostic::error(Code::ClassUnresolved, span, format!("{what} could not be worked out"))
        .note(format!("obstacle: {obstacle}"))
        .help("write its formulas with fewer functions, or give parameters values")
}

/// A matrix has no inverse.
pub(super) fn singular(what: &str, span: Span) -> Diagnostic {
    Diagnostic::error(Code::SingularMatrix, span, format!("{what} has no inverse"))
        .label("its determinant is zero everywhere")
        .help("check that no row is a combination of the others")
}

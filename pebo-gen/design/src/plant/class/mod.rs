//! Plants by class: the matrices that the author wrote, expanded into the ordinary plant.
//!
//! ```text
//! lti | mechanical | electromechanical -> x' = f_x, y' = f_y, z = phi, and a proposal
//! ```
//!
//! Every equation keeps the span of the field that it is made of. The knowledge of the class (a left inverse, the terms
//! of the regression) is a [`Proposal`]: the analysis proves it as it proves anything else.

mod electromechanical;
mod linear;
mod mechanical;
mod shape;

use std::collections::{BTreeMap, BTreeSet};

use crate::model::{self, Model};
use crate::source::{Code, Diagnostic, Diagnostics, Span};
use pebo_cas::tower::Obstacle;
use pebo_cas::{Arena, Domain, Expr, Symbol};

use super::Scope;
use super::formula::lower;
use super::plant::{Assumption, Formula, Output, State};
use super::resolve::confined;

pub use electromechanical::Electromechanical;
pub use linear::Linear;
pub use mechanical::{InVelocities, Mechanical, change_along};

/// The class of a plant, with its matrices.
#[derive(Clone, Debug)]
pub enum Class {
    /// `lti`
    Linear(Linear),
    /// `mechanical`
    Mechanical(Mechanical),
    /// `electromechanical`
    Electromechanical(Electromechanical),
}

impl Class {
    /// The key of a linear plant in a model file.
    pub(crate) const LTI: &str = model::Class::LTI;

    /// The key of a mechanical plant.
    pub(crate) const MECHANICAL: &str = model::Class::MECHANICAL;

    /// The key of the class in a model file.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Linear(_) => model::Class::LTI,
            Self::Mechanical(_) => model::Class::MECHANICAL,
            Self::Electromechanical(_) => model::Class::ELECTROMECHANICAL,
        }
    }
}

/// The proposals of a class, unproved.
#[derive(Clone, Debug, Default)]
pub struct Proposal {
    /// States in z and y.
    pub phi_left: Vec<(Symbol, Expr)>,
    /// Outputs with their rates as `known + factors * phi`.
    pub rates: BTreeMap<Symbol, (Expr, Vec<Expr>)>,
}

/// The plant of a class.
#[derive(Debug, Default)]
pub(super) struct Expansion {
    pub(super) x: Vec<State>,
    pub(super) y: Vec<Output>,
    pub(super) phi: Vec<Formula>,
    pub(super) proposal: Proposal,
    pub(super) class: Option<Class>,
    /// The domain conditions of the class on its matrices besides those of their formulas.
    pub(super) conditions: Vec<Assumption>,
}

/// The number of components of the transform.
pub(super) fn components(model: &Model) -> usize {
    match &model.class {
        None => model.phi.len(),
        // With a transform of the author's there may be more of them than states.
        Some(model::Class::Lti(lti)) => match &lti.t1 {
            Some(t1) if t1.depth == 2 => t1.rows.len(),
            Some(t1) if t1.depth == 1 && model.x.len() == 1 => t1.rows[0].len(),
            _ => model.x.len(),
        },
        Some(model::Class::Mechanical(_)) => model.x.len(),
        Some(model::Class::Electromechanical(class)) => electromechanical::coils(class, model),
    }
}

/// The declared names by their roles.
pub(super) struct Names<'a> {
    pub(super) x: &'a [Symbol],
    pub(super) y: &'a [Symbol],
    pub(super) u: &'a [Symbol],
    pub(super) w: &'a [Symbol],
    pub(super) constants: &'a BTreeSet<Symbol>,
}

/// The context in which the formulas of a class are resolved.
#[derive(Clone, Copy)]
pub(super) struct ClassContext<'a> {
    pub(super) arena: &'a Arena,
    pub(super) scope: &'a Scope,
    pub(super) model: &'a Model,
    pub(super) domain: &'a Domain,
    /// The coordinates of the transform.
    pub(super) z: &'a [Symbol],
}

/// The reason for the end of an expansion.
enum Stop {
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
    /// The plant of a class; nothing if there was a mistake, which is among the problems then.
    pub(super) fn expand(
        &self,
        class: &model::Class,
        names: &Names<'_>,
        problems: &mut Diagnostics,
    ) -> Option<Expansion> {
        let expanded = match class {
            model::Class::Lti(written) => linear::expand(self, written, names, problems),
            model::Class::Mechanical(written) => mechanical::expand(self, written, names, problems),
            model::Class::Electromechanical(written) => electromechanical::expand(self, written, names, problems),
        };
        match expanded {
            Ok(expansion) => Some(expansion),
            Err(Stop::Reported) => None,
            Err(Stop::Mistake(diagnostic)) => {
                problems.push(*diagnostic);
                None
            }
        }
    }

    /// A formula that may depend on constants and these symbols.
    fn formula(&self, written: &model::Formula, allowed: &BTreeSet<Symbol>, what: &str) -> Result<Expr, Diagnostic> {
        let expr = lower(self.arena, self.scope, written)?;
        Ok(confined(self.arena, expr, written.span, allowed, what)?.expr)
    }
}

/// The algebra met an obstacle while it expanded a class.
fn unresolved(what: &str, span: Span, obstacle: &Obstacle) -> Diagnostic {
    Diagnostic::error(Code::ClassUnresolved, span, format!("{what} could not be worked out"))
        .note(format!("obstacle: {obstacle}"))
        .help("write its formulas with fewer functions, or give parameters values")
}

/// A matrix has no inverse.
fn singular(what: &str, span: Span) -> Diagnostic {
    Diagnostic::error(Code::SingularMatrix, span, format!("{what} has no inverse"))
        .label("its determinant is zero everywhere")
        .help("check that no row is a combination of the others")
}

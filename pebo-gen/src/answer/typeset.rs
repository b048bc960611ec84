//! The derivation, typeset: presentation `MathML` that a page shows as it is.

use indexmap::IndexMap;
use serde::Serialize;

use crate::derived::Derived;
use pebo_cas::{Arena, Expr};

/// The functions of an observer as `MathML`, each formula a `math` element; empty if they were not derived.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
#[non_exhaustive]
pub struct TypesetFormulas {
    /// The known part of z', a component each.
    pub h: Vec<String>,
    /// The matrix of a generalised cascade, by rows.
    pub lambda: Vec<Vec<String>>,
    /// The known terms of the regression, by rows.
    pub phi_0: Vec<String>,
    /// The factors of the unknowns, by rows.
    pub phi_1: Vec<Vec<String>>,
    /// The states in z and y.
    pub phi_left: IndexMap<String, String>,
}

impl TypesetFormulas {
    /// The derived formulas, whatever the verdict.
    pub(super) fn of(derived: &Derived) -> Self {
        let (arena, derivation) = (&derived.plant.arena, &derived.derivation);
        let mut typeset = Self::default();
        if let Some(cascade) = &derivation.cascade.result {
            typeset.h = row(arena, &cascade.h);
            typeset.lambda = cascade.lambda.iter().flatten().map(|entries| row(arena, entries)).collect();
        }
        if let Some(regression) = &derivation.regression.result {
            typeset.phi_0 = row(arena, &regression.phi_0);
            typeset.phi_1 = regression.phi_1.iter().map(|entries| row(arena, entries)).collect();
        }
        let states = derivation.left_inverse.result.iter().flat_map(|inverse| &inverse.x);
        typeset.phi_left = states.map(|(state, formula)| (arena.name(*state), arena.mathml(*formula))).collect();
        typeset
    }
}

fn row(arena: &Arena, entries: &[Expr]) -> Vec<String> {
    entries.iter().map(|entry| arena.mathml(*entry)).collect()
}

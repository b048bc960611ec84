//! Plants that are written by their class: a few matrices in place of equations.
//!
//! The types are generic in the entry: a text as read, a [`Formula`] after parsing.

#[cfg(feature = "yaml")]
use serde::Deserialize;

use super::formula::{Decimal, Formula};
use super::spanned::Spanned;
use crate::source::Span;

/// A class with its formulas.
#[derive(Clone, Debug, PartialEq)]
pub enum Class {
    /// A linear, time-invariant plant.
    Lti(Lti<Formula>),
    /// A mechanical plant in Hamiltonian form.
    Mechanical(Mechanical<Formula>),
    /// Coils that move a mass.
    Electromechanical(Electromechanical<Formula>),
}

/// A matrix as written.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "yaml", derive(Deserialize))]
#[cfg_attr(feature = "yaml", serde(deny_unknown_fields))]
pub struct Matrix<F> {
    /// The span.
    pub span: Span,
    /// The depth of its lists: 0 for a single entry, 1 for a plain list, 2 for a list of rows.
    pub depth: usize,
    /// The entries; one row unless the depth is 2, and all rows of one length.
    pub rows: Vec<Vec<F>>,
}

/// `x' = A11 x + A12 y + B1 u`, `y' = A21 x + A22 y + B2 u`; a block that is absent is zero.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "yaml", derive(Deserialize))]
#[cfg_attr(feature = "yaml", serde(rename_all = "UPPERCASE", bound(deserialize = "F: Deserialize<'de>")))]
#[cfg_attr(feature = "yaml", serde(deny_unknown_fields))]
pub struct Lti<F> {
    /// From x to its rate.
    pub a11: Option<Matrix<F>>,
    /// From y to the rate of x.
    pub a12: Option<Matrix<F>>,
    /// From x to the rate of y.
    pub a21: Option<Matrix<F>>,
    /// From y to its rate.
    pub a22: Option<Matrix<F>>,
    /// From the inputs to the rate of x.
    pub b1: Option<Matrix<F>>,
    /// From the inputs to the rate of y.
    pub b2: Option<Matrix<F>>,
    /// The factor of x in the transform `T1 x + T2 y`; derived where it is absent.
    pub t1: Option<Matrix<F>>,
    /// The factor of y in the transform; derived with `t1`.
    pub t2: Option<Matrix<F>>,
}

/// The energy `p' M^-1 p / 2 + V(q)` with forces `G(q) u`, and a frame `T(q)`: the momenta are x, the
/// positions y.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "yaml", derive(Deserialize))]
#[cfg_attr(feature = "yaml", serde(rename_all = "UPPERCASE", bound(deserialize = "F: Deserialize<'de>")))]
#[cfg_attr(feature = "yaml", serde(deny_unknown_fields))]
pub struct Mechanical<F> {
    /// The inertia matrix in the positions.
    pub m: Option<Matrix<F>>,
    /// The potential energy in the positions.
    pub v: Option<F>,
    /// The action of the inputs on the momenta.
    pub g: Option<Matrix<F>>,
    /// The frame: the transform is `T(q)' p`; searched for where it is absent.
    pub t: Option<Matrix<F>>,
}

/// The fluxes `L(q) i + mu(q)` with `d/dt(..) = -R i + B u`: the position is x, the currents are the first
/// outputs y.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "yaml", derive(Deserialize))]
#[cfg_attr(feature = "yaml", serde(bound(deserialize = "F: Deserialize<'de>")))]
#[cfg_attr(feature = "yaml", serde(deny_unknown_fields))]
pub struct Electromechanical<F> {
    /// The number of coils, checked against the rest.
    pub coils: Option<Spanned<Decimal>>,
    /// Inductances in the position.
    #[cfg_attr(feature = "yaml", serde(rename = "L"))]
    pub inductance: Option<Matrix<F>>,
    /// Flux of permanent magnets in the position.
    pub mu: Option<Matrix<F>>,
    /// Resistances.
    #[cfg_attr(feature = "yaml", serde(rename = "R"))]
    pub resistance: Option<Matrix<F>>,
    /// The action of voltages on coils.
    #[cfg_attr(feature = "yaml", serde(rename = "B"))]
    pub voltages: Option<Matrix<F>>,
    /// The declared name of the speed: an output, an input or an unmeasured signal.
    pub speed: Option<Spanned<String>>,
    /// The inertia of the mass.
    pub inertia: Option<F>,
    /// The friction coefficient.
    pub friction: Option<F>,
    /// The constant external force.
    pub load: Option<F>,
}

#[cfg(feature = "yaml")]
impl<F> Matrix<F> {
    /// The matrix of the changed entries.
    fn map<G>(self, change: &mut impl FnMut(F) -> G) -> Matrix<G> {
        let rows = self.rows.into_iter().map(|row| row.into_iter().map(&mut *change).collect()).collect();
        Matrix { span: self.span, depth: self.depth, rows }
    }
}

#[cfg(feature = "yaml")]
impl<F> Lti<F> {
    pub(super) fn map<G>(self, change: &mut impl FnMut(F) -> G) -> Lti<G> {
        let mut matrix = |block: Option<Matrix<F>>| block.map(|block| block.map(change));
        Lti {
            a11: matrix(self.a11),
            a12: matrix(self.a12),
            a21: matrix(self.a21),
            a22: matrix(self.a22),
            b1: matrix(self.b1),
            b2: matrix(self.b2),
            t1: matrix(self.t1),
            t2: matrix(self.t2),
        }
    }
}

#[cfg(feature = "yaml")]
impl<F> Mechanical<F> {
    pub(super) fn map<G>(self, change: &mut impl FnMut(F) -> G) -> Mechanical<G> {
        Mechanical {
            m: self.m.map(|m| m.map(change)),
            v: self.v.map(&mut *change),
            g: self.g.map(|g| g.map(change)),
            t: self.t.map(|t| t.map(change)),
        }
    }
}

#[cfg(feature = "yaml")]
impl<F> Electromechanical<F> {
    pub(super) fn map<G>(self, change: &mut impl FnMut(F) -> G) -> Electromechanical<G> {
        Electromechanical {
            coils: self.coils,
            inductance: self.inductance.map(|m| m.map(change)),
            mu: self.mu.map(|m| m.map(change)),
            resistance: self.resistance.map(|m| m.map(change)),
            voltages: self.voltages.map(|m| m.map(change)),
            speed: self.speed,
            inertia: self.inertia.map(&mut *change),
            friction: self.friction.map(&mut *change),
            load: self.load.map(&mut *change),
        }
    }
}

impl Class {
    /// The key of a linear plant.
    pub const LTI: &str = "lti";

    /// The key of a mechanical plant.
    pub const MECHANICAL: &str = "mechanical";

    /// The key of an electromechanical plant.
    pub const ELECTROMECHANICAL: &str = "electromechanical";

    /// The key of the class.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Lti(_) => Self::LTI,
            Self::Mechanical(_) => Self::MECHANICAL,
            Self::Electromechanical(_) => Self::ELECTROMECHANICAL,
        }
    }

    /// The formulas of the class, for their domain conditions.
    pub fn formulas(&self) -> Vec<&Formula> {
        match self {
            Self::Lti(c) => entries([&c.a11, &c.a12, &c.a21, &c.a22, &c.b1, &c.b2, &c.t1, &c.t2]).collect(),
            Self::Mechanical(c) => entries([&c.m, &c.g, &c.t]).chain(&c.v).collect(),
            Self::Electromechanical(c) => entries([&c.inductance, &c.mu, &c.resistance, &c.voltages])
                .chain(c.inertia.iter().chain(&c.friction).chain(&c.load))
                .collect(),
        }
    }
}

/// The entries of the matrices that are given.
fn entries<const N: usize>(matrices: [&Option<Matrix<Formula>>; N]) -> impl Iterator<Item = &Formula> {
    matrices.into_iter().flatten().flat_map(|matrix| matrix.rows.iter().flatten())
}

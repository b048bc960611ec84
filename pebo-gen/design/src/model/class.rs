//! Plants that are written by their class: a few matrices in place of equations.

use super::formula::Formula;
use super::section::{Number, Text, Value, section};
use crate::source::Span;

/// A class with its formulas.
#[derive(Clone, Debug, PartialEq)]
pub enum Class {
    /// A linear, time-invariant plant.
    Lti(Lti),
    /// A mechanical plant in Hamiltonian form.
    Mechanical(Mechanical),
    /// Coils that move a mass.
    Electromechanical(Electromechanical),
}

/// A matrix as written.
#[derive(Clone, Debug, PartialEq)]
pub struct Matrix {
    /// The span.
    pub span: Span,
    /// The depth of its lists: 0 for a single entry, 1 for a plain list, 2 for a list of rows.
    pub depth: usize,
    /// The entries; one row unless the depth is 2, and all rows of one length.
    pub rows: Vec<Vec<Formula>>,
}

impl Value for Matrix {}

section! {
    /// `x' = A11 x + A12 y + B1 u`, `y' = A21 x + A22 y + B2 u`; a block that is absent is zero. With `T1` and `T2` the
    /// author chooses the transform.
    pub struct Lti {
        a11 as "A11": Option<Matrix>, "A11: [[0, 1], [-1, 0]]", "From x to the rate of x", required();
        a12 as "A12": Option<Matrix>, "A12: [[0], [1]]", "From y to the rate of x; zero if left out";
        a21 as "A21": Option<Matrix>, "A21: [[1, 0]]", "From x to the rate of y", required();
        a22 as "A22": Option<Matrix>, "A22: [[-1]]", "From y to the rate of y; zero if left out";
        b1 as "B1": Option<Matrix>, "B1: [[0], [1]]", "From the inputs to the rate of x; zero if left out";
        b2 as "B2": Option<Matrix>, "B2: [[1]]", "From the inputs to the rate of y; zero if left out";
        t1 as "T1": Option<Matrix>, "T1: [[1, 0], [0, 1]]",
            "The factor of x in the transform T1 x + T2 y; derived if left out";
        t2 as "T2": Option<Matrix>, "T2: [[0], [0]]", "The factor of y in the transform T1 x + T2 y; derived with T1";
    }
}

section! {
    /// The energy `p' M^-1 p / 2 + V(q)` with forces `G(q) u`, and a frame `T(q)`: the momenta are x, the positions y.
    pub struct Mechanical {
        m as "M": Option<Matrix>, "M: [[m, 0], [0, m*r^2]]", "The inertia matrix, a function of the positions",
            required();
        v as "V": Option<Formula>, "V: m*g*r*cos(q)",
            "The potential energy, a function of the positions; zero if left out";
        g as "G": Option<Matrix>, "G: [[1], [0]]",
            "The input matrix, from the inputs to the rates of the momenta; zero if left out";
        t as "T": Option<Matrix>, "T: [[1, 0], [0, 1]]",
            "The frame T(q) of the transform z = T(q)' p; if left out, the transform is searched for";
    }
}

section! {
    /// The fluxes `L(q) i + mu(q)` with `d/dt(..) = -R i + B u`: the position is x, the currents are the first outputs y.
    pub struct Electromechanical {
        coils: Number, "coils: 2", "The number of coils";
        inductance as "L": Option<Matrix>, "L: [[L, 0], [0, L]]", "The inductance matrix, a function of the position",
            required();
        mu: Option<Matrix>, "mu: [lambda_m*cos(q), lambda_m*sin(q)]",
            "The flux of permanent magnets in each coil, a function of the position; zero if left out";
        resistance as "R": Option<Matrix>, "R: [R, R]", "The resistance matrix", required();
        voltages as "B": Option<Matrix>, "B: [[1, 0], [0, 1]]",
            "From the voltages to the coils; the identity if left out";
        speed: Text, "speed: omega", "The declared name of the speed: an output, an input, or a signal of w",
            required();
        inertia: Option<Formula>, "inertia: j", "The inertia of the mass";
        friction: Option<Formula>, "friction: f", "The friction coefficient";
        load: Option<Formula>, "load: m*g", "The constant external force";
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
fn entries<const N: usize>(matrices: [&Option<Matrix>; N]) -> impl Iterator<Item = &Formula> {
    matrices.into_iter().flatten().flat_map(|matrix| matrix.rows.iter().flatten())
}

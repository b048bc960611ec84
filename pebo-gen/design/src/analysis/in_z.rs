//! The claims as equations between functions of z, y and u.
//!
//! In: a cascade, or a regression with its unknowns apart. Out: the rates of z, and the rows of the regression where z
//! stands in place of the extension and the unknowns. They are what is read: under a generalised cascade `Phi_1` repeats
//! each factor of z for each column of Psi.

use std::collections::{BTreeMap, BTreeSet};

use super::design::{Cascade, Regression, RegressionKind};
use crate::plant::Plant;
use pebo_cas::graph::conditions::Regularity;
use pebo_cas::{Arena, Expr, Symbol};

/// A row of the regression in z.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct EquationInZ {
    /// The left side.
    pub left: LeftSide,
    /// The right side.
    pub right: Expr,
}

/// The left side of an equation in z.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum LeftSide {
    /// Zero.
    Zero,
    /// The rate of a measured output.
    Rate(Symbol),
    /// The derivative of a function of z, y and u.
    Derivative(Expr),
}

impl LeftSide {
    /// Its formula, if it is more than a name.
    pub fn formula(self) -> Option<Expr> {
        match self {
            Self::Derivative(primitive) => Some(primitive),
            Self::Zero | Self::Rate(_) => None,
        }
    }
}

impl EquationInZ {
    /// The equation in the model file's grammar, with its formulas as they are printed there.
    pub fn text(&self, arena: &Arena, print: impl Fn(Expr) -> String) -> String {
        let left = match self.left {
            LeftSide::Zero => "0".to_owned(),
            LeftSide::Rate(symbol) => format!("{}'", arena.name(symbol)),
            LeftSide::Derivative(primitive) => format!("d/dt({})", print(primitive)),
        };
        format!("{left} = {}", print(self.right))
    }
}

impl Cascade {
    /// The rates of z: `h`, of the generalised cascade `Lambda z + h`.
    pub fn rates(&self, plant: &Plant) -> Vec<Expr> {
        let arena = &plant.arena;
        let z: Vec<Expr> = plant.z.iter().map(|z| arena.of_symbol(*z)).collect();
        match &self.lambda {
            None => self.h.clone(),
            Some(rows) => rows.iter().zip(&self.h).map(|(row, h)| arena.add(arena.dot(row, &z), *h)).collect(),
        }
    }
}

impl Regression {
    /// The rows in z. None of a local regression, which holds near the extension alone, and where functions of theta have
    /// no value at zero.
    pub fn in_z(&self, plant: &Plant) -> Option<Vec<EquationInZ>> {
        let arena = &plant.arena;
        if self.is_at_estimate() || !arena.domain_conditions(&self.eta, Regularity::Defined).is_empty() {
            return None;
        }
        // With theta = 0 the extension is z.
        let zeros: BTreeMap<Symbol, Expr> = plant.theta.iter().map(|theta| (*theta, arena.zero())).collect();
        let eta = arena.substitute_all(&self.eta, &zeros);
        let z = plant.z.iter().map(|z| arena.of_symbol(*z));
        let at: BTreeMap<Symbol, Expr> = plant.chi.iter().chain(&plant.xi).copied().zip(z.clone().chain(z)).collect();
        let psi: BTreeSet<Symbol> = plant.psi.iter().flatten().copied().collect();
        let side = |known: Expr, factors: &[Expr]| {
            let unknown = arena.dot(factors, &eta);
            let unknown = if self.kind == RegressionKind::Static { arena.neg(unknown) } else { unknown };
            let in_z = arena.substitute(arena.add(known, unknown), &at);
            (!arena.depends_on(in_z, &psi)).then_some(in_z)
        };
        let outputs = self.rows();
        let row = |(row, (known, factors)): (usize, (&Expr, &Vec<Expr>))| {
            let left = match (self.primitive_0.get(row), self.primitive_1.get(row), outputs.get(row)) {
                (Some(known), Some(factors), _) => {
                    let primitive = side(*known, factors)?;
                    match arena.as_symbol(primitive) {
                        _ if arena.is_zero(primitive) => LeftSide::Zero,
                        Some(symbol) => LeftSide::Rate(symbol),
                        None => LeftSide::Derivative(primitive),
                    }
                }
                (.., Some(output)) => LeftSide::Rate(plant.y[*output].symbol),
                _ => LeftSide::Zero,
            };
            Some(EquationInZ { left, right: side(*known, factors)? })
        };
        self.phi_0.iter().zip(&self.phi_1).enumerate().map(row).collect()
    }
}

//! One equation of a regression, before theta is separated from known signals.

use super::premises::Premises;
use crate::plant::{Formula, Output, Plant};
use pebo_cas::Expr;
use pebo_cas::domain::zero::is_zero;

/// `d/dt primitive = rate`, the rate as a function of z, y and u, the primitive of y and perhaps z. Without a primitive
/// it is a relation that holds at every instant.
#[derive(Clone, PartialEq)]
pub(super) struct Equation {
    pub(super) primitive: Expr,
    pub(super) rate: Expr,
    /// Positions of the outputs whose equation it is.
    pub(super) outputs: Vec<usize>,
    /// The factors of z in the primitive and in the rate, where both are affine in z.
    pub(super) factors: Option<[Vec<Expr>; 2]>,
}

impl Equation {
    /// The equation, reduced to affine functions of z where it is made of these.
    pub(super) fn new(premises: &Premises<'_>, primitive: Expr, rate: Expr, outputs: Vec<usize>) -> Self {
        let factors = |expr| premises.row(expr).map(|row| row[1..].to_vec());
        let factors = factors(primitive).and_then(|of_primitive| Some([of_primitive, factors(rate)?]));
        Self { primitive, rate, outputs, factors }
    }

    /// The rate of an output, known as this function of z that is not affine.
    pub(super) fn curved(premises: &Premises<'_>, output: usize, in_z: Expr) -> Self {
        Self { primitive: premises.output(output), rate: in_z, outputs: vec![output], factors: None }
    }

    /// A relation that holds at every instant, of these outputs.
    pub(super) fn instant(premises: &Premises<'_>, rate: Expr, outputs: Vec<usize>) -> Self {
        Self::new(premises, premises.arena().zero(), rate, outputs)
    }

    pub(super) fn is_instant(&self, premises: &Premises<'_>) -> bool {
        premises.arena().is_zero(self.primitive)
    }

    /// Tests whether two equations are one, perhaps with the other sign: counted twice, the sensors would seem better.
    pub(super) fn is_same(&self, other: &Self, premises: &Premises<'_>) -> bool {
        if self.primitive != other.primitive {
            return false;
        }
        if !self.is_instant(premises) || self.rate == other.rate {
            return true;
        }
        let (arena, everywhere) = (premises.arena(), premises.domain.without_equations());
        let is_zero = |expr: Expr| is_zero(arena, expr, &everywhere);
        is_zero(arena.sub(self.rate, other.rate)) || is_zero(arena.add(self.rate, other.rate))
    }

    pub(super) fn is_linear(&self) -> bool {
        self.factors.is_some()
    }

    /// Tests whether it is the rate of one output.
    pub(super) fn is_rate(&self, premises: &Premises<'_>) -> bool {
        matches!(self.outputs.as_slice(), [output] if self.primitive == premises.output(*output))
    }
}

/// Positions of the outputs in a formula.
pub(super) fn outputs_in(plant: &Plant, formula: Expr) -> Vec<usize> {
    let symbols = plant.arena.symbols_of(&[formula]);
    (0..plant.y.len()).filter(|position| symbols.contains(&plant.y[*position].symbol)).collect()
}

/// The outputs whose equation an identity is: the one whose value it gives, or all in it.
pub(super) fn outputs_of(plant: &Plant, identity: &Formula) -> Vec<usize> {
    let is_value = |output: &Output| output.value.is_some_and(|value| value.span == identity.span);
    match plant.y.iter().position(is_value) {
        Some(position) => vec![position],
        None => outputs_in(plant, identity.expr),
    }
}

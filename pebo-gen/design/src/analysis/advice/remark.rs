//! The remarks that a derivation keeps on itself: values, which are made on first use.

use std::cell::OnceCell;

use pebo_cas::domain::cells::Side;
use pebo_cas::{Expr, Symbol};

/// The remarks computed so far.
#[derive(Debug, Default)]
pub struct Remarks {
    pub(super) operating_point: OnceCell<Option<Equilibrium>>,
    pub(super) drift: OnceCell<Option<Drift>>,
    pub(super) rebase: OnceCell<bool>,
}

/// The components of the extension that a constant bias makes run away.
#[derive(Clone, Debug)]
pub struct Drift {
    /// Components whose rate is free of the extension and not provably zero.
    pub integrators: Vec<Symbol>,
    /// Those of them that the known start fixes and no output corrects.
    pub uncorrected: Vec<Symbol>,
    /// The outputs and inputs that they integrate.
    pub integrated: Vec<Symbol>,
}

/// The equilibrium of a plant.
#[derive(Clone, Debug)]
pub enum Equilibrium {
    /// An equilibrium: proved.
    At(OperatingPoint),
    /// No equilibrium, since this state or output always moves: proved.
    Nowhere(Symbol),
    /// Undecided, for this reason.
    Undecided(String),
}

/// Values at which every rate vanishes.
#[derive(Clone, Debug)]
pub struct OperatingPoint {
    /// Determined symbols as functions of the free ones.
    pub values: Vec<(Symbol, Expr)>,
    /// Signs that the free ones have there: in other cells of the domain the values are others, or none.
    pub sides: Vec<(Expr, Side)>,
    /// True if there are no other equilibria: they are these, at all values of the free symbols.
    pub complete: bool,
    /// True if z' vanishes there too: `h`, of the generalised cascade `Lambda z + h`.
    pub still: bool,
    /// The rank of `[f; h_i]` at almost every point, the same for all i; none if undecided. At the operating point it
    /// is 0 if z' vanishes.
    pub rank: Option<usize>,
}

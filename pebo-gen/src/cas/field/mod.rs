//! The normal form: expressions as quotients of polynomials over independent kernels.
//!
//! ```text
//! expressions, facts -> kernels (symbols, sin, cos, exp, log, roots) -> fractions -> expressions
//! ```
//!
//! A kernel is what a polynomial may take as a variable. Angles are first split into an integer basis
//! (so that `sin(2*q + p)` becomes a polynomial in the sines and cosines of q and p), exponents
//! likewise, roots into roots of coprime parts. What relates kernels (`sin^2 = 1 - cos^2`, `r^2 = a`)
//! is reduced away.
//!
//! Holds after: every rewriting is an identity wherever the expression has a value, so a fraction that
//! is zero proves that the expression is zero. The converse needs the kernels to be independent, which
//! is so for rational functions, for sines, cosines and exponentials of arguments that are linearly
//! independent over the rationals (Ax 1971), and for square roots of coprime square-free polynomials;
//! nothing here relies on it for a verdict: what refutes is an enclosure (see [`super::zero`]).

mod angle;
mod branch;
mod convert;
mod exponent;
mod fraction;
mod inverse;
mod kernel;
mod root;
mod show;
mod sign;

use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt;

use rustc_hash::FxHashMap;

use super::arena::Arena;
use super::expr::{Expr, Symbol};
use super::facts::{Facts, Relation};
use super::poly::{Poly, TooLarge, Work};
use super::rational::Rational;

pub use fraction::Fraction;
use kernel::Kernel;

/// Steps of polynomial arithmetic that one field may spend, some seconds' worth.
const STEPS: u64 = 50_000_000;

/// How often the bases of angles and exponents may be refined before the field is given up.
const MOST_ROUNDS: usize = 12;

/// Why a question stays open.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum Obstacle {
    /// The polynomials grow past the work limit.
    TooLarge,
    /// A denominator vanishes identically.
    DivisionByZero,
    /// Two kernels that could not be shown independent, or one that has no rules here.
    Kernel(String),
    /// No point of the assumed domain was found at which the expression has a value.
    NoPoint,
    /// The normal form is not zero, but no point shows it.
    NoWitness,
}

impl fmt::Display for Obstacle {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TooLarge => f.write_str("the expressions grow past the work limit"),
            Self::DivisionByZero => f.write_str("a denominator is zero everywhere"),
            Self::Kernel(what) => write!(f, "no rule decides {what}"),
            Self::NoPoint => f.write_str("no point of the assumed domain was found where the formula has a value"),
            Self::NoWitness => {
                f.write_str("the normal form is not zero, yet no point was found where it provably differs")
            }
        }
    }
}

impl std::error::Error for Obstacle {}

impl From<TooLarge> for Obstacle {
    fn from(_: TooLarge) -> Self {
        Self::TooLarge
    }
}

/// Which argument a basis serves.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
enum Family {
    /// Arguments of sine and cosine.
    Angle,
    /// Arguments of the exponential.
    Exponent,
}

/// The kernels of one question, and the arithmetic over them.
#[derive(Debug)]
pub struct Field<'a> {
    arena: &'a Arena,
    work: Work,
    kernels: RefCell<Vec<Kernel>>,
    numbers: RefCell<FxHashMap<Expr, u32>>,
    known: RefCell<FxHashMap<Expr, Fraction>>,
    /// The step of which all multiples of a basis argument are integer multiples.
    units: RefCell<BTreeMap<(Family, Expr), Rational>>,
    refined: RefCell<bool>,
    signs: RefCell<Vec<(Poly, Relation)>>,
}

impl<'a> Field<'a> {
    /// The field that holds all the roots; afterwards [`Self::fraction`] answers for each of them and
    /// for whatever is built of the same kernels.
    pub fn over(arena: &'a Arena, facts: &Facts, roots: &[Expr]) -> Result<Self, Obstacle> {
        let field = Self {
            arena,
            work: Work::new(STEPS),
            kernels: RefCell::default(),
            numbers: RefCell::default(),
            known: RefCell::default(),
            units: RefCell::default(),
            refined: RefCell::new(false),
            signs: RefCell::default(),
        };
        for _ in 0..MOST_ROUNDS {
            field.restart(facts)?;
            for root in roots {
                field.fraction(*root)?;
            }
            if !*field.refined.borrow() {
                return Ok(field);
            }
        }
        Err(Obstacle::TooLarge)
    }

    /// Forgets the kernels but not the units.
    fn restart(&self, facts: &Facts) -> Result<(), Obstacle> {
        self.kernels.borrow_mut().clear();
        self.numbers.borrow_mut().clear();
        self.known.borrow_mut().clear();
        self.signs.borrow_mut().clear();
        *self.refined.borrow_mut() = false;
        self.learn(facts)
    }

    fn work(&self) -> &Work {
        &self.work
    }

    /// The arena of the expressions.
    pub fn arena(&self) -> &'a Arena {
        self.arena
    }

    /// The numbers of the kernels that depend on one of the symbols.
    pub fn kernels_of(&self, symbols: &BTreeSet<Symbol>) -> BTreeSet<u32> {
        let kernels = self.kernels.borrow();
        (0..).zip(kernels.iter()).filter(|(_, k)| self.arena.depends_on(k.expr, symbols)).map(|(n, _)| n).collect()
    }

    /// What a kernel stands for.
    pub fn kernel(&self, number: u32) -> Expr {
        self.kernels.borrow()[number as usize].expr
    }

    /// A polynomial over the kernels as a fraction.
    pub fn of_polynomial(&self, poly: &Poly) -> Result<Fraction, Obstacle> {
        self.fraction_of(poly, &Poly::one())
    }

    /// The fraction of two polynomials over the kernels.
    pub fn quotient(&self, num: &Poly, den: &Poly) -> Result<Fraction, Obstacle> {
        self.fraction_of(num, den)
    }

    /// The work limit, for polynomial arithmetic on numerators.
    pub fn limit(&self) -> &Work {
        &self.work
    }
}

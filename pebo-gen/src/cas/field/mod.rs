//! The normal form: expressions as quotients of polynomials over independent kernels.
//!
//! ```text
//! expressions, facts -> kernels (symbols, sin, cos, exp, log, roots) -> fractions -> expressions
//! ```
//!
//! A kernel is what a polynomial may take as a variable. Angles are first split into an integer basis
//! (so that `sin(2*q + p)` becomes a polynomial in the sines and cosines of q and p), exponents
//! likewise, roots into roots of coprime parts. What relates kernels (`sin^2 = 1 - cos^2`, `r^2 = a`)
//! is reduced away, and so is what relates symbols on a manifold.
//!
//! Holds after: every rewriting is an identity wherever the expressions have values, up to points in
//! whose neighbourhood they have values too, so a fraction that is zero proves that the expression is
//! zero. The converse needs the kernels to be independent. They are, and the answer is complete, for
//! what is built of
//!
//! - rational functions of symbols,
//! - sines, cosines and exponentials of rational functions, split into arguments that are linearly
//!   independent over the rationals modulo constants (Ax 1971, theorem 3),
//! - logarithms of coprime polynomials (the same theorem, for the inverse functions),
//! - roots of coprime square-free polynomials, and magnitudes of polynomials that have both signs
//!   (Kummer theory; Besicovitch 1940 for roots of primes),
//! - cosines of rational multiples of pi and square roots of rationals (Gauss 1811).
//!
//! It is not known to be for relations among constants (e, pi, sin(1): Schanuel's conjecture), roots of
//! sums of roots that do not denest, and inverse trigonometric functions beyond sums of three. Nothing
//! here relies on independence for a verdict: what refutes is an enclosure (see [`super::zero`]).

mod angle;
mod circle;
mod convert;
mod exponent;
mod fraction;
mod inverse;
mod kernel;
mod known;
mod logarithm;
mod magnitude;
mod manifold;
mod nature;
mod parts;
mod quadratic;
mod range;
mod root;
mod shift;
mod show;
mod sign;
mod span;
mod square;

use std::cell::{Cell, RefCell};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt;

use rustc_hash::FxHashMap;

use super::arena::Arena;
use super::domain::Domain;
use super::expr::{Expr, Symbol};
use super::facts::{Facts, Relation};
use super::manifold::Step;
use super::poly::{Poly, TooLarge, Work};
use super::rational::Rational;

pub use fraction::Fraction;

use angle::Pair;
use inverse::{Known, domain_of};
use kernel::Kernel;
use parts::Parts;
use root::Whole;
use sign::Sign;

/// Steps of polynomial arithmetic that one field may spend, some seconds' worth.
const STEPS: u64 = 50_000_000;

/// How often the bases of angles and exponents may be refined before the field is given up.
const MOST_ROUNDS: usize = 12;

/// Why a question stays open.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum Obstacle {
    /// The polynomials grow past the work limit.
    TooLarge,
    /// The budget of all questions together is used up.
    OutOfBudget,
    /// A denominator vanishes identically.
    DivisionByZero,
    /// Two kernels that could not be shown independent, or one that has no rules here.
    Kernel(String),
    /// No point of the assumed domain was found at which the expression has a value.
    NoPoint,
    /// An equation of the domain that the normal form does not know of.
    Unsolved(String),
    /// The normal form is not zero, but no point shows it.
    NoWitness,
    /// The same, and it has two kernels that were not shown to be independent.
    Related(String, String),
}

impl fmt::Display for Obstacle {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TooLarge => f.write_str("the expressions grow beyond the work limit"),
            Self::OutOfBudget => f.write_str("the limit on time or memory is reached"),
            Self::DivisionByZero => f.write_str("a denominator is zero everywhere"),
            Self::Kernel(what) => write!(f, "no rule decides {what}"),
            Self::NoPoint => f.write_str("no point of the assumed domain was found where the formula has a value"),
            Self::Unsolved(equation) => {
                write!(f, "the identity `{equation}` could not be solved for a symbol without losing solutions")
            }
            Self::NoWitness => f.write_str(
                "the expression does not simplify to zero, but no point was found where it is provably not zero",
            ),
            Self::Related(a, b) => write!(f, "no rule shows whether {a} and {b} are independent"),
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
    /// Radicands.
    Root,
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
    /// What arguments are combinations of, each with the expression it stands for.
    atoms: RefCell<BTreeMap<Family, Vec<(Expr, Fraction)>>>,
    /// The m of `cos(pi/m)`, of which all other multiples of pi are multiples.
    finest: Cell<Option<u32>>,
    /// Inverse functions that are kernels.
    inverses: RefCell<Vec<Known>>,
    /// Arguments of sines and cosines.
    angles: RefCell<Vec<(Fraction, Pair)>>,
    domain: Domain,
    /// Signs of expressions over the box that the facts state.
    boxed: RefCell<FxHashMap<Expr, Option<bool>>>,
    /// Kernels whose signs are being asked for.
    asking: RefCell<BTreeSet<u32>>,
    /// Signs of kernels by what they are, with so many signs known.
    natures: RefCell<FxHashMap<(u32, usize), Option<Sign>>>,
    /// Those of them that were found within another question, which may have kept more from being seen.
    passing: RefCell<Vec<(u32, usize)>>,
    /// How deep the question of a sign is nested.
    depth: Cell<u32>,
    refined: RefCell<bool>,
    parts: RefCell<Parts>,
    wholes: RefCell<Vec<Whole>>,
    /// What is known of signs; empty until the first question of a sign.
    signs: RefCell<Vec<(Poly, Relation)>>,
    asked: Cell<bool>,
    roots: Vec<Expr>,
    /// What symbols are on the manifold.
    steps: BTreeMap<Symbol, Step>,
    /// What must hold for the expressions to have values.
    learned: RefCell<Vec<(Expr, Relation)>>,
    /// Parts of whose unknown signs something was made.
    unsigned: RefCell<BTreeSet<Poly>>,
}

impl<'a> Field<'a> {
    /// The field that holds all the roots; afterwards [`Self::fraction`] answers for each of them and
    /// for whatever is built of the same kernels.
    pub fn over(arena: &'a Arena, facts: &Facts, roots: &[Expr]) -> Result<Self, Obstacle> {
        Self::of(arena, facts, &[], roots)
    }

    /// The field of the roots on the domain's manifold: a symbol for which an equation is solved is what it is there.
    ///
    /// Holds after: every rewriting is an identity where the equations hold. What an equation that was not solved
    /// would make zero is not seen to be zero.
    pub fn on(arena: &'a Arena, domain: &Domain, roots: &[Expr]) -> Result<Self, Obstacle> {
        Self::of(arena, &domain.facts, domain.manifold.steps(), roots)
    }

    fn of(arena: &'a Arena, facts: &Facts, steps: &[Step], roots: &[Expr]) -> Result<Self, Obstacle> {
        let field = Self {
            arena,
            work: Work::within(STEPS, arena.budget()),
            kernels: RefCell::default(),
            numbers: RefCell::default(),
            known: RefCell::default(),
            units: RefCell::default(),
            atoms: RefCell::default(),
            finest: Cell::default(),
            inverses: RefCell::default(),
            angles: RefCell::default(),
            domain: domain_of(facts),
            boxed: RefCell::default(),
            asking: RefCell::default(),
            natures: RefCell::default(),
            passing: RefCell::default(),
            depth: Cell::default(),
            refined: RefCell::new(false),
            parts: RefCell::default(),
            wholes: RefCell::default(),
            signs: RefCell::default(),
            asked: Cell::default(),
            roots: roots.to_vec(),
            steps: steps.iter().map(|step| (step.symbol, step.clone())).collect(),
            learned: RefCell::default(),
            unsigned: RefCell::default(),
        };
        for _ in 0..MOST_ROUNDS {
            if arena.budget().is_exhausted() {
                return Err(Obstacle::OutOfBudget);
            }
            field.restart();
            for root in roots {
                field.fraction(*root)?;
            }
            if !*field.refined.borrow() {
                return Ok(field);
            }
        }
        Err(Obstacle::TooLarge)
    }

    /// Forgets the kernels, but not the units, the parts and what was learned.
    fn restart(&self) {
        self.keep_parts();
        self.kernels.borrow_mut().clear();
        self.numbers.borrow_mut().clear();
        self.known.borrow_mut().clear();
        self.atoms.borrow_mut().clear();
        self.inverses.borrow_mut().clear();
        self.angles.borrow_mut().clear();
        self.wholes.borrow_mut().clear();
        self.signs.borrow_mut().clear();
        self.natures.borrow_mut().clear();
        self.passing.borrow_mut().clear();
        self.unsigned.borrow_mut().clear();
        self.asked.set(false);
        *self.refined.borrow_mut() = false;
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

    /// Why a fraction that is not zero may stand for zero all the same: its last two kernels that are
    /// not symbols, which no rule has shown to be independent.
    pub fn doubt(&self, fraction: &Fraction) -> Obstacle {
        let exprs: BTreeSet<u32> = fraction.numerator().variables().iter().copied().collect();
        let made = |number: &u32| self.arena.as_symbol(self.kernel(*number)).is_none();
        let mut last = exprs.into_iter().rev().filter(made).map(|number| self.arena.print(self.kernel(number)));
        match (last.next(), last.next()) {
            (Some(b), Some(a)) => Obstacle::Related(a, b),
            _ => Obstacle::NoWitness,
        }
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

//! The normal form: expressions as quotients of polynomials over independent kernels.
//!
//! ```text
//! expressions, facts -> kernels (symbols, sin, cos, exp, log, roots) -> fractions -> expressions
//! ```
//!
//! A kernel is a variable of polynomials. Angles are first split into an integer basis (so that `sin(2*q + p)` becomes
//! a polynomial in the sines and cosines of q and p), exponents likewise, roots into roots of coprime parts. Relations
//! among kernels (`sin^2 = 1 - cos^2`, `r^2 = a`) are reduced away, and so are relations among symbols on a manifold.
//!
//! Holds after: every rewriting is an identity wherever the expressions have values, up to points in whose
//! neighbourhood they have values too, so a fraction that is zero proves that the expression is zero. The converse
//! needs the kernels to be independent. They are, and the answer is complete, for
//!
//! - rational functions of symbols,
//! - sines, cosines and exponentials of rational functions, split into arguments that are linearly
//!   independent over the rationals modulo constants (Ax 1971, theorem 3),
//! - logarithms of coprime polynomials (the same theorem, for the inverse functions),
//! - roots of coprime square-free polynomials, and absolute values of polynomials that have both signs
//!   (Kummer theory; Besicovitch 1940 for roots of primes),
//! - cosines of rational multiples of pi and square roots of rationals (Gauss 1811).
//!
//! Independence is not known for relations among constants (e, pi, sin(1): Schanuel's conjecture), roots of sums of
//! roots that do not denest, and inverse trigonometric functions beyond sums of three. No verdict relies on
//! independence: an enclosure refutes (see [`crate::domain::zero`]).

mod arithmetic;
mod convert;
mod coprime;
mod express;
mod fourier;
mod fraction;
mod kernel;
mod obstacle;
mod products;
pub mod residue;
mod sign;
mod sines;
pub mod straight_line;

use std::cell::{Cell, RefCell};
use std::collections::{BTreeMap, BTreeSet};

use rustc_hash::FxHashMap;

use super::poly::{Poly, Work};
use crate::domain::solution::Step;
use crate::graph::arena::Arena;
use crate::graph::expr::{Expr, Symbol};
use crate::{Domain, Facts};

pub use fraction::Fraction;
pub use obstacle::Obstacle;
pub use sign::Signs;

use coprime::CoprimeBase;
use kernel::absolute_angles::absolute_angles;
use kernel::range::{InverseAngle, Pair};
use kernel::units::{Atoms, Family, Units};
use kernel::{AlgebraicRelation, Kernel, Kernels, ProductRoot};
use sign::SignMemory;

/// The greatest number of refinements of the bases of angles and exponents before the field is given up.
const MOST_ROUNDS: usize = 12;

/// The kernels of one problem, and the arithmetic over them.
#[derive(Debug)]
pub struct Field<'a> {
    arena: &'a Arena,
    work: Work,
    /// The assumptions.
    domain: Domain,
    /// The steps that replace symbols on the manifold.
    steps: BTreeMap<Symbol, Step>,
    /// The expressions that the kernels are made for.
    roots: Vec<Expr>,
    /// For each atom the unit whose integer multiples are all of its multiples.
    units: RefCell<Units>,
    /// The m of `cos(pi/m)`, whose multiples are all other multiples of pi.
    finest: Cell<Option<u32>>,
    /// The factors of the arguments of roots, logarithms and absolute values.
    base: RefCell<CoprimeBase>,
    /// The memory of [`Signs`].
    sign_memory: SignMemory,
    round: Round,
}

/// The state that is discarded and made anew if the kernels turn out to be too coarse.
#[derive(Default, Debug)]
struct Round {
    kernels: RefCell<Kernels>,
    /// The normal forms so far.
    fractions: RefCell<FxHashMap<Expr, Fraction>>,
    atoms: RefCell<Atoms>,
    /// Inverse functions that are kernels.
    inverses: RefCell<Vec<InverseAngle>>,
    /// Arguments of sines and cosines.
    angles: RefCell<Vec<(Fraction, Pair)>>,
    /// Roots of products.
    products: RefCell<Vec<ProductRoot>>,
    /// True if a basis became finer that kernels were made of.
    finer: Cell<bool>,
}

impl<'a> Field<'a> {
    /// The field that holds all the roots; afterwards [`Self::fraction`] answers for each of them and for any
    /// expression built of the same kernels. An angle that is a sum of symbols is split into these, so that measured
    /// and unmeasured symbols are separated.
    pub fn over(arena: &'a Arena, facts: &Facts, roots: &[Expr]) -> Result<Self, Obstacle> {
        Self::of(arena, facts, &[], &[], roots)
    }

    /// The field of the roots on the domain's manifold: a symbol for which an equation is solved has its value there.
    ///
    /// Holds after: every rewriting is an identity where the equations hold. Expressions that are zero only by an
    /// unsolved equation are not found to be zero.
    pub fn on(arena: &'a Arena, domain: &Domain, roots: &[Expr]) -> Result<Self, Obstacle> {
        Self::of(arena, &domain.facts, domain.manifold.steps(), &[], roots)
    }

    /// As [`Self::over`], for problems that do not need the symbols of a kernel: long sums of angles may be kernels as
    /// they are.
    pub fn of_long_sums(arena: &'a Arena, facts: &Facts, roots: &[Expr]) -> Result<Self, Obstacle> {
        Self::of(arena, facts, &[], &absolute_angles(arena, roots), roots)
    }

    fn of(
        arena: &'a Arena,
        facts: &Facts,
        steps: &[Step],
        absolute: &[Expr],
        roots: &[Expr],
    ) -> Result<Self, Obstacle> {
        let mut field = Self {
            arena,
            work: Work::within(arena.budget().of_one_problem(), arena.budget()),
            domain: Domain { facts: facts.clone(), ..Domain::default() },
            steps: steps.iter().map(|step| (step.symbol, step.clone())).collect(),
            roots: roots.to_vec(),
            units: RefCell::default(),
            finest: Cell::default(),
            base: RefCell::default(),
            sign_memory: SignMemory::default(),
            round: Round::default(),
        };
        for _ in 0..MOST_ROUNDS {
            if arena.budget().is_exhausted() {
                return Err(Obstacle::OutOfBudget);
            }
            for angle in absolute {
                field.take_for_atom(Family::Angle, *angle)?;
            }
            for root in roots {
                field.fraction(*root)?;
            }
            if !field.round.finer.get() {
                return Ok(field);
            }
            field.keep_base();
            field.round = Round::default();
            field.sign_memory.start_again();
        }
        Err(Obstacle::TooLarge)
    }

    /// The arena of the expressions.
    pub fn arena(&self) -> &'a Arena {
        self.arena
    }

    /// The numbers of the kernels that depend on one of the symbols.
    pub fn kernels_of(&self, symbols: &BTreeSet<Symbol>) -> BTreeSet<u32> {
        let kernels = self.round.kernels.borrow();
        kernels.iter().filter(|(_, k)| self.arena.depends_on(k.expr, symbols)).map(|(n, _)| n).collect()
    }

    /// The number of the kernel of an expression, entered if it is new.
    pub(in crate::tower) fn enter(&self, expr: Expr, relation: Option<AlgebraicRelation>, positive: bool) -> u32 {
        self.round.kernels.borrow_mut().enter(Kernel { expr, relation, positive })
    }

    /// The kernel as a fraction.
    pub(in crate::tower) fn entered(
        &self,
        expr: Expr,
        relation: Option<AlgebraicRelation>,
        positive: bool,
    ) -> Fraction {
        Fraction::polynomial(Poly::variable(self.enter(expr, relation, positive)))
    }

    /// True if a kernel with an algebraic relation occurs.
    pub(crate) fn has_relations(&self, fraction: &Fraction) -> bool {
        let kernels = self.round.kernels.borrow();
        let mut variables = fraction.num.variables().iter().chain(fraction.den.variables());
        variables.any(|variable| kernels[*variable].relation.is_some())
    }

    /// The expressions of all kernels.
    pub fn kernels(&self) -> Vec<Expr> {
        self.round.kernels.borrow().iter().map(|(_, kernel)| kernel.expr).collect()
    }

    /// The expression of a kernel.
    pub fn kernel(&self, number: u32) -> Expr {
        self.round.kernels.borrow()[number].expr
    }

    /// The reason for doubt that a fraction which is not zero stands for a non-zero expression: its last two kernels
    /// that are not symbols, which no rule has proved independent.
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
        self.quotient(poly, &Poly::one())
    }

    /// The work limit, for polynomial arithmetic on numerators.
    pub fn limit(&self) -> &Work {
        &self.work
    }
}

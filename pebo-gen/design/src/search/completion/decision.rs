//! Decides the largest rank of the transforms with a plain cascade, and their number, whatever functions they are made
//! of.
//!
//! ```text
//! plant, values of its parameters -> equations for unknown functions -> completed -> rank, number, relations
//! ```
//!
//! The rate's independence of x, of unmeasured signals and of inputs is a system of linear equations
//! ([`super::gradient`]). Their completion bounds the rank of dphi/dx everywhere but at single points, and where it
//! ends flat the number of transforms is known, even if they have no closed form. The parameters have values that are
//! named with it. Where each state is driven alone by inputs, every smooth transform is affine in x.
//!
//! Holds after: the result is proved by exact algebra, if the kernels of the equations are independent: symbols, and
//! sines, cosines, exponentials, logarithms and roots of rational functions are (see [`pebo_cas::tower`]). The
//! coefficients that are compared belong to functions of other symbols than those of the unknown functions, so that
//! these may be any.

use std::collections::{BTreeMap, BTreeSet};

use pebo_cas::graph::enclosure::Point;
use pebo_cas::linear::{Echelon, Matrix};
use pebo_cas::tower::{Field, Obstacle};
use pebo_cas::{Expr, Function, Node, Symbol};

use super::connection::MOST_DERIVATIVES;
use super::gradient::{EquationRows, GradientEquations};
use super::{Completion, Derivations, Solutions, System};
use crate::search::bounds::{Bound, BoundClass, Evidence};
use crate::search::problem::Problem;

/// The share of the remaining budget for a decision: of functions of y, and of functions of x and y, where equations
/// soon have more terms than series have coefficients.
const SHARES: [u64; 2] = [8, 200];

/// The possible rank of smooth transforms of the class, for values of the parameters that are found after so many
/// others; none where the formulas hold kernels that are not known to be independent, or it takes too long.
pub(in crate::search) fn decided(problem: &Problem<'_>, class: BoundClass, others: usize) -> Option<Bound> {
    if !problem.plant.identities.is_empty() || problem.y.is_empty() {
        return None;
    }
    let arena = problem.arena;
    let formulas: Vec<Expr> = problem.rates.values().copied().collect();
    let mut domain = problem.domain.clone();
    // The first values are the file's own, which decide for the file.
    if others > 0 {
        domain.fixed.clear();
    }
    let mut point: Point = domain.points(arena, &formulas).nth(others)?;
    point.retain(|symbol, _| !problem.signals.contains(symbol));
    let rates: BTreeMap<Symbol, Expr> =
        problem.rates.iter().map(|(symbol, rate)| (*symbol, arena.substitute(*rate, &point))).collect();
    let (equations, share) = match class {
        BoundClass::Affine => (GradientEquations::affine(problem, &rates).ok()?, SHARES[0]),
        BoundClass::Smooth if problem.rates.len().pow(2) > MOST_DERIVATIVES => return None,
        BoundClass::Smooth => (GradientEquations::smooth(problem, &rates), SHARES[1]),
        BoundClass::AffineRate => return None,
    };
    let found = arena.budget().share(share, || RankDecision::of(&equations, problem)).ok()??;
    let relations = found.relations;
    Some(Bound {
        states: problem.x.len(),
        rank: problem.x.len() - relations.len(),
        class,
        proved: true,
        point: point.into_iter().collect(),
        x: problem.x.clone(),
        relations,
        evidence: Evidence::Completion { transforms: found.transforms },
    })
}

/// The consequences of a completion for dphi/dx.
struct RankDecision {
    relations: Vec<Vec<Expr>>,
    transforms: Option<usize>,
}

impl RankDecision {
    fn of(equations: &GradientEquations, problem: &Problem<'_>) -> Result<Option<Self>, Obstacle> {
        let Some(field) = equations.field(problem)? else { return Ok(None) };
        if !are_independent(&field, problem, &equations.moving(problem)) {
            return Ok(None);
        }
        let states = problem.x.len();
        let Some(EquationRows { kept, rows }) = equations.rows(problem, &field)? else { return Ok(None) };
        let by = Derivations::of(&field, &equations.base)?;
        let system = System::new(&by, (states, kept.len()), rows);
        let trivial = system.vanishing();
        let Completion { lift, functions, solutions, .. } = system.completed()?;
        let transforms = match solutions {
            // Without transforms that hold no state.
            Solutions::AsFunctions => {
                let trivial = trivial.completed()?;
                (trivial.solutions == Solutions::AsFunctions).then(|| functions - trivial.functions)
            }
            _ => None,
        };
        let transposed = Matrix::build(functions, lift.len(), |column, row| lift[row][column].clone());
        let (echelon, _) = Echelon::of(&field, transposed, states)?;
        let relations = echelon.null_space().iter().map(|vector| field.show_all(vector)).collect();
        Ok(Some(Self { relations, transforms }))
    }
}

/// Tests whether the kernels are known to be independent, and those of moving symbols hold none of the base.
fn are_independent(field: &Field<'_>, problem: &Problem<'_>, moving: &BTreeSet<Symbol>) -> bool {
    let arena = problem.arena;
    let is_rational = |of: Expr| {
        arena.postorder(&[of]).into_iter().all(|part| match arena.node(part) {
            Node::Call(..) | Node::Pi => false,
            Node::Product(product) => product.factors.iter().all(|(_, exponent)| exponent.is_integer()),
            _ => true,
        })
    };
    let is_known = |kernel: Expr| match arena.node(kernel) {
        Node::Symbol(_) => true,
        Node::Call(Function::Sin | Function::Cos | Function::Exp | Function::Log, arguments) => {
            is_rational(arguments[0])
        }
        Node::Product(product) => product.factors.iter().all(|(base, _)| is_rational(*base)),
        _ => false,
    };
    field.kernels().into_iter().all(|kernel| {
        let signals = arena.symbols_of(&[kernel]);
        let moves = |symbol: &Symbol| problem.signals.contains(symbol);
        let mixed = !signals.is_disjoint(moving) && signals.iter().any(|s| moves(s) && !moving.contains(s));
        is_known(kernel) && !mixed && signals.iter().any(moves)
    })
}

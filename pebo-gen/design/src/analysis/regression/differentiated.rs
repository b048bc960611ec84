//! Relations under the derivative.
//!
//! In: relations between z, y and parameters, of degree two in z with constant coefficients at the squares,
//!
//! ```text
//! a(y) + b(y).z + z'C z = 0
//! ```
//!
//! Out: the equations `d/dt (-(a + b.z)/2) = z'C (Lambda z + h)`. Where the right side is affine in z, as always under
//! a plain cascade, or becomes so by the relation itself (`z'C Lambda z = mu z'C z`), the regression that they make has
//! theta itself for its unknowns, and `theta'C theta`, which the relation itself would add to these, is gone. The
//! motor's fluxes lie on a circle, `|z - L i|^2 = lambda_m^2` (Ortega et al. 2015, eq. 28): `d/dt (L i.z - L^2 |i|^2/2)
//! = z.h`.

use std::collections::BTreeSet;

use super::combined::joined;
use super::equation::{Equation, velocity};
use super::{cleared, relations};
use crate::analysis::design::{Cascade, Claim, LeftInverse, Regression, RegressionKind, Verdict};
use crate::plant::{Plant, RelationForm};
use crate::source::{Code, Diagnostic, Span};
use pebo_cas::domain::zero::point_of;
use pebo_cas::forms::tidy::shortest;
use pebo_cas::number::rational::half;
use pebo_cas::{Domain, Expr, Symbol};

/// The regression under the derivative, in theta itself, where it has fewer unknowns than the given one, or the model
/// chooses it.
pub(in crate::analysis) fn differentiated(
    plant: &Plant,
    domain: &Domain,
    cascade: &Cascade,
    left_inverse: Option<&LeftInverse>,
    given: &Claim<Regression>,
) -> Option<Claim<Regression>> {
    let wanted = plant.wants(RelationForm::Differentiated);
    let longer = |g: &Regression| g.kind == RegressionKind::Static && g.eta.len() > plant.theta.len();
    if !wanted && !proved(given).is_none_or(longer) {
        return None;
    }
    let relations = if !plant.identities.is_empty() {
        cleared::in_z(plant, domain, left_inverse?)
    } else if relations::possible(plant, domain) {
        let relations = relations::among(plant, domain).ok()?;
        relations.into_iter().map(|rate| Equation::relation(plant, rate)).collect()
    } else {
        return None;
    };
    let equations = relations.into_iter().filter_map(|relation| under_derivative(plant, domain, cascade, relation));
    let equations: Vec<Equation> = equations.collect();
    if equations.is_empty() {
        return None;
    }
    joined(plant, domain, cascade, left_inverse, &equations, &mut Vec::new())
        .filter(|claim| proved(claim).is_some_and(|regression| regression.is_linear(plant)))
}

/// Reports that no regression has the chosen form.
pub(in crate::analysis) fn no_such_form(plant: &Plant, (form, span): (RelationForm, Span)) -> Diagnostic {
    let (how, needs, other) = match form {
        RelationForm::Static => (
            "from a relation among the components of phi as it holds at every instant",
            "it needs an output that is given by its value (`g_y`), an identity, or components of phi that outputs and \
             parameters relate",
            "differentiated",
        ),
        RelationForm::Differentiated => (
            "by differentiating a relation among the components of phi",
            "it needs a relation of degree two in the components of phi, with constant coefficients at their products, \
             whose derivative is affine in them",
            "static",
        ),
    };
    let message = format!("no identifiable regression was found {how}");
    let diagnostic = Diagnostic::error(Code::RegressionUndecided, span, message)
        .label(format!("`regression: {}` asks for one", form.name()))
        .note(needs);
    let about = plant.identities.first().map(|identity| (identity.span, "the identity"));
    let about = about.or_else(|| Some((plant.phi.first()?.span, "phi")));
    let diagnostic = about.into_iter().fold(diagnostic, |diagnostic, (span, what)| diagnostic.also(span, what));
    diagnostic.help(format!("leave out `regression`, or write `regression: {other}`"))
}

fn proved(claim: &Claim<Regression>) -> Option<&Regression> {
    claim.result.as_ref().filter(|_| claim.verdict == Verdict::Proved)
}

/// The equation that a relation becomes; none where squares have coefficients that move, or nothing moves at all.
fn under_derivative(plant: &Plant, domain: &Domain, cascade: &Cascade, relation: Equation) -> Option<Equation> {
    let arena = &plant.arena;
    let Equation { rate: relation, outputs, .. } = relation;
    let z: Vec<Expr> = plant.z.iter().map(|s| arena.of_symbol(*s)).collect();
    let constants: BTreeSet<Symbol> = plant.parameters.iter().map(|p| p.symbol).collect();
    let known: BTreeSet<Symbol> =
        constants.iter().chain(&plant.z).copied().chain(plant.y.iter().map(|o| o.symbol)).collect();
    let mut squares = Vec::new();
    let mut rate = Vec::new();
    let mut witness = None;
    for (i, first) in plant.z.iter().enumerate() {
        let slope = arena.derivative(relation, *first);
        for (j, second) in plant.z.iter().enumerate() {
            let curvature = shortest(arena, domain, arena.derivative(slope, *second));
            if !arena.symbols_of(&[curvature]).is_subset(&constants) {
                return None;
            }
            if !arena.is_zero(curvature) {
                witness.get_or_insert((curvature, *first, *second));
            }
            let curvature = arena.scale(curvature, &half());
            squares.push(arena.product([curvature, z[i], z[j]]));
            rate.push(arena.product([curvature, z[j], velocity(plant, cascade, i)]));
        }
    }
    let squares = arena.sum(squares);
    let rest = arena.sub(relation, squares);
    let primitive = shortest(arena, domain, arena.neg(arena.scale(without_constant(plant, domain, rest), &half())));
    let rate = arena.sum(rate);
    // The relation is zero: a multiple of it takes the square away, and with it all others, if they are in proportion.
    let (curvature, first, second) = witness?;
    let multiple = arena.div(arena.derivative(arena.derivative(rate, first), second), curvature);
    let rate = shortest(arena, domain, arena.sub(rate, arena.mul(multiple, relation)));
    let moves = !arena.is_zero(primitive) || !arena.is_zero(rate);
    // The rate of an input is not known.
    (moves && arena.symbols_of(&[primitive]).is_subset(&known)).then_some(Equation { primitive, rate, outputs })
}

/// An expression less its value at z = 0 and y = 0, if it has a value there without an input: a constant has no rate.
fn without_constant(plant: &Plant, domain: &Domain, expr: Expr) -> Expr {
    let arena = &plant.arena;
    let signals = plant.z.iter().copied().chain(plant.y.iter().map(|output| output.symbol));
    let constant = arena.substitute(expr, &signals.map(|signal| (signal, arena.zero())).collect());
    let constants: BTreeSet<Symbol> = plant.parameters.iter().map(|p| p.symbol).collect();
    let is_constant = arena.symbols_of(&[constant]).is_subset(&constants);
    if is_constant && point_of(arena, constant, domain).is_some() { arena.sub(expr, constant) } else { expr }
}

//! Refuses a regression, with the point that shows it.

use std::collections::{BTreeMap, BTreeSet};

use crate::analysis::design::{Claim, Comparison, LeftInverse, Regression, Verdict, Witness};
use crate::analysis::{affine, blame};
use crate::plant::{Formula, Plant};
use crate::source::{Code, Diagnostic, Span, listed};
use pebo_cas::domain::zero::refute;
use pebo_cas::tower::Obstacle;
use pebo_cas::{Domain, Expr, Symbol};

use super::cancelling::moved_freely;

/// Every given rate depends on an unmeasured signal, and so do all combinations but so many, which gave no regression.
pub(super) fn hidden_by_signals(
    plant: &Plant,
    domain: &Domain,
    moved: &[(usize, Expr, Span)],
    combined: usize,
    found: &mut Vec<Diagnostic>,
) -> Claim<Regression> {
    let arena = &plant.arena;
    let outputs: Vec<usize> = moved.iter().map(|row| row.0).collect();
    if combined > 0 || !moved_freely(plant, domain, &outputs, 0) {
        found.push(maybe_hidden(plant, &outputs, moved.first().map_or(Span::point(0), |row| row.2)));
        return Claim { verdict: Verdict::Undecided, result: None };
    }
    let mut verdict = Verdict::Refuted;
    for (index, rate, span) in moved {
        let witness = plant.w.iter().find_map(|w| {
            let slope = arena.derivative(*rate, *w);
            refute(arena, slope, domain).map(|point| (*w, Witness::of(slope, &point)))
        });
        let Some((signal, witness)) = witness else {
            verdict = Verdict::Undecided;
            found.push(undecided(plant, *index, *span, &Obstacle::NoWitness));
            continue;
        };
        let summands = blame::summands(plant, *index, |term| arena.depends_on(term, &BTreeSet::from([signal])));
        let (output, signal) = (arena.name(plant.y[*index].symbol), arena.name(signal));
        found.push(
            Diagnostic::error(
                Code::RegressionNonlinear,
                summands.first().map_or(*span, |summand| summand.span),
                format!("the rate of {output} depends on the unmeasured signal {signal}"),
            )
            .label(format!("{output} gives no information while {signal} is unknown"))
            .note(format!("the derivative of this rate with respect to {signal}: {}", witness.sentence(arena)))
            .help(format!(
                "declare {signal} under `u` if it is measured, give `f_y` for an output whose rate is free of it, or an \
                 identity under `identities`"
            )),
        );
    }
    Claim { verdict, result: None }
}

/// Outputs that unmeasured signals move, perhaps not in all combinations.
fn maybe_hidden(plant: &Plant, outputs: &[usize], span: Span) -> Diagnostic {
    let names: Vec<String> = outputs.iter().map(|index| plant.arena.name(plant.y[*index].symbol)).collect();
    Diagnostic::error(
        Code::RegressionUndecided,
        span,
        "it could not be decided whether the outputs determine the unknowns while unmeasured signals act on them",
    )
    .note(format!(
        "no regression was found among the combinations of {} with constant coefficients that are free of these signals",
        listed(names.iter().map(String::as_str))
    ))
    .help("give `f_y` for an output whose rate is free of the unmeasured signals, or an identity under `identities`")
}

/// A generalised cascade whose outputs may be linear in functions of theta.
pub(super) fn not_tried(plant: &Plant, index: usize, span: Span) -> Diagnostic {
    let output = plant.arena.name(plant.y[index].symbol);
    Diagnostic::error(
        Code::RegressionUndecided,
        span,
        format!("it could not be decided whether the rate of {output} is linear in functions of theta"),
    )
    .label("not an affine function of phi with coefficients in y and u")
    .note("obstacle: for a generalised cascade, z = xi + Psi theta, a regression in functions of theta is not searched for")
    .help("choose a phi whose derivative is free of x, or one in which this rate is affine")
}

/// A rate that is linear in functions of theta from which theta was not found.
pub(super) fn not_recovered(plant: &Plant, index: usize, span: Span, functions: &str) -> Diagnostic {
    let output = plant.arena.name(plant.y[index].symbol);
    Diagnostic::error(
        Code::RegressionUndecided,
        span,
        format!("the rate of {output} is linear in functions of theta, but theta was not recovered from them"),
    )
    .label("not an affine function of phi with coefficients in y and u")
    .note(format!("the functions of theta: {functions}"))
    .help("choose a phi in which this rate is affine, or give an identity under `identities`")
}

/// The reason why a rate is no affine function of the transform, by points of the domain.
///
/// A second derivative, where the transform has as many components as there are states: it is then one-to-one on a
/// neighbourhood of each point of the domain, so that z moves freely there. Else points with the same y, u and
/// parameters at which no affine function takes the rate's values.
pub(super) fn nonlinear(
    plant: &Plant,
    domain: &Domain,
    rate: Expr,
    left_inverse: Option<&LeftInverse>,
) -> Option<String> {
    let arena = &plant.arena;
    if let Some(witness) = left_inverse.and_then(|inverse| curvature(plant, domain, rate, inverse)) {
        return Some(format!(
            "as a function of z, this rate has a second derivative that is not zero: {}",
            witness.sentence(arena)
        ));
    }
    let points = affine::refuted(plant, domain, rate)?;
    let compared = Comparison::of([rate, rate], &points, &plant.hidden());
    Some(format!("no affine function of phi has the values of this rate: {}", compared.sentence(arena, "the rate")))
}

/// A point of the domain at which the rate, as a function of z, has a second derivative.
fn curvature(plant: &Plant, domain: &Domain, rate: Expr, left_inverse: &LeftInverse) -> Option<Witness> {
    let arena = &plant.arena;
    let inverse: BTreeMap<Symbol, Expr> = left_inverse.x.iter().copied().collect();
    let in_z = arena.substitute(rate, &inverse);
    // On a manifold of the states z does not move freely.
    let bound = plant.identities.iter().any(|identity| arena.depends_on(identity.expr, &plant.hidden()));
    if bound || plant.phi.len() != inverse.len() || arena.depends_on(in_z, &plant.hidden()) {
        return None;
    }
    // Back at z = phi(x, y), so that the domain of x is the one that is searched.
    let transform: BTreeMap<Symbol, Expr> = plant.z.iter().copied().zip(plant.transform()).collect();
    for (index, first) in plant.z.iter().enumerate() {
        for second in &plant.z[index..] {
            let curvature = arena.derivative(arena.derivative(in_z, *first), *second);
            let curvature = arena.substitute(curvature, &transform);
            if let Some(point) = refute(arena, curvature, domain) {
                return Some(Witness::of(curvature, &point));
            }
        }
    }
    None
}

pub(super) fn refuted(plant: &Plant, index: usize, summands: &[Formula], point: &str, other_forms: &str) -> Diagnostic {
    let arena = &plant.arena;
    let output = arena.name(plant.y[index].symbol);
    let (first, others) = summands.split_first().map_or((plant.y[index].span, &[][..]), |(f, rest)| (f.span, rest));
    let diagnostic = Diagnostic::error(
        Code::RegressionNonlinear,
        first,
        format!("the rate of {output} is not linear in the unknowns"),
    );
    let diagnostic = others
        .iter()
        .fold(diagnostic, |diagnostic, other| diagnostic.also(other.span, "this term is not affine in phi either"));
    diagnostic.label("not an affine function of phi with coefficients in y and u").note(point).note(other_forms).help(
        "choose a phi in which this rate is affine, leave the output's rate out of `f_y` if others suffice, or give \
           an identity under `identities`",
    )
}

/// A form of a regression that is not affine in z.
#[derive(Clone, Copy)]
pub(super) enum OtherForm {
    /// The rate times an unknown that it is divided by.
    Multiplied,
    /// In a function of this component, which is constant.
    Function(usize),
    /// As a function of z, which is not known without a left inverse.
    Unknown,
}

/// A rate that is not affine in z, but may be linear in the unknowns in another form.
pub(super) fn not_in_other_forms(plant: &Plant, index: usize, span: Span, point: &str, form: OtherForm) -> Diagnostic {
    let arena = &plant.arena;
    let output = arena.name(plant.y[index].symbol);
    let diagnostic = Diagnostic::error(
        Code::RegressionUndecided,
        span,
        format!("it could not be decided whether a regression for the rate of {output} is linear in the unknowns"),
    )
    .label("not an affine function of phi with coefficients in y and u")
    .note(point);
    match form {
        OtherForm::Multiplied => diagnostic
            .note(
                "an unknown divides this rate, and the rate times it is no derivative of what is affine in phi with \
                 polynomials of the outputs for coefficients; other factors were not tried",
            )
            .help("choose a phi in which this rate is affine, or measure another output"),
        OtherForm::Unknown => diagnostic
            .note("without a left inverse this rate is not known as a function of z, which may be linear in functions of theta")
            .help("give the left inverse under `phi_left`, or choose a phi in which this rate is affine"),
        OtherForm::Function(component) => {
            let phi = arena.print(plant.phi[component].expr);
            diagnostic
                .note(format!("`{phi}` is constant, and so is each of its functions"))
                .help(format!("take the functions of `{phi}` that this rate holds as components of phi"))
        }
    }
}

pub(super) fn undecided(plant: &Plant, index: usize, span: Span, obstacle: &Obstacle) -> Diagnostic {
    let output = plant.y.get(index).map_or_else(String::new, |o| format!(" of {}", plant.arena.name(o.symbol)));
    Diagnostic::error(
        Code::RegressionUndecided,
        span,
        format!("it could not be decided whether the rate{output} is linear in the unknowns"),
    )
    .note(format!("obstacle: {obstacle}"))
    .help("simplify the formula, or state signs under `assume`")
}

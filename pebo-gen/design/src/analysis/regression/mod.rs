//! Claim 3, the regression: the unknowns enter linearly.
//!
//! In: the plant and its proved cascade. Out: a dynamic regression y' = `Phi_0` + `Phi_1` theta from the
//! decomposition `f_y = A(y, u) + B(y, u) phi` (which needs no left inverse and finds the linear form
//! where substituting the left inverse would hide it), else one in functions of theta
//! ([`separation`]), else a static one from an identity (Ortega et al. 2015, eqs. 16 and 28).

mod combined;
mod static_relation;

mod cancelling;
mod cleared;
mod differentiated;
mod equation;
mod functions;
mod implicit;
mod linear;
mod outputs;
mod refusal;
mod relations;
mod separation;

use std::collections::{BTreeMap, BTreeSet};

use crate::plant::Plant;
use crate::source::{Diagnostic, Span};
use pebo_cas::tower::{Field, Obstacle};
use pebo_cas::{Domain, Expr, Symbol};

use super::blame;
use super::design::{Cascade, Claim, LeftInverse, Regression, Verdict};
use cancelling::{affine_combinations, combinations};
pub(super) use combined::combined;
use combined::under_derivative;
pub(super) use differentiated::{differentiated, no_such_form};
use functions::over_parameterised;
use linear::{decompose, linear};
pub(super) use outputs::with_all_outputs;
use refusal::{
    OtherForm, hidden_by_signals, nonlinear, not_in_other_forms, not_recovered, not_tried, refuted, undecided,
};
use static_relation::from_relations;
pub(super) use static_relation::{from_affine_identities, from_identities};

const NO_SEPARATION: &str = "the rate is not a sum of known signals times functions of theta either: polynomials, \
    exponentials, sines and cosines of z were tried";

/// A non-smooth rate as it is on the domain: the assumptions on the states decide the side, and are not known of z.
fn on_domain_side(plant: &Plant, domain: &Domain, rate: Expr) -> Expr {
    let arena = &plant.arena;
    if arena.dividers(&[rate]).into_iter().all(|part| !arena.depends_on(part, &plant.hidden())) {
        return rate;
    }
    let field = Field::over(arena, &domain.facts, &[rate]);
    field.and_then(|field| Ok(field.show(&field.fraction(rate)?))).unwrap_or(rate)
}

/// A form in which the unknowns of a rate that is not affine, a function of z, may be linear all the same, if not all
/// such forms were tried on each cell.
fn other_form(plant: &Plant, domain: &Domain, cascade: &Cascade, rate: Expr) -> Option<OtherForm> {
    let arena = &plant.arena;
    let unknown: BTreeSet<Symbol> = plant.z.iter().copied().collect();
    let Ok(cells) = domain.cells(arena, &[rate], |divider| arena.depends_on(divider, &unknown)) else {
        return Some(OtherForm::Unknown);
    };
    cells.iter().find_map(|cell| {
        let branch = cell.domain.analytic(arena, &[rate])[0];
        other_form_on_cell(plant, &cell.domain, cascade, branch)
    })
}

fn other_form_on_cell(plant: &Plant, domain: &Domain, cascade: &Cascade, rate: Expr) -> Option<OtherForm> {
    let arena = &plant.arena;
    let unknown: BTreeSet<Symbol> = plant.z.iter().copied().collect();
    let Ok(below) = implicit::factor(plant, domain, rate) else { return Some(OtherForm::Unknown) };
    if let Some(below) = below.filter(|below| arena.depends_on(*below, &unknown)) {
        let both = [below, arena.mul(below, rate)];
        if !matches!(separation::separate(plant, domain, &both), Ok(None)) {
            return Some(OtherForm::Multiplied);
        }
    }
    // A component without a rate of its own is a constant, and so is each of its functions.
    let is_constant_component = |index: usize| is_constant(plant, cascade, index);
    let nonlinear = |z: Symbol| arena.depends_on(arena.derivative(rate, z), &BTreeSet::from([z]));
    plant
        .z
        .iter()
        .enumerate()
        .find(|(index, z)| is_constant_component(*index) && nonlinear(**z))
        .map(|(index, _)| OtherForm::Function(index))
}

/// Tests whether a component of the transform has no rate.
fn is_constant(plant: &Plant, cascade: &Cascade, index: usize) -> bool {
    cascade.lambda.is_none() && plant.arena.is_zero(cascade.h[index])
}

/// The first component that has none.
fn constant_component(plant: &Plant, cascade: &Cascade) -> Option<usize> {
    (0..cascade.h.len()).find(|index| is_constant(plant, cascade, *index))
}

/// The regression of the rates that are affine in phi, where there are others too; none if no rate is.
pub(super) fn of_affine_rates(
    plant: &Plant,
    domain: &Domain,
    cascade: &Cascade,
    left_inverse: Option<&LeftInverse>,
) -> Option<Claim<Regression>> {
    let rates = plant.y.iter().enumerate().filter_map(|(index, output)| Some((index, output.rate?.expr)));
    let row = |(index, rate)| Some((index, decompose(plant, domain, left_inverse, (index, rate)).ok()??));
    let (outputs, rows): (Vec<usize>, Vec<_>) = rates.filter_map(row).unzip();
    let regression = || linear(plant, domain, cascade, left_inverse, outputs, &rows);
    (!rows.is_empty()).then(|| Claim { verdict: Verdict::Proved, result: Some(regression()) })
}

/// The regression in functions of theta of the rates that are made of such functions, where there are others too; none
/// if no rate is.
pub(super) fn of_separable_rates(
    plant: &Plant,
    domain: &Domain,
    cascade: &Cascade,
    left_inverse: Option<&LeftInverse>,
    found: &mut Vec<Diagnostic>,
) -> Option<Claim<Regression>> {
    let left_inverse = left_inverse.filter(|_| cascade.lambda.is_none())?;
    let unmeasured: BTreeSet<Symbol> = plant.w.iter().copied().collect();
    let rates = plant.y.iter().enumerate().filter_map(|(index, output)| Some((index, output.rate?.expr)));
    let known = rates.filter(|(_, rate)| !plant.arena.depends_on(*rate, &unmeasured));
    let in_z = known.map(|(index, rate)| (index, of_z(plant, domain, left_inverse, rate)));
    let (outputs, rates): (Vec<usize>, Vec<Expr>) = in_z.filter(|(_, rate)| is_separable(plant, domain, *rate)).unzip();
    let separated = separation::separate(plant, domain, &rates).ok()??;
    over_parameterised(
        plant,
        domain,
        left_inverse,
        (outputs.into_iter().map(|output| vec![output]).collect(), 0),
        separated,
        found,
    )
}

/// A rate as a function of z.
fn of_z(plant: &Plant, domain: &Domain, left_inverse: &LeftInverse, rate: Expr) -> Expr {
    let inverse: BTreeMap<Symbol, Expr> = left_inverse.x.iter().copied().collect();
    plant.arena.substitute(on_domain_side(plant, domain, rate), &inverse)
}

/// Tests whether a rate is a sum of known signals times functions of theta.
fn is_separable(plant: &Plant, domain: &Domain, rate: Expr) -> bool {
    matches!(separation::separate(plant, domain, &[rate]), Ok(Some(_)))
}

/// A rate that is not affine: its output, itself, its span, and the obstacle to a decision.
type NonlinearRate = (usize, Expr, Span, Option<Obstacle>);

/// Keeps the rates that are no sums of functions of theta either: the obstacles.
fn formless(plant: &Plant, domain: &Domain, in_z: &BTreeMap<usize, Expr>, nonlinear: &mut Vec<NonlinearRate>) {
    let has_form = |row: &NonlinearRate| in_z.get(&row.0).is_some_and(|rate| is_separable(plant, domain, *rate));
    let others: Vec<NonlinearRate> = nonlinear.iter().filter(|row| !has_form(row)).cloned().collect();
    if !others.is_empty() {
        *nonlinear = others;
    }
}

/// Proves or refutes the regression.
pub(super) fn prove(
    plant: &Plant,
    domain: &Domain,
    cascade: &Cascade,
    left_inverse: Option<&LeftInverse>,
    found: &mut Vec<Diagnostic>,
) -> Claim<Regression> {
    let mut rows: Vec<(usize, Expr, Span)> =
        plant.y.iter().enumerate().filter_map(|(i, o)| o.rate.map(|rate| (i, rate.expr, rate.span))).collect();
    if rows.is_empty() {
        return from_identities(plant, domain, cascade, left_inverse, found);
    }
    let unmeasured: BTreeSet<Symbol> = plant.w.iter().copied().collect();
    let mut affine = Vec::new();
    let mut obstacles = Vec::new();
    let mut moved = Vec::new();
    for (index, rate, span) in &rows {
        match decompose(plant, domain, left_inverse, (*index, *rate)) {
            Ok(Some(row)) => affine.push(row),
            Ok(None) | Err(_) if plant.arena.depends_on(*rate, &unmeasured) => moved.push((*index, *rate, *span)),
            Ok(None) => obstacles.push((*index, *rate, *span, None)),
            Err(obstacle) => obstacles.push((*index, *rate, *span, Some(obstacle))),
        }
    }
    // A rate that an unmeasured signal moves is of no use, unless combinations are free of it; the others have to do.
    rows.retain(|row| !moved.contains(row));
    if rows.is_empty() {
        let outputs: Vec<usize> = moved.iter().map(|row| row.0).collect();
        let combined = combinations(plant, domain, &outputs);
        if !combined.is_empty()
            && let Some(claim) = combined::of_combinations(plant, domain, cascade, left_inverse, &combined, found)
        {
            return claim;
        }
        if plant.identities.is_empty() {
            return from_relations(plant, domain, cascade, left_inverse, found)
                .unwrap_or_else(|| hidden_by_signals(plant, domain, &moved, combined.len(), found));
        }
        return from_identities(plant, domain, cascade, left_inverse, found);
    }
    if obstacles.is_empty() {
        let regression = linear(plant, domain, cascade, left_inverse, rows.iter().map(|r| r.0).collect(), &affine);
        return Claim { verdict: Verdict::Proved, result: Some(regression) };
    }
    // In functions of theta: only where z = chi + theta, the extension being an integrator.
    let mut search = FunctionSearch::default();
    if let Some(left_inverse) = left_inverse {
        let rates: Vec<Expr> = rows.iter().map(|(_, rate, _)| of_z(plant, domain, left_inverse, *rate)).collect();
        search.in_z = rows.iter().map(|row| row.0).zip(rates.iter().copied()).collect();
        match separation::separate(plant, domain, &rates) {
            Ok(Some(_)) if cascade.lambda.is_some() => search.untried = true,
            Ok(Some(separated)) => {
                let eta: Vec<String> = separated.eta.iter().map(|e| plant.arena.print(*e)).collect();
                let outputs = rows.iter().map(|r| vec![r.0]).collect();
                if let Some(claim) = over_parameterised(plant, domain, left_inverse, (outputs, 0), separated, found) {
                    return claim;
                }
                search.unrecovered = Some(eta.join(", "));
            }
            Ok(None) => {
                let of_outputs: Vec<(usize, Expr)> = rows.iter().map(|row| row.0).zip(rates).collect();
                let claim = under_derivative(plant, domain, cascade, left_inverse, &of_outputs, found);
                if let Some(claim) = claim {
                    return claim;
                }
                if cascade.lambda.is_none() {
                    formless(plant, domain, &search.in_z, &mut obstacles);
                }
            }
            Err(obstacle) => obstacles.iter_mut().for_each(|o| o.3 = Some(obstacle.clone())),
        }
    }
    if !plant.identities.is_empty() {
        let claim = from_identities(plant, domain, cascade, left_inverse, &mut Vec::new());
        if claim.verdict == Verdict::Proved {
            return claim;
        }
    }
    // A term that makes one rate nonlinear may cancel from several.
    let outputs: Vec<usize> = rows.iter().map(|row| row.0).collect();
    let (combined, moving) = affine_combinations(plant, domain, &outputs).unwrap_or((Vec::new(), outputs.len() > 1));
    if combined.len() > affine.len()
        && let Some(claim) = combined::of_combinations(plant, domain, cascade, left_inverse, &combined, found)
    {
        return claim;
    }
    // An identity may serve in place of the rates, in a form that was not found, or a combination that was not tried.
    let is_refuted = plant.identities.is_empty() && combined.len() <= affine.len() && !moving;
    let verdict = if is_refuted { Verdict::Refuted } else { Verdict::Undecided };
    refuse(plant, domain, (cascade, left_inverse), &search, obstacles, verdict, found)
}

/// The result of the search for functions of theta.
#[derive(Default)]
struct FunctionSearch {
    /// True if some are used by no regression.
    untried: bool,
    /// Functions from which theta was not recovered.
    unrecovered: Option<String>,
    /// The rates as functions of z.
    in_z: BTreeMap<usize, Expr>,
}

/// Reports the obstacle of each nonlinear rate; the verdict is the firmest that is left.
fn refuse(
    plant: &Plant,
    domain: &Domain,
    (cascade, left_inverse): (&Cascade, Option<&LeftInverse>),
    search: &FunctionSearch,
    obstacles: Vec<NonlinearRate>,
    mut verdict: Verdict,
    found: &mut Vec<Diagnostic>,
) -> Claim<Regression> {
    for (index, rate, span, obstacle) in obstacles {
        if search.untried {
            verdict = Verdict::Undecided;
            found.push(not_tried(plant, index, span));
            continue;
        }
        if let Some(functions) = &search.unrecovered {
            verdict = Verdict::Undecided;
            found.push(not_recovered(plant, index, span, functions));
            continue;
        }
        // A rate that was given up is not refuted: it may be linear in functions of theta all the same.
        let curvature = if obstacle.is_none() { nonlinear(plant, domain, rate, left_inverse) } else { None };
        let form = match left_inverse {
            Some(_) => search.in_z.get(&index).and_then(|rate| other_form(plant, domain, cascade, *rate)),
            // The rate as a function of z is unknown: it may be linear with functions of z as factors or as unknowns.
            None => Some(constant_component(plant, cascade).map_or(OtherForm::Unknown, OtherForm::Function)),
        };
        if let (Some(point), Some(form)) = (&curvature, form) {
            verdict = Verdict::Undecided;
            found.push(not_in_other_forms(plant, index, span, point, form));
        } else if let Some(point) = curvature {
            let is_curved = |term| nonlinear(plant, domain, term, left_inverse).is_some();
            let summands = blame::summands(plant, index, is_curved);
            found.push(refuted(plant, index, &summands, &point, NO_SEPARATION));
        } else {
            verdict = Verdict::Undecided;
            found.push(undecided(plant, index, span, &obstacle.unwrap_or(Obstacle::NoWitness)));
        }
    }
    Claim { verdict, result: None }
}

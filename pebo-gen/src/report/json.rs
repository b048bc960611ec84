//! The JSON object of `check --format json`: one line a model, schema 1.

use indexmap::IndexMap;
use serde::Serialize;

use super::growth::Growth;
use super::remarks::ONE_OF_THEM;
use super::{conditions, expansion, printed};
use pebo_cas::{Arena, Expr, Symbol};
use pebo_design::analysis::{
    BlindTrajectory, Cascade, Claim, Derivation, Determined, Equilibrium, Excitation, Fundamental, Identifiability,
    Outcome, Regression, UnusedOutput, Witness,
};
use pebo_design::plant::{Noisier, Plant, TransformOrigin};
use pebo_design::source::{Diagnostic, LocatedDiagnostic, Source};

/// The object of one model, which [`CHECK_SCHEMA`](super::CHECK_SCHEMA) describes.
#[derive(Clone, Debug, Serialize)]
#[non_exhaustive]
pub struct Report {
    schema: u32,
    /// The model's name, or the stem of its file.
    pub model: String,
    /// The verdict on the model.
    pub verdict: Outcome,
    class: Option<&'static str>,
    /// The plant that a model by class expands to.
    expansion: Option<ExpansionReport>,
    phi: Option<TransformReport>,
    /// The input that is the time in seconds, where the formulas use it without a declaration.
    time: Option<String>,
    cascade: Option<CascadeReport>,
    left_inverse: Option<LeftInverseReport>,
    regression: Option<RegressionReport>,
    identifiability: Option<IdentifiabilityReport>,
    /// The components of the extension that grow without bound under a constant bias.
    drift: Vec<String>,
    operating_point: Option<OperatingPointReport>,
    /// The cost of the observer's functions beside the model's, of an accepted model.
    cost: Option<CostReport>,
    /// Conditions of the proofs besides the assumptions, as comparisons with zero.
    conditions: Vec<String>,
    diagnostics: Vec<LocatedDiagnostic>,
}

#[derive(Clone, Debug, Serialize)]
struct ExpansionReport {
    class: &'static str,
    #[serde(flatten)]
    origin: IndexMap<&'static str, String>,
    rates: IndexMap<String, String>,
    phi: Vec<String>,
    /// Positions with their momenta.
    momentum: IndexMap<String, String>,
    velocity: IndexMap<String, String>,
}

/// Operations of the model's own formulas and of the observer's functions; `times` if the ratio is large, and the
/// function that takes most of them.
#[derive(Clone, Debug, Serialize)]
struct CostReport {
    written: usize,
    derived: usize,
    times: Option<usize>,
    most: &'static str,
}

/// The transform and its origin: the author, a class, or the search.
#[derive(Clone, Debug, Serialize)]
struct TransformReport {
    origin: &'static str,
    z: Vec<String>,
    /// The number of components after the author's own, which are functions of these.
    #[serde(skip_serializing_if = "Option::is_none")]
    lifted: Option<usize>,
    /// The transform to which it was preferred, where that takes the noise of samples or needs conditions.
    #[serde(skip_serializing_if = "Option::is_none")]
    noisier: Option<NoisierReport>,
}

#[derive(Clone, Debug, Serialize)]
struct NoisierReport {
    phi: Vec<String>,
    /// States with the outputs whose samples they take as they are.
    unfiltered: IndexMap<String, Vec<String>>,
    /// What it needs of signals and the plant does not.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    conditions: Vec<String>,
}

#[derive(Clone, Debug, Serialize)]
struct CascadeReport {
    verdict: &'static str,
    h: Vec<String>,
    lambda: Option<Vec<Vec<String>>>,
    residual: Vec<String>,
    witness: Option<WitnessReport>,
    /// Boundedness of the fundamental matrix of a generalised cascade; no part of the verdict.
    bounded: Option<&'static str>,
    /// Beside a generalised cascade, a transform with a plain one.
    mend: Option<Vec<String>>,
    /// Beside a generalised cascade, the right side of the plain one of the same transform, to which it is preferred.
    #[serde(skip_serializing_if = "Option::is_none")]
    plain: Option<Vec<String>>,
}

#[derive(Clone, Debug, Serialize)]
struct LeftInverseReport {
    verdict: &'static str,
    x: IndexMap<String, String>,
    modulo: IndexMap<String, String>,
    origin: Option<&'static str>,
    /// Domain conditions on estimates; a step of the observer that violates one is refused.
    asks: Vec<String>,
    /// Some states are not recovered.
    partial: bool,
    witness: Option<WitnessReport>,
}

#[derive(Clone, Debug, Serialize)]
struct RegressionReport {
    verdict: &'static str,
    kind: Option<&'static str>,
    parameterisation: Option<&'static str>,
    phi_0: Vec<String>,
    phi_1: Vec<Vec<String>>,
    /// The terms under the derivative of an implicit regression.
    primitive_0: Vec<String>,
    primitive_1: Vec<Vec<String>>,
    eta: Vec<String>,
    theta: Vec<String>,
    /// The outputs that have an equation of their own, which the regression leaves out.
    unused: Vec<UnusedReport>,
}

#[derive(Clone, Debug, Serialize)]
struct UnusedReport {
    output: String,
    reason: &'static str,
}

#[derive(Clone, Debug, Serialize)]
struct IdentifiabilityReport {
    verdict: &'static str,
    kind: Option<&'static str>,
    /// The unknowns that the known start fixes, counted from 1.
    by_start: Vec<usize>,
    singular_where: Vec<String>,
    /// Full rank of the regressor is proved everywhere else.
    everywhere_else: bool,
    direction: Option<Vec<String>>,
    /// No input has to move; `None` if that is undecided, or the unknowns are not identifiable.
    by_itself: Option<bool>,
    /// Trajectories on which not all unknowns are identifiable.
    blind: Vec<BlindReport>,
    /// `blind` lists all of those with constant inputs; `None` unless the unknowns are identifiable over time.
    blind_complete: Option<bool>,
    /// `conditions` hold all values of the parameters at which unknowns are never identifiable; likewise.
    parameters_complete: Option<bool>,
    gram: Option<GramReport>,
}

/// A trajectory, the unknowns that are observable on it, and unobservable directions.
#[derive(Clone, Debug, Serialize)]
struct BlindReport {
    #[serde(rename = "while")]
    place: String,
    seen: Vec<String>,
    /// The number of other functions of the unknowns that are observable.
    functions: usize,
    hidden: Vec<Vec<String>>,
    /// What is identified of functions of theta determines theta near almost every value.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    determines_theta: bool,
    /// The unmeasured states that what is identified of phi's components determines near almost every value.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    determines: Vec<String>,
}

/// `Phi_1' Phi_1` and its determinant; `positive` if that is proved on the whole assumed domain.
#[derive(Clone, Debug, Serialize)]
struct GramReport {
    matrix: Vec<Vec<String>>,
    determinant: String,
    positive: bool,
}

/// The equilibrium of the plant under a constant input.
#[derive(Clone, Debug, Serialize)]
struct OperatingPointReport {
    verdict: &'static str,
    /// The determined signals as functions of the free ones.
    values: IndexMap<String, String>,
    /// Signs that free signals have there.
    within: Vec<String>,
    /// z' vanishes there by the cascade: `h`, or `lambda z + h` of the generalised one.
    still: Option<bool>,
    /// The rank of `[f; h_i]` at almost every point, and there: if it falls, Frobenius' theorem gives no transform.
    rank: Option<[usize; 2]>,
    /// The reason for none, or for an open question.
    reason: Option<String>,
}

/// A point where an expression provably is not zero: exact coordinates, outward rounded bounds.
#[derive(Clone, Debug, Serialize)]
struct WitnessReport {
    expression: String,
    point: IndexMap<String, String>,
    bounds: [f64; 2],
    /// The points of the domain that were compared, if more than one was needed.
    compared: Option<ComparisonReport>,
}

/// Points with the same y, u and parameters, and bounds of the expression at each.
#[derive(Clone, Debug, Serialize)]
struct ComparisonReport {
    expression: String,
    points: Vec<IndexMap<String, String>>,
    values: Vec<[f64; 2]>,
}

impl Report {
    /// The object of a model that was read, with its diagnostics.
    pub fn of(plant: &Plant, derivation: &Derivation, diagnostics: &[Diagnostic], source: &Source) -> Self {
        let arena = &plant.arena;
        Self {
            schema: 1,
            model: plant.name.clone(),
            verdict: derivation.outcome,
            class: Some(derivation.class.name()),
            expansion: expansion::of(plant).map(|expansion| ExpansionReport {
                class: expansion.class,
                origin: expansion.origin.into_iter().collect(),
                rates: expansion.rates.into_iter().collect(),
                phi: expansion.phi,
                momentum: expansion.momentum.into_iter().collect(),
                velocity: expansion.velocity.into_iter().collect(),
            }),
            phi: (!plant.phi.is_empty()).then(|| TransformReport {
                origin: plant.origin.word(),
                z: printed(arena, &plant.transform()),
                lifted: match plant.origin {
                    TransformOrigin::Lifted { written } => Some(plant.phi.len() - written),
                    _ => None,
                },
                noisier: plant.noisier.as_ref().map(|found| noisier(arena, found)),
            }),
            time: plant.time.map(|time| arena.name(time)),
            cascade: Some(cascade(arena, &derivation.cascade)),
            left_inverse: Some(left_inverse(plant, derivation)),
            regression: Some(regression(plant, &derivation.regression)),
            identifiability: Some(identifiability(plant, &derivation.identifiability)),
            drift: derivation
                .drift(plant)
                .map(|drift| drift.integrators.iter().map(|s| arena.name(*s)).collect())
                .unwrap_or_default(),
            operating_point: derivation.operating_point(plant).map(|found| operating_point(arena, found)),
            cost: Growth::of(plant, derivation).map(|growth| CostReport {
                written: growth.written,
                derived: growth.derived,
                times: growth.many(),
                most: growth.most,
            }),
            conditions: conditions(arena, &derivation.conditions),
            diagnostics: located(diagnostics, source),
        }
    }

    /// The object of a model without a plant: rejected for the diagnostics, or undecided if one of them says that
    /// something could not be worked out.
    pub fn of_unread(name: &str, diagnostics: &[Diagnostic], source: &Source) -> Self {
        Self {
            schema: 1,
            model: name.to_owned(),
            verdict: Outcome::of_unread(diagnostics),
            class: None,
            expansion: None,
            phi: None,
            time: None,
            cascade: None,
            left_inverse: None,
            regression: None,
            identifiability: None,
            drift: Vec::new(),
            operating_point: None,
            cost: None,
            conditions: Vec::new(),
            diagnostics: located(diagnostics, source),
        }
    }

    /// The object as a line of `check --format json`, without the line's end.
    pub fn line(&self) -> String {
        // Strings, numbers and maps with string keys always serialise.
        serde_json::to_string(self).unwrap_or_default()
    }
}

fn located(diagnostics: &[Diagnostic], source: &Source) -> Vec<LocatedDiagnostic> {
    diagnostics.iter().map(|d| LocatedDiagnostic::new(d, source)).collect()
}

fn matrix(arena: &Arena, rows: &[Vec<Expr>]) -> Vec<Vec<String>> {
    rows.iter().map(|row| printed(arena, row)).collect()
}

fn witness(arena: &Arena, witness: &Witness) -> WitnessReport {
    let coordinates = |point: &[(Symbol, Expr)]| point.iter().map(|(s, v)| (arena.name(*s), arena.print(*v))).collect();
    WitnessReport {
        expression: arena.print(witness.expr),
        point: coordinates(&witness.point),
        bounds: [witness.bounds.0, witness.bounds.1],
        compared: witness.compared.as_ref().map(|compared| ComparisonReport {
            expression: arena.print(compared.expr),
            points: compared.points.iter().map(|point| coordinates(point)).collect(),
            values: compared.values.iter().map(|(low, high)| [*low, *high]).collect(),
        }),
    }
}

fn noisier(arena: &Arena, found: &Noisier) -> NoisierReport {
    let mut unfiltered: IndexMap<String, Vec<String>> = IndexMap::new();
    for (state, output) in &found.unfiltered {
        unfiltered.entry(arena.name(*state)).or_default().push(arena.name(*output));
    }
    NoisierReport { phi: printed(arena, &found.phi), unfiltered, conditions: conditions(arena, &found.conditions) }
}

fn cascade(arena: &Arena, claim: &Claim<Cascade>) -> CascadeReport {
    let result = claim.result.as_ref();
    CascadeReport {
        verdict: claim.verdict.word(),
        h: result.map(|r| printed(arena, &r.h)).unwrap_or_default(),
        lambda: result.and_then(|r| r.lambda.as_ref()).map(|l| matrix(arena, l)),
        residual: result.map(|r| printed(arena, &r.residual)).unwrap_or_default(),
        witness: result.and_then(|r| r.witness.as_ref()).map(|w| witness(arena, w)),
        bounded: result.and_then(|r| r.fundamental).map(Fundamental::word),
        mend: result.and_then(|r| r.mend.as_ref()).map(|mend| printed(arena, mend)),
        plain: result.and_then(|r| r.plain.as_ref()).map(|plain| printed(arena, plain)),
    }
}

fn left_inverse(plant: &Plant, derivation: &Derivation) -> LeftInverseReport {
    let (arena, claim) = (&plant.arena, &derivation.left_inverse);
    let result = claim.result.as_ref();
    LeftInverseReport {
        verdict: claim.verdict.word(),
        x: result.map(|r| r.x.iter().map(|(s, e)| (arena.name(*s), arena.print(*e))).collect()).unwrap_or_default(),
        modulo: result
            .map(|r| r.modulo.iter().map(|(s, e)| (arena.name(*s), arena.print(*e))).collect())
            .unwrap_or_default(),
        origin: result.map(|r| r.origin.word()),
        asks: conditions(arena, &derivation.conditions_on_estimates(plant)),
        partial: result.is_some_and(|r| r.x.len() < plant.x.len()),
        witness: result.and_then(|r| r.witness.as_ref()).map(|w| witness(arena, w)),
    }
}

fn regression(plant: &Plant, claim: &Claim<Regression>) -> RegressionReport {
    let arena = &plant.arena;
    let result = claim.result.as_ref();
    let unused = |unused: &UnusedOutput| UnusedReport {
        output: arena.name(plant.y[unused.output].symbol),
        reason: unused.reason.words(),
    };
    RegressionReport {
        verdict: claim.verdict.word(),
        kind: result.map(|r| r.kind.word()),
        parameterisation: result.map(|r| r.parameterisation(plant)),
        phi_0: result.map(|r| printed(arena, &r.phi_0)).unwrap_or_default(),
        phi_1: result.map(|r| matrix(arena, &r.phi_1)).unwrap_or_default(),
        primitive_0: result.map(|r| printed(arena, &r.primitive_0)).unwrap_or_default(),
        primitive_1: result.map(|r| matrix(arena, &r.primitive_1)).unwrap_or_default(),
        eta: result.map(|r| printed(arena, &r.eta)).unwrap_or_default(),
        theta: result.map(|r| printed(arena, &r.theta)).unwrap_or_default(),
        unused: result.iter().flat_map(|r| &r.unused).map(unused).collect(),
    }
}

fn blind(plant: &Plant, blind: &BlindTrajectory) -> BlindReport {
    let (seen, of_states) = blind.combinations(plant);
    BlindReport {
        place: blind.condition(plant),
        seen: printed(&plant.arena, &seen),
        functions: of_states.len(),
        hidden: matrix(&plant.arena, &blind.hidden),
        determines_theta: blind.determined == Determined::Theta,
        determines: match &blind.determined {
            Determined::States(states) => states.iter().map(|state| plant.arena.name(*state)).collect(),
            Determined::Nothing | Determined::Theta => Vec::new(),
        },
    }
}

fn identifiability(plant: &Plant, claim: &Claim<Identifiability>) -> IdentifiabilityReport {
    let arena = &plant.arena;
    let result = claim.result.as_ref();
    let trajectories = result.and_then(|result| result.trajectories.as_ref());
    IdentifiabilityReport {
        verdict: claim.verdict.word(),
        kind: result.map(|r| r.kind.word()),
        by_start: result.map(|r| r.by_start.iter().map(|position| position + 1).collect()).unwrap_or_default(),
        singular_where: result.map(|r| r.singular_where.clone()).unwrap_or_default(),
        everywhere_else: result.is_some_and(|r| r.everywhere_else),
        direction: result.and_then(|r| r.direction.as_ref()).map(|d| printed(arena, d)),
        by_itself: result.and_then(|r| match r.kind {
            Excitation::Instant => Some(true),
            Excitation::Excitation => trajectories.and_then(|trajectories| trajectories.by_itself),
            Excitation::Never => None,
        }),
        blind: trajectories
            .map(|trajectories| trajectories.blind.iter().map(|blind| self::blind(plant, blind)).collect())
            .unwrap_or_default(),
        blind_complete: trajectories.map(|trajectories| trajectories.everywhere),
        parameters_complete: trajectories.map(|trajectories| trajectories.parameters),
        gram: result.and_then(|r| r.gram.as_ref()).map(|gram| GramReport {
            matrix: matrix(arena, &gram.matrix),
            determinant: arena.print(gram.determinant),
            positive: gram.positive.is_some(),
        }),
    }
}

fn operating_point(arena: &Arena, equilibrium: &Equilibrium) -> OperatingPointReport {
    let verdict = equilibrium.verdict().word();
    let without = |reason| OperatingPointReport {
        verdict,
        values: IndexMap::new(),
        within: Vec::new(),
        still: None,
        rank: None,
        reason: Some(reason),
    };
    match equilibrium {
        Equilibrium::At(point) => OperatingPointReport {
            verdict,
            values: point.values.iter().map(|(s, e)| (arena.name(*s), arena.print(*e))).collect(),
            within: point.sides.iter().map(|(e, side)| format!("{} {}", arena.print(*e), side.sign())).collect(),
            still: Some(point.still),
            rank: point.rank.filter(|_| point.still).map(|rank| [rank, 0]),
            reason: (!point.complete).then(|| ONE_OF_THEM.to_owned()),
        },
        Equilibrium::Nowhere(symbol) => without(format!("`{}` never rests", arena.name(*symbol))),
        Equilibrium::Undecided(reason) => without(reason.clone()),
    }
}

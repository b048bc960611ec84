//! Reports that identifiability is undecided.

use crate::analysis::design::{Claim, Identifiability, Verdict};
use crate::analysis::left_inverse::checking::at_phi;
use crate::plant::Plant;
use crate::source::{Code, Diagnostic};
use pebo_cas::Expr;
use pebo_cas::tower::Obstacle;

/// A domain of several components, on one of which a plant may remain.
pub(super) fn falls_apart(plant: &Plant, equation: Expr) -> Diagnostic {
    let zero = plant.arena.print(equation);
    Diagnostic::error(
        Code::IdentifiabilityUndecided,
        plant.identities.first().map_or_else(|| at_phi(plant), |identity| identity.span),
        "the identities hold on several components of the domain, and a rank at a point of one says nothing of the others",
    )
    .label(format!("`{zero} = 0` holds in several ways"))
    .help("write the factor that is zero under `identities`, or exclude the others under `assume`")
}

/// The claim that an obstacle leaves open.
pub(super) fn open(plant: &Plant, obstacle: &Obstacle, found: &mut Vec<Diagnostic>) -> Claim<Identifiability> {
    let lacks_values = plant.parameters.iter().any(|parameter| parameter.value.is_none());
    let values = if lacks_values { "give the parameters values, or " } else { "" };
    found.push(
        Diagnostic::error(
            Code::IdentifiabilityUndecided,
            at_phi(plant),
            "it could not be decided whether the unknowns can be identified",
        )
        .note(format!("obstacle: {obstacle}"))
        .help(format!("{values}state signs under `assume`")),
    );
    Claim { verdict: Verdict::Undecided, result: None }
}

/// The regression leaves unknowns unseen, but there are equations that it could not use: `used` has the outputs of each
/// of its own.
pub(in crate::analysis) fn not_all_used(plant: &Plant, used: &[Vec<usize>]) -> Diagnostic {
    let is_left_out = |output: &usize| !used.iter().any(|own| own.contains(output));
    let names = (0..plant.y.len()).filter(is_left_out).map(|output| plant.arena.name(plant.y[output].symbol));
    let mut left_out: Vec<String> = names.map(|name| format!("`{name}`")).collect();
    if left_out.is_empty() {
        left_out.push("identities of the plant".to_owned());
    }
    let left_out = left_out.join(", ");
    Diagnostic::error(
        Code::IdentifiabilityUndecided,
        at_phi(plant),
        "it could not be decided whether the unknowns can be identified",
    )
    .note(format!("this regression does not identify all unknowns, but it leaves {left_out} unused"))
    .help("measure another output, or write what relates phi to the outputs under `identities`")
}

//! Notes on a claim beside its formulas, a sentence each: the same in text and on a page.

use std::collections::BTreeSet;

use pebo_cas::{Arena, Symbol};
use pebo_design::analysis::{
    Derivation, Excitation, Gram, Identifiability, Outcome, Positive, Regression, RegressionKind, Trajectories,
    UnusedOutput, Verdict,
};
use pebo_design::plant::{Noisier, Plant, RelationForm, TransformOrigin};
use pebo_design::source::{Code, Diagnostic, counted, listed};

/// The meaning of the model's verdict.
pub(crate) fn meaning(derivation: &Derivation) -> &'static str {
    let is_without = |found: &Diagnostic| found.code == Code::TransformNotFound;
    match derivation.outcome {
        Outcome::Rejected if derivation.diagnostics.first().is_some_and(is_without) => {
            "no observer recovers all of its states"
        }
        Outcome::Accepted if derivation.conditions.is_empty() => "all four claims are proved",
        Outcome::Accepted => "all four claims are proved where the conditions below hold",
        Outcome::Rejected => "a claim is refuted",
        Outcome::Undecided => "a claim could not be decided",
    }
}

/// Notes on a transform that was found, or lifted: the one to which it was preferred, and the functions in it.
pub(crate) fn transform(plant: &Plant) -> Vec<String> {
    let arena = &plant.arena;
    if let TransformOrigin::Lifted { written } = plant.origin {
        let (first, last) = (written + 1, plant.phi.len());
        let added = match last - written {
            1 => format!("z{first} is a function"),
            2 => format!("z{first} and z{last} are functions"),
            _ => format!("z{first} to z{last} are functions"),
        };
        return vec![format!(
            "{added} of the components as they are written: in these alone the outputs are not affine, in all they are"
        )];
    }
    let note = |noisier: &Noisier| {
        let phi: Vec<String> = noisier.phi.iter().map(|component| arena.print(*component)).collect();
        let (states, outputs): (BTreeSet<Symbol>, BTreeSet<Symbol>) = noisier.unfiltered.iter().copied().unzip();
        let conditions = super::conditions(arena, &noisier.conditions);
        let needed =
            (!conditions.is_empty()).then(|| format!("which needs {}", listed(conditions.iter().map(String::as_str))));
        let noisy = (!states.is_empty()).then(|| {
            let (states, outputs) = (names(arena, states), names(arena, outputs));
            format!("in which each sample of {outputs} enters {states} with all of its noise")
        });
        let reasons: Vec<String> = noisy.into_iter().chain(needed).collect();
        let (phi, reasons) = (phi.join(", "), reasons.join(", and "));
        format!("preferred to `phi: [{phi}]`, {reasons}; write that `phi` to have it")
    };
    plant.noisier.iter().map(note).collect()
}

fn names(arena: &Arena, symbols: impl IntoIterator<Item = Symbol>) -> String {
    let names: Vec<String> = symbols.into_iter().map(|symbol| arena.name(symbol)).collect();
    listed(names.iter().map(String::as_str))
}

/// The plain cascade to which a generalised one is preferred.
pub(crate) fn cascade(plant: &Plant, derivation: &Derivation) -> Option<String> {
    let cascade = derivation.cascade.result.as_ref()?;
    let arena = &plant.arena;
    let plain = cascade.plain.iter().flatten().zip(&plant.z);
    let moving = plain.filter(|(rate, _)| !arena.is_zero(**rate));
    let rates: Vec<String> = moving.map(|(rate, z)| format!("{}' = {}", arena.name(*z), arena.print(*rate))).collect();
    let outputs = names(arena, cascade.unfiltered(plant));
    (!rates.is_empty()).then(|| {
        format!(
            "preferred to the plain cascade {}, which each sample of {outputs} enters with all of its noise; write \
             `class: pebo` to have it",
            listed(rates.iter().map(String::as_str))
        )
    })
}

/// Notes on the left inverse: the states that it does not recover, and its domain conditions on estimates.
pub(crate) fn left_inverse(plant: &Plant, derivation: &Derivation) -> Vec<String> {
    let Some(inverse) = &derivation.left_inverse.result else { return Vec::new() };
    let arena = &plant.arena;
    let mut lines = Vec::new();
    let missing: Vec<String> = plant
        .x
        .iter()
        .filter(|s| inverse.x.iter().all(|(symbol, _)| *symbol != s.symbol))
        .map(|s| arena.name(s.symbol))
        .collect();
    if !missing.is_empty() && derivation.left_inverse.verdict == Verdict::Proved {
        lines
            .push(format!("a partial observer, which does not recover {}", listed(missing.iter().map(String::as_str))));
    }
    let asked = super::conditions(arena, &derivation.conditions_on_estimates(plant));
    if !asked.is_empty() {
        let asked = listed(asked.iter().map(String::as_str));
        lines.push(format!("needs estimates with {asked}: `step` refuses a sample whose estimate is not finite"));
    }
    lines
}

/// Notes on the regression: the meaning of more unknowns than theta has, its other form, and outputs without use.
pub(crate) fn regression(plant: &Plant, regression: &Regression) -> Vec<String> {
    let (unknowns, components) = (regression.eta.len(), plant.theta.len());
    let more = (unknowns > components).then(|| {
        format!(
            "eta has {unknowns} components and theta has {components}: a gradient or DREM needs all of eta excited, least \
             squares keep it a function of theta"
        )
    });
    let other = regression.alternative.map(|other| match other.form {
        RelationForm::Static => format!(
            "a relation among the components of phi, under the derivative; as it stands it is a regression in {}, \
             with `regression: static`",
            counted(other.unknowns, "unknown")
        ),
        RelationForm::Differentiated => {
            let unknowns = counted(other.unknowns, "unknown");
            format!("under the derivative it is a regression in {unknowns}, with `regression: differentiated`")
        }
    });
    let left_out = |unused: &UnusedOutput| {
        format!("`{}` is left out: {}", plant.arena.name(plant.y[unused.output].symbol), unused.reason.words())
    };
    let meaning = regression.meaning().map(str::to_owned);
    meaning.into_iter().chain(more).chain(other).chain(regression.unused.iter().map(left_out)).collect()
}

/// Notes on identifiability: its proof, its exceptions, and the signals that have to move.
pub(crate) fn identifiability(plant: &Plant, derivation: &Derivation) -> Vec<String> {
    let Some(result) = &derivation.identifiability.result else { return Vec::new() };
    let implicit = derivation.regression.result.as_ref().is_some_and(|r| r.kind == RegressionKind::Implicit);
    let regressor = match (implicit, result.by_start.is_empty()) {
        (false, true) => "Phi_1",
        (false, false) => "the rest of Phi_1",
        (true, true) => "Phi_1 - d/dt P_1",
        (true, false) => "the rest of Phi_1 - d/dt P_1",
    };
    let mut lines = by_start(plant, derivation, result).into_iter().collect::<Vec<String>>();
    lines.push(match result.kind {
        Excitation::Instant
            if derivation.regression.result.as_ref().is_some_and(|r| r.eta.len() == result.by_start.len()) =>
        {
            return lines;
        }
        Excitation::Instant => format!("{}: {regressor} has full column rank", result.kind.word()),
        Excitation::Excitation if result.trajectories.as_ref().is_some_and(Trajectories::is_divided) => {
            format!("over time: {regressor} has full column rank over the cells of the domain combined")
        }
        Excitation::Excitation => format!("over time: {regressor} and its derivatives have full column rank"),
        Excitation::Never => {
            format!("{}: the outputs do not depend on one direction of the unknowns", result.kind.word())
        }
    });
    if !result.singular_where.is_empty() {
        let places = listed(result.singular_where.iter().map(String::as_str));
        lines.push(format!("except where {places}: there one instant does not identify all unknowns"));
    }
    if result.kind == Excitation::Instant && !result.everywhere_else {
        lines.push("this holds at almost every point; the points where the rank drops were not all found".to_owned());
    }
    lines.extend(result.trajectories.iter().flat_map(|trajectories| trajectories.lines(plant)));
    lines
}

/// The note on unknowns that the known start fixes.
pub(crate) fn by_start(plant: &Plant, derivation: &Derivation, result: &Identifiability) -> Option<String> {
    let eta = &derivation.regression.result.as_ref()?.eta;
    let fixed: Vec<String> = result.by_start.iter().map(|position| plant.arena.print(eta[*position])).collect();
    (!fixed.is_empty()).then(|| {
        format!(
            "by the known start, where the extension is phi, {} = 0: no output corrects it later",
            fixed.join(" = ")
        )
    })
}

/// The note that the determinant of `Phi_1' Phi_1` is positive, with its proof.
pub(crate) fn positive(derivation: &Derivation, gram: &Gram) -> Option<&'static str> {
    gram.positive.map(|positive| match positive {
        Positive::Assumed if derivation.conditions.is_empty() => {
            "the determinant is positive wherever the assumptions hold: every input excites"
        }
        Positive::Assumed => {
            "the determinant is positive wherever the assumptions and conditions hold: every input excites"
        }
        Positive::Divided => {
            "the determinant is positive throughout the assumed box at the given parameter values: every input excites"
        }
    })
}

//! The verdict as text for people.

use super::notes;
use pebo_cas::{Arena, Expr, Symbol};
use pebo_design::analysis::{Claim, Class, Derivation, Gram, Outcome, Regression, RegressionKind, Verdict};
use pebo_design::plant::{Plant, TransformOrigin};

/// As wide as the columns of names and verdicts: two spaces, 16, one, and nine.
const INDENT: &str = "                            ";

/// A few lines: the verdict on the model, then each claim with its formulas.
pub fn summary(plant: &Plant, derivation: &Derivation) -> String {
    let conditions = match derivation.outcome {
        Outcome::Accepted => super::conditions(&plant.arena, &derivation.conditions),
        Outcome::Rejected | Outcome::Undecided => Vec::new(),
    };
    let meaning = notes::meaning(derivation);
    let mut text = format!("{}: {}: {meaning}\n", plant.name, derivation.outcome.word());
    expansion(&mut text, plant);
    if matches!(plant.origin, TransformOrigin::Found | TransformOrigin::Lifted { .. }) {
        let components = plant.transform().into_iter().enumerate();
        let mut lines: Vec<String> =
            components.map(|(i, e)| format!("z{} = {}", i + 1, plant.arena.print(e))).collect();
        lines.extend(notes::transform(plant));
        block(&mut text, "phi", plant.origin.word(), &lines);
    }
    claim(&mut text, "cascade", &derivation.cascade, |_| cascade(plant, derivation));
    claim(&mut text, "left inverse", &derivation.left_inverse, |_| left_inverse(plant, derivation));
    claim(&mut text, "regression", &derivation.regression, |r| regression(plant, derivation.class, r));
    claim(&mut text, "identifiability", &derivation.identifiability, |r| {
        let mut lines = notes::identifiability(plant, derivation);
        lines.extend(r.gram.iter().flat_map(|gram| excitation(plant, derivation, gram)));
        lines
    });
    if !conditions.is_empty() {
        block(&mut text, "conditions", "", &conditions);
    }
    // A remark is no claim and has no verdict.
    for remark in super::remarks::of(plant, derivation) {
        let value =
            |(symbol, value): &(Symbol, Expr)| format!("{} = {}", plant.arena.name(*symbol), plant.arena.print(*value));
        let lines: Vec<String> = remark.values.iter().map(value).chain(remark.lines).collect();
        block(&mut text, remark.name, "", &lines);
    }
    text
}

/// The longest matrix that is printed in one line; JSON has the others.
const MOST_CHARACTERS: usize = 300;

/// `Phi_1' Phi_1` with its determinant.
fn excitation(plant: &Plant, derivation: &Derivation, gram: &Gram) -> Vec<String> {
    let arena = &plant.arena;
    let mut lines = Vec::new();
    let row = |row: &Vec<Expr>| format!("[{}]", row.iter().map(|e| arena.print(*e)).collect::<Vec<_>>().join(", "));
    let rows = gram.matrix.iter().map(row).collect::<Vec<_>>().join(", ");
    let determinant = arena.print(gram.determinant);
    if rows.len() <= MOST_CHARACTERS {
        lines.push(format!("Phi_1^T Phi_1 = [{rows}], with the transpose Phi_1^T"));
    }
    lines.push(format!("det(Phi_1^T Phi_1) = {determinant}"));
    lines.extend(notes::positive(derivation, gram).map(str::to_owned));
    lines
}

/// The plant that a class expands to.
fn expansion(text: &mut String, plant: &Plant) {
    let Some(expansion) = super::expansion::of(plant) else { return };
    let mut lines: Vec<String> = expansion.origin.iter().map(|(name, formula)| format!("{name} = {formula}")).collect();
    lines.extend(expansion.rates.iter().map(|(name, rate)| format!("{name}' = {rate}")));
    lines.extend(expansion.phi.iter().enumerate().map(|(i, phi)| format!("z{} = {phi}", i + 1)));
    lines.extend(expansion.momentum.iter().map(|(name, state)| format!("momentum of {name}: {state}")));
    lines.extend(expansion.velocity.iter().map(|(name, formula)| format!("velocity of {name}: {formula}")));
    let line = format!("  {:<26}{}", expansion.class, lines.join(&format!("\n{INDENT}")));
    text.extend([line.trim_end(), "\n"]);
}

/// A name, a verdict, and lines beside them.
fn block(text: &mut String, name: &str, verdict: &str, lines: &[String]) {
    let line = format!("  {name:<16} {verdict:<9}{}", lines.join(&format!("\n{INDENT}")));
    text.extend([line.trim_end(), "\n"]);
}

fn claim<T>(text: &mut String, name: &str, claim: &Claim<T>, lines: impl Fn(&T) -> Vec<String>) {
    let shown = match (&claim.result, claim.verdict) {
        (Some(result), Verdict::Proved | Verdict::Refuted) => lines(result),
        _ => Vec::new(),
    };
    block(text, name, claim.verdict.word(), &shown);
}

fn cascade(plant: &Plant, derivation: &Derivation) -> Vec<String> {
    let Some(cascade) = &derivation.cascade.result else { return Vec::new() };
    let arena = &plant.arena;
    if derivation.cascade.verdict == Verdict::Refuted {
        let kept = cascade.residual.iter().enumerate().filter(|(_, e)| !arena.is_zero(**e));
        return kept.map(|(i, e)| format!("z{}' keeps the term {}", i + 1, arena.print(*e))).collect();
    }
    // A row of Lambda with its many zeros is read more easily as the rate that it makes.
    let rates = cascade.rates(plant).into_iter().enumerate();
    let mut lines: Vec<String> = rates.map(|(i, rate)| format!("z{}' = {}", i + 1, arena.print(rate))).collect();
    if derivation.class == Class::Gpebo {
        lines.insert(0, "generalised: z' = Lambda z + h, with z = xi + Psi theta".to_owned());
    }
    lines.extend(notes::cascade(plant, derivation));
    lines
}

fn left_inverse(plant: &Plant, derivation: &Derivation) -> Vec<String> {
    let Some(inverse) = &derivation.left_inverse.result else { return Vec::new() };
    let arena = &plant.arena;
    let origin = inverse.origin.word();
    let mut lines: Vec<String> = inverse
        .x
        .iter()
        .map(|(state, formula)| {
            let period = inverse.modulo.iter().find(|(s, _)| s == state);
            let modulo = period.map(|(_, p)| format!(" modulo {}", arena.print(*p))).unwrap_or_default();
            let unit = plant.units.get(state).map(|unit| format!(", in {unit}")).unwrap_or_default();
            format!("{} = {}{modulo} ({origin}{unit})", arena.name(*state), arena.print(*formula))
        })
        .collect();
    lines.extend(notes::left_inverse(plant, derivation));
    lines
}

/// The rows with their unknowns apart. Under a generalised cascade in z, where `Phi_1` would repeat each factor of z for
/// each column of Psi.
fn regression(plant: &Plant, class: Class, regression: &Regression) -> Vec<String> {
    let arena = &plant.arena;
    let in_z = (class == Class::Gpebo).then(|| regression.in_z(plant)).flatten();
    let mut lines = match in_z {
        Some(equations) => equations.iter().map(|equation| equation.text(arena, |e| arena.print(e))).collect(),
        None => with_unknowns_apart(plant, regression),
    };
    lines.extend(notes::regression(plant, regression));
    lines
}

fn with_unknowns_apart(plant: &Plant, regression: &Regression) -> Vec<String> {
    let arena = &plant.arena;
    let linear = regression.is_linear(plant);
    let unknowns = if linear { &plant.theta } else { &regression.eta_symbols };
    let unknown = |index: usize| -> String { arena.name(unknowns[index]) };
    let mut lines = Vec::new();
    let is_plain = |known: Expr, factors: &[Expr]| {
        arena.as_symbol(known).is_some() && factors.iter().all(|factor| arena.is_zero(*factor))
    };
    for (index, (known, factors)) in regression.phi_0.iter().zip(&regression.phi_1).enumerate() {
        lines.push(match regression.kind {
            RegressionKind::Static => {
                format!("{} = {}", arena.print(*known), affine(arena, arena.zero(), factors, &unknown))
            }
            RegressionKind::Dynamic | RegressionKind::Implicit => {
                let output = match regression.primitive_0.get(index) {
                    None => format!("{}'", arena.name(plant.y[regression.rows()[index]].symbol)),
                    // A relation between z, y and u: nothing is under a derivative.
                    Some(known) if regression.primitive_1[index].iter().chain([known]).all(|e| arena.is_zero(*e)) => {
                        "0".to_owned()
                    }
                    Some(known) if is_plain(*known, &regression.primitive_1[index]) => {
                        format!("{}'", arena.print(*known))
                    }
                    Some(known) => format!("d/dt({})", affine(arena, *known, &regression.primitive_1[index], &unknown)),
                };
                format!("{output} = {}", affine(arena, *known, factors, &unknown))
            }
        });
    }
    if !linear {
        for (index, eta) in regression.eta.iter().enumerate() {
            lines.push(format!("{} = {}", unknown(index), arena.print(*eta)));
        }
    }
    lines
}

/// `known + [factor]*unknown + ..`, without zero terms.
fn affine(arena: &Arena, known: Expr, factors: &[Expr], unknown: &impl Fn(usize) -> String) -> String {
    let factors = factors.iter().enumerate().filter(|(_, factor)| !arena.is_zero(**factor));
    let mut terms: Vec<String> =
        factors.map(|(column, factor)| format!("[{}]*{}", arena.print(*factor), unknown(column))).collect();
    if terms.is_empty() || !arena.is_zero(known) {
        terms.insert(0, arena.print(known));
    }
    terms.join(" + ")
}

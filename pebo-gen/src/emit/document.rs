//! What the emitted module says about itself, in the author's names.
//!
//! In: plant, derivation and programs. Out: lines of documentation. No date, no path: the same model
//! gives the same text.

use super::definition::{Argument, Definitions, VELOCITY};
use super::module::Module;
use crate::analysis::{Class, Derivation, Excitation, Fundamental, Origin, RegressionKind};
use crate::cas::facts::Relation;
use crate::cas::{Arena, Expr, Symbol};
use crate::plant::Plant;
use crate::program::{Cost, Staged};

/// The documentation of the module.
pub(super) fn module(module: &Module<'_>) -> Vec<String> {
    let &Module { plant, derivation, definitions, staged, scalar, rebase, .. } = module;
    let mut lines = Vec::new();
    let title = plant.title.as_deref().unwrap_or(&plant.name);
    lines.push(sentence(title));
    if let Some(reference) = &plant.reference {
        lines.extend([String::new(), format!("Source: {}", sentence(reference))]);
    }
    lines.extend([
        String::new(),
        format!(
            "Written by pebo-gen {} from the model `{}`, for `{}`.",
            env!("CARGO_PKG_VERSION"),
            plant.name,
            scalar.name()
        ),
        "Edit the model, not this file, and generate again.".to_owned(),
    ]);
    lines.extend(equations(plant));
    lines.extend(observer(plant, definitions));
    lines.extend(fundamental(derivation));
    lines.extend(drift(plant, derivation, rebase));
    lines.extend(proofs(plant, derivation, definitions));
    lines.extend(costs(definitions, staged));
    lines
}

fn equations(plant: &Plant) -> Vec<String> {
    let arena = &plant.arena;
    let mut lines = section("Plant");
    let mut vectors = vec![
        format!("unmeasured {}", listed(arena, plant.x.iter().map(|state| state.symbol))),
        format!("measured {}", listed(arena, plant.y.iter().map(|output| output.symbol))),
    ];
    if !plant.u.is_empty() {
        vectors.push(format!("input {}", listed(arena, plant.u.iter().copied())));
    }
    if !plant.w.is_empty() {
        vectors.push(format!("unknown {}", listed(arena, plant.w.iter().copied())));
    }
    lines.push(capitalised(&format!("{}.", vectors.join("; "))));
    let states = plant.x.iter().map(|state| (state.symbol, Some(state.rate.expr)));
    let outputs = plant.y.iter().map(|o| (o.symbol, o.rate.as_ref().map(|rate| rate.expr)));
    let rates = states
        .chain(outputs)
        .filter_map(|(symbol, rate)| Some(format!("{}' = {}", arena.name(symbol), arena.print(rate?))));
    let values = plant
        .y
        .iter()
        .filter_map(|output| Some(format!("{} = {}", arena.name(output.symbol), arena.print(output.value?.expr))));
    lines.extend(text(rates.chain(values).collect()));
    lines
}

fn observer(plant: &Plant, definitions: &Definitions) -> Vec<String> {
    let arena = &plant.arena;
    let mut lines = section("Observer");
    let linear = definitions.regression.theta.iter().copied().eq(definitions
        .regression
        .eta_symbols
        .iter()
        .map(|&eta| arena.of_symbol(eta)));
    let unknown = if linear { "theta" } else { "eta" };
    lines.push("The transform `z = phi(x, y)`:".to_owned());
    let mut formulas: Vec<String> = Vec::new();
    for (z, phi) in plant.z.iter().zip(&plant.phi) {
        formulas.push(format!("{} = {}", arena.name(*z), arena.print(phi.expr)));
    }
    lines.extend(text(formulas));
    lines.extend([
        String::new(),
        match definitions.class {
            Class::Pebo => "The unknown constant `theta` is what the extension misses of `z`:".to_owned(),
            Class::Gpebo => "The unknown constant `theta` is the start of what the extension misses of `z`:".to_owned(),
        },
    ]);
    let mut laws = match definitions.class {
        Class::Pebo => vec!["chi' = h(y, u)".to_owned(), "z = chi + theta".to_owned()],
        Class::Gpebo => vec![
            "xi' = lambda(y, u) xi + h(y, u)".to_owned(),
            "Psi' = lambda(y, u) Psi, Psi(0) = I".to_owned(),
            "z = xi + Psi theta".to_owned(),
        ],
    };
    laws.push(match definitions.regression.kind {
        RegressionKind::Static => format!("phi_0 = phi_1 {unknown}"),
        RegressionKind::Implicit if definitions.functions.iter().any(|function| function.name == "primitive_1") => {
            format!("d/dt (primitive_0 + primitive_1 {unknown}) = phi_0 + phi_1 {unknown}")
        }
        RegressionKind::Implicit => format!("d/dt primitive_0 = phi_0 + phi_1 {unknown}"),
        RegressionKind::Dynamic => {
            let rows = definitions.regression.rows.iter();
            let outputs = rows.filter_map(|&row| Some(plant.y.get(row)?.symbol));
            format!("{}' = phi_0 + phi_1 {unknown}", vector(arena, outputs))
        }
    });
    laws.push("x = phi_left(z, y)".to_owned());
    if !linear {
        for (eta, value) in definitions.regression.eta_symbols.iter().zip(&definitions.regression.eta) {
            laws.push(format!("{} = {}", arena.name(*eta), arena.print(*value)));
        }
    }
    lines.extend(text(laws));
    lines.extend([String::new(), "with".to_owned()]);
    let mut blocks = Vec::new();
    for definition in &definitions.functions {
        match definition.name {
            "primitive_0" if definitions.regression.kind == RegressionKind::Dynamic => {}
            "theta" if linear => {}
            "theta" => blocks.extend(named(arena, &plant.theta, &definition.rows)),
            "phi_left" => {
                let states: Vec<Symbol> = definitions.left_inverse.x.iter().map(|state| state.0).collect();
                blocks.extend(named(arena, &states, &definition.rows));
            }
            name => blocks.extend(bracketed(arena, name, &definition.rows)),
        }
    }
    lines.extend(text(blocks));
    lines
}

/// What becomes of the fundamental matrix, and what there is against it.
fn fundamental(derivation: &Derivation) -> Vec<String> {
    let fate = match derivation.cascade.result.as_ref().and_then(|cascade| cascade.fundamental) {
        None => return Vec::new(),
        Some(Fundamental::Bounded { fades: false }) => return vec![String::new(), "`Psi` stays bounded.".to_owned()],
        Some(Fundamental::Bounded { fades: true }) => {
            "`Psi` stays bounded, but dies out in part: what the model misses later stays uncorrected there."
        }
        Some(Fundamental::Grows) => "`Psi` grows without bound, and with it every error of `theta`.",
        Some(Fundamental::NotShown) => "It was not shown that `Psi` stays bounded: errors of `theta` may grow with it.",
    };
    let restart = "`Observer::restart` at the estimate of `z`, with `theta` zero, makes it the identity again.";
    vec![String::new(), fate.to_owned(), restart.to_owned()]
}

/// What the extension does under a constant bias, and what there is against it.
fn drift(plant: &Plant, derivation: &Derivation, rebase: bool) -> Vec<String> {
    let Some(drift) = derivation.drift(plant) else { return Vec::new() };
    let remedy = match (derivation.class, rebase) {
        (Class::Pebo, true) => "`Observer::step_without_drift` keeps the extension bounded",
        (Class::Gpebo, true) => "`Observer::rebase` moves what has grown into `theta`",
        (_, false) => "start the observer anew before the extension loses its digits",
    };
    let integrators = listed(&plant.arena, drift.integrators.iter().copied());
    vec![String::new(), format!("A constant bias makes {integrators} grow: {remedy}.")]
}

fn proofs(plant: &Plant, derivation: &Derivation, definitions: &Definitions) -> Vec<String> {
    let arena = &plant.arena;
    let mut lines = section("Proved");
    lines.push(match definitions.class {
        Class::Pebo => "- Cascade: the derivative of `z` along the plant is `h(y, u)`.".to_owned(),
        Class::Gpebo => "- Generalised cascade: the derivative of `z` along the plant is `lambda z + h`.".to_owned(),
    });
    let origin = match definitions.left_inverse.origin {
        Origin::Given => "as the model gives it",
        Origin::Derived => "derived",
    };
    let mut inverse = format!("- Left inverse, {origin}: `phi_left(phi(x, y), y) = x`");
    for (state, period) in &definitions.left_inverse.modulo {
        inverse += &[", `", &arena.name(*state), "` modulo `", &arena.print(*period), "`"].concat();
    }
    if definitions.left_inverse.x.len() < plant.x.len() {
        inverse.push_str(", for a part of the states");
    }
    lines.push(format!("{inverse}."));
    let asked = derivation.asked_of_estimates(plant);
    if !asked.is_empty() {
        let asked: Vec<String> = asked.iter().map(|(e, relation)| compared(arena, *e, *relation)).collect();
        lines.push(format!(
            "  It asks of estimates that {}: a step without a finite estimate is refused with `Fault::Estimate`.",
            asked.join(", ")
        ));
    }
    let kind = match definitions.regression.kind {
        RegressionKind::Dynamic => "dynamic",
        RegressionKind::Static => "static",
        RegressionKind::Implicit => "implicit",
    };
    let parameterisation = if definitions.regression.eta == theta(plant) {
        "linear in `theta`".to_owned()
    } else {
        format!("over-parameterised, {} unknowns", definitions.regression.eta.len())
    };
    lines.push(format!("- Regression: {kind}, {parameterisation}."));
    if let Some(identifiability) = &derivation.identifiability.result {
        let mut line = match identifiability.kind {
            Excitation::Instant if identifiability.everywhere_else => {
                "- Identifiability: every input excites".to_owned()
            }
            Excitation::Instant => "- Identifiability: almost every input excites".to_owned(),
            Excitation::Excitation => {
                let lines = identifiability.motion.iter().flat_map(|motion| motion.lines(plant));
                format!("- Identifiability: over time, {}", lines.collect::<Vec<String>>().join("; "))
            }
            Excitation::Never => "- Identifiability: none".to_owned(),
        };
        if !identifiability.singular_where.is_empty() {
            let conditions: Vec<String> =
                identifiability.singular_where.iter().map(|condition| format!("`{condition}`")).collect();
            line += ", except where ";
            line += &conditions.join(" or ");
        }
        lines.push(format!("{line}."));
    }
    let assumed: Vec<String> = plant.assumptions.iter().map(|a| compared(arena, a.expr, a.relation)).collect();
    if !assumed.is_empty() {
        lines.extend([String::new(), format!("Assumed: {}.", assumed.join(", "))]);
    }
    let conditions: Vec<String> =
        derivation.conditions.iter().map(|(e, relation)| compared(arena, *e, *relation)).collect();
    if !conditions.is_empty() {
        lines.extend([String::new(), format!("For the formulas to have values: {}.", conditions.join(", "))]);
    }
    if !plant.parameters.is_empty() {
        lines.extend([
            String::new(),
            "The proofs hold for all values of the parameters that keep the signs of the model's: `Parameters::check` tells.".to_owned(),
        ]);
    }
    lines
}

/// A comparison with zero, as code.
fn compared(arena: &Arena, expr: Expr, relation: Relation) -> String {
    format!("`{} {}`", arena.print(expr), relation.sign())
}

fn costs(definitions: &Definitions, staged: &Staged) -> Vec<String> {
    let mut lines = section("Cost");
    lines.extend(["| function | operations |", "|---|---|"].map(str::to_owned));
    lines.push(format!("| `new`, once | {} |", Cost::of(&staged.setup)));
    for (definition, program) in definitions.functions.iter().zip(&staged.programs) {
        lines.push(format!("| `{}` | {} |", definition.name, Cost::of(program)));
    }
    lines
}

fn theta(plant: &Plant) -> Vec<Expr> {
    plant.theta.iter().map(|&theta| plant.arena.of_symbol(theta)).collect()
}

/// What a size of the module counts.
pub(super) fn size(plant: &Plant, definitions: &Definitions, name: &str) -> String {
    let arena = &plant.arena;
    match name {
        "NX" => {
            let states = definitions.left_inverse.x.iter().map(|state| state.0);
            format!("Entries of `x`, the recovered states: {}.", listed(arena, states))
        }
        "NY" => {
            let outputs = definitions.symbols(Argument::Y).into_iter();
            format!("Entries of `y`, the outputs: {}.", listed(arena, outputs))
        }
        "NU" => {
            let inputs = definitions.symbols(Argument::U).into_iter();
            format!("Entries of `u`, the inputs: {}.", listed(arena, inputs))
        }
        "NZ" => "Coordinates of the transform.".to_owned(),
        "NR" => "Equations of the regression.".to_owned(),
        _ => "Unknowns of the regression.".to_owned(),
    }
}

/// What a function returns, in a line.
pub(super) fn function(name: &str, kind: RegressionKind) -> &'static str {
    match name {
        "h" => "`h` of the cascade.",
        "lambda" => "`lambda` of the cascade, by columns.",
        "phi_0" => "What is known in the regression.",
        "phi_1" => "The factors of the unknowns, by columns: one for each unknown.",
        "primitive_0" if kind == RegressionKind::Implicit => "What is known under the derivative of the regression.",
        "primitive_0" => "The outputs whose rates the regression gives.",
        "primitive_1" => "The factors of the unknowns under the derivative, by columns.",
        "theta" => "`theta` from the unknowns of the regression.",
        VELOCITY => {
            "The rates of the outputs, `M^-1 p`, from the coordinates: of an observer `extension().coordinates(&theta())`."
        }
        _ => "The recovered states.",
    }
}

/// A text as prose: one line, names as code, nothing that Markdown or rustdoc would read.
pub(super) fn prose(text: &str) -> String {
    let words = text.split_whitespace().map(|word| {
        let camel = word.chars().zip(word.chars().skip(1)).any(|(a, b)| a.is_lowercase() && b.is_uppercase());
        let special = word.contains(['_', '[', ']', '<', '>', '*', '`', '|', '\\', '#', '&', '~', '$']);
        if camel || special || word.contains("::") { format!("`{}`", word.replace('`', "'")) } else { word.to_owned() }
    });
    words.collect::<Vec<String>>().join(" ")
}

fn sentence(text: &str) -> String {
    let prose = prose(text);
    if prose.ends_with(['.', '!', '?']) { prose } else { format!("{prose}.") }
}

fn capitalised(text: &str) -> String {
    let mut letters = text.chars();
    let first = letters.next().into_iter().flat_map(char::to_uppercase);
    first.chain(letters).collect()
}

fn section(title: &str) -> Vec<String> {
    vec![String::new(), format!("# {title}"), String::new()]
}

fn text(lines: Vec<String>) -> Vec<String> {
    let block = std::iter::once("```text".to_owned()).chain(lines).chain(["```".to_owned()]);
    std::iter::once(String::new()).chain(block).collect()
}

/// Names as code.
fn listed(arena: &Arena, symbols: impl Iterator<Item = Symbol>) -> String {
    let names: Vec<String> = symbols.map(|symbol| format!("`{}`", arena.name(symbol))).collect();
    if names.is_empty() { "none".to_owned() } else { names.join(", ") }
}

fn vector(arena: &Arena, symbols: impl Iterator<Item = Symbol>) -> String {
    let names: Vec<String> = symbols.map(|symbol| arena.name(symbol)).collect();
    if let [only] = names.as_slice() { only.clone() } else { format!("({})", names.join(", ")) }
}

fn named(arena: &Arena, names: &[Symbol], rows: &[Vec<Expr>]) -> Vec<String> {
    let entries = names.iter().zip(rows.iter().flatten());
    entries.map(|(name, entry)| format!("{} = {}", arena.name(*name), arena.print(*entry))).collect()
}

/// A matrix with its columns aligned.
fn bracketed(arena: &Arena, name: &str, rows: &[Vec<Expr>]) -> Vec<String> {
    let entries: Vec<Vec<String>> =
        rows.iter().map(|row| row.iter().map(|&entry| arena.print(entry)).collect()).collect();
    let columns = entries.first().map_or(0, Vec::len);
    let width = |column: usize| entries.iter().map(|row| row[column].chars().count()).max().unwrap_or(0);
    let widths: Vec<usize> = (0..columns).map(width).collect();
    let rows = entries.iter().enumerate().map(|(index, row)| {
        let cells: Vec<String> = row.iter().zip(&widths).map(|(entry, &width)| format!("{entry:<width$}")).collect();
        let lead = if index == 0 { format!("{name} = ") } else { " ".repeat(name.len() + 3) };
        format!("{lead}[ {} ]", cells.join("   "))
    });
    rows.collect()
}

//! The documentation of the emitted module, in the author's names.
//!
//! In: plant, derivation and programs. Out: lines of documentation. No date, no path: the same model
//! gives the same text.

use super::abbreviation::Abbreviations;
use super::formulas::{self, equation, is_linear, named, text};
use super::inputs::Module;
use super::prose::{self, section, sentence};
use crate::emit::accuracy;
use crate::emit::definition::{
    Argument, CASCADE_SLOPES, Definitions, ETA, FUNCTIONS, Group, INSTANTS, OUTPUT_SLOPES, PERIODS, PHI, PHI_SLOPES,
    RATE_SLOPES, SLOPES, TRANSFORM, VELOCITY,
};
use pebo_cas::{Arena, Expr, Relation, Symbol};
use pebo_design::analysis::{
    AtEstimate, Class, Derivation, EquationInZ, Excitation, Fundamental, Origin, RegressionKind, UnusedOutput,
};
use pebo_design::plant::{Formula, Plant};
use pebo_design::program::{Cost, StagedPrograms};

/// The documentation of the module.
pub(in crate::emit) fn module(module: &Module<'_>) -> Vec<String> {
    let &Module { plant, derivation, definitions, staged, scalar, rebase, abbreviations, .. } = module;
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
    let parts = abbreviations.lines(&plant.arena);
    if !parts.is_empty() {
        lines.extend(section("Parts of the formulas"));
        lines.push("The formulas below, and those of the fields, name these:".to_owned());
        lines.extend(text(parts));
    }
    lines.extend(equations(plant, abbreviations));
    lines.extend(observer(plant, definitions, abbreviations));
    lines.extend(idle(plant, derivation, definitions));
    lines.extend(left_out(plant, definitions));
    lines.extend(fundamental(derivation, rebase));
    lines.extend(drift(plant, derivation, rebase));
    lines.extend(proofs(plant, derivation, definitions));
    lines.extend(section("Cost"));
    lines.extend(["| function | operations |", "|---|---|"].map(str::to_owned));
    lines.extend(costs(definitions, staged).into_iter().map(|(function, cost)| format!("| {function} | {cost} |")));
    lines.extend(accuracy::lines(module.accuracy));
    prose::wrapped(lines, MODULE)
}

/// The longest line of the module's documentation behind `//! `.
const MODULE: usize = 96;

/// All formulas that the documentation shows.
pub(in crate::emit) fn formulas(plant: &Plant, definitions: &Definitions, staged: &StagedPrograms) -> Vec<Expr> {
    let arena = &plant.arena;
    let constants = staged.constants.iter().copied().collect();
    let states = plant.x.iter().map(|state| state.rate.expr);
    let outputs = plant.y.iter().flat_map(|output| [output.rate.as_ref(), output.value.as_ref()]).flatten();
    let is_shown = |name| ![RATE_SLOPES, CASCADE_SLOPES, PHI, PHI_SLOPES].contains(&name);
    let shown = definitions.functions.iter().filter(|function| is_shown(function.name));
    let entries = shown.flat_map(|definition| definition.rows.concat());
    let terms = staged.terms.iter().map(|term| arena.substitute(term.1, &constants));
    let all = states.chain(outputs.map(|output| output.expr)).chain(plant.transform()).chain(identities(plant));
    let in_z = in_z(plant, definitions).into_iter().flatten();
    let all =
        all.chain(entries).chain(in_z.flat_map(|equation| [Some(equation.right), equation.left.formula()]).flatten());
    all.chain(definitions.regression.eta.iter().copied()).chain(terms).collect()
}

/// The regression in z, where `phi_1` would repeat each factor of z for each column of `Psi`.
fn in_z(plant: &Plant, definitions: &Definitions) -> Option<Vec<EquationInZ>> {
    (definitions.class == Class::Gpebo).then(|| definitions.regression.in_z(plant)).flatten()
}

fn equations(plant: &Plant, abbreviations: &Abbreviations) -> Vec<String> {
    let arena = &plant.arena;
    let mut lines = section("Plant");
    let groups: [(&str, Vec<Symbol>); 4] = [
        ("Unmeasured state", plant.x.iter().map(|state| state.symbol).collect()),
        ("output", plant.y.iter().map(|output| output.symbol).collect()),
        ("input", plant.u.clone()),
        ("unknown signal", plant.w.clone()),
    ];
    let signals = groups.into_iter().filter(|(_, symbols)| !symbols.is_empty()).map(|(name, symbols)| {
        format!("{name}{} {}", if symbols.len() == 1 { "" } else { "s" }, listed(arena, symbols.into_iter()))
    });
    lines.push(format!("{}.", signals.collect::<Vec<String>>().join("; ")));
    lines.extend(plant.time.map(|time| {
        format!(
            "The input `{}` is the time in s, as the formulas count it: give each step the time of its middle.",
            arena.name(time)
        )
    }));
    let states = plant.x.iter().map(|state| (state.symbol, Some(state.rate.expr)));
    let outputs = plant.y.iter().map(|o| (o.symbol, o.rate.as_ref().map(|rate| rate.expr)));
    let rates = states
        .chain(outputs)
        .filter_map(|(symbol, rate)| Some(format!("{}' = {}", arena.name(symbol), abbreviations.print(arena, rate?))));
    let values = plant.y.iter().filter_map(|output| {
        Some(format!("{} = {}", arena.name(output.symbol), abbreviations.print(arena, output.value?.expr)))
    });
    let identities = identities(plant).map(|identity| format!("0 = {}", abbreviations.print(arena, identity)));
    lines.extend(text(rates.chain(values).chain(identities).collect()));
    lines
}

/// The identities, without the outputs that are given by value.
fn identities(plant: &Plant) -> impl Iterator<Item = Expr> {
    let arena = &plant.arena;
    let of_output = |identity: &Expr| {
        let differs = |value: Expr, symbol| arena.sub(arena.of_symbol(symbol), value) == *identity;
        plant.y.iter().any(|output| output.value.is_some_and(|value| differs(value.expr, output.symbol)))
    };
    plant.identities.iter().map(|identity| identity.expr).filter(move |identity| !of_output(identity))
}

fn observer(plant: &Plant, definitions: &Definitions, abbreviations: &Abbreviations) -> Vec<String> {
    let arena = &plant.arena;
    let mut lines = section("Observer");
    lines.push("The transform `z = phi(x, y)`:".to_owned());
    let mut formulas: Vec<String> = Vec::new();
    for (z, phi) in plant.z.iter().zip(&plant.phi) {
        formulas.push(format!("{} = {}", arena.name(*z), abbreviations.print(arena, phi.expr)));
    }
    lines.extend(text(formulas));
    lines.extend([
        String::new(),
        match definitions.class {
            Class::Pebo => "The extension `chi` has the rate of `z`; the unknown constant `theta` is `z - chi`:",
            Class::Gpebo => {
                "The extension `xi` copies the dynamics of `z`; the unknown constant `theta` is `z - xi` at the start:"
            }
        }
        .to_owned(),
    ]);
    let mut laws = match definitions.class {
        Class::Pebo => vec!["chi' = h(y, u)".to_owned(), "z = chi + theta".to_owned()],
        Class::Gpebo => vec![
            "xi' = lambda(y, u) xi + h(y, u)".to_owned(),
            "Psi' = lambda(y, u) Psi, Psi(0) = I".to_owned(),
            "z = xi + Psi theta".to_owned(),
        ],
    };
    let near = match definitions.regression.at_estimate {
        Some(AtEstimate::Local) => ", to first order in theta",
        Some(AtEstimate::Monotone) => ", slopes at the estimate",
        None => "",
    };
    laws.push(format!("{}{near}", equation(plant, definitions)));
    laws.push("x = phi_left(z, y)".to_owned());
    if !is_linear(arena, definitions) {
        for (eta, value) in definitions.regression.eta_symbols.iter().zip(&definitions.regression.eta) {
            laws.push(format!("{} = {}", arena.name(*eta), abbreviations.print(arena, *value)));
        }
    }
    lines.extend(text(laws));
    lines.extend([String::new(), "with".to_owned()]);
    let mut blocks = Vec::new();
    let in_z = in_z(plant, definitions);
    for definition in &definitions.functions {
        match definition.name {
            "phi_0" if in_z.is_some() => {
                let print = |formula| abbreviations.print(arena, formula);
                blocks.extend(in_z.iter().flatten().map(|equation| equation.text(arena, print)));
            }
            // Their formulas stand with the functions.
            "primitive_0" | "primitive_1" | "phi_1" if in_z.is_some() => {}
            "primitive_0" if definitions.regression.kind == RegressionKind::Dynamic => {}
            "theta" if is_linear(arena, definitions) => {}
            // The laws and formulas have the values, and with them their derivatives.
            ETA | SLOPES | RATE_SLOPES | CASCADE_SLOPES | PHI | PHI_SLOPES => {}
            "theta" => blocks.extend(named((arena, abbreviations), &plant.theta, &definition.rows)),
            _ => blocks.extend(formulas::of((arena, abbreviations), definitions, definition, MODULE)),
        }
    }
    lines.extend(text(blocks));
    lines
}

/// The note on equations without unknowns.
fn idle(plant: &Plant, derivation: &Derivation, definitions: &Definitions) -> Vec<String> {
    let Some(whole) = &derivation.regression.result else { return Vec::new() };
    let arena = &plant.arena;
    let idle = whole.without_unknowns(arena);
    let names: Vec<String> = idle
        .iter()
        .map(|&row| match (whole.rows().get(row), whole.primitive_0.get(row)) {
            (Some(&output), _) => format!("`{}'`", arena.name(plant.y[output].symbol)),
            (None, Some(held)) => format!("`d/dt({})`", arena.print(*held)),
            (None, None) => format!("equation {}", row + 1),
        })
        .collect();
    if names.is_empty() {
        return names;
    }
    let (verb, them) = if names.len() == 1 { ("holds", "it is") } else { ("hold", "they are") };
    let told = if definitions.regression.phi_0.len() == whole.phi_0.len() {
        "kept for what the observer expects of the outputs"
    } else {
        "no part of the regression"
    };
    vec![String::new(), format!("{} {verb} nothing unknown: {them} {told}.", names.join(", "))]
}

/// The outputs whose equations the regression leaves out.
fn left_out(plant: &Plant, definitions: &Definitions) -> Vec<String> {
    let sentence = |unused: &UnusedOutput| {
        let name = plant.arena.name(plant.y[unused.output].symbol);
        format!("`{name}` is left out of the regression: {}.", unused.reason.words())
    };
    definitions.regression.unused.iter().flat_map(|unused| [String::new(), sentence(unused)]).collect()
}

/// The fate of the fundamental matrix, with its remedy.
fn fundamental(derivation: &Derivation, rebase: bool) -> Vec<String> {
    let fate = match derivation.cascade.result.as_ref().and_then(|cascade| cascade.fundamental) {
        None => return Vec::new(),
        Some(Fundamental::Bounded { fades: false }) => return vec![String::new(), "`Psi` stays bounded.".to_owned()],
        Some(Fundamental::Bounded { fades: true }) => {
            "`Psi` stays bounded but decays in some directions, in which later disturbances of `z` are not corrected."
        }
        Some(Fundamental::Grows) => "`Psi` grows without bound and amplifies every error of `theta`.",
        Some(Fundamental::Undecided) => {
            "It was not shown that `Psi` stays bounded; if it grows, it amplifies errors of `theta`."
        }
    };
    let remedy = if rebase {
        "`Observer::rebasing` sets it back to the identity, with all memory carried over."
    } else {
        "`Observer::restart` from the estimate of `z` with zero `theta` sets `Psi` back to the identity."
    };
    vec![String::new(), format!("{fate} {remedy}")]
}

/// The drift of the extension under a constant bias, with its remedy.
fn drift(plant: &Plant, derivation: &Derivation, rebase: bool) -> Vec<String> {
    let Some(drift) = derivation.drift(plant) else { return Vec::new() };
    let remedy = match (derivation.class, rebase) {
        _ if !drift.uncorrected.is_empty() => "No output corrects it: restart the observer where the states are known.",
        (Class::Pebo, true) => "Use `Observer::step_without_drift`, which keeps the extension bounded.",
        (Class::Gpebo, true) => "Use `Observer::rebasing`, which makes the extension start again from the estimate.",
        (_, false) => "Restart the observer before the extension grows so large that rounding matters.",
    };
    let integrators = listed(&plant.arena, drift.integrators.iter().copied());
    vec![String::new(), format!("A constant bias makes {integrators} grow without bound. {remedy}")]
}

/// The part of a line on unknowns that the known start fixes.
fn by_start(plant: &Plant, derivation: &Derivation) -> String {
    let arena = &plant.arena;
    let fixed = derivation.fixed_by_start(plant);
    if fixed.is_empty() {
        return String::new();
    }
    let start = |(state, value): &(Symbol, Formula)| format!("`{} = {}`", arena.name(*state), arena.print(value.expr));
    let known: Vec<String> = plant.known.iter().map(start).collect();
    let fixed = listed(arena, fixed.into_iter());
    format!("; where the observer starts at {}, {fixed} vanish, which no output corrects later", known.join(" and "))
}

fn proofs(plant: &Plant, derivation: &Derivation, definitions: &Definitions) -> Vec<String> {
    let arena = &plant.arena;
    let mut lines = section("Proved");
    lines.push(match definitions.class {
        Class::Pebo => "- Cascade: the derivative of `z` along the plant is `h(y, u)`.".to_owned(),
        Class::Gpebo => {
            "- Generalised cascade: the derivative of `z` along the plant is `lambda(y, u) z + h(y, u)`.".to_owned()
        }
    });
    let origin = match definitions.left_inverse.origin {
        Origin::Given => "as the model gives it",
        Origin::Derived => Origin::Derived.word(),
    };
    let mut inverse = format!("- Left inverse, {origin}: `phi_left(phi(x, y), y) = x`");
    for (state, period) in &definitions.left_inverse.modulo {
        inverse += &[", `", &arena.name(*state), "` modulo `", &arena.print(*period), "`"].concat();
    }
    if definitions.left_inverse.x.len() < plant.x.len() {
        inverse.push_str(", for some of the states");
    }
    lines.push(format!("{inverse}."));
    let asked = derivation.conditions_on_estimates(plant);
    if !asked.is_empty() {
        let asked: Vec<String> = asked.iter().map(|(e, relation)| compared(arena, *e, *relation)).collect();
        lines.push(format!(
            "  It needs estimates with {}; `step` refuses a sample whose estimate is not finite with `Fault::Estimate`.",
            asked.join(", ")
        ));
    }
    let (regression, kind) = (&definitions.regression, definitions.regression.kind.word());
    let parameterisation = regression.parameterisation(plant);
    let parameterisation = if regression.is_linear(plant) {
        format!("{parameterisation} in `theta`")
    } else {
        format!("{parameterisation}, {} unknowns", regression.eta.len())
    };
    let near = regression.meaning().map_or_else(String::new, |meaning| [": ", meaning].concat());
    lines.push(format!("- Regression: {kind}, {parameterisation}{near}."));
    if let Some(identifiability) = &derivation.identifiability.result {
        let mut line = match identifiability.kind {
            Excitation::Instant if identifiability.everywhere_else => {
                "- Identifiability: every input excites".to_owned()
            }
            Excitation::Instant => "- Identifiability: almost every input excites".to_owned(),
            Excitation::Excitation => {
                let lines = identifiability.trajectories.iter().flat_map(|trajectories| trajectories.lines(plant));
                format!("- Identifiability: over time; {}", lines.collect::<Vec<String>>().join("; "))
            }
            Excitation::Never => "- Identifiability: none".to_owned(),
        };
        line += &by_start(plant, derivation);
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
        lines.extend([String::new(), format!("The proofs also require: {}.", conditions.join(", "))]);
    }
    if !plant.parameters.is_empty() {
        lines.extend([
            String::new(),
            "The proofs hold for all parameters that have the signs of the model's values and meet its assumptions. \
             `Parameters::check` refuses all others."
                .to_owned(),
        ]);
    }
    lines
}

/// A comparison with zero, as code.
fn compared(arena: &Arena, expr: Expr, relation: Relation) -> String {
    format!("`{} {}`", arena.print(expr), relation.sign())
}

/// The functions with their results, and the operations of one call of each.
pub(in crate::emit) fn costs(definitions: &Definitions, staged: &StagedPrograms) -> Vec<(String, Cost)> {
    let mut costs = vec![("`new`, once".to_owned(), Cost::of(&staged.setup))];
    if !staged.terms.is_empty() {
        costs.push(("`terms`, once a sample".to_owned(), Cost::of(&staged.sample)));
    }
    for (group, program) in definitions.groups().iter().zip(&staged.programs) {
        let members: Vec<String> = group.members.iter().map(|member| format!("`{}`", member.name)).collect();
        let values =
            if members == [format!("`{}`", group.name)] { String::new() } else { format!(": {}", members.join(", ")) };
        costs.push((format!("`{}`{values}", group.name), Cost::of(program)));
    }
    costs
}

/// The objects that a size of the module counts.
pub(in crate::emit) fn size(plant: &Plant, definitions: &Definitions, name: &str) -> String {
    let arena = &plant.arena;
    match name {
        "NX" => {
            let states = definitions.left_inverse.x.iter().map(|state| state.0);
            format!("The number of recovered states: {}.", listed(arena, states))
        }
        "NY" => {
            let outputs = definitions.symbols(Argument::Y).into_iter();
            format!("The number of outputs: {}.", listed(arena, outputs))
        }
        "NU" => {
            let inputs = definitions.symbols(Argument::U).into_iter();
            format!("The number of inputs: {}.", listed(arena, inputs))
        }
        "NZ" => "The number of components of the transform `z`.".to_owned(),
        "NR" => "The number of equations of the regression.".to_owned(),
        INSTANTS => {
            "The number of its equations that hold at every instant, without a derivative: the last ones.".to_owned()
        }
        _ => "The number of unknowns of the regression.".to_owned(),
    }
}

/// A name as code, with the unit where the model gives one.
pub(in crate::emit) fn quantity(plant: &Plant, symbol: Symbol) -> String {
    let name = plant.arena.name(symbol);
    match plant.units.get(&symbol) {
        Some(unit) => format!("`{name}` in {}", prose::prose(unit)),
        None => format!("`{name}`"),
    }
}

/// The result of a function, in words.
pub(in crate::emit) fn group(group: &Group, definitions: &Definitions) -> &'static str {
    match group.name {
        "flow" if definitions.class == Class::Gpebo => {
            "The cascade `z' = lambda(y, u) z + h(y, u)`; `lambda` is written by columns."
        }
        "flow" => "The right side `h` of the cascade `z' = h(y, u)`.",
        "regression" => {
            "Both sides of the regression: `phi_0`, which is known, and the regressor `phi_1`, written by columns: one for \
             each unknown."
        }
        "primitive" if definitions.regression.kind == RegressionKind::Dynamic => {
            "The outputs whose rates are the left side of the regression."
        }
        "primitive" if group.members.len() == 1 => "The known term under the time derivative of the regression.",
        "primitive" => {
            "What stands under the time derivative of the regression: the known term, and the factors of the unknowns, \
             written by columns."
        }
        "theta" => "The constant `theta`, from the unknowns of the regression.",
        FUNCTIONS => {
            "The unknowns `eta` of the regression as functions of `theta`, and their derivatives, written by columns: one for \
             each component of `theta`. The estimate is the nearest of these values."
        }
        TRANSFORM => {
            "The transform `phi` as a function of the recovered states, and its derivatives, written by columns: one for each \
             state. Its components depend on one another: the estimate is the state whose transform is nearest to that of the \
             estimator."
        }
        OUTPUT_SLOPES => {
            "The derivatives of the rates by the outputs whose rates the regression has, at `z`: an observer in output form has \
             these outputs among its states. Written by columns, one for each of them."
        }
        PERIODS => "The periods of the outputs that are angles, 0 for the others: the observer counts their turns.",
        VELOCITY => {
            "The velocities `M^-1 p`, which are the rates of the outputs, from the coordinates `z`. An observer has its \
             estimate of `z` as `extension().coordinates(&theta())`, and the terms of its last sample as `terms()`."
        }
        _ => "The recovered states: `phi_left`, the left inverse of the transform.",
    }
}

/// Names as code.
fn listed(arena: &Arena, symbols: impl Iterator<Item = Symbol>) -> String {
    let names: Vec<String> = symbols.map(|symbol| format!("`{}`", arena.name(symbol))).collect();
    if names.is_empty() { "none".to_owned() } else { names.join(", ") }
}

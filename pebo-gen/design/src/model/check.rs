//! Checks the declarations of a model.
//!
//! In: a model of any front end. After this pass, if it found nothing: declared names are names and
//! declared once; entries belong to what they are for, and `f_x` has one for each state; settings
//! are in range.

use std::collections::{HashMap, HashSet};

use super::definitions::circles;
use super::names::{admit, derivative_of};
use super::recording::Recording;
use super::section::{Names, Value};
use super::simulation::{Baseline, Simulation};
use super::spanned::{Entry, Spanned};
use super::written::Model;
use super::{Decimal, Formula};
use crate::source::{Code, Diagnostic, Diagnostics, Span, listed, nearest, quoted};

/// Checks the model's declarations.
///
/// A list of states or outputs that is empty has been reported where it was read: what depends on
/// it is not reported again.
pub fn check(model: &Model, diagnostics: &mut Diagnostics) {
    let measured: HashSet<&str> = model.y.iter().map(|output| output.value.as_str()).collect();
    let both = model.x.iter().map(|state| state.value.as_str()).filter(|state| measured.contains(state));
    let simulated = model.simulation.is_some() || model.recording.is_some();
    let mut pass = DeclarationCheck { diagnostics, simulated, both: both.collect() };
    pass.name(&model.name);
    let scope = pass.declare(model.names(), &[]);
    pass.circles(&model.define);
    let [x, y, both] = [Names::X, Names::Y, Names::XOrY].map(|names| Group::of(names, model));
    if !model.x.is_empty() && !model.y.is_empty() {
        pass.complete(&model.f_x, &model.x, "f_x");
        pass.rates(&model.f_x, &scope, (&x, "x", "f_x"), (&y, "f_y"));
        pass.rates(&model.f_y, &scope, (&y, "y", "f_y"), (&x, "f_x"));
        pass.belong(&model.g_y, &y, "g_y");
        pass.belong(&model.phi_left, &x, "phi_left");
        pass.belong(&model.known, &x, "known");
        pass.belong(&model.angles, &both, "angles");
        pass.belong(&model.units, &Group::new(model.declared(), "a parameter or a signal of x, y, u or w"), "units");
        pass.entries(&model.observer, model);
        pass.patience(model);
        if let Some(recording) = &model.recording {
            pass.recording(recording, model);
        }
        if let Some(simulation) = &model.simulation {
            pass.entries(simulation, model);
        }
    }
    pass.units(model);
    pass.inverted(model);
    pass.measured(model);
    model.observer.check_estimator(pass.diagnostics);
    pass.numbers(&model.observer);
    model.observer.check(pass.diagnostics);
    if let Some(simulation) = &model.simulation {
        pass.simulation(simulation, &scope, (&model.u, &model.w));
    }
}

/// Entries for no name of the model whose names are compared with those that miss one: of more, nobody misspelt each.
const MOST_STRANGERS: usize = 20;

/// Names declared in one section of the model, with their spans in the file.
type Scope<'a> = HashMap<&'a str, Span>;

/// Names that entries may be for.
struct Group<'a> {
    /// In the order of the file, for messages.
    names: Vec<&'a str>,
    set: HashSet<&'a str>,
    /// The kind of each.
    what: &'static str,
}

impl<'a> Group<'a> {
    fn new(names: impl IntoIterator<Item = &'a Spanned<String>>, what: &'static str) -> Self {
        let names: Vec<&str> = names.into_iter().map(|name| name.value.as_str()).collect();
        Self { set: names.iter().copied().collect(), names, what }
    }

    /// The names that entries of a section's map are for.
    fn of(names: Names, model: &'a Model) -> Self {
        let parameters = model.parameters.iter().map(|entry| &entry.name);
        match names {
            Names::X => Self::new(&model.x, "a state of x"),
            Names::Y => Self::new(&model.y, "an output of y"),
            Names::XOrY => Self::new(model.x.iter().chain(&model.y), "a state of x or y"),
            Names::U => Self::new(&model.u, "an input of u"),
            Names::YOrU => Self::new(model.y.iter().chain(&model.u), "an output of y or an input of u"),
            Names::ParameterOrX => Self::new(parameters.chain(&model.x), "a parameter or a state of x"),
            Names::Signal => Self::new(model.x.iter().chain(&model.y).chain(&model.u), "a state, output or input"),
        }
    }

    /// The names for which there is no entry.
    fn without<T>(&self, entries: &[Entry<T>]) -> Vec<&'a str> {
        let present: HashSet<&str> = entries.iter().map(|entry| entry.name.value.as_str()).collect();
        self.names.iter().copied().filter(|name| !present.contains(name)).collect()
    }
}

struct DeclarationCheck<'a> {
    diagnostics: &'a mut Diagnostics,
    /// Names among the states and the outputs.
    both: HashSet<&'a str>,
    /// True if `t` is time: where there is a simulation or a recording.
    simulated: bool,
}

impl DeclarationCheck<'_> {
    fn name(&mut self, name: &Spanned<String>) {
        self.diagnostics.keep(admit(&name.value, name.span, false));
    }

    /// Declares names beside those of the `outer` scopes.
    fn declare<'a>(&mut self, names: impl IntoIterator<Item = &'a Spanned<String>>, outer: &[&Scope<'_>]) -> Scope<'a> {
        let mut scope = Scope::new();
        for name in names {
            let text = name.value.as_str();
            self.diagnostics.keep(admit(text, name.span, self.simulated));
            let outside = outer.iter().find_map(|scope| scope.get(text)).copied();
            if let Some(first) = scope.insert(text, name.span).or(outside) {
                let message = format!("{} is declared twice", quoted(text));
                self.diagnostics.push(
                    Diagnostic::error(Code::DuplicateName, name.span, message)
                        .also(first, "first here")
                        .help(if outside.is_none() && self.both.contains(text) {
                            format!(
                                "a state that is measured stands under `y` alone, with its rate under `f_y`: remove {} from `x`",
                                quoted(text)
                            )
                        } else {
                            "rename one of them".to_owned()
                        }),
                );
            }
        }
        scope
    }

    /// No definition needs itself.
    fn circles(&mut self, definitions: &[Entry<Formula>]) {
        for circle in circles(definitions) {
            self.diagnostics.push(circle);
        }
    }

    /// A unit is a word that goes into a line of documentation or beside an axis.
    fn units(&mut self, model: &Model) {
        const LONGEST: usize = 20;
        for unit in model.units.iter().map(|entry| &entry.value) {
            let text = unit.value.as_str();
            let plain = text.chars().all(|letter| letter.is_alphanumeric() || " ·*/^().-+%°'\"_".contains(letter));
            if text.trim().is_empty() || text.chars().count() > LONGEST || !plain {
                let message = format!("{} is no unit", quoted(text));
                self.diagnostics.push(
                    Diagnostic::error(Code::WrongShape, unit.span, message)
                        .help(format!("write up to {LONGEST} letters, digits and signs, as `kg m^2/s`")),
                );
            }
        }
    }

    /// A recording has signals of the plant, and its rows are placed in time in one way.
    fn recording(&mut self, recording: &Recording, model: &Model) {
        self.entries(recording, model);
        let mut signals = model.x.iter().chain(&model.y).chain(&model.u);
        if let Some(name) = signals.find(|name| name.value == Recording::STEP) {
            let message = format!("`{}` is reserved for the period of a recording", name.value);
            self.diagnostics.push(
                Diagnostic::error(Code::ReservedName, name.span, message)
                    .help(format!("choose another name, as `{}_0`", name.value)),
            );
        }
        if let (Some(t), Some(step)) = (&recording.t, &recording.step) {
            self.diagnostics.push(
                Diagnostic::error(Code::SettingConflict, step.name.span, "`step` stands beside `t`")
                    .also(t.name.span, "this says when each row was recorded")
                    .help("remove `t` if the rows are equally far apart, or else `step`"),
            );
        }
    }

    /// Checks that a left inverse has a transform. A mistake in a given transform has been reported.
    fn inverted(&mut self, model: &Model) {
        if self.diagnostics.has_errors() {
            return;
        }
        let (None, [], Some(first)) = (&model.class, model.phi.as_slice(), model.phi_left.first()) else { return };
        let message = "`phi_left` stands without the `phi` that it inverts";
        self.diagnostics.push(
            Diagnostic::error(Code::MissingKey, first.name.span, message)
                .help("write `phi`, or leave `phi_left` out: then both are searched for"),
        );
    }

    /// Every name has an entry.
    fn complete(&mut self, entries: &[Entry<Formula>], names: &[Spanned<String>], section: &str) {
        // Without any entry the section itself has been reported.
        let Some(first) = entries.first() else { return };
        let present: HashSet<&str> = entries.iter().map(|entry| entry.name.value.as_str()).collect();
        let missing: Vec<&str> =
            names.iter().map(|name| name.value.as_str()).filter(|name| !present.contains(name)).collect();
        let known: HashSet<&str> = names.iter().map(|name| name.value.as_str()).collect();
        let strangers = entries.iter().map(|entry| entry.name.value.as_str());
        let strangers = strangers.filter(|name| !known.contains(name)).take(MOST_STRANGERS);
        // Such an entry has a hint of its own; so does an output among the states.
        let meant: HashSet<&str> = strangers.filter_map(|name| meant(name, &missing)).collect();
        let missing: HashSet<&str> =
            missing.into_iter().filter(|name| !meant.contains(name) && !self.both.contains(name)).collect();
        for name in names.iter().filter(|name| missing.contains(name.value.as_str())) {
            let message = format!("`{section}` has no entry for {}", quoted(&name.value));
            self.diagnostics.push(
                Diagnostic::error(Code::MissingEntry, name.span, message)
                    .also(first.name.span, format!("`{section}` begins here"))
                    .help(format!("add its rate under `{section}`, 0 if it is constant")),
            );
        }
    }

    /// Every entry has a name of the group.
    fn belong(&mut self, entries: &dyn Value, group: &Group<'_>, section: &str) {
        for name in entries.names().into_iter().filter(|name| !group.set.contains(name.value.as_str())) {
            self.diagnostics.push_with(|| stranger(name, group, section));
        }
    }

    /// Entries below a section are for the names that its rows say.
    fn entries(&mut self, section: &dyn Value, model: &Model) {
        for row in section.rows() {
            if let Some(names) = row.names {
                self.belong(row.value, &Group::of(names, model), row.key);
            }
            self.entries(row.value, model);
        }
    }

    /// Numbers below a section are in the ranges that its rows say.
    fn numbers(&mut self, section: &dyn Value) {
        for row in section.rows() {
            if let Some(limit) = row.limit {
                let numbers = row.value.numbers().into_iter().enumerate();
                for (index, number) in numbers.filter(|(_, number)| !(limit.admits)(number.value.to_f64())) {
                    let names = row.value.names();
                    let name = names.get(index).map_or("", |name| &name.value);
                    let message = limit.message.replace("<name>", name);
                    let diagnostic = Diagnostic::error(Code::NumberOutOfRange, number.span, message);
                    self.diagnostics.push(diagnostic.help(limit.help));
                }
            }
            self.numbers(row.value);
        }
    }

    /// Every rate is of a name of its own group, which the list of the key declares.
    fn rates(
        &mut self,
        entries: &[Entry<Formula>],
        declared: &Scope<'_>,
        (own, key, section): (&Group<'_>, &str, &str),
        (other, there): (&Group<'_>, &str),
    ) {
        let missing = own.without(entries);
        for entry in entries.iter().filter(|entry| !own.set.contains(entry.name.value.as_str())) {
            let name = entry.name.value.as_str();
            self.diagnostics.push_with(|| {
                let message = format!("{} under `{section}` is not {}", quoted(name), own.what);
                let diagnostic = Diagnostic::error(Code::UnknownEntry, entry.name.span, message);
                if other.set.contains(name) {
                    return diagnostic
                        .help(format!("it is {}: its rate stands under `{there}`, and not here", other.what));
                }
                if let Some(of) = derivative_of(name, missing.iter().copied()) {
                    return diagnostic
                        .help(format!("write `{of}: ..`: what stands under `{section}` is a rate already"));
                }
                match nearest(name, missing.iter().copied()) {
                    Some(near) => diagnostic.suggest(Some(near)),
                    None if declared.contains_key(name) => diagnostic.help("remove it here, or its other declaration"),
                    None => {
                        let names = own.names.iter().copied().chain([name]).collect::<Vec<_>>().join(", ");
                        diagnostic.help(format!("declare it, as `{key}: [{names}]`, or remove it here"))
                    }
                }
            });
        }
    }

    /// An output has to depend on the states; with a given phi, the regression reports that it has no equation.
    fn measured(&mut self, model: &Model) {
        let nothing = model.f_y.is_empty() && model.g_y.is_empty() && model.identities.is_empty();
        if self.diagnostics.has_errors() || model.class.is_some() || !model.phi.is_empty() || !nothing {
            return;
        }
        let Some(output) = model.y.first() else { return };
        let names = listed(model.y.iter().map(|name| name.value.as_str()));
        let message = format!("nothing says what {names} has to do with the states");
        self.diagnostics.push(Diagnostic::error(Code::MissingKey, output.span, message).help(format!(
            "add the rate of an output, as `f_y: {{{0}: ..}}`, or its value, as `g_y: {{{0}: ..}}`",
            output.value
        )));
    }

    fn simulation(
        &mut self,
        simulation: &Simulation,
        model: &Scope<'_>,
        (u, w): (&[Spanned<String>], &[Spanned<String>]),
    ) {
        self.numbers(simulation);
        // The course of a signal of `w` is given here, under the name that it has already.
        let signals = simulation.signals.iter().map(|entry| &entry.name);
        let signals = signals.filter(|name| w.iter().all(|known| known.value != name.value));
        let (inputs, signals): (Vec<_>, Vec<_>) =
            signals.partition(|name| u.iter().any(|input| input.value == name.value));
        for name in inputs {
            let message = format!("{} is an input, which has no course under `signals`", quoted(&name.value));
            self.diagnostics.push(
                Diagnostic::error(Code::UnknownEntry, name.span, message).help(format!(
                    "give the course a name of its own and set the input to it: `signals: {{{0}_t: ..}}` and `control: {{{0}: \
                     {0}_t}}`",
                    name.value
                )),
            );
        }
        let define = simulation.define.iter().map(|entry| &entry.name);
        let own = self.declare(signals.into_iter().chain(define), &[model]);
        self.circles(&simulation.define);
        for signal in simulation.signals.iter().chain(&simulation.plant) {
            for pair in signal.value.windows(2) {
                let [before, after] = pair else { continue };
                self.ascend(&before.from, &after.from);
            }
        }
        // Baselines do not see one another: the same state may occur in two of them.
        for baseline in &simulation.baselines {
            self.name(&baseline.name);
            match &baseline.value {
                Baseline::Equations(equations) => {
                    let states = || equations.state.iter().map(|entry| &entry.name);
                    self.declare(states(), &[model, &own]);
                    let group = Group::new(states(), "a state of the baseline");
                    self.belong(&equations.initial, &group, "initial");
                }
                Baseline::Luenberger(observer) => self.poles(&observer.poles),
                Baseline::Kalman(_) | Baseline::Extended(_) => {}
            }
        }
        self.feedback(simulation);
    }

    /// The longest gap has room for a step.
    fn patience(&mut self, model: &Model) {
        let step = model.simulation.as_ref().and_then(|simulation| simulation.step.as_ref());
        if let (Some(gap), Some(step)) = (&model.observer.gap, step)
            && gap.value.to_f64() > 0.0
            && gap.value.to_f64() < step.value.to_f64()
        {
            let message = format!("a gap of {} s is shorter than a step of {} s", gap.value.text(), step.value.text());
            self.diagnostics.push(
                Diagnostic::error(Code::NumberOutOfRange, gap.span, message)
                    .also(step.span, "the step is here")
                    .help("write the time of several steps: after a longer one the observer begins anew"),
            );
        }
    }

    fn feedback(&mut self, simulation: &Simulation) {
        let Some(feedback) = &simulation.feedback else { return };
        let choices = simulation.feedbacks();
        if choices.contains(&feedback.value.as_str()) {
            return;
        }
        let message = format!("{} is not an observer of this simulation", quoted(&feedback.value));
        self.diagnostics.push(
            Diagnostic::error(Code::WrongChoice, feedback.span, message)
                .help(format!("write one of {}", listed(choices))),
        );
    }

    fn ascend(&mut self, before: &Spanned<Decimal>, after: &Spanned<Decimal>) {
        if before.value.to_f64() < after.value.to_f64() {
            return;
        }
        let message = "the start times are not in ascending order";
        self.diagnostics.push(
            Diagnostic::error(Code::NumberOutOfRange, after.span, message)
                .also(before.span, "the previous piece starts here")
                .help("order the pieces by their start times"),
        );
    }

    /// Poles are in the left half of the plane, and each there once.
    fn poles(&mut self, poles: &[Spanned<Decimal>]) {
        for (index, pole) in poles.iter().enumerate() {
            let value = pole.value.to_f64();
            let message = if value >= 0.0 {
                "a pole must be negative"
            } else if poles[..index].iter().any(|other| other.value.to_f64().total_cmp(&value).is_eq()) {
                "this pole is there twice"
            } else {
                continue;
            };
            self.diagnostics.push(
                Diagnostic::error(Code::NumberOutOfRange, pole.span, message)
                    .help("write distinct numbers below zero, as `poles: [-100, -110]`"),
            );
        }
    }
}

/// The missing name that a stray entry is probably meant for.
fn meant<'a>(name: &str, missing: &[&'a str]) -> Option<&'a str> {
    derivative_of(name, missing.iter().copied()).or_else(|| nearest(name, missing.iter().copied()))
}

/// An entry for a name that is none of the group.
fn stranger(name: &Spanned<String>, group: &Group<'_>, section: &str) -> Diagnostic {
    let message = format!("{} under `{section}` is not {}", quoted(&name.value), group.what);
    let diagnostic = Diagnostic::error(Code::UnknownEntry, name.span, message);
    match nearest(&name.value, group.names.iter().copied()) {
        Some(near) => diagnostic.suggest(Some(near)),
        None if group.names.is_empty() => diagnostic.help("remove it, or declare it"),
        None => diagnostic.help(format!("the entries of this map are for {}", listed(group.names.iter().copied()))),
    }
}

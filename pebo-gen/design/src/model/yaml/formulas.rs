//! Parses a document's texts to formulas.

use super::document::{self, Definition, Document, Text};
use crate::model::class::{Class, Electromechanical, Lti, Mechanical};
use std::sync::Arc;

use crate::model::formula::{
    Comparison, Decimal, Estimates, Formula, Interpolation, Permitted, SpanMap, Table, Term, parse_comparison,
    parse_formula,
};
use crate::model::recording::Recording;
use crate::model::spanned::Entry;
use crate::model::written::{Baseline, Equations, Kalman, Luenberger, Model, Panel, Piece, Simulation};
use crate::source::{Diagnostics, Source, Span};

/// Parses every formula of the document; nothing if the model has no name.
pub(super) fn parse(document: Document, source: &Source, diagnostics: &mut Diagnostics) -> Option<Model> {
    let tables = tables(&document.define, diagnostics);
    let mut pass = FormulaParser { source, diagnostics, estimates: Estimates::Refused, tables };
    let define = document.define.into_iter().map(|entry| pass.definition(entry)).collect();
    let assume = document.assume.iter().filter_map(|text| pass.comparison(text)).collect();
    let f_x = pass.entries(document.f_x);
    let f_y = pass.entries(document.f_y);
    let g_y = pass.entries(document.g_y);
    let phi = pass.list(&document.phi);
    let phi_left = pass.entries(document.phi_left);
    let identities = pass.list(&document.identities);
    let known = pass.entries(document.known);
    let angles = pass.entries(document.angles);
    let class = pass.class(document.lti, document.mechanical, document.electromechanical);
    let recording = document.recording.map(|entries| Recording::of(pass.entries(entries)));
    let mut simulation = document.simulation.map(|simulation| pass.simulation(simulation));
    // A run begins where the start is known to be, unless it says otherwise.
    if let Some(simulation) = &mut simulation {
        let is_named = |name: &str| simulation.initial.iter().any(|own| own.name.value == name);
        let is_state = |name: &str| document.x.iter().any(|state| state.value == name);
        let is_missing = |entry: &&Entry<Formula>| is_state(&entry.name.value) && !is_named(&entry.name.value);
        let missing: Vec<Entry<Formula>> = known.iter().filter(is_missing).cloned().collect();
        simulation.initial.extend(missing);
    }
    Some(Model {
        name: document.model?,
        title: document.title,
        reference: document.reference,
        parameters: document.parameters,
        x: document.x,
        y: document.y,
        u: document.u,
        time: None,
        w: document.w,
        cascade_class: document.class,
        regression_form: document.regression,
        define,
        assume,
        class,
        f_x,
        f_y,
        g_y,
        phi,
        phi_left,
        identities,
        known,
        angles,
        units: document.units,
        observer: document.observer,
        simulation,
        recording,
    })
}

struct FormulaParser<'a> {
    source: &'a Source,
    diagnostics: &'a mut Diagnostics,
    /// Permission for `hat()` in the section at hand.
    estimates: Estimates,
    /// The tables of the model.
    tables: Vec<Arc<Table>>,
}

/// The tables among definitions.
fn tables(define: &[Entry<Definition>], diagnostics: &mut Diagnostics) -> Vec<Arc<Table>> {
    let mut found = Vec::new();
    for entry in define {
        let Definition::Table(table) = &entry.value else { continue };
        let kind = table.interpolation.as_ref().and_then(|text| Interpolation::from_name(&text.value));
        // What is missing has its diagnostic.
        let read = !table.points.is_empty() && table.table.is_some();
        let through = || Table::through(&entry.name.value, &table.points, (kind.unwrap_or_default(), entry.name.span));
        found.extend(read.then(through).and_then(|table| diagnostics.keep(table)).map(Arc::new));
    }
    found
}

impl FormulaParser<'_> {
    fn formula(&mut self, text: &Text) -> Formula {
        let spans = SpanMap::align(&text.value, text.span, self.source);
        let permitted = Permitted { estimates: self.estimates, tables: &self.tables };
        let parsed = parse_formula(&text.value, &spans, permitted);
        self.diagnostics.keep(parsed).unwrap_or_else(|| nothing(text.span))
    }

    /// A formula with a name, or a table at its argument.
    fn definition(&mut self, entry: Entry<Definition>) -> Entry<Formula> {
        let Entry { name, value } = entry;
        let value = match value {
            Definition::Formula(text) => self.formula(&text),
            Definition::Table(table) => {
                let own = self.tables.iter().find(|own| own.name == name.value).map(Arc::clone);
                let argument = table.table.map(|text| self.formula(&text));
                match own.zip(argument) {
                    Some((own, argument)) => {
                        let span = argument.span;
                        Formula { span, term: Term::Table(own, 0, Box::new(argument)) }
                    }
                    None => nothing(name.span),
                }
            }
        };
        Entry { name, value }
    }

    fn comparison(&mut self, text: &Text) -> Option<Comparison> {
        let spans = SpanMap::align(&text.value, text.span, self.source);
        self.diagnostics.keep(parse_comparison(&text.value, &spans, &self.tables))
    }

    fn list(&mut self, texts: &[Text]) -> Vec<Formula> {
        texts.iter().map(|text| self.formula(text)).collect()
    }

    fn entries(&mut self, entries: Vec<Entry<Text>>) -> Vec<Entry<Formula>> {
        let parse = |entry: Entry<Text>| Entry { value: self.formula(&entry.value), name: entry.name };
        entries.into_iter().map(parse).collect()
    }

    /// The class, at most one.
    fn class(
        &mut self,
        lti: Option<Lti<Text>>,
        mechanical: Option<Mechanical<Text>>,
        electromechanical: Option<Electromechanical<Text>>,
    ) -> Option<Class> {
        let mut parse = |text: Text| self.formula(&text);
        let lti = lti.map(|class| Class::Lti(class.map(&mut parse)));
        let mechanical = mechanical.map(|class| Class::Mechanical(class.map(&mut parse)));
        let electromechanical = electromechanical.map(|class| Class::Electromechanical(class.map(&mut parse)));
        lti.or(mechanical).or(electromechanical)
    }

    fn simulation(&mut self, simulation: document::Simulation) -> Simulation {
        let initial = self.entries(simulation.initial);
        let signals = self.courses(simulation.signals);
        let plant = self.courses(simulation.plant);
        self.estimates = Estimates::Allowed;
        Simulation {
            duration: simulation.duration,
            step: simulation.step,
            initial,
            signals,
            noise: simulation.noise,
            bias: simulation.bias,
            quantisation: simulation.quantisation,
            delay: simulation.delay,
            jitter: simulation.jitter,
            dropped: simulation.dropped,
            every: simulation.every,
            plant,
            define: self.entries(simulation.define),
            control: self.entries(simulation.control),
            feedback: simulation.feedback,
            baselines: simulation
                .baselines
                .into_iter()
                .map(|entry| Entry { value: self.baseline(&entry.name, entry.value), name: entry.name })
                .collect(),
            panels: simulation.panels.into_iter().filter_map(|panel| self.panel(panel)).collect(),
        }
    }

    /// Formulas that hold one after the other, by name.
    fn courses(&mut self, entries: Vec<Entry<Vec<document::Piece>>>) -> Vec<Entry<Vec<Piece>>> {
        let course = |entry: Entry<Vec<document::Piece>>| Entry {
            value: entry.value.into_iter().map(|piece| self.piece(piece)).collect(),
            name: entry.name,
        };
        entries.into_iter().map(course).collect()
    }

    fn piece(&mut self, piece: document::Piece) -> Piece {
        Piece { formula: self.formula(&piece.formula), from: piece.from }
    }

    /// A baseline, of the kind that its name says.
    fn baseline(&mut self, name: &Text, baseline: document::Baseline) -> Baseline {
        let initial = self.entries(baseline.initial);
        match name.value.as_str() {
            name @ (Baseline::KALMAN | Baseline::EXTENDED) => Baseline::Kalman(Kalman {
                extended: name == Baseline::EXTENDED,
                sensors: baseline.sensors,
                start: baseline.start,
                disturbance: baseline.disturbance,
                initial,
            }),
            Baseline::LUENBERGER => Baseline::Luenberger(Luenberger { poles: baseline.poles, initial }),
            _ => Baseline::Equations(Equations {
                state: self.entries(baseline.state),
                initial,
                estimate: self.entries(baseline.estimate),
            }),
        }
    }

    /// Nothing if there is no title, whose diagnostic is out.
    fn panel(&mut self, panel: document::Panel) -> Option<Panel> {
        let curves = self.list(&panel.curves);
        let scale = panel.scale.map(|scale| scale.value).unwrap_or_default();
        Some(Panel { title: panel.title?, unit: panel.unit, curves, scale })
    }
}

/// A stand-in for a formula whose diagnostic is out.
fn nothing(span: Span) -> Formula {
    Formula { span, term: Term::Number(Decimal::zero()) }
}

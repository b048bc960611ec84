//! The keys of the whole file.

use std::sync::Arc;

use super::key::{Key, Role, Shape};
use super::read::{Read, Reader, Section, nothing, spanned};
use super::tree::{Content, Node};
use super::words::is_course;
use crate::model::class::{Class, Electromechanical, Lti, Mechanical};
use crate::model::formula::{Comparison, Formula, Interpolation, Table, Term};
use crate::model::observer::Observer;
use crate::model::recording::Recording;
use crate::model::section::{Formulas, Number, Numbers, Text, Value, section};
use crate::model::simulation::Simulation;
use crate::model::spanned::{Entry, Spanned};
use crate::model::written::{CascadeClass, Model, RegressionForm};

section! {
    /// The file.
    struct Document {
        model: Text, "model: cuk", "The name of the model: an identifier, which also names the emitted module",
            required();
        title: Text, "title: DC-DC Cuk converter", "One line that says what the plant is";
        reference: Text, "reference: Ortega et al. 2015, Section 5.3", "Where the model is from";
        parameters: Parameters, "parameters: {L1: 10e-3, E: 12}",
            "The constants of the plant with their values, or a list of names whose values are given later";
        x: Vec<Spanned<String>>, "x: [i1, i3]", "The unmeasured states", required();
        y: Vec<Spanned<String>>, "y: [v2, v4]", "The measured outputs", required();
        u: Vec<Spanned<String>>, "u: [d]", "The inputs";
        w: Vec<Spanned<String>>, "w: [omega]", "Unmeasured signals that are not estimated: no result depends on them";
        class: Option<Spanned<CascadeClass>>, "class: pebo",
            "The cascade that is asked for; if left out, a plain one (pebo) is preferred unless a generalised one (gpebo) takes fewer samples unfiltered or needs fewer conditions";
        regression: Option<Spanned<RegressionForm>>, "regression: static",
            "How a relation between the components of phi becomes a regression: as it holds at every instant, or differentiated, which has fewer unknowns; if left out, an identity of the model is used as it is written, and a relation that was found is differentiated where that gives fewer unknowns. With `monotone`, equations that are monotone in one unknown each are used where none are linear in functions of theta, as without `phi`. With `local`, the equations of all outputs are used, those that are not linear in functions of theta to first order at the estimate, which then converges from a neighbourhood";
        define: Definitions, "define: {p: v2*i1}", "Names for parts of formulas and for tables, in any order";
        assume: Vec<Comparison>, "assume: [L1 > 0, 0 < d < 1]", "Inequalities that hold wherever the plant operates";
        f_x: Formulas, "f_x: {i1: (E - (1 - d)*v2)/L1}", "The time derivative of each unmeasured state",
            role(Role::RequiredOrByClass);
        f_y: Formulas, "f_y: {v2: i1/C2}",
            "The time derivatives of outputs; an output whose derivative nothing needs may be left out",
            role(Role::OptionalOrByClass);
        g_y: Formulas, "g_y: {V: E - R*i1}", "The values of outputs, in the states, the inputs and the other outputs",
            role(Role::OptionalOrByClass);
        phi: Vec<Formula>, "phi: [i1, i3]",
            "The components of the transform z = phi(x, y); if left out, it is searched for",
            role(Role::SearchedOrByClass);
        phi_left: Formulas, "phi_left: {i1: z1}",
            "The states in z1, z2, .. and the outputs; derived if left out; some states only make a partial observer";
        identities: Vec<Formula>, "identities: [a^2 + b^2 - 1]", "Expressions that are zero by physics";
        known: Formulas, "known: {p: 0}",
            "States that start at these values, in parameters, whenever the observer starts: the proof uses them where the outputs do not show the states";
        angles: Formulas, "angles: {q: 2*pi}", "States and outputs that are angles, with their periods";
        units: Vec<Entry<Spanned<String>>>, "units: {i1: A, v2: V}",
            "The units of parameters and signals, for the emitted documentation and the axes of the figure";
        observer: Observer, "observer: {gain: 1e7}",
            "The estimator and its settings, for the emitted code and the simulation";
        simulation: Option<Simulation>, "simulation: {duration: 0.1, step: 1e-6}", "The closed loop to simulate";
        recording: Option<Recording>, "recording: {t: time, v2: ch1/256 - offset}",
            "What the columns of recorded data mean: a formula in columns and parameters for each output, input, and state that was measured besides; the column of its own name if left out";
        lti: Option<Lti>, "lti: {A11: [[-1]], A21: [[2]]}",
            "A linear time-invariant plant: x' = A11 x + A12 y + B1 u, y' = A21 x + A22 y + B2 u", role(Role::Class);
        mechanical: Option<Mechanical>, "mechanical: {M: [[m]], V: m*g*q, T: [[1]]}",
            "A mechanical plant in Hamiltonian form: x lists the momenta, y the positions", role(Role::Class);
        electromechanical: Option<Electromechanical>,
            "electromechanical: {L: [[L]], mu: [c*q], R: [r], speed: omega}",
            "Coils that move a mass: x lists the position, y the currents and perhaps the speed", role(Role::Class);
    }
}

/// The keys of the file.
pub(super) const FILE: &[Key] = Document::KEYS;

/// Reads the file; nothing if it is no map, or has no name, whose diagnostic is out.
pub(super) fn read<'a>(root: &'a Node, reader: &mut Reader<'a>) -> Option<Model> {
    Document::read(root, &Document::SHAPE, reader)?.model()
}

impl Document {
    fn model(self) -> Option<Model> {
        let lti = self.lti.map(Class::Lti);
        let mechanical = self.mechanical.map(Class::Mechanical);
        let electromechanical = self.electromechanical.map(Class::Electromechanical);
        let mut simulation = self.simulation;
        // A run begins where the start is known to be, unless it says otherwise.
        if let Some(simulation) = &mut simulation {
            let is_named = |name: &str| simulation.initial.iter().any(|own| own.name.value == name);
            let is_state = |name: &str| self.x.iter().any(|state| state.value == name);
            let is_missing = |entry: &&Entry<Formula>| is_state(&entry.name.value) && !is_named(&entry.name.value);
            let missing: Vec<Entry<Formula>> = self.known.iter().filter(is_missing).cloned().collect();
            simulation.initial.extend(missing);
        }
        Some(Model {
            name: self.model?,
            title: self.title,
            reference: self.reference,
            parameters: self.parameters.0,
            x: self.x,
            y: self.y,
            u: self.u,
            time: None,
            w: self.w,
            define: self.define.0,
            cascade_class: self.class,
            regression_form: self.regression,
            assume: self.assume,
            class: lti.or(mechanical).or(electromechanical),
            f_x: self.f_x,
            f_y: self.f_y,
            g_y: self.g_y,
            phi: self.phi,
            phi_left: self.phi_left,
            identities: self.identities,
            known: self.known,
            angles: self.angles,
            units: self.units,
            observer: self.observer,
            simulation,
            recording: self.recording,
        })
    }
}

/// Parameters, with values or without.
#[derive(Clone, Debug, Default, PartialEq)]
struct Parameters(Vec<Entry<Number>>);

impl Value for Parameters {}

/// A map from names to numbers or nothing, or a list of names.
impl Read for Parameters {
    const SHAPE: Shape = Shape::Parameters;

    fn read<'a>(node: &'a Node, shape: &'static Shape, reader: &mut Reader<'a>) -> Option<Self> {
        match &node.content {
            Content::Map(entries) => Some(Self(reader.entries(entries, |_, node, reader| match node.content {
                Content::Null => Some(None),
                _ => Some(Spanned::read(node, &Shape::Number, reader)),
            }))),
            Content::List(items) => {
                let mut name = |node| Some(Entry { name: Spanned::read(node, &Shape::Text, reader)?, value: None });
                Some(Self(items.iter().filter_map(&mut name).collect()))
            }
            _ => reader.refuse(node, shape),
        }
    }
}

/// Named sub-expressions and tables.
#[derive(Clone, Debug, Default, PartialEq)]
struct Definitions(Formulas);

impl Value for Definitions {}

/// A formula that is not parsed before all tables are known, or a table.
enum Definition {
    Formula(Spanned<String>),
    Table(Curve),
}

section! {
    /// A table; what is missing has its diagnostic.
    struct Curve {
        table: Text, "table: soc", "The argument of the table", required();
        points: Vec<Numbers>, "points: [[0, 3.0], [0.5, 3.7], [1, 4.2]]",
            "Arguments, ascending, each with its value; beyond the first and the last the table goes on with its slope",
            required();
        interpolation: Option<Spanned<Interpolation>>, "interpolation: linear",
            "The function between the points: monotone cubics (cubic) if left out, or lines (linear)";
    }
}

impl Read for Definitions {
    const SHAPE: Shape = Shape::Map(&Shape::FormulaOr(Curve::KEYS));

    fn read<'a>(node: &'a Node, shape: &'static Shape, reader: &mut Reader<'a>) -> Option<Self> {
        let Content::Map(entries) = &node.content else { return reader.refuse(node, shape) };
        let written = reader.entries(entries, |_, node, reader| Some(Definition::read(node, reader)));
        let tables = written.iter().filter_map(|entry| entry.value.table(&entry.name));
        reader.tables = tables.filter_map(|table| reader.diagnostics.keep(table)).map(Arc::new).collect();
        let parsed = |Entry { name, value }: Entry<Definition>| Entry { value: value.formula(&name, reader), name };
        Some(Self(written.into_iter().map(parsed).collect()))
    }
}

impl Definition {
    fn read<'a>(node: &'a Node, reader: &mut Reader<'a>) -> Self {
        const EITHER: Shape = Shape::FormulaOr(Curve::KEYS);
        let read = match &node.content {
            Content::Scalar(text) => Some(Self::Formula(spanned(text, node.span))),
            Content::Map(_) if is_course(node) => reader.refuse(node, &Shape::Formula),
            _ => Curve::read(node, &EITHER, reader).map(Self::Table),
        };
        read.unwrap_or_else(|| Self::Formula(spanned("0", node.span)))
    }

    /// The table, unless something of it is missing.
    fn table(&self, name: &Spanned<String>) -> Option<Result<Table, crate::source::Diagnostic>> {
        let Self::Table(curve) = self else { return None };
        let interpolation = curve.interpolation.as_ref().map(|kind| kind.value).unwrap_or_default();
        let is_whole = !curve.points.is_empty() && curve.table.is_some();
        is_whole.then(|| Table::through(&name.value, &curve.points, (interpolation, name.span)))
    }

    /// The formula, or the table at its argument.
    fn formula(self, name: &Spanned<String>, reader: &mut Reader<'_>) -> Formula {
        match self {
            Self::Formula(text) => reader.formula(&text.value, text.span),
            Self::Table(curve) => {
                let own = reader.tables.iter().find(|own| own.name == name.value).map(Arc::clone);
                let argument = curve.table.map(|text| reader.formula(&text.value, text.span));
                own.zip(argument).map_or_else(
                    || nothing(name.span),
                    |(own, argument)| Formula { span: argument.span, term: Term::Table(own, 0, Box::new(argument)) },
                )
            }
        }
    }
}

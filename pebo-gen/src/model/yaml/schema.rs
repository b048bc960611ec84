//! The keys of a model file, and the shape of the value behind each.

use crate::model::CascadeClass;
use crate::model::observer::Estimator;

/// The shape that a value must have.
#[derive(Debug)]
pub(super) enum Shape {
    /// Any scalar. Names are texts here: whether they are names is checked where they are declared.
    Text,
    /// A decimal.
    Number,
    /// A formula or a comparison; parsed later.
    Formula,
    /// One of these words.
    Choice(&'static [&'static str]),
    /// A list of values of one shape.
    List(&'static Shape),
    /// A list, or a single value that stands for a list of one.
    OneOrMore(&'static Shape),
    /// A map from names to values of one shape.
    Map(&'static Shape),
    /// A map from names to numbers or nothing, or a list of names.
    Parameters,
    /// A formula, or a map from start times to formulas.
    Signal,
    /// A map with these keys.
    Record(&'static [Key]),
    /// A matrix of formulas: rows, or a plain list, or a single one; what these stand for depends on
    /// the size that is wanted.
    Matrix,
}

/// What the presence of a key means for the others.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Role {
    /// It must be there.
    Required,
    /// It may be there.
    Optional,
    /// It stands for the keys that a class gives.
    Class,
    /// It must be there unless a class is, which gives it.
    RequiredOrByClass,
    /// It may be there unless a class is, which gives it.
    OptionalOrByClass,
}

/// A key of a record.
#[derive(Debug)]
pub(super) struct Key {
    pub(super) name: &'static str,
    pub(super) role: Role,
    pub(super) shape: Shape,
    /// How to write it.
    pub(super) example: &'static str,
}

const fn key(role: Role, name: &'static str, shape: Shape, example: &'static str) -> Key {
    Key { name, role, shape, example }
}

const fn required(name: &'static str, shape: Shape, example: &'static str) -> Key {
    key(Role::Required, name, shape, example)
}

const fn optional(name: &'static str, shape: Shape, example: &'static str) -> Key {
    key(Role::Optional, name, shape, example)
}

const TEXTS: Shape = Shape::List(&Shape::Text);
const NUMBERS: Shape = Shape::List(&Shape::Number);
/// For each unknown, or one number for all.
const ONE_OR_EACH: Shape = Shape::OneOrMore(&Shape::Number);
const FORMULAS: Shape = Shape::List(&Shape::Formula);
const RATES: Shape = Shape::Map(&Shape::Formula);

/// The file.
pub(super) const MODEL: &[Key] = &[
    required("model", Shape::Text, "model: cuk"),
    optional("title", Shape::Text, "title: DC-DC Cuk converter"),
    optional("reference", Shape::Text, "reference: Ortega et al. 2015, Section 5.3"),
    optional("parameters", Shape::Parameters, "parameters: {L1: 10e-3, E: 12}"),
    required("x", TEXTS, "x: [i1, i3]"),
    required("y", TEXTS, "y: [v2, v4]"),
    optional("u", TEXTS, "u: [d]"),
    optional("w", TEXTS, "w: [omega]"),
    optional("class", Shape::Choice(CascadeClass::NAMES), "class: pebo"),
    optional("define", RATES, "define: {p: v2*i1}"),
    optional("assume", FORMULAS, "assume: [L1 > 0, 0 < d < 1]"),
    key(Role::RequiredOrByClass, "f_x", RATES, "f_x: {i1: (E - (1 - d)*v2)/L1}"),
    key(Role::OptionalOrByClass, "f_y", RATES, "f_y: {v2: i1/C2}"),
    key(Role::OptionalOrByClass, "g_y", RATES, "g_y: {V: E - R*i1}"),
    key(Role::RequiredOrByClass, "phi", FORMULAS, "phi: [i1, i3]"),
    optional("phi_left", RATES, "phi_left: {i1: z1}"),
    optional("identities", FORMULAS, "identities: [a^2 + b^2 - 1]"),
    optional("angles", RATES, "angles: {q: 2*pi}"),
    optional("observer", Shape::Record(OBSERVER), "observer: {gain: 1e7}"),
    optional("simulation", Shape::Record(SIMULATION), "simulation: {duration: 0.1, step: 1e-6}"),
    key(Role::Class, "lti", Shape::Record(LTI), "lti: {A11: [[-1]], A21: [[2]]}"),
    key(Role::Class, "mechanical", Shape::Record(MECHANICAL), "mechanical: {M: [[m]], V: m*g*q, T: [[1]]}"),
    key(
        Role::Class,
        "electromechanical",
        Shape::Record(ELECTROMECHANICAL),
        "electromechanical: {L: [[L]], mu: [c*q], R: [r], speed: omega}",
    ),
];

/// Blocks of a linear plant; those left out are zero. With T1 and T2 the author chooses the transform.
const LTI: &[Key] = &[
    required("A11", Shape::Matrix, "A11: [[0, 1], [-1, 0]]"),
    optional("A12", Shape::Matrix, "A12: [[0], [1]]"),
    required("A21", Shape::Matrix, "A21: [[1, 0]]"),
    optional("A22", Shape::Matrix, "A22: [[-1]]"),
    optional("B1", Shape::Matrix, "B1: [[0], [1]]"),
    optional("B2", Shape::Matrix, "B2: [[1]]"),
    optional("T1", Shape::Matrix, "T1: [[1, 0], [0, 1]]"),
    optional("T2", Shape::Matrix, "T2: [[0], [0]]"),
];

/// Inertia, potential energy, input matrix and the frame T of a mechanical plant, in positions and parameters.
const MECHANICAL: &[Key] = &[
    required("M", Shape::Matrix, "M: [[m, 0], [0, m*r^2]]"),
    optional("V", Shape::Formula, "V: m*g*r*cos(q)"),
    optional("G", Shape::Matrix, "G: [[1], [0]]"),
    required("T", Shape::Matrix, "T: [[1, 0], [0, 1]]"),
];

/// Inductances, magnets, resistances, and the mass that the coils move.
const ELECTROMECHANICAL: &[Key] = &[
    optional("coils", Shape::Number, "coils: 2"),
    required("L", Shape::Matrix, "L: [[L, 0], [0, L]]"),
    optional("mu", Shape::Matrix, "mu: [lambda_m*cos(q), lambda_m*sin(q)]"),
    required("R", Shape::Matrix, "R: [R, R]"),
    optional("B", Shape::Matrix, "B: [[1, 0], [0, 1]]"),
    required("speed", Shape::Text, "speed: omega"),
    optional("inertia", Shape::Formula, "inertia: j"),
    optional("friction", Shape::Formula, "friction: f"),
    optional("load", Shape::Formula, "load: m*g"),
];

/// Settings of the estimators belong to some of them: [`Estimator`] has which.
const OBSERVER: &[Key] = &[
    optional("estimator", Shape::Choice(Estimator::NAMES), "estimator: gradient"),
    optional("gain", ONE_OR_EACH, "gain: [1e7, 1e7]"),
    optional("covariance", ONE_OR_EACH, "covariance: 1e6"),
    optional("regressor_gain", ONE_OR_EACH, "regressor_gain: [1, 1]"),
    optional("forgetting", Shape::Number, "forgetting: 100"),
    optional("normalisation", Shape::Number, "normalisation: 1"),
    optional("clip", Shape::Number, "clip: 0.1"),
    optional("period", Shape::Number, "period: 0.01"),
    optional("bounds", Shape::Record(BOUNDS), "bounds: {lower: [-1, 0], upper: 5}"),
    optional("filter", Shape::Number, "filter: 500"),
    optional("window", Shape::Number, "window: 100"),
    optional("hold", Shape::Choice(&["zero-order", "first-order"]), "hold: zero-order"),
    optional("extension", NUMBERS, "extension: [0, 0]"),
];

const BOUNDS: &[Key] = &[optional("lower", ONE_OR_EACH, "lower: [-1, 0]"), optional("upper", ONE_OR_EACH, "upper: 5")];

const SIMULATION: &[Key] = &[
    optional("duration", Shape::Number, "duration: 0.1"),
    optional("step", Shape::Number, "step: 1e-6"),
    optional("initial", RATES, "initial: {i1: 0, v2: E}"),
    optional("signals", Shape::Map(&Shape::Signal), "signals: {V_d: {0: 25, 0.2: 30}}"),
    optional("define", RATES, "define: {p: V_d*hat(i1)}"),
    optional("control", RATES, "control: {d: V_d/(V_d + E)}"),
    optional("feedback", Shape::Text, "feedback: observer"),
    optional(
        "baselines",
        Shape::Map(&Shape::Record(BASELINE)),
        "baselines: {copy: {state: {a: -a}, estimate: {i1: a}}}",
    ),
    optional("panels", Shape::List(&Shape::Record(PANEL)), "panels: [{title: error, unit: A, curves: [hat(i1) - i1]}]"),
];

const BASELINE: &[Key] = &[
    required("state", RATES, "state: {a: -a + v2}"),
    optional("initial", RATES, "initial: {a: 0}"),
    required("estimate", RATES, "estimate: {i1: a}"),
];

const PANEL: &[Key] = &[
    required("title", Shape::Text, "title: error"),
    optional("unit", Shape::Text, "unit: A"),
    required("curves", FORMULAS, "curves: [hat(i1) - i1]"),
    optional("scale", Shape::Choice(&["linear", "log"]), "scale: log"),
];

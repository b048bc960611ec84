//! The keys of a model file, and the shape of the value behind each.

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
    /// A section that is not read yet.
    Later,
}

/// A key of a record.
#[derive(Debug)]
pub(super) struct Key {
    pub(super) name: &'static str,
    pub(super) required: bool,
    pub(super) shape: Shape,
    /// How to write it.
    pub(super) example: &'static str,
}

const fn required(name: &'static str, shape: Shape, example: &'static str) -> Key {
    Key { name, required: true, shape, example }
}

const fn optional(name: &'static str, shape: Shape, example: &'static str) -> Key {
    Key { name, required: false, shape, example }
}

const TEXTS: Shape = Shape::List(&Shape::Text);
const NUMBERS: Shape = Shape::List(&Shape::Number);
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
    optional("define", RATES, "define: {p: v2*i1}"),
    optional("assume", FORMULAS, "assume: [L1 > 0, 0 < d < 1]"),
    required("f_x", RATES, "f_x: {i1: (E - (1 - d)*v2)/L1}"),
    optional("f_y", RATES, "f_y: {v2: i1/C2}"),
    required("phi", FORMULAS, "phi: [i1, i3]"),
    optional("phi_left", RATES, "phi_left: {i1: z1}"),
    optional("identities", FORMULAS, "identities: [a^2 + b^2 - 1]"),
    optional("angles", RATES, "angles: {q: 2*pi}"),
    optional("observer", Shape::Record(OBSERVER), "observer: {gain: 1e7}"),
    optional("simulation", Shape::Record(SIMULATION), "simulation: {duration: 0.1, step: 1e-6}"),
    optional("lti", Shape::Later, "lti: {A11: [[0]]}"),
    optional("mechanical", Shape::Later, "mechanical: {M: [[1]]}"),
    optional("electromechanical", Shape::Later, "electromechanical: {L: [[1]]}"),
];

const OBSERVER: &[Key] = &[
    optional("estimator", Shape::Text, "estimator: gradient"),
    optional("gain", Shape::OneOrMore(&Shape::Number), "gain: [1e7, 1e7]"),
    optional("filter", Shape::Number, "filter: 500"),
    optional("hold", Shape::Choice(&["zero-order", "first-order"]), "hold: zero-order"),
    optional("extension", NUMBERS, "extension: [0, 0]"),
];

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

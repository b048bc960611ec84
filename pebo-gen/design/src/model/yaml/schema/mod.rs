//! The keys of a model file, and the shape of the value behind each.
//!
//! The reader checks a file by this table (`shape`), and `json_schema` prints it for editors.

mod key;

use crate::model::formula::Interpolation;
use crate::model::observer::{Estimator, Form};
use crate::model::{Baseline, CascadeClass, Class, Recording, RegressionForm};

pub(super) use key::{Key, Role, Shape};
use key::{key, optional, required};

const TEXTS: Shape = Shape::List(&Shape::Text);
const NUMBERS: Shape = Shape::List(&Shape::Number);
/// For each unknown, or one number for all.
const ONE_OR_EACH: Shape = Shape::OneOrMore(&Shape::Number);
/// A number above zero for each name.
const DEVIATIONS: Shape = Shape::Map(&Shape::Number);
/// A number for each name.
const OFFSETS: Shape = Shape::Map(&Shape::Number);
const FORMULAS: Shape = Shape::List(&Shape::Formula);
const RATES: Shape = Shape::Map(&Shape::Formula);

/// Names of keys in other tools and textbooks, beside the names here.
pub(super) const OTHERS: &[(&str, &str)] = &[
    ("params", "parameters"),
    ("param", "parameters"),
    ("constants", "parameters"),
    ("p", "parameters"),
    ("state", "x"),
    ("states", "x"),
    ("output", "y"),
    ("outputs", "y"),
    ("measured", "y"),
    ("measurements", "y"),
    ("input", "u"),
    ("inputs", "u"),
    ("controls", "u"),
    ("disturbances", "w"),
    ("name", "model"),
    ("description", "title"),
    ("assumptions", "assume"),
    ("constraints", "assume"),
    ("definitions", "define"),
    ("where", "define"),
    ("dynamics", "f_x"),
    ("equations", "f_x"),
    ("dx", "f_x"),
    ("f", "f_x"),
    ("dy", "f_y"),
    ("g", "g_y"),
    ("h", "g_y"),
    ("transform", "phi"),
    ("z", "phi"),
    ("noise", "sensors"),
    ("measurement_noise", "sensors"),
    ("process_noise", "disturbance"),
    ("dt", "step"),
    ("x0", "initial"),
    ("tend", "duration"),
    ("t_end", "duration"),
];

/// A table under `define`.
const TABLE: &[Key] = &[
    required("table", Shape::Formula, "table: soc", "The argument of the table"),
    required(
        "points",
        Shape::List(&NUMBERS),
        "points: [[0, 3.0], [0.5, 3.7], [1, 4.2]]",
        "Arguments, ascending, each with its value; beyond the first and the last the table goes on with its slope",
    ),
    optional(
        "interpolation",
        Shape::Choice(Interpolation::NAMES),
        "interpolation: linear",
        "The function between the points: monotone cubics (cubic) if left out, or lines (linear)",
    ),
];

/// The file.
pub(super) const MODEL: &[Key] = &[
    required(
        "model",
        Shape::Text,
        "model: cuk",
        "The name of the model: an identifier, which also names the emitted module",
    ),
    optional("title", Shape::Text, "title: DC-DC Cuk converter", "One line that says what the plant is"),
    optional("reference", Shape::Text, "reference: Ortega et al. 2015, Section 5.3", "Where the model is from"),
    optional(
        "parameters",
        Shape::Parameters,
        "parameters: {L1: 10e-3, E: 12}",
        "The constants of the plant with their values, or a list of names whose values are given later",
    ),
    required("x", TEXTS, "x: [i1, i3]", "The unmeasured states"),
    required("y", TEXTS, "y: [v2, v4]", "The measured outputs"),
    optional("u", TEXTS, "u: [d]", "The inputs"),
    optional("w", TEXTS, "w: [omega]", "Unmeasured signals that are not estimated: no result depends on them"),
    optional(
        "class",
        Shape::Choice(CascadeClass::NAMES),
        "class: pebo",
        "The cascade that is asked for; if left out, a plain one (pebo) is preferred unless a generalised one (gpebo) takes fewer samples unfiltered or needs fewer conditions",
    ),
    optional(
        "regression",
        Shape::Choice(RegressionForm::NAMES),
        "regression: static",
        "How a relation between the components of phi becomes a regression: as it holds at every instant, or \
         differentiated, which has fewer unknowns; if left out, an identity of the model is used as it is written, and a \
         relation that was found is differentiated where that gives fewer unknowns. With `local`, the equations of all \
         outputs are used, those that are not linear in functions of theta to first order at the estimate, which then \
         converges from a neighbourhood",
    ),
    optional(
        "define",
        Shape::Map(&Shape::FormulaOr(TABLE)),
        "define: {p: v2*i1}",
        "Names for parts of formulas and for tables, in any order",
    ),
    optional("assume", FORMULAS, "assume: [L1 > 0, 0 < d < 1]", "Inequalities that hold wherever the plant operates"),
    key(
        Role::RequiredOrByClass,
        "f_x",
        RATES,
        ("f_x: {i1: (E - (1 - d)*v2)/L1}", "The time derivative of each unmeasured state"),
    ),
    key(
        Role::OptionalOrByClass,
        "f_y",
        RATES,
        (
            "f_y: {v2: i1/C2}",
            "The time derivatives of outputs; an output whose derivative nothing needs may be left out",
        ),
    ),
    key(
        Role::OptionalOrByClass,
        "g_y",
        RATES,
        ("g_y: {V: E - R*i1}", "The values of outputs, in the states, the inputs and the other outputs"),
    ),
    key(
        Role::SearchedOrByClass,
        "phi",
        FORMULAS,
        ("phi: [i1, i3]", "The components of the transform z = phi(x, y); if left out, it is searched for"),
    ),
    optional(
        "phi_left",
        RATES,
        "phi_left: {i1: z1}",
        "The states in z1, z2, .. and the outputs; derived if left out; some states only make a partial observer",
    ),
    optional("identities", FORMULAS, "identities: [a^2 + b^2 - 1]", "Expressions that are zero by physics"),
    optional(
        "known",
        RATES,
        "known: {p: 0}",
        "States that start at these values, in parameters, whenever the observer starts: the proof uses them where the outputs do not show the states",
    ),
    optional("angles", RATES, "angles: {q: 2*pi}", "States and outputs that are angles, with their periods"),
    optional(
        "units",
        Shape::Map(&Shape::Text),
        "units: {i1: A, v2: V}",
        "The units of parameters and signals, for the emitted documentation and the axes of the figure",
    ),
    optional(
        "observer",
        Shape::Record(OBSERVER),
        "observer: {gain: 1e7}",
        "The estimator and its settings, for the emitted code and the simulation",
    ),
    optional(
        "simulation",
        Shape::Record(SIMULATION),
        "simulation: {duration: 0.1, step: 1e-6}",
        "The closed loop to simulate",
    ),
    optional(
        "recording",
        Shape::Kinds(RECORDING, &Shape::Formula),
        "recording: {t: time, v2: ch1/256 - offset}",
        "What the columns of recorded data mean: a formula in columns and parameters for each output, input, and state that was measured besides; the column of its own name if left out",
    ),
    key(
        Role::Class,
        Class::LTI,
        Shape::Record(LTI),
        (
            "lti: {A11: [[-1]], A21: [[2]]}",
            "A linear time-invariant plant: x' = A11 x + A12 y + B1 u, y' = A21 x + A22 y + B2 u",
        ),
    ),
    key(
        Role::Class,
        Class::MECHANICAL,
        Shape::Record(MECHANICAL),
        (
            "mechanical: {M: [[m]], V: m*g*q, T: [[1]]}",
            "A mechanical plant in Hamiltonian form: x lists the momenta, y the positions",
        ),
    ),
    key(
        Role::Class,
        Class::ELECTROMECHANICAL,
        Shape::Record(ELECTROMECHANICAL),
        (
            "electromechanical: {L: [[L]], mu: [c*q], R: [r], speed: omega}",
            "Coils that move a mass: x lists the position, y the currents and perhaps the speed",
        ),
    ),
];

/// Blocks of a linear plant; absent ones are zero. With T1 and T2 the author chooses the transform.
const LTI: &[Key] = &[
    required("A11", Shape::Matrix, "A11: [[0, 1], [-1, 0]]", "From x to the rate of x"),
    optional("A12", Shape::Matrix, "A12: [[0], [1]]", "From y to the rate of x; zero if left out"),
    required("A21", Shape::Matrix, "A21: [[1, 0]]", "From x to the rate of y"),
    optional("A22", Shape::Matrix, "A22: [[-1]]", "From y to the rate of y; zero if left out"),
    optional("B1", Shape::Matrix, "B1: [[0], [1]]", "From the inputs to the rate of x; zero if left out"),
    optional("B2", Shape::Matrix, "B2: [[1]]", "From the inputs to the rate of y; zero if left out"),
    optional(
        "T1",
        Shape::Matrix,
        "T1: [[1, 0], [0, 1]]",
        "The factor of x in the transform T1 x + T2 y; derived if left out",
    ),
    optional("T2", Shape::Matrix, "T2: [[0], [0]]", "The factor of y in the transform T1 x + T2 y; derived with T1"),
];

/// Inertia, potential energy, input matrix and the frame T of a mechanical plant, in positions and parameters.
const MECHANICAL: &[Key] = &[
    required("M", Shape::Matrix, "M: [[m, 0], [0, m*r^2]]", "The inertia matrix, a function of the positions"),
    optional(
        "V",
        Shape::Formula,
        "V: m*g*r*cos(q)",
        "The potential energy, a function of the positions; zero if left out",
    ),
    optional(
        "G",
        Shape::Matrix,
        "G: [[1], [0]]",
        "The input matrix, from the inputs to the rates of the momenta; zero if left out",
    ),
    optional(
        "T",
        Shape::Matrix,
        "T: [[1, 0], [0, 1]]",
        "The frame T(q) of the transform z = T(q)' p; if left out, the transform is searched for",
    ),
];

/// Inductances, magnets, resistances, and the mass that the coils move.
const ELECTROMECHANICAL: &[Key] = &[
    optional("coils", Shape::Number, "coils: 2", "The number of coils"),
    required("L", Shape::Matrix, "L: [[L, 0], [0, L]]", "The inductance matrix, a function of the position"),
    optional(
        "mu",
        Shape::Matrix,
        "mu: [lambda_m*cos(q), lambda_m*sin(q)]",
        "The flux of permanent magnets in each coil, a function of the position; zero if left out",
    ),
    required("R", Shape::Matrix, "R: [R, R]", "The resistance matrix"),
    optional("B", Shape::Matrix, "B: [[1, 0], [0, 1]]", "From the voltages to the coils; the identity if left out"),
    required(
        "speed",
        Shape::Text,
        "speed: omega",
        "The declared name of the speed: an output, an input, or a signal of w",
    ),
    optional("inertia", Shape::Formula, "inertia: j", "The inertia of the mass"),
    optional("friction", Shape::Formula, "friction: f", "The friction coefficient"),
    optional("load", Shape::Formula, "load: m*g", "The constant external force"),
];

/// Settings of the estimators belong to some of them: [`Estimator`] has which.
const OBSERVER: &[Key] = &[
    optional(
        "sensors",
        DEVIATIONS,
        "sensors: {v2: 0.1}",
        "The standard deviation of each output's samples, from which with `start` and `disturbance` all gains are derived; that of `noise` and `quantisation` together, or a thousandth of the output at the start, if left out",
    ),
    optional(
        "start",
        DEVIATIONS,
        "start: {i1: 5}",
        "How wrong the estimate of each state can be at the start, a standard deviation; ten times the state, or 10 of its unit, if left out (once the state with `regression: local`)",
    ),
    optional(
        "disturbance",
        DEVIATIONS,
        "disturbance: {i1: 0.1}",
        "By how much a state or output drifts besides its rate, in its unit per root second; 0 if left out beside `sensors` or `start`",
    ),
    optional(
        "delay",
        Shape::AllOrEach,
        "delay: {v2: 2e-6}",
        "How old the samples of an output are as they arrive, in seconds: one number, or one for each output; the observer takes each for the time that it is of; 0 if left out",
    ),
    optional(
        "form",
        Shape::Choice(Form::NAMES),
        "form: output",
        "rate: the regression of the rates of the outputs, through a filter or a window; output: the same integrated, which needs no filter; if left out, output, or rate where gains are written",
    ),
    optional(
        "estimator",
        Shape::Choice(Estimator::NAMES),
        "estimator: gradient",
        "The estimator; if left out beside gains, gradient",
    ),
    optional(
        "gain",
        ONE_OR_EACH,
        "gain: [1e7, 1e7]",
        "The gain of a gradient, or of DREM in 1/s: one for each unknown, or one for all",
    ),
    optional(
        "covariance",
        ONE_OR_EACH,
        "covariance: 1e6",
        "The diagonal of the covariance of least squares at the start, which is also its bound",
    ),
    optional(
        "regressor_gain",
        ONE_OR_EACH,
        "regressor_gain: [1, 1]",
        "The diagonal of the gain of the regressor extension of DREM",
    ),
    optional("forgetting", Shape::Number, "forgetting: 100", "The rate of forgetting in 1/s; 0 if left out"),
    optional(
        "process_noise",
        ONE_OR_EACH,
        "process_noise: [0, 1]",
        "By how much the covariance of least squares grows in a second; 0 if left out",
    ),
    optional(
        "normalisation",
        Shape::Number,
        "normalisation: 1",
        "mu of the normalised gradient, which is divided by 1 + mu |Phi_1|^2",
    ),
    optional("clip", Shape::Number, "clip: 0.1", "mu of finite-time DREM, above 0 and below 1"),
    optional(
        "period",
        Shape::Number,
        "period: 0.01",
        "Seconds after which finite-time DREM starts again, so that it tracks jumps; never if left out",
    ),
    optional("bounds", Shape::Record(BOUNDS), "bounds: {lower: [-1, 0], upper: 5}", "Bounds of the unknowns"),
    optional(
        "within",
        Shape::Record(WITHIN),
        "within: {lower: 0, upper: [10, 5]}",
        "Bounds of the recovered states: an estimate beyond them is moved to the bound",
    ),
    optional("filter", Shape::Number, "filter: 500", "The corner frequency of the filter of the regression, in rad/s"),
    optional(
        "window",
        Shape::Number,
        "window: 100",
        "The number of samples of a moving window, in place of the filter",
    ),
    optional(
        "hold",
        Shape::Choice(&["zero-order", "first-order"]),
        "hold: zero-order",
        "What the samples stand for between two instants",
    ),
    optional(
        "rebase",
        Shape::NumberOr(REBASE),
        "rebase: 1",
        "When the extension starts again from the estimate, with all memory carried over: after so many samples (1 is the form without drift), or as the map says; never if left out",
    ),
    optional(
        "gate",
        Shape::Number,
        "gate: 25",
        "The normalised square of the innovation beyond which a sample is refused as an outlier; without gains only",
    ),
    optional(
        "wanted",
        DEVIATIONS,
        "wanted: {i1: 0.05}",
        "The standard error that each state shall be known to: a run says from when on all are, or which is not; without gains only",
    ),
    optional(
        "limits",
        Shape::Map(&NUMBERS),
        "limits: {v2: [-50, 50], d: [0, 1]}",
        "Between what a sample of an output or input is, as the rails of its sensor; one beyond is refused",
    ),
    optional(
        "gap",
        Shape::Number,
        "gap: 1e-3",
        "The longest time in seconds from one accepted sample to the next; after a longer one the observer begins anew",
    ),
    optional(
        "extension",
        NUMBERS,
        "extension: [0, 0]",
        "The dynamic extension at the start: one number for each component; if left out, zeros, or where phi_left has no value at zero, or with `regression: local`, phi of half the state at which the simulation begins",
    ),
];

const REBASE: &[Key] = &[
    optional("samples", Shape::Number, "samples: 1", "After so many samples; the same as the number alone"),
    optional(
        "above",
        Shape::Number,
        "above: 100",
        "When a component of the extension exceeds this, in units of phi: cheap, as it seldom does",
    ),
    optional(
        "leak",
        Shape::Number,
        "leak: 5",
        "All the time, at this rate in 1/s: what leaks from the extension goes into theta",
    ),
];

const BOUNDS: &[Key] = &[
    optional("lower", ONE_OR_EACH, "lower: [-1, 0]", "The lower bound: one for each unknown, or one for all"),
    optional("upper", ONE_OR_EACH, "upper: 5", "The upper bound: one for each unknown, or one for all"),
];

const WITHIN: &[Key] = &[
    optional("lower", ONE_OR_EACH, "lower: 0", "The lower bound: one for each recovered state, or one for all"),
    optional("upper", ONE_OR_EACH, "upper: [10, 5]", "The upper bound: one for each recovered state, or one for all"),
];

const SIMULATION: &[Key] = &[
    optional("duration", Shape::Number, "duration: 0.1", "How long to simulate, in seconds"),
    optional("step", Shape::Number, "step: 1e-6", "The sampling period of observer and control law, in seconds"),
    optional("initial", RATES, "initial: {i1: 0, v2: E}", "The states and outputs at the start, in parameters"),
    optional(
        "signals",
        Shape::Map(&Shape::Signal),
        "signals: {V_d: {0: 25, 0.2: 30}}",
        "Signals in time, those of `w` too: a formula in t and parameters, or a map from start times to formulas, which are steps",
    ),
    optional(
        "noise",
        DEVIATIONS,
        "noise: {v2: 0.1, v4: 0.1}",
        "The standard deviation of each output's samples, in the unit of the output; 0 if left out",
    ),
    optional(
        "bias",
        OFFSETS,
        "bias: {v2: 0.1}",
        "The constant offset of each output's sensor, in the unit of the output; 0 if left out",
    ),
    optional(
        "quantisation",
        OFFSETS,
        "quantisation: {v2: 0.05}",
        "The step of each output's converter, in the unit of the output: a sample is the multiple of it that is nearest; none if 0 or left out",
    ),
    optional(
        "delay",
        Shape::AllOrEach,
        "delay: {v2: 2e-6}",
        "How old a sample is, in seconds: one number, or one for each output; a part of a step is interpolated straight between samples; that of the section `observer` if left out",
    ),
    optional(
        "jitter",
        Shape::Number,
        "jitter: 0.3",
        "How far an instant of the loop is from its place at most, as a share of the step below 0.5: uniform, and not told to any observer",
    ),
    optional(
        "dropped",
        Shape::Number,
        "dropped: 0.2",
        "The probability that the sample of an instant never arrives, from 0 to below 1; the first one does",
    ),
    optional(
        "every",
        OFFSETS,
        "every: {v4: 10}",
        "Of an output only each so many-th sample arrives, the first included; 1 if left out",
    ),
    optional(
        "plant",
        Shape::Map(&Shape::Signal),
        "plant: {E: {0: 12, 0.5: 13}}",
        "True values where the model errs: of parameters, and of states whose rate is 0, in t and parameters",
    ),
    optional("define", RATES, "define: {p: V_d*hat(i1)}", "Names for parts of the formulas of the simulation"),
    optional(
        "control",
        RATES,
        "control: {d: V_d/(V_d + E)}",
        "The control law: each input in outputs, estimates hat(x), signals, parameters and t",
    ),
    optional(
        "feedback",
        Shape::Text,
        "feedback: observer",
        "Whose estimates the control law uses: observer, truth, or the name of a baseline",
    ),
    optional(
        "baselines",
        Shape::Kinds(BASELINES, &Shape::Record(BASELINE)),
        "baselines: {kalman: {sensors: {v2: 0.1}}, copy: {state: {a: -a}, estimate: {i1: a}}}",
        "Other observers to compare with: kalman, ekf, luenberger, or ones given by their equations",
    ),
    optional(
        "panels",
        Shape::List(&Shape::Record(PANEL)),
        "panels: [{title: error, unit: A, curves: [hat(i1) - i1]}]",
        "The panels of the figure",
    ),
];

/// The keys of a recording besides signals.
const RECORDING: &[Key] = &[
    optional(Recording::T, Shape::Formula, "t: time/1000", "When each row was recorded, in seconds"),
    optional(
        Recording::STEP,
        Shape::Formula,
        "step: 1e-5",
        "The time from row to row in seconds, in parameters, where the rows have no time",
    ),
];

/// Baselines that are given by their name.
const BASELINES: &[Key] = &[
    optional(
        Baseline::KALMAN,
        Shape::Record(KALMAN),
        "kalman: {sensors: {v2: 0.1}, disturbance: {i1: 1}}",
        "The Kalman filter of a plant that is affine in its states and outputs",
    ),
    optional(
        Baseline::EXTENDED,
        Shape::Record(KALMAN),
        "ekf: {sensors: {v2: 0.1}, disturbance: {i1: 1}}",
        "The extended Kalman filter, which linearises the plant at its estimate",
    ),
    optional(
        Baseline::LUENBERGER,
        Shape::Record(LUENBERGER),
        "luenberger: {poles: [-100, -110]}",
        "Luenberger's observer, of the plant as linearised at its estimate",
    ),
];

const KALMAN: &[Key] = &[
    optional(
        "sensors",
        DEVIATIONS,
        "sensors: {v2: 0.1}",
        "The standard deviation of each output's samples; that of `noise` and `quantisation` together if left out",
    ),
    optional(
        "start",
        DEVIATIONS,
        "start: {i1: 1}",
        "How wrong each unmeasured state is at the start, a standard deviation; its very error if left out",
    ),
    optional(
        "disturbance",
        DEVIATIONS,
        "disturbance: {i1: 0.1}",
        "By how much a state or output drifts besides its rate, in its unit per root second; 0 if left out",
    ),
    optional("initial", RATES, "initial: {i1: 1}", START),
];

const LUENBERGER: &[Key] = &[
    required(
        "poles",
        NUMBERS,
        "poles: [-100, -110]",
        "Poles of the error in 1/s, negative: one for each state and each output that has a rate, dealt to the outputs in turn",
    ),
    optional("initial", RATES, "initial: {i1: 1}", START),
];

const START: &str = "The estimates of the unmeasured states at the start, in parameters and outputs; zero if left out";

const BASELINE: &[Key] = &[
    required("state", RATES, "state: {a: -a + v2}", "The states of the baseline observer with their rates"),
    optional("initial", RATES, "initial: {a: 0}", "Its states at the start; zero if left out"),
    required("estimate", RATES, "estimate: {i1: a}", "Its estimates of the unmeasured states"),
];

const PANEL: &[Key] = &[
    required("title", Shape::Text, "title: error", "The heading of the panel"),
    optional("unit", Shape::Text, "unit: A", "The unit of its axis"),
    required("curves", FORMULAS, "curves: [hat(i1) - i1]", "What to draw, as formulas"),
    optional("scale", Shape::Choice(&["linear", "log"]), "scale: log", "The scale of its axis; linear if left out"),
];

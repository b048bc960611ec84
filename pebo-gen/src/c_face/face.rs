//! The crate's root: the functions that the header declares, over the emitted observer.
//!
//! In: the face. Out: Rust in rustfmt's layout, for `std` on hosts and without it where there is no system. A function
//! looks at its pointers and at the tag of the observer, and hands over to the emitted code.

use std::fmt::Write as _;

use super::faults::FAULTS;
use super::size::{mentions, start_name};
use super::{Face, Signal};

const HEAD: &str = include_str!("templates/face_head.rs.in");
const TAIL: &str = include_str!("templates/face_tail.rs.in");
const STANDARD_ERROR: &str = include_str!("templates/face_standard_error.rs.in");

/// The longest list of fields that rustfmt leaves in one line.
const SHORT: usize = 18;

/// The text of `lib.rs`.
pub(super) fn text(face: &Face<'_>) -> String {
    let module = &face.module;
    let is_late = mentions(&module.tuned, "LateObserver");
    let tag = grouped(module.tag);
    let observer = if is_late { "tuned.past()" } else { "tuned" };
    let or = |wanted: bool, text: &'static str| if wanted { text } else { "" };
    let guards = [or(module.has_gate, "Gate"), or(module.has_limits, "Limits")];
    let mut imports = vec!["Extension as _"];
    imports.extend(guards.into_iter().filter(|name| !name.is_empty()));
    let imports = if imports.len() == 1 { imports.concat() } else { format!("{{{}}}", imports.join(", ")) };
    let head = face.filled(
        HEAD,
        &[
            ("type", &module.type_name),
            ("tag", &tag),
            ("start", start_name(module)),
            ("started", observer),
            ("imports", &imports),
            (
                "limits_field",
                or(
                    module.has_limits,
                    "    limits: Limits<@scalar@, { emitted::NY }, { emitted::NU }>,\n",
                ),
            ),
            ("gate_field", or(module.has_gate, "    gate: Gate<@scalar@>,\n")),
            ("limits_set", &or(module.has_limits, "        let limits = emitted::@type@::limits()?;\n").replace("@type@", &module.type_name)),
            ("gate_set", &or(module.has_gate, "        let gate = emitted::@type@::gate()?;\n").replace("@type@", &module.type_name)),
            ("limits_name", or(module.has_limits, "            limits,\n")),
            ("gate_name", or(module.has_gate, "            gate,\n")),
            ("limits_check", or(module.has_limits, "        self.limits.check(&SVector::from(y), &SVector::from(u), period)?;\n")),
            ("gate_check", or(module.has_gate, "        let innovation = self.tuned.innovation(y, u, period)?;\n        self.gate.admit(&innovation)?;\n")),
            ("parameters_argument", or(!face.parameters.is_empty(), "parameters: &Parameters")),
            ("parameters_value", &value("emitted::Parameters", &face.parameters, "parameters")),
        ],
    );
    let structures = [
        structure(face, "Y", "The outputs of a sample.", &face.y),
        structure(face, "U", "The inputs of a sample.", &face.u),
        structure(face, "X", "The states that an estimate holds.", &face.x),
        structure(face, "Parameters", "The constants of the plant.", &face.parameters),
    ];
    let with_parameters = !face.parameters.is_empty();
    let with_inputs = !face.u.is_empty();
    let tail = face.filled(
        TAIL,
        &[
            ("parameters", or(with_parameters, ", parameters: *const Parameters")),
            ("parameters_read", if with_parameters { "(room(observer), read(parameters))" } else { "room(observer)" }),
            ("parameters_names", if with_parameters { "(room, parameters)" } else { "room" }),
            ("parameters_given", or(with_parameters, "&parameters?")),
            ("inputs", or(with_inputs, "    u: *const U,\n")),
            (
                "inputs_read",
                or(with_inputs, "    // SAFETY: the caller promises it.\n    let u = unsafe { read(u) };\n"),
            ),
            ("inputs_names", or(with_inputs, "u, ")),
            ("inputs_given", or(with_inputs, "u?, ")),
            ("y_value", &value("emitted::Y", &face.y, "y")),
            ("u_value", &value("emitted::U", &face.u, "u")),
            ("standard_error", if face.has_standard_error() { STANDARD_ERROR } else { "" }),
        ],
    );
    let text = format!("{head}{}{}{tail}", structures.concat(), faults());
    face.filled(&text, &[("x_value", &value("Self", &face.x, "x"))])
}

impl Face<'_> {
    /// Tests whether the estimator has a covariance.
    pub(super) fn has_standard_error(&self) -> bool {
        let has = |name| mentions(&self.module.tuned, name);
        (has("LeastSquares") || has("AdaptiveLeastSquares")) && !has("Drem") && !has("FiniteTime")
    }

    /// Tests whether the covariance is that of sensors.
    pub(super) fn is_sampled(&self) -> bool {
        mentions(&self.module.tuned, "SampledRegression")
    }
}

/// A structure in the order of C.
fn structure(face: &Face<'_>, name: &str, what: &str, signals: &[Signal]) -> String {
    if signals.is_empty() {
        return String::new();
    }
    let scalar = face.scalar.name();
    let fields = signals.iter().map(|signal| {
        let unit = signal.unit.as_ref().map(|unit| format!(" in {}", unit.replace('\n', " "))).unwrap_or_default();
        format!("    /// `{}`{unit}.\n    pub {}: {scalar},\n", signal.written, signal.rust)
    });
    let fields: String = fields.collect();
    format!("/// {what}\n#[repr(C)]\n#[derive(Clone, Copy)]\npub struct {name} {{\n{fields}}}\n\n")
}

/// A value of a structure from one with the same fields, two levels deep.
fn value(name: &str, signals: &[Signal], from: &str) -> String {
    if signals.is_empty() {
        return name.to_owned();
    }
    let fields: Vec<String> = signals.iter().map(|signal| format!("{0}: {from}.{0}", signal.rust)).collect();
    let line = fields.join(", ");
    if line.len() <= SHORT {
        return format!("{name} {{ {line} }}");
    }
    let lines: String = fields.iter().map(|field| format!("            {field},\n")).collect();
    format!("{name} {{\n{lines}        }}")
}

/// The enumeration of faults, and the runtime's as one of them.
fn faults() -> String {
    let mut text = String::from(
        "/// What a function returns.\n#[repr(C)]\n#[derive(Clone, Copy, Debug, PartialEq, Eq)]\npub enum Fault {\n    \
         /// No fault.\n    Ok = 0,\n",
    );
    for (place, fault) in FAULTS.iter().enumerate() {
        let number = place + 1;
        writeln!(text, "    /// It says: {}.\n    {} = {number},", fault.meaning.replace('\n', " "), fault.rust)
            .expect("a string");
    }
    text.push_str("}\n\nimpl From<pebo_runtime::Fault> for Fault {\n    fn from(fault: pebo_runtime::Fault) -> Self {\n        match fault {\n");
    for fault in FAULTS {
        if let Some(pattern) = fault.of {
            writeln!(text, "            pebo_runtime::Fault::{pattern} => Self::{},", fault.rust).expect("a string");
        }
    }
    text.push_str("            _ => Self::Other,\n        }\n    }\n}\n\n");
    text
}

/// A number in hexadecimal digits, in groups of four.
fn grouped(number: u64) -> String {
    let digits = format!("{number:016x}");
    let groups: Vec<&str> = (0..4).map(|group| &digits[4 * group..4 * group + 4]).collect();
    format!("0x{}", groups.join("_"))
}

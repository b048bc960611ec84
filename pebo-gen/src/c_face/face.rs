//! The crate's root: the functions that the header declares, over the emitted observer.
//!
//! In: the face. Out: Rust in rustfmt's layout, for `std` on hosts and without it where there is no system. A function
//! looks at its pointers and at the tag of the observer, and hands over to the emitted code.

use super::faults::FAULTS;
use super::size::start_name;
use super::subject::{Face, Signal};

const HEAD: &str = include_str!("templates/face_head.rs.in");
const FAULT: &str = include_str!("templates/face_fault.rs.in");
const TAIL: &str = include_str!("templates/face_tail.rs.in");
const STANDARD_ERROR: &str = include_str!("templates/face_standard_error.rs.in");

/// The longest list of fields that rustfmt leaves in one line.
const SHORT: usize = 18;

/// What an observer with limits has besides, what `new` does for them, and `step`.
const LIMITS: [&str; 3] = [
    "    limits: pebo_runtime::Limits<@scalar@, { emitted::NY }, { emitted::NU }>,\n",
    "        let limits = emitted::@type@::limits()?;\n",
    // A number that is not finite is in no range, and the observer refuses it by itself.
    "        let (outputs, inputs) = (SVector::from(y), SVector::from(u));\n        \
     let finite = |values: &[@scalar@]| values.iter().all(|value| value.is_finite());\n        \
     if finite(outputs.as_slice()) && finite(inputs.as_slice()) {\n            \
     match self.limits.check(&outputs, &inputs, period) {\n                \
     // Before the first sample no interval is too long.\n                \
     Err(pebo_runtime::Fault::Gap) if self.tuned.estimate().is_none() => {}\n                \
     checked => checked?,\n            }\n        }\n",
];

/// The same of a gate.
const GATE: [&str; 3] = [
    "    gate: pebo_runtime::Gate<@scalar@>,\n",
    "        let gate = emitted::@type@::gate()?;\n",
    "        let innovation = self.tuned.innovation(y, u, period)?;\n        self.gate.admit(&innovation)?;\n",
];

/// The text of `lib.rs`.
pub(super) fn text(face: &Face<'_>) -> String {
    let module = &face.module;
    let tag = grouped(module.tag);
    let started = if face.is_late() { "tuned.past()" } else { "tuned" };
    let (with_limits, with_gate) = (module.has_limits, module.has_gate);
    let guards = |place: usize| or(with_limits, LIMITS[place]).to_owned() + or(with_gate, GATE[place]);
    let [fields, set, checks] = [0, 1, 2].map(guards);
    let head = face.filled(
        HEAD,
        &[
            ("guard_fields", &fields),
            ("guards_set", &set),
            ("limits_name", or(with_limits, "            limits,\n")),
            ("gate_name", or(with_gate, "            gate,\n")),
            ("guard_checks", &checks),
            ("tag", &tag),
            ("start", start_name(module)),
            ("started", started),
            ("parameters_argument", or(!face.parameters.is_empty(), "parameters: &Parameters")),
            ("parameters_value", &value("emitted::Parameters", &face.parameters, "parameters")),
            ("type", &module.type_name),
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

/// The text where it is wanted.
fn or(wanted: bool, text: &'static str) -> &'static str {
    if wanted { text } else { "" }
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
    let lines = fields.iter().map(|field| format!("            {field},\n")).collect::<Vec<_>>().concat();
    format!("{name} {{\n{lines}        }}")
}

/// The enumeration of faults, and the runtime's as one of them.
fn faults() -> String {
    let numbered = FAULTS
        .iter()
        .zip(1..)
        .map(|(fault, number)| format!("    /// It says: {}.\n    {} = {number},\n", fault.meaning, fault.rust));
    let arms = FAULTS
        .iter()
        .filter_map(|fault| Some(format!("            pebo_runtime::Fault::{} => Self::{},\n", fault.of?, fault.rust)));
    let (numbered, arms) = (numbered.collect::<Vec<_>>().concat(), arms.collect::<Vec<_>>().concat());
    FAULT.replace("@numbered@", &numbered).replace("@arms@", &arms)
}

/// A number in hexadecimal digits, in groups of four.
fn grouped(number: u64) -> String {
    let digits = format!("{number:016x}");
    let groups: Vec<&str> = (0..4).map(|group| &digits[4 * group..4 * group + 4]).collect();
    format!("0x{}", groups.join("_"))
}

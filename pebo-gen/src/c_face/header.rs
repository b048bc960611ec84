//! The header: the only text of the crate that a C programmer reads.
//!
//! In: the face. Out: C99 that C++17 takes too: the plant, the timing of a call, structures in the author's names with
//! their units, faults, and functions with what each does.

use super::faults::FAULTS;
use super::subject::{Face, Signal};

const HEAD: &str = include_str!("templates/header_head.h");
const TAIL: &str = include_str!("templates/header_tail.h");

/// The longest line of a comment behind ` * `.
const WIDTH: usize = 96;

/// The text of the header.
pub(super) fn text(face: &Face<'_>) -> String {
    let plant = plant(face);
    let inputs = face.c_inputs();
    let parameters = face.c_parameters();
    let [output, input] = [&face.y, &face.u].map(|signals| if signals.len() == 1 { "" } else { "s" });
    let held = if face.u.is_empty() {
        String::new()
    } else {
        format!(" * u is the input{input} held DURING the interval since the sample before.\n")
    };
    let head = face.filled(HEAD, &[("plant", &plant), ("output_s", output), ("held", &held)]);
    let structures = [
        structure(face, "y", "The outputs of a sample.", &face.y),
        structure(face, "u", "The inputs of a sample.", &face.u),
        structure(face, "x", "The states that an estimate holds.", &face.x),
        structure(face, "parameters", "The constants of the plant.", &face.parameters),
        values(face),
        faults(face),
    ];
    let limits = match (face.module.has_limits, face.module.has_gate) {
        (true, true) => " *\n * The sample is held against the limits of the model and its gate for outliers first.\n",
        (true, false) => " *\n * The sample is held against the limits of the model first.\n",
        (false, true) => " *\n * The sample is held against the model's gate for outliers first.\n",
        (false, false) => "",
    };
    let error = if face.has_standard_error() { standard_error(face) } else { String::new() };
    let tail = face.filled(
        TAIL,
        &[("inputs", &inputs), ("parameters", &parameters), ("limits", limits), ("standard_error", &error)],
    );
    let structures = structures.into_iter().filter(|text| !text.is_empty());
    format!("{head}{}{tail}", structures.map(|text| text + "\n").collect::<String>())
}

impl Face<'_> {
    /// The argument for the inputs, if there are any.
    fn c_inputs(&self) -> String {
        if self.u.is_empty() { String::new() } else { format!("const {}_u *u, ", self.prefix) }
    }

    /// The argument for the parameters, if there are any.
    fn c_parameters(&self) -> String {
        if self.parameters.is_empty() {
            String::new()
        } else {
            format!(", const {}_parameters *parameters", self.prefix)
        }
    }
}

/// Title and equations of the plant, as lines of a comment.
fn plant(face: &Face<'_>) -> String {
    let plant = face.plant;
    let arena = &plant.arena;
    let mut lines = vec![plant.title.clone().unwrap_or_else(|| plant.name.clone())];
    lines.extend(plant.reference.as_ref().map(|reference| format!("Source: {reference}")));
    let listed = |what: &str, signals: &[Signal]| {
        let names: Vec<&str> = signals.iter().map(|signal| signal.written.as_str()).collect();
        format!("{what} {}", names.join(", "))
    };
    let mut parts = vec![listed("estimated", &face.x), listed("measured", &face.y)];
    parts.extend((!face.u.is_empty()).then(|| listed("input", &face.u)));
    lines.extend([String::new(), format!("The plant: {}.", parts.join("; ")), String::new()]);
    let states = plant.x.iter().map(|state| (state.symbol, Some(state.rate.expr)));
    let outputs = plant.y.iter().map(|output| (output.symbol, output.rate.as_ref().map(|rate| rate.expr)));
    let rates = states.chain(outputs).filter_map(|(symbol, rate)| Some((arena.name(symbol), rate?)));
    lines.extend(rates.map(|(name, rate)| format!("  {name}' = {}", arena.print(rate))));
    let values = plant.y.iter().filter_map(|output| Some((arena.name(output.symbol), output.value?.expr)));
    lines.extend(values.map(|(name, value)| format!("  {name} = {}", arena.print(value))));
    lines.iter().map(|line| comment_line(line)).collect()
}

/// A line of a comment that nothing in it ends.
fn comment_line(text: &str) -> String {
    let safe = safe(text);
    if safe.is_empty() { " *\n".to_owned() } else { format!(" * {safe}\n") }
}

/// A text for a comment, in one line.
fn safe(text: &str) -> String {
    text.replace("*/", "* /").replace("/*", "/ *").replace(['\n', '\r', '\\'], " ").trim_end().to_owned()
}

/// A structure of numbers, if there are any.
fn structure(face: &Face<'_>, name: &str, what: &str, signals: &[Signal]) -> String {
    if signals.is_empty() {
        return String::new();
    }
    let fields = signals.iter().enumerate().map(|(place, signal)| {
        let mut notes: Vec<String> = Vec::new();
        notes.extend((signal.c != signal.written).then(|| format!("`{}` of the model", signal.written)));
        notes.extend(signal.unit.as_ref().map(|unit| format!("in {unit}")));
        let value = face.plant.parameters.get(place).filter(|_| name == "parameters");
        notes.extend(value.and_then(|value| Some(format!("{} in the model", value.text.as_ref()?))));
        let note = if notes.is_empty() { String::new() } else { format!(" /* {} */", safe(&notes.join("; "))) };
        format!("    {} {};{note}\n", face.c_scalar(), signal.c)
    });
    let fields = fields.collect::<Vec<_>>().concat();
    format!("/* {what} */\ntypedef struct {{\n{fields}}} {}_{name};\n", face.prefix)
}

/// The values of the model as an initialiser, if each parameter has one.
fn values(face: &Face<'_>) -> String {
    let values: Option<Vec<f64>> =
        face.plant.parameters.iter().map(|parameter| Some(parameter.value.as_ref()?.to_f64())).collect();
    let Some(values) = values.filter(|values| !values.is_empty()) else { return String::new() };
    let literals: Vec<String> = values.iter().map(|value| face.c_literal(*value)).collect();
    let upper = face.prefix.to_uppercase();
    let name = &face.prefix;
    let lines = wrapped(&literals.join(", "), WIDTH - 8).join(" \\\n        ");
    format!(
        "/* The values of the model: `static const {name}_parameters parameters = {upper}_PARAMETERS;` */\n\
         #define {upper}_PARAMETERS \\\n    {{ \\\n        {lines} \\\n    }}\n"
    )
}

/// Words in lines of a bounded length.
fn wrapped(text: &str, width: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split(' ') {
        match lines.last_mut() {
            Some(line) if line.len() + 1 + word.len() <= width => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}

/// The enumeration of faults.
fn faults(face: &Face<'_>) -> String {
    let upper = face.prefix.to_uppercase();
    let numbered = FAULTS.iter().zip(1..).map(|(fault, number)| {
        let comma = if number == FAULTS.len() { "" } else { "," };
        format!("    /* {} */\n    {upper}_FAULT_{} = {number}{comma}\n", fault.meaning, fault.c)
    });
    let numbered = numbered.collect::<Vec<_>>().concat();
    let kept = match (face.is_late(), face.module.has_gate) {
        (true, _) => "After OUTPUT, INPUT and STEP the observer is as it was before the call",
        (false, true) => "After a fault the observer is as it was before the call, but for the count of outliers",
        (false, false) => "After a fault the observer is as it was before the call, to the last bit",
    };
    format!(
        "/* What a function returns. {kept}. */\ntypedef enum {{\n    {upper}_OK = 0,\n{numbered}}} {}_fault;\n",
        face.prefix
    )
}

/// The function for the standard error.
fn standard_error(face: &Face<'_>) -> String {
    let note = if face.is_sampled() {
        ""
    } else {
        " * It is the covariance of the settings through the estimator, and a standard error as far as\n * that covariance is one.\n"
    };
    face.filled(
        "/*\n * The standard error of each state of the estimate at the last accepted sample.\n@note@ *\n\
         \x20* Faults: POINTER, NOT_SET, NO_ESTIMATE.\n */\n\
         @name@_fault @name@_standard_error(const @name@ *observer, @name@_x *error);\n\n",
        &[("note", note)],
    )
}

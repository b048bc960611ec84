//! The example: a C program that steps the observer over samples and prints its estimates.

use super::samples::Origin;
use super::subject::{Face, Signal};
use crate::emit::Scalar;

const EXAMPLE: &str = include_str!("templates/main.c");

/// The text of `example/main.c`.
pub(super) fn text(face: &Face<'_>) -> String {
    let list = |values: &[f64]| values.iter().map(|value| face.c_literal(*value)).collect::<Vec<_>>().join(", ");
    let rows = face.samples.rows.iter().map(|row| {
        let inputs = if face.u.is_empty() { String::new() } else { format!(", {{{}}}", list(&row.u)) };
        format!("    {{{}, {{{}}}{inputs}}},\n", face.c_literal(row.period), list(&row.y))
    });
    let rows: String = rows.collect();
    let has_parameters = !face.parameters.is_empty();
    let has_values = face.plant.parameters.iter().all(|parameter| parameter.value.is_some());
    let given = if has_values {
        face.filled("@NAME@_PARAMETERS", &[])
    } else {
        format!("{{{}}}", list(&face.samples.parameters))
    };
    let parameters = if has_parameters {
        face.filled("    static const @name@_parameters parameters = @given@;\n", &[("given", &given)])
    } else {
        String::new()
    };
    let or = |wanted: bool, text: &'static str| if wanted { text } else { "" };
    let print = |signal: &Signal| format!("            print(\"{0}\", (double)x.{0});\n", signal.c);
    let prints: String = face.x.iter().map(print).collect();
    let origin = match face.samples.origin {
        Origin::Run => "the closed loop that the model describes, without noise",
        Origin::Domain => "a place of the model's domain, again and again",
    };
    // So many tell all numbers apart.
    let digits = if face.scalar == Scalar::F32 { "9" } else { "17" };
    face.filled(
        EXAMPLE,
        &[
            ("origin", origin),
            ("digits", digits),
            ("rows", &rows),
            ("parameters_value", &parameters),
            ("parameters", or(has_parameters, ", &parameters")),
            ("u_field", or(!face.u.is_empty(), "    @name@_u u;\n")),
            ("u", or(!face.u.is_empty(), "&samples[k].u, ")),
            ("prints", &prints),
        ],
    )
}

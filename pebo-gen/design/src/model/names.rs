//! Names: their syntax, reserved ones, and hints for unknown ones.

use super::formula::greek;
use crate::source::{Code, Diagnostic, Span, listed, nearest, quoted};

/// The name of time in formulas.
pub(super) const TIME: &str = "t";

/// Checks that `text` can be declared as a name; `simulated` if there is a simulation or a recording, in which `t` is
/// time.
pub(super) fn admit(text: &str, span: Span, simulated: bool) -> Result<(), Diagnostic> {
    if !is_identifier(text) {
        return Err(invalid(text, span));
    }
    let meaning = match coordinate(text) {
        Some(meaning) => meaning,
        None if text == TIME && simulated => "time",
        None => return Ok(()),
    };
    let message = format!("`{text}` is reserved for {meaning}");
    let other = match text.find(|character: char| character.is_ascii_digit()) {
        Some(at) => format!("{}_{}", &text[..at], &text[at..]),
        None => format!("{text}_0"),
    };
    let help = if text == TIME {
        format!(
            "if it is the time, remove the declaration, which formulas do not need; if not, choose another name, as `{other}`"
        )
    } else {
        format!("choose another name, as `{other}`")
    };
    Err(Diagnostic::error(Code::ReservedName, span, message).help(help))
}

fn is_identifier(text: &str) -> bool {
    let starts = text.starts_with(|character: char| character.is_ascii_alphabetic() || character == '_');
    // A lone underscore is no identifier in the language that is emitted.
    starts && text != "_" && text.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
}

fn invalid(text: &str, span: Span) -> Diagnostic {
    let message = format!("{} is not a name", quoted(text));
    let diagnostic = Diagnostic::error(Code::InvalidName, span, message);
    let spelled: String =
        text.chars().map(|character| greek(character).map_or_else(|| character.to_string(), str::to_owned)).collect();
    if is_identifier(&spelled) {
        return diagnostic.help(format!("spell it out: `{spelled}`"));
    }
    if !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit()) {
        let decimal = quoted(&format!("0.{text}"));
        return diagnostic.help(format!("if it is the end of a decimal, write that with a point, as {decimal}"));
    }
    let plain: String = text.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect();
    let plain = plain.trim_end_matches('_');
    if is_identifier(plain) {
        return diagnostic.help(format!("write {}: letters, digits and underscores", quoted(plain)));
    }
    diagnostic.help("use ASCII letters, digits and underscores, beginning with a letter")
}

/// The candidate whose derivative `name` looks like, as `i` for `di`, `i'`, `di/dt` and `i_dot`.
pub(crate) fn derivative_of<'a>(name: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    candidates.into_iter().find(|of| {
        let rest = |before: &str, after: &str| {
            name.strip_prefix(before).and_then(|rest| rest.strip_suffix(after)).is_some_and(|rest| rest == *of)
        };
        let marks = [("d", ""), ("D", ""), ("d", "/dt"), ("d", "_dt"), ("d", "dt"), ("", "'"), ("", "′"), ("", "_dot")];
        let words = [("", "dot"), ("dot_", ""), ("dot", ""), ("d_", ""), ("der(", ")"), ("d(", ")/dt")];
        marks.iter().chain(&words).any(|(before, after)| rest(before, after))
    })
}

/// The generator's own meaning of a name.
fn coordinate(name: &str) -> Option<&'static str> {
    let letters = name.trim_end_matches(|character: char| character.is_ascii_digit());
    if letters.len() == name.len() {
        return None;
    }
    match letters {
        "z" => Some("a coordinate"),
        // Beyond nine components a mark separates the row from the column.
        _ if is_entry(letters) => Some("the generalised cascade"),
        "chi" => Some("the dynamic extension"),
        "theta" => Some("an unknown parameter"),
        "xi" | "Psi" => Some("the generalised cascade"),
        _ => None,
    }
}

/// Tests whether the text, without the column's number, is an entry of the fundamental matrix: `Psi10_`.
fn is_entry(text: &str) -> bool {
    let row = text.strip_prefix("Psi").and_then(|rest| rest.strip_suffix('_'));
    row.is_some_and(|row| !row.is_empty() && row.bytes().all(|byte| byte.is_ascii_digit()))
}

/// The diagnostic of a name that is not among the `candidates`, which are known at its span.
pub fn unknown_name<'a>(name: &str, span: Span, candidates: impl IntoIterator<Item = &'a str>) -> Diagnostic {
    let candidates: Vec<&str> = candidates.into_iter().collect();
    let message = format!("unknown name {}", quoted(name));
    let diagnostic = Diagnostic::error(Code::UnknownName, span, message);
    match nearest(name, candidates.iter().copied()) {
        Some(near) => diagnostic.suggest(Some(near)),
        None => diagnostic.help(format!("names known here are {}", listed(candidates))),
    }
}

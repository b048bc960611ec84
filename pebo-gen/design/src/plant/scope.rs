//! Names that a formula may use, with their meanings.

use std::collections::BTreeMap;

use crate::model::derivative_of;
use crate::source::{Code, Diagnostic, Span, nearest};
use pebo_cas::Expr;

/// Names with their meaning, in one section of the model.
#[derive(Clone, Debug, Default)]
pub struct Scope {
    names: BTreeMap<String, Expr>,
    estimates: BTreeMap<String, Expr>,
    /// Declared names that are not permitted here, with the reason.
    barred: BTreeMap<String, String>,
}

impl Scope {
    /// A scope without names.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a name.
    pub fn define(&mut self, name: impl Into<String>, meaning: Expr) {
        self.names.insert(name.into(), meaning);
    }

    /// Adds an estimate `hat(name)`.
    pub fn define_estimate(&mut self, name: impl Into<String>, meaning: Expr) {
        self.estimates.insert(name.into(), meaning);
    }

    /// Names something that exists but may not be used here, and why.
    pub fn bar(&mut self, name: impl Into<String>, reason: impl Into<String>) {
        self.barred.insert(name.into(), reason.into());
    }

    /// The names, for suggestions.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.names.keys().map(String::as_str)
    }

    /// The meaning of the name.
    pub fn look_up(&self, name: &str, span: Span) -> Result<Expr, Diagnostic> {
        if let Some(&meaning) = self.names.get(name) {
            return Ok(meaning);
        }
        if let Some(reason) = self.barred.get(name) {
            return Err(Diagnostic::error(Code::UnknownName, span, format!("`{name}` cannot be used here"))
                .label(reason.clone())
                .help("use only names that are known at this place"));
        }
        Err(unknown(name, span, self.names()))
    }

    /// The meaning of `hat(name)`.
    pub fn look_up_estimate(&self, name: &str, span: Span) -> Result<Expr, Diagnostic> {
        match self.estimates.get(name) {
            Some(&meaning) => Ok(meaning),
            None => Err(unknown(name, span, self.estimates.keys().map(String::as_str))
                .note("hat(..) takes an unmeasured state that the observer estimates")),
        }
    }
}

fn unknown<'a>(name: &str, span: Span, candidates: impl Iterator<Item = &'a str>) -> Diagnostic {
    let diagnostic = Diagnostic::error(Code::UnknownName, span, format!("unknown name `{name}`"))
        .label("not declared in this model");
    let candidates: Vec<&str> = candidates.collect();
    // A similar name is another quantity.
    if let Some(of) = derivative_of(name, candidates.iter().copied()) {
        return diagnostic.help(format!(
            "if it is the derivative of `{of}`, write the formula of that derivative in its place; if not, declare it under \
             `parameters`, `x`, `y`, `u`, `w` or `define`"
        ));
    }
    match nearest(name, candidates) {
        Some(near) => diagnostic.help(format!("did you mean `{near}`?")),
        // A function of time alone has to be measured at each sample: it is an input.
        None if name == "t" => diagnostic.help(
            "the observer knows of time what it is told at each sample, and that is an input: add `time` to `u`, write `time` \
             for `t` in this formula, and `time: t` under `control` of the simulation; the application hands it over with the \
             other inputs. A signal that nobody knows is `w`, with its course in t under `signals`",
        ),
        None => diagnostic.help(
            "declare it: a constant under `parameters`, what is commanded or known under `u`, what is measured under `y`, what \
             is to be estimated under `x`, an unknown signal under `w`, a part of a formula under `define`",
        ),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn time_in_a_plant_is_an_input() {
        let help = |name| unknown(name, Span::default(), ["v", "q"].into_iter()).help.unwrap_or_default();
        assert!(help("t").contains("add `time` to `u`"), "{}", help("t"));
        assert!(help("speed").contains("commanded or known under `u`"), "{}", help("speed"));
    }

    #[test]
    fn a_derivative_is_no_misspelt_state() {
        for name in ["dq", "q'", "q_dot", "dq_dt"] {
            let help = unknown(name, Span::default(), ["v", "q"].into_iter()).help.unwrap_or_default();
            assert!(help.contains("the derivative of `q`"), "{name}: {help}");
        }
    }
}

//! Delays of sensors, as they are written.

use super::formula::Decimal;
use super::section::Value;
use super::spanned::{Entry, Spanned};
use crate::source::Span;

/// Delays of sensors in seconds: one for all outputs, or some outputs' own; no delay where there is neither.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Delay {
    /// The delay of all outputs.
    pub all: Option<Spanned<Decimal>>,
    /// The delays of outputs by name.
    pub each: Vec<Entry<Spanned<Decimal>>>,
}

impl Delay {
    /// The delay of an output, if it has one.
    pub fn of(&self, output: &str) -> Option<&Spanned<Decimal>> {
        let own = self.each.iter().find(|entry| entry.name.value == output).map(|entry| &entry.value);
        own.or(self.all.as_ref())
    }

    /// The span of the first of them.
    pub fn span(&self) -> Option<Span> {
        let first = self.each.first().map(|entry| entry.name.span);
        self.all.as_ref().map(|all| all.span).or(first)
    }

    /// All that are written.
    pub fn written(&self) -> impl Iterator<Item = &Spanned<Decimal>> {
        self.all.iter().chain(self.each.iter().map(|entry| &entry.value))
    }
}

impl Value for Delay {
    fn names(&self) -> Vec<&Spanned<String>> {
        self.each.names()
    }

    fn numbers(&self) -> Vec<&Spanned<Decimal>> {
        self.written().collect()
    }
}

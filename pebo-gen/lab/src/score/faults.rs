//! Counts the samples that an observer refused.

use std::collections::BTreeMap;

use pebo_runtime::Fault;
use serde::Serialize;

/// The numbers of refused samples, by the reason. Serialises to a map from reasons to numbers.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(transparent)]
pub struct Faults(BTreeMap<String, u64>);

/// The names of an observer's outputs and inputs, in their order.
#[derive(Clone, Debug, Default)]
pub(crate) struct SignalNames {
    pub(crate) outputs: Vec<String>,
    pub(crate) inputs: Vec<String>,
}

impl SignalNames {
    /// The fault in words, with the name of its signal.
    pub(crate) fn words(&self, fault: Fault) -> String {
        let (signal, what) = match fault {
            Fault::Output { index } => (self.outputs.get(index), "is not a finite number"),
            Fault::Input { index } => (self.inputs.get(index), "is not a finite number"),
            Fault::OutputRange { index } => (self.outputs.get(index), "is out of range"),
            Fault::InputRange { index } => (self.inputs.get(index), "is out of range"),
            _ => (None, ""),
        };
        signal.map_or_else(|| fault.to_string(), |name| format!("`{name}` {what}"))
    }
}

impl Faults {
    /// Counts a fault of an observer whose signals have these names.
    pub(crate) fn add(&mut self, fault: Fault, names: &SignalNames) {
        *self.0.entry(names.words(fault)).or_default() += 1;
    }

    /// The reasons with their numbers, in the order of the words.
    pub fn iter(&self) -> impl Iterator<Item = (&str, u64)> {
        self.0.iter().map(|(reason, count)| (reason.as_str(), *count))
    }

    /// The total number.
    pub fn count(&self) -> u64 {
        self.0.values().sum()
    }
}

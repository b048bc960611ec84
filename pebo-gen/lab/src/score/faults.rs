//! Counts the samples that an observer refused.

use std::collections::BTreeMap;

use pebo_runtime::Fault;
use serde::Serialize;

/// The numbers of refused samples, by the reason. Serialises to a map from reasons to numbers.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(transparent)]
pub struct Faults(BTreeMap<String, u64>);

impl Faults {
    /// Counts a fault.
    pub(crate) fn add(&mut self, fault: Fault) {
        *self.0.entry(fault.to_string()).or_default() += 1;
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

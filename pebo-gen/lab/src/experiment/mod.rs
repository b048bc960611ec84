//! An experiment: the model's observer and baselines over the samples of a source, and the scores of both.
//!
//! ```text
//! source -> sample -> observer, baselines -> source sets inputs -> errors, scores, excitation, certainty -> next sample
//! ```
//!
//! In: a [`Source`](source::Source), a simulated plant with its sensors or a piece of a recording. Out: the table of values
//! at each sample, and in the end the summary. What differs between the two is in the sources.

pub(crate) mod columns;
pub(crate) mod curves;
pub(crate) mod estimates;
pub(crate) mod follow;
pub(crate) mod formulas;
pub(crate) mod layout;
pub(crate) mod panels;
pub(crate) mod setup;
pub(crate) mod source;

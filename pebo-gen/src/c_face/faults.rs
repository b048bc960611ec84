//! The one table of faults: the runtime's by their names, behind those that the face itself finds.

/// A fault of the enumeration.
pub(super) struct Fault {
    /// Its variant in Rust.
    pub(super) rust: &'static str,
    /// Its name in C, behind `NAME_FAULT_`.
    pub(super) c: &'static str,
    /// The variant of the runtime's fault, as a pattern; none for what the face finds.
    pub(super) of: Option<&'static str>,
    /// Its meaning.
    pub(super) meaning: &'static str,
}

/// A row of the table.
const fn row(rust: &'static str, c: &'static str, of: Option<&'static str>, meaning: &'static str) -> Fault {
    Fault { rust, c, of, meaning }
}

/// The faults in the order of their numbers, from 1. Numbers stay: rows are added at the end.
pub(super) const FAULTS: &[Fault] = &[
    row("Pointer", "POINTER", None, "a pointer is NULL, or not aligned for its type"),
    row(
        "NotSet",
        "NOT_SET",
        None,
        "the memory holds no observer of this model: the function `new` has not been called",
    ),
    row("NoEstimate", "NO_ESTIMATE", None, "no sample was accepted yet, or the standard error has no value"),
    row("Output", "OUTPUT", Some("Output { .. }"), "an output is NaN or infinite: leave the sample out"),
    row("Input", "INPUT", Some("Input { .. }"), "an input is NaN or infinite: leave the sample out"),
    row("OutputRange", "OUTPUT_RANGE", Some("OutputRange { .. }"), "an output is not within the limits of the model"),
    row("InputRange", "INPUT_RANGE", Some("InputRange { .. }"), "an input is not within the limits of the model"),
    row("Step", "STEP", Some("Step"), "the period is not positive and finite"),
    row("Outlier", "OUTLIER", Some("Outlier"), "the sample is too far from what was expected: leave it out"),
    row("Gap", "GAP", Some("Gap"), "too long without a sample: restart, and give the sample again"),
    row("Limits", "LIMITS", Some("Limits"), "a limit of samples is impossible"),
    row("Filter", "FILTER", Some("Filter"), "the bandwidth of the filter is impossible"),
    row("Gain", "GAIN", Some("Gain"), "a gain or a variance is impossible"),
    row("Start", "START", Some("Start"), "the start is not finite"),
    row("Singular", "SINGULAR", Some("Singular"), "the period is too long for the rates of the cascade: restart"),
    row("State", "STATE", Some("State"), "the new state would not be finite: restart, and look at the units"),
    row("Estimate", "ESTIMATE", Some("Estimate"), "the states have no value at this estimate: restart if it persists"),
    row("Parameter", "PARAMETER", Some("Parameter { .. }"), "a parameter is not finite, or not as the proofs assume"),
    row("Constant", "CONSTANT", Some("Constant { .. }"), "a number that is made of parameters is not finite"),
    row("Other", "OTHER", None, "a fault of a later version of the runtime library"),
];

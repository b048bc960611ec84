//! The cause of a loss of digits: the emitted form, the author, or nobody.

/// The cause of a loss of digits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "answer", derive(serde::Serialize), serde(rename_all = "lowercase"))]
#[non_exhaustive]
pub enum Cause {
    /// The emitted form's.
    #[default]
    Form,
    /// The author's: a part of the model's own formulas loses digits there, and these lose as much.
    Model,
    /// Nobody's: the error is a rounding of the value's size elsewhere.
    Small,
}

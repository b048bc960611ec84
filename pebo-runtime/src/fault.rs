//! The reason of a refusal: a fact, small enough to be copied into a log or a status register.

use core::fmt;

use crate::Real;

/// The reason for which a call was refused. Its receiver is then exactly as it was before.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Fault {
    /// An output sample is infinite or NaN.
    Output {
        /// Its place in `y`, from 0.
        index: usize,
    },
    /// An input sample is infinite or NaN.
    Input {
        /// Its place in `u`, from 0.
        index: usize,
    },
    /// An output sample is out of the range that the application set.
    OutputRange {
        /// Its place in `y`, from 0.
        index: usize,
    },
    /// An input sample is out of the range that the application set.
    InputRange {
        /// Its place in `u`, from 0.
        index: usize,
    },
    /// The sample time is not a positive finite number.
    Step,
    /// The sample is further from what was expected of it than the application allows.
    Outlier,
    /// More time has passed since the last accepted sample than the application allows.
    Gap,
    /// A range is empty or the longest time between two samples is not positive.
    Limits,
    /// The filter's `alpha` is not a positive number.
    Filter,
    /// A gain or rate is out of its range, or a gain matrix is not symmetric and positive definite.
    Gain,
    /// The start of the extension or of the estimate, or a shift, is infinite or NaN.
    Start,
    /// A linear system has no unique solution at this step: the step is too long for `Lambda`.
    Singular,
    /// The new state would be infinite or NaN: a function left its domain or a number overflowed.
    State,
    /// The left inverse would give an infinite or NaN estimate.
    Estimate,
    /// A parameter is infinite or NaN, or out of the range that the proofs of the model assume.
    Parameter {
        /// The place of the first condition that does not hold, from 0, among those of the model's `Parameters::check`.
        index: usize,
    },
    /// A number that the model computes from its parameters is infinite or NaN: parameters that each are in their range
    /// nearly cancel in a divisor, or their product is beyond what the floating-point type holds.
    Constant {
        /// Its place, from 0, among the fields of the model that are no parameters.
        index: usize,
    },
}

impl Fault {
    /// Accepts parameters if all these conditions hold.
    ///
    /// # Errors
    /// [`Fault::Parameter`] with the place of the first that does not.
    pub fn of_parameters<const N: usize>(conditions: [bool; N]) -> Result<(), Self> {
        conditions.iter().position(|holds| !holds).map_or(Ok(()), |index| Err(Self::Parameter { index }))
    }

    /// Accepts the constants that a model computed from its parameters if all are finite.
    ///
    /// # Errors
    /// [`Fault::Constant`] with the place of the first that is not.
    pub fn of_constants<R: Real, const N: usize>(constants: [R; N]) -> Result<(), Self> {
        let first = constants.iter().position(|constant| !constant.is_finite());
        first.map_or(Ok(()), |index| Err(Self::Constant { index }))
    }
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Output { index } => write!(f, "output sample {index} is not finite"),
            Self::Input { index } => write!(f, "input sample {index} is not finite"),
            Self::OutputRange { index } => write!(f, "output sample {index} is out of range"),
            Self::InputRange { index } => write!(f, "input sample {index} is out of range"),
            Self::Outlier => f.write_str("the sample is an outlier"),
            Self::Gap => f.write_str("too much time since the last accepted sample"),
            Self::Limits => f.write_str("a range is empty or a time not positive"),
            Self::Step => f.write_str("the sample time is not positive and finite"),
            Self::Filter => f.write_str("the filter's alpha is not positive"),
            Self::Gain => f.write_str("a gain or rate is out of its range, or a gain matrix not positive definite"),
            Self::Start => f.write_str("the start value or shift is not finite"),
            Self::Singular => f.write_str("the extension cannot be advanced by this step: singular system"),
            Self::State => f.write_str("the new state would not be finite"),
            Self::Estimate => f.write_str("the left inverse is not finite here"),
            Self::Parameter { index } => write!(f, "condition {index} of the parameters does not hold"),
            Self::Constant { index } => write!(f, "constant {index} of the model is not finite"),
        }
    }
}

impl core::error::Error for Fault {}

//! Refuses outliers.

use crate::{Fault, Innovation, Real};

/// Refuses outliers: samples whose [normalised square](Innovation::normalised_square) is above a limit.
///
/// With independent sensors and normal errors that square is chi-squared: its mean is the number of rows; with one row
/// it is above 9 in 0.3 %, above 25 in 0.00006 % of all samples.
///
/// After as many refusals in a row as it is patient, the gate believes the samples, and not the model: the next one
/// passes, so that an observer that has lost its state finds it again.
///
/// ```
/// # use pebo_runtime::{Fault, Gate, Innovation, nalgebra::SVector};
/// let mut gate = Gate::new(9.0, 2)?;
/// let innovation = |value: f64| Innovation {
///     value: SVector::from([value]),
///     normalised_square: value * value,
///     determinant: 1.0,
/// };
/// assert_eq!(gate.admit(&innovation(2.0)), Ok(()));
/// assert_eq!(gate.admit(&innovation(4.0)), Err(Fault::Outlier));
/// assert_eq!(gate.admit(&innovation(4.0)), Err(Fault::Outlier));
/// assert_eq!(gate.admit(&innovation(4.0)), Ok(()));
/// # Ok::<(), Fault>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Gate<S: Real> {
    limit: S,
    patience: u32,
    /// Refusals in a row.
    refused: u32,
}

impl<S: Real> Gate<S> {
    /// A gate with a limit of the normalised square, which refuses at most so many samples in a row.
    ///
    /// # Errors
    /// [`Fault::Limits`] unless the limit is positive and finite.
    pub fn new(limit: S, patience: u32) -> Result<Self, Fault> {
        let positive = limit > S::zero() && Real::is_finite(limit);
        if positive { Ok(Self { limit, patience, refused: 0 }) } else { Err(Fault::Limits) }
    }

    /// Lets the sample of this innovation pass, or refuses it.
    ///
    /// # Errors
    /// [`Fault::Outlier`] if not.
    pub fn admit<const NR: usize>(&mut self, innovation: &Innovation<S, NR>) -> Result<(), Fault> {
        if innovation.normalised_square <= self.limit || self.refused >= self.patience {
            self.refused = 0;
            return Ok(());
        }
        self.refused += 1;
        Err(Fault::Outlier)
    }
}

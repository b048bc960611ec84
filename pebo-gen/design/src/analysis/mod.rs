//! The claims of a parameter-estimation-based observer, each with its verdict.
//!
//! ```text
//! Plant -> identities -> cascade -> left inverse -> regression -> identifiability -> Derivation
//! ```
//!
//! Holds after: a proved claim was shown by exact algebra, a refuted one by rational points of the domain, with the
//! same y, u and parameters and rigorous enclosures, or by an exact null vector; every other claim is undecided and
//! gives a reason. `never` (no input and no trajectory identifies the unknowns) means that no rate, no combination of
//! rates, no relation of the transform with the outputs and no identity makes a direction of theta observable.
//!
//! The domain D of a model: where its assumptions and identities hold, for all values of the parameters that keep the
//! signs of those given (one given as 0 is 0, one not given is any), and `f_x`, `f_y` and phi have values, phi also
//! derivatives. Proved: true at every point of D but for those that the listed conditions exclude. Refuted: shown by
//! points of D. The states of the extension and theta are any reals: only the left inverse, and the way back from
//! functions of theta, may have domain conditions on an estimate, and list them. Where no point of D is found, nothing
//! is proved.
//!
//! Domain conditions of formulas are read off the one table of operations ([`pebo_cas::graph::conditions`],
//! [`pebo_cas::graph::function`]), and listed in one place, after all claims (`conditions`).

mod advice;
mod affine;
mod blame;
mod cascade;
mod conditions;
mod derive;
mod design;
mod identifiability;
mod identities;
mod in_z;
mod left_inverse;
mod limited;
mod output_slopes;
mod parameters;
mod pencil;
mod permitted;
mod regression;
mod related_transform;
mod turns;
mod witness;
mod words;

#[cfg(test)]
mod tests;

pub use advice::remark::{Drift, Equilibrium, OperatingPoint, Remarks};
pub use design::{
    AtEstimate, BlindTrajectory, Cascade, Claim, Class, Comparison, Derivation, Determined, Excitation, Fundamental,
    Gram, Identifiability, InputCourses, LeftInverse, Origin, Outcome, Positive, Regression, RegressionKind, Still,
    Trajectories, TrajectoryCondition, UnusedOutput, UnusedReason, Verdict, Witness,
};
pub use identifiability::trajectory::words::on_sides;
pub use in_z::{EquationInZ, LeftSide};
pub use output_slopes::{OutputSlopes, are_affine_in_outputs};
pub use parameters::Sign;
pub use pebo_cas::domain::cells::Side;
pub use related_transform::RelatedTransform;

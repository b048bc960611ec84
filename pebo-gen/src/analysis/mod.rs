//! The claims of a parameter-estimation-based observer, each with its verdict.
//!
//! ```text
//! Plant -> cascade -> left inverse -> regression -> identifiability -> Derivation
//! ```
//!
//! Holds after: what is called proved was shown by exact algebra, what is called refuted by a rational
//! point with a rigorous enclosure or by an exact null vector; everything else is undecided and says why.

mod blame;
mod bounded;
mod cascade;
mod conditions;
mod derive;
mod design;
mod drift;
mod elimination;
mod equilibrium;
mod excitation;
mod gpebo;
mod identifiability;
mod implicit;
mod killing;
mod known;
mod left_inverse;
mod pencil;
mod regression;
mod relations;
mod separation;
mod singular;
mod solve;
mod tidy;

#[cfg(test)]
mod tests;

pub use design::{
    Cascade, Claim, Class, Derivation, Excitation, Fundamental, Gram, Identifiability, LeftInverse, Origin, Outcome,
    Positive, Regression, RegressionKind, Verdict, Witness,
};
pub use drift::{Drift, rebase_residuals};
pub use equilibrium::{Equilibrium, OperatingPoint};

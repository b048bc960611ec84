//! The runtime's observer on a derived model that is interpreted.

pub(crate) mod certainty;
pub(crate) mod design;
pub(crate) mod driver;
pub(crate) mod estimator;
pub(crate) mod excitation;
mod interpreted;
pub(crate) mod operator;
pub(crate) mod padded;
pub(crate) mod request;
pub(crate) mod setup;
pub(crate) mod sizes;
mod uncertainty;

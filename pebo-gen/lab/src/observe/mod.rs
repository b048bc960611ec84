//! The runtime's observer on a derived model that is interpreted.

pub(crate) mod certainty;
pub(crate) mod design;
pub(crate) mod estimator;
pub(crate) mod excitation;
mod monitored;
pub(crate) mod interpreted;
pub(crate) mod request;
pub(crate) mod setup;
pub(crate) mod sizes;
pub(crate) mod stepping;
mod uncertainty;
pub(crate) mod window;

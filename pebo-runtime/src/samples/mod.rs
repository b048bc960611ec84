//! Checks of samples before the observer takes them, and the intervals without one.

mod arrivals;
mod gap;
mod gate;
mod limits;
mod unwrap;

pub use arrivals::{Arrivals, Instant};
pub use gap::Gap;
pub use gate::Gate;
pub use limits::Limits;
pub use unwrap::unwrapped;

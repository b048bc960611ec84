//! One question as JSON in, one answer as JSON out, for a page that has the generator as `WebAssembly`.
//!
//! ```text
//! page -> worker -> room, ask, answer (memory) -> respond -> pebo-gen
//! ```
//!
//! `respond` is all there is: `native` calls it in a native program, so that the two can be compared, and `memory` from a
//! page. The last model is kept as it was derived; what is asked of it next is not derived again.

mod keep;
#[cfg(target_arch = "wasm32")]
mod memory;
mod question;
mod respond;

pub use keep::Kept;
pub use question::Question;
pub use respond::respond;

//! One question as JSON in, one answer as JSON out, for a page that has the generator as `WebAssembly`.
//!
//! ```text
//! page -> worker -> room, ask, answer (memory) -> respond -> pebo-gen
//! ```
//!
//! `respond` is all there is: `memory` calls it in a page, and `native` in a native program, so that the two can be
//! compared. The last model is kept as it was derived; what is asked of it next is not derived again.

mod keep;
mod memory;
mod question;
mod respond;

//! One question as JSON in, one answer as JSON out, for a page that has the generator as `WebAssembly`.
//!
//! ```text
//! page -> worker -> room, ask, answer (memory) -> respond -> pebo-gen
//! ```
//!
//! `respond` is all there is: `memory` calls it in a page, and `native` in a native program, so that the two can be
//! compared. The last model is kept with its derivation, so that the next question about it derives nothing.

mod cache;
mod memory;
mod question;
mod respond;

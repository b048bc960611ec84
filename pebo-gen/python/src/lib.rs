//! The generator as a module of Python.
//!
//! ```text
//! pebo (Python) -> call (source, limit, interrupts) -> pebo-gen -> JSON and columns of numbers -> pebo (Python)
//! ```
//!
//! In: a model as bytes, settings, a limit. Out: the library's answer as it serialises, with its diagnostics rendered;
//! of a run the table of its signals too. The package `pebo` around it, in `python/`, makes texts of keywords, objects
//! of the JSON and `NumPy` arrays of the columns; all facts are the library's. Calculations release the interpreter's
//! lock and end at Ctrl-C.

mod call;
mod outcome;
mod program;
mod request;
mod table;

use pyo3::prelude::*;

/// The functions that the package `pebo` calls.
#[pymodule]
mod _pebo {
    #[pymodule_export]
    use super::program::program;
    #[pymodule_export]
    use super::request::{certificate, check, code, page, replay, simulate};
    use super::{Bound, PyModule, PyModuleMethods, PyResult, Section};

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("VERSION", env!("CARGO_PKG_VERSION"))?;
        module.add("STYLE", Section::STYLE)
    }
}

use pebo_gen::Section;

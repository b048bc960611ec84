//! The program `pebo-gen`, which the wheel brings along.

use std::ffi::OsString;

use pyo3::prelude::*;

/// Runs the command of a call, whose first argument is the program's name, and gives its exit status.
#[pyfunction]
pub(super) fn program(py: Python<'_>, call: Vec<OsString>) -> u8 {
    py.detach(|| pebo_gen::cli::run(call) as u8)
}

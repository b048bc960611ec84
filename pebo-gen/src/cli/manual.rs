//! Descriptions of the command line for shells, for `man` and for programs.

use crate::Standing;
use clap::CommandFactory as _;

use super::arguments::{Arguments, CompletionsOptions, SchemaName, SchemaOptions};
use super::standard;

pub(super) fn completions(options: &CompletionsOptions) -> Standing {
    let mut script = Vec::new();
    clap_complete::generate(options.shell, &mut Arguments::command(), "pebo-gen", &mut script);
    standard::print(&script)
}

pub(super) fn page() -> Standing {
    let mut page = Vec::new();
    match clap_mangen::Man::new(Arguments::command()).render(&mut page) {
        Ok(()) => standard::print(&page),
        Err(error) => standard::refuse(standard::unwritten(&error)),
    }
}

pub(super) fn schema(options: &SchemaOptions) -> Standing {
    match options.of {
        SchemaName::Check => standard::print(crate::report::CHECK_SCHEMA.as_bytes()),
        SchemaName::Solve => standard::print(crate::report::SOLVE_SCHEMA.as_bytes()),
        SchemaName::Model => standard::print(crate::model::json_schema().as_bytes()),
    }
}

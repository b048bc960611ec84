//! README.md and the manual in docs/ are true: models, commands with their output, Rust, tables, links.
//!
//! The first words behind the fence of a block tell its kind:
//!
//! | fence | kind | test |
//! |---|---|---|
//! | `yaml NAME.yaml` | a model file, which the commands behind it can name | it is accepted |
//! | `yaml NAME.yaml refused` | one that is not accepted | it is refused |
//! | `yaml NAME.yaml with` | keys that replace those of the file so far, or come behind them | the file is accepted |
//! | `yaml` | a part of a model file | a shipped model, or one on the page, has it |
//! | `console` | commands behind `$ `, each with its output | it succeeds with that output; a line `...` matches any number of lines |
//! | `console refused` | the same, of commands that fail | they fail |
//! | `sh` | commands that build or install | CI runs them, or `commands::BY_HAND` has them |
//! | `rust` | a part of a program | code that is compiled has it |
//! | `toml` | dependencies of a crate beside a checkout named `pebo` | Cargo resolves them |
//! | `c` | a part of a C program or of a header | a command of the page wrote a file that has it |
//! | `pycon` | a session of Python with its output | `pebo-gen/python/tests/test_manual.py` runs it |
//! | `csv` | a part of a recording | a recording below models/ has it |
//! | `text` | a diagram or formulas | nothing |
//! | `text PATH` | a file of the project | it is that file |
//!
//! A figure that a command of a page draws is the one of that name that the page shows.
//!
//! Between `<!-- generated: NAME -->` and `<!-- end -->` a page has the text of `generated`. `UPDATE_DOCS=1 cargo test
//! -p pebo-gen --test manual` writes that and the output of commands anew; outputs with a line `...` are left alone.
#![cfg(all(feature = "cli", feature = "simulate", unix))]

mod blocks;
mod commands;
mod generated;
mod links;
mod page;

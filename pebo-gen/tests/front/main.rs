//! What stands between the generator and its users: the whole answer as a value, the command line, explanations, schemas.

mod answer;
mod certificate;
mod cli;
mod explain;
mod page;
mod replay;
mod schema;

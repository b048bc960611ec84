//! The generator's front ends: the whole answer as a value, the command line, explanations, schemas.

mod answer;
mod c_face;
mod certificate;
mod cli;
mod explain;
mod page;
mod replay;
mod schema;

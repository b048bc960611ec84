//! The scalar's functions.

mod double;
mod real;
mod single;

//! Known numbers in, settings out.

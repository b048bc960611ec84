//! Values of the symbols that are solved for.

use std::collections::BTreeMap;

use crate::graph::expr::{Expr, Symbol};

/// Values of symbols, in those that are free.
pub(super) type Values = BTreeMap<Symbol, Expr>;

//! Handles and nodes of the expression graph.
//!
//! An [`Expr`] is a copyable index into an [`Arena`](crate::Arena). Two handles of one arena are
//! equal exactly if the expressions are the same after construction, and a child's handle is always
//! smaller than its parent's: sorting handles is a topological order.

use std::rc::Rc;

use super::function::Function;
use crate::Rational;

/// An expression: an index into the arena that made it.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct Expr(pub(crate) u32);

/// A symbol: a variable or an unnamed constant. Its name serves printing, not identity.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct Symbol(pub(crate) u32);

impl Symbol {
    /// The position in the order of first use, for tables indexed by symbol.
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// A node of the graph. Cloning is cheap: the operand lists are shared.
#[derive(Clone, PartialEq, Eq, Hash, Debug)]
pub enum Node {
    /// An exact rational number.
    Number(Rational),
    /// The circle constant.
    Pi,
    /// A symbol.
    Symbol(Symbol),
    /// A sum of at least two summands.
    Sum(Rc<Sum>),
    /// A product that is neither a number nor a bare expression.
    Product(Rc<Product>),
    /// A function of the table applied to its arguments.
    Call(Function, Rc<[Expr]>),
}

/// `constant + sum of coefficient * term`: terms ascending, none a number, a sum or a scaled
/// product, no coefficient zero.
#[derive(Clone, PartialEq, Eq, Hash, Debug)]
pub struct Sum {
    /// The summand free of any term.
    pub constant: Rational,
    /// Terms with their coefficients.
    pub terms: Vec<(Expr, Rational)>,
}

/// `coefficient * product of base ^ exponent`: bases ascending, exponents non-zero.
///
/// A base that is a number carries a proper fraction as its exponent, or is a zero under a negative
/// exponent, which stands for a value that does not exist. A power with a fractional exponent is the
/// positive real one and exists for non-negative bases only.
#[derive(Clone, PartialEq, Eq, Hash, Debug)]
pub struct Product {
    /// The rational factor.
    pub coefficient: Rational,
    /// Bases with their exponents.
    pub factors: Vec<(Expr, Rational)>,
}

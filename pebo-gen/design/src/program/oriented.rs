//! Takes signs out of named values, so that a value and its opposite have one name.
//!
//! In: an expression. Out: the same without its overall minus.

use pebo_cas::{Arena, Expr, Node, Rational};

/// A value without its overall minus, and true if it has one: of a product, those of all its factors.
pub(super) fn oriented(arena: &Arena, value: Expr) -> (bool, Expr) {
    let minus = Rational::from(-1);
    let all_negative = |expr: Expr| match arena.node(expr) {
        Node::Sum(sum) => {
            sum.terms.iter().all(|term| term.1.is_negative()) && (sum.constant.is_zero() || sum.constant.is_negative())
        }
        _ => false,
    };
    let Node::Product(product) = arena.node(value) else {
        let is_negative = all_negative(value);
        return (is_negative, if is_negative { arena.scale(value, &minus) } else { value });
    };
    let mut is_negative = product.coefficient.is_negative();
    let factors: Vec<(Expr, Rational)> = product
        .factors
        .iter()
        .map(|(base, exponent)| {
            let is_odd = exponent.is_integer() && exponent.numerator().trailing_zeros() == 0;
            if is_odd && all_negative(*base) {
                is_negative = !is_negative;
                return (arena.scale(*base, &minus), exponent.clone());
            }
            (*base, exponent.clone())
        })
        .collect();
    (is_negative, arena.multiply(&product.coefficient.abs(), factors))
}

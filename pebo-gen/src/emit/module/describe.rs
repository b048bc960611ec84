//! Telling names for constants of the parameters: `g_over_c4` for G/C4.
//!
//! In: a formula. Out: a name, if there is a short one that describes the formula.

use std::collections::BTreeMap;

use crate::emit::names::LONGEST;
use pebo_cas::{Arena, Expr, Integer, Node, Product, Sum, Symbol};

/// A name for the value of the formula, made of the parameters' names.
pub(in crate::emit) fn describe(arena: &Arena, expr: Expr, names: &BTreeMap<Symbol, String>) -> Option<String> {
    let text = match arena.node(expr) {
        Node::Symbol(symbol) => names.get(&symbol)?.clone(),
        Node::Call(function, arguments) if arguments.len() == 1 => {
            format!("{}_{}", function.row().rust, describe(arena, arguments[0], names)?)
        }
        Node::Sum(sum) => describe_sum(arena, &sum, names)?,
        Node::Product(product) if product.coefficient.is_negative() => {
            format!("minus_{}", describe(arena, arena.neg(expr), names)?)
        }
        Node::Product(product) => describe_product(arena, &product, names)?,
        Node::Number(_) | Node::Pi | Node::Call(..) => return None,
    };
    (text.len() <= LONGEST).then_some(text)
}

/// `ld_minus_lq`, `one_plus_k`: two summands, the first without a minus.
fn describe_sum(arena: &Arena, sum: &Sum, names: &BTreeMap<Symbol, String>) -> Option<String> {
    let mut summands: Vec<(String, bool)> = Vec::new();
    if sum.constant.is_one() {
        summands.push(("one".to_owned(), false));
    } else if !sum.constant.is_zero() {
        return None;
    }
    for (term, coefficient) in &sum.terms {
        if !coefficient.abs().is_one() {
            return None;
        }
        summands.push((describe(arena, *term, names)?, coefficient.is_negative()));
    }
    summands.sort_by_key(|summand| summand.1);
    match summands.as_slice() {
        [(a, false), (b, false)] => Some(format!("{a}_plus_{b}")),
        [(a, false), (b, true)] => Some(format!("{a}_minus_{b}")),
        _ => None,
    }
}

/// `inv_c2`, `g_over_c4`, `two_l1`.
fn describe_product(arena: &Arena, product: &Product, names: &BTreeMap<Symbol, String>) -> Option<String> {
    let mut above: Vec<String> = word(&product.coefficient.numerator())?;
    let mut below: Vec<String> = word(&product.coefficient.denominator())?;
    for (base, exponent) in &product.factors {
        let name = describe(arena, *base, names)?;
        let power = match exponent.abs().to_string().as_str() {
            "1" => name,
            "2" => format!("{name}_squared"),
            "1/2" => format!("sqrt_{name}"),
            _ => return None,
        };
        if exponent.is_negative() { below.push(power) } else { above.push(power) }
    }
    Some(match (above.is_empty(), below.is_empty()) {
        (true, _) => format!("inv_{}", below.join("_")),
        (false, true) => above.join("_"),
        (false, false) => format!("{}_over_{}", above.join("_"), below.join("_")),
    })
}

/// The words of a small number; none for one, which goes without saying.
fn word(number: &Integer) -> Option<Vec<String>> {
    let word = match number.to_i64()? {
        1 => return Some(Vec::new()),
        2 => "two",
        3 => "three",
        4 => "four",
        _ => return None,
    };
    Some(vec![word.to_owned()])
}

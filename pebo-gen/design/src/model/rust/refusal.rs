//! Diagnostics for Rust that has no meaning in a model.

use proc_macro2::Ident;
use quote::ToTokens;
use syn::{BinOp, Expr, Macro, Pat, Type};

use super::spans::Places;
use super::value::Field;
use crate::model::names::unknown_name;
use crate::source::{Code, Diagnostic, Span};

/// Rust that has no meaning in a model.
pub(super) fn unsupported(place: Span, message: impl Into<Box<str>>) -> Diagnostic {
    Diagnostic::error(Code::UnsupportedRust, place, message)
}

/// An expression of a kind that formulas do not have.
pub(super) fn expression(expr: &Expr, places: &mut Places) -> Diagnostic {
    match expr {
        Expr::If(e) => control_flow(&e.if_token, "if", places),
        Expr::Match(e) => control_flow(&e.match_token, "match", places),
        Expr::While(e) => repetition(&e.while_token, "while", places),
        Expr::ForLoop(e) => repetition(&e.for_token, "for", places),
        Expr::Loop(e) => repetition(&e.loop_token, "loop", places),
        Expr::Closure(e) => {
            let place = places.of(e);
            unsupported(place, "a formula cannot contain a closure").help("write a function in the module, and call it")
        }
        Expr::Try(e) => control_flow(&e.question_token, "?", places),
        Expr::Return(e) => unsupported(places.of(&e.return_token), "`return` stands in the middle of a function")
            .help("end the function with the expression that it returns"),
        Expr::Macro(e) => macro_call(&e.mac, places),
        Expr::Assign(e) => assignment(&e.eq_token, places),
        Expr::Unsafe(e) => unsupported(places.of(&e.unsafe_token), "a formula cannot contain unsafe code")
            .help("compute it with safe operations"),
        Expr::Range(e) => unsupported(places.of(e), "a range is not a number").help("write each component by itself"),
        Expr::Lit(e) => {
            unsupported(places.of(e), "this literal is not a decimal number").help("write a decimal, as 12.0 or 22e-6")
        }
        other => unsupported(places.of(other), "a formula cannot contain this expression")
            .help("use + - * /, calls, fields and `let`"),
    }
}

/// An operator that formulas do not have.
pub(super) fn operator(op: &BinOp, places: &mut Places) -> Diagnostic {
    let place = places.of(op);
    match op {
        BinOp::BitXor(_) => unsupported(place, "`^` is not a power in Rust")
            .label("in Rust it is the exclusive or of the bits")
            .help("write `a.powi(2)` for a square, `a.powf(0.5)` for a root"),
        BinOp::Rem(_) => unsupported(place, "a remainder is not analytic")
            .help("declare a state that is an angle by `angles(q = 2.0 * PI)` in the attribute"),
        BinOp::Lt(_) | BinOp::Le(_) | BinOp::Gt(_) | BinOp::Ge(_) | BinOp::Eq(_) | BinOp::Ne(_) => {
            unsupported(place, "a formula cannot contain a comparison")
                .help("state what holds wherever the plant operates in the attribute: `assume(L > 0)`")
        }
        BinOp::AddAssign(_) | BinOp::SubAssign(_) | BinOp::MulAssign(_) | BinOp::DivAssign(_) => assignment(op, places),
        _ => unsupported(place, format!("`{}` is not an operator of formulas", op.to_token_stream()))
            .help("use + - * / and `.powi(n)`"),
    }
}

/// A statement that is no `let`.
pub(super) fn statement(expr: &Expr, places: &mut Places) -> Diagnostic {
    match expr {
        Expr::Binary(binary) => operator(&binary.op, places),
        Expr::If(_)
        | Expr::Match(_)
        | Expr::While(_)
        | Expr::ForLoop(_)
        | Expr::Loop(_)
        | Expr::Return(_)
        | Expr::Macro(_)
        | Expr::Assign(_)
        | Expr::Unsafe(_)
        | Expr::Try(_) => expression(expr, places),
        other => {
            unsupported(places.of(other), "this statement does nothing").help("bind its value with `let`, or remove it")
        }
    }
}

pub(super) fn control_flow(token: &impl ToTokens, what: &str, places: &mut Places) -> Diagnostic {
    unsupported(places.of(token), format!("a formula cannot contain `{what}`"))
        .label("f_x, f_y and phi must be one formula for all states")
        .help("write one smooth formula; where only one case occurs, say which in the attribute: `assume(i > 0)`")
}

fn repetition(token: &impl ToTokens, what: &str, places: &mut Places) -> Diagnostic {
    unsupported(places.of(token), format!("a formula cannot contain `{what}` loop"))
        .help("write the terms out one by one")
}

pub(super) fn mutable(token: &impl ToTokens, places: &mut Places) -> Diagnostic {
    unsupported(places.of(token), "names in formulas cannot change their values")
        .help("remove `mut`, and bind new values to new names")
}

fn assignment(token: &impl ToTokens, places: &mut Places) -> Diagnostic {
    unsupported(places.of(token), "names in formulas cannot change their values")
        .help("bind the new value: `let a = a + b;`")
}

pub(super) fn macro_call(call: &Macro, places: &mut Places) -> Diagnostic {
    unsupported(places.of(&call.path), format!("the macro `{}!` is not known here", Places::path(&call.path)))
        .label("models are read before macros in them are expanded")
        .help("write out what it stands for; checks belong into tests")
}

pub(super) fn pattern(pattern: &Pat, places: &mut Places) -> Diagnostic {
    unsupported(places.of(pattern), "this pattern does not fit its value")
        .help("use a name, `X { i1, i3 }`, `[a, b]` or `(a, b)` with as many parts as the value has")
}

pub(super) fn no_field(name: &Ident, fields: &[Field], places: &mut Places) -> Diagnostic {
    let place = places.of(name);
    unknown_name(&name.to_string(), place, fields.iter().map(|field| field.name.value.as_str()))
}

pub(super) fn not_a_number(ty: &Type, places: &mut Places) -> Diagnostic {
    unsupported(places.of(ty), "a signal is one floating-point number")
        .help("use `f64`, or `f32` everywhere; write the entries of a vector as fields of their own")
}

/// An integer where Rust computes with integers.
pub(super) fn integer(expr: &Expr, places: &mut Places) -> Diagnostic {
    let place = places.of(expr);
    let text = places.text(place);
    unsupported(place, "an integer stands among floating-point numbers")
        .label("Rust divides integers without a fraction: 1 / 2 is 0")
        .help(format!("write `{text}.0`"))
}

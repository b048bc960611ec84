//! Diagnostics for Rust that has no meaning in a model.

use proc_macro2::Ident;
use quote::ToTokens;
use syn::{BinOp, Expr, Macro, Pat, Type};

use super::spans::TokenSpans;
use super::value::Field;
use crate::model::names::unknown_name;
use crate::source::{Code, Diagnostic, Span};

/// Rust that has no meaning in a model.
pub(super) fn unsupported(place: Span, message: impl Into<Box<str>>) -> Diagnostic {
    Diagnostic::error(Code::UnsupportedRust, place, message)
}

/// An expression of a kind that formulas do not have.
pub(super) fn expression(expr: &Expr, spans: &mut TokenSpans) -> Diagnostic {
    match expr {
        Expr::If(e) => control_flow(&e.if_token, "if", spans),
        Expr::Match(e) => control_flow(&e.match_token, "match", spans),
        Expr::While(e) => repetition(&e.while_token, "while", spans),
        Expr::ForLoop(e) => repetition(&e.for_token, "for", spans),
        Expr::Loop(e) => repetition(&e.loop_token, "loop", spans),
        Expr::Closure(e) => {
            let place = spans.of(e);
            unsupported(place, "a formula cannot contain a closure").help("write a function in the module, and call it")
        }
        Expr::Try(e) => control_flow(&e.question_token, "?", spans),
        Expr::Return(e) => unsupported(spans.of(&e.return_token), "`return` stands in the middle of a function")
            .help("end the function with the expression that it returns"),
        Expr::Macro(e) => macro_call(&e.mac, spans),
        Expr::Assign(e) => assignment(&e.eq_token, spans),
        Expr::Unsafe(e) => unsupported(spans.of(&e.unsafe_token), "a formula cannot contain unsafe code")
            .help("compute it with safe operations"),
        Expr::Range(e) => unsupported(spans.of(e), "a range is not a number").help("write each component by itself"),
        Expr::Lit(e) => {
            unsupported(spans.of(e), "this literal is not a decimal number").help("write a decimal, as 12.0 or 22e-6")
        }
        other => unsupported(spans.of(other), "a formula cannot contain this expression")
            .help("use + - * /, calls, fields and `let`"),
    }
}

/// An operator that formulas do not have.
pub(super) fn operator(op: &BinOp, spans: &mut TokenSpans) -> Diagnostic {
    let place = spans.of(op);
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
        BinOp::AddAssign(_) | BinOp::SubAssign(_) | BinOp::MulAssign(_) | BinOp::DivAssign(_) => assignment(op, spans),
        _ => unsupported(place, format!("`{}` is not an operator of formulas", op.to_token_stream()))
            .help("use + - * / and `.powi(n)`"),
    }
}

/// A statement that is no `let`.
pub(super) fn statement(expr: &Expr, spans: &mut TokenSpans) -> Diagnostic {
    match expr {
        Expr::Binary(binary) => operator(&binary.op, spans),
        Expr::If(_)
        | Expr::Match(_)
        | Expr::While(_)
        | Expr::ForLoop(_)
        | Expr::Loop(_)
        | Expr::Return(_)
        | Expr::Macro(_)
        | Expr::Assign(_)
        | Expr::Unsafe(_)
        | Expr::Try(_) => expression(expr, spans),
        other => {
            unsupported(spans.of(other), "this statement does nothing").help("bind its value with `let`, or remove it")
        }
    }
}

pub(super) fn control_flow(token: &impl ToTokens, what: &str, spans: &mut TokenSpans) -> Diagnostic {
    unsupported(spans.of(token), format!("a formula cannot contain `{what}`"))
        .label("f_x, f_y and phi must be one formula for all states")
        .help("write one smooth formula; where only one case occurs, say which in the attribute: `assume(i > 0)`")
}

fn repetition(token: &impl ToTokens, what: &str, spans: &mut TokenSpans) -> Diagnostic {
    unsupported(spans.of(token), format!("a formula cannot contain `{what}` loop"))
        .help("write the terms out one by one")
}

pub(super) fn mutable(token: &impl ToTokens, spans: &mut TokenSpans) -> Diagnostic {
    unsupported(spans.of(token), "names in formulas cannot change their values")
        .help("remove `mut`, and bind new values to new names")
}

fn assignment(token: &impl ToTokens, spans: &mut TokenSpans) -> Diagnostic {
    unsupported(spans.of(token), "names in formulas cannot change their values")
        .help("bind the new value: `let a = a + b;`")
}

pub(super) fn macro_call(call: &Macro, spans: &mut TokenSpans) -> Diagnostic {
    unsupported(spans.of(&call.path), format!("the macro `{}!` is not known here", TokenSpans::path(&call.path)))
        .label("models are read before macros in them are expanded")
        .help("write out what it stands for; checks belong into tests")
}

pub(super) fn pattern(pattern: &Pat, spans: &mut TokenSpans) -> Diagnostic {
    unsupported(spans.of(pattern), "this pattern does not fit its value")
        .help("use a name, `X { i1, i3 }`, `[a, b]` or `(a, b)` with as many parts as the value has")
}

pub(super) fn no_field(name: &Ident, fields: &[Field], spans: &mut TokenSpans) -> Diagnostic {
    let place = spans.of(name);
    unknown_name(&name.to_string(), place, fields.iter().map(|field| field.name.value.as_str()))
}

pub(super) fn not_a_number(ty: &Type, spans: &mut TokenSpans) -> Diagnostic {
    unsupported(spans.of(ty), "a signal is one floating-point number")
        .help("use `f64`, or `f32` everywhere; write the entries of a vector as fields of their own")
}

/// An integer where Rust computes with integers.
pub(super) fn integer(expr: &Expr, spans: &mut TokenSpans) -> Diagnostic {
    let place = spans.of(expr);
    let text = spans.text(place);
    unsupported(place, "an integer stands among floating-point numbers")
        .label("Rust divides integers without a fraction: 1 / 2 is 0")
        .help(format!("write `{text}.0`"))
}

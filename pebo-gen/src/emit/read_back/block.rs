//! Emitted functions, interpreted as algebra: statements in order, then the last expression.

use syn::{ImplItem, Pat, Stmt};

use super::value::{Scope, Value, expression, unreadable};
use crate::emit::error::EmitError;
use pebo_cas::Arena;

/// The value of a function: its statements in order, then its last expression.
pub(in crate::emit) fn body(arena: &Arena, function: &syn::ImplItemFn, scope: Scope) -> Result<Value, EmitError> {
    let (last, scope) = statements(arena, function, scope)?;
    expression(arena, last, &scope)
}

/// The last expression of a function, and the names that its statements bind before.
pub(in crate::emit) fn statements<'a>(
    arena: &Arena,
    function: &'a syn::ImplItemFn,
    mut scope: Scope,
) -> Result<(&'a syn::Expr, Scope), EmitError> {
    let (last, statements) = function.block.stmts.split_last().ok_or_else(|| unreadable(&function.sig))?;
    for statement in statements {
        let Stmt::Local(local) = statement else {
            return Err(unreadable(statement));
        };
        let Some(init) = &local.init else {
            return Err(unreadable(statement));
        };
        let value = expression(arena, &init.expr, &scope)?;
        scope.bind(&local.pat, value)?;
    }
    match last {
        Stmt::Expr(value, None) => Ok((value, scope)),
        other => Err(unreadable(other)),
    }
}

/// The function of an implementation that has one.
pub(in crate::emit) fn only_function(item: &syn::ItemImpl) -> Result<&syn::ImplItemFn, EmitError> {
    match item.items.as_slice() {
        [ImplItem::Fn(function)] => Ok(function),
        _ => Err(unreadable(item)),
    }
}

/// The name that a pattern binds.
pub(in crate::emit) fn name_of(pattern: &Pat) -> Result<String, EmitError> {
    match pattern {
        Pat::Ident(ident) => Ok(ident.ident.to_string()),
        _ => Err(unreadable(pattern)),
    }
}

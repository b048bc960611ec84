//! Statements and patterns.

use syn::ext::IdentExt as _;
use syn::{Block, Expr, Pat, Stmt};

use super::evaluate::Reader;
use super::refusal::{self, unsupported};
use super::value::{Locals, Value};
use crate::source::Diagnostic;

impl Reader<'_> {
    /// The value of a block: `let`s, and an expression at its end.
    pub(super) fn block(&mut self, block: &Block, locals: &mut Locals) -> Result<Value, Diagnostic> {
        let outer = locals.len();
        let value = self.statements(block, locals);
        locals.truncate(outer);
        value
    }

    fn statements(&mut self, block: &Block, locals: &mut Locals) -> Result<Value, Diagnostic> {
        let Some((last, before)) = block.stmts.split_last() else {
            return Err(unsupported(self.spans.of(block), "there is no value here")
                .help("end the function with the expression that it returns"));
        };
        for statement in before {
            self.bind_statement(statement, locals)?;
        }
        match last {
            Stmt::Expr(Expr::Return(returned), _) => match &returned.expr {
                Some(value) => self.value(value, locals),
                None => Err(unsupported(self.spans.of(returned), "nothing is returned here")
                    .help("return the value that the function promises")),
            },
            Stmt::Expr(value, None) => self.value(value, locals),
            other => {
                // The diagnostic of another statement comes first.
                self.bind_statement(other, locals)?;
                Err(unsupported(self.spans.of(other), "the function ends without a value")
                    .help("end it with the expression that it returns, without a semicolon"))
            }
        }
    }

    fn bind_statement(&mut self, statement: &Stmt, locals: &mut Locals) -> Result<(), Diagnostic> {
        let local = match statement {
            Stmt::Local(local) => local,
            Stmt::Expr(expr, _) => return Err(refusal::statement(expr, self.spans)),
            Stmt::Item(item) => {
                return Err(unsupported(self.spans.of(item), "an item inside a function")
                    .help("move it out of the function, into the module"));
            }
            Stmt::Macro(call) => return Err(refusal::macro_call(&call.mac, self.spans)),
        };
        let Some(init) = &local.init else {
            return Err(unsupported(self.spans.of(local), "a name without a value")
                .help("give it its value where it is declared: `let a = ..;`"));
        };
        if let Some((_, diverge)) = &init.diverge {
            return Err(refusal::control_flow(diverge, "let .. else", self.spans));
        }
        let value = self.value(&init.expr, locals)?;
        self.bind(&local.pat, value, locals)
    }

    /// Gives the names of a pattern their values.
    pub(super) fn bind(&mut self, pattern: &Pat, value: Value, locals: &mut Locals) -> Result<(), Diagnostic> {
        match (pattern, value) {
            (Pat::Ident(name), value) if name.subpat.is_none() => {
                if let Some(mutable) = &name.mutability {
                    return Err(refusal::mutable(mutable, self.spans));
                }
                locals.push((name.ident.unraw().to_string(), value));
                Ok(())
            }
            (Pat::Wild(_), _) => Ok(()),
            (Pat::Paren(inner), value) => self.bind(&inner.pat, value, locals),
            (Pat::Type(typed), value) => self.bind(&typed.pat, value, locals),
            (Pat::Reference(inner), value) => self.bind(&inner.pat, value, locals),
            (Pat::Struct(shape), Value::Record(fields)) => {
                for part in &shape.fields {
                    let syn::Member::Named(name) = &part.member else {
                        return Err(refusal::pattern(pattern, self.spans));
                    };
                    let wanted = name.unraw().to_string();
                    match fields.iter().find(|field| field.name.value == wanted) {
                        Some(field) => self.bind(&part.pat, field.value.clone(), locals)?,
                        None => return Err(refusal::no_field(name, &fields, self.spans)),
                    }
                }
                Ok(())
            }
            (Pat::Slice(syn::PatSlice { elems, .. }) | Pat::Tuple(syn::PatTuple { elems, .. }), Value::List(items))
                if elems.len() == items.len() =>
            {
                elems.iter().zip(items).try_for_each(|(pattern, item)| self.bind(pattern, item, locals))
            }
            _ => Err(refusal::pattern(pattern, self.spans)),
        }
    }
}

//! The items of a module that concern its model.

use syn::ext::IdentExt as _;
use syn::{Attribute, Expr, Fields, Item, ItemConst, ItemFn, ItemMod, ItemStruct, ItemType, Type};

use super::imports::Imports;
use super::refusal::{self, unsupported};
use super::spans::TokenSpans;
use crate::model::spanned::Spanned;
use crate::source::{Diagnostic, Diagnostics};

/// The items of the module; those of other kinds are the author's own affair.
pub(super) struct Items<'a> {
    pub(super) constants: Vec<&'a ItemConst>,
    pub(super) functions: Vec<&'a ItemFn>,
    pub(super) structs: Vec<&'a ItemStruct>,
    aliases: Vec<&'a ItemType>,
    pub(super) imports: Imports,
}

impl<'a> Items<'a> {
    pub(super) fn of(module: &'a ItemMod) -> Self {
        let mut items = Self {
            constants: Vec::new(),
            functions: Vec::new(),
            structs: Vec::new(),
            aliases: Vec::new(),
            imports: Imports::default(),
        };
        for item in module.content.iter().flat_map(|(_, items)| items) {
            match item {
                Item::Const(item) => items.constants.push(item),
                Item::Fn(item) => items.functions.push(item),
                Item::Struct(item) => items.structs.push(item),
                Item::Type(item) => items.aliases.push(item),
                Item::Use(item) => items.imports.read(&item.tree),
                _ => {}
            }
        }
        items
    }

    pub(super) fn function(&self, name: &str) -> Option<&'a ItemFn> {
        self.functions.iter().copied().find(|item| item.sig.ident == name)
    }

    pub(super) fn structure(&self, name: &str) -> Option<&'a ItemStruct> {
        self.structs.iter().copied().find(|item| item.ident == name)
    }

    /// The constants that are numbers of the plant.
    pub(super) fn numbers(&self) -> impl Iterator<Item = &'a ItemConst> {
        self.constants.iter().copied().filter(|item| self.is_float(&item.ty))
    }

    /// Tests whether a type is one of the two that signals have, perhaps by another name that the module gives it.
    pub(super) fn is_float(&self, ty: &Type) -> bool {
        let alias = self.aliases.iter().find(|alias| is_named(ty, &alias.ident));
        is_float(alias.map_or(ty, |alias| &alias.ty))
    }

    /// A whole number as it is written, or the constant of the module that it is.
    pub(super) fn whole(&self, expr: &Expr) -> Option<String> {
        let written = match bare(expr) {
            Expr::Path(path) => {
                let name = path.path.get_ident()?;
                let constant = self.constants.iter().find(|item| item.ident == *name)?;
                if self.is_float(&constant.ty) || conditional(&constant.attrs).is_some() {
                    return None;
                }
                literal(&constant.expr)?
            }
            _ => literal(expr)?,
        };
        written.trim_start_matches('-').bytes().all(|byte| byte.is_ascii_digit()).then_some(written)
    }
}

/// An expression without the parentheses around it.
pub(super) fn bare(expr: &Expr) -> &Expr {
    match expr {
        Expr::Paren(inner) => bare(&inner.expr),
        Expr::Group(inner) => bare(&inner.expr),
        other => other,
    }
}

fn is_named(ty: &Type, name: &syn::Ident) -> bool {
    matches!(ty, Type::Path(path) if path.path.is_ident(name))
}

/// The fields of a struct of numbers.
pub(super) fn fields(
    items: &Items<'_>,
    item: &ItemStruct,
    spans: &mut TokenSpans,
    diagnostics: &mut Diagnostics,
) -> Vec<Spanned<String>> {
    if let Err(conditional) = unconditional(&item.attrs, spans) {
        diagnostics.push(conditional);
    }
    let Fields::Named(named) = &item.fields else {
        let place = spans.of(&item.ident);
        let message = format!("`{}` has no named fields", item.ident);
        diagnostics.push(unsupported(place, message).help("give each signal a name: `pub struct X { pub i1: f64 }`"));
        return Vec::new();
    };
    let mut names = Vec::new();
    for field in &named.named {
        if let Err(conditional) = unconditional(&field.attrs, spans) {
            diagnostics.push(conditional);
        }
        let Some(ident) = &field.ident else { continue };
        if items.is_float(&field.ty) {
            names.push(Spanned { value: ident.unraw().to_string(), span: spans.of(ident) });
        } else {
            diagnostics.push(refusal::not_a_number(&field.ty, spans));
        }
    }
    names
}

fn is_float(ty: &Type) -> bool {
    matches!(ty, Type::Path(path) if path.path.is_ident("f64") || path.path.is_ident("f32"))
}

fn conditional(attributes: &[Attribute]) -> Option<&Attribute> {
    attributes.iter().find(|a| a.path().is_ident("cfg") || a.path().is_ident("cfg_attr"))
}

/// Refuses an item that is compiled under a condition: a macro does not know whether it holds.
pub(super) fn unconditional(attributes: &[Attribute], spans: &mut TokenSpans) -> Result<(), Diagnostic> {
    match conditional(attributes) {
        None => Ok(()),
        Some(condition) => Err(unsupported(spans.of(condition), "a part of the model depends on a condition")
            .label("the model is read before conditions are")
            .help("put the condition on the whole module, and write a module for each case")),
    }
}

/// A number as it is written, perhaps with a minus sign.
pub(super) fn literal(expr: &Expr) -> Option<String> {
    match expr {
        Expr::Lit(lit) => match &lit.lit {
            syn::Lit::Float(number) => Some(number.base10_digits().to_owned()),
            syn::Lit::Int(number) => Some(number.base10_digits().to_owned()),
            _ => None,
        },
        Expr::Unary(syn::ExprUnary { op: syn::UnOp::Neg(_), expr, .. }) => {
            literal(expr).filter(|text| !text.starts_with('-')).map(|text| format!("-{text}"))
        }
        Expr::Paren(inner) => literal(&inner.expr),
        Expr::Group(inner) => literal(&inner.expr),
        _ => None,
    }
}

//! What a module declares that concerns its model.

use syn::ext::IdentExt as _;
use syn::{Attribute, Expr, Fields, Item, ItemConst, ItemFn, ItemMod, ItemStruct, Type};

use super::{Places, refusal, unsupported};
use crate::model::written::Spanned;
use crate::source::{Diagnostic, Diagnostics};

/// The items of the module; those of other kinds are the author's own affair.
pub(super) struct Items<'a> {
    pub(super) constants: Vec<&'a ItemConst>,
    pub(super) functions: Vec<&'a ItemFn>,
    pub(super) structs: Vec<&'a ItemStruct>,
}

impl<'a> Items<'a> {
    pub(super) fn of(module: &'a ItemMod) -> Self {
        let mut items = Self { constants: Vec::new(), functions: Vec::new(), structs: Vec::new() };
        for item in module.content.iter().flat_map(|(_, items)| items) {
            match item {
                Item::Const(item) => items.constants.push(item),
                Item::Fn(item) => items.functions.push(item),
                Item::Struct(item) => items.structs.push(item),
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
        self.constants.iter().copied().filter(|item| is_float(&item.ty))
    }
}

/// The fields of a struct of numbers.
pub(super) fn fields(item: &ItemStruct, places: &mut Places, diagnostics: &mut Diagnostics) -> Vec<Spanned<String>> {
    if let Err(conditional) = unconditional(&item.attrs, places) {
        diagnostics.push(conditional);
    }
    let Fields::Named(named) = &item.fields else {
        let place = places.of(&item.ident);
        let message = format!("`{}` has no named fields", item.ident);
        diagnostics.push(unsupported(place, message).help("give each signal a name: `pub struct X { pub i1: f64 }`"));
        return Vec::new();
    };
    let mut names = Vec::new();
    for field in &named.named {
        if let Err(conditional) = unconditional(&field.attrs, places) {
            diagnostics.push(conditional);
        }
        let Some(ident) = &field.ident else { continue };
        if is_float(&field.ty) {
            names.push(Spanned { value: ident.unraw().to_string(), span: places.of(ident) });
        } else {
            diagnostics.push(refusal::not_a_number(&field.ty, places));
        }
    }
    names
}

/// Whether a type is one of the two that signals have.
pub(super) fn is_float(ty: &Type) -> bool {
    matches!(ty, Type::Path(path) if path.path.is_ident("f64") || path.path.is_ident("f32"))
}

/// Refuses what is compiled under a condition: nobody tells a macro whether it holds.
pub(super) fn unconditional(attributes: &[Attribute], places: &mut Places) -> Result<(), Diagnostic> {
    match attributes.iter().find(|a| a.path().is_ident("cfg") || a.path().is_ident("cfg_attr")) {
        None => Ok(()),
        Some(condition) => Err(unsupported(places.of(condition), "a part of the model depends on a condition")
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

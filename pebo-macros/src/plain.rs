//! The attribute on a module of plain Rust.

use pebo_gen::Derived;
use pebo_gen::emit::Scalar;
use pebo_gen::model::Model;
use pebo_gen::model::rust::TokenSpans;
use pebo_gen::source::Diagnostic;
use proc_macro2::{Group, Ident, Span, TokenStream, TokenTree};
use quote::quote;
use syn::{Item, ItemMod, Type};

use crate::functions::Functions;
use crate::refusal;

/// The module with what was derived of it, or with what is wrong with it.
pub(crate) fn module(arguments: TokenStream, module: &ItemMod) -> TokenStream {
    let ItemMod { attrs, vis, ident, content, .. } = module;
    let mut spans = TokenSpans::new();
    let added = match additions(arguments, module, &mut spans) {
        Ok(added) => added,
        Err(diagnostics) => refusal::errors(&diagnostics, &spans),
    };
    // Also where the model is refused: what else is wrong with the module, the compiler says.
    let items = content.iter().flat_map(|(_, items)| items);
    let (outer, inner): (Vec<_>, Vec<_>) = attrs.iter().partition(|a| matches!(a.style, syn::AttrStyle::Outer));
    quote! {
        #(#outer)* #vis mod #ident {
            #(#inner)*
            #(#items)*
            #added
        }
    }
}

fn additions(arguments: TokenStream, module: &ItemMod, spans: &mut TokenSpans) -> Result<TokenStream, Vec<Diagnostic>> {
    let scalar = scalar(module);
    let derived = Derived::of(Model::read_rust(arguments, module, spans)?)?;
    let emitted = derived.admitted(scalar)?;
    let tokens = &emitted.tokens;
    let type_name = Ident::new(&emitted.type_name, Span::call_site());
    let functions = Functions { derived: &derived, module, type_name: &type_name, scalar }.tokens();
    let added = quote! {
        pub mod observer { #tokens }
        pub use observer::*;
        #functions
    };
    Ok(at(added, Span::call_site().located_at(module.ident.span())))
}

/// The tokens, all in one place. An attribute of several lines is a place that makes lints see line breaks inside
/// of what is written.
fn at(tokens: TokenStream, span: Span) -> TokenStream {
    let moved = tokens.into_iter().map(|mut token| {
        if let TokenTree::Group(group) = &token {
            token = Group::new(group.delimiter(), at(group.stream(), span)).into();
        }
        token.set_span(span);
        token
    });
    moved.collect()
}

/// The type that the module computes in: that of its first state, perhaps by another name.
fn scalar(module: &ItemMod) -> Scalar {
    let items = || module.content.iter().flat_map(|(_, items)| items);
    let state = items().find_map(|item| match item {
        Item::Struct(item) if item.ident == "X" => item.fields.iter().next(),
        _ => None,
    });
    let alias = |ty: &Type| {
        items().find_map(|item| match item {
            Item::Type(alias) if is_named(ty, &alias.ident.to_string()) => Some((*alias.ty).clone()),
            _ => None,
        })
    };
    let ty = state.map(|field| alias(&field.ty).unwrap_or_else(|| field.ty.clone()));
    if ty.is_some_and(|ty| is_named(&ty, "f32")) { Scalar::F32 } else { Scalar::F64 }
}

fn is_named(ty: &Type, name: &str) -> bool {
    matches!(ty, Type::Path(path) if path.path.is_ident(name))
}

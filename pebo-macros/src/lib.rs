//! `#[pebo_model("models/cuk.yaml")]`: an observer from a model file, at compile time.
//!
//! Put on an empty module, the attribute fills it with what `pebo-gen` would emit for the file; the
//! crate that uses it depends on `pebo-runtime`. The path is relative to the crate's own folder, and the
//! crate is built again when the file changes. A claim that is not proved is a compile error with the
//! generator's diagnostics.

use std::path::PathBuf;

use pebo_gen::emit::Scalar;
use pebo_gen::source::{Colour, Source, render};
use proc_macro2::TokenStream;
use quote::quote;
use syn::spanned::Spanned as _;
use syn::{Error, Item, ItemMod, LitStr};

/// Fills an empty module with the observer of a model file.
///
/// ```text
/// #[pebo_macros::pebo_model("models/cuk.yaml")]
/// pub mod cuk {}
/// ```
#[proc_macro_attribute]
pub fn pebo_model(arguments: proc_macro::TokenStream, item: proc_macro::TokenStream) -> proc_macro::TokenStream {
    expand(arguments.into(), item.into()).unwrap_or_else(Error::into_compile_error).into()
}

fn expand(arguments: TokenStream, item: TokenStream) -> Result<TokenStream, Error> {
    let path: LitStr = syn::parse2(arguments).map_err(|e| {
        Error::new(e.span(), "the model file's path is missing: write #[pebo_model(\"models/plant.yaml\")]")
    })?;
    let module = empty_module(item)?;
    let folder = std::env::var_os("CARGO_MANIFEST_DIR").map(PathBuf::from).unwrap_or_default();
    let file = folder.join(path.value());
    let bytes = std::fs::read(&file).map_err(|e| {
        Error::new(path.span(), format!("cannot read {}: {e}; the path is relative to the crate", path.value()))
    })?;
    let refused = |text: String| Error::new(path.span(), format!("{} is refused\n{text}", path.value()));
    let source = Source::from_bytes(path.value(), bytes)
        .map_err(|d| refused(render(&[d], &Source::unread(path.value()), Colour::Never)))?;
    let derived = pebo_gen::derive(&source).map_err(|d| refused(render(&d, &source, Colour::Never)))?;
    derived.derivation.admit().map_err(|d| refused(render(d, &source, Colour::Never)))?;
    let emitted = derived.emit(Scalar::F64).map_err(|e| refused(e.to_string()))?;

    let ItemMod { attrs, vis, ident, .. } = module;
    let tokens = emitted.tokens;
    let tracked = file.display().to_string();
    Ok(quote! {
        #(#attrs)* #vis mod #ident {
            #tokens
            // Makes the compiler look at the file when it decides whether to build again.
            const _: &[u8] = include_bytes!(#tracked);
        }
    })
}

fn empty_module(item: TokenStream) -> Result<ItemMod, Error> {
    let expected = "put this attribute on an empty module, as `pub mod plant {}`";
    let item: Item = syn::parse2(item)?;
    match item {
        Item::Mod(module) if module.content.as_ref().is_some_and(|(_, items)| items.is_empty()) => Ok(module),
        other => Err(Error::new(other.span(), expected)),
    }
}

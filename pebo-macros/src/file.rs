//! The attribute with the path of a model file.

use std::path::PathBuf;

use pebo_gen::emit::{Emitted, Scalar};
use pebo_gen::source::{Colour, Source, render};
use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};
use syn::parse::{Parse, ParseStream};
use syn::{Error, Fields, ItemMod, ItemStruct, LitStr, Token};

/// `"models/cuk.yaml"`, perhaps with `scalar = f32`.
struct Arguments {
    path: LitStr,
    scalar: Scalar,
}

impl Parse for Arguments {
    fn parse(input: ParseStream<'_>) -> syn::Result<Self> {
        let path = input.parse().map_err(|error| {
            let help = "write #[pebo_model(\"models/plant.yaml\")]; the path is relative to the crate";
            Error::new(error.span(), format!("the model file's path is missing\nhelp: {help}"))
        })?;
        let mut scalar = Scalar::F64;
        while !input.is_empty() {
            input.parse::<Token![,]>()?;
            if input.is_empty() {
                break;
            }
            let key: Ident = input.parse()?;
            if key != "scalar" {
                let message = format!("there is no argument `{key}` beside the path of a model file");
                return Err(Error::new(key.span(), format!("{message}\nhelp: write `scalar = f32`, or nothing")));
            }
            input.parse::<Token![=]>()?;
            let name: Ident = input.parse()?;
            scalar = Scalar::from_name(&name.to_string()).ok_or_else(|| {
                let message = format!("code is written for f64 or f32, not for `{name}`");
                Error::new(name.span(), format!("{message}\nhelp: write `scalar = f32`"))
            })?;
        }
        Ok(Self { path, scalar })
    }
}

/// An empty module, filled with what is emitted.
pub(crate) fn module(arguments: TokenStream, module: ItemMod) -> Result<TokenStream, Error> {
    if !module.content.as_ref().is_some_and(|(_, items)| items.is_empty()) {
        let help = "write `pub mod plant {}`, or leave the path out if this module is the model";
        return Err(Error::new_spanned(
            &module.ident,
            format!("with the path of a model file, this attribute fills an empty module\nhelp: {help}"),
        ));
    }
    let read = read(arguments)?;
    let ItemMod { attrs, vis, ident, .. } = module;
    let (tokens, tracked) = (read.emitted.tokens, read.tracked);
    Ok(quote! {
        #(#attrs)* #vis mod #ident {
            #tokens
            #tracked
        }
    })
}

/// A unit struct, which becomes the model's type, beside a module with all that is emitted.
pub(crate) fn structure(arguments: TokenStream, item: &ItemStruct) -> Result<TokenStream, Error> {
    if !matches!(item.fields, Fields::Unit) || !item.generics.params.is_empty() {
        let message = "this attribute needs a unit struct, because it writes the fields";
        return Err(Error::new_spanned(&item.ident, format!("{message}\nhelp: write `pub struct {};`", item.ident)));
    }
    let read = read(arguments)?;
    let ItemStruct { attrs, vis, ident, .. } = item;
    if let Some(derive) = attrs.iter().find(|attribute| !attribute.path().is_ident("doc")) {
        let message = "this attribute writes the model's type together with all its traits";
        return Err(Error::new_spanned(derive, format!("{message}\nhelp: remove the other attribute")));
    }
    let module = format_ident!("{}", snake(&ident.to_string()), span = ident.span());
    let emitted = format_ident!("{}", read.emitted.type_name);
    let renamed = if ident == &read.emitted.type_name { quote!() } else { quote!(as #ident) };
    let (tokens, tracked) = (read.emitted.tokens, read.tracked);
    Ok(quote! {
        #(#attrs)* #vis mod #module {
            #tokens
            #tracked
        }
        #vis use #module::#emitted #renamed;
    })
}

struct Read {
    emitted: Emitted,
    /// Makes the compiler look at the file when it decides whether to build again.
    tracked: TokenStream,
}

fn read(arguments: TokenStream) -> Result<Read, Error> {
    let Arguments { path, scalar } = syn::parse2(arguments)?;
    let folder = std::env::var_os("CARGO_MANIFEST_DIR").map(PathBuf::from).unwrap_or_default();
    let file = folder.join(path.value());
    let bytes = std::fs::read(&file).map_err(|error| {
        let help = "the path is relative to the folder of the crate's Cargo.toml";
        Error::new(path.span(), format!("cannot read {}: {error}\nhelp: {help}", path.value()))
    })?;
    let refused = |text: String| Error::new(path.span(), format!("{} is refused\n{text}", path.value()));
    let source = Source::from_bytes(path.value(), bytes)
        .map_err(|d| refused(render(&[d], &Source::unread(path.value()), Colour::Never)))?;
    let emitted = pebo_gen::derive(&source).and_then(|derived| derived.admitted(scalar));
    let emitted = emitted.map_err(|d| refused(render(&d, &source, Colour::Never)))?;
    let tracked = file.display().to_string();
    Ok(Read {
        emitted,
        tracked: quote!(
            const _: &[u8] = include_bytes!(#tracked);
        ),
    })
}

/// A type's name as a module's.
fn snake(name: &str) -> String {
    let mut snake = String::new();
    let mut before_lower = false;
    for letter in name.chars() {
        if letter.is_uppercase() && before_lower {
            snake.push('_');
        }
        before_lower = !letter.is_uppercase() && letter != '_';
        snake.extend(letter.to_lowercase());
    }
    snake
}

#[cfg(test)]
mod tests {
    use super::*;

    fn refused(model: &str) -> String {
        let file = tempfile::NamedTempFile::new().expect("a file");
        std::fs::write(file.path(), model).expect("a file that can be written");
        let path = file.path().display().to_string();
        read(quote!(#path)).err().expect("a refusal").to_string().replace(&path, "plant.yaml")
    }

    #[test]
    fn what_is_wrong_with_a_file_is_shown_with_its_place_and_an_excerpt() {
        let model = "model: m\nx: [a]\ny: [b]\nu: [c]\nf_x: {a: c - a^2}\nf_y: {b: a}\nphi: [a]\n";
        let said = refused(model);
        for part in [
            "plant.yaml is refused",
            "error[cascade-refuted]",
            "--> plant.yaml:7:7",
            "7 | phi: [a]",
            "5 | f_x: {a: c - a^2}",
        ] {
            assert!(said.contains(part), "no `{part}` in\n{said}");
        }
        let said = refused(&model.replace("f_y:", "f_yy:"));
        for part in ["error[unknown-key]", "--> plant.yaml:6:1", "6 | f_yy: {b: a}", "did you mean `f_y`?"] {
            assert!(said.contains(part), "no `{part}` in\n{said}");
        }
    }
}

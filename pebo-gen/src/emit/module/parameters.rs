//! The parameters of the plant, and the model that is made of them.

use proc_macro2::{Span, TokenStream};
use quote::quote;

use super::{Module, Scope, doc, document, numbers, permission};
use crate::emit::expression::{Piece, ident, number};
use crate::emit::literal::literal;
use crate::emit::names::camel;
use pebo_cas::{Arena, Rational};
use pebo_design::plant::Parameter;

/// A number as an author writes it: 8.875 rather than 71/8.
pub(in crate::emit) fn decimal(arena: &Arena, value: &Rational) -> String {
    // In prose there are no groups of digits.
    let digits = literal(&value.abs()).filter(|_| !value.is_integer()).map(|digits| digits.replace('_', ""));
    match digits {
        Some(digits) if value.is_negative() => format!("-{digits}"),
        Some(digits) => digits,
        None => arena.print(arena.number(value.clone())),
    }
}

/// The value of a parameter as the author wrote it, where that is short; not of whole numbers, to which Rust adds a point.
fn written(parameter: &Parameter) -> Option<&str> {
    const LONGEST: usize = 24;
    let is_whole = parameter.value.as_ref().is_some_and(Rational::is_integer);
    parameter.text.as_deref().filter(|text| !is_whole && text.len() <= LONGEST)
}

/// The author's text as a literal, where Rust has it too and it reads without groups of digits: `22.9e-6`.
fn authors_literal(parameter: &Parameter) -> Option<TokenStream> {
    const LONGEST_RUN: usize = 5;
    let text = written(parameter)?;
    let (sign, magnitude) = text.strip_prefix('-').map_or((quote!(), text), |rest| (quote!(-), rest));
    let runs = || magnitude.split(|c: char| !c.is_ascii_digit());
    let is_floating = magnitude.contains(['.', 'e']) && magnitude.split(['.', 'e']).all(|part| !part.is_empty());
    let reads = runs().all(|run| run.len() <= LONGEST_RUN);
    let literal = (is_floating && reads).then(|| syn::LitFloat::new(magnitude, Span::call_site()))?;
    Some(quote!(#sign #literal))
}

impl Module<'_> {
    /// The parameters as a type, with the model's values if each has one.
    pub(in crate::emit) fn parameters(&self, scope: &mut Scope) -> TokenStream {
        let arena = &self.plant.arena;
        let scalar = ident(self.scalar.name());
        let parameters = &self.plant.parameters;
        if parameters.is_empty() {
            return quote! {
                /// The plant has no parameters.
                #[derive(Clone, Debug, Default, PartialEq)]
                pub struct Parameters;
            };
        }
        let fields = parameters.iter().map(|parameter| {
            let name = document::quantity(self.plant, parameter.symbol);
            let line = match (written(parameter), &parameter.value) {
                (Some(text), Some(_)) => format!("{name}, {text} in the model."),
                (None, Some(value)) => format!("{name}, {} in the model.", decimal(arena, value)),
                (_, None) => format!("{name}, without a value in the model."),
            };
            let (doc, field) = (doc(&line), ident(&scope.locals[&parameter.symbol]));
            quote!(#doc pub #field: #scalar,)
        });
        let fields: Vec<TokenStream> = fields.collect();
        let values: Option<Vec<&Rational>> = parameters.iter().map(|parameter| parameter.value.as_ref()).collect();
        let default = values.map(|values| {
            let precision = permission::for_numbers(self.scalar, values.iter().map(|&value| value.clone()));
            let entries: Vec<TokenStream> = parameters
                .iter()
                .zip(values)
                .map(|(parameter, value)| {
                    let field = ident(&scope.locals[&parameter.symbol]);
                    let value = match authors_literal(parameter) {
                        Some(literal) => literal,
                        None => number(value, &mut |ratio| scope.ratio(ratio)).tokens,
                    };
                    quote!(#field: #value)
                })
                .collect();
            quote! {
                /// The values of the model.
                #precision
                impl Default for Parameters {
                    fn default() -> Self {
                        Self { #(#entries),* }
                    }
                }
            }
        });
        quote! {
            /// The constants of the plant, in the units of the model.
            #[derive(Clone, Debug, PartialEq)]
            pub struct Parameters { #(#fields)* }
            #default
        }
    }

    /// The type of the model, and its constructor.
    pub(in crate::emit) fn model(&self, scope: &mut Scope) -> TokenStream {
        let arena = &self.plant.arena;
        let (type_name, scalar) = (ident(&camel(&self.plant.name)), ident(self.scalar.name()));
        let read = self.plant.parameters.iter().map(|parameter| {
            let name = &scope.locals[&parameter.symbol];
            let field = ident(name);
            Piece::atom(quote!(parameters.#field), "parameters.".len() + name.len(), Some(name.clone()))
        });
        let inputs: Vec<Piece> = read.collect();
        let body = scope.render(&self.staged.setup, &inputs);
        let fields: Vec<_> = scope.fields.iter().map(|field| ident(field)).collect();
        let summary =
            doc("The functions of the model. What depends on the parameters alone is computed once, in `new`.");
        let unread = self.plant.parameters.is_empty() || fields.is_empty();
        let argument = ident(if unread { "_parameters" } else { "parameters" });
        let precision = permission::for_numbers(self.scalar, numbers(&self.staged.setup));
        let (declaration, value) = if fields.is_empty() {
            (quote!(pub struct #type_name;), quote!(Self))
        } else {
            let docs = self.staged.constants.iter().map(|constant| doc(&format!("`{}`.", arena.print(constant.1))));
            let values = body.outputs.iter().map(|output| &output.tokens);
            (quote!(pub struct #type_name { #(#docs #fields: #scalar,)* }), quote!(Self { #(#fields: #values),* }))
        };
        let statements = &body.statements;
        let similar = permission::for_names(&body.variables);
        quote! {
            #summary
            #[derive(Clone, Copy, Debug, PartialEq)]
            #declaration
            #precision
            impl #type_name {
                /// The model with these parameters.
                #[must_use]
                #similar
                pub fn new(#argument: &Parameters) -> Self {
                    #(#statements)*
                    #value
                }
            }
        }
    }
}

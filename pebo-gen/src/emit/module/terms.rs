//! The terms of a sample of the outputs that the functions need: a type, and the function that computes it.
//!
//! Holds: without terms the type is the vector of the outputs. With them it is a structure of its own: the outputs that
//! are read, then the terms.

use proc_macro2::TokenStream;
use quote::quote;

use super::function::pattern;
use super::{Module, Scope, doc, permission};
use crate::emit::definition::Argument;
use crate::emit::expression::{Piece, ident};

impl Module<'_> {
    /// Positions of the outputs that functions read from the terms of a sample.
    fn kept(&self) -> Vec<usize> {
        let first = self.staged.constants.len();
        let outputs = 0..self.definitions.symbols(Argument::Y).len();
        outputs.filter(|output| self.staged.programs.iter().any(|program| program.reads(first + output))).collect()
    }

    /// Names of the fields: of the kept outputs, then of the terms.
    fn fields(&self, scope: &Scope) -> Vec<String> {
        let outputs = self.definitions.symbols(Argument::Y);
        let kept = self.kept().into_iter().map(|output| outputs[output]);
        kept.chain(self.staged.terms.iter().map(|term| term.0)).map(|symbol| scope.locals[&symbol].clone()).collect()
    }

    /// The structure; none where the outputs are all that is needed.
    pub(in crate::emit) fn terms_type(&self, scope: &Scope) -> Option<TokenStream> {
        if self.staged.terms.is_empty() {
            return None;
        }
        let arena = &self.plant.arena;
        let scalar = ident(self.scalar.name());
        let outputs = self.definitions.symbols(Argument::Y);
        let kept = self.kept().into_iter().map(|output| arena.name(outputs[output]));
        let constants = self.staged.constants.iter().copied().collect();
        let formulas = self
            .staged
            .terms
            .iter()
            .map(|term| self.abbreviations.defined(arena, arena.substitute(term.1, &constants)));
        let docs = kept.chain(formulas).map(|formula| doc(&format!("`{formula}`.")));
        let names = self.fields(scope).into_iter().map(|name| ident(&name));
        Some(quote! {
            /// What the functions need of a sample of the outputs. An observer computes it once for each
            /// sample.
            #[derive(Clone, Copy, Debug, PartialEq)]
            pub struct Terms { #(#docs pub #names: #scalar,)* }
        })
    }

    /// The type as the model names it.
    pub(in crate::emit) fn terms_name(&self) -> TokenStream {
        if self.staged.terms.is_empty() {
            let scalar = ident(self.scalar.name());
            quote!(SVector<#scalar, NY>)
        } else {
            quote!(Terms)
        }
    }

    /// The function from the outputs to the terms.
    pub(in crate::emit) fn terms_function(&self, scope: &mut Scope) -> TokenStream {
        let scalar = ident(self.scalar.name());
        if self.staged.terms.is_empty() {
            return quote! {
                /// The functions need nothing but the outputs.
                #[inline]
                fn terms(&self, y: &SVector<#scalar, NY>) -> SVector<#scalar, NY> { *y }
            };
        }
        let program = &self.staged.sample;
        let mut inputs = scope.constants();
        let first = inputs.len();
        let parts = self.definitions.parts(Argument::Y);
        let kept = self.kept();
        let read = |input: usize| program.reads(input) || kept.contains(&(input - first));
        let outputs = parts.iter().flat_map(|part| part.columns.iter().flatten());
        inputs.extend(outputs.map(|symbol| Piece::local(&scope.locals[symbol])));
        let patterns: Vec<TokenStream> = parts.iter().map(|part| pattern(part, read, first, scope)).collect();
        let outputs = self.definitions.symbols(Argument::Y);
        let named = outputs.iter().enumerate().filter(|(output, _)| read(first + output));
        let named: Vec<String> = named.map(|(_, symbol)| scope.locals[symbol].clone()).collect();
        let body = scope.render_terms(program, &inputs);
        let (statements, values) = (&body.statements, body.outputs.iter().map(|value| &value.tokens));
        let kept: Vec<_> = kept.into_iter().map(|output| ident(&scope.locals[&outputs[output]])).collect();
        let fields = self.staged.terms.iter().zip(values).map(|(term, value)| {
            let name = ident(&scope.locals[&term.0]);
            if name == value.to_string() { quote!(#name) } else { quote!(#name: #value) }
        });
        let fields: Vec<TokenStream> = fields.collect();
        let similar = permission::for_names(&[named, body.variables].concat());
        let long = permission::for_length(statements.len() + fields.len());
        quote! {
            /// What the other functions need of the outputs.
            #similar
            #long
            #[inline]
            fn terms(&self, y: &SVector<#scalar, NY>) -> Terms {
                #(let #patterns = y.data.0;)*
                #(#statements)*
                Terms { #(#kept,)* #(#fields),* }
            }
        }
    }

    /// The terms as inputs of a program: the outputs, then the terms.
    pub(in crate::emit) fn terms(&self, scope: &Scope) -> Vec<Piece> {
        let outputs = self.definitions.symbols(Argument::Y).into_iter();
        let symbols = outputs.chain(self.staged.terms.iter().map(|term| term.0));
        let piece = symbols.map(|symbol| {
            let name = &scope.locals[&symbol];
            if self.staged.terms.is_empty() {
                return Piece::local(name);
            }
            let field = ident(name);
            Piece::atom(quote!(terms.#field), "terms.".len() + name.len(), Some(name.clone()))
        });
        piece.collect()
    }
}

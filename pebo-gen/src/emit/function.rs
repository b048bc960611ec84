//! One function of the runtime's `Model`: a definition and its program in, a method out.
//!
//! Arguments are taken apart by patterns: nothing is indexed, so nothing can be out of range. What is
//! not read has no name.

use std::ops::Range;

use proc_macro2::TokenStream;
use quote::quote;

use super::definition::{Argument, Definition, Part, Shape, VELOCITY};
use super::document;
use super::expression::{Piece, ident};
use super::module::{Module, Scope, doc};
use super::permission;
use crate::cas::Symbol;
use crate::program::{Operand, Program};

impl Module<'_> {
    /// The method.
    pub(super) fn function(&self, definition: &Definition, program: &Program, scope: &mut Scope) -> TokenStream {
        let scalar = ident(self.scalar.name());
        let constants = scope.fields.iter().map(|name| {
            let field = ident(name);
            Piece::atom(quote!(self.#field), "self.".len() + name.len(), Some(name.clone()))
        });
        let mut inputs: Vec<Piece> = constants.collect();
        let stored = inputs.len();
        let symbols: Vec<Symbol> = definition.arguments.iter().flat_map(|&a| self.definitions.symbols(a)).collect();
        let mut arguments = Vec::new();
        let mut statements = Vec::new();
        let mut copied = None;
        for &argument in &definition.arguments {
            let mut reads = false;
            for part in self.definitions.parts(argument) {
                let first = inputs.len();
                let symbols = part.columns.iter().flatten();
                inputs.extend(symbols.map(|symbol| Piece::local(&scope.locals[symbol])));
                let range = first..inputs.len();
                if !range.clone().any(|input| program.reads(input)) {
                    continue;
                }
                reads = true;
                let source = source(argument, &part);
                if is_copy(definition, program, &range) {
                    copied = Some(quote!(*#source));
                } else {
                    let pattern = pattern(&part, program, first, scope);
                    statements.push(quote!(let #pattern = #source.data.0;));
                }
            }
            let name = argument.name();
            let name = ident(&if reads { name.to_owned() } else { format!("_{name}") });
            arguments.push(match size(argument) {
                None => quote!(#name: &Self::Extension),
                Some(size) => {
                    let size = ident(size);
                    quote!(#name: &SVector<#scalar, #size>)
                }
            });
        }
        let result = copied.unwrap_or_else(|| {
            let body = scope.render(program, &inputs);
            statements.extend(body.statements);
            result(definition, &body.outputs, &mut statements)
        });
        let returned = match definition.shape {
            Shape::Vector(size) => {
                let size = ident(size);
                quote!(SVector<#scalar, #size>)
            }
            Shape::Matrix(rows, columns) => {
                let (rows, columns) = (ident(rows), ident(columns));
                quote!(SMatrix<#scalar, #rows, #columns>)
            }
        };
        let read = |&(index, _): &(usize, &Symbol)| program.reads(stored + index);
        let named: Vec<String> =
            symbols.iter().enumerate().filter(read).map(|(_, symbol)| scope.locals[symbol].clone()).collect();
        let similar = permission::for_names(&named);
        let long = permission::for_length(statements.len() + program.outputs.len());
        let (name, doc) = (ident(definition.name), doc(document::function(definition.name, self.definitions)));
        // What the trait does not know is the model's own.
        let visibility = (definition.name == VELOCITY).then(|| quote!(#[must_use] pub));
        quote! {
            #doc
            #similar
            #long
            #visibility fn #name(&self, #(#arguments),*) -> #returned {
                #(#statements)*
                #result
            }
        }
    }
}

/// The constant that an argument's size is; the extension has a type of its own.
fn size(argument: Argument) -> Option<&'static str> {
    match argument {
        Argument::Extension => None,
        Argument::Y => Some("NY"),
        Argument::U => Some("NU"),
        Argument::Z => Some("NZ"),
        Argument::Eta => Some("NE"),
    }
}

/// The vector or matrix that holds a part of an argument.
fn source(argument: Argument, part: &Part) -> TokenStream {
    let name = ident(argument.name());
    match part.access {
        None => quote!(#name),
        Some(access) => {
            let access = ident(access);
            quote!(#name.#access())
        }
    }
}

/// Whether the result is a part of an argument, as it is.
fn is_copy(definition: &Definition, program: &Program, part: &Range<usize>) -> bool {
    matches!(definition.shape, Shape::Vector(_)) && program.outputs.iter().copied().eq(part.clone().map(Operand::Input))
}

/// The pattern that names the entries which are read.
fn pattern(part: &Part, program: &Program, first: usize, scope: &Scope) -> TokenStream {
    let mut inputs = first..;
    let columns = part.columns.iter().map(|column| {
        let entries = column.iter().zip(inputs.by_ref()).map(|(symbol, input)| {
            if program.reads(input) {
                let name = ident(&scope.locals[symbol]);
                quote!(#name)
            } else {
                quote!(_)
            }
        });
        let entries: Vec<TokenStream> = entries.collect();
        quote!([#(#entries),*])
    });
    let columns: Vec<TokenStream> = columns.collect();
    quote!([#(#columns),*])
}

/// The returned value: a vector, or a matrix by its columns.
fn result(definition: &Definition, entries: &[Piece], statements: &mut Vec<TokenStream>) -> TokenStream {
    let columns = definition.rows.first().map_or(0, Vec::len);
    let column = |column: usize| {
        let entries = entries.iter().skip(column).step_by(columns).map(|entry| &entry.tokens);
        quote!([#(#entries),*])
    };
    match (definition.shape, columns) {
        (Shape::Vector(_), _) => {
            let only = column(0);
            quote!(SVector::from(#only))
        }
        (Shape::Matrix(..), 1) => {
            let only = column(0);
            quote!(SMatrix::from([#only]))
        }
        (Shape::Matrix(..), _) => {
            let names: Vec<_> = (1..=columns).map(|number| ident(&format!("column_{number}"))).collect();
            for (index, name) in names.iter().enumerate() {
                let column = column(index);
                statements.push(quote!(let #name = #column;));
            }
            quote!(SMatrix::from([#(#names),*]))
        }
    }
}

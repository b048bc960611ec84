//! One function of the runtime's `Model`: the definitions of its values and its program in, a method out.
//!
//! Arguments are taken apart by patterns: nothing is indexed, so nothing can be out of range. What is
//! not read has no name.

use std::ops::Range;

use proc_macro2::TokenStream;
use quote::quote;

use super::{Module, Scope, doc, document, permission};
use crate::emit::definition::tasks::varying;
use crate::emit::definition::{
    Argument, CASCADE_SLOPES, Definition, FUNCTIONS, Group, OUTPUT_SLOPES, Part, RATE_SLOPES, Shape, TRANSFORM,
    VELOCITY,
};
use crate::emit::expression::{Piece, ident};
use pebo_cas::Symbol;
use pebo_design::program::{Operand, Program};

impl Module<'_> {
    /// The method that gives the values of a group.
    pub(in crate::emit) fn function(&self, group: &Group, program: &Program, scope: &mut Scope) -> TokenStream {
        let scalar = ident(self.scalar.name());
        let mut inputs = scope.constants();
        let stored = inputs.len();
        inputs.extend(self.terms(scope));
        let first_argument = inputs.len();
        let symbols: Vec<Symbol> =
            varying(&group.arguments).flat_map(|argument| self.definitions.symbols(argument)).collect();
        inputs.extend(symbols.iter().map(|symbol| Piece::local(&scope.locals[symbol])));

        let mut next = first_argument;
        let mut arguments = Vec::new();
        let mut statements = Vec::new();
        let mut copied = None;
        for &argument in &group.arguments {
            if argument == Argument::Y && !self.staged.terms.is_empty() {
                let name =
                    ident(if (stored..first_argument).any(|input| program.reads(input)) { "terms" } else { "_terms" });
                arguments.push(quote!(#name: &Terms));
                continue;
            }
            let mut reads = false;
            for part in self.definitions.parts(argument) {
                let count = part.columns.iter().flatten().count();
                let first = if argument == Argument::Y { stored } else { next };
                if argument != Argument::Y {
                    next += count;
                }
                let range = first..first + count;
                if !range.clone().any(|input| program.reads(input)) {
                    continue;
                }
                reads = true;
                let source = source(argument, &part);
                if is_copy(group, program, &range) {
                    copied = Some(quote!(*#source));
                } else {
                    let pattern = pattern(&part, |input| program.reads(input), first, scope);
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
        let mut variables = Vec::new();
        let values = if let Some(copied) = copied {
            vec![copied]
        } else {
            let body = scope.render(program, &inputs);
            statements.extend(body.statements);
            variables = body.variables;
            let mut entries = body.outputs.as_slice();
            let mut columns = 0;
            let value = |member: &&Definition| {
                let (own, rest) = entries.split_at(member.rows.iter().map(Vec::len).sum());
                entries = rest;
                result(member, own, &mut columns, &mut statements)
            };
            group.members.iter().map(value).collect()
        };
        let (returned, result) = self.returned(group, &values);
        // Terms are fields; without them the outputs have names here too.
        let outputs = if self.staged.terms.is_empty() { self.definitions.symbols(Argument::Y) } else { Vec::new() };
        let local = (stored..).zip(&outputs).chain((first_argument..).zip(&symbols));
        let read = local.filter(|(input, _)| program.reads(*input));
        let named: Vec<String> = read.map(|(_, symbol)| scope.locals[symbol].clone()).collect();
        let similar = permission::for_names(&[named, variables].concat());
        let long = permission::for_length(statements.len() + program.outputs.len());
        let (name, doc) = (ident(group.name), doc(document::group(group, self.definitions)));
        // A function outside the trait is the model's own. A step is compiled where it is called, often in another
        // crate, and there keeps values in registers between functions that are inlined.
        let visibility = if group.name == VELOCITY { quote!(#[must_use] pub) } else { quote!(#[inline]) };
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

    /// The type of a group's result, and the result made of its members' values.
    fn returned(&self, group: &Group, values: &[TokenStream]) -> (TokenStream, TokenStream) {
        let scalar = ident(self.scalar.name());
        let first = &values[0];
        let zeros = quote!(SMatrix::zeros());
        let second = values.get(1).unwrap_or(&zeros);
        match group.name {
            "flow" => (quote!(Flow<#scalar, NZ>), quote!(Flow { h: #first, lambda: #second })),
            "regression" | "primitive" => {
                (quote!(Sides<#scalar, NR, NE>), quote!(Sides { known: #first, factor: #second }))
            }
            OUTPUT_SLOPES => {
                let of = |name| {
                    let place = group.members.iter().position(|member| member.name == name);
                    place.and_then(|place| values.get(place)).unwrap_or(&zeros)
                };
                let (rates, cascade) = (of(RATE_SLOPES), of(CASCADE_SLOPES));
                (quote!(OutputSlopes<#scalar, NR, NZ>), quote!(OutputSlopes { rates: #rates, cascade: #cascade }))
            }
            FUNCTIONS => (
                quote!(Option<Functions<#scalar, NE, NZ>>),
                quote!(Some(Functions { values: #first, slopes: #second })),
            ),
            TRANSFORM => (
                quote!(Option<Functions<#scalar, NZ, NX>>),
                quote!(Some(Functions { values: #first, slopes: #second })),
            ),
            _ => {
                let Shape::Vector(size) = group.members[0].shape else {
                    unreachable!("a group that is no structure is a vector");
                };
                let size = ident(size);
                (quote!(SVector<#scalar, #size>), quote!(#first))
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
        Argument::Z | Argument::Theta => Some("NZ"),
        Argument::Eta => Some("NE"),
        Argument::X => Some("NX"),
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

/// The result is a part of an argument, as it is.
fn is_copy(group: &Group, program: &Program, part: &Range<usize>) -> bool {
    matches!(group.members.as_slice(), [Definition { shape: Shape::Vector(_), .. }])
        && program.outputs.iter().copied().eq(part.clone().map(Operand::Input))
}

/// The pattern that names the entries which are read.
pub(in crate::emit) fn pattern(part: &Part, reads: impl Fn(usize) -> bool, first: usize, scope: &Scope) -> TokenStream {
    let mut inputs = first..;
    let columns = part.columns.iter().map(|column| {
        let entries = column.iter().zip(inputs.by_ref()).map(|(symbol, input)| {
            if reads(input) {
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

/// The returned value: a vector, or a matrix by its columns, which are numbered through the function; so many have names.
fn result(
    definition: &Definition,
    entries: &[Piece],
    named: &mut usize,
    statements: &mut Vec<TokenStream>,
) -> TokenStream {
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
            let names: Vec<_> = (1..=columns).map(|number| ident(&format!("column_{}", *named + number))).collect();
            *named += columns;
            for (index, name) in names.iter().enumerate() {
                let column = column(index);
                statements.push(quote!(let #name = #column;));
            }
            quote!(SMatrix::from([#(#names),*]))
        }
    }
}

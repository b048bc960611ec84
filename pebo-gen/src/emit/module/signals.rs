//! The signals of a sample and of an estimate by name: the structures `X`, `Y` and `U`.
//!
//! In: the recovered states, the outputs and the inputs, in the order of their vectors. Out: a structure of each, and
//! its conversions to and from the vector. The way back: the order that such conversions keep.

use proc_macro2::TokenStream;
use quote::{ToTokens, quote};
use syn::{FnArg, ItemImpl, ItemStruct};

use super::{Module, doc, document, permission};
use crate::emit::definition::{Argument, Definitions};
use crate::emit::error::EmitError;
use crate::emit::expression::ident;
use crate::emit::names::Names;
use crate::emit::read_back::block::{body, name_of, only_function};
use crate::emit::read_back::value::{Scope, Value, unreadable};
use pebo_cas::{Arena, Expr, Symbol};

/// The structures: name, name of the size, meaning of the fields.
const STRUCTURES: [(&str, &str, &str); 3] = [
    ("X", "NX", "The recovered states: what an estimate holds."),
    ("Y", "NY", "The outputs of a sample."),
    ("U", "NU", "The inputs of a sample."),
];

/// The signals of a structure, in the order of the vector.
fn signals(definitions: &Definitions, structure: &str) -> Vec<Symbol> {
    match structure {
        "X" => definitions.left_inverse.x.iter().map(|state| state.0).collect(),
        "Y" => definitions.symbols(Argument::Y),
        _ => definitions.symbols(Argument::U),
    }
}

impl Module<'_> {
    /// The structures with their conversions.
    pub(in crate::emit) fn signals(&self) -> TokenStream {
        STRUCTURES.into_iter().map(|structure| self.structure(structure)).collect()
    }

    fn structure(&self, (name, size, summary): (&str, &str, &str)) -> TokenStream {
        let symbols = signals(self.definitions, name);
        let (structure, size, scalar) = (ident(name), ident(size), ident(self.scalar.name()));
        let argument = ident(&name.to_lowercase());
        let vector = quote!(SVector<#scalar, #size>);
        let derive = quote!(#[derive(Clone, Copy, Debug, PartialEq)]);
        if symbols.is_empty() {
            let argument = ident(&format!("_{argument}"));
            return quote! {
                /// The plant has no inputs.
                #derive
                pub struct #structure;
                impl From<#structure> for #vector {
                    fn from(#argument: #structure) -> Self { Self::zeros() }
                }
                impl From<#vector> for #structure {
                    fn from(#argument: #vector) -> Self { Self }
                }
            };
        }
        let written: Vec<String> = symbols.iter().map(|symbol| self.plant.arena.name(*symbol)).collect();
        let names = Names::default().claim_all(&written);
        let docs = symbols.iter().map(|symbol| doc(&format!("{}.", document::quantity(self.plant, *symbol))));
        let (summary, alike, similar) =
            (doc(summary), permission::for_fields(name, &names), permission::for_names(&names));
        let names: Vec<_> = names.iter().map(|name| ident(name)).collect();
        quote! {
            #summary
            #derive
            #alike
            pub struct #structure { #(#docs pub #names: #scalar,)* }
            impl From<#structure> for #vector {
                fn from(#argument: #structure) -> Self { Self::from([#(#argument.#names),*]) }
            }
            impl From<#vector> for #structure {
                #similar
                fn from(#argument: #vector) -> Self {
                    let [[#(#names),*]] = #argument.data.0;
                    Self { #(#names),* }
                }
            }
        }
    }
}

/// The fields of the structures that were read.
#[derive(Debug, Default)]
pub(in crate::emit) struct Fields {
    structures: Vec<(String, Vec<String>)>,
    /// The number of conversions that were read.
    conversions: usize,
}

impl Fields {
    /// Keeps the fields of a structure, if it is one of these.
    pub(in crate::emit) fn declare(&mut self, item: &ItemStruct) {
        let name = item.ident.to_string();
        if STRUCTURES.iter().any(|structure| structure.0 == name) {
            let fields = item.fields.iter().filter_map(|field| Some(field.ident.as_ref()?.to_string()));
            self.structures.push((name, fields.collect()));
        }
    }

    /// Reads a conversion: each field is the signal at its index, one way or the other.
    pub(in crate::emit) fn convert(
        &mut self,
        arena: &Arena,
        definitions: &Definitions,
        item: &ItemImpl,
    ) -> Result<(), EmitError> {
        let function = only_function(item)?;
        let [FnArg::Typed(argument)] = function.sig.inputs.iter().collect::<Vec<_>>()[..] else {
            return Err(unreadable(function));
        };
        let text = |tokens: &dyn Fn() -> String| tokens().split_whitespace().collect::<String>();
        let source = text(&|| argument.ty.to_token_stream().to_string());
        let target = text(&|| item.self_ty.to_token_stream().to_string());
        let known = |name: &str| STRUCTURES.iter().find(|structure| structure.0 == name);
        let (&(name, size, _), to_vector) = known(&source)
            .map(|known| (known, true))
            .or_else(|| Some((known(&target)?, false)))
            .ok_or_else(|| unreadable(item))?;
        let of_size = if to_vector { &target } else { &source };
        if !(of_size.starts_with("SVector<") && of_size.ends_with(&format!(",{size}>"))) {
            return Err(unreadable(item));
        }
        let symbols: Vec<Expr> = signals(definitions, name).into_iter().map(|symbol| arena.of_symbol(symbol)).collect();
        let (_, fields) = self.structures.iter().find(|known| known.0 == name).ok_or_else(|| unreadable(item))?;
        if fields.len() != symbols.len() {
            return Err(unreadable(item));
        }
        self.conversions += 1;
        if symbols.is_empty() {
            return Ok(());
        }
        let by_name = fields.iter().cloned().zip(symbols.iter().copied()).collect();
        let mut scope = Scope::default();
        let value = if to_vector { Value::Fields(by_name) } else { Value::Matrix(vec![symbols.clone()]) };
        scope.declare(&name_of(&argument.pat)?, value);
        let same = match body(arena, function, scope)? {
            Value::Matrix(columns) => to_vector && columns == [symbols],
            Value::Fields(found) => {
                !to_vector && fields.iter().zip(&symbols).all(|(field, s)| found.get(field) == Some(s))
            }
            _ => false,
        };
        if same { Ok(()) } else { Err(unreadable(item)) }
    }

    /// There is every structure, with the conversions both ways.
    pub(in crate::emit) fn are_complete(&self) -> bool {
        self.structures.len() == STRUCTURES.len() && self.conversions == 2 * STRUCTURES.len()
    }
}

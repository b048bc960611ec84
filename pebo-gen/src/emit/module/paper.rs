//! The paper's functions by name: `h`, `phi_0`, `phi_1`, `phi_left`, and `lambda` of a generalised cascade.
//!
//! In: the functions of the runtime's `Model`, which give these values in groups. Out: a method of the model's type for
//! each of them, from named signals and arrays to an array. None computes anything by itself. The way back: the result
//! of such a method, read from tokens.

use std::collections::BTreeMap;

use proc_macro2::TokenStream;
use quote::quote;
use syn::{FnArg, ImplItem, ItemImpl};

use super::{Module, WIDTH, docs, formulas, permission};
use crate::emit::definition::{Argument, Definition, Definitions, Shape};
use crate::emit::error::EmitError;
use crate::emit::expression::ident;
use crate::emit::names::camel;
use crate::emit::read_back::block::{body, name_of};
use crate::emit::read_back::value::{Scope, Value, transposed, unreadable};
use pebo_cas::{Arena, Expr};
use pebo_design::analysis::Class;
use pebo_design::plant::Plant;

/// The functions with their arguments, in the paper's order.
const FUNCTIONS: [(&str, &[Argument]); 5] = [
    ("h", &[Argument::Y, Argument::U]),
    ("lambda", &[Argument::Y, Argument::U]),
    ("phi_0", &[Argument::Extension, Argument::Y, Argument::U]),
    ("phi_1", &[Argument::Extension, Argument::Y, Argument::U]),
    ("phi_left", &[Argument::Z, Argument::Y]),
];

/// The values by columns of the functions that were read.
pub(in crate::emit) type Columns = BTreeMap<String, Vec<Vec<Expr>>>;

/// The functions of a model, with their arguments.
fn functions<'d>(definitions: &'d Definitions) -> impl Iterator<Item = (&'d Definition, &'static [Argument])> {
    FUNCTIONS.into_iter().filter_map(|(name, arguments)| {
        let definition = definitions.functions.iter().find(|definition| definition.name == name)?;
        Some((definition, arguments))
    })
}

impl Module<'_> {
    /// The methods.
    pub(in crate::emit) fn paper(&self) -> TokenStream {
        let type_name = ident(&camel(&self.plant.name));
        let methods = functions(self.definitions).map(|(definition, arguments)| self.method(definition, arguments));
        let sizes = self.definitions.sizes().into_iter().filter(|size| ["NY", "NU", "NZ"].contains(&size.name));
        let permission =
            permission::for_methods(self.staged.constants.len(), sizes.map(|size| size.value).max().unwrap_or(0));
        quote! {
            /// The functions of the paper by their names there. An observer calls those of `Model`, which
            /// share their work.
            #permission
            impl #type_name { #(#methods)* }
        }
    }

    fn method(&self, definition: &Definition, arguments: &[Argument]) -> TokenStream {
        let scalar = ident(self.scalar.name());
        let arguments = arguments.iter().map(|argument| match (argument, self.definitions.class) {
            (Argument::Extension, Class::Pebo) => quote!(chi: [#scalar; NZ]),
            (Argument::Extension, Class::Gpebo) => quote!(extension: &Fundamental<#scalar, NZ>),
            (Argument::Z, _) => quote!(z: [#scalar; NZ]),
            (Argument::Y, _) => quote!(y: Y),
            (Argument::U, _) => quote!(u: U),
            (Argument::Eta, _) => quote!(eta: [#scalar; NE]),
            (Argument::Theta, _) => quote!(theta: [#scalar; NZ]),
            (Argument::X, _) => quote!(x: X),
        });
        let returned = match (definition.name, definition.shape) {
            ("phi_left", _) => quote!(X),
            (_, Shape::Vector(size)) => {
                let size = ident(size);
                quote!([#scalar; #size])
            }
            (_, Shape::Matrix(rows, columns)) => {
                let (rows, columns) = (ident(rows), ident(columns));
                quote!([[#scalar; #columns]; #rows])
            }
        };
        let terms = if self.staged.terms.is_empty() { quote!(&y.into()) } else { quote!(&self.terms(&y.into())) };
        let flow = quote!(self.flow(#terms, &u.into()));
        let (start, extension) = match self.definitions.class {
            Class::Pebo => (quote!(let extension = Integrator::new(chi.into());), quote!(&extension)),
            Class::Gpebo => (quote!(), quote!(extension)),
        };
        let sides = quote!(#start let sides = self.regression(#extension, #terms, &u.into()););
        let body = match definition.name {
            "h" => quote!(#flow.h.into()),
            "lambda" => quote!(let flow = #flow; flow.lambda.transpose().into()),
            "phi_0" => quote!(#sides sides.known.into()),
            "phi_1" => quote!(#sides sides.factor.transpose().into()),
            _ => quote!(self.recover(&z.into(), #terms).into()),
        };
        let print = (&*self.plant.arena, self.abbreviations);
        let mut lines = vec![summary(definition.name, self.plant, self.definitions)];
        lines.extend(formulas::text(formulas::of(print, self.definitions, definition, WIDTH)));
        let (docs, name) = (docs(lines), ident(definition.name));
        quote! {
            #docs
            #[inline]
            #[must_use]
            pub fn #name(&self, #(#arguments),*) -> #returned { #body }
        }
    }
}

/// The summary of a function of the paper.
fn summary(name: &str, plant: &Plant, definitions: &Definitions) -> String {
    match (name, definitions.class) {
        ("h", Class::Pebo) => "The right side of the cascade `z' = h(y, u)`:".to_owned(),
        ("h", Class::Gpebo) => {
            "What is free of `z` in the generalised cascade `z' = lambda(y, u) z + h(y, u)`:".to_owned()
        }
        ("lambda", _) => "The factor of `z` in the generalised cascade, by rows:".to_owned(),
        ("phi_0", _) => format!("What is known in the regression `{}`:", formulas::equation(plant, definitions)),
        ("phi_1", _) => "The factor of the unknown in the regression, by rows:".to_owned(),
        _ => "The recovered states, `x = phi_left(z, y)`:".to_owned(),
    }
}

/// These are the methods.
pub(in crate::emit) fn is_paper(item: &ItemImpl) -> bool {
    let named = |entry: &ImplItem| matches!(entry, ImplItem::Fn(function) if FUNCTIONS.iter().any(|known| function.sig.ident == known.0));
    item.trait_.is_none() && !item.items.is_empty() && item.items.iter().all(named)
}

/// The results of the methods: arguments by their position, and `Model`'s functions as they are known in the scope.
pub(in crate::emit) fn read(
    arena: &Arena,
    definitions: &Definitions,
    item: &ItemImpl,
    globals: &Scope,
) -> Result<Columns, EmitError> {
    let mut read = Columns::new();
    for entry in &item.items {
        let ImplItem::Fn(function) = entry else { return Err(unreadable(entry)) };
        let name = function.sig.ident.to_string();
        let (_, arguments) = FUNCTIONS.iter().find(|known| known.0 == name).ok_or_else(|| unreadable(function))?;
        let mut scope = globals.clone();
        let mut typed = function.sig.inputs.iter().skip(1);
        for &argument in *arguments {
            let Some(FnArg::Typed(input)) = typed.next() else { return Err(unreadable(&function.sig)) };
            let value = match (argument, definitions.class) {
                (Argument::Extension, Class::Pebo) => {
                    Value::Matrix(vec![definitions.chi.iter().map(|&chi| arena.of_symbol(chi)).collect()])
                }
                _ => definitions.value(arena, argument),
            };
            scope.declare(&name_of(&input.pat)?, value);
        }
        let columns = body(arena, function, scope)?.columns().ok_or_else(|| unreadable(&function.block))?;
        read.insert(name, columns);
    }
    Ok(read)
}

/// Each of the methods is there, and returns the result of the function of `Model`: vectors as they are, matrices by
/// rows.
pub(in crate::emit) fn agrees(definitions: &Definitions, paper: &Columns, model: &Columns) -> bool {
    let mut expected = Columns::new();
    for (definition, _) in functions(definitions) {
        let Some(columns) = model.get(definition.name) else { return false };
        let columns = match definition.shape {
            Shape::Vector(_) => columns.clone(),
            Shape::Matrix(..) => transposed(columns),
        };
        expected.insert(definition.name.to_owned(), columns);
    }
    expected == *paper
}

//! The module as tokens: definitions and their programs in, items out.

pub(crate) mod abbreviation;
pub(crate) mod check;
mod constructors;
mod describe;
pub(super) mod document;
mod formulas;
mod function;
mod inputs;
pub(crate) mod paper;
mod parameters;
pub(in crate::emit) mod permission;
pub(crate) mod prose;
mod settings_words;
pub(crate) mod signals;
mod terms;

use std::collections::BTreeMap;

use proc_macro2::{Span, TokenStream};
use quote::quote;

use super::definition::{Argument, INSTANTS, VELOCITY};
use super::error::EmitError;
use super::expression::{self, Body, Piece, ident, render};
use super::literal::{literal, whole};
use super::names::{Names, camel};
use super::table::Tables;
use describe::describe;
pub(super) use inputs::Module;
use pebo_cas::{Expr, Rational, Symbol};
use pebo_design::analysis::{Class, RegressionKind};
use pebo_design::program::{Constant, Program};

/// The `INTERFACE` of the runtime library that emitted code is written for: it fails to compile against another.
const INTERFACE: u32 = 2;

/// The names of the module.
pub(super) struct Scope {
    /// Names of parameters and arguments; all functions share them, so that a name means one thing.
    pub(super) locals: BTreeMap<Symbol, String>,
    /// Names of the constants.
    pub(super) fields: Vec<String>,
    names: Names,
    /// The same without those of the terms: where these are computed, their names are free for their parts.
    names_before_terms: Names,
    /// Numbers without a literal, with the names of their constants.
    ratios: BTreeMap<Rational, String>,
    /// Tables, with the names of theirs.
    tables: Tables,
}

impl Module<'_> {
    /// The items.
    pub(super) fn tokens(&self) -> Result<TokenStream, EmitError> {
        self.check_numbers()?;
        let mut scope = self.scope();
        let model = self.model(&mut scope);
        let terms = self.terms_type(&scope);
        let (mut functions, mut own) = (vec![self.terms_function(&mut scope)], None);
        for (group, program) in self.definitions.groups().iter().zip(&self.staged.programs) {
            let function = self.function(group, program, &mut scope);
            if group.name == VELOCITY { own = Some(function) } else { functions.push(function) }
        }
        let parameters = self.parameters(&mut scope);
        let check = (!self.asked.is_empty()).then(|| self.check(&mut scope));
        let constructors = self.constructors(&mut scope);
        let ratios = self.ratios(&scope);
        let tables = scope.tables.items(&self.plant.arena, self.scalar, doc);
        let signals = self.signals();

        let lines = document::module(self);
        let lines = lines.iter().map(|line| spaced(line));
        let uses = self.uses();
        let sizes = self.definitions.sizes().into_iter().map(|size| {
            let doc = doc(&document::size(self.plant, self.definitions, size.name));
            let (name, value) = (ident(size.name), proc_macro2::Literal::usize_unsuffixed(size.value));
            quote!(#doc pub const #name: usize = #value;)
        });
        let interface = proc_macro2::Literal::u32_unsuffixed(INTERFACE);
        let interface = quote!(#[doc = " It compiles with the runtime library that it was written for, and with no other."] const _: () = pebo_runtime::emitted_for(#interface););
        let (type_name, scalar) = (ident(&camel(&self.plant.name)), ident(self.scalar.name()));
        let (extension, terms_name) = (ident(self.extension()), self.terms_name());
        let regression = ident(match self.definitions.regression.kind {
            RegressionKind::Static => "Static",
            RegressionKind::Dynamic | RegressionKind::Implicit => "Dynamic",
        });
        let sampled = self.staged.programs.iter().chain([&self.staged.sample]);
        let precision = permission::for_numbers(self.scalar, sampled.flat_map(numbers));
        let instants = self.definitions.has_instants().then(|| {
            let number = ident(INSTANTS);
            quote!(const INSTANTS: usize = #number;)
        });
        let related = self.definitions.has_transform().then(|| {
            quote!(
                const RELATED: bool = true;
            )
        });
        let own = own.map(|velocity| quote!(#precision impl #type_name { #velocity }));
        let paper = self.paper();
        let is_local = self.definitions.regression.is_at_estimate();
        let local = is_local.then(|| {
            quote!(
                const LOCAL: bool = true;
            )
        });
        let movable = if is_local {
            quote! {
                /// `phi_1` is the slope of `phi_0` where `theta` is zero: the observer has to move each
                /// estimate from `theta` into the extension.
            }
        } else {
            quote! {
                /// `phi_0` is affine in the extension with the factor `phi_1`: the observer may move a
                /// shift from the extension into `theta`.
            }
        };
        let rebase = self.rebase.then(|| {
            quote! {
                #movable
                impl Rebase<NX, NY, NU, NZ, NR> for #type_name {}
            }
        });
        Ok(quote! {
            #(#![doc = #lines])*
            #uses
            #interface
            #(#sizes)*
            #signals
            #ratios
            #tables
            #parameters
            #check
            #model
            #terms
            #precision
            impl Model<NX, NY, NU, NZ, NR, NE> for #type_name {
                type Scalar = #scalar;
                type X = X;
                type Y = Y;
                type U = U;
                type Extension = #extension<#scalar, NZ>;
                type Terms = #terms_name;
                const REGRESSION: Regression = Regression::#regression;
                #instants
                #related
                #local
                #(#functions)*
            }
            #own
            #paper
            #rebase
            /// The observer of this model, with the gradient estimator unless another is named.
            pub type Observer<E = Gradient<#scalar, NE>> =
                pebo_runtime::Observer<#type_name, E, NX, NY, NU, NZ, NR, NE>;
            #constructors
        })
    }

    fn extension(&self) -> &'static str {
        match self.definitions.class {
            Class::Pebo => "Integrator",
            Class::Gpebo => "Fundamental",
        }
    }

    fn programs(&self) -> impl Iterator<Item = &Program> {
        [&self.staged.setup, &self.staged.sample, &self.checked].into_iter().chain(&self.staged.programs)
    }

    fn scope(&self) -> Scope {
        let mut names = Names::default();
        let arena = &self.plant.arena;
        let parameters = self.plant.parameters.iter().map(|parameter| parameter.symbol);
        let arguments =
            [Argument::Y, Argument::U, Argument::Extension, Argument::Z, Argument::Eta, Argument::Theta, Argument::X];
        let arguments = arguments.into_iter().flat_map(|argument| self.definitions.symbols(argument));
        let symbols: Vec<Symbol> = parameters.chain(arguments).collect();
        let written: Vec<String> = symbols.iter().map(|symbol| arena.name(*symbol)).collect();
        let mut locals: BTreeMap<Symbol, String> = symbols.into_iter().zip(names.claim_all(&written)).collect();
        let names_before_terms = names.clone();
        let constants: BTreeMap<Symbol, Expr> = self.staged.constants.iter().copied().collect();
        for &(term, formula) in &self.staged.terms {
            let name = match describe(arena, arena.substitute(formula, &constants), &locals) {
                Some(name) => names.claim(&name),
                None => names.number("s"),
            };
            locals.insert(term, name);
        }
        let mut fields = Names::default();
        let constants = self.staged.constants.iter().map(|(_, formula)| match describe(arena, *formula, &locals) {
            Some(name) => fields.claim(&name),
            None => fields.number("k"),
        });
        let fields = constants.collect();
        let tables = Tables::of(arena, self.programs());
        Scope { locals, fields, names, names_before_terms, ratios: BTreeMap::new(), tables }
    }

    fn uses(&self) -> TokenStream {
        let scalar = ident(self.scalar.name());
        let pi = self.programs().any(|program| program.constants.contains(&Constant::Pi));
        let pi = pi.then(|| quote!(use core::#scalar::consts::PI;));
        let mut names = vec!["Flow", "Gradient", self.extension(), "Model", "Regression", "Sides"];
        names.extend(self.programs().any(expression::calls).then_some("Real"));
        names.extend((self.definitions.class == Class::Pebo).then_some("Extension"));
        names.extend(self.definitions.has_functions().then_some("Functions"));
        names.extend(self.definitions.has_output_slopes().then_some("OutputSlopes"));
        names.extend(self.rebase.then_some("Rebase"));
        names.extend(self.programs().any(|program| !program.tables.is_empty()).then_some("Table"));
        names.extend((!self.asked.is_empty()).then_some("Fault"));
        names.extend(self.constructors_use());
        // In alphabetical order, as rustfmt has them.
        names.sort_unstable();
        names.dedup();
        let names = names.into_iter().map(ident);
        quote! {
            #pi
            use pebo_runtime::nalgebra::{SMatrix, SVector};
            use pebo_runtime::{#(#names),*};
        }
    }

    /// Refuses numbers that the scalar cannot represent.
    fn check_numbers(&self) -> Result<(), EmitError> {
        let constants = self.programs().flat_map(|program| &program.constants);
        let numbers = constants.filter_map(|constant| match constant {
            Constant::Number(value) => Some(value),
            Constant::Pi => None,
        });
        let values = self.plant.parameters.iter().filter_map(|parameter| parameter.value.as_ref());
        let tables = Tables::of(&self.plant.arena, self.programs());
        if let Some(number) = tables.numbers().find(|number| !self.scalar.holds(number)) {
            return Err(EmitError::OutOfRange { number: number.clone() });
        }
        for value in numbers.chain(values).chain(self.tuned_numbers()) {
            let parts = [value.clone(), value.numerator().into(), value.denominator().into()];
            let written = if literal(value).is_some() { &parts[..1] } else { &parts[..] };
            if let Some(number) = written.iter().find(|part| !self.scalar.holds(part)) {
                return Err(EmitError::OutOfRange { number: number.clone() });
            }
        }
        Ok(())
    }

    /// The constants for numbers without a literal.
    fn ratios(&self, scope: &Scope) -> TokenStream {
        let scalar = ident(self.scalar.name());
        let items = scope.ratios.iter().map(|(value, name)| {
            let doc = doc(&format!("`{value}`."));
            let name = ident(name);
            let [above, below] = [value.numerator(), value.denominator()]
                .map(|part| syn::LitFloat::new(&whole(&part), Span::call_site()));
            quote!(#doc const #name: #scalar = #above / #below;)
        });
        items.collect()
    }
}

impl Scope {
    /// The constants of the model, as inputs of a program.
    pub(super) fn constants(&self) -> Vec<Piece> {
        let constants = self.fields.iter().map(|name| {
            let field = ident(name);
            Piece::atom(quote!(self.#field), "self.".len() + name.len(), Some(name.clone()))
        });
        constants.collect()
    }

    /// A program's statements and results, with local variables that differ from all arguments.
    pub(super) fn render(&mut self, program: &Program, inputs: &[Piece]) -> Body {
        let mut names = self.names.clone();
        let tables = self.tables.clone();
        render(program, inputs, &mut |value| self.ratio(value), &tables, &mut names)
    }

    /// The same for the program that computes the terms.
    pub(super) fn render_terms(&mut self, program: &Program, inputs: &[Piece]) -> Body {
        let mut names = self.names_before_terms.clone();
        let tables = self.tables.clone();
        render(program, inputs, &mut |value| self.ratio(value), &tables, &mut names)
    }

    /// The constant for a positive number without a literal.
    pub(super) fn ratio(&mut self, value: &Rational) -> Piece {
        const LONGEST: usize = 16;
        let next = self.ratios.len() + 1;
        let name = self.ratios.entry(value.clone()).or_insert_with(|| {
            let telling = format!("RATIO_{}_{}", value.numerator(), value.denominator());
            if telling.len() <= LONGEST { telling } else { format!("RATIO_{next}") }
        });
        let constant = ident(name);
        Piece::atom(quote!(#constant), name.len(), None)
    }
}

/// Numbers of a program, for the question whether they are long.
pub(super) fn numbers(program: &Program) -> impl Iterator<Item = Rational> {
    program.constants.iter().filter_map(|constant| match constant {
        Constant::Number(value) => Some(value.clone()),
        Constant::Pi => None,
    })
}

/// The longest line behind `///` and the indentation of a function in a block.
const WIDTH: usize = 92;

/// The documentation of an item: a paragraph, wrapped to lines.
pub(super) fn doc(paragraph: &str) -> TokenStream {
    docs(vec![paragraph.to_owned()])
}

/// The documentation of an item: paragraphs and blocks.
fn docs(lines: Vec<String>) -> TokenStream {
    let lines = prose::wrapped(lines, WIDTH);
    let lines = lines.iter().map(|line| spaced(line));
    quote!(#(#[doc = #lines])*)
}

/// A line as it is written behind `///`.
fn spaced(line: &str) -> String {
    if line.is_empty() { String::new() } else { format!(" {line}") }
}

//! The emitted tokens, read again as algebra.
//!
//! In: tokens, and the plant for the meaning of positions: the first field of `Parameters` is the
//! first parameter, the first entry of `y` the first output. Nothing else of the emitter is used: no
//! table of names, no program. Out: the value of each function as expressions. What the reader does
//! not know, an undeclared name among it, is an error.

pub(crate) mod block;
mod settings;
pub(crate) mod value;

use std::collections::BTreeMap;

use proc_macro2::TokenStream;
use quote::ToTokens;
use syn::{FnArg, ImplItem, Item};

use super::definition::{Argument, Definitions, GROUPS, INSTANTS, VELOCITY};
use super::error::EmitError;
use super::literal::Scalar;
use super::module::check::{self, Condition};
use super::module::{paper, signals};
use super::table::read_constant;
use block::{body, name_of, only_function, statements};
use pebo_cas::graph::function::pieces::Pieces;
use pebo_cas::{Arena, Expr, Rational, Symbol};
use pebo_design::analysis::{RegressionKind, Sign};
use pebo_design::plant::{Plant, Settings};
use value::{Scope, Value, expression, unreadable};

/// Confirms that the tokens compute the definitions.
pub(super) fn confirm(
    plant: &Plant,
    definitions: &Definitions,
    (asked, settings): (&[(Expr, Sign)], Option<&Settings<Rational>>),
    scalar: Scalar,
    tokens: &TokenStream,
    is_zero: impl Fn(&Arena, Expr) -> bool,
) -> Result<(), EmitError> {
    let arena = &plant.arena;
    let read = read(plant, definitions, tokens)?;
    let expected = [
        ("Scalar", scalar.name()),
        ("X", "X"),
        ("Y", "Y"),
        ("U", "U"),
        ("Extension", if definitions.psi.is_empty() { "Integrator" } else { "Fundamental" }),
        (
            "REGRESSION",
            match definitions.regression.kind {
                RegressionKind::Static => "Static",
                RegressionKind::Dynamic | RegressionKind::Implicit => "Dynamic",
            },
        ),
    ];
    for (name, value) in expected {
        if read.choices.get(name).map(String::as_str) != Some(value) {
            return Err(EmitError::Unreadable { code: format!("{name} is not {value}") });
        }
    }
    if read.choices.get("INSTANTS").map(String::as_str) != definitions.has_instants().then_some(INSTANTS) {
        return Err(EmitError::Unreadable { code: "the equations that hold at every instant".to_owned() });
    }
    if read.choices.get("LOCAL").map(String::as_str) != definitions.regression.is_at_estimate().then_some("true") {
        return Err(EmitError::Unreadable { code: "whether the slopes are those at the estimate".to_owned() });
    }
    if read.choices.get("RELATED").map(String::as_str) != definitions.has_transform().then_some("true") {
        return Err(EmitError::Unreadable { code: "whether the components of phi depend on one another".to_owned() });
    }
    let values: Option<Vec<Rational>> = plant.parameters.iter().map(|parameter| parameter.value.clone()).collect();
    if !plant.parameters.is_empty() && read.default != values {
        return Err(EmitError::Unreadable { code: "the values of the parameters".to_owned() });
    }
    let asked: Vec<Condition> = asked.iter().map(|asked| Condition::of(arena, *asked)).collect();
    if !plant.parameters.is_empty() && !same_conditions(arena, &read.checked, &asked, &is_zero) {
        return Err(EmitError::Unreadable { code: "the check of the parameters".to_owned() });
    }
    if read.settings.as_ref() != settings {
        return Err(EmitError::Unreadable { code: "the settings of the observer".to_owned() });
    }
    if !read.signals.are_complete() {
        return Err(EmitError::Unreadable { code: "the structures of the signals".to_owned() });
    }
    if read.functions.len() != definitions.functions.len() {
        return Err(EmitError::Unreadable { code: "another set of functions".to_owned() });
    }
    if !paper::agrees(definitions, &read.paper, &read.functions) {
        return Err(EmitError::Unreadable { code: "the functions of the paper".to_owned() });
    }
    for definition in &definitions.functions {
        let columns = read.functions.get(definition.name).ok_or(EmitError::Missing("function"))?;
        for (row, entries) in definition.rows.iter().enumerate() {
            for (column, &entry) in entries.iter().enumerate() {
                let emitted = columns.get(column).and_then(|column| column.get(row));
                let equal =
                    emitted.is_some_and(|&emitted| emitted == entry || is_zero(arena, arena.sub(emitted, entry)));
                let same_size = columns.len() == entries.len()
                    && columns.iter().all(|column| column.len() == definition.rows.len());
                if !equal && arena.budget().is_exhausted() {
                    return Err(EmitError::LimitReached);
                }
                if !equal || !same_size {
                    let function = definition.name.to_owned();
                    return Err(EmitError::Differs { function, row: row + 1, column: column + 1 });
                }
            }
        }
    }
    Ok(())
}

/// The conditions are the same, one by one.
fn same_conditions(
    arena: &Arena,
    read: &[Condition],
    asked: &[Condition],
    is_zero: impl Fn(&Arena, Expr) -> bool,
) -> bool {
    let same = |read: &Condition, asked: &Condition| {
        let compared = match (read.compared, asked.compared) {
            (Some((a, how)), Some((b, asked))) => how == asked && (a == b || is_zero(arena, arena.sub(a, b))),
            (None, None) => true,
            _ => false,
        };
        compared && read.finite == asked.finite
    };
    read.len() == asked.len() && read.iter().zip(asked).all(|(read, asked)| same(read, asked))
}

impl Definitions<'_> {
    /// The tables in the functions.
    fn tables(&self, arena: &Arena) -> Vec<Pieces> {
        let formulas: Vec<Expr> = self.functions.iter().flat_map(|function| function.rows.concat()).collect();
        let parts = arena.postorder(&formulas).into_iter();
        parts.filter_map(|part| Pieces::of(arena, part)).map(|(table, _)| Pieces { order: 0, ..table }).collect()
    }

    /// The value of an argument when its function is read.
    pub(super) fn value(&self, arena: &Arena, argument: Argument) -> Value {
        let columns = |columns: &[Vec<Symbol>]| {
            let column = |column: &Vec<Symbol>| column.iter().map(|&s| arena.of_symbol(s)).collect();
            columns.iter().map(column).collect::<Vec<Vec<Expr>>>()
        };
        let parts = self.parts(argument);
        match parts.as_slice() {
            [part] if part.access.is_none() => Value::Matrix(columns(&part.columns)),
            parts => Value::Parts(
                parts.iter().filter_map(|part| Some((part.access?.to_owned(), columns(&part.columns)))).collect(),
            ),
        }
    }
}

/// The content of the tokens.
#[derive(Debug, Default)]
struct Read {
    default: Option<Vec<Rational>>,
    /// The conditions on the parameters.
    checked: Vec<Condition>,
    /// The settings of the observer's constructor.
    settings: Option<Settings<Rational>>,
    /// Associated types and constants, by the last segment of their values.
    choices: BTreeMap<String, String>,
    /// The structures of the signals.
    signals: signals::Fields,
    /// The terms of a sample.
    terms: Option<Value>,
    /// The columns of each value.
    functions: paper::Columns,
    /// The same of the methods that the paper names.
    paper: paper::Columns,
}

fn read(plant: &Plant, definitions: &Definitions, tokens: &TokenStream) -> Result<Read, EmitError> {
    let arena = &plant.arena;
    let file: syn::File =
        syn::parse2(tokens.clone()).map_err(|error| EmitError::Unreadable { code: error.to_string() })?;
    let mut read = Read::default();
    let mut globals = Scope::default();
    let mut fields: BTreeMap<String, Expr> = BTreeMap::new();
    let mut stored: BTreeMap<String, Expr> = BTreeMap::new();
    let (mut window, mut rows) = (None, None);
    for item in &file.items {
        match item {
            Item::Use(item) => globals.import(arena, &item.to_token_stream().to_string()),
            // The version of the runtime library: it computes nothing.
            Item::Const(item) if item.ident == "_" => {}
            Item::Const(item) if item.ident == settings::WINDOW || item.ident == settings::PAST => {
                window = Some(&*item.expr);
            }
            Item::Const(item) if item.ident == settings::ROWS => rows = Some(&*item.expr),
            Item::Const(item) if item.ident == settings::UNKNOWNS => {
                if item.expr.to_token_stream().to_string() != settings::unknowns(definitions.has_instants()) {
                    return Err(unreadable(item));
                }
            }
            Item::Const(item) if is_size(&item.ty) => {
                let name = item.ident.to_string();
                let size = definitions.sizes().into_iter().find(|size| name == size.name);
                if size.map(|size| size.value.to_string()) != Some(item.expr.to_token_stream().to_string()) {
                    return Err(unreadable(item));
                }
            }
            Item::Const(item) if item.ident.to_string().starts_with("TABLE_") => {
                let table = read_constant(&definitions.tables(arena), &item.expr);
                let table = table.ok_or_else(|| unreadable(item))?;
                globals.declare(&item.ident.to_string(), Value::Table(table));
            }
            Item::Const(item) => {
                let value = expression(arena, &item.expr, &globals)?;
                globals.declare(&item.ident.to_string(), value);
            }
            Item::Struct(item) if item.ident == "Parameters" => {
                let names: Vec<String> =
                    item.fields.iter().filter_map(|field| Some(field.ident.as_ref()?.to_string())).collect();
                if names.len() != plant.parameters.len() {
                    return Err(unreadable(item));
                }
                let symbols = plant.parameters.iter().map(|p| arena.of_symbol(p.symbol));
                fields = names.into_iter().zip(symbols).collect();
            }
            Item::Struct(item) => read.signals.declare(item),
            Item::Type(_) => {}
            Item::Impl(item) => match trait_name(item).as_deref() {
                Some("Default") => {
                    let values = structure(arena, only_function(item)?, &globals)?;
                    let declared = plant.parameters.iter().map(|p| arena.of_symbol(p.symbol));
                    let value = |symbol: Expr| {
                        let (name, _) = fields.iter().find(|field| *field.1 == symbol)?;
                        arena.as_number(*values.get(name)?)
                    };
                    read.default = declared.map(value).collect();
                }
                Some("From") => read.signals.convert(arena, definitions, item)?,
                Some("Rebase") if item.items.is_empty() => {}
                Some("Model") => model(plant, definitions, item, (&mut globals, &stored), &mut read)?,
                None if paper::is_paper(item) => read.paper = paper::read(arena, definitions, item, &globals)?,
                None if settings::is_constructors(item) => {
                    read.settings = settings::read(arena, item, (window, rows), &globals)?;
                }
                None if only_function(item)?.sig.ident == VELOCITY => {
                    model(plant, definitions, item, (&mut globals, &stored), &mut read)?;
                }
                None if last_segment(&item.self_ty)? == "Parameters" => {
                    let mut scope = globals.clone();
                    scope.declare("self", Value::Fields(fields.clone()));
                    let (last, scope) = statements(arena, only_function(item)?, scope)?;
                    read.checked = check::read(arena, last, &scope)?;
                }
                None => {
                    let mut scope = globals.clone();
                    let function = only_function(item)?;
                    let [FnArg::Typed(argument)] = function.sig.inputs.iter().collect::<Vec<_>>()[..] else {
                        return Err(unreadable(function));
                    };
                    scope.declare(&name_of(&argument.pat)?, Value::Fields(fields.clone()));
                    stored = structure(arena, function, &scope)?;
                }
                Some(_) => return Err(unreadable(item)),
            },
            other => return Err(unreadable(other)),
        }
    }
    Ok(read)
}

/// The functions of the trait: arguments by their position, as the runtime defines them. What follows may call them.
fn model(
    plant: &Plant,
    definitions: &Definitions,
    item: &syn::ItemImpl,
    (globals, stored): (&mut Scope, &BTreeMap<String, Expr>),
    read: &mut Read,
) -> Result<(), EmitError> {
    let arena = &plant.arena;
    for entry in &item.items {
        match entry {
            ImplItem::Type(entry) => {
                read.choices.insert(entry.ident.to_string(), last_segment(&entry.ty)?);
            }
            ImplItem::Const(entry) => {
                let value = match &entry.expr {
                    syn::Expr::Path(path) => path.path.segments.last().map(|last| last.ident.to_string()),
                    syn::Expr::Lit(literal) => Some(literal.to_token_stream().to_string()),
                    _ => None,
                };
                read.choices.insert(entry.ident.to_string(), value.ok_or_else(|| unreadable(entry))?);
            }
            ImplItem::Fn(function) => {
                let mut scope = globals.clone();
                scope.declare("self", Value::Fields(stored.clone()));
                let name = function.sig.ident.to_string();
                let group = GROUPS.iter().find(|group| group.0 == name);
                let arguments = match (name.as_str(), group) {
                    ("terms", _) => &[Argument::Y][..],
                    (_, Some(group)) => group.1,
                    (_, None) => return Err(unreadable(&function.sig)),
                };
                let mut typed = function.sig.inputs.iter().skip(1);
                let mut read_with = Vec::new();
                for &argument in arguments {
                    let Some(FnArg::Typed(input)) = typed.next() else {
                        return Err(unreadable(&function.sig));
                    };
                    let value = match (argument, group) {
                        (Argument::Y, Some(_)) => read.terms.clone().ok_or_else(|| unreadable(&function.sig))?,
                        _ => definitions.value(arena, argument),
                    };
                    scope.declare(&name_of(&input.pat)?, value.clone());
                    read_with.push(value);
                }
                let value = body(arena, function, scope)?;
                globals.declare_method(&name, read_with, value.clone());
                let Some(&(_, _, members)) = group else {
                    read.terms = Some(value);
                    continue;
                };
                let values = match value {
                    Value::Matrix(columns) => vec![(members[0], columns)],
                    Value::Parts(parts) => {
                        let known = parts.into_iter().map(|(field, columns)| Some((member(&field, members)?, columns)));
                        known.collect::<Option<_>>().ok_or_else(|| unreadable(&function.block))?
                    }
                    _ => return Err(unreadable(&function.block)),
                };
                let there = values.into_iter().filter(|(_, columns)| !columns.is_empty());
                read.functions.extend(there.map(|(name, columns)| (name.to_owned(), columns)));
            }
            other => return Err(unreadable(other)),
        }
    }
    Ok(())
}

/// The value that a field of the runtime's `Flow`, `Sides`, `Functions` or `OutputSlopes` holds, of those that a function gives.
fn member(field: &str, members: &'static [&'static str]) -> Option<&'static str> {
    match field {
        "h" | "known" | "values" | "rates" => members.first().copied(),
        "lambda" | "factor" | "slopes" | "cascade" => members.get(1).copied(),
        _ => None,
    }
}

/// The fields of the structure that a function returns.
fn structure(arena: &Arena, function: &syn::ImplItemFn, scope: &Scope) -> Result<BTreeMap<String, Expr>, EmitError> {
    match body(arena, function, scope.clone())? {
        Value::Fields(fields) => Ok(fields),
        _ => Err(unreadable(&function.block)),
    }
}

fn trait_name(item: &syn::ItemImpl) -> Option<String> {
    let implemented = item.trait_.as_ref()?;
    Some(implemented.0.segments.last()?.ident.to_string())
}

fn is_size(ty: &syn::Type) -> bool {
    ty.to_token_stream().to_string() == "usize"
}

fn last_segment(ty: &syn::Type) -> Result<String, EmitError> {
    match ty {
        syn::Type::Path(path) => {
            let last = path.path.segments.last().ok_or_else(|| unreadable(ty))?;
            Ok(last.ident.to_string())
        }
        _ => Err(unreadable(ty)),
    }
}

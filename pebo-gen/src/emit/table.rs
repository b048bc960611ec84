//! Tables as constants of the module.
//!
//! In: the tables of the programs. Out: a constant of the runtime's `Table` for each, with its numbers as double precision
//! has them; and the exact table of a constant that is read back.

use proc_macro2::{Ident, Literal, Span, TokenStream};
use quote::quote;
use syn::Expr as Syntax;

use super::literal::{Scalar, literal, read};
use super::module::permission::for_numbers;
use super::names::Names;
use pebo_cas::graph::function::pieces::Pieces;
use pebo_cas::{Arena, Rational};
use pebo_design::program::Program;

/// The tables of a module with the names of their constants.
#[derive(Clone, Debug, Default)]
pub(super) struct Tables {
    named: Vec<(Pieces, String)>,
}

impl Tables {
    /// Those of the programs.
    pub(super) fn of<'a>(arena: &Arena, programs: impl Iterator<Item = &'a Program>) -> Self {
        let (mut named, mut names): (Vec<(Pieces, String)>, Names) = (Vec::new(), Names::default());
        for table in programs.flat_map(|program| &program.tables) {
            let table = Pieces { order: 0, ..table.clone() };
            if !named.iter().any(|(known, _)| *known == table) {
                let name = names.claim(&arena.table_name(&table)).to_uppercase();
                named.push((table, format!("TABLE_{name}")));
            }
        }
        Self { named }
    }

    /// The name of a table's constant, or of that of which it is a derivative.
    pub(super) fn name(&self, table: &Pieces) -> &str {
        let is_same = |known: &Pieces| known.knots == table.knots && known.coefficients == table.coefficients;
        self.named.iter().find(|(known, _)| is_same(known)).map_or("", |(_, name)| name)
    }

    /// All numbers.
    pub(super) fn numbers(&self) -> impl Iterator<Item = &Rational> {
        self.named.iter().flat_map(|(table, _)| table.knots.iter().chain(table.coefficients.iter().flatten()))
    }

    /// The constants; `doc` has the documentation of a line.
    pub(super) fn items(&self, arena: &Arena, scalar: Scalar, doc: impl Fn(&str) -> TokenStream) -> TokenStream {
        let ident = |name: &str| Ident::new(name, Span::call_site());
        let kind = ident(scalar.name());
        let item = |(table, name): &(Pieces, String)| {
            let (rows, columns) = (table.knots.len(), table.coefficients.first().map_or(0, Vec::len));
            let curve = if columns > 2 { "monotone cubics" } else { "lines" };
            let doc = doc(&format!(
                "`{}`: {curve} through {rows} points. From each on, its row has the coefficients of the powers of the \
                 distance.",
                arena.table_name(table)
            ));
            let numbers = |numbers: &[Rational]| numbers.iter().map(number_tokens).collect::<Vec<TokenStream>>();
            let points = numbers(&table.knots);
            let coefficients = table.coefficients.iter().map(|row| {
                let row = numbers(row);
                quote!([#(#row),*])
            });
            let (constant, [rows, columns]) = (ident(name), [rows, columns].map(Literal::usize_unsuffixed));
            // In either scalar, so that the text is one.
            let numbers = table.knots.iter().chain(table.coefficients.iter().flatten());
            let precision = for_numbers(Scalar::F32, numbers.filter_map(rounded));
            quote! {
                #doc
                #precision
                const #constant: Table<#kind, #rows, #columns> =
                    Table::new([#(#points),*], [#(#coefficients),*]);
            }
        };
        self.named.iter().map(item).collect()
    }
}

/// A number as double precision has it, in the fewest digits.
fn number_tokens(number: &Rational) -> TokenStream {
    let magnitude = number.abs();
    let text = rounded(&magnitude).and_then(|rounded| literal(&rounded));
    let text = text.unwrap_or_else(|| format!("{:?}", magnitude.to_f64()));
    let literal = syn::LitFloat::new(&text, Span::call_site());
    if number.is_negative() { quote!(-#literal) } else { quote!(#literal) }
}

/// The decimal of the fewest digits that is rounded as the number is; compilers round it again for single precision.
fn rounded(number: &Rational) -> Option<Rational> {
    Rational::from_decimal(&format!("{:e}", number.to_f64())).ok()
}

/// The table whose constant this is, among those of a model; none if it is of none of them.
pub(super) fn read_constant(tables: &[Pieces], syntax: &Syntax) -> Option<Pieces> {
    let Syntax::Call(call) = syntax else { return None };
    let Syntax::Path(path) = &*call.func else { return None };
    let segments: Vec<String> = path.path.segments.iter().map(|segment| segment.ident.to_string()).collect();
    if segments != ["Table", "new"] || call.args.len() != 2 {
        return None;
    }
    let points = list(&call.args[0])?;
    let Syntax::Array(rows) = &call.args[1] else { return None };
    let rows: Vec<Vec<Rational>> = rows.elems.iter().map(list).collect::<Option<_>>()?;
    let as_held = |number: &Rational| {
        let magnitude = rounded(&number.abs())?;
        Some(if number.is_negative() { -&magnitude } else { magnitude })
    };
    let all = |numbers: &[Rational]| numbers.iter().map(as_held).collect::<Option<Vec<Rational>>>();
    let is_it = |table: &&Pieces| {
        all(&table.knots).as_ref() == Some(&points)
            && table.coefficients.iter().map(|row| all(row)).collect::<Option<Vec<_>>>().as_ref() == Some(&rows)
    };
    tables.iter().find(is_it).cloned()
}

/// The numbers of an array.
fn list(syntax: &Syntax) -> Option<Vec<Rational>> {
    let Syntax::Array(array) = syntax else { return None };
    array.elems.iter().map(number).collect()
}

fn number(syntax: &Syntax) -> Option<Rational> {
    match syntax {
        Syntax::Unary(unary) if matches!(unary.op, syn::UnOp::Neg(_)) => Some(-&number(&unary.expr)?),
        Syntax::Lit(literal) => match &literal.lit {
            syn::Lit::Float(number) if number.suffix().is_empty() => read(number.base10_digits()),
            _ => None,
        },
        _ => None,
    }
}

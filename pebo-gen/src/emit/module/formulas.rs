//! The derived formulas as lines of documentation, in the author's names.
//!
//! In: plant and definitions. Out: lines, as the head of the module and its functions show them.

use super::abbreviation::Abbreviations;
use crate::emit::definition::{Definition, Definitions};
use pebo_cas::{Arena, Expr, Symbol};
use pebo_design::analysis::RegressionKind;
use pebo_design::plant::Plant;

/// The printer of formulas.
pub(super) type Print<'a> = (&'a Arena, &'a Abbreviations);

/// The formulas of a function.
pub(super) fn of(print: Print, definitions: &Definitions, definition: &Definition, width: usize) -> Vec<String> {
    match definition.name {
        "phi_left" => {
            let states: Vec<Symbol> = definitions.left_inverse.x.iter().map(|state| state.0).collect();
            named(print, &states, &definition.rows)
        }
        name => bracketed(print, name, &definition.rows, width),
    }
}

/// The unknowns of the regression are `theta` itself.
pub(super) fn is_linear(arena: &Arena, definitions: &Definitions) -> bool {
    let regression = &definitions.regression;
    regression.theta.iter().copied().eq(regression.eta_symbols.iter().map(|&eta| arena.of_symbol(eta)))
}

/// The equation that the unknown is estimated from.
pub(super) fn equation(plant: &Plant, definitions: &Definitions) -> String {
    let arena = &plant.arena;
    let unknown = if is_linear(arena, definitions) { "theta" } else { "eta" };
    match definitions.regression.kind {
        RegressionKind::Static => format!("phi_0 = phi_1 {unknown}"),
        RegressionKind::Implicit if definitions.functions.iter().any(|function| function.name == "primitive_1") => {
            format!("d/dt (primitive_0 + primitive_1 {unknown}) = phi_0 + phi_1 {unknown}")
        }
        RegressionKind::Implicit => format!("d/dt primitive_0 = phi_0 + phi_1 {unknown}"),
        RegressionKind::Dynamic => {
            let rows = definitions.regression.rows().into_iter();
            let outputs = rows.filter_map(|row| Some(plant.y.get(row)?.symbol));
            format!("{}' = phi_0 + phi_1 {unknown}", vector(arena, outputs))
        }
    }
}

/// Lines as a block.
pub(super) fn text(lines: Vec<String>) -> Vec<String> {
    let block = std::iter::once("```text".to_owned()).chain(lines).chain(["```".to_owned()]);
    std::iter::once(String::new()).chain(block).collect()
}

/// A line for each name.
pub(super) fn named((arena, abbreviations): Print, names: &[Symbol], rows: &[Vec<Expr>]) -> Vec<String> {
    let entries = names.iter().zip(rows.iter().flatten());
    entries.map(|(name, entry)| format!("{} = {}", arena.name(*name), abbreviations.print(arena, *entry))).collect()
}

/// A matrix with its columns aligned; its entries that are not zero, where a row of it would be longer than a line.
fn bracketed((arena, abbreviations): Print, name: &str, rows: &[Vec<Expr>], width: usize) -> Vec<String> {
    let entries: Vec<Vec<String>> =
        rows.iter().map(|row| row.iter().map(|&entry| abbreviations.print(arena, entry)).collect()).collect();
    let columns = entries.first().map_or(0, Vec::len);
    let widest = |column: usize| entries.iter().map(|row| row[column].chars().count()).max().unwrap_or(0);
    let widths: Vec<usize> = (0..columns).map(widest).collect();
    let rows = entries.iter().enumerate().map(|(index, row)| {
        let cells: Vec<String> = row.iter().zip(&widths).map(|(entry, &width)| format!("{entry:<width$}")).collect();
        let lead = if index == 0 { format!("{name} = ") } else { " ".repeat(name.len() + 3) };
        format!("{lead}[ {} ]", cells.join("   "))
    });
    let rows: Vec<String> = rows.collect();
    if rows.iter().all(|row| row.chars().count() <= width) {
        return rows;
    }
    let place = |row: usize, column: usize| {
        if columns == 1 { format!("{name}[{}]", row + 1) } else { format!("{name}[{}, {}]", row + 1, column + 1) }
    };
    let is_named = |entry: &String| entry != "0";
    let mut listed: Vec<String> = Vec::new();
    for (row, cells) in entries.iter().enumerate() {
        let named = cells.iter().enumerate().filter(|(_, entry)| is_named(entry));
        listed.extend(named.map(|(column, entry)| format!("{} = {entry}", place(row, column))));
    }
    if !entries.iter().flatten().all(is_named) {
        listed.push(format!("{name}[..] = 0 elsewhere"));
    }
    listed
}

/// Names in parentheses, unless there is one.
fn vector(arena: &Arena, symbols: impl Iterator<Item = Symbol>) -> String {
    let names: Vec<String> = symbols.map(|symbol| arena.name(symbol)).collect();
    if let [only] = names.as_slice() { only.clone() } else { format!("({})", names.join(", ")) }
}

//! A transform in the terms of the class of its plant: a frame T, or the factors T1 and T2.

use std::collections::BTreeSet;
use std::ops::Range;

use crate::plant::{Class, Plant};
use pebo_cas::domain::zero::is_zero;
use pebo_cas::{Expr, Symbol};

/// A key of the class with its matrix, by rows.
pub type Block = (&'static str, Vec<Vec<String>>);

/// The transform of a plant in the terms of the class with this key; none if it has another form.
pub fn blocks(plant: &Plant, class: &str) -> Option<Vec<Block>> {
    let outputs: Vec<Symbol> = plant.y.iter().map(|output| output.symbol).collect();
    let states: Vec<Symbol> = plant.x.iter().map(|state| state.symbol).collect();
    match class {
        Class::LTI => {
            let moving: BTreeSet<Symbol> = outputs.iter().chain(&states).copied().collect();
            let factors = factors(plant, &[states.as_slice(), &outputs].concat(), &moving)?;
            let part = |range: Range<usize>| factors.iter().map(|row| printed(plant, &row[range.clone()])).collect();
            Some(vec![("T1", part(0..states.len())), ("T2", part(states.len()..states.len() + outputs.len()))])
        }
        Class::MECHANICAL => {
            let factors = factors(plant, &states, &plant.hidden())?;
            if factors.len() != states.len() {
                return None;
            }
            // z = T' p
            let column = |index: usize| printed(plant, &factors.iter().map(|row| row[index]).collect::<Vec<Expr>>());
            Some(vec![("T", (0..states.len()).map(column).collect())])
        }
        // The transform of coils are their fluxes, which follow from L and mu.
        _ => None,
    }
}

/// The rows of factors with which phi is linear in these symbols, if it is, and the factors are free of moving symbols.
fn factors(plant: &Plant, of: &[Symbol], moving: &BTreeSet<Symbol>) -> Option<Vec<Vec<Expr>>> {
    let (arena, domain) = (&plant.arena, plant.domain());
    plant
        .transform()
        .into_iter()
        .map(|component| {
            let factors: Vec<Expr> = of.iter().map(|symbol| arena.derivative(component, *symbol)).collect();
            let terms = of.iter().zip(&factors).map(|(symbol, factor)| arena.mul(*factor, arena.of_symbol(*symbol)));
            let rest = arena.sub(component, arena.sum(terms.collect::<Vec<Expr>>()));
            let is_linear = factors.iter().all(|factor| !arena.depends_on(*factor, moving));
            (is_linear && is_zero(arena, rest, &domain)).then_some(factors)
        })
        .collect()
}

fn printed(plant: &Plant, row: &[Expr]) -> Vec<String> {
    row.iter().map(|entry| plant.arena.print(*entry)).collect()
}

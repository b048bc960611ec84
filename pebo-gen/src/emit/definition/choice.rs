//! Chooses among equal forms of the functions the cheapest that keeps its digits.
//!
//! In: the definitions as derived. Out: the emitted definitions, their programs, and their measured accuracy; of other
//! forms only the entries that lose digits. The derived form comes first. Only for an entry that loses digits in it,
//! also if its author's formulas do, other forms are tried; the first that keeps them by itself is taken, if fewer
//! entries lose digits then. If none does, the derived form is kept.

use std::collections::BTreeSet;

use super::{Definitions, GROUPS, tasks};
use crate::emit::accuracy::{Accuracy, Ground, Losing};
use crate::emit::literal::Scalar;
use pebo_cas::forms::tidy::{operations, others};
use pebo_cas::{Arena, Expr, Symbol};
use pebo_design::analysis::Derivation;
use pebo_design::plant::Plant;
use pebo_design::program::{StagedPrograms, UndeclaredSymbol};

/// Ways to write an entry that are tried.
const MOST_WAYS: usize = 12;

/// A form may take so many times the operations of the entry: longer ones are not tried, as each is measured.
const MOST_LONGER: usize = 4;

/// The part of the work that is left which these may take.
const SHARE: u64 = 2;

/// The emitted definitions and programs.
#[derive(Clone, Debug)]
pub(in crate::emit) struct Choice<'a> {
    pub(in crate::emit) definitions: Definitions<'a>,
    pub(in crate::emit) staged: StagedPrograms,
    /// Entries that lose digits.
    losing: Losing,
}

impl Choice<'_> {
    /// This, or the other if fewer entries lose digits in it.
    fn or_better(self, other: Self) -> Self {
        if other.lost() < self.lost() { other } else { self }
    }

    /// The number of entries that lose digits.
    fn lost(&self) -> usize {
        self.losing.values().map(BTreeSet::len).sum()
    }
}

/// Chooses for numbers of this type.
///
/// # Errors
/// [`UndeclaredSymbol`] if a function depends on a symbol that it does not get.
pub(in crate::emit) fn choose<'a>(
    plant: &Plant,
    derivation: &Derivation,
    (parameters, scalar): (&[Symbol], Scalar),
    definitions: &Definitions<'a>,
    is_zero: impl Fn(&Arena, Expr) -> bool,
) -> Result<(Choice<'a>, Accuracy), UndeclaredSymbol> {
    let arena = &plant.arena;
    let ground = Ground::of(plant, derivation, definitions);
    let of = |definitions: &Definitions<'a>, staged: StagedPrograms| {
        let losing = ground.losing(definitions, &staged, scalar);
        Choice { definitions: definitions.clone(), staged, losing }
    };
    let measured = |definitions: &Definitions<'a>| -> Result<Choice<'a>, UndeclaredSymbol> {
        let (cheaper, other) = tasks::staged(arena, parameters, definitions, &is_zero)?;
        let cheaper = of(definitions, cheaper);
        let Some(other) = other.filter(|_| !cheaper.losing.is_empty()) else { return Ok(cheaper) };
        Ok(cheaper.or_better(of(definitions, other)))
    };
    let domain = derivation.domain(plant);
    let mut choice = measured(definitions)?;
    for (function, entries) in choice.losing.clone() {
        if arena.budget().is_exhausted() {
            break;
        }
        let before = choice.definitions.clone();
        let better = arena.budget().share(SHARE, || -> Result<Option<Choice<'a>>, UndeclaredSymbol> {
            let keeps = |entry: Expr, form: Expr| {
                ground.keeps(form, entry, &before, scalar) && is_zero(arena, arena.sub(form, entry))
            };
            let other = rewritten(before.clone(), function, |place, entry| {
                // An entry that keeps its digits may be shorter beside one that does not: they share their work.
                let is_losing = entries.contains(&place);
                let own = operations(arena, entry);
                let most = if is_losing { MOST_LONGER * own } else { own.saturating_sub(1) };
                let mut forms = others(arena, &domain, entry, most).take(MOST_WAYS);
                forms.find(|form| keeps(entry, *form))
            });
            let Some(other) = other else { return Ok(None) };
            let other = measured(&other)?;
            // A form that was not measured to the end may lose digits all the same.
            Ok((!arena.budget().is_exhausted()).then_some(other))
        })?;
        if let Some(better) = better {
            choice = choice.or_better(better);
        }
    }
    let accuracy = ground.measure(&choice.definitions, &choice.staged);
    Ok((choice, accuracy))
}

/// The definitions with the entries of a function written as `better` says; none if it does not say of any.
fn rewritten<'a>(
    mut definitions: Definitions<'a>,
    function: &str,
    better: impl Fn(usize, Expr) -> Option<Expr>,
) -> Option<Definitions<'a>> {
    let members = GROUPS.iter().find(|(name, ..)| *name == function).map_or(&[][..], |group| group.2);
    let functions = definitions.functions.iter_mut().filter(|definition| members.contains(&definition.name));
    let mut changed = false;
    for (place, entry) in functions.flat_map(|definition| definition.rows.iter_mut().flatten()).enumerate() {
        if let Some(form) = better(place, *entry) {
            *entry = form;
            changed = true;
        }
    }
    changed.then_some(definitions)
}

//! Of equal forms of the functions, the cheapest that keeps its digits.
//!
//! In: the definitions as derived. Out: the definitions that are emitted, their programs, and the accuracy measured of
//! these; of the others only which functions lose digits. What was derived comes first. Only for a function that loses
//! digits that way, also where its author's formulas do, other ways to write it are tried; the first that keeps them is
//! taken. If none does, it stays as it was derived.

use super::accuracy::{Accuracy, Ground};
use super::definition::{Definitions, GROUPS};
use super::literal::Scalar;
use super::tasks;
use crate::analysis::Derivation;
use crate::cas::tidy::others;
use crate::cas::{Arena, Expr, Symbol};
use crate::plant::Plant;
use crate::program::{Staged, Undeclared};

/// Ways to write a function that are tried.
const MOST_WAYS: usize = 4;

/// The part of the work that is left which these may take.
const SHARE: u64 = 2;

/// What is emitted.
#[derive(Clone, Debug)]
pub(super) struct Choice<'a> {
    pub(super) definitions: Definitions<'a>,
    pub(super) staged: Staged,
    /// The functions that lose digits.
    losing: Vec<&'static str>,
}

impl Choice<'_> {
    /// This, or the other if fewer functions lose digits in it.
    fn or_better(self, other: Self) -> Self {
        if other.losing.len() < self.losing.len() { other } else { self }
    }
}

/// Chooses for numbers of this type.
///
/// # Errors
/// [`Undeclared`] if a function depends on a symbol that it does not get.
pub(super) fn choose<'a>(
    plant: &Plant,
    derivation: &Derivation,
    (parameters, scalar): (&[Symbol], Scalar),
    definitions: &Definitions<'a>,
    is_zero: impl Fn(&Arena, Expr) -> bool,
) -> Result<(Choice<'a>, Accuracy), Undeclared> {
    let arena = &plant.arena;
    let ground = Ground::of(plant, derivation);
    let of = |definitions: &Definitions<'a>, staged: Staged| {
        let losing = ground.losing(definitions, &staged, scalar);
        Choice { definitions: definitions.clone(), staged, losing }
    };
    let measured = |definitions: &Definitions<'a>| -> Result<Choice<'a>, Undeclared> {
        let (cheaper, other) = tasks::staged(arena, parameters, definitions, &is_zero)?;
        let cheaper = of(definitions, cheaper);
        let Some(other) = other.filter(|_| !cheaper.losing.is_empty()) else { return Ok(cheaper) };
        Ok(cheaper.or_better(of(definitions, other)))
    };
    let mut choice = measured(definitions)?;
    for function in choice.losing.clone() {
        if arena.budget().is_exhausted() {
            break;
        }
        let before = choice.definitions.clone();
        let better = arena.budget().share(SHARE, || -> Result<Option<Choice<'a>>, Undeclared> {
            for other in rewritten(plant, derivation, &before, function, &is_zero) {
                let other = measured(&other)?;
                // What was not measured to the end may lose digits all the same.
                if arena.budget().is_exhausted() {
                    break;
                }
                if !other.losing.contains(&function) {
                    return Ok(Some(other));
                }
            }
            Ok(None)
        })?;
        if let Some(better) = better {
            choice = choice.or_better(better);
        }
    }
    let accuracy = ground.measure(&choice.definitions, &choice.staged);
    Ok((choice, accuracy))
}

/// The definitions with what a function computes written in other ways.
fn rewritten<'a>(
    plant: &Plant,
    derivation: &Derivation,
    definitions: &Definitions<'a>,
    function: &str,
    is_zero: impl Fn(&Arena, Expr) -> bool,
) -> impl Iterator<Item = Definitions<'a>> {
    let arena = &plant.arena;
    let domain = derivation.domain(plant);
    let members = GROUPS.iter().find(|(name, ..)| *name == function).map_or(&[][..], |group| group.2);
    let entries = |definitions: &Definitions| -> Vec<Expr> {
        let members = definitions.functions.iter().filter(|definition| members.contains(&definition.name));
        members.flat_map(|definition| definition.rows.concat()).collect()
    };
    let ways: Vec<(Expr, Vec<Expr>)> =
        entries(definitions).into_iter().map(|entry| (entry, others(arena, &domain, entry))).collect();
    let most = ways.iter().map(|(_, forms)| forms.len()).max().unwrap_or(0).min(MOST_WAYS);
    let definitions = definitions.clone();
    (0..most).map(move |way| {
        let mut forms = ways.iter().map(|(entry, forms)| {
            let form = forms.get(way).copied().filter(|form| is_zero(arena, arena.sub(*form, *entry)));
            form.unwrap_or(*entry)
        });
        let mut other = definitions.clone();
        for definition in other.functions.iter_mut().filter(|definition| members.contains(&definition.name)) {
            for entry in definition.rows.iter_mut().flatten() {
                *entry = forms.next().unwrap_or(*entry);
            }
        }
        other
    })
}

//! The functions of `Model` as tasks that share their work.
//!
//! In: the definitions. Out: their programs. A regression that is affine in the extension is computed by
//! its factors where that takes less work and keeps the digits; the caller's zero test must confirm that it is.

use std::collections::BTreeMap;

use super::definition::{Argument, Definitions, Group, VELOCITY};
use crate::analysis::RegressionKind;
use crate::cas::{Arena, Expr, Symbol};
use crate::program::{Cost, Staged, Task, Undeclared, stage};

/// The programs of all groups, in their order; where they are computed by the factors of the regression, those as derived
/// too.
pub(super) fn staged(
    arena: &Arena,
    parameters: &[Symbol],
    definitions: &Definitions,
    is_zero: impl Fn(&Arena, Expr) -> bool,
) -> Result<(Staged, Option<Staged>), Undeclared> {
    let sampled = definitions.symbols(Argument::Y);
    let as_derived = tasks(definitions);
    let derived = stage(arena, parameters, &sampled, &as_derived)?;
    let Some(affine) = Affine::of(arena, definitions, &is_zero) else {
        return Ok((derived, None));
    };
    let mut by_factors = as_derived;
    for (group, task) in definitions.groups().iter().zip(&mut by_factors) {
        let outputs = match group.name {
            "regression" => Some(affine.outputs.clone()),
            VELOCITY => affine.velocities(arena, definitions, group, &is_zero),
            _ => None,
        };
        if let Some(outputs) = outputs {
            task.parts.clone_from(&affine.factors);
            task.outputs = outputs;
        }
    }
    let shared = stage(arena, parameters, &sampled, &by_factors)?;
    // A sum that is multiplied out loses digits where its summands cancel: it has to be worth it.
    let saves = 10 * work(&shared, definitions) <= 9 * work(&derived, definitions);
    Ok(if saves { (shared, Some(derived)) } else { (derived, None) })
}

fn tasks(definitions: &Definitions) -> Vec<Task> {
    let groups = definitions.groups();
    let task = groups.iter().map(|group| Task {
        arguments: varying(&group.arguments).flat_map(|argument| definitions.symbols(argument)).collect(),
        parts: Vec::new(),
        outputs: group.members.iter().flat_map(|member| member.rows.concat()).collect(),
        is_regular: group.name != VELOCITY,
    });
    task.collect()
}

/// The arguments besides the terms of the sample.
pub(super) fn varying(arguments: &[Argument]) -> impl Iterator<Item = Argument> {
    arguments.iter().copied().filter(|&argument| argument != Argument::Y)
}

/// A regression by the factors B of the coordinates: `phi_0 = A + B chi` with `phi_1 = B`, or `phi_0 = A + B xi` with
/// `phi_1 = B Psi`.
struct Affine {
    /// The entries of B that are not zero, by names.
    factors: Vec<(Symbol, Expr)>,
    /// `phi_0`, then `phi_1` by rows, in these names.
    outputs: Vec<Expr>,
}

impl Affine {
    /// None if the regression is not of this form, or has nothing that both sides share.
    fn of(arena: &Arena, definitions: &Definitions, is_zero: impl Fn(&Arena, Expr) -> bool) -> Option<Self> {
        let rows = |name| definitions.functions.iter().find(|function| function.name == name).map(|found| &found.rows);
        let (phi_0, phi_1) = (rows("phi_0")?, rows("phi_1")?);
        let (chi, psi) = (&definitions.chi, &definitions.psi);
        if definitions.regression.eta_symbols.len() != chi.len() {
            return None;
        }
        // Y = S eta: what the extension knows of it is taken away.
        let sign = if definitions.regression.kind == RegressionKind::Static { arena.number(-1) } else { arena.one() };
        let still: BTreeMap<Symbol, Expr> = chi.iter().map(|&chi| (chi, arena.zero())).collect();
        let diagonal = |row, column| if row == column { arena.one() } else { arena.zero() };
        let entries = psi.iter().enumerate().flat_map(|(column, entries)| {
            entries.iter().enumerate().map(move |(row, &entry)| (entry, diagonal(row, column)))
        });
        let identity: BTreeMap<Symbol, Expr> = entries.collect();

        let (mut factors, mut known, mut regressor) = (Vec::new(), Vec::new(), Vec::new());
        for (row, (entry_0, entries_1)) in phi_0.iter().zip(phi_1).enumerate() {
            let entry_0 = *entry_0.first()?;
            let values = arena.substitute_all(entries_1, &identity);
            let rest = arena.substitute(entry_0, &still);
            let moved =
                chi.iter().zip(&values).map(|(&chi, &factor)| arena.product([sign, arena.of_symbol(chi), factor]));
            let affine = moved.fold(rest, |sum, summand| arena.add(sum, summand));
            if affine != entry_0 && !is_zero(arena, arena.sub(affine, entry_0)) {
                return None;
            }
            let names = values.iter().enumerate().map(|(column, &value)| {
                if arena.as_number(value).is_some() {
                    return value;
                }
                let name = arena.generated(&format!("B[{row},{column}]"));
                factors.push((name, value));
                arena.of_symbol(name)
            });
            let names: Vec<Expr> = names.collect();
            let moved = chi.iter().zip(&names).map(|(&chi, &name)| arena.product([sign, arena.of_symbol(chi), name]));
            known.push(moved.fold(rest, |sum, summand| arena.add(sum, summand)));
            for (column, &entry) in entries_1.iter().enumerate() {
                regressor.push(match definitions.psi_entries.get(column) {
                    None => names[column],
                    Some(psi) => {
                        let product = arena.sum(psi.iter().zip(&names).map(|(&p, &b)| arena.mul(p, b)));
                        let plain = arena.sum(psi.iter().zip(&values).map(|(&p, &b)| arena.mul(p, b)));
                        if plain != entry && !is_zero(arena, arena.sub(plain, entry)) {
                            return None;
                        }
                        product
                    }
                });
            }
        }
        let outputs = known.into_iter().chain(regressor).collect();
        (!factors.is_empty()).then_some(Self { factors, outputs })
    }
}

impl Affine {
    /// The velocities, where they are what the regression says of the rates of all outputs.
    fn velocities(
        &self,
        arena: &Arena,
        definitions: &Definitions,
        group: &Group,
        is_zero: impl Fn(&Arena, Expr) -> bool,
    ) -> Option<Vec<Expr>> {
        let z = definitions.symbols(Argument::Z).into_iter().map(|z| arena.of_symbol(z));
        let coordinates: BTreeMap<Symbol, Expr> = definitions.chi.iter().copied().zip(z).collect();
        let count = definitions.regression.phi_0.len();
        let rates = arena.substitute_all(&self.outputs[..count], &coordinates);
        let factors: BTreeMap<Symbol, Expr> = self.factors.iter().copied().collect();
        let rows: Vec<Expr> = group.members.iter().flat_map(|member| member.rows.concat()).collect();
        let plain = arena.substitute_all(&rates, &factors);
        let same = |(a, b): (&Expr, &Expr)| a == b || is_zero(arena, arena.sub(*a, *b));
        (rows.len() == count && plain.iter().zip(&rows).all(same)).then_some(rates)
    }
}

/// The work of a step: a sample once, flow, regression and primitives at both ends.
fn work(staged: &Staged, definitions: &Definitions) -> usize {
    let programs = definitions.groups().into_iter().zip(&staged.programs).map(|(group, program)| {
        let times = if ["flow", "regression", "primitive"].contains(&group.name) { 2 } else { 1 };
        times * Cost::of(program).weighted()
    });
    Cost::of(&staged.sample).weighted() + programs.sum::<usize>()
}

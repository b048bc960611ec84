//! The functions of `Model` as tasks that share their work.
//!
//! In: the definitions. Out: their programs. An equation of a regression that is affine in the extension is computed by
//! its factors where that takes less work, `A + B chi` with the B that its regressor is, and so are the velocities; the
//! caller's zero test must confirm that it is affine.

use std::collections::BTreeMap;

use super::{Argument, Definitions, OUTPUT_SLOPES, VELOCITY};
use pebo_cas::{Arena, Expr, Symbol};
use pebo_design::analysis::RegressionKind;
use pebo_design::program::{Cost, StagedPrograms, Task, UndeclaredSymbol, stage};

/// More choices are made at once, not one by one.
const MOST_SWITCHES: usize = 12;

/// The programs of all groups, in their order; where any is computed by the factors of the regression, those as derived
/// too.
pub(in crate::emit) fn staged(
    arena: &Arena,
    parameters: &[Symbol],
    definitions: &Definitions,
    is_zero: impl Fn(&Arena, Expr) -> bool,
) -> Result<(StagedPrograms, Option<StagedPrograms>), UndeclaredSymbol> {
    let sampled = definitions.symbols(Argument::Y);
    let derived = stage(arena, parameters, &sampled, &tasks(definitions))?;
    let Some(affine) = Affine::of(arena, definitions, &is_zero) else {
        return Ok((derived, None));
    };
    let attempt = |by_factors: &[bool]| -> Result<(usize, StagedPrograms), UndeclaredSymbol> {
        let staged = stage(arena, parameters, &sampled, &affine.tasks(arena, definitions, by_factors))?;
        Ok((work(&staged, definitions), staged))
    };
    let switches = affine.rows.len() + usize::from(affine.has_velocity);
    let of_derived = work(&derived, definitions);
    let mut chosen = vec![true; switches];
    let (mut least, mut best) = attempt(&chosen)?;
    if of_derived <= least {
        chosen = vec![false; switches];
        (least, best) = (of_derived, derived.clone());
    }
    for switch in (0..switches).filter(|_| switches <= MOST_SWITCHES) {
        chosen[switch] = !chosen[switch];
        let (work, staged) = attempt(&chosen)?;
        if work < least {
            (least, best) = (work, staged);
        } else {
            chosen[switch] = !chosen[switch];
        }
    }
    Ok(if chosen.contains(&true) { (best, Some(derived)) } else { (derived, None) })
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
pub(in crate::emit) fn varying(arguments: &[Argument]) -> impl Iterator<Item = Argument> {
    arguments.iter().copied().filter(|&argument| argument != Argument::Y)
}

/// A regression by the factors B of the coordinates: `phi_0 = A + B chi` with `phi_1 = B`, or `phi_0 = A + B xi` with
/// `phi_1 = B Psi`.
struct Affine {
    rows: Vec<Row>,
    /// The velocities are the rates of the regression.
    has_velocity: bool,
}

/// An equation by its factors.
struct Row {
    /// The entries of B that are not numbers, by names.
    factors: Vec<(Symbol, Expr)>,
    /// The entry of `phi_0` in these names.
    known: Expr,
    /// The entries of `phi_1` in these names.
    regressor: Vec<Expr>,
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
        // Y = S eta: the known terms of the extension are subtracted.
        let sign = if definitions.regression.kind == RegressionKind::Static { arena.number(-1) } else { arena.one() };
        let still: BTreeMap<Symbol, Expr> = chi.iter().map(|&chi| (chi, arena.zero())).collect();
        let diagonal = |row, column| if row == column { arena.one() } else { arena.zero() };
        let entries = psi.iter().enumerate().flat_map(|(column, entries)| {
            entries.iter().enumerate().map(move |(row, &entry)| (entry, diagonal(row, column)))
        });
        let identity: BTreeMap<Symbol, Expr> = entries.collect();
        let same = |a: Expr, b: Expr| a == b || is_zero(arena, arena.sub(a, b));

        let mut found = Vec::new();
        for (row, (entry_0, entries_1)) in phi_0.iter().zip(phi_1).enumerate() {
            let entry_0 = *entry_0.first()?;
            let values = arena.substitute_all(entries_1, &identity);
            let rest = arena.substitute(entry_0, &still);
            let affine = |factors: &[Expr]| {
                let moved =
                    chi.iter().zip(factors).map(|(&chi, &factor)| arena.product([sign, arena.of_symbol(chi), factor]));
                moved.fold(rest, |sum, summand| arena.add(sum, summand))
            };
            if !same(affine(&values), entry_0) {
                return None;
            }
            let mut factors: Vec<(Symbol, Expr)> = Vec::new();
            let names = values.iter().enumerate().map(|(column, &value)| {
                if arena.as_number(value).is_some() {
                    return value;
                }
                if let Some((name, _)) = factors.iter().find(|factor| factor.1 == value) {
                    return arena.of_symbol(*name);
                }
                let name = arena.generated(&format!("B[{row},{column}]"));
                factors.push((name, value));
                arena.of_symbol(name)
            });
            let names: Vec<Expr> = names.collect();
            let mut regressor = Vec::new();
            for (column, &entry) in entries_1.iter().enumerate() {
                regressor.push(match definitions.psi_entries.get(column) {
                    None => names[column],
                    Some(psi) => {
                        let product = arena.sum(psi.iter().zip(&names).map(|(&p, &b)| arena.mul(p, b)));
                        let plain = arena.sum(psi.iter().zip(&values).map(|(&p, &b)| arena.mul(p, b)));
                        if !same(plain, entry) {
                            return None;
                        }
                        product
                    }
                });
            }
            found.push(Row { factors, known: affine(&names), regressor });
        }
        if found.iter().all(|row| row.factors.is_empty()) {
            return None;
        }
        let mut affine = Self { rows: found, has_velocity: false };
        let factors: BTreeMap<Symbol, Expr> = affine.rows.iter().flat_map(|row| row.factors.iter().copied()).collect();
        let rates = affine.rates(arena, definitions, &vec![true; affine.rows.len()]);
        let plain = arena.substitute_all(&rates, &factors);
        affine.has_velocity = rows(VELOCITY).is_some_and(|velocities| {
            let velocities = velocities.concat();
            velocities.len() == plain.len() && plain.iter().zip(&velocities).all(|(&a, &b)| same(a, b))
        });
        Some(affine)
    }

    /// The rates of the outputs, the chosen ones in the names of the factors, with the coordinates in place of the
    /// extension.
    fn rates(&self, arena: &Arena, definitions: &Definitions, chosen: &[bool]) -> Vec<Expr> {
        let z = definitions.symbols(Argument::Z).into_iter().map(|z| arena.of_symbol(z));
        let coordinates: BTreeMap<Symbol, Expr> = definitions.chi.iter().copied().zip(z).collect();
        let derived = definitions.functions.iter().find(|function| function.name == "phi_0");
        let derived = derived.into_iter().flat_map(|function| function.rows.concat());
        let rows = self.rows.iter().zip(derived).zip(chosen);
        let known: Vec<Expr> = rows.map(|((row, derived), &chosen)| if chosen { row.known } else { derived }).collect();
        arena.substitute_all(&known, &coordinates)
    }

    /// The tasks with the chosen equations by factors; the last of the choices is that of the velocities.
    fn tasks(&self, arena: &Arena, definitions: &Definitions, chosen: &[bool]) -> Vec<Task> {
        let mut tasks = tasks(definitions);
        for (group, task) in definitions.groups().iter().zip(&mut tasks) {
            if group.name == "regression" {
                let count = self.rows.len();
                let mut first = count;
                for (place, row) in self.rows.iter().enumerate() {
                    if chosen[place] {
                        task.parts.extend(&row.factors);
                        task.outputs[place] = row.known;
                        task.outputs[first..first + row.regressor.len()].copy_from_slice(&row.regressor);
                    }
                    first += row.regressor.len();
                }
            } else if group.name == VELOCITY && chosen.get(self.rows.len()) == Some(&true) {
                let by_factors = self.rows.iter().zip(chosen).filter(|(_, chosen)| **chosen);
                task.parts = by_factors.flat_map(|(row, _)| row.factors.iter().copied()).collect();
                task.outputs = self.rates(arena, definitions, chosen);
            }
        }
        tasks
    }
}

/// The work of a step: a sample once, flow, regression, primitives and slopes at both ends.
fn work(staged: &StagedPrograms, definitions: &Definitions) -> usize {
    let programs = definitions.groups().into_iter().zip(&staged.programs).map(|(group, program)| {
        let times = if ["flow", "regression", "primitive", OUTPUT_SLOPES].contains(&group.name) { 2 } else { 1 };
        times * Cost::of(program).weighted()
    });
    Cost::of(&staged.sample).weighted() + programs.sum::<usize>()
}

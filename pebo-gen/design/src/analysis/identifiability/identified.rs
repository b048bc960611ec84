//! The combinations of the unknowns that are identified where others are hidden.
//!
//! In: the rows of a set of trajectories with the directions that they do not observe. Out: combinations that span what
//! the rows show, at every point of the set. A basis by elimination does where its pivots have no zeros; else the rows
//! themselves are the combinations, perhaps more of them than their rank: of a field that is seen in three components,
//! `m x (z1, z2, z3)` has three, and any two of them say less where the third component of m is zero.

use std::collections::{BTreeMap, BTreeSet};

use pebo_cas::forms::tidy::{operations, shortest};
use pebo_cas::graph::conditions::Regularity;
use pebo_cas::linear::rank::{null_vectors, proved_rank};
use pebo_cas::{Arena, Domain, Expr, Node, Rational, Relation, Symbol};

use super::observation::{Observation, free_columns};
use super::singular::take_common;

/// The combinations, in these symbols of the unknowns. With unmeasured states for factors, combinations are only counted:
/// then they are a basis.
pub(super) fn combinations(
    arena: &Arena,
    domain: &Domain,
    (symbols, unmeasured): (&[Symbol], &BTreeSet<Symbol>),
    observed: &Observation,
) -> Vec<Expr> {
    let basis = basis(arena, domain, symbols.len(), &observed.hidden);
    let is_basis_throughout = basis
        .iter()
        .all(|(pivot, row)| domain.grants(arena, (*pivot, Relation::NonZero)) && have_values(arena, domain, row));
    let rows: Vec<Vec<Expr>> = basis.into_iter().map(|(_, row)| row).collect();
    let shown = if is_basis_throughout { None } else { as_observed(arena, domain, &rows, &observed.stack) };
    let shown = shown.filter(|shown| !shown.iter().flatten().any(|factor| arena.depends_on(*factor, unmeasured)));
    let unknowns: Vec<Expr> = symbols.iter().map(|symbol| arena.of_symbol(*symbol)).collect();
    let shorter = |form: Expr| [form, arena.neg(form)].into_iter().min_by_key(|form| arena.print(*form).len());
    shown.unwrap_or(rows).iter().filter_map(|row| shorter(arena.dot(row, &unknowns))).collect()
}

/// Rows of the combinations that do not change along the hidden directions, without denominators that may vanish, each
/// with its pivot.
fn basis(arena: &Arena, domain: &Domain, unknowns: usize, hidden: &[Vec<Expr>]) -> Vec<(Expr, Vec<Expr>)> {
    let free = free_columns(arena, hidden, unknowns);
    let combination = |column: usize| {
        let mut row = vec![arena.zero(); unknowns];
        row[column] = arena.one();
        for (vector, free) in hidden.iter().zip(&free) {
            if let Some(free) = free {
                row[*free] = arena.neg(shortest(arena, domain, vector[column]));
            }
        }
        let row = without_denominators(arena, domain, &row);
        (row[column], row)
    };
    (0..unknowns).filter(|column| !free.contains(&Some(*column))).map(combination).collect()
}

/// A row times the powers in its denominators that may vanish.
fn without_denominators(arena: &Arena, domain: &Domain, row: &[Expr]) -> Vec<Expr> {
    let mut common: BTreeMap<Expr, Rational> = BTreeMap::new();
    for entry in row {
        let Node::Product(product) = arena.node(*entry) else { continue };
        for (base, power) in product.factors.iter().filter(|(_, power)| power.is_negative()) {
            let most = common.entry(*base).or_insert(Rational::ZERO);
            *most = most.clone().max(-power);
        }
    }
    common.retain(|base, _| !domain.implies(arena, *base, Relation::NonZero));
    let whole =
        |factor: &Expr| arena.multiply(&Rational::ONE, common.clone().into_iter().chain([(*factor, Rational::ONE)]));
    row.iter().map(whole).collect()
}

/// The rows that were observed, short ones first, without those that follow from others at every point; none where they
/// hold other symbols than a basis, as rates of inputs, or do not reach its rank.
fn as_observed(arena: &Arena, domain: &Domain, basis: &[Vec<Expr>], stack: &[Vec<Expr>]) -> Option<Vec<Vec<Expr>>> {
    let unknowns = basis.first()?.len();
    let known = arena.symbols_of(&basis.concat());
    let mut rows: Vec<Vec<Expr>> = stack.to_vec();
    rows.retain(|row| row.iter().any(|entry| !arena.is_zero(*entry)));
    for row in &mut rows {
        take_common(arena, row);
        let numbers: Vec<Rational> = row.iter().filter_map(|entry| number(arena, *entry)).collect();
        if let Some(inverse) = numbers.iter().min().and_then(Rational::recip) {
            for entry in row {
                *entry = arena.scale(*entry, &inverse);
            }
        }
    }
    rows.sort_by_cached_key(|row| row.iter().map(|entry| operations(arena, *entry)).sum::<usize>());
    let mut shown: Vec<Vec<Expr>> = Vec::new();
    for row in rows {
        if !follows(arena, domain, &shown, &row) {
            shown.push(row);
        }
    }
    let is_known = arena.symbols_of(&shown.concat()).is_subset(&known);
    (is_known && proved_rank(arena, domain, &shown, unknowns) == basis.len()).then_some(shown)
}

/// The size of the number in a factor; none for zero.
fn number(arena: &Arena, factor: Expr) -> Option<Rational> {
    match arena.node(factor) {
        Node::Number(number) => Some(number.abs()).filter(|size| !size.is_zero()),
        Node::Product(product) => Some(product.coefficient.abs()),
        _ => Some(Rational::ONE),
    }
}

/// Tests whether a row is a combination of others with coefficients that have values on the whole domain.
fn follows(arena: &Arena, domain: &Domain, others: &[Vec<Expr>], row: &[Expr]) -> bool {
    let entries = |column: usize| others.iter().map(|other| other[column]).chain([row[column]]).collect();
    let transposed: Vec<Vec<Expr>> = (0..row.len()).map(entries).collect();
    let is_one = |vector: &Vec<Expr>| vector.last() == Some(&arena.one());
    let relations = null_vectors(arena, domain, &transposed, others.len() + 1).unwrap_or_default();
    relations.iter().any(|relation| is_one(relation) && have_values(arena, domain, relation))
}

/// Tests whether formulas have values on the whole domain.
fn have_values(arena: &Arena, domain: &Domain, formulas: &[Expr]) -> bool {
    let conditions = arena.domain_conditions(formulas, Regularity::Defined);
    conditions.into_iter().all(|condition| domain.grants(arena, condition))
}

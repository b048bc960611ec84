//! The strength of the excitation: `Phi_1' Phi_1`, its determinant, and a proof that this is positive throughout the
//! assumed domain (Ortega et al. 2015, remark R3).
//!
//! The proof uses the assumptions, factor by factor, or else divides the box that they bound until an enclosure of the
//! determinant is positive on every cell. The box is closed, so that the second way also covers its faces.

use std::collections::BTreeMap;

use crate::plant::Plant;
use pebo_cas::domain::Ranges;
use pebo_cas::domain::bounds::sign_on_box;
use pebo_cas::domain::zero::is_zero;
use pebo_cas::forms::oriented::oriented;
use pebo_cas::tower::{Field, Fraction, Obstacle};
use pebo_cas::{Arena, Domain, Expr, Rational, Symbol};

use super::singular::{Volume, ZeroSet};
use crate::analysis::design::{Gram, Positive};
use pebo_cas::forms::tidy::{shorter, shortest};

/// The conditions under which a regressor with full column rank at almost every point loses it, and its Gram matrix
/// where that could be worked out.
pub(super) fn of(plant: &Plant, domain: &Domain, phi_1: &[Vec<Expr>]) -> (ZeroSet, Option<Gram>) {
    let found = || -> Result<(ZeroSet, Gram), Obstacle> {
        let volume = Volume::of(&plant.arena, domain, phi_1)?;
        let mut zero_set = volume.zero_set(plant, domain)?;
        let gram = worked_out(plant, domain, phi_1, &volume, &zero_set)?;
        let symbols = plant.arena.symbols_of(&[gram.determinant]);
        let general = !plant.parameters.iter().any(|parameter| symbols.contains(&parameter.symbol));
        // Dividing the box may prove what no factor does; with parameters it does so for their values alone.
        if gram.positive.is_some() && general {
            zero_set.signals.clear();
            zero_set.all = true;
        }
        Ok((zero_set, gram))
    };
    found().map_or_else(|_| (ZeroSet::default(), None), |(zero_set, gram)| (zero_set, Some(gram)))
}

fn worked_out(
    plant: &Plant,
    domain: &Domain,
    phi_1: &[Vec<Expr>],
    volume: &Volume<'_>,
    zero_set: &ZeroSet,
) -> Result<Gram, Obstacle> {
    let columns = phi_1.first().map_or(0, Vec::len);
    let arena = &plant.arena;
    let field = Field::over(arena, &domain.facts, &phi_1.concat())?;
    let product = field.matrix(phi_1)?.gram(&field, columns)?;
    let columns: Vec<Vec<Expr>> = (0..columns).map(|column| phi_1.iter().map(|row| row[column]).collect()).collect();
    let written = |i: usize, j: usize| arena.dot(&columns[i], &columns[j]);
    let entry = |i: usize, j: usize, product: &Fraction| {
        let printed = shorter(arena, written(i, j), shortest(arena, domain, field.show(product)));
        oriented(arena, domain, printed)
    };
    let line = |(i, row): (usize, &Vec<Fraction>)| row.iter().enumerate().map(|(j, e)| entry(i, j, e)).collect();
    let matrix: Vec<Vec<Expr>> = product.rows().iter().enumerate().map(line).collect();
    let square = volume.square;
    let root = volume.printed();
    // Never negative, it is positive where it does not vanish.
    let positive = if zero_set.are_none() {
        Some(Positive::Assumed)
    } else {
        on_box(plant, domain, root, square).then_some(Positive::Divided)
    };
    let determinant = if square { arena.mul(root, root) } else { root };
    Ok(Gram { matrix, determinant: oriented(arena, domain, determinant), positive })
}

/// Tests whether an expression is positive, or of a square at least not zero, on the closed box of the assumptions.
fn on_box(plant: &Plant, domain: &Domain, expr: Expr, square: bool) -> bool {
    let sign = ranges(plant, domain, expr).and_then(|ranges| sign_on_box(&plant.arena, expr, ranges));
    sign.is_some_and(|positive| positive || square)
}

/// The ranges that values and assumptions give the symbols, or a turn of an angle; none if one is unbounded.
fn ranges(plant: &Plant, domain: &Domain, expr: Expr) -> Option<Ranges> {
    let arena = &plant.arena;
    let symbols = arena.symbols_of(&[expr]);
    let bounds = domain.bounds(arena, &symbols);
    let range = |symbol: Symbol| {
        let value = plant.parameters.iter().find(|p| p.symbol == symbol).and_then(|p| p.value.clone());
        let known = value.map(|value| (value.clone(), value)).or_else(|| bounds.get(&symbol).cloned());
        // More than a turn.
        let turn = || turns(arena, domain, expr, symbol).then(|| (Rational::from(-4), Rational::from(4)));
        Some((symbol, known.or_else(turn)?))
    };
    symbols.into_iter().map(range).collect()
}

/// Tests whether the expression is the same after a turn of the symbol.
fn turns(arena: &Arena, domain: &Domain, expr: Expr, symbol: Symbol) -> bool {
    let turn = arena.turn();
    let turned = BTreeMap::from([(symbol, arena.add(arena.of_symbol(symbol), turn))]);
    is_zero(arena, arena.sub(arena.substitute(expr, &turned), expr), domain)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::Identifiability;
    use crate::model::Model;
    use crate::source::Source;

    fn identified(assume: &str, rates: &str) -> Identifiability {
        let text = format!(
            "model: m\nparameters: {{k: 0.9}}\nx: [a, b]\ny: [p, q]\nu: [d, e]\nassume: [{assume}]\n\
             f_x: {{a: d, b: e}}\nf_y: {{{rates}}}\nphi: [a, b]\n"
        );
        let model = Model::parse(&Source::new("m", text.as_str()).unwrap()).unwrap();
        let plant = Plant::resolve(&model).unwrap();
        let derivation = crate::analysis::Derivation::derive(&plant);
        derivation.identifiability.result.unwrap()
    }

    fn gram_of(assume: &str, rates: &str) -> Gram {
        identified(assume, rates).gram.unwrap()
    }

    /// With another value of k the determinant may vanish, and values may be set at run time.
    #[test]
    fn a_proof_by_dividing_the_box_holds_for_the_values_of_parameters_alone() {
        let general = identified("0 < d < 0.9", "p: (1 + d*sin(e))*a + d*b, q: b");
        assert!(general.singular_where.is_empty() && general.everywhere_else);
        let special = identified("0 < d < 1", "p: (1 + k*d*sin(e))*a + d*b, q: b");
        assert_eq!(special.gram.unwrap().positive, Some(Positive::Divided));
        assert_eq!(special.singular_where, ["k*d*sin(e) + 1 = 0"]);
    }

    #[test]
    fn a_determinant_is_positive_where_it_is_proved() {
        // By the assumptions: (1 - d)^2 on the open interval.
        let facts = gram_of("0 < d < 1", "p: (1 - d)*a + d*b, q: b");
        assert_eq!(facts.positive, Some(Positive::Assumed));
        // By the bounds of a sine.
        let rates = "p: (1 + d*sin(e))*a + d*b, q: b";
        assert_eq!(gram_of("0 < d < 0.9, -3 < e < 3", rates).positive, Some(Positive::Assumed));
        assert_eq!(gram_of("0 < d < 1", rates).positive, Some(Positive::Assumed));
        // By division: 1 + d sin(e + d), whose sign no rule finds, on a turn of e.
        let rates = "p: (1 + d*sin(e + d))*a + d*b, q: b";
        assert_eq!(gram_of("0 < d < 0.9", rates).positive, Some(Positive::Divided));
    }

    #[test]
    fn a_determinant_that_vanishes_somewhere_is_not_called_positive() {
        for (assume, rates) in [
            ("0 < d < 2", "p: (1 - d)*a + d*b, q: b"),
            // On the face of the closed box.
            ("0 < d <= 1, -3 < e < 3", "p: (1 - d*cos(e))*a + d*b, q: b"),
            // At one point inside.
            ("-1 < d < 1, -1 < e < 1", "p: ((d - 1/3)^2 + (e - 1/7)^2)*a, q: b"),
            // Positive, but on no bounded box.
            ("0 < d < 0.9", "p: (2 + sin(e + e*d))*a + d*b, q: b"),
        ] {
            assert_eq!(gram_of(assume, rates).positive, None, "{assume}: {rates}");
        }
    }
}

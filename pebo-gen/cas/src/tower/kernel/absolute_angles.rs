//! Basis angles for long sums: absolute angles rather than those between neighbours.
//!
//! In: the roots of a field. Out: integer combinations of symbols, in which the arguments of its sines and cosines are
//! shorter sums than in the symbols; none if their sums are short. The sine of a sum of n angles has 2^(n-1) terms: a
//! chain of links whose author writes `q1 + q2 + .. + q6` has 32 terms in each q, and one in its links' absolute
//! angles, whose differences are the angles between links. The symbols within such a kernel are no longer separated: it
//! serves problems that do not need them.

use std::collections::{BTreeMap, BTreeSet};

use crate::graph::expr::{Expr, Node};
use crate::graph::function::Function;
use crate::{Arena, Rational};

/// Sums with fewer terms are unchanged: the result is then nearest to the author's formula.
const SHORT: u64 = 4;

/// The greatest number of symbols, and of arguments, in the search for a basis.
const MOST: usize = 64;

/// The basis, as expressions.
pub(in crate::tower) fn absolute_angles(arena: &Arena, roots: &[Expr]) -> Vec<Expr> {
    let Some((symbols, mut angles)) = written(arena, roots) else { return Vec::new() };
    let longest = |angles: &[Vec<i64>]| angles.iter().map(|angle| length(angle)).max().unwrap_or(0);
    if longest(&angles) < SHORT {
        return Vec::new();
    }
    let before = weight(&angles);
    let n = symbols.len();
    let mut basis: Vec<Vec<i64>> = (0..n).map(|i| (0..n).map(|j| i64::from(i == j)).collect()).collect();
    let mut least = before;
    // An angle `a b_i + c b_j` is `(a - s c) b_i + c (b_j + s b_i)`: the step that helps most, while one helps.
    while let Some((next, i, j, sign)) = steps(n)
        .map(|(i, j, sign)| (weight(&stepped(&angles, i, j, sign)), i, j, sign))
        .min()
        .filter(|(next, ..)| *next < least)
    {
        angles = stepped(&angles, i, j, sign);
        let added = basis[i].clone();
        for (entry, other) in basis[j].iter_mut().zip(added) {
            *entry += sign * other;
        }
        least = next;
    }
    if least > before / 2 {
        return Vec::new();
    }
    let shown = |angle: &Vec<i64>| {
        let terms = symbols.iter().zip(angle).map(|(symbol, times)| (*symbol, Rational::from(*times)));
        arena.combine(&Rational::ZERO, terms)
    };
    basis.iter().map(shown).collect()
}

/// The symbols in arguments of sines and cosines, and each argument's integer multiples of them; none if there are too
/// many.
fn written(arena: &Arena, roots: &[Expr]) -> Option<(Vec<Expr>, Vec<Vec<i64>>)> {
    let mut arguments: BTreeSet<Vec<(Expr, i64)>> = BTreeSet::new();
    for expr in arena.postorder(roots) {
        if let Node::Call(Function::Sin | Function::Cos | Function::Tan, operands) = arena.node(expr)
            && let Node::Sum(sum) = arena.node(operands[0])
        {
            let symbols = sum.terms.iter().filter(|(term, _)| arena.as_symbol(*term).is_some());
            arguments.insert(symbols.map(|(term, times)| Some((*term, times.to_i64()?))).collect::<Option<_>>()?);
        }
    }
    let symbols: BTreeSet<Expr> = arguments.iter().flatten().map(|(symbol, _)| *symbol).collect();
    if symbols.len() > MOST || arguments.len() > MOST {
        return None;
    }
    let places: BTreeMap<Expr, usize> = symbols.iter().enumerate().map(|(place, symbol)| (*symbol, place)).collect();
    let row = |argument: &Vec<(Expr, i64)>| {
        let mut row = vec![0; symbols.len()];
        for (symbol, times) in argument {
            row[places[symbol]] = *times;
        }
        row
    };
    let rows = arguments.iter().map(row).collect();
    Some((symbols.into_iter().collect(), rows))
}

fn steps(n: usize) -> impl Iterator<Item = (usize, usize, i64)> {
    let pairs = (0..n).flat_map(move |i| (0..n).map(move |j| (i, j))).filter(|(i, j)| i != j);
    pairs.flat_map(|(i, j)| [(i, j, 1), (i, j, -1)])
}

fn stepped(angles: &[Vec<i64>], i: usize, j: usize, sign: i64) -> Vec<Vec<i64>> {
    let mut stepped = angles.to_vec();
    for angle in &mut stepped {
        angle[i] -= sign * angle[j];
    }
    stepped
}

/// The number of basis angles in a sum.
fn length(angle: &[i64]) -> u64 {
    angle.iter().map(|times| times.unsigned_abs()).sum()
}

/// The terms of all sines.
fn weight(angles: &[Vec<i64>]) -> u64 {
    const MOST_DOUBLINGS: u64 = 40;
    angles.iter().map(|angle| 1_u64 << length(angle).min(MOST_DOUBLINGS)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Facts;
    use crate::tower::{Field, Obstacle};

    #[test]
    fn long_sums_are_short_in_absolute_angles() {
        let arena = Arena::new();
        let symbols: Vec<Expr> = (1..=6).map(|n| arena.variable(&format!("q{n}"))).collect();
        let sine = |range: std::ops::Range<usize>| arena.call(Function::Sin, &[arena.sum(symbols[range].to_vec())]);
        let chain: Vec<Expr> = (1..=6).map(|n| sine(0..n)).chain([sine(3..5)]).collect();
        let shown: Vec<String> = absolute_angles(&arena, &chain).iter().map(|angle| arena.print(*angle)).collect();
        assert_eq!(
            shown,
            [
                "q1",
                "q1 + q2",
                "q1 + q2 + q3",
                "q1 + q2 + q3 + q4",
                "q1 + q2 + q3 + q4 + q5",
                "q1 + q2 + q3 + q4 + q5 + q6"
            ]
        );
        assert!(absolute_angles(&arena, &chain[..3]).is_empty(), "short sums stay");
        assert!(absolute_angles(&arena, &[sine(0..6)]).len() == 6, "one long sum is an angle of its own");
    }

    #[test]
    fn fields_that_separate_symbols_split_the_sum() {
        let arena = Arena::new();
        let symbols: Vec<Expr> = ["a", "b", "c", "d"].map(|name| arena.variable(name)).to_vec();
        let sine = arena.call(Function::Sin, &[arena.sum(symbols)]);
        let kernels = |field: Result<Field<'_>, Obstacle>| field.unwrap().kernels().len();
        // Four symbols with a sine and a cosine each; or all of them in one sum, whose symbols are kernels too.
        assert_eq!(kernels(Field::over(&arena, &Facts::new(), &[sine])), 12);
        assert_eq!(kernels(Field::of_long_sums(&arena, &Facts::new(), &[sine])), 6);
    }
}

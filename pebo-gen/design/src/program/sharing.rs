//! Common denominators and pairs of factors of several products.
//!
//! In: the expressions that are lowered together. Out: an order of the factors of each product in
//! which a pair that others have too comes first. Common pairs are then one value.

use std::collections::BTreeMap;

use super::product::is_half;
use pebo_cas::{Arena, Expr, Node, Product, Rational};

/// A base and its exponent.
type Factor = (Expr, Rational);

/// The number of products with a denominator, and with a pair of factors.
#[derive(Debug, Default)]
pub(super) struct Sharing {
    denominators: BTreeMap<Vec<Factor>, usize>,
    pairs: BTreeMap<(Factor, Factor), usize>,
}

/// Larger products are not searched for pairs.
const MOST_FACTORS: usize = 32;

impl Sharing {
    /// Counts in all products that the roots consist of.
    pub(super) fn of(arena: &Arena, roots: &[Expr]) -> Self {
        let mut sharing = Self::default();
        for expr in arena.postorder(roots) {
            let Node::Product(product) = arena.node(expr) else {
                continue;
            };
            let below = denominators(&product);
            if !below.is_empty() {
                *sharing.denominators.entry(below).or_insert(0) += 1;
            }
            let factors = &product.factors;
            if factors.len() <= MOST_FACTORS {
                for (index, first) in factors.iter().enumerate() {
                    for second in &factors[index + 1..] {
                        let pair = (first.clone(), second.clone());
                        *sharing.pairs.entry(pair).or_insert(0) += 1;
                    }
                }
            }
        }
        sharing
    }

    /// Tests whether more than one product divides by these powers.
    pub(super) fn is_shared(&self, denominators: &[Factor]) -> bool {
        self.denominators.get(denominators).is_some_and(|&products| products > 1)
    }

    /// The factors with the pair first that most products have; of equals, the one entered first.
    pub(super) fn arranged(&self, factors: &[Factor]) -> Vec<Factor> {
        let mut arranged = factors.to_vec();
        let mut best: Option<(usize, usize, usize)> = None;
        for first in 0..factors.len().min(MOST_FACTORS) {
            for second in first + 1..factors.len().min(MOST_FACTORS) {
                let pair = (factors[first].clone(), factors[second].clone());
                let products = self.pairs.get(&pair).copied().unwrap_or(0);
                if products > best.map_or(1, |best| best.0) {
                    best = Some((products, first, second));
                }
            }
        }
        if let Some((_, first, second)) = best {
            arranged[..=first].rotate_right(1);
            arranged[1..=second].rotate_right(1);
        }
        arranged
    }
}

/// The powers that a product divides by; a general power takes its sign along instead.
pub(super) fn denominators(product: &Product) -> Vec<Factor> {
    let divides = |factor: &&Factor| {
        let size = factor.1.abs();
        let fraction = &size - &Rational::from(size.floor());
        factor.1.is_negative() && (fraction.is_zero() || is_half(&fraction))
    };
    product.factors.iter().filter(divides).cloned().collect()
}

//! The components of the points of a domain at which further equations hold.
//!
//! In: a domain, equations, and the symbols that they are solved for. Out: domains, each with equations that no rule
//! found to be a product. Together they hold every point of the domain at which the equations hold: `a*(s - 1) = 0` is
//! `a = 0` or `s = 1`, and `a = 0` is left out where `a > 0` is assumed. A property proved at a point of a component
//! holds almost everywhere in it, where formulas are analytic.

use std::collections::BTreeSet;

use super::manifold::Manifold;
use super::reducible::{Factors, factors};
use crate::graph::expr::{Expr, Symbol};
use crate::tower::Obstacle;
use crate::{Arena, Domain};

/// The greatest number of components that are examined one by one.
const MOST_COMPONENTS: usize = 16;

impl Domain {
    /// The components on which the equations hold too, solved for symbols of the groups, the last of which are
    /// constants. None of them is known to be empty. An obstacle if there are too many, or if an equation remains that
    /// may hold in several ways.
    pub fn components(
        &self,
        arena: &Arena,
        equations: &[Expr],
        groups: &[BTreeSet<Symbol>],
    ) -> Result<Vec<Self>, Obstacle> {
        let own = self.manifold.equations().iter().chain(equations).copied().collect();
        let mut open: Vec<Vec<Expr>> = vec![own];
        let mut found = Vec::new();
        while let Some(equations) = open.pop() {
            let manifold = Manifold::new(arena, &self.facts, equations, groups.to_vec());
            let there = Self { manifold, ..self.clone() };
            match there.finer(arena)? {
                Some(finer) => open.extend(finer.into_iter().rev()),
                None => found.push(there),
            }
            if open.len() + found.len() > MOST_COMPONENTS {
                return Err(Obstacle::TooLarge);
            }
        }
        Ok(found)
    }

    /// The equations of finer components that hold the same points, if one of the equations is a product.
    fn finer(&self, arena: &Arena) -> Result<Option<Vec<Vec<Expr>>>, Obstacle> {
        let assumed = self.without_equations();
        let equations = self.manifold.reduced(arena);
        for (index, equation) in equations.iter().enumerate() {
            let replaced = |factor: Expr| {
                let mut finer = equations.clone();
                finer[index] = factor;
                finer
            };
            match factors(arena, &assumed, *equation)? {
                Factors::One => {}
                Factors::Several(factors) => return Ok(Some(factors.into_iter().map(replaced).collect())),
                Factors::Roots => return Err(Obstacle::Unsolved(arena.print(*equation))),
            }
        }
        Ok(None)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Rational, Relation};

    #[test]
    fn products_of_equations_are_taken_apart() {
        let arena = Arena::new();
        let [a, b, c] = ["a", "b", "c"].map(|name| arena.variable(name));
        let one = arena.one();
        let square = |e| arena.mul(e, e);
        let components = |equations: &[Expr], positive: &[Expr]| -> Option<Vec<String>> {
            let mut domain = Domain::default();
            for fact in positive {
                domain.facts.assume(*fact, Relation::Positive);
            }
            let symbols = [a, b, c].iter().filter_map(|e| arena.as_symbol(*e)).collect();
            let groups = [BTreeSet::new(), symbols, BTreeSet::new()];
            let shown = |there: Domain| {
                let equations: Vec<String> = there.manifold.reduced(&arena).iter().map(|e| arena.print(*e)).collect();
                equations.join(", ")
            };
            Some(domain.components(&arena, equations, &groups).ok()?.into_iter().map(shown).collect())
        };
        let product = arena.mul(a, arena.sub(b, one));
        assert_eq!(components(&[product], &[]).unwrap(), ["a", "b - 1"]);
        assert_eq!(components(&[product], &[a]).unwrap(), ["b - 1"]);
        assert_eq!(components(&[product], &[a, b]).unwrap(), ["b - 1"]);
        assert_eq!(components(&[product], &[a, arena.sub(b, arena.number(Rational::from(2)))]).unwrap(), [""; 0]);
        // A product after another equation is solved.
        assert_eq!(components(&[arena.sub(arena.mul(a, c), a), arena.sub(c, b)], &[]).unwrap().len(), 2);
        assert_eq!(components(&[arena.sub(square(a), square(b))], &[]).unwrap().len(), 2);
        assert_eq!(components(&[arena.add(square(a), one)], &[]).unwrap(), [""; 0]);
        // Three values of one symbol are not told apart.
        let cubic = arena.sum([arena.mul(a, square(a)), arena.scale(a, &Rational::from(-3)), one]);
        assert_eq!(components(&[cubic], &[]), None);
    }
}

//! Tests for special values of parameters inside functions of signals.
//!
//! In: rows of full rank. Out: true if a function in them holds a parameter that could make it constant, or equal to
//! another, as `sin(k*v)` and `sin(m*v)` are for k = m, or `tanh(k*v)` is for k = 0. The factors of a determinant are
//! those of a polynomial in such functions: they do not show these values.

use std::collections::BTreeSet;

use crate::analysis::identifiability::problem::ObservabilityProblem;
use pebo_cas::{Expr, Node, Relation, Symbol};

impl ObservabilityProblem<'_> {
    /// Tests whether values of the parameters may make functions in the rows constant or equal.
    pub(super) fn may_coincide(&self, stack: &[Vec<Expr>]) -> bool {
        let arena = &self.plant.arena;
        let parameters: BTreeSet<Symbol> = self.plant.parameters.iter().map(|parameter| parameter.symbol).collect();
        let mut arguments = BTreeSet::new();
        for part in arena.postorder(&stack.concat()) {
            match arena.node(part) {
                Node::Call(_, inner) => arguments.extend(inner.iter().copied()),
                Node::Product(product) => {
                    let roots = product.factors.iter().filter(|(_, exponent)| !exponent.is_integer());
                    arguments.extend(roots.map(|(base, _)| *base));
                }
                _ => {}
            }
        }
        let moving = |argument: &Expr| -> Vec<Symbol> {
            arena.symbols_of(&[*argument]).difference(&parameters).copied().collect()
        };
        arguments.retain(|argument| !moving(argument).is_empty());
        let varies = |argument: &Expr| {
            let steep =
                |symbol: Symbol| self.domain.implies(arena, arena.derivative(*argument, symbol), Relation::NonZero);
            moving(argument).into_iter().any(steep)
        };
        // One function that is never constant is independent of polynomials, whatever the values are.
        arguments.iter().any(|argument| arena.depends_on(*argument, &parameters))
            && !(arguments.len() == 1 && arguments.iter().all(varies))
    }
}

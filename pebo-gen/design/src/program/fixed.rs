//! Subexpressions that depend on given symbols alone.

use rustc_hash::FxHashSet;

use pebo_cas::{Arena, Expr, Node, Symbol};

/// Every sub-expression that depends on nothing but parameters.
pub(super) fn fixed(arena: &Arena, roots: &[Expr], parameters: &[Symbol]) -> FxHashSet<Expr> {
    let parameters: FxHashSet<Symbol> = parameters.iter().copied().collect();
    let mut fixed = FxHashSet::default();
    for expr in arena.postorder(roots) {
        let is_fixed = match arena.node(expr) {
            Node::Symbol(symbol) => parameters.contains(&symbol),
            _ => arena.operands(expr).iter().all(|operand| fixed.contains(operand)),
        };
        if is_fixed {
            fixed.insert(expr);
        }
    }
    fixed
}

//! Formulas some of whose functions stay as they are written.
//!
//! In: formulas, and the symbols that a question is about. Out: the same over fresh symbols, one for each function and
//! each root whose argument is free of those symbols; and the way back. Or in: formulas and some of their functions, for
//! which the symbols stand then. What is solved over them is an identity whatever
//! they stand for, so it is one of the formulas: it keeps `tanh(100*w)`, `sin(24*q)` and `1/(1 + sqrt(q))`, which a
//! normal form would write with exponentials, with powers of a cosine, and with `q - 1` below the bar. What needs a
//! relation among these functions is not seen this way.

use std::collections::{BTreeMap, BTreeSet};

use rustc_hash::FxHashMap;

use super::rational::Rational;
use super::{Arena, Expr, Node, Symbol};

/// The fresh symbols, with what they stand for.
pub(crate) struct Frozen<'a> {
    arena: &'a Arena,
    which: Which<'a>,
    symbols: FxHashMap<Expr, Expr>,
    values: BTreeMap<Symbol, Expr>,
}

/// What is replaced.
enum Which<'a> {
    /// Functions and roots of what is free of these symbols.
    FreeOf(&'a BTreeSet<Symbol>),
    /// These functions.
    Calls(&'a BTreeSet<Expr>),
}

impl<'a> Frozen<'a> {
    /// For a question about these symbols.
    pub(crate) fn new(arena: &'a Arena, about: &'a BTreeSet<Symbol>) -> Self {
        Self { arena, which: Which::FreeOf(about), symbols: FxHashMap::default(), values: BTreeMap::new() }
    }

    /// For a question in which these functions are to stay.
    pub(crate) fn calls(arena: &'a Arena, calls: &'a BTreeSet<Expr>) -> Self {
        Self { arena, which: Which::Calls(calls), symbols: FxHashMap::default(), values: BTreeMap::new() }
    }

    /// Formulas over the fresh symbols.
    pub(crate) fn freeze(&mut self, exprs: &[Expr]) -> Vec<Expr> {
        let arena = self.arena;
        let mut known: FxHashMap<Expr, Expr> = FxHashMap::default();
        for expr in arena.postorder(exprs) {
            let frozen = match arena.node(expr) {
                Node::Call(..) if self.stays(expr) => self.symbol_of(expr),
                Node::Product(product) if product.factors.iter().any(|(_, exponent)| !exponent.is_integer()) => {
                    let factors: Vec<(Expr, Rational)> = product
                        .factors
                        .iter()
                        .map(|(base, exponent)| match Rational::new(1, exponent.denominator()) {
                            // A power of the root.
                            Some(share) if !exponent.is_integer() && self.roots_stay(*base) => {
                                let root = self.symbol_of(arena.power(*base, &share));
                                (root, Rational::from(exponent.numerator()))
                            }
                            _ => (known[base], exponent.clone()),
                        })
                        .collect();
                    arena.multiply(&product.coefficient, factors)
                }
                _ => arena.rebuild(expr, &known),
            };
            known.insert(expr, frozen);
        }
        exprs.iter().map(|expr| known[expr]).collect()
    }

    /// Whether nothing was replaced.
    pub(crate) fn is_empty(&self) -> bool {
        self.values.is_empty()
    }

    /// A formula with what the fresh symbols stand for.
    pub(crate) fn thaw(&self, expr: Expr) -> Expr {
        self.arena.substitute(expr, &self.values)
    }

    /// Whether a function is replaced.
    fn stays(&self, expr: Expr) -> bool {
        match &self.which {
            Which::FreeOf(about) => {
                let symbols = self.arena.symbols_of(&[expr]);
                !symbols.is_empty() && symbols.is_disjoint(about)
            }
            Which::Calls(calls) => calls.contains(&expr),
        }
    }

    /// Whether a root of this is replaced.
    fn roots_stay(&self, base: Expr) -> bool {
        matches!(self.which, Which::FreeOf(_)) && self.stays(base)
    }

    fn symbol_of(&mut self, expr: Expr) -> Expr {
        if let Some(symbol) = self.symbols.get(&expr) {
            return *symbol;
        }
        let symbol = self.arena.generated(&format!("signal{}", self.values.len() + 1));
        self.values.insert(symbol, expr);
        self.symbols.insert(expr, self.arena.of_symbol(symbol));
        self.arena.of_symbol(symbol)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cas::function::Function;

    #[test]
    fn functions_of_signals_are_replaced_and_come_back() {
        let arena = Arena::new();
        let [x, y] = ["x", "y"].map(|name| arena.variable(name));
        let about = arena.symbols_of(&[x]);
        let half = Rational::new(1, 2).unwrap();
        let sine = arena.call(Function::Sin, &[y]);
        let written = [
            arena.mul(x, arena.call(Function::Tanh, &[sine])),
            arena.div(x, arena.add(arena.one(), arena.power(y, &half))),
            arena.power(y, &(&half + &Rational::ONE)),
            arena.call(Function::Sin, &[arena.add(x, sine)]),
            arena.power(arena.add(x, y), &half),
            arena.call(Function::Sin, &[arena.one()]),
        ];
        let mut frozen = Frozen::new(&arena, &about);
        let formulas = frozen.freeze(&written);
        let shown: Vec<String> = formulas.iter().map(|formula| arena.print(*formula)).collect();
        let expected = ["x*signal2", "x/(signal3 + 1)", "signal3^3", "sin(x + signal1)", "sqrt(x + y)", "sin(1)"]
            .map(str::to_owned);
        assert_eq!(shown, expected);
        assert!(!frozen.is_empty());
        let back: Vec<Expr> = formulas.iter().map(|formula| frozen.thaw(*formula)).collect();
        assert_eq!(back, written);
    }
    #[test]
    fn functions_that_stay_leave_the_others_to_the_normal_form() {
        let arena = Arena::new();
        let x = arena.variable("x");
        let [sine, tanh] = [Function::Sin, Function::Tanh].map(|function| arena.call(function, &[x]));
        let root = arena.sqrt(arena.mul(x, x));
        let calls = BTreeSet::from([tanh]);
        let mut frozen = Frozen::calls(&arena, &calls);
        let whole = arena.sum([arena.mul(sine, tanh), root, arena.call(Function::Exp, &[tanh])]);
        let shown: Vec<Expr> = frozen.freeze(&[whole]);
        assert_eq!(arena.print(shown[0]), "sqrt(x^2) + sin(x)*signal1 + exp(signal1)");
        assert_eq!(frozen.thaw(shown[0]), whole);
    }
}

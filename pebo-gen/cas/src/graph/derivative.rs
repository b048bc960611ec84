//! Differentiation and simultaneous substitution: one pass over the graph each.

use std::collections::BTreeMap;

use rustc_hash::FxHashMap;

use super::arena::Arena;
use super::expr::{Expr, Node, Symbol};
use crate::Rational;

impl Arena {
    /// The partial derivative by one symbol, all others held.
    pub fn derivative(&self, expr: Expr, symbol: Symbol) -> Expr {
        if let Node::Sum(sum) = self.node(expr)
            && sum.terms.iter().all(|(term, _)| self.as_symbol(*term).is_some())
        {
            let own = sum.terms.iter().find(|(term, _)| self.as_symbol(*term) == Some(symbol));
            return own.map_or_else(|| self.zero(), |(_, factor)| self.number(factor.clone()));
        }
        self.directional(expr, &BTreeMap::from([(symbol, self.one())]))
    }

    /// The derivative along a direction: the sum of `d(expr)/d(symbol) * rate` over its entries.
    ///
    /// With the rates of a plant's states this is the Lie derivative along its vector field.
    pub fn directional(&self, expr: Expr, rates: &BTreeMap<Symbol, Expr>) -> Expr {
        let mut known: FxHashMap<Expr, Expr> = FxHashMap::default();
        let zero = self.zero();
        for e in self.postorder(&[expr]) {
            let derivative = match self.node(e) {
                Node::Number(_) | Node::Pi => zero,
                Node::Symbol(s) => rates.get(&s).copied().unwrap_or(zero),
                Node::Sum(sum) => {
                    self.combine(&Rational::ZERO, sum.terms.iter().map(|(term, c)| (known[term], c.clone())))
                }
                Node::Product(product) => {
                    let changing = product.factors.iter().enumerate().filter(|(_, f)| known[&f.0] != zero);
                    self.sum(changing.map(|(index, (base, exponent))| {
                        let mut factors = product.factors.clone();
                        factors[index].1 = exponent - &Rational::ONE;
                        factors.push((known[base], Rational::ONE));
                        self.multiply(&(&product.coefficient * exponent), factors)
                    }))
                }
                Node::Call(function, arguments) => {
                    if arguments.iter().all(|a| known[a] == zero) {
                        zero
                    } else {
                        let partials = (function.row().derivative)(self, &arguments);
                        self.sum(partials.into_iter().zip(arguments.iter()).map(|(p, a)| self.mul(p, known[a])))
                    }
                }
            };
            known.insert(e, derivative);
        }
        known[&expr]
    }

    /// Replaces symbols, all at once.
    pub fn substitute(&self, expr: Expr, values: &BTreeMap<Symbol, Expr>) -> Expr {
        self.substitute_all(&[expr], values)[0]
    }

    /// Replaces symbols in several expressions, all at once.
    pub fn substitute_all(&self, exprs: &[Expr], values: &BTreeMap<Symbol, Expr>) -> Vec<Expr> {
        let mut known: FxHashMap<Expr, Expr> = FxHashMap::default();
        for e in self.postorder(exprs) {
            let replaced = match self.node(e) {
                Node::Symbol(s) => values.get(&s).copied().unwrap_or(e),
                _ => self.rebuild(e, &known),
            };
            known.insert(e, replaced);
        }
        exprs.iter().map(|e| known[e]).collect()
    }

    /// Replaces sub-expressions, the outermost first.
    pub fn replace(&self, expr: Expr, values: &FxHashMap<Expr, Expr>) -> Expr {
        let mut known: FxHashMap<Expr, Expr> = FxHashMap::default();
        for e in self.postorder(&[expr]) {
            let replaced = values.get(&e).copied().unwrap_or_else(|| self.rebuild(e, &known));
            known.insert(e, replaced);
        }
        known[&expr]
    }

    /// The expression over new operands; `known` has an entry for each of its operands.
    pub fn rebuild(&self, expr: Expr, known: &FxHashMap<Expr, Expr>) -> Expr {
        match self.node(expr) {
            Node::Number(_) | Node::Pi | Node::Symbol(_) => expr,
            Node::Sum(sum) => self.combine(&sum.constant, sum.terms.iter().map(|(t, c)| (known[t], c.clone()))),
            Node::Product(product) => {
                self.multiply(&product.coefficient, product.factors.iter().map(|(b, k)| (known[b], k.clone())))
            }
            Node::Call(function, arguments) => {
                let arguments: Vec<Expr> = arguments.iter().map(|a| known[a]).collect();
                self.call(function, &arguments)
            }
        }
    }
}

//! Formulas in which some functions and sums are opaque.
//!
//! In: formulas, and the symbols of a problem. Out: the formulas over fresh symbols, one for each function, each root
//! and each factor that is a sum, if it is free of those symbols; and the way back. Or in: formulas and some of their
//! functions, which the fresh symbols replace. A solution over fresh symbols is an identity for any of their values, so
//! it is one of the formulas: it keeps `tanh(100*w)`, `sin(24*q)`, `1/(1 + sqrt(q))` and `(T - 300)^3`, which a normal
//! form would write with exponentials, with powers of a cosine, with the denominator `q - 1`, and as a polynomial whose
//! terms cancel near T = 300. Results that need a relation among opaque terms are not found.

use std::collections::{BTreeMap, BTreeSet};

use rustc_hash::{FxHashMap, FxHashSet};

use crate::tower::Field;
use crate::{Arena, Domain, Expr, Node, Rational, Symbol};

/// The fresh symbols, with the terms they replace.
pub struct OpaqueTerms<'a> {
    arena: &'a Arena,
    selection: Selection<'a>,
    /// The symbols of the opaque terms; of sums also their multiples, by the symbol with leading coefficient 1.
    symbols: FxHashMap<Expr, Expr>,
    values: BTreeMap<Symbol, Expr>,
}

/// The selection of opaque terms.
enum Selection<'a> {
    /// Functions, roots and factors that are free of these symbols.
    FreeOf(&'a BTreeSet<Symbol>),
    /// These functions.
    Calls(&'a BTreeSet<Expr>),
}

impl<'a> OpaqueTerms<'a> {
    /// For a problem in these symbols.
    pub fn new(arena: &'a Arena, about: &'a BTreeSet<Symbol>) -> Self {
        Self { arena, selection: Selection::FreeOf(about), symbols: FxHashMap::default(), values: BTreeMap::new() }
    }

    /// For a problem in which these functions are opaque.
    pub(crate) fn calls(arena: &'a Arena, calls: &'a BTreeSet<Expr>) -> Self {
        Self { arena, selection: Selection::Calls(calls), symbols: FxHashMap::default(), values: BTreeMap::new() }
    }

    /// Formulas over the fresh symbols.
    pub fn replace(&mut self, exprs: &[Expr]) -> Vec<Expr> {
        let arena = self.arena;
        let mut known: FxHashMap<Expr, Expr> = FxHashMap::default();
        let parts = arena.postorder(exprs);
        let whole = whole_sums(arena, &parts);
        for expr in parts {
            let opaque = match arena.node(expr) {
                Node::Call(..) if self.is_opaque(expr) => self.symbol_of(expr),
                Node::Product(product) => {
                    let factors: Vec<(Expr, Rational)> = product
                        .factors
                        .iter()
                        .map(|(base, exponent)| match Rational::new(1, exponent.denominator()) {
                            // A power of the root.
                            Some(share) if !exponent.is_integer() && self.is_opaque_factor(*base) => {
                                let root = self.symbol_of(arena.power(*base, &share));
                                (root, Rational::from(exponent.numerator()))
                            }
                            _ if whole.contains(base) && self.is_opaque_factor(*base) => {
                                (self.sum(*base), exponent.clone())
                            }
                            _ => (known[base], exponent.clone()),
                        })
                        .collect();
                    arena.multiply(&product.coefficient, factors)
                }
                _ => arena.rebuild(expr, &known),
            };
            known.insert(expr, opaque);
        }
        exprs.iter().map(|expr| known[expr]).collect()
    }

    /// True if there are no opaque terms.
    pub fn is_empty(&self) -> bool {
        self.values.is_empty()
    }

    /// A formula with the fresh symbols replaced by their terms.
    pub fn restore(&self, expr: Expr) -> Expr {
        if self.is_empty() { expr } else { upright(self.arena, self.arena.substitute(expr, &self.values)) }
    }

    /// True if a function is opaque.
    fn is_opaque(&self, expr: Expr) -> bool {
        match &self.selection {
            Selection::FreeOf(about) => {
                let symbols = self.arena.symbols_of(&[expr]);
                !symbols.is_empty() && symbols.is_disjoint(about)
            }
            Selection::Calls(calls) => calls.contains(&expr),
        }
    }

    /// True if roots of a base are opaque, and the base itself where it is a factor.
    fn is_opaque_factor(&self, base: Expr) -> bool {
        matches!(self.selection, Selection::FreeOf(_)) && self.is_opaque(base)
    }

    /// The symbol of a sum, or the multiple of that of a proportional sum: `q0 - q` after `q - q0`.
    fn sum(&mut self, expr: Expr) -> Expr {
        let arena = self.arena;
        let Node::Sum(sum) = arena.node(expr) else { return self.symbol_of(expr) };
        let lead = sum.terms[0].1.clone();
        let multiple = |factor: &Rational| arena.combine(&Rational::ZERO, [(expr, factor.clone())]);
        let Some(share) = lead.recip() else { return self.symbol_of(expr) };
        let unit = multiple(&share);
        if let Some(known) = self.symbols.get(&unit) {
            return arena.scale(*known, &lead);
        }
        let symbol = self.symbol_of(expr);
        self.symbols.insert(unit, arena.scale(symbol, &share));
        symbol
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

/// The sums among expressions and their operands, operands first, that hold no divisions but by powers, as
/// `1 + (q/K)^10`: others go over their common denominator, as `L - M^2/J`.
fn whole_sums(arena: &Arena, parts: &[Expr]) -> FxHashSet<Expr> {
    let mut whole = FxHashSet::default();
    for part in parts {
        let Node::Sum(sum) = arena.node(*part) else { continue };
        let is_whole = sum.terms.iter().all(|(term, _)| match arena.node(*term) {
            Node::Product(product) => {
                let size = product.factors[0].1.abs();
                let is_quotient = product.factors.len() > 1 && !size.is_one();
                is_quotient && product.factors.iter().all(|(_, exponent)| exponent.abs() == size)
                    || product.factors.iter().all(|(base, exponent)| {
                        !exponent.is_negative() && (!matches!(arena.node(*base), Node::Sum(_)) || whole.contains(base))
                    })
            }
            _ => true,
        });
        if is_whole {
            whole.insert(*part);
        }
    }
    whole
}

/// A product whose sums have no more minus than plus signs: `z/(1 + q - z)` rather than `-z/(z - q - 1)`.
fn upright(arena: &Arena, expr: Expr) -> Expr {
    let Node::Product(product) = arena.node(expr) else { return expr };
    let mut coefficient = product.coefficient.clone();
    let mut factors = product.factors.clone();
    let balance = |base: Expr| match arena.node(base) {
        Node::Sum(sum) => {
            let signs = sum.terms.iter().map(|(_, factor)| factor).chain([&sum.constant]);
            Some(signs.map(Rational::signum).map(i64::from).sum::<i64>())
        }
        _ => None,
    };
    let is_odd = |exponent: &Rational| exponent.is_integer() && exponent.numerator().trailing_zeros() == 0;
    let mut turned = false;
    for (base, exponent) in &mut factors {
        if is_odd(exponent) && balance(*base).is_some_and(|balance| balance < 0) {
            *base = arena.neg(*base);
            coefficient = -&coefficient;
            turned = true;
        }
    }
    // The remaining minus goes into a difference in the numerator; in denominators, entries of one matrix share their
    // divisors.
    if turned
        && coefficient.is_negative()
        && let Some((base, _)) = factors.iter_mut().find(|(base, power)| power.is_one() && balance(*base) == Some(0))
    {
        *base = arena.neg(*base);
        coefficient = -&coefficient;
    }
    if turned { arena.multiply(&coefficient, factors) } else { expr }
}

/// The normal form of an expression with opaque terms free of the symbols, if there is one.
pub fn as_written(arena: &Arena, domain: &Domain, expr: Expr, about: &BTreeSet<Symbol>) -> Option<Expr> {
    let mut opaque = OpaqueTerms::new(arena, about);
    let signals = opaque.replace(&[expr]);
    if opaque.is_empty() {
        return None;
    }
    let field = Field::over(arena, &domain.facts, &signals).ok()?;
    let fraction = field.fraction(signals[0]).ok()?;
    Some(opaque.restore(field.show(&fraction)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::domain::zero::is_zero;
    use crate::graph::function::Function;

    #[test]
    fn sums_of_signals_that_are_factors_are_replaced_and_come_back() {
        let arena = Arena::new();
        let [x, y, r] = ["x", "y", "r"].map(|name| arena.variable(name));
        let about = arena.symbols_of(&[x]);
        let offset = arena.sub(y, r);
        let power = |base, exponent: i64| arena.power(base, &Rational::from(exponent));
        let twice = arena.combine(&Rational::ZERO, [(offset, Rational::from(-2))]);
        let cases = [
            (arena.add(x, power(offset, 3)), "x + signal1^3"),
            (arena.mul(x, twice), "-2*x*signal1"),
            (arena.div(x, arena.add(arena.one(), power(arena.div(y, r), 4))), "x/signal2"),
            // The inner denominator of a nested fraction goes to the outer one.
            (arena.div(x, arena.sub(r, arena.div(power(y, 2), r))), "x/(r - y^2/r)"),
            (arena.div(x, power(offset, 8)), "x/signal1^8"),
            // A summand that is not a factor may cancel.
            (arena.add(x, offset), "x + y - r"),
            (arena.mul(y, arena.add(x, offset)), "y*(x + y - r)"),
            (arena.mul(x, arena.add(arena.one(), power(offset, 2))), "x*signal3"),
        ];
        let mut opaque = OpaqueTerms::new(&arena, &about);
        for (written, expected) in cases {
            let formula = opaque.replace(&[written])[0];
            assert_eq!(arena.print(formula), expected);
            let difference = arena.sub(opaque.restore(formula), written);
            assert!(is_zero(&arena, difference, &Domain::default()), "{expected}");
        }
    }

    #[test]
    fn products_have_few_minus_signs() {
        let arena = Arena::new();
        let [z, q, r] = ["z", "q", "r"].map(|name| arena.variable(name));
        let low = arena.sum([z, arena.neg(q), arena.number(-1)]);
        let difference = arena.sub(q, z);
        let cases = [
            (arena.neg(arena.div(z, low)), "z/(1 - z + q)"),
            (arena.div(difference, low), "(z - q)/(1 - z + q)"),
            (arena.mul(r, difference), "r*(q - z)"),
            (arena.neg(arena.mul(r, difference)), "-r*(q - z)"),
            (arena.neg(arena.div(r, difference)), "-r/(q - z)"),
            (arena.mul(r, arena.power(low, &Rational::from(2))), "r*(z - q - 1)^2"),
        ];
        for (written, expected) in cases {
            assert_eq!(arena.print(upright(&arena, written)), expected);
        }
    }

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
        let mut opaque = OpaqueTerms::new(&arena, &about);
        let formulas = opaque.replace(&written);
        let shown: Vec<String> = formulas.iter().map(|formula| arena.print(*formula)).collect();
        let expected =
            ["x*signal2", "x/signal4", "signal3^3", "sin(x + signal1)", "sqrt(x + y)", "sin(1)"].map(str::to_owned);
        assert_eq!(shown, expected);
        assert!(!opaque.is_empty());
        let back: Vec<Expr> = formulas.iter().map(|formula| opaque.restore(*formula)).collect();
        assert_eq!(back, written);
    }
    #[test]
    fn opaque_functions_leave_the_others_to_the_normal_form() {
        let arena = Arena::new();
        let x = arena.variable("x");
        let [sine, tanh] = [Function::Sin, Function::Tanh].map(|function| arena.call(function, &[x]));
        let root = arena.sqrt(arena.mul(x, x));
        let calls = BTreeSet::from([tanh]);
        let mut opaque = OpaqueTerms::calls(&arena, &calls);
        let whole = arena.sum([arena.mul(sine, tanh), root, arena.call(Function::Exp, &[tanh])]);
        let shown: Vec<Expr> = opaque.replace(&[whole]);
        assert_eq!(arena.print(shown[0]), "sqrt(x^2) + sin(x)*signal1 + exp(signal1)");
        assert_eq!(opaque.restore(shown[0]), whole);
    }
}

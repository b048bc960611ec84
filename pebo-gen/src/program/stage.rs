//! What depends on parameters alone, apart from what changes with every sample.
//!
//! In: the functions of a model. Out: constants, and the functions with each maximal sub-expression
//! of parameters replaced by its constant. A division by parameters becomes a multiplication by the
//! stored reciprocal: one more rounding, and no division at run time. Numbers and pi alone are not
//! worth a constant; an irrational number such as sqrt(2) is.

use std::collections::BTreeSet;

use rustc_hash::{FxHashMap, FxHashSet};

use super::factor::factor;
use super::lower::{Undeclared, lower};
use super::straight::Program;
use crate::cas::rational::Rational;
use crate::cas::{Arena, Expr, Node, Symbol};

/// A function to be computed: its arguments and its outputs.
#[derive(Clone, Debug)]
pub struct Task {
    /// The symbols that change from call to call.
    pub arguments: Vec<Symbol>,
    /// The values.
    pub outputs: Vec<Expr>,
}

/// Functions that share constants.
#[derive(Clone, Debug)]
pub struct Staged {
    /// The constants: each a formula in the parameters, the output of `setup` at the same position.
    pub constants: Vec<(Symbol, Expr)>,
    /// From the parameters to the constants.
    pub setup: Program,
    /// A program for each task; its inputs are the constants, then the task's arguments.
    pub programs: Vec<Program>,
}

/// Lowers functions together, with constants computed once.
///
/// # Errors
/// [`Undeclared`] if an output depends on a symbol that is neither a parameter nor an argument.
pub fn stage(arena: &Arena, parameters: &[Symbol], tasks: &[Task]) -> Result<Staged, Undeclared> {
    let parameter_set: BTreeSet<Symbol> = parameters.iter().copied().collect();
    let roots: Vec<Expr> = tasks.iter().flat_map(|task| task.outputs.iter().copied()).collect();
    // Factors that vary leave first: what they leave behind may be a sum of parameters.
    let factored = {
        let fixed = fixed(arena, &roots, &parameter_set);
        factor(arena, &roots, |base| !fixed.contains(&base))
    };
    let mut split = Split {
        arena,
        fixed: fixed(arena, &factored, &parameter_set),
        constants: Vec::new(),
        symbols: FxHashMap::default(),
    };
    let varying = split.split(&factored);
    let varying = factor(arena, &varying, |_| true);

    let used = arena.symbols_of(&varying);
    let mut constants = split.constants;
    constants.retain(|constant| used.contains(&constant.0));
    let formulas: Vec<Expr> = constants.iter().map(|constant| constant.1).collect();
    let setup = lower(arena, parameters, &formulas)?;
    let mut programs = Vec::with_capacity(tasks.len());
    let mut first = 0;
    for task in tasks {
        let outputs = &varying[first..first + task.outputs.len()];
        first += task.outputs.len();
        let stored = constants.iter().map(|constant| constant.0);
        let inputs: Vec<Symbol> = stored.chain(task.arguments.iter().copied()).collect();
        programs.push(lower(arena, &inputs, outputs)?);
    }
    Ok(Staged { constants, setup, programs })
}

/// Every sub-expression that depends on nothing but parameters.
fn fixed(arena: &Arena, roots: &[Expr], parameters: &BTreeSet<Symbol>) -> FxHashSet<Expr> {
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

struct Split<'a> {
    arena: &'a Arena,
    fixed: FxHashSet<Expr>,
    constants: Vec<(Symbol, Expr)>,
    symbols: FxHashMap<Expr, Expr>,
}

impl Split<'_> {
    fn split(&mut self, roots: &[Expr]) -> Vec<Expr> {
        let arena = self.arena;
        let mut known: FxHashMap<Expr, Expr> = FxHashMap::default();
        for expr in arena.postorder(roots) {
            if self.fixed.contains(&expr) {
                continue;
            }
            let varying = match arena.node(expr) {
                Node::Number(_) | Node::Pi | Node::Symbol(_) => expr,
                Node::Sum(sum) => {
                    let (fixed, rest): (Vec<_>, Vec<_>) =
                        sum.terms.iter().cloned().partition(|term| self.fixed.contains(&term.0));
                    let mut terms: Vec<(Expr, Rational)> = rest
                        .into_iter()
                        .map(|(term, c)| match arena.node(term) {
                            // The coefficient joins the parameters of its product.
                            Node::Product(product) if !c.abs().is_one() => {
                                (self.product(&c, &product.factors, &known), Rational::ONE)
                            }
                            _ => (known[&term], c),
                        })
                        .collect();
                    if fixed.is_empty() {
                        arena.combine(&sum.constant, terms)
                    } else {
                        let constant = arena.combine(&sum.constant, fixed);
                        terms.push((self.constant(constant), Rational::ONE));
                        arena.combine(&Rational::ZERO, terms)
                    }
                }
                Node::Product(product) => self.product(&product.coefficient, &product.factors, &known),
                Node::Call(function, arguments) => {
                    let arguments: Vec<Expr> =
                        arguments.iter().map(|a| known.get(a).copied().unwrap_or_else(|| self.constant(*a))).collect();
                    arena.call(function, &arguments)
                }
            };
            known.insert(expr, varying);
        }
        let root = |expr: &Expr| known.get(expr).copied();
        roots.iter().map(|expr| root(expr).unwrap_or_else(|| self.constant(*expr))).collect()
    }

    /// A product with its parameters collected in one constant.
    fn product(&mut self, coefficient: &Rational, factors: &[(Expr, Rational)], known: &FxHashMap<Expr, Expr>) -> Expr {
        let arena = self.arena;
        let (fixed, rest): (Vec<_>, Vec<_>) =
            factors.iter().cloned().partition(|factor| self.fixed.contains(&factor.0));
        let mut factors: Vec<_> = rest.into_iter().map(|(base, e)| (known[&base], e)).collect();
        if fixed.is_empty() {
            return arena.multiply(coefficient, factors);
        }
        let constant = arena.multiply(coefficient, fixed);
        factors.push((self.constant(constant), Rational::ONE));
        arena.multiply(&Rational::ONE, factors)
    }

    /// The constant that holds the value; a sign stays outside, so that both signs share one.
    fn constant(&mut self, value: Expr) -> Expr {
        let arena = self.arena;
        if matches!(arena.node(value), Node::Number(_) | Node::Pi) {
            return value;
        }
        if let Some(&known) = self.symbols.get(&value) {
            return known;
        }
        let minus = Rational::from(-1);
        let opposite = arena.combine(&Rational::ZERO, [(value, minus.clone())]);
        let known = self.symbols.get(&opposite).copied();
        if let Some(known) = known {
            return arena.scale(known, &minus);
        }
        if is_negative(arena, value) {
            let known = self.constant(opposite);
            return arena.scale(known, &minus);
        }
        let symbol = arena.generated(&format!("${}", self.constants.len()));
        self.constants.push((symbol, value));
        let constant = arena.of_symbol(symbol);
        self.symbols.insert(value, constant);
        constant
    }
}

/// Whether every summand bears a minus.
fn is_negative(arena: &Arena, expr: Expr) -> bool {
    match arena.node(expr) {
        Node::Product(product) => product.coefficient.is_negative(),
        Node::Sum(sum) => {
            let all = sum.terms.iter().all(|term| term.1.is_negative());
            all && (sum.constant.is_zero() || sum.constant.is_negative())
        }
        _ => false,
    }
}

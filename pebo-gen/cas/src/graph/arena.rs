//! The expression graph: every expression once.
//!
//! In: nodes. Out: handles. After a node is entered, an equal node yields the same handle.

use std::cell::{Cell, RefCell};
use std::collections::BTreeSet;
use std::hash::BuildHasher;

use hashbrown::HashTable;
use rustc_hash::{FxBuildHasher, FxHashMap, FxHashSet};

use super::expr::{Expr, Node, Symbol};
use super::function::Function;
use crate::number::interval::Interval;
use crate::number::notation::Notation;
use crate::{Budget, Rational};

/// Steps that an examination of a node takes, or of one met again as an operand of another.
const STEPS_OF_A_LOOK: u64 = 2;

/// The last walk through the graph that came to each node: a set of nodes that takes no time to empty.
#[derive(Default, Debug)]
struct Visits {
    last: Vec<u32>,
    walk: u32,
}

impl Visits {
    /// Begins a walk through so many nodes.
    fn begin(&mut self, nodes: usize) -> u32 {
        if self.walk == u32::MAX {
            *self = Self::default();
        }
        self.walk += 1;
        self.last.resize(nodes, 0);
        self.walk
    }
}

/// Owns the nodes of all expressions of one problem.
///
/// Constructors take `&self`, so that they nest as the formula does.
#[derive(Debug)]
pub struct Arena {
    budget: Budget,
    nodes: RefCell<Vec<Node>>,
    table: RefCell<HashTable<Expr>>,
    visits: RefCell<Visits>,
    names: RefCell<Vec<String>>,
    /// The authors' symbols by their names.
    symbols: RefCell<FxHashMap<String, Symbol>>,
    /// The generator's own by theirs: another space of names.
    generated: RefCell<FxHashMap<String, Symbol>>,
    /// Constants that are known by an enclosure.
    located: RefCell<FxHashMap<Symbol, Interval>>,
    /// Solutions of equations, by the equations and the values that they were searched from.
    solutions: RefCell<FxHashMap<Vec<Expr>, Option<Vec<Expr>>>>,
    /// Expressions in them that are zero, as the constants satisfy equations.
    satisfied: RefCell<FxHashSet<Expr>>,
    /// The number of logarithms of numbers.
    number_logarithms: Cell<usize>,
    notation: Notation,
    table_names: RefCell<FxHashMap<Vec<Rational>, String>>,
}

impl Arena {
    /// An arena without expressions, and without a limit on the work.
    pub fn new() -> Self {
        Self::within(Budget::unlimited())
    }

    /// An arena without expressions; all work on them draws from the budget.
    pub fn within(budget: Budget) -> Self {
        Self {
            budget,
            nodes: RefCell::default(),
            table: RefCell::default(),
            visits: RefCell::default(),
            names: RefCell::default(),
            symbols: RefCell::default(),
            generated: RefCell::default(),
            located: RefCell::default(),
            solutions: RefCell::default(),
            satisfied: RefCell::default(),
            number_logarithms: Cell::default(),
            notation: Notation::default(),
            table_names: RefCell::default(),
        }
    }

    /// The budget of all work on the expressions.
    pub fn budget(&self) -> &Budget {
        &self.budget
    }

    /// The author's notation of numbers.
    pub fn notation(&self) -> &Notation {
        &self.notation
    }

    /// The author's names of tables, by their numbers.
    pub(in crate::graph) fn table_names(&self) -> &RefCell<FxHashMap<Vec<Rational>, String>> {
        &self.table_names
    }

    /// The node of an expression.
    pub fn node(&self, expr: Expr) -> Node {
        self.nodes.borrow()[expr.0 as usize].clone()
    }

    /// Enters a node that is already in canonical form.
    pub(crate) fn intern(&self, node: Node) -> Expr {
        let hash = hash_of(&node);
        let mut nodes = self.nodes.borrow_mut();
        let mut table = self.table.borrow_mut();
        if let Some(&found) = table.find(hash, |e| nodes[e.0 as usize] == node) {
            return found;
        }
        let expr = Expr(u32::try_from(nodes.len()).expect("fewer than 2^32 expressions"));
        if let Node::Call(Function::Log, argument) = &node
            && matches!(nodes[argument[0].0 as usize], Node::Number(_))
        {
            self.number_logarithms.set(self.number_logarithms.get() + 1);
        }
        nodes.push(node);
        table.insert_unique(hash, expr, |e| hash_of(&nodes[e.0 as usize]));
        expr
    }

    /// The number of logarithms of numbers among the nodes.
    pub(crate) fn number_logarithms(&self) -> usize {
        self.number_logarithms.get()
    }

    /// The symbol that an author calls by this name.
    pub fn symbol(&self, name: &str) -> Symbol {
        self.entered(&self.symbols, name)
    }

    /// The generator's own symbol of this name: never one that an author calls so, though both are printed alike.
    pub fn generated(&self, name: &str) -> Symbol {
        self.entered(&self.generated, name)
    }

    fn entered(&self, space: &RefCell<FxHashMap<String, Symbol>>, name: &str) -> Symbol {
        if let Some(&symbol) = space.borrow().get(name) {
            return symbol;
        }
        let mut names = self.names.borrow_mut();
        let symbol = Symbol(u32::try_from(names.len()).expect("fewer than 2^32 symbols"));
        names.push(name.to_owned());
        space.borrow_mut().insert(name.to_owned(), symbol);
        symbol
    }

    /// The printed name of a symbol.
    pub fn name(&self, symbol: Symbol) -> String {
        self.names.borrow()[symbol.index()].clone()
    }

    /// The symbol that an author calls by this name, as an expression.
    pub fn variable(&self, name: &str) -> Expr {
        let symbol = self.symbol(name);
        self.intern(Node::Symbol(symbol))
    }

    /// A symbol as an expression.
    pub fn of_symbol(&self, symbol: Symbol) -> Expr {
        self.intern(Node::Symbol(symbol))
    }

    /// A new constant within an enclosure, of which nothing else is known: a coordinate of a solution of equations.
    pub(crate) fn located(&self, value: Interval) -> Expr {
        let mut names = self.names.borrow_mut();
        let symbol = Symbol(u32::try_from(names.len()).expect("fewer than 2^32 symbols"));
        names.push(format!("{}", f64::midpoint(value.lo(), value.hi())));
        self.located.borrow_mut().insert(symbol, value);
        self.intern(Node::Symbol(symbol))
    }

    /// The solution of a problem, found once: the same is asked for with each set of points.
    pub(crate) fn solution(&self, problem: Vec<Expr>, solve: impl FnOnce() -> Option<Vec<Expr>>) -> Option<Vec<Expr>> {
        if let Some(known) = self.solutions.borrow().get(&problem) {
            return known.clone();
        }
        let found = solve();
        // Work that the budget ended is no answer.
        if found.is_some() || !self.budget.is_exhausted() {
            self.solutions.borrow_mut().insert(problem, found.clone());
        }
        found
    }

    /// Notes that an expression in located constants is zero.
    pub(crate) fn satisfies(&self, expr: Expr) {
        self.satisfied.borrow_mut().insert(expr);
    }

    /// True if an expression in located constants was noted to be zero.
    pub(crate) fn is_satisfied(&self, expr: Expr) -> bool {
        self.satisfied.borrow().contains(&expr)
    }

    /// The enclosure of a located constant.
    pub(super) fn location(&self, symbol: Symbol) -> Option<Interval> {
        self.located.borrow().get(&symbol).cloned()
    }

    /// The number as an expression.
    pub fn number(&self, value: impl Into<Rational>) -> Expr {
        self.intern(Node::Number(value.into()))
    }

    /// Zero.
    pub fn zero(&self) -> Expr {
        self.number(0)
    }

    /// One.
    pub fn one(&self) -> Expr {
        self.number(1)
    }

    /// The circle constant.
    pub fn pi(&self) -> Expr {
        self.intern(Node::Pi)
    }

    /// A whole turn, `2*pi`.
    pub fn turn(&self) -> Expr {
        self.scale(self.pi(), &Rational::from(2))
    }

    /// The value, if the expression is a number.
    pub fn as_number(&self, expr: Expr) -> Option<Rational> {
        match &self.nodes.borrow()[expr.0 as usize] {
            Node::Number(value) => Some(value.clone()),
            _ => None,
        }
    }

    /// The symbol, if the expression is one that has no value.
    pub fn as_symbol(&self, expr: Expr) -> Option<Symbol> {
        match self.nodes.borrow()[expr.0 as usize] {
            Node::Symbol(symbol) if !self.located.borrow().contains_key(&symbol) => Some(symbol),
            _ => None,
        }
    }

    /// True if the expression is the number zero.
    pub fn is_zero(&self, expr: Expr) -> bool {
        matches!(&self.nodes.borrow()[expr.0 as usize], Node::Number(value) if value.is_zero())
    }

    /// The operands of an expression, in order.
    pub fn operands(&self, expr: Expr) -> Vec<Expr> {
        let mut operands = Vec::new();
        push_operands(&self.nodes.borrow()[expr.0 as usize], &mut operands);
        operands
    }

    /// The number of operands of an expression.
    pub(crate) fn operand_count(&self, expr: Expr) -> u64 {
        let count = match &self.nodes.borrow()[expr.0 as usize] {
            Node::Number(_) | Node::Pi | Node::Symbol(_) => 0,
            Node::Sum(sum) => sum.terms.len(),
            Node::Product(product) => product.factors.len(),
            Node::Call(_, arguments) => arguments.len(),
        };
        count as u64
    }

    /// Every subexpression of the roots, operands before their users.
    pub fn postorder(&self, roots: &[Expr]) -> Vec<Expr> {
        let nodes = self.nodes.borrow();
        let mut visits = self.visits.borrow_mut();
        let visit = visits.begin(nodes.len());
        let mut found = Vec::new();
        let mut open: Vec<Expr> = roots.to_vec();
        let mut looks: u64 = 0;
        while let Some(expr) = open.pop() {
            looks += 1;
            let last = &mut visits.last[expr.0 as usize];
            if *last != visit {
                *last = visit;
                found.push(expr);
                push_operands(&nodes[expr.0 as usize], &mut open);
            }
        }
        // Each is also put in order.
        self.budget.take(STEPS_OF_A_LOOK.saturating_mul(looks.saturating_add(found.len() as u64)));
        // Operands are entered before their users, so ascending handles are a topological order.
        found.sort_unstable();
        found
    }

    /// The symbols that the roots depend on.
    pub fn symbols_of(&self, roots: &[Expr]) -> BTreeSet<Symbol> {
        self.postorder(roots).into_iter().filter_map(|e| self.as_symbol(e)).collect()
    }

    /// True if the expression contains one of the symbols.
    pub fn depends_on(&self, expr: Expr, symbols: &BTreeSet<Symbol>) -> bool {
        !self.symbols_of(&[expr]).is_disjoint(symbols)
    }
}

impl Default for Arena {
    fn default() -> Self {
        Self::new()
    }
}

fn push_operands(node: &Node, to: &mut Vec<Expr>) {
    match node {
        Node::Number(_) | Node::Pi | Node::Symbol(_) => {}
        Node::Sum(sum) => to.extend(sum.terms.iter().map(|term| term.0)),
        Node::Product(product) => to.extend(product.factors.iter().map(|factor| factor.0)),
        Node::Call(_, arguments) => to.extend(arguments.iter()),
    }
}

fn hash_of(node: &Node) -> u64 {
    FxBuildHasher.hash_one(node)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_generated_symbol_is_no_author_s() {
        let arena = Arena::new();
        let (own, generated) = (arena.symbol("eta1"), arena.generated("eta1"));
        assert_ne!(own, generated);
        assert_eq!((arena.name(own), arena.name(generated)), ("eta1".to_owned(), "eta1".to_owned()));
        assert_eq!((arena.symbol("eta1"), arena.generated("eta1")), (own, generated));
        let difference = arena.sub(arena.of_symbol(own), arena.of_symbol(generated));
        assert!(!arena.is_zero(difference));
    }
}

//! Separates values that change seldom from those that change with every call.
//!
//! In: the functions of a model. Out: constants, which depend on parameters alone; terms, which depend on
//! parameters and the sampled outputs and are worth being kept for all functions and for both ends of an
//! interval; and the functions with each maximal sub-expression of these kinds replaced by its name. A
//! division by parameters becomes a multiplication by the stored reciprocal: one more rounding, and no
//! division at run time. Numbers and pi alone are not worth a constant; an irrational number such as
//! sqrt(2) is.

use std::collections::{BTreeMap, BTreeSet};

use rustc_hash::{FxHashMap, FxHashSet};

use super::angles::halved;
use super::factor::factor;
use super::fixed::fixed;
use super::guards::{GuardedProgram, guarded};
use super::lower::{UndeclaredSymbol, lower, lower_with};
use super::oriented::oriented;
use super::product::combined_exponent;
use super::reuse::with_values;
use super::spread::spread;
use super::straight::{Operand, Operation, Program};
use pebo_cas::{Arena, Expr, Node, Rational, Relation, Symbol};

/// A function to be computed: its arguments and its outputs.
#[derive(Clone, Debug)]
pub struct Task {
    /// The symbols that change from call to call, besides the sampled ones.
    pub arguments: Vec<Symbol>,
    /// Values that the outputs name by symbols: each is computed once, as it is written.
    pub parts: Vec<(Symbol, Expr)>,
    /// The values.
    pub outputs: Vec<Expr>,
    /// True if it runs with every sample. Values that only others need are computed where they need them.
    pub is_regular: bool,
}

/// Functions that share constants and terms.
#[derive(Clone, Debug)]
pub struct StagedPrograms {
    /// The constants: each a formula in the parameters, the output of `setup` at the same position.
    pub constants: Vec<(Symbol, Expr)>,
    /// From the parameters to the constants.
    pub setup: Program,
    /// The terms: each a formula in the constants and the sampled symbols, the output of `sample` at the same position.
    pub terms: Vec<(Symbol, Expr)>,
    /// From the constants and the sampled symbols to the terms.
    pub sample: Program,
    /// A program for each task; its inputs are the constants, the sampled symbols, the terms, then the task's
    /// arguments.
    pub programs: Vec<Program>,
}

/// Lowers several functions, with constants computed once and terms once a sample.
///
/// # Errors
/// [`UndeclaredSymbol`] if an output depends on a symbol that is neither a parameter, sampled, nor an argument.
pub fn stage(
    arena: &Arena,
    parameters: &[Symbol],
    sampled: &[Symbol],
    tasks: &[Task],
) -> Result<StagedPrograms, UndeclaredSymbol> {
    let values = |task: &Task| task.parts.iter().map(|part| part.1).chain(task.outputs.clone()).collect::<Vec<_>>();
    let roots: Vec<Expr> = tasks.iter().flat_map(values).collect();
    let roots = spread(arena, &prepared(arena, &halved(arena, &roots), parameters, parameters), parameters);
    let (mut varying, mut constants) = split(arena, &roots, (parameters, parameters), ("$", 0), |_| true);
    let stored: Vec<Symbol> = constants.iter().map(|constant| constant.0).collect();
    let regular: Vec<bool> = tasks.iter().flat_map(|task| values(task).into_iter().map(|_| task.is_regular)).collect();
    let steady: Vec<Expr> = varying.iter().zip(&regular).filter_map(|(value, &is)| is.then_some(*value)).collect();
    let (steady, mut terms) =
        split(arena, &steady, (&[&stored, sampled].concat(), &stored), ("%", 0), |expr| is_dear(arena, expr));
    let mut steady = steady.into_iter();
    for (value, _) in varying.iter_mut().zip(&regular).filter(|(_, regular)| **regular) {
        *value = steady.next().unwrap_or(*value);
    }
    let inputs = [stored.as_slice(), sampled].concat();
    let seldom: Vec<Expr> = varying.iter().zip(&regular).filter_map(|(value, &is)| (!is).then_some(*value)).collect();
    let mut seldom = with_values(arena, &prepared(arena, &seldom, &inputs, &stored), &terms).into_iter();
    for (value, _) in varying.iter_mut().zip(&regular).filter(|(_, regular)| !**regular) {
        *value = seldom.next().unwrap_or(*value);
    }
    let level = same(arena, &inputs, &terms)?;
    terms.retain(|term| !level.contains_key(&term.0));
    let varying = factor(arena, &arena.substitute_all(&varying, &level), |_| true, is_constant(arena, &constants));
    let varying = merged(arena, varying, &mut terms, &mut constants);

    // Two shapes of a formula in the parameters may be one value.
    let equal = same(arena, parameters, &constants)?;
    constants.retain(|constant| !equal.contains_key(&constant.0));
    let varying = arena.substitute_all(&varying, &equal);
    for term in &mut terms {
        term.1 = arena.substitute(term.1, &equal);
    }

    let used = arena.symbols_of(&varying);
    terms.retain(|term| used.contains(&term.0));
    let formulas: Vec<Expr> = terms.iter().map(|term| term.1).collect();
    let used: BTreeSet<Symbol> = arena.symbols_of(&formulas).into_iter().chain(used).collect();
    constants.retain(|constant| used.contains(&constant.0));
    let split = Stages { constants, terms, varying };
    split.with_fewest_signs(arena, parameters, sampled, tasks)
}

/// More signs are chosen at once, not one by one.
const MOST_SIGNS: usize = 12;

/// The expressions of each stage.
#[derive(Clone)]
struct Stages {
    constants: Vec<(Symbol, Expr)>,
    terms: Vec<(Symbol, Expr)>,
    /// The parts of each task, then its outputs.
    varying: Vec<Expr>,
}

impl Stages {
    fn lowered(
        &self,
        arena: &Arena,
        parameters: &[Symbol],
        sampled: &[Symbol],
        tasks: &[Task],
    ) -> Result<StagedPrograms, UndeclaredSymbol> {
        let formulas = |named: &[(Symbol, Expr)]| named.iter().map(|part| part.1).collect::<Vec<Expr>>();
        let setup = lower(arena, parameters, &formulas(&self.constants))?;
        let mut inputs: Vec<Symbol> = self.constants.iter().map(|constant| constant.0).collect();
        inputs.extend(sampled);
        let sample = lower(arena, &inputs, &formulas(&self.terms))?;
        inputs.extend(self.terms.iter().map(|term| term.0));

        let mut programs = Vec::with_capacity(tasks.len());
        let mut first = 0;
        for task in tasks {
            let (parts, rest) = self.varying[first..].split_at(task.parts.len());
            let outputs = &rest[..task.outputs.len()];
            first += task.parts.len() + task.outputs.len();
            let parts: Vec<(Symbol, Expr)> = task.parts.iter().map(|part| part.0).zip(parts.iter().copied()).collect();
            programs.push(lower_with(arena, &[inputs.as_slice(), &task.arguments].concat(), &parts, outputs)?);
        }
        Ok(StagedPrograms { constants: self.constants.clone(), setup, terms: self.terms.clone(), sample, programs })
    }

    /// The programs, with the opposites of constants and terms kept where that leaves fewer negations.
    fn with_fewest_signs(
        self,
        arena: &Arena,
        parameters: &[Symbol],
        sampled: &[Symbol],
        tasks: &[Task],
    ) -> Result<StagedPrograms, UndeclaredSymbol> {
        let negations = |staged: &StagedPrograms| {
            let of = |program: &Program| program.operations.iter().filter(|o| matches!(o, Operation::Neg(_))).count();
            // A function that runs at both ends of an interval counts twice.
            let often = |task: &Task| if task.is_regular { 2 } else { 1 };
            of(&staged.sample) + tasks.iter().zip(&staged.programs).map(|(task, p)| often(task) * of(p)).sum::<usize>()
        };
        let mut best = self.lowered(arena, parameters, sampled, tasks)?;
        let mut least = negations(&best);
        let negated = best.negated();
        let choices: Vec<BTreeSet<Symbol>> = match negated.len() {
            0..=MOST_SIGNS => negated.iter().map(|symbol| BTreeSet::from([*symbol])).collect(),
            _ => vec![negated],
        };
        let mut stages = self;
        for chosen in choices {
            let other = stages.clone().with_opposites(arena, &chosen);
            let staged = other.lowered(arena, parameters, sampled, tasks)?;
            if negations(&staged) < least {
                least = negations(&staged);
                (stages, best) = (other, staged);
            }
        }
        Ok(best)
    }

    /// The same, with the opposites of these kept.
    fn with_opposites(mut self, arena: &Arena, negated: &BTreeSet<Symbol>) -> Self {
        let opposites = negated.iter().map(|&symbol| (symbol, arena.neg(arena.of_symbol(symbol)))).collect();
        for term in &mut self.terms {
            term.1 = arena.substitute(term.1, &opposites);
        }
        self.varying = arena.substitute_all(&self.varying, &opposites);
        for (_, value) in
            self.constants.iter_mut().chain(&mut self.terms).filter(|(symbol, _)| negated.contains(symbol))
        {
            *value = arena.neg(*value);
        }
        self
    }
}

impl StagedPrograms {
    /// A program that compares parameters with zero, with the conditions of the constants and the functions on them.
    pub fn guarded(&self, arena: &Arena, checked: &Program, wanted: &[Option<Relation>]) -> GuardedProgram {
        let users: Vec<&Program> = self.programs.iter().chain([&self.sample]).collect();
        guarded(arena, &self.setup, &users, (checked, wanted))
    }

    /// The constants and terms whose opposite is used, or that of a product with them.
    fn negated(&self) -> BTreeSet<Symbol> {
        let named: BTreeSet<Symbol> = self.constants.iter().chain(&self.terms).map(|part| part.0).collect();
        let mut negated = BTreeSet::new();
        for program in self.programs.iter().chain([&self.sample]) {
            let mut open: Vec<Operand> = Vec::new();
            let opposites = program.operations.iter().filter(|operation| matches!(operation, Operation::Neg(_)));
            open.extend(opposites.flat_map(|operation| operation.operands()));
            let mut guarded_values: FxHashSet<Operand> = FxHashSet::default();
            while let Some(operand) = open.pop() {
                match operand {
                    _ if !guarded_values.insert(operand) => {}
                    Operand::Input(input) => negated.extend(program.inputs.get(input)),
                    Operand::Result(result) => {
                        let operation = program.operations[result];
                        if matches!(operation, Operation::Mul(..) | Operation::Add(..)) {
                            open.extend(operation.operands());
                        }
                    }
                    Operand::Constant(_) => {}
                }
            }
        }
        negated.retain(|symbol| named.contains(symbol));
        negated
    }
}

/// The functions and terms with constants that meet as one: a factor that left a sum is beside others.
fn merged(
    arena: &Arena,
    varying: Vec<Expr>,
    terms: &mut [(Symbol, Expr)],
    constants: &mut Vec<(Symbol, Expr)>,
) -> Vec<Expr> {
    /// A factor that leaves a sum may leave the next one too.
    const ROUNDS: usize = 4;
    let formulas = terms.iter().map(|term| term.1);
    let mut all =
        factor(arena, &formulas.chain(varying).collect::<Vec<Expr>>(), |_| true, is_constant(arena, constants));
    for _ in 0..ROUNDS {
        let stored: Vec<Symbol> = constants.iter().map(|constant| constant.0).collect();
        let (split, found) =
            split(arena, &all, (&stored, &stored), ("$", stored.len()), |expr| arena.as_symbol(expr).is_none());
        if found.is_empty() {
            break;
        }
        let values: BTreeMap<Symbol, Expr> = constants.iter().copied().collect();
        constants.extend(found.into_iter().map(|(symbol, value)| (symbol, arena.substitute(value, &values))));
        all = factor(arena, &split, |_| true, is_constant(arena, constants));
    }
    let varying = all.split_off(terms.len());
    for (term, formula) in terms.iter_mut().zip(all) {
        term.1 = formula;
    }
    varying
}

/// Tests whether an expression is one of the constants.
fn is_constant(arena: &Arena, constants: &[(Symbol, Expr)]) -> impl Fn(Expr, usize) -> bool {
    let stored: FxHashSet<Expr> = constants.iter().map(|constant| arena.of_symbol(constant.0)).collect();
    move |expr, _| stored.contains(&expr)
}

/// Terms that are computed as an earlier one, or as its opposite, and their values then: two shapes of a formula may
/// come to the same operations.
fn same(
    arena: &Arena,
    inputs: &[Symbol],
    terms: &[(Symbol, Expr)],
) -> Result<BTreeMap<Symbol, Expr>, UndeclaredSymbol> {
    let formulas: Vec<Expr> = terms.iter().map(|term| term.1).collect();
    let program = lower(arena, inputs, &formulas)?;
    let opposite = |operand: Operand| {
        let Operand::Result(index) = operand else { return None };
        let found = |operation| program.operations.iter().position(|other| *other == operation).map(Operand::Result);
        match program.operations[index] {
            Operation::Neg(value) => Some(value),
            Operation::Sub(a, b) => found(Operation::Sub(b, a)),
            _ => None,
        }
    };
    let mut known: BTreeMap<Operand, Symbol> = BTreeMap::new();
    let mut same = BTreeMap::new();
    for (&(term, _), &operand) in terms.iter().zip(&program.outputs) {
        if let Some(&first) = known.get(&operand) {
            same.insert(term, arena.of_symbol(first));
        } else if let Some(&first) = opposite(operand).and_then(|operand| known.get(&operand)) {
            same.insert(term, arena.neg(arena.of_symbol(first)));
        } else {
            known.insert(operand, term);
        }
    }
    Ok(same)
}

/// The expressions with each maximal sub-expression of the given symbols that is worth it replaced by a symbol, and
/// these symbols with their formulas. Of `constants` among the symbols each formula is computed once for all.
fn split(
    arena: &Arena,
    roots: &[Expr],
    (symbols, constants): (&[Symbol], &[Symbol]),
    (prefix, first): (&'static str, usize),
    worth: impl Fn(Expr) -> bool,
) -> (Vec<Expr>, Vec<(Symbol, Expr)>) {
    let factored = prepared(arena, roots, symbols, constants);
    let fixed = fixed(arena, &factored, symbols);
    let mut split = Split { arena, fixed, prefix, first, worth, found: Vec::new(), symbols: FxHashMap::default() };
    (split.split(&factored), split.found)
}

/// The expressions without varying factors in the sums: the rest may be a sum of the given symbols. A number beside a
/// value of `constants` alone is part of another constant. Beside other formulas of the symbols it is part of these
/// where they have no other use.
fn prepared(arena: &Arena, roots: &[Expr], symbols: &[Symbol], constants: &[Symbol]) -> Vec<Expr> {
    let known = fixed(arena, roots, symbols);
    let stored = fixed(arena, roots, constants);
    let is_own = |base: Expr, uses: usize| uses < 2 && arena.as_symbol(base).is_none() && known.contains(&base);
    factor(arena, roots, |base| !known.contains(&base), |base, uses| stored.contains(&base) || is_own(base, uses))
}

/// Tests whether computing the value takes more than a few operations.
fn is_dear(arena: &Arena, expr: Expr) -> bool {
    /// A multiplication or two cost as much as a number that is kept.
    const FEW: usize = 3;
    let mut operations = 0;
    for part in arena.postorder(&[expr]) {
        operations += match arena.node(part) {
            Node::Number(_) | Node::Pi | Node::Symbol(_) => 0,
            Node::Sum(sum) => sum.terms.len(),
            Node::Product(product) if product.factors.iter().any(|(_, exponent)| !is_natural(exponent)) => FEW,
            Node::Product(product) => product.factors.len(),
            Node::Call(..) => FEW,
        };
    }
    operations >= FEW
}

fn is_natural(exponent: &Rational) -> bool {
    exponent.is_integer() && !exponent.is_negative()
}

struct Split<'a, W> {
    arena: &'a Arena,
    fixed: FxHashSet<Expr>,
    prefix: &'static str,
    /// The number of the first symbol.
    first: usize,
    worth: W,
    found: Vec<(Symbol, Expr)>,
    symbols: FxHashMap<Expr, Expr>,
}

impl<W: Fn(Expr) -> bool> Split<'_, W> {
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
        // In a power of a quotient the parameters are a power of one constant: `K^10` alone may overflow.
        let is_raised = |(_, exponent): &(Expr, Rational)| {
            let combined = combined_exponent(exponent);
            combined.is_some() && rest.iter().any(|(_, moving)| combined_exponent(moving) == combined)
        };
        let (raised, fixed): (Vec<_>, Vec<_>) = fixed.into_iter().partition(is_raised);
        let mut factors: Vec<_> = rest.into_iter().map(|(base, e)| (known[&base], e)).collect();
        let mut bases: BTreeMap<Rational, Vec<(Expr, Rational)>> = BTreeMap::new();
        for (base, exponent) in raised {
            let one = Rational::from(exponent.signum());
            bases.entry(exponent.abs()).or_default().push((base, one));
        }
        for (exponent, bases) in bases {
            let base = arena.multiply(&Rational::ONE, bases);
            factors.push((self.constant(base), exponent));
        }
        if fixed.is_empty() {
            return arena.multiply(coefficient, factors);
        }
        let constant = arena.multiply(coefficient, fixed);
        factors.push((self.constant(constant), Rational::ONE));
        arena.multiply(&Rational::ONE, factors)
    }

    /// The constant that holds the value; a sign is left outside, so that both signs share one.
    fn constant(&mut self, value: Expr) -> Expr {
        let arena = self.arena;
        if matches!(arena.node(value), Node::Number(_) | Node::Pi) || !(self.worth)(value) {
            return value;
        }
        let (is_opposite, oriented) = oriented(arena, value);
        if is_opposite {
            return arena.scale(self.constant(oriented), &Rational::from(-1));
        }
        let value = oriented;
        if let Some(&known) = self.symbols.get(&value) {
            return known;
        }
        let minus = Rational::from(-1);
        let opposite = arena.combine(&Rational::ZERO, [(value, minus.clone())]);
        let known = self.symbols.get(&opposite).copied();
        if let Some(known) = known {
            return arena.scale(known, &minus);
        }
        let symbol = arena.generated(&format!("{}{}", self.prefix, self.first + self.found.len()));
        self.found.push((symbol, value));
        let constant = arena.of_symbol(symbol);
        self.symbols.insert(value, constant);
        constant
    }
}

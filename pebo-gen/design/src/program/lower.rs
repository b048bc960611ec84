//! Lowers expressions to operations.
//!
//! Every value is computed once, sines and cosines of sums from those of the summands (`angles`). Signs travel
//! with the values and end in subtractions; `signs` removes what it can of the remaining negations. Products
//! are in `product`.
//!
//! One thing with `product`, `angles` and `sharing`: a product is lowered factor by factor, an angle by its summands,
//! and sharing counts the products of that lowering.

use std::fmt;

use rustc_hash::FxHashMap;

use super::angles::Angles;
use super::factor::factor;
use super::sharing::Sharing;
use super::straight::{Constant, Operand, Operation, Program};
use pebo_cas::graph::function::pieces::Pieces;
use pebo_cas::{Arena, Expr, Function, Node, Product, Rational, Sum, Symbol};

/// An output depends on a symbol that is not an input.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct UndeclaredSymbol(pub Symbol);

impl fmt::Display for UndeclaredSymbol {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "an output depends on symbol {}, which is not an input", self.0.index())
    }
}

impl std::error::Error for UndeclaredSymbol {}

/// Lowers expressions to a program from the inputs' values to theirs.
///
/// # Errors
/// [`UndeclaredSymbol`] if an output depends on a symbol that is not an input.
pub fn lower(arena: &Arena, inputs: &[Symbol], outputs: &[Expr]) -> Result<Program, UndeclaredSymbol> {
    lower_with(arena, inputs, &[], outputs)
}

/// The same for outputs that name some values by symbols; these depend on the inputs alone.
pub(super) fn lower_with(
    arena: &Arena,
    inputs: &[Symbol],
    parts: &[(Symbol, Expr)],
    outputs: &[Expr],
) -> Result<Program, UndeclaredSymbol> {
    let declared: FxHashMap<Symbol, usize> =
        inputs.iter().enumerate().map(|(position, &symbol)| (symbol, position)).collect();
    let values: Vec<Expr> = parts.iter().map(|part| part.1).collect();
    let undeclared = |exprs: &[Expr], named: &[(Symbol, Expr)]| {
        let known = |symbol: &Symbol| declared.contains_key(symbol) || named.iter().any(|part| part.0 == *symbol);
        arena.symbols_of(exprs).into_iter().find(|symbol| !known(symbol))
    };
    if let Some(symbol) = undeclared(&values, &[]).or_else(|| undeclared(outputs, parts)) {
        return Err(UndeclaredSymbol(symbol));
    }
    let all = factor(arena, &[&values, outputs].concat(), |_| true, |_, _| false);
    let (values, outputs) = all.split_at(parts.len());
    let mut lowering = Lowering {
        arena,
        inputs: declared,
        sharing: Sharing::of(arena, &all),
        angles: Angles::of(arena, &all),
        known: FxHashMap::default(),
        constants: Numbering::default(),
        tables: Numbering::default(),
        operations: Numbering::default(),
    };
    for (&(name, _), &value) in parts.iter().zip(values) {
        lowering.lowered(value);
        let value = lowering.known[&value];
        lowering.known.insert(arena.of_symbol(name), value);
    }
    for expr in arena.postorder(outputs) {
        if !lowering.known.contains_key(&expr) {
            let value = lowering.value(expr);
            lowering.known.insert(expr, value);
        }
    }
    let outputs = outputs.iter().map(|&expr| lowering.plain(lowering.known[&expr])).collect();
    let program = Program {
        inputs: inputs.to_vec(),
        constants: lowering.constants.entries,
        tables: lowering.tables.entries,
        operations: lowering.operations.entries,
        outputs,
    };
    Ok(program.pruned().with_signs_absorbed().pruned())
}

/// A value up to its sign.
#[derive(Clone, Copy, Debug)]
pub(super) struct Signed {
    pub(super) negative: bool,
    pub(super) operand: Operand,
}

/// Entries in order of first use, each once.
#[derive(Debug)]
struct Numbering<T> {
    entries: Vec<T>,
    positions: FxHashMap<T, usize>,
}

impl<T> Default for Numbering<T> {
    fn default() -> Self {
        Self { entries: Vec::new(), positions: FxHashMap::default() }
    }
}

impl<T: Clone + Eq + std::hash::Hash> Numbering<T> {
    fn position(&mut self, entry: T) -> usize {
        *self.positions.entry(entry).or_insert_with_key(|entry| {
            self.entries.push(entry.clone());
            self.entries.len() - 1
        })
    }
}

pub(super) struct Lowering<'a> {
    pub(super) arena: &'a Arena,
    inputs: FxHashMap<Symbol, usize>,
    pub(super) sharing: Sharing,
    pub(super) angles: Angles,
    pub(super) known: FxHashMap<Expr, Signed>,
    constants: Numbering<Constant>,
    tables: Numbering<Pieces>,
    operations: Numbering<Operation>,
}

impl Lowering<'_> {
    /// The value of an expression whose operands are known.
    pub(super) fn value(&mut self, expr: Expr) -> Signed {
        match self.arena.node(expr) {
            Node::Number(value) => {
                let operand = self.number(&value.abs());
                Signed { negative: value.is_negative(), operand }
            }
            Node::Pi => positive(Operand::Constant(self.constants.position(Constant::Pi))),
            Node::Symbol(symbol) => positive(Operand::Input(self.inputs[&symbol])),
            Node::Sum(sum) => self.sum(expr, &sum),
            Node::Product(product) => self.product(&product),
            Node::Call(function @ (Function::Sin | Function::Cos), arguments) => {
                positive(self.trigonometric(function, arguments[0]))
            }
            Node::Call(function, arguments) => {
                if let Some((table, argument)) = Pieces::of(self.arena, expr) {
                    let argument = self.plain(self.known[&argument]);
                    let table = self.tables.position(table);
                    return positive(self.operation(Operation::Table(table, argument)));
                }
                if function == Function::Log
                    && let Some(beside) = beside_one(self.arena, arguments[0])
                {
                    let beside = self.lowered(beside);
                    return positive(self.operation(Operation::Ln1P(beside)));
                }
                let values: Vec<Operand> = arguments.iter().map(|argument| self.plain(self.known[argument])).collect();
                let operation = match values.as_slice() {
                    [only] => Operation::Unary(function, *only),
                    [first, second] => Operation::Binary(function, *first, *second),
                    _ => unreachable!("the table has functions of one and two arguments"),
                };
                positive(self.operation(operation))
            }
        }
    }

    fn sum(&mut self, expr: Expr, sum: &Sum) -> Signed {
        let opposite = self.arena.combine(&Rational::ZERO, [(expr, Rational::from(-1))]);
        if let Some(known) = self.known.get(&opposite) {
            return Signed { negative: !known.negative, ..*known };
        }
        if let Some((argument, negative)) = exp_m1(self.arena, sum) {
            let argument = self.plain(self.known[&argument]);
            return Signed { negative, operand: self.operation(Operation::ExpM1(argument)) };
        }
        let mut summands: Vec<Signed> = Vec::with_capacity(sum.terms.len() + 1);
        for (term, coefficient) in &sum.terms {
            let factors = vec![(*term, Rational::ONE)];
            summands.push(match self.arena.node(*term) {
                _ if coefficient.abs().is_one() => {
                    let known = self.known[term];
                    Signed { negative: known.negative != coefficient.is_negative(), ..known }
                }
                Node::Product(product) => {
                    self.product(&Product { coefficient: coefficient.clone(), factors: product.factors.clone() })
                }
                _ => self.product(&Product { coefficient: coefficient.clone(), factors }),
            });
        }
        if !sum.constant.is_zero() {
            let operand = self.number(&sum.constant.abs());
            let constant = Signed { negative: sum.constant.is_negative(), operand };
            // `1 - d`, but `x + 1`.
            let leads = !constant.negative && summands.iter().any(|summand| summand.negative);
            summands.insert(if leads { 0 } else { summands.len() }, constant);
        }
        let lead = summands.iter().position(|summand| !summand.negative);
        let negative = lead.is_none();
        let first = summands.remove(lead.unwrap_or(0));
        let mut total = first.operand;
        for summand in summands {
            total = self.operation(if summand.negative == negative {
                Operation::Add(total, summand.operand)
            } else {
                Operation::Sub(total, summand.operand)
            });
        }
        Signed { negative, operand: total }
    }

    /// The value with its sign.
    pub(super) fn plain(&mut self, value: Signed) -> Operand {
        if !value.negative {
            return value.operand;
        }
        if let Operand::Constant(index) = value.operand
            && let Constant::Number(number) = &self.constants.entries[index]
        {
            let opposite = -number;
            return self.number(&opposite);
        }
        self.operation(Operation::Neg(value.operand))
    }

    pub(super) fn number(&mut self, value: &Rational) -> Operand {
        Operand::Constant(self.constants.position(Constant::Number(value.clone())))
    }

    pub(super) fn operation(&mut self, operation: Operation) -> Operand {
        Operand::Result(self.operations.position(operation))
    }
}

/// The `a` of `exp(a) - 1`, or of its opposite: the difference has few digits where `a` is small.
fn exp_m1(arena: &Arena, sum: &Sum) -> Option<(Expr, bool)> {
    let [(term, coefficient)] = sum.terms.as_slice() else { return None };
    let Node::Call(Function::Exp, arguments) = arena.node(*term) else { return None };
    let is_it = coefficient.abs().is_one() && -coefficient == sum.constant;
    is_it.then(|| (arguments[0], coefficient.is_negative()))
}

/// The `a` of `1 + a`, whose logarithm has few digits where `a` is small.
fn beside_one(arena: &Arena, argument: Expr) -> Option<Expr> {
    let Node::Sum(sum) = arena.node(argument) else { return None };
    sum.constant.is_one().then(|| arena.sub(argument, arena.one()))
}

fn positive(operand: Operand) -> Signed {
    Signed { negative: false, operand }
}

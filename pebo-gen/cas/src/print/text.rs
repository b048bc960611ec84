//! Expressions as text in the model file's grammar: the text parses back to the same value.
//!
//! Numbers are written as [`notation`](crate::number::notation) has them.

use rustc_hash::FxHashMap;

use super::arrangement::{Factor, Summand, is_root, quotient, summands};
use crate::Rational;
use crate::forms::number_powers::{as_power, printed_parts};
use crate::graph::arena::Arena;
use crate::graph::expr::{Expr, Node, Product, Sum};
use crate::graph::function::Function;
use crate::graph::function::pieces::Pieces;
use crate::number::notation::whole;

/// The length up to which a formula is printed, all repetitions included.
const MOST_CHARACTERS: usize = 10_000_000;

/// The binding of a text's outermost operation.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
enum Binding {
    Sum,
    Negation,
    Product,
    Power,
    Atom,
}

/// The text of an expression and how it may be embedded.
#[derive(Clone, Debug)]
struct Text {
    text: String,
    binding: Binding,
}

impl Text {
    fn new(text: impl Into<String>, binding: Binding) -> Self {
        Self { text: text.into(), binding }
    }

    /// The text as an operand of something that binds at least as tightly as `least`.
    fn within(&self, least: Binding) -> String {
        if self.binding >= least { self.text.clone() } else { format!("({})", self.text) }
    }
}

impl Arena {
    /// The expression in the model file's grammar.
    ///
    /// Shared subexpressions are printed at every use, so that a short model can have a result longer than any page:
    /// then the text only gives its length.
    ///
    /// ```
    /// use pebo_cas::Arena;
    ///
    /// let arena = Arena::new();
    /// let [theta, c] = ["theta1", "C"].map(|name| arena.of_symbol(arena.symbol(name)));
    /// assert_eq!(arena.print(arena.div(arena.add(theta, arena.one()), c)), "(theta1 + 1)/C");
    /// ```
    pub fn print(&self, expr: Expr) -> String {
        let mut known: FxHashMap<Expr, Text> = FxHashMap::default();
        let mut written = 0;
        for e in printed_parts(self, expr) {
            let text = match self.node(e) {
                Node::Number(value) => self.print_number(&value),
                Node::Pi => Text::new("pi", Binding::Atom),
                Node::Symbol(symbol) => Text::new(self.name(symbol), Binding::Atom),
                Node::Sum(sum) => self.print_sum(&sum, &known),
                Node::Product(product) => self.print_product(&product, &known),
                Node::Call(function, arguments) => {
                    let special = self.print_power(function, arguments[0], &known);
                    special.or_else(|| self.print_table(e, &known)).unwrap_or_else(|| {
                        let inner: Vec<&str> = arguments.iter().map(|a| known[a].text.as_str()).collect();
                        Text::new(format!("{}({})", function.row().name, inner.join(", ")), Binding::Atom)
                    })
                }
            };
            written += text.text.len();
            if written > MOST_CHARACTERS {
                return format!("(a formula of more than {MOST_CHARACTERS} characters)");
            }
            known.insert(e, text);
        }
        known.remove(&expr).map(|t| t.text).unwrap_or_default()
    }

    /// A table at an argument.
    fn print_table(&self, call: Expr, known: &FxHashMap<Expr, Text>) -> Option<Text> {
        let (table, argument) = Pieces::of(self, call)?;
        Some(Text::new(format!("{}({})", self.table_name(&table), known[&argument].text), Binding::Atom))
    }

    /// A power of a number, if the function is one.
    fn print_power(&self, function: Function, argument: Expr, known: &FxHashMap<Expr, Text>) -> Option<Text> {
        let (number, exponent) = as_power(self, argument).filter(|_| function == Function::Exp)?;
        let base = self.print_number(&number).within(Binding::Atom);
        let exponent = known[&exponent].within(Binding::Atom);
        Some(Text::new(format!("{base}^{exponent}"), Binding::Power))
    }

    fn print_sum(&self, sum: &Sum, known: &FxHashMap<Expr, Text>) -> Text {
        let mut text = String::new();
        for (index, (negative, summand)) in summands(self, sum).into_iter().enumerate() {
            text.push_str(match (index, negative) {
                (0, true) => "-",
                (0, false) => "",
                (_, true) => " - ",
                (_, false) => " + ",
            });
            let summand = match summand {
                Summand::Number(value) => self.print_number(&value),
                Summand::Expr(term) => known[&term].clone(),
                Summand::Product(product) => self.print_product(&product, known),
            };
            text.push_str(&summand.within(Binding::Product));
        }
        Text::new(text, Binding::Sum)
    }

    fn print_product(&self, product: &Product, known: &FxHashMap<Expr, Text>) -> Text {
        let factor = |factor: Factor<'_>| match factor {
            Factor::Number(value) => self.print_number(&value).text,
            Factor::Power(base, exponent) => power(&known[&base], &exponent.abs()),
        };
        let (numerator, denominator) = quotient(self, product);
        let numerator: Vec<String> = numerator.into_iter().map(factor).collect();
        let denominator: Vec<String> = denominator.into_iter().map(factor).collect();
        let single = numerator.len() + denominator.len() == 1 && denominator.is_empty();
        let mut text = if numerator.is_empty() { "1".to_owned() } else { numerator.join("*") };
        match denominator.as_slice() {
            [] => {}
            [one] => text = format!("{text}/{one}"),
            several => text = format!("{text}/({})", several.join("*")),
        }
        if product.coefficient.is_negative() {
            Text::new(format!("-{text}"), Binding::Negation)
        } else if single && product.factors.len() == 1 && !product.factors[0].1.is_one() {
            Text::new(text, Binding::Power)
        } else {
            Text::new(text, Binding::Product)
        }
    }

    fn print_number(&self, value: &Rational) -> Text {
        if value.is_integer() {
            let binding = if value.is_negative() { Binding::Negation } else { Binding::Atom };
            return Text::new(whole(value), binding);
        }
        let sign = if value.is_negative() { "-" } else { "" };
        match self.notation().decimal(&value.abs()) {
            Some(text) if !self.notation().as_fraction(&value.abs()) => {
                Text::new(format!("{sign}{text}"), if sign.is_empty() { Binding::Atom } else { Binding::Negation })
            }
            _ => Text::new(value.to_string(), if sign.is_empty() { Binding::Product } else { Binding::Negation }),
        }
    }
}

/// `base ^ exponent` for a positive exponent, bound as tightly as a factor must be.
fn power(base: &Text, exponent: &Rational) -> String {
    if exponent.is_one() {
        return base.within(Binding::Power);
    }
    if is_root(exponent) {
        return format!("sqrt({})", base.text);
    }
    let base = base.within(Binding::Atom);
    if exponent.is_integer() { format!("{base}^{exponent}") } else { format!("{base}^({exponent})") }
}

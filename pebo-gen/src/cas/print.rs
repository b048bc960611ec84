//! Expressions as text in the model file's grammar: what is printed parses back to the same value.
//!
//! Small denominators stay fractions (`x/2`), others become decimals where these are exact
//! (`9.81*m`), as an engineer would write them.

use rustc_hash::FxHashMap;

use super::arena::Arena;
use super::expr::{Expr, Node, Product, Sum};
use super::rational::Rational;

/// The length up to which a formula is printed, with all of its parts.
const MOST_CHARACTERS: usize = 10_000_000;

/// How tightly the outermost operation of a text binds.
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
    /// What is shared is printed wherever it is used, so that a short model can have a result that no page holds: of
    /// that, the text says no more than how long it is.
    pub fn print(&self, expr: Expr) -> String {
        let mut known: FxHashMap<Expr, Text> = FxHashMap::default();
        let mut written = 0;
        for e in self.postorder(&[expr]) {
            let text = match self.node(e) {
                Node::Number(value) => number(&value),
                Node::Pi => Text::new("pi", Binding::Atom),
                Node::Symbol(symbol) => Text::new(self.name(symbol), Binding::Atom),
                Node::Sum(sum) => self.print_sum(&sum, &known),
                Node::Product(product) => print_product(&product, &known),
                Node::Call(function, arguments) => {
                    let inner: Vec<&str> = arguments.iter().map(|a| known[a].text.as_str()).collect();
                    Text::new(format!("{}({})", function.row().name, inner.join(", ")), Binding::Atom)
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

    fn print_sum(&self, sum: &Sum, known: &FxHashMap<Expr, Text>) -> Text {
        // (negative, text) for each summand
        let mut summands: Vec<(bool, String)> = Vec::with_capacity(sum.terms.len() + 1);
        for (term, coefficient) in &sum.terms {
            let scaled = match self.node(*term) {
                Node::Product(product) => {
                    let scaled = Product { coefficient: coefficient.abs(), factors: product.factors.clone() };
                    print_product(&scaled, known)
                }
                _ if coefficient.abs().is_one() => known[term].clone(),
                _ => {
                    let scaled = Product { coefficient: coefficient.abs(), factors: vec![(*term, Rational::ONE)] };
                    print_product(&scaled, known)
                }
            };
            summands.push((coefficient.is_negative(), scaled.within(Binding::Product)));
        }
        if !sum.constant.is_zero() {
            let constant = (sum.constant.is_negative(), number(&sum.constant.abs()).text);
            // `1 - d`, but `x + 1`.
            let leads = !constant.0 && summands.first().is_some_and(|s| s.0);
            let at = if leads { 0 } else { summands.len() };
            summands.insert(at, constant);
        }
        if let Some(positive) = summands.iter().position(|s| !s.0) {
            summands[..=positive].rotate_right(1);
        }
        let mut text = String::new();
        for (index, (negative, summand)) in summands.iter().enumerate() {
            text.push_str(match (index, negative) {
                (0, true) => "-",
                (0, false) => "",
                (_, true) => " - ",
                (_, false) => " + ",
            });
            text.push_str(summand);
        }
        Text::new(text, Binding::Sum)
    }
}

fn print_product(product: &Product, known: &FxHashMap<Expr, Text>) -> Text {
    let coefficient = product.coefficient.abs();
    let mut above: Vec<String> = Vec::new();
    let mut below: Vec<String> = Vec::new();
    if as_fraction(&coefficient) {
        let (n, d) = (coefficient.numerator(), coefficient.denominator());
        if !n.is_one() {
            above.push(n.to_string());
        }
        if !d.is_one() {
            below.push(d.to_string());
        }
    } else {
        above.push(number(&coefficient).text);
    }
    for (base, exponent) in &product.factors {
        let text = power(&known[base], &exponent.abs());
        if exponent.is_negative() { below.push(text) } else { above.push(text) }
    }
    let single = above.len() + below.len() == 1 && below.is_empty();
    let mut text = if above.is_empty() { "1".to_owned() } else { above.join("*") };
    match below.as_slice() {
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

/// `base ^ exponent` for a positive exponent, bound as tightly as a factor must be.
fn power(base: &Text, exponent: &Rational) -> String {
    if exponent.is_one() {
        return base.within(Binding::Power);
    }
    if Rational::new(1, 2).as_ref() == Some(exponent) {
        return format!("sqrt({})", base.text);
    }
    let base = base.within(Binding::Atom);
    if exponent.is_integer() { format!("{base}^{exponent}") } else { format!("{base}^({exponent})") }
}

/// Whether the number reads better as a fraction than as a decimal.
fn as_fraction(value: &Rational) -> bool {
    const LARGEST_DENOMINATOR: i64 = 12;
    value.denominator().to_i64().is_some_and(|d| d <= LARGEST_DENOMINATOR) || decimal(value).is_none()
}

fn number(value: &Rational) -> Text {
    if value.is_integer() {
        let binding = if value.is_negative() { Binding::Negation } else { Binding::Atom };
        return Text::new(value.to_string(), binding);
    }
    let sign = if value.is_negative() { "-" } else { "" };
    match decimal(&value.abs()) {
        Some(text) if !as_fraction(value) => {
            Text::new(format!("{sign}{text}"), if sign.is_empty() { Binding::Atom } else { Binding::Negation })
        }
        _ => Text::new(value.to_string(), if sign.is_empty() { Binding::Product } else { Binding::Negation }),
    }
}

/// The exact decimal of a non-negative number, if it is short.
fn decimal(value: &Rational) -> Option<String> {
    const MOST_PLACES: u32 = 12;
    let places = (0..=MOST_PLACES).find(|places| {
        Rational::from(10).pow(i32::try_from(*places).unwrap_or(0)).is_some_and(|scale| (value * &scale).is_integer())
    })?;
    let scale = Rational::from(10).pow(i32::try_from(places).ok()?)?;
    let digits = (value * &scale).to_string();
    // Leading zeros beyond a few read better as an exponent: 2.2e-5.
    let significant = digits.trim_end_matches('0');
    let width = usize::try_from(places).ok()?;
    if digits.len() + 3 <= width {
        let exponent = width - digits.len() + 1;
        let (head, tail) = significant.split_at(1);
        let point = if tail.is_empty() { "" } else { "." };
        return Some(format!("{head}{point}{tail}e-{exponent}"));
    }
    let padded = format!("{digits:0>width$}", width = width + 1);
    let (whole, fraction) = padded.split_at(padded.len() - width);
    Some(if fraction.is_empty() { whole.to_owned() } else { format!("{whole}.{fraction}") })
}

//! Expressions as presentation `MathML`: the formulas of [`Arena::print`] in two dimensions.
//!
//! In: an expression. Out: one `math` element, or its content, well-formed as XML and as HTML, without named entities,
//! in the names of the model: `theta1` is a theta with an index, `L_1` an L. Quotients are fractions, square roots have
//! a bar, and functions are upright by the names of the one table. Parentheses are only where reading needs them.

use std::collections::BTreeMap;

use rustc_hash::FxHashMap;

use super::arrangement::{Factor, Summand, is_root, quotient, summands};
use super::letter::{greek, parts};
use crate::Rational;
use crate::forms::number_powers::{as_power, printed_parts};
use crate::graph::arena::Arena;
use crate::graph::expr::{Expr, Node, Product, Sum, Symbol};
use crate::graph::function::Function;
use crate::graph::function::pieces::Pieces;

/// The length up to which a formula is set, all repetitions included.
const MOST_CHARACTERS: usize = 10_000_000;

/// Invisible sign between a function and its arguments.
const APPLY: &str = "<mo>&#x2061;</mo>";

/// Invisible sign between factors.
const TIMES: &str = "<mo>&#x2062;</mo>";

/// Between factors that would read as one.
const DOT: &str = "<mo>⋅</mo>";

const MINUS: &str = "<mo>−</mo>";

/// The binding of the outermost operation, as far as signs show it.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
enum Binding {
    Sum,
    Product,
    /// Fractions and powers: a factor as they are, no base.
    Factor,
    Atom,
}

/// The elements of an expression, its binding, and its two ends.
#[derive(Clone, Debug)]
struct Markup {
    elements: String,
    binding: Binding,
    ends: Ends,
}

/// The kind of character at an end, for the sign between two factors.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Ends {
    /// A digit.
    Digit,
    /// A name of several letters, a function.
    Word,
    /// A letter, a fraction, a parenthesis.
    Plain,
}

impl Markup {
    fn new(elements: impl Into<String>, binding: Binding, ends: Ends) -> Self {
        Self { elements: elements.into(), binding, ends }
    }

    fn atom(elements: impl Into<String>) -> Self {
        Self::new(elements, Binding::Atom, Ends::Plain)
    }

    /// As an operand of something that binds at least as tightly as `least`.
    fn within(&self, least: Binding) -> Self {
        if self.binding >= least { self.clone() } else { Self::atom(parenthesised(&self.elements)) }
    }

    /// As one element.
    fn element(&self) -> String {
        format!("<mrow>{}</mrow>", self.elements)
    }
}

impl Arena {
    /// The expression as a `math` element.
    ///
    /// Shared subexpressions are set at every use; for a formula longer than any page, the element only gives its
    /// length.
    ///
    /// ```
    /// use pebo_cas::Arena;
    ///
    /// let arena = Arena::new();
    /// let [theta, c] = ["theta1", "C"].map(|name| arena.of_symbol(arena.symbol(name)));
    /// let fraction = "<mfrac><mrow><msub><mi>θ</mi><mn>1</mn></msub></mrow><mrow><mi>C</mi></mrow></mfrac>";
    /// assert_eq!(arena.mathml(arena.div(theta, c)), format!("<math>{fraction}</math>"));
    /// ```
    pub fn mathml(&self, expr: Expr) -> String {
        format!("<math>{}</math>", self.mathml_elements(expr, &BTreeMap::new()))
    }

    /// The content of the `math` element, for a larger formula; a symbol of `shown` is set as the formula beside it, in
    /// parentheses where reading needs them: a substitution before any simplification.
    pub fn mathml_elements(&self, expr: Expr, shown: &BTreeMap<Symbol, Expr>) -> String {
        let mut known: FxHashMap<Expr, Markup> = FxHashMap::default();
        let mut written = 0;
        let replaced: Vec<Expr> = shown.values().copied().collect();
        for e in replaced.iter().flat_map(|e| printed_parts(self, *e)) {
            known.insert(e, self.typeset(e, &known));
            written += known[&e].elements.len();
            if written > MOST_CHARACTERS {
                return too_long();
            }
        }
        let replaced: BTreeMap<Symbol, Markup> = shown.iter().map(|(symbol, e)| (*symbol, known[e].clone())).collect();
        known.clear();
        for e in printed_parts(self, expr) {
            let row = match self.as_symbol(e).and_then(|symbol| replaced.get(&symbol)) {
                Some(row) => row.clone(),
                None => self.typeset(e, &known),
            };
            written += row.elements.len();
            if written > MOST_CHARACTERS {
                return too_long();
            }
            known.insert(e, row);
        }
        known.remove(&expr).map(|row| row.elements).unwrap_or_default()
    }

    /// The rate of a signal, as a point over its letter.
    pub fn mathml_rate(&self, symbol: Symbol) -> String {
        let rate = |letter: String| {
            // The dot replaces that of the letter.
            let letter = match letter.as_str() {
                "<mi>i</mi>" => "<mi>ı</mi>",
                "<mi>j</mi>" => "<mi>ȷ</mi>",
                other => other,
            };
            format!("<mover accent=\"true\">{letter}<mo stretchy=\"false\">˙</mo></mover>")
        };
        named(&self.name(symbol), rate).elements
    }

    /// The value of a parameter: a decimal if it has a short one, as most authors write it.
    pub fn mathml_value(&self, value: &Rational) -> String {
        self.typeset_number_in(value, false).elements
    }

    /// The elements of an expression from those of its operands.
    fn typeset(&self, expr: Expr, known: &FxHashMap<Expr, Markup>) -> Markup {
        match self.node(expr) {
            Node::Number(value) => self.typeset_number(&value),
            Node::Pi => Markup::atom("<mi>π</mi>"),
            Node::Symbol(symbol) => named(&self.name(symbol), |letter| letter),
            Node::Sum(sum) => self.typeset_sum(&sum, known),
            Node::Product(product) => self.typeset_product(&product, known),
            Node::Call(function, arguments) => {
                let special = self.typeset_power(function, arguments[0], known);
                special.or_else(|| self.typeset_table(expr, known)).unwrap_or_else(|| {
                    let arguments: Vec<&str> = arguments.iter().map(|a| known[a].elements.as_str()).collect();
                    call(function, &arguments.join("<mo>,</mo>"))
                })
            }
        }
    }

    /// A table at an argument, a prime for each derivative.
    fn typeset_table(&self, call: Expr, known: &FxHashMap<Expr, Markup>) -> Option<Markup> {
        let (table, argument) = Pieces::of(self, call)?;
        let primes = "′".repeat(table.order);
        let primed = |letter: String| match primes.as_str() {
            "" => letter,
            primes => format!("<msup>{letter}<mo>{primes}</mo></msup>"),
        };
        let name = named(&self.table_name(&Pieces { order: 0, ..table }), primed).elements;
        let call = format!("<mrow>{name}{APPLY}{}</mrow>", parenthesised(&known[&argument].elements));
        Some(Markup::new(call, Binding::Atom, Ends::Word))
    }

    /// A power of a number, if the function is one.
    fn typeset_power(&self, function: Function, argument: Expr, known: &FxHashMap<Expr, Markup>) -> Option<Markup> {
        let (number, exponent) = as_power(self, argument).filter(|_| function == Function::Exp)?;
        let base = self.typeset_number(&number).within(Binding::Atom);
        let power = format!("<msup>{}{}</msup>", base.element(), known[&exponent].element());
        Some(Markup::new(power, Binding::Factor, base.ends))
    }

    fn typeset_sum(&self, sum: &Sum, known: &FxHashMap<Expr, Markup>) -> Markup {
        let mut elements = String::new();
        for (index, (negative, summand)) in summands(self, sum).into_iter().enumerate() {
            elements.push_str(match (index, negative) {
                (0, false) => "",
                (_, true) => MINUS,
                (_, false) => "<mo>+</mo>",
            });
            let summand = match summand {
                Summand::Number(value) => self.typeset_number(&value),
                Summand::Expr(term) => known[&term].clone(),
                Summand::Product(product) => self.typeset_product(&product, known),
            };
            elements.push_str(&summand.within(Binding::Product).elements);
        }
        Markup::new(elements, Binding::Sum, Ends::Plain)
    }

    fn typeset_product(&self, product: &Product, known: &FxHashMap<Expr, Markup>) -> Markup {
        let factor = |factor: &Factor<'_>| match factor {
            Factor::Number(value) => self.typeset_number(value),
            Factor::Power(base, exponent) => power(&known[base], &exponent.abs()),
        };
        let (numerator, denominator) = quotient(self, product);
        let [numerator, denominator] =
            [numerator, denominator].map(|side| side.iter().map(factor).collect::<Vec<Markup>>());
        let row = if denominator.is_empty() {
            side(&numerator, Binding::Factor)
        } else {
            let [numerator, denominator] =
                [numerator, denominator].map(|factors| side(&factors, Binding::Sum).element());
            let fraction = format!("<mfrac>{numerator}{denominator}</mfrac>");
            Markup::new(fraction, Binding::Factor, Ends::Plain)
        };
        if product.coefficient.is_negative() {
            // A minus before a factor binds as a sum does: (−a)b and (−a)² keep their parentheses.
            Markup::new(format!("{MINUS}{}", row.elements), Binding::Sum, row.ends)
        } else {
            row
        }
    }

    fn typeset_number(&self, value: &Rational) -> Markup {
        self.typeset_number_in(value, self.notation().as_fraction(&value.abs()))
    }

    /// A number as a fraction, or as a decimal if it has a short one.
    fn typeset_number_in(&self, value: &Rational, fraction: bool) -> Markup {
        let absolute = value.abs();
        let row = match self.notation().decimal(&absolute) {
            _ if absolute.is_integer() => Markup::new(format!("<mn>{absolute}</mn>"), Binding::Atom, Ends::Digit),
            Some(text) if !fraction => match text.split_once("e-") {
                Some((digits, exponent)) => {
                    let ten = format!("<msup><mn>10</mn><mrow>{MINUS}<mn>{exponent}</mn></mrow></msup>");
                    Markup::new(format!("<mn>{digits}</mn>{DOT}{ten}"), Binding::Factor, Ends::Digit)
                }
                None => Markup::new(format!("<mn>{text}</mn>"), Binding::Atom, Ends::Digit),
            },
            _ => {
                let (numerator, denominator) = (absolute.numerator(), absolute.denominator());
                Markup::new(
                    format!("<mfrac><mn>{numerator}</mn><mn>{denominator}</mn></mfrac>"),
                    Binding::Factor,
                    Ends::Plain,
                )
            }
        };
        if value.is_negative() { Markup::new(format!("{MINUS}{}", row.elements), Binding::Sum, row.ends) } else { row }
    }
}

/// Factors beside one another; a single one binds at least as tightly as `least`.
fn side(factors: &[Markup], least: Binding) -> Markup {
    match factors {
        [] => Markup::new("<mn>1</mn>", Binding::Atom, Ends::Digit),
        [alone] => alone.within(least),
        [first, rest @ ..] => {
            let first = first.within(Binding::Factor);
            let (mut elements, mut before) = (first.elements.clone(), first.ends);
            for factor in rest.iter().map(|factor| factor.within(Binding::Factor)) {
                let merge = factor.ends == Ends::Digit || before == Ends::Word || factor.ends == Ends::Word;
                elements.push_str(if merge { DOT } else { TIMES });
                elements.push_str(&factor.elements);
                before = factor.ends;
            }
            Markup::new(elements, Binding::Product, Ends::Plain)
        }
    }
}

/// `base ^ exponent` for a positive exponent.
fn power(base: &Markup, exponent: &Rational) -> Markup {
    if exponent.is_one() {
        return base.clone();
    }
    if is_root(exponent) {
        return Markup::atom(format!("<msqrt>{}</msqrt>", base.elements));
    }
    let base = base.within(Binding::Atom);
    let superscript = if exponent.is_integer() {
        format!("<mn>{exponent}</mn>")
    } else {
        format!("<mrow><mn>{}</mn><mo>/</mo><mn>{}</mn></mrow>", exponent.numerator(), exponent.denominator())
    };
    Markup::new(format!("<msup>{}{superscript}</msup>", base.element()), Binding::Factor, base.ends)
}

fn call(function: Function, arguments: &str) -> Markup {
    match function {
        Function::Abs => Markup::atom(format!("<mrow><mo>|</mo>{arguments}<mo>|</mo></mrow>")),
        Function::Sqrt => Markup::atom(format!("<msqrt>{arguments}</msqrt>")),
        _ => {
            let name = function.row().typeset();
            let call = format!("<mrow><mi>{name}</mi>{APPLY}{}</mrow>", parenthesised(arguments));
            Markup::new(call, Binding::Atom, Ends::Word)
        }
    }
}

fn parenthesised(elements: &str) -> String {
    format!("<mrow><mo>(</mo>{elements}<mo>)</mo></mrow>")
}

/// A substitute for a formula longer than any page.
fn too_long() -> String {
    format!("<mtext>(a formula of more than {MOST_CHARACTERS} characters)</mtext>")
}

/// A name: its letter with an accent, its index below; several indices with commas between them.
fn named(name: &str, put: impl Fn(String) -> String) -> Markup {
    let (base, index) = parts(name);
    let letter = put(identifier(base));
    let ends = if greek(base).is_some() || base.chars().count() == 1 { Ends::Plain } else { Ends::Word };
    let indices: Vec<String> = index.split('_').filter(|part| !part.is_empty()).map(subscript).collect();
    let elements = match indices.as_slice() {
        [] => letter,
        [one] => format!("<msub>{letter}{one}</msub>"),
        several => format!("<msub>{letter}<mrow>{}</mrow></msub>", several.join("<mo>,</mo>")),
    };
    Markup::new(elements, Binding::Atom, ends)
}

fn subscript(index: &str) -> String {
    if index.chars().all(|character| character.is_ascii_digit()) {
        format!("<mn>{index}</mn>")
    } else {
        identifier(index)
    }
}

fn identifier(name: &str) -> String {
    match greek(name) {
        Some(letter) => format!("<mi>{letter}</mi>"),
        None => format!("<mi>{}</mi>", escaped(name)),
    }
}

/// A text as XML and HTML encode it; characters that they cannot encode are replaced.
pub fn escaped(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for character in text.chars() {
        match character {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            '\'' => escaped.push_str("&#39;"),
            '\u{FFFE}' | '\u{FFFF}' => escaped.push('\u{FFFD}'),
            '\n' | '\t' => escaped.push(character),
            c if c.is_control() => escaped.push('\u{FFFD}'),
            c => escaped.push(c),
        }
    }
    escaped
}

#[cfg(test)]
mod tests;

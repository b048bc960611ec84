//! Formulas in floating point, with slopes: a reader and an evaluator that share nothing with the algebra they judge.
//!
//! In: the text of a formula, values and rates of its names. Out: its value, its rate (forward differentiation), and
//! the largest absolute value met on the way, to which rounding is relative.

use std::collections::{BTreeMap, BTreeSet};

/// A formula as a tree.
#[derive(Clone, Debug)]
pub(crate) enum Formula {
    Number(f64),
    Name(String),
    Call(String, Vec<Formula>),
    Negative(Box<Formula>),
    Binary(char, Box<Formula>, Box<Formula>),
}

/// Names with their values and rates.
pub(crate) type Values = BTreeMap<String, (f64, f64)>;

/// A value, its rate, and the largest absolute value met.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Evaluation {
    pub(crate) value: f64,
    pub(crate) slope: f64,
    pub(crate) size: f64,
}

/// An inequality chain, as `0 < d < 1`.
#[derive(Clone, Debug)]
pub(crate) struct Comparison {
    sides: Vec<Formula>,
    relations: Vec<String>,
}

impl Comparison {
    pub(crate) fn read(text: &str) -> Self {
        let mut sides = Vec::new();
        let mut relations = Vec::new();
        let mut rest = text;
        while let Some(at) = rest.find(['<', '>', '!']) {
            sides.push(Formula::read(&rest[..at]));
            let length = if rest[at + 1..].starts_with('=') { 2 } else { 1 };
            relations.push(rest[at..at + length].to_owned());
            rest = &rest[at + length..];
        }
        sides.push(Formula::read(rest));
        Self { sides, relations }
    }

    /// The names that it speaks of.
    pub(crate) fn names(&self) -> BTreeSet<String> {
        self.sides.iter().flat_map(Formula::names).collect()
    }

    /// It holds, by more than rounding.
    pub(crate) fn holds(&self, values: &Values) -> bool {
        let sides: Vec<Evaluation> = self.sides.iter().map(|side| side.at(values)).collect();
        sides.windows(2).zip(&self.relations).all(|(pair, relation)| {
            let difference = pair[0].value - pair[1].value;
            // A value within rounding of the bound counts as outside: nothing is asserted there.
            let close = 1e-9 * (pair[0].size + pair[1].size + 1e-3);
            match relation.as_str() {
                "<" | "<=" => difference < -close,
                ">" | ">=" => difference > close,
                _ => difference.abs() > close,
            }
        })
    }
}

impl Formula {
    pub(crate) fn read(text: &str) -> Self {
        let mut reader = Reader { text: text.as_bytes(), at: 0 };
        let formula = reader.sum();
        reader.skip();
        assert_eq!(reader.at, text.len(), "a formula ends early: {text}");
        formula
    }

    /// The names in it but the constant of the circle.
    pub(crate) fn names(&self) -> BTreeSet<String> {
        match self {
            Self::Number(_) => BTreeSet::new(),
            Self::Name(name) if name == "pi" => BTreeSet::new(),
            Self::Name(name) => BTreeSet::from([name.clone()]),
            Self::Negative(inner) => inner.names(),
            Self::Binary(_, left, right) => left.names().into_iter().chain(right.names()).collect(),
            Self::Call(_, arguments) => arguments.iter().flat_map(Self::names).collect(),
        }
    }

    /// The value at the given values of its names.
    pub(crate) fn at(&self, values: &Values) -> Evaluation {
        match self {
            Self::Number(number) => Evaluation::new(*number, 0.0),
            Self::Name(name) if name == "pi" && !values.contains_key("pi") => {
                Evaluation::new(std::f64::consts::PI, 0.0)
            }
            Self::Name(name) => {
                let (value, slope) = values.get(name).unwrap_or_else(|| panic!("no value for `{name}`"));
                Evaluation::new(*value, *slope)
            }
            Self::Negative(inner) => {
                let a = inner.at(values);
                Evaluation { value: -a.value, slope: -a.slope, size: a.size }
            }
            Self::Binary(operator, left, right) => binary(*operator, left.at(values), right.at(values)),
            Self::Call(name, arguments) => {
                let arguments: Vec<Evaluation> = arguments.iter().map(|argument| argument.at(values)).collect();
                call(name, &arguments)
            }
        }
    }
}

impl Evaluation {
    fn new(value: f64, slope: f64) -> Self {
        Self { value, slope, size: value.abs().max(slope.abs()) }
    }

    fn after(value: f64, slope: f64, operands: &[Self]) -> Self {
        let size = operands.iter().fold(value.abs().max(slope.abs()), |size, operand| size.max(operand.size));
        Self { value, slope, size }
    }
}

fn binary(operator: char, a: Evaluation, b: Evaluation) -> Evaluation {
    let of = |value, slope| Evaluation::after(value, slope, &[a, b]);
    match operator {
        '+' => of(a.value + b.value, a.slope + b.slope),
        '-' => of(a.value - b.value, a.slope - b.slope),
        '*' => of(a.value * b.value, a.slope * b.value + a.value * b.slope),
        '/' => of(a.value / b.value, (a.slope * b.value - a.value * b.slope) / (b.value * b.value)),
        '^' => power(a, b),
        _ => unreachable!("an operator of the reader"),
    }
}

/// Real powers: any base under a whole exponent, else a base that is not negative.
fn power(a: Evaluation, b: Evaluation) -> Evaluation {
    let whole = b.slope == 0.0 && b.value.fract() == 0.0;
    let value = if whole || a.value >= 0.0 { a.value.powf(b.value) } else { f64::NAN };
    let mut slope = 0.0;
    if b.slope == 0.0 && b.value == 0.0 {
        return Evaluation::after(1.0, 0.0, &[a]);
    }
    // At a base of zero the derivative exists for exponents of one and more, whatever the rate.
    if b.slope == 0.0 {
        slope += b.value * a.value.powf(b.value - 1.0) * a.slope;
    } else {
        slope += value * (b.slope * a.value.ln() + b.value * a.slope / a.value);
    }
    Evaluation::after(value, slope, &[a, b])
}

fn call(name: &str, arguments: &[Evaluation]) -> Evaluation {
    let a = arguments[0];
    let x = a.value;
    let (value, factor) = match name {
        "sin" => (x.sin(), x.cos()),
        "cos" => (x.cos(), -x.sin()),
        "tan" => (x.tan(), 1.0 + x.tan().powi(2)),
        "asin" => (x.asin(), 1.0 / (1.0 - x * x).sqrt()),
        "acos" => (x.acos(), -1.0 / (1.0 - x * x).sqrt()),
        "atan" => (x.atan(), 1.0 / (1.0 + x * x)),
        "sinh" => (x.sinh(), x.cosh()),
        "cosh" => (x.cosh(), x.sinh()),
        "tanh" => (x.tanh(), 1.0 - x.tanh().powi(2)),
        "asinh" => (x.asinh(), 1.0 / x.hypot(1.0)),
        "acosh" => (x.acosh(), 1.0 / ((x - 1.0) * (x + 1.0)).sqrt()),
        "atanh" => (x.atanh(), 1.0 / ((1.0 - x) * (1.0 + x))),
        "exp" => (x.exp(), x.exp()),
        "log" | "ln" => (x.ln(), 1.0 / x),
        "sqrt" => (x.sqrt(), 0.5 / x.sqrt()),
        "abs" => (x.abs(), if x == 0.0 { f64::NAN } else { x.signum() }),
        "sign" => (if x == 0.0 { f64::NAN } else { x.signum() }, 0.0),
        "sat" if x.abs() < 1.0 => (x, 1.0),
        "sat" => (x.signum(), if x.abs() > 1.0 { 0.0 } else { f64::NAN }),
        "min" | "max" => {
            let b = arguments[1];
            let ahead = b.value - x;
            let first = (ahead > 0.0) == (name == "min");
            let chosen = if first { a } else { b };
            let slope = if ahead == 0.0 { f64::NAN } else { chosen.slope };
            return Evaluation::after(chosen.value, slope, arguments);
        }
        "atan2" => {
            let b = arguments[1];
            let square = x * x + b.value * b.value;
            let slope = (a.slope * b.value - x * b.slope) / square;
            // At the origin there is neither an angle nor a slope.
            let value = if square == 0.0 { f64::NAN } else { x.atan2(b.value) };
            return Evaluation::after(value, slope, arguments);
        }
        _ => panic!("no such function: {name}"),
    };
    Evaluation::after(value, factor * a.slope, arguments)
}

struct Reader<'a> {
    text: &'a [u8],
    at: usize,
}

impl Reader<'_> {
    fn skip(&mut self) {
        while self.text.get(self.at).is_some_and(u8::is_ascii_whitespace) {
            self.at += 1;
        }
    }

    fn take(&mut self, wanted: &[u8]) -> bool {
        self.skip();
        let found = self.text[self.at..].starts_with(wanted);
        if found {
            self.at += wanted.len();
        }
        found
    }

    fn sum(&mut self) -> Formula {
        let mut left = self.product();
        loop {
            let operator = if self.take(b"+") {
                '+'
            } else if self.take(b"-") {
                '-'
            } else {
                return left;
            };
            left = Formula::Binary(operator, Box::new(left), Box::new(self.product()));
        }
    }

    fn product(&mut self) -> Formula {
        let mut left = self.signed();
        loop {
            self.skip();
            let power = self.text[self.at..].starts_with(b"**");
            let operator = if !power && self.take(b"*") {
                '*'
            } else if self.take(b"/") {
                '/'
            } else {
                return left;
            };
            left = Formula::Binary(operator, Box::new(left), Box::new(self.signed()));
        }
    }

    fn signed(&mut self) -> Formula {
        if self.take(b"-") {
            return Formula::Negative(Box::new(self.signed()));
        }
        if self.take(b"+") {
            return self.signed();
        }
        let base = self.atom();
        if self.take(b"^") || self.take(b"**") {
            return Formula::Binary('^', Box::new(base), Box::new(self.signed()));
        }
        base
    }

    fn atom(&mut self) -> Formula {
        if self.take(b"(") {
            let inner = self.sum();
            assert!(self.take(b")"), "a bracket is not closed: {}", String::from_utf8_lossy(self.text));
            return inner;
        }
        self.skip();
        let start = self.at;
        let letter = |c: &u8| c.is_ascii_alphanumeric() || *c == b'_' || *c == b'\'';
        if self.text.get(start).is_some_and(|c| c.is_ascii_digit() || *c == b'.') {
            while let Some(c) = self.text.get(self.at) {
                let exponent = (*c == b'+' || *c == b'-') && matches!(self.text[self.at - 1], b'e' | b'E');
                if !(c.is_ascii_digit() || matches!(c, b'.' | b'e' | b'E') || exponent) {
                    break;
                }
                self.at += 1;
            }
            let text = String::from_utf8_lossy(&self.text[start..self.at]).into_owned();
            return Formula::Number(text.parse().unwrap_or_else(|_| panic!("a number: {text}")));
        }
        while self.text.get(self.at).is_some_and(letter) {
            self.at += 1;
        }
        let name = String::from_utf8_lossy(&self.text[start..self.at]).into_owned();
        assert!(!name.is_empty(), "a formula: {}", String::from_utf8_lossy(self.text));
        if !self.take(b"(") {
            return Formula::Name(name);
        }
        let mut arguments = vec![self.sum()];
        while self.take(b",") {
            arguments.push(self.sum());
        }
        assert!(self.take(b")"), "a bracket is not closed: {}", String::from_utf8_lossy(self.text));
        Formula::Call(name, arguments)
    }
}

#[test]
fn formulas_are_read_as_the_language_says() {
    let values: Values = [("a", (2.0, 1.0)), ("b", (3.0, 0.0))].map(|(n, v)| (n.to_owned(), v)).into();
    for (text, value, slope) in [
        ("-a^2", -4.0, -4.0),
        ("a^b^2", 512.0, 9.0 * 256.0),
        ("2**a", 4.0, 4.0 * std::f64::consts::LN_2),
        ("a - b - 1", -2.0, 1.0),
        ("b/a/2", 0.75, -0.375),
        ("1.5e1*a", 30.0, 15.0),
        ("atan2(a, b)", 2.0_f64.atan2(3.0), 3.0 / 13.0),
        ("2*-a", -4.0, -2.0),
        ("a^-1", 0.5, -0.25),
    ] {
        let found = Formula::read(text).at(&values);
        assert!((found.value - value).abs() < 1e-12 && (found.slope - slope).abs() < 1e-9, "{text}: {found:?}");
    }
    assert!(Comparison::read("0 < a <= 3").holds(&values));
    assert!(!Comparison::read("a != 2").holds(&values));
}

//! Cases: identities with random operands, embedded and composed, and their perturbations.

use super::draw::Draw;
use super::{rules, rules_inverse};

/// A class of identities.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Class {
    Rational,
    Trigonometric,
    Exponential,
    Logarithmic,
    Root,
    Inverse,
    Absolute,
    Mixed,
    Leibniz,
}

impl Class {
    pub(crate) const ALL: [Self; 9] = [
        Self::Rational,
        Self::Trigonometric,
        Self::Exponential,
        Self::Logarithmic,
        Self::Root,
        Self::Inverse,
        Self::Absolute,
        Self::Mixed,
        Self::Leibniz,
    ];

    fn rules(self) -> &'static [(&'static str, &'static str)] {
        match self {
            Self::Rational | Self::Mixed | Self::Leibniz => rules::RATIONAL,
            Self::Trigonometric => rules::TRIGONOMETRIC,
            Self::Exponential => rules::EXPONENTIAL,
            Self::Logarithmic => rules::LOGARITHMIC,
            Self::Root => rules::ROOT,
            Self::Inverse => rules_inverse::INVERSE,
            Self::Absolute => rules_inverse::ABSOLUTE,
        }
    }
}

/// Two formulas that are equal, or nearly so, where the facts hold.
#[derive(Clone, Debug)]
pub(crate) struct Case {
    /// The identity it was made of.
    pub(crate) rule: String,
    pub(crate) left: String,
    pub(crate) right: String,
    pub(crate) facts: &'static [&'static str],
}

impl Case {
    pub(crate) fn text(&self) -> String {
        format!("{} - ({})", self.left, self.right)
    }
}

/// Facts of every case: p, q and r are positive, t is between -1 and 1, w within (0, pi/2).
pub(crate) const FACTS: &[&str] = &["p", "q", "r", "1 - t", "1 + t", "w", "pi/2 - w"];

/// A true case of the class.
pub(crate) fn identity(class: Class, draw: &mut Draw) -> Case {
    match class {
        Class::Mixed => mixed(draw),
        Class::Leibniz => {
            let (first, second) = (draw.of(&BASIC), draw.of(&BASIC));
            let rules = [*first, *second].map(|class| pick(class, draw));
            let left = filled(rules[0].0, draw);
            let right = filled(rules[1].0, draw);
            Case { rule: format!("({})*({})", rules[0].0, rules[1].0), left, right, facts: FACTS }
        }
        _ => embedded(plain(class, draw), draw),
    }
}

const BASIC: [&Class; 7] = [
    &Class::Rational,
    &Class::Trigonometric,
    &Class::Exponential,
    &Class::Logarithmic,
    &Class::Root,
    &Class::Inverse,
    &Class::Absolute,
];

fn pick(class: Class, draw: &mut Draw) -> (&'static str, &'static str) {
    let rules = class.rules();
    rules[draw.below(rules.len())]
}

/// A rule with its operands filled in, the same on both sides.
fn plain(class: Class, draw: &mut Draw) -> Case {
    let (left, right) = pick(class, draw);
    let both = filled(&format!("{left} @ {right}"), draw);
    let (a, b) = both.split_once(" @ ").expect("the separator");
    let (left_text, right_text) = if draw.once_in(2) { (a, b) } else { (b, a) };
    Case {
        rule: format!("{left} = {right}"),
        left: left_text.to_owned(),
        right: format!("({right_text})"),
        facts: FACTS,
    }
}

/// The identity within a larger expression, the same on both sides.
fn embedded(case: Case, draw: &mut Draw) -> Case {
    let (l, r) = (format!("({})", case.left), case.right.clone());
    let other = filled("A", draw);
    let positive = filled("P", draw);
    let (left, right) = match draw.below(9) {
        0 => (format!("{l}*{other}"), format!("{other}*{r}")),
        1 => (format!("{l}/{positive} + {other}"), format!("({r} + {other}*{positive})/{positive}")),
        2 => (format!("({l} + {other})^2"), format!("{r}^2 + 2*{l}*{other} + {other}^2")),
        3 => (format!("sin({l} + {positive})"), format!("sin({r})*cos({positive}) + cos({l})*sin({positive})")),
        4 => (format!("1/({l}^2 + 1)"), format!("1/({r}*{l} + 1)")),
        5 => (format!("{positive}*({l} - {other})"), format!("{r}*{positive} - {positive}*{other}")),
        _ => return case,
    };
    Case { left, right, ..case }
}

/// Two identities of any classes, combined.
fn mixed(draw: &mut Draw) -> Case {
    let (first, second) = (draw.of(&BASIC), draw.of(&BASIC));
    let (a, b) = (plain(*first, draw), plain(*second, draw));
    let (l, m) = (format!("({})", a.left), format!("({})", b.left));
    let (r, s) = (&a.right, &b.right);
    let (left, right) = match draw.below(7) {
        0 => (format!("{l}*{m}"), format!("{s}*{r}")),
        1 => (format!("{l} - {m}"), format!("{r} - {s}")),
        2 => (format!("{l}/{m}"), format!("{r}*{l}/({l}*{s})")),
        3 => (format!("({l} + {m})^2"), format!("{r}^2 + {s}^2 + 2*{r}*{s}")),
        4 => (format!("exp({l})*{m}"), format!("exp({r})*{s}")),
        5 => (format!("({l} - {m})*({r} + {s})"), format!("{r}^2 - {s}^2")),
        _ => (format!("cos({l})*{m} + 1/(1 + {m}^2)"), format!("cos({r})*{s} + 1/(1 + {s}^2)")),
    };
    Case { rule: format!("{} | {}", a.rule, b.rule), left, right, facts: FACTS }
}

const SYMBOLS: [&str; 6] = ["x", "y", "z", "a", "b", "p"];
const LINEAR: [&str; 8] = ["S", "S", "2*S", "S/2", "S + D", "S - D/3", "3*S/2", "S - 2*D"];
const TERMS: [&str; 12] =
    ["S", "S", "2*S", "S/3", "S + D", "S*D", "S^2", "a*S + b", "S - D/2", "1 + S", "S*D - 1", "S/(1 + D^2)"];
const POSITIVE: [&str; 12] =
    ["p", "q", "r", "2*p", "q/3", "p*q", "p + q", "1 + p", "p/r", "p^2 + 1", "2*r + 1/2", "q^2"];
const BETWEEN: [&str; 6] = ["t", "t", "t/2", "t^2", "-t", "p/(1 + p)"];

/// The template with operands: each letter the same throughout.
fn filled(template: &str, draw: &mut Draw) -> String {
    let mut values: Vec<(char, String)> = Vec::new();
    for letter in ['A', 'B', 'L', 'M', 'P', 'Q', 'R', 'T', 'N', 'W'] {
        let value = match letter {
            'A' | 'B' => bracketed(&term(draw.of(&TERMS), draw)),
            'L' | 'M' => bracketed(&term(draw.of(&LINEAR), draw)),
            'P' | 'Q' | 'R' => bracketed(draw.of(&POSITIVE)),
            'T' => bracketed(draw.of(&BETWEEN)),
            'N' => (2 + draw.below(4)).to_string(),
            _ => draw.of(&["w", "w", "w/2", "(w + pi/4)/2"]).to_owned(),
        };
        values.push((letter, value));
    }
    let mut text = String::new();
    for letter in template.chars() {
        match values.iter().find(|(place, _)| *place == letter) {
            Some((_, value)) => text.push_str(value),
            None => text.push(letter),
        }
    }
    text
}

fn term(template: &str, draw: &mut Draw) -> String {
    template.replace('S', draw.of(&SYMBOLS)).replace('D', draw.of(&SYMBOLS))
}

fn bracketed(text: &str) -> String {
    if text.len() == 1 { text.to_owned() } else { format!("({text})") }
}

/// The case with one number, sign, symbol or function of the right side changed.
pub(crate) fn perturbed(case: &Case, draw: &mut Draw) -> Case {
    let bytes = case.right.as_bytes();
    let word = |at: usize| bytes.get(at).is_some_and(u8::is_ascii_alphabetic);
    // Behind an operand a sign is that of a sum or difference.
    let unary = |at: usize| case.right[..at].trim_end().ends_with(['(', '*', '/', ',']) || at == 0;
    let places: Vec<usize> = (0..bytes.len())
        .filter(|&at| match bytes[at] {
            b'+' => true,
            b'-' => at == 0 || bytes[at - 1] != b'^',
            b'0'..=b'9' | b'a'..=b'z' => at == 0 || !word(at - 1),
            _ => false,
        })
        .collect();
    if places.is_empty() {
        return Case { right: format!("{} + 1/1000", case.right), ..case.clone() };
    }
    let at = places[draw.below(places.len())];
    let end = (at + 1..=bytes.len()).find(|&end| !word(at) || !word(end)).unwrap_or(bytes.len());
    let changed = match (&case.right[at..end], bytes[at]) {
        ("+", _) => "-".to_owned(),
        // There is no unary plus.
        ("-", _) if unary(at) => String::new(),
        ("-", _) => "+".to_owned(),
        (digit, b'0'..=b'9') => (digit.parse::<u32>().unwrap_or(1) + 1).to_string(),
        ("sin", _) => "cos".to_owned(),
        ("cos", _) => "sin".to_owned(),
        ("cosh", _) => "sinh".to_owned(),
        ("sinh" | "tan", _) => "tanh".to_owned(),
        ("exp", _) => "cosh".to_owned(),
        ("asin", _) => "atan".to_owned(),
        (name, _) if name.len() == 1 => draw.of(&SYMBOLS).to_owned(),
        (name, _) => format!("2*{name}"),
    };
    Case { right: format!("{}{changed}{}", &case.right[..at], &case.right[end..]), ..case.clone() }
}

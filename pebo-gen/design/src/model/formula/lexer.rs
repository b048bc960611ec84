//! A formula's text, cut into tokens.

use super::{Relation, SpanMap, foreign};
use crate::source::{Code, Diagnostic, Span};

/// The kind of a token.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Number,
    Name,
    Plus,
    Minus,
    Times,
    Over,
    Power,
    Open,
    Close,
    Comma,
    Relation(Relation),
    /// `=` or `==`, which no formula holds; a token of its own for the sake of its diagnostic.
    Equals,
    /// Nothing is left.
    End,
}

/// A token: its kind and the bytes of the text that it takes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Token {
    pub(super) kind: Kind,
    pub(super) start: usize,
    pub(super) end: usize,
}

/// Cuts a text into tokens, one at a time.
pub(super) struct Lexer<'a> {
    text: &'a str,
    spans: &'a SpanMap,
    at: usize,
}

impl<'a> Lexer<'a> {
    pub(super) fn new(text: &'a str, spans: &'a SpanMap) -> Self {
        // Without trailing white space the end is right behind the last token.
        Self { text: text.trim_end(), spans, at: 0 }
    }

    pub(super) fn text(&self, token: Token) -> &'a str {
        &self.text[token.start..token.end]
    }

    pub(super) fn span(&self, token: Token) -> Span {
        self.spans.span(token.start, token.end)
    }

    /// The next token; at the end of the text, `End` again and again.
    pub(super) fn next(&mut self) -> Result<Token, Diagnostic> {
        let rest = &self.text[self.at..];
        let blank = rest.len() - rest.trim_start_matches([' ', '\t', '\r', '\n']).len();
        let start = self.at + blank;
        let rest = &self.text[start..];
        let (kind, length) = match rest.as_bytes() {
            [] => (Kind::End, 0),
            [b'0'..=b'9', ..] | [b'.', b'0'..=b'9', ..] => (Kind::Number, number(rest)),
            [b'a'..=b'z' | b'A'..=b'Z' | b'_', ..] => (Kind::Name, word(rest)),
            [b'*', b'*', ..] => (Kind::Power, 2),
            [b'<', b'=', ..] => (Kind::Relation(Relation::LessOrEqual), 2),
            [b'>', b'=', ..] => (Kind::Relation(Relation::GreaterOrEqual), 2),
            [b'!', b'=', ..] => (Kind::Relation(Relation::NotEqual), 2),
            [b'=', b'=', ..] => (Kind::Equals, 2),
            [b'+', ..] => (Kind::Plus, 1),
            [b'-', ..] => (Kind::Minus, 1),
            [b'*', ..] => (Kind::Times, 1),
            [b'/', ..] => (Kind::Over, 1),
            [b'^', ..] => (Kind::Power, 1),
            [b'(', ..] => (Kind::Open, 1),
            [b')', ..] => (Kind::Close, 1),
            [b',', ..] => (Kind::Comma, 1),
            [b'<', ..] => (Kind::Relation(Relation::Less), 1),
            [b'>', ..] => (Kind::Relation(Relation::Greater), 1),
            [b'=', ..] => (Kind::Equals, 1),
            _ => return Err(self.stranger(start)),
        };
        self.at = start + length;
        Ok(Token { kind, start, end: self.at })
    }

    /// The text that is not read yet.
    pub(super) fn rest(&self) -> &'a str {
        &self.text[self.at..]
    }

    /// A character that no formula has.
    fn stranger(&self, start: usize) -> Diagnostic {
        let character = self.text[start..].chars().next().unwrap_or_default();
        let span = self.spans.span(start, start + character.len_utf8());
        let message = format!("formulas cannot contain the character `{}`", character.escape_debug());
        let diagnostic = Diagnostic::error(Code::UnexpectedCharacter, span, message);
        match foreign::character(&self.text[..start], &self.text[start..]).or_else(|| substitute(character)) {
            Some(help) => diagnostic.help(help),
            None => diagnostic.help("formulas have names, numbers, + - * / ^ and parentheses"),
        }
    }
}

/// Length of the number at the start of `text`.
fn number(text: &str) -> usize {
    let bytes = text.as_bytes();
    let digits = |from: usize| from + bytes[from..].iter().take_while(|b| b.is_ascii_digit()).count();
    let mut end = digits(0);
    if bytes.get(end) == Some(&b'.') {
        end = digits(end + 1);
    }
    if let Some(b'e' | b'E') = bytes.get(end) {
        let sign = usize::from(matches!(bytes.get(end + 1), Some(b'+' | b'-')));
        let power = digits((end + 1 + sign).min(bytes.len()));
        // Without digits it is no exponent: `2e` is 2 and the name e, and says so.
        if power > end + 1 + sign {
            end = power;
        }
    }
    end
}

/// Length of the name at the start of `text`.
fn word(text: &str) -> usize {
    text.bytes().take_while(|byte| byte.is_ascii_alphanumeric() || *byte == b'_').count()
}

/// A replacement for a character that people and their editors use.
fn substitute(character: char) -> Option<String> {
    let other = match character {
        '−' | '–' | '—' | '‐' | '‑' => "-",
        '·' | '×' | '⋅' | '∗' | '•' => "*",
        '÷' | '∕' | '⁄' => "/",
        '¹' => "^1",
        '²' => "^2",
        '³' => "^3",
        '≤' => "<=",
        '≥' => ">=",
        '≠' => "!=",
        '√' => "sqrt()",
        '[' | '{' | '（' => "(",
        ']' | '}' | '）' => ")",
        '\u{a0}' | '\u{2009}' | '\u{202f}' => return Some("write an ordinary space".to_owned()),
        '\'' | '′' | '’' => return Some("write the rate of a state under f_x or f_y".to_owned()),
        '.' => return Some("a point belongs to a number, as in 0.5".to_owned()),
        _ => greek(character)?,
    };
    Some(format!("write `{other}`"))
}

/// The name of a Greek letter.
pub(crate) fn greek(character: char) -> Option<&'static str> {
    const NAMES: [&str; 25] = [
        "alpha", "beta", "gamma", "delta", "epsilon", "zeta", "eta", "theta", "iota", "kappa", "lambda", "mu", "nu",
        "xi", "omicron", "pi", "rho", "sigma", "sigma", "tau", "upsilon", "phi", "chi", "psi", "omega",
    ];
    const CAPITALS: [&str; 25] = [
        "Alpha", "Beta", "Gamma", "Delta", "Epsilon", "Zeta", "Eta", "Theta", "Iota", "Kappa", "Lambda", "Mu", "Nu",
        "Xi", "Omicron", "Pi", "Rho", "", "Sigma", "Tau", "Upsilon", "Phi", "Chi", "Psi", "Omega",
    ];
    let row = |first: char| (character as usize).checked_sub(first as usize);
    let name = match character {
        'α'..='ω' => NAMES[row('α')?],
        'Α'..='Ω' => CAPITALS[row('Α')?],
        'ϕ' => "phi",
        'ϑ' => "theta",
        'ϵ' => "epsilon",
        'µ' => "mu",
        _ => return None,
    };
    Some(name)
}

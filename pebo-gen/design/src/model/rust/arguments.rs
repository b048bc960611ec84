//! The attribute's own arguments.
//!
//! ```text
//! #[pebo_model(reference = "..", assume(L > 0, 0 < d < 1), angles(q = 2.0 * PI / N_P), units(L = "H"))]
//! ```

use proc_macro2::{Spacing, TokenStream, TokenTree};
use quote::ToTokens as _;
use syn::parse::Parser as _;
use syn::punctuated::Punctuated;
use syn::{Expr, Lit, Meta, MetaList, MetaNameValue, Token};

use super::refusal::unsupported;
use super::spans::TokenSpans;
use crate::model::choice::Choice;
use crate::model::formula::Relation;
use crate::model::spanned::{Entry, Spanned};
use crate::model::written::{CascadeClass, RegressionForm};
use crate::source::{Code, Diagnostic, Diagnostics, Span, listed, nearest, quoted};

/// The keys of an attribute.
const KEYS: [&str; 8] = ["title", "reference", "class", "regression", "assume", "known", "angles", "units"];

const KNOWN: &str = "known(p = 0.0)";
const ANGLES: &str = "angles(q = 2.0 * PI)";
const UNITS: &str = "units(L = \"H\", i = \"A\")";

/// The arguments of an attribute.
#[derive(Default)]
pub(super) struct Arguments {
    pub(super) title: Option<Spanned<String>>,
    pub(super) reference: Option<Spanned<String>>,
    pub(super) class: Option<Spanned<CascadeClass>>,
    pub(super) regression: Option<Spanned<RegressionForm>>,
    pub(super) assume: Vec<Chain>,
    pub(super) known: Vec<MetaNameValue>,
    pub(super) angles: Vec<MetaNameValue>,
    pub(super) units: Vec<Entry<Spanned<String>>>,
}

/// Sides with relations between them.
pub(super) struct Chain {
    pub(super) span: Span,
    pub(super) first: Expr,
    pub(super) rest: Vec<(Relation, Expr)>,
}

impl Arguments {
    pub(super) fn read(tokens: TokenStream, spans: &mut TokenSpans, diagnostics: &mut Diagnostics) -> Self {
        let mut arguments = Self::default();
        let metas = match Punctuated::<Meta, Token![,]>::parse_terminated.parse2(tokens) {
            Ok(metas) => metas,
            Err(error) => {
                let place = spans.at(error.span());
                let message = format!("the attribute could not be read: {error}");
                diagnostics.push(
                    unsupported(place, message)
                        .help("write for example #[pebo_model(reference = \"..\", assume(L > 0, 0 < d < 1))]"),
                );
                return arguments;
            }
        };
        for meta in &metas {
            if let Err(diagnostic) = arguments.meta(meta, spans, diagnostics) {
                diagnostics.push(diagnostic);
            }
        }
        arguments
    }

    fn meta(&mut self, meta: &Meta, spans: &mut TokenSpans, diagnostics: &mut Diagnostics) -> Result<(), Diagnostic> {
        let name = TokenSpans::path(meta.path());
        match (name.as_str(), meta) {
            ("title", Meta::NameValue(pair)) => self.title = Some(text(pair, spans)?),
            ("reference", Meta::NameValue(pair)) => self.reference = Some(text(pair, spans)?),
            ("class", Meta::NameValue(pair)) => {
                self.class = Some(choice(&text(pair, spans)?)?);
            }
            ("regression", Meta::NameValue(pair)) => {
                self.regression = Some(choice(&text(pair, spans)?)?);
            }
            ("assume", Meta::List(list)) => {
                for part in split(list.tokens.clone(), is_comma) {
                    let chain = chain(part, spans);
                    self.assume.extend(diagnostics.keep(chain));
                }
            }
            ("known", Meta::List(list)) => {
                self.known.extend(pairs(list, "a state needs its value at the start", KNOWN, spans)?);
            }
            ("angles", Meta::List(list)) => {
                self.angles.extend(pairs(list, "an angle needs a period", ANGLES, spans)?);
            }
            ("units", Meta::List(list)) => {
                for pair in pairs(list, "a quantity needs its unit", UNITS, spans)? {
                    let name = Spanned { value: TokenSpans::path(&pair.path), span: spans.of(&pair.path) };
                    self.units.push(Entry { name, value: text(&pair, spans)? });
                }
            }
            ("title" | "reference" | "class" | "regression", _) => {
                return Err(unsupported(spans.of(meta), format!("`{name}` takes a text"))
                    .help(format!("write `{name} = \"..\"`")));
            }
            ("assume" | "known" | "angles" | "units", _) => {
                let example = match name.as_str() {
                    "assume" => "assume(L > 0)",
                    "known" => KNOWN,
                    "angles" => ANGLES,
                    _ => UNITS,
                };
                return Err(unsupported(spans.of(meta), format!("`{name}` takes a list in parentheses"))
                    .help(format!("write for example `{example}`")));
            }
            _ => {
                let diagnostic = Diagnostic::error(
                    Code::UnknownKey,
                    spans.of(meta.path()),
                    format!("the attribute has no argument `{name}`"),
                );
                return Err(match nearest(&name, KEYS) {
                    Some(near) => diagnostic.suggest(Some(near)),
                    None => diagnostic.help(format!("its arguments are {}", listed(KEYS))),
                });
            }
        }
        Ok(())
    }
}

/// A list of names with a value for each.
fn pairs(
    list: &MetaList,
    wrong: &str,
    example: &str,
    spans: &mut TokenSpans,
) -> Result<Vec<MetaNameValue>, Diagnostic> {
    let pairs = list.parse_args_with(Punctuated::<MetaNameValue, Token![,]>::parse_terminated);
    let pairs = pairs
        .map_err(|error| unsupported(spans.at(error.span()), wrong).help(format!("write for example `{example}`")))?;
    Ok(pairs.into_iter().collect())
}

fn text(pair: &MetaNameValue, spans: &mut TokenSpans) -> Result<Spanned<String>, Diagnostic> {
    match &pair.value {
        Expr::Lit(syn::ExprLit { lit: Lit::Str(text), .. }) => {
            Ok(Spanned { value: text.value(), span: spans.of(text) })
        }
        other => Err(unsupported(spans.of(other), "this is not a text").help("write it in quotes")),
    }
}

fn choice<T: Choice>(name: &Spanned<String>) -> Result<Spanned<T>, Diagnostic> {
    let Some(value) = T::of_word(&name.value) else {
        let message = format!("{} is none of the choices", quoted(&name.value));
        return Err(Diagnostic::error(Code::WrongChoice, name.span, message)
            .help(format!("write one of {}", listed(T::WORDS.iter().copied()))));
    };
    Ok(Spanned { value, span: name.span })
}

/// `a < b < c`, which as Rust would not be one expression.
fn chain(tokens: TokenStream, spans: &mut TokenSpans) -> Result<Chain, Diagnostic> {
    let whole = spans.of(&tokens);
    let mut relations = Vec::new();
    let mut sides = vec![TokenStream::new()];
    let mut tokens = tokens.into_iter().peekable();
    while let Some(token) = tokens.next() {
        let relation = match &token {
            TokenTree::Punct(punct) => {
                let equals = punct.spacing() == Spacing::Joint
                    && matches!(tokens.peek(), Some(TokenTree::Punct(next)) if next.as_char() == '=');
                match (punct.as_char(), equals) {
                    ('<', true) => Some(Relation::LessOrEqual),
                    ('>', true) => Some(Relation::GreaterOrEqual),
                    ('!', true) => Some(Relation::NotEqual),
                    ('<', false) => Some(Relation::Less),
                    ('>', false) => Some(Relation::Greater),
                    ('=', _) => {
                        return Err(Diagnostic::error(
                            Code::ComparisonExpected,
                            spans.of(&token),
                            "an assumption is not an equation",
                        )
                        .help("put what is zero by physics into a function `identities`"));
                    }
                    _ => None,
                }
            }
            _ => None,
        };
        match (relation, sides.last_mut()) {
            (Some(relation), _) => {
                if matches!(relation, Relation::LessOrEqual | Relation::GreaterOrEqual | Relation::NotEqual) {
                    tokens.next();
                }
                relations.push(relation);
                sides.push(TokenStream::new());
            }
            (None, Some(side)) => token.to_tokens(side),
            (None, None) => {}
        }
    }
    let mut sides = sides.into_iter().map(|side| operand(side, whole, spans));
    let Some(first) = sides.next().transpose()? else { return Err(no_comparison(whole, spans)) };
    let rest: Vec<Expr> = sides.collect::<Result<_, _>>()?;
    if rest.is_empty() {
        return Err(no_comparison(whole, spans));
    }
    Ok(Chain { span: whole, first, rest: relations.into_iter().zip(rest).collect() })
}

fn no_comparison(whole: Span, spans: &TokenSpans) -> Diagnostic {
    Diagnostic::error(Code::ComparisonExpected, whole, "an assumption needs a comparison, and this has none")
        .help(format!("write for example `{} > 0`", spans.text(whole)))
}

fn operand(tokens: TokenStream, whole: Span, spans: &mut TokenSpans) -> Result<Expr, Diagnostic> {
    if tokens.is_empty() {
        return Err(Diagnostic::error(Code::EmptyFormula, whole, "a side of this comparison is missing")
            .help("write for example `0 < d < 1`"));
    }
    syn::parse2(tokens).map_err(|error| {
        unsupported(spans.at(error.span()), format!("this is not an expression: {error}"))
            .help("write the sides of an assumption as in Rust")
    })
}

fn is_comma(token: &TokenTree) -> bool {
    matches!(token, TokenTree::Punct(punct) if punct.as_char() == ',')
}

/// The runs of tokens between separators; an empty one at the end is none.
fn split(tokens: TokenStream, separates: impl Fn(&TokenTree) -> bool) -> Vec<TokenStream> {
    let mut parts = vec![TokenStream::new()];
    for token in tokens {
        if separates(&token) {
            parts.push(TokenStream::new());
        } else if let Some(part) = parts.last_mut() {
            token.to_tokens(part);
        }
    }
    parts.retain(|part| !part.is_empty());
    parts
}

//! Tokens to formulas, by precedence climbing.

use std::sync::Arc;

use super::bounds::SizedFormula;
use super::lexer::{Kind, Lexer, Token};
use super::state::{Estimates, Parser, Permitted};
use super::sum::sum;
use super::{Comparison, DEPTH_LIMIT, Decimal, Formula, LENGTH_LIMIT, Operator, SpanMap, Table, Term, complaints};
use crate::source::{Code, Diagnostic, Span};
use pebo_cas::Function;

/// Reads `text` as one formula.
pub fn parse_formula<'a>(
    text: &'a str,
    spans: &'a SpanMap,
    permitted: impl Into<Permitted<'a>>,
) -> Result<Formula, Diagnostic> {
    let mut parser = Parser::new(text, spans, permitted.into())?;
    let formula = parser.expression(SUM)?.formula;
    match parser.next.kind {
        Kind::End => Ok(formula),
        Kind::Relation(_) => {
            Err(parser.unexpected("a formula cannot contain a comparison").help("comparisons belong under `assume`"))
        }
        _ => Err(parser.trailing()),
    }
}

/// Reads `text` as a chain of comparisons.
pub fn parse_comparison(text: &str, spans: &SpanMap, tables: &[Arc<Table>]) -> Result<Comparison, Diagnostic> {
    let mut parser = Parser::new(text, spans, Permitted { estimates: Estimates::Refused, tables })?;
    let first = parser.expression(SUM)?.formula;
    let mut rest = Vec::new();
    while let Kind::Relation(relation) = parser.next.kind {
        parser.advance()?;
        rest.push((relation, parser.expression(SUM)?.formula));
    }
    if parser.next.kind != Kind::End {
        return Err(parser.trailing());
    }
    let span = rest.last().map_or(first.span, |(_, last)| first.span.to(last.span));
    if rest.is_empty() {
        let message = "an assumption needs a comparison, and this has none".to_owned();
        return Err(Diagnostic::error(Code::ComparisonExpected, span, message)
            .help(format!("write for example `{} > 0`", text.trim())));
    }
    Ok(Comparison { span, first, rest })
}

/// Levels of precedence; a higher one binds tighter.
const SUM: u8 = 1;
const PRODUCT: u8 = 2;
const SIGN: u8 = 3;
const POWER: u8 = 4;

impl<'a> Parser<'a> {
    fn new(text: &'a str, spans: &'a SpanMap, permitted: Permitted<'a>) -> Result<Self, Diagnostic> {
        if text.len() > LENGTH_LIMIT {
            let message = format!("the formula has {} bytes", text.len());
            return Err(Diagnostic::error(Code::FormulaTooLarge, spans.whole(), message)
                .help(format!("name parts of it under `define`; the limit is {LENGTH_LIMIT}")));
        }
        let mut lexer = Lexer::new(text, spans);
        let next = lexer.next()?;
        if next.kind == Kind::End {
            let message = "a formula is missing".to_owned();
            return Err(Diagnostic::error(Code::EmptyFormula, spans.whole(), message).help("write 0 for zero"));
        }
        Ok(Self { lexer, permitted, next, last: next, depth: 0 })
    }

    fn advance(&mut self) -> Result<Token, Diagnostic> {
        self.last = self.next;
        self.next = self.lexer.next()?;
        Ok(self.last)
    }

    /// An expression whose operators bind at least as tight as `least`.
    fn expression(&mut self, least: u8) -> Result<SizedFormula, Diagnostic> {
        self.depth += 1;
        if self.depth > DEPTH_LIMIT {
            return Err(self.too_deep());
        }
        let mut left = self.operand()?;
        let mut terms = Vec::new();
        while let Some((operator, level)) = operator(self.next.kind)
            && level >= least
        {
            self.advance()?;
            // Powers group to the right: 2^3^2 is 2^(3^2). All others group to the left.
            let right = self.expression(if level == POWER { POWER } else { level + 1 })?;
            if level == SUM {
                terms.push((operator, right));
                continue;
            }
            let span = left.formula.span.to(right.formula.span);
            left = SizedFormula::binary(operator, left, right, span)?;
        }
        self.depth -= 1;
        sum(left, terms)
    }

    fn operand(&mut self) -> Result<SizedFormula, Diagnostic> {
        match self.next.kind {
            Kind::Number => self.number(),
            Kind::Name => self.name(),
            Kind::Minus => self.negative(),
            Kind::Open => self.group(),
            _ => Err(self.misplaced()),
        }
    }

    fn negative(&mut self) -> Result<SizedFormula, Diagnostic> {
        let sign = self.advance()?;
        let operand = self.expression(SIGN)?;
        let span = self.lexer.span(sign).to(operand.formula.span);
        SizedFormula::negative(operand, span)
    }

    fn group(&mut self) -> Result<SizedFormula, Diagnostic> {
        let open = self.advance()?;
        let mut inner = self.expression(SUM)?;
        inner.formula.span = self.close(open)?;
        Ok(inner)
    }

    fn number(&mut self) -> Result<SizedFormula, Diagnostic> {
        let token = self.advance()?;
        let span = self.lexer.span(token);
        let number = Decimal::parse(self.lexer.text(token), span)?;
        Ok(SizedFormula::leaf(Formula { span, term: Term::Number(number) }))
    }

    fn name(&mut self) -> Result<SizedFormula, Diagnostic> {
        let token = self.advance()?;
        let (span, name) = (self.lexer.span(token), self.lexer.text(token));
        if self.next.kind != Kind::Open {
            return Ok(SizedFormula::leaf(Formula { span, term: Term::Name(name.to_owned()) }));
        }
        if name == "hat" {
            return self.estimate(span);
        }
        let table = || self.permitted.tables.iter().find_map(|table| Some((Arc::clone(table), table.order(name)?)));
        match (Function::named(name), table()) {
            (Some(function), _) => self.call(function, span),
            (None, Some(table)) => self.table(table, span),
            (None, None) => Err(complaints::unknown_function(name, span, self.lexer.rest())),
        }
    }

    /// `hat(x)`, from the parenthesis on.
    fn estimate(&mut self, hat: Span) -> Result<SizedFormula, Diagnostic> {
        if self.permitted.estimates == Estimates::Refused {
            return Err(complaints::no_estimate(hat));
        }
        let open = self.advance()?;
        if self.next.kind != Kind::Name {
            return Err(self.unexpected("hat() takes a state").help("write hat(x), with a state x"));
        }
        let name = self.advance()?;
        let span = hat.to(self.close(open)?);
        let term = Term::Estimate(self.lexer.text(name).to_owned());
        Ok(SizedFormula::leaf(Formula { span, term }))
    }

    /// A call, from the parenthesis on.
    fn call(&mut self, function: Function, name: Span) -> Result<SizedFormula, Diagnostic> {
        let open = self.advance()?;
        let mut arguments = Vec::new();
        if self.next.kind != Kind::Close {
            loop {
                arguments.push(self.expression(SUM)?);
                if self.next.kind != Kind::Comma {
                    break;
                }
                self.advance()?;
            }
        }
        let span = name.to(self.close(open)?);
        if arguments.len() != function.row().arity {
            return Err(complaints::argument_count(function, arguments.len(), span));
        }
        SizedFormula::call(function, arguments, span)
    }

    /// A table or its slope, from the parenthesis on.
    fn table(&mut self, table: (Arc<Table>, usize), name: Span) -> Result<SizedFormula, Diagnostic> {
        let open = self.advance()?;
        let argument = self.expression(SUM)?;
        let span = name.to(self.close(open)?);
        SizedFormula::table(table, argument, span)
    }

    /// Reads the parenthesis that closes `open`; returns the span of the whole.
    fn close(&mut self, open: Token) -> Result<Span, Diagnostic> {
        match self.next.kind {
            Kind::Close => {
                let close = self.advance()?;
                Ok(self.lexer.span(open).to(self.lexer.span(close)))
            }
            _ => Err(self.unclosed(open)),
        }
    }
}

fn operator(kind: Kind) -> Option<(Operator, u8)> {
    Some(match kind {
        Kind::Plus => (Operator::Add, SUM),
        Kind::Minus => (Operator::Subtract, SUM),
        Kind::Times => (Operator::Multiply, PRODUCT),
        Kind::Over => (Operator::Divide, PRODUCT),
        Kind::Power => (Operator::Power, POWER),
        _ => return None,
    })
}

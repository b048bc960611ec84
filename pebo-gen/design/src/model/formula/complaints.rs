//! The parser's diagnostics for a text that is no formula.

use super::lexer::{Kind, Token};
use super::state::Parser;
use super::{DEPTH_LIMIT, foreign};
use crate::source::{Code, Diagnostic, Span, listed, nearest, quoted};
use pebo_cas::Function;

impl Parser<'_> {
    /// A missing operand.
    pub(super) fn misplaced(&self) -> Diagnostic {
        match self.next.kind {
            Kind::Plus => self.unexpected("a plus sign needs a left side").help("remove the plus sign"),
            Kind::End => self
                .unexpected("the formula ends where an operand is missing")
                .help("write what follows the operator, or remove the operator"),
            _ => {
                let found = quoted(self.lexer.text(self.next));
                self.unexpected(&format!("{found} stands where an operand is missing"))
                    .help("write a name, a number or a parenthesis here")
            }
        }
    }

    /// A missing parenthesis that closes `open`.
    pub(super) fn unclosed(&self, open: Token) -> Diagnostic {
        match self.next.kind {
            Kind::End => {
                let message = "this parenthesis is not closed";
                Diagnostic::error(Code::UnclosedParenthesis, self.lexer.span(open), message)
                    .help("close it; a formula with a comma needs quotes inside { } or [ ]")
            }
            Kind::Relation(_) => self
                .unexpected("a comparison stands inside parentheses")
                .help("compare whole formulas, and only under `assume`"),
            _ => self.trailing(),
        }
    }

    /// The next operand would be one level too deep.
    pub(super) fn too_deep(&self) -> Diagnostic {
        let message = format!("the formula has more than {DEPTH_LIMIT} levels");
        Diagnostic::error(Code::FormulaTooDeep, self.lexer.span(self.next), message)
            .label("too deep from here on")
            .help("name parts of it under `define`")
    }

    /// The formula could end here, and goes on.
    pub(super) fn trailing(&self) -> Diagnostic {
        match self.next.kind {
            Kind::Number | Kind::Name | Kind::Open => {
                let (left, right) = (self.lexer.text(self.last), self.lexer.text(self.next));
                let span = self.lexer.span(self.last).to(self.lexer.span(self.next));
                if let Some(help) = foreign::operator(right) {
                    return self.unexpected(&format!("{} is no operator of formulas", quoted(right))).help(help);
                }
                let message = "an operator is missing between two factors".to_owned();
                Diagnostic::error(Code::ImplicitMultiplication, span, message)
                    .help(format!("write `{left}*{right}` for a product"))
            }
            Kind::Close => self.unexpected("this parenthesis closes nothing").help("remove it, or open one before"),
            Kind::Comma => self
                .unexpected("a comma separates the arguments of a call, and there is no call here")
                .help("write decimals with a point"),
            Kind::Equals => self
                .unexpected("a formula is not an equation")
                .help("put what is zero by physics under `identities`, inequalities under `assume`"),
            _ => self.unexpected("the formula goes on in an unexpected way").help("end the formula before this"),
        }
    }

    pub(super) fn unexpected(&self, message: &str) -> Diagnostic {
        Diagnostic::error(Code::UnexpectedToken, self.lexer.span(self.next), message)
    }
}

/// An estimate where there is none.
pub(super) fn no_estimate(hat: Span) -> Diagnostic {
    Diagnostic::error(Code::MisplacedEstimate, hat, "hat() has no meaning in this place")
        .help("use hat() in the control law and panels of a simulation only")
}

/// A call with the wrong number of arguments.
pub(super) fn argument_count(function: Function, found: usize, span: Span) -> Diagnostic {
    let (name, wanted) = (function.row().name, function.row().arity);
    let found = if found == 0 { "none".to_owned() } else { found.to_string() };
    Diagnostic::error(Code::ArgumentCount, span, format!("`{name}` takes {wanted} and has {found}"))
        .help(format!("write `{name}({})`", if wanted == 1 { "a" } else { "a, b" }))
}

/// A call of something that is no function; `argument` is the text after the parenthesis.
pub(super) fn unknown_function(name: &str, span: Span, argument: &str) -> Diagnostic {
    let message = format!("{} is not a function", quoted(name));
    let diagnostic = Diagnostic::error(Code::UnknownFunction, span, message);
    let timed = argument.trim_start().strip_prefix('t').is_some_and(|rest| {
        rest.trim_start().starts_with([')', '-', '+', ',']) && !rest.starts_with(|c: char| c.is_ascii_alphanumeric())
    });
    if let Some(help) = foreign::call(name, timed) {
        return diagnostic.help(help);
    }
    match nearest(name, Function::names()) {
        Some(near) => diagnostic.suggest(Some(near)),
        None => diagnostic.help(format!("write `{name}*(` for a product")),
    }
    .note("a name before a parenthesis is a call")
    .note(format!("the functions are {}", listed(Function::names())))
}

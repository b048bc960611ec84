//! A program as Rust statements and expressions.
//!
//! In: a program, and the tokens of its inputs. Out: `let` statements, and an expression for each
//! output. A value that is used once is written where it is used, unless the line would become too long.

use std::collections::BTreeMap;

use proc_macro2::{Ident, Literal, Span, TokenStream};
use quote::quote;

use super::literal::literal;
use super::names::{LONGEST, Names};
use super::table::Tables;
use pebo_cas::{Function, Rational};
use pebo_design::program::{Constant, Operand, Operation, Program};

/// The precedence of the outermost operation of an expression.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
enum Binding {
    Sum,
    Product,
    Sign,
    Atom,
}

/// An expression with its precedence and label.
#[derive(Clone, Debug)]
pub(super) struct Piece {
    pub(super) tokens: TokenStream,
    binding: Binding,
    /// The number of characters it takes.
    pub(super) width: usize,
    /// A telling name for a value that holds it, if there is one.
    label: Option<String>,
}

impl Piece {
    /// A path or a literal: something that never needs parentheses.
    pub(super) fn atom(tokens: TokenStream, width: usize, label: Option<String>) -> Self {
        Self { tokens, binding: Binding::Atom, width, label }
    }

    /// A local variable.
    pub(super) fn local(name: &str) -> Self {
        let ident = ident(name);
        Self::atom(quote!(#ident), name.len(), Some(name.to_owned()))
    }

    fn within(self, least: Binding) -> Self {
        if self.binding >= least {
            return self;
        }
        let tokens = self.tokens;
        Self { tokens: quote!((#tokens)), width: self.width + 2, ..self }
    }
}

/// Statements and results of one function.
#[derive(Clone, Debug, Default)]
pub(super) struct Body {
    pub(super) statements: Vec<TokenStream>,
    pub(super) outputs: Vec<Piece>,
    /// The variables that the statements bind.
    pub(super) variables: Vec<String>,
}

/// An expression that takes more characters is split.
const WIDEST: usize = 60;

/// Renders a program; `numbers` renders a number that has no literal.
pub(super) fn render(
    program: &Program,
    inputs: &[Piece],
    numbers: &mut impl FnMut(&Rational) -> Piece,
    tables: &Tables,
    names: &mut Names,
) -> Body {
    let constants = program
        .constants
        .iter()
        .map(|constant| match constant {
            Constant::Pi => Piece::atom(quote!(PI), 2, Some("pi".to_owned())),
            Constant::Number(value) => number(value, numbers),
        })
        .collect();
    let (results, statements, variables) = (Vec::new(), Vec::new(), Vec::new());
    let pairs = BTreeMap::new();
    let tables = program.tables.iter().map(|table| (table.order, tables.name(table).to_owned())).collect();
    let mut renderer = Renderer { inputs, constants, tables, results, pairs, statements, variables, names };
    let uses = program.uses();
    for (index, (operation, uses)) in program.operations.iter().zip(uses).enumerate() {
        let other = operation.companion().and_then(|other| program.operations.iter().position(|found| *found == other));
        if let Some(other) = other {
            let pair = if other < index { renderer.pairs.get(&other).cloned() } else { None };
            let piece = pair.unwrap_or_else(|| renderer.sine_and_cosine(*operation, index));
            renderer.results.push(piece);
            continue;
        }
        let piece = renderer.operation(*operation);
        let piece = if uses > 1 { renderer.bind(piece) } else { piece };
        renderer.results.push(piece);
    }
    let outputs = program.outputs.iter().map(|&output| renderer.operand(output)).collect();
    Body { statements: renderer.statements, outputs, variables: renderer.variables }
}

/// A number as a literal, or by its constant.
pub(super) fn number(value: &Rational, numbers: &mut impl FnMut(&Rational) -> Piece) -> Piece {
    let magnitude = value.abs();
    let piece = match literal(&magnitude) {
        Some(text) => {
            let literal = syn::LitFloat::new(&text, Span::call_site());
            let label = magnitude.is_one().then(|| "one".to_owned());
            Piece::atom(quote!(#literal), text.len(), label)
        }
        None => numbers(&magnitude),
    };
    if value.is_negative() { negative(piece) } else { piece }
}

/// An identifier of a name that [`Names`] gave.
pub(super) fn ident(name: &str) -> Ident {
    Ident::new(name, Span::call_site())
}

fn negative(piece: Piece) -> Piece {
    // `-(a * b)`, although `-a * b` has the same value: a reader should not have to know.
    let inner = piece.within(Binding::Atom);
    let tokens = inner.tokens;
    Piece { tokens: quote!(-#tokens), binding: Binding::Sign, width: inner.width + 1, label: None }
}

struct Renderer<'a> {
    inputs: &'a [Piece],
    constants: Vec<Piece>,
    /// The order of the derivative, and the constant.
    tables: Vec<(usize, String)>,
    results: Vec<Piece>,
    /// For a sine or cosine whose companion is needed too: the companion, from the same call.
    pairs: BTreeMap<usize, Piece>,
    statements: Vec<TokenStream>,
    variables: Vec<String>,
    names: &'a mut Names,
}

impl Renderer<'_> {
    fn operand(&self, operand: Operand) -> Piece {
        match operand {
            Operand::Input(index) => self.inputs[index].clone(),
            Operand::Constant(index) => self.constants[index].clone(),
            Operand::Result(index) => self.results[index].clone(),
        }
    }

    fn operation(&mut self, operation: Operation) -> Piece {
        match operation {
            Operation::Neg(a) => {
                let [a] = self.fitting([a], 3);
                negative(a)
            }
            Operation::Add(a, b) => {
                let [a, b] = self.fitting([a, b], 5);
                let (a, b) = (a.within(Binding::Sum), b.within(Binding::Product));
                binary(Binding::Sum, a, b, |a, b| quote!(#a + #b), None)
            }
            Operation::Sub(a, b) => {
                let label = self.label(a).zip(self.label(b)).map(|(a, b)| format!("{a}_minus_{b}"));
                let [a, b] = self.fitting([a, b], 5);
                let (a, b) = (a.within(Binding::Sum), b.within(Binding::Product));
                binary(Binding::Sum, a, b, |a, b| quote!(#a - #b), label)
            }
            Operation::Mul(a, b) => {
                let square = a == b;
                let label = self.label(a).filter(|_| square).map(|a| format!("{a}_squared"));
                let [a, b] = self.fitting([a, b], 7);
                let (a, b) = (a.within(Binding::Product), b.within(Binding::Sign));
                binary(Binding::Product, a, b, |a, b| quote!(#a * #b), label)
            }
            Operation::Div(a, b) => {
                let reciprocal = self.label(a).is_some_and(|a| a == "one");
                let label = self.label(b).filter(|_| reciprocal).map(|b| format!("inv_{b}"));
                let [a, b] = self.fitting([a, b], 7);
                let (a, b) = (a.within(Binding::Product), b.within(Binding::Sign));
                binary(Binding::Product, a, b, |a, b| quote!(#a / #b), label)
            }
            Operation::Power(a, b) => {
                let [a, b] = self.fitting([a, b], 14);
                call("powf", &[a, b], None)
            }
            Operation::ExpM1(a) => {
                let label = self.label(a).map(|a| format!("exp_m1_{a}"));
                let [a] = self.fitting([a], 14);
                call("exp_m1", &[a], label)
            }
            Operation::Ln1P(a) => {
                let label = self.label(a).map(|a| format!("ln_1p_{a}"));
                let [a] = self.fitting([a], 13);
                call("ln_1p", &[a], label)
            }
            Operation::Unary(function, a) => {
                let name = function.row().rust;
                let label = self.label(a).map(|a| format!("{name}_{a}"));
                let [a] = self.fitting([a], 8 + name.len());
                call(name, &[a], label)
            }
            Operation::Binary(function, a, b) => {
                let name = function.row().rust;
                let [a, b] = self.fitting([a, b], 10 + name.len());
                call(name, &[a, b], None)
            }
            Operation::Table(table, a) => self.table(table, a),
        }
    }

    /// A table, or a derivative of it, at an argument.
    fn table(&mut self, table: usize, argument: Operand) -> Piece {
        let (order, name) = self.tables[table].clone();
        let [argument] = self.fitting([argument], ".derivative(2, )".len() + name.len());
        let (constant, inner) = (ident(&name), &argument.tokens);
        let order_literal = Literal::usize_unsuffixed(order);
        let (tokens, width) = match order {
            0 => (quote!(#constant.value(#inner)), ".value()".len()),
            1 => (quote!(#constant.slope(#inner)), ".slope()".len()),
            _ => (quote!(#constant.derivative(#order_literal, #inner)), ".derivative(2, )".len()),
        };
        Piece::atom(tokens, width + name.len() + argument.width, None)
    }

    /// A sine or cosine whose companion is needed too: both from one call. Keeps the companion for its turn.
    fn sine_and_cosine(&mut self, operation: Operation, index: usize) -> Piece {
        let Operation::Unary(function, angle) = operation else {
            unreachable!("only sine and cosine have a companion");
        };
        let label = self.label(angle);
        let [angle] = self.fitting([angle], "Real::sin_cos()".len());
        let names = ["sin", "cos"].map(|name| {
            let wanted = label.as_ref().map(|label| format!("{name}_{label}")).filter(|wanted| wanted.len() <= LONGEST);
            match wanted {
                Some(wanted) => self.names.claim(&wanted),
                None => self.names.number(&format!("{name}_")),
            }
        });
        self.variables.extend(names.iter().cloned());
        let [sine, cosine] = names.each_ref().map(|name| ident(name));
        let angle = angle.tokens;
        self.statements.push(quote!(let (#sine, #cosine) = Real::sin_cos(#angle);));
        let [sine, cosine] = names.each_ref().map(|name| Piece::local(name));
        let (own, companion) = if function == Function::Sin { (sine, cosine) } else { (cosine, sine) };
        self.pairs.insert(index, companion);
        own
    }

    fn label(&self, operand: Operand) -> Option<String> {
        self.operand(operand).label
    }

    /// The operands, the widest in variables of their own until the whole fits.
    fn fitting<const N: usize>(&mut self, operands: [Operand; N], around: usize) -> [Piece; N] {
        let mut pieces = operands.map(|operand| self.operand(operand));
        while around + pieces.iter().map(|piece| piece.width).sum::<usize>() > WIDEST {
            let splittable = pieces.iter_mut().filter(|piece| piece.binding != Binding::Atom || is_call(piece));
            let Some(widest) = splittable.max_by_key(|piece| piece.width) else {
                break;
            };
            *widest = self.bind(widest.clone());
        }
        pieces
    }

    /// A variable that holds the value.
    fn bind(&mut self, piece: Piece) -> Piece {
        let wanted = piece.label.filter(|label| label.len() <= LONGEST);
        let name = match wanted {
            Some(label) => self.names.claim(&label),
            None => self.names.number("t"),
        };
        self.variables.push(name.clone());
        let (variable, value) = (ident(&name), piece.tokens);
        self.statements.push(quote!(let #variable = #value;));
        Piece::local(&name)
    }
}

fn binary(
    binding: Binding,
    a: Piece,
    b: Piece,
    join: impl FnOnce(TokenStream, TokenStream) -> TokenStream,
    label: Option<String>,
) -> Piece {
    let width = a.width + b.width + 3;
    Piece { tokens: join(a.tokens, b.tokens), binding, width, label }
}

/// A call of the runtime's scalar functions, by path: no method of `f64` is needed, and none is hidden.
fn call(name: &str, arguments: &[Piece], label: Option<String>) -> Piece {
    let function = ident(name);
    let tokens = arguments.iter().map(|argument| &argument.tokens);
    let inner: usize = arguments.iter().map(|argument| argument.width + 2).sum();
    Piece::atom(quote!(Real::#function(#(#tokens),*)), "Real::".len() + name.len() + inner, label)
}

/// The atom is a call, which a variable can hold.
fn is_call(piece: &Piece) -> bool {
    piece.tokens.clone().into_iter().any(|tree| matches!(tree, proc_macro2::TokenTree::Group(_)))
}

/// The program calls a function of the runtime's scalar.
pub(super) fn calls(program: &Program) -> bool {
    program.operations.iter().any(|operation| {
        use Operation::{Binary, ExpM1, Ln1P, Power, Unary};
        matches!(operation, Power(..) | ExpM1(..) | Ln1P(..) | Unary(..) | Binary(..))
    })
}

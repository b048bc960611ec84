//! `Parameters::check`: whether given values are those that the proofs are about.
//!
//! In: the derivation's conditions on the parameters. Out: a function that compares each parameter with zero, and
//! expressions in several. The way back: the comparisons of such a function, read from tokens.

use proc_macro2::TokenStream;
use quote::quote;
use syn::{BinOp, Expr as Syntax};

use super::{Module, Scope, numbers, permission};
use crate::emit::error::EmitError;
use crate::emit::expression::{Piece, ident};
use crate::emit::read_back::value::{self, Value, expression, unreadable};
use pebo_cas::{Arena, Domain, Expr, Node, Relation};
use pebo_design::analysis::Sign;
use pebo_design::program::{GuardedProgram, Program, StagedPrograms};

/// A condition on values: one is finite, one compares so with zero, or both.
#[derive(Clone, Copy, PartialEq, Eq, Default, Debug)]
pub(in crate::emit) struct Condition {
    pub(in crate::emit) finite: Option<Expr>,
    pub(in crate::emit) compared: Option<(Expr, Comparison)>,
}

/// A comparison with zero.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(in crate::emit) enum Comparison {
    Greater,
    GreaterOrEqual,
    Less,
    LessOrEqual,
    Unequal,
    Equal,
}

impl Condition {
    /// The condition that an expression has the sign.
    pub(in crate::emit) fn of(arena: &Arena, (expr, sign): (Expr, Sign)) -> Self {
        let compared = match sign {
            Sign::Any => None,
            Sign::Zero => Some(Comparison::Equal),
            Sign::Is(Relation::Positive) => Some(Comparison::Greater),
            Sign::Is(Relation::NonNegative) => Some(Comparison::GreaterOrEqual),
            Sign::Opposite(Relation::Positive) => Some(Comparison::Less),
            Sign::Opposite(Relation::NonNegative) => Some(Comparison::LessOrEqual),
            Sign::Is(Relation::NonZero) | Sign::Opposite(Relation::NonZero) => Some(Comparison::Unequal),
        };
        // A value equal to zero is finite; so is each parameter of a formula that is checked after them.
        let alone = matches!(arena.node(expr), Node::Symbol(_)) && sign != Sign::Zero;
        Self { finite: alone.then_some(expr), compared: compared.map(|comparison| (expr, comparison)) }
    }
}

/// The conditions on the parameters, with those of the divisors, roots and logarithms of the code as they are computed.
pub(in crate::emit) fn with_guards(
    arena: &Arena,
    mut asked: Vec<(Expr, Sign)>,
    checked: &Program,
    staged: &StagedPrograms,
) -> (Vec<(Expr, Sign)>, Program) {
    let mut domain = Domain::default();
    for (expr, sign) in &asked {
        match *sign {
            Sign::Is(relation) => domain.facts.assume(*expr, relation),
            Sign::Opposite(relation) => domain.facts.assume(arena.neg(*expr), relation),
            Sign::Any | Sign::Zero => {}
        }
    }
    let relations: Vec<Option<Relation>> = asked
        .iter()
        .map(|(_, sign)| match *sign {
            Sign::Is(relation) => Some(relation),
            Sign::Opposite(Relation::Positive | Relation::NonZero) => Some(Relation::NonZero),
            Sign::Opposite(Relation::NonNegative) | Sign::Any | Sign::Zero => None,
        })
        .collect();
    let GuardedProgram { program, guards } = staged.guarded(arena, checked, &relations);
    asked.extend(guards.into_iter().map(|(expr, relation)| {
        let sign = match relation {
            Relation::NonZero if domain.implies(arena, expr, Relation::Positive) => Sign::Is(Relation::Positive),
            Relation::NonZero if domain.implies(arena, arena.neg(expr), Relation::Positive) => {
                Sign::Opposite(Relation::Positive)
            }
            relation => Sign::Is(relation),
        };
        (expr, sign)
    }));
    (asked, program)
}

impl Module<'_> {
    /// The function, for a model that has parameters.
    pub(in crate::emit) fn check(&self, scope: &mut Scope) -> TokenStream {
        let arena = &self.plant.arena;
        let read = self.plant.parameters.iter().map(|parameter| {
            let name = &scope.locals[&parameter.symbol];
            let field = ident(name);
            Piece::atom(quote!(self.#field), "self.".len() + name.len(), None)
        });
        let inputs: Vec<Piece> = read.collect();
        let body = scope.render(&self.checked, &inputs);
        let rows = self.asked.iter().zip(&body.outputs).map(|(asked, output)| {
            let value = &output.tokens;
            let condition = Condition::of(arena, *asked);
            let finite = condition.finite.map(|_| quote!(#value.is_finite()));
            let compared = condition.compared.map(|(_, comparison)| match comparison {
                Comparison::Greater => quote!(#value > 0.0),
                Comparison::GreaterOrEqual => quote!(#value >= 0.0),
                Comparison::Less => quote!(#value < 0.0),
                Comparison::LessOrEqual => quote!(#value <= 0.0),
                Comparison::Unequal => quote!(#value != 0.0),
                Comparison::Equal => quote!(#value == 0.0),
            });
            match (finite, compared) {
                (Some(finite), Some(compared)) => quote!(#finite && #compared),
                (finite, compared) => quote!(#finite #compared),
            }
        });
        let rows: Vec<TokenStream> = rows.collect();
        let statements = &body.statements;
        let precision = permission::for_numbers(self.scalar, numbers(&self.checked));
        quote! {
            #precision
            impl Parameters {
                /// Accepts finite values with the signs and inequalities that the proofs assume.
                ///
                /// # Errors
                /// `Fault::Parameter` with the place of the first condition that does not hold.
                pub fn check(&self) -> Result<(), Fault> {
                    #(#statements)*
                    Fault::of_parameters([#(#rows),*])
                }
            }
        }
    }
}

/// The comparisons of a function with this last expression.
pub(in crate::emit) fn read(arena: &Arena, last: &Syntax, scope: &value::Scope) -> Result<Vec<Condition>, EmitError> {
    let unknown = || unreadable(last);
    let Syntax::Call(call) = last else { return Err(unknown()) };
    let [Syntax::Array(conditions)] = call.args.iter().collect::<Vec<_>>()[..] else { return Err(unknown()) };
    let Syntax::Path(function) = &*call.func else { return Err(unknown()) };
    let path: Vec<String> = function.path.segments.iter().map(|segment| segment.ident.to_string()).collect();
    if path != ["Fault", "of_parameters"] {
        return Err(unknown());
    }
    conditions.elems.iter().map(|condition| self::condition(arena, condition, scope)).collect()
}

fn condition(arena: &Arena, syntax: &Syntax, scope: &value::Scope) -> Result<Condition, EmitError> {
    let unknown = || unreadable(syntax);
    let scalar = |inner: &Syntax| match expression(arena, inner, scope)? {
        Value::Scalar(value) => Ok(value),
        _ => Err(unknown()),
    };
    match syntax {
        Syntax::MethodCall(call) if call.method == "is_finite" && call.args.is_empty() => {
            Ok(Condition { finite: Some(scalar(&call.receiver)?), compared: None })
        }
        Syntax::Binary(both) if matches!(both.op, BinOp::And(_)) => {
            match (condition(arena, &both.left, scope)?, condition(arena, &both.right, scope)?) {
                (Condition { finite, compared: None }, Condition { finite: None, compared }) => {
                    Ok(Condition { finite, compared })
                }
                _ => Err(unknown()),
            }
        }
        Syntax::Binary(binary) if arena.is_zero(scalar(&binary.right)?) => {
            let comparison = match binary.op {
                BinOp::Gt(_) => Comparison::Greater,
                BinOp::Ge(_) => Comparison::GreaterOrEqual,
                BinOp::Lt(_) => Comparison::Less,
                BinOp::Le(_) => Comparison::LessOrEqual,
                BinOp::Ne(_) => Comparison::Unequal,
                BinOp::Eq(_) => Comparison::Equal,
                _ => return Err(unknown()),
            };
            Ok(Condition { finite: None, compared: Some((scalar(&binary.left)?, comparison)) })
        }
        _ => Err(unknown()),
    }
}

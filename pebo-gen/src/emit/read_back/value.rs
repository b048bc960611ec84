//! Emitted expressions, interpreted as algebra: syntax and the values of names in, a value out.
//!
//! A literal is the rational that its digits spell. Only the forms that the emitter uses are known.

use std::collections::BTreeMap;

use quote::ToTokens;
use syn::{BinOp, Expr as Syntax, Lit, Member, Pat, PatSlice, PatTuple, UnOp};

use crate::emit::error::EmitError;
use crate::emit::literal::read;
use pebo_cas::graph::function::pieces::Pieces;
use pebo_cas::{Arena, Expr, Function};
use syn::punctuated::Punctuated;
use syn::token::Comma;

/// The value of an emitted expression.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::emit) enum Value {
    Scalar(Expr),
    List(Vec<Value>),
    /// By columns; a vector has one.
    Matrix(Vec<Vec<Expr>>),
    /// Named numbers: parameters, stored constants.
    Fields(BTreeMap<String, Expr>),
    /// The results of the methods of an extension, and the fields of the result of a function of `Model`.
    Parts(BTreeMap<String, Vec<Vec<Expr>>>),
    /// A table of the model.
    Table(Pieces),
}

impl Value {
    /// The columns of a matrix.
    pub(in crate::emit) fn columns(self) -> Option<Vec<Vec<Expr>>> {
        match self {
            Self::Matrix(columns) => Some(columns),
            _ => None,
        }
    }

    fn scalar(&self) -> Option<Expr> {
        match self {
            Self::Scalar(value) => Some(*value),
            _ => None,
        }
    }

    fn list(columns: Vec<Vec<Expr>>) -> Self {
        let column = |column: Vec<Expr>| Self::List(column.into_iter().map(Self::Scalar).collect());
        Self::List(columns.into_iter().map(column).collect())
    }

    fn column(&self) -> Option<Vec<Expr>> {
        match self {
            Self::List(entries) => entries.iter().map(Self::scalar).collect(),
            _ => None,
        }
    }
}

/// The names that are known at a point of the code.
#[derive(Clone, Debug, Default)]
pub(in crate::emit) struct Scope {
    values: BTreeMap<String, Value>,
    /// The methods of `self`: the arguments that they were read with, and their results.
    methods: BTreeMap<String, (Vec<Value>, Value)>,
}

impl Scope {
    /// A name for a value; it hides an earlier one.
    pub(in crate::emit) fn declare(&mut self, name: &str, value: Value) {
        self.values.insert(name.to_owned(), value);
    }

    /// A method of `self`, with its arguments and its result.
    pub(in crate::emit) fn declare_method(&mut self, name: &str, arguments: Vec<Value>, value: Value) {
        self.methods.insert(name.to_owned(), (arguments, value));
    }

    /// The names of a `use` that are values.
    pub(in crate::emit) fn import(&mut self, arena: &Arena, item: &str) {
        let path: String = item.split_whitespace().collect();
        if ["usecore::f64::consts::PI;", "usecore::f32::consts::PI;"].contains(&path.as_str()) {
            self.declare("PI", Value::Scalar(arena.pi()));
        }
    }

    /// The names of a pattern, for the value that it takes apart.
    pub(in crate::emit) fn bind(&mut self, pattern: &Pat, value: Value) -> Result<(), EmitError> {
        match (pattern, value) {
            (Pat::Wild(_), _) => Ok(()),
            (Pat::Ident(ident), value)
                if ident.by_ref.is_none() && ident.mutability.is_none() && ident.subpat.is_none() =>
            {
                self.declare(&ident.ident.to_string(), value);
                Ok(())
            }
            (Pat::Slice(PatSlice { elems, .. }) | Pat::Tuple(PatTuple { elems, .. }), Value::List(entries))
                if elems.len() == entries.len() =>
            {
                elems.iter().zip(entries).try_for_each(|(pattern, entry)| self.bind(pattern, entry))
            }
            _ => Err(unreadable(pattern)),
        }
    }
}

/// Code that has no known meaning.
pub(in crate::emit) fn unreadable(code: &impl ToTokens) -> EmitError {
    EmitError::Unreadable { code: code.to_token_stream().to_string() }
}

/// The value of an expression.
pub(in crate::emit) fn expression(arena: &Arena, syntax: &Syntax, scope: &Scope) -> Result<Value, EmitError> {
    let unknown = || unreadable(syntax);
    let scalar = |inner: &Syntax| {
        let value = expression(arena, inner, scope)?;
        value.scalar().ok_or_else(|| unreadable(inner))
    };
    Ok(match syntax {
        Syntax::Paren(inner) => expression(arena, &inner.expr, scope)?,
        Syntax::Group(inner) => expression(arena, &inner.expr, scope)?,
        Syntax::Lit(literal) => match &literal.lit {
            Lit::Float(number) if number.suffix().is_empty() => {
                let value = read(number.base10_digits()).ok_or_else(unknown)?;
                Value::Scalar(arena.number(value))
            }
            _ => return Err(unknown()),
        },
        Syntax::Path(path) => {
            let name = path.path.get_ident().ok_or_else(unknown)?.to_string();
            match scope.values.get(&name) {
                Some(value) => value.clone(),
                // A model without constants.
                None if name == "Self" => Value::Fields(BTreeMap::new()),
                None => return Err(unknown()),
            }
        }
        Syntax::Unary(unary) => match unary.op {
            UnOp::Neg(_) => Value::Scalar(arena.neg(scalar(&unary.expr)?)),
            UnOp::Deref(_) => expression(arena, &unary.expr, scope)?,
            _ => return Err(unknown()),
        },
        Syntax::Binary(binary) => {
            let (a, b) = (scalar(&binary.left)?, scalar(&binary.right)?);
            Value::Scalar(match binary.op {
                BinOp::Add(_) => arena.add(a, b),
                BinOp::Sub(_) => arena.sub(a, b),
                BinOp::Mul(_) => arena.mul(a, b),
                BinOp::Div(_) => arena.div(a, b),
                _ => return Err(unknown()),
            })
        }
        Syntax::Field(field) => {
            let base = match (&*field.base, &field.member) {
                // The storage of a matrix: `y.data.0`.
                (Syntax::Field(inner), Member::Unnamed(index))
                    if index.index == 0 && is_named(&inner.member, "data") =>
                {
                    let columns = expression(arena, &inner.base, scope)?.columns();
                    return columns.map(Value::list).ok_or_else(unknown);
                }
                (base, _) => expression(arena, base, scope)?,
            };
            match (base, &field.member) {
                (Value::Fields(fields), Member::Named(name)) => {
                    Value::Scalar(*fields.get(&name.to_string()).ok_or_else(unknown)?)
                }
                (Value::Parts(mut parts), Member::Named(name)) => {
                    Value::Matrix(parts.remove(&name.to_string()).ok_or_else(unknown)?)
                }
                _ => return Err(unknown()),
            }
        }
        Syntax::Reference(reference) if reference.mutability.is_none() => expression(arena, &reference.expr, scope)?,
        Syntax::MethodCall(call) => method(arena, call, scope)?,
        Syntax::Array(array) => {
            let entries = array.elems.iter().map(|entry| expression(arena, entry, scope));
            Value::List(entries.collect::<Result<_, _>>()?)
        }
        Syntax::Struct(structure) if structure.rest.is_none() => {
            let (mut fields, mut parts) = (BTreeMap::new(), BTreeMap::new());
            for field in &structure.fields {
                let Member::Named(name) = &field.member else {
                    return Err(unknown());
                };
                match expression(arena, &field.expr, scope)? {
                    Value::Scalar(value) => drop(fields.insert(name.to_string(), value)),
                    Value::Matrix(columns) => drop(parts.insert(name.to_string(), columns)),
                    _ => return Err(unknown()),
                }
            }
            match (parts.is_empty(), fields.is_empty()) {
                (true, _) => Value::Fields(fields),
                (false, true) => Value::Parts(parts),
                (false, false) => return Err(unknown()),
            }
        }
        Syntax::Call(call) => function(arena, call, scope)?,
        _ => return Err(unknown()),
    })
}

/// A call of a method: of `self`, of an extension, or of a matrix.
fn method(arena: &Arena, call: &syn::ExprMethodCall, scope: &Scope) -> Result<Value, EmitError> {
    let unknown = || unreadable(call);
    let arguments = call.args.iter().map(|argument| expression(arena, argument, scope));
    let arguments: Vec<Result<Value, EmitError>> = arguments.collect();
    let name = call.method.to_string();
    if let Value::Table(table) = expression(arena, &call.receiver, scope).unwrap_or(Value::List(Vec::new())) {
        return called(arena, (&name, table), &call.args, &arguments).ok_or_else(unknown);
    }
    let arguments: Vec<Value> = arguments.into_iter().collect::<Result<_, _>>()?;
    if let (Syntax::Path(receiver), Some((read_with, value))) = (&*call.receiver, scope.methods.get(&name))
        && receiver.path.is_ident("self")
    {
        return if arguments == *read_with { Ok(value.clone()) } else { Err(unknown()) };
    }
    match (name.as_str(), expression(arena, &call.receiver, scope)?) {
        _ if !arguments.is_empty() => Err(unknown()),
        // A structure of signals, a vector and an array of the same entries.
        ("into", Value::Matrix(columns)) => Ok(Value::Matrix(columns)),
        ("transpose", Value::Matrix(columns)) => Ok(Value::Matrix(transposed(&columns))),
        (name, Value::Parts(mut parts)) => parts.remove(name).map(Value::Matrix).ok_or_else(unknown),
        _ => Err(unknown()),
    }
}

/// A table or one of its derivatives at an argument.
fn called(
    arena: &Arena,
    (name, table): (&str, Pieces),
    written: &Punctuated<Syntax, Comma>,
    arguments: &[Result<Value, EmitError>],
) -> Option<Value> {
    let order = match (name, written.first()) {
        ("value", _) => 0,
        ("slope", _) => 1,
        ("derivative", Some(Syntax::Lit(literal))) => match &literal.lit {
            Lit::Int(order) => order.base10_parse().ok()?,
            _ => return None,
        },
        _ => return None,
    };
    let expected = if name == "derivative" { 2 } else { 1 };
    let argument = arguments.last()?.as_ref().ok()?.scalar()?;
    (arguments.len() == expected).then(|| Value::Scalar(Pieces { order, ..table }.call(arena, argument)))
}

/// The rows of a matrix that is given by columns.
pub(in crate::emit) fn transposed(columns: &[Vec<Expr>]) -> Vec<Vec<Expr>> {
    let rows = columns.first().map_or(0, Vec::len);
    (0..rows).map(|row| columns.iter().filter_map(|column| column.get(row).copied()).collect()).collect()
}

/// A call of the runtime's scalar functions, or of a constructor.
fn function(arena: &Arena, call: &syn::ExprCall, scope: &Scope) -> Result<Value, EmitError> {
    let unknown = || unreadable(call);
    let Syntax::Path(path) = &*call.func else {
        return Err(unknown());
    };
    let segments: Vec<String> = path.path.segments.iter().map(|segment| segment.ident.to_string()).collect();
    if let ([name], [argument]) = (segments.as_slice(), call.args.iter().collect::<Vec<_>>().as_slice())
        && name == "Some"
    {
        return expression(arena, argument, scope);
    }
    let [owner, name] = segments.as_slice() else {
        return Err(unknown());
    };
    let arguments: Vec<Value> =
        call.args.iter().map(|argument| expression(arena, argument, scope)).collect::<Result<_, _>>()?;
    if name == "from" {
        return match (owner.as_str(), arguments.as_slice()) {
            ("SVector" | "Self", [column]) => Ok(Value::Matrix(vec![column.column().ok_or_else(unknown)?])),
            ("SMatrix", [Value::List(columns)]) => {
                let columns: Option<Vec<Vec<Expr>>> = columns.iter().map(Value::column).collect();
                columns.map(Value::Matrix).ok_or_else(unknown)
            }
            _ => Err(unknown()),
        };
    }
    if let ("Integrator", "new", [Value::Matrix(start)]) = (owner.as_str(), name.as_str(), arguments.as_slice()) {
        return Ok(Value::Parts(BTreeMap::from([("chi".to_owned(), start.clone())])));
    }
    if (owner.as_str(), name.as_str(), arguments.len()) == ("SMatrix", "zeros", 0) {
        // No columns: an absent value.
        return Ok(Value::Matrix(Vec::new()));
    }
    let scalars: Option<Vec<Expr>> = arguments.iter().map(Value::scalar).collect();
    let scalars = scalars.ok_or_else(unknown)?;
    match (owner.as_str(), name.as_str(), scalars.as_slice()) {
        ("Real", "powf", [base, exponent]) => {
            let exponent = arena.as_number(*exponent).ok_or_else(unknown)?;
            Ok(Value::Scalar(arena.power(*base, &exponent)))
        }
        ("Real", "sin_cos", &[angle]) => {
            let both = [Function::Sin, Function::Cos].map(|function| Value::Scalar(arena.call(function, &[angle])));
            Ok(Value::List(both.to_vec()))
        }
        ("Real", "exp_m1", &[argument]) => {
            let power = arena.call(Function::Exp, &[argument]);
            Ok(Value::Scalar(arena.sub(power, arena.one())))
        }
        ("Real", "ln_1p", &[argument]) => {
            let sum = arena.add(arena.one(), argument);
            Ok(Value::Scalar(arena.call(Function::Log, &[sum])))
        }
        ("Real", name, arguments) => {
            let row = Function::table()
                .iter()
                .find(|row| row.rust == name && row.arity == arguments.len())
                .ok_or_else(unknown)?;
            Ok(Value::Scalar(arena.call(row.function, arguments)))
        }
        _ => Err(unknown()),
    }
}

fn is_named(member: &Member, name: &str) -> bool {
    matches!(member, Member::Named(ident) if ident == name)
}

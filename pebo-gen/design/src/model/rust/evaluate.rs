//! Expressions of Rust, run with names for numbers.

use std::collections::HashSet;

use syn::ext::IdentExt as _;
use syn::{BinOp, Expr, ExprStruct, ItemFn, Member, Path, UnOp};

use super::functions;
use super::items::{self, Items};
use super::refusal::{self, unsupported};
use super::spans::TokenSpans;
use super::value::{Field, Locals, Value};
use crate::model::formula::{Decimal, Formula, Operator, PI, SizedFormula, Term};
use crate::model::names::unknown_name;
use crate::model::spanned::Spanned;
use crate::source::{Code, Diagnostic, Diagnostics, Span};

/// Most calls of helper functions inside one another.
const CALL_LIMIT: usize = 32;

/// Most expressions that are evaluated, and parts that are copied, for one module.
const WORK_LIMIT: usize = 1 << 20;

/// Longest array that is written as a repetition.
const REPEAT_LIMIT: usize = 64;

/// Runs the functions of a module.
pub(super) struct Reader<'a> {
    pub(super) items: &'a Items<'a>,
    pub(super) spans: &'a mut TokenSpans,
    pub(super) diagnostics: &'a mut Diagnostics,
    /// Constants of the module that are names of their own.
    pub(super) constants: HashSet<String>,
    /// True if integers are numbers, as they are in attributes but not in Rust.
    pub(super) integers: bool,
    calls: usize,
    work: usize,
}

impl<'a> Reader<'a> {
    pub(super) fn new(items: &'a Items<'a>, spans: &'a mut TokenSpans, diagnostics: &'a mut Diagnostics) -> Self {
        Self { items, spans, diagnostics, constants: HashSet::new(), integers: false, calls: 0, work: 0 }
    }

    /// The value of an expression.
    pub(super) fn value(&mut self, expr: &Expr, locals: &mut Locals) -> Result<Value, Diagnostic> {
        self.spend(1, expr)?;
        match expr {
            Expr::Lit(_) => self.literal(expr),
            Expr::Path(path) if path.qself.is_none() => self.name(&path.path, locals),
            Expr::Group(inner) => self.value(&inner.expr, locals),
            Expr::Paren(inner) => {
                let mut value = self.value(&inner.expr, locals)?;
                if let Value::Number(number) = &mut value {
                    number.formula.span = self.spans.of(expr);
                }
                Ok(value)
            }
            Expr::Reference(inner) => match &inner.mutability {
                None => self.value(&inner.expr, locals),
                Some(mutable) => Err(refusal::mutable(mutable, self.spans)),
            },
            Expr::Unary(unary) => match unary.op {
                UnOp::Deref(_) => self.value(&unary.expr, locals),
                UnOp::Neg(_) => {
                    let operand = self.number(&unary.expr, locals)?;
                    let span = self.spans.of(expr);
                    SizedFormula::negative(operand, span).map(Value::Number)
                }
                _ => Err(unsupported(self.spans.of(&unary.op), "`!` is not an operator of formulas")
                    .help("use + - * / and `.powi(n)`")),
            },
            Expr::Binary(binary) => {
                let operator = self.operator(&binary.op)?;
                let (left, right) = (self.number(&binary.left, locals)?, self.number(&binary.right, locals)?);
                self.binary(operator, left, right, expr).map(Value::Number)
            }
            Expr::Call(call) => functions::call(self, call, locals),
            Expr::MethodCall(call) => functions::method(self, call, locals),
            Expr::Field(access) => self.field(access, locals),
            Expr::Index(access) => self.index(access, locals),
            Expr::Struct(shape) => self.record(shape, locals),
            Expr::Array(array) => Ok(Value::List(array.elems.iter().map(|item| self.element(item, locals)).collect())),
            Expr::Tuple(tuple) => Ok(Value::List(tuple.elems.iter().map(|item| self.element(item, locals)).collect())),
            Expr::Repeat(repeat) => {
                let value = self.value(&repeat.expr, locals)?;
                let length = self.items.whole(&repeat.len).and_then(|length| length.parse::<usize>().ok());
                let Some(length) = length.filter(|length| (1..=REPEAT_LIMIT).contains(length)) else {
                    return Err(unsupported(self.spans.of(&repeat.len), "the length of this array is not known here")
                        .help("write the components out one by one"));
                };
                self.spend(length.saturating_mul(value.size()), expr)?;
                Ok(Value::List(vec![value; length]))
            }
            Expr::Block(block) if block.label.is_none() => self.block(&block.block, locals),
            Expr::Cast(cast) if self.items.is_float(&cast.ty) => self.converted(&cast.expr, locals),
            other => Err(refusal::expression(other, self.spans)),
        }
    }

    /// A value that is a number.
    pub(super) fn number(&mut self, expr: &Expr, locals: &mut Locals) -> Result<SizedFormula, Diagnostic> {
        match self.value(expr, locals)? {
            Value::Number(number) => Ok(number),
            other => Err(unsupported(self.spans.of(expr), format!("this is {}, not a number", other.kind()))
                .help("use its fields or components one by one")),
        }
    }

    /// A component of a result. If it has no meaning, its diagnostic is out and it is 0 from there on, so that the
    /// other components are read as well.
    fn element(&mut self, expr: &Expr, locals: &mut Locals) -> Value {
        let value = self.value(expr, locals);
        self.diagnostics.keep(value).unwrap_or_else(|| {
            let span = self.spans.of(expr);
            Value::Number(SizedFormula::leaf(Formula { span, term: Term::Number(Decimal::zero()) }))
        })
    }

    /// A number that may be written as an integer: the operand of a conversion to a float.
    pub(super) fn converted(&mut self, expr: &Expr, locals: &mut Locals) -> Result<Value, Diagnostic> {
        let local = matches!(expr, Expr::Path(path) if path.path.get_ident().is_some_and(|name| {
            locals.iter().any(|(local, _)| name.unraw() == local)
        }));
        match self.items.whole(expr) {
            Some(text) if !local => self.whole(&text, expr).map(Value::Number),
            _ => self.value(expr, locals),
        }
    }

    /// A whole number where Rust means one.
    pub(super) fn whole(&mut self, text: &str, expr: &Expr) -> Result<SizedFormula, Diagnostic> {
        let span = self.spans.of(expr);
        let digits = Decimal::parse(text.trim_start_matches('-'), span)?;
        let number = SizedFormula::leaf(Formula { span, term: Term::Number(digits) });
        if text.starts_with('-') { SizedFormula::negative(number, span) } else { Ok(number) }
    }

    pub(super) fn binary(
        &mut self,
        operator: Operator,
        left: SizedFormula,
        right: SizedFormula,
        whole: &Expr,
    ) -> Result<SizedFormula, Diagnostic> {
        let span = self.spans.of(whole);
        SizedFormula::binary(operator, left, right, span)
    }

    /// Runs a function of the module.
    pub(super) fn run(&mut self, item: &'a ItemFn, arguments: Vec<Value>, call: Span) -> Result<Value, Diagnostic> {
        items::unconditional(&item.attrs, self.spans)?;
        if self.calls >= CALL_LIMIT {
            let message = format!("functions call one another more than {CALL_LIMIT} deep");
            return Err(unsupported(call, message).help("write a function that does not call itself"));
        }
        if item.sig.inputs.len() != arguments.len() {
            let (name, wanted, found) = (&item.sig.ident, item.sig.inputs.len(), arguments.len());
            return Err(Diagnostic::error(
                Code::ArgumentCount,
                call,
                format!("`{name}` takes {wanted} and has {found}"),
            )
            .help("give each argument that the function declares"));
        }
        let mut locals = Locals::new();
        for (input, argument) in item.sig.inputs.iter().zip(arguments) {
            match input {
                syn::FnArg::Typed(typed) => self.bind(&typed.pat, argument, &mut locals)?,
                syn::FnArg::Receiver(receiver) => {
                    return Err(unsupported(self.spans.of(receiver), "a function of the module has no `self`")
                        .help("give what it needs as an argument"));
                }
            }
        }
        self.calls += 1;
        let value = self.block(&item.block, &mut locals);
        self.calls -= 1;
        value
    }

    fn operator(&mut self, op: &BinOp) -> Result<Operator, Diagnostic> {
        Ok(match op {
            BinOp::Add(_) => Operator::Add,
            BinOp::Sub(_) => Operator::Subtract,
            BinOp::Mul(_) => Operator::Multiply,
            BinOp::Div(_) => Operator::Divide,
            other => return Err(refusal::operator(other, self.spans)),
        })
    }

    fn literal(&mut self, expr: &Expr) -> Result<Value, Diagnostic> {
        let Some(text) = items::literal(expr) else { return Err(refusal::expression(expr, self.spans)) };
        let whole = matches!(expr, Expr::Lit(syn::ExprLit { lit: syn::Lit::Int(number), .. })
            if !matches!(number.suffix(), "f64" | "f32"));
        if whole && !self.integers {
            return Err(refusal::integer(expr, self.spans));
        }
        let span = self.spans.of(expr);
        let number = Decimal::parse(&text, span)?;
        Ok(Value::Number(SizedFormula::leaf(Formula { span, term: Term::Number(number) })))
    }

    /// A name: a local one, a constant of the module, or one of the mathematical constants.
    fn name(&mut self, path: &Path, locals: &Locals) -> Result<Value, Diagnostic> {
        let place = self.spans.of(path);
        let Some(last) = path.segments.last() else { return Err(unsupported(place, "a name is missing")) };
        let name = last.ident.unraw().to_string();
        if path.segments.len() == 1
            && let Some((_, value)) = locals.iter().rev().find(|(local, _)| *local == name)
        {
            let mut value = value.clone();
            self.spend(value.size(), path)?;
            // A declared name is used here; a name of `let` was computed at its definition.
            if let Value::Number(number) = &mut value
                && matches!(number.formula.term, Term::Name(_))
            {
                number.formula.span = place;
            }
            return Ok(value);
        }
        let own = path.segments.len() == 1 || (path.segments.len() == 2 && path.segments[0].ident == "self");
        if own && self.constants.contains(&name) {
            return Ok(Value::name(&name, place));
        }
        // In the attribute nothing needs to be imported; but a single letter is a quantity that was forgotten.
        let known = |name: &String| self.integers && name != "E";
        let imported = self.items.imports.constant(path).or_else(|| Some(name.clone()).filter(known));
        if let Some(constant) = imported.as_deref().and_then(functions::mathematical) {
            if self.constants.contains(PI) {
                return Err(unsupported(place, "`pi` is a constant of the module as well").help("rename that constant"));
            }
            return constant(place).map(Value::Number);
        }
        if own && let Some(item) = self.items.constants.iter().find(|item| item.ident == name) {
            if matches!(items::bare(&item.expr), Expr::Array(_) | Expr::Tuple(_) | Expr::Repeat(_) | Expr::Reference(_))
            {
                return self.constant_list(item, path);
            }
            return Err(unsupported(place, format!("the constant `{name}` is not a floating-point number"))
                .help(format!("declare it as `const {}: f64`", item.ident)));
        }
        let mut known: Vec<&str> =
            locals.iter().map(|(local, _)| local.as_str()).chain(self.constants.iter().map(String::as_str)).collect();
        known.sort_unstable();
        let written = TokenSpans::path(path);
        let unknown = unknown_name(&written, place, known).label("not a signal, a `let` or a constant of this module");
        Err(match functions::mathematical(&name) {
            Some(_) => unknown.help(format!("write `core::f64::consts::{name}`, or `use` it inside of the module")),
            None => unknown,
        })
    }

    /// A constant with components, which have no name of their own in the model: their values are inserted at each use.
    fn constant_list(&mut self, item: &syn::ItemConst, path: &Path) -> Result<Value, Diagnostic> {
        items::unconditional(&item.attrs, self.spans)?;
        if self.calls >= CALL_LIMIT {
            return Err(unsupported(self.spans.of(path), "constants refer to one another in a circle")
                .help("give one of them its value"));
        }
        self.calls += 1;
        let value = self.value(&item.expr, &mut Locals::new());
        self.calls -= 1;
        value
    }

    fn field(&mut self, access: &syn::ExprField, locals: &mut Locals) -> Result<Value, Diagnostic> {
        let base = self.value(&access.base, locals)?;
        match (base, &access.member) {
            (Value::Record(fields), Member::Named(name)) => {
                let wanted = name.unraw().to_string();
                let place = self.spans.of(access);
                match fields.iter().find(|field| field.name.value == wanted) {
                    Some(field) => {
                        let mut value = field.value.clone();
                        if let Value::Number(number) = &mut value
                            && matches!(number.formula.term, Term::Name(_))
                        {
                            number.formula.span = place;
                        }
                        Ok(value)
                    }
                    None => Err(refusal::no_field(name, &fields, self.spans)),
                }
            }
            (Value::List(items), Member::Unnamed(index)) => self.component(items, index.index as usize, access),
            (other, _) => Err(unsupported(self.spans.of(access), format!("{} has no such field", other.kind()))
                .help("use a field of X, Y, U or W")),
        }
    }

    fn index(&mut self, access: &syn::ExprIndex, locals: &mut Locals) -> Result<Value, Diagnostic> {
        let base = self.value(&access.expr, locals)?;
        let Value::List(items) = base else {
            return Err(
                unsupported(self.spans.of(access), format!("{} has no components", base.kind())).help("use its fields")
            );
        };
        match self.items.whole(&access.index).and_then(|index| index.parse::<usize>().ok()) {
            Some(index) => self.component(items, index, access),
            None => Err(unsupported(self.spans.of(&access.index), "this index is not known here")
                .help("write a number, as in `z[0]`")),
        }
    }

    fn component(
        &mut self,
        items: Vec<Value>,
        index: usize,
        whole: &impl quote::ToTokens,
    ) -> Result<Value, Diagnostic> {
        let count = items.len();
        let place = self.spans.of(whole);
        items.into_iter().nth(index).ok_or_else(|| {
            unsupported(place, format!("there are {count} components, and this is number {}", index.saturating_add(1)))
                .help("components are counted from 0")
        })
    }

    fn record(&mut self, shape: &ExprStruct, locals: &mut Locals) -> Result<Value, Diagnostic> {
        let mut fields = Vec::new();
        for part in &shape.fields {
            let Member::Named(name) = &part.member else {
                return Err(unsupported(self.spans.of(part), "a field without a name").help("name it"));
            };
            let name = Spanned { value: name.unraw().to_string(), span: self.spans.of(name) };
            let value = self.element(&part.expr, locals);
            fields.push(Field { name, value });
        }
        if let Some(rest) = &shape.rest {
            match self.value(rest, locals)? {
                Value::Record(others) => {
                    let given = |field: &Field| fields.iter().any(|own| own.name.value == field.name.value);
                    let others: Vec<Field> = others.into_iter().filter(|field| !given(field)).collect();
                    fields.extend(others);
                }
                other => {
                    return Err(unsupported(self.spans.of(rest), format!("this is {}, not a struct", other.kind()))
                        .help("give the fields one by one"));
                }
            }
        }
        Ok(Value::Record(fields))
    }

    /// Counts work, since hostile input could need any amount.
    fn spend(&mut self, work: usize, tokens: &impl quote::ToTokens) -> Result<(), Diagnostic> {
        self.work = self.work.saturating_add(work);
        if self.work <= WORK_LIMIT {
            return Ok(());
        }
        Err(Diagnostic::error(Code::FormulaTooLarge, self.spans.of(tokens), "the functions take too many steps")
            .help("simplify them: a model needs some thousand operations"))
    }
}

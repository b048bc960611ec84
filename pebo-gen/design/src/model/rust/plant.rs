//! The module as a model: the meaning of each function.

use proc_macro2::TokenStream;
use syn::ext::IdentExt as _;
use syn::{Expr, ItemFn, ItemMod, Lit, Meta, Type};

use super::arguments::{Arguments, Chain};
use super::evaluate::Reader;
use super::items::{self, Items};
use super::refusal::unsupported;
use super::spans::TokenSpans;
use super::value::{Locals, Value};
use crate::model::formula::{Comparison, Decimal, Formula};
use crate::model::observer::Observer;
use crate::model::spanned::{Entry, Spanned};
use crate::model::written::Model;
use crate::source::{Code, Diagnostic, Diagnostics, Span};

/// Signals by the struct that declares them.
struct Signals {
    x: Vec<Spanned<String>>,
    y: Vec<Spanned<String>>,
    u: Vec<Spanned<String>>,
    w: Vec<Spanned<String>>,
}

impl Signals {
    /// The signals of a function's argument, by the name of its type.
    fn of(&self, name: &str) -> Option<&[Spanned<String>]> {
        match name {
            "X" => Some(&self.x),
            "Y" => Some(&self.y),
            "U" => Some(&self.u),
            "W" => Some(&self.w),
            _ => None,
        }
    }
}

/// Reads the model; nothing where one of its parts is missing.
pub(super) fn read(
    arguments: TokenStream,
    module: &ItemMod,
    spans: &mut TokenSpans,
    diagnostics: &mut Diagnostics,
) -> Option<Model> {
    // The first span is the default of a diagnostic.
    let name = Spanned { span: spans.of(&module.ident), value: module.ident.unraw().to_string() };
    if module.content.is_none() {
        diagnostics.push(
            unsupported(name.span, "the module is in another file, which the attribute cannot read")
                .help("write its items here in braces, or put the model into a file and name that"),
        );
        return None;
    }
    let arguments = Arguments::read(arguments, spans, diagnostics);
    let items = Items::of(module);
    let mut signals = |letter: &str, required: Option<&str>, spans: &mut TokenSpans| {
        if let Some(item) = items.structure(letter) {
            return items::fields(&items, item, spans, diagnostics);
        }
        if let Some(what) = required {
            let what = format!("the struct `{letter}`, the {what},");
            diagnostics.push(missing(name.span, &what, &format!("pub struct {letter} {{ pub a: f64 }}")));
        }
        Vec::new()
    };
    let signals = Signals {
        x: signals("X", Some("unmeasured states"), spans),
        y: signals("Y", Some("measured outputs"), spans),
        u: signals("U", None, spans),
        w: signals("W", None, spans),
    };
    // Functions of signals that are not known would only repeat it.
    if diagnostics.has_errors() {
        return None;
    }
    let mut pass = ModuleReader { reader: Reader::new(&items, spans, diagnostics), signals, module: name.span };
    let (parameters, define) = pass.constants();
    let f_x =
        pass.required("f_x", "pub fn f_x(x: &X, y: &Y, u: &U) -> X { X { .. } }").map(|item| pass.entries(item, 0));
    let f_y = pass.reader.items.function("f_y").map(|item| pass.entries(item, 0)).unwrap_or_default();
    let g_y = pass.reader.items.function("g_y").map(|item| pass.entries(item, 0)).unwrap_or_default();
    let phi = pass.reader.items.function("phi").map(|item| pass.list(item)).unwrap_or_default();
    let components = phi.len();
    let phi_left =
        pass.reader.items.function("phi_left").map(|item| pass.entries(item, components)).unwrap_or_default();
    let identities = pass.reader.items.function("identities").map(|item| pass.list(item)).unwrap_or_default();
    let (assume, [known, angles]) = pass.attribute(&arguments);
    let Signals { x, y, u, w } = pass.signals;
    let title = arguments.title.or_else(|| documented(module, spans));
    Some(Model {
        name,
        title,
        reference: arguments.reference,
        cascade_class: arguments.class,
        regression_form: arguments.regression,
        parameters,
        x,
        y,
        u,
        time: None,
        w,
        define,
        assume,
        class: None,
        f_x: f_x?,
        f_y,
        g_y,
        phi,
        phi_left,
        identities,
        known,
        angles,
        units: arguments.units,
        observer: Observer::default(),
        simulation: None,
        recording: None,
    })
}

struct ModuleReader<'a> {
    reader: Reader<'a>,
    signals: Signals,
    /// The module's name.
    module: Span,
}

type Parameters = Vec<Entry<Option<Spanned<Decimal>>>>;

impl<'a> ModuleReader<'a> {
    /// Constants that are decimals are parameters; computed ones are definitions.
    fn constants(&mut self) -> (Parameters, Vec<Entry<Formula>>) {
        let (mut parameters, mut computed) = (Vec::new(), Vec::new());
        // Rust's constants may use later ones.
        for item in self.reader.items.numbers() {
            if let Err(conditional) = items::unconditional(&item.attrs, self.reader.spans) {
                self.reader.diagnostics.push(conditional);
            }
            let name = Spanned { value: item.ident.unraw().to_string(), span: self.reader.spans.of(&item.ident) };
            let Some(text) = items::literal(&item.expr) else {
                computed.push((name, item));
                continue;
            };
            let span = self.reader.spans.of(&item.expr);
            self.reader.constants.insert(name.value.clone());
            let value = self.reader.diagnostics.keep(Decimal::parse(&text, span));
            parameters.push(Entry { name, value: value.map(|value| Spanned { value, span }) });
        }
        let mut define = Vec::new();
        while !computed.is_empty() {
            let ready = computed.iter().position(|(_, item)| {
                let waits = |(other, _): &(Spanned<String>, _)| mentions(&item.expr, &other.value);
                !computed.iter().any(waits)
            });
            // Constants that wait for one another in a circle are Rust's to refuse.
            let (name, item) = computed.remove(ready.unwrap_or(0));
            let value = self.reader.number(&item.expr, &mut Locals::new());
            if let Some(value) = self.reader.diagnostics.keep(value) {
                self.reader.constants.insert(name.value.clone());
                define.push(Entry { name, value: value.formula });
            }
        }
        (parameters, define)
    }

    fn required(&mut self, name: &str, example: &str) -> Option<&'a ItemFn> {
        let found = self.reader.items.function(name);
        if found.is_none() {
            self.reader.diagnostics.push(missing(self.module, &format!("the function `{name}`"), example));
        }
        found
    }

    /// Runs a function on the signals that its arguments are, and on `components` coordinates.
    fn run(&mut self, item: &'a ItemFn, components: usize) -> Option<Value> {
        let mut values = Vec::new();
        for input in &item.sig.inputs {
            let value = match input {
                syn::FnArg::Typed(typed) => self.argument(&typed.ty, components),
                syn::FnArg::Receiver(receiver) => {
                    Err(unsupported(self.reader.spans.of(receiver), "a function of the plant has no `self`")
                        .help("take the signals as arguments: `x: &X, y: &Y, u: &U`"))
                }
            };
            values.push(self.reader.diagnostics.keep(value)?);
        }
        let place = self.reader.spans.of(&item.sig.ident);
        let value = self.reader.run(item, values, place);
        self.reader.diagnostics.keep(value)
    }

    fn argument(&mut self, ty: &Type, components: usize) -> Result<Value, Diagnostic> {
        match ty {
            Type::Reference(inner) => self.argument(&inner.elem, components),
            Type::Path(path) => {
                let name = path.path.segments.last().map(|segment| segment.ident.to_string()).unwrap_or_default();
                match self.signals.of(&name) {
                    Some(fields) => Ok(Value::record(fields)),
                    None => Err(unsupported(
                        self.reader.spans.of(ty),
                        format!("`{name}` is not one of the plant's signals"),
                    )
                    .help("take X, Y, U or W, by value or by reference")),
                }
            }
            Type::Array(_) if components > 0 => {
                let place = self.reader.spans.of(ty);
                Ok(Value::List((1..=components).map(|number| Value::name(&format!("z{number}"), place)).collect()))
            }
            _ => Err(unsupported(self.reader.spans.of(ty), "this is not one of the plant's signals")
                .help("take X, Y, U or W, by value or by reference; phi_left takes `z: [f64; N]` as well")),
        }
    }

    /// The fields of the struct that a function returns.
    fn entries(&mut self, item: &'a ItemFn, components: usize) -> Vec<Entry<Formula>> {
        let fields = match self.run(item, components) {
            Some(Value::Record(fields)) => fields,
            Some(other) => {
                let place = self.reader.spans.of(&item.sig.ident);
                let message = format!("`{}` returns {}, not a struct", item.sig.ident, other.kind());
                self.reader.diagnostics.push(
                    unsupported(place, message).help("return a struct with a field for each signal: `X { i1: .. }`"),
                );
                return Vec::new();
            }
            None => return Vec::new(),
        };
        let mut entries = Vec::new();
        for field in fields {
            match field.value {
                Value::Number(number) => entries.push(Entry { name: field.name, value: number.formula }),
                other => self.reader.diagnostics.push(
                    unsupported(field.name.span, format!("this field is {}, not a number", other.kind()))
                        .help("give it one number"),
                ),
            }
        }
        entries
    }

    /// The components that a function returns.
    fn list(&mut self, item: &'a ItemFn) -> Vec<Formula> {
        let Some(value) = self.run(item, 0) else { return Vec::new() };
        let mut waiting = vec![value];
        let mut formulas = Vec::new();
        while let Some(value) = waiting.pop() {
            match value {
                Value::Number(number) => formulas.push(number.formula),
                Value::List(items) => waiting.extend(items.into_iter().rev()),
                Value::Record(fields) => {
                    let declared = returned(item).and_then(|name| self.reader.items.structure(&name));
                    let order = |name: &str| {
                        let mut names = declared.iter().flat_map(|item| &item.fields).filter_map(|f| f.ident.as_ref());
                        names.position(|ident| ident.unraw() == name)
                    };
                    let mut fields = fields;
                    fields.sort_by_key(|field| order(&field.name.value));
                    waiting.extend(fields.into_iter().rev().map(|field| field.value));
                }
            }
        }
        if formulas.is_empty() {
            let place = self.reader.spans.of(&item.sig.ident);
            let message = format!("`{}` returns no components", item.sig.ident);
            self.reader
                .diagnostics
                .push(Diagnostic::error(Code::EmptyList, place, message).help("return at least one: `[x.a]`"));
        }
        formulas
    }

    /// The arguments of the attribute, in which signals are called by their names alone.
    fn attribute(&mut self, arguments: &Arguments) -> (Vec<Comparison>, [Vec<Entry<Formula>>; 2]) {
        let mut locals = Locals::new();
        for (letter, fields) in
            [("x", &self.signals.x), ("y", &self.signals.y), ("u", &self.signals.u), ("w", &self.signals.w)]
        {
            locals.push((letter.to_owned(), Value::record(fields)));
        }
        for field in [&self.signals.x, &self.signals.y, &self.signals.u, &self.signals.w].into_iter().flatten() {
            locals.push((field.value.clone(), Value::name(&field.value, field.span)));
        }
        self.reader.integers = true;
        let mut assume = Vec::new();
        for chain in &arguments.assume {
            let comparison = self.comparison(chain, &mut locals);
            assume.extend(self.reader.diagnostics.keep(comparison));
        }
        let values = [&arguments.known, &arguments.angles].map(|pairs| {
            let mut values = Vec::new();
            for pair in pairs {
                let span = self.reader.spans.of(&pair.path);
                let name = Spanned { value: TokenSpans::path(&pair.path), span };
                let value = self.reader.number(&pair.value, &mut locals);
                if let Some(value) = self.reader.diagnostics.keep(value) {
                    values.push(Entry { name, value: value.formula });
                }
            }
            values
        });
        self.reader.integers = false;
        (assume, values)
    }

    fn comparison(&mut self, chain: &Chain, locals: &mut Locals) -> Result<Comparison, Diagnostic> {
        let first = self.reader.number(&chain.first, locals)?.formula;
        let mut rest = Vec::new();
        for (relation, side) in &chain.rest {
            rest.push((*relation, self.reader.number(side, locals)?.formula));
        }
        Ok(Comparison { span: chain.span, first, rest })
    }
}

fn missing(module: Span, what: &str, example: &str) -> Diagnostic {
    Diagnostic::error(Code::MissingItem, module, format!("{what} is missing"))
        .help(format!("add it to the module, for example `{example}`"))
}

/// The name of the type that a function returns.
fn returned(item: &ItemFn) -> Option<String> {
    let syn::ReturnType::Type(_, ty) = &item.sig.output else { return None };
    let Type::Path(path) = &**ty else { return None };
    Some(path.path.segments.last()?.ident.to_string())
}

/// Tests whether an expression mentions a name.
fn mentions(expr: &Expr, name: &str) -> bool {
    struct Search<'n>(&'n str, bool);
    impl<'ast> syn::visit::Visit<'ast> for Search<'_> {
        fn visit_ident(&mut self, ident: &'ast syn::Ident) {
            self.1 |= ident.unraw() == self.0;
        }
    }
    let mut search = Search(name, false);
    syn::visit::Visit::visit_expr(&mut search, expr);
    search.1
}

/// The first paragraph of the module's documentation, without its full stop.
fn documented(module: &ItemMod, spans: &mut TokenSpans) -> Option<Spanned<String>> {
    let lines = module.attrs.iter().filter_map(|attribute| match &attribute.meta {
        Meta::NameValue(pair) if pair.path.is_ident("doc") => match &pair.value {
            Expr::Lit(syn::ExprLit { lit: Lit::Str(text), .. }) => Some((attribute, text.value())),
            _ => None,
        },
        _ => None,
    });
    let paragraph: Vec<_> = lines.take_while(|(_, line)| !line.trim().is_empty()).collect();
    let (first, _) = paragraph.first()?;
    let text = paragraph.iter().map(|(_, line)| line.trim()).collect::<Vec<_>>().join(" ");
    let text = text.trim_end_matches('.').to_owned();
    Some(Spanned { value: text, span: spans.of(first) })
}

//! Sites of small faults: an operator exchanged, a condition or a number off.

use std::collections::BTreeMap;
use std::ops::Range;
use std::path::{Path, PathBuf};

use proc_macro2::Span;
use syn::spanned::Spanned;
use syn::visit::{self, Visit};

use crate::plan::Module;

/// A fault that can be switched on.
pub struct Fault {
    /// From 1.
    pub number: usize,
    pub module: &'static str,
    /// Below the root.
    pub file: PathBuf,
    pub line: usize,
    /// The function that it is in.
    pub function: String,
    /// The replaced bytes of the file.
    pub place: Range<usize>,
    /// The replacement; `@` stands for the switch's number, [`ORIGINAL`] for the replaced text.
    pub instead: String,
    pub what: String,
}

/// Stands for the replaced text.
pub const ORIGINAL: &str = "\u{1}";

/// A sample of the faults of each module, none within another, numbered in all.
///
/// Those of the least hashes are drawn, so that a seed keeps its sample except for changed sources.
pub fn draw(root: &Path, modules: &[&'static Module], sample: usize, seed: u64) -> Result<Vec<Fault>, String> {
    let mut drawn: Vec<Fault> = Vec::new();
    for module in modules {
        let mut found = Vec::new();
        for source in module.sources {
            collect(root, &PathBuf::from(source), module.name, &mut found)?;
        }
        let mut taken: Vec<Fault> = Vec::new();
        for fault in hashed(found, seed) {
            if taken.len() == sample {
                break;
            }
            let apart = |other: &Fault| {
                other.file != fault.file || other.place.end <= fault.place.start || fault.place.end <= other.place.start
            };
            if taken.iter().all(apart) {
                taken.push(fault);
            }
        }
        drawn.extend(taken);
    }
    for (number, fault) in (1..).zip(&mut drawn) {
        fault.number = number;
    }
    Ok(drawn)
}

/// The faults by the hash of their site: file, function, exchanged text, and a count of equal ones.
fn hashed(faults: Vec<Fault>, seed: u64) -> impl Iterator<Item = Fault> {
    let mut same: BTreeMap<String, usize> = BTreeMap::new();
    let mut all: Vec<(u64, Fault)> = Vec::new();
    for fault in faults {
        let place = format!("{}\n{}\n{}", fault.file.display(), fault.function, fault.what);
        let count = same.entry(place.clone()).or_default();
        all.push((hash(&format!("{seed}\n{place}\n{count}")), fault));
        *count += 1;
    }
    all.sort_by_key(|(hash, _)| *hash);
    all.into_iter().map(|(_, fault)| fault)
}

/// FNV-1a, whose low bits depend on few, mixed as SplitMix64 does; the same on every machine and with every compiler.
fn hash(text: &str) -> u64 {
    let sum = text
        .bytes()
        .fold(0xcbf2_9ce4_8422_2325, |sum: u64, byte| (sum ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3));
    let mixed = (sum ^ sum >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let mixed = (mixed ^ mixed >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
    mixed ^ mixed >> 31
}

fn collect(root: &Path, path: &Path, module: &'static str, found: &mut Vec<Fault>) -> Result<(), String> {
    let whole = root.join(path);
    let problem = |error: &dyn std::fmt::Display| format!("{}: {error}", whole.display());
    if whole.is_dir() {
        let mut entries = Vec::new();
        for entry in std::fs::read_dir(&whole).map_err(|error| problem(&error))? {
            entries.push(entry.map_err(|error| problem(&error))?.file_name());
        }
        entries.sort();
        return entries
            .iter()
            .filter(|name| *name != "tests" && *name != "tests.rs")
            .try_for_each(|name| collect(root, &path.join(name), module, found));
    }
    if path.extension().is_none_or(|extension| extension != "rs") {
        return Ok(());
    }
    let text = std::fs::read_to_string(&whole).map_err(|error| problem(&error))?;
    let file = syn::parse_file(&text).map_err(|error| problem(&error))?;
    let mut sites = Sites { text: &text, path, module, function: String::new(), found };
    sites.visit_file(&file);
    Ok(())
}

struct Sites<'a> {
    text: &'a str,
    path: &'a Path,
    module: &'static str,
    /// The function that is being looked at.
    function: String,
    found: &'a mut Vec<Fault>,
}

impl<'a> Sites<'a> {
    fn of(&self, span: Span) -> &'a str {
        &self.text[span.byte_range()]
    }

    /// The expression at the span, or another in its place where the switch is on.
    fn add(&mut self, span: Span, other: &str, what: String) {
        let instead = format!("(if crate::mutants::on(@) {{ {other} }} else {{ {ORIGINAL} }})");
        self.push(span.byte_range(), span, instead, what);
    }

    fn push(&mut self, place: Range<usize>, span: Span, instead: String, what: String) {
        self.found.push(Fault {
            number: 0,
            module: self.module,
            file: self.path.to_owned(),
            line: span.start().line,
            function: self.function.clone(),
            place,
            instead,
            what,
        });
    }

    /// The faults of a function.
    fn inside(&mut self, signature: &syn::Signature, block: &syn::Block) {
        let outer = std::mem::replace(&mut self.function, signature.ident.to_string());
        self.body(signature, block);
        self.visit_block(block);
        self.function = outer;
    }

    /// Faults that return a value at once.
    fn body(&mut self, signature: &syn::Signature, block: &syn::Block) {
        let syn::ReturnType::Type(_, output) = &signature.output else { return };
        let output = self.of(output.span());
        let values: &[&str] = match output {
            "bool" => &["true", "false"],
            _ if output.starts_with("Option<") => &["None"],
            _ => &[],
        };
        let open = block.brace_token.span.open();
        for value in values {
            let instead = format!("{ORIGINAL} if crate::mutants::on(@) {{ return {value}; }}");
            self.push(
                open.byte_range(),
                signature.ident.span(),
                instead,
                format!("`{}` gives {value}", signature.ident),
            );
        }
    }
}

/// The condition binds names, and cannot be moved.
fn binds(expr: &syn::Expr) -> bool {
    match expr {
        syn::Expr::Let(_) => true,
        syn::Expr::Binary(binary) => binds(&binary.left) || binds(&binary.right),
        _ => false,
    }
}

fn is_test(attributes: &[syn::Attribute]) -> bool {
    attributes.iter().any(|attribute| match &attribute.meta {
        syn::Meta::List(list) => list.path.is_ident("cfg") && list.tokens.to_string().contains("test"),
        meta => meta.path().is_ident("test"),
    })
}

/// The operator in exchange for another.
fn exchanged(operator: &syn::BinOp) -> Option<&'static str> {
    use syn::BinOp as Op;
    Some(match operator {
        Op::Lt(_) => "<=",
        Op::Le(_) => "<",
        Op::Gt(_) => ">=",
        Op::Ge(_) => ">",
        Op::Eq(_) => "!=",
        Op::Ne(_) => "==",
        Op::And(_) => "||",
        Op::Or(_) => "&&",
        Op::Add(_) => "-",
        Op::Sub(_) => "+",
        Op::Mul(_) | Op::Rem(_) => "+",
        Op::Div(_) => "*",
        Op::AddAssign(_) => "-=",
        Op::SubAssign(_) => "+=",
        Op::MulAssign(_) => "+=",
        _ => return None,
    })
}

impl<'ast> Visit<'ast> for Sites<'_> {
    fn visit_expr_binary(&mut self, node: &'ast syn::ExprBinary) {
        if let Some(other) = exchanged(&node.op).filter(|_| !binds(&node.left) && !binds(&node.right)) {
            let operator = node.op.span().byte_range();
            let whole = node.span().byte_range();
            let (left, right) = (&self.text[whole.start..operator.start], &self.text[operator.end..whole.end]);
            let text = format!("{left}{other}{right}");
            let what = format!("`{}` for `{}` in `{}`", other, self.of(node.op.span()), short(self.of(node.span())));
            self.add(node.span(), &text, what);
        }
        visit::visit_expr_binary(self, node);
    }

    fn visit_expr_unary(&mut self, node: &'ast syn::ExprUnary) {
        if matches!(node.op, syn::UnOp::Not(_) | syn::UnOp::Neg(_)) && !matches!(*node.expr, syn::Expr::Lit(_)) {
            let text = self.of(node.expr.span());
            let what = format!("`{}` for `{}`", short(text), short(self.of(node.span())));
            self.add(node.span(), text, what);
        }
        visit::visit_expr_unary(self, node);
    }

    fn visit_expr_if(&mut self, node: &'ast syn::ExprIf) {
        if !binds(&node.cond) {
            let text = format!("!({})", self.of(node.cond.span()));
            let what = format!("`if` not `{}`", short(self.of(node.cond.span())));
            self.add(node.cond.span(), &text, what);
        }
        visit::visit_expr_if(self, node);
    }

    fn visit_expr_lit(&mut self, node: &'ast syn::ExprLit) {
        if let syn::Lit::Int(number) = &node.lit {
            let text = format!("{number} + 1");
            self.add(node.span(), &text, format!("`{text}`"));
        }
    }

    fn visit_item_fn(&mut self, node: &'ast syn::ItemFn) {
        if node.sig.constness.is_none() && !is_test(&node.attrs) {
            self.inside(&node.sig, &node.block);
        }
    }

    fn visit_impl_item_fn(&mut self, node: &'ast syn::ImplItemFn) {
        if node.sig.constness.is_none() && !is_test(&node.attrs) {
            self.inside(&node.sig, &node.block);
        }
    }

    fn visit_item_mod(&mut self, node: &'ast syn::ItemMod) {
        if !is_test(&node.attrs) {
            visit::visit_item_mod(self, node);
        }
    }

    // Constants and patterns can have no switch.
    fn visit_item_const(&mut self, _: &'ast syn::ItemConst) {}
    fn visit_item_static(&mut self, _: &'ast syn::ItemStatic) {}
    fn visit_impl_item_const(&mut self, _: &'ast syn::ImplItemConst) {}
    fn visit_item_enum(&mut self, _: &'ast syn::ItemEnum) {}
    fn visit_expr_repeat(&mut self, node: &'ast syn::ExprRepeat) {
        self.visit_expr(&node.expr);
    }
    fn visit_expr_const(&mut self, _: &'ast syn::ExprConst) {}
    fn visit_type(&mut self, _: &'ast syn::Type) {}
    fn visit_pat(&mut self, _: &'ast syn::Pat) {}
    fn visit_generic_argument(&mut self, _: &'ast syn::GenericArgument) {}
    fn visit_attribute(&mut self, _: &'ast syn::Attribute) {}
}

/// On one line, and no longer than is read.
fn short(text: &str) -> String {
    let words = text.split_whitespace().collect::<Vec<_>>().join(" ");
    match words.char_indices().nth(60) {
        Some((end, _)) => format!("{}..", &words[..end]),
        None => words,
    }
}

//! The emitted module as its C face sees it, read off the items of its code.

use std::collections::BTreeMap;

use syn::{BinOp, Expr, Fields, Item, ItemImpl, ItemStruct, Lit, Type};

use crate::emit::Emitted;

/// The parts of an emitted module.
pub(super) struct Module {
    /// The name of the model's type.
    pub(super) type_name: String,
    /// The fields of the structures `X`, `Y`, `U` and `Parameters`.
    pub(super) x: Vec<String>,
    pub(super) y: Vec<String>,
    pub(super) u: Vec<String>,
    pub(super) parameters: Vec<String>,
    /// The number of fields of the model's type, and of what it keeps of a sample.
    pub(super) constants: usize,
    pub(super) terms: usize,
    /// The type of the extension.
    pub(super) extension: Type,
    /// The type of the observer with the settings of the model.
    pub(super) tuned: Type,
    /// The sizes by their names.
    pub(super) sizes: BTreeMap<String, usize>,
    /// True if samples are held against limits, and against a gate, before each step.
    pub(super) has_limits: bool,
    pub(super) has_gate: bool,
    /// A number that other modules do not have, as far as 64 bits tell them apart.
    pub(super) tag: u64,
}

impl Module {
    /// The parts of a module; none if it has no observer, because the settings of the model are incomplete.
    pub(super) fn of(emitted: &Emitted) -> Option<Self> {
        let file: syn::File = syn::parse2(emitted.tokens.clone()).ok()?;
        let type_name = emitted.type_name.clone();
        let structure = |name: &str| {
            file.items.iter().find_map(|item| match item {
                Item::Struct(item) if item.ident == name => Some(fields(item)),
                _ => None,
            })
        };
        let alias = |name: &str| {
            file.items.iter().find_map(|item| match item {
                Item::Type(item) if item.ident == name => Some((*item.ty).clone()),
                _ => None,
            })
        };
        let impls = || file.items.iter().filter_map(|item| if let Item::Impl(item) = item { Some(item) } else { None });
        let model = impls().find(|item| is_of(item, "Model"))?;
        let has = |name: &str| impls().any(|item| has_function(item, name));
        let mut sizes = BTreeMap::new();
        for item in &file.items {
            if let Item::Const(item) = item
                && let Some(value) = number(&item.expr, &sizes)
            {
                sizes.insert(item.ident.to_string(), value);
            }
        }
        let outputs = structure("Y")?;
        Some(Self {
            tuned: alias("Tuned")?,
            x: structure("X")?,
            u: structure("U")?,
            parameters: structure("Parameters")?,
            constants: structure(&type_name)?.len(),
            terms: structure("Terms").map_or(outputs.len(), |terms| terms.len()),
            extension: associated(model, "Extension")?,
            has_limits: has("limits"),
            has_gate: has("gate"),
            tag: tag(&emitted.text),
            y: outputs,
            sizes,
            type_name,
        })
    }
}

/// The names of the fields.
fn fields(item: &ItemStruct) -> Vec<String> {
    let Fields::Named(named) = &item.fields else { return Vec::new() };
    named.named.iter().filter_map(|field| Some(field.ident.as_ref()?.to_string())).collect()
}

/// Tests whether the items implement the trait of that name.
fn is_of(item: &ItemImpl, name: &str) -> bool {
    item.trait_.as_ref().is_some_and(|(path, _)| path.segments.last().is_some_and(|last| last.ident == name))
}

fn has_function(item: &ItemImpl, name: &str) -> bool {
    let mut items = item.items.iter();
    item.trait_.is_none() && items.any(|item| matches!(item, syn::ImplItem::Fn(function) if function.sig.ident == name))
}

/// The associated type of that name.
fn associated(item: &ItemImpl, name: &str) -> Option<Type> {
    item.items.iter().find_map(|item| match item {
        syn::ImplItem::Type(item) if item.ident == name => Some(item.ty.clone()),
        _ => None,
    })
}

/// The value of a size: a number, another size, a sum or a difference.
fn number(expr: &Expr, known: &BTreeMap<String, usize>) -> Option<usize> {
    match expr {
        Expr::Lit(literal) => match &literal.lit {
            Lit::Int(value) => value.base10_parse().ok(),
            _ => None,
        },
        Expr::Path(path) => known.get(&path.path.get_ident()?.to_string()).copied(),
        Expr::Binary(binary) => {
            let (left, right) = (number(&binary.left, known)?, number(&binary.right, known)?);
            match binary.op {
                BinOp::Add(_) => left.checked_add(right),
                BinOp::Sub(_) => left.checked_sub(right),
                _ => None,
            }
        }
        _ => None,
    }
}

/// The FNV-1a hash of a text, odd: memory that is zero holds no such number.
fn tag(text: &str) -> u64 {
    let hash = |hash: u64, byte: u8| (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3);
    text.bytes().fold(0xcbf2_9ce4_8422_2325, hash) | 1
}

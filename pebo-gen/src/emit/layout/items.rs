//! Items, and the statements of functions, as text.

use quote::ToTokens;
use syn::{Attribute, Expr, Fields, ImplItem, Item, Lit, Meta, ReturnType, Stmt, UseTree};

use super::super::error::EmitError;
use super::syntax::{broken_type, expression, filled, joined, path_text, pattern, type_text};
use super::{LINE, Page, STEP, unknown};

/// The longest arguments of an attribute on one line.
const ATTRIBUTE: usize = 70;

/// The module's documentation and items, apart by blank lines.
pub(super) fn module(file: &syn::File) -> Result<String, EmitError> {
    let mut page = Page::default();
    for attribute in &file.attrs {
        let line = documentation(attribute).ok_or_else(|| unknown(attribute))?;
        page.line(0, &format!("//!{line}"));
    }
    let mut used_before = None;
    for item in &file.items {
        let used = match item {
            Item::Use(item) => root(&item.tree),
            _ => None,
        };
        // Uses of one crate are a group.
        if used.is_none() || used != used_before {
            page.line(0, "");
        }
        used_before = used;
        self::item(&mut page, item)?;
    }
    Ok(page.text)
}

fn item(page: &mut Page, item: &Item) -> Result<(), EmitError> {
    match item {
        Item::Use(item) => used(page, &item.tree)?,
        Item::Const(item) => {
            attributes(page, &item.attrs, 0)?;
            let (visible, name) = (visibility(&item.vis), &item.ident);
            let (ty, value) = (type_text(&item.ty)?, expression(&item.expr, 0, 0, 1)?);
            page.line(0, &format!("{visible}const {name}: {ty} = {value};"));
        }
        Item::Type(item) => alias(page, item)?,
        Item::Struct(item) => structure(page, item)?,
        Item::Impl(item) => implementation(page, item)?,
        other => return Err(unknown(other)),
    }
    Ok(())
}

fn alias(page: &mut Page, item: &syn::ItemType) -> Result<(), EmitError> {
    attributes(page, &item.attrs, 0)?;
    let mut generics = Vec::new();
    for parameter in item.generics.type_params() {
        generics.push(match &parameter.default {
            Some((_, default)) => format!("{} = {}", parameter.ident, type_text(default)?),
            None => parameter.ident.to_string(),
        });
    }
    let (visible, name, generics) = (visibility(&item.vis), &item.ident, generics.join(", "));
    let generics = if generics.is_empty() { generics } else { format!("<{generics}>") };
    let head = format!("{visible}type {name}{generics} =");
    let value = format!("{};", type_text(&item.ty)?);
    if head.len() + 1 + value.len() <= LINE {
        page.line(0, &format!("{head} {value}"));
    } else if STEP + value.len() > LINE {
        page.line(0, &format!("{head} {};", broken_type(&item.ty)?));
    } else {
        page.line(0, &head);
        page.line(STEP, &value);
    }
    Ok(())
}

fn structure(page: &mut Page, item: &syn::ItemStruct) -> Result<(), EmitError> {
    attributes(page, &item.attrs, 0)?;
    let head = format!("{}struct {}", visibility(&item.vis), item.ident);
    match &item.fields {
        Fields::Unit => page.line(0, &format!("{head};")),
        Fields::Named(fields) => {
            page.line(0, &format!("{head} {{"));
            for field in &fields.named {
                attributes(page, &field.attrs, STEP)?;
                let (visible, name) = (visibility(&field.vis), field.ident.to_token_stream());
                page.line(STEP, &format!("{visible}{name}: {},", type_text(&field.ty)?));
            }
            page.line(0, "}");
        }
        Fields::Unnamed(_) => return Err(unknown(item)),
    }
    Ok(())
}

fn implementation(page: &mut Page, item: &syn::ItemImpl) -> Result<(), EmitError> {
    attributes(page, &item.attrs, 0)?;
    let target = type_text(&item.self_ty)?;
    let head = match &item.trait_ {
        None => format!("impl {target}"),
        Some((implemented, _)) => format!("impl {} for {target}", path_text(implemented)?),
    };
    if item.items.is_empty() {
        page.line(0, &format!("{head} {{}}"));
        return Ok(());
    }
    page.line(0, &format!("{head} {{"));
    for (index, entry) in item.items.iter().enumerate() {
        match entry {
            ImplItem::Type(entry) => {
                page.line(STEP, &format!("type {} = {};", entry.ident, type_text(&entry.ty)?));
            }
            ImplItem::Const(entry) => {
                let (ty, value) = (type_text(&entry.ty)?, expression(&entry.expr, STEP, STEP, 1)?);
                page.line(STEP, &format!("const {}: {ty} = {value};", entry.ident));
            }
            ImplItem::Fn(entry) => {
                if index > 0 {
                    page.line(0, "");
                }
                function(page, entry)?;
            }
            other => return Err(unknown(other)),
        }
    }
    page.line(0, "}");
    Ok(())
}

fn function(page: &mut Page, item: &syn::ImplItemFn) -> Result<(), EmitError> {
    attributes(page, &item.attrs, STEP)?;
    let name = format!("{}fn {}", visibility(&item.vis), item.sig.ident);
    let mut arguments = Vec::new();
    for input in &item.sig.inputs {
        arguments.push(match input {
            syn::FnArg::Receiver(_) => "&self".to_owned(),
            syn::FnArg::Typed(typed) => {
                let name = pattern(&typed.pat, 0, 0, 0)?;
                format!("{name}: {}", type_text(&typed.ty)?)
            }
        });
    }
    let ReturnType::Type(_, returned) = &item.sig.output else {
        return Err(unknown(&item.sig));
    };
    let returned = type_text(returned)?;
    let one_line = format!("{name}({}) -> {returned} {{", arguments.join(", "));
    if STEP + one_line.chars().count() <= LINE {
        page.line(STEP, &one_line);
    } else {
        page.line(STEP, &format!("{name}("));
        for argument in &arguments {
            page.line(2 * STEP, &format!("{argument},"));
        }
        page.line(STEP, &format!(") -> {returned} {{"));
    }
    for statement in &item.block.stmts {
        self::statement(page, statement, 2 * STEP)?;
    }
    page.line(STEP, "}");
    Ok(())
}

fn statement(page: &mut Page, statement: &Stmt, indent: usize) -> Result<(), EmitError> {
    match statement {
        Stmt::Local(local) => {
            let init = local.init.as_ref().ok_or_else(|| unknown(statement))?;
            let column = indent + "let ".len();
            // The text behind the pattern on its last line, at least.
            let opening = expression(&init.expr, indent, 0, 0)?;
            let opening = opening.lines().next().map_or(0, |line| line.chars().count());
            let name = pattern(&local.pat, indent, column, " = ;".len() + opening)?;
            let last = name.lines().last().map_or(0, |line| line.chars().count());
            let column = if name.contains('\n') { last } else { column + last } + " = ".len();
            let value = expression(&init.expr, indent, column, 1)?;
            page.line(indent, &format!("let {name} = {value};"));
        }
        Stmt::Expr(value, Some(_)) => page.line(indent, &format!("{};", expression(value, indent, indent, 1)?)),
        Stmt::Expr(value, None) => page.line(indent, &expression(value, indent, indent, 0)?),
        other => return Err(unknown(other)),
    }
    Ok(())
}

/// Attributes, each on lines of its own.
fn attributes(page: &mut Page, attributes: &[Attribute], indent: usize) -> Result<(), EmitError> {
    for attribute in attributes {
        if let Some(line) = documentation(attribute) {
            page.line(indent, &format!("///{line}"));
            continue;
        }
        match &attribute.meta {
            Meta::Path(path) => page.line(indent, &format!("#[{}]", path_text(path)?)),
            Meta::List(list) => {
                let parser = syn::punctuated::Punctuated::<Meta, syn::Token![,]>::parse_terminated;
                let entries = list.parse_args_with(parser).map_err(|_| unknown(attribute))?;
                let entries: Vec<String> = entries
                    .iter()
                    .map(|entry| match entry {
                        Meta::NameValue(pair) => {
                            format!("{} = {}", joined(&pair.path), pair.value.to_token_stream())
                        }
                        other => joined(other),
                    })
                    .collect();
                let (name, one_line) = (path_text(&list.path)?, entries.join(", "));
                if one_line.chars().count() <= ATTRIBUTE {
                    page.line(indent, &format!("#[{name}({one_line})]"));
                } else {
                    page.line(indent, &format!("#[{name}("));
                    for (index, entry) in entries.iter().enumerate() {
                        let comma = if index + 1 < entries.len() { "," } else { "" };
                        page.line(indent + STEP, &format!("{entry}{comma}"));
                    }
                    page.line(indent, ")]");
                }
            }
            Meta::NameValue(_) => return Err(unknown(attribute)),
        }
    }
    Ok(())
}

/// The text of a line of documentation, with the space that leads it.
fn documentation(attribute: &Attribute) -> Option<String> {
    let Meta::NameValue(pair) = &attribute.meta else {
        return None;
    };
    let Expr::Lit(literal) = &pair.value else {
        return None;
    };
    match &literal.lit {
        Lit::Str(text) if pair.path.is_ident("doc") => Some(text.value()),
        _ => None,
    }
}

fn visibility(visibility: &syn::Visibility) -> &'static str {
    match visibility {
        syn::Visibility::Public(_) => "pub ",
        _ => "",
    }
}

fn root(tree: &UseTree) -> Option<String> {
    match tree {
        UseTree::Path(path) => Some(path.ident.to_string()),
        _ => None,
    }
}

/// A `use`, the names of its group filled into lines where one is too short.
fn used(page: &mut Page, tree: &UseTree) -> Result<(), EmitError> {
    let one_line = format!("use {};", use_text(tree)?);
    match one_line.split_once('{') {
        // Rustfmt keeps room for a comma and a brace.
        Some((head, names)) if one_line.len() > LINE - "},".len() => {
            let names: Vec<String> = names.trim_end_matches("};").split(", ").map(str::to_owned).collect();
            page.line(0, &format!("{}{};", head, filled(&names, STEP, LINE - 1).within("{", "}", 0)));
        }
        _ => page.line(0, &one_line),
    }
    Ok(())
}

fn use_text(tree: &UseTree) -> Result<String, EmitError> {
    match tree {
        UseTree::Path(path) => Ok(format!("{}::{}", path.ident, use_text(&path.tree)?)),
        UseTree::Name(name) => Ok(name.ident.to_string()),
        UseTree::Group(group) => {
            let names: Vec<String> = group.items.iter().map(use_text).collect::<Result<_, _>>()?;
            Ok(format!("{{{}}}", names.join(", ")))
        }
        _ => Err(unknown(tree)),
    }
}

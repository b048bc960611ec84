//! Types, patterns and expressions as text.

use quote::ToTokens;
use syn::{BinOp, Expr, GenericArgument, Member, Pat, PathArguments, Type, UnOp};

use super::super::error::EmitError;
use super::{LINE, Page, STEP, unknown};

/// The longest contents of an array, of an array pattern, and of the arguments of a call on one line.
const LIST: usize = 60;
/// The longest contents of a structure on one line.
const STRUCTURE: usize = 18;
/// Elements of arrays up to this length share lines.
const SHORT: usize = 10;

/// An expression from `column` on, with `behind` characters to follow, indented by `indent` where it
/// takes several lines.
pub(super) fn expression(syntax: &Expr, indent: usize, column: usize, behind: usize) -> Result<String, EmitError> {
    let one_line = flat(syntax)?;
    if is_narrow(syntax)? && column + one_line.chars().count() + behind <= LINE {
        return Ok(one_line);
    }
    let inner = indent + STEP;
    let each = |elements: &mut dyn Iterator<Item = &Expr>| -> Result<Page, EmitError> {
        let mut page = Page::default();
        for element in elements {
            page.line(inner, &format!("{},", expression(element, inner, inner, 1)?));
        }
        Ok(page)
    };
    match syntax {
        Expr::Array(array) => {
            let elements: Vec<String> = array.elems.iter().map(flat).collect::<Result<_, _>>()?;
            let short = elements.iter().all(|element| element.chars().count() <= SHORT);
            let page = if short { filled(&elements, inner, LINE) } else { each(&mut array.elems.iter())? };
            Ok(page.within("[", "]", indent))
        }
        Expr::Call(call) => {
            let function = flat(&call.func)?;
            if let [only @ (Expr::Array(_) | Expr::Struct(_))] = call.args.iter().collect::<Vec<_>>()[..] {
                // A single array or structure opens on the line of the call.
                return Ok(format!("{function}({})", broken(only, indent)?));
            }
            let page = each(&mut call.args.iter())?;
            Ok(page.within(&format!("{function}("), ")", indent))
        }
        Expr::Struct(structure) => {
            let mut page = Page::default();
            for field in &structure.fields {
                let name = member(&field.member);
                let column = inner + name.len() + 2;
                let value = expression(&field.expr, inner, column, 1)?;
                page.line(inner, &format!("{},", initialised(&name, value)));
            }
            Ok(page.within(&format!("{} {{", structure.path.to_token_stream()), "}", indent))
        }
        Expr::Binary(binary) if matches!(binary.op, BinOp::And(_)) => {
            Ok(format!("{}\n{:inner$}&& {}", flat(&binary.left)?, "", flat(&binary.right)?))
        }
        _ => Ok(one_line),
    }
}

/// An array that is the only argument of a call: over several lines, its only element opened with it.
fn broken(syntax: &Expr, indent: usize) -> Result<String, EmitError> {
    if let Expr::Array(array) = syntax
        && let [only @ Expr::Array(_)] = array.elems.iter().collect::<Vec<_>>()[..]
    {
        return Ok(format!("[{}]", broken(only, indent)?));
    }
    // No room is left on the line: it breaks.
    expression(syntax, indent, LINE, 0)
}

/// Short elements, as many to a line as fit.
pub(super) fn filled(elements: &[String], indent: usize, longest: usize) -> Page {
    let mut page = Page::default();
    let mut line = String::new();
    for element in elements {
        let width = indent + line.chars().count() + element.chars().count() + " ,".len();
        if !line.is_empty() && width > longest {
            page.line(indent, &std::mem::take(&mut line));
        }
        if !line.is_empty() {
            line.push(' ');
        }
        line.push_str(element);
        line.push(',');
    }
    page.line(indent, &line);
    page
}

/// A field of a structure; `x: x` is `x`.
fn initialised(name: &str, value: String) -> String {
    if name == value { value } else { format!("{name}: {value}") }
}

/// Every list within is short enough for one line.
fn is_narrow(syntax: &Expr) -> Result<bool, EmitError> {
    let list = |elements: Vec<&Expr>| -> Result<bool, EmitError> {
        let mut width = 0;
        for (index, element) in elements.iter().enumerate() {
            width += flat(element)?.chars().count() + if index > 0 { 2 } else { 0 };
            if !is_narrow(element)? {
                return Ok(false);
            }
        }
        // A list that holds but a list is as wide as that may be.
        Ok(width <= LIST || matches!(elements.as_slice(), [Expr::Array(_)]))
    };
    match syntax {
        Expr::Array(array) => list(array.elems.iter().collect()),
        Expr::Call(call) => list(call.args.iter().collect()),
        Expr::Struct(structure) => {
            let width = flat(syntax)?.chars().count();
            // `Self { .. }`: all but the contents.
            let around = structure.path.to_token_stream().to_string().len() + " {  }".len();
            Ok(width <= around + STRUCTURE)
        }
        Expr::Binary(binary) => Ok(is_narrow(&binary.left)? && is_narrow(&binary.right)?),
        Expr::Unary(unary) => is_narrow(&unary.expr),
        Expr::Paren(inner) => is_narrow(&inner.expr),
        _ => Ok(true),
    }
}

/// An expression on one line.
fn flat(syntax: &Expr) -> Result<String, EmitError> {
    let list = |elements: &mut dyn Iterator<Item = &Expr>| -> Result<String, EmitError> {
        Ok(elements.map(flat).collect::<Result<Vec<_>, _>>()?.join(", "))
    };
    Ok(match syntax {
        Expr::Lit(literal) => literal.lit.to_token_stream().to_string(),
        Expr::Path(path) => joined(&path.to_token_stream()),
        Expr::Paren(inner) => format!("({})", flat(&inner.expr)?),
        Expr::Reference(reference) => format!("&{}", flat(&reference.expr)?),
        Expr::Try(attempt) => format!("{}?", flat(&attempt.expr)?),
        Expr::Unary(unary) => {
            let operator = match unary.op {
                UnOp::Neg(_) => "-",
                UnOp::Deref(_) => "*",
                _ => return Err(unknown(syntax)),
            };
            format!("{operator}{}", flat(&unary.expr)?)
        }
        Expr::Binary(binary) => {
            let operator = match binary.op {
                BinOp::Add(_) => "+",
                BinOp::Sub(_) => "-",
                BinOp::Mul(_) => "*",
                BinOp::Div(_) => "/",
                BinOp::And(_) => "&&",
                BinOp::Gt(_) => ">",
                BinOp::Ge(_) => ">=",
                BinOp::Lt(_) => "<",
                BinOp::Le(_) => "<=",
                BinOp::Ne(_) => "!=",
                BinOp::Eq(_) => "==",
                _ => return Err(unknown(syntax)),
            };
            format!("{} {operator} {}", flat(&binary.left)?, flat(&binary.right)?)
        }
        Expr::Field(field) => format!("{}.{}", flat(&field.base)?, member(&field.member)),
        Expr::MethodCall(call) => {
            format!("{}.{}({})", flat(&call.receiver)?, call.method, list(&mut call.args.iter())?)
        }
        Expr::Array(array) => format!("[{}]", list(&mut array.elems.iter())?),
        Expr::Call(call) => format!("{}({})", flat(&call.func)?, list(&mut call.args.iter())?),
        Expr::Struct(structure) => {
            let mut fields = Vec::new();
            for field in &structure.fields {
                let (name, value) = (member(&field.member), flat(&field.expr)?);
                fields.push(initialised(&name, value));
            }
            format!("{} {{ {} }}", structure.path.to_token_stream(), fields.join(", "))
        }
        _ => return Err(unknown(syntax)),
    })
}

/// A pattern of a `let`, with `behind` characters to follow.
pub(super) fn pattern(syntax: &Pat, indent: usize, column: usize, behind: usize) -> Result<String, EmitError> {
    let flat = flat_pattern(syntax)?;
    let Pat::Slice(slice) = syntax else {
        return Ok(flat);
    };
    let mut innermost = slice;
    while let [Pat::Slice(only)] = innermost.elems.iter().collect::<Vec<_>>()[..] {
        innermost = only;
    }
    let narrow = flat_pattern(&Pat::Slice(innermost.clone()))?.chars().count() <= LIST + "[]".len();
    if narrow && column + flat.chars().count() + behind <= LINE {
        return Ok(flat);
    }
    let inner = indent + STEP;
    let mut page = Page::default();
    for element in &slice.elems {
        page.line(inner, &format!("{},", pattern(element, inner, inner, 1)?));
    }
    Ok(page.within("[", "]", indent))
}

fn flat_pattern(syntax: &Pat) -> Result<String, EmitError> {
    Ok(match syntax {
        Pat::Ident(name) => name.ident.to_string(),
        Pat::Wild(_) => "_".to_owned(),
        Pat::Slice(slice) => {
            let elements: Vec<String> = slice.elems.iter().map(flat_pattern).collect::<Result<_, _>>()?;
            format!("[{}]", elements.join(", "))
        }
        Pat::Tuple(tuple) => {
            let elements: Vec<String> = tuple.elems.iter().map(flat_pattern).collect::<Result<_, _>>()?;
            format!("({})", elements.join(", "))
        }
        _ => return Err(unknown(syntax)),
    })
}

/// A type on one line.
pub(super) fn type_text(syntax: &Type) -> Result<String, EmitError> {
    match syntax {
        Type::Reference(reference) => Ok(format!("&{}", type_text(&reference.elem)?)),
        Type::Path(path) => path_text(&path.path),
        Type::Array(array) => Ok(format!("[{}; {}]", type_text(&array.elem)?, expression(&array.len, 0, 0, 1)?)),
        Type::Tuple(tuple) if tuple.elems.is_empty() => Ok("()".to_owned()),
        _ => Err(unknown(syntax)),
    }
}

/// A type with a line for each of its generic arguments.
pub(super) fn broken_type(syntax: &Type) -> Result<String, EmitError> {
    let Type::Path(path) = syntax else { return Err(unknown(syntax)) };
    let Some(PathArguments::AngleBracketed(arguments)) = path.path.segments.last().map(|last| &last.arguments) else {
        return Err(unknown(syntax));
    };
    let mut page = Page::default();
    for argument in &arguments.args {
        let GenericArgument::Type(argument) = argument else { return Err(unknown(argument)) };
        page.line(STEP, &format!("{},", type_text(argument)?));
    }
    let one_line = path_text(&path.path)?;
    let head = one_line.split('<').next().unwrap_or_default();
    Ok(page.within(&format!("{head}<"), ">", 0))
}

/// A path, its generic arguments included.
pub(super) fn path_text(path: &syn::Path) -> Result<String, EmitError> {
    let mut segments = Vec::new();
    for segment in &path.segments {
        let mut text = segment.ident.to_string();
        if let PathArguments::AngleBracketed(arguments) = &segment.arguments {
            let mut inner = Vec::new();
            for argument in &arguments.args {
                match argument {
                    GenericArgument::Type(argument) => inner.push(type_text(argument)?),
                    GenericArgument::Const(size) => inner.push(flat(size)?),
                    other => return Err(unknown(other)),
                }
            }
            text = format!("{text}<{}>", inner.join(", "));
        }
        segments.push(text);
    }
    Ok(segments.join("::"))
}

/// Tokens without any space between them.
pub(super) fn joined(tokens: &impl ToTokens) -> String {
    tokens.to_token_stream().to_string().split_whitespace().collect()
}

fn member(member: &Member) -> String {
    match member {
        Member::Named(name) => name.to_string(),
        Member::Unnamed(index) => index.index.to_string(),
    }
}

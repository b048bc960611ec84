//! Puts the settings of a call into the tree of the file.
//!
//! In: the tree, and the settings behind the text in its source. Out: the tree as if the file said so, with the spans
//! of the call. Values are not checked here: the schema checks the whole tree.

use super::document::FILE;
use super::key::Shape;
use super::tree::{Content, Key, Node, grow_part};
use crate::source::{Code, Diagnostic, Diagnostics, Source, Span, listed, nearest, quoted};

/// Maps whose keys are names that the map declares: a name that the file does not declare would be used by nothing.
const DECLARING: &[&[&str]] = &[&["parameters"], &["define"], &["simulation", "define"], &["simulation", "signals"]];

/// Puts every setting of the call into the tree; a tree that is no map is refused elsewhere.
pub(super) fn set(root: &mut Node, source: &Source, diagnostics: &mut Diagnostics) {
    for setting in source.settings() {
        if matches!(root.content, Content::Map(_))
            && let Some((path, value)) = read(*setting, source, diagnostics)
        {
            let put = resolved(root, path).and_then(|path| {
                parameters_as_map(root);
                put(root, &path, value)
            });
            diagnostics.keep(put);
        }
    }
}

/// The names before the equals sign, and the value behind it.
fn read(setting: Span, source: &Source, diagnostics: &mut Diagnostics) -> Option<(Vec<Key>, Node)> {
    let text = source.slice(setting);
    let Some((name, _)) = text.split_once('=') else {
        let message = format!("{} sets nothing", quoted(text));
        let help = "write `NAME=VALUE`, as `--set L1=5e-3` or `--set simulation.noise.v2=0.1`";
        diagnostics.push(Diagnostic::error(Code::WrongShape, setting, message).help(help));
        return None;
    };
    let mut path = Vec::new();
    let mut start = setting.start;
    for part in name.split('.') {
        let key = part.trim();
        let at = start + (part.len() - part.trim_start().len());
        path.push(Key { span: Span::new(at, at + key.len()), text: key.to_owned() });
        start += part.len() + 1;
    }
    if let Some(key) = path.iter().find(|key| key.text.is_empty()) {
        let message = "a name is expected here";
        diagnostics.push(Diagnostic::error(Code::WrongShape, key.span, message).help("write `NAME=VALUE`"));
        return None;
    }
    let behind = Span::new(setting.start + name.len() + 1, setting.end);
    let empty = Diagnostic::error(Code::WrongShape, Span::point(setting.end), format!("{} has no value", quoted(name)))
        .help("write the value behind `=`");
    Some((path, grow_part(source, behind, empty, diagnostics)?))
}

/// The names from the top of the file: a single name may be that of a parameter.
fn resolved(root: &Node, mut path: Vec<Key>) -> Result<Vec<Key>, Diagnostic> {
    let Some(first) = path.first() else { return Ok(path) };
    let parameters = names(child(root, "parameters"));
    if path.len() == 1 && parameters.contains(&first.text.as_str()) {
        path.insert(0, Key { span: first.span, text: "parameters".to_owned() });
    } else if !FILE.iter().any(|key| key.name == first.text) {
        return Err(unknown(root, &path, &parameters));
    }
    let texts: Vec<&str> = path.iter().map(|key| key.text.as_str()).collect();
    let declaring = DECLARING.iter().find(|section| texts.len() > section.len() && texts.starts_with(section));
    if let Some(section) = declaring {
        let mut declared = names(section.iter().try_fold(root, |node, name| child(node, name)));
        if section.ends_with(&["signals"]) {
            declared.extend(names(child(root, "w")));
        }
        let name = &path[section.len()];
        if !declared.contains(&name.text.as_str()) {
            let message = format!("{} is no name under `{}` of the model", quoted(&name.text), section.join("."));
            return Err(one_of(Diagnostic::error(Code::UnknownName, name.span, message), &name.text, &declared));
        }
    }
    Ok(path)
}

/// The probable meaning of a setting's first name.
fn unknown(root: &Node, path: &[Key], parameters: &[&str]) -> Diagnostic {
    let (name, span) = (path[0].text.as_str(), path[0].span.to(path[path.len() - 1].span));
    let whole: Vec<&str> = path.iter().map(|key| key.text.as_str()).collect();
    let whole = whole.join(".");
    let message = format!("{} is no parameter of the model and no key of its file", quoted(&whole));
    let diagnostic = Diagnostic::error(Code::UnknownName, span, message);
    let mut sections = FILE.iter().filter(|section| ["observer", "simulation"].contains(&section.name));
    let section = sections.find(|section| match section.shape {
        Shape::Record(keys) => keys.iter().any(|key| key.name == name),
        _ => false,
    });
    if let Some(section) = section {
        return diagnostic.suggest(Some(&format!("{}.{whole}", section.name)));
    }
    if ["x", "y"].iter().any(|group| names(child(root, group)).contains(&name)) {
        return diagnostic.help(format!("to set its value at the start, write `simulation.initial.{name}`"));
    }
    if path.len() == 1 {
        return one_of(diagnostic, name, parameters);
    }
    one_of(diagnostic, name, &FILE.iter().map(|key| key.name).collect::<Vec<_>>())
}

fn one_of(diagnostic: Diagnostic, name: &str, names: &[&str]) -> Diagnostic {
    match nearest(name, names.iter().copied()) {
        Some(near) => {
            let whole = Span { end: diagnostic.primary.span.start + name.len(), ..diagnostic.primary.span };
            let mut diagnostic = diagnostic.suggest(Some(near));
            diagnostic.primary.span = whole;
            diagnostic
        }
        None if names.is_empty() => diagnostic.help("declare it in the model file"),
        None => diagnostic.help(format!("choose one of {}", listed(names.iter().copied()))),
    }
}

/// The value of a map under a key.
fn child<'n>(node: &'n Node, name: &str) -> Option<&'n Node> {
    let Content::Map(entries) = &node.content else { return None };
    entries.iter().find(|(key, _)| key.text == name).map(|(_, node)| node)
}

/// The keys of a map, or the words of a list.
fn names(node: Option<&Node>) -> Vec<&str> {
    match node.map(|node| &node.content) {
        Some(Content::Map(entries)) => entries.iter().map(|(key, _)| key.text.as_str()).collect(),
        Some(Content::List(items)) => items.iter().filter_map(word).collect(),
        _ => Vec::new(),
    }
}

fn word(node: &Node) -> Option<&str> {
    match &node.content {
        Content::Scalar(text) => Some(text),
        _ => None,
    }
}

/// Parameters that are a list of names, none with a value, as the map that they may also be written as.
fn parameters_as_map(root: &mut Node) {
    let Content::Map(entries) = &mut root.content else { return };
    let Some((_, node)) = entries.iter_mut().find(|(key, _)| key.text == "parameters") else { return };
    let Content::List(items) = &node.content else { return };
    if items.iter().all(|item| word(item).is_some()) {
        let key = |item: &Node| Some(Key { span: item.span, text: word(item)?.to_owned() });
        let entry = |item: &Node| Some((key(item)?, Node { span: item.span, content: Content::Null }));
        node.content = Content::Map(items.iter().filter_map(entry).collect());
    }
}

/// Replaces a value, or adds it beside the others.
fn put(node: &mut Node, path: &[Key], value: Node) -> Result<(), Diagnostic> {
    let [key, rest @ ..] = path else {
        *node = value;
        return Ok(());
    };
    match &mut node.content {
        Content::Map(entries) => {
            if let Some((_, node)) = entries.iter_mut().find(|(known, _)| known.text == key.text) {
                return put(node, rest, value);
            }
            let mut node = Node { span: key.span, content: Content::Map(Vec::new()) };
            put(&mut node, rest, value)?;
            entries.push((Key { span: key.span, text: key.text.clone() }, node));
            Ok(())
        }
        Content::Null => {
            node.content = Content::Map(Vec::new());
            put(node, path, value)
        }
        Content::Broken => Ok(()),
        Content::Scalar(_) | Content::List(_) => {
            let message = format!("there is no {} in a single value or a list", quoted(&key.text));
            let diagnostic = Diagnostic::error(Code::WrongShape, key.span, message);
            Err(diagnostic.also(node.span, "this is it").help("set the whole of it, as `--set 'observer.gain=[1, 2]'`"))
        }
    }
}

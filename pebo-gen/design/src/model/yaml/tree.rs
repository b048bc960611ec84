//! A YAML text as a tree with spans.
//!
//! In: a source. Out: a [`Node`] of bounded size and depth, without anchors, aliases, tags, further
//! documents and duplicate keys, each of which gets its diagnostic here.

use std::collections::HashMap;

use granit_parser::{Event, Parser, ScalarStyle, StructureStyle};

use super::refusal;
use crate::source::{Diagnostic, Diagnostics, Source, Span};

/// Most levels of lists, and of maps. The schema needs five.
const NESTING_LIMIT: usize = 32;

/// Most scalars, lists and maps in one file.
const NODE_LIMIT: usize = 20_000;

/// A value and its span.
#[derive(Debug)]
pub(crate) struct Node {
    pub(crate) span: Span,
    pub(crate) content: Content,
}

/// The next thing that a map expects.
enum Pending {
    /// A key.
    Key,
    /// The value of this key.
    Value(Key),
    /// The value of a key that was refused.
    Discard,
}

/// The content of a node.
#[derive(Debug)]
pub(crate) enum Content {
    /// Nothing, or a plain `null` or `~`.
    Null,
    Scalar(String),
    List(Vec<Node>),
    Map(Vec<(Key, Node)>),
    /// Something whose diagnostic is out already.
    Broken,
}

/// A key of a map and its span.
#[derive(Debug)]
pub(crate) struct Key {
    pub(super) span: Span,
    pub(super) text: String,
}

/// Grows the tree of the file in `source`; nothing if it is no single YAML document.
pub(super) fn grow(source: &Source, diagnostics: &mut Diagnostics) -> Option<Node> {
    grow_part(source, Span::new(0, source.text().len()), refusal::empty(), diagnostics)
}

/// The same of a range of the text, with the diagnostic for an empty one.
pub(super) fn grow_part(source: &Source, part: Span, empty: Diagnostic, diagnostics: &mut Diagnostics) -> Option<Node> {
    let options = granit_parser::options! {
        disallow_directives: true,
        emit_unresolved_aliases: true,
        emit_comments: false,
        flow_nesting_limit: NESTING_LIMIT,
        block_nesting_limit: NESTING_LIMIT,
    };
    let mut grower = Grower { source, diagnostics, frames: Vec::new(), root: None, nodes: 0 };
    for event in Parser::new_from_str_with_options(source.slice(part), options) {
        let accepted = match event {
            Ok((event, span)) => {
                let range = span.byte_range().unwrap_or_default();
                let span = Span::new(part.start + range.start, part.start + range.end);
                grower.accept(event, span)
            }
            Err(error) => Err(refusal::syntax(&error, part.start)),
        };
        if let Err(diagnostic) = accepted {
            grower.diagnostics.push(diagnostic);
            return None;
        }
    }
    let root = grower.root;
    if root.is_none() {
        diagnostics.push(empty);
    }
    root
}

struct Grower<'a> {
    source: &'a Source,
    diagnostics: &'a mut Diagnostics,
    /// The lists and maps that are open, outermost first.
    frames: Vec<Frame>,
    root: Option<Node>,
    nodes: usize,
}

/// An open list or map.
struct Frame {
    span: Span,
    flow: bool,
    growth: Growth,
    /// Scalars up to this byte belong to a formula that a comma has cut; see [`cut_formula`].
    skip_to: Option<usize>,
}

enum Growth {
    List(Vec<Node>),
    Map { entries: Vec<(Key, Node)>, seen: HashMap<String, Span>, pending: Pending },
}

impl Grower<'_> {
    /// Takes in one event; an error ends the growth.
    fn accept(&mut self, event: Event<'_>, span: Span) -> Result<(), Diagnostic> {
        if event.is_node() {
            self.nodes += 1;
            if self.nodes > NODE_LIMIT {
                return Err(refusal::too_many(span, NODE_LIMIT));
            }
        }
        if event.anchor_id().is_some() || event.tag().is_some() {
            let help = "remove it; put a formula in quotes if it begins with `&` or `!`";
            self.diagnostics.push(refusal::feature(span, "anchors and tags", help));
        }
        match event {
            Event::DocumentStart(..) if self.root.is_some() => {
                let help = "put each model into a file of its own";
                return Err(refusal::feature(span, "a second document", help));
            }
            Event::Alias(_) | Event::UnresolvedAlias(_) => {
                self.diagnostics.push(refusal::alias(span, self.source.slice(span)));
                self.attach(Node { span, content: Content::Broken });
            }
            Event::Scalar(text, style, ..) => self.scalar(text.into_owned(), style, span),
            Event::SequenceStart(style, ..) => self.open(style, span, Growth::List(Vec::new())),
            Event::MappingStart(style, ..) => {
                let growth = Growth::Map { entries: Vec::new(), seen: HashMap::new(), pending: Pending::Key };
                self.open(style, span, growth);
            }
            Event::SequenceEnd | Event::MappingEnd => self.close(span),
            _ => {}
        }
        Ok(())
    }

    fn open(&mut self, style: StructureStyle, span: Span, growth: Growth) {
        let flow = style == StructureStyle::Flow;
        self.frames.push(Frame { span, flow, growth, skip_to: None });
    }

    fn close(&mut self, end: Span) {
        let Some(frame) = self.frames.pop() else { return };
        let (content, last) = match frame.growth {
            Growth::List(items) => {
                let last = items.last().map(|item| item.span);
                (Content::List(items), last)
            }
            Growth::Map { entries, .. } => {
                let last = entries.last().map(|(_, value)| value.span);
                (Content::Map(entries), last)
            }
        };
        // The event after a block ends it.
        let end = if frame.flow { end } else { last.unwrap_or(frame.span) };
        self.attach(Node { span: frame.span.to(end), content });
    }

    fn scalar(&mut self, text: String, style: ScalarStyle, span: Span) {
        let plain = style == ScalarStyle::Plain;
        if let Some(frame) = self.frames.last_mut() {
            if frame.skip_to.is_some_and(|end| span.start <= end) {
                return;
            }
            if let Growth::Map { pending: pending @ Pending::Key, .. } = &mut frame.growth {
                *pending = Pending::Value(Key { span, text });
                return;
            }
            if plain
                && frame.flow
                && let Some(cut) = cut_formula(self.source, span)
            {
                frame.skip_to = Some(cut.end);
                self.diagnostics.push(refusal::cut(cut, self.source.slice(cut)));
                return self.attach(Node { span: cut, content: Content::Broken });
            }
        }
        let null = plain && matches!(text.as_str(), "" | "~" | "null" | "Null" | "NULL");
        let content = if null { Content::Null } else { Content::Scalar(text) };
        self.attach(Node { span, content });
    }

    /// Puts a complete value where it belongs.
    fn attach(&mut self, node: Node) {
        let Some(frame) = self.frames.last_mut() else {
            self.root = Some(node);
            return;
        };
        match &mut frame.growth {
            Growth::List(items) => items.push(node),
            Growth::Map { entries, seen, pending } => match std::mem::replace(pending, Pending::Key) {
                Pending::Key => {
                    self.diagnostics.push(refusal::key(node.span));
                    *pending = Pending::Discard;
                }
                Pending::Discard => {}
                Pending::Value(key) => {
                    if let Some(first) = seen.insert(key.text.clone(), key.span) {
                        self.diagnostics.push(refusal::duplicate(&key.text, key.span, first));
                    } else {
                        entries.push((key, node));
                    }
                }
            },
        }
    }
}

/// Characters to look for the end of a formula that a comma has cut. Hostile input has a candidate at every comma.
const CUT_LIMIT: usize = 1024;

/// The span of a formula that a comma has cut; its first piece is at `span`.
///
/// `{q: atan2(a, b)/n}` is YAML for q: "atan2(a" and "b)/n": nothing. It is the most natural slip
/// of all, so it gets a diagnostic of its own instead of three strange ones.
fn cut_formula(source: &Source, span: Span) -> Option<Span> {
    let mut depth = 0_usize;
    let mut commas = 0;
    let text = source.slice(Span::new(span.start, usize::MAX));
    for (at, character) in text.char_indices().take(CUT_LIMIT) {
        match character {
            '(' => depth += 1,
            ')' => depth = depth.checked_sub(1)?,
            ',' if depth > 0 => commas += 1,
            ',' | ']' | '}' if depth == 0 => {
                let formula = text[..at].trim_end();
                return (commas > 0).then(|| Span::new(span.start, span.start + formula.len()));
            }
            '[' | ']' | '{' | '}' | '"' | '\'' | '#' | '\n' => return None,
            _ => {}
        }
    }
    None
}

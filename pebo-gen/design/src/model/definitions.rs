//! Definitions in the order of their use: each after the ones that it needs.
//!
//! In: named formulas in any order. Out: their order, or the circles in which they need one another. A file may name a
//! formula before the formulas in it, as a text does.

use std::collections::HashMap;

use super::formula::Formula;
use super::spanned::{Entry, Spanned};
use crate::source::{Code, Diagnostic, listed, quoted};

/// More spans of a circle than these make its diagnostic unreadable.
const MOST_SPANS: usize = 8;

/// An order of definitions, each after the ones that it uses, and the circles that have none.
///
/// Definitions that do not depend on one another keep their order.
pub(super) struct Order {
    /// Indices in the list, including the definitions of a circle.
    pub(super) positions: Vec<usize>,
    /// Each circle once, each definition of it before the one that it uses.
    pub(super) circles: Vec<Vec<usize>>,
}

/// The progress of the search at a definition.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Mark {
    New,
    Open,
    Done,
}

impl Order {
    pub(super) fn of(definitions: &[Entry<Formula>]) -> Self {
        let indices: HashMap<&str, usize> =
            definitions.iter().enumerate().map(|(index, entry)| (entry.name.value.as_str(), index)).collect();
        let uses = |index: usize| -> Vec<usize> {
            let names = definitions[index].value.names();
            // The last of them is looked at first.
            names.iter().rev().filter_map(|(name, _)| indices.get(name).copied()).collect()
        };
        let mut order = Self { positions: Vec::with_capacity(definitions.len()), circles: Vec::new() };
        let mut marks = vec![Mark::New; definitions.len()];
        for first in 0..definitions.len() {
            if marks[first] != Mark::New {
                continue;
            }
            marks[first] = Mark::Open;
            // A chain of definitions may be as long as the file: the path is on the heap.
            let mut path = vec![(first, uses(first))];
            while let Some((index, waiting)) = path.last_mut() {
                let index = *index;
                match waiting.pop() {
                    Some(next) if marks[next] == Mark::New => {
                        marks[next] = Mark::Open;
                        path.push((next, uses(next)));
                    }
                    Some(next) if marks[next] == Mark::Open => {
                        let circle = path.iter().map(|(open, _)| *open).skip_while(|open| *open != next);
                        order.circles.push(circle.collect());
                    }
                    Some(_) => {}
                    None => {
                        marks[index] = Mark::Done;
                        order.positions.push(index);
                        path.pop();
                    }
                }
            }
        }
        order
    }
}

/// The definitions in an order in which each uses only earlier ones, if there is one.
pub(super) fn sorted(definitions: Vec<Entry<Formula>>) -> Vec<Entry<Formula>> {
    let order = Order::of(&definitions);
    let mut waiting: Vec<Option<Entry<Formula>>> = definitions.into_iter().map(Some).collect();
    order.positions.into_iter().filter_map(|index| waiting[index].take()).collect()
}

/// A diagnostic for each circle of definitions.
pub(super) fn circles(definitions: &[Entry<Formula>]) -> Vec<Diagnostic> {
    let order = Order::of(definitions);
    let names = |circle: &Vec<usize>| circle.iter().map(|index| &definitions[*index].name).collect::<Vec<_>>();
    order.circles.iter().map(|circle| refusal(&names(circle))).collect()
}

fn refusal(circle: &[&Spanned<String>]) -> Diagnostic {
    let name = |at: usize| quoted(&circle[at % circle.len()].value);
    let message = match circle.len() {
        1 => format!("{} is defined by itself", name(0)),
        _ => format!("{} are defined by one another", listed(circle.iter().map(|name| name.value.as_str()))),
    };
    let uses = |at: usize| format!("uses {}", name(at + 1));
    let diagnostic = Diagnostic::error(Code::CircularDefinition, circle[0].span, message).label(uses(0));
    let others = circle.iter().enumerate().skip(1).take(MOST_SPANS);
    let diagnostic = others.fold(diagnostic, |diagnostic, (at, name)| diagnostic.also(name.span, uses(at)));
    diagnostic.help("define one of them by declared quantities, or declare it as a parameter or state")
}

#[cfg(all(test, feature = "yaml"))]
mod tests {
    use super::*;
    use crate::model::Model;
    use crate::source::Source;

    fn parse(define: &str) -> Result<Vec<String>, Vec<Diagnostic>> {
        let rest = "x: [x]\ny: [y]\nf_x: {x: y}\nf_y: {y: x}\nphi: [x]";
        let source = Source::new("m", format!("model: m\n{rest}\ndefine: {define}\n").as_str()).expect("a text");
        let model = Model::parse(&source)?;
        Ok(model.define.into_iter().map(|entry| entry.name.value).collect())
    }

    #[test]
    fn definitions_follow_the_ones_they_use_and_else_keep_their_order() {
        for (written, expected) in [
            ("{a: b, b: y^2}", vec!["b", "a"]),
            ("{a: y, b: y, c: y}", vec!["a", "b", "c"]),
            ("{a: b + c, b: d, c: d, d: y}", vec!["d", "b", "c", "a"]),
            ("{a: sin(b)^2 + b, b: y}", vec!["b", "a"]),
        ] {
            assert_eq!(parse(written).expect(written), expected, "{written}");
        }
    }

    #[test]
    fn a_circle_is_refused_once_with_its_names() {
        for (written, expected) in [
            ("{a: a + 1}", vec!["`a` is defined by itself"]),
            ("{a: b, b: a}", vec!["`a`, `b` are defined by one another"]),
            (
                "{e: a, a: y*b, b: c, c: 1 - a, d: d}",
                vec!["`a`, `b`, `c` are defined by one another", "`d` is defined by itself"],
            ),
            // A name of the language is the author's own where it is declared.
            ("{pi: 2*pi}", vec!["`pi` is defined by itself"]),
        ] {
            let refused = parse(written).expect_err(written);
            let messages: Vec<&str> = refused.iter().map(|diagnostic| &*diagnostic.message).collect();
            assert_eq!(messages, expected, "{written}");
            assert!(refused.iter().all(|diagnostic| diagnostic.code == Code::CircularDefinition), "{written}");
        }
    }

    #[test]
    fn a_long_chain_is_followed_on_the_heap() {
        const LINKS: usize = 2000;
        let mut define: Vec<String> = (1..LINKS).map(|i| format!("d{i}: d{} + 1", i + 1)).collect();
        define.push(format!("d{LINKS}: y"));
        let order = parse(&format!("{{{}}}", define.join(", "))).expect("it is right");
        assert_eq!(order.first().map(String::as_str), Some(format!("d{LINKS}").as_str()));
    }
}

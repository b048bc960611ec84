//! Names for subexpressions of long formulas, so that people can read them.
//!
//! In: all formulas of the documentation. Out: names for subexpressions that occur several times, and for those that
//! would fill lines by themselves. Short formulas need none.

use rustc_hash::FxHashMap;

use pebo_cas::{Arena, Expr, Node, Symbol};

/// If no formula has more characters, none is abbreviated.
const LONG: usize = 240;

/// A subexpression with more characters is named wherever it occurs,
const WIDE: usize = 120;

/// and one with more than these if it occurs several times.
const SHARED: usize = 16;

/// Letters that numbered names may begin with, in the order in which they are tried.
const LETTERS: [&str; 6] = ["a", "b", "c", "d", "e", "part"];

/// Parts with their names.
#[derive(Debug, Default)]
pub(in crate::emit) struct Abbreviations {
    /// In the order of their use: each names earlier ones alone.
    parts: Vec<(Symbol, Expr)>,
    short: FxHashMap<Expr, Expr>,
}

impl Abbreviations {
    /// Those of the formulas.
    pub(in crate::emit) fn of(arena: &Arena, formulas: &[Expr]) -> Self {
        if formulas.iter().all(|formula| length(arena, *formula) <= LONG) {
            return Self::default();
        }
        let nodes = arena.postorder(formulas);
        let mut uses: FxHashMap<Expr, usize> = FxHashMap::default();
        for used in nodes.iter().flat_map(|node| arena.operands(*node)).chain(formulas.iter().copied()) {
            *uses.entry(used).or_insert(0) += 1;
        }
        let letter = letter(arena, formulas);
        let mut found = Self::default();
        for node in nodes {
            let opposite = found.short.get(&arena.neg(node)).filter(|short| arena.as_symbol(**short).is_some());
            if let Some(&opposite) = opposite {
                found.short.insert(node, arena.neg(opposite));
                continue;
            }
            let mut short = arena.rebuild(node, &found.short);
            let is_made = matches!(arena.node(short), Node::Sum(_) | Node::Product(_) | Node::Call(..));
            let is_shared = uses[&node] > 1 && !is_monomial(arena, short);
            let longest = if is_shared { SHARED } else { WIDE };
            if is_made && length(arena, short) > longest {
                let name = arena.generated(&format!("{letter}{}", found.parts.len() + 1));
                found.parts.push((name, short));
                short = arena.of_symbol(name);
            }
            found.short.insert(node, short);
        }
        found
    }

    /// A formula with its parts by name.
    pub(in crate::emit) fn print(&self, arena: &Arena, formula: Expr) -> String {
        arena.print(self.short.get(&formula).copied().unwrap_or(formula))
    }

    /// The definition of a formula that has a name itself.
    pub(in crate::emit) fn defined(&self, arena: &Arena, formula: Expr) -> String {
        let short = self.short.get(&formula).copied().unwrap_or(formula);
        let part = self.parts.iter().find(|(name, _)| Some(*name) == arena.as_symbol(short));
        arena.print(part.map_or(short, |part| part.1))
    }

    /// The definition of each name.
    pub(in crate::emit) fn lines(&self, arena: &Arena) -> Vec<String> {
        self.parts.iter().map(|(name, part)| format!("{} = {}", arena.name(*name), arena.print(*part))).collect()
    }
}

fn length(arena: &Arena, formula: Expr) -> usize {
    arena.print(formula).chars().count()
}

/// It is a product of powers of symbols: short enough anywhere.
fn is_monomial(arena: &Arena, expr: Expr) -> bool {
    matches!(arena.node(expr), Node::Product(product)
        if product.factors.iter().all(|(base, _)| arena.as_symbol(*base).is_some()))
}

/// A letter with which, and a number, no symbol of the formulas is called.
fn letter(arena: &Arena, formulas: &[Expr]) -> &'static str {
    let names: Vec<String> = arena.symbols_of(formulas).into_iter().map(|symbol| arena.name(symbol)).collect();
    let is_free = |letter: &&str| {
        let numbered = |name: &String| {
            name.strip_prefix(letter).is_some_and(|rest| !rest.is_empty() && rest.chars().all(|c| c.is_ascii_digit()))
        };
        !names.iter().any(numbered)
    };
    LETTERS.into_iter().find(is_free).unwrap_or("part_")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_long_formulas_share_has_a_name() {
        let arena = Arena::new();
        let sum = |names: &[&str]| arena.sum(names.iter().map(|name| arena.variable(name)));
        let shared = sum(&["alpha_first", "beta_second", "gamma_third"]);
        let other = sum(&["a1", "delta"]);
        let powers = (2..20).map(|k: i64| arena.mul(arena.power(other, &k.into()), shared));
        let long = arena.sum(powers);
        let short = arena.mul(shared, arena.variable("delta"));
        assert!(Abbreviations::of(&arena, &[short]).lines(&arena).is_empty());
        let found = Abbreviations::of(&arena, &[long, short]);
        // The author has an a1.
        assert_eq!(found.lines(&arena)[0], "b1 = alpha_first + beta_second + gamma_third");
        assert_eq!(found.print(&arena, short), "delta*b1");
        assert_eq!((found.print(&arena, shared).as_str(), found.defined(&arena, shared)), ("b1", arena.print(shared)));
        let long = found.defined(&arena, long);
        assert!(long.contains("b1") && !long.contains("alpha_first"), "{long}");
    }
}

//! Formulas of a plant as elements of `MathML`, and the steps of a derivation in one table.

use std::cell::Cell;
use std::collections::BTreeMap;

use pebo_cas::print::mathml::escaped;
use pebo_cas::{Arena, Expr, Relation, Symbol};

/// The length of the longest formula that is set: some thousand names, more than anybody reads.
const MOST_OF_FORMULA: usize = 100_000;

/// The length of all formulas of one page, with a browser in mind.
const MOST_OF_PAGE: usize = 4_000_000;

/// The text in place of a longer formula.
pub(super) const LEFT_OUT: &str = "<mtext>(too long for a page: pebo-gen check --format json has it)</mtext>";

/// Sets the formulas of one page.
#[derive(Debug)]
pub(super) struct Setter<'a> {
    pub(super) arena: &'a Arena,
    /// The length left to formulas of this page.
    left: Cell<usize>,
}

impl<'a> Setter<'a> {
    pub(super) fn new(arena: &'a Arena) -> Self {
        Self { arena, left: Cell::new(MOST_OF_PAGE) }
    }

    pub(super) fn expr(&self, expr: Expr) -> String {
        self.put(expr, &BTreeMap::new())
    }

    /// A formula with symbols replaced as they are, nothing simplified.
    pub(super) fn put(&self, expr: Expr, shown: &BTreeMap<Symbol, Expr>) -> String {
        if self.left.get() == 0 {
            return LEFT_OUT.to_owned();
        }
        let elements = self.arena.mathml_elements(expr, shown);
        if elements.len() > MOST_OF_FORMULA {
            return LEFT_OUT.to_owned();
        }
        self.left.set(self.left.get().saturating_sub(elements.len()));
        elements
    }

    pub(super) fn symbol(&self, symbol: Symbol) -> String {
        self.expr(self.arena.of_symbol(symbol))
    }

    /// The rate of a signal.
    pub(super) fn rate(&self, symbol: Symbol) -> String {
        self.arena.mathml_rate(symbol)
    }

    /// Names with commas between them.
    pub(super) fn symbols(&self, symbols: &[Symbol]) -> String {
        symbols.iter().map(|symbol| self.symbol(*symbol)).collect::<Vec<_>>().join("<mo>,</mo>")
    }

    pub(super) fn matrix(&self, rows: &[Vec<Expr>]) -> String {
        bracketed(rows.iter().map(|row| row.iter().map(|entry| self.expr(*entry)).collect()))
    }

    pub(super) fn column(&self, entries: &[Expr]) -> String {
        bracketed(entries.iter().map(|entry| vec![self.expr(*entry)]))
    }

    /// `known + [factor] unknown + ..`, without zero terms.
    pub(super) fn affine(&self, known: Expr, factors: &[Expr], unknowns: &[Symbol]) -> String {
        let terms = factors.iter().zip(unknowns).filter(|(factor, _)| !self.arena.is_zero(**factor));
        let mut parts: Vec<String> = Vec::new();
        if !self.arena.is_zero(known) {
            parts.push(self.expr(known));
        }
        parts.extend(terms.map(|(factor, unknown)| {
            let unknown = self.symbol(*unknown);
            match self.arena.as_number(*factor) {
                Some(one) if one.is_one() => unknown,
                _ => format!("<mrow><mo>[</mo>{}<mo>]</mo></mrow>{unknown}", self.expr(*factor)),
            }
        }));
        sum(&parts)
    }

    /// A comparison with zero.
    pub(super) fn compared(&self, expr: Expr, relation: Relation) -> String {
        let sign = match relation {
            Relation::Positive => "&gt;",
            Relation::NonNegative => "≥",
            Relation::NonZero => "≠",
        };
        format!("{}<mo>{sign}</mo><mn>0</mn>", self.expr(expr))
    }
}

fn bracketed(rows: impl Iterator<Item = Vec<String>>) -> String {
    let mut elements = "<mrow><mo>[</mo><mtable displaystyle=\"true\">".to_owned();
    for row in rows {
        elements.push_str("<mtr>");
        for entry in row {
            elements.extend(["<mtd>", &entry, "</mtd>"]);
        }
        elements.push_str("</mtr>");
    }
    elements + "</mtable><mo>]</mo></mrow>"
}

/// Summands beside one another as they are, nothing collected or cancelled.
pub(super) fn sum(summands: &[String]) -> String {
    let mut elements = String::new();
    for summand in summands {
        if !elements.is_empty() && !summand.starts_with("<mo>−</mo>") {
            elements.push_str("<mo>+</mo>");
        }
        elements.push_str(summand);
    }
    if elements.is_empty() { "<mn>0</mn>".to_owned() } else { elements }
}

/// Equations aligned at their equals signs. An empty left side continues the line above; the text behind an equation is
/// its reason.
#[derive(Debug, Default)]
pub(super) struct Steps {
    rows: String,
}

impl Steps {
    pub(super) fn add(&mut self, left: &str, right: &str, reason: &str) {
        let reason = if reason.is_empty() { String::new() } else { format!("<mtext>{}</mtext>", escaped(reason)) };
        let [left, equals, right, why] = [("left", left), ("equals", "<mo>=</mo>"), ("right", right), ("why", &reason)]
            .map(|(class, content)| format!("<mtd class=\"{class}\">{content}</mtd>"));
        self.rows.extend(["<mtr>", &left, &equals, &right, &why, "</mtr>\n"]);
    }

    /// The table of all steps.
    pub(super) fn finish(self) -> String {
        format!("<mtable displaystyle=\"true\" class=\"steps\">\n{}</mtable>", self.rows)
    }
}

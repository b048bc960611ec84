//! Points that refute a claim, as a reader would say them.

use std::collections::BTreeSet;

use pebo_cas::graph::enclosure::Point;
use pebo_cas::linear::contrast::Contrast;
use pebo_cas::{Arena, Expr, Symbol};

use super::design::{Comparison, Witness};

/// A longer formula is cut in a sentence: its value counts there.
const MOST_CHARACTERS: usize = 300;

impl Witness {
    /// The witness of the zero test, for a report.
    pub(super) fn of(expr: Expr, witness: &pebo_cas::domain::zero::Witness) -> Self {
        let bounds = (witness.value.lo(), witness.value.hi());
        Self { expr, point: coordinates(&witness.point), bounds, compared: None }
    }

    /// The witness as a sentence for a reader: `-G*v4/C4` is about 9 where C4 = 1, ..
    pub fn sentence(&self, arena: &Arena) -> String {
        let printed = arena.print(self.expr);
        let start: String = printed.chars().take(MOST_CHARACTERS).collect();
        let cut = if start.len() < printed.len() { " .." } else { "" };
        let what = format!("`{start}{cut}`");
        let place = match self.point.as_slice() {
            [] => "everywhere".to_owned(),
            point => format!("where {}", values(arena, point)),
        };
        format!("{what} is {} {place}", about(self.bounds))
    }
}

impl Comparison {
    /// Points that agree in all but x, with the values of an expression there.
    pub(super) fn of([expr, read]: [Expr; 2], contrast: &Contrast, x: &BTreeSet<Symbol>) -> Self {
        let (mut points, mut known) = (Vec::new(), Vec::new());
        for point in &contrast.points {
            let (own, shared) = coordinates(point).into_iter().partition(|(symbol, _)| x.contains(symbol));
            points.push(own);
            known = shared;
        }
        let values = contrast.values.iter().map(|value| (value.lo(), value.hi())).collect();
        Self { expr, read, points, known, values }
    }

    /// z1' is about 2 at p = 1, 0 at p = 0, with the same u = 1; `what` names the compared value.
    pub(super) fn sentence(&self, arena: &Arena, what: &str) -> String {
        let places: Vec<String> =
            self.places(arena).zip(&self.values).map(|(at, v)| format!("{} {at}", about(*v))).collect();
        format!("{what} is {}{}", places.join(", "), self.with_the_same(arena))
    }

    fn places<'a>(&'a self, arena: &'a Arena) -> impl Iterator<Item = String> + 'a {
        self.points.iter().map(|point| format!("at {}", values(arena, point)))
    }

    /// The shared values of the symbols that the expression reads.
    fn with_the_same(&self, arena: &Arena) -> String {
        let read = arena.symbols_of(&[self.read]);
        let shared: Vec<_> = self.known.iter().filter(|(symbol, _)| read.contains(symbol)).copied().collect();
        if shared.is_empty() { String::new() } else { format!(", with the same {}", values(arena, &shared)) }
    }
}

fn coordinates(point: &Point) -> Vec<(Symbol, Expr)> {
    point.iter().map(|(symbol, value)| (*symbol, *value)).collect()
}

/// `a = 1, b = 2/3`
fn values(arena: &Arena, point: &[(Symbol, Expr)]) -> String {
    let entry = |(s, v): &(Symbol, Expr)| format!("{} = {}", arena.name(*s), arena.print(*v));
    point.iter().map(entry).collect::<Vec<_>>().join(", ")
}

/// The bounds of a value in words: bounds that agree to nine digits read better as one number.
fn about((low, high): (f64, f64)) -> String {
    if low == 0.0 && high == 0.0 {
        "0".to_owned()
    } else if (high - low).abs() <= 1e-9 * low.abs().max(high.abs()) {
        format!("about {}", short(low))
    } else {
        format!("between {} and {}", short(low), short(high))
    }
}

/// A few significant digits.
fn short(value: f64) -> String {
    let size = value.abs();
    if size == 0.0 {
        "0".to_owned()
    } else if (1e-3..1e6).contains(&size) {
        format!("{}", (value * 1e6).round() / 1e6)
    } else {
        format!("{value:.4e}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_printed_as_a_reader_would_write_them() {
        assert_eq!(about((0.0, 0.0)), "0");
        assert_eq!(about((9.0, 9.0)), "about 9");
        assert_eq!(about((-1.0, 0.0)), "between -1 and 0");
        assert_eq!(about((0.0, 2e-4)), "between 0 and 2.0000e-4");
        assert_eq!([1.0 / 3.0, 1234.5, 1e-3].map(short), ["0.333333", "1234.5", "0.001"]);
        assert_eq!([1_234_567.0, -5e-4].map(short), ["1.2346e6", "-5.0000e-4"]);
    }

    #[test]
    fn only_a_long_formula_is_cut() {
        let arena = Arena::new();
        let said = |name: &str| {
            let expr = arena.variable(name);
            Witness { expr, point: Vec::new(), bounds: (9.0, 9.0), compared: None }.sentence(&arena)
        };
        assert!(said("x").starts_with("`x` "), "{}", said("x"));
        let long = "x".repeat(MOST_CHARACTERS + 1);
        assert!(said(&long).starts_with(&format!("`{} ..` ", "x".repeat(MOST_CHARACTERS))), "{}", said(&long));
    }
}

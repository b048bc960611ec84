//! The parts of a domain on each of which formulas are analytic.
//!
//! In: a domain, and formulas with absolute values, signs, least and greatest values. Out: the domain divided by the signs of
//! what stands under these. What is seen at a point of a part holds almost everywhere in that part, and need not in another:
//! `q + |q|` is no zero, and vanishes wherever q is negative.

use super::Arena;
use super::domain::Domain;
use super::expr::{Expr, Node};
use super::facts::Relation;
use super::field::Obstacle;
use super::function::Function;

/// Parts that are looked at one by one.
const MOST_PARTS: usize = 16;

/// A part of a domain.
#[derive(Clone, Debug)]
pub(crate) struct Part {
    /// The points of the part.
    pub(crate) domain: Domain,
    /// What divides it from the others, and whether that is positive or negative in this part.
    pub(crate) sides: Vec<(Expr, Side)>,
}

/// The sign of what divides.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Side {
    /// `> 0`
    Positive,
    /// `< 0`
    Negative,
}

impl Side {
    /// As a formula writes it.
    pub fn sign(self) -> &'static str {
        match self {
            Self::Positive => "> 0",
            Self::Negative => "< 0",
        }
    }
}

impl Domain {
    /// The parts on which the formulas are analytic in what varies; one, if they are so everywhere. An obstacle, where there
    /// are too many or it is open whether one of them has points.
    pub(crate) fn parts(
        &self,
        arena: &Arena,
        exprs: &[Expr],
        varies: impl Fn(Expr) -> bool,
    ) -> Result<Vec<Part>, Obstacle> {
        let mut parts = vec![Part { domain: self.clone(), sides: Vec::new() }];
        for divisor in arena.dividers(exprs).into_iter().filter(|divisor| varies(*divisor)) {
            let mut finer = Vec::new();
            for part in parts {
                finer.extend(part.divided(arena, divisor)?);
            }
            if finer.len() > MOST_PARTS {
                return Err(Obstacle::TooLarge);
            }
            parts = finer;
        }
        Ok(parts)
    }
}

impl Part {
    /// What of the part is on either side.
    fn divided(self, arena: &Arena, divisor: Expr) -> Result<Vec<Self>, Obstacle> {
        let sides = [(Side::Positive, divisor), (Side::Negative, arena.neg(divisor))];
        if sides.iter().any(|(_, positive)| self.domain.implies(arena, *positive, Relation::NonNegative)) {
            return Ok(vec![self]);
        }
        let one = |(side, positive): (Side, Expr)| {
            let mut part = self.clone();
            part.domain.facts.assume(positive, Relation::Positive);
            part.sides.push((divisor, side));
            let met = part.domain.points(arena, &[divisor]).next().is_some();
            if met { Ok(part) } else { Err(Obstacle::NoPoint) }
        };
        sides.into_iter().map(one).collect()
    }
}

impl Arena {
    /// What stands under absolute values, also where these are written as other functions: where it passes zero, formulas
    /// bend or jump.
    pub(crate) fn dividers(&self, exprs: &[Expr]) -> Vec<Expr> {
        let mut found = Vec::new();
        let mut open = exprs.to_vec();
        while !open.is_empty() {
            let nodes = self.postorder(&std::mem::take(&mut open));
            for node in nodes {
                let Node::Call(function, arguments) = self.node(node) else { continue };
                match function.row().in_terms {
                    Some(in_terms) => open.push(in_terms(self, &arguments)),
                    None if function == Function::Abs && !found.contains(&arguments[0]) => found.push(arguments[0]),
                    None => {}
                }
            }
        }
        found
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parts(assumed: &[fn(&Arena, Expr) -> Expr], formula: fn(&Arena, [Expr; 2]) -> Expr) -> Vec<String> {
        let arena = Arena::new();
        let [a, b] = ["a", "b"].map(|name| arena.variable(name));
        let mut domain = Domain::default();
        for fact in assumed {
            domain.facts.assume(fact(&arena, b), Relation::Positive);
        }
        let shown = |part: Part| {
            let sides = part.sides.iter().map(|(divisor, side)| format!("{} {}", arena.print(*divisor), side.sign()));
            sides.collect::<Vec<_>>().join(", ")
        };
        domain.parts(&arena, &[formula(&arena, [a, b])], |_| true).unwrap().into_iter().map(shown).collect()
    }

    #[test]
    fn a_domain_is_divided_where_formulas_bend_and_has_points_on_both_sides() {
        let size = |arena: &Arena, [a, b]: [Expr; 2]| arena.add(a, arena.call(Function::Abs, &[b]));
        assert_eq!(parts(&[], |arena, [a, b]| arena.mul(a, arena.call(Function::Sin, &[b]))), [""]);
        assert_eq!(parts(&[], size), ["b > 0", "b < 0"]);
        assert_eq!(parts(&[|arena, b| arena.sub(b, arena.one())], size), [""]);
        let both = |arena: &Arena, [a, b]: [Expr; 2]| {
            arena.mul(arena.call(Function::Sign, &[a]), arena.call(Function::Max, &[a, b]))
        };
        assert_eq!(parts(&[], both).len(), 4);
        // Three of four: a > 1 and a < -1 exclude each other.
        assert_eq!(parts(&[], |arena, [a, _]| arena.call(Function::Sat, &[a])).len(), 3);
    }
}

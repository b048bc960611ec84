//! Assumptions that cannot hold together.
//!
//! In: assumptions, and the values of parameters. Out: a diagnostic for an assumption that those values violate, for
//! two of which one bounds a quantity from below where the other bounds it from above, and for one whose opposite the
//! algebra derives from the others. Undetected contradictions leave the claims without a point of their domain, and
//! undecided.

use std::collections::BTreeMap;

use crate::source::{Code, Diagnostic, Diagnostics};
use pebo_cas::graph::enclosure::Point;
use pebo_cas::number::interval::Precision;
use pebo_cas::tower::Field;
use pebo_cas::{Arena, Domain, Expr, Node, Rational, Relation, Symbol};

use super::parts::{Assumption, Parameter};

/// Precision of the order of bounds; the reported comparison is decided by an enclosure as fine as necessary.
const PRECISION: u32 = 64;

/// A bound of a quantity: `quantity > value` or `quantity < value`, perhaps with equality.
#[derive(Clone, Copy)]
struct Bound {
    value: Expr,
    near: f64,
    strict: bool,
    by: Assumption,
}

/// The tightest bounds of a quantity.
#[derive(Default)]
struct Bounds {
    low: Option<Bound>,
    high: Option<Bound>,
}

/// Reports assumptions that no values satisfy.
pub(super) fn find(arena: &Arena, assumptions: &[Assumption], parameters: &[Parameter], problems: &mut Diagnostics) {
    let given = parameters.iter().filter_map(|p| Some((p.symbol, arena.number(p.value.clone()?))));
    let values: BTreeMap<_, _> = given.collect();
    let mut quantities: BTreeMap<Expr, Bounds> = BTreeMap::new();
    for assumption in assumptions {
        let expr = arena.substitute(assumption.expr, &values);
        if arena.symbols_of(&[expr]).is_empty() {
            if arena.fails_of_number((expr, assumption.relation)) {
                problems.push(violated(arena, assumption, parameters));
            }
        } else if assumption.relation != Relation::NonZero {
            let (quantity, slope, constant) = quantity(arena, expr);
            let Some(value) = slope.recip().map(|inverse| arena.scale(constant, &-&inverse)) else { continue };
            let Some(near) = arena.enclose(value, &Point::new(), Precision::new(PRECISION)) else { continue };
            let strict = assumption.relation == Relation::Positive;
            let bound = Bound { value, near: near.lo(), strict, by: *assumption };
            quantities.entry(quantity).or_default().tighten(bound, slope.is_negative());
        }
    }
    let mut is_reported = false;
    for (quantity, bounds) in &quantities {
        let (Some(low), Some(high)) = (bounds.low, bounds.high) else { continue };
        let relation = if low.strict || high.strict { Relation::Positive } else { Relation::NonNegative };
        if arena.fails_of_number((arena.sub(high.value, low.value), relation)) {
            problems.push(contradictory(arena, *quantity, &low, &high));
            is_reported = true;
        }
    }
    if !is_reported && let Some(assumption) = excluded(arena, assumptions, &values) {
        problems.push(impossible(arena, assumption, assumptions.len() == 1));
    }
}

/// An assumption whose opposite follows from the others, as `p^2 + q^2 < -1`.
fn excluded<'a>(
    arena: &Arena,
    assumptions: &'a [Assumption],
    values: &BTreeMap<Symbol, Expr>,
) -> Option<&'a Assumption> {
    let valued: Vec<Expr> = assumptions.iter().map(|a| arena.substitute(a.expr, values)).collect();
    (0..assumptions.len())
        .find(|&index| {
            let mut others = Domain::default();
            for (other, assumption) in assumptions.iter().enumerate().filter(|(other, _)| *other != index) {
                others.facts.assume(valued[other], assumption.relation);
            }
            let opposite = match assumptions[index].relation {
                Relation::Positive => Relation::NonNegative,
                Relation::NonNegative => Relation::Positive,
                Relation::NonZero => return vanishes(arena, &others, valued[index]),
            };
            !arena.symbols_of(&[valued[index]]).is_empty() && others.implies(arena, arena.neg(valued[index]), opposite)
        })
        .map(|index| &assumptions[index])
}

/// Tests whether the expression is zero throughout the domain by its normal form.
fn vanishes(arena: &Arena, domain: &Domain, expr: Expr) -> bool {
    let field = Field::over(arena, &domain.facts, &[expr]);
    field.and_then(|field| field.fraction(expr)).is_ok_and(|fraction| fraction.is_zero())
}

fn impossible(arena: &Arena, assumption: &Assumption, alone: bool) -> Diagnostic {
    let printed = format!("`{} {}`", arena.print(assumption.expr), assumption.relation.sign());
    let (message, label) = if alone {
        ("no values satisfy this assumption", format!("no values have {printed}"))
    } else {
        ("no values satisfy the assumptions together", format!("the other assumptions exclude {printed}"))
    };
    Diagnostic::error(Code::ContradictoryAssumptions, assumption.span, message).label(label).help("correct one of them")
}

impl Bounds {
    fn tighten(&mut self, bound: Bound, from_above: bool) {
        let (held, tighter): (_, fn(&Bound, &Bound) -> bool) = if from_above {
            (&mut self.high, |new, old| new.near < old.near)
        } else {
            (&mut self.low, |new, old| new.near > old.near)
        };
        if held.as_ref().is_none_or(|old| tighter(&bound, old) || (bound.strict && bound.value == old.value)) {
            *held = Some(bound);
        }
    }
}

/// The expression as `slope * quantity + constant`, the same quantity for all that differ in slope and constant.
fn quantity(arena: &Arena, expr: Expr) -> (Expr, Rational, Expr) {
    match arena.node(expr) {
        Node::Sum(sum) => {
            let free = |term: &Expr| arena.symbols_of(&[*term]).is_empty();
            let (constant, terms): (Vec<_>, Vec<_>) = sum.terms.iter().cloned().partition(|(term, _)| free(term));
            let constant = arena.combine(&sum.constant, constant);
            let Some(slope) = terms.first().map(|(_, slope)| slope.clone()) else {
                return (expr, Rational::ONE, arena.zero());
            };
            let Some(inverse) = slope.recip() else { return (expr, Rational::ONE, arena.zero()) };
            (arena.scale(arena.combine(&Rational::ZERO, terms), &inverse), slope, constant)
        }
        Node::Product(product) => {
            let bare = arena.multiply(&Rational::ONE, product.factors.iter().cloned());
            (bare, product.coefficient.clone(), arena.zero())
        }
        _ => (expr, Rational::ONE, arena.zero()),
    }
}

fn violated(arena: &Arena, assumption: &Assumption, parameters: &[Parameter]) -> Diagnostic {
    let diagnostic = Diagnostic::error(
        Code::ContradictoryAssumptions,
        assumption.span,
        "the model's own parameters violate this assumption",
    );
    let used = arena.symbols_of(&[assumption.expr]);
    let used = parameters.iter().filter(|parameter| used.contains(&parameter.symbol));
    used.fold(diagnostic, |diagnostic, parameter| diagnostic.also(parameter.span, "the value is given here"))
        .help("correct the value, or the assumption")
}

fn contradictory(arena: &Arena, quantity: Expr, low: &Bound, high: &Bound) -> Diagnostic {
    let than = |bound: &Bound, strict: &str, loose: &str| {
        format!(
            "this assumption requires `{} {} {}`",
            arena.print(quantity),
            if bound.strict { strict } else { loose },
            arena.print(bound.value)
        )
    };
    let (below, above) = (than(low, ">", ">="), than(high, "<", "<="));
    // The later of the two is the one that surprises.
    let ((first, one), (last, other)) =
        if low.by.span <= high.by.span { ((low, below), (high, above)) } else { ((high, above), (low, below)) };
    let diagnostic =
        Diagnostic::error(Code::ContradictoryAssumptions, last.by.span, "two assumptions cannot hold together")
            .label(other);
    if first.by.span == last.by.span { diagnostic.note(one) } else { diagnostic.also(first.by.span, one) }
        .help("correct one of them")
}

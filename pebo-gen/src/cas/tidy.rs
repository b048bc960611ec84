//! The shortest of several equal forms of a result, for people and for emitted code.
//!
//! A form counts only if it has a value wherever the result has: `sqrt(q) - 1` over `q - 1` does not stand for
//! `1/(1 + sqrt(q))`.

use std::collections::{BTreeMap, BTreeSet};

use rustc_hash::FxHashMap;

use super::asks::Want;
use super::domain::Domain;
use super::field::Field;
use super::oriented::Orientation;
use super::rational::Rational;
use super::zero::decide;
use super::{Arena, Expr, Node};

/// The shortest of an expression and the ways to write its normal form.
pub(crate) fn shortest(arena: &Arena, domain: &Domain, expr: Expr) -> Expr {
    shortest_turned(arena, &Orientation::new(arena, domain), expr)
}

/// As [`shortest`], of one of several expressions that are turned alike.
pub(crate) fn shortest_turned(arena: &Arena, orientation: &Orientation<'_>, expr: Expr) -> Expr {
    if is_shortest(arena, expr) {
        return expr;
    }
    let domain = orientation.domain();
    let normal = Field::over(arena, &domain.facts, &[expr]).and_then(|field| {
        let fraction = field.fraction(expr)?;
        Ok([Some(field.show(&fraction)), Some(field.show_apart(&fraction)), field.show_by_angles(&fraction)])
    });
    let forms = normal.into_iter().flatten().flatten();
    let turned = |form: Expr| [form, orientation.of(form)];
    let forms = [expr].into_iter().chain(forms).flat_map(turned);
    let own = functions(arena, &[expr]);
    forms.fold(expr, |best, form| {
        let kept = || functions(arena, &[form]).iter().all(|call| own.contains(call) || domain.written.contains(call));
        let shorter = operations(arena, form) < operations(arena, best) && kept() && divides_as(arena, expr, form);
        if shorter && asks_no_more(arena, domain, expr, form) { form } else { best }
    })
}

/// Whether no way to write the normal form is shorter: of a number, of a symbol, and of a sum of symbols with numbers for
/// factors unless one of these divides all others, so that it becomes one where it is taken out.
fn is_shortest(arena: &Arena, expr: Expr) -> bool {
    match arena.node(expr) {
        Node::Number(_) | Node::Symbol(_) => true,
        Node::Sum(sum) if sum.terms.iter().all(|(term, _)| arena.as_symbol(*term).is_some()) => {
            let least = sum.terms.iter().map(|(_, factor)| factor.abs()).min();
            least.is_some_and(|least| {
                !least.is_one()
                    && sum.terms.iter().any(|(_, f)| f.checked_div(&least).is_some_and(|ratio| !ratio.is_integer()))
            })
        }
        _ => false,
    }
}

/// The calls of expressions, and what their roots are taken of. A form with others is not the author's: `tanh(100*w)`
/// as a quotient of exponentials overflows, and `sin(24*q)` as a polynomial in `cos(q)` loses all digits.
pub(crate) fn functions(arena: &Arena, exprs: &[Expr]) -> BTreeSet<Expr> {
    let mut found = BTreeSet::new();
    for e in arena.postorder(exprs) {
        match arena.node(e) {
            Node::Call(..) => {
                found.insert(e);
            }
            Node::Product(product) => {
                found.extend(
                    product.factors.iter().filter(|(_, exponent)| !exponent.is_integer()).map(|(base, _)| *base),
                );
            }
            _ => {}
        }
    }
    found
}

/// Whether a form divides by nothing by which the expression does not divide, and by nothing more often: `cos(q)^2 - 1`
/// in place of `sin(q)^2` has lost its digits where it is small, and what is over `sin(q)^2` and not over `sin(q)` has
/// a numerator that cancels there.
fn divides_as(arena: &Arena, expr: Expr, form: Expr) -> bool {
    let own = divisors(arena, expr);
    let within = |(base, times): (&Expr, &Rational)| {
        let allowed = own.get(base).or_else(|| own.get(&arena.neg(*base)));
        allowed.is_some_and(|allowed| times <= allowed)
    };
    divisors(arena, form).iter().all(within)
}

/// The sums and functions by which an expression divides, and how often along one path at most.
fn divisors(arena: &Arena, expr: Expr) -> BTreeMap<Expr, Rational> {
    let mut known: FxHashMap<Expr, BTreeMap<Expr, Rational>> = FxHashMap::default();
    for e in arena.postorder(&[expr]) {
        let mut found: BTreeMap<Expr, Rational> = BTreeMap::new();
        match arena.node(e) {
            Node::Product(product) => {
                for (base, exponent) in &product.factors {
                    let magnitude = exponent.abs();
                    for (inner, times) in &known[base] {
                        let times = times * &magnitude;
                        found.entry(*inner).and_modify(|sum| *sum = &*sum + &times).or_insert(times);
                    }
                    if exponent.is_negative() && matches!(arena.node(*base), Node::Sum(_) | Node::Call(..)) {
                        found.entry(*base).and_modify(|sum| *sum = &*sum + &magnitude).or_insert(magnitude);
                    }
                }
            }
            _ => {
                for (inner, times) in arena.operands(e).iter().flat_map(|operand| &known[operand]) {
                    let most = found.entry(*inner).or_insert_with(|| times.clone());
                    if times > most {
                        *most = times.clone();
                    }
                }
            }
        }
        known.insert(e, found);
    }
    known.remove(&expr).unwrap_or_default()
}

/// Of equal forms the shortest in the functions of the author's formula; the first where none keeps to them.
pub(crate) fn authors(arena: &Arena, written: Expr, forms: &[Expr]) -> Option<Expr> {
    let own = functions(arena, &[written]);
    let keeps = |form: &Expr| functions(arena, &[*form]).is_subset(&own) && divides_as(arena, written, *form);
    let kept = forms.iter().copied().filter(keeps);
    kept.min_by_key(|form| operations(arena, *form)).or_else(|| forms.first().copied())
}

/// Whether a form asks for nothing, to have a value, but what the expression asks too or what the domain shows.
pub(crate) fn asks_no_more(arena: &Arena, domain: &Domain, expr: Expr, form: Expr) -> bool {
    let own = arena.asks(&[expr], Want::Value);
    let mut more = arena.asks(&[form], Want::Value);
    more.retain(|ask| !own.contains(ask));
    if more.is_empty() {
        return true;
    }
    let mut there = domain.clone();
    for (part, relation) in own {
        there.facts.assume(part, relation);
    }
    more.into_iter().all(|(part, relation)| there.implies(arena, part, relation))
}

/// The first of the candidates that asks for less than the expression of what the domain does not show and is proved
/// equal to it: of `(sqrt(q) - 1)/(q - 1)` and `1/(1 + sqrt(q))` the second, which has a value at q = 1 too.
pub(crate) fn asking_less(arena: &Arena, domain: &Domain, expr: Expr, candidates: &[Expr]) -> Expr {
    let unshown = |form: Expr| {
        let asked = arena.asks(&[form], Want::Value).into_iter();
        asked.filter(|(part, relation)| !domain.implies(arena, *part, *relation)).count()
    };
    let most = unshown(expr);
    if most == 0 {
        return expr;
    }
    let equal = |form: Expr| decide(arena, arena.sub(form, expr), domain).is_zero();
    candidates.iter().copied().find(|form| unshown(*form) < most && equal(*form)).unwrap_or(expr)
}

/// The shorter of an expression and its normal form, the latter only if the zero test confirms it.
pub(crate) fn proved_shortest(arena: &Arena, domain: &Domain, expr: Expr) -> Expr {
    let candidate = shortest(arena, domain, expr);
    shortest_equal(arena, domain, expr, &[candidate])
}

/// The one of two equal expressions that takes fewer operations; the first where they are level.
pub(crate) fn shorter(arena: &Arena, first: Expr, second: Expr) -> Expr {
    if operations(arena, second) < operations(arena, first) { second } else { first }
}

/// The first of the candidates by length that is proved equal to the expression.
pub(crate) fn shortest_equal(arena: &Arena, domain: &Domain, expr: Expr, candidates: &[Expr]) -> Expr {
    let mut best = expr;
    for &candidate in candidates {
        if operations(arena, candidate) < operations(arena, best)
            && asks_no_more(arena, domain, expr, candidate)
            && decide(arena, arena.sub(candidate, expr), domain).is_zero()
        {
            best = candidate;
        }
    }
    best
}

/// The number of operations of an expression, shared parts once; functions weigh more.
pub(crate) fn operations(arena: &Arena, expr: Expr) -> usize {
    const FUNCTION: usize = 10;
    arena
        .postorder(&[expr])
        .into_iter()
        .map(|e| match arena.node(e) {
            Node::Number(_) | Node::Pi | Node::Symbol(_) => 0,
            Node::Sum(sum) => {
                let scaled = sum.terms.iter().filter(|(_, c)| !c.abs().is_one()).count();
                sum.terms.len() + scaled - usize::from(sum.constant.is_zero())
            }
            Node::Product(product) => {
                let powers: usize = product
                    .factors
                    .iter()
                    .map(|(_, exponent)| match exponent.abs().to_i64() {
                        Some(1) => 1,
                        Some(_) => 2,
                        None => FUNCTION,
                    })
                    .sum();
                let scaled = usize::from(!product.coefficient.abs().is_one());
                let inverted = usize::from(product.factors.iter().all(|(_, exponent)| exponent.is_negative()));
                (powers + scaled + inverted).saturating_sub(1)
            }
            Node::Call(..) => FUNCTION,
        })
        .sum()
}

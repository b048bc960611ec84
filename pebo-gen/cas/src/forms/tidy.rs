//! The shortest of several equal forms of a result, for people and for emitted code.
//!
//! A form counts only if it has a value wherever the result has: `sqrt(q) - 1` over `q - 1` does not stand for
//! `1/(1 + sqrt(q))`.

use std::collections::{BTreeMap, BTreeSet};

use rustc_hash::{FxHashMap, FxHashSet};

use super::as_sign::as_sign;
use super::hyperbolic::without_differences;
use super::near_zero::near_zero;
use super::opaque::OpaqueTerms;
use super::oriented::Orientation;
use super::scaled::scaled;
use super::shared_sums::SharedSums;
use crate::domain::zero::is_zero;
use crate::graph::conditions::Regularity;
use crate::graph::function::{Conditions, Function};
use crate::tower::Field;
use crate::{Arena, Domain, Expr, Facts, Node, Rational, Relation};

/// Numbers of terms for which a numerator is tested as a product of sums, as `(p - 1)*(q - 1)`.
const PRODUCT_TERMS: std::ops::RangeInclusive<usize> = 4..=12;

/// Terms of a normal form up to which it is always written out: common factors may shorten it.
const LONG: usize = 500;

/// The shortest of an expression and the forms of its normal form.
pub fn shortest(arena: &Arena, domain: &Domain, expr: Expr) -> Expr {
    shortest_oriented(arena, &Orientation::new(arena, domain), expr)
}

/// As [`shortest`], for one of several expressions with a common orientation.
pub fn shortest_oriented(arena: &Arena, orientation: &Orientation<'_>, expr: Expr) -> Expr {
    if is_shortest(arena, expr) {
        return expr;
    }
    let expr = as_sign(arena, expr);
    // A long formula over its shared sums: written out, it would be longer.
    if operations(arena, expr) > LONG
        && let Some(shared) = SharedSums::of(arena, expr)
    {
        return shared.expanded(arena, shortest_oriented(arena, orientation, shared.expr));
    }
    let domain = orientation.domain();
    let own = functions(arena, &[expr]);
    let kept = |form: Expr| {
        functions(arena, &[form]).iter().all(|call| {
            own.contains(call) || domain.written.contains(call) || own.iter().any(|own| is_root_of(arena, *call, *own))
        }) && !dissolves(arena, &[expr], form)
    };
    let mut forms = vec![expr];
    if let Ok(field) = Field::of_long_sums(arena, &domain.facts, &[expr]) {
        forms.extend(written(&field, expr));
        if forms.iter().skip(1).all(|form| !kept(*form)) {
            forms.extend(in_own_functions(&field, &domain.facts, expr, &own, kept));
        }
    }
    forms.extend(forms.iter().filter_map(|form| without_differences(arena, *form)).collect::<Vec<Expr>>());
    let forms = forms.into_iter().flat_map(|form: Expr| [form, orientation.of(form)]);
    // Several forms are often equal.
    let mut seen = FxHashSet::default();
    let forms = forms.flat_map(|form| [form, scaled(arena, form)]).map(|form| as_sign(arena, form));
    let forms = forms.filter(|form| seen.insert(*form));
    let cancels = |form: Expr| !root_differences(arena, form).is_subset(&root_differences(arena, expr));
    let (mut best, mut fewest) = (expr, operations(arena, expr));
    for form in forms {
        let taken = operations(arena, form);
        if taken < fewest
            && kept(form)
            && divides_as(arena, expr, form)
            && !cancels(form)
            && adds_no_conditions(arena, domain, expr, form)
        {
            (best, fewest) = (form, taken);
        }
    }
    best
}

/// The other forms of an expression with at most so many operations that have a value wherever it has, those with the
/// fewest first. They may hold other functions than the author's and divide by other sums; the caller proves them
/// equal.
pub fn others(arena: &Arena, domain: &Domain, expr: Expr, most: usize) -> impl Iterator<Item = Expr> {
    let mut forms: Vec<(usize, Expr)> = Vec::new();
    for form in ways(arena, domain, expr) {
        let taken = operations(arena, form);
        if form != expr && taken <= most && !forms.contains(&(taken, form)) {
            forms.push((taken, form));
        }
    }
    forms.sort_by_key(|(taken, _)| *taken);
    // The domain conditions of a form take long to check: only those of the forms in use are.
    forms.into_iter().map(|(_, form)| form).filter(move |form| adds_no_conditions(arena, domain, expr, *form))
}

/// The forms of an expression, some of them several times.
fn ways(arena: &Arena, domain: &Domain, expr: Expr) -> Vec<Expr> {
    let Ok(field) = Field::of_long_sums(arena, &domain.facts, &[expr]) else { return Vec::new() };
    let orientation = Orientation::new(arena, domain);
    let own = functions(arena, &[expr]);
    let in_kernels_of = |field: &Field<'_>| {
        let mut ways = written(field, expr);
        if let Ok(fraction) = field.fraction(expr) {
            ways.extend(field.show_without_sines(&fraction));
            ways.extend(field.show_rationalised(&fraction));
        }
        ways
    };
    let mut ways = in_kernels_of(&field);
    // In absolute angles `sin(q)` is no divisor.
    ways.extend(Field::over(arena, &domain.facts, &[expr]).iter().flat_map(in_kernels_of));
    ways.extend(in_own_functions(&field, &domain.facts, expr, &own, |form| functions(arena, &[form]).is_subset(&own)));
    ways.extend([expr].iter().chain(&ways).filter_map(|form| near_zero(arena, *form)).collect::<Vec<Expr>>());
    ways.into_iter().flat_map(|form| [orientation.of(form), form]).collect()
}

/// The forms of the normal form; none if it is long and has more terms than the expression has operations, as a
/// determinant that is written by its minors: each term is at least one operation.
fn written(field: &Field<'_>, expr: Expr) -> Vec<Expr> {
    let Ok(fraction) = field.fraction(expr) else { return Vec::new() };
    let terms = fraction.weight();
    if terms > LONG && terms > operations(field.arena(), expr) {
        return Vec::new();
    }
    let few = PRODUCT_TERMS.contains(&fraction.numerator().term_count());
    let factored = few.then(|| field.show_factored(&fraction));
    let forms =
        [Some(field.show(&fraction)), Some(field.show_apart(&fraction)), field.show_by_angles(&fraction), factored];
    forms.into_iter().flatten().collect()
}

/// The forms of a normal form in which functions that it would replace are opaque: writing `tanh(u)` as a quotient of
/// exponentials must not keep `sqrt(q^2) - q^2/sqrt(q^2)` beside it from cancelling.
fn in_own_functions(
    field: &Field<'_>,
    facts: &Facts,
    expr: Expr,
    own: &BTreeSet<Expr>,
    kept: impl Fn(Expr) -> bool,
) -> Vec<Expr> {
    let arena = field.arena();
    let foreign = |call: &Expr| field.fraction(*call).is_ok_and(|fraction| !kept(field.show(&fraction)));
    let is_call = |call: &Expr| matches!(arena.node(*call), Node::Call(..));
    let calls: BTreeSet<Expr> = own.iter().copied().filter(|call| is_call(call) && foreign(call)).collect();
    let mut opaque = OpaqueTerms::calls(arena, &calls);
    let over = opaque.replace(&[expr])[0];
    if opaque.is_empty() {
        return Vec::new();
    }
    let Ok(field) = Field::of_long_sums(arena, facts, &[over]) else { return Vec::new() };
    written(&field, over).into_iter().map(|form| opaque.restore(form)).collect()
}

/// True if a call is the root of an even power: `abs(q)` is `sqrt(q^2)`.
fn is_root_of(arena: &Arena, call: Expr, radicand: Expr) -> bool {
    let (Node::Call(Function::Abs, inside), Node::Product(product)) = (arena.node(call), arena.node(radicand)) else {
        return false;
    };
    let is_even = |power: &Rational| power.is_integer() && power.numerator().trailing_zeros() > 0;
    product.factors.iter().any(|(base, power)| *base == inside[0] && is_even(power))
}

/// True if no form of the normal form is shorter: for a number, a symbol, and a sum of symbols with numeric factors
/// unless one of these divides all others, so that it becomes one where it is taken out.
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

/// The calls of expressions, and the radicands of their roots. A form with others is not the author's: `tanh(100*w)` as
/// a quotient of exponentials overflows, and `sin(24*q)` as a polynomial in `cos(q)` loses all digits.
pub fn functions(arena: &Arena, exprs: &[Expr]) -> BTreeSet<Expr> {
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

/// True if a form of expressions writes one of their hyperbolic functions with powers of exponentials: `exp(q)^4 - 1`
/// over `exp(q)^4 + 1` is `tanh(2*q)`, and overflows.
pub fn dissolves(arena: &Arena, exprs: &[Expr], form: Expr) -> bool {
    let hyperbolic = |exprs: &[Expr]| -> BTreeSet<Expr> {
        let is_hyperbolic =
            |call: &Expr| matches!(arena.node(*call), Node::Call(Function::Sinh | Function::Cosh | Function::Tanh, _));
        functions(arena, exprs).into_iter().filter(is_hyperbolic).collect()
    };
    !hyperbolic(exprs).is_subset(&hyperbolic(&[form]))
        && !powers_of_exp(arena, &[form]).is_subset(&powers_of_exp(arena, exprs))
}

/// The powers of exponentials, but for the first.
fn powers_of_exp(arena: &Arena, exprs: &[Expr]) -> BTreeSet<(Expr, Rational)> {
    let mut found = BTreeSet::new();
    for expr in arena.postorder(exprs) {
        let Node::Product(product) = arena.node(expr) else { continue };
        let is_power = |(base, exponent): &&(Expr, Rational)| {
            matches!(arena.node(*base), Node::Call(Function::Exp, _)) && !exponent.abs().is_one()
        };
        found.extend(product.factors.iter().filter(is_power).cloned());
    }
    found
}

/// The sums in which a square root has another sign than another term: they lose digits where the two are near, as
/// `(sqrt(4*z + 1) - 1)/2` does for small z and `2*z/(sqrt(4*z + 1) + 1)` does not. Up to their signs.
pub fn root_differences(arena: &Arena, expr: Expr) -> BTreeSet<Expr> {
    let is_root = |term: Expr| match arena.node(term) {
        Node::Product(product) => product.factors.iter().any(|(_, exponent)| !exponent.is_integer()),
        _ => false,
    };
    let mut found = BTreeSet::new();
    for e in arena.postorder(&[expr]) {
        let Node::Sum(sum) = arena.node(e) else { continue };
        let signs = |positive: bool| {
            let constant = !sum.constant.is_zero() && sum.constant.is_negative() != positive;
            constant || sum.terms.iter().any(|(_, factor)| factor.is_negative() != positive)
        };
        if sum.terms.iter().any(|(term, factor)| is_root(*term) && signs(factor.is_negative())) {
            found.insert(e.min(arena.neg(e)));
        }
    }
    found
}

/// True if a form has no divisors but the expression's, and none more often: `cos(q)^2 - 1` in place of `sin(q)^2` has
/// lost its digits where it is small, and a form over `sin(q)^2` instead of `sin(q)` has a numerator that cancels
/// there.
fn divides_as(arena: &Arena, expr: Expr, form: Expr) -> bool {
    let own = divisors(arena, expr);
    let within = |(base, times): (&Expr, &Rational)| {
        let allowed = own.get(base).or_else(|| own.get(&arena.neg(*base)));
        allowed.is_some_and(|allowed| times <= allowed)
    };
    divisors(arena, form).iter().all(within)
}

/// The sums and functions by which an expression divides, with their greatest multiplicity along one path. A divisor
/// `cos(q)^2 - 1` counts as `sin(q)^2`.
fn divisors(arena: &Arena, expr: Expr) -> BTreeMap<Expr, Rational> {
    let mut known: FxHashMap<Expr, BTreeMap<Expr, Rational>> = FxHashMap::default();
    for e in arena.postorder(&[expr]) {
        let mut found: BTreeMap<Expr, Rational> = BTreeMap::new();
        match arena.node(e) {
            Node::Product(product) => {
                for (base, exponent) in &product.factors {
                    let times_each = exponent.abs();
                    for (inner, times) in &known[base] {
                        let times = times * &times_each;
                        found.entry(*inner).and_modify(|sum| *sum = &*sum + &times).or_insert(times);
                    }
                    if exponent.is_negative() && matches!(arena.node(*base), Node::Sum(_) | Node::Call(..)) {
                        let sine = arena.sine_of_square(*base).map(|sine| (sine, &times_each + &times_each));
                        for (inner, times) in sine.into_iter().chain([(*base, times_each)]) {
                            found.entry(inner).and_modify(|sum| *sum = &*sum + &times).or_insert(times);
                        }
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

/// The shortest of equal forms in the functions of the author's formula; the first if none keeps to them.
pub fn authors_form(arena: &Arena, written: Expr, forms: &[Expr]) -> Option<Expr> {
    let own = functions(arena, &[written]);
    let keeps = |form: &Expr| functions(arena, &[*form]).is_subset(&own) && divides_as(arena, written, *form);
    let kept = forms.iter().copied().filter(keeps);
    kept.min_by_key(|form| operations(arena, *form)).or_else(|| forms.first().copied())
}

/// True if every domain condition of a form is one of the expression or proved on the domain.
pub(crate) fn adds_no_conditions(arena: &Arena, domain: &Domain, expr: Expr, form: Expr) -> bool {
    let own = code_conditions(arena, &[expr]);
    let mut more = code_conditions(arena, &[form]);
    more.retain(|ask| !own.contains(ask));
    if more.is_empty() {
        return true;
    }
    // A point that proofs exclude may still not divide by zero: only signs, and the expression's own conditions, count.
    let mut facts = Facts::new();
    let signs = domain.facts.iter().filter(|(_, relation)| *relation != Relation::NonZero);
    for (part, relation) in signs.chain(own) {
        facts.assume(part, relation);
    }
    let there = Domain { facts, ..domain.clone() };
    more.into_iter().all(|(part, relation)| there.implies(arena, part, relation))
}

/// The domain conditions of the emitted code: unlike a proof, code has a value for the sign of 0, and for the slope of a
/// table at a corner.
pub fn code_conditions(arena: &Arena, formulas: &[Expr]) -> Conditions {
    let mut found = Conditions::new();
    for part in arena.postorder(formulas) {
        if matches!(arena.node(part), Node::Call(Function::Sign | Function::Table, _)) {
            continue;
        }
        for ask in arena.operation_conditions(part, Regularity::Defined) {
            if !found.contains(&ask) && !arena.holds_of_number(ask) {
                found.push(ask);
            }
        }
    }
    found
}

/// The first of the candidates that has fewer unproved domain conditions than the expression and is proved equal to it:
/// of `(sqrt(q) - 1)/(q - 1)` and `1/(1 + sqrt(q))` the second, which has a value at q = 1 too.
pub fn with_fewer_conditions(arena: &Arena, domain: &Domain, expr: Expr, candidates: &[Expr]) -> Expr {
    let unproved = |form: Expr| {
        let asked = code_conditions(arena, &[form]).into_iter();
        asked.filter(|(part, relation)| !domain.implies(arena, *part, *relation)).count()
    };
    let most = unproved(expr);
    if most == 0 {
        return expr;
    }
    let equal = |form: Expr| is_zero(arena, arena.sub(form, expr), domain);
    candidates.iter().copied().find(|form| unproved(*form) < most && equal(*form)).unwrap_or(expr)
}

/// The shorter of an expression and its normal form, the latter only if the zero test confirms it.
pub fn proved_shortest(arena: &Arena, domain: &Domain, expr: Expr) -> Expr {
    let candidate = shortest(arena, domain, expr);
    shortest_equal(arena, domain, expr, &[candidate])
}

/// The one of two equal expressions that takes fewer operations; the first of equally long ones.
pub fn shorter(arena: &Arena, first: Expr, second: Expr) -> Expr {
    if operations(arena, second) < operations(arena, first) { second } else { first }
}

/// The first of the candidates by length that is proved equal to the expression.
pub fn shortest_equal(arena: &Arena, domain: &Domain, expr: Expr, candidates: &[Expr]) -> Expr {
    let mut best = expr;
    for &candidate in candidates {
        if operations(arena, candidate) < operations(arena, best)
            && adds_no_conditions(arena, domain, expr, candidate)
            && is_zero(arena, arena.sub(candidate, expr), domain)
        {
            best = candidate;
        }
    }
    best
}

/// The number of operations of an expression, shared subexpressions once; functions weigh more.
pub fn operations(arena: &Arena, expr: Expr) -> usize {
    operations_of(arena, &[expr])
}

/// As [`operations`], of several expressions combined.
pub fn operations_of(arena: &Arena, exprs: &[Expr]) -> usize {
    const FUNCTION: usize = 10;
    arena
        .postorder(exprs)
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Relation;

    #[test]
    fn a_sine_is_divided_by_and_not_the_square_of_a_cosine_less_one() {
        let arena = Arena::new();
        let [q, k] = ["q", "k"].map(|name| arena.variable(name));
        let [s, c] = [Function::Sin, Function::Cos].map(|function| arena.call(function, &[q]));
        let square = arena.scale(arena.sub(arena.mul(c, c), arena.one()), &Rational::from(2));
        let cases = [
            (arena.div(arena.mul(k, s), square), "-k/(2*sin(q))"),
            // The author has no sine.
            (arena.div(k, square), "k/(2*(cos(q)^2 - 1))"),
            (arena.div(k, arena.mul(s, s)), "k/sin(q)^2"),
            // One sine, not two.
            (arena.div(k, s), "k/sin(q)"),
        ];
        for (written, expected) in cases {
            assert_eq!(arena.print(shortest(&arena, &Domain::default(), written)), expected);
        }
    }

    #[test]
    fn terms_cancel_beside_opaque_functions() {
        let arena = Arena::new();
        let [p, q, u] = ["p", "q", "u"].map(|name| arena.variable(name));
        let call = |function, argument| arena.call(function, &[argument]);
        let root = arena.sqrt(arena.mul(q, q));
        let over = arena.div(arena.mul(q, q), root);
        let cancelled = arena.sub(root, over);
        let speed = arena.scale(u, &Rational::from(5));
        let wave = call(Function::Sin, arena.scale(p, &Rational::from(24)));
        let pythagoras = arena.sum([
            arena.power(call(Function::Sin, q), &Rational::from(2)),
            arena.power(call(Function::Cos, q), &Rational::from(2)),
            arena.number(-1),
        ]);
        let larger = arena.call(Function::Max, &[q, u]);
        for (own, expected) in [
            (call(Function::Tanh, speed), "tanh(5*u)"),
            (call(Function::Sat, speed), "sat(5*u)"),
            (arena.sub(call(Function::Sat, speed), larger), "sat(5*u) - max(q, u)"),
            (wave, "sin(24*p)"),
        ] {
            for vanishing in [cancelled, arena.mul(p, cancelled), arena.mul(p, pythagoras)] {
                let form = shortest(&arena, &Domain::default(), arena.add(own, vanishing));
                assert_eq!(arena.print(form), expected, "{}", arena.print(vanishing));
            }
            let doubled = arena.sum([own, root, over]);
            let form = shortest(&arena, &Domain::default(), doubled);
            let shown = arena.print(form);
            assert!(
                shown.contains("2*abs(q)") && functions(&arena, &[form]).is_superset(&functions(&arena, &[own])),
                "{shown}"
            );
        }
    }

    /// The absolute value equals the root, and no form of another function.
    #[test]
    fn an_absolute_value_replaces_only_the_root_of_a_square() {
        let arena = Arena::new();
        let [p, q] = ["p", "q"].map(|name| arena.variable(name));
        let larger = arena.call(Function::Max, &[p, q]);
        let form = shortest(&arena, &Domain::default(), arena.mul(larger, arena.sub(p, q)));
        assert!(!arena.print(form).contains("abs"), "{}", arena.print(form));
        let root = arena.sqrt(arena.mul(q, q));
        let mut domain = Domain::default();
        domain.facts.assume(q, Relation::Positive);
        assert_eq!(arena.print(shortest(&arena, &domain, root)), "q");
    }
}

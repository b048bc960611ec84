//! Laws of the expression layer, on random expressions.

use std::collections::BTreeMap;

use pebo_cas::Domain;
use pebo_cas::Rational;
use pebo_cas::Relation;
use pebo_cas::domain::zero::{Answer, decide, is_zero};
use pebo_cas::number::interval::{Interval, Precision};
use pebo_cas::{Arena, Expr, Function, Node};
use pebo_gen::model::formula::{Estimates, SpanMap, parse_formula};
use pebo_gen::plant::{Scope, lower};
use proptest::prelude::*;

const NAMES: [&str; 3] = ["x", "y", "z"];

/// A recipe for an expression.
#[derive(Clone, Debug)]
enum Recipe {
    Number(i64, i64),
    Symbol(usize),
    Add(Box<Recipe>, Box<Recipe>),
    Multiply(Box<Recipe>, Box<Recipe>),
    Power(Box<Recipe>, i64),
    Call(Function, Box<Recipe>),
}

/// Functions that have a value everywhere.
const TOTAL: [Function; 6] =
    [Function::Sin, Function::Cos, Function::Tanh, Function::Atan, Function::Exp, Function::Cosh];

fn recipe(calls: bool) -> impl Strategy<Value = Recipe> {
    let leaf = prop_oneof![
        (-4..5_i64, 1..4_i64).prop_map(|(n, d)| Recipe::Number(n, d)),
        (0..3_usize).prop_map(Recipe::Symbol)
    ];
    leaf.prop_recursive(3, 12, 2, move |inner| {
        let pair = (inner.clone(), inner.clone());
        let sum = pair.clone().prop_map(|(a, b)| Recipe::Add(Box::new(a), Box::new(b)));
        let product = pair.prop_map(|(a, b)| Recipe::Multiply(Box::new(a), Box::new(b)));
        let power = (inner.clone(), 2..4_i64).prop_map(|(a, n)| Recipe::Power(Box::new(a), n));
        let call = (prop::sample::select(TOTAL.to_vec()), inner).prop_map(|(f, a)| Recipe::Call(f, Box::new(a)));
        if calls { prop_oneof![sum, product, power, call].boxed() } else { prop_oneof![sum, product, power].boxed() }
    })
}

fn build(arena: &Arena, recipe: &Recipe) -> Expr {
    match recipe {
        Recipe::Number(n, d) => arena.number(Rational::new(*n, *d).expect("a denominator above zero")),
        Recipe::Symbol(index) => arena.variable(NAMES[*index]),
        Recipe::Add(a, b) => arena.add(build(arena, a), build(arena, b)),
        Recipe::Multiply(a, b) => arena.mul(build(arena, a), build(arena, b)),
        Recipe::Power(a, n) => arena.power(build(arena, a), &Rational::from(*n)),
        Recipe::Call(f, a) => arena.call(*f, &[build(arena, a)]),
    }
}

/// The expression made once more from its node.
fn again(arena: &Arena, expr: Expr) -> Expr {
    match arena.node(expr) {
        Node::Number(value) => arena.number(value),
        Node::Pi => arena.pi(),
        Node::Symbol(symbol) => arena.of_symbol(symbol),
        Node::Sum(sum) => arena.combine(&sum.constant, sum.terms.iter().cloned()),
        Node::Product(product) => arena.multiply(&product.coefficient, product.factors.iter().cloned()),
        Node::Call(function, arguments) => arena.call(function, &arguments),
    }
}

/// Equal, or at least not refuted: the zero test may only be too weak, never wrong.
fn agree(arena: &Arena, a: Expr, b: Expr) -> bool {
    a == b || !matches!(decide(arena, arena.sub(a, b), &Domain::default()), Answer::NonZero(_))
}

fn proved(arena: &Arena, a: Expr, b: Expr) -> bool {
    a == b || is_zero(arena, arena.sub(a, b), &Domain::default())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn construction_is_idempotent(r in recipe(true)) {
        let arena = Arena::new();
        let expr = build(&arena, &r);
        for e in arena.postorder(&[expr]) {
            prop_assert_eq!(again(&arena, e), e, "{}", arena.print(e));
        }
    }

    #[test]
    fn printed_text_parses_to_the_same(r in recipe(true)) {
        let arena = Arena::new();
        let expr = build(&arena, &r);
        let text = arena.print(expr);
        let formula = parse_formula(&text, &SpanMap::verbatim(&text, 0), Estimates::Refused).expect("its own text");
        let mut scope = Scope::new();
        for name in NAMES {
            scope.define(name, arena.variable(name));
        }
        let back = lower(&arena, &scope, &formula).expect("its own text");
        prop_assert!(proved(&arena, back, expr), "{}", text);
    }

    #[test]
    fn sums_and_products_obey_the_ring_axioms(a in recipe(false), b in recipe(false), c in recipe(false)) {
        let arena = Arena::new();
        let (a, b, c) = (build(&arena, &a), build(&arena, &b), build(&arena, &c));
        prop_assert_eq!(arena.add(a, b), arena.add(b, a));
        prop_assert_eq!(arena.mul(a, b), arena.mul(b, a));
        prop_assert!(proved(&arena, arena.add(arena.add(a, b), c), arena.add(a, arena.add(b, c))));
        prop_assert!(proved(&arena, arena.mul(arena.mul(a, b), c), arena.mul(a, arena.mul(b, c))));
        prop_assert!(proved(&arena, arena.mul(a, arena.add(b, c)), arena.add(arena.mul(a, b), arena.mul(a, c))));
        prop_assert!(arena.is_zero(arena.sub(a, a)));
        prop_assert_eq!(arena.mul(a, arena.one()), a);
    }

    #[test]
    fn the_product_rule_holds(a in recipe(true), b in recipe(true)) {
        let arena = Arena::new();
        let (a, b, x) = (build(&arena, &a), build(&arena, &b), arena.symbol("x"));
        let whole = arena.derivative(arena.mul(a, b), x);
        let parts = arena.add(arena.mul(arena.derivative(a, x), b), arena.mul(a, arena.derivative(b, x)));
        prop_assert!(agree(&arena, whole, parts));
    }

    /// Renaming commutes with the derivative: d/dx f(x, y := z) = (d/dx f)(y := z).
    #[test]
    fn substitution_and_differentiation_commute(a in recipe(true), b in recipe(true)) {
        let arena = Arena::new();
        let (x, y) = (arena.symbol("x"), arena.symbol("y"));
        let apart = BTreeMap::from([(x, arena.variable("z"))]);
        let inner = arena.substitute(build(&arena, &b), &apart);
        let values = BTreeMap::from([(y, inner)]);
        let a = build(&arena, &a);
        let first = arena.derivative(arena.substitute(a, &values), x);
        let second = arena.substitute(arena.derivative(a, x), &values);
        prop_assert!(agree(&arena, first, second), "{}", arena.print(a));
    }

    #[test]
    fn derivatives_match_high_precision_differences(r in recipe(true), n in -6..7_i64, m in -6..7_i64) {
        let arena = Arena::new();
        let expr = build(&arena, &r);
        let x = arena.symbol("x");
        let precision = Precision::new(400);
        let step = Rational::new(1, 1_i64 << 40).expect("a step");
        let at = |shift: &Rational| {
            let mut point = BTreeMap::new();
            for (name, value) in NAMES.iter().zip([n, m, n - m]) {
                point.insert(arena.symbol(name), arena.number(Rational::new(value, 5).expect("a fifth")));
            }
            let moved = arena.add(point[&x], arena.number(shift.clone()));
            point.insert(x, moved);
            point
        };
        let zero = Rational::ZERO;
        let (Some(up), Some(down), Some(slope)) = (
            arena.enclose(expr, &at(&step), precision),
            arena.enclose(expr, &at(&-&step), precision),
            arena.enclose(arena.derivative(expr, x), &at(&zero), precision),
        ) else {
            return Ok(());
        };
        let width = Interval::from_rational(&(&step * &Rational::from(2)), precision).expect("a number");
        let quotient = up.sub(&down, precision).and_then(|rise| rise.div(&width, precision)).expect("a quotient");
        // The error of a central difference is h^2/6 times the third derivative. Of numbers beyond 2^400 the difference
        // is rounding alone, as its enclosure says.
        let size = slope.lo().abs();
        if size < 1e6 {
            let error = 1e-6 * (1.0 + size);
            let meets = quotient.lo() - error <= slope.hi() && slope.lo() <= quotient.hi() + error;
            prop_assert!(meets, "{quotient:?} {slope:?}");
        }
    }
}

#[test]
fn assumed_signs_do_not_leak_between_questions() {
    let arena = Arena::new();
    let x = arena.variable("x");
    let difference = arena.sub(arena.call(Function::Abs, &[x]), x);
    let mut domain = Domain::default();
    domain.facts.assume(x, Relation::Positive);
    assert!(is_zero(&arena, difference, &domain));
    assert!(matches!(decide(&arena, difference, &Domain::default()), Answer::NonZero(_)));
}

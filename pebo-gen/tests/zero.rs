//! The zero test on a table of identities and near-identities.
//!
//! Every witness is evaluated once more, in floating point by a plain walk over the written formula,
//! so that a refutation does not rest on the enclosures alone.

use std::collections::BTreeMap;

use pebo_cas::Domain;
use pebo_cas::Relation;
use pebo_cas::domain::zero::{Answer, decide};
use pebo_cas::graph::function::{Function, Value};
use pebo_cas::tower::Obstacle;
use pebo_cas::{Arena, Expr};
use pebo_gen::model::formula::{Estimates, Formula, Operator, SpanMap, Term, parse_formula};
use pebo_gen::plant::{Scope, lower};

const NAMES: [&str; 12] = ["a", "b", "c", "x", "y", "z", "p", "q", "u", "v", "n", "E"];

fn parse(text: &str) -> Formula {
    parse_formula(text, &SpanMap::verbatim(text, 0), Estimates::Refused).expect(text)
}

fn decided(formula: &Formula, positive: &[&str]) -> (Arena, Answer) {
    let arena = Arena::new();
    let mut scope = Scope::new();
    for name in NAMES {
        scope.define(name, arena.variable(name));
    }
    let mut domain = Domain::default();
    for text in positive {
        let fact = lower(&arena, &scope, &parse(text)).expect(text);
        domain.facts.assume(fact, Relation::Positive);
    }
    let expr = lower(&arena, &scope, formula).expect("a formula of the table");
    let answer = decide(&arena, expr, &domain);
    (arena, answer)
}

/// The value of a formula as written, in floating point.
fn value(formula: &Formula, point: &BTreeMap<String, f64>) -> f64 {
    let at = |f: &Formula| value(f, point);
    match &formula.term {
        Term::Number(decimal) => decimal.to_f64(),
        Term::Name(name) => point.get(name).copied().unwrap_or(std::f64::consts::PI),
        // These formulas have neither.
        Term::Estimate(_) | Term::Table(..) => f64::NAN,
        Term::Negative(operand) => -at(operand),
        Term::Binary(operator, left, right) => {
            let (a, b) = (at(left), at(right));
            match operator {
                Operator::Add => a + b,
                Operator::Subtract => a - b,
                Operator::Multiply => a * b,
                Operator::Divide => a / b,
                Operator::Power => a.powf(b),
            }
        }
        Term::Call(function, arguments) => {
            let row = function.row();
            match row.value {
                Value::Unary(f) => f(at(&arguments[0])),
                Value::Binary(f) => f(at(&arguments[0]), at(&arguments[1])),
                Value::Tabulated(_) => f64::NAN,
            }
        }
    }
}

const ZERO: &[(&str, &[&str])] = &[
    // A cube root of a product of powers.
    ("((x^5*y)^(1/3) + 1)*((x^5*y)^(2/3) - (x^5*y)^(1/3) + 1) - x^5*y - 1", &[]),
    ("(x + y)^2 - x^2 - 2*x*y - y^2", &[]),
    ("(x^3 - y^3)/(x - y) - x^2 - x*y - y^2", &[]),
    ("1/(x*(x + 1)) - 1/x + 1/(x + 1)", &[]),
    ("a/(b/c) - a*c/b", &[]),
    ("(a/b)/c - a/(b*c)", &[]),
    ("x^-2 - 1/x^2", &[]),
    ("-x^2 + x*x", &[]),
    ("sin(x)^2 + cos(x)^2 - 1", &[]),
    ("sin(2*x) - 2*sin(x)*cos(x)", &[]),
    ("cos(x + y) - cos(x)*cos(y) + sin(x)*sin(y)", &[]),
    ("sin(3*x) - 3*sin(x) + 4*sin(x)^3", &[]),
    ("sin(x/2)^2 - (1 - cos(x))/2", &[]),
    ("tan(x) - sin(x)/cos(x)", &[]),
    ("tan(2*x) - 2*tan(x)/(1 - tan(x)^2)", &[]),
    ("sin(n*x + n*y) - sin(n*x)*cos(n*y) - cos(n*x)*sin(n*y)", &[]),
    ("sin(-x) + sin(x)", &[]),
    ("cos(x - y) - cos(y - x)", &[]),
    ("sin(x + pi/2) - cos(x)", &[]),
    ("sin(x + pi) + sin(x)", &[]),
    ("cos(pi/3) - 1/2", &[]),
    ("sin(pi/4)^2 - 1/2", &[]),
    ("sin(x + 2*pi/3) + sin(x) + sin(x - 2*pi/3)", &[]),
    ("exp(x + y) - exp(x)*exp(y)", &[]),
    ("exp(2*x) - exp(x)^2", &[]),
    ("exp(-x)*exp(x) - 1", &[]),
    ("exp(x/2)^2 - exp(x)", &[]),
    ("cosh(x)^2 - sinh(x)^2 - 1", &[]),
    ("tanh(x) - sinh(x)/cosh(x)", &[]),
    ("asinh(sinh(x)) - x", &[]),
    ("acosh(cosh(x)) - x", &["x"]),
    ("atanh(tanh(x)) - x", &[]),
    ("sinh(asinh(x)) - x", &[]),
    ("cosh(acosh(x)) - x", &["x - 1"]),
    ("tanh(atanh(x)) - x", &["1 - x", "1 + x"]),
    ("sinh(2*x) - 2*sinh(x)*cosh(x)", &[]),
    ("sinh(x) + cosh(x) - exp(x)", &[]),
    ("log(exp(x)) - x", &[]),
    ("exp(log(x)) - x", &["x"]),
    ("exp(2*log(x)) - x^2", &["x"]),
    ("log(x*y) - log(x) - log(y)", &["x", "y"]),
    ("log(x^2) - 2*log(x)", &["x"]),
    ("log(x/y) + log(y/x)", &["x", "y"]),
    ("log(4) - 2*log(2)", &[]),
    ("sqrt(x)^2 - x", &["x"]),
    ("sqrt(x^2) - x", &["x"]),
    ("sqrt(x^2) - abs(x)", &[]),
    ("sqrt(4*x) - 2*sqrt(x)", &["x"]),
    ("sqrt(x)*sqrt(y) - sqrt(x*y)", &["x", "y"]),
    ("sqrt(8) - 2*sqrt(2)", &[]),
    ("sqrt(6) - sqrt(2)*sqrt(3)", &[]),
    ("1/sqrt(x) - sqrt(x)/x", &["x"]),
    ("(sqrt(x) + sqrt(y))*(sqrt(x) - sqrt(y)) - x + y", &["x", "y"]),
    ("1/(1 + sqrt(x)) - (1 - sqrt(x))/(1 - x)", &["x"]),
    ("sqrt((x + y)^2) - x - y", &["x", "y"]),
    ("sqrt(x^2*y) - x*sqrt(y)", &["x", "y"]),
    ("x^(1/3)*x^(2/3) - x", &["x"]),
    ("(x^3)^(1/3) - x", &["x"]),
    ("x^1.5 - x*sqrt(x)", &["x"]),
    ("sqrt(1 - b^2*cos(x)^2/c)*sqrt(c) - sqrt(c - b^2*cos(x)^2)", &["c", "c - b^2"]),
    ("abs(x)^2 - x^2", &[]),
    ("abs(-x) - abs(x)", &[]),
    ("abs(x) - x", &["x"]),
    ("abs(x*y) - x*y", &["x", "y"]),
    ("sin(atan2(y, x)) - y/sqrt(x^2 + y^2)", &["x", "y"]),
    ("cos(atan(x)) - 1/sqrt(1 + x^2)", &[]),
    ("sin(asin(x)) - x", &["x", "1 - x"]),
    ("cos(2*atan(x)) - (1 - x^2)/(1 + x^2)", &[]),
    ("tan(atan(x)) - x", &[]),
    ("sin(acos(x)) - sqrt(1 - x^2)", &["x", "1 - x"]),
    ("E*(1 - u) + E*u - E", &[]),
    ("0.1 + 0.2 - 0.3", &[]),
    ("x^y*x^z - x^(y + z)", &["x"]),
    ("atan(x) + atan(1/x) - pi/2", &["x"]),
    ("asin(x) + acos(x) - pi/2", &["x", "1 - x"]),
    ("acos(-x) + acos(x) - pi", &["x", "1 - x"]),
    ("atan(x - y) + atan(y - x)", &[]),
    ("atan2(y, x) - atan(y/x)", &["x"]),
    ("atan2(y, x) + atan(x/y) + pi/2", &["-y"]),
    ("atan2(2*y, 2*x) - atan2(y, x)", &["x"]),
    ("abs(x - y) - abs(y - x)", &[]),
    ("abs(2*x*y) - 2*abs(x)*abs(y)", &[]),
    ("abs(abs(x)) - abs(x)", &[]),
    ("abs(x^3) - abs(x)^3", &[]),
    ("sign(x)*abs(x) - x", &[]),
    ("sign(x*y) - sign(x)*sign(y)", &[]),
    ("sign(x^3) - 1", &["x"]),
    ("sign(-2*x) + sign(x)", &[]),
    ("min(x, y) + max(x, y) - x - y", &[]),
    ("min(x, y)*max(x, y) - x*y", &[]),
    ("max(x, y) - max(y, x)", &[]),
    ("max(x, -x) - abs(x)", &[]),
    ("max(x, 1 + x^2) - 1 - x^2", &[]),
    ("max(x, x) - x", &[]),
    ("min(z*x, z*y) - z*min(x, y)", &["z"]),
    ("min(2*x, 2*y) - 2*min(x, y)", &[]),
    ("sat(x) + sat(-x)", &[]),
    ("sat(2 + x^2) - 1", &[]),
    ("sat(x) - x", &["1 - x", "1 + x"]),
    ("log(x*sqrt(y)) - log(x) - log(y)/2", &["x", "y"]),
    ("log((x + y)^2) - 2*log(x + y)", &["x", "y"]),
    ("log(x*exp(y)) - log(x) - y", &["x"]),
    ("log(-x*y) - log(-x) - log(y)", &["-x", "y"]),
    ("log(x^2*y) - 2*log(-x) - log(y)", &["-x", "y"]),
    ("sqrt(y*sqrt(x)) - sqrt(y)*x^(1/4)", &["x", "y"]),
    ("sqrt(x*exp(y)) - sqrt(x)*exp(y/2)", &["x"]),
    ("(sqrt(exp(x) + 1) - 1)*(sqrt(exp(x) + 1) + 1) - exp(x)", &[]),
    ("(x^2 + 2*x + 1)^(1/4) - sqrt(abs(x + 1))", &[]),
    // Squares that the relation of sine and cosine hides, one of them up to a factor.
    ("sqrt(4 + 4*sin(x)*cos(x)^2 + sin(x)^2*cos(x)^4) - 2 - sin(x)*cos(x)^2", &["2 + sin(x)*cos(x)^2"]),
    ("sqrt(1 + 2*sin(x)*cos(x)) - abs(sin(x) + cos(x))", &[]),
    ("sqrt(2 + 2*sin(x) + 2*cos(x) + 2*sin(x)*cos(x)) - abs(1 + sin(x) + cos(x))", &[]),
    ("log(1 + sin(x) + cos(x) + sin(x)*cos(x)) - 2*log(abs(1 + sin(x) + cos(x))) + log(2)", &[]),
    ("(2 + cos(x)^3)^(3/2) - (2 + cos(x)^3)*sqrt(2 + cos(x)^3)", &[]),
    // Multiples of pi, and the roots among them.
    ("cos(pi/5) - (1 + sqrt(5))/4", &[]),
    ("(5^(1/4) + 1)*(5^(1/4) - 1) - 4*cos(pi/5) + 2", &[]),
    ("sin(2*pi/5)^2 - (5 + sqrt(5))/8", &[]),
    ("cos(2*pi/7)*cos(4*pi/7)*cos(6*pi/7) - 1/8", &[]),
    ("sin(pi/7) + sin(2*pi/7) - sin(3*pi/7) - sqrt(7)/2 + 2*sin(3*pi/7) - 2*sin(pi/7)", &[]),
    ("tan(3*pi/11) + 4*sin(2*pi/11) - sqrt(11)", &[]),
    ("cos(pi/8) - sqrt(2 + sqrt(2))/2", &[]),
    ("sin(x) + sin(x + 2*pi/5) + sin(x + 4*pi/5) + sin(x + 6*pi/5) + sin(x + 8*pi/5)", &[]),
    ("sin(pi/24)*sin(5*pi/24)*sin(7*pi/24)*sin(11*pi/24) - 1/16", &[]),
    // Arguments over denominators.
    ("sin(x/(1 + y) + x*y/(1 + y)) - sin(x)", &[]),
    ("exp(1/(x*(x + 1))) - exp(1/x)/exp(1/(x + 1))", &[]),
    ("cos(x^2/(x + y) - y^2/(x + y)) - cos(x - y)", &[]),
    ("sin((pi*(1 + 2*y) + 1)/(1 + 2*y)) + sin(1/(1 + 2*y))", &[]),
    ("exp(2/(x^2 - 1)) - exp(1/(x - 1))/exp(1/(x + 1))", &[]),
    // Roots, absolute values and logarithms of products.
    ("sqrt(x)*sqrt(y) - sqrt(x*y)", &[]),
    ("sqrt(x*y)*sqrt(y*z) - abs(y)*sqrt(x*z)", &[]),
    ("sqrt(x/y) - sqrt(x*y)/abs(y)", &[]),
    ("log(x*y) - log(abs(x)) - log(abs(y))", &[]),
    ("log(x^2) - 2*log(x)", &[]),
    ("abs(x^2 - y^2) - abs(x + y)*abs(y - x)", &[]),
    ("abs(x^2 + x + 1) - 1 - x - x^2", &[]),
    ("sqrt((x^2 - 2*x*y + 2*y^2 + 1)^2) - (x - y)^2 - y^2 - 1", &[]),
    ("sqrt(sin(x + y)^2) - abs(sin(x)*cos(y) + cos(x)*sin(y))", &[]),
    ("sqrt(1 - sin(x)^2) - cos(x)", &["pi/2 - x", "x + pi/2"]),
    ("sqrt(1 - cos(x)^2) - sin(x)", &["x", "3 - x"]),
    ("sqrt(x + y + 2*sqrt(x*y)) - sqrt(x) - sqrt(y)", &["x", "y"]),
    ("sqrt(3 - 2*sqrt(2)) - sqrt(2) + 1", &[]),
    ("x^(1/4)*x^(1/6) - x^(5/12)", &["x"]),
    ("sqrt((x^2 - 3*x + 4 + sin(x))^2) - x^2 + 3*x - 4 - sin(x)", &["x", "1 - x"]),
    // Angles that differ by none.
    ("asin(x) - atan(x/sqrt(1 - x^2))", &[]),
    ("acos(x) - atan2(sqrt(1 - x^2), x)", &[]),
    ("2*atan(x/(1 + sqrt(1 + x^2))) - atan(x)", &[]),
    ("atan(x) - atan(y) - atan((x - y)/(1 + x*y))", &["x", "y"]),
    ("4*atan(1/5) - atan(1/239) - pi/4", &[]),
    ("4*atan(1/5) + atan(239) - 3*pi/4", &[]),
    ("atan(x) + atan(y) + atan((1 - x*y)/(x + y)) - pi/2", &["x", "y"]),
    ("asin(2*x*sqrt(1 - x^2)) - 2*asin(x)", &["x", "1/2 - x"]),
    ("atan(1) - pi/4", &[]),
    ("acos(-x) + acos(x) - pi", &[]),
    ("cos(atan(x)/2)^2 - (1 + 1/sqrt(1 + x^2))/2", &[]),
    ("sin(acos(x)/2) - sqrt((1 - x)/2)", &[]),
    ("asin(sin(x/2 + pi/8)) - x/2 - pi/8", &["x", "pi/2 - x"]),
    // Facts about the functions that occur.
    ("sqrt(cos(x)^2) - cos(x)", &["cos(x)"]),
    ("abs(x - atan(x)) - x + atan(x)", &["x - atan(x)"]),
    ("abs(x - sin(x)) + sin(x) - x", &["x - sin(x)"]),
    ("sqrt(x - sqrt(x))^2 + sqrt(x) - x", &["x - sqrt(x)"]),
];

const NON_ZERO: &[(&str, &[&str])] = &[
    ("(x + y)^2 - x^2 - y^2", &[]),
    ("x - y", &[]),
    ("1e-30*x", &[]),
    ("sin(x)^2 - cos(x)^2 - 1", &[]),
    ("sin(2*x) - 2*sin(x)", &[]),
    ("cos(x + y) - cos(x)*cos(y) - sin(x)*sin(y)", &[]),
    ("sqrt(x^2) - x", &[]),
    ("sqrt(x^2) + x", &["x"]),
    ("abs(x) - x", &[]),
    ("abs(x) + x", &["x"]),
    ("log(x^2) - log(x)", &["x"]),
    ("exp(x*y) - exp(x)*exp(y)", &[]),
    ("atan(tan(x)) - x", &[]),
    ("atan2(sin(x), cos(x)) - x", &[]),
    ("atan2(y, x) - atan(y/x)", &[]),
    ("atan2(y, x) + atan(x/y) - pi/2", &[]),
    ("atan(x) + atan(1/x) - pi/2", &["-x"]),
    ("atan(x) + atan(1/x) - pi/2", &[]),
    ("abs(x*y) - x*abs(y)", &[]),
    ("sign(x*y) - sign(x)", &[]),
    ("min(x, y) - max(x, y)", &[]),
    ("min(x, y) + max(x, y) - x", &[]),
    ("max(x, y) - x", &["x"]),
    ("sat(x) - x", &[]),
    ("sat(2*x) - 2*sat(x)", &[]),
    ("asin(sin(x)) - x", &[]),
    ("sqrt(2) - 1.414213562373095048801688724209698", &[]),
    ("pi - 3.14159265358979323846264338327950288", &[]),
    ("exp(1) - 2.718281828459045235360287471352662", &[]),
    ("x^2 - 2", &[]),
    ("cosh(x) - 1 - x^2/2", &[]),
    ("sqrt(x + y) - sqrt(x) - sqrt(y)", &["x", "y"]),
    ("-x^2 - x^2", &[]),
    ("(-x)^2 + x^2", &[]),
    // Each of these is an identity on a part of the domain.
    ("atan(x) + atan(y) - atan((x + y)/(1 - x*y))", &["x", "y"]),
    ("asin(2*x*sqrt(1 - x^2)) - 2*asin(x)", &["x"]),
    ("asin(sin(x)) - x", &["x"]),
    ("sqrt(1 - sin(x)^2) - cos(x)", &["x"]),
    ("sqrt(x*y)*sqrt(y*z) - y*sqrt(x*z)", &[]),
    ("sqrt(x/y) - sqrt(x*y)/y", &[]),
    ("log(x*y) - log(x^2)/2 - log(y^2)", &[]),
    ("acos(x) - atan(sqrt(1 - x^2)/x)", &[]),
    ("sqrt(x + y - 2*sqrt(x*y)) - sqrt(x) + sqrt(y)", &["x", "y"]),
    ("sin(acos(x)/2) + sqrt((1 - x)/2)", &[]),
    ("cos(atan2(y, x)/2) - sqrt((1 + sin(atan2(y, x)))/2)", &[]),
    ("tan(3*pi/11) + 4*sin(2*pi/11) + sqrt(11)", &[]),
    ("cos(2*pi/7) - 0.6234898018587335305", &[]),
    ("abs(x^2 + x - 1) - x^2 - x + 1", &[]),
    // Facts about the functions that occur.
    ("sqrt(cos(x)^2) + cos(x)", &["cos(x)"]),
    ("abs(x - atan(x)) + x - atan(x)", &["x - atan(x)"]),
    ("abs(x - sin(x)) - sin(x) + x", &["x - sin(x)", "sin(x) - x^3/7"]),
    ("sqrt(x - sqrt(x)) + x", &["x - sqrt(x)"]),
];

/// Outside the normal form's scope, or without a value anywhere: neither answer may be given.
const OPEN: &[(&str, &[&str])] = &[
    ("sqrt(-1 - x^2)", &[]),
    ("1/(sqrt(x^2) - abs(x))", &[]),
    ("log(-x^2) - 1", &[]),
    ("sqrt(x)", &["-x"]),
    // The golden ratio, cubed: no rule takes cube roots of sums of roots apart.
    ("(2 + sqrt(5))^(1/3) - (1 + sqrt(5))/2", &[]),
];

#[test]
fn identities_are_proved() {
    for (text, positive) in ZERO {
        let (_, answer) = decided(&parse(text), positive);
        assert!(answer.is_zero(), "{text}: {answer:?}");
    }
}

#[test]
fn near_identities_are_refuted_with_a_witness() {
    for (text, positive) in NON_ZERO {
        let formula = parse(text);
        let (arena, answer) = decided(&formula, positive);
        let Answer::NonZero(witness) = answer else { panic!("{text}: {answer:?}") };
        let rational = |v: &Expr| arena.as_number(*v).expect("a rational coordinate").to_f64();
        let point: BTreeMap<String, f64> = witness.point.iter().map(|(s, v)| (arena.name(*s), rational(v))).collect();
        let (low, high) = (witness.value.lo(), witness.value.hi());
        assert!(low > 0.0 || high < 0.0, "{text}: [{low}, {high}] does not exclude zero");
        // Rounding of the floating-point walk, over a dozen operations on values of size 100 at most.
        let slack = 1e-12;
        let again = value(&formula, &point);
        assert!(again >= low - slack && again <= high + slack, "{text}: {again} outside [{low}, {high}] at {point:?}");
    }
}

#[test]
fn formulas_outside_the_scope_remain_open() {
    for (text, positive) in OPEN {
        let (_, answer) = decided(&parse(text), positive);
        assert!(matches!(answer, Answer::Open(_)), "{text}: {answer:?}");
    }
}

/// The signs of functions within functions are computed once each: otherwise every level would take thrice as long.
#[test]
fn functions_within_functions_are_decided() {
    let nested = |function: &str| format!("{}x{}", format!("{function}(").repeat(16), ")".repeat(16));
    for function in ["asin", "acos", "atan", "sqrt"] {
        let nested = nested(function);
        let (_, answer) = decided(&parse(&format!("({nested} + y)^2 - {nested}^2 - 2*y*{nested} - y^2")), &["x"]);
        assert!(matches!(answer, Answer::Zero | Answer::Open(Obstacle::NoPoint)), "{nested}: {answer:?}");
    }
}

/// An open question names the two that may be related.
#[test]
fn an_obstacle_names_two_kernels() {
    let (_, answer) = decided(&parse("(2 + sqrt(5))^(1/3) - (1 + sqrt(5))/2"), &[]);
    let Answer::Open(obstacle) = answer else { panic!("{answer:?}") };
    assert_eq!(obstacle.to_string(), "no rule shows whether sqrt(5) and (sqrt(5) + 2)^(1/3) are independent");
}

#[test]
fn every_function_takes_part_in_an_identity() {
    for row in Function::table() {
        let call = format!("{}(", row.name);
        assert!(ZERO.iter().any(|(text, _)| text.contains(&call)), "no identity with {}", row.name);
    }
}

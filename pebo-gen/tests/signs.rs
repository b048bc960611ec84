//! Signs over a domain, row by row: those that algebra proves of a formula where the assumptions hold, and those that
//! it must not.
//!
//! Every row is also evaluated in floating point, at points of its domain: a sign that one of them contradicts is
//! wrong, whatever the table says.

use std::collections::BTreeMap;

use pebo_cas::Arena;
use pebo_cas::graph::function::Value;
use pebo_cas::tower::Field;
use pebo_cas::{Facts, Relation};
use pebo_gen::model::formula::{Estimates, Formula, Operator, SpanMap, Term, parse_formula};
use pebo_gen::plant::{Scope, lower};

/// The proved sign of a formula.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum ProvedSign {
    Positive,
    NotNegative,
    Negative,
    NotPositive,
    Nothing,
    /// Nothing, although there is a sign: a failure means that more is proved than before.
    Open,
}
use ProvedSign::{Negative, NotNegative, NotPositive, Nothing, Open, Positive};

const NAMES: [&str; 6] = ["a", "b", "c", "x", "y", "z"];

/// Formula; assumptions, a formula that is positive or, with `>=` before it, not negative; the proved sign.
const TABLE: &[(&str, &[&str], ProvedSign)] = &[
    // Numbers, rational and not.
    ("3", &[], Positive),
    ("-1/7", &[], Negative),
    ("pi - 3", &[], Positive),
    ("pi - 22/7", &[], Negative),
    ("sqrt(2) - 1", &[], Positive),
    ("1 - exp(1)", &[], Negative),
    // Variables, by facts about one alone.
    ("x", &[], Nothing),
    ("x", &["x"], Positive),
    ("-x", &["x"], Negative),
    ("x", &[">= x"], NotNegative),
    ("x", &["x - 1"], Positive),
    ("x", &[">= x - 1"], Positive),
    ("x", &["x + 1"], Nothing),
    ("x", &["-x"], Negative),
    ("x", &["-x - 1"], Negative),
    ("x", &["1 - x"], Nothing),
    ("x", &["2*x - 3"], Positive),
    // A fact that is a fraction: of roots, its normal form may vanish where the fact holds, as at a = 1, b = -1.
    ("a*b", &["a/b"], Positive),
    ("(sqrt(a) + b)*(a - b^2)", &["1/(sqrt(a) - b)"], NotNegative),
    // Products and powers.
    ("x*y", &["x", "y"], Positive),
    ("x*y", &["x", "-y"], Negative),
    ("x*y", &["-x", "-y"], Positive),
    ("x*y", &["x"], Nothing),
    ("x*y", &[">= x", ">= y"], NotNegative),
    ("x*y", &[">= x", "y"], NotNegative),
    ("x*y", &[">= x", "-y"], NotPositive),
    ("x/y", &["x", "-y"], Negative),
    ("x^2", &[], NotNegative),
    ("-x^2", &[], NotPositive),
    ("x^3", &["x"], Positive),
    ("x^3", &["-x"], Negative),
    ("x^2*y", &["y"], NotNegative),
    ("x^2*y", &["y", "x"], Positive),
    ("x^2*y", &["y", "-x"], Positive),
    ("1/x^2", &["-x"], Positive),
    // Sums.
    ("x + y", &["x", "y"], Positive),
    ("x + y", &["x", ">= y"], Positive),
    ("x + y", &[">= x", ">= y"], NotNegative),
    ("x + y", &["-x", "-y"], Negative),
    ("x - y", &["x", "y"], Nothing),
    ("x^2 + 1", &[], Positive),
    ("x^2 + y^2", &[], NotNegative),
    ("x^2 + y^2", &["x"], Positive),
    ("x^2 - 1", &[], Nothing),
    ("x^4 + x^2*y^2 + 2", &[], Positive),
    // Facts about combinations.
    ("x - y", &["x - y"], Positive),
    ("x - y + 1", &["x - y"], Positive),
    ("x - y - 1", &["x - y"], Nothing),
    ("y - x", &["x - y"], Negative),
    ("x - z", &["x - y", "y - z"], Positive),
    ("x - z", &[">= x - y", ">= y - z"], NotNegative),
    ("x - z", &[">= x - y", "y - z"], Positive),
    ("x - z", &["x - y", "z - y"], Nothing),
    ("x*y - a*b", &["x*y - y*z", "y*z - z*a", "z*a - a*b"], Positive),
    ("a*b - c^2/2", &["a*b - c^2"], Positive),
    ("a*b - 2*c^2", &["a*b - c^2"], Nothing),
    ("1 - x", &["1 - x", "x"], Positive),
    ("2 - x", &["1 - x", "x"], Positive),
    ("x*(1 - x)", &["1 - x", "x"], Positive),
    ("x*(x - 1)", &["1 - x", "x"], Negative),
    ("1 - x^2", &["1 - x", "x"], Positive),
    ("1 - 3*x^2", &["1 - x", "x"], Nothing),
    // Factors, also hidden ones, and squares written out.
    ("x^2 - 2*x*y + y^2", &[], NotNegative),
    ("x^2 - 2*x*y + y^2", &["x - y"], Positive),
    ("-x^2 + 2*x*y - y^2", &[], NotPositive),
    ("(x - y)^3", &["x - y"], Positive),
    ("(x - y)^3", &["y - x"], Negative),
    ("x^3 - x^2*y", &["x", "x - y"], Positive),
    // Discriminants.
    ("x^2 + x + 1", &[], Positive),
    ("x^2 + 2*x + 1", &[], NotNegative),
    ("x^2 + 3*x + 1", &[], Nothing),
    ("-x^2 + x - 1", &[], Negative),
    ("x^2 + x*y + y^2", &[], NotNegative),
    ("x^2 + x*y + y^2 + 1", &[], Positive),
    ("x^4 + x^2 + 1", &[], Positive),
    ("a*x^2 + b*x + c", &["a", "4*a*c - b^2"], Positive),
    ("a*x^2 + b*x + c", &["-a", "4*a*c - b^2"], Negative),
    ("a*x^2 + b*x + c", &["a"], Nothing),
    ("y*x^2 + 2*x*y + y + z", &[">= y", ">= z"], NotNegative),
    // Functions.
    ("exp(x)", &[], Positive),
    ("exp(x) - 1", &[], Nothing),
    ("sqrt(x)", &["x"], Positive),
    ("sqrt(x)", &[">= x"], NotNegative),
    ("abs(x)", &[], NotNegative),
    ("abs(x) + 1", &[], Positive),
    ("1 - sin(x)", &[], NotNegative),
    ("2 - sin(x)", &[], Positive),
    ("1 + cos(x)", &[], NotNegative),
    ("cos(x) - 2", &[], Negative),
    ("sin(x) + cos(x)", &[], Nothing),
    ("3 + sin(x) + cos(x)", &[], Positive),
    ("1 - sin(x)^2/2", &[], Positive),
    ("a - b*cos(x)^2", &["a - b", "b"], Positive),
    ("a + b*cos(x)", &["a - b", "b"], Positive),
    ("a + b*cos(x)", &["b - a", "b"], Nothing),
    // Angles within a quadrant.
    ("cos(x)", &["x + pi/2", "pi/2 - x"], Positive),
    ("cos(x)", &[">= x + pi/2", ">= pi/2 - x"], NotNegative),
    ("cos(x)", &["x", "2 - x"], Nothing),
    ("sin(x)", &["x", "pi - x"], Positive),
    ("sin(x)", &["x", "4 - x"], Nothing),
    // Inverse functions.
    ("atan(x)", &["x"], Positive),
    ("atan(x)", &["-x"], Negative),
    ("atan(x)", &[], Nothing),
    ("acos(x)", &[], NotNegative),
    ("acos(x)", &["-x"], Positive),
    ("asin(x)", &[">= x"], NotNegative),
    ("atan2(x, y)", &["x"], Positive),
    ("atan2(x, y)", &["-x"], Negative),
    ("atan2(x, y)", &["y"], Nothing),
];

fn parse(text: &str) -> Formula {
    parse_formula(text, &SpanMap::verbatim(text, 0), Estimates::Refused).expect(text)
}

fn assumption(text: &str) -> (Formula, Relation) {
    match text.strip_prefix(">= ") {
        Some(rest) => (parse(rest), Relation::NonNegative),
        None => (parse(text), Relation::Positive),
    }
}

fn proved_sign(text: &str, assumptions: &[&str]) -> ProvedSign {
    let arena = Arena::new();
    let mut scope = Scope::new();
    for name in NAMES {
        scope.define(name, arena.variable(name));
    }
    let mut facts = Facts::new();
    for assumed in assumptions {
        let (formula, relation) = assumption(assumed);
        facts.assume(lower(&arena, &scope, &formula).expect(assumed), relation);
    }
    let expr = lower(&arena, &scope, &parse(text)).expect(text);
    let field = Field::over(&arena, &facts, &[expr]).expect(text);
    let fraction = field.fraction(expr).expect(text);
    let opposite = fraction.opposite();
    let is = |answer: Result<bool, _>| answer.expect(text);
    match (is(field.signs().is_positive(&fraction)), is(field.signs().is_positive(&opposite))) {
        (true, true) => panic!("{text} is said to be positive and negative"),
        (true, false) => Positive,
        (false, true) => Negative,
        (false, false) if is(field.signs().is_not_negative(&fraction)) => NotNegative,
        (false, false) if is(field.signs().is_not_negative(&opposite)) => NotPositive,
        (false, false) => Nothing,
    }
}

fn value(formula: &Formula, point: &BTreeMap<&str, f64>) -> f64 {
    let at = |f: &Formula| value(f, point);
    match &formula.term {
        Term::Number(decimal) => decimal.to_f64(),
        Term::Name(name) => point.get(name.as_str()).copied().unwrap_or(std::f64::consts::PI),
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
        Term::Call(function, arguments) => match function.row().value {
            Value::Unary(f) => f(at(&arguments[0])),
            Value::Binary(f) => f(at(&arguments[0]), at(&arguments[1])),
            Value::Tabulated(_) => f64::NAN,
        },
    }
}

/// A value has the sign, up to rounding.
fn agrees(proved_sign: ProvedSign, value: f64) -> bool {
    match proved_sign {
        Positive | NotNegative => value > -1e-9,
        Negative | NotPositive => value < 1e-9,
        Nothing | Open => true,
    }
}

#[test]
fn signs_are_those_of_the_table() {
    let wrong: Vec<String> = TABLE
        .iter()
        .map(|(text, facts, expected)| (text, facts, expected, proved_sign(text, facts)))
        .filter(|(_, _, expected, found)| *expected != found && !(**expected == Open && *found == Nothing))
        .map(|(text, facts, expected, found)| format!("{text} where {facts:?}: {found:?}, not {expected:?}"))
        .collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn no_sign_is_contradicted_by_a_point() {
    for (text, assumptions, expected) in TABLE {
        let formula = parse(text);
        let assumptions: Vec<_> = assumptions.iter().map(|text| assumption(text)).collect();
        let (mut inside, mut seen) = (0, [false; 2]);
        for number in 0..4000_u32 {
            // A lattice without pattern over [-4, 4].
            let share = |prime: f64| (f64::from(number) * prime.sqrt()).fract();
            let coordinates = [2.0, 3.0, 5.0, 7.0, 11.0, 13.0].map(|prime| 8.0 * share(prime) - 4.0);
            let point: BTreeMap<&str, f64> = NAMES.into_iter().zip(coordinates).collect();
            if !assumptions.iter().all(|(fact, _)| value(fact, &point) > 0.0) {
                continue;
            }
            let found = value(&formula, &point);
            if found.is_nan() {
                continue;
            }
            inside += 1;
            assert!(agrees(*expected, found), "{text} is {found} at {point:?}");
            seen[usize::from(found > 0.0)] = true;
        }
        assert!(inside > 10, "{text}: {inside} points of the domain");
        // Where nothing is proved there is no sign.
        let mixed = seen == [true, true];
        assert!(if *expected == Nothing { mixed } else { *expected != Open || !mixed }, "{text}: {seen:?}");
    }
}

use proptest::prelude::*;

use super::{
    Comparison, DEPTH_LIMIT, Decimal, Estimates, Formula, LENGTH_LIMIT, Operator, Relation, SpanMap, Term,
    parse_comparison, parse_formula,
};
use crate::source::{Code, Diagnostic, Source, Span};
use pebo_cas::Function;

fn parse(text: &str) -> Result<Formula, Diagnostic> {
    parse_formula(text, &SpanMap::verbatim(text, 0), Estimates::Allowed)
}

fn compare(text: &str) -> Result<Comparison, Diagnostic> {
    parse_comparison(text, &SpanMap::verbatim(text, 0), &[])
}

/// The formula with all its parentheses.
fn explicit(formula: &Formula) -> String {
    match &formula.term {
        Term::Number(number) => number.text().to_owned(),
        Term::Name(name) => name.clone(),
        Term::Estimate(name) => format!("hat({name})"),
        Term::Negative(operand) => format!("(-{})", explicit(operand)),
        Term::Binary(operator, left, right) => {
            let sign = match operator {
                Operator::Add => '+',
                Operator::Subtract => '-',
                Operator::Multiply => '*',
                Operator::Divide => '/',
                Operator::Power => '^',
            };
            format!("({}{sign}{})", explicit(left), explicit(right))
        }
        Term::Table(..) => formula.to_string(),
        Term::Call(function, arguments) => {
            let arguments: Vec<String> = arguments.iter().map(explicit).collect();
            format!("{}({})", function.row().name, arguments.join(","))
        }
    }
}

#[test]
fn precedence() {
    let cases = [
        ("-x^2", "(-(x^2))"),
        ("2^3^2", "(2^(3^2))"),
        ("2^-3^2", "(2^(-(3^2)))"),
        ("x^-1", "(x^(-1))"),
        ("x**2", "(x^2)"),
        ("-x**-y", "(-(x^(-y)))"),
        ("x^-1*y", "((x^(-1))*y)"),
        ("a/b*c", "((a/b)*c)"),
        ("a-b-c", "((a-b)-c)"),
        ("a-b+c", "((a-b)+c)"),
        ("a+b*c^d", "(a+(b*(c^d)))"),
        ("-a*b", "((-a)*b)"),
        ("a*-b", "(a*(-b))"),
        ("a--b", "(a-(-b))"),
        ("--a", "(-(-a))"),
        ("(a+b)*c", "((a+b)*c)"),
        ("(-x)^2", "((-x)^2)"),
        ("sin(x)^2", "(sin(x)^2)"),
        ("-sin (x)", "(-sin(x))"),
        ("ln(x)", "log(x)"),
        ("atan2(y, -x)/n", "(atan2(y,(-x))/n)"),
        ("2*pi*E", "((2*pi)*E)"),
        ("1.5e-3 + .5 + 2.", "((1.5e-3+.5)+2.)"),
        ("2e3*e", "(2e3*e)"),
        ("sin*exp + hat", "((sin*exp)+hat)"),
        ("hat( i1 ) - i1", "(hat(i1)-i1)"),
        (" x\t*\n y ", "(x*y)"),
    ];
    for (text, expected) in cases {
        let formula = parse(text).unwrap_or_else(|error| panic!("{text}: {}", error.message));
        assert_eq!(explicit(&formula), expected, "{text}");
    }
}

#[test]
fn mistakes() {
    let cases = [
        ("", Code::EmptyFormula, ""),
        ("  ", Code::EmptyFormula, "  "),
        ("a +", Code::UnexpectedToken, ""),
        ("a + * b", Code::UnexpectedToken, "*"),
        ("+a", Code::UnexpectedToken, "+"),
        ("a)", Code::UnexpectedToken, ")"),
        ("()", Code::UnexpectedToken, ")"),
        ("1,5", Code::UnexpectedToken, ","),
        ("a = b", Code::UnexpectedToken, "="),
        ("a < b", Code::UnexpectedToken, "<"),
        ("(a < b)", Code::UnexpectedToken, "<"),
        ("((a + b)", Code::UnclosedParenthesis, "("),
        ("atan2(a, b", Code::UnclosedParenthesis, "("),
        ("2 x", Code::ImplicitMultiplication, "2 x"),
        ("2x", Code::ImplicitMultiplication, "2x"),
        ("2e", Code::ImplicitMultiplication, "2e"),
        ("1.2.3", Code::ImplicitMultiplication, "1.2.3"),
        ("(a)(b)", Code::ImplicitMultiplication, ")("),
        ("a*(b c)", Code::ImplicitMultiplication, "b c"),
        ("sinn(a)", Code::UnknownFunction, "sinn"),
        ("v2(1 - d)", Code::UnknownFunction, "v2"),
        ("sin()", Code::ArgumentCount, "sin()"),
        ("sin(a, b)", Code::ArgumentCount, "sin(a, b)"),
        ("atan2(a)", Code::ArgumentCount, "atan2(a)"),
        ("hat(2)", Code::UnexpectedToken, "2"),
        ("a − b", Code::UnexpectedCharacter, "−"),
        ("a·b", Code::UnexpectedCharacter, "·"),
        ("λ*a", Code::UnexpectedCharacter, "λ"),
        ("a[1]", Code::UnexpectedCharacter, "["),
        ("v'", Code::UnexpectedCharacter, "'"),
        ("x^1000000000", Code::ExponentTooLarge, "1000000000"),
        ("x^-65", Code::ExponentTooLarge, "-65"),
        ("x^(8^8)", Code::ExponentTooLarge, "(8^8)"),
        ("x^(1/0)", Code::ExponentTooLarge, "(1/0)"),
        ("((x^64)^64)^2", Code::FormulaTooLarge, "((x^64)^64)^2"),
        ("1e999999999", Code::NumberTooLarge, "1e999999999"),
        ("1e-99999999999999999999", Code::NumberTooLarge, "1e-99999999999999999999"),
    ];
    for (text, code, underlined) in cases {
        let error = parse(text).expect_err(text);
        assert_eq!((error.code, &text[error.primary.span.range()]), (code, underlined), "{text}");
        assert!(error.help.is_some(), "{text}");
    }
}

#[test]
fn help_says_what_to_write() {
    let cases = [
        ("2 x", "write `2*x` for a product"),
        ("a − b", "write `-`"),
        ("λ*a", "write `lambda`"),
        ("sinn(a)", "did you mean `sin`?"),
        ("v2(1 - d)", "write `v2*(` for a product"),
        ("a²", "write `^2`"),
    ];
    for (text, help) in cases {
        assert_eq!(parse(text).expect_err(text).help.as_deref(), Some(help), "{text}");
    }
}

#[test]
fn estimates_are_refused_in_formulas_without_them() {
    let text = "a - hat(a)";
    let error = parse_formula(text, &SpanMap::verbatim(text, 0), Estimates::Refused);
    let error = error.expect_err("there is no estimate");
    assert_eq!((error.code, error.primary.span), (Code::MisplacedEstimate, Span::new(4, 7)));
    assert_eq!(parse("hat").map(|formula| formula.term), Ok(Term::Name("hat".to_owned())));
}

#[test]
fn comparisons() {
    let chain = compare("0 < d <= 2*b").expect("it compares");
    let pairs: Vec<_> = chain.pairs().map(|(l, relation, r)| (explicit(l), relation, explicit(r))).collect();
    let expected =
        [("0".to_owned(), Relation::Less, "d".to_owned()), ("d".to_owned(), Relation::LessOrEqual, "(2*b)".to_owned())];
    assert_eq!(pairs, expected);
    for (text, relation) in [("a>b", Relation::Greater), ("a >= b", Relation::GreaterOrEqual)] {
        assert_eq!(compare(text).map(|c| c.rest[0].0), Ok(relation), "{text}");
    }
    assert_eq!(compare("b != 0").map(|c| c.rest[0].0), Ok(Relation::NotEqual));
    let cases = [
        ("a", Code::ComparisonExpected, "a"),
        ("a = b", Code::UnexpectedToken, "="),
        ("a == b", Code::UnexpectedToken, "=="),
        ("a <", Code::UnexpectedToken, ""),
        ("< a", Code::UnexpectedToken, "<"),
        ("a ≤ b", Code::UnexpectedCharacter, "≤"),
    ];
    for (text, code, underlined) in cases {
        let error = compare(text).expect_err(text);
        assert_eq!((error.code, &text[error.primary.span.range()]), (code, underlined), "{text}");
    }
}

#[test]
fn every_node_has_its_span() {
    let text = "-(a + b2)*sin( c )^2";
    let formula = parse(text).expect("it parses");
    let mut spans = Vec::new();
    let mut waiting = vec![&formula];
    while let Some(formula) = waiting.pop() {
        spans.push(&text[formula.span.range()]);
        waiting.extend(formula.parts().into_iter().rev());
    }
    let expected = [text, "-(a + b2)", "(a + b2)", "a", "b2", "sin( c )^2", "sin( c )", "c", "2"];
    assert_eq!(spans, expected);
    let names: Vec<&str> = formula.names().into_iter().map(|(name, _)| name).collect();
    assert_eq!(names, ["a", "b2", "c"]);
}

#[test]
fn every_function_is_called_by_its_name() {
    for function in Function::table() {
        let arguments = vec!["a"; function.arity].join(",");
        let text = format!("{}({arguments})", function.name);
        assert_eq!(parse(&text).map(|formula| explicit(&formula)), Ok(text));
    }
}

#[test]
fn decimals_are_exact() {
    let cases = [
        ("12", (false, "12", 0)),
        ("10e-3", (false, "10", -3)),
        ("-2.29e-05", (true, "229", -7)),
        (".5", (false, "5", -1)),
        ("5.", (false, "5", 0)),
        ("1E+2", (false, "1", 2)),
    ];
    for (text, (negative, digits, exponent)) in cases {
        let parts = Decimal::parse(text, Span::default()).expect(text).parts();
        assert_eq!((parts.negative, parts.digits.as_str(), parts.exponent), (negative, digits, exponent));
    }
    for text in ["", "-", ".", "1e", "e5", "1.2.3", "0x10", "1_000", "inf", "--1", "+1", "1 "] {
        let error = Decimal::parse(text, Span::default()).expect_err(text);
        assert_eq!(error.code, Code::MalformedNumber, "{text}");
    }
    let digits = "1".repeat(401);
    let error = Decimal::parse(&digits, Span::default()).expect_err("too many digits");
    assert_eq!(error.code, Code::NumberTooLarge);
}

#[test]
fn size_and_depth_are_bounded() {
    let nested = |open: &str, close: &str, n: usize| open.repeat(n) + "x" + &close.repeat(n);
    let limit = DEPTH_LIMIT - 1;
    for (open, close) in [("(", ")"), ("-", ""), ("sin(", ")"), ("x^", ""), ("", "*x")] {
        assert!(parse(&nested(open, close, limit)).is_ok(), "{limit} times {open}{close}");
        let error = parse(&nested(open, close, 10_000)).expect_err(open);
        let code = error.code;
        assert!(code == Code::FormulaTooDeep || code == Code::FormulaTooLarge, "{open}{close}");
    }
    let error = parse(&" ".repeat(LENGTH_LIMIT + 1)).expect_err("too long");
    assert_eq!(error.code, Code::FormulaTooLarge);
}

/// The levels of a formula, and its value with every name zero.
fn measured(formula: &Formula) -> (usize, f64) {
    let parts: Vec<_> = formula.parts().into_iter().map(measured).collect();
    let value = match (&formula.term, parts.as_slice()) {
        (Term::Number(number), _) => number.to_f64(),
        (Term::Negative(_), [(_, value)]) => -value,
        (Term::Binary(Operator::Add, ..), [(_, a), (_, b)]) => a + b,
        (Term::Binary(Operator::Subtract, ..), [(_, a), (_, b)]) => a - b,
        _ => 0.0,
    };
    (1 + parts.iter().map(|(levels, _)| *levels).max().unwrap_or(0), value)
}

#[test]
fn a_long_sum_is_not_deep() {
    for terms in [2_u32, 64, 65, 80, 81, 201, 4000] {
        let sign = |k: u32| if k == 1 || k.is_multiple_of(3) { "+" } else { "-" };
        let text = (2..=terms).fold("1".to_owned(), |text, k| text + sign(k) + &k.to_string());
        let expected: f64 = (1..=terms).map(|k| if sign(k) == "+" { f64::from(k) } else { -f64::from(k) }).sum();
        let formula = parse(&text).expect("a sum");
        let (levels, value) = measured(&formula);
        assert!((value - expected).abs() < 0.5 && levels <= 65, "{terms}: {value}, {levels} levels");
        assert_eq!(formula.span.range(), 0..text.len());
    }
    let sum = format!("x{}", "+x".repeat(10_000));
    assert_eq!(parse(&sum).map(|formula| formula.names().len()), Ok(10_001));
    let nested = format!("{}x{}", "(x+".repeat(10_000), ")".repeat(10_000));
    assert!(parse(&nested).is_err());
}

#[test]
fn spans_survive_the_scalar_styles_of_yaml() {
    let cases = [
        ("a + bb*c", "a + bb*c"),
        ("'a + bb*c'", "a + bb*c"),
        ("a +\n    bb*c", "a + bb*c"),
        ("\"a +\n\n  bb*c\"", "a +\nbb*c"),
        ("a\n  + bb*c\n", "a\n+ bb*c\n"),
    ];
    for (raw, text) in cases {
        let source = Source::new("m", format!("é: {raw}")).expect("it is small");
        let spans = SpanMap::align(text, Span::new(4, 4 + raw.len()), &source);
        let formula = parse_formula(text, &spans, Estimates::Refused).expect(text);
        let names: Vec<&str> = formula.names().into_iter().map(|(_, span)| source.slice(span)).collect();
        assert_eq!(names, ["a", "bb", "c"], "{raw}");
    }
    // An escape: its parts have the span of the whole scalar.
    let source = Source::new("m", r#""a\x2bb""#).expect("it is small");
    let whole = Span::new(0, 8);
    assert_eq!(SpanMap::align("a+b", whole, &source).span(0, 1), whole);
}

proptest! {
    #[test]
    fn nothing_panics(text in "[a-e0-9+*/^()., <>=!.é−-]{0,60}") {
        let _ = parse(&text);
        let _ = compare(&text);
    }

    #[test]
    fn spans_lie_inside_the_text(text in "[ab12+*/^() -]{0,30}") {
        let span = match parse(&text) {
            Ok(formula) => formula.span,
            Err(error) => error.primary.span,
        };
        prop_assert!(text.get(span.range()).is_some());
    }

    #[test]
    fn what_is_explicit_parses_to_itself(text in "[ab12+*/^() -]{0,30}") {
        if let Ok(formula) = parse(&text) {
            let once = explicit(&formula);
            prop_assert_eq!(parse(&once).map(|formula| explicit(&formula)), Ok(once));
        }
    }
}

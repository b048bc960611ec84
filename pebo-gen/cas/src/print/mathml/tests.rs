use std::collections::BTreeMap;

use crate::{Arena, Expr, Function, Rational};

/// The expression without grouping elements, and with visible signs.
fn set(arena: &Arena, expr: Expr) -> String {
    let text = arena.mathml(expr);
    assert_well_formed(&text);
    let inner = text.strip_prefix("<math>").and_then(|rest| rest.strip_suffix("</math>")).expect("a math element");
    inner.replace("<mrow>", "").replace("</mrow>", "").replace("&#x2061;", "@").replace("&#x2062;", "*")
}

/// Every element is closed where it was opened, and text holds no mark of an element.
fn assert_well_formed(text: &str) {
    let mut open: Vec<&str> = Vec::new();
    let mut rest = text;
    while let Some((before, after)) = rest.split_once('<') {
        assert!(!before.contains('>'), "{text}");
        for entity in before.split('&').skip(1) {
            let (name, _) = entity.split_once(';').unwrap_or_else(|| panic!("a bare ampersand in {text}"));
            assert!(["amp", "lt", "gt", "quot"].contains(&name) || name.starts_with('#'), "&{name}; in {text}");
        }
        let (tag, after) = after.split_once('>').expect("an end of the tag");
        match tag.strip_prefix('/') {
            Some(name) => assert_eq!(open.pop(), Some(name), "{text}"),
            None => open.push(tag),
        }
        rest = after;
    }
    assert!(open.is_empty() && rest.is_empty(), "{text}");
}

#[test]
fn names_have_greek_letters_and_indices() {
    let arena = Arena::new();
    for (name, expected) in [
        ("x", "<mi>x</mi>"),
        ("theta1", "<msub><mi>θ</mi><mn>1</mn></msub>"),
        ("L_1", "<msub><mi>L</mi><mn>1</mn></msub>"),
        ("i12", "<msub><mi>i</mi><mn>12</mn></msub>"),
        ("Psi11", "<msub><mi>Ψ</mi><mn>11</mn></msub>"),
        ("lambda_m", "<msub><mi>λ</mi><mi>m</mi></msub>"),
        ("v_alpha", "<msub><mi>v</mi><mi>α</mi></msub>"),
        ("C_d_1", "<msub><mi>C</mi><mi>d</mi><mo>,</mo><mn>1</mn></msub>"),
        ("soc", "<mi>soc</mi>"),
        ("a_", "<mi>a</mi>"),
        ("_a", "<mi>_a</mi>"),
        ("1", "<mi>1</mi>"),
    ] {
        assert_eq!(set(&arena, arena.of_symbol(arena.symbol(name))), expected, "{name}");
    }
}

#[test]
fn any_name_gives_well_formed_elements() {
    let arena = Arena::new();
    for name in ["<b>", "a&b", "\"'", "]]>", "a\u{0}b", "\u{1b}[0m", "\u{fffe}", "é", "", "_", "&lt;", "a_<_>"] {
        set(&arena, arena.of_symbol(arena.symbol(name)));
    }
    assert_eq!(set(&arena, arena.of_symbol(arena.symbol("a<&b"))), "<mi>a&lt;&amp;b</mi>");
}

/// Numbers, powers, fractions, functions, and the positions of parentheses.
#[test]
fn formulas_are_set_as_they_are_read() {
    let arena = Arena::new();
    let [a, b, c, soc] = ["a", "b", "c", "soc"].map(|name| arena.of_symbol(arena.symbol(name)));
    let (sum, two) = (arena.add(a, b), Rational::from(2));
    let fraction = |n, d| Rational::new(n, d).expect("a fraction");
    let number = |value: Rational| arena.number(value);
    let call = |function, argument| arena.call(function, &[argument]);
    for (expr, expected) in [
        (number(fraction(981, 100)), "<mn>9.81</mn>"),
        (number(fraction(-1, 3)), "<mo>−</mo><mfrac><mn>1</mn><mn>3</mn></mfrac>"),
        (number(fraction(11, 500_000)), "<mn>2.2</mn><mo>⋅</mo><msup><mn>10</mn><mo>−</mo><mn>5</mn></msup>"),
        (arena.pi(), "<mi>π</mi>"),
        (arena.sub(a, b), "<mi>a</mi><mo>−</mo><mi>b</mi>"),
        (arena.sub(arena.one(), a), "<mn>1</mn><mo>−</mo><mi>a</mi>"),
        (arena.neg(a), "<mo>−</mo><mi>a</mi>"),
        (arena.mul(a, b), "<mi>a</mi><mo>*</mo><mi>b</mi>"),
        (arena.mul(a, soc), "<mi>a</mi><mo>⋅</mo><mi>soc</mi>"),
        (arena.mul(arena.number(2), a), "<mn>2</mn><mo>*</mo><mi>a</mi>"),
        (arena.mul(sum, c), "<mi>c</mi><mo>*</mo><mo>(</mo><mi>a</mi><mo>+</mo><mi>b</mi><mo>)</mo>"),
        (
            arena.neg(arena.mul(sum, c)),
            "<mo>−</mo><mi>c</mi><mo>*</mo><mo>(</mo><mi>a</mi><mo>+</mo><mi>b</mi><mo>)</mo>",
        ),
        (arena.div(a, sum), "<mfrac><mi>a</mi><mi>a</mi><mo>+</mo><mi>b</mi></mfrac>"),
        (arena.div(sum, c), "<mfrac><mi>a</mi><mo>+</mo><mi>b</mi><mi>c</mi></mfrac>"),
        (arena.div(a, arena.mul(arena.number(2), b)), "<mfrac><mi>a</mi><mn>2</mn><mo>*</mo><mi>b</mi></mfrac>"),
        (arena.power(a, &two), "<msup><mi>a</mi><mn>2</mn></msup>"),
        (arena.power(sum, &two), "<msup><mo>(</mo><mi>a</mi><mo>+</mo><mi>b</mi><mo>)</mo><mn>2</mn></msup>"),
        (arena.div(arena.one(), arena.power(a, &two)), "<mfrac><mn>1</mn><msup><mi>a</mi><mn>2</mn></msup></mfrac>"),
        (arena.sqrt(sum), "<msqrt><mi>a</mi><mo>+</mo><mi>b</mi></msqrt>"),
        (arena.power(a, &fraction(1, 3)), "<msup><mi>a</mi><mn>1</mn><mo>/</mo><mn>3</mn></msup>"),
        (
            arena.mul(a, call(Function::Sin, sum)),
            "<mi>a</mi><mo>⋅</mo><mi>sin</mi><mo>@</mo><mo>(</mo><mi>a</mi><mo>+</mo><mi>b</mi><mo>)</mo>",
        ),
        (call(Function::Asin, a), "<mi>arcsin</mi><mo>@</mo><mo>(</mo><mi>a</mi><mo>)</mo>"),
        (call(Function::Log, a), "<mi>ln</mi><mo>@</mo><mo>(</mo><mi>a</mi><mo>)</mo>"),
        (call(Function::Abs, a), "<mo>|</mo><mi>a</mi><mo>|</mo>"),
        (
            arena.call(Function::Atan2, &[a, b]),
            "<mi>atan2</mi><mo>@</mo><mo>(</mo><mi>a</mi><mo>,</mo><mi>b</mi><mo>)</mo>",
        ),
    ] {
        assert_eq!(set(&arena, expr), expected, "{}", arena.print(expr));
    }
}

#[test]
fn every_function_of_the_table_is_set() {
    let arena = Arena::new();
    let arguments = [arena.of_symbol(arena.symbol("a")), arena.of_symbol(arena.symbol("b"))];
    for row in Function::table() {
        let text = set(&arena, arena.call(row.function, &arguments[..row.arity]));
        assert!(text.contains(row.typeset()) || text.contains("<msqrt>") || text.contains('|'), "{}: {text}", row.name);
        assert!(row.typeset().chars().all(char::is_alphanumeric), "{}", row.typeset());
    }
}

/// Shared subexpressions are set at every use: a formula longer than any page is not set.
#[test]
fn a_formula_that_no_page_holds_is_not_set() {
    let arena = Arena::new();
    let mut expr = arena.of_symbol(arena.symbol("a"));
    for _ in 0..40 {
        expr = arena.call(Function::Atan2, &[expr, expr]);
    }
    assert!(set(&arena, expr).starts_with("<mtext>(a formula of more than"));
}

/// A substituted formula is set as it was given, in parentheses where needed.
#[test]
fn a_substitution_is_shown_before_anything_is_made_of_it() {
    let arena = Arena::new();
    let [z, a, b] = ["z1", "a", "b"].map(|name| arena.of_symbol(arena.symbol(name)));
    let shown = BTreeMap::from([(arena.symbol("z1"), arena.sub(a, b))]);
    let elements = |expr| arena.mathml_elements(expr, &shown);
    let parts = "<mi>a</mi><mo>−</mo><mi>b</mi>";
    // Nothing cancels.
    assert_eq!(elements(arena.add(z, b)).matches("<mi>b</mi>").count(), 2);
    assert!(elements(arena.mul(arena.number(2), z)).contains(&format!("<mo>(</mo>{parts}<mo>)</mo>")));
    assert_eq!(elements(z), parts);
}

#[test]
fn a_parameter_is_set_as_its_decimal() {
    let arena = Arena::new();
    let value = |n, d| arena.mathml_value(&Rational::new(n, d).expect("a fraction"));
    assert_eq!([value(49, 5), value(-3, 2), value(7, 1)], ["<mn>9.8</mn>", "<mo>−</mo><mn>1.5</mn>", "<mn>7</mn>"]);
    assert_eq!(value(1, 3), "<mfrac><mn>1</mn><mn>3</mn></mfrac>");
}

#[test]
fn a_rate_has_its_point_over_the_letter() {
    let arena = Arena::new();
    let rate = arena.mathml_rate(arena.symbol("v_2"));
    assert_eq!(rate, "<msub><mover accent=\"true\"><mi>v</mi><mo stretchy=\"false\">˙</mo></mover><mn>2</mn></msub>");
}

use super::{
    Code, Colour, Diagnostic, Diagnostics, LocatedDiagnostic, SIZE_LIMIT, Source, Span, listed, nearest, quoted, render,
};

fn source(text: &str) -> Source {
    Source::new("cuk.yaml", text).expect("the text is small")
}

#[test]
fn positions_count_lines_and_characters_from_one() {
    let source = source("a: é+x\r\nb: 2\n");
    let positions = [(0, (1, 1)), (3, (1, 4)), (5, (1, 5)), (4, (1, 4)), (9, (2, 1)), (99, (3, 1))];
    for (offset, (line, column)) in positions {
        let position = source.position(offset);
        assert_eq!((position.line, position.column), (line, column), "offset {offset}");
    }
}

#[test]
fn a_byte_order_mark_takes_no_column() {
    let source = Source::from_bytes("m", b"\xef\xbb\xbfmodel: m".to_vec()).expect("it is text");
    assert_eq!(source.text(), "model: m");
}

#[test]
fn slices_end_on_whole_characters() {
    let source = source("aé");
    assert_eq!(source.slice(Span::new(0, 2)), "a");
    assert_eq!(source.slice(Span::new(1, 99)), "é");
    assert_eq!(source.slice(Span::new(50, 99)), "");
}

#[test]
fn only_small_texts_are_accepted() {
    let code = |bytes: Vec<u8>| Source::from_bytes("m", bytes).map_err(|d| d.code);
    assert_eq!(code(vec![b'a', 0xff]), Err(Code::NotText));
    assert_eq!(code(vec![b'a'; SIZE_LIMIT + 1]), Err(Code::FileTooLarge));
    assert!(code(vec![b'a'; SIZE_LIMIT]).is_ok());
}

#[test]
fn codes_are_unique_and_found_by_name() {
    for code in Code::ALL {
        assert_eq!(Code::from_name(code.name()), Some(*code));
        assert!(!code.title().is_empty() && code.explanation().ends_with('.'), "{}", code.name());
        assert!(code.example().ends_with('\n') && code.example().lines().count() <= 20, "{}", code.name());
        assert!(code.name().bytes().all(|byte| byte == b'-' || byte.is_ascii_lowercase()));
    }
    assert_eq!(Code::from_name("no-such-code"), None);
}

#[test]
fn a_picture_has_spans_notes_and_help() {
    let source = source("parameters: {R: 1}\nx: [φ, R]\n");
    let diagnostic = Diagnostic::error(Code::DuplicateName, Span::new(27, 28), "`R` again")
        .label("here")
        .also(Span::new(13, 14), "first here")
        .note("names are declared once")
        .help("rename one of them");
    let expected = "\
error[duplicate-name]: `R` again
 --> cuk.yaml:2:8
  |
1 | parameters: {R: 1}
  |              - first here
2 | x: [φ, R]
  |        ^ here
  |
  = note: names are declared once
  = help: rename one of them
";
    assert_eq!(render(std::slice::from_ref(&diagnostic), &source, Colour::Never), expected);
    assert!(render(&[diagnostic], &source, Colour::Always).contains("\u{1b}["));
}

#[test]
fn every_span_can_be_pictured() {
    let long = "x".repeat(200_000);
    for text in ["", "\n", "é", "a\r\nb", "\t\u{1b}[31m", &long] {
        let source = source(text);
        for span in [Span::default(), Span::new(1, 2), Span::new(0, text.len()), Span::point(9)] {
            let diagnostic = Diagnostic::error(Code::YamlSyntax, span, "no").also(span, "here");
            let picture = render(&[diagnostic], &source, Colour::Never);
            assert!(picture.len() < 2000 && !picture.contains('\u{1b}'), "{picture}");
        }
    }
}

#[test]
fn json_has_the_documented_fields() {
    let source = source("a\nbé: c\n");
    let json = |diagnostic: Diagnostic| {
        serde_json::to_string(&LocatedDiagnostic::new(&diagnostic, &source)).expect("it serialises")
    };
    assert_eq!(
        json(Diagnostic::error(Code::UnknownKey, Span::new(7, 8), "unknown key").suggest(Some("d"))),
        r#"{"code":"unknown-key","severity":"error","message":"unknown key","line":2,"column":5,"help":"did you mean `d`?","span":{"start":7,"end":8},"label":"","labels":[],"notes":[],"replacement":"d"}"#
    );
    let nowhere = Diagnostic::warning(Code::UnknownKey, Span::NOWHERE, "no").label("here").note("a fact");
    assert_eq!(
        json(nowhere.also(Span::new(0, 1), "and here")),
        r#"{"code":"unknown-key","severity":"warning","message":"no","line":1,"column":1,"help":null,"span":null,"label":"here","labels":[{"span":{"start":0,"end":1},"text":"and here"}],"notes":["a fact"],"replacement":null}"#
    );
}

#[test]
fn a_pass_ends_with_all_its_diagnostics_in_order() {
    let mut diagnostics = Diagnostics::new();
    assert!(diagnostics.propagate().is_ok());
    diagnostics.push(Diagnostic::warning(Code::UnknownKey, Span::point(3), "hm"));
    assert!(diagnostics.propagate().is_ok(), "a warning stops nothing");
    for start in (0..100).rev() {
        diagnostics.push(Diagnostic::error(Code::UnknownKey, Span::point(start), "no"));
    }
    let found = diagnostics.propagate().expect_err("there are errors");
    assert_eq!(found.len(), 40);
    assert!(found.is_sorted_by_key(|diagnostic| diagnostic.primary.span));
    assert_eq!(found[39].notes, ["61 more are not shown"]);
}

#[test]
fn near_names_are_found_and_far_ones_are_not() {
    let names = ["parameters", "phi", "phi_left", "i1", "E", "sin", "v2"];
    let cases = [
        ("paramters", Some("parameters")),
        ("phileft", Some("phi_left")),
        ("sni", Some("sin")),
        ("I1", Some("i1")),
        ("e", Some("E")),
        ("v", Some("v2")),
        ("q", None),
        ("omega", None),
        ("", None),
    ];
    for (name, expected) in cases {
        assert_eq!(nearest(name, names), expected, "{name}");
    }
    assert_eq!(nearest(&"a".repeat(100), ["a"]), None);
}

#[test]
fn quoted_texts_are_short_and_harmless() {
    assert_eq!(quoted("a\n\u{1b}'"), "`a\\n\\u{1b}'`");
    assert!(quoted(&"é".repeat(1000)).chars().count() < 60);
    assert_eq!(listed(["a", "b"]), "`a`, `b`");
}

#[test]
fn a_nearest_name_is_the_replacement() {
    let diagnostic = Diagnostic::error(Code::UnknownKey, Span::new(0, 2), "unknown key");
    assert_eq!(diagnostic.clone().suggest(Some("phi")).replacement(), Some("phi"));
    assert_eq!(diagnostic.help("did you mean `phi`?").replacement(), None);
    let elsewhere = Diagnostic::error(Code::WrongChoice, Span::NOWHERE, "said in the call");
    assert_eq!(elsewhere.suggest(Some("truth")).replacement(), None);
}

//! Models by class with the found transform written into them.

use pebo_gen::source::Source;
use pebo_gen::{Request, Standing, answer, solve};

/// The text with its transform, which is accepted as it is.
fn filled(text: &str) -> String {
    let source = Source::new("m.yaml", text).expect("a text");
    let solution = solve(&source, None, &Request::new());
    assert_eq!(solution.standing, Standing::Accepted, "{text}");
    let filled = solution.filled.unwrap_or_else(|| panic!("nothing was written: {text}"));
    let again = answer(&Source::new("m.yaml", filled.as_str()).expect("a text"), &Request::new());
    assert_eq!(again.standing, Standing::Accepted, "{filled}");
    assert!(again.report.line().contains(r#""phi":{"origin":"class""#), "{filled}");
    filled
}

const HEAD: &str = "model: m   # name\nparameters: {b: 0.8, c: 1.5}\nx: [p1, p2]\ny: [q1, q2]\nu: [u]\n\
                    assume: [c > 0, b > 0, b^2 < c]\n";

#[test]
fn a_frame_is_written_among_the_lines_of_a_mechanical_plant() {
    let before = "mechanical:\n  M: [[1, b*cos(q1)], [b*cos(q1), c]]   # inertia\n  V: cos(q1)\n  G: [[0], [1]]\n";
    let after = "# the end\n";
    let text = filled(&format!("{HEAD}{before}{after}"));
    let rest = text.strip_prefix(&format!("{HEAD}{before}")).expect("what was there");
    let line = rest.strip_suffix(after).expect("what was there");
    assert!(line.starts_with("  T: [[") && line.lines().count() == 1, "{text}");
}

#[test]
fn a_frame_is_written_into_the_braces_of_a_mechanical_plant() {
    let before = "mechanical: {M: [[1, b*cos(q1)], [b*cos(q1), c]], V: cos(q1), G: [[0], [1]]";
    let text = filled(&format!("{HEAD}{before}}}   # {{q}}\n"));
    assert!(text.starts_with(&format!("{HEAD}{before}, T: [[")), "{text}");
}

#[test]
fn another_frame_takes_the_place_of_one_that_is_refused() {
    let before = "mechanical:\n  M: [[1, b*cos(q1)], [b*cos(q1), c]]\n";
    let after = "  V: cos(q1)\n  G: [[0], [1]]\n";
    let text = filled(&format!("{HEAD}{before}  T:\n    - [1, 0]\n    - [0, 1]\n{after}"));
    let line = text.strip_prefix(&format!("{HEAD}{before}{after}")).unwrap_or_else(|| panic!("{text}"));
    assert!(line.starts_with("  T: [[") && line.lines().count() == 1, "{text}");
}

#[test]
fn the_factors_of_a_linear_plant_are_written() {
    let text = "model: m\nx: [i]\ny: [v]\nu: [e]\nlti:\n  A11: [[-2]]  # loss\n  A21: [[3]]\n  B1: [[1]]\n# end\n";
    let expected = text.replace("# end", "  T1: [[1]]\n  T2: [[2/3]]\n# end");
    assert_eq!(filled(text), expected);
}

//! Pages say all that is proved, are well-formed whatever a model says, and have a size that a browser takes. How they
//! look, `tests/pages/check.py` tests in a browser.

use std::path::PathBuf;

use pebo_gen::source::Source;
use pebo_gen::{Answer, Request, Standing, answer};

fn asked(text: &str) -> Answer {
    let source = Source::new("m.yaml", text).expect("a text");
    answer(&source, &Request::new().page().mathml())
}

fn page(text: &str) -> String {
    let page = asked(text).page.expect("a plant is made");
    assert_well_formed(&page);
    page
}

/// Every element is closed in its order, every attribute quoted, every reference known.
fn assert_well_formed(page: &str) {
    let mut open = Vec::new();
    let mut rest = page.strip_prefix("<!DOCTYPE html>\n").expect("a page");
    while let Some((text, after)) = rest.split_once('<') {
        let is_style = open.last() == Some(&"style");
        assert!(is_style || !text.contains('>'), "{text}");
        for reference in text.split('&').skip(1) {
            let name = reference.split(';').next().expect("a part");
            let is_number = name.strip_prefix('#').is_some_and(|number| !number.is_empty());
            assert!(["amp", "lt", "gt", "quot"].contains(&name) || is_number, "&{name}; in {text}");
        }
        let (tag, after) = after.split_once('>').expect("an end of the tag");
        assert!(tag.matches('"').count() % 2 == 0 && !tag.contains('<'), "{tag}");
        match (tag.strip_prefix('/'), tag.ends_with('/')) {
            (Some(closed), _) => assert_eq!(open.pop(), Some(closed)),
            (None, true) => {}
            (None, false) => open.push(tag.split_whitespace().next().expect("a name")),
        }
        rest = after;
    }
    assert!(open.is_empty() && rest.trim().is_empty(), "{open:?} {rest}");
}

/// The model files of the project.
fn shipped() -> Vec<PathBuf> {
    let entries = std::fs::read_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/../models")).expect("the models");
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.expect("an entry").path()).collect();
    paths.retain(|path| path.extension().is_some_and(|extension| extension == "yaml"));
    paths.sort();
    paths
}

/// The model without the closed loop, which takes its time and is of the tests that run it.
fn without_a_run(path: &PathBuf) -> String {
    let text = std::fs::read_to_string(path).expect("a model");
    text.split("\nsimulation:").next().expect("a part").to_owned() + "\n"
}

#[test]
fn the_page_of_every_shipped_model_has_every_formula_of_its_claims() {
    let models = shipped();
    assert!(models.len() > 10);
    for path in models {
        let answer = asked(&without_a_run(&path));
        let (page, typeset) = (answer.page.expect("a page"), answer.mathml.expect("asked for"));
        assert_eq!(answer.standing, Standing::Accepted);
        assert_well_formed(&page);
        let formulas = typeset.h.iter().chain(typeset.lambda.iter().flatten()).chain(&typeset.phi_0);
        let formulas = formulas.chain(typeset.phi_1.iter().flatten()).chain(typeset.phi_left.values());
        for formula in formulas {
            let elements = formula.strip_prefix("<math>").and_then(|rest| rest.strip_suffix("</math>"));
            assert!(page.contains(elements.expect("a math element")), "{}: {formula}", path.display());
        }
        for id in ["plant", "transform", "cascade", "left-inverse", "regression", "identifiability", "code"] {
            assert!(page.contains(&format!("<section id=\"{id}\">")), "{}: {id}", path.display());
        }
        let verdicts = page.matches("<p class=\"verdict\" data-verdict=\"proved\">").count();
        assert_eq!(verdicts, 5, "{}: of the model and of each claim", path.display());
        assert!(!page.contains("too long for a page") && !page.contains("<script"), "{}", path.display());
        assert!(page.len() < 300_000, "{}: {}", path.display(), page.len());
    }
}

const PLANT: &str = "x: [p]\ny: [q]\nu: [v]\n";

#[test]
fn terms_that_cancel_are_shown_before_they_do() {
    let model = format!("model: m\n{PLANT}f_x: {{p: \"v - 2*p\"}}\nf_y: {{q: p}}\nphi: [p + 2*q]\n");
    let page = page(&model);
    let twice = |name: &str| format!("<mn>2</mn><mo>&#x2062;</mo><mi>{name}</mi>");
    let cancelling = format!("{}<mo>−</mo>{}", twice("p"), twice("p"));
    assert!(
        page.contains(&format!(
            "{cancelling}</mtd><mtd class=\"equals\"><mo>=</mo></mtd><mtd class=\"right\"><mn>0</mn>"
        )),
        "{page}"
    );
    // The transform in the left inverse, before anything cancels: (2q + p) - 2q = p.
    let checked = format!("<mo>(</mo>{}<mo>+</mo><mi>p</mi><mo>)</mo></mrow><mo>−</mo>{}", twice("q"), twice("q"));
    assert!(page.contains(&checked), "{page}");
}

#[test]
fn text_of_an_author_is_escaped() {
    let hostile = "</title><script>alert(1)</script>&\\\"'\\u0007]]>";
    let model = format!(
        "model: m\ntitle: \"{hostile}\"\nreference: \"{hostile}\"\n{PLANT}# </code></pre><script>\nf_x: {{p: v}}\nf_y: {{q: p}}\nphi: [p]\n"
    );
    let page = page(&model);
    assert!(page.contains("&lt;/title&gt;&lt;script&gt;alert(1)") && !page.contains("<script"), "{page}");
}

#[test]
fn a_refused_model_and_an_undecided_one_have_pages_that_say_why() {
    let refused = format!("model: m\n{PLANT}f_x: {{p: v - p^2}}\nf_y: {{q: p}}\nphi: [p]\n");
    let answer = asked(&refused);
    assert_eq!(answer.standing, Standing::Refused);
    let page = answer.page.expect("a page");
    assert_well_formed(&page);
    for part in ["error[cascade-refuted]", "data-verdict=\"refuted\"", "data-verdict=\"skipped\"", "do not cancel"] {
        assert!(page.contains(part), "{part}");
    }
    assert!(!page.contains("id=\"code\"") && !page.contains("href=\"#code\""));
    let without = self::page("model: m\nx: [p]\ny: [q]\nf_x: {p: sin(p)*q + p^2}\nf_y: {q: p}\n");
    assert!(without.contains("error[transform-not-found]"), "{without}");
    assert_eq!(asked("model: m\nx: [p]\n").page, None, "of this no plant is made");
}

/// A formula that nobody reads is left out, and the text in its stead says where it is.
#[test]
fn a_huge_formula_leaves_the_page_small() {
    let powers = (1..40).flat_map(|i| (1..40).map(move |j| format!("{}*v^{i}*q^{j}", 40 * i + j)));
    let rate = powers.collect::<Vec<_>>().join(" + ");
    let model = format!("model: m\n{PLANT}f_x: {{p: \"v + {rate}\"}}\nf_y: {{q: p}}\nphi: [p]\n");
    let answer = asked(&model);
    let page = answer.page.expect("a page");
    assert_well_formed(&page);
    assert!(page.contains("too long for a page") && page.len() < 5_000_000, "{}", page.len());
}

/// A page without its figure says why, in place of the figure and in the answer of the call.
#[test]
fn a_loop_that_fails_is_not_passed_over() {
    let model = format!(
        "model: m\n{PLANT}f_x: {{p: v}}\nf_y: {{q: p}}\nsimulation: {{duration: 1, step: 0.1, initial: {{p: 0, q: 0}}, \
         control: {{v: 1/(1 - 2*t)}}}}\n"
    );
    let answer = asked(&model);
    assert_eq!(answer.standing, Standing::Refused, "{:#?}", answer.diagnostics);
    let page = answer.page.expect("it is accepted");
    assert_well_formed(&page);
    assert!(
        page.contains("<section id=\"run\">") && page.contains("href=\"#run\"") && !page.contains("<figure>"),
        "{page}"
    );
    let told = answer.diagnostics.iter().flat_map(|found| &found.notes);
    assert!(told.into_iter().any(|note| note.contains("the page is written without")), "{:#?}", answer.diagnostics);
}

/// The numbers of the closed loop are those of the terminal.
#[test]
fn a_page_has_the_table_of_the_run() {
    let model = format!(
        "model: m\n{PLANT}f_x: {{p: v}}\nf_y: {{q: p}}\nsimulation: {{duration: 1, step: 0.01, initial: {{p: 1, q: 0}}, \
         control: {{v: 0}}}}\n"
    );
    let page = page(&model);
    let table = page.split("Errors of the estimates").nth(1).expect("a table");
    assert!(table.contains("settled to 1 %") && table.contains("<li>excitation: "), "{table}");
    assert!(!page.contains("e0<"), "numbers as of programs");
}

/// The observer's integral and the role of the unknown depend on the cascade.
#[test]
fn the_idea_is_that_of_the_cascade() {
    let [plain, general] =
        ["v", "v - p"].map(|rate| page(&format!("model: m\n{PLANT}f_x: {{p: {rate}}}\nf_y: {{q: p}}\nphi: [p]\n")));
    let idea = |page: &str| page.split("<section id=\"plant\">").next().expect("a part").to_owned();
    assert!(idea(&plain).contains("<mi>χ</mi>") && !idea(&plain).contains("<mi>Ψ</mi>"));
    assert!(idea(&general).contains("<mi>Ψ</mi>") && !idea(&general).contains("<mi>χ</mi>"));
}

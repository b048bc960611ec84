//! Small plants for every verdict on every claim.

mod conditions;
mod fundamental;
mod refusals;
mod relations;
mod shapes;
mod table;

use pebo_gen::report::summary;
use pebo_gen::source::Source;
use pebo_gen::{Derived, derive};

fn derived(lines: &str) -> Derived {
    let text = format!("model: m\n{lines}\n");
    derive(&Source::new("m", text.as_str()).expect("a text")).unwrap_or_else(|d| panic!("{lines}: {}", d[0].message))
}

#[test]
fn the_headline_speaks_of_the_claims_alone() {
    let said = |lines: &str| {
        let derived = derived(lines);
        summary(&derived.plant, &derived.derivation)
    };
    let undecided =
        said("x: [x]\ny: [y]\nu: [u]\nf_x: {x: y + sin(y) - u*y}\nf_y: {y: x + exp(y)}\nphi: [x]\nassume: [y > 0]");
    assert!(undecided.starts_with("m: accepted: all four claims are proved\n"), "{undecided}");
    // An open remark is no open claim: it stands under no verdict.
    assert!(undecided.contains("\n  operating point           "), "{undecided}");
    let conditional = said("x: [x]\ny: [y]\nu: [u]\nf_x: {x: u}\nf_y: {y: x/u}\nphi: [x]");
    let headline = "m: accepted: all four claims are proved where the conditions below hold\n";
    assert!(conditional.starts_with(headline), "{conditional}");
    assert!(conditional.contains("\n  conditions                u != 0\n"), "{conditional}");
}

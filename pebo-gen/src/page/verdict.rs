//! The verdicts on the model and on each claim.

use crate::report::notes;
use pebo_design::analysis::{Outcome, Verdict};
use pebo_design::source::{Colour, render};

use super::html::Html;
#[cfg(feature = "simulate")]
use super::subject::Run;
use super::subject::Subject;

/// The title, the verdict, and the contents.
pub(super) fn header(html: &mut Html, subject: &Subject<'_>) {
    let (plant, derivation) = (subject.plant, subject.derivation);
    html.line("h1", &[], |html| html.text(subject.title()));
    html.line("p", &[("class", "model")], |html| {
        html.text("Model ");
        html.within("code", &[], |html| html.text(&plant.name));
        if let Some(reference) = &plant.reference {
            html.text(&format!(". Source: {reference}"));
        }
    });
    let class = match derivation.outcome {
        Outcome::Accepted => Verdict::Proved,
        Outcome::Rejected => Verdict::Refuted,
        Outcome::Undecided => Verdict::Undecided,
    };
    let outcome = derivation.outcome.word();
    html.line("p", &[("class", "verdict"), ("data-verdict", class.word())], |html| {
        html.within("strong", &[], |html| html.text(outcome));
        html.text(&format!(": {}", notes::meaning(derivation)));
    });
    html.block("nav", &[("aria-label", "Contents")], |html| {
        html.block("ul", &[], |html| {
            for (id, name) in contents(subject) {
                html.line("li", &[], |html| html.within("a", &[("href", &format!("#{id}"))], |html| html.text(name)));
            }
        });
    });
}

/// The sections that the page has, in their order.
fn contents(subject: &Subject<'_>) -> Vec<(&'static str, &'static str)> {
    let mut contents = Vec::new();
    if !subject.diagnostics.is_empty() {
        contents.push(("diagnostics", "Diagnostics"));
    }
    contents.extend([
        ("idea", "The idea"),
        ("plant", "Plant"),
        ("transform", "Transform"),
        ("cascade", "1 Cascade"),
        ("left-inverse", "2 Left inverse"),
        ("regression", "3 Regression"),
        ("identifiability", "4 Identifiability"),
        ("conditions", "Conditions"),
        ("use", "In use"),
    ]);
    #[cfg(feature = "simulate")]
    if !matches!(subject.run, Run::Not) {
        contents.push(("run", "Closed loop"));
    }
    if subject.emitted.is_some() {
        contents.push(("code", "Code"));
    }
    contents
}

/// The diagnostics, as the command line prints them.
pub(super) fn diagnostics(html: &mut Html, subject: &Subject<'_>) {
    if subject.diagnostics.is_empty() {
        return;
    }
    html.section("diagnostics", "Diagnostics", |html| {
        if subject.emitted.is_none() {
            html.paragraph("No code is written for this model. The lines marked `help` say what would mend it.");
        }
        html.code(&render(subject.diagnostics, subject.source, Colour::Never));
    });
}

/// The verdict on a claim, behind its heading.
pub(super) fn of_claim(html: &mut Html, verdict: Verdict) {
    let meaning = match verdict {
        Verdict::Proved | Verdict::Refuted => "",
        Verdict::Undecided => ": neither proved nor refuted; the diagnostics say what stands in the way",
        Verdict::Skipped => ": not looked at, because a claim that it builds on is not proved",
    };
    html.line("p", &[("class", "verdict"), ("data-verdict", verdict.word())], |html| {
        html.within("strong", &[], |html| html.text(verdict.word()));
        html.text(meaning);
    });
}

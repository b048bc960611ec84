//! The conditions of the proofs, and remarks for use.

use crate::report::remarks;
use pebo_design::analysis::{Outcome, Verdict};

use super::formula::{Setter, Steps};
use super::html::Html;
use super::plant::listed;
use super::subject::Subject;

pub(super) fn sections(html: &mut Html, setter: &Setter<'_>, subject: &Subject<'_>) {
    let (plant, derivation) = (subject.plant, subject.derivation);
    html.section("conditions", "Conditions", |html| {
        let conditions: Vec<String> =
            derivation.conditions.iter().map(|(expr, relation)| setter.compared(*expr, *relation)).collect();
        match (derivation.outcome, conditions.is_empty()) {
            (Outcome::Accepted, true) => {
                html.paragraph(if derivation.conditions_on_estimates(plant).is_empty() {
                    "None: what the formulas ask to have values follows from the assumptions."
                } else {
                    "None on the plant: what the formulas ask to have values follows from the assumptions. What estimates \
                     have to satisfy stands with claim 2."
                });
            }
            (_, true) => html.paragraph("No claim is proved under conditions."),
            (_, false) => {
                listed(html, "The proofs need these to hold, and the assumptions do not grant them:", &conditions);
            }
        }
    });
    html.section("use", "In use", |html| {
        let remarks = remarks::of(plant, derivation);
        if remarks.is_empty() {
            html.paragraph(match derivation.cascade.verdict {
                Verdict::Proved => "There is nothing to remark.",
                _ => "There is nothing to remark: the remarks rest on a proved cascade.",
            });
        }
        for remark in remarks {
            html.line("h3", &[], |html| html.text(&capitalised(remark.name)));
            if !remark.values.is_empty() {
                let mut steps = Steps::default();
                for (symbol, value) in &remark.values {
                    steps.add(&setter.symbol(*symbol), &setter.expr(*value), "");
                }
                html.display(&steps.finish());
            }
            html.list(&remark.lines);
        }
    });
}

/// With a capital first letter.
fn capitalised(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

//! The closed loop: its figure, and the errors of the estimates as numbers.

use super::html::Html;
use super::subject::{Loop, Run, Subject};

pub(super) fn section(html: &mut Html, subject: &Subject<'_>) {
    match &subject.run {
        Run::Not => {}
        Run::Failed => html.section("run", "Closed loop", |html| {
            html.paragraph(
                "There is no figure: the closed loop of the model's section `simulation` did not come to its end. The \
                 diagnostic under the verdict says why.",
            );
        }),
        Run::Done(run) => html.section("run", "Closed loop", |html| done(html, run)),
    }
}

fn done(html: &mut Html, run: &Loop<'_>) {
    html.paragraph(
        "The plant, the control law and the observer of the model's section `simulation`, run together. An error is the \
         estimate less the truth.",
    );
    html.block("figure", &[], |html| {
        html.block("div", &[("class", "wide")], |html| html.markup(run.figure));
        html.line("figcaption", &[], |html| {
            html.text(&format!("The closed loop over {} s, sample by sample.", run.end));
        });
    });
    if let Some((headings, rows)) = run.errors.split_first() {
        let headings: Vec<&str> = headings.iter().map(String::as_str).collect();
        html.table("Errors of the estimates", &headings, rows);
    }
    html.list(&run.lines);
}

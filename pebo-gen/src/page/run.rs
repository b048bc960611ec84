//! The closed loop: its figure, and the errors of the estimates as numbers.

use super::html::Html;
use super::subject::Subject;

pub(super) fn section(html: &mut Html, subject: &Subject<'_>) {
    let Some(run) = &subject.run else { return };
    html.section("run", "Closed loop", |html| {
        html.paragraph(
            "The plant, the control law and the observer of the model's section `simulation`, run together. An error is \
             the estimate less the truth.",
        );
        html.block("figure", &[], |html| {
            html.block("div", &[("class", "wide"), ("tabindex", "0")], |html| html.markup(run.figure));
            html.line("figcaption", &[], |html| {
                html.text(&format!("The closed loop over {} s, sample by sample.", run.end));
            });
        });
        html.block("div", &[("class", "wide")], |html| {
            html.block("table", &[], |html| {
                html.line("caption", &[], |html| html.text("Errors of the estimates"));
                html.block("thead", &[], |html| {
                    html.line("tr", &[], |html| {
                        for name in ["state", "at the start", &format!("at {} s", run.end)] {
                            html.within("th", &[("scope", "col")], |html| html.text(name));
                        }
                    });
                });
                html.block("tbody", &[], |html| {
                    for error in &run.errors {
                        html.line("tr", &[], |html| {
                            html.within("th", &[("scope", "row")], |html| html.text(error.state));
                            for value in [error.start, error.end] {
                                html.within("td", &[], |html| html.text(&format!("{value:.3e}")));
                            }
                        });
                    }
                });
            });
        });
    });
}

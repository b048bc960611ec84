//! The code: what a step costs, how many digits it keeps, and the module itself.

use crate::emit::{Accuracy, Emitted};

use super::html::Html;
use super::subject::Subject;

pub(super) fn section(html: &mut Html, subject: &Subject<'_>) {
    let Some(emitted) = subject.emitted else { return };
    html.section("code", "Code", |html| {
        html.paragraph(
            "The functions of the observer in Rust, for `f64`. What was written was read back and proved equal to the \
             formulas above.",
        );
        cost(html, emitted);
        accuracy(html, &emitted.accuracy);
        html.folded("The module", |html| html.code(&emitted.text));
    });
}

fn cost(html: &mut Html, emitted: &Emitted) {
    let rows: Vec<Vec<String>> =
        emitted.costs.iter().map(|(function, cost)| vec![function.clone(), cost.to_string()]).collect();
    table(html, "Operations of each function", &["function", "operations"], &rows);
}

fn accuracy(html: &mut Html, accuracy: &Accuracy) {
    if accuracy.places == 0 {
        html.paragraph("The accuracy was not measured: no point of the domain was found.");
        return;
    }
    let rows: Vec<Vec<String>> = accuracy
        .losses
        .iter()
        .map(|loss| vec![format!("`{}`", loss.function), loss.single.told(), loss.double.told()])
        .collect();
    let caption = format!(
        "Largest error at {} places of the domain, in units of what rounding of the arguments alone causes, up to the next \
         power of two",
        accuracy.places
    );
    table(html, &caption, &["function", "`f32`", "`f64`"], &rows);
}

/// A table whose first column names its rows.
fn table(html: &mut Html, caption: &str, columns: &[&str], rows: &[Vec<String>]) {
    html.block("div", &[("class", "wide")], |html| {
        html.block("table", &[], |html| {
            html.line("caption", &[], |html| html.prose(caption));
            html.block("thead", &[], |html| {
                html.line("tr", &[], |html| {
                    for name in columns {
                        html.within("th", &[("scope", "col")], |html| html.prose(name));
                    }
                });
            });
            html.block("tbody", &[], |html| {
                for row in rows {
                    html.line("tr", &[], |html| {
                        for (index, cell) in row.iter().enumerate() {
                            match index {
                                0 => html.within("th", &[("scope", "row")], |html| html.prose(cell)),
                                _ => html.within("td", &[], |html| html.prose(cell)),
                            }
                        }
                    });
                }
            });
        });
    });
}

//! The code: the cost of a step, the digits that it keeps, and the module itself.

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
    html.table("Operations of each function", &["function", "operations"], &rows);
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
        "How many times the rounding of their arguments the results are off: the worst of {} places of the domain, rounded \
         up to a power of two",
        accuracy.places
    );
    html.table(&caption, &["function", "`f32`", "`f64`"], &rows);
}

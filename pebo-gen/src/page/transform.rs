//! The transform and its origin.

use pebo_design::plant::TransformOrigin;

use crate::report::notes;

use super::formula::{Setter, Steps};
use super::html::Html;
use super::subject::Subject;

pub(super) fn section(html: &mut Html, setter: &Setter<'_>, subject: &Subject<'_>) {
    let plant = subject.plant;
    html.section("transform", "Transform", |html| {
        if plant.phi.is_empty() {
            html.paragraph("The model has none, and none was found. The diagnostics say how far the search went.");
            return;
        }
        html.paragraph(match plant.origin {
            TransformOrigin::Given => "The author of the model gives it.",
            TransformOrigin::Lifted { .. } => "The author of the model gives its first components.",
            TransformOrigin::Class => "It follows from the class of the plant.",
            TransformOrigin::Found => "The model has none: it was found by a search, and then proved as any other.",
        });
        let mut steps = Steps::default();
        for (z, phi) in plant.z.iter().zip(&plant.phi) {
            steps.add(&setter.symbol(*z), &setter.expr(phi.expr), "");
        }
        html.display(&steps.finish());
        html.list(&notes::transform(plant));
    });
}

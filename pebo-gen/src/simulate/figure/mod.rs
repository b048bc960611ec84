//! The figure of a run: panels one above the other over a common time axis, as SVG.
//!
//! In: the points of the curves. Out: one self-contained drawing for print and screen: text stays
//! text, curves differ in colour and in dashes, legends stand beside the plots and cover nothing. A
//! line has no more points than can be seen, however long the run was.

mod axis;
mod line;
mod page;
mod plot;
mod svg;

use super::label::Label;
use super::scenario::Scenario;
use super::trace::Trace;
use axis::Axis;
use page::{BOTTOM, HEADING, LEFT, MARGIN, PLOT_WIDTH, TEXT, TITLE, TOP};
use plot::Plot;
use svg::{Anchor, Drawing, width};

/// Draws the panels of a scenario with the curves of its run.
pub fn draw(trace: &Trace, scenario: &Scenario) -> String {
    let duration = scenario.timing.at(scenario.timing.samples);
    let (unit, factor) = time_unit(duration);
    let time = Axis::whole(0.0, duration * factor);

    let labels = scenario.panels.iter().flat_map(|panel| &panel.curves);
    let legend = labels.map(|label| width(label, TEXT)).fold(0.0, f64::max) + plot::SAMPLE + 2.0 * MARGIN;
    let heading = title(scenario);
    let page = (LEFT + PLOT_WIDTH + legend).max(2.0 * MARGIN + width(&heading, TITLE));

    let mut drawing = Drawing::new();
    let middle = LEFT + PLOT_WIDTH / 2.0;
    // The title stands over the middle of the plots, unless it then left the page.
    let half = width(&heading, TITLE) / 2.0 + MARGIN;
    drawing.label((middle.min(page - half).max(half), TOP - 6.0), Anchor::Middle, TITLE, &heading);
    let mut top = TOP;
    for (panel, curves) in scenario.panels.iter().zip(&trace.curves) {
        let plot = Plot { panel, curves, time: &time, factor, left: LEFT, top: top + HEADING };
        top = plot.draw(&mut drawing);
    }
    plot::time_axis(&mut drawing, &time, top, &Label::name("t").then(Label::text(&format!(" in {unit}"))));
    drawing.finish((page, top + BOTTOM), &scenario.title)
}

fn title(scenario: &Scenario) -> Label {
    let title = Label::text(&scenario.title);
    match &scenario.feedback {
        Some(feedback) => title.remark(&format!("feedback: {feedback}")),
        None => title,
    }
}

/// The unit in which this many seconds are read easily, and how many of it a second has.
fn time_unit(duration: f64) -> (&'static str, f64) {
    match duration {
        d if d < 2e-4 => ("µs", 1e6),
        d if d < 0.2 => ("ms", 1e3),
        _ => ("s", 1.0),
    }
}

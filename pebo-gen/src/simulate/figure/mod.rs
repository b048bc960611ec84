//! The figure of a run: panels one above the other over a common time axis, as SVG.
//!
//! In: the points of the curves. Out: one self-contained drawing for print and screen: text stays
//! text, curves differ in colour and in dashes, legends stand beside the plots and cover nothing. A
//! line has no more points than can be seen, however long the run was.

mod axis;
mod line;
mod plot;
mod svg;

use super::label::Label;
use super::scenario::Scenario;
use super::trace::Trace;
use axis::Axis;
use plot::Plot;
use svg::{Anchor, Drawing, width};

/// Width of the plots; the legends make the figure about a third wider. All lengths are in points of
/// a figure that is printed at the width of a page.
const PLOT_WIDTH: f64 = 420.0;
const PLOT_HEIGHT: f64 = 106.0;
const LEFT: f64 = 56.0;
/// Above the first plot: the title.
const TOP: f64 = 24.0;
/// Above each plot: its heading.
const HEADING: f64 = 24.0;
/// Below the last plot: the time axis.
const BOTTOM: f64 = 38.0;
const MARGIN: f64 = 10.0;

/// Size of the title's letters.
const TITLE: f64 = 13.0;
/// Size of all other letters.
const TEXT: f64 = 12.0;

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

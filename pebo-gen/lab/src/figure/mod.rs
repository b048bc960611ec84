//! The figure of a run: panels one above the other over a common time axis, as SVG.
//!
//! In: the points of the curves. Out: one self-contained drawing for print and screen: text stays
//! text, curves differ in colour and in dashes, legends stand beside the plots and cover nothing. A
//! line has no more points than can be seen, however long the run was.

pub(crate) mod curve;
pub(crate) mod label;
pub(crate) mod panel;
pub(crate) mod unit;

mod axis;
mod line;
mod page;
mod plot;
mod svg;

use axis::Axis;
use curve::DrawnCurve;
use label::Label;
use page::{BOTTOM, HEADING, LEFT, MARGIN, PLOT_WIDTH, TEXT, TITLE, TOP};
use panel::Panel;
use plot::Plot;
use svg::{Anchor, Drawing, width};

/// The share of the time at the start in which a curve that settles may leave a linear axis.
const SETTLING: f64 = 0.05;

/// Panels with their curves over a common time.
pub(super) struct Sheet<'a> {
    /// The title as plain text, and as it is drawn.
    pub(super) title: (&'a str, Label),
    /// The range of time in seconds, and its label.
    pub(super) time: ([f64; 2], Label),
    pub(super) panels: &'a [Panel],
    /// Each panel's curves.
    pub(super) curves: &'a [Vec<DrawnCurve>],
}

impl Sheet<'_> {
    /// The drawing as SVG.
    pub(super) fn draw(&self) -> String {
        let ([from, to], name) = &self.time;
        // One row alone has no duration.
        let to = &if to > from { *to } else { from + 1.0 };
        let (unit, factor) = time_unit(to - from);
        let time = Axis::whole(from * factor, to * factor);

        let settled = from + SETTLING * (to - from);
        let plots = self.panels.iter().zip(self.curves).map(|(panel, curves)| Plot::of(panel, curves, settled));
        let plots: Vec<Plot> = plots.collect();
        let labels = self.panels.iter().flat_map(|panel| &panel.curves).map(|curve| &curve.label);
        let legend = labels.map(|label| width(label, TEXT)).fold(0.0, f64::max) + plot::SAMPLE + 2.0 * MARGIN;
        let left = plots.iter().map(Plot::labels_width).fold(LEFT, f64::max);
        let (title, heading) = &self.title;
        let headings = self.panels.iter().map(|panel| left + width(&plot::longest_heading(panel), TEXT) + MARGIN);
        let page = (left + PLOT_WIDTH + legend).max(2.0 * MARGIN + width(heading, TITLE));
        let page = headings.fold(page, f64::max);

        let mut drawing = Drawing::new();
        let middle = left + PLOT_WIDTH / 2.0;
        // The title stands over the middle of the plots, unless it then left the page.
        let half = width(heading, TITLE) / 2.0 + MARGIN;
        drawing.label((middle.min(page - half).max(half), TOP - 6.0), Anchor::Middle, TITLE, heading);
        let mut top = TOP;
        for plot in &plots {
            top = plot.draw(&mut drawing, (&time, factor), (left, top + HEADING));
        }
        plot::time_axis(&mut drawing, &time, (left, top), name, unit);
        drawing.finish((page, top + BOTTOM), title)
    }
}

/// The unit in which this duration in seconds is read easily, and the number of units in a second.
fn time_unit(duration: f64) -> (&'static str, f64) {
    match duration {
        d if d < 2e-4 => ("µs", 1e6),
        d if d < 0.2 => ("ms", 1e3),
        _ => ("s", 1.0),
    }
}

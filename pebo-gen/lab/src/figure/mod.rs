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
use label::Label;
pub(crate) use page::Band;
use page::{BOTTOM, HEADING, LEFT, MARGIN, PLOT_WIDTH, TEXT, TITLE, TOP};
use panel::Panel;
use plot::Plot;
use svg::{Anchor, Drawing, width};

/// Panels with their curves over a common time.
pub(super) struct Sheet<'a> {
    /// The title as plain text, and as it is drawn.
    pub(super) title: (&'a str, Label),
    /// The range of time in seconds, and its label.
    pub(super) time: ([f64; 2], Label),
    pub(super) panels: &'a [Panel],
    /// The points of each panel's curves.
    pub(super) curves: &'a [Vec<Vec<(f64, f64)>>],
}

impl Sheet<'_> {
    /// The drawing as SVG.
    pub(super) fn draw(&self) -> String {
        self.draw_with(&[])
    }

    /// The drawing with the bands of some panels' curves, panel by panel.
    pub(super) fn draw_with(&self, bands: &[Vec<Band>]) -> String {
        let ([from, to], name) = &self.time;
        let (unit, factor) = time_unit(to - from);
        let time = Axis::whole(from * factor, to * factor);

        let labels = self.panels.iter().flat_map(|panel| &panel.curves);
        let legend = labels.map(|label| width(label, TEXT)).fold(0.0, f64::max) + plot::SAMPLE + 2.0 * MARGIN;
        let (title, heading) = &self.title;
        let headings = self.panels.iter().map(|panel| LEFT + width(&plot::longest_heading(panel), TEXT) + MARGIN);
        let page = (LEFT + PLOT_WIDTH + legend).max(2.0 * MARGIN + width(heading, TITLE));
        let page = headings.fold(page, f64::max);

        let mut drawing = Drawing::new();
        let middle = LEFT + PLOT_WIDTH / 2.0;
        // The title stands over the middle of the plots, unless it then left the page.
        let half = width(heading, TITLE) / 2.0 + MARGIN;
        drawing.label((middle.min(page - half).max(half), TOP - 6.0), Anchor::Middle, TITLE, heading);
        let mut top = TOP;
        for (number, (panel, curves)) in self.panels.iter().zip(self.curves).enumerate() {
            let bands = bands.get(number).map_or(&[][..], Vec::as_slice);
            let plot = Plot { panel, curves, bands, time: &time, factor, left: LEFT, top: top + HEADING };
            top = plot.draw(&mut drawing);
        }
        plot::time_axis(&mut drawing, &time, top, name, unit);
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

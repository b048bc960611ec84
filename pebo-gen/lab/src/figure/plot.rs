//! One panel: frame, grid, curves, marks, legend.

use super::axis::Axis;
use super::label::Label;
use super::line::thinned;
use super::page::{Band, LEFT, MARGIN, PLOT_HEIGHT, PLOT_WIDTH, TEXT};
use super::panel::Panel;
use super::svg::{Anchor, Drawing};
use pebo_design::model::Scale;

/// Colours that people with any kind of colour vision tell apart (Okabe and Ito 2008), each with dashes
/// that tell it apart in grey.
const STYLES: &[(&str, &str)] = &[
    ("#0072b2", ""),
    ("#d55e00", "6 3"),
    ("#009e73", "1.5 2.5"),
    ("#cc79a7", "8 2.5 1.5 2.5"),
    ("#000000", "3 1.5"),
    ("#c48800", "10 3"),
];

/// Length of a legend's line, with the space behind it.
pub(super) const SAMPLE: f64 = 28.0;

/// From line to line of a legend.
const SPACING: f64 = 17.0;

/// A panel at its position.
#[derive(Debug)]
pub(super) struct Plot<'a> {
    pub(super) panel: &'a Panel,
    pub(super) curves: &'a [Vec<(f64, f64)>],
    /// About each of the curves, if there are any.
    pub(super) bands: &'a [Band],
    pub(super) time: &'a Axis,
    /// Units of the time axis in a second.
    pub(super) factor: f64,
    pub(super) left: f64,
    /// The upper edge of the frame; the heading is above.
    pub(super) top: f64,
}

impl Plot<'_> {
    /// Draws the panel; returns its lower edge.
    pub(super) fn draw(&self, drawing: &mut Drawing) -> f64 {
        let rows = self.panel.curves.iter().fold(0.0, |rows, _| rows + 1.0);
        let height = PLOT_HEIGHT.max(SPACING * rows);
        let ends = || self.bands.iter().flatten().flat_map(|(_, ends)| *ends);
        let values = || self.curves.iter().flatten().map(|point| point.1).chain(ends());
        let axis = match self.panel.scale {
            Scale::Linear => Axis::linear(values()),
            Scale::Log => Axis::logarithmic(values()),
        };
        let bottom = self.top + height;
        drawing.label((self.left, self.top - 7.0), Anchor::Start, TEXT, &heading(self.panel, axis.exponent));
        for mark in &axis.marks {
            let y = bottom - mark.place * height;
            drawing.grid_line((self.left, y), (self.left + PLOT_WIDTH, y));
            drawing.label((self.left - 6.0, y + 4.0), Anchor::End, TEXT, &mark.label);
        }
        for mark in &self.time.marks {
            let x = self.left + mark.place * PLOT_WIDTH;
            drawing.grid_line((x, self.top), (x, bottom));
        }
        for (number, band) in self.bands.iter().enumerate() {
            // Values beyond the axis end at its edge.
            let place = |t: f64, value: f64| {
                let x = self.left + self.time.place(t * self.factor) * PLOT_WIDTH;
                (x, bottom - axis.place(value).clamp(0.0, 1.0) * height)
            };
            let known = || band.iter().filter(|(_, ends)| !ends.iter().any(|end| end.is_nan()));
            let lower: Vec<_> = known().map(|(t, [lower, _])| place(*t, *lower)).collect();
            let upper: Vec<_> = known().map(|(t, [_, upper])| place(*t, *upper)).collect();
            let edge: Vec<_> = thinned(&lower).into_iter().chain(thinned(&upper).into_iter().rev()).collect();
            drawing.area(&edge, style(number).0);
        }
        for (number, curve) in self.curves.iter().enumerate() {
            let place = |(t, value): &(f64, f64)| {
                let x = self.left + self.time.place(t * self.factor) * PLOT_WIDTH;
                (x, bottom - axis.place(*value) * height)
            };
            // Values that are not finite, or too small for a logarithmic axis, are gaps in the line.
            let parts = curve.split(|point| !point.1.is_finite() || axis.place(point.1) < 0.0);
            let parts: Vec<_> = parts.map(|part| thinned(&part.iter().map(place).collect::<Vec<_>>())).collect();
            drawing.line(&parts, style(number));
        }
        drawing.frame((self.left, self.top), (PLOT_WIDTH, height));
        self.legend(drawing);
        bottom
    }

    fn legend(&self, drawing: &mut Drawing) {
        let x = self.left + PLOT_WIDTH + MARGIN;
        let mut y = self.top + 9.0;
        for (number, label) in self.panel.curves.iter().enumerate() {
            drawing.line(&[vec![(x, y), (x + SAMPLE - 6.0, y)]], style(number));
            drawing.label((x + SAMPLE, y + 4.0), Anchor::Start, TEXT, label);
            y += SPACING;
        }
    }
}

/// The title of a panel with unit and power of ten.
fn heading(panel: &Panel, exponent: i32) -> Label {
    measured(Label::text(&panel.title), exponent, panel.unit.as_deref())
}

/// A quantity in a power of ten of a unit.
fn measured(what: Label, exponent: i32, unit: Option<&str>) -> Label {
    match (exponent, unit) {
        (0, None) => what,
        (0, Some(unit)) => what.in_unit(unit),
        (exponent, None) => what.then(Label::text(" in ")).then(Label::power_of_ten(exponent)),
        (exponent, Some(unit)) => measured(what, exponent, None).then(Label::text(" ")).then(Label::unit(unit)),
    }
}

/// The same with the longest power of ten.
pub(super) fn longest_heading(panel: &Panel) -> Label {
    heading(panel, -300)
}

/// The marks and the name of the time axis under the last panel, whose lower edge is `y`.
pub(super) fn time_axis(drawing: &mut Drawing, time: &Axis, y: f64, name: &Label, unit: &str) {
    for mark in &time.marks {
        drawing.label((LEFT + mark.place * PLOT_WIDTH, y + 15.0), Anchor::Middle, TEXT, &mark.label);
    }
    let name = measured(name.clone(), time.exponent, Some(unit));
    drawing.label((LEFT + PLOT_WIDTH / 2.0, y + 31.0), Anchor::Middle, TEXT, &name);
}

fn style(number: usize) -> (&'static str, &'static str) {
    STYLES[number % STYLES.len()]
}

#[cfg(test)]
mod tests {
    use super::STYLES;

    /// The relative luminance of a colour (WCAG 2.2).
    fn luminance(colour: &str) -> f64 {
        let part = |at: usize| {
            let value = f64::from(u8::from_str_radix(&colour[at..at + 2], 16).expect("two digits")) / 255.0;
            if value <= 0.040_45 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) }
        };
        0.2126 * part(1) + 0.7152 * part(3) + 0.0722 * part(5)
    }

    #[test]
    fn lines_stand_out_from_the_sheet() {
        for (colour, _) in STYLES {
            let contrast = 1.05 / (luminance(colour) + 0.05);
            // WCAG 2.2, 1.4.11: the contrast of graphics.
            assert!(contrast >= 3.0, "{colour}: {contrast}");
        }
    }
}

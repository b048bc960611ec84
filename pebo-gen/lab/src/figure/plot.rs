//! One panel: frame, grid, curves, marks, legend.

use super::axis::Axis;
use super::curve::DrawnCurve;
use super::label::Label;
use super::line::{thinned, within};
use super::page::{MARGIN, PLOT_HEIGHT, PLOT_WIDTH, TEXT};
use super::panel::{Panel, PanelCurve};
use super::svg::{Anchor, Drawing, width};
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

/// Between the marks and the frame.
const MARK_SPACE: f64 = 6.0;

/// From line to line of a legend.
const SPACING: f64 = 17.0;

/// A panel with its curves.
#[derive(Debug)]
pub(super) struct Plot<'a> {
    panel: &'a Panel,
    curves: &'a [DrawnCurve],
    axis: Axis,
}

impl<'a> Plot<'a> {
    /// The panel with these curves; before `settled`, in seconds, one that settles may leave a linear axis.
    pub(super) fn of(panel: &'a Panel, curves: &'a [DrawnCurve], settled: f64) -> Self {
        Self { panel, curves, axis: axis(panel, curves, settled) }
    }

    /// The width that the marks beside the frame need.
    pub(super) fn labels_width(&self) -> f64 {
        let widest = self.axis.marks.iter().map(|mark| width(&mark.label, TEXT)).fold(0.0, f64::max);
        widest + MARK_SPACE + MARGIN
    }

    /// Draws the panel over a time axis, with so many of its units in a second; `top` is the upper edge of the frame,
    /// with the heading above. Returns the lower edge.
    pub(super) fn draw(&self, drawing: &mut Drawing, (time, factor): (&Axis, f64), (left, top): (f64, f64)) -> f64 {
        let axis = &self.axis;
        let rows = self.panel.curves.iter().fold(0.0, |rows, _| rows + 1.0);
        let height = PLOT_HEIGHT.max(SPACING * rows);
        let bottom = top + height;
        drawing.label((left, top - 7.0), Anchor::Start, TEXT, &heading(self.panel, axis.exponent));
        for mark in &axis.marks {
            let y = bottom - mark.place * height;
            drawing.grid_line((left, y), (left + PLOT_WIDTH, y));
            drawing.label((left - MARK_SPACE, y + 4.0), Anchor::End, TEXT, &mark.label);
        }
        for mark in &time.marks {
            let x = left + mark.place * PLOT_WIDTH;
            drawing.grid_line((x, top), (x, bottom));
        }
        let place = |(t, value): &(f64, f64)| {
            let x = left + time.place(t * factor) * PLOT_WIDTH;
            (x, bottom - axis.place(*value) * height)
        };
        for (number, curve) in self.curves.iter().enumerate() {
            let Some(edges) = &curve.band else { continue };
            let edge = |points: &Vec<(f64, f64)>| {
                let known = points.iter().filter(|point| !point.1.is_nan());
                // Values beyond the axis end at its edge.
                let placed = known.map(place).map(|(x, y)| (x, y.clamp(top, bottom)));
                thinned(&placed.collect::<Vec<_>>())
            };
            let [lower, upper] = edges.each_ref().map(edge);
            drawing.area(&lower.into_iter().chain(upper.into_iter().rev()).collect::<Vec<_>>(), style(number).0);
        }
        for (number, curve) in self.curves.iter().enumerate() {
            // Values that are not finite, or too small for a logarithmic axis, are gaps in the line.
            let is_gap = |value: f64| !value.is_finite() || (self.panel.scale == Scale::Log && axis.place(value) < 0.0);
            let parts = curve.line.split(|point| is_gap(point.1));
            let parts = parts.flat_map(|part| within(&part.iter().map(place).collect::<Vec<_>>(), [top, bottom]));
            let parts: Vec<_> = parts.map(|part| thinned(&part)).collect();
            drawing.line(&parts, style(number));
        }
        drawing.frame((left, top), (PLOT_WIDTH, height));
        self.legend(drawing, (left, top));
        bottom
    }

    fn legend(&self, drawing: &mut Drawing, (left, top): (f64, f64)) {
        let x = left + PLOT_WIDTH + MARGIN;
        let mut y = top + 9.0;
        for (number, PanelCurve { label, .. }) in self.panel.curves.iter().enumerate() {
            drawing.line(&[vec![(x, y), (x + SAMPLE - 6.0, y)]], style(number));
            drawing.label((x + SAMPLE, y + 4.0), Anchor::Start, TEXT, label);
            y += SPACING;
        }
    }
}

/// The axis of values. A linear one leaves out where a curve comes from, and how wide the band was there.
fn axis(panel: &Panel, curves: &[DrawnCurve], settled: f64) -> Axis {
    let lines = || curves.iter().map(|curve| &curve.line);
    if panel.scale == Scale::Log {
        let edges = curves.iter().filter_map(|curve| curve.band.as_ref()).flatten();
        return Axis::logarithmic(lines().chain(edges).flatten().map(|point| point.1));
    }
    let shown = lines().zip(&panel.curves).flat_map(|(line, curve)| {
        let first = if curve.settles { line.partition_point(|point| point.0 < settled) } else { 0 };
        &line[first..]
    });
    Axis::linear(shown.map(|point| point.1))
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

/// The marks and the name of the time axis under the last panel, whose lower left corner this is.
pub(super) fn time_axis(drawing: &mut Drawing, time: &Axis, (left, y): (f64, f64), name: &Label, unit: &str) {
    for mark in &time.marks {
        drawing.label((left + mark.place * PLOT_WIDTH, y + 15.0), Anchor::Middle, TEXT, &mark.label);
    }
    let name = measured(name.clone(), time.exponent, Some(unit));
    drawing.label((left + PLOT_WIDTH / 2.0, y + 31.0), Anchor::Middle, TEXT, &name);
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

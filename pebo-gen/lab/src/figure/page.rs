//! The lengths of the page, in points of a figure that is printed at the width of a page.

/// Width of the plots; the legends make the figure about a third wider.
pub(super) const PLOT_WIDTH: f64 = 420.0;
pub(super) const PLOT_HEIGHT: f64 = 106.0;
pub(super) const LEFT: f64 = 56.0;
/// Above the first plot: the title.
pub(super) const TOP: f64 = 24.0;
/// Above each plot: its heading.
pub(super) const HEADING: f64 = 24.0;
/// Below the last plot: the time axis.
pub(super) const BOTTOM: f64 = 38.0;
pub(super) const MARGIN: f64 = 10.0;

/// Size of the title's letters.
pub(super) const TITLE: f64 = 13.0;
/// Size of all other letters.
pub(super) const TEXT: f64 = 12.0;

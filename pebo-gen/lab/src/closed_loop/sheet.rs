//! Draws the figure of a run: the panels of its scenario with the curves of its trace.

use super::scenario::Scenario;
use super::trace::Trace;
use crate::figure::Sheet;
use crate::figure::label::Label;

/// Draws the panels of a scenario with the curves of its run.
pub fn draw(trace: &Trace, scenario: &Scenario) -> String {
    let duration = scenario.timing.at(scenario.timing.samples);
    let title = (scenario.experiment.title.as_str(), title(scenario));
    Sheet {
        title,
        time: ([0.0, duration], Label::name("t")),
        panels: &scenario.experiment.panels,
        curves: &trace.curves,
    }
    .draw()
}

fn title(scenario: &Scenario) -> Label {
    let title = Label::text(&scenario.experiment.title);
    match &scenario.feedback {
        Some(feedback) => title.remark(&format!("feedback: {feedback}")),
        None => title,
    }
}

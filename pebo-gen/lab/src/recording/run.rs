//! Runs the observer over a log, piece by piece.
//!
//! Out: estimates row by row, and in the end the errors of the longest piece, the faults of rows, and the figure of all
//! pieces one after the other. The record of the run does not grow with it. At each piece the observer begins anew.

use std::io::Write;
use std::ops::ControlFlow;

use crate::experiment::columns::write_row;
use crate::experiment::curves::Curves;
use crate::experiment::follow::ExperimentState;
use crate::figure::Sheet;
use crate::figure::curve::GrowingCurve;
use crate::figure::label::Label;
use crate::summary::{Summary, contradiction, standing_out};
use crate::timing::real;

use super::failure::Failure;
use super::log::Log;
use super::piece::Piece;
use super::replayed::{OutputResidual, Replayed};
use super::scene::Replay;
use super::stream::RowStream;

/// The result of a piece.
struct PieceResult {
    rows: u64,
    /// The first instant.
    start: f64,
    summary: Summary,
    residuals: Vec<OutputResidual>,
}

impl Replay {
    /// Runs the observer over all rows; estimates go to `estimates` as CSV, row by row. `watch` gets the numbers of
    /// rows and bytes now and then, and may end the run there.
    pub fn run(
        &self,
        log: &mut Log,
        mut estimates: Option<&mut dyn Write>,
        watch: &mut dyn FnMut(u64, u64) -> ControlFlow<()>,
    ) -> Result<Replayed, Failure> {
        let (experiment, mut text) = (&self.experiment, self.experiment.columns.names.join(",") + "\n");
        let is_listed = estimates.is_some();
        let mut write = |text: &str| match &mut estimates {
            Some(file) => file.write_all(text.as_bytes()).map_err(Failure::Unwritten),
            None => Ok(()),
        };
        write(&text)?;
        let mut stream = RowStream::new(self, log, watch);
        let mut curves = Curves::<GrowingCurve>::new(experiment);
        // The place of the present piece in the figure, in seconds, and the longest piece so far; of equals the first.
        let (mut offset, mut longest) = (0.0, None::<PieceResult>);
        let (end, refused) = loop {
            let mut piece = Piece::new(self, &mut stream, is_listed);
            let mut state = ExperimentState::start(experiment).map_err(Failure::Refused)?;
            state.driver = state.driver.judging_first();
            let state = state.follow(&mut piece, |piece, table| {
                let place = offset + piece.duration();
                curves.add(table, |curve, value| curve.add((place, value)));
                if is_listed {
                    text.clear();
                    write_row(&mut text, experiment.columns.row(table));
                    write(&text)?;
                }
                Ok(())
            })?;
            let contradiction = contradiction(&state.driver, true).or_else(|| standing_out(&state.driver));
            let rows = longest.as_ref().map_or(0, |longest| longest.rows);
            if state.estimated > 0 && piece.rows > rows {
                let (summary, residuals) = (state.summary(contradiction), piece.residuals());
                longest = Some(PieceResult { rows: piece.rows, start: piece.start(), summary, residuals });
            }
            if !piece.goes_on {
                let refused = state.driver.faults.iter().map(|(reason, _)| reason.to_owned());
                break (offset + piece.duration(), refused.collect());
            }
            offset += piece.room();
            curves.add_to_all(|curve| curve.add((offset, f64::NAN)));
        };
        let (faults, rows) =
            (stream.faults.worded([&self.names.columns, &experiment.design.names.inputs]), stream.rows);
        let Some(PieceResult { rows: scored, start, summary, residuals }) = longest else {
            return Err(Failure::Silent { rows, faults, refused });
        };
        let from_zero = offset == 0.0 && start == 0.0;
        let sheet = Sheet {
            title: (&experiment.title, Label::text(&experiment.title).remark("replay")),
            time: ([0.0, end], if from_zero { Label::name("t") } else { Label::text("t since the first row") }),
            panels: &experiment.panels,
            curves: &curves.finish(GrowingCurve::finish),
        };
        Ok(Replayed {
            rows,
            scored,
            start,
            inputs_at_once: experiment.design.with_instant,
            summary,
            residuals,
            left_out: self.names.left_out.clone(),
            faults,
            figure: sheet.draw(),
        })
    }

    /// The logarithm of the likelihood of all samples, but for a constant, and the number of innovations behind it; none
    /// where the observer does not say.
    pub(super) fn likelihood(&self, log: &mut Log) -> Option<(f64, f64)> {
        let mut watch = |_, _| ControlFlow::Continue(());
        let mut stream = RowStream::new(self, log, &mut watch);
        let (mut likelihood, mut judged) = (0.0, 0.0);
        loop {
            let mut piece = Piece::new(self, &mut stream, false);
            let mut state = ExperimentState::start(&self.experiment).ok()?;
            state.driver = state.driver.judging_each();
            let driver = state.follow(&mut piece, |_, _| Ok(())).ok()?.driver;
            let found = driver.likelihood();
            if !piece.goes_on {
                return Some((likelihood + found?, judged + real(driver.judged())));
            }
            if let Some(found) = found {
                (likelihood, judged) = (likelihood + found, judged + real(driver.judged()));
            }
        }
    }
}

//! Refuses settings that a regression at the estimate does not admit.

use pebo_design::analysis::Derivation;
use pebo_design::model::Model;
use pebo_design::source::{Code, Diagnostic};

/// The refusal of a setting, where the regression has its slopes at the extension: that has to be the estimate at each
/// sample, and rows of the past are of estimates that have been left.
pub(super) fn refused(model: &Model, derivation: &Derivation) -> Option<Diagnostic> {
    let regression = derivation.regression.result.as_ref()?;
    if !regression.is_at_estimate() {
        return None;
    }
    let observer = &model.observer;
    let (span, key, note) = match (observer.rebase.span(), observer.delay.written().next()) {
        (Some(span), _) if !observer.rebase.is_at_each_sample() => (
            span,
            "rebase",
            "its slopes are those at the estimate, from which the extension starts again at each sample",
        ),
        (_, Some(delay)) => {
            (delay.span, "delay", "a late sample would be explained with the slopes of an estimate that has been left")
        }
        _ => return None,
    };
    let message = format!("`{key}` does not go with a regression at the estimate");
    Some(Diagnostic::error(Code::SettingConflict, span, message).note(note).help(format!("remove `{key}`")))
}

//! Conflicts among the keys of the section `observer`.

use super::{Estimator, Observer, Rebase};
use crate::model::formula::Decimal;
use crate::model::spanned::{Entry, Spanned};
use crate::source::{Code, Diagnostic, Diagnostics, Span, listed};

impl Rebase {
    /// Reports several of them at once.
    fn check(&self, diagnostics: &mut Diagnostics) {
        let mut written = self.written();
        let (Some((first, span)), Some((second, other))) = (written.next(), written.next()) else { return };
        let message = format!("`rebase` has both `{first}` and `{second}`");
        diagnostics.push(
            Diagnostic::error(Code::SettingConflict, other, message)
                .also(span, format!("`{first}` is here"))
                .help("keep one of them: each of the forms alone keeps the extension from running away"),
        );
    }
}

impl Observer {
    /// Reports settings that the estimator does not have, and gains beside the numbers that they would be derived from.
    pub(in crate::model) fn check_estimator(&self, diagnostics: &mut Diagnostics) {
        // A misspelt estimator is absent, and its settings are unknown.
        let known = self.estimator.is_some() || !diagnostics.has_errors();
        self.contradictions(diagnostics);
        let estimator = self.estimator();
        for (key, span) in self.settings().filter(|_| known && self.known().is_none()) {
            if !estimator.has(key) {
                diagnostics.push(self.stranger(key, span));
            }
        }
    }

    /// Reports conflicts of the other keys.
    pub(in crate::model) fn check(&self, diagnostics: &mut Diagnostics) {
        if let Some(gate) = self.gate.as_ref().filter(|_| self.has_gains()) {
            let message = "`gate` stands beside gains, which do not say how far a sample may be from what is expected";
            diagnostics.push(
                Diagnostic::error(Code::SettingConflict, gate.span, message)
                    .help("write `sensors`, `start` and `disturbance` in place of gains, or remove `gate`"),
            );
        }
        if let Some(wanted) = self.wanted.first().filter(|_| self.has_gains()) {
            let message = "`wanted` stands beside gains, which do not say how far an estimate errs";
            diagnostics.push(
                Diagnostic::error(Code::SettingConflict, wanted.name.span, message).help(
                    "write `sensors`, `start` and `disturbance` in place of gains, or remove `wanted`: for gains the runtime \
                     has a `Monitor`",
                ),
            );
        }
        if let Some(delay) = self.delay.span().filter(|_| self.has_gains()) {
            let message = "`delay` stands beside gains, whose observer takes every sample for one of the moment";
            diagnostics.push(
                Diagnostic::error(Code::SettingConflict, delay, message)
                    .help("write `sensors`, `start` and `disturbance` in place of gains, or remove `delay` and give the observer the inputs as late as the outputs"),
            );
        }
        self.rebase.check(diagnostics);
        self.limits.iter().for_each(|entry| limits(entry, diagnostics));
        if let (Some(filter), Some(window)) = (&self.filter, &self.window) {
            let message = "the observer has both a filter and a window";
            diagnostics.push(
                Diagnostic::error(Code::SettingConflict, window.span, message)
                    .also(filter.span, "the filter")
                    .help("remove one of them: the regression goes through a filter or a window"),
            );
        }
    }

    /// Reports gains beside the numbers that they would be derived from.
    fn contradictions(&self, diagnostics: &mut Diagnostics) {
        let Some((key, known)) = self.known() else {
            self.idle_bounds(diagnostics);
            return;
        };
        let instead = [("covariance", &self.start, "start"), ("process_noise", &self.disturbance, "disturbance")];
        for (gain, entries, name) in instead {
            if let (Some(span), Some(first)) = (self.span_of(gain), entries.first()) {
                let message = format!("`{gain}` stands beside the `{name}` that it would be derived from");
                diagnostics.push(
                    Diagnostic::error(Code::SettingConflict, span, message)
                        .also(first.name.span, format!("`{name}` begins here"))
                        .help(format!("remove one of them: `{name}` is in units of the states, `{gain}` of phi")),
                );
            }
        }
        let others = self.settings().filter(|(key, _)| instead.iter().all(|(gain, ..)| gain != key));
        let mut strangers: Vec<(&str, Span)> = others.collect();
        strangers.extend(["filter", "window"].into_iter().filter_map(|key| Some((key, self.span_of(key)?))));
        strangers.extend(
            [("bounds", &self.bounds.lower), ("bounds", &self.bounds.upper)]
                .iter()
                .filter_map(|(key, numbers)| Some((*key, numbers.first()?.span))),
        );
        let other = self.estimator.as_ref().filter(|estimator| estimator.value != Estimator::LeastSquares);
        strangers.extend(other.map(|estimator| ("estimator", estimator.span)));
        for (stranger, span) in strangers {
            let message = format!("`{stranger}` stands beside `{key}`, from which the observer is derived");
            let help = match stranger {
                "bounds" => "bound the states instead, by `within`".to_owned(),
                "estimator" => format!("write `least-squares`, or gains in place of `{key}`"),
                _ => format!("remove `{stranger}`: the observer is least squares, whose numbers are derived"),
            };
            diagnostics.push(
                Diagnostic::error(Code::SettingConflict, span, message)
                    .also(known, format!("`{key}` is here"))
                    .help(help),
            );
        }
    }

    /// Reports bounds of the unknowns of an estimator that the section does not choose.
    fn idle_bounds(&self, diagnostics: &mut Diagnostics) {
        // An estimator that was misspelt is absent.
        let bounds = self.bounds.lower.first().or(self.bounds.upper.first());
        if let Some(bound) = bounds.filter(|_| !self.has_gains() && !diagnostics.has_errors()) {
            let message = "`bounds` are those of an estimator's unknowns, and this section chooses no estimator";
            diagnostics.push(
                Diagnostic::error(Code::SettingConflict, bound.span, message)
                    .help("bound the states instead, by `within`, or choose an `estimator` with its settings"),
            );
        }
    }

    /// A setting that the estimator does not have.
    fn stranger(&self, key: &str, span: Span) -> Diagnostic {
        let estimator = self.estimator();
        let message = format!("the estimator `{}` has no `{key}`", estimator.name());
        let others = Estimator::ALL.into_iter().filter(|other| other.has(key)).map(Estimator::name);
        let own = estimator.needs().iter().chain(estimator.admits()).copied();
        let diagnostic = Diagnostic::error(Code::SettingConflict, span, message)
            .note(format!("`{key}` is a setting of {}", listed(others)));
        match &self.estimator {
            Some(estimator) => diagnostic.also(estimator.span, "the estimator is chosen here").help(format!(
                "remove `{key}`, or choose another estimator: the settings of this one are {}",
                listed(own)
            )),
            None => diagnostic
                .help("add `estimator:` with one that has this setting; without that key the estimator is `gradient`"),
        }
    }
}

/// Reports limits of a signal that are no two numbers in order.
fn limits(entry: &Entry<Vec<Spanned<Decimal>>>, diagnostics: &mut Diagnostics) {
    let name = &entry.name.value;
    match entry.value.as_slice() {
        [least, most] if least.value.to_f64() <= most.value.to_f64() => {}
        [least, most] => diagnostics.push(
            Diagnostic::error(
                Code::NumberOutOfRange,
                least.span,
                format!("no sample of `{name}` is within its limits"),
            )
            .also(most.span, "this upper limit is below the lower one")
            .help("exchange them"),
        ),
        values => {
            let message = format!("{} numbers are given as the limits of `{name}`", values.len());
            let help = format!("write the least and the greatest, as `{name}: [0, 1]`");
            diagnostics.push(Diagnostic::error(Code::WrongShape, entry.name.span, message).help(help));
        }
    }
}

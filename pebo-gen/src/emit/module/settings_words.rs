//! The settings of an observer in words, for the documentation of its type.

use super::Module;
use super::parameters::decimal;
use pebo_cas::Rational;
use pebo_design::plant::settings::{Covariance, Estimator, Extension, FiniteTime, Operator, Rebase, Settings};

impl Module<'_> {
    /// The settings in words, as a sentence.
    pub(super) fn words(&self, settings: &Settings<Rational>) -> String {
        let arena = &self.plant.arena;
        let one = |value: &Rational| decimal(arena, value);
        let list = |values: &[Rational]| {
            let values: Vec<String> = values.iter().map(one).collect();
            if let [only] = values.as_slice() { only.clone() } else { format!("({})", values.join(", ")) }
        };
        let forgetting = |rate: &Rational| {
            if rate.is_zero() { String::new() } else { format!(" that forget at {}/s", one(rate)) }
        };
        let squares = |Covariance { start, forgetting: rate, process_noise }: &Covariance<Rational>| {
            let noise =
                process_noise.as_ref().map_or(String::new(), |noise| format!(" with process noise {}", list(noise)));
            format!("least squares of covariance {}{}{noise}", list(start), forgetting(rate))
        };
        let mut parts = vec![match &settings.estimator {
            Estimator::Gradient(gain) => format!("gradient of gain {}", list(gain)),
            Estimator::NormalisedGradient { gain, mu } => {
                format!("normalised gradient of gain {} and normalisation {}", list(gain), one(mu))
            }
            Estimator::LeastSquares(covariance) => squares(covariance),
            Estimator::AdaptiveLeastSquares(covariance, guess) => {
                let more = if covariance.process_noise.is_some() { "and" } else { "with process noise" };
                format!("{} {more} {} times a factor that the innovations correct", squares(covariance), list(guess))
            }
            Estimator::Drem { gain, extension } => {
                let (kind, extension) = match extension {
                    Extension::Kreisselmeier { gain, forgetting: rate, finite_time } => {
                        let kind = finite_time.as_ref().map_or(String::new(), |FiniteTime { clip, period }| {
                            let period =
                                period.as_ref().map_or(String::new(), |period| format!(" and {} s", one(period)));
                            format!(" exact after a finite time with clip {}{period},", one(clip))
                        });
                        let rate =
                            if rate.is_zero() { String::new() } else { format!(" with forgetting {}/s", one(rate)) };
                        (kind, format!("Kreisselmeier's extension of gain {}{rate}", list(gain)))
                    }
                    Extension::Gradient(gain) => {
                        (String::new(), format!("the response of a gradient of gain {}", list(gain)))
                    }
                    Extension::LeastSquares(covariance) => {
                        (String::new(), format!("the response of {}", squares(covariance)))
                    }
                };
                format!("DREM{kind} of gain {} on {extension}", list(gain))
            }
        }];
        parts.extend(settings.lower.as_ref().map(|lower| format!("not below {}", list(lower))));
        parts.extend(settings.upper.as_ref().map(|upper| format!("not above {}", list(upper))));
        let [least, greatest] = &settings.within;
        parts.extend(least.as_ref().map(|least| format!("states not below {}", list(least))));
        parts.extend(greatest.as_ref().map(|greatest| format!("states not above {}", list(greatest))));
        parts.push(match &settings.operator {
            Operator::Filter(alpha) => format!("filter of {} rad/s", one(alpha)),
            Operator::Window(samples) => format!("window of {} samples", one(samples)),
            Operator::Sampled(deviations) => format!("samples of standard deviation {}", list(deviations)),
        });
        parts.extend(settings.late.as_ref().map(|late| {
            let late = self.plant.y.iter().zip(&late.delays).filter(|(_, delay)| !delay.is_zero());
            let name = |output: pebo_cas::Symbol| self.plant.arena.name(output);
            let each: Vec<String> =
                late.map(|(y, delay)| format!("`{}` by {} s", name(y.symbol), one(delay))).collect();
            format!("late {}", each.join(", "))
        }));
        parts.extend(settings.errors_in_variables.as_ref().map(|sensors| {
            format!("each linearised at its likely outputs, with sensors of standard deviation {}", list(sensors))
        }));
        parts.extend(settings.feedthrough.as_ref().map(|outputs| {
            let name = |output: &usize| format!("`{}`", self.plant.arena.name(self.plant.y[*output].symbol));
            let each: Vec<String> = outputs.iter().flatten().map(name).collect();
            format!("after a jump of an input {} as it is expected", each.join(", "))
        }));
        parts.extend(settings.output.then(|| "output form".to_owned()));
        if !matches!(settings.operator, Operator::Sampled(_)) {
            parts.push(format!("{}-order hold", if settings.straight { "first" } else { "zero" }));
        }
        parts.extend(settings.rebase.as_ref().map(|rebase| match rebase {
            Rebase::Samples(samples) if *samples == Rational::ONE => "re-based at every sample".to_owned(),
            Rebase::Samples(samples) => format!("re-based every {} samples", one(samples)),
            Rebase::Above(bound) => format!("re-based when the extension exceeds {}", one(bound)),
            Rebase::Leak(rate) => format!("re-based by a leak of {}/s", one(rate)),
        }));
        if settings.chi_0.iter().any(|value| !value.is_zero()) {
            parts.push(format!("extension from {}", list(&settings.chi_0)));
        }
        format!("Settings: {}.", parts.join("; "))
    }
}

//! Advice on a run: reason and mend.
//!
//! In: the summary of a run, and the differences of its plant and sensors from the model, or that they were recorded.
//! Out: a diagnostic if the samples contradict the observer's numbers, and one if an estimate of the model's observer has
//! not settled, or if a recording without measured states does not determine the unknown. The reasons are tried in this
//! order: refused samples, data that do not determine the unknown, then what innovation and expected error say of the
//! error; of an observer of gains, which has neither, whether it still falls.

use pebo_design::source::{Code, Diagnostic, Span, listed};

use super::{CREDIBLE, EstimateScore, Summary, short};
use crate::observe::excitation::Excitation;
use crate::observe::setup::Estimator;
use crate::score::{SETTLED, Score};
use crate::settings::KnownNumbers;
use crate::timing::real;

/// The share of refused samples that by itself explains an estimate that does not settle.
const REFUSED: f64 = 0.1;

/// An error below this share of its value a quarter of the run before still falls. A quarter of a run has many samples
/// of a sensor's noise, so their root mean square varies by well below a tenth.
const FALLING: f64 = 0.9;

/// The source of a run's samples.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Origin<'a> {
    /// A simulation, with the differences of its plant and sensors from the model, and the first state that is given a
    /// course, if no parameter is.
    Simulated(&'a [&'static str], Option<&'a str>),
    Recorded,
}

/// The advice on a run; `where_said` is the section that describes it.
pub(crate) fn advise(
    summary: &Summary,
    (estimator, origin): (&Estimator, Origin<'_>),
    where_said: Span,
) -> Vec<Diagnostic> {
    let contradicted = summary.contradiction.map(|factor| {
        if summary.is_mostly_as_expected() {
            standing_out(factor, where_said)
        } else if is_local(summary) {
            contradicted(factor, origin, where_said).help(BEGIN_NEARER)
        } else {
            contradicted(factor, origin, where_said)
        }
    });
    let unsettled = not_converged(summary, (estimator, origin), where_said);
    contradicted.into_iter().chain(unsettled).collect()
}

/// True if the observer converges from a neighbourhood alone.
fn is_local(summary: &Summary) -> bool {
    summary.known.as_ref().is_some_and(|known| known.is_local)
}

/// The help for a local regression, whose estimate may be at rest where the state is not.
const BEGIN_NEARER: &str = "begin nearer, by `extension` under `observer`, or give the unknowns a `disturbance`: a local \
                            regression converges from a neighbourhood, and is certain elsewhere too; if that is of no \
                            use, raise `sensors` to what samples scatter by";

/// The advice on a recording of which some samples contradict the observer's numbers, and on average by this factor.
fn standing_out(factor: f64, where_said: Span) -> Diagnostic {
    let message = format!(
        "some innovations stand out: on average they are {} times as large as the observer's numbers say",
        short(factor)
    );
    Diagnostic::warning(Code::NumbersContradicted, where_said, message)
        .note("the plant does more than its model says there, or samples are off by far: no `sensors` fit both")
        .help(GATE)
}

/// The advice on samples that are off by far.
const GATE: &str = "`gate: 25` under `observer` refuses samples that are off by far, `limits` those that a sensor cannot show; \
                    where the plant itself steps, raise `disturbance` of what does";

/// The advice on samples that contradict the observer's numbers by this factor.
fn contradicted(factor: f64, origin: Origin<'_>, where_said: Span) -> Diagnostic {
    let message = format!("innovations are {} times as large as the observer's numbers say", short(factor));
    let diagnostic = Diagnostic::warning(Code::NumbersContradicted, where_said, message);
    if factor < 1.0 {
        return diagnostic
            .help("lower `sensors` to what samples scatter by, and `disturbance` to what the model leaves out");
    }
    let others = match origin {
        Origin::Simulated(departures, _) => {
            departures.iter().copied().filter(|departure| *departure != "noise").collect()
        }
        Origin::Recorded => Vec::new(),
    };
    match (others.is_empty(), origin) {
        // The plant is that of the model.
        (true, Origin::Simulated(..)) => diagnostic.help("raise `sensors` to what samples scatter by"),
        (true, Origin::Recorded) => diagnostic.help(
            "let `replay --fit` find numbers with which they agree; or raise `disturbance` by as much where the plant does \
             more than its model says, `sensors` where samples scatter more than that; or write `limits` where a logger has \
             -9999 for a missing sample",
        ),
        (false, _) => diagnostic
            .note(format!("the simulation has {}", listed(others.iter().copied())))
            .help("raise `disturbance` by as much, where the plant does more than its model says"),
    }
}

/// The advice on a run that did not converge.
fn not_converged(
    summary: &Summary,
    (estimator, origin): (&Estimator, Origin<'_>),
    where_said: Span,
) -> Option<Diagnostic> {
    let unsettled = summary.unsettled();
    let Some(slowest) = unsettled.iter().max_by(|a, b| a.score.trend.total_cmp(&b.score.trend)) else {
        let is_blind = matches!(origin, Origin::Recorded) && summary.estimates.is_empty();
        let message = "the recording does not determine all estimates";
        return unexcited(Diagnostic::warning(Code::NotConverged, where_said, message), summary).filter(|_| is_blind);
    };
    let names = listed(unsettled.iter().map(|scored| scored.estimate.state.as_str()));
    let message = match unsettled.len() {
        1 => format!("the estimate of {names} has not settled to 1 % within {} s", short(summary.end)),
        _ => format!("the estimates of {names} have not settled to 1 % within {} s", short(summary.end)),
    };
    let diagnostic = Diagnostic::warning(Code::NotConverged, where_said, message);
    let raised = match estimator {
        _ if summary.known.is_some() => "`start` or `disturbance` under `observer`",
        Estimator::LeastSquares(_) | Estimator::AdaptiveLeastSquares(..) => "`covariance`",
        Estimator::Gradient(_) | Estimator::NormalisedGradient { .. } | Estimator::Drem { .. } => "`gain`",
    };
    let faster = match origin {
        Origin::Simulated(..) => format!("raise {raised}, or simulate longer"),
        Origin::Recorded => format!("raise {raised}, or record longer"),
    };
    let (refused, trend) = (summary.faults.count(), slowest.score.trend);
    Some(if real(refused) > REFUSED * real(summary.samples + 1) {
        let reason =
            summary.faults.iter().max_by_key(|(_, count)| *count).map(|(reason, _)| reason).unwrap_or_default();
        diagnostic
            .note(format!("the observer refused {refused} of {} samples: {reason}", summary.samples + 1))
            .help("keep samples in the domain of the observer's formulas, or estimates within bounds, as `within: {lower: 0}`")
    } else if let Some(scored) = unsettled.iter().find(|scored| scored.outside) {
        let state = &scored.estimate.state;
        diagnostic
            .note(format!(
                "`{state}` itself is beyond the bounds of `within` in this run, and its estimate is kept within them"
            ))
            .help(format!("widen the bounds of `{state}` under `within`, or start the plant within them"))
    } else if let Some(diagnostic) = unexcited(diagnostic.clone(), summary) {
        diagnostic
    } else if let Some((scored, steps, step)) = unsettled.iter().find_map(|scored| steps_away(scored)) {
        let state = &scored.estimate.state;
        let count = if steps.abs() > 1.0 { format!("{} steps", steps.abs()) } else { "one step".to_owned() };
        diagnostic
            .note(format!("the estimate of `{state}` is {count} of {} off, which the outputs do not show", short(step)))
            .help(format!(
                "if `{state}` is an angle, declare its period under `angles`: such an error is then none; if not, measure \
                 another output"
            ))
    } else if summary.surprise.is_some() {
        of_numbers(summary, slowest, origin, diagnostic)
    } else if trend < FALLING {
        diagnostic
            .note(format!(
                "the error of `{}` still falls: it is {} % of what it was a quarter of the run before",
                slowest.estimate.state,
                short(100.0 * trend)
            ))
            .help(faster)
    } else {
        let note = at_rest(slowest);
        match origin {
            Origin::Recorded => diagnostic.note(note).help(BENCH),
            Origin::Simulated([], _) => {
                let help = format!("{faster}; if the signals change much within one `step`, choose a shorter one");
                diagnostic.note(note).help(help)
            }
            Origin::Simulated(departures @ [first, ..], state) => {
                let note = format!("{note}, with {} in the simulation", listed(departures.iter().copied()));
                let help = match state {
                    Some(state) if *first == "plant" => follow(state, (estimator, summary.known.is_some())),
                    _ => mend(first, summary.known.is_some()).to_owned(),
                };
                diagnostic.note(note).help(help)
            }
        }
    })
}

/// The help for an error on a recording.
const BENCH: &str = "compare parameters and offsets of sensors with those of the bench: what they err by stays in the \
                     estimate; the sensor that it is compared with counts too";

/// An error of at most so many standard errors is one that the observer expects: a run has one of these, as a rule, and in
/// three of a thousand it is larger by chance.
const WITHIN: f64 = 3.0;

/// The error that an estimate keeps.
fn at_rest(scored: &EstimateScore) -> String {
    let (state, rms) = (&scored.estimate.state, short(scored.score.rms));
    format!("the error of `{state}` hardly falls any more: its root mean square at the end is {rms}")
}

/// True if the observer takes its plant for undisturbed, or for as much disturbed as samples show: then a lower number
/// averages no more of them.
fn is_undisturbed(summary: &Summary) -> bool {
    let numbers = summary.known.iter().flat_map(|known| &known.numbers);
    let mut disturbances = numbers.filter(|numbers| numbers.what == KnownNumbers::DISTURBANCE);
    disturbances.all(|numbers| numbers.assumed || numbers.values.iter().all(|value| value.value == 0.0))
}

/// The advice on an observer that expects its samples and the errors of its estimates.
fn of_numbers(summary: &Summary, slowest: &EstimateScore, origin: Origin<'_>, diagnostic: Diagnostic) -> Diagnostic {
    let Score { rms, trend, .. } = slowest.score;
    let note = match trend {
        falling if falling < FALLING => {
            format!(
                "the error of `{}` still falls: its root mean square at the end is {}",
                slowest.estimate.state,
                short(rms)
            )
        }
        _ => at_rest(slowest),
    };
    let (departures, state) = match origin {
        Origin::Simulated(departures, state) => (departures, state),
        Origin::Recorded => (&[][..], None),
    };
    // Noise is what the numbers are of.
    let other = departures.iter().copied().find(|departure| *departure != "noise");
    let mended = match (other, state) {
        (Some("plant"), Some(state)) => format!(
            "raise `disturbance` of `{state}` under `observer`, so that the observer follows where `{state}` moves; what \
             moves all the time it follows with a lag"
        ),
        (Some(departure), _) => mend(departure, true).to_owned(),
        (None, _) if matches!(origin, Origin::Recorded) => BENCH.to_owned(),
        (None, _) => {
            "begin nearer, by `extension` under `observer`, or choose a shorter `step` if signals change much within \
                      one"
            .to_owned()
        }
    };
    let departed = match other {
        Some(_) => format!(", with {} in the simulation", listed(departures.iter().copied())),
        None => String::new(),
    };
    match (summary.contradiction, slowest.expected) {
        (Some(_), _) if other.is_none() && matches!(origin, Origin::Simulated(..)) => {
            let help = if is_local(summary) { BEGIN_NEARER } else { "mend the numbers of the observer first" };
            diagnostic.note(note).help(help)
        }
        (Some(_), _) => diagnostic.note(note + &departed).help(mended),
        (None, Some(expected)) if rms <= WITHIN * expected => {
            let help = if trend < FALLING || is_undisturbed(summary) {
                "simulate longer, or record more, as the observer averages what its sensors err by; or take a better sensor"
            } else {
                "choose a lower `disturbance` under `observer`, which averages more samples, or a better sensor"
            };
            diagnostic
                .note(format!("{note}, and the observer expects {} of its sensors and disturbances", short(expected)))
                .help(help)
        }
        (None, _) => {
            let (shown, help) = match summary.surprise.filter(|square| square > CREDIBLE.end()) {
                // What is typical of them does not contradict the numbers.
                Some(square) => (
                    format!(
                        "most innovations are as expected, but some so large that their normalised square is {} on average: \
                         the plant does more than its model says, or samples are off by far",
                        short(square)
                    ),
                    format!("`gate: 25` under `observer` refuses samples that are off by far; else {mended}"),
                ),
                None if is_local(summary) => (
                    "the innovations are as expected: where the estimate is, the outputs hardly show this error"
                        .to_owned(),
                    mended,
                ),
                None => ("the innovations are as expected: the outputs do not show this error".to_owned(), mended),
            };
            diagnostic.note(note + &departed).note(shown).help(help)
        }
    }
}

/// The number of steps by which an estimate is off its state, and their length, where the outputs determine the state
/// only up to multiples of these.
fn steps_away(scored: &EstimateScore) -> Option<(&EstimateScore, f64, f64)> {
    let (step, error) = (scored.step?.abs(), scored.score.last);
    let count = (error / step).round();
    // Within the tolerance of settling, and on average too, so that it is no moment on the way.
    let rests = |error: f64| (error.abs() - count.abs() * step).abs() <= SETTLED * step;
    (count != 0.0 && rests(error) && rests(scored.score.rms)).then_some((scored, count, step))
}

/// Adds the advice on data that do not determine the unknown.
fn unexcited(diagnostic: Diagnostic, summary: &Summary) -> Option<Diagnostic> {
    match &summary.excitation {
        Excitation::Converged { .. } => None,
        Excitation::NotYet { weakest } => Some(
            diagnostic
                .note(format!("excitation: the data never told `{weakest}` apart from the rest of the unknown"))
                .help(
                    "let inputs or set points move more, longer, or in another way, as with a second frequency: the \
                     verdict on identifiability says which motions it needs",
                ),
        ),
        Excitation::Lost { since, weakest } => {
            let since = short(*since);
            Some(
                diagnostic
                    .note(format!(
                        "excitation: from t = {since} s on nothing new was said of `{weakest}`, which was forgotten"
                    ))
                    .help("lower `forgetting`, or let inputs or set points go on moving"),
            )
        }
    }
}

/// The help for a state that varies where the model has it constant.
fn follow(state: &str, (estimator, known): (&Estimator, bool)) -> String {
    let setting = match estimator {
        _ if known => format!("raise `disturbance` of `{state}` under `observer`"),
        Estimator::LeastSquares(_) | Estimator::AdaptiveLeastSquares(..) => {
            format!("raise `process_noise` of `{state}`, or `forgetting`")
        }
        Estimator::Gradient(_) | Estimator::NormalisedGradient { .. } => "raise `gain`".to_owned(),
        Estimator::Drem { .. } => "raise `gain` and `forgetting`".to_owned(),
    };
    format!(
        "{setting}, so that the observer follows where `{state}` moves; what moves all the time it follows with a lag"
    )
}

/// The help for the first difference of a plant and its sensors from the model; observers of known numbers have no
/// filter and no gain to choose.
fn mend(departure: &str, known: bool) -> &'static str {
    match departure {
        "plant" => "measure the parameter that differs, or make it a state with rate 0, which is then estimated too",
        "bias" => "calibrate the sensor, or make its offset a state with rate 0, which is then estimated too",
        "delay" if known => {
            "write the delay under `observer` too: it then takes each sample for the time that it is of"
        }
        "delay" => "give the observer the inputs as late as the outputs, or choose a lower `filter` or `gain`",
        "jitter" => {
            "give the observer the time that has passed in place of the period, as `step` takes it in the emitted code"
        }
        "quantisation" if known => "choose a finer converter, or a lower `disturbance`, which averages more samples",
        "quantisation" => "choose a finer converter, or a lower `filter` or `gain`, which averages more samples",
        "every" => "let that output be sampled more often, or simulate longer",
        "dropped" => "choose a shorter `step`, so that less happens in a gap",
        _ if known => "choose a lower `disturbance`, which averages more samples, or a better sensor",
        _ => "choose a lower `filter` or `gain`, which averages more samples, or a better sensor",
    }
}

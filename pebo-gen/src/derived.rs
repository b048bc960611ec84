//! From a source to its proofs, and from there to code and to a closed loop.
//!
//! In: a source, or a model that was read. Out: a [`Derived`], whose claims all have a verdict; a missing transform is
//! searched for. Everything else is computed on demand.

use crate::emit::{self, EmitError, Emitted, Scalar};
use pebo_cas::domain::zero::is_zero;
use pebo_cas::{Arena, Budget, Rational};
use pebo_design::analysis::{Derivation, Outcome};
use pebo_design::model::Model;
use pebo_design::plant::{Class, Plant, Settings, TransformOrigin};
use pebo_design::search::{self, SearchVerdict};
#[cfg(feature = "yaml")]
use pebo_design::source::Source;
use pebo_design::source::{Code, Diagnostic, Diagnostics, Span};
use pebo_lab::settings::{DerivedSettings, Shown};

/// A model with its plant and its derivation.
#[derive(Debug)]
#[non_exhaustive]
pub struct Derived {
    /// The model as it was written.
    pub model: Model,
    /// The plant; with the transform that the search found, if the model has none.
    pub plant: Plant,
    /// The claims, each with its verdict.
    pub derivation: Derivation,
}

/// Derives the observer of a model file within the usual budget of steps; the errors are those of a file that could
/// not be read, or whose class could not be expanded.
///
/// ```
/// use pebo_gen::analysis::Outcome;
/// use pebo_gen::source::Source;
///
/// let text = "model: m\nx: [p]\ny: [q]\nu: [v]\nf_x: {p: v - sin(q)}\nf_y: {q: p}\nphi: [p]\n";
/// let derived = pebo_gen::derive(&Source::new("m.yaml", text).expect("a short text")).expect("a model");
/// assert_eq!(derived.derivation.outcome, Outcome::Accepted);
/// let cascade = derived.derivation.cascade.result.expect("it is proved");
/// assert_eq!(derived.plant.arena.print(cascade.h[0]), "v - sin(q)");
/// ```
#[cfg(feature = "yaml")]
pub fn derive(source: &Source) -> Result<Derived, Vec<Diagnostic>> {
    derive_within(source, Budget::default())
}

/// The same within a budget, which later questions about the model draw from too.
#[cfg(feature = "yaml")]
pub fn derive_within(source: &Source, budget: Budget) -> Result<Derived, Vec<Diagnostic>> {
    Derived::within(Model::parse(source)?, budget)
}

/// The search that follows a refusal may take this fraction of the remaining budget; `solve` takes all of it.
const SHARE_OF_ADVICE: u64 = 5;

impl Derived {
    /// Derives the observer of a model that was read, within the usual budget of steps.
    pub fn of(model: Model) -> Result<Self, Vec<Diagnostic>> {
        Self::within(model, Budget::default())
    }

    /// The same within a budget, which later questions about the model draw from too.
    pub fn within(model: Model, budget: Budget) -> Result<Self, Vec<Diagnostic>> {
        let plant = Plant::resolve_within(&model, budget)?;
        if !plant.phi.is_empty() {
            let derivation = Derivation::derive(&plant);
            return Ok(match search::lifted(&plant, &derivation) {
                Some(lifted) => Self { model, plant: lifted.plant, derivation: lifted.derivation },
                None => Self { model, plant, derivation },
            });
        }
        if let Some(derivation) = Derivation::of_contradiction(&plant) {
            return Ok(Self { model, plant, derivation });
        }
        let mut search = search::solve(&plant, plant.cascade_class);
        let best = match search.verdict {
            SearchVerdict::Found => (!search.candidates.is_empty()).then_some(0),
            // A transform that hides states is a proof that every other one does.
            SearchVerdict::None | SearchVerdict::Undecided => {
                search.candidates.iter().position(search::Candidate::hides_states)
            }
        };
        if let Some(best) = best {
            let mut best = search.candidates.swap_remove(best);
            if let Some(first) = best.derivation.diagnostics.first_mut() {
                *first = search.declare(&best.plant.arena, first.clone());
            }
            return Ok(Self { model, plant: best.plant, derivation: best.derivation });
        }
        let names = (model.x.first(), model.x.last());
        let states = match names {
            (Some(first), Some(last)) => first.span.to(last.span),
            _ => plant.x.first().map_or(Span::NOWHERE, |state| state.rate.span),
        };
        let refusal = search.refusal(&plant, states);
        let derivation = Derivation::without_transform(vec![refusal], search.is_unobservable);
        Ok(Self { model, plant, derivation })
    }

    /// The derivation holds for another version of the model too, which then may replace [`model`](Self::model): one
    /// that differs in the sections `observer`, `simulation` and `recording` alone, as with
    /// [`Source::set`](pebo_design::source::Source::set).
    pub fn holds_of(&self, other: &Model) -> bool {
        let Model { observer, simulation, recording, .. } = self.model.clone();
        Model { observer, simulation, recording, ..other.clone() } == self.model
    }

    /// The diagnostics of the claims; if a transform is refused or undecided, followed by the result of a search for
    /// another.
    pub fn advised(&self) -> Vec<Diagnostic> {
        let mut diagnostics = self.derivation.diagnostics.clone();
        let searched = match self.plant.origin {
            TransformOrigin::Given => true,
            // The class knows all transforms of linear plants and coils.
            TransformOrigin::Class => matches!(self.plant.class, Some(Class::Mechanical(_))),
            TransformOrigin::Found | TransformOrigin::Lifted { .. } => false,
        };
        let refused = searched && self.derivation.outcome != Outcome::Accepted;
        let mut open = diagnostics.iter_mut().filter(|d| refused && search::settles(d.code, &self.derivation));
        if let Some(first) = open.next() {
            let budget = self.plant.arena.budget();
            let search = budget.share(SHARE_OF_ADVICE, || search::solve(&self.plant, self.plant.cascade_class));
            *first = search.advise(&self.plant, first.clone());
            // A mend of the first mends the others.
            if search.verdict == SearchVerdict::Found {
                open.for_each(|other| other.help = None);
            }
        }
        diagnostics
    }

    /// Writes the observer as Rust, and proves that the written code computes the derived formulas.
    pub fn emit(&self, scalar: Scalar) -> Result<Emitted, EmitError> {
        let domain = self.plant.domain();
        let is_zero = |arena: &Arena, expr| is_zero(arena, expr, &domain);
        emit::emit(&self.plant, &self.derivation, self.settings().0.as_ref(), scalar, is_zero)
    }

    /// The settings of the section `observer`, if they are complete, and the diagnostics of the section; `simulate`
    /// reports missing ones.
    fn settings(&self) -> (Option<Settings<Rational>>, Vec<Diagnostic>) {
        let mut problems = Diagnostics::default();
        let tuned = DerivedSettings::of(&self.model, &self.plant, &self.derivation, &Shown::default(), &mut problems);
        let settings = tuned.map(|tuned| tuned.settings);
        (settings.filter(|_| !problems.has_errors()), problems.into_vec())
    }

    /// The same for a front end: if there is no code, diagnostics say why, be it a claim or the code itself.
    pub fn admitted(&self, scalar: Scalar) -> Result<Emitted, Vec<Diagnostic>> {
        if self.derivation.admit().is_err() {
            return Err(self.advised());
        }
        let (_, problems) = self.settings();
        if !problems.is_empty() {
            return Err(problems);
        }
        self.emit(scalar).map_err(|error| vec![self.refusal(&error, scalar)])
    }

    /// Warnings at the model's name about digits that the emitted code loses because the model's own formulas do.
    pub fn cautions(&self, emitted: &Emitted, scalar: Scalar) -> Vec<Diagnostic> {
        let losses = emitted.accuracy.cautions(scalar).into_iter().map(|(function, worst)| {
            let (scalar, place) = (scalar.name(), &worst.place);
            let how_much = if worst.is_finite() {
                format!("its error is {} times what rounding of its arguments causes", worst.told())
            } else {
                "it is not finite".to_owned()
            };
            let message = format!("`{function}` loses digits in `{scalar}`: at {place} {how_much}");
            Diagnostic::warning(Code::LosesDigits, self.model.name.span, message)
                .note("the model's own formulas lose as many there")
        });
        losses.collect()
    }

    /// The reason at the model's name that an accepted derivation is not emitted.
    fn refusal(&self, error: &EmitError, scalar: Scalar) -> Diagnostic {
        let span = self.model.name.span;
        let help = match error {
            EmitError::LimitReached => return Diagnostic::limit_reached("the check of the emitted code", span),
            EmitError::OutOfRange { .. } if scalar == Scalar::F32 => {
                "write for f64, or choose units in which the number is nearer to 1"
            }
            EmitError::OutOfRange { .. } => "choose units in which the number is nearer to 1",
            _ => "the model may be right: this is a defect of pebo-gen",
        };
        Diagnostic::error(Code::CannotEmit, span, format!("`{}` cannot be emitted: {error}", self.plant.name))
            .help(help)
    }

    /// The closed loop that the model file describes, ready to be run.
    #[cfg(feature = "simulate")]
    pub fn scenario(&self, overrides: &pebo_lab::Overrides) -> Result<pebo_lab::Scenario, Vec<Diagnostic>> {
        pebo_lab::Scenario::resolve(&self.model, &self.plant, &self.derivation, overrides)
    }

    /// The standard deviations of sensors and disturbances with which the observer makes these rows of a recording, with
    /// its header, most likely. `watch` gets the number of replays so far, and may end the search.
    #[cfg(feature = "simulate")]
    pub fn fitted(
        &self,
        recording: (&str, &[u8]),
        sought: &[String],
        watch: &mut dyn FnMut(u64) -> std::ops::ControlFlow<()>,
    ) -> Result<pebo_lab::recording::FittedNumbers, Vec<Diagnostic>> {
        self.derivation.admit().map_err(<[Diagnostic]>::to_vec)?;
        pebo_lab::recording::fit((&self.model, &self.plant, &self.derivation), recording, sought, watch)
    }

    /// The observer of the model, ready to be run over recorded data with these columns.
    #[cfg(feature = "simulate")]
    pub fn replay(
        &self,
        log: &mut pebo_lab::recording::Log<'_>,
    ) -> Result<pebo_lab::recording::Replay, Vec<Diagnostic>> {
        pebo_lab::recording::Replay::resolve(&self.model, &self.plant, &self.derivation, log)
    }
}

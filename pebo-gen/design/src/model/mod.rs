//! The model as written, with the span of every part.
//!
//! In: a [`Source`] or a module's tokens. Out: a [`Model`], or every independent mistake in it. After this layer the
//! file has the right shape, its formulas are parsed and bounded, every declared name is declared once, maps that
//! belong to declared names have entries for these and no others, and a definition uses only those before it. Names
//! *inside* formulas are not looked up here but in the plant layer ([`unknown_name`] words its diagnostic).
//!
//! The passes: `yaml` reads text, [`rust`] reads tokens, and [`check()`] checks the declarations of either.

mod check;
mod choice;
pub mod class;
mod definitions;
mod delay;
pub mod formula;
mod names;
mod observer;
mod recording;
pub mod rust;
mod section;
mod simulation;
mod spanned;
#[cfg(feature = "yaml")]
mod time;
mod written;
#[cfg(feature = "yaml")]
mod yaml;

#[cfg(all(test, feature = "yaml"))]
mod tests;

pub use check::check;
pub use class::{Class, Electromechanical, Lti, Matrix, Mechanical};
pub use delay::Delay;
pub use formula::{Comparison, Decimal, Formula, Operator, Relation, Term};
pub(crate) use names::derivative_of;
pub use names::unknown_name;
pub use observer::{Bounds, Estimator, Form, Hold, Observer, Rebase, Within};
pub use recording::Recording;
pub use simulation::{Baseline, Equations, Kalman, Luenberger, Panel, Piece, Scale, Simulation};
pub use spanned::{Entry, Spanned};
pub use written::{CascadeClass, Model, RegressionForm};

#[cfg(feature = "yaml")]
use crate::source::{Diagnostic, Diagnostics, Source};

/// The JSON schema of model files (draft 2020-12), for editors that complete and check them: keys and the shapes of
/// their values, from the table by which [`Model::parse`] reads. Only the reader checks the rest, as names and
/// formulas.
///
/// ```
/// let schema: serde_json::Value = serde_json::from_str(&pebo_design::model::json_schema()).expect("JSON");
/// assert!(schema["properties"]["f_x"]["description"].as_str().is_some_and(|about| about.contains("derivative")));
/// ```
#[cfg(feature = "yaml")]
#[must_use]
pub fn json_schema() -> String {
    yaml::json_schema()
}

#[cfg(feature = "yaml")]
impl Model {
    /// Reads a model file.
    pub fn parse(source: &Source) -> Result<Self, Vec<Diagnostic>> {
        let mut diagnostics = Diagnostics::new();
        let model = yaml::read(source, &mut diagnostics);
        if let Some(model) = &model {
            check(model, &mut diagnostics);
        }
        diagnostics.propagate()?;
        // Without a model there is an error, which was propagated.
        model.map(Self::ordered).map(Self::timed).map(Self::late).ok_or_else(Vec::new)
    }

    /// The model with sensors that are as late in a simulation as its observer knows them to be, unless the simulation
    /// says otherwise.
    fn late(mut self) -> Self {
        let known = &self.observer.delay;
        if let Some(simulation) = self.simulation.as_mut().filter(|simulation| simulation.delay.span().is_none()) {
            simulation.delay.clone_from(known);
        }
        self
    }
}

//! Plants by class: the matrices that the author wrote, expanded into the ordinary plant.
//!
//! ```text
//! lti | mechanical | electromechanical -> x' = f_x, y' = f_y, z = phi, and a proposal
//! ```
//!
//! Every equation keeps the span of the field that it is made of. The knowledge of the class (a left inverse, the terms
//! of the regression) is a [`Proposal`]: the analysis proves it as it proves anything else.

mod context;
mod electromechanical;
mod linear;
mod mechanical;
mod shape;

use crate::model::{self, Model};
use crate::source::Diagnostics;

use context::Stop;

pub use context::Proposal;
pub(super) use context::{ClassContext, Expansion, Names};
pub use electromechanical::Electromechanical;
pub use linear::Linear;
pub use mechanical::{InVelocities, Mechanical, change_along};

/// The class of a plant, with its matrices.
#[derive(Clone, Debug)]
pub enum Class {
    /// `lti`
    Linear(Linear),
    /// `mechanical`
    Mechanical(Mechanical),
    /// `electromechanical`
    Electromechanical(Electromechanical),
}

impl Class {
    /// The key of a linear plant in a model file.
    pub(crate) const LTI: &str = model::Class::LTI;

    /// The key of a mechanical plant.
    pub(crate) const MECHANICAL: &str = model::Class::MECHANICAL;

    /// The key of the class in a model file.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Linear(_) => model::Class::LTI,
            Self::Mechanical(_) => model::Class::MECHANICAL,
            Self::Electromechanical(_) => model::Class::ELECTROMECHANICAL,
        }
    }
}

/// The number of components of the transform.
pub(super) fn components(model: &Model) -> usize {
    match &model.class {
        None => model.phi.len(),
        Some(model::Class::Lti(lti)) => linear::components(lti, model),
        Some(model::Class::Mechanical(_)) => model.x.len(),
        Some(model::Class::Electromechanical(class)) => electromechanical::coils(class, model),
    }
}

impl ClassContext<'_> {
    /// The plant of a class; nothing if there was a mistake, which is among the problems then.
    pub(super) fn expand(
        &self,
        class: &model::Class,
        names: &Names<'_>,
        problems: &mut Diagnostics,
    ) -> Option<Expansion<Option<Class>>> {
        let expanded = match class {
            model::Class::Lti(written) => linear::expand(self, written, names, problems)
                .map(|found| found.of_any(|class| Some(Class::Linear(class)))),
            model::Class::Mechanical(written) => mechanical::expand(self, written, names, problems)
                .map(|found| found.of_any(|class| class.map(Class::Mechanical))),
            model::Class::Electromechanical(written) => electromechanical::expand(self, written, names, problems)
                .map(|found| found.of_any(|class| Some(Class::Electromechanical(class)))),
        };
        match expanded {
            Ok(expansion) => Some(expansion),
            Err(Stop::Reported) => None,
            Err(Stop::Mistake(diagnostic)) => {
                problems.push(*diagnostic);
                None
            }
        }
    }
}

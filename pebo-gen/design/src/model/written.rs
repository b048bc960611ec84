//! The types of a model as written.
//!
//! These are the sections of a model file, in its words. Lists keep the order of the file, except
//! where [`Model::ordered`] says otherwise.

use super::choice::choices;
use super::class::Class;
use super::definitions::sorted;
use super::formula::{Comparison, Decimal, Formula};
use super::observer::Observer;
use super::recording::Recording;
use super::simulation::Simulation;
use super::spanned::{Entry, Spanned};
use crate::source::Span;

/// A model.
///
/// A list that the file leaves out is empty.
#[derive(Clone, Debug, PartialEq)]
pub struct Model {
    /// Identifier: the emitted module's name.
    pub name: Spanned<String>,
    /// One line for people.
    pub title: Option<Spanned<String>>,
    /// The source of the model.
    pub reference: Option<Spanned<String>>,
    /// Parameters, with their values where these are given already.
    pub parameters: Vec<Entry<Option<Spanned<Decimal>>>>,
    /// Unmeasured states.
    pub x: Vec<Spanned<String>>,
    /// Measured outputs.
    pub y: Vec<Spanned<String>>,
    /// Inputs.
    pub u: Vec<Spanned<String>>,
    /// The first use of the time `t` in the formulas, if no declaration has that name: then it is the last input.
    pub time: Option<Span>,
    /// Unmeasured signals that are not estimated: no result may depend on them.
    pub w: Vec<Spanned<String>>,
    /// Named sub-expressions, each of which uses only earlier ones.
    pub define: Vec<Entry<Formula>>,
    /// The class of cascade that the author wants; either if absent.
    pub cascade_class: Option<Spanned<CascadeClass>>,
    /// The form of a regression made of a relation between the components of the transform.
    pub regression_form: Option<Spanned<RegressionForm>>,
    /// Inequalities that hold where the plant operates.
    pub assume: Vec<Comparison>,
    /// The class that the plant is written by, which fills the empty fields below.
    pub class: Option<Class>,
    /// Rates of x: one for each, in the order of `x`.
    pub f_x: Vec<Entry<Formula>>,
    /// Rates of y, in the order of `y`; unneeded ones may be absent.
    pub f_y: Vec<Entry<Formula>>,
    /// Values of outputs that are functions of the other signals, in the order of `y`.
    pub g_y: Vec<Entry<Formula>>,
    /// The transform, component by component.
    pub phi: Vec<Formula>,
    /// The left inverse, in the order of `x`: of all, of some (a partial observer) or of none (to
    /// be derived).
    pub phi_left: Vec<Entry<Formula>>,
    /// Expressions that are zero by physics.
    pub identities: Vec<Formula>,
    /// States that start at these values.
    pub known: Vec<Entry<Formula>>,
    /// States and outputs that are angles, with their periods.
    pub angles: Vec<Entry<Formula>>,
    /// Units of parameters and signals.
    pub units: Vec<Entry<Spanned<String>>>,
    /// The construction of the observer.
    pub observer: Observer,
    /// The simulation.
    pub simulation: Option<Simulation>,
    /// The meaning of recorded data.
    pub recording: Option<Recording>,
}

choices! {
    /// The class of a cascade.
    pub enum CascadeClass {
        /// z' = h: the extension is an integrator, z = chi + theta.
        Pebo = "pebo",
        /// z' = Lambda z + h: xi' = Lambda xi + h, Psi' = Lambda Psi, z = xi + Psi theta.
        Gpebo = "gpebo",
    }
}

choices! {
    /// The form of a regression that a model asks for.
    pub enum RegressionForm {
        /// A relation between the components of the transform as it holds at every instant, with functions of theta among
        /// the unknowns where it is not affine.
        Static = "static",
        /// Such a relation under the derivative, where constants vanish.
        Differentiated = "differentiated",
        /// Equations that are monotone in one unknown each, with their slopes at the estimate, where none are linear.
        Monotone = "monotone",
        /// All equations as they are, to first order at the estimate.
        Local = "local",
    }
}

impl Model {
    /// What the model's form of a regression is, of some forms, with its place.
    pub(crate) fn asks_for<T>(&self, of: impl FnOnce(RegressionForm) -> Option<T>) -> Option<(T, Span)> {
        let form = self.regression_form.as_ref()?;
        Some((of(form.value)?, form.span))
    }

    /// The place where it admits a regression to first order, if it does.
    pub(crate) fn admits_local(&self) -> Option<Span> {
        self.asks_for(|form| (form == RegressionForm::Local).then_some(())).map(|((), span)| span)
    }

    /// True if it admits a monotone regression: it asks for one, or leaves the transform open and names no form.
    pub(crate) fn admits_monotone(&self) -> bool {
        let form = self.regression_form.as_ref();
        form.map_or(self.phi.is_empty(), |form| form.value == RegressionForm::Monotone)
    }

    /// The model with the entries of `f_x`, `f_y`, `g_y` and `phi_left` in the order of their states, and definitions
    /// after the ones that they use.
    #[must_use]
    pub(super) fn ordered(mut self) -> Self {
        let order = |entries: &mut Vec<Entry<Formula>>, states: &[Spanned<String>]| {
            entries.sort_by_cached_key(|entry| states.iter().position(|state| state.value == entry.name.value));
        };
        order(&mut self.f_x, &self.x);
        order(&mut self.f_y, &self.y);
        order(&mut self.g_y, &self.y);
        order(&mut self.phi_left, &self.x);
        self.define = sorted(self.define);
        if let Some(simulation) = &mut self.simulation {
            simulation.define = sorted(std::mem::take(&mut simulation.define));
        }
        self
    }

    /// The names of the model: parameters, x, y, u, w and definitions, in this order.
    pub fn names(&self) -> impl Iterator<Item = &Spanned<String>> {
        self.declared().chain(self.define.iter().map(|entry| &entry.name))
    }

    /// The names of symbols: parameters, x, y, u and w, in this order.
    pub fn declared(&self) -> impl Iterator<Item = &Spanned<String>> {
        let parameters = self.parameters.iter().map(|entry| &entry.name);
        let signals = [&self.x, &self.y, &self.u, &self.w].into_iter().flatten();
        parameters.chain(signals)
    }
}

//! The meaning of a model: names resolved, numbers exact.
//!
//! In: its parts, as they were resolved. Out: the plant, which answers what follows from its parts alone.

use std::collections::{BTreeMap, BTreeSet};
use std::rc::Rc;

use crate::model::{CascadeClass, RegressionForm};
use crate::source::Span;
use pebo_cas::domain::manifold::Manifold;
use pebo_cas::forms::tidy::functions;
use pebo_cas::graph::conditions::Regularity;
use pebo_cas::{Arena, Domain, Expr, Node, Rational, Relation, Symbol};

use super::class::{Class, Proposal};
use super::own::Own;
use super::parts::{Assumption, Formula, Output, Parameter, State, assumed};

/// A plant, resolved, with its candidate transform if there is one.
#[derive(Clone, Debug)]
pub struct Plant {
    /// The identifier of the model.
    pub name: String,
    /// The title.
    pub title: Option<String>,
    /// The source of the model.
    pub reference: Option<String>,
    /// The arena of all expressions of this plant, and of the same plant with other transforms.
    pub arena: Rc<Arena>,
    /// The class that it was written by, with its matrices.
    pub class: Option<Class>,
    /// The proposals of the class; proved like anything else.
    pub proposal: Proposal,
    /// The class of cascade that the author wants; either if absent.
    pub cascade_class: Option<CascadeClass>,
    /// The form of a regression of relations between the components of the transform that the author wants, with the
    /// span.
    pub relation_form: Option<(RelationForm, Span)>,
    /// The place where a regression to first order is admitted, if it is.
    pub local_regression: Option<Span>,
    /// True if a regression that is monotone in theta is admitted where none is linear in functions of it: the model asks for
    /// it, or for no transform and no regression.
    pub monotone_regression: bool,
    /// Constants of the plant.
    pub parameters: Vec<Parameter>,
    /// Unmeasured states with their rates.
    pub x: Vec<State>,
    /// Measured outputs with their rates.
    pub y: Vec<Output>,
    /// Inputs.
    pub u: Vec<Symbol>,
    /// The input that is the time in seconds, where the formulas use it without a declaration.
    pub time: Option<Symbol>,
    /// Signals that are neither measured nor estimated; no result may depend on them.
    pub w: Vec<Symbol>,
    /// The candidate transform z = phi(x, y), one formula a component; none where it is to be searched for.
    pub phi: Vec<Formula>,
    /// The origin of the transform.
    pub origin: TransformOrigin,
    /// The transform that was found too, where this one is preferred for the noise of the sensors.
    pub noisier: Option<Noisier>,
    /// The left inverse as the author gave it: states with formulas in z and y.
    pub phi_left: Option<Vec<(Symbol, Formula)>>,
    /// Expressions in x, y and u that are zero by physics; of an output that is given by its value, the difference of
    /// the two.
    pub identities: Vec<Formula>,
    /// States that start at these values, in parameters, whenever the observer starts.
    pub known: Vec<(Symbol, Formula)>,
    /// States and outputs that are angles, with their period.
    pub angles: Vec<(Symbol, Formula)>,
    /// Units of parameters and signals, as far as the author gives them.
    pub units: BTreeMap<Symbol, String>,
    /// The domain that the author assumes.
    pub assumptions: Vec<Assumption>,
    /// Rational values of states and outputs at the start of the simulation.
    pub start: BTreeMap<Symbol, Expr>,
    /// The summands of the rates as written, each with its span.
    pub terms: BTreeMap<Symbol, Vec<Formula>>,
    /// The domain conditions of the formulas: denominators, radicands and the like.
    pub conditions: Vec<Assumption>,
    /// The coordinates z1.. of the transform.
    pub z: Vec<Symbol>,
    /// The states chi1.. of the dynamic extension.
    pub chi: Vec<Symbol>,
    /// The states xi1.. of the extension of a generalised cascade.
    pub xi: Vec<Symbol>,
    /// The entries Psi11.. of its fundamental matrix, by rows; `Psi1_1`.. where there are more than nine.
    pub psi: Vec<Vec<Symbol>>,
    /// The unknown constants theta1..
    pub theta: Vec<Symbol>,
    /// The prefix of the number of a regression's unknown, where these are functions of theta.
    pub eta: String,
}

/// The origin of a transform.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum TransformOrigin {
    /// The author gave it, or nobody has yet.
    Given,
    /// The author gave the first components; the others are functions of them, with which the outputs are affine.
    Lifted {
        /// The number of components that the author gave.
        written: usize,
    },
    /// The class that the plant was written by gives it.
    Class,
    /// It was searched for.
    Found,
}

impl TransformOrigin {
    /// The origin in a word.
    pub fn word(self) -> &'static str {
        match self {
            Self::Given | Self::Lifted { .. } => "given",
            Self::Class => "class",
            Self::Found => "found",
        }
    }
}

/// A transform that is accepted and of a plainer form than another, which takes fewer samples as they are or needs fewer
/// conditions on signals: near an exception, all noise is much.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Noisier {
    /// Its components.
    pub phi: Vec<Expr>,
    /// States, each with an output whose samples its left inverse takes with all of their noise.
    pub unfiltered: Vec<(Symbol, Symbol)>,
    /// Conditions on signals that it needs and the plant does not.
    pub conditions: Vec<(Expr, Relation)>,
}

/// The form of a regression made of a relation between the components of the transform.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum RelationForm {
    /// As it holds at every instant, with functions of theta among the unknowns where it is not affine.
    Static,
    /// Under the derivative, where constants vanish.
    Differentiated,
}

impl RelationForm {
    /// The form that a model asks for, if it is one of a relation.
    pub(super) fn of(form: RegressionForm) -> Option<Self> {
        match form {
            RegressionForm::Static => Some(Self::Static),
            RegressionForm::Differentiated => Some(Self::Differentiated),
            RegressionForm::Monotone | RegressionForm::Local => None,
        }
    }

    /// Its name in a model.
    pub fn name(self) -> &'static str {
        match self {
            Self::Static => RegressionForm::Static.name(),
            Self::Differentiated => RegressionForm::Differentiated.name(),
        }
    }
}

impl Plant {
    /// Tests whether the author wants this form of a relation between the components of the transform.
    pub fn wants(&self, form: RelationForm) -> bool {
        self.relation_form.is_some_and(|wanted| wanted.0 == form)
    }

    /// The same plant with another transform, which was searched for: a component that fails is pointed at where the
    /// rates of the states begin.
    #[must_use]
    pub fn with_transform(&self, transform: &[Expr]) -> Self {
        let Own { z, chi, theta, xi, psi } = Own::of(&self.arena, transform.len());
        let span = self.x.first().map_or(Span::NOWHERE, |state| state.rate.span);
        let mut conditions = self.conditions.clone();
        for (expr, relation) in self.arena.domain_conditions(transform, Regularity::Differentiable) {
            if conditions.iter().all(|known| (known.expr, known.relation) != (expr, relation)) {
                conditions.push(Assumption { expr, relation, span });
            }
        }
        let phi = transform.iter().map(|component| Formula { expr: *component, span }).collect();
        let (origin, proposal) = (TransformOrigin::Found, Proposal::default());
        Self {
            phi,
            origin,
            noisier: None,
            proposal,
            phi_left: None,
            conditions,
            z,
            chi,
            theta,
            xi,
            psi,
            ..self.clone()
        }
    }

    /// The same plant with further components of the transform, at the place of the author's last one.
    #[must_use]
    pub fn lifted(&self, functions: &[Expr]) -> Self {
        let mut plant = self.with_transform(&[&self.transform(), functions].concat());
        let last = self.phi.last().map_or(Span::NOWHERE, |component| component.span);
        for (index, component) in plant.phi.iter_mut().enumerate() {
            component.span = self.phi.get(index).map_or(last, |written| written.span);
        }
        plant.origin = match self.origin {
            TransformOrigin::Given => TransformOrigin::Lifted { written: self.phi.len() },
            origin => origin,
        };
        plant.phi_left.clone_from(&self.phi_left);
        plant
    }

    /// The same plant where these are positive.
    #[must_use]
    pub fn with_positive(&self, symbols: &[Symbol]) -> Self {
        self.with_positive_expressions(symbols.iter().map(|symbol| self.arena.of_symbol(*symbol)))
    }

    /// The same plant where the first of these is larger than the second.
    #[must_use]
    pub fn with_larger(&self, larger: Symbol, smaller: Symbol) -> Self {
        self.with_positive_expressions([self.arena.sub(self.arena.of_symbol(larger), self.arena.of_symbol(smaller))])
    }

    /// The same plant where these expressions are positive.
    #[must_use]
    pub fn with_positive_expressions(&self, positive: impl IntoIterator<Item = Expr>) -> Self {
        let span = self.x.first().map_or(Span::NOWHERE, |state| state.rate.span);
        let mut plant = self.clone();
        let assumed = |expr| Assumption { expr, relation: Relation::Positive, span };
        plant.assumptions.extend(positive.into_iter().map(assumed));
        plant
    }

    /// The same plant where these are between the negatives of bounds and the bounds.
    #[must_use]
    pub fn within_bounds(&self, bounds: &[(Symbol, Expr)]) -> Self {
        let arena = &self.arena;
        let sides = bounds.iter().flat_map(|(symbol, most)| {
            let value = arena.of_symbol(*symbol);
            [arena.add(*most, value), arena.sub(*most, value)]
        });
        self.with_positive_expressions(sides)
    }

    /// The same plant without these states, on which nothing else depends, and what is assumed of them.
    #[must_use]
    pub fn without_states(&self, states: &[Symbol]) -> Self {
        let holds = |expr: Expr| self.arena.depends_on(expr, &states.iter().copied().collect());
        let mut plant = self.clone();
        plant.x.retain(|state| !states.contains(&state.symbol));
        plant.assumptions.retain(|assumption| !holds(assumption.expr));
        plant.conditions.retain(|condition| !holds(condition.expr));
        plant.known.retain(|(state, _)| !states.contains(state));
        plant.angles.retain(|(state, _)| !states.contains(state));
        plant
    }

    /// The same plant where these states are angles of the period.
    #[must_use]
    pub fn with_angles(&self, angles: &[(Symbol, Expr)]) -> Self {
        let span = self.x.first().map_or(Span::NOWHERE, |state| state.rate.span);
        let mut plant = self.clone();
        plant.angles.extend(angles.iter().map(|(state, period)| (*state, Formula { expr: *period, span })));
        plant
    }

    /// The components of the transform with their values at the start, in parameters: those that the known states fix
    /// whatever the others and the outputs are.
    pub fn known_components(&self) -> Vec<(usize, Expr)> {
        let values: BTreeMap<Symbol, Expr> = self.known.iter().map(|(state, value)| (*state, value.expr)).collect();
        let constants: BTreeSet<Symbol> = self.parameters.iter().map(|parameter| parameter.symbol).collect();
        let domain = self.assumed();
        let at_start = |(component, phi): (usize, &Formula)| {
            let value = self.arena.substitute(phi.expr, &values);
            let is_fixed = self.arena.symbols_of(&[value]).is_subset(&constants);
            let asked = self.arena.domain_conditions(&[value], Regularity::Defined);
            let has_value = || asked.iter().all(|condition| domain.grants(&self.arena, *condition));
            (is_fixed && has_value()).then_some((component, value))
        };
        let components = self.phi.iter().enumerate();
        if values.is_empty() { Vec::new() } else { components.filter_map(at_start).collect() }
    }

    /// The components of the transform.
    pub fn transform(&self) -> Vec<Expr> {
        self.phi.iter().map(|f| f.expr).collect()
    }

    /// The inputs but for the time.
    pub fn commanded(&self) -> impl Iterator<Item = Symbol> + '_ {
        self.u.iter().copied().filter(|input| self.time != Some(*input))
    }

    /// The unmeasured states and signals: no result may depend on them.
    pub fn hidden(&self) -> BTreeSet<Symbol> {
        self.x.iter().map(|s| s.symbol).chain(self.w.iter().copied()).collect()
    }

    /// Tests whether the author declares the symbol.
    pub fn declares(&self, symbol: Symbol) -> bool {
        let outputs = self.y.iter().map(|output| output.symbol);
        let signals = self.u.iter().copied().chain(self.time).chain(self.hidden()).chain(outputs);
        signals.chain(self.parameters.iter().map(|parameter| parameter.symbol)).any(|own| own == symbol)
    }

    /// Tests whether the symbol may have any value: of the dynamic extension, or an unknown constant.
    pub fn is_of_extension(&self, symbol: Symbol) -> bool {
        let extension = self.chi.iter().chain(&self.xi).chain(&self.theta).chain(self.psi.iter().flatten());
        extension.into_iter().any(|own| *own == symbol)
    }

    /// The time derivatives of the states, of the outputs that have one, and of the time.
    pub fn rates(&self) -> BTreeMap<Symbol, Expr> {
        let states = self.x.iter().map(|s| (s.symbol, s.rate.expr));
        let outputs = self.y.iter().filter_map(|o| Some((o.symbol, o.rate?.expr)));
        states.chain(outputs).chain(self.time.map(|time| (time, self.arena.one()))).collect()
    }

    /// `d(phi)/dx f_x + d(phi)/dy f_y`, a component each.
    pub fn derivative_of_transform(&self) -> Vec<Expr> {
        let rates = self.rates();
        self.phi.iter().map(|phi| self.arena.directional(phi.expr, &rates)).collect()
    }

    /// The period of a state or an output, if it is an angle.
    pub fn period(&self, signal: Symbol) -> Option<Expr> {
        self.angles.iter().find(|(s, _)| *s == signal).map(|(_, period)| period.expr)
    }

    /// The period of each output, zero if it is no angle; none if no output is one.
    pub fn periods_of_outputs(&self) -> Option<Vec<Expr>> {
        let periods: Vec<Option<Expr>> = self.y.iter().map(|output| self.period(output.symbol)).collect();
        let is_angle = periods.iter().any(Option::is_some);
        is_angle.then(|| periods.into_iter().map(|period| period.unwrap_or_else(|| self.arena.zero())).collect())
    }

    /// The symbols eta1.. of so many unknowns.
    pub fn eta(&self, count: usize) -> Vec<Symbol> {
        (1..=count).map(|i| self.arena.generated(&format!("{}{i}", self.eta))).collect()
    }

    /// The domain of the claims: the assumed values at which the formulas as written have values.
    ///
    /// Without the second condition a point where the author's `sqrt(x)` does not exist could count against a claim,
    /// since construction makes `x` of its square.
    pub fn domain(&self) -> Domain {
        let mut domain = self.assumed();
        for condition in &self.conditions {
            domain.facts.assume(condition.expr, condition.relation);
        }
        let formulas: Vec<Expr> = self.rates().into_values().chain(self.transform()).collect();
        domain.written = Rc::new(functions(&self.arena, &formulas));
        domain
    }

    /// The groups of symbols that equations are solved for, in this order: unmeasured ones, which results must not
    /// hold, outputs, inputs, and parameters.
    pub(crate) fn elimination_order(&self) -> Vec<BTreeSet<Symbol>> {
        let outputs = self.y.iter().map(|output| output.symbol);
        let constants = self.parameters.iter().map(|parameter| parameter.symbol);
        vec![self.hidden(), outputs.collect(), self.u.iter().copied().collect(), constants.collect()]
    }

    /// The assumptions on values: the author's inequalities and identities, and the values of the parameters.
    pub fn assumed(&self) -> Domain {
        let mut domain = assumed(&self.arena, &self.assumptions, &self.parameters);
        if !self.identities.is_empty() {
            let equations =
                self.identities.iter().map(|identity| self.without_excluded_factors(&domain, identity.expr));
            let equations = equations.collect();
            domain.manifold = Manifold::new(&self.arena, &domain.facts, equations, self.elimination_order());
            domain.start = self.start.clone();
        }
        domain
    }

    /// A product that is zero, without the factors that inequalities keep from zero.
    fn without_excluded_factors(&self, domain: &Domain, equation: Expr) -> Expr {
        let arena = &self.arena;
        let Node::Product(product) = arena.node(equation) else { return equation };
        let may_vanish = |(base, power): &&(Expr, Rational)| {
            !power.is_negative() && !domain.implies(arena, *base, Relation::NonZero)
        };
        let left: Vec<(Expr, Rational)> = product.factors.iter().filter(may_vanish).cloned().collect();
        if left.is_empty() { equation } else { arena.multiply(&Rational::ONE, left) }
    }
}

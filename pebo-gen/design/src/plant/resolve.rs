//! Resolves a written model to a plant.
//!
//! In: a model whose declarations are consistent. Out: the plant, with a transform if the author gave one, or every
//! name and formula in it that has no meaning.

use std::collections::{BTreeMap, BTreeSet};
use std::rc::Rc;

use crate::model::{self, Comparison, Entry, Model, Spanned};
use crate::source::{Code, Diagnostic, Diagnostics};
use pebo_cas::graph::conditions::Regularity;
use pebo_cas::{Arena, Budget, Expr, Rational, Relation as Compared, Symbol};

use super::formula::{exact, lower};
use super::own::{Own, letter_of_unknowns};
use super::parts::{Assumption, Formula, Output, Parameter, State, assumed, confined};
use super::plant::{Plant, RelationForm, TransformOrigin};
use super::scope::Scope;
use super::{class, start, terms, values};

impl Plant {
    /// Resolves the names and numbers of a model; later computations on the plant have the usual budget.
    pub fn resolve(model: &Model) -> Result<Self, Vec<Diagnostic>> {
        Self::resolve_within(model, Budget::default())
    }

    /// Resolves the names and numbers of a model; later computations on the plant draw from the budget, as the
    /// expansion of a class does.
    pub fn resolve_within(model: &Model, budget: Budget) -> Result<Self, Vec<Diagnostic>> {
        Self::resolve_in(Rc::new(Arena::within(budget)), model)
    }

    /// The same plant in which these parameters are symbols: one that is given as zero is in no formula, as proofs hold
    /// for zero then.
    pub fn with_symbols(&self, model: &Model, parameters: &[&str]) -> Result<Self, Vec<Diagnostic>> {
        let mut open = model.clone();
        for parameter in open.parameters.iter_mut().filter(|entry| parameters.contains(&entry.name.value.as_str())) {
            parameter.value = None;
        }
        Self::resolve_in(Rc::clone(&self.arena), &open)
    }

    fn resolve_in(arena: Rc<Arena>, model: &Model) -> Result<Self, Vec<Diagnostic>> {
        let mut problems = Diagnostics::new();
        // In this order, so that results print parameters before states before inputs.
        let parameters = problems.all(model.parameters.iter().map(|entry| parameter(&arena, entry)));
        let names = |list: &[Spanned<String>]| -> Vec<Symbol> {
            list.iter().filter_map(|name| arena.as_symbol(arena.variable(&name.value))).collect()
        };
        let (y, x, u, w) = (names(&model.y), names(&model.x), names(&model.u), names(&model.w));
        let own = Own::of(&arena, class::components(model));

        let scope = names_of(&arena, model, &parameters, &mut problems);
        let constants: BTreeSet<Symbol> = parameters.iter().map(|p| p.symbol).collect();
        let with = |groups: &[&[Symbol]]| -> BTreeSet<Symbol> {
            groups.iter().flat_map(|g| g.iter().copied()).chain(constants.iter().copied()).collect()
        };
        let within = |formula: &model::Formula, allowed: &BTreeSet<Symbol>, place: &str| {
            let expr = lower(&arena, &scope, formula)?;
            confined(&arena, expr, formula.span, allowed, place)
        };

        let assumptions = self::assumptions(&arena, &scope, model, &parameters, &mut problems);
        let domain = assumed(&arena, &assumptions, &parameters);
        let on_states = with(&[&x, &y]);
        let dynamics = match &model.class {
            None => explicit(&arena, &scope, model, (&x, &y), &mut problems, |formula| {
                within(formula, &on_states, "phi(x, y)")
            }),
            Some(class) => {
                let place = class::ClassContext { arena: &arena, scope: &scope, model, domain: &domain, z: &own.z };
                let names = class::Names { x: &x, y: &y, u: &u, w: &w, constants: &constants };
                place.expand(class, &names, &mut problems).unwrap_or_default()
            }
        };
        let class::Expansion { x: states, y: mut outputs, phi, proposal, class, conditions } = dynamics;
        let origin = if class.is_some() { TransformOrigin::Class } else { TransformOrigin::Given };
        let mut identities =
            problems.all(model.identities.iter().map(|f| within(f, &with(&[&x, &y, &u]), "an identity in x, y and u")));
        values::confine(&arena, &outputs, &with(&[&x, &y, &u]), &mut problems);
        identities.extend(values::identities(&arena, &outputs));
        let time = model.time.and(u.last().copied());
        values::move_along(&arena, &states, &mut outputs, time, &constants);
        let constant = |value: &model::Formula| within(value, &with(&[]), "a value at the start");
        let known = super::known::starts(&arena, model, (&assumptions, &parameters), constant, &mut problems);
        let angles = problems.all(model.angles.iter().map(|entry| {
            let period = within(&entry.value, &with(&[]), "a period")?;
            super::period::positive(&arena, &domain, period)?;
            Ok((arena.symbol(&entry.name.value), period))
        }));
        let mut inverse_scope = scope.clone();
        for symbol in &own.z {
            inverse_scope.define(arena.name(*symbol), arena.of_symbol(*symbol));
        }
        let on_transform = with(&[&own.z, &y]);
        let phi_left = problems.all(model.phi_left.iter().map(|entry| {
            let expr = lower(&arena, &inverse_scope, &entry.value)?;
            let formula = confined(&arena, expr, entry.value.span, &on_transform, "phi_left(z, y)")?;
            Ok((arena.symbol(&entry.name.value), formula))
        }));
        let units =
            model.units.iter().map(|entry| (arena.symbol(&entry.name.value), entry.value.value.clone())).collect();
        let conditions = domain_conditions(&arena, &scope, model, conditions);
        let terms = terms::of_rates(&arena, &scope, model);
        rates_of_transform(&arena, &phi, &outputs, &mut problems);
        if arena.budget().is_exhausted() {
            // Other findings may be no mistakes, but something that there was no time to prove.
            let phase = if model.class.is_some() { "the expansion of the class" } else { "the reading of the model" };
            return Err(vec![Diagnostic::limit_reached(phase, model.name.span)]);
        }
        problems.propagate()?;
        Ok(Self {
            name: model.name.value.clone(),
            title: model.title.as_ref().map(|t| t.value.clone()),
            reference: model.reference.as_ref().map(|r| r.value.clone()),
            class,
            cascade_class: model.cascade_class.as_ref().map(|class| class.value),
            relation_form: model.asks_for(RelationForm::of),
            local_regression: model.admits_local(),
            monotone_regression: model.admits_monotone(),
            proposal,
            start: start_of(&arena, model, &parameters, &outputs),
            parameters,
            x: states,
            y: outputs,
            time,
            u,
            w,
            origin,
            noisier: None,
            phi,
            phi_left: (!phi_left.is_empty()).then_some(phi_left),
            identities,
            known,
            angles,
            units,
            terms,
            conditions,
            assumptions,
            z: own.z,
            chi: own.chi,
            theta: own.theta,
            xi: own.xi,
            psi: own.psi,
            eta: letter_of_unknowns(model),
            arena,
        })
    }
}

/// The names of a model with their meanings: a symbol, zero for a parameter that is given as zero, or a definition.
fn names_of(arena: &Arena, model: &Model, parameters: &[Parameter], problems: &mut Diagnostics) -> Scope {
    let mut scope = Scope::new();
    for name in model.declared() {
        scope.define(&name.value, arena.variable(&name.value));
    }
    // A parameter given as zero is zero everywhere.
    for parameter in parameters.iter().filter(|p| p.value.as_ref().is_some_and(Rational::is_zero)) {
        scope.define(arena.name(parameter.symbol), arena.zero());
    }
    // Each uses only earlier ones: no definition is a symbol.
    for definition in &model.define {
        let meaning = problems.keep(lower(arena, &scope, &definition.value));
        // A failure was reported, and there will be no plant; formulas that use it are checked all the same.
        let meaning = meaning.unwrap_or_else(|| arena.variable(&definition.name.value));
        scope.define(&definition.name.value, meaning);
    }
    scope
}

/// The domain conditions of the formulas, and the conditions for the transform to have derivatives, beside those of a
/// class: some of its formulas are differentiated.
fn domain_conditions(arena: &Arena, scope: &Scope, model: &Model, of_class: Vec<Assumption>) -> Vec<Assumption> {
    let mut conditions = of_class;
    let mut collect = |formula: &model::Formula, want: Regularity| {
        // A failure was reported where the formula itself was lowered.
        let _ = super::conditions::collect(arena, scope, formula, want, &mut conditions);
    };
    let of_class: Vec<_> = model.class.iter().flat_map(model::Class::formulas).collect();
    // The rate of an output that is given by its value is that of the value.
    let values = model.g_y.iter().map(|entry| &entry.value);
    let smooth: Vec<&model::Formula> = model.phi.iter().chain(values).chain(of_class).collect();
    let plain = model.f_x.iter().chain(&model.f_y).map(|entry| &entry.value).chain(&model.identities);
    plain.for_each(|formula| collect(formula, Regularity::Defined));
    for formula in &smooth {
        collect(formula, Regularity::Differentiable);
    }
    // A definition that a differentiated formula uses, directly or through others, is differentiated too.
    let mut users = smooth;
    let mut differentiated = BTreeSet::new();
    while let Some(user) = users.pop() {
        for (index, definition) in model.define.iter().enumerate() {
            if super::conditions::uses(user, &definition.name.value) && differentiated.insert(index) {
                users.push(&definition.value);
            }
        }
    }
    for (index, definition) in model.define.iter().enumerate() {
        collect(
            &definition.value,
            if differentiated.contains(&index) { Regularity::Differentiable } else { Regularity::Defined },
        );
    }
    conditions
}

/// The equations as the author wrote them.
fn explicit(
    arena: &Arena,
    scope: &Scope,
    model: &Model,
    (x, y): (&[Symbol], &[Symbol]),
    problems: &mut Diagnostics,
    component: impl Fn(&model::Formula) -> Result<Formula, Diagnostic>,
) -> class::Expansion<Option<class::Class>> {
    let states = x
        .iter()
        .zip(&model.f_x)
        .map(|(symbol, rate)| Ok(State { symbol: *symbol, rate: resolved(arena, scope, &rate.value)? }));
    let states = problems.all(states);
    let outputs = model.y.iter().zip(y).map(|(name, symbol)| {
        let rate = model.f_y.iter().find(|entry| entry.name.value == name.value);
        let rate = rate.map(|entry| resolved(arena, scope, &entry.value)).transpose()?;
        let value = model.g_y.iter().find(|entry| entry.name.value == name.value);
        let value = value.map(|entry| resolved(arena, scope, &entry.value)).transpose()?;
        Ok(Output { symbol: *symbol, rate, value, span: name.span })
    });
    let outputs = problems.all(outputs);
    let phi = problems.all(model.phi.iter().map(component));
    class::Expansion { x: states, y: outputs, phi, ..class::Expansion::default() }
}

impl Diagnostics {
    /// The good results; the others are kept as diagnostics.
    pub(super) fn all<T>(&mut self, results: impl Iterator<Item = Result<T, Diagnostic>>) -> Vec<T> {
        results.filter_map(|result| self.keep(result)).collect()
    }
}

fn parameter(arena: &Arena, entry: &Entry<Option<Spanned<model::Decimal>>>) -> Result<Parameter, Diagnostic> {
    let value = entry.value.as_ref().map(|v| exact(&v.value, v.span)).transpose()?;
    let text = entry.value.as_ref().map(|v| v.value.text().to_owned());
    arena.variable(&entry.name.value);
    Ok(Parameter { symbol: arena.symbol(&entry.name.value), value, text, span: entry.name.span })
}

fn resolved(arena: &Arena, scope: &Scope, formula: &model::Formula) -> Result<Formula, Diagnostic> {
    Ok(Formula { expr: lower(arena, scope, formula)?, span: formula.span })
}

/// The assumptions that are no truths about numbers; those that exclude one another are reported.
fn assumptions(
    arena: &Arena,
    scope: &Scope,
    model: &Model,
    parameters: &[Parameter],
    problems: &mut Diagnostics,
) -> Vec<Assumption> {
    let written = problems.all(model.assume.iter().map(|chain| compared(arena, scope, chain)));
    let mut assumptions: Vec<Assumption> = written.into_iter().flatten().collect();
    super::contradiction::find(arena, &assumptions, parameters, problems);
    assumptions.retain(|assumption| !arena.holds_of_number((assumption.expr, assumption.relation)));
    assumptions
}

/// The inequalities of a chain as comparisons with zero.
fn compared(arena: &Arena, scope: &Scope, comparison: &Comparison) -> Result<Vec<Assumption>, Diagnostic> {
    use model::Relation::{Greater, GreaterOrEqual, Less, LessOrEqual, NotEqual};
    comparison
        .pairs()
        .map(|(left, relation, right)| {
            let (a, b) = (lower(arena, scope, left)?, lower(arena, scope, right)?);
            let (difference, relation) = match relation {
                Less => (arena.sub(b, a), Compared::Positive),
                LessOrEqual => (arena.sub(b, a), Compared::NonNegative),
                Greater => (arena.sub(a, b), Compared::Positive),
                GreaterOrEqual => (arena.sub(a, b), Compared::NonNegative),
                NotEqual => (arena.sub(a, b), Compared::NonZero),
            };
            Ok(Assumption { expr: difference, relation, span: comparison.span })
        })
        .collect()
}

/// The values at the start of the simulation.
fn start_of(arena: &Arena, model: &Model, parameters: &[Parameter], outputs: &[Output]) -> BTreeMap<Symbol, Expr> {
    let parameters: Vec<_> = parameters.iter().filter_map(|own| Some((own.symbol, own.value.clone()?))).collect();
    let outputs: Vec<_> = outputs.iter().filter_map(|own| Some((own.symbol, own.value?.expr))).collect();
    start::start(arena, model, &parameters, &outputs)
}

/// Every output that the transform uses needs a rate.
fn rates_of_transform(arena: &Arena, phi: &[Formula], outputs: &[Output], problems: &mut Diagnostics) {
    for component in phi {
        let used = arena.symbols_of(&[component.expr]);
        for output in outputs.iter().filter(|o| o.rate.is_none() && used.contains(&o.symbol)) {
            let name = arena.name(output.symbol);
            let missing = Diagnostic::error(
                Code::MissingRate,
                component.span,
                format!("phi uses {name}, whose rate is not given"),
            )
            .also(output.span, "declared here");
            problems.push(match &output.value {
                None => missing.help(format!("give the rate of {name} under `f_y`")),
                Some(value) => missing
                    .also(value.span, "an input moves this value, and its own rate is not known")
                    .help(format!("leave {name} out of phi")),
            });
        }
    }
}

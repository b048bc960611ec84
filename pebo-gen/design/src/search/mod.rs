//! Transforms that make a plant's state observation an estimation of constants: the search for phi.
//!
//! ```text
//! Plant, class -> candidates -> claims, proved by `analysis` -> Search
//! ```
//!
//! In: a plant; its own transform, if any, is ignored. Out: the transforms that were found, in order of merit, each
//! with its derivation, and the attempts. Holds after: *found* is said only of a transform whose claims are all proved.
//! Everything before that proof only directs the search: values modulo a prime, null spaces, rules for integrals.
//!
//! It is linear: the rate of `phi = sum of c_k b_k` is linear in the `c_k`, and in dphi, however nonlinear the plant is
//! (Ortega, Bobtsov, Pyrkin, Aranovskiy 2015, eq. 3). Attempts go from simple forms to large ones; the first whose outputs
//! are affine in z ends the search.

mod bounds;
mod integral;
mod problem;

mod ansatz;
mod candidate;
mod choice;
mod closure;
mod completion;
mod continuous;
mod found;
mod frame;
mod functions;
mod sample;
#[cfg(all(test, feature = "yaml"))]
mod tests;
pub mod words;

use std::collections::BTreeSet;

use crate::analysis::{Class, Derivation, Verdict};
use crate::plant::{Plant, TransformOrigin};
use pebo_cas::domain::zero::decide;
use pebo_cas::tower::Obstacle;
use pebo_cas::{Expr, Relation, Symbol};

use ansatz::{Ansatz, Rate};
use bounds::LARGEST_ORDER;
pub use bounds::{Bound, BoundClass, Evidence};
pub use candidate::Candidate;
use completion::connection::Connection;
use continuous::{continuous, is_of_states_and_outputs};
pub use found::{Form, Found, Search, Start, Tried};
pub use frame::Block;
#[cfg(feature = "yaml")]
pub use frame::blocks;
use problem::Question;
pub use words::settles;

/// Searches for a transform of the plant, of one class of cascade or of any.
///
/// ```
/// use pebo_design::model::Model;
/// use pebo_design::plant::Plant;
/// use pebo_design::search::{Found, solve};
/// use pebo_design::source::Source;
///
/// let text = "model: m\nx: [p]\ny: [q]\nu: [v]\nf_x: {p: v - sin(q)}\nf_y: {q: p}\n";
/// let model = Model::parse(&Source::new("m.yaml", text).expect("a short text")).expect("a model");
/// let search = solve(&Plant::resolve(&model).expect("a plant"), None);
/// assert_eq!(search.verdict, Found::Found);
/// assert_eq!(search.candidates[0].formulas(), ["p"]);
/// ```
#[must_use]
pub fn solve(plant: &Plant, class: Option<Class>) -> Search {
    let question = Question::of(plant);
    let mut hunt = Hunt::new(&question);
    // The transform of the plant's class may leave nothing better to be expected.
    let own = of_class(plant).filter(|own| class.is_none_or(|class| own.derivation.class == class));
    hunt.candidates.extend(own);
    hunt.run(class);
    // An output may determine a state, with all of its noise: transforms that filter it were looked for first.
    for told in Question::with_told_states(plant) {
        if hunt.is_full() || !told.goes_on() {
            break;
        }
        let mut others = Hunt::new(&told);
        others.run(class);
        hunt.candidates.extend(others.candidates.into_iter().filter(Candidate::is_full));
    }
    let (mut candidates, tried) = (std::mem::take(&mut hunt.candidates), std::mem::take(&mut hunt.tried));
    if let Some(class) = class {
        candidates.retain(|candidate| candidate.derivation.class == class);
    }
    candidates.sort_by_cached_key(Candidate::merit);
    let found = candidates.first().is_some_and(Candidate::is_full);
    let plain = found && candidates.first().is_some_and(|c| c.derivation.class == Class::Pebo);
    let (affine, bound) = if plain || class == Some(Class::Gpebo) {
        (None, None)
    } else {
        let affine = hunt.affine.take().or_else(|| bounds::largest::affine(&question, 0));
        (affine, hunt.bound.take().or_else(|| bounds::largest::smooth_to(&question, LARGEST_ORDER, 0)))
    };
    let affine = affine.filter(|affine| affine.rank < affine.states);
    let bound = match bound {
        Some(smooth) if smooth.rank < smooth.states => Some(smooth),
        smooth => affine.clone().or(smooth),
    };
    let smooth = bound.as_ref().is_some_and(|bound| bound.class == BoundClass::Smooth && bound.excludes());
    let generalised = if found || !smooth || class.is_some() {
        None
    } else {
        hunt.generalised.take().or_else(|| affine_rates(&question, 0)).filter(|bound| bound.rank < bound.states)
    };
    let excluded = smooth
        && (class == Some(Class::Pebo)
            || (generalised.as_ref().is_some_and(Bound::excludes) && question.suggests_affine_transforms()));
    // A transform may fail at single points, which are then listed: two points that were drawn are not both of them.
    let again = || {
        let smooth = bounds::largest::smooth(&question, bounds::largest::affine(&question, 1).as_ref(), 1)
            .filter(Bound::excludes)
            .or_else(|| bounds::largest::smooth_to(&question, LARGEST_ORDER, 1));
        let generalised = || affine_rates(&question, 1);
        smooth.is_some_and(|bound| bound.excludes())
            && (class.is_some() || generalised().is_some_and(|bound| bound.excludes()))
    };
    let excluded = excluded && again();
    let verdict = match (found, excluded) {
        (true, _) => Found::Found,
        (false, true) => Found::None,
        (false, false) => Found::Undecided,
    };
    let assumed = if found { None } else { with_signs(&question, &candidates) };
    Search { verdict, candidates, assumed, bound, affine, generalised, tried }
}

/// The transform that the plant's class gives: coils have their fluxes.
fn of_class(plant: &Plant) -> Option<Candidate> {
    let is_own = plant.origin == TransformOrigin::Class && !plant.phi.is_empty();
    is_own.then(|| Candidate { plant: plant.clone(), derivation: Derivation::derive(plant) })
}

/// The bound of the transforms affine in x with a plain or generalised cascade, at a point that is found after so many.
fn affine_rates(question: &Question<'_>, others: usize) -> Option<Bound> {
    bounds::bound(question, BoundClass::AffineRate, (LARGEST_ORDER, others))
}

/// The first transform that recovers the states if states without a known sign are positive.
fn with_signs(question: &Question<'_>, candidates: &[Candidate]) -> Option<(Candidate, Vec<Symbol>)> {
    let arena = question.arena;
    let lost = |c: &&Candidate| c.derivation.left_inverse.verdict == Verdict::Refuted;
    let candidate = candidates.iter().filter(|c| c.derivation.cascade.verdict == Verdict::Proved).find(lost)?;
    let unknown = |state: &Symbol| {
        let state = arena.of_symbol(*state);
        ![state, arena.neg(state)].iter().any(|e| question.domain.implies(arena, *e, Relation::Positive))
    };
    let signs: Vec<Symbol> = question.x.iter().copied().filter(unknown).collect();
    if signs.is_empty() || !question.goes_on() {
        return None;
    }
    let plant = question.plant.with_positive(&signs);
    let question = Question::of(&plant);
    let budget = arena.budget();
    let candidate = budget.share(2, || Candidate::of(&question, &candidate.plant.transform()));
    candidate.is_full().then_some((candidate, signs))
}

/// The order of series that costs less than another form of transforms.
const LOW_ORDER: usize = 2;

/// Products of a state and an output from which on constant combinations are tried before them.
const MOST_PRODUCTS: usize = 100;

/// The degree of polynomials in the outputs up to which they are tried beside constant combinations of the states.
const MOST_SHIFTED: usize = 5;

/// The share of the remaining budget for polynomials with undetermined coefficients.
const FOR_INVARIANT: u64 = 8;

struct Hunt<'a> {
    question: &'a Question<'a>,
    candidates: Vec<Candidate>,
    tried: Vec<Tried>,
    /// The decision on transforms affine in x with a plain cascade.
    affine: Option<Bound>,
    /// The bound that excludes further transforms with a plain cascade.
    bound: Option<Bound>,
    /// The bound that excludes further transforms that are affine in x.
    generalised: Option<Bound>,
    /// Transforms in which the outputs are not affine: they are proved if nothing better is found.
    later: Vec<Vec<Expr>>,
    /// The transforms that were met.
    seen: BTreeSet<Vec<Expr>>,
    /// The polynomials in the states that divide their own rates, once they were looked for.
    invariant: Option<Vec<Expr>>,
}

impl<'a> Hunt<'a> {
    fn new(question: &'a Question<'a>) -> Self {
        Self {
            question,
            candidates: Vec::new(),
            tried: Vec::new(),
            affine: None,
            bound: None,
            generalised: None,
            later: Vec::new(),
            seen: BTreeSet::new(),
            invariant: None,
        }
    }

    /// Tries the forms of the class, or of both.
    fn run(&mut self, class: Option<Class>) {
        if class != Some(Class::Gpebo) {
            self.plain();
        }
        if class != Some(Class::Pebo) && !self.is_over() {
            self.generalised();
        }
        self.rest();
    }
}

impl Hunt<'_> {
    /// Tests whether there is nothing better to be expected.
    fn is_over(&self) -> bool {
        !self.question.goes_on()
            || self.candidates.iter().any(|c| c.is_full() && c.is_linear() && !c.copies_an_output())
    }

    /// Tests whether a transform was found.
    fn is_full(&self) -> bool {
        self.candidates.iter().any(Candidate::is_full)
    }

    /// Tests whether transforms affine in x, or series of low order, prove that no smooth transform has a plain cascade
    /// and a left inverse.
    fn is_excluded(&mut self) -> bool {
        self.affine = bounds::largest::affine(self.question, 0);
        self.bound = bounds::largest::smooth(self.question, self.affine.as_ref(), 0)
            .filter(Bound::excludes)
            .or_else(|| bounds::largest::smooth_to(self.question, LOW_ORDER, 0))
            .filter(Bound::excludes);
        self.bound.is_some()
    }

    /// Transforms with a plain cascade.
    fn plain(&mut self) {
        let question = self.question;
        let arena = question.arena;
        let states: Vec<(Expr, usize)> = question.x.iter().map(|x| (arena.of_symbol(*x), 1)).collect();
        let affine = [&[(arena.one(), 0)], states.as_slice()].concat();
        let mut outputs = functions::of_outputs(question);
        self.attempt(Form::Affine(0), |_| Ok(Ansatz { of_x: states.clone(), of_y: vec![(arena.one(), 0)], weight: 1 }));
        // With many signals there are too many products; combinations with constant coefficients there are not.
        if states.len() * question.y.len() > MOST_PRODUCTS && !self.is_over() {
            let of_y = question.y.iter().map(|y| (arena.of_symbol(*y), 1));
            let of_y = std::iter::once((arena.one(), 0)).chain(of_y).collect();
            self.attempt(Form::Affine(0), |_| Ok(Ansatz { of_x: affine.clone(), of_y, weight: 1 }));
        }
        for degree in 1..=3 {
            // Found in no time where there is one, while completions of long formulas take long.
            if degree == 2 && !self.is_over() {
                self.shifted();
            }
            if self.is_over() || (degree == 2 && self.is_excluded()) {
                return;
            }
            if self.affine.as_ref().is_some_and(Bound::excludes) {
                break;
            }
            // Products of the functions in the formulas read better than integrals.
            if degree == 3 {
                let integrated = arena.budget().share(3, || completion::integration::integrated(question));
                self.judge(Form::Integrals, 0, integrated);
                if self.is_over() {
                    return;
                }
            }
            // Functions outside the formulas come in where those were not enough.
            if degree == 2 {
                let roots = functions::roots(question, &outputs);
                outputs.extend(roots);
                // There are transforms, perhaps of functions that turn with an angle that no formula holds.
                if self.affine.as_ref().is_some_and(|affine| affine.transforms().is_some()) {
                    outputs.extend(functions::waves(question));
                }
            }
            if degree == 2
                && let Ok(connection) = Connection::of(question, Rate::Free)
            {
                let factors = connection.factors(question);
                let shifts = connection.shifts(question, &[&[arena.one()], factors.as_slice(), &outputs].concat());
                for function in factors.into_iter().chain(shifts) {
                    if !outputs.contains(&function) {
                        outputs.push(function);
                    }
                }
            }
            let pool = outputs.clone();
            self.attempt(Form::Affine(degree), |question| {
                let of_y = functions::products(question, &pool, degree + usize::from(degree == 1))?;
                Ok(Ansatz { of_x: affine.clone(), of_y, weight: degree + 1 })
            });
        }
        let mut of_states = functions::of_states(question);
        let bases = [of_states.as_slice(), &outputs, self.invariant()].concat();
        let logarithms = functions::logarithms(question, &bases);
        for logarithm in logarithms {
            let list = if arena.depends_on(logarithm, &question.hidden) { &mut of_states } else { &mut outputs };
            if !list.contains(&logarithm) {
                list.push(logarithm);
            }
        }
        for (first, second) in [(1, 1), (2, 1), (2, 2), (3, 2)] {
            if self.is_over() {
                return;
            }
            let (of_x, of_y) = (of_states.clone(), outputs.clone());
            self.attempt(Form::Nonlinear(first, second), |question| {
                let of_x = functions::products(question, &of_x, first)?;
                let of_y = functions::products(question, &of_y, second)?;
                Ok(Ansatz { of_x, of_y, weight: first + second })
            });
        }
    }

    /// Constant combinations of the states with polynomials in the outputs, where the formulas are polynomials in all that
    /// moves: of a few columns for a state, up to a high degree.
    fn shifted(&mut self) {
        let question = self.question;
        let arena = question.arena;
        let symbols: Vec<Expr> = question.y.iter().map(|y| arena.of_symbol(*y)).collect();
        for degree in 3..=MOST_SHIFTED {
            let Some(of_y) = functions::monomials(question, &symbols, degree) else { return };
            let states = question.x.iter().map(|x| (arena.of_symbol(*x), degree));
            let of_x = [(arena.one(), 0)].into_iter().chain(states).collect();
            self.attempt(Form::Shifted(degree), |_| Ok(Ansatz { of_x, of_y, weight: degree }));
            if self.is_over() {
                return;
            }
        }
    }

    /// Transforms with a generalised cascade.
    fn generalised(&mut self) {
        let question = self.question;
        let arena = question.arena;
        let states: Vec<Expr> = question.x.iter().map(|x| arena.of_symbol(*x)).collect();
        let rates: Vec<Expr> = question.x.iter().filter_map(|x| question.rates.get(x).copied()).collect();
        if matches!(sample::is_affine_in(question, &rates, &states), Ok(true)) {
            self.judge(Form::States, 0, Ok(states.clone()));
        }
        let rates = question.output_rates();
        let both = [rates.as_slice(), &states].concat();
        let identities: Vec<Expr> = question.plant.identities.iter().map(|identity| identity.expr).collect();
        let told = if identities.is_empty() { Vec::new() } else { [identities.as_slice(), &states].concat() };
        let starts =
            [(Start::Outputs, &rates), (Start::Both, &both), (Start::States, &states), (Start::Identities, &told)];
        for (start, formulas) in starts.into_iter().filter(|(_, formulas)| !formulas.is_empty()) {
            if self.is_over() {
                return;
            }
            let closed = closure::closure(question, formulas).map(Option::unwrap_or_default);
            self.judge(Form::Closure(start), 0, closed);
        }
        if self.is_over() {
            return;
        }
        let closed = closure::of_rows(question).map(Option::unwrap_or_default);
        self.judge(Form::Closure(Start::Rows), 0, closed);
        if self.is_over() {
            return;
        }
        self.of_quotients();
        if self.is_over() {
            return;
        }
        self.with_constants();
        if self.is_over() {
            return;
        }
        // The bound of transforms affine in x is looked at where that of all plain cascades is small.
        if self.bound.is_some() {
            self.generalised = affine_rates(question, 0);
            if self.generalised.as_ref().is_some_and(Bound::excludes) {
                return;
            }
        }
        let mut outputs = functions::of_outputs(question);
        if let Ok(connection) = Connection::of(question, Rate::Affine) {
            outputs.extend(connection.factors(question));
        }
        for degree in 1..=2 {
            if self.is_over() {
                return;
            }
            let ansatz = || {
                let of_x = [(arena.one(), 0)].into_iter().chain(states.iter().map(|x| (*x, 1))).collect();
                Ok(Ansatz { of_x, of_y: functions::products(question, &outputs, degree)?, weight: degree + 1 })
            };
            self.attempt_with(Form::Frame(degree), Rate::Affine, ansatz());
        }
    }

    /// Quotients of the states by a polynomial that divides its own rate: the rates of these may be affine, as that of
    /// `1/p` is for `p' = a*p + b*p^2`.
    fn of_quotients(&mut self) {
        let question = self.question;
        let arena = question.arena;
        for polynomial in self.invariant().to_vec() {
            let states = question.x.iter().map(|x| arena.of_symbol(*x));
            // The last is begun with: of functions of one span the reciprocal is the plainest.
            let quotients: Vec<Expr> = states.chain([arena.one()]).map(|above| arena.div(above, polynomial)).collect();
            let closed = closure::closure(question, &quotients).map(Option::unwrap_or_default);
            self.judge(Form::Closure(Start::Quotients), 0, closed);
            if self.is_over() {
                return;
            }
        }
    }

    /// The polynomials in the states that divide their own rates.
    fn invariant(&mut self) -> &[Expr] {
        let question = self.question;
        self.invariant.get_or_insert_with(|| {
            let found = question.arena.budget().share(FOR_INVARIANT, || closure::darboux::invariant(question));
            found.unwrap_or_default()
        })
    }

    /// A transform by way of one that there is if the unknown constants are measured.
    fn with_constants(&mut self) {
        let question = self.question;
        let unknown = closure::constants::constants(question);
        if !unknown.is_empty() {
            let by_parts = closure::by_parts::by_parts(question, &unknown).map(Option::unwrap_or_default);
            let by_parts = by_parts.and_then(|functions| closure::observable::observable(question, &functions));
            self.judge(Form::Closure(Start::Parts), 0, by_parts);
        }
        if self.is_over() {
            return;
        }
        let Some(measured) = closure::constants::measured(question) else { return };
        let search = question.arena.budget().share(3, || solve(&measured, Some(Class::Pebo)));
        let proved = |candidate: &&Candidate| {
            let derivation = &candidate.derivation;
            derivation.cascade.verdict == Verdict::Proved && derivation.left_inverse.verdict == Verdict::Proved
        };
        if let Some(candidate) = search.candidates.iter().find(proved) {
            let closed = closure::constants::closure(question, candidate).map(Option::unwrap_or_default);
            let closed = closed.and_then(|functions| closure::observable::observable(question, &functions));
            self.judge(Form::Closure(Start::Constants), 0, closed);
        }
    }

    fn attempt(&mut self, form: Form, ansatz: impl FnOnce(&Question<'_>) -> Result<Ansatz, Obstacle>) {
        let ansatz = ansatz(self.question);
        self.attempt_with(form, Rate::Free, ansatz);
    }

    fn attempt_with(&mut self, form: Form, rate: Rate, ansatz: Result<Ansatz, Obstacle>) {
        let question = self.question;
        let columns = ansatz.as_ref().map_or(0, |ansatz| ansatz.width(question));
        // A large null space does not keep other forms from being tried.
        let of = |ansatz: Ansatz| question.arena.budget().share(2, || ansatz.solutions(question, rate));
        let solutions = ansatz.and_then(of);
        self.judge(form, columns, solutions);
    }

    /// Derives the claims of the transforms that were found.
    fn judge(&mut self, form: Form, columns: usize, solutions: Result<Vec<Expr>, Obstacle>) {
        let count = solutions.as_ref().map_or(0, Vec::len);
        // A closure is one transform, which would not close without one of its components.
        let choose = if matches!(form, Form::Closure(_)) { choice::whole } else { choice::choose };
        let choice = solutions.and_then(|solutions| choose(self.question, &solutions));
        let (choice, obstacle) = match choice {
            Ok(choice) => (choice, None),
            Err(obstacle) => (choice::Choice::default(), Some(obstacle)),
        };
        self.tried.push(Tried { form, columns, solutions: count, rank: choice.rank, obstacle });
        if choice.rank < self.question.x.len() {
            return;
        }
        for (index, phi) in choice.transforms.into_iter().enumerate() {
            if self.is_over() || !self.seen.insert(phi.clone()) {
                continue;
            }
            if index == 0 && choice.affine {
                self.prove(&phi);
            } else {
                self.later.push(phi);
            }
        }
    }

    /// Proves deferred transforms: those in which the outputs do not look affine.
    fn rest(&mut self) {
        for phi in std::mem::take(&mut self.later) {
            if self.is_full() || !self.question.goes_on() {
                return;
            }
            self.prove(&phi);
        }
    }

    /// Derives the claims with a third of the remaining budget: an undecided one then does not end the search.
    fn prove(&mut self, phi: &[Expr]) {
        let question = self.question;
        let may_stand =
            |component: &Expr| question.exists(*component) && is_of_states_and_outputs(question, *component);
        if !phi.iter().all(may_stand) {
            return;
        }
        let Some(phi) = phi.iter().map(|component| continuous(question, *component)).collect::<Option<Vec<_>>>() else {
            return;
        };
        // Components that vanish by the values of outputs filter nothing; the rest may do alone.
        let domain = &question.domain;
        let is_zero = |component: &Expr| decide(question.arena, *component, domain).is_zero();
        let rest: Vec<Expr> = match question.plant.identities.as_slice() {
            [] => phi.clone(),
            _ => phi.iter().copied().filter(|component| !is_zero(component)).collect(),
        };
        if !rest.is_empty() && rest.len() < phi.len() {
            let candidate = question.arena.budget().share(3, || Candidate::of(question, &rest));
            let is_full = candidate.is_full();
            self.candidates.push(candidate);
            if is_full {
                return;
            }
        }
        let candidate = question.arena.budget().share(3, || Candidate::of(question, &phi));
        self.candidates.push(candidate);
    }
}

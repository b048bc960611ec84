//! Attempts at a transform, one form after another, from simple forms to large ones.
//!
//! In: a problem, and the class of cascade that is asked for. Out: candidates with their derivations, in the order in
//! which they were found, the forms that were tried, and bounds on the way. Holds after: a form is left out only where
//! nothing better is to be expected of it, where a bound excludes it, or where the budget has ended.

use std::collections::BTreeSet;

use super::ansatz::{Ansatz, Rate};
use super::bounds::{self, Bound, affine_rates};
use super::candidate::Candidate;
use super::completion::{self, connection::Connection};
use super::continuous::{continuous, is_of_states_and_outputs};
use super::found::{Attempt, Form, Start};
use super::problem::Problem;
use super::{choice, closure, functions, sample};
use crate::analysis::Class;
use crate::plant::{Noisier, TransformOrigin};
use pebo_cas::Expr;
use pebo_cas::domain::zero::is_zero;
use pebo_cas::tower::Obstacle;

/// The order of series that costs less than another form of transforms.
const LOW_ORDER: usize = 2;

/// Products of a state and an output from which on constant combinations are tried before them.
const MOST_PRODUCTS: usize = 100;

/// The degree of polynomials in the outputs up to which they are tried beside constant combinations of the states.
const MOST_SHIFTED: usize = 5;

/// The share of the remaining budget for transforms with a plain cascade where generalised ones are tried after them.
const FOR_PLAIN: u64 = 2;

/// The share of the remaining budget for a transform with less noise or fewer exceptions than one that is accepted.
const FOR_LESS_NOISE: u64 = 4;

/// The share of the remaining budget for polynomials with undetermined coefficients.
const FOR_INVARIANT: u64 = 8;

/// The attempts of a class or of any, with their candidates in order of merit.
pub(super) fn attempted<'a>(problem: &'a Problem<'a>, class: Option<Class>) -> Attempts<'a> {
    let plant = problem.plant;
    let mut attempts = Attempts::new(problem);
    // The transform of the plant's class may leave nothing better to be expected.
    let own = of_class(problem).filter(|own| class.is_none_or(|class| own.derivation.class == class));
    attempts.candidates.extend(own);
    attempts.run(class);
    // An output may determine a state, with all of its noise: transforms that filter it were looked for first.
    for reduced in Problem::with_measured_states(plant) {
        if attempts.is_full() || !reduced.goes_on() {
            break;
        }
        let mut others = Attempts::new(&reduced);
        others.run(class);
        attempts.candidates.extend(others.candidates.into_iter().filter(Candidate::is_full));
    }
    if class != Some(Class::Pebo) {
        let is_quiet = |c: &&Candidate| c.is_full() && !c.multiplies_samples() && c.taken() == 0;
        let least = attempts.candidates.iter().filter(is_quiet).map(Candidate::exceptions).min();
        if least != Some((0, 0)) {
            let known = attempts.candidates.len();
            attempts.of_values();
            // One that does without nothing less is no better: values drive it as samples.
            let found = attempts.candidates.split_off(known);
            let is_better = |c: &Candidate| least.is_none_or(|least| c.exceptions() < least);
            attempts.candidates.extend(found.into_iter().filter(is_better));
        }
    }
    // What the rates hold of the states, outputs that are given by value may show.
    if !attempts.is_full() && !plant.identities.is_empty() && problem.goes_on() {
        let states = problem.x.iter().map(|x| problem.arena.of_symbol(*x)).collect();
        attempts.judge(Form::States, 0, Ok(states));
    }
    if let Some(class) = class {
        attempts.candidates.retain(|candidate| candidate.derivation.class == class);
    }
    attempts.candidates.sort_by_cached_key(Candidate::merit);
    let noisier = noisier(&attempts.candidates);
    if let Some(best) = attempts.candidates.first_mut() {
        best.plant.noisier = noisier;
    }
    attempts
}

/// The transform that would be the best of these if samples had no noise, where another one is.
fn noisier(candidates: &[Candidate]) -> Option<Noisier> {
    let best = candidates.first().filter(|best| best.is_full())?;
    let equal = candidates.iter().filter(|candidate| candidate.standing() == best.standing());
    let plainest = equal.min_by_key(|candidate| candidate.form())?;
    let needs_more = plainest.conditions.len() > best.conditions.len();
    let is_best = plainest.unfiltered() == best.unfiltered() && !needs_more;
    let of_plainest = || {
        let conditions = if needs_more { plainest.conditions.clone() } else { Vec::new() };
        Noisier { phi: plainest.plant.transform(), unfiltered: plainest.unfiltered(), conditions }
    };
    (!is_best).then(of_plainest)
}

/// The transform that the plant's class gives: coils have their fluxes.
fn of_class(problem: &Problem<'_>) -> Option<Candidate> {
    let is_own = problem.plant.origin == TransformOrigin::Class && !problem.plant.phi.is_empty();
    is_own.then(|| Candidate::derive(problem.plant.clone(), problem))
}

/// Attempts at a problem, with what they found.
pub(super) struct Attempts<'a> {
    problem: &'a Problem<'a>,
    pub(super) candidates: Vec<Candidate>,
    pub(super) tried: Vec<Attempt>,
    /// The decision on transforms affine in x with a plain cascade.
    pub(super) affine: Option<Bound>,
    /// The bound that excludes further transforms with a plain cascade.
    pub(super) bound: Option<Bound>,
    /// The bound that excludes further transforms that are affine in x.
    pub(super) generalised: Option<Bound>,
    /// Transforms in which the outputs are not affine: they are proved if nothing better is found.
    later: Vec<Vec<Expr>>,
    /// The functions with rates free of x by which most states are determined, with their rank.
    partial: (usize, Vec<Expr>),
    /// The transforms that were met.
    known: BTreeSet<Vec<Expr>>,
    /// The polynomials in the states that divide their own rates, once they were looked for.
    invariant: Option<Vec<Expr>>,
    /// The class of the forms that are tried.
    class: Class,
}

impl<'a> Attempts<'a> {
    fn new(problem: &'a Problem<'a>) -> Self {
        Self {
            problem,
            candidates: Vec::new(),
            tried: Vec::new(),
            affine: None,
            bound: None,
            generalised: None,
            later: Vec::new(),
            partial: (0, Vec::new()),
            known: BTreeSet::new(),
            invariant: None,
            class: Class::Pebo,
        }
    }

    /// Tries the forms of the class, or of both.
    fn run(&mut self, class: Option<Class>) {
        // Forms of one class leave time for those of the other.
        let of_plain = if class.is_none() { FOR_PLAIN } else { 1 };
        if class != Some(Class::Gpebo) {
            self.problem.arena.budget().share(of_plain, || self.plain());
        }
        let share = if self.is_over() { FOR_LESS_NOISE } else { 1 };
        self.class = Class::Gpebo;
        if class != Some(Class::Pebo) && !self.is_over() {
            self.problem.arena.budget().share(share, || self.generalised());
        }
        self.rest();
        if class != Some(Class::Pebo) && !self.is_full() {
            self.of_products();
        }
    }
}

impl Attempts<'_> {
    /// Tests whether there is nothing better to be expected: a plain cascade that needs the value of an output needs it
    /// in all of its forms, a generalised one may do without; likewise where it has exceptions.
    fn is_over(&self) -> bool {
        let is_plain = self.class == Class::Pebo;
        let is_filtered = |c: &Candidate| c.unfiltered().is_empty() && c.multiplied() == 0 && c.unused() == 0;
        let is_quiet = |c: &Candidate| !c.copies_an_output() && (is_plain || is_filtered(c) && c.is_everywhere());
        !self.problem.goes_on() || self.candidates.iter().any(|c| c.is_full() && c.is_linear() && is_quiet(c))
    }

    /// Tests whether a transform was found.
    fn is_full(&self) -> bool {
        self.candidates.iter().any(Candidate::is_full)
    }

    /// Tests whether transforms affine in x, or series of low order, prove that no smooth transform has a plain cascade
    /// and a left inverse.
    fn is_excluded(&mut self) -> bool {
        self.affine = bounds::largest::affine(self.problem, 0);
        self.bound = bounds::largest::smooth(self.problem, self.affine.as_ref(), 0)
            .filter(Bound::excludes)
            .or_else(|| bounds::largest::smooth_to(self.problem, LOW_ORDER, 0))
            .filter(Bound::excludes);
        self.bound.is_some()
    }

    /// Transforms with a plain cascade.
    fn plain(&mut self) {
        let problem = self.problem;
        let arena = problem.arena;
        let states: Vec<(Expr, usize)> = problem.x.iter().map(|x| (arena.of_symbol(*x), 1)).collect();
        let affine = [&[(arena.one(), 0)], states.as_slice()].concat();
        let mut outputs = functions::of_outputs(problem);
        self.attempt(Form::Affine(0), |_| Ok(Ansatz { of_x: states.clone(), of_y: vec![(arena.one(), 0)], weight: 1 }));
        // With many signals there are too many products; combinations with constant coefficients there are not.
        if states.len() * problem.y.len() > MOST_PRODUCTS && !self.is_over() {
            let of_y = problem.y.iter().map(|y| (arena.of_symbol(*y), 1));
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
                let integrated = arena.budget().share(3, || completion::integration::integrated(problem));
                self.judge(Form::Integrals, 0, integrated);
                if self.is_over() {
                    return;
                }
            }
            // Functions outside the formulas come in where those were not enough.
            if degree == 2 {
                let roots = functions::roots(problem, &outputs);
                outputs.extend(roots);
                // There are transforms, perhaps of functions that turn with an angle that no formula holds.
                if self.affine.as_ref().is_some_and(|affine| affine.transforms().is_some()) {
                    outputs.extend(functions::waves(problem));
                }
            }
            if degree == 2
                && let Ok(connection) = Connection::of(problem, Rate::Free)
            {
                let factors = connection.factors(problem);
                let shifts = connection.shifts(problem, &[&[arena.one()], factors.as_slice(), &outputs].concat());
                for function in factors.into_iter().chain(shifts) {
                    if !outputs.contains(&function) {
                        outputs.push(function);
                    }
                }
            }
            let pool = outputs.clone();
            self.attempt(Form::Affine(degree), |problem| {
                let of_y = functions::products(problem, &pool, degree + usize::from(degree == 1))?;
                Ok(Ansatz { of_x: affine.clone(), of_y, weight: degree + 1 })
            });
        }
        self.nonlinear(&outputs, &[(1, 1), (2, 1), (2, 2), (3, 2)]);
    }

    /// Products of functions of x with functions of y, each to these degrees.
    fn nonlinear(&mut self, of_outputs: &[Expr], degrees: &[(usize, usize)]) {
        let problem = self.problem;
        let arena = problem.arena;
        let mut outputs = of_outputs.to_vec();
        let mut of_states = functions::of_states(problem);
        let bases = [of_states.as_slice(), &outputs, self.invariant()].concat();
        let logarithms = functions::logarithms(problem, &bases);
        for logarithm in logarithms {
            let list = if arena.depends_on(logarithm, &problem.hidden) { &mut of_states } else { &mut outputs };
            if !list.contains(&logarithm) {
                list.push(logarithm);
            }
        }
        for (first, second) in degrees.iter().copied() {
            if self.is_over() {
                return;
            }
            let (of_x, of_y) = (of_states.clone(), outputs.clone());
            self.attempt(Form::Nonlinear(first, second), |problem| {
                let of_x = functions::products(problem, &of_x, first)?;
                let of_y = functions::products(problem, &of_y, second)?;
                Ok(Ansatz { of_x, of_y, weight: first + second })
            });
            // The next degrees hold all of these functions, and more.
            if self.tried.last().is_some_and(|attempt| attempt.obstacle.is_some()) {
                return;
            }
        }
    }

    /// Constant combinations of the states with polynomials in the outputs, where the formulas are polynomials in all
    /// that moves: of a few columns for a state, up to a high degree.
    fn shifted(&mut self) {
        let problem = self.problem;
        let arena = problem.arena;
        let symbols: Vec<Expr> = problem.y.iter().map(|y| arena.of_symbol(*y)).collect();
        for degree in 3..=MOST_SHIFTED {
            let Some(of_y) = functions::monomials(problem, &symbols, degree) else { return };
            let states = problem.x.iter().map(|x| (arena.of_symbol(*x), degree));
            let of_x = [(arena.one(), 0)].into_iter().chain(states).collect();
            self.attempt(Form::Shifted(degree), |_| Ok(Ansatz { of_x, of_y, weight: degree }));
            if self.is_over() {
                return;
            }
        }
    }

    /// Transforms with a generalised cascade.
    fn generalised(&mut self) {
        let problem = self.problem;
        let arena = problem.arena;
        let states: Vec<Expr> = problem.x.iter().map(|x| arena.of_symbol(*x)).collect();
        let rates: Vec<Expr> = problem.x.iter().filter_map(|x| problem.rates.get(x).copied()).collect();
        if matches!(sample::is_affine_in(problem, &rates, &states), Ok(true)) {
            self.judge(Form::States, 0, Ok(states.clone()));
        }
        let rates = problem.output_rates();
        let both = [rates.as_slice(), &states].concat();
        let identities: Vec<Expr> =
            problem.plant.identities.iter().map(|identity| functions::without_roots(problem, identity.expr)).collect();
        let bound = if identities.is_empty() { Vec::new() } else { [identities.as_slice(), &states].concat() };
        let starts = [
            (Start::Identities, &bound),
            (Start::IdentitiesAlone, &identities),
            (Start::Outputs, &rates),
            (Start::Both, &both),
            (Start::States, &states),
        ];
        for (start, formulas) in starts.into_iter().filter(|(_, formulas)| !formulas.is_empty()) {
            if self.is_over() {
                return;
            }
            let closed = closure::closure(problem, formulas).map(Option::unwrap_or_default);
            self.judge(Form::Closure(start), 0, closed);
        }
        if self.is_over() {
            return;
        }
        let closed = closure::of_rows(problem).map(Option::unwrap_or_default);
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
        self.extended();
        if self.is_over() {
            return;
        }
        // The bound of transforms affine in x is looked at where that of all plain cascades is small.
        if self.bound.is_some() {
            self.generalised = affine_rates(problem, 0);
            if self.generalised.as_ref().is_some_and(Bound::excludes) {
                return;
            }
        }
        let mut outputs = functions::of_outputs(problem);
        if let Ok(connection) = Connection::of(problem, Rate::Affine) {
            outputs.extend(connection.factors(problem));
        }
        outputs.extend(functions::waves(problem));
        for degree in 1..=2 {
            if self.is_over() {
                return;
            }
            let ansatz = || {
                let of_x = [(arena.one(), 0)].into_iter().chain(states.iter().map(|x| (*x, 1))).collect();
                Ok(Ansatz { of_x, of_y: functions::products(problem, &outputs, degree)?, weight: degree + 1 })
            };
            self.attempt_with(Form::Frame(degree), Rate::Affine, ansatz());
        }
    }

    /// Functions of the states whose rates are affine in themselves where outputs stand for what they show, with the
    /// values of outputs among them: none of the states is a sample as it is.
    fn of_values(&mut self) {
        let problem = self.problem;
        let values: Vec<Expr> = problem.plant.identities.iter().map(|identity| identity.expr).collect();
        if values.is_empty() {
            return;
        }
        let cleared: Vec<Expr> = values.iter().map(|value| functions::without_roots(problem, *value)).collect();
        let states = problem.x.iter().map(|x| problem.arena.of_symbol(*x));
        let both: Vec<Expr> = cleared.iter().copied().chain(states).collect();
        let rates: Vec<Expr> = cleared.iter().copied().chain(problem.output_rates()).collect();
        let starts = [
            (Start::Values, &values),
            (Start::Values, &cleared),
            (Start::ValuesAndStates, &both),
            (Start::ValuesAndRates, &rates),
        ];
        for (start, formulas) in starts {
            if self.is_over() {
                return;
            }
            let closed = closure::closure_of_values(problem, formulas).map(Option::unwrap_or_default);
            self.judge(Form::Closure(start), 0, closed);
        }
        self.rest();
    }

    /// Quotients of the states by a polynomial that divides its own rate: the rates of these may be affine, as that of
    /// `1/p` is for `p' = a*p + b*p^2`.
    fn of_quotients(&mut self) {
        let problem = self.problem;
        let arena = problem.arena;
        for polynomial in self.invariant().to_vec() {
            let states = problem.x.iter().map(|x| arena.of_symbol(*x));
            // The last is begun with: of functions of one span the reciprocal is the plainest.
            let quotients: Vec<Expr> = states.chain([arena.one()]).map(|above| arena.div(above, polynomial)).collect();
            let closed = closure::closure(problem, &quotients).map(Option::unwrap_or_default);
            self.judge(Form::Closure(Start::Quotients), 0, closed);
            if self.is_over() {
                return;
            }
        }
    }

    /// The polynomials in the states that divide their own rates.
    fn invariant(&mut self) -> &[Expr] {
        let problem = self.problem;
        self.invariant.get_or_insert_with(|| {
            let found = problem.arena.budget().share(FOR_INVARIANT, || closure::darboux::invariant(problem));
            found.unwrap_or_default()
        })
    }

    /// A transform by way of one that there is if the unknown constants are measured.
    fn with_constants(&mut self) {
        let problem = self.problem;
        let unknown = closure::constants::constants(problem);
        if !unknown.is_empty() {
            let by_parts = closure::by_parts::by_parts(problem, &unknown).map(Option::unwrap_or_default);
            let by_parts = by_parts.and_then(|functions| closure::observable::observable(problem, &functions));
            self.judge(Form::Closure(Start::Parts), 0, by_parts);
        }
        if self.is_over() {
            return;
        }
        let Some(measured) = closure::constants::measured(problem) else { return };
        let candidates = || attempted(&Problem::of(&measured), Some(Class::Pebo)).candidates;
        let candidates = problem.arena.budget().share(3, candidates);
        if let Some(candidate) = candidates.iter().find(|candidate| candidate.has_coordinates()) {
            let closed = closure::coordinates::closure(problem, &candidate.plant, &candidate.derivation);
            let closed = closed.map(Option::unwrap_or_default);
            let closed = closed.and_then(|functions| closure::observable::observable(problem, &functions));
            self.judge(Form::Closure(Start::Constants), 0, closed);
        }
    }

    /// Functions with rates free of x that determine part of the states, extended by the others.
    fn extended(&mut self) {
        // Where no plain cascade determines all states, those that determine some were not looked for to the end.
        if !self.tried.iter().any(|attempt| matches!(attempt.form, Form::Nonlinear(..))) {
            let outputs = functions::of_outputs(self.problem);
            self.problem.arena.budget().share(2, || self.nonlinear(&outputs, &[(1, 1), (2, 1)]));
        }
        let functions = std::mem::take(&mut self.partial.1);
        if !functions.is_empty() {
            let extended = closure::extended::extended(self.problem, &functions).map(Option::unwrap_or_default);
            self.judge(Form::Closure(Start::Partial), 0, extended);
        }
    }

    /// Products of the components of a transform with a generalised cascade in which the outputs' rates are not affine.
    fn of_products(&mut self) {
        let is_generalised = |c: &&Candidate| c.derivation.class == Class::Gpebo && c.has_coordinates();
        let Some(candidate) = self.candidates.iter().find(is_generalised) else { return };
        let closed = closure::coordinates::closure(self.problem, &candidate.plant, &candidate.derivation);
        self.judge(Form::Closure(Start::Products), 0, closed.map(Option::unwrap_or_default));
        // An equation with its denominator multiplied is affine in them, and the rate itself is not.
        self.rest();
    }

    fn attempt(&mut self, form: Form, ansatz: impl FnOnce(&Problem<'_>) -> Result<Ansatz, Obstacle>) {
        let ansatz = ansatz(self.problem);
        self.attempt_with(form, Rate::Free, ansatz);
    }

    fn attempt_with(&mut self, form: Form, rate: Rate, ansatz: Result<Ansatz, Obstacle>) {
        let problem = self.problem;
        let columns = ansatz.as_ref().map_or(0, |ansatz| ansatz.width(problem));
        // A large null space does not keep other forms from being tried.
        let of = |ansatz: Ansatz| problem.arena.budget().share(2, || ansatz.solutions(problem, rate));
        let solutions = ansatz.and_then(of);
        let found = if rate == Rate::Free { solutions.as_ref().map_or(Vec::new(), Vec::clone) } else { Vec::new() };
        let rank = self.judge(form, columns, solutions);
        if rank > self.partial.0 {
            self.partial = (rank, found);
        }
    }

    /// Derives the claims of the transforms that were found; the rank of their gradients by x.
    fn judge(&mut self, form: Form, columns: usize, solutions: Result<Vec<Expr>, Obstacle>) -> usize {
        let count = solutions.as_ref().map_or(0, Vec::len);
        // A closure is one transform, which would not close without one of its components.
        let choose = if matches!(form, Form::Closure(_)) { choice::whole } else { choice::choose };
        let choice = solutions.and_then(|solutions| choose(self.problem, &solutions));
        let (choice, obstacle) = match choice {
            Ok(choice) => (choice, None),
            Err(obstacle) => (choice::Choice::default(), Some(obstacle)),
        };
        self.tried.push(Attempt { form, columns, solutions: count, rank: choice.rank, obstacle });
        if choice.rank < self.problem.x.len() {
            return choice.rank;
        }
        for (index, phi) in choice.transforms.into_iter().enumerate() {
            if self.is_over() || !self.known.insert(phi.clone()) {
                continue;
            }
            // The equations of values may be affine in the states where their rates are not.
            let begins_so = match form {
                Form::States => true,
                Form::Closure(start) => {
                    matches!(start, Start::Values | Start::ValuesAndStates | Start::ValuesAndRates)
                }
                _ => false,
            };
            let by_values = begins_so && self.problem.plant.y.iter().any(|output| output.value.is_some());
            if index == 0 && (choice.affine || by_values) {
                self.prove(&phi);
            } else {
                self.later.push(phi);
            }
        }
        choice.rank
    }

    /// Proves deferred transforms: those in which the outputs do not look affine.
    fn rest(&mut self) {
        for phi in std::mem::take(&mut self.later) {
            if self.is_full() || !self.problem.goes_on() {
                return;
            }
            self.prove(&phi);
        }
    }

    /// Derives the claims with a third of the remaining budget: an undecided one then does not end the search.
    fn prove(&mut self, phi: &[Expr]) {
        let problem = self.problem;
        let is_usable = |component: &Expr| problem.exists(*component) && is_of_states_and_outputs(problem, *component);
        if !phi.iter().all(is_usable) {
            return;
        }
        let Some(phi) = phi.iter().map(|component| continuous(problem, *component)).collect::<Option<Vec<_>>>() else {
            return;
        };
        // Components that vanish by the values of outputs filter nothing; the rest may do alone.
        let domain = &problem.domain;
        let is_zero = |component: &Expr| is_zero(problem.arena, *component, domain);
        let rest: Vec<Expr> = match problem.plant.identities.as_slice() {
            [] => phi.clone(),
            _ => phi.iter().copied().filter(|component| !is_zero(component)).collect(),
        };
        if !rest.is_empty() && rest.len() < phi.len() {
            let candidate = problem.arena.budget().share(3, || Candidate::of(problem, &rest));
            let is_full = candidate.is_full();
            self.candidates.push(candidate);
            if is_full {
                return;
            }
        }
        let candidate = problem.arena.budget().share(3, || Candidate::of(problem, &phi));
        self.candidates.push(candidate);
    }
}

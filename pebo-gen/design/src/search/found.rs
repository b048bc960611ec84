//! The result of a search, as values.

use pebo_cas::tower::Obstacle;

use super::bounds::Bound;
use super::candidate::Candidate;
use super::declaration::Declaration;
use super::symmetry::Symmetry;

/// The result of a search.
#[derive(Debug)]
pub struct Search {
    /// The verdict, in a word.
    pub verdict: SearchVerdict,
    /// The transforms that were proved or refuted, in order of merit.
    pub candidates: Vec<Candidate>,
    /// A change of the states that no output shows, where none is accepted.
    pub symmetry: Option<Symmetry>,
    /// True if by the symmetry no observer recovers all states, and no declaration of the domain that was tried ends it.
    pub is_unobservable: bool,
    /// A transform that would be accepted with a declaration, where none is accepted as it is.
    pub declared: Vec<(Candidate, Declaration)>,
    /// The bound on the rank of dphi/dx for transforms with a plain cascade, where the search computed it: for smooth
    /// ones; where that says nothing, as of every plant without inputs, for those affine in x.
    pub bound: Option<Bound>,
    /// The same for those affine in x, where it is small.
    pub affine: Option<Bound>,
    /// The same of transforms affine in x with a generalised cascade, where the first is small.
    pub generalised: Option<Bound>,
    /// The attempts, in order.
    pub tried: Vec<Attempt>,
}

impl Search {
    /// The result of a search that ended with its first attempt.
    pub(super) fn of(found: Candidate) -> Self {
        Self {
            verdict: SearchVerdict::Found,
            candidates: vec![found],
            symmetry: None,
            is_unobservable: false,
            declared: Vec::new(),
            bound: None,
            affine: None,
            generalised: None,
            tried: Vec::new(),
        }
    }
}

/// The verdict of a search.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum SearchVerdict {
    /// There is one whose claims are all proved, and which recovers all states.
    Found,
    /// It is proved that there is none at all, by a symmetry, or none of the classes that the bounds name: no smooth one
    /// with a plain cascade, and if a generalised one would do, none that is affine in x. Other generalised ones were
    /// looked for and not found; where rates are no polynomials in the states, or a state is an unknown constant, which
    /// suggests other functions, the search is undecided instead.
    None,
    /// Neither.
    Undecided,
}

/// A form of transforms that was tried.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Attempt {
    /// The form.
    pub form: Form,
    /// The functions among which a null space was looked for, where there was one.
    pub columns: usize,
    /// The number of solutions, as far as they were worked out.
    pub solutions: usize,
    /// The rank of their gradients by x.
    pub rank: usize,
    /// The reason for giving it up, if it was.
    pub obstacle: Option<Obstacle>,
}

/// A form of transforms.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Form {
    /// Constant combinations of the states, and functions of y to this degree.
    Affine(usize),
    /// Constant combinations of the states, and polynomials in y to this degree.
    Shifted(usize),
    /// `T(y) x + s(y)`, where the equations for T and the gradient of s are solved by integrals.
    Integrals,
    /// Products of functions of x to the first degree with functions of y to the second.
    Nonlinear(usize, usize),
    /// The states themselves, with rates affine in them.
    States,
    /// `T(y) x + s(y)` with rates affine in x, T to this degree.
    Frame(usize),
    /// Functions of x whose rates are affine in themselves.
    Closure(Start),
}

/// The formulas with which a closure begins.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Start {
    /// The outputs' rates.
    Outputs,
    /// The outputs' rates as they are written, each one function.
    Rows,
    /// The outputs' rates and the states.
    Both,
    /// The states.
    States,
    /// The identities and the states; the value of an output is an identity.
    Identities,
    /// The identities.
    IdentitiesAlone,
    /// The identities, where in the rates the values of outputs stand for the functions that they show.
    Values,
    /// The same with the states.
    ValuesAndStates,
    /// The same with the outputs' rates.
    ValuesAndRates,
    /// The states divided by a polynomial that divides its own rate.
    Quotients,
    /// The outputs' rates, where unknown constants are taken for known.
    Constants,
    /// Functions with rates free of x that determine part of the states, and the other states.
    Partial,
    /// The outputs' rates, with the factors of unknown constants integrated by parts.
    Parts,
    /// The outputs' rates, in the components of a transform with a generalised cascade.
    Products,
}

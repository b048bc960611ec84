//! The result of a search, in words.

use std::collections::BTreeSet;

use crate::analysis::{Class, Derivation, Origin, Outcome, Verdict};
use crate::plant::{self, Plant};
use crate::source::{Code, Diagnostic, Span, counted, listed};
use pebo_cas::{Arena, Expr};

use super::bounds::{Bound, BoundClass, Evidence};
use super::candidate::Candidate;
use super::declaration::{Declaration, unseen};
use super::found::{Attempt, Form, Search, SearchVerdict, Start};
use super::frame::{Block, blocks};
use super::symmetry::SymmetryKind;

impl SearchVerdict {
    /// The verdict in a word.
    pub fn word(self) -> &'static str {
        match self {
            Self::Found => "found",
            Self::None => "none",
            Self::Undecided => "undecided",
        }
    }
}

impl Form {
    /// The form in words.
    fn words(self) -> String {
        match self {
            Self::Affine(0) => "combinations of the states with constant coefficients".to_owned(),
            Self::Affine(degree) => format!("T(y) x + s(y) with functions of y to degree {degree}"),
            Self::Shifted(degree) => {
                format!("combinations of the states with constant coefficients and polynomials in y to degree {degree}")
            }
            Self::Integrals => "T(y) x + s(y) by integrals of the equations for T and s".to_owned(),
            Self::Nonlinear(x, y) => format!("functions of x to degree {x} times functions of y to degree {y}"),
            Self::States => "the states themselves, with rates affine in x".to_owned(),
            Self::Frame(degree) => {
                format!("T(y) x + s(y) with rates affine in x and functions of y to degree {degree}")
            }
            Self::Closure(start) => {
                format!("functions of x whose rates are affine in themselves, beginning with {}", start.words())
            }
        }
    }
}

impl Start {
    fn words(self) -> &'static str {
        match self {
            Self::Outputs => "the functions in the outputs' rates",
            Self::Rows => "the outputs' rates",
            Self::Both => "the functions in the outputs' rates and the states",
            Self::Identities => "the functions in the identities and the states",
            Self::IdentitiesAlone => "the functions in the identities",
            Self::Values => "the functions in the identities, which outputs show in their rates",
            Self::ValuesAndStates => {
                "the functions in the identities and the states, which outputs show in their rates"
            }
            Self::ValuesAndRates => {
                "the functions in the identities and in the outputs' rates, which outputs show in their rates"
            }
            Self::States => "the states",
            Self::Quotients => "the states divided by a polynomial that divides its own rate",
            Self::Constants => "the outputs' rates, in a cascade in which the unknown constants are known",
            Self::Partial => "a transform of part of the states, and the other states",
            Self::Parts => "the outputs' rates, by parts where unknown constants multiply them",
            Self::Products => "the outputs' rates, as products of components with a generalised cascade",
        }
    }
}

impl BoundClass {
    /// The class in a word.
    pub fn word(self) -> &'static str {
        match self {
            Self::Smooth => "smooth",
            Self::Affine => "affine",
            Self::AffineRate => "affine with an affine rate",
        }
    }

    /// The class in words.
    fn words(self) -> &'static str {
        match self {
            Self::Smooth => "smooth phi with a plain cascade",
            Self::Affine => "phi affine in x with a plain cascade",
            Self::AffineRate => "phi affine in x with a plain or generalised cascade",
        }
    }
}

impl Bound {
    /// The bound on the rank, in a line.
    pub fn sentence(&self, arena: &Arena) -> String {
        let values: Vec<String> =
            self.point.iter().map(|(s, e)| format!("{} = {}", arena.name(*s), arena.print(*e))).collect();
        let location = if values.is_empty() { String::new() } else { format!(" around {}", values.join(", ")) };
        let (rank, states, class) = (self.rank, self.states, self.class.words());
        if rank == states {
            return format!("of a {class} the rank of dphi/dx may be {rank} of {states}{location}");
        }
        let status = if self.proved { "proved" } else { "likely, by arithmetic modulo a prime" };
        let number = match self.transforms() {
            Some(1) => ", and but for functions of y there is just one".to_owned(),
            Some(count) if count > 1 => format!(", and but for functions of y there are just {count}"),
            _ => String::new(),
        };
        format!("no {class} has a rank of dphi/dx above {rank} of {states}{location}{number}: {status}")
    }

    /// The relations that every gradient satisfies at the point, with the equations that prove each.
    pub fn certificate(&self, arena: &Arena) -> Vec<String> {
        let term = |(index, c): (usize, &Expr)| {
            let slope = format!("dphi/d{}", arena.name(self.x[index]));
            if *c == arena.one() { slope } else { format!("({})*{slope}", arena.print(*c)) }
        };
        let by = match self.evidence {
            Evidence::Series { equations, order } => {
                format!("there, a combination of at most {equations} equations to order {order}")
            }
            Evidence::Completion { .. } if self.class == BoundClass::Smooth => {
                "for all x and y, by completing the equations for the gradient of phi".to_owned()
            }
            Evidence::Completion { .. } => {
                "for every y, by completing the equations for T(y) and s(y) of phi = T(y) x + s(y)".to_owned()
            }
        };
        let relation = |relation: &Vec<Expr>| {
            let terms = relation.iter().enumerate().filter(|(_, c)| !arena.is_zero(**c)).map(term);
            format!("{} = 0 {by}", terms.collect::<Vec<_>>().join(" + "))
        };
        self.relations.iter().map(relation).collect()
    }
}

impl Attempt {
    /// The attempt in a line.
    pub fn sentence(&self) -> String {
        let form = self.form.words();
        let found = match (&self.obstacle, self.columns, self.solutions) {
            (Some(obstacle), ..) => return format!("{form}: given up, {obstacle}"),
            (None, 0, 0) => "none".to_owned(),
            (None, 0, count) => format!("{}, of which {} independent", counted(count, "function"), self.rank),
            (None, columns, count) => {
                format!("{} among {}, rank {}", counted(count, "solution"), counted(columns, "function"), self.rank)
            }
        };
        format!("{form}: {found}")
    }
}

impl Candidate {
    /// The components, as formulas of a model file.
    pub fn formulas(&self) -> Vec<String> {
        self.plant.transform().iter().map(|e| self.plant.arena.print(*e)).collect()
    }

    /// The keys of a model file with the transform; none where a class has no words for it.
    fn keys(&self) -> Option<String> {
        let Some(class) = &self.plant.class else { return Some(format!("`phi: [{}]`", self.formulas().join(", "))) };
        let row = |row: &Vec<String>| format!("[{}]", row.join(", "));
        let block = |(key, rows): Block| format!("`{key}: [{}]`", rows.iter().map(row).collect::<Vec<_>>().join(", "));
        Some(blocks(&self.plant, class.name())?.into_iter().map(block).collect::<Vec<_>>().join(" and "))
    }

    /// The cascade, if there is one, and the verdict on it, in a line.
    pub fn sentence(&self) -> String {
        let class = match (self.derivation.cascade.verdict, self.derivation.class) {
            (Verdict::Skipped, _) => "",
            (_, Class::Pebo) => ", plain cascade",
            (_, Class::Gpebo) => ", generalised cascade",
        };
        let formulas = self.formulas();
        let phi = formulas.join(", ");
        match self.derivation.outcome {
            Outcome::Accepted => format!("phi = [{phi}]{class}, is accepted"),
            outcome => {
                let why = self.derivation.diagnostics.first().map_or("", |d| &d.message);
                format!("phi = [{phi}]{class}, is {}: {why}", outcome.word())
            }
        }
    }
}

impl Search {
    /// The bounds on ranks, each once.
    pub fn bounds(&self) -> impl Iterator<Item = &Bound> {
        let affine = self.affine.iter().filter(|affine| {
            self.bound.as_ref().is_none_or(|bound| (bound.rank, bound.class) != (affine.rank, affine.class))
        });
        self.bound.iter().chain(affine).chain(&self.generalised)
    }

    /// For a mechanical plant, the sentence that M has too few Killing fields for a frame of them.
    fn killing_fields(&self, plant: &Plant) -> Option<String> {
        let Some(plant::Class::Mechanical(_)) = &plant.class else { return None };
        let affine = self.affine.as_ref().filter(|affine| affine.excludes())?;
        let fields = match (affine.transforms(), affine.rank) {
            (Some(0), _) | (None, 0) => "M has no Killing field".to_owned(),
            (Some(count), _) => format!("M has just {}", counted(count, "Killing field")),
            (None, rank) => format!("the Killing fields of M span at most {}", counted(rank, "direction")),
        };
        let needed = plant.x.len();
        Some(format!("{fields}, and T needs {needed}: measure more than the positions, such as a velocity"))
    }

    /// The candidates in order of merit; of those with the same components in another order, the first.
    fn nearest(&self) -> impl Iterator<Item = &Candidate> {
        let mut reported = BTreeSet::new();
        self.candidates.iter().filter(move |candidate| {
            let mut components = candidate.formulas();
            components.sort_unstable();
            reported.insert((candidate.derivation.class.name(), components))
        })
    }

    /// The open possibilities after a search that found none.
    pub fn open(&self) -> Option<&'static str> {
        let excluded = !self.is_unobservable && self.generalised.as_ref().is_some_and(Bound::excludes);
        (self.verdict == SearchVerdict::None && excluded).then_some(
            "a phi that is not affine in x, with a generalised cascade; the search looked for such and found none",
        )
    }

    /// The refusal of a model without a transform, after a search that found none; `span` is where it declares its
    /// states.
    pub fn refusal(&self, plant: &Plant, span: Span) -> Diagnostic {
        // That no observer recovers the states needs no search.
        if plant.arena.budget().is_exhausted() && !self.is_unobservable {
            let limited = Diagnostic::limit_reached("the search for phi", span);
            let settled = self.bounds().filter(|bound| bound.excludes()).map(|bound| bound.sentence(&plant.arena));
            let symmetry = self.symmetry.iter().map(|symmetry| symmetry.sentence(&plant.arena));
            let settled = symmetry.chain(self.declared.iter().map(declared)).chain(settled);
            return settled.fold(limited, Diagnostic::note);
        }
        let states: Vec<String> = plant.x.iter().map(|state| plant.arena.name(state.symbol)).collect();
        let states = listed(states.iter().map(String::as_str));
        let message = format!("no transform from which {states} can be recovered was found");
        let mut diagnostic = Diagnostic::error(Code::TransformNotFound, span, message);
        let unseen: Vec<String> =
            unseen(plant).into_iter().map(|state| format!("`{}`", plant.arena.name(state))).collect();
        if !unseen.is_empty() {
            let them = if unseen.len() == 1 { "it" } else { "them" };
            diagnostic =
                diagnostic.note(format!("no output depends on {}: nothing recovers {them}", unseen.join(", ")));
        }
        if let Some(symmetry) = &self.symmetry {
            diagnostic = diagnostic.note(symmetry.sentence(&plant.arena));
        }
        for candidate in self.nearest().take(2) {
            diagnostic = diagnostic.note(candidate.sentence());
        }
        diagnostic = self.declared.iter().map(declared).fold(diagnostic, Diagnostic::note);
        // A statement on all smooth ones holds for those affine in x too.
        let smooth = self.bounds().find(|bound| bound.excludes() && bound.class == BoundClass::Smooth);
        let implied =
            |bound: &Bound| bound.class == BoundClass::Affine && smooth.is_some_and(|smooth| smooth.rank <= bound.rank);
        for bound in self.bounds().filter(|bound| bound.excludes() && !implied(bound)) {
            diagnostic = diagnostic.note(bound.sentence(&plant.arena));
        }
        diagnostic = diagnostic.note("`pebo-gen solve` shows what was tried");
        diagnostic.help(self.help().unwrap_or_else(|| self.general_help(&plant.arena)))
    }

    /// The advice where no declaration was found that helps.
    fn general_help(&self, arena: &Arena) -> String {
        if let Some((larger, smaller)) = self.symmetry.as_ref().and_then(|symmetry| symmetry.exchanged(arena)) {
            return format!(
                "assume which is the larger if it is known, as `assume: [{} > {}]`, or measure another signal",
                arena.name(larger),
                arena.name(smaller)
            );
        }
        let signed = self.symmetry.as_ref().filter(|symmetry| symmetry.kind == SymmetryKind::Signs);
        match signed.and_then(|symmetry| symmetry.states.first()) {
            Some((state, _)) => format!(
                "assume the sign of one of them if it is known, as `assume: [{} > 0]`, or measure another signal",
                arena.name(*state)
            ),
            None => {
                "measure another signal, assume the signs of what is positive, or write a phi of your own".to_owned()
            }
        }
    }

    /// The refusal of the best transform, with the declarations with which one is accepted; a direction of its unknowns
    /// in terms of the states, where a symmetry is known.
    pub fn declare(&self, arena: &Arena, refusal: Diagnostic) -> Diagnostic {
        let refusal = match &self.symmetry {
            Some(symmetry) if refusal.code == Code::NeverIdentifiable => refusal.label(symmetry.sentence(arena)),
            _ => refusal,
        };
        let noted = self.declared.iter().map(declared).fold(refusal, Diagnostic::note);
        match self.help() {
            Some(help) => noted.help(help),
            None => noted,
        }
    }

    /// The advice to write one of the declarations.
    fn help(&self) -> Option<String> {
        let help = |(candidate, declaration): &(Candidate, Declaration)| declaration.help(&candidate.plant);
        let all: Vec<String> = self.declared.iter().map(help).collect();
        let is_partial = matches!(self.declared.first(), Some((_, Declaration::Unmeasured(_))));
        let first = is_partial.then(|| "measure another signal".to_owned());
        (!all.is_empty()).then(|| first.into_iter().chain(all).collect::<Vec<_>>().join("; or "))
    }

    /// The refusal of a given transform, with the search's result in its place.
    pub fn advise(&self, plant: &Plant, refusal: Diagnostic) -> Diagnostic {
        if let Some(best) = self.candidates.first().filter(|_| self.verdict == SearchVerdict::Found) {
            let class = best.derivation.class.name();
            if let Some(keys) = best.keys() {
                return refusal.help(format!("use {keys}, which is accepted ({class})"));
            }
            let refusal = self.killing_fields(plant).into_iter().fold(refusal, Diagnostic::note);
            return refusal.note(best.sentence()).help("write the plant under `f_x` and `f_y`, with this phi");
        }
        let refusal = self.declared.iter().map(declared).fold(refusal, Diagnostic::note);
        // A direction that no output shows is the refusal itself.
        let symmetry = self.symmetry.as_ref().filter(|_| refusal.code != Code::NeverIdentifiable);
        if let Some(symmetry) = symmetry {
            let help = self.help().unwrap_or_else(|| "measure another signal".to_owned());
            return refusal.note(symmetry.sentence(&plant.arena)).help(help);
        }
        match self.bounds().find(|bound| bound.excludes()) {
            Some(bound) => {
                let noted = refusal.note(bound.sentence(&plant.arena));
                // To choose a phi is no advice where there is none.
                let help = match (self.killing_fields(plant), plant.cascade_class) {
                    (Some(help), _) => help,
                    (None, _) if bound.class != BoundClass::Smooth => return noted,
                    (None, Some(Class::Pebo)) => "leave out `class: pebo`, or measure another signal".to_owned(),
                    (None, _) => "measure another signal".to_owned(),
                };
                noted.help(help)
            }
            None => refusal.note("a search found no phi that is accepted: `pebo-gen solve` shows what was tried"),
        }
    }
}

/// The sentence that a transform is accepted with a declaration.
pub fn declared((candidate, declaration): &(Candidate, Declaration)) -> String {
    let lines = declaration.lines(&candidate.plant);
    format!("with {lines}, phi = [{}] is accepted", candidate.formulas().join(", "))
}

/// Tests whether another transform settles a refusal.
pub fn settles(code: Code, derivation: &Derivation) -> bool {
    match code {
        Code::CascadeRefuted
        | Code::LeftInverseUnderivable
        | Code::RegressionNonlinear
        | Code::RegressionUndecided
        | Code::NeverIdentifiable => true,
        // The left inverse may be the author's own, and wrong.
        Code::LeftInverseRefuted => {
            derivation.left_inverse.result.as_ref().is_none_or(|inverse| inverse.origin != Origin::Given)
        }
        _ => false,
    }
}

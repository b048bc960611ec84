//! The result of the analysis of a plant: each claim with its verdict.

use std::borrow::Cow;

pub use crate::plant::CascadeClass as Class;
use crate::plant::{Plant, RelationForm};
use crate::source::Diagnostic;
use pebo_cas::domain::cells::Side;
use pebo_cas::forms::tidy::code_conditions;
use pebo_cas::{Arena, Domain, Expr, Relation, Symbol};

use super::advice::remark::Remarks;

/// The verdict on one claim.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Verdict {
    /// Exact algebra showed it.
    Proved,
    /// A point exists where it fails.
    Refuted,
    /// Neither proved nor refuted.
    Undecided,
    /// Not looked at, because a claim it builds on is not proved.
    Skipped,
}

/// The verdict on the model.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Outcome {
    /// Every claim is proved.
    Accepted,
    /// A claim is refuted.
    Rejected,
    /// No claim is refuted, but one is undecided.
    Undecided,
}

/// A claim: its verdict and its result, where there is one.
#[derive(Clone, Debug)]
pub struct Claim<T> {
    /// The verdict.
    pub verdict: Verdict,
    /// The derived result.
    pub result: Option<T>,
}

/// Claim 1: the transform moves by known signals.
#[derive(Clone, Debug, Default)]
pub struct Cascade {
    /// The known term of z', free of x, a component each.
    pub h: Vec<Expr>,
    /// The matrix Lambda(y, u) by rows, for the generalised cascade.
    pub lambda: Option<Vec<Vec<Expr>>>,
    /// The terms of z' that depend on x, a component each; empty where the claim is proved.
    pub residual: Vec<Expr>,
    /// A point at which a residual is bounded away from zero.
    pub witness: Option<Witness>,
    /// The behaviour of the fundamental matrix of a generalised cascade: not part of the claim.
    pub fundamental: Option<Fundamental>,
    /// Beside a generalised cascade, a transform with a plain one: phi with multiples of the outputs added.
    pub mend: Option<Vec<Expr>>,
    /// Beside a generalised cascade, the right side of the plain one of the same transform. It is not taken, as samples of
    /// outputs that are given by value drive it.
    pub plain: Option<Vec<Expr>>,
}

impl Cascade {
    /// The outputs given by value whose samples drive the plain cascade that is not taken, and not this one.
    pub fn unfiltered(&self, plant: &Plant) -> Vec<Symbol> {
        let arena = &plant.arena;
        let driven = arena.symbols_of(&self.plain.iter().flatten().copied().collect::<Vec<_>>());
        let taken = self.lambda.iter().flatten().flatten().chain(&self.h);
        let taken = arena.symbols_of(&taken.copied().collect::<Vec<_>>());
        let values = plant.y.iter().filter(|output| output.value.is_some()).map(|output| output.symbol);
        values.filter(|symbol| driven.contains(symbol) && !taken.contains(symbol)).collect()
    }
}

/// The behaviour of `Psi' = Lambda(y, u) Psi`, `Psi(0) = I`, along every trajectory.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Fundamental {
    /// Bounded.
    Bounded {
        /// True if its determinant dies out at a constant rate: directions of theta are then forgotten.
        fades: bool,
    },
    /// It grows without bound.
    Grows,
    /// Undecided.
    Undecided,
}

/// A point at which an expression provably is not zero.
#[derive(Clone, Debug)]
pub struct Witness {
    /// The expression.
    pub expr: Expr,
    /// The values of its symbols: constants, rational ones as a rule.
    pub point: Vec<(Symbol, Expr)>,
    /// Bounds of its value there, outward rounded; both of one sign.
    pub bounds: (f64, f64),
    /// The points of the domain that were compared, where it took more than one.
    pub compared: Option<Comparison>,
}

/// Points of the domain with the same y, u and parameters, and the values that an expression has there.
#[derive(Clone, Debug)]
pub struct Comparison {
    /// The expression as printed.
    pub expr: Expr,
    /// The expression whose values were compared: it may read more than the printed one.
    pub read: Expr,
    /// The unmeasured states and signals at each point.
    pub points: Vec<Vec<(Symbol, Expr)>>,
    /// The values that all points share.
    pub known: Vec<(Symbol, Expr)>,
    /// Bounds of the expression's value at each point, outward rounded.
    pub values: Vec<(f64, f64)>,
}

/// Claim 2: the states are recovered from z and y.
#[derive(Clone, Debug)]
pub struct LeftInverse {
    /// The states with their formulas in z1.. and y.
    pub x: Vec<(Symbol, Expr)>,
    /// Periods of the states that are recovered as angles.
    pub modulo: Vec<(Symbol, Expr)>,
    /// The origin: the author or the generator.
    pub origin: Origin,
    /// A point at which the author's formula fails.
    pub witness: Option<Witness>,
}

/// The origin of a left inverse.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Origin {
    /// The model file gives it.
    Given,
    /// It was solved for.
    Derived,
}

/// The left side of the regression.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum RegressionKind {
    /// y' = `Phi_0` + `Phi_1` eta.
    Dynamic,
    /// `Phi_0` = `Phi_1` eta.
    Static,
    /// `d/dt(P_0 + P_1 eta)` = `Phi_0` + `Phi_1` eta.
    Implicit,
}

/// Claim 3: the unknowns enter linearly.
#[derive(Clone, Debug)]
pub struct Regression {
    /// The sense in which it holds where it is not linear in functions of theta: `Phi_0` is then the equation where the
    /// extension is z, and `Phi_1` its slope by theta there.
    pub at_estimate: Option<AtEstimate>,
    /// The left side.
    pub kind: RegressionKind,
    /// For each row, the positions in the plant's outputs of those whose equation it is: of a relation, all in it.
    pub sources: Vec<Vec<usize>>,
    /// `Phi_0` by rows, in chi1.. (xi1.. and Psi11.. for the generalised cascade), y and u.
    pub phi_0: Vec<Expr>,
    /// `Phi_1` by rows, an entry for each eta.
    pub phi_1: Vec<Vec<Expr>>,
    /// `P_0` by rows, for an implicit regression.
    pub primitive_0: Vec<Expr>,
    /// `P_1` by rows, for an implicit regression.
    pub primitive_1: Vec<Vec<Expr>>,
    /// The unknowns as functions of theta1..; theta itself where the parameterisation is linear.
    pub eta: Vec<Expr>,
    /// theta as functions of eta1.., an entry for each theta.
    pub theta: Vec<Expr>,
    /// The symbols eta1..
    pub eta_symbols: Vec<Symbol>,
    /// States that are identifiable only up to multiples of a constant, with that constant, but no declared angles.
    pub steps: Vec<(Symbol, Expr)>,
    /// The other form of the relation that the regression is made of, if it has one.
    pub alternative: Option<Alternative>,
    /// The outputs that have an equation of their own, which the regression leaves out.
    pub unused: Vec<UnusedOutput>,
}

/// The sense in which a regression with the slopes at the estimate holds.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum AtEstimate {
    /// To first order, in a neighbourhood.
    Local,
    /// Each equation is a function of one component of z, and strictly monotone in it on the domain.
    Monotone,
}

/// An output whose equation is left out of the regression.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct UnusedOutput {
    /// Its position in the plant's outputs.
    pub output: usize,
    /// The reason.
    pub reason: UnusedReason,
}

/// A reason to leave an output's equation out.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum UnusedReason {
    /// It was not found to be linear in the unknowns.
    Nonlinear,
    /// It holds an unmeasured signal.
    Hidden,
    /// It was not found to be monotone in the unknowns.
    NotMonotone,
    /// With it, the claims were not proved.
    Unproved,
}

/// An alternative form of the regression that a model may choose.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Alternative {
    /// The form.
    pub form: RelationForm,
    /// The number of its unknowns.
    pub unknowns: usize,
}

impl Regression {
    /// Tests whether the unknowns are theta itself.
    pub fn is_linear(&self, plant: &Plant) -> bool {
        self.eta.len() == plant.theta.len()
            && self.eta.iter().zip(&plant.theta).all(|(eta, theta)| plant.arena.as_symbol(*eta) == Some(*theta))
    }

    /// True if its slopes are those at the estimate, to which the extension has to be moved at each sample.
    pub fn is_at_estimate(&self) -> bool {
        self.at_estimate.is_some()
    }

    /// A regression at the estimate where the extension has these values, as z itself or phi on a trajectory; any other as
    /// it is.
    #[must_use]
    pub fn with_extension(&self, plant: &Plant, values: &[Expr]) -> Cow<'_, Self> {
        if !self.is_at_estimate() {
            return Cow::Borrowed(self);
        }
        let values = plant.chi.iter().chain(&plant.xi).copied().zip(values.iter().copied().cycle()).collect();
        let mut there = self.clone();
        for formula in there.phi_0.iter_mut().chain(there.phi_1.iter_mut().flatten()) {
            *formula = plant.arena.substitute(*formula, &values);
        }
        Cow::Owned(there)
    }

    /// The derivatives of the unknowns, a row for each with an entry for each component of theta; none unless there are
    /// more unknowns than these.
    pub fn slopes(&self, plant: &Plant) -> Option<Vec<Vec<Expr>>> {
        let row = |eta: &Expr| plant.theta.iter().map(|theta| plant.arena.derivative(*eta, *theta)).collect();
        (self.eta.len() > plant.theta.len()).then(|| self.eta.iter().map(row).collect())
    }

    /// Positions in the plant's outputs of the rows, for a dynamic regression.
    pub fn rows(&self) -> Vec<usize> {
        if self.kind == RegressionKind::Dynamic { self.sources.concat() } else { Vec::new() }
    }

    /// Positions in the plant's outputs of those whose rates are rows, where nothing else is under a derivative; these
    /// are the first rows. None for a static regression.
    pub fn outputs_with_rates(&self, plant: &Plant) -> Option<Vec<usize>> {
        let arena = &plant.arena;
        let first = self.primitive_0.len() - self.instants(arena);
        let is_known = |factors: &Vec<Expr>| factors.iter().all(|factor| arena.is_zero(*factor));
        let place =
            |primitive: &Expr| plant.y.iter().position(|output| arena.as_symbol(*primitive) == Some(output.symbol));
        match self.kind {
            RegressionKind::Dynamic => Some(self.rows()),
            RegressionKind::Implicit if self.primitive_1.iter().all(is_known) => {
                self.primitive_0[..first].iter().map(place).collect()
            }
            RegressionKind::Static | RegressionKind::Implicit => None,
        }
    }

    /// The same without the unknowns at these positions, which are zero. They are named by the coordinates z where they are
    /// theta.
    #[must_use]
    pub fn without(&self, plant: &Plant, positions: &[usize]) -> Self {
        let mut rest = self.clone();
        if self.is_linear(plant) {
            rest.eta_symbols.clone_from(&plant.z);
        }
        retain(&mut rest.eta, positions);
        retain(&mut rest.eta_symbols, positions);
        for row in rest.phi_1.iter_mut().chain(&mut rest.primitive_1) {
            retain(row, positions);
        }
        rest
    }

    /// Indices of the equations without an unknown: of known rates.
    pub fn without_unknowns(&self, arena: &Arena) -> Vec<usize> {
        if self.kind == RegressionKind::Static {
            return Vec::new();
        }
        let nothing = |row: Option<&Vec<Expr>>| row.into_iter().flatten().all(|factor| arena.is_zero(*factor));
        let is_idle = |row: &usize| nothing(self.phi_1.get(*row)) && nothing(self.primitive_1.get(*row));
        (0..self.phi_0.len()).filter(is_idle).collect()
    }

    /// The number of equations that hold at every instant beside those of rates: the last ones, with nothing under the
    /// derivative.
    pub fn instants(&self, arena: &Arena) -> usize {
        let nothing = |expr: &Expr| arena.is_zero(*expr);
        let sides = self.primitive_0.iter().zip(&self.primitive_1).rev();
        sides.take_while(|(known, factor)| nothing(known) && factor.iter().all(nothing)).count()
    }

    /// The equations that an observer runs: all of them where each `serves`, else those with an unknown. An equation
    /// without one serves a gate, which checks the sample of its output, and the output form, in which the output
    /// itself is estimated.
    #[must_use]
    pub fn computed(&self, arena: &Arena, serves: bool) -> Self {
        let idle = if serves { Vec::new() } else { self.without_unknowns(arena) };
        let mut computed = self.clone();
        if idle.is_empty() {
            return computed;
        }
        retain(&mut computed.sources, &idle);
        retain(&mut computed.phi_0, &idle);
        retain(&mut computed.phi_1, &idle);
        retain(&mut computed.primitive_0, &idle);
        retain(&mut computed.primitive_1, &idle);
        computed
    }
}

/// Takes the entries at these positions out of a list.
fn retain<T>(rows: &mut Vec<T>, left_out: &[usize]) {
    let mut row = 0..;
    rows.retain(|_| row.next().is_none_or(|row| !left_out.contains(&row)));
}

/// Claim 4: the unknowns are identifiable.
#[derive(Clone, Debug)]
pub struct Identifiability {
    /// The kind of excitation.
    pub kind: Excitation,
    /// The positions of unknowns that are zero because the start of the plant is known; what else is said here is of the
    /// regression without them.
    pub by_start: Vec<usize>,
    /// The conditions under which the regressor loses rank, for a reader.
    pub singular_where: Vec<String>,
    /// True if the regressor provably has full rank everywhere else.
    pub everywhere_else: bool,
    /// Combinations of parameters without a known sign whose zeros lower the rank.
    pub constants: Vec<Expr>,
    /// Combinations of parameters that are positive at the values of the file: with others of another sign the answer is
    /// another one.
    pub positive: Vec<Expr>,
    /// A direction of eta that no trajectory makes observable, where there is one.
    pub direction: Option<Vec<Expr>>,
    /// The motion that the unknowns need, where one instant does not identify them.
    pub trajectories: Option<Trajectories>,
    /// `Phi_1' Phi_1`, where `Phi_1` has full column rank at almost every point.
    pub gram: Option<Gram>,
}

impl Identifiability {
    /// The answer of this kind, without conditions.
    pub fn new(kind: Excitation) -> Self {
        Self {
            kind,
            by_start: Vec::new(),
            singular_where: Vec::new(),
            everywhere_else: false,
            constants: Vec::new(),
            positive: Vec::new(),
            direction: None,
            trajectories: None,
            gram: None,
        }
    }
}

/// Courses of the inputs.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum InputCourses {
    /// Constant inputs: of others, some may keep the plant where it hides unknowns.
    Constant,
    /// All: none of them does, but on listed trajectories.
    All,
}

/// The motion that makes unknowns identifiable which one instant does not identify.
#[derive(Clone, Debug)]
pub struct Trajectories {
    /// True if no input has to move: with all of them constant the rank over time is full on almost every trajectory.
    /// None if undecided.
    pub by_itself: Option<bool>,
    /// The courses of the inputs with which it is so.
    pub courses: InputCourses,
    /// True if nothing has to move: there are equilibria outside the listed trajectories, and the rank is full at almost
    /// all of these.
    pub at_rest: bool,
    /// Trajectories on which the rank is not full.
    pub blind: Vec<BlindTrajectory>,
    /// True if there are no others with constant inputs.
    pub everywhere: bool,
    /// True if all combinations of the parameters are known at which the rank is full on no trajectory.
    pub parameters: bool,
}

/// Trajectories on which the regression provably does not identify all unknowns, or on which that is undecided.
#[derive(Clone, Debug)]
pub struct BlindTrajectory {
    /// The condition that defines the trajectories.
    pub condition: TrajectoryCondition,
    /// The identifiable combinations of the unknowns: of z1.. where they are theta, else of eta1..
    pub identifiable: Vec<Expr>,
    /// Unobservable directions: none where it is undecided.
    pub hidden: Vec<Vec<Expr>>,
    /// What these combinations determine although they are fewer than the unknowns.
    pub determined: Determined,
}

/// What combinations of unknowns that depend on one another determine near almost every value.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum Determined {
    /// They are not known to determine anything else.
    #[default]
    Nothing,
    /// Theta: the unknowns are functions of it.
    Theta,
    /// These states: the unknowns are more components of phi than there are states.
    States(Vec<Symbol>),
}

impl BlindTrajectory {
    /// Trajectories on which the rank is undecided.
    pub(in crate::analysis) fn undecided(condition: TrajectoryCondition) -> Self {
        Self { condition, identifiable: Vec::new(), hidden: Vec::new(), determined: Determined::Nothing }
    }
}

/// A condition that holds at all times.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct TrajectoryCondition {
    /// These keep their signs: a cell of the domain, at whose border the regressor is non-smooth.
    pub sides: Vec<(Expr, Side)>,
    /// What does not move.
    pub still: Still,
    /// These are zero.
    pub zeros: Vec<Expr>,
}

/// What does not move on a trajectory.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum Still {
    /// Nothing has to.
    #[default]
    Nothing,
    /// These inputs.
    Inputs(Vec<Symbol>),
    /// All signals: the plant is at an equilibrium.
    Plant,
}

/// `Phi_1' Phi_1`: the strength of the excitation at a point.
#[derive(Clone, Debug)]
pub struct Gram {
    /// By rows.
    pub matrix: Vec<Vec<Expr>>,
    /// Its determinant.
    pub determinant: Expr,
    /// The proof that the determinant is positive throughout the assumed domain, if there is one.
    pub positive: Option<Positive>,
}

/// A proof that a determinant is positive.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Positive {
    /// Its factors have signs by the assumptions.
    Assumed,
    /// Enclosures on the cells of the closed box that the assumptions bound, at the values of the parameters.
    Divided,
}

/// The excitation that identifies the unknowns.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Excitation {
    /// `Phi_1` has full column rank at almost every point.
    Instant,
    /// It has over time, along almost every trajectory.
    Excitation,
    /// It never has.
    Never,
}

impl Derivation {
    /// The sense in which the regression holds, where its slopes are those at the estimate.
    #[must_use]
    pub fn at_estimate(&self) -> Option<AtEstimate> {
        self.regression.result.as_ref()?.at_estimate
    }

    /// The unknowns that the known start fixes and no output shows.
    pub fn fixed_by_start(&self, plant: &Plant) -> Vec<Symbol> {
        let (Some(regression), Some(identifiability)) = (&self.regression.result, &self.identifiability.result) else {
            return Vec::new();
        };
        let symbols = if regression.is_linear(plant) { &plant.theta } else { &regression.eta_symbols };
        identifiability.by_start.iter().map(|position| symbols[*position]).collect()
    }

    /// The domain conditions of the way from estimates back to x, and of a regression at these, beside the
    /// assumptions on y: an estimate of z (or, where the regression has functions of theta, of these) may lie where the
    /// true one cannot.
    pub fn conditions_on_estimates(&self, plant: &Plant) -> Vec<(Expr, Relation)> {
        let arena = &plant.arena;
        let (mut formulas, mut estimates) = (Vec::new(), plant.z.clone());
        formulas.extend(self.left_inverse.result.iter().flat_map(|inverse| &inverse.x).map(|(_, formula)| *formula));
        if let Some(regression) = &self.regression.result {
            formulas.extend(&regression.theta);
            if regression.is_at_estimate() {
                let z: Vec<Expr> = plant.z.iter().map(|z| arena.of_symbol(*z)).collect();
                let near = regression.with_extension(plant, &z);
                formulas.extend(near.phi_0.iter().chain(near.phi_1.iter().flatten()));
            }
            estimates.extend(&regression.eta_symbols);
        }
        let domain = self.domain(plant);
        let mut conditions = code_conditions(arena, &formulas);
        conditions.retain(|(part, relation)| {
            let free = arena.symbols_of(&[*part]).iter().any(|symbol| estimates.contains(symbol));
            free && !domain.implies(arena, *part, *relation)
        });
        let positive: Vec<Expr> =
            conditions.iter().filter(|(_, r)| *r == Relation::Positive).map(|(p, _)| *p).collect();
        conditions.retain(|(part, relation)| *relation == Relation::Positive || !positive.contains(part));
        conditions
    }

    /// The domain of the proofs: the plant's domain, without the points that the conditions exclude.
    pub fn domain(&self, plant: &Plant) -> Domain {
        let mut domain = plant.domain();
        self.conditions.iter().for_each(|(expr, relation)| domain.facts.assume(*expr, *relation));
        domain
    }
}

/// The result of the analysis of a plant.
#[derive(Debug)]
pub struct Derivation {
    /// The verdict on the model.
    pub outcome: Outcome,
    /// The class of the cascade.
    pub class: Class,
    /// Claim 1.
    pub cascade: Claim<Cascade>,
    /// Claim 2.
    pub left_inverse: Claim<LeftInverse>,
    /// Claim 3.
    pub regression: Claim<Regression>,
    /// Claim 4.
    pub identifiability: Claim<Identifiability>,
    /// The conditions of the proofs besides the assumptions: expressions with the comparison with zero that gives the
    /// formulas values.
    pub conditions: Vec<(Expr, Relation)>,
    /// The diagnostics for the author.
    pub diagnostics: Vec<Diagnostic>,
    /// Remarks on which no claim depends.
    pub remarks: Remarks,
}

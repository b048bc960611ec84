//! Checks that outputs that are angles may be counted from any turn.
//!
//! In: a plant whose claims are proved. Out: for each output with a period the refusal, unless the observer computes the
//! same a period further on, as of a bearing in sines and cosines alone, or a period more in it, with states moved by
//! whole periods of their own, makes another trajectory of the plant: the claims hold for that one too. The samples of
//! such an output are read within a turn, and nobody knows in which one the first of them is.

use std::collections::BTreeMap;

use super::design::{Cascade, LeftInverse, Regression};
use crate::plant::Plant;
use crate::source::{Code, Diagnostic, Span};
use pebo_cas::domain::zero::is_zero;
use pebo_cas::{Domain, Expr, Relation, Symbol};

/// States that turn at once are tried up to so many: each triples the ways.
const MOST_TURNING: usize = 5;

/// What an observer computes of samples.
pub(super) struct Computed<'a> {
    pub(super) cascade: &'a Cascade,
    pub(super) regression: &'a Regression,
    pub(super) inverse: &'a LeftInverse,
}

impl Computed<'_> {
    /// Tests whether it is the same a period of an output further on; what stands under a derivative may be more by a
    /// constant.
    fn is_periodic(&self, plant: &Plant, domain: &Domain, (output, period): (Symbol, Expr)) -> bool {
        let arena = &plant.arena;
        let there = BTreeMap::from([(output, arena.add(arena.of_symbol(output), period))]);
        let change = |expr: &Expr| arena.sub(arena.substitute(*expr, &there), *expr);
        let Self { cascade, regression, inverse } = self;
        let lambda = cascade.lambda.iter().flatten().flatten();
        let rows = regression.phi_1.iter().chain(&regression.primitive_1).flatten();
        let formulas = cascade.h.iter().chain(lambda).chain(&regression.phi_0).chain(rows);
        let domain = domain.without_equations();
        let is_zero = |expr: Expr| is_zero(arena, expr, &domain);
        let constants = plant.parameters.iter().map(|parameter| parameter.symbol).collect();
        let is_constant = |expr: Expr| is_zero(expr) || arena.symbols_of(&[expr]).is_subset(&constants);
        formulas.chain(inverse.x.iter().map(|(_, formula)| formula)).map(change).all(is_zero)
            && regression.primitive_0.iter().map(change).all(is_constant)
    }
}

/// The refusals of the outputs that have to be counted from a certain turn.
pub(super) fn refused(plant: &Plant, domain: &Domain, computed: &Computed<'_>) -> Vec<Diagnostic> {
    let outputs = plant.y.iter().filter_map(|output| Some((output.symbol, plant.period(output.symbol)?)));
    let is_known = |angle| computed.is_periodic(plant, domain, angle) || turns(plant, domain, angle);
    let open = outputs.filter(|(output, period)| !is_known((*output, *period)));
    open.map(|(output, _)| refuse(plant, output)).collect()
}

fn refuse(plant: &Plant, output: Symbol) -> Diagnostic {
    let name = plant.arena.name(output);
    let span = plant.angles.iter().find(|(angle, _)| *angle == output).map_or(Span::NOWHERE, |(_, period)| period.span);
    Diagnostic::error(
        Code::UnknownUpToTurns,
        span,
        format!("the turn of `{name}` is not known, and the states depend on it"),
    )
    .label(format!("samples of `{name}` are read within this period"))
    .note(
        "a period more in it, with states moved by whole periods of their own, is not shown to leave equations and \
         assumptions as they are",
    )
    .help(format!(
        "leave out `{name}` if its samples do not wrap, or declare the period by which a state turns with it"
    ))
}

/// Tests whether the plant is the same a period of an output further on, with states turned in one of the ways.
fn turns(plant: &Plant, domain: &Domain, (output, period): (Symbol, Expr)) -> bool {
    let turning: Vec<(Symbol, Expr)> =
        plant.x.iter().filter_map(|state| Some((state.symbol, plant.period(state.symbol)?))).collect();
    let ways = 3_usize.pow(u32::try_from(turning.len().min(MOST_TURNING)).unwrap_or(0));
    (0..ways).any(|way| is_same(plant, domain, (output, period), &turned(&turning, way)))
}

/// Tests it where states turn by so many periods.
fn is_same(plant: &Plant, domain: &Domain, (output, period): (Symbol, Expr), turned: &[(Symbol, Expr, i64)]) -> bool {
    let arena = &plant.arena;
    let plus = |symbol: Symbol, step: Expr| (symbol, arena.add(arena.of_symbol(symbol), step));
    let mut there: BTreeMap<Symbol, Expr> = BTreeMap::from([plus(output, period)]);
    there.extend(turned.iter().map(|(state, period, turns)| plus(*state, arena.scale(*period, &(*turns).into()))));
    let change = |expr: Expr| arena.sub(arena.substitute(expr, &there), expr);
    let values =
        plant.y.iter().filter_map(|output| Some(arena.sub(arena.of_symbol(output.symbol), output.value?.expr)));
    let identities = plant.identities.iter().map(|identity| identity.expr);
    // The domain too: what may only not be zero is zero elsewhere then, which its trajectories pass as these do.
    let signs = domain.facts.iter().filter(|(_, relation)| *relation != Relation::NonZero).map(|(fact, _)| fact);
    let formulas = plant.rates().into_values().chain(values).chain(identities).chain(signs);
    let domain = domain.without_equations();
    formulas.into_iter().all(|formula| is_zero(arena, change(formula), &domain))
}

/// States with so many periods, one of three for each: as they are, one more, or one less.
fn turned(turning: &[(Symbol, Expr)], way: usize) -> Vec<(Symbol, Expr, i64)> {
    let digits = (0..MOST_TURNING).map(|place| way / 3_usize.pow(u32::try_from(place).unwrap_or(0)) % 3);
    let turns = digits.map(|digit| if digit == 2 { -1 } else { i64::try_from(digit).unwrap_or(0) });
    turning.iter().zip(turns).filter(|(_, turns)| *turns != 0).map(|((s, p), turns)| (*s, *p, turns)).collect()
}

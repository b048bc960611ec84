//! Checks that outputs that are angles may be counted from any turn.
//!
//! In: the claims of a plant. Out: for each output with a period the refusal, unless a period more in it, with the
//! coordinates moved by constants, leaves the observer as it is, and each state but for whole periods of its own. The
//! samples of such an output are read within a turn, and nobody knows in which one the first of them is.

use std::collections::BTreeMap;

use super::design::{Cascade, LeftInverse, Regression};
use super::left_inverse::checking::is_whole_turns;
use crate::plant::Plant;
use crate::source::{Code, Diagnostic, Span};
use pebo_cas::domain::zero::decide;
use pebo_cas::forms::tidy::shortest;
use pebo_cas::{Domain, Expr, Symbol};

/// States that turn at once are tried up to so many: each triples the ways.
const MOST_TURNING: usize = 5;

/// The refusals of the outputs that have to be counted from a certain turn.
pub(super) fn refused(
    plant: &Plant,
    domain: &Domain,
    (cascade, regression, inverse): (&Cascade, &Regression, &LeftInverse),
) -> Vec<Diagnostic> {
    let claims = Claims { plant, domain, cascade, regression, inverse };
    let outputs = plant.y.iter().filter_map(|output| Some((output.symbol, plant.period(output.symbol)?)));
    let open = outputs.filter(|(output, period)| !claims.turns(*output, *period));
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
    .note("a period more in it is not shown to change each state by whole periods of its own, and nothing else")
    .help(format!(
        "leave out `{name}` if its samples do not wrap, or declare the period by which a state turns with it"
    ))
}

struct Claims<'a> {
    plant: &'a Plant,
    domain: &'a Domain,
    cascade: &'a Cascade,
    regression: &'a Regression,
    inverse: &'a LeftInverse,
}

impl Claims<'_> {
    /// Tests whether the observer is the same a period of an output further on, with states turned in one of the ways.
    fn turns(&self, output: Symbol, period: Expr) -> bool {
        let plant = self.plant;
        let turning: Vec<(Symbol, Expr)> =
            plant.x.iter().filter_map(|state| Some((state.symbol, plant.period(state.symbol)?))).collect();
        let ways = 3_usize.pow(u32::try_from(turning.len().min(MOST_TURNING)).unwrap_or(0));
        (0..ways).any(|way| self.is_same((output, period), &turned(&turning, way)))
    }

    /// Tests it where states turn by so many periods.
    fn is_same(&self, (output, period): (Symbol, Expr), turned: &[(Symbol, Expr, i64)]) -> bool {
        let plant = self.plant;
        let (arena, domain) = (&plant.arena, &self.domain.without_equations());
        let plus = |symbol: Symbol, step: Expr| (symbol, arena.add(arena.of_symbol(symbol), step));
        let mut there: BTreeMap<Symbol, Expr> = BTreeMap::from([plus(output, period)]);
        there.extend(turned.iter().map(|(state, period, turns)| plus(*state, arena.scale(*period, &(*turns).into()))));
        let vanishes = |expr: Expr| decide(arena, expr, domain).is_zero();
        let constants = plant.parameters.iter().map(|parameter| parameter.symbol).collect();
        // The steps of the coordinates, which are constant.
        let mut steps: Vec<Expr> = Vec::new();
        for component in plant.transform() {
            let step = arena.sub(arena.substitute(component, &there), component);
            let value = shortest(arena, domain, step);
            if !arena.symbols_of(&[value]).is_subset(&constants) || !vanishes(arena.sub(step, value)) {
                return false;
            }
            steps.push(value);
        }
        for coordinates in [&plant.z, &plant.chi, &plant.xi] {
            there.extend(coordinates.iter().zip(&steps).map(|(symbol, step)| plus(*symbol, *step)));
        }
        let change = |expr: Expr| arena.sub(arena.substitute(expr, &there), expr);
        let lambda = self.cascade.lambda.iter().flatten();
        let along = lambda.clone().map(|row| arena.dot(row, &steps)).chain(std::iter::repeat(arena.zero()));
        let rates = self.cascade.h.iter().zip(along).map(|(h, along)| arena.add(change(*h), along));
        let Regression { phi_0, phi_1, primitive_0, primitive_1, .. } = self.regression;
        let kept = phi_0.iter().chain(phi_1.iter().flatten()).chain(primitive_1.iter().flatten());
        let kept = kept.chain(lambda.flatten()).map(|expr| change(*expr));
        // A constant in a function under a derivative is of no account.
        let moving = |expr: &Expr| change(*expr);
        let slopes = primitive_0.iter().map(moving).flat_map(|change| {
            arena.symbols_of(&[change]).into_iter().map(move |symbol| arena.derivative(change, symbol))
        });
        let is_turned = |(state, formula): &(Symbol, Expr)| {
            let change = change(*formula);
            let by_turns = |period| is_whole_turns(arena, domain, arena.div(arena.mul(change, arena.turn()), period));
            vanishes(change) || plant.period(*state).is_some_and(by_turns)
        };
        rates.chain(kept).chain(slopes).all(vanishes) && self.inverse.x.iter().all(is_turned)
    }
}

/// States with so many periods, one of three for each: as they are, one more, or one less.
fn turned(turning: &[(Symbol, Expr)], way: usize) -> Vec<(Symbol, Expr, i64)> {
    let digits = (0..MOST_TURNING).map(|place| way / 3_usize.pow(u32::try_from(place).unwrap_or(0)) % 3);
    let turns = digits.map(|digit| if digit == 2 { -1 } else { i64::try_from(digit).unwrap_or(0) });
    turning.iter().zip(turns).filter(|(_, turns)| *turns != 0).map(|((s, p), turns)| (*s, *p, turns)).collect()
}

use crate::Overrides;
use crate::closed_loop::ode::Flow;
use crate::closed_loop::ode::equation::Standstill;
use crate::closed_loop::signal::Signal;
use crate::experiment::layout::time;
use pebo_cas::{Arena, Expr};
use pebo_design::model::Model;
use pebo_design::plant::Scope;
use pebo_design::program::lower;
use pebo_design::source::{Diagnostics, Source};

use super::{SPRING, run, with};

#[test]
fn a_spring_swings_as_its_closed_form_says() {
    // A step of a sixth of a period: the integrator has to take several.
    let trace = run(SPRING, &Overrides { step: Some(0.5), ..Overrides::default() });
    let (t, v, q) = (trace.column("t").unwrap(), trace.column("v").unwrap(), trace.column("q").unwrap());
    assert_eq!(t.len(), 21);
    for ((t, v), q) in t.iter().zip(&v).zip(&q) {
        // The tolerance of a step is 1e-10; some hundred steps.
        assert!((q - (2.0 * t).cos()).abs() < 1e-8, "{t} {q}");
        assert!((v + 2.0 * (2.0 * t).sin()).abs() < 2e-8, "{t} {v}");
    }
}

/// The course of the signal `s`.
pub(super) fn course(arena: &Arena, formula: &str) -> Signal {
    let text = with(SPRING, "duration", &format!("signals: {{s: {formula}}}, duration"));
    let model = Model::parse(&Source::new("test", text).unwrap()).unwrap();
    let mut scope = Scope::new();
    scope.define("t", arena.of_symbol(time(arena)));
    let mut problems = Diagnostics::new();
    let signal = Signal::resolve(arena, &scope, &model.simulation.unwrap().signals[0], &mut problems);
    assert!(!problems.has_errors());
    signal
}

/// The state after each of `steps` steps of 0.1 s, where the table is time, one state and the signal `s`.
fn integrate(rate: impl Fn(&Arena, Expr, Expr) -> Expr, signal: &str, steps: u8) -> Result<Vec<f64>, Standstill> {
    let arena = Arena::new();
    let (state, input) = (arena.variable("a"), arena.variable("s"));
    let symbols = [time(&arena), arena.symbol("a"), arena.symbol("s")];
    let signal = course(&arena, signal);
    let rate = rate(&arena, state, input);
    let program = lower(&arena, &symbols, &[rate]).unwrap();
    let slopes = lower(&arena, &symbols, &[arena.derivative(rate, symbols[1])]).unwrap();
    let mut flow = Flow::new((&program, Some(&slopes)), None, 1..2, &[(2, &signal)], 1e-9);
    let mut table = [0.0, 1.0, 0.0];
    let mut states = Vec::new();
    for step in 0..steps {
        let from = f64::from(step) / 10.0;
        flow.advance(&mut table, from, from + 0.1)?;
        table[0] = from + 0.1;
        states.push(table[1]);
    }
    Ok(states)
}

#[test]
fn a_signal_that_jumps_between_samples_is_integrated_to_the_jump() {
    let states = integrate(|_, _, s| s, "{0: 1, 0.25: 3, 0.27: -1}", 4).unwrap();
    let expected = [1.1, 1.2, 1.25 + 3.0 * 0.02 - 0.03, 1.25 + 3.0 * 0.02 - 0.13];
    for (state, expected) in states.iter().zip(expected) {
        assert!((state - expected).abs() < 1e-12, "{state} {expected}");
    }
}

#[test]
fn a_signal_that_moves_is_followed_between_samples() {
    let states = integrate(|_, _, s| s, "{0: cos(20*t)}", 5).unwrap();
    assert!((states[4] - 1.0 - 10_f64.sin() / 20.0).abs() < 1e-9, "{}", states[4]);
}

#[test]
fn an_impossible_integration_ends() {
    // Escapes to infinity at t = 1.
    assert!(integrate(|arena, a, _| arena.mul(a, a), "0", 20).is_err());
    // Leaves the domain of the root.
    assert!(integrate(|arena, a, _| arena.neg(arena.sqrt(arena.sub(a, arena.one()))), "0", 1).is_ok());
    assert!(integrate(|arena, a, _| arena.sqrt(arena.neg(a)), "0", 1).is_err());
    // Has no solution: a switch that would have to be everywhere.
    assert!(integrate(|arena, a, _| arena.div(arena.number(-1), arena.sub(a, arena.one())), "0", 1).is_err());
}

#[test]
fn a_transient_of_a_nanosecond_costs_a_few_steps() {
    // Leads to cos(20 t) with a time constant of 1 ns; the explicit method would need 3e7 steps for each 0.1 s.
    let fast = |arena: &Arena, a, s| arena.mul(arena.number(-1_000_000_000), arena.sub(a, s));
    let states = integrate(fast, "{0: cos(20*t)}", 10).unwrap();
    for (state, t) in states.iter().zip(1..) {
        let t = f64::from(t) / 10.0;
        // It lags by 1 ns: cos(20 t) + 20e-9 sin(20 t).
        let expected = (20.0 * t).cos() + 20e-9 * (20.0 * t).sin();
        // The tolerance of a step is 1e-10.
        assert!((state - expected).abs() < 1e-9, "{t} {state} {expected}");
    }
}

/// Robertson's reaction, whose rates span nine powers of ten, with one of its substances measured.
const ROBERTSON: &str = "
model: robertson
x: [a, b]
y: [c]
f_x: {a: -0.04*a + 1e4*b*c, b: 0.04*a - 1e4*b*c - 3e7*b^2}
f_y: {c: 3e7*b^2}
phi: [a + b + c, b]
observer: {gain: 1, filter: 1}
simulation: {duration: 40, step: 1, initial: {a: 1, b: 0, c: 0}}
";

#[test]
fn a_stiff_plant_moves_as_published() {
    let source = Source::new("test", ROBERTSON).unwrap();
    let model = Model::parse(&source).unwrap();
    let plant = pebo_design::plant::Plant::resolve(&model).unwrap();
    let arena = &plant.arena;
    let symbols: Vec<_> = [time(arena)].into_iter().chain(["a", "b", "c"].map(|name| arena.symbol(name))).collect();
    let rates: Vec<Expr> = symbols[1..].iter().map(|symbol| plant.rates()[symbol]).collect();
    let slopes: Vec<Expr> =
        rates.iter().flat_map(|rate| symbols[1..].iter().map(|symbol| arena.derivative(*rate, *symbol))).collect();
    let (rates, slopes) = (lower(arena, &symbols, &rates).unwrap(), lower(arena, &symbols, &slopes).unwrap());
    let mut flow = Flow::new((&rates, Some(&slopes)), None, 1..4, &[], 1e-9);
    let mut table = [0.0, 1.0, 0.0, 0.0];
    for second in 0..40 {
        flow.advance(&mut table, f64::from(second), f64::from(second + 1)).unwrap();
    }
    // Hairer and Wanner, Solving ordinary differential equations II, and the test set for initial value problems.
    for (state, expected) in table[1..].iter().zip([0.715_827_068_718_2, 9.185_534_764_558e-6, 0.284_163_745_746_9]) {
        assert!((state / expected - 1.0).abs() < 1e-8, "{state} {expected}");
    }
}

use crate::cas::{Arena, Expr};
use crate::model::Model;
use crate::plant::Scope;
use crate::program::lower;
use crate::simulate::Overrides;
use crate::simulate::flow::{Flow, Stuck};
use crate::simulate::layout::time;
use crate::simulate::signal::Signal;
use crate::source::{Diagnostics, Source};

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
fn integrate(rate: impl Fn(&Arena, Expr, Expr) -> Expr, signal: &str, steps: u8) -> Result<Vec<f64>, Stuck> {
    let arena = Arena::new();
    let (state, input) = (arena.variable("a"), arena.variable("s"));
    let symbols = [time(&arena), arena.symbol("a"), arena.symbol("s")];
    let signal = course(&arena, signal);
    let program = lower(&arena, &symbols, &[rate(&arena, state, input)]).unwrap();
    let mut flow = Flow::new(&program, None, 1..2, &[(2, &signal)], 1e-9);
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
fn what_cannot_be_integrated_ends() {
    // Escapes to infinity at t = 1.
    assert!(integrate(|arena, a, _| arena.mul(a, a), "0", 20).is_err());
    // Leaves the domain of the root.
    assert!(integrate(|arena, a, _| arena.neg(arena.sqrt(arena.sub(a, arena.one()))), "0", 1).is_ok());
    assert!(integrate(|arena, a, _| arena.sqrt(arena.neg(a)), "0", 1).is_err());
    // Has no solution: a switch that would have to be everywhere.
    assert!(integrate(|arena, a, _| arena.div(arena.number(-1), arena.sub(a, arena.one())), "0", 1).is_err());
    // Is far too stiff.
    assert!(integrate(|arena, a, _| arena.mul(arena.number(-1_000_000_000), a), "0", 1).is_err());
}

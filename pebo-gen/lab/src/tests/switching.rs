//! Plants with signs in their rates, beside their closed forms.

use crate::closed_loop::ode::Flow;
use crate::closed_loop::ode::switching::Switches;
use crate::experiment::layout::time;
use crate::{Failure, Overrides};
use pebo_cas::Function::Sign;
use pebo_cas::{Arena, Expr};
use pebo_design::program::lower;
use pebo_design::source::Span;

use super::flow::course;
use super::{SPRING, resolve, run, with};

/// The accuracy of a level: the tolerance of the integrator over some hundred steps.
const KNOWN: f64 = 1e-8;

fn sign(arena: &Arena, level: Expr) -> Expr {
    arena.call(Sign, &[level])
}

/// The states at instants a tenth of a second apart, by their rates in the states and the signal `s`.
fn states(begin: &[f64], rates: impl Fn(&Arena, &[Expr], Expr) -> Vec<Expr>, signal: &str) -> Vec<Vec<f64>> {
    let arena = Arena::new();
    let names: Vec<String> = (0..begin.len()).map(|place| format!("a{place}")).collect();
    let state: Vec<_> = names.iter().map(|name| arena.symbol(name)).collect();
    let s = arena.symbol("s");
    let all: Vec<Expr> = state.iter().map(|symbol| arena.of_symbol(*symbol)).collect();
    let mut rates = rates(&arena, &all, arena.of_symbol(s));
    let switches = Switches::take(&arena, &mut rates, &state, &[s]);
    assert!(!switches.levels.is_empty());
    let symbols = [&[time(&arena)], state.as_slice(), &[s], &switches.symbols].concat();
    let switched = switches.programs(&arena, &symbols, Span::NOWHERE).unwrap();
    let signal = course(&arena, signal);
    let program = lower(&arena, &symbols, &rates).unwrap();
    let end = 1 + begin.len();
    let mut flow = Flow::new((&program, None), switched.as_ref(), 1..end, &[(end, &signal)], 1e-9);
    let mut table = vec![0.0; symbols.len()];
    table[1..end].copy_from_slice(begin);
    let step = |sample: u32| {
        flow.advance(&mut table, f64::from(sample) / 10.0, f64::from(sample + 1) / 10.0).unwrap();
        table[1..end].to_vec()
    };
    (0..100).map(step).collect()
}

/// Holds states against what they should be at these instants.
fn compare(found: &[Vec<f64>], expected: impl Fn(f64) -> Vec<f64>) {
    for (sample, found) in (1_u32..).zip(found) {
        let expected = expected(f64::from(sample) / 10.0);
        for (a, b) in found.iter().zip(&expected) {
            assert!((a - b).abs() < KNOWN, "{sample} {found:?} {expected:?}");
        }
    }
}

#[test]
fn dry_friction_stops_a_mass_holds_it_and_lets_it_go() {
    // a' = t - 2 sign(a): it stops where 1 - 2 t + t^2/2 is 0, and is held while t is below 2.
    let found = states(&[1.0], |arena, a, s| vec![arena.sub(s, arena.mul(arena.number(2), sign(arena, a[0])))], "t");
    compare(&found, |t| {
        vec![match t {
            t if t < 2.0 - 2.0_f64.sqrt() => 1.0 - 2.0 * t + t * t / 2.0,
            t if t < 2.0 => 0.0,
            t => (t - 2.0).powi(2) / 2.0,
        }]
    });
}

#[test]
fn masses_stick_to_one_another_and_to_the_ground() {
    // One slides on the other, which slides on the ground: a' = -sign(a - b), b' = sign(a - b) - sign(b)/2.
    let rates = |arena: &Arena, a: &[Expr], _: Expr| {
        let between = sign(arena, arena.sub(a[0], a[1]));
        let half = arena.div(sign(arena, a[1]), arena.number(2));
        vec![arena.neg(between), arena.sub(between, half)]
    };
    compare(&states(&[1.0, 0.0], rates, "0"), |t| match t {
        t if t < 2.0 / 3.0 => vec![1.0 - t, t / 2.0],
        t if t < 2.0 => vec![1.0 / 3.0 - (t - 2.0 / 3.0) / 4.0; 2],
        _ => vec![0.0; 2],
    });
}

#[test]
fn a_level_that_goes_through_zero_is_not_held() {
    // a' = 2 - sign(a) from -1.
    let found = states(&[-1.0], |arena, a, _| vec![arena.sub(arena.number(2), sign(arena, a[0]))], "0");
    compare(&found, |t| vec![if t < 1.0 / 3.0 { 3.0 * t - 1.0 } else { t - 1.0 / 3.0 }]);
}

#[test]
fn a_relay_swings_in_parabolas() {
    // a'' = -sign(a) from 1 at rest: a quarter of its swing takes sqrt(2).
    let found = states(&[1.0, 0.0], |arena, a, _| vec![a[1], arena.neg(sign(arena, a[0]))], "0");
    let quarter = 2.0_f64.sqrt();
    compare(&found, |t| {
        let turned = t % (4.0 * quarter);
        let (side, since) = if (quarter..3.0 * quarter).contains(&turned) {
            (-1.0, turned - 2.0 * quarter)
        } else {
            (1.0, if turned < quarter { turned } else { turned - 4.0 * quarter })
        };
        vec![side * (1.0 - since * since / 2.0), -side * since]
    });
}

#[test]
fn signs_that_change_ever_faster_end_at_rest() {
    // a'' = -sign(a) - sign(a')/2 from 1: 2 s to zero, 2/3 s to -1/3, and so on from a third: (2 + 2/3)/(1 - sqrt(1/3))
    // s, which is 6.31 s, for all of it.
    let rates = |arena: &Arena, a: &[Expr], _: Expr| {
        let friction = arena.div(sign(arena, a[1]), arena.number(2));
        vec![a[1], arena.neg(arena.add(sign(arena, a[0]), friction))]
    };
    let found = states(&[1.0, 0.0], rates, "0");
    // a' moves by 1.5 a second, and a sign may be wrong for a thousandth of a tenth of one.
    for state in &found[65..] {
        assert!(state[0].abs() < 1e-6 && state[1].abs() < 3e-4, "{state:?}");
    }
}

#[test]
fn a_sign_of_a_signal_changes_between_samples() {
    // a' = sign(cos(t)), which changes at odd multiples of pi/2.
    let found = states(&[0.0], |arena, _, s| vec![sign(arena, s)], "cos(t)");
    compare(&found, |t| vec![t.sin().asin()]);
}

/// A motor with dry friction under a torque that alternates and is too weak to move it all the time.
const BRAKE: &str = "
model: brake
parameters: {J: 1, M_c: 2}
x: [M_L]
y: [omega]
u: [M]
assume: [J > 0, M_c > 0]
f_x: {M_L: 0}
f_y: {omega: (M + M_L - M_c*sign(omega))/J}
phi: [M_L]
simulation: {duration: 5, step: 1e-3, initial: {M_L: 0.5, omega: 1}, control: {M: 3*sin(2*t)}}
";

#[test]
fn a_plant_that_sticks_is_simulated() {
    let trace = run(BRAKE, &Overrides { every: Some(1e-3), ..Overrides::default() });
    let (torque, omega) = (trace.column("M").unwrap(), trace.column("omega").unwrap());
    let held: Vec<usize> = (0..omega.len()).filter(|row| omega[*row].abs() < 1e-9).collect();
    // It sticks for some tenths of a second, and meanwhile the torque is below the break-away torque.
    assert!(held.len() > 200, "{}", held.len());
    let rests =
        |row: &usize| row + 1 == omega.len() || omega[row + 1].abs() >= 1e-9 || (torque[*row] + 0.5).abs() <= 2.0;
    assert!(held.iter().all(rests));
}

#[test]
fn a_diverging_state_is_named_with_its_time() {
    let text = with(&with(SPRING, "{v: -k*q}", "{v: q^3*k}"), "{v: 0, q: 1}", "{v: 1, q: 1}");
    let scenario = resolve(&text, &Overrides::default()).unwrap();
    let failure = scenario.run().unwrap_err();
    let Failure::Diverged { name, value, at } = &failure else { panic!("{failure}") };
    // q'' = 4 q^3 from 1 with the speed 1: q'^2 = 2 q^4 - 1, and 1/q is 0 after the integral of 1/sqrt(2 - p^4) over
    // 0..1, which is 0.76 or so.
    assert!(name == "v" && *value > 1e6 && (0.7..0.8).contains(at), "{failure}");
    assert!(scenario.explain(&failure).help.unwrap().contains("unstable"));
}

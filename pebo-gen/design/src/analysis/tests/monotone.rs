//! Regressions that are monotone in theta.

use super::{codes, derive};
use crate::analysis::{AtEstimate, Derivation, Outcome, UnusedReason};
use crate::plant::Plant;
use crate::source::Code;

fn sense(lines: &str) -> Option<AtEstimate> {
    let asked = if lines.contains("regression: ") { "" } else { "\nregression: monotone" };
    let (_, derivation) = derive(&[lines, asked].concat());
    (derivation.outcome == Outcome::Accepted).then(|| derivation.at_estimate()).flatten()
}

fn monotone(lines: &str) -> (Plant, Derivation) {
    let (plant, derivation) = derive(&format!("{lines}\nregression: monotone"));
    assert_eq!((derivation.outcome, codes(&derivation)), (Outcome::Accepted, Vec::new()), "{lines}");
    assert_eq!(derivation.at_estimate(), Some(AtEstimate::Monotone), "{lines}");
    (plant, derivation)
}

/// A torque that is monotone in the speed of the wind below that of the largest one.
const TURBINE: &str =
    "parameters: {J: 2, a: 0.3}\nx: [v]\ny: [w]\nu: [T]\nf_x: {v: 0}\nf_y: {w: (a*v^3*w*exp(-v/w) - T)/J}\nphi: [v]";

#[test]
fn slopes_of_one_sign_on_the_domain_are_monotone() {
    let (plant, derivation) = monotone(&format!("{TURBINE}\nassume: [w > 0, v > 0, v < 3*w]"));
    assert_eq!(derivation.regression.result.unwrap().parameterisation(&plant), "monotone");
    // Beyond the largest torque it falls: with a larger domain there are two speeds of one torque.
    for assumed in ["w > 0, v > 0", "w > 0, v > 0, v < 4*w", "w > 0, v < 3*w"] {
        assert_eq!(sense(&format!("{TURBINE}\nassume: [{assumed}]")), None, "{assumed}");
    }
}

/// A slope is a factor that y and u determine, of any sign, times one that is positive.
#[test]
fn known_factors_may_have_any_sign() {
    monotone("x: [n]\ny: [v]\nu: [F]\nf_x: {n: 0}\nf_y: {v: F - exp(n*v)}\nphi: [n]");
    monotone("x: [p]\ny: [s]\nu: [u, r]\nf_x: {p: u}\nf_y: {s: (r - u)*(p + atan(p))}\nphi: [p]");
    // Of a factor with the unknown nothing of that kind is known.
    assert_eq!(sense("x: [p]\ny: [s]\nu: [u]\nf_x: {p: u}\nf_y: {s: (p - u)*atan(p)}\nphi: [p]"), None);
}

/// Several unknowns, each in equations of its own, of which some are linear.
#[test]
fn each_equation_holds_one_unknown() {
    let (_, derivation) = monotone(
        "parameters: {R: 8}\nx: [E]\ny: [c, T]\nu: [q]\nassume: [T > 0, c > 0]\nf_x: {E: 0}\n\
         f_y: {c: q - c*exp(-E/(R*T)), T: c*exp(-E/(R*T)) - T}\nphi: [E]",
    );
    assert_eq!(derivation.regression.result.unwrap().phi_1.len(), 2);
    monotone("x: [p, r]\ny: [s, t]\nu: [u]\nf_x: {p: 0, r: 0}\nf_y: {s: exp(p*u), t: u - r*t}\nphi: [p, r]");
    assert_eq!(sense("x: [p, r]\ny: [s]\nu: [u]\nf_x: {p: 0, r: 0}\nf_y: {s: exp(p*u + r)}\nphi: [p, r]"), None);
    assert_eq!(sense("x: [p, r]\ny: [s]\nu: [u]\nf_x: {p: 0, r: 0}\nf_y: {s: exp(p*u) + r}\nphi: [p, r]"), None);
    assert_eq!(sense("x: [p, r]\ny: [s]\nu: [u]\nf_x: {p: 0, r: 0}\nf_y: {s: r*exp(p*u)}\nphi: [p, r]"), None);
}

/// What jumps, or has no value between two estimates, is not monotone, though its slope has one sign.
#[test]
fn jumps_and_poles_are_not_monotone() {
    let with = |value: &str, assumed: &str| {
        sense(&format!("x: [p]\ny: [s]\nu: [u]\nassume: [{assumed}]\nf_x: {{p: 0}}\nf_y: {{s: {value}}}\nphi: [p]"))
    };
    assert_eq!(with("atan(p - 2*sign(p)) + u", ""), None);
    assert_eq!(with("exp(u/p)", ""), None);
    assert_eq!(with("exp(u/p)", "p != 0"), None);
    assert_eq!(with("exp(u/p)", "p > 0"), Some(AtEstimate::Monotone));
    // Two intervals, of which the first is beyond the second.
    assert_eq!(with("exp(u*p)", "p^2 > 1"), None);
    assert_eq!(with("atan(abs(p)*p) + u", ""), None, "the slope is zero where p is");
    assert_eq!(with("atan(p + abs(p)/2) + u", ""), Some(AtEstimate::Monotone));
}

/// Each piece of a table rises, the straight ones too; with a piece that falls, or is flat, the table is not monotone.
#[test]
fn tables_are_monotone_piece_by_piece() {
    let with = |points: &str, how: &str| {
        sense(&format!(
            "parameters: {{Q: 9}}\nx: [s]\ny: [V]\nu: [I]\nassume: [0 < s < 1]\ndefine: {{ocv: {{table: s, points: [{points}]{how}}}}}\nf_x: {{s: -I/Q}}\n\
             g_y: {{V: ocv - I}}\nphi: [s]"
        ))
    };
    let rising = "[0, 3.0], [0.1, 3.3], [0.2, 3.5], [1, 4.2]";
    for how in ["", ", interpolation: linear"] {
        assert_eq!(with(rising, how), Some(AtEstimate::Monotone), "{how}");
        assert_eq!(with("[0, 3.0], [0.1, 3.3], [0.2, 3.2], [1, 4.2]", how), None, "{how}");
        assert_eq!(with("[0, 3.0], [0.1, 3.3], [0.2, 3.3], [1, 4.2]", how), None, "{how}");
    }
}

/// An equation that is not monotone is left out where the others serve, and named.
#[test]
fn other_equations_are_left_out() {
    let (_, derivation) =
        monotone("x: [p]\ny: [s, t]\nu: [u]\nf_x: {p: 0}\nf_y: {s: exp(p*u), t: u + exp(-p^2)}\nphi: [p]");
    let unused = derivation.regression.result.unwrap().unused;
    assert_eq!(
        unused.iter().map(|left| (left.output, left.reason)).collect::<Vec<_>>(),
        [(1, UnusedReason::NotMonotone)]
    );
}

/// The claims on a given transform are those of a linear regression, unless the model asks for another.
#[test]
fn a_given_transform_asks_for_it() {
    let lines = format!("{TURBINE}\nassume: [w > 0, v > 0, v < 3*w]");
    assert_ne!(derive(&lines).1.outcome, Outcome::Accepted);
    monotone(&lines);
    // That there is no linear one refutes nothing then.
    let (_, open) = derive(&format!("{TURBINE}\nassume: [w > 0, v > 0]\nregression: monotone"));
    assert_eq!((open.outcome, codes(&open)[0]), (Outcome::Undecided, Code::RegressionUndecided));
}

/// Linear equations are exact; under a fundamental matrix the gradient of z is not that of theta; and who asks for a local
/// observer has one.
#[test]
fn other_regressions_are_not_called_monotone() {
    let linear = "x: [a]\ny: [y]\nu: [u]\nf_x: {a: u}\nf_y: {y: (1 + u^2)*a}\nphi: [a]";
    assert_eq!((derive(linear).1.outcome, sense(linear)), (Outcome::Accepted, None));
    assert_eq!(sense("x: [p]\ny: [v]\nu: [F]\nf_x: {p: -p + F}\nf_y: {v: atan(p) - v}\nphi: [p]"), None);
    let asked = format!("{TURBINE}\nassume: [w > 0, v > 0, v < 3*w]\nregression: local");
    assert_eq!(sense(&asked), Some(AtEstimate::Local));
}

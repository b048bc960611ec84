//! Rare cases: each was covered by no test until a small fault was put there (`tests/mutants`).

use super::{codes, conditions, derive};
use crate::analysis::{Derivation, Outcome, Verdict};
use crate::model::Model;
use crate::plant::Plant;
use crate::source::{Code, Source};
use pebo_cas::Budget;

#[test]
fn a_listed_sign_excludes_zeros() {
    let found = derive("x: [p]\ny: [r]\nu: [v]\nf_x: {p: v/(r + 1) + log(r)}\nf_y: {r: p}\nphi: [p]");
    assert_eq!((found.1.outcome, conditions(&found)), (Outcome::Accepted, vec!["r > 0".to_owned()]));
}

/// The second vanishes where the first does; the denominator of the first has any sign.
#[test]
fn factors_with_common_zeros_are_listed_once() {
    let found = derive("x: [p]\ny: [r]\nu: [v]\nf_x: {p: v/(1/r - 1) + 1/(r - 1)}\nf_y: {r: p}\nphi: [p]");
    assert_eq!(
        (found.1.outcome, conditions(&found)),
        (Outcome::Accepted, vec!["1/r - 1 != 0".to_owned(), "r != 0".to_owned()])
    );
}

#[test]
fn conditions_of_the_cascade_alone_are_listed() {
    let found =
        derive("x: [a, b]\ny: [q, r]\nu: [v]\nf_x: {a: v, b: a}\nf_y: {q: 0, r: b}\nphi: [a*q, b]\nphi_left: {b: z2}");
    assert_eq!((found.1.outcome, conditions(&found)), (Outcome::Accepted, vec!["q != 0".to_owned()]));
}

/// The rates of q and s depend on b, but no combination identifies it.
#[test]
fn observations_that_no_regression_uses_are_not_refuted() {
    let (_, derivation) = derive(
        "x: [a, b]\ny: [p, q, s]\nu: [u]\nw: [w]\nf_x: {a: u, b: u}\nf_y: {p: a, q: w, s: w^2 + b}\nphi: [a, b]",
    );
    assert_eq!((derivation.outcome, codes(&derivation)), (Outcome::Undecided, vec![Code::IdentifiabilityUndecided]));
}

#[test]
fn theta_may_be_identified_where_its_functions_are_not() {
    let (_, derivation) = derive("x: [a]\ny: [y]\nu: [u]\nf_x: {a: 0}\nf_y: {y: a^2 + u}\nphi: [a]");
    assert_eq!((derivation.outcome, codes(&derivation)), (Outcome::Undecided, vec![Code::IdentifiabilityUndecided]));
    let said = derivation.diagnostics[0].notes.join("\n");
    assert!(said.contains("theta itself can be identified near almost every value"), "{said}");
}

/// The factor of a^2 is zero, which no rule of algebra proves.
#[test]
fn undecided_identifiability_of_theta_is_reported() {
    let zero = "((2 + sqrt(5))^(1/3) - (sqrt(5) - 2)^(1/3) - 1)";
    let (_, derivation) =
        derive(&format!("x: [a]\ny: [y]\nu: [u]\nf_x: {{a: 0}}\nf_y: {{y: {zero}*a^2 + u}}\nphi: [a]"));
    assert_eq!((derivation.outcome, codes(&derivation)), (Outcome::Undecided, vec![Code::IdentifiabilityUndecided]));
    let said = derivation.diagnostics[0].notes.join("\n");
    assert!(said.contains("it could not be decided whether theta itself can be identified"), "{said}");
}

/// The ambiguity of an unknown is a step of the state: its period, if it is an angle.
#[test]
fn a_state_that_is_known_up_to_steps_is_an_angle_of_that_period() {
    let rotor = "parameters: [k]\nassume: [k > 0]\nx: [q]\ny: [a, b]\nu: [w]\nf_x: {q: w}\n\
                 f_y: {a: sin(q/k), b: cos(q/k)}\n";
    let cosine = |rate: &str| {
        format!("parameters: {{n: 3}}\nx: [q]\ny: [a]\nu: [w]\nf_x: {{q: w}}\nf_y: {{a: {rate}}}\nphi: [q]\n")
    };
    let (accepted, rejected, open) = (Outcome::Accepted, Outcome::Rejected, Outcome::Undecided);
    let warned = vec![Code::UnknownUpToTurns];
    let cases = [
        (format!("{rotor}phi: [q/k]"), accepted, warned.clone()),
        (format!("{rotor}phi: [q/k]\nangles: {{q: 2*pi*k}}"), accepted, Vec::new()),
        (format!("{rotor}phi: [q]\nangles: {{q: 2*pi*k}}"), accepted, Vec::new()),
        (format!("{rotor}phi: [q]\nangles: {{q: 4*pi*k}}"), rejected, warned.clone()),
        (format!("{}angles: {{q: 2*pi/n}}", cosine("cos(n*q)")), accepted, Vec::new()),
        (format!("{}angles: {{q: 2*pi}}", cosine("cos(n*q)")), rejected, warned.clone()),
        (format!("{}angles: {{q: pi}}", cosine("cos(2*q)")), accepted, Vec::new()),
        (format!("{}angles: {{q: 4*pi}}", cosine("cos(q/2)")), accepted, Vec::new()),
        // An angle known up to 4 pi is known up to 2 pi.
        (format!("{}angles: {{q: 2*pi}}", cosine("cos(q/2)")), accepted, Vec::new()),
        (cosine("cos(q)"), accepted, warned.clone()),
        // The domain holds no other state, which no formula for theta uses.
        (format!("{}assume: [10 < q, q < 12]", cosine("cos(q)")), open, warned.clone()),
        // theta is a quotient of the unknowns.
        (cosine("q*cos(q)"), accepted, Vec::new()),
        // And here it is the ratio of two frequencies, which is not found.
        (cosine("cos(q) + cos(sqrt(2)*q)"), open, warned.clone()),
    ];
    for (model, outcome, expected) in cases {
        let (_, derivation) = derive(&model);
        assert_eq!((derivation.outcome, codes(&derivation)), (outcome, expected), "{model}");
    }
}

/// The side of a non-smooth rate is known of x, not of z.
#[test]
fn a_non_smooth_rate_takes_its_form_on_the_domain() {
    for (assume, rate) in [("p > 5", "abs(p - 5)*p"), ("p < 0", "abs(p)*p"), ("p > 1", "max(p, 1)^2")] {
        let model =
            format!("x: [p]\ny: [q]\nu: [v]\nassume: [{assume}]\nf_x: {{p: v}}\nf_y: {{q: '{rate}'}}\nphi: [p]");
        assert_eq!(derive(&model).1.outcome, Outcome::Accepted, "{model}");
    }
}

/// The rate of b is zero, which no rule of algebra proves.
#[test]
fn an_undecided_identity_is_not_covered_by_a_proved_one() {
    let (_, derivation) = derive(
        "x: [p]\ny: [a, b, c]\nu: [v]\nf_x: {p: v}\n\
         f_y: {a: p, b: (2 + sqrt(5))^(1/3) - (sqrt(5) - 2)^(1/3) - 1, c: 0}\nphi: [p]\nidentities: [b, c]",
    );
    assert_eq!((derivation.outcome, codes(&derivation)), (Outcome::Undecided, vec![Code::IdentityUndecided]));
}

#[test]
fn the_claim_in_which_the_budget_ends_is_the_last_with_diagnostics() {
    let text = "model: m\nx: [p]\ny: [q]\nu: [v]\nf_x: {p: v}\nf_y: {q: p}\nphi: [p]\n";
    let model = Model::parse(&Source::new("m", text).unwrap()).unwrap();
    let plant = Plant::resolve_within(&model, Budget::unlimited()).unwrap();
    plant.arena.budget().take(u64::MAX);
    let derivation = Derivation::derive(&plant);
    assert_eq!((derivation.outcome, codes(&derivation)), (Outcome::Undecided, vec![Code::LimitReached]));
    assert_eq!(derivation.left_inverse.verdict, Verdict::Skipped);
}

#[test]
fn the_way_back_has_conditions_on_estimates() {
    let conditions = |phi: &str, left: &str| -> Vec<String> {
        let (plant, derivation) = derive(&format!(
            "x: [p]\ny: [q, r]\nu: [v]\nf_x: {{p: v}}\nf_y: {{q: p, r: v}}\nphi: [{phi}]\nphi_left: {{p: {left}}}"
        ));
        let conditions = derivation.conditions_on_estimates(&plant);
        conditions.iter().map(|(expr, relation)| format!("{} {}", plant.arena.print(*expr), relation.sign())).collect()
    };
    assert_eq!(conditions("p", "z1"), Vec::<String>::new());
    assert_eq!(conditions("exp(p)", "log(z1)"), ["z1 > 0"]);
}

#[test]
fn known_terms_are_as_the_author_wrote_them() {
    let (plant, derivation) =
        derive("x: [p]\ny: [q]\nu: [v]\nf_x: {p: v}\nf_y: {q: exp(q)*(p + q) + (q + 1)^2*(p + 3)}\nphi: [p]");
    let regression = derivation.regression.result.unwrap();
    assert_eq!(plant.arena.print(regression.phi_0[0]), "exp(q)*(q + chi1) + (q + 1)^2*(chi1 + 3)");
}

#[test]
fn an_identity_is_a_regression_where_the_rates_are_none() {
    let lines = "x: [a]\ny: [q, s]\nu: [u]\nf_x: {a: u}\nf_y: {q: exp(-a^2)}\nphi: [a]";
    assert_eq!(derive(lines).1.outcome, Outcome::Rejected);
    assert_eq!(derive(&format!("{lines}\nidentities: [s - a^2]")).1.outcome, Outcome::Accepted);
}

/// On one of the lines nothing is observable, for ever.
#[test]
fn a_domain_of_several_components_is_not_judged_by_one_of_them() {
    let model = |identity: &str, rates: &str, assume: &str| {
        format!(
            "x: [p]\ny: [a, b, r]\nu: [v]\nidentities: [{identity}]\nassume: [{assume}]\nf_x: {{p: v}}\nf_y: {{{rates}}}\nphi: [p]"
        )
    };
    let lines = "a: b*v, b: a*v, r: p*(a - b)";
    let (_, open) = derive(&model("a^2 - b^2", lines, ""));
    assert_eq!((open.outcome, codes(&open)), (Outcome::Undecided, vec![Code::IdentifiabilityUndecided]));
    let (_, one) = derive(&model("a + b", lines, "a != 0"));
    assert_eq!(one.outcome, Outcome::Accepted, "{:?}", codes(&one));
    // The regressor does not depend on the state, whose sign the identity leaves open.
    let (_, square) = derive("x: [p]\ny: [q]\nu: [v]\nf_x: {p: v}\nidentities: [q^2 - p^2]\nphi: [p]");
    assert_eq!(square.outcome, Outcome::Accepted, "{:?}", codes(&square));
    let (_, circle) = derive(&model("a^2 + b^2 - 1", "a: -b*v, b: a*v, r: p*(2 + a)", ""));
    assert_eq!(circle.outcome, Outcome::Accepted, "{:?}", codes(&circle));
}

/// Roots of squares and absolute values in identities are non-smooth too, and parameters have both signs unless one is
/// given.
#[test]
fn an_unknown_that_vanishes_on_one_cell_is_identifiable_on_the_other() {
    let model = |head: &str, rates: &str| format!("{head}\nx: [p]\nu: [v]\nf_x: {{p: v}}\nf_y: {{{rates}}}\nphi: [p]");
    let judged = |head: &str, rates: &str| {
        let (_, derivation) = derive(&model(head, rates));
        let parts = derivation.identifiability.result.as_ref().and_then(|result| result.trajectories.as_ref());
        (derivation.outcome, parts.map_or(0, |trajectories| trajectories.blind.len()))
    };
    let outputs = "y: [q, r]";
    // The border of the cell is another statement, where the factor has a value.
    for (factor, statements) in
        [("sqrt(q^2) + q", 2), ("(q^2)^(1/2) - q", 2), ("exp(abs(q)) - exp(q)", 2), ("atan2(q, abs(q)) - pi/4", 1)]
    {
        let judged = judged(outputs, &format!("q: v, r: \"({factor})*p\""));
        assert_eq!(judged, (Outcome::Accepted, statements), "{factor}");
    }
    for factor in ["asin(sin(q)) - q", "acos(cos(q)) - q", "atan(tan(q)) - q", "atan2(v, q) - atan(v/q)"] {
        assert_eq!(judged(outputs, &format!("q: v, r: \"({factor})*p\"")), (Outcome::Undecided, 0), "{factor}");
    }
    // An angle of its own.
    assert_eq!(judged(outputs, "q: v, r: atan(2*tan(q))*p").0, Outcome::Accepted);
    assert_eq!(judged("y: [q, r]\nassume: [-1 < q < 1]", "q: v, r: (asin(sin(q)) + q)*p").0, Outcome::Accepted);
    let non_smooth = "y: [q, r, s]\nassume: [q > 0]\nidentities: [q - abs(r)]";
    assert_eq!(judged(non_smooth, "q: v*q, r: v*r, s: (q - r)*p"), (Outcome::Accepted, 1));
    for factor in ["sqrt(k^2) - k", "abs(k*q) - k*abs(q)"] {
        let of_parameter = |sign: &str| {
            let head = format!("{outputs}\nparameters: {{k: null}}\nassume: [{sign}]");
            judged(&head, &format!("q: v, r: \"({factor})*p\"")).0
        };
        assert_eq!(of_parameter(""), Outcome::Undecided, "{factor}");
        assert_eq!(of_parameter("k > 0"), Outcome::Rejected, "{factor}");
        assert_eq!(of_parameter("k < 0"), Outcome::Accepted, "{factor}");
    }
}

/// The rate of `I/7` is not known, so the relation between V and z is not differentiated.
#[test]
fn an_input_in_a_relation_is_no_constant_that_has_no_rate() {
    let battery =
        |value: &str| format!("x: [s, v]\ny: [V]\nu: [I]\nf_x: {{s: -I, v: I - v}}\ng_y: {{V: {value}}}\nphi: [s, v]");
    let outcome = |value: &str| derive(&battery(value)).1.outcome;
    assert_eq!(outcome("3 + s - s^2 - v"), Outcome::Accepted);
    // A filter would need the rate of I.
    assert_eq!(outcome("3 + s - s^2 - v - I/7"), Outcome::Undecided);
}

/// An identity is solved for a rate; where parameters make its factor zero it says something else.
#[test]
fn parameters_that_make_an_identity_degenerate_are_excluded() {
    let of = |value: &str| {
        derive(&format!(
            "parameters: {{a: 2}}\nx: [p, s]\ny: [q]\nu: [v]\nf_x: {{p: 0, s: 0}}\ng_y: {{q: {value}}}\nphi: [p, s]"
        ))
    };
    assert_eq!(conditions(&of("(1 - a)*v*p + s")), ["a - 1 != 0"]);
    assert_eq!(conditions(&of("v*p + s")), [""; 0]);
}

/// Rows that vanish at equilibria by several equations at once.
#[test]
fn equilibria_at_which_rows_vanish_by_a_combination_of_rates_are_listed() {
    let (plant, derivation) = derive(
        "x: [p, k]\ny: [q]\nu: [v]\nf_x: {p: \"v - (p - q)*k\", k: 0}\nf_y: {q: \"(p - q)*k - q\"}\nphi: [q*k + p*k, k]",
    );
    let result = derivation.identifiability.result.as_ref().and_then(|result| result.trajectories.as_ref());
    let lines = result.expect("over time").lines(&plant);
    // At rest v and q are k*(p - q).
    let expected = "while `q + v + 2*k*(q - p) = 0`, only `z1 - 2*q*z2` is identified";
    assert!(lines.contains(&expected.to_owned()), "{lines:#?}");
}

/// What holds on one component of an identity is not said of the others.
#[test]
fn a_rank_that_drops_on_one_component_is_listed_with_it() {
    let (_, derivation) =
        derive("x: [p]\ny: [a, b]\nu: [v]\nf_x: {p: v}\nf_y: {a: p*a, b: -p*b}\nphi: [p]\nidentities: [a*b]");
    let result = derivation.identifiability.result.expect("proved");
    assert_eq!(result.singular_where, ["a = 0 and b = 0"]);
}

/// `a*b = 0` with `a > 0` is `b = 0`.
#[test]
fn a_factor_that_an_assumption_excludes_is_none() {
    let of = |assume: &str| {
        let lines = "x: [p]\ny: [a, b]\nu: [v]\nf_x: {p: v}\nf_y: {a: p*a, b: -p*b}\nphi: [p]\nidentities: [a*b]";
        derive(&format!("assume: [{assume}]\n{lines}")).1
    };
    let result = of("a > 0").identifiability.result.expect("proved");
    assert!(result.singular_where.is_empty() && result.everywhere_else);
    assert_ne!(of("a > 0, b > 0").outcome, Outcome::Accepted);
}

/// With w = 2 nothing shows p, on neither side of which the sign of `w - 2` is.
#[test]
fn parameters_that_vanish_together_in_absolute_values_are_excluded() {
    let judged = |parameters: &str, factor: &str| {
        let lines = format!(
            "parameters: {{{parameters}}}\nx: [c, d]\ny: [q]\nu: [v]\nf_x: {{c: \"v - ({factor})*d\", d: 0}}\n\
             f_y: {{q: c}}\nphi: [c, d]"
        );
        let (plant, derivation) = derive(&lines);
        let listed = derivation.conditions.iter().map(|(expr, _)| plant.arena.print(*expr)).collect::<Vec<_>>();
        (derivation.outcome, listed.join(", "))
    };
    let equal = judged("k: 2, m: 2, l: 2", "sqrt((k - m)^2) + abs(m - l)");
    assert_eq!(equal, (Outcome::Rejected, String::new()));
    for (parameters, factor, condition) in [
        ("k: null, m: null", "abs(k) + abs(m)", "m^2 + k^2"),
        ("k: null, m: null", "max(abs(k), abs(m))", "k^2 + m^2"),
        ("k: 1, m: 2", "abs(k - m) + abs(k - 3)", "(m - 3)^2 + (k - m)^2"),
    ] {
        assert_eq!(judged(parameters, factor), (Outcome::Accepted, condition.to_owned()), "{factor}");
    }
}

#[test]
fn values_between_the_signs_of_a_parameter_are_conditions() {
    let of = |rate: &str| {
        let lines = "parameters: {w: 3}\nx: [p, s]\ny: [q]\nu: [v]\nf_x: {p: 0, s: 0}\nphi: [p, s]";
        let (plant, derivation) = derive(&format!("{lines}\nf_y: {{q: \"{rate}\"}}"));
        let result = derivation.identifiability.result.expect("proved");
        let lines = result.trajectories.expect("over time").lines(&plant);
        assert!(!lines.iter().any(|line| line.contains("w = 2")), "a condition excludes it: {lines:#?}");
        result.constants.iter().map(|constant| plant.arena.print(*constant)).collect::<Vec<_>>()
    };
    for rate in ["p*max(v*(w - 2), 0) + s", "p*v*abs(w - 2) + s"] {
        assert_eq!(of(rate), ["w - 2"], "{rate}");
    }
    assert_eq!(of("p*v*abs(w - 2) + s*v^2*abs(w - 1)"), ["w - 2", "w - 1"]);
    for rate in ["p*v*max(w - 2, 1) + s", "p*v*(abs(w - 2) + 1) + s", "p*max(w*v, v) + s*v^2"] {
        assert_eq!(of(rate), [""; 0], "{rate}");
    }
}

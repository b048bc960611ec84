//! Plants by class: expansions, refusals, and the agreement of two forms of a condition.

use std::fmt::Write as _;
use std::time::Instant;

use pebo_cas::Expr;
use pebo_cas::domain::zero::is_zero;
use pebo_gen::analysis::{Class, Excitation, Outcome, RegressionKind, Verdict};
use pebo_gen::report::summary;
use pebo_gen::source::{Code, Diagnostic, Source};
use pebo_gen::{Derived, derive};

fn read(lines: &str) -> Result<Derived, Vec<Diagnostic>> {
    derive(&Source::new("m", format!("model: m\n{lines}\n")).expect("a text"))
}

fn derived(lines: &str) -> Derived {
    read(lines).unwrap_or_else(|d| panic!("{lines}: {}", d[0].message))
}

fn printed(derived: &Derived, exprs: &[Expr]) -> Vec<String> {
    exprs.iter().map(|e| derived.plant.arena.print(*e)).collect()
}

/// All that is said beside the first diagnostic of a code.
fn words(derived: &Derived, code: Code) -> String {
    let found = derived.derivation.diagnostics.iter().find(|d| d.code == code);
    let found = found.unwrap_or_else(|| panic!("{code:?} is not among {:?}", derived.derivation.diagnostics));
    assert!(found.help.is_some());
    format!("{}\n{}\n{}", found.message, found.primary.text, found.notes.join("\n"))
}

// Linear plants: Proposition 2.

/// Claim C1: observable, yet no transform; with and without values.
#[test]
fn an_observable_linear_plant_may_have_no_transform() {
    for parameters in ["[a1, a2, a, b]", "{a1: -1, a2: -2, a: 1, b: 1}", "{a1: -1, a2: 3, a: 1, b: -2}"] {
        let plant = derived(&format!(
            "x: [x1, x2]\ny: [y]\nclass: pebo\nparameters: {parameters}\nlti: {{A11: [[a1, 0], [0, a2]], A21: [[a, b]]}}"
        ));
        assert_eq!(plant.derivation.outcome, Outcome::Rejected);
        assert_eq!(plant.derivation.cascade.verdict, Verdict::Refuted);
        let words = words(&plant, Code::CascadeRefuted);
        assert!(words.contains("no PEBO exists") && words.contains("the plant is observable"), "{words}");
    }
    // A rotation has a generalised cascade, but no transform of this kind.
    let turning =
        |class: &str| derived(&format!("x: [a, b]\ny: [y]\n{class}lti: {{A11: [[0, 1], [-1, 0]], A21: [[1, 0]]}}"));
    let (plain, either) = (turning("class: pebo\n").derivation, turning("").derivation);
    assert_eq!((plain.outcome, plain.class), (Outcome::Rejected, Class::Pebo));
    assert_eq!((either.outcome, either.class), (Outcome::Accepted, Class::Gpebo));
    // Neither observable nor with a transform: the generalised observer's theta is not identifiable.
    let blind =
        |class: &str| derived(&format!("x: [a, b]\ny: [y]\n{class}lti: {{A11: [[-1, 0], [0, -2]], A21: [[1, 0]]}}"));
    for (class, code) in [("class: pebo\n", Code::CascadeRefuted), ("", Code::NeverIdentifiable)] {
        let words = words(&blind(class), code);
        assert!(words.contains("not observable") && words.contains("s = -2, along x = (0, 1)"), "{words}");
    }
}

/// Claim C2: a transform, but no observability.
#[test]
fn a_transform_does_not_make_a_linear_plant_observable() {
    let plant = derived("x: [x]\ny: [y]\nu: [v]\nparameters: [a]\nlti: {A11: 0, A21: 0, A22: a, B1: 1}");
    assert_eq!(plant.derivation.cascade.verdict, Verdict::Proved);
    assert_eq!(plant.derivation.identifiability.result.as_ref().expect("a result").kind, Excitation::Never);
    let words = words(&plant, Code::NeverIdentifiable);
    assert!(words.contains("loses rank at s = 0, along x = (1)") && words.contains("cannot be recovered"), "{words}");
}

/// Values at which ranks are special are special: parameters are what they are in the file.
#[test]
fn ranks_are_those_at_the_values() {
    let lines = |k: &str| format!("x: [x]\ny: [y]\nclass: pebo\nparameters: {{k: {k}, a: 2}}\nlti: {{A11: a, A21: k}}");
    let seen = derived(&lines("1"));
    assert_eq!(seen.derivation.outcome, Outcome::Accepted);
    let unseen = derived(&lines("0"));
    assert_eq!((unseen.derivation.outcome, unseen.derivation.cascade.verdict), (Outcome::Rejected, Verdict::Refuted));
    // In general rows of A11 are no multiples of A21; at these values they are.
    let special = |b: &str| {
        derived(&format!(
            "x: [p, q]\ny: [s, r]\nparameters: {{a: 1, b: {b}}}\n\
             lti: {{A11: [[a, 1], [0, 0]], A21: [[b, 1], [2, 2]]}}"
        ))
    };
    assert_eq!(special("1").derivation.cascade.verdict, Verdict::Proved);
    assert_eq!(special("1").derivation.outcome, Outcome::Rejected);
    assert_eq!(special("3").derivation.outcome, Outcome::Accepted);
}

/// A verdict names the values that it depends on, or the parameters that must not vanish.
#[test]
fn special_values_are_named() {
    let seen_through = |parameters: &str, a21: &str| {
        let plant = derived(&format!("x: [x]\ny: [y]\nparameters: {parameters}\nlti: {{A11: a, A21: {a21}}}"));
        summary(&plant.plant, &plant.derivation)
    };
    let report = |parameters: &str| seen_through(parameters, "k");
    let special = "the verdict holds for `k = 3`, `a = 2`: with general values, some matrix ranks are different";
    assert!(seen_through("{k: 3, a: 2}", "k - 3").contains(special));
    for general in ["{k: 3, a: 2}", "[k, a]"] {
        assert!(!report(general).contains("ranks"), "{general}");
    }
    assert!(report("[k, a]").contains("\n  conditions                k != 0\n"));
    assert!(!report("{k: 3, a: 2}").contains("  conditions "));
}

/// Claim C3, with T1 and T2 derived; the regression is the paper's.
#[test]
fn a_linear_plant_has_the_regression_of_claim_c3() {
    let plant = derived(
        "x: [x1, x2]\ny: [y1, y2]\nu: [v]\nparameters: {a: 2, b: 3}\n\
         lti: {A11: [[0, a], [-1, b]], A12: [[1, 0], [0, 1]], A21: [[1, 0], [1, 2]], A22: [[-1, 0], [0, -1]], \
         B1: [0, 1], B2: [[1], [0]]}",
    );
    assert_eq!(plant.derivation.outcome, Outcome::Accepted);
    assert_eq!(printed(&plant, &plant.plant.transform()), ["x1 - a*y2/2 + a*y1/2", "x2 - b*y2/2 + y1*(b + 2)/2"]);
    let regression = plant.derivation.regression.result.as_ref().expect("a regression");
    assert_eq!(printed(&plant, &regression.phi_1.concat()), ["1", "0", "1", "2"]);
}

/// Claim C3 with more components than states: theta is not identifiable, x is recovered all the same.
#[test]
fn a_redundant_transform_loses_theta_but_not_x() {
    let plant = derived("x: [x]\ny: [y]\nu: [v]\nlti: {A11: 0, A21: 1, B1: 1, T1: [1, 2]}");
    assert_eq!(plant.derivation.outcome, Outcome::Rejected);
    let regression = plant.derivation.regression.result.as_ref().expect("a regression");
    assert_eq!(printed(&plant, &regression.phi_1.concat()), ["1/5", "2/5"]);
    assert!(words(&plant, Code::NeverIdentifiable).contains("x is recoverable although theta is not"));
    // T1 of too small a rank is no transform; a T that does not solve the equation is no cascade.
    let flat = derived("x: [p, q]\ny: [y]\nlti: {A11: [[0, 0], [0, 0]], A21: [[1, 1]], T1: [[1, 1], [2, 2]]}");
    assert_eq!(flat.derivation.left_inverse.verdict, Verdict::Refuted);
    let other =
        derived("x: [p]\ny: [y]\nclass: pebo\nparameters: [a]\nassume: [a > 0]\nlti: {A11: a, A21: 1, T1: 1, T2: 1}");
    assert_eq!(other.derivation.cascade.verdict, Verdict::Refuted);
}

// Mechanical plants: Assumption 3.

/// Inertia matrix, frame, assumptions on positions, and whether the frame's columns are Killing fields.
const FRAMES: &[(&str, &str, &str, bool)] = &[
    // Constant metrics: translations in any constant frame.
    ("[[2, 1], [1, 3]]", "[[1, 0], [0, 1]]", "", true),
    ("[[2, 1], [1, 3]]", "[[1, 4], [-2, 1]]", "", true),
    // A constant metric's rotation is a Killing field too.
    ("[[1, 0], [0, 1]]", "[[1, -q2], [0, q1]]", "q1 > 0", true),
    ("[[2, 0], [0, 1]]", "[[1, -q2], [0, q1]]", "q1 > 0", false),
    // The plane in polar coordinates: translations; the rotation alone; the radius is none.
    ("[[1, 0], [0, q1^2]]", "[[cos(q2), sin(q2)], [-sin(q2)/q1, cos(q2)/q1]]", "q1 > 0", true),
    ("[[1, 0], [0, q1^2]]", "[[cos(q2), 0], [-sin(q2)/q1, 1]]", "q1 > 0", true),
    ("[[1, 0], [0, q1^2]]", "[[1, 0], [0, 1]]", "q1 > 0", false),
    ("[[1, 0], [0, q1^2]]", "[[cos(q2), sin(q2)], [sin(q2)/q1, cos(q2)/q1]]", "q1 > 0", false),
    // Orthonormal, but not along Killing fields: not every frame of a flat metric will do.
    ("[[1, 0], [0, q1^2]]", "[[1, 0], [0, 1/q1]]", "q1 > 0", false),
    // The sphere: rotations.
    ("[[1, 0], [0, sin(q1)^2]]", "[[cos(q2), 0], [-cos(q1)*sin(q2)/sin(q1), 1]]", "sin(q1) > 0", true),
    ("[[1, 0], [0, sin(q1)^2]]", "[[1, 0], [0, 1/sin(q1)]]", "sin(q1) > 0", false),
    // The cart-pendulum, flat, with the frame that shows it and with others.
    (
        "[[1, b*cos(q1)], [b*cos(q1), c]]",
        "[[1/sqrt(1 - b^2*cos(q1)^2/c), 0], [-b*cos(q1)/(c*sqrt(1 - b^2*cos(q1)^2/c)), 1/sqrt(c)]]",
        "b^2 < c",
        true,
    ),
    ("[[1, b*cos(q1)], [b*cos(q1), c]]", "[[1, 0], [0, 1]]", "b^2 < c", false),
    ("[[1, b*cos(q1)], [b*cos(q1), c]]", "[[1, 0], [-b*cos(q1)/c, 1]]", "b^2 < c", false),
    // Acrobot, and the two-link arm, which has one cyclic angle only.
    ("[[c + 2*b*cos(q2), 1 + b*cos(q2)], [1 + b*cos(q2), 1]]", "[[1, 0], [0, 1]]", "b^2 < c - 1", false),
    ("[[c + 2*b*cos(q2), 1 + b*cos(q2)], [1 + b*cos(q2), 1]]", "[[1, 1], [0, 1]]", "b^2 < c - 1", false),
];

#[test]
fn a_frame_of_killing_fields_is_accepted_and_no_other() {
    for (m, t, assume, valid) in FRAMES {
        let assume = if assume.is_empty() { String::new() } else { format!("assume: [b > 0, c > 0, {assume}]\n") };
        // Values for which each matrix is an inertia matrix.
        let plant = derived(&format!(
            "x: [p1, p2]\ny: [q1, q2]\nu: [f]\nparameters: {{b: 0.5, c: 3}}\n{assume}\
             mechanical:\n  M: {m}\n  V: cos(q1)*q2\n  G: [[1], [0]]\n  T: {t}"
        ));
        let verdict = plant.derivation.cascade.verdict;
        assert_eq!(verdict, if *valid { Verdict::Proved } else { Verdict::Refuted }, "M {m}, T {t}");
        if !valid {
            assert!(words(&plant, Code::CascadeRefuted).contains("B_("), "M {m}, T {t}");
            continue;
        }
        assert_eq!(plant.derivation.outcome, Outcome::Accepted, "M {m}, T {t}: {:?}", plant.derivation.diagnostics);
        // The derivative along the expanded plant, term by term, is the h that the class gives.
        let (arena, domain) = (&plant.plant.arena, plant.plant.domain());
        let h = &plant.derivation.cascade.result.as_ref().expect("a cascade").h;
        for (rate, h) in plant.plant.derivative_of_transform().iter().zip(h) {
            assert!(is_zero(arena, arena.sub(*rate, *h), &domain), "M {m}, T {t}: {}", arena.print(*h));
        }
    }
}

#[test]
fn a_two_link_arm_is_refused_with_the_entries_that_stand_against_it() {
    let plant = derived(
        "x: [p1, p2]\ny: [q1, q2]\nu: [a, b]\nparameters: {m1: 3, m2: 1, c: 0.5}\nmechanical:\n  \
         M: [[m1 + 2*c*cos(q2), m2 + c*cos(q2)], [m2 + c*cos(q2), m2]]\n  V: 0\n  G: [[1, 0], [0, 1]]\n  \
         T: [[1, 0], [0, 1]]",
    );
    let found = words(&plant, Code::CascadeRefuted);
    // The first angle is cyclic, the second is not.
    assert!(found.contains("component 2") && !found.contains("component 1"), "{found}");
    for entry in ["(1, 1)", "(1, 2)", "(2, 2)"] {
        assert!(found.contains(&format!("B_(2) + B_(2)' has the nonzero entry {entry}")), "{found}");
    }
}

/// So many point masses in a plane, each held by the one before at a length and an angle that are free.
///
/// T is the inverse of the Jacobian of their Cartesian positions, in which the metric is constant.
fn chain(masses: usize) -> String {
    let names: Vec<(char, usize)> = (1..=masses).flat_map(|j| [('r', j), ('q', j)]).collect();
    let mass = |from: usize| {
        let sum: Vec<String> = (from..=masses).map(|k| format!("m{k}")).collect();
        format!("({})", sum.join(" + "))
    };
    let inertia = |(s, i): (char, usize), (t, j): (char, usize)| {
        let m = mass(i.max(j));
        match (s, t) {
            ('r', 'r') => format!("{m}*cos(q{i} - q{j})"),
            ('r', _) => format!("{m}*r{j}*sin(q{i} - q{j})"),
            (_, 'r') => format!("{m}*r{i}*sin(q{j} - q{i})"),
            _ => format!("{m}*r{i}*r{j}*cos(q{i} - q{j})"),
        }
    };
    let frame = |(s, j): (char, usize), column: usize| {
        let (k, along_x) = (column / 2 + 1, column.is_multiple_of(2));
        let entry = match (s, along_x) {
            ('r', true) => format!("cos(q{j})"),
            ('r', false) => format!("sin(q{j})"),
            (_, true) => format!("(-sin(q{j})/r{j})"),
            _ => format!("cos(q{j})/r{j}"),
        };
        if k == j {
            entry
        } else if k + 1 == j {
            format!("-{entry}")
        } else {
            "0".to_owned()
        }
    };
    let rows = |entry: &dyn Fn((char, usize), usize) -> String| {
        let row = |&name: &(char, usize)| {
            format!("[{}]", (0..names.len()).map(|c| entry(name, c)).collect::<Vec<_>>().join(", "))
        };
        format!("[{}]", names.iter().map(row).collect::<Vec<_>>().join(", "))
    };
    let y: Vec<String> = names.iter().map(|(s, j)| format!("{s}{j}")).collect();
    let list = |prefix: &str| y.iter().map(|name| format!("{prefix}{name}")).collect::<Vec<_>>().join(", ");
    let heights: Vec<String> = (1..=masses).map(|k| format!("{}*r{k}*sin(q{k})", mass(k))).collect();
    let mut text = String::new();
    let masses = 1..=masses;
    let values: Vec<String> = masses.clone().map(|k| format!("m{k}: {k}")).collect();
    let lengths: Vec<String> = masses.map(|k| format!("r{k} > 0")).collect();
    writeln!(text, "x: [{}]\ny: [{}]\nu: [{}]", list("p_"), list(""), list("f_")).expect("a string");
    writeln!(text, "parameters: {{g: 9.81, {}}}\nassume: [{}]", values.join(", "), lengths.join(", "))
        .expect("a string");
    let identity = rows(&|name, column| i32::from(names[column] == name).to_string());
    write!(
        text,
        "mechanical:\n  M: {}\n  V: g*({})\n  G: {identity}\n  T: {}",
        rows(&|name, column| inertia(name, names[column])),
        heights.join(" + "),
        rows(&frame)
    )
    .expect("a string");
    text
}

/// Assumption 3 in any number of degrees of freedom; the time is printed.
#[test]
fn chains_of_point_masses_satisfy_assumption_3() {
    for masses in [2, 4, 6] {
        let text = chain(masses);
        let start = Instant::now();
        let plant = derived(&text);
        let degrees = 2 * masses;
        println!("{masses} masses, {degrees} degrees of freedom: {:?}", start.elapsed());
        assert_eq!(plant.derivation.outcome, Outcome::Accepted, "{:?}", plant.derivation.diagnostics);
        assert_eq!(plant.plant.x.len(), degrees);
        // The last column off by a factor that moves is no Killing field.
        let wrong = text.replace(&format!("cos(q{masses})/r{masses}]"), &format!("cos(q{masses})]"));
        assert_ne!(wrong, text);
        assert_eq!(derived(&wrong).derivation.cascade.verdict, Verdict::Refuted);
    }
}

/// Elimination would go on for hours in the equations of a chain in motion: it rests at zero momenta, whatever its
/// positions are that the forces hold.
#[test]
fn a_chain_of_point_masses_has_equilibria_where_it_is_held() {
    let chain = derived(&chain(4));
    let report = summary(&chain.plant, &chain.derivation);
    for line in ["operating point           p_r1 = 0", "p_q4 = 0", "f_q4 = g*m4*r4*cos(q4)", "h = 0 there"] {
        assert!(report.contains(line), "{line}:\n{report}");
    }
}

/// Two masses, each at the end of two links, with T the inverse of the Jacobian of their positions.
///
/// Over one denominator, the rates of the outputs would be divided by `sin(2*q1 + q2)`, which is zero in harmless
/// postures.
const FOUR_LINKS: &str = r"x: [p1, p2, p3, p4]
y: [q1, q2, q3, q4]
u: [u1, u2, u3, u4]
assume: [sin(q2) > 0, sin(q4) > 0]
define:
  q12: q1 + q2
  q123: q12 + q3
  q1234: q123 + q4
  ax: sin(q1) + sin(q12)
  ay: cos(q1) + cos(q12)
  bx: sin(q123) + sin(q1234)
  by: cos(q123) + cos(q1234)
  ra1: ((ax + bx)*cos(q12) - (sin(q12) + bx)*ay)/sin(q2)
  ra2: ((ax + bx)*sin(q12) - (sin(q12) + bx)*ax)/sin(q2)
  rb1: ((ay + by)*cos(q12) - (cos(q12) + by)*ay)/sin(q2)
  rb2: ((ay + by)*sin(q12) - (cos(q12) + by)*ax)/sin(q2)
mechanical:
  M: [[ax^2 + ay^2 + (ax + bx)^2 + (ay + by)^2, ax*sin(q12) + ay*cos(q12) + (ax + bx)*(sin(q12) + bx) + (ay + by)*(cos(q12) + by), (ax + bx)*bx + (ay + by)*by, (ax + bx)*sin(q1234) + (ay + by)*cos(q1234)],
      [ax*sin(q12) + ay*cos(q12) + (ax + bx)*(sin(q12) + bx) + (ay + by)*(cos(q12) + by), 1 + (sin(q12) + bx)^2 + (cos(q12) + by)^2, (sin(q12) + bx)*bx + (cos(q12) + by)*by, (sin(q12) + bx)*sin(q1234) + (cos(q12) + by)*cos(q1234)],
      [(ax + bx)*bx + (ay + by)*by, (sin(q12) + bx)*bx + (cos(q12) + by)*by, bx^2 + by^2, bx*sin(q1234) + by*cos(q1234)],
      [(ax + bx)*sin(q1234) + (ay + by)*cos(q1234), (sin(q12) + bx)*sin(q1234) + (cos(q12) + by)*cos(q1234), bx*sin(q1234) + by*cos(q1234), 1]]
  V: 9*(2*ax + bx)
  G: [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]
  T: [[cos(q12)/sin(q2), sin(q12)/sin(q2), 0, 0],
      [-ay/sin(q2), -ax/sin(q2), 0, 0],
      [(cos(q1234)*ra1 - sin(q1234)*rb1)/sin(q4), (cos(q1234)*ra2 - sin(q1234)*rb2)/sin(q4), cos(q1234)/sin(q4), sin(q1234)/sin(q4)],
      [(bx*rb1 - by*ra1)/sin(q4), (bx*rb2 - by*ra2)/sin(q4), -by/sin(q4), -bx/sin(q4)]]";

#[test]
fn a_plant_has_the_denominators_of_its_frame() {
    let links = derived(FOUR_LINKS);
    assert_eq!(links.derivation.outcome, Outcome::Accepted, "{:?}", links.derivation.diagnostics);
    assert_eq!(links.derivation.conditions.len(), 0);
    // Along the horizontal, weight does nothing, and does not stand in the formula either. Along the vertical it is
    // that of the mass, and not divided.
    let cascade = links.derivation.cascade.result.as_ref().expect("a cascade");
    assert_eq!(
        printed(&links, &cascade.h)[2..],
        [
            "u3*cos(q1 + q2 + q3 + q4)/sin(q4) + u4*(-cos(q1 + q2 + q3) - cos(q1 + q2 + q3 + q4))/sin(q4)",
            "u3*sin(q1 + q2 + q3 + q4)/sin(q4) + u4*(-sin(q1 + q2 + q3) - sin(q1 + q2 + q3 + q4))/sin(q4) - 9",
        ]
    );
    // At q1 = -q2/2 and without the assumptions the same, but for the postures at which T has no value.
    let (_, without) = FOUR_LINKS.split_once("assume: [sin(q2) > 0, sin(q4) > 0]\n").expect("assumptions");
    let head = &FOUR_LINKS[..FOUR_LINKS.find("assume").expect("assumptions")];
    let links = derived(&format!("{head}{without}"));
    let conditions: Vec<Expr> = links.derivation.conditions.iter().map(|(expr, _)| *expr).collect();
    assert_eq!(printed(&links, &conditions), ["sin(q2)", "sin(q4)"]);
}

// Electromechanical plants.

const MOTOR: &str = "x: [q]\ny: [i1, i2]\nu: [v1, v2]\nw: [omega]\nparameters: [R, L, n_p, lambda_m]\n\
    assume: [L > 0, lambda_m > 0, n_p > 0]\nangles: {q: 2*pi/n_p}\n\
    electromechanical: {L: [L, L], mu: ['lambda_m*cos(n_p*q)', 'lambda_m*sin(n_p*q)'], R: R, speed: omega}";

#[test]
fn the_circle_of_fluxes_is_found() {
    let motor = derived(MOTOR);
    assert_eq!(motor.derivation.outcome, Outcome::Accepted, "{:?}", motor.derivation.diagnostics);
    let regression = motor.derivation.regression.result.as_ref().expect("a regression");
    assert_eq!(regression.kind, RegressionKind::Implicit);
    assert_eq!(printed(&motor, &regression.eta), ["theta1", "theta2"]);
    assert_eq!(printed(&motor, &regression.phi_1.concat()), ["v1 - R*i1", "v2 - R*i2"]);
    assert_eq!(printed(&motor, &regression.primitive_1.concat()), ["L*i1", "L*i2"]);
    let line = "as it stands it is a regression in 3 unknowns, with `regression: static`";
    assert!(summary(&motor.plant, &motor.derivation).contains(line));
    // As it is.
    let motor = derived(&format!("regression: static\n{MOTOR}"));
    let regression = motor.derivation.regression.result.as_ref().expect("a regression");
    assert_eq!(regression.kind, RegressionKind::Static);
    assert_eq!(printed(&motor, &regression.eta), ["theta1", "theta2", "lambda_m^2 - theta1^2 - theta2^2"]);
    assert_eq!(printed(&motor, &regression.phi_1.concat()), ["-2*(chi1 - L*i1)", "-2*(chi2 - L*i2)", "1"]);
    // A salient machine has no such circle with these coefficients; nothing is claimed.
    let salient = MOTOR.replace(
        "L: [L, L]",
        "L: [[L + L*cos(2*n_p*q)/4, L*sin(2*n_p*q)/4], \
                                               [L*sin(2*n_p*q)/4, L - L*cos(2*n_p*q)/4]]",
    );
    assert_ne!(salient, MOTOR);
    assert_ne!(derived(&salient).derivation.outcome, Outcome::Accepted);
}

#[test]
fn a_measured_speed_gives_its_own_row() {
    let measured = MOTOR
        .replace("y: [i1, i2]", "y: [i1, i2, omega]")
        .replace("w: [omega]\n", "")
        .replace("speed: omega}", "speed: omega, inertia: j, friction: f, load: tau}")
        .replace("lambda_m]\n", "lambda_m, j, f, tau]\n");
    let motor = derived(&measured);
    assert_eq!(motor.derivation.outcome, Outcome::Accepted, "{:?}", motor.derivation.diagnostics);
    let regression = motor.derivation.regression.result.as_ref().expect("a regression");
    assert_eq!((regression.kind, regression.rows()), (RegressionKind::Dynamic, vec![0, 1, 2]));
    assert_eq!(
        printed(&motor, &regression.phi_1.concat()),
        ["0", "n_p*omega/L", "-n_p*omega/L", "0", "n_p*i2/j", "-n_p*i1/j"]
    );
    // As an input its rate is not known, and not needed.
    let input = MOTOR.replace("w: [omega]\n", "").replace("u: [v1, v2]", "u: [v1, v2, omega]");
    let motor = derived(&input);
    assert_eq!(motor.derivation.regression.result.as_ref().expect("a regression").rows(), [0, 1]);
}

// Regressions with the unknown under the derivative.

/// The levitated ball: `d/dt (z i) = 2 i (U - R i) - v z^2/k` at z = chi + theta.
#[test]
fn the_flux_of_a_levitated_ball_multiplies_a_rate() {
    let ball = derived(
        "x: [q]\ny: [i]\nu: [U, v]\nparameters: [R, k, c]\nassume: [k > 0, c - q > 0, i > 0]\n\
         electromechanical: {coils: 1, L: k/(c - q), R: R, speed: v}",
    );
    assert_eq!(ball.derivation.outcome, Outcome::Accepted, "{:?}", ball.derivation.diagnostics);
    let regression = ball.derivation.regression.result.as_ref().expect("a regression");
    assert_eq!(regression.kind, RegressionKind::Implicit);
    assert_eq!(printed(&ball, &regression.eta), ["theta1", "theta1^2"]);
    assert_eq!(printed(&ball, &regression.primitive_0), ["i*chi1"]);
    assert_eq!(printed(&ball, &regression.primitive_1.concat()), ["i", "0"]);
    let arena = &ball.plant.arena;
    let [i, u, r, k, v] = ["i", "U", "R", "k", "v"].map(|name| arena.variable(name));
    let chi = arena.of_symbol(ball.plant.chi[0]);
    // 2 i (U - R i) - v chi^2/k, and its slopes in theta and theta^2.
    let driven = arena.product([arena.number(2), i, arena.sub(u, arena.mul(r, i))]);
    let expected = [
        arena.sub(driven, arena.div(arena.product([v, chi, chi]), k)),
        arena.div(arena.product([arena.number(-2), v, chi]), k),
        arena.neg(arena.div(v, k)),
    ];
    let found = [regression.phi_0[0], regression.phi_1[0][0], regression.phi_1[0][1]];
    for (found, expected) in found.into_iter().zip(expected) {
        assert!(is_zero(arena, arena.sub(found, expected), &ball.plant.domain()), "{}", arena.print(found));
    }
    // Its speed alone shows the ball only while it moves.
    assert_eq!(ball.derivation.identifiability.result.as_ref().expect("a result").kind, Excitation::Excitation);
}

#[test]
fn a_rate_has_a_primitive_or_is_refused() {
    let kind = |rate: &str| {
        let plant = derived(&format!(
            "x: [x]\ny: [y]\nu: [u]\nassume: [x > 0, y > 0]\nf_x: {{x: u}}\nf_y: {{y: {rate}}}\nphi: [x]"
        ));
        let regression = plant.derivation.regression.result.as_ref().map(|regression| regression.kind);
        (plant.derivation.outcome, regression)
    };
    let implicit = (Outcome::Accepted, Some(RegressionKind::Implicit));
    // (x + y) y' = u has the primitive x y + y^2/2.
    for rate in ["u/x", "x/(1 + x)", "u/(x + y)", "(u + x)/(x + x*y^2 + 1)"] {
        assert_eq!(kind(rate), implicit, "{rate}");
    }
    // No primitive: the factor of the rate depends on the input, is no polynomial in y, mixes theta with signals, or is
    // not affine in the unknown.
    let refused =
        ["u/(x + u)", "u/(x + exp(y))", "u/(x + log(y))", "1/(1 + exp(-x^2))", "1/(1 + exp(x*y))", "u/(1 + x^2)"];
    for rate in refused {
        assert_ne!(kind(rate).0, Outcome::Accepted, "{rate}");
    }
}

// Mistakes.

#[test]
fn each_mistake_has_its_diagnostic() {
    let linear = "x: [a, b]\ny: [y]\nu: [v]\nlti: {A11: [[0, 0], [0, 0]], A21: [[1, 0]]}";
    let mechanical =
        "x: [p1, p2]\ny: [q1, q2]\nu: [f]\nmechanical: {M: [[1, 0], [0, 1]], V: q1, G: [1, 0], T: [[1, 0], [0, 1]]}";
    let cases = [
        (linear, "A21: [[1, 0]]", "A21: [[1, 0, 0]]", Code::WrongShape, "[[1, 0, 0]]"),
        (linear, "A21: [[1, 0]]", "A21: [[1, 0], [1]]", Code::WrongShape, "[1]"),
        (linear, "A21: [[1, 0]]", "A21: [[1, 0], 1]", Code::WrongShape, "1"),
        (linear, "A21: [[1, 0]]", "A21: []", Code::EmptyList, "[]"),
        (linear, "A21: [[1, 0]]", "A21: 1", Code::WrongShape, "1"),
        (linear, "A21: [[1, 0]]", "A21: [[1, y]]", Code::MisplacedName, "y"),
        (linear, "A21: [[1, 0]]", "A21: [[1, k]]", Code::UnknownName, "k"),
        (linear, ", A21: [[1, 0]]", "", Code::MissingKey, "{A11: [[0, 0], [0, 0]]}"),
        (linear, "A21: [[1, 0]]", "A21: [[1, 0]], A23: 1", Code::UnknownKey, "A23"),
        (linear, "A21: [[1, 0]]", "A21: [[1, 0]], T2: 1", Code::MissingKey, "1"),
        (linear, "lti:", "f_x: {a: 0}\nlti:", Code::ClassConflict, "f_x"),
        (linear, "lti:", "phi: [a]\nlti:", Code::ClassConflict, "phi"),
        (linear, "lti:", "lti: {A11: 0, A21: 0}\nmechanical:", Code::ClassConflict, "mechanical"),
        (mechanical, "M: [[1, 0], [0, 1]]", "M: [[1, 2], [0, 1]]", Code::NotSymmetric, "[[1, 2], [0, 1]]"),
        (mechanical, "M: [[1, 0], [0, 1]]", "M: [[1, 1], [1, 1]]", Code::SingularMatrix, "[[1, 1], [1, 1]]"),
        (mechanical, "T: [[1, 0], [0, 1]]", "T: [[q1, q1], [1, 1]]", Code::SingularMatrix, "[[q1, q1], [1, 1]]"),
        (mechanical, "V: q1", "V: p1", Code::MisplacedName, "p1"),
        (mechanical, "x: [p1, p2]", "x: [p1]", Code::WrongShape, "p1"),
        (mechanical, "G: [1, 0]", "G: [1, 0, 0]", Code::WrongShape, "[1, 0, 0]"),
        (MOTOR, "speed: omega", "speed: omgea", Code::UnknownName, "omgea"),
        (MOTOR, "speed: omega", "speed: omega, coils: 3", Code::WrongShape, "3"),
        (MOTOR, "y: [i1, i2]", "y: [omega2, i1, i2]", Code::WrongShape, "[L, L]"),
        (MOTOR, "u: [v1, v2]", "u: [v1]", Code::MissingKey, "[L, L]"),
        (MOTOR, "x: [q]", "x: [q, r]", Code::WrongShape, "r"),
        (MOTOR, "L: [L, L]", "L: [L, i1]", Code::MisplacedName, "i1"),
        (MOTOR, "R: R", "R: q", Code::MisplacedName, "q"),
    ];
    for (base, from, to, code, underlined) in cases {
        assert!(base.contains(from), "{from}");
        let text = format!("model: m\n{}\n", base.replacen(from, to, 1));
        let found = derive(&Source::new("m", text.as_str()).expect("a text")).expect_err(to);
        let place = &text[found[0].primary.span.range()];
        assert_eq!((found[0].code, place), (code, underlined), "{to}: {found:#?}");
        assert!(found[0].help.is_some(), "{to}");
    }
}

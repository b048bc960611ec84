//! Plants, and the report of the trajectories on which their unknowns are hidden.

use crate::analysis::{Derivation, Outcome};
use crate::model::Model;
use crate::plant::Plant;
use crate::source::Source;

/// The report on a plant's trajectories, and the conditions on its parameters.
fn of(lines: &str) -> Vec<String> {
    let text = format!("model: m\n{lines}\n");
    let plant = Plant::resolve(&Model::parse(&Source::new("m", text).unwrap()).unwrap()).unwrap();
    let derivation = Derivation::derive(&plant);
    assert_eq!(derivation.outcome, Outcome::Accepted, "{lines}");
    let result = derivation.identifiability.result.as_ref().expect("proved");
    let mut lines = result.trajectories.as_ref().expect("over time").lines(&plant);
    lines.extend(result.constants.iter().map(|e| format!("{} != 0", plant.arena.print(*e))));
    lines
}

#[test]
fn inputs_that_are_equal_or_constant_may_hide_unknowns() {
    let phases = "parameters: [r]\nx: [a, b]\ny: [v]\nu: [d, e]\nf_x: {a: -r*a - d*v, b: -r*b - e*v}\n\
                  f_y: {v: d*a + e*b}\nphi: [a, b]\nassume: [r > 0";
    let anywhere = format!("{phases}]");
    let expected = [
        "the unknowns are identified under excitation: keep the inputs varying",
        "while the plant rests and `d = 0` and `e = 0`, nothing is identified",
        "while all inputs are constant, only `d*z1 + e*z2` is identified",
        "while `d = e`, only `z1 + z2` is identified",
        "while `d = 0`, only `z2` is identified",
        "while `e = 0`, only `z1` is identified",
        "these were found: there may be other trajectories of this kind",
    ];
    assert_eq!(of(&anywhere), expected);
    // Their variation identifies unknowns that they hide as constants.
    let cells = |outputs: &str| {
        of(&format!(
            "x: [p, s]\ny: [q]\nu: [v, w]\nassume: [v > 0, w > 0]\nf_x: {{p: -v*p, s: -w*s}}\n{outputs}\nphi: [p, s]"
        ))
    };
    for outputs in ["f_y: {q: v*p + s}", "g_y: {q: v*p + s}"] {
        let lines = cells(outputs);
        assert!(
            lines.iter().any(|line| line.starts_with("while all inputs are constant and `v = w`, only")),
            "{lines:?}"
        );
    }
    assert!(cells("f_y: {q: p/w + s}").iter().any(|line| line.contains("are constant and `v = w`")));
    // Assumptions exclude the rest.
    let quotient = "while all inputs are constant, only `z1 + e*z2/d` is identified";
    assert_eq!(of(&format!("{phases}, d > 0, e > d]"))[..2], [expected[0], quotient]);
}

#[test]
fn different_time_constants_tell_unknowns_apart() {
    let cells = "parameters: [r, s]\nassume: [r > 0, s > 0]\nx: [a, b]\ny: [v]\nu: [i]\n\
                 f_x: {a: i - r*a, b: i - s*b}\nf_y: {v: a + b}\nphi: [a, b]";
    assert_eq!(of(cells), ["the unknowns are identified without excitation by the inputs, even at rest", "r - s != 0"]);
}

#[test]
fn a_plant_that_moves_may_need_no_input() {
    let square = "x: [x]\ny: [y]\nu: [u]\nf_x: {x: u}\nf_y: {y: x^2}\nphi: [x]";
    let lines = of(square);
    assert_eq!(lines[0], "the unknowns are identified without excitation by the inputs while the plant moves");
    // The plant rests then, too.
    assert!(lines[1].starts_with("while `u = 0`, only `"), "{lines:?}");
    assert_eq!(lines.len(), 2);
    let turned = "x: [q]\ny: [s]\nu: [v]\nf_x: {q: v}\ng_y: {s: sin(q)}\nphi: [sin(q), cos(q)]\nangles: {q: 2*pi}";
    let lines = of(turned);
    assert_eq!(lines[0], "the unknowns are identified without excitation by the inputs while the plant moves");
    assert_eq!(lines[1], "while `v = 0`, only `z1` is identified, which determines `q` near almost every value");
    let frame = "x: [a, b]\ny: [y]\nu: [w, u]\nf_x: {a: w*b + u, b: -w*a}\nf_y: {y: a}\nphi: [a, b]";
    assert_eq!(
        of(frame),
        [
            "the unknowns are identified without excitation by the inputs, even at rest, but for these trajectories",
            "while `w = 0`, only `z1` is identified"
        ]
    );
}

#[test]
fn losses_under_constant_inputs_at_a_value_of_one_or_of_a_parameter_are_listed() {
    let wind = "x: [a, k]\ny: [p, q]\nu: [v, r]\nassume: [v > 0]\nf_x: {a: 0, k: 0}\n\
                f_y: {p: k*v*cos(q) + a, q: r}\nphi: [a, k]";
    let lines = of(wind);
    assert_eq!(
        lines[0],
        "with constant inputs the unknowns are identified while the plant moves, with others on almost every trajectory"
    );
    assert_eq!(lines[1], "while all inputs are constant and `r = 0`, only `z1 + v*z2*cos(q)` is identified");
    let sum = "parameters: [k, m]\nassume: [k > 0, m > 0, v > 0, w > 0]\nx: [a, b]\ny: [r]\nu: [v, w]\n\
               f_x: {a: -k*a, b: -m*b}\nf_y: {r: v*a + w*b}\nphi: [a, b]";
    let lines = of(sum);
    // With v = exp(k*t) and w = exp(m*t) each of v*a and w*b is constant.
    let others = "even at rest, but for what follows; with others on almost every trajectory";
    assert!(lines[0].ends_with(others), "{lines:?}");
    assert!(lines[1].starts_with("while all inputs are constant and `k = m`, only"), "{lines:?}");
    // q = v is invariant, while r moves.
    let pursuit = "x: [p, s]\ny: [r, q]\nu: [v]\nf_x: {p: -v*p, s: -q*s}\nf_y: {r: p + s, q: q - v}\nphi: [p, s]";
    let lines = of(pursuit);
    assert!(lines.iter().any(|line| line.contains("`q = v`")), "{lines:?}");
}

#[test]
fn inputs_at_which_rows_with_their_derivatives_lose_rank_are_listed() {
    let but = "the unknowns are identified without excitation by the inputs, even at rest, but for these trajectories";
    let cells = |rates: &str| format!("parameters: {{k: 2}}\nx: [a, b]\ny: [r]\nu: [v, w]\n{rates}\nphi: [a, b]");
    let report = |rates: &str| of(&cells(&format!("{rates}\nf_y: {{r: a + b}}")));
    assert_eq!(report("f_x: {a: v*a, b: w*b}"), [but, "while `v = w`, only `z1 + z2` is identified"]);
    assert_eq!(report("f_x: {a: -k*v*a, b: -k*b}"), [but, "while `v = 1`, only `z1 + z2` is identified"]);
    assert_eq!(
        report("f_x: {a: -(1 + v^2)*a, b: -(2 + v)*b}"),
        [but, "while `v*(v - 1) - 1 = 0`, only `z1 + z2` is identified"]
    );
    let turned = "x: [a, b]\ny: [q, r]\nu: [v]\nf_x: {a: q*a, b: -q*b}\nf_y: {q: v, r: a + b}\nphi: [a, b]";
    assert_eq!(of(turned), [but, "while `q = 0` and `v = 0`, only `z1 + z2` is identified"]);
}

/// A grid behind an inverter of unknown gain: a voltage at the grid's frequency may stand for the grid. The rows of a
/// constant one do not show that.
#[test]
fn a_course_of_the_inputs_may_cancel_what_constant_ones_show() {
    let plant = "parameters: {w: 314, L: 0.01}\nx: [e, f, k]\ny: [i]\nu: [v]\nf_x: {e: w*f, f: -w*e, k: 0}\n\
                 f_y: {i: (k*v - e)/L}\nphi: [e, f, k]";
    let lines = of(plant);
    assert_eq!(
        lines,
        [
            "with constant inputs the unknowns are identified, even at rest, but for what follows; with others on almost \
             every trajectory",
            "while `v = 0`, only `z1`, `z2` are identified"
        ]
    );
}

/// A heat exchanger with an unknown area: without a difference of temperatures it transfers nothing, for ever at rest.
#[test]
fn losses_by_several_signals_at_rest_are_listed() {
    let exchanger = "x: [T, k]\ny: [S]\nu: [v, w]\nassume: [k > 0]\nf_x: {T: v - T - k*(T - S), k: 0}\n\
                     f_y: {S: w - S + k*(T - S)}\nphi: [k, k*(T + S)]";
    let lines = of(exchanger);
    assert!(lines[0].ends_with("even at rest, but for these trajectories"), "{lines:?}");
    assert_eq!(lines[1], "while `w - v + 2*k*(T - S) = 0`, only `z2 - 2*S*z1` is identified");
    assert_eq!(lines.len(), 2, "{lines:?}");
}

/// No trajectory is passed over in silence: a statement on all trajectories provably holds on all.
#[test]
fn trajectories_kept_by_several_signals_are_listed_or_not_claimed() {
    let almost = "the unknowns are identified on almost every trajectory, also with constant inputs";
    // A limit cycle, on which q^2 + w^2 is 1.
    let cycle = "x: [p, s]\ny: [q, w, r]\nf_x: {p: 0, s: 0}\nphi: [p, s]\n\
                 f_y: {q: w + q*(1 - q^2 - w^2), w: -q + w*(1 - q^2 - w^2), r: p + s*(q^2 + w^2)}";
    let lines = of(cycle);
    assert!(lines.contains(&"while `q^2 + w^2 - 1 = 0`, only `z1 + z2` is identified".to_owned()), "{lines:?}");
    // Two axes, one of which may hold still.
    let axes = "x: [a, g, b, k]\ny: [q, v, r, w]\nu: [m, n]\nf_x: {a: 0, g: 0, b: 0, k: 0}\n\
                f_y: {q: v, v: m - a*v - g*cos(q), r: w, w: n - b*w - k*cos(r)}\nphi: [a, g, b, k]";
    assert_eq!(of(axes)[0], almost);
}

/// Competing species at the concentration at which both grow alike.
#[test]
fn outputs_at_unobservable_equilibria_are_listed() {
    let species = "x: [p, s]\ny: [q, r]\nu: [v]\nf_x: {p: -q*p, s: -s}\nf_y: {q: v - q, r: p + q*s}\nphi: [p, s]";
    let lines = of(species);
    // On 0 < q < 1 the input makes q grow as it likes.
    assert!(lines.contains(&"while `v - q*(2 - q) = 0`, only `z1 + q*z2` is identified".to_owned()), "{lines:?}");
}

/// The factors of a determinant do not show the values at which functions of signals are equal, or constant, nor those
/// at which several coefficients vanish.
#[test]
fn parameters_that_may_make_functions_of_signals_equal_or_constant_are_spoken_of() {
    let open = "it was not worked out for which special values of the parameters this is not so";
    let report = |rate: &str| {
        let lines = format!(
            "parameters: [k, m]\nx: [p, s]\ny: [q]\nu: [v]\nf_x: {{p: 0, s: 0}}\nf_y: {{q: {rate}}}\nphi: [p, s]"
        );
        of(&lines).iter().any(|line| line == open)
    };
    for rate in ["p*sin(k*v) + s*sin(m*v)", "p*tanh(k*v) + s*v", "p*sqrt(1 + k*v^2) + s", "p*exp(k*v) + s*exp(m*v)"] {
        assert!(report(rate), "{rate}");
    }
    // k = m = 0, which no single equation says.
    assert!(report("p*v + (k + m*q)*s"));
    let both = "parameters: [k, m]\nx: [p, s, r]\ny: [q, w]\nu: [v]\nf_x: {p: s, s: 0, r: 0}\nphi: [p, s, r]";
    for rates in ["{q: m*r, w: p + w*k*r}", "{q: m*r, w: p + v*k*r}", "{q: (m + k)*r, w: p + w*k*r}"] {
        let lines = of(&format!("{both}\nf_y: {rates}"));
        assert!(lines.iter().any(|line| line == open), "{rates}: {lines:?}");
    }
    for rate in ["p*sin(v) + s*cos(v)", "p*k*v + s*sin(v)", "p*tanh(v + k) + s*v"] {
        assert!(!report(rate), "{rate}");
    }
    // k - 2*m and k + m vanish at once only where k does.
    let signed = "parameters: [k, m]\nassume: [k > 0]\nx: [p, s]\ny: [q]\nu: [v, w]\nf_x: {p: 0, s: 0}\nphi: [p, s]";
    let lines = of(&format!("{signed}\nf_y: {{q: p*v + ((k - 2*m)*v^2 + (k + m)*w)*s}}"));
    assert!(!lines.iter().any(|line| line == open), "{lines:?}");
}

/// At r = 0, which is invariant, no input makes s observable.
#[test]
fn outputs_that_no_input_moves_from_a_blind_value_are_listed() {
    let of_rate = |rate: &str| {
        of(&format!(
            "x: [p, s]\ny: [q, r]\nu: [v]\nf_x: {{p: 0, s: 0}}\nf_y: {{q: p*v^2 + s*r*v, r: {rate}}}\nphi: [p, s]"
        ))
    };
    let blind = "while `r = 0`, only `z1` is identified".to_owned();
    for is_invariant in ["0", "-r", "r*(v - q)"] {
        let lines = of_rate(is_invariant);
        assert!(lines.contains(&blind), "{is_invariant}: {lines:?}");
    }
    assert!(of_rate("0")[0].contains("keep the inputs varying"));
    assert!(!of_rate("v").contains(&blind));
}

/// A cell of the domain in which all unknowns are identifiable needs its excitation there too.
#[test]
fn cells_of_the_domain_state_their_excitation() {
    let of_rate = |rate: &str, other: &str| {
        of(&format!("x: [p, s]\ny: [q]\nu: [v]\nf_x: {{p: 0, s: {other}}}\nf_y: {{q: \"{rate}\"}}\nphi: [p, s]"))[0]
            .clone()
    };
    assert!(of_rate("p*max(v, 1) + s", "0").ends_with("keep the inputs varying"));
    assert!(of_rate("p*max(q, 1) + s", "v").contains("neither rests nor stays"));
}

#[test]
fn a_column_that_vanishes_with_functions_of_inputs_is_listed() {
    let constant = |factor: &str| {
        of(&format!("x: [p, s]\ny: [q]\nu: [v, r]\nf_x: {{p: 0, s: 0}}\nf_y: {{q: p*({factor}) + s*r}}\nphi: [p, s]"))
    };
    for (factor, expected) in [
        ("sin(v)", "`sin(v) = 0`, only `z2` is identified"),
        ("1 - cos(v)", "`cos(v) - 1 = 0`, it was not decided what is identified"),
        ("v^2 - 2", "`v^2 - 2 = 0`, only `z2` is identified"),
        ("v^2 + r^2 - 1", "`v^2 + r^2 - 1 = 0`, it was not decided what is identified"),
    ] {
        let lines = constant(factor);
        let expected = format!("while {expected}");
        assert!(
            lines.contains(&expected) && lines.contains(&"while `r = 0`, only `z1` is identified".to_owned()),
            "{lines:?}"
        );
    }
    // None of these vanishes.
    assert!(constant("2 + sin(v)").iter().all(|line| !line.contains("sin(v) + 2 = 0")));
}

#[test]
fn losses_on_each_side_of_a_non_smooth_point_are_listed() {
    let friction = "parameters: [J]\nassume: [J > 0]\nx: [b, fc]\ny: [w]\nu: [tau]\nf_x: {b: 0, fc: 0}\n\
                    f_y: {w: (tau - b*w - fc*sign(w))/J}\nphi: [b, fc]";
    let lines = of(friction);
    for expected in [
        "while `w > 0` and the plant rests, only `z2 + w*z1` is identified",
        "while `w < 0` and the plant rests, only `z2 - w*z1` is identified",
    ] {
        assert!(lines.iter().any(|line| line == expected), "{lines:?}");
    }
    // A result that is the same on both sides is reported for both.
    let lines = of("x: [p, s]\ny: [q]\nu: [v, r]\nf_x: {p: 0, s: 0}\nf_y: {q: p*abs(v) + s*r}\nphi: [p, s]");
    assert!(lines.contains(&"while `r = 0`, only `z1` is identified".to_owned()), "{lines:?}");
    assert!(lines.iter().any(|line| line.starts_with("while `v = 0`")), "{lines:?}");
}

/// "At rest" is said of equilibria that the plant has, and of the rank on them.
#[test]
fn equilibria_are_those_of_the_plant() {
    let moves = "the unknowns are identified while the plant moves";
    let almost = "the unknowns are identified on almost every trajectory, also with constant inputs";
    let growth = "x: [a, k]\ny: [s]\nassume: [a > 0]\nf_x: {a: (s - 1)*a, k: 0}\nf_y: {s: k - a}\nphi: [a, k]";
    assert_eq!(of(growth)[..2], [moves, "while the plant rests, only `z2 - z1` is identified"]);
    // It rests on the border of two cells, in neither of them.
    let hysteresis = "x: [s, h]\ny: [V]\nu: [I]\nf_x: {s: I, h: -abs(I)*h}\nf_y: {V: s + h}\nphi: [s, h]";
    assert_eq!(of(hysteresis)[0], almost);
    assert_eq!(of(hysteresis)[1], "while `I = 0`, only `z1 + z2` is identified");
    // A point that never rests.
    let always = "x: [a, b]\ny: [q, r]\nf_x: {a: 0, b: 0}\nf_y: {q: 1, r: a*q + b}\nphi: [a, b]";
    assert_eq!(of(always), [moves]);
    // Two components: a = 0, with any q, and q = 1.
    let two = "x: [a, k]\ny: [q, r]\nu: [v]\nf_x: {a: (q - 1)*a, k: 0}\nf_y: {q: v, r: a + k}\nphi: [a, k]";
    let lines = of(two);
    assert!(lines[0].ends_with("even at rest, but for these trajectories"), "{lines:?}");
    assert!(
        lines.iter().any(|line| line.contains("q = 1") && line.ends_with("only `z1 + z2` is identified")),
        "{lines:?}"
    );
}

/// Of `|q|*b = v` each side has its own zeros, at which q has the sign of the side, and says so.
/// A curve that is level between two points shows nothing of its argument there.
#[test]
fn a_level_piece_of_a_table_is_listed() {
    let cell = "x: [s]\ny: [V]\nu: [I]\nregression: local\nphi: [s]\nf_x: {s: -I}\ng_y: {V: e - 2*I}\n\
                define: {e: {table: s, points: [[0, 3], [0.3, 3.3], [0.7, 3.3], [1, 3.6]]}}";
    let lines = of(cell);
    let hidden: Vec<&String> = lines.iter().filter(|line| line.contains("nothing is identified")).collect();
    // At its ends it is level too, and a cell may rest there.
    let expected = [
        "while the plant rests and `s = 0.7` and `V = 3.3`, nothing is identified",
        "while the plant rests and `s = 0.3` and `V = 3.3`, nothing is identified",
        "while `s > 0.3` and `s < 0.7`, nothing is identified",
    ];
    assert_eq!(hidden, expected, "{lines:?}");
}

/// Of `r*u = 0` at `r > 0` the factor r has no zero; a mass that a pendulum's position shows wherever it rests is not
/// shown where it hangs.
#[test]
fn what_holds_at_equilibria_is_that_of_all_of_them() {
    let orbit = of("x: [v, h, mu]\ny: [r]\nu: [a, u]\nassume: [r > 0, mu > 0, h > 0]\n\
                    f_x: {v: h^2/r^3 - mu/r^2 + a, h: r*u, mu: 0}\nf_y: {r: v}\nphi: [v, h, mu, h^2]");
    assert!(orbit.contains(&"while the plant rests, only `z1`, `z3 - z4/r` are identified".to_owned()), "{orbit:?}");
    let pendulum = of("x: [w, a, b]\ny: [q]\nu: [u]\nassume: [a > 0, b > 0]\n\
                       f_x: {w: u - a*sin(q) - b*w, a: 0, b: 0}\nf_y: {q: w}\nphi: [w + b*q, b, a]");
    let hanging = "while the plant rests and `sin(q) = 0`, it was not decided what is identified";
    assert!(pendulum.contains(&hanging.to_owned()), "{pendulum:?}");
}

#[test]
fn equilibria_of_a_cell_are_listed_with_its_sides() {
    let plant = "x: [a, b]\ny: [q]\nu: [v, r]\nassume: [v > 0]\nphi: [a, b]\n\
                 f_x: {a: -a, b: \"a + abs(q)*b - v\"}\nf_y: {q: v*q*a + r*b + v^2 + 1}";
    let lines = of(plant);
    let at_rest: Vec<&String> = lines.iter().filter(|line| line.contains("the plant rests and")).collect();
    assert!(!at_rest.is_empty() && at_rest.iter().all(|line| line.contains("`q < 0`")), "{lines:?}");
}

#[test]
fn trajectories_that_hide_more_than_others_are_listed() {
    let spring = |force: &str| {
        of(&format!("x: [v, a, b]\ny: [q]\nu: [f]\nf_x: {{v: f - {force}, a: 0, b: 0}}\nf_y: {{q: v}}\nphi: [v, a, b]"))
    };
    assert_eq!(
        spring("a*q - b*q^3")[1..],
        [
            "while the plant rests, only `z1`, `z2 + q^2*z3` are identified",
            "while the plant rests and `q = 0`, only `z1` is identified"
        ]
    );
    // At q = 0 the combination is b.
    assert_eq!(
        spring("a*sin(q) - b*cos(q)")[1..],
        ["while the plant rests, only `z1`, `z3*cos(q) + z2*sin(q)` are identified"]
    );
    let mass = "x: [m, k]\ny: [q, v]\nu: [f]\nf_x: {m: 0, k: 0}\nf_y: {q: v, v: m*f - k*q}\nphi: [m, k]";
    assert_eq!(
        of(mass)[1..],
        [
            "while the plant rests, only `f*z1 - q*z2` is identified",
            "while the plant rests and `q = 0` and `f = 0`, nothing is identified",
            "while `f = 0`, only `z2` is identified"
        ]
    );
}

#[test]
fn factors_of_unmeasured_states_make_no_combination() {
    let ratio = "x: [a, b]\ny: [q]\nu: [v]\nassume: [a > 0]\nf_x: {a: v, b: 0}\nf_y: {q: b/a}\nphi: [a, b]";
    assert!(of(ratio).contains(&"while `v = 0`, only 1 function of `z1`, `z2` is identified".to_owned()));
}

#[test]
fn a_combination_has_no_factor_that_vanishes_by_an_identity() {
    let bearing = "parameters: [m]\nassume: [m > 0]\nx: [a, b]\ny: [s, p, r]\nu: [v]\nidentities: [p^2 + r^2 - m^2]\n\
                   f_x: {a: v, b: 0}\nf_y: {s: p*a + r*b, p: r*v, r: -p*v}\nphi: [a, b]";
    assert_eq!(of(bearing)[1], "while `v = 0`, only `p*z1 + r*z2` is identified");
}

#[test]
fn trajectories_on_which_a_claim_has_no_value_are_not_listed() {
    let scaled = "x: [a, b]\ny: [s, r]\nu: [w]\nf_x: {a: 0, b: 0}\nf_y: {s: r^3*a*w + b, r: 0}";
    let at_zero = |phi: &str| of(&format!("{scaled}\nphi: {phi}")).iter().any(|line| line.contains("`r = 0`"));
    assert!(at_zero("[a, b]"));
    // The left inverse divides by r.
    assert!(!at_zero("[r*a, b]"));
}

#[test]
fn a_row_without_zeros_excludes_those_of_the_determinant() {
    // Of the determinant of all rows the numerator may vanish with its denominator.
    let cylinder = "parameters: {M: 120, A: 2e-3, B: 1.2e-3, k: 1.2e9, V: 1e-3, D: 300}\nx: [v, f]\ny: [p, q, s]\n\
                    u: [c, d]\nf_x: {v: (A*p - B*q - D*v - f)/M, f: 0}\nphi: [v, f]\n\
                    f_y: {p: k/(V + A*s)*(c - A*v) + k/(V - B*s)*(B*v - d), q: k/(V - B*s)*(B*v - d), s: v}";
    assert_eq!(of(cylinder), ["the unknowns are identified without excitation by the inputs, even at rest"]);
}

#[test]
fn combinations_span_what_is_identified_at_every_point() {
    // With a rotor that stands still, `i*z2` and `i*z1 - z3`: a pivot of the speed says less.
    let motor = "x: [K, R, T]\ny: [i, w]\nu: [v]\nf_x: {K: 0, R: 0, T: 0}\nf_y: {i: v - R*i - K*w, w: K*i - T}\n\
                 phi: [K, R, T]";
    let lines = of(motor);
    assert!(
        lines.contains(&"while the plant rests, only `i*z2 + w*z1`, `i*z1 - z3` are identified".to_owned()),
        "{lines:?}"
    );
    // Any two of three say less where a component of the field is zero.
    let field = "x: [a, b, c]\ny: [k, l, m]\nu: [p, q, r]\nf_x: {a: 0, b: 0, c: 0}\nphi: [a, b, c]\n\
                 f_y: {k: l*(r - c) - m*(q - b), l: m*(p - a) - k*(r - c), m: k*(q - b) - l*(p - a)}";
    let lines = of(field);
    let at_rest = lines.iter().find(|line| line.starts_with("while the plant rests, only")).expect("a line");
    assert_eq!(at_rest.matches("*z").count(), 6, "{lines:?}");
}

#[test]
fn what_is_identified_of_functions_of_theta_may_determine_theta() {
    // A cube that does not move is one function of three: it determines the state all the same.
    let cube = "x: [a]\ny: [q]\nu: [v]\nf_x: {a: v}\nf_y: {q: a^3}\nphi: [a]";
    let lines = of(cube);
    let line = lines.iter().find(|line| line.starts_with("while `v = 0`, only")).expect("a line");
    assert!(line.ends_with("is identified, which determines theta near almost every value"), "{lines:?}");
    // At rest a = 0, and with it the factor by which b is seen.
    let still = "x: [a, b]\ny: [q, v]\nu: [f]\nf_x: {a: f, b: 0}\nf_y: {q: a, v: a*b + a*q*b^2}\nphi: [a, b]";
    let lines = of(still);
    assert!(!lines.iter().any(|line| line.contains("rests") && line.contains("determines")), "{lines:?}");
}

#[test]
fn what_is_identified_of_related_components_may_determine_the_states() {
    // Distance from the origin under a known speed, and an unknown one: seven functions of four states.
    let range = "x: [px, py, cx, cy]\ny: [r]\nu: [wx, wy]\nassume: [r > 0]\n\
                 f_x: {px: wx + cx, py: wy + cy, cx: 0, cy: 0}\ng_y: {r: sqrt(px^2 + py^2)}\n\
                 phi: [px, py, cx, cy, px^2 + py^2, px*cx + py*cy, cx^2 + cy^2]";
    let lines = of(range);
    let line = |start: &str| lines.iter().find(|line| line.starts_with(start)).expect("a line");
    let determined = "are identified, which determine `px`, `py`, `cx`, `cy` near almost every value";
    assert!(line("while `wx` is constant, only").ends_with(determined), "{lines:?}");
    // At rest too, at the states of which the components are functions.
    let pendulum = "x: [p1, p2]\ny: [q1, q2]\nu: [t]\nassume: [0 < q1 < pi]\n\
                    f_x: {p1: p2^2*cos(q1)/sin(q1)^3 + sin(q1) + t, p2: 0}\nf_y: {q1: p1, q2: p2/sin(q1)^2}\n\
                    phi: [p1, p2, p2^2]";
    let rest = "while the plant rests and `cos(q1) = 0`, only `z1`, `z2` are identified, which determine `p1`, `p2` near \
                almost every value";
    assert!(of(pendulum).iter().any(|line| line == rest), "{:?}", of(pendulum));
    // All seen from a point that the origin moves with is turned about it unseen.
    assert!(line("while all inputs are constant, only").ends_with("are identified"), "{lines:?}");
}

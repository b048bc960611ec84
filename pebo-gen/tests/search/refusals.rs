//! Searches without a transform, or without one that is found.

use pebo_gen::analysis::{Class, Outcome};
use pebo_gen::search::{BoundClass, Declaration, SearchVerdict};
use pebo_gen::source::{Code, Source};
use pebo_gen::{Request, Standing, answer, solve};

use super::search;

const ARM: &str = "parameters: [c1, c2, c3]\nx: [p1, p2]\ny: [q1, q2]\nu: [u1, u2]\n\
    define: {ma: c1 + c2 + 2*c3*cos(q2), mb: c2 + c3*cos(q2), md: c1*c2 - c3^2*cos(q2)^2}\n\
    f_x: {p1: u1, p2: u2 - (c3*sin(q2)*p1*p2 - c3*sin(q2)*p2^2)/md + \
    (c2*p1^2 - 2*mb*p1*p2 + ma*p2^2)*c3^2*cos(q2)*sin(q2)/md^2}\n\
    f_y: {q1: (c2*p1 - mb*p2)/md, q2: (ma*p2 - mb*p1)/md}";

#[test]
fn a_two_link_arm_has_no_transform_and_a_certificate_says_so() {
    let (plant, found) = search(ARM, None);
    assert_eq!(found.verdict, SearchVerdict::None);
    let bound = found.bound.expect("a bound");
    assert_eq!((bound.states, bound.rank, bound.class, bound.proved), (2, 1, BoundClass::Smooth, true));
    assert!(bound.sentence(&plant.arena).ends_with("proved"));
    assert_eq!(bound.relations.len(), 1);
    assert!(
        found.generalised.is_some_and(|bound| bound.excludes()),
        "none of a generalised cascade affine in x either"
    );
}

/// Roots that cancel make functions that are zero, as `sqrt(d) + h2/sqrt(d) - h1/sqrt(d)` with `d = h1 - h2`.
#[test]
fn functions_that_vanish_are_no_components() {
    let tanks = "parameters: {A1: 0.5, A2: 0.8, a: 0.02}\nx: [h2]\ny: [h1]\nu: [qin, qp]\nassume: [h1 > h2, h2 > 0]\n\
        f_x: {h2: (a*sqrt(h1 - h2) - qp)/A2}\nf_y: {h1: (qin - a*sqrt(h1 - h2))/A1}";
    let (_, found) = search(tanks, None);
    assert!(!found.candidates.is_empty());
    for candidate in &found.candidates {
        assert!(candidate.formulas().iter().all(|phi| !phi.contains("sqrt")), "{}", candidate.sentence());
    }
}

/// Bounds of plants whose transforms are known.
#[test]
fn bounds_are_those_of_the_transforms_that_there_are() {
    let cuk = "parameters: {L1: 0.01, C2: 22e-6, L3: 0.01, C4: 22.9e-6, G: 0.0447, E: 12}\nx: [i1, i3, v4]\ny: [v2]\nu: [u]\n\
        f_x: {i1: -(1 - u)*v2/L1 + E/L1, i3: -u*v2/L3 - v4/L3, v4: (i3 - G*v4)/C4}\nf_y: {v2: ((1 - u)*i1 + u*i3)/C2}";
    let resistive = "parameters: {L: 1e-3, C: 1e-4, R: 50, E: 12, r: 0.5}\nx: [i]\ny: [v]\nu: [d]\n\
        f_x: {i: (-r*i - (1 - d)*v + E)/L}\nf_y: {v: ((1 - d)*i - v/R)/C}";
    let free = "parameters: [a1, a2, a, b]\nx: [x1, x2]\ny: [y]\nf_x: {x1: a1*x1, x2: a2*x2}\nf_y: {y: a*x1 + b*x2}";
    for (lines, states, rank, class) in
        [(cuk, 3, 1, BoundClass::Smooth), (resistive, 1, 0, BoundClass::Smooth), (free, 2, 1, BoundClass::Affine)]
    {
        let (_, found) = search(lines, Some(Class::Pebo));
        let bound = found.bound.expect("a bound");
        assert_eq!((bound.states, bound.rank, bound.class, bound.proved), (states, rank, class, true), "{lines}");
        assert_eq!(bound.relations.len(), states - rank, "{lines}");
        // It excludes no other affine transforms: on x > 0 the logarithms of x1 and x2 are one.
        let expected = if class == BoundClass::Smooth { SearchVerdict::None } else { SearchVerdict::Undecided };
        assert_eq!(found.verdict, expected, "{lines}");
    }
}

#[test]
fn nothing_is_said_of_smooth_transforms_without_inputs() {
    // Every autonomous plant has local ones: the flow box.
    let (_, found) = search("x: [a]\ny: [b]\nf_x: {a: a^3}\nf_y: {b: a^2}", Some(Class::Pebo));
    assert!(found.bound.is_none_or(|bound| bound.class != BoundClass::Smooth));
}

#[test]
fn a_function_of_the_states_that_jumps_is_no_component() {
    // p, |p| and sign(p) have affine rates but where p passes zero: there theta would jump with sign(p).
    let (_, found) = search("x: [p]\ny: [q]\nu: [f]\nf_x: {p: \"f*min(p, 2*p) + q\"}\nf_y: {q: p}", None);
    assert_eq!(found.verdict, SearchVerdict::Undecided);
    let (_, found) =
        search("x: [p]\ny: [q]\nu: [f]\nassume: [p > 0]\nf_x: {p: \"f*min(p, 2*p) + q\"}\nf_y: {q: p}", None);
    assert_eq!(found.verdict, SearchVerdict::Found);
}

#[test]
fn a_transform_whose_domain_is_not_proved_is_not_found() {
    // Logarithms of x are the only plain cascade; they have values where x is positive.
    let lines = "parameters: [a1, a2, a, b]\nx: [x1, x2]\ny: [y]\nf_x: {x1: a1*x1, x2: a2*x2}\nf_y: {y: a*x1 + b*x2}";
    let logarithms = |found: &pebo_gen::search::Search| {
        found.candidates.iter().any(|c| c.formulas().iter().any(|formula| formula.contains("log(x")))
    };
    let (_, open) = search(lines, Some(Class::Pebo));
    assert!(open.verdict == SearchVerdict::Undecided && !logarithms(&open));
    let (_, signed) = search(&format!("{lines}\nassume: [x1 > 0, x2 > 0, a > 0, b > 0]"), Some(Class::Pebo));
    assert!(logarithms(&signed));
}

#[test]
fn a_sign_that_would_do_is_named() {
    let lines = "parameters: [k]\nx: [v]\ny: [q]\nu: [F]\nf_x: {v: (F - k*q)/v - k*v}\nf_y: {q: v^2}";
    let (_, found) = search(lines, None);
    assert_eq!(found.verdict, SearchVerdict::Undecided);
    let (candidate, declaration) = found.declared.into_iter().next().expect("an assumption");
    assert!(matches!(&declaration, Declaration::Positive(signs) if signs.len() == 1), "{declaration:?}");
    assert_eq!(candidate.plant.phi.len(), 1);
    let (_, found) = search(&format!("{lines}\nassume: [v > 0]"), None);
    assert_eq!(found.verdict, SearchVerdict::Found);
}

/// Of a motor the angle and an unknown flux linkage are recovered up to half a turn with the other sign.
#[test]
fn a_sign_of_one_constant_is_enough_where_products_of_components_are_accepted_with_it() {
    let lines = "x: [th, w, l]\ny: [i, j]\nu: [v, s]\nangles: {th: 2*pi}\n\
        f_x: {th: w, w: l*(j*cos(th) - i*sin(th)) - w, l: 0}\nf_y: {i: v + l*w*sin(th), j: s - l*w*cos(th)}";
    let (plant, found) = search(lines, None);
    let (candidate, declaration) = found.declared.into_iter().next().expect("an assumption");
    let Declaration::Positive(signs) = &declaration else { panic!("{declaration:?}") };
    assert_eq!(signs.iter().map(|sign| plant.arena.name(*sign)).collect::<Vec<_>>(), ["l"]);
    assert!(candidate.is_full());
}

/// A phi in which the outputs are not affine is accepted with products of its components, after the author's own.
#[test]
fn a_phi_is_lifted_by_products_of_its_components() {
    let lines = "x: [th, w]\ny: [i, j]\nu: [v, s]\nangles: {th: 2*pi}\nf_x: {th: w, w: j*cos(th) - i*sin(th) - w}\n\
        f_y: {i: v + w*sin(th), j: s - w*cos(th)}\nphi: [i + cos(th), j + sin(th), w]";
    let motor = answered(&format!("model: m\n{lines}\n"));
    assert_eq!(motor.standing, Standing::Accepted, "{:?}", motor.diagnostics);
    let line = motor.report.line();
    let phi = r#""phi":{"origin":"given","z":["i + cos(th)","j + sin(th)","w","(i + cos(th))^2","#;
    assert!(line.contains(phi) && line.contains(r#""lifted":"#), "{line}");
    assert!(line.contains(r#""parameterisation":"over-parameterised""#), "{line}");

    // Of a product nothing shows a^2 and b^2 apart.
    let product = "x: [a, b]\ny: [r]\nu: [w, v]\nf_x: {a: w*b + v, b: -w*a}\nf_y: {r: a*b}\nphi: [a, b]";
    let product = answered(&format!("model: m\n{product}\n"));
    assert_eq!(product.standing, Standing::Accepted, "{:?}", product.diagnostics);
    assert!(product.report.line().contains(r#""lifted":2"#), "{}", product.report.line());

    // With one component the states are not determined, whatever its square has in its rate.
    let few = "x: [a, b]\ny: [r]\nu: [w, v]\nf_x: {a: v - a, b: a - 2*b}\nf_y: {r: a^2 + b}\nphi: [a]";
    assert_eq!(answered(&format!("model: m\n{few}\n")).standing, Standing::Refused);

    // By the value of an output too: r^2 = a^2 + b^2.
    let range = "x: [a, b, c, d]\ny: [r]\nu: [v, w]\nassume: [r > 0]\nf_x: {a: v + c, b: w + d, c: 0, d: 0}\n\
        g_y: {r: sqrt(a^2 + b^2)}\nphi: [a, b, c, d]\nphi_left: {a: z1, b: z2, c: z3, d: z4}";
    let range = answered(&format!("model: m\n{range}\n"));
    assert_eq!(range.standing, Standing::Accepted, "{:?}", range.diagnostics);
    let line = range.report.line();
    let phi = r#""z":["a","b","c","d","a^2 + b^2","#;
    assert!(
        line.contains(phi) && line.contains(r#""lifted":3}"#) && line.contains(r#""origin":"given","asks""#),
        "{line}"
    );
}

fn answered(text: &str) -> pebo_gen::Answer {
    answer(&Source::new("m.yaml", text).expect("a text"), &Request::new())
}

#[test]
fn a_model_without_phi_is_answered_with_the_one_that_was_found() {
    let found = answered("model: m\nx: [p]\ny: [q]\nu: [v]\nf_x: {p: v - q*p}\nf_y: {q: p}\n");
    assert_eq!(found.standing, Standing::Accepted);
    assert!(found.report.line().contains(r#""phi":{"origin":"found","z":["p + q^2/2"]}"#), "{}", found.report.line());
    let given = answered("model: m\nx: [p]\ny: [q]\nu: [v]\nf_x: {p: v}\nf_y: {q: p}\nphi: [p]\n");
    assert!(given.report.line().contains(r#""phi":{"origin":"given","z":["p"]}"#));
    let open = answered("model: m\nx: [a]\ny: [b]\nu: [c]\nf_x: {a: c - a^3}\nf_y: {b: c*a}\n");
    assert_eq!((open.standing, open.diagnostics[0].code), (Standing::Refused, Code::TransformNotFound));
}

#[test]
fn a_refusal_is_followed_by_the_result_of_a_search() {
    let refused = [
        // The rate of x is not free of x, that of x plus an integral over y is.
        ("class: pebo\nx: [x]\ny: [y]\nu: [u]\nf_x: {x: u - x*y}\nf_y: {y: x}\nphi: [x]", Code::CascadeRefuted),
        ("x: [x]\ny: [y]\nf_x: {x: -x*y}\nf_y: {y: x}\nphi: [x^2]", Code::LeftInverseRefuted),
        ("x: [a, b]\ny: [y]\nu: [u]\nf_x: {a: u, b: a}\nf_y: {y: b}\nphi: [a]", Code::LeftInverseRefuted),
        (
            "x: [x]\ny: [y]\nu: [u]\nf_x: {x: u}\nf_y: {y: x^5 + exp(-x^2)*0 + x}\nphi: [exp(x)]",
            Code::RegressionNonlinear,
        ),
        // Nothing is refuted: no left inverse was found, and the claim about the regression is open.
        (
            "x: [s, v]\ny: [w]\nu: [u]\nf_x: {s: u, v: u - v}\ng_y: {w: s - v - u}\nphi: [s^2 + s, v]",
            Code::LeftInverseUnderivable,
        ),
    ];
    for (lines, code) in refused {
        let answer = answered(&format!("model: m\n{lines}\n"));
        let told = answer.diagnostics.iter().find(|diagnostic| diagnostic.code == code);
        let diagnostic = told.unwrap_or_else(|| panic!("{lines}: {:#?}", answer.diagnostics));
        let help = diagnostic.help.as_deref().unwrap_or_default();
        assert!(help.contains("which is accepted"), "{lines}: {code:?} {:?} {help}", diagnostic.code);
        let others = answer.diagnostics.iter().filter_map(|other| other.help.as_deref());
        assert_eq!(others.filter(|help| help.contains("choose a phi")).count(), 0, "{lines}");
    }
}

/// A frame has as many components as there are momenta; a transform with more is not denied for it.
#[test]
fn a_transform_that_is_no_frame_is_reported_for_a_mechanical_plant() {
    let refused = answered(
        "model: m\nx: [p1, p2]\ny: [q1, q2]\nu: [a, b]\n\
         mechanical: {M: [['1 + cos(q2)^2', 0], [0, 1]], V: 'cos(q2)', G: [[1, 0], [0, 1]], T: [[1, 0], [0, 1]]}\n",
    );
    let diagnostic = &refused.diagnostics[0];
    assert_eq!(diagnostic.code, Code::CascadeRefuted);
    assert_eq!(
        diagnostic.notes.last().map(|note| &**note),
        Some("phi = [p1, p2, p1^2], generalised cascade, is accepted")
    );
    assert_eq!(diagnostic.help.as_deref(), Some("write the plant under `f_x` and `f_y`, with this phi"));
}

#[test]
fn the_transform_is_written_into_the_model_and_nothing_else_changes() {
    let head =
        "model: m          # a comment\nx: [p]\ny: [q]\nu: [v]\nf_x:\n  p: v - q*p      # friction\nf_y: {q: p}\n";
    let tail = "\n# the end\nassume: [q > 0]\n";
    let solution = solve(&Source::new("m.yaml", format!("{head}{tail}")).expect("a text"), None, &Request::new());
    assert_eq!(solution.filled.expect("a model"), format!("{head}phi: [p + q^2/2]\n{tail}"));
    let given = format!("{head}phi: [p]\nphi_left: {{p: z1}}\n{tail}");
    let solution = solve(&Source::new("m.yaml", given).expect("a text"), None, &Request::new());
    assert_eq!(solution.filled.expect("a model"), format!("{head}phi: [p + q^2/2]\n{tail}"));
}

#[test]
fn a_refused_frame_has_the_number_of_killing_fields() {
    let lines = "parameters: [m, J, g]\nx: [p1, p2]\ny: [r, th]\nu: [tau]\nassume: [m > 0, J > 0, g > 0]\n\
                 mechanical: {M: [[m, 0], [0, J + m*r^2]], V: m*g*r*sin(th), G: [[0], [1]], T: [[1, 0], [0, 1]]}";
    let answer = answered(&format!("model: m\nclass: pebo\n{lines}\n"));
    let diagnostic = &answer.diagnostics[0];
    assert_eq!(diagnostic.code, Code::CascadeRefuted);
    let help = diagnostic.help.as_deref().unwrap_or_default();
    assert!(help.starts_with("M has just 1 Killing field, and T needs 2"), "{help}");
    assert!(diagnostic.notes.iter().any(|note| note.contains("no smooth phi")), "{:?}", diagnostic.notes);
    let (_, found) = search(lines, Some(Class::Pebo));
    assert_eq!(found.verdict, SearchVerdict::None);
    assert_eq!(found.affine.and_then(|affine| affine.transforms()), Some(1));
}

#[test]
fn no_advice_is_to_choose_a_phi_where_there_is_none() {
    let lines = "parameters: [R, L, K]\nx: [i]\ny: [w]\nu: [V]\nassume: [R > 0, L > 0, K > 0]\n\
                 f_x: {i: (V - R*i - K*w)/L}\nf_y: {w: (K + V)*i}\nphi: [i]";
    let answer = answered(&format!("model: m\nclass: pebo\n{lines}\n"));
    let help = answer.diagnostics[0].help.as_deref().unwrap_or_default();
    assert_eq!(
        (answer.diagnostics[0].code, help.split(',').next()),
        (Code::CascadeRefuted, Some("leave out `class: pebo`"))
    );
    assert_eq!(answered(&format!("model: m\n{lines}\n")).standing, Standing::Accepted);
}

/// The nearest candidate and its obstacle come first, no transform is repeated in another order, and the states without
/// a transform are underlined.
#[test]
fn a_model_without_a_transform_is_refused_in_a_few_notes() {
    let text = "model: m\nx: [a, b]\ny: [q]\nu: [v]\nf_x: {a: v - 2*a, b: 3*b}\nf_y: {q: a + sin(b)*q}\n";
    let source = Source::new("m.yaml", text).expect("a text");
    let answer = answer(&source, &Request::new());
    let found = &answer.diagnostics[0];
    assert_eq!((found.code, source.slice(found.primary.span)), (Code::TransformNotFound, "a, b"));
    assert!(found.notes.len() <= 5 && !found.notes.iter().any(|note| note.starts_with("tried:")), "{:#?}", found.notes);
    assert!(found.notes.last().is_some_and(|note| note.contains("`pebo-gen solve` shows what was tried")));
    let sorted = |note: &String| {
        let inner =
            note.split_once("phi = [").and_then(|(_, rest)| rest.split_once(']')).map(|(inner, _)| inner.to_owned());
        inner.map(|inner| {
            let mut parts: Vec<String> = inner.split(", ").map(str::to_owned).collect();
            parts.sort_unstable();
            parts
        })
    };
    let candidates = found.notes.iter().filter(|note| note.starts_with("phi = ["));
    let told: Vec<Vec<String>> = candidates.filter_map(sorted).collect();
    assert!(told.len() < 2 || told[0] != told[1], "{told:#?}");
}

/// Proofs about transforms affine in x say nothing about others.
#[test]
fn none_has_its_open_cases() {
    let said = |lines: &str| {
        let text = format!("model: m\n{lines}\n");
        solve(&Source::new("m.yaml", text.as_str()).expect("a text"), None, &Request::new()).summary
    };
    let open = "not excluded: a phi that is not affine in x, with a generalised cascade";
    assert!(said(ARM).contains(open), "{}", said(ARM));
    let asked = said(&format!("class: pebo\n{ARM}"));
    assert!(!asked.contains(open), "{asked}");
}

#[test]
fn an_unmeasured_signal_is_no_component() {
    // Whatever mu is, a slope explains the speed.
    for lines in [
        "parameters: [m]\nassume: [m > 0]\nx: [mu]\ny: [vel]\nu: [F]\nw: [slope]\nf_x: {mu: 0}\nf_y: {vel: (F - mu*vel - slope)/m}",
        "x: [b, p]\ny: [q]\nu: [v]\nw: [d]\nf_x: {b: 0, p: d + b*v}\nf_y: {q: p}",
    ] {
        let (_, found) = search(lines, None);
        assert_ne!(found.verdict, SearchVerdict::Found, "{lines}");
    }
}

/// The codes of the refusal of a model, and its notes.
fn refused(lines: &str) -> (Vec<Code>, String) {
    let source = Source::new("m.yaml", format!("model: m\n{lines}\n")).unwrap();
    let derived = pebo_gen::derive(&source).unwrap();
    assert_eq!(derived.derivation.outcome, Outcome::Rejected, "{lines}");
    let codes = derived.derivation.diagnostics.iter().map(|d| d.code).collect();
    (codes, derived.derivation.diagnostics.iter().flat_map(|d| d.notes.clone()).collect::<Vec<_>>().join("; "))
}

#[test]
fn states_that_no_output_shows_are_refused_as_with_a_transform() {
    for (plant, phi, shown) in [
        (
            "parameters: [J]\nx: [load, bias]\ny: [omega]\nu: [tau]\nf_x: {load: 0, bias: 0}\n\
             f_y: {omega: (tau + bias - load)/J}",
            "load, bias",
            "of `load`, `bias` the outputs show only `bias - load`",
        ),
        (
            "parameters: {a: 2, b: 2}\nx: [p, q]\ny: [v]\nf_x: {p: -a*p, q: -b*q}\nf_y: {v: p + q}",
            "p, q",
            "of `p`, `q` the outputs show only `p + q`",
        ),
        (
            "x: [a, b, c]\ny: [r]\nu: [v]\nf_x: {a: 0, b: 0, c: 0}\nf_y: {r: v*(a + 2*b) - r}",
            "a, b, c",
            "of `a`, `b`, `c` the outputs show only `a/2 + b`",
        ),
    ] {
        for lines in [plant.to_owned(), format!("{plant}\nphi: [{phi}]")] {
            let (codes, notes) = refused(&lines);
            assert_eq!(codes, [Code::NeverIdentifiable], "{lines}");
            assert!(notes.contains(shown), "{notes}");
        }
    }
}

/// A symmetry proves that no observer recovers the states, whatever its transform is.
#[test]
fn a_plant_whose_outputs_are_the_same_along_a_symmetry_is_rejected() {
    let reactor = "model: m\nparameters: {Ks: 0.3, Sin: 5}\nx: [X, mu, k]\ny: [S]\nu: [D]\n\
        assume: [S > 0, X > 0, mu > 0, k > 0, D > 0]\nf_x: {X: (mu*S/(Ks + S) - D)*X, mu: 0, k: 0}\n\
        f_y: {S: -k*mu*S/(Ks + S)*X + D*(Sin - S)}\n";
    let line = answered(reactor).report.line();
    assert!(line.contains(r#""verdict":"rejected""#), "{line}");
}

#[test]
fn a_declaration_with_which_a_transform_is_accepted_is_found_by_trying() {
    let hall = "parameters: {A: 1}\nx: [q, w, o1, o2]\ny: [h1, h2]\nf_x: {q: w, w: 0, o1: 0, o2: 0}\n\
                g_y: {h1: A*sin(q) + o1, h2: A*cos(q) + o2}";
    let converter = "parameters: {L: 0.01, C: 1e-4, E: 12, r: 0.5, R: 50}\nx: [i]\ny: [v]\nu: [d]\n\
                     f_x: {i: (-r*i - (1 - d)*v + E)/L}\nf_y: {v: ((1 - d)*i - v/R)/C}\nclass: pebo";
    let sine = "x: [g]\ny: [h]\nu: [v]\nf_x: {g: 0}\nf_y: {h: v*sin(g)}";
    for (lines, expected) in
        [(hall, "`angles: {q: 2*pi}`"), (converter, "no `class`"), (sine, "`assume: [-pi/2 < g < pi/2]`")]
    {
        let source = Source::new("m.yaml", format!("model: m\n{lines}\n")).unwrap();
        let derived = pebo_gen::derive(&source).unwrap();
        let refusal = &derived.derivation.diagnostics[0];
        assert_eq!(refusal.code, Code::TransformNotFound, "{lines}");
        assert!(refusal.notes.iter().any(|note| note.starts_with(&format!("with {expected}, phi = ["))), "{refusal:?}");
        // With the line it is accepted.
        let with = match expected {
            "no `class`" => lines.replace("\nclass: pebo", ""),
            line => format!("{lines}\n{}", line.replace('`', "")),
        };
        let source = Source::new("m.yaml", format!("model: m\n{with}\n")).unwrap();
        assert_eq!(pebo_gen::derive(&source).unwrap().derivation.outcome, Outcome::Accepted, "{with}");
    }
    // A period of unknown sign would be refused.
    let lines = hall.replace("{A: 1}", "{A: 1, n: null}").replace("(q)", "(n*q)");
    let source = Source::new("m.yaml", format!("model: m\n{lines}\n")).unwrap();
    let refusal = &pebo_gen::derive(&source).unwrap().derivation.diagnostics[0];
    assert!(!refusal.notes.iter().any(|note| note.contains("angles")), "{refusal:?}");
}

#[test]
fn a_state_on_which_no_output_depends_may_be_left_out() {
    let lines = "parameters: {k: 0.5, m: 2}\nx: [v, w]\ny: [q]\nu: [F]\nf_x: {v: F/m - v, w: v - k*w}\nf_y: {q: v}";
    let source = Source::new("m.yaml", format!("model: m\n{lines}\n")).unwrap();
    let derived = pebo_gen::derive(&source).unwrap();
    let refusal = &derived.derivation.diagnostics[0];
    assert_eq!(refusal.code, Code::NeverIdentifiable);
    assert!(refusal.notes.iter().any(|note| note.starts_with("with no `w`, phi = [")), "{refusal:?}");
    assert_eq!(
        refusal.help.as_deref(),
        Some("measure an output that depends on `w`, or leave it out under `x` and `f_x`")
    );
    // Where the rest is no better, it is said all the same.
    let product = "x: [c, d, b]\ny: [T]\nu: [q]\nf_x: {c: -q*c, d: q*(c - d), b: 0}\nf_y: {T: c*b - T}";
    let source = Source::new("m.yaml", format!("model: m\n{product}\n")).unwrap();
    let derived = pebo_gen::derive(&source).unwrap();
    let notes = derived.derivation.diagnostics[0].notes.join("; ");
    assert!(notes.contains("no output depends on `d`: nothing recovers it"), "{notes}");
}

#[test]
fn a_plant_that_contradicts_itself_is_refused_before_any_search() {
    let plant = "x: [v]\ny: [s]\nf_x: {v: 0}\nf_y: {s: 2*v}\ng_y: {s: 3*v}";
    for lines in [plant.to_owned(), format!("{plant}\nphi: [v]")] {
        assert_eq!(refused(&lines).0, [Code::IdentityRefuted], "{lines}");
    }
}

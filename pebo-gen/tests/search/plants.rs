//! Plants from the literature without their transform.

use pebo_gen::analysis::Class;
use pebo_gen::search::SearchVerdict;
use pebo_gen::source::Source;
use pebo_gen::{Request, solve};

use super::{search, written};

/// A plant, where it is from, and the class and the size of the transform that is to be found at the latest.
struct Case {
    from: &'static str,
    lines: &'static str,
    class: Class,
    most: usize,
}

const CASES: &[Case] = &[
    Case {
        from: "boost converter: the inductor current",
        lines: "parameters: {L: 1e-3, C: 1e-4, R: 50, E: 12}\nx: [i]\ny: [v]\nu: [d]\n\
                f_x: {i: (E - (1 - d)*v)/L}\nf_y: {v: ((1 - d)*i - v/R)/C}",
        class: Class::Pebo,
        most: 1,
    },
    Case {
        from: "Lotka 1920, Volterra 1926: the prey from its predator; the sum of phi holds a logarithm of y",
        lines: "parameters: [a, b, c, d]\nx: [x]\ny: [y]\nu: [u]\nassume: [x > 0, y > 0, d > 0]\n\
                f_x: {x: a*x - b*x*y}\nf_y: {y: -c*y + d*x*y + u}",
        class: Class::Gpebo,
        most: 1,
    },
    Case {
        from: "Lotka 1920 without an input: a plain cascade with an integral over y",
        lines: "parameters: [a, b, c, d]\nx: [x]\ny: [y]\nassume: [x > 0, y > 0, d > 0]\n\
                f_x: {x: a*x - b*x*y}\nf_y: {y: -c*y + d*x*y}",
        class: Class::Pebo,
        most: 1,
    },
    Case {
        from: "Euler's equations of a rigid body in a plane frame that turns: velocities of the body from positions",
        lines: "parameters: [m, J]\nx: [a, b, r]\ny: [px, py, psi]\nu: [fa, fb, tr]\n\
                f_x: {a: r*b + fa/m, b: -r*a + fb/m, r: tr/J}\n\
                f_y: {px: cos(psi)*a - sin(psi)*b, py: sin(psi)*a + cos(psi)*b, psi: r}",
        class: Class::Pebo,
        most: 3,
    },
    Case {
        from: "levitated ball: its position from the current; affine in two functions of one state",
        lines: "parameters: [k, c, R]\nx: [q]\ny: [i]\nu: [U, v]\nassume: [k > 0, c - q > 0, i > 0]\n\
                f_x: {q: v}\nf_y: {i: (c - q)/k*(U - R*i) - v*i/(c - q)}",
        class: Class::Pebo,
        most: 2,
    },
    Case {
        from: "falling body in an atmosphere that thins out: an integrating factor",
        lines: "parameters: [k, H, g]\nx: [v]\ny: [a]\nu: [F]\n\
                f_x: {v: \"-g + F + k*exp(-a/H)*v^2\"}\nf_y: {a: v}",
        class: Class::Pebo,
        most: 1,
    },
    Case {
        from: "pendulum on a cart in its momenta (Acosta, Ortega, Astolfi, Mahindrakar 2005): a root of det M",
        lines: "parameters: {a: 9.8, b: 0.8, c: 1.5}\nx: [p1, p2]\ny: [q1, q2]\nu: [u]\n\
                assume: [c > 0, b > 0, b^2 < c]\n\
                f_x: {p1: \"a*sin(q1) - b*sin(q1)*(p1*c - b*cos(q1)*p2)*(p2 - b*cos(q1)*p1)/(c - b^2*cos(q1)^2)^2\", p2: u}\n\
                f_y: {q1: \"(c*p1 - b*cos(q1)*p2)/(c - b^2*cos(q1)^2)\", q2: \"(p2 - b*cos(q1)*p1)/(c - b^2*cos(q1)^2)\"}",
        class: Class::Pebo,
        most: 2,
    },
    Case {
        from: "Cuk converter, three states from one voltage: a generalised cascade alone",
        lines: "parameters: [L1, C2, L3, C4, G, E]\nx: [i1, i3, v4]\ny: [v2]\nu: [u]\n\
                assume: [L1 > 0, C2 > 0, L3 > 0, C4 > 0]\n\
                f_x: {i1: -(1 - u)*v2/L1 + E/L1, i3: -u*v2/L3 - v4/L3, v4: (i3 - G*v4)/C4}\n\
                f_y: {v2: ((1 - u)*i1 + u*i3)/C2}",
        class: Class::Gpebo,
        most: 3,
    },
    Case {
        from: "Van der Pol 1926, Lienard's form: the damping is an integral over y",
        lines: "parameters: [mu]\nx: [v]\ny: [y]\nu: [u]\nf_x: {v: mu*(1 - y^2)*v - y + u}\nf_y: {y: v}",
        class: Class::Pebo,
        most: 1,
    },
    Case {
        from: "Susceptible, infected (Kermack, McKendrick 1927): the susceptible from the infected",
        lines: "parameters: [beta, g]\nx: [S]\ny: [I]\nassume: [S > 0, I > 0, beta > 0]\n\
                f_x: {S: -beta*S*I}\nf_y: {I: beta*S*I - g*I}",
        class: Class::Pebo,
        most: 1,
    },
    Case {
        from: "stirred tank (Bastin, Dochain 1990): substrate from biomass with a known growth rate",
        lines: "parameters: [k]\nx: [S]\ny: [X]\nu: [D, Sin]\nassume: [k > 0, X > 0]\n\
                f_x: {S: -k*S*X + D*(Sin - S)}\nf_y: {X: S*X - D*X}",
        class: Class::Gpebo,
        most: 1,
    },
    Case {
        from: "unicycle that sees its position: the heading under a known rate of turn",
        lines: "x: [th]\ny: [px, py]\nu: [v, w]\nangles: {th: 2*pi}\n\
                f_x: {th: w}\nf_y: {px: v*cos(th), py: v*sin(th)}",
        class: Class::Gpebo,
        most: 2,
    },
    Case {
        from: "rotor flux of an induction motor in a fixed frame, currents and speed measured",
        lines: "parameters: [Rr, Lr, M, s, Rs]\nx: [la, lb]\ny: [ia, ib, w]\nu: [va, vb]\nassume: [Lr > 0, M > 0, s > 0]\n\
                f_x: {la: -Rr/Lr*la - w*lb + Rr*M/Lr*ia, lb: -Rr/Lr*lb + w*la + Rr*M/Lr*ib}\n\
                f_y: {ia: (va - Rs*ia + M*Rr/Lr^2*la + M/Lr*w*lb)/s, ib: (vb - Rs*ib + M*Rr/Lr^2*lb - M/Lr*w*la)/s}",
        class: Class::Gpebo,
        most: 2,
    },
    Case {
        from: "made from its transform: x1 + (c*q^3 + 4*p*q)*x2 and x2 + c*sqrt(p^2 + 1), which are integrals over both outputs",
        lines: "parameters: [b, c]\nx: [x1, x2]\ny: [p, q]\nu: [u]\n\
                define: {dp: (1 + u^2)*x1 - p, dq: u + (1 + u^2)*(x1 + x2), r: u*p - c*p - c*p*dp/sqrt(p^2 + 1)}\n\
                f_x: {x1: u - b - 4*x2*q*dp - x2*(3*c*q^2 + 4*p)*dq - (c*q^3 + 4*p*q)*r, x2: r}\n\
                f_y: {p: dp, q: dq}",
        class: Class::Pebo,
        most: 2,
    },
    Case {
        from: "made from its transform: a frame that turns with q, and quotients of p beside it",
        lines: "parameters: [a]\nx: [x1, x2]\ny: [p, q]\nu: [u, v]\nassume: [a > 0]\n\
                define: {dp: x1*u + x2, dq: x1 + v*x2, f: u - dp*(1/(1 + p^2) + (a - p^2)/(a + p^2)^2), g: v*q - a*dp*cos(p)}\n\
                f_x: {x1: f*cos(q) - g*sin(q) - x2*dq, x2: f*sin(q) + g*cos(q) + x1*dq}\n\
                f_y: {p: dp, q: dq}",
        class: Class::Pebo,
        most: 2,
    },
    Case {
        from: "Kermack, McKendrick 1927 with unknown rates of contact and of recovery: what is seen of b*S, b and g",
        lines: "x: [S, b, g]\ny: [I]\nassume: [S > 0, I > 0, b > 0, g > 0]\n\
                f_x: {S: -b*S*I, b: 0, g: 0}\nf_y: {I: b*S*I - g*I}",
        class: Class::Gpebo,
        most: 3,
    },
    Case {
        from: "Verhulst 1838, harvested: the reciprocal of a population from its yield",
        lines: "x: [p]\ny: [q]\nu: [v]\nassume: [0 < p < 1]\nf_x: {p: p*(1 - p) - v*p}\nf_y: {q: v*p}",
        class: Class::Gpebo,
        most: 1,
    },
    Case {
        from: "Riccati's equation with a constant solution, written out: a quotient by p - 1 or p - 2",
        lines: "x: [p]\ny: [q]\nu: [v]\nassume: [p > 2]\nf_x: {p: v*(p^2 - 3*p + 2)}\nf_y: {q: p}",
        class: Class::Gpebo,
        most: 1,
    },
    Case {
        from: "lift with an unknown load below a fraction bar, with friction: by parts with 1/(3 + m)",
        lines: "x: [v, m]\ny: [h]\nu: [F]\nassume: [m > 0]\n\
                f_x: {v: (F - 9.81*m*cos(h) - 2*v)/(3 + m), m: 0}\nf_y: {h: v}",
        class: Class::Gpebo,
        most: 2,
    },
    Case {
        from: "heading, bias of its gyroscope, speed and wind from positions: by parts with sine and cosine",
        lines: "x: [psi, b, V, we, wn]\ny: [e, n]\nu: [gz]\nangles: {psi: 2*pi}\nassume: [V > 0]\n\
                f_x: {psi: gz - b, b: 0, V: 0, we: 0, wn: 0}\nf_y: {e: V*sin(psi) + we, n: V*cos(psi) + wn}",
        class: Class::Gpebo,
        most: 7,
    },
    Case {
        from: "made from its transform: p and 2*s - p^2, of which the rates of s and p^2 alone do not close",
        lines: "x: [p, s]\ny: [q]\nu: [v]\n\
                f_x: {p: v - q*p + 2*s - p^2, s: v*p + 2*s*p - p^3 - 2*q*s}\nf_y: {q: 2*v*p + 2*s - p^2}",
        class: Class::Gpebo,
        most: 2,
    },
    Case {
        from: "made from its transform: x1 + a polynomial of the fourth degree in three outputs",
        lines: "x: [x1]\ny: [p, q, r]\nu: [v]\n\
                define: {dp: x1*q + v, dq: 2*x1 - p, dr: x1*p*r + 1}\n\
                f_x: {x1: v*p - (3*p^2*q + r^2)*dp - p^3*dq - (2*p*r - 4*r^3)*dr}\nf_y: {p: dp, q: dq, r: dr}",
        class: Class::Pebo,
        most: 1,
    },
    Case {
        from: "heater and load in a vacuum furnace: products of the stored heat, whose cascade is a generalised one",
        lines: "parameters: [a, b, k, h]\nx: [load]\ny: [heater]\nu: [P]\nassume: [a > 0, b > 0, k > 0, h > 0]\n\
                f_x: {load: (k*(heater^4 - load^4) - h*load)/b}\nf_y: {heater: (P - k*(heater^4 - load^4))/a}",
        class: Class::Gpebo,
        most: 4,
    },
    Case {
        from: "position and heading of a vehicle from the bearings of two landmarks, which it takes from its heading",
        lines: "parameters: {x1: 20, y1: 5, x2: 5, y2: 20}\nx: [px, py, psi]\ny: [b1, b2]\nu: [v, om]\n\
                angles: {psi: 2*pi}\nf_x: {px: v*cos(psi), py: v*sin(psi), psi: om}\n\
                g_y: {b1: \"atan2(y1 - py, x1 - px) - psi\", b2: \"atan2(y2 - py, x2 - px) - psi\"}",
        class: Class::Gpebo,
        most: 4,
    },
    Case {
        from: "two reactants and their product: products of two components",
        lines: "parameters: [k]\nx: [a, b]\ny: [p]\nu: [w]\nassume: [k > 0]\n\
                f_x: {a: b - a - k*a*b, b: w - b}\nf_y: {p: k*a*b}",
        class: Class::Gpebo,
        most: 4,
    },
    Case {
        from: "motor whose speed is driven by its fluxes: a transform of the angle, extended by the speed",
        lines: "x: [th, w]\ny: [i, j]\nu: [v, s]\nangles: {th: 2*pi}\n\
                f_x: {th: w, w: j*cos(th) - i*sin(th) - w}\nf_y: {i: v + w*sin(th), j: s - w*cos(th)}",
        class: Class::Gpebo,
        most: 7,
    },
    Case {
        from: "drive with a resolver: the rates of sine and cosine are the speed times what is measured",
        lines: "parameters: {J: 0.01, K: 0.5, B: 0.001}\nx: [th, w, TL]\ny: [s, c]\nu: [i]\nangles: {th: 2*pi}\n\
                f_x: {th: w, w: (K*i - B*w - TL)/J, TL: 0}\ng_y: {s: sin(th), c: cos(th)}",
        class: Class::Gpebo,
        most: 4,
    },
    Case {
        from: "three-phase grid: amplitude, angle and frequency, none of them a sample as it is",
        lines: "x: [A, ph, w]\ny: [va, vb]\nassume: [A > 0, w > 0]\nangles: {ph: 2*pi}\n\
                f_x: {A: 0, ph: w, w: 0}\ng_y: {va: A*cos(ph), vb: A*sin(ph)}",
        class: Class::Gpebo,
        most: 3,
    },
    Case {
        from: "single-phase grid: the output stands for itself in the second rate",
        lines: "x: [A, ph, w]\ny: [v]\nassume: [A > 0, w > 0]\nangles: {ph: 2*pi}\n\
                f_x: {A: 0, ph: w, w: 0}\ng_y: {v: A*sin(ph)}",
        class: Class::Gpebo,
        most: 3,
    },
    Case {
        from: "attitude matrix from two vectors and a gyroscope: identities that depend on one another",
        lines: "parameters: {g: 9.81, b: 0.6, d: 0.8}\nx: [r11, r12, r13, r21, r22, r23, r31, r32, r33]\n\
                y: [a1, a2, a3, m1, m2, m3]\nu: [w1, w2, w3]\nf_x: {r11: r12*w3 - r13*w2, r12: r13*w1 - r11*w3, \
                r13: r11*w2 - r12*w1, r21: r22*w3 - r23*w2, r22: r23*w1 - r21*w3, r23: r21*w2 - r22*w1, \
                r31: r32*w3 - r33*w2, r32: r33*w1 - r31*w3, r33: r31*w2 - r32*w1}\ng_y: {a1: g*r31, a2: g*r32, \
                a3: g*r33, m1: b*r11 + d*r31, m2: b*r12 + d*r32, m3: b*r13 + d*r33}\nidentities: \
                [r11 - (r22*r33 - r23*r32), r12 - (r23*r31 - r21*r33), r13 - (r21*r32 - r22*r31), \
                r21 - (r32*r13 - r33*r12), r22 - (r33*r11 - r31*r13), r23 - (r31*r12 - r32*r11)]",
        class: Class::Gpebo,
        most: 9,
    },
    Case {
        from: "a vehicle on a track and the distance of a mast beside it, with an unknown drag",
        lines: "x: [a, b, c]\ny: [r, s]\nu: [v]\nf_x: {a: b, b: v - c/10, c: 0}\n\
                g_y: {r: 'sqrt((a - 3)^2 + 4)', s: c*a}",
        class: Class::Gpebo,
        most: 9,
    },
];

/// A polynomial that no formula shows divides its own rate.
#[test]
fn logarithms_of_polynomials_that_stay_zero_are_found() {
    for (lines, phi) in [
        ("x: [p]\ny: [q]\nu: [v]\nassume: [p + q > 0]\nf_x: {p: (p + q)*v - p}\nf_y: {q: p}", "log(q + p)"),
        (
            "x: [p]\ny: [q]\nu: [v]\nassume: [p^2 + q > 0, p > 0]\nf_x: {p: v*(p^2 + q)/(2*p) - 1/2}\nf_y: {q: p}",
            "log(q + p^2)",
        ),
    ] {
        let (_, found) = search(lines, Some(Class::Pebo));
        let tried: Vec<String> = found.tried.iter().map(pebo_gen::search::Attempt::sentence).collect();
        let phis: Vec<Vec<String>> = found.candidates.iter().map(pebo_gen::search::Candidate::formulas).collect();
        assert!(phis.contains(&vec![phi.to_owned()]), "{phis:?}: {}", tried.join("\n"));
    }
}

#[test]
fn plants_have_their_transform_found_and_proved() {
    for Case { from, lines, class, most } in CASES {
        let (_, found) = search(lines, None);
        let tried: Vec<String> = found.tried.iter().map(pebo_gen::search::Attempt::sentence).collect();
        assert!(!found.candidates.is_empty(), "{from}: {}", tried.join("\n"));
        let (got, components) = written(lines, &found);
        assert!(components <= *most, "{from}: {:?}", found.candidates[0].formulas());
        assert!(got == Class::Pebo || *class == Class::Gpebo, "{from}: {:?}", found.candidates[0].formulas());
        println!("{from}: {got:?} {:?}", found.candidates[0].formulas());
    }
}

#[test]
fn an_autonomous_plant_is_found_the_same_every_time() {
    let lines = CASES[1].lines;
    let formulas =
        || search(lines, None).1.candidates.iter().map(pebo_gen::search::Candidate::formulas).collect::<Vec<_>>();
    assert_eq!(formulas(), formulas());
}

#[test]
fn a_mechanical_plant_needs_no_frame() {
    let lines = "parameters: {a: 9.8, b: 0.8, c: 1.5}\nx: [p1, p2]\ny: [q1, q2]\nu: [u]\nassume: [c > 0, b > 0, b^2 < c]\n\
                 mechanical: {M: [[1, b*cos(q1)], [b*cos(q1), c]], V: a*cos(q1), G: [[0], [1]]}";
    let (_, found) = search(lines, None);
    assert!(found.candidates[0].is_full() && found.candidates[0].derivation.class == Class::Pebo);
    assert_eq!(found.candidates[0].plant.phi.len(), 2);
}

/// The class knows whether the columns of its own T are Killing fields, which says nothing of a transform that was
/// found.
#[test]
fn a_frame_that_is_found_is_not_judged_by_the_authors() {
    let model = |metric: &str| {
        format!(
            "x: [p1, p2]\ny: [q1, q2]\nu: [a, b]\n\
             mechanical: {{M: {metric}, V: 'cos(q2)', G: [[1, 0], [0, 1]], T: [[1, 0], [0, 1]]}}"
        )
    };
    // z1 = p2 comes first; the other component moves with a, the input of the first joint.
    let (plant, found) = search(&model("[['(2 + sin(q1))^2', 0], [0, 1]]"), None);
    let candidate = &found.candidates[0];
    let rates = candidate.derivation.cascade.result.as_ref().expect("a cascade").h.clone();
    let formulas: Vec<String> = rates.iter().map(|rate| candidate.plant.arena.print(*rate)).collect();
    for (component, rate) in candidate.formulas().iter().zip(&formulas) {
        assert_eq!(component.contains("p1"), rate.contains('a'), "{component}: {rate}");
        assert_eq!(component.contains("p2"), rate.contains('b'), "{component}: {rate}");
    }
    assert_eq!(plant.x.len(), candidate.recovered());
    // A generalised one has more components than T has columns.
    search(&model("[['1 + cos(q2)^2', 0], [0, 1]]"), Some(Class::Gpebo));
}

#[test]
fn coils_have_their_fluxes_where_nothing_better_is_found() {
    // The speed is not measured, and only a relation among the fluxes, which no affine output is, identifies them.
    let lines = "parameters: {R: 8.875, L: 0.04, n: 5, m: 0.2}\nx: [q]\ny: [i1, i2]\nu: [v1, v2]\nw: [omega]\n\
                 assume: [L > 0, m > 0, n > 0]\nangles: {q: 2*pi/n}\nelectromechanical:\n  L: [[L, 0], [0, L]]\n  \
                 mu: [m*cos(n*q), m*sin(n*q)]\n  R: [R, R]\n  speed: omega";
    let (_, found) = search(lines, None);
    assert_eq!(found.verdict, SearchVerdict::Found);
    assert_eq!(found.candidates[0].formulas(), ["m*cos(n*q) + L*i1", "m*sin(n*q) + L*i2"]);
    // There is nothing to be written into the model.
    let source = Source::new("m.yaml", format!("model: m\n{lines}\n")).expect("a text");
    assert_eq!(solve(&source, None, &Request::new()).filled.as_deref(), Some(source.text()));
}

/// With the speed measured the fluxes are a linear regression, and nothing else is searched for; the class in the call
/// is another.
#[test]
fn a_class_that_leaves_nothing_better_answers_alone() {
    let lines = "parameters: {R: 8.875, L: 0.04, n: 5, m: 0.2}\nx: [q]\ny: [i1, i2, omega]\nu: [v1, v2]\n\
                 assume: [L > 0, m > 0, n > 0]\nangles: {q: 2*pi/n}\nelectromechanical:\n  L: [[L, 0], [0, L]]\n  \
                 mu: [m*cos(n*q), m*sin(n*q)]\n  R: [R, R]\n  speed: omega\n  inertia: 1\n  load: 0";
    let (_, found) = search(lines, None);
    assert_eq!(found.candidates[0].formulas(), ["m*cos(n*q) + L*i1", "m*sin(n*q) + L*i2"]);
    assert_eq!((found.candidates.len(), found.tried.len()), (1, 1));
    let (_, generalised) = search(lines, Some(Class::Gpebo));
    assert!(generalised.candidates.iter().all(|candidate| candidate.derivation.class == Class::Gpebo));
    assert!(generalised.tried.len() > 1);
}

#[test]
fn of_more_solutions_than_states_those_that_hold_everywhere_are_taken() {
    // Among the three momenta of a plane in polar coordinates, the two of the fixed frame.
    let lines = "parameters: [m]\nx: [pr, pt]\ny: [r, th]\nu: [ur, ut]\nassume: [m > 0, r > 0]\n\
                 f_x: {pr: pt^2/(m*r^3) + ur, pt: ut}\nf_y: {r: pr/m, th: pt/(m*r^2)}";
    let (_, found) = search(lines, None);
    let best = &found.candidates[0];
    assert!(best.is_full() && best.derivation.conditions.is_empty(), "{:?}", best.formulas());
}

#[test]
fn a_state_is_not_replaced_by_the_output_that_measures_it() {
    // `angle - incline` has a known rate, as it is zero: with it, or without any component for the angle, the estimate
    // of the angle would be the sensor's sample.
    let lines = "x: [angle, bias]\ny: [incline]\nu: [gyro]\nf_x: {angle: gyro - bias, bias: 0}\ng_y: {incline: angle}";
    let (_, found) = search(lines, None);
    assert_eq!(found.candidates[0].formulas(), ["angle", "bias"]);
    assert!(found.candidates.iter().any(|candidate| candidate.formulas() == ["bias"]));
}

/// A damper of two constants: as a sum of products of q and signs it may jump where q is 1, and theta with it.
#[test]
fn a_transform_is_continuous_where_the_rates_are_non_smooth() {
    let damper = "parameters: [m, d1, d2]\nassume: [m > 0]\nx: [p]\ny: [q]\nu: [F]\n\
                  f_x: {p: F - (d1 + (d2 - d1)*(1 + sign(q - 1))/2)*p/m}\nf_y: {q: p/m}";
    for lines in [damper, "x: [p]\ny: [q]\nu: [v]\nf_x: {p: v - p*sat(q)}\nf_y: {q: p}"] {
        let (plant, found) = search(lines, None);
        written(lines, &found);
        let best = &found.candidates[0];
        assert!(best.derivation.jumps(&plant).is_empty() && best.derivation.jumps(&best.plant).is_empty(), "{lines}");
    }
    // An author may write one that does, with a remark.
    let text = "model: m\nx: [p]\ny: [q]\nu: [v]\nf_x: {p: v}\nf_y: {q: p}\nphi: [p + 5*sign(q) + abs(q)]\n";
    let derived = pebo_gen::derive(&pebo_gen::source::Source::new("m.yaml", text).expect("a text")).expect("a model");
    let jumps = derived.derivation.jumps(&derived.plant);
    assert_eq!(jumps.iter().map(|jump| derived.plant.arena.print(jump.1)).collect::<Vec<_>>(), ["q"]);
}

/// Many states, one in each output's rate: products of states and outputs would be too many to try.
#[test]
fn many_states_are_no_harder_than_few() {
    let count = 30;
    let list = |of: &dyn Fn(usize) -> String| (0..count).map(of).collect::<Vec<_>>().join(", ");
    let lines = format!(
        "x: [{}]\ny: [{}]\nu: [v]\nf_x: {{{}}}\nf_y: {{{}}}",
        list(&|i| format!("p{i}")),
        list(&|i| format!("q{i}")),
        list(&|i| format!("p{i}: v - p{}", (i + 1) % count)),
        list(&|i| format!("q{i}: p{i}")),
    );
    let (_, found) = search(&lines, None);
    assert_eq!(written(&lines, &found), (pebo_gen::analysis::Class::Pebo, count));
}

/// An output that is a sum of states tells one of them by the others: a sine of unknown frequency with a bias, and the
/// way to an unknown level at an unknown rate.
#[test]
fn a_state_that_an_output_combines_with_others_is_no_unknown() {
    for (lines, class, phi) in [
        (
            "x: [p, s, w2, b]\ny: [a]\nassume: [w2 > 0]\nf_x: {p: s, s: -w2*p, w2: 0, b: 0}\ng_y: {a: p + b}",
            pebo_gen::analysis::Class::Gpebo,
            vec!["s", "w2", "w2*b"],
        ),
        (
            "x: [c, k, b]\ny: [m]\nf_x: {c: -k*c, k: 0, b: 0}\ng_y: {m: c + b}",
            pebo_gen::analysis::Class::Pebo,
            vec!["k", "k*b"],
        ),
    ] {
        let (_, found) = search(lines, None);
        assert_eq!(written(lines, &found), (class, phi.len()), "{lines}");
        assert_eq!(found.candidates[0].formulas(), phi, "{lines}");
    }
}

/// A hysteresis whose rate is non-smooth in its state, which an output shows beside an input (Bouc and Wen): the states
/// themselves, in whose rates the output stands for them.
#[test]
fn a_non_smooth_rate_holds_what_an_output_shows() {
    let lines = "x: [h]\ny: [p]\nu: [v, r]\nf_x: {h: r - abs(r)*h/4 - r*abs(h)/8}\ng_y: {p: v - h}";
    let (_, found) = search(lines, None);
    assert_eq!(written(lines, &found), (pebo_gen::analysis::Class::Pebo, 1));
    assert_eq!(found.candidates[0].formulas(), ["h"]);
}

/// A vehicle's heading and rate of turn from its distances to two beacons: where these stand for its place in the transform,
/// their values say nothing of how it moves, and their rates do.
#[test]
fn what_values_do_not_show_their_rates_may() {
    let lines = "parameters: {d: 20}\nx: [px, py, th, om]\ny: [r1, r2]\nu: [v]\nassume: [r1 > 0, r2 > 0, py > 0]\n\
                 angles: {th: 2*pi}\nf_x: {px: v*cos(th), py: v*sin(th), th: om, om: 0}\n\
                 g_y: {r1: sqrt(px^2 + py^2), r2: sqrt((px - d)^2 + py^2)}";
    let (_, found) = search(lines, None);
    assert_eq!(found.verdict, SearchVerdict::Undecided, "its own speed tells it where it heads");
    assert!(!found.candidates.iter().any(pebo_gen::search::Candidate::hides_states));
}

/// A state that an output tells by its value is as good as measured.
#[test]
fn a_state_that_an_output_tells_is_no_unknown() {
    for (lines, components) in [
        ("x: [th, om]\ny: [m]\nu: [F]\nf_x: {th: om, om: F - sin(th) - 0.1*om}\ng_y: {m: th}", 1),
        (
            "parameters: [k, c]\nassume: [k > 0]\nx: [th, om]\ny: [m]\nu: [F]\n\
             f_x: {th: om, om: F - sin(th) - 0.1*om}\ng_y: {m: k*th + c}",
            1,
        ),
        ("x: [pos, vel]\ny: [m]\nu: [F]\nf_x: {pos: vel, vel: F - pos^3 - vel*pos^2}\ng_y: {m: pos}", 1),
        // Biomass and its rate of growth from its product, which is estimated too: its samples are noisy.
        ("x: [X, mu]\ny: [Q]\nu: [D]\nassume: [X > 0, mu > 0]\nf_x: {X: mu*X - D*X, mu: 0}\ng_y: {Q: mu*X}", 2),
    ] {
        // A plain cascade would take samples of the output for the rate of the state.
        let (_, found) = search(lines, None);
        assert_eq!(written(lines, &found), (pebo_gen::analysis::Class::Gpebo, components), "{lines}");
    }
}

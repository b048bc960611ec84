//! Decisions on plants that are made from their transforms: none of them may be excluded.

use proptest::prelude::*;

use super::bounds::{Bound, BoundClass, largest};
use super::closure::closure;
use super::closure::darboux::invariant;
use super::closure::observable::observable;
use super::completion::decision::decided;
use super::problem::Problem;
use super::symmetry::{SymmetryKind, symmetry};
use super::{Declaration, SearchVerdict, solve, symmetry_beside};
use crate::analysis::{AtEstimate, Class};
use crate::model::Model;
use crate::plant::Plant;
use crate::source::Source;
use pebo_cas::{Expr, Symbol};

fn plant(lines: &str) -> Plant {
    let source = Source::new("m.yaml", format!("model: m\n{lines}\n")).expect("a text");
    let model = Model::parse(&source).unwrap_or_else(|d| panic!("{lines}: {}", d[0].message));
    Plant::resolve(&model).unwrap_or_else(|d| panic!("{lines}: {}", d[0].message))
}

/// The decision on one class, for two values of the parameters.
fn both(lines: &str, class: BoundClass) -> Vec<Bound> {
    let plant = plant(lines);
    let problem = Problem::of(&plant);
    (0..2).filter_map(|others| decided(&problem, class, others)).collect()
}

/// A function of these, with small coefficients.
fn function(symbols: &'static [&'static str]) -> impl Strategy<Value = String> {
    let leaf = prop_oneof![
        prop::sample::select(symbols).prop_map(str::to_owned),
        prop::sample::select(symbols).prop_map(|s| format!("sin({s})")),
        prop::sample::select(symbols).prop_map(|s| format!("cos({s})")),
        prop::sample::select(symbols).prop_map(|s| format!("{s}^2")),
        prop::sample::select(symbols).prop_map(|s| format!("exp({s})")),
        prop::sample::select(symbols).prop_map(|s| format!("1/(1 + {s}^2)")),
    ];
    let term = (-3..=3_i32, prop::collection::vec(leaf, 1..=2))
        .prop_map(|(factor, factors)| format!("({factor})*{}", factors.join("*")));
    prop::collection::vec(term, 1..=2).prop_map(|terms| terms.join(" + "))
}

/// The derivative of a formula, as a formula.
fn slope(formula: &str, by: &str) -> String {
    let names = "x: [a, b]\ny: [p, q]\nu: [u, v]\nf_x: {a: 0, b: 0}";
    let plant = plant(&format!("{names}\nf_y: {{p: {formula}, q: 0}}"));
    let arena = &plant.arena;
    let rate = plant.y[0].rate.expect("a rate").expr;
    let by = plant.x.iter().map(|x| x.symbol).chain(plant.y.iter().map(|y| y.symbol)).find(|s| arena.name(*s) == by);
    arena.print(arena.derivative(rate, by.expect("a signal")))
}

/// The plant in which `(m a + s, n b + t + k a)` have rates free of x.
fn made(m: &str, k: &str, shifts: [&str; 2], rates: [&str; 2], outputs: [&str; 2]) -> String {
    let along = |formula: &str| {
        format!("(({})*({}) + ({})*({}))", slope(formula, "p"), outputs[0], slope(formula, "q"), outputs[1])
    };
    // z1 = e^m a + s, z2 = b + t + k a
    let first = format!("exp(-({m}))*({} - {}) - a*{}", rates[0], along(shifts[0]), along(m));
    let second = format!("{} - {} - a*{} - ({k})*({first})", rates[1], along(shifts[1]), along(k));
    let [p, q] = outputs;
    format!("x: [a, b]\ny: [p, q]\nu: [u, v]\nf_x: {{a: {first}, b: {second}}}\nf_y: {{p: {p}, q: {q}}}")
}

const Y: &[&str] = &["p", "q"];

/// A relation names the state that it is about: an unknown constant is a transform, with a slope by itself.
#[test]
fn a_relation_among_the_gradients_holds_of_the_constants_that_are_transforms() {
    let plant = plant("x: [psi, b]\ny: [p, q]\nu: [r]\nf_x: {psi: r - b, b: 0}\nf_y: {p: cos(psi), q: sin(psi)}");
    let problem = Problem::of(&plant);
    let bound = largest::smooth_to(&problem, 4, 0).expect("a bound");
    assert!(bound.excludes() && bound.rank == 1, "{bound:?}");
    let arena = &plant.arena;
    let entries: Vec<bool> = bound.relations[0].iter().map(|entry| arena.is_zero(*entry)).collect();
    assert_eq!(entries, [false, true], "dphi/dpsi = 0, as phi = b is a transform");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// A transform affine in x is neither excluded among the affine ones nor among the smooth ones.
    #[test]
    fn what_has_a_transform_affine_in_x_is_not_excluded(
        m in function(Y), k in function(Y), s in function(Y), t in function(Y), h in function(&["p", "q", "u", "v"]),
        c in function(&["p", "u"]), d in function(&["q", "v"]),
    ) {
        let lines = made(&m, &k, [&s, &t], [&h, "v"], [&format!("a + ({c})*b"), &format!("b*({d}) + u")]);
        for class in [BoundClass::Affine, BoundClass::Smooth] {
            for bound in both(&lines, class) {
                prop_assert_eq!(bound.rank, 2, "{}", lines);
                prop_assert!(bound.transforms().is_none_or(|count| count >= 2), "{}", lines);
            }
        }
        let plant = plant(&lines);
        let problem = Problem::of(&plant);
        let smooth = largest::smooth(&problem, largest::affine(&problem, 0).as_ref(), 0);
        prop_assert!(smooth.is_none_or(|bound| bound.rank == 2), "{}", lines);
    }

    /// A transform that is not affine in x is not excluded among the smooth ones.
    #[test]
    fn what_has_a_smooth_transform_is_not_excluded(
        g in function(&["b", "q"]), t in function(Y), h in function(&["p", "q", "u"]), c in function(&["b", "p"]),
    ) {
        // z1 = a + g(b, q), z2 = b + t(p, q)
        let (p, q) = (format!("a + {c}"), "b*u".to_owned());
        let along = |by: &str, of: &str| format!("({})*({of})", slope(&t, by));
        let second = format!("v - {} - {}", along("p", &p), along("q", &q));
        let first = format!("{h} - ({})*({second}) - ({})*({q})", slope(&g, "b"), slope(&g, "q"));
        let lines =
            format!("x: [a, b]\ny: [p, q]\nu: [u, v]\nf_x: {{a: {first}, b: {second}}}\nf_y: {{p: {p}, q: {q}}}");
        for bound in both(&lines, BoundClass::Smooth) {
            prop_assert_eq!(bound.rank, 2, "{}", lines);
        }
        let plant = plant(&lines);
        let problem = Problem::of(&plant);
        let smooth = largest::smooth(&problem, largest::affine(&problem, 0).as_ref(), 0)
            .or_else(|| largest::smooth_to(&problem, 2, 0));
        prop_assert!(smooth.is_none_or(|bound| bound.rank == 2), "{}", lines);
    }
}

/// Plants, and the direction of the states that no output shows.
#[test]
fn symmetries_are_those_that_no_output_shows() {
    let cases = [
        // A shift of two positions; and one of a velocity with an unmeasured signal.
        ("x: [a, b, v]\ny: [q]\nf_x: {a: v, b: v, v: 0}\nf_y: {q: (a - b)*v}", Some("a 1, b 1")),
        ("x: [v]\ny: [q]\nw: [f]\nf_x: {v: f}\nf_y: {q: 1}", Some("v 1")),
        (
            "x: [s, u, z]\ny: [d, m]\nw: [r]\nf_x: {s: -d - s + u, u: d - z, z: u - r}\nf_y: {d: s - u}\ng_y: {m: s - u - d}",
            Some("s 1, u 1"),
        ),
        // A gain and the signal that it multiplies.
        ("x: [k, p]\ny: [q]\nf_x: {k: 0, p: -p}\nf_y: {q: k*p}", Some("k k, p -p")),
        // The input shows the gain, the square all but a sign, the sine all but a turn.
        ("x: [k, p]\ny: [q]\nu: [u]\nf_x: {k: 0, p: u - p}\nf_y: {q: k*p}", None),
        ("x: [p]\ny: [q]\nf_x: {p: -p}\nf_y: {q: p^2}", Some("p to -p")),
        ("x: [p]\ny: [q]\nf_x: {p: 1}\nf_y: {q: sin(p)}", None),
        // Gases of which the sum is measured: a shift from one to the other decays. A gas that leaves faster is shown.
        (
            "x: [a, b]\ny: [p]\nu: [u]\nassume: [a > 0, b > 0]\nf_x: {a: u - a*(a + b), b: 1 - b*(a + b)}\ng_y: {p: a + b}",
            Some("a 1, b -1"),
        ),
        (
            "x: [a, b]\ny: [p]\nu: [u]\nassume: [a > 0, b > 0]\nf_x: {a: u - a*(a + b), b: 1 - 2*b*(a + b)}\ng_y: {p: a + b}",
            None,
        ),
        // Two of three, the third carried into them; and with an unmeasured signal.
        ("x: [a, b, c]\ny: [p]\nf_x: {a: b*sin(p), b: c*p, c: -c*b^2}\nf_y: {p: -p}", Some("a 1")),
        ("x: [a, b, c]\ny: [p]\nw: [f]\nf_x: {a: f - p*a, b: c - f - p*b, c: -c}\nf_y: {p: a + b}", Some("a 1, b -1")),
        // Rates of turn about two axes; one of them known to be positive, or shown at a threshold that is no even one.
        ("x: [a, b]\ny: [r]\nf_x: {a: b*r, b: -2*a*r}\nf_y: {r: a*b}", Some("a to -a, b to -b")),
        ("x: [a, b]\ny: [r]\nassume: [a > 0]\nf_x: {a: b*r, b: -2*a*r}\nf_y: {r: a*b}", None),
        ("x: [a, b]\ny: [r]\nf_x: {a: b*r, b: -2*a*r}\nf_y: {r: a*b + abs(a - 1)}", None),
        ("x: [a, b]\ny: [r]\nf_x: {a: b*r, b: -2*a*r}\nf_y: {r: a*b + abs(a)}", Some("a to -a, b to -b")),
        // A formula that has values for one sign alone.
        ("x: [a]\ny: [r]\nf_x: {a: -a}\nf_y: {r: sqrt(a)^4}", None),
        // A state that is zero is its opposite.
        ("x: [a, b]\ny: [r]\nf_x: {a: -a, b: 0}\nf_y: {r: b^3 + a^2}\nidentities: [a]", None),
        // A load that the motor's unmeasured torque turns with it.
        ("x: [p]\ny: [q]\nw: [f]\nf_x: {p: f}\nf_y: {q: p^2}", Some("p to -p")),
        // An identity determines what the outputs do not.
        ("x: [a, b]\ny: [q]\nf_x: {a: 0, b: 0}\nf_y: {q: a - b}\nidentities: [a*b - 2]", None),
        // Two equal states: what moves them apart vanishes, what moves both grows.
        (
            "x: [a, b]\ny: [q]\nf_x: {a: (5*a - b)/2, b: (a + 3*b)/2}\nf_y: {q: a - b}\nidentities: [a - b]",
            Some("a 1, b 1"),
        ),
        // Two tanks of the same size, two constants, two pairs of coordinates; tanks that differ, and an order of constants.
        (
            "x: [a, b]\ny: [q]\nassume: [a > 0, b > 0]\nf_x: {a: q - sqrt(a), b: q - sqrt(b)}\nf_y: {q: a^3 + b^3}",
            Some("a to b, b to a"),
        ),
        ("x: [a, b]\ny: [q]\nu: [u]\nf_x: {a: 0, b: 0}\nf_y: {q: exp(a*u) + exp(b*u)}", Some("a to b, b to a")),
        (
            "x: [a, b, c, d]\ny: [q, r]\nu: [u]\nf_x: {a: u, b: u^2, c: u, d: u^2}\nf_y: {q: a^3 + c^3, r: a*b + c*d}",
            Some("a to c, b to d, c to a, d to b"),
        ),
        ("x: [a, b]\ny: [q]\nf_x: {a: q - a, b: q - 2*b}\nf_y: {q: a^3 + b^3}", None),
        ("x: [a, b]\ny: [q]\nu: [u]\nassume: [a > b]\nf_x: {a: 0, b: 0}\nf_y: {q: exp(a*u) + exp(b*u)}", None),
        // Of an output without an equation nothing is known.
        ("x: [a, b]\ny: [q, r]\nf_x: {a: 0, b: 0}\nf_y: {q: a - b}", None),
    ];
    for (lines, expected) in cases {
        let plant = plant(lines);
        let found = symmetry(&Problem::of(&plant)).unwrap();
        let shown = found.map(|found| {
            let verb = if found.kind == SymmetryKind::Direction { "" } else { " to" };
            let of = |(state, entry): &(Symbol, Expr)| {
                format!("{}{verb} {}", plant.arena.name(*state), plant.arena.print(*entry))
            };
            found.states.iter().map(of).collect::<Vec<_>>().join(", ")
        });
        assert_eq!(shown.as_deref(), expected, "{lines}");
    }
}

/// A sign that a declaration decides leaves the search undecided; where none does, there is no observer.
#[test]
fn a_plant_that_lacks_a_sign_is_not_refused() {
    let lacking = solve(&plant("x: [p]\ny: [q]\nf_x: {p: -p}\nf_y: {q: p^2}"), None);
    assert_eq!(
        (lacking.verdict, lacking.declared.len(), lacking.is_unobservable),
        (SearchVerdict::Undecided, 1, false)
    );
    let alike = solve(&plant("x: [a, b]\ny: [q, r]\nf_x: {a: 0, b: 0}\nf_y: {q: a + b, r: a*b}"), None);
    let declared: Vec<String> = alike.declared.iter().map(|(found, order)| order.lines(&found.plant)).collect();
    assert_eq!((alike.verdict, declared), (SearchVerdict::Undecided, vec!["`assume: [a > b]`".to_owned()]));
    let same = solve(&plant("x: [a, b]\ny: [q]\nu: [u]\nf_x: {a: 0, b: 0}\nf_y: {q: exp(a*u) + exp(b*u)}"), None);
    assert_eq!((same.verdict, same.is_unobservable), (SearchVerdict::None, true));
    let turned = solve(&plant("x: [a, b]\ny: [r]\nf_x: {a: b*r, b: -2*a*r}\nf_y: {r: a*b}"), None);
    assert_eq!((turned.verdict, turned.is_unobservable), (SearchVerdict::None, true));
}

/// An unknown that enters nonlinearly is offered a local observer, unless another state has the same outputs; where the
/// model asks for it, it has one.
#[test]
fn a_local_regression_is_offered() {
    let lines = "x: [n]\ny: [v]\nu: [F]\nassume: [v > 0]\nf_x: {n: 0}\nf_y: {v: F - exp(n*v) - exp(-n)}";
    let offered = solve(&plant(lines), None);
    let declared: Vec<&Declaration> = offered.declared.iter().map(|(_, declaration)| declaration).collect();
    assert_eq!((offered.verdict, declared), (SearchVerdict::Undecided, vec![&Declaration::Local]));
    let asked = solve(&plant(&format!("{lines}\nregression: local")), None);
    assert_eq!((asked.verdict, asked.declared.len()), (SearchVerdict::Found, 0));
    // What its estimate may converge to instead is told beside it.
    let alike = "x: [a, b]\ny: [q]\nu: [u]\nregression: local\nf_x: {a: 0, b: 0}\nf_y: {q: exp(a*u) + exp(b*u)}";
    let beside = |lines: &str| {
        let near = plant(lines);
        let found = solve(&near, None).candidates.swap_remove(0);
        assert!(found.is_full(), "{lines}");
        symmetry_beside(&found.plant, &found.derivation).map(|symmetry| symmetry.kind)
    };
    assert_eq!(beside(alike), Some(SymmetryKind::Exchange));
    assert_eq!(beside(&format!("{alike}\nassume: [a > b]")), None);
    // A direction that is not affine, along which the outputs are the same: no search asks for it, and it is proved.
    let hidden = solve(&plant("x: [a, b]\ny: [y]\nu: [u]\nf_x: {a: 0, b: 0}\nf_y: {y: u*exp(u*(a + b^3))}"), None);
    assert!(hidden.symmetry.is_none() && hidden.candidates[0].hides_states(), "{:?}", hidden.symmetry);
    let even = solve(&plant("x: [n]\ny: [v]\nu: [F]\nf_x: {n: 0}\nf_y: {v: F - cos(n*v)}"), None);
    assert!(even.declared.iter().all(|(_, declaration)| *declaration != Declaration::Local), "{:?}", even.declared);
}

/// Where outputs are monotone in an unknown, no neighbourhood is asked for; what the assumptions lack is told.
#[test]
fn a_monotone_regression_is_found() {
    let drag = "x: [n]\ny: [v]\nu: [F]\nassume: [v > 0]\nf_x: {n: 0}\nf_y: {v: F - v^n}";
    let found = solve(&plant(drag), None);
    assert_eq!((found.verdict, found.candidates[0].formulas()), (SearchVerdict::Found, vec!["n".to_owned()]));
    assert_eq!(found.candidates[0].derivation.at_estimate(), Some(AtEstimate::Monotone));
    let turbine = plant("x: [v]\ny: [w]\nu: [T]\nassume: [v > 0, w > 0]\nf_x: {v: 0}\nf_y: {w: v^3*w*exp(-v/w) - T}");
    let offered = solve(&turbine, None);
    let [(candidate, declared)] = &offered.declared[..] else { panic!("{:?}", offered.declared) };
    assert_eq!((offered.verdict, candidate.is_full()), (SearchVerdict::Undecided, true));
    assert_eq!(declared.lines(&turbine), "`assume: [3*w - v > 0]`");
    // Of a given transform the refusal says how to have it.
    let given = solve(&plant(&format!("{drag}\nphi: [n]")), None);
    let declared: Vec<&Declaration> = given.declared.iter().map(|(_, declaration)| declaration).collect();
    assert_eq!((given.verdict, declared), (SearchVerdict::Undecided, vec![&Declaration::Monotone]));
}

/// Haldane's kinetics: with its denominator multiplied, the rate holds the square of a component.
#[test]
fn a_quotient_is_lifted_by_its_denominator() {
    for denominator in ["1 + S + S^2", "K + S + S^2/L"] {
        let lines = format!(
            "parameters: [K, L]\nx: [S]\ny: [X]\nu: [D]\nassume: [S > 0, X > 0, K > 0, L > 0]\n\
             f_x: {{S: D*(5 - S) - 2*S*X/({denominator})}}\nf_y: {{X: S*X/({denominator}) - D*X}}"
        );
        let found = solve(&plant(&lines), None);
        assert_eq!((found.verdict, found.candidates[0].formulas().len()), (SearchVerdict::Found, 2), "{denominator}");
    }
}

/// A spring that is in contact or not, a heater that is warmer than its surroundings: on one side of the wall there is an
/// observer, which tells what to assume.
#[test]
fn a_side_of_a_wall_is_offered() {
    let assumed = |lines: &str| {
        let plant = plant(lines);
        let offered = solve(&plant, None);
        assert_eq!(offered.verdict, SearchVerdict::Undecided, "{lines}");
        offered.declared.iter().map(|(_, declaration)| declaration.lines(&plant)).collect::<Vec<String>>()
    };
    let contact = "x: [v, q0]\ny: [q]\nu: [F]\nf_x: {v: \"F - 9*max(q - q0, 0)\", q0: 0}\nf_y: {q: v}";
    assert_eq!(assumed(contact), ["`assume: [q - q0 > 0]`"]);
    let heater = "x: [G, Ta]\ny: [T]\nu: [P]\nassume: [G > 0]\nf_x: {G: 0, Ta: 0}\nf_y: {T: \"P - G*max(T - Ta, 0)\"}";
    assert_eq!(assumed(heater), ["`assume: [T - Ta > 0]`"]);
    let friction = "x: [v, F]\ny: [q]\nu: [u]\nf_x: {v: u - F*sign(v) - v, F: 0}\nf_y: {q: v}";
    assert_eq!(assumed(friction), ["`assume: [v > 0]`"]);
}

/// Surfaces with known Killing fields: three on constant curvature, one on a surface of revolution.
#[test]
fn the_number_of_killing_fields_is_that_of_the_surface() {
    let surfaces = [
        // A plane in polar coordinates, a sphere, a cone, a torus, and a surface without symmetry.
        ("1", "r^2", 2, 3),
        ("1", "sin(r)^2", 2, 3),
        ("2", "r^2", 2, 3),
        ("1", "(2 + cos(r))^2", 1, 1),
        ("1 + t^2", "1 + r^2*t", 0, 0),
    ];
    for (first, second, rank, count) in surfaces {
        let lines = format!(
            "x: [a, b]\ny: [r, t]\nu: [u, v]\nassume: [r > 0, t > 0]\nmechanical: {{M: [[{first}, 0], [0, {second}]], \
             V: 0, G: [[1, 0], [0, 1]]}}"
        );
        let bounds = both(&lines, BoundClass::Affine);
        assert_eq!(bounds.len(), 2, "{lines}");
        for bound in bounds {
            assert_eq!((bound.rank, bound.transforms()), (rank, Some(count)), "{lines}");
            assert_eq!(bound.relations.len(), 2 - rank, "{lines}");
        }
    }
}

/// Ball and beam in its momenta: the beam's is the one that there is, among all smooth functions.
#[test]
fn ball_and_beam_has_one_killing_field() {
    let lines = "parameters: [m, J, g]\nx: [p1, p2]\ny: [r, th]\nu: [tau]\nassume: [m > 0, J > 0, g > 0]\n\
                 f_x: {p1: m*r*p2^2/(J + m*r^2)^2 - m*g*sin(th), p2: tau - m*g*r*cos(th)}\n\
                 f_y: {r: p1/m, th: p2/(J + m*r^2)}";
    for class in [BoundClass::Affine, BoundClass::Smooth] {
        let bounds = both(lines, class);
        assert!(bounds.len() == 2 && bounds.iter().all(|bound| bound.excludes() && bound.transforms() == Some(1)));
    }
}

/// Formulas of a plant, in the order in which they are found.
fn printed(plant: &Plant, formulas: &[pebo_cas::Expr]) -> Vec<String> {
    formulas.iter().map(|formula| plant.arena.print(*formula)).collect()
}

#[test]
fn polynomials_that_divide_their_own_rates_are_found() {
    for (lines, expected) in [
        ("x: [p]\ny: [q]\nu: [v]\nf_x: {p: p^2 - v*p}\nf_y: {q: p}", &["p"][..]),
        ("x: [p]\ny: [q]\nu: [v]\nf_x: {p: v*(p^2 - 3*p + 2)}\nf_y: {q: p}", &["p - 1", "p - 2"]),
        ("x: [p]\ny: [q]\nu: [v]\nf_x: {p: (p + q)*v - p}\nf_y: {q: p}", &["q + p"]),
        ("parameters: [a]\nx: [p]\ny: [q]\nu: [v]\nf_x: {p: v*(p - a)}\nf_y: {q: p}", &["a - p"]),
        ("x: [p]\ny: [q]\nu: [v]\nf_x: {p: v*(p^2 + q)/(2*p) - 1/2}\nf_y: {q: p}", &["q + p^2"]),
        // Kept for one value of v only.
        ("x: [p]\ny: [q]\nu: [v]\nf_x: {p: p^2 - v}\nf_y: {q: p}", &[]),
        ("x: [p]\ny: [q]\nu: [v]\nf_x: {p: v*sin(p)}\nf_y: {q: p}", &[]),
    ] {
        let plant = plant(lines);
        let found = invariant(&Problem::of(&plant)).expect("no obstacle");
        assert_eq!(printed(&plant, &found), expected, "{lines}");
    }
}

#[test]
fn closures_take_the_functions_of_formulas_as_written() {
    for (lines, expected) in [
        ("f_x: {p: v - q*p, s: v*p - 2*q*s}\nf_y: {q: 2*v*p + 2*s - p^2}", Some(&["p", "s - p^2/2"][..])),
        ("f_x: {p: v - q*p, s: v}\nf_y: {q: p + v*s}", Some(&["p", "s"])),
        // Term by term, as a fraction of exp(p) would overflow.
        (
            "f_x: {p: v*(exp(p) + exp(-p))/(exp(p) - exp(-p)), s: 0}\nf_y: {q: v*(exp(p) + exp(-p))}",
            Some(&["exp(p) + 1/exp(p)"]),
        ),
        ("f_x: {p: v*p*(1 + p), s: 0}\nf_y: {q: 1/(1 + p)}", Some(&["1/(p + 1)"])),
        // Both x and y in the denominator.
        ("f_x: {p: v, s: 0}\nf_y: {q: 1/(q + p)}", None),
    ] {
        let plant = plant(&format!("x: [p, s]\ny: [q]\nu: [v]\n{lines}"));
        let problem = Problem::of(&plant);
        let found = closure(&problem, &problem.output_rates()).expect("no obstacle");
        let expected = expected.map(|formulas| formulas.iter().map(|f| (*f).to_owned()).collect::<Vec<_>>());
        assert_eq!(found.map(|found| printed(&plant, &found)), expected, "{lines}");
    }
}

#[test]
fn unobservable_functions_are_left_out() {
    let plant = plant(
        "x: [S, b, g]\ny: [I]\nf_x: {S: -b*S*I, b: 0, g: 0}\nf_y: {I: b*S*I - g*I}\nphi: [b*S + b*I, b, g, b*g, S]",
    );
    let problem = Problem::of(&plant);
    let all = plant.transform();
    let kept = observable(&problem, &all[..4]).expect("no obstacle");
    assert_eq!(printed(&plant, &kept), ["S*b - g + I*b", "b", "b*g"]);
    // The rate of S is not affine in these.
    assert_eq!(observable(&problem, &all[1..]).expect("no obstacle"), all[1..]);
}

/// An accelerometer beside a position: a plain cascade needs the value of the first, a generalised one does not.
const DRONE: &str = "parameters: {c: 0.35}\nx: [v, wind, bias]\ny: [p, acc]\nu: [a]\nf_x: {v: a - c*(v - wind), \
                     wind: 0, bias: 0}\nf_y: {p: v}\ng_y: {acc: bias - c*(v - wind)}";

#[test]
fn a_transform_that_takes_no_samples_is_preferred_to_a_plainer_one() {
    let plant = plant(DRONE);
    let arena = &plant.arena;
    let [v, acc] = ["v", "acc"].map(|name| arena.symbol(name));
    let best = |class| solve(&plant, class).candidates.swap_remove(0);
    let chosen = best(None);
    assert_eq!((chosen.derivation.class, chosen.formulas()[0].as_str()), (Class::Gpebo, "v"));
    let plain = best(Some(Class::Pebo));
    assert_eq!(plain.unfiltered(), [(v, acc)]);
    assert_eq!(chosen.plant.noisier.map(|noisier| noisier.phi), Some(plain.plant.transform()));
    assert_eq!(plain.plant.noisier, None);
}

/// Pitch and a sensor's bias from two accelerometers and a gyroscope: gravity in the axes of the body turns, and its
/// samples as they are need no model of that.
#[test]
fn functions_that_turn_are_preferred_to_the_samples_that_show_them() {
    let pitch = "parameters: {g: 10}\nx: [th, ba]\ny: [ax, az]\nu: [w]\nangles: {th: 2*pi}\nf_x: {th: w, ba: 0}\n\
                 g_y: {ax: g*sin(th) + ba, az: g*cos(th)}";
    let chosen = solve(&plant(pitch), None).candidates.swap_remove(0);
    assert_eq!(chosen.formulas(), ["ba", "sin(th)", "cos(th)"]);
    assert!(chosen.is_full() && chosen.unfiltered().is_empty());
    let noisier = chosen.plant.noisier.expect("named");
    assert_eq!(noisier.unfiltered.len(), 2);
}

/// A wheel that multiplies its sample by its radius: rates in 1/R say no more. And a wheel that multiplies the speed: a
/// product that is estimated has no sample for a factor.
#[test]
fn few_components_are_preferred_unless_more_of_them_multiply_fewer_samples() {
    let chosen = |lines: &str| solve(&plant(lines), None).candidates.swap_remove(0).formulas();
    let radius = "x: [v, b, R]\ny: [gps, wheel]\nu: [a]\nassume: [R > 0]\nf_x: {v: a - b, b: 0, R: 0}\n\
                  g_y: {gps: v, wheel: v/R}";
    assert_eq!(chosen(radius), ["v", "b", "R"]);
    let grade = "parameters: {g: 10, c: 0.2}\nx: [v, s, k]\ny: [p, wheel, acc]\nu: [F]\n\
                 f_x: {v: F - c*v - g*s, s: 0, k: 0}\nf_y: {p: v}\ng_y: {wheel: k*v, acc: F - c*v}";
    assert_eq!(chosen(grade), ["v", "s", "k", "v*k", "s*k"]);
}

/// Single-track cars, tanks and epidemics, whose outputs are given by value.
#[test]
fn transforms_that_use_all_outputs_everywhere_are_preferred() {
    let found = |lines: &str| {
        let chosen = solve(&plant(lines), None).candidates.swap_remove(0);
        assert!(chosen.is_full(), "{lines}");
        (chosen.formulas(), chosen.exceptions())
    };
    // Without the lateral acceleration, neutral steer would be an exception.
    let car = "parameters: {m: 1500, I: 2500, f: 1.2, g: 1.5}\nx: [v, cf, cr]\ny: [r, a]\nu: [d, s]\n\
               assume: [s > 0, cf > 0, cr > 0]\ndefine: {front: cf*(d - (v + f*r)/s), rear: cr*(g*r - v)/s}\n\
               f_x: {v: (front + rear)/m - s*r, cf: 0, cr: 0}\nf_y: {r: (f*front - g*rear)/I}\n\
               g_y: {a: (front + rear)/m}";
    let all = |formulas: &[&str]| (formulas.iter().map(ToString::to_string).collect::<Vec<_>>(), (0, 0));
    assert_eq!(found(car), all(&["cf", "cr", "v*cf", "v*cr"]));
    // The sample of the outflow less itself filters nothing.
    let tank = "parameters: {k: 0.1}\nx: [h]\ny: [p, q]\nu: [v]\nassume: [p > 0, h > 0]\n\
                f_x: {h: k*sqrt(p) - k*sqrt(h)}\nf_y: {p: v - k*sqrt(p)}\ng_y: {q: k*sqrt(h)}";
    assert_eq!(found(tank), all(&["h"]));
    // What is reported is a part of the infected, who are known by it.
    let epidemic = "parameters: {g: 0.1, b: 0.4}\nx: [s, i, k]\ny: [r]\nassume: [i > 0, s > 0, k > 0]\n\
                    f_x: {s: -b*s*i, i: b*s*i - g*i, k: 0}\ng_y: {r: k*i}";
    assert_eq!(found(epidemic), all(&["s + r/k", "1/k"]));
}

#[test]
fn a_plain_cascade_is_preferred_where_no_value_of_an_output_is_needed() {
    let plant = plant("parameters: {c: 0.35}\nx: [v]\ny: [p]\nu: [a]\nf_x: {v: a - c*v}\nf_y: {p: v}");
    let chosen = solve(&plant, None).candidates.swap_remove(0);
    assert_eq!((chosen.derivation.class, chosen.plant.noisier), (Class::Pebo, None));
}

#[test]
fn states_are_recovered_without_those_that_outputs_do_not_tell_apart() {
    let rates = "y: [q, r, s]\nu: [v]\nf_y: {q: a - q, r: b + c}";
    let search =
        solve(&plant(&format!("x: [a, b, c]\n{rates}\nf_x: {{a: v, b: 0, c: 0}}\ng_y: {{s: a + b + c}}")), None);
    let (candidate, declaration) = search.declared.into_iter().next_back().expect("a partial observer");
    assert_eq!(declaration.lines(&candidate.plant), "`x: [a]`, `w: [b, c]`");
    let written = plant(&format!("x: [a]\nw: [b, c]\n{rates}\nf_x: {{a: v}}"));
    let written = solve(&written, None).candidates.swap_remove(0);
    assert!(written.is_full());
    assert_eq!(written.formulas(), candidate.formulas());
}

#[test]
fn a_state_whose_rate_no_transform_covers_is_an_unmeasured_signal() {
    let lines = "x: [v, d]\ny: [q, s]\nu: [f]\nf_x: {v: f, d: f*sin(d) + log(v)}\nf_y: {q: v, s: d^3}";
    let (candidate, declaration) =
        solve(&plant(lines), None).declared.into_iter().next_back().expect("a partial observer");
    assert_eq!(declaration.lines(&candidate.plant), "`x: [v]`, `w: [d]`");
    // The rate of d is unknown, and so is that v is positive.
    assert!(candidate.plant.conditions.is_empty() && candidate.derivation.conditions.is_empty());
}

#[test]
fn the_sensor_that_is_lacking_is_named() {
    // The output's rate holds the exponential of w, and no rate is affine in what it needs.
    let lines = "x: [a, w, b]\ny: [q]\nu: [v]\nf_x: {a: b*sin(w), w: v - a*exp(w), b: 0}\nf_y: {q: exp(w)}";
    let declared = solve(&plant(lines), None).declared;
    let lines: Vec<String> = declared.iter().map(|(found, lacking)| lacking.lines(&found.plant)).collect();
    assert_eq!(lines[0], "`x: [a, b]`, `y: [q, w]`", "{lines:?}");
}

#[test]
fn a_state_in_friction_may_keep_its_sign() {
    let friction = "parameters: {J: 2}\nx: [w, c]\ny: [q]\nu: [i]\nf_x: {w: (i - c*sign(w))/J, c: 0}\nf_y: {q: w}";
    let (candidate, declaration) = solve(&plant(friction), None).declared.swap_remove(0);
    assert_eq!(declaration.lines(&candidate.plant), "`assume: [w > 0]`");
    assert!(candidate.is_full());
}

#[test]
fn a_transform_without_exceptions_comes_before_a_plain_cascade_with_one() {
    let lines = "x: [a, b]\ny: [r, s]\nu: [w]\nf_x: {a: -a*w, b: 0}\nf_y: {r: r*w, s: a + r*b}";
    let candidates = solve(&plant(lines), None).candidates;
    assert_eq!(candidates[0].formulas(), ["a", "b"]);
    assert!(candidates[0].derivation.class == Class::Gpebo && candidates[0].is_everywhere());
    // r*a is constant, but says nothing of a while r is zero.
    let plain = candidates.iter().find(|other| other.derivation.class == Class::Pebo).expect("a plain cascade");
    assert_eq!(plain.formulas(), ["b", "r*a"]);
    let noisier = candidates[0].plant.noisier.as_ref().expect("named");
    assert!(noisier.phi == plain.plant.transform() && noisier.unfiltered.is_empty());
    assert_eq!(noisier.conditions.len(), 1);
}

#[test]
fn a_frame_may_turn_with_an_angle_that_no_rate_holds() {
    // A body around a centre of unknown mass: its velocity in axes that do not turn.
    let orbit = "x: [v, o, m]\ny: [r, s]\nu: [f, g]\nassume: [r > 0, m > 0]\n\
                 f_x: {v: r*o^2 - m/r^2 + f, o: (g - 2*v*o)/r, m: 0}\nf_y: {r: v, s: o}";
    let found = solve(&plant(orbit), None).candidates.swap_remove(0);
    assert!(found.is_full() && found.derivation.class == Class::Gpebo, "{:?}", found.formulas());
}

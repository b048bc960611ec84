//! The plant's equilibrium under a constant input (Ortega et al. 2015, Section 2.5 and remark R5).
//!
//! In: a plant with a proved cascade. Out: states, and inputs where the states leave equations, as functions of the
//! free ones, with the proof that every rate and `h` vanish there.
//!
//! Elimination proposes points; the zero test checks them within the assumed domain.

use std::collections::{BTreeMap, BTreeSet};

use crate::plant::Plant;
use pebo_cas::domain::zero::{Answer, decide, is_zero};
use pebo_cas::forms::oriented::Orientation;
use pebo_cas::graph::conditions::Regularity;
use pebo_cas::tower::Obstacle;
use pebo_cas::{Arena, Domain, Expr, Relation, Symbol};

use super::remark::{Equilibrium, OperatingPoint};
use crate::analysis::design::{Cascade, Derivation, Verdict};
use pebo_cas::forms::tidy::{operations, shortest_oriented};
use pebo_cas::solve::elimination::Elimination;

/// The share of the command's remaining budget for this search: one part in so many.
const SHARE: u64 = 4;

/// The share of the remaining budget for all equilibria: most is for the proof of the one that was found.
const FOR_ALL: u64 = 64;

/// Operations from which on a value is printed as it was found, and an unsolved equation is not printed.
const MOST_TIDIED: usize = 40;

/// Said where equilibria were found, but none in the domain of the observer.
const NONE_WITHIN: &str = "no equilibrium that was looked at lies within the assumptions and conditions";

impl Equilibrium {
    /// Looks for the operating points of a plant; none without a proved cascade.
    pub(in crate::analysis) fn of(plant: &Plant, derivation: &Derivation) -> Option<Self> {
        let cascade = derivation.cascade.result.as_ref().filter(|_| derivation.cascade.verdict == Verdict::Proved)?;
        let domain = derivation.domain(plant);
        // An equilibrium is advice: most of the budget is for emitting the observer.
        plant.arena.budget().share(SHARE, || {
            let found = found(plant, &domain, cascade).unwrap_or_else(|obstacle| Self::Undecided(obstacle.to_string()));
            Some(match found {
                Self::Undecided(_) if plant.arena.budget().is_exhausted() => {
                    Self::Undecided(Obstacle::OutOfBudget.to_string())
                }
                found => found,
            })
        })
    }
}

fn found(plant: &Plant, domain: &Domain, cascade: &Cascade) -> Result<Equilibrium, Obstacle> {
    let arena = &plant.arena;
    if let Some(output) = plant.y.iter().find(|output| output.rate.is_none() && output.value.is_none()) {
        return Ok(Equilibrium::Undecided(format!("give the rate of `{}`", arena.name(output.symbol))));
    }
    let rates = rates_of_signals(plant);
    if let Some(time) = plant.time
        && rates.values().any(|rate| arena.depends_on(*rate, &BTreeSet::from([time])))
    {
        return Ok(Equilibrium::Undecided(format!("the rates depend on the time `{}`", arena.name(time))));
    }
    let states = plant.x.iter().map(|s| s.symbol).chain(plant.y.iter().map(|o| o.symbol)).collect();
    let inputs = plant.commanded().chain(plant.w.iter().copied()).collect();
    let mut doubtful = None;
    let mut equilibrium_on = |domain: &Domain, values: &BTreeMap<Symbol, Expr>| match checked(plant, domain, values) {
        Ok(there) => Some((values.clone(), there)),
        Err(reason) => {
            doubtful.get_or_insert(reason);
            None
        }
    };
    let mut equilibrium = |values: &BTreeMap<Symbol, Expr>| equilibrium_on(domain, values);
    let search = Elimination { arena, domain, states, inputs };
    let identities = plant.identities.iter().map(|identity| identity.expr);
    let equations: Vec<Expr> = rates.values().copied().chain(identities).collect();
    // If an equilibrium of the unmeasured states is too hard to find, zero is tried, as for momenta.
    let still = plant.x.iter().map(|state| (state.symbol, arena.zero())).collect();
    let searched = arena.budget().share(2, || search.run(&equations, &[BTreeMap::new(), still], &mut equilibrium));
    // Values may hold unmeasured states: no group is kept out of them.
    let order = [vec![BTreeSet::new()], plant.elimination_order()].concat();
    let families = arena.budget().share(FOR_ALL, || domain.components(arena, &equations, &[], &order));
    let is_nowhere = families.as_ref().is_ok_and(Vec::is_empty);
    let mut families = families.unwrap_or_default();
    // With as many free signals as there may be: walls between cells come last.
    families.sort_by_key(|family| family.domain.manifold.reduced(arena).len());
    let is_all = |values: &BTreeMap<Symbol, Expr>| {
        let [family] = families.as_slice() else { return false };
        // Where the family gives all its symbols, their values take their places, and no equation is left.
        let given = family.domain.manifold.values();
        let there = given.as_ref().and_then(|given| family.domain.restricted(arena, given));
        let (given, there) = (given.unwrap_or_default(), there.as_ref().unwrap_or(&family.domain));
        values.iter().all(|(symbol, value)| {
            let apart = arena.sub(arena.of_symbol(*symbol), *value);
            is_zero(arena, arena.substitute(apart, &given), there)
        })
    };
    // Those of all parameters: others are points of no plant of this file.
    let of_signals = |values: &BTreeMap<Symbol, Expr>| {
        plant.parameters.iter().all(|parameter| !values.contains_key(&parameter.symbol))
    };
    // All equilibria rather than one of them.
    let family = match &searched {
        Ok(Ok((values, _))) if is_all(values) => None,
        Ok(Ok(_)) if families.len() != 1 => None,
        _ => families.iter().find_map(|family| {
            let values = family.domain.manifold.values().filter(of_signals)?;
            Some((family, equilibrium_on(&family.domain, &values)?))
        }),
    };
    let (sides, complete, searched) = match (family, searched) {
        (Some((family, found)), _) => (family.distinct_sides(arena, domain), families.len() == 1, Ok(Ok(found))),
        (None, Ok(Ok(found))) => (Vec::new(), is_all(&found.0), Ok(Ok(found))),
        (None, searched) => (Vec::new(), false, searched),
    };
    // At an equilibrium nothing moves: a state that always moves is looked for only if no such point was found. It does
    // not rest where a condition of the observer alone does not hold either.
    let mut assumed = plant.assumed();
    for (part, relation) in arena.domain_conditions(&equations, Regularity::Defined) {
        assumed.facts.assume(part, relation);
    }
    if !matches!(searched, Ok(Ok(_)))
        && let Some((symbol, _)) = rates.iter().find(|(_, rate)| assumed.implies(arena, **rate, Relation::NonZero))
    {
        return Ok(Equilibrium::Nowhere(*symbol));
    }
    let (values, there) = match searched? {
        Ok(found) => found,
        Err(_) if is_nowhere => return Ok(Equilibrium::Undecided(NONE_WITHIN.to_owned())),
        Err(stuck) => {
            let contradiction = arena.symbols_of(&[stuck]).is_empty();
            let reason = doubtful.unwrap_or_else(|| match contradiction {
                true => "every way of solving for it that was tried ends in a contradiction".to_owned(),
                false if operations(arena, stuck) > MOST_TIDIED => {
                    "no rule solves the equations that are left".to_owned()
                }
                false => format!("no rule solves `{}` = 0", arena.print(stuck)),
            });
            return Ok(Equilibrium::Undecided(reason));
        }
    };
    let still = flow(plant, cascade).into_iter().all(|rate| vanishes(arena, rate, &values, &there));
    let order = plant.x.iter().map(|s| s.symbol).chain(plant.y.iter().map(|o| o.symbol));
    let order = order.chain(plant.commanded()).chain(plant.w.iter().copied());
    let orientation = Orientation::new(arena, &there);
    let printed = |value: Expr| match operations(arena, value) {
        // Its normal form would be longer than anybody reads, and take longer than all claims.
        MOST_TIDIED.. => value,
        _ => orientation.of(shortest_oriented(arena, &orientation, value)),
    };
    let values = order.filter_map(|s| Some((s, printed(*values.get(&s)?)))).collect();
    Ok(Equilibrium::At(OperatingPoint { values, sides, complete, still, rank: rank(arena, domain, rates.values()) }))
}

/// The rates of all signals but time.
fn rates_of_signals(plant: &Plant) -> BTreeMap<Symbol, Expr> {
    let mut rates = plant.rates();
    rates.retain(|symbol, _| plant.time != Some(*symbol));
    rates
}

/// The domain of the free symbols, with the proof that every rate and identity vanishes there; else the
/// reason.
fn checked(plant: &Plant, domain: &Domain, values: &BTreeMap<Symbol, Expr>) -> Result<Domain, String> {
    let arena = &plant.arena;
    let there = domain.restricted(arena, values).ok_or_else(|| NONE_WITHIN.to_owned())?;
    match rates_of_signals(plant).iter().find(|(_, rate)| !vanishes(arena, **rate, values, &there)) {
        Some((symbol, _)) => Err(format!("the rate of `{}` was not shown to vanish", arena.name(*symbol))),
        None if plant.identities.iter().any(|identity| !vanishes(arena, identity.expr, values, &there)) => {
            Err("the identities were not shown to hold at the equilibrium".to_owned())
        }
        None => Ok(there),
    }
}

fn vanishes(arena: &Arena, expr: Expr, values: &BTreeMap<Symbol, Expr>, there: &Domain) -> bool {
    is_zero(arena, arena.substitute(expr, values), there)
}

/// z' as the cascade has it: `h`, or `Lambda phi + h`.
fn flow(plant: &Plant, cascade: &Cascade) -> Vec<Expr> {
    let arena = &plant.arena;
    let Some(lambda) = &cascade.lambda else { return cascade.h.clone() };
    let phi = plant.transform();
    let moved = lambda.iter().map(|row| arena.dot(row, &phi));
    moved.zip(&cascade.h).map(|(moved, h)| arena.add(moved, *h)).collect()
}

/// The rank of the column `[f; h_i]` at almost every point: 1 if an entry is not zero. As `h_i` is a combination of the
/// rates, the rates decide.
fn rank<'a>(arena: &Arena, domain: &Domain, mut rates: impl Iterator<Item = &'a Expr> + Clone) -> Option<usize> {
    let answers = || rates.clone().map(|rate| decide(arena, *rate, domain));
    if answers().any(|answer| matches!(answer, Answer::NonZero(_))) {
        return Some(1);
    }
    rates.all(|rate| is_zero(arena, *rate, domain)).then_some(0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::Model;
    use crate::source::Source;

    fn of(lines: &str) -> (Plant, Option<Equilibrium>) {
        let text = format!("model: m\n{lines}\n");
        let plant = Plant::resolve(&Model::parse(&Source::new("m", text).unwrap()).unwrap()).unwrap();
        let equilibrium = Equilibrium::of(&plant, &Derivation::derive(&plant));
        (plant, equilibrium)
    }

    /// The values of a point at which z' vanishes and the rank falls from 1.
    fn at(lines: &str) -> String {
        let (plant, equilibrium) = of(lines);
        let Some(Equilibrium::At(point)) = equilibrium else { panic!("{lines}: {equilibrium:?}") };
        assert!(point.still, "{lines}");
        assert_eq!(point.rank, Some(1), "{lines}");
        let arena = &plant.arena;
        let printed = point.values.iter().map(|(s, value)| format!("{} = {}", arena.name(*s), arena.print(*value)));
        printed.collect::<Vec<String>>().join(", ")
    }

    fn undecided(lines: &str) -> String {
        let (_, equilibrium) = of(lines);
        let Some(Equilibrium::Undecided(reason)) = equilibrium else { panic!("{lines}: {equilibrium:?}") };
        reason
    }

    const BOOST: &str = "parameters: {L: 1, C: 1, R: 5, E: 12}\nx: [i]\ny: [v]\nu: [d]\n\
                         f_x: {i: (E - (1 - d)*v)/L}\nf_y: {v: ((1 - d)*i - v/R)/C}\nphi: [i]";

    #[test]
    fn converters_have_the_equilibria_of_the_textbook() {
        assert_eq!(at(&format!("{BOOST}\nassume: [0 < d < 1]")), "i = E/(R*(1 - d)^2), v = E/(1 - d)");
        let cuk = "parameters: {L1: 1, C2: 1, L3: 1, C4: 1, G: 1, E: 12}\nx: [i1, i3]\ny: [v2, v4]\nu: [d]\n\
                   assume: [0 < d < 1]\nf_x: {i1: (E - (1 - d)*v2)/L1, i3: -(d*v2 + v4)/L3}\n\
                   f_y: {v2: ((1 - d)*i1 + d*i3)/C2, v4: (i3 - G*v4)/C4}\nphi: [i1, i3]";
        assert_eq!(at(cuk), "i1 = G*E*d^2/(1 - d)^2, i3 = -G*E*d/(1 - d), v2 = E/(1 - d), v4 = -E*d/(1 - d)");
    }

    #[test]
    fn an_input_is_solved_for_where_no_state_is() {
        let pendulum = "parameters: {m: 1, g: 9.81}\nx: [p]\ny: [q]\nu: [tau]\n\
                        f_x: {p: tau - m*g*sin(q)}\nf_y: {q: p/m}\nphi: [p]";
        assert_eq!(at(pendulum), "p = 0, tau = m*g*sin(q)");
    }

    #[test]
    fn inverse_functions_solve_what_is_not_linear() {
        let lines = "parameters: {a: 2}\nx: [x]\ny: [y]\nf_x: {x: a - exp(y)}\nf_y: {y: x}\nphi: [x]";
        assert_eq!(at(lines), "x = 0, y = log(a)");
        // A leg of length r > 0 hangs down.
        let leg = "x: [p]\ny: [r, q]\nu: [v]\nassume: [r > 0]\nf_x: {p: -r*sin(q)}\nf_y: {r: v, q: p}\nphi: [p]";
        assert_eq!(at(leg), "p = 0, q = 0, v = 0");
    }

    #[test]
    fn one_factor_of_a_product_vanishes() {
        // An aircraft that takes off upright hovers; without thrust it does not.
        let aircraft = "parameters: [g]\nx: [vx, vz]\ny: [px, pz, q]\nu: [thrust, turn]\n\
                        f_x: {vx: -sin(q)*thrust, vz: cos(q)*thrust - g}\nf_y: {px: vx, pz: vz, q: turn}\n\
                        phi: [vx, vz]";
        assert_eq!(at(aircraft), "vx = 0, vz = 0, q = 0, thrust = g, turn = 0");
        let lorenz = "parameters: [s, r, b]\nassume: [b > 0, s > 0]\nx: [b1, b2]\ny: [a]\n\
                      f_x: {b1: r*a - b1 - a*b2, b2: a*b1 - b*b2}\nf_y: {a: s*(b1 - a)}\nphi: [b1, b2]";
        assert_eq!(at(lorenz), "b1 = 0, b2 = 0, a = 0");
        let away = "x: [x]\ny: [y]\nassume: [y > 1]\nf_x: {x: (y - 3)^2*y}\nf_y: {y: x}\nphi: [x]";
        assert_eq!(at(away), "x = 0, y = 3");
    }

    #[test]
    fn all_equilibria_are_told_from_one_of_them() {
        let is_complete = |lines: &str| match of(lines).1 {
            Some(Equilibrium::At(point)) => point.complete,
            other => panic!("{lines}: {other:?}"),
        };
        let range = "x: [px, py]\ny: [r]\nu: [vx, vy]\nassume: [r > 0]\nf_x: {px: vx, py: vy}\n\
                     g_y: {r: sqrt(px^2 + py^2)}\nphi: [px, py]";
        assert_eq!(at(range), "r = sqrt(px^2 + py^2), vx = 0, vy = 0");
        assert!(is_complete(range) && is_complete(&format!("{BOOST}\nassume: [0 < d < 1]")));
        let lorenz = "x: [b1, b2]\ny: [a]\nf_x: {b1: 28*a - b1 - a*b2, b2: a*b1 - 8*b2/3}\nf_y: {a: 10*(b1 - a)}\n\
                      phi: [b1, b2]";
        assert!(!is_complete(lorenz));
        let half = "x: [p]\ny: [q]\nu: [v]\nf_x: {p: v - q^2}\nf_y: {q: p}\nphi: [p]";
        assert_eq!((at(half).as_str(), is_complete(half)), ("p = 0, v = q^2", true));
    }

    #[test]
    fn roots_of_two_states_may_be_level() {
        let tanks = "parameters: [a]\nx: [h1]\ny: [h2]\nu: [q]\nassume: [h1 > 0, h2 > 0, a > 0]\n\
                     f_x: {h1: q - a*sqrt(h1)}\nf_y: {h2: a*sqrt(h1) - a*sqrt(h2)}\nphi: [h1 + h2]";
        assert_eq!(at(tanks), "h2 = h1, q = a*sqrt(h1)");
    }

    #[test]
    fn a_rotor_with_many_turns_has_an_equilibrium_without_turning() {
        let satellite = "x: [a, b, c]\ny: [q0, q1, q2, q3]\nu: [t1, t2, t3]\n\
                         f_x: {a: t1, b: t2, c: t3}\nidentities: [q0^2 + q1^2 + q2^2 + q3^2 - 1]\n\
                         f_y: {q0: -(q1*a + q2*b + q3*c)/2, q1: (q0*a - q3*b + q2*c)/2,\n\
                         \x20 q2: (q3*a + q0*b - q1*c)/2, q3: (q1*b - q2*a + q0*c)/2}\nphi: [a, b, c]";
        assert_eq!(at(satellite), "a = 0, b = 0, c = 0, q0 = sqrt(1 - q1^2 - q2^2 - q3^2), t1 = 0, t2 = 0, t3 = 0");
    }

    #[test]
    fn identities_hold_at_the_equilibrium() {
        // A point on the unit circle has no equilibrium at the circle's centre.
        let circle = "x: [c, s]\ny: [q]\nu: [v, w]\nidentities: [c^2 + s^2 - 1]\n\
                      f_x: {c: -s*w, s: c*w}\nf_y: {q: v*c}\nphi: [c, s]";
        assert_eq!(at(circle), "c = 0, s = 1, w = 0");
        let motor = std::fs::read_to_string("../../models/motor_flux.yaml").unwrap();
        let lines = motor.lines().filter(|line| !line.starts_with("model:")).collect::<Vec<_>>().join("\n");
        assert_eq!(at(&lines), "l1 = lambda_m + L*v1/R, l2 = L*v2/R, i1 = v1/R, i2 = v2/R, omega = 0");
    }

    #[test]
    fn a_parameter_is_not_solved_for() {
        let reason = undecided("parameters: [g]\nx: [x]\ny: [y]\nf_x: {x: -g}\nf_y: {y: x}\nphi: [x]");
        assert_eq!(reason, "no rule solves `-g` = 0");
    }

    #[test]
    fn a_state_that_the_assumptions_keep_from_zero_is_not_set_to_zero() {
        let prey = "x: [x]\ny: [y]\nassume: [x > 0, y > 0]\nf_x: {x: x*(1 - y)}\nf_y: {y: y*(x - 2)}\nphi: [log(x)]";
        assert_eq!(at(prey), "x = 2, y = 1");
    }

    #[test]
    fn a_generalised_cascade_has_an_equilibrium_of_z() {
        let lines = "x: [a, b]\ny: [c]\nu: [u]\nf_x: {a: b, b: u - a}\nf_y: {c: a}\nphi: [a, b]";
        let (_, equilibrium) = of(lines);
        assert!(matches!(equilibrium, Some(Equilibrium::At(OperatingPoint { still: true, .. }))), "{equilibrium:?}");
        assert_eq!(at(lines), "a = 0, b = 0, u = 0");
    }

    #[test]
    fn a_point_outside_the_assumptions_is_none() {
        // E - (1 - d) v is positive there.
        let (_, equilibrium) = of(&format!("{BOOST}\nassume: [0 < d < 1, v < 0]"));
        assert!(matches!(equilibrium, Some(Equilibrium::Nowhere(_))), "{equilibrium:?}");
        // A bound that the point meets, and one that only some of the inputs meet.
        at(&format!("{BOOST}\nassume: [0 < d < 1, v > 0]"));
        at(&format!("{BOOST}\nassume: [0 < d < 1, v > 15]"));
    }

    #[test]
    fn a_point_at_which_the_observer_has_no_value_is_none() {
        // q' = q w vanishes at q = 0 too, where p = z1/q has no value.
        let product = "x: [p]\ny: [q, r]\nu: [v, w]\nf_x: {p: v - p*w}\nf_y: {q: q*w, r: p}\nphi: [p*q]";
        assert_eq!(at(product), "p = 0, v = 0, w = 0");
        let alone = "x: [p]\ny: [q, r]\nu: [v]\nf_x: {p: v + p}\nf_y: {q: -q, r: p}\nphi: [p*q]";
        let (_, equilibrium) = of(alone);
        assert!(matches!(equilibrium, Some(Equilibrium::Undecided(reason)) if reason == NONE_WITHIN));
    }

    #[test]
    fn a_cascade_at_equilibrium_everywhere_has_rank_zero() {
        let (_, equilibrium) = of("x: [x]\ny: [y]\nf_x: {x: 0}\nf_y: {y: 0}\nphi: [x]");
        assert!(matches!(equilibrium, Some(Equilibrium::At(OperatingPoint { rank: Some(0), .. }))), "{equilibrium:?}");
    }

    #[test]
    fn an_unsolved_equilibrium_is_reported() {
        let reason = undecided("x: [x]\ny: [y]\nf_x: {x: y + sin(y) - 1}\nf_y: {y: x}\nphi: [x]");
        assert!(reason.starts_with("no rule solves `") && reason.contains("sin(y)"), "{reason}");
        let reason = undecided("x: [x]\ny: [y, s]\nf_x: {x: s}\nf_y: {y: x}\nphi: [x]");
        assert_eq!(reason, "give the rate of `s`");
        let (_, none) = of("x: [x]\ny: [y]\nf_x: {x: x^2}\nf_y: {y: 1}\nphi: [x]");
        assert!(none.is_none(), "the cascade is not proved: {none:?}");
    }

    #[test]
    fn a_state_without_equilibrium_is_named() {
        let (plant, equilibrium) = of("x: [x]\ny: [y]\nu: [u]\nf_x: {x: 1 + u^2}\nf_y: {y: x}\nphi: [x]");
        let Some(Equilibrium::Nowhere(symbol)) = equilibrium else { panic!("{equilibrium:?}") };
        assert_eq!(plant.arena.name(symbol), "x");
    }
}

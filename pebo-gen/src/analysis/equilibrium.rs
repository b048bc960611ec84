//! Where the plant rests under a constant input (Ortega et al. 2015, Section 2.5 and remark R5).
//!
//! In: a plant with a proved cascade. Out: states, and inputs where the states leave equations, in those that
//! stay free, with the proof that every rate vanishes there, and with it `h`.
//!
//! The equations are taken one at a time, each for a symbol that is linear in it, which is then replaced
//! in all others; where none is linear, inverse functions may help. Division by what vanishes somewhere can
//! lose operating points, never add one: what comes out is checked by the zero test within the assumed domain.

use std::collections::{BTreeMap, BTreeSet};

use crate::cas::domain::Domain;
use crate::cas::enclosure::Point;
use crate::cas::facts::Relation;
use crate::cas::field::{Field, Fraction, Obstacle};
use crate::cas::oriented::oriented;
use crate::cas::rational::Rational;
use crate::cas::zero::{Answer, decide};
use crate::cas::{Arena, Expr, Node, Symbol};
use crate::plant::Plant;

use super::design::{Cascade, Derivation, Verdict};
use super::solve::{Equation, solve};
use super::tidy::{shorter, shortest};

/// What is known of where a plant rests.
#[derive(Clone, Debug)]
pub enum Equilibrium {
    /// It rests there: proved.
    At(OperatingPoint),
    /// It rests nowhere, as this state or output never does: proved.
    Nowhere(Symbol),
    /// Neither was shown, for this reason.
    Undecided(String),
}

/// Values at which every rate vanishes.
#[derive(Clone, Debug)]
pub struct OperatingPoint {
    /// Symbols that are determined, in those that are free.
    pub values: Vec<(Symbol, Expr)>,
    /// Whether z' vanishes there too: `h`, of the generalised cascade `Lambda z + h`.
    pub still: bool,
    /// The rank of `[f; h_i]` at almost every point, the same for all i; none where it was not shown. At
    /// the operating point it is 0 if z' vanishes.
    pub rank: Option<usize>,
}

impl Equilibrium {
    /// Looks for the operating points of a plant; none without a proved cascade.
    pub fn of(plant: &Plant, derivation: &Derivation) -> Option<Self> {
        let cascade = derivation.cascade.result.as_ref().filter(|_| derivation.cascade.verdict == Verdict::Proved)?;
        Some(found(plant, cascade).unwrap_or_else(|obstacle| Self::Undecided(obstacle.to_string())))
    }
}

fn found(plant: &Plant, cascade: &Cascade) -> Result<Equilibrium, Obstacle> {
    let arena = &plant.arena;
    let domain = plant.domain();
    if let Some(output) = plant.y.iter().find(|output| output.rate.is_none()) {
        return Ok(Equilibrium::Undecided(format!("give the rate of `{}`", arena.name(output.symbol))));
    }
    let rates = plant.rates();
    if let Some((symbol, _)) = rates.iter().find(|(_, rate)| domain.shows(arena, **rate, Relation::NonZero)) {
        return Ok(Equilibrium::Nowhere(*symbol));
    }
    let mut search = Search { plant, domain: &domain, values: BTreeMap::new() };
    if let Some(left) = search.run(rates.values().copied().collect())? {
        let reason = format!("no rule solves `{}` = 0", arena.print(left));
        return Ok(Equilibrium::Undecided(reason));
    }
    let values = search.values;
    let Some(there) = restricted(arena, &domain, &values) else {
        return Ok(Equilibrium::Undecided("no operating point was found within the assumptions".to_owned()));
    };
    let vanishes = |expr: Expr| decide(arena, arena.substitute(expr, &values), &there).is_zero();
    if let Some((symbol, _)) = rates.iter().find(|(_, rate)| !vanishes(**rate)) {
        return Ok(Equilibrium::Undecided(format!("the rate of `{}` was not shown to vanish", arena.name(*symbol))));
    }
    let still = flow(plant, cascade).into_iter().all(vanishes);
    let order = plant.x.iter().map(|s| s.symbol).chain(plant.y.iter().map(|o| o.symbol));
    let order = order.chain(plant.u.iter().copied()).chain(plant.w.iter().copied());
    let shown = |value: Expr| {
        let short = shortest(arena, &there, value);
        let shown = factored(arena, &there, value).map_or(short, |factored| shorter(arena, factored, short));
        oriented(arena, &there, shown)
    };
    let values = order.filter_map(|s| Some((s, shown(*values.get(&s)?)))).collect();
    Ok(Equilibrium::At(OperatingPoint { values, still, rank: rank(arena, &domain, rates.values()) }))
}

/// The value with repeated factors as powers.
fn factored(arena: &Arena, domain: &Domain, value: Expr) -> Result<Expr, Obstacle> {
    let field = Field::over(arena, &domain.facts, &[value])?;
    let fraction = field.fraction(value)?;
    let mut product = arena.one();
    for (poly, side) in [(fraction.numerator(), 1), (fraction.denominator(), -1)] {
        let parts = poly.square_free(field.limit())?;
        product = arena.mul(product, arena.power(arena.number(Rational::from(parts.content)), &Rational::from(side)));
        for (part, exponent) in parts.factors {
            let part = field.show(&field.of_polynomial(&part)?);
            product = arena.mul(product, arena.power(part, &Rational::from(side * i64::from(exponent))));
        }
    }
    Ok(product)
}

/// z' as the cascade has it: `h`, or `Lambda phi + h`.
fn flow(plant: &Plant, cascade: &Cascade) -> Vec<Expr> {
    let arena = &plant.arena;
    let Some(lambda) = &cascade.lambda else { return cascade.h.clone() };
    let phi = plant.transform();
    let moved = lambda.iter().map(|row| crate::plant::matrix::dot(arena, row, &phi));
    moved.zip(&cascade.h).map(|(moved, h)| arena.add(moved, *h)).collect()
}

/// The rank of the column `[f; h_i]` at almost every point. Of a column it is 1 where an entry is not zero; as
/// `h_i` is a combination of the rates, those decide.
fn rank<'a>(arena: &Arena, domain: &Domain, mut rates: impl Iterator<Item = &'a Expr> + Clone) -> Option<usize> {
    let answers = || rates.clone().map(|rate| decide(arena, *rate, domain));
    if answers().any(|answer| matches!(answer, Answer::NonZero(_))) {
        return Some(1);
    }
    rates.all(|rate| decide(arena, *rate, domain).is_zero()).then_some(0)
}

/// The domain of the symbols that stay free; none unless some point of it is found.
fn restricted(arena: &Arena, domain: &Domain, values: &BTreeMap<Symbol, Expr>) -> Option<Domain> {
    let mut there = Domain { fixed: domain.fixed.clone(), ..Domain::default() };
    let mut constant = Vec::new();
    for (fact, relation) in domain.facts.iter() {
        let fact = arena.substitute(fact, values);
        if relation == Relation::NonNegative && arena.is_zero(fact) {
            continue;
        }
        if arena.symbols_of(&[fact]).is_empty() {
            constant.push((fact, relation));
        } else {
            there.facts.assume(fact, relation);
        }
    }
    let holds = |(fact, relation): &(Expr, Relation)| {
        let value = arena.separated_from_zero(*fact, &BTreeMap::new());
        value.is_some_and(|value| *relation == Relation::NonZero || value.is_positive())
    };
    let mut all: Vec<Expr> = values.values().copied().collect();
    all.extend(there.facts.iter().map(|(fact, _)| fact));
    let exists = |point: &Point| values.values().all(|value| arena.exists_at(*value, point));
    (constant.iter().all(holds) && there.points(arena, &all).any(|point| exists(&point))).then_some(there)
}

/// The equations with what they have determined so far.
struct Search<'a> {
    plant: &'a Plant,
    domain: &'a Domain,
    values: BTreeMap<Symbol, Expr>,
}

/// How little a step of elimination assumes; the least is taken.
#[derive(PartialEq, Eq, PartialOrd, Ord)]
struct Cost {
    /// Whether the symbol's factor holds states, which may vanish.
    bends: bool,
    /// Whether the symbol is an input, which the author would rather choose.
    input: bool,
    /// Whether the factor holds inputs.
    driven: bool,
    /// Terms of factor and rest.
    terms: usize,
}

/// Parts of all equations together. A remark is not worth minutes: elimination makes the equations longer at each
/// step, and those of a chain of four bodies, which this ends, took more than 100 s.
const MOST_PARTS: usize = 600;

impl Search<'_> {
    /// Determines symbols until every equation holds; else one that does not.
    fn run(&mut self, mut equations: Vec<Expr>) -> Result<Option<Expr>, Obstacle> {
        let arena = &self.plant.arena;
        loop {
            equations = arena.substitute_all(&equations, &self.values);
            if arena.postorder(&equations).len() > MOST_PARTS {
                return Err(Obstacle::TooLarge);
            }
            let field = Field::over(arena, &self.domain.facts, &equations)?;
            let mut open = Vec::new();
            for equation in &equations {
                let fraction = field.fraction(*equation)?;
                if !fraction.is_zero() {
                    open.push((field.show(&fraction), fraction));
                }
            }
            let Some((first, _)) = open.first() else { return Ok(None) };
            let next = match self.linear(&field, &open)? {
                Some(next) => Some(next),
                None => self.inverted(&open)?,
            };
            let Some((symbol, value)) = next else { return Ok(Some(*first)) };
            let replaced = BTreeMap::from([(symbol, value)]);
            for known in self.values.values_mut() {
                *known = arena.substitute(*known, &replaced);
            }
            self.values.insert(symbol, value);
            equations = open.into_iter().map(|(equation, _)| equation).collect();
        }
    }

    /// The states, then the inputs, that are not determined.
    fn unknowns(&self) -> [BTreeSet<Symbol>; 2] {
        let plant = self.plant;
        let states = plant.x.iter().map(|s| s.symbol).chain(plant.y.iter().map(|o| o.symbol));
        let inputs = plant.u.iter().chain(&plant.w).copied();
        [
            states.filter(|s| !self.values.contains_key(s)).collect(),
            inputs.filter(|s| !self.values.contains_key(s)).collect(),
        ]
    }

    /// A symbol that stands to the first power in an equation, in no kernel but itself.
    fn linear(&self, field: &Field<'_>, open: &[(Expr, Fraction)]) -> Result<Option<(Symbol, Expr)>, Obstacle> {
        let arena = field.arena();
        let [states, inputs] = self.unknowns();
        let mut best: Option<(Cost, Symbol, Expr)> = None;
        for (_, fraction) in open {
            let numerator = fraction.numerator();
            for symbol in states.union(&inputs) {
                let kernels = field.kernels_of(&BTreeSet::from([*symbol]));
                let mut kernels = numerator.variables().iter().filter(|kernel| kernels.contains(kernel));
                let (Some(kernel), None) = (kernels.next(), kernels.next()) else { continue };
                if numerator.degree(*kernel) != 1 || arena.as_symbol(field.kernel(*kernel)) != Some(*symbol) {
                    continue;
                }
                let mut factor = Fraction::zero();
                let mut rest = Fraction::zero();
                for (power, coefficient) in numerator.collect(&[*kernel]) {
                    *(if power.is_one() { &mut rest } else { &mut factor }) = field.of_polynomial(&coefficient)?;
                }
                let holds = |symbols: &BTreeSet<Symbol>| {
                    let kernels = field.kernels_of(symbols);
                    factor.variables().any(|kernel| kernels.contains(&kernel))
                };
                if rest.is_zero() && self.domain.shows(arena, arena.of_symbol(*symbol), Relation::NonZero) {
                    continue;
                }
                let cost = Cost {
                    bends: holds(&states),
                    input: inputs.contains(symbol),
                    driven: holds(&inputs),
                    terms: factor.numerator().term_count() + rest.numerator().term_count(),
                };
                if best.as_ref().is_none_or(|(least, ..)| cost < *least) {
                    let value = field.show(&field.div(&rest, &factor)?.opposite());
                    best = Some((cost, *symbol, value));
                }
            }
        }
        Ok(best.map(|(_, symbol, value)| (symbol, value)))
    }

    /// A state that inverse functions give.
    fn inverted(&self, open: &[(Expr, Fraction)]) -> Result<Option<(Symbol, Expr)>, Obstacle> {
        let arena = &self.plant.arena;
        let [states, _] = self.unknowns();
        let unknowns: Vec<Symbol> = states.iter().copied().collect();
        // What cannot vanish says nothing of where its product does.
        let bare = |formula: Expr| match arena.node(formula) {
            Node::Product(product) => {
                let may_vanish = |(base, _): &&(Expr, Rational)| !self.domain.shows(arena, *base, Relation::NonZero);
                arena.multiply(&Rational::ONE, product.factors.iter().filter(may_vanish).cloned())
            }
            _ => formula,
        };
        let equations: Vec<Equation> =
            open.iter().map(|(formula, _)| Equation { formula: bare(*formula), value: arena.zero() }).collect();
        let candidates = solve(arena, self.domain, &equations, &unknowns)?;
        let free = |(symbol, values): (Symbol, Vec<Expr>)| {
            let value = values.into_iter().find(|value| !arena.depends_on(*value, &BTreeSet::from([symbol])))?;
            Some((symbol, value))
        };
        Ok(candidates.into_iter().find_map(free))
    }
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

    /// The values of a point at which z rests and where the rank falls from 1.
    fn at(lines: &str) -> String {
        let (plant, equilibrium) = of(lines);
        let Some(Equilibrium::At(point)) = equilibrium else { panic!("{lines}: {equilibrium:?}") };
        assert!(point.still, "{lines}");
        assert_eq!(point.rank, Some(1), "{lines}");
        let arena = &plant.arena;
        let shown = point.values.iter().map(|(s, value)| format!("{} = {}", arena.name(*s), arena.print(*value)));
        shown.collect::<Vec<String>>().join(", ")
    }

    fn undecided(lines: &str) -> String {
        let (_, equilibrium) = of(lines);
        let Some(Equilibrium::Undecided(reason)) = equilibrium else { panic!("{lines}: {equilibrium:?}") };
        reason
    }

    const BOOST: &str = "parameters: {L: 1, C: 1, R: 5, E: 12}\nx: [i]\ny: [v]\nu: [d]\n\
                         f_x: {i: (E - (1 - d)*v)/L}\nf_y: {v: ((1 - d)*i - v/R)/C}\nphi: [i]";

    #[test]
    fn converters_rest_where_the_textbook_says() {
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
    fn a_state_that_the_assumptions_keep_from_zero_is_not_set_to_zero() {
        let prey = "x: [x]\ny: [y]\nassume: [x > 0, y > 0]\nf_x: {x: x*(1 - y)}\nf_y: {y: y*(x - 2)}\nphi: [log(x)]";
        assert_eq!(at(prey), "x = 2, y = 1");
    }

    #[test]
    fn of_a_generalised_cascade_z_rests() {
        let lines = "x: [a, b]\ny: [c]\nu: [u]\nf_x: {a: b, b: u - a}\nf_y: {c: a}\nphi: [a, b]";
        let (_, equilibrium) = of(lines);
        assert!(matches!(equilibrium, Some(Equilibrium::At(OperatingPoint { still: true, .. }))), "{equilibrium:?}");
        assert_eq!(at(lines), "a = 0, b = 0, u = 0");
    }

    #[test]
    fn a_point_outside_the_assumptions_is_none() {
        let reason = undecided(&format!("{BOOST}\nassume: [0 < d < 1, v < 0]"));
        assert_eq!(reason, "no operating point was found within the assumptions");
        // A bound that the point meets, and one that only a part of the inputs meets.
        at(&format!("{BOOST}\nassume: [0 < d < 1, v > 0]"));
        at(&format!("{BOOST}\nassume: [0 < d < 1, v > 15]"));
    }

    #[test]
    fn what_is_not_solved_is_said() {
        let reason = undecided("x: [x]\ny: [y]\nf_x: {x: y + sin(y) - 1}\nf_y: {y: x}\nphi: [x]");
        assert!(reason.starts_with("no rule solves `") && reason.contains("sin(y)"), "{reason}");
        let reason = undecided("x: [x]\ny: [y, s]\nf_x: {x: s}\nf_y: {y: x}\nphi: [x]");
        assert_eq!(reason, "give the rate of `s`");
        let (_, none) = of("x: [x]\ny: [y]\nf_x: {x: x}\nf_y: {y: 1}\nphi: [x]");
        assert!(none.is_none(), "the cascade is not proved: {none:?}");
    }

    #[test]
    fn a_state_that_never_rests_is_named() {
        let (plant, equilibrium) = of("x: [x]\ny: [y]\nu: [u]\nf_x: {x: 1 + u^2}\nf_y: {y: x}\nphi: [x]");
        let Some(Equilibrium::Nowhere(symbol)) = equilibrium else { panic!("{equilibrium:?}") };
        assert_eq!(plant.arena.name(symbol), "x");
    }
}

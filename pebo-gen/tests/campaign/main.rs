//! A differential campaign for the zero test: generated identities and near-identities.
//!
//! True cases are made by known rules, false ones by changing one number, sign, symbol or function of a
//! true one. Floating point judges every case independently: what is called true must vanish at random
//! points, what is called false must not. A few thousand cases run by default;
//! `PEBO_CAMPAIGN=120000` runs that many, `PEBO_CASES=path` writes the cases with their verdicts for
//! the oracle script, and `PEBO_OPEN=1` prints the rules whose cases remain open.

mod draw;
mod judge;
mod make;
mod rules;
mod rules_inverse;

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::time::{Duration, Instant};

use pebo_cas::Arena;
use pebo_cas::Domain;
use pebo_cas::Relation;
use pebo_cas::domain::zero::{Answer, decide};
use pebo_gen::model::formula::{Estimates, Formula, SpanMap, parse_formula};
use pebo_gen::plant::{Scope, lower};

use draw::Draw;
use judge::{NAMES, Point, SampledSign};
use make::{Case, Class};

/// Cases in a plain `cargo test`.
const FEW: usize = 4_000;

/// No decision may take longer than this.
const PATIENCE: Duration = Duration::from_secs(if cfg!(debug_assertions) { 60 } else { 8 });

#[derive(Default)]
struct Count {
    proved: usize,
    refuted: usize,
    open: usize,
    wrong: usize,
}

impl Count {
    fn total(&self) -> usize {
        self.proved + self.refuted + self.open + self.wrong
    }
}

#[derive(Default)]
struct Tally {
    counts: BTreeMap<(String, bool), Count>,
    open: BTreeMap<String, (usize, String)>,
    wrong: Vec<String>,
    unclear: usize,
    outside: usize,
    refused: usize,
    mislabelled: Vec<String>,
    slowest: (Duration, String),
    cases: String,
}

fn parse(text: &str) -> Formula {
    parse_formula(text, &SpanMap::verbatim(text, 0), Estimates::Refused)
        .unwrap_or_else(|_| panic!("does not parse: {text}"))
}

fn scope(arena: &Arena) -> Scope {
    let mut scope = Scope::new();
    for name in NAMES {
        scope.define(name, arena.variable(name));
    }
    scope
}

/// `(f g)' - f' g - f g'` as text, for a case that holds f and g; none where one of them has no value.
fn leibniz(case: &Case) -> Option<Case> {
    let arena = Arena::new();
    let scope = scope(&arena);
    let of = |text: &str| lower(&arena, &scope, &parse(text)).ok();
    let (f, g) = (of(&case.left)?, of(&case.right)?);
    let by = arena.symbol("p");
    let left = arena.derivative(arena.mul(f, g), by);
    let right = arena.add(arena.mul(arena.derivative(f, by), g), arena.mul(f, arena.derivative(g, by)));
    Some(Case { left: arena.print(left), right: format!("({})", arena.print(right)), ..case.clone() })
}

/// The answer, and its witness; none where the formula is refused because it has no value.
fn decided(case: &Case, formula: &Formula) -> Option<(Answer, Point)> {
    let arena = Arena::new();
    let scope = scope(&arena);
    let mut domain = Domain::default();
    for text in case.facts {
        let fact = lower(&arena, &scope, &parse(text)).expect("a fact of the campaign");
        domain.facts.assume(fact, Relation::Positive);
    }
    let expr = lower(&arena, &scope, formula).ok()?;
    let answer = decide(&arena, expr, &domain);
    let mut point = Point::new();
    if let Answer::NonZero(witness) = &answer {
        for name in NAMES {
            // Symbols that the formula does not contain may have any value.
            let value = witness.point.get(&arena.symbol(name)).and_then(|value| arena.as_number(*value));
            point.insert(name, value.map_or(0.5, |value| value.to_f64()));
        }
    }
    Some((answer, point))
}

impl Tally {
    fn run(&mut self, class: Class, case: &Case, intended: bool, draw: &mut Draw) {
        let text = case.text();
        let formula = parse(&text);
        let sampled = judge::sample(&formula, draw);
        match (sampled, intended) {
            (SampledSign::Unclear, _) => {
                self.unclear += 1;
                return;
            }
            (SampledSign::Differs, true) => {
                self.mislabelled.push(text);
                return;
            }
            _ => {}
        }
        let start = Instant::now();
        let Some((answer, point)) = decided(case, &formula) else {
            self.refused += 1;
            return;
        };
        let taken = start.elapsed();
        // A perturbation can stay true. It can also be false on a small part of the domain alone, as where `sign` or
        // `sat` has another value: floating point then differs at the witness, though at no point that was drawn.
        let differs_at_witness = matches!(answer, Answer::NonZero(_)) && judge::differs(judge::value(&formula, &point));
        let truth = sampled == SampledSign::Vanishes && (intended || !differs_at_witness);
        if taken > PATIENCE / 4 {
            println!("slow: {taken:?} {text}");
        }
        if taken > self.slowest.0 {
            self.slowest = (taken, text.clone());
        }
        let count = self.counts.entry((format!("{class:?}"), truth)).or_default();
        let verdict = match &answer {
            Answer::Zero if truth => {
                count.proved += 1;
                "zero"
            }
            Answer::NonZero(_) if !truth => {
                count.refuted += 1;
                "nonzero"
            }
            Answer::Open(_) => {
                count.open += 1;
                if truth {
                    let entry = self.open.entry(case.rule.clone()).or_insert_with(|| (0, text.clone()));
                    entry.0 += 1;
                    if text.len() < entry.1.len() {
                        entry.1.clone_from(&text);
                    }
                }
                "open"
            }
            _ => {
                count.wrong += 1;
                self.wrong.push(format!("{text}\n    rule {}, {answer:?}", case.rule));
                "wrong"
            }
        };
        if let Answer::NonZero(witness) = &answer {
            self.check_witness(&text, &formula, &point, (witness.value.lo(), witness.value.hi()));
        }
        if matches!(answer, Answer::Zero) || matches!(answer, Answer::NonZero(_)) || truth {
            let said = if answer.is_zero() {
                "zero"
            } else if verdict == "open" {
                "open"
            } else {
                "nonzero"
            };
            let _ = writeln!(self.cases, "{class:?}\t{said}\t{text}");
        }
    }

    /// The enclosure must hold the value of the formula as written, wherever floating point can tell.
    fn check_witness(&mut self, text: &str, formula: &Formula, point: &Point, (low, high): (f64, f64)) {
        let (value, error) = judge::value(formula, point);
        let slack = 1e3 * error + 1e-9;
        if !(low > 0.0 || high < 0.0) && low != 0.0 && high != 0.0 {
            self.wrong.push(format!("{text}\n    the enclosure [{low}, {high}] does not exclude zero"));
        }
        if value.is_nan() {
            // Construction may enlarge the domain: cancelled terms have no domain conditions.
            self.outside += 1;
        } else if value.is_finite() && slack.is_finite() && (value < low - slack || value > high + slack) {
            self.wrong.push(format!("{text}\n    {value} is outside [{low}, {high}] at {point:?}"));
        }
    }

    fn report(&self) -> String {
        let mut text = format!(
            "{:<15} {:<6} {:>7} {:>7} {:>7} {:>6} {:>6}\n",
            "class", "", "count", "proved", "refuted", "open", "wrong"
        );
        for ((class, truth), c) in &self.counts {
            let kind = if *truth { "true" } else { "false" };
            let _ = writeln!(
                text,
                "{class:<15} {kind:<6} {:>7} {:>7} {:>7} {:>6} {:>6}",
                c.total(),
                c.proved,
                c.refuted,
                c.open,
                c.wrong
            );
        }
        let _ = writeln!(text, "left out because floating point could not judge: {}", self.unclear);
        let _ = writeln!(text, "refused before the zero test, a constant without a value: {}", self.refused);
        let _ = writeln!(text, "witnesses where the formula as written has no value: {}", self.outside);
        let _ = writeln!(text, "slowest: {:?} for {}", self.slowest.0, self.slowest.1);
        if std::env::var_os("PEBO_OPEN").is_some() {
            let mut open: Vec<_> = self.open.iter().collect();
            open.sort_by_key(|(_, (times, _))| std::cmp::Reverse(*times));
            for (rule, (times, shortest)) in open.iter().take(60) {
                let _ = writeln!(text, "open {times:>5}  {rule}\n             {shortest}");
            }
        }
        text
    }
}

#[test]
fn no_generated_case_gets_a_wrong_answer() {
    let number = std::env::var("PEBO_CAMPAIGN").ok().and_then(|n| n.parse().ok()).unwrap_or(FEW);
    // The same cases in every run, unless another seed is given.
    let seed = std::env::var("PEBO_SEED").map_or(0, |seed| seed.parse::<u32>().expect("a seed below 2^32"));
    let mut tally = Tally::default();
    for index in 0..number.div_ceil(2) {
        let class = Class::ALL[index % Class::ALL.len()];
        let mut draw = Draw::new(u64::from(seed) << 32 | u64::try_from(index).expect("a small index"));
        let mut case = make::identity(class, &mut draw);
        if class == Class::Leibniz {
            let Some(sides) = leibniz(&case) else {
                tally.refused += 1;
                continue;
            };
            case = sides;
        }
        tally.run(class, &case, true, &mut draw);
        let near = make::perturbed(&case, &mut draw);
        tally.run(class, &near, false, &mut draw);
    }
    println!("{}", tally.report());
    if let Some(path) = std::env::var_os("PEBO_CASES") {
        std::fs::write(path, format!("# {}\n{}", make::FACTS.join("; "), tally.cases)).expect("a writable path");
    }
    assert!(tally.mislabelled.is_empty(), "rules that are not identities:\n{}", tally.mislabelled.join("\n"));
    assert!(tally.wrong.is_empty(), "wrong answers:\n{}", tally.wrong.join("\n"));
    assert!(tally.slowest.0 < PATIENCE, "too slow: {:?} for {}", tally.slowest.0, tally.slowest.1);
}

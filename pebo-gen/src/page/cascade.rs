//! Claim 1: the rate of the transform term by term, its terms in unmeasured signals, and the rest.

use pebo_cas::domain::zero::is_zero;
use pebo_cas::{Arena, Expr, Node, Rational, Symbol};
use pebo_design::analysis::{Class, Verdict};
use pebo_design::plant::Plant;

use super::formula::{Setter, Steps, sum};
use super::html::Html;
use super::subject::Subject;
use super::verdict;
use crate::report::notes;

/// The longest table of terms that a reader follows.
const MOST_TERMS: usize = 64;

/// A term of the rate of a component: the slope of the component times a term of the rate of a signal.
struct Term {
    of: Symbol,
    slope: Expr,
    rate: Expr,
    whole: Expr,
    /// It contains an unmeasured signal.
    hidden: bool,
}

pub(super) fn section(html: &mut Html, setter: &Setter<'_>, subject: &Subject<'_>) {
    let (plant, derivation) = (subject.plant, subject.derivation);
    html.section("cascade", "Claim 1: the cascade", |html| {
        html.paragraph(match derivation.class {
            Class::Pebo => {
                "The rate of z along the plant is made of known signals alone: what holds an unmeasured one cancels."
            }
            Class::Gpebo => {
                "The rate of z along the plant is affine in z, with coefficients of known signals alone: what holds an \
                 unmeasured one is a combination of the components of z."
            }
        });
        verdict::of_claim(html, derivation.cascade.verdict);
        for index in 0..plant.phi.len() {
            component(html, setter, subject, index);
        }
        if derivation.cascade.verdict == Verdict::Proved {
            result(html, setter, subject);
            html.list(&notes::cascade(plant, derivation).into_iter().collect::<Vec<_>>());
        }
    });
}

/// The rate of one component.
fn component(html: &mut Html, setter: &Setter<'_>, subject: &Subject<'_>, index: usize) {
    let plant = subject.plant;
    let (z, phi) = (plant.z[index], plant.phi[index].expr);
    html.line("h3", &[], |html| {
        html.text("The rate of ");
        html.formula(&setter.symbol(z));
    });
    let terms = terms(plant, phi);
    let mut steps = Steps::default();
    let rate = setter.rate(z);
    steps.add(&rate, &chain(setter, &terms), "the chain rule");
    html.display(&steps.finish());
    if terms.len() > MOST_TERMS {
        html.paragraph(&format!("These are {} terms, too many for a table.", terms.len()));
    } else if !terms.is_empty() {
        table(html, setter, plant, &terms);
    }
    if subject.derivation.cascade.verdict != Verdict::Skipped {
        split(html, setter, subject, index, &terms);
    }
}

/// The terms of the rate of a component.
fn terms(plant: &Plant, phi: Expr) -> Vec<Term> {
    let (arena, hidden) = (&plant.arena, plant.hidden());
    let mut terms = Vec::new();
    for (of, rate) in plant.rates() {
        let slope = arena.derivative(phi, of);
        if arena.is_zero(slope) {
            continue;
        }
        let written = plant.terms.get(&of).filter(|terms| !terms.is_empty());
        let parts = match written {
            Some(written) => written.iter().map(|term| term.expr).collect(),
            None => summands(arena, rate),
        };
        for rate in parts {
            let whole = arena.mul(slope, rate);
            terms.push(Term { of, slope, rate, whole, hidden: arena.depends_on(whole, &hidden) });
        }
    }
    terms
}

/// The summands of a formula, also where they stand over a common divisor.
fn summands(arena: &Arena, expr: Expr) -> Vec<Expr> {
    match arena.node(expr) {
        Node::Sum(sum) => {
            let terms = sum.terms.iter().map(|(term, factor)| arena.mul(arena.number(factor.clone()), *term));
            let constant = Some(arena.number(sum.constant.clone())).filter(|constant| !arena.is_zero(*constant));
            constant.into_iter().chain(terms).collect()
        }
        Node::Product(product) => {
            let is_sum =
                |(base, exponent): &(Expr, Rational)| exponent.is_one() && matches!(arena.node(*base), Node::Sum(_));
            let mut sums = product.factors.iter().filter(|factor| is_sum(factor));
            match (sums.next(), sums.next()) {
                (Some((sum, _)), None) => {
                    let others = arena.div(expr, *sum);
                    summands(arena, *sum).into_iter().map(|term| arena.mul(others, term)).collect()
                }
                _ => vec![expr],
            }
        }
        _ => vec![expr],
    }
}

/// The chain rule, with the slopes as symbols.
fn chain(setter: &Setter<'_>, terms: &[Term]) -> String {
    let mut parts: Vec<String> = Vec::new();
    let mut last = None;
    for term in terms.iter().filter(|term| last.replace(term.of) != Some(term.of)) {
        let slope = match setter.arena.node(term.slope) {
            Node::Number(one) if one.is_one() => String::new(),
            Node::Symbol(symbol) => setter.symbol(symbol),
            _ => format!("<mrow><mo>[</mo>{}<mo>]</mo></mrow>", setter.expr(term.slope)),
        };
        parts.push(format!("{slope}{}", setter.rate(term.of)));
    }
    sum(&parts)
}

fn table(html: &mut Html, setter: &Setter<'_>, plant: &Plant, terms: &[Term]) {
    let hidden = plant.hidden();
    html.block("div", &[("class", "wide")], |html| {
        html.block("table", &[("class", "terms")], |html| {
            html.line("caption", &[], |html| html.text("Term by term"));
            html.block("thead", &[], |html| {
                html.line("tr", &[], |html| {
                    for name in ["from the rate of", "slope of z", "term of the rate", "product", "not measured in it"]
                    {
                        html.within("th", &[("scope", "col")], |html| html.text(name));
                    }
                });
            });
            html.block("tbody", &[], |html| {
                for term in terms {
                    let held: Vec<Symbol> =
                        setter.arena.symbols_of(&[term.whole]).intersection(&hidden).copied().collect();
                    html.line("tr", &[], |html| {
                        html.within("th", &[("scope", "row")], |html| html.formula(&setter.symbol(term.of)));
                        for formula in [term.slope, term.rate, term.whole] {
                            html.within("td", &[], |html| html.formula(&setter.expr(formula)));
                        }
                        html.within("td", &[], |html| {
                            if held.is_empty() { html.text("nothing") } else { html.formula(&setter.symbols(&held)) }
                        });
                    });
                }
            });
        });
    });
}

/// The terms in unmeasured signals, and their sum.
fn split(html: &mut Html, setter: &Setter<'_>, subject: &Subject<'_>, index: usize, terms: &[Term]) {
    let (plant, cascade) = (subject.plant, &subject.derivation.cascade);
    let (arena, domain) = (&plant.arena, subject.derivation.domain(plant));
    let of = |hidden: bool| terms.iter().filter(move |term| term.hidden == hidden).map(|term| term.whole);
    let shown = |hidden: bool| {
        if terms.len() > MOST_TERMS {
            return setter.expr(arena.sum(of(hidden)));
        }
        sum(&of(hidden).map(|term| setter.expr(term)).collect::<Vec<_>>())
    };
    let Some(result) = &cascade.result else { return };
    if of(true).next().is_none() {
        html.paragraph("No term holds an unmeasured signal.");
        return;
    }
    let mut steps = Steps::default();
    let rest = match (cascade.verdict, result.h.get(index)) {
        (Verdict::Refuted, _) => {
            let kept = result.residual.get(index).filter(|kept| !arena.is_zero(**kept));
            if let Some(kept) = kept {
                html.paragraph("The terms with unmeasured signals do not cancel:");
                steps.add(&shown(true), &setter.expr(*kept), "");
                html.display(&steps.finish());
            }
            return;
        }
        (Verdict::Proved, Some(h)) => arena.sub(*h, arena.sum(of(false))),
        _ => return,
    };
    let combined = result.lambda.as_ref().map(|lambda| {
        let row = &lambda[index];
        arena.sum(row.iter().zip(&plant.z).map(|(factor, z)| arena.mul(*factor, arena.of_symbol(*z))))
    });
    let vanishes = is_zero(arena, rest, &domain);
    let right = match combined {
        Some(combined) if vanishes => combined,
        Some(combined) => arena.add(combined, rest),
        None if vanishes => arena.zero(),
        None => rest,
    };
    html.paragraph(match (combined, vanishes) {
        (None, true) => "The terms with unmeasured signals cancel:",
        (None, false) => "The terms with unmeasured signals add up to known ones:",
        (Some(_), _) => "The terms with unmeasured signals are a combination of the components of z:",
    });
    steps.add(&shown(true), &setter.expr(right), "proved");
    html.display(&steps.finish());
}

/// The cascade as it was derived.
fn result(html: &mut Html, setter: &Setter<'_>, subject: &Subject<'_>) {
    let (plant, derivation) = (subject.plant, subject.derivation);
    let Some(cascade) = &derivation.cascade.result else { return };
    html.line("h3", &[], |html| html.text("What is left"));
    let mut steps = Steps::default();
    let z = "<mover accent=\"true\"><mi>z</mi><mo stretchy=\"false\">˙</mo></mover>";
    match &cascade.lambda {
        None => {
            for (z, h) in plant.z.iter().zip(&cascade.h) {
                steps.add(&setter.rate(*z), &setter.expr(*h), "");
            }
        }
        Some(lambda) => {
            steps.add(z, "<mi>Λ</mi><mi>z</mi><mo>+</mo><mi>h</mi>", "");
            steps.add("<mi>Λ</mi>", &setter.matrix(lambda), "");
            steps.add("<mi>h</mi>", &setter.column(&cascade.h), "");
        }
    }
    html.display(&steps.finish());
    html.paragraph(match derivation.class {
        Class::Pebo => {
            "This right side is h. The observer integrates it from any start: the difference of z and what it integrates \
             is constant, and is called θ."
        }
        Class::Gpebo => {
            "The observer integrates ξ with the same Λ and h from any start, and Ψ with Λ from the identity: the \
             difference of z and ξ is then Ψ times a constant, which is called θ."
        }
    });
    let mut steps = Steps::default();
    match derivation.class {
        Class::Pebo => {
            let chi = "<mover accent=\"true\"><mi>χ</mi><mo stretchy=\"false\">˙</mo></mover>";
            steps.add(chi, "<mi>h</mi>", "");
            steps.add("<mi>z</mi>", "<mi>χ</mi><mo>+</mo><mi>θ</mi>", "");
        }
        Class::Gpebo => {
            let rate =
                |letter: &str| format!("<mover accent=\"true\"><mi>{letter}</mi><mo stretchy=\"false\">˙</mo></mover>");
            steps.add(&rate("ξ"), "<mi>Λ</mi><mi>ξ</mi><mo>+</mo><mi>h</mi>", "");
            let start = "<mi>Ψ</mi><mo>(</mo><mn>0</mn><mo>)</mo><mo>=</mo><mi>I</mi>";
            steps.add(&rate("Ψ"), &format!("<mi>Λ</mi><mi>Ψ</mi><mo>,</mo><mspace width=\"1em\"/>{start}"), "");
            steps.add("<mi>z</mi>", "<mi>ξ</mi><mo>+</mo><mi>Ψ</mi><mi>θ</mi>", "");
        }
    }
    html.display(&steps.finish());
}

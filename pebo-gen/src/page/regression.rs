//! Claim 3: the outputs as a regression, with z replaced by its integral and the unknown constant.

use std::collections::BTreeMap;

use crate::report::notes;
use pebo_cas::{Expr, Symbol};
use pebo_design::analysis::{Class, Regression, RegressionKind, Verdict};
use pebo_design::plant::Plant;

use super::formula::{Setter, Steps};
use super::html::Html;
use super::subject::Subject;
use super::verdict;

pub(super) fn section(html: &mut Html, setter: &Setter<'_>, subject: &Subject<'_>) {
    let (plant, derivation) = (subject.plant, subject.derivation);
    let claim = &derivation.regression;
    html.section("regression", "Claim 3: the regression", |html| {
        html.paragraph("The unknown constants multiply known signals in equations between known signals.");
        verdict::of_claim(html, claim.verdict);
        let Some(regression) = claim.result.as_ref().filter(|_| claim.verdict == Verdict::Proved) else { return };
        let linear = regression.is_linear(plant);
        html.paragraph(match regression.kind {
            RegressionKind::Dynamic => {
                "The rates of these outputs hold the states only through z. A rate is not measured: the estimator \
                 filters both sides, which needs no differentiation."
            }
            RegressionKind::Static => "At every instant these relations hold between z and the known signals.",
            RegressionKind::Implicit => {
                "These relations hold the unknowns under a derivative too. The estimator filters both sides, which needs \
                 no differentiation."
            }
        });
        html.line("p", &[], |html| {
            html.text("In place of z stands what is integrated and what is constant, ");
            html.formula(match derivation.class {
                Class::Pebo => "<mi>z</mi><mo>=</mo><mi>χ</mi><mo>+</mo><mi>θ</mi>",
                Class::Gpebo => "<mi>z</mi><mo>=</mo><mi>ξ</mi><mo>+</mo><mi>Ψ</mi><mi>θ</mi>",
            });
            html.text(". What multiplies an unknown stands in brackets.");
        });
        let unknowns = if linear { &plant.theta } else { &regression.eta_symbols };
        for row in 0..regression.phi_0.len() {
            equation(html, setter, subject, (regression, unknowns), row);
        }
        functions(html, setter, regression, unknowns, linear);
        let mut steps = Steps::default();
        let letter = |index: &str| format!("<msub><mi>Φ</mi><mn>{index}</mn></msub>");
        steps.add(&letter("0"), &setter.column(&regression.phi_0), "");
        steps.add(&letter("1"), &setter.matrix(&regression.phi_1), "");
        html.paragraph("Together, as the code computes them:");
        html.display(&steps.finish());
        html.list(&notes::regression(plant, regression));
    });
}

/// One equation, from the plant to the regression.
fn equation(
    html: &mut Html,
    setter: &Setter<'_>,
    subject: &Subject<'_>,
    (regression, unknowns): (&Regression, &[Symbol]),
    row: usize,
) {
    let plant = subject.plant;
    let affine = setter.affine(regression.phi_0[row], &regression.phi_1[row], unknowns);
    let in_z = regression.in_z(plant).map(|equations| equations[row].right);
    let parts = parts_of_z(plant, subject.derivation.class);
    let mut steps = Steps::default();
    match regression.kind {
        RegressionKind::Dynamic => {
            let output = &plant.y[regression.rows()[row]];
            let rate = setter.rate(output.symbol);
            let whole = output.rate.map(|rate| setter.expr(rate.expr)).unwrap_or_default();
            steps.add(&rate, &whole, "the plant");
            if let Some(in_z) = in_z {
                steps.add("", &setter.expr(in_z), "in z");
                steps.add("", &setter.put(in_z, &parts), "z in its parts");
            }
            steps.add("", &affine, "proved");
        }
        RegressionKind::Static => {
            let zero = setter.arena.zero();
            if let Some(in_z) = in_z {
                steps.add("<mn>0</mn>", &setter.expr(in_z), "in z");
                steps.add("", &setter.put(in_z, &parts), "z in its parts");
                html.display(&std::mem::take(&mut steps).finish());
                html.paragraph("Sorted by the unknowns:");
            }
            let known = setter.expr(regression.phi_0[row]);
            steps.add(&known, &setter.affine(zero, &regression.phi_1[row], unknowns), "proved");
        }
        RegressionKind::Implicit => {
            let empty = Vec::new();
            let known = regression.primitive_0.get(row).copied().unwrap_or(setter.arena.zero());
            let factors = regression.primitive_1.get(row).unwrap_or(&empty);
            let under = setter.affine(known, factors, unknowns);
            let derivative = if factors.iter().chain([&known]).all(|part| setter.arena.is_zero(*part)) {
                "<mn>0</mn>".to_owned()
            } else {
                let operator = "<mfrac><mi>d</mi><mrow><mi>d</mi><mi>t</mi></mrow></mfrac>";
                format!("{operator}<mrow><mo>(</mo>{under}<mo>)</mo></mrow>")
            };
            steps.add(&derivative, &affine, "proved");
        }
    }
    html.display(&steps.finish());
}

/// The components of z as sums of an integral and a constant.
fn parts_of_z(plant: &Plant, class: Class) -> BTreeMap<Symbol, Expr> {
    let arena = &plant.arena;
    let theta: Vec<Expr> = plant.theta.iter().map(|theta| arena.of_symbol(*theta)).collect();
    let part = |(index, z): (usize, &Symbol)| {
        let whole = match class {
            Class::Pebo => arena.add(arena.of_symbol(plant.chi[index]), theta[index]),
            Class::Gpebo => {
                let psi: Vec<Expr> = plant.psi[index].iter().map(|entry| arena.of_symbol(*entry)).collect();
                arena.add(arena.of_symbol(plant.xi[index]), arena.dot(&psi, &theta))
            }
        };
        (*z, whole)
    };
    plant.z.iter().enumerate().map(part).collect()
}

/// The unknowns that are functions of theta.
fn functions(html: &mut Html, setter: &Setter<'_>, regression: &Regression, unknowns: &[Symbol], linear: bool) {
    if linear {
        return;
    }
    html.paragraph("The unknowns are functions of θ:");
    let mut steps = Steps::default();
    for (eta, value) in unknowns.iter().zip(&regression.eta) {
        steps.add(&setter.symbol(*eta), &setter.expr(*value), "");
    }
    html.display(&steps.finish());
    html.paragraph("θ comes back from them:");
    let mut steps = Steps::default();
    for (index, theta) in regression.theta.iter().enumerate() {
        steps.add(&format!("<msub><mi>θ</mi><mn>{}</mn></msub>", index + 1), &setter.expr(*theta), "");
    }
    html.display(&steps.finish());
}

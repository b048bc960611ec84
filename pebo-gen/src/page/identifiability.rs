//! Claim 4: identifiability of the unknowns, its exceptions, and the excitation that it needs.

use crate::report::notes;
use pebo_design::analysis::{Class, Derivation, Excitation, Gram, Trajectories, Verdict};

use super::formula::{Setter, Steps};
use super::html::Html;
use super::subject::Subject;
use super::verdict;

pub(super) fn section(html: &mut Html, setter: &Setter<'_>, subject: &Subject<'_>) {
    let (plant, derivation) = (subject.plant, subject.derivation);
    let claim = &derivation.identifiability;
    html.section("identifiability", "Claim 4: identifiability", |html| {
        html.paragraph("The regression determines its unknowns: no two of their values give the same outputs.");
        verdict::of_claim(html, claim.verdict);
        let decided = matches!(claim.verdict, Verdict::Proved | Verdict::Refuted);
        let Some(result) = claim.result.as_ref().filter(|_| decided) else { return };
        html.list(&notes::identifiability(plant, derivation));
        html.paragraph(match result.kind {
            Excitation::Instant => {
                "One sample of the filtered regression is enough: the columns of the regressor are independent at almost \
                 every point."
            }
            Excitation::Excitation if derivation.class == Class::Gpebo && result.trajectories.as_ref().is_some_and(at_rest) => {
                "No single sample is enough, but samples at several times are, also while the plant rests: Ψ changes between \
                 them."
            }
            Excitation::Excitation => {
                "No single sample is enough: the regressor has to move, so that samples at several times show together \
                 what one does not."
            }
            Excitation::Never => "No motion and no input shows this direction of the unknowns:",
        });
        if let Some(direction) = &result.direction {
            html.display(&setter.column(direction));
        }
        if let Some(gram) = &result.gram {
            determinant(html, setter, derivation, gram);
        }
    });
}

/// No signal of the plant has to move.
fn at_rest(trajectories: &Trajectories) -> bool {
    trajectories.at_rest && !trajectories.is_divided()
}

/// `Phi_1' Phi_1`, whose determinant vanishes where the unknowns are not identifiable.
fn determinant(html: &mut Html, setter: &Setter<'_>, derivation: &Derivation, gram: &Gram) {
    html.paragraph(
        "How strongly they are seen is the Gram matrix of the regressor; where its determinant is zero they are not:",
    );
    let product = "<msubsup><mi>Φ</mi><mn>1</mn><mi>⊤</mi></msubsup><msub><mi>Φ</mi><mn>1</mn></msub>";
    let mut steps = Steps::default();
    steps.add(product, &setter.matrix(&gram.matrix), "");
    let determinant = format!("<mi>det</mi><mrow><mo>(</mo>{product}<mo>)</mo></mrow>");
    steps.add(&determinant, &setter.expr(gram.determinant), "");
    html.display(&steps.finish());
    html.list(&notes::positive(derivation, gram).into_iter().collect::<Vec<_>>());
}

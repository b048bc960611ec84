//! Claim 2: the states as functions of z and y, with their check.

use std::collections::BTreeMap;

use crate::report::notes;
use pebo_cas::{Expr, Symbol};
use pebo_design::analysis::{Origin, Verdict};

use super::formula::{Setter, Steps};
use super::html::Html;
use super::subject::Subject;
use super::verdict;

pub(super) fn section(html: &mut Html, setter: &Setter<'_>, subject: &Subject<'_>) {
    let (plant, derivation) = (subject.plant, subject.derivation);
    let claim = &derivation.left_inverse;
    html.section("left-inverse", "Claim 2: the left inverse", |html| {
        html.paragraph("The states are read off z and the outputs.");
        verdict::of_claim(html, claim.verdict);
        let Some(inverse) = claim.result.as_ref().filter(|_| claim.verdict != Verdict::Undecided) else { return };
        html.paragraph(match inverse.origin {
            Origin::Given => "The author of the model gives the formulas. The check puts the transform in place of z:",
            Origin::Derived => "The transform was solved for them. The check puts the transform in place of z:",
        });
        let transform: BTreeMap<Symbol, Expr> =
            plant.z.iter().copied().zip(plant.phi.iter().map(|phi| phi.expr)).collect();
        for (state, formula) in &inverse.x {
            let name = setter.symbol(*state);
            let period = inverse.modulo.iter().find(|(symbol, _)| symbol == state);
            let mut steps = Steps::default();
            steps.add(&name, &setter.expr(*formula), "");
            if claim.verdict == Verdict::Proved {
                let checked = setter.put(*formula, &transform);
                match period {
                    None if checked == name => steps.add("", &checked, "proved"),
                    None => steps.add("", &format!("{checked}<mo>=</mo>{name}"), "proved"),
                    Some((_, period)) => {
                        let period = setter.expr(*period);
                        let equal = format!("{checked}<mo>≡</mo>{name}<mspace width=\"1em\"/><mtext>modulo</mtext>");
                        steps.add("", &format!("{equal}<mspace width=\"0.5em\"/>{period}"), "proved");
                    }
                }
            }
            html.display(&steps.finish());
        }
        html.list(&notes::left_inverse(plant, derivation));
    });
}

//! A page that explains the proofs of a model to a reader who knows control, and not this project.
//!
//! In: a plant with its derivation, and its code and the figure of its closed loop if there are any. Out: one HTML page
//! that is also well-formed XML: it needs no other file, holds no script, folds, prints, and is readable on a narrow
//! screen and in the dark. A refused model has a page too, with the obstacles and without code: a refusal needs an
//! explanation more than a proof does.

mod cascade;
mod code;
mod formula;
mod html;
mod identifiability;
mod left_inverse;
mod plant;
mod regression;
#[cfg(feature = "simulate")]
mod run;
mod sections;
mod subject;
mod transform;
mod usage;
mod verdict;

use formula::Setter;
use html::Html;
use pebo_design::analysis::{Class, Derivation};

pub use sections::Section;
pub(crate) use sections::sections;
pub(crate) use subject::Subject;
#[cfg(feature = "simulate")]
pub(crate) use subject::{Loop, Run};

/// The style of every page.
const STYLE: &str = include_str!("page.css");

/// Writes the page.
pub(crate) fn page(subject: &Subject<'_>) -> String {
    let setter = Setter::new(&subject.plant.arena);
    let mut html = Html::default();
    html.markup("<!DOCTYPE html>\n");
    html.block("html", &[("lang", "en")], |html| {
        html.block("head", &[], |html| head(html, subject));
        html.block("body", &[], |html| {
            html.block("header", &[], |html| verdict::header(html, subject));
            html.block("main", &[], |html| {
                verdict::diagnostics(html, subject);
                idea(html, subject.derivation);
                plant::section(html, &setter, subject);
                transform::section(html, &setter, subject);
                cascade::section(html, &setter, subject);
                left_inverse::section(html, &setter, subject);
                regression::section(html, &setter, subject);
                identifiability::section(html, &setter, subject);
                usage::sections(html, &setter, subject);
                #[cfg(feature = "simulate")]
                run::section(html, subject);
                code::section(html, subject);
            });
            html.block("footer", &[], |html| {
                let version = env!("CARGO_PKG_VERSION");
                html.paragraph(&format!("Written by pebo-gen {version}: `pebo-gen report`."));
            });
        });
    });
    html.finish()
}

fn head(html: &mut Html, subject: &Subject<'_>) {
    html.void("meta", &[("charset", "utf-8")]);
    html.void("meta", &[("name", "viewport"), ("content", "width=device-width, initial-scale=1")]);
    html.line("title", &[], |html| html.text(&format!("{}: the proof of its observer", subject.title())));
    html.line("style", &[], |html| html.markup(STYLE));
}

/// The purpose of the claims.
fn idea(html: &mut Html, derivation: &Derivation) {
    html.section("idea", "The idea", |html| {
        html.line("p", &[], |html| {
            html.text("A parameter-estimation-based observer turns the estimation of a moving state ");
            html.formula("<mi>x</mi>");
            html.text(" into that of a constant. It needs a transform ");
            html.formula(
                "<mi>z</mi><mo>=</mo><mi>φ</mi><mrow><mo>(</mo><mi>x</mi><mo>,</mo><mi>y</mi><mo>)</mo></mrow>",
            );
            match derivation.class {
                Class::Pebo => {
                    html.text(
                        " that moves by known signals: the outputs y and the inputs u. An integrator that is fed with \
                         these follows z but for a constant, ",
                    );
                    html.formula("<mi>z</mi><mo>=</mo><mi>χ</mi><mo>+</mo><mi>θ</mi>");
                    html.text(", which depends on where the plant began.");
                }
                Class::Gpebo => {
                    html.text(
                        " whose rate is affine in z itself, with coefficients of known signals: the outputs y and the \
                         inputs u. A copy of it that is fed with these, ",
                    );
                    html.formula("<mi>ξ</mi>");
                    html.text(", differs from z by a known matrix times a constant, ");
                    html.formula("<mi>z</mi><mo>=</mo><mi>ξ</mi><mo>+</mo><mi>Ψ</mi><mi>θ</mi>");
                    html.text(", which depends on where the plant began.");
                }
            }
            html.text(" An estimator finds θ from the outputs, and x is read off z.");
        });
        html.paragraph(
            "Four claims make this right. Each is shown below with its derivation. Proved means: by exact algebra, for all \
             values of the signals and of the parameters that the assumptions and the conditions below allow. A dot over a \
             signal marks its rate.",
        );
    });
}

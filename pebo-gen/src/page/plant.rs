//! The plant: its signals, its class with matrices, its equations, and its assumptions.

use pebo_cas::{Expr, Symbol};
use pebo_design::plant::{Class, Plant};

use super::formula::{Setter, Steps};
use super::html::Html;
use super::subject::Subject;

fn class(html: &mut Html, setter: &Setter<'_>, plant: &Plant) {
    let Some(class) = &plant.class else { return };
    html.line("h3", &[], |html| html.text("Written by class"));
    match class {
        Class::Linear(linear) => {
            html.paragraph(
                "A linear plant: the blocks A and B are those of its author. The rows of the first block are combinations \
                 of those of the second, which is what a linear transform needs.",
            );
            html.display(
                "<mover><mi>x</mi><mo>˙</mo></mover><mo>=</mo><msub><mi>A</mi><mn>11</mn></msub><mi>x</mi><mo>+</mo>\
                 <msub><mi>A</mi><mn>12</mn></msub><mi>y</mi><mo>+</mo><msub><mi>B</mi><mn>1</mn></msub><mi>u</mi>\
                 <mo>,</mo><mspace width=\"1em\"/><mover><mi>y</mi><mo>˙</mo></mover><mo>=</mo>\
                 <msub><mi>A</mi><mn>21</mn></msub><mi>x</mi><mo>+</mo><msub><mi>A</mi><mn>22</mn></msub><mi>y</mi>\
                 <mo>+</mo><msub><mi>B</mi><mn>2</mn></msub><mi>u</mi>",
            );
            let indexed = |index: &str| format!("<msub><mi>A</mi><mn>{index}</mn></msub>");
            let mut steps = Steps::default();
            steps.add(&indexed("11"), &setter.matrix(linear.a11.rows()), "");
            steps.add(&indexed("21"), &setter.matrix(linear.a21.rows()), "");
            html.display(&steps.finish());
        }
        Class::Mechanical(mechanical) => {
            html.paragraph(
                "A mechanical plant in Hamiltonian form: y are positions q and x are momenta p. Its equations follow from \
                 the energy H with the inertia matrix M, the potential V and the forces G u.",
            );
            html.display(
                "<mover><mi>q</mi><mo>˙</mo></mover><mo>=</mo><mfrac><mrow><mi>∂</mi><mi>H</mi></mrow><mrow><mi>∂</mi>\
                 <mi>p</mi></mrow></mfrac><mo>,</mo><mspace width=\"1em\"/><mover><mi>p</mi><mo>˙</mo></mover><mo>=</mo>\
                 <mo>−</mo><mfrac><mrow><mi>∂</mi><mi>H</mi></mrow><mrow><mi>∂</mi><mi>q</mi></mrow></mfrac><mo>+</mo>\
                 <mi>G</mi><mi>u</mi>",
            );
            let mut steps = Steps::default();
            steps.add("<mi>M</mi>", &setter.matrix(mechanical.inertia.rows()), "");
            let energy = mechanical.in_velocities.as_ref().map_or(mechanical.energy, |shown| shown.energy);
            steps.add("<mi>H</mi>", &setter.expr(energy), "");
            html.display(&steps.finish());
        }
        Class::Electromechanical(coils) => {
            html.paragraph(
                "Coils that move a mass: x is its position, and the first outputs are the currents i. The fluxes λ are \
                 moved by the voltages and the resistances, as Faraday's law says.",
            );
            html.display(
                "<mi>λ</mi><mo>=</mo><mi>L</mi><mi>i</mi><mo>+</mo><mi>μ</mi><mo>,</mo><mspace width=\"1em\"/>\
                 <mover><mi>λ</mi><mo>˙</mo></mover><mo>=</mo><mo>−</mo><mi>R</mi><mi>i</mi><mo>+</mo><mi>B</mi><mi>u</mi>",
            );
            let mut steps = Steps::default();
            steps.add("<mi>L</mi>", &setter.matrix(coils.inductance.rows()), "");
            steps.add("<mi>μ</mi>", &setter.column(&coils.magnets), "");
            html.display(&steps.finish());
        }
    }
}

fn described(html: &mut Html, setter: &Setter<'_>, plant: &Plant) {
    signals(html, setter, plant);
    class(html, setter, plant);
    html.line("h3", &[], |html| html.text("Equations"));
    let mut steps = Steps::default();
    for (symbol, rate) in rates(plant) {
        steps.add(&setter.rate(symbol), &setter.expr(rate), "");
    }
    for output in &plant.y {
        if let Some(value) = output.value {
            steps.add(&setter.symbol(output.symbol), &setter.expr(value.expr), "");
        }
    }
    html.display(&steps.finish());
    comparisons(html, setter, plant);
}

/// The plant, with its model file.
pub(super) fn section(html: &mut Html, setter: &Setter<'_>, subject: &Subject<'_>) {
    html.section("plant", "Plant", |html| {
        described(html, setter, subject.plant);
        html.folded("The model file", |html| html.code(subject.source.text()));
    });
}

/// The rates in their shortest form: in velocities, for a mechanical plant with a long inverse of M.
fn rates(plant: &Plant) -> Vec<(Symbol, Expr)> {
    let states = plant.x.iter().map(|state| (state.symbol, state.rate.expr));
    match &plant.class {
        Some(Class::Mechanical(mechanical)) if mechanical.in_velocities.is_some() => {
            let shown = mechanical.in_velocities.as_ref();
            let momenta = shown.map_or(&[][..], |shown| &shown.rates);
            let velocities = shown.map_or(&[][..], |shown| &shown.velocities);
            let momenta = plant.x.iter().zip(momenta).map(|(state, rate)| (state.symbol, *rate));
            momenta.chain(plant.y.iter().zip(velocities).map(|(output, rate)| (output.symbol, *rate))).collect()
        }
        _ => states.chain(plant.y.iter().filter_map(|output| Some((output.symbol, output.rate?.expr)))).collect(),
    }
}

/// The names and their meanings.
fn signals(html: &mut Html, setter: &Setter<'_>, plant: &Plant) {
    let groups: [(&str, Vec<Symbol>); 5] = [
        ("states, not measured: x", plant.x.iter().map(|state| state.symbol).collect()),
        ("outputs, measured: y", plant.y.iter().map(|output| output.symbol).collect()),
        ("inputs, known: u", plant.commanded().collect()),
        ("time in s, an input: u", plant.time.into_iter().collect()),
        ("signals that are neither known nor estimated: w", plant.w.clone()),
    ];
    html.block("div", &[("class", "wide")], |html| {
        html.block("table", &[], |html| {
            html.line("caption", &[], |html| html.text("Signals and parameters"));
            html.block("tbody", &[], |html| {
                for (name, symbols) in groups.into_iter().filter(|(_, symbols)| !symbols.is_empty()) {
                    html.line("tr", &[], |html| {
                        html.within("th", &[("scope", "row")], |html| html.text(name));
                        html.within("td", &[], |html| html.formula(&setter.symbols(&symbols)));
                    });
                }
                if !plant.parameters.is_empty() {
                    html.line("tr", &[], |html| {
                        html.within("th", &[("scope", "row")], |html| html.text("parameters, constant"));
                        html.within("td", &[], |html| parameters(html, setter, plant));
                    });
                }
            });
        });
    });
}

fn parameters(html: &mut Html, setter: &Setter<'_>, plant: &Plant) {
    for (index, parameter) in plant.parameters.iter().enumerate() {
        if index > 0 {
            html.text(", ");
        }
        let name = setter.symbol(parameter.symbol);
        if let Some(value) = &parameter.value {
            html.formula(&format!("{name}<mo>=</mo>{}", plant.arena.mathml_value(value)));
        } else {
            html.formula(&name);
            html.text(" (given later)");
        }
    }
}

/// The assumptions and the identities.
fn comparisons(html: &mut Html, setter: &Setter<'_>, plant: &Plant) {
    let assumed: Vec<String> = plant.assumptions.iter().map(|a| setter.compared(a.expr, a.relation)).collect();
    listed(html, "Assumed:", &assumed);
    let identities: Vec<String> =
        plant.identities.iter().map(|identity| format!("{}<mo>=</mo><mn>0</mn>", setter.expr(identity.expr))).collect();
    listed(html, "Zero along every motion, and used by every claim:", &identities);
    let known: Vec<String> = plant
        .known
        .iter()
        .map(|(s, value)| format!("{}<mo>=</mo>{}", setter.symbol(*s), setter.expr(value.expr)))
        .collect();
    listed(html, "Known where the observer starts:", &known);
    let angles: Vec<String> = plant
        .angles
        .iter()
        .map(|(s, period)| format!("{}<mo>:</mo>{}", setter.symbol(*s), setter.expr(period.expr)))
        .collect();
    listed(html, "Angles, with their periods:", &angles);
}

/// Formulas behind a lead, with a line for each where it is narrow.
pub(super) fn listed(html: &mut Html, lead: &str, formulas: &[String]) {
    if formulas.is_empty() {
        return;
    }
    html.paragraph(lead);
    html.block("ul", &[("class", "formulas")], |html| {
        for formula in formulas {
            html.line("li", &[("class", "wide")], |html| html.formula(formula));
        }
    });
}

//! What to know in use, in a line each: whether Psi stays bounded, where the plant rests, what drifts, how long theta holds.

use crate::analysis::{Class, Derivation, Drift, Equilibrium, Fundamental, OperatingPoint, Outcome, Verdict};
use crate::cas::Symbol;
use crate::plant::{Class as PlantClass, Plant};
use crate::source::listed;

/// A remark: its name and its lines.
pub(super) struct Remark {
    pub(super) name: &'static str,
    pub(super) lines: Vec<String>,
}

/// The remarks on a plant with a proved cascade.
pub(super) fn of(plant: &Plant, derivation: &Derivation) -> Vec<Remark> {
    if plant.arena.budget().is_exhausted() {
        return Vec::new();
    }
    let remark = |name, lines| Remark { name, lines };
    let rests = derivation.operating_point(plant).map(|equilibrium| match equilibrium {
        Equilibrium::At(point) => rest(plant, derivation.class, point),
        Equilibrium::Nowhere(symbol) => vec![format!("none: `{}` never rests", plant.arena.name(*symbol))],
        Equilibrium::Undecided(reason) => vec![format!("none was found: {reason}")],
    });
    let mut remarks = fundamental(plant, derivation);
    remarks.extend(rests.map(|lines| remark("operating point", lines)));
    remarks.extend(special(plant).map(|line| remark("values", vec![line])));
    if derivation.outcome == Outcome::Accepted {
        let drift = derivation.drift(plant);
        remarks.extend(drift.map(|drift| {
            remark("drift", vec![grows(plant, drift), format!("against it {}", remedy(plant, derivation))])
        }));
        let jump = "another constant after a jump of the state: then start anew, or let the estimator forget";
        remarks.push(remark("theta", vec![jump.to_owned()]));
    }
    remarks
}

/// What becomes of a generalised cascade's fundamental matrix, what that means, and what would do without it.
fn fundamental(plant: &Plant, derivation: &Derivation) -> Vec<Remark> {
    let cascade = derivation.cascade.result.as_ref().filter(|_| derivation.cascade.verdict == Verdict::Proved);
    let Some((cascade, fundamental)) = cascade.and_then(|cascade| Some((cascade, cascade.fundamental?))) else {
        return Vec::new();
    };
    let lines: &[&str] = match fundamental {
        Fundamental::Bounded { fades: false } => &["bounded: no error of theta is amplified"],
        Fundamental::Bounded { fades: true } => &[
            "bounded, but theta is forgotten where Psi dies out: what the model misses later stays uncorrected there",
            RESTART,
        ],
        Fundamental::Grows => &["grows, and with it every error of theta, until a number overflows", RESTART],
        Fundamental::NotShown => &[
            "not shown to be bounded: if it grows, so does every error of theta; if it dies out, theta is forgotten",
            RESTART,
        ],
    };
    let lines = lines.iter().map(|line| (*line).to_owned()).collect();
    let mut remarks = vec![Remark { name: "Psi", lines }];
    remarks.extend(cascade.mend.iter().map(|mend| {
        let phi: Vec<String> = mend.iter().map(|component| plant.arena.print(*component)).collect();
        Remark {
            name: "plain instead",
            lines: vec![
                format!("phi: [{}] has a plain cascade, z' = h(y, u), without Psi", phi.join(", ")),
                "its extension is an open integrator: a constant bias of a sensor or input makes it drift".to_owned(),
            ],
        }
    }));
    remarks
}

/// What makes the fundamental matrix the identity again.
const RESTART: &str = "`restart` at the estimate of z, with theta = 0, makes Psi the identity again";

/// On which values the verdict rests, where it is another than in general.
fn special(plant: &Plant) -> Option<String> {
    let Some(PlantClass::Linear(linear)) = &plant.class else { return None };
    let arena = &plant.arena;
    let value = |symbol: &Symbol| {
        let parameter = plant.parameters.iter().find(|p| p.symbol == *symbol)?;
        Some(format!("{} = {}", arena.name(*symbol), arena.print(arena.number(parameter.value.clone()?))))
    };
    let values: Vec<String> = linear.special.iter().filter_map(value).collect();
    let given = listed(values.iter().map(String::as_str));
    (!values.is_empty()).then(|| format!("the ranks are others for {given} than in general: the verdict is for these"))
}

/// The point, and what holds there.
fn rest(plant: &Plant, class: Class, point: &OperatingPoint) -> Vec<String> {
    let arena = &plant.arena;
    let mut lines: Vec<String> = point
        .values
        .iter()
        .map(|(symbol, value)| format!("{} = {}", arena.name(*symbol), arena.print(*value)))
        .collect();
    if point.still {
        lines.push(match class {
            Class::Pebo => "h = 0 there: chi rests but for a bias".to_owned(),
            Class::Gpebo => "Lambda z + h = 0 there: z rests".to_owned(),
        });
        lines.extend(point.rank.filter(|rank| *rank > 0).map(|rank| {
            format!("rank [f; h_i] falls from {rank} to 0 there: Frobenius' theorem gives no phi, this one is explicit")
        }));
    }
    lines
}

fn grows(plant: &Plant, drift: &Drift) -> String {
    let names = |symbols: &[Symbol]| {
        let names: Vec<String> = symbols.iter().map(|s| plant.arena.name(*s)).collect();
        listed(names.iter().map(String::as_str))
    };
    let integrators = names(&drift.integrators);
    if drift.integrated.is_empty() {
        return format!("without end in {integrators}");
    }
    format!("in {integrators} under a constant bias of {}", names(&drift.integrated))
}

/// What the runtime has against drift.
fn remedy(plant: &Plant, derivation: &Derivation) -> &'static str {
    match (derivation.class, derivation.can_rebase(plant)) {
        (Class::Pebo, true) => "use `step_without_drift`, and an estimator that forgets",
        (Class::Gpebo, true) => "use `rebase`, and an estimator that forgets",
        (_, false) => "start anew before the extension loses its digits",
    }
}

//! Remarks for use, a line each: boundedness of Psi, equilibria, drift. Remarks that hold for every model are in the
//! manual.

use super::growth::Growth;
use pebo_cas::{Expr, Symbol};
use pebo_design::analysis::{
    Class, Derivation, Drift, Equilibrium, Fundamental, OperatingPoint, Outcome, Verdict, on_sides,
};
use pebo_design::plant::{Class as PlantClass, Plant};
use pebo_design::search;
use pebo_design::source::listed;

/// A remark: its name, the values that it gives, and its lines.
pub(crate) struct Remark {
    pub(crate) name: &'static str,
    pub(crate) values: Vec<(Symbol, Expr)>,
    pub(crate) lines: Vec<String>,
}

/// The remarks on a plant with a proved cascade.
pub(crate) fn of(plant: &Plant, derivation: &Derivation) -> Vec<Remark> {
    if plant.arena.budget().is_exhausted() {
        return Vec::new();
    }
    let remark = |name, lines| Remark { name, values: Vec::new(), lines };
    let rests = derivation.operating_point(plant).map(|equilibrium| match equilibrium {
        Equilibrium::At(point) => (point.values.clone(), rest(plant, derivation.class, point)),
        Equilibrium::Nowhere(symbol) => {
            (Vec::new(), vec![format!("none: the rate of `{}` is never zero", plant.arena.name(*symbol))])
        }
        Equilibrium::Undecided(reason) => (Vec::new(), vec![format!("none was found: {reason}")]),
    });
    let mut remarks: Vec<Remark> =
        plant.time.map(|time| remark("time", time_is_input(plant, time))).into_iter().collect();
    let jumps = jumps(plant, derivation);
    remarks.extend((!jumps.is_empty()).then(|| remark("jumps", jumps)));
    remarks.extend(fundamental(plant, derivation));
    remarks.extend(search::symmetry_beside(plant, derivation).map(|symmetry| {
        let nearest = "estimates converge to those that they begin near: assume what tells them apart";
        remark("other states", vec![symmetry.same_outputs(&plant.arena), nearest.to_owned()])
    }));
    remarks.extend(rests.map(|(values, lines)| Remark { name: "operating point", values, lines }));
    remarks.extend(special(plant).map(|line| remark("values", vec![line])));
    remarks.extend(Growth::of_long(plant, derivation).and_then(long).map(|lines| remark("cost", lines)));
    if derivation.outcome == Outcome::Accepted {
        let drift = derivation.drift(plant);
        remarks.extend(drift.map(|drift| {
            let remedy = if drift.uncorrected.is_empty() {
                format!("remedy: {}", remedy(plant, derivation))
            } else {
                format!("no output corrects {}: {RESTART_KNOWN}", names(plant, &drift.uncorrected))
            };
            remark("drift", vec![grows(plant, drift), remedy])
        }));
    }
    remarks
}

/// The remark that the time is an input.
fn time_is_input(plant: &Plant, time: Symbol) -> Vec<String> {
    let name = plant.arena.name(time);
    vec![
        format!("`{name}` is not declared: it is a known input, the time in s"),
        "the application hands it over with the other inputs, at the middle of each step".to_owned(),
    ]
}

/// The jumps of the transform, and their effect on the unknown constant.
fn jumps(plant: &Plant, derivation: &Derivation) -> Vec<String> {
    let arena = &plant.arena;
    let line = |(component, border): (Symbol, Expr)| {
        let (component, border) = (arena.name(component), arena.print(border));
        format!("`{component}` was not shown to be continuous where `{border}` passes zero: there `theta` changes")
    };
    derivation.jumps(plant).into_iter().map(line).collect()
}

/// The fate of a generalised cascade's fundamental matrix, its meaning, and a plain cascade instead.
fn fundamental(plant: &Plant, derivation: &Derivation) -> Vec<Remark> {
    let cascade = derivation.cascade.result.as_ref().filter(|_| derivation.cascade.verdict == Verdict::Proved);
    let Some((cascade, fundamental)) = cascade.and_then(|cascade| Some((cascade, cascade.fundamental?))) else {
        return Vec::new();
    };
    let remedy = match (derivation.at_estimate().is_some(), derivation.can_rebase(plant)) {
        (true, _) => MOVED,
        (false, true) => REBASE,
        (false, false) => RESTART,
    };
    let lines: &[&str] = match fundamental {
        Fundamental::Bounded { fades: false } => &["stays bounded: errors of theta are not amplified"],
        Fundamental::Bounded { fades: true } => &[
            "stays bounded but decays, at least in some directions: later disturbances of z are not corrected there",
            remedy,
        ],
        Fundamental::Grows => {
            &["grows without bound: it amplifies every error of theta until numbers overflow", remedy]
        }
        Fundamental::Undecided => &[
            "was not shown to stay bounded",
            "if it grows, it amplifies errors of theta; if it decays, later disturbances of z are not corrected",
            remedy,
        ],
    };
    let lines = lines.iter().map(|line| (*line).to_owned()).collect();
    let mut remarks = vec![Remark { name: "Psi", values: Vec::new(), lines }];
    remarks.extend(cascade.mend.iter().map(|mend| {
        let phi: Vec<String> = mend.iter().map(|component| plant.arena.print(*component)).collect();
        Remark {
            name: "plain cascade",
            values: Vec::new(),
            lines: vec![
                format!("phi: [{}] has the plain cascade z' = h(y, u) and needs no Psi", phi.join(", ")),
                "its extension is an open integrator, which drifts under a constant bias of a sensor or input"
                    .to_owned(),
            ],
        }
    }));
    remarks
}

/// Said of the observer of a local regression.
const MOVED: &str = "the observer makes it the identity at every sample";

/// The remedy if all memory can be carried over.
const REBASE: &str = "remedy: `rebase: 1` under `observer`, which is set unless gains are written, makes it the identity at every sample";

/// The remedy that makes the fundamental matrix the identity again.
const RESTART: &str = "remedy: `restart` from the estimate of z with theta = 0 sets Psi back to the identity";

/// The values that the verdict depends on, if it differs from the general one.
fn special(plant: &Plant) -> Option<String> {
    let Some(PlantClass::Linear(linear)) = &plant.class else { return None };
    let arena = &plant.arena;
    let value = |symbol: &Symbol| {
        let parameter = plant.parameters.iter().find(|p| p.symbol == *symbol)?;
        Some(format!("{} = {}", arena.name(*symbol), arena.print(arena.number(parameter.value.clone()?))))
    };
    let values: Vec<String> = linear.special.iter().filter_map(value).collect();
    let given = listed(values.iter().map(String::as_str));
    (!values.is_empty())
        .then(|| format!("the verdict holds for {given}: with general values, some matrix ranks are different"))
}

/// The remark that the observer's functions are far longer than the model, with its remedy.
fn long(growth: Growth) -> Option<Vec<String>> {
    let Growth { written, derived, most } = growth;
    let times = growth.many()?;
    let remedy = match most {
        "phi_left" => "give a shorter `phi_left` if you know one: it is proved like the derived one",
        _ => "write the model in other coordinates, or with parts under `define` that cancel in its derivatives",
    };
    Some(vec![
        format!("the observer's functions take {derived} operations, {times} times those of the model ({written})"),
        format!("most are in {most}; remedy: {remedy}"),
    ])
}

/// Said of an equilibrium beside which there may be others.
pub(super) const ONE_OF_THEM: &str = "one of them: it was not shown that there are no other equilibria";

/// Properties of the point.
fn rest(plant: &Plant, class: Class, point: &OperatingPoint) -> Vec<String> {
    let mut lines = Vec::new();
    let states = plant.x.iter().map(|state| state.symbol).chain(plant.y.iter().map(|output| output.symbol));
    let is_free = |symbol: &Symbol| point.values.iter().all(|(determined, _)| determined != symbol);
    let free: Vec<String> = states.filter(is_free).map(|symbol| plant.arena.name(symbol)).collect();
    if !free.is_empty() {
        lines.push(format!("free: {}", listed(free.iter().map(String::as_str))));
    }
    if !point.sides.is_empty() {
        lines.push(format!("while {}", on_sides(plant, &point.sides)));
    }
    if !point.complete {
        lines.push(ONE_OF_THEM.to_owned());
    }
    if point.still {
        lines.push(match class {
            Class::Pebo => "h = 0 there: chi is constant if no sensor or input has a bias".to_owned(),
            Class::Gpebo => "Lambda z + h = 0 there: z is constant".to_owned(),
        });
    }
    lines
}

fn grows(plant: &Plant, drift: &Drift) -> String {
    let integrators = names(plant, &drift.integrators);
    if drift.integrated.is_empty() {
        return format!("the constant h makes {integrators} grow without bound");
    }
    format!("a constant bias of {} makes {integrators} grow without bound", names(plant, &drift.integrated))
}

fn names(plant: &Plant, symbols: &[Symbol]) -> String {
    let names: Vec<String> = symbols.iter().map(|s| plant.arena.name(*s)).collect();
    listed(names.iter().map(String::as_str))
}

/// The remedy where no output shows the state.
const RESTART_KNOWN: &str = "restart the observer wherever the states are known again";

/// The runtime's remedy for drift.
fn remedy(plant: &Plant, derivation: &Derivation) -> &'static str {
    match (derivation.class, derivation.can_rebase(plant)) {
        (Class::Pebo, true) => "use `step_without_drift` and an estimator with forgetting",
        (Class::Gpebo, true) => "use `rebase` and an estimator that forgets or has process noise",
        (_, false) => "restart the observer before the extension grows so large that rounding matters",
    }
}

//! The certificate of an accepted model: a Python script that proves its claims again with `SymPy`, and without pebo.
//!
//! In: the model as it was written, and its derivation. Out: a script of two parts, the formulas as texts in the model
//! file's grammar and `checker.py`, which reads and proves them; what the verdict says of trajectories it looks at in
//! points of them. The plant is restated from the author's own formulas,
//! also where it is written by class, so that a mistake of pebo's in reading, expanding or proving it is found.

mod python;

use pebo_cas::{Expr, Symbol};
use pebo_design::analysis::{
    BlindTrajectory, Derivation, Excitation, RegressionKind, Still, Trajectories, TrajectoryCondition,
};
use pebo_design::model::class::Matrix;
use pebo_design::model::formula::{Interpolation, Term};
use pebo_design::model::{Class, Decimal, Entry, Formula, Model};
use pebo_design::plant::Plant;

use python::Literal;

/// The part of the script that reads and proves the formulas.
const CHECKER: &str = include_str!("checker.py");

/// The script for a model whose claims are all proved; none for another.
pub(crate) fn certificate(model: &Model, plant: &Plant, derivation: &Derivation) -> Option<String> {
    derivation.admit().ok()?;
    let derived = derived(plant, derivation)?;
    let name = &plant.name;
    let title = plant.title.as_ref().map(|title| format!(": {}", title.replace(['\\', '"'], " "))).unwrap_or_default();
    let version = env!("CARGO_PKG_VERSION");
    let head = format!(
        "#!/usr/bin/env python3\n\
         \"\"\"Certificate of `{name}`{title}\n\
         \n\
         Proves again, with SymPy alone, what pebo-gen {version} proved of this model:\n\
         \n    pip install sympy\n    python3 {name}.py\n\
         \n\
         PLANT is what its author wrote; DERIVED is what pebo-gen made of it. Exit status 0: every claim is proved;\n\
         1: a claim is false, and a point shows it; 2: SymPy could decide neither. What is said of trajectories is\n\
         looked at in points of them: one may show that it is false, and none proves it.\n\
         \"\"\"\n"
    );
    let part = |name: &str, literal: &Literal| {
        let key = format!("{name} = ");
        format!("{key}{}\n", literal.layout(key.len() + 120, 0))
    };
    Some(format!("{head}\n{}\n{}\n{CHECKER}", part("PLANT", &stated(model)), part("DERIVED", &derived)))
}

/// The plant in its author's formulas, without absent keys.
fn stated(model: &Model) -> Literal {
    let texts = |formulas: &[Formula]| Literal::texts(formulas);
    let named =
        |entries: &[Entry<Formula>]| Literal::named(entries.iter().map(|entry| (&entry.name.value, &entry.value)));
    let names = |list: &[pebo_design::model::Spanned<String>]| Literal::texts(list.iter().map(|name| &name.value));
    let parameter = |entry: &Entry<Option<pebo_design::model::Spanned<pebo_design::model::Decimal>>>| {
        let value = entry.value.as_ref().map_or(Literal::None, |value| Literal::text(value.value.text()));
        (entry.name.value.clone(), value)
    };
    let class = model.class.as_ref().map(|class| match class {
        Class::Lti(lti) => {
            let blocks = [
                ("A11", &lti.a11),
                ("A12", &lti.a12),
                ("A21", &lti.a21),
                ("A22", &lti.a22),
                ("B1", &lti.b1),
                ("B2", &lti.b2),
            ];
            (Class::LTI, blocks.into_iter().filter_map(|(name, block)| matrix(name, block.as_ref())).collect())
        }
        Class::Mechanical(class) => {
            let mut parts: Vec<_> = [("M", &class.m), ("G", &class.g)]
                .into_iter()
                .filter_map(|(name, block)| matrix(name, block.as_ref()))
                .collect();
            parts.extend(class.v.as_ref().map(|v| ("V".to_owned(), Literal::text(v))));
            (Class::MECHANICAL, parts)
        }
        Class::Electromechanical(class) => {
            let blocks =
                [("L", &class.inductance), ("mu", &class.mu), ("R", &class.resistance), ("B", &class.voltages)];
            let mut parts: Vec<_> =
                blocks.into_iter().filter_map(|(name, block)| matrix(name, block.as_ref())).collect();
            parts.extend(class.speed.as_ref().map(|speed| ("speed".to_owned(), Literal::text(&speed.value))));
            let scalars = [("inertia", &class.inertia), ("friction", &class.friction), ("load", &class.load)];
            let given = |(name, formula): (&str, &Option<Formula>)| {
                formula.as_ref().map(|formula| (name.to_owned(), Literal::text(formula)))
            };
            parts.extend(scalars.into_iter().filter_map(given));
            (Class::ELECTROMECHANICAL, parts)
        }
    });
    // The last input is then the time.
    let time = model.time.and(model.u.last());
    let mut parts = vec![
        ("parameters", Literal::Dict(model.parameters.iter().map(parameter).collect())),
        ("x", names(&model.x)),
        ("y", names(&model.y)),
        ("u", names(&model.u)),
        ("w", names(&model.w)),
        ("time", time.map_or(Literal::None, |name| Literal::text(&name.value))),
        ("tables", Literal::Dict(tables(model))),
        ("define", named(&model.define)),
        ("assume", Literal::texts(&model.assume)),
        ("identities", texts(&model.identities)),
        ("known", named(&model.known)),
        ("angles", named(&model.angles)),
        ("f_x", named(&model.f_x)),
        ("f_y", named(&model.f_y)),
        ("g_y", named(&model.g_y)),
    ];
    parts.extend(class.map(|(name, parts)| (name, Literal::Dict(parts))));
    dict(parts)
}

/// The tables by their points.
fn tables(model: &Model) -> Vec<(String, Literal)> {
    let table = |entry: &Entry<Formula>| {
        let Term::Table(table, ..) = &entry.value.term else { return None };
        let point = |(at, value): &(Decimal, Decimal)| Literal::texts([at.text(), value.text()]);
        let mut parts = vec![("points", Literal::List(table.points.iter().map(point).collect()))];
        if table.interpolation == Interpolation::Linear {
            parts.push(("linear", Literal::Truth(true)));
        }
        Some((table.name.clone(), dict(parts)))
    };
    model.define.iter().filter_map(table).collect()
}

/// A matrix with the depth of lists that its author gave it.
fn matrix(name: &str, matrix: Option<&Matrix>) -> Option<(String, Literal)> {
    let matrix = matrix?;
    let literal = match (matrix.depth, matrix.rows.first()) {
        (0, Some(row)) => Literal::text(row.first()?),
        (1, Some(row)) => Literal::texts(row),
        _ => Literal::List(matrix.rows.iter().map(Literal::texts).collect()),
    };
    Some((name.to_owned(), literal))
}

/// The derivation, if it is complete.
fn derived(plant: &Plant, derivation: &Derivation) -> Option<Literal> {
    let arena = &plant.arena;
    let cascade = derivation.cascade.result.as_ref()?;
    let inverse = derivation.left_inverse.result.as_ref()?;
    let regression = derivation.regression.result.as_ref()?;
    let identifiability = derivation.identifiability.result.as_ref()?;
    let texts = |exprs: &[Expr]| Literal::texts(exprs.iter().map(|expr| arena.print(*expr)));
    let rows = |rows: &[Vec<Expr>]| Literal::List(rows.iter().map(|row| texts(row)).collect());
    let symbols = |symbols: &[Symbol]| Literal::texts(symbols.iter().map(|symbol| arena.name(*symbol)));
    let left = match regression.kind {
        RegressionKind::Dynamic => {
            symbols(&regression.rows().into_iter().map(|row| plant.y[row].symbol).collect::<Vec<_>>())
        }
        RegressionKind::Static | RegressionKind::Implicit => Literal::None,
    };
    let kind = match identifiability.kind {
        Excitation::Instant => "instant",
        Excitation::Excitation => "excitation",
        Excitation::Never => "never",
    };
    let extension = match cascade.lambda {
        None => dict(vec![("chi", symbols(&plant.chi))]),
        Some(_) => dict(vec![
            ("xi", symbols(&plant.xi)),
            ("Psi", Literal::List(plant.psi.iter().map(|row| symbols(row)).collect())),
        ]),
    };
    let determinant = identifiability.gram.as_ref().map(|gram| Literal::text(&arena.print(gram.determinant)));
    let conditions =
        derivation.conditions.iter().map(|(expr, relation)| format!("{} {}", arena.print(*expr), relation.sign()));
    Some(dict(vec![
        ("z", symbols(&plant.z)),
        ("theta", symbols(&plant.theta)),
        ("extension", extension),
        ("phi", texts(&plant.transform())),
        ("h", texts(&cascade.h)),
        ("Lambda", cascade.lambda.as_deref().map_or(Literal::None, rows)),
        (
            "phi_left",
            Literal::named(inverse.x.iter().map(|(state, formula)| (arena.name(*state), arena.print(*formula)))),
        ),
        ("y'", left),
        ("primitive_0", texts(&regression.primitive_0)),
        ("primitive_1", rows(&regression.primitive_1)),
        ("phi_0", texts(&regression.phi_0)),
        ("phi_1", rows(&regression.phi_1)),
        ("local", if regression.is_at_estimate() { Literal::Truth(true) } else { Literal::None }),
        (
            "eta",
            Literal::named(
                regression
                    .eta_symbols
                    .iter()
                    .zip(&regression.eta)
                    .map(|(symbol, eta)| (arena.name(*symbol), arena.print(*eta))),
            ),
        ),
        ("theta of eta", texts(&regression.theta)),
        ("identifiability", Literal::text(kind)),
        ("by start", symbols(&derivation.fixed_by_start(plant))),
        ("trajectories", identifiability.trajectories.as_ref().map_or(Literal::None, |t| trajectories(plant, t))),
        ("determinant of phi_1' phi_1", determinant.unwrap_or(Literal::None)),
        ("conditions", Literal::texts(conditions)),
    ]))
}

/// What is said of the motion that the unknowns need. What is undecided is no claim, but an exception of one.
fn trajectories(plant: &Plant, trajectories: &Trajectories) -> Literal {
    let text = |expr: Expr| Literal::text(&plant.arena.print(expr));
    let texts = |exprs: &[Expr]| Literal::List(exprs.iter().copied().map(text).collect());
    let (open, decided): (Vec<_>, Vec<_>) = trajectories.blind.iter().partition(|blind| blind.hidden.is_empty());
    let statement = |blind: &BlindTrajectory| {
        let mut parts = vec![("while", Literal::text(&blind.condition(plant)))];
        parts.extend(self::parts(plant, &blind.condition));
        parts.push(("identified", texts(&blind.identifiable)));
        parts.push(("hidden", Literal::List(blind.hidden.iter().map(|direction| texts(direction)).collect())));
        dict(parts)
    };
    let exception = |blind: &BlindTrajectory| dict(parts(plant, &blind.condition));
    dict(vec![
        ("by itself", trajectories.by_itself.map_or(Literal::None, Literal::Truth)),
        ("at rest", Literal::Truth(trajectories.at_rest)),
        ("blind", Literal::List(decided.into_iter().map(statement).collect())),
        ("undecided", Literal::List(open.into_iter().map(exception).collect())),
    ])
}

/// The parts of a condition of trajectories, which all hold.
fn parts(plant: &Plant, condition: &TrajectoryCondition) -> Vec<(&'static str, Literal)> {
    let arena = &plant.arena;
    let TrajectoryCondition { sides, still, zeros } = condition;
    let constant = if let Still::Inputs(inputs) = still { inputs.as_slice() } else { &[] };
    let positive = sides.iter().map(|(divider, side)| arena.print(side.positive(arena, *divider)));
    vec![
        ("zero", Literal::texts(zeros.iter().map(|zero| arena.print(*zero)))),
        ("positive", Literal::texts(positive)),
        ("constant", Literal::texts(constant.iter().map(|input| arena.name(*input)))),
        ("rest", if *still == Still::Plant { Literal::Truth(true) } else { Literal::None }),
    ]
}

/// A dictionary without empty values.
fn dict(parts: Vec<(&str, Literal)>) -> Literal {
    let kept = parts.into_iter().filter(|(_, value)| !value.is_empty());
    Literal::Dict(kept.map(|(name, value)| (name.to_owned(), value)).collect())
}

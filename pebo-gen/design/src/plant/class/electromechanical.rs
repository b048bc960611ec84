//! Coils that move one mass: the flux is the transform.
//!
//! ```text
//! lambda = L(q) i + mu(q)            lambda' = -R i + B u            q' = omega
//! L i' = -R i + B u - (L' i + mu') omega
//! j omega' = i' L' i / 2 + i' mu' - f omega - tau
//! ```
//!
//! The currents are the first outputs. The speed is an output after them (its equation is then used), an
//! input, or an unmeasured signal (Ortega et al. 2015, Section 5.2).

use std::collections::BTreeSet;

use crate::model::{Electromechanical as WrittenClass, Formula as WrittenFormula, Model};
use crate::plant::Matrix;
use crate::plant::parts::{Assumption, Formula, Output, State};
use crate::source::{Code, Diagnostic, Diagnostics, Span, listed, nearest};
use pebo_cas::number::rational::half;
use pebo_cas::tower::Obstacle;
use pebo_cas::{Expr, Relation, Symbol};

use super::context::{ClassContext, Expansion, Names, Proposal, Stop, singular, unresolved};
use super::shape::{self, Size};

/// Coils that move one mass.
#[derive(Clone, Debug)]
pub struct Electromechanical {
    /// Inductances.
    pub inductance: Matrix,
    /// Fluxes of magnets.
    pub magnets: Vec<Expr>,
}

/// The number of coils: of outputs that are not the speed.
pub(super) fn coils(class: &WrittenClass, model: &Model) -> usize {
    let is_speed = |name: &str| class.speed.as_ref().is_some_and(|speed| speed.value == name);
    model.y.iter().filter(|output| !is_speed(&output.value)).count()
}

pub(super) fn expand(
    context: &ClassContext<'_>,
    written: &WrittenClass,
    names: &Names<'_>,
    problems: &mut Diagnostics,
) -> Result<Expansion<Electromechanical>, Stop> {
    let (arena, facts) = (context.arena, &context.domain.facts);
    let (Some(l), Some(speed_name)) = (&written.inductance, &written.speed) else { return Err(Stop::Reported) };
    let speed = speed(context, names, speed_name)?;
    let [position] = names.x else {
        let span = context.model.x[1].span;
        return Err(Diagnostic::error(Code::WrongShape, span, "an electromechanical plant has one position")
            .help("list the position alone in x; the class takes the fluxes as the transform")
            .into());
    };
    let currents: Vec<Symbol> = names.y.iter().copied().filter(|s| *s != speed).collect();
    let n = currents.len();
    if n == 0 || names.y[..n] != currents {
        let span = context.model.y[0].span;
        return Err(Diagnostic::error(Code::WrongShape, span, "the first outputs are not the currents")
            .help("list the currents first in y, the speed after them if it is measured")
            .into());
    }
    counted(written, n)?;
    let ElectromechanicalEntries { inductance, magnets, resistance, voltages, inertia, friction, load } =
        ElectromechanicalEntries::read(context, written, names, (*position, speed, n), problems)
            .ok_or(Stop::Reported)?;
    context.symmetric("L", &inductance, l.span)?;
    let open = |what: &'static str| move |obstacle: Obstacle| Stop::from(unresolved(what, l.span, &obstacle));
    let inverse = inductance.inverse(arena, facts).map_err(open("the inverse of L"))?;
    let inverse = inverse.ok_or_else(|| singular("L", l.span))?;
    let determinant = inductance.determinant(arena, facts).map_err(open("the determinant of L"))?;
    let conditions = if arena.as_number(determinant).is_none() {
        vec![Assumption { expr: determinant, relation: Relation::NonZero, span: l.span }]
    } else {
        Vec::new()
    };

    let symbols = |list: &[Symbol]| -> Vec<Expr> { list.iter().map(|s| arena.of_symbol(*s)).collect() };
    let i = symbols(&currents);
    let u: Vec<Expr> = names.u.iter().filter(|s| **s != speed).map(|s| arena.of_symbol(*s)).collect();
    let omega = arena.of_symbol(speed);
    let slope = inductance.derivative(arena, *position);
    let magnet_slope: Vec<Expr> = magnets.iter().map(|e| arena.derivative(*e, *position)).collect();
    let driven: Vec<Expr> = (0..n)
        .map(|k| {
            let voltage = if u.is_empty() { arena.zero() } else { arena.dot(&voltages.rows()[k], &u) };
            arena.sub(voltage, arena.dot(&resistance.rows()[k], &i))
        })
        .collect();
    // L i', coil by coil.
    let induced: Vec<Expr> = (0..n)
        .map(|k| {
            let moving = arena.add(arena.dot(&slope.rows()[k], &i), magnet_slope[k]);
            arena.sub(driven[k], arena.mul(omega, moving))
        })
        .collect();
    let rates = inverse.apply(arena, &induced);
    let acceleration = inertia.map(|inertia| {
        let force =
            arena.add(arena.scale(arena.dot(&i, &slope.apply(arena, &i)), &half()), arena.dot(&i, &magnet_slope));
        let drag = arena.mul(friction.unwrap_or_else(|| arena.zero()), omega);
        let against = arena.add(drag, load.unwrap_or_else(|| arena.zero()));
        arena.div(arena.sub(force, against), inertia)
    });
    let outputs = names.y.iter().zip(&context.model.y).enumerate().map(|(k, (symbol, name))| {
        let rate = if *symbol == speed { acceleration } else { rates.get(k).copied() };
        let span = match &written.inertia {
            Some(inertia) if *symbol == speed => inertia.span,
            _ => l.span,
        };
        Output { symbol: *symbol, rate: rate.map(|expr| Formula { expr, span }), value: None, span: name.span }
    });
    let phi = (0..n).map(|k| Formula {
        expr: arena.add(arena.dot(&inductance.rows()[k], &i), magnets[k]),
        span: flux_span(l, written.mu.as_ref(), k),
    });
    Ok(Expansion {
        x: vec![State { symbol: *position, rate: Formula { expr: omega, span: speed_name.span } }],
        y: outputs.collect(),
        phi: phi.collect(),
        proposal: Proposal::default(),
        conditions,
        class: Electromechanical { inductance, magnets },
    })
}

/// The formulas of the class.
struct ElectromechanicalEntries {
    inductance: Matrix,
    magnets: Vec<Expr>,
    resistance: Matrix,
    voltages: Matrix,
    inertia: Option<Expr>,
    friction: Option<Expr>,
    load: Option<Expr>,
}

impl ElectromechanicalEntries {
    /// Reads them for so many coils; nothing if there was a mistake, which is reported.
    fn read(
        context: &ClassContext<'_>,
        written: &WrittenClass,
        names: &Names<'_>,
        (position, speed, n): (Symbol, Symbol, usize),
        problems: &mut Diagnostics,
    ) -> Option<Self> {
        let on_q: BTreeSet<Symbol> = [position].iter().chain(names.constants).copied().collect();
        let mut read = |name, matrix, (height, width), diagonal, counted, allowed| {
            let size = Size { height, width, diagonal, counted };
            context.matrix(shape::WrittenMatrix { name, matrix }, size, allowed, problems)
        };
        let nu = names.u.iter().filter(|input| **input != speed).count();
        let inductance = read("L", &written.inductance, (n, n), true, "coils x coils", &on_q);
        let magnets = read("mu", &written.mu, (n, 1), false, "coils x 1", &on_q);
        let resistance = read("R", &written.resistance, (n, n), true, "coils x coils", names.constants);
        let voltages = if written.voltages.is_some() {
            read("B", &written.voltages, (n, nu), nu == n, "coils x voltages", names.constants)
        } else if nu == n {
            Some(Matrix::identity(context.arena, n))
        } else {
            let span = written.inductance.as_ref()?.span;
            let message = format!("{nu} voltages for {n} coils need the matrix B");
            problems.push(
                Diagnostic::error(Code::MissingKey, span, message)
                    .help("add `B`, with a row for each coil and a column for each voltage in u"),
            );
            None
        };
        let mut constant = |formula: &Option<WrittenFormula>, what: &str| match formula {
            Some(formula) => problems.keep(context.formula(formula, names.constants, what)).map(Some),
            None => Some(None),
        };
        let inertia = constant(&written.inertia, "inertia");
        let friction = constant(&written.friction, "friction");
        let load = constant(&written.load, "load");
        Some(Self {
            inductance: inductance?,
            magnets: magnets?.column(0),
            resistance: resistance?,
            voltages: voltages?,
            inertia: inertia?,
            friction: friction?,
            load: load?,
        })
    }
}

/// The declared symbol of the speed.
fn speed(
    context: &ClassContext<'_>,
    names: &Names<'_>,
    written: &crate::model::Spanned<String>,
) -> Result<Symbol, Diagnostic> {
    let signals = || names.y.iter().chain(names.u).chain(names.w);
    let found = signals().find(|symbol| context.arena.name(**symbol) == written.value);
    found.copied().ok_or_else(|| {
        let message = format!("the speed `{}` is not declared", written.value);
        let known: Vec<String> = signals().map(|symbol| context.arena.name(*symbol)).collect();
        let diagnostic = Diagnostic::error(Code::UnknownName, written.span, message)
            .note(format!("signals are {}", listed(known.iter().map(String::as_str))));
        match nearest(&written.value, known.iter().map(String::as_str)) {
            Some(near) => diagnostic.help(format!("did you mean `{near}`?")),
            None => diagnostic.help("declare it under y or u if it is measured, under w if not"),
        }
    })
}

/// Checks that the written number of coils is that of the currents.
fn counted(written: &WrittenClass, n: usize) -> Result<(), Diagnostic> {
    let Some(coils) = &written.coils else { return Ok(()) };
    let found = pebo_cas::Rational::from_decimal(coils.value.text()).ok();
    if found.and_then(|value| value.to_i64()) == i64::try_from(n).ok() {
        return Ok(());
    }
    let message = format!("{} coils, but y has {n} currents", coils.value.text());
    Err(Diagnostic::error(Code::WrongShape, coils.span, message).help("y lists a current for each coil"))
}

/// The span of a component of the flux: the magnet's entry if there is one, else the row of L.
fn flux_span(l: &crate::model::Matrix, mu: Option<&crate::model::Matrix>, k: usize) -> Span {
    let entry = mu.and_then(|mu| if mu.depth == 2 { mu.rows.get(k)?.first() } else { mu.rows[0].get(k) });
    let row = l.rows.get(k).filter(|_| l.depth == 2);
    match (entry, row) {
        (Some(entry), _) => entry.span,
        (None, Some(row)) => row[0].span.to(row[row.len() - 1].span),
        (None, None) => l.span,
    }
}

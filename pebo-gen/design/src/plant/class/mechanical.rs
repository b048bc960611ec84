//! Mechanical plants in Hamiltonian form.
//!
//! ```text
//! H = p' M(q)^-1 p / 2 + V(q)      q' = dH/dp = M^-1 p      p' = -dH/dq + G(q) u      z = T(q)' p
//! ```
//!
//! With v = q' the force of inertia is `-d/dq (p' M^-1 p / 2) = v' (dM/dq) v / 2`. Everything is inverted through W =
//! T' M T, which is simple where T is worth its name: `M^-1 = T W^-1 T'`, and the velocities are `v = (T' M)^-1 z = T
//! W^-1 z` (Ortega et al. 2015, Section 5.1). Where W is not simple, its inverse is not written out: formulas hold it
//! as cofactors over the determinant, and are shown in the velocities.

use std::collections::BTreeSet;

use crate::model::{Formula as WrittenFormula, Mechanical as WrittenClass};
use crate::plant::Matrix;
use crate::plant::parts::{Assumption, Formula, Output, State};
use crate::source::{Code, Diagnostic, Diagnostics, Span};
use pebo_cas::domain::zero::{Answer, decide, refute};
use pebo_cas::forms::oriented::oriented;
use pebo_cas::forms::scaled::scaled;
use pebo_cas::forms::tidy::operations;
use pebo_cas::number::rational::half;
use pebo_cas::tower::{Field, Obstacle};
use pebo_cas::{Arena, Expr, Relation, Symbol};

use super::context::{ClassContext, Expansion, Names, Proposal, Stop, singular, unresolved};
use super::shape::{self, Size};

/// A mechanical plant.
#[derive(Clone, Debug)]
pub struct Mechanical {
    /// The positions.
    pub q: Vec<Symbol>,
    /// The inertia matrix M.
    pub inertia: Matrix,
    /// The frame T: `z = T' p`.
    pub frame: Matrix,
    /// `T^-1`.
    pub inverse_frame: Matrix,
    /// `(T' M T)^-1`.
    pub inverse_metric: Matrix,
    /// The velocities `(T' M)^-1 z`.
    pub velocities: Vec<Expr>,
    /// `-T' (dV/dq - G u)`: z' without the terms that are quadratic in momenta.
    pub h: Vec<Expr>,
    /// The energy H.
    pub energy: Expr,
    /// The printed forms where the inverse of T' M T is too long to be written out.
    pub in_velocities: Option<InVelocities>,
    /// The span of T.
    pub span: Span,
}

/// Formulas in symbols for the velocities.
#[derive(Clone, Debug)]
pub struct InVelocities {
    /// The symbols, one for each position.
    pub velocities: Vec<Expr>,
    /// The energy H.
    pub energy: Expr,
    /// The rates of the momenta.
    pub rates: Vec<Expr>,
}

impl InVelocities {
    fn of(arena: &Arena, names: &Names<'_>, inertia: &Matrix, (potential, external): (Expr, &[Expr])) -> Self {
        let symbol = |q: &Symbol| arena.of_symbol(arena.generated(&format!("{}'", arena.name(*q))));
        let velocities: Vec<Expr> = names.y.iter().map(symbol).collect();
        let rates = names.y.iter().zip(external);
        let rates = rates.map(|(q, external)| arena.add(inertial(arena, inertia, *q, &velocities), *external));
        let rates = rates.collect();
        let kinetic = arena.scale(arena.dot(&velocities, &inertia.apply(arena, &velocities)), &half());
        Self { velocities, energy: arena.add(kinetic, potential), rates }
    }
}

/// The force of inertia along a position: `v' (dM/dq) v / 2`, with each pair of velocities once.
fn inertial(arena: &Arena, inertia: &Matrix, q: Symbol, v: &[Expr]) -> Expr {
    let slope = inertia.derivative(arena, q);
    let of_row = |i: usize| {
        let beside = arena.dot(&slope.rows()[i][i + 1..], &v[i + 1..]);
        let own = arena.scale(arena.mul(slope.at(i, i), v[i]), &half());
        arena.mul(v[i], arena.add(own, beside))
    };
    scaled(arena, arena.sum((0..v.len()).map(of_row)))
}

pub(super) fn expand(
    context: &ClassContext<'_>,
    written: &WrittenClass,
    names: &Names<'_>,
    problems: &mut Diagnostics,
) -> Result<Expansion<Option<Mechanical>>, Stop> {
    let (arena, facts, n) = (context.arena, &context.domain.facts, names.y.len());
    let Some(m) = &written.m else { return Err(Stop::Reported) };
    // Without a frame the momenta themselves: any will do to write the equations.
    let t = written.t.as_ref().unwrap_or(m);
    if names.x.len() != n {
        let span = context.model.x.first().map_or(m.span, |first| first.span);
        let message = format!("{} momenta in x for {n} positions in y", names.x.len());
        return Err(Diagnostic::error(Code::WrongShape, span, message)
            .help("a mechanical plant measures all its positions, and x has their momenta in the same order")
            .into());
    }
    let MechanicalEntries { inertia, forces, frame, potential } = read(context, written, names, problems)?;
    context.symmetric("M", &inertia, m.span)?;
    let open = |what: &'static str, span: Span| move |obstacle: Obstacle| Stop::from(unresolved(what, span, &obstacle));
    let transposed = frame.transpose();
    let metric = transposed.mul(arena, &inertia).mul(arena, &frame);
    let metric = metric.normal(arena, facts).map_err(open("M", m.span))?;
    let inverse_frame = frame.inverse(arena, facts).map_err(open("the inverse of T", t.span))?;
    let inverse_frame = inverse_frame.ok_or_else(|| singular("T", t.span))?;
    let inverse =
        inverse_metric(context, (&inertia, &frame), &metric, names).map_err(open("the inverse of M", m.span))?;
    let (inverse_metric, is_implicit) = inverse.ok_or_else(|| singular("M", m.span))?;
    // Not in normal form: if W is simple, the author's T is shorter.
    let velocity = frame.mul(arena, &inverse_metric);
    // det W = det(T)^2 det M: if it does not vanish, T has an inverse wherever it has a value. If the inverse of W is
    // not written out, neither is its condition: the rates have no value there.
    let (inverted, span) = if is_implicit { (&frame, t.span) } else { (&metric, m.span) };
    let conditions = nonzero_determinant(context, inverted, span)?.into_iter().collect();

    let symbols = |list: &[Symbol]| -> Vec<Expr> { list.iter().map(|s| arena.of_symbol(*s)).collect() };
    let (p, u) = (symbols(names.x), symbols(names.u));
    let z: Vec<Expr> = context.z.iter().map(|symbol| arena.of_symbol(*symbol)).collect();
    let at_p = transposed.apply(arena, &p);
    let over_one = |matrix: &Matrix, vector: &[Expr]| collected(context, matrix, vector, is_implicit);
    let on_positions = arena.symbols_of(&inverse_metric.rows().concat());
    let rates = over_one(&velocity, &at_p).map_err(open("M^-1 p", m.span))?;
    let velocities = if names.y.iter().any(|position| on_positions.contains(position)) {
        over_one(&velocity, &z).map_err(open("the velocity", m.span))?
    } else {
        velocity.apply(arena, &z)
    };
    let force = |index: usize| {
        let slope = arena.neg(arena.derivative(potential, names.y[index]));
        if u.is_empty() { slope } else { arena.add(slope, arena.dot(&forces.rows()[index], &u)) }
    };
    let external: Vec<Expr> = (0..n).map(force).collect();
    let in_velocities = is_implicit.then(|| InVelocities::of(arena, names, &inertia, (potential, &external)));
    let states = names.x.iter().enumerate().map(|(i, symbol)| State {
        symbol: *symbol,
        rate: Formula { expr: arena.add(inertial(arena, &inertia, names.y[i], &rates), external[i]), span: m.span },
    });
    let outputs = names.y.iter().zip(&context.model.y).enumerate().map(|(i, (symbol, name))| Output {
        symbol: *symbol,
        rate: Some(Formula { expr: rates[i], span: m.span }),
        value: None,
        span: name.span,
    });
    let given = written.t.is_some();
    let phi = (0..n).filter(|_| given).map(|i| Formula { expr: arena.dot(&frame.column(i), &p), span: column(t, i) });
    // T^-T = M T W^-1, where the inverse of a large T has grown out of proportion.
    let inverse = inverse_frame.transpose().apply(arena, &z);
    let product = inertia.mul(arena, &frame).mul(arena, &inverse_metric).apply(arena, &z);
    let product = (!is_implicit).then_some(product);
    let momenta = [Some(inverse), product].into_iter().flatten().flat_map(|z| names.x.iter().copied().zip(z));
    let proposal = Proposal {
        phi_left: momenta.collect(),
        rates: names.y.iter().zip(velocity.rows()).map(|(s, row)| (*s, (arena.zero(), row.clone()))).collect(),
    };
    // p' M^-1 p is z' W^-1 z.
    let of_work = [arena.dot(&p, &rates), arena.dot(&at_p, &inverse_metric.apply(arena, &at_p))];
    let doubled = if is_implicit { of_work[0] } else { shorter(arena, of_work) };
    let energy = arena.add(arena.scale(doubled, &half()), potential);
    Ok(Expansion {
        x: states.collect(),
        y: outputs.collect(),
        phi: phi.collect(),
        proposal: if given { proposal } else { Proposal::default() },
        conditions,
        // The class knows its own frame alone.
        class: given.then(|| Mechanical {
            q: names.y.to_vec(),
            h: transposed.apply(arena, &external),
            inertia,
            frame,
            inverse_frame,
            inverse_metric,
            velocities,
            energy,
            in_velocities,
            span: t.span,
        }),
    })
}

/// The entries of a mechanical plant as written, over its positions.
struct MechanicalEntries {
    inertia: Matrix,
    forces: Matrix,
    frame: Matrix,
    potential: Expr,
}

fn read(
    context: &ClassContext<'_>,
    written: &WrittenClass,
    names: &Names<'_>,
    problems: &mut Diagnostics,
) -> Result<MechanicalEntries, Stop> {
    let (arena, n) = (context.arena, names.y.len());
    let on_q: BTreeSet<Symbol> = names.y.iter().chain(names.constants).copied().collect();
    let mut matrix = |name, matrix, (height, width), diagonal, counted| {
        let size = Size { height, width, diagonal, counted };
        context.matrix(shape::WrittenMatrix { name, matrix }, size, &on_q, problems)
    };
    let inertia = matrix("M", &written.m, (n, n), true, "positions x positions");
    let forces = matrix("G", &written.g, (n, names.u.len()), false, "positions x inputs");
    let frame = match &written.t {
        Some(_) => matrix("T", &written.t, (n, n), true, "positions x positions"),
        None => Some(Matrix::identity(arena, n)),
    };
    let potential = match &written.v {
        Some(v) => problems.keep(context.formula(v, &on_q, "V(q)")),
        None => Some(arena.zero()),
    };
    match (inertia, forces, frame, potential) {
        (Some(inertia), Some(forces), Some(frame), Some(potential)) => {
            Ok(MechanicalEntries { inertia, forces, frame, potential })
        }
        _ => Err(Stop::Reported),
    }
}

/// The condition that a determinant does not vanish, where it is no number.
fn nonzero_determinant(context: &ClassContext<'_>, matrix: &Matrix, span: Span) -> Result<Option<Assumption>, Stop> {
    let determinant = matrix.determinant(context.arena, &context.domain.facts);
    let expr = determinant.map_err(|obstacle| Stop::from(unresolved("a determinant", span, &obstacle)))?;
    let is_number = context.arena.as_number(expr).is_some();
    Ok((!is_number).then_some(Assumption { expr, relation: Relation::NonZero, span }))
}

/// `L_X M = sum over k of X_k dM/dq_k + (dX)' M + M dX`: zero where M does not change along X, a Killing field of M.
pub fn change_along(arena: &Arena, m: &Matrix, field: &[Expr], q: &[Symbol]) -> Matrix {
    let n = field.len();
    let jacobian = Matrix::build(n, n, |j, k| arena.derivative(field[j], q[k]));
    let drag = m.mul(arena, &jacobian);
    let mut total = drag.add(arena, &drag.transpose());
    for (component, q) in field.iter().zip(q) {
        if !arena.is_zero(*component) {
            total = total.add(arena, &m.derivative(arena, *q).map(|e| arena.mul(*component, *e)));
        }
    }
    total
}

/// `W^-1`, and whether it is not written out; none if W has no inverse.
fn inverse_metric(
    context: &ClassContext<'_>,
    parts: (&Matrix, &Matrix),
    metric: &Matrix,
    names: &Names<'_>,
) -> Result<Option<(Matrix, bool)>, Obstacle> {
    if let Some(inverse) = implicit_inverse(context, parts, metric, names)? {
        return Ok(Some((inverse, true)));
    }
    Ok(metric.inverse(context.arena, &context.domain.facts)?.map(|inverse| (inverse, false)))
}

/// `W^-1` as cofactors over the determinant, where its normal form would be out of proportion: if a column of T is no
/// Killing field of M, so that the cascade is refused and nothing is to be proved of the inverse but that it exists.
fn implicit_inverse(
    context: &ClassContext<'_>,
    (inertia, frame): (&Matrix, &Matrix),
    metric: &Matrix,
    names: &Names<'_>,
) -> Result<Option<Matrix>, Obstacle> {
    let arena = context.arena;
    if !metric.is_long_to_invert(arena, &context.domain.facts)? {
        return Ok(None);
    }
    let changes = |column: usize| change_along(arena, inertia, &frame.column(column), names.y).entries();
    let differs = |entry: &Expr| matches!(decide(arena, *entry, context.domain), Answer::NonZero(_));
    if !(0..frame.width()).any(|column| changes(column).iter().any(differs)) {
        return Ok(None);
    }
    let (adjugate, determinant) = metric.adjugate(arena);
    let exists = refute(arena, determinant, context.domain).is_some();
    Ok(exists.then(|| adjugate.map(|cofactor| arena.div(*cofactor, determinant))))
}

/// The product with a vector, each component over one denominator where that is shorter, except for inverses that are
/// not written out.
///
/// As a product of the author's formulas it has a value wherever these have, and sums of angles are kept.
fn collected(
    context: &ClassContext<'_>,
    matrix: &Matrix,
    vector: &[Expr],
    is_implicit: bool,
) -> Result<Vec<Expr>, Obstacle> {
    let arena = context.arena;
    let products = matrix.apply(arena, vector);
    if is_implicit {
        return Ok(products);
    }
    let field = Field::of_long_sums(arena, &context.domain.facts, &products)?;
    let shortened = |product: &Expr| {
        let over_one = oriented(arena, context.domain, field.show(&field.fraction(*product)?));
        Ok(shorter(arena, [over_one, *product]))
    };
    products.iter().map(shortened).collect()
}

/// The one of two equal formulas with fewer operations, the first where they have as many.
fn shorter(arena: &Arena, [first, second]: [Expr; 2]) -> Expr {
    if operations(arena, second) < operations(arena, first) { second } else { first }
}

/// The span of T's column for a component of z: its first entry that is not zero.
fn column(written: &crate::model::Matrix, index: usize) -> Span {
    let entries = written.rows.iter().filter_map(|row| row.get(index));
    let is_zero = |f: &&WrittenFormula| matches!(&f.term, crate::model::Term::Number(n) if n.to_f64() == 0.0);
    if written.depth < 2 {
        return written.rows[0].get(index).map_or(written.span, |entry| entry.span);
    }
    entries.into_iter().find(|entry| !is_zero(entry)).map_or(written.span, |entry| entry.span)
}

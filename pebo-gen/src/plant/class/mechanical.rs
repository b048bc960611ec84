//! Mechanical plants in Hamiltonian form.
//!
//! ```text
//! H = p' M(q)^-1 p / 2 + V(q)      q' = dH/dp = M^-1 p      p' = -dH/dq + G(q) u      z = T(q)' p
//! ```
//!
//! With v = q' the force of inertia is `-d/dq (p' M^-1 p / 2) = v' (dM/dq) v / 2`. Everything is inverted
//! through W = T' M T, which is simple where T is worth its name: `M^-1 = T W^-1 T'`, and the velocities
//! are `v = (T' M)^-1 z = T W^-1 z` (Ortega et al. 2015, Section 5.1).

use std::collections::BTreeSet;

use crate::cas::facts::Relation;
use crate::cas::field::{Field, Obstacle};
use crate::cas::oriented::oriented;
use crate::cas::rational::half;
use crate::cas::{Expr, Symbol};
use crate::model::{Formula as Written, Mechanical as WrittenClass};
use crate::plant::Matrix;
use crate::plant::matrix::dot;
use crate::plant::plant::{Assumption, Formula, Output, State};
use crate::source::{Code, Diagnostic, Diagnostics, Span};

use super::shape::{self, Size};
use super::{Class, Expansion, Names, Place, Proposal, Stop, singular, unresolved};

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
    /// `-T' (dV/dq - G u)`: what z' is if the terms that are quadratic in momenta vanish.
    pub h: Vec<Expr>,
    /// The energy H.
    pub energy: Expr,
    /// Where T stands.
    pub span: Span,
}

pub(super) fn expand(
    place: &Place<'_>,
    written: &WrittenClass<Written>,
    names: &Names<'_>,
    problems: &mut Diagnostics,
) -> Result<Expansion, Stop> {
    let (arena, facts) = (place.arena, &place.domain.facts);
    let n = names.y.len();
    let (Some(m), Some(t)) = (&written.m, &written.t) else { return Err(Stop::Reported) };
    if names.x.len() != n {
        let span = place.model.x.first().map_or(m.span, |first| first.span);
        let message = format!("{} momenta in x for {n} positions in y", names.x.len());
        return Err(Diagnostic::error(Code::WrongShape, span, message)
            .help("a mechanical plant measures all its positions, and x has their momenta in the same order")
            .into());
    }
    let on_q: BTreeSet<Symbol> = names.y.iter().chain(names.constants).copied().collect();
    let mut read = |name, matrix, (height, width), diagonal, counted| {
        let size = Size { height, width, diagonal, counted };
        place.matrix(shape::Written { name, matrix }, size, &on_q, problems)
    };
    let inertia = read("M", &written.m, (n, n), true, "positions x positions");
    let forces = read("G", &written.g, (n, names.u.len()), false, "positions x inputs");
    let frame = read("T", &written.t, (n, n), true, "positions x positions");
    let potential = match &written.v {
        Some(v) => problems.keep(place.formula(v, &on_q, "V(q)")),
        None => Some(arena.zero()),
    };
    let (Some(inertia), Some(forces), Some(frame), Some(potential)) = (inertia, forces, frame, potential) else {
        return Err(Stop::Reported);
    };
    place.symmetric("M", &inertia, m.span)?;
    let open = |what: &'static str, span: Span| move |obstacle: Obstacle| Stop::from(unresolved(what, span, &obstacle));
    let transposed = frame.transpose();
    let metric = transposed.mul(arena, &inertia).mul(arena, &frame);
    let metric = metric.normal(arena, facts).map_err(open("M", m.span))?;
    let inverse_frame = frame.inverse(arena, facts).map_err(open("the inverse of T", t.span))?;
    let inverse_frame = inverse_frame.ok_or_else(|| singular("T", t.span))?;
    let inverse_metric = metric.inverse(arena, facts).map_err(open("the inverse of M", m.span))?;
    let inverse_metric = inverse_metric.ok_or_else(|| singular("M", m.span))?;
    // Not in normal form: where W is simple, what the author wrote for T is shorter.
    let velocity = frame.mul(arena, &inverse_metric);
    let mut conditions = Vec::new();
    for (matrix, span) in [(&frame, t.span), (&metric, m.span)] {
        let determinant = matrix.determinant(arena, facts).map_err(open("a determinant", span))?;
        if arena.as_number(determinant).is_none() {
            conditions.push(Assumption { expr: determinant, relation: Relation::NonZero, span });
        }
    }

    let symbols = |list: &[Symbol]| -> Vec<Expr> { list.iter().map(|s| arena.of_symbol(*s)).collect() };
    let (p, u) = (symbols(names.x), symbols(names.u));
    let z: Vec<Expr> = place.z.iter().map(|symbol| arena.of_symbol(*symbol)).collect();
    let rates = collected(place, &velocity.mul(arena, &transposed), &p).map_err(open("M^-1 p", m.span))?;
    let velocities = collected(place, &velocity, &z).map_err(open("the velocity", m.span))?;
    let force = |index: usize| {
        let slope = arena.neg(arena.derivative(potential, names.y[index]));
        if u.is_empty() { slope } else { arena.add(slope, dot(arena, &forces.rows()[index], &u)) }
    };
    let inertial = |index: usize| {
        let slope = inertia.derivative(arena, names.y[index]);
        arena.scale(dot(arena, &rates, &slope.apply(arena, &rates)), &half())
    };
    let external: Vec<Expr> = (0..n).map(force).collect();
    let states = names.x.iter().enumerate().map(|(i, symbol)| State {
        symbol: *symbol,
        rate: Formula { expr: arena.add(inertial(i), external[i]), span: m.span },
    });
    let outputs = names.y.iter().zip(&place.model.y).enumerate().map(|(i, (symbol, name))| Output {
        symbol: *symbol,
        rate: Some(Formula { expr: rates[i], span: m.span }),
        value: None,
        span: name.span,
    });
    let phi = (0..n).map(|i| Formula { expr: dot(arena, &frame.column(i), &p), span: column(t, i) });
    // T^-T = M T W^-1, where the inverse of a large T has grown out of proportion.
    let inverse = inverse_frame.transpose().apply(arena, &z);
    let product = inertia.mul(arena, &frame).mul(arena, &inverse_metric).apply(arena, &z);
    let momenta = [inverse, product].into_iter().flat_map(|z| names.x.iter().copied().zip(z));
    let proposal = Proposal {
        phi_left: momenta.collect(),
        rates: names.y.iter().zip(velocity.rows()).map(|(s, row)| (*s, (arena.zero(), row.clone()))).collect(),
    };
    let energy = arena.add(arena.scale(dot(arena, &p, &rates), &half()), potential);
    Ok(Expansion {
        x: states.collect(),
        y: outputs.collect(),
        phi: phi.collect(),
        proposal,
        conditions,
        class: Some(Class::Mechanical(Mechanical {
            q: names.y.to_vec(),
            h: transposed.apply(arena, &external),
            inertia,
            frame,
            inverse_frame,
            inverse_metric,
            velocities,
            energy,
            span: t.span,
        })),
    })
}

/// The product with a vector, each component over one denominator.
fn collected(place: &Place<'_>, matrix: &Matrix, vector: &[Expr]) -> Result<Vec<Expr>, Obstacle> {
    let products = matrix.apply(place.arena, vector);
    let field = Field::over(place.arena, &place.domain.facts, &products)?;
    let over_one = |e: &Expr| Ok(oriented(place.arena, place.domain, field.show(&field.fraction(*e)?)));
    products.iter().map(over_one).collect()
}

/// Where the column of T stands that a component of z is made of: its first entry that is not zero.
fn column(written: &crate::model::Matrix<Written>, index: usize) -> Span {
    let entries = written.rows.iter().filter_map(|row| row.get(index));
    let is_zero = |f: &&Written| matches!(&f.term, crate::model::Term::Number(n) if n.to_f64() == 0.0);
    if written.depth < 2 {
        return written.rows[0].get(index).map_or(written.span, |entry| entry.span);
    }
    entries.into_iter().find(|entry| !is_zero(entry)).map_or(written.span, |entry| entry.span)
}

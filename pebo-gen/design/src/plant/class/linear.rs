//! Linear plants: `x' = A11 x + A12 y + B1 u`, `y' = A21 x + A22 y + B2 u`.
//!
//! A linear transform z = T1 x + T2 y moves by known signals exactly if `T1 A11 + T2 A21 = 0`, and has a left inverse
//! exactly if T1 has rank `n_x`. Rows of T1 that form an invertible square block may be combined to T1 = I, so the
//! problem is to solve `A11 + T2 A21 = 0`: the rows of A11 have to be combinations of those of A21 (Ortega et al. 2015,
//! Section 4, eq. 19).

use crate::model::{Lti, Model};
use crate::plant::Matrix;
use crate::source::{Code, Diagnostic, Diagnostics, Span};
use pebo_cas::linear::solve_each;
use pebo_cas::poly::Poly;
use pebo_cas::tower::{Field, Obstacle};
use pebo_cas::{Expr, Relation, Symbol};

use super::context::{ClassContext, Expansion, Names, Proposal, Stop, unresolved};
use super::shape::{self, Size};
use crate::plant::parts::{Assumption, Formula, Output, State};

/// A linear plant.
#[derive(Clone, Debug)]
pub struct Linear {
    /// The action of the unmeasured states on themselves.
    pub a11: Matrix,
    /// Their action on the outputs.
    pub a21: Matrix,
    /// The transform: `z = T1 x + T2 y`.
    pub t1: Matrix,
    /// See [`Self::t1`].
    pub t2: Matrix,
    /// True if T1 and T2 are the author's.
    pub given: bool,
    /// The parameters whose values make ranks of A11 and A21 others than in general: the values were written in.
    pub special: Vec<Symbol>,
    /// Rows of A11 that are no combination of rows of A21: no transform exists if there is one.
    pub unsolved: Vec<usize>,
    /// The span of A11.
    pub span: Span,
}

/// States up to which T2 is written by minors: there are twice as many of them with each further row, and every claim
/// goes through all of them.
const MOST_BY_MINORS: usize = 6;

/// The number of components of the transform: with one of the author's there may be more of them than states.
pub(super) fn components(written: &Lti, model: &Model) -> usize {
    match &written.t1 {
        Some(t1) if t1.depth == 2 => t1.rows.len(),
        Some(t1) if t1.depth == 1 && model.x.len() == 1 => t1.rows[0].len(),
        _ => model.x.len(),
    }
}

pub(super) fn expand(
    context: &ClassContext<'_>,
    written: &Lti,
    names: &Names<'_>,
    problems: &mut Diagnostics,
) -> Result<Expansion<Linear>, Stop> {
    let arena = context.arena;
    if let (None, Some(alone)) = (&written.t1, &written.t2) {
        return Err(Diagnostic::error(Code::MissingKey, alone.span, "T2 is given without T1")
            .help("give T1 as well, or leave both out to have them derived")
            .into());
    }
    let (nx, ny, nu) = (names.x.len(), names.y.len(), names.u.len());
    let mut read = |name, matrix, (height, width), counted| {
        let size = Size { height, width, diagonal: false, counted };
        context.matrix(shape::WrittenMatrix { name, matrix }, size, names.constants, problems)
    };
    let a11 = read("A11", &written.a11, (nx, nx), "states x states");
    let a12 = read("A12", &written.a12, (nx, ny), "states x outputs");
    let a21 = read("A21", &written.a21, (ny, nx), "outputs x states");
    let a22 = read("A22", &written.a22, (ny, ny), "outputs x outputs");
    let b1 = read("B1", &written.b1, (nx, nu), "states x inputs");
    let b2 = read("B2", &written.b2, (ny, nu), "outputs x inputs");
    let nz = components(written, context.model);
    let t1 = read("T1", &written.t1, (nz, nx), "components x states");
    let t2 = read("T2", &written.t2, (nz, ny), "components x outputs");
    let (Some(mut a11), Some(a12), Some(mut a21), Some(a22), Some(b1), Some(b2), Some(t1), Some(t2)) =
        (a11, a12, a21, a22, b1, b2, t1, t2)
    else {
        return Err(Stop::Reported);
    };
    let (Some(first), Some(second)) = (&written.a11, &written.a21) else { return Err(Stop::Reported) };
    let facts = &context.domain.facts;
    let open = |obstacle: Obstacle| Stop::from(unresolved("the transform", first.span, &obstacle));
    // Values of the parameters at which ranks differ from the generic ones are inserted: the rest holds for these
    // values alone.
    let valued = |matrix: &Matrix| matrix.map(|entry| arena.substitute(*entry, &context.domain.fixed));
    let ranks = |a11: &Matrix, a21: &Matrix| -> Result<[usize; 2], Obstacle> {
        let both = Matrix::new(a11.rows().iter().chain(a21.rows()).cloned().collect());
        Ok([a21.rank(arena, facts)?, both.rank(arena, facts)?])
    };
    let special = [valued(&a11), valued(&a21)];
    let blocks = [a12, a22, b1, b2, t1, t2];
    let valued_symbols = arena.symbols_of(&[a11.entries(), a21.entries()].concat());
    let differ = ranks(&a11, &a21).map_err(open)? != ranks(&special[0], &special[1]).map_err(open)?;
    let [a12, a22, b1, b2, t1, t2] = if differ {
        [a11, a21] = special;
        blocks.each_ref().map(valued)
    } else {
        blocks
    };
    let special = if differ {
        valued_symbols.into_iter().filter(|s| context.domain.fixed.contains_key(s)).collect()
    } else {
        Vec::new()
    };
    let given = written.t1.is_some();
    let few = !given && nx == ny && nx <= MOST_BY_MINORS;
    let is_long = few && a21.is_long_to_invert(arena, facts).map_err(open)?;
    let nonzero = |expr: Expr| Assumption { expr, relation: Relation::NonZero, span: first.span };
    let (t1, t2, unsolved, conditions) = if given {
        let conditions = denominators(context, &t2).map_err(open)?;
        (t1, t2, Vec::new(), conditions)
    } else if is_long && a21.rank(arena, facts).map_err(open)? == nx {
        let (t2, determinant) = by_cofactors(context, &a11, &a21);
        (Matrix::identity(arena, nx), t2, Vec::new(), vec![determinant])
    } else {
        let (t2, unsolved) = transform(context, &a11, &a21).map_err(open)?;
        let conditions = denominators(context, &t2).map_err(open)?;
        (Matrix::identity(arena, nx), t2, unsolved, conditions)
    };
    let conditions = conditions.into_iter().map(nonzero).collect();
    let symbols = |list: &[pebo_cas::Symbol]| -> Vec<Expr> { list.iter().map(|s| arena.of_symbol(*s)).collect() };
    let (x, y, u) = (symbols(names.x), symbols(names.y), symbols(names.u));
    let rate = |row: usize, [a, b, c]: [&Matrix; 3]| {
        let driven = if u.is_empty() { arena.zero() } else { arena.dot(&c.rows()[row], &u) };
        arena.sum([arena.dot(&a.rows()[row], &x), arena.dot(&b.rows()[row], &y), driven])
    };
    let span = |matrix: &crate::model::Matrix, row: usize| match matrix.rows.get(row) {
        Some(entries) => entries[0].span.to(entries[entries.len() - 1].span),
        None => matrix.span,
    };
    let states = names.x.iter().enumerate().map(|(i, symbol)| State {
        symbol: *symbol,
        rate: Formula { expr: rate(i, [&a11, &a12, &b1]), span: span(first, i) },
    });
    let outputs = names.y.iter().zip(&context.model.y).enumerate().map(|(i, (symbol, name))| Output {
        symbol: *symbol,
        rate: Some(Formula { expr: rate(i, [&a21, &a22, &b2]), span: span(second, i) }),
        value: None,
        span: name.span,
    });
    let phi = (0..nz).map(|i| Formula {
        expr: arena.add(arena.dot(&t1.rows()[i], &x), arena.dot(&t2.rows()[i], &y)),
        span: span(written.t1.as_ref().unwrap_or(first), i),
    });
    let proposal = propose(context, [&t1, &t2], [&a21, &a22, &b2], names, is_long).map_err(open)?;
    Ok(Expansion {
        x: states.collect(),
        y: outputs.collect(),
        phi: phi.collect(),
        proposal,
        conditions,
        class: Linear { a11, a21, t1, t2, given, special, unsolved, span: first.span },
    })
}

/// T2 with `A11 + T2 A21 = 0`, zero in the rows that have no solution, and these.
fn transform(context: &ClassContext<'_>, a11: &Matrix, a21: &Matrix) -> Result<(Matrix, Vec<usize>), Obstacle> {
    let arena = context.arena;
    let entries = [a11.entries(), a21.entries()].concat();
    let field = Field::over(arena, &context.domain.facts, &entries)?;
    // A21' T2' = -A11', a right side for each row of A11.
    let mut system = Vec::new();
    for column in 0..a11.height() {
        let left = a21.column(column).into_iter().map(|e| field.fraction(e));
        let right = a11.column(column).into_iter().map(|e| Ok(field.fraction(e)?.opposite()));
        system.push(left.chain(right).collect::<Result<Vec<_>, _>>()?);
    }
    let mut unsolved = Vec::new();
    let mut rows = Vec::new();
    for (index, solution) in
        solve_each(&field, pebo_cas::linear::Matrix::new(system), a21.height())?.into_iter().enumerate()
    {
        if let Some(solution) = solution {
            rows.push(field.show_all(&solution));
        } else {
            unsolved.push(index);
            rows.push(vec![arena.zero(); a21.height()]);
        }
    }
    Ok((Matrix::new(rows), unsolved))
}

/// `T2 = -A11 adj(A21) / det(A21)` and the determinant, which is not zero: as expressions that share their minors,
/// where their normal forms are too long to be written out.
fn by_cofactors(context: &ClassContext<'_>, a11: &Matrix, a21: &Matrix) -> (Matrix, Expr) {
    let arena = context.arena;
    let (adjugate, determinant) = a21.adjugate(arena);
    let over_determinant = |entry: &Expr| arena.neg(arena.div(*entry, determinant));
    (a11.mul(arena, &adjugate).map(over_determinant), determinant)
}

/// Expressions that must not vanish for the entries to have values: at their zeros the generic rank falls.
fn denominators(context: &ClassContext<'_>, matrix: &Matrix) -> Result<Vec<Expr>, Obstacle> {
    let arena = context.arena;
    let field = Field::over(arena, &context.domain.facts, &matrix.entries())?;
    let mut found_denominators: Vec<Poly> = Vec::new();
    let mut found: Vec<Expr> = Vec::new();
    for entry in matrix.entries() {
        let fraction = field.fraction(entry)?;
        // Entries have few different ones: showing a long one takes longer than comparing it.
        if found_denominators.contains(fraction.denominator()) {
            continue;
        }
        found_denominators.push(fraction.denominator().clone());
        let below = field.show(&field.of_polynomial(fraction.denominator())?);
        if arena.as_number(below).is_none() && !found.contains(&below) {
            found.push(below);
        }
    }
    Ok(found)
}

/// `x = T1^+ (z - T2 y)` with `T1^+ = (T1' T1)^-1 T1'`, and the regression of claim C3: `y' = (A22 - A21 T1^+ T2) y +
/// B2 u + A21 T1^+ z`. If T2 is too long for normal forms, so are the products with it.
fn propose(
    context: &ClassContext<'_>,
    [t1, t2]: [&Matrix; 2],
    [a21, a22, b2]: [&Matrix; 3],
    names: &Names<'_>,
    is_long: bool,
) -> Result<Proposal, Obstacle> {
    let (arena, facts) = (context.arena, &context.domain.facts);
    let transposed = t1.transpose();
    let Some(gram) = transposed.mul(arena, t1).inverse(arena, facts)? else { return Ok(Proposal::default()) };
    let left = gram.mul(arena, &transposed).normal(arena, facts)?;
    let minus = |matrix: &Matrix| matrix.map(|entry| arena.neg(*entry));
    let short = |matrix: Matrix| if is_long { Ok(matrix) } else { matrix.normal(arena, facts) };
    let on_y = short(minus(&left.mul(arena, t2)))?;
    let factors = a21.mul(arena, &left).normal(arena, facts)?;
    let rest = short(a22.add(arena, &a21.mul(arena, &on_y)))?;
    let symbols = |list: &[pebo_cas::Symbol]| -> Vec<Expr> { list.iter().map(|s| arena.of_symbol(*s)).collect() };
    let (y, u) = (symbols(names.y), symbols(names.u));
    let z = symbols(context.z);
    let states = names
        .x
        .iter()
        .enumerate()
        .map(|(i, symbol)| (*symbol, arena.add(arena.dot(&left.rows()[i], &z), arena.dot(&on_y.rows()[i], &y))));
    let rates = names.y.iter().enumerate().map(|(i, symbol)| {
        let driven = if u.is_empty() { arena.zero() } else { arena.dot(&b2.rows()[i], &u) };
        (*symbol, (arena.add(arena.dot(&rest.rows()[i], &y), driven), factors.rows()[i].clone()))
    });
    Ok(Proposal { phi_left: states.collect(), rates: rates.collect() })
}

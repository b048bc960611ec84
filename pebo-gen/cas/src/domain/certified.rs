//! Finds points of equations that no formula solves, and proves that they exist.
//!
//! In: equations, and values of their symbols to start from. Out: values at which all equations hold, near the start:
//! as many symbols as there are equations have a value known by an enclosure, the others a rational one. A solution is
//! approached by Newton's method in floating point and refined with many digits. It exists by the operator of Krawczyk
//! (1969): with `Y` close to the inverse of the Jacobian matrix `J`, the equations `F = 0` have exactly one solution in
//! the box `x + [-r, r]` if
//!
//! ```text
//! |Y F(x)| + |1 - Y J(box)| r < r
//! ```

use std::collections::BTreeMap;
use std::convert::Infallible;

use crate::Rational;
use crate::graph::arena::Arena;
use crate::graph::enclosure::Point;
use crate::graph::expr::{Expr, Symbol};
use crate::linear::elimination::{PlacedRow, Reach, by_columns, eliminate};
use crate::number::interval::{Interval, Precision};

/// Steps of Newton's method in floating point: from afar it halves the error, then doubles the digits.
const MOST_STEPS: usize = 40;

/// A step of this size relative to the values is the last in floating point, whose rounding is some 1e-16.
const SMALL_STEP: f64 = 1e-13;

/// A pivot of this size relative to the greatest has no digit that rounding and the last step leave.
const SMALL_PIVOT: f64 = 1e-9;

/// Bits of the refinement, and those that the box's radius leaves of them: ranks are proved with as many.
const PRECISION: u32 = 320;
const DIGITS: i32 = 256;

/// Bits that a step with the inverse in floating point surely adds.
const BITS_A_STEP: u32 = 24;

/// The width of an equation's values over the box, relative to what its slopes explain: terms that cancel and interval
/// arithmetic widen it, a jump makes it that of the jump.
const MOST_CHANGE: f64 = 1e12;

/// `2^41 + 1`: it leaves 12 of the 53 bits of a rational value, as short ones keep what is computed with them short.
const ROUNDING: f64 = 2_199_023_255_553.0;

/// Equations without a formula for a solution.
#[derive(Clone, Debug, Default)]
pub(crate) struct System {
    equations: Vec<Expr>,
    symbols: Vec<Symbol>,
    /// Row by row.
    jacobian: Vec<Expr>,
}

impl System {
    /// None if there are more equations than symbols: they are not independent.
    pub(crate) fn new(arena: &Arena, equations: Vec<Expr>) -> Option<Self> {
        let symbols: Vec<Symbol> = arena.symbols_of(&equations).into_iter().collect();
        if symbols.len() < equations.len() {
            return None;
        }
        let jacobian = equations.iter().flat_map(|e| symbols.iter().map(|symbol| arena.derivative(*e, *symbol)));
        Some(Self { jacobian: jacobian.collect(), symbols, equations })
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.equations.is_empty()
    }

    /// Moves a point that has rational values of all symbols onto the equations; none if no solution is found near it.
    pub(crate) fn complete(&self, arena: &Arena, point: &mut Point) -> Option<()> {
        let start: Vec<Expr> = self.symbols.iter().map(|symbol| point.get(symbol).copied()).collect::<Option<_>>()?;
        let problem = [self.equations.as_slice(), &start].concat();
        let solution = arena.solution(problem, || self.solve_near(arena, &start))?;
        point.extend(self.symbols.iter().copied().zip(solution));
        for equation in &self.equations {
            arena.satisfies(arena.substitute(*equation, point));
        }
        Some(())
    }

    /// The values of all symbols at a solution near these.
    fn solve_near(&self, arena: &Arena, start: &[Expr]) -> Option<Vec<Expr>> {
        let start: Vec<f64> = start.iter().map(|e| Some(arena.as_number(*e)?.to_f64())).collect::<Option<_>>()?;
        let scale: Vec<f64> = start.iter().map(|v| if *v == 0.0 { 1.0 } else { v.abs() }).collect();
        let near = self.approach(arena, start, (&scale, None))?;
        let dependent = self.dependent(arena, &near, &scale)?;
        // The others have short values, and the dependent ones follow.
        let is_dependent = |place: &usize| dependent.contains(place);
        let shortened = near.iter().enumerate().map(|(i, v)| if is_dependent(&i) { *v } else { short(*v) });
        let near = self.approach(arena, shortened.collect(), (&scale, Some(&dependent)))?;
        let solution = self.proved(arena, &near, (&scale, &dependent))?;
        let exact = |place: usize| match dependent.iter().position(|other| *other == place) {
            Some(unknown) => Some(arena.located(solution[unknown].clone())),
            None => Some(arena.number(Rational::from_f64_exact(near[place])?)),
        };
        (0..near.len()).map(exact).collect()
    }

    /// Newton's method: the least change of all values, relative to a scale, or of the dependent ones alone.
    fn approach(
        &self,
        arena: &Arena,
        mut at: Vec<f64>,
        (scale, dependent): (&[f64], Option<&[usize]>),
    ) -> Option<Vec<f64>> {
        let count = self.equations.len();
        for _ in 0..MOST_STEPS {
            let (residual, slopes) = self.in_floating_point(arena, &at)?;
            let moves = |j: usize| dependent.is_none_or(|dependent| dependent.contains(&j));
            // J S with the scale S of the values that move.
            let scaled: Vec<Vec<f64>> = slopes
                .iter()
                .map(|row| row.iter().enumerate().map(|(j, s)| if moves(j) { s * scale[j] } else { 0.0 }).collect())
                .collect();
            let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
            let gram = (0..count).map(|i| (0..count).map(|k| dot(&scaled[i], &scaled[k])).collect()).collect();
            let inverse = inverse(gram)?;
            let weights: Vec<f64> = inverse.iter().map(|row| dot(row, &residual)).collect();
            let steps: Vec<f64> =
                (0..at.len()).map(|j| (0..count).map(|i| scaled[i][j] * weights[i]).sum::<f64>()).collect();
            let size = steps.iter().fold(0.0_f64, |most, step| most.max(step.abs()));
            if !size.is_finite() {
                return None;
            }
            for (j, step) in steps.iter().enumerate() {
                at[j] -= scale[j] * step;
            }
            if size < SMALL_STEP {
                return Some(at);
            }
        }
        None
    }

    /// Symbols, one for each equation, in which the equations are independent.
    fn dependent(&self, arena: &Arena, at: &[f64], scale: &[f64]) -> Option<Vec<usize>> {
        let (_, mut rows) = self.in_floating_point(arena, at)?;
        for row in &mut rows {
            row.iter_mut().zip(scale).for_each(|(slope, scale)| *slope *= scale);
        }
        let greatest = rows.iter().flatten().fold(0.0_f64, |most, slope| most.max(slope.abs()));
        let choose = |rest: &[PlacedRow<f64>]| {
            let entries =
                rest.iter().enumerate().flat_map(|(i, (_, row))| row.iter().enumerate().map(move |(j, s)| (i, j, s)));
            let (i, j, pivot) = entries.max_by(|(_, _, a), (_, _, b)| a.abs().total_cmp(&b.abs()))?;
            (pivot.abs() > SMALL_PIVOT * greatest).then_some((i, j))
        };
        let clear = |other: &mut [f64], row: &[f64], column: usize| {
            subtract(other, other[column] / row[column], row);
            other[column] = 0.0;
            Ok::<_, Infallible>(())
        };
        let Ok(found) = eliminate(rows, Reach::Below, choose, |row, _| Ok(row), clear);
        found.rest.is_empty().then(|| found.pivots.iter().map(|pivot| pivot.column).collect())
    }

    /// Enclosures of the dependent values, in each of which a solution was proved.
    fn proved(&self, arena: &Arena, near: &[f64], (scale, dependent): (&[f64], &[usize])) -> Option<Vec<Interval>> {
        let (_, slopes) = self.in_floating_point(arena, near)?;
        let inverse = inverse(slopes.iter().map(|row| dependent.iter().map(|j| row[*j]).collect()).collect())?;
        let mut at: Vec<Rational> = near.iter().map(|v| Rational::from_f64_exact(*v)).collect::<Option<_>>()?;
        let mut bits = 2 * BITS_A_STEP;
        while bits < PRECISION {
            bits += BITS_A_STEP;
            let residual = self.residual(arena, &at, Precision::new(bits + 64))?;
            for (row, j) in inverse.iter().zip(dependent) {
                let step: f64 = row.iter().zip(&residual).map(|(y, f)| y * f64::midpoint(f.lo(), f.hi())).sum();
                at[*j] = &at[*j] - &Rational::from_f64_exact(step)?;
            }
        }
        let p = Precision::new(PRECISION);
        let exact = |value: &Rational| Interval::from_rational(value, p);
        let radius = |j: &usize| Some(&Rational::from(2).pow(-DIGITS)? * &Rational::from_f64_exact(scale[*j])?);
        let radii: Vec<Rational> = dependent.iter().map(radius).collect::<Option<_>>()?;
        let mut values: Vec<Interval> = at.iter().map(exact).collect::<Option<_>>()?;
        for (radius, j) in radii.iter().zip(dependent) {
            values[*j] = exact(&(&at[*j] - radius))?.hull(&exact(&(&at[*j] + radius))?);
        }
        let residual = self.residual(arena, &at, p)?;
        let slopes = self.enclosed(arena, &self.jacobian, &values, p)?;
        let slope = |k: usize, unknown: usize| &slopes[k * self.symbols.len() + dependent[unknown]];
        // Slopes say nothing of a function that jumps within the box, where its enclosure is wide.
        let whole = self.enclosed(arena, &self.equations, &values, p)?;
        for (k, value) in whole.iter().enumerate() {
            let size = |slope: &Interval| slope.lo().abs().max(slope.hi().abs());
            let change: f64 = radii.iter().enumerate().map(|(j, radius)| size(slope(k, j)) * radius.to_f64()).sum();
            if value.width() > MOST_CHANGE * change {
                return None;
            }
        }
        for (i, row) in inverse.iter().enumerate() {
            let row: Vec<Interval> =
                row.iter().map(|y| exact(&Rational::from_f64_exact(*y)?)).collect::<Option<_>>()?;
            let along = |column: &dyn Fn(usize) -> Interval| {
                row.iter()
                    .enumerate()
                    .try_fold(exact(&Rational::ZERO)?, |sum, (k, y)| sum.add(&y.mul(&column(k), p)?, p))
            };
            let mut reach = along(&|k| residual[k].clone())?.abs();
            for (unknown, radius) in radii.iter().enumerate() {
                let one = if unknown == i { Rational::ONE } else { Rational::ZERO };
                let contraction = exact(&one)?.sub(&along(&|k| slope(k, unknown).clone())?, p)?;
                reach = reach.add(&contraction.abs().mul(&exact(radius)?, p)?, p)?;
            }
            if !reach.sub(&exact(&radii[i])?, p)?.is_negative() {
                return None;
            }
        }
        Some(dependent.iter().map(|j| values[*j].clone()).collect())
    }

    fn residual(&self, arena: &Arena, at: &[Rational], p: Precision) -> Option<Vec<Interval>> {
        let values: Vec<Interval> = at.iter().map(|v| Interval::from_rational(v, p)).collect::<Option<_>>()?;
        self.enclosed(arena, &self.equations, &values, p)
    }

    fn enclosed(&self, arena: &Arena, exprs: &[Expr], values: &[Interval], p: Precision) -> Option<Vec<Interval>> {
        let values: BTreeMap<Symbol, Interval> = self.symbols.iter().copied().zip(values.iter().cloned()).collect();
        arena.enclose_over(exprs, &values, p)
    }

    /// The equations' values, and the rows of their Jacobian matrix.
    fn in_floating_point(&self, arena: &Arena, at: &[f64]) -> Option<(Vec<f64>, Vec<Vec<f64>>)> {
        let p = Precision::new(64);
        let exact = |value: &f64| Interval::from_rational(&Rational::from_f64_exact(*value)?, p);
        let values: Vec<Interval> = at.iter().map(exact).collect::<Option<_>>()?;
        let all = [self.equations.as_slice(), &self.jacobian].concat();
        let middle = |value: &Interval| f64::midpoint(value.lo(), value.hi());
        let all: Vec<f64> = self.enclosed(arena, &all, &values, p)?.iter().map(middle).collect();
        let (residual, slopes) = all.split_at(self.equations.len());
        Some((residual.to_vec(), slopes.chunks(self.symbols.len()).map(<[f64]>::to_vec).collect()))
    }
}

/// The value to a few bits: rounded by a sum with a multiple of itself (Veltkamp 1968).
fn short(value: f64) -> f64 {
    let multiple = value * ROUNDING;
    let rounded = multiple - (multiple - value);
    if rounded.is_finite() { rounded } else { value }
}

/// The inverse of a square matrix by elimination with pivots; none if a pivot is lost in rounding.
fn inverse(mut rows: Vec<Vec<f64>>) -> Option<Vec<Vec<f64>>> {
    let size = rows.len();
    for (i, row) in rows.iter_mut().enumerate() {
        row.extend((0..size).map(|j| if i == j { 1.0 } else { 0.0 }));
    }
    let largest = |rest: &[PlacedRow<f64>], column: usize| {
        let sizes = rest.iter().map(|(_, row)| row[column].abs()).enumerate();
        let (index, size) = sizes.max_by(|(_, a), (_, b)| a.total_cmp(b))?;
        (size != 0.0 && size.is_finite()).then_some(index)
    };
    let over = |row: Vec<f64>, column: usize| Ok(row.iter().map(|entry| entry / row[column]).collect());
    let clear = |other: &mut [f64], row: &[f64], column: usize| {
        subtract(other, other[column], row);
        Ok::<_, Infallible>(())
    };
    let Ok(found) = eliminate(rows, Reach::All, by_columns(size, largest), over, clear);
    found.rest.is_empty().then(|| found.pivots.into_iter().map(|mut pivot| pivot.row.split_off(size)).collect())
}

/// `row - factor * other`
fn subtract(row: &mut [f64], factor: f64, other: &[f64]) {
    row.iter_mut().zip(other).for_each(|(entry, other)| *entry -= factor * other);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Function;

    fn completed(arena: &Arena, equations: Vec<Expr>, start: &[(Expr, i64)]) -> Option<Point> {
        let start = start.iter().filter_map(|(e, v)| Some((arena.as_symbol(*e)?, arena.number(*v))));
        let mut point: Point = start.collect();
        System::new(arena, equations)?.complete(arena, &mut point)?;
        Some(point)
    }

    #[test]
    fn solutions_are_enclosed_and_hold() {
        let arena = Arena::new();
        let [a, b, c] = ["a", "b", "c"].map(|name| arena.variable(name));
        let square = |e| arena.mul(e, e);
        let size = arena.add(square(a), square(b));
        let limacon = arena.sub(square(arena.sub(size, a)), arena.scale(size, &4.into()));
        let wave = arena.sub(arena.call(Function::Exp, &[c]), arena.add(a, c));
        for (equations, start) in [
            (vec![limacon], vec![(a, 1), (b, 2)]),
            (vec![limacon, wave], vec![(a, 3), (b, 2), (c, 1)]),
            (vec![arena.sub(square(square(a)), arena.number(2))], vec![(a, 1)]),
        ] {
            let point = completed(&arena, equations.clone(), &start).expect("a solution");
            for equation in &equations {
                let value = arena.enclose(*equation, &point, Precision::new(256)).unwrap();
                assert!(value.contains_zero() && value.width() < 1e-70, "{value}");
                assert!(arena.separated_from_zero(*equation, &point).is_none());
            }
            let other = arena.add(equations[0], arena.number(Rational::new(1, 1_i64 << 60).unwrap()));
            assert!(arena.separated_from_zero(other, &point).is_some());
            assert!(arena.symbols_of(&point.values().copied().collect::<Vec<_>>()).is_empty());
        }
    }

    #[test]
    fn nothing_is_proved_where_equations_touch_or_exclude_one_another() {
        let arena = Arena::new();
        let [a, b] = ["a", "b"].map(|name| arena.variable(name));
        let square = |e| arena.mul(e, e);
        // A function that jumps over zero.
        let step = arena.add(a, arena.call(Function::Sign, &[a]));
        assert!(completed(&arena, vec![arena.sub(step, arena.mul(b, b))], &[(a, 0), (b, 0)]).is_none());
        // A double root, a dependent pair, no real solution.
        let line = arena.sub(a, b);
        for equations in [
            vec![square(arena.sub(a, arena.number(2)))],
            vec![line, arena.scale(line, &2.into())],
            vec![arena.add(square(square(a)), arena.one())],
        ] {
            assert!(completed(&arena, equations, &[(a, 3), (b, 1)]).is_none());
        }
    }
}

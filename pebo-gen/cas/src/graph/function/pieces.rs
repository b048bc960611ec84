//! Functions given by a table: polynomials between knots, in the arguments of a call.
//!
//! In: the arguments `s, order, degree, knots, coefficients`. The piece from a knot on has `degree + 1` coefficients, of
//! the powers of the distance from it, the lowest first; the last one is affine, and before the first knot the first one
//! is continued by its value and slope. The value is the derivative of that order by `s`. All but `s` are numbers: so
//! are they in each expression that is built from a call.

use std::cmp::Ordering;

use super::formulas::Conditions;
use super::kind::Function;
use crate::graph::arena::Arena;
use crate::graph::expr::{Expr, Node};
use crate::number::interval::{Interval, Precision};
use crate::{Rational, Relation};

/// The arguments before the knots.
const BEFORE: usize = 3;

/// A table of exact numbers, and the order of the derivative that is meant.
#[derive(Clone, PartialEq, Eq, Hash, Debug)]
pub struct Pieces {
    /// The order of the derivative.
    pub order: usize,
    /// Where the pieces begin, in ascending order.
    pub knots: Vec<Rational>,
    /// The coefficients of each piece.
    pub coefficients: Vec<Vec<Rational>>,
}

impl Pieces {
    /// The table of a call, with its argument.
    pub fn of(arena: &Arena, expr: Expr) -> Option<(Self, Expr)> {
        let Node::Call(Function::Table, arguments) = arena.node(expr) else { return None };
        let numbers: Option<Vec<Rational>> = arguments[1..].iter().map(|number| arena.as_number(*number)).collect();
        Some((Self::of_numbers(&numbers?)?, arguments[0]))
    }

    /// From the arguments but the first.
    fn of_numbers(numbers: &[Rational]) -> Option<Self> {
        let count = |number: &Rational| number.to_i64().and_then(|number| usize::try_from(number).ok());
        let ([order, degree], rest) = numbers.split_first_chunk::<2>()?;
        let (order, degree) = (count(order)?, count(degree)?);
        let knots = rest.len() / (degree + 2);
        let (knots, coefficients) = rest.split_at_checked(knots)?;
        let coefficients = coefficients.chunks(degree + 1).map(<[Rational]>::to_vec).collect();
        Some(Self { order, knots: knots.to_vec(), coefficients })
    }

    /// The numbers that a table has in common with its derivatives.
    fn numbers(&self) -> Vec<Rational> {
        self.knots.iter().chain(self.coefficients.iter().flatten()).cloned().collect()
    }

    /// The call of the table at an argument.
    pub fn call(&self, arena: &Arena, argument: Expr) -> Expr {
        let count = |count: usize| arena.number(i64::try_from(count).unwrap_or(i64::MAX));
        let degree = self.coefficients.first().map_or(0, |piece| piece.len().saturating_sub(1));
        let mut arguments = vec![argument, count(self.order), count(degree)];
        arguments.extend(self.numbers().into_iter().map(|number| arena.number(number)));
        arena.call(Function::Table, &arguments)
    }

    /// The coefficients of the derivative on a piece: 0 before the first knot, then from each knot on.
    pub fn piece(&self, piece: usize) -> Vec<Rational> {
        let own = &self.coefficients[piece.saturating_sub(1)];
        let most = if piece == 0 { own.len().min(2) } else { own.len() };
        let falling =
            |power: usize| (0..self.order).map(|down| whole(power - down)).fold(Rational::ONE, |a, b| &a * &b);
        (self.order..most).map(|power| &own[power] * &falling(power)).collect()
    }

    /// The knot from which the distance on a piece counts.
    pub fn knot(&self, piece: usize) -> &Rational {
        &self.knots[piece.saturating_sub(1)]
    }

    /// The value on a piece, as a polynomial in the argument.
    pub fn branch(&self, arena: &Arena, piece: usize, argument: Expr) -> Expr {
        let distance = arena.sub(argument, arena.number(self.knot(piece).clone()));
        let powers = self.piece(piece).into_iter().enumerate().map(|(power, coefficient)| {
            let power = i64::try_from(power).unwrap_or(i64::MAX);
            arena.scale(arena.power(distance, &Rational::from(power)), &coefficient)
        });
        arena.sum(powers)
    }

    /// The knots where two different polynomials meet; with their derivatives up to an order equal, if `smooth` says so.
    pub fn meeting(&self, smooth: Option<usize>) -> Vec<Rational> {
        let differs = |at: usize| {
            let ahead = self.piece(at + 1);
            let mut behind = self.piece(at);
            let shift = if at == 0 { Rational::ZERO } else { &self.knots[at] - &self.knots[at - 1] };
            shifted(&mut behind, &shift);
            let most = smooth.map_or(behind.len().max(ahead.len()), |order| order + 1);
            let part = |piece: &[Rational], power: usize| piece.get(power).cloned().unwrap_or(Rational::ZERO);
            (0..most).any(|power| part(&behind, power) != part(&ahead, power))
        };
        (0..self.knots.len()).filter(|at| differs(*at)).map(|at| self.knots[at].clone()).collect()
    }

    /// Bounds of the values, where there are some.
    pub fn range(&self) -> Option<(Rational, Rational)> {
        let mut bounds: Vec<Rational> = Vec::new();
        for piece in 0..=self.knots.len() {
            let polynomial = self.piece(piece);
            match (piece, self.knots.get(piece)) {
                (1.., Some(end)) => bounds.extend(extremes(&polynomial, &(end - self.knot(piece)))),
                _ if polynomial[1.min(polynomial.len())..].iter().any(|slope| !slope.is_zero()) => return None,
                _ => bounds.push(polynomial.first().cloned().unwrap_or(Rational::ZERO)),
            }
        }
        Some((bounds.iter().min()?.clone(), bounds.iter().max()?.clone()))
    }
}

impl Arena {
    /// Names a table, unless it has a name.
    pub fn name_table(&self, table: &Pieces, name: &str) {
        self.table_names().borrow_mut().entry(table.numbers()).or_insert_with(|| name.to_owned());
    }

    /// The name of a table as a function: the author's, and that of its slope, or of a further derivative by its order.
    pub fn table_name(&self, table: &Pieces) -> String {
        let names = self.table_names().borrow();
        let name = names.get(&table.numbers()).map_or("table", String::as_str);
        format!("{name}{}", suffix(table.order))
    }
}

/// A table of numbers in floating point.
#[derive(Clone, Debug)]
pub struct FloatTable {
    order: usize,
    knots: Vec<f64>,
    coefficients: Vec<Vec<f64>>,
}

impl FloatTable {
    /// The nearest numbers of a table.
    pub fn of(table: &Pieces) -> Self {
        let row = |row: &Vec<Rational>| row.iter().map(Rational::to_f64).collect::<Vec<f64>>();
        Self {
            order: table.order,
            knots: table.knots.iter().map(Rational::to_f64).collect(),
            coefficients: table.coefficients.iter().map(row).collect(),
        }
    }

    /// The value.
    pub fn value(&self, argument: f64) -> f64 {
        at(self.order, &self.knots, |piece| &self.coefficients[piece], argument)
    }
}

/// The value at rational arguments.
pub(super) fn rational(arguments: &[Rational]) -> Option<Rational> {
    let table = Pieces::of_numbers(&arguments[1..])?;
    let argument = &arguments[0];
    let piece = table.knots.partition_point(|knot| knot <= argument);
    let distance = argument - table.knot(piece);
    Some(table.piece(piece).iter().rev().fold(Rational::ZERO, |value, own| &(&value * &distance) + own))
}

/// The value in floating point.
pub(super) fn value(arguments: &[f64]) -> f64 {
    let Some((&[argument, order, degree], rest)) = arguments.split_first_chunk::<BEFORE>() else { return f64::NAN };
    let count = |number: f64| (0..=rest.len()).find(|count| approx(*count) >= number).unwrap_or(0);
    let (order, degree) = (count(order), count(degree));
    let (knots, coefficients) = rest.split_at(rest.len() / (degree + 2));
    at(order, knots, |piece| &coefficients[piece * (degree + 1)..(piece + 1) * (degree + 1)], argument)
}

/// The derivative of that order of a table with these knots and coefficients.
fn at<'a>(order: usize, knots: &[f64], coefficients: impl Fn(usize) -> &'a [f64], argument: f64) -> f64 {
    let piece = knots.iter().take_while(|knot| **knot <= argument).count();
    let own = coefficients(piece.saturating_sub(1));
    let most = if piece == 0 { own.len().min(2) } else { own.len() };
    let factor = |power: usize| (0..order).map(|down| approx(power - down)).product::<f64>();
    let terms = (order..most).rev().map(|power| own[power] * factor(power));
    let distance = argument - knots[piece.saturating_sub(1)];
    terms.fold(0.0, |value, own| value * distance + own)
}

/// An enclosure of the values over an interval of arguments.
pub(super) fn enclosure(arguments: &[Interval], p: Precision) -> Option<Interval> {
    let ([argument, order, degree], rest) = arguments.split_first_chunk::<BEFORE>()?;
    let count = |number: &Interval| (0..=rest.len()).find(|count| approx(*count) >= number.lo());
    let (order, degree) = (count(order)?, count(degree)?);
    let (knots, coefficients) = rest.split_at(rest.len() / (degree + 2));
    let mut total: Option<Interval> = None;
    for piece in 0..=knots.len() {
        let (from, to) = (piece.checked_sub(1).map(|at| &knots[at]), knots.get(piece));
        let is_beside =
            from.is_some_and(|from| argument.hi() < from.lo()) || to.is_some_and(|to| argument.lo() > to.hi());
        if is_beside {
            continue;
        }
        let mut own = argument.clone();
        own = from.map_or(own.clone(), |from| own.max(from));
        own = to.map_or(own.clone(), |to| own.min(to));
        let distance = own.sub(from.unwrap_or(&knots[0]), p)?;
        let first = piece.saturating_sub(1) * (degree + 1);
        let most = if piece == 0 { degree.min(1) } else { degree };
        let mut value = Interval::from_rational(&Rational::ZERO, p)?;
        for power in (order..=most).rev() {
            let factor = (0..order).map(|down| whole(power - down)).fold(Rational::ONE, |a, b| &a * &b);
            let coefficient = coefficients[first + power].mul(&Interval::from_rational(&factor, p)?, p)?;
            value = value.mul(&distance, p)?.add(&coefficient, p)?;
        }
        total = Some(total.map_or(value.clone(), |total| total.hull(&value)));
    }
    total
}

/// The derivative by the argument, and zeros by the numbers.
pub(super) fn derivative(arena: &Arena, arguments: &[Expr]) -> Vec<Expr> {
    let mut next = arguments.to_vec();
    next[1] = arena.add(arguments[1], arena.one());
    let is_constant = arena.as_number(next[1]) > arena.as_number(arguments[2]);
    let slope = if is_constant { arena.zero() } else { arena.call(Function::Table, &next) };
    std::iter::once(slope).chain(std::iter::repeat_n(arena.zero(), arguments.len() - 1)).collect()
}

/// A value: where it jumps, there is none to proofs.
pub(super) fn conditions(arena: &Arena, arguments: &[Expr]) -> Conditions {
    apart_from_knots(arena, arguments, 0)
}

/// A derivative.
pub(super) fn smooth(arena: &Arena, arguments: &[Expr]) -> Conditions {
    apart_from_knots(arena, arguments, 1)
}

fn apart_from_knots(arena: &Arena, arguments: &[Expr], order: usize) -> Conditions {
    let call = arena.call(Function::Table, arguments);
    let Some((table, argument)) = Pieces::of(arena, call) else { return Conditions::new() };
    let away = |knot: Rational| (arena.sub(argument, arena.number(knot)), Relation::NonZero);
    table.meeting(Some(order)).into_iter().map(away).collect()
}

/// Moves a polynomial, so that it counts from that far on.
fn shifted(polynomial: &mut [Rational], by: &Rational) {
    for done in 0..polynomial.len() {
        for power in (done..polynomial.len().saturating_sub(1)).rev() {
            let carried = &polynomial[power + 1] * by;
            polynomial[power] = &polynomial[power] + &carried;
        }
    }
}

/// Numbers between which the values of a polynomial on `[0, width]` are: its extremes, or else its coefficients in
/// Bernstein's form.
fn extremes(polynomial: &[Rational], width: &Rational) -> Vec<Rational> {
    let at = |place: &Rational| polynomial.iter().rev().fold(Rational::ZERO, |value, own| &(&value * place) + own);
    let mut found = vec![at(&Rational::ZERO), at(width)];
    let slope: Vec<Rational> = polynomial.iter().enumerate().skip(1).map(|(power, own)| own * &whole(power)).collect();
    if let [level, steepness] = slope.as_slice() {
        let place = level.checked_div(steepness).map(|place| -&place);
        found.extend(place.filter(|place| place.signum() > 0 && place < width).map(|place| at(&place)));
    } else if slope.len() > 2 {
        let bounds = extremes(&slope, width);
        let is_monotone = [1, -1].iter().any(|sign| bounds.iter().all(|bound| bound.signum() * sign >= 0));
        if !is_monotone {
            found.extend(bernstein(polynomial, width));
        }
    }
    found
}

/// The coefficients of a polynomial on `[0, width]` in Bernstein's form: its values are between them.
fn bernstein(polynomial: &[Rational], width: &Rational) -> Vec<Rational> {
    let degree = polynomial.len().saturating_sub(1);
    let choose = |n: usize, k: usize| {
        (0..k).fold(Rational::ONE, |value, at| {
            let next = &value * &whole(n - at);
            next.checked_div(&whole(at + 1)).unwrap_or(next)
        })
    };
    let mut scaled = Vec::with_capacity(polynomial.len());
    let mut power = Rational::ONE;
    for coefficient in polynomial {
        scaled.push(coefficient * &power);
        power = &power * width;
    }
    let entry = |at: usize| {
        (0..=at).fold(Rational::ZERO, |sum, power| {
            let share = (&choose(at, power) * &scaled[power]).checked_div(&choose(degree, power));
            &sum + &share.unwrap_or(Rational::ZERO)
        })
    };
    (0..polynomial.len()).map(entry).collect()
}

fn whole(count: usize) -> Rational {
    Rational::from(i64::try_from(count).unwrap_or(i64::MAX))
}

#[expect(clippy::cast_precision_loss, reason = "tables have few points")]
fn approx(count: usize) -> f64 {
    count as f64
}

/// What the name of a table's derivative of that order ends with: `ocv_slope`, `ocv_slope2`.
pub fn suffix(order: usize) -> String {
    match order {
        0 => String::new(),
        1 => SLOPE.to_owned(),
        _ => format!("{SLOPE}{order}"),
    }
}

/// The end of the name of a table's slope.
const SLOPE: &str = "_slope";

/// A monotone table through points with ascending arguments: a cubic between neighbours whose slopes at the points keep
/// it monotone wherever the values are (Fritsch and Carlson 1980; the slopes are those of Fritsch and Butland 1984, and
/// at the ends three-point ones), or a line. Beyond the first and the last point it goes on with the slope there.
pub fn through(points: &[(Rational, Rational)], is_cubic: bool) -> Option<Pieces> {
    let gaps: Vec<Rational> = points.windows(2).map(|pair| &pair[1].0 - &pair[0].0).collect();
    if points.len() < 2 || gaps.iter().any(|gap| gap.signum() <= 0) {
        return None;
    }
    let chords: Vec<Rational> = points
        .windows(2)
        .zip(&gaps)
        .map(|(pair, gap)| (&pair[1].1 - &pair[0].1).checked_div(gap))
        .collect::<Option<_>>()?;
    let mut coefficients = Vec::with_capacity(points.len());
    let slopes = if is_cubic { slopes(&gaps, &chords)? } else { Vec::new() };
    for (at, (gap, chord)) in gaps.iter().zip(&chords).enumerate() {
        let value = points[at].1.clone();
        coefficients.push(if is_cubic {
            let (here, next) = (&slopes[at], &slopes[at + 1]);
            let three = &(chord + chord) + chord;
            let square = (&(&three - &(here + here)) - next).checked_div(gap)?;
            let cube = (&(here + next) - &(chord + chord)).checked_div(&(gap * gap))?;
            vec![value, here.clone(), square, cube]
        } else {
            vec![value, chord.clone()]
        });
    }
    let last = slopes.last().or(chords.last())?.clone();
    let mut beyond = vec![points.last()?.1.clone(), last];
    beyond.resize(if is_cubic { 4 } else { 2 }, Rational::ZERO);
    coefficients.push(beyond);
    Some(Pieces { order: 0, knots: points.iter().map(|point| point.0.clone()).collect(), coefficients })
}

/// The slopes of a cubic at its points.
fn slopes(gaps: &[Rational], chords: &[Rational]) -> Option<Vec<Rational>> {
    let (Some(first), Some(last)) = (chords.first(), chords.last()) else { return None };
    if chords.len() == 1 {
        return Some(vec![first.clone(), last.clone()]);
    }
    let (end, n) = (chords.len() - 1, gaps.len());
    let mut found = vec![one_sided((&gaps[0], first), (&gaps[1], &chords[1]))?];
    for at in 1..n {
        let (before, after) = (&chords[at - 1], &chords[at]);
        found.push(if before.signum() * after.signum() <= 0 {
            Rational::ZERO
        } else {
            let (short, long) = (&gaps[at - 1], &gaps[at]);
            let (w1, w2) = (&(long + long) + short, &(short + short) + long);
            let mean = &w1.checked_div(before)? + &w2.checked_div(after)?;
            (&w1 + &w2).checked_div(&mean)?
        });
    }
    found.push(one_sided((&gaps[end], last), (&gaps[end - 1], &chords[end - 1]))?);
    Some(found)
}

/// The slope at an end, by its own gap and chord and the next ones: that of a parabola, kept monotone.
fn one_sided((gap, chord): (&Rational, &Rational), (next, other): (&Rational, &Rational)) -> Option<Rational> {
    let parabola = (&(&(&(gap + gap) + next) * chord) - &(gap * other)).checked_div(&(gap + next))?;
    let three = &(chord + chord) + chord;
    if parabola.signum() != chord.signum() {
        return Some(Rational::ZERO);
    }
    let is_steep = parabola.abs().cmp(&three.abs()) == Ordering::Greater;
    Some(if chord.signum() != other.signum() && is_steep { three } else { parabola })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::graph::enclosure::Point;
    use crate::{Domain, Facts};

    const CELL: [(&str, &str); 5] = [("0", "3"), ("0.1", "3.4"), ("0.5", "3.6"), ("0.9", "3.9"), ("1", "4.2")];

    fn decimal(text: &str) -> Rational {
        Rational::from_decimal(text).expect(text)
    }

    fn table(points: &[(&str, &str)], is_cubic: bool) -> Pieces {
        let points: Vec<_> = points.iter().map(|(s, value)| (decimal(s), decimal(value))).collect();
        through(&points, is_cubic).expect("a table")
    }

    fn at(table: &Pieces, s: &str) -> Rational {
        let arena = Arena::new();
        arena.as_number(table.call(&arena, arena.number(decimal(s)))).expect("a number")
    }

    /// Values and slopes as `SciPy` 1.16 has them (`PchipInterpolator`).
    #[test]
    fn a_cubic_is_the_usual_one_and_goes_on_with_its_slopes() {
        let cubic = table(&CELL, true);
        let slope = Pieces { order: 1, ..cubic.clone() };
        for (s, value) in CELL {
            assert_eq!(at(&cubic, s), decimal(value), "{s}");
        }
        for (s, value, own) in [
            ("0.05", 3.245_592_105_263_158, 4.561_842_105_263_157),
            ("0.3", 3.522_631_578_947_369, 0.336_842_105_263_158),
            ("0.95", 4.023_920_454_545_454, 3.296_590_909_090_909),
            // Beyond the ends.
            ("-1", 3.0 - 4.7, 4.7),
            ("3", 4.2 + 2.0 * 3.45, 3.45),
        ] {
            // Twelve digits: the library rounds each step.
            assert!((at(&cubic, s).to_f64() - value).abs() < 1e-12, "{s}: {}", at(&cubic, s).to_f64());
            assert!((at(&slope, s).to_f64() - own).abs() < 1e-12, "{s}: {}", at(&slope, s).to_f64());
        }
        // Monotone data have a slope above zero; a hill has a level top.
        assert!(slope.range().expect("bounds").0.signum() > 0);
        assert_eq!(at(&Pieces { order: 1, ..table(&[("0", "0"), ("1", "1"), ("2", "0")], true) }, "1"), Rational::ZERO);
        assert!(through(&[(decimal("1"), decimal("0")), (decimal("1"), decimal("2"))], true).is_none());
    }

    #[test]
    fn derivatives_are_those_of_the_pieces_and_know_where_they_jump() {
        let arena = Arena::new();
        let s = arena.variable("s");
        let symbol = arena.as_symbol(s).expect("a symbol");
        let (cubic, linear) = (table(&CELL, true), table(&CELL, false));
        arena.name_table(&cubic, "ocv");
        let call = cubic.call(&arena, s);
        let slope = arena.derivative(call, symbol);
        assert_eq!((arena.print(call), arena.print(slope)), ("ocv(s)".to_owned(), "ocv_slope(s)".to_owned()));
        let (table_of_slope, argument) = Pieces::of(&arena, slope).expect("a table");
        assert_eq!((table_of_slope.order, argument), (1, s));
        let third = arena.derivative(arena.derivative(slope, symbol), symbol);
        assert_eq!(arena.print(third), "ocv_slope3(s)");
        assert!(arena.is_zero(arena.derivative(third, symbol)));
        // A cubic has a slope everywhere, and its slope none at the points; lines have none at theirs.
        assert!(arena.operation_conditions(call, crate::graph::conditions::Regularity::Differentiable).is_empty());
        let knots = |call: Expr, regularity| arena.operation_conditions(call, regularity).len();
        assert_eq!(knots(slope, crate::graph::conditions::Regularity::Differentiable), 5);
        assert_eq!(knots(linear.call(&arena, s), crate::graph::conditions::Regularity::Defined), 0);
        assert_eq!(knots(linear.call(&arena, s), crate::graph::conditions::Regularity::Differentiable), 3);
    }

    #[test]
    fn values_are_those_of_the_branches_and_within_their_enclosures() {
        let arena = Arena::new();
        let s = arena.variable("s");
        let symbol = arena.as_symbol(s).expect("a symbol");
        for (base, order) in
            [(table(&CELL, true), 0), (table(&CELL, true), 1), (table(&CELL, true), 2), (table(&CELL, false), 0)]
        {
            let table = Pieces { order, ..base };
            let call = table.call(&arena, s);
            let domain = Domain { facts: Facts::new(), ..Domain::default() };
            let cells = domain.cells(&arena, &[call], |_| true).expect("cells");
            assert_eq!(cells.len(), table.meeting(None).len() + 1);
            for text in ["-0.5", "0.03", "0.2", "0.73", "0.97", "1.5"] {
                let place = arena.number(decimal(text));
                let exact = at(&table, text);
                let point = Point::from([(symbol, place)]);
                let value = arena.enclose(call, &point, Precision::new(64)).expect("a value");
                assert!(
                    (FloatTable::of(&table).value(decimal(text).to_f64()) - exact.to_f64()).abs() < 1e-12,
                    "{text}"
                );
                // An enclosure of 64 bits, printed in double precision.
                assert!(!value.excludes(&exact) && value.width() < 1e-12, "{text}");
                let inside = cells.iter().filter(|cell| {
                    let holds = |(divider, side): &(Expr, crate::domain::cells::Side)| {
                        let positive = arena.substitute(side.positive(&arena, *divider), &point);
                        arena.as_number(positive).is_some_and(|number| number.signum() > 0)
                    };
                    cell.sides.iter().all(holds)
                });
                let branches: Vec<Expr> = inside.map(|cell| cell.domain.analytic(&arena, &[call])[0]).collect();
                let values: Vec<Rational> =
                    branches.iter().filter_map(|branch| arena.as_number(arena.substitute(*branch, &point))).collect();
                assert_eq!(values, [exact], "{text}");
            }
            // Over an interval the enclosure has the values at both ends.
            let wide = Interval::from_rational(&decimal("0.05"), Precision::new(64)).expect("a number");
            let wide = wide.hull(&Interval::from_rational(&decimal("0.95"), Precision::new(64)).expect("a number"));
            let over = arena.enclose_over(&[call], &[(symbol, wide)].into(), Precision::new(64)).expect("values");
            assert!(["0.05", "0.3", "0.95"].iter().all(|text| !over[0].excludes(&at(&table, text))));
        }
    }
}

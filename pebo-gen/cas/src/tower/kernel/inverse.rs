//! Inverse trigonometric functions as kernels, and the linear relations among them.
//!
//! In: `asin`, `acos`, `atan` or `atan2` of arguments in normal form. Out: a combination of earlier angles, if there is
//! one, else a kernel. The equality of `a = asin(t)` and `b = atan(t/sqrt(1 - t^2))` is proved in two steps: the sine
//! of a - b is 0 and its cosine is 1, so that a - b is a multiple of 2 pi; and both ranges lie within a half circle, so
//! that it is zero. The same two steps prove `asin(sin(w)) = w` if the facts keep w on the principal branch.

use crate::Rational;
use crate::graph::expr::{Expr, Node};
use crate::graph::function::Function;
use crate::number::interval::Precision;
use crate::number::rational::half;

use super::range::{InverseAngle, Pair, Range};
use crate::tower::fraction::Fraction;
use crate::tower::{Field, Obstacle};

/// Angles that a new one is compared with.
const MOST_ANGLES: usize = 8;

/// The largest multiple of pi/12 in a relation: two full turns.
const MOST_TWELFTHS: i32 = 48;

/// `own * new = sum of share * known + twelfths * pi/12`
struct Guess {
    own: i32,
    shares: Vec<(usize, i32)>,
    twelfths: i32,
}

impl Field<'_> {
    /// An inverse trigonometric function at arguments whose normal form is known.
    pub(in crate::tower) fn inverse_function(&self, expr: Expr) -> Result<Fraction, Obstacle> {
        let call = self.tidy_call(expr)?;
        if let Some(number) = self.round.kernels.borrow().number_of(call) {
            return Ok(Fraction::polynomial(crate::poly::Poly::variable(number)));
        }
        if let Some(angle) = self.angle_inside(expr)? {
            return Ok(angle);
        }
        let (Some(pair), Node::Call(function, arguments)) = (self.pair_of(expr)?, self.arena.node(expr)) else {
            return Ok(self.entered(call, None, false));
        };
        let range = self.range_of_inverse(function, &arguments)?;
        let known = self.known_angles()?;
        for guess in self.guesses(call, &known) {
            if self.holds(&guess, &pair, &range, &known)? {
                let mut total = self.scale(&self.fraction(self.arena.pi())?, &ratio(guess.twelfths, 12))?;
                for (index, share) in &guess.shares {
                    total = self.add(&total, &self.scale(&known[*index].value, &Rational::from(i64::from(*share)))?)?;
                }
                return self.scale(&total, &ratio(1, guess.own));
            }
        }
        if let Some(value) = self.arena.as_number(call) {
            return Ok(Fraction::constant(&value));
        }
        let value = self.entered(call, None, false);
        self.round.inverses.borrow_mut().push(InverseAngle { value: value.clone(), pair, range });
        Ok(value)
    }

    /// The angle whose sine, cosine or tangent the argument is, on the principal branch.
    fn angle_inside(&self, expr: Expr) -> Result<Option<Fraction>, Obstacle> {
        let Node::Call(function, arguments) = self.arena.node(expr) else { return Ok(None) };
        let argument = self.fraction(arguments[0])?;
        let angles = self.round.angles.borrow().clone();
        for (value, (sin, cos)) in angles {
            let fits = match function {
                Function::Asin => argument == sin,
                Function::Acos => argument == cos,
                Function::Atan => self.sub(&sin, &self.mul(&argument, &cos)?)?.is_zero(),
                _ => false,
            };
            if fits && self.range_of_angle(&value)?.is_some_and(|range| range.is_principal(function)) {
                return Ok(Some(value));
            }
        }
        Ok(None)
    }

    /// Remembers an angle with its sine and cosine.
    pub(in crate::tower) fn remember_angle(&self, value: &Fraction, pair: &Pair) {
        let mut angles = self.round.angles.borrow_mut();
        if angles.len() < MOST_ANGLES
            && value.to_constant().is_none()
            && !angles.iter().any(|(known, _)| known == value)
        {
            angles.push((value.clone(), pair.clone()));
        }
    }

    /// The earlier angles with known ranges.
    fn known_angles(&self) -> Result<Vec<InverseAngle>, Obstacle> {
        let mut known: Vec<InverseAngle> = self.round.inverses.borrow().iter().take(MOST_ANGLES).cloned().collect();
        let angles = self.round.angles.borrow().clone();
        for (value, pair) in angles {
            if let Some(range) = self.range_of_angle(&value)? {
                known.push(InverseAngle { value, pair, range });
            }
        }
        Ok(known)
    }

    /// Combinations that fit at two points of the domain, the simplest first.
    fn guesses(&self, call: Expr, known: &[InverseAngle]) -> Vec<Guess> {
        let exprs: Vec<Expr> = [call].into_iter().chain(known.iter().map(|k| self.show(&k.value))).collect();
        let samples: Vec<Vec<f64>> = {
            let precision = Precision::new(64);
            let points = self.domain.points(self.arena, &exprs);
            let values = points.take(40).filter_map(|point| self.arena.enclose_all(&exprs, &point, precision));
            values.take(2).map(|row| row.iter().map(|value| f64::midpoint(value.lo(), value.hi())).collect()).collect()
        };
        let [first, second] = samples.as_slice() else { return Vec::new() };
        let mut shares: Vec<Vec<(usize, i32)>> = vec![Vec::new()];
        for i in 0..known.len() {
            shares.extend([1, -1, 2, -2, 3, -3, 4, -4].map(|s| vec![(i, s)]));
        }
        for i in 0..known.len() {
            for j in i + 1..known.len() {
                for s in [1, -1] {
                    shares.extend([1, -1].map(|t| vec![(i, s), (j, t)]));
                }
            }
        }
        let mut guesses = Vec::new();
        for shares in shares {
            for own in [1, 2] {
                let twelfths = |sample: &[f64]| {
                    let sum: f64 = shares.iter().map(|(index, share)| sample[index + 1] * f64::from(*share)).sum();
                    (sample[0] * f64::from(own) - sum) * 12.0 / std::f64::consts::PI
                };
                let (a, b) = (twelfths(first), twelfths(second));
                // Only a guess: its consequences are proved.
                let near = |number: &i32| [a, b].iter().all(|value| (value - f64::from(*number)).abs() < 1e-9);
                if let Some(twelfths) = (-MOST_TWELFTHS..=MOST_TWELFTHS).find(near) {
                    guesses.push(Guess { own, shares: shares.clone(), twelfths });
                }
            }
        }
        guesses
    }

    /// True if the guess is an identity.
    fn holds(&self, guess: &Guess, pair: &Pair, range: &Range, known: &[InverseAngle]) -> Result<bool, Obstacle> {
        let mut total = self.repeated(pair, u64::from(guess.own.unsigned_abs()))?;
        let mut within = range.times(i64::from(guess.own));
        let opposite = |(sin, cos): Pair| (sin.opposite(), cos);
        for (index, share) in &guess.shares {
            let other = self.repeated(&known[*index].pair, u64::from(share.unsigned_abs()))?;
            total = self.sum_of_angles(&total, &if *share > 0 { opposite(other) } else { other })?;
            within = within.plus(&known[*index].range.times(-i64::from(*share)));
        }
        total = self.sum_of_angles(&total, &self.multiple_of_pi(&ratio(-guess.twelfths, 12))?)?;
        within = within.plus(&Range::point(ratio(-guess.twelfths, 12)));
        Ok(within.is_within_turn() && total.0.is_zero() && total.1.is_one())
    }

    /// Sine and cosine of an inverse trigonometric function.
    pub(in crate::tower) fn pair_of(&self, expr: Expr) -> Result<Option<Pair>, Obstacle> {
        let Node::Call(function, arguments) = self.arena.node(expr) else { return Ok(None) };
        if !matches!(function, Function::Asin | Function::Acos | Function::Atan | Function::Atan2) {
            return Ok(None);
        }
        let a = self.fraction(arguments[0])?;
        let complement = |a: &Fraction| -> Result<Fraction, Obstacle> {
            self.root(&self.sub(&Fraction::one(), &self.pow(a, 2)?)?, &half())
        };
        Ok(Some(match function {
            Function::Asin => (a.clone(), complement(&a)?),
            Function::Acos => (complement(&a)?, a),
            _ => {
                let b = match arguments.get(1) {
                    Some(argument) => self.fraction(*argument)?,
                    None => Fraction::one(),
                };
                let radius = self.root(&self.add(&self.pow(&a, 2)?, &self.pow(&b, 2)?)?, &half())?;
                (self.div(&a, &radius)?, self.div(&b, &radius)?)
            }
        }))
    }
}

fn ratio(n: i32, d: i32) -> Rational {
    Rational::new(i64::from(n), i64::from(d)).unwrap_or(Rational::ZERO)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Arena, Facts};

    #[test]
    fn half_an_angle_is_determined_only_within_a_half_turn() {
        let arena = Arena::new();
        let q = arena.variable("q");
        let [sin, cos] = [Function::Sin, Function::Cos].map(|function| arena.call(function, &[q]));
        let field = Field::over(&arena, &Facts::new(), &[sin, cos]).unwrap();
        let pair = (field.fraction(sin).unwrap(), field.fraction(cos).unwrap());
        let half = |range: &Range| field.half_of(&pair, range).unwrap();
        let right = Range::right_half();
        assert!(half(&right).is_some());
        assert!(half(&right.times(2)).is_none(), "at half a turn the sine of the half is no quotient by its cosine");
        // From 0 to a half turn the half has a sine of its own.
        let (half_sin, half_cos) = half(&right.plus(&Range::point(ratio(1, 2)))).unwrap();
        let squares = field.add(&field.pow(&half_sin, 2).unwrap(), &field.pow(&half_cos, 2).unwrap()).unwrap();
        assert!(squares.is_one());
    }

    #[test]
    fn angles_with_the_same_sine_and_cosine_may_differ_by_a_turn() {
        let arena = Arena::new();
        let field = Field::over(&arena, &Facts::new(), &[]).unwrap();
        let half_turn = (Fraction::zero(), Fraction::one().opposite());
        let guess = Guess { own: 1, shares: Vec::new(), twelfths: 12 };
        let is_half_turn = |n: i32| field.holds(&guess, &half_turn, &Range::point(ratio(n, 1)), &[]).unwrap();
        assert!(is_half_turn(1) && !is_half_turn(-1) && !is_half_turn(3));
    }
}

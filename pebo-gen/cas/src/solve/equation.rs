//! An equation, and the inverses that take more than the table of functions: of powers and of a sine beside a cosine.

use crate::graph::function::{Function, Parity};
use crate::tower::{Field, Obstacle};
use crate::{Arena, Domain, Expr, Rational, Relation};

/// `formula = value`.
#[derive(Clone, Copy, Debug)]
pub struct Equation {
    /// The side that depends on the unknowns.
    pub formula: Expr,
    /// The other side.
    pub value: Expr,
}

/// An equation inverted.
pub(super) struct Inverse {
    /// The inner equation.
    pub(super) equation: Equation,
    /// False if it has another value too: a root or an inverse cosine of the other sign.
    pub(super) is_unique: bool,
}

impl Inverse {
    /// The only one.
    pub(super) fn unique(equation: Equation) -> Self {
        Self { equation, is_unique: true }
    }
}

/// `base = value^(1/exponent)`: the positive root unless the base is known to be negative.
pub(super) fn unpower(arena: &Arena, domain: &Domain, base: Expr, exponent: &Rational, value: Expr) -> Option<Inverse> {
    let unique = |value| Some(Inverse::unique(Equation { formula: base, value }));
    if exponent.is_one() {
        return unique(value);
    }
    let root = arena.power(value, &exponent.recip()?);
    let is_even = exponent.is_integer() && exponent.numerator().trailing_zeros() > 0;
    if !is_even {
        return unique(root);
    }
    let field = Field::over(arena, &domain.facts, &[base]).ok()?;
    let fraction = field.fraction(base).ok()?;
    if field.signs().is_positive(&fraction.opposite()).ok()? {
        return unique(arena.neg(root));
    }
    let is_unique = field.signs().is_not_negative(&fraction).ok()?;
    Some(Inverse { equation: Equation { formula: base, value: root }, is_unique })
}

/// `inside = inverse(value)`: of an even function the negative of that where the argument is known to be negative.
pub(super) fn uncall(arena: &Arena, domain: &Domain, function: Function, inside: Expr, value: Expr) -> Option<Inverse> {
    let row = function.row();
    let principal = arena.call(row.inverse?, &[value]);
    let of = |value| Equation { formula: inside, value };
    if row.parity != Some(Parity::Even) {
        return Some(Inverse::unique(of(principal)));
    }
    if domain.implies(arena, arena.neg(inside), Relation::NonNegative) {
        return Some(Inverse::unique(of(arena.neg(principal))));
    }
    let is_unique = domain.implies(arena, inside, Relation::NonNegative);
    Some(Inverse { equation: of(principal), is_unique })
}

/// The angle with this sine and cosine, a common positive denominator left out.
pub(super) fn angle_of(arena: &Arena, domain: &Domain, sin: Expr, cos: Expr) -> Expr {
    let scaled = || -> Result<Option<[Expr; 2]>, Obstacle> {
        let field = Field::over(arena, &domain.facts, &[sin, cos])?;
        let (y, x) = (field.fraction(sin)?, field.fraction(cos)?);
        let common = y.denominator().lcm(x.denominator(), field.limit())?;
        let common = field.of_polynomial(&common)?;
        if !field.signs().is_positive(&common)? {
            return Ok(None);
        }
        if common.is_one() {
            return Ok(None);
        }
        Ok(Some([field.show(&field.mul(&y, &common)?), field.show(&field.mul(&x, &common)?)]))
    };
    let arguments = scaled().ok().flatten().unwrap_or([sin, cos]);
    arena.call(Function::Atan2, &arguments)
}

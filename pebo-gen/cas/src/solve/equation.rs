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

/// `base = value^(1/exponent)`: the positive root unless the base is known to be negative.
pub(super) fn unpower(
    arena: &Arena,
    domain: &Domain,
    base: Expr,
    exponent: &Rational,
    value: Expr,
) -> Option<Equation> {
    if exponent.is_one() {
        return Some(Equation { formula: base, value });
    }
    let inverse = exponent.recip()?;
    if !exponent.is_integer() {
        return Some(Equation { formula: base, value: arena.power(value, &inverse) });
    }
    let field = Field::over(arena, &domain.facts, &[base]).ok()?;
    let fraction = field.fraction(base).ok()?;
    let root = arena.power(value, &inverse);
    let even = exponent.numerator().trailing_zeros() > 0;
    let negative = even && field.signs().is_positive(&fraction.opposite()).ok()?;
    Some(Equation { formula: base, value: if negative { arena.neg(root) } else { root } })
}

/// `inside = inverse(value)`: of an even function the negative of that where the argument is known to be negative.
pub(super) fn uncall(
    arena: &Arena,
    domain: &Domain,
    function: Function,
    inside: Expr,
    value: Expr,
) -> Option<Equation> {
    let row = function.row();
    let principal = arena.call(row.inverse?, &[value]);
    let is_negative =
        row.parity == Some(Parity::Even) && domain.implies(arena, arena.neg(inside), Relation::NonNegative);
    Some(Equation { formula: inside, value: if is_negative { arena.neg(principal) } else { principal } })
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

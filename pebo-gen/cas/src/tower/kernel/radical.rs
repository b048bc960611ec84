//! Roots of fractions.
//!
//! In: a fraction and a rational exponent. Out: powers of kernels `r = part^(1/q)` with `r^q = part`, one for each part
//! of known sign (see [`crate::tower::coprime`]). A power of parts of unknown signs has a kernel for the product:
//! wherever that has a value, the product is not negative, which is learned as a fact. Products of such roots are
//! written over earlier ones.
//!
//! Every root is the real one of a number that is not negative, so that
//! `(a^k b^m)^(1/q) = |a|^(k/q) |b|^(m/q)` wherever it has a value.

use crate::graph::expr::{Expr, Node};
use crate::graph::function::Function;
use crate::number::rational::half;
use crate::poly::Poly;
use crate::{Integer, Rational, Relation};

use super::elements::UnsignedFactors;
use super::{AlgebraicRelation, ProductRoot};
use crate::tower::fraction::Fraction;
use crate::tower::sign::Sign;
use crate::tower::{Family, Field, Obstacle};

impl Field<'_> {
    /// `base ^ exponent` for an exponent that is not an integer; the real power of a non-negative base.
    pub(in crate::tower) fn root(&self, base: &Fraction, exponent: &Rational) -> Result<Fraction, Obstacle> {
        if base.is_zero() {
            return if exponent.is_negative() { Err(Obstacle::DivisionByZero) } else { Ok(Fraction::zero()) };
        }
        let mut total = Fraction::one();
        let UnsignedFactors { negative, parts: unknown } = self.elements_of(base, &mut |part, times| {
            total = self.mul(&total, &self.power_of(part, &(&Rational::from(times) * exponent))?)?;
            Ok(())
        })?;
        if unknown.is_empty() {
            return if negative { Err(self.negative_root(base)) } else { Ok(total) };
        }
        let rest = self.root_of_unknown(negative, unknown, exponent)?;
        self.mul(&total, &rest)
    }

    fn negative_root(&self, base: &Fraction) -> Obstacle {
        Obstacle::Kernel(format!("the root of {}, which is negative", self.arena.print(self.show(base))))
    }

    /// A root of parts with unknown signs, whose product is not negative.
    fn root_of_unknown(
        &self,
        negative: bool,
        parts: Vec<(Poly, i64)>,
        exponent: &Rational,
    ) -> Result<Fraction, Obstacle> {
        let degree = exponent.denominator().to_i64().ok_or(Obstacle::TooLarge)?;
        let mut total = Fraction::one();
        let mut odd = Vec::new();
        for (part, times) in parts {
            // Full powers of even exponent come out as absolute values; an even power has the absolute value's root.
            let step = if degree % 2 == 0 { degree } else { 2 * degree };
            let inside = times.rem_euclid(step);
            let share = if inside % 2 == 0 { times } else { times - inside };
            if share != 0 {
                let power = self.power_of_size(&part, &(&Rational::from(share) * exponent))?;
                total = self.mul(&total, &power)?;
            }
            if times != share {
                odd.push((part, inside));
            }
        }
        if odd.is_empty() {
            return if negative { Err(Obstacle::Kernel("the root of a negative square".into())) } else { Ok(total) };
        }
        if let [(part, times)] = odd.as_slice() {
            // The part itself has the sign that the root needs.
            let size = if negative { -part } else { part.clone() };
            self.signs().learn_from_existence(&size, Relation::NonNegative)?;
            let power = self.power_of(&size, &(&Rational::from(*times) * exponent))?;
            return self.mul(&total, &power);
        }
        let root = self.root_of_product(negative, odd, u32::try_from(degree).map_err(|_| Obstacle::TooLarge)?)?;
        let times = exponent.numerator().to_i64().ok_or(Obstacle::TooLarge)?;
        self.mul(&total, &self.pow(&root, times)?)
    }

    /// The root of a product as one kernel, or over the earlier roots of products.
    fn root_of_product(&self, negative: bool, powers: Vec<(Poly, i64)>, degree: u32) -> Result<Fraction, Obstacle> {
        let mut value = if negative { Poly::constant(-1) } else { Poly::one() };
        for (part, times) in &powers {
            let times = u32::try_from(*times).map_err(|_| Obstacle::TooLarge)?;
            value = value.mul(&part.pow(times, self.limit())?, self.limit())?;
        }
        for (part, _) in &powers {
            self.signs().leave_open(part);
        }
        self.signs().learn_from_existence(&value, Relation::NonNegative)?;
        if let Some(root) = self.over_earlier_roots(negative, &powers, degree)? {
            return Ok(root);
        }
        let value = self.reduce(&value)?;
        let exponent = Rational::new(1, i64::from(degree)).ok_or(Obstacle::DivisionByZero)?;
        let shown = self.arena.power(self.show_polynomial(&value), &exponent);
        let kernel = self.enter(shown, Some(AlgebraicRelation { degree, value }), false);
        self.round.products.borrow_mut().push(ProductRoot { degree, negative, powers, kernel });
        Ok(Fraction::polynomial(Poly::variable(kernel)))
    }

    /// A square root as a product of one or two earlier ones over absolute values: all of them have values, so
    /// `sqrt(a b) = sqrt(a c) sqrt(b c) / |c|`.
    fn over_earlier_roots(
        &self,
        negative: bool,
        powers: &[(Poly, i64)],
        degree: u32,
    ) -> Result<Option<Fraction>, Obstacle> {
        let earlier: Vec<ProductRoot> =
            self.round.products.borrow().iter().filter(|whole| whole.degree == degree).cloned().collect();
        if let Some(same) = earlier.iter().find(|whole| whole.negative == negative && whole.powers == powers) {
            return Ok(Some(Fraction::polynomial(Poly::variable(same.kernel))));
        }
        if degree != 2 {
            return Ok(None);
        }
        for (index, first) in earlier.iter().enumerate() {
            for second in &earlier[index + 1..] {
                let mut exponents: Vec<(Poly, i64)> = powers.to_vec();
                for (part, times) in first.powers.iter().chain(&second.powers) {
                    match exponents.iter_mut().find(|(known, _)| known == part) {
                        Some((_, total)) => *total -= times,
                        None => exponents.push((part.clone(), -times)),
                    }
                }
                let even = exponents.iter().all(|(_, times)| times % 2 == 0);
                if !even || negative != (first.negative ^ second.negative) {
                    continue;
                }
                let kernels = [first, second].map(|whole| Fraction::polynomial(Poly::variable(whole.kernel)));
                let mut total = self.mul(&kernels[0], &kernels[1])?;
                for (part, times) in exponents {
                    total = self.mul(&total, &self.pow(&self.size(&part)?, times / 2)?)?;
                }
                return Ok(Some(total));
            }
        }
        Ok(None)
    }

    /// `|part| ^ exponent`
    fn power_of_size(&self, part: &Poly, exponent: &Rational) -> Result<Fraction, Obstacle> {
        let size = self.size(part)?;
        match exponent.to_i64() {
            Some(times) => self.pow(&size, times),
            None => self.power_of(&size.num, exponent),
        }
    }

    /// `part ^ exponent` for a part that is not negative.
    pub(in crate::tower) fn power_of(&self, part: &Poly, exponent: &Rational) -> Result<Fraction, Obstacle> {
        if let Some(times) = exponent.to_i64() {
            return self.pow(&Fraction::polynomial(part.clone()), times);
        }
        if let ([variable], true) = (part.variables(), part.term_count() == 1 && part.total_degree() == 1) {
            let expr = self.kernel(*variable);
            match self.arena.node(expr) {
                Node::Call(Function::Exp, inside) => {
                    return self.exponential(&self.scale(&self.fraction(inside[0])?, exponent)?);
                }
                Node::Product(product) if self.is_plain_root(expr) => {
                    let (base, inner) = &product.factors[0];
                    return self.root(&self.fraction(*base)?, &(inner * exponent));
                }
                _ => {}
            }
        }
        if exponent.denominator().trailing_zeros() > 0
            && let Some(simpler) = self.denested(part)?
        {
            return self.root(&simpler, &(exponent * &Rational::from(2)));
        }
        let whole = Rational::from(exponent.floor());
        let times = whole.to_i64().ok_or(Obstacle::TooLarge)?;
        let outside = self.pow(&Fraction::polynomial(part.clone()), times)?;
        let key = self.show_polynomial(part);
        let share = exponent - &whole;
        let step = Rational::new(Integer::ONE, share.denominator()).ok_or(Obstacle::DivisionByZero)?;
        // The kernel is the root itself, not a power of it.
        let _unit = self.multiple(Family::Root, key, &step)?;
        let (unit, times) = self.multiple(Family::Root, key, &share)?;
        let degree = unit.denominator().to_i64().and_then(|q| u32::try_from(q).ok()).ok_or(Obstacle::TooLarge)?;
        let mut value = self.reduce(part)?;
        let mut degree = degree;
        if degree % 2 == 0
            && let Some(prime) = part.to_constant()
            && let Some(root) = self.gauss_sum(&prime)?
        {
            // r^q = p is r^(q/2) = sqrt(p) there.
            degree /= 2;
            value = root;
            if degree == 1 {
                return self.mul(&outside, &self.pow(&Fraction::polynomial(value), times)?);
            }
        }
        // A root is zero where its radicand is: only that of a number is positive wherever it exists.
        let root =
            self.entered(self.arena.power(key, &unit), Some(AlgebraicRelation { degree, value }), part.is_constant());
        self.mul(&outside, &self.pow(&root, times)?)
    }

    /// The square root of `a + b r` with `r^2 = c`, where `a^2 - b^2 c = d^2`: the square root is
    /// `sqrt((a + d)/2) + sqrt((a - d)/2)`, with a minus for a negative b r (Borodin and others, 1985).
    fn denested(&self, part: &Poly) -> Result<Option<Fraction>, Obstacle> {
        for (kernel, c) in self.square_roots_in(part) {
            let mut a = Poly::zero();
            let mut b = Poly::zero();
            for (exponent, coefficient) in part.coefficients_in(kernel) {
                match exponent {
                    0 => a = coefficient,
                    _ => b = coefficient,
                }
            }
            let squares = &a.mul(&a, self.limit())? - &b.mul(&b, self.limit())?.mul(&c, self.limit())?;
            let Some(d) = self.reduce(&squares)?.sqrt_exact(self.limit())? else { continue };
            let d = match self.signs().of_polynomial(&d)? {
                Some(Sign::Negative) => -&d,
                _ => d,
            };
            let halves = [&a + &d, &a - &d];
            if halves.iter().any(Poly::is_zero) {
                continue;
            }
            let mut roots = Vec::new();
            for value in &halves {
                if !self.signs().of_polynomial(value)?.is_some_and(Sign::is_positive_or_zero) {
                    break;
                }
                roots.push(self.root(&self.scale(&Fraction::polynomial(value.clone()), &half())?, &half())?);
            }
            let [first, second] = roots.as_slice() else { continue };
            match self.signs().of_polynomial(&b)? {
                Some(Sign::Negative) if self.signs().of_polynomial(&d)?.is_some_and(Sign::is_positive_or_zero) => {
                    return Ok(Some(self.sub(first, second)?));
                }
                Some(sign) if sign.is_positive_or_zero() => return Ok(Some(self.add(first, second)?)),
                _ => {}
            }
        }
        Ok(None)
    }

    /// The square roots that occur linearly in a polynomial, with their radicands.
    pub(crate) fn square_roots_in(&self, poly: &Poly) -> Vec<(u32, Poly)> {
        let kernels = self.round.kernels.borrow();
        let of = |&variable: &u32| {
            let kernel = &kernels[variable];
            let relation = kernel.relation.as_ref().filter(|relation| relation.degree == 2)?;
            (self.is_plain_root(kernel.expr) && poly.degree(variable) == 1).then(|| (variable, relation.value.clone()))
        };
        poly.variables().iter().filter_map(of).collect()
    }

    pub(in crate::tower) fn is_plain_root(&self, expr: Expr) -> bool {
        match self.arena.node(expr) {
            Node::Product(product) => {
                product.coefficient.is_one()
                    && matches!(product.factors.as_slice(), [(_, exponent)] if exponent.numerator().is_one() && !exponent.is_integer())
            }
            _ => false,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Arena;
    use crate::Facts;

    #[test]
    fn zero_has_positive_powers_alone() {
        let arena = Arena::new();
        let field = Field::over(&arena, &Facts::new(), &[]).unwrap();
        let power = |exponent: &Rational| field.root(&Fraction::zero(), exponent);
        assert_eq!(power(&half()), Ok(Fraction::zero()));
        assert_eq!(power(&-&half()), Err(Obstacle::DivisionByZero));
    }

    #[test]
    fn the_root_of_a_product_of_unsign_memory_has_the_product_as_its_square() {
        let arena = Arena::new();
        let [x, y] = ["x", "y"].map(|name| arena.variable(name));
        for product in [arena.mul(x, y), arena.neg(arena.mul(x, y)), arena.scale(arena.mul(x, y), &Rational::from(-3))]
        {
            let root = arena.sqrt(product);
            let field = Field::over(&arena, &Facts::new(), &[root, product]).unwrap();
            let own = field.fraction(root).unwrap();
            let square = field.pow(&own, 2).unwrap();
            assert_eq!(square, field.fraction(product).unwrap(), "{}", arena.print(product));
            assert!(arena.print(field.show(&own)).contains("sqrt("), "{}", arena.print(field.show(&own)));
        }
    }

    /// Not over two earlier ones that leave a part with an odd power.
    #[test]
    fn roots_of_products_are_distinguished_by_their_parts() {
        let arena = Arena::new();
        let [w, x, y, z] = ["w", "x", "y", "z"].map(|name| arena.variable(name));
        let products = [arena.mul(x, y), arena.mul(y, z), arena.mul(x, z), arena.mul(x, w)];
        let roots = products.map(|product| arena.sqrt(product));
        let field = Field::over(&arena, &Facts::new(), &roots).unwrap();
        for (root, product) in roots.into_iter().zip(products) {
            let square = field.pow(&field.fraction(root).unwrap(), 2).unwrap();
            assert_eq!(square, field.fraction(product).unwrap(), "{}", arena.print(product));
        }
    }

    /// Else the kernels would be another root of the same, and roots of exponentials.
    #[test]
    fn roots_of_kernels_are_powers_of_what_these_are_made_of() {
        let arena = Arena::new();
        let [x, y] = ["x", "y"].map(|name| arena.variable(name));
        let mut facts = Facts::new();
        facts.assume(y, Relation::Positive);
        let exp = arena.call(Function::Exp, &[x]);
        let next = arena.add(y, arena.one());
        let root = arena.sqrt(next);
        for (inside, shown) in
            [([exp, arena.mul(exp, y)], "sqrt(y + 1)*exp(x/2)"), ([root, arena.mul(root, y)], "(y + 1)^(3/4)")]
        {
            let whole = arena.sqrt(arena.sum(inside));
            let field = Field::over(&arena, &facts, &[whole]).unwrap();
            let fraction = field.fraction(whole).unwrap();
            assert_eq!(arena.print(field.show(&fraction)), shown);
            assert!(!field.round.finer.get(), "{shown} needs no other kernels");
        }
    }

    /// The sign of x is not learned.
    #[test]
    fn an_even_power_has_the_root_of_its_absolute_value() {
        let arena = Arena::new();
        let x = arena.variable("x");
        for (power, degree, expected) in
            [(2, 4, "sqrt(abs(x))"), (6, 4, "abs(x)^(3/2)"), (2, 3, "abs(x)^(2/3)"), (4, 2, "x^2"), (2, 2, "abs(x)")]
        {
            let field = Field::over(&arena, &Facts::new(), &[x]).unwrap();
            let whole = field.pow(&field.fraction(x).unwrap(), power).unwrap();
            let root = field.root(&whole, &Rational::new(1, degree).unwrap()).unwrap();
            assert_eq!(arena.print(field.show(&root)), expected);
            assert_eq!(field.signs().count_learned(), 0);
        }
    }

    #[test]
    fn a_negative_number_has_no_root() {
        let arena = Arena::new();
        let x = arena.variable("x");
        for negative in
            [arena.number(-2), arena.neg(arena.mul(x, x)), arena.sub(arena.neg(arena.mul(x, x)), arena.one())]
        {
            let field = Field::over(&arena, &Facts::new(), &[negative]).unwrap();
            let root = field.root(&field.fraction(negative).unwrap(), &half());
            assert!(matches!(root, Err(Obstacle::Kernel(_))), "{}: {root:?}", arena.print(negative));
        }
    }
}

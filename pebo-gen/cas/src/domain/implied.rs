//! Proves signs of expressions from the assumptions of a domain.
//!
//! In: a domain and an expression. Out: yes, if a fact, algebra over the facts and the equations, or an enclosure over
//! the box that they state proves it; an undecided sign is not proved.

use std::collections::{BTreeSet, HashSet};

use crate::graph::arena::Arena;
use crate::graph::expr::{Expr, Node, Symbol};
use crate::graph::function::Function;
use crate::tower::{Field, Fraction, Obstacle};
use crate::{Domain, Facts, Rational, Relation};

/// The most sums of facts that are looked at for one: ten symbols have 90 differences.
const MOST_SUMS: usize = 100;

/// The signs that a value has at some points.
#[derive(Default)]
struct SampledSigns {
    positive: bool,
    negative: bool,
}

impl SampledSigns {
    /// True if the value of a fraction at these points, and at all others, has one sign and is not zero.
    fn are_one(&self, field: &Field<'_>, fraction: &Fraction) -> Result<bool, Obstacle> {
        Ok((!self.negative && field.signs().is_positive(fraction)?)
            || (!self.positive && field.signs().is_positive(&fraction.opposite())?))
    }
}

impl Domain {
    /// True if a domain condition of a formula is granted: it holds of numbers, or the facts prove it.
    pub fn grants(&self, arena: &Arena, condition: (Expr, Relation)) -> bool {
        arena.holds_of_number(condition) || self.implies(arena, condition.0, condition.1)
    }

    /// True if the facts prove that the expression compares so with zero, wherever it has a value.
    pub fn implies(&self, arena: &Arena, expr: Expr, relation: Relation) -> bool {
        if self.facts.iter().any(|(fact, known)| fact == expr && (known == relation || known == Relation::Positive)) {
            return true;
        }
        // A proof of a sign takes algebra; one point often refutes it.
        let sampled = self.sampled_signs(arena, expr);
        let signed = match relation {
            Relation::Positive | Relation::NonNegative => !sampled.negative,
            Relation::NonZero => !(sampled.negative && sampled.positive),
        };
        let shown = |field: Result<Field<'_>, Obstacle>| {
            let field = field?;
            let fraction = field.fraction(expr)?;
            match relation {
                Relation::Positive => field.signs().is_positive(&fraction),
                Relation::NonNegative => field.signs().is_not_negative(&fraction),
                Relation::NonZero => sampled.are_one(&field, &fraction),
            }
        };
        let divides = || {
            relation != Relation::NonNegative
                && self.divides(arena, expr).unwrap_or(false)
                && (relation == Relation::NonZero || signed && self.implies(arena, expr, Relation::NonNegative))
        };
        (signed && shown(Field::over(arena, &self.facts, &[expr])).unwrap_or(false))
            || (signed && !self.manifold.is_empty() && shown(Field::on(arena, self, &[expr])).unwrap_or(false))
            || divides()
            || (signed && self.sign_over_box(arena, expr).is_some_and(|is| is || relation == Relation::NonZero))
            || (signed
                && (self.implies_by_order(arena, expr, relation)
                    || self.implies_on_both_sides(arena, expr, relation)
                    || self.implies_of_combined_angles(arena, expr, relation)
                    || self.implies_by_values(arena, expr, relation)))
    }

    /// True if the expression is a sum of facts: `a` is positive where `a > b`, `b > c` and `c > 0`.
    fn implies_by_order(&self, arena: &Arena, expr: Expr, relation: Relation) -> bool {
        let signed = self.facts.iter().filter(|(_, relation)| *relation != Relation::NonZero);
        let (sums, others): (Vec<_>, Vec<_>) =
            signed.partition(|(fact, _)| matches!(arena.node(*fact), Node::Sum(sum) if sum.terms.len() > 1));
        // Without a comparison of two expressions the facts are these themselves.
        let is_sum = |expr: Expr, relation| {
            !sums.is_empty() && is_sum_of_facts(arena, (expr, relation), &[sums.as_slice(), &others].concat())
        };
        match relation {
            Relation::NonZero => [expr, arena.neg(expr)].into_iter().any(|expr| is_sum(expr, Relation::Positive)),
            _ => is_sum(expr, relation),
        }
    }

    /// True if the expression compares so with the values that the equations give of symbols in it and in the facts:
    /// `1 - y^2` is not negative where `y = sin(q)`, though the normal form keeps y, which results may hold, and not q;
    /// `a^2 + b^2` is positive where `r > 0` and `r = sqrt(a^2 + b^2)`.
    fn implies_by_values(&self, arena: &Arena, expr: Expr, relation: Relation) -> bool {
        let values = self.manifold.given_values(arena);
        let by_values = |expr: Expr| arena.substitute(expr, &values);
        let facts = self.facts.iter().map(|(fact, relation)| (fact, by_values(fact), relation));
        let new: Vec<_> = facts.filter(|(fact, by_values, _)| fact != by_values).collect();
        if new.is_empty() && by_values(expr) == expr {
            return false;
        }
        let mut domain = self.without_equations();
        for (_, fact, relation) in new {
            domain.facts.assume(fact, relation);
        }
        domain.implies(arena, by_values(expr), relation)
    }

    /// True if the expression compares so in angles of its own for the sums of which it takes sines and cosines:
    /// `2 - cos(q - r)` is positive as `2 - cos(q)` is, which the sum of products that is its normal form does not show.
    /// An angle takes the place of a symbol of its sum, so that all values of the symbols are values of the others with
    /// the angle; where no symbol is left, it has any values.
    fn implies_of_combined_angles(&self, arena: &Arena, expr: Expr, relation: Relation) -> bool {
        let known: Vec<Expr> = self.facts.iter().map(|(fact, _)| fact).chain([expr]).collect();
        let taken = arena.symbols_of(&known);
        // Of a name that is not in use: a sum may hold angles that stand for others already.
        let mut fresh = (1..).map(|n| arena.generated(&format!("angle{n}"))).filter(|angle| !taken.contains(angle));
        let mut all = known;
        let mut angles: BTreeSet<Symbol> = BTreeSet::new();
        while let Some(sum) = arena.angle_of_a_sum(&all[all.len() - 1..]) {
            let Some(angle) = fresh.next() else { return false };
            angles.insert(angle);
            let own = arena.of_symbol(angle);
            let replaced =
                arena.unit_symbol(sum, |symbol| !angles.contains(symbol) && !self.fixed.contains_key(symbol));
            all = match replaced {
                Some((symbol, slope)) => {
                    let rest = arena.sub(sum, arena.scale(arena.of_symbol(symbol), &slope));
                    let value = arena.div(arena.sub(own, rest), arena.number(slope));
                    arena.substitute_all(&all, &[(symbol, value)].into())
                }
                None => all.iter().map(|e| arena.replace(*e, &[(sum, own)].into_iter().collect())).collect(),
            };
        }
        let Some(expr) = all.pop().filter(|_| !angles.is_empty()) else { return false };
        let mut free = self.without_equations();
        free.facts = Facts::new();
        for ((_, relation), fact) in self.facts.iter().zip(all) {
            free.facts.assume(fact, relation);
        }
        free.implies(arena, expr, relation)
    }

    /// True if the expression compares so on either side of each of its non-smooth points: there it has no absolute
    /// value of a term that changes sign. `max(q, 1)` is q where that is at least 1, and 1 elsewhere.
    fn implies_on_both_sides(&self, arena: &Arena, expr: Expr, relation: Relation) -> bool {
        let sides = |divider: Expr| [divider, arena.neg(divider)];
        let is_open =
            |divider: &Expr| !sides(*divider).into_iter().any(|side| self.implies(arena, side, Relation::NonNegative));
        let Some(divider) = arena.dividers(&[expr]).into_iter().find(is_open) else { return false };
        sides(divider).into_iter().all(|side| {
            let mut there = self.clone();
            there.facts.assume(side, Relation::NonNegative);
            there.implies(arena, expr, relation)
        })
    }

    /// The signs that the expression provably has at some points of the domain.
    fn sampled_signs(&self, arena: &Arena, expr: Expr) -> SampledSigns {
        let mut sampled = SampledSigns::default();
        for value in self.glimpses(arena, &[expr]).filter_map(|point| arena.separated_from_zero(expr, &point)) {
            *(if value.is_positive() { &mut sampled.positive } else { &mut sampled.negative }) = true;
            if sampled.positive && sampled.negative {
                break;
            }
        }
        sampled
    }

    /// True if the expression vanishes only where an expression assumed non-zero does: its factors are among those of
    /// the facts, as `d - 1` is of `L*(1 - d) != 0`, or among those of their squares, as `cos(q)^2 - 1` is of
    /// `sin(q) != 0`.
    fn divides(&self, arena: &Arena, expr: Expr) -> Result<bool, Obstacle> {
        let symbols = arena.symbols_of(&[expr]);
        let facts = self.facts.iter().filter(|(fact, relation)| {
            *relation != Relation::NonNegative && !arena.symbols_of(&[*fact]).is_disjoint(&symbols)
        });
        let facts: Vec<Expr> = facts.map(|(fact, _)| fact).collect();
        if facts.is_empty() {
            return Ok(false);
        }
        let field = Field::over(arena, &self.facts, &[facts.as_slice(), &[expr]].concat())?;
        let is_signed = |fraction: &Fraction| {
            let sampled = || self.sampled_signs(arena, field.show(fraction));
            Ok::<_, Obstacle>(fraction.to_constant().is_some() || sampled().are_one(&field, fraction)?)
        };
        let whole = field.fraction(expr)?;
        if whole.is_zero() {
            return Ok(false);
        }
        let mut known = Vec::new();
        for fact in facts {
            let fact = field.fraction(fact)?;
            // At zeros of the normal form's denominator the fact may hold although its numerator is zero.
            if is_signed(&field.of_polynomial(fact.denominator())?)? {
                known.extend(square(&field, &fact)?);
                known.push(fact);
            }
        }
        for own in square(&field, &whole)?.into_iter().chain([whole.clone()]) {
            let mut rest = own.numerator().clone();
            for fact in &known {
                loop {
                    let common = rest.gcd(fact.numerator(), field.limit())?;
                    if common.is_constant() {
                        break;
                    }
                    let Some(quotient) = rest.div_exact(&common, field.limit())? else { break };
                    rest = quotient;
                }
            }
            // The sign of the expression itself was asked for before this.
            let left = field.of_polynomial(&rest)?;
            if left != whole && is_signed(&left)? {
                return Ok(true);
            }
        }
        Ok(false)
    }
}

impl Arena {
    /// A sum of which one of the expressions takes the sine or cosine.
    fn angle_of_a_sum(&self, exprs: &[Expr]) -> Option<Expr> {
        self.postorder(exprs).into_iter().find_map(|node| match self.node(node) {
            Node::Call(Function::Sin | Function::Cos, arguments) => {
                let is_one = matches!(self.node(arguments[0]), Node::Sum(_)) && !self.symbols_of(&arguments).is_empty();
                is_one.then_some(arguments[0])
            }
            _ => None,
        })
    }

    /// A symbol that a sum holds times a number, and not otherwise.
    fn unit_symbol(&self, sum: Expr, admitted: impl Fn(&Symbol) -> bool) -> Option<(Symbol, Rational)> {
        let Node::Sum(sum) = self.node(sum) else { return None };
        sum.terms.iter().enumerate().find_map(|(place, (term, slope))| {
            let symbol = self.as_symbol(*term).filter(&admitted)?;
            let others = sum.terms.iter().enumerate().filter(|(other, _)| *other != place);
            let is_apart = others.into_iter().all(|(_, (term, _))| !self.symbols_of(&[*term]).contains(&symbol));
            is_apart.then(|| (symbol, slope.clone()))
        })
    }
}

/// True if an expression is a sum of these facts, and one of them is positive if it has to be. What is left after a fact
/// holds no more symbols than before, and is met once: differences of symbols have few others.
fn is_sum_of_facts(arena: &Arena, whole: (Expr, Relation), facts: &[(Expr, Relation)]) -> bool {
    let count = |expr: Expr| arena.symbols_of(&[expr]).len();
    let (mut met, mut open) = (HashSet::from([whole]), vec![whole]);
    while let Some((expr, relation)) = open.pop() {
        for (fact, known) in facts {
            let rest = arena.sub(expr, *fact);
            if arena.is_zero(rest) {
                if *known == Relation::Positive || relation == Relation::NonNegative {
                    return true;
                }
                continue;
            }
            let shares = || !arena.symbols_of(&[*fact]).is_disjoint(&arena.symbols_of(&[expr]));
            let needed = if *known == Relation::Positive { Relation::NonNegative } else { relation };
            if count(rest) <= count(expr) && shares() && met.len() < MOST_SUMS && met.insert((rest, needed)) {
                open.push((rest, needed));
            }
        }
    }
    false
}

/// The square of a fraction, if that is more than a product: `sin(q)` has `1 - cos(q)^2`.
fn square(field: &Field<'_>, fraction: &Fraction) -> Result<Option<Fraction>, Obstacle> {
    field.has_relations(fraction).then(|| field.mul(fraction, fraction)).transpose()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Function;
    use crate::domain::manifold::Manifold;

    #[test]
    fn an_order_is_transitive() {
        let arena = Arena::new();
        let [a, b, c, d] = ["a", "b", "c", "d"].map(|name| arena.variable(name));
        let mut domain = Domain::default();
        for (more, less) in [(a, b), (b, c), (c, arena.zero())] {
            domain.facts.assume(arena.sub(more, less), Relation::Positive);
        }
        domain.facts.assume(arena.sub(d, a), Relation::NonNegative);
        let holds = |expr, relation| domain.implies(&arena, expr, relation);
        for expr in [a, b, d, arena.sub(a, c), arena.sub(d, c)] {
            assert!(holds(expr, Relation::Positive) && holds(expr, Relation::NonZero), "{}", arena.print(expr));
            assert!(!holds(arena.neg(expr), Relation::NonNegative), "{}", arena.print(expr));
        }
        assert!(holds(arena.sub(c, a), Relation::NonZero));
        assert!(!holds(arena.sub(d, a), Relation::Positive) && !holds(arena.sub(a, d), Relation::NonNegative));
    }

    #[test]
    fn divisors_of_a_fact_do_not_vanish() {
        let arena = Arena::new();
        let [q, k] = ["q", "k"].map(|name| arena.variable(name));
        let [sine, cosine] = [Function::Sin, Function::Cos].map(|function| arena.call(function, &[q]));
        let square = arena.sub(arena.mul(cosine, cosine), arena.one());
        let implied = |fact, expr| {
            let mut domain = Domain::default();
            domain.facts.assume(fact, Relation::NonZero);
            domain.implies(&arena, expr, Relation::NonZero)
        };
        assert!(implied(sine, square) && implied(square, sine));
        assert!(implied(arena.mul(k, sine), square));
        assert!(!implied(cosine, square) && !implied(arena.add(sine, k), square));
    }

    #[test]
    fn sines_of_sums_have_the_bounds_of_sines() {
        let arena = Arena::new();
        let [q, r, b, c] = ["q", "r", "b", "c"].map(|name| arena.variable(name));
        let cosine = |e| arena.call(Function::Cos, &[e]);
        let of = |e| arena.sub(arena.number(Rational::from(2)), cosine(e));
        assert!(Domain::default().implies(&arena, of(arena.sub(q, r)), Relation::Positive));
        assert!(!Domain::default().implies(
            &arena,
            arena.sub(arena.one(), cosine(arena.sub(q, r))),
            Relation::Positive
        ));
        // A bound of a sum is one of its angle.
        let mut bounded = Domain::default();
        let angle = arena.sub(q, r);
        bounded.facts.assume(angle, Relation::Positive);
        bounded.facts.assume(arena.sub(arena.number(Rational::from(3)), angle), Relation::Positive);
        let sine = arena.call(Function::Sin, &[angle]);
        assert!(bounded.implies(&arena, sine, Relation::Positive));
        assert!(!bounded.implies(&arena, arena.call(Function::Sin, &[arena.add(q, r)]), Relation::NonZero));
        let before = |e| arena.call(Function::Sin, &[arena.neg(e)]);
        assert!(bounded.implies(&arena, before(angle), Relation::NonZero));
        // An angle that stands for a sum already is not taken for another: the cosines differ.
        let inner = arena.of_symbol(arena.generated("angle1"));
        let difference = arena.sub(cosine(inner), cosine(arena.add(inner, q)));
        let positive = arena.add(difference, arena.number(Rational::new(19, 10).unwrap()));
        assert!(!Domain::default().implies(&arena, positive, Relation::Positive));
        let mut domain = Domain::default();
        let square = |e| arena.mul(e, e);
        domain.facts.assume(arena.sub(c, square(b)), Relation::Positive);
        let leg = arena.sub(c, square(arena.mul(b, cosine(arena.sub(q, r)))));
        assert!(domain.implies(&arena, leg, Relation::Positive));
    }

    #[test]
    fn signs_are_proved_on_both_sides_of_a_non_smooth_point() {
        use Relation::{NonNegative, NonZero, Positive};

        let arena = Arena::new();
        let [q, k] = ["q", "k"].map(|name| arena.variable(name));
        let number = |n: i64| arena.number(Rational::from(n));
        let call = |function, arguments: &[Expr]| arena.call(function, arguments);
        let cases = [
            (call(Function::Max, &[q, number(1)]), Positive, true),
            (call(Function::Max, &[q, number(1)]), NonZero, true),
            (call(Function::Max, &[q, number(0)]), NonNegative, true),
            (call(Function::Max, &[q, number(0)]), Positive, false),
            (arena.add(call(Function::Max, &[q, number(-1)]), number(1)), NonZero, false),
            (arena.add(call(Function::Max, &[q, number(-1)]), number(2)), NonZero, true),
            (arena.add(call(Function::Sat, &[q]), number(2)), Positive, true),
            (arena.add(call(Function::Sat, &[q]), number(1)), Positive, false),
            (arena.add(call(Function::Sign, &[q]), number(2)), NonZero, true),
            (arena.add(call(Function::Sign, &[q]), number(1)), NonZero, false),
            (arena.sub(number(-1), call(Function::Max, &[k, number(1)])), NonZero, true),
            (arena.sub(call(Function::Abs, &[q]), q), NonNegative, true),
            (arena.sub(call(Function::Abs, &[q]), q), Positive, false),
        ];
        for (expr, relation, expected) in cases {
            let implied = Domain::default().implies(&arena, expr, relation);
            assert_eq!(implied, expected, "{} {}", arena.print(expr), relation.sign());
        }
    }

    #[test]
    fn measured_values_have_the_bounds_of_their_formulas() {
        let arena = Arena::new();
        let [q, y] = ["q", "y"].map(|name| arena.variable(name));
        let equation = arena.sub(y, arena.scale(arena.call(Function::Sin, &[q]), &Rational::from(2)));
        let groups = vec![arena.symbols_of(&[q]), arena.symbols_of(&[y]), BTreeSet::new()];
        let manifold = Manifold::new(&arena, &Facts::new(), vec![equation], groups);
        let domain = Domain { manifold, ..Domain::default() };
        let leg = |square: i64| arena.sub(arena.number(square), arena.mul(y, y));
        assert!(domain.implies(&arena, leg(4), Relation::NonNegative));
        assert!(domain.implies(&arena, leg(5), Relation::Positive));
        assert!(!domain.implies(&arena, leg(4), Relation::Positive));
        assert!(!domain.implies(&arena, leg(3), Relation::NonNegative));
        // A bound of the measured value is one of the formula.
        let [a, b, r] = ["a", "b", "r"].map(|name| arena.variable(name));
        let square = arena.add(arena.mul(a, a), arena.mul(b, b));
        let groups = vec![arena.symbols_of(&[a, b]), arena.symbols_of(&[r]), BTreeSet::new()];
        let manifold = Manifold::new(&arena, &Facts::new(), vec![arena.sub(r, arena.sqrt(square))], groups);
        let mut domain = Domain { manifold, ..Domain::default() };
        assert!(!domain.implies(&arena, square, Relation::Positive));
        domain.facts.assume(r, Relation::Positive);
        assert!(domain.implies(&arena, square, Relation::Positive));
    }

    #[test]
    fn sums_of_facts_are_implied() {
        let arena = Arena::new();
        let [a, b, c, d] = ["a", "b", "c", "d"].map(|name| arena.variable(name));
        let mut domain = Domain::default();
        for fact in [arena.sub(b, a), arena.sub(c, b), arena.sub(d, c)] {
            domain.facts.assume(fact, Relation::Positive);
        }
        for (low, high) in [(a, b), (a, c), (a, d), (b, d)] {
            assert!(domain.implies(&arena, arena.sub(high, low), Relation::Positive));
            assert!(!domain.implies(&arena, arena.sub(low, high), Relation::NonNegative));
        }
        assert!(domain.implies(&arena, arena.sub(arena.sum([c, d]), arena.sum([a, b])), Relation::Positive));
    }
}

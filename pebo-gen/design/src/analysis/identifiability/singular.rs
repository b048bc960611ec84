//! Conditions under which a regressor loses rank, for a reader to check.
//!
//! In: `Phi_1` of full generic column rank. Out: the zero set of det(`Phi_1`' `Phi_1`) by factors, each solved for a
//! signal where it is linear in one (`d = 1`); factors that the assumptions keep from zero are left out, and those
//! without signals are separate.
//!
//! Common factors of rows and columns as written are taken out first. A zero of the remaining numerator is one of the
//! determinant only where its denominator does not vanish too: a denominator with a root or an absolute value is made
//! rational by a factor that both then have, as in `(1 - |w|)/(1 - w^2)`, which is never zero.

use std::collections::{BTreeMap, BTreeSet};

use crate::plant::Plant;
use pebo_cas::linear::determinant::determinant;
use pebo_cas::linear::{Echelon, Matrix};
use pebo_cas::poly::Poly;
use pebo_cas::tower::{Field, Fraction, Obstacle};
use pebo_cas::{Arena, Domain, Expr, Node, Rational, Relation, Symbol};

/// The zeros of a determinant.
#[derive(Default)]
pub(super) struct ZeroSet {
    /// Conditions on signals, each of which makes it vanish.
    pub signals: Vec<String>,
    /// The functions that vanish there, in the same order.
    pub zeros: Vec<Expr>,
    /// Combinations of the parameters, of unknown sign, that make it vanish at all signals.
    pub constants: Vec<Expr>,
    /// True if it has no other zeros.
    pub all: bool,
    /// True if values of the parameters are not excluded that make a factor vanish at all signals, by several
    /// equations.
    pub joint: bool,
}

impl ZeroSet {
    /// Tests whether it vanishes nowhere.
    pub(super) fn are_none(&self) -> bool {
        self.all && self.signals.is_empty() && self.constants.is_empty()
    }
}

/// The root of det(`Phi_1`' `Phi_1`) for a square regressor, the determinant itself for any other: powers of the common
/// factors, and the determinant of the rest.
pub(super) struct Volume<'a> {
    arena: &'a Arena,
    field: Field<'a>,
    powers: Vec<(Expr, Rational)>,
    rest: Vec<Vec<Expr>>,
    core: Fraction,
    /// True if this is the root.
    pub square: bool,
}

impl<'a> Volume<'a> {
    /// The volume of a regressor with as many rows as columns or more.
    pub(super) fn of(arena: &'a Arena, domain: &Domain, phi_1: &[Vec<Expr>]) -> Result<Self, Obstacle> {
        let columns = phi_1.first().map_or(0, Vec::len);
        let square = phi_1.len() == columns;
        let (rest, mut powers) = without_common_factors(arena, phi_1, square);
        let bases = powers.iter().map(|(base, _)| *base);
        let field = Field::on(arena, domain, &rest.iter().flatten().copied().chain(bases).collect::<Vec<_>>())?;
        let core = core_of(&field, &rest)?;
        if !square {
            for (_, power) in &mut powers {
                *power = &*power + &*power;
            }
        }
        Ok(Self { arena, field, powers, rest, core, square })
    }

    /// As an expression, in factors.
    pub(super) fn printed(&self) -> Expr {
        let core = self.field.show_factored(&self.core);
        let powers = self.powers.iter().map(|(base, power)| (self.split(*base).unwrap_or(*base), power.clone()));
        self.arena.multiply(&Rational::ONE, powers.chain([(core, Rational::ONE)]))
    }

    /// A polynomial in factors, if it has several.
    fn split(&self, base: Expr) -> Option<Expr> {
        let fraction = self.field.fraction(base).ok()?;
        let parts = fraction.numerator().factored(self.field.limit()).ok()?;
        (fraction.denominator().is_constant() && parts.factors.len() > 1).then(|| self.field.show_factored(&fraction))
    }

    /// The zeros.
    pub(super) fn zero_set(&self, plant: &Plant, domain: &Domain) -> Result<ZeroSet, Obstacle> {
        let mut zero_set = ZeroSet { all: true, ..ZeroSet::default() };
        for (base, power) in &self.powers {
            if !power.is_negative() {
                self.zeros_of(&self.field.fraction(*base)?, &[vec![*base]], plant, domain, &mut zero_set)?;
            }
        }
        self.zeros_of(&self.core, &self.rest, plant, domain, &mut zero_set)?;
        Ok(zero_set)
    }

    /// Adds the zeros of a fraction, which is the determinant of a matrix as it is written.
    fn zeros_of(
        &self,
        fraction: &Fraction,
        written: &[Vec<Expr>],
        plant: &Plant,
        domain: &Domain,
        zero_set: &mut ZeroSet,
    ) -> Result<(), Obstacle> {
        let field = &self.field;
        let mut shared = false;
        for (factor, _) in fraction.numerator().factored(field.limit())?.factors {
            if self.never_zero(&factor, domain)? {
                continue;
            }
            if field.may_vanish_together(&factor, fraction.denominator())? {
                shared = true;
            } else {
                self.add(&factor, plant, domain, zero_set)?;
            }
        }
        if !shared {
            return Ok(());
        }
        // The zeros of a fraction are those of the denominator of its inverse.
        let inverse = field.div(&Fraction::one(), fraction)?;
        for (factor, _) in inverse.denominator().factored(field.limit())?.factors {
            if self.never_zero(&factor, domain)? {
                continue;
            }
            let there = self.solved(&factor, plant)?.and_then(|(kernel, value)| {
                let signal = self.arena.as_symbol(kernel)?;
                // As it is written: the fraction has no value there.
                let values = BTreeMap::from([(signal, value)]);
                let rows: Vec<_> = written.iter().map(|row| self.arena.substitute_all(row, &values)).collect();
                let there = Field::over(self.arena, &domain.facts, &rows.concat()).ok()?;
                let value = core_of(&there, &rows).ok()?;
                Some((value.is_zero(), there.show(&value)))
            });
            match there {
                Some((true, _)) => self.add(&factor, plant, domain, zero_set)?,
                Some((false, there)) if domain.implies(self.arena, there, Relation::NonZero) => {}
                _ => zero_set.all = false,
            }
        }
        Ok(())
    }

    /// Tests whether the assumptions exclude all zeros of a polynomial.
    fn never_zero(&self, poly: &Poly, domain: &Domain) -> Result<bool, Obstacle> {
        if self.field.signs().never_zero(poly) {
            return Ok(true);
        }
        let formula = self.field.show(&self.field.of_polynomial(poly)?);
        Ok(domain.implies(self.arena, formula, Relation::NonZero))
    }

    /// Adds the zeros of a factor.
    fn add(&self, factor: &Poly, plant: &Plant, domain: &Domain, zero_set: &mut ZeroSet) -> Result<(), Obstacle> {
        let formula = self.field.show(&self.field.of_polynomial(factor)?);
        if self.arena.symbols_of(&[formula]).is_subset(&constants(plant)) {
            if !zero_set.constants.contains(&formula) {
                zero_set.constants.push(formula);
            }
            return Ok(());
        }
        zero_set.joint |= self.may_be_nothing(factor, plant, domain)?;
        let condition = match self.solved(factor, plant)? {
            Some((kernel, value)) => format!("{} = {}", self.arena.print(kernel), self.arena.print(value)),
            None => format!("{} = 0", self.arena.print(formula)),
        };
        if !zero_set.signals.contains(&condition) {
            zero_set.signals.push(condition);
            zero_set.zeros.push(formula);
        }
        Ok(())
    }

    /// Tests whether parameters may make all coefficients of a factor, as a polynomial in the signals, zero.
    fn may_be_nothing(&self, factor: &Poly, plant: &Plant, domain: &Domain) -> Result<bool, Obstacle> {
        let constants = constants(plant);
        let varies = |v: &u32| !self.arena.symbols_of(&[self.field.kernel(*v)]).is_subset(&constants);
        let moving: Vec<u32> = factor.variables().iter().copied().filter(varies).collect();
        let coefficients: Vec<Poly> = factor.collect(&moving).into_iter().map(|(_, coefficient)| coefficient).collect();
        for coefficient in &coefficients {
            if self.never_zero(coefficient, domain)? {
                return Ok(false);
            }
        }
        // `k - m` and `k + m` vanish at once only where k does.
        let monomials: BTreeSet<_> = coefficients.iter().flat_map(|poly| poly.terms().map(|(m, _)| m)).collect();
        let number = |poly: &Poly, monomial| {
            poly.coefficient(monomial)
                .map_or(Fraction::zero(), |value| Fraction::constant(&Rational::from(value.clone())))
        };
        let row = |poly: &Poly| monomials.iter().map(|monomial| number(poly, monomial)).collect();
        let (reduced, _) =
            Echelon::of(&self.field, Matrix::new(coefficients.iter().map(row).collect()), monomials.len())?;
        for (_, row) in reduced.rows() {
            let mut sum = Fraction::zero();
            for (value, monomial) in row.iter().zip(&monomials) {
                let power = self.field.of_polynomial(&Poly::from_terms([(monomial.clone(), 1.into())])?)?;
                sum = self.field.add(&sum, &self.field.mul(value, &power)?)?;
            }
            if self.never_zero(sum.numerator(), domain)? {
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// A signal, or a function of it, and the one value at which a factor vanishes, if it is linear in that and nothing
    /// else in it varies.
    fn solved(&self, factor: &Poly, plant: &Plant) -> Result<Option<(Expr, Expr)>, Obstacle> {
        let constants = constants(plant);
        let varies = |v: &u32| !self.arena.symbols_of(&[self.field.kernel(*v)]).is_subset(&constants);
        let moving: Vec<u32> = factor.variables().iter().copied().filter(varies).collect();
        let [variable] = moving.as_slice() else { return Ok(None) };
        if factor.degree(*variable) != 1 {
            return Ok(None);
        }
        let mut slope = Poly::zero();
        let mut rest = Poly::zero();
        for (power, coefficient) in factor.coefficients_in(*variable) {
            if power == 1 { slope = coefficient } else { rest = coefficient }
        }
        // At a zero of the slope, the factor may be zero at every value.
        if !self.field.signs().never_zero(&slope) {
            return Ok(None);
        }
        Ok(Some((self.field.kernel(*variable), self.field.show(&self.field.quotient(&-&rest, &slope)?))))
    }
}

/// The determinant of a square matrix, of any other that of `M' M`.
fn core_of(field: &Field<'_>, matrix: &[Vec<Expr>]) -> Result<Fraction, Obstacle> {
    let columns = matrix.first().map_or(0, Vec::len);
    let matrix = field.matrix(matrix)?;
    determinant(field, if matrix.height() == columns { matrix } else { matrix.gram(field, columns)? })
}

fn constants(plant: &Plant) -> BTreeSet<Symbol> {
    plant.parameters.iter().map(|p| p.symbol).collect()
}

/// The matrix without the common factors of each column as written, and of a square matrix those of each row, with
/// their powers.
fn without_common_factors(
    arena: &Arena,
    matrix: &[Vec<Expr>],
    rows_too: bool,
) -> (Vec<Vec<Expr>>, Vec<(Expr, Rational)>) {
    let mut rest = matrix.to_vec();
    let mut powers = Vec::new();
    if rows_too {
        for row in &mut rest {
            powers.extend(take_common(arena, row));
        }
    }
    for column in 0..rest.first().map_or(0, Vec::len) {
        let mut entries: Vec<Expr> = rest.iter().map(|row| row[column]).collect();
        powers.extend(take_common(arena, &mut entries));
        for (row, entry) in rest.iter_mut().zip(entries) {
            row[column] = entry;
        }
    }
    (rest, powers)
}

/// Takes their common factors out of the entries that are not zero.
pub(super) fn take_common(arena: &Arena, entries: &mut [Expr]) -> Vec<(Expr, Rational)> {
    let mut factors = entries.iter().filter(|e| !arena.is_zero(**e)).map(|e| factors(arena, *e));
    let Some(mut common) = factors.next() else { return Vec::new() };
    for factors in factors {
        common.retain_mut(|(base, power)| {
            let other = factors.iter().find(|(other, _)| other == base);
            // Only powers of one sign: of others nothing is common.
            match other.filter(|(_, other)| other.is_negative() == power.is_negative()) {
                Some((_, other)) => {
                    if other.abs() < power.abs() {
                        *power = other.clone();
                    }
                    true
                }
                None => false,
            }
        });
    }
    for entry in entries.iter_mut().filter(|e| !arena.is_zero(**e)) {
        let inverse = common.iter().map(|(base, power)| (*base, -power));
        *entry = arena.multiply(&Rational::ONE, inverse.chain([(*entry, Rational::ONE)]));
    }
    common
}

/// The factors of a product as it is written.
fn factors(arena: &Arena, expr: Expr) -> Vec<(Expr, Rational)> {
    match arena.node(expr) {
        Node::Product(product) => product.factors.clone(),
        Node::Number(_) => Vec::new(),
        _ => vec![(expr, Rational::ONE)],
    }
}

#[cfg(test)]
mod tests {
    use crate::analysis::{Derivation, Positive};
    use crate::model::Model;
    use crate::plant::Plant;
    use crate::source::Source;

    /// The conditions under which the regressor of p' and q' as functions of a and b, with b in q', loses rank; the
    /// root of the determinant.
    fn of(assume: &str, rate: &str) -> String {
        of_both(assume, [rate, "b"])
    }

    /// The same for a q' of any kind.
    fn of_both(assume: &str, [rate, other]: [&str; 2]) -> String {
        let text = format!(
            "model: m\nparameters: [k, l]\nx: [a, b]\ny: [p, q, w]\nu: [d, e]\nassume: [{assume}]\n\
             f_x: {{a: d, b: e}}\nf_y: {{p: {rate}, q: {other}, w: d}}\nphi: [a, b]\n"
        );
        let plant = Plant::resolve(&Model::parse(&Source::new("m", text).unwrap()).unwrap()).unwrap();
        let derivation = Derivation::derive(&plant);
        let result = derivation.identifiability.result.as_ref().expect("identifiable");
        let gram = result.gram.as_ref().expect("a determinant");
        let positive = gram.positive == Some(Positive::Assumed);
        let constants: Vec<String> = result.constants.iter().map(|e| plant.arena.print(*e)).collect();
        assert!(result.everywhere_else, "{rate}");
        assert_eq!(positive, result.singular_where.is_empty() && constants.is_empty(), "{rate}");
        let all = [result.singular_where.clone(), constants.iter().map(|e| format!("{e} != 0")).collect()].concat();
        format!("{} | {}", all.join(", "), plant.arena.print(gram.determinant))
    }

    #[test]
    fn factors_are_separated_and_nonzero_ones_dropped() {
        let phases = "(1 - d)*(1 - e)*a";
        assert_eq!(of("k > 0", phases), "d = 1, e = 1 | (1 - d)^2*(1 - e)^2");
        assert_eq!(of("0 < d < 1", phases), "e = 1 | (1 - d)^2*(1 - e)^2");
        assert_eq!(of("0 < d < 1, 0 < e < 1", phases), " | (1 - d)^2*(1 - e)^2");
        // As it comes out of sums.
        assert_eq!(of("0 < d < 1", "(1 - d - e + d*e)*a + d*b"), "e = 1 | (1 - d)^2*(e - 1)^2");
        assert_eq!(of("k > 0", "(d^2 - e^2)*a"), "d + e = 0, d - e = 0 | (d + e)^2*(d - e)^2");
        // A quotient is kept as written.
        assert_eq!(of("d > 0", "(1 - 1/d^2)*a"), "d = 1 | (1 - 1/d^2)^2");
        // The least power is common.
        let powers = of_both("k > 0", ["(1 - d)^2*a + (1 - d)*b", "a + b"]);
        assert_eq!(powers, "d = 0, d = 1 | d^2*(d - 1)^2");
        // The sine would be zero there too.
        assert!(of("sin(d) > 0", "(1 - cos(d))*a").starts_with(" | "));
        assert!(of("cos(d) > 0", "(1 - cos(d))*a").starts_with("cos(d) = 1 | "));
        // Parameters alone are no signal's business.
        assert_eq!(of("d > 0", "d*(k - l)*a"), "k - l != 0 | d^2*(k - l)^2");
    }

    #[test]
    fn a_zero_that_a_denominator_cancels_is_not_listed() {
        for (rate, determinant) in
            [("a/(1 + abs(w))", "1/(abs(w) + 1)^2"), ("a/(1 + sqrt(1 + w^2))", "1/(sqrt(w^2 + 1) + 1)^2")]
        {
            assert_eq!(of("k > 0", rate), format!(" | {determinant}"));
        }
        assert!(of("k > 0", "(1 + 1/(1 + abs(w)))*a").starts_with(" | "));
        assert!(of("k > 0", "(1 - abs(w))*a").starts_with("abs(w) = 1 | "));
        assert!(of("w > 0", "(sqrt(w) - 2)*a").starts_with("sqrt(w) = 2 | "));
        // 1/(1 + |w|) - 1/2 vanishes at both.
        let both = of("k > 0", "(1/(1 + abs(w)) - 1/2)*a");
        assert!(both.contains("w = 1") && both.contains("w = -1"), "{both}");
    }
}

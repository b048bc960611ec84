use proptest::prelude::*;

use super::{Monomial, Poly, PrimeField, Work};
use crate::{Integer, Rational};

fn work() -> Work {
    Work::new(1 << 40)
}

/// Coefficients of a few bits mostly, of a word, and of more than a word.
fn coefficient() -> impl Strategy<Value = Integer> {
    prop_oneof![
        6 => (-9_i64..10).prop_map(Integer::from),
        1 => any::<i64>().prop_map(Integer::from),
        1 => any::<i128>().prop_map(Integer::from),
    ]
}

/// Polynomials in some of the variables 0 to 8, the last few far apart, so that layouts differ.
pub(super) fn poly(terms: usize, degree: u32) -> impl Strategy<Value = Poly> {
    let variable = prop_oneof![5 => 0_u32..4, 1 => Just(17_u32), 1 => 30_u32..45];
    let exponent = prop_oneof![8 => 1..=degree, 1 => 1..=3 * degree];
    let monomial = prop::collection::btree_map(variable, exponent, 0..4).prop_map(Monomial::new);
    prop::collection::vec((monomial, coefficient()), 0..=terms)
        .prop_map(|terms| Poly::from_terms(terms).expect("small exponents"))
}

fn mul(a: &Poly, b: &Poly) -> Poly {
    a.mul(b, &work()).expect("small")
}

/// The product by its definition.
fn schoolbook(a: &Poly, b: &Poly) -> Poly {
    let terms = a.terms().flat_map(|(x, c)| {
        b.terms().map(move |(y, d)| {
            let mut powers = std::collections::BTreeMap::<u32, u32>::new();
            for (variable, exponent) in x.powers().iter().chain(y.powers()) {
                *powers.entry(*variable).or_default() += exponent;
            }
            (Monomial::new(powers), c * d)
        })
    });
    Poly::from_terms(terms).expect("small exponents")
}

fn coordinate(variable: u32) -> Rational {
    let variable = i64::from(variable);
    Rational::new(2 * variable - 5, variable + 3).expect("not zero")
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn a_coefficient_is_that_of_its_term(a in poly(8, 4), b in poly(8, 4)) {
        for (monomial, coefficient) in a.terms() {
            prop_assert_eq!(a.coefficient(&monomial), Some(coefficient));
        }
        for (monomial, _) in b.terms() {
            let term = a.terms().find(|(own, _)| *own == monomial);
            prop_assert_eq!(a.coefficient(&monomial), term.map(|(_, coefficient)| coefficient));
        }
    }

    #[test]
    fn ring_axioms(a in poly(12, 4), b in poly(12, 4), c in poly(12, 4)) {
        prop_assert_eq!(&a + &b, &b + &a);
        prop_assert_eq!(&(&a + &b) + &c, &a + &(&b + &c));
        prop_assert_eq!(&(&a - &b) + &b, a.clone());
        prop_assert_eq!(&a + &-&a, Poly::zero());
        prop_assert_eq!(mul(&a, &b), schoolbook(&a, &b));
        prop_assert_eq!(mul(&a, &(&b + &c)), &mul(&a, &b) + &mul(&a, &c));
        prop_assert_eq!(mul(&mul(&a, &b), &c), mul(&a, &mul(&b, &c)));
        prop_assert_eq!(mul(&a, &Poly::one()), a.clone());
        prop_assert_eq!(a.pow(3, &work()), Ok(mul(&a, &mul(&a, &a))));
        for poly in [&a, &(&a + &b), &(&a - &b), &mul(&a, &b)] {
            prop_assert!(poly.is_canonical());
            let terms = poly.terms().map(|(monomial, c)| (monomial, c.clone())).rev();
            prop_assert_eq!(&Poly::from_terms(terms).expect("small"), poly);
        }
    }

    #[test]
    fn quotients(a in poly(12, 4), b in poly(12, 4)) {
        let product = mul(&a, &b);
        if b.is_zero() {
            prop_assert_eq!(a.div_exact(&b, &work()), Ok(None));
        } else {
            prop_assert_eq!(product.div_exact(&b, &work()), Ok(Some(a.clone())));
            if !b.is_constant() {
                prop_assert_eq!((&product + &Poly::one()).div_exact(&b, &work()), Ok(None));
            }
            if let Some(quotient) = a.div_exact(&b, &work()).expect("small") {
                prop_assert_eq!(mul(&quotient, &b), a);
            }
        }
    }

    #[test]
    fn values(a in poly(12, 4), b in poly(12, 4)) {
        let at = |poly: &Poly| poly.evaluate(coordinate, &work()).expect("small");
        prop_assert_eq!(at(&(&a + &b)), &at(&a) + &at(&b));
        prop_assert_eq!(at(&mul(&a, &b)), &at(&a) * &at(&b));
        for prime in [7, 2_147_483_647, (1 << 61) - 1, (1 << 63) - 25] {
            let field = PrimeField::new(prime).expect("prime");
            let modulo = |poly: &Poly| {
                poly.evaluate_mod(&field, |v| field.from_u64(u64::from(v) * 77 + 12_345))
            };
            prop_assert_eq!(modulo(&(&a + &b)), field.add(modulo(&a), modulo(&b)));
            prop_assert_eq!(modulo(&mul(&a, &b)), field.mul(modulo(&a), modulo(&b)));
            let reduced = |v| field.from_rational(&coordinate(v));
            if a.variables().iter().all(|v| reduced(*v).is_some())
                && let Some(value) = field.from_rational(&at(&a))
            {
                let image = a.evaluate_mod(&field, |v| reduced(v).unwrap_or_default());
                prop_assert_eq!(image, value);
            }
        }
    }

    #[test]
    fn coefficients(a in poly(20, 4), set in prop::collection::vec(0_u32..4, 0..3)) {
        let parts = a.collect(&set);
        prop_assert!(parts.windows(2).all(|pair| pair[0].0 > pair[1].0));
        let mut sum = Poly::zero();
        for (monomial, part) in &parts {
            prop_assert!(!part.is_zero() && set.iter().all(|v| part.degree(*v) == 0));
            sum = &sum + &part.mul_term(monomial, &Integer::ONE, &work()).expect("small");
        }
        prop_assert_eq!(&sum, &a);
        let (content, primitive) = a.primitive();
        prop_assert_eq!(primitive.scale(&content), a.clone());
        prop_assert!(a.is_zero() || primitive.content().is_one());
        for variable in 0..4 {
            let leading = a.coefficients_in(variable).into_iter().next().unwrap_or_default();
            prop_assert_eq!(leading, (a.degree(variable), a.leading_coefficient_in(variable)));
        }
    }

    #[test]
    fn derivatives(a in poly(12, 4), b in poly(12, 4), v in 0_u32..4) {
        let product = &mul(&a.derivative(v), &b) + &mul(&a, &b.derivative(v));
        prop_assert_eq!(mul(&a, &b).derivative(v), product);
    }

    #[test]
    fn substitution(a in poly(8, 3), value in poly(4, 2), v in 0_u32..4, degree in 1_u32..4) {
        let replaced = a.substitute(v, &value, &work()).expect("small");
        let at = |variable| if variable == v {
            value.evaluate(coordinate, &work()).expect("small")
        } else {
            coordinate(variable)
        };
        prop_assert_eq!(replaced.evaluate(coordinate, &work()), a.evaluate(at, &work()));

        let value = value.substitute(v, &Poly::constant(2), &work()).expect("small");
        let reduced = a.reduce_power(v, degree, &value, &work()).expect("small");
        prop_assert!(reduced.degree(v) < degree);
        let relation = &Poly::variable(v).pow(degree, &work()).expect("small") - &value;
        prop_assert!((&a - &reduced).div_exact(&relation, &work()).expect("small").is_some());
    }

    #[test]
    fn square_roots(a in poly(8, 3), b in poly(8, 3)) {
        let square = mul(&a, &a);
        let root = square.sqrt_exact(&work()).expect("small").expect("a square");
        prop_assert!(root == a || root == -&a);
        prop_assert!(!root.leading_coefficient().is_negative());
        if let Some(root) = b.sqrt_exact(&work()).expect("small") {
            prop_assert_eq!(mul(&root, &root), b);
        }
        if !a.is_constant() {
            prop_assert_eq!((&square + &Poly::one()).sqrt_exact(&work()), Ok(None));
        }
    }
}

/// Polynomials in many variables, or with large exponents: keys of several words.
fn wide() -> impl Strategy<Value = Poly> {
    let few = prop::collection::btree_map(0_u32..3, 1_u32..70_000, 0..4);
    let many = prop::collection::btree_map(0_u32..60, 1_u32..9, 0..30);
    let terms = |monomial: BoxedStrategy<Monomial>| prop::collection::vec((monomial, coefficient()), 0..12);
    prop_oneof![terms(few.prop_map(Monomial::new).boxed()), terms(many.prop_map(Monomial::new).boxed())]
        .prop_map(|terms| Poly::from_terms(terms).expect("small exponents"))
}

proptest! {
    #[test]
    fn wide_keys(a in wide(), b in wide()) {
        let product = mul(&a, &b);
        prop_assert_eq!(&product, &schoolbook(&a, &b));
        prop_assert!(product.is_canonical());
        prop_assert_eq!(&(&product - &a) + &a, product.clone());
        if !b.is_zero() {
            prop_assert_eq!(product.div_exact(&b, &work()), Ok(Some(a.clone())));
            let other = &product + &Poly::variable(70);
            prop_assert_eq!(other.div_exact(&b, &work()).map(|q| q.is_some()), Ok(b.is_constant() && b.bits() < 2));
        }
    }
}

fn gcd(a: &Poly, b: &Poly) -> Poly {
    a.gcd(b, &work()).expect("small")
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn common_divisors(a in poly(8, 3), b in poly(8, 3), g in poly(8, 3)) {
        let (x, y) = (mul(&a, &g), mul(&b, &g));
        let common = gcd(&x, &y);
        if x.is_zero() && y.is_zero() {
            prop_assert!(common.is_zero());
        } else {
            let over = |poly: &Poly| poly.div_exact(&common, &work()).expect("small");
            prop_assert!(common.div_exact(&g, &work()).expect("small").is_some());
            let (Some(rest), Some(other)) = (over(&x), over(&y)) else {
                return Err(TestCaseError::fail("does not divide"));
            };
            prop_assert!(gcd(&rest, &other).is_one());
            prop_assert!(common.leading_coefficient().signum() > 0);
            prop_assert_eq!(&common, &gcd(&y, &x));
            let multiple = x.lcm(&y, &work()).expect("small");
            let product = mul(&x, &y);
            let again = mul(&multiple, &common);
            prop_assert!(again == product || again == -&product);
        }
    }

    #[test]
    fn square_free_parts(a in poly(4, 2), b in poly(4, 2), c in poly(3, 2)) {
        let product = mul(&a, &mul(&mul(&b, &b), &mul(&c, &mul(&c, &c))));
        let parts = product.square_free(&work()).expect("small");
        let mut again = Poly::constant(parts.content.clone());
        for (factor, exponent) in &parts.factors {
            again = mul(&again, &factor.pow(*exponent, &work()).expect("small"));
            for variable in factor.variables() {
                let common = gcd(factor, &factor.derivative(*variable));
                prop_assert_eq!(common.degree(*variable), 0);
            }
        }
        prop_assert_eq!(again, product);
        for (index, (factor, _)) in parts.factors.iter().enumerate() {
            for (other, _) in &parts.factors[..index] {
                prop_assert!(gcd(factor, other).is_one());
            }
        }
    }

    /// Without the factors free of the variables, and with every multiplicity, the product of the factors is the
    /// polynomial's.
    #[test]
    fn factors_in_variables(a in poly(4, 2), b in poly(4, 2), c in poly(3, 2)) {
        let inner = [0, 1];
        let mut rest = mul(&c, &mul(&a, &mul(&b, &b)));
        prop_assume!(!rest.is_zero());
        for factor in rest.clone().factors_in(&inner, &work()).expect("small") {
            prop_assert!(factor.variables().iter().any(|v| inner.contains(v)));
            let mut times = 0;
            while let Some(quotient) = rest.div_exact(&factor, &work()).expect("small") {
                (rest, times) = (quotient, times + 1);
            }
            prop_assert!(times > 0);
        }
        prop_assert!(rest.variables().iter().all(|v| !inner.contains(v)));
    }
}

/// Polynomials in the first few variables, so dense that common divisors take interpolation.
fn crowded() -> impl Strategy<Value = Poly> {
    let monomial = prop::collection::vec(0_u32..4, 4).prop_map(|exponents| Monomial::new((0..).zip(exponents)));
    prop::collection::vec((monomial, coefficient()), 2..12)
        .prop_map(|terms| Poly::from_terms(terms).expect("small exponents"))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn interpolated_divisors(a in crowded(), b in crowded(), g in crowded()) {
        let common = gcd(&mul(&a, &g), &mul(&b, &g));
        let rest = common.div_exact(&gcd(&a, &b), &work()).expect("small").expect("divides");
        prop_assert!(rest == g.primitive().1.scale(&g.content()));
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    /// Factors multiply to the polynomial, and are found however they share their variables.
    #[test]
    fn factors_for_a_reader(a in poly(3, 2), b in poly(3, 2), c in poly(3, 1)) {
        let product = mul(&a, &mul(&b, &mul(&b, &c)));
        let parts = product.factored(&work()).expect("small");
        let mut again = Poly::constant(parts.content.clone());
        for (index, (factor, exponent)) in parts.factors.iter().enumerate() {
            prop_assert!(!factor.is_constant());
            prop_assert_eq!(factor, &factor.primitive().1);
            again = mul(&again, &factor.pow(*exponent, &work()).expect("small"));
            for (other, _) in &parts.factors[..index] {
                prop_assert!(gcd(factor, other).is_one());
            }
        }
        prop_assert_eq!(again, product);
    }
}

#[test]
fn factors_that_are_linear_in_a_variable_are_found() {
    let [a, b, c, d] = [0, 1, 2, 3].map(Poly::variable);
    let one = Poly::one();
    let product = |factors: &[Poly]| factors.iter().fold(Poly::one(), |product, factor| mul(&product, factor));
    let vandermonde: Vec<Poly> =
        [(&a, &b), (&a, &c), (&a, &d), (&b, &c), (&b, &d), (&c, &d)].map(|(v, w)| v - w).to_vec();
    for factors in [
        vec![&one - &a, &one - &b],
        vec![&a - &b, &a + &b],
        vec![&mul(&a, &b) - &c, &mul(&a, &c) + &b, &a - &one],
        vandermonde,
        // Irreducible, of degree two in each variable.
        vec![&(&mul(&a, &a) + &mul(&b, &b)) + &one, &a - &one],
        vec![&a.scale(&Integer::from(3)) - &b, &a.scale(&Integer::from(7)) + &c, &(&a + &b) + &c],
    ] {
        let found = product(&factors).factored(&work()).expect("small");
        let mut shown: Vec<String> = found.factors.iter().map(|(factor, _)| factor.to_string()).collect();
        let mut expected: Vec<String> = factors.iter().map(|factor| factor.primitive().1.to_string()).collect();
        shown.sort();
        expected.sort();
        assert_eq!(shown, expected);
        assert!(found.factors.iter().all(|(_, exponent)| *exponent == 1));
    }
}

/// The sum of the products of all variables but one: its leading coefficient in any variable is of
/// the same kind, one variable less.
fn all_but_one(count: u32) -> Poly {
    let product = |left_out| (0..count).filter(move |v| *v != left_out).map(|v| (v, 1));
    let terms = (0..count).map(|left_out| (Monomial::new(product(left_out)), Integer::ONE));
    Poly::from_terms(terms).expect("linear")
}

#[test]
fn leading_coefficients_nest_deep() {
    let g = all_but_one(120);
    let (a, b) = (&Poly::variable(3) + &Poly::one(), &Poly::variable(4) + &Poly::constant(2));
    assert_eq!(gcd(&mul(&a, &g), &mul(&b, &g)), g);
}

#[test]
fn coefficients_of_many_words() {
    let huge = |seed: i64| Integer::from(seed).pow(200);
    let poly = |seed: i64| {
        let terms = (0..4).map(|k| (Monomial::new([(0, k), (1, 3 - k)]), huge(seed + i64::from(k))));
        Poly::from_terms(terms).expect("small exponents")
    };
    let (a, b, g) = (poly(3), poly(17), poly(30));
    assert_eq!(gcd(&mul(&a, &g), &mul(&b, &g)), g.primitive().1);
    assert_eq!(mul(&a, &g).div_exact(&g, &work()), Ok(Some(a)));
}

#[test]
fn shown() {
    let terms = [
        (Monomial::new([(2, 1), (0, 2)]), Integer::from(-3)),
        (Monomial::one(), Integer::from(1)),
        (Monomial::new([(2, 1)]), Integer::from(1)),
    ];
    let poly = Poly::from_terms(terms).expect("small");
    assert_eq!(poly.to_string(), "-3*x0^2*x2 + x2 + 1");
    assert_eq!(Poly::zero().to_string(), "0");
}

#[test]
fn monomials_order_as_keys_do() {
    let monomials = [
        Monomial::one(),
        Monomial::new([(1, 1)]),
        Monomial::new([(1, 2)]),
        Monomial::new([(0, 1)]),
        Monomial::new([(0, 1), (1, 3)]),
        Monomial::new([(0, 2)]),
    ];
    assert!(monomials.is_sorted());
    let terms = monomials.iter().map(|monomial| (monomial.clone(), Integer::ONE));
    let poly = Poly::from_terms(terms).expect("small");
    assert!(poly.terms().rev().map(|(monomial, _)| monomial).eq(monomials));
}

#[test]
fn limits() {
    let x = Poly::variable(0);
    let sum = &x + &Poly::one();
    assert!(sum.pow(1_000_000, &Work::new(100_000)).is_err());
    assert!(Poly::constant(3).pow(u32::MAX, &Work::new(1000)).is_err());
    let large = x.pow(i32::MAX.cast_unsigned(), &work()).expect("a single term");
    assert!(large.mul(&x, &work()).is_err());
    assert!(Poly::from_terms([(Monomial::new([(0, u32::MAX)]), Integer::ONE)]).is_err());
    let many = (0..600).fold(Poly::one(), |sum, v| &sum + &Poly::variable(v));
    assert_eq!(many.term_count(), 601);
    assert!(many.mul(&many, &work()).is_err());
    let some = (0..200).fold(Poly::one(), |sum, v| &sum + &Poly::variable(v));
    assert_eq!(mul(&some, &some).sqrt_exact(&work()), Ok(Some(some)));
}

//! Solving equations for unknown symbols, where elimination and inverse functions suffice.
//!
//! In: equations `formula(unknowns) = value`. Out: candidates for the unknowns in the values. Nothing is claimed of a
//! candidate; the caller proves it.
//!
//! An equation with a single occurrence of the unknown is inverted operation by operation. If none is left, the
//! equations are taken as linear in the kernels that hold unknowns (`p`, `sin(q)`, `exp(x)`, `x^3`) and eliminated; the
//! resulting kernels are inverted: a sine and a cosine of one angle give `atan2`, and products are separated
//! (`monomials`). The remaining equation in one unknown may be quadratic (`quadratic`). Known terms are opaque at
//! first ([`crate::forms::opaque`]), and only then expanded, for results that need a relation within them.

pub mod elimination;

pub mod cleared;
mod equation;
mod monomials;
mod quadratic;

use std::collections::{BTreeMap, BTreeSet};

use super::linear::{Echelon, Matrix};
use super::poly::Monomial;
use super::{Arena, Expr, Node, Symbol};
use crate::forms::opaque::OpaqueTerms;
use crate::forms::tidy::shorter;
use crate::graph::function::Function;
use crate::number::interval::Precision;
use crate::tower::{Field, Fraction, Obstacle};
use crate::{Domain, Rational};
use equation::{Inverse, angle_of, uncall, unpower};

pub use cleared::cleared;
pub use equation::Equation;

/// Candidates for those unknowns that the equations give, the likelier first.
pub fn solve(
    arena: &Arena,
    domain: &Domain,
    equations: &[Equation],
    unknowns: &[Symbol],
) -> Result<BTreeMap<Symbol, Vec<Expr>>, Obstacle> {
    let mut alone: BTreeMap<Symbol, Expr> = BTreeMap::new();
    let turned_out = |equation: &Equation| turned_out(arena, domain, *equation, unknowns);
    let mut turned: Vec<Equation> = equations.iter().map(turned_out).collect();
    let apart = monomials::apart(arena, domain, &turned);
    let apart: Vec<Equation> = apart.iter().map(|inverse| turned_out(&inverse.equation)).collect();
    turned.extend(apart);
    for Equation { formula, value } in &turned {
        if let Some(symbol) = arena.as_symbol(*formula) {
            alone.entry(symbol).and_modify(|known| *known = shorter(arena, *known, *value)).or_insert(*value);
        }
    }
    let mut candidates: BTreeMap<Symbol, Vec<Expr>> = BTreeMap::new();
    // All equations combined determine branches that a single one does not: cosine and sine, but not cosine. A value
    // that an equation gives directly loses no digits.
    let given = |equation: &Equation| Some((arena.as_symbol(equation.formula)?, equation.value));
    let given = equations.iter().rev().filter_map(given).filter(|(symbol, _)| unknowns.contains(symbol)).collect();
    let starts = [given, alone];
    let mut add = |found: BTreeMap<Symbol, Expr>| {
        for (symbol, value) in found {
            let known = candidates.entry(symbol).or_default();
            if !known.contains(&value) {
                known.push(value);
            }
        }
    };
    for start in &starts {
        // Results that need a relation among known terms may be out of reach while these are opaque.
        if let Ok(found) = eliminated(arena, domain, equations, unknowns, start.clone(), Reading::Written) {
            add(found);
        }
    }
    for start in &starts {
        add(eliminated(arena, domain, equations, unknowns, start.clone(), Reading::Normal)?);
    }
    // Inverted as far as possible: `p/(1 - p) = exp(z)` for `log(p/(1 - p)) = z`.
    let [given, _] = starts;
    if unknowns.iter().any(|unknown| !candidates.contains_key(unknown)) {
        for (symbol, value) in eliminated(arena, domain, &turned, unknowns, given, Reading::Normal).unwrap_or_default()
        {
            candidates.entry(symbol).or_default().push(value);
        }
    }
    let all = [equations, &turned].concat();
    for (symbol, values) in by_roots(arena, domain, &all, unknowns, &candidates) {
        candidates.entry(symbol).or_default().extend(values);
    }
    Ok(candidates)
}

/// The unknowns that equations in one unknown give by a quadratic equation, and further unknowns by these.
fn by_roots(
    arena: &Arena,
    domain: &Domain,
    equations: &[Equation],
    unknowns: &[Symbol],
    candidates: &BTreeMap<Symbol, Vec<Expr>>,
) -> BTreeMap<Symbol, Vec<Expr>> {
    let mut known: BTreeMap<Symbol, Expr> = candidates.iter().map(|(symbol, values)| (*symbol, values[0])).collect();
    let mut found: BTreeMap<Symbol, Vec<Expr>> = BTreeMap::new();
    while known.len() < unknowns.len() {
        let open: BTreeSet<Symbol> = unknowns.iter().copied().filter(|symbol| !known.contains_key(symbol)).collect();
        let differences: Vec<Expr> = equations.iter().map(|e| arena.sub(e.formula, e.value)).collect();
        let mut differences = arena.substitute_all(&differences, &known);
        differences.extend(without_one(arena, &differences, &open));
        let mut roots = Vec::new();
        for difference in differences {
            let unknown: Vec<Symbol> = arena.symbols_of(&[difference]).intersection(&open).copied().collect();
            let [unknown] = unknown.as_slice() else { continue };
            for root in quadratic::roots(arena, domain, difference, *unknown).unwrap_or_default() {
                let Equation { formula, value } = turned_out(arena, domain, root, &[*unknown]);
                if arena.as_symbol(formula) == Some(*unknown) && fits(arena, domain, equations, *unknown, value) {
                    roots.push((*unknown, value));
                }
            }
        }
        let Some((unknown, value)) = roots.first().copied() else { break };
        known.insert(unknown, value);
        found.insert(unknown, roots.iter().filter(|root| root.0 == unknown).map(|root| root.1).collect());
        let rest = eliminated(arena, domain, equations, unknowns, known.clone(), Reading::Normal).unwrap_or_default();
        for (symbol, value) in rest {
            if known.insert(symbol, value).is_none() {
                found.insert(symbol, vec![value]);
            }
        }
    }
    found
}

/// One of two differences in two unknowns, after elimination of an unknown that is a summand of the other.
fn without_one(arena: &Arena, differences: &[Expr], open: &BTreeSet<Symbol>) -> Vec<Expr> {
    let mut found = Vec::new();
    for difference in differences {
        let Node::Sum(sum) = arena.node(*difference) else { continue };
        let single = |(term, slope): &(Expr, Rational)| Some((arena.as_symbol(*term)?, slope.recip()?));
        for (unknown, factor) in sum.terms.iter().filter_map(single).filter(|(symbol, _)| open.contains(symbol)) {
            let value = arena.sub(arena.of_symbol(unknown), arena.scale(*difference, &factor));
            if !arena.depends_on(value, &BTreeSet::from([unknown])) {
                let others = differences.iter().filter(|other| *other != difference);
                let map = BTreeMap::from([(unknown, value)]);
                found.extend(others.map(|other| arena.substitute(*other, &map)));
            }
        }
    }
    found
}

/// True if a value may be that of the unknown: at points of the domain it is not another.
fn fits(arena: &Arena, domain: &Domain, equations: &[Equation], unknown: Symbol, value: Expr) -> bool {
    const POINTS: usize = 3;
    let meaning = equations.iter().filter_map(|e| Some((arena.as_symbol(e.value)?, e.formula))).collect();
    let error = arena.sub(arena.substitute(value, &meaning), arena.of_symbol(unknown));
    let at = |point| arena.enclose_all(&[error], &point, Precision::new(64));
    let values: Vec<_> = domain.points(arena, &[error]).take(2 * POINTS).filter_map(at).take(POINTS).collect();
    !values.is_empty() && values.iter().all(|value| value[0].contains_zero())
}

/// The treatment of terms free of the unknowns in elimination.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Reading {
    /// Opaque.
    Written,
    /// In the normal form.
    Normal,
}

/// Eliminates and inverts until no further unknown results.
fn eliminated(
    arena: &Arena,
    domain: &Domain,
    equations: &[Equation],
    unknowns: &[Symbol],
    mut found: BTreeMap<Symbol, Expr>,
    reading: Reading,
) -> Result<BTreeMap<Symbol, Expr>, Obstacle> {
    let mut differences: Vec<Expr> = equations.iter().map(|e| arena.sub(e.formula, e.value)).collect();
    differences = arena.substitute_all(&differences, &found);
    // Every continued pass finds an unknown or replaces a kernel by its argument.
    for _ in 0..(2 * unknowns.len() + 2) {
        let open: BTreeSet<Symbol> = unknowns.iter().copied().filter(|s| !found.contains_key(s)).collect();
        differences.retain(|d| arena.depends_on(*d, &open));
        if open.is_empty() || differences.is_empty() {
            break;
        }
        let known = eliminate(arena, domain, &differences, &open, reading)?;
        // Of a product the sign of a factor is known, of its square it is not.
        let (unique, others): (Vec<_>, Vec<_>) =
            invert(arena, domain, &known).into_iter().partition(|inverse| inverse.is_unique);
        let mut progress = false;
        for inverses in [unique, others].into_iter().filter(|inverses| !inverses.is_empty()) {
            let before = differences.len();
            for Inverse { equation: Equation { formula, value }, .. } in inverses {
                match arena.as_symbol(formula) {
                    Some(symbol) if open.contains(&symbol) => {
                        progress = true;
                        found.entry(symbol).or_insert(value);
                    }
                    _ => {
                        let difference = arena.sub(formula, value);
                        if !differences.contains(&difference) {
                            differences.push(difference);
                        }
                    }
                }
            }
            progress |= differences.len() > before;
            if progress {
                break;
            }
        }
        if !progress {
            break;
        }
        differences = arena.substitute_all(&differences, &found);
    }
    Ok(found)
}

/// The equation inverted as far as the unknowns occur once: with one unknown in one place, to the unknown itself.
fn turned_out(arena: &Arena, domain: &Domain, mut equation: Equation, unknowns: &[Symbol]) -> Equation {
    let open: BTreeSet<Symbol> = unknowns.iter().copied().collect();
    while let Some(inner) = turned_once(arena, domain, equation, &open) {
        equation = inner;
    }
    equation
}

/// Removes the outermost operation around the single occurrence of unknowns.
fn turned_once(arena: &Arena, domain: &Domain, equation: Equation, open: &BTreeSet<Symbol>) -> Option<Equation> {
    let Equation { formula, value } = equation;
    let alone = |e: &Expr| arena.depends_on(*e, open);
    match arena.node(formula) {
        Node::Sum(sum) => {
            let (inner, rest): (Vec<_>, Vec<_>) = sum.terms.iter().cloned().partition(|(t, _)| alone(t));
            let [(term, slope)] = inner.as_slice() else { return None };
            let rest = arena.combine(&sum.constant, rest);
            Some(Equation { formula: *term, value: arena.scale(arena.sub(value, rest), &slope.recip()?) })
        }
        Node::Product(product) => {
            let (inner, rest): (Vec<_>, Vec<_>) = product.factors.iter().cloned().partition(|(b, _)| alone(b));
            let [(base, exponent)] = inner.as_slice() else { return None };
            let rest = arena.multiply(&product.coefficient, rest);
            unpower(arena, domain, *base, exponent, arena.div(value, rest)).map(|inverse| inverse.equation)
        }
        Node::Call(function, arguments) => {
            let [inside] = arguments.as_ref() else { return None };
            uncall(arena, domain, function, *inside, value).map(|inverse| inverse.equation)
        }
        Node::Symbol(_) | Node::Number(_) | Node::Pi => None,
    }
}

/// The monomials in unknown kernels that linear elimination determines, with their values.
fn eliminate(
    arena: &Arena,
    domain: &Domain,
    differences: &[Expr],
    open: &BTreeSet<Symbol>,
    reading: Reading,
) -> Result<Vec<Equation>, Obstacle> {
    let mut opaque = OpaqueTerms::new(arena, open);
    let differences = match reading {
        Reading::Written => opaque.replace(differences),
        Reading::Normal => differences.to_vec(),
    };
    let field = Field::over(arena, &domain.facts, &differences)?;
    let hidden: Vec<u32> = field.kernels_of(open).into_iter().collect();
    let mut rows: Vec<BTreeMap<Monomial, Fraction>> = Vec::new();
    let mut columns: BTreeSet<Monomial> = BTreeSet::new();
    for difference in &differences {
        let mut row = BTreeMap::new();
        for (monomial, coefficient) in field.fraction(*difference)?.numerator().collect(&hidden) {
            if !monomial.is_one() {
                columns.insert(monomial.clone());
            }
            row.insert(monomial, field.of_polynomial(&coefficient)?);
        }
        rows.push(row);
    }
    // Heavier monomials first, so that lighter ones remain when there are fewer equations.
    let mut columns: Vec<Monomial> = columns.into_iter().collect();
    columns.sort_by_key(|monomial| std::cmp::Reverse(monomial.degree()));
    let matrix = rows
        .into_iter()
        .map(|mut row| {
            let mut entries: Vec<Fraction> =
                columns.iter().map(|m| row.remove(m).unwrap_or_else(Fraction::zero)).collect();
            entries.push(row.remove(&Monomial::one()).unwrap_or_else(Fraction::zero).opposite());
            entries
        })
        .collect();
    let (echelon, _) = Echelon::of(&field, Matrix::new(matrix), columns.len())?;
    let mut known = Vec::new();
    for (pivot, row) in echelon.determined() {
        let factors = columns[pivot].powers().iter().map(|&(k, e)| (field.kernel(k), Rational::from(i64::from(e))));
        let formula = arena.multiply(&Rational::ONE, factors);
        let value = opaque.restore(field.show(&row[columns.len()]));
        known.push(Equation { formula: opaque.restore(formula), value });
    }
    Ok(known)
}

/// Inverts the outermost function of known kernels; values known without inversion come first: `a` rather than the root
/// of `a^2`.
fn invert(arena: &Arena, domain: &Domain, known: &[Equation]) -> Vec<Inverse> {
    let (symbols, others): (Vec<Equation>, Vec<Equation>) =
        known.iter().copied().partition(|equation| arena.as_symbol(equation.formula).is_some());
    let mut inverted: Vec<Inverse> = symbols.into_iter().map(Inverse::unique).collect();
    for Equation { formula, value } in others {
        let next = match arena.node(formula) {
            Node::Product(product) => match product.factors.as_slice() {
                [(base, exponent)] => unpower(arena, domain, *base, exponent, value),
                _ => None,
            },
            Node::Call(function, arguments) => {
                let inside = arguments[0];
                let alone = || uncall(arena, domain, function, inside, value);
                match function {
                    Function::Cos => match beside(arena, known, Function::Sin, inside) {
                        Some(sin) => {
                            let angle = angle_of(arena, domain, sin, value);
                            Some(Inverse::unique(Equation { formula: inside, value: angle }))
                        }
                        None => alone(),
                    },
                    // With its cosine known, the angle comes from both.
                    Function::Sin if beside(arena, known, Function::Cos, inside).is_some() => None,
                    _ => alone(),
                }
            }
            _ => None,
        };
        inverted.extend(next);
    }
    inverted.extend(monomials::apart(arena, domain, known));
    inverted
}

/// The known value of another function of the same argument.
fn beside(arena: &Arena, known: &[Equation], function: Function, inside: Expr) -> Option<Expr> {
    let wanted = arena.call(function, &[inside]);
    known.iter().find(|e| e.formula == wanted).map(|e| e.value)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Relation;

    /// The likeliest value for the first unknown.
    fn solved(arena: &Arena, domain: &Domain, formulas: &[Expr], unknown: Expr) -> String {
        let name = |index: usize| arena.variable(&format!("z{}", index + 1));
        let equation = |(index, formula): (usize, &Expr)| Equation { formula: *formula, value: name(index) };
        let equations: Vec<Equation> = formulas.iter().enumerate().map(equation).collect();
        let unknowns: Vec<Symbol> = arena.symbols_of(&[unknown]).into_iter().collect();
        let candidates = solve(arena, domain, &equations, &unknowns).unwrap();
        arena.print(candidates[&unknowns[0]][0])
    }

    #[test]
    fn even_functions_have_the_branch_of_their_argument() {
        let arena = Arena::new();
        let p = arena.variable("p");
        let cosine = [arena.call(Function::Cos, &[p])];
        for (positive, expected) in [(p, "acos(z1)"), (arena.neg(p), "-acos(z1)")] {
            let mut domain = Domain::default();
            domain.facts.assume(positive, Relation::Positive);
            assert_eq!(solved(&arena, &domain, &cosine, p), expected);
        }
    }

    #[test]
    fn known_terms_are_opaque() {
        let arena = Arena::new();
        let [_, p, q, r, k] = ["z1", "p", "q", "r", "k"].map(|name| arena.variable(name));
        let mut domain = Domain::default();
        domain.facts.assume(p, Relation::Positive);
        let power = |base, exponent: i64| arena.power(base, &Rational::from(exponent));
        let call = |function, argument| arena.call(function, &[argument]);
        let one = arena.one();
        let offset = arena.sub(q, r);
        let cases = [
            // Powers of a difference.
            (arena.add(p, power(arena.sub(q, arena.number(300)), 3)), "z1 - (q - 300)^3"),
            (arena.add(p, arena.mul(k, power(offset, 2))), "z1 - k*(q - r)^2"),
            (arena.mul(p, arena.mul(power(offset, 2), arena.add(q, r))), "z1/((q - r)^2*(q + r))"),
            // Functions of a sum.
            (arena.sub(call(Function::Log, arena.add(one, p)), power(q, 2)), "exp(z1 + q^2) - 1"),
            (arena.add(call(Function::Asin, p), q), "sin(z1 - q)"),
            (arena.sub(arena.sqrt(arena.add(one, power(p, 2))), power(q, 2)), "sqrt((z1 + q^2)^2 - 1)"),
            // The unknown in two places.
            (arena.add(arena.div(p, arena.add(p, one)), call(Function::Sin, q)), "(z1 - sin(q))/(1 - z1 + sin(q))"),
        ];
        for (formula, expected) in cases {
            assert_eq!(solved(&arena, &domain, &[formula], p), expected);
        }
    }

    #[test]
    fn quadratics_are_solved_for_the_root_of_the_domain_without_losing_its_digits() {
        let arena = Arena::new();
        let [p, b] = ["p", "b"].map(|name| arena.variable(name));
        let mut domain = Domain::default();
        domain.facts.assume(p, Relation::Positive);
        domain.facts.assume(b, Relation::Positive);
        let (one, square) = (arena.one(), arena.mul(p, p));
        let call = |function, argument| arena.call(function, &[argument]);
        let cases = [
            (arena.add(square, arena.mul(b, p)), "2*z1/(b + sqrt(4*z1 + b^2))"),
            (arena.add(p, arena.sqrt(p)), "2*z1^2/(2*z1 + sqrt(4*z1 + 1) + 1)"),
            (arena.div(p, arena.sqrt(arena.add(one, square))), "z1/sqrt(1 - z1^2)"),
            (arena.add(arena.mul(square, square), square), "sqrt(2*z1/(sqrt(4*z1 + 1) + 1))"),
            (call(Function::Log, arena.div(p, arena.add(one, p))), "-exp(z1)/(exp(z1) - 1)"),
            (call(Function::Sinh, p), "asinh(z1)"),
        ];
        for (formula, expected) in cases {
            assert_eq!(solved(&arena, &domain, &[formula], p), expected, "{}", arena.print(formula));
        }
    }

    #[test]
    fn products_are_separated() {
        let arena = Arena::new();
        let [p, s] = ["p", "s"].map(|name| arena.variable(name));
        let mut domain = Domain::default();
        domain.facts.assume(p, Relation::Positive);
        domain.facts.assume(s, Relation::Positive);
        let turned = |function| arena.mul(s, arena.call(function, &[p]));
        let product = arena.mul(p, s);
        let cases = [
            ([turned(Function::Sin), turned(Function::Cos)], "atan2(z1, z2)", "sqrt(z1^2 + z2^2)"),
            ([product, arena.mul(product, s)], "z1^2/z2", "z2/z1"),
            ([product, arena.div(p, s)], "sqrt(z1*z2)", "1/sqrt(z2/z1)"),
            ([arena.add(p, s), product], "(z1 + sqrt(z1^2 - 4*z2))/2", "2*z2/(z1 + sqrt(z1^2 - 4*z2))"),
        ];
        for (formulas, first, second) in cases {
            // The first of two numbers with given sum and product is the larger.
            let mut domain = domain.clone();
            domain.facts.assume(arena.sub(p, s), Relation::Positive);
            let equation = |(formula, z): (&Expr, &str)| Equation { formula: *formula, value: arena.variable(z) };
            let equations: Vec<Equation> = formulas.iter().zip(["z1", "z2"]).map(equation).collect();
            let unknowns = [p, s].map(|unknown| arena.as_symbol(unknown).unwrap());
            let candidates = solve(&arena, &domain, &equations, &unknowns).unwrap();
            assert_eq!(unknowns.map(|unknown| arena.print(candidates[&unknown][0])), [first, second]);
        }
    }

    #[test]
    fn an_unknown_by_itself_is_not_taken_from_a_power() {
        let arena = Arena::new();
        let p = arena.variable("p");
        let mut domain = Domain::default();
        domain.facts.assume(p, Relation::Positive);
        let power = |exponent: i64| arena.power(p, &Rational::from(exponent));
        assert_eq!(solved(&arena, &domain, &[power(2), p], p), "z2");
        assert_eq!(solved(&arena, &domain, &[power(3), power(2)], p), "z1^(1/3)");
        assert_eq!(solved(&arena, &domain, &[arena.add(power(3), p), p, power(3)], p), "z2");
    }

    /// The sign of a factor is that of its product with a positive one; its square has none.
    #[test]
    fn a_product_determines_a_sign_before_a_square_does_not() {
        let arena = Arena::new();
        let [p, s] = ["p", "s"].map(|name| arena.variable(name));
        let mut domain = Domain::default();
        domain.facts.assume(p, Relation::Positive);
        let squares = [p, s].map(|factor| arena.mul(factor, factor));
        let formulas = [squares[1], arena.mul(p, s), squares[0]];
        let equation = |(formula, z): (&Expr, &str)| Equation { formula: *formula, value: arena.variable(z) };
        let equations: Vec<Equation> = formulas.iter().zip(["z1", "z2", "z3"]).map(equation).collect();
        let unknowns = [p, s].map(|unknown| arena.as_symbol(unknown).unwrap());
        let candidates = solve(&arena, &domain, &equations, &unknowns).unwrap();
        assert_eq!(unknowns.map(|unknown| arena.print(candidates[&unknown][0])), ["sqrt(z3)", "z2/sqrt(z3)"]);
    }

    #[test]
    fn a_relation_within_what_is_known_is_found() {
        let arena = Arena::new();
        let [p, s, q] = ["p", "s", "q"].map(|name| arena.variable(name));
        // (q - 1)*(q + 1) is q^2 - 1: of the two equations only the difference is independent of s.
        let product = arena.mul(arena.sub(q, arena.one()), arena.add(q, arena.one()));
        let square = arena.sub(arena.mul(q, q), arena.one());
        let formulas = [arena.add(arena.mul(product, s), p), arena.mul(square, s)];
        let unknowns: Vec<Symbol> = [p, s].into_iter().filter_map(|e| arena.as_symbol(e)).collect();
        let equations: Vec<Equation> = formulas
            .iter()
            .zip(["z1", "z2"])
            .map(|(f, z)| Equation { formula: *f, value: arena.variable(z) })
            .collect();
        let domain = Domain::default();
        let candidates = solve(&arena, &domain, &equations, &unknowns).unwrap();
        let shown: Vec<String> = candidates[&unknowns[0]].iter().map(|e| arena.print(*e)).collect();
        assert!(shown.contains(&"z1 - z2".to_owned()), "{shown:?}");
    }
}

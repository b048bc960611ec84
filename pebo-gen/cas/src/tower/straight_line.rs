//! Residues of formulas as they are written, where only values are needed and the normal form would be long.
//!
//! ```text
//! formulas -> sums, products and whole powers of atoms; the field of the atoms -> values of kernels -> residues
//! ```
//!
//! In: formulas that share subexpressions. Out: the field of their atoms, and for values of its kernels a residue of
//! each formula. Holds after: a residue is that of the formula's fraction; if the formula divides by zero there is
//! none, even if the fraction has one.

use std::collections::BTreeSet;

use rustc_hash::FxHashMap;

use super::{Field, Fraction, Obstacle};
use crate::poly::{PrimeField, Residue};
use crate::{Arena, Expr, Facts, Node, Rational};

/// An instruction: a value computed from earlier ones, which are named by their positions.
#[derive(Debug)]
enum Instruction {
    Sum(Residue, Vec<(usize, Residue)>),
    Product(Residue, Vec<(usize, Power)>),
}

/// An integer power: the exponent's absolute value, and true if it divides.
#[derive(Clone, Copy, Debug)]
struct Power {
    exponent: u64,
    divides: bool,
}

/// A program that evaluates formulas modulo the prime for which they were compiled.
#[derive(Debug)]
pub struct StraightLineProgram<'a> {
    field: Field<'a>,
    /// Symbols, functions and roots, whose values come first.
    atoms: Vec<Fraction>,
    instructions: Vec<Instruction>,
    /// The position of each formula's value.
    values: Vec<usize>,
}

impl<'a> StraightLineProgram<'a> {
    /// Compiles formulas for values modulo a prime.
    pub fn of(arena: &'a Arena, facts: &Facts, prime: &PrimeField, formulas: &[Expr]) -> Result<Self, Obstacle> {
        let (atoms, compounds) = parts(arena, formulas);
        let field = Field::over(arena, facts, &atoms)?;
        let fractions = atoms.iter().map(|atom| field.fraction(*atom)).collect::<Result<_, _>>()?;
        let places: FxHashMap<Expr, usize> = atoms.iter().chain(&compounds).copied().zip(0..).collect();
        let instruction = |compound: &Expr| instruction(arena, prime, *compound, &places).ok_or(Obstacle::TooLarge);
        let instructions = compounds.iter().map(instruction).collect::<Result<_, _>>()?;
        let values = formulas.iter().map(|formula| places[formula]).collect();
        Ok(Self { field, atoms: fractions, instructions, values })
    }

    /// The field of the atoms.
    pub fn field(&self) -> &Field<'a> {
        &self.field
    }

    /// The number of values computed for the residues.
    pub fn length(&self) -> usize {
        self.atoms.len() + self.instructions.len()
    }

    /// The residues of all formulas; none if one divides by zero.
    pub fn residues(&self, prime: &PrimeField, kernels: &[Residue]) -> Option<Vec<Residue>> {
        let mut values = Vec::with_capacity(self.length());
        for atom in &self.atoms {
            values.push(atom.residue(prime, kernels)?);
        }
        for instruction in &self.instructions {
            values.push(instruction.value(prime, &values)?);
        }
        Some(self.values.iter().map(|place| values[*place]).collect())
    }
}

impl Instruction {
    fn value(&self, prime: &PrimeField, values: &[Residue]) -> Option<Residue> {
        match self {
            Self::Sum(constant, terms) => {
                let add = |sum, (place, factor): &(usize, Residue)| prime.add(sum, prime.mul(values[*place], *factor));
                Some(terms.iter().fold(*constant, add))
            }
            Self::Product(coefficient, factors) => {
                let mut factors = factors.iter();
                factors.try_fold(*coefficient, |product, (place, power)| {
                    let base = prime.pow(values[*place], power.exponent);
                    Some(prime.mul(product, if power.divides { prime.inv(base)? } else { base }))
                })
            }
        }
    }
}

/// A factor of a product as an integer power of its base, or of the root that it is.
fn factor(arena: &Arena, base: Expr, exponent: &Rational) -> (Expr, Power) {
    match exponent.to_i64() {
        Some(exponent) => (base, Power { exponent: exponent.unsigned_abs(), divides: exponent < 0 }),
        None => (arena.power(base, exponent), Power { exponent: 1, divides: false }),
    }
}

/// The subexpressions of formulas: atoms, and the sums and products of them, each after its operands.
fn parts(arena: &Arena, formulas: &[Expr]) -> (Vec<Expr>, Vec<Expr>) {
    let (mut atoms, mut compounds) = (BTreeSet::new(), BTreeSet::new());
    let mut open = formulas.to_vec();
    while let Some(expr) = open.pop() {
        let operands: Vec<Expr> = match arena.node(expr) {
            Node::Sum(sum) => sum.terms.iter().map(|(term, _)| *term).collect(),
            Node::Product(product) => {
                let bases = product.factors.iter().map(|(base, exponent)| factor(arena, *base, exponent).0);
                bases.filter(|base| *base != expr).collect()
            }
            _ => Vec::new(),
        };
        if operands.is_empty() {
            atoms.insert(expr);
        } else if compounds.insert(expr) {
            open.extend(operands);
        }
    }
    (atoms.into_iter().collect(), compounds.into_iter().collect())
}

/// The instruction for a sum or product of its operands; none if a number has no residue.
fn instruction(
    arena: &Arena,
    prime: &PrimeField,
    compound: Expr,
    places: &FxHashMap<Expr, usize>,
) -> Option<Instruction> {
    match arena.node(compound) {
        Node::Sum(sum) => {
            let terms = sum.terms.iter().map(|(term, c)| Some((places[term], prime.from_rational(c)?)));
            Some(Instruction::Sum(prime.from_rational(&sum.constant)?, terms.collect::<Option<_>>()?))
        }
        Node::Product(product) => {
            let factors = product.factors.iter().map(|(base, exponent)| {
                let (base, power) = factor(arena, *base, exponent);
                (places[&base], power)
            });
            Some(Instruction::Product(prime.from_rational(&product.coefficient)?, factors.collect()))
        }
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Function;
    use crate::tower::residue::{Words, prime_of_kernels};

    #[test]
    fn residues_are_those_of_the_normal_forms() {
        let arena = Arena::new();
        let [a, b] = ["a", "b"].map(|name| arena.variable(name));
        let number = |n: i64, d: i64| Rational::new(n, d).expect("a rational");
        let (sin, root) = (arena.call(Function::Sin, &[arena.add(a, b)]), arena.power(b, &number(-3, 2)));
        let sum = arena.sum([arena.scale(sin, &number(2, 7)), arena.mul(a, root), arena.number(number(1, 3))]);
        let formulas = [
            a,
            arena.number(number(5, 2)),
            sum,
            arena.power(sum, &(-3).into()),
            arena.mul(arena.power(arena.add(sum, b), &2.into()), arena.scale(arena.power(a, &number(1, 2)), &3.into())),
            arena.call(Function::Exp, &[arena.mul(sum, a)]),
        ];
        let prime = prime_of_kernels().expect("a prime");
        let straight = StraightLineProgram::of(&arena, &Facts::new(), &prime, &formulas).expect("formulas");
        let field = straight.field();
        let fractions: Vec<Fraction> = formulas.iter().map(|e| field.fraction(*e).expect("a fraction")).collect();
        let mut words = Words::new(3);
        for _ in 0..5 {
            let kernels = field.draw(&prime, &mut words, |_| None).expect("kernels");
            let expected: Option<Vec<Residue>> = fractions.iter().map(|f| f.residue(&prime, &kernels)).collect();
            assert_eq!(straight.residues(&prime, &kernels), Some(expected.expect("values")));
        }
    }

    #[test]
    fn a_division_by_zero_has_no_residue() {
        let arena = Arena::new();
        let a = arena.variable("a");
        let formula = arena.power(arena.sub(arena.mul(a, a), arena.one()), &(-1).into());
        let prime = prime_of_kernels().expect("a prime");
        let straight = StraightLineProgram::of(&arena, &Facts::new(), &prime, &[formula]).expect("a formula");
        assert_eq!(straight.residues(&prime, &[prime.one()]), None);
    }
}

//! Square-free decomposition.

use std::collections::BTreeMap;

use super::Poly;
use super::work::{TooLarge, Work};
use crate::Integer;

/// A polynomial as a product of powers of square-free polynomials.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SquareFree {
    /// The integer factor, with the sign; zero of zero.
    pub content: Integer,
    /// The other factors with their exponents, ascending: none has a square factor, no two have a
    /// factor in common, none is constant, each is primitive with a positive leading coefficient.
    pub factors: Vec<(Poly, u32)>,
}

impl Poly {
    /// The square-free decomposition (Yun, 1976), by one variable after the other: the content with
    /// respect to a variable is decomposed on its own.
    pub fn square_free(&self, work: &Work) -> Result<SquareFree, TooLarge> {
        let (content, mut rest) = self.primitive();
        let mut factors = BTreeMap::new();
        let monomial = self.monomial_content();
        for (variable, exponent) in monomial.powers() {
            insert(&mut factors, *exponent, &Self::variable(*variable), work)?;
        }
        rest = rest.over_monomial(&monomial);
        while let Some(variable) = rest.variables().first().copied() {
            let lower = rest.content_in(&[variable], work)?;
            rest.over(&lower, work)?.yun(variable, &mut factors, work)?;
            rest = lower;
        }
        let factors = factors.into_iter().map(|(exponent, factor)| (factor, exponent)).collect();
        Ok(SquareFree { content, factors })
    }

    /// Factors that hold some of the variables, once each, separated by contents and multiplicities: the polynomial
    /// vanishes where one of them does, or a polynomial in the other variables.
    pub fn factors_in(&self, variables: &[u32], work: &Work) -> Result<Vec<Self>, TooLarge> {
        let monomial = self.monomial_content();
        let mut rest = self.over_monomial(&monomial);
        let alone = monomial.powers().iter().map(|(variable, _)| *variable);
        let mut factors: Vec<Self> = alone.filter(|v| variables.contains(v)).map(Self::variable).collect();
        for variable in variables {
            if rest.variables().contains(variable) {
                // Every factor outside the content holds the variable.
                let lower = rest.content_in(&[*variable], work)?;
                let held = rest.over(&lower, work)?.square_free(work)?.factors;
                factors.extend(held.into_iter().map(|(factor, _)| factor));
                rest = lower;
            }
        }
        Ok(factors)
    }

    /// All its factors without constants, once each, separated by contents and multiplicities.
    pub fn distinct_factors(&self, work: &Work) -> Result<Vec<Self>, TooLarge> {
        let mut found: Vec<Self> = Vec::new();
        let mut open = self.factors_in(self.variables(), work)?;
        while let Some(factor) = open.pop() {
            let mut split = None;
            for variable in factor.variables() {
                let lower = factor.content_in(&[*variable], work)?;
                if !lower.is_constant() {
                    split = Some([factor.over(&lower, work)?, lower]);
                    break;
                }
            }
            match split {
                Some(parts) => open.extend(parts),
                None if factor.is_constant() => {}
                None => {
                    let (_, factor) = factor.primitive();
                    if !found.contains(&factor) {
                        found.push(factor);
                    }
                }
            }
        }
        found.reverse();
        Ok(found)
    }

    /// For a polynomial that is primitive in the variable.
    fn yun(&self, variable: u32, factors: &mut BTreeMap<u32, Self>, work: &Work) -> Result<(), TooLarge> {
        let derivative = self.derivative(variable);
        let common = self.gcd(&derivative, work)?;
        let mut product = self.over(&common, work)?;
        let mut slope = derivative.over(&common, work)?;
        let mut exponent = 1;
        while !product.is_constant() {
            slope = &slope - &product.derivative(variable);
            let factor = product.gcd(&slope, work)?;
            if !factor.is_constant() {
                insert(factors, exponent, &factor, work)?;
            }
            product = product.over(&factor, work)?;
            slope = slope.over(&factor, work)?;
            exponent += 1;
        }
        Ok(())
    }
}

fn insert(factors: &mut BTreeMap<u32, Poly>, exponent: u32, factor: &Poly, work: &Work) -> Result<(), TooLarge> {
    let (_, factor) = factor.primitive();
    let product = match factors.get(&exponent) {
        Some(other) => other.mul(&factor, work)?,
        None => factor,
    };
    factors.insert(exponent, product);
    Ok(())
}

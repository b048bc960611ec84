//! Polynomials in one variable modulo a prime: the coefficients, constant term first, highest not
//! zero.

use super::super::field::{PrimeField, Residue};

/// Drops leading zeros.
pub(in crate::poly) fn trim(poly: &mut Vec<Residue>) {
    while poly.last().is_some_and(|coefficient| coefficient.is_zero()) {
        poly.pop();
    }
}

/// Up to here a reciprocal costs more than another product for every coefficient.
const SHORT: usize = 64;

/// Replaces `a` by a multiple of its remainder modulo `b`, which is not zero.
fn reduce(field: &PrimeField, a: &mut Vec<Residue>, b: &[Residue]) {
    let Some(divisor) = b.last().copied() else {
        return;
    };
    let inverse = if b.len() > SHORT { field.inv(divisor) } else { None };
    while a.len() >= b.len() {
        let Some(leading) = a.pop() else { break };
        let start = a.len() + 1 - b.len();
        if let Some(inverse) = inverse {
            let factor = field.mul(leading, inverse);
            for (x, y) in a[start..].iter_mut().zip(b) {
                *x = field.sub(*x, field.mul(factor, *y));
            }
        } else {
            for x in &mut a[..start] {
                *x = field.mul(*x, divisor);
            }
            for (x, y) in a[start..].iter_mut().zip(b) {
                *x = field.sub(field.mul(*x, divisor), field.mul(leading, *y));
            }
        }
        trim(a);
    }
}

/// The greatest common divisor with leading coefficient 1, by Euclid's algorithm; of two zeros it
/// is zero, the empty list.
pub(in crate::poly) fn gcd(field: &PrimeField, mut a: Vec<Residue>, mut b: Vec<Residue>) -> Vec<Residue> {
    while !b.is_empty() {
        reduce(field, &mut a, &b);
        std::mem::swap(&mut a, &mut b);
    }
    if let Some(inverse) = a.last().and_then(|leading| field.inv(*leading)) {
        for coefficient in &mut a {
            *coefficient = field.mul(*coefficient, inverse);
        }
    }
    a
}

/// The solution `c` of the transposed Vandermonde system `sum_m c_m node_m^j = values_j` for
/// `j = 1, 2, ..`, with nodes that are different and not zero (Zippel, 1990).
pub(super) fn solve_powers(field: &PrimeField, nodes: &[Residue], values: &[Residue]) -> Option<Vec<Residue>> {
    if let ([node], [value, ..]) = (nodes, values) {
        return Some(vec![field.mul(*value, field.inv(*node)?)]);
    }
    // The polynomial with the nodes as roots.
    let mut product = vec![field.one()];
    for node in nodes {
        product.insert(0, Residue::ZERO);
        for index in 1..product.len() {
            let lower = field.mul(product[index], *node);
            product[index - 1] = field.sub(product[index - 1], lower);
        }
    }
    let mut solution = Vec::with_capacity(nodes.len());
    for node in nodes {
        // Its quotient by the linear factor of this node vanishes at all others: synthetic
        // division, highest coefficient first, and its value at the node by Horner's rule.
        let (mut coefficient, mut at_node, mut sum) = (Residue::ZERO, Residue::ZERO, Residue::ZERO);
        for index in (1..product.len()).rev() {
            coefficient = field.add(field.mul(coefficient, *node), product[index]);
            at_node = field.add(field.mul(at_node, *node), coefficient);
            sum = field.add(sum, field.mul(coefficient, values[index - 1]));
        }
        solution.push(field.mul(sum, field.inv(field.mul(*node, at_node))?));
    }
    Some(solution)
}

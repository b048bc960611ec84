//! Images of polynomials modulo a prime, and their values along a geometric sequence of points.

use super::super::Poly;
use super::super::field::{PrimeField, Residue};
use super::dense;

/// A polynomial modulo a prime: rows of exponents, one column for each variable, in descending
/// lexicographic order, none repeated.
#[derive(Clone, Debug)]
pub(super) struct Image {
    columns: usize,
    exponents: Vec<u32>,
    pub(super) coefficients: Vec<Residue>,
}

impl Image {
    /// The image of a polynomial, with columns for the given variables, which are all it has.
    pub(super) fn new(poly: &Poly, variables: &[u32], field: &PrimeField) -> Self {
        let positions: Vec<_> = variables.iter().map(|v| poly.layout.position(*v)).collect();
        let mut rows: Vec<(Vec<u32>, Residue)> = poly
            .keys()
            .zip(&poly.coefficients)
            .map(|(key, coefficient)| {
                let exponent = |p: &Option<usize>| p.map_or(0, |index| poly.layout.get(key, index));
                (positions.iter().map(exponent).collect(), field.from_integer(coefficient))
            })
            .collect();
        rows.sort_unstable_by(|a, b| b.0.cmp(&a.0));
        let coefficients = rows.iter().map(|row| row.1).collect();
        let exponents = rows.into_iter().flat_map(|row| row.0).collect();
        Self { columns: variables.len(), exponents, coefficients }
    }

    /// From rows that descend.
    pub(super) fn from_rows(columns: usize, exponents: Vec<u32>, coefficients: Vec<Residue>) -> Self {
        debug_assert_eq!(exponents.len(), columns * coefficients.len());
        Self { columns, exponents, coefficients }
    }

    pub(super) fn rows(&self) -> std::slice::ChunksExact<'_, u32> {
        self.exponents.chunks_exact(self.columns)
    }

    pub(super) fn columns(&self) -> usize {
        self.columns
    }

    /// The number of terms.
    pub(super) fn len(&self) -> usize {
        self.coefficients.len()
    }

    /// The largest exponent in a column.
    pub(super) fn degree(&self, column: usize) -> u32 {
        self.rows().map(|row| row[column]).max().unwrap_or(0)
    }

    /// The value in the last column's variable, whose column is removed. Terms may have become zero.
    pub(super) fn at_last(&self, field: &PrimeField, value: Residue) -> Self {
        let last = self.columns - 1;
        let powers = powers(field, value, self.degree(last));
        let mut exponents: Vec<u32> = Vec::new();
        let mut coefficients: Vec<Residue> = Vec::new();
        for (row, coefficient) in self.rows().zip(&self.coefficients) {
            let term = field.mul(*coefficient, powers[row[last] as usize]);
            match coefficients.last_mut() {
                // Rows that differ in the last column alone are neighbours.
                Some(sum) if exponents[exponents.len() - last..] == row[..last] => {
                    *sum = field.add(*sum, term);
                }
                _ => {
                    exponents.extend_from_slice(&row[..last]);
                    coefficients.push(term);
                }
            }
        }
        Self { columns: last, exponents, coefficients }
    }

    /// The values of the power products of all columns but the first.
    pub(super) fn nodes(&self, field: &PrimeField, point: &[Residue]) -> Vec<Residue> {
        let tables: Vec<_> =
            (1..self.columns).map(|column| powers(field, point[column - 1], self.degree(column))).collect();
        self.rows()
            .map(|row| {
                row[1..].iter().zip(&tables).fold(field.one(), |node, (exponent, table)| {
                    if *exponent == 0 { node } else { field.mul(node, table[*exponent as usize]) }
                })
            })
            .collect()
    }
}

/// The powers of a residue up to a degree.
pub(super) fn powers(field: &PrimeField, base: Residue, degree: u32) -> Vec<Residue> {
    let next = |power: &Residue| Some(field.mul(*power, base));
    std::iter::successors(Some(field.one()), next).take(degree as usize + 1).collect()
}

/// The images in the first variable at the points `(b_2^j, b_3^j, ..)` for `j = 1, 2, ..`: the
/// value of a term is multiplied by the same factor from one point to the next.
pub(super) struct Samples<'a> {
    field: &'a PrimeField,
    degrees: Vec<u32>,
    nodes: Vec<Residue>,
    values: Vec<Residue>,
}

impl<'a> Samples<'a> {
    pub(super) fn new(field: &'a PrimeField, image: &Image, point: &[Residue]) -> Self {
        Self {
            field,
            degrees: image.rows().map(|row| row[0]).collect(),
            nodes: image.nodes(field, point),
            values: image.coefficients.clone(),
        }
    }

    /// The greatest possible degree of an image.
    pub(super) fn degree(&self) -> usize {
        self.degrees.first().copied().unwrap_or(0) as usize
    }

    /// The next image, without leading zeros.
    pub(super) fn next_image(&mut self) -> Vec<Residue> {
        let mut image = vec![Residue::ZERO; self.degree() + 1];
        for ((value, node), degree) in self.values.iter_mut().zip(&self.nodes).zip(&self.degrees) {
            *value = self.field.mul(*value, *node);
            let sum = &mut image[*degree as usize];
            *sum = self.field.add(*sum, *value);
        }
        dense::trim(&mut image);
        image
    }
}

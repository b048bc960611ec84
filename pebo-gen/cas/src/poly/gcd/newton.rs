//! Newton's interpolation of many polynomials in one variable at the same points.

use super::super::field::{PrimeField, Residue};
use super::image::Image;

/// Polynomials through the values at the points so far.
pub(super) struct Newton {
    points: Vec<Residue>,
    /// For each polynomial the coefficients of 1, `(x - p_0)`, `(x - p_0) (x - p_1)`, ..
    polynomials: Vec<Vec<Residue>>,
}

impl Newton {
    /// Constants: the values at one point.
    pub(super) fn new(values: Vec<Residue>, point: Residue) -> Self {
        Self { points: vec![point], polynomials: values.into_iter().map(|value| vec![value]).collect() }
    }

    /// The number of points.
    pub(super) fn len(&self) -> usize {
        self.points.len()
    }

    /// Adds the values at a further point; true if they were as interpolated before. `None` if the point is not new.
    pub(super) fn add(&mut self, field: &PrimeField, values: &[Residue], point: Residue) -> Option<bool> {
        let factors: Vec<Residue> = self.points.iter().map(|p| field.sub(point, *p)).collect();
        let product = factors.iter().fold(field.one(), |product, f| field.mul(product, *f));
        let inverse = field.inv(product)?;
        let mut same = true;
        for (polynomial, value) in self.polynomials.iter_mut().zip(values) {
            // Horner's rule in the products.
            let mut old = Residue::ZERO;
            for index in (0..polynomial.len()).rev() {
                old = field.add(field.mul(old, factors[index]), polynomial[index]);
            }
            let next = field.mul(field.sub(*value, old), inverse);
            same &= next.is_zero();
            polynomial.push(next);
        }
        self.points.push(point);
        Some(same)
    }

    /// The polynomials as coefficients of the rows of `skeleton`: a column for the interpolated
    /// variable is added at the end.
    pub(super) fn into_image(self, field: &PrimeField, skeleton: &Image) -> Image {
        let (mut exponents, mut coefficients) = (Vec::new(), Vec::new());
        for (row, polynomial) in skeleton.rows().zip(&self.polynomials) {
            let expanded = expand(field, &self.points, polynomial);
            for (power, coefficient) in expanded.iter().enumerate().rev() {
                if !coefficient.is_zero() {
                    exponents.extend_from_slice(row);
                    exponents.push(u32::try_from(power).unwrap_or(u32::MAX));
                    coefficients.push(*coefficient);
                }
            }
        }
        Image::from_rows(skeleton.columns() + 1, exponents, coefficients)
    }
}

/// From Newton's form to coefficients of powers, constant term first.
fn expand(field: &PrimeField, points: &[Residue], newton: &[Residue]) -> Vec<Residue> {
    let mut powers: Vec<Residue> = Vec::with_capacity(newton.len());
    for (coefficient, point) in newton.iter().zip(points).rev() {
        // Times (x - point), plus the coefficient.
        powers.insert(0, Residue::ZERO);
        for index in 1..powers.len() {
            let lower = field.mul(powers[index], *point);
            powers[index - 1] = field.sub(powers[index - 1], lower);
        }
        powers[0] = field.add(powers[0], *coefficient);
    }
    powers
}

//! Bounds of the degrees of a greatest common divisor.

use super::super::Poly;
use super::super::field::{PrimeField, Residue};
use super::super::work::{TooLarge, Work, steps};
use super::dense;
use super::image::powers;
use super::points::Points;

/// For each variable of two polynomials in the same variables a bound of the degree of their
/// greatest common divisor, which it nearly always attains: the degree of that of their images
/// modulo a prime, with values for the other variables. It is proved and not only likely, because
/// values at which a leading coefficient vanishes are not used.
pub(super) fn bounds(
    field: &PrimeField,
    points: &mut Points,
    a: &Poly,
    b: &Poly,
    work: &Work,
) -> Result<Vec<u32>, TooLarge> {
    let pairs = || a.degrees().into_iter().zip(b.degrees());
    let mut bounds: Vec<u32> = pairs().map(|(x, y)| x.min(y)).collect();
    let largest: Vec<u32> = pairs().map(|(x, y)| x.max(y)).collect();
    work.spend(largest.iter().copied().map(u64::from).sum())?;
    work.spend(steps((a.term_count() + b.term_count()) * bounds.len()))?;
    let tables = Tables::new(field, points, &largest);
    let (images, others) = (tables.images(field, a), tables.images(field, b));
    let complete = |image: &[Residue]| image.last().is_some_and(|leading| !leading.is_zero());
    for ((image, other), bound) in images.into_iter().zip(others).zip(&mut bounds) {
        work.spend(steps(image.len()).saturating_mul(steps(other.len())))?;
        // One non-vanishing leading coefficient is enough: then that of the divisor does not vanish either.
        if complete(&image) || complete(&other) {
            let (mut image, mut other) = (image, other);
            dense::trim(&mut image);
            dense::trim(&mut other);
            let degree = dense::gcd(field, image, other).len().saturating_sub(1);
            *bound = u32::try_from(degree).unwrap_or(*bound).min(*bound);
        }
    }
    Ok(bounds)
}

/// Powers of the coordinates and of their reciprocals.
struct Tables {
    powers: Vec<Vec<Residue>>,
    /// Reciprocals, which remove one variable from the value of a term.
    reciprocals: Vec<Vec<Residue>>,
}

impl Tables {
    fn new(field: &PrimeField, points: &mut Points, degrees: &[u32]) -> Self {
        let coordinates = points.residues(field, degrees.len());
        // One reciprocal, of the product, gives all of them (Montgomery, 1987).
        let mut products = vec![field.one()];
        for coordinate in &coordinates {
            products.push(field.mul(products[products.len() - 1], *coordinate));
        }
        let product = products.pop().and_then(|product| field.inv(product));
        let mut rest = product.unwrap_or_default();
        let mut tables = Self { powers: Vec::new(), reciprocals: Vec::new() };
        let columns = coordinates.iter().zip(products).zip(degrees);
        for ((coordinate, product), degree) in columns.rev() {
            tables.powers.push(powers(field, *coordinate, *degree));
            tables.reciprocals.push(powers(field, field.mul(rest, product), *degree));
            rest = field.mul(rest, *coordinate);
        }
        tables.powers.reverse();
        tables.reciprocals.reverse();
        tables
    }

    /// For each variable the image in it, with values for all others.
    fn images(&self, field: &PrimeField, poly: &Poly) -> Vec<Vec<Residue>> {
        let image = |degree: &u32| vec![Residue::ZERO; *degree as usize + 1];
        let mut images: Vec<_> = poly.degrees().iter().map(image).collect();
        // The values of all terms: a term without a variable is part of the constant term of the image in it.
        let mut total = Residue::ZERO;
        for (key, coefficient) in poly.keys().zip(&poly.coefficients) {
            let mut value = field.from_integer(coefficient);
            for (index, exponent) in poly.layout.powers(key) {
                value = field.mul(value, self.powers[index][exponent as usize]);
            }
            total = field.add(total, value);
            for (index, exponent) in poly.layout.powers(key) {
                let (image, table) = (&mut images[index], &self.reciprocals[index]);
                let sum = &mut image[exponent as usize];
                *sum = field.add(*sum, field.mul(value, table[exponent as usize]));
                image[0] = field.sub(image[0], value);
            }
        }
        for image in &mut images {
            image[0] = field.add(image[0], total);
        }
        images
    }
}

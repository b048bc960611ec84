//! The greatest common divisor modulo a prime by sparse interpolation (Zippel, 1979; the scaling
//! by the divisor of the leading coefficients is Brown's, 1971).
//!
//! The divisor is found with values for all variables but the first, and then one variable after the other is restored.
//! The terms found so far are taken to be all there are (the skeleton), so that images at further values take as many
//! points as the longest coefficient has terms, and not as many as there could be. Every assumption may fail without
//! notice: the caller verifies.

use super::super::field::{PrimeField, Residue};
use super::super::work::{TooLarge, Work, steps};
use super::dense;
use super::image::{Image, Samples};
use super::newton::Newton;
use super::points::Points;

/// Attempts with new points before all is begun anew.
const ATTEMPTS: usize = 8;

/// The reason why these points give no divisor.
pub(super) enum Failure {
    /// The points were special: others will do.
    Unlucky,
    /// The degree in the first variable is lower than was assumed: this is a better bound.
    Degree(usize),
    /// Out of work.
    TooLarge,
}

impl From<TooLarge> for Failure {
    fn from(_: TooLarge) -> Self {
        Self::TooLarge
    }
}

/// Two polynomials modulo a prime, primitive in the variable of the first column, and the common divisor of their
/// leading coefficients in it, with which the divisor is scaled.
#[derive(Clone)]
pub(super) struct Triple {
    pub(super) a: Image,
    pub(super) b: Image,
    /// It has the first column as well, with zeros.
    pub(super) leading: Image,
}

impl Triple {
    fn at_last(&self, field: &PrimeField, value: Residue) -> Self {
        Self {
            a: self.a.at_last(field, value),
            b: self.b.at_last(field, value),
            leading: self.leading.at_last(field, value),
        }
    }

    fn len(&self) -> usize {
        self.a.len() + self.b.len() + self.leading.len()
    }
}

/// One run modulo one prime.
pub(super) struct Interpolation<'a> {
    pub(super) field: &'a PrimeField,
    pub(super) points: &'a mut Points,
    /// The degree of the divisor in the first variable, as far as is known.
    pub(super) degree: usize,
    pub(super) work: &'a Work,
}

impl Interpolation<'_> {
    /// The scaled divisor. `bounds` are those of its degrees in the other variables, in order.
    pub(super) fn run(&mut self, triple: &Triple, bounds: &[u32]) -> Result<Image, Failure> {
        let anchor = self.points.residues(self.field, bounds.len());
        let mut stages = vec![triple.clone()];
        for value in anchor.iter().rev() {
            let Some(last) = stages.last() else { break };
            self.work.spend(steps(last.len()))?;
            stages.push(last.at_last(self.field, *value));
        }
        let Some(stage) = stages.pop() else {
            return Err(Failure::Unlucky);
        };
        let mut found = self.first_stage(&stage)?;
        for (value, bound) in anchor.iter().zip(bounds) {
            let Some(stage) = stages.pop() else { break };
            found = self.give_back(&stage, &found, *value, *bound)?;
        }
        Ok(found)
    }

    /// The divisor of polynomials in the first variable alone.
    fn first_stage(&mut self, stage: &Triple) -> Result<Image, Failure> {
        let powers = (0..=self.degree).rev().map(|power| u32::try_from(power).unwrap_or(u32::MAX));
        let all = Image::from_rows(1, powers.collect(), vec![self.field.one(); self.degree + 1]);
        let values = self.on_skeleton(stage, &all)?;
        let rows = all.rows().map(|row| row[0]).zip(values);
        let (exponents, coefficients) = rows.filter(|(_, value)| !value.is_zero()).unzip();
        Ok(Image::from_rows(1, exponents, coefficients))
    }

    /// The divisor of `stage`, which has one more column than `found`, the divisor at `value`.
    fn give_back(&mut self, stage: &Triple, found: &Image, value: Residue, bound: u32) -> Result<Image, Failure> {
        let mut newton = Newton::new(found.coefficients.clone(), value);
        while newton.len() <= bound as usize {
            let value = self.points.residue(self.field);
            self.work.spend(steps(stage.len()))?;
            let image = self.on_skeleton(&stage.at_last(self.field, value), found)?;
            self.work.spend(steps(image.len()).saturating_mul(steps(newton.len())))?;
            match newton.add(self.field, &image, value) {
                None => return Err(Failure::Unlucky),
                Some(false) => {}
                // Nothing new at this point: complete, but for bad luck.
                Some(true) => break,
            }
        }
        Ok(newton.into_image(self.field, found))
    }

    /// The coefficients of the divisor of `triple` if it has the terms of `skeleton` and no others.
    pub(super) fn on_skeleton(&mut self, triple: &Triple, skeleton: &Image) -> Result<Vec<Residue>, Failure> {
        for _ in 0..ATTEMPTS {
            match self.try_skeleton(triple, skeleton) {
                Err(Failure::Unlucky) => {}
                result => return result,
            }
        }
        Err(Failure::Unlucky)
    }

    fn try_skeleton(&mut self, triple: &Triple, skeleton: &Image) -> Result<Vec<Residue>, Failure> {
        let field = self.field;
        let point = self.points.residues(field, skeleton.columns() - 1);
        let nodes = skeleton.nodes(field, &point);
        let rows: Vec<&[u32]> = skeleton.rows().collect();
        let groups: Vec<usize> = rows.chunk_by(|x, y| x[0] == y[0]).map(<[_]>::len).collect();
        let count = groups.iter().copied().max().unwrap_or(0);
        if !distinct(&nodes, &groups) {
            return Err(Failure::Unlucky);
        }
        let mut samples = [&triple.a, &triple.b, &triple.leading].map(|image| Samples::new(field, image, &point));
        let mut images = Vec::with_capacity(count);
        for _ in 0..count {
            let [a, b, leading] = &mut samples;
            self.work.spend(steps(triple.len()))?;
            let image = self.divisor(a, b, leading)?;
            let terms = image.iter().filter(|coefficient| !coefficient.is_zero()).count();
            let known = |group: &&[u32]| !image[group[0] as usize].is_zero();
            if terms > rows.chunk_by(|x, y| x[0] == y[0]).map(|group| group[0]).filter(known).count() {
                return Err(Failure::Unlucky);
            }
            images.push(image);
        }
        let mut coefficients = Vec::with_capacity(rows.len());
        let mut start = 0;
        for size in groups {
            let power = rows[start][0] as usize;
            let values: Vec<Residue> = images[..size].iter().map(|image| image[power]).collect();
            self.work.spend(steps(size * size))?;
            let nodes = &nodes[start..start + size];
            let solution = dense::solve_powers(field, nodes, &values).ok_or(Failure::Unlucky)?;
            coefficients.extend(solution);
            start += size;
        }
        Ok(coefficients)
    }

    /// The scaled divisor at the next point of the samples, of the assumed degree.
    fn divisor(
        &self,
        a: &mut Samples<'_>,
        b: &mut Samples<'_>,
        leading: &mut Samples<'_>,
    ) -> Result<Vec<Residue>, Failure> {
        let (full_a, full_b) = (a.degree(), b.degree());
        let (a, b, scale) = (a.next_image(), b.next_image(), leading.next_image());
        if a.len() != full_a + 1 || b.len() != full_b + 1 || scale.len() != 1 {
            return Err(Failure::Unlucky);
        }
        self.work.spend(steps(a.len()).saturating_mul(steps(b.len())))?;
        let mut image = dense::gcd(self.field, a, b);
        match image.len().saturating_sub(1) {
            degree if degree < self.degree => return Err(Failure::Degree(degree)),
            degree if degree > self.degree => return Err(Failure::Unlucky),
            _ => {}
        }
        for coefficient in &mut image {
            *coefficient = self.field.mul(*coefficient, scale[0]);
        }
        Ok(image)
    }
}

/// True if the nodes within each group differ.
fn distinct(nodes: &[Residue], groups: &[usize]) -> bool {
    let mut start = 0;
    groups.iter().all(|size| {
        let mut group: Vec<Residue> = nodes[start..start + size].to_vec();
        start += size;
        group.sort_unstable();
        group.windows(2).all(|pair| pair[0] != pair[1])
    })
}

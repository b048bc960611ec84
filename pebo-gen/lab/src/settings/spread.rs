//! Propagates standard deviations through formulas.

use pebo_cas::{Expr, Symbol};
use pebo_design::plant::Plant;

use super::point::Point;

/// Formulas with their derivatives by some symbols, by rows.
#[derive(Debug)]
pub(super) struct Slopes {
    pub(super) formulas: Vec<Expr>,
    symbols: Vec<Symbol>,
    /// The derivatives.
    pub(super) by: Vec<Expr>,
}

impl Slopes {
    pub(super) fn new(plant: &Plant, formulas: &[Expr], symbols: &[Symbol]) -> Self {
        let by = |formula: &Expr| symbols.iter().map(|s| plant.arena.derivative(*formula, *s)).collect::<Vec<_>>();
        Self { formulas: formulas.to_vec(), symbols: symbols.to_vec(), by: formulas.iter().flat_map(by).collect() }
    }

    /// The same without these slopes by these of the symbols, for each formula.
    pub(super) fn without(mut self, plant: &Plant, slopes: &[Vec<Expr>], symbols: &[Symbol]) -> Self {
        for (by, slopes) in self.by.chunks_mut(self.symbols.len().max(1)).zip(slopes) {
            for (symbol, slope) in symbols.iter().zip(slopes) {
                let place = self.symbols.iter().position(|known| known == symbol);
                if let Some(by) = place.and_then(|place| by.get_mut(place)) {
                    *by = plant.arena.sub(*by, *slope);
                }
            }
        }
        self
    }

    /// The variance of each formula for these standard deviations of the symbols, by the slopes at a point.
    pub(super) fn variances(&self, point: &Point, deviations: &[f64]) -> Option<Vec<f64>> {
        let slopes = point.values(&self.by)?;
        let row = |row: &[f64]| row.iter().zip(deviations).map(|(slope, d)| square(slope * d)).sum();
        Some(slopes.chunks(self.symbols.len().max(1)).take(self.formulas.len()).map(row).collect())
    }

    /// The same for deviations that are too large for slopes alone: with the change of the formulas over a deviation to
    /// either side, where they have a value there.
    pub(super) fn wide_variances(&self, point: &Point, deviations: &[f64]) -> Option<Vec<f64>> {
        let mut variances = vec![0.0; self.formulas.len()];
        let slopes = point.values(&self.by)?;
        let middle = point.values(&self.formulas)?;
        for (column, (symbol, deviation)) in self.symbols.iter().zip(deviations).enumerate() {
            let at = point.of_symbol(*symbol)?;
            let sides = [at - deviation, at + deviation].map(|moved| point.with(&[*symbol], &[moved]));
            let sides = [sides[0].values(&self.formulas)?, sides[1].values(&self.formulas)?];
            for (row, variance) in variances.iter_mut().enumerate() {
                let slope = (slopes[row * self.symbols.len() + column] * deviation).abs();
                let changes = sides.iter().map(|side| (side[row] - middle[row]).abs());
                let largest = changes.filter(|change| change.is_finite()).fold(f64::NAN, f64::max);
                // A slope says little of a function that is nonlinear within the deviation.
                *variance += square(if largest.is_finite() { largest } else { slope });
            }
        }
        Some(variances)
    }
}

fn square(value: f64) -> f64 {
    if value.is_finite() { value * value } else { 0.0 }
}

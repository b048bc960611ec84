//! Boundedness of the fundamental matrix of a generalised cascade.
//!
//! In: Lambda(y, u). Out: every solution of `Psi' = Lambda Psi` is provably bounded, provably grows, or neither. Lambda
//! is divided into blocks of components that feed one another. Each block is judged by itself,
//! - by a quadratic form with a constant positive diagonal P that never grows: `P Lambda + Lambda' P` is diagonal
//!   without a positive entry (for circuits and mechanisms P is the stored energy);
//! - where it is constant, as flows between compartments that lose no less than they feed ([`flows`]);
//! - else by the criterion of Hurwitz;
//! - by its trace, which is the rate of `log det Psi` (Liouville).
//!
//! Then in the order in which the blocks feed one another: a block fed through constants by a bounded block is bounded
//! if by itself it dies out at a constant rate; any other block only if all that feeds it dies out so.

mod fate;
mod flows;

use crate::plant::Plant;
use pebo_cas::linear::Matrix;
use pebo_cas::linear::determinant::by_elimination;
use pebo_cas::tower::{Field, Fraction, Obstacle};
use pebo_cas::{Domain, Expr};

use self::fate::Fate;
use crate::analysis::design::Fundamental;

/// A block with more components is not judged by its characteristic polynomial.
const MOST_COMPONENTS: usize = 6;

/// The behaviour of the fundamental matrix.
pub(super) fn of(plant: &Plant, domain: &Domain, lambda: &[Vec<Expr>]) -> Fundamental {
    judged(plant, domain, lambda).unwrap_or(Fundamental::Undecided)
}

fn judged(plant: &Plant, domain: &Domain, lambda: &[Vec<Expr>]) -> Result<Fundamental, Obstacle> {
    let field = Field::over(&plant.arena, &domain.facts, &lambda.concat())?;
    let entries = field.matrix(lambda)?.into_rows();
    let system = System { plant, field, fed: fed(&entries), entries };
    let (mut rows, mut fades) = (vec![Fate::Open; lambda.len()], false);
    for block in system.blocks() {
        let alone = system.alone(&block)?;
        // A block by itself is the diagonal block of Psi.
        if alone == Fate::Grows || system.integrates(&block)? {
            return Ok(Fundamental::Grows);
        }
        fades |= alone == Fate::Fades;
        let fate = system.beside(&block, alone, &rows);
        for component in block {
            rows[component] = fate;
        }
    }
    let bounded = rows.iter().all(|fate| matches!(fate, Fate::Fades | Fate::Bounded));
    Ok(if bounded { Fundamental::Bounded { fades } } else { Fundamental::Undecided })
}

struct System<'a> {
    plant: &'a Plant,
    field: Field<'a>,
    entries: Vec<Vec<Fraction>>,
    /// True if a component is fed by another, directly or through others; each is by itself.
    fed: Vec<Vec<bool>>,
}

impl System<'_> {
    /// Components that feed one another, a block each, in the order of the feed.
    fn blocks(&self) -> Vec<Vec<usize>> {
        let fed = &self.fed;
        let together = |i: usize| (0..fed.len()).filter(|&j| fed[i][j] && fed[j][i]).collect::<Vec<usize>>();
        let mut blocks: Vec<Vec<usize>> = (0..fed.len()).map(together).collect();
        // The blocks that feed a block are fed by fewer components than it.
        blocks.sort_by_key(|block| (fed[block[0]].iter().filter(|by| **by).count(), block[0]));
        blocks.dedup();
        blocks
    }

    /// The behaviour of a block by itself.
    fn alone(&self, block: &[usize]) -> Result<Fate, Obstacle> {
        let mut trace = Fraction::zero();
        for &i in block {
            trace = self.field.add(&trace, &self.entries[i][i])?;
        }
        if self.is_constant(&trace) && self.field.signs().is_positive(&trace)? {
            return Ok(Fate::Grows);
        }
        let by_energy = self.by_energy(block)?;
        let constant = block.iter().all(|&i| block.iter().all(|&j| self.is_constant(&self.entries[i][j])));
        if by_energy == Fate::Fades || !constant {
            return Ok(by_energy);
        }
        let by_flows = flows::fate(&self.field, &self.entries, block)?;
        if by_flows == Fate::Fades {
            return Ok(Fate::Fades);
        }
        let known = if by_energy == Fate::Open { by_flows } else { by_energy };
        if block.len() > MOST_COMPONENTS {
            return Ok(known);
        }
        let by_polynomial = self.by_polynomial(block)?;
        Ok(if by_polynomial == Fate::Open { known } else { by_polynomial })
    }

    /// By a quadratic form with a constant positive diagonal.
    fn by_energy(&self, block: &[usize]) -> Result<Fate, Obstacle> {
        let field = &self.field;
        let mut weights: Vec<Option<Fraction>> = vec![None; self.entries.len()];
        weights[block[0]] = Some(Fraction::one());
        let mut open = vec![block[0]];
        while let Some(i) = open.pop() {
            let Some(weight) = weights[i].clone() else { continue };
            for &j in block {
                let (out, back) = (&self.entries[i][j], &self.entries[j][i]);
                if i == j || (out.is_zero() && back.is_zero()) {
                    continue;
                }
                if out.is_zero() || back.is_zero() {
                    return Ok(Fate::Open);
                }
                // P_j = -P_i Lambda_ij / Lambda_ji
                let other = field.div(&field.mul(&weight, out)?, &back.opposite())?;
                if !field.signs().is_positive(&other)? || !self.is_constant(&other) {
                    return Ok(Fate::Open);
                }
                match &weights[j] {
                    Some(known) if *known != other => return Ok(Fate::Open),
                    Some(_) => {}
                    None => {
                        weights[j] = Some(other);
                        open.push(j);
                    }
                }
            }
        }
        let mut fate = Fate::Fades;
        for &i in block {
            let loss = self.entries[i][i].opposite();
            if !field.signs().is_not_negative(&loss)? && !field.signs().is_positive(&loss)? {
                return Ok(Fate::Open);
            }
            if !self.is_constant(&loss) || !field.signs().is_positive(&loss)? {
                fate = Fate::Bounded;
            }
        }
        Ok(fate)
    }

    /// The behaviour of a constant block, by its characteristic polynomial.
    fn by_polynomial(&self, block: &[usize]) -> Result<Fate, Obstacle> {
        let field = &self.field;
        let polynomial = self.characteristic(block)?;
        let mut all_positive = true;
        // A polynomial with no root to the right of the imaginary axis has neither a negative coefficient nor a
        // negative determinant of Hurwitz; one with all roots to the left has positive ones.
        for size in 0..=block.len() {
            for value in [polynomial[size].clone(), hurwitz(field, &polynomial, size)?] {
                if field.signs().is_positive(&value.opposite())? {
                    return Ok(Fate::Grows);
                }
                all_positive &= field.signs().is_positive(&value)?;
            }
        }
        if all_positive {
            return Ok(Fate::Fades);
        }
        // s^2 + c with c > 0: an oscillation.
        let oscillates = block.len() == 2 && polynomial[1].is_zero() && field.signs().is_positive(&polynomial[2])?;
        Ok(if oscillates { Fate::Bounded } else { Fate::Open })
    }

    /// The characteristic polynomial, from its leading coefficient down (Faddeev and Le Verrier).
    fn characteristic(&self, block: &[usize]) -> Result<Vec<Fraction>, Obstacle> {
        let field = &self.field;
        let size = block.len();
        let a = Matrix::build(size, size, |i, j| self.entries[block[i]][block[j]].clone());
        let mut polynomial = vec![Fraction::one()];
        let mut m = Matrix::build(size, size, |_, _| Fraction::zero());
        for step in 1..=size {
            // M <- A M + c I
            let mut next = a.product(field, &m)?.into_rows();
            for (i, row) in next.iter_mut().enumerate() {
                row[i] = field.add(&row[i], &polynomial[step - 1])?;
            }
            m = Matrix::new(next);
            let am = a.product(field, &m)?;
            let mut trace = Fraction::zero();
            for (i, row) in am.rows().iter().enumerate() {
                trace = field.add(&trace, &row[i])?;
            }
            let count = field.fraction(self.plant.arena.number(-i64::try_from(step).unwrap_or(1)))?;
            polynomial.push(field.div(&trace, &count)?);
        }
        Ok(polynomial)
    }

    /// Tests whether a component that is constant by itself integrates another such component through a constant that
    /// is not zero, while nothing else that feeds it depends on that component.
    fn integrates(&self, block: &[usize]) -> Result<bool, Obstacle> {
        let &[component] = block else { return Ok(false) };
        let row = &self.entries[component];
        if !row[component].is_zero() {
            return Ok(false);
        }
        let feeding: Vec<usize> = (0..row.len()).filter(|&j| !row[j].is_zero()).collect();
        for &j in &feeding {
            let still = self.entries[j].iter().all(Fraction::is_zero);
            let alone = feeding.iter().all(|&other| other == j || !self.fed[other][j]);
            if still && alone && self.is_constant(&row[j]) {
                let signed =
                    self.field.signs().is_positive(&row[j])? || self.field.signs().is_positive(&row[j].opposite())?;
                if signed {
                    return Ok(true);
                }
            }
        }
        Ok(false)
    }

    /// The behaviour of a block that others feed.
    fn beside(&self, block: &[usize], alone: Fate, rows: &[Fate]) -> Fate {
        let outside = (0..rows.len()).filter(|j| !block.contains(j));
        let (mut all_fade, mut all_bounded) = (true, true);
        for j in outside {
            for factor in block.iter().map(|&i| &self.entries[i][j]).filter(|factor| !factor.is_zero()) {
                let constant = self.is_constant(factor);
                all_fade &= constant && rows[j] == Fate::Fades;
                all_bounded &= constant && matches!(rows[j], Fate::Fades | Fate::Bounded);
            }
        }
        match alone {
            Fate::Fades if all_fade => Fate::Fades,
            Fate::Fades if all_bounded => Fate::Bounded,
            Fate::Bounded if all_fade => Fate::Bounded,
            _ => Fate::Open,
        }
    }

    /// Tests whether the value is a function of parameters alone, their values known or not.
    fn is_constant(&self, value: &Fraction) -> bool {
        let symbols = self.plant.arena.symbols_of(&[self.field.show(value)]);
        symbols.iter().all(|symbol| self.plant.parameters.iter().any(|p| p.symbol == *symbol))
    }
}

/// For each pair of components, true if the first is fed by the second, directly or through others.
fn fed(entries: &[Vec<Fraction>]) -> Vec<Vec<bool>> {
    let size = entries.len();
    let directly = |i: usize, j: usize| i == j || !entries[i][j].is_zero();
    let mut fed: Vec<Vec<bool>> = (0..size).map(|i| (0..size).map(|j| directly(i, j)).collect()).collect();
    for through in 0..size {
        let by = fed[through].clone();
        for row in fed.iter_mut().filter(|row| row[through]) {
            row.iter_mut().zip(&by).for_each(|(known, by)| *known |= by);
        }
    }
    fed
}

/// The determinant of Hurwitz of that size.
fn hurwitz(field: &Field<'_>, polynomial: &[Fraction], size: usize) -> Result<Fraction, Obstacle> {
    let entry = |row: usize, column: usize| {
        let index = (2 * (column + 1)).checked_sub(row + 1);
        index.and_then(|index| polynomial.get(index)).cloned().unwrap_or_else(Fraction::zero)
    };
    by_elimination(field, Matrix::build(size, size, entry))
}

//! Transforms with undetermined coefficients: `sum of c_ab m_a(x) n_b(y)`.
//!
//! ```text
//! functions m_a and n_b -> rows modulo a prime -> null space -> its support again, exactly -> functions
//! ```
//!
//! The rate of a transform is linear in the coefficients, however nonlinear the plant is, and it has to lie in the span
//! over the functions of y and u of given functions: of 1 for a plain cascade, of 1 and x for a generalised one. For
//! one (y, u) at a few x, a combination of the rates in which those functions cancel has to vanish: a row. Holds after:
//! the results satisfy the condition by exact algebra over the constants of the plant; nothing is proved of the domain.

use pebo_cas::Expr;
use pebo_cas::linear::Echelon;
use pebo_cas::linear::comparison::equations;
use pebo_cas::linear::residues::ResidueRows;
use pebo_cas::poly::{PrimeField, Residue};
use pebo_cas::tower::{Field, Fraction, Obstacle};

use super::problem::Problem;
use super::sample::{Sample, Values};

/// Columns with more terms than this in one solution are not worked out exactly.
const MOST_TERMS: usize = 24;

/// More columns than this are not looked at.
const MOST_COLUMNS: usize = 300;

/// The permitted rate of a transform.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Rate {
    /// Free of x.
    Free,
    /// Affine in x.
    Affine,
}

/// Functions whose products are the columns.
#[derive(Clone, Debug)]
pub(super) struct Ansatz {
    /// Functions of x, and perhaps y, each with a weight; the first is 1 if functions of y may occur alone.
    pub(super) of_x: Vec<(Expr, usize)>,
    /// Functions of y, each with a weight; the first is 1.
    pub(super) of_y: Vec<(Expr, usize)>,
    /// The largest weight of a product.
    pub(super) weight: usize,
}

/// The columns: positions of the two factors, lighter products first.
fn columns(problem: &Problem<'_>, ansatz: &Ansatz) -> Vec<(usize, usize)> {
    let mut columns = Vec::new();
    for (a, (m, first)) in ansatz.of_x.iter().enumerate() {
        for (b, (n, second)) in ansatz.of_y.iter().enumerate() {
            let constant = problem.arena.symbols_of(&[*m, *n]).is_disjoint(&problem.signals);
            if first + second <= ansatz.weight && !constant {
                columns.push((first + second, a, b));
            }
        }
    }
    columns.sort_unstable();
    columns.into_iter().map(|(_, a, b)| (a, b)).collect()
}

impl Ansatz {
    /// The number of columns.
    pub(super) fn width(&self, problem: &Problem<'_>) -> usize {
        columns(problem, self).len()
    }

    /// A basis of the transforms of this form with a permitted rate, each with as few late columns as can be;
    /// transforms without a state are left out.
    pub(super) fn solutions(&self, problem: &Problem<'_>, permitted: Rate) -> Result<Vec<Expr>, Obstacle> {
        let columns = columns(problem, self);
        if columns.len() > MOST_COLUMNS {
            return Err(Obstacle::TooLarge);
        }
        let found = self.likely(problem, permitted, &columns)?;
        let mut solutions = Vec::new();
        for (_, vector) in found {
            let support: Vec<usize> = (0..columns.len()).filter(|column| !vector[*column].is_zero()).collect();
            let products: Vec<Expr> = support
                .iter()
                .map(|column| {
                    let (a, b) = columns[*column];
                    problem.arena.mul(self.of_x[a].0, self.of_y[b].0)
                })
                .collect();
            let holds_state = products.iter().any(|e| problem.arena.depends_on(*e, &problem.hidden));
            if !holds_state || products.len() > MOST_TERMS {
                continue;
            }
            solutions.extend(exact(problem, permitted, &products)?);
        }
        Ok(solutions)
    }

    /// The null space modulo a prime.
    fn likely(
        &self,
        problem: &Problem<'_>,
        permitted: Rate,
        columns: &[(usize, usize)],
    ) -> Result<Vec<(usize, Values)>, Obstacle> {
        let arena = problem.arena;
        let factors = || self.of_x.iter().chain(&self.of_y).map(|(e, _)| *e);
        let mut formulas: Vec<Expr> = factors().collect();
        formulas.extend(factors().map(|e| problem.rate(e)));
        let known = match permitted {
            Rate::Free => Vec::new(),
            Rate::Affine => problem.x.iter().map(|x| arena.of_symbol(*x)).collect(),
        };
        let (count, points) = (self.of_x.len() + self.of_y.len(), known.len() + 2);
        formulas.extend(&known);
        let mut sample = Sample::of(problem, &formulas)?;
        let split = self.of_x.len();
        let row = |prime: &PrimeField, fibre: &[Values]| {
            let weights = weights(prime, fibre, 2 * count)?;
            let entry = |(a, b): &(usize, usize)| {
                let (a, b) = (*a, split + *b);
                fibre.iter().zip(&weights).fold(Residue::ZERO, |sum, (values, weight)| {
                    let first = prime.mul(values[count + a], values[b]);
                    let second = prime.mul(values[a], values[count + b]);
                    prime.add(sum, prime.mul(*weight, prime.add(first, second)))
                })
            };
            Some(columns.iter().map(entry).collect())
        };
        sample.rows(columns.len(), points, row).ok_or(Obstacle::OutOfBudget)
    }
}

/// Weights of the points of a fibre in which 1 and the functions from that index on cancel.
fn weights(prime: &PrimeField, fibre: &[Values], from: usize) -> Option<Values> {
    let mut rows = ResidueRows::new(prime, fibre.len());
    rows.insert(vec![prime.one(); fibre.len()]);
    for function in from..fibre.first()?.len() {
        rows.insert(fibre.iter().map(|values| values[function]).collect());
    }
    rows.null_space().into_iter().next().map(|(_, vector)| vector)
}

/// The combination of the products with a permitted rate, exactly; none if there is no single one.
fn exact(problem: &Problem<'_>, permitted: Rate, products: &[Expr]) -> Result<Option<Expr>, Obstacle> {
    let arena = problem.arena;
    let rates: Vec<Expr> = products.iter().map(|product| problem.rate(*product)).collect();
    let along = |exprs: &[Expr], symbol| exprs.iter().map(|e| arena.derivative(*e, symbol)).collect::<Vec<Expr>>();
    let mut conditions = Vec::new();
    for hidden in &problem.hidden {
        let slopes = along(&rates, *hidden);
        if permitted == Rate::Free || !problem.x.contains(hidden) {
            conditions.push(slopes);
        } else {
            conditions.extend(problem.hidden.iter().map(|other| along(&slopes, *other)));
        }
    }
    let roots: Vec<Expr> = conditions.iter().flatten().copied().collect();
    let field = Field::over(arena, &problem.domain.facts, &roots)?;
    let matrix = equations(&field, &conditions, &problem.signals)?;
    let vectors = Echelon::of(&field, matrix, products.len())?.0.null_space();
    let [vector] = vectors.as_slice() else { return Ok(None) };
    // The first that holds a state has the coefficient 1.
    let states = |(e, c): &(&Expr, &Fraction)| !c.is_zero() && arena.depends_on(**e, &problem.hidden);
    let Some((_, unit)) = products.iter().zip(vector).find(states) else { return Ok(None) };
    let mut terms = Vec::new();
    for (product, coefficient) in products.iter().zip(vector) {
        let coefficient = field.show(&field.div(coefficient, unit)?);
        terms.push(arena.mul(coefficient, *product));
    }
    Ok(Some(arena.sum(terms)))
}

//! Completes linear partial differential equations for functions of y to an integrable system.
//!
//! ```text
//! rows over [dw | w] -> equations in w alone are solved -> mixed derivatives agree -> and so on -> dw = G w, flat
//! ```
//!
//! In: equations of first order for unknown functions w of y, linear and homogeneous, over a field of functions of y.
//! Three steps add their consequences. An equation without derivatives is solved, and fewer functions are left. A
//! derivative that no equation gives becomes an unknown function of its own. Second derivatives do not depend on the
//! order: that gives further equations. Holds after: the original functions are `lift w` of the remaining ones, so that
//! the rank of `lift` bounds that of all solutions. Where each derivative is given and second derivatives agree, a
//! solution is given by its values at a point, any values (Frobenius): there are as many as functions are left.

pub(crate) mod connection;
pub(crate) mod decision;
mod flat;
mod gradient;
pub(super) mod integration;

use pebo_cas::Symbol;
use pebo_cas::linear::{Echelon, Matrix};
use pebo_cas::poly::Poly;
use pebo_cas::tower::{Field, Fraction, Obstacle};

/// Rounds after which a completion is given up.
const MOST_ROUNDS: usize = 24;

/// More functions than this are not completed.
const MOST_FUNCTIONS: usize = 24;

pub(super) type EquationRow = Vec<Fraction>;

/// Differentiation of the elements of a field by some symbols.
#[derive(Debug)]
pub(super) struct Derivations<'a> {
    pub(super) field: &'a Field<'a>,
    /// For each symbol, the kernels that depend on it with their derivatives.
    slopes: Vec<Vec<(u32, Fraction)>>,
}

impl<'a> Derivations<'a> {
    /// The kernels' derivatives have to be in the field.
    pub(super) fn of(field: &'a Field<'a>, symbols: &[Symbol]) -> Result<Self, Obstacle> {
        let slopes = symbols.iter().map(|symbol| {
            let kernels = field.kernels_of(&[*symbol].into()).into_iter();
            let slope = |kernel: u32| field.fraction(field.arena().derivative(field.kernel(kernel), *symbol));
            kernels.map(|kernel| Ok((kernel, slope(kernel)?))).collect::<Result<Vec<_>, Obstacle>>()
        });
        Ok(Self { field, slopes: slopes.collect::<Result<_, _>>()? })
    }

    fn count(&self) -> usize {
        self.slopes.len()
    }

    /// The derivative by the symbol at this index.
    fn derivative(&self, of: &Fraction, by: usize) -> Result<Fraction, Obstacle> {
        let field = self.field;
        let along = |poly: &Poly| {
            self.slopes[by].iter().try_fold(Fraction::zero(), |sum, (kernel, slope)| {
                let partial = field.of_polynomial(&poly.derivative(*kernel))?;
                field.add(&sum, &field.mul(&partial, slope)?)
            })
        };
        let above = along(of.numerator())?;
        if of.denominator().is_constant() {
            return field.div(&above, &field.of_polynomial(of.denominator())?);
        }
        // (n / d)' = (n' - (n / d) d') / d
        let below = field.mul(of, &along(of.denominator())?)?;
        field.div(&field.sub(&above, &below)?, &field.of_polynomial(of.denominator())?)
    }
}

/// Equations for functions w of y.
#[derive(Debug)]
pub(super) struct System<'a> {
    by: &'a Derivations<'a>,
    /// The number of functions.
    functions: usize,
    /// So many of the first are to be given in terms of the others.
    given: usize,
    /// A row has a column for each derivative, those of one function in sequence, and then one for each function.
    rows: Vec<EquationRow>,
    /// The wanted functions, in terms of the functions.
    lift: Vec<EquationRow>,
}

/// The result of a completion.
#[derive(Debug)]
pub(super) struct Completion {
    /// The wanted functions, in terms of the remaining ones.
    pub(super) lift: Vec<EquationRow>,
    /// The number of remaining functions.
    pub(super) functions: usize,
    /// The derivatives of these, where each is given: for each function and symbol, its coefficients in terms of the
    /// functions.
    pub(super) slopes: Vec<Vec<EquationRow>>,
    pub(super) solutions: Solutions,
}

/// The number of independent solutions around a point.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Solutions {
    /// As many as functions are left: each choice of their values at a point gives one.
    AsFunctions,
    /// Functions of y may be chosen.
    Infinite,
    /// The completion was not carried to its end.
    Unknown,
}

impl<'a> System<'a> {
    /// The equations; the wanted functions come first.
    pub(super) fn new(by: &'a Derivations<'a>, (wanted, functions): (usize, usize), rows: Vec<EquationRow>) -> Self {
        Self { by, functions, given: 0, rows, lift: (0..wanted).map(|index| unit(functions, index)).collect() }
    }

    /// The same, with so many of the first functions to be given in terms of the others where that can be.
    pub(super) fn giving(self, given: usize) -> Self {
        Self { given, ..self }
    }

    /// The same equations for solutions in which all wanted functions vanish.
    pub(super) fn vanishing(&self) -> Self {
        let padding = vec![Fraction::zero(); self.functions * self.by.count()];
        let vanishes = self.lift.iter().map(|row| [padding.as_slice(), row].concat());
        let rows = self.rows.iter().cloned().chain(vanishes).collect();
        Self { rows, lift: Vec::new(), ..*self }
    }

    /// Adds all that follows.
    pub(super) fn completed(mut self) -> Result<Completion, Obstacle> {
        for _ in 0..MOST_ROUNDS {
            let width = self.functions * self.by.count();
            let rows = Matrix::new(std::mem::take(&mut self.rows));
            let (slopes, rest) = Echelon::of(self.by.field, rows, width)?;
            let values = Echelon::in_order(self.by.field, rest.behind(width), (self.given, self.functions))?;
            if values.rank() > 0 {
                self.solve(&slopes, &values)?;
                continue;
            }
            let is_given = slopes.rank() == width;
            let equations = self.mixed(&slopes)?;
            if is_given && equations.is_empty() {
                let count = self.by.count();
                let of = |column: usize| self.rows[column][width..].iter().map(Fraction::opposite).collect();
                let slopes = (0..self.functions).map(|f| (0..count).map(|by| of(f * count + by)).collect()).collect();
                return Ok(Completion { slopes, ..self.ended(Solutions::AsFunctions) });
            }
            // There is nothing with which derivatives by one symbol could disagree.
            if self.by.count() == 1 {
                return Ok(self.ended(Solutions::Infinite));
            }
            if self.functions > MOST_FUNCTIONS {
                break;
            }
            self.rows.extend(equations);
        }
        Ok(self.ended(Solutions::Unknown))
    }

    fn ended(self, solutions: Solutions) -> Completion {
        Completion { lift: self.lift, functions: self.functions, slopes: Vec::new(), solutions }
    }

    /// Replaces functions by combinations of the remaining ones.
    fn solve(&mut self, slopes: &Echelon, values: &Echelon) -> Result<(), Obstacle> {
        let (field, directions, before) = (self.by.field, self.by.count(), self.functions);
        // The functions are the columns of `basis` times the remaining ones.
        let basis = values.null_space();
        let mut changes = Vec::new();
        for vector in &basis {
            let by =
                |direction| vector.iter().map(|e| self.by.derivative(e, direction)).collect::<Result<EquationRow, _>>();
            changes.push((0..directions).map(by).collect::<Result<Vec<EquationRow>, Obstacle>>()?);
        }
        let mut rows = Vec::new();
        for (_, row) in slopes.rows() {
            let (derivatives, values) = row.split_at(before * directions);
            let along = |direction: usize| derivatives.iter().skip(direction).step_by(directions);
            let mut next = Vec::new();
            for vector in &basis {
                for direction in 0..directions {
                    next.push(field.dot(along(direction), vector)?);
                }
            }
            for (vector, change) in basis.iter().zip(&changes) {
                let mut sum = field.dot(values, vector)?;
                for (direction, change) in change.iter().enumerate() {
                    sum = field.add(&sum, &field.dot(along(direction), change)?)?;
                }
                next.push(sum);
            }
            rows.push(next);
        }
        for row in &mut self.lift {
            *row = basis.iter().map(|vector| field.dot(row.iter(), vector)).collect::<Result<_, _>>()?;
        }
        let is_given = |column: &usize| values.rows().any(|(pivot, _)| pivot == *column);
        self.given = (0..self.given).filter(|column| !is_given(column)).count();
        (self.rows, self.functions) = (rows, basis.len());
        Ok(())
    }

    /// Makes unknown functions of the derivatives that are not given, keeps the others as rows, and gives the equations
    /// that say that second derivatives agree.
    fn mixed(&mut self, slopes: &Echelon) -> Result<Vec<EquationRow>, Obstacle> {
        let (field, directions, before) = (self.by.field, self.by.count(), self.functions);
        let width = before * directions;
        let free: Vec<usize> = slopes.free().collect();
        let after = before + free.len();
        // Every first derivative of the functions before, in all functions.
        let mut given = vec![Vec::new(); width];
        for (index, column) in free.iter().enumerate() {
            given[*column] = unit(after, before + index);
        }
        for (pivot, row) in slopes.rows() {
            let derivatives = free.iter().map(|column| row[*column].opposite());
            given[pivot] = row[width..].iter().map(Fraction::opposite).chain(derivatives).collect();
        }
        let mut equations = Vec::new();
        for function in 0..before {
            for (first, second) in (0..directions).flat_map(|k| (0..k).map(move |j| (j, k))) {
                let mut row = vec![Fraction::zero(); after * (directions + 1)];
                for (one, other, negative) in [(first, second, false), (second, first, true)] {
                    for (index, factor) in given[function * directions + one].iter().enumerate() {
                        let mut add = |column: usize, term: Fraction| -> Result<(), Obstacle> {
                            let sum =
                                if negative { field.sub(&row[column], &term) } else { field.add(&row[column], &term) };
                            row[column] = sum?;
                            Ok(())
                        };
                        add(after * directions + index, self.by.derivative(factor, other)?)?;
                        if index >= before {
                            add(index * directions + other, factor.clone())?;
                        } else if !factor.is_zero() {
                            for (column, inner) in given[index * directions + other].iter().enumerate() {
                                add(after * directions + column, field.mul(factor, inner)?)?;
                            }
                        }
                    }
                }
                if row.iter().any(|entry| !entry.is_zero()) {
                    equations.push(row);
                }
            }
        }
        self.rows = (0..width)
            .map(|column| {
                let mut derivatives = unit(after * directions, column);
                derivatives.extend(given[column].iter().map(Fraction::opposite));
                derivatives
            })
            .collect();
        for row in &mut self.lift {
            row.resize(after, Fraction::zero());
        }
        self.functions = after;
        Ok(equations)
    }
}

fn unit(length: usize, index: usize) -> EquationRow {
    let mut row = vec![Fraction::zero(); length];
    row[index] = Fraction::one();
    row
}

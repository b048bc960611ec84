//! Matrices of expressions, for the classes of plants.
//!
//! Entries are kept as the shortest exact form that is at hand: the author's own, or a computed normal form.

mod adjugate;

use pebo_cas::linear::Echelon;
use pebo_cas::linear::determinant::determinant;
use pebo_cas::linear::rank::proved_rank;
use pebo_cas::tower::{Field, Fraction, Obstacle};
use pebo_cas::{Arena, Domain, Expr, Facts, Symbol};

/// A matrix of expressions, by rows; at least one entry.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Matrix {
    rows: Vec<Vec<Expr>>,
}

impl Matrix {
    /// The matrix with these rows, all of one length.
    pub fn new(rows: Vec<Vec<Expr>>) -> Self {
        debug_assert!(rows.windows(2).all(|pair| pair[0].len() == pair[1].len()));
        Self { rows }
    }

    /// The matrix with the entry that `entry` gives for each row and column.
    pub fn build(height: usize, width: usize, entry: impl Fn(usize, usize) -> Expr) -> Self {
        Self { rows: (0..height).map(|i| (0..width).map(|j| entry(i, j)).collect()).collect() }
    }

    /// Zero.
    pub fn zero(arena: &Arena, height: usize, width: usize) -> Self {
        Self::build(height, width, |_, _| arena.zero())
    }

    /// The identity.
    pub fn identity(arena: &Arena, size: usize) -> Self {
        Self::build(size, size, |i, j| arena.number(i64::from(i == j)))
    }

    /// The number of rows.
    pub fn height(&self) -> usize {
        self.rows.len()
    }

    /// The number of columns.
    pub fn width(&self) -> usize {
        self.rows.first().map_or(0, Vec::len)
    }

    /// The rows.
    pub fn rows(&self) -> &[Vec<Expr>] {
        &self.rows
    }

    /// An entry.
    pub fn at(&self, row: usize, column: usize) -> Expr {
        self.rows[row][column]
    }

    /// A column.
    pub fn column(&self, column: usize) -> Vec<Expr> {
        self.rows.iter().map(|row| row[column]).collect()
    }

    /// All entries, row by row.
    pub fn entries(&self) -> Vec<Expr> {
        self.rows.concat()
    }

    /// Rows for columns.
    #[must_use]
    pub fn transpose(&self) -> Self {
        Self::build(self.width(), self.height(), |i, j| self.at(j, i))
    }

    /// The sum.
    #[must_use]
    pub fn add(&self, arena: &Arena, other: &Self) -> Self {
        Self::build(self.height(), self.width(), |i, j| arena.add(self.at(i, j), other.at(i, j)))
    }

    /// The product.
    #[must_use]
    pub fn mul(&self, arena: &Arena, other: &Self) -> Self {
        let columns: Vec<Vec<Expr>> = (0..other.width()).map(|column| other.column(column)).collect();
        Self::build(self.height(), other.width(), |i, j| arena.dot(&self.rows[i], &columns[j]))
    }

    /// The product with a column.
    pub fn apply(&self, arena: &Arena, vector: &[Expr]) -> Vec<Expr> {
        self.rows.iter().map(|row| dot(arena, row, vector)).collect()
    }

    /// The matrix with a function applied to each entry.
    #[must_use]
    pub fn map(&self, change: impl Fn(Expr) -> Expr) -> Self {
        Self::build(self.height(), self.width(), |i, j| change(self.at(i, j)))
    }

    /// The partial derivative of each entry.
    #[must_use]
    pub fn derivative(&self, arena: &Arena, symbol: Symbol) -> Self {
        self.map(|entry| arena.derivative(entry, symbol))
    }

    /// The matrix with each entry in normal form.
    pub fn normal(&self, arena: &Arena, facts: &Facts) -> Result<Self, Obstacle> {
        let field = Field::of_long_sums(arena, facts, &self.entries())?;
        let printed = |row: &Vec<Expr>| row.iter().map(|e| Ok(field.show(&field.fraction(*e)?))).collect();
        Ok(Self { rows: self.rows.iter().map(printed).collect::<Result<_, Obstacle>>()? })
    }

    /// The inverse in normal form; none if the determinant is zero everywhere.
    pub fn inverse(&self, arena: &Arena, facts: &Facts) -> Result<Option<Self>, Obstacle> {
        let size = self.height();
        let field = Field::of_long_sums(arena, facts, &self.entries())?;
        let mut augmented = Vec::with_capacity(size);
        for (i, row) in self.rows.iter().enumerate() {
            let mut fractions = row.iter().map(|e| field.fraction(*e)).collect::<Result<Vec<_>, _>>()?;
            fractions.extend((0..size).map(|j| if i == j { Fraction::one() } else { Fraction::zero() }));
            augmented.push(fractions);
        }
        let (echelon, _) = Echelon::of(&field, augmented, size)?;
        if echelon.rank() < size {
            return Ok(None);
        }
        let rows = echelon.rows().map(|(_, row)| row[size..].iter().map(|e| field.show(e)).collect()).collect();
        Ok(Some(Self { rows }))
    }

    /// The rank over the field of functions that the entries generate.
    pub fn rank(&self, arena: &Arena, facts: &Facts) -> Result<usize, Obstacle> {
        // A rank at a point is a lower bound: the greatest possible one needs no elimination.
        let most = self.height().min(self.width());
        let domain = Domain { facts: facts.clone(), ..Domain::default() };
        if proved_rank(arena, &domain, &self.rows, self.width()) == most {
            return Ok(most);
        }
        self.echelon(arena, facts, |_, echelon| echelon.rank())
    }

    /// A basis of the columns v with `self * v = 0`.
    pub fn null_space(&self, arena: &Arena, facts: &Facts) -> Result<Vec<Vec<Expr>>, Obstacle> {
        self.echelon(arena, facts, |field, echelon| {
            let printed = |vector: &Vec<Fraction>| vector.iter().map(|e| field.show(e)).collect();
            echelon.null_space().iter().map(printed).collect()
        })
    }

    /// The determinant in normal form.
    pub fn determinant(&self, arena: &Arena, facts: &Facts) -> Result<Expr, Obstacle> {
        let field = Field::of_long_sums(arena, facts, &self.entries())?;
        let fractions = |row: &Vec<Expr>| row.iter().map(|e| field.fraction(*e)).collect();
        let rows = self.rows.iter().map(fractions).collect::<Result<Vec<Vec<Fraction>>, _>>()?;
        Ok(field.show(&determinant(&field, rows)?))
    }

    fn echelon<T>(
        &self,
        arena: &Arena,
        facts: &Facts,
        read: impl FnOnce(&Field<'_>, &Echelon) -> T,
    ) -> Result<T, Obstacle> {
        let field = Field::of_long_sums(arena, facts, &self.entries())?;
        let fractions = |row: &Vec<Expr>| row.iter().map(|e| field.fraction(*e)).collect();
        let rows = self.rows.iter().map(fractions).collect::<Result<Vec<Vec<Fraction>>, _>>()?;
        let (echelon, _) = Echelon::of(&field, rows, self.width())?;
        Ok(read(&field, &echelon))
    }
}

/// The sum of the products of the entries.
pub(crate) fn dot(arena: &Arena, left: &[Expr], right: &[Expr]) -> Expr {
    arena.dot(left, right)
}

//! Matrices with entries of one type: expressions, fractions, polynomials.

/// A matrix, by rows of one length.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Matrix<T> {
    rows: Vec<Vec<T>>,
}

impl<T> Matrix<T> {
    /// The matrix with these rows, all of one length.
    pub fn new(rows: Vec<Vec<T>>) -> Self {
        debug_assert!(rows.windows(2).all(|pair| pair[0].len() == pair[1].len()));
        Self { rows }
    }

    /// The matrix with the entry that `entry` gives for each row and column.
    pub fn build(height: usize, width: usize, entry: impl Fn(usize, usize) -> T) -> Self {
        Self { rows: (0..height).map(|i| (0..width).map(|j| entry(i, j)).collect()).collect() }
    }

    /// The number of rows.
    pub fn height(&self) -> usize {
        self.rows.len()
    }

    /// The number of columns; of no rows, none.
    pub fn width(&self) -> usize {
        self.rows.first().map_or(0, Vec::len)
    }

    /// The rows.
    pub fn rows(&self) -> &[Vec<T>] {
        &self.rows
    }

    /// The rows alone.
    pub fn into_rows(self) -> Vec<Vec<T>> {
        self.rows
    }

    /// The matrix with a function applied to each entry.
    #[must_use]
    pub fn map<U>(&self, change: impl Fn(&T) -> U) -> Matrix<U> {
        Matrix { rows: self.rows.iter().map(|row| row.iter().map(&change).collect()).collect() }
    }

    /// The same, if the function has a value for all.
    pub fn try_map<U, E>(&self, change: impl Fn(&T) -> Result<U, E>) -> Result<Matrix<U>, E> {
        let row = |row: &Vec<T>| row.iter().map(&change).collect();
        Ok(Matrix { rows: self.rows.iter().map(row).collect::<Result<_, E>>()? })
    }
}

impl<T: Clone> Matrix<T> {
    /// An entry.
    pub fn at(&self, row: usize, column: usize) -> T {
        self.rows[row][column].clone()
    }

    /// A column.
    pub fn column(&self, column: usize) -> Vec<T> {
        self.rows.iter().map(|row| row[column].clone()).collect()
    }

    /// All entries, row by row.
    pub fn entries(&self) -> Vec<T> {
        self.rows.concat()
    }

    /// The columns from a place on.
    #[must_use]
    pub fn behind(&self, columns: usize) -> Self {
        Self { rows: self.rows.iter().map(|row| row[columns..].to_vec()).collect() }
    }

    /// Rows for columns.
    #[must_use]
    pub fn transpose(&self) -> Self {
        Self::build(self.width(), self.height(), |i, j| self.at(j, i))
    }
}

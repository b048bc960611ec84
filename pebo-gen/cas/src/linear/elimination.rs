//! The one loop of elimination, for entries of any kind.
//!
//! In: rows, the choice of each pivot, and the step that clears its column in another row. These differ: fractions take
//! the lightest pivot, integers divide exactly, enclosures and floating point take the largest. Out: the pivot rows as
//! they were chosen, and the rows that are left when nothing is chosen.

/// A row with its place among those given.
pub(crate) type PlacedRow<T> = (usize, Vec<T>);

/// A pivot row.
pub(crate) struct Pivot<T> {
    /// The place of the row among those given.
    pub(crate) place: usize,
    pub(crate) column: usize,
    pub(crate) row: Vec<T>,
}

/// The result of an elimination.
pub(crate) struct Eliminated<T> {
    pub(crate) pivots: Vec<Pivot<T>>,
    pub(crate) rest: Vec<Vec<T>>,
    /// True if the pivot rows are an odd permutation of the rows given, where no row is left.
    pub(crate) odd: bool,
}

/// The rows in which the column of a pivot is cleared.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Reach {
    /// Those that are left.
    Below,
    /// The pivot rows too.
    All,
}

/// Eliminates: `choose` gives the index of a row among those left, and its column; `keep` changes a pivot row before
/// its column is cleared.
pub(crate) fn eliminate<T, E>(
    rows: Vec<Vec<T>>,
    reach: Reach,
    mut choose: impl FnMut(&[PlacedRow<T>]) -> Option<(usize, usize)>,
    mut keep: impl FnMut(Vec<T>, usize) -> Result<Vec<T>, E>,
    mut clear: impl FnMut(&mut [T], &[T], usize) -> Result<(), E>,
) -> Result<Eliminated<T>, E> {
    let mut rest: Vec<PlacedRow<T>> = rows.into_iter().enumerate().collect();
    let (mut pivots, mut odd) = (Vec::<Pivot<T>>::new(), false);
    while let Some((index, column)) = choose(&rest) {
        let last = rest.len() - 1;
        // The row moves to the front, and the last one to its place.
        odd ^= (index == last) == (last % 2 == 1);
        let (place, row) = rest.swap_remove(index);
        let row = keep(row, column)?;
        let above = if reach == Reach::All { pivots.as_mut_slice() } else { &mut [] };
        for other in rest.iter_mut().map(|(_, row)| row).chain(above.iter_mut().map(|pivot| &mut pivot.row)) {
            clear(other, &row, column)?;
        }
        pivots.push(Pivot { place, column, row });
    }
    Ok(Eliminated { pivots, rest: rest.into_iter().map(|(_, row)| row).collect(), odd })
}

/// A choice column by column, which passes those over that have no pivot.
pub(crate) fn by_columns<T>(
    columns: usize,
    choose: impl Fn(&[PlacedRow<T>], usize) -> Option<usize>,
) -> impl FnMut(&[PlacedRow<T>]) -> Option<(usize, usize)> {
    let mut columns = 0..columns;
    move |rest| columns.find_map(|column| Some((choose(rest, column)?, column)))
}

/// The first row that is not zero in a column.
pub(crate) fn first<T>(is_zero: impl Fn(&T) -> bool) -> impl Fn(&[PlacedRow<T>], usize) -> Option<usize> {
    move |rest, column| rest.iter().position(|(_, row)| !is_zero(&row[column]))
}

//! Written matrices in the sizes that the class needs.
//!
//! A matrix is a list of rows. A plain list is a row, a column, or, where that is allowed, a diagonal; a single formula
//! is the only entry, or that multiple of the identity.

use std::collections::BTreeSet;

use crate::model;
use crate::plant::Matrix;
use crate::source::{Code, Diagnostic, Diagnostics, Span};
use pebo_cas::Symbol;
use pebo_cas::domain::zero::{Answer, decide};

use super::context::{ClassContext, unresolved};

/// The size of a matrix, and the names of its counts.
#[derive(Clone, Copy)]
pub(super) struct Size {
    pub(super) height: usize,
    pub(super) width: usize,
    /// True if a list may be a diagonal, and a formula a multiple of the identity.
    pub(super) diagonal: bool,
    /// As `outputs x states`.
    pub(super) counted: &'static str,
}

/// A written matrix with its name.
#[derive(Clone, Copy)]
pub(super) struct WrittenMatrix<'a> {
    pub(super) name: &'static str,
    pub(super) matrix: &'a Option<model::Matrix>,
}

impl ClassContext<'_> {
    /// The matrix in that size; zero where none is written. Mistakes are reported.
    pub(super) fn matrix(
        &self,
        written: WrittenMatrix<'_>,
        size: Size,
        allowed: &BTreeSet<Symbol>,
        problems: &mut Diagnostics,
    ) -> Option<Matrix> {
        let Some(matrix) = written.matrix else { return Some(Matrix::zero(self.arena, size.height, size.width)) };
        let mut rows = Vec::with_capacity(matrix.rows.len());
        let mut sound = true;
        for row in &matrix.rows {
            let lowered = row.iter().map(|f| problems.keep(self.formula(f, allowed, written.name)));
            // Every entry is checked, even after a mistake.
            let lowered: Vec<_> = lowered.collect();
            let row: Option<Vec<_>> = lowered.into_iter().collect();
            sound &= row.is_some();
            rows.extend(row);
        }
        if !sound {
            return None;
        }
        let Size { height, width, .. } = size;
        let zero = self.arena.zero();
        let fitted = match (matrix.depth, rows.as_slice()) {
            (2, rows) if rows.len() == height && rows[0].len() == width => Some(Matrix::new(rows.to_vec())),
            (1, [list]) if height == 1 && list.len() == width => Some(Matrix::new(vec![list.clone()])),
            (1, [list]) if width == 1 && list.len() == height => Some(Matrix::build(height, 1, |i, _| list[i])),
            (1, [list]) if size.diagonal && list.len() == height => {
                Some(Matrix::build(height, width, |i, j| if i == j { list[i] } else { zero }))
            }
            (0, [list]) if (height, width) == (1, 1) || (size.diagonal && height == width) => {
                Some(Matrix::build(height, width, |i, j| if i == j { list[0] } else { zero }))
            }
            _ => None,
        };
        if fitted.is_none() {
            problems.push(misfit(written.name, matrix, size));
        }
        fitted
    }

    /// Tests whether the matrix is symmetric; reports it if not.
    pub(super) fn symmetric(&self, name: &str, matrix: &Matrix, span: Span) -> Result<(), Diagnostic> {
        for i in 0..matrix.height() {
            for j in 0..i {
                let difference = self.arena.sub(matrix.at(i, j), matrix.at(j, i));
                match decide(self.arena, difference, self.domain) {
                    Answer::Zero => {}
                    Answer::NonZero(_) => {
                        let message = format!("{name} is not symmetric");
                        let entry = |row: usize, column: usize| {
                            format!(
                                "entry ({}, {}) is {}",
                                row + 1,
                                column + 1,
                                self.arena.print(matrix.at(row, column))
                            )
                        };
                        return Err(Diagnostic::error(Code::NotSymmetric, span, message)
                            .label(format!("{}, {}", entry(i, j), entry(j, i)))
                            .help(format!(
                                "write the same formula in both places: {name} is the matrix of an energy"
                            )));
                    }
                    Answer::Open(obstacle) => return Err(unresolved(name, span, &obstacle)),
                }
            }
        }
        Ok(())
    }
}

fn misfit(name: &str, matrix: &model::Matrix, size: Size) -> Diagnostic {
    let found = match matrix.depth {
        0 => "a single formula".to_owned(),
        1 => format!("a list of {}", matrix.rows[0].len()),
        _ => extent(matrix.rows.len(), matrix.rows[0].len()),
    };
    let Size { height, width, diagonal, counted } = size;
    let message = format!("{name} is {found} where {} is expected ({counted})", extent(height, width));
    let diagnostic = Diagnostic::error(Code::WrongShape, matrix.span, message);
    if height == 0 || width == 0 {
        return diagnostic.help(format!("remove {name}, or declare what it acts on"));
    }
    let row = format!("[{}]", vec!["0"; width].join(", "));
    let example = format!("`{name}: [{}]`", vec![row; height].join(", "));
    diagnostic.help(if diagonal && height > 1 {
        format!("write {example}, or a list of {height} for a diagonal matrix")
    } else {
        format!("write {example}")
    })
}

/// As `2 rows of 3`.
fn extent(height: usize, width: usize) -> String {
    format!("{height} row{} of {width}", if height == 1 { "" } else { "s" })
}

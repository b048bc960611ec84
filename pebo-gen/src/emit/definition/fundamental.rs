//! Entries of the fundamental matrix that never change.
//!
//! In: `Lambda` of `Psi' = Lambda Psi`, `Psi(0) = I`. Out: which entries of Psi are 0 or 1 for ever, whatever the
//! signals: `Psi_ij` is 0 unless a chain of non-zero entries of Lambda leads from j to i, and `Psi_ii` is 1 unless one
//! leads from i back to i. Re-basing sets the identity, for which the same holds.

use pebo_cas::{Arena, Expr};

/// For each entry of Psi, by rows, its constant value if it has one.
pub(in crate::emit) fn constant_entries(arena: &Arena, lambda: &[Vec<Expr>]) -> Vec<Vec<Option<Expr>>> {
    let size = lambda.len();
    // reached[i][j]: from j to i; every index reaches itself.
    let mut reached: Vec<Vec<bool>> = lambda
        .iter()
        .enumerate()
        .map(|(i, row)| row.iter().enumerate().map(|(j, entry)| i == j || !arena.is_zero(*entry)).collect())
        .collect();
    for middle in 0..size {
        let through = reached[middle].clone();
        for row in &mut reached {
            if row[middle] {
                row.iter_mut().zip(&through).for_each(|(entry, &leads)| *entry |= leads);
            }
        }
    }
    let entry = |i: usize, j: usize| match reached[i][j] {
        false => Some(arena.zero()),
        // Its rate has no term that is not zero for ever.
        true if i == j && (0..size).all(|k| arena.is_zero(lambda[i][k]) || !reached[k][i]) => Some(arena.one()),
        true => None,
    };
    (0..size).map(|i| (0..size).map(|j| entry(i, j)).collect()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_lambda_does_not_connect_stays_as_it_starts() {
        let arena = Arena::new();
        let (zero, a) = (arena.zero(), arena.variable("a"));
        // The first moves by itself, the second by the first, the third not at all; the fourth by the third.
        let lambda = vec![vec![a, zero, zero, zero], vec![a, zero, zero, zero], vec![zero; 4], vec![zero, zero, a, a]];
        let found = constant_entries(&arena, &lambda);
        let shown: Vec<String> = found
            .iter()
            .map(|row| row.iter().map(|entry| entry.map_or("*".to_owned(), |value| arena.print(value))).collect())
            .collect();
        assert_eq!(shown, ["*000", "*100", "0010", "00**"]);
    }
}

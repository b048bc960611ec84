//! Decides with which inputs the outputs of a row were sampled.
//!
//! In: the first rows of a recording. Out: the row whose inputs stand in outputs that are given by values with inputs in
//! them, as `V = U0 - R0*I`. A logger samples both at once, so it is the same row; a controller samples before it sets new
//! inputs, so it is the row before. The changes of outputs from row to row tell which, by a regression on those of the
//! inputs of each.

use std::collections::BTreeSet;

use pebo_cas::Symbol;
use pebo_design::plant::Plant;

/// The row whose inputs stand in the outputs of a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum InputRow {
    /// That before it: inputs hold from row to row.
    Before,
    /// The row itself.
    Same,
}

/// By how much, in logarithms of likelihood, the row before has to explain the outputs better: one in a thousand does by
/// chance.
const CLEARLY: f64 = 7.0;

/// Of so small a share of the outputs' changes nothing remains but rounding.
const ROUNDING: f64 = 1e-20;

impl InputRow {
    /// The row for a plant with these samples of its signals, and true if they tell.
    pub(super) fn of(plant: &Plant, samples: &[(Symbol, Vec<f64>)]) -> (Self, bool) {
        let inputs: BTreeSet<Symbol> = plant.commanded().collect();
        let of_signal = |symbol: Symbol| samples.iter().find(|(signal, _)| *signal == symbol).map(|(_, values)| values);
        let mut advantage = None;
        for output in &plant.y {
            let Some(value) = &output.value else { continue };
            let own = plant.arena.symbols_of(&[value.expr]).into_iter().filter(|symbol| inputs.contains(symbol));
            let own: Vec<&Vec<f64>> = own.filter_map(of_signal).collect();
            if let Some(values) = of_signal(output.symbol).filter(|_| !own.is_empty()) {
                *advantage.get_or_insert(0.0) += advantage_of_before(values, &own);
            }
        }
        match advantage {
            Some(advantage) if advantage <= CLEARLY => (Self::Same, advantage < -CLEARLY),
            _ => (Self::Before, true),
        }
    }
}

/// How much more likely an output is with the inputs of the row before than with those of the same, as a logarithm.
fn advantage_of_before(output: &[f64], inputs: &[&Vec<f64>]) -> f64 {
    let is_known = |row: &usize| {
        (row - 2..=*row).all(|row| inputs.iter().all(|input| input[row].is_finite()))
            && (row - 1..=*row).all(|row| output[row].is_finite())
    };
    let rows: Vec<usize> = (2..output.len()).filter(is_known).collect();
    let changes = |signal: &[f64], lag: usize| -> Vec<f64> {
        rows.iter().map(|row| signal[row - lag] - signal[row - lag - 1]).collect()
    };
    let change = changes(output, 0);
    let rest = |lag: usize| {
        let by: Vec<Vec<f64>> = inputs.iter().map(|input| changes(input, lag)).collect();
        unexplained(change.clone(), by) + ROUNDING * dot(&change, &change)
    };
    let (before, same) = (rest(1), rest(0));
    if before > 0.0 {
        0.5 * crate::timing::real(u64::try_from(rows.len()).unwrap_or(0)) * (same / before).ln()
    } else {
        0.0
    }
}

/// The sum of squares of a series that is left by a regression on others.
fn unexplained(mut series: Vec<f64>, mut others: Vec<Vec<f64>>) -> f64 {
    while let Some(one) = others.pop() {
        let square = dot(&one, &one);
        if square > 0.0 {
            for other in others.iter_mut().chain([&mut series]) {
                let share = dot(&one, other) / square;
                other.iter_mut().zip(&one).for_each(|(value, part)| *value -= share * part);
            }
        }
    }
    dot(&series, &series)
}

fn dot(one: &[f64], other: &[f64]) -> f64 {
    one.iter().zip(other).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A voltage and its current, with the current of as many rows before in it.
    fn rows(lag: usize, noise: f64) -> [Vec<f64>; 2] {
        let time = |row: usize| crate::timing::real(u64::try_from(row).unwrap());
        let current = |row: usize| (0.05 * time(row)).sin() + if row % 40 < 20 { 1.0 } else { 0.0 };
        let voltage = |row: usize| 3.0 - 0.02 * current(row - lag) + noise * (1.9 * time(row * row)).sin();
        let rows = 1..256;
        [rows.clone().map(voltage).collect(), rows.map(current).collect()]
    }

    #[test]
    fn outputs_move_with_the_inputs_that_are_in_them() {
        for noise in [0.0, 0.005] {
            for (lag, is_before) in [(1, true), (0, false)] {
                let [voltage, current] = rows(lag, noise);
                let advantage = advantage_of_before(&voltage, &[&current]);
                assert_eq!(advantage > CLEARLY, is_before, "{noise} {lag} {advantage}");
                assert_eq!(advantage < -CLEARLY, !is_before, "{noise} {lag} {advantage}");
                // A second input that does nothing, and one without a value, do not change that.
                let mut other: Vec<f64> = current.iter().map(|i| (7.0 * i).cos()).collect();
                other[10] = f64::NAN;
                let beside = advantage_of_before(&voltage, &[&current, &other]);
                assert_eq!(beside > CLEARLY, is_before, "{noise} {lag} {beside}");
            }
        }
        // Noise that hides the input, or an input that does not move, tells nothing.
        let [voltage, current] = rows(1, 5.0);
        assert!(advantage_of_before(&voltage, &[&current]).abs() < CLEARLY);
        assert!(advantage_of_before(&voltage, &[&vec![1.0; voltage.len()]]).abs() < 1e-9);
    }
}

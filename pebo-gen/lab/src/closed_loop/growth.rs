//! Finds a state of a loop that grows without end, from its values sample by sample.
//!
//! In: the state at each sample. Out: when the loop cannot go on, the component that has grown most beyond its peak in
//! the first half of the run, if any has grown far beyond. Keeps two numbers for each component.

/// A state runs away beyond this multiple of its peak in the first half of the run: a plant in operation exceeds the
/// range of its start by much less.
const FAR: f64 = 1e3;

/// The largest absolute values of a state so far.
#[derive(Clone, Debug)]
pub(crate) struct Growth {
    /// Up to the last sample whose number is a power of two.
    early: Vec<f64>,
    /// Up to the one before.
    earlier: Vec<f64>,
    so_far: Vec<f64>,
    samples: u64,
}

impl Growth {
    /// From the first sample on.
    pub(crate) fn new(state: &[f64]) -> Self {
        let so_far: Vec<f64> = state.iter().map(|value| value.abs()).collect();
        Self { early: so_far.clone(), earlier: so_far.clone(), so_far, samples: 0 }
    }

    /// Takes the state at the next sample.
    pub(crate) fn add(&mut self, state: &[f64]) {
        self.samples += 1;
        for (peak, value) in self.so_far.iter_mut().zip(state) {
            *peak = peak.max(value.abs());
        }
        if self.samples.is_power_of_two() {
            std::mem::swap(&mut self.earlier, &mut self.early);
            self.early.clone_from(&self.so_far);
        }
    }

    /// The component of a last state that has run away, with its value; of several, the one that has grown most.
    pub(crate) fn away(&self, state: &[f64]) -> Option<(usize, f64)> {
        // A quarter to a half of the run: the last power of two may be the very last sample.
        let grown = |(place, value): (usize, &f64)| {
            // A component that has been zero so far has no known size: take one of its unit.
            let before = if self.earlier[place] > 0.0 { self.earlier[place] } else { 1.0 };
            let last = if value.is_finite() { value.abs() } else { self.so_far[place] };
            (place, last, last / before)
        };
        let all = state.iter().enumerate().map(grown);
        let (place, last, times) = all.max_by(|a, b| a.2.total_cmp(&b.2))?;
        (times > FAR).then_some((place, last))
    }
}

#[cfg(test)]
mod tests {
    use super::Growth;

    #[test]
    fn unbounded_growth_is_named_and_swinging_is_not() {
        let mut growth = Growth::new(&[1.0, 0.1]);
        for sample in 1..=200_u32 {
            growth.add(&[f64::from(sample).sin(), 0.1 * (f64::from(sample) / 5.0).exp()]);
        }
        assert!(matches!(growth.away(&[1.0, 1e17]), Some((1, value)) if value > 1e16));
        // No longer finite: its last finite peak.
        assert!(matches!(growth.away(&[1.0, f64::NAN]), Some((1, value)) if value > 1e15));
        let mut swings = Growth::new(&[0.0]);
        (1..500_u32).for_each(|sample| swings.add(&[f64::from(sample).sin()]));
        assert_eq!(swings.away(&[1.0]), None);
        // It escaped before the second sample.
        assert_eq!(Growth::new(&[2.0]).away(&[1e9]), Some((0, 1e9)));
    }
}

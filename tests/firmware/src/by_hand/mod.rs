//! Observers as a careful engineer writes them for one plant each: no library, no generics over scalars, the same
//! arithmetic in the same order as the emitted observer, and the same promise to keep the last good state.
//!
//! All three filter a regression with two unknowns and correct these by the implicit gradient step: [`Regression`].

pub mod arm;
pub mod cuk;
pub mod induction;
pub mod motor;

/// A number and the rounding error of its summation.
#[derive(Clone, Copy)]
struct Accumulator {
    value: f32,
    carry: f32,
}

impl Accumulator {
    const ZERO: Self = Self { value: 0.0, carry: 0.0 };

    fn add(&mut self, increment: f32) {
        let sum = self.value + increment;
        let taken = sum - self.value;
        let lost = (self.value - (sum - taken)) + (increment - taken);
        let rest = self.carry + lost;
        self.value = sum + rest;
        self.carry = rest - (self.value - sum);
    }

    /// Zero, or NaN if either number is not finite.
    fn blemish(self) -> f32 {
        self.value * 0.0 + self.carry * 0.0
    }
}

/// The two coordinates of an integrator.
#[derive(Clone, Copy)]
struct Extension([Accumulator; 2]);

impl Extension {
    const START: Self = Self([Accumulator::ZERO; 2]);

    fn chi(&self) -> [f32; 2] {
        self.0.map(|entry| entry.value)
    }

    /// Adds the rates at both ends of an interval by the trapezoidal rule; gives `chi` at both ends.
    fn integrate(&mut self, start: [f32; 2], end: [f32; 2], dt: f32) -> [[f32; 2]; 2] {
        let before = self.chi();
        self.0[0].add((start[0] + end[0]) * (0.5 * dt));
        self.0[1].add((start[1] + end[1]) * (0.5 * dt));
        [before, self.chi()]
    }

    /// Zero, or NaN if a number is not finite.
    fn blemish(&self) -> f32 {
        self.0[0].blemish() + self.0[1].blemish()
    }
}

/// The filtered regression with its unknowns.
#[derive(Clone, Copy)]
struct Regression<const ROWS: usize> {
    regressand: [Accumulator; ROWS],
    regressor: [[Accumulator; 2]; ROWS],
    theta: [Accumulator; 2],
    weight_dt: f32,
    level: f32,
    slope: f32,
}

impl<const ROWS: usize> Regression<ROWS> {
    const START: Self = Self {
        regressand: [Accumulator::ZERO; ROWS],
        regressor: [[Accumulator::ZERO; 2]; ROWS],
        theta: [Accumulator::ZERO; 2],
        weight_dt: 0.0,
        level: 0.0,
        slope: 0.0,
    };

    /// Filters a row: what is known of it at both ends of the interval, and the factors there.
    fn filter(&mut self, row: usize, known: [f32; 2], factors: [[f32; 2]; 2]) {
        let (level, slope) = (self.level, self.slope);
        let toward = |entry: &mut Accumulator, [first, last]: [f32; 2]| {
            entry.add((first - entry.value) * level + (last - first) * slope);
        };
        toward(&mut self.regressand[row], known);
        for (column, entry) in self.regressor[row].iter_mut().enumerate() {
            toward(entry, [factors[0][column], factors[1][column]]);
        }
    }

    /// The implicit gradient step.
    fn correct(&mut self, gains: [f32; 2], dt: f32) {
        let mut weight = [1.0 / gains[0], 1.0 / gains[1]];
        let mut upper = 0.0;
        let mut target = [0.0; 2];
        for (entries, known) in self.regressor.iter().zip(&self.regressand) {
            let [first, mut second] = [entries[0].value, entries[1].value];
            let mut value = known.value - (first * self.theta[0].value + second * self.theta[1].value);
            let mut share = dt;
            if first != 0.0 {
                let after = weight[0] + share * first * first;
                let kept = weight[0] / after;
                let taken = share * first / after;
                weight[0] = after;
                share *= kept;
                let (entry, above) = (second, upper);
                second = entry - first * above;
                upper = kept * above + taken * entry;
                let (entry, above) = (value, target[0]);
                value = entry - first * above;
                target[0] = kept * above + taken * entry;
            }
            if second != 0.0 {
                let after = weight[1] + share * second * second;
                let kept = weight[1] / after;
                let taken = share * second / after;
                weight[1] = after;
                target[1] = kept * target[1] + taken * value;
            }
        }
        self.theta[1].add(target[1]);
        self.theta[0].add(target[0] - upper * target[1]);
    }

    /// The coordinates `z = chi + theta`.
    fn coordinates(&self, extension: &Extension) -> [f32; 2] {
        let chi = extension.chi();
        [chi[0] + self.theta[0].value, chi[1] + self.theta[1].value]
    }

    /// The filter's weights for this sample time.
    fn use_sample_time(&mut self, alpha: f32, dt: f32) {
        if self.weight_dt != dt {
            (self.level, self.slope) = weights(alpha * dt);
            self.weight_dt = dt;
        }
    }

    /// Zero, or NaN if a number is not finite.
    fn blemish(&self) -> f32 {
        let factors = self.regressor.iter().flatten();
        self.regressand.iter().chain(factors).chain(&self.theta).fold(0.0, |sum, entry| sum + entry.blemish())
    }
}

/// Level and slope of the filter for another sample time: values in and out, so that a usual step stays in registers.
#[cold]
#[inline(never)]
fn weights(a: f32) -> (f32, f32) {
    let level = -pebo_runtime::Real::exp_m1(-a);
    let mut series = 1.0;
    for k in (3..20_u8).rev() {
        series = 1.0 - a / f32::from(k) * series;
    }
    (level, 0.5 * a * series)
}

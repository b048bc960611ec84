//! Outputs that arrive late: each sample is an equation of the time that it is of.

use pebo_runtime::nalgebra::{SMatrix, SVector};
use pebo_runtime::{
    Fault, Flow, Fundamental, Late, LateObserver, LeastSquares, Model, Observer, OutputForm, OutputSlopes, Real,
    Rebase, Regression, SampledRegression, Sides,
};

use crate::noise::Noise;

/// A mass on a spring with an accelerometer of unknown bias, `p' = v`, `v' = u - b - 0.8 p`, whose position `p` arrives
/// late, and a slow sensor of its speed that does not: `s' = v - 3 s`. `z = (v, b)`.
#[derive(Clone, Copy, Debug)]
struct Spring<S> {
    period: S,
}

const SPRING: f64 = 0.8;
const SLOWNESS: f64 = 3.0;

impl<S: Real> Model<2, 2, 1, 2, 2, 2> for Spring<S> {
    type Scalar = S;
    type Extension = Fundamental<S, 2>;
    type X = SVector<S, 2>;
    type Y = SVector<S, 2>;
    type U = SVector<S, 1>;
    type Terms = SVector<S, 2>;
    const REGRESSION: Regression = Regression::Dynamic;

    fn periods(&self) -> SVector<S, 2> {
        SVector::from([self.period, S::zero()])
    }
    fn terms(&self, y: &SVector<S, 2>) -> SVector<S, 2> {
        *y
    }
    fn flow(&self, y: &SVector<S, 2>, u: &SVector<S, 1>) -> Flow<S, 2> {
        let lambda = SMatrix::<f64, 2, 2>::new(0.0, -1.0, 0.0, 0.0).map(Real::from_f64);
        Flow { lambda, h: SVector::from([u[0] - y[0] * Real::from_f64(SPRING), S::zero()]) }
    }
    fn regression(&self, extension: &Self::Extension, y: &SVector<S, 2>, _u: &SVector<S, 1>) -> Sides<S, 2, 2> {
        let factor = SMatrix::<f64, 2, 2>::new(1.0, 0.0, 1.0, 0.0).map(Real::from_f64);
        let known = SVector::from([S::zero(), y[1] * Real::from_f64(-SLOWNESS)]);
        Sides { known: known + factor * extension.xi(), factor: factor * extension.psi() }
    }
    fn primitive(&self, _: &Self::Extension, y: &SVector<S, 2>) -> Sides<S, 2, 2> {
        Sides { known: *y, factor: SMatrix::zeros() }
    }
    fn output_slopes(&self, _y: &SVector<S, 2>, _u: &SVector<S, 1>, _z: &SVector<S, 2>) -> OutputSlopes<S, 2, 2> {
        let rates = SMatrix::<f64, 2, 2>::new(0.0, 0.0, 0.0, -SLOWNESS).map(Real::from_f64);
        OutputSlopes { rates, cascade: SMatrix::<f64, 2, 2>::new(-SPRING, 0.0, 0.0, 0.0).map(Real::from_f64) }
    }
    fn theta(&self, eta: &SVector<S, 2>) -> SVector<S, 2> {
        *eta
    }
    fn recover(&self, z: &SVector<S, 2>, _y: &SVector<S, 2>) -> SVector<S, 2> {
        *z
    }
}

impl<S: Real> Rebase<2, 2, 1, 2, 2> for Spring<S> {}

/// The plant's state is (p, s, v, b): after `dt` seconds with the input.
fn moved(state: &SVector<f64, 4>, u: f64, dt: f64) -> SVector<f64, 4> {
    let rate = SMatrix::<f64, 4, 4>::from_row_slice(&[
        0.0, 0.0, 1.0, 0.0, //
        0.0, -SLOWNESS, 1.0, 0.0, //
        -SPRING, 0.0, 0.0, -1.0, //
        0.0, 0.0, 0.0, 0.0,
    ]);
    let (mut sum, mut term) = (*state, *state);
    for order in 1..20 {
        let driven = if order == 1 { SVector::from([0.0, 0.0, u, 0.0]) } else { SVector::zeros() };
        term = (rate * term + driven) * (dt / f64::from(order));
        sum += term;
    }
    sum
}

const DT: f64 = 0.02;
const DEVIATIONS: [f64; 2] = [0.02, 0.05];
const START: [f64; 4] = [0.3, 0.05, 2.0, 1.0];

/// What a state drifts in a second, as variances of (p, s, v, b).
const DRIFT: [f64; 4] = [0.0, 0.0, 0.04, 0.01];

type Delayed<S, const N: usize> =
    LateObserver<OutputForm<Spring<S>, S, 2, 2>, LeastSquares<S, 4>, 2, 2, 1, 4, 2, 4, SampledRegression<S, 2, 4>, N>;

/// An observer whose first output is late by so many seconds, of an angle with this period.
fn observer<S: Real, const N: usize>(delay: f64, period: f64) -> Delayed<S, N> {
    let model = OutputForm::new(Spring { period: Real::from_f64(period) });
    let variances = SVector::from(START.map(|deviation| Real::from_f64(deviation * deviation)));
    let estimator = LeastSquares::diagonal(&variances, S::zero()).unwrap();
    let estimator = estimator.with_process_noise(&SVector::from(DRIFT.map(Real::from_f64))).unwrap();
    let regression = SampledRegression::new(&SVector::from(DEVIATIONS.map(Real::from_f64))).unwrap();
    let observer = Observer::with_regression(model, estimator, regression, SVector::zeros()).unwrap();
    let delays = SVector::from([delay, 0.0].map(Real::from_f64));
    let late = Late { delays, rows: [0, 1], is_expected: [true; 2] };
    LateObserver::new(observer.rebasing(1).unwrap(), late).unwrap()
}

/// The true states at each period of a run, with the input during the period before.
fn run(steps: u32, dt: f64) -> Vec<(SVector<f64, 4>, f64)> {
    let mut state = SVector::from([0.4, 0.1, 0.9, 0.6]);
    let mut states = vec![(state, 0.0)];
    for k in 0..steps {
        let u = (0.07 * f64::from(k)).sin();
        state = moved(&state, u, dt);
        states.push((state, u));
    }
    states
}

/// The first output of the plant `late` periods before `k`; before the run it stands still.
fn late_output(states: &[(SVector<f64, 4>, f64)], k: usize, late: usize) -> f64 {
    states[k.saturating_sub(late)].0[0]
}

/// The error of the last estimate of a run whose first output is late by so many samples.
fn last_error<const N: usize>(late: u8, told: f64) -> f64 {
    let states = run(600, DT);
    let mut observer = observer::<f64, N>(told, 0.0);
    let mut error = f64::NAN;
    for (k, (state, u)) in states.iter().enumerate() {
        let estimate = observer.step([late_output(&states, k, usize::from(late)), state[1]], [*u], DT).unwrap();
        error = (estimate - state.fixed_rows::<2>(2)).norm();
    }
    error
}

#[test]
fn samples_count_for_the_time_that_they_are_of() {
    let on_time = last_error::<16>(0, 0.0);
    // What is left of the start, whose weight is that of a sample or two.
    assert!(on_time < 1e-3, "{on_time}");
    for late in [1, 4, 10] {
        let told = last_error::<16>(late, DT * f64::from(late));
        assert!(told < 2.0 * on_time, "{late}: {told} {on_time}");
        let ignored = last_error::<16>(late, 0.0);
        assert!(ignored > 0.01, "{late}: {ignored}");
    }
    // Of more than 128 on their way some are taken as one, with the mean of an input that moves by 0.07 in a period.
    let joined = last_error::<204>(200, DT * 200.0);
    assert!(joined < 0.02, "{joined}");
    // With more samples on their way than there is room for, the newest are joined, and the input with them.
    let short = last_error::<8>(10, DT * 10.0);
    assert!(short < 0.02, "{short}");
}

/// The first output comes with every tenth sample, four periods old: until the first of them nothing is refused, and the
/// time before it is nobody's.
#[test]
fn a_slow_and_late_output_begins_the_observer_with_its_first_sample() {
    let states = run(600, DT);
    let mut observer = observer::<f64, 16>(DT * 4.0, 0.0);
    let mut error = f64::NAN;
    for (k, (state, u)) in states.iter().enumerate() {
        let first = if k % 10 == 0 && k >= 4 { late_output(&states, k, 4) } else { f64::NAN };
        let estimate = observer.step_partly([first, state[1]], [*u], DT).unwrap();
        if k < 10 {
            assert!(estimate.amax() == 0.0, "{k}: {estimate}");
        }
        error = (estimate - state.fixed_rows::<2>(2)).norm();
    }
    // As with a late output at each sample; a tenth of the samples lets more of the start remain.
    assert!(error < 1e-2, "{error}");
}

/// The plant with its past: (p, s, v, b) now and of seven samples before.
const PAST: usize = 32;

/// A Kalman filter of the plant with its past, which takes each sample as it arrives.
#[test]
fn the_estimate_is_that_of_a_filter_with_the_past_among_its_states() {
    let (late, states) = (7, run(200, DT));
    let mut random = Noise::new(20_261_127);
    let mut observer = observer::<f64, 12>(DT * 7.0, 0.0);
    let samples: Vec<[f64; 2]> = states
        .iter()
        .enumerate()
        .map(|(k, (state, _))| {
            let noise = DEVIATIONS.map(|deviation| deviation * random.normal());
            [late_output(&states, k, late) + noise[0], state[1] + noise[1]]
        })
        .collect();
    let mut map = SMatrix::<f64, PAST, PAST>::zeros();
    for column in 0..4 {
        let mut unit = SVector::<f64, 4>::zeros();
        unit[column] = 1.0;
        map.fixed_view_mut::<4, 1>(0, column).copy_from(&moved(&unit, 0.0, DT));
    }
    (4..PAST).for_each(|row| map[(row, row - 4)] = 1.0);
    let mut mean = SVector::<f64, PAST>::zeros();
    let mut covariance = SMatrix::<f64, PAST, PAST>::zeros();
    (0..4).for_each(|row| covariance[(row, row)] = START[row] * START[row]);
    // The observer begins with the first sample that is whole, when its position has arrived.
    (mean[0], mean[1]) = (samples[late][0], samples[0][1]);
    for (k, (_, u)) in states.iter().enumerate() {
        let estimate = observer.step(samples[k], [*u], DT).unwrap();
        if k > 0 {
            mean = map * mean;
            let driven = moved(&SVector::zeros(), *u, DT);
            (0..4).for_each(|row| mean[row] += driven[row]);
            covariance = map * covariance * map.transpose();
            (0..4).for_each(|row| covariance[(row, row)] += DRIFT[row] * DT);
            // A position of the start is not a second sample of it.
            let arrived = (k > late).then_some((0, 4 * late)).into_iter().chain([(1, 1)]);
            for (output, place) in arrived {
                let column = covariance.column(place).clone_owned();
                let variance = column[place] + DEVIATIONS[output].powi(2);
                mean += column * ((samples[k][output] - mean[place]) / variance);
                covariance -= column * column.transpose() / variance;
            }
        }
        if k >= late {
            let best = mean.fixed_rows::<2>(2);
            assert!((estimate - best).norm() < 1e-9, "{k}: {estimate} {best}");
            let errors = observer.standard_error().unwrap();
            assert!((errors[0] / covariance[(2, 2)].sqrt() - 1.0).abs() < 1e-7, "{k}: {errors}");
        }
    }
}

#[test]
fn delays_between_samples_lose_little() {
    let dt = DT / 5.0;
    let states = run(1200, dt);
    let error = |late: [usize; 2], delay: f64| {
        let mut observer = observer::<f64, 60>(delay, 0.0);
        let mut error = f64::NAN;
        for (k, (state, u)) in states.iter().enumerate() {
            // Half-way between two samples, where the plant runs nearly straight.
            let [before, after] = late.map(|late| late_output(&states, k, late));
            let p = f64::midpoint(before, after);
            error = (observer.step([p, state[1]], [*u], dt).unwrap() - state.fixed_rows::<2>(2)).norm();
        }
        error
    };
    let (on_time, between) = (error([0, 0], 0.0), error([53, 54], dt * 53.5));
    assert!(between < 2.0 * on_time + 1e-4, "{between} {on_time}");
}

#[test]
fn samples_may_tell_their_age() {
    let states = run(600, DT);
    let mut observer = observer::<f64, 16>(0.0, 0.0);
    let mut error = f64::NAN;
    for (k, (state, u)) in states.iter().enumerate() {
        // Arrivals overtake one another.
        let late = 3 + u8::try_from(k * 7 % 10).unwrap();
        let y = [late_output(&states, k, usize::from(late)), state[1]];
        let delays = SVector::from([DT * f64::from(late), 0.0]);
        error = (observer.step_with_delays(y, &delays, [*u], DT).unwrap() - state.fixed_rows::<2>(2)).norm();
    }
    // Instants of which no sample has come are on a straight line: as above, over up to ten periods.
    assert!(error < 2e-2, "{error}");
    for (delays, output) in [([0.0, -DT], 1), ([-1.0, 0.0], 0), ([f64::NAN, 0.0], 0)] {
        let before = format!("{observer:?}");
        let found = observer.step_with_delays([0.0, 0.0], &SVector::from(delays), [0.0], DT);
        assert_eq!(found, Err(Fault::Output { index: output }), "{delays:?}");
        assert_eq!(format!("{observer:?}"), before);
    }
}

#[test]
fn late_and_missing_outputs_go_together_and_turns_are_counted() {
    let states = run(600, DT);
    // As an angle, read within a turn of 0.7.
    let (mut whole, mut wrapped) = (observer::<f64, 16>(DT * 5.0, 0.0), observer::<f64, 16>(DT * 5.0, 0.7));
    let mut error = f64::NAN;
    for (k, (state, u)) in states.iter().enumerate() {
        let p = late_output(&states, k, 5);
        let read = p - 0.7 * (p / 0.7).round();
        let missing = |output: f64, every: usize| if k % every == 1 { f64::NAN } else { output };
        let rest = missing(state[1], 5);
        let [whole, wrapped] = [(&mut whole, p), (&mut wrapped, if k <= 5 { p } else { read })]
            .map(|(observer, p)| observer.step_partly([missing(p, 3), rest], [*u], DT).unwrap());
        assert!((whole - wrapped).norm() < 1e-9, "{k}: {whole} {wrapped}");
        error = (whole - state.fixed_rows::<2>(2)).norm();
    }
    assert!(error < 1e-3, "{error}");
}

#[test]
fn a_slow_sensor_may_be_late() {
    let states = run(600, DT);
    for delay in [5.0, 5.5] {
        let mut observer = observer::<f64, 16>(DT * delay, 0.0);
        let mut error = f64::NAN;
        for (k, (state, u)) in states.iter().enumerate() {
            // Each tenth sample arrives.
            let p = if k % 10 == 0 { late_output(&states, k, 5) } else { f64::NAN };
            let p = if k == 5 || k == 6 { states[k - 5].0[0] } else { p };
            error = (observer.step_partly([p, state[1]], [*u], DT).unwrap() - state.fixed_rows::<2>(2)).norm();
        }
        // That of a half counts for the last instant before it, half a period too early.
        assert!(error < if delay < 5.5 { 1e-3 } else { 2e-2 }, "{delay}: {error}");
    }
}

#[test]
fn a_refused_sample_changes_nothing_and_a_saved_state_goes_on() {
    let states = run(100, DT);
    let mut observer = observer::<f64, 16>(DT * 5.0, 0.0);
    let mut other = observer.clone();
    for (k, (state, u)) in states.iter().enumerate() {
        let y = [late_output(&states, k, 5), state[1]];
        assert!(observer.step([f64::NAN, y[1]], [*u], DT).is_err());
        assert!(observer.step(y, [f64::INFINITY], DT).is_err());
        assert!(observer.step(y, [*u], 0.0).is_err());
        let estimate = observer.step(y, [*u], DT).unwrap();
        assert_eq!(other.step(y, [*u], DT).unwrap(), estimate);
        // Before the first sample is whole the estimate is that of the start.
        assert_eq!(observer.estimate().is_some(), k >= 5);
        assert_eq!(estimate == SVector::<f64, 2>::zeros(), k < 5, "{k}: {estimate}");
        if k == 40 {
            let (state, arrivals) = observer.state();
            let mut restored = self::observer::<f64, 16>(DT * 5.0, 0.0);
            restored.restore(*state, *arrivals).unwrap();
            other = restored;
        }
    }
    observer.restart(SVector::zeros(), &SVector::zeros()).unwrap();
    assert_eq!(observer.estimate(), None);
}

#[test]
fn innovations_are_those_of_the_late_samples() {
    let states = run(2000, DT);
    let mut random = Noise::new(20_261_128);
    let mut observer = observer::<f64, 16>(DT * 9.0, 0.0);
    let (mut squares, mut count) = (0.0, 0.0);
    for (k, (state, u)) in states.iter().enumerate() {
        let noise = DEVIATIONS.map(|deviation| deviation * random.normal());
        let y = [late_output(&states, k, 9) + noise[0], state[1] + noise[1]];
        let innovation = observer.innovation(y, [*u], DT).unwrap().normalised_square;
        assert_eq!(innovation == 0.0, k <= 9, "{k}: {innovation}");
        if k > 100 {
            squares += innovation;
            count += 2.0;
        }
        observer.step(y, [*u], DT).unwrap();
    }
    // The mean of 3,800 squares of a plant that does not drift: a little below 1.
    let mean: f64 = squares / count;
    assert!((0.85..1.05).contains(&mean), "{mean}");
}

#[test]
fn single_precision_keeps_up() {
    let states = run(600, DT);
    let mut observer = observer::<f32, 16>(DT * 5.0, 0.0);
    let mut error = f64::NAN;
    let single = <f32 as Real>::from_f64;
    for (k, (state, u)) in states.iter().enumerate() {
        let y = [late_output(&states, k, 5), state[1]].map(single);
        let estimate = observer.step(y, [single(*u)], single(DT)).unwrap();
        error = (estimate.map(f64::from) - state.fixed_rows::<2>(2)).norm();
    }
    assert!(error < 1e-3, "{error}");
}

#[test]
fn a_fault_of_a_sample_that_becomes_whole_leaves_that_one_out() {
    let states = run(200, DT);
    let mut observer = observer::<f64, 16>(DT * 5.0, 0.0);
    let (mut error, mut faults) = (f64::NAN, 0);
    for (k, (state, u)) in states.iter().enumerate() {
        // No estimate has a value with this.
        let p = if k == 60 { f64::MAX } else { late_output(&states, k, 5) };
        match observer.step([p, state[1]], [*u], DT) {
            Ok(estimate) => error = (estimate - state.fixed_rows::<2>(2)).norm(),
            Err(_) => faults += 1,
        }
    }
    assert!(faults == 1 && error < 1e-2, "{faults} {error}");
}

#[test]
fn delays_that_are_none_are_refused() {
    let on_time = observer::<f64, 4>(0.0, 0.0);
    for delay in [-1.0, f64::NAN, f64::INFINITY] {
        let late = Late { delays: SVector::from([delay, 0.0]), rows: [0, 1], is_expected: [true; 2] };
        let made = LateObserver::<_, _, 2, 2, 1, 4, 2, 4, _, 4>::new(on_time.past().clone(), late);
        assert_eq!(made.err(), Some(Fault::Gain), "{delay}");
    }
}

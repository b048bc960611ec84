//! The method for stiff plants.
//!
//! Method: RODAS, a Rosenbrock method of order 4 with an error estimate of order 3 (Hairer and Wanner, *Solving
//! ordinary differential equations II*, 1996, section VI.4; the coefficients are those of their program). Its steps are
//! as long as the slow components allow once the fast ones have died out. It takes the derivatives of the rates by the
//! state, which the algebra knows exactly, so that each stage is one linear equation and nothing is iterated.
//!
//! Own code, as the library's implicit methods will not do: they end after ten refused steps of a run, and the
//! tolerance of their iteration is absolute, in any units.

use pebo_runtime::nalgebra::{Const, DimMin, SMatrix, SVector};

use super::equation::{ABSOLUTE, Equation, RELATIVE, SHORTEST, Solver, Standstill, StepCallback};

/// The diagonal of the method.
const GAMMA: f64 = 0.25;

/// The times of the stages, as shares of the step.
const NODES: [f64; 6] = [0.0, 0.386, 0.21, 0.63, 1.0, 1.0];

/// The weights of the rates' derivative by time in the stages.
const DRIFTS: [f64; 6] = [0.25, -0.1043, 0.1035, -0.036_200_000_000_000_23, 0.0, 0.0];

/// The states of the stages, in the stages before.
const PLACES: [[f64; 5]; 6] = [
    [0.0; 5],
    [1.544, 0.0, 0.0, 0.0, 0.0],
    [0.946_678_528_081_582_6, 0.255_701_169_898_328_4, 0.0, 0.0, 0.0],
    [3.314_825_187_068_521, 2.896_124_015_972_201, 0.998_641_913_997_781_7, 0.0, 0.0],
    [1.221_224_509_226_641, 6.019_134_481_288_629, 12.537_083_329_320_87, -0.687_886_036_105_895, 0.0],
    [1.221_224_509_226_641, 6.019_134_481_288_629, 12.537_083_329_320_87, -0.687_886_036_105_895, 1.0],
];

/// The weights of the stages before beside the rates.
const COUPLINGS: [[f64; 5]; 6] = [
    [0.0; 5],
    [-5.6688, 0.0, 0.0, 0.0, 0.0],
    [-2.430_093_356_833_875, -0.206_359_915_709_191_5, 0.0, 0.0, 0.0],
    [-0.107_352_905_815_137_5, -9.594_562_251_023_355, -20.470_286_148_096_16, 0.0, 0.0],
    [7.496_443_313_967_647, -10.246_804_314_643_52, -33.999_903_528_199_05, 11.708_908_932_061_6, 0.0],
    [
        8.083_246_795_921_522,
        -7.981_132_988_064_893,
        -31.521_594_328_743_71,
        16.319_305_431_231_36,
        -6.058_818_238_834_054,
    ],
];

/// The least ratio of a step to the one before.
const LEAST: f64 = 0.2;

/// The largest ratio of a step to the one before.
const MOST: f64 = 6.0;

/// The share of the tolerance that a step aims at.
const AIM: f64 = 0.9;

/// The distance of the instants in the difference quotient by time, as a share of the interval: for a rate whose third
/// derivative is one over the interval cubed, its relative error is 3e-9.
const APART: f64 = 1e-4;

/// The method for states of up to `N` components.
#[derive(Debug)]
pub(crate) struct StiffMethod<const N: usize> {
    /// The first step of the last interval, after which a fast part of the state follows a jump of the inputs.
    first: f64,
}

impl<const N: usize> StiffMethod<N> {
    pub(crate) fn new() -> Self {
        Self { first: f64::INFINITY }
    }
}

impl<const N: usize> Solver for StiffMethod<N>
where
    Const<N>: DimMin<Const<N>, Output = Const<N>>,
{
    fn solve(
        &mut self,
        rates: &Equation,
        state: &mut [f64],
        length: f64,
        most: u64,
        _watch: Option<&mut StepCallback<'_>>,
    ) -> Result<u64, Standstill> {
        let mut y = SVector::<f64, N>::zeros();
        y.as_mut_slice()[..state.len()].copy_from_slice(state);
        let (mut t, mut h, mut steps) = (0.0, length.min(MOST * self.first), 0);
        let mut at = None;
        while length - t > SHORTEST * length {
            h = h.min(length - t);
            if steps == most || h.is_nan() || h <= SHORTEST * length {
                let state = y.as_slice()[..state.len()].to_vec();
                return Err(Standstill { steps, at: rates.origin() + t, state, fast: None });
            }
            steps += 1;
            let &mut (ref slopes, drift) =
                at.get_or_insert_with(|| (rates.slopes::<N>(t, &y), drift::<N>(rates, t, &y, APART * length)));
            let (next, error) = step(rates, (t, &y), h, slopes, &drift);
            let scaled =
                |place: usize| error[place].abs() / (ABSOLUTE + RELATIVE * y[place].abs().max(next[place].abs()));
            // NaN counts as the largest error.
            let worst = (0..state.len()).map(scaled).fold(0.0, |worst, one| if one <= worst { worst } else { one });
            let scale = AIM * worst.powf(-0.25);
            if worst <= 1.0 {
                if t == 0.0 {
                    self.first = h;
                }
                (t, y, at) = (t + h, next, None);
            }
            h *= if scale.is_nan() { LEAST } else { scale.clamp(LEAST, MOST) };
        }
        state.copy_from_slice(&y.as_slice()[..state.len()]);
        Ok(steps)
    }
}

/// A step of `h` seconds: the state after it, and its error.
fn step<const N: usize>(
    rates: &Equation,
    (t, y): (f64, &SVector<f64, N>),
    h: f64,
    slopes: &SMatrix<f64, N, N>,
    drift: &SVector<f64, N>,
) -> (SVector<f64, N>, SVector<f64, N>)
where
    Const<N>: DimMin<Const<N>, Output = Const<N>>,
{
    let solver = (SMatrix::<f64, N, N>::identity() / (h * GAMMA) - slopes).lu();
    let mut stages = [SVector::<f64, N>::zeros(); 6];
    let mut place = *y;
    for stage in 0..stages.len() {
        place = *y;
        let mut side = drift * (h * DRIFTS[stage]);
        for (before, known) in stages[..stage].iter().enumerate() {
            place += known * PLACES[stage][before];
            side += known * (COUPLINGS[stage][before] / h);
        }
        side += rates.at::<N>(t + NODES[stage] * h, &place);
        if !solver.solve_mut(&mut side) {
            side.fill(f64::NAN);
        }
        stages[stage] = side;
    }
    // The last stage is the difference of the two orders.
    (place + stages[5], stages[5])
}

/// The derivative of the rates by time, the state held.
fn drift<const N: usize>(rates: &Equation, t: f64, y: &SVector<f64, N>, apart: f64) -> SVector<f64, N> {
    if !rates.moves() {
        return SVector::zeros();
    }
    // To one side, as a signal need not have values before its beginning.
    let [now, soon, later] = [0.0, apart, 2.0 * apart].map(|after| rates.at::<N>(t + after, y));
    (soon * 4.0 - now * 3.0 - later) / (2.0 * apart)
}

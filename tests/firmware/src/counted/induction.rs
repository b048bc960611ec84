//! The induction motor with its currents and its speed measured: the observer of known numbers beside an extended Kalman
//! filter of the same numbers. The samples are those of the plant, with sensors that err.

use pebo_runtime::Fault;

use super::{Plant, waves};
use crate::by_hand::induction::{ByHand, rate};
use crate::emitted::induction::{Induction as Model, Parameters, Tuned, U, X, Y};

/// Seconds between two samples.
const DT: f32 = 1e-4;

/// Currents and speed, then the voltages of the interval before.
pub type Sample = ([f32; 3], [f32; 2]);

/// The motor.
pub struct Induction;

impl Plant for Induction {
    const NAME: &'static str = "induction";
    type Sample = Sample;
    type Estimate = [f32; 3];
    type Emitted = Tuned;
    type ByHand = ByHand;

    fn observers() -> Result<(Tuned, ByHand), Fault> {
        Ok((Model::observer(&Parameters::default())?, ByHand::new()))
    }

    fn samples() -> impl Iterator<Item = Sample> {
        let mut state = [0.0, 0.0, 0.0, 0.3, -0.2, 2.0];
        // Three turns of the voltage to one of the sines: 48 Hz.
        waves().map(move |(sine, cosine)| {
            let u = [
                310.0 * (4.0 * cosine * cosine * cosine - 3.0 * cosine),
                310.0 * (3.0 * sine - 4.0 * sine * sine * sine),
            ];
            // Forty steps of Euler's rule.
            for _ in 0..40 {
                let rate = rate(state, u);
                state.iter_mut().zip(rate).for_each(|(x, rate)| *x += DT / 40.0 * rate);
            }
            let [i1, i2, omega, ..] = state;
            ([i1 + 0.05 * sine, i2 - 0.05 * sine, omega + 0.1 * cosine], u)
        })
    }

    #[inline]
    fn emitted(observer: &mut Tuned, &([i1, i2, omega], [v1, v2]): &Sample) -> Option<[f32; 3]> {
        let X { psi1, psi2, t_l } = observer.step(Y { i1, i2, omega }, U { v1, v2 }, DT).ok()?;
        Some([psi1, psi2, t_l])
    }

    #[inline]
    fn by_hand(observer: &mut ByHand, (y, u): &Sample) -> Option<[f32; 3]> {
        observer.step(*y, *u, DT)
    }

    // 0.1 s: what is left of their different ways over the first steps, from fluxes that are wrong by 0.3 Wb.
    const SETTLED_AFTER: usize = 1000;

    /// Both are of second order in the step, and no more: 0.1 % of the flux, and of the torque a twenty-fifth of its standard
    /// error, 0.25 N m.
    fn agree(emitted: [f32; 3], by_hand: [f32; 3]) -> bool {
        let within = [0.001, 0.001, 0.01];
        emitted.iter().zip(by_hand).zip(within).all(|((emitted, by_hand), within)| (emitted - by_hand).abs() <= within)
    }
}

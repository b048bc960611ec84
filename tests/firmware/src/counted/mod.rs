//! The steps that are counted: of an emitted observer and of the one written by hand for the same plant, each a
//! function of its own so that counters and size figures find it.

pub mod arm;
pub mod cuk;
pub mod induction;
pub mod motor;

use pebo_runtime::{Fault, Filter, Gradient, Hold, Real};

use crate::report::Report;

/// The program that counts the steps of a plant's observers: an image of its own, as in firmware. On the host it
/// compares the two as the board does, and with the argument `emitted` or `hand` runs that one for an instruction
/// counter.
#[macro_export]
macro_rules! count {
    ($plant:ty) => {
        #[cfg(feature = "board")]
        #[cortex_m_rt::entry]
        fn main() -> ! {
            $crate::board::run($crate::board::count::<$plant>)
        }

        #[cfg(not(feature = "board"))]
        fn main() -> Result<(), pebo_runtime::Fault> {
            $crate::host::count::<$plant>()
        }
    };
}

/// A plant with both observers.
pub trait Plant {
    /// The heading of its results.
    const NAME: &'static str;
    /// Outputs and inputs.
    type Sample: Copy;
    /// The estimate of the state, as both give it.
    type Estimate: IntoIterator<Item = f32>;
    /// The emitted observer.
    type Emitted;
    /// The one written by hand.
    type ByHand;

    /// Both before the first sample.
    ///
    /// # Errors
    /// None for the gains here.
    fn observers() -> Result<(Self::Emitted, Self::ByHand), Fault>;

    /// Samples without end.
    fn samples() -> impl Iterator<Item = Self::Sample>;

    /// One step of the emitted observer.
    fn emitted(observer: &mut Self::Emitted, sample: &Self::Sample) -> Option<Self::Estimate>;

    /// One step by hand.
    fn by_hand(observer: &mut Self::ByHand, sample: &Self::Sample) -> Option<Self::Estimate>;

    /// The samples before both estimates agree.
    const SETTLED_AFTER: usize = 0;

    /// True for estimates that are the same: to the last bit, where both compute the same.
    fn agree(emitted: Self::Estimate, by_hand: Self::Estimate) -> bool {
        emitted.into_iter().map(f32::to_bits).eq(by_hand.into_iter().map(f32::to_bits))
    }
}

/// The settings of both observers of a plant with two unknowns.
pub struct Settings {
    /// The gains of the gradient estimator.
    pub gains: [f32; 2],
    /// The filter, in rad/s.
    pub alpha: f32,
}

impl Settings {
    /// The estimator and the filter of the emitted observer.
    fn parts(&self) -> Result<(Gradient<f32, 2>, Filter<f32>), Fault> {
        Ok((Gradient::diagonal(&self.gains.into())?, Filter::new(self.alpha, Hold::First)?))
    }
}

/// Sine and cosine of an angle that goes on: signals without a plant.
fn waves() -> impl Iterator<Item = (f32, f32)> {
    (0..=u16::MAX).cycle().map(|k| Real::sin_cos(0.01 * f32::from(k)))
}

/// Samples in a round of counting.
pub const ROUND: usize = 64;

/// Samples of a round.
pub type Samples<P> = [Option<<P as Plant>::Sample>; ROUND];

/// The first samples of a plant.
pub fn samples<P: Plant>() -> Samples<P> {
    let mut samples = P::samples();
    core::array::from_fn(|_| samples.next())
}

/// One step of the emitted observer.
#[inline(never)]
pub fn emitted_step<P: Plant>(observer: &mut P::Emitted, sample: &P::Sample) -> Option<P::Estimate> {
    P::emitted(observer, sample)
}

/// One step of the observer written by hand.
#[inline(never)]
pub fn hand_step<P: Plant>(observer: &mut P::ByHand, sample: &P::Sample) -> Option<P::Estimate> {
    P::by_hand(observer, sample)
}

/// Rounds before the one that counts: the first step of all sets the clock, the second computes the filter's weights.
pub const WARM_UP: usize = 1;

/// A round of the emitted observer's steps.
#[inline(never)]
pub fn emitted_round<P: Plant>(observer: &mut P::Emitted, samples: &Samples<P>) -> bool {
    samples.iter().flatten().all(|sample| emitted_step::<P>(observer, sample).is_some())
}

/// A round of steps by hand.
#[inline(never)]
pub fn hand_round<P: Plant>(observer: &mut P::ByHand, samples: &Samples<P>) -> bool {
    samples.iter().flatten().all(|sample| hand_step::<P>(observer, sample).is_some())
}

/// Reports whether both give the same estimates.
///
/// # Errors
/// A fault where none should be.
pub fn compare<P: Plant>(report: &mut impl Report) -> Result<(), Fault> {
    let (mut emitted, mut hand) = P::observers()?;
    let mut same = true;
    for (index, sample) in P::samples().take(2000).enumerate() {
        let found = [emitted_step::<P>(&mut emitted, &sample), hand_step::<P>(&mut hand, &sample)];
        let [Some(emitted), Some(hand)] = found else { return Err(Fault::Estimate) };
        same &= index < P::SETTLED_AFTER || P::agree(emitted, hand);
    }
    report.name("by hand");
    report.name(P::NAME);
    report.flag(same);
    Ok(())
}

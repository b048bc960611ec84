//! The budget of a command for a model: `--limit`, by this machine's clock, and memory.

use std::ops::ControlFlow;
use std::time::{Duration, Instant};

use memory_stats::memory_stats;
use pebo_cas::Budget;

use crate::{Request, Stage};

/// Bytes of memory for a limit of usual length or shorter.
const MEMORY: f64 = 512.0 * 1024.0 * 1024.0;

/// The fraction of the memory that is kept for a single operation before the next look.
const RESERVE: f64 = 0.25;

/// Seconds for a model, a positive number; the usual ones by default. Memory is limited to 512 MB, in proportion more
/// beyond the usual seconds.
///
/// ```
/// use pebo_gen::answer;
/// use pebo_gen::cli::Limit;
/// use pebo_gen::source::Source;
///
/// let source = Source::new("m.yaml", "{model: m, x: [p], y: [q], f_x: {p: 0}, f_y: {q: p}}").expect("a short text");
/// let request = Limit::of_seconds(2.0).expect("it is positive").request();
/// assert_eq!(answer(&source, &request).report.model, "m");
/// assert!(Limit::of_seconds(0.0).is_err());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limit(pub(super) f64);

impl Default for Limit {
    fn default() -> Self {
        Self(Budget::SECONDS)
    }
}

impl Limit {
    /// So many seconds.
    ///
    /// # Errors
    /// The seconds are not a positive number.
    pub fn of_seconds(seconds: f64) -> Result<Self, &'static str> {
        // Beyond the largest value of a clock there is no visible difference.
        if seconds > 0.0 { Ok(Self(seconds.min(1e9))) } else { Err("the limit must be positive") }
    }

    /// A request within the limit, begun now.
    #[must_use]
    pub fn request(self) -> Request {
        Request::new().limit(self.0).watch(self.watch())
    }

    /// Ends a call that takes longer from now on, or more memory.
    pub fn watch(self) -> impl Fn(Stage) -> ControlFlow<()> {
        let started = Instant::now();
        let time = Duration::from_secs_f64(self.0);
        let longer = (self.0 / Budget::SECONDS).max(1.0);
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a float that is too large saturates"
        )]
        let memory = (MEMORY * longer * (1.0 - RESERVE)) as usize;
        // Memory taken before, for another model, is not this one's.
        let before = resident();
        move |_| {
            let is_over = started.elapsed() >= time || resident().saturating_sub(before) >= memory;
            if is_over { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        }
    }
}

/// The bytes that the process has in memory; 0 if the system does not tell.
fn resident() -> usize {
    memory_stats().map_or(0, |stats| stats.physical_mem)
}

//! What one question after another may take together: steps of work, and what its owner watches.
//!
//! In: a number of steps, and perhaps a watch, which says that the owner's time or memory is used up. Out: whether
//! there is something left. Once there is not, that stays so: whatever asks next is answered at once.
//!
//! Steps come first. They are the same on every machine, so that no verdict depends on its speed; the watch is for
//! what they misjudge. A library has no clock of its own (WebAssembly has none): whoever has one passes the watch.

use std::cell::Cell;
use std::fmt;
use std::rc::Rc;

/// Steps to a second: a machine of today does about twice as many, so that on one half as fast they still run out
/// before its clock does.
const STEPS_PER_SECOND: f64 = 50_000_000.0;

/// Steps between two looks at the watch: some milliseconds.
const BETWEEN_LOOKS: u64 = 1 << 18;

/// Says that what may be taken is used up, of time or memory.
type Watch = dyn Fn() -> bool;

/// The steps that are left. Clones draw from the same steps.
#[derive(Clone)]
pub struct Budget(Rc<Shared>);

struct Shared {
    left: Cell<u64>,
    stopped: Cell<bool>,
    watch: Option<Box<Watch>>,
}

impl Budget {
    /// What a command may take unless it says otherwise.
    pub const SECONDS: f64 = 10.0;

    /// Without end, for a single small question.
    pub fn unlimited() -> Self {
        Self::of(u64::MAX, None)
    }

    /// As many steps as are done in so many seconds, whatever they take here.
    pub fn of_seconds(seconds: f64) -> Self {
        Self::of(steps_of(seconds), None)
    }

    /// The same, and it ends too when the watch says so, which is asked every few milliseconds.
    pub fn watched(seconds: f64, watch: impl Fn() -> bool + 'static) -> Self {
        Self::of(steps_of(seconds), Some(Box::new(watch)))
    }

    fn of(left: u64, watch: Option<Box<Watch>>) -> Self {
        Self(Rc::new(Shared { left: Cell::new(left), stopped: Cell::new(false), watch }))
    }

    /// Whether nothing is left.
    pub fn is_exhausted(&self) -> bool {
        self.0.stopped.get() || self.0.left.get() == 0
    }

    /// Takes steps; false once there are too few, and from then on.
    pub fn take(&self, steps: u64) -> bool {
        let before = self.0.left.get();
        let left = before.saturating_sub(steps);
        self.0.left.set(left);
        if before / BETWEEN_LOOKS != left / BETWEEN_LOOKS && self.0.watch.as_ref().is_some_and(|watch| watch()) {
            self.0.stopped.set(true);
        }
        !self.is_exhausted()
    }

    /// Does something with at most one part in so many of what is left. If that is used up, the others remain: what
    /// is good to know does not use up what must be known.
    pub fn share<T>(&self, parts: u64, run: impl FnOnce() -> T) -> T {
        let before = self.0.left.get();
        let granted = before / parts;
        self.0.left.set(granted);
        let result = run();
        self.0.left.set(before - granted + self.0.left.get());
        result
    }
}

fn steps_of(seconds: f64) -> u64 {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a float that is too large saturates")]
    let steps = (seconds * STEPS_PER_SECOND) as u64;
    steps
}

impl Default for Budget {
    fn default() -> Self {
        Self::of_seconds(Self::SECONDS)
    }
}

impl fmt::Debug for Budget {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Budget").field("left", &self.0.left.get()).finish_non_exhaustive()
    }
}

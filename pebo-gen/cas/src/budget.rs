//! The budget of a sequence of problems: steps of work, and a watch on time or memory.
//!
//! In: a number of steps, and perhaps a watch, which reports that the owner's time or memory is used up. Out: true
//! while something is left. An exhausted budget remains exhausted, and refuses every later request at once.
//!
//! Steps come first. They are the same on every machine, so that no verdict depends on its speed; the watch covers
//! their misjudgements. A library has no clock of its own (WebAssembly has none): a caller that has one passes the
//! watch.

use std::cell::Cell;
use std::fmt;
use std::rc::Rc;

/// Steps to a second: a machine of today does half as many again, so that on one somewhat slower they still run out
/// before its clock does.
const STEPS_PER_SECOND: f64 = 100_000_000.0;

/// Problems that a budget suffices for if each takes its limit.
const PROBLEMS: u64 = 20;

/// Steps between two looks at the watch: some milliseconds.
const BETWEEN_LOOKS: u64 = 1 << 18;

/// Reports that the available time or memory is used up.
type Watch = dyn Fn() -> bool;

/// The steps that are left. Clones draw from the same steps.
#[derive(Clone)]
pub struct Budget(Rc<Account>);

struct Account {
    left: Cell<u64>,
    of_one_problem: u64,
    stopped: Cell<bool>,
    watch: Option<Box<Watch>>,
}

impl Budget {
    /// The default budget of a command, in seconds.
    pub const SECONDS: f64 = 10.0;

    /// Without end, for a single small question.
    pub fn unlimited() -> Self {
        Self::of(u64::MAX, None)
    }

    /// The steps done in so many seconds on a reference machine.
    pub fn of_seconds(seconds: f64) -> Self {
        Self::of(steps_of(seconds), None)
    }

    /// As [`Self::of_seconds`], with a watch that is polled every few milliseconds and may end the budget too.
    pub fn with_watch(seconds: f64, watch: impl Fn() -> bool + 'static) -> Self {
        Self::of(steps_of(seconds), Some(Box::new(watch)))
    }

    fn of(left: u64, watch: Option<Box<Watch>>) -> Self {
        // Unlimited and short budgets give a problem its share of the usual budget.
        let usual = steps_of(Self::SECONDS);
        let whole = if left == u64::MAX { usual } else { left.max(usual) };
        let of_one_problem = whole / PROBLEMS;
        Self(Rc::new(Account { left: Cell::new(left), of_one_problem, stopped: Cell::new(false), watch }))
    }

    /// The steps that a single normal form may take, so that others can follow where it is given up.
    pub(super) fn of_one_problem(&self) -> u64 {
        self.0.of_one_problem
    }

    /// True if nothing is left.
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

    /// Runs a closure with at most one part in so many of the steps that are left, so that optional knowledge does not
    /// use up the budget of necessary knowledge.
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

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;
    use crate::number::interval::Precision;
    use crate::{Arena, Expr, Function};

    /// The steps that a closure takes of the arena's budget.
    fn steps(arena: &Arena, run: impl FnOnce()) -> u64 {
        let before = arena.budget().0.left.get();
        run();
        before - arena.budget().0.left.get()
    }

    /// A product of so many sines, and a sum of so many.
    fn long(arena: &Arena, count: u32) -> [Expr; 2] {
        let q = arena.variable("q");
        let sines: Vec<Expr> =
            (1..=count).map(|k| arena.call(Function::Sin, &[arena.add(q, arena.number(i64::from(k)))])).collect();
        [arena.product(sines.iter().copied()), arena.sum(sines)]
    }

    /// Steps stand for time: making or evaluating few long expressions takes as many steps as many short ones do.
    #[test]
    fn long_expressions_take_steps_for_each_operand() {
        let arena = Arena::new();
        let q = arena.symbol("q");
        let [[short, _], [product, sum]] = [20, 200].map(|count| long(&arena, count));
        let derived = |expr: Expr| steps(&arena, || _ = arena.derivative(expr, q));
        assert!(derived(product) > 30 * derived(short));
        let at = BTreeMap::from([(q, arena.number(3))]);
        let precision = Precision::new(64);
        let sines =
            steps(&arena, || _ = arena.enclose(arena.call(Function::Sin, &[arena.of_symbol(q)]), &at, precision));
        assert!(steps(&arena, || _ = arena.enclose(sum, &at, precision)) > 100 * sines);
        let moved = BTreeMap::from([(q, arena.variable("p"))]);
        let substituted = |expr: Expr| steps(&arena, || _ = arena.substitute(expr, &moved));
        assert!(substituted(product) > 5 * substituted(short));
    }

    #[test]
    fn a_problem_has_a_share_that_grows_with_the_whole() {
        let usual = Budget::default().of_one_problem();
        assert_eq!(Budget::unlimited().of_one_problem(), usual);
        assert_eq!(Budget::of_seconds(1.0).of_one_problem(), usual);
        assert_eq!(Budget::of_seconds(6.0 * Budget::SECONDS).of_one_problem(), 6 * usual);
    }
}

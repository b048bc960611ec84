//! A memory of the signs of kernels, permanent and provisional.
//!
//! In: queries as they begin and end, nested. Out: answers. One that was found within another query holds for that
//! query alone, because an open query is not repeated within itself: outside of it, the same kernel may have a sharper
//! sign. It is used until the outermost query ends, and then forgotten.

use std::cell::{Cell, RefCell};
use std::collections::BTreeSet;

use rustc_hash::FxHashMap;

use super::value::Sign;
use crate::Relation;
use crate::graph::expr::Expr;
use crate::poly::Poly;

/// The memory between queries.
#[derive(Default, Debug)]
pub(in crate::tower) struct SignMemory {
    /// The conditions for the expressions to have values.
    pub(super) learned: RefCell<Vec<(Expr, Relation)>>,
    /// Signs of expressions over the box that the facts state.
    pub(super) boxed: RefCell<FxHashMap<Expr, Option<bool>>>,
    pub(super) round: KernelSigns,
}

/// The memory about kernels, discarded with them.
#[derive(Default, Debug)]
pub(super) struct KernelSigns {
    /// Polynomials of known signs: the facts, once they are read, and the conditions for the expressions to have
    /// values.
    pub(super) facts: RefCell<Vec<(Poly, Relation)>>,
    /// True if the facts were read: most problems need no sign.
    pub(super) read: Cell<bool>,
    /// The signs of kernels.
    pub(super) memo: RefCell<Memo>,
    /// The nesting depth of queries by discriminants.
    pub(super) depth: Cell<u32>,
    /// Factors of unknown signs that kernels depend on: with a known sign these would be others.
    pub(super) undecided: RefCell<BTreeSet<Poly>>,
}

impl SignMemory {
    /// Discards the memory about kernels, which are made anew.
    pub(in crate::tower) fn start_again(&mut self) {
        self.round = KernelSigns::default();
    }
}

/// A kernel, and the number of known facts: with more of them its sign may be another.
pub(super) type Query = (u32, usize);

/// The memo.
#[derive(Default, Debug)]
pub(in crate::tower) struct Memo {
    answers: FxHashMap<Query, Option<Sign>>,
    /// Kernels with an open query.
    open: BTreeSet<u32>,
    /// Answers that were found within another query.
    provisional: Vec<Query>,
}

impl Memo {
    /// The known sign.
    pub(super) fn answer(&self, query: Query) -> Option<&Option<Sign>> {
        self.answers.get(&query)
    }

    /// Begins a query; false if one for the kernel is open.
    pub(super) fn begin(&mut self, kernel: u32) -> bool {
        self.open.insert(kernel)
    }

    /// Ends it with an answer; `outermost` if no other kind of query is open around it.
    pub(super) fn end(&mut self, query: Query, sign: Option<Sign>, outermost: bool) {
        self.open.remove(&query.0);
        if self.open.is_empty() && outermost {
            for query in self.provisional.drain(..) {
                self.answers.remove(&query);
            }
        } else {
            self.provisional.push(query);
        }
        self.answers.insert(query, sign);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_answer_within_another_query_ends_with_it() {
        let mut memo = Memo::default();
        assert!(memo.begin(1));
        assert!(memo.begin(2));
        assert!(!memo.begin(1), "a query is not repeated within itself");
        memo.end((2, 0), None, true);
        assert_eq!(memo.answer((2, 0)), Some(&None), "until then it is used");
        memo.end((1, 0), Some(Sign::Positive), true);
        assert_eq!(memo.answer((2, 0)), None);
        assert_eq!(memo.answer((1, 0)), Some(&Some(Sign::Positive)));
        assert_eq!(memo.answer((1, 1)), None, "another fact may change it");
        // By itself the second may have a sharper sign.
        assert!(memo.begin(2));
        memo.end((2, 0), Some(Sign::Negative), true);
        assert_eq!(memo.answer((2, 0)), Some(&Some(Sign::Negative)));
    }

    #[test]
    fn within_another_kind_of_query_answers_are_provisional() {
        let mut memo = Memo::default();
        assert!(memo.begin(1));
        memo.end((1, 0), None, false);
        assert!(memo.begin(2));
        memo.end((2, 0), Some(Sign::Positive), true);
        assert_eq!(memo.answer((1, 0)), None);
        assert_eq!(memo.answer((2, 0)), Some(&Some(Sign::Positive)));
    }
}

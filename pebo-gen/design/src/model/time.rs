//! Time in the formulas of a plant: a known input that nobody has to declare.
//!
//! In: a model whose declarations are consistent. Out: the same; where its formulas use `t` and no declaration has that
//! name, `t` is the last of its inputs, in seconds, and the only one whose rate is known: 1.

use super::class::Class;
use super::formula::Formula;
use super::names::TIME;
use super::spanned::{Entry, Spanned};
use super::written::Model;

/// Its unit.
const SECOND: &str = "s";

impl Model {
    /// The model with time among its inputs, where its formulas use it.
    #[must_use]
    pub(super) fn timed(mut self) -> Self {
        // `B1` and `B2`, and `G`, have a column for each input: an undeclared input has none.
        let by_columns = matches!(self.class, Some(Class::Lti(_) | Class::Mechanical(_)));
        if by_columns || self.names().any(|name| name.value == TIME) {
            return self;
        }
        let uses = self.formulas().flat_map(Formula::names).filter(|(name, _)| *name == TIME);
        let Some(first) = uses.map(|(_, span)| span).min() else { return self };
        let time = Spanned { value: TIME.to_owned(), span: first };
        self.units.push(Entry { name: time.clone(), value: Spanned { value: SECOND.to_owned(), span: first } });
        self.u.push(time);
        self.time = Some(first);
        self
    }

    /// The formulas of the plant, its transform and its domain.
    fn formulas(&self) -> impl Iterator<Item = &Formula> {
        let maps = [&self.define, &self.f_x, &self.f_y, &self.g_y, &self.phi_left, &self.known, &self.angles];
        let maps = maps.into_iter().flatten().map(|entry| &entry.value);
        let assumed = self
            .assume
            .iter()
            .flat_map(|chain| std::iter::once(&chain.first).chain(chain.rest.iter().map(|side| &side.1)));
        let of_class = self.class.iter().flat_map(Class::formulas);
        maps.chain(&self.phi).chain(&self.identities).chain(assumed).chain(of_class)
    }
}

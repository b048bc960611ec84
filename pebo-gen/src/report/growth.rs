//! The cost of the observer's functions beside that of the author's formulas.
//!
//! In: a plant and its accepted derivation. Out: the operations of both, each as one straight-line program that
//! computes every subexpression once, with the parameters among its inputs; and the function that takes most of them.

use pebo_cas::{Expr, Symbol};
use pebo_design::analysis::{Derivation, Outcome};
use pebo_design::plant::{Class, Plant};
use pebo_design::program::{Cost, lower};

/// The ratio of operations that counts as large: all models and cases of this project are below 4, and a left inverse
/// that writes out a determinant of order 4 has 11.
const MANY: usize = 10;

/// Operations of a page of code, which are few at any ratio.
const PAGE: usize = 300;

/// The operations of a model and of its observer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Growth {
    /// Operations of the rates and the transform, or of the matrices and forces of a mechanical plant.
    pub(super) written: usize,
    /// Operations of the functions of the observer.
    pub(super) derived: usize,
    /// The function that takes most of them by itself.
    pub(super) most: &'static str,
}

impl Growth {
    /// The growth of an accepted model.
    pub(super) fn of(plant: &Plant, derivation: &Derivation) -> Option<Self> {
        let functions = functions(derivation)?;
        let derived = combined(plant, &functions)?;
        let most = functions.iter().max_by_key(|function| operations(plant, &function.1))?.0;
        Some(Self { written: operations(plant, &written(plant))?, derived, most })
    }

    /// The growth of a model whose observer takes more than a page.
    pub(super) fn of_long(plant: &Plant, derivation: &Derivation) -> Option<Self> {
        (combined(plant, &functions(derivation)?)? > PAGE).then(|| Self::of(plant, derivation)).flatten()
    }

    /// The ratio, if it is large.
    pub(super) fn many(self) -> Option<usize> {
        let times = self.derived / self.written.max(1);
        (times >= MANY && self.derived > PAGE).then_some(times)
    }
}

/// The functions of an accepted model's observer, with their names.
fn functions(derivation: &Derivation) -> Option<Vec<(&'static str, Vec<Expr>)>> {
    if derivation.outcome != Outcome::Accepted {
        return None;
    }
    let cascade = derivation.cascade.result.as_ref()?;
    let inverse = derivation.left_inverse.result.as_ref()?;
    let regression = derivation.regression.result.as_ref()?;
    Some(vec![
        ("h", cascade.h.clone()),
        ("lambda", cascade.lambda.iter().flatten().flatten().copied().collect()),
        ("phi_0", regression.phi_0.clone()),
        ("phi_1", regression.phi_1.concat()),
        ("primitive_0", regression.primitive_0.clone()),
        ("primitive_1", regression.primitive_1.concat()),
        ("phi_left", inverse.x.iter().map(|state| state.1).collect()),
    ])
}

/// The operations of one program for all functions.
fn combined(plant: &Plant, functions: &[(&'static str, Vec<Expr>)]) -> Option<usize> {
    let all: Vec<Expr> = functions.iter().flat_map(|function| &function.1).copied().collect();
    operations(plant, &all)
}

/// The author's formulas: for a class, its matrices and forces.
fn written(plant: &Plant) -> Vec<Expr> {
    match &plant.class {
        Some(Class::Mechanical(mechanical)) => {
            [mechanical.inertia.entries(), mechanical.frame.entries(), mechanical.h.clone()].concat()
        }
        _ => plant.rates().into_values().chain(plant.transform()).collect(),
    }
}

/// The operations of one program for all formulas.
fn operations(plant: &Plant, formulas: &[Expr]) -> Option<usize> {
    let inputs: Vec<Symbol> = plant.arena.symbols_of(formulas).into_iter().collect();
    Some(Cost::of(&lower(&plant.arena, &inputs, formulas).ok()?).total())
}

#[cfg(all(test, feature = "yaml"))]
mod tests {
    use super::*;
    use pebo_design::source::Source;

    /// A model with so many states, whose transform is their product with a matrix of parameters.
    fn growth(states: usize) -> Growth {
        let each = |entry: &dyn Fn(usize) -> String| (1..=states).map(entry).collect::<Vec<_>>().join(", ");
        let entry = |i: usize, j: usize| format!("a{i}{j}");
        let rows = each(&|i| each(&|j| format!("{}: {}", entry(i, j), if i == j { 3 } else { 1 })));
        let text = format!(
            "model: m\nparameters: {{{rows}}}\nx: [{x}]\ny: [{y}]\nu: [u]\nf_x: {{{f_x}}}\nf_y: {{{f_y}}}\nphi: [{phi}]\n",
            x = each(&|i| format!("x{i}")),
            y = each(&|i| format!("y{i}")),
            f_x = each(&|i| format!("x{i}: u - y{i}")),
            f_y = each(&|i| format!("y{i}: x{i}")),
            phi = each(&|i| each(&|j| format!("{}*x{j}", entry(i, j))).replace(", ", " + ")),
        );
        let derived = crate::derive(&Source::new("m", text).expect("a text")).expect("a model");
        Growth::of(&derived.plant, &derived.derivation).expect("an accepted model")
    }

    #[test]
    fn an_inverse_that_is_written_out_costs_many_times_its_matrix() {
        assert_eq!(growth(2).many(), None);
        let four = growth(4);
        assert!(four.many().is_some_and(|times| times >= MANY) && four.most != "h", "{four:?}");
    }
}

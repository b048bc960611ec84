//! The transform of an observer whose components depend on one another.
//!
//! In: a plant with its proved left inverse and regression. Out: the components of phi with their derivatives by the
//! recovered states, if they satisfy an equation in which neither outputs nor parameters occur, as `x1`, `x2` and
//! `x1*x2` do: the observer estimates them as if they were independent, and its estimate of the states is better where it
//! counts this. An equation with parameters is left to the regression: it holds no better than these are known.

use std::collections::BTreeSet;

use crate::plant::Plant;
use pebo_cas::linear::rank::{full_rank, proved_rank};
use pebo_cas::{Expr, Symbol};

use super::design::{LeftInverse, Regression};

/// Components of phi that depend on one another.
#[derive(Clone, Debug)]
pub struct RelatedTransform {
    /// The components, functions of the recovered states and the outputs.
    pub phi: Vec<Expr>,
    /// Their derivatives, a row for each with an entry for each recovered state.
    pub slopes: Vec<Vec<Expr>>,
}

impl RelatedTransform {
    /// The transform of a plant; none unless its components are related and the left inverse gives all that they depend on.
    pub fn of(plant: &Plant, left_inverse: &LeftInverse, regression: &Regression) -> Option<Self> {
        let arena = &plant.arena;
        let states: Vec<Symbol> = left_inverse.x.iter().map(|(state, _)| *state).collect();
        let phi = plant.transform();
        let symbols = arena.symbols_of(&phi);
        let recovered: BTreeSet<Symbol> = states.iter().copied().collect();
        let is_known = |symbol: &Symbol| recovered.contains(symbol) || !plant.hidden().contains(symbol);
        let is_theta = regression.theta.len() == regression.eta_symbols.len()
            && regression.theta.iter().zip(&regression.eta_symbols).all(|(t, e)| arena.as_symbol(*t) == Some(*e));
        if phi.len() <= states.len() || !is_theta || !symbols.iter().all(is_known) {
            return None;
        }
        let by = |symbols: &[Symbol]| -> Vec<Vec<Expr>> {
            phi.iter().map(|phi| symbols.iter().map(|symbol| arena.derivative(*phi, *symbol)).collect()).collect()
        };
        let domain = plant.domain();
        let all: Vec<Symbol> = symbols.into_iter().collect();
        // The rank by all symbols is that by the states: all equations among the components are free of the others.
        let slopes = by(&states);
        let is_related = full_rank(arena, &domain, &slopes, states.len())
            && proved_rank(arena, &domain, &by(&all), all.len()) == states.len();
        is_related.then_some(Self { phi, slopes })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::Derivation;
    use crate::model::Model;
    use crate::source::Source;

    /// The components of phi that are related, as printed, of an accepted model.
    fn of(lines: &str) -> Option<Vec<String>> {
        let text = format!("model: m\nparameters: {{k: 2}}\n{lines}\n");
        let plant = Plant::resolve(&Model::parse(&Source::new("m", text).unwrap()).unwrap()).unwrap();
        let derivation = Derivation::derive(&plant);
        let claims = (derivation.left_inverse.result.as_ref(), derivation.regression.result.as_ref());
        let (Some(left_inverse), Some(regression)) = claims else { panic!("{:?}", derivation.diagnostics) };
        let found = RelatedTransform::of(&plant, left_inverse, regression)?;
        Some(found.phi.iter().map(|phi| plant.arena.print(*phi)).collect())
    }

    #[test]
    fn functions_of_other_components_are_related_to_them() {
        let product = of("x: [a, b]\ny: [s]\nu: [v]\nf_x: {a: 0, b: 0}\ng_y: {s: a + v*a*b}\nphi: [a, b, a*b]");
        assert_eq!(product.unwrap(), ["a", "b", "a*b"]);
        let angle =
            of("x: [q]\ny: [s]\nu: [v]\nf_x: {q: v}\ng_y: {s: sin(q)}\nphi: [sin(q), cos(q)]\nangles: {q: 2*pi}");
        assert_eq!(angle.unwrap(), ["sin(q)", "cos(q)"]);
        // An output may be in them.
        let epidemic = "x: [S, b, g]\ny: [I]\nu: [v]\nassume: [S > 0, I > 0, b > 0, g > 0]\n\
            f_x: {S: -b*S*I - v*S, b: 0, g: 0}\nf_y: {I: b*S*I - g*I}\nphi: [S*b + I*b, b, g, b*g]";
        assert_eq!(of(epidemic).unwrap(), ["S*b + I*b", "b", "g", "b*g"]);
    }

    #[test]
    fn a_relation_that_holds_by_parameters_or_outputs_is_none() {
        let parameter = "x: [q]\ny: [i1, i2]\nu: [v]\nf_x: {q: v}\nf_y: {i1: 'k*cos(q)', i2: 'k*sin(q)'}\n";
        assert_eq!(of(&format!("{parameter}phi: [k*cos(q), k*sin(q)]\nangles: {{q: 2*pi}}")), None);
        let alone = "x: [a, b]\ny: [s]\nu: [v]\nf_x: {a: 0, b: 0}\ng_y: {s: a + v*b}\nphi: [a, b]";
        assert_eq!(of(alone), None);
    }
}

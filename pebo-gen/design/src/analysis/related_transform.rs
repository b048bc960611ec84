//! The transform of an observer whose components depend on one another.
//!
//! In: a plant with its proved claims. Out: the components of phi with their derivatives by the recovered states, if they
//! satisfy an equation, as `x1`, `x2` and `x1*x2` do: the observer estimates them as if they were independent, and its
//! estimate of the states is better where it counts this. The equation may hold outputs that are states of the observer,
//! and parameters that the observer computes with. One with others is left to the regression: it is as noisy as samples
//! are, or holds no better than these parameters are known.

use std::collections::BTreeSet;

use crate::plant::Plant;
use pebo_cas::linear::rank::{full_rank, proved_rank};
use pebo_cas::{Expr, Symbol};

use super::design::{Cascade, LeftInverse, Regression};

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
    pub fn of(plant: &Plant, cascade: &Cascade, left_inverse: &LeftInverse, regression: &Regression) -> Option<Self> {
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
        let computed: Vec<Expr> = [&cascade.h, &regression.phi_0].into_iter().flatten().copied().collect();
        let factors = cascade.lambda.iter().chain([&regression.phi_1]).flatten().flatten().copied();
        let used = arena.symbols_of(&computed.into_iter().chain(factors).collect::<Vec<_>>());
        let estimated = regression.outputs_with_rates(plant).unwrap_or_default();
        let is_estimated = |symbol: &Symbol| estimated.iter().any(|output| plant.y[*output].symbol == *symbol);
        let is_output = |symbol: &Symbol| plant.y.iter().any(|output| output.symbol == *symbol);
        let admitted = |symbol: &Symbol| if is_output(symbol) { is_estimated(symbol) } else { used.contains(symbol) };
        let others: Vec<Symbol> =
            symbols.into_iter().filter(|symbol| recovered.contains(symbol) || !admitted(symbol)).collect();
        // The rank by these symbols is that by the states: all equations among the components are free of the others.
        let slopes = by(&states);
        let is_related = full_rank(arena, &domain, &slopes, states.len())
            && proved_rank(arena, &domain, &by(&others), others.len()) == states.len();
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
        let cascade = derivation.cascade.result.as_ref().unwrap();
        let (Some(left_inverse), Some(regression)) = claims else { panic!("{:?}", derivation.diagnostics) };
        let found = RelatedTransform::of(&plant, cascade, left_inverse, regression)?;
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
    fn outputs_and_parameters_of_the_observer_may_be_in_the_relation() {
        // `z1 = z2*(k*z3 + y)`: y is a state of the observer, and k is in its cascade.
        let winding = "x: [a, p]\ny: [y]\nu: [v]\nassume: [a > 0]\nf_x: {a: 0, p: a*(y - p)}\n\
            f_y: {y: v - k*a*(y - p)}\nphi: [a*(k*p + y), a, p]";
        assert_eq!(of(winding).map(|phi| phi.len()), Some(3));
    }

    #[test]
    fn a_relation_that_holds_by_parameters_or_outputs_is_none() {
        let parameter = "x: [q]\ny: [i1, i2]\nu: [v]\nf_x: {q: v}\nf_y: {i1: 'k*cos(q)', i2: 'k*sin(q)'}\n";
        assert_eq!(of(&format!("{parameter}phi: [k*cos(q), k*sin(q)]\nangles: {{q: 2*pi}}")), None);
        let alone = "x: [a, b]\ny: [s]\nu: [v]\nf_x: {a: 0, b: 0}\ng_y: {s: a + v*b}\nphi: [a, b]";
        assert_eq!(of(alone), None);
    }
}

//! Slopes of all rates by the outputs, for an observer that has these outputs among its states.
//!
//! In: the cascade, and a regression of rates of outputs. Out: the derivatives of the known terms of both by these
//! outputs. With them the terms are linearised at each sample, so that to first order the noise of its sensors is in no
//! rate; along every trajectory the linearised terms have the values of the terms themselves.

use std::collections::{BTreeMap, BTreeSet};

use crate::plant::Plant;
use pebo_cas::graph::conditions::Regularity;
use pebo_cas::{Arena, Expr, Symbol};

use super::design::{Cascade, Regression};

/// Derivatives of the known terms of the rates by outputs; 0 where the known terms of a rate are not differentiable in the
/// output wherever they have a value, so that no slope refuses a sample.
#[derive(Clone, Debug)]
pub struct OutputSlopes {
    /// The positions in the plant's outputs of those whose rates are the first rows of the regression.
    pub outputs: Vec<usize>,
    /// The derivatives of `Phi_0` at the start of the extension, for each row of the regression; a column for each row.
    pub rates: Vec<Vec<Expr>>,
    /// Those of `h`, for each component of the transform.
    pub cascade: Vec<Vec<Expr>>,
}

impl OutputSlopes {
    /// The slopes; none where all are 0, or where something else than outputs is under the derivative.
    pub fn of(plant: &Plant, cascade: &Cascade, regression: &Regression) -> Option<Self> {
        let arena = &plant.arena;
        let outputs = regression.outputs_with_rates(plant)?;
        // The factors of the coordinates at the extension's start, where these are 0.
        let start: BTreeMap<Symbol, Expr> = plant.chi.iter().chain(&plant.xi).map(|&c| (c, arena.zero())).collect();
        let known = arena.substitute_all(&regression.phi_0, &start);
        let equations = regression.phi_0.len();
        let row = |rate: Expr, is_rate: bool| -> Vec<Expr> {
            let slope = |column: usize| match outputs.get(column) {
                Some(&output) if is_rate => slope(arena, rate, plant.y[output].symbol),
                _ => arena.zero(),
            };
            (0..equations).map(slope).collect()
        };
        let rates = known.iter().enumerate().map(|(place, rate)| row(*rate, place < outputs.len())).collect();
        let cascade = cascade.h.iter().map(|rate| row(*rate, true)).collect();
        let found = Self { outputs, rates, cascade };
        let is_some = found.rates.iter().chain(&found.cascade).flatten().any(|slope| !arena.is_zero(*slope));
        is_some.then_some(found)
    }
}

/// The derivative of a rate by an output, if it has one wherever the rate has a value; else 0.
fn slope(arena: &Arena, rate: Expr, output: Symbol) -> Expr {
    let of = BTreeSet::from([output]);
    let is_smooth = |part: &Expr| {
        let conditions = |regularity| arena.operation_conditions(*part, regularity);
        conditions(Regularity::Differentiable) == conditions(Regularity::Defined)
    };
    let parts = arena.postorder(&[rate]);
    let mut through = parts.iter().filter(|part| arena.depends_on(**part, &of));
    if through.all(is_smooth) { arena.derivative(rate, output) } else { arena.zero() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::Derivation;
    use crate::model::Model;
    use crate::source::Source;

    /// The slopes of the rates of `y` and `z1` by `y`, as printed.
    fn of(lines: &str) -> Option<[String; 2]> {
        let text = format!("model: m\nx: [a]\ny: [y]\nu: [u]\nparameters: {{k: 2}}\n{lines}\n");
        let plant = Plant::resolve(&Model::parse(&Source::new("m", text).unwrap()).unwrap()).unwrap();
        let derivation = Derivation::derive(&plant);
        let regression = derivation.regression.result.as_ref().unwrap();
        let found = OutputSlopes::of(&plant, derivation.cascade.result.as_ref().unwrap(), regression)?;
        Some([found.rates[0][0], found.cascade[0][0]].map(|slope| plant.arena.print(slope)))
    }

    #[test]
    fn every_known_term_has_its_slope() {
        let linear = of("f_x: {a: u - k*y}\nf_y: {y: a - u*y}\nphi: [a]").unwrap();
        assert_eq!(linear, ["-u", "-k"]);
        let curved = of("f_x: {a: sin(y)}\nf_y: {y: a + y^2}\nphi: [a]").unwrap();
        assert_eq!(curved, ["2*y", "cos(y)"]);
        // What multiplies an unknown is none of the known terms.
        assert_eq!(of("f_x: {a: u}\nf_y: {y: (2 + y^2)*a}\nphi: [a]"), None);
    }

    #[test]
    fn a_rate_that_has_a_corner_or_a_root_has_no_slope_there() {
        for corner in ["abs(y - u)", "max(y, u)", "sqrt(y)", "min(y, 1)^2"] {
            let found = of(&format!("f_x: {{a: '{corner} - y'}}\nf_y: {{y: a - y}}\nphi: [a]\nassume: [\"y >= 0\"]"));
            assert_eq!(found.unwrap(), ["-1", "0"], "{corner}");
        }
        // Beside one of the input there is one.
        assert_eq!(of("f_x: {a: abs(u)*y}\nf_y: {y: a}\nphi: [a]").unwrap(), ["0", "abs(u)"]);
    }
}

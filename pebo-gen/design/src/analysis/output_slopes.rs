//! Slopes of all rates by the outputs, for an observer that has these outputs among its states.
//!
//! In: the cascade, and a regression of rates of outputs. Out: the derivatives of both by these outputs, as functions of
//! z. With them and an estimate of z the rates are linearised at each sample, so that to first order the noise of its
//! sensors is in no rate; along every trajectory the linearised rates have the values of the rates themselves, whatever
//! the estimate is. So it is with rows that hold at an instant, where such an output stands beside others.

use std::collections::{BTreeMap, BTreeSet};

use crate::plant::Plant;
use pebo_cas::graph::conditions::Regularity;
use pebo_cas::{Arena, Expr, Symbol};

use super::design::{Cascade, Regression};

/// Derivatives of the rates by outputs, at z; terms that are not differentiable in the output wherever they have a value
/// are left out, so that no slope refuses a sample.
#[derive(Clone, Debug)]
pub struct OutputSlopes {
    /// The positions in the plant's outputs of those whose rates are the first rows of the regression.
    pub outputs: Vec<usize>,
    /// Those of the regression's rows, a column for each row. Those of an instant do not depend on z.
    pub rates: Vec<Vec<Expr>>,
    /// Those of the cascade's, for each component of the transform.
    pub cascade: Vec<Vec<Expr>>,
}

impl OutputSlopes {
    /// The slopes; none where all are 0, or where something else than outputs is under the derivative.
    pub fn of(plant: &Plant, cascade: &Cascade, regression: &Regression) -> Option<Self> {
        let arena = &plant.arena;
        let outputs = regression.outputs_with_rates(plant)?;
        let (known, mut factor) = at_start(plant, regression);
        if regression.is_at_estimate() {
            // The known side is all of the equation.
            factor.iter_mut().for_each(Vec::clear);
        }
        let z = plant.z.iter().copied().collect();
        let equations = known.len();
        let row = |known: Expr, factor: &[Expr], is_rate: bool| -> Vec<Expr> {
            let slope = |column: usize| {
                let Some(&output) = outputs.get(column) else { return arena.zero() };
                let by = |rate: Expr| slope(arena, rate, plant.y[output].symbol);
                let mut terms = factor.iter().zip(&plant.z).map(|(f, z)| arena.mul(by(*f), arena.of_symbol(*z)));
                if is_rate {
                    terms.fold(by(known), |sum, term| arena.add(sum, term))
                } else if terms.all(|term| arena.is_zero(term)) && !arena.depends_on(by(known), &z) {
                    by(known)
                } else {
                    // Noise in a factor of the unknown is corrected as an error in a variable.
                    arena.zero()
                }
            };
            (0..equations).map(slope).collect()
        };
        let rates = known.iter().zip(&factor).enumerate();
        let rates = rates.map(|(place, (known, factor))| row(*known, factor, place < outputs.len())).collect();
        let lambda = |place: usize| cascade.lambda.as_ref().map_or(&[][..], |lambda| lambda[place].as_slice());
        let cascade = cascade.h.iter().enumerate().map(|(place, h)| row(*h, lambda(place), true)).collect();
        let found = Self { outputs, rates, cascade };
        let is_some = found.rates.iter().chain(&found.cascade).flatten().any(|slope| !arena.is_zero(*slope));
        is_some.then_some(found)
    }
}

/// True if each output whose rate the regression has is in all rates with a factor that depends neither on such outputs nor
/// on z: rates that are linearised in these outputs are then the same at all their values.
pub fn are_affine_in_outputs(plant: &Plant, cascade: &Cascade, regression: &Regression) -> bool {
    let arena = &plant.arena;
    let Some(outputs) = regression.outputs_with_rates(plant) else { return false };
    let outputs: Vec<Symbol> = outputs.into_iter().map(|output| plant.y[output].symbol).collect();
    let (known, factor) = at_start(plant, regression);
    let mut terms: Vec<Expr> = [known.as_slice(), &cascade.h].concat();
    let factors: Vec<Expr> = factor.iter().chain(cascade.lambda.iter().flatten()).flatten().copied().collect();
    let of = outputs.iter().copied().collect();
    // Where an output is in a factor of z, z is in the output's.
    let by = |output: &Symbol| terms.iter().map(|term| arena.derivative(*term, *output)).collect::<Vec<_>>();
    terms = outputs.iter().flat_map(by).chain(factors).collect();
    !terms.iter().any(|term| arena.depends_on(*term, &of))
}

/// The sides of a regression at the start of its extension, where the unknown is z; those of a local one where it is z.
fn at_start(plant: &Plant, regression: &Regression) -> (Vec<Expr>, Vec<Vec<Expr>>) {
    let arena = &plant.arena;
    let identity = plant.psi.iter().enumerate().flat_map(|(i, row)| {
        row.iter().enumerate().map(move |(j, s)| (*s, if i == j { arena.one() } else { arena.zero() }))
    });
    let z: Vec<Expr> = plant.z.iter().map(|z| arena.of_symbol(*z)).collect();
    let regression = regression.with_extension(plant, &z);
    let zero = plant.chi.iter().chain(&plant.xi).map(|s| (*s, arena.zero()));
    let start: BTreeMap<Symbol, Expr> = zero.chain(identity).collect();
    let factor = regression.phi_1.iter().map(|row| arena.substitute_all(row, &start)).collect();
    (arena.substitute_all(&regression.phi_0, &start), factor)
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

    fn derived(lines: &str) -> (Plant, Derivation) {
        derived_of(&format!("y: [y]\n{lines}"))
    }

    fn derived_of(lines: &str) -> (Plant, Derivation) {
        let text = format!("model: m\nx: [a]\nu: [u]\nparameters: {{k: 2}}\n{lines}\n");
        let plant = Plant::resolve(&Model::parse(&Source::new("m", text).unwrap()).unwrap()).unwrap();
        let derivation = Derivation::derive(&plant);
        (plant, derivation)
    }

    /// The slopes of the rates of `y` and `z1` by `y`, as printed.
    fn of(lines: &str) -> Option<[String; 2]> {
        let (plant, derivation) = derived(lines);
        let regression = derivation.regression.result.as_ref().unwrap();
        let found = OutputSlopes::of(&plant, derivation.cascade.result.as_ref().unwrap(), regression)?;
        Some([found.rates[0][0], found.cascade[0][0]].map(|slope| plant.arena.print(slope)))
    }

    #[test]
    fn every_term_has_its_slope() {
        let linear = of("f_x: {a: u - k*y}\nf_y: {y: a - u*y}\nphi: [a]").unwrap();
        assert_eq!(linear, ["-u", "-k"]);
        let curved = of("f_x: {a: sin(y)}\nf_y: {y: a + y^2}\nphi: [a]").unwrap();
        assert_eq!(curved, ["2*y", "cos(y)"]);
        // So has what multiplies an unknown, at an estimate.
        assert_eq!(of("f_x: {a: u}\nf_y: {y: (2 + y^2)*a}\nphi: [a]").unwrap(), ["2*y*z1", "0"]);
        assert_eq!(of("f_x: {a: u}\nf_y: {y: (2 + u^2)*a}\nphi: [a]"), None);
    }

    #[test]
    fn a_value_has_the_slopes_that_do_not_depend_on_z() {
        // In the value of `v`, `y` stands alone or as a factor of the unknown.
        for (value, expected) in [("3*a + u*y", "-u"), ("a + y^2", "-2*y"), ("a*(1 + y)", "0"), ("a*y + y", "0")] {
            let (plant, derivation) =
                derived_of(&format!("y: [y, v]\nf_x: {{a: u}}\nf_y: {{y: a - y}}\ng_y: {{v: '{value}'}}\nphi: [a]"));
            let regression = derivation.regression.result.as_ref().unwrap();
            assert_eq!(regression.instants(&plant.arena), 1, "{value}");
            let found = OutputSlopes::of(&plant, derivation.cascade.result.as_ref().unwrap(), regression).unwrap();
            let of_y = [found.rates[0][0], found.rates[1][0]].map(|slope| plant.arena.print(slope));
            assert_eq!(of_y, ["-1", expected], "{value}");
        }
    }

    #[test]
    fn rates_may_be_affine_in_outputs_and_unknowns_combined() {
        let affine = |f_x: &str, f_y: &str| {
            let (plant, derivation) = derived(&format!("f_x: {{a: '{f_x}'}}\nf_y: {{y: '{f_y}'}}\nphi: [a]"));
            let cascade = derivation.cascade.result.as_ref().unwrap();
            are_affine_in_outputs(&plant, cascade, derivation.regression.result.as_ref().unwrap())
        };
        assert!(affine("u - k*y", "a - u*y + cos(u)"));
        for (f_x, f_y) in [("sin(y)", "a"), ("u", "a*y"), ("-y*a", "a"), ("u", "a + y^2"), ("abs(y)", "a")] {
            assert!(!affine(f_x, f_y), "{f_x}, {f_y}");
        }
    }

    #[test]
    fn a_rate_that_has_a_corner_or_a_root_has_no_slope_there() {
        for corner in ["abs(y - u)", "max(y, u)", "sqrt(y)", "min(y, 1)^2"] {
            let found = of(&format!("f_x: {{a: '{corner} - y'}}\nf_y: {{y: a - y}}\nphi: [a]\nassume: [\"y >= 0\"]"));
            assert_eq!(found.unwrap(), ["-1", "0"], "{corner}");
        }
        // A factor with a corner takes none from the known terms.
        assert_eq!(of("f_x: {a: u}\nf_y: {y: 'abs(y)*a - y'}\nphi: [a]").unwrap(), ["-1", "0"]);
        // Beside one of the input there is one.
        assert_eq!(of("f_x: {a: abs(u)*y}\nf_y: {y: a}\nphi: [a]").unwrap(), ["0", "abs(u)"]);
    }
}

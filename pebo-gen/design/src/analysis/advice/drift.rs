//! Components of the extension that are open integrators, and the runtime's means against their drift (Ortega et al.
//! 2015, remark R5).

use crate::plant::Plant;
use pebo_cas::Expr;
use pebo_cas::domain::zero::is_zero;

use super::remark::Drift;
use crate::analysis::design::{Class, Derivation, Regression, RegressionKind, Verdict};

impl Drift {
    /// The open integrators of an extension; none without a proved cascade.
    pub(in crate::analysis) fn of(plant: &Plant, derivation: &Derivation) -> Option<Self> {
        let cascade = derivation.cascade.result.as_ref().filter(|_| derivation.cascade.verdict == Verdict::Proved)?;
        let arena = &plant.arena;
        let domain = plant.domain();
        let zero = |expr: &Expr| is_zero(arena, *expr, &domain);
        let apart = |row: usize| cascade.lambda.as_ref().is_none_or(|lambda| lambda[row].iter().all(zero));
        let open: Vec<usize> = (0..cascade.h.len()).filter(|row| apart(*row) && !zero(&cascade.h[*row])).collect();
        let extension = match derivation.class {
            Class::Pebo => &plant.chi,
            Class::Gpebo => &plant.xi,
        };
        let rates: Vec<Expr> = open.iter().map(|row| cascade.h[*row]).collect();
        let read = arena.symbols_of(&rates);
        let signals = plant.y.iter().map(|output| output.symbol).chain(plant.commanded());
        let fixed = derivation.fixed_by_start(plant);
        let is_uncorrected = |row: &&usize| fixed.contains(&plant.theta[**row]);
        Some(Self {
            uncorrected: open.iter().filter(is_uncorrected).map(|row| extension[*row]).collect(),
            integrators: open.iter().map(|row| extension[*row]).collect(),
            integrated: signals.filter(|signal| read.contains(signal)).collect(),
        })
    }
}

/// The expressions that vanish if a shift c of theta leaves the regression as it is (`Rebase` of the runtime): the
/// derivative of `Phi_0` along c less `Phi_1`, with the sign of a static regression, and the derivative of `Phi_1`;
/// likewise for the terms under the derivative. None where the unknowns are not theta itself.
pub(in crate::analysis) fn rebase_residuals(plant: &Plant, class: Class, regression: &Regression) -> Option<Vec<Expr>> {
    let arena = &plant.arena;
    let unknowns = regression.eta_symbols.iter().map(|&eta| arena.of_symbol(eta));
    if unknowns.ne(regression.theta.iter().copied()) {
        return None;
    }
    let extension = match class {
        Class::Pebo => &plant.chi,
        Class::Gpebo => &plant.xi,
    };
    let mut residuals = Vec::new();
    let primitives = regression.primitive_0.iter().zip(&regression.primitive_1);
    for (phi_0, phi_1) in regression.phi_0.iter().zip(&regression.phi_1).chain(primitives) {
        let slopes: Vec<Expr> = extension.iter().map(|&chi| arena.derivative(*phi_0, chi)).collect();
        for (column, &entry) in phi_1.iter().enumerate() {
            let slope = match class {
                Class::Pebo => slopes[column],
                Class::Gpebo => arena.sum(
                    slopes.iter().zip(&plant.psi).map(|(&slope, row)| arena.mul(slope, arena.of_symbol(row[column]))),
                ),
            };
            residuals.push(match regression.kind {
                RegressionKind::Static => arena.add(slope, entry),
                RegressionKind::Dynamic | RegressionKind::Implicit => arena.sub(slope, entry),
            });
            residuals.extend(extension.iter().map(|&chi| arena.derivative(entry, chi)));
        }
    }
    Some(residuals)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::Model;
    use crate::source::Source;
    use pebo_cas::Symbol;

    /// Integrators and their integrands.
    fn of(lines: &str) -> Option<String> {
        let text = format!("model: m\n{lines}\n");
        let plant = Plant::resolve(&Model::parse(&Source::new("m", text).unwrap()).unwrap()).unwrap();
        let drift = Drift::of(&plant, &Derivation::derive(&plant))?;
        let names = |symbols: &[Symbol]| symbols.iter().map(|s| plant.arena.name(*s)).collect::<Vec<_>>().join(" ");
        Some(format!("{} of {}", names(&drift.integrators), names(&drift.integrated)))
    }

    #[test]
    fn an_integrator_of_a_signal_drifts_and_a_constant_does_not() {
        let pendulum = "x: [p]\ny: [q]\nu: [tau]\nf_x: {p: tau - sin(q)}\nf_y: {q: p}\nphi: [p]";
        assert_eq!(of(pendulum).unwrap(), "chi1 of q tau");
        // h1 is zero, also where it is not written so; h2 reads the input alone.
        for zero in ["0", "sin(c)^2 + cos(c)^2 - 1"] {
            let lines =
                format!("x: [a, b]\ny: [c, d]\nu: [u]\nf_x: {{a: {zero}, b: u}}\nf_y: {{c: a, d: b}}\nphi: [a, b]");
            assert_eq!(of(&lines).unwrap(), "chi2 of u", "{zero}");
        }
    }

    #[test]
    fn a_component_that_the_extension_feeds_is_no_open_integrator() {
        // a and b turn with the frame, c' = v alone.
        let frame = "x: [a, b, c]\ny: [p, q]\nu: [w, v]\nf_x: {a: w*b, b: v - w*a, c: v}\n\
                     f_y: {p: a, q: c}\nphi: [a, b, c]";
        assert_eq!(of(frame).unwrap(), "xi3 of v");
    }

    #[test]
    fn without_an_integrator_there_is_no_drift() {
        for (rate, drifts) in [("0", false), ("q", true)] {
            let text = format!("model: m\nx: [a]\ny: [q]\nf_x: {{a: {rate}}}\nf_y: {{q: a}}\nphi: [a]\n");
            let plant = Plant::resolve(&Model::parse(&Source::new("m", text).unwrap()).unwrap()).unwrap();
            assert_eq!(Derivation::derive(&plant).drift(&plant).is_some(), drifts, "{rate}");
        }
    }

    #[test]
    fn without_a_cascade_nothing_is_said() {
        assert_eq!(of("x: [x]\ny: [y]\nf_x: {x: x^2}\nf_y: {y: y}\nphi: [x]"), None);
    }
}

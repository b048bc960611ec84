//! Checks that each formula contains only the arguments of its function.
//!
//! In: a claim. Out: the same, undecided where a formula of a proved one holds a symbol that the emitted function does
//! not get. Each claim takes care of this on its own; this check finds a forgotten or confused symbol in one place,
//! before anything builds on the claim or is accepted.

use std::collections::BTreeSet;

use crate::plant::Plant;
use crate::source::{Code, Diagnostic, Span};
use pebo_cas::{Expr, Symbol};

use super::design::{Cascade, Claim, Class, LeftInverse, Regression, Verdict};

/// A function: its name, its entries, and its arguments besides the parameters.
type Function = (&'static str, Vec<Expr>, Vec<Symbol>);

/// Arguments of the transform have rates; arguments of `h` and `Lambda` are outputs and inputs.
pub(super) fn cascade(plant: &Plant, claim: Claim<Cascade>, found: &mut Vec<Diagnostic>) -> Claim<Cascade> {
    let signals = [outputs(plant), plant.u.clone()].concat();
    // A symbol without a rate would count as a constant.
    let with_inputs: Vec<Symbol> = plant.rates().into_keys().collect();
    confined(plant, claim, Code::CascadeUndecided, found, |cascade| {
        let lambda = cascade.lambda.iter().flatten().flatten().copied().collect();
        vec![
            ("phi", plant.transform(), with_inputs.clone()),
            ("h", cascade.h.clone(), signals.clone()),
            ("Lambda", lambda, signals.clone()),
        ]
    })
}

/// `phi_left` knows coordinates and outputs; a period is constant.
pub(super) fn left_inverse(
    plant: &Plant,
    claim: Claim<LeftInverse>,
    found: &mut Vec<Diagnostic>,
) -> Claim<LeftInverse> {
    let coordinates = [plant.z.clone(), outputs(plant)].concat();
    confined(plant, claim, Code::LeftInverseUndecided, found, |inverse| {
        let values = |pairs: &[(Symbol, Expr)]| pairs.iter().map(|pair| pair.1).collect();
        vec![("phi_left", values(&inverse.x), coordinates.clone()), ("a period", values(&inverse.modulo), Vec::new())]
    })
}

/// `phi_0` and `phi_1` have the extension, outputs and inputs as arguments; functions under a time derivative no
/// inputs, which the runtime does not pass; `eta` and `theta` have each other.
pub(super) fn regression(
    plant: &Plant,
    class: Class,
    claim: Claim<Regression>,
    found: &mut Vec<Diagnostic>,
) -> Claim<Regression> {
    let extension = match class {
        Class::Pebo => plant.chi.clone(),
        Class::Gpebo => plant.xi.iter().chain(plant.psi.iter().flatten()).copied().collect(),
    };
    let without_inputs = [extension, outputs(plant)].concat();
    let with_inputs = [without_inputs.clone(), plant.u.clone()].concat();
    confined(plant, claim, Code::RegressionUndecided, found, |regression| {
        vec![
            ("phi_0", regression.phi_0.clone(), with_inputs.clone()),
            ("phi_1", regression.phi_1.concat(), with_inputs.clone()),
            ("primitive_0", regression.primitive_0.clone(), without_inputs.clone()),
            ("primitive_1", regression.primitive_1.concat(), without_inputs.clone()),
            ("eta", regression.eta.clone(), plant.theta.clone()),
            ("theta", regression.theta.clone(), regression.eta_symbols.clone()),
        ]
    })
}

fn outputs(plant: &Plant) -> Vec<Symbol> {
    plant.y.iter().map(|output| output.symbol).collect()
}

/// The claim, or an undecided one if a function of its result holds more than its arguments.
fn confined<T>(
    plant: &Plant,
    claim: Claim<T>,
    code: Code,
    found: &mut Vec<Diagnostic>,
    functions: impl Fn(&T) -> Vec<Function>,
) -> Claim<T> {
    let proved = claim.result.as_ref().filter(|_| claim.verdict == Verdict::Proved);
    let parameters: Vec<Symbol> = plant.parameters.iter().map(|parameter| parameter.symbol).collect();
    let stray = proved.into_iter().flat_map(functions).find_map(|(name, entries, known)| {
        let known: BTreeSet<Symbol> = known.into_iter().chain(parameters.iter().copied()).collect();
        let stray = plant.arena.symbols_of(&entries).into_iter().find(|symbol| !known.contains(symbol))?;
        Some((name, stray))
    });
    let Some((name, stray)) = stray else { return claim };
    let span = plant.phi.first().map_or(Span::point(0), |phi| phi.span);
    let message =
        format!("{name} was derived as a function of `{}`, which is not among its arguments", plant.arena.name(stray));
    found.push(
        Diagnostic::error(code, span, message)
            .note("the model may be right: this is a defect of pebo-gen")
            .help("report the defect together with the model"),
    );
    Claim { verdict: Verdict::Undecided, result: None }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::analysis::Derivation;
    use crate::model::Model;
    use crate::source::Source;

    /// Puts an expression into one of the formulas.
    type Set = fn(&mut Regression, Expr);

    const PLANT: &str = "model: m\nparameters: {k: 2}\nx: [x]\ny: [y]\nu: [u]\nw: [w]\nf_x: {x: u}\n\
        f_y: {y: k*x}\nphi: [x]\nangles: {x: 2*pi}\n";

    fn plant() -> Plant {
        Plant::resolve(&Model::parse(&Source::new("m", PLANT).unwrap()).unwrap()).unwrap()
    }

    /// The function that the check names in a claim whose result was changed.
    fn stopped<T: Clone>(
        claim: &Claim<T>,
        change: impl Fn(&mut T),
        gate: impl Fn(Claim<T>, &mut Vec<Diagnostic>) -> Claim<T>,
    ) -> Option<String> {
        let (mut found, mut changed) = (Vec::new(), claim.clone());
        change(changed.result.as_mut().unwrap());
        let answer = gate(changed, &mut found);
        assert_eq!(answer.verdict == Verdict::Proved, found.is_empty());
        assert_eq!(answer.result.is_some(), found.is_empty());
        found.first().map(|diagnostic| diagnostic.message.split(' ').next().unwrap().to_owned())
    }

    #[test]
    fn every_function_holds_what_it_knows_and_nothing_else() {
        let plant = plant();
        let derivation = Derivation::derive(&plant);
        let arena = &plant.arena;
        let of = |symbols: &[Symbol]| symbols.iter().map(|s| arena.of_symbol(*s)).collect::<Vec<_>>();
        let (x, y, k) = (arena.variable("x"), arena.variable("y"), arena.variable("k"));
        let (u, w, ghost) = (of(&plant.u)[0], of(&plant.w)[0], arena.variable("ghost"));
        let (z, chi, theta, eta) = (of(&plant.z)[0], of(&plant.chi)[0], of(&plant.theta)[0], of(&plant.eta(1))[0]);
        let (xi, psi) = (of(&plant.xi)[0], of(&plant.psi[0])[0]);
        let all = [x, y, k, u, w, ghost, z, chi, theta, eta, xi, psi];

        let check = |name: &str, knows: &[Expr], stop: &dyn Fn(Expr) -> Option<String>| {
            for expr in all {
                let expected = (!knows.contains(&expr)).then(|| name.to_owned());
                assert_eq!(stop(expr), expected, "{name} with {}", arena.print(expr));
            }
        };
        let h = |e: Expr| stopped(&derivation.cascade, |c| c.h[0] = e, |claim, found| cascade(&plant, claim, found));
        check("h", &[y, u, k], &h);
        let lambda = |e: Expr| {
            let change = |c: &mut Cascade| c.lambda = Some(vec![vec![e]]);
            stopped(&derivation.cascade, change, |claim, found| cascade(&plant, claim, found))
        };
        check("Lambda", &[y, u, k], &lambda);
        let inverse = |change: &dyn Fn(&mut LeftInverse)| {
            stopped(&derivation.left_inverse, change, |claim, found| left_inverse(&plant, claim, found))
        };
        check("phi_left", &[z, y, k], &|e| inverse(&|l| l.x[0].1 = e));
        check("a", &[k], &|e| inverse(&|l| l.modulo[0].1 = e));
        let entries: [(&str, Set, &[Expr], &[Expr]); 4] = [
            ("phi_0", |r, e| r.phi_0[0] = e, &[chi, y, u, k], &[xi, psi, y, u, k]),
            ("phi_1", |r, e| r.phi_1[0][0] = e, &[chi, y, u, k], &[xi, psi, y, u, k]),
            ("primitive_0", |r, e| r.primitive_0 = vec![e], &[chi, y, k], &[xi, psi, y, k]),
            ("primitive_1", |r, e| r.primitive_1 = vec![vec![e]], &[chi, y, k], &[xi, psi, y, k]),
        ];
        for (name, set, plain, generalised) in entries {
            // The functions of the extension before it hold nothing of the other class's.
            let blank = |r: &mut Regression, e: Expr| {
                (r.phi_0, r.phi_1) = (vec![k], vec![vec![k]]);
                set(r, e);
            };
            for (class, knows) in [(Class::Pebo, plain), (Class::Gpebo, generalised)] {
                let stop = |e: Expr| {
                    let gate = |claim, found: &mut Vec<_>| regression(&plant, class, claim, found);
                    stopped(&derivation.regression, |r| blank(r, e), gate)
                };
                check(name, knows, &stop);
            }
        }
        let unknowns = |change: &dyn Fn(&mut Regression)| {
            stopped(&derivation.regression, change, |claim, found| regression(&plant, Class::Pebo, claim, found))
        };
        check("eta", &[theta, k], &|e| unknowns(&|r| r.eta[0] = e));
        check("theta", &[eta, k], &|e| unknowns(&|r| r.theta[0] = e));
    }
}

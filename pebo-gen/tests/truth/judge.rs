//! Compares derivations with the plant's own formulas at points of its domain.
//!
//! Every claim of an accepted model is evaluated in floating point where the model's own formulas have values and
//! derivatives and no listed condition fails. A formula that has no finite value there, or another one than the claim
//! says, is a complaint.

use pebo_gen::Derived;
use pebo_gen::analysis::{Outcome, Regression};
use serde_json::Value as Json;

use super::draw::Draw;
use super::formula::{Comparison, Evaluation, Formula, Values};
use super::plant::Plant;

/// Points of a model that are looked at, of as many draws as it takes, up to the second number.
const POINTS: usize = 60;
const DRAWS: usize = 4000;

/// Relative to the largest absolute value met: rounding is about 1e-16 an operation, a wrong formula is off by far
/// more.
const TOLERANCE: f64 = 1e-8;

/// The formulas of a report.
struct Claims {
    h: Vec<Formula>,
    lambda: Option<Vec<Vec<Formula>>>,
    phi_left: Vec<(String, Formula)>,
    kind: String,
    /// The slopes are those at the estimate, in the place of the extension.
    is_monotone: bool,
    phi_0: Vec<Formula>,
    phi_1: Vec<Vec<Formula>>,
    primitive_0: Vec<Formula>,
    primitive_1: Vec<Vec<Formula>>,
    eta: Vec<Formula>,
    theta: Vec<Formula>,
    conditions: Vec<Comparison>,
}

impl Claims {
    fn read(report: &Json) -> Self {
        let list = |json: &Json| -> Vec<Formula> {
            json.as_array().into_iter().flatten().filter_map(Json::as_str).map(Formula::read).collect()
        };
        let rows = |json: &Json| -> Vec<Vec<Formula>> { json.as_array().into_iter().flatten().map(list).collect() };
        let regression = &report["regression"];
        let lambda = &report["cascade"]["lambda"];
        Self {
            h: list(&report["cascade"]["h"]),
            lambda: lambda.is_array().then(|| rows(lambda)),
            phi_left: report["left_inverse"]["x"]
                .as_object()
                .into_iter()
                .flatten()
                .filter_map(|(name, formula)| Some((name.clone(), Formula::read(formula.as_str()?))))
                .collect(),
            kind: regression["kind"].as_str().unwrap_or_default().to_owned(),
            is_monotone: regression["parameterisation"] == "monotone",
            phi_0: list(&regression["phi_0"]),
            phi_1: rows(&regression["phi_1"]),
            primitive_0: list(&regression["primitive_0"]),
            primitive_1: rows(&regression["primitive_1"]),
            eta: list(&regression["eta"]),
            theta: list(&regression["theta"]),
            conditions: report["conditions"]
                .as_array()
                .into_iter()
                .flatten()
                .filter_map(Json::as_str)
                .map(Comparison::read)
                .collect(),
        }
    }
}

/// Claims of an accepted model that its plant contradicts, and the number of points of the comparison.
pub(crate) fn complaints(plant: &Plant, derived: &Derived, report: &Json, seed: u64) -> (Vec<String>, usize) {
    if derived.derivation.outcome != Outcome::Accepted {
        return (outside(plant, report), 0);
    }
    let claims = Claims::read(report);
    let mut draw = Draw::new(seed);
    let mut found = Vec::new();
    let mut points = 0;
    let rows = derived.derivation.regression.result.as_ref().map_or(Vec::new(), Regression::rows);
    for _ in 0..DRAWS {
        let Some(values) = plant.point(&mut draw) else { continue };
        points += 1;
        if claims.conditions.iter().all(|condition| condition.holds(&values)) {
            let mut at = DomainPoint::new(plant, &claims, values);
            at.cascade();
            at.left_inverse();
            at.regression(&rows, &mut draw);
            found.append(&mut at.found);
        }
        if points == POINTS || !found.is_empty() {
            break;
        }
    }
    (found, points)
}

/// Witnesses of refutations that are not in the domain.
fn outside(plant: &Plant, report: &Json) -> Vec<String> {
    let mut found = Vec::new();
    for claim in ["cascade", "left_inverse", "regression"] {
        let witness = &report[claim]["witness"];
        for key in ["point", "other"] {
            let Some(point) = witness[key].as_object() else { continue };
            let values: Values = point
                .iter()
                .filter_map(|(name, value)| {
                    Some((name.clone(), (Formula::read(value.as_str()?).at(&Values::new()).value, 0.0)))
                })
                .collect();
            if !plant.admits(&values) {
                found.push(format!("the {claim} is refuted by a point outside the assumptions: {witness}"));
            }
        }
    }
    found
}

/// A value that does not move.
fn still(value: f64) -> Evaluation {
    Evaluation { value, slope: 0.0, size: value.abs() }
}

/// `first` and the sum of the products.
fn sum(terms: impl Iterator<Item = (Evaluation, Evaluation)>, first: Evaluation) -> Evaluation {
    terms.fold(first, |total, (a, b)| Evaluation {
        value: total.value + a.value * b.value,
        slope: total.slope + a.slope * b.value + a.value * b.slope,
        size: total.size.max(a.size * b.size.max(1.0)).max(b.size),
    })
}

fn all(formulas: &[Formula], values: &Values) -> Vec<Evaluation> {
    formulas.iter().map(|formula| formula.at(values)).collect()
}

/// A point of the domain at which the claims are looked at.
struct DomainPoint<'a> {
    plant: &'a Plant,
    claims: &'a Claims,
    values: Values,
    place: String,
    z: Vec<Evaluation>,
    h: Vec<Evaluation>,
    /// The largest absolute value met in the rates.
    moving: f64,
    lambda: Option<Vec<Vec<Evaluation>>>,
    found: Vec<String>,
}

impl<'a> DomainPoint<'a> {
    fn new(plant: &'a Plant, claims: &'a Claims, values: Values) -> Self {
        let place = values.iter().map(|(name, (value, _))| format!("{name} = {value}")).collect::<Vec<_>>().join(", ");
        Self {
            z: all(&plant.phi, &values),
            h: all(&claims.h, &values),
            moving: plant.rates.values().map(|rate| rate.at(&values).size).fold(0.0, f64::max),
            lambda: claims.lambda.as_ref().map(|rows| rows.iter().map(|row| all(row, &values)).collect()),
            plant,
            claims,
            values,
            place,
            found: Vec::new(),
        }
    }

    fn check(&mut self, what: &str, claimed: Evaluation, wanted: Evaluation) {
        let size = claimed.size.max(wanted.size).max(1.0);
        // Beyond this, digits are lost that the claim cannot be blamed for here.
        let told = wanted.value.is_finite() && (size < 1e10 || !size.is_finite());
        let close = (claimed.value - wanted.value).abs() <= TOLERANCE * size;
        if told && !close {
            self.found.push(format!("{what} is {}, not {}, at {}", claimed.value, wanted.value, self.place));
        }
    }

    fn cascade(&mut self) {
        for i in 0..self.z.len() {
            let component = self.z[i];
            // The rounding of the rates themselves: large terms may multiply an identity that is zero.
            let along = Evaluation { value: component.slope, slope: 0.0, size: component.size.max(self.moving) };
            let claimed = match &self.lambda {
                None => self.h[i],
                Some(lambda) => sum(lambda[i].iter().zip(&self.z).map(|(l, z)| (*l, still(z.value))), self.h[i]),
            };
            self.check(&format!("z{}'", i + 1), claimed, along);
        }
    }

    fn left_inverse(&mut self) {
        let mut at_z = self.values.clone();
        for (i, component) in self.z.iter().enumerate() {
            at_z.insert(format!("z{}", i + 1), (component.value, 0.0));
        }
        let claims = self.claims;
        for (state, formula) in &claims.phi_left {
            let mut claimed = formula.at(&at_z);
            let wanted = still(self.values[state].0);
            if let Some(period) = self.plant.periods.get(state) {
                let period = period.at(&self.values).value;
                claimed.value -= ((claimed.value - wanted.value) / period).round() * period;
            }
            // The inverse of a flat transform loses digits that are the transform's: the size of z tells how many.
            claimed.size = claimed.size.max(self.z.iter().fold(0.0, |size: f64, z| size.max(z.size)) * 1e2);
            self.check(&format!("phi_left of {state}"), claimed, wanted);
        }
    }

    /// Sets the extension to where it is for an unknown theta, with its rates.
    fn extend(&mut self, theta: &[f64], draw: &mut Draw) {
        let components = theta.len();
        let Some(lambda) = &self.lambda else {
            for (i, theta) in theta.iter().enumerate() {
                self.values.insert(format!("chi{}", i + 1), (self.z[i].value - theta, self.h[i].value));
            }
            return;
        };
        let psi: Vec<Vec<f64>> = (0..components).map(|_| (0..components).map(|_| draw.value()).collect()).collect();
        let product = |row: &[f64]| row.iter().zip(theta).map(|(psi, theta)| psi * theta).sum::<f64>();
        let xi: Vec<f64> = psi.iter().zip(&self.z).map(|(row, z)| z.value - product(row)).collect();
        for (i, row) in lambda.iter().enumerate() {
            for (j, entry) in psi[i].iter().enumerate() {
                let rate = row.iter().zip(&psi).map(|(l, psi)| l.value * psi[j]).sum();
                self.values.insert(format!("Psi{}{}", i + 1, j + 1), (*entry, rate));
            }
            let rate = self.h[i].value + row.iter().zip(&xi).map(|(l, xi)| l.value * xi).sum::<f64>();
            self.values.insert(format!("xi{}", i + 1), (xi[i], rate));
        }
    }

    /// The regression and the way back to theta, with an extension anywhere.
    fn regression(&mut self, rows: &[usize], draw: &mut Draw) {
        let claims = self.claims;
        let mut theta: Vec<f64> = self.z.iter().map(|_| draw.value()).collect();
        if claims.is_monotone {
            self.monotone(&theta, draw);
            theta.fill(0.0);
        }
        self.extend(&theta, draw);
        let mut at_theta = self.values.clone();
        at_theta.extend((1..).zip(&theta).map(|(i, theta)| (format!("theta{i}"), (*theta, 0.0))));
        // Functions of theta are constants: the slopes of other symbols in them do not count.
        let eta: Vec<Evaluation> = claims.eta.iter().map(|eta| still(eta.at(&at_theta).value)).collect();
        for (row, (known, factors)) in claims.phi_0.iter().zip(&claims.phi_1).enumerate() {
            let (known, factors) = (known.at(&self.values), all(factors, &self.values));
            let right = |first: Evaluation| sum(factors.iter().copied().zip(eta.iter().copied()), first);
            let what = format!("row {} of the regression", row + 1);
            match claims.kind.as_str() {
                "static" => self.check(&what, right(still(0.0)), known),
                "dynamic" => {
                    let rate = self.values[&self.plant.y[rows[row]]].1;
                    self.check(&what, right(known), Evaluation { value: rate, slope: 0.0, size: known.size });
                }
                _ => {
                    let held = claims.primitive_1.get(row).map_or_else(Vec::new, |held| all(held, &self.values));
                    let first = claims.primitive_0[row].at(&self.values);
                    let held = sum(held.into_iter().zip(eta.iter().copied()), first);
                    self.check(&what, right(known), Evaluation { value: held.slope, ..held });
                }
            }
        }
        // theta from its functions, up to whole turns.
        at_theta.extend((1..).zip(&eta).map(|(i, eta)| (format!("eta{i}"), (eta.value, 0.0))));
        for (i, formula) in claims.theta.iter().enumerate() {
            let mut claimed = formula.at(&at_theta);
            let turn = std::f64::consts::TAU;
            claimed.value -= ((claimed.value - theta[i]) / turn).round() * turn;
            claimed.size = eta.iter().fold(claimed.size, |size, eta| size.max(eta.size)) * 1e2;
            self.check(&format!("theta{}", i + 1), claimed, still(theta[i]));
        }
        self.anywhere(draw);
    }

    /// The error of each equation at an estimate has the sign of its slope there times the error of the estimate: from all
    /// of these a step along the gradient goes towards z.
    fn monotone(&mut self, theta: &[f64], draw: &mut Draw) {
        let claims = self.claims;
        self.extend(&vec![0.0; theta.len()], draw);
        let at_z: Vec<f64> = claims.phi_0.iter().map(|known| known.at(&self.values).value).collect();
        self.extend(theta, draw);
        for (row, (known, factors)) in claims.phi_0.iter().zip(&claims.phi_1).enumerate() {
            let error = at_z[row] - known.at(&self.values).value;
            let along: f64 =
                all(factors, &self.values).iter().zip(theta).map(|(slope, theta)| slope.value * theta).sum();
            // Of a static equation the known side is on the left.
            let error = if claims.kind == "static" { -error } else { error };
            // Rounded to zero either may have any sign.
            if error * along < -TOLERANCE * error.abs().max(along.abs()) {
                self.found.push(format!("row {} is not monotone: {error}, {along}; {}", row + 1, self.place));
            }
        }
    }

    /// An extension may have run anywhere: the regression has a value all the same.
    fn anywhere(&mut self, draw: &mut Draw) {
        let claims = self.claims;
        for name in (1..=self.z.len()).flat_map(|i| [format!("chi{i}"), format!("xi{i}")]) {
            self.values.entry(name).and_modify(|entry| entry.0 = 5.0 * draw.value());
        }
        let formulas = claims.phi_0.iter().chain(claims.phi_1.iter().flatten());
        for formula in formulas.chain(&claims.primitive_0).chain(claims.primitive_1.iter().flatten()) {
            let value = formula.at(&self.values);
            if !value.value.is_finite() && (value.size < 1e10 || value.size.is_nan()) {
                let extension =
                    self.values.iter().filter(|(name, _)| name.starts_with("chi") || name.starts_with("xi"));
                let extension: Vec<String> = extension.map(|(name, v)| format!("{name} = {}", v.0)).collect();
                self.found.push(format!("the regression has no value at {}; {}", extension.join(", "), self.place));
            }
        }
    }
}

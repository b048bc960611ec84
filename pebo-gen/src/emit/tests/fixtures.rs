//! Plants and derivations written by hand, as the analysis would find them.

use std::collections::BTreeMap;

use crate::emit::read_back::value::{Scope, Value, expression};
use pebo_cas::{Arena, Expr, Rational, Relation, Symbol};
use pebo_design::analysis::{
    Cascade, Claim, Class, Derivation, Excitation, Identifiability, LeftInverse, Origin, Outcome, Regression,
    RegressionKind, Remarks, Verdict,
};
use pebo_design::plant::{Assumption, Formula, Output, Parameter, Plant, Proposal, State};
use pebo_design::source::Span;

/// A plant and its derivation as text. Formulas are in Rust's grammar, with floating-point numbers
/// and `Real::sin(x)`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sketch {
    pub(crate) name: &'static str,
    pub(crate) title: &'static str,
    pub(crate) parameters: &'static [(&'static str, &'static str)],
    pub(crate) x: &'static [(&'static str, &'static str)],
    pub(crate) y: &'static [(&'static str, &'static str)],
    pub(crate) u: &'static [&'static str],
    /// Expressions greater than zero.
    pub(crate) assume: &'static [&'static str],
    pub(crate) phi: &'static [&'static str],
    pub(crate) h: &'static [&'static str],
    pub(crate) lambda: Option<&'static [&'static [&'static str]]>,
    pub(crate) kind: RegressionKind,
    pub(crate) phi_0: &'static [&'static str],
    pub(crate) phi_1: &'static [&'static [&'static str]],
    /// In theta1..
    pub(crate) eta: &'static [&'static str],
    pub(crate) phi_left: &'static [(&'static str, &'static str)],
    pub(crate) singular_where: &'static [&'static str],
}

pub(crate) const CUK: Sketch = Sketch {
    name: "cuk",
    title: "DC-DC Cuk converter, inductor currents from capacitor voltages",
    parameters: &[("L1", "10e-3"), ("C2", "22e-6"), ("L3", "10e-3"), ("C4", "22.9e-6"), ("G", "0.0447"), ("E", "12")],
    x: &[("i1", "(E - (1.0 - d)*v2)/L1"), ("i3", "-(d*v2 + v4)/L3")],
    y: &[("v2", "((1.0 - d)*i1 + d*i3)/C2"), ("v4", "(i3 - G*v4)/C4")],
    u: &["d"],
    assume: &["L1", "C2", "L3", "C4", "d", "1.0 - d"],
    phi: &["i1", "i3"],
    h: &["(E - (1.0 - d)*v2)/L1", "-(d*v2 + v4)/L3"],
    lambda: None,
    kind: RegressionKind::Dynamic,
    phi_0: &["((1.0 - d)*chi1 + d*chi2)/C2", "(chi2 - G*v4)/C4"],
    phi_1: &[&["(1.0 - d)/C2", "d/C2"], &["0.0", "1.0/C4"]],
    eta: &["theta1", "theta2"],
    phi_left: &[("i1", "z1"), ("i3", "z2")],
    singular_where: &["d = 1"],
};

pub(crate) const CUK_CASE2: Sketch = Sketch {
    name: "cuk_case2",
    title: "DC-DC Cuk converter, input current and output voltage from the other two",
    x: &[("i1", "(E - (1.0 - d)*v2)/L1"), ("v4", "(i3 - G*v4)/C4")],
    y: &[("v2", "((1.0 - d)*i1 + d*i3)/C2"), ("i3", "-(d*v2 + v4)/L3")],
    phi: &["i1", "v4 - (G*L3/C4)*i3"],
    h: &["(E - (1.0 - d)*v2)/L1", "i3/C4 + (G/C4)*d*v2"],
    phi_0: &["((1.0 - d)*chi1 + d*i3)/C2", "-(d*v2 + chi2)/L3 - (G/C4)*i3"],
    phi_1: &[&["(1.0 - d)/C2", "0.0"], &["0.0", "-1.0/L3"]],
    phi_left: &[("i1", "z1"), ("v4", "z2 + (G*L3/C4)*i3")],
    ..CUK
};

pub(crate) const PMSM: Sketch = Sketch {
    name: "pmsm",
    title: "Permanent-magnet motor: rotor position from currents",
    parameters: &[("R", "0.3"), ("L", "1/3000"), ("lambda_m", "0.0123456789"), ("n_p", "4")],
    x: &[("q", "w")],
    y: &[("i_a", ""), ("i_b", "")],
    u: &["u_a", "u_b"],
    assume: &["L", "lambda_m"],
    phi: &["L*i_a + lambda_m*Real::cos(n_p*q)", "L*i_b + lambda_m*Real::sin(n_p*q)"],
    h: &["u_a - R*i_a", "u_b - R*i_b"],
    lambda: None,
    kind: RegressionKind::Static,
    phi_0: &["(chi1 - L*i_a)*(chi1 - L*i_a) + (chi2 - L*i_b)*(chi2 - L*i_b)"],
    phi_1: &[&["-2.0*(chi1 - L*i_a)", "-2.0*(chi2 - L*i_b)", "1.0"]],
    eta: &["theta1", "theta2", "lambda_m*lambda_m - theta1*theta1 - theta2*theta2"],
    phi_left: &[("q", "Real::atan2(z2 - L*i_b, z1 - L*i_a)/n_p")],
    singular_where: &[],
};

pub(crate) const PENDULUM: Sketch = Sketch {
    name: "cart_pendulum",
    title: "Cart with pendulum, momenta from positions",
    parameters: &[("m", ""), ("M", ""), ("ell", ""), ("g", "")],
    x: &[("p1", "g*Real::sin(q2)"), ("p2", "u1")],
    y: &[("q1", "(p1 - Real::cos(q2)*p2)/Real::sqrt(m - Real::cos(q2)*Real::cos(q2))"), ("q2", "p2/(m + M)")],
    u: &["u1"],
    assume: &["m - 1.0"],
    phi: &["p1", "p2"],
    h: &[
        "2.0*Real::sqrt(2.0)*g*Real::sin(q2)/(3.0*ell)/Real::sqrt(m - Real::cos(q2)*Real::cos(q2))",
        "-Real::cos(q2)*u1/Real::sqrt(m - Real::cos(q2)*Real::cos(q2)) - M/(m + M)/3.0*q1",
    ],
    lambda: Some(&[&["-g/ell", "Real::sin(q2)*Real::exp(-q1*q1)"], &["0.0", "-u1/7.0"]]),
    kind: RegressionKind::Dynamic,
    phi_0: &["(xi1 - Real::cos(q2)*xi2)/Real::sqrt(m - Real::cos(q2)*Real::cos(q2))", "xi2/(m + M)"],
    phi_1: &[
        &[
            "(Psi11 - Real::cos(q2)*Psi21)/Real::sqrt(m - Real::cos(q2)*Real::cos(q2))",
            "(Psi12 - Real::cos(q2)*Psi22)/Real::sqrt(m - Real::cos(q2)*Real::cos(q2))",
        ],
        &["Psi21/(m + M)", "Psi22/(m + M)"],
    ],
    eta: &["theta1", "theta2"],
    phi_left: &[("p1", "z1"), ("p2", "z2")],
    singular_where: &[],
};

/// A formula; names that rustc takes for something else have to be built by hand.
pub(crate) fn formula(arena: &Arena, text: &str) -> Expr {
    let syntax: syn::Expr = syn::parse_str(text).unwrap_or_else(|error| panic!("{text}: {error}"));
    let mut scope = Scope::default();
    let separators = |c: char| !(c.is_alphanumeric() || c == '_');
    for name in text.split(separators).filter(|name| name.starts_with(char::is_alphabetic)) {
        scope.declare(name, Value::Scalar(arena.variable(name)));
    }
    match expression(arena, &syntax, &scope) {
        Ok(Value::Scalar(value)) => value,
        other => panic!("{text}: {other:?}"),
    }
}

impl Sketch {
    /// The plant and its derivation, with every claim called proved.
    pub(crate) fn build(&self) -> (Plant, Derivation) {
        let arena = Arena::new();
        let span = Span::default();
        let at = |text: &str| Formula { expr: formula(&arena, text), span };
        let count = self.phi.len();
        let indexed =
            |stem: &str| -> Vec<Symbol> { (1..=count).map(|index| arena.symbol(&format!("{stem}{index}"))).collect() };
        let value = |text: &str| match text.split_once('/') {
            None => Rational::from_decimal(text).ok(),
            Some((n, d)) => Rational::from_decimal(n).ok().zip(Rational::from_decimal(d).ok()).map(|(n, d)| &n / &d),
        };
        let formulas = |texts: &[&str]| -> Vec<Expr> { texts.iter().map(|text| formula(&arena, text)).collect() };
        let rows = |rows: &[&[&str]]| -> Vec<Vec<Expr>> { rows.iter().map(|row| formulas(row)).collect() };
        let eta: Vec<Symbol> = (1..=self.eta.len()).map(|index| arena.symbol(&format!("eta{index}"))).collect();
        let derivation = Derivation {
            conditions: Vec::new(),
            outcome: Outcome::Accepted,
            class: if self.lambda.is_some() { Class::Gpebo } else { Class::Pebo },
            cascade: proved(Cascade { h: formulas(self.h), lambda: self.lambda.map(rows), ..Cascade::default() }),
            left_inverse: proved(LeftInverse {
                x: self.phi_left.iter().map(|(x, text)| (arena.symbol(x), formula(&arena, text))).collect(),
                modulo: Vec::new(),
                origin: Origin::Derived,
                witness: None,
            }),
            regression: proved(Regression {
                at_estimate: None,
                kind: self.kind,
                sources: (0..self.phi_0.len()).map(|row| vec![row]).collect(),
                phi_0: formulas(self.phi_0),
                primitive_0: Vec::new(),
                primitive_1: Vec::new(),
                phi_1: rows(self.phi_1),
                eta: formulas(self.eta),
                theta: eta[..count].iter().map(|&eta| arena.of_symbol(eta)).collect(),
                eta_symbols: eta,
                steps: Vec::new(),
                alternative: None,
                unused: Vec::new(),
            }),
            identifiability: proved(Identifiability {
                singular_where: self.singular_where.iter().map(|&text| text.to_owned()).collect(),
                everywhere_else: true,
                ..Identifiability::new(Excitation::Instant)
            }),
            diagnostics: Vec::new(),
            remarks: Remarks::default(),
        };
        let output = |(y, rate): &(&str, &str)| {
            let rate = (!rate.is_empty()).then(|| at(rate));
            Output { symbol: arena.symbol(y), rate, value: None, span }
        };
        let plant = Plant {
            origin: pebo_design::plant::TransformOrigin::Given,
            noisier: None,
            start: BTreeMap::new(),
            class: None,
            cascade_class: None,
            relation_form: None,
            local_regression: None,
            monotone_regression: false,
            proposal: Proposal::default(),
            terms: BTreeMap::new(),
            conditions: Vec::new(),
            name: self.name.to_owned(),
            title: Some(self.title.to_owned()),
            reference: Some("Ortega et al. 2015, Section 5".to_owned()),
            parameters: self
                .parameters
                .iter()
                .map(|(name, text)| Parameter { symbol: arena.symbol(name), value: value(text), text: None, span })
                .collect(),
            x: self.x.iter().map(|(x, rate)| State { symbol: arena.symbol(x), rate: at(rate) }).collect(),
            y: self.y.iter().map(output).collect(),
            u: self.u.iter().map(|u| arena.symbol(u)).collect(),
            time: None,
            w: Vec::new(),
            phi: self.phi.iter().map(|text| at(text)).collect(),
            phi_left: None,
            identities: Vec::new(),
            known: Vec::new(),
            angles: Vec::new(),
            units: BTreeMap::new(),
            assumptions: self
                .assume
                .iter()
                .map(|text| Assumption { expr: formula(&arena, text), relation: Relation::Positive, span })
                .collect(),
            z: indexed("z"),
            chi: indexed("chi"),
            xi: indexed("xi"),
            psi: (1..=count).map(|row| indexed(&format!("Psi{row}"))).collect(),
            theta: indexed("theta"),
            eta: "eta".to_owned(),
            arena: arena.into(),
        };
        (plant, derivation)
    }
}

fn proved<T>(result: T) -> Claim<T> {
    Claim { verdict: Verdict::Proved, result: Some(result) }
}

/// Stands in for the zero test: the value at several points, against the size of its terms.
pub(crate) fn vanishes(arena: &Arena, expr: Expr) -> bool {
    let symbols: Vec<Symbol> = arena.symbols_of(&[expr]).into_iter().collect();
    (1..=5).all(|point| {
        let number = |index: usize| {
            let seed = i64::try_from(index * 37 + point * 101).unwrap_or(0);
            arena.number(Rational::new(seed % 89 + 100, 61).unwrap_or(Rational::ONE))
        };
        let values: BTreeMap<Symbol, Expr> =
            symbols.iter().enumerate().map(|(index, &symbol)| (symbol, number(index))).collect();
        let value = arena.substitute(expr, &values);
        let program = pebo_design::program::lower(arena, &[], &[value]).expect("no symbol is left");
        let mut result = [0.0];
        pebo_design::program::Interpreter::new(&program).run(&[], &mut result);
        result[0].abs() < 1e-9
    })
}

//! Emitted functions of plants whose names were once taken for the generator's own.

use std::collections::BTreeSet;

use crate::emit::Scalar;
use crate::emit::names::TYPES;
use crate::{Derived, derive};
use pebo_design::program::{Interpreter, lower};
use pebo_design::source::Source;

fn derived(text: &str) -> Derived {
    let derived = derive(&Source::new("m", text).expect("a text")).expect("a model");
    assert!(derived.derivation.admit().is_ok(), "{:?}", derived.derivation.diagnostics);
    derived
}

/// An efficiency is called `eta1` where the first unknown would be.
#[test]
fn the_estimate_is_no_parameter_of_its_name() {
    let motor = derived(
        "model: m\nparameters: {eta1: 3, l: 0.5}\nx: [p]\ny: [q]\nu: [v]\nf_x: {p: v - eta1*l*sin(q)}\n\
         f_y: {q: p/(eta1*l^2)}\nphi: [p]\n",
    );
    let regression = motor.derivation.regression.result.as_ref().expect("a regression");
    let arena = &motor.plant.arena;
    assert!(!regression.eta_symbols.contains(&motor.plant.parameters[0].symbol));
    let program = lower(arena, &regression.eta_symbols, &regression.theta).expect("of the unknowns alone");
    let mut theta = [0.0];
    Interpreter::new(&program).run(&[7.0], &mut theta);
    // The identity: no rounding.
    assert!((theta[0] - 7.0).abs() < f64::EPSILON, "{theta:?}");
    let text = motor.emit(Scalar::F64).expect("emitted").text;
    let (_, function) = text.split_once("fn theta(").expect("the function");
    assert!(function.split_once("\n    }").expect("its end").0.contains("*eta"), "{function}");
}

/// With eleven components, row 1 column 11 and row 11 column 1 are two entries of the fundamental matrix.
#[test]
fn each_entry_of_a_wide_fundamental_matrix_is_read_where_it_stands() {
    const COMPONENTS: usize = 11;
    let each = |entry: &dyn Fn(usize) -> String| (1..=COMPONENTS).map(entry).collect::<Vec<_>>().join(", ");
    let wide = derived(&format!(
        "model: m\nparameters: {{a: 1}}\nx: [{p}]\ny: [{q}]\nu: [v]\nf_x: {{{f_x}}}\nf_y: {{{f_y}}}\nphi: [{p}]\n",
        p = each(&|i| format!("p{i}")),
        q = each(&|i| format!("q{i}")),
        f_x = each(&|i| format!("p{i}: -(a + q{i}^2)*p{i} + v + p{}", i % COMPONENTS + 1)),
        f_y = each(&|i| format!("q{i}: p{i}")),
    ));
    let (plant, arena) = (&wide.plant, &wide.plant.arena);
    let regression = wide.derivation.regression.result.as_ref().expect("a regression");
    let program = lower(arena, &plant.psi.concat(), &regression.phi_1.concat()).expect("of the matrix alone");
    let psi: Vec<f64> =
        (0..COMPONENTS * COMPONENTS).map(|place| f64::from(u32::try_from(place).expect("small"))).collect();
    let mut phi_1 = vec![0.0; psi.len()];
    Interpreter::new(&program).run(&psi, &mut phi_1);
    // y = x = xi + Psi theta: the regressor is the matrix, entry by entry.
    assert_eq!(phi_1, psi);
    // Read back and compared entry by entry, or not emitted.
    let text = wide.emit(Scalar::F64).expect("emitted").text;
    assert!(text.contains("psi1_11") && text.contains("psi11_1") && !text.contains("psi111"));
}

/// Every name in capitals that an emitted module uses is one that the model's type does not take.
#[test]
fn the_type_is_named_like_nothing_that_the_module_uses() {
    let settings = [
        "estimator: least-squares, covariance: 10, filter: 4, bounds: {lower: -5, upper: 5}",
        "estimator: finite-time-drem, gain: 4, regressor_gain: 2, clip: 0.1, filter: 3",
        "estimator: gradient, gain: 10, filter: 4, limits: {q: [-9, 9]}, within: {lower: -2, upper: 2}",
        "sensors: {q: 0.1}, start: {p: 1}, gate: 25",
    ];
    for settings in settings {
        let text = format!(
            "model: gate\nparameters: {{k: 3}}\nx: [p]\ny: [q]\nu: [v]\nf_x: {{p: k*v - sqrt(q)}}\nf_y: {{q: p*sin(q)}}\n\
             assume: [q > 0]\nphi: [p]\nobserver: {{{settings}}}\nsimulation: {{duration: 1, step: 0.01, control: {{v: 1}}, \
             initial: {{p: 1, q: 1}}}}\n"
        );
        let text = derived(&text).emit(Scalar::F32).expect("emitted").text;
        let code: proc_macro2::TokenStream = text.parse().expect("tokens");
        let used = capitalised(code);
        assert!(used.contains("GatePlant") && used.len() > 10, "{used:?}");
        let taken = |name: &String| TYPES.contains(&name.as_str()) || *name == "GatePlant" || name.starts_with("RATIO");
        let others: Vec<&String> = used.iter().filter(|name| !taken(name)).collect();
        assert!(others.is_empty(), "{settings}: {others:?}");
    }
}

/// The identifiers that start with a capital, except for those of attributes, of other types and of other modules.
fn capitalised(code: proc_macro2::TokenStream) -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    let mut before = String::new();
    for token in code {
        match &token {
            proc_macro2::TokenTree::Ident(ident) => {
                let is_own = |name: &String| name.starts_with(char::is_uppercase) && before != ":";
                found.extend(Some(ident.to_string()).filter(is_own));
            }
            proc_macro2::TokenTree::Group(group) if before != "#" && before != "!" => {
                found.extend(capitalised(group.stream()));
            }
            _ => {}
        }
        before = token.to_string();
    }
    found
}

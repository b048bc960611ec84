//! Emissions and refusals.

mod constructors;

mod accuracy;
pub(crate) mod fixtures;
#[cfg(feature = "yaml")]
mod names;

use fixtures::{CUK, CUK_CASE2, PENDULUM, PMSM, Sketch, vanishes};

use super::*;
use pebo_cas::Node;
use pebo_design::analysis::Outcome;

fn emitted(sketch: Sketch) -> String {
    emitted_as(sketch, Scalar::F64)
}

fn emitted_as(sketch: Sketch, scalar: Scalar) -> String {
    let (plant, derivation) = sketch.build();
    emit(&plant, &derivation, None, scalar, vanishes).unwrap().text
}

/// The code of one function, without its documentation.
fn function(text: &str, name: &str) -> String {
    let start = text.find(&format!("fn {name}(")).unwrap();
    let length = text[start..].find("\n    }").unwrap();
    text[start..start + length].to_owned()
}

/// One line of `phi_0`, for a formula in v2, v4, d, chi1, chi2 and the parameters.
fn line(formula: &'static str) -> String {
    let row: &'static [&'static str] = Box::leak(Box::new([formula, "0.0"]));
    let (plant, derivation) = Sketch { phi_0: row, ..CUK }.build();
    let text = emit(&plant, &derivation, None, Scalar::F64, vanishes).unwrap().text;
    let code = function(&text, "regression");
    let (_, rest) = code.split_once("known: SVector::from([").unwrap();
    let (known, _) = rest.split_once("]),").unwrap();
    known.trim().trim_end_matches(", 0.0").to_owned()
}

#[test]
fn every_fixture_is_emitted_for_both_scalars() {
    for sketch in [CUK, CUK_CASE2, PMSM, PENDULUM] {
        for scalar in [Scalar::F32, Scalar::F64] {
            let text = emitted_as(sketch, scalar);
            assert!(text.lines().all(|line| line.chars().count() <= 100 || line.starts_with("//!")));
            assert_eq!(text, emitted_as(sketch, scalar), "deterministic");
        }
    }
}

#[test]
fn parentheses_keep_the_value() {
    assert_eq!(line("(-chi1)*(-chi1)"), "chi1 * chi1");
    assert_eq!(line("chi1/(chi2*d)"), "chi1 / (d * chi2)");
    assert_eq!(line("v2/(v4*d)"), "terms.v2_over_v4 / d");
    assert_eq!(line("-(v2 + v4)*d"), "-(d * (v2 + v4))");
    assert_eq!(line("v2 - (v4 - d)"), "d + v2 - v4");
    assert_eq!(line("chi1/chi2 - d"), "chi1 / chi2 - d");
    assert_eq!(line("2.0 - d"), "2.0 - d");
    assert_eq!(line("d - 2.0"), "d - 2.0");
    assert_eq!(line("d + 2.0"), "d + 2.0");
    assert_eq!(line("(v2 - chi1)*(v2 + chi1)"), "(v2 - chi1) * (v2 + chi1)");
    assert_eq!(line("1.0/(1.0/chi1 + chi2)"), "1.0 / (chi2 + 1.0 / chi1)");
}

#[test]
fn powers_are_products_and_reciprocals_divisions() {
    let text = line("v2*v2*v2 + 1.0/d/d");
    assert!(!text.contains("pow"), "{text}");
    assert_eq!(text, "v2 * v2 * v2 + 1.0 / (d * d)");
    let all = emitted(Sketch { phi_0: &["v2*v2*v2*Real::sqrt(d)*d/v4", "1.0/v2/v2/v2"], ..CUK });
    assert!(!all.contains("::pow") && !all.contains("mul_add") && !all.contains("unsafe"), "{all}");
}

#[test]
fn a_parameter_named_e_is_a_parameter() {
    let text = emitted(CUK);
    assert!(text.contains("/// `E`, 12 in the model.\n    pub e: f64,"), "{text}");
    assert!(text.contains("e: 12.0,"), "{text}");
    assert!(!text.contains("exp") && !text.contains("consts::E"));
}

#[test]
fn names_that_differ_only_in_case_stay_apart() {
    let sketch = Sketch {
        parameters: &[("V", "3"), ("v", "5")],
        phi_0: &["V*chi1 - v*chi2", "V/v*D"],
        y: &[("v2", "0.0"), ("D", "0.0")],
        x: &[("i1", "0.0"), ("i3", "0.0")],
        h: &["0.0", "D"],
        phi_1: &[&["d", "D"], &["0.0", "V"]],
        assume: &[],
        ..CUK
    };
    let text = emitted(sketch);
    // The one that is written as Rust writes names keeps its own, whichever is declared first.
    for (name, value, field) in [("V", 3, "v_2"), ("v", 5, "v")] {
        assert!(text.contains(&format!("/// `{name}`, {value} in the model.\n    pub {field}: f64,")), "{text}");
    }
    assert!(text.contains("/// `D`.\n    pub d: f64,") && text.contains("/// `d`.\n    pub d: f64,"), "{text}");
    assert!(function(&text, "regression").contains("let [[d]] = u.data.0;"), "{text}");
}

#[test]
fn keywords_are_no_names() {
    let (mut plant, mut derivation) = CUK.build();
    let arena = &plant.arena;
    let (type_, gen_) = (arena.variable("type"), arena.variable("gen"));
    let (own, y) = (arena.symbol("self"), arena.symbol("y"));
    plant.parameters[0].symbol = arena.symbol("type");
    plant.parameters[1].symbol = arena.symbol("gen");
    plant.y[0].symbol = own;
    plant.y[1].symbol = y;
    derivation.cascade.result.as_mut().unwrap().h =
        vec![arena.div(arena.of_symbol(own), type_), arena.mul(arena.of_symbol(y), gen_)];
    let regression = derivation.regression.result.as_mut().unwrap();
    regression.phi_0 = vec![arena.of_symbol(own), arena.zero()];
    regression.phi_1 = vec![vec![arena.one(), arena.zero()], vec![arena.zero(), arena.one()]];
    let text = emit(&plant, &derivation, None, Scalar::F64, vanishes).unwrap().text;
    assert!(text.contains("pub type_: f64") && text.contains("pub gen_: f64"), "{text}");
    assert!(text.contains("let [[self_, y_]] = y.data.0;"), "{text}");
}

/// Each structure has a scope of its own; parameters and the arguments of functions share one.
#[test]
fn signals_have_the_names_of_the_author() {
    let sketch = Sketch {
        parameters: &[("V", "3")],
        phi_0: &["V*chi1", "D"],
        y: &[("v", "0.0"), ("D", "0.0")],
        x: &[("terms", "0.0"), ("v_4", "0.0")],
        phi: &["terms", "v_4"],
        phi_left: &[("terms", "z1"), ("v_4", "z2")],
        u: &[],
        h: &["0.0", "D"],
        phi_1: &[&["v", "D"], &["0.0", "V"]],
        assume: &[],
        ..CUK
    };
    let text = emitted(sketch);
    let has = |name: &str, fields: &str| {
        let from = text.find(&format!("pub struct {name}")).unwrap();
        let found = text[from..].split('\n').take_while(|line| *line != "}" && !line.ends_with(';'));
        let found: Vec<&str> = found.filter(|line| line.contains(": f64,")).map(str::trim).collect();
        assert_eq!(found.join(" "), fields, "{text}");
    };
    has("X", "pub terms_: f64, pub v_4: f64,");
    has("Y", "pub v: f64, pub d: f64,");
    has("U", "");
    assert!(text.contains("pub struct U;"), "{text}");
}

#[test]
fn an_undeclared_symbol_is_an_error() {
    let (plant, derivation) = Sketch { phi_0: &["i1", "0.0"], ..CUK }.build();
    let error = emit(&plant, &derivation, None, Scalar::F64, vanishes).unwrap_err();
    assert_eq!(error, EmitError::UndeclaredSymbol { symbol: "i1".to_owned() });
}

#[test]
fn only_accepted_derivations_are_emitted() {
    let (plant, mut derivation) = CUK.build();
    derivation.outcome = Outcome::Undecided;
    let error = emit(&plant, &derivation, None, Scalar::F64, vanishes).unwrap_err();
    assert_eq!(error, EmitError::NotAccepted);
}

#[test]
fn there_is_no_default_without_values() {
    let text = emitted(PENDULUM);
    assert!(!text.contains("impl Default"), "{text}");
    assert!(text.contains("`ell`, without a value in the model."));
}

#[test]
fn numbers_without_a_decimal_are_exact_quotients() {
    let text = emitted(PMSM);
    assert!(text.contains("const RATIO_1_3000: f64 = 1.0 / 3000.0;"), "{text}");
    assert!(text.contains("l: RATIO_1_3000,"), "{text}");
}

#[test]
fn a_number_out_of_range_is_an_error() {
    let sketch =
        Sketch { parameters: &[("L1", "1e-60"), ("C2", "1"), ("L3", "1"), ("C4", "1"), ("G", "1"), ("E", "1")], ..CUK };
    let (plant, derivation) = sketch.build();
    assert!(emit(&plant, &derivation, None, Scalar::F64, vanishes).is_ok());
    let error = emit(&plant, &derivation, None, Scalar::F32, vanishes).unwrap_err();
    assert!(matches!(error, EmitError::OutOfRange { .. }), "{error}");
}

#[test]
fn tampered_tokens_are_refused() {
    let (plant, derivation) = CUK.build();
    let definitions = Definitions::of(&plant, &derivation, None).unwrap();
    let asked = derivation.conditions_on_parameters(&plant);
    let text = emitted(CUK);
    let confirm = |text: &str| {
        let tokens = text.parse().unwrap();
        read_back::confirm(&plant, &definitions, (&asked, None), Scalar::F64, &tokens, vanishes)
    };
    assert_eq!(confirm(&text), Ok(()));
    for (from, to) in [
        ("1.0 - d", "1.0 + d"),
        ("let [[v2, v4]] = y", "let [[v4, v2]] = y"),
        ("1.0 / parameters.c2", "1.0 / parameters.c4"),
        ("[column_1, column_2]", "[column_2, column_1]"),
        ("let [[chi1, chi2]]", "let [[_, chi2]]"),
        ("e: 12.0", "e: 12.5"),
        ("Regression::Dynamic", "Regression::Static"),
        ("NX: usize = 2", "NX: usize = 3"),
        ("pub l1: f64", "pub c2: f64"),
        ("SVector::from(", "SVector::of("),
        ("self.l1 > 0.0", "self.l1 >= 0.0"),
        ("self.l3 > 0.0", "self.l1 > 0.0"),
        ("self.c2.is_finite() && ", ""),
        ("self.c2.is_finite() && ", "self.l1.is_finite() && "),
        ("self.g.is_finite() && self.g > 0.0,", ""),
        ("Fault::of_parameters", "Fault::of_values"),
        ("Self::from([y.v2, y.v4])", "Self::from([y.v4, y.v2])"),
        ("let [[i1, i3]] = x", "let [[i3, i1]] = x"),
        ("pub d: f64", "pub e: f64"),
        ("type Y = Y", "type Y = SVector<f64, NY>"),
        ("impl From<U> for SVector<f64, NU>", "impl From<U> for SVector<f64, NY>"),
        ("sides.known.into()", "sides.factor.into()"),
        ("sides.factor.transpose().into()", "sides.factor.into()"),
        ("self.recover(&z.into(), &y.into())", "self.recover(&y.into(), &z.into())"),
        ("self.flow(&y.into(), &u.into()).h", "self.flow(&y.into(), &u.into()).lambda"),
        ("pub fn h(", "pub fn lambda("),
    ] {
        assert!(text.contains(from), "{from}");
        assert!(confirm(&text.replacen(from, to, 1)).is_err(), "{from} -> {to}");
    }
}

#[test]
fn the_functions_of_the_paper_are_those_of_the_class() {
    let named = |sketch: Sketch| {
        let text = emitted(sketch);
        let (_, paper) = text.split_once("/// The functions of the paper").unwrap();
        let (paper, _) = paper.split_once("\n}\n").unwrap();
        let heads = paper.lines().filter_map(|line| line.trim().strip_prefix("pub fn ")?.strip_suffix(" {"));
        heads.map(str::to_owned).collect::<Vec<String>>()
    };
    let expected = [
        "h(&self, y: Y, u: U) -> [f64; NZ]",
        "phi_0(&self, chi: [f64; NZ], y: Y, u: U) -> [f64; NR]",
        "phi_1(&self, chi: [f64; NZ], y: Y, u: U) -> [[f64; NE]; NR]",
        "phi_left(&self, z: [f64; NZ], y: Y) -> X",
    ];
    for sketch in [CUK, CUK_CASE2, PMSM] {
        assert_eq!(named(sketch), expected, "{}", sketch.name);
    }
    let generalised = named(PENDULUM);
    assert_eq!(generalised[1], "lambda(&self, y: Y, u: U) -> [[f64; NZ]; NZ]");
    assert_eq!(generalised[2], "phi_0(&self, extension: &Fundamental<f64, NZ>, y: Y, u: U) -> [f64; NR]");
}

#[test]
fn an_unconfirmed_emission_is_refused() {
    // Equal to 1 only by sin^2 + cos^2 = 1.
    const ROWS: &[&str] = &["Real::sin(d)*Real::sin(d) + Real::cos(d)*Real::cos(d)", "0.0"];
    let (plant, derivation) = Sketch { phi_0: ROWS, ..CUK }.build();
    let definitions = Definitions::of(&plant, &derivation, None).unwrap();
    let tokens = emitted(Sketch { phi_0: &["1.0", "0.0"], ..CUK }).parse().unwrap();
    let asked = derivation.conditions_on_parameters(&plant);
    let confirm = |is_zero: fn(&Arena, Expr) -> bool| {
        read_back::confirm(&plant, &definitions, (&asked, None), Scalar::F64, &tokens, is_zero)
    };
    assert_eq!(confirm(vanishes), Ok(()));
    let refused = confirm(|arena, expr| {
        let call = |&inner: &Expr| matches!(arena.node(inner), Node::Call(..));
        vanishes(arena, expr) && !arena.postorder(&[expr]).iter().any(call)
    });
    let function = "phi_0".to_owned();
    assert_eq!(refused, Err(EmitError::Differs { function, row: 1, column: 1 }));
}

#[test]
fn parameters_are_checked_for_what_is_assumed() {
    let sketch = Sketch {
        // Without a value, and with values of each sign.
        parameters: &[("L1", ""), ("C2", "-2"), ("L3", "0"), ("C4", ""), ("G", "0.5"), ("E", "")],
        assume: &["L1", "G", "1.0 - d", "-E", "C4 - 3.0*G*L1"],
        ..CUK
    };
    let text = emitted(sketch);
    let code = function(&text, "check");
    let (_, rows) = code.split_once("of_parameters([").unwrap();
    let rows: Vec<&str> = rows.lines().map(str::trim).filter(|line| line.ends_with(',')).collect();
    let expected = [
        "self.l1.is_finite() && self.l1 > 0.0,",
        "self.c2.is_finite() && self.c2 < 0.0,",
        "self.l3 == 0.0,",
        "self.c4.is_finite(),",
        "self.g.is_finite() && self.g > 0.0,",
        "self.e.is_finite() && self.e < 0.0,",
        "self.c4 - 3.0 * self.l1 * self.g > 0.0,",
        // The code divides by these, and no row above says that they are not zero as they are rounded.
        "self.c4.is_finite() && self.c4 > 0.0,",
        "self.l3.is_finite() && self.l3 != 0.0,",
    ];
    assert_eq!(rows, expected, "{code}");
}

/// The conditions of several parameters, and the variables that they share.
fn checked(phi_0: &'static [&'static str], assume: &'static [&'static str]) -> Vec<String> {
    let text = emitted(Sketch { assume, phi_0, ..CUK });
    let code = function(&text, "check");
    let lines = code.lines().map(str::trim);
    let lines = lines.filter(|line| line.starts_with("let ") || line.ends_with(',') && !line.contains("is_finite"));
    lines.map(str::to_owned).collect()
}

#[test]
fn what_is_divided_by_is_checked_in_the_form_in_which_it_is_computed() {
    // If the first is positive, the second can be 0.
    let quotient = checked(&["v2/(L1 - C2*C2/L3)", "0.0"], &["L1*L3 - C2*C2"]);
    let expected =
        ["let t1 = self.c2 * self.c2;", "self.l1 * self.l3 - t1 > 0.0,", "self.l1 - t1 * (1.0 / self.l3) > 0.0,"];
    assert_eq!(quotient, expected);
    // Nothing is checked twice, and neither are products of nonzero factors.
    assert_eq!(checked(&["v2/(L1*L3 - C2*C2)", "0.0"], &["L1*L3 - C2*C2"]).len(), 1);
    assert_eq!(checked(&["v2/(L1*C2)", "0.0"], &["L1"]), [""; 0]);
    // The sign of negative divisors is checked, and that those without a sign are not zero.
    assert_eq!(checked(&["v2/(L1 - C2)", "0.0"], &["C2 - L1"])[1..], ["self.l1 - self.c2 < 0.0,"]);
    assert_eq!(checked(&["v2/(L1 - C2)", "0.0"], &["L1"]), ["self.l1 - self.c2 != 0.0,"]);
}

#[test]
fn roots_and_logarithms_of_parameters_are_checked_as_they_are_computed() {
    let last = |formula| checked(Box::leak(Box::new([formula, "0.0"])), &["L1*L3 - C2*C2"]).pop();
    let last = |formula| last(formula).unwrap_or_default();
    assert_eq!(last("v2*Real::sqrt(L1 - C2*C2/L3)"), "self.l1 - t1 * (1.0 / self.l3) >= 0.0,");
    assert!(last("v2*Real::ln(L1/C2 - C2/L3)").ends_with(" > 0.0,"));
    assert_eq!(last("v2*Real::sqrt(L1*C2)"), "self.l1 * self.l3 - self.c2 * self.c2 > 0.0,");
}

#[test]
fn what_the_rows_of_single_parameters_show_is_not_checked_again() {
    let assume = &["L1", "L1*C2 + G", "1.0 + E*E"];
    assert!(!emitted(Sketch { assume, ..CUK }).contains("self.l1 * "));
}

#[test]
fn linear_regressions_may_be_rebased() {
    for (sketch, rebase) in [(CUK, true), (CUK_CASE2, true), (PENDULUM, true), (PMSM, false)] {
        assert_eq!(emitted(sketch).contains("impl Rebase"), rebase, "{}", sketch.name);
    }
    let wrong_sign = Sketch { phi_0: &["-((1.0 - d)*chi1 + d*chi2)/C2", "chi2/C4"], ..CUK };
    assert!(!emitted(wrong_sign).contains("impl Rebase"));
}

#[test]
fn an_equation_without_an_unknown_is_left_out() {
    // The rate of `v4` is known: chi2 is not in it.
    let known = Sketch {
        y: &[("v2", "((1.0 - d)*i1 + d*i3)/C2"), ("v4", "-G*v4/C4")],
        phi_0: &["((1.0 - d)*chi1 + d*chi2)/C2", "-G*v4/C4"],
        phi_1: &[&["(1.0 - d)/C2", "d/C2"], &["0.0", "0.0"]],
        ..CUK
    };
    let text = emitted(known);
    assert!(text.contains("pub const NR: usize = 1;"), "{text}");
    assert!(text.contains("//! `v4'` holds nothing unknown: it is no part of the regression."), "{text}");
    assert!(!text.contains("g_over_c4") && !text.contains("[0.0, 0.0]"), "{text}");
    // A gate looks at the sample of each output.
    let (plant, derivation) = known.build();
    let whole = derivation.regression.result.as_ref().unwrap();
    assert_eq!(whole.without_unknowns(&plant.arena), [1]);
    assert_eq!(whole.computed(&plant.arena, true).rows(), [0, 1]);
    assert_eq!(whole.computed(&plant.arena, false).rows(), [0]);
    assert_eq!(emitted(CUK).matches("nothing unknown").count(), 0);
}

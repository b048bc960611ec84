//! One mistake, one diagnostic, at the right span.

use super::{CUK, REST, parse};
use crate::plant::Plant;
use crate::source::Code::{self, *};

/// The example with one text replaced: the only diagnostic's code, and the underlined text.
fn diagnose(from: &str, to: &str) -> (Code, String) {
    let text = CUK.to_owned() + REST;
    assert!(text.contains(from), "{from}");
    let text = text.replacen(from, to, 1);
    let found = parse(&text).expect_err(to);
    assert_eq!(found.len(), 1, "{to}: {found:#?}");
    assert!(found[0].help.is_some(), "{to}");
    (found[0].code, text[found[0].primary.span.range()].to_owned())
}

#[test]
fn each_gives_one_diagnostic() {
    let cases = [
        // Keys.
        ("title:", "titel:", UnknownKey, "titel"),
        ("hold:", "holt:", UnknownKey, "holt"),
        ("scale:", "sc:", UnknownKey, "sc"),
        ("limits: {v2:", "limits: {i1:", UnknownEntry, "i1"),
        ("limits: {v2: [-50, 50]", "limits: {v2: [50, -50]", NumberOutOfRange, "50"),
        ("limits: {v2: [-50, 50]", "limits: {v2: [50]", WrongShape, "v2"),
        ("gap: 1e-3", "gap: 0", NumberOutOfRange, "0"),
        ("gap: 1e-3", "gap: 1e-7", NumberOutOfRange, "1e-7"),
        ("title:", "model:", DuplicateKey, "model"),
        ("f_x: {i3:", "f_x: {i1: 0, i3:", DuplicateKey, "i1"),
        ("x: [i1, i3]\n", "", MissingKey, "model"),
        ("phi: [i1, i3]\n", "", MissingKey, "i3"),
        ("model: cuk\n", "", MissingKey, "title"),
        ("title: error, ", "", MissingKey, "{unit: A, curves: [hat(i1) - i1, v2], scale: log}"),
        // Shapes.
        ("x: [i1, i3]", "x: {i1: 0, i3: 0}", WrongShape, "{i1: 0, i3: 0}"),
        ("x: [i1, i3]", "x: i1", WrongShape, "i1"),
        ("phi: [i1, i3]", "phi: i1", WrongShape, "i1"),
        ("phi: [i1, i3]", "phi: [i1, [i3]]", WrongShape, "[i3]"),
        ("phi: [i1, i3]", "phi: []", EmptyList, "[]"),
        ("y: [v2, v4]", "y: []", EmptyList, "[]"),
        ("model: cuk", "model: [cuk]", WrongShape, "[cuk]"),
        ("model: cuk", "model:", WrongShape, ""),
        ("E: 12", "E: [12]", WrongShape, "[12]"),
        ("E: 12", "E: 1/3", MalformedNumber, "1/3"),
        ("E: 12", "E: 1e400", NumberTooLarge, "1e400"),
        ("phi_left: {i3: z2}", "phi_left: 3", WrongShape, "3"),
        ("units: {i1: A", "units: {i2: A", UnknownEntry, "i2"),
        ("units: {i1: A", "units: {i1: \"\"", WrongShape, "\"\""),
        ("units: {i1: A", "units: {i1: '[A]'", WrongShape, "'[A]'"),
        ("units: {i1: A", "units: {i1: ampere as it is measured", WrongShape, "ampere as it is measured"),
        ("units: {i1: A", "units: {i1: [A]", WrongShape, "[A]"),
        ("step: 1e-6", "step: fast", MalformedNumber, "fast"),
        ("step: 1e-6", "step: -1", NumberOutOfRange, "-1"),
        ("filter: 500", "filter: 0", NumberOutOfRange, "0"),
        ("gain: 1e7", "gain: [1e7, -2]", NumberOutOfRange, "-2"),
        ("gain: 1e7", "gain: 1e7, covariance: [2, 3]", SettingConflict, "2, 3"),
        ("gain: 1e7", "gain: 1e7, window: 10", SettingConflict, "10"),
        ("gain: 1e7", "gain: 1e7, process_noise: 2", SettingConflict, "2"),
        ("gain: 1e7", "gain: 1e7, rebase: 0", NumberOutOfRange, "0"),
        ("gain: 1e7", "gain: 1e7, rebase: 1.5", NumberOutOfRange, "1.5"),
        ("gain: 1e7", "gain: 1e7, rebase: {samples: 0}", NumberOutOfRange, "0"),
        ("gain: 1e7", "gain: 1e7, rebase: {above: 0}", NumberOutOfRange, "0"),
        ("gain: 1e7", "gain: 1e7, rebase: {leak: -1}", NumberOutOfRange, "-1"),
        ("gain: 1e7", "gain: 1e7, rebase: {above: 5, leak: 3}", SettingConflict, "3"),
        ("gain: 1e7", "gain: 1e7, rebase: {leek: 3}", UnknownKey, "leek"),
        ("gain: 1e7", "gain: 1e7, rebase: [3]", WrongShape, "[3]"),
        ("estimator: gradient, gain: 1e7", "clip: 0.2", SettingConflict, "0.2"),
        ("estimator: gradient, gain: 1e7", "estimator: least-squares, gain: 1", SettingConflict, "1"),
        ("estimator: gradient, gain: 1e7", "estimator: drem, gain: 1, regressor_gain: 0", NumberOutOfRange, "0"),
        ("estimator: gradient, gain: 1e7", "estimator: least-squares, covariance: -1", NumberOutOfRange, "-1"),
        ("estimator: gradient, gain: 1e7", "estimator: least-squares, forgetting: -1", NumberOutOfRange, "-1"),
        ("estimator: gradient", "estimator: normalised-gradient, normalisation: -2", NumberOutOfRange, "-2"),
        ("estimator: gradient", "estimator: finite-time-drem, clip: 1", NumberOutOfRange, "1"),
        ("estimator: gradient", "estimator: finite-time-drem, clip: 0", NumberOutOfRange, "0"),
        ("estimator: gradient", "estimator: finite-time-drem, period: 0", NumberOutOfRange, "0"),
        ("filter: 500", "window: 2.5", NumberOutOfRange, "2.5"),
        ("filter: 500", "window: 0", NumberOutOfRange, "0"),
        ("filter: 500", "window: [1]", WrongShape, "[1]"),
        ("upper: [2, 3]", "uper: 2", UnknownKey, "uper"),
        ("estimator: gradient, gain: 1e7", "estimator: least-square, covariance: 2", WrongChoice, "least-square"),
        ("0.2: 30*t", "0.0: 30*t", NumberOutOfRange, "0.0"),
        ("hold: first-order", "hold: first_order", WrongChoice, "first_order"),
        ("feedback: copy", "feedback: cpoy", WrongChoice, "cpoy"),
        // YAML.
        ("E: 12", "E: &e 12", YamlFeature, "12"),
        ("E: 12", "E: !!int 12", YamlFeature, "12"),
        ("phi: [i1, i3]", "phi: [i1, *i3]", YamlFeature, "*i3"),
        ("define: {p: v2*i1}", "define: {? [p] : v2*i1, p: 1}", WrongShape, "[p]"),
        // Names.
        ("model: cuk", "model: 3cuk", InvalidName, "3cuk"),
        ("w: [omega]", "w: [ω]", InvalidName, "ω"),
        ("w: [omega]", "w: [a b]", InvalidName, "a b"),
        ("w: [omega]", "w: [_]", InvalidName, "_"),
        ("w: [omega]", "w: [z12]", ReservedName, "z12"),
        ("w: [omega]", "w: [theta1]", ReservedName, "theta1"),
        ("w: [omega]", "w: [Psi10_11]", ReservedName, "Psi10_11"),
        ("w: [omega]", "w: [t]", ReservedName, "t"),
        ("w: [omega]", "w: [E]", DuplicateName, "E"),
        ("define: {p:", "define: {d:", DuplicateName, "d"),
        ("{V_d: {", "{E: {", DuplicateName, "E"),
        ("state: {a:", "state: {V: 0, a:", DuplicateName, "V"),
        // Entries.
        ("f_x: {i3: -(d*v2 + v4)/L3, ", "f_x: {", MissingEntry, "i3"),
        ("f_x: {i3:", "f_x: {omega: 0, i3:", UnknownEntry, "omega"),
        ("f_y: {v2:", "f_y: {V2:", UnknownEntry, "V2"),
        ("control: {d:", "control: {D:", UnknownEntry, "D"),
        ("estimate: {i1:", "estimate: {i2:", UnknownEntry, "i2"),
        ("initial: {a:", "initial: {b:", UnknownEntry, "b"),
        // Formulas.
        ("phi: [i1, i3]", "phi: [i1, 2 i3]", ImplicitMultiplication, "2 i3"),
        ("phi: [i1, i3]", "phi: [i1, atan2(i1, v2)/G]", UnclosedParenthesis, "atan2(i1, v2)/G"),
        ("phi_left: {i3: z2}", "phi_left: {i3: atan2(z2, z1)}", UnclosedParenthesis, "atan2(z2, z1)"),
        ("phi: [i1, i3]", "phi: [i1, ]\nidentities: []", DuplicateKey, "identities"),
        ("phi: [i1, i3]", "phi: [i1, hat(i3)]", MisplacedEstimate, "hat"),
        ("V: 1}", "V: hat(i1)}", MisplacedEstimate, "hat"),
        ("assume: [L1 > 0", "assume: [L1", ComparisonExpected, "L1"),
        ("d*v2 + v4", "d*v2 + + v4", UnexpectedToken, "+"),
        ("f_x: {i3: -(d*v2 + v4)/L3", "f_x: {i3: ", WrongShape, ""),
    ];
    for (from, to, code, underlined) in cases {
        assert_eq!(diagnose(from, to), (code, underlined.to_owned()), "{to}");
    }
}

/// A table as its author may write it: the diagnostic's code, and the underlined text.
#[test]
fn a_table_is_read_or_refused_where_it_is_wrong() {
    let cases = [
        ("{table: v2, points: [[0, 1], [2, 0.5]]}", None),
        ("{table: v2, points: [[0, 1], [2, 0.5]], interpolation: linear}", None),
        ("{table: v2, points: [[0, 1], [0, 0.5]]}", Some((WrongShape, "0"))),
        ("{table: v2, points: [[0, 1, 3], [1, 0.5]]}", Some((WrongShape, "0"))),
        ("{table: v2, points: [[0, 1], [x, 0.5]]}", Some((MalformedNumber, "x"))),
        ("{table: v2, points: [[0, 1]]}", Some((WrongShape, "t"))),
        ("{table: v2, points: {0: 1, 1: 2}}", Some((WrongShape, "{0: 1, 1: 2}"))),
        ("{table: v2}", Some((MissingKey, "{table: v2}"))),
        ("{points: [[0, 1], [1, 2]]}", Some((MissingKey, "{points: [[0, 1], [1, 2]]}"))),
        ("{table: nothing, points: [[0, 1], [1, 2]]}", Some((UnknownName, "nothing"))),
        ("{table: t(v2), points: [[0, 1], [1, 2]]}", None),
        ("{table: v2, points: [[0, 1], [1, 2]], interpolation: spline}", Some((WrongChoice, "spline"))),
        ("{0: 1, 1: 2}", Some((WrongShape, "{0: 1, 1: 2}"))),
    ];
    for (table, expected) in cases {
        let text = CUK.replacen("phi:", &format!("define: {{t: {table}}}\nphi:"), 1).replacen("d*v2", "d*t", 1);
        let found = match parse(&text) {
            Ok(model) => Plant::resolve(&model).map(|_| ()),
            Err(found) => Err(found),
        };
        let first = found.err().and_then(|found| found.into_iter().next());
        let shown = first.map(|found| (found.code, text[found.primary.span.range()].to_owned()));
        assert_eq!(shown, expected.map(|(code, text)| (code, text.to_owned())), "{table}");
    }
    let points: Vec<String> = (0..51).map(|at| format!("[{at}, {at}]")).collect();
    let long = format!("define: {{t: {{table: v2, points: [{}]}}}}\nphi:", points.join(", "));
    let found = parse(&CUK.replacen("phi:", &long, 1)).expect_err("too many points");
    assert!(found[0].message.contains("at most 50 points"), "{}", found[0].message);
}

#[test]
fn independent_mistakes_are_all_found() {
    let text = CUK
        .replace("title", "titel")
        .replace("E: 12", "E: x")
        .replace("u: [d]", "u: [d, d]")
        .replace("*v2 + v4", "v2")
        .replace("i1:", "i2:");
    let codes: Vec<Code> = parse(&text).expect_err("it is wrong").iter().map(|found| found.code).collect();
    // The missing entry of `f_x` for i1 is reported at i2.
    let expected = [UnknownKey, MalformedNumber, DuplicateName, UnknownEntry];
    assert_eq!(codes, expected);
}

#[test]
fn help_names_the_nearest() {
    let help = |from: &str, to: &str| {
        let found = parse(&CUK.replacen(from, to, 1)).expect_err(to);
        found[0].help.as_deref().unwrap_or_default().to_owned()
    };
    assert_eq!(help("parameters", "paramters"), "did you mean `parameters`?");
    assert_eq!(help("phi:", "observer: {estimator: lest-squares}\nphi:"), "did you mean `least-squares`?");
    assert_eq!(help("f_y: {v2", "f_y: {v22"), "did you mean `v2`?");
    assert_eq!(help("x: [i1", "x: [λ"), "spell it out: `lambda`");
    let course = "write a number: the values of a signal over time stand in `signals`, those of a parameter or of a constant state in `plant`";
    assert_eq!(help("phi:", "simulation: {initial: {i1: {0: 0, 0.1: 1}}}\nphi:"), course);
    assert_eq!(help("[i1, i3]\ny", "i1\ny"), "write `x: [i1]`");
    let unknown = super::super::unknown_name("v_2", crate::source::Span::default(), ["v2", "d"]);
    assert_eq!(unknown.help.as_deref(), Some("did you mean `v2`?"));
}

/// A drive in the words of its author, with one text replaced: the only diagnostic's code and help.
fn of_drive(from: &str, to: &str) -> (Code, String) {
    const DRIVE: &str = "model: drive\nparameters: {R: 1, L: 5e-3, K: 0.1, J: 1e-3}\nx: [i, load]\ny: [omega]\nu: [v]\n\
                         f_x: {i: (v - R*i - K*omega)/L, load: 0}\nf_y: {omega: (K*i - load)/J}\n";
    assert!(DRIVE.contains(from), "{from}");
    let found = parse(&DRIVE.replacen(from, to, 1)).expect_err(to);
    assert_eq!(found.len(), 1, "{to}: {found:#?}");
    (found[0].code, found[0].help.as_deref().unwrap_or_default().to_owned())
}

#[test]
fn a_help_is_the_cure() {
    let cases = [
        // States and outputs.
        ("[i, load]", "[i, load, omega]", DuplicateName, "remove `omega` from `x`"),
        ("x: [i, load]", "x: [i]", UnknownEntry, "declare it, as `x: [i, load]`"),
        ("load: 0}", "load: 0, omega: (K*i - load)/J}", UnknownEntry, "its rate stands under `f_y`"),
        ("f_y: {", "f_y: {load: 0, ", UnknownEntry, "its rate stands under `f_x`"),
        ("load: 0}", "load: 0, R: 0}", UnknownEntry, "remove it here"),
        ("{i: (", "{di: (", UnknownEntry, "write `i: ..`: what stands under `f_x` is a rate already"),
        ("{i: (", "{i': (", UnknownEntry, "write `i: ..`"),
        ("{i: (", "{di/dt: (", UnknownEntry, "write `i: ..`"),
        (", load: 0}", "}", MissingEntry, "its rate under `f_x`, 0 if it is constant"),
        ("f_y: {omega: (K*i - load)/J}\n", "", MissingKey, "`f_y: {omega: ..}`, or its value, as `g_y: {omega: ..}`"),
        ("y: [omega]", "y: omega", WrongShape, "write `y: [omega]`"),
        ("x: [i, load]", "x: {i: A, load: Nm}", WrongShape, "write `x: [i, load]`"),
        // Keys.
        ("parameters:", "params:", UnknownKey, "did you mean `parameters`?"),
        ("u: [v]", "inputs: [v]", UnknownKey, "did you mean `u`?"),
        ("u: [v]\n", "u: [v]\nobserver: {noise: {omega: 1}}\n", UnknownKey, "did you mean `sensors`?"),
        ("u: [v]\n", "u: [v]\nduration: 1\n", UnknownKey, "write it under `simulation`"),
        ("model: drive", "model: DC drive 24V", InvalidName, "write `DC_drive_24V`"),
        // Numbers.
        ("L: 5e-3", "L: 5mH", MalformedNumber, "write `5e-3`"),
        ("L: 5e-3", "L: 100k", MalformedNumber, "write `100e3`"),
        ("L: 5e-3", "L: 5 V", MalformedNumber, "write `5`"),
        ("L: 5e-3", "L: 5m", MalformedNumber, "write `5`, or `5e-3` if that is meant"),
        ("L: 5e-3", "L: \"0,005\"", MalformedNumber, "write `0.005`"),
        ("L: 5e-3", "L: 0,005", InvalidName, "as `0.005`"),
        ("L: 5e-3", "L: 5 %", MalformedNumber, "`5e-2`"),
        // Formulas.
        ("u: [v]\n", "u: [v]\nassume: [v > 0 and v < 24]\n", UnexpectedToken, "a chain, as `0 < v < 24`"),
        ("u: [v]\n", "u: [v]\nassume: [v > 0 && v < 24]\n", UnexpectedCharacter, "a chain, as `0 < v < 24`"),
        ("{i: (v -", "{i: (v(t - R) -", UnknownFunction, "a delayed input is an input of its own"),
        ("- load)", "- interp(load))", UnknownFunction, "write its points under `define`"),
        ("- load)", "- if(load > 0))", UnknownFunction, "use max, min, sat, sign or abs"),
        ("- load)", "- load*|omega|)", UnexpectedCharacter, "the absolute value is `abs(omega)`"),
        ("- load)", "- log10(load))", UnknownFunction, "`log(a)/log(10)`"),
        ("load: 0", "load: {0: 1, 1: 2}", WrongShape, "a table has a name"),
    ];
    for (from, to, code, cure) in cases {
        let (found, help) = of_drive(from, to);
        assert_eq!(found, code, "{to}: {help}");
        assert!(help.contains(cure), "{to}: {help}");
    }
}

/// The help is followed: then there is nothing left to say.
#[test]
fn the_course_of_an_input_has_a_name_of_its_own() {
    let with = |simulation: &str| parse(&format!("{CUK}simulation: {{{simulation}}}\n"));
    let both = "`signals: {d_t: {0: 0, 0.1: 1}}` and `control: {d: d_t}`";
    let found = with("control: {d: {0: 0, 1: 0.5}}").expect_err("it is a map");
    assert!(found.len() == 1 && found[0].help.as_deref().is_some_and(|help| help.contains(both)), "{found:#?}");
    let found = with("signals: {d: {0: 0, 1: 0.5}}").expect_err("it is an input");
    let help = found[0].help.as_deref().unwrap_or_default();
    assert!(help.contains("`signals: {d_t: ..}` and `control: {d: d_t}`"), "{help}");
    with("signals: {d_t: {0: 0, 0.1: 1}}, control: {d: d_t}").expect("it is what the help says");
}

//! Settings derived from known numbers, and contradictions.

use pebo_cas::Rational;
use pebo_design::analysis::Derivation;
use pebo_design::model::Model;
use pebo_design::plant::Plant;
use pebo_design::plant::settings::{Covariance, Estimator, Late, Operator, Rebase, Settings};
use pebo_design::source::{Diagnostic, Diagnostics, Source};

use super::DerivedSettings;
use super::equations::SampleRows;

const CUK: &str = "
model: cuk
parameters: {L1: 10e-3, C2: 22e-6, L3: 10e-3, C4: 22.9e-6, G: 0.0447, E: 12}
x: [i1, i3]
y: [v2, v4]
u: [d]
assume: [0 < d < 1]
f_x: {i1: (E - (1 - d)*v2)/L1, i3: -(d*v2 + v4)/L3}
f_y: {v2: ((1 - d)*i1 + d*i3)/C2, v4: (i3 - G*v4)/C4}
phi: [2*i1, i3]
";

const KNOWN: &str = "observer: {sensors: {v2: 0.1, v4: 0.2}, start: {i1: 5, i3: 3}, disturbance: {i1: 1}}\n";

const SCENARIO: &str = "simulation: {step: 1e-5, initial: {i1: 0.5, i3: -1, v2: 10, v4: -12}, control: {d: 0.5}}\n";

/// The plant of a model that is accepted, with its derivation.
fn accepted(text: &str) -> (Plant, Derivation) {
    let plant = Plant::resolve(&Model::parse(&Source::new("test", text).unwrap()).unwrap()).unwrap();
    let derivation = Derivation::derive(&plant);
    (plant, derivation)
}

fn derived(text: &str) -> (Option<Settings<Rational>>, Vec<Diagnostic>) {
    let model = match Source::new("test", text).map_err(|found| vec![found]).and_then(|source| Model::parse(&source)) {
        Ok(model) => model,
        Err(found) => return (None, found),
    };
    let plant = Plant::resolve(&model).unwrap();
    let derivation = Derivation::derive(&plant);
    let mut problems = Diagnostics::new();
    let derived = DerivedSettings::of(&model, &plant, &derivation, &super::Shown::default(), &mut problems);
    (derived.map(|derived| derived.settings), problems.into_vec())
}

fn numbers(settings: &Settings<Rational>) -> [Vec<f64>; 3] {
    let Estimator::LeastSquares(Covariance { start, process_noise, .. }) = &settings.estimator else {
        panic!("{settings:?}")
    };
    let all = |values: &[Rational]| values.iter().map(Rational::to_f64).collect::<Vec<_>>();
    let operator = match &settings.operator {
        Operator::Sampled(deviations) => all(deviations),
        Operator::Filter(alpha) => vec![alpha.to_f64()],
        Operator::Window(_) => panic!("{settings:?}"),
    };
    [all(start), all(process_noise.as_ref().unwrap()), operator]
}

fn close(found: &[f64], expected: &[f64]) -> bool {
    // Four digits are kept.
    found.len() == expected.len() && found.iter().zip(expected).all(|(a, b)| (a - b).abs() <= 1e-3 * b.abs())
}

#[test]
fn deviations_become_covariances_through_the_slopes_of_phi() {
    let (settings, problems) = derived(&format!("{CUK}{KNOWN}{SCENARIO}"));
    assert!(problems.is_empty(), "{problems:?}");
    let settings = settings.unwrap();
    let [start, noise, sensors] = numbers(&settings);
    assert!(settings.output && settings.expected.is_none() && settings.rebase == Some(Rebase::Samples(Rational::ONE)));
    assert!(close(&sensors, &[0.1, 0.2]), "{sensors:?}");
    // The outputs' first samples, then (2*5)^2 and 3^2.
    assert!(close(&start, &[0.01, 0.04, 100.0, 9.0]), "{start:?}");
    // 2*i1 drifts by 2; the outputs are states of the observer, so that what their samples err by is in no rate.
    let expected = [0.0, 0.0, 4.0, 0.0];
    assert!(close(&noise, &expected), "{noise:?} {expected:?}");
}

#[test]
fn an_output_that_is_given_by_its_value_moves_with_the_states() {
    // z = x1 - y1 is -x2: it starts as wrong as x2, and drifts as x2 does.
    let text = "model: m\nx: [x1, x2]\ny: [y1, y2]\nf_x: {x1: x2, x2: 0}\nf_y: {y2: x1}\ng_y: {y1: x1 + x2}\n\
                phi: [x1 - y1, x1]\nobserver: {sensors: {y1: 1e-4, y2: 0.1}, start: {x1: 0.01, x2: 1}, disturbance: {x2: 3}}\n\
                simulation: {duration: 1, step: 0.01, initial: {x1: 0, x2: 1, y2: 0}}\n";
    let (settings, problems) = derived(text);
    let settings = settings.unwrap_or_else(|| panic!("{problems:?}"));
    let [start, noise, _] = numbers(&settings);
    let first = start.len() - 2;
    assert!(close(&start[first..], &[1.0, 1e-4]) && (noise[first] - 9.0).abs() < 0.01, "{start:?} {noise:?}");
}

#[test]
fn covariances_of_z_may_be_written() {
    let known =
        "observer: {sensors: {v2: 0.1, v4: 0.2}, covariance: [7, 8], process_noise: 0.5, within: {lower: -9}}\n";
    let (settings, problems) = derived(&format!("{CUK}{known}{SCENARIO}"));
    let settings = settings.unwrap_or_else(|| panic!("{problems:?}"));
    let [start, noise, _] = numbers(&settings);
    assert!(close(&start[2..], &[7.0, 8.0]) && close(&noise[2..], &[0.5, 0.5]), "{start:?} {noise:?}");
    assert_eq!(settings.within[0].as_ref().map(Vec::len), Some(2));
}

#[test]
fn settings_need_no_known_numbers_if_the_start_is_known() {
    let (settings, problems) = derived(&format!("{CUK}{SCENARIO}"));
    assert!(problems.is_empty() && settings.is_some_and(|settings| settings.output), "{problems:?}");
    // Nothing is known of the step: there is no observer, and no complaint.
    assert_eq!(derived(CUK), (None, Vec::new()));
}

#[test]
fn a_guessed_drift_is_corrected_by_the_samples() {
    let estimator = |text: &str| derived(&format!("{CUK}{text}{SCENARIO}")).0.unwrap().estimator;
    let Estimator::AdaptiveLeastSquares(Covariance { process_noise, .. }, guess) = estimator("") else {
        panic!("no guess")
    };
    // Samples drive nothing, and outputs do not drift besides: what is wrong shows in the states.
    assert!(process_noise.is_none(), "{process_noise:?}");
    assert!(
        guess[..2].iter().all(Rational::is_zero) && guess[2..].iter().all(|guess| guess.to_f64() > 0.0),
        "{guess:?}"
    );
    // Numbers of the author are not corrected; nor is what goes through a filter, which correlates samples by itself.
    for section in ["sensors: {v2: 0.1, v4: 0.1}", "disturbance: {i1: 1}", "form: rate"] {
        assert!(matches!(estimator(&format!("observer: {{{section}}}\n")), Estimator::LeastSquares(_)), "{section}");
    }
}

#[test]
fn the_noise_of_an_output_without_a_slope_is_process_noise() {
    // q' by y, k' = 0; y' = -y + u is known.
    let of = |rate: &str| {
        let text = format!(
            "model: m\nx: [k]\ny: [q, y]\nu: [u]\nf_x: {{k: 0}}\nf_y: {{q: {rate} - 5*q, y: u - y}}\nphi: [k]\n\
             observer: {{sensors: {{q: 0.2, y: 0.1}}, start: {{k: 1}}, disturbance: {{k: 0}}}}\n\
             simulation: {{step: 0.01, initial: {{k: 2, q: 0, y: 4}}, control: {{u: 4}}}}\n"
        );
        let (settings, problems) = derived(&text);
        let settings = settings.unwrap_or_else(|| panic!("{problems:?}"));
        let [_, noise, _] = numbers(&settings);
        (noise, settings.expected)
    };
    let (noise, expected) = of("3*abs(y)*k");
    assert!(close(&noise, &[(3.0_f64 * 2.0 * 0.1).powi(2) * 0.01, 0.0, 0.0]), "{noise:?}");
    assert_eq!(expected, Some(vec![0, 1]));
    // With a slope the output is a state of the observer, at whose estimate the rates are taken.
    let (noise, expected) = of("3*y*k");
    assert!(close(&noise, &[0.0; 3]) && expected == Some(vec![0, 1]), "{noise:?} {expected:?}");
    // Where the factor is constant they do not depend on it.
    let (noise, expected) = of("k + 3*y");
    assert!(close(&noise, &[0.0; 3]) && expected.is_none(), "{noise:?} {expected:?}");
}

#[test]
fn the_drift_of_an_angle_has_no_direction() {
    let text = |angles: &str| {
        format!(
            "model: m\nx: [q]\ny: [y1, y2]\nu: [v]\nf_x: {{q: v}}\nf_y: {{y1: 3*cos(q), y2: 3*sin(q)}}\n{angles}\
             phi: [3*cos(q), 3*sin(q)]\nclass: gpebo\nobserver: {{sensors: {{y1: 1, y2: 1}}, start: {{q: 0.1}}, \
             disturbance: {{q: 2}}}}\nsimulation: {{step: 0.1, initial: {{q: 0, y1: 0, y2: 0}}, control: {{v: 0}}}}\n"
        )
    };
    let noise = |angles: &str| {
        let (settings, problems) = derived(&text(angles));
        let [_, noise, _] = numbers(&settings.unwrap_or_else(|| panic!("{problems:?}")));
        noise[noise.len() - 2..].to_vec()
    };
    // At q = 0 it moves 3*sin(q) alone, by 3*2; over a turn each of both by half of the square.
    assert!(close(&noise(""), &[0.0, 36.0]), "{:?}", noise(""));
    assert!(close(&noise("angles: {q: 2*pi}\n"), &[18.0, 18.0]), "{:?}", noise("angles: {q: 2*pi}\n"));
}

#[test]
fn known_numbers_may_depend_on_the_operating_point() {
    let product = "model: m\nx: [k]\ny: [q, y]\nu: [u]\nf_x: {k: 0}\nf_y: {q: y*k, y: u}\nphi: [k]\n\
                   observer: {sensors: {q: 1, y: 1}, start: {k: 1}, disturbance: {k: 0}}\n";
    let (settings, problems) = derived(product);
    assert!(settings.is_none());
    assert!(problems[0].message.contains("`k` is not known"), "{problems:?}");
    // Of a plant whose outputs are states of the observer, and whose phi is linear, they do not.
    let (settings, problems) = derived(&format!("{CUK}{KNOWN}"));
    assert!(settings.is_some(), "{problems:?}");
}

#[test]
fn unknown_names_bad_numbers_and_contradictions_are_reported() {
    for (section, message) in [
        ("sensors: {v3: 0.1}", "`v3` under `sensors` is not an output of y"),
        ("start: {v2: 1}", "`v2` under `start` is not a state of x"),
        ("disturbance: {d: 1}", "`d` under `disturbance` is not a state of x or y"),
        ("sensors: {v2: 0}", "the standard deviation of a sensor must be positive"),
        ("start: {i1: -1}", "a standard deviation must not be negative"),
        ("sensors: {v2: 1}, gain: 5", "`gain` stands beside `sensors`"),
        ("sensors: {v2: 1}, filter: 5", "`filter` stands beside `sensors`"),
        ("form: output, window: 5", "`window` stands beside `form`"),
        ("start: {i1: 1}, covariance: 5", "`covariance` stands beside the `start`"),
        ("disturbance: {i1: 1}, process_noise: 5", "`process_noise` stands beside the `disturbance`"),
        ("sensors: {v2: 1}, estimator: drem", "`estimator` stands beside `sensors`"),
        ("sensors: {v2: 1}, bounds: {lower: 0}", "`bounds` stands beside `sensors`"),
        ("gain: 1, filter: 1, gate: 9", "`gate` stands beside gains"),
        ("sensors: {v2: 1}, gate: 0", "the limit of the gate must be positive"),
        ("delay: {v3: 1}", "`v3` under `delay` is not an output of y"),
        ("delay: {v2: -1}", "a delay must not be negative"),
        ("gain: 1, filter: 1, delay: 1", "`delay` stands beside gains"),
        ("sensors: {v2: 1}, form: rate, delay: {v2: 1e-5}", "`v2` cannot be late: the filter"),
        ("sensors: {v2: 1e200}", "out of range"),
        ("sensors: {v2: 1}, start: {i1: 1e160}", "out of range"),
    ] {
        let (_, problems) = derived(&format!("{CUK}observer: {{{section}}}\n{SCENARIO}"));
        let found = problems.iter().any(|problem| problem.message.contains(message) && problem.help.is_some());
        assert!(found, "{section}: {problems:?}");
    }
}

/// The outputs that are late.
fn late(text: &str) -> Result<Late<f64>, Vec<Diagnostic>> {
    let (settings, problems) = derived(text);
    Ok(settings.ok_or(problems)?.late.as_ref().expect("a late output").map(Rational::to_f64))
}

#[test]
fn late_outputs_are_expected_by_their_equations() {
    let delayed = |delay: &str| {
        let known = KNOWN.replace("observer: {", &format!("observer: {{delay: {delay}, "));
        late(&format!("{CUK}{known}{SCENARIO}")).unwrap()
    };
    // Of three periods and a half: now, four of the past, and one for what is between two.
    let found = delayed("{v4: 3.5e-5}");
    let expected = Late { delays: vec![0.0, 3.5e-5], rows: vec![0, 1], is_expected: vec![true; 2], instants: 6 };
    assert_eq!(found, expected);
    assert_eq!(delayed("3.5e-5").delays, [3.5e-5, 3.5e-5]);
    // However long, the room is limited.
    assert_eq!(delayed("{v2: 1}").instants, 1024);
    let none = derived(&format!("{CUK}observer: {{delay: {{v2: 0}}}}\n{SCENARIO}")).0.unwrap();
    assert_eq!(none.late, None);
}

#[test]
fn a_late_output_that_drives_the_observer_has_an_equation_of_its_own() {
    let battery = "model: m\nx: [s]\ny: [V]\nu: [I]\nf_x: {s: -I}\ng_y: {V: 3 + 2*s - 0.1*I}\nphi: [s]\n\
                   observer: {sensors: {V: 0.1}, start: {s: 1}, delay: 0.5}\n\
                   simulation: {step: 0.1, initial: {s: 1}, control: {I: 0.1}}\n";
    let found = late(battery).unwrap();
    assert_eq!(found, Late { delays: vec![0.5], rows: vec![0], is_expected: vec![true], instants: 7 });
    // A bearing is in a factor, and nothing else needs it: its samples are waited for.
    let bearing = "model: m\nx: [p, q]\ny: [b]\nu: [v]\nassume: [sin(b) > 0]\nf_x: {p: -v, q: 0}\n\
                   g_y: {b: \"atan2(q, p)\"}\nidentities: [p*sin(b) - q*cos(b)]\nphi: [p, q]\n\
                   observer: {sensors: {b: 0.1}, start: {p: 1, q: 1}, delay: 0.5}\n\
                   simulation: {step: 0.1, initial: {p: 1, q: 1}, control: {v: 0.1}}\n";
    let found = late(bearing).unwrap();
    assert_eq!((found.rows, found.is_expected), (vec![0], vec![false]));
    // An equation of two outputs waits for the later one, and expects the other no more than that.
    let sum = "model: m\nx: [p]\ny: [a, b]\nu: [v]\nf_x: {p: v - a}\nidentities: [a + b - p]\nphi: [p]\n\
               observer: {sensors: {a: 0.1, b: 0.1}, start: {p: 1}, delay: {a: 0.1, b: 0.2}}\n\
               simulation: {step: 0.1, initial: {p: 1, a: 1, b: 0}, control: {v: 0.1}}\n";
    let problems = late(sum).unwrap_err();
    assert!(problems[0].message.contains("`a` cannot be late: the observer needs it"), "{problems:?}");
    // With a drift along it the observer needs the bearing of now.
    let problems = late(&bearing.replace("p: -v", "p: -v*cos(b)")).unwrap_err();
    assert!(problems[0].message.contains("`b` cannot be late: the observer needs it"), "{problems:?}");
}

/// Variances of a share and of a pressure, of units that set them apart by 1e25: neither is raised for the other. One of
/// zero is less than the least.
#[test]
fn variances_at_the_start_do_not_depend_on_the_units_of_others() {
    let covariance = |start: &str| {
        let text = format!(
            "model: m\nx: [p, s, c]\ny: [y]\nu: [v]\nf_x: {{p: 0, s: 0, c: 0}}\ng_y: {{y: v*p + v^2*s + c}}\n\
             phi: [p, s, c]\nobserver: {{sensors: {{y: 1}}, start: {start}, disturbance: {{p: 1}}}}\n\
             simulation: {{step: 0.1, initial: {{p: 1e7, s: 1e-6, c: 1}}, control: {{v: sin(t)}}}}\n"
        );
        numbers(&derived(&text).0.unwrap())[0].clone()
    };
    assert_eq!(covariance("{p: 1e7, s: 1e-6, c: 1}"), [1e14, 1e-12, 1.0]);
    assert_eq!(covariance("{p: 1e7, s: 1e-6, c: 0}"), [1e14, 1e-12, 1e-24]);
}

/// A car whose lateral acceleration has the steering angle in it.
const CAR: &str = "model: m\nx: [c, p]\ny: [r, a]\nu: [d]\nf_x: {c: 0, p: a*c}\nf_y: {r: 2*c*d - p - r}\n\
                   g_y: {a: c*d + p - r}\nphi: [c, p]\n\
                   observer: {sensors: {r: 0.1, a: 0.1}, start: {c: 1, p: 1}}\n\
                   simulation: {step: 0.1, initial: {c: 1, p: 0, r: 0}, control: {d: sin(t)}}\n";

#[test]
fn an_output_with_an_input_in_it_that_drives_the_cascade_jumps_with_it() {
    let found = |text: &str| derived(text).0.unwrap().feedthrough;
    assert_eq!(found(CAR), Some(vec![None, Some(1)]));
    let without = |text: &str| assert_eq!(found(text), None, "{text}");
    without(&CAR.replace("p: a*c", "p: r*c"));
    without(&CAR.replace("a: c*d + p", "a: c + p"));
}

#[test]
fn an_output_given_by_its_value_beside_one_with_a_rate_may_be_missing() {
    let (plant, derivation) = accepted(CAR);
    let regression = derivation.regression.result.as_ref().unwrap();
    // The second row has both outputs in it: without the speed it has what is expected of the speed.
    let rows = SampleRows::of(&plant, regression, true);
    assert_eq!(rows, SampleRows { rows: vec![0, 1], is_expected: vec![true; 2] });
}

#[test]
fn a_static_regression_has_no_output_form() {
    let plant = "
model: level
x: [a]
y: [q]
f_x: {a: -a}
identities: [q - a]
phi: [a]
";
    let (_, problems) = derived(&format!("{plant}observer: {{form: output}}\nsimulation: {{initial: {{a: 1, q: 1}}}}"));
    assert!(problems[0].message.contains("no regression of rates"), "{problems:?}");
    let known = "observer: {sensors: {q: 0.1}, start: {a: 2}}\nsimulation: {step: 1, initial: {a: 1, q: 1}}";
    let (settings, problems) = derived(&format!("{plant}{known}"));
    let settings = settings.unwrap_or_else(|| panic!("{problems:?}"));
    let [start, noise, sensors] = numbers(&settings);
    assert!(!settings.output && close(&start, &[4.0]) && close(&sensors, &[0.1]), "{start:?} {sensors:?}");
    // The identity lets the output drive the cascade, `z' = -q`.
    assert!(close(&noise, &[0.01]), "{noise:?}");
}

/// A heat exchanger, whose phi has no left inverse at zero.
pub(crate) const EXCHANGER: &str = "
model: exchanger
parameters: {V: 1, rc: 4}
x: [Th, U]
y: [Tc]
u: [qh, qc, Thin, Tcin]
assume: [U > 0, V > 0, rc > 0]
f_x: {Th: qh/V*(Thin - Th) - U/(rc*V)*(Th - Tc), U: 0}
f_y: {Tc: qc/V*(Tcin - Tc) + U/(rc*V)*(Th - Tc)}
phi: [U, U*(Th + Tc)]
";

#[test]
fn an_extension_starts_where_the_left_inverse_has_a_value() {
    // Th = z2/z1 - Tc has no value at zero, and phi of a state that is zero is zero.
    let start = |rest: &str| {
        let (settings, problems) = derived(&format!("{EXCHANGER}{rest}"));
        let settings = settings.unwrap_or_else(|| panic!("{problems:?}"));
        settings.chi_0.iter().map(Rational::to_f64).collect::<Vec<_>>()
    };
    let gains = "observer: {gain: 1, filter: 1}\n";
    let scenario =
        "simulation: {step: 0.01, initial: {Th: 50, U: 3, Tc: 20}, control: {qh: 0.5, qc: 0.4, Thin: 60, Tcin: 15}}";
    // Half of where the plant starts: U = 1.5, Th = 25.
    assert_eq!(start(&format!("{gains}{scenario}")), [1.5, 67.5]);
    // The same for known numbers, in whose extension the output stands first.
    assert_eq!(start(scenario), [0.0, 1.5, 67.5]);
    // Without a start, a state of the domain at a distance of 1; the author's own start is kept.
    assert_eq!(start(gains), [1.0, 2.0]);
    assert_eq!(start("observer: {gain: 1, filter: 1, extension: [0, 0]}\n"), [0.0, 0.0]);
    // Half of it is not in this domain, twice is: U = 6.
    let far = EXCHANGER.replace("assume: [", "assume: [Th > 40, ");
    let (settings, _) = derived(&format!("{far}{gains}{scenario}"));
    assert_eq!(settings.unwrap().chi_0[0], Rational::from(6));
}

#[test]
fn noise_of_samples_that_drive_the_observer_needs_their_period() {
    let tank = "model: m\nx: [k]\ny: [h]\nu: [q]\nassume: [h > 0]\nf_x: {k: 0}\nf_y: {h: q - k*sqrt(h)}\nphi: [k]\n\
                observer: {sensors: {h: 0.01}, start: {k: 1}, disturbance: {k: 0}NOISE}\n\
                simulation: {STEPinitial: {k: 1, h: 2}, control: {q: 1}}\n";
    let said = |noise: &str, step: &str| derived(&tank.replace("NOISE", noise).replace("STEP", step));
    assert!(said("", "step: 0.1, ").0.is_some());
    let (_, problems) = said("", "");
    let message = "the process noise of `m` depends on the period of its samples";
    assert!(problems.iter().any(|problem| &*problem.message == message && problem.help.is_some()), "{problems:?}");
    // An output that only its own equation needs drives nothing.
    let plain = tank.replace("q - k*sqrt(h)", "q - k").replace("NOISE", "").replace("STEP", "");
    assert!(derived(&plain).0.is_some());
}

#[test]
fn the_extension_begins_where_the_plant_is_known_to_start() {
    let cart = "model: m\nparameters: {m: 2, l: 0.25}\nx: [p, d]\ny: [v]\nu: [F]\nf_x: {p: v, d: 0}\nf_y: {v: (F + d)/m}\n\
                phi: [2*p, d]\nknown: {p: 3*l}\n";
    let scenario = "simulation: {step: 0.01, initial: {d: 0.3, v: 0}, control: {F: 0}}\n";
    let (settings, problems) = derived(&format!("{cart}{scenario}"));
    let settings = settings.unwrap_or_else(|| panic!("{problems:?}"));
    // Of the output form, in which the output stands first.
    assert_eq!(settings.chi_0, [Rational::from(0), Rational::new(3, 2).unwrap(), Rational::from(0)]);
    let Estimator::AdaptiveLeastSquares(Covariance { start, .. }, _) = &settings.estimator else {
        panic!("{settings:?}")
    };
    let [sensor, known, unknown] = [0, 1, 2].map(|place| start[place].to_f64());
    // As good as exact, and no zero, of which there is no inverse: a share of 1e-12, with room for rounding.
    assert!(known > 0.0 && known <= 2e-12 * sensor.min(unknown), "{start:?}");
    let gains = "observer: {estimator: least-squares, covariance: 1, filter: 10}\n";
    assert_eq!(derived(&format!("{cart}{gains}")).0.unwrap().chi_0, [Rational::new(3, 2).unwrap(), Rational::from(0)]);
    for (observer, key) in [
        ("{extension: [0, 0]}", "`extension`"),
        ("{gap: 1}", "`gap`"),
        ("{estimator: drem, gain: 1, regressor_gain: 1, filter: 10}", "`estimator`"),
    ] {
        let (settings, problems) = derived(&format!("{cart}{scenario}observer: {observer}\n"));
        assert!(settings.is_none() && problems[0].message.starts_with(key), "{observer}: {problems:?}");
    }
    let (settings, problems) = derived(&format!("{cart}{gains}").replace("l: 0.25", "l: null"));
    assert!(settings.is_none() && problems[0].message.contains("`l`, which has no value"), "{problems:?}");
}

const EXPONENT: &str = "model: exponent\nx: [n]\ny: [v]\nu: [F]\nf_x: {n: 0}\nf_y: {v: F - exp(n*v)}\nphi: [n]\nregression: monotone\n\
                        simulation: {step: 0.01, initial: {n: 1, v: 1}, control: {F: 3}}\n";

/// A monotone regression has the gradient on single samples, from slopes of e = 2.718 here: of a speed of 5 in a thousand
/// samples, or of that at which noise and drift add the least, `cbrt(q^2 e^2/(4 s^2))`.
#[test]
fn a_monotone_regression_has_a_normalised_gradient() {
    let square = std::f64::consts::E.powi(2);
    for (observer, speed) in [
        ("", 0.5_f64),
        ("observer: {sensors: {v: 0.01}, start: {n: 1}, disturbance: {n: 0.1}}\n", (square * 0.01 / 4e-4).cbrt()),
        // Ten samples to a time constant at least.
        ("observer: {sensors: {v: 1e-6}, start: {n: 1}, disturbance: {n: 1}}\n", 10.0),
    ] {
        let (settings, problems) = derived(&format!("{EXPONENT}{observer}"));
        let settings = settings.unwrap_or_else(|| panic!("{problems:?}"));
        let Estimator::NormalisedGradient { gain, mu } = &settings.estimator else { panic!("{settings:?}") };
        // In four digits.
        let is_near = |value: &Rational, wanted: f64| (value.to_f64() / wanted - 1.0).abs() < 1e-3;
        assert!(is_near(mu, 100.0 / square) && is_near(&gain[0], 101.0 * speed / square), "{gain:?} {mu:?}");
        assert_eq!(
            (settings.operator, settings.rebase),
            (Operator::Window(Rational::ONE), Some(Rebase::Samples(Rational::ONE)))
        );
    }
}

#[test]
fn settings_with_memory_do_not_go_with_a_monotone_regression() {
    for (key, section) in [
        ("filter", "{filter: 10, gain: 1}"),
        ("window", "{window: 5, gain: 1}"),
        ("covariance", "{estimator: least-squares, window: 1, covariance: [1]}"),
        ("gate", "{sensors: {v: 0.1}, gate: 25}"),
        ("form", "{form: output}"),
        ("rebase", "{window: 1, gain: 1, rebase: 5}"),
    ] {
        let (settings, problems) = derived(&format!("{EXPONENT}observer: {section}\n"));
        let said: Vec<&str> = problems.iter().map(|problem| &*problem.message).collect();
        assert!(
            settings.is_none() && said.len() == 1 && said[0].starts_with(&format!("`{key}`")),
            "{section}: {said:?}"
        );
    }
    let (_, problems) = derived(&format!("{EXPONENT}observer: {{gain: 1}}\n"));
    assert!(problems[0].help.as_ref().is_some_and(|help| help.contains("`window: 1`")), "{problems:?}");
    let (settings, problems) = derived(&format!("{EXPONENT}observer: {{window: 1, gain: 1}}\n"));
    assert!(settings.is_some() && problems.is_empty(), "{problems:?}");
}

//! Model files, right and wrong.

mod hostile;
mod mistakes;
mod settings;
mod time;

use super::{Baseline, CascadeClass, Estimator, Hold, Model, Scale};
use crate::source::{Diagnostic, Source};

/// The design's example.
const CUK: &str = "\
model: cuk
title: DC-DC Cuk converter, inductor currents from capacitor voltages
parameters: {L1: 10e-3, C2: 22e-6, L3: 10e-3, C4: 22.9e-6, G: 0.0447, E: 12}
x: [i1, i3]
y: [v2, v4]
u: [d]
assume: [L1 > 0, 0 < d < 1]
f_x: {i3: -(d*v2 + v4)/L3, i1: (E - (1 - d)*v2)/L1}
f_y: {v2: ((1 - d)*i1 + d*i3)/C2, v4: (i3 - G*v4)/C4}
phi: [i1, i3]
";

/// Every key of the schema, but for those of other estimators.
const REST: &str = "\
reference: a paper
w: [omega]
class: gpebo
define: {p: v2*i1}
phi_left: {i3: z2}
g_y: {v4: i1 + d}
identities: [i1 - i1]
angles: {i1: 2*pi}
units: {i1: A, v2: V, L1: H}
observer: {estimator: gradient, gain: 1e7, bounds: {lower: -1, upper: [2, 3]}, within: {lower: 0, upper: [4, 5]}, filter: 500, hold: first-order, limits: {v2: [-50, 50], d: [0, 1]}, gap: 1e-3, extension: [0, 1]}
simulation:
  duration: 0.5
  step: 1e-6
  initial: {i1: 0, v2: E}
  signals: {V_d: {0: 25, 0.2: 30*t}, V: 1}
  noise: {v2: 0.1}
  bias: {v2: -0.5}
  quantisation: {v4: 0.05}
  delay: {v2: 2e-6}
  jitter: 0.3
  dropped: 0.2
  plant: {E: {0: 12, 0.25: 13}}
  define: {power: V_d*hat(i1)}
  control: {d: V_d/(V_d + E)}
  feedback: copy
  baselines:
    copy:
      state: {a: -a + v2 - hat(i1)}
      initial: {a: v2}
      estimate: {i1: a}
    kalman: {sensors: {v2: 0.1, v4: 0.2}, start: {i1: 1}, disturbance: {i1: 1, v2: 2}, initial: {i1: v2}}
    luenberger: {poles: [-1, -2], initial: {i1: 1}}
  panels:
    - {title: error, unit: A, curves: [hat(i1) - i1, v2], scale: log}
    - {title: duty, curves: [d]}
recording: {t: time/1000, v2: ch1/256 - 2*L1, d: duty}
";

fn source(text: &str) -> Source {
    Source::new("model.yaml", text).expect("the text is small")
}

fn parse(text: &str) -> Result<Model, Vec<Diagnostic>> {
    Model::parse(&source(text))
}

#[test]
fn the_example_is_read() {
    let model = parse(CUK).expect("it is right");
    assert_eq!(model.name.value, "cuk");
    let names: Vec<&str> = model.names().map(|name| name.value.as_str()).collect();
    assert_eq!(names, ["L1", "C2", "L3", "C4", "G", "E", "i1", "i3", "v2", "v4", "d"]);
    let rates: Vec<&str> = model.f_x.iter().map(|entry| entry.name.value.as_str()).collect();
    assert_eq!(rates, ["i1", "i3"], "rates are in the order of x");
    let value = model.parameters[0].value.as_ref().map(|value| value.value.text());
    assert_eq!(value, Some("10e-3"));
    assert!(model.phi_left.is_empty() && model.simulation.is_none());
}

#[test]
fn every_key_is_read() {
    let model = parse(&(CUK.to_owned() + REST)).expect("it is right");
    assert_eq!(model.phi_left[0].name.value, "i3");
    assert_eq!(model.observer.gain[0].value.text(), "1e7");
    assert_eq!(model.observer.hold.map(|hold| hold.value), Some(Hold::FirstOrder));
    assert_eq!(model.observer.extension.len(), 2);
    assert_eq!((model.observer.within.lower.len(), model.observer.within.upper.len()), (1, 2));
    assert_eq!(model.cascade_class.map(|class| class.value), Some(CascadeClass::Gpebo));
    let simulation = model.simulation.expect("it is there");
    let starts: Vec<f64> = simulation.signals[0].value.iter().map(|piece| piece.from.value.to_f64()).collect();
    assert_eq!(starts, [0.0, 0.2]);
    assert_eq!(simulation.signals[1].value.len(), 1);
    assert_eq!(simulation.noise[0].value.value.text(), "0.1");
    assert_eq!(simulation.bias[0].value.value.text(), "-0.5");
    assert_eq!(simulation.quantisation[0].name.value, "v4");
    let delay = |output: &str| simulation.delay.of(output).map(|delay| delay.value.text());
    assert_eq!((delay("v2"), delay("v4")), (Some("2e-6"), None));
    assert_eq!(simulation.jitter.as_ref().map(|share| share.value.text()), Some("0.3"));
    assert_eq!(simulation.dropped.as_ref().map(|share| share.value.text()), Some("0.2"));
    assert_eq!(simulation.plant[0].value.len(), 2);
    let [copy, kalman, luenberger] = simulation.baselines.as_slice() else { panic!("three baselines") };
    assert_eq!(copy.value.equations().map(|equations| equations.state.len()), Some(1));
    assert!(matches!(&kalman.value, Baseline::Kalman(filter) if filter.start.len() == 1));
    assert!(matches!(&luenberger.value, Baseline::Luenberger(observer) if observer.poles.len() == 2));
    let scales: Vec<Scale> = simulation.panels.iter().map(|panel| panel.scale.value).collect();
    assert_eq!(scales, [Scale::Log, Scale::Linear]);
    let recording = model.recording.expect("it is there");
    assert!(recording.t.is_some() && recording.step.is_none());
    assert_eq!(recording.of_signal("v2").map(|entry| entry.value.names()[0].0), Some("ch1"));
}

#[test]
fn every_estimator_has_its_settings() {
    let sections = [
        "gain: 2",
        "estimator: normalised-gradient, gain: [2, 3], normalisation: 0",
        "estimator: least-squares, covariance: 1e6, process_noise: [0, 1], window: 100, rebase: 10",
        "estimator: drem, gain: 1, regressor_gain: 3, forgetting: 0",
        "estimator: finite-time-drem, gain: 1, regressor_gain: [3, 4], forgetting: 5, clip: 0.1, period: 0.01",
        "estimator: gradient-drem, gain: 1, regressor_gain: 3",
        "estimator: least-squares-drem, gain: 1, covariance: [3, 3], forgetting: 10",
    ];
    for (section, estimator) in sections.iter().zip(Estimator::ALL) {
        let observer = parse(&format!("{CUK}observer: {{{section}}}\n")).expect(section).observer;
        assert_eq!(observer.estimator(), estimator, "{section}");
        for key in estimator.needs() {
            assert!(observer.span_of(key).is_some(), "{section}: {key}");
        }
    }
    for (estimator, name) in Estimator::ALL.iter().zip(Estimator::NAMES) {
        assert_eq!(estimator.name(), *name);
    }
}

#[test]
fn every_name_and_formula_has_its_span() {
    let text = CUK.to_owned() + REST;
    let source = source(&text);
    let model = Model::parse(&source).expect("it is right");
    for name in model.names() {
        assert_eq!(source.slice(name.span), name.value);
    }
    let rates = model.f_x.iter().chain(&model.f_y).chain(&model.g_y).chain(&model.define);
    for (name, span) in rates.flat_map(|entry| entry.value.names()) {
        assert_eq!(source.slice(span), name);
    }
    assert_eq!(source.slice(model.phi[1].span), "i3");
    assert_eq!(source.slice(model.assume[1].span), "0 < d < 1");
}

#[test]
fn parameters_may_lack_values() {
    for parameters in ["[L, R]", "{L: null, R: ~}", "{L: , R: }", "{L, R}"] {
        let text = format!("model: m\nx: [a]\ny: [v]\nparameters: {parameters}\nf_x: {{a: v/L}}\nphi: [a]\n");
        let model = parse(&text).expect(parameters);
        assert_eq!(model.parameters.len(), 2, "{parameters}");
        assert!(model.parameters.iter().all(|entry| entry.value.is_none()), "{parameters}");
    }
}

#[test]
fn names_are_free() {
    // Functions, constants, words of Rust and of YAML, names that differ in case only.
    let names = "[E, I, S, e, N, n, sin, hat, pi, t, fn, self, gen, y, no, theta, z, z1a, chi_1]";
    let text = format!("model: type\nx: [a]\ny: [v]\nw: {names}\nf_x: {{a: sin*pi}}\nphi: [a]\n");
    assert_eq!(parse(&text).map(|model| model.w.len()), Ok(19));
}

#[test]
fn formulas_may_be_blocks() {
    let text = "model: m\nx: [a]\ny: [v]\nf_x:\n  a: |\n    v +\n      v2x\nphi:\n- >-\n  a +\n  v\n";
    let source = source(text);
    let model = Model::parse(&source).expect("it is right");
    let places: Vec<&str> = [&model.f_x[0].value, &model.phi[0]]
        .into_iter()
        .flat_map(|formula| formula.names())
        .map(|(_, span)| source.slice(span))
        .collect();
    assert_eq!(places, ["v", "v2x", "a", "v"]);
}

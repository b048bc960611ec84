//! Plants that say nothing of their observer: the models of the project without that section, and the plants of
//! `tests/cases/plants` with a scenario that was made up for each.

use std::io;
use std::path::{Path, PathBuf};

/// Scenarios for plants without one.
const SCENARIOS: &[(&str, &str)] = &[
    (
        "battery",
        "
g_y: {W: a0 + a1*soc - v1 - v2}
simulation:
  duration: 3600
  step: 1
  initial: {soc: 0.9, v1: 0, v2: 0.02}
  control: {I: 1*sin(2*pi*t/600)^2 + 0.5*sin(2*pi*t/90)}
",
    ),
    (
        "bearing_only",
        "
simulation:
  duration: 2400
  # The inputs are held for a step, and the bearing is what its rate adds up to with them: at 1 s it errs by more than the
  # observer is told of its sensor.
  step: 0.1
  initial: {px: 4000, py: 2000, vx: -1, vy: 4, beta: 'atan2(2000, 4000)'}
  define: {course: sin(2*pi*t/300)}
  signals: {turn: 2*pi/300}
  control: {ox: 5/turn*(1 - cos(2*pi*t/300)), oy: 3*t, ovx: 5*course, ovy: 3}
",
    ),
    (
        "boost_resistive",
        "
simulation: {duration: 0.1, step: 1e-5, initial: {i: 1, v: 20}, control: {d: 0.5}}
",
    ),
    (
        "dc_motor_load",
        "
simulation: {duration: 1, step: 1e-4, initial: {i: 0, TL: 0.1, w: 0}, control: {V: 12}}
",
    ),
    (
        "flyback",
        "
simulation:
  duration: 0.2
  step: 1e-5
  initial: {im: 1.5, G: 0.5, v: 7.5}
  control: {d: 0.4 + 0.02*sin(2*pi*100*t)}
",
    ),
    (
        "hydraulic_cylinder",
        "
simulation:
  duration: 2
  step: 1e-4
  initial: {v: 0.05, load: 2000, p1: 2.2e6, p2: 2e6, s: 0.2}
  define: {v_d: 0.1*sin(2*pi*t) + 5*(0.2 + 0.1/(2*pi)*(1 - cos(2*pi*t)) - s)}
  control: {q1: A1*v_d, q2: A2*v_d}
",
    ),
    (
        "three_phase_motor",
        "
simulation:
  duration: 0.2
  step: 1e-5
  initial: {q: 0.3, i1: 0, i2: 0, i3: 0, omega: 0}
  control: {v1: 10*cos(50*t), v2: 10*cos(50*t - 2*pi/3), v3: 10*cos(50*t + 2*pi/3)}
",
    ),
    (
        "wind_turbine",
        "
simulation:
  duration: 60
  step: 0.01
  initial: {wr: 1.2, Ta: 8e5, wg: 106.2, ts: 0.3}
  control: {Tg: 9040*(1 + 0.05*sin(0.5*t))}
",
    ),
    (
        "pendulum",
        "
simulation: {duration: 4, step: 1e-4, initial: {p: 0.5, q: 1}, control: {tau: 0}}
",
    ),
];

/// A plant with its scenario and without its observer.
pub(crate) struct Case {
    /// The path of its file, without its folder's beginning and its suffix.
    pub(crate) name: String,
    /// The model file.
    pub(crate) text: String,
}

/// All of them, in the order of their names; or those that are wanted.
pub(crate) fn cases(wanted: &[&str]) -> io::Result<Vec<Case>> {
    let workspace = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let mut cases = Vec::new();
    for (folder, place) in [("models", "models"), ("plants", "tests/cases/plants")] {
        let mut paths: Vec<PathBuf> =
            workspace.join(place).read_dir()?.map(|entry| Ok(entry?.path())).collect::<io::Result<_>>()?;
        paths.retain(|path| path.extension().is_some_and(|e| e == "yaml"));
        paths.sort();
        for path in paths {
            let stem = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
            let name = format!("{folder}/{stem}");
            if wanted.is_empty() || wanted.contains(&name.as_str()) {
                cases.push(Case { text: complete(&stem, &std::fs::read_to_string(&path)?), name });
            }
        }
    }
    Ok(cases)
}

/// A model file without its section `observer`, with a scenario if it has none.
fn complete(stem: &str, text: &str) -> String {
    let mut inside = false;
    let kept = text.lines().filter(|line| {
        if !line.starts_with([' ', '#']) {
            inside = line.starts_with("observer:");
        }
        !inside
    });
    let text: String = kept.flat_map(|line| [line, "\n"]).collect();
    let added = SCENARIOS.iter().find(|(plant, _)| *plant == stem && !text.contains("\nsimulation:"));
    text + added.map_or("", |(_, scenario)| scenario)
}

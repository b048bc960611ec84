use crate::closed_loop::sheet::draw;
use crate::figure::curve::Curve;
use crate::{Overrides, Scenario};

use super::{CUK_CASE_2, SPRING, resolve, with};

fn figure(scenario: &Scenario) -> String {
    draw(&scenario.run().unwrap(), scenario)
}

/// Checks that every element is closed in its order, every attribute quoted, every entity known.
fn assert_well_formed(svg: &str) {
    let mut open = Vec::new();
    let mut rest = svg;
    while let Some(start) = rest.find('<') {
        let text = &rest[..start];
        assert!(!text.contains('>'), "{text}");
        for entity in text.split('&').skip(1) {
            assert!(["amp;", "lt;", "gt;"].iter().any(|known| entity.starts_with(known)), "{entity}");
        }
        let end = start + rest[start..].find('>').unwrap();
        let tag = &rest[start + 1..end];
        assert_eq!(tag.matches('"').count() % 2, 0, "{tag}");
        assert!(!tag.contains('<') && !tag.contains('&'), "{tag}");
        let name = |tag: &str| tag.split_whitespace().next().unwrap().to_owned();
        match (tag.strip_prefix('/'), tag.strip_suffix('/')) {
            (Some(closed), _) => assert_eq!(open.pop().as_deref(), Some(closed)),
            (None, Some(_)) => {}
            (None, None) => open.push(name(tag)),
        }
        rest = &rest[end + 1..];
    }
    assert!(open.is_empty(), "{open:?}");
    assert!(!svg.contains("NaN") && !svg.contains("inf"));
}

#[test]
fn a_figure_is_well_formed_and_always_the_same() {
    let scenario = resolve(CUK_CASE_2, &Overrides { duration: Some(0.05), ..Overrides::default() }).unwrap();
    let svg = figure(&scenario);
    assert_well_formed(&svg);
    assert_eq!(svg, figure(&scenario));
    for text in ["î", "v\u{302}", "(immersion)", "Duty cycle", ">in ms</tspan>"] {
        assert!(svg.contains(text), "{text}");
    }
}

#[test]
fn the_usual_panels_and_odd_titles_are_drawn() {
    let text = with(SPRING, "model: spring", "model: spring\ntitle: \"a < b & \\u0007 c\"");
    let svg = figure(&resolve(&text, &Overrides::default()).unwrap());
    assert_well_formed(&svg);
    assert!(svg.contains("Estimate of v") && svg.contains("Estimation errors"));
    assert!(svg.contains("Outputs") && !svg.contains("Inputs") && !svg.contains("fill-opacity"));
    // Under noise an error is shown as it is, one without a unit by itself; known numbers have a standard error.
    let (plant, loop_) = (SPRING.split("observer:").next().unwrap(), SPRING.split("simulation:").nth(1).unwrap());
    let numbers = "observer: {sensors: {q: 0.01}, start: {v: 1}, disturbance: {v: 0}}";
    let text = with(&format!("{plant}{numbers}\nsimulation:{loop_}"), "q: 1}", "q: 1}, noise: {q: 0.01}");
    let svg = figure(&resolve(&text, &Overrides::default()).unwrap());
    assert_well_formed(&svg);
    assert!(svg.contains("Error of v") && !svg.contains("Estimation errors") && svg.contains("fill-opacity"));
}

#[test]
fn no_text_of_several_runs_is_anchored() {
    let text = with(SPRING, "q: 1}", "q: 1}, panels: [{title: e, curves: [hat(v) - v], scale: log}]");
    let svg = figure(&resolve(&text, &Overrides::default()).unwrap());
    let texts: Vec<&str> = svg.lines().filter(|line| line.starts_with("<text")).collect();
    assert!(texts.iter().any(|text| text.contains("<tspan")) && texts.iter().any(|text| text.contains("anchor")));
    assert!(!texts.iter().any(|text| text.contains("<tspan") && text.contains("anchor")), "{texts:#?}");
}

#[test]
fn long_texts_widen_the_page() {
    let wide = "W".repeat(60);
    let title = with(SPRING, "model: spring", &format!("model: spring\ntitle: {wide}"));
    let heading = with(SPRING, "q: 1}", &format!("q: 1}}, panels: [{{title: {wide}, unit: m, curves: [q]}}]"));
    for text in [title, heading] {
        let svg = figure(&resolve(&text, &Overrides::default()).unwrap());
        let page = svg.split("viewBox=\"0 0 ").nth(1).and_then(|rest| rest.split(' ').next()).unwrap();
        // An em a letter of 12 points.
        assert!(page.parse::<f64>().unwrap() > 60.0 * 12.0, "{page}");
    }
}

#[test]
fn units_stand_with_the_axis_or_beside_the_curves() {
    let drawn = |units: &str| {
        let text = with(SPRING, "model: spring", &format!("model: spring\nunits: {units}"));
        let svg = figure(&resolve(&text, &Overrides::default()).unwrap());
        svg.split('<').filter_map(|part| Some(part.split_once('>')?.1)).collect::<String>()
    };
    assert!(drawn("{q: m}").contains("Outputs in m"));
    assert!(!drawn("{v: m/s}").contains("Outputs in"));
    // Signals of two units are not drawn on one linear axis.
    let text = with(SPRING, "model: spring\nx: [v]", "model: spring\nunits: {a: m^3/s, b: K}\nu: [a, b]\nx: [v]");
    let text = with(&text, "q: 1}", "q: 1}, control: {a: 1e-4, b: 300}");
    let svg = figure(&resolve(&text, &Overrides::default()).unwrap());
    assert_eq!(svg.matches(">Inputs in ").count(), 2, "{svg}");
    // The model's own panels without their units: those of the curves, unless one has none.
    let text = super::CUK.replace(", unit: A", "").replace(", unit: V", "");
    let svg = figure(&resolve(&text, &Overrides { duration: Some(1e-3), ..Overrides::default() }).unwrap());
    let said: String = svg.split('<').filter_map(|part| Some(part.split_once('>')?.1)).collect();
    assert!(said.contains("Estimation errors in A") && !said.contains("reference in"), "{said}");
}

#[test]
fn a_curve_of_many_samples_stays_small() {
    // Noise: every span of time has its own extremes.
    let panel =
        "panels: [{title: noise, curves: [\"sin(1e5*t^2)\", \"1/(t - 5)\", \"sqrt(t - 5)\", \"0\", \"1e-9*q\"]}], ";
    let text = with(SPRING, "simulation: {", &format!("simulation: {{{panel}"));
    let svg = figure(&resolve(&text, &Overrides { step: Some(1e-4), ..Overrides::default() }).unwrap());
    assert_well_formed(&svg);
    // Three thousand points of some fifteen bytes for the noise.
    assert!(svg.len() < 60_000, "{}", svg.len());
}

#[test]
fn no_extreme_is_lost() {
    let mut curve = Curve::default();
    let samples = 100_000;
    for sample in 0..=samples {
        let t = f64::from(u32::try_from(sample).unwrap());
        let value = match sample {
            54_321 => 7.0,
            54_322 => -3.0,
            77_777 => f64::NAN,
            _ => 0.5,
        };
        curve.add(sample, samples, (t, value));
    }
    let points = curve.finish();
    assert!(points.len() < 2500, "{}", points.len());
    assert!(points.windows(2).all(|pair| pair[0].0 < pair[1].0));
    assert!(points.contains(&(54_321.0, 7.0)) && points.contains(&(54_322.0, -3.0)));
    assert_eq!(points.first(), Some(&(0.0, 0.5)));
    assert_eq!(points.last(), Some(&(1e5, 0.5)));
    assert!(points.iter().any(|point| point.1.is_nan()));
}

//! A setting of a call means the same as in the file; its refusal points into the call's own text.

use super::{CUK, Model, REST, parse};
use crate::source::Code::{self, *};
use crate::source::{Colour, Diagnostic, Source, render};

fn source(text: &str, settings: &[&str]) -> Source {
    Source::new("m.yaml", text).and_then(|source| source.set(settings)).unwrap()
}

fn set(text: &str, settings: &[&str]) -> Result<Model, Vec<Diagnostic>> {
    Model::parse(&source(text, settings))
}

/// The model without spans.
fn without_spans(model: &Model) -> String {
    let text = format!("{model:?}");
    let mut parts = text.split("Span {");
    let first = parts.next().unwrap_or_default().to_owned();
    first + &parts.map(|part| part.split_once('}').map_or("", |(_, rest)| rest)).collect::<String>()
}

#[test]
fn a_setting_is_what_the_file_would_say() {
    let text = CUK.to_owned() + REST;
    let cases = [
        ("L1=5e-3", "L1: 10e-3", "L1: 5e-3"),
        ("parameters.L1 = 5e-3", "L1: 10e-3", "L1: 5e-3"),
        ("class=pebo", "class: gpebo", "class: pebo"),
        ("simulation.step=1e-5", "step: 1e-6", "step: 1e-5"),
        ("simulation.noise.v2=0.3", "noise: {v2: 0.1}", "noise: {v2: 0.3}"),
        ("simulation.noise.v4=0.3", "noise: {v2: 0.1}", "noise: {v2: 0.1, v4: 0.3}"),
        ("simulation.every.v4=10", "dropped: 0.2", "dropped: 0.2\n  every: {v4: 10}"),
        ("simulation.plant.E={0: 12, 0.3: 14}", "{0: 12, 0.25: 13}", "{0: 12, 0.3: 14}"),
        ("simulation.plant.E=atan2(1, 2)", "{0: 12, 0.25: 13}", "\"atan2(1, 2)\""),
        ("simulation.initial.v2=2*E", "v2: E}", "v2: 2*E}"),
        ("simulation.signals.omega=sin(t)", "V: 1}", "V: 1, omega: sin(t)}"),
        ("simulation.baselines.kalman.start.i1=2", "start: {i1: 1}", "start: {i1: 2}"),
        ("observer.bounds.upper=[4, 5]", "upper: [2, 3]", "upper: [4, 5]"),
        ("f_x.i3=-v4/L3", "i3: -(d*v2 + v4)/L3", "i3: -v4/L3"),
    ];
    for (setting, from, to) in cases {
        assert!(text.contains(from), "{from}");
        let written = parse(&text.replacen(from, to, 1)).unwrap_or_else(|found| panic!("{to}: {found:#?}"));
        let called = set(&text, &[setting]).unwrap_or_else(|found| panic!("{setting}: {found:#?}"));
        assert_eq!(without_spans(&called), without_spans(&written), "{setting}");
    }
    // The last of two counts; a list of parameters has room for values.
    let listed =
        CUK.replace("{L1: 10e-3, C2: 22e-6, L3: 10e-3, C4: 22.9e-6, G: 0.0447, E: 12}", "[L1, C2, L3, C4, G, E]");
    let value = |name: &str, model: &Model| {
        let entry = model.parameters.iter().find(|entry| entry.name.value == name);
        entry.and_then(|entry| entry.value.as_ref()).map(|number| number.value.text().to_owned())
    };
    let model = set(&listed, &["L1=1", "G=2", "L1=3"]).unwrap();
    assert_eq!((value("L1", &model), value("G", &model)), (Some("3".to_owned()), Some("2".to_owned())));
    assert_eq!(value("E", &model), None);
    assert_eq!(value("L1", &set(CUK, &["L1=null"]).unwrap()), None);
}

#[test]
fn a_refused_setting_is_reported_in_the_call() {
    let text = CUK.to_owned() + REST;
    let cases: &[(&str, Code, &str, &str)] = &[
        ("L1", WrongShape, "L1", "`NAME=VALUE`"),
        ("=1", WrongShape, "", "`NAME=VALUE`"),
        ("simulation..step=1", WrongShape, "", "`NAME=VALUE`"),
        ("L1=", WrongShape, "", "value behind"),
        ("L1=fast", MalformedNumber, "fast", ""),
        ("l1=5e-3", UnknownName, "l1", "`L1`?"),
        ("M=5e-3", UnknownName, "M", "one of `L1`"),
        ("parameters.L11=1", UnknownName, "L11", "`L1`?"),
        ("i1=1", UnknownName, "i1", "`simulation.initial.i1`"),
        ("noise.v2=0.1", UnknownName, "noise.v2", "`simulation.noise.v2`?"),
        ("duration=1", UnknownName, "duration", "`simulation.duration`?"),
        ("simulatoin.step=1", UnknownName, "simulatoin", "`simulation`?"),
        ("simulation.nois.v2=0.1", UnknownKey, "nois", "`noise`?"),
        ("simulation.noise.v3=0.1", UnknownEntry, "v3", "`v2`?"),
        ("simulation.noise.v2=-1", NumberOutOfRange, "-1", ""),
        ("simulation.signals.V_e=1", UnknownName, "V_e", "`V_d`?"),
        ("simulation.step.v2=1", WrongShape, "v2", "the whole"),
        ("observer.gain.i1=1", WrongShape, "i1", "the whole"),
        ("observer.gain=[1", YamlSyntax, "", "bracket"),
        ("observer.estimator=gradientt", WrongChoice, "gradientt", "`gradient`?"),
        ("simulation.plant.E=12 +", UnexpectedToken, "", ""),
        ("simulation.plant={E: atan2(1, 2)}", UnclosedParenthesis, "atan2(1, 2)", "quotes"),
    ];
    for (setting, code, blamed, help) in cases {
        let source = source(&text, &["title=another", setting]);
        let found = Model::parse(&source).expect_err(setting);
        assert_eq!(found.len(), 1, "{setting}: {found:#?}");
        let first = &found[0];
        assert_eq!((first.code, source.slice(first.primary.span)), (*code, *blamed), "{setting}: {found:#?}");
        assert!(first.help.as_deref().is_some_and(|text| text.contains(help)), "{setting}: {found:#?}");
        let picture = render(&found, &source, Colour::Never);
        assert!(picture.contains("--> the call:2:") && picture.contains("| --set "), "{picture}");
        assert!(picture.contains(setting), "{picture}");
    }
    // A mistake in the file, and one in both.
    let source = source(&text.replace("gain: 1e7", "gain: 1e7, window: 5"), &["observer.window=7"]);
    let picture = render(&Model::parse(&source).expect_err("both"), &source, Colour::Never);
    assert!(picture.contains("m.yaml:") && picture.contains("the call:1:"), "{picture}");
}

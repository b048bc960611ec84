//! Certificates state the plant in its author's words, and there is none without a proof. That they prove and that they
//! fail when a claim is false, `tests/oracle/certificates.py` shows with `SymPy`, of every shipped model.

use pebo_gen::source::Source;
use pebo_gen::{Request, Standing, answer};

fn certificate(text: &str) -> (Standing, Option<String>) {
    let source = Source::new("m.yaml", text).unwrap();
    let answer = answer(&source, &Request::new().certificate());
    (answer.standing, answer.certificate)
}

/// The script before its common part.
fn stated(text: &str) -> String {
    let script = certificate(text).1.expect("it is accepted");
    let (stated, checker) = script.split_once("\nimport contextlib\n").expect("a checker");
    assert!(checker.contains("sys.exit"));
    stated.to_owned()
}

#[test]
fn the_plant_is_restated_as_its_author_wrote_it() {
    let stated = stated(
        "model: m\ntitle: A \"first\" plant\nparameters: {k: 10e-3, c: null}\nx: [p]\ny: [q]\nu: [v]\nassume: [k > 0, 0 < q < 2]\n\
         define: {s: k*(q+1)}\nf_x: {p: v - s**2/(2*c)}\nf_y: {q: p/k/2}\nphi: [p]\n",
    );
    for line in [
        "\"\"\"Certificate of `m`: A  first  plant",
        "    \"parameters\": {\"k\": \"10e-3\", \"c\": None},",
        "    \"define\": {\"s\": \"k*(q + 1)\"},",
        "    \"assume\": [\"k > 0\", \"0 < q < 2\"],",
        "    \"f_x\": {\"p\": \"v - s^2/(2*c)\"},",
        "    \"f_y\": {\"q\": \"p/k/2\"},",
        "    \"phi\": [\"p\"],",
        "    \"y'\": [\"q\"],",
        "    \"conditions\": [\"c != 0\"],",
    ] {
        assert!(stated.lines().any(|have| have == line), "{line}\n{stated}");
    }
}

#[test]
fn a_class_is_restated_by_its_matrices() {
    let stated = stated(
        "model: m\nparameters: [a, k, m1]\nassume: [m1 > 0]\nx: [p]\ny: [q]\nu: [f]\n\
         mechanical: {M: m1, V: k*q^2/2, G: [1], T: 1}\n",
    );
    let line = "    \"mechanical\": {\"M\": \"m1\", \"G\": [\"1\"], \"V\": \"k*q^2/2\"},";
    assert!(stated.lines().any(|have| have == line) && !stated.contains("f_x"), "{stated}");
}

#[test]
fn what_is_said_of_trajectories_is_stated_as_data() {
    // Nothing is seen while a < 0.
    let half = stated("model: m\nx: [k]\ny: [r]\nu: [a]\nf_x: {k: 0}\nf_y: {r: 'k*max(0, a)'}\nphi: [1/k]\n");
    let cell = "{\"while\": \"a < 0\", \"positive\": [\"-a\"], \"hidden\": [[\"1\"]]}";
    assert!(half.contains("\"identifiability\": \"excitation\"") && half.contains(cell), "{half}");
    // With no current, as at rest, one sum alone is seen, and with another constant input all is.
    let battery =
        stated("model: m\nx: [s, h]\ny: [V]\nu: [I]\nf_x: {s: I, h: -abs(I)*h}\nf_y: {V: s + h}\nphi: [s, h]\n");
    let still = "\"zero\": [\"I\"], \"identified\": [\"z1 + z2\"], \"hidden\": [[\"-1\", \"1\"]]}";
    let motion = "\"by itself\": True,\n        \"at rest\": False,";
    assert!(battery.contains(still) && battery.contains(motion), "{battery}");
    let growth = stated(
        "model: m\nx: [a, k]\ny: [s]\nassume: [a > 0]\nf_x: {a: (s - 1)*a, k: 0}\nf_y: {s: k - a}\nphi: [a, k]\n",
    );
    assert!(growth.contains("\"rest\": True, \"identified\": [\"z2 - z1\"]"), "{growth}");
    let motor = stated(include_str!("../../../models/motor_flux.yaml"));
    assert!(motor.contains("\"zero\": [\"omega\"]") && !motor.contains("undecided\": [{"), "{motor}");
    // Of what is undecided nothing is claimed.
    let turned = stated(
        "model: m\nx: [p, s]\ny: [q]\nu: [v, r]\nf_x: {p: 0, s: 0}\nf_y: {q: p*(1 - cos(v)) + s*r}\nphi: [p, s]\n",
    );
    assert!(turned.contains("\"undecided\": [{\"zero\": [\"cos(v) - 1\"]}]"), "{turned}");
}

#[test]
fn there_is_none_of_a_model_that_is_not_accepted() {
    let wrong = "model: m\nx: [p]\ny: [q]\nf_x: {p: -p^2 + q*sin(p)}\nf_y: {q: p}\nphi: [p]\n";
    let (standing, script) = certificate(wrong);
    assert!(standing == Standing::Refused && script.is_none(), "{standing:?}");
    assert_eq!(certificate("model: m\nx: [p]\n").1, None);
}

#[test]
fn every_shipped_model_has_one() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../models");
    let mut models = 0;
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|extension| extension == "yaml") {
            let text = std::fs::read_to_string(&path).unwrap();
            assert!(certificate(&text).1.is_some(), "{}", path.display());
            models += 1;
        }
    }
    assert!(models > 10);
}

"""Instructions of emitted code, counted by callgrind: one evaluation of h, phi_0, phi_1 and phi_left, and one step.

    python3 tests/bench/instructions.py models/cuk.yaml models/motor.yaml

Each model is emitted for `f64` into one crate under cargo's target directory, built with optimisation for x86-64. Counted
are a function that is not inlined and returns all four values, with the terms of its sample, and a step of the observer
with a gradient estimator and a filter, as the difference of runs of 13 and 3 steps. Needs valgrind. PEBO_GEN names a
build of the generator; left out, one is made.
"""

import os
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
TARGET = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target"))
CRATE = TARGET / "instructions"
GENERATOR = [os.environ["PEBO_GEN"]] if "PEBO_GEN" in os.environ else ["cargo", "run", "--release", "--quiet", "-p", "pebo-gen", "--"]

MANIFEST = """\
[package]
name = "instructions"
version = "0.0.0"
edition = "2024"

[dependencies]
pebo-runtime = {{ path = {runtime!r} }}

[profile.release]
opt-level = 3
debug = 1

[workspace]
"""

MODULE = """
mod {name};

mod of_{name} {{
    use std::hint::black_box;

    use pebo_runtime::nalgebra::{{SMatrix, SVector}};
    use pebo_runtime::{{Extension, Filter, Gradient, Hold, Model}};

    use super::{name}::{{{type_name} as Plant, NE, NR, NU, NX, NY, NZ, Observer, Parameters}};

    type Chi = <Plant as Model<NX, NY, NU, NZ, NR, NE>>::Extension;
    type Values = (SVector<f64, NZ>, SVector<f64, NR>, SMatrix<f64, NR, NE>, SVector<f64, NX>);

    #[inline(never)]
    fn eval_{name}(
        plant: &Plant,
        chi: &Chi,
        y: &SVector<f64, NY>,
        u: &SVector<f64, NU>,
        z: &SVector<f64, NZ>,
    ) -> Values {{
        let terms = plant.terms(y);
        let sides = plant.regression(chi, &terms, u);
        (plant.flow(&terms, u).h, sides.known, sides.factor, plant.recover(z, &terms))
    }}

    #[inline(never)]
    fn step_{name}(observer: &mut Observer, y: &SVector<f64, NY>, u: &SVector<f64, NU>) -> f64 {{
        observer.step(*y, *u, black_box(1e-3)).map_or(0.0, |x| SVector::from(x)[0])
    }}

    pub fn run(steps: u32) {{
        let plant = Plant::new(&Parameters::default());
        let y = SVector::from_fn(|i, _| 0.3 + 0.2 * i as f64);
        let u = SVector::from_fn(|i, _| 0.4 + 0.1 * i as f64);
        let z = SVector::from_fn(|i, _| 0.5 + 0.1 * i as f64);
        let chi = Chi::new(z);
        black_box(eval_{name}(black_box(&plant), black_box(&chi), black_box(&y), black_box(&u), black_box(&z)));
        let filter = Filter::new(5.0, Hold::First).unwrap();
        let mut observer = Observer::new(plant, Gradient::diagonal(&SVector::repeat(1.0)).unwrap(), filter, z).unwrap();
        for k in 0..steps {{
            black_box(step_{name}(&mut observer, black_box(&(y * (1.0 + 0.01 * f64::from(k)))), black_box(&u)));
        }}
    }}
}}
"""


def run(*command, **settings):
    return subprocess.run(command, check=True, text=True, **settings)


def emit(models):
    """Writes the crate; gives the modules' names."""
    (CRATE / "src").mkdir(parents=True, exist_ok=True)
    (CRATE / "Cargo.toml").write_text(MANIFEST.format(runtime=str(ROOT / "pebo-runtime")))
    names, source = [], ["#![allow(dead_code)]"]
    for model in models:
        name = Path(model).stem
        code = CRATE / "src" / f"{name}.rs"
        run(*GENERATOR, model, "-o", str(code), cwd=ROOT, stderr=subprocess.DEVNULL)
        type_name = re.search(r"impl Model<.*> for (\w+)", code.read_text())[1]
        source.append(MODULE.format(name=name, type_name=type_name))
        names.append(name)
    calls = " ".join(f"of_{name}::run(steps);" for name in names)
    source.append(f"fn main() {{ let steps = std::env::args().nth(1).unwrap().parse().unwrap(); {calls} }}\n")
    (CRATE / "src" / "main.rs").write_text("\n".join(source))
    return names


def counted(steps):
    """Inclusive instructions by function."""
    profile = CRATE / f"profile.{steps}"
    run("valgrind", "--tool=callgrind", f"--callgrind-out-file={profile}", str(CRATE / "target/release/instructions"),
        str(steps), capture_output=True)
    listing = run("callgrind_annotate", "--inclusive=yes", "--threshold=100", str(profile), capture_output=True).stdout
    found = {}
    for line in listing.splitlines():
        match = re.match(r"\s*([\d,]+) .*:instructions::of_\w+::((?:eval|step)_\w+)", line)
        if match:
            found[match[2]] = max(found.get(match[2], 0), int(match[1].replace(",", "")))
    return found


def main():
    models = [str(Path(model).resolve()) for model in sys.argv[1:]] or [str(ROOT / "models/cuk.yaml")]
    names = emit(models)
    run("cargo", "build", "--release", "--quiet", "--target-dir", str(CRATE / "target"), cwd=CRATE)
    few, many = counted(3), counted(13)
    print("| model | one evaluation | one step |\n|---|---|---|")
    for name in names:
        step = (many[f"step_{name}"] - few[f"step_{name}"]) // 10
        print(f"| {name} | {few[f'eval_{name}']} | {step} |")


if __name__ == "__main__":
    main()

"""What the attribute adds to the time that a user's crate compiles.

    python3 tests/bench/compile.py [--rounds 7] [--models cuk two_mass_drive]

Makes crates under cargo's target directory that differ in where the observer of a model comes from: the emitted file,
checked in; the attribute with the model file; the attribute on plain Rust, without the reader of model files; a build
script. Prints for each the processor time and the clock's time of a cold build of everything, and the medians of
builds after `main.rs` was touched, in the profile dev. The expansion is the difference between the attribute and the
checked-in file. Needs the registry's crates on this machine, as a build of the workspace leaves them there.
"""

import argparse
import os
import pathlib
import resource
import shutil
import statistics
import subprocess
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
TARGET = pathlib.Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target")).resolve()

MANIFEST = """[package]
name = "user"
version = "0.0.0"
edition = "2024"

[workspace]

[dependencies]
pebo-runtime = {{ path = "{root}/pebo-runtime" }}
{dependencies}
"""

MAIN = """{item}

fn main() {{
    println!("{{}}", {name}::NX);
}}
"""


def crates(model):
    """Name, further dependencies, the item of main.rs, other files."""
    yaml = ROOT / "models" / f"{model}.yaml"
    path = os.path.relpath(yaml, TARGET / "compile" / "file")
    emitted = subprocess.run(
        ["cargo", "run", "--quiet", "-p", "pebo-gen", "--", str(yaml)],
        cwd=ROOT, check=True, capture_output=True, text=True).stdout
    camel = "".join(word.capitalize() for word in model.split("_"))
    macros = f'pebo-macros = {{ path = "{ROOT}/pebo-macros"'
    yield "checked in", "", f"mod {model};", {f"src/{model}.rs": emitted}
    yield "attribute, model file", macros + " }", f'#[pebo_macros::pebo_model("{path}")]\nstruct {camel};', {}
    plain = ROOT / "tests" / "tests" / "plants" / f"{model}.rs"
    if plain.exists():
        yield "attribute, plain Rust", macros + ", default-features = false }", plain.read_text(), {}
    builder = f'[build-dependencies]\npebo-gen = {{ path = "{ROOT}/pebo-gen", default-features = false, features = ["yaml"] }}'
    script = f'fn main() {{ pebo_gen::Builder::new().compile(&["{yaml}"]).unwrap(); }}\n'
    yield "build script", builder, 'include!(concat!(env!("OUT_DIR"), "/pebo.rs"));', {"build.rs": script}


def build(folder, target):
    """Processor time and clock of a build, in seconds."""
    before, began = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
    subprocess.run(["cargo", "build", "--quiet", "--offline"], cwd=folder, check=True,
                   env={**os.environ, "CARGO_TARGET_DIR": str(target), "RUSTFLAGS": "-Awarnings"})
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, time.perf_counter() - began


def measure(model, rounds):
    print(f"\n{model:24}  {'cold, cpu':>10} {'clock':>9}   {'touched, cpu':>12} {'clock':>9}")
    incremental = {}
    prepared = []
    for kind, dependencies, item, files in crates(model):
        folder = TARGET / "compile" / "file"
        folder = folder.with_name(kind.replace(", ", "-").replace(" ", "-"))
        target = folder / "target"
        shutil.rmtree(folder, ignore_errors=True)
        (folder / "src").mkdir(parents=True)
        (folder / "Cargo.toml").write_text(MANIFEST.format(root=ROOT, dependencies=dependencies))
        shutil.copy(ROOT / "Cargo.lock", folder / "Cargo.lock")
        (folder / "src" / "main.rs").write_text(MAIN.format(item=item, name=model))
        for name, text in files.items():
            (folder / name).write_text(text)
        prepared.append((kind, folder, target, build(folder, target)))
    times = {kind: [] for kind, *_ in prepared}
    # They take turns, so that what else the machine does falls on all of them.
    for _ in range(rounds):
        for kind, folder, target, _ in prepared:
            (folder / "src" / "main.rs").touch()
            times[kind].append(build(folder, target))
    for kind, _, _, cold in prepared:
        incremental[kind] = [statistics.median(values) for values in zip(*times[kind])]
        print(f"{kind:24}  {cold[0]:8.1f} s {cold[1]:7.1f} s   {incremental[kind][0]:10.3f} s {incremental[kind][1]:7.3f} s")
    for kind in incremental:
        if kind.startswith("attribute"):
            more = incremental[kind][0] - incremental["checked in"][0]
            print(f"{kind}: {1000 * more:.0f} ms of the processor more than the checked-in file")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--rounds", type=int, default=7)
    parser.add_argument("--models", nargs="+", default=["cuk"])
    arguments = parser.parse_args()
    for model in arguments.models:
        measure(model, arguments.rounds)


if __name__ == "__main__":
    main()

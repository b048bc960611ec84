"""Builds the programs of a run: ours, the Python rivals in an environment of their own, the Rust rival in its workspace.

A rival that cannot be had is left out, and a line says so.
"""
import os
import subprocess
import sys
from pathlib import Path

from .systems import System

PYTHON_RIVALS = {
    "SymEngine": ("symengine", "symengine_rival.py",
                  ("expand", "numerator", "exp", "exp numerator", "half angles", "by hand")),
    "SymPy": ("sympy", "sympy_rival.py",
              ("expand", "by hand", "exp", "half angles", "expand_trig", "trigsimp", "simplify")),
    "FLINT": ("flint", "flint_rival.py", ("",)),
}
SYMPLEX_RECIPES = ("expand", "ratsimp", "by hand", "exp", "expand_trig", "equals", "simplify")


def target(root):
    return Path(os.environ.get("CARGO_TARGET_DIR", root / "target"))


def build_ours(root):
    """Our command line as it is installed, and our side of the protocol built alike: the rivals come as optimised
    libraries."""
    build = ["cargo", "build", "--profile", "dist", "--quiet"]
    subprocess.run([*build, "-p", "pebo-gen"], cwd=root, check=True)
    subprocess.run([*build, "-p", "tests", "--example", "bench-ours"], cwd=root, check=True)
    built = target(root) / "dist"
    return str(built / "pebo-gen"), System("ours", [str(built / "examples" / "bench-ours")])


def environment(root):
    """The Python of the rivals, or that of the caller if none can be made."""
    place = target(root) / "bench-venv"
    python = place / "bin" / "python"
    if sys.executable == str(python):
        return sys.executable
    wanted = root / "tests" / "bench" / "requirements.txt"
    try:
        if not python.exists():
            subprocess.run([sys.executable, "-m", "venv", str(place)], check=True)
        subprocess.run([str(python), "-m", "pip", "install", "--quiet", "--disable-pip-version-check", "-r",
                        str(wanted)], check=True)
    except (OSError, subprocess.CalledProcessError) as error:
        print(f"NOTE: no environment for the rivals in Python ({error}); those installed for {sys.executable} are used")
        return sys.executable
    return str(python)


def rivals(root, python):
    """The rivals that are there."""
    bench = root / "tests" / "bench"
    found = []
    for name, (module, script, recipes) in PYTHON_RIVALS.items():
        version = subprocess.run([python, "-c", f"import {module}; print({module}.__version__)"], capture_output=True,
                                 text=True, check=False)
        if version.returncode:
            print(f"SKIPPED: {name}, which {python} does not have")
            continue
        found.append(System(name, [python, str(bench / "rivals" / script)], recipes))
        print(f"{name} {version.stdout.strip()}")
    place = bench / "rivals" / "symplex"
    build = subprocess.run(["cargo", "build", "--release", "--quiet", "--locked"], cwd=place, check=False,
                           env={**os.environ, "CARGO_TARGET_DIR": str(target(root) / "bench-symplex")})
    if build.returncode:
        print("SKIPPED: symplex, which could not be built")
    else:
        program = target(root) / "bench-symplex" / "release" / "bench-symplex"
        found.append(System("symplex", [str(program)], SYMPLEX_RECIPES))
        print("symplex 0.57.0")
    return found

"""Checks that the verdict does not depend on how a plant is written.

    python3 tests/oracle/metamorphic.py target/release/pebo-gen MODEL.yaml ..

Each model is written in other ways, and all of them have the verdict of the original, claim by claim, with as many
conditions, and the same statements on excitation:

- parameters, states, outputs and inputs in the opposite order;
- every name longer;
- each unmeasured state with the opposite sign, or in another unit.

Needs PyYAML. Exits with 1 where an answer differs; a model that the program refuses to read is passed over.
"""

import copy
import json
import re
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import yaml

CLAIMS = ("cascade", "left_inverse", "regression", "identifiability")
SIGNALS = ("x", "y", "u", "w")


def names_of(model):
    found = set()
    for key in (*SIGNALS, "parameters"):
        part = model.get(key) or []
        found |= set(part)
    return {name for name in found if isinstance(name, str)}


def backwards(part):
    return dict(reversed(part.items())) if isinstance(part, dict) else part[::-1]


def reordered(model, keys):
    other = copy.deepcopy(model)
    for key in keys:
        if isinstance(other.get(key), (list, dict)):
            other[key] = backwards(other[key])
    return other


def renamed(model):
    names = names_of(model)
    pattern = re.compile(r"(?<![\w.])(" + "|".join(sorted(map(re.escape, names), key=len, reverse=True)) + r")(?![\w.]|\s*\()")
    rename = lambda text: pattern.sub(lambda found: found[1] + "_a", text)

    def walk(part, formulas):
        if isinstance(part, dict):
            return {rename(k) if formulas and isinstance(k, str) else k: walk(v, formulas) for k, v in part.items()}
        if isinstance(part, list):
            return [walk(item, formulas) for item in part]
        return rename(part) if formulas and isinstance(part, str) else part

    return {k: walk(v, k not in ("model", "title")) for k, v in model.items()}


def in_other_units(model, factor):
    """The model in states that are so many times the old ones."""
    states = [name for name in model["x"] if isinstance(name, str)]
    pattern = re.compile(r"(?<![\w.])(" + "|".join(sorted(map(re.escape, states), key=len, reverse=True)) + r")(?![\w.])")

    def walk(part):
        if isinstance(part, dict):
            return {k: walk(v) for k, v in part.items()}
        if isinstance(part, list):
            return [walk(item) for item in part]
        return pattern.sub(rf"(\1/({factor}))", part) if isinstance(part, str) else part

    formulas = ("f_x", "f_y", "g_y", "phi", "identities", "assume", "define")
    other = {k: walk(v) if k in formulas else v for k, v in model.items()}
    for key in ("f_x", "phi_left"):
        if isinstance(other.get(key), dict):
            other[key] = {k: f"({factor})*({v})" for k, v in other[key].items()}
    return other


def answer(program, model, folder, name):
    path = Path(folder, name)
    path.write_text(yaml.safe_dump(model, sort_keys=False, default_flow_style=False, width=10**6))
    said = subprocess.run([program, "check", "--format", "json", path], capture_output=True, text=True, timeout=300)
    try:
        report = json.loads(said.stdout)
    except json.JSONDecodeError:
        return None
    if any((report.get(claim) or {}).get("verdict") is None for claim in CLAIMS):
        return None
    found = report["identifiability"]
    claims = tuple(report[claim]["verdict"] for claim in CLAIMS)
    return {
        "verdict": report["verdict"],
        "claims": claims,
        "kind": found["kind"],
        "conditions": len(report["conditions"] or []),
        "by_itself": found["by_itself"],
        "at rest": any("the plant rests" in blind["while"] for blind in found["blind"] or []),
    }


def look(program, path, folder):
    try:
        model = yaml.safe_load(Path(path).read_text())
    except yaml.YAMLError:
        return path, None, []
    if not isinstance(model, dict) or not isinstance(model.get("x"), list) or not isinstance(model.get("y"), list):
        return path, None, []
    # An order that the file does not state is that of the file: classes have matrices in it.
    model = {k: v for k, v in model.items() if k not in ("simulation", "observer")}
    stem = f"{abs(hash(path))}"
    first = answer(program, model, folder, f"{stem}.yaml")
    if first is None:
        return path, None, []
    ways = {"parameters backwards": reordered(model, ["parameters"])}
    # A class has matrices in the order of its signals, and keys that may be names too.
    if not set(model) & {"mechanical", "electromechanical", "lti"}:
        ways["signals backwards"] = reordered(model, [*SIGNALS, "f_x", "f_y", "g_y"])
        ways["renamed"] = renamed(model)
        if all(isinstance(name, str) for name in model["x"]) and not set(model) & {"angles", "phi_left"}:
            ways["negated states"] = in_other_units(model, "-1")
            ways["doubled states"] = in_other_units(model, "2")
    wrong = []
    for way, other in ways.items():
        found = answer(program, other, folder, f"{stem}_{way[0]}{len(way)}.yaml")
        if found != first:
            changed = {k: (first[k], found and found[k]) for k in first if not found or found[k] != first[k]}
            wrong.append(f"{way}: {changed}")
    return path, first, wrong


def main():
    program, paths = sys.argv[1], sys.argv[2:]
    looked = bad = 0
    with tempfile.TemporaryDirectory() as folder, ThreadPoolExecutor(2) as pool:
        for path, first, wrong in pool.map(lambda path: look(program, path, folder), paths):
            looked += first is not None
            bad += bool(wrong)
            for what in wrong:
                print(f"{path}: {what}")
    print(f"{looked} models of {len(paths)}, {bad} with another answer when written otherwise")
    sys.exit(bad > 0)


if __name__ == "__main__":
    main()

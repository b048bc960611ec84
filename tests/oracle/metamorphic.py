"""Checks that the verdict does not depend on how a plant is written.

    python3 tests/oracle/metamorphic.py target/release/pebo-gen MODEL.yaml ..

Each model is written in other ways, and all of them have the verdict of the original, claim by claim, with as many
conditions, and the same statements on excitation:

- parameters, states, outputs and inputs in the opposite order;
- every name longer;
- each unmeasured state, or each output, with the opposite sign, or in another unit;
- the sum of two outputs in the place of one of them;
- an unmeasured state plus an output, or plus its square, in the place of the state.

Where phi is searched for, the search has to answer alike.

Needs PyYAML. Exits with 1 where an answer differs; a model that the program refuses to read is passed over, and an
answer that the limit of time cut short.
"""

import copy
import json
import re
import subprocess
import sys
import tempfile
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from itertools import permutations, product
from pathlib import Path

import yaml

CLAIMS = ("cascade", "left_inverse", "regression", "identifiability")
SIGNALS = ("x", "y", "u", "w")
CUT_SHORT = "the limit of time was reached"
FORMULAS = ("f_x", "f_y", "g_y", "phi", "phi_left", "identities", "assume", "define")


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


def in_terms_of(model, old):
    """The model with each name that `old` has replaced by its formula there, the rates and values left as they were."""
    pattern = re.compile(r"(?<![\w.])(" + "|".join(sorted(map(re.escape, old), key=len, reverse=True)) + r")(?![\w.])")

    def walk(part):
        if isinstance(part, dict):
            return {k: walk(v) for k, v in part.items()}
        if isinstance(part, list):
            return [walk(item) for item in part]
        return pattern.sub(lambda found: f"({old[found[1]]})", part) if isinstance(part, str) else part

    return {k: walk(v) if k in FORMULAS else v for k, v in model.items()}


def in_other_units(model, signals, factor):
    """The model in states or outputs that are so many times the old ones."""
    other = in_terms_of(model, {name: f"{name}/({factor})" for name in model[signals]})
    for key in ("f_x", "phi_left") if signals == "x" else ("f_y", "g_y"):
        if isinstance(other.get(key), dict):
            other[key] = {k: f"({factor})*({v})" for k, v in other[key].items()}
    return other


def mentions(model, formula, name):
    """Whether the name is in the formula, or in what it has by definition."""
    seen, left = set(), [str(formula)]
    while left:
        found = set(re.findall(r"(?<![\w.])[A-Za-z_]\w*", left.pop())) - seen
        seen |= found
        left += [str(part) for key, part in (model.get("define") or {}).items() if key in found]
    return name in seen


def with_a_sum(model):
    """The model with a + b measured in the place of a, for the first outputs a, b of which no less is known then."""
    given = [model.get(key) or {} for key in ("f_y", "g_y")]
    for a, b in permutations(model["y"], 2):
        if any(a in part and b not in part for part in given) or mentions(model, given[1].get(b, ""), a):
            continue
        other = in_terms_of(model, {a: f"{a} - {b}"})
        for key in ("f_y", "g_y"):
            if a in (other.get(key) or {}):
                other[key][a] = f"({other[key][a]}) + ({other[key][b]})"
        return other
    return None


def shifted(model, states, function, slope):
    """The model with a + function(b) in the place of a, for the first state a and output b that allow it."""
    rates, values = model.get("f_y") or {}, model.get("g_y") or {}
    for a, b in product(states, model["y"]):
        # The program refuses a value that depends on itself.
        if b not in rates or mentions(model, values.get(b, ""), a):
            continue
        other = in_terms_of(model, {a: f"{a} - {function.format(b)}"})
        other["f_x"][a] = f"({other['f_x'][a]}) + {slope.format(b)}*({other['f_y'][b]})"
        if a in (other.get("phi_left") or {}):
            other["phi_left"][a] = f"({other['phi_left'][a]}) + {function.format(b)}"
        return other
    return None


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
    if any(found["code"] == "limit-reached" for found in report["diagnostics"]):
        return CUT_SHORT
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
    model = {k: v for k, v in model.items() if k not in ("simulation", "observer", "recording")}
    stem = f"{abs(hash(path))}"
    first = answer(program, model, folder, f"{stem}.yaml")
    if first in (None, CUT_SHORT):
        return path, None, []
    ways = {"parameters backwards": reordered(model, ["parameters"])}
    # A class has matrices in the order of its signals, and keys that may be names too.
    if not set(model) & {"mechanical", "electromechanical", "lti"}:
        ways["signals backwards"] = reordered(model, [*SIGNALS, "f_x", "f_y", "g_y"])
        ways["renamed"] = renamed(model)
        if all(isinstance(name, str) for name in model["x"]) and not set(model) & {"angles", "phi_left"}:
            ways["negated states"] = in_other_units(model, "x", "-1")
            ways["doubled states"] = in_other_units(model, "x", "2")
        # Of an output that is an angle the period would have to be another; a state that is one keeps its own.
        named = all(isinstance(name, str) for name in (*model["x"], *model["y"]))
        if named and not set(model["y"]) & set(model.get("angles") or {}):
            ways["negated outputs"] = in_other_units(model, "y", "-1")
            ways["doubled outputs"] = in_other_units(model, "y", "2")
            ways["sum of outputs"] = with_a_sum(model)
            ways["state plus output"] = shifted(model, model["x"], "{}", "1")
            ways["state plus square"] = shifted(model, model["x"], "{}^2", "2*{}")
            if len(model["x"]) > 1:
                ways["last state plus output"] = shifted(model, model["x"][::-1], "{}", "1")
    ways = {way: other for way, other in ways.items() if other}
    compared, wrong = [], []
    for number, (way, other) in enumerate(ways.items()):
        found = answer(program, other, folder, f"{stem}_{number}.yaml")
        if found == CUT_SHORT:
            continue
        compared.append(way)
        if found != first:
            changed = {k: (first[k], found and found[k]) for k in first if not found or found[k] != first[k]}
            wrong.append(f"{way}: {changed}")
    return path, compared, wrong


def main():
    program, paths = sys.argv[1], sys.argv[2:]
    asked, looked, bad = Counter(), 0, 0
    with tempfile.TemporaryDirectory() as folder, ThreadPoolExecutor(2) as pool:
        for path, ways, wrong in pool.map(lambda path: look(program, path, folder), paths):
            asked.update(ways or [])
            looked += ways is not None
            bad += bool(wrong)
            for what in wrong:
                print(f"{path}: {what}")
    print("; ".join(f"{way}: {count}" for way, count in asked.items()))
    print(f"{looked} models of {len(paths)}, {bad} with another answer when written otherwise")
    sys.exit(bad > 0)


if __name__ == "__main__":
    main()

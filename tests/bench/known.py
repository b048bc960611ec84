"""The observer that is told the numbers of its sensors beside an extended Kalman filter of the same numbers, for every plant
of models/: the table of docs/estimators.md.

    cargo build --release -p pebo-gen
    python3 tests/bench/known.py [--runs 20] [MODEL.yaml ...]

Each sensor has white noise of 1 % of the root mean square of its output, and no other imperfection. Both are told that noise,
an error at the start as large as the root mean square of each state, and a disturbance of each state that adds up to 3 % of
it over the run. Errors are root mean squares after settling (of the last tenth of a run that does not settle), the median of
the runs, in percent of the root mean square of the state, of the state with the largest ratio.
"""

import argparse
import csv
import io
import math
import re
import subprocess
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from estimators import ROOT

PROGRAM = ROOT / "target/release/pebo-gen"

# A model whose observer is a filter has no output form, and is not told the noise of samples.
FILTERED = ["levitated_ball"]


def simulate(model, settings, arguments=()):
    command = [str(PROGRAM), "simulate", str(model), *arguments]
    for name, value in settings.items():
        command += ["--set", f"{name}={value}"]
    return subprocess.run(command, capture_output=True, text=True, check=False).stdout


def size(rows, name):
    """The root mean square of a signal."""
    return math.sqrt(sum(float(row[name]) ** 2 for row in rows) / len(rows))


def of_all(numbers):
    return "{" + ", ".join(f"{name}: {value:.3g}" for name, value in numbers.items()) + "}"


def table_of(model):
    """The signals of a run without noise."""
    settings = {"simulation.baselines": "{}", "simulation.panels": "[]"}
    return list(csv.DictReader(io.StringIO(simulate(model, settings, ["--csv", "-"]))))


def errors(report):
    """The root mean square of the error of each row of the summary, and the number of runs in which it has not settled."""
    found = {}
    for line in report.splitlines()[1:]:
        cells = [cell.strip() for cell in line.split("   ") if cell.strip()]
        if len(cells) != 9 or "/" not in cells[7]:
            break
        name = cells[0].split(" in ")[0]
        found[name] = float(cells[3].split()[0]) if cells[3][:1].isdigit() else math.nan
    return found


def row(model, runs):
    """The line of a model; none of one without a run, or without such a filter."""
    rows = table_of(model)
    if not rows:
        return None
    states = [name.removesuffix("_hat") for name in rows[0] if name.endswith("_hat")]
    outputs = re.search(r"^y: \[(.*?)\]", model.read_text(), re.MULTILINE)[1].split(", ")
    noise = {name: 0.01 * size(rows, name) for name in outputs}
    start = {name: size(rows, name) for name in states}
    duration = float(rows[-1]["t"])
    drift = {name: 0.03 * value / math.sqrt(duration) for name, value in start.items()}
    numbers = f"sensors: {of_all(noise)}, start: {of_all(start)}, disturbance: {of_all(drift)}"
    settings = {
        "observer": "{" + numbers + "}",
        "simulation.noise": of_all(noise),
        "simulation.baselines": "{ekf: {" + numbers + "}}",
        "simulation.panels": "[]",
    }
    found = errors(simulate(model, settings, ["--runs", str(runs)]))
    percent = lambda prefix: {state: 100 * found.get(prefix + state, math.nan) / start[state] for state in states}
    own, ekf = percent(""), percent("ekf.")
    ratios = {state: own[state] / ekf[state] for state in states}
    if any(math.isnan(ratio) for ratio in ratios.values()):
        return None
    worst = max(ratios, key=ratios.get)
    return f"| {model.stem} | {worst} | {own[worst]:.2g} | {ekf[worst]:.2g} | {ratios[worst]:.2f} |"


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n", maxsplit=1)[0])
    parser.add_argument("models", nargs="*", type=Path)
    parser.add_argument("--runs", type=int, default=20)
    asked = parser.parse_args()
    models = asked.models or sorted(path for path in (ROOT / "models").glob("*.yaml") if path.stem not in FILTERED)
    print("| plant | state | observer | `ekf` | ratio |")
    print("|---|---|---|---|---|")
    with ThreadPoolExecutor(2) as pool:
        for line in filter(None, pool.map(lambda model: row(model, asked.runs), models)):
            print(line)


if __name__ == "__main__":
    main()

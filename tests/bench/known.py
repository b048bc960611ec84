"""The observer that is told the numbers of its sensors beside an extended Kalman filter of the same numbers, for every plant
of models/: the table of docs/estimators.md.

    cargo build --release -p pebo-gen
    python3 tests/bench/known.py [--runs 20] [MODEL ...]

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
from concurrent.futures import ThreadPoolExecutor

from estimators import ROOT, errors, simulate


def size(rows, name):
    """The root mean square of a signal."""
    return math.sqrt(sum(float(row[name]) ** 2 for row in rows) / len(rows))


def of_all(numbers):
    return "{" + ", ".join(f"{name}: {value:.3g}" for name, value in numbers.items()) + "}"


def row(model, runs):
    """The line of a model; with the reason where it has no run, or no such filter."""
    # The signals, without noise.
    plain = {"simulation.baselines": "{}", "simulation.panels": "[]"}
    rows = list(csv.DictReader(io.StringIO(simulate(model, plain, ["--csv", "-"]))))
    if not rows:
        return f"| {model} | no section `simulation` | | | |"
    states = [name.removesuffix("_hat") for name in rows[0] if name.endswith("_hat")]
    text = (ROOT / f"models/{model}.yaml").read_text()
    outputs = re.search(r"^y: \[(.*?)\]", text, re.MULTILINE)[1].split(", ")
    noise = {name: 0.01 * size(rows, name) for name in outputs}
    start = {name: size(rows, name) for name in states}
    duration = float(rows[-1]["t"])
    drift = {name: 0.03 * value / math.sqrt(duration) for name, value in start.items()}
    numbers = f"sensors: {of_all(noise)}, start: {of_all(start)}, disturbance: {of_all(drift)}"
    settings = plain | {
        "observer": "{" + numbers + "}",
        "simulation.noise": of_all(noise),
        "simulation.baselines": "{ekf: {" + numbers + "}}",
    }
    found = errors(simulate(model, settings, ["--runs", str(runs)]))
    rms = lambda name: found.get(name, (None, None, None))[1] or math.nan
    own, ekf = ({state: 100 * rms(of + state) / start[state] for state in states} for of in ("", "ekf."))
    ratios = {state: own[state] / ekf[state] for state in states}
    if any(math.isnan(ratio) for ratio in ratios.values()):
        return f"| {model} | no `ekf` | | | |"
    worst = max(ratios, key=ratios.get)
    return f"| {model} | {worst} | {own[worst]:.2g} | {ekf[worst]:.2g} | {ratios[worst]:.3g} |"


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n", maxsplit=1)[0])
    parser.add_argument("models", nargs="*")
    parser.add_argument("--runs", type=int, default=20)
    asked = parser.parse_args()
    models = asked.models or sorted(path.stem for path in (ROOT / "models").glob("*.yaml"))
    print("| plant | state | observer | `ekf` | ratio |")
    print("|---|---|---|---|---|")
    with ThreadPoolExecutor(2) as pool:
        for line in pool.map(lambda model: row(model, asked.runs), models):
            print(line, flush=True)


if __name__ == "__main__":
    main()

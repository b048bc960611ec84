"""Every estimator and the baselines under noise, bias, mismatch, lost samples and jitter: the table of docs/estimators.md.

    cargo build --release -p pebo-gen
    python3 tests/bench/estimators.py [--runs 100] [cuk_case2 | motor]

Plants are those of models/, under the control law with the true state, so that all observers see the same data. Each
observer has one setting for all columns. Where chance is at work the numbers are those of 100 runs: medians of the time
to settle and of the root mean square from then on, and what nine tenths of the runs do not exceed at worst. Errors are
in percent of the largest absolute value of the state (of an angle: of its period), of the state with the largest.
"""

import argparse
import csv
import io
import math
import subprocess
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]

# Each condition: settings of the simulation, and whether chance is at work.
CONDITIONS = {
    "cuk_case2": {
        "no noise": ({}, False),
        "0.1 % noise": ({"noise": "{v2: 0.04, i3: 0.0025}"}, True),
        "1 % noise": ({"noise": "{v2: 0.4, i3: 0.025}"}, True),
        "1 % bias": ({"bias": "{v2: 0.4, i3: 0.025}"}, False),
        "5 % mismatch": (
            {"plant": "{L1: 1.05*L1, C2: 1.05*C2, L3: 1.05*L3, C4: 1.05*C4, G: 1.05*G}"},
            False,
        ),
        "20 % dropped": ({"dropped": "0.2"}, True),
        "30 % jitter": ({"jitter": "0.3"}, True),
    },
    "motor": {
        "no noise": ({}, False),
        "0.1 % noise": ({"noise": "{i1: 0.001, i2: 0.001, omega: 0.01}"}, True),
        "1 % noise": ({"noise": "{i1: 0.01, i2: 0.01, omega: 0.1}"}, True),
        "1 % bias": ({"bias": "{i1: 0.01, i2: 0.01, omega: 0.1}"}, False),
        "5 % mismatch": ({"plant": "{R: 1.05*R, L: 1.05*L, lambda_m: 1.05*lambda_m}"}, False),
        "20 % dropped": ({"dropped": "0.2"}, True),
        "30 % jitter": ({"jitter": "0.3"}, True),
    },
}

# Settings that all conditions of a model have in common.
COMMON = {
    "cuk_case2": {"duration": "0.1", "panels": "[]"},
    "motor": {"duration": "0.5", "step": "1e-4", "panels": "[]"},
}

# The numbers that a user knows: those of the column with 1 % noise.
KNOWN = {
    "cuk_case2": "sensors: {v2: 0.4, i3: 0.025}, start: {i1: 5, v4: 30}, disturbance: {i1: 0.1, v4: 1}",
    "motor": "sensors: {i1: 0.01, i2: 0.01, omega: 0.1}, start: {q: 1}, disturbance: {q: 0.01}",
}

OBSERVERS = {
    "cuk_case2": {
        "no section `observer`": "{}",
        "`sensors`, `start`, `disturbance`": "{" + KNOWN["cuk_case2"] + "}",
        "`gradient`": "{gain: [5e-6, 0.1], filter: 1e3}",
        "`normalised-gradient`": "{estimator: normalised-gradient, gain: [5e-6, 0.1], normalisation: 1e-9, filter: 1e3}",
        "`least-squares`": "{estimator: least-squares, covariance: [1e6, 1e10], forgetting: 100, filter: 1e3}",
        "`drem`": "{estimator: drem, gain: 1e3, regressor_gain: [2e-3, 40], forgetting: 200, filter: 1e3}",
        "`finite-time-drem`": "{estimator: finite-time-drem, gain: 1e3, regressor_gain: [2e-3, 40], forgetting: 200, "
        "clip: 0.1, period: 5e-3, filter: 1e3}",
        "`gradient-drem`": "{estimator: gradient-drem, gain: 1e3, regressor_gain: [5e-6, 0.1], filter: 1e3}",
        "`least-squares-drem`": "{estimator: least-squares-drem, gain: 1e3, covariance: [1e6, 1e10], forgetting: 100, "
        "filter: 1e3}",
    },
    "motor": {
        "no section `observer`": "{}",
        "`sensors`, `start`, `disturbance`": "{" + KNOWN["motor"] + "}",
        "`gradient`": "{gain: 2e-5, filter: 500}",
        "`normalised-gradient`": "{estimator: normalised-gradient, gain: 2e-5, normalisation: 1e-9, filter: 500}",
        "`least-squares`": "{estimator: least-squares, covariance: 1, forgetting: 20, filter: 500}",
        "`drem`": "{estimator: drem, gain: 100, regressor_gain: 1, forgetting: 50, filter: 500}",
        "`finite-time-drem`": "{estimator: finite-time-drem, gain: 100, regressor_gain: 1, forgetting: 50, clip: 0.1, "
        "period: 0.05, filter: 500}",
        "`gradient-drem`": "{estimator: gradient-drem, gain: 100, regressor_gain: 2e-5, filter: 500}",
        "`least-squares-drem`": "{estimator: least-squares-drem, gain: 100, covariance: 1, forgetting: 20, filter: 500}",
    },
}

# Run beside the first observer. At rest the motor is not observable: no gain of Luenberger's exists.
BASELINES = {
    "cuk_case2": {
        "kalman": KNOWN["cuk_case2"],
        "luenberger": "poles: [-1000, -1100, -1200, -1300]",
    },
    "motor": {"ekf": KNOWN["motor"]},
}

# Written in the model file.
OF_FILE = {"cuk_case2": ["immersion"], "motor": []}

# Of angles, in rad.
PERIODS = {"q": 2 * 3.141592653589793 / 5}


def simulate(model, settings, arguments):
    """The output of a run: its summary, or the table that is asked for."""
    command = [str(ROOT / "target/release/pebo-gen"), "simulate", str(ROOT / f"models/{model}.yaml"), *arguments]
    for name, value in settings.items():
        command += ["--set", f"{name}={value}"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    return done.stdout


def largest(model):
    """The largest absolute value of each state."""
    settings = {f"simulation.{key}": value for key, value in COMMON[model].items()}
    out = simulate(model, settings | {"simulation.baselines": "{}"}, ["--csv", "-", "--feedback", "truth"])
    rows = list(csv.DictReader(io.StringIO(out)))
    states = [name.removesuffix("_hat") for name in rows[0] if name.endswith("_hat")]
    return {s: PERIODS.get(s) or max(abs(float(row[s])) for row in rows) for s in states}


def errors(report):
    """Of each row of the table: settled, rms, and worst of nine tenths of the runs; nothing for none."""
    lines = report.splitlines()
    found = {}
    for line in lines[1:]:
        cells = [cell.strip() for cell in line.split("   ") if cell.strip()]
        # The last column, what is expected, is there where an observer knows its sensors.
        if len(cells) not in (8, 9) or "/" not in cells[7]:
            break
        number = lambda cell: float(cell.split()[0]) if cell[:1].isdigit() else None
        found[cells[0].split(" in ")[0]] = (number(cells[1]), number(cells[3]), number(cells[6]))
    return found


def cell(found, scale, of):
    """What is told of an observer: the time of the last state, and the errors of the worst."""
    parts = [(value, scale[name.split(".")[-1]]) for name, value in found.items() if name.rpartition(".")[0] == of]
    if not parts or any(rms is None for (_, rms, _), _ in parts):
        return "-"
    settled = [time for (time, _, _), _ in parts]
    time = "no" if None in settled else shown(max(settled) * 1e3) + " ms"
    # A number that a tenth of the runs does not have is infinite.
    rms, worst = (max((value[k] or math.inf) / size for value, size in parts) for k in (1, 2))
    return f"{time}, {shown(rms * 100)}, {shown(worst * 100)}"


def shown(value):
    """Two digits."""
    if value == math.inf:
        return "-"
    if value == 0 or value < 0.005:
        return "0.00"
    return f"{value:.0f}" if value >= 9.95 else f"{value:.1f}" if value >= 0.995 else f"{value:.2f}"


def table(model, runs):
    """The lines of a model's table."""
    scale = largest(model)
    calls = {}
    for name, observer in OBSERVERS[model].items():
        for condition, (settings, chance) in CONDITIONS[model].items():
            of_run = {f"simulation.{key}": value for key, value in (COMMON[model] | settings).items()}
            of_run["observer"] = observer
            if name == next(iter(OBSERVERS[model])):
                for baseline, numbers in BASELINES[model].items():
                    of_run[f"simulation.baselines.{baseline}"] = "{" + numbers + "}"
            else:
                of_run["simulation.baselines"] = "{}"
            calls[name, condition] = (of_run, ["--feedback", "truth", "--runs", str(runs if chance else 1)])
    with ThreadPoolExecutor(2) as pool:
        reports = dict(zip(calls, pool.map(lambda call: simulate(model, *call), calls.values()), strict=True))
    yield f"| {model} | " + " | ".join(CONDITIONS[model]) + " |"
    yield "|---" * (1 + len(CONDITIONS[model])) + "|"
    first = next(iter(OBSERVERS[model]))
    rows = [(name, name, "") for name in OBSERVERS[model]]
    rows += [(f"`{name}`, a baseline", first, name) for name in [*BASELINES[model], *OF_FILE[model]]]
    for title, name, of in rows:
        cells = [cell(errors(reports[name, condition]), scale, of) for condition in CONDITIONS[model]]
        if all(text == "-" for text in cells):
            print(reports[name, next(iter(CONDITIONS[model]))])
        yield f"| {title} | " + " | ".join(cells) + " |"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("models", nargs="*", default=list(OBSERVERS))
    parser.add_argument("--runs", type=int, default=100)
    asked = parser.parse_args()
    for model in asked.models:
        for line in table(model, asked.runs):
            print(line)
        print()


if __name__ == "__main__":
    main()

"""Compares observers of random linear plants, whose outputs are redundant and noisy, with the Kalman filter.

    python3 tests/oracle/redundant.py target/release/pebo-gen 150 [SEED] [--show]

Drawn are `x' = A x + b u` with one to three states, which decay, swing, integrate or are constant, and two to four
outputs, each by its rate (`y' = c x + d u - e y`) or by its value (`y = c x + d u`). Some see what another one sees,
some see the input only. Sensors scatter between 1e-4 and 1. Half of the plants have `phi = x`, of the others it is
searched for; a third has a disturbance. All numbers are given to the observer by `sensors`, `start` and `disturbance`.
Looked at:

- the verdict: accepted if the exact rank of C, C A, .. is full, and not otherwise; and that each output with a row of
  C that is not 0 has an equation of its own, in which it stands by its rate or by its value;
- *expected*, against the covariance of the Kalman filter of the sampled plant, by its Riccati recursion, which takes
  the disturbance for jumps at the samples as the observer does: never better, and of a tenth more variance at most
  where no output is in a rate or in the cascade. For the others, the spread is printed;
- the errors of many runs without disturbance, against *expected*: their variance is that of the noise, by the quantiles
  of runs that start without an error, and that of the start, by runs without noise that start with one;
- the errors that an input `sin(t)` and outputs that start at 1 make alone, which are small beside *expected*;
- *expected* without each of the sensors in turn: no smaller than with it.

All are means over the last tenth of a run. Needs NumPy. Exits with 1 on a wrong statement, which it prints with the
plant; `--show` prints the ratios of each plant.
"""

import json
import random
import re
import subprocess
import sys
import tempfile
from collections import Counter, defaultdict
from concurrent.futures import ThreadPoolExecutor
from fractions import Fraction
from pathlib import Path

import numpy as np

from series import rank

RUNS = 300
# A standard deviation by the quantile of nine tenths has a relative error of 0.89/sqrt(RUNS); four of these.
MARGIN = 4 * 0.89 / RUNS**0.5
# What a step of the integration and three printed digits may do to a standard deviation.
ROUNDING = 0.02
MOST_VARIANCE = 1.1
MOST_BIAS = 0.3
# What nine tenths of the absolute values of normally distributed errors do not exceed.
NINE_TENTHS = 1.6448536270
# Nothing moves, and no estimate settles to a hundredth of the states.
AT_REST = 1e-9


class Plant:
    """A random plant: exact coefficients, and what is known of it."""

    def __init__(self, seed):
        draw = random.Random(seed)
        self.seed = seed
        n, m = draw.choice([1, 2, 2, 3]), draw.choice([2, 2, 3, 3, 4])
        number = lambda most=30: Fraction(draw.choice([-1, 1]) * draw.randint(1, most), 10)
        self.a = [[Fraction(0)] * n for _ in range(n)]
        for i in range(n):
            kind = draw.choice(["decays", "decays", "constant", "integrates", "swings"])
            later = [j for j in range(i + 1, n)]
            if kind == "decays":
                self.a[i][i] = -abs(number())
                for j in later:
                    self.a[i][j] = draw.choice([Fraction(0), number()])
            elif kind == "integrates" and later:
                self.a[i][draw.choice(later)] = number(10)
            elif kind == "swings" and later and not any(self.a[i + 1]):
                self.a[i][i + 1] = number()
                self.a[i + 1][i] = -self.a[i][i + 1]
        self.b = [draw.choice([Fraction(0), number()]) for _ in range(n)]
        self.rows = []  # Of each output: whether by its rate, c, d, e.
        for _ in range(m):
            by_rate = draw.random() < 0.5
            kind = draw.random()
            seen = [c for _, c, _, _ in self.rows if any(c)]
            if kind < 0.12:
                c, d = [Fraction(0)] * n, number()
            elif kind < 0.45 and seen:
                factor = draw.choice([Fraction(1), number(20)])
                c, d = [factor * k for k in draw.choice(seen)], draw.choice([Fraction(0), number()])
            else:
                c, d = [draw.choice([Fraction(0), number(), number()]) for _ in range(n)], draw.choice([Fraction(0), number()])
                c = c if any(c) else [number() for _ in range(n)]
            self.rows.append((by_rate, c, d, draw.choice([Fraction(0), Fraction(0), abs(number())]) if by_rate else 0))
        power = lambda low, high: float(f"{10 ** draw.uniform(low, high):.2g}")
        self.sensors = [power(-4, 0) for _ in range(m)]
        self.start = [power(-0.5, 0.7) for _ in range(n)]
        disturbed = draw.random() < 0.33
        self.drift = [power(-2, -0.5) if disturbed and draw.random() < 0.7 else 0.0 for _ in range(n)]
        self.given = draw.random() < 0.5
        self.step, self.steps = draw.choice([0.005, 0.01, 0.02]), draw.choice([60, 100])

    def without(self, output):
        """The same plant without one of its sensors."""
        other = object.__new__(Plant)
        other.__dict__.update(self.__dict__)
        keep = [i for i in range(len(self.rows)) if i != output]
        other.rows, other.sensors = [self.rows[i] for i in keep], [self.sensors[i] for i in keep]
        return other

    def observable(self):
        rows, found = [c for _, c, _, _ in self.rows], []
        for _ in self.a:
            found += rows
            rows = [[sum(c[k] * self.a[k][j] for k in range(len(c))) for j in range(len(c))] for c in rows]
        return rank(found) == len(self.a)

    def text(self):
        n, m = len(self.a), len(self.rows)
        xs, ys = [f"x{i + 1}" for i in range(n)], [f"y{i + 1}" for i in range(m)]
        formula = lambda names, row: " + ".join(f"({float(k):g})*{name}" for k, name in zip(row, names) if k) or "0"
        part = lambda wanted: [
            f"{y}: {formula([*xs, 'u', y], [*c, d, -e])}" for y, (by_rate, c, d, e) in zip(ys, self.rows) if by_rate is wanted
        ]
        map_of = lambda names, values: "{" + ", ".join(f"{k}: {v}" for k, v in zip(names, values)) + "}"
        lines = ["model: redundant", f"x: [{', '.join(xs)}]", f"y: [{', '.join(ys)}]", "u: [u]"]
        lines.append("f_x: {" + ", ".join(f"{x}: {formula([*xs, 'u'], [*r, b])}" for x, r, b in zip(xs, self.a, self.b)) + "}")
        lines += [f"{key}: {{{', '.join(part(wanted))}}}" for key, wanted in (("f_y", True), ("g_y", False)) if part(wanted)]
        lines += [f"phi: [{', '.join(xs)}]"] if self.given else []
        lines.append(f"observer:\n  sensors: {map_of(ys, self.sensors)}\n  start: {map_of(xs, self.start)}")
        lines.append(f"  disturbance: {map_of(xs, self.drift)}")
        by_rate = [y for y, row in zip(ys, self.rows) if row[0]]
        lines.append(f"simulation:\n  duration: {self.step * self.steps:g}\n  step: {self.step}")
        lines.append(f"  initial: {map_of([*xs, *by_rate], [AT_REST] * n + [0] * m)}")
        lines.append(f"  noise: {map_of(ys, self.sensors)}\n  control: {{u: 0}}")
        return "\n".join(lines) + "\n"

    def kalman(self, jumps):
        """The standard errors of the last tenth, where outputs with rates are states that are measured too.

        The disturbance enters all the time, or in jumps at the samples.
        """
        n, rated = len(self.a), [i for i, row in enumerate(self.rows) if row[0]]
        size = n + len(rated)
        rate, seen = np.zeros((size, size)), np.zeros((len(self.rows), size))
        rate[:n, :n] = np.array(self.a, float)
        for k, i in enumerate(rated):
            rate[n + k, :n], rate[n + k, n + k] = np.array(self.rows[i][1], float), -float(self.rows[i][3])
        for i, (by_rate, c, _, _) in enumerate(self.rows):
            if by_rate:
                seen[i, n + rated.index(i)] = 1
            else:
                seen[i, :n] = np.array(c, float)
        noise = np.diag([k * k for k in self.drift] + [0.0] * len(rated))
        move, grown = advance(rate, noise, self.step)
        grown = noise * self.step if jumps else grown
        p = np.diag([k * k for k in self.start] + [1e8 * self.sensors[i] ** 2 for i in rated])
        found = []
        for k in range(self.steps + 1):
            if k:
                p = move @ p @ move.T + grown
            # One after the other, as their noises are independent.
            for row, sensor in zip(seen, self.sensors):
                gain = p @ row / (row @ p @ row + sensor**2)
                left = np.eye(size) - np.outer(gain, row)
                p = left @ p @ left.T + np.outer(gain, gain) * sensor**2
            found.append(np.diag(p)[:n].copy())
        return np.sqrt(np.array(found)[self.last()].mean(axis=0))

    def last(self):
        """The samples of the last tenth."""
        return slice(self.steps - self.steps // 10, self.steps + 1)


def advance(rate, noise, step):
    """exp(rate*step), and what the noise adds to the covariance in a step (Van Loan)."""
    size = len(rate)
    both = np.block([[-rate, noise], [np.zeros((size, size)), rate.T]]) * step / 64
    power, term = np.eye(2 * size), np.eye(2 * size)
    for k in range(1, 14):
        term = term @ both / k
        power = power + term
    for _ in range(6):
        power = power @ power
    move = power[size:, size:].T
    return move, move @ power[:size, size:]


class Trial:
    """What the program makes of a plant."""

    def __init__(self, program, plant):
        self.program, self.plant = program, plant
        self.wrong, self.looked, self.ratios = [], Counter(), {}

    def call(self, plant, command, *options, limit="30"):
        with tempfile.TemporaryDirectory() as folder:
            path, table = Path(folder, "model.yaml"), Path(folder, "table.csv")
            path.write_text(plant.text())
            csv = ["--csv", table, "--every", str(plant.step)] if "--csv" in options else []
            options = [o for o in options if o != "--csv"]
            ask = [self.program, command, path, *options, *csv, "--limit", limit]
            said = subprocess.run(ask, capture_output=True, text=True, timeout=300)
            if not csv:
                return said.stdout + said.stderr
            if not table.exists():
                raise ValueError(f"no table: {said.stderr[-300:]}")
            return np.genfromtxt(table, delimiter=",", names=True)

    def look(self):
        try:
            if self.of_verdict():
                self.of_errors()
        except ValueError as error:
            self.wrong.append(str(error))
        return self

    def of_verdict(self):
        text = self.call(self.plant, "check", "--format", "json")
        try:
            said = json.loads(text)
        except json.JSONDecodeError:
            raise ValueError(f"no answer: {text[-300:]}") from None
        observable, verdict = self.plant.observable(), said["verdict"]
        self.looked[f"{'observable' if observable else 'not observable'}, {verdict}"] += 1
        if (verdict == "accepted") is not observable:
            codes = [f"{found['code']}: {found['message']}" for found in said["diagnostics"]]
            self.wrong.append(f"{verdict}, but observable is {observable}; {codes[:2]}")
        if verdict != "accepted" or not observable:
            return False
        found = said["regression"]
        text = self.call(self.plant, "check")
        block = re.search(r"\n  regression .*?(?=\n  \w)", text, re.S)[0]
        equations = [line for line in block.split("\n") if "theta" in line or "=" in line]
        self.looked[f"regression: {found['kind']}, {found['parameterisation']}"] += 1
        informative = [i for i, row in enumerate(self.plant.rows) if any(row[1])]
        missing = [f"y{i + 1}" for i in informative if not any(stands(f"y{i + 1}", self.plant.rows[i][0], e) for e in equations)]
        if missing or len(found["phi_0"]) < len(informative):
            self.wrong.append(f"no equation for {missing} of {len(informative)} informative outputs:\n{block}")
        unused = [entry["output"] if isinstance(entry, dict) else entry for entry in found["unused"]]
        for output in unused:
            says = output in [f"y{i + 1}" for i in informative]
            self.looked[f"unused output, {'informative' if says else 'silent'}"] += 1
        self.phi, lam = said["phi"]["z"], said["cascade"]["lambda"] or []
        driven = any(re.search(r"\by\d", f) for f in [*self.phi, *said["cascade"]["h"], *sum(lam, [])])
        single = all(len(set(re.findall(r"x\d", f))) == 1 for f in self.phi)
        self.group = "outputs in the cascade" if driven else "outputs in rates" if any(row[3] for row in self.plant.rows) else "no output in a rate"
        self.group += "" if single else ", mixed phi"
        return True

    def expected(self, plant):
        """The column of this name, over the last tenth as nothing settles."""
        text = self.call(plant, "simulate")
        head = next((line for line in text.split("\n") if line.startswith("error of")), "")
        if "expected" not in head:
            note = re.search(r"(?:not predicted|expected)[^\n]*", text)
            raise ValueError(f"nothing expected: {note[0] if note else text[-400:]}")
        lines = [line.split() for line in text.split("\n") if re.match(r"x\d ", line)]
        settled = [line[0] for line in lines if "no" not in line]
        if settled:
            raise ValueError(f"the script: {settled} settled\n{text}")
        return np.array([float(line[-1]) for line in lines])

    def of_errors(self):
        plant = self.plant
        best = plant.kalman(jumps=True)
        expected = self.expected(plant)
        self.ratios["expected to best"] = expected / best
        if any(plant.drift):
            self.ratios["expected to best, if the disturbance is no jumps"] = expected / plant.kalman(jumps=False)
        if any(expected < best * (1 - ROUNDING)):
            self.wrong.append(f"expected {expected} is better than the best {best}")
        if any(expected > best * MOST_VARIANCE**0.5):
            self.wrong.append(f"expected {expected}, best {best}: variances {(expected / best) ** 2}")
        if not any(plant.drift):
            measured, by_noise, by_start = self.measured(expected)
            self.ratios["measured to expected"] = measured / expected
            self.ratios["measured to best"] = measured / best
            if any(abs(np.log(measured / expected)) > MARGIN + ROUNDING):
                self.wrong.append(f"measured {measured} (by noise {by_noise}, by the start {by_start}), expected {expected}")
        for i in range(len(plant.rows)):
            fewer = plant.without(i)
            if not fewer.rows or not fewer.observable():
                continue
            try:
                less = self.expected(fewer)
            except ValueError as error:
                self.wrong.append(f"without y{i + 1}: {error}")
                continue
            self.looked["sensor that was taken away"] += 1
            ratio = expected / less
            self.ratios.setdefault("with a sensor to without", []).extend(ratio)
            if any(ratio > 1 + ROUNDING):
                self.wrong.append(f"the sensor y{i + 1} hurts: expected {expected}, without it {less}")

    def measured(self, expected):
        plant = self.plant
        n, last = len(plant.a), plant.last()
        quiet = [f"--set=simulation.noise.y{i + 1}=0" for i in range(len(plant.rows))]
        errors = lambda *more: (lambda t: np.array([t[f"x{i + 1}_error"] for i in range(n)]))(
            self.call(plant, "simulate", *quiet, *more, "--csv")
        )
        moved = [errors(f"--set=simulation.initial.x{i + 1}={s}") for i, s in enumerate(plant.start)]
        table = self.call(plant, "simulate", "--runs", str(RUNS), "--csv", limit="120")
        spread = np.array([table[f"x{i + 1}_error_90"] / NINE_TENTHS for i in range(n)])
        of_start = sum(m**2 for m in moved)
        mean = lambda squares: np.sqrt(squares[:, last].mean(axis=1))
        by_rate = [i for i, row in enumerate(plant.rows) if row[0]]
        places = [f"--set=simulation.initial.y{i + 1}=1" for i in by_rate]
        for what, change in ("the input sin(t)", ["--set=simulation.control.u=sin(t)"]), ("outputs that start at 1", places):
            if change:
                bias = mean(errors(*change) ** 2) / expected
                self.ratios[f"error by {what} alone, to expected"] = bias
                if any(bias > MOST_BIAS):
                    self.wrong.append(f"{what} alone, without noise or error of the start: errors of {bias} of what is expected, {expected}")
        return mean(spread**2 + of_start), mean(spread**2), mean(of_start)


def stands(output, by_rate, equation):
    """Whether an equation is one of the output, by its rate or by its value."""
    return bool(re.search(rf"\b{output}'" if by_rate else rf"\b{output}\b", equation)) or f"d/dt({output}" in equation


def main():
    arguments = [a for a in sys.argv[1:] if a != "--show"]
    program, count, first = arguments[0], int(arguments[1]), int((arguments + ["1"])[2])
    ratios, looked, bad = defaultdict(list), Counter(), 0
    work = lambda seed: Trial(program, Plant(seed)).look()
    with ThreadPoolExecutor(2) as pool:
        for trial in pool.map(work, range(first, first + count)):
            looked += trial.looked
            for kind, found in trial.ratios.items():
                how = ", phi given" if trial.plant.given else ", phi found"
                how += ", disturbed" if any(trial.plant.drift) else ""
                ratios[f"{kind}: {trial.group}{how}"] += list(found)
                ratios[f"{kind}: {trial.group}"] += list(found)
            if trial.wrong:
                bad += 1
                print(f"seed {trial.plant.seed}: " + "\n  ".join(trial.wrong) + f"\n{trial.plant.text()}", flush=True)
            if "--show" in sys.argv and trial.ratios:
                print(trial.plant.seed, trial.group, {k: [float(f"{r:.3g}") for r in v] for k, v in trial.ratios.items()}, flush=True)
    print("ratios of standard deviations: how many, least, median, nine tenths, most")
    for kind, found in sorted(ratios.items()):
        low, middle, high, most = np.quantile(found, [0, 0.5, 0.9, 1])
        print(f"{len(found):6} {low:7.3f} {middle:7.3f} {high:7.3f} {most:8.3f}  {kind}")
    print(*[f"{times:6} {kind}" for kind, times in sorted(looked.items())], sep="\n")
    print(f"{count} plants, {bad} with a wrong statement; margin of {RUNS} runs: {100 * MARGIN:.0f} % of a standard deviation")
    sys.exit(bad > 0)


if __name__ == "__main__":
    main()

"""Checks what the verdict says of trajectories on random plants, by exact ranks at points.

    python3 tests/oracle/trajectories.py target/release/pebo-gen 300 [SEED]

The plants have rates affine in the unmeasured states, with coefficients in outputs, inputs and a parameter, some of them
non-smooth: `x' = A x + b`, `y' = C x + d`, `phi = x`. The unknowns are identifiable at a point where the rows C with
their derivatives along the plant have full rank: with free derivatives of the inputs, with constant inputs, and at an
equilibrium, where nothing moves. Ranks are exact, at rational points inside the cells of the coefficients. Looked at:

- a deficient rank at a random point is that of a refusal, of inputs that are constant, or of a cell that is listed;
- equilibria on a grid: "even at rest" holds at each but those listed, "almost wherever the plant rests" at one of
  them, and a direction that is called unobservable at rest is so at each of them.

Needs SymPy. Exits with 1 on a wrong statement; prints how many statements of each kind were looked at.
"""

import itertools
import json
import random
import re
import subprocess
import sys
import tempfile
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import sympy
from sympy import Integer, Matrix, Rational, Symbol

NAMES = [f"{letter}{i}" for letter in "xqu" for i in (1, 2, 3)] + ["w"]
SYMBOLS = {name: Symbol(name, real=True) for name in NAMES}
FUNCTIONS = {
    "abs": sympy.Abs,
    "sign": sympy.sign,
    "max": sympy.Max,
    "min": sympy.Min,
    "sat": lambda a: sympy.Max(-1, sympy.Min(a, 1)),
}
# Coefficients: constants more often than functions, so that ranks are lost in many ways.
SMOOTH = "0 0 0 0 1 1 -1 2 w u1 -u1 u2 q1 -q1 (q1-1) u1*q1 (u1-w) (u1^2+1) q1^2 (q2-q1)".split()
CORNERS = "abs(u1) max(0,u1) sign(u1) max(u1-w,0) min(q1,w) sat(u1) abs(q1) max(q1,u1) (abs(u1)-u1)".split()
GRID = [-2, -1, 0, Rational(1, 2), 1, 2]
MOST_EQUILIBRIA = 60


def ordinary(draw):
    """A number at which no coefficient is special, as it is at 0 and 1."""
    return Rational(draw.choice([-1, 1]) * (draw.randint(20, 300) * 97 + 1), 97**2)


class Plant:
    """A random plant, its text, and its coefficients."""

    def __init__(self, draw, seed):
        self.n, self.m, self.p = draw.choice([1, 2, 2, 3]), draw.choice([1, 1, 2]), draw.choice([0, 1, 1, 2])
        corners = draw.random() < 0.5
        self.x = [f"x{i + 1}" for i in range(self.n)]
        self.y = [f"q{i + 1}" for i in range(self.m)]
        self.u = [f"u{i + 1}" for i in range(self.p)]
        known = set(self.y + self.u + ["w"])

        def pick(often):
            while True:
                if draw.random() < often:
                    return "0"
                pool = CORNERS if corners and draw.random() < 0.3 else SMOOTH
                text = draw.choice(pool)
                if set(re.findall(r"[xqu]\d|w", text)) <= known:
                    return text

        matrix = lambda rows, often: [[pick(often) for _ in range(self.n)] for _ in range(rows)]
        self.text_a, self.text_c = matrix(self.n, 0.4), matrix(self.m, 0.2)
        self.text_b = [pick(0.5) for _ in range(self.n)]
        self.text_d = [pick(0.4) for _ in range(self.m)]
        self.value = draw.choice([Integer(1), Integer(2), Rational(1, 2)])
        self.positive = draw.random() < 0.2
        rate = lambda row, rest: " + ".join([f"({c})*{x}" for c, x in zip(row, self.x) if c != "0"] + [f"({rest})"])
        lines = [f"model: m{seed}", f"parameters: {{w: {float(self.value)}}}", f"x: [{', '.join(self.x)}]"]
        lines += [f"y: [{', '.join(self.y)}]"] + ([f"u: [{', '.join(self.u)}]"] if self.u else [])
        lines += ["assume: [x1 > 0]"] if self.positive else []
        lines += ["f_x:"] + [f'  {x}: "{rate(r, b)}"' for x, r, b in zip(self.x, self.text_a, self.text_b)]
        lines += ["f_y:"] + [f'  {y}: "{rate(r, d)}"' for y, r, d in zip(self.y, self.text_c, self.text_d)]
        self.text = "\n".join([*lines, f"phi: [{', '.join(self.x)}]", ""])

    def formulas(self, point):
        """A, b, C, d on the cell of a point: each non-smooth function by its branch."""

        def read(text):
            # `text` is one of the coefficients above.
            expr = sympy.sympify(text.replace("^", "**"), locals=SYMBOLS | FUNCTIONS)
            def branch(function):
                value = lambda e: e.subs(point)
                if isinstance(function, sympy.Abs):
                    return function.args[0] * sympy.sign(value(function.args[0]))
                if isinstance(function, sympy.sign):
                    return value(function)
                best = max if isinstance(function, sympy.Max) else min
                return best(function.args, key=value)
            while expr.has(sympy.Abs, sympy.sign, sympy.Max, sympy.Min):
                inner = [f for f in expr.atoms(sympy.Function, sympy.Max, sympy.Min)
                         if not any(a.has(sympy.Abs, sympy.sign, sympy.Max, sympy.Min) for a in f.args)]
                expr = expr.subs({f: branch(f) for f in inner})
            return expr

        return (Matrix([[read(t) for t in row] for row in self.text_a]), Matrix([read(t) for t in self.text_b]),
                Matrix([[read(t) for t in row] for row in self.text_c]), Matrix([read(t) for t in self.text_d]))

    def rows(self, point, draw, moving):
        """C with its derivatives at a point; inputs have random derivatives where they move."""
        a, b, c, d = self.formulas(point)
        x = Matrix([SYMBOLS[name] for name in self.x])
        rates = dict(zip(map(SYMBOLS.get, self.x), a * x + b)) | dict(zip(map(SYMBOLS.get, self.y), c * x + d))
        values = dict(point)
        levels = {}
        for name in self.u if moving else []:
            for order in range(self.n + 1):
                here = SYMBOLS[name] if order == 0 else Symbol(f"{name}_{order}")
                levels[here] = Symbol(f"{name}_{order + 1}")
                values[levels[here]] = ordinary(draw)
        flow = rates | levels
        latest, stack = c, [c.subs(values)]
        for _ in range(1, self.n):
            latest = latest.applyfunc(lambda e: sum((e.diff(s) * r for s, r in flow.items()), Integer(0))) + latest * a
            stack.append(latest.subs(values))
        return Matrix.vstack(*stack)

    def at_rest(self, point):
        """C, C A, .. at an equilibrium, at which nothing moves."""
        a, _, c, _ = self.formulas(point)
        stack = [c.subs(point)]
        for _ in range(1, self.n):
            stack.append(stack[-1] * a.subs(point))
        return Matrix.vstack(*stack)

    def equilibria(self):
        """Equilibria with outputs and inputs on the grid; the states are a solution of the linear equations."""
        names = self.y + self.u
        for values in itertools.product(GRID, repeat=len(names)):
            point = dict(zip(map(SYMBOLS.get, names), map(sympy.sympify, values))) | {SYMBOLS["w"]: self.value}
            a, b, c, d = (m.subs(point) for m in self.formulas(point))
            left, right = Matrix.vstack(a, c), -Matrix.vstack(b, d)
            free = [SYMBOLS[name] for name in self.x]
            solution = sympy.linsolve((left, right), free)
            for states in solution:
                values = {s: Integer(1) for s in free}
                states = [sympy.sympify(e).subs(values) for e in states]
                if not self.positive or states[0] > 0:
                    yield point | dict(zip(free, states))


def holds(condition, point):
    """Whether one comparison of a listed trajectory holds at a point."""
    left, sign, right = re.fullmatch(r"(.*?) (!=|=|<|>=|>) (.*)", condition).groups()
    read = lambda text: sympy.sympify(text.replace("^", "**"), locals=SYMBOLS | FUNCTIONS).subs(point)
    difference = read(left) - read(right)
    # At a pole nothing is compared.
    if not difference.is_real:
        return False
    signs = {"=": difference == 0, "!=": difference != 0, "<": difference < 0, ">": difference > 0, ">=": difference >= 0}
    return signs[sign]


class Listed:
    """A listed trajectory: `while A and B, only .. is identified`."""

    def __init__(self, entry):
        parts = entry["while"].split(" and ")
        self.rests = "the plant rests" in parts
        self.constant = [part for part in parts if part.endswith("constant")]
        self.comparisons = [part for part in parts if part != "the plant rests" and not part.endswith("constant")]
        self.hidden = entry["hidden"]
        self.undecided = not entry["hidden"]
        # A cell holds on a set with inner points; an equation does not.
        self.is_cell = bool(self.comparisons) and all(" = " not in part for part in self.comparisons)

    def covers(self, point):
        return all(holds(part, point) for part in self.comparisons)


def complaints(plant, answer, draw):
    """Wrong statements of an answer, and the number of statements of each kind."""
    looked, wrong = Counter(), []
    found = answer["identifiability"]
    if found["verdict"] not in ("proved", "refuted"):
        looked["undecided"] += 1
        return wrong, looked
    listed = [Listed(entry) for entry in found["blind"] or []]
    names = plant.x + plant.y + plant.u
    for _ in range(6):
        values = {SYMBOLS[name]: ordinary(draw) for name in names}
        # Equal numbers are special: coefficients hold differences.
        if len({abs(value) for value in values.values()}) < len(values):
            continue
        point = values | {SYMBOLS["w"]: plant.value}
        if plant.positive:
            point[SYMBOLS["x1"]] = abs(point[SYMBOLS["x1"]]) + 1
        cell = any(entry.is_cell and not entry.rests and entry.covers(point) for entry in listed)
        free = plant.rows(point, draw, True).rank() == plant.n
        kind = found["kind"]
        looked[f"random point, {kind}"] += 1
        if kind == "never" and free:
            wrong.append(f"never, but identified at {point}")
        if kind == "instant" and plant.formulas(point)[2].subs(point).rank() < plant.n:
            wrong.append(f"instant, but of a lower rank at {point}")
        if kind == "excitation" and not free and not cell:
            wrong.append(f"identified, but not at {point}")
        if kind == "excitation" and found["by_itself"] is True and not cell:
            looked["random point, constant inputs"] += 1
            if plant.rows(point, draw, False).rank() < plant.n:
                wrong.append(f"identified with constant inputs, but not at {point}")
    if found["kind"] != "excitation" or found["by_itself"] is not True:
        return wrong, looked
    text = answer["text"]
    full, deficient = 0, []
    allowed = (p for p in plant.equilibria() if all(holds(c, p) for c in answer["conditions"]))
    for point in itertools.islice(allowed, MOST_EQUILIBRIA):
        observed = plant.at_rest(point)
        if observed.rank() == plant.n:
            full += 1
        else:
            deficient.append(point)
        for entry in listed:
            if entry.rests and not entry.undecided and entry.covers(point):
                looked["direction at an equilibrium"] += 1
                for direction in entry.hidden:
                    read = lambda text: sympy.sympify(text.replace("^", "**"), locals=SYMBOLS | FUNCTIONS)
                    vector = Matrix([read(e).subs(point) for e in direction])
                    if not all(e.is_finite for e in vector):
                        continue  # A direction is scaled, so that an entry is 1: it has poles.
                    if any(e != 0 for e in (observed * vector).applyfunc(sympy.simplify)):
                        wrong.append(f"called unobservable at rest, but observed at {point}: {direction}")
    looked["equilibrium"] += full + len(deficient)
    if "even at rest" in text:
        looked["even at rest"] += 1
        for point in deficient:
            if not any(entry.covers(point) for entry in listed if entry.comparisons):
                wrong.append(f"even at rest, but not at {point}")
    if "almost wherever the plant rests" in text:
        looked["almost wherever at rest"] += 1
        if deficient and not full:
            unlisted = [p for p in deficient if not any(e.covers(p) for e in listed if e.comparisons)]
            if unlisted:
                wrong.append(f"almost wherever at rest, but at none of {len(deficient)}, as {unlisted[0]}")
    return wrong, looked


def look(program, seed, folder):
    draw = random.Random(seed)
    plant = Plant(draw, seed)
    path = Path(folder, f"m{seed}.yaml")
    path.write_text(plant.text)
    def call(*options):
        return subprocess.run([program, "check", *options, path], capture_output=True, text=True, timeout=120)
    said = call("--format", "json")
    try:
        answer = json.loads(said.stdout)
    except json.JSONDecodeError:
        return seed, plant, [f"no answer: {said.stderr[-300:]}"], Counter()
    answer["text"] = call().stdout
    wrong, looked = complaints(plant, answer, draw)
    return seed, plant, wrong, looked


def main():
    program, count = sys.argv[1], int(sys.argv[2])
    first = int(sys.argv[3]) if len(sys.argv) > 3 else 1
    total, bad = Counter(), 0
    with tempfile.TemporaryDirectory() as folder, ThreadPoolExecutor(2) as pool:
        for seed, plant, wrong, looked in pool.map(lambda s: look(program, s, folder), range(first, first + count)):
            total += looked
            if wrong:
                bad += 1
                print(f"seed {seed}: " + "\n  ".join(wrong[:3]) + f"\n{plant.text}")
    for kind, times in sorted(total.items()):
        print(f"{times:6} {kind}")
    print(f"{count} plants, {bad} with a wrong statement")
    sys.exit(bad > 0)


if __name__ == "__main__":
    main()

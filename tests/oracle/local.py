"""Checks verdicts on random plants whose unknowns enter nonlinearly, with `regression: local`, by ranks of their slopes.

    python3 tests/oracle/local.py target/release/pebo-gen 500 [SEED]

One to three unknown constants are in the rate of an output, a random expression of sums, products, exponentials, sines,
hyperbolic tangents and quotients with the output and an input. Looked at, in arithmetic of 60 digits:

- an accepted plant is locally identifiable: the slopes of the rate by the unknowns, at samples of output and input, have
  full rank at one of a few points;
- a rejected one is not: they have it at none.

Needs SymPy. Exits with 1 on a wrong statement; prints how many plants there were of each verdict.
"""

import json
import random
import subprocess
import sys
import tempfile
from collections import Counter
from pathlib import Path

import mpmath
import sympy
from sympy import Integer, cos, exp, lambdify, sin, symbols, tanh

Y, U, *UNKNOWN = symbols("y u a b c")
DIGITS = 60
# Slopes are divided by the largest of their column; what is left of cancellation is far below.
SMALL = mpmath.mpf(10) ** (-DIGITS // 2)
POINTS = 4


def expression(draw, unknowns, depth):
    if depth == 0:
        return draw.choice([*unknowns, Y, U, Integer(1), Integer(2)])
    part = lambda: expression(draw, unknowns, depth - 1)
    kind = draw.random()
    if kind < 0.4:
        # An exponential of one would be beyond all numbers.
        return draw.choice([exp, sin, cos, tanh])(expression(draw, unknowns, min(depth - 1, 1)))
    if kind < 0.6:
        return part() + part()
    return part() * part() if kind < 0.9 else part() / (1 + part() ** 2)


def plant(draw):
    """The unknowns, the rate of the output, and the model; none if the rate lacks one of them."""
    unknowns = UNKNOWN[: draw.choice([1, 2, 2, 3])]
    rate = expression(draw, unknowns, 3)
    if not all(rate.has(unknown) for unknown in unknowns):
        return None
    names = ", ".join(map(str, unknowns))
    constant = ", ".join(f"{unknown}: 0" for unknown in unknowns)
    text = str(rate).replace("E", "exp(1)")
    model = f"model: m\nx: [{names}]\ny: [y]\nu: [u]\nf_x: {{{constant}}}\nf_y: {{y: '{text}'}}\n"
    return unknowns, rate, f"{model}regression: local\nphi: [{names}]\n"


def rank(draw, unknowns, rate):
    """The largest rank of the slopes at a point of the unknowns, over samples of output and input."""
    slopes = lambdify([Y, U, *unknowns], [sympy.diff(rate, unknown) for unknown in unknowns], "mpmath")
    number = lambda: mpmath.mpf(draw.randint(-20, 20)) / 9 + mpmath.mpf(1) / 17
    found = 0
    for _ in range(POINTS):
        point = [number() for _ in unknowns]
        rows = mpmath.matrix([slopes(number(), number(), *point) for _ in range(3 * len(unknowns) + 2)])
        for column in range(rows.cols):
            largest = max(abs(rows[row, column]) for row in range(rows.rows))
            for row in range(rows.rows if largest else 0):
                rows[row, column] /= largest
        values = mpmath.svd_r(rows, compute_uv=False)
        found = max(found, sum(1 for value in values if value > SMALL))
    return found


def main():
    mpmath.mp.dps = DIGITS
    program, count = sys.argv[1], int(sys.argv[2])
    draw = random.Random(int(sys.argv[3]) if len(sys.argv) > 3 else 1)
    verdicts, wrong = Counter(), 0
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "m.yaml"
        while sum(verdicts.values()) < count:
            drawn = plant(draw)
            if drawn is None:
                continue
            unknowns, rate, model = drawn
            file.write_text(model)
            answer = subprocess.run([program, "check", file, "--format", "json"], capture_output=True, text=True)
            verdict = json.loads(answer.stdout)["verdict"]
            verdicts[verdict] += 1
            is_full = rank(draw, unknowns, rate) == len(unknowns)
            if verdict != "undecided" and is_full != (verdict == "accepted"):
                wrong += 1
                print(f"wrong: {verdict}\n{model}")
    print(", ".join(f"{number} {verdict}" for verdict, number in sorted(verdicts.items())), f"; wrong: {wrong}", sep="")
    sys.exit(1 if wrong else 0)


main()

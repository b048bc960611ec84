"""Checks verdicts on random plants with polynomial identities, by ranks at points of each factor's curve.

    python3 tests/oracle/identities.py target/release/pebo-gen 200 [SEED]

Two unknown constants a and b are on a curve, F(a, b) = 0: a circle, an ellipse, Pascal's snail or another, or on one of
two curves, as F is a product. An output, by its rate or its value, is a sum of inputs times functions of a and b, some
of which say nothing on one of the curves. Looked at:

- an identity whose curve has points is never refuted, and not called without values;
- an accepted plant is observable on each curve: at a point of it the differentials of F and of the functions have rank
  2, in arithmetic of 60 digits.

Needs SymPy. Exits with 1 on a wrong statement; prints how many plants there were of each verdict.
"""

import json
import random
import subprocess
import sys
import tempfile
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import mpmath
import sympy
from sympy import Float, Matrix, Rational, symbols

A, B, W, V = symbols("a b w v")
DIGITS = 60


def curve(draw):
    """A polynomial whose zeros are a curve, and a ray from its inside that meets it."""
    scale = draw.choice([1, 2, Rational(1, 2)])
    return draw.choice(
        [
            A**2 + B**2 - scale**2,
            A**2 + 3 * B**2 - scale**2,
            A**4 + B**4 - scale,
            (A**2 + B**2 - A / 2) ** 2 - scale * (A**2 + B**2),
            B - scale * A**2 - 1,
            A**3 + A * B + B**3 - scale,
        ]
    )


def plant(draw):
    """The factors, whether the output is given by its value, and the functions in it."""
    factors = [curve(draw) for _ in range(draw.choice([1, 1, 2]))]
    if len(factors) == 2 and factors[0] == factors[1]:
        factors.pop()
    known = [A, B, A + B, A * B, A**2, A * factors[0], B * factors[-1] + A, B**2 + A]
    return factors, draw.random() < 0.5, draw.sample(known, draw.choice([1, 2]))


def text(product, by_value, functions):
    show = lambda e: str(sympy.expand(e)).replace("**", "^")
    output = show(sum(u * function for u, function in zip((W, V), functions)))
    equation = f"g_y: {{s: '{output}'}}" if by_value else f"f_y: {{s: '{output}'}}"
    return (
        f"model: m\nx: [a, b]\ny: [s]\nu: [w, v]\nf_x: {{a: 0, b: 0}}\n{equation}\n"
        f"identities: ['{show(product)}']\nphi: [a, b]\n"
    )


def points(factor, draw):
    """Points of a factor's curve to many digits."""
    found = []
    for _ in range(60):
        start, end = ([Rational(draw.randint(-30, 30), 7) for _ in range(2)] for _ in range(2))
        share = sympy.Dummy()
        line = sympy.expand(factor.subs({A: start[0] + share * end[0], B: start[1] + share * end[1]}, simultaneous=True))
        try:
            roots = sympy.Poly(line, share).nroots(n=DIGITS, maxsteps=200) if line.has(share) else []
        except mpmath.libmp.NoConvergence:
            continue
        for root in roots:
            if abs(sympy.im(root)) < Float(10) ** (-DIGITS // 2):
                root = sympy.re(root)
                found.append({A: start[0] + root * end[0], B: start[1] + root * end[1]})
        if len(found) >= 4:
            break
    return found


def observable(point, product, functions):
    """True if the differentials have rank 2 at the point."""
    rows = [[sympy.diff(e, x).subs(point).evalf(DIGITS) for x in (A, B)] for e in [product, *functions]]
    minors = [Matrix([r, s]).det() for i, r in enumerate(rows) for s in rows[:i]]
    # The points satisfy F to some 30 digits, so that a minor which is zero there is far below this.
    return any(abs(minor) > Float(10) ** (-DIGITS // 3) for minor in minors)


def judge(program, seed):
    draw = random.Random(seed)
    factors, by_value, functions = plant(draw)
    product = sympy.prod(factors)
    written = text(product, by_value, functions)
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "m.yaml"
        file.write_text(written)
        run = subprocess.run([program, "check", "--format", "json", str(file)], capture_output=True, text=True, timeout=120)
    answer = json.loads(run.stdout)
    verdict = answer["verdict"]
    codes = {diagnostic["code"] for diagnostic in answer["diagnostics"]}
    messages = " ".join(diagnostic["message"] for diagnostic in answer["diagnostics"])
    wrong = []
    curves = [points(factor, draw) for factor in factors]
    if any(curves) and ("identity-refuted" in codes or "no values were found" in messages):
        wrong.append("an identity that holds at points and is invariant is refused")
    if verdict == "accepted":
        for factor, there in zip(factors, curves):
            if there and not any(observable(p, product, functions) for p in there):
                wrong.append(f"accepted, but not observable where {factor} = 0")
    return seed, written, verdict, len(factors), wrong


def main():
    program, count = sys.argv[1], int(sys.argv[2])
    first = int(sys.argv[3]) if len(sys.argv) > 3 else 1
    seen, failed = Counter(), 0
    with ThreadPoolExecutor(2) as pool:
        for seed, written, verdict, factors, wrong in pool.map(lambda s: judge(program, s), range(first, first + count)):
            seen[f"{factors} curves, {verdict}"] += 1
            for statement in wrong:
                failed += 1
                print(f"seed {seed}: {statement}\n{written}")
    for kind, number in sorted(seen.items()):
        print(f"{number:5} {kind}")
    print(f"{failed} wrong")
    sys.exit(1 if failed else 0)


main()

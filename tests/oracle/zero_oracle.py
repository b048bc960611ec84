"""Checks the verdicts of the zero test's campaign with SymPy and mpmath.

Write the cases, then read them (the second number is how many to sample, all if left out):

    PEBO_CASES=$PWD/target/cases.tsv cargo test --release -p pebo-gen --test campaign
    python3 tests/oracle/zero_oracle.py target/cases.tsv 5000

Needs SymPy and mpmath. The value at random points of the domain decides, with 150 and with 250 digits: a
value that differs from zero is the same with both, while what rounding leaves of zero is not. A case called zero
must have no such value, one called nonzero must have one. `simplify` is asked of short open cases only, for
information. Exits with 1 on a wrong verdict.
"""

import random
import sys
from collections import Counter

import mpmath
import sympy

FEW, MANY = 150, 250
mpmath.mp.dps = MANY
NAMES = "x y z a b p q r t w".split()
SYMBOLS = {name: sympy.Symbol(name, real=True) for name in NAMES}
LOCALS = SYMBOLS | {"abs": sympy.Abs, "atan2": sympy.atan2, "pi": sympy.pi, "min": sympy.Min, "max": sympy.Max}
LOCALS |= {"sat": lambda a: sympy.Max(-1, sympy.Min(a, 1))}


def real(function, allowed=None):
    """The real function: not a number outside its real domain."""

    def value(*arguments):
        if allowed and not allowed(*arguments):
            raise ValueError
        return function(*arguments)

    return value


def power(base, exponent):
    if exponent == int(exponent):
        return base ** int(exponent)
    if base < 0:
        raise ValueError
    return base**exponent


FUNCTIONS = {name: getattr(mpmath, name) for name in "sin cos tan sinh cosh tanh asinh exp atan atan2".split()} | {
    "abs": abs,
    "min": min,
    "max": max,
    "sat": lambda a: max(-1, min(a, 1)),
    "sign": real(mpmath.sign, lambda a: a != 0),
    "pi": mpmath.pi,
    "sqrt": real(mpmath.sqrt, lambda a: a >= 0),
    "log": real(mpmath.log, lambda a: a > 0),
    "acosh": real(mpmath.acosh, lambda a: a >= 1),
    "atanh": real(mpmath.atanh, lambda a: abs(a) < 1),
    "asin": real(mpmath.asin, lambda a: abs(a) <= 1),
    "acos": real(mpmath.acos, lambda a: abs(a) <= 1),
    "atan2": real(mpmath.atan2, lambda a, b: (a, b) != (0, 0)),
    "power": power,
    "num": mpmath.mpf,
}


def compiled(text):
    """The formula as Python code over exact decimals, with real powers as calls."""
    import ast

    class Rewrite(ast.NodeTransformer):
        def visit_BinOp(self, node):
            self.generic_visit(node)
            if isinstance(node.op, ast.Pow):
                return ast.Call(ast.Name("power", ast.Load()), [node.left, node.right], [])
            return node

        def visit_Constant(self, node):
            return ast.Call(ast.Name("num", ast.Load()), [ast.Constant(repr(node.value))], [])

    tree = Rewrite().visit(ast.parse(text.replace("^", "**"), mode="eval"))
    return compile(ast.fix_missing_locations(tree), "case", "eval")


def points(random_source, reach):
    ranges = {"p": (0.05, 2.5), "q": (0.05, 2.5), "r": (0.05, 2.5), "t": (-0.95, 0.95), "w": (0.05, 1.5)}
    while True:
        yield {n: mpmath.mpf(random_source.uniform(*ranges.get(n, (-reach, reach)))) for n in NAMES}


def at(digits, code, point):
    with mpmath.workdps(digits):
        return eval(code, FUNCTIONS, point)


def differs_from_zero(few, many):
    """A value with few and with many digits is one number other than zero, and not rounding.

    Rounding leaves of zero what is a hundred orders smaller with a hundred digits more, or nothing with either.
    """
    return abs(few - many) < abs(many) / 2


def largest(text, random_source, times=12, reach=2.5):
    """The largest absolute value over some points, zero if it is rounding, and the number of points with a value."""
    code, best, seen = compiled(text), mpmath.mpf(0), 0
    for _, point in zip(range(times), points(random_source, reach)):
        try:
            few, many = at(FEW, code, point), at(MANY, code, point)
        except (ValueError, ZeroDivisionError, OverflowError):
            continue
        seen += 1
        if differs_from_zero(few, many):
            best = max(best, abs(many))
    return best, seen


def main():
    with open(sys.argv[1], encoding="utf-8") as file:
        rows = [line.rstrip("\n").split("\t") for line in file if not line.startswith("#")]
    source = random.Random(1)
    if len(sys.argv) > 2 and int(sys.argv[2]) < len(rows):
        rows = source.sample(rows, int(sys.argv[2]))
    counts, wrong = Counter(), []
    for group, said, text in rows:
        value, seen = largest(text, source)
        if not seen:
            counts[group, said, "no value"] += 1
        elif said == "open":
            counts[group, said, "is zero" if value == 0 else "is not"] += 1
        elif (value == 0) == (said == "zero"):
            counts[group, said, "confirmed"] += 1
        else:
            # It may differ on a small part of the domain only, or far out: `sat(4 + (y/3)^3)` is 1 but for y < -4.3.
            if said == "nonzero" and any(largest(text, source, 2000, reach)[0] > 0 for reach in (2.5, 20)):
                counts[group, said, "confirmed"] += 1
                continue
            counts[group, said, "WRONG"] += 1
            wrong.append((said, text, mpmath.nstr(value, 5)))
    simplified = 0
    for group, said, text in [row for row in rows if row[1] == "zero" and len(row[2]) < 60][:40]:
        simplified += sympy.simplify(sympy.sympify(text.replace("^", "**"), locals=LOCALS)) == 0
    for key in sorted(counts):
        print("{:<15} {:<8} {:<10} {:>7}".format(*key, counts[key]))
    print(f"of at most 40 short proofs, SymPy's simplify follows {simplified}")
    for said, text, value in wrong[:50]:
        print(f"WRONG {said}: {text}  (largest value {value})")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())

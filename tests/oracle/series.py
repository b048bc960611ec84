"""Formulas of the model file as exact power series in time, along trajectories that stay in a cell.

A cell is where all arguments of `abs`, `sign`, `max`, `min` and `sat` keep their signs; the formulas are smooth there.
"""

import re
from decimal import Context, Decimal
from fractions import Fraction
from math import isqrt

ORDER = 4
CELL = []  # The signs that were asked for since it was last cleared.


class NoValue(Exception):
    """On a wall of a cell, or where a formula has a pole."""


class Series:
    """The first terms of a power series in time."""

    def __init__(self, terms):
        self.terms = (list(terms) + [Fraction(0)] * ORDER)[:ORDER]

    def __add__(self, other):
        return Series(a + b for a, b in zip(self.terms, other.terms))

    def __neg__(self):
        return Series(-a for a in self.terms)

    def __sub__(self, other):
        return self + -other

    def __mul__(self, other):
        a, b = self.terms, other.terms
        return Series(sum((a[i] * b[k - i] for i in range(k + 1)), Fraction(0)) for k in range(ORDER))

    def __truediv__(self, other):
        a, b, found = self.terms, other.terms, []
        if b[0] == 0:
            raise NoValue
        for k in range(ORDER):
            found.append((a[k] - sum(found[i] * b[k - i] for i in range(k))) / b[0])
        return Series(found)

    def __pow__(self, power):
        result = number(1)
        for _ in range(abs(int(power.terms[0]))):
            result *= self
        return result if power.terms[0] >= 0 else number(1) / result

    def sign(self):
        if self.terms[0] == 0:
            raise NoValue
        CELL.append(self.terms[0] > 0)
        return 1 if CELL[-1] else -1

    def positive(self):
        """Of an argument of `abs` or `max`, that may be zero for ever."""
        return not any(self.terms) or self.sign() > 0

    def rate(self):
        return Series([(k + 1) * c for k, c in enumerate(self.terms[1:])])


number = lambda text: Series([Fraction(text)])
total = lambda terms: sum(terms, number(0))
zero = lambda series: not any(series.terms[: ORDER - 2])
larger = lambda a, b: a if (a - b).positive() else b
smaller = lambda a, b: b if (a - b).positive() else a
def root(a):
    """Of a number, to 200 digits: an affine expression of it that is zero at rational points is zero with these too."""
    inside = a.terms[0] * 10**400
    if any(a.terms[1:]) or inside < 0:
        raise NoValue
    return number(Fraction(isqrt(inside.numerator // inside.denominator), 10**200))


def logarithm(a):
    """Of a positive start, to 200 digits: zero is exact."""
    if a.terms[0] <= 0:
        raise NoValue
    digits = Context(prec=200)
    start = digits.ln(digits.divide(Decimal(a.terms[0].numerator), Decimal(a.terms[0].denominator)))
    slopes = (a.rate() / a).terms
    return Series([Fraction(start)] + [slope / (k + 1) for k, slope in enumerate(slopes)])


FUNCTIONS = {
    "sqrt": root, "log": logarithm, "number": number, "max": larger, "min": smaller, "sign": lambda a: number(a.sign()),
    "abs": lambda a: a if a.positive() else -a, "sat": lambda a: larger(number(-1), smaller(a, number(1))),
}
COMPILED = {}


def value(text, names):
    """A formula of the model file along a trajectory."""
    if text not in COMPILED:
        code = re.sub(r"(?<![\w.])\d+(\.\d+)?", lambda n: f"number('{n[0]}')", text.replace("^", "**"))
        COMPILED[text] = compile(code.strip(), text, "eval")
    return eval(COMPILED[text], FUNCTIONS, names)


def holds(condition, names):
    """Whether a chain of comparisons holds at the start of a trajectory."""
    parts = re.split(r"\s(!=|>=|<=|=|<|>)\s", condition)
    values = [value(text, names).terms[0] for text in parts[::2]]
    compare = {"!=": lambda a, b: a != b, ">=": lambda a, b: a >= b, "<=": lambda a, b: a <= b,
               "=": lambda a, b: a == b, "<": lambda a, b: a < b, ">": lambda a, b: a > b}
    return all(compare[sign](*values[i : i + 2]) for i, sign in enumerate(parts[1::2]))


def flow(names, unknowns, rates):
    """The names with the solution of differential equations, from the first terms of the unknowns."""
    names = dict(names) | {s: number(start) for s, start in unknowns.items()}
    for k in range(ORDER - 1):
        found = rates(names)
        names |= {s: Series(names[s].terms[: k + 1] + [found[s].terms[k] / (k + 1)]) for s in unknowns}
    return names


def rank(rows):
    rows, found = [list(row) for row in rows], 0
    for column in range(len(rows[0]) if rows else 0):
        pivot = next((r for r in range(found, len(rows)) if rows[r][column]), None)
        if pivot is None:
            continue
        rows[found], rows[pivot] = rows[pivot], rows[found]
        for r in range(found + 1, len(rows)):
            factor = rows[r][column] / rows[found][column]
            rows[r] = [a - factor * b for a, b in zip(rows[r], rows[found])]
        found += 1
    return found


def coefficients(rows, lam, names, n):
    """The coefficients of theta, with the fundamental matrix: a row for each equation and derivative."""
    matrix = [[value(t, names) for t in row] for row in lam]
    unit = {(i, j): int(i == j) for i in range(n) for j in range(n)}
    psi = flow({}, unit, lambda psi: {(i, j): total(matrix[i][l] * psi[l, j] for l in range(n)) for i, j in unit})
    known = [[value(t, names) for t in row[1:]] for row in rows]
    known = [[total(row[l] * psi[l, j] for l in range(n)) for j in range(n)] for row in known]
    return [[entry.terms[k] for entry in row] for k in range(ORDER - 1) for row in known]

"""Checks verdicts on random plants with non-smooth functions, whose truth is known by construction.

    python3 tests/oracle/cells.py target/release/pebo-gen 300 [SEED]

A plant is drawn as `z' = Lambda z + h` with outputs that show z by their rates, by their values, or beside rates that z
multiplies; then its states are changed by piecewise linear maps and reciprocals, with thresholds that are parameters or
outputs. False plants break one claim, often in one cell of the signs of all arguments only: a rate that keeps a state, a
transform that folds or jumps, a left inverse of one cell, a rate with a kink in z, an unknown that no cell shows. An
assumption that leaves the cell out makes them true again. Looked at, by exact power series along trajectories from
random rational points in each cell:

- the construction itself: a claim is true if its formulas hold in every cell, false by points with the same outputs,
  inputs and parameters;
- a claim that is proved is not false at points that satisfy the conditions, and one that is refuted is not true;
- the formulas of the answer: h, Lambda, the left inverse and the regression;
- what it says of cells: the rank is full where no cell is listed, and as low as said where one is.

Exits with 1 on a wrong statement, which it prints with the plant; counts the verdicts of each kind of plant, and what is
true and undecided by the program's reason.
"""

import json
import random
import re
import subprocess
import sys
import tempfile
from collections import Counter, defaultdict
from fractions import Fraction
from pathlib import Path

ORDER = 4
CLAIMS = ("cascade", "left_inverse", "regression", "identifiability")
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
        return Series(sum((a[i] * b[k - i] for i in range(k + 1) if a[i] and b[k - i]), Fraction(0)) for k in range(ORDER))

    def __truediv__(self, other):
        a, b, found = self.terms, other.terms, []
        if b[0] == 0:
            raise NoValue
        for k in range(ORDER):
            found.append((a[k] - sum(found[i] * b[k - i] for i in range(k))) / b[0])
        return Series(found)

    def __pow__(self, other):
        power = other.terms[0]
        result = number(1)
        for _ in range(abs(int(power))):
            result *= self
        return result if power >= 0 else number(1) / result

    def sign(self):
        if self.terms[0] == 0:
            raise NoValue
        CELL.append(self.terms[0] > 0)
        return 1 if CELL[-1] else -1

    def rate(self):
        return Series([(k + 1) * c for k, c in enumerate(self.terms[1:])])


def number(text):
    return Series([Fraction(text)])


larger = lambda a, b: a if (a - b).sign() > 0 else b
smaller = lambda a, b: b if (a - b).sign() > 0 else a
FUNCTIONS = {
    "number": number, "max": larger, "min": smaller, "sign": lambda a: number(a.sign()),
    "abs": lambda a: a if a.sign() > 0 else -a, "sat": lambda a: larger(number(-1), smaller(a, number(1))),
}
COMPILED = {}


def value(text, names):
    """A formula of the model file along a trajectory."""
    if text not in COMPILED:
        code = re.sub(r"(?<![\w.])\d+(\.\d+)?", lambda n: f"number('{n[0]}')", str(text).replace("^", "**"))
        COMPILED[text] = compile(code.strip(), text, "eval")
    return eval(COMPILED[text], FUNCTIONS, names)


def holds(condition, names):
    """Whether a chain of comparisons holds at the start of a trajectory."""
    parts = re.split(r"\s(!=|>=|<=|=|<|>)\s", condition)
    values = [value(text, names).terms[0] for text in parts[::2]]
    compare = {"!=": lambda a, b: a != b, ">=": lambda a, b: a >= b, "<=": lambda a, b: a <= b,
               "=": lambda a, b: a == b, "<": lambda a, b: a < b, ">": lambda a, b: a > b}
    return all(compare[sign](*values[i : i + 2]) for i, sign in enumerate(parts[1::2]))


def rank(rows):
    rows, found = [list(row) for row in rows], 0
    for column in range(len(rows[0]) if rows else 0):
        pivot = next((r for r in range(found, len(rows)) if rows[r][column]), None)
        if pivot is None:
            continue
        rows[found], rows[pivot] = rows[pivot], rows[found]
        for r in range(found + 1, len(rows)):
            factor = rows[r][column] / rows[found][column]
            if factor:
                rows[r] = [a - factor * b for a, b in zip(rows[r], rows[found])]
        found += 1
    return found


def times(a, b):
    return "0" if "0" in (a, b) else b if a == "1" else a if b == "1" else f"({a})*({b})"


def plus(*terms):
    return " + ".join(f"({t})" if " " in t else t for t in terms if t != "0") or "0"


class Plant:
    """A random plant with the formulas that show its claims."""

    def __init__(self, seed):
        self.draw = draw = random.Random(seed)
        self.seed, self.assume, self.given, self.flat, self.jumps, self.search = seed, [], None, False, set(), False
        self.kink = False  # The rate of the output has a kink in z, which moves: no regression.
        self.parameters = {"p": draw.choice([None, None, "0.3", "2", "-0.7"])}
        self.n = draw.choice([1, 1, 2, 2, 3])
        self.x, self.y, self.u = list("abc")[: self.n], ["q"], ["v"]
        self.kind = draw.choice(KINDS)
        self.static = "value" in self.kind
        known = ["v"] if self.static else ["v", "q"]
        self.know = known
        self.lam = [["0"] * self.n for _ in self.x]
        if draw.random() < 0.4:
            self.lam[draw.randrange(self.n)][draw.randrange(self.n)] = self.coefficient()
        self.h = [self.coefficient() if draw.random() < 0.8 else "0" for _ in self.x]
        self.c = [[self.coefficient(0.6) for _ in self.x]]
        self.d = [self.coefficient() if draw.random() < 0.5 else "0"]
        if draw.random() < 0.3 and not self.static and self.n > 1:
            self.y.append("r")
            self.c.append([self.coefficient(0.6) for _ in self.x])
            self.d.append("0")
        getattr(self, "make_" + self.kind.split(",")[0].replace(" ", "_"))()

    def argument(self):
        pool = "v v-p 2*v-1 v^2-p v+p".split() + ("q q-p q-v v*q q+p".split() if "q" in self.know else [])
        return self.draw.choice(pool).replace("-", " - ").replace("+", " + ")

    def coefficient(self, corners=0.5):
        e, f = self.argument(), self.argument()
        if self.draw.random() > corners:
            return self.draw.choice(["1", "1", "2", "v", "p", e, f"{e}^2".replace(e, f"({e})"), "v^2 + 1"])
        return self.draw.choice([
            f"abs({e})", f"max(0, {e})", f"min({e}, 0)", f"max({e}, {f})", f"min({e}, {f})", f"sat({e})", f"sign({e})",
            f"max(0, abs({e}) - p)", f"abs({e}) - ({e})", f"max(0, {e})^2", f"({e})*sign({f})", f"1 + sign({e})",
            f"min(max({e}, 0), {f})", self.positive()])

    def positive(self):
        e = self.argument()
        return self.draw.choice([f"1 + abs({e})", f"2 + sign({e})", f"max(1, {e})", f"1/(1 + abs({e}))", f"2 + sat({e})"])

    def build(self, ways=None, keep=None):
        """The equations in x from those in z: `ways` says for each state how it is changed."""
        n, draw = self.n, self.draw
        ways = ways or [draw.choice(WAYS) for _ in self.x]
        if self.static:
            ways = [w if w in ("bijection", "reciprocal", "abs", "fold", "plateau", "same") else "same" for w in ways]
        if ways[-1] == "shift by state":
            ways[-1] = "bijection"
        z, slope, plain, left = [None] * n, {}, [], [None] * n
        kinks = lambda e: draw.choice([
            (f"abs({e})", f"sign({e})"), (f"max(0, {e})", f"(1 + sign({e}))/2"), (f"min({e}, 0)", f"(1 - sign({e}))/2"),
            (f"sat({e})", f"(sign({e} + 1) - sign({e} - 1))/2"), (f"({e})*abs({e})", f"2*abs({e})"), (f"max(0, {e})^2", f"2*max(0, {e})")])
        # slope: z' = own x' + q' of the output + other x_(i+1)'.
        for i in reversed(range(n)):
            x, s, way = self.x[i], f"z{i + 1}", ways[i]
            t = draw.choice(["p", "p", "1", "0"]) if "output" not in way else "q"
            e = x if t == "0" else f"{x} - {t}"
            over = lambda own, q="0", other="0": slope.__setitem__(i, (own, q, other))
            if way == "same":
                z[i], left[i] = x, s
                over("1")
            elif way == "shift by output":
                f, g = kinks(draw.choice(["q", "q - p"]))
                z[i], left[i] = f"{x} + {f}", f"{s} - ({f})"
                over("1", g)
            elif way == "shift by state":
                f, g = kinks(self.x[i + 1])
                z[i], left[i] = f"{x} + {f}", f"{s} - ({f.replace(self.x[i + 1], '(' + left[i + 1] + ')')})"
                if re.search(rf"[a-z]*{self.x[i + 1]}[a-z]+", f):  # a name within a function's: by whole words
                    left[i] = f"{s} - ({re.sub(rf'(?<![a-z]){self.x[i + 1]}(?![a-z])', '(' + left[i + 1] + ')', f)})"
                over("1", "0", g)
            elif way in ("bijection", "bijection at output"):
                k, j = draw.choice([(3, 1), (2, -1), (1, 2), (2, 1)]), draw.randrange(4)
                if j == 0 or (j == 3 and t == "q"):
                    c, d = (3, k[1])
                    z[i], own = f"{c}*{x} + {d}*abs({e})".replace("+ -", "- "), f"{c} + {d}*sign({e})".replace("+ -", "- ")
                    left[i] = f"{t} + ({c}*({s} - {c}*{t}) - ({d})*abs({s} - {c}*{t}))/{c * c - d * d}"
                    over(own, f"-({d})*sign({e})" if t == "q" else "0")
                elif j == 1:
                    z[i], own = f"{x} + {k[0]}*max(0, {e})", f"1 + {k[0]}*(1 + sign({e}))/2"
                    left[i] = f"{s} - {k[0]}*max(0, {s} - {t})/{k[0] + 1}"
                    over(own, f"-{k[0]}*(1 + sign({e}))/2" if t == "q" else "0")
                elif j == 2:
                    z[i], own = f"{x} + {k[0]}*min({x}, {t})", f"1 + {k[0]}*(1 - sign({e}))/2"
                    left[i] = f"{s} - {k[0]}*min({s}/{k[0] + 1}, {t})"
                    over(own, f"{k[0]}*(1 + sign({e}))/2" if t == "q" else "0")
                else:
                    z[i], left[i] = f"{x} + sat({x})", f"{s} - sat({s}/2)"
                    over(f"1 + (sign({x} + 1) - sign({x} - 1))/2")
            elif way == "reciprocal":
                z[i], left[i] = f"1/{x}", f"1/{s}"
                over(f"(-1/{x}^2)")
            elif way == "scaled by output":
                m, g = draw.choice([("1 + abs(q)", "sign(q)"), ("1 + max(0, q - p)", "(1 + sign(q - p))/2"), ("2 - sat(q)", "-(sign(q + 1) - sign(q - 1))/2")])
                z[i], left[i] = f"{x}*({m})", f"{s}/({m})"
                over(m, f"{x}*{g}" if g[0] != "-" else f"(-{x})*{g[1:]}")
            elif way == "abs":
                z[i] = f"abs({e})"
                left[i] = {">": f"{s} + {t}", "<": f"{t} - {s}"}[self.side]
                over(f"sign({e})")
                self.wall = (x, t)
            elif way == "fold":
                z[i], left[i] = f"{x} + 2*abs({e})", f"({s} + 2*{t})/3" if self.side == ">" else f"2*{t} - {s}"
                over(f"1 + 2*sign({e})")
                self.wall = (x, t)
            elif way == "plateau":
                z[i], left[i] = (f"max({x}, {t})", s) if self.side == ">" else (f"min({x}, {t})", s)
                over("1")
                self.h[i], self.lam[i] = "0", ["0"] * n
                self.wall = (x, t)
            elif way == "jump":
                e = draw.choice(["q", "q - p", e, f"{x} + q"] if not self.static else [e])
                z[i] = f"{x} + sign({e})" if x in e or draw.random() < 0.5 else f"{x}*(2 + sign({e}))"
                own = "1" if "*" not in z[i] else f"2 + sign({e})"
                left[i] = f"{s}/({own})" if own != "1" else f"{s} - sign({e.replace(x, s)})"
                over(own)
                self.jumps.add(i)
                self.wall = e
        self.phi, self.left = z, dict(zip(self.x, left))
        zs = [f"({t})" if " " in t else t for t in z]
        self.zs = zs
        linear = lambda row: [times(k, t) for k, t in zip(row, zs)]
        outputs = self.outputs(linear) if hasattr(self, "outputs") else [plus(*linear(c), d) for c, d in zip(self.c, self.d)]
        self.f_y, self.g_y = ({}, dict(zip(self.y, outputs))) if self.static else (dict(zip(self.y, outputs)), {})
        self.f_x = {}
        for i in reversed(range(n)):
            own, q, other = slope[i]
            rate = plus(*linear(self.lam[i]), self.h[i])
            less = [times(q, self.f_y["q"])] if q != "0" else []
            less += [times(other, self.f_x[self.x[i + 1]])] if other != "0" else []
            rate = " - ".join([rate if not less else f"({rate})", *less])
            self.f_x[self.x[i]] = f"-{self.x[i]}^2*({rate})" if own.startswith("(-1/") else rate if own == "1" else f"({rate})/({own})"
            if ways[i] == "plateau":
                self.f_x[self.x[i]] = f"v*{'min' if self.side == '>' else 'max'}(0, {self.wall[0]} - {self.wall[1]})"
        if not hasattr(self, "rows"):
            rates = [y if self.static else f"rate_{y}" for y in self.y]
            self.rows = [[f"{d} - {r}", *c] for r, c, d in zip(rates, self.c, self.d)]
        self.kind += "".join(f", {w}" for w in sorted(set(ways)) if w != "same")

    # The kinds. A claim that is expected to be false is named in `false`; what is left is expected to be true.
    false = ()

    def make_rates(self):
        self.build()
        self.search = self.draw.random() < 0.15

    def make_values(self):
        self.build()
        self.search = self.draw.random() < 0.15

    def make_given_left_inverse(self):
        self.build()
        self.given = dict(self.left)

    def make_value_through_a_bijection(self):
        k = self.draw.choice([1, 2])
        self.outputs = lambda linear: [f"{e} + {k}*max(0, {e})" for e in [f"({plus(*linear(self.c[0]), self.d[0])})"]]
        self.rows = [[f"{self.d[0]} - (q - {k}*max(0, q)/{k + 1})", *self.c[0]]]
        self.build(["same"] * self.n)

    def make_output_through_a_bijection(self):
        m = self.draw.choice(["3 + sign(q)", "2 - sign(q - p)", "1 + (1 + sign(q - p))/2"])
        self.c = [[times(m, k) for k in row] for row in self.c]
        self.d = [times(m, k) for k in self.d]
        self.build()

    def implicit(self):
        self.n, self.x, self.y = min(self.n, 2), self.x[:2], ["q"]
        self.lam, self.h = [row[: self.n] for row in self.lam[: self.n]], self.h[: self.n]
        k, g, r = self.coefficient(), self.coefficient(), "q" if self.static else "rate_q"
        def outputs(linear):
            top = g if self.n == 1 else f"{g} - {times(k, self.zs[1])}"
            return [f"{self.x[0]}*({top})" if self.zs[0].startswith("1/") else f"({top})/{self.zs[0]}"]
        self.outputs = outputs
        self.rows = [[f"-({g})", r, k][: self.n + 1]]
        ways = [self.draw.choice(["same", "reciprocal", "reciprocal"]), self.draw.choice(["same", "shift by output", "bijection"])]
        self.build(ways[: self.n])
        self.search = self.draw.random() < 0.1

    make_divided_rates = make_divided_value = implicit

    def twin(self, cell, opposite, false):
        """Half of the plants assume the opposite of the cell, in which a claim is false."""
        self.false = false
        if self.draw.random() < 0.4:
            self.assume.append(opposite)
            self.false = ()
            self.kind += ", excluded"

    def make_state_kept_on_a_cell(self):
        self.build([w if w != "shift by state" else "same" for w in (self.draw.choice(("same", "same", "shift by output")) for _ in self.x)])
        x, t = self.x[0], self.draw.choice(["p", "q", "v", "1"])
        text, cell, opposite = self.draw.choice([
            (f"max(0, {x} - {t})", f"{x} > {t}", f"{x} < {t}"), (f"min({x}, {t}) - {t}", f"{x} < {t}", f"{x} > {t}"),
            (f"v*(abs({x} - {t}) - {x} + {t})", f"{x} < {t}", f"{x} > {t}"), (f"max(0, v - p)*{x}^2", "v > p", "v < p"),
            (f"{x}^2*(1 + sign(q - p))", "q > p", "q < p"), (f"sat({x}) - {x}", f"{x} > 1", f"-1 < {x} < 1")])
        self.f_x[x] = plus(self.f_x[x], text)
        self.twin(cell, opposite, ("cascade",))

    def make_folded(self):
        self.side = self.draw.choice("<>")
        way = self.draw.choice(["abs", "fold", "plateau"])
        self.build([way] + ["same"] * (self.n - 1))
        x, t = self.wall
        self.twin("", f"{x} {self.side} {t}", ("left_inverse",))

    def make_folded_value(self):
        self.make_folded()

    def make_ordered(self):
        """The larger and the smaller of two states: which is which is known by an assumption alone."""
        self.__dict__.update(n=2, x=["a", "b"], y=["q"], lam=[["0", "0"], ["0", "0"]], c=[["1", "v"]], d=self.d[:1])
        self.h = [self.coefficient(), self.coefficient()]
        self.build(["same", "same"])
        self.phi = self.draw.choice([["max(a, b)", "min(a, b)"], ["a + b", "abs(a - b)"], ["a + b", "max(a, b)"]])
        one, two = self.h
        first, second = {"m": (one, two), "a": (f"({one} + {two})/2", f"({one} - ({two}))/2")}[self.phi[0][0]]
        if self.phi[1][0] == "m" and self.phi[0][0] == "a":
            first, second = two, f"{one} - ({two})"
        self.f_x = {"a": f"(({first}) + ({second}))/2 + sign(a - b)*(({first}) - ({second}))/2",
                    "b": f"(({first}) + ({second}))/2 - sign(a - b)*(({first}) - ({second}))/2"}
        if self.phi == ["a + b", "abs(a - b)"]:
            self.f_x = {"a": f"(({one}) + sign(a - b)*({two}))/2", "b": f"(({one}) - sign(a - b)*({two}))/2"}
            self.left = {"a": "(z1 + z2)/2", "b": "(z1 - z2)/2"}
        elif self.phi[0] == "a + b":
            self.f_x = {"a": f"(({one}) + sign(a - b)*(2*({two}) - ({one})))/2", "b": f"(({one}) - sign(a - b)*(2*({two}) - ({one})))/2"}
            self.left = {"a": "z2", "b": "z1 - z2"}
        else:
            self.left = {"a": "z1", "b": "z2"}
        self.f_y = {"q": plus(self.phi[0], times("v", self.phi[1]), self.d[0])}
        self.twin("", "a > b", ("left_inverse",))

    def make_left_inverse_of_one_cell(self):
        x = self.x[0]
        k, t = self.draw.choice([1, 2]), self.draw.choice(["p", "q", "1"])
        self.build(["same"] * self.n)
        self.phi = [f"{x} + {k}*max(0, {x} - {t})"] + self.phi[1:]
        moves = times(f"{k}*(1 + sign({x} - {t}))/2", self.f_y["q"]) if t == "q" else "0"
        z = [f"({self.phi[0]})", *self.x[1:]]
        again = lambda row: [times(c, s) for c, s in zip(row, z)]
        self.f_y = {y: plus(*again(c), d) for y, c, d in zip(self.y, self.c, self.d)}
        rates = [plus(*again(row), h) for row, h in zip(self.lam, self.h)]
        if t == "q":
            moves = times(f"{k}*(1 + sign({x} - q))/2", self.f_y["q"])
        self.f_x = dict(zip(self.x, rates))
        self.f_x[x] = f"({plus(rates[0], moves)})/(1 + {k}*(1 + sign({x} - {t}))/2)"
        self.given = dict(self.left) | {x: self.draw.choice(["z1", f"(z1 + {k}*{t})/{k + 1}"])}
        self.left[x] = f"z1 - {k}*max(0, z1 - {t})/{k + 1}"
        cells = (f"{x} > {t}", f"{x} < {t}") if self.given[x] == "z1" else (f"{x} < {t}", f"{x} > {t}")
        self.twin(*cells, ("left_inverse",))

    def make_jump(self):
        self.build(["jump"] + ["same"] * (self.n - 1))

    def make_kink(self):
        self.lam, self.h[0] = [["0"] * self.n for _ in self.x], self.draw.choice(["v", "v + abs(q)", "v - p"])
        self.y, self.c, self.d = ["q"], [["1"] + self.c[0][1:]], self.d[:1]
        self.build(["same"] * self.n)
        x, t = self.x[0], self.draw.choice(["p", "q", "1"])
        text, cell, opposite = self.draw.choice([
            (f"max(0, {x} - {t})", f"{x} > {t}", f"{x} < {t}"), (f"min({x}, {t}) - {t}", f"{x} < {t}", f"{x} > {t}"),
            (f"max(0, v - p)*abs({x})", "v > p", "v < p"), (f"(1 - sign(q))*abs({x} - p)", "q < 0", "q > 0"),
            (f"v*(abs({x} - {t}) - {x} + {t})", f"{x} < {t}", f"{x} > {t}"), (f"sat({x}) - {x}", f"{x} > 1", f"-1 < {x} < 1")])
        self.f_y["q"] = plus(self.f_y["q"], text)
        self.twin(cell, opposite, ("regression",))
        self.kink = bool(self.false)

    def make_hidden(self):
        """The output shows one combination in each cell, or the same one in all."""
        self.__dict__.update(n=2, x=["a", "b"], y=["q"], lam=[["0", "0"], ["0", "0"]], h=self.h[:1] + [self.coefficient()], d=self.d[:1])
        e = self.argument()
        one, two = self.draw.choice([("1", "1"), ("1", "-1"), ("2", "p"), ("1", "0"), ("v", "1")])
        k, m = self.draw.choice([(f"max(0, {e})", f"min({e}, 0)"), (f"abs({e})", f"sign({e})"), (f"1 + sign({e})", f"abs({e}) - ({e})")])
        self.c = [self.draw.choice([[f"{k}*{one} + {m}*{one}", f"{k}*{two} + {m}*{two}"], [k, m], [f"{k} + {m}", f"{k} - {m}"]])]
        self.build([self.draw.choice(["same", "same", "bijection", "reciprocal"]) for _ in self.x])
        if self.draw.random() < 0.5:
            self.assume.append(f"{e} {self.draw.choice('<>')} 0")
            self.kind += ", one cell"

    make_hidden_value = make_hidden

    def make_lost_on_a_cell(self):
        """The transform forgets a state where an output has one sign."""
        self.__dict__.update(n=1, x=["a"], y=["q"], lam=[["0"]], h=["v"], c=[["1"]], d=["0"])
        self.build(["same"])
        m, g = self.draw.choice([("max(0, q)", "(1 + sign(q))/2"), ("max(q, 0)^2", "2*max(q, 0)"), ("abs(q) - q", "(sign(q) - 1)")])
        self.phi, self.f_x, self.f_y = [f"a*({m})"], {"a": f"-a*({g})*v/({m} + abs(min(q, 0)))"}, {"q": "v"}
        if m[0] == "a":
            self.f_x = {"a": f"-a*({g})*v/({m} + max(0, q))"}
        self.h, self.rows, self.left = ["0"], [["v - rate_q", "0"]], {"a": f"z1/({m})"}
        self.twin("", "q < 0" if m[0] == "a" else "q > 0", ("left_inverse",))

    def text(self):
        quote = lambda part: ", ".join(f'"{t}"' for t in part)
        section = lambda name, part: [f"{name}:"] + [f'  {k}: "{v}"' for k, v in sorted(part.items())] if part else []
        body = " ".join([*self.f_x.values(), *self.f_y.values(), *self.g_y.values(), *self.phi, *self.assume, *(self.given or {}).values()])
        used = bool(re.search(r"(?<![a-z])p(?![a-z])", body))
        lines = [f"model: m{self.seed}"] + ([f"parameters: {{p: {self.parameters['p'] or 'null'}}}"] if used else [])
        lines += [f"x: [{', '.join(self.x)}]", f"y: [{', '.join(self.y)}]", "u: [v]"]
        lines += [f"assume: [{quote(self.assume)}]"] if self.assume else []
        lines += section("f_x", self.f_x) + section("f_y", self.f_y) + section("g_y", self.g_y)
        lines += [] if self.search else [f"phi: [{quote(self.phi)}]"]
        return "\n".join(lines + section("phi_left", self.given or {}) + [""])

    def start(self, fixed=None, still=False):
        """Random values of everything, as series whose later terms the inputs alone have."""
        ordinary = lambda: Fraction(self.draw.randint(-350, 350) * 2 + 1, 202)
        p = self.parameters["p"]
        names = fixed or {"p": number(ordinary() if p is None else abs(ordinary()) * (1 if float(p) > 0 else -1)),
                          "v": Series([ordinary()] + [Fraction(self.draw.randint(1, 9)) for _ in range(0 if still else ORDER - 1)])}
        names = dict(names)
        return names | {k: number(ordinary()) for k in self.x + self.y if k not in names}

    def trajectory(self, fixed=None, still=False, wanted=lambda cell: True):
        """All signals along a trajectory of the plant, or nothing where it has no value or is beyond the domain."""
        names = self.start(fixed, still)
        rates = self.f_x | self.f_y
        try:
            for k in range(ORDER):
                CELL.clear()
                names |= {y: value(g, names) for y, g in self.g_y.items()}
                if k == 0 and not all(holds(a, names) for a in self.assume):
                    return None
                found = {s: value(f, names) for s, f in rates.items()}
                if k == 0:
                    for f in self.phi:
                        value(f, names)
                    names["cell"] = tuple(CELL)
                    if not wanted(names["cell"]):
                        return None
                for s in found if k + 1 < ORDER else ():
                    names[s] = Series(names[s].terms[: k + 1] + [found[s].terms[k] / (k + 1)])
            names |= {f"rate_{y}": names[y].rate() for y in self.y}
            names |= {f"z{i + 1}": value(f, names) for i, f in enumerate(self.phi)}
            return names
        except NoValue:
            return None


def zero(series, terms=ORDER - 2):
    return not any(series.terms[:terms])


def rows_of(rows, lam, names, n):
    """The coefficients of theta in the equations along a trajectory, with the fundamental matrix: Taylor coefficients."""
    psi = [[number(int(i == j)) for j in range(n)] for i in range(n)]
    matrix = [[value(t, names) for t in row] for row in lam]
    total = lambda terms: sum(terms, number(0))
    for k in range(ORDER - 1):
        found = [[total(matrix[i][l] * psi[l][j] for l in range(n)) for j in range(n)] for i in range(n)]
        psi = [[Series(psi[i][j].terms[: k + 1] + [found[i][j].terms[k] / (k + 1)]) for j in range(n)] for i in range(n)]
    known = [[value(t, names) for t in row[1:]] for row in rows]
    known = [[total(row[l] * psi[l][j] for l in range(n)) for j in range(n)] for row in known]
    return [[entry.terms[k] for entry in row] for k in range(ORDER - 1) for row in known]


class Truth:
    """What is true of a plant, at points in each of its cells."""

    def __init__(self, plant):
        self.plant, cells, self.points = plant, Counter(), []
        for _ in range(80):
            names = len(self.points) < 20 and plant.trajectory(wanted=lambda cell: cells[cell] < 1)
            if names:
                cells[names["cell"]] += 1
                self.points.append(names)
        self.zs = [f"z{i + 1}" for i in range(plant.n)]
        self.wrong = {claim: [p for p in self.points if not self.shown(claim, p)] for claim in CLAIMS[:3]}
        self.claims = {claim: self.claim(claim) for claim in CLAIMS[:3]}
        self.ranks = None
        if self.claims["regression"] and self.claims["cascade"]:
            self.ranks = [rows_of(plant.rows, plant.lam, p, plant.n) for p in self.points]
            full = any(rank(r) == plant.n for r in self.ranks)
            moving = any(e != "0" for row in plant.lam for e in row)
            same = full or [plant.trajectory({"p": self.points[0]["p"], "v": plant.start()["v"]}) for _ in range(30)]
            union = full or rank([row for p in same if p for row in rows_of(plant.rows, plant.lam, p, plant.n)]) == plant.n
            self.claims["identifiability"] = True if full or (union and not moving) else None if moving else False
            if moving and not union and not any(k != "0" for i, row in enumerate(plant.lam) for j, k in enumerate(row) if i != j):
                self.claims["identifiability"] = False
        else:
            self.claims["identifiability"] = None

    def shown(self, claim, names):
        plant = self.plant
        try:
            if claim == "cascade":
                return all(zero(names[z].rate() - self.combined([h, *row], names)) for z, h, row in zip(self.zs, plant.h, plant.lam))
            if claim == "left_inverse":
                return all(zero(value(f, names) - names[x]) for x, f in (plant.given or plant.left).items())
            return all(zero(self.combined(row, names)) for row in plant.rows)
        except NoValue:
            return False

    def combined(self, row, names):
        return sum((value(k, names) * names[z] for k, z in zip(row[1:], self.zs)), value(row[0], names))

    def claim(self, claim):
        wrong = self.wrong[claim]
        if not wrong or not self.points:
            return True if self.points else None
        if claim == "left_inverse":
            return False if self.plant.given or any(self.collides(p) for p in wrong) else None
        false = [p for p in wrong if self.curved(claim, p)]
        self.wrong[claim] = false
        return False if false and (claim == "cascade" or self.plant.kink) else None

    def curved(self, claim, names):
        """With these outputs, inputs and parameters, what is claimed is no affine function of z: by its values."""
        fixed = {k: names[k] for k in ["p", "v", *self.plant.y]}
        fixed |= {y: number(names[y].terms[0]) for y in self.plant.y}
        found = [p for p in (self.plant.trajectory(fixed) for _ in range(3 * self.plant.n + 9)) if p]
        known = [[Fraction(1), *(p[z].terms[0] for z in self.zs)] for p in found]
        rates = self.zs if claim == "cascade" else self.plant.y
        return bool(found) and any(rank([[*k, p[r].terms[1]] for k, p in zip(known, found)]) > rank(known) for r in rates)

    def collides(self, names):
        """Two values of the states with the same transform, one of them here."""
        plant = self.plant
        fixed = {k: number(names[k].terms[0]) for k in ["p", "v", *plant.x, *plant.y]}
        here = [names[z].terms[0] for z in self.zs]
        p = fixed["p"].terms[0]
        for x in plant.x:
            a = names[x].terms[0]
            others = [t + s for w in (p, 0, 1) for t, s in ((w, w - a), (w, -3 * (a - w)), (w, (w - a) / 3))] + [a - Fraction(1, 9), a + Fraction(1, 9)]
            tries = [fixed | {x: number(o)} for o in others if o != a]
            for other in tries + ([fixed | {"a": fixed["b"], "b": fixed["a"]}] if plant.n == 2 else []):
                try:
                    if all(holds(c, other) for c in plant.assume) and [value(f, other).terms[0] for f in plant.phi] == here:
                        return True
                except NoValue:
                    pass
        return False


class Listed:
    """A listed trajectory: `while A and B, only .. is identified`."""

    def __init__(self, entry):
        parts = entry["while"].split(" and ")
        self.comparisons = [part for part in parts if part != "the plant rests" and not part.endswith("constant")]
        self.is_cell = len(self.comparisons) == len(parts) and all(" = " not in part for part in parts)
        self.hidden = entry["hidden"]

    def covers(self, names):
        return self.is_cell and all(holds(part, names) for part in self.comparisons)


def admitted(answer, names):
    try:
        return all(holds(c, names) for c in answer["conditions"])
    except NoValue:
        return False


def of_formulas(plant, answer, names):
    """Formulas of the answer that are wrong along a trajectory."""
    cascade, regression, wrong = answer["cascade"], answer["regression"], []
    names = {k: s for k, s in names.items() if not re.match(r"z\d", k)}
    z = [value(f, names) for f in answer["phi"]["z"]]
    n = len(z)
    lam = cascade["lambda"] or [["0"] * n for _ in z]
    if cascade["verdict"] != "proved":
        return wrong
    total = lambda terms: sum(terms, number(0))
    for i in range(n):
        if not zero(z[i].rate() - value(cascade["h"][i], names) - total(value(lam[i][j], names) * z[j] for j in range(n))):
            wrong.append(f"z{i + 1}' is not as stated")
    if answer["left_inverse"]["verdict"] == "proved":
        with_z = names | {f"z{i + 1}": s for i, s in enumerate(z)}
        wrong += [f"{x} is not {f}" for x, f in answer["left_inverse"]["x"].items() if not zero(value(f, with_z) - names[x])]
    if regression["verdict"] == "proved" and not wrong:
        letter = "xi" if cascade["lambda"] else "chi"
        start = [Fraction(plant.draw.randint(-90, 90), 31) for _ in z]
        theta = [number(s.terms[0] - c) for s, c in zip(z, start)]
        flow = {f"{letter}{i + 1}": number(c) for i, c in enumerate(start)}
        flow |= {f"Psi{i + 1}{j + 1}": number(int(i == j)) for i in range(n) for j in range(n)}
        for k in range(ORDER - 1):
            every = names | flow
            rates = {f"{letter}{i + 1}": value(cascade["h"][i], every) + total(value(lam[i][j], every) * flow[f"{letter}{j + 1}"] for j in range(n)) for i in range(n)}
            rates |= {f"Psi{i + 1}{j + 1}": total(value(lam[i][m], every) * flow[f"Psi{m + 1}{j + 1}"] for m in range(n)) for i in range(n) for j in range(n)}
            flow = {s: Series(flow[s].terms[: k + 1] + [rates[s].terms[k] / (k + 1)]) for s in flow}
        every = names | flow
        eta = [value(e, {f"theta{i + 1}": t for i, t in enumerate(theta)} | names) for e in regression["eta"]]
        side = lambda first, second: [value(a, every) + total(value(b, every) * e for b, e in zip(row, eta)) for a, row in zip(first, second)]
        if regression["primitive_0"]:
            left, right = side(regression["primitive_0"], regression["primitive_1"]), side(regression["phi_0"], regression["phi_1"])
            good = all(zero(a.rate() - b) for a, b in zip(left, right))
        elif regression["kind"] == "static":
            good = all(zero(value(a, every) - total(value(b, every) * e for b, e in zip(row, eta))) for a, row in zip(regression["phi_0"], regression["phi_1"]))
        else:
            good = all(any(zero(s - names[f"rate_{y}"]) for y in plant.y) for s in side(regression["phi_0"], regression["phi_1"]))
        wrong += [] if good else ["the regression does not hold"]
    return wrong


def of_cells(plant, truth, answer, looked):
    """Wrong statements on what is identified in a cell."""
    found, wrong = answer["identifiability"], []
    if found["verdict"] != "proved" or truth.ranks is None or plant.search:
        return wrong
    listed = [Listed(entry) for entry in found["blind"]]
    covered = Counter()
    for names, rows in zip(truth.points, truth.ranks):
        if not admitted(answer, names):
            looked["point beyond the conditions"] += 1
            continue
        here = {k: f"{float(s.terms[0]):.3f}" for k, s in names.items() if k in [*plant.x, *plant.y, "v", "p"]}
        cells = [entry for entry in listed if entry.covers(names)]
        seen = rank(rows)
        looked[f"point, {found['kind']}" + (", in a listed cell" if cells else "")] += 1
        if found["kind"] == "instant" and rank(rows[: len(plant.rows)]) < plant.n:
            wrong.append(f"instant, but of a lower rank at {here}")
        if found["kind"] == "excitation" and seen < plant.n and not cells:
            wrong.append(f"identified, but not at {here}, which no cell covers")
        for entry in cells:
            if not entry.hidden:
                looked["point in a cell that was not decided"] += 1
                continue
            try:
                hidden = [[value(e, names).terms[0] for e in direction] for direction in entry.hidden]
            except (NoValue, NameError):
                looked["direction that was not read"] += 1
                continue
            if seen > plant.n - len(hidden):
                wrong.append(f"called hidden while {entry.comparisons}, but identified at {here}")
            if any(sum(a * b for a, b in zip(row, d)) for row in rows[: len(plant.rows)] for d in hidden):
                wrong.append(f"called hidden while {entry.comparisons}, but seen at {here}")
    if found["kind"] == "excitation" and found["by_itself"] is True:
        for _ in range(12):
            names = plant.trajectory(still=True)
            if names and admitted(answer, names) and not any(entry.covers(names) for entry in listed):
                looked["point, constant inputs"] += 1
                if rank(rows_of(plant.rows, plant.lam, names, plant.n)) < plant.n:
                    here = {k: f"{float(s.terms[0]):.3f}" for k, s in names.items() if k in [*plant.x, *plant.y, "v", "p"]}
                    wrong.append(f"identified with constant inputs, but not at {here}")
    return wrong


def complaints(plant, truth, answer, looked):
    wrong = []
    for claim in CLAIMS:
        said, true = answer[claim]["verdict"], truth.claims[claim]
        if plant.search:
            continue
        looked[f"{claim}: {said}, {'true' if true else 'false' if true is False else 'open'}"] += 1
        if said == "refuted" and true:
            wrong.append(f"UNSOUND: {claim} refuted, but it is true")
        if said == "proved" and true is False:
            # Conditions may leave out the points where it is false.
            inside = [p for p in truth.wrong.get(claim, truth.points) if admitted(answer, p)]
            if claim == "left_inverse" and not plant.given:
                inside = [p for p in inside if truth.collides(p)]
            looked[f"{claim} that is false where a condition fails"] += not inside
            wrong += [f"UNSOUND: {claim} proved, but it is false"] if inside else []
    all_true = all(truth.claims[claim] for claim in CLAIMS)
    if answer["verdict"] == "rejected" and all_true:
        wrong.append("UNSOUND: rejected, but all is true")
    for names in truth.points if answer["phi"] else ():
        if admitted(answer, names):
            try:
                wrong += of_formulas(plant, answer, names)
                looked["point at which formulas hold"] += 1
            except NoValue:
                looked["point at which a formula has no value"] += 1
            except NameError as missing:
                looked[f"formula that was not read: {missing}"] += 1
                break
    return sorted(set(wrong)) + of_cells(plant, truth, answer, looked)


WAYS = ["same", "same", "shift by output", "shift by state", "bijection", "bijection", "bijection at output", "reciprocal", "scaled by output"]
KINDS = [name[5:].replace("_", " ") for name in vars(Plant) if name.startswith("make_")]
KINDS += ["rates", "rates", "values", "values", "state kept on a cell", "divided rates", "divided value", "hidden"]


def reason(answer):
    """Why a plant is not accepted, in the program's first words."""
    for found in answer["diagnostics"]:
        if found["severity"] == "error":
            notes = [note for note in found["notes"] if "obstacle" in note] or [""]
            words = re.sub(r"`[^`]*`|\d+", "..", notes[0].replace("obstacle: ", ""))
            return f"{found['code']}: {' '.join(words.split()[:7])}"
    return "no reason"


def main():
    program, count = sys.argv[1], int(sys.argv[2])
    first = int(sys.argv[3]) if len(sys.argv) > 3 else 1
    verdicts, reasons, looked, bad = defaultdict(Counter), Counter(), Counter(), 0
    for seed in range(first, first + count):
        plant = Plant(seed)
        truth = Truth(plant)
        all_true, some_false = all(truth.claims.values()), any(t is False for t in truth.claims.values())
        if not truth.points:
            looked["plant without a point"] += 1
            continue
        expected = {claim: claim not in plant.false for claim in CLAIMS[:3]}
        if any(truth.claims[c] not in (expected[c], None) for c in CLAIMS[:3]):
            print(f"not as constructed: {plant.kind}: {truth.claims}\n{plant.text()}")
        if plant.search and not all_true:
            plant.search = False
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder, "model.yaml")
            path.write_text(plant.text())
            call = lambda *options: subprocess.run([program, "check", *options, path], capture_output=True, text=True, timeout=120)
            said = call("--format", "json")
            try:
                answer = json.loads(said.stdout)
                wrong = complaints(plant, truth, answer, looked)
                if answer["verdict"] == "accepted" and plant.jumps and not plant.assume and "jumps" not in call().stdout:
                    wrong.append("UNSOUND: z jumps, and the answer does not say so")
            except json.JSONDecodeError:
                answer, wrong = None, [f"no answer: {said.stderr[-300:]}"]
        if wrong:
            bad += 1
            print(f"seed {seed}, {plant.kind}: " + "\n  ".join(wrong[:4]) + f"\n{plant.text()}")
        if answer:
            kind = plant.kind + (", searched" if plant.search else "")
            true = "true" if all_true else "false" if some_false else "open"
            verdicts[f"{true}: {kind}"][answer["verdict"]] += 1
            if answer["verdict"] == "undecided" and all_true:
                reasons[f"{reason(answer)} | {kind}"] += 1
                if "--show" in sys.argv:
                    print(f"undecided, seed {seed}, {kind}: {reason(answer)}\n{plant.text()}")
    for kind, found in sorted(verdicts.items()):
        print(f"{kind}: " + ", ".join(f"{times} {verdict}" for verdict, times in sorted(found.items())))
    print()
    for kind, times in reasons.most_common():
        print(f"{times:6} undecided: {kind}")
    print()
    for kind, times in sorted(looked.items()):
        print(f"{times:6} {kind}")
    print(f"{count} plants, {bad} with a wrong statement")
    sys.exit(bad > 0)


if __name__ == "__main__":
    main()

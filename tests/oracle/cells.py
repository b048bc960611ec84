"""Checks verdicts on random plants with non-smooth functions, whose truth is known by construction.

    python3 tests/oracle/cells.py target/release/pebo-gen 300 [SEED] [--show]

A plant is drawn as `z' = Lambda z + h`, with outputs that show z by their rates, by their values, or divided by z. Then
its states are changed by piecewise linear maps and reciprocals, with thresholds that are parameters or outputs. False
plants break one claim, often in one cell of the signs of all arguments only: a rate that keeps a state, a transform that
folds, jumps or forgets, a left inverse of one cell, a rate with a kink in z, an unknown that no cell shows. Half of them
assume that the cell is not met, and are true. Looked at, by exact power series along trajectories from random rational
points, one in each cell:

- the construction: a claim is true if its formulas hold in every cell, false by points with the same y, u and parameters;
- a claim that is proved is not false where the conditions hold, and one that is refuted is not true;
- the formulas of the answer: h, Lambda, the left inverse and the regression;
- what it says of cells and constant inputs: the rank is full where none is listed, and as low as said where one is.

Exits with 1 on a wrong statement, which it prints with the plant. Prints the verdicts of each kind of plant, and what is
true and undecided by the program's reason; `--show` prints these plants too.
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
FUNCTIONS = {
    "number": number, "max": larger, "min": smaller, "sign": lambda a: number(a.sign()),
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


enclosed = lambda text: f"({text})" if re.search(r"[ *]", text) else text
times = lambda a, b: "0" if "0" in (a, b) else b if a == "1" else a if b == "1" else f"{enclosed(a)}*{enclosed(b)}"
plus = lambda *terms: " + ".join(f"({t})" if t[0] == "-" or " - " in t else t for t in terms if t != "0") or "0"

# Ways to change a state @ into z, with a threshold #: z, dz/d@, dz/dq, dz/d& for the next state &, and @ from z = $, & = %.
KINKS = [("abs(?)", "sign(?)"), ("max(0, ?)", "(1 + sign(?))/2"), ("min(?, 0)", "(1 - sign(?))/2"), ("?*abs(?)", "2*abs(?)"),
         ("sat(?)", "(sign(? + 1) - sign(? - 1))/2"), ("max(0, ?)^2", "2*max(0, ?)")]
BIJECTIONS = [("3*@ + abs(@ - #)", "3 + sign(@ - #)", "-sign(@ - #)", "# + (3*($ - 3*#) - abs($ - 3*#))/8"),
              ("3*@ - 2*abs(@ - #)", "3 - 2*sign(@ - #)", "2*sign(@ - #)", "# + (3*($ - 3*#) + 2*abs($ - 3*#))/5"),
              ("@ + 2*max(0, @ - #)", "2 + sign(@ - #)", "-(1 + sign(@ - #))", "$ - 2*max(0, $ - #)/3"),
              ("@ + max(@, #)", "(3 + sign(@ - #))/2", "(1 - sign(@ - #))/2", "min($/2, $ - #)"),
              ("@ + min(@, 2*#)", "(3 - sign(@ - 2*#))/2", "1 + sign(@ - 2*#)", "max($/2, $ - 2*#)"),
              ("@ + sat(@ - #)", "1 + (sign(@ - # + 1) - sign(@ - # - 1))/2", "-(sign(@ - # + 1) - sign(@ - # - 1))/2", "$ - sat(($ - #)/2)")]
SCALES = [("1 + abs(q)", "sign(q)"), ("1 + max(0, q - p)", "(1 + sign(q - p))/2"), ("2 - sat(q)", "(sign(q - 1) - sign(q + 1))/2")]
WAYS = {
    "same": [("@", "1", "0", "0", "$")],
    "shift by output": [[t.replace("?", e) for t in (f"@ + {f}", "1", g, "0", f"$ - ({f})")] for f, g in KINKS for e in ("q", "(q - p)")],
    "shift by state": [(f"@ + {f}".replace("?", "&"), "1", "0", g.replace("?", "&"), f"$ - ({f})".replace("?", "(%)")) for f, g in KINKS],
    "bijection": [(z, own, "0", "0", left) for z, own, _, left in BIJECTIONS],
    "bijection at output": [[t.replace("#", "q") for t in (z, own, q, "0", left)] for z, own, q, left in BIJECTIONS],
    "reciprocal": [("1/@", "-1/@^2", "0", "0", "1/$")],
    "scaled by output": [(f"@*({m})", m, f"@*{g}", "0", f"$/({m})") for m, g in SCALES],
    "jump": [("@ + sign(q)", "1", "0", "0", "$ - sign(q)"), ("@*(2 + sign(q - p))", "2 + sign(q - p)", "0", "0", "$/(2 + sign(q - p))"),
             ("@ + sign(@ - p)", "1", "0", "0", "$ - sign($ - p)"), ("@ + sign(@ + q)", "1", "0", "0", "$ - sign($ + q)")],
    "abs >": [("abs(@ - #)", "sign(@ - #)", "0", "0", "$ + #")], "abs <": [("abs(@ - #)", "sign(@ - #)", "0", "0", "# - $")],
    "fold >": [("@ + 2*abs(@ - #)", "1 + 2*sign(@ - #)", "0", "0", "($ + 2*#)/3")], "fold <": [("@ + 2*abs(@ - #)", "1 + 2*sign(@ - #)", "0", "0", "2*# - $")],
    "plateau >": [("max(@, #)", "1", "0", "0", "$")], "plateau <": [("min(@, #)", "1", "0", "0", "$")],
}
USUAL = ["same", "same", "shift by output", "shift by state", "bijection", "bijection", "bijection at output", "reciprocal", "scaled by output"]
OF_VALUES = ["same", "same", "bijection", "reciprocal", "shift by state"]
# Terms that are zero but in a cell, and what excludes the cell. They are linear in @ nowhere else.
CELLS = [("max(0, @ - #)", "@ < #"), ("min(@, #) - #", "@ > #"), ("v*(abs(@ - #) - @ + #)", "@ > #"), ("sat(@) - @", "-1 < @ < 1"),
         ("max(0, v - p)*abs(@ - #)", "v < p"), ("(1 - sign(q))*abs(@ - #)", "q > 0"), ("max(0, q - p)*max(@, #)", "q < p")]


class Plant:
    """A random plant with the formulas that show its claims."""

    def __init__(self, seed):
        self.draw = draw = random.Random(seed)
        self.seed, self.kind = seed, draw.choice(KINDS)
        self.assume, self.given, self.false, self.jumps, self.search, self.kink = [], None, (), False, False, False
        self.relation = None
        self.value = draw.choice([None, None, "0.3", "2", "-0.7"])  # Of the parameter p.
        self.threshold = draw.choice(["p", "p", "1", "0.5"])
        self.static = "value" in self.kind
        self.shape(draw.choice([1, 1, 2, 2, 3]), draw.choice([1, 1, 2]))
        if draw.random() < 0.4:
            self.lam[draw.randrange(self.n)][draw.randrange(self.n)] = self.coefficient()
        getattr(self, "make_" + self.kind.replace(" ", "_"))()

    def shape(self, n, m):
        """z' = lam z + h, y' = c z + d."""
        self.n, self.x, self.y = n, list("abc")[:n], ["q", "r"][: 1 if self.static else m]
        some = lambda often, corners=0.5: self.coefficient(corners) if self.draw.random() < often else "0"
        self.lam, self.h = [["0"] * n for _ in self.x], [some(0.8) for _ in self.x]
        self.c, self.d = [[some(0.9, 0.6) for _ in self.x] for _ in self.y], [some(0.5) for _ in self.y]

    def argument(self):
        return self.draw.choice(["v", "v - p", "2*v - 1", "v^2 - p", "v + p", "v/p"] + ["q", "q - p", "q - v", "v*q", "q + p"] * (not self.static))

    def positive(self):
        e = self.argument()
        return self.draw.choice([f"1 + abs({e})", f"2 + sign({e})", f"max(1, {e})", f"1/(1 + abs({e}))", f"2 + sat({e})"])

    def coefficient(self, corners=0.5):
        e, f = self.argument(), self.argument()
        if self.draw.random() > corners:
            return self.draw.choice(["1", "1", "2", "v", "p", e, f"({e})^2", "v^2 + 1"])
        return self.draw.choice([
            f"abs({e})", f"max(0, {e})", f"min({e}, 0)", f"max({e}, {f})", f"min({e}, {f})", f"sat({e})", f"sign({e})", self.positive(),
            f"max(0, abs({e}) - p)", f"abs({e}) - ({e})", f"max(0, {e})^2", f"({e})*sign({f})", f"1 + sign({e})", f"min(max({e}, 0), {f})"])

    def build(self, ways=None, outputs=None):
        """The equations in x from those in z; each way says how a state is changed."""
        ways = ways or [self.draw.choice(OF_VALUES if self.static else USUAL) for _ in self.x]
        if ways[-1] == "shift by state":
            ways[-1] = "bijection"
        maps, left = [None] * self.n, {}
        for i in reversed(range(self.n)):
            following = (self.x + [""])[i + 1]
            each = {"@": self.x[i], "#": self.threshold, "$": f"z{i + 1}", "&": following, "%": left.get(following, "")}
            maps[i] = [re.sub(r"[@#$&%]", lambda m: each[m[0]], t) for t in self.draw.choice(WAYS[ways[i]])]
            left[self.x[i]] = maps[i][4]
        self.phi, self.left, self.rate = [m[0] for m in maps], left, {}
        linear = lambda row: [times(k, t) for k, t in zip(row, self.phi)]
        outputs = outputs(self.phi) if outputs else [plus(*linear(c), d) for c, d in zip(self.c, self.d)]
        self.f_y, self.g_y = ({}, dict(zip(self.y, outputs))) if self.static else (dict(zip(self.y, outputs)), {})
        self.f_x = {}
        for i in reversed(range(self.n)):
            _, own, q, other, _ = maps[i]
            less = [times(q, self.f_y["q"]) if q != "0" else "0", times(other, self.f_x[self.x[i + 1]]) if other != "0" else "0"]
            rate = " - ".join([plus(*linear(self.lam[i]), self.h[i])] + [enclosed(t) for t in less if t != "0"])
            power = f"{self.x[i]}^2"
            self.f_x[self.x[i]] = times(f"-{power}", rate) if own == f"-1/{power}" else "0" if rate == "0" else rate if own == "1" else f"({rate})/({own})"
        rates = [y if self.static else f"rate_{y}" for y in self.y]
        self.rows = [[f"{d} - {r}", *c] for r, c, d in zip(rates, self.c, self.d)]
        self.kind += "".join(f", {w.split(' <')[0].split(' >')[0]}" for w in sorted(set(ways)) if w != "same")

    def twin(self, opposite, false):
        """Half of the plants assume the opposite of the cell in which a claim is false."""
        if self.draw.random() < 0.5:
            self.assume.append(opposite)
            self.kind += ", excluded"
        else:
            self.false = (false,)

    def make_rates(self):
        self.build()
        self.search = self.draw.random() < 0.15

    make_values = make_rates

    def make_given_left_inverse(self):
        self.build()
        self.given = dict(self.left)

    def make_value_through_a_bijection(self):
        self.build(["same"] * self.n, lambda z: [f"({e}) + 2*max(0, {e})" for e in [plus(*map(times, self.c[0], z), self.d[0])]])
        self.rows = [[f"{self.d[0]} - (q - 2*max(0, q)/3)", *self.c[0]]]

    def make_output_through_a_bijection(self):
        m = self.draw.choice(["3 + sign(q)", "2 - sign(q - p)", "1 + (1 + sign(q - p))/2"])
        self.c, self.d = [[times(m, k) for k in row] for row in self.c], [times(m, k) for k in self.d]
        self.build()

    def make_divided_rate(self):
        """z1 y = g - k z2, with the rate or the value of an output; z1 is often a reciprocal."""
        lam, h = self.lam, self.h
        self.shape(min(self.n, 2), 1)
        self.lam, self.h = [row[: self.n] for row in lam[: self.n]], h[: self.n]
        k, g = self.coefficient(), self.coefficient()
        top = lambda z: g if self.n == 1 else f"{g} - {enclosed(times(k, z[1]))}"
        ways = [self.draw.choice(["same", "reciprocal"]), self.draw.choice(["same", "same", "bijection"] + ["shift by output"] * (not self.static))]
        self.build(ways[: self.n], lambda z: [times("a", top(z)) if z[0] == "1/a" else f"({top(z)})/a"])
        self.rows = [[f"-({g})", "q" if self.static else "rate_q", k][: self.n + 1]]
        self.search = self.draw.random() < 0.1

    make_divided_value = make_divided_rate

    def make_state_kept_on_a_cell(self):
        self.build([self.draw.choice(("same", "shift by output")) for _ in self.x])
        x, t = self.x[0], self.draw.choice(["p", "q", "v", "1"])
        text, opposite = (s.replace("@", x).replace("#", t) for s in self.draw.choice(CELLS))
        self.f_x[x] = plus(self.f_x[x], text)
        self.twin(opposite, "cascade")

    def make_kink(self):
        self.shape(self.n, 1)
        self.h[0], self.c[0][0] = self.draw.choice(["v", "v + abs(q)", "v - p"]), "1"
        self.build(["same"] * self.n)
        text, opposite = (s.replace("@", "a").replace("#", self.draw.choice(["p", "q", "1"])) for s in self.draw.choice(CELLS))
        self.f_y["q"] = plus(self.f_y["q"], text)
        self.twin(opposite, "regression")
        self.kink = bool(self.false)

    def make_folded(self):
        way, side = self.draw.choice(["abs", "fold", "plateau"]), self.draw.choice("<>")
        if way == "plateau":
            self.h[0], self.lam[0] = "0", ["0"] * self.n
        self.build([f"{way} {side}"] + ["same"] * (self.n - 1))
        self.twin(f"a {side} {self.threshold}", "left_inverse")

    make_folded_value = make_folded

    def make_ordered(self):
        """A sum and a difference, or the larger and the smaller of two states: an assumption says which is which."""
        self.shape(2, 1)
        self.build(["same", "same"])
        one, two = self.h
        self.phi, self.left, mean, half = self.draw.choice([
            (["max(a, b)", "min(a, b)"], {"a": "z1", "b": "z2"}, f"({one} + {two})/2", f"({one} - ({two}))/2"),
            (["a + b", "abs(a - b)"], {"a": "(z1 + z2)/2", "b": "(z1 - z2)/2"}, f"({one})/2", f"({two})/2")])
        self.f_x = {"a": f"{mean} + sign(a - b)*({half})", "b": f"{mean} - sign(a - b)*({half})"}
        self.f_y = {"q": plus(*map(times, self.c[0], self.phi), self.d[0])}
        self.twin("a > b", "left_inverse")

    def make_left_inverse_of_one_cell(self):
        self.build([self.draw.choice(["bijection", "bijection at output"])] + ["same"] * (self.n - 1))
        t = "q" if "output" in self.kind else self.threshold
        side, wall = self.draw.choice([(1, ">"), (-1, "<")]), f"2*{t}" if "min" in self.phi[0] else t
        far = f"{wall} {'+' if side[0] > 0 else '-'} 5"
        # In the outer cell z = k a + m: by two values there, which do not depend on signs.
        slope = {"3*a + ": {1: 4, -1: 2}, "3*a - ": {1: 1, -1: 5}, "a + 2*": {1: 3, -1: 1}, "a + ma": {1: 2, -1: 1}, "a + mi": {1: 1, -1: 2},
                 "a + sa": {1: 1, -1: 1}}[self.phi[0][:6]][side[0]]
        at = re.sub(r"\ba\b", f"({far})", self.phi[0])
        self.given = dict(self.left) | {"a": f"{far} + (z1 - ({at}))/{slope}"}
        self.twin(f"a {side[1]} {wall} {'+' if side[0] > 0 else '-'} 1", "left_inverse")

    def make_jump(self):
        self.build(["jump"] + ["same"] * (self.n - 1))
        self.jumps = True

    def make_hidden(self):
        """The output shows one combination in each cell, or the same one in all."""
        self.shape(2, 1)
        e = self.argument()
        one, two = self.draw.choice([("1", "1"), ("1", "-1"), ("2", "p"), ("1", "0"), ("v", "1")])
        k, m = self.draw.choice([(f"max(0, {e})", f"min({e}, 0)"), (f"abs({e})", f"sign({e})"), (f"1 + sign({e})", f"abs({e}) - ({e})")])
        both = f"{k} + {m}"
        self.c = [self.draw.choice([[times(both, one), times(both, two)], [k, m], [both, f"{k} - ({m})"]])]
        self.build([self.draw.choice(["same", "same", "bijection", "reciprocal"]) for _ in self.x])
        if self.draw.random() < 0.5:
            self.assume.append(f"{e} {self.draw.choice('<>')} 0")
            self.kind += ", one cell"

    make_hidden_value = make_hidden

    def make_relation(self):
        """An output that is known by an identity: a = m(q) b, with m one-to-one."""
        self.shape(2, 1)
        self.build(["same", "same"])
        m, slope = self.draw.choice([("2*q + abs(q)", "2 + sign(q)"), ("q + max(0, q - p)", "(3 + sign(q - p))/2"), ("q + sat(q)", "1 + (sign(q + 1) - sign(q - 1))/2")])
        self.f_y = {"q": f"({self.h[0]} - {enclosed(times(m, self.h[1]))})/(b*({slope}))"}
        self.relation = f"({m})*b"
        self.rows = [["0", "1", f"-({m})"]]

    def make_lost_on_a_cell(self):
        """The transform forgets a state where an output has one sign: z = a m(q), with z' = 0."""
        self.shape(1, 1)
        self.c, self.d, self.h = [["0"]], ["v"], ["0"]
        self.build(["same"])
        m, slope, side = self.draw.choice([("max(0, q)", "1", ">"), ("max(q, 0)^2", "2*q", ">"), ("(abs(q) - q)", "-2", "<")])
        self.phi, self.f_x, self.left = [f"a*{m}"], {"a": f"-a*{slope}*v/({m} + abs(q) {'-' if side == '>' else '+'} q)"}, {"a": f"z1/{m}"}
        self.twin(f"q {side} 0", "left_inverse")

    def text(self):
        quote = lambda part: ", ".join(f'"{t}"' for t in part)
        section = lambda name, part: [f"{name}:"] + [f'  {k}: "{v}"' for k, v in sorted(part.items())] if part else []
        body = " ".join([*self.f_x.values(), *self.f_y.values(), *self.g_y.values(), *self.phi, *self.assume, *(self.given or {}).values()])
        lines = [f"model: m{self.seed}"] + ([f"parameters: {{p: {self.value or 'null'}}}"] if re.search(r"\bp\b", body) else [])
        lines += [f"x: [{', '.join(self.x)}]", f"y: [{', '.join(self.y)}]", "u: [v]"]
        lines += [f"assume: [{quote(self.assume)}]"] if self.assume else []
        lines += section("f_x", self.f_x) + section("f_y", self.f_y) + section("g_y", self.g_y)
        lines += [f'identities: ["a - {self.relation}"]'] if self.relation else []
        lines += [] if self.search else [f"phi: [{quote(self.phi)}]"]
        return "\n".join(lines + section("phi_left", self.given or {}) + [""])

    def start(self, still=False):
        """Random values of everything that has none, of which the inputs move if they are not constant."""
        ordinary = lambda: Fraction(self.draw.randint(-350, 350) * 2 + 1, 202)
        p = ordinary() if self.value is None else abs(ordinary()) * (1 if float(self.value) > 0 else -1)
        moves = [Fraction(self.draw.randint(1, 9)) for _ in range(0 if still else ORDER - 1)]
        return {"p": number(p), "v": Series([ordinary(), *moves])} | {k: number(ordinary()) for k in self.x + self.y}

    def trajectory(self, fixed=(), still=False, wanted=lambda cell: True):
        """All signals along a trajectory, or nothing where there is no value or beyond the domain."""
        names = self.start(still) | dict(fixed)
        names |= {"a": value(self.relation, names)} if self.relation else {}
        states = {s: names[s].terms[0] for s in [*self.f_x, *self.f_y]}
        valued = lambda names: {y: value(g, names) for y, g in self.g_y.items()}
        try:
            CELL.clear()
            names |= valued(names)
            for f in [*self.f_x.values(), *self.f_y.values(), *self.phi]:
                value(f, names)
            names["cell"] = tuple(CELL)
            if not wanted(names["cell"]) or not all(holds(a, names) for a in self.assume):
                return None
            def rates(names):
                with_values = names | valued(names)
                return {s: value(f, with_values) for s, f in (self.f_x | self.f_y).items()}
            names = flow(names, states, rates)
            names |= valued(names)
            names |= {f"rate_{y}": names[y].rate() for y in self.y}
            return names | {f"z{i + 1}": value(f, names) for i, f in enumerate(self.phi)}
        except NoValue:
            return None


KINDS = [name[5:].replace("_", " ") for name in vars(Plant) if name.startswith("make_")]
KINDS += ["rates", "rates", "values", "state kept on a cell", "divided rate", "divided value", "hidden", "hidden value"]


def coefficients(rows, lam, names, n):
    """The coefficients of theta in the equations, with the fundamental matrix: a row for each equation and derivative."""
    matrix = [[value(t, names) for t in row] for row in lam]
    unit = {(i, j): int(i == j) for i in range(n) for j in range(n)}
    psi = flow({}, unit, lambda psi: {(i, j): total(matrix[i][l] * psi[l, j] for l in range(n)) for i, j in unit})
    known = [[value(t, names) for t in row[1:]] for row in rows]
    known = [[total(row[l] * psi[l, j] for l in range(n)) for j in range(n)] for row in known]
    return [[entry.terms[k] for entry in row] for k in range(ORDER - 1) for row in known]


class Truth:
    """What is true of a plant, by a point in each of its cells."""

    def __init__(self, plant):
        self.plant, cells, self.points = plant, set(), []
        for _ in range(80):
            names = len(self.points) < 20 and plant.trajectory(wanted=lambda cell: cell not in cells)
            if names:
                cells.add(names["cell"])
                self.points.append(names)
        self.zs = [f"z{i + 1}" for i in range(plant.n)]
        self.wrong = {claim: [p for p in self.points if not self.shown(claim, p)] for claim in CLAIMS[:3]}
        self.claims = {claim: self.claim(claim) for claim in CLAIMS[:3]}
        known = self.points and self.claims["regression"] and self.claims["cascade"]
        self.ranks = [coefficients(plant.rows, plant.lam, p, plant.n) for p in self.points] if known else None
        self.claims["identifiability"] = self.identified() if known else None

    def identified(self):
        """In one cell, or in cells with the same parameters; in none, if the same direction is hidden in all."""
        plant = self.plant
        if any(rank(rows) == plant.n for rows in self.ranks):
            return True
        # Rows of several cells add up if Psi is the identity, or at least diagonal.
        if any(k != "0" for i, row in enumerate(plant.lam) for j, k in enumerate(row) if i != j):
            return None
        full = False
        for first in self.points[:4]:
            near = [first] + [plant.trajectory({"p": first["p"]}) for _ in range(20)]
            full |= rank([row for p in near if p for row in coefficients(plant.rows, plant.lam, p, plant.n)]) == plant.n
        return False if not full else True if all(k == "0" for row in plant.lam for k in row) else None

    def shown(self, claim, names):
        """Whether the formulas of the construction hold along a trajectory."""
        plant = self.plant
        affine = lambda row: total(value(k, names) * names[z] for k, z in zip(row[1:], self.zs)) + value(row[0], names)
        try:
            if claim == "cascade":
                return all(zero(names[z].rate() - affine([h, *row])) for z, h, row in zip(self.zs, plant.h, plant.lam))
            if claim == "left_inverse":
                return all(zero(value(f, names) - names[x]) for x, f in (plant.given or plant.left).items())
            return all(zero(affine(row)) for row in plant.rows)
        except NoValue:
            return False

    def claim(self, claim):
        wrong = self.wrong[claim]
        if not wrong:
            return True if self.points else None
        show = (lambda p: self.plant.given or self.collides(p)) if claim == "left_inverse" else lambda p: self.curved(claim, p)
        self.wrong[claim] = [p for p in wrong if show(p)]
        return False if self.wrong[claim] and (claim != "regression" or self.plant.kink) else None

    def curved(self, claim, names):
        """With these outputs, inputs and parameters, what is claimed is no affine function of z, by its values."""
        fixed = {k: number(names[k].terms[0]) for k in ["p", "v", *self.plant.y]}
        far = lambda: {x: number(Fraction(self.plant.draw.randint(-1999, 1999), 202)) for x in self.plant.x}
        found = [p for p in (self.plant.trajectory(fixed | far()) for _ in range(4 * self.plant.n + 12)) if p]
        known = [[Fraction(1), *(p[z].terms[0] for z in self.zs)] for p in found]
        rates = self.zs if claim == "cascade" else self.plant.y
        return bool(found) and any(rank([[*k, p[r].terms[1]] for k, p in zip(known, found)]) > rank(known) for r in rates)

    def collides(self, names):
        """Other values of the states in the domain have the same transform as those here."""
        plant = self.plant
        fixed = {k: number(names[k].terms[0]) for k in ["p", "v", *plant.x, *plant.y]}
        others = [fixed | {"a": fixed["b"], "b": fixed["a"]}] if plant.n == 2 else []
        for x in plant.x:
            a = names[x].terms[0]
            walls = [value(t, fixed).terms[0] for t in {"1", plant.threshold}]
            places = [w + k * (w - a) for w in walls for k in (1, 3, Fraction(1, 3))] + [a + Fraction(1, 9), a - Fraction(1, 9)]
            others += [fixed | {x: number(place)} for place in places if place != a]
        same = lambda other: all(zero(value(f, other) - number(names[z].terms[0])) for f, z in zip(plant.phi, self.zs))
        return any(all(holds(c, other) for c in plant.assume) and same(other) for other in others)


class Answer:
    """What the program says of a plant, beside the truth."""

    def __init__(self, plant, truth, said, text):
        self.plant, self.truth, self.said, self.text = plant, truth, said, text
        self.looked, self.wrong = Counter(), []

    def look(self):
        for claim in [] if self.plant.search else CLAIMS:
            self.of_claim(claim, self.said[claim]["verdict"], self.truth.claims[claim])
        if self.said["verdict"] == "rejected" and all(self.truth.claims.values()):
            self.wrong.append("UNSOUND: rejected, but all is true")
        if self.said["verdict"] == "accepted" and self.plant.jumps and "jumps" not in self.text:
            self.wrong.append("z jumps, and the answer does not say so")
        for names in filter(self.admits, self.truth.points if self.said["phi"] else ()):
            try:
                self.of_formulas({k: s for k, s in names.items() if not re.match(r"z\d", k)})
                self.looked["point at which formulas were looked at"] += 1
            except NoValue:
                self.looked["point at which a formula has no value"] += 1
            except NameError as missing:
                self.looked[f"formula that was not read: {missing}"] += 1
        if self.said["identifiability"]["verdict"] == "proved" and self.truth.ranks and not self.plant.search:
            self.of_cells(self.said["identifiability"])
        return list(dict.fromkeys(self.wrong))

    def admits(self, names):
        try:
            return all(holds(c, names) for c in self.said["conditions"])
        except NoValue:
            return False

    def of_claim(self, claim, said, true):
        word = {True: "true", False: "false", None: "open"}[true]
        self.looked[f"{claim}: {said}, {word}"] += 1
        if said == "refuted" and true:
            self.wrong.append(f"UNSOUND: {claim} refuted, but it is true")
        if said == "proved" and true is False:
            # Conditions may leave out the points where it is false.
            inside = any(self.admits(p) for p in self.truth.wrong.get(claim, self.truth.points))
            self.looked[f"{claim} that is false where a condition fails"] += not inside
            self.wrong += [f"UNSOUND: {claim} proved, but it is false"] if inside else []

    def of_formulas(self, names):
        """The formulas of the answer along a trajectory, from a random start of the dynamic extension."""
        cascade, regression = self.said["cascade"], self.said["regression"]
        if cascade["verdict"] != "proved":
            return
        z = [value(f, names) for f in self.said["phi"]["z"]]
        n, letter = len(z), "xi" if cascade["lambda"] else "chi"
        lam, h = cascade["lambda"] or [["0"] * n for _ in z], cascade["h"]
        along = lambda i, of, names: total(value(lam[i][j], names) * of(j) for j in range(n))
        if not all(zero(z[i].rate() - value(h[i], names) - along(i, z.__getitem__, names)) for i in range(n)):
            self.wrong.append("UNSOUND: z' is not as stated")
        if self.said["left_inverse"]["verdict"] == "proved":
            with_z = names | {f"z{i + 1}": s for i, s in enumerate(z)}
            if not all(zero(value(f, with_z) - names[x]) for x, f in self.said["left_inverse"]["x"].items()):
                self.wrong.append("UNSOUND: the left inverse is not as stated")
        if regression["verdict"] != "proved":
            return
        start = {f"{letter}{i + 1}": Fraction(self.plant.draw.randint(-90, 90), 31) for i in range(n)}
        names |= {f"theta{i + 1}": number(s.terms[0] - c) for i, (s, c) in enumerate(zip(z, start.values()))}
        start |= {f"Psi{i + 1}{j + 1}": int(i == j) for i in range(n) for j in range(n)}
        def rates(names):
            found = {f"{letter}{i + 1}": value(h[i], names) + along(i, lambda j: names[f"{letter}{j + 1}"], names) for i in range(n)}
            return found | {f"Psi{i + 1}{k + 1}": along(i, lambda j: names[f"Psi{j + 1}{k + 1}"], names) for i in range(n) for k in range(n)}
        names = flow(names, start, rates)
        eta = [value(e, names) for e in regression["eta"]]
        known = lambda rows: [total(value(k, names) * e for k, e in zip(row, eta)) for row in rows]
        side = lambda first, rows: [value(k, names) + s for k, s in zip(first, known(rows))]
        first, rows = regression["phi_0"], regression["phi_1"]
        if regression["primitive_0"]:
            good = all(zero(a.rate() - b) for a, b in zip(side(regression["primitive_0"], regression["primitive_1"]), side(first, rows)))
        elif regression["kind"] == "static":
            good = all(zero(value(a, names) - b) for a, b in zip(first, known(rows)))
        else:
            good = all(any(zero(s - names[f"rate_{y}"]) for y in self.plant.y) for s in side(first, rows))
        self.wrong += [] if good else ["UNSOUND: the regression does not hold"]

    def of_cells(self, found):
        plant, n = self.plant, self.plant.n
        listed = [(entry["while"].split(" and "), entry["hidden"]) for entry in found["blind"]]
        # A cell holds on a set with inner points; an equation, a constant and rest do not.
        is_cell = lambda parts: all(re.search(r" [<>] ", part) for part in parts)
        covers = lambda parts, names: all(holds(p, names) for p in parts if not re.search("rests|constant$", p))
        excepted = lambda names: any(holds(condition, names) for condition in found["singular_where"])
        for names in filter(self.admits, self.truth.points):
            rows = coefficients(plant.rows, plant.lam, names, n)
            here = {k: f"{float(names[k].terms[0]):.3f}" for k in [*plant.x, *plant.y, "v", "p"]}
            cells = [(parts, hidden) for parts, hidden in listed if is_cell(parts) and covers(parts, names)]
            self.looked[f"point, {found['kind']}" + (", in a listed cell" if cells else "")] += 1
            if found["kind"] == "instant" and rank(rows[: len(plant.rows)]) < n:
                self.looked["cell that an equation lists, as it holds in all of it"] += excepted(names)
                self.wrong += [] if excepted(names) else [f"UNSOUND: instant, but of a lower rank at {here}"]
            if found["kind"] == "excitation" and rank(rows) < n and not cells:
                self.wrong.append(f"UNSOUND: identified, but not at {here}, which no cell covers")
            for parts, hidden in cells if self.said["regression"]["eta"] == [f"theta{i + 1}" for i in range(n)] else ():
                try:
                    directions = [[value(e, names).terms[0] for e in direction] for direction in hidden]
                except (NoValue, NameError):
                    self.looked["direction that was not read"] += 1
                    continue
                if not directions:
                    self.looked["point in a cell that was not decided"] += 1
                elif rank(rows) > n - len(directions):
                    self.wrong.append(f"UNSOUND: called hidden while {parts}, but identified at {here}")
                if any(sum(a * b for a, b in zip(row, d)) for row in rows[: len(plant.rows)] for d in directions):
                    self.wrong.append(f"UNSOUND: called hidden while {parts}, but seen at {here}")
        special = [number(k) for k in ("0", "1", "-1", "1/2")] + [None] * 8
        for fixed in special if found["kind"] == "instant" or found["by_itself"] is True else ():
            names = plant.trajectory({"v": fixed} if fixed else (), still=True)
            if not names or not self.admits(names):
                continue
            rows = coefficients(plant.rows, plant.lam, names, n)
            here = {k: f"{float(names[k].terms[0]):.3f}" for k in [*plant.x, *plant.y, "v", "p"]}
            if found["kind"] == "instant":
                self.looked["point with a special input, instant"] += found["everywhere_else"] and bool(fixed)
                if found["everywhere_else"] and rank(rows[: len(plant.rows)]) < n and not excepted(names):
                    self.wrong.append(f"UNSOUND: instant everywhere else, but of a lower rank at {here}")
            elif not fixed or found["blind_complete"]:
                self.looked["point with a constant input" + (", a special one" if fixed else "")] += 1
                if rank(rows) < n and not any(covers(parts, names) for parts, _ in listed if fixed or is_cell(parts)):
                    self.wrong.append(f"UNSOUND: identified with constant inputs, but not at {here}")


def reason(said):
    """Why a plant is not accepted, in the program's first words."""
    for found in said["diagnostics"]:
        if found["severity"] == "error":
            notes = [note for note in found["notes"] if "obstacle" in note] or [found["message"]]
            words = re.sub(r"`[^`]*`|\d+", "..", notes[0].replace("obstacle: ", ""))
            return f"{found['code']}: {' '.join(words.split()[:8])}"
    return "no reason"


def main():
    arguments = [a for a in sys.argv[1:] if a != "--show"]
    program, count, first = arguments[0], int(arguments[1]), int((arguments + ["1"])[2])
    verdicts, reasons, looked, bad = defaultdict(Counter), Counter(), Counter(), 0
    for seed in range(first, first + count):
        plant = Plant(seed)
        truth = Truth(plant)
        if not truth.points:
            looked["plant without a point of its domain"] += 1
            continue
        plant.search &= all(truth.claims.values())
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder, "model.yaml")
            path.write_text(plant.text())
            call = lambda *options: subprocess.run([program, "check", *options, path], capture_output=True, text=True, timeout=120)
            said = call("--format", "json")
            text = call().stdout if plant.jumps else ""
        try:
            answer = Answer(plant, truth, json.loads(said.stdout), text)
            wrong = answer.look()
        except json.JSONDecodeError:
            print(f"no answer, seed {seed}: {said.stderr[-300:]}\n{plant.text()}")
            bad += 1
            continue
        looked += answer.looked
        expected = [c for c in CLAIMS[:3] if truth.claims[c] is (c in plant.false)]
        wrong += [f"the script: {expected} not as constructed"] if expected else []
        if wrong:
            bad += 1
            print(f"seed {seed}, {plant.kind}: " + "\n  ".join(wrong[:4]) + f"\n{plant.text()}")
        true = "true" if all(truth.claims.values()) else "false" if False in truth.claims.values() else "open"
        kind, verdict = plant.kind + (", searched" if plant.search else ""), answer.said["verdict"]
        verdicts[f"{true}: {kind}"][verdict] += 1
        verdicts[f"all that is {true}"][verdict] += 1
        if verdict == "undecided" and true == "true":
            reasons[f"{reason(answer.said)} | {kind}"] += 1
        if verdict == "undecided" and "--show" in sys.argv:
            print(f"undecided, seed {seed}, {true}: {kind}: {reason(answer.said)}\n{plant.text()}")
    for kind, found in sorted(verdicts.items()):
        print(f"{kind}: " + ", ".join(f"{times} {verdict}" for verdict, times in sorted(found.items())))
    print(*[f"{times:6} undecided: {kind}" for kind, times in reasons.most_common()], sep="\n")
    print(*[f"{times:6} {kind}" for kind, times in sorted(looked.items()) if times], sep="\n")
    print(f"{count} plants, {bad} with a wrong statement")
    sys.exit(bad > 0)


if __name__ == "__main__":
    main()

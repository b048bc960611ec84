"""Random plants with non-smooth functions, with the formulas that show their claims. See `cells.py`."""

import random
import re
from fractions import Fraction

from series import CELL, ORDER, NoValue, Series, flow, holds, number, value

enclosed = lambda text: f"({text})" if re.search(r"[ *]", text) else text
times = lambda a, b: "0" if "0" in (a, b) else b if a == "1" else a if b == "1" else f"{enclosed(a)}*{enclosed(b)}"
plus = lambda *terms: " + ".join(f"({t})" if t[0] == "-" or " - " in t else t for t in terms if t != "0") or "0"

# Ways to change a state @ into z, with a threshold #: z, dz/d@, dz/dq, dz/d& for the next state &, @ from z = $, & = %.
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
    "shift by output": [[t.replace("?", e) for t in (f"@ + {f}", "1", g, "0", f"$ - ({f})")]
                        for f, g in KINKS for e in ("q", "(q - p)")],
    "shift by state": [(f"@ + {f}".replace("?", "&"), "1", "0", g.replace("?", "&"), f"$ - ({f})".replace("?", "(%)"))
                       for f, g in KINKS],
    "bijection": [(z, own, "0", "0", left) for z, own, _, left in BIJECTIONS],
    "bijection at output": [[t.replace("#", "q") for t in (z, own, q, "0", left)] for z, own, q, left in BIJECTIONS],
    "reciprocal": [("1/@", "-1/@^2", "0", "0", "1/$")],
    "scaled by output": [(f"@*({m})", m, f"@*{g}", "0", f"$/({m})") for m, g in SCALES],
    "jump": [("@ + sign(q)", "1", "0", "0", "$ - sign(q)"), ("@*(2 + sign(q - p))", "2 + sign(q - p)", "0", "0", "$/(2 + sign(q - p))"),
             ("@ + sign(@ - p)", "1", "0", "0", "$ - sign($ - p)"), ("@ + sign(@ + q)", "1", "0", "0", "$ - sign($ + q)")],
    "abs >": [("abs(@ - #)", "sign(@ - #)", "0", "0", "$ + #")], "abs <": [("abs(@ - #)", "sign(@ - #)", "0", "0", "# - $")],
    "fold >": [("@ + 2*abs(@ - #)", "1 + 2*sign(@ - #)", "0", "0", "($ + 2*#)/3")],
    "fold <": [("@ + 2*abs(@ - #)", "1 + 2*sign(@ - #)", "0", "0", "2*# - $")],
    "plateau >": [("max(@, #)", "1", "0", "0", "$")], "plateau <": [("min(@, #)", "1", "0", "0", "$")],
}
USUAL = ["same", "same", "bijection", "bijection", "bijection at output", "reciprocal",
         "shift by output", "shift by state", "scaled by output"]
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
        of_outputs = [] if self.static else ["q", "q - p", "q - v", "v*q", "q + p"]
        return self.draw.choice(["v", "v - p", "2*v - 1", "v^2 - p", "v + p", "v/p", *of_outputs])

    def positive(self):
        e = self.argument()
        return self.draw.choice([f"1 + abs({e})", f"2 + sign({e})", f"max(1, {e})", f"1/(1 + abs({e}))", f"2 + sat({e})"])

    def coefficient(self, corners=0.5):
        e, f = self.argument(), self.argument()
        if self.draw.random() > corners:
            return self.draw.choice(["1", "1", "2", "v", "p", e, f"({e})^2", "v^2 + 1"])
        return self.draw.choice([
            f"abs({e})", f"max(0, {e})", f"min({e}, 0)", f"max({e}, {f})", f"min({e}, {f})", f"sat({e})", f"sign({e})",
            f"max(0, abs({e}) - p)", f"abs({e}) - ({e})", f"max(0, {e})^2", f"({e})*sign({f})", f"1 + sign({e})",
            f"min(max({e}, 0), {f})", self.positive()])

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
            less = [times(q, self.f_y["q"])] if q != "0" else []
            less += [times(other, self.f_x[self.x[i + 1]])] if other != "0" else []
            rate = " - ".join([plus(*linear(self.lam[i]), self.h[i])] + [enclosed(t) for t in less if t != "0"])
            power = f"{self.x[i]}^2"
            whole = times(f"-{power}", rate) if own == f"-1/{power}" else rate
            self.f_x[self.x[i]] = whole if whole == "0" or own in ("1", f"-1/{power}") else f"({rate})/({own})"
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
        bent = lambda e: [f"({e}) + 2*max(0, {e})"]
        self.build(["same"] * self.n, lambda z: bent(plus(*map(times, self.c[0], z), self.d[0])))
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
        second = ["same", "same", "bijection", "same" if self.static else "shift by output"]
        ways = [self.draw.choice(["same", "reciprocal"]), self.draw.choice(second)]
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
        t = self.draw.choice(["p", "q", "1"])
        text, opposite = (s.replace("@", "a").replace("#", t) for s in self.draw.choice(CELLS))
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
        slopes = {"3*a + ": {1: 4, -1: 2}, "3*a - ": {1: 1, -1: 5}, "a + 2*": {1: 3, -1: 1},
                  "a + ma": {1: 2, -1: 1}, "a + mi": {1: 1, -1: 2}, "a + sa": {1: 1, -1: 1}}
        slope = slopes[self.phi[0][:6]][side[0]]
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
        k, m = self.draw.choice([(f"max(0, {e})", f"min({e}, 0)"), (f"abs({e})", f"sign({e})"),
                                 (f"1 + sign({e})", f"abs({e}) - ({e})")])
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
        m, slope = self.draw.choice([("2*q + abs(q)", "2 + sign(q)"), ("q + max(0, q - p)", "(3 + sign(q - p))/2"),
                                     ("q + sat(q)", "1 + (sign(q + 1) - sign(q - 1))/2")])
        self.f_y = {"q": f"({self.h[0]} - {enclosed(times(m, self.h[1]))})/(b*({slope}))"}
        self.relation = f"({m})*b"
        self.rows = [["0", "1", f"-({m})"]]

    def make_lost_on_a_cell(self):
        """The transform forgets a state where an output has one sign: z = a m(q), with z' = 0."""
        self.shape(1, 1)
        self.c, self.d, self.h = [["0"]], ["v"], ["0"]
        self.build(["same"])
        m, slope, side = self.draw.choice([("max(0, q)", "1", ">"), ("max(q, 0)^2", "2*q", ">"),
                                           ("(abs(q) - q)", "-2", "<")])
        self.phi, self.left = [f"a*{m}"], {"a": f"z1/{m}"}
        self.f_x = {"a": f"-a*{slope}*v/({m} + abs(q) {'-' if side == '>' else '+'} q)"}
        self.twin(f"q {side} 0", "left_inverse")

    def text(self):
        quote = lambda part: ", ".join(f'"{t}"' for t in part)
        section = lambda name, part: [f"{name}:"] + [f'  {k}: "{v}"' for k, v in sorted(part.items())] if part else []
        body = [*self.f_x.values(), *self.f_y.values(), *self.g_y.values(), *(self.given or {}).values()]
        uses_p = re.search(r"\bp\b", " ".join([*body, *self.phi, *self.assume, self.relation or ""]))
        lines = [f"model: m{self.seed}"] + ([f"parameters: {{p: {self.value or 'null'}}}"] if uses_p else [])
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

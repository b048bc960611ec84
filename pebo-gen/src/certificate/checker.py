
import contextlib
import random
import re
import sys
from decimal import Decimal
from fractions import Fraction

import sympy as sp
from mpmath.libmp import NoConvergence

# ---------------------------------------------------------------------------------------------------------------------
# Formulas: the grammar of a model file is that of Python but for `^`, and its numbers are exact.

TOKEN = re.compile(r"(?P<number>(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?)|(?P<name>[^\W\d]\w*'*)|(?P<power>\^)|(?P<other>\S)|\s+")
FUNCTIONS = {
    name: getattr(sp, name)
    for name in (
        "sin cos tan asin acos atan atan2 sinh cosh tanh asinh acosh atanh exp log sqrt sign".split()
    )
}
FUNCTIONS |= {"abs": sp.Abs, "min": sp.Min, "max": sp.Max, "sat": lambda a: sp.Min(sp.Max(a, -1), 1)}

# Of the values at which a rank is looked at.
DIGITS = 160
# What is left of a zero in so many digits is far below, also where factors such as exp(-8750/T) are not of one size.
SMALL = sp.Float(10, DIGITS) ** (-DIGITS // 2)
# The bits of half the digits, and of ten more.
HALF = int((DIGITS // 2 + 10) * 3.33)
# Points at which the signs of arguments are looked at: a cell that holds one in sixteen is missed once in sixty times.
DRAWN = 64
# Points of a cell at which a rank may fall short by chance, before it is called false.
OF_CELL = 12
# Points at which a statement on trajectories is looked at, and ways in which its equations are solved.
OF_STATEMENT, WAYS = 4, 3

NAMES = {}
ZERO = sp.Integer(0)


def number(text):
    return sp.Rational(Fraction(Decimal(text)))


def formula(text):
    """The expression that a text stands for."""
    code = []
    for token in TOKEN.finditer(text):
        kind, piece = token.lastgroup, token.group()
        if token["number"]:
            code.append(f"number('{piece}')")
        elif token["name"]:
            called = re.match(r"\s*\(", text[token.end():])
            code.append(f"FUNCTIONS['{piece}']" if called else f'named("{piece}")')
        else:
            code.append("**" if kind == "power" else piece)
    return sp.sympify(eval("".join(code), {"number": number, "FUNCTIONS": FUNCTIONS, "named": named}))


def named(text):
    """The symbol of a name; that of a derivative, as v'', if nothing else is known of it."""
    name = text.rstrip("'")
    return NAMES[name] if name == text else derivative(NAMES[name], len(text) - len(name))


def derivative(signal, order):
    return sp.Symbol(f"{signal}^({order})", real=True)


class Table(sp.Function):
    """A function between points, or a derivative of it: polynomials in the distance from where each begins."""

    starts, pieces, slope = (), (), None

    @classmethod
    def eval(cls, argument):
        return cls.piece(argument, argument) if argument.is_Rational or argument.is_Float else None

    @classmethod
    def piece(cls, place, argument):
        """The polynomial that holds at a place, at an argument."""
        at = max((k for k, start in enumerate(cls.starts) if start <= place), default=None)
        # Before the first point its line goes on.
        start, piece = (cls.starts[0], cls.pieces[0][:2 - cls.order]) if at is None else (cls.starts[at], cls.pieces[at])
        return sum((c * (argument - start) ** k for k, c in enumerate(piece)), ZERO)

    def fdiff(self, argindex=1):
        return self.slope(self.args[0]) if self.slope else ZERO


def tabulate(name, stated):
    """Adds a table and its derivatives to the functions."""
    s, v = zip(*([number(text) for text in point] for point in stated["points"]))
    gaps = [b - a for a, b in zip(s, s[1:])]
    chords = [(b - a) / gap for a, b, gap in zip(v, v[1:], gaps)]
    if "linear" in stated:
        pieces = [[value, chord] for value, chord in zip(v, [*chords, chords[-1]])]
    else:
        inner = [0 if a * b <= 0 else 3 * (g + h) / ((2 * h + g) / a + (h + 2 * g) / b)
                 for a, b, g, h in zip(chords, chords[1:], gaps, gaps[1:])]
        ends = [chords[0], chords[-1]]
        if len(chords) > 1:
            ends = [end_slope(*gaps[:2], *chords[:2]), end_slope(*gaps[:-3:-1], *chords[:-3:-1])]
        d = [ends[0], *inner, ends[1]]
        pieces = [[value, a, (3 * chord - 2 * a - b) / gap, (a + b - 2 * chord) / gap**2]
                  for value, a, b, chord, gap in zip(v, d, d[1:], chords, gaps)]
        pieces.append([v[-1], d[-1], 0, 0])
    names = [name, f"{name}_slope", *(f"{name}_slope{order}" for order in range(2, len(pieces[0])))]
    slope = None
    for order in reversed(range(len(pieces[0]))):
        own = [[sp.ff(k, order) * c for k, c in enumerate(piece)][order:] for piece in pieces]
        parts = {"starts": s, "pieces": own, "order": order, "slope": slope}
        slope = FUNCTIONS[names[order]] = type(names[order], (Table,), parts)


def end_slope(gap, following, chord, other):
    """The slope at an end: that of a parabola, kept monotone."""
    slope = ((2 * gap + following) * chord - gap * other) / (gap + following)
    if slope * chord <= 0:
        return ZERO
    return 3 * chord if chord * other < 0 and abs(slope) > abs(3 * chord) else slope


def formulas(texts):
    return [formula(text) for text in texts]


def matrix(rows, height, width):
    """A matrix from its rows; a plain list is a row, a column or a diagonal, whichever fits."""
    if rows is None:
        return sp.zeros(height, width)
    if isinstance(rows, str):
        return sp.Matrix([[formula(rows)]])
    if isinstance(rows[0], list):
        return sp.Matrix([formulas(row) for row in rows])
    entries = formulas(rows)
    if height == width == len(entries):
        return sp.diag(*entries)
    return sp.Matrix(height, width, entries)


def relations(text):
    """A chain of comparisons, pair by pair: left side, relation, right side."""
    parts = re.split(r"(<=|>=|!=|<|>)", text)
    sides = formulas(parts[::2])
    return list(zip(sides, parts[1::2], sides[1:]))


# ---------------------------------------------------------------------------------------------------------------------
# The plant.


class Plant:
    """The signals of PLANT as symbols, its rates, and what is assumed."""

    def __init__(self, stated, derived):
        constants = stated.get("parameters", {})
        self.values = {name: number(value) for name, value in constants.items() if value is not None}
        signs = {name: sp.sign(value) for name, value in self.values.items()}
        for text in stated.get("assume", []):
            sides = re.split(r"(<=|>=|!=|<|>)", text)
            for left, relation, right in zip(sides[::2], sides[1::2], sides[2::2]):
                for name, bound, above in ((left, right, ">"), (right, left, "<")):
                    if relation == above and bound.strip() == "0":
                        signs[name.strip()] = 1
        own = [derived["z"], derived["theta"], *derived["extension"].values(), list(derived["eta"])]
        declared = [*constants, *(name for key in ("x", "y", "u", "w") for name in stated.get(key, []))]
        NAMES["pi"] = sp.pi
        for name in [*declared, *flat(own)]:
            sign = signs.get(name)
            assumed = {1: {"positive": True}, -1: {"negative": True}}.get(sign, {"real": True})
            NAMES[name] = ZERO if name in constants and sign == 0 else sp.Symbol(name, **assumed)
        for name, table in stated.get("tables", {}).items():
            tabulate(name, table)
        for name, text in stated.get("define", {}).items():
            NAMES[name] = formula(text)
        self.x, self.y, self.u, self.w = ([NAMES[name] for name in stated.get(key, [])] for key in ("x", "y", "u", "w"))
        self.assumed = [pair for text in stated.get("assume", []) for pair in relations(text)]
        self.assumed += [pair for text in derived.get("conditions", []) for pair in relations(text)]
        self.identities = formulas(stated.get("identities", []))
        self.known = {NAMES[name]: formula(value) for name, value in stated.get("known", {}).items()}
        self.angles = {NAMES[name]: formula(period) for name, period in stated.get("angles", {}).items()}
        # An output that is given by its value is that value.
        self.given = {NAMES[name]: formula(value) for name, value in stated.get("g_y", {}).items()}
        self.rates = {NAMES[n]: formula(rate) for key in ("f_x", "f_y") for n, rate in stated.get(key, {}).items()}
        for key, expand in (("lti", linear), ("mechanical", mechanical), ("electromechanical", electromechanical)):
            if key in stated:
                self.rates |= expand(self, stated[key])
        if "time" in stated:
            self.rates[NAMES[stated["time"]]] = sp.Integer(1)
        # Its rate follows where the rates of all in it are known: perhaps after those of other outputs.
        for _ in self.given:
            for output, value in self.given.items():
                if output not in self.rates and not self.missing(value):
                    self.rates[output] = self.along(value)
        self.parameters = {NAMES[name] for name in constants}

    def moving(self, expr, more={}):
        """The signals of an expression."""
        return [s for s in sorted(expr.free_symbols, key=str) if s in {*self.x, *self.y, *self.u, *self.w, *more}]

    def missing(self, expr, more={}):
        """The signals of an expression whose rate is not known."""
        return [symbol for symbol in self.moving(expr, more) if symbol not in {**self.rates, **more}]

    def valued(self, expr):
        """The expression without the outputs that are given by their values, which may hold each other."""
        for _ in self.given:
            expr = expr.xreplace(self.given)
        return expr

    def outputs(self, point):
        """The outputs that are given by their values."""
        return {output: self.valued(given).xreplace(point) for output, given in self.given.items()}

    def along(self, expr, more={}):
        """The time derivative of an expression."""
        if self.missing(expr, more):
            # An output by its value, in which an input without a rate may cancel.
            expr = sp.expand(expr.subs(self.given))
        rates, moving = {**self.rates, **more}, self.moving(expr, more)
        missing = self.missing(expr, more)
        if missing:
            raise ValueError(f"the rate of {missing[0]} is not given")
        return sum((sp.diff(expr, symbol) * rates[symbol] for symbol in moving), ZERO)


def flat(nested):
    return [name for item in nested for name in (flat(item) if isinstance(item, list) else [item])]


def linear(plant, blocks):
    x, y, u = sp.Matrix(plant.x), sp.Matrix(plant.y), sp.Matrix(len(plant.u), 1, plant.u)
    n, m, k = len(plant.x), len(plant.y), len(plant.u)
    block = lambda name, height, width: matrix(blocks.get(name), height, width)
    x_rates = block("A11", n, n) * x + block("A12", n, m) * y + block("B1", n, k) * u
    y_rates = block("A21", m, n) * x + block("A22", m, m) * y + block("B2", m, k) * u
    return dict(zip([*plant.x, *plant.y], [*x_rates, *y_rates]))


def mechanical(plant, parts):
    """Hamilton's equations: x are the momenta, y the positions."""
    n = len(plant.x)
    p, inverse = sp.Matrix(plant.x), matrix(parts["M"], n, n).inv(method="ADJ")
    force = matrix(parts.get("G"), n, len(plant.u)) * sp.Matrix(len(plant.u), 1, plant.u)
    potential = formula(parts.get("V", "0"))
    momenta = [-sp.diff(potential, q) - (p.T * inverse.diff(q) * p)[0] / 2 + f for q, f in zip(plant.y, force)]
    return dict(zip([*plant.y, *plant.x], [*(inverse * p), *momenta]))


def electromechanical(plant, parts):
    """Coils that move a mass: x is the position, the first outputs are the currents."""
    (q,), speed = plant.x, NAMES[parts["speed"]]
    currents, voltages = ([s for s in signals if s != speed] for signals in (plant.y, plant.u))
    n, i = len(currents), sp.Matrix(currents)
    inductance, magnets = matrix(parts["L"], n, n), matrix(parts.get("mu"), n, 1)
    driving = matrix(parts["B"], n, len(voltages)) if "B" in parts else sp.eye(n)
    emf = speed * (inductance.diff(q) * i + magnets.diff(q))
    driven = driving * sp.Matrix(len(voltages), 1, voltages) - matrix(parts.get("R"), n, n) * i - emf
    rates = dict(zip(currents, inductance.inv() * driven)) | {q: speed}
    if "inertia" in parts and speed in plant.y:
        force = (i.T * inductance.diff(q) * i)[0] / 2 + (i.T * magnets.diff(q))[0]
        drag = formula(parts.get("friction", "0")) * speed + formula(parts.get("load", "0"))
        rates[speed] = (force - drag) / formula(parts["inertia"])
    return rates


# ---------------------------------------------------------------------------------------------------------------------
# Zero: proved by polynomials, refuted by a point.


# Functions that are analytic while arguments or differences of arguments keep their signs; and their derivatives.
BENT = (sp.Abs, sp.sign, sp.Max, sp.Min)
STEPS = (sp.Heaviside, sp.DiracDelta)


def polynomials(exprs):
    """Expressions as quotients of polynomials in kernels that they share, with the relations among these, innermost first."""
    known, relations = {}, []

    def kernel(e):
        if e not in known:
            known[e] = sp.Dummy(f"k{len(known)}")
        return known[e]

    def convert(e):
        if e.is_Symbol or e.is_Rational or e == sp.pi:
            return e
        if e.is_Add or e.is_Mul:
            return e.func(*map(convert, e.args))
        if e.is_Pow and e.exp.is_Integer:
            return convert(e.base) ** e.exp
        if e.is_Pow and e.exp.is_Rational:
            root = known.get((e.base, e.exp.q))
            if root is None:
                inner = convert(e.base)
                root = known[(e.base, e.exp.q)] = sp.Dummy(f"r{len(known)}")
                relations.append((root, e.exp.q, inner))
            return root ** e.exp.p
        if isinstance(e, sp.Abs):
            if e not in known:
                inner = convert(e.args[0])
                relations.append((kernel(e), 2, inner**2))
            return kernel(e)
        if isinstance(e, (sp.sin, sp.cos)):
            sine, cosine = kernel(sp.sin(e.args[0])), kernel(sp.cos(e.args[0]))
            if not any(relation[0] is cosine for relation in relations):
                relations.append((cosine, 2, 1 - sine**2))
            return sine if isinstance(e, sp.sin) else cosine
        return kernel(e)

    converted = []
    for expr in exprs:
        expr = expr.replace(lambda e: isinstance(e, (sp.sinh, sp.cosh, sp.tanh)), lambda e: e.rewrite(sp.exp))
        expr = expr.replace(lambda e: isinstance(e, (sp.asinh, sp.acosh, sp.atanh)), lambda e: e.rewrite(sp.log))
        # But where the argument is zero, which has no inner points.
        expr = expr.replace(lambda e: isinstance(e, (sp.Max, sp.Min)), by_size)
        expr = expr.replace(lambda e: isinstance(e, sp.sign), lambda e: sp.Abs(e.args[0]) / e.args[0])
        expr = expr.replace(lambda e: isinstance(e, sp.tan), lambda e: sp.sin(e.args[0]) / sp.cos(e.args[0]))
        converted.append(convert(sp.expand_log(sp.expand_power_exp(sp.expand_trig(expr)))))
    return converted, relations


def by_size(e):
    """The larger or smaller of several by the sizes of their differences."""
    first, *others = e.args
    for other in others:
        size = sp.Abs(first - other)
        first = (first + other + (size if isinstance(e, sp.Max) else -size)) / 2
    return first


def is_zero(expr, identities=()):
    """Whether the expression is shown to vanish, where the identities do."""
    if expr == 0 or sp.expand(expr) == 0:
        return True
    (converted, *vanishing), relations = polynomials([expr, *identities])
    numerator = sp.numer(sp.together(converted))
    for symbol, degree, value in reversed(relations):
        above, below = sp.fraction(sp.together(value))
        numerator = sp.prem(sp.expand(numerator), below * symbol**degree - above, symbol)
    numerator = sp.expand(numerator)
    if numerator != 0 and identities:
        ideal = [sp.numer(sp.together(identity)) for identity in vanishing]
        numerator = sp.reduced(numerator, ideal)[1]
    # Of arguments with signs SymPy simplifies little, and for long: cells do better.
    return numerator == 0 or (not identities and not expr.has(*BENT, *STEPS, Table) and sp.simplify(expr) == 0)


class Points:
    """Points of the domain, drawn at random from a fixed seed: rational ones, but for what the identities fix."""

    def __init__(self, plant):
        self.plant, self.draw = plant, random.Random(1)

    def value(self, symbol):
        given = self.plant.values.get(str(symbol)) if symbol in self.plant.parameters else None
        size = sp.Rational(self.draw.randint(1, 300), self.draw.choice((7, 100, 200)))
        if given is not None and given != 0:
            return given * size
        if symbol.is_positive or symbol.is_negative:
            return size if symbol.is_positive else -size
        return size * self.draw.choice((-1, 1))

    def point(self, symbols):
        """Values for the symbols and for all that the assumptions speak of; none if no point was met."""
        spoken = [e for left, _, right in self.plant.assumed for e in (left, right)] + self.plant.identities
        related = set().union(*(e.free_symbols for e in spoken))
        for _ in range(500):
            point = {symbol: self.value(symbol) for symbol in sorted({*symbols, *related}, key=str)}
            if self.onto_identities(point) and self.is_assumed(point):
                return point
        return None

    def is_assumed(self, point):
        return all(self.holds(*pair, point) for pair in self.plant.assumed)

    def onto_identities(self, point):
        """Gives one symbol of each identity the value that it has by it, and says whether all of them hold."""
        free = list(self.plant.x) + list(self.plant.y)
        for identity in self.plant.identities:
            symbol = next((s for s in free if s in identity.free_symbols), None)
            if symbol is None:
                return False
            free.remove(symbol)
            alone = identity.subs({other: value for other, value in point.items() if other != symbol})
            if not alone.is_polynomial(symbol):
                return False
            root = self.root(sp.Poly(alone, symbol))
            if root is None:
                return False
            point[symbol] = root
        return all(abs(sp.N(identity.subs(point), 50)) < sp.Float("1e-35") for identity in self.plant.identities)

    @staticmethod
    def root(polynomial):
        """The largest real root to sixty digits; none if there is none, or if SymPy's iteration does not find them."""
        if polynomial.degree() == 1:
            slope, rest = polynomial.all_coeffs()
            return sp.N(-rest / slope, 60)
        try:
            roots = polynomial.nroots(n=60, maxsteps=200)
        except NoConvergence:
            return None
        real = [sp.re(root) for root in roots if abs(sp.im(root)) < 1e-40]
        return real[-1] if real else None

    @staticmethod
    def holds(left, relation, right, point):
        difference = sp.N((left - right).subs(point), 30)
        if not difference.is_real:
            return False
        return {"<": difference < 0, "<=": difference <= 0, ">": difference > 0, ">=": difference >= 0}.get(
            relation, difference != 0
        )

    def refutes(self, expr):
        """A point at which the expression is not zero, and its value there."""
        for _ in range(12):
            point = self.point(expr.free_symbols)
            value = sp.N(expr.subs(point), 40) if point is not None else None
            # Forty digits are asked for; what is left of a zero is far below.
            if value is not None and value.is_number and value.is_finite and abs(value) > sp.Float("1e-25"):
                return {symbol: sp.N(point[symbol], 8) for symbol in expr.free_symbols}, sp.N(value, 6)
        return None


# ---------------------------------------------------------------------------------------------------------------------
# Ranks, cells and trajectories.


def value(expr, point, comparable=False):
    """The value at a point: exact if it is rational, else in so many digits, and zero where none of them is certain, as of
    summands that cancel. One that is to be comparable has half of the digits, or there is none."""
    at = expr.xreplace(point)
    if at.is_Rational:
        return at
    at = at.evalf(DIGITS)
    if not (at.is_number and at.is_real and at.is_finite):
        raise NoValue
    if comparable and at.is_Float and at._prec < HALF:
        raise NoValue
    return ZERO if at.is_Float and at._prec < 64 else at


class NoValue(Exception):
    """An expression has no value at a point, which is beyond the domain then."""


def rank(rows):
    """The rank of numbers, by elimination with the largest pivot: exact where all are rational."""
    rows = [list(row) for row in rows]
    if not all(entry.is_Rational for row in rows for entry in row):
        # Columns and then rows of the length one: an unknown may enter with a factor such as exp(-8750/T).
        for _ in range(2):
            lengths = [sp.sqrt(sum(entry**2 for entry in line)).evalf(DIGITS) for line in zip(*rows)]
            # Scaled and turned over: the second time it is the rows.
            rows = [[e / length if length else e for e in line] for line, length in zip(zip(*rows), lengths)]
    found = 0
    while rows and rows[0]:
        size, i, j = max((abs(entry), -i, -j) for i, row in enumerate(rows) for j, entry in enumerate(row))
        if size == 0 or size.is_Float and size < SMALL:
            break
        pivot, found = rows.pop(-i), found + 1
        rows = [[e - row[-j] / pivot[-j] * p for k, (e, p) in enumerate(zip(row, pivot)) if k != -j] for row in rows]
    return found


class Cell:
    """The cell of a point, on which no argument of abs, sign, max and min changes its sign, and none of a table its piece."""

    def __init__(self, point):
        self.point, self.on_border = point, False

    def smooth(self, expr):
        """The expression by its branches, from the innermost on. On a border, which is not left, any branch will do."""
        bent = (*BENT, *STEPS, Table)
        return expr.replace(lambda e: isinstance(e, bent), self.branch) if expr.has(*bent) else expr

    def branch(self, e):
        if isinstance(e, (sp.Max, sp.Min)):
            values = [value(argument, self.point) for argument in e.args]
            best = (max if isinstance(e, sp.Max) else min)(values)
            self.on_border |= values.count(best) > 1
            return e.args[values.index(best)]
        argument = e.args[0]
        if isinstance(e, Table):
            place = value(argument, self.point)
            self.on_border |= any(place == start for start in e.starts)
            return e.piece(place, argument)
        sign = sp.sign(value(argument, self.point))
        self.on_border |= sign == 0
        if isinstance(e, STEPS):
            return sp.Integer(1) if isinstance(e, sp.Heaviside) and sign > 0 else ZERO
        return sign if isinstance(e, sp.sign) else sign * argument


class Rows:
    """The regressor with its derivatives along trajectories: all of them, those with constant inputs, or equilibria."""

    def __init__(self, certificate, cell, constant=(), rest=False):
        plant, self.at_start = certificate.plant, certificate.at_start
        self.smooth = lambda expr: cell.smooth(plant.valued(expr))
        signals = [signal for signal in [*plant.y, *plant.u, *plant.w] if signal not in plant.given]
        flow = dict(zip(certificate.xi, certificate.Lambda * sp.Matrix(certificate.xi) + sp.Matrix(certificate.h)))
        if certificate.psi:
            flow |= dict(zip(flat(certificate.psi), certificate.Lambda * certificate.Psi))
        if rest:
            # Under a generalised cascade the extension moves all the same.
            self.free, self.rates = [], {s: ZERO for s in [*plant.x, *signals, *([] if certificate.psi else flow)]}
        else:
            self.rates = {s: self.smooth(rate) for s, rate in plant.rates.items() if s not in plant.given}
            self.rates |= {s: ZERO for s in constant}
            # Inputs, and outputs whose rate is not given, may move in any way.
            self.free = [derivative(s, 1) for s in signals if s not in self.rates]
            self.rates |= {s: derivative(s, 1) for s in signals if s not in self.rates}
        self.rates = {s: self.smooth(rate) for s, rate in flow.items()} | self.rates
        self.order, self.levels, self.certificate = 1, [], certificate
        # But as identities leave it.
        self.bind([self.smooth(identity) for identity in plant.identities], cell.point)

    def along(self, expr):
        moving = sorted(expr.free_symbols & {*self.rates}, key=str)
        return sum((sp.diff(expr, symbol) * self.rates[symbol] for symbol in moving), ZERO)

    def bind(self, equations, point):
        """Sets free derivatives by equations that hold at all times, and returns the rates that have to vanish as well."""
        left = []
        for equation in equations:
            moved = self.along(equation)
            for free in self.free:
                slope = sp.diff(moved, free)
                if slope != 0 and value(slope, {free_: ZERO for free_ in self.free} | point) != 0:
                    bound = {free: -moved.xreplace({free: ZERO}) / slope}
                    self.rates = {symbol: rate.xreplace(bound) for symbol, rate in self.rates.items()}
                    self.free.remove(free)
                    break
            else:
                left.append(moved)
        return left

    def level(self, order):
        """The derivatives of an order, with Psi at its start: being inverted at all times, it takes nothing from ranks."""
        if not self.levels:
            # Of a row under a derivative, the rate of the factor counts as well.
            rows = self.certificate.regressor.applyfunc(self.smooth)
            if self.certificate.primitive is not None:
                rows -= self.certificate.primitive.applyfunc(self.smooth).applyfunc(self.along)
            self.levels = [rows]
        while len(self.levels) <= order:
            if len(self.levels) > 1:
                self.order += 1
                following = {free: sp.Symbol(f"{str(free)[:-3]}({self.order})", real=True) for free in self.free}
                self.rates |= following
                self.free = list(following.values())
            self.levels.append(self.levels[-1].applyfunc(self.along))
        return self.levels[order].xreplace(self.at_start)

    def at(self, point, orders):
        """The values at a point up to an order, or until one adds nothing to the rank: then none does. And the rank."""
        values, known = [], -1
        for order in range(orders):
            level = self.level(order)
            new = sorted(level.free_symbols - {*point}, key=str)
            point |= {symbol: self.certificate.points.value(symbol) for symbol in new}
            values += [[value(entry, point) for entry in row] for row in level.tolist()]
            known, before = rank(values), known
            if known in (before, level.cols):
                break
        return values, known


def quadratic(factor, symbol):
    """The values of a symbol at which a polynomial vanishes that is linear or quadratic in it."""
    *square, slope, rest = sp.Poly(factor, symbol).all_coeffs()
    if not square:
        return [-rest / slope]
    root = sp.sqrt(slope**2 - 4 * square[0] * rest)
    return [(-slope + root) / (2 * square[0]), (-slope - root) / (2 * square[0])]


class Trajectories:
    """Points at which formulas vanish, and go on to vanish: exact ones."""

    def __init__(self, certificate):
        self.certificate, self.plant, self.points = certificate, certificate.plant, certificate.points
        plant = self.plant
        self.signals = [s for s in [*plant.u, *plant.y, *plant.x, *plant.w] if s not in plant.given] + certificate.xi
        self.rates = [plant.valued(rate) for signal, rate in plant.rates.items()
                      if signal not in plant.given and signal not in plant.u]
        # False where an equation could not be solved.
        self.all = True

    def met(self, symbols):
        """Points of the domain: exact ones, as a rank that is not full would seem to be beside an identity."""
        exact = bool(self.plant.identities)
        while exact:
            points = [point for point, _ in self.solved([self.plant.valued(e) for e in self.plant.identities], [], [])]
            exact = bool(points)
            yield from points
        while True:
            yield self.points.point(symbols)

    def of(self, condition, listed=()):
        """Points of the trajectories of a condition, with the rows there: enough of them outside listed conditions."""
        zero = [self.plant.valued(formula(text)) for text in condition.get("zero", [])]
        positive = formulas(condition.get("positive", []))
        rest, constant = condition.get("rest"), [NAMES[name] for name in condition.get("constant", [])]
        equations = zero + [self.plant.valued(identity) for identity in self.plant.identities]
        if rest:
            equations += self.rates
        found = 0
        for _ in range(WAYS):
            for point, factors in self.solved(equations, zero, positive):
                try:
                    for rows in self.remaining(point, factors, zero, positive, constant, rest):
                        found += not any(self.holds(entry, rows[0]) for entry in listed)
                        yield rows
                        break
                except NoValue:
                    continue
                if found >= OF_STATEMENT:
                    return

    def remaining(self, point, factors, zero, positive, constant, rest, depth=0):
        """The point with its rows, if the equations go on to hold; if not, one at which their rates vanish too."""
        rows = Rows(self.certificate, Cell(point), constant, rest)
        cell = Cell(point)
        left = [] if rest else rows.bind([cell.smooth(factor) for factor in factors], point)
        left = [moved for moved in left if value(moved, {free: ZERO for free in rows.free} | point) != 0]
        if not left:
            yield point, rows
        elif depth < len(self.signals):
            for point, factors in self.solved(factors + left, zero, positive):
                yield from self.remaining(point, factors, zero, positive, constant, rest, depth + 1)

    def solved(self, equations, zero, positive):
        """Points at which equations hold, one for each way in which they do, with the factors that vanish there."""
        spoken = set().union(*(e.free_symbols for e in zero)) if zero else set()
        parameters = self.certificate.parameters
        # Parameters of which the condition says nothing have any value.
        fixed = {symbol: self.points.value(symbol) for symbol in sorted(parameters - spoken, key=str)}
        for solution, factors in self.branches([e.xreplace(fixed) for e in equations], parameters & spoken):
            point = self.placed(fixed, solution, equations, positive)
            if point is not None:
                yield point, factors

    def branches(self, equations, parameters):
        """Ways in which all equations hold: pairs of a symbol and its value, which reads symbols that come later."""
        try:
            left = [sp.numer(sp.together(e)) for e in equations]
            left = [e for e in left if e != 0 and sp.expand(e) != 0]
            if not left:
                yield [], []
                return
            first = min(left, key=lambda e: (e.has(*BENT), len(e.free_symbols), sp.count_ops(e), str(e)))
            if not first.free_symbols:
                # What is no zero to the eye may be one.
                if value(first, {}) == 0:
                    left.remove(first)
                    yield from self.branches(left, parameters)
                return
            bent = [e for e in first.atoms(*BENT) if not any(argument.has(*BENT) for argument in e.args)]
            if bent:
                e = min(bent, key=str)
                by_sign = {sp.Abs: lambda a: [a, -a], sp.sign: lambda a: [sp.Integer(1), sp.Integer(-1)]}
                for branch in by_sign[e.func](*e.args) if e.func in by_sign else e.args:
                    yield from self.branches([other.xreplace({e: branch}) for other in left], parameters)
                return
            # A power of e with a quotient in it would be a polynomial of a high degree.
            kernels = {e: sp.Dummy() for e in first.atoms(sp.Function, sp.Pow) if not (e.is_Pow and e.exp.is_Integer)}
            factors = [factor for factor, _ in sp.factor_list(first.xreplace(kernels))[1]]
        except (sp.PolynomialError, NoValue):
            self.all = False
            return
        for factor in factors:
            back = {kernel: e for e, kernel in kernels.items()}
            within = set().union(*(back[kernel].free_symbols for kernel in factor.free_symbols & {*back}))
            roots = self.roots(factor, within, back, parameters)
            factor = factor.xreplace(back)
            for symbol, root in roots:
                following = [e.xreplace({symbol: root}) for e in left]
                for solution, others in self.branches(following, parameters):
                    yield [(symbol, root), *solution], [factor, *others]

    def roots(self, factor, within, back, parameters):
        """A symbol of a factor with the values at which it vanishes, one by one; some symbols are within functions."""
        whole = factor.xreplace(back)
        if whole.is_nonzero:
            return
        symbols = [s for s in self.signals if s in whole.free_symbols]
        self.points.draw.shuffle(symbols)
        symbols += sorted(parameters & whole.free_symbols, key=str)
        degree = lambda s: sp.degree(factor, s) if s in factor.free_symbols else 9
        degrees = {s: 9 if s in within else degree(s) for s in symbols}
        best = min(symbols, key=degrees.get, default=None)
        if best is not None and degrees[best] <= 2:
            return (yield from ((best, root.xreplace(back)) for root in quadratic(factor, best)))
        # Or a symbol of one function alone, which is inverted.
        for symbol in symbols:
            held = [kernel for kernel in factor.free_symbols & {*back} if symbol in back[kernel].free_symbols]
            if len(held) == 1 and symbol not in factor.free_symbols and sp.degree(factor, held[0]) <= 2:
                level = sp.Dummy(real=True)
                with contextlib.suppress(NotImplementedError):
                    inverse = sp.solve(back[held[0]] - level, symbol)
                    values = [root.xreplace(back) for root in quadratic(factor, held[0])]
                    return (yield from ((symbol, e.xreplace({level: root})) for root in values for e in inverse))
        self.all &= not symbols

    def placed(self, fixed, solution, equations, positive):
        """A point with these values at which all equations hold, and what is assumed."""
        at = {symbol for symbol, _ in solution}
        spoken = [*equations, *positive, *(e for left, _, right in self.plant.assumed for e in (left, right))]
        spoken += self.certificate.regressor[:] + list(self.plant.rates.values()) + list(self.plant.given.values())
        drawn = {*self.signals, *self.certificate.parameters}.union(*(e.free_symbols for e in spoken))
        drawn -= at | {*fixed, *self.plant.given} | {*self.certificate.at_start}
        drawn = sorted(drawn, key=str)
        for _ in range(100):
            point = fixed | {symbol: self.points.value(symbol) for symbol in drawn}
            try:
                for symbol, root in reversed(solution):
                    point[symbol] = root.xreplace(point)
                    size = value(point[symbol], {})
                    if symbol.is_positive and not size > 0 or symbol.is_negative and not size < 0:
                        raise NoValue
                point |= self.plant.outputs(point)
                if all(value(e, point) > 0 for e in positive) and self.points.is_assumed(point):
                    if all(value(e, point) == 0 for e in equations):
                        return point
            except NoValue:
                pass
        return None

    def holds(self, condition, point):
        """Whether a condition on signals alone holds at a point."""
        try:
            return all(value(self.plant.valued(e), point) == 0 for e in formulas(condition.get("zero", []))) and all(
                value(self.plant.valued(e), point) > 0 for e in formulas(condition.get("positive", []))
            )
        except NoValue:
            return False


# ---------------------------------------------------------------------------------------------------------------------
# The claims.


class Certificate:
    def __init__(self, stated, derived):
        self.plant, self.derived = Plant(stated, derived), derived
        self.points = Points(self.plant)
        self.worst = 0
        self.z = [NAMES[name] for name in derived["z"]]
        self.theta = [NAMES[name] for name in derived["theta"]]
        extension = derived["extension"]
        self.xi = [NAMES[name] for name in extension.get("chi", extension.get("xi"))]
        self.psi = [[NAMES[name] for name in row] for row in extension.get("Psi", [])]
        self.phi, self.h = formulas(derived["phi"]), formulas(derived["h"])
        n = len(self.phi)
        self.Lambda = sp.Matrix([formulas(row) for row in derived["Lambda"]]) if "Lambda" in derived else sp.zeros(n, n)
        self.Psi = sp.Matrix(self.psi) if self.psi else sp.eye(n)
        self.at_start = dict(zip(flat(self.psi), sp.eye(n))) if self.psi else {}
        self.regressor = self.sides("phi")[1]
        if derived.get("local"):
            # Along a trajectory the extension is z.
            self.regressor = self.regressor.subs(dict(zip(self.xi, self.phi)), simultaneous=True)
        self.primitive = self.sides("primitive")[1] if "primitive_1" in derived else None
        self.is_linear = [*derived["eta"].values()] == derived["theta"]
        self.unknowns = dict(zip(derived["theta"] if self.is_linear else derived["eta"], derived["eta"].values()))
        # Of the others all that follows is said.
        fixed = [name in derived.get("by start", []) for name in self.unknowns]
        for column in reversed([column for column, is_fixed in enumerate(fixed) if is_fixed]):
            self.regressor.col_del(column)
            if self.primitive is not None:
                self.primitive.col_del(column)
        self.rest = [unknown for unknown, is_fixed in zip(self.z if self.is_linear else self.unknowns, fixed) if not is_fixed]
        self.width = self.regressor.cols
        self.parameters = {symbol for symbol in self.plant.parameters if symbol.is_Symbol}
        self.motion = derived.get("trajectories", {})
        self.sets = Trajectories(self)

    def say(self, claim, verdict, detail=""):
        # What holds at points is a statement on trajectories: no point proves it, but one can refute it.
        self.worst = max(self.worst, {"FALSE": 2, "undecided": 1}.get(verdict, 0))
        print(f"{claim:<40} {verdict}{detail}")

    def vanishes(self, claim, expr):
        """Says whether an expression is zero on the domain."""
        expr = expr.subs(self.plant.given)
        for left, relation, right in self.plant.assumed:
            if relation != "!=":
                above = right - left if relation[0] == "<" else left - right
                signs = {} if relation.endswith("=") else {sp.sign(above): 1}
                expr = expr.subs({sp.Abs(above): above, sp.Abs(-above): above, **signs})
        if is_zero(expr, self.plant.identities):
            return self.say(claim, "proved")
        if expr.has(*BENT, *STEPS, Table):
            cells = self.branches(expr)
            if cells and all(is_zero(branch, self.plant.identities) for branch in cells):
                return self.say(claim, "proved", f" on each cell that was met: {len(cells)} forms")
        found = self.points.refutes(expr)
        if found:
            point = ", ".join(f"{symbol} = {value!s}" for symbol, value in found[0].items())
            return self.say(claim, "FALSE", f": the difference is {found[1]!s} at {point}")
        return self.say(claim, "undecided", f": {sp.sstr(expr)[:200]}")

    def branches(self, expr):
        """The forms that an expression has on the cells that are met."""
        found = []
        for _ in range(DRAWN):
            point = self.points.point(expr.free_symbols)
            with contextlib.suppress(NoValue):
                cell = Cell(point or {})
                branch = cell.smooth(expr)
                found += [branch] if not cell.on_border and branch not in found else []
        return found

    def reads(self, claim, exprs, allowed):
        """Says whether expressions hold no symbol but these and parameters."""
        known = set(allowed) | self.plant.parameters
        foreign = set().union(*(expr.free_symbols for expr in exprs)) - known if exprs else set()
        self.say(claim, "FALSE" if foreign else "proved", f": it holds {foreign}" if foreign else "")

    def cascade(self):
        plant = self.plant
        measured = [*plant.y, *plant.u]
        self.reads("h and Lambda are free of x", [*self.h, *self.Lambda], measured)
        flow = self.Lambda * sp.Matrix(self.phi) + sp.Matrix(self.h)
        for k, (component, side) in enumerate(zip(self.phi, flow), 1):
            self.vanishes(f"cascade: z{k}'", plant.along(component) - side)

    def left_inverse(self):
        at = dict(zip(self.z, self.phi))
        inverse = {NAMES[name]: formula(text) for name, text in self.derived["phi_left"].items()}
        self.reads("phi_left reads z and y", list(inverse.values()), [*self.z, *self.plant.y])
        for state, value in inverse.items():
            error = value.subs(at, simultaneous=True) - state
            period = self.plant.angles.get(state)
            if period is None:
                self.vanishes(f"left inverse: {state}", error)
            else:
                # A whole number of periods: its angle on the circle is that of zero.
                turn = sp.expand(2 * sp.pi * error / period)
                self.vanishes(f"left inverse: {state}, on the circle", sp.expand_trig(sp.cos(turn)) - 1)

    def regression(self):
        plant, derived = self.plant, self.derived
        unknowns = {NAMES[name]: formula(text) for name, text in derived["eta"].items()}
        eta = sp.Matrix(list(unknowns.values()))
        phi_0, phi_1 = self.sides("phi")
        extension = [*self.xi, *(entry for row in self.psi for entry in row)]
        self.reads("the regression is free of x", [*phi_0, *phi_1], [*extension, *plant.y, *plant.u])
        right = phi_0 + phi_1 * eta
        if "y'" in derived:
            left = sp.Matrix([plant.rates[NAMES[name]] for name in derived["y'"]])
        elif "primitive_0" in derived or "primitive_1" in derived:
            held_0, held_1 = self.sides("primitive")
            rates = dict(zip(self.xi, self.Lambda * sp.Matrix(self.xi) + sp.Matrix(self.h)))
            if self.psi:
                rates |= dict(zip(flat(self.psi), self.Lambda * self.Psi))
            left = sp.Matrix([plant.along(held, rates) for held in held_0 + held_1 * eta])
        else:
            left, right = phi_0, phi_1 * eta
        if derived.get("local"):
            # To first order: the slopes by theta are those where it is zero.
            slopes = phi_0.jacobian(self.xi) * self.Psi
            of_theta = -phi_1 if left == phi_0 else phi_1
            for k, difference in enumerate(flat((slopes - of_theta).tolist()), 1):
                self.vanishes(f"regression: slope {k}", difference)
            zero = dict.fromkeys(self.theta, 0)
            left, right = left.subs(zero), right.subs(zero)
            start = dict(zip(self.xi, self.phi))
        else:
            # z = xi + Psi theta, for any theta and Psi.
            start = dict(zip(self.xi, sp.Matrix(self.phi) - self.Psi * sp.Matrix(self.theta)))
        for k, difference in enumerate(left - right, 1):
            self.vanishes(f"regression: row {k}", difference.subs(start, simultaneous=True))
        for symbol, back in zip(self.theta, formulas(derived["theta of eta"])):
            error = back.subs(unknowns, simultaneous=True) - symbol
            angle, angles = sp.Dummy(), back.atoms(sp.atan2)
            turn = sp.diff(back.subs({other: angle for other in angles}), angle)
            if len(angles) == 1 and not turn.has(angle) and not is_zero(error, plant.identities):
                # Known up to whole turns of that angle.
                claim = f"regression: {symbol}, up to {2 * sp.pi * turn}"
                self.vanishes(claim, sp.expand_trig(sp.cos(sp.expand(error / turn))) - 1)
            else:
                self.vanishes(f"regression: {symbol} from the unknowns", error)

    def sides(self, name):
        """The known part and the factor of the unknowns."""
        known = self.derived.get(f"{name}_0")
        rows = self.derived.get(f"{name}_1")
        height = len(known) if known else len(rows)
        width = len(self.derived["eta"])
        zero_0, zero_1 = sp.zeros(height, 1), sp.zeros(height, width)
        return sp.Matrix(formulas(known)) if known else zero_0, sp.Matrix(list(map(formulas, rows))) if rows else zero_1

    def identifiability(self):
        """On each cell of the domain the regressor has full column rank; if it takes excitation, with its derivatives along the
        plant. A cell that is listed may have a lower one; if all are, several have it together."""
        kind, shown = self.derived["identifiability"], self.derived.get("determinant of phi_1' phi_1")
        self.by_start()
        if self.width == 0:
            return
        if shown and self.width <= 3 and self.primitive is None:
            start = self.regressor.subs(self.at_start)
            self.vanishes("the determinant of phi_1' phi_1", (start.T * start).det() - formula(shown))
        self.full_rank(f"identifiability: {kind}", self.width if kind == "excitation" else 1, ())

    def by_start(self):
        """The unknowns that are zero where the states start at their known values and the extension at phi."""
        start = [component.subs(self.plant.known, simultaneous=True) for component in self.phi]
        signals = {*self.plant.x, *self.plant.y, *self.plant.u, *self.plant.w}
        zeros = {theta: ZERO for theta, at in zip(self.theta, start) if not at.free_symbols & signals and at.is_finite is not False}
        for name in self.derived.get("by start", []):
            self.vanishes(f"by the known start: {name}", formula(self.unknowns[name]).subs(zeros))

    def full_rank(self, claim, orders, constant):
        """Says whether the regressor, with its derivatives below an order, has full rank on each cell that is not listed."""
        rates, blind = [*self.plant.rates.values()], self.motion.get("blind", [])
        cells = [entry for entry in blind if not entry.keys() & {"zero", "constant", "rest"}]
        looked = [*self.regressor, *(self.primitive or []), *rates, *self.h, *self.Lambda, *self.plant.identities]
        texts = [*flat([entry.get("positive", []) for entry in cells])]
        symbols = set().union(*(self.plant.valued(e).free_symbols for e in [*looked, *formulas(texts)]))
        patterns, points = {}, self.sets.met(symbols - {*self.plant.given} - {*self.at_start})
        least = DRAWN if any(e.has(*BENT, Table) for e in looked) else 1
        for drawn in range(least + OF_CELL):
            if drawn >= least and all(full or listed for _, _, full, listed in patterns.values()):
                break
            point = next(points, None)
            if point is None:
                return self.say(claim, "undecided", ": no point was met at which the assumptions hold")
            point |= self.plant.outputs(point)
            try:
                cell = Cell(point)
                smooth = tuple(cell.smooth(self.plant.valued(e)) for e in looked)
                listed = any(self.sets.holds(entry, point) for entry in cells)
                if cell.on_border:
                    continue
                if (smooth, listed) not in patterns:
                    patterns[smooth, listed] = [point, Rows(self, cell, constant), False, listed]
                entry = patterns[smooth, listed]
                if not entry[2] and not listed:
                    entry[2] = entry[1].at(point, orders)[1] == self.width
            except NoValue:
                continue
        if not patterns:
            return self.say(claim, "undecided", ": the regressor has a value at no point that was met")
        for point, rows, full, listed in patterns.values():
            if not full and not listed:
                return self.say(claim, "FALSE", f": the regressor has no full rank around {self.shown(point)}")
        if all(listed for *_, listed in patterns.values()) and not self.together(patterns, orders):
            return self.say(claim, "FALSE", ": the cells have no full rank together")
        return self.say(claim, "proved")

    def together(self, patterns, orders):
        """Whether the rows at points of all cells have full rank."""
        values = []
        for point, rows, *_ in patterns.values():
            with contextlib.suppress(NoValue):
                values += rows.at(point, orders)[0]
        return bool(values) and rank(values) == self.width

    def trajectories(self):
        """What is said of equilibria and of other trajectories, at points of these: one that contradicts it refutes it."""
        if self.motion.get("by itself"):
            self.full_rank("identified with constant inputs", self.width, self.plant.u)
        blind = self.motion.get("blind", [])
        exceptions = blind + self.motion.get("undecided", [])
        if self.motion.get("at rest"):
            self.at_rest("identified at rest", exceptions)
        for entry in blind:
            # Where another statement says that more is hidden, or that it is open, this one is of the others.
            own = len(entry.get("hidden", []))
            special = [other for other in exceptions if other is not entry
                       and other.get("zero") and len(other.get("hidden", [])) not in range(1, own + 1)]
            self.blind(f"while {entry['while']}", entry, special)

    def at_rest(self, claim, exceptions):
        self.sets.all, full, listed = True, 0, 0
        for point, rows in self.sets.of({"rest": True}, exceptions):
            if any(self.sets.holds(entry, point) for entry in exceptions):
                listed += 1
            elif rows.at(point, self.width)[1] < self.width:
                return self.say(claim, "FALSE", f": no full rank at {self.shown(point)}")
            else:
                full += 1
        if full == 0 and listed > 0 and self.sets.all:
            return self.say(claim, "FALSE", ": each equilibrium that was met is an exception")
        return self.say(claim, *(("holds", f" at {full} points") if full else ("not checked", ": no point was met")))

    def blind(self, claim, entry, special):
        """On the trajectories of a condition some directions are hidden, and these combinations are identified."""
        plant, unknowns = self.plant, self.rest if self.is_linear else [NAMES[name] for name in self.rest]
        hidden = [[plant.valued(e).xreplace(self.at_start) for e in formulas(d)] for d in entry.get("hidden", [])]
        seen = [
            [sp.diff(plant.valued(e), unknown).xreplace(self.at_start) for unknown in unknowns]
            for e in formulas(entry.get("identified", []))
        ]
        looked = 0
        for point, rows in self.sets.of(entry, special):
            if any(self.sets.holds(other, point) for other in special):
                continue
            try:
                values, known = rows.at(point, self.width)
                directions = [[value(e, point, True) for e in direction] for direction in hidden]
                gradients = [[value(e, point, True) for e in gradient] for gradient in seen]
            except (NoValue, ZeroDivisionError):
                continue
            looked += 1
            wrong = None
            if any(not self.orthogonal(row, direction) for row in values for direction in directions):
                wrong = "a direction is not hidden"
            elif known == self.width:
                wrong = "all unknowns are identified"
            elif gradients and rank(values + gradients) > known:
                wrong = "a combination is not identified"
            elif known + len(hidden) != self.width:
                wrong = f"the rank is {known}"
            elif rank(directions) != len(hidden) or len(hidden) + (rank(gradients) if seen else 0) != self.width:
                wrong = "directions and combinations are not all of the unknowns"
            if wrong:
                return self.say(claim, "FALSE", f": {wrong} at {self.shown(point)}")
        self.say(claim, *(("holds", f" at {looked} points") if looked else ("not checked", ": no point was met")))

    @staticmethod
    def orthogonal(row, direction):
        products = [a * b for a, b in zip(row, direction)]
        total = abs(sum(products))
        return total == 0 or not total.is_Rational and total < SMALL * max(map(abs, products))

    def shown(self, point):
        moving = [*self.plant.x, *self.plant.y, *self.plant.u, *self.plant.w, *sorted(self.parameters, key=str)]
        return ", ".join(f"{symbol} = {sp.N(point[symbol], 8)!s}" for symbol in moving if symbol in point)

    def prove(self):
        for claim in (self.cascade, self.left_inverse, self.regression, self.identifiability, self.trajectories):
            try:
                claim()
            except ValueError as error:
                self.say(claim.__name__.replace("_", " "), "undecided", f": {error}")
        return self.worst


if __name__ == "__main__":
    verdict = Certificate(PLANT, DERIVED).prove()
    print(["every claim is proved", "not every claim was decided", "A CLAIM IS FALSE"][verdict])
    sys.exit([0, 2, 1][verdict])

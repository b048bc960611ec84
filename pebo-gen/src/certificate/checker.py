
import random
import re
import sys
from decimal import Decimal
from fractions import Fraction

import sympy as sp
from mpmath.libmp import NoConvergence

# ---------------------------------------------------------------------------------------------------------------------
# Formulas: the grammar of a model file is that of Python but for `^`, and its numbers are exact.

TOKEN = re.compile(r"(?P<number>(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?)|(?P<name>[^\W\d]\w*)|(?P<power>\^)|(?P<other>\S)|\s+")
FUNCTIONS = {
    name: getattr(sp, name)
    for name in (
        "sin cos tan asin acos atan atan2 sinh cosh tanh asinh acosh atanh exp log sqrt sign".split()
    )
}
FUNCTIONS |= {"abs": sp.Abs, "min": sp.Min, "max": sp.Max, "sat": lambda a: sp.Min(sp.Max(a, -1), 1)}

# Of the values at which a rank is looked at.
DIGITS = 160

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
            code.append(f"FUNCTIONS['{piece}']" if called else f"NAMES['{piece}']")
        else:
            code.append("**" if kind == "power" else piece)
    return sp.sympify(eval("".join(code), {"number": number, "FUNCTIONS": FUNCTIONS, "NAMES": NAMES}))


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
            for left, relation, right in re.findall(r"(?=([^<>!=]+)(<=|>=|<|>)([^<>!=]+))", text):
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
        for name, text in stated.get("define", {}).items():
            NAMES[name] = formula(text)
        self.x, self.y, self.u, self.w = ([NAMES[name] for name in stated.get(key, [])] for key in ("x", "y", "u", "w"))
        self.assumed = [pair for text in stated.get("assume", []) for pair in relations(text)]
        self.assumed += [pair for text in derived.get("conditions", []) for pair in relations(text)]
        self.identities = formulas(stated.get("identities", []))
        self.angles = {NAMES[name]: formula(period) for name, period in stated.get("angles", {}).items()}
        # An output that is given by its value is that value.
        self.given = {NAMES[name]: formula(value) for name, value in stated.get("g_y", {}).items()}
        self.rates = {NAMES[n]: formula(rate) for key in ("f_x", "f_y") for n, rate in stated.get(key, {}).items()}
        for key, expand in (("lti", linear), ("mechanical", mechanical), ("electromechanical", electromechanical)):
            if key in stated:
                self.rates |= expand(self, stated[key])
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
        expr = expr.replace(lambda e: isinstance(e, sp.tan), lambda e: sp.sin(e.args[0]) / sp.cos(e.args[0]))
        converted.append(convert(sp.expand_log(sp.expand_power_exp(sp.expand_trig(expr)))))
    return converted, relations


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
    return numerator == 0 or (not identities and sp.simplify(expr) == 0)


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
            if self.onto_identities(point) and all(self.holds(*pair, point) for pair in self.plant.assumed):
                return point
        return None

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

    def say(self, claim, verdict, detail=""):
        self.worst = max(self.worst, {"proved": 0, "FALSE": 2, "undecided": 1}[verdict])
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
        found = self.points.refutes(expr)
        if found:
            point = ", ".join(f"{symbol} = {value!s}" for symbol, value in found[0].items())
            return self.say(claim, "FALSE", f": the difference is {found[1]!s} at {point}")
        return self.say(claim, "undecided", f": {sp.sstr(expr)[:200]}")

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
        """The regressor has full column rank at a point; if it takes excitation, with its derivatives along the plant; if it
        bends, at points of several parts of the domain together."""
        plant, kind = self.plant, self.derived["identifiability"]
        regressor = self.sides("phi")[1]
        if "primitive_1" in self.derived:
            regressor = sp.Matrix.vstack(regressor, self.sides("primitive")[1])
        width = regressor.cols
        shown = self.derived.get("determinant of phi_1' phi_1")
        # Psi can be inverted at all times, and is left out of what is asked of ranks.
        at_start = dict(zip(flat(self.psi), sp.eye(len(self.phi)))) if self.psi else {}
        if shown and width <= 3 and "primitive_1" not in self.derived:
            start = regressor.subs(at_start)
            self.vanishes("the determinant of phi_1' phi_1", (start.T * start).det() - formula(shown))
        rows, moved = [regressor], regressor
        rates = dict(zip(self.xi, self.Lambda * sp.Matrix(self.xi) + sp.Matrix(self.h)))
        if self.psi:
            rates |= dict(zip(flat(self.psi), self.Lambda * self.Psi))
        for order in range(width - 1 if kind == "excitation" else 0):
            for signal in [*plant.y, *plant.u, *plant.w]:
                # Inputs, and outputs whose rate is not given, may move in any way.
                last = signal if order == 0 else sp.Symbol(f"{signal}^({order})", real=True)
                if order > 0 or signal not in plant.rates:
                    rates.setdefault(last, sp.Symbol(f"{signal}^({order + 1})", real=True))
            moved = moved.applyfunc(lambda entry: plant.along(entry, rates))
            rows.append(moved)
        stacked = sp.Matrix.vstack(*rows).subs(plant.given).subs(at_start)
        for _ in range(12):
            points = [self.points.point(stacked.free_symbols) for _ in range(6 if kind == "parts" else 1)]
            if None in points:
                return self.say(f"identifiability: {kind}", "undecided", ": no point was met at which the assumptions hold")
            values = sp.Matrix.vstack(*(stacked.subs(point).evalf(DIGITS) for point in points))
            if all(value.is_number and value.is_finite for value in values):
                # Columns and then rows of the length one: an unknown may enter with a factor such as exp(-8750/T).
                for _ in range(2):
                    lines = [line / line.norm() for line in map(values.col, range(values.cols)) if line.norm() != 0]
                    values = sp.Matrix.hstack(*lines).T if len(lines) > 0 else sp.zeros(0, 0)
                # The square of the product of singular values: rounding leaves less of a rank that is not full.
                product = values.T * values if values.rows >= values.cols else sp.zeros(1, 1)
                if values.cols == width and abs(product.det()) > sp.Float(10, DIGITS) ** (-DIGITS // 2):
                    return self.say(f"identifiability: {kind}", "proved")
        return self.say(f"identifiability: {kind}", "FALSE", ": the regressor has no full rank at twelve points")

    def prove(self):
        for claim in (self.cascade, self.left_inverse, self.regression, self.identifiability):
            try:
                claim()
            except ValueError as error:
                self.say(claim.__name__.replace("_", " "), "undecided", f": {error}")
        return self.worst


if __name__ == "__main__":
    verdict = Certificate(PLANT, DERIVED).prove()
    print(["every claim is proved", "not every claim was decided", "A CLAIM IS FALSE"][verdict])
    sys.exit([0, 2, 1][verdict])

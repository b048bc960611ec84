"""SymEngine: it expands; what makes that a proof (common denominators, kernels) is done by the recipes below."""
import symengine as se

import formulas
import protocol

FUNCTIONS = {name: getattr(se, name) for name in "sin cos tan exp log sqrt pi Integer".split()}


def _numerator(expr):
    return se.expand(expr.as_numer_denom()[0])


def _exponentials(expr):
    """Sines and cosines by exponentials, whose products SymEngine merges."""
    values = {}
    for function in expr.atoms(se.sin, se.cos):
        power = se.exp(se.expand(se.I * function.args[0]))
        if isinstance(function, se.sin):
            values[function] = (power - 1 / power) / (2 * se.I)
        else:
            values[function] = (power + 1 / power) / 2
    return expr.xreplace(values)


def _half_angles(expr):
    """Sines and cosines of integer sums by the tangents of half of every angle."""
    tangents = {}

    def rational(argument):
        """The cosine and sine of a sum, by the addition formulas."""
        cosine, sine = se.Integer(1), se.Integer(0)
        for angle, times in se.expand(argument).as_coefficients_dict().items():
            t = tangents.setdefault(angle, se.Dummy())
            c, s = (1 - t**2) / (1 + t**2), 2 * t / (1 + t**2)
            for _ in range(abs(int(times))):
                step = s if times > 0 else -s
                cosine, sine = cosine * c - sine * step, sine * c + cosine * step
        return cosine, sine

    values = {f: rational(f.args[0])[isinstance(f, se.sin)] for f in expr.atoms(se.sin, se.cos)}
    return expr.xreplace(values)


# Each turns an expression that is zero into 0, if it can.
RECIPES = {
    "expand": se.expand,
    "numerator": _numerator,
    "exp": lambda e: se.expand(_exponentials(e)),
    "exp numerator": lambda e: _numerator(_exponentials(e)),
    "half angles": lambda e: _numerator(_half_angles(e)),
    "by hand": _numerator,
}


def proof(job, recipe, part):
    if recipe == "by hand":
        job = protocol.by_hand(job)
    derived = formulas.residuals(job, lambda name, _: se.Symbol(name), FUNCTIONS)
    found = derived() if part == "proof" else None

    def work():
        residuals = derived() if found is None else found
        answer = all(RECIPES[recipe](expr) == 0 for expr in residuals)
        return lambda: protocol.proved(answer)

    return work


def _poly(symbols, terms):
    return se.Add(*(c * se.Mul(*(x**e for x, e in zip(symbols, exponents))) for c, exponents in terms))


def product(job, *_how):
    symbols = [se.Symbol(f"x{i}") for i in range(job["variables"])]
    if "base" in job:
        a = se.expand(_poly(symbols, job["base"]) ** job["power"])
        b = a + 1
    else:
        a, b = _poly(symbols, job["a"]), _poly(symbols, job["b"])
    ones = {x: se.Integer(1) for x in symbols}

    def work():
        found = se.expand(a * b)
        return lambda: protocol.right(len(found.args) == job["terms"] and str(found.xreplace(ones)) == job["sum"])

    return work


def gcd(*_how):
    raise protocol.Failed("-")


# Jobs that it does not answer.
JOBS = {"zero": proof, "product": product, "gcd": gcd, "power": gcd, "square_free": gcd}
protocol.serve(lambda job, *how: JOBS[job["kind"]](job, *how))

"""SymPy: proofs by the recipes below, polynomials by its sparse rings."""
import sympy as sp
from sympy.core.cache import clear_cache
from sympy.polys.rings import ring

import formulas
import protocol

FUNCTIONS = {name: getattr(sp, name) for name in "sin cos tan exp log sqrt pi Integer".split()}


def _numerator(expr):
    return sp.fraction(sp.together(expr))[0]


def _field(expr):
    return sp.fraction(sp.cancel(expr))[0]


# Each turns an expression that is zero into 0, if it can.
RECIPES = {
    "expand": sp.expand,
    "simplify": sp.simplify,
    "trigsimp": lambda e: sp.trigsimp(_numerator(e)),
    "expand_trig": lambda e: sp.trigsimp(sp.expand(sp.expand_trig(_numerator(e)))),
    "exp": lambda e: sp.expand(_numerator(e.rewrite(sp.exp)), deep=True),
    "half angles": lambda e: sp.expand(_numerator(_half_angles(e))),
    "by hand": _field,
}


def _half_angles(expr):
    """Sines and cosines of sums by the tangents of half of every angle."""
    expr = sp.expand_trig(expr)
    angles = {f.args[0] for f in expr.atoms(sp.sin, sp.cos)}
    values = {}
    for angle in angles:
        t = sp.Dummy("t")
        values[sp.sin(angle)], values[sp.cos(angle)] = 2 * t / (1 + t**2), (1 - t**2) / (1 + t**2)
    return expr.xreplace(values)


def _symbol(name, positive):
    return sp.Symbol(name, positive=True) if positive else sp.Symbol(name, real=True)


def proof(job, recipe, part):
    if recipe == "by hand":
        job = protocol.by_hand(job)
    derived = formulas.residuals(job, _symbol, FUNCTIONS)
    found = derived() if part == "proof" else None
    clear_cache()  # or the second proof of a thing is a look-up

    def work():
        residuals = derived() if found is None else found
        answer = all(RECIPES[recipe](expr) == 0 for expr in residuals)
        return lambda: protocol.proved(answer)

    return work


def _poly(names, terms):
    return names.from_dict({tuple(exponents): coefficient for coefficient, exponents in terms})


def product(job, *_how):
    names = ring([f"x{i}" for i in range(job["variables"])], sp.ZZ, order=sp.lex)[0]
    if "base" in job:
        a = _poly(names, job["base"]) ** job["power"]
        b = a + 1
    else:
        a, b = _poly(names, job["a"]), _poly(names, job["b"])

    def work():
        found = a * b
        return lambda: protocol.right(len(found) == job["terms"] and str(sum(found.values())) == job["sum"])

    return work


def gcd(job, *_how):
    names = ring([f"x{i}" for i in range(job["variables"])], sp.ZZ, order=sp.lex)[0]
    a, b, known = (_poly(names, job[key]) for key in ("a", "b", "gcd"))

    def work():
        found = a.gcd(b)
        return lambda: protocol.right(found in (known, -known))

    return work


def power(job, *_how):
    names = ring([f"x{i}" for i in range(job["variables"])], sp.ZZ, order=sp.lex)[0]
    a = _poly(names, job["a"])

    def work():
        found = a ** job["power"]
        return lambda: protocol.right(len(found) == job["terms"] and str(sum(found.values())) == job["sum"])

    return work


def square_free(job, *_how):
    names = ring([f"x{i}" for i in range(job["variables"])], sp.ZZ, order=sp.lex)[0]
    a, parts = _poly(names, job["a"]), [_poly(names, part) for part in job["parts"]]

    def work():
        found = a.sqf_list()[1]
        known = [(part, times) for times, part in enumerate(parts, 1)]
        return lambda: protocol.right(len(found) == len(known) and all(
            any(times == own and part in (other, -other) for other, own in known) for part, times in found))

    return work


JOBS = {"zero": proof, "product": product, "gcd": gcd, "power": power, "square_free": square_free}
protocol.serve(lambda job, *how: JOBS[job["kind"]](job, *how))

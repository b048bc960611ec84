"""The cascade of a model of `models.py`, by a rival, as a whole process: exit status 0 if it is decided that there is one.

    python family_rival.py FLINT lti.yaml
    python family_rival.py SymPy cuk.yaml

FLINT solves `A11 + T2 A21 = 0` of a linear plant over the rationals. SymPy expands the rates of phi and asks whether their
slopes along the states are free of the states (0 for a plain cascade, else a generalised one with phi = x).
"""
import sys
from fractions import Fraction

import yaml


def flint_solves(model):
    import flint

    def matrix(rows):
        entries = [[Fraction(str(entry)) for entry in row] for row in rows]
        return flint.fmpq_mat([[flint.fmpq(e.numerator, e.denominator) for e in row] for row in entries])

    a11, a21 = (matrix(model["lti"][name]) for name in ("A11", "A21"))
    t2 = a21.transpose().solve(-a11.transpose()).transpose()
    return a11 + t2 * a21 == flint.fmpq_mat(a11.nrows(), a11.ncols())


def sympy_decides(model):
    import sympy

    names = [*model["x"], *model["y"], *model.get("u", []), *model.get("parameters", [])]
    symbols = {name: sympy.Symbol(name) for name in names}

    def read(formula):
        return sympy.sympify(str(formula).replace("^", "**"), locals=symbols)

    x = [symbols[name] for name in model["x"]]
    rates = {symbols[name]: read(rate) for key in ("f_x", "f_y") for name, rate in model[key].items()}
    phi = [read(component) for component in model["phi"]]
    cascade = [sympy.expand(sum(sympy.diff(p, s) * rate for s, rate in rates.items())) for p in phi]
    slopes = [sympy.expand(sympy.diff(rate, state)) for rate in cascade for state in x]
    return all(slope.free_symbols.isdisjoint(x) for slope in slopes)


rival, path = sys.argv[1:]
with open(path, encoding="utf-8") as file:
    read_model = yaml.load(file, yaml.BaseLoader)
sys.exit(0 if {"FLINT": flint_solves, "SymPy": sympy_decides}[rival](read_model) else 1)

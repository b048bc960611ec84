"""The jobs: what is to be proved or computed, in a form that every system reads (JSON), and what must come out."""
import json
from pathlib import Path

import models

from . import chain, identities, polynomials

# The right sides of the cascades of the model files, from the papers.
CASCADES = {
    "Cuk, case I": ("models/cuk.yaml", ["(E - (1 - d)*v2)/L1", "-(d*v2 + v4)/L3"]),
    "Cuk, case II": ("models/cuk_case2.yaml", ["(E - (1 - d)*v2)/L1", "(i3 + G*d*v2)/C4"]),
    "PMSM": ("tests/models/pmsm.yaml", ["v1 - R*i1", "v2 - R*i2"]),
    "cart-pendulum": ("tests/bench/models/cart_pendulum.yaml", ["(a*c*sin(q1) - b*u*cos(q1))/sqrt(c*s)", "u/sqrt(c)"]),
    "two-link arm": ("tests/bench/models/two_link_arm.yaml", ["t1 - g1*cos(q1) - g2*cos(q1 + q2)"]),
}

# The input of a person for a system that knows no relation of kernels: the sine, the cosine and the roots as states
# of their own (k^2 = c, r^2 = s for the cart), and a rational parametrisation of what relates them at the end.
CIRCLE = [["S", "2*T/(1 + T^2)"], ["C", "(1 - T^2)/(1 + T^2)"]]
BY_HAND = {
    "cart-pendulum": {
        "symbols": "a b c p1 p2 u S C T k r".split(),
        "define": [["qd", "(c*p1 - b*C*p2)/r^2"]],
        "rates": {"p1": "a*S - b*S*qd*(p2 - b*C*p1)/r^2", "p2": "u", "S": "C*qd", "C": "-S*qd", "r": "b^2*C*S*qd/r"},
        "claims": [["(c*p1 - b*C*p2)/(k*r)", "(a*c*S - b*u*C)/(k*r)"], ["p2/k", "u/k"]],
        "replace": [["c", "r^2 + b^2*C^2"], *CIRCLE],
    },
    "two-link arm": {
        "symbols": "a1 a2 a3 g1 g2 v1 v2 t1 t2 S C T C1 C12".split(),
        "define": [
            ["M11", "a1 + a2 + 2*a3*C"], ["M12", "a2 + a3*C"], ["D", "a1*a2 - a3^2 + a3^2*S^2"],
            ["r1", "t1 + a3*S*(2*v1*v2 + v2^2) - g1*C1 - g2*C12"], ["r2", "t2 - a3*S*v1^2 - g2*C12"],
        ],
        "rates": {"v1": "(a2*r1 - M12*r2)/D", "v2": "(M11*r2 - M12*r1)/D", "S": "C*v2", "C": "-S*v2"},
        "claims": [["M11*v1 + M12*v2", "t1 - g1*C1 - g2*C12"]],
        "replace": CIRCLE,
    },
}


def cascade(model, sides):
    """A model as it is read from its file, and the known rates of its transform."""
    parameters = model.get("parameters") or []
    assume = []
    for fact in model.get("assume", []):
        # `a < b < c` and `a > b` as differences that are positive.
        parts = fact.replace(">", "<").split("<")
        ordered = [part.strip() for part in (parts if "<" in fact else parts[::-1])]
        assume += [high if low == "0" else f"{high} - ({low})" for low, high in zip(ordered, ordered[1:])]
    return {
        "kind": "zero",
        "symbols": [*parameters, *model["x"], *model["y"], *model.get("u", []), *model.get("w", [])],
        "define": [[name, str(text)] for name, text in (model.get("define") or {}).items()],
        "rates": {name: str(text) for part in ("f_x", "f_y") for name, text in (model.get(part) or {}).items()},
        "assume": assume,
        "claims": [list(pair) for pair in zip(map(str, model["phi"]), sides)],
    }


class Shelf:
    """Writes jobs into a directory and remembers where: a name for the JSON, and the model file if there is one."""

    def __init__(self, directory, root):
        self.directory, self.root = Path(directory), Path(root)
        self.directory.mkdir(parents=True, exist_ok=True)
        self.models = {}

    def _put(self, name, job):
        path = self.directory / f"{name.replace(' ', '_').replace(',', '').replace('(', '').replace(')', '')}.json"
        path.write_text(json.dumps(job), encoding="utf-8")
        return str(path)

    def model(self, name):
        import yaml  # here, so that the polynomial jobs run without it

        path, sides = CASCADES[name]
        self.models[name] = str(self.root / path)
        job = cascade(yaml.safe_load((self.root / path).read_text(encoding="utf-8")), sides)
        if name in BY_HAND:
            job["by_hand"] = {"kind": "zero", **BY_HAND[name]}
        return self._put(name, job)

    def chain(self, links):
        import yaml

        text = chain.model(links)
        path = self.directory / f"chain{links}.yaml"
        path.write_text(text, encoding="utf-8")
        name = f"chain of {links}"
        self.models[name] = str(path)
        return self._put(name, cascade(yaml.safe_load(text), chain.rates(links)))

    def rotations(self, count):
        return self._put(f"rotations {count}", {"kind": "zero", **identities.rotations(count)})

    def roots(self, count):
        return self._put(f"roots {count}", {"kind": "zero", **identities.roots(count)})

    def family(self, name, size):
        path = self.directory / f"{name}{size}.yaml"
        path.write_text(models.FAMILIES[name](size), encoding="utf-8")
        return str(path)

    def trinomial(self, power):
        return self._put(f"trinomial {power}", polynomials.trinomial_square(power))

    def product(self, variables, terms, largest):
        job = polynomials.sparse_product(1, variables, terms, largest)
        return self._put(f"product {variables} {terms} {largest}", job), job["terms"]

    def gcd(self, variables, terms, largest):
        return self._put(f"gcd {variables} {terms} {largest}", polynomials.gcd(2, variables, terms, largest))

    def power(self, variables, terms, largest, exponent):
        job = polynomials.power(3, variables, terms, largest, exponent)
        return self._put(f"power {variables} {terms} {largest} {exponent}", job)

    def square_free(self, variables, terms, largest):
        job = polynomials.square_free(4, variables, terms, largest)
        return self._put(f"square-free {variables} {terms} {largest}", job)

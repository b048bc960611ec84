"""Polynomial jobs: inputs as lists of [coefficient, exponents], with what is known of the result."""
import random


def trinomial_square(power):
    """p (1 + p) for p = (1 + x + y + z)^power; the power itself is not timed."""
    base = [[1, [0, 0, 0]], [1, [1, 0, 0]], [1, [0, 1, 0]], [1, [0, 0, 1]]]
    d = 2 * power
    terms = (d + 1) * (d + 2) * (d + 3) // 6
    return {"kind": "product", "variables": 3, "base": base, "power": power,
            "terms": terms, "sum": str(4**power * (1 + 4**power))}


def sparse_product(seed, variables, terms, largest):
    """The product of two random polynomials; coefficients are positive, so that no term can vanish."""
    source = random.Random(seed)
    a, b = (_random(source, variables, terms, largest, range(1, 100)) for _ in range(2))
    support = {tuple(map(int.__add__, p, q)) for p in a for q in b}
    return {"kind": "product", "variables": variables, "a": _listed(a), "b": _listed(b),
            "terms": len(support), "sum": str(sum(a.values()) * sum(b.values()))}


def gcd(seed, variables, terms, largest):
    """Two products with a common factor; that the cofactors are coprime every system confirms."""
    source = random.Random(seed)
    common, a, b = (_random(source, variables, terms, largest, [*range(-99, 0), *range(1, 100)]) for _ in range(3))
    return {"kind": "gcd", "variables": variables, "a": _listed(_product(a, common)),
            "b": _listed(_product(b, common)), "gcd": _listed(common)}


def _random(source, variables, terms, largest, coefficients):
    # A constant term, so that no variable divides it; one coefficient 1, so that the content is 1.
    poly = {(0,) * variables: 1}
    while len(poly) < terms:
        poly[tuple(source.randint(0, largest) for _ in range(variables))] = source.choice(coefficients)
    return poly


def _product(a, b):
    product = {}
    for p, c in a.items():
        for q, d in b.items():
            key = tuple(map(int.__add__, p, q))
            product[key] = product.get(key, 0) + c * d
    return {key: value for key, value in product.items() if value}


def _listed(poly):
    return [[coefficient, list(exponents)] for exponents, coefficient in sorted(poly.items(), reverse=True)]

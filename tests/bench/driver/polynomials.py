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


def power(seed, variables, terms, largest, exponent):
    """A power of a random polynomial with positive coefficients; in one variable without gaps, so that its terms are known."""
    source = random.Random(seed)
    if variables == 1:
        base = {(place,): source.randint(1, 99) for place in range(terms)}
        count = exponent * (terms - 1) + 1
    else:
        base = _random(source, variables, terms, largest, range(1, 100))
        support = {(0,) * variables}
        for _ in range(exponent):
            support = {tuple(map(int.__add__, p, q)) for p in support for q in base}
        count = len(support)
    return {"kind": "power", "variables": variables, "a": _listed(base), "power": exponent,
            "terms": count, "sum": str(sum(base.values()) ** exponent)}


def square_free(seed, variables, terms, largest):
    """a b^2 c^3 for random polynomials; that they are square-free and coprime every system confirms."""
    source = random.Random(seed)
    parts = [_random(source, variables, terms, largest, [*range(-99, 0), *range(1, 100)]) for _ in range(3)]
    product = {(0,) * variables: 1}
    for times, part in enumerate(parts, 1):
        for _ in range(times):
            product = _product(product, part)
    return {"kind": "square_free", "variables": variables, "a": _listed(product),
            "parts": [_listed(part) for part in parts]}


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

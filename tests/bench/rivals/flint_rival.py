"""python-flint: the sparse polynomials of FLINT over the integers."""
import flint

import protocol


def _context(count):
    return flint.fmpz_mpoly_ctx.get([f"x{i}" for i in range(count)], flint.Ordering.lex)


def _poly(context, terms):
    return context.from_dict({tuple(exponents): coefficient for coefficient, exponents in terms})


def proof(*_how):
    raise protocol.Failed("-")


def product(job, *_how):
    context = _context(job["variables"])
    if "base" in job:
        a = _poly(context, job["base"]) ** job["power"]
        b = a + 1
    else:
        a, b = _poly(context, job["a"]), _poly(context, job["b"])

    def work():
        found = a * b
        return lambda: protocol.right(len(found) == job["terms"] and str(sum(found.coeffs())) == job["sum"])

    return work


def gcd(job, *_how):
    context = _context(job["variables"])
    a, b, known = (_poly(context, job[key]) for key in ("a", "b", "gcd"))

    def work():
        found = a.gcd(b)
        return lambda: protocol.right(found in (known, -known))

    return work


protocol.serve(lambda job, *how: {"zero": proof, "product": product, "gcd": gcd}[job["kind"]](job, *how))

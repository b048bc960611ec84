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


def power(job, *_how):
    context = _context(job["variables"])
    a = _poly(context, job["a"])

    def work():
        found = a ** job["power"]
        return lambda: protocol.right(len(found) == job["terms"] and str(sum(found.coeffs())) == job["sum"])

    return work


def square_free(job, *_how):
    context = _context(job["variables"])
    a, parts = _poly(context, job["a"]), [_poly(context, part) for part in job["parts"]]

    def work():
        found = a.factor_squarefree()[1]
        known = [(part, times) for times, part in enumerate(parts, 1)]
        return lambda: protocol.right(len(found) == len(known) and all(
            any(times == own and part in (other, -other) for other, own in known) for part, times in found))

    return work


JOBS = {"zero": proof, "product": product, "gcd": gcd, "power": power, "square_free": square_free}
protocol.serve(lambda job, *how: JOBS[job["kind"]](job, *how))

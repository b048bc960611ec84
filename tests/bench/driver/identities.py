"""Identities that are not cascades: rotations in four dimensions, sums of roots."""

PLANES = [(0, 1), (0, 2), (0, 3), (1, 2), (1, 3), (2, 3)]
SIZE = range(4)


def rotations(count):
    """det of the product of `count` planar rotations of R^4 (each in the next plane, by its own angle) is 1."""
    define = []
    product = [["1" if r == c else "0" for c in SIZE] for r in SIZE]
    for k in range(count):
        i, j = PLANES[k % len(PLANES)]
        sine, cosine = f"sin(a{k})", f"cos(a{k})"
        for row in SIZE:
            left, right = product[row][i], product[row][j]
            product[row][i] = _named(define, f"R{k}_{row}{i}", _sum((left, cosine), (right, sine)))
            product[row][j] = _named(define, f"R{k}_{row}{j}", _sum((left, f"(-{sine})"), (right, cosine)))
    determinant = _determinant(product, list(SIZE), list(SIZE))
    return {"symbols": [f"a{k}" for k in range(count)], "define": define, "zero": [f"{determinant} - 1"]}


def roots(count):
    """1/(s + r) + 1/(s - r) = 2 s/(s^2 - r^2) where s is a sum of square roots and r one more."""
    symbols = [f"p{k}" for k in range(count)]
    *summands, last = [f"sqrt({name})" for name in symbols]
    total = "(" + " + ".join(summands) + ")"
    zero = f"1/({total} + {last}) + 1/({total} - {last}) - 2*{total}/({total}^2 - {symbols[-1]})"
    return {"symbols": symbols, "define": [], "assume": symbols, "zero": [zero]}


def _named(define, name, text):
    """A number stays; anything else is defined once, so that no formula is repeated."""
    if text in ("0", "1"):
        return text
    define.append([name, text])
    return name


def _sum(*products):
    kept = [b if a == "1" else f"{a}*{b}" for a, b in products if a != "0"]
    return " + ".join(kept) or "0"


def _determinant(matrix, rows, columns):
    """By cofactors along the first row."""
    if len(rows) == 1:
        return matrix[rows[0]][columns[0]]
    parts = []
    for position, column in enumerate(columns):
        entry = matrix[rows[0]][column]
        if entry != "0":
            minor = _determinant(matrix, rows[1:], columns[:position] + columns[position + 1:])
            parts.append(f"{'-' if position % 2 else '+'} {entry}*({minor})")
    return "0 " + " ".join(parts) if parts else "0"

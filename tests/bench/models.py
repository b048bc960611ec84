"""Models that grow: the text of a model file for a family and a size, on the standard output.

    python3 tests/bench/models.py cuk 4 > cuk4.yaml

Every family keeps its structure as it grows, so that the time of `pebo-gen check` over n shows the growth of the algebra and not of
another question. Decimals are drawn from a fixed seed.
"""

import random
import sys


def cuk(n):
    """n Cuk converters in a row, each one fed by the one before."""
    stages = range(1, n + 1)
    parts = [f"{part}_{k}" for k in stages for part in ("L1", "C2", "L3", "C4")] + [f"G{k}" for k in stages]
    f_x = {}
    f_y = {}
    for k in stages:
        # The output voltage is negative, and what the next stage draws flows into its node.
        source, drawn = ("E" if k == 1 else f"-v4_{k - 1}"), (f" + i1_{k + 1}" if k < n else "")
        f_x[f"i1_{k}"] = f"({source} - (1 - d{k})*v2_{k})/L1_{k}"
        f_x[f"i3_{k}"] = f"-(d{k}*v2_{k} + v4_{k})/L3_{k}"
        f_y[f"v2_{k}"] = f"((1 - d{k})*i1_{k} + d{k}*i3_{k})/C2_{k}"
        f_y[f"v4_{k}"] = f"(i3_{k} - G{k}*v4_{k}{drawn})/C4_{k}"
    return _model(
        f"cuk{n}",
        parameters=_list(parts + ["E"]),
        x=_list(f_x),
        y=_list(f_y),
        u=_list(f"d{k}" for k in stages),
        assume=_list([f"{part} > 0" for part in parts] + [f"0 < d{k} < 1" for k in stages]),
        f_x=_map(f_x),
        f_y=_map(f_y),
        phi=_list(f_x),
    )


def lti(n):
    """A linear plant with n unmeasured states, as many measured ones, and decimals for entries."""
    draw = random.Random(n)

    def block(width):
        return _list(_list(f"{draw.randint(-999, 999) / 100}" for _ in range(width)) for _ in range(n))

    blocks = {name: block(n) for name in ("A11", "A12", "A21", "A22")} | {name: block(1) for name in ("B1", "B2")}
    x, y = ([f"{letter}{i}" for i in range(1, n + 1)] for letter in "xy")
    return _model(f"lti{n}", x=_list(x), y=_list(y), u="[u]", lti=_map(blocks))


def symbolic(n):
    """A linear plant with n unmeasured states and as many measured ones, in symbols."""
    indices = range(1, n + 1)
    blocks = {name: [[f"{letter}{i}{j}" for j in indices] for i in indices] for name, letter in (("A11", "a"), ("A21", "c"))}
    parameters = [entry for rows in blocks.values() for row in rows for entry in row]
    x, y = ([f"{letter}{i}" for i in indices] for letter in "xy")
    matrices = {name: _list(map(_list, rows)) for name, rows in blocks.items()}
    return _model(f"symbolic{n}", parameters=_list(parameters), x=_list(x), y=_list(y), lti=_map(matrices))


def arm(n):
    """A planar arm of n links with masses at the joints, relative angles: the momentum of the base alone is of use."""
    joints = range(1, n + 1)

    def inertia(i, j):
        # Between links a and b stand the angles a + 1 to b; link a moves what is at its end and beyond.
        terms = []
        for a in range(i, n + 1):
            for b in range(j, n + 1):
                low, high = sorted((a, b))
                angle = " + ".join(f"q{k}" for k in range(low + 1, high + 1))
                terms.append(f"m{high}*l{a}*l{b}*cos({angle})" if angle else f"m{high}*l{a}^2")
        return " + ".join(terms)

    # m_k is the mass at the end of link k and all beyond it.
    parts = [f"{letter}{k}" for letter in "ml" for k in joints]
    matrix = {"M": _list(_list(inertia(i, j) for j in joints) for i in joints)}
    matrix |= {"T": _list(_list(str(int(i == j)) for j in joints) for i in joints)}
    matrix |= {"G": _list(_list(str(int(i == j)) for j in joints) for i in joints)}
    return _model(
        f"arm{n}",
        parameters=_list(parts),
        x=_list(f"p{k}" for k in joints),
        y=_list(f"q{k}" for k in joints),
        u=_list(f"t{k}" for k in joints),
        assume=_list(f"{part} > 0" for part in parts),
        mechanical=_map(matrix),
    )


def spatial(n):
    """An arm in space of n joints whose axes are turned by a right angle each, to one side and the other, as those of an
    industrial robot: masses at the ends of the links and rotors at the joints, momenta for the transform. The momentum of
    the base alone is of use.

    Joint k turns about the third axis of frame k - 1; M = sum of m_k J_k'J_k and the rotors, with J_k the Jacobian of the
    position of mass k from axes and levers.
    """
    joints, define = range(1, n + 1), {}

    def named(name, formula):
        """A formula under a name; zero and one as they are."""
        if formula in ("0", "1", "-1"):
            return formula
        define[name] = formula
        return name

    def total(*products):
        """The sum of products of factors."""
        kept = [[f"({factor})" for factor in product if factor != "1"] or ["1"] for product in products if "0" not in product]
        return " + ".join("*".join(product) for product in kept) or "0"

    axes, origins = [[list(axis) for axis in ("100", "010", "001")]], [["0"] * 3]
    for k in joints:
        x, y, z = axes[-1]
        turned = [named(f"x{k}_{i}", total((a, f"cos(q{k})"), (b, f"sin(q{k})"))) for i, (a, b) in enumerate(zip(x, y))]
        across = [named(f"y{k}_{i}", total(("-1", a, f"sin(q{k})"), (b, f"cos(q{k})"))) for i, (a, b) in enumerate(zip(x, y))]
        side = "1" if k % 2 else "-1"
        opposite = "-1" if k % 2 else "1"
        second = [total((side, entry)) for entry in z]
        third = [total((opposite, entry)) for entry in across]
        axes.append([turned, second, third])
        origins.append([named(f"p{k}_{i}", total((a,), (f"l{k}", b))) for i, (a, b) in enumerate(zip(origins[-1], turned))])

    def column(i, k):
        """How mass k moves with joint i: axis times lever."""
        axis = axes[i - 1][2]
        lever = [total((a,), ("-1", b)) for a, b in zip(origins[k], origins[i - 1])]
        cross = [(1, 2), (2, 0), (0, 1)]
        return [named(f"J{i}_{k}_{c}", total((axis[a], lever[b]), ("-1", axis[b], lever[a]))) for c, (a, b) in enumerate(cross)]

    columns = {(i, k): column(i, k) for k in joints for i in range(1, k + 1)}

    def inertia(i, j):
        moved = range(max(i, j), n + 1)
        products = [(f"m{k}", a, b) for k in moved for a, b in zip(columns[i, k], columns[j, k])]
        return total(*products, *[(f"I{i}",)] * (i == j))

    parts = [f"{letter}{k}" for letter in "mlI" for k in joints]
    unit = _list(_list(str(int(i == j)) for j in joints) for i in joints)
    matrix = {"M": _list(_list(inertia(min(i, j), max(i, j)) for j in joints) for i in joints), "T": unit, "G": unit}
    matrix |= {"V": total(*[(f"m{k}", "g", origins[k][2]) for k in joints])}
    return _model(
        f"spatial{n}",
        parameters=_list([*parts, "g"]),
        x=_list(f"p{k}" for k in joints),
        y=_list(f"q{k}" for k in joints),
        u=_list(f"t{k}" for k in joints),
        assume=_list(f"{part} > 0" for part in parts),
        define=_map(define),
        mechanical=_map(matrix),
    )


def chain(n):
    """A planar chain of n links that moves point masses, one at the end of each second link; a last one without a partner is
    a rotor about its joint. Angles are relative to the link before.

    With J the Jacobian of the positions of the masses and of the rotor's angle, M = J'M_0 J and T is the inverse of J.
    """
    joints, pairs = range(1, n + 1), range(1, n // 2 + 1)
    define = {}
    for k in joints:
        angle = "+".join(f"y{i}" for i in range(1, k + 1))
        define |= {f"c{k}": f"l{k}*cos({angle})", f"s{k}": f"l{k}*sin({angle})"} if k <= 2 * len(pairs) else {}
    # X_i_k, Y_i_k: from joint i to mass k, along the vertical and across.
    for k in pairs:
        for i in range(2 * k, 0, -1):
            beyond = i < 2 * k
            define[f"X_{i}_{k}"] = f"s{i}" + f" + X_{i + 1}_{k}" * beyond
            define[f"Y_{i}_{k}"] = f"c{i}" + f" + Y_{i + 1}_{k}" * beyond
    # T = J^-1 by pairs of links: the rows of a pair undo what the pairs before it move its mass by.
    inverse = {(i, j): "0" for i in joints for j in joints}
    for k in pairs:
        a, b = 2 * k - 1, 2 * k
        define[f"d{k}"] = f"l{a}*l{b}*sin(y{b})"
        define |= {f"T_{a}_{a}": f"Y_{b}_{k}/d{k}", f"T_{a}_{b}": f"X_{b}_{k}/d{k}"}
        define |= {f"T_{b}_{a}": f"-Y_{a}_{k}/d{k}", f"T_{b}_{b}": f"-X_{a}_{k}/d{k}"}
        inverse |= {(i, j): f"T_{i}_{j}" for i in (a, b) for j in (a, b)}
        for j in range(1, a):
            moved = [i for i in range(1, a) if inverse[i, j] != "0"]
            define[f"R_{a}_{j}"] = " + ".join(f"(-X_{i}_{k})*{inverse[i, j]}" for i in moved)
            define[f"R_{b}_{j}"] = " + ".join(f"Y_{i}_{k}*{inverse[i, j]}" for i in moved)
            for i in (a, b):
                define[f"T_{i}_{j}"] = f"-T_{i}_{a}*R_{a}_{j} - T_{i}_{b}*R_{b}_{j}"
                inverse[i, j] = f"T_{i}_{j}"
    if n % 2:
        for j in range(1, n):
            define[f"T_{n}_{j}"] = "-(" + " + ".join(inverse[i, j] for i in range(1, n) if inverse[i, j] != "0") + ")"
            inverse[n, j] = f"T_{n}_{j}"
        inverse[n, n] = "1"

    def inertia(i, j):
        moving = [k for k in pairs if max(i, j) <= 2 * k]
        return " + ".join([f"m{k}*(X_{i}_{k}*X_{j}_{k} + Y_{i}_{k}*Y_{j}_{k})" for k in moving] + ["I"] * (n % 2))

    parts = [f"m{k}" for k in pairs] + [f"l{k}" for k in range(1, 2 * len(pairs) + 1)] + ["I"] * (n % 2)
    matrix = {"M": _list(_list(inertia(i, j) for j in joints) for i in joints)}
    matrix |= {"V": " + ".join(f"m{k}*g*X_1_{k}" for k in pairs)}
    matrix |= {"G": _list(_list(str(int(i == j)) for j in joints) for i in joints)}
    matrix |= {"T": _list(_list(inverse[i, j] for j in joints) for i in joints)}
    return _model(
        f"chain{n}",
        parameters=_list(parts + ["g"]),
        x=_list(f"x{k}" for k in joints),
        y=_list(f"y{k}" for k in joints),
        u=_list(f"u{k}" for k in joints),
        assume=_list([f"{part} > 0" for part in parts] + [f"sin(y{2 * k}) > 0" for k in pairs]),
        define=_map(define),
        mechanical=_map(matrix),
    )


def phases(n):
    """A boost converter of n interleaved phases with losses in the coils, the output voltage measured."""
    coils = range(1, n + 1)
    parts = [f"{letter}{k}" for k in coils for letter in "LR"] + ["C", "G"]
    flowing = " + ".join(f"(1 - d{k})*i{k}" for k in coils)
    return _model(
        f"phases{n}",
        parameters=_list(parts + ["E"]),
        x=_list(f"i{k}" for k in coils),
        y="[v]",
        u=_list(f"d{k}" for k in coils),
        assume=_list([f"{part} > 0" for part in parts] + [f"0 < d{k} < 1" for k in coils]),
        f_x=_map({f"i{k}": f"(E - R{k}*i{k} - (1 - d{k})*v)/L{k}" for k in coils}),
        f_y=_map({"v": f"({flowing} - G*v)/C"}),
        phi=_list(f"i{k}" for k in coils),
    )


def compartments(n):
    """A chain of n compartments with linear flows both ways and losses, the last one measured."""
    rates = {}
    for k in range(1, n + 1):
        flows = ["u"] * (k == 1) + [f"-e{k}*c{k}"]
        flows += [f"f{k - 1}*c{k - 1} - b{k - 1}*c{k}"] * (k > 1) + [f"b{k}*c{k + 1} - f{k}*c{k}"] * (k < n)
        rates[f"c{k}"] = " + ".join(flows)
    last = {f"c{n}": rates.pop(f"c{n}")}
    parameters = [f"{letter}{k}" for letter in "fb" for k in range(1, n)] + [f"e{k}" for k in range(1, n + 1)]
    return _model(
        f"compartments{n}",
        parameters=_list(parameters),
        x=_list(rates),
        y=_list(last),
        u="[u]",
        assume=_list(f"{parameter} > 0" for parameter in parameters),
        f_x=_map(rates),
        f_y=_map(last),
        phi=_list(rates),
    )


def grid(n):
    """n machines on one net: swing equations with angles measured."""
    machines = range(1, n + 1)

    def line(i, j):
        return f"k{min(i, j)}_{max(i, j)}*sin(a{i} - a{j})"

    lines = [f"k{i}_{j}" for i in machines for j in range(i + 1, n + 1)]
    parts = [f"{letter}{i}" for letter in "MD" for i in machines]
    swing = {
        f"w{i}": f"(P{i} - D{i}*w{i} - {' - '.join(line(i, j) for j in machines if j != i)})/M{i}" for i in machines
    }
    return _model(
        f"grid{n}",
        parameters=_list(parts + lines),
        x=_list(swing),
        y=_list(f"a{i}" for i in machines),
        u=_list(f"P{i}" for i in machines),
        assume=_list(f"{part} > 0" for part in parts),
        f_x=_map(swing),
        f_y=_map({f"a{i}": f"w{i}" for i in machines}),
        phi=_list(f"w{i} + D{i}/M{i}*a{i}" for i in machines),
    )


def terms(n):
    """A sum of n terms in one rate."""
    total = " + ".join(f"a{k}*y^{1 + k % 5}" for k in range(1, n + 1))
    names = _list(f"a{k}" for k in range(1, n + 1))
    return _model(f"terms{n}", parameters=names, x="[x]", y="[y]", f_x=_map({"x": total}), f_y="{y: x}", phi="[x]")


FAMILIES = {family.__name__: family for family in (cuk, lti, symbolic, arm, spatial, chain, phases, compartments, grid, terms)}


def _model(name, **keys):
    return "".join(f"{key}: {value}\n" for key, value in {"model": name, **keys}.items())


def _list(items):
    return f"[{', '.join(items)}]"


def _map(items):
    return "".join(f"\n  {key}: {value}" for key, value in items.items())


if __name__ == "__main__":
    if len(sys.argv) != 3 or sys.argv[1] not in FAMILIES or not sys.argv[2].isdigit():
        sys.exit(f"models.py {'|'.join(FAMILIES)} SIZE")
    sys.stdout.write(FAMILIES[sys.argv[1]](int(sys.argv[2])))

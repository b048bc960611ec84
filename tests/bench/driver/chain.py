"""A planar chain of n links with point masses at their ends, as a model file.

The state W is the work that the joints have done. Its rate is written with the Christoffel symbols of the
inertia matrix (v'(M a + C v), M from the Jacobians), the kinetic energy with the closed form of M (cosines of
differences of absolute angles). That W less the energy is constant is v'(Mdot - 2 C)v = 0, the skew symmetry
of Mdot - 2 C, and needs the angle sums of all joints. An output that this difference drives makes W observable.
"""


def model(n):
    """The text of the model file."""
    joints = range(1, n + 1)
    angle = {a: "(" + " + ".join(f"q{i}" for i in range(1, a + 1)) + ")" for a in joints}

    def along(function, first, last):
        return "(" + " + ".join(f"l{a}*{function}({angle[a][1:-1]})" for a in range(first, last + 1)) + ")"

    define = {}
    for i in joints:
        for k in range(i, n + 1):
            # The velocity of mass k as joint i turns is (-X, Y).
            define[f"X{i}_{k}"], define[f"Y{i}_{k}"] = along("sin", i, k), along("cos", i, k)
    for i in joints:
        for j in range(i, n + 1):
            masses = range(j, n + 1)
            define[f"M{i}_{j}"] = " + ".join(f"m{k}*(X{i}_{k}*X{j}_{k} + Y{i}_{k}*Y{j}_{k})" for k in masses)
            for p in joints:
                define[f"M{i}_{j}_{p}"] = " + ".join(f"m{k}*({_slope(i, j, p, k)})" for k in masses if k >= p) or "0"

    def inertia(i, j):
        return f"M{min(i, j)}_{max(i, j)}"

    def christoffel(i, j, p):
        return f"({inertia(i, j)}_{p} + {inertia(i, p)}_{j} - {inertia(p, j)}_{i})/2"

    power = [f"v{i}*{inertia(i, j)}*a{j}" for i in joints for j in joints]
    power += [f"v{i}*{christoffel(i, j, p)}*v{p}*v{j}" for i in joints for j in joints for p in joints]
    energy = [f"m{k}*l{a}*l{b}*w{a}*w{b}*cos({_difference(a, b)})/2"
              for k in joints for a in range(1, k + 1) for b in range(1, k + 1)]
    for a in joints:
        define[f"w{a}"] = " + ".join(f"v{i}" for i in range(1, a + 1))
    define["power"], define["energy"] = " + ".join(power), " + ".join(energy)

    names = lambda letter: [f"{letter}{i}" for i in joints]
    lines = [f"model: chain{n}", f"parameters: [{', '.join(names('m') + names('l'))}]",
             f"x: [W, {', '.join(names('v'))}]", f"y: [s, {', '.join(names('q'))}]", f"u: [{', '.join(names('a'))}]",
             "define:", *(f"  {name}: {text}" for name, text in define.items()),
             "f_x:", "  W: power", *(f"  v{i}: a{i}" for i in joints),
             "f_y:", "  s: W - energy", *(f"  q{i}: v{i}" for i in joints),
             f"phi: [W - energy, {', '.join(names('v'))}]"]
    return "\n".join(lines) + "\n"


def rates(n):
    """The right side of the cascade."""
    return ["0"] + [f"a{i}" for i in range(1, n + 1)]


def _slope(i, j, p, k):
    """The derivative of X_i X_j + Y_i Y_j (to mass k) by angle p."""
    one, other = f"{max(i, p)}_{k}", f"{max(j, p)}_{k}"
    return f"Y{one}*X{j}_{k} + X{i}_{k}*Y{other} - X{one}*Y{j}_{k} - Y{i}_{k}*X{other}"


def _difference(a, b):
    low, high = sorted((a, b))
    return " + ".join(f"q{i}" for i in range(low + 1, high + 1)) or "0"

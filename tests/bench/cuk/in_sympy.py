"""The job of `pebo-gen check models/cuk.yaml` done with SymPy: the baseline of the time comparison.

Proves the cascade, the left inverse and the linear regression of the Cuk converter, case I, and the
generic column rank of its regressor. Exits with 1 if one of them fails.
"""
import sys

import sympy as sp

L1, C2, L3, C4, G, E = sp.symbols("L1 C2 L3 C4 G E", positive=True)
i1, i3, v2, v4, d = sp.symbols("i1 i3 v2 v4 d")
chi = sp.symbols("chi1 chi2")
theta = sp.symbols("theta1 theta2")
x, y = [i1, i3], [v2, v4]
f_x = [(E - (1 - d) * v2) / L1, -(d * v2 + v4) / L3]
f_y = [((1 - d) * i1 + d * i3) / C2, (i3 - G * v4) / C4]
phi = sp.Matrix([i1, i3])

h = sp.simplify(phi.jacobian(x) * sp.Matrix(f_x) + phi.jacobian(y) * sp.Matrix(f_y))
cascade = not (h.free_symbols & set(x))
z = sp.symbols("z1 z2")
solution = sp.solve([p - q for p, q in zip(phi, z)], x, dict=True)
inverse = len(solution) == 1 and all(
    sp.simplify(solution[0][s].subs(dict(zip(z, phi))) - s) == 0 for s in x
)
in_theta = sp.Matrix(f_y).subs(solution[0]).subs({a: b + c for a, b, c in zip(z, chi, theta)})
phi_1 = in_theta.jacobian(theta)
phi_0 = sp.simplify(in_theta.subs({t: 0 for t in theta}))
linear = sp.simplify(in_theta - phi_0 - phi_1 * sp.Matrix(theta)) == sp.zeros(2, 1)
instant = phi_1.rank() == 2
sys.exit(0 if cascade and inverse and linear and instant else 1)

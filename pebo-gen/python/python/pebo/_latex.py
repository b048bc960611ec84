"""The derivation of an observer in LaTeX, set by SymPy from the formulas of the answer."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from ._sympy import FormulaError, latex

if TYPE_CHECKING:
    from ._result import Result


#: Characters of formulas that a reader can take in; SymPy needs a second for so many.
MOST = 20_000


def typeset(result: Result) -> str | None:
    """Transform, cascade, regression and left inverse, as far as they were derived, below one another.

    None if the formulas are too long or too deeply nested to be set.
    """
    try:
        return _typeset(result)
    except (FormulaError, RecursionError):
        return None


def _typeset(result: Result) -> str | None:
    claims = [result.cascade.get("h"), result.regression.get("phi_0"), result.regression.get("phi_1")]
    if len(str([result.phi, *claims, result.left_inverse.get("x")])) > MOST:
        return None
    lines = []
    if result.phi:
        lines.append(rf"z &= \varphi(x, y) = {_column(result.phi)}")
    cascade, regression = result.cascade, result.regression
    if cascade.get("h"):
        matrix = cascade["lambda"]
        factor = rf"{_matrix(matrix)}\, z + " if matrix else ""
        lines.append(rf"\dot z &= {factor}{_column(cascade['h'])}")
    if regression.get("phi_0"):
        known, factors = ("Y", "S^\\top") if regression["kind"] == "static" else (r"\Phi_0", r"\Phi_1")
        lines.append(rf"{known} &= {_column(regression['phi_0'])}, \quad {factors} = {_matrix(regression['phi_1'])}")
    for state, formula in (result.left_inverse.get("x") or {}).items():
        lines.append(rf"{latex(state)} &= {latex(formula)}")
    return "$$\\begin{aligned}\n" + " \\\\\n".join(lines) + "\n\\end{aligned}$$"


def _column(entries: Sequence[str]) -> str:
    return _matrix([[entry] for entry in entries])


def _matrix(rows: Sequence[Sequence[str]]) -> str:
    body = r" \\ ".join(" & ".join(map(latex, row)) for row in rows)
    return rf"\begin{{bmatrix}} {body} \end{{bmatrix}}"

"""Observers with proofs: what no sensor measures, computed from what is measured.

`check` answers whether the equations of a plant determine the states that are not measured, with a proof or with what
fails. A `Result` simulates the observer (`Result.simulate`), runs it over recorded data (`Result.replay`), and writes
it as Rust (`Result.rust`) and for C (`Result.c`). Numbers are in the units of the model, times in seconds.
"""

from ._errors import Diagnostic, ModelError, PeboError, RefusedError
from ._pebo import VERSION as __version__
from ._result import Claim, Result, check
from ._run import Replay, Run

__all__ = [
    "Claim",
    "Diagnostic",
    "FormulaError",
    "ModelError",
    "PeboError",
    "RefusedError",
    "Replay",
    "Result",
    "Run",
    "__version__",
    "check",
    "expression",
    "formula",
    "latex",
]


def __getattr__(name: str) -> object:
    # SymPy is imported only by who uses it.
    if name in ("FormulaError", "expression", "formula", "latex"):
        from . import _sympy

        return getattr(_sympy, name)
    raise AttributeError(f"module 'pebo' has no attribute {name!r}")

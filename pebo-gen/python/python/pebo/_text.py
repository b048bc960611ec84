"""The text of a model file from its keys.

In: keys of the model file with Python values. Out: YAML text that reads well in an excerpt of a diagnostic. What the
values mean is judged by the generator alone; here only what has no form in YAML is an error.
"""

from __future__ import annotations

import decimal
import fractions
import json
import numbers
import os
import re
import sys
from collections.abc import Mapping
from typing import Any

# Characters that YAML takes as they are, within brackets too.
_PLAIN = re.compile(r"[A-Za-z0-9(][A-Za-z0-9_+\-*/^() .]*")
# What YAML would read as something else than the text, or as nothing.
_OTHER = re.compile(r"(true|false|yes|no|on|off|null|~)?", re.IGNORECASE)


def read(model: str | os.PathLike[str] | None, keys: Mapping[str, Any]) -> tuple[str, bytes]:
    """The name and the text of a model: of a file by its path, of a text, or of the keys of a model file.

    A ``str`` is a text if it has a line break or begins with ``{``, and a path otherwise.
    """
    if model is None:
        return "model.yaml", text(keys).encode()
    if keys:
        names = ", ".join(f"`{name}`" for name in keys)
        raise TypeError(f"a model file is given, and keys of another beside it: {names}; `set=` changes keys of a file")
    if isinstance(model, str) and ("\n" in model or model.lstrip().startswith("{")):
        return "model.yaml", model.encode()
    if not isinstance(model, (str, os.PathLike)):
        raise TypeError(f"a model is a path, a text, or keys by their names, and not {type(model).__name__}")
    with open(model, "rb") as file:
        return os.fsencode(model).decode(errors="replace"), file.read()


def text(keys: Mapping[str, Any]) -> str:
    """The text of a model file with these keys: YAML, a line for each entry of a map of the first level.

    A key that is a word of Python has an underscore behind it: ``class_``. Without a name the model is ``model``.
    """
    named = {name.removesuffix("_"): value for name, value in keys.items()}
    named = {"model": named.pop("model", "model"), **named}
    writer = _Writer(named)
    lines: list[str] = []
    for key, value in named.items():
        if isinstance(value, Mapping) and value:
            lines.append(f"{key}:")
            lines += [f"  {writer.name(name)}: {writer.flow(inner)}" for name, inner in value.items()]
        else:
            # A column of components is a list of them; a matrix of a class keeps its rows.
            if key in ("phi", "identities") and getattr(value, "shape", ())[1:] == (1,):
                value = [entry for row in value.tolist() for entry in row]
            lines.append(f"{key}: {writer.flow(value)}")
    return "\n".join(lines) + "\n"


def settings(changes: Mapping[str, Any] | None) -> list[str]:
    """Settings as the command line takes them: ``{"simulation.step": 1e-6}`` is ``simulation.step=1e-06``."""
    writer = _Writer({})
    return [f"{name}={writer.flow(value)}" for name, value in (changes or {}).items()]


class _Writer:
    """Writes values as YAML; a signal is known by its name alone, be it a symbol or a function of time."""

    def __init__(self, keys: Mapping[str, Any]) -> None:
        declared = [keys.get(key) for key in ("x", "y", "u", "w")]
        lists = [value for value in declared if value is not None and not isinstance(value, (str, Mapping))]
        self._signals = frozenset(_name(signal) for names in lists if hasattr(names, "__iter__") for signal in names)

    def name(self, value: Any) -> str:
        """The name of an entry of a map: of a signal, or of its derivative by time; or an instant."""
        return _quoted(_name(value))

    def flow(self, value: Any) -> str:
        """A value on one line: maps in braces, lists and matrices in brackets."""
        # Matrices of SymPy, arrays and numbers of NumPy.
        if hasattr(value, "tolist"):
            value = value.tolist()
        if value is None:
            return "null"
        if isinstance(value, bool):
            return "true" if value else "false"
        if isinstance(value, Mapping):
            return "{" + ", ".join(f"{self.name(name)}: {self.flow(inner)}" for name, inner in value.items()) + "}"
        if isinstance(value, (list, tuple)):
            return "[" + ", ".join(self.flow(part) for inner in value for part in _parts(inner)) + "]"
        return _quoted(self._formula(value))

    def _formula(self, value: Any) -> str:
        """A formula or a name, or a number with as many digits as it has."""
        if isinstance(value, str):
            return value
        if _is_sympy(value):
            from ._sympy import formula

            if not getattr(value, "is_Rational", False):
                return formula(value, self._signals)
            value = fractions.Fraction(int(value.p), int(value.q))
        if isinstance(value, fractions.Fraction):
            return _decimal(value)
        if isinstance(value, (int, decimal.Decimal)):
            return str(value)
        if isinstance(value, numbers.Real):
            # The shortest text that reads back as the same number: 0.1 is one tenth to the generator.
            return repr(float(value))
        kind = type(value).__name__
        raise TypeError(f"a model has texts, numbers, lists, maps and SymPy expressions, and not {kind}: {value!r}")


def _decimal(value: fractions.Fraction) -> str:
    """The decimal of this value, as parameters have it, or a quotient if there is none."""
    try:
        with decimal.localcontext() as context:
            context.prec = 1000
            context.traps[decimal.Inexact] = True
            return str(decimal.Decimal(value.numerator) / value.denominator)
    except decimal.Inexact:
        return f"{value.numerator}/{value.denominator}"


def _parts(value: Any) -> list[Any]:
    if _is_sympy(value):
        from ._sympy import conjuncts

        return conjuncts(value)
    return [value]


def _name(value: Any) -> str:
    if _is_sympy(value):
        from ._sympy import name

        return name(value)
    return str(value)


def _is_sympy(value: Any) -> bool:
    """Without importing SymPy, which a caller who has no expressions need not have."""
    sympy = sys.modules.get("sympy")
    return sympy is not None and isinstance(value, (sympy.Basic, sympy.MatrixBase))


def _quoted(text: str) -> str:
    """The text as YAML, in quotes where it needs them."""
    plain = _PLAIN.fullmatch(text) and text == text.strip() and not _OTHER.fullmatch(text)
    return text if plain else json.dumps(text, ensure_ascii=False)

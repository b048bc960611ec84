"""Diagnostics, and the exceptions that carry them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Diagnostic:
    """What is wrong with a model or remarkable in it: where, what, and how to mend it."""

    #: A stable name, which ``pebo-gen explain`` tells more about.
    code: str
    #: ``error``, ``warning`` or ``note``.
    severity: str
    #: What is the matter, in a sentence.
    message: str
    #: How to mend it; None if no way is known.
    help: str | None
    #: All of it as text, with an excerpt of the model.
    text: str

    def __str__(self) -> str:
        return self.text.rstrip()


class PeboError(Exception):
    """A call without its result; the message is that of all its diagnostics."""

    # As users write it, in a traceback too.
    __module__ = "pebo"

    #: The reasons, in the order of their importance.
    diagnostics: Sequence[Diagnostic]

    def __init__(self, diagnostics: Sequence[Diagnostic], summary: str = "") -> None:
        self.diagnostics = tuple(diagnostics)
        texts = [summary.rstrip()] if summary.strip() else []
        super().__init__("\n".join([*texts, *(str(diagnostic) for diagnostic in diagnostics)]))

    # The default would give the message to the constructor of a copy.
    def __reduce__(self) -> Any:
        return _anew, (type(self), str(self), self.diagnostics)


def _anew(kind: type[PeboError], message: str, diagnostics: Sequence[Diagnostic]) -> PeboError:
    error = kind(diagnostics)
    error.args = (message,)
    return error


class ModelError(PeboError, ValueError):
    """The model, its settings or a recording is malformed: nothing is proved or refuted."""

    __module__ = "pebo"


class RefusedError(PeboError):
    """The model was read, but the result cannot be had: a claim is refuted or undecided, or a run ended early."""

    __module__ = "pebo"


def found(answer: dict[str, Any]) -> list[Diagnostic]:
    """The diagnostics of an answer of the generator."""
    pairs = zip(answer["diagnostics"], answer["rendered"])
    return [Diagnostic(one["code"], one["severity"], one["message"], one["help"], rendered) for one, rendered in pairs]


def refusal(answer: dict[str, Any]) -> PeboError:
    """The exception of an answer that lacks what was asked for."""
    kind = ModelError if answer["standing"] == "malformed" else RefusedError
    summary = answer["summary"] if answer["report"]["verdict"] != "accepted" else ""
    return kind(found(answer), summary)

"""Runs of the observer: a table of NumPy columns, with the summary and the figure."""

from __future__ import annotations

import html
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

from ._errors import Diagnostic, found

if TYPE_CHECKING:
    import numpy
    from numpy.typing import NDArray

    Column = NDArray[numpy.float64]


class Table(Mapping[str, "Column"]):
    """Columns by their names, each an array of one number a row; NaN where there is none."""

    def __init__(self, answer: dict[str, Any], columns: list[str], values: bytes) -> None:
        import numpy

        self._answer = answer
        rows = numpy.frombuffer(values, dtype=numpy.float64).reshape(-1, max(len(columns), 1))
        self._columns = {name: rows[:, place].copy() for place, name in enumerate(columns)}

    def __getitem__(self, column: str) -> Column:
        try:
            return self._columns[column]
        except KeyError:
            raise KeyError(f"there is no column `{column}`; the columns are {', '.join(self)}") from None

    def __iter__(self) -> Iterator[str]:
        return iter(self._columns)

    def __len__(self) -> int:
        return len(self._columns)

    @property
    def diagnostics(self) -> list[Diagnostic]:
        """Warnings, as of an estimate that did not settle."""
        return found(self._answer)

    @property
    def text(self) -> str:
        """The errors of the estimates in words, as the command prints them."""
        return str(self._answer["told"])

    @property
    def figure(self) -> str:
        """The figure as SVG."""
        return str(self._result["figure"])

    @property
    def summary(self) -> dict[str, Any]:
        """The numbers of `text`: of each estimate its error at the start and the end, when it settled, and more."""
        return dict(self._result["summary"])

    @property
    def _result(self) -> dict[str, Any]:
        raise NotImplementedError

    def settled(self, state: str, baseline: str | None = None) -> float | None:
        """The time in seconds from which on an estimate errs by less than 1 % of the state's largest absolute value.

        None if it does not settle. ``baseline`` names another observer of the same run.
        """
        estimates = self.summary["estimates"]
        for one in estimates:
            if (one["state"], one["baseline"]) == (state, baseline):
                settled = one["settled"]
                return None if settled is None else float(settled)
        names = ", ".join(
            one["state"] if one["baseline"] is None else f"{one['baseline']}.{one['state']}" for one in estimates
        )
        raise KeyError(f"there is no error of an estimate of `{state}`; there are {names or 'none'}")

    def __str__(self) -> str:
        return "\n".join([self.text.rstrip(), *map(str, self.diagnostics)])

    def __repr__(self) -> str:
        rows = len(next(iter(self._columns.values()), ()))
        return f"<pebo.{type(self).__name__} {self._answer['report']['model']}: {rows} rows of {', '.join(self)}>"

    def _repr_html_(self) -> str:
        """The figure under the summary."""
        return f"<pre>{html.escape(str(self))}</pre>{self.figure}"


class Run(Table):
    """A run of the closed loop: the columns of ``pebo-gen simulate --csv``.

    They are ``t`` in seconds, every state, output and input, ``<x>_hat`` and ``<x>_error`` (estimate less truth) of
    every recovered state, ``<baseline>.<x>_hat``, and ``<x>_std``, the standard error, where it is predicted; in the
    units of the model. Of many runs they are ``t`` and quantiles of the largest errors, as ``<x>_error_50``.
    """

    @property
    def _result(self) -> dict[str, Any]:
        return dict(self._answer["run"])

    @property
    def errors(self) -> dict[str, tuple[float, float]]:
        """The error of the estimate of each state, estimate less truth: at the start, and at the end."""
        return {one["state"]: (one["start"], one["end"]) for one in self._result["errors"]}


class Replay(Table):
    """The observer over recorded samples: the columns of ``pebo-gen replay --csv``.

    They are ``t`` in seconds, ``<x>_hat`` of every recovered state, ``<x>_error`` (estimate less measurement) where the
    state was recorded, and ``<x>_std``, the standard error, where it is predicted. A row stands for a row of the data.
    """

    @property
    def _result(self) -> dict[str, Any]:
        return dict(self._answer["replay"])

    @property
    def faults(self) -> list[str]:
        """What is wrong with rows of the data, each with how often and the line of the first; the header is line 1."""
        return [f"{one['what']}: {one['count']}, first in line {one['line']}" for one in self._result["faults"]]

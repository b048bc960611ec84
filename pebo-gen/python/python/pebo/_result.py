"""The answer on a model: verdict, claims, formulas; and what can be asked of it further."""

from __future__ import annotations

import html
import json
import os
from collections.abc import Iterator, Mapping
from typing import Any

from . import _pebo
from ._errors import Diagnostic, found, refusal
from ._record import recording
from ._run import Replay, Run
from ._text import settings

#: The claims of an observer, in the order of their proofs.
CLAIMS = ("cascade", "left_inverse", "regression", "identifiability")


class Claim(Mapping[str, Any]):
    """A claim with its verdict: the object of ``pebo-gen check --format json``, whose fields are attributes too.

    ``pebo-gen schema`` describes the fields; formulas are in the language of model files.
    """

    def __init__(self, name: str, fields: Mapping[str, Any]) -> None:
        self._name = name
        self._fields = dict(fields)

    @property
    def verdict(self) -> str:
        """``proved``, ``refuted``, ``undecided``, or ``skipped`` if it follows a claim that is not proved."""
        return str(self._fields["verdict"])

    def __getitem__(self, field: str) -> Any:
        return self._fields[field]

    def __iter__(self) -> Iterator[str]:
        return iter(self._fields)

    def __len__(self) -> int:
        return len(self._fields)

    def __getattr__(self, field: str) -> Any:
        try:
            return self.__dict__["_fields"][field]
        except KeyError:
            raise AttributeError(f"the claim has no field `{field}`") from None

    def __dir__(self) -> list[str]:
        return sorted({*super().__dir__(), *self._fields})

    def __repr__(self) -> str:
        return f"<{self._name.replace('_', ' ')}: {self.verdict}>"


class Result:
    """The answer on a model, as `check` gives it. A notebook shows the derivation, ``print`` the verdict in words.

    Each further question is a call to the generator of its own, with the settings and the limit of the check unless
    it has others. A question about an observer that is not proved raises `RefusedError`.
    """

    def __init__(self, model: tuple[str, bytes], changes: Mapping[str, Any] | None, limit: float | None) -> None:
        self._model, self._changes, self._limit = model, dict(changes or {}), limit
        answer, *_ = _pebo.check(model, settings(changes), limit)
        self._answer: dict[str, Any] = json.loads(answer)
        if self._answer["standing"] == "malformed":
            raise refusal(self._answer)

    @property
    def report(self) -> dict[str, Any]:
        """The object of ``pebo-gen check --format json``, which ``pebo-gen schema`` describes."""
        return dict(self._answer["report"])

    @property
    def name(self) -> str:
        """The name of the model."""
        return str(self.report["model"])

    @property
    def model(self) -> str:
        """The text of the model file, without the changes of ``set=``."""
        return self._model[1].decode(errors="replace")

    @property
    def verdict(self) -> str:
        """``accepted`` if all claims are proved, ``rejected`` if one is refuted, or ``undecided``."""
        return str(self.report["verdict"])

    @property
    def accepted(self) -> bool:
        """All claims are proved."""
        return self.verdict == "accepted"

    @property
    def summary(self) -> str:
        """The verdict in words, as ``pebo-gen check`` prints it; empty if the model could not be read in time."""
        return str(self._answer["summary"])

    @property
    def diagnostics(self) -> list[Diagnostic]:
        """What is refuted, undecided or remarkable, each with its place in the model."""
        return found(self._answer)

    @property
    def claims(self) -> dict[str, Claim]:
        """The claims by name, as far as the proof came: cascade, left_inverse, regression, identifiability."""
        return {name: Claim(name, self.report[name]) for name in CLAIMS if self.report[name] is not None}

    def _claim(self, name: str) -> Claim:
        return self.claims.get(name) or Claim(name, {"verdict": "skipped"})

    @property
    def cascade(self) -> Claim:
        """The rate of z = phi(x, y) is ``h(y, u)``, or ``lambda z + h`` with a matrix ``lambda(y, u)``."""
        return self._claim("cascade")

    @property
    def left_inverse(self) -> Claim:
        """The states are functions of z and y: the map ``x`` of states to formulas."""
        return self._claim("left_inverse")

    @property
    def regression(self) -> Claim:
        """The outputs are linear in the unknowns ``eta``, with the known terms ``phi_0`` and the factors ``phi_1``."""
        return self._claim("regression")

    @property
    def identifiability(self) -> Claim:
        """The outputs determine the unknowns: at once or over time, by ``kind``, and where not."""
        return self._claim("identifiability")

    @property
    def phi(self) -> list[str]:
        """The components of the transform z = phi(x, y), given or found; empty if there is none."""
        return list((self.report["phi"] or {"z": []})["z"])

    @property
    def conditions(self) -> list[str]:
        """What must hold besides the assumptions, as comparisons with zero."""
        return list(self.report["conditions"])

    def __repr__(self) -> str:
        return f"<pebo.Result {self.name}: {self.verdict}>"

    def __str__(self) -> str:
        return "\n".join([self.summary.rstrip(), *map(str, self.diagnostics)]).strip()

    def _repr_html_(self) -> str:
        """The sections of the page that ``pebo-gen report`` writes about the derivation, under the verdict."""
        first = self.summary.split("\n", 1)[0] or f"{self.name}: {self.verdict}"
        texts = "".join(f"<pre>{html.escape(str(diagnostic))}</pre>" for diagnostic in self.diagnostics)
        sections = "".join(section["html"] for section in self._answer["sections"] or [])
        # The rules of the page hold within the answer alone, on paper of its own in a dark notebook too.
        style = _pebo.STYLE.replace(":root", "&")
        frame = ".pebo { background: var(--paper); color: var(--ink); padding: 0.5rem 1rem; }"
        head = f"<p><strong>{html.escape(first)}</strong></p>"
        return f'<style>.pebo {{ {style} }} {frame}</style><div class="pebo">{head}{texts}{sections}</div>'

    def _repr_latex_(self) -> str | None:
        """Transform, cascade, regression and left inverse; None without SymPy, or if they are very long."""
        try:
            from ._latex import typeset
        except ImportError:
            return None
        return typeset(self)

    def rust(self, scalar: str = "f64", *, limit: float | None = None) -> str:
        """The observer as a module of Rust, as ``pebo-gen MODEL --scalar`` writes it.

        ``scalar`` is the type of its numbers, ``f64`` or ``f32``.
        """
        return str(self._ask(_pebo.code, limit, scalar, False)["emitted"]["text"])

    def c(self, scalar: str = "f64", *, limit: float | None = None) -> dict[str, str]:
        """A crate that C projects link, as ``pebo-gen MODEL --c`` writes it: the text of each file by its path.

        Header, example, Makefile and CMakeLists.txt are among them; write each where its path says.
        """
        return dict(self._ask(_pebo.code, limit, scalar, True)["c_project"]["files"])

    def page(self, *, limit: float | None = None) -> str:
        """The page of HTML that explains the proof, accepted or not, as ``pebo-gen report`` writes it."""
        answer = self._answer_of(_pebo.page, limit)
        if answer["page"] is None:
            raise refusal(answer)
        return str(answer["page"])

    def certificate(self, *, limit: float | None = None) -> str:
        """A script that proves every claim again with SymPy, as ``pebo-gen certificate`` writes it."""
        return str(self._ask(_pebo.certificate, limit)["certificate"])

    def simulate(
        self,
        *,
        duration: float | None = None,
        step: float | None = None,
        every: float | None = None,
        seed: int | None = None,
        initial_error: float | None = None,
        feedback: str | None = None,
        runs: int | None = None,
        set: Mapping[str, Any] | None = None,
        limit: float | None = None,
    ) -> Run:
        """Run plant, control law and observer in the closed loop of the section ``simulation``, as columns of numbers.

        Each of these changes the file for this run:

        - ``duration``, ``step``: the length of the run and the sampling period, in seconds.
        - ``every``: the time between rows of the table, in seconds; a thousandth of the duration if left out.
        - ``seed``: the seed of all chance, 1 if left out; the same seed gives the same run.
        - ``initial_error``: the error of the observer at the start, as a multiple of the file's; 0 knows the state.
        - ``feedback``: whose estimates the control law uses: ``observer``, ``truth``, or a baseline's name.
        - ``runs``: so many runs, 1 to 10000, with the seed and those after it; the columns are then quantiles.
        - ``set``: keys of the file with their values, as ``{"simulation.noise.v2": 0.1}``, or parameters.
        - ``limit``: seconds for the proofs, and as many for the run; a run without a limit takes its time.

        Raises `RefusedError` if a claim is not proved or the run ends early, `ModelError` if the section is malformed.
        """
        if runs is not None and not 1 <= runs <= 10_000:
            raise ValueError(f"runs are 1 to 10000, and not {runs}")
        if seed is not None and not 0 <= seed < 2**64:
            raise ValueError(f"a seed is at least 0 and below 2^64, and not {seed}")
        answer, columns, values = _pebo.simulate(
            self._model,
            self._settings(set),
            self._within(limit),
            duration=duration,
            step=step,
            every=every,
            seed=seed,
            initial_error=initial_error,
            feedback=feedback,
            runs=runs,
        )
        asked = json.loads(answer)
        if asked["run"] is None:
            raise refusal(asked)
        return Run(asked, columns, values)

    def replay(
        self,
        data: Any,
        *,
        set: Mapping[str, Any] | None = None,
        limit: float | None = None,
    ) -> Replay:
        """Run the observer over recorded samples, as columns of numbers: the estimates of each row.

        ``data`` is a DataFrame, a mapping of names to columns of equal length, or the path of a CSV file. The section
        ``recording`` says what columns mean; without it a signal is the column of its name, and ``t`` the time in
        seconds. NaN is a sample that is missing.

        Raises `RefusedError` if a claim is not proved or the run ends early, `ModelError` if columns are missing.
        """
        name, rows = (os.fspath(data), os.fspath(data)) if isinstance(data, (str, os.PathLike)) else recording(data)
        answer, columns, values = _pebo.replay(self._model, self._settings(set), self._within(limit), name, rows)
        asked = json.loads(answer)
        if asked["replay"] is None:
            raise refusal(asked)
        return Replay(asked, columns, values)

    def _settings(self, changes: Mapping[str, Any] | None) -> list[str]:
        return settings({**self._changes, **(changes or {})})

    def _within(self, limit: float | None) -> float | None:
        return self._limit if limit is None else limit

    def _answer_of(self, question: Any, limit: float | None, *options: Any) -> dict[str, Any]:
        answer, *_ = question(self._model, self._settings(None), self._within(limit), *options)
        return dict(json.loads(answer))

    def _ask(self, question: Any, limit: float | None, *options: Any) -> dict[str, Any]:
        """The answer to a question; the exception of one that is refused."""
        answer = self._answer_of(question, limit, *options)
        if answer["standing"] != "accepted":
            raise refusal(answer)
        return answer


def check(
    model: str | os.PathLike[str] | None = None,
    /,
    *,
    set: Mapping[str, Any] | None = None,
    limit: float | None = None,
    **keys: Any,
) -> Result:
    """Check a plant: is it observable by a parameter-estimation-based observer, and which one?

    The plant is the path of a model file, its text, or the keys of a model file by name. In keys, formulas are texts or
    SymPy expressions, signals are texts or symbols, matrices are lists of rows; ``class_`` is the key ``class``:

    >>> import pebo
    >>> pebo.check(x=["v"], y=["q"], u=["a"], f_x={"v": "a"}, f_y={"q": "v"})
    <pebo.Result model: accepted>

    ``set`` changes keys of the model, as ``{"parameters.L1": 0.02}``. ``limit`` is the time for the proofs in seconds,
    10 by default; what is unfinished then is undecided.

    A model that is refuted or undecided is a result, whose diagnostics say why. Raises `ModelError` if it is malformed,
    `FormulaError` if a SymPy expression has no form in a model file, and `OSError` if a file cannot be read.
    """
    from ._text import read

    return Result(read(model, keys), set, limit)

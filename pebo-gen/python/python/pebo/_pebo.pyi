"""The generator. Each function is one request: the model is its name and its text, settings are ``NAME=VALUE``."""

VERSION: str
STYLE: str

_Model = tuple[str, bytes]
_Outcome = tuple[str, list[str], bytes]

def check(model: _Model, settings: list[str], limit: float | None) -> _Outcome: ...
def code(model: _Model, settings: list[str], limit: float | None, scalar: str, c: bool) -> _Outcome: ...
def page(model: _Model, settings: list[str], limit: float | None) -> _Outcome: ...
def certificate(model: _Model, settings: list[str], limit: float | None) -> _Outcome: ...
def simulate(
    model: _Model,
    settings: list[str],
    limit: float | None,
    *,
    duration: float | None,
    step: float | None,
    every: float | None,
    seed: int | None,
    initial_error: float | None,
    feedback: str | None,
    runs: int | None,
) -> _Outcome: ...
def replay(model: _Model, settings: list[str], limit: float | None, name: str, recording: str | bytes) -> _Outcome: ...
def program(call: list[str]) -> int: ...

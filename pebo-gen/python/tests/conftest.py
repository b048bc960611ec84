"""What the tests share: the shipped models, and the program of the wheel."""

from __future__ import annotations

import pathlib
import subprocess
import sys

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[3]
MODELS = ROOT / "models"

#: A mass whose position is measured, by keys.
MASS = {"model": "mass", "x": ["v"], "y": ["q"], "u": ["a"], "f_x": {"v": "a"}, "f_y": {"q": "v"}}


@pytest.fixture
def cuk() -> pathlib.Path:
    return MODELS / "cuk.yaml"


def program(*arguments: object, cwd: pathlib.Path | None = None) -> subprocess.CompletedProcess[str]:
    """Runs the program that the wheel installed beside the interpreter."""
    installed = pathlib.Path(sys.executable).parent / "pebo-gen"
    call = [str(installed), *map(str, arguments)]
    return subprocess.run(call, capture_output=True, text=True, cwd=cwd, timeout=120, check=False)

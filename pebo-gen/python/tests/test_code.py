"""Code, page and certificate: byte for byte those of the program."""

from __future__ import annotations

import subprocess
import sys

import pytest
from conftest import MODELS, program

import pebo


@pytest.mark.parametrize("scalar", ["f64", "f32"])
def test_rust_is_that_of_the_program(cuk, scalar):
    said = program(cuk, "--scalar", scalar)
    assert said.returncode == 0 and pebo.check(cuk).rust(scalar) == said.stdout


def test_c_is_that_of_the_program(cuk, tmp_path):
    assert program(cuk, "--c", tmp_path / "cuk").returncode == 0
    files = pebo.check(cuk).c()
    written = {
        str(path.relative_to(tmp_path / "cuk")): path for path in (tmp_path / "cuk").rglob("*") if path.is_file()
    }
    assert files.keys() == written.keys() and "include/cuk.h" in files
    for name, path in written.items():
        assert files[name] == path.read_text()


def test_page_and_certificate_are_those_of_the_program(tmp_path):
    model = MODELS / "boost.yaml"
    result = pebo.check(model)
    assert program("report", model).stdout == result.page()
    assert program("certificate", model).stdout == result.certificate()
    (tmp_path / "boost.py").write_text(result.certificate())
    subprocess.run([sys.executable, tmp_path / "boost.py"], check=True, timeout=300)


def test_a_wrong_scalar_is_told(cuk):
    with pytest.raises(ValueError, match="only f64 and f32: did you mean `f32`"):
        pebo.check(cuk).rust("f3")

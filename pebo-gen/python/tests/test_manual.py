"""Blocks of the manual and of README.md: `pycon` is a session with its output, `python` is code that runs."""

from __future__ import annotations

import doctest
import re

import pytest
from conftest import ROOT

PAGES = [*sorted((ROOT / "docs").glob("*.md")), ROOT / "pebo-gen" / "python" / "README.md"]
BLOCK = re.compile(r"^```(python|pycon)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
FLAGS = doctest.ELLIPSIS


def blocks(page):
    return [(found.group(1), found.group(2), found.start(2)) for found in BLOCK.finditer(page.read_text())]


@pytest.mark.parametrize("page", [page for page in PAGES if blocks(page)], ids=lambda page: page.name)
def test_a_page_is_true(page, monkeypatch, capsys):
    pytest.importorskip("sympy")
    # Pages name files as from the folder of the checkout.
    monkeypatch.chdir(ROOT)
    names: dict[str, object] = {}
    runner = doctest.DocTestRunner(optionflags=FLAGS)
    for kind, text, start in blocks(page):
        if kind == "python":
            exec(compile(text, str(page), "exec"), names)
            continue
        line = page.read_text()[:start].count("\n")
        session = doctest.DocTestParser().get_doctest(text, names, page.name, str(page), line)
        runner.run(session, clear_globs=False)
        names = session.globs
    assert not runner.failures, capsys.readouterr().out

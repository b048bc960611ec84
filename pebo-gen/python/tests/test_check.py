"""Verdicts, claims and diagnostics, of files, texts and keys."""

from __future__ import annotations

import json
import os
import pickle
import time
from decimal import Decimal
from fractions import Fraction

import numpy
import pytest
from conftest import MASS, MODELS, program

import pebo


@pytest.mark.parametrize("name", ["cuk", "cuk_case2", "motor", "boost", "cart_pendulum", "levitated_ball"])
def test_the_report_is_that_of_the_program(name):
    path = MODELS / f"{name}.yaml"
    said = program("check", path, "--format", "json")
    assert pebo.check(path).report == json.loads(said.stdout)


def test_a_result_has_verdict_claims_and_formulas(cuk):
    result = pebo.check(cuk)
    assert (result.name, result.verdict, result.accepted) == ("cuk", "accepted", True)
    assert list(result.claims) == ["cascade", "left_inverse", "regression", "identifiability"]
    assert {claim.verdict for claim in result.claims.values()} == {"proved"}
    assert result.phi == ["i1", "i3"]
    assert result.cascade.h == ["(E - v2*(1 - d))/L1", "(-v4 - v2*d)/L3"]
    assert result.left_inverse["x"] == {"i1": "z1", "i3": "z2"}
    assert result.identifiability.kind == "instant"
    assert "h" in dir(result.cascade) and repr(result.cascade) == "<cascade: proved>"
    assert repr(result) == "<pebo.Result cuk: accepted>"
    assert str(result).startswith("cuk: accepted: all four claims are proved\n")
    with pytest.raises(AttributeError, match="no field `hh`"):
        _ = result.cascade.hh


def test_a_file_a_text_and_keys_give_the_same(cuk):
    text = cuk.read_text()
    keys = dict(
        model="cuk",
        parameters={"L1": 10e-3, "C2": 22e-6, "L3": 10e-3, "C4": 22.9e-6, "G": 0.0447, "E": 12},
        x=["i1", "i3"],
        y=("v2", "v4"),
        u=["d"],
        units=dict(L1="H", C2="F", L3="H", C4="F", G="S", E="V", i1="A", i3="A", v2="V", v4="V"),
        assume=["L1 > 0", "C2 > 0", "L3 > 0", "C4 > 0", "0 < d < 1"],
        f_x={"i1": "(E - (1 - d)*v2)/L1", "i3": "-(d*v2 + v4)/L3"},
        f_y={"v2": "((1 - d)*i1 + d*i3)/C2", "v4": "(i3 - G*v4)/C4"},
        phi=["i1", "i3"],
    )
    of_keys = pebo.check(**keys)
    assert of_keys.report == pebo.check(cuk).report == pebo.check(str(cuk)).report == pebo.check(text).report
    assert pebo.check(of_keys.model).report == of_keys.report


def test_matrices_and_words_of_python_are_keys():
    lti = {"A11": numpy.array([[-1.0]]), "A21": [[2]]}
    assert pebo.check(x=["p"], y=["q"], lti=lti).accepted
    asked = pebo.check(**MASS, class_="pebo")
    assert "class: pebo" in asked.model


def test_a_wrong_name_gives_the_nearest():
    with pytest.raises(pebo.ModelError) as raised:
        pebo.check(**{**MASS, "f_x": {"v": "aa"}})
    (found,) = raised.value.diagnostics
    assert (found.code, found.severity, found.help) == ("unknown-name", "error", "did you mean `a`?")
    assert "v: aa" in str(raised.value) and "^^ not declared in this model" in str(raised.value)
    with pytest.raises(pebo.ModelError, match="did you mean `f_x`"):
        pebo.check(x=["v"], y=["q"], f_z={"v": "1"}, f_y={"q": "v"})
    with pytest.raises(ValueError, match="unknown name"):
        pebo.check(**{**MASS, "f_x": {"v": "aa"}})


def test_an_exception_can_be_pickled():
    with pytest.raises(pebo.ModelError) as raised:
        pebo.check(x=["v"])
    again = pickle.loads(pickle.dumps(raised.value))
    assert str(again) == str(raised.value) and again.diagnostics == raised.value.diagnostics


def test_a_refuted_claim_is_a_result():
    refuted = pebo.check(x=["p", "s"], y=["q"], f_x={"p": "0", "s": "s^2"}, f_y={"q": "p"})
    assert refuted.verdict == "rejected" and not refuted.accepted
    assert any(diagnostic.severity == "error" for diagnostic in refuted.diagnostics)
    for ask in [refuted.rust, refuted.c, refuted.certificate, refuted.simulate, lambda: refuted.replay({"t": [0]})]:
        with pytest.raises(pebo.RefusedError, match="rejected"):
            ask()
    assert "<html" in refuted.page()
    assert "rejected" in refuted._repr_html_()


def test_a_short_limit_is_undecided_and_soon():
    begun = time.monotonic()
    result = pebo.check(MODELS / "induction_motor.yaml", limit=0.01)
    assert result.verdict == "undecided"
    assert "limit-reached" in {diagnostic.code for diagnostic in result.diagnostics}
    assert time.monotonic() - begun < 2
    with pytest.raises(pebo.RefusedError, match="undecided"):
        result.rust()
    for limit in (0, -1, float("nan")):
        with pytest.raises(ValueError, match="positive"):
            pebo.check(**MASS, limit=limit)


def test_settings_change_a_model(cuk):
    changed = pebo.check(cuk, set={"parameters.L1": 0.02, "observer.filter": 2})
    assert changed.accepted and "L1: 10e-3" in changed.model
    with pytest.raises(pebo.ModelError, match="did you mean `L1`"):
        pebo.check(cuk, set={"L11": 1})


def test_what_is_no_model_says_so(tmp_path, cuk):
    with pytest.raises(FileNotFoundError):
        pebo.check(tmp_path / "none.yaml")
    with pytest.raises(TypeError, match="keys of another beside it: `x`"):
        pebo.check(cuk, x=["p"])
    with pytest.raises(TypeError, match="not int"):
        pebo.check(3)
    with pytest.raises(TypeError, match="not object"):
        pebo.check(**{**MASS, "f_x": {"v": object()}})
    with pytest.raises(pebo.ModelError):
        pebo.check()
    (tmp_path / "binary.yaml").write_bytes(b"\xff\xfe")
    with pytest.raises(pebo.ModelError, match="not UTF-8"):
        pebo.check(tmp_path / "binary.yaml")


@pytest.mark.parametrize(
    "value",
    ["", "#", ": {", "'", '"', "\\", "]", "\0", "ä + 𝛼", "a" * 5000, "(" * 5000, "9^9^9^9", "1/0", "null", "true", "~"],
)
def test_no_value_breaks_out_of_its_place(value):
    # An answer or an exception in words, and never a panic.
    for keys in ({"f_x": {"v": value}}, {"x": [value]}, {"f_x": {value: "a"}}, {value or "_": 1}, {"observer": value}):
        try:
            assert pebo.check(**{**MASS, **keys}, limit=1).verdict
        except pebo.ModelError as error:
            assert error.diagnostics


def test_numbers_keep_their_digits():
    values = {"a": 0.1, "b": 1e-5, "c": numpy.float64(0.3), "d": 2**70, "e": numpy.int32(4), "f": 1e300}
    model = pebo.check(x=["p"], y=["q"], f_x={"p": "-p"}, f_y={"q": "p"}, parameters=values).model
    assert "a: 0.1\n" in model and "b: 1e-05" in model and "c: 0.3\n" in model and f"d: {2**70}" in model


def test_other_kinds_of_numbers_are_numbers():
    values = {"a": Decimal("1E+5"), "b": Fraction(1, 8), "c": numpy.float32(0.5), "d": 1e-300, "e": Decimal("-0.10")}
    result = pebo.check(x=["p"], y=["q"], f_x={"p": "-p"}, f_y={"q": "p"}, parameters=values)
    assert result.accepted and "b: 0.125" in result.model


def test_a_path_may_have_any_name(tmp_path, cuk):
    for name in ("ä ö.yaml", "a{b}.yaml", os.fsdecode(b"\xff.yaml")):
        (tmp_path / name).write_bytes(cuk.read_bytes())
        assert pebo.check(tmp_path / name).accepted


def test_a_notebook_shows_the_derivation(cuk):
    shown = pebo.check(cuk)._repr_html_()
    assert "<math" in shown and "Phi" in shown or "Φ" in shown
    assert ":root" not in shown and "<script" not in shown

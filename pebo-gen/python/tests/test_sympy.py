"""SymPy expressions: the same verdict as texts, or an error that says what cannot be written."""

from __future__ import annotations

import pytest

import pebo

sympy = pytest.importorskip("sympy")

from pebo._sympy import expression, formula, latex  # noqa: E402

a, b, c = sympy.symbols("a b c", real=True)


def test_expressions_give_the_verdict_of_texts():
    m, length, g, p, q, tau = sympy.symbols("m l g p q tau")
    texts = pebo.check(
        model="pendulum",
        parameters={"m": 1, "l": 0.5, "g": 9.81},
        x=["p"],
        y=["q"],
        u=["tau"],
        f_x={"p": "-g*l*m*sin(q) + tau"},
        f_y={"q": "p/(l^2*m)"},
    )
    symbols = pebo.check(
        model="pendulum",
        parameters={m: 1, length: sympy.Rational(1, 2), g: sympy.Float("9.81")},
        x=[p],
        y=[q],
        u=[tau],
        f_x={p: tau - m * g * length * sympy.sin(q)},
        f_y={q: p / (m * length**2)},
    )
    assert texts.accepted
    keys = ("verdict", "class", "phi", "cascade", "left_inverse", "regression", "identifiability")
    assert [symbols.report[key] for key in keys] == [texts.report[key] for key in keys]


def test_signals_may_be_functions_of_time():
    t = sympy.Symbol("t")
    v, q, force = (sympy.Function(name)(t) for name in ("v", "q", "F"))
    m, k = sympy.symbols("m k", positive=True)
    result = pebo.check(
        parameters=[m, k],
        x=[v],
        y=[q],
        u=[force],
        assume=["m > 0", "k > 0", sympy.And(q > 0, q < 1)],
        f_x={v.diff(t): (force - k * q) / m},
        f_y={q.diff(t): v},
        phi=sympy.Matrix([v]),
    )
    assert result.accepted and "phi: [v]" in result.model and '"q > 0", "q < 1"' in result.model


@pytest.mark.parametrize(
    ("expr", "text"),
    [
        (-(a**2), "-a^2"),
        ((-a) ** 3, "-a^3"),
        (a**b**c, "a^b^c"),
        (sympy.Pow(a**b, c, evaluate=False), "(a^b)^c"),
        (1 / (a * b), "1/(a*b)"),
        (sympy.sqrt(a) / b, "sqrt(a)/b"),
        (a ** sympy.Rational(-2, 3), "a^(-2/3)"),
        (abs(a) * sympy.pi, "pi*abs(a)"),
        (sympy.E * a, "exp(1)*a"),
        (0.1 * a, "0.1*a"),
        (sympy.Max(a, b, c), "max(max(a, b), c)"),
        (sympy.atan2(a, b), "atan2(a, b)"),
        (sympy.Function("ocv")(a), "ocv(a)"),
        (sympy.Ne(a, 0), "a != 0"),
        (sympy.sec(a), "(1/cos(a))"),
    ],
)
def test_what_an_expression_is_written_as(expr, text):
    assert formula(expr) == text


@pytest.mark.parametrize(
    "expr", [-(a - b) * c / (a + b) ** 2, a**b**c, (a / b) / c, a / (b / c), sympy.cot(a), -sympy.exp(-a) / 3]
)
def test_what_is_written_reads_back(expr):
    assert sympy.simplify(expression(formula(expr)) - expr) == 0


@pytest.mark.parametrize(
    ("expr", "why"),
    [
        (sympy.Piecewise((a, a > 0), (b, True)), "Piecewise.*abs, sign, min, max or sat"),
        (sympy.I * a, "formulas are real"),
        (sympy.Heaviside(a), "sign"),
        (sympy.gamma(a), "gamma.*model-file.md"),
        (sympy.oo, "Infinity"),
        (sympy.nan, "NaN"),
        (sympy.Eq(a, b), "difference of its sides"),
        (sympy.Function("i")(a).diff(a), "Derivative.*f_x"),
        (sympy.true, "write it as a text"),
        (sympy.Matrix([a, b]), "Matrix"),
        (a % 2, "Mod"),
    ],
)
def test_what_cannot_be_written_says_so(expr, why):
    with pytest.raises(pebo.FormulaError, match=why):
        formula(expr)


@pytest.mark.parametrize("text", ["", "a.real", "'a'", "a; b", "a b", "(", "1/", "(" * 3000 + "a" + ")" * 3000, "a[0]"])
def test_no_formula_is_an_error_in_words(text):
    with pytest.raises(pebo.FormulaError):
        expression(text)


def test_very_long_formulas_are_not_typeset():
    inputs = [f"{'a' * 400}{n}" for n in range(60)]
    result = pebo.check(x=["p"], y=["q"], u=inputs, f_x={"p": "+".join(inputs)}, f_y={"q": "p"}, phi=["p"])
    assert result.accepted and result._repr_latex_() is None


def test_formulas_of_an_answer_are_typeset(cuk):
    typeset = pebo.check(cuk)._repr_latex_()
    assert typeset.startswith("$$\\begin{aligned}") and r"\frac{1}{C_{4}}" in typeset
    # Names may be words of Python, or of SymPy.
    assert latex("lambda*E - as/I") == r"\lambda E - \frac{as}{I}"

"""Formulas between SymPy and the language of model files.

In: SymPy expressions, or formulas of an answer. Out: formulas of a model file, or SymPy expressions. Holds: what has no
form in the other language is an error that says so; nothing is approximated.
"""

from __future__ import annotations

import functools
import re
from tokenize import TokenError
from collections.abc import Collection
from typing import Any

try:
    import sympy
    from sympy.core.function import AppliedUndef
    from sympy.parsing.sympy_parser import parse_expr
    from sympy.printing.codeprinter import CodePrinter
    from sympy.printing.latex import LatexPrinter
    from sympy.printing.precedence import PRECEDENCE
except ImportError as error:
    raise ImportError("formulas as SymPy expressions need SymPy: pip install sympy") from error

_SAME = "sin cos tan asin acos atan atan2 sinh cosh tanh asinh acosh atanh exp log sign"
#: Functions of the model language by those of SymPy that mean the same.
FUNCTIONS = {**{name: name for name in _SAME.split()}, "Abs": "abs"}

#: What to write for functions that the language does not have.
_INSTEAD = {
    "Piecewise": "write it with abs, sign, min, max or sat, or as a table under `define`",
    "Heaviside": "write (1 + sign(a))/2",
    "BooleanTrue": "SymPy's own assumptions imply it, which a model does not know; write it as a text, as 'L > 0'",
    "Derivative": "write rates under f_x and f_y, with formulas that have none",
    "Integral": "evaluate it first, with .doit()",
    "ImaginaryUnit": "formulas are real: declare symbols with real=True or positive=True and simplify",
    "conjugate": "formulas are real: declare symbols with real=True and simplify",
    "re": "formulas are real: declare symbols with real=True and simplify",
    "im": "formulas are real: declare symbols with real=True and simplify",
}


class FormulaError(ValueError):
    """A SymPy expression that has no form in the language of model files."""

    __module__ = "pebo"


def formula(expr: Any, signals: Collection[str] = ()) -> str:
    """The formula of an expression, or of an inequality between expressions.

    Functions of time, as ``Function("i")(t)``, are signals if their names are among ``signals``.
    """
    return _Printer(signals).doprint(expr)


def name(expr: Any) -> str:
    """The name of a symbol, of a function of time, or of the signal whose derivative by time this is."""
    if isinstance(expr, sympy.Derivative) and len(expr.variables) == 1:
        expr = expr.expr
    if isinstance(expr, AppliedUndef) and len(expr.args) == 1:
        return str(expr.func.__name__)
    return str(expr)


def conjuncts(value: Any) -> list[Any]:
    """The inequalities of a conjunction, as ``And(0 < d, d < 1)``, in an order that does not change; else the value."""
    return sorted(value.args, key=sympy.default_sort_key) if isinstance(value, sympy.And) else [value]


class _Printer(CodePrinter):  # type: ignore[misc]
    """Writes the language of model files; what is not in it raises `FormulaError`."""

    printmethod = "_pebo"
    language = "pebo"

    def __init__(self, signals: Collection[str]) -> None:
        super().__init__({"allow_unknown_functions": True})
        self._signals = signals

    def doprint(self, expr: Any, assign_to: Any = None) -> str:
        # CodePrinter's own would make statements of it.
        return str(self._print(sympy.sympify(expr)))

    def emptyPrinter(self, expr: Any) -> str:
        return self._refuse(expr)

    def _refuse(self, expr: Any) -> str:
        kind = type(expr).__name__
        help = _INSTEAD.get(kind, "the manual lists the functions: docs/model-file.md")
        raise FormulaError(f"a model file cannot express SymPy's {kind} in `{expr}`: {help}")

    _print_not_supported = _refuse
    _print_Piecewise = _print_Derivative = _print_Integral = _print_Heaviside = _print_ImaginaryUnit = _refuse
    _print_NaN = _print_Infinity = _print_NegativeInfinity = _print_ComplexInfinity = _refuse
    _print_BooleanTrue = _print_BooleanFalse = _print_And = _print_Or = _print_Not = _print_ITE = _print_Tuple = (
        _print_MatrixBase
    ) = _refuse

    def _print_Symbol(self, expr: Any) -> str:
        return str(expr.name)

    def _print_Integer(self, expr: Any) -> str:
        return str(expr.p)

    def _print_Rational(self, expr: Any) -> str:
        return f"{expr.p}/{expr.q}"

    _print_Half = _print_Rational

    def _print_Float(self, expr: Any) -> str:
        # In double precision the shortest decimal is what the author wrote; it is exact to the generator.
        return repr(float(expr)) if expr._prec == 53 else str(sympy.StrPrinter({"full_prec": True}).doprint(expr))

    def _print_Pi(self, expr: Any) -> str:
        return "pi"

    def _print_Exp1(self, expr: Any) -> str:
        return "exp(1)"

    def _print_NumberSymbol(self, expr: Any) -> str:
        return self._refuse(expr)

    def _print_Pow(self, expr: Any, rational: bool = False) -> str:
        base, power = expr.base, expr.exp
        bound = PRECEDENCE["Pow"]
        if power == sympy.S.Half:
            return f"sqrt({self._print(base)})"
        if power == -sympy.S.Half:
            return f"1/sqrt({self._print(base)})"
        if power == -1:
            return f"1/{self.parenthesize(base, bound)}"
        # `^` binds to the right and tighter than a minus in front.
        return f"{self.parenthesize(base, bound, strict=False)}^{self.parenthesize(power, bound, strict=True)}"

    def _print_Function(self, expr: Any) -> str:
        kind = expr.func.__name__
        arguments = ", ".join(self._print(argument) for argument in expr.args)
        if kind in FUNCTIONS:
            return f"{FUNCTIONS[kind]}({arguments})"
        if isinstance(expr, AppliedUndef):
            # A signal that is a function of time; any other is a table, or a function that the language has.
            is_signal = kind in self._signals and len(expr.args) == 1
            return str(kind) if is_signal else f"{kind}({arguments})"
        # Secants and the like.
        for target in (sympy.cos, sympy.exp):
            rewritten = expr.rewrite(target)
            if not rewritten.has(expr.func):
                return f"({self._print(rewritten)})"
        return self._refuse(expr)

    def _print_ExpBase(self, expr: Any) -> str:
        return f"exp({self._print(expr.args[0])})"

    def _print_Max(self, expr: Any) -> str:
        return self._folded("max", expr)

    def _print_Min(self, expr: Any) -> str:
        return self._folded("min", expr)

    def _folded(self, function: str, expr: Any) -> str:
        """Of two arguments at a time; in an order that does not change from run to run."""
        arguments = sorted(expr.args, key=sympy.default_sort_key)
        written: list[str] = [self._print(argument) for argument in arguments]
        return functools.reduce(lambda a, b: f"{function}({a}, {b})", written)

    def _print_Relational(self, expr: Any) -> str:
        if expr.rel_op not in ("<", "<=", ">", ">=", "!="):
            raise FormulaError(f"a model file cannot express the equation `{expr}`: write the difference of its sides")
        return f"{self._print(expr.lhs)} {expr.rel_op} {self._print(expr.rhs)}"


# A name that is not the exponent of a number.
_NAME = re.compile(r"(?<![\w.])[^\W\d]\w*")
# What formulas are made of: SymPy evaluates what it reads, and nothing else may get there.
_FORMULA = re.compile(r"(?:[\w\s,()+\-*/^]|\.(?![^\W\d]))+")


def expression(text: str) -> Any:
    """A formula of an answer as a SymPy expression, whose symbols are real; its terms stand as they are written.

    Raises `FormulaError` for a text that is no formula, or is nested too deeply for Python.
    """
    if not _FORMULA.fullmatch(text):
        raise FormulaError(f"no formula: `{text}`")
    names: dict[str, Any] = {}

    def placed(found: re.Match[str]) -> str:
        # Names may be words of Python, or of SymPy.
        word = found.group()
        is_call = text[found.end() :].startswith("(")
        place = f"n{len(names)}_"
        if is_call:
            names[place] = _FUNCTIONS_BACK.get(word) or sympy.Function(word)
        else:
            names[place] = sympy.pi if word == "pi" else sympy.Symbol(word, real=True)
        return place

    spelled = _NAME.sub(placed, text).replace("^", "**")
    try:
        return parse_expr(spelled, local_dict=names, evaluate=False)
    except (ArithmeticError, MemoryError, RecursionError, SyntaxError, TokenError, TypeError, ValueError) as error:
        raise FormulaError(f"SymPy cannot read `{text[:80]}`: {error}") from error


def latex(text: str) -> str:
    """A formula of an answer in LaTeX, in the order in which it is written."""
    return str(_Latex({"order": "none"}).doprint(expression(text)))


class _Latex(LatexPrinter):  # type: ignore[misc]
    """Prints the expression as it stands, but for the factor 1 that SymPy makes of a quotient such as 1/C."""

    def _print_Mul(self, expr: Any) -> str:
        rest: tuple[Any, ...] = expr.args[1:] if expr.args[0] == 1 else ()
        if len(rest) == 1:
            return str(self._print(rest[0]))
        return str(super()._print_Mul(sympy.Mul(*rest, evaluate=False) if rest else expr))


_FUNCTIONS_BACK: dict[str, Any] = {name: getattr(sympy, kind) for kind, name in FUNCTIONS.items()} | {
    "sqrt": sympy.sqrt,
    "min": sympy.Min,
    "max": sympy.Max,
}

"""Reads the formulas of a job into a system that overloads Python's operators, as a script would write them."""
import ast


class _Exact(ast.NodeTransformer):
    """Integers become the system's, so that 1/2 is no decimal."""

    def visit_Constant(self, node):
        return ast.Call(ast.Name("Integer", ast.Load()), [node], [])


def compiled(text):
    tree = _Exact().visit(ast.parse(str(text).replace("^", "**"), mode="eval"))
    return compile(ast.fix_missing_locations(tree), "formula", "eval")


def residuals(job, symbol, functions):
    """What is to be shown zero: the rates of the transform less their known values, and identities as they are.

    Reads the formulas and returns the function that differentiates and subtracts.
    `symbol(name, positive)` makes a symbol; `functions` maps names, among them `Integer`, to what they mean.
    """
    assumed = set(job.get("assume", ()))
    symbols = {name: symbol(name, name in assumed) for name in job["symbols"]}
    names = {**functions, **symbols}

    def value(text):
        return eval(compiled(text), {"__builtins__": {}}, names)

    for name, text in job.get("define", ()):
        names[name] = value(text)
    rates = {symbols[name]: value(text) for name, text in job.get("rates", {}).items()}
    identities = [value(text) for text in job.get("zero", ())]
    claims = [(value(phi), value(side)) for phi, side in job.get("claims", ())]
    replaced = [(symbols[name], value(text)) for name, text in job.get("replace", ())]

    def derived():
        found = list(identities)
        for transform, side in claims:
            found.append(sum((transform.diff(state) * rate for state, rate in rates.items()), -side))
        # One after the other: the value of one symbol holds others that are replaced in turn.
        for name, meaning in replaced:
            found = [expr.xreplace({name: meaning}) for expr in found]
        return found

    return derived

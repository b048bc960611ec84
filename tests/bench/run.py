"""Our algebra beside others', in one run: see README.md. From the project's root: python3 tests/bench/run.py"""
import argparse
import json
import os
import platform
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests" / "bench"))

from driver import rows, setup  # noqa: E402
from driver.jobs import CASCADES, Shelf  # noqa: E402
from driver.systems import whole  # noqa: E402

IDENTITIES = ("SymEngine", "SymPy", "symplex")
CHECKS = {"cuk": (1, 2, 4, 8), "lti": (12, 24, 60), "symbolic": (2, 4, 6), "arm": (3, 4, 5, 6, 7), "spatial": (2, 3, 6),
          "compartments": (6, 12), "grid": (8, 16, 32), "terms": (50, 201, 400)}
# The rivals that answer the central question of a family (rivals/family_rival.py).
FAMILY_RIVALS = {"cuk": "SymPy", "lti": "FLINT", "compartments": "SymPy", "grid": "SymPy", "terms": "SymPy"}
POLYNOMIALS = ("FLINT", "SymEngine", "SymPy", "symplex")


def proofs(shelf, ours, others, program, timeout):
    """(a) The zero proof alone, and the whole process."""
    others = [system for system in others if system.name in IDENTITIES]
    head = [ours.name, *(system.name for system in others)]
    jobs = [(name, shelf.model(name)) for name in CASCADES]
    jobs += [("chain of 4", shelf.chain(4)), ("det of 6 rotations", shelf.rotations(6))]
    tables = {part: [] for part in ("proof", "check", "process")}
    recipes = []
    for name, job in jobs:
        chosen, failed = [(ours, "")], {}
        for system in others:
            recipe, found = rows.best_recipe(system, job, timeout)
            if recipe is None:
                failed[system.name] = found
            else:
                chosen.append((system, recipe))
                recipes.append(f"{name}, {system.name}: {recipe}")
        model = shelf.models.get(name)
        for part, table in tables.items():
            asks = {s.name: _asker(s, job, recipe, part) for s, recipe in chosen}
            if part == "process" and model:
                alone = asks["ours"]
                asks["ours"] = lambda limit, model=model: whole([program, "check", model], limit)
                asks["cascade alone"] = alone
            table.append((name, {**failed, **rows.measure(asks, timeout)}))
    rows.show("(a) The zero proof alone, in process, warm", head, tables["proof"])
    rows.show("(a) The cascade check, in process, warm: derivatives, difference, proof", head, tables["check"])
    rows.show("(a) A whole process: ours proves all claims of the model, the others and the second column the cascade",
              [head[0], "cascade alone", *head[1:]], tables["process"])
    nothing = rows.measure({"nothing": lambda limit: whole(["true"], limit)}, timeout)["nothing"]
    print(f"  A process that does nothing takes {nothing * 1e3:.2f} ms.\n")
    print("Recipes, the fastest of each system's:")
    for line in recipes:
        print(f"  {line}")


def _asker(system, job, recipe, part):
    if part == "process":
        return lambda limit: system.whole(job, recipe, limit)
    return lambda limit: system.ask(job, recipe, part, limit)


def polynomials(shelf, ours, others, timeout):
    """(b) Products and greatest common divisors."""
    others = [system for name in POLYNOMIALS for system in others if system.name == name]
    head = [ours.name, *(system.name for system in others)]
    crowded, spread = shelf.product(6, 1000, 3), shelf.product(6, 340, 20)
    jobs = [
        ("p(1 + p), p = (1+x+y+z)^20", shelf.trinomial(20)),
        (f"sparse, 6 variables, 340 x 340 to {spread[1]} terms", spread[0]),
        (f"sparse, 6 variables, 1000 x 1000 to {crowded[1]} terms", crowded[0]),
        (f"dense, 1 variable, 500 x 500 to {shelf.product(1, 500, 560)[1]} terms", shelf.product(1, 500, 560)[0]),
        ("gcd, 1 variable", shelf.gcd(1, 60, 80)),
        ("gcd, 3 variables", shelf.gcd(3, 40, 8)),
        ("gcd, 5 variables", shelf.gcd(5, 40, 4)),
        ("gcd, 7 variables", shelf.gcd(7, 40, 3)),
        ("power 10, 1 variable, 40 terms", shelf.power(1, 40, 39, 10)),
        ("power 6, 4 variables, 8 terms", shelf.power(4, 8, 4, 6)),
        ("square-free parts, 1 variable", shelf.square_free(1, 12, 14)),
        ("square-free parts, 3 variables", shelf.square_free(3, 5, 3)),
    ]
    table = []
    for name, job in jobs:
        asks = {s.name: _asker(s, job, "", "proof") for s in [ours, *others]}
        table.append((name, rows.measure(asks, timeout)))
    rows.show("(b) Polynomials over the integers", head, table)


def growth(shelf, ours, program, timeout):
    """(c) How our time grows."""

    def series(title, entries):
        table = []
        for name, job in entries:
            table.append((name, rows.measure({"ours": _asker(ours, job, "", "proof")}, timeout)))
        rows.show(title, ["ours"], table)

    chains = []
    for links in range(1, 6):
        job = shelf.chain(links)
        model = Path(job).with_suffix(".model.json")
        model.write_text(json.dumps({"kind": "model", "path": shelf.models[f"chain of {links}"]}), encoding="utf-8")
        chains += [(f"{links} links, zero proofs", job), (f"{links} links, all claims", str(model))]
    series("(c) Links: the planar chain", chains)
    products = [(f"({(n + 1) * (n + 2) * (n + 3) // 6} terms) squared", shelf.trinomial(n)) for n in (5, 10, 20, 30)]
    divisors = [(f"gcd, 5 variables, {t} terms", shelf.gcd(5, t, 4)) for t in (10, 20, 40, 80)]
    series("(c) Terms", products + divisors)
    rotations = [(f"det of {k} rotations, {2 * k} kernels", shelf.rotations(k)) for k in (2, 4, 6, 8, 10)]
    roots = [(f"1/sum of {k} roots", shelf.roots(k)) for k in (2, 3, 4, 5)]
    series("(c) Kernels", rotations + roots)
    checks = []
    for family, sizes in CHECKS.items():
        for size in sizes:
            path = shelf.family(family, size)
            command = [program, "check", "--limit", "20", path]
            # Arms are rejected: the exit status is 1.
            asks = {"ours": lambda limit, command=command: whole(command, limit, decided=(0, 1))}
            if rival := FAMILY_RIVALS.get(family):
                other = [sys.executable, str(ROOT / "tests" / "bench" / "rivals" / "family_rival.py"), rival, path]
                asks[rival] = lambda limit, other=other: whole(other, limit)
            checks.append((f"{family} {size}", rows.measure(asks, timeout)))
    rows.show("(c) Families of models (models.py): a whole process; ours all claims, rivals the cascade alone",
              ["ours", "FLINT", "SymPy"], checks)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--timeout", type=float, default=60, help="seconds that a system gets for a job (60)")
    parser.add_argument("--only", choices="abc", help="one of the tables")
    options = parser.parse_args()
    program, ours = setup.build_ours(ROOT)
    python = setup.environment(ROOT)
    if python != sys.executable:
        # Once more in the environment, which has the reader of the model files.
        os.execv(python, [python, *sys.argv])
    print(f"{platform.machine()}, {os.cpu_count()} cores, Python {platform.python_version()}")
    others = setup.rivals(ROOT, python)
    shelf = Shelf(setup.target(ROOT) / "bench-jobs", ROOT)
    chosen = options.only or "abc"
    try:
        if "a" in chosen:
            proofs(shelf, ours, others, program, options.timeout)
        if "b" in chosen:
            polynomials(shelf, ours, others, options.timeout)
        if "c" in chosen:
            growth(shelf, ours, program, options.timeout)
    finally:
        for system in [ours, *others]:
            system.close()


main()

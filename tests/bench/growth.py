"""How generation grows, beside SymPy's cse: planar chains of n links and interleaved converters of n phases.

    python3 tests/bench/growth.py
    python3 tests/bench/growth.py chain 2 6

Ours is a whole process: model file in, all claims proved, module out, accuracy measured. SymPy gets the formulas that
come of it, h, phi_0, phi_1 and phi_left, and takes their common subexpressions out and prints C. Times are of the
processor. Operations are additions, multiplications and divisions of one evaluation of the four functions, calls are of
sine and cosine, one for both of an angle; what depends on parameters alone is computed once, before, and not counted,
for SymPy too: its parameters' subexpressions are left out. Bytes are those of the functions' bodies without comments and
leading blanks. Needs SymPy, in this Python or in the environment of run.py.
"""

import argparse
import json
import os
import re
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
TARGET = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target"))
LIMIT = 300
FAMILIES = ["chain", "phases"]
COLUMNS = "| family | n | seconds | operations | calls | bytes | SymPy: seconds | operations | calls | bytes |"


def model(family, n, folder):
    path = Path(folder) / f"{family}{n}.yaml"
    script = [sys.executable, str(ROOT / "tests/bench/models.py"), family, str(n)]
    path.write_text(subprocess.run(script, check=True, capture_output=True, text=True).stdout)
    return path


def pebo(*arguments):
    """Output of pebo-gen and the processor's time; none where it refuses."""
    tool = os.environ.get("PEBO_GEN", str(TARGET / "release/pebo-gen"))
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    ran = subprocess.run([tool, *arguments, "--limit", str(LIMIT)], capture_output=True, text=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    took = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return (ran.stdout, took) if ran.returncode == 0 else (None, took)


def emitted(path):
    """Seconds, operations, calls and bytes of our module."""
    code = path.with_suffix(".rs")
    out, took = pebo(str(path), "-o", str(code))
    if out is None:
        return f"{took:.2f} | refused | |"
    text = code.read_text()
    operations = calls = size = 0
    for name in ("terms", "flow", "regression", "recover"):
        row = re.search(rf"^//! \| `{name}`[^|]*\| ([^|]*) \|", text, re.M)
        for count, kind in re.findall(r"(\d+) (\w+)", row[1] if row else ""):
            calls += int(count) * (kind == "call")
            operations += int(count) * (kind != "call")
        body = re.search(rf"^    fn {name}\((?:.|\n)*?^    \}}$", text, re.M)
        size += sum(len(line.strip()) + 1 for line in body[0].splitlines()) if body else 0
    return f"{took:.2f} | {operations} | {calls} | {size}"


def formulas(path):
    """The formulas that were derived, and the names of the parameters."""
    out, _ = pebo("check", str(path), "--format", "json")
    if out is None:
        return None
    report = json.loads(out)
    regression = report["regression"]
    found = report["cascade"]["h"] + regression["phi_0"] + [entry for row in regression["phi_1"] for entry in row]
    found += list(report["left_inverse"]["x"].values())
    parameters = re.search(r"^parameters: \[(.*)\]$", path.read_text(), re.M)[1]
    return {"formulas": found, "parameters": parameters.split(", ")}


def by_sympy(task):
    """Seconds, operations, calls and bytes of what SymPy's cse makes of formulas; in a process of its own."""
    import sympy
    from sympy.parsing.sympy_parser import parse_expr

    names = set(re.findall(r"[A-Za-z_]\w*", " ".join(task["formulas"]))) - {"sin", "cos", "sqrt", "exp", "log", "atan2"}
    symbols = {name: sympy.Symbol(name) for name in names}
    exprs = [parse_expr(formula.replace("^", "**"), local_dict=symbols) for formula in task["formulas"]]
    start = time.process_time()
    shared, results = sympy.cse(exprs, optimizations="basic")
    lines = [f"{name} = {sympy.ccode(value)};" for name, value in shared]
    lines += [f"out[{index}] = {sympy.ccode(value)};" for index, value in enumerate(results)]
    took = time.process_time() - start
    fixed = {symbols[name] for name in task["parameters"] if name in symbols}
    running = []
    for name, value in shared:
        if value.free_symbols <= fixed:
            fixed.add(name)
        else:
            running.append(value)
    calls = {call.args[0] for value in running + results for call in value.atoms(sympy.sin, sympy.cos)}
    functions = sum(len(value.atoms(sympy.Function)) for value in running + results)
    operations = sum(int(sympy.count_ops(value)) for value in running + results) - functions
    size = sum(len(line) + 1 for line in lines)
    print(f"{took:.2f} | {operations} | {len(calls)} | {size}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("family", nargs="?", choices=FAMILIES, help="both unless one is named")
    parser.add_argument("first", nargs="?", type=int, default=2, help="the smallest n")
    parser.add_argument("last", nargs="?", type=int, default=8, help="the largest n")
    asked = parser.parse_args()
    families = [asked.family] if asked.family else FAMILIES
    if "PEBO_GEN" not in os.environ:
        subprocess.run(["cargo", "build", "--release", "--quiet", "-p", "pebo-gen"], check=True, cwd=ROOT)
    print(COLUMNS + "\n|" + "---|" * 10)
    with tempfile.TemporaryDirectory() as folder:
        for family in families:
            for n in range(asked.first, asked.last + 1):
                path = model(family, n, folder)
                ours, task = emitted(path), formulas(path)
                theirs = " | | |"
                if task:
                    command = [sys.executable, __file__, "--sympy"]
                    try:
                        ran = subprocess.run(
                            command, input=json.dumps(task), capture_output=True, text=True, timeout=LIMIT, check=True
                        )
                        theirs = ran.stdout.strip()
                    except subprocess.TimeoutExpired:
                        theirs = f"over {LIMIT} | | |"
                print(f"| {family} | {n} | {ours} | {theirs} |", flush=True)


if __name__ == "__main__":
    if sys.argv[1:] == ["--sympy"]:
        by_sympy(json.load(sys.stdin))
    else:
        main()

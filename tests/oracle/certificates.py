"""Certificates prove, and fail when a claim is falsified: `certificates.py SCRIPT..` runs each script that
`pebo-gen certificate` wrote as its user would, and then with one term of one claim changed, for each claim in turn.

Exit status 0 if every script proves all of its claims and every changed one finds the false claim, else 1.
"""

import concurrent.futures
import contextlib
import copy
import io
import runpy
import subprocess
import sys
import time


def falsified(plant, derived):
    """Names of claims, each with what was derived but for one term of it, and how a false line begins."""

    def changed(change):
        copied = copy.deepcopy(derived)
        change(copied)
        return copied

    y, z = plant["y"][0], derived["z"][0]
    extension = (derived["extension"].get("chi") or derived["extension"]["xi"])[0]

    def h(d):
        d["h"][0] += f" + {y}/1000"

    def hidden(d):
        d["h"][0] += f" + {plant['x'][0]} - {plant['x'][0]}^2"

    def phi_left(d):
        state = next(iter(d["phi_left"]))
        d["phi_left"][state] += f" + {z}/1000"

    def phi_0(d):
        d["phi_0"][0] += f" + {extension}^2"

    def phi_1(d):
        d["phi_1"][0][0] += " + 1/1000"

    def blind(d):
        # A regressor that is nowhere of full rank, and a regression that holds all the same.
        for side in ("phi_1", "primitive_1"):
            for row in d.get(side, []):
                row[-1] = "0"

    yield "h", changed(h), "cascade: z1'"
    yield "h free of x", changed(hidden), "h and Lambda are free of x"
    yield "phi_left", changed(phi_left), "left inverse:"
    yield "phi_0", changed(phi_0), "regression: row 1"
    yield "phi_1", changed(phi_1), "regression: row 1"
    yield "identifiability", changed(blind), "identifiability:"


def look(script):
    """What there is to say of a script, and how many of its claims are not as they must be."""
    start = time.process_time()
    run = subprocess.run([sys.executable, script], capture_output=True, text=True)
    if run.returncode != 0:
        return f"{script}: exit {run.returncode}\n{run.stdout}{run.stderr}", 1
    module = runpy.run_path(script)
    caught, missed = [], []
    for name, derived, line in falsified(module["PLANT"], module["DERIVED"]):
        said = io.StringIO()
        with contextlib.redirect_stdout(said):
            verdict = module["Certificate"](module["PLANT"], derived).prove()
        false = [text for text in said.getvalue().splitlines() if " FALSE" in text]
        if verdict == 2 and any(text.startswith(line) for text in false):
            caught.append(name)
        else:
            missed.append(f"{script}: a false {name} was not found\n{said.getvalue()}")
    took = time.process_time() - start
    return "\n".join([*missed, f"{script}: proved; false {', '.join(caught)} found ({took:.1f} s)"]), len(missed)


def main(scripts):
    failures = 0
    with concurrent.futures.ProcessPoolExecutor() as processes:
        for said, failed in processes.map(look, scripts):
            print(said, flush=True)
            failures += failed
    print(f"{len(scripts) - failures} certificates hold" if failures == 0 else f"{failures} failures")
    return failures != 0 or not scripts


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

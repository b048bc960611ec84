"""Certificates prove, and fail when a claim is falsified: `certificates.py SCRIPT..` runs each script that
`pebo-gen certificate` wrote as its user would, and then with one term of one claim changed, for each claim in turn; so
also for what is said of trajectories, where the script met points of them.

Exit status 0 if every script proves all of its claims and every changed one finds the false claim, else 1.
"""

import concurrent.futures
import contextlib
import copy
import io
import re
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


def on_trajectories(derived, said):
    """The same of statements on trajectories that were looked at."""
    unknowns = derived["z"]
    if list(derived["eta"].values()) != derived["theta"]:
        unknowns = list(derived["eta"])

    def changed(change):
        copied = copy.deepcopy(derived)
        change(copied.setdefault("trajectories", {}))
        return copied

    motion = derived.get("trajectories", {})
    if derived["identifiability"] == "excitation":
        instant = copy.deepcopy(derived) | {"identifiability": "instant"}
        instant.pop("trajectories", None)
        yield "instant", instant, "identifiability: instant"
    if motion.get("by itself") is False:
        yield "constant inputs", changed(lambda m: m.update({"by itself": True})), "identified with constant inputs"
    for place, entry in enumerate(motion.get("blind", [])):
        line = f"while {entry['while']}"
        if not any(text.startswith(line) and " holds at " in text for text in said.splitlines()):
            continue

        def fewer(m):
            m["blind"][place]["hidden"].pop()

        def other(m):
            # Another entry along an unknown that this combination holds.
            name = re.search("|".join(map(re.escape, unknowns)), entry["identified"][0])[0]
            m["blind"][place]["hidden"][0][unknowns.index(name)] += " + 1"

        def combination(m):
            # An unknown that moves along a direction.
            moved = next(name for name, part in zip(unknowns, entry["hidden"][0]) if part != "0")
            m["blind"][place]["identified"][0] += f" + {moved}"

        yield "number of directions", changed(fewer), line
        if "identified" in entry:
            yield "direction", changed(other), line
            yield "combination", changed(combination), line
        if entry.keys() & {"rest", "zero", "positive", "constant"} == {"rest"}:

            def at_rest(m):
                m["at rest"] = True
                del m["blind"][place]

            yield "rest", changed(at_rest), "identified at rest"
        if entry.keys() & {"rest", "zero", "positive", "constant"} == {"positive"}:

            def everywhere(m):
                del m["blind"][place]

            yield "cell", changed(everywhere), "identifiability: "


def look(script):
    """What there is to say of a script, and how many of its claims are not as they must be."""
    start = time.process_time()
    run = subprocess.run([sys.executable, script], capture_output=True, text=True)
    if run.returncode != 0:
        return f"{script}: exit {run.returncode}\n{run.stdout}{run.stderr}", 1
    module = runpy.run_path(script)
    caught, missed = [], []
    whole = [(*case, ["prove"]) for case in falsified(module["PLANT"], module["DERIVED"])]
    # These are looked at alone: the other claims are as they were.
    motion = [(*case, ["identifiability", "trajectories"]) for case in on_trajectories(module["DERIVED"], run.stdout)]
    for name, derived, line, claims in whole + motion:
        said = io.StringIO()
        certificate = module["Certificate"](module["PLANT"], derived)
        with contextlib.redirect_stdout(said):
            for claim in claims:
                getattr(certificate, claim)()
        verdict = certificate.worst
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

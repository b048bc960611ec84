"""Checks verdicts on random plants with non-smooth functions, whose truth is known by construction.

    python3 tests/oracle/cells.py target/release/pebo-gen 300 [SEED] [--show]

A plant is drawn as `z' = Lambda z + h`, with outputs that show z by their rates, by their values, or divided by z. Then
its states are changed by piecewise linear maps and reciprocals, with thresholds that are parameters or outputs. False
plants break one claim, often in one cell only, which is where all arguments of abs, max and the like keep their signs: a
rate that keeps a state, a transform that folds, jumps or forgets, a left inverse of one cell, a rate with a kink in z,
an unknown that no cell shows. Half of them assume that the cell is not met, and are true. Looked at, by exact power
series along trajectories from random rational points, one in each cell:

- the construction: a claim is true if its formulas hold in every cell, false by points with the same y, u, parameters;
- a claim that is proved is not false where the conditions hold, and one that is refuted is not true;
- the formulas of the answer: h, Lambda, the left inverse and the regression;
- what it says of cells and constant inputs: the rank is full where none is listed, and as low as said where one is.

Exits with 1 on a wrong statement, which it prints with the plant. Prints the verdicts of each kind of plant, and what
is true and undecided by the program's reason; `--show` prints these plants too.
"""

import json
import re
import subprocess
import sys
import tempfile
from collections import Counter, defaultdict
from fractions import Fraction
from pathlib import Path

from cell_plants import Plant
from series import NoValue, coefficients, flow, holds, number, rank, total, value, zero

CLAIMS = ("cascade", "left_inverse", "regression", "identifiability")


class Truth:
    """What is true of a plant, by a point in each of its cells."""

    def __init__(self, plant):
        self.plant, cells, self.points = plant, set(), []
        for _ in range(70):
            names = len(self.points) < 14 and plant.trajectory(wanted=lambda cell: cell not in cells)
            if names:
                cells.add(names["cell"])
                self.points.append(names)
        self.zs = [f"z{i + 1}" for i in range(plant.n)]
        self.wrong = {claim: [p for p in self.points if not self.shown(claim, p)] for claim in CLAIMS[:3]}
        self.claims = {claim: self.claim(claim) for claim in CLAIMS[:3]}
        known = self.points and self.claims["regression"] and self.claims["cascade"]
        self.ranks = [coefficients(plant.rows, plant.lam, p, plant.n) for p in self.points] if known else None
        self.claims["identifiability"] = self.identified() if known else None

    def identified(self):
        """In one cell or in several with the same parameters; never, if what no row of any cell sees stays so."""
        plant = self.plant
        if any(rank(rows) == plant.n for rows in self.ranks):
            return True
        known = []  # The rows of several cells with the same parameters, and Lambda there.
        for first in self.points[:4]:
            near = [first] + [p for p in (plant.trajectory({"p": first["p"]}) for _ in range(20)) if p]
            rows = [row for p in near for row in coefficients(plant.rows, plant.lam, p, plant.n)]
            known.append((rows, [[[value(t, p).terms[0] for t in row] for row in plant.lam] for p in near]))
        if any(rank(rows) == plant.n for rows, _ in known):
            # They add up if Psi is the identity.
            return True if all(k == "0" for row in plant.lam for k in row) else None
        moved = lambda row, lam: [sum(a * b[j] for a, b in zip(row, lam)) for j in range(plant.n)]
        stays = all(rank(rows) == rank(rows + [moved(row, lam) for row in rows]) for rows, lams in known for lam in lams)
        return False if stays else None

    def shown(self, claim, names):
        """Whether the formulas of the construction hold along a trajectory."""
        plant = self.plant
        affine = lambda row: total(value(k, names) * names[z] for k, z in zip(row[1:], self.zs)) + value(row[0], names)
        try:
            if claim == "cascade":
                return all(zero(names[z].rate() - affine([h, *row])) for z, h, row in zip(self.zs, plant.h, plant.lam))
            if claim == "left_inverse":
                return all(zero(value(f, names) - names[x]) for x, f in (plant.given or plant.left).items())
            return all(zero(affine(row)) for row in plant.rows)
        except NoValue:
            return False

    def claim(self, claim):
        wrong = self.wrong[claim]
        if not wrong:
            return True if self.points else None
        show = (lambda p: self.plant.given or self.collides(p)) if claim == "left_inverse" else lambda p: self.curved(claim, p)
        self.wrong[claim] = [p for p in wrong if show(p)]
        return False if self.wrong[claim] and (claim != "regression" or self.plant.kink) else None

    def curved(self, claim, names):
        """With these outputs, inputs and parameters, what is claimed is no affine function of z, by its values."""
        fixed = {k: number(names[k].terms[0]) for k in ["p", "v", *self.plant.y]}
        far = lambda: {x: number(Fraction(self.plant.draw.randint(-1999, 1999), 202)) for x in self.plant.x}
        found = [p for p in (self.plant.trajectory(fixed | far()) for _ in range(4 * self.plant.n + 12)) if p]
        known = [[Fraction(1), *(p[z].terms[0] for z in self.zs)] for p in found]
        rates = self.zs if claim == "cascade" else self.plant.y
        return bool(found) and any(rank([[*k, p[r].terms[1]] for k, p in zip(known, found)]) > rank(known) for r in rates)

    def collides(self, names):
        """Other values of the states in the domain have the same transform as those here."""
        plant = self.plant
        fixed = {k: number(names[k].terms[0]) for k in ["p", "v", *plant.x, *plant.y]}
        others = [fixed | {"a": fixed["b"], "b": fixed["a"]}] if plant.n == 2 else []
        for x in plant.x:
            a = names[x].terms[0]
            walls = [value(t, fixed).terms[0] for t in {"1", plant.threshold}]
            places = [w + k * (w - a) for w in walls for k in (1, 3, Fraction(1, 3))] + [a + Fraction(1, 9), a - Fraction(1, 9)]
            others += [fixed | {x: number(place)} for place in places if place != a]
        same = lambda other: all(zero(value(f, other) - number(names[z].terms[0])) for f, z in zip(plant.phi, self.zs))
        return any(all(holds(c, other) for c in plant.assume) and same(other) for other in others)


class Answer:
    """What the program says of a plant, beside the truth."""

    def __init__(self, plant, truth, said, text):
        self.plant, self.truth, self.said, self.text = plant, truth, said, text
        self.looked, self.wrong = Counter(), []

    def look(self):
        for claim in [] if self.plant.search else CLAIMS:
            self.of_claim(claim, self.said[claim]["verdict"], self.truth.claims[claim])
        if self.said["verdict"] == "rejected" and all(self.truth.claims.values()):
            self.wrong.append("UNSOUND: rejected, but all is true")
        if self.said["verdict"] == "accepted" and self.plant.jumps and "jumps" not in self.text:
            self.wrong.append("z jumps, and the answer does not say so")
        for names in filter(self.admits, self.truth.points if self.said["phi"] else ()):
            try:
                self.of_formulas({k: s for k, s in names.items() if not re.match(r"z\d", k)})
                self.looked["point at which formulas were looked at"] += 1
            except NoValue:
                self.looked["point at which a formula has no value"] += 1
            except NameError as missing:
                self.looked[f"formula that was not read: {missing}"] += 1
        if self.said["identifiability"]["verdict"] == "proved" and self.truth.ranks and not self.plant.search:
            self.of_cells(self.said["identifiability"])
        return list(dict.fromkeys(self.wrong))

    def admits(self, names):
        try:
            return all(holds(c, names) for c in self.said["conditions"])
        except NoValue:
            return False

    def of_claim(self, claim, said, true):
        word = {True: "true", False: "false", None: "open"}[true]
        self.looked[f"{claim}: {said}, {word}"] += 1
        if said == "refuted" and true:
            self.wrong.append(f"UNSOUND: {claim} refuted, but it is true")
        if said == "proved" and true is False:
            # Conditions may leave out the points where it is false.
            inside = any(self.admits(p) for p in self.truth.wrong.get(claim, self.truth.points))
            self.looked[f"{claim} that is false where a condition fails"] += not inside
            self.wrong += [f"UNSOUND: {claim} proved, but it is false"] if inside else []

    def of_formulas(self, names):
        """The formulas of the answer along a trajectory, from a random start of the dynamic extension."""
        cascade, regression = self.said["cascade"], self.said["regression"]
        if cascade["verdict"] != "proved":
            return
        z = [value(f, names) for f in self.said["phi"]["z"]]
        n, letter = len(z), "xi" if cascade["lambda"] else "chi"
        lam, h = cascade["lambda"] or [["0"] * n for _ in z], cascade["h"]
        along = lambda i, of, names: total(value(lam[i][j], names) * of(j) for j in range(n))
        if not all(zero(z[i].rate() - value(h[i], names) - along(i, z.__getitem__, names)) for i in range(n)):
            self.wrong.append("UNSOUND: z' is not as stated")
        if self.said["left_inverse"]["verdict"] == "proved":
            with_z = names | {f"z{i + 1}": s for i, s in enumerate(z)}
            if not all(zero(value(f, with_z) - names[x]) for x, f in self.said["left_inverse"]["x"].items()):
                self.wrong.append("UNSOUND: the left inverse is not as stated")
        if regression["verdict"] != "proved":
            return
        start = {f"{letter}{i + 1}": Fraction(self.plant.draw.randint(-90, 90), 31) for i in range(n)}
        names |= {f"theta{i + 1}": number(s.terms[0] - c) for i, (s, c) in enumerate(zip(z, start.values()))}
        start |= {f"Psi{i + 1}{j + 1}": int(i == j) for i in range(n) for j in range(n)}
        def rates(names):
            of = lambda name, last: lambda j: names[f"{name}{j + 1}{last}"]
            found = {f"{letter}{i + 1}": value(h[i], names) + along(i, of(letter, ""), names) for i in range(n)}
            columns = range(1, n + 1)
            return found | {f"Psi{i + 1}{k}": along(i, of("Psi", k), names) for i in range(n) for k in columns}
        names = flow(names, start, rates)
        eta = [value(e, names) for e in regression["eta"]]
        known = lambda rows: [total(value(k, names) * e for k, e in zip(row, eta)) for row in rows]
        side = lambda first, rows: [value(k, names) + s for k, s in zip(first, known(rows))]
        first, rows = regression["phi_0"], regression["phi_1"]
        if regression["primitive_0"]:
            primitive = side(regression["primitive_0"], regression["primitive_1"])
            good = all(zero(a.rate() - b) for a, b in zip(primitive, side(first, rows)))
        elif regression["kind"] == "static":
            good = all(zero(value(a, names) - b) for a, b in zip(first, known(rows)))
        else:
            good = all(any(zero(s - names[f"rate_{y}"]) for y in self.plant.y) for s in side(first, rows))
        self.wrong += [] if good else ["UNSOUND: the regression does not hold"]

    def of_cells(self, found):
        plant, n = self.plant, self.plant.n
        listed = [(entry["while"].split(" and "), entry["hidden"]) for entry in found["blind"]]
        # A cell holds on a set with inner points; an equation, a constant and rest do not.
        is_cell = lambda parts: all(re.search(r" [<>] ", part) for part in parts)
        covers = lambda parts, names: all(holds(p, names) for p in parts if not re.search("rests|constant$", p))
        excepted = lambda names: any(holds(condition, names) for condition in found["singular_where"])
        for names in filter(self.admits, self.truth.points):
            rows = coefficients(plant.rows, plant.lam, names, n)
            here = {k: f"{float(names[k].terms[0]):.3f}" for k in [*plant.x, *plant.y, "v", "p"]}
            cells = [(parts, hidden) for parts, hidden in listed if is_cell(parts) and covers(parts, names)]
            self.looked[f"point, {found['kind']}" + (", in a listed cell" if cells else "")] += 1
            # A rate of an output that multiplies an unknown says what the derivative of a relation does.
            at_once = len(plant.rows) * (2 if self.said["regression"]["kind"] == "implicit" else 1)
            if found["kind"] == "instant" and rank(rows[:at_once]) < n:
                self.looked["cell that an equation lists, as it holds in all of it"] += excepted(names)
                self.wrong += [] if excepted(names) else [f"UNSOUND: instant, but of a lower rank at {here}"]
            # A point that was drawn may lie on a wall that is listed.
            is_listed = any(covers(parts, names) for parts, _ in listed)
            if found["kind"] == "excitation" and rank(rows) < n and not is_listed:
                self.wrong.append(f"UNSOUND: identified, but not at {here}, which nothing that is listed covers")
            for parts, hidden in cells if self.said["regression"]["eta"] == [f"theta{i + 1}" for i in range(n)] else ():
                try:
                    directions = [[value(e, names).terms[0] for e in direction] for direction in hidden]
                except (NoValue, NameError):
                    self.looked["direction that was not read"] += 1
                    continue
                if not directions:
                    self.looked["point in a cell that was not decided"] += 1
                elif rank(rows) > n - len(directions):
                    self.wrong.append(f"UNSOUND: called hidden while {parts}, but identified at {here}")
                if any(sum(a * b for a, b in zip(row, d)) for row in rows[: len(plant.rows)] for d in directions):
                    self.wrong.append(f"UNSOUND: called hidden while {parts}, but seen at {here}")
        special = [number(k) for k in ("0", "1", "-1", "1/2")] + [None] * 8
        for fixed in special if found["kind"] == "instant" or found["by_itself"] is True else ():
            names = plant.trajectory({"v": fixed} if fixed else (), still=True)
            if not names or not self.admits(names):
                continue
            rows = coefficients(plant.rows, plant.lam, names, n)
            here = {k: f"{float(names[k].terms[0]):.3f}" for k in [*plant.x, *plant.y, "v", "p"]}
            if found["kind"] == "instant":
                self.looked["point with a special input, instant"] += found["everywhere_else"] and bool(fixed)
                at_once = len(plant.rows) * (2 if self.said["regression"]["kind"] == "implicit" else 1)
                if found["everywhere_else"] and rank(rows[:at_once]) < n and not excepted(names):
                    self.wrong.append(f"UNSOUND: instant everywhere else, but of a lower rank at {here}")
            elif not fixed or found["blind_complete"]:
                self.looked["point with a constant input" + (", a special one" if fixed else "")] += 1
                # An input that was drawn may be at a value that is listed.
                of_values = lambda parts: fixed or is_cell(parts) or any(" = " in part for part in parts)
                if rank(rows) < n and not any(covers(parts, names) for parts, _ in listed if of_values(parts)):
                    self.wrong.append(f"UNSOUND: identified with constant inputs, but not at {here}")


def reason(said):
    """Why a plant is not accepted, in the program's first words."""
    for found in said["diagnostics"]:
        if found["severity"] == "error":
            notes = [note for note in found["notes"] if "obstacle" in note] or [found["message"]]
            words = re.sub(r"`[^`]*`|\d+", "..", notes[0].replace("obstacle: ", ""))
            return f"{found['code']}: {' '.join(words.split()[:8])}"
    return "no reason"


def main():
    arguments = [a for a in sys.argv[1:] if a != "--show"]
    program, count, first = arguments[0], int(arguments[1]), int((arguments + ["1"])[2])
    verdicts, reasons, looked, bad = defaultdict(Counter), Counter(), Counter(), 0
    for seed in range(first, first + count):
        plant = Plant(seed)
        truth = Truth(plant)
        if not truth.points:
            looked["plant without a point of its domain"] += 1
            continue
        plant.search &= all(truth.claims.values())
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder, "model.yaml")
            path.write_text(plant.text())
            ask = lambda *options: [program, "check", *options, path]
            call = lambda *options: subprocess.run(ask(*options), capture_output=True, text=True, timeout=120)
            said = call("--format", "json")
            text = call().stdout if plant.jumps else ""
        try:
            answer = Answer(plant, truth, json.loads(said.stdout), text)
            wrong = answer.look()
        except json.JSONDecodeError:
            print(f"no answer, seed {seed}: {said.stderr[-300:]}\n{plant.text()}")
            bad += 1
            continue
        looked += answer.looked
        expected = [c for c in CLAIMS[:3] if truth.claims[c] is (c in plant.false)]
        wrong += [f"the script: {expected} not as constructed"] if expected else []
        if wrong:
            bad += 1
            print(f"seed {seed}, {plant.kind}: " + "\n  ".join(wrong[:4]) + f"\n{plant.text()}")
        true = "true" if all(truth.claims.values()) else "false" if False in truth.claims.values() else "open"
        kind, verdict = plant.kind + (", searched" if plant.search else ""), answer.said["verdict"]
        verdicts[f"{true}: {kind}"][verdict] += 1
        verdicts[f"all that is {true}"][verdict] += 1
        if verdict == "undecided" and true == "true":
            reasons[f"{reason(answer.said)} | {kind}"] += 1
        if (verdict == "undecided" or true == "open") and "--show" in sys.argv:
            print(f"{verdict}, seed {seed}, {true}: {kind}: {reason(answer.said)}\n{plant.text()}")
    for kind, found in sorted(verdicts.items()):
        print(f"{kind}: " + ", ".join(f"{times} {verdict}" for verdict, times in sorted(found.items())))
    print(*[f"{times:6} undecided: {kind}" for kind, times in reasons.most_common()], sep="\n")
    print(*[f"{times:6} {kind}" for kind, times in sorted(looked.items()) if times], sep="\n")
    print(f"{count} plants, {bad} with a wrong statement")
    sys.exit(bad > 0)


if __name__ == "__main__":
    main()

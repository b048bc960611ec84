"""A row of a table: one job, all systems in turn, medians, and ratios to ours."""
from statistics import median

# Repetitions of what is short, of the rest, and where the border is (in seconds).
MANY, FEW, BORDER = 20, 5, 0.5


def best_recipe(system, job, timeout):
    """The recipe that proves the job fastest, all tried once; why there is none is the last's answer."""
    best, seconds, why = None, timeout, ""
    for recipe in system.recipes:
        # Nothing that takes much longer than what is known would be chosen.
        answer = system.ask(job, recipe, "proof", min(timeout, 2 * seconds + 1) if best else timeout)
        if isinstance(answer, float):
            if best is None or answer < seconds:
                best, seconds = recipe, answer
        elif answer != "nothing by hand":
            why = answer if why == "" or "no answer" in answer else why
    return best, seconds if best is not None else why


def measure(askers, timeout):
    """Times of every system, in turn. `askers` maps names to functions that give seconds or a reason."""
    times = {name: [] for name in askers}
    failed = {}
    repetitions = {}
    for name, ask in askers.items():
        answer = ask(timeout)  # warms up
        if isinstance(answer, float):
            repetitions[name] = MANY if answer < BORDER else FEW
        else:
            failed[name] = answer
    for turn in range(max(repetitions.values(), default=0)):
        for name, count in repetitions.items():
            if turn < count and name not in failed:
                answer = askers[name](timeout)
                if isinstance(answer, float):
                    times[name].append(answer)
                else:
                    failed[name] = answer
    return {name: failed.get(name) or median(times[name]) for name in askers}


def show(title, head, rows, notes=()):
    """Prints a table: the first system is ours, the others with their ratio to it."""
    print(f"\n{title}\n")
    lines = [["", *head]]
    for name, results in rows:
        ours = results.get(head[0])
        lines.append([name, *(_cell(results.get(system), None if system == head[0] else ours) for system in head)])
    widths = [max(len(line[column]) for line in lines) for column in range(len(lines[0]))]
    for line in lines:
        print("  ".join(cell.ljust(width) for cell, width in zip(line, widths)).rstrip())
    for note in notes:
        print(f"  {note}")
    print(flush=True)


def _cell(result, ours):
    if result is None:
        return "-"
    if not isinstance(result, float):
        return result
    ratio = f" ({_figures(result / ours)}x)" if isinstance(ours, float) else ""
    return _figures(result * 1e3) + " ms" + ratio


def _figures(value):
    """Three figures, no exponent."""
    if value >= 100:
        return f"{value:.0f}"
    return f"{value:.1f}" if value >= 10 else f"{value:.2f}" if value >= 0.1 else f"{value:.3f}"

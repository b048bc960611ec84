"""What every rival in Python speaks: one job a line in, one time a line out.

In (JSON): {"job": path, "recipe": name, "part": "proof" or "check"}. Out: {"seconds": s} or {"failed": why}. The
operands are made anew for every answer and not timed, so that nothing is remembered from the last one. A proof is
timed alone, a check with the derivatives that make what is proved. `--once JOB RECIPE` does the job and exits, for
times of a whole process. All times are of the processor: on a busy machine the clock counts others' work.
"""
import json
import sys
import time

# A faster job is done once more before it is timed, with other operands: the caches have served other processes.
SHORT = 0.02


class Failed(Exception):
    """The reason that there is no time."""


def by_hand(job):
    """The job as a person prepares it, if one did."""
    if "by_hand" not in job:
        raise Failed("nothing by hand")
    return job["by_hand"]


def proved(answer):
    """Fails unless the proof is there."""
    if not answer:
        raise Failed("finds no proof")


def right(answer):
    """Fails unless a result is what it must be."""
    if not answer:
        raise Failed("WRONG")


def serve(prepare):
    """`prepare(job, recipe, part)` makes operands and returns the work, which returns the check of its result."""

    def answer(path, recipe, part, last):
        with open(path, encoding="utf-8") as file:
            job = json.load(file)
        if last < SHORT:
            prepare(job, recipe, part)()()
        work = prepare(job, recipe, part)
        start = time.process_time()
        check = work()
        seconds = time.process_time() - start
        check()
        return {"seconds": seconds}

    if sys.argv[1:2] == ["--once"]:
        with open(sys.argv[2], encoding="utf-8") as file:
            prepare(json.load(file), sys.argv[3], "check")()()
        sys.exit()
    last = {}
    for line in sys.stdin:
        request = json.loads(line)
        key = (request["job"], request["recipe"], request["part"])
        try:
            reply = answer(*key, last.get(key, 0))
        except Failed as why:
            reply = {"failed": str(why)}
        except Exception as error:  # a rival that cannot do a job is a row of the table, not the end of the run
            reply = {"failed": f"{type(error).__name__}: {error}"[:80]}
        last[key] = reply.get("seconds", 1)
        print(json.dumps(reply), flush=True)

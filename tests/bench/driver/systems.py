"""The systems that are compared: a process each that answers jobs with times, ended where it takes too long."""
import json
import os
import resource
import select
import subprocess

FOREVER = "no answer in {:.0f} s"


class System:
    """A system, its recipes for proofs in the order they are tried, and its process."""

    def __init__(self, name, command, recipes=("",), environment=None):
        self.name, self.command, self.recipes = name, command, recipes
        self.environment = {**os.environ, **(environment or {})}
        self.process = None

    def ask(self, job, recipe, part, timeout):
        """Seconds, or why there is no time."""
        if self.process is None:
            self.process = subprocess.Popen(self.command, stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                                            stderr=subprocess.DEVNULL, env=self.environment)
        request = json.dumps({"job": job, "recipe": recipe, "part": part}) + "\n"
        try:
            self.process.stdin.write(request.encode())
            self.process.stdin.flush()
        except BrokenPipeError:
            self.close()
            return "ended"
        # One line is one answer, so nothing is left in a buffer when the next request goes out.
        ready, _, _ = select.select([self.process.stdout], [], [], timeout)
        if not ready:
            self.close()
            return FOREVER.format(timeout)
        line = self.process.stdout.readline()
        if not line:
            self.close()
            return "ended"
        reply = json.loads(line)
        return reply.get("seconds", reply.get("failed"))

    def whole(self, job, recipe, timeout):
        """Seconds of a process that does this one job, or why there is no time."""
        return whole([*self.command, "--once", job, recipe], timeout, self.environment)

    def close(self):
        if self.process is not None:
            self.process.kill()
            self.process.wait()
            self.process = None


def whole(command, timeout, environment=None, decided=(0,)):
    """Seconds of processor time that a command takes from start to end, or why there is no time."""
    before = _of_children()
    try:
        done = subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, timeout=timeout,
                              env=environment)
    except subprocess.TimeoutExpired:
        return FOREVER.format(timeout)
    seconds = _of_children() - before
    return seconds if done.returncode in decided else "finds no proof"


def _of_children():
    """Processor time of the processes that have ended; those that answer jobs have not."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime

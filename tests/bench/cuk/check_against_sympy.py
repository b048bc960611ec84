"""Whole-process time of `pebo-gen check models/cuk.yaml` beside the same job in SymPy.

Run from the project's root after `cargo build --release`; needs SymPy in the Python that runs this.
Both are timed in turn in one run; printed are the medians and the median of the ratios.
"""
import os
import statistics
import subprocess
import sys
import time

RUNS = 20
TARGET = os.environ.get("CARGO_TARGET_DIR", "target")
OURS = [f"{TARGET}/release/pebo-gen", "check", "models/cuk.yaml"]
THEIRS = [sys.executable, "tests/bench/cuk/in_sympy.py"]


def seconds(command):
    start = time.perf_counter()
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    return time.perf_counter() - start


for command in (OURS, THEIRS):
    seconds(command)  # warms the file cache
pairs = [(seconds(OURS), seconds(THEIRS)) for _ in range(RUNS)]
ours, theirs = zip(*pairs)
print(f"pebo-gen  median {statistics.median(ours) * 1e3:8.2f} ms  ({min(ours) * 1e3:.2f} to {max(ours) * 1e3:.2f})")
print(f"SymPy     median {statistics.median(theirs) * 1e3:8.2f} ms  ({min(theirs) * 1e3:.2f} to {max(theirs) * 1e3:.2f})")
print(f"ratio     median {statistics.median(b / a for a, b in pairs):8.1f}")

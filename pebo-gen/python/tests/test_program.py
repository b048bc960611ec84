"""The program that the wheel brings."""

from __future__ import annotations

import pathlib
import signal
import subprocess
import sys
import time

import pytest
from conftest import MODELS, program

import pebo


def test_it_has_the_version_of_the_module():
    said = program("--version")
    assert (said.returncode, said.stdout, said.stderr) == (0, f"pebo-gen {pebo.__version__}\n", "")


def test_its_exit_status_is_the_verdict(cuk, tmp_path):
    said = program("check", cuk)
    assert said.returncode == 0 and said.stdout.startswith("cuk: accepted") and not said.stderr
    assert program("check", MODELS / "induction_motor.yaml", "--limit", "0.01").returncode == 1
    wrong = program("check", tmp_path / "none.yaml")
    assert wrong.returncode == 2 and "cannot read" in wrong.stderr and not wrong.stdout
    assert program("checks").returncode == 2
    module = subprocess.run([sys.executable, "-m", "pebo", "--version"], capture_output=True, text=True, check=True)
    assert module.stdout == program("--version").stdout


def test_a_reader_that_goes_away_is_no_error(cuk):
    installed = pathlib.Path(sys.executable).parent / "pebo-gen"
    piped = subprocess.run(
        f"'{installed}' '{cuk}' 2> /dev/null | head -n 1", shell=True, capture_output=True, text=True, check=True
    )
    assert len(piped.stdout.splitlines()) == 1 and not piped.stderr


@pytest.mark.skipif(sys.platform == "win32", reason="signals of Unix")
def test_an_interrupt_ends_it(cuk):
    installed = pathlib.Path(sys.executable).parent / "pebo-gen"
    running = subprocess.Popen([str(installed), "simulate", str(cuk), "--step", "1e-8"], stderr=subprocess.DEVNULL)
    time.sleep(1)
    running.send_signal(signal.SIGINT)
    assert running.wait(timeout=5) == -signal.SIGINT


@pytest.mark.skipif(sys.platform == "win32", reason="signals of Unix")
def test_an_interrupt_ends_a_calculation(cuk):
    script = f"import pebo\nr = pebo.check({str(cuk)!r})\nprint('begun', flush=True)\nr.simulate(step=1e-8)\n"
    running = subprocess.Popen(
        [sys.executable, "-c", script], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    assert running.stdout.readline() == "begun\n"
    time.sleep(0.5)
    running.send_signal(signal.SIGINT)
    _, said = running.communicate(timeout=5)
    assert "KeyboardInterrupt" in said and "panic" not in said

"""Closed loops and recorded data as columns."""

from __future__ import annotations

import csv
import threading
import time

import numpy
import pytest
from conftest import MODELS, program

import pebo


def table(path):
    with open(path, newline="") as file:
        names, *rows = csv.reader(file)
    cells = numpy.array([[float(cell or "nan") for cell in row] for row in rows])
    return {name: cells[:, place] for place, name in enumerate(names)}


def same(columns, others):
    assert list(columns) == list(others)
    for name in columns:
        numpy.testing.assert_array_equal(columns[name], others[name])


def test_the_columns_are_those_of_the_program(cuk, tmp_path):
    run = pebo.check(cuk).simulate(every=1e-2, seed=3, set={"simulation.noise.v2": 0.1})
    said = program(
        "simulate",
        cuk,
        "--every",
        "1e-2",
        "--seed",
        "3",
        "--set",
        "simulation.noise.v2=0.1",
        "--csv",
        tmp_path / "cuk.csv",
    )
    assert said.returncode == 0
    same(run, table(tmp_path / "cuk.csv"))
    assert said.stdout == run.text


def test_a_run_settles(cuk):
    run = pebo.check(cuk).simulate()
    assert run.settled("i1") == pytest.approx(0.0644, abs=1e-4)
    assert abs(run["i1_error"][-1]) < 1e-4 < abs(run["i1_error"][0])
    numpy.testing.assert_allclose(run["i1_hat"] - run["i1"], run["i1_error"], atol=1e-12)
    assert run.errors["i1"] == (-0.5, run["i1_error"][-1])
    assert len(run["t"]) == 1001 and run["t"].dtype == numpy.float64
    assert run.figure.startswith("<svg") and run.figure in run._repr_html_()
    assert repr(run).startswith("<pebo.Run cuk: 1001 rows of t, i1")
    with pytest.raises(KeyError, match="no column `i2`; the columns are t, i1"):
        _ = run["i2"]
    with pytest.raises(KeyError, match="there are i1, i3"):
        run.settled("v2")


def test_baselines_and_many_runs():
    result = pebo.check(MODELS / "cuk_case2.yaml")
    run = result.simulate(duration=0.6, step=1e-4)
    assert run.settled("v4", "immersion") < run.settled("v4")
    many = result.simulate(duration=0.05, runs=3, set={"simulation.noise.v2": 0.1})
    assert list(many)[:2] == ["t", "i1_error_10"]
    with pytest.raises(ValueError, match="1 to 10000"):
        result.simulate(runs=0)


def test_flawed_settings_are_told(cuk):
    result = pebo.check(cuk)
    for options in ({"step": -1.0}, {"step": 0.0}, {"duration": float("nan")}, {"every": -1}, {"feedback": "nobody"}):
        with pytest.raises(pebo.ModelError):
            result.simulate(**options)
    with pytest.raises(pebo.ModelError, match="did you mean"):
        result.simulate(set={"simulation.nois.v2": 1})
    with pytest.raises(TypeError):
        result.simulate(step="fast")
    with pytest.raises(ValueError, match="seed"):
        result.simulate(seed=-1)


def test_a_limit_ends_a_run(cuk):
    begun = time.monotonic()
    with pytest.raises(pebo.RefusedError):
        pebo.check(cuk).simulate(step=1e-8, limit=0.3)
    assert time.monotonic() - begun < 5


def test_a_simulated_log_replays(cuk, tmp_path):
    pandas = pytest.importorskip("pandas")
    result = pebo.check(cuk)
    run = result.simulate(duration=0.2, every=1e-5)
    log = {name: run[name] for name in ("t", "v2", "v4", "d", "i1", "i3")}
    replayed = result.replay(log)
    assert replayed.settled("i1") == pytest.approx(0.064, abs=0.01)
    # The observer of the loop, on the same samples.
    numpy.testing.assert_allclose(replayed["i1_hat"], run["i1_hat"], atol=1e-9)
    assert not replayed.faults
    frame = pandas.DataFrame(log)
    same(result.replay(frame), replayed)
    frame.to_csv(tmp_path / "log.csv", index=False)
    same(result.replay(tmp_path / "log.csv"), replayed)


def test_a_recording_replays_as_by_the_program(tmp_path):
    pandas = pytest.importorskip("pandas")
    recorded, model = MODELS / "recordings" / "motor_bench.csv", MODELS / "recordings" / "motor_bench.yaml"
    said = program("replay", model, "--data", recorded, "--csv", tmp_path / "estimates.csv")
    replayed = pebo.check(model).replay(recorded)
    same(replayed, table(tmp_path / "estimates.csv"))
    assert said.stdout == replayed.text
    frame = pandas.read_csv(recorded, comment="#")
    same(pebo.check(model).replay(frame), replayed)
    assert any("NaN" in fault or "empty" in fault for fault in replayed.faults)


def test_dates_are_seconds_since_the_first():
    result = pebo.check(MODELS / "dc_motor.yaml")
    run = result.simulate(duration=0.05, every=1e-4)
    names = [*result_signals(result)]
    log = {name: run[name] for name in names}
    instants = numpy.datetime64("2026-11-27T10:00:00") + (run["t"] * 1e6).round().astype("timedelta64[us]")
    by_date = result.replay({"t": instants, **log})
    numpy.testing.assert_allclose(by_date["t"], run["t"], atol=1e-9)


def result_signals(result):
    """The outputs and inputs of a model file, which lists them on one line each."""
    for line in result.model.splitlines():
        if line.startswith(("y:", "u:")):
            yield from (name.strip() for name in line.split("[")[1].split("]")[0].split(","))


def test_flawed_data_are_told(cuk):
    result = pebo.check(cuk)
    with pytest.raises(pebo.ModelError, match="v4"):
        result.replay({"t": [0, 1], "v2": [1, 2], "d": [0.1, 0.2]})
    with pytest.raises(ValueError, match="`t` 2, `v2` 1"):
        result.replay({"t": [0, 1], "v2": [1]})
    with pytest.raises(ValueError, match="2"):
        result.replay({"t": [[0, 1]]})
    with pytest.raises(TypeError, match="not list"):
        result.replay([1, 2])
    with pytest.raises(FileNotFoundError):
        result.replay("none.csv")
    with pytest.raises(pebo.ModelError):
        result.replay({"t": [0, 1], "v2": ["x", "y"], "v4": [0, 0], "d": [0, 0]})
    for data in ({}, {"t": []}, {'a"b,\n': [1]}):
        with pytest.raises(pebo.PeboError):
            result.replay(data)


def test_other_threads_go_on(cuk):
    result = pebo.check(cuk)
    turns = 0
    thread = threading.Thread(target=lambda: result.simulate(step=2e-6))
    thread.start()
    while thread.is_alive():
        turns += 1
        time.sleep(0.001)
    assert turns > 20

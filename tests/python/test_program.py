"""Python gives the program's results, to the last bit: both use the same Rust code."""

import functools
import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import eeruf
import numpy as np
import pytest
from eeruf import Schedule, sim, tables

ROOT = Path(__file__).parents[2]


@functools.lru_cache
def printed(*words: str) -> str:
    """Return the program's JSON as text."""
    path = os.environ.get("EERUF_PROGRAM")
    assert path is not None, "EERUF_PROGRAM names the program; `cargo xtask python` sets it"
    run = subprocess.run([path, *words, "--json"], cwd=ROOT, capture_output=True, text=True)
    assert run.returncode in (0, 1), run.stderr
    return run.stdout


def program(*words: str) -> Any:
    """Return the program's JSON, parsed."""
    return json.loads(printed(*words))


@pytest.mark.parametrize("method", [method for method in sim.METHODS if method != "eeruf_best"])
def test_a_simulation_has_the_figures_that_the_program_prints(method: Any) -> None:
    printed = program("study", "scenes/alcove.toml", "--periods", "200", "--method", method)["methods"][method]
    readings = sim.simulate(sim.Scene.read_toml(ROOT / "scenes/alcove.toml"), method, periods=200)
    summary = readings.summary().to_dict()
    # The program names the method by the key.
    del summary["method"]
    assert summary == {name: printed[name] for name in summary}


def test_set_one_is_the_programs() -> None:
    methods: Any = ["conventional", "eeruf", "eeruf_best", "multi_echo"]
    printed = program("experiment", "set-one", "--seeds", "2", "--method", ",".join(methods))
    found = eeruf.experiments.set_one(seeds=2, methods=methods).to_dict()
    del found["runs"]
    assert found == printed


@pytest.mark.parametrize(
    ("words", "arguments"),
    [
        ([], {}),
        (["--second-robot", "ahead", "--speed", "0.8"], {"second_robot": "ahead", "speed_m_s": 0.8}),
        (["--no-odometry", "--second-robot"], {"odometry": False, "second_robot": (0.6, 5.4)}),
    ],
    ids=["alone", "ahead", "no odometry"],
)
def test_set_two_is_the_programs(words: list[str], arguments: dict[str, Any]) -> None:
    methods: Any = ["conventional", "eeruf", "eeruf_best"]
    printed = program("experiment", "set-two", "--seeds", "2", "--method", ",".join(methods), *words)
    found = eeruf.experiments.set_two(seeds=2, methods=methods, **arguments).to_dict()
    del found["runs"]
    assert found == printed


@pytest.mark.parametrize("atlas", [True, False])
@pytest.mark.parametrize("ring", ["paper-12", "ring-24"])
def test_a_design_is_the_programs(ring: str, atlas: bool) -> None:
    printed = program("design", "--period-only", f"rings/{ring}.toml", *([] if atlas else ["--no-atlas"]))
    arguments: dict[str, Any] = (
        {"sensors": 12, "layout": "line"} if ring == "paper-12" else {"sensors": 24, "layout": "ring"}
    )
    needs: dict[str, Any] = {"t_delta_us": 999, "min_interval_us": 15_000, "window_us": 30_000}
    found = eeruf.design(**needs, **arguments, atlas=atlas)
    del printed["seconds"]
    # A certificate is made on demand in Python.
    assert printed.pop("certified_us") <= printed["bound_us"]
    assert printed["from_atlas"] is atlas
    assert (found.nodes == 0) is atlas
    assert Schedule.from_firing(**printed.pop("schedule")) == found.schedule
    assert {name: getattr(found, name) for name in printed} == printed
    names = {"value_us", "bound_us", "proven", "nodes", "reason", "from_atlas"}
    assert names == set(printed)
    # The atlas answers by default, as in the program.
    assert eeruf.design(**needs, **arguments).from_atlas


def test_the_best_table_of_waits_is_the_programs() -> None:
    printed = program("search", "rings/table-i-waits.toml", "--best", "interval")
    needs: dict[str, Any] = {"t_delta_us": 999, "min_interval_us": 15_000, "criterion": "paper"}
    found = eeruf.WaitSearch(12, 100_000, 24_000, 1_000, **needs).best("interval")
    assert Schedule(**printed["schedule"]) == found.schedule
    assert [printed[name] for name in ("value_us", "bound_us", "nodes")] == [
        found.value_us,
        found.bound_us,
        found.nodes,
    ]


def test_a_log_is_judged_as_by_the_program() -> None:
    log = "tests/data/scitos-g5-24-sonars.csv"
    printed = program("replay", log, "--t-delta-us", "500")["total"]
    metres = np.genfromtxt(ROOT / log, delimiter=",", skip_header=1, usecols=range(24))
    echoes_us = np.where(metres >= 5.0, np.nan, 2e6 * metres / 343.2)
    kinds = eeruf.EchoFilter(24, 500).push_many(echoes_us)
    counted = np.bincount(kinds.ravel(), minlength=len(eeruf.KINDS))
    assert {name: counted[eeruf.KINDS.index(name)] for name in printed if name in eeruf.KINDS} == {
        name: count for name, count in printed.items() if name in eeruf.KINDS
    }
    assert printed["accepted"] > 1000


def test_a_report_is_the_programs() -> None:
    printed = program("verify", "rings/table-i-b.toml", "--t-delta-us", "999", "--min-interval-us", "15000")
    report = tables.TABLE_I_B.verify(999, min_interval_us=15_000)
    shown = {
        name: getattr(report, name)
        for name in ("ok", "separation_us", "max_t_delta_us", "min_interval_us", "min_refire_us")
    }
    assert shown == {name: printed[name] for name in shown}
    fields: list[dict[str, Any]] = [
        {name: tuple(value) if isinstance(value, list) else value for name, value in violation.items()}
        for violation in printed["violations"]
    ]
    violations = [eeruf.typing.Violation(**violation) for violation in fields]
    assert list(report.violations) == violations
    assert len(violations) > 2


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="a device of Linux")
def test_full_disk_is_exit_74_and_a_sentence() -> None:
    for words in (["examples"], ["--help"], ["verify", "rings/table-i-d.toml", "--json"]):
        with open("/dev/full", "w") as full:
            command = [sys.executable, "-m", "eeruf", *words]
            run = subprocess.run(command, cwd=ROOT, stdout=full, stderr=subprocess.PIPE, text=True)
        assert run.returncode == 74, run.stderr
        assert run.stderr.startswith("eeruf: standard output: No space left"), run.stderr

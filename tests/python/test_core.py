"""Schedules, filter and ring, as Python sees them."""

import json
import os
import pickle
import subprocess
import sys
from pathlib import Path

import eeruf
import numpy as np
import pytest
from eeruf import Schedule, tables


def test_what_compares_equal_pickles_and_prints_so_that_it_can_be_pasted() -> None:
    found = eeruf.design(4, t_delta_us=999, min_interval_us=15_000, window_us=36_000)
    report = tables.TABLE_I_D.verify(1_500, min_interval_us=18_000)
    assert not report.ok
    names = {name: getattr(eeruf, name) for name in ("Schedule", "Found", "Report", "Violation")}
    for value in (tables.TABLE_I_D, tables.TABLE_I_D.scaled(3, 5), found, report, report.violations[0]):
        assert pickle.loads(pickle.dumps(value)) == value
        assert eval(repr(value), names) == value


def test_the_papers_table_leaves_neighbours_17_ms_and_separates_by_2_ms() -> None:
    report = tables.TABLE_I_D.verify(999, min_interval_us=15_000)
    assert report.ok
    assert (report.min_interval_us, report.separation_us, report.max_t_delta_us) == (17_000, 2_000, 999)


def test_violations_name_sensors_value_and_source() -> None:
    violations = tables.TABLE_I_B.verify(999, min_interval_us=15_000).violations
    assert {"interval"} == {violation.kind for violation in violations}
    assert min(violation.value_us for violation in violations) == 1_000
    assert all(violation.required_us == 15_000 and violation.source for violation in violations)


def test_schedules_survive_toml_and_json() -> None:
    for schedule in (tables.TABLE_I_D, Schedule.from_firing(40_000, [0, 20_000], [2_000, 25_000])):
        assert Schedule.from_toml(schedule.to_toml()) == schedule
        assert Schedule.from_json(schedule.to_json()) == schedule
        assert json.loads(schedule.to_json())["period_us"] == schedule.period_us


def test_the_c_header_compiles_without_warnings(tmp_path: Path) -> None:
    (tmp_path / "ring.h").write_text(tables.TABLE_I_D.to_c(min_interval_us=15_000))
    (tmp_path / "main.c").write_text('#include "ring.h"\nint main(void) { return 0; }\n')
    flags = ["-std=c99", "-Wall", "-Wextra", "-Werror", "-Wno-unused-variable", "-Wno-unused-const-variable"]
    subprocess.run(["gcc", *flags, "-fsyntax-only", "main.c"], cwd=tmp_path, check=True)


def test_the_rust_source_is_a_checked_constant() -> None:
    source = tables.TABLE_I_D.to_rust(min_interval_us=15_000)
    assert "schedule!" in source or "Schedule<12>" in source


def test_many_readings_at_once_are_judged_as_one_by_one() -> None:
    chance = np.random.default_rng(1)
    echoes = np.where(chance.random((200, 5)) < 0.2, np.nan, chance.integers(0, 3, (200, 5)) * 300 + 9_000.0)
    together = eeruf.EchoFilter(5, 500).push_many(echoes)
    alone = eeruf.EchoFilter(5, 500)
    for row, kinds in zip(echoes, together):
        for sensor, (us, kind) in enumerate(zip(row, kinds)):
            reading = alone.push(sensor, None if np.isnan(us) else int(us))
            assert reading.kind == eeruf.KINDS[kind]
    assert {"accepted", "rejected", "no_echo", "clear", "first"} == {eeruf.KINDS[kind] for kind in np.unique(together)}


def test_a_ring_accepts_an_echo_that_repeats() -> None:
    ring = eeruf.Ring(tables.TABLE_I_D, 500, window_us=36_000)
    kinds: list[str] = []
    now_us = 0
    while len(kinds) < 24:
        event = ring.poll(now_us)
        if event is None:
            now_us = ring.next_deadline_us
        elif isinstance(event, eeruf.Fire):
            ring.echo(event.sensor, now_us + 9_000)
        elif isinstance(event, eeruf.Reading):
            kinds.append(event.kind)
            assert event.t_echo_us == 9_000
    assert kinds == ["first"] * 12 + ["accepted"] * 12


def test_a_callable_follows_the_work_and_its_error_ends_it() -> None:
    class Enough(Exception):
        pass

    def stop(share: "float | None", text: str) -> None:
        raise Enough

    with pytest.raises(Enough):
        eeruf.experiments.set_one(seeds=10_000, progress=stop)


def test_results_do_not_depend_on_the_number_of_threads() -> None:
    program = "import eeruf, json; print(json.dumps(eeruf.experiments.set_one(seeds=3, readings=800)))"
    command = [sys.executable, "-c", program]
    printed = [
        subprocess.run(
            command, check=True, capture_output=True, env={**os.environ, "RAYON_NUM_THREADS": threads}
        ).stdout
        for threads in ("1", "2")
    ]
    assert printed[0] == printed[1]
    assert json.loads(printed[0])["methods"]["eeruf"]


def test_the_wheel_is_below_3_mb() -> None:
    wheel = os.environ.get("EERUF_WHEEL")
    assert wheel is not None, "EERUF_WHEEL names the wheel; `cargo xtask python` sets it"
    assert Path(wheel).stat().st_size < 3_000_000

"""Schedules, filter and ring, as Python sees them."""

import json
import os
import pickle
import re
import subprocess
import sys
import threading
import tracemalloc
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import eeruf
import numpy as np
import pytest
from eeruf import Schedule, nav, sim, tables


def test_equal_values_pickle_and_print_as_code() -> None:
    found = eeruf.design(4, t_delta_us=999, min_interval_us=15_000, window_us=36_000)
    report = tables.TABLE_I_D.verify(1_500, min_interval_us=18_000)
    assert not report.ok
    reading = eeruf.EchoFilter(1, 500).push(0, 9_000)
    names = {
        name: getattr(eeruf, name)
        for name in ("Schedule", "Found", "Needs", "Report", "Fire", "Reading", "PeriodEnded")
    }
    names |= {name: getattr(eeruf.typing, name) for name in ("RobotState", "Steering", "Violation")}
    ring = eeruf.Ring(tables.TABLE_I_D, t_delta_us=500, window_us=36_000)
    while not isinstance(ended := ring.poll(ring.next_deadline_us + 40), eeruf.PeriodEnded):
        pass
    robot = sim.Robot((1, 0, 0.3), sensors=8, spacing_rad=0.26, radius_m=0.3)
    world = sim.Simulation(sim.Scene([[5, 2, -5, 2]], robots=[robot]))
    world.set_velocity(0, v_m_s=0.3, w_rad_s=0.1)
    world.step(0.06)
    assert sum(ended.tally.values()) and ended.sum_late_us
    firing = Schedule.from_firing(40_000, [0, 20_000], [2_000, 25_000])
    values = (
        tables.TABLE_I_D,
        tables.TABLE_I_D.scaled(3, 5),
        firing,
        found,
        report,
        report.violations[0],
        eeruf.typing.Violation("interval", (0, 1), ("a", "b"), 1, 2, "Sec. '3.1' \"c\""),
        eeruf.Fire(3),
        reading,
        ended,
        world.robots[0],
        nav.Vfh().steer(nav.Himm(), place=(0, 0), target=(0, 5)),
        eeruf.Needs(sensors=2, module=["ping", "srf08"], layout=[(0, 1)], speed_m_s=np.float64(0.5)),
    )
    for value in values:
        assert pickle.loads(pickle.dumps(value)) == value
        assert eval(repr(value), names) == value


RINGS = Path(__file__).parents[2] / "rings"


def test_needs_mean_what_the_program_takes_from_the_file(tmp_path: Path) -> None:
    for ring in (ring for ring in RINGS.glob("*.toml") if "table-i" not in ring.name):
        name = f"rings/{ring.name}"
        (file := tmp_path / "ring.toml").write_text(text := eeruf.example(name), encoding="utf-8")
        program = [sys.executable, "-m", "eeruf", "design", str(file), "--period-only", "--json"]
        said = json.loads(subprocess.run(program, check=True, capture_output=True, text=True).stdout)
        needs = eeruf.Needs.from_toml(text)
        found = [eeruf.design(what) for what in (needs, file, str(file))]
        assert {one.value_us for one in found} == {said["value_us"]}, name
        assert found[0].schedule is not None and found[0].schedule.verify(needs).ok
        assert found[0].schedule.to_dict().items() >= {"period_us": said["schedule"]["period_us"]}.items()
        rings = eeruf.Ring(found[0].schedule, needs), eeruf.Ring.flow(needs)
        assert [ring.sensors for ring in rings] == [needs.sensors] * 2


def test_a_ring_by_needs_accepts_what_is_before_it() -> None:
    ring, now_us = eeruf.Ring.flow(eeruf.Needs(sensors=4, module="hc-sr04"), {"seed": 3}), 0
    kinds: list[str] = []
    while len(kinds) < 200:
        now_us += ring.wait_us(now_us)
        while event := ring.poll(now_us):
            if isinstance(event, eeruf.Fire):
                ring.echo_between(event.sensor, now_us + 8_990, now_us + 9_010)
            elif isinstance(event, eeruf.Reading):
                kinds.append(event.kind)
    assert kinds[8:].count("accepted") > 185


def test_a_certificate_of_design_is_checked_and_pickles() -> None:
    found = eeruf.design(8, 999, 15_000, 30_000, certificate=True)
    assert found.certificate is not None
    assert eeruf.check_certificate(found.certificate) == found.value_us == found.certified_us == 63_000
    again = pickle.loads(pickle.dumps(found))
    assert again == found
    assert again.certificate == found.certificate
    assert eeruf.design(8, 999, 15_000, 30_000).certificate is None


def test_a_certificate_that_is_wrong_is_refused() -> None:
    certificate = eeruf.design(8, 999, 15_000, 30_000, certificate=True).certificate
    assert certificate is not None
    lines = certificate.splitlines(keepends=True)
    with pytest.raises(eeruf.CertificateError, match=r"^line \d+: "):
        eeruf.check_certificate("".join(lines[:-2] + lines[-1:]))
    with pytest.raises(eeruf.EerufError, match="expected a certificate"):
        eeruf.check_certificate(3)  # type: ignore[arg-type]


def test_a_time_limit_leaves_schedule_bound_and_certificate() -> None:
    # Not proven within half a million nodes.
    found = eeruf.design(11, 999, 15_000, 15_000, layout="ring", time_limit_s=0.1, certificate=True)
    assert not found.proven
    assert found.schedule is not None
    assert found.certificate is not None
    assert found.bound_us is not None
    assert eeruf.check_certificate(found.certificate) <= found.bound_us < (found.value_us or 0)
    with pytest.raises(eeruf.EerufError, match="time_limit_s = 0"):
        eeruf.design(8, 999, 15_000, 30_000, time_limit_s=0)


def test_a_period_that_is_given_says_what_fits() -> None:
    for period_us, expected in [(64_000, (False, 499)), (65_000, (True, 999)), (100_000, (True, 2_999))]:
        fits, found = eeruf.fit(period_us, 12, 999, 15_000, 30_000)
        assert (fits, found.value_us) == expected
        assert found.schedule is not None
        assert found.schedule.verify(expected[1], 15_000, window_us=30_000).ok
    uneven = eeruf.design(3, [999, 499, 499], 10_000, [20_000, 9_000, 9_000])
    assert uneven.value_us is not None
    assert eeruf.fit(uneven.value_us, 3, [999, 499, 499], 10_000, [20_000, 9_000, 9_000])[0] is True
    assert eeruf.fit(uneven.value_us - 1000, 3, [999, 499, 499], 10_000, [20_000, 9_000, 9_000])[0] is False
    with pytest.raises(eeruf.EerufError, match="expected a whole number of ticks"):
        eeruf.fit(64_500, 12, 999, 15_000, 30_000)


def test_a_curve_has_the_shortest_period_of_each_of_twenty_needs() -> None:
    curve = eeruf.curve("range", 8, 999, 15_000, 36_000, layout="ring")
    assert [value_us for value_us, *_ in curve] == [3_600 * tenths for tenths in range(1, 21)]
    for window_us, period_us, bound_us, proven in curve[4::5]:
        assert proven
        found = eeruf.design(8, 999, 15_000, window_us, layout="ring")
        assert period_us == bound_us == found.value_us
    with pytest.raises(eeruf.EerufError, match=r"need = 'speed'; expected"):
        eeruf.curve("speed", 8, 999, 15_000, 36_000)  # type: ignore[arg-type]


def test_the_front_of_tables_spans_the_two_bests() -> None:
    search = eeruf.WaitSearch(4, 40_000, 9_000, 1000, t_delta_us=99)
    front = search.pareto()
    assert front[0][1] == search.best("interval").value_us
    assert front[-1][2] == search.best("t_delta").value_us
    for table, interval_us, t_delta_us in front:
        assert t_delta_us is not None
        assert table.verify(t_delta_us, interval_us, criterion="paper").ok


def test_the_papers_table_has_17_ms_and_separates_by_2_ms() -> None:
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


def test_push_many_takes_any_array_and_changes_none() -> None:
    echoes = np.array([[9_000.0, 7_000.0], [9_100.0, np.nan]])
    before = echoes.copy()
    expected = eeruf.EchoFilter(2, 500).push_many(echoes)
    assert np.array_equal(echoes, before, equal_nan=True)
    assert expected.dtype == np.int8
    wide = np.full((4, 2), 1.0)
    wide[::2] = echoes
    for same in (
        echoes.tolist(),
        np.asfortranarray(echoes),
        wide[::2],
        echoes.astype(np.float32),
        echoes.astype(object),
    ):
        assert np.array_equal(eeruf.EchoFilter(2, 500).push_many(same), expected)
    assert eeruf.EchoFilter(2, 500).push_many(np.empty((0, 2))).shape == (0, 2)
    frozen = echoes.copy()
    frozen.flags.writeable = False
    assert np.array_equal(eeruf.EchoFilter(2, 500).push_many(frozen), expected)


def test_a_million_readings_are_read_in_place() -> None:
    # The input has 8 MB; if it were copied, numpy would trace as much again. The kinds have one byte each, in Rust's memory.
    echoes = np.full((125_000, 8), 9_000.0)
    filter = eeruf.EchoFilter(8, 500)
    tracemalloc.start()
    kinds = filter.push_many(echoes)
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert kinds.size == 1_000_000
    assert peak < 1_000_000
    tracemalloc.start()
    filter.push_many(echoes.astype(np.float32))
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert peak > 8_000_000


def test_multi_echo_filter_judges_single_echoes_alike() -> None:
    chance = np.random.default_rng(2)
    echoes = np.where(chance.random((300, 3)) < 0.2, np.nan, chance.integers(0, 3, (300, 3)) * 300 + 9_000.0)
    one, several = eeruf.EchoFilter(3, 500), eeruf.EchoFilter(3, 500, echoes=8)
    assert (one.echoes, several.echoes) == (1, 8)
    assert np.array_equal(one.push_many(echoes), several.push_many(echoes))


def test_of_several_echoes_the_earliest_that_count_are_compared() -> None:
    first, second = [14_000, 9_000, 20_000], [9_050, 14_000]
    for echoes, accepted_us in ((1, 9_050), (2, 9_050), (8, 9_050)):
        filter = eeruf.EchoFilter(1, 100, echoes=echoes)
        filter.push_echoes(0, first)
        assert filter.push_echoes(0, second).t_echo_us == accepted_us
    # Another sensor's sound comes first, once.
    for echoes, kind in ((1, "rejected"), (2, "accepted")):
        filter = eeruf.EchoFilter(1, 100, echoes=echoes)
        filter.push_echoes(0, [9_000])
        assert filter.push_echoes(0, [4_000, 9_000]).kind == kind
    assert eeruf.EchoFilter(1, 100, echoes=3).push_echoes(0, []).kind == "no_echo"


def kinds_of_two_periods(t_echo_us: Callable[[int], int], expected_change_us: "list[int] | None") -> list[str]:
    ring = eeruf.Ring(tables.TABLE_I_D, 500, window_us=36_000)
    kinds: list[str] = []
    now_us = 0
    while len(kinds) < 24:
        event = ring.poll(now_us, expected_change_us)
        if event is None:
            now_us = ring.next_deadline_us
        elif isinstance(event, eeruf.Fire):
            ring.echo(event.sensor, now_us + t_echo_us(now_us))
        elif isinstance(event, eeruf.Reading):
            kinds.append(event.kind)
            assert event.t_echo_us is not None
    return kinds


def test_a_ring_accepts_an_echo_that_repeats() -> None:
    assert kinds_of_two_periods(lambda _: 9_000, None) == ["first"] * 12 + ["accepted"] * 12


def test_a_ring_accepts_an_echo_that_changes_as_it_should() -> None:
    # By 1 ms from the first period of 100 ms to the second.
    def approaching_us(now_us: int) -> int:
        return 9_000 if now_us < 100_000 else 8_000

    assert kinds_of_two_periods(approaching_us, None) == ["first"] * 12 + ["rejected"] * 12
    assert kinds_of_two_periods(approaching_us, [-1_000] * 12) == ["first"] * 12 + ["accepted"] * 12
    changes = [0] * 6 + [-1_000] * 6
    assert kinds_of_two_periods(approaching_us, changes).count("accepted") == 6


def test_a_callable_follows_the_work_and_its_error_ends_it() -> None:
    class Enough(Exception):
        pass

    def stop(share: "float | None", text: str) -> None:
        raise Enough

    with pytest.raises(Enough):
        eeruf.experiments.set_one(seeds=10_000, progress=stop)


def test_results_do_not_depend_on_the_number_of_threads() -> None:
    program = """
import eeruf, json, hashlib
one = eeruf.experiments.set_one(seeds=3, readings=800)
two = eeruf.experiments.set_two(seeds=4, methods=["eeruf", "conventional"])
tracks = [hashlib.sha256(run.track.tobytes() + run.grid.tobytes()).hexdigest() for runs in two.runs.values() for run in runs]
print(json.dumps([one.to_dict(), two.to_dict(), tracks]))
"""
    printed = [
        subprocess.run(
            [sys.executable, "-c", program],
            check=True,
            capture_output=True,
            env={**os.environ, "RAYON_NUM_THREADS": threads},
        ).stdout
        for threads in ("1", "2")
    ]
    assert printed[0] == printed[1]
    one, two, tracks = json.loads(printed[0])
    assert one["methods"]["eeruf"] and two["methods"]["eeruf"]["courses"] == 4
    assert len(set(tracks)) == 8


def test_threads_run_side_by_side_without_the_interpreter_lock() -> None:
    # While one thread is in a search that does not end, another one runs Python, and ends the search.
    reached = threading.Event()

    def tell(share: "float | None", text: str) -> None:
        if reached.is_set():
            raise InterruptedError

    chance = np.random.default_rng(3)
    pairs = [(x, y) for x in range(64) for y in range(x) if chance.random() < 0.3]
    with ThreadPoolExecutor(1) as threads:
        search = threads.submit(lambda: eeruf.design(64, 499, 9_000, 36_000, layout=pairs, budget=2**60, progress=tell))
        for _ in range(100_000):
            pass
        assert not search.done()
        reached.set()
        with pytest.raises(InterruptedError):
            search.result(timeout=60)


def test_uneven_rings_are_designed_verified_and_certified() -> None:
    needs: dict[str, Any] = {
        "t_delta_us": [999, 999, 1500, 499],
        "min_interval_us": 8_000,
        "layout": "ring",
        "neighbours": 2,
        "shared_lines": [(0, 2)],
        "together": [[1, 3]],
    }
    windows = np.array([20_000, 12_000, 30_000, 12_000])
    found = eeruf.design(4, window_us=windows, certificate=True, **needs)
    schedule = found.schedule
    assert found.proven and schedule is not None and found.certificate is not None
    assert eeruf.check_certificate(found.certificate) == found.value_us
    assert schedule.t_fire_a_us[1] == schedule.t_fire_a_us[3] and schedule.t_fire_b_us[1] == schedule.t_fire_b_us[3]
    assert schedule.verify(window_us=windows, **needs).ok
    longer = schedule.verify(window_us=schedule.period_us, **needs)
    assert {violation.kind for violation in longer.violations} == {"shared_line", "window"}


def test_a_pairs_interval_and_a_sensors_rest_are_kept() -> None:
    found = eeruf.design(2, 499, 0, 9_000, neighbours=1, intervals_us=[(0, 1, 4_000)], refire_us=[40_000, 9_000])
    assert found.value_us == 40_000 and found.schedule is not None
    kinds = {violation.kind for violation in found.schedule.verify(499, refire_us=90_000).violations}
    assert kinds == {"refire"}


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"window_us": [9_000]}, "window: 1 values; expected one for each of 2 sensors"),
        ({"window_us": [9_000, 0]}, "window_us = [9000, 0]; expected one time of 1 or more for each sensor"),
        ({"t_delta_us": [9, -1]}, "t_delta_us[1] = -1; expected a whole number from 0 to 4294967295"),
        ({"intervals_us": [(0, 2, 9)]}, "intervals_us: sensors 0 and 2; expected two different ones from 0 to 1"),
        ({"shared_lines": [(0,)]}, "shared_lines: [0]; expected two or more different sensors from 0 to 1"),
        ({"together": 3}, "together = 3; expected groups of sensors, such as [(0, 4), (1, 5)]"),
        (
            {"together": [(0, 1)]},
            "together: sensors 0 and 1 must keep 5 ms between their firings; expected a layout in which they are no "
            "neighbours, or intervals_us = [[0, 1, 0]], and no shared line",
        ),
    ],
)
def test_what_is_wrong_with_uneven_needs_is_said_by_name(arguments: dict[str, Any], message: str) -> None:
    needs: dict[str, Any] = {"sensors": 2, "t_delta_us": 99, "min_interval_us": 5_000, "window_us": 9_000}
    with pytest.raises(eeruf.EerufError, match=re.escape(message)):
        eeruf.design(**{**needs, **arguments})

"""Limits per sensor, many phases, several echoes and adaptation, two by two: from a schedule's file to readings."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Union

import eeruf
import pytest

NEEDS: dict[str, Any] = {"t_delta_us": [999, 999, 1500, 1500], "window_us": [36_000, 36_000, 12_000, 12_000]}
LINES = [(0, 2)]
PHASES = """
period_us = 85_006
step_us = 3_001
phases = 5
first_multiplier = 2
t_lag_us = [0, 64_004, 43_002, 27_004]
"""
#: Beyond the two short windows.
WALL_US = 13_000
AnySchedule = Union[eeruf.Schedule, eeruf.HoppingSchedule]


def table(folder: Path) -> eeruf.Schedule:
    """Two phases for four sensors with limits of their own, by way of a file."""
    found = eeruf.design(4, min_interval_us=15_000, shared_lines=LINES, **NEEDS)
    assert found.schedule is not None
    (folder / "table.toml").write_text(found.schedule.to_toml(), "utf-8")
    return eeruf.Schedule.from_toml((folder / "table.toml").read_text("utf-8"))


def phases(folder: Path) -> eeruf.HoppingSchedule:
    """Many phases for the same sensors, as `eeruf design --phases 5 --emit toml` writes them."""
    (folder / "phases.toml").write_text(PHASES, "utf-8")
    return eeruf.HoppingSchedule.from_toml((folder / "phases.toml").read_text("utf-8"))


def hopping(schedule: eeruf.HoppingSchedule, **more: Any) -> eeruf.Ring:
    settings = eeruf.HoppingSettings("driving", t_delta_us=1500, near_us=1500)
    return eeruf.Ring.hopping(schedule, settings, shared_lines=LINES, **NEEDS, **more)


def believed(
    ring: eeruf.Ring, periods: int, wall: bool = True, noise: bool = False, adaptation: eeruf.Adaptation | None = None
) -> list[tuple[int, int | None]]:
    """Accepted sensors and echo times before a wall, with something before it that never repeats, or with that alone."""
    accepted, fired, ended = [], [0] * ring.sensors, 0
    while ended < periods:
        now_us = ring.next_deadline_us
        while event := ring.poll(now_us):
            if isinstance(event, eeruf.Fire):
                fired[event.sensor] += 1
                if noise:
                    ring.echo(event.sensor, now_us + 1_000 + fired[event.sensor] * 3_100 % 9_000)
                if wall:
                    ring.echo(event.sensor, now_us + WALL_US)
            elif isinstance(event, eeruf.Reading):
                if event.kind == "accepted":
                    accepted.append((event.sensor, event.t_echo_us))
            else:
                ended += 1
            if adaptation is not None:
                adaptation.adapt(ring, event)
    return accepted


WALLS = {(0, WALL_US), (1, WALL_US)}


def test_limits_go_with_many_phases(tmp_path: Path) -> None:
    schedule = phases(tmp_path)
    ring = hopping(schedule)
    assert ring.window_us == 36_000
    assert set(believed(ring, 100)) == WALLS
    with pytest.raises(eeruf.ArgumentError, match="t_delta_us = 999; expected one for each sensor"):
        eeruf.Ring.hopping(schedule, window_us=36_000, t_delta_us=999)
    tight = eeruf.HoppingSchedule(4, 70_000, schedule.step_us, t_lag_us=[0, 1_000, 2_000, 3_000])
    with pytest.raises(eeruf.RingError, match=r"sensor 2 fires 5\.001 ms after sensor 0"):
        hopping(tight)
    with pytest.raises(eeruf.RingError, match=r"sensor 2 fires 5\.001 ms after sensor 0"):
        ring.change_schedule(tight)


def test_limits_go_with_several_echoes(tmp_path: Path) -> None:
    schedule = table(tmp_path)
    several = eeruf.Ring(schedule, shared_lines=LINES, several_echoes=True, **NEEDS)
    assert set(believed(several, 50, noise=True)) == WALLS
    one = eeruf.Ring(schedule, shared_lines=LINES, **NEEDS)
    assert not set(believed(one, 50, noise=True)) & WALLS


def test_limits_go_with_adaptation(tmp_path: Path) -> None:
    schedule = table(tmp_path)
    ring = eeruf.Ring(schedule, shared_lines=LINES, **NEEDS)
    adaptation = eeruf.Adaptation([schedule, schedule.scaled(3, 2)], t_delta_us=999)
    believed(ring, 40, wall=False, noise=True, adaptation=adaptation)
    assert adaptation.rung == 1
    assert ring.schedule == schedule.scaled(3, 2)
    assert set(believed(ring, 20)) == WALLS


def test_many_phases_go_with_several_echoes(tmp_path: Path) -> None:
    schedule = phases(tmp_path)
    several = hopping(schedule, several_echoes=True)
    assert set(believed(several, 50, noise=True)) == WALLS
    assert (0, several.confirmed_us(0)) in WALLS and several.t_lag_us == schedule.t_lag_us
    assert not set(believed(hopping(schedule), 50, noise=True)) & WALLS
    with pytest.raises(eeruf.RingError, match="schedule of a ring that counts votes"):
        _ = several.schedule


def test_many_phases_go_with_adaptation(tmp_path: Path) -> None:
    schedule = phases(tmp_path)
    slow = schedule.scaled(3, 2)
    ring = hopping(schedule)
    adaptation = eeruf.Adaptation([schedule, slow], t_delta_us=1500)
    believed(ring, 40, wall=False, noise=True, adaptation=adaptation)
    assert adaptation.rung == 1 and adaptation.schedule == slow
    assert repr(adaptation) == f"<Adaptation: rung 1 of 2, {slow.period_us}>"
    assert ring.t_lag_us == slow.t_lag_us
    assert set(believed(ring, 100)) == WALLS
    believed(ring, 200, adaptation=adaptation)
    assert adaptation.rung == 0 and ring.t_lag_us == schedule.t_lag_us
    # Of several echoes the silence after such noise is heard, and believed: that ring need not slow down.
    ring, adaptation = hopping(schedule, several_echoes=True), eeruf.Adaptation([schedule, slow], t_delta_us=1500)
    believed(ring, 40, wall=False, noise=True, adaptation=adaptation)
    assert adaptation.rung == 0 and ring.confirmed_us(0) is None
    ring.change_schedule(slow)
    assert set(believed(ring, 100, noise=True)) == WALLS and ring.t_lag_us == slow.t_lag_us


def test_several_echoes_go_with_adaptation() -> None:
    ladder = [eeruf.tables.TABLE_I_D.scaled(3, 5), eeruf.tables.TABLE_I_D]
    for wall, rung in ((False, 1), (True, 0)):
        ring = eeruf.Ring(ladder[0], 500, window_us=36_000, several_echoes=True)
        adaptation = eeruf.Adaptation(ladder, t_delta_us=500)
        believed(ring, 40, wall=wall, noise=True, adaptation=adaptation)
        assert adaptation.rung == rung and ring.schedule == ladder[rung]


def test_hopping_ladders_are_of_one_code() -> None:
    schedule = eeruf.HoppingSchedule(sensors=8, period_us=60_000, step_us=240)
    other = eeruf.HoppingSchedule(sensors=8, period_us=90_000, step_us=250)
    ring = eeruf.Ring.hopping(schedule, window_us=36_000)
    with pytest.raises(eeruf.HoppingError, match="code"):
        ring.change_schedule(other)
    with pytest.raises(eeruf.HoppingError, match=r"t_delta|T_delta"):
        eeruf.Adaptation([schedule], t_delta_us=240)
    with pytest.raises(eeruf.ArgumentError, match=r"schedules\[1\]"):
        eeruf.Adaptation([schedule, eeruf.tables.TABLE_I_D], t_delta_us=100)  # type: ignore[arg-type]
    with pytest.raises(eeruf.RingError, match="max_speed_m_s of a ring that hops"):
        eeruf.Adaptation([schedule], t_delta_us=150).max_speed_m_s(150)
    with pytest.raises(eeruf.RingError, match="does not hop"):
        eeruf.Ring(eeruf.tables.TABLE_I_D, 500, window_us=36_000).change_schedule(schedule)


def test_simulated_rings_adapt_and_hear_several_echoes() -> None:
    schedule = eeruf.HoppingSchedule(sensors=8, period_us=80_000, step_us=301)
    robot = eeruf.sim.Robot((0, 0, 1.57), sensors=8, spacing_rad=0.26, radius_m=0.3)
    scene = eeruf.sim.Scene([[5, 2, -5, 2]], robots=[robot])
    for name in ("adaptive_hopping", "hopping_multi_echo"):
        method = eeruf.sim.Method(name, schedule=schedule, settings="driving")
        readings = eeruf.sim.simulate(scene, method, 60)
        assert readings.is_accepted.mean() > 0.2

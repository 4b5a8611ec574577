"""Limits per sensor, several echoes and adaptation, two by two: from a schedule's file to readings."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import eeruf

NEEDS: dict[str, Any] = {"t_delta_us": [999, 999, 1500, 1500], "window_us": [36_000, 36_000, 12_000, 12_000]}
LINES = [(0, 2)]
#: The wall's echo time, beyond the two short windows.
WALL_US = 13_000


def table(folder: Path) -> eeruf.Schedule:
    """Return two phases for four sensors with limits of their own, read from a file."""
    found = eeruf.design(4, min_interval_us=15_000, shared_lines=LINES, **NEEDS)
    assert found.schedule is not None
    (folder / "table.toml").write_text(found.schedule.to_toml(), "utf-8")
    return eeruf.Schedule.from_toml((folder / "table.toml").read_text("utf-8"))


def believed(
    ring: eeruf.Ring, periods: int, wall: bool = True, noise: bool = False, adaptation: eeruf.Adaptation | None = None
) -> list[tuple[int, int | None]]:
    """Return the sensor and echo time of each accepted reading. Noise: earlier echoes that never repeat."""
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


def test_several_echoes_go_with_adaptation() -> None:
    ladder = [eeruf.tables.TABLE_I_D.scaled(3, 5), eeruf.tables.TABLE_I_D]
    for wall, rung in ((False, 1), (True, 0)):
        ring = eeruf.Ring(ladder[0], 500, window_us=36_000, several_echoes=True)
        adaptation = eeruf.Adaptation(ladder, t_delta_us=500)
        believed(ring, 40, wall=wall, noise=True, adaptation=adaptation)
        assert adaptation.rung == rung and ring.schedule == ladder[rung]

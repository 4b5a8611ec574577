"""The example for a Raspberry Pi, with modules that this test simulates behind gpiod's interface."""

import importlib.util
import sys
from pathlib import Path
from types import ModuleType
from typing import Any

import eeruf
import pytest

if sys.platform != "linux":
    pytest.skip("GPIO character devices are Linux's", allow_module_level=True)

import gpiod
from gpiod.line import Clock, Direction, Edge, Value

EXAMPLE = Path(__file__).parents[2] / "examples/raspberry-pi/ring.py"
TRIGGERS, ECHOES = [5, 6, 13, 19, 26, 12], [23, 24, 25, 16, 20, 21]
# Two walls; nothing in range; a cut wire; a line that is stuck; a spike on the line of a module without power.
WALLS_US = {0: 5_800, 1: 11_600}
OPEN, CUT, STUCK, SPIKE = 2, 3, 4, 5


@pytest.fixture(scope="module")
def example() -> ModuleType:
    spec = importlib.util.spec_from_file_location("raspberry_pi_ring", EXAMPLE)
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


class World:
    """Modules, a clock that advances while the ring waits, and the lines that gpiod would open."""

    def __init__(self, start_us: int) -> None:
        self.clock_us = start_us
        self.edges: list[tuple[int, int, bool]] = []
        self.raised_us: dict[int, int] = {}
        self.firings = [0] * len(TRIGGERS)

    def now_us(self) -> int:
        self.clock_us += 2
        return self.clock_us

    def request_lines(self, path: str, config: dict[Any, gpiod.LineSettings], consumer: str) -> "World":
        (lines,) = config
        settings = config[lines]
        assert path == "/dev/gpiochip0" and consumer == "eeruf"
        if settings.direction is Direction.OUTPUT:
            assert list(lines) == TRIGGERS and settings.output_value is Value.INACTIVE
        else:
            assert list(lines) == ECHOES and settings.direction is Direction.INPUT
            assert settings.edge_detection is Edge.BOTH and settings.event_clock is Clock.MONOTONIC
        return self

    def get_value(self, line: int) -> Value:
        return Value.ACTIVE if ECHOES.index(line) == STUCK else Value.INACTIVE

    def set_value(self, line: int, value: Value) -> None:
        sensor, now_us = TRIGGERS.index(line), self.now_us()
        assert sensor != STUCK
        if value is Value.ACTIVE:
            self.raised_us[sensor] = now_us
            return
        assert now_us - self.raised_us[sensor] >= 10
        self.firings[sensor] += 1
        if sensor == CUT:
            return
        width_us = {OPEN: 38_000, SPIKE: 5, **WALLS_US}[sensor]
        self.edges += [(now_us + 450, sensor, True), (now_us + 450 + width_us, sensor, False)]
        self.edges.sort()

    def wait_edge_events(self, timeout: float) -> bool:
        until_us = self.clock_us + round(1e6 * timeout)
        first_us = self.edges[0][0] if self.edges else until_us + 1
        # A process that has slept wakes up late, by varying times.
        late_us = self.clock_us * 7_919 % 400 if timeout else 0
        self.clock_us = max(self.clock_us, min(until_us, first_us)) + late_us
        return first_us <= until_us

    def read_edge_events(self) -> list[gpiod.EdgeEvent]:
        come = [edge for edge in self.edges if edge[0] <= self.clock_us]
        self.edges = self.edges[len(come) :]
        types = {True: gpiod.EdgeEvent.Type.RISING_EDGE, False: gpiod.EdgeEvent.Type.FALLING_EDGE}
        return [
            gpiod.EdgeEvent(types[high].value, 1_000 * at_us + 999, ECHOES[sensor], 0, 0)
            for at_us, sensor, high in come
        ]


# The second run goes through the wrap of the ring's clock.
@pytest.mark.parametrize("start_us", [1_000, 2**32 - 1_000_000])
def test_ring_on_pins_reads_walls_and_faults(
    example: ModuleType, monkeypatch: pytest.MonkeyPatch, start_us: int
) -> None:
    world = World(start_us)
    monkeypatch.setattr(gpiod, "request_lines", world.request_lines)
    needs: dict[str, Any] = {"t_delta_us": 500, "window_us": example.WINDOW_US, "refire_us": 60_000}
    found = eeruf.design(len(ECHOES), min_interval_us=10_000, layout="ring", **needs)
    assert found.schedule is not None
    ring = eeruf.Ring(found.schedule, now_us=start_us, path_change_us=100, silence="needs_answer", **needs)
    modules = example.Modules("/dev/gpiochip0", TRIGGERS, ECHOES, world.now_us)
    readings: list[list[tuple[str, int | None]]] = [[] for _ in ECHOES]
    late_us: list[int] = []

    def each(event: eeruf.Reading | eeruf.PeriodEnded) -> bool:
        if isinstance(event, eeruf.PeriodEnded):
            late_us.append(event.max_late_us)
            return event.period < 40
        readings[event.sensor].append((event.kind, event.t_echo_us))
        return True

    example.run(ring, modules, each)
    for sensor, echo_us in WALLS_US.items():
        assert len(readings[sensor]) >= 40
        assert readings[sensor][1:] == [("accepted", echo_us)] * (len(readings[sensor]) - 1)
        assert example.describe(ring.state(sensor)) == f"{echo_us * 0.1716:.0f}"
    kinds = [{kind for kind, _ in heard[1:]} for heard in readings]
    assert kinds[OPEN] == {"clear"} and kinds[STUCK] == {"stuck"}
    assert kinds[CUT] == kinds[SPIKE] == {"unanswered"}
    assert world.firings[STUCK] == 0 and min(world.firings[:STUCK]) >= 40
    # The ring waits actively for firings that are due soon, so it fires in time although each sleep ends late.
    assert max(late_us) <= 50

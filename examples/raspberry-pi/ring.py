"""A ring of HC-SR04 modules on a Raspberry Pi: ``python ring.py`` prints what is in front of each, once a second.

The kernel stamps the edges of the echo lines, so that a late loop does not make echo times less accurate. Needs the
packages ``eeruf`` and ``gpiod``.
"""

import time
from collections.abc import Callable, Sequence

import eeruf
import gpiod
from gpiod.line import Clock, Direction, Edge, Value

CHIP = "/dev/gpiochip0"
# The lines of each module, in the order of the ring.
TRIGGER_LINES = [5, 6, 13, 19]
ECHO_LINES = [23, 24, 25, 16]

SOUND_MM_PER_US = 0.3432
# Times of an HC-SR04, in microseconds. Its line rises 450 us after the trigger; a rise after LATEST_RISE_US has another
# cause. A pulse as long as LONGEST_US is its time-out: it heard nothing. Clones hold the line for 200 ms.
TRIGGER_US, LATEST_RISE_US, SHORTEST_US, LONGEST_US, LONGEST_HOLD_US = 10, 1_400, 100, 36_000, 250_000
WINDOW_US = LONGEST_US + 1_000
# The last part of each wait is polled without sleeping, since a sleeping process wakes up late.
SOON_US = 500


def monotonic_us() -> int:
    """Read the clock by which the kernel stamps edges, in microseconds."""
    return time.monotonic_ns() // 1_000


class Modules:
    """Trigger and echo lines of HC-SR04 modules on a GPIO character device, with the clock of their time stamps."""

    def __init__(
        self, chip: str, triggers: Sequence[int], echoes: Sequence[int], now_us: Callable[[], int] = monotonic_us
    ) -> None:
        """Open the lines."""
        low = gpiod.LineSettings(direction=Direction.OUTPUT, output_value=Value.INACTIVE)
        edges = gpiod.LineSettings(direction=Direction.INPUT, edge_detection=Edge.BOTH, event_clock=Clock.MONOTONIC)
        self.triggers = gpiod.request_lines(chip, {tuple(triggers): low}, consumer="eeruf")
        self.echoes = gpiod.request_lines(chip, {tuple(echoes): edges}, consumer="eeruf")
        self.trigger_lines, self.echo_lines = list(triggers), list(echoes)
        self.now_us = now_us
        self.fired_us: list[int | None] = [None] * len(triggers)
        self.rose_us: list[int | None] = [None] * len(triggers)

    def fire(self, ring: eeruf.Ring, sensor: int) -> None:
        """Trigger a module unless its line is high, when it would ignore the trigger."""
        if self.echoes.get_value(self.echo_lines[sensor]) is Value.ACTIVE:
            rose_us = self.rose_us[sensor]
            if rose_us is not None and self.now_us() - rose_us <= LONGEST_HOLD_US:
                ring.answered(sensor)  # it still listens for the echo of an earlier firing: nothing is in range
            else:
                ring.stuck(sensor)
            return
        self.rose_us[sensor] = None
        self.triggers.set_value(self.trigger_lines[sensor], Value.ACTIVE)
        end_us = self.now_us() + TRIGGER_US
        while self.now_us() <= end_us:
            pass
        self.triggers.set_value(self.trigger_lines[sensor], Value.INACTIVE)
        self.fired_us[sensor] = self.now_us()

    def take(self, ring: eeruf.Ring, timeout_us: int = 0) -> None:
        """Report the edges that have come to the ring, or wait this long for the first one."""
        if not self.echoes.wait_edge_events(timeout_us / 1e6):
            return
        for event in self.echoes.read_edge_events():
            sensor, at_us = self.echo_lines.index(event.line_offset), event.timestamp_ns // 1_000
            fired_us, rose_us = self.fired_us[sensor], self.rose_us[sensor]
            if event.event_type is event.Type.RISING_EDGE:
                if fired_us is not None and rose_us is None and at_us - fired_us <= LATEST_RISE_US:
                    self.rose_us[sensor] = at_us
                    ring.answered(sensor)
            elif rose_us is not None:
                self.rose_us[sensor] = None
                width_us = at_us - rose_us
                if width_us < SHORTEST_US:
                    ring.answered(sensor, False)  # a spike does not show that it listened
                elif width_us < LONGEST_US:
                    self.fired_us[sensor] = None  # one pulse for one trigger
                    ring.measured(sensor, width_us)


def run(ring: eeruf.Ring, modules: Modules, each: Callable[[eeruf.Reading | eeruf.PeriodEnded], bool]) -> None:
    """Fire and listen; pass readings and ends of periods to ``each`` until it returns false."""
    while True:
        now_us = modules.now_us()
        modules.take(ring)  # after the clock is read, so that no window closes on an edge that came in time
        while event := ring.poll(now_us):
            if isinstance(event, eeruf.Fire):
                modules.fire(ring, event.sensor)
            elif not each(event):
                return
        modules.take(ring, max(0, ring.wait_us(modules.now_us()) - SOON_US))


def describe(state: eeruf.State) -> str:
    """Return a distance in millimetres, or the reason why there is none."""
    return f"{state.t_echo_us * SOUND_MM_PER_US / 2:.0f}" if state.t_echo_us is not None else state.kind


def main() -> None:
    """Design a ring of as many sensors as there are lines, and print its states once a second."""
    sensors = len(ECHO_LINES)
    found = eeruf.design(
        sensors, t_delta_us=500, min_interval_us=10_000, window_us=WINDOW_US, layout="ring", refire_us=60_000
    )
    assert found.schedule is not None, found.reason
    # Foreign paths change by less than 100 us from one firing to the next, while the robot drives slowly.
    ring = eeruf.Ring(
        found.schedule, t_delta_us=500, now_us=monotonic_us(), window_us=WINDOW_US, refire_us=60_000, path_change_us=100,
        silence="needs_answer",
    )  # fmt: skip
    per_second = 1_000_000 // found.schedule.period_us

    def each(event: eeruf.Reading | eeruf.PeriodEnded) -> bool:
        if isinstance(event, eeruf.PeriodEnded) and event.period % per_second == 0:
            print("  ".join(describe(ring.state(sensor)) for sensor in range(sensors)), flush=True)
        return True

    run(ring, Modules(CHIP, TRIGGER_LINES, ECHO_LINES), each)


if __name__ == "__main__":
    main()

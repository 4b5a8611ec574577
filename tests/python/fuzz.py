"""Call everything with anything: `python tests/python/fuzz.py --calls 3000000 --seed 1`.

Whatever it is given, a call works or raises an `EerufError`, a `TypeError` about its arguments' names, a `MemoryError`, or an `OSError`
about a file, within seconds. The process must not grow either: the memory in use after half of the calls and after all of
them is compared, once unused memory has been given back. The exit code is 1 if it grew by more than `MOST_GROWN`.
"""

from __future__ import annotations

import argparse
import contextlib
import ctypes
import faulthandler
import gc
import importlib
import io
import math
import pickle
import random
import sys
import tempfile
import time
import warnings
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any, Callable, NamedTuple

import eeruf
import numpy as np
from eeruf import nav, sim, tables

# Of glibc's malloc.h.
M_ARENA_MAX = -8


def keep_one_heap() -> None:
    """Use one heap for all threads from now on, since malloc_trim never gives back the free end of any other."""
    libc = ctypes.CDLL(None)
    if hasattr(libc, "mallopt"):
        libc.mallopt(M_ARENA_MAX, 1)


keep_one_heap()
ANY: Any = eeruf
ROBOT = sim.Robot((0.3, 0.7, 1.57), 4, 0.26, 0.1)
ROOM = sim.Scene([[5, 2, -5, 2]], robots=[ROBOT])
READINGS = sim.simulate(ROOM, periods=3)
SLOW = tables.TABLE_I_D.scaled(5, 4)
INLINE = ThreadPoolExecutor(1)
FIRINGS = eeruf.logs.Firings.of(
    sensor=READINGS.sensor,
    fired_us=1e6 * READINGS.fired_s,
    period=READINGS.period,
    phase=READINGS.phase,
    t_echo_us=READINGS.earliest_us,
)
RING_FILE = Path(__file__).parents[2] / "rings" / "hc-sr04-8.toml"
TABLE = eeruf.experiments.set_one(2, readings=16, methods=["eeruf"])
RUNS = TABLE.runs["eeruf"]
PATHS = ROOM.paths((0, 0), [(1, 0), (2, 0)], 2)
UNEVEN: dict[str, Any] = {"t_delta_us": [999, 999, 1_500, 1_500], "window_us": [36_000, 36_000, 12_000, 12_000]}
FOUND = eeruf.design(4, min_interval_us=15_000, shared_lines=[(0, 2)], certificate=True, **UNEVEN)
FITS: Any = FOUND.schedule
LONGER = FITS.scaled(3, 1)
CERTIFICATE = FOUND.certificate or ""
KEPT_UNTIL_THE_END = tempfile.TemporaryDirectory(prefix="eeruf-fuzz-")
FOLDER = Path(KEPT_UNTIL_THE_END.name)
SAVED = io.BytesIO()
READINGS.save(SAVED)
# Imports on first use are not growth.
READINGS.to_pandas(), READINGS.to_polars()
HANGS_S = 60


class Nothing:
    """A class that takes no arguments."""


class Chance:
    """Arguments that make sense, nearly make sense, or make none."""

    def __init__(self, seed: int) -> None:
        """Draw the same for the same seed."""
        self.random = random.Random(seed)

    def anything(self, depth: int = 0) -> Any:
        r = self.random
        kinds: list[Callable[[], Any]] = [
            lambda: None,
            lambda: r.random() < 0.5,
            lambda: r.choice(
                [0, 1, 2, 3, 7, 63, 64, 65, 999, 36_000, 2**31, 2**32 - 1, 2**32, 2**63, 2**64, 2**200, -1]
            ),
            lambda: r.choice([0.0, -0.0, 0.5, 1e-300, 1e300, math.inf, -math.inf, math.nan, r.uniform(-9, 9)]),
            lambda: r.choice(["", "line", "ring", "eeruf", "soft", "a", "\0", "\ud800", "x" * 99, "period_us = 1"]),
            lambda: r.choice([np.int8(-3), np.uint8(200), np.uint64(2**64 - 1), np.float32(0.3), np.bool_(True)]),
            lambda: r.choice(
                [
                    b"",
                    object(),
                    ROBOT,
                    ROOM,
                    READINGS,
                    PATHS,
                    tables.TABLE_I_D,
                    sim.Noise(),
                    FOUND,
                    FITS,
                    nav.Himm(3),
                    print,
                    Nothing,
                ]
            ),
            lambda: np.array(r.choices([0.0, 1.0, -2.0, math.nan, math.inf, 9_000.0], k=r.randrange(9))),
            lambda: np.array(r.choices([0.0, 1.0, 5.0, -3.0], k=12)).reshape(
                r.choice([(3, 4), (4, 3), (6, 2), (12, 1)])
            ),
            lambda: np.empty(r.choice([(0,), (0, 4), (3, 0), (1, 1, 1)])),
            lambda: np.array(["a", None], dtype=object),
        ]
        if depth < 3:
            kinds += [
                lambda: [self.anything(depth + 1) for _ in range(r.randrange(4))],
                lambda: tuple(self.anything(depth + 1) for _ in range(r.randrange(4))),
                lambda: {self.word(): self.anything(depth + 1) for _ in range(r.randrange(3))},
            ]
        return r.choice(kinds)()

    def word(self) -> str:
        return self.random.choice(["seed", "robots", "sensors", "walls", "noise", "t_delta_us", "progress", "nonsense"])

    def small(self, most: int = 4) -> Any:
        """Return a number that keeps the work short, or anything but a large number."""
        if self.random.random() < 0.6:
            return self.random.randrange(most + 1)
        thing = self.anything()
        return thing if not isinstance(thing, (int, np.integer, float)) or thing != thing or thing < most else -1

    def mostly(self, good: Any) -> Any:
        """Return a good value most of the time."""
        return good if self.random.random() < 0.7 else self.anything()

    def one_wrong(self, good: dict[str, Any]) -> dict[str, Any]:
        """Return these arguments, half the time with a bad value for one."""
        wrong = {self.random.choice(list(good)): self.anything()} if self.random.random() < 0.5 else {}
        return {**good, **wrong}

    def each(self, good: int, count: int = 4) -> Any:
        """Return a number for all sensors, or a list with one for each, of any kind and sometimes of another length."""
        r = self.random
        near = [
            good + r.choice([0, 0, 0, 1, -1, 500]) for _ in range(r.choice([count, count, count, 0, count + 1, 65]))
        ]
        return self.mostly(
            r.choice([good, near, tuple(near), np.array(near), iter(near), [*near[:-1], self.anything()]])
        )

    def groups(self) -> Any:
        """Return groups of sensors, like those that share a line or fire together."""
        good = self.random.choice(
            [None, [(0, 2)], [[0, 1], (2, 3)], [[0, 1, 2, 3]], np.array([[1, 3]]), [(0,)], [(1, 1)]]
        )
        return self.mostly(good)

    def uneven(self) -> dict[str, Any]:
        """Return some arguments of uneven rings, or none."""
        all_of_it = {
            "refire_us": self.each(60_000),
            "intervals_us": self.mostly([(0, 1, 20_000), (self.anything(), 2, 1_000)][: self.random.randrange(3)]),
            "shared_lines": self.groups(),
            "together": self.groups(),
        }
        return {name: value for name, value in all_of_it.items() if self.random.random() < 0.4}

    def place(self, good: object) -> Any:
        """Return a place to write to: a string names a file in this run's own folder."""
        thing = self.mostly(good)
        return f"{FOLDER}/{thing}" if isinstance(thing, str) else thing

    def file(self, name: str, content: bytes) -> Path:
        """Write a file of this name, most of the time with a piece changed, and return its path."""
        path, changed = FOLDER / name, bytearray(content)
        for _ in range(self.random.randrange(3)):
            at = self.random.randrange(len(changed) + 1)
            changed[at : at + self.random.randrange(4)] = self.random.randbytes(self.random.randrange(4))
        path.write_bytes(changed)
        return path


def calls(c: Chance) -> list[Callable[[], Any]]:
    """Return calls of every entry, with random arguments."""
    a, m = c.anything, c.mostly
    return [
        lambda: ANY.design(
            m(4), m(999), m(15_000), m(36_000), m(1_000), m(4), m("line"), m(False), c.random.randrange(1, 200)
        ),
        lambda: ANY.design(m(8), 999, 15_000, 30_000, atlas=m(True), certificate=False),
        lambda: ANY.design(
            m(4),
            c.each(999),
            m(15_000),
            c.each(36_000),
            budget=c.random.randrange(1, 200),
            atlas=m(False),
            **c.uneven(),
        ),
        lambda: ANY.design(m(3), c.each(999, 3), 15_000, c.each(30_000, 3), certificate=m(True)),
        lambda: FITS.verify(c.each(999), m(0), window_us=c.each(12_000), **c.uneven()),
        lambda: ANY.fit(m(70_000), m(4), c.each(999), m(15_000), c.each(36_000), budget=m(50), **c.uneven()),
        lambda: ANY.curve(m("range"), m(4), c.each(999), m(15_000), c.each(36_000), budget=m(20), **c.uneven()),
        lambda: ANY.check_certificate(mutated(c, CERTIFICATE)),
        lambda: uneven_ring(c),
        lambda: unverified_ring(c),
        lambda: ANY.Schedule(a(), a(), a(), a()),
        lambda: ANY.Schedule.from_firing(m(40_000), m([0, 20_000]), m([2_000, 25_000])),
        lambda: ANY.Schedule.from_toml(a()),
        lambda: ANY.Schedule.from_json(a()),
        lambda: ANY.Schedule.from_toml(mutated(c, SLOW.to_toml())),
        lambda: ANY.Schedule.from_json(mutated(c, SLOW.to_json())),
        lambda: ANY.Schedule.read_toml(m("no such file")),
        lambda: tables.TABLE_I_D.scaled(a(), a()),
        lambda: tables.TABLE_I_D.verify(m(999), m(0), neighbours=m(4), layout=m("line"), criterion=m("exact")),
        lambda: tables.TABLE_I_D.to_rust(m(999), m(0), neighbours=m(4), layout=m("line"), stale_echo=m(False)),
        lambda: tables.TABLE_I_D.to_c(m(999), m(0), neighbours=m(4), window_us=m(0), criterion=m("exact")),
        lambda: ANY.Needs(sensors=m(8), module=m("hc-sr04"), layout=m("ring"), speed_m_s=m(0.5)),
        lambda: ANY.Needs.from_toml(mutated(c, eeruf.example("rings/hc-sr04-8.toml"))),
        lambda: ANY.WaitSearch(m(3), m(40), m(4), m(1), m(None), t_delta_us=m(1), layout=m("line")).count(c.small(50)),
        lambda: ANY.WaitSearch(3, 40, 4, 1, t_delta_us=1).best(m("interval"), c.random.randrange(1, 50)),
        lambda: ANY.WaitSearch(m(3), 40, 4, 1, t_delta_us=m(1)).pareto(),
        lambda: [next(ANY.WaitSearch(3, 40, m(4), 1, m([0, 9, 18]), t_delta_us=1, layout=m([(0, 1)])).all(), None)],
        lambda: ANY.WaitSearch(m(3), 40, 4, 1, t_delta_us=1, criterion=m("exact"), min_interval_us=m(1)).first(),
        lambda: ANY.EchoFilter(m(2), m(500), m(2), echoes=m(1)).push_many(a()),
        lambda: ANY.EchoFilter(2, 500).push(m(0), m(9_000), m(0)),
        lambda: ANY.EchoFilter(2, 500).forget(a()),
        lambda: ANY.EchoFilter(2, 500, echoes=4).push_echoes(m(0), m([9_000, 12_000]), m(0)),
        lambda: ring(c),
        lambda: ANY.Ring.flow(m(8), m({"rest_us": 60_000}), m(0), window_us=m(36_000), blanking_us=a(), reach_us=a()),
        lambda: flow_ring(c),
        lambda: ANY.Fire(a()),
        lambda: ANY.PeriodEnded(a(), a()).to_dict(),
        lambda: pickle.dumps(ANY.PeriodEnded(m(3), m(1), m(40), m(90), m(0), m({"accepted": 8}))),
        lambda: ANY.Reading(a(), a(), a(), a(), a(), a(), a(), a()),
        lambda: ANY.typing.FiredReading(
            m(ANY.Reading(3, "first", 9_000)), m([9_000]), m(0.5), m(0), m([3.0])
        ).to_dict(),
        lambda: ANY.check_certificate(a()),
        lambda: ANY.sim.Material(m(0.9), m(0.0)),
        lambda: ANY.sim.Noise(fading_db_rms=m(1.0), jitter_us_rms=m(1.0), bursts_per_s=m(1.0), burst_db=m(1.0)),
        lambda: ANY.sim.Robot(m((0, 0, 0)), m(4), m(0.2), m(0.1), m("hc_sr04"), gain=m("linear"), t_delta_us=m(500)),
        lambda: ANY.sim.Robot((0, 0, 0), m([(0, 0, 0)]), window_us=m(36_000), velocity_m_s=m((0, 1)), schedule=m(None)),
        lambda: ANY.sim.Robot((0, 0, 0), 4, 0.2, 0.1, waypoints_m=m([(1, 1)]), speed_m_s=m(1), clock_drift_ppm=m(3.0)),
        lambda: ANY.sim.Robot(
            m((0, 0, 0)), 4, 0.2, 0.1, body=m(0.2), turn_rad_s=m(0.1), start_us=m(3), neighbours=m(3)
        ),
        lambda: ROBOT.replace(body=m([(0.2, 0.2), (-0.2, 0.2), (-0.2, -0.2)]), odometry=m(True), consecutive=m(2)),
        lambda: ROBOT.replace(**{c.word(): a(), "consecutive": m(3)}),
        lambda: ANY.sim.Scene(a(), m(None), m(None), m(None), materials=m("soft")),
        lambda: ANY.sim.Scene([[5, 2, -5, 2]], poles=a(), pole_materials=m("soft"), temperature_c=m(20.0)),
        lambda: ANY.sim.Scene([[5, 2, -5, 2]], noise=m(True), seed=m(3), max_order=m(2), robots=m([ROBOT])),
        lambda: ANY.sim.Scene(
            [[5, 2, -5, 2], [5, 3, -5, 3]],
            open=m([0]),
            two_sided=m([1]),
            physics=m({c.word(): a()}),
            pressure_kpa=m(99.0),
        ).to_toml(),
        lambda: ROOM.replace(physics=m("plain"), two_sided=m([0]), humidity_percent=m(20))._repr_svg_(),
        lambda: ROOM.replace(**{c.word(): a()}),
        lambda: ANY.sim.Scene.from_toml(a()),
        lambda: ANY.sim.Scene.from_toml(mutated(c, ROOM.to_toml())),
        lambda: ANY.sim.Scene.read_toml(m("no such file")),
        lambda: ROOM.paths(m((0, 0)), m([(1, 0)]), c.small(3), m(None)),
        lambda: PATHS.points(a()),
        lambda: ANY.sim.simulate(m(ROOM), m("eeruf"), c.small(), m(3)),
        lambda: [*ANY.sim.simulate_blocks(ROOM, m("eeruf"), c.small(), m(3), block_periods=m(2))],
        lambda: ANY.sim.Simulation(m(ROOM), m("eeruf"), seed=m(3)).step(c.small(1)),
        lambda: ANY.sim.Simulation(ROOM).set_velocity(m(0), m(0.5), m(0.1)),
        lambda: ANY.sim.Simulation(ROOM, m("flow")).step_to_reading(c.small(1)),
        lambda: recorded(c),
        lambda: ANY.sim.Simulation(ROOM, filter=lambda _: m(("accepted", a()))).step(0.1),
        lambda: ANY.sim.Simulation(ROOM, firing=lambda _: (m(60_000), [(m(0), m(1))], m(1))).step(0.1),
        lambda: ANY.sim.Simulation(ROOM, firing=m(None), filter=m(None)),
        lambda: ANY.sim.Simulation(ROOM).change_schedule(m(0), m(LONGER)),
        lambda: ANY.sim.Simulation(ROOM).change_scene(m(ROOM)),
        lambda: grid(c),
        lambda: ANY.nav.Himm(m(9), m(0.1), growth=m(False)).cells(),
        lambda: ANY.nav.Vfh(**{c.random.choice(["window", "smoothing", "threshold", "wide", "density_max"]): a()}),
        lambda: ANY.Adaptation(m([tables.TABLE_I_D]), m(500), noisy=m(0.3), calm=m(0.1), window_periods=m(1)),
        lambda: ANY.SensorWatch(m(4), m(3)).observe(m(ANY.Reading(m(3), m("first"), m(9_000))), m(0)),
        lambda: ANY.SensorWatch(4).state(m(3), m(0)),
        lambda: c.random.choice([ANY.typing.Blind, ANY.State, ANY.Fire])(a(), a()).to_dict(),
        lambda: ANY.sim.Simulation(ROOM).robots[0].to_dict(),
        lambda: READINGS.summary(m(500.0)).to_dict(),
        lambda: READINGS.summary(a()),
        lambda: READINGS.is_wrong(a()),
        lambda: tampered(c),
        lambda: ANY.logs.Firings.of(**{name: m(column) for name, column in FIRINGS.columns().items()}),
        lambda: c.random.choice([ANY.logs.diagnose, ANY.logs.survey])(m(FIRINGS), tolerance_us=m(75)),
        lambda: c.random.choice([ANY.read_log, ANY.logs.read_firings])(m("no such file")),
        lambda: list(ANY.logs.blocks(m(io.BytesIO(b"1.2 1.3\n1.3 1.4\n")), rows=m(1), judge=m(ANY.logs.Agree(500)))),
        lambda: ANY.logs.replay(m("no such file"), m("quick"), out=m(None), speed_of_sound=m(343.2)),
        lambda: ANY.read_log(c.file("log.csv", b"time,range\n0.1,0.5\n0.2,0.6\n"), time=m("time")).echo_us(
            speed_of_sound=m(343.2)
        ),
        lambda: log_of_firings(c),
        lambda: ANY.read_log(__file__, time=m(None), range_unit=m("m"), ranges=m(()), no_echo_m=m(5.0)),
        lambda: ANY.example(m("scenes/alcove.toml")),
        lambda: ANY.sim.Scene.read_map(m("no such file"), tolerance_m=m(0.1)),
        lambda: ANY.sim.Scene.read_map(occupancy_map(c), tolerance_m=m(0.1)),
        lambda: ANY.sim.Readings.load(m(io.BytesIO(b"nothing"))),
        lambda: ANY.sim.Readings.load(c.file("readings.npz", SAVED.getvalue())).summary(),
        lambda: READINGS.save(c.place(c.random.choice([io.BytesIO(), FOLDER / "own.npz"]))),
        lambda: ANY.experiments.set_one(
            c.small(1), readings=c.small(8), methods=m(["eeruf"]), progress=c.random.choice([None, False, 3, len])
        ),
        lambda: ANY.experiments.set_two(1, methods=m([]), second_robot=m("behind"), pilot=m("own"), physics=m("plain")),
        lambda: ANY.experiments.set_three(1, periods=m(20), methods=m(["flow"]), physics=m("plain"), height=m("room")),
        lambda: ANY.experiments.compare(m(RUNS), m(RUNS)),
        lambda: ANY.experiments.concat(m([TABLE])),
        lambda: RUNS[0].figures(),
        lambda: [*c.random.choice([ANY.experiments.alcoves, ANY.experiments.courses])(m(3), m(2))[:1]],
        lambda: ANY.experiments.rooms(m(RING_FILE), m(3), m(1), kind=m("hall"), driving=m(False), height=m("flat")),
        # Judging takes a second for each place, and a minute for many: no such ring gets so far.
        lambda: ANY.experiments.recommend(m("absent.toml"), places=m(1), first=m(0), all_ways=m(False)),
        lambda: [*ANY.experiments.Scenes(m("alcove"), m(range(3)), m("plain"))[:2]],
        lambda: ANY.sim.simulate(ROOM, method(c), 5).to_xarray(),
        lambda: READINGS[m(slice(1, 5))],
        lambda: ANY.sim.Readings.concat(m([READINGS, READINGS])),
        lambda: ANY.sim.Readings.from_arrays(m([0, 1]), m([0.0, 0.1]), m([9_000, 8_000]), kind=m([1, 1]), sensors=m(2)),
        lambda: c.random.choice([ANY.typing.is_kind, ANY.typing.is_method])(c.word()),
        lambda: ANY.sim.Simulation(ROOM, method(c)).reset(m(3)),
        lambda: ANY.sim.Simulation(ROOM).set_pose(m(0), m((0, 0, 1))),
        lambda: ANY.experiments.speed_sweep(m([]), seeds=m(1), methods=m([]), bodies=m(True), t_delta_us=m(150)),
    ]


def method(c: Chance) -> Any:
    """Return a method that nearly makes sense."""
    m = c.mostly
    return ANY.sim.Method(
        m(c.random.choice(["eeruf", "flow", "in_turn"])),
        label=m("mine"),
        schedule=m(None),
        settings=m(c.random.choice([None, {"masked_adds_us": m(5_000)}, "quick"])),
        sketch=m(None),
        make_filter=m(c.random.choice([None, lambda robot: lambda firing: m(("clear", None))])),
        make_firing=m(None),
    )


def tried(call: Callable[..., Any], *arguments: Any) -> Any:
    """Return the result of a call; None if it refuses its arguments, as it may."""
    try:
        return call(*arguments)
    except eeruf.EerufError as error:
        assert str(error), "an error says what is wrong"
        return None


def ring(c: Chance) -> None:
    """Run a ring of identical sensors."""
    good = {"t_delta_us": 500, "now_us": c.random.choice([0, 3, 2**32 - 9]), "window_us": 36_000, "consecutive": 2}
    live = ANY.Ring(tables.TABLE_I_D, **c.one_wrong(good), blanking_us=c.random.choice([0, 900]))
    run(c, live, ANY.Adaptation([tables.TABLE_I_D, SLOW], 500, window_periods=1))


def uneven_ring(c: Chance) -> None:
    """Run a ring whose sensors differ, share lines, or rest longer."""
    needs: dict[str, Any] = {**UNEVEN, "shared_lines": [(0, 2)], "now_us": 0, "consecutive": 2}
    if c.random.random() < 0.4:
        needs = {"t_delta_us": c.each(900), "window_us": c.each(12_000), **c.uneven()}
    live = ANY.Ring(c.random.choice([FITS, LONGER]), **c.one_wrong(needs))
    run(c, live, ANY.Adaptation([FITS, LONGER], 1_500, window_periods=1))


def unverified_ring(c: Chance) -> None:
    """Run a ring with any schedule, good or not."""
    firing = {"period_us": 60_000, "t_fire_a_us": [0, 20_000], "t_fire_b_us": [c.random.randrange(60_000), 25_000]}
    good = {"t_delta_us": 500, "now_us": 0, "window_us": c.random.choice([900, 12_000, 36_000]), "blanking_us": 0}
    live = ANY.Ring.unverified(ANY.Schedule.from_firing(**c.one_wrong(firing)), **c.one_wrong(good))
    run(c, live, ANY.Adaptation([SLOW], 500))


def run(c: Chance, live: Any, adaptation: Any) -> None:
    """Poll and disturb a ring at any time; a refused call must leave it unchanged."""
    m, r = c.mostly, c.random
    watch = ANY.SensorWatch(live.sensors, 2)
    now = 0
    for _ in range(r.choice([3, 12, 40])):
        # In time or late; sometimes at an invalid time.
        now = r.choice([live.next_deadline_us, now, now + r.randrange(90_000)])
        event = tried(live.poll, m(now), m(None))
        if event is not None:
            tried(watch.observe, event, m(now))
            tried(adaptation.adapt, m(live), event)
            event.to_dict()
        live.wait_us(now)
        tried(r.choice([live.echo, live.echo, live.fired]), m(r.randrange(live.sensors)), m(now + 9_000))
        if r.random() < 0.2:
            disturb(c, live, now)
        if r.random() < 0.1:
            to = [0, 9, 900, c.anything(), c.each(900, live.sensors)]
            tried(setattr, live, r.choice(["t_delta_us", "window_us", "blanking_us"]), r.choice(to))
            tried(live.change_schedule, m(r.choice([live.schedule, live.schedule.scaled(5, 4), SLOW])))
        assert live.schedule.sensors == live.sensors
    tried(adaptation.max_speed_m_s, m(500), m(343.2))


def disturb(c: Chance, live: Any, now: int) -> None:
    """Do something that may happen to a ring of either kind between two polls."""
    tried(c.random.choice([live.disable, live.enable, live.stuck, live.is_enabled]), c.mostly(1))
    tried(live.wait_us, c.anything())
    c.random.choice([live.pause, live.resume, live.resume, lambda: tried(live.restart, c.mostly(now))])()
    if isinstance(live, ANY.Ring):
        tried(live.upcoming)
        tried(live.measured, c.mostly(1), c.random.choice([None, c.mostly(9_000)]))
        tried(live.answered, c.mostly(1), c.mostly(False))
        tried(live.echo_between, c.mostly(1), c.mostly(now), c.mostly(now + 90))
        tried(c.random.choice([live.state, live.forget]), c.mostly(1))


def recorded(c: Chance) -> None:
    """Run a simulation that writes itself into a file until it is closed."""
    with ANY.sim.Simulation(ROOM, mcap=c.place(FOLDER / "own.mcap")) as live:
        live.step(c.small(0))
        c.random.choice([live.close, lambda: None])()
        live.step(0.1)


def log_of_firings(c: Chance) -> None:
    """Read and replay a log of firings with changed bytes."""
    rows = "".join(f"{at % 2},{40_000 * at},{at // 2},{at // 2 % 2},{9_000 + at}\n" for at in range(8))
    file = c.file("firings.csv", f"sensor,fired_us,period,phase,t_echo_us\n{rows}".encode())
    c.random.choice(
        [
            ANY.logs.read_firings,
            lambda file: ANY.logs.replay(file, ANY.logs.Agree(500)),
            ANY.logs.diagnose,
            ANY.logs.survey,
        ]
    )(file)


def occupancy_map(c: Chance) -> Path:
    """Write a map of 6 by 4 cells, with one of its files changed."""
    c.file("map.pgm", b"P5 6 4 255\n" + bytes([0, 0, 0, 0, 0, 0, 0, 254, 254, 254, 254, 0] * 2))
    return c.file(
        "map.yaml",
        b"image: map.pgm\nresolution: 0.5\norigin: [0, 0, 0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.2\n",
    )


def grid(c: Chance) -> None:
    """Fill a grid, and steer by it."""
    m = c.mostly
    live, vfh = ANY.nav.Himm(9), ANY.nav.Vfh()
    for _ in range(6):
        tried(live.echo, m((0.0, 0.0, 1.0)), m(0.4), m(0.0))
        tried(live.clear, m((0.0, 0.0, 1.0)), m(0.4), m(0.0))
        tried(live.move_to, m((0.1, 0.3)))
        tried(lambda: live.enter(m(READINGS), m(3.0), m(0.0), robot=m(0), sound_m_s=m(343.2)))
    tried(live.value, c.anything())
    live.to_numpy()
    tried(vfh.histogram, m(live), m((0.0, 0.0)))
    tried(vfh.steer, m(live), m((0.0, 0.0)), m((1.0, 0.0)))
    tried(lambda: vfh.drive(m(live), m((0.0, 0.0, 0.0)), m((1.0, 0.0)), m(0.0), turn_gain=m(3.0)))


def flow_ring(c: Chance) -> None:
    """Poll and disturb a flow ring at any time."""
    m, r = c.mostly, c.random
    good = {"settings": {"seed": 1}, "now_us": 0, "window_us": 36_000, "blanking_us": 0, "reach_us": None}
    live = ANY.Ring.flow(8, **c.one_wrong(good))
    now = 0
    for _ in range(r.choice([3, 12, 40])):
        now = r.choice([live.next_deadline_us, now, now + r.randrange(90_000)])
        tried(live.poll, m(now), m(None))
        live.wait_us(now)
        tried(r.choice([live.echo, live.echo, live.fired]), m(r.randrange(8)), m(now + 9_000))
        tried(live.state, m(3))
        tried(live.moving, m(0.5), m(0.1), m(now))
        if r.random() < 0.2:
            disturb(c, live, now)


def mutated(c: Chance, text: str) -> str:
    """Return a text with a piece of it changed."""
    at = c.random.randrange(len(text))
    return (
        text[:at] + c.random.choice(["", "9", "-", "[", "\n", "nan", "1e999", "x"]) + text[at + c.random.randrange(4) :]
    )


def tampered(c: Chance) -> Any:
    """Make readings from tampered columns."""
    reduced: Any = READINGS.__reduce__()
    rebuild, (method, duration_s, sensors, columns, paths) = reduced
    name = c.random.choice(list(columns))
    column = columns[name].copy()
    column[c.random.randrange(len(column))] = c.random.choice([0, 1, -1, 64, 100, -128, 127])
    changed = {**columns, name: c.mostly(column)}
    readings = rebuild(c.mostly(method), c.mostly(duration_s), c.mostly(sensors), changed, c.mostly(paths))
    if c.random.random() < 0.02:
        c.random.choice([readings.to_pandas, readings.to_polars])()
    return readings.summary(), pickle.dumps(readings)


class Used(NamedTuple):
    """Memory of a process after all unused memory has been given back."""

    resident_mb: float
    """Memory of the machine in use, including idle parts between used pieces."""
    heap_mb: float
    """Memory from malloc that was not freed: of Rust, of NumPy, and of Python where it does not manage its own."""
    objects: int
    """Number of memory blocks that Python manages itself."""

    def __str__(self) -> str:
        return f"{self.resident_mb:.1f} MB resident, {self.heap_mb:.3f} MB of the heap, {self.objects} objects"


# The growth allowed in the second half of a run of any length: more is a leak, since caches have filled by then.
MOST_GROWN = Used(resident_mb=8.0, heap_mb=0.5, objects=3_000)


class _MallInfo(ctypes.Structure):
    _fields_ = tuple(
        (name, ctypes.c_size_t)
        for name in (
            "arena",
            "ordblks",
            "smblks",
            "hblks",
            "hblkhd",
            "usmblks",
            "fsmblks",
            "uordblks",
            "fordblks",
            "top",
        )
    )


def resident_mb() -> float:
    """Return the process's memory, on Linux."""
    status = Path("/proc/self/status").read_text() if sys.platform == "linux" else "VmRSS: 0"
    return int(status.split("VmRSS:")[1].split()[0]) / 1024


def used() -> Used:
    """Return the memory used now, on Linux with glibc; elsewhere zeros for unknown figures."""
    gc.collect()
    libc, heap_bytes = ctypes.CDLL(None), 0
    if hasattr(libc, "mallinfo2"):
        libc.malloc_trim(0)
        libc.mallinfo2.restype = _MallInfo
        of = libc.mallinfo2()
        heap_bytes = of.uordblks + of.hblkhd
    return Used(resident_mb(), heap_bytes / 1e6, getattr(sys, "getallocatedblocks", int)())


def fuzz(number: int, seed: int, *, report_every: int = 0) -> tuple[Counter[str], list[Used]]:
    """Make this many calls; return how they ended, and the memory used after each tenth of them and at the end."""
    chance, ended, tenths = Chance(seed), Counter[str](), list[Used]()
    # Imports by calls are not growth.
    for name in ("pandas", "polars", "pyarrow", "xarray", "dask.array", "distributed", "matplotlib.pyplot"):
        with contextlib.suppress(ImportError):
            importlib.import_module(name)
    # Python keeps each warning that it has shown.
    warnings.simplefilter("ignore", eeruf.EerufWarning)
    began = time.monotonic()
    table = calls(chance)
    for call in range(number):
        if call % 100 == 0:
            faulthandler.dump_traceback_later(HANGS_S, exit=True)
        if call > 0 and call % max(1, number // 10) == 0:
            tenths.append(used())
        if report_every > 0 and call % report_every == 0:
            before_mb = resident_mb()
            print(
                f"{call} calls, {time.monotonic() - began:.0f} s, {before_mb:.0f} MB, given back: {used()}", flush=True
            )
        try:
            chance.random.choice(table)()
            ended["fine"] += 1
        except (eeruf.EerufError, MemoryError, OSError) as error:
            assert str(error), "an error says what is wrong"
            ended[type(error).__name__] += 1
        except TypeError as error:
            # Only about the names of arguments.
            assert "argument" in str(error), (call, error)
            ended["TypeError"] += 1
    faulthandler.cancel_dump_traceback_later()
    return ended, [*tenths[:9], used()]


def grown(tenths: list[Used]) -> Used:
    """Return the growth in the second half of the run."""
    half, end = tenths[4], tenths[-1]
    return Used(end.resident_mb - half.resident_mb, end.heap_mb - half.heap_mb, end.objects - half.objects)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--calls", type=int, default=100_000)
    parser.add_argument("--seed", type=int, default=1)
    asked = parser.parse_args()
    how, at = fuzz(asked.calls, asked.seed, report_every=100_000)
    print(dict(how.most_common()))
    print(f"in the end {at[-1]}; in the second half came {grown(at)}")
    if any(came > most for came, most in zip(grown(at), MOST_GROWN)):
        sys.exit(f"grew by more than {MOST_GROWN}")

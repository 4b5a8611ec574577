"""Whatever is wrong raises one clear error, and nothing panics."""

import math
import time
import warnings
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any, Callable

import eeruf
import matplotlib.figure
import numpy as np
import pytest
from eeruf import sim, tables
from hypothesis import given, settings, strategies as st

ANYTHING = st.one_of(
    st.none(),
    st.booleans(),
    st.integers(),
    st.integers(-2, 70),
    st.floats(),
    st.text(max_size=3),
    st.lists(st.integers(-1, 2**33), max_size=3),
)

RING = Path(__file__).parents[2] / "rings/paper-12.toml"
# For calls that a type checker would refuse.
ANY: Any = eeruf
NEEDS = eeruf.Needs(sensors=8, module="hc-sr04", layout="ring")
WALL = sim.Scene([[0, 0, 1, 0]])
ROOM = sim.Scene([[5, 2, -5, 2]], robots=[sim.Robot((0, 0, 1.57), 8, 0.26, 0.3)])
FIRINGS = eeruf.logs.Firings.of(sensor=[0], fired_us=[0], period=[0], phase=[0], t_echo_us=[7000.0])

BAD: list[tuple[Callable[[], Any], type[Exception], str]] = [
    (lambda: eeruf.design(0, 1, 1, 1), eeruf.EerufError, "sensors = 0; expected a whole number from 1 to 64"),
    (lambda: eeruf.design(65, 1, 1, 1), eeruf.EerufError, "sensors = 65"),
    (lambda: eeruf.design(4, -1, 1, 1), eeruf.EerufError, "t_delta_us = -1"),
    (lambda: eeruf.design(4, 1, 1, 0), eeruf.EerufError, "window_us = 0"),
    (lambda: eeruf.Schedule(10, (1, 2), (1,), (2,)), eeruf.EerufError, "phase a has 1 waits; expected one for each"),
    (lambda: eeruf.EchoFilter(4, 500, 9), eeruf.EerufError, "9 consecutive readings; expected 2 to 8"),
    (
        lambda: eeruf.EchoFilter(4, 500, echoes=9),
        eeruf.EerufError,
        "echoes = 9; expected a whole number from 1 to 8",
    ),
    (lambda: eeruf.EchoFilter(4, 500).push_echoes(0, [1, -2]), eeruf.EerufError, r"t_echoes_us\[1\] = -2"),
    (
        lambda: eeruf.Ring(tables.TABLE_I_D, 500, window_us=36_000).poll(0, [1, 2]),
        eeruf.EerufError,
        r"expected_change_us = \[1, 2\]; expected a sequence of 12 whole numbers",
    ),
    (
        lambda: eeruf.EchoFilter(4, 500).push(4, 1),
        eeruf.EerufError,
        "sensor = 4; expected a whole number from 0 to 3",
    ),
    (lambda: eeruf.EchoFilter(4, 500).push_many(np.zeros((2, 3))), eeruf.EerufError, "shape of t_echo_us"),
    (lambda: eeruf.EchoFilter(1, 500).push_many([[1], [-1]]), eeruf.EerufError, r"t_echo_us\[1, 0\] = -1"),
    (lambda: eeruf.Ring(tables.TABLE_I_D, 500, window_us=0), eeruf.EerufError, "window of 0 us"),
    (lambda: eeruf.WaitSearch(4, 100, 10, 0, t_delta_us=1), eeruf.EerufError, "tick"),
    (lambda: sim.Scene([[0, 0, math.nan, 1]]), eeruf.EerufError, "wall 0"),
    (lambda: sim.Scene([[0, 0, 1]]), eeruf.EerufError, "shape of walls"),
    (lambda: sim.Scene([[0, 0, 1, 0]]).paths((0, math.nan), [(1, 1)], 2), eeruf.EerufError, "source"),
    (lambda: sim.simulate(sim.Scene([[0, 0, 1, 0]])), eeruf.EerufError, "0 robots"),
    (lambda: eeruf.experiments.set_one(0), eeruf.EerufError, "seeds = 0"),
    (lambda: ANY.experiments.set_one(1, methods=["loud"]), eeruf.EerufError, "no method `loud`"),
    (lambda: eeruf.experiments.set_one(1, methods=[]), eeruf.EerufError, "no methods"),
    # The same for what is not a number at all, and for everything that came later.
    (lambda: ANY.design(b"4", 1, 1, 1), eeruf.EerufError, "sensors = b'4'; expected a whole number from 1 to 64"),
    (lambda: eeruf.design("none.toml"), eeruf.EerufError, "none.toml: No such file .*; expected a file that exists"),
    (
        lambda: eeruf.design(4),
        eeruf.EerufError,
        "t_delta_us = None; expected t_delta_us, min_interval_us and window",
    ),
    (lambda: eeruf.design(4, 1, 1), eeruf.EerufError, "window_us = None; expected t_delta_us, min_interval_us and"),
    (lambda: eeruf.design(NEEDS, 500), eeruf.EerufError, "t_delta_us = 500; expected none beside a Needs"),
    (lambda: tables.TABLE_I_D.verify(NEEDS), eeruf.EerufError, "expected needs of 12 sensors, as the schedule has"),
    (lambda: eeruf.Ring.flow(NEEDS, window_us=9_000), eeruf.EerufError, "window_us = 9000; expected none beside a"),
    (
        lambda: eeruf.Ring.flow(NEEDS, reach_us=9_000),
        eeruf.EerufError,
        "reach_us = 9000; expected none beside a Needs",
    ),
    (lambda: eeruf.Needs(sensors=8), eeruf.EerufError, 'module: missing; expected `module = "hc-sr04"`'),
    (lambda: eeruf.Needs(sensor=8), eeruf.EerufError, "sensor"),
    (lambda: eeruf.Needs.from_toml("sensors = 8\nmodule = 4"), eeruf.EerufError, "line 2"),
    (lambda: ANY.design(4.0, 1, 1, 1), eeruf.EerufError, "sensors = 4.0"),
    (lambda: ANY.design(True, 1, 1, 1), eeruf.EerufError, "sensors = True"),
    (lambda: ANY.design(4, math.nan, 1, 1), eeruf.EerufError, "t_delta_us = nan"),
    (
        lambda: ANY.design(4, 1, 1, 1, stale_echo="yes"),
        eeruf.EerufError,
        "stale_echo = 'yes'; expected True or False",
    ),
    (lambda: ANY.design(4, 1, 1, 1, layout="star"), eeruf.EerufError, "layout = 'star'; expected \"line\""),
    (
        lambda: eeruf.design(3, 999, 12_000, 36_000, layout=[(1, 2), (2, 3)]),
        eeruf.EerufError,
        r"layout = \[\(2, 3\)\]; expected pairs of two different sensors from 0 to 2",
    ),
    (
        lambda: eeruf.WaitSearch(4, 100, 10, 1, t_delta_us=1, layout=[(0, 4)]),
        eeruf.EerufError,
        r"layout = \[\(0, 4\)\]; expected pairs .* from 0 to 3",
    ),
    (
        lambda: tables.TABLE_I_D.verify(999, layout=[(0, 12)]),
        eeruf.EerufError,
        r"layout = \[\(0, 12\)\]; expected pairs .* from 0 to 11",
    ),
    (
        lambda: tables.TABLE_I_D.to_c(999, layout=[(0, 1), (1, 1)]),
        eeruf.EerufError,
        r"layout = \[\(1, 1\)\]; expected pairs of two different",
    ),
    (
        lambda: ANY.design(4, 1, 1, 1, progress=3),
        eeruf.EerufError,
        "progress = 3; expected None, True or a callable",
    ),
    (lambda: ANY.design(4, 1, 1, 1, atlas="yes"), eeruf.EerufError, "atlas = 'yes'; expected True or False"),
    (lambda: ANY.read_log(3), eeruf.EerufError, "log = 3; expected the path of a log, a URL or a file object"),
    (lambda: ANY.read_log("x", ranges="cm"), eeruf.EerufError, "ranges = 'cm'; expected the names of columns"),
    (lambda: ANY.read_log("x", time=3), eeruf.EerufError, "time = 3; expected the name of a column, or None"),
    (lambda: ANY.read_log("x", time_unit="h"), eeruf.EerufError, 'time_unit = \'h\'; expected "s" or "ms"'),
    (lambda: ANY.read_log("x", no_echo_m=0), eeruf.EerufError, "no_echo_m = 0; expected a number above 0"),
    (
        lambda: ANY.logs.diagnose(3),
        eeruf.EerufError,
        "log = 3; expected an eeruf.logs.Firings, or the path of a log, a URL or a file object",
    ),
    (lambda: ANY.logs.survey(FIRINGS, until_us=-1), eeruf.EerufError, "until_us = -1"),
    (
        lambda: ANY.logs.Firings.of(sensor=["a"], fired_us=[0], period=[0], phase=[0], t_echo_us=[1]),
        eeruf.EerufError,
        r"sensor = \['a'\]; expected numbers, one for each firing",
    ),
    (
        lambda: ANY.logs.Firings.of(sensor=3, fired_us=[0], period=[0], phase=[0], t_echo_us=[1]),
        eeruf.EerufError,
        r"sensor has the shape \(\); expected one number for each firing",
    ),
    (lambda: eeruf.design(4, 1, 1, 1, budget=0), eeruf.EerufError, "budget = 0"),
    (
        lambda: ANY.tables.TABLE_I_D.verify(1, criterion="strict"),
        eeruf.EerufError,
        'criterion = \'strict\'; expected "exact" or "paper"',
    ),
    (lambda: eeruf.Schedule.from_toml("period_us ="), eeruf.EerufError, "."),
    (lambda: eeruf.Schedule.from_json("{}"), eeruf.EerufError, "line 1: period_us: missing; expected `period_us"),
    (lambda: eeruf.Schedule.from_json(""), eeruf.EerufError, "line 1: EOF while parsing a value; expected JSON"),
    (lambda: ANY.Schedule.from_json(b"{}"), eeruf.EerufError, "text = b'{}'; expected a schedule in JSON"),
    (lambda: tables.TABLE_I_D.scaled(1, 0), eeruf.EerufError, "0"),
    (lambda: eeruf.Schedule(10, (), (), ()), eeruf.EerufError, "0 sensors"),
    (lambda: eeruf.Schedule.from_firing(10, [0] * 65, [0] * 65), eeruf.EerufError, "65 sensors"),
    (lambda: eeruf.Schedule.from_firing(10, [0], [-1]), eeruf.EerufError, r"t_fire_b_us\[0\] = -1"),
    (lambda: ANY.WaitSearch(4, 100, 10, 1, t_delta_us=1).best("speed"), eeruf.EerufError, "objective = 'speed'"),
    (lambda: eeruf.WaitSearch(4, 100, 10, 1, t_delta_us=1).count(0), eeruf.EerufError, "limit = 0"),
    (lambda: eeruf.EchoFilter(1, 500).push(0, -5), eeruf.EerufError, "t_echo_us = -5"),
    (lambda: eeruf.EchoFilter(1, 500).push_many([[math.inf]]), eeruf.EerufError, r"t_echo_us\[0, 0\] = inf"),
    (lambda: eeruf.EchoFilter(1, 500).push_many([["a"]]), eeruf.EerufError, "t_echo_us = .*array of floats"),
    (lambda: eeruf.EchoFilter(2, 500).push_many(np.zeros(2)), eeruf.EerufError, r"shape of t_echo_us = \(2,\)"),
    (lambda: ANY.Ring("I-d", 500, window_us=1), eeruf.EerufError, "schedule = 'I-d'; expected an eeruf.Schedule"),
    (lambda: eeruf.Ring(tables.TABLE_I_D, 500, window_us=90_000), eeruf.EerufError, "listening window of 90 ms"),
    (lambda: eeruf.Fire(64), eeruf.EerufError, "sensor = 64; expected a whole number from 0 to 63"),
    (
        lambda: ANY.Reading(0, "ambiguous", explained_by=64),
        eeruf.EerufError,
        'explained_by = 64; expected 0 to 63, "history" or None',
    ),
    (lambda: ANY.Reading(0, "loud"), eeruf.EerufError, "kind = 'loud'; expected \"first\" or"),
    (lambda: sim.Robot((0, 0), 8, 0.2, 0.3), eeruf.EerufError, r"pose = \(0, 0\); expected \(x, y, heading\)"),  # type: ignore[arg-type]
    (lambda: sim.Robot((0, math.nan, 0), 8, 0.2, 0.3), eeruf.EerufError, r"pose\[1\] = nan"),
    (lambda: sim.Robot((0, 0, 0), 65, 0.2, 0.3), eeruf.EerufError, "sensors = 65"),
    (
        lambda: ANY.sim.Robot((0, 0, 0), 8, 0.2, 0.3, "bat"),
        eeruf.EerufError,
        "module = 'bat'; expected \"polaroid-6500\"",
    ),
    (lambda: sim.Scene([[0, 0, 1, 0]], open=[1]), eeruf.EerufError, "open = 1; expected a whole number from 0 to 0"),
    (lambda: sim.Scene([], open=[0]), eeruf.EerufError, r"open = \[0\]; expected no indices"),
    (lambda: sim.Scene([], robots=[3]), eeruf.EerufError, "robots = 3; expected a sequence of eeruf.sim.Robot"),  # type: ignore[list-item]
    (lambda: sim.Scene([], poles=[[0, 0, -1]]), eeruf.EerufError, "pole 0"),
    (lambda: sim.Scene.from_toml("nowhere.toml"), eeruf.EerufError, "text, line 1"),
    (lambda: ANY.sim.Scene.from_toml(3), eeruf.EerufError, "text = 3; expected a scene in TOML; read_toml"),
    (lambda: eeruf.Schedule.read_toml("nowhere.toml"), eeruf.EerufError, "nowhere.toml: No such file"),
    (lambda: sim.Scene.read_toml("nowhere.toml"), eeruf.EerufError, "nowhere.toml"),
    # The report of the program: line, key, value and expectation, and the kind of the file.
    (lambda: eeruf.Schedule.from_toml("period_us = -1"), eeruf.EerufError, "line 1: period_us: integer `-1`; "),
    (lambda: eeruf.Schedule.read_toml(RING), eeruf.EerufError, "ring for `eeruf design`; expected a schedule"),
    (lambda: sim.Scene.read_toml(RING), eeruf.EerufError, "this is a ring for `eeruf design`; expected a scene"),
    (lambda: sim.Scene.read_toml(3), eeruf.EerufError, "path = 3"),  # type: ignore[arg-type]
    (lambda: WALL.paths((0, -1), [(1, -1)], 1001), eeruf.EerufError, "paths up to order 1001; expected at most 1000"),
    (lambda: WALL.paths((0, -1), [(1, -1)], 1, math.nan), eeruf.EerufError, "max_length_m = nan"),
    (lambda: WALL.paths((0, -1), [(1, -1)], 1, 0), eeruf.EerufError, "paths up to 0 m"),
    (lambda: WALL.paths([(0, -1), (0, -2)], [(1, -1)], 1), eeruf.EerufError, "source = .*; expected one point"),
    (lambda: WALL.paths((0, -1), (1, -1), 1).points(9), eeruf.EerufError, "path = 9"),
    (lambda: WALL.paths((0, -1), (1, -1), 1, 0.1).points(0), eeruf.EerufError, "path = 0; expected no index where"),
    (
        lambda: sim.Scene([], robots=[sim.Robot((0, 0, 0), 8, 0.2, 0.3), sim.Robot((0.1, 0, 0), 8, 0.2, 0.3)]),
        eeruf.EerufError,
        "are 0.100 m apart; expected more than 0.600 m",
    ),
    (lambda: ANY.sim.Simulation(3), eeruf.EerufError, "scene = 3; expected an eeruf.sim.Scene"),
    (lambda: sim.Simulation(ROOM).step(-1), eeruf.EerufError, "seconds = -1; expected a number from 0"),
    (lambda: sim.Simulation(ROOM).set_velocity(1, 0, 0), eeruf.EerufError, "robot = 1; expected .* from 0 to 0"),
    (lambda: sim.Simulation(ROOM).set_velocity(0, 51, 0), eeruf.EerufError, "v_m_s = 51; expected"),
    (lambda: sim.simulate_blocks(ROOM, block_periods=0), eeruf.EerufError, "block_periods = 0"),
    (lambda: ANY.sim.simulate_blocks(ROOM, progress=3), eeruf.EerufError, "progress = 3"),
    (lambda: ANY.sim.simulate(ROOM, "loud"), eeruf.EerufError, "no method `loud`; expected simultaneous"),
    (lambda: sim.simulate(ROOM, periods=0), eeruf.EerufError, "periods = 0"),
    (lambda: sim.simulate(ROOM, seed=-1), eeruf.EerufError, "seed = -1"),
    (lambda: sim.simulate(3), eeruf.EerufError, "scene = 3; expected an eeruf.sim.Scene"),  # type: ignore[arg-type]
    (lambda: sim.simulate(ROOM, periods=2).summary(-1), eeruf.EerufError, "tolerance_us = -1"),
    (lambda: eeruf.experiments.set_one(100_001), eeruf.EerufError, "seeds = 100001; expected .* from 1 to 100000"),
    (
        lambda: ANY.experiments.set_one(1, methods="eeruf"),
        eeruf.EerufError,
        "methods = 'eeruf'; expected a sequence",
    ),
    (lambda: eeruf.experiments.set_two(0), eeruf.EerufError, "seeds = 0"),
    (lambda: eeruf.experiments.set_three(1, periods=9), eeruf.EerufError, "periods = 9"),
    (lambda: ANY.experiments.set_three(1, methods=["fast"]), eeruf.EerufError, "no method `fast`"),
    (lambda: eeruf.experiments.set_three(1, methods=[]), eeruf.EerufError, "no methods"),
    (lambda: eeruf.experiments.set_two(1, methods=[]), eeruf.EerufError, "no methods"),
    (
        lambda: eeruf.experiments.set_two(1, speed_m_s=9),
        eeruf.EerufError,
        "speed_m_s = 9; expected a number from 0.1 to 5",
    ),
    (lambda: eeruf.experiments.set_two(1, second_robot="here"), eeruf.EerufError, "second_robot = 'here'"),  # type: ignore[arg-type]
    (lambda: eeruf.experiments.set_two(1, second_robot=(math.nan, 1)), eeruf.EerufError, "."),
    (lambda: eeruf.experiments.set_two(1, t_delta_us=-1), eeruf.EerufError, "t_delta_us = -1"),
    (lambda: eeruf.experiments.set_two(1, odometry="no"), eeruf.EerufError, "odometry = 'no'"),  # type: ignore[arg-type]
    (
        lambda: ANY.experiments.set_two(1, pilot="mine"),
        eeruf.EerufError,
        "pilot = 'mine'; expected .*own.*shared.*published.*published-gro",
    ),
    (lambda: ANY.experiments.set_two(1, odometry_noise="no"), eeruf.EerufError, "odometry_noise = 'no'"),
    (lambda: eeruf.experiments.set_one(1, first=-1), eeruf.EerufError, "first = -1"),
    (lambda: eeruf.experiments.speed_sweep([]), eeruf.EerufError, r"speeds_m_s = \[\]; expected one speed or more"),
    (lambda: eeruf.experiments.speed_sweep([1.0, -1]), eeruf.EerufError, r"speeds_m_s\[1\] = -1"),
    (lambda: ANY.plot.timing(3), eeruf.EerufError, "schedule = 3; expected an eeruf.Schedule"),
    (lambda: ANY.plot.timing(tables.TABLE_I_D, window_us=-1), eeruf.EerufError, "window_us = -1"),
    (lambda: ANY.plot.scene(3), eeruf.EerufError, "scene = 3; expected an eeruf.sim.Scene"),
    (lambda: ANY.plot.scene(WALL, 3), eeruf.EerufError, "paths = 3; expected eeruf.typing.Paths"),
    (lambda: ANY.plot.scene(WALL, source=(1, 2, 3)), eeruf.EerufError, "source = .*; expected one point"),
    (lambda: ANY.plot.readings(3), eeruf.EerufError, "readings = 3; expected eeruf.sim.Readings"),
    (lambda: ANY.plot.readings(sim.simulate(ROOM, periods=2), sensor=99), eeruf.EerufError, "sensor = 99; expected"),
    (lambda: ANY.plot.methods(3), eeruf.EerufError, "result = 3; expected what eeruf.experiments.set_one"),
]


@pytest.mark.parametrize(("call", "error", "message"), BAD, ids=[message for _, _, message in BAD])
def test_bad_input_is_refused_by_name_value_and_expectation(
    call: Callable[[], Any], error: type[Exception], message: str
) -> None:
    with pytest.raises(error, match=message) as raised:
        call()
    assert isinstance(raised.value, eeruf.EerufError)
    assert isinstance(raised.value, ValueError)


# Whole calls of all kinds; numbers stay small where more would only take long.
SMALL = st.one_of(
    st.none(), st.booleans(), st.integers(-2, 3), st.floats(), st.text(max_size=2), st.lists(st.floats(), max_size=3)
)
ARRAY = st.one_of(
    ANYTHING,
    st.lists(st.lists(st.floats(), min_size=2, max_size=4), max_size=3),
    st.lists(st.lists(st.floats(-9, 9), min_size=4, max_size=4), max_size=3),
)


@settings(deadline=None)
@given(st.lists(ANYTHING, min_size=4, max_size=4), ANYTHING)
def test_the_core_never_panics_whatever_it_is_given(arguments: list[Any], layout: Any) -> None:
    refuse(
        lambda: ANY.design(*arguments, layout=layout, budget=100),
        lambda: ANY.design(4, 999, 15_000, 36_000, tick_us=arguments[0], layout=layout, stale_echo=arguments[1]),
        lambda: ANY.Schedule(*arguments),
        lambda: ANY.Schedule.from_firing(*arguments[:3]),
        lambda: ANY.Schedule.from_toml(arguments[0]),
        lambda: ANY.Schedule.from_json(arguments[0]),
        lambda: ANY.tables.TABLE_I_D.verify(
            *arguments[:2], layout=layout, window_us=arguments[2], together=arguments[3]
        ),
        lambda: ANY.tables.TABLE_I_D.to_rust(*arguments[:2], neighbours=arguments[2], layout=layout),
        lambda: ANY.tables.TABLE_I_D.to_c(*arguments[:2], neighbours=arguments[2], layout=layout),
        lambda: tables.TABLE_I_D.scaled(*arguments[:2]),
        lambda: ANY.WaitSearch(4, *arguments[:3], arguments[3], t_delta_us=layout).first(),
        lambda: ANY.WaitSearch(arguments[0], 100, 10, 1, arguments[1], t_delta_us=arguments[2], layout=layout).count(
            10
        ),
        lambda: ANY.WaitSearch(4, 100, 10, 1, t_delta_us=1).best(arguments[0], arguments[1]),
        lambda: ANY.EchoFilter(arguments[0], arguments[1], arguments[2]).push(0, arguments[3]),
        lambda: ANY.EchoFilter(4, 500).push(arguments[0], arguments[1], arguments[2]),
        lambda: ANY.EchoFilter(4, 500, echoes=arguments[3]).push_echoes(0, arguments[0]),
        lambda: ANY.EchoFilter(4, 500).forget(arguments[0]),
        lambda: ANY.Ring(tables.TABLE_I_D, 500, window_us=36_000).poll(arguments[0], arguments[1]),
        lambda: ANY.Ring(tables.TABLE_I_D, arguments[0], arguments[1], window_us=arguments[2]).poll(arguments[3]),
        lambda: ANY.Ring(arguments[0], 500, window_us=36_000),
        lambda: ANY.Ring(tables.TABLE_I_D, 500, window_us=36_000).echo(arguments[0], arguments[1]),
        lambda: ANY.Ring(tables.TABLE_I_D, 500, window_us=36_000).disable(arguments[0]),
        lambda: ANY.Fire(arguments[0]),
        lambda: ANY.Reading(*arguments),
        lambda: ANY.typing.Violation(*arguments, layout, arguments[0]),
        lambda: ANY.Report(*arguments, layout),
        lambda: ANY.Found(*arguments, layout, arguments[0]),
    )


@settings(deadline=None)
@given(ARRAY, ARRAY, st.lists(SMALL, min_size=6, max_size=6))
def test_the_simulator_never_panics_whatever_it_is_given(array: Any, other: Any, arguments: list[Any]) -> None:
    refuse(
        lambda: ANY.EchoFilter(2, 500).push_many(array),
        lambda: ANY.sim.Scene(array, arguments[0], arguments[1], other),
        lambda: ANY.sim.Scene(array, poles=other).paths(arguments[0], arguments[1], arguments[2], arguments[3]),
        lambda: ANY.sim.Scene(array).paths((0.3, 0.7), other, 2),
        lambda: ANY.sim.Scene(
            array, noise=arguments[0], seed=arguments[1], max_order=arguments[2], robots=arguments[3]
        ),
        lambda: ANY.sim.Scene(array, robots=[ROBOT]),
        lambda: WALL.paths(array, other, 2).points(arguments[0]),
        lambda: ANY.sim.Scene.read_toml(arguments[0]),
        lambda: ANY.sim.Robot(array, 8, *arguments[:2]),
        lambda: ANY.sim.Robot((0, 0, 1.5), 8, arguments[0], arguments[1], arguments[2], period_us=arguments[3]),
        lambda: ANY.sim.Robot(
            (0, 0, 1.5), 8, 0.2, 0.3, t_delta_us=arguments[0], window_us=arguments[1], schedule=arguments[2]
        ),
        lambda: ANY.sim.simulate(ROOM, arguments[0], arguments[1], arguments[2]),
        lambda: ANY.sim.simulate(ROOM, periods=arguments[0], progress=arguments[1]),
        lambda: ANY.sim.simulate(ROOM, periods=3).summary(arguments[0]),
        lambda: ANY.sim.simulate(ROOM, periods=3).is_wrong(arguments[0]),
    )


@settings(deadline=None, max_examples=50)
@given(ARRAY, st.lists(SMALL, min_size=6, max_size=6))
def test_experiments_and_figures_never_panic(array: Any, arguments: list[Any]) -> None:
    one, two, three, four, *_ = arguments
    refuse(
        lambda: ANY.experiments.set_one(one, readings=two, methods=three or ["eeruf"], progress=four),
        lambda: ANY.experiments.set_two(1, methods=["eeruf"], second_robot=array, speed_m_s=one, odometry=two),
        lambda: ANY.experiments.set_two(one, methods=two or ["eeruf"], t_delta_us=three, first=four),
        lambda: ANY.experiments.speed_sweep(array, seeds=1, methods=["eeruf"]),
        lambda: ANY.plot.timing(one, window_us=two),
        lambda: ANY.plot.timing(tables.TABLE_I_D, window_us=one, ax=AX),
        lambda: ANY.plot.scene(WALL, one, source=two, receivers=array, most=three, ax=AX),
        lambda: ANY.plot.readings(FEW, sensor=one, robot=two, first=three, count=four, ax=AX),
        lambda: ANY.plot.methods({"methods": one}, figure=two, ax=AX),
        lambda: ANY.plot.methods(STANDING, figure=one, names=two, ax=AX),
        lambda: ANY.plot.course(DRIVING, method=one, course=two, ax=AX),
        lambda: ANY.plot.course(array, ax=AX),
    )


@pytest.mark.parametrize("call", [ANY.design, ANY.Ring.flow, ANY.tables.TABLE_I_D.verify, ANY.tables.TABLE_I_D.to_c])
def test_an_unknown_keyword_is_a_type_error(call: Any) -> None:
    with pytest.raises(TypeError, match=r"\(\) got an unexpected keyword argument 'layouts'"):
        call(4, layouts="ring")


def refuse(*calls: Callable[[], Any]) -> None:
    """Check that calls work, or raise a clear error, and nothing else."""
    for call in calls:
        try:
            call()
        except eeruf.EerufError as error:
            assert len(str(error)) > 10


ROBOT = sim.Robot((0.3, 0.7, 1.57), 2, 0.26, 0.1)
INLINE = ThreadPoolExecutor(1)
AX = matplotlib.figure.Figure().subplots()
FEW = sim.simulate(ROOM, periods=3)
STANDING = eeruf.experiments.set_one(1, readings=8, methods=["eeruf"])
DRIVING = eeruf.experiments.set_two(1, methods=["eeruf"])


class Reenters:
    """A number whose conversion calls the object that is being called."""

    def __init__(self, call: Callable[[], Any]) -> None:
        self.call = call

    def __index__(self) -> int:
        self.call()
        return 0

    def __rshift__(self, _: int) -> int:
        return 0

    def __float__(self) -> float:
        self.call()
        return 0.5


STATEFUL: list[tuple[Any, Callable[[Any, Any], Any], Callable[[Any], Any]]] = [
    (eeruf.Ring(tables.TABLE_I_D, 500, window_us=36_000), lambda of, at: of.echo(at, at), lambda of: of.pause()),
    (eeruf.Ring.flow(8, window_us=30_000), lambda of, at: of.echo(at, at), lambda of: of.resume()),
    (eeruf.nav.Himm(), lambda of, at: of.echo((0, 0, 0), at), lambda of: of.move_to((0, 0))),
    (eeruf.SensorWatch(4), lambda of, at: of.state(at, at), lambda of: of.observe(eeruf.Fire(0), 0)),
    (
        eeruf.Adaptation([tables.TABLE_I_D], 500),
        lambda of, at: of.max_speed_m_s(at),
        lambda of: of.adapt(eeruf.Ring(tables.TABLE_I_D, 500, window_us=36_000), eeruf.Fire(0)),
    ),
]


@pytest.mark.parametrize(("of", "call", "within"), STATEFUL, ids=[type(of).__name__ for of, _, _ in STATEFUL])
def test_a_call_within_a_call_works_or_is_an_error_of_ours(
    of: Any, call: Callable[[Any, Any], Any], within: Callable[[Any], Any]
) -> None:
    outcomes: list[str] = []

    def again() -> None:
        try:
            within(of)
            outcomes.append("it works")
        except Exception as error:
            outcomes.append(f"{type(error).__name__}: {error}")

    call(of, Reenters(again))
    name = type(of).__name__
    busy = f"EerufError: this {name} is in use by another call; expected one at a time: one {name} a thread, or a lock"
    assert outcomes and set(outcomes) <= {"it works", busy}
    within(of)


def test_two_threads_get_answers_or_an_error_with_advice() -> None:
    ring = eeruf.Ring(tables.TABLE_I_D, 500, window_us=36_000)

    def fire() -> None:
        for at in range(2_000):
            try:
                ring.echo(Reenters(lambda: time.sleep(0)), at)
                ring.poll(at)
            except eeruf.EerufError as error:
                assert "one Ring a thread, or a lock" in str(error)

    with ThreadPoolExecutor(2) as threads:
        for done in [threads.submit(fire) for _ in range(2)]:
            done.result()


ABOVE = eeruf.Schedule.from_firing(60_000, [0, 20_000], [100, 20_400])
IMPLAUSIBLE: list[tuple[Callable[[], Any], str]] = [
    (lambda: tables.TABLE_I_D.verify(999, window_us=36), "window_us = 36; expected 1000 to 1000000; likely milli"),
    (lambda: eeruf.EchoFilter(4, 5), "t_delta_us = 5; expected 20 to 20000; T_delta is in microseconds"),
    (lambda: sim.Robot((0, 0, 0), 8, 0.26, 30.0), "radius_m = 30; expected 0.001 to 20; likely centimetres"),
    (lambda: sim.Robot((0, 0, 0), 8, 4.0, 0.3), "spacing_rad = 4; expected 0 to 3.2; radians from one sensor"),
    (lambda: sim.Robot((0, 0, 0), 8, 2 * math.pi, 0.3), "spacing_rad = 6.28.*not degrees or the whole circle"),
    (lambda: WALL.paths((0, -1), [(1, -1)], 20), "max_order = 20; expected 0 to 12; each bounce"),
    (
        lambda: eeruf.Schedule.from_toml(ABOVE.to_toml().replace("60_000", "90_000_000")),
        "line 1: period_us: 90000000; expected 2000 to",
    ),
    (
        lambda: sim.Scene([[5, 2, -5, 2]], robots=[sim.Robot((0, 0, 0), 2, 0.3, 0.3, t_delta_us=900, schedule=ABOVE)]),
        "robot 0: t_delta_us: 900; expected at most .*, what its schedule rejects",
    ),
    (
        lambda: sim.Scene.from_toml("[[wall]]\npoints_m = [[0, 0], [0, 500]]"),
        "line 2: points_m: 500; expected 0 to 200",
    ),
]


@pytest.mark.parametrize(("call", "message"), IMPLAUSIBLE, ids=[message for _, message in IMPLAUSIBLE])
def test_implausible_input_warns(call: Callable[[], Any], message: str) -> None:
    with pytest.warns(eeruf.EerufWarning, match=message):
        call()


def test_implausible_logs_warn(tmp_path: Path) -> None:
    log = tmp_path / "firings.csv"
    log.write_text("sensor,fired_us,period,phase,t_echo_us\n0,0,0,0,5\n1,20,1,0,6\n")
    with pytest.warns(eeruf.EerufWarning, match="column t_echo_us: at most 6; expected 200 or more; likely milli"):
        eeruf.logs.read_firings(log)


def test_plausible_input_does_not_warn() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for scene in RING.parents[1].glob("scenes/*.toml"):
            sim.Scene.from_toml(eeruf.example(f"scenes/{scene.name}"))
        eeruf.Ring(tables.TABLE_I_D, 500, window_us=36_000)

"""Custom firings and filters, and schedules and scenes that change during a simulation."""

import gc
import math
import pickle
import weakref
from typing import Any, Callable

import eeruf
import numpy as np
import pytest
from eeruf import sim

ANY: Any = eeruf
ALCOVE = [[0.85, 0.0, 0.85, 1.39], [0.85, 1.39, -0.85, 1.39], [-0.85, 1.39, -0.85, 0.0]]


def scene(**robot: Any) -> sim.Scene:
    return sim.Scene(ALCOVE, robots=[sim.Robot((-0.26, 0.17, 1.65), 8, 0.26, 0.3, **robot)], seed=20_003)


def same(one: sim.Readings, other: sim.Readings) -> bool:
    columns = other.columns()
    return len(one) > 0 and all(
        np.array_equal(column, columns[name], equal_nan=column.dtype.kind == "f")
        for name, column in one.columns().items()
    )


def paper(echoes: int = 1) -> Callable[[eeruf.typing.FiredReading], eeruf.Reading]:
    mine = eeruf.EchoFilter(8, 500, echoes=echoes)
    return lambda firing: mine.push_echoes(firing.reading.sensor, firing.t_echoes_us, firing.expected_change_us)


@pytest.mark.parametrize(
    ("under", "like", "echoes"), [("eeruf", "eeruf", 1), ("conventional", "comparison", 1), ("multi_echo",) * 2 + (8,)]
)
def test_own_filter_like_a_methods_gives_its_readings(under: Any, like: Any, echoes: int) -> None:
    own = sim.Simulation(scene(), under, filter=paper(echoes)).step(3.0)
    assert same(own, sim.Simulation(scene(), like).step(3.0))
    assert own.is_accepted.any()
    assert not own.is_accepted.all()


def test_a_filter_that_hands_on_verdicts_changes_nothing() -> None:
    own = sim.Simulation(scene(odometry=True), "eeruf", filter=lambda firing: firing.reading)
    own.set_velocity(0, 0.05, 0.2)
    built_in = sim.Simulation(scene(odometry=True), "eeruf")
    built_in.set_velocity(0, 0.05, 0.2)
    assert same(own.step(2.0), built_in.step(2.0))


def test_own_firing_by_a_methods_schedule_gives_its_readings() -> None:
    table = eeruf.tables.TABLE_I_D.scaled(3, 5)
    robot = sim.Robot((-0.26, 0.17, 1.65), 12, 0.2, 0.3, schedule=table)
    room = sim.Scene(ALCOVE, robots=[robot])
    periods = []

    def fire(period: int) -> Any:
        periods.append(period)
        times = (table.t_fire_a_us, table.t_fire_b_us)[period % 2]
        return table.period_us, [(t_fire_us, sensor) for sensor, t_fire_us in enumerate(times)], period % 2

    assert same(sim.Simulation(room, firing=fire).step(2.0), sim.Simulation(room).step(2.0))
    assert periods == list(range(len(periods)))
    assert len(periods) > 30


def level_and_amplitude(far: float) -> tuple[float, float]:
    """Return the only level at which the echo of a wall at this distance is heard, and the amplitude of its path."""
    robot = sim.Robot((0, 0, math.pi / 2), sensors=1, spacing_rad=0.1, radius_m=0.0)
    room = sim.Scene([[5, far, -5, far]], robots=[robot], noise=False)
    seen: list[eeruf.typing.FiredReading] = []

    def believe(firing: eeruf.typing.FiredReading) -> eeruf.Reading:
        seen.append(firing)
        return firing.reading

    sim.Simulation(room, "sequential", filter=believe).step(1.0)
    (level,) = {level for firing in seen for level in firing.levels_db}
    assert all(len(firing.levels_db) == len(firing.t_echoes_us) for firing in seen)
    return level, room.paths((0, 0), [(0, 0)], 1).amplitude[0]


def test_a_filter_sees_the_level_of_an_echo_as_its_path_has_it() -> None:
    (near, here), (far, there) = level_and_amplitude(1.0), level_and_amplitude(2.5)
    assert near - far == pytest.approx(20 * math.log10(here / there), abs=1e-4)
    assert near - far > 8.0


def test_a_filter_sees_its_sensor_and_its_verdict_is_kept() -> None:
    seen: list[eeruf.typing.FiredReading] = []

    def late(firing: eeruf.typing.FiredReading) -> Any:
        seen.append(firing)
        return ("accepted", firing.t_echoes_us[0] + 2.4) if firing.t_echoes_us else ("clear", None)

    own = sim.Simulation(scene(), "conventional", filter=late).step(1.0)
    prompt = sim.Simulation(scene(), "conventional").step(1.0)
    assert np.array_equal(own.cause, prompt.cause)
    assert np.array_equal(own.t_echo_us, prompt.t_echo_us + 2, equal_nan=True)
    assert [firing.fired_s for firing in seen] == own.fired_s.tolist()
    assert [firing.reading.sensor for firing in seen] == own.sensor.tolist()
    assert [firing.reading.period for firing in seen] == own.period.tolist()
    firsts = [firing.t_echoes_us[0] if firing.t_echoes_us else math.nan for firing in seen]
    assert np.array_equal(firsts, own.earliest_us, equal_nan=True)
    assert pickle.loads(pickle.dumps(seen[0])) == seen[0]
    assert eval(repr(seen[0]), {"FiredReading": eeruf.typing.FiredReading, "Reading": eeruf.Reading}) == seen[0]
    plain = seen[0].to_dict()
    assert plain["t_echoes_us"] == list(seen[0].t_echoes_us)
    assert plain["reading"] == seen[0].reading.to_dict()


def test_others_than_the_first_robot_are_named_by_number() -> None:
    robots = [sim.Robot((x, 0.6, 1.57), 4, 0.26, 0.2) for x in (-0.45, 0.45)]
    world = sim.Simulation(
        sim.Scene(ALCOVE, robots=robots), "conventional", filter={1: lambda firing: ("rejected", None)}
    )
    readings = world.step(1.0)
    assert readings.is_accepted[readings.robot == 0].all()
    assert not readings.is_accepted[readings.robot == 1].any()


@pytest.mark.parametrize(
    ("returned", "message"),
    [
        (None, "what filter returned = None; expected an eeruf.Reading, or .kind, t_echo_us. with None for no echo"),
        ("accepted", "what filter returned = 'accepted'; expected"),
        (("good", 9_000), "what filter returned = .'good', 9000.; expected"),
        (("accepted", -1), "t_echo_us that filter returned = -1; expected a number from 0"),
        (("accepted", math.nan), "t_echo_us that filter returned = nan"),
        (("accepted", "soon"), "t_echo_us that filter returned = 'soon'"),
    ],
)
def test_what_a_filter_must_not_return_is_said(returned: Any, message: str) -> None:
    with pytest.raises(eeruf.EerufError, match=message):
        sim.Simulation(scene(), filter=lambda firing: returned).step(0.5)


@pytest.mark.parametrize(
    ("returned", "error", "message"),
    [
        (60_000, eeruf.EerufError, "what firing returned = 60000; expected .length_us"),
        ((60_000,), eeruf.EerufError, "what firing returned = .60000,.; expected"),
        ((60_000, [3]), eeruf.EerufError, "what firing returned = .60000, .3..; expected"),
        ((60_000, [(0.5, 3)]), eeruf.EerufError, "t_fire_us of firing 0 = 0.5; expected a whole number"),
        ((60_000, [(0, 64)]), eeruf.EerufError, "sensor of firing 0 = 64; expected a whole number from 0 to 63"),
        ((60_000, [], 8), eeruf.EerufError, "phase = 8; expected a whole number from 0 to 7"),
        ((60_000, [(0, 8)]), eeruf.EerufError, "at 0.000 s: the firing of robot 0: period 0 fires sensor 8"),
        ((60_000, [(0, 1), (30_000, 1)]), eeruf.EerufError, "fires sensor 1 at 30 ms, 30000 us after its last"),
        ((0, []), eeruf.EerufError, "period 0 lasts 0 us; expected 1 us to 268435.456 ms"),
    ],
)
def test_what_a_firing_must_not_return_is_said(returned: Any, error: Any, message: str) -> None:
    with pytest.raises(error, match=message):
        sim.Simulation(scene(), firing=lambda period: returned)
    later = sim.Simulation(scene(), firing=lambda period: returned if period > 2 else (50_000, [(0, 0)]))
    with pytest.raises(error, match=message.replace("0.000", "0.150").replace("period 0", "period 3")):
        later.step(1.0)


def test_what_is_not_a_callable_is_refused() -> None:
    with pytest.raises(eeruf.EerufError, match="filter = 3; expected a callable, or a dict of callables by robot"):
        ANY.sim.Simulation(scene(), filter=3)
    with pytest.raises(eeruf.EerufError, match=r"firing\[0\] = 3; expected a callable"):
        ANY.sim.Simulation(scene(), firing={0: 3})
    with pytest.raises(eeruf.EerufError, match="robot of firing = 1; expected a whole number from 0 to 0"):
        ANY.sim.Simulation(scene(), firing={1: print})


def test_errors_of_callables_leave_the_simulation_going() -> None:
    class Weary(Exception):
        pass

    def weary(firing: eeruf.typing.FiredReading) -> eeruf.Reading:
        if firing.reading.period == 3 and firing.reading.sensor == 2:
            raise Weary("for today")
        return firing.reading

    world = sim.Simulation(scene(), filter=weary)
    with pytest.raises(Weary, match="for today") as caught:
        world.step(1.0)
    assert caught.traceback[-1].name == "weary"
    assert len(world.step(1.0)) > 100

    def interrupted(period: int) -> Any:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        sim.Simulation(scene(), firing=interrupted)


@pytest.mark.parametrize(
    "call",
    [
        lambda world: world.time_s,
        lambda world: world.robots,
        lambda world: world.step(0.1),
        lambda world: world.set_velocity(0, 0, 0),
        lambda world: world.change_scene(scene()),
    ],
)
def test_a_callable_that_asks_its_own_simulation_is_refused(
    call: Callable[[sim.Simulation], object],
) -> None:
    worlds: list[sim.Simulation] = []

    def ask(firing: eeruf.typing.FiredReading) -> eeruf.Reading:
        assert "in a step" in repr(worlds[0])
        call(worlds[0])
        return firing.reading

    worlds.append(sim.Simulation(scene(), filter=ask))
    with pytest.raises(eeruf.EerufError, match="a simulation under way; expected its firing and its filter"):
        worlds[0].step(0.5)
    assert worlds[0].time_s == 0.0


def test_a_simulation_whose_filter_holds_it_is_collected() -> None:
    class Mine:
        def __init__(self) -> None:
            self.world = sim.Simulation(scene(), filter=self.judge)

        def judge(self, firing: eeruf.typing.FiredReading) -> eeruf.Reading:
            return firing.reading

    mine = Mine()
    mine.world.step(0.2)
    gone = weakref.ref(mine)
    del mine
    gc.collect()
    assert gone() is None


def test_a_ring_changes_its_schedule_while_it_runs() -> None:
    fast, slow = eeruf.tables.TABLE_I_D.scaled(3, 5), eeruf.tables.TABLE_I_D
    robot = sim.Robot((-0.26, 0.17, 1.65), 12, 0.2, 0.3, schedule=fast)
    world = sim.Simulation(sim.Scene(ALCOVE, robots=[robot]))
    before = len(world.step(2.4))
    world.change_schedule(0, slow)
    world.step(0.5)
    assert len(world.step(2.4)) == pytest.approx(0.6 * before, rel=0.05)
    for schedule, error, message in [
        (eeruf.tables.TABLE_I_D.scaled(1, 4), eeruf.EerufError, "method eeruf: a listening window of 36 ms"),
        (3, eeruf.EerufError, "schedule = 3; expected an eeruf.Schedule"),
    ]:
        with pytest.raises(error, match=message):
            ANY.sim.Simulation.change_schedule(world, 0, schedule)
    with pytest.raises(eeruf.EerufError, match="robot 0: a schedule of 12 sensors; expected one of 8"):
        sim.Simulation(scene()).change_schedule(0, slow)
    with pytest.raises(eeruf.EerufError, match="robot 0 fires by dither or by its own firing"):
        sim.Simulation(sim.Scene(ALCOVE, robots=[robot]), "dither").change_schedule(0, slow)
    with pytest.raises(eeruf.EerufError, match="robot = 1; expected a whole number from 0 to 0"):
        world.change_schedule(1, slow)


def test_obstacles_move_between_steps() -> None:
    robot = sim.Robot((0, 0, 0), [(0.0, 0.0, 0.0)])
    walls = [[3.0, -5.0, 3.0, 5.0]]
    world = sim.Simulation(
        sim.Scene(walls, poles=[(2.0, 0, 0.1)], two_sided=[0], robots=[robot], physics="plain", noise=False)
    )
    for x in (2.0, 1.5, 1.0, 2.5):
        world.change_scene(sim.Scene(walls, poles=[(x, 0, 0.1)], two_sided=[0]))
        assert world.step_to_reading(1.0).t_echo_us[0] * 343.2e-6 / 2 == pytest.approx(x - 0.1, abs=1e-3)
    with pytest.raises(eeruf.EerufError, match="scene = 3; expected an"):
        ANY.sim.Simulation.change_scene(world, 3)

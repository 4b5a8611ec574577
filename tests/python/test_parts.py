"""Readings are cut and joined, simulations are reset and copied."""

import copy
import pickle
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import eeruf
import numpy as np
import pytest
from eeruf import experiments, sim

ANY: Any = eeruf
SCENE = experiments.alcoves()[0]
READINGS = sim.simulate(SCENE, "conventional", 100)


def lengths_m(readings: sim.Readings) -> list[float]:
    """Return the length of each reading's path; paths may be numbered differently."""
    return [float(readings.paths["length_m"][path]) if path >= 0 else 0.0 for path in readings.path[:200]]


def same(one: sim.Readings, other: sim.Readings) -> bool:
    columns = other.columns()
    return (
        len(one) == len(other)
        and lengths_m(one) == lengths_m(other)
        and all(
            np.array_equal(column, columns[name], equal_nan=column.dtype.kind == "f")
            for name, column in one.columns().items()
            if name != "path"
        )
    )


def test_slices_masks_and_indices_take_whole_readings() -> None:
    mask = READINGS.is_accepted & READINGS.is_wrong()
    for key in (slice(3, 90, 4), mask, np.flatnonzero(mask)[::-1], [5, 2, 2], slice(0, 0)):
        some = READINGS[key]
        for name, column in READINGS.columns().items():
            if name != "path":
                assert np.array_equal(some.columns()[name], column[key], equal_nan=column.dtype.kind == "f"), name
        assert (some.duration_s, some.sensors) == (READINGS.duration_s, READINGS.sensors)
        # Paths are renumbered, and are the same.
        for was, now in zip(READINGS.path[key], some.path):
            assert (was < 0) == (now < 0)
            if was >= 0:
                assert READINGS.paths["walls"][was] == some.paths["walls"][now]
                assert READINGS.paths["length_m"][was] == some.paths["length_m"][now]
        assert len(some.paths["length_m"]) == len({number for number in some.path if number >= 0})
    assert READINGS[mask].summary().wrong_of_all == 1.0


@pytest.mark.parametrize("key", [3, "a", 1.5, [900], np.ones(3, dtype=bool), np.zeros((2, 2), dtype=int), None])
def test_other_keys_are_refused(key: Any) -> None:
    with pytest.raises(eeruf.EerufError, match=r"(?s)readings\[..\] = .*; expected a slice, a mask"):
        ANY.sim.Readings.__getitem__(READINGS, key)


def test_steps_joined_are_the_simulation() -> None:
    world = sim.Simulation(SCENE, "conventional")
    whole = sim.Readings.concat([world.step(1.3), world.step(0.0), world.step(2.2), world.step(4.5)])
    assert whole.duration_s == pytest.approx(8.0)
    first = whole[: len(READINGS)]
    assert same(first[first.fired_s < 6.0], READINGS[READINGS.fired_s < 6.0])
    blocks = sim.Readings.concat(sim.simulate_blocks(SCENE, "conventional", 100, block_periods=7))
    assert blocks.summary() == READINGS.summary()
    assert len(blocks.paths["order"]) == len(READINGS.paths["order"])
    with pytest.raises(eeruf.EerufError, match=r"parts = \[\]; expected several"):
        sim.Readings.concat([])
    with pytest.raises(eeruf.EerufError, match=r"parts\[1\] = eeruf of 8 sensors; expected conventional of 8"):
        sim.Readings.concat([READINGS, sim.simulate(SCENE, "eeruf", 3)])


def test_arrays_of_ones_own_become_readings() -> None:
    columns = {name: column for name, column in READINGS.columns().items() if name not in ("path",)}
    again = sim.Readings.from_arrays(**columns, duration_s=READINGS.duration_s, sensors=8, method="conventional")
    assert again.summary() == READINGS.summary()
    drive = sim.Readings.from_arrays(
        [0, 1, 0], [0, 0.03, 0.06], [9_000, np.nan, 9_900], reference_us=[9_000, 5_000, 9_000]
    )
    assert drive.is_wrong().tolist() == [False, True, True]
    assert drive.summary().wrong_of_all == pytest.approx(2 / 3)
    assert pickle.loads(pickle.dumps(drive)).summary() == drive.summary()
    cases: list[tuple[dict[str, Any], str]] = [
        ({"sensor": [0, 1]}, r"shape of fired_s = \(1,\); expected \(2,\)"),
        ({"sensor": [0.5]}, "sensor = .*; expected an array of int64"),
        ({"kind": ["first"]}, "kind = .*; expected an array of int8"),
        ({"kind": [99]}, "kind = 99; expected 0 to"),
        ({"colour": [1]}, "no column colour; expected one of robot"),
        ({"path": [0]}, "expected -1, since these readings have no paths"),
        ({"sensor": [64]}, "sensor = 64; expected 0 to 63"),
        ({"sensors": -1}, "sensors = -1; expected a whole number"),
    ]
    for arguments, message in cases:
        given: dict[str, Any] = {"sensor": [0], "fired_s": [0.0], "t_echo_us": [9_000]} | arguments
        with pytest.raises(eeruf.EerufError, match=message):
            ANY.sim.Readings.from_arrays(**given)


def test_readings_become_a_data_set_and_an_arrow_table() -> None:
    data = READINGS.to_xarray()
    assert data.sizes["reading"] == len(READINGS) and data.attrs["method"] == "conventional"
    assert float(data["t_echo_us"].max()) == np.nanmax(READINGS.t_echo_us)
    import pyarrow

    assert pyarrow.table(READINGS).num_rows == len(READINGS)


def test_a_reset_simulation_begins_again() -> None:
    world = sim.Simulation(SCENE, "eeruf")
    first = world.step(2.0)
    world.set_velocity(0, 0.1, 0.0)
    world.step(1.0)
    world.reset()
    assert world.time_s == 0 and world.robots[0].pose == sim.Simulation(SCENE).robots[0].pose
    assert same(world.step(2.0), first)
    world.reset(seed=5)
    other = world.step(2.0)
    assert not same(other, first) and same(other, sim.Simulation(SCENE, "eeruf", seed=5).step(2.0))
    with pytest.raises(eeruf.EerufError, match="seed = -1"):
        world.reset(seed=-1)


def test_a_reset_makes_own_filters_anew_and_keeps_those_given() -> None:
    made: list[object] = []

    def make(robot: sim.Robot) -> Any:
        mine = eeruf.EchoFilter(robot.sensors, 500)
        made.append(mine)
        return lambda firing: mine.push_echoes(firing.reading.sensor, firing.t_echoes_us)

    world = sim.Simulation(SCENE, sim.Method("conventional", make_filter=make))
    first = world.step(2.0)
    world.reset()
    assert same(world.step(2.0), first) and len(made) == 2
    calls: list[int] = []

    def count(firing: eeruf.typing.FiredReading) -> eeruf.Reading:
        calls.append(1)
        return firing.reading

    given = sim.Simulation(SCENE, filter=count)
    given.step(0.5)
    before = len(calls)
    given.reset()
    given.step(0.5)
    assert len(calls) == 2 * before > 0


def test_a_robot_is_put_elsewhere() -> None:
    robot = sim.Robot((0, 0, 0), [(0.0, 0.0, 0.0)])
    wall = sim.Scene([[3.0, -5.0, 3.0, 5.0]], two_sided=[0], robots=[robot], physics="plain", noise=False)
    world = sim.Simulation(wall, "sequential")
    for x in (0.0, 1.0, 2.0, 0.5):
        world.set_pose(0, (x, 0.0, 0.0))
        assert world.robots[0].pose == (x, 0.0, 0.0)
        assert world.step_to_reading(1.0).t_echo_us[0] * 343.2e-6 / 2 == pytest.approx(3 - x, abs=1e-3)
    world.set_velocity(0, 0.5, 0.0)
    world.set_pose(0, (0.0, 0.0, 0.0))
    world.step(1.0)
    assert world.robots[0].pose[0] == pytest.approx(0.5)
    with pytest.raises(eeruf.EerufError, match=r"pose\[0\] = nan"):
        world.set_pose(0, (float("nan"), 0, 0))


@pytest.mark.parametrize("again", [copy.copy, copy.deepcopy, lambda world: pickle.loads(pickle.dumps(world))])
def test_a_copy_goes_on_alike(again: Any) -> None:
    fast = eeruf.tables.TABLE_I_D.scaled(3, 5)
    robot = sim.Robot((-0.26, 0.17, 1.65), 12, 0.2, 0.3, schedule=fast)
    world = sim.Simulation(SCENE.replace(robots=[robot]), seed=9)
    world.step(0.3)
    world.set_velocity(0, 0.05, 0.1)
    world.step_to_reading(0.5)
    world.change_schedule(0, eeruf.tables.TABLE_I_D)
    world.step(0.7)
    world.change_scene(experiments.alcoves()[1])
    world.set_pose(0, (0.0, 0.0, 1.5))
    other = again(world)
    assert other.time_s == world.time_s and other.robots == world.robots
    assert same(other.step(1.0), world.step(1.0))
    with pytest.raises(eeruf.EerufError, match=r"expected a sim\.Method that makes them for each"):
        again(sim.Simulation(SCENE, filter=lambda firing: firing.reading))


def test_a_second_call_at_a_time_is_told_what_to_do() -> None:
    busy, echoes = eeruf.EchoFilter(1, 500), np.full((4_000_000, 1), 9_000.0)
    with ThreadPoolExecutor(1) as other:
        many = other.submit(busy.push_many, echoes)
        refused = 0
        while not many.done():
            try:
                busy.push(0, 9_000)
            except eeruf.EerufError as error:
                assert str(error).startswith("this EchoFilter is in use by another call; expected one at a time")
                refused += 1
    assert refused > 0 and len(many.result()) == len(echoes)
    assert busy.push(0, 9_000).kind in eeruf.KINDS

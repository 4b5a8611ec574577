"""Scenes, simulations and sweeps."""

import contextlib
import functools
import io
import pickle
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import eeruf
import numpy as np
import pytest
from distributed import Client, LocalCluster
from eeruf import sim

SCENES = Path(__file__).parents[2] / "scenes"
ALCOVE = [[0.85, 0.0, 0.85, 1.39], [0.85, 1.39, -0.85, 1.39], [-0.85, 1.39, -0.85, 0.0]]


def same(one: sim.Readings, other: sim.Readings) -> bool:
    columns = other.columns()
    return all(
        np.array_equal(column, columns[name], equal_nan=column.dtype.kind == "f")
        for name, column in one.columns().items()
    )


def test_the_same_seed_gives_the_same_readings_only() -> None:
    scene = sim.Scene.read_toml(SCENES / "alcove.toml")
    first = sim.simulate(scene, "eeruf", periods=50, seed=7)
    assert same(first, sim.simulate(scene, "eeruf", periods=50, seed=7))
    assert not same(first, sim.simulate(scene, "eeruf", periods=50, seed=8))


@pytest.mark.parametrize("method", sim.METHODS)
def test_every_method_runs_in_a_scene_made_in_code(method: Any) -> None:
    robot = sim.Robot((-0.26, 0.17, 1.65), sensors=8, spacing_rad=0.26, radius_m=0.3)
    scene = sim.Scene(ALCOVE, robots=[robot], seed=3)
    readings = sim.simulate(scene, method, periods=30)
    assert readings.method == method
    assert len(readings) == len(readings.fired_s) > 0
    assert 0 <= readings.summary().wrong_of_all <= 1


def test_scenes_robots_and_readings_pickle() -> None:
    robot = sim.Robot((-0.26, 0.17, 1.65), 8, 0.26, 0.3, t_delta_us=100, consecutive=5)
    assert eval(repr(robot), {"Robot": sim.Robot}) == robot
    assert pickle.loads(pickle.dumps(robot)) == robot
    made = sim.Scene(ALCOVE, poles=[[0.0, 1.0, 0.004]], robots=[robot])
    for scene in (made, sim.Scene.read_toml(SCENES / "alcove.toml")):
        again = pickle.loads(pickle.dumps(scene))
        readings = sim.simulate(scene, periods=20)
        assert same(readings, sim.simulate(again, periods=20))
        copy = pickle.loads(pickle.dumps(readings))
        assert same(readings, copy)
        assert copy.summary() == readings.summary()


def test_columns_are_signed_read_only_views() -> None:
    readings = sim.simulate(sim.Scene.read_toml(SCENES / "alcove.toml"), periods=40_000)
    assert (np.diff(readings.period * 60_000) >= 0).all()
    assert (readings.sensor - 5).min() == -5
    for name, column in readings.columns().items():
        assert column.dtype.kind in "if", name
        assert getattr(readings, name) is column, name
        with pytest.raises(ValueError, match="read-only"):
            column[0] = 1
    first = readings.fired_s[:3]
    del readings, column
    assert first[0] < 0.06
    paths = sim.Scene(ALCOVE).paths((0.0, 0.2), [(0.1, 0.2)], 3)
    assert paths.length_m is paths.length_m
    assert (paths.order - 4).min() < 0
    with pytest.raises(ValueError, match="read-only"):
        paths.amplitude[0] = 1
    assert eeruf.EchoFilter(1, 500).push_many([[9_000]]).dtype == np.int8


def test_an_open_simulation_is_steered_step_by_step() -> None:
    scene = sim.Scene([[5, 2, -5, 2]], robots=[sim.Robot((0, 0, 0), 8, 0.26, 0.3)])
    world = sim.Simulation(scene, "eeruf", seed=3)
    # The windows of the last firings have not closed.
    first, whole = world.step(0.6), sim.simulate(scene, "eeruf", periods=10, seed=3)
    assert 70 < len(first) < len(whole) == 80
    assert np.array_equal(first.t_echo_us, whole.t_echo_us[: len(first)], equal_nan=True)
    each = sim.Simulation(scene, "eeruf", seed=3)
    known = 0
    while known < 20:
        # Mostly one; windows of sensors that fire together close together.
        reading = each.step_to_reading(1.0)
        assert 1 <= len(reading) <= 2
        assert reading.sensor.tolist() == whole.sensor[known : known + len(reading)].tolist()
        known += len(reading)
    world.set_velocity(0, v_m_s=0.5, w_rad_s=0.0)
    world.step(1.0)
    assert world.robots[0].pose == pytest.approx((0.5, 0.0, 0.0))
    assert world.robots[0].velocity_m_s == (0.5, 0.0)
    assert world.time_s == pytest.approx(1.6)
    assert not world.robots[0].touches
    world.set_velocity(0, 0.0, np.pi)
    world.step(0.5)
    assert world.robots[0].pose[2] == pytest.approx(np.pi / 2)
    world.set_velocity(0, 2.0, 0.0)
    world.step(1.0)
    assert world.robots[0].touches


def test_a_simulation_writes_itself_into_mcap_as_it_is_steered(tmp_path: Path) -> None:
    file = tmp_path / "drive.mcap"
    scene = sim.Scene([[5, 2, -5, 2]], robots=[sim.Robot((0, 0, 0), 8, 0.26, 0.3)])
    with sim.Simulation(scene, "eeruf", seed=3, mcap=file) as world:
        steps = []
        for k in range(20):
            world.set_velocity(0, v_m_s=0.05 * k, w_rad_s=0.2)
            steps.append(world.step(0.06))
    firings = eeruf.logs.read_firings(file)
    echoes = np.concatenate([step.earliest_us for step in steps])
    fired = np.concatenate([step.fired_s for step in steps])
    order = np.argsort(fired, kind="stable")
    assert firings.damage is None
    assert np.array_equal(firings.t_echo_us, np.floor(echoes[order]), equal_nan=True)
    ranges = eeruf.read_log(file, judged=True)
    accepted = [ranges.topics[sensor].endswith("/accepted") for sensor in ranges.sensor]
    assert sum(accepted) == sum(int(step.is_accepted.sum()) for step in steps)
    assert len(ranges) == len(fired) + sum(accepted)
    # The simulation continues when the file is closed, and closes it once.
    size = file.stat().st_size
    assert len(world.step(0.06)) > 0
    world.close()
    assert file.stat().st_size == size
    with pytest.raises(eeruf.LogError, match=r"missing.*x\.mcap: "):
        sim.Simulation(scene, mcap=tmp_path / "missing" / "x.mcap")
    with pytest.raises(eeruf.EerufError, match="mcap = 3; expected the path"):
        sim.Simulation(scene, mcap=3)  # type: ignore[arg-type]


def test_a_tampered_pickle_is_refused() -> None:
    readings = sim.simulate(sim.Scene.read_toml(SCENES / "alcove.toml"), "conventional", periods=20)
    reduced: Any = readings.__reduce__()
    rebuild, (method, duration_s, sensors, columns, paths) = reduced
    assert rebuild(method, duration_s, sensors, columns, paths).summary() == readings.summary()
    for name, value in [("sensor", 64), ("sensor", -1), ("robot", 64), ("robot", 2**40), ("phase", 256), ("kind", 99),
                        ("kind", -1), ("cause", 5), ("path", 10**6), ("path", -2), ("period", -1)]:  # fmt: skip
        column = columns[name].copy()
        column[3] = value
        with pytest.raises(eeruf.EerufError, match=f"{name} = {value}; expected"):
            rebuild(method, duration_s, sensors, {**columns, name: column}, paths).summary()
    for given, message in [
        ((method, duration_s, 3, columns, paths), "sensors = 3; expected 8 or more"),
        ((method, -1.0, sensors, columns, paths), "duration_s = -1"),
        (("loud", duration_s, sensors, columns, paths), "no method `loud`"),
        ((method, duration_s, sensors, {**columns, "period": columns["period"][1:]}, paths), "length"),
    ]:
        with pytest.raises(eeruf.EerufError, match=message):
            rebuild(*given)


def unaligned(array: Any) -> Any:
    """Return a copy of the array at an odd address."""
    buffer = bytearray(array.nbytes + 1)
    copy = np.frombuffer(buffer, dtype=array.dtype, offset=1, count=array.size).reshape(array.shape)
    copy[...] = array
    assert array.itemsize == 1 or not copy.flags.aligned
    return copy


def test_arrays_that_are_not_aligned_are_taken_as_well() -> None:
    scene = sim.Scene(unaligned(np.array(ALCOVE)), poles=unaligned(np.array([[0.0, 1.0, 0.004]])))
    assert scene.walls.tolist() == ALCOVE
    echoes = unaligned(np.array([[9_000.0], [9_100.0]]))
    assert eeruf.EchoFilter(1, 500).push_many(echoes).ravel().tolist() == [0, 1]
    assert len(scene.paths(unaligned(np.array([0.0, 0.2])), unaligned(np.array([[0.1, 0.2]])), 1)) > 1
    readings = sim.simulate(sim.Scene.read_toml(SCENES / "alcove.toml"), periods=20)
    reduced: Any = readings.__reduce__()
    rebuild, (method, duration_s, sensors, columns, paths) = reduced
    odd = {name: unaligned(column) for name, column in columns.items()}
    assert same(rebuild(method, duration_s, sensors, odd, paths), readings)


def test_readings_are_saved_loaded_and_streamed(tmp_path: Path) -> None:
    import pyarrow

    readings = sim.simulate(sim.Scene.read_toml(SCENES / "alcove.toml"), "conventional", periods=40)
    readings.save(tmp_path / "readings.npz")
    loaded = sim.Readings.load(tmp_path / "readings.npz")
    assert same(readings, loaded)
    assert loaded.summary() == readings.summary()
    assert loaded.paths["walls"] == readings.paths["walls"]
    assert (loaded.method, loaded.duration_s, loaded.sensors) == ("conventional", readings.duration_s, 8)
    (tmp_path / "nothing.npz").write_bytes(b"PK nothing")
    np.savez(tmp_path / "other.npz", format=1, a=[1])
    for name in ("nothing.npz", "other.npz"):
        with pytest.raises(eeruf.EerufError, match=r"expected what Readings\.save wrote"):
            sim.Readings.load(tmp_path / name)
    with pytest.raises(FileNotFoundError):
        sim.Readings.load(tmp_path / "missing.npz")
    whole = (tmp_path / "readings.npz").read_bytes()
    for at in range(0, len(whole), 997):
        damaged = whole[:at] + bytes([whole[at] ^ 255]) + whole[at + 1 :]
        with contextlib.suppress(eeruf.EerufError):
            assert len(sim.Readings.load(io.BytesIO(damaged))) == len(readings)
    wrong: Any
    for wrong in (True, None, "\0", io.StringIO()):
        with pytest.raises(eeruf.EerufError, match=r"^file = .*; expected a path, or a file that takes bytes$"):
            readings.save(wrong)
    table = pyarrow.table(readings)
    assert table.num_rows == len(readings)
    assert table["path"].null_count == int((readings.path < 0).sum())


def test_codes_have_names_and_missing_values_are_null() -> None:
    readings = sim.simulate(sim.Scene.read_toml(SCENES / "alcove.toml"), periods=40)
    names = [eeruf.KINDS[code] for code in readings.kind]
    pandas, polars = readings.to_pandas(), readings.to_polars()
    assert pandas["kind"].tolist() == polars["kind"].to_list() == names
    assert list(pandas["kind"].cat.categories) == list(eeruf.KINDS)
    assert str(polars["cause"].dtype).startswith("Enum")
    silent = np.isnan(readings.t_echo_us)
    assert polars["t_echo_us"].is_null().to_list() == silent.tolist()
    assert polars["path"].null_count() == pandas["path"].isna().sum() == (readings.path < 0).sum()


def test_readings_become_a_data_frame() -> None:
    readings = sim.simulate(sim.Scene.read_toml(SCENES / "alcove.toml"), periods=20)
    frame = readings.to_pandas()
    assert len(frame) == len(readings)
    assert list(frame.columns) == list(readings.columns())


def test_readings_become_a_polars_frame() -> None:
    readings = sim.simulate(sim.Scene.read_toml(SCENES / "alcove.toml"), periods=20)
    frame = readings.to_polars()
    assert frame.columns == list(readings.columns())
    assert frame["t_echo_us"].fill_null(np.nan).to_list() == pytest.approx(readings.t_echo_us.tolist(), nan_ok=True)


def test_readings_of_crosstalk_know_their_paths_and_pickle() -> None:
    # A threshold detector would hear faint echoes later than their sound arrives.
    scene = sim.Scene.read_toml(SCENES / "alcove.toml").replace(physics="plain")
    readings = sim.simulate(scene, "conventional", periods=100)
    copy = pickle.loads(pickle.dumps(readings))
    crosstalk = readings.cause == eeruf.typing.CAUSES.index("crosstalk")
    assert crosstalk.sum() > 100
    for same in (readings, copy):
        paths, along = same.paths, same.path[crosstalk]
        assert along.min() >= 0
        assert np.array_equal(paths["receiver"][along], same.sensor[crosstalk])
        assert (paths["emitter"][along] != same.sensor[crosstalk]).all()
        assert [len(paths["walls"][path]) for path in along] == paths["order"][along].tolist()
        flight_us = same.fired_s[crosstalk] * 1e6 + same.t_echo_us[crosstalk] - same.emitted_s[crosstalk] * 1e6
        # At 343 m/s, give or take jitter of a robot's clock and of its sensors.
        assert np.allclose(flight_us * 343.2e-6, paths["length_m"][along], atol=0.05)
    assert (readings.path[readings.cause == eeruf.typing.CAUSES.index("nothing")] == -1).all()
    assert readings.paths.keys() == copy.paths.keys()
    kept: dict[str, Any] = {**copy.paths}
    heard: dict[str, Any] = {**readings.paths}
    for name, column in heard.items():
        assert np.array_equal(column, kept[name]) if name != "walls" else column == kept[name]


def test_a_pickled_scene_brings_the_schedule_that_its_file_names(tmp_path: Path) -> None:
    schedule = eeruf.design(8, t_delta_us=499, min_interval_us=9_000, window_us=36_000).schedule
    assert schedule is not None
    (tmp_path / "ring.toml").write_text(schedule.to_toml())
    text = (SCENES / "alcove.toml").read_text().replace("[[robot]]", '[[robot]]\nschedule = "ring.toml"')
    (tmp_path / "scene.toml").write_text(text)
    scene = sim.Scene.read_toml(tmp_path / "scene.toml")
    pickled = pickle.dumps(scene)
    readings = sim.simulate(scene, periods=50)
    assert not same(readings, sim.simulate(sim.Scene.read_toml(SCENES / "alcove.toml"), periods=50))
    for file in tmp_path.iterdir():
        file.unlink()
    assert same(readings, sim.simulate(pickle.loads(pickled), periods=50))


def test_paths_are_those_of_the_simulation() -> None:
    """A pillar of 0.6 m between a source and a wall: no path runs through it, unless the physics says so."""
    pillar = [(2.0, 0.0, 0.6)]
    walls = [[4, -5, 4, 5]]
    solid = sim.Scene(walls, two_sided=[0], poles=pillar)
    transparent = sim.Scene(walls, two_sided=[0], poles=pillar, physics="plain")
    assert (0,) not in solid.paths((0, 0), (0, 0.1), 1).walls
    assert (0,) in transparent.paths((0, 0), (0, 0.1), 1).walls
    with pytest.raises(eeruf.EerufError, match="inside pole 0"):
        solid.paths((2, 0), (0, 0), 1)


def test_paths_of_a_room_name_floor_and_ceiling() -> None:
    room = sim.Scene(np.zeros((0, 4)), height={"ceiling_m": 3.0}, physics="plain")
    paths = room.paths((0, 0, 1.0), [(2.0, 0, 1.0)], 2)
    floor, ceiling = 2**33, 2**33 + 1
    assert paths.walls == [(), (floor,), (ceiling,), (floor, ceiling), (ceiling, floor)]
    assert paths.length_m == pytest.approx(np.hypot(2.0, [0.0, 2.0, 4.0, 6.0, 6.0]))
    assert paths.departure_elevation_rad[1] == paths.arrival_elevation_rad[1] == pytest.approx(-np.pi / 4)
    copy = pickle.loads(pickle.dumps(paths))
    assert copy.walls == paths.walls
    assert np.array_equal(copy.arrival_elevation_rad, paths.arrival_elevation_rad)
    assert len(room.paths((0, 0), (2, 0), 0)) == 1
    with pytest.raises(eeruf.EerufError, match="since the scene is flat"):
        sim.Scene(ALCOVE).paths((0.0, 0.2, 0.3), (0.1, 0.2), 1)
    with pytest.raises(eeruf.EerufError, match=r"a sensor is 3\.5 m high"):
        room.paths((0, 0, 3.5), (2, 0), 1)


def test_paths_pickle() -> None:
    paths = sim.Scene(ALCOVE).paths((0.0, 0.2), [(0.1, 0.2), (0.2, 0.3)], 4, max_length_m=6.0)
    copy = pickle.loads(pickle.dumps(paths))
    assert len(copy) == len(paths) > 10
    for name in ("receiver", "length_m", "order", "departure_rad", "arrival_rad", "amplitude"):
        assert np.array_equal(getattr(copy, name), getattr(paths, name))
    assert copy.walls == paths.walls
    assert np.array_equal(copy.points(3), paths.points(3))


def test_runs_of_set_two_pickle() -> None:
    found = eeruf.experiments.set_two(seeds=2, methods=["eeruf"])
    copy = pickle.loads(pickle.dumps(found))
    assert copy == found
    assert copy.runs == found.runs
    assert found.runs["eeruf"][0] != found.runs["eeruf"][1]
    for run in found.runs["eeruf"]:
        assert run.way_m == pytest.approx(np.hypot(*np.diff(run.track[:, 1:3], axis=0).T).sum(), rel=0.02)
        assert (run.track[:, 0] <= run.time_s).all()
        assert ((run.grid[:, 2] >= 1) & (run.grid[:, 2] <= 15)).all()


def test_processes_and_dask_give_the_same() -> None:
    scene = sim.Scene.read_toml(SCENES / "alcove.toml")
    # The cases are seeds. Other processes find the function by its name.
    run = functools.partial(sim.simulate, scene, "conventional", 50)
    here = [run(seed) for seed in range(4)]
    with ThreadPoolExecutor() as threads:
        assert all(same(one, other) for one, other in zip(here, threads.map(run, range(4))))
    with LocalCluster(n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None) as cluster:
        with Client(cluster) as client:
            there = list(client.get_executor().map(run, range(4)))
    assert len(there) == 4
    assert all(same(one, other) for one, other in zip(here, there))

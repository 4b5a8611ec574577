"""Scenes, simulations and sweeps."""

import functools
import pickle
from pathlib import Path

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


def test_the_same_seed_gives_the_same_readings_and_another_others() -> None:
    scene = sim.Scene.from_toml(SCENES / "alcove.toml")
    first = sim.simulate(scene, "eeruf", periods=50, seed=7)
    assert same(first, sim.simulate(scene, "eeruf", periods=50, seed=7))
    assert not same(first, sim.simulate(scene, "eeruf", periods=50, seed=8))


@pytest.mark.parametrize("method", sim.METHODS)
def test_every_method_runs_in_a_scene_made_in_code(method: str) -> None:
    robot = sim.Robot((-0.26, 0.17, 1.65), sensors=8, spacing_rad=0.26, radius_m=0.3)
    scene = sim.Scene(ALCOVE, robots=[robot], seed=3)
    readings = sim.simulate(scene, method, periods=30)
    assert readings.method == method
    assert len(readings) == len(readings.fired_s) > 0
    assert 0 <= readings.summary()["wrong_of_all"] <= 1


def test_scenes_robots_and_readings_pickle() -> None:
    robot = sim.Robot((-0.26, 0.17, 1.65), 8, 0.26, 0.3, t_delta_us=100, consecutive=5, patience=12)
    assert eval(repr(robot), {"Robot": sim.Robot}) == robot
    assert pickle.loads(pickle.dumps(robot)) == robot
    made = sim.Scene(ALCOVE, poles=[[0.0, 1.0, 0.004]], robots=[robot])
    for scene in (made, sim.Scene.from_toml(SCENES / "alcove.toml")):
        again = pickle.loads(pickle.dumps(scene))
        readings = sim.simulate(scene, periods=20)
        assert same(readings, sim.simulate(again, periods=20))
        copy = pickle.loads(pickle.dumps(readings))
        assert same(readings, copy)
        assert copy.summary() == readings.summary()


def test_readings_become_a_data_frame() -> None:
    readings = sim.simulate(sim.Scene.from_toml(SCENES / "alcove.toml"), periods=20)
    frame = readings.to_pandas()
    assert len(frame) == len(readings)
    assert list(frame.columns) == list(readings.columns())


def test_readings_become_a_polars_frame() -> None:
    readings = sim.simulate(sim.Scene.from_toml(SCENES / "alcove.toml"), periods=20)
    frame = readings.to_polars()
    assert frame.columns == list(readings.columns())
    assert frame["t_echo_us"].to_numpy().tolist() == pytest.approx(readings.t_echo_us.tolist(), nan_ok=True)


def test_every_reading_of_crosstalk_knows_its_path_and_keeps_it_in_a_pickle() -> None:
    readings = sim.simulate(sim.Scene.from_toml(SCENES / "alcove.toml"), "conventional", periods=100)
    copy = pickle.loads(pickle.dumps(readings))
    crosstalk = readings.cause == sim.CAUSES.index("crosstalk")
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
    assert (readings.path[readings.cause == sim.CAUSES.index("nothing")] == -1).all()
    assert readings.paths.keys() == copy.paths.keys()
    for name, column in readings.paths.items():
        assert np.array_equal(column, copy.paths[name]) if name != "walls" else column == copy.paths[name]


def test_a_pickled_scene_brings_the_schedule_that_its_file_names(tmp_path: Path) -> None:
    schedule = eeruf.design(8, t_delta_us=499, min_interval_us=9_000, window_us=36_000).schedule
    assert schedule is not None
    (tmp_path / "ring.toml").write_text(schedule.to_toml())
    text = (SCENES / "alcove.toml").read_text().replace("[[robot]]", '[[robot]]\nschedule = "ring.toml"')
    (tmp_path / "scene.toml").write_text(text)
    scene = sim.Scene.from_toml(tmp_path / "scene.toml")
    pickled = pickle.dumps(scene)
    readings = sim.simulate(scene, periods=50)
    assert not same(readings, sim.simulate(sim.Scene.from_toml(SCENES / "alcove.toml"), periods=50))
    for file in tmp_path.iterdir():
        file.unlink()
    assert same(readings, sim.simulate(pickle.loads(pickled), periods=50))


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


def test_a_sweep_gives_the_same_on_processes_and_on_dask() -> None:
    scene = sim.Scene.from_toml(SCENES / "alcove.toml")
    # The cases are seeds. Other processes find the function by its name.
    run = functools.partial(sim.simulate, scene, "conventional", 50)
    here = [run(seed) for seed in range(4)]
    assert all(same(one, other) for one, other in zip(here, eeruf.sweep(run, range(4))))
    with LocalCluster(n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None) as cluster:
        with Client(cluster) as client:
            there = eeruf.sweep(run, range(4), executor=client.get_executor())
    assert len(there) == 4
    assert all(same(one, other) for one, other in zip(here, there))

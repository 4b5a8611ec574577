"""A scene in code is a scene in a file."""

import pickle
import re
from pathlib import Path
from typing import Any

import eeruf
import numpy as np
import pytest
from eeruf import sim

SCENES = Path(__file__).parents[2] / "scenes"
WALLS = [[-2, -2, 2, -2], [2, -2, 2, 2], [2, 2, -2, 2], [-2, 2, -2, -2]]
SCHEDULE = eeruf.Schedule.from_firing(60_000, [0, 30_000], [5_000, 40_000])
EVERYTHING = sim.Scene(
    WALLS,
    open=[1],
    two_sided=[3],
    poles=[[1.0, 1.0, 0.004], [-1.0, 1.0, 0.1]],
    materials=["smooth", "soft", sim.Material(0.7, 0.0002), "perfect"],
    pole_materials="painted",
    temperature_c=3.0,
    humidity_percent=70.0,
    pressure_kpa=95.0,
    noise=sim.Noise(fading_db_rms=2.0, bursts_per_s=3.0),
    seed=2**64 - 1,
    max_order=4,
    physics={"preset": "default", "narrow_panels": False, "interference": True, "fading_time_s": 0.4},
    height={"ceiling_m": 2.2, "floor": sim.Material(0.8, 0.0001)},
    robots=[
        sim.Robot((0, 0, 0.3), 6, 0.4, 0.1, "hc_sr04", gain="linear", blanking_us=300, odometry=True,
                  beam="continuous", coupling_db=-45.0, height_m=0.2,
                  velocity_m_s=(0.05, 0.01), turn_rad_s=0.2, clock_offset_us=5, clock_drift_ppm=-20.0, body=0.15),
        sim.Robot((-1.2, -1.2, 0.9), [(0.05, 0.05, 0.7), (0.05, -0.05, -0.7)], schedule=SCHEDULE, start_us=777,
                  waypoints_m=[(-1.3, -1.0), (-1.2, -1.2)], speed_m_s=0.1, neighbours=2, min_refire_us=20_000,
                  body=[(-0.1, -0.1), (0.1, -0.1), (0.0, 0.1)]),
    ],
)  # fmt: skip


def same(one: sim.Scene, other: sim.Scene) -> bool:
    mine, theirs = sim.simulate(one, periods=20).columns(), sim.simulate(other, periods=20).columns()
    return all(mine[name].tobytes() == theirs[name].tobytes() for name in mine)


def test_a_written_or_pickled_scene_gives_the_same_readings(tmp_path: Path) -> None:
    again = sim.Scene.from_toml(EVERYTHING.to_toml())
    assert again.to_toml() == EVERYTHING.to_toml()
    (tmp_path / "scene.toml").write_text(EVERYTHING.to_toml())
    for scene in (again, sim.Scene.read_toml(tmp_path / "scene.toml"), pickle.loads(pickle.dumps(EVERYTHING))):
        assert same(scene, EVERYTHING)


@pytest.mark.parametrize("file", sorted(SCENES.glob("*.toml")), ids=lambda file: str(file.stem))
def test_a_scene_of_a_file_is_the_scene_made_of_its_fields(file: Path) -> None:
    scene = sim.Scene.read_toml(file)
    fields: dict[str, Any] = {
        name: getattr(scene, name)
        for name in "walls open two_sided poles materials pole_materials temperature_c humidity_percent pressure_kpa robots "
        "noise seed max_order physics height".split()
    }
    made = sim.Scene(**fields)
    assert made.to_toml() == scene.to_toml()
    names = {"Robot": sim.Robot, "Schedule": eeruf.Schedule}
    assert all(eval(repr(robot), names) == robot for robot in scene.robots)
    if len(scene.walls) < 20:
        assert same(made, scene)


def test_all_that_a_scene_was_made_of_can_be_read() -> None:
    assert (EVERYTHING.open, EVERYTHING.two_sided, EVERYTHING.seed, EVERYTHING.max_order) == ([1], [3], 2**64 - 1, 4)
    assert EVERYTHING.materials[2] == sim.Material(0.7, 0.0002)
    assert EVERYTHING.pole_materials == [sim.Material(0.9)] * 2
    effects = {
        "shadows": True,
        "edges": True,
        "narrow_panels": False,
        "range_walk": True,
        "interference": True,
        "fading_time_s": 0.4,
    }
    assert EVERYTHING.physics == effects
    assert EVERYTHING.noise == sim.Noise(fading_db_rms=2.0, bursts_per_s=3.0)
    moving, driving = EVERYTHING.robots
    assert (moving.velocity_m_s, moving.turn_rad_s, moving.waypoints_m) == ((0.05, 0.01), 0.2, None)
    assert (driving.waypoints_m, driving.speed_m_s) == ([(-1.3, -1.0), (-1.2, -1.2)], 0.1)
    assert (driving.sensors, driving.spacing_rad, driving.sensor_poses[1]) == (2, None, (0.05, -0.05, -0.7))
    assert (moving.beam, moving.coupling_db) == ("continuous", -45.0)
    assert EVERYTHING.height == {"ceiling_m": 2.2, "floor": sim.Material(0.8, 0.0001), "ceiling": sim.Material(0.9)}
    assert (moving.height_m, driving.height_m) == ([0.2] * 6, [0.3, 0.3])
    assert (driving.beam, driving.coupling_db) == ("cut_at_90", None)
    assert (moving.gain, moving.blanking_us, moving.odometry, driving.start_us) == ("linear", 300, True, 777)


def test_replace_changes_what_it_names_and_nothing_else() -> None:
    colder = EVERYTHING.replace(temperature_c=-10.0)
    assert colder.temperature_c == -10.0
    assert colder.replace(temperature_c=3.0).to_toml() == EVERYTHING.to_toml()
    assert EVERYTHING.replace(walls=WALLS[:1]).materials == [sim.Material(0.95)]
    robot = EVERYTHING.robots[0]
    assert robot.replace(consecutive=3).consecutive == 3
    assert robot.replace(consecutive=3).replace(consecutive=robot.consecutive) == robot
    assert robot.replace(waypoints_m=[(1, 1)], speed_m_s=0.2).velocity_m_s is None
    assert robot.replace(sensors=[(0, 0, 0)]).sensors == 1
    assert robot.replace(sensors=8).radius_m == 0.1


def test_what_does_not_fit_together_is_refused() -> None:
    cases: list[tuple[Any, str]] = [
        (lambda: sim.Scene(WALLS, materials=["soft"]), "number of materials = 1; expected 4"),
        (lambda: sim.Scene(WALLS, materials="velvet"), "materials = 'velvet'; expected \"smooth\""),  # type: ignore[arg-type]
        (lambda: sim.Scene(WALLS, noise=3), "noise = 3; expected True, False or"),  # type: ignore[arg-type]
        (lambda: sim.Robot((0, 0, 0), 8), "spacing_rad = None; expected a number"),
        (lambda: sim.Robot((0, 0, 0), [(0, 0, 0)], radius_m=1), "radius_m = 1; expected None"),
        (lambda: sim.Robot((0, 0, 0), []), "number of sensors = 0"),
        (lambda: sim.Robot((0, 0, 0), 8, 0.2, 0.3, speed_m_s=1), "speed_m_s = 1; expected waypoints_m and speed_m_s"),
        (lambda: sim.Robot((0, 0, 0), 8, 0.2, 0.3, waypoints_m=[(1, 1)], turn_rad_s=1), "waypoints_m = "),
        (lambda: sim.Material(1.2), "reflection = 1.2; expected a number from 0 to 1"),
        (lambda: sim.Noise(bursts_per_s=-1), "bursts_per_s = -1"),
        (lambda: EVERYTHING.replace(seed=-1), "seed = -1"),
    ]
    for call, message in cases:
        with pytest.raises(eeruf.EerufError, match=message):
            call()


def test_a_notebook_shows_walls_poles_robots_and_headings() -> None:
    svg = EVERYTHING._repr_svg_()
    assert svg.count("<line") == 4 + 6 + 2
    assert svg.count("<circle") == 2 + 2
    assert "nan" not in svg.lower() and "inf" not in svg.lower()
    assert sim.Scene(np.empty((0, 4)))._repr_svg_().endswith("</svg>")


def test_errors_count_robots_and_sensors_from_0_as_code_does() -> None:
    robot = sim.Robot((0, 0, 0), 8, 0.2, 0.3)
    with pytest.raises(eeruf.EerufError, match=r"robots 0 and 1 are 0\.100 m apart"):
        sim.Scene(WALLS, robots=[robot, robot.replace(pose=(0.1, 0, 0))])
    with pytest.raises(eeruf.EerufError, match="sensor 1 fires 50 ms into phase a"):
        eeruf.Schedule.from_firing(40_000, [0, 50_000], [0, 2_000])


def test_physics_and_bodies_take_several_forms() -> None:
    assert sim.Scene(WALLS).physics == "default"
    assert sim.Scene(WALLS, physics={"preset": "plain"}).physics == "plain"
    for physics in ("full", 3, {"preset": "full"}, {"fading": 1.0}):
        with pytest.raises(eeruf.EerufError, match="physics = "):
            sim.Scene(WALLS, physics=physics)  # type: ignore[arg-type]
    place = (0.0, 0.0, 0.0)
    assert sim.Robot(place, 2, 0.3, 0.1, body=0.2).body == 0.2
    assert sim.Robot(place, 2, 0.3, 0.1, body=(0.4, 0.3)).body == (0.4, 0.3)
    assert EVERYTHING.robots[1].body == [(-0.1, -0.1), (0.1, -0.1), (0.0, 0.1)]
    for body in (-1.0, (0.4, 0.0), [(0, 0), (0, 1), (1, 0)], "round"):
        with pytest.raises(eeruf.EerufError, match="body"):
            sim.Robot(place, 2, 0.3, 0.1, body=body)  # type: ignore[arg-type]
    robots = [sim.Robot((x, 0.0, 0.0), 2, 0.3, 0.1, body=0.3) for x in (0.0, 0.5)]
    with pytest.raises(eeruf.EerufError, match="the bodies of robots"):
        sim.Scene(WALLS, robots=robots)


def test_a_body_stands_in_the_way_of_another_robots_sound() -> None:
    watcher = sim.Robot((0.0, 0.0, 0.0), [(0.0, 0.0, 0.0)])
    for body, expected_m in ((None, 2.0), (0.3, 0.7)):
        scene = sim.Scene(
            WALLS, robots=[watcher, sim.Robot((1.0, 0.0, 0.0), [(0.0, 0.0, 0.0)], body=body)], noise=False
        )
        readings = sim.simulate(scene, "sequential", periods=4).columns()
        reference = readings["reference_us"][readings["robot"] == 0]
        assert np.allclose(reference * 1e-6 * 343.2 / 2, expected_m, atol=1e-3)


def test_a_mixed_robot_in_code_is_one_in_a_file() -> None:
    robot = sim.Robot(
        (0, 0, 0.3), 3, 0.4, 0.1, ["hc-sr04", {"like": "hc-sr04", "sees_to_m": 2.5, "hold_us": 130_000}, "srf08"],
        t_delta_us=[300, 400, 500], window_us=[20_000, 14_000, 25_000], blanking_us=[200, 300, 400],
        together=[[0, 2]], height_m=[0.2, 0.3, 0.4],
    )  # fmt: skip
    text = """
seed = 1

[[wall]]
points_m = [[-2, -2], [2, -2], [2, 2], [-2, 2]]
closed = true

[[robot]]
pose = { x_m = 0, y_m = 0, heading_rad = 0.3 }
ring = { sensors = 3, spacing_deg = 22.918311805232928, radius_m = 0.1 }
module = ["hc-sr04", { like = "hc-sr04", sees_to_m = 2.5, hold_us = 130_000 }, "srf08"]
t_delta_us = [300, 400, 500]
window_us = [20_000, 14_000, 25_000]
blanking_us = [200, 300, 400]
together = [[0, 2]]
height_m = [0.2, 0.3, 0.4]
"""
    # Methods other than the robot's own do not fire them together.
    scene = sim.Scene(WALLS, robots=[robot.replace(together=())])
    read = sim.Scene.from_toml(text).robots[0]
    for name in ("module", "t_delta_us", "window_us", "blanking_us", "together", "height_m"):
        assert getattr(read, name) == getattr(robot, name), name
    assert same(scene, sim.Scene.from_toml(scene.to_toml()))
    assert robot.replace(module="ping").blanking_us == 115
    assert pickle.loads(pickle.dumps(robot)) == robot
    assert robot == eval(repr(robot), {"Robot": sim.Robot})
    with pytest.raises(eeruf.EerufError, match="no figure `sees`; expected like, sees_to_m"):
        sim.Robot((0, 0, 0), 2, 0.3, 0.1, {"like": "ping", "sees": 2.0})


def test_faults_are_said_by_the_words_of_scene_files() -> None:
    schedule = eeruf.Schedule.from_firing(90_000, [0, 30_000], [8_000, 50_000])
    faults = [
        {"kind": "lost", "share": 0.5, "sensors": [0]},
        {"kind": "cut", "sensors": [1], "from_s": 0.6, "to_s": 1.2},
        {"kind": "other_table", "schedule": schedule, "from_s": 30},
        {"kind": "leg", "radius_m": 0.05, "from_m": [1, -1], "to_m": (1, 1), "to_s": 2.0},
    ]
    robot = sim.Robot((0, 0, 0.3), [(0.05, 0.05, 0.7), (0.05, -0.05, -0.7)], module="hc-sr04", schedule=SCHEDULE)
    scene = sim.Scene(WALLS, robots=[robot], faults=faults)
    assert [fault["kind"] for fault in scene.faults] == ["lost", "cut", "other_table", "leg"]
    again = sim.Scene.from_toml(scene.to_toml())
    assert again.faults == scene.faults == scene.replace(seed=1).faults
    assert same(scene, again)
    assert pickle.loads(pickle.dumps(scene)).faults == scene.faults
    readings = sim.simulate(scene, periods=60)
    cut = (readings.sensor == 1) & (readings.fired_s > 0.6) & (readings.fired_s < 1.2)
    assert cut.sum() > 8
    assert np.isnan(readings.earliest_us[cut]).all()
    for fault, message in [
        ({"kind": "bat"}, 'kind is "bat"; expected lost, noise'),
        ({"kind": "lost"}, 'no share; expected one with kind "lost"'),
        ({"kind": "cut", "since": 1}, "since: unknown key"),
        ({"kind": "cut", "sensors": object()}, "a number, a text, a list or a dict of these"),
        (3, "a sequence of dicts"),
    ]:
        with pytest.raises(eeruf.EerufError, match=message):
            sim.Scene(WALLS, robots=[robot], faults=[fault])  # type: ignore[list-item]
    with pytest.raises(eeruf.EerufError, match="sensors is 2; expected numbers below its robot"):
        sim.Scene(WALLS, robots=[robot], faults=[{"kind": "cut", "sensors": [2]}])


def test_how_a_ring_is_fired_today_is_said_in_code_as_in_a_file() -> None:
    rows = [[at, at + 20_000, at + 40_000, at + 60_000] for at in (0, 5_000, 2_000)]
    table = {"period_us": 90_000, "t_fire_us": rows}
    sets = {"arrays": [[0, 2], [1, 3]], "groups": [[0, 3], [1, 2]]}
    firing: Any = {"turn_us": 33_000, **sets, "consecutive": 2, "schedule": table}
    robot = sim.Robot((0, 0, 0.3), 4, 0.5, 0.1, module="hc-sr04", firing=firing)
    assert robot.firing == firing
    assert robot.audible_us == 33_159
    assert eval(repr(robot), {"Robot": sim.Robot}) == robot
    assert robot.replace(module="polaroid-6500").audible_us == 73_252
    made = sim.Scene(WALLS, robots=[robot])
    again = sim.Scene.from_toml(made.to_toml())
    assert again.robots[0].firing == firing
    # Rounds of sensor 0; a module that runs freely is at most 0.5 % early.
    rounds: dict[Any, float] = {
        "in_turn": 0.131, "arrays": 0.065, "groups": 0.065, "sync_line": 0.059, "free_running": 0.0597, "table": 0.0869,
    }  # fmt: skip
    for method, shortest_s in rounds.items():
        readings = sim.simulate(made, method, periods=30)
        assert np.array_equal(readings.fired_s, sim.simulate(again, method, periods=30).fired_s)
        first = np.sort(readings.fired_s[readings.sensor == 0])
        assert np.diff(first).min() > shortest_s, method
    with pytest.raises(eeruf.EerufError, match="firing: turns_us: unknown key; did you mean `turn_us`"):
        robot.replace(firing={"turns_us": 1})
    with pytest.raises(eeruf.EerufError, match="timeout_us is 40000; expected 1 to window_us"):
        sim.Scene(WALLS, robots=[robot.replace(firing={"timeout_us": 40_000})])


def test_a_ring_file_makes_the_same_robot_in_code_as_in_a_scene(tmp_path: Path) -> None:
    rings = SCENES.parent / "rings"
    made = sim.Robot((0, 0, 0), ring=rings / "car-12.toml", blanking_us=900)
    ring = (rings / "car-12.toml").read_text()
    (tmp_path / "car.toml").write_text(ring)
    scene = tmp_path / "scene.toml"
    scene.write_text("[[robot]]\npose = { x_m = 0, y_m = 0 }\nring = 'car.toml'\nblanking_us = 900\n")
    read = sim.Scene.read_toml(scene).robots[0]
    assert read == made
    assert (made.sensors, made.neighbours, made.module) == (12, 3, "jsn-sr04t")
    far_m = [4.5, 5.5, 5.5, 4.5, 2.0, 2.0, 2.5, 3.0, 3.0, 2.5, 2.0, 2.0]
    assert made.window_us == [round(2e6 * range_m / 343.2) for range_m in far_m]
    # Driving as fast as the file says, unless odometry knows: 2 v T / c, of 75 ms at 1.5 m/s.
    assert made.t_delta_us == [150 + 656] * 4 + [400 + 656] * 8
    standing = sim.Robot((0, 0, 0), ring=rings / "car-12.toml", odometry=True)
    assert standing.t_delta_us == [150] * 4 + [400] * 8
    pioneer = SCENES.parent / "tests" / "data" / "pioneer-16.toml"
    arrays = [list(range(8)), list(range(8, 16))]
    robot = sim.Robot((0, 0, 0), ring=pioneer, firing={"arrays": arrays})
    readings = sim.simulate(sim.Scene(WALLS, robots=[robot]), "arrays", periods=50)
    for array in arrays:
        order = readings.sensor[np.argsort(readings.fired_s, kind="stable")]
        assert order[np.isin(order, array)][:16].tolist() == array * 2
    with pytest.raises(eeruf.EerufError, match="ring: it does not say where sensors stand"):
        sim.Robot((0, 0, 0), ring=rings / "paper-12.toml")
    with pytest.raises(eeruf.EerufError, match="nowhere"):
        sim.Robot((0, 0, 0), ring="nowhere.toml")


RINGS = sorted(path for path in (SCENES.parent / "rings").glob("*.toml") if not path.name.startswith("table-"))


def places(poses: list[tuple[float, float, float]]) -> str:
    return ", ".join(f"{{ x_m = {x}, y_m = {y}, heading_rad = {heading} }}" for x, y, heading in poses)


def test_a_mower_in_code_reads_what_it_reads_from_a_file(tmp_path: Path) -> None:
    path = SCENES.parent / "rings" / "mower-8-and-4.toml"
    ring = pytest.importorskip("tomllib").loads(path.read_text())
    asked = sim.Robot((0, 0, 0), ring=path)
    pairs = {key: [tuple(pair) for pair in ring[key]] for key in ("layout", "intervals_us", "together")}
    needs: Any = {"tick_us": ring["tick_us"], "budget": 200_000, **pairs}
    found = eeruf.design(12, asked.t_delta_us, ring["min_interval_us"], asked.window_us, **needs)
    assert found.schedule is not None
    made = sim.Robot((0, 0, 0), ring=path, blanking_us=900, schedule=found.schedule)
    scene = tmp_path / "scene.toml"
    scene.write_text(
        "seed = 1\n[[wall]]\npoints_m = [[-2, -2], [2, -2], [2, 2], [-2, 2]]\nclosed = true\n\n"
        f"[[robot]]\npose = {{ x_m = 0, y_m = 0 }}\nring = {str(path)!r}\n"
        f"blanking_us = 900\n\n[robot.schedule]\n{found.schedule.to_toml()}"
    )
    read = sim.Scene.read_toml(scene)
    assert read.robots[0] == made
    assert made.together == [[8, 9], [10, 11]]
    assert made.window_us == [round(2e6 * range_m / 343.2) for range_m in ring["max_range_m"]]
    in_code, in_file = (sim.simulate(each, "eeruf", periods=60) for each in (read.replace(robots=[made]), read))
    assert len(in_code) > 12 * 50
    assert np.array_equal(in_code.earliest_us, in_file.earliest_us, equal_nan=True)
    assert np.array_equal(in_code.kind, in_file.kind)


@pytest.mark.parametrize("path", RINGS, ids=lambda path: path.stem)
def test_a_ring_file_is_the_same_robot_in_code_and_in_a_scene(path: Path, tmp_path: Path) -> None:
    text = path.read_text()
    sensors = re.search(r"^sensors = (\d+)$", text, re.MULTILINE)
    assert sensors
    line = [(0.05 * sensor, 0.0, 0.1 * sensor) for sensor in range(int(sensors[1]))]
    beside = None if "\nposes = " in text else line
    made = sim.Robot((0, 0, 0), beside, ring=path)
    scene = tmp_path / "scene.toml"
    stand = f"sensors = [{places(line)}]\n" if beside else ""
    scene.write_text(f"[[robot]]\npose = {{ x_m = 0, y_m = 0 }}\nring = {str(path)!r}\n{stand}")
    assert sim.Scene.read_toml(scene).robots[0] == made


def test_sound_and_rest_of_a_ring_file_reach_its_robot(tmp_path: Path) -> None:
    path = tmp_path / "ring.toml"
    path.write_text(
        'sensors = 2\nmodule = "hc-sr04"\njitter_us = 200\nspeed_m_s = 0.5\nmin_interval_us = 0\nmax_range_m = 2.0\n'
        "retrigger_us = 40_000\npath_change_us = 150\naudible_us = 50_000\nspacing_deg = 30\nradius_m = 0.2\n"
    )
    robot = sim.Robot((0, 0, 0), ring=path)
    # As fast as the file says, 2 v T / c of 75 ms are added to both.
    assert (robot.t_delta_us, robot.path_change_us, robot.audible_us) == (200 + 219, 150 + 219, 50_000)
    modules: Any = robot.module
    assert [module["rest_us"] for module in modules] == [40_000, 40_000]
    again = sim.Scene.from_toml(sim.Scene(WALLS, robots=[robot]).to_toml()).robots[0]
    assert (again.path_change_us, again.audible_us, again.module) == (369, 50_000, robot.module)
    assert sim.Robot((0, 0, 0), ring=path, module="ping").audible_us == 50_000
    assert sim.Robot((0, 0, 0), ring=path, odometry=True, path_change_us=90).path_change_us == 90
    assert robot.replace(path_change_us=None).path_change_us is None

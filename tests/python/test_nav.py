"""The places that readings look at, the grid that they fill, and driving by it."""

import math
from typing import Any

import eeruf
import numpy as np
import pytest
from eeruf import nav, sim

ROOM = [[-2, -2, 2, -2], [2, -2, 2, 2], [2, 2, -2, 2], [-2, 2, -2, -2]]
C_M_S = 343.2
# For calls that a type checker would refuse.
ANY: Any = nav


def hits(readings: sim.Readings) -> Any:
    """Return the places from which true echoes came."""
    right = readings.is_accepted & ~readings.is_wrong() & ~np.isnan(readings.t_echo_us)
    range_m = 0.5e-6 * C_M_S * readings.t_echo_us[right]
    heading = readings.heading_rad[right]
    return readings.x_m[right] + range_m * np.cos(heading), readings.y_m[right] + range_m * np.sin(heading)


def test_readings_of_a_standing_robot_know_their_places() -> None:
    places = [(0.1, 0.05, 0.3), (-0.1, 0.0, math.pi), (0.0, -0.2, -1.2)]
    robot = sim.Robot((0.5, -0.25, 2.0), places, module="hc-sr04", window_us=24_000)
    readings = sim.simulate(sim.Scene(ROOM, robots=[robot]), periods=10)
    for sensor, (x, y, heading) in enumerate(places):
        of = readings.sensor == sensor
        assert of.any()
        assert readings.x_m[of] == pytest.approx(0.5 + x * math.cos(2.0) - y * math.sin(2.0))
        assert readings.y_m[of] == pytest.approx(-0.25 + x * math.sin(2.0) + y * math.cos(2.0))
        assert np.cos(readings.heading_rad[of]) == pytest.approx(math.cos(2.0 + heading))
        assert np.sin(readings.heading_rad[of]) == pytest.approx(math.sin(2.0 + heading))


def test_readings_of_a_moving_robot_know_their_places() -> None:
    robot = sim.Robot((-1, 0, 0), 1, 0.0, 0.2, velocity_m_s=(0.3, 0.1))
    readings = sim.simulate(sim.Scene(ROOM, robots=[robot]), "simultaneous", periods=40)
    assert readings.x_m == pytest.approx(-1 + 0.2 + 0.3 * readings.fired_s)
    assert readings.y_m == pytest.approx(0.1 * readings.fired_s)
    world = sim.Simulation(sim.Scene(ROOM, robots=[sim.Robot((0, 0, 0), 1, 0.0, 0.2)]), "simultaneous")
    world.step(0.5)
    world.set_velocity(0, 0.0, 1.0)
    turned = world.step(1.0)
    later = turned.fired_s > 0.5
    assert turned.heading_rad[later] == pytest.approx(turned.fired_s[later] - 0.5)
    assert np.hypot(turned.x_m, turned.y_m) == pytest.approx(0.2)


def test_where_readings_looked_and_how_far_gives_the_walls() -> None:
    robot = sim.Robot((0.4, 0.3, 0), 12, math.radians(30), 0.2)
    readings = sim.simulate(sim.Scene(ROOM, robots=[robot], noise=False), periods=40)
    x, y = hits(readings)
    off_m = np.maximum(np.abs(x), np.abs(y)) - 2.0
    # Sensors that face a wall have it on their axis; others hear it off their axis, and so nearer.
    assert len(x) > 100
    assert (off_m < 0.05).all()
    assert (np.abs(off_m) < 0.05).mean() > 0.3


def test_places_stay_in_files_frames_and_pickles(tmp_path: Any) -> None:
    readings = sim.simulate(sim.Scene(ROOM, robots=[sim.Robot((0, 0, 0.5), 4, 0.3, 0.2)]), periods=5)
    readings.save(tmp_path / "readings.npz")
    loaded = sim.Readings.load(tmp_path / "readings.npz")
    for name in ("x_m", "y_m", "heading_rad"):
        assert np.array_equal(getattr(loaded, name), getattr(readings, name))
        assert readings.to_polars()[name].to_list() == getattr(readings, name).tolist()


def test_a_grid_takes_in_readings_as_echo_by_echo() -> None:
    robot = sim.Robot((0.3, 0, 0), 8, math.radians(45), 0.2)
    readings = sim.simulate(sim.Scene(ROOM, robots=[robot]), "conventional", periods=20)
    entered, by_hand = nav.Himm(side=81), nav.Himm(side=81)
    entered.enter(readings, range_m=1.9, near_m=0.3)
    for n in np.flatnonzero(readings.is_accepted):
        sensor = (readings.x_m[n], readings.y_m[n], readings.heading_rad[n])
        range_m = 0.5e-6 * 343.2 * readings.t_echo_us[n]
        if math.isnan(range_m) or range_m > 1.9:
            by_hand.clear(sensor, 1.9, 0.3)
        else:
            by_hand.echo(sensor, range_m, 0.3)
    assert np.array_equal(entered.to_numpy(), by_hand.to_numpy())
    assert entered.to_numpy().max() > 6
    # Another robot's readings are not its own.
    other = nav.Himm(side=81)
    other.enter(readings, robot=1)
    assert len(other.cells()) == 0


def test_a_picture_of_the_grid_has_its_cells_in_their_places() -> None:
    grid = nav.Himm(side=40, cell_m=0.25)
    grid.move_to((7.0, -2.0))
    rng = np.random.default_rng(7)
    for heading, range_m in zip(rng.uniform(-3, 3, 200), rng.uniform(0, 5, 200)):
        grid.echo((7.0, -2.0, heading), range_m)
    picture, (x0, x1, y0, y1) = grid.to_numpy(), grid.extent_m
    assert (x1 - x0, y1 - y0) == pytest.approx((10, 10))
    cells = grid.cells()
    assert len(cells) == (picture > 0).sum() > 50
    for x, y, value in cells:
        assert picture[int((y - y0) / 0.25), int((x - x0) / 0.25)] == value == grid.value((x, y))


def test_a_robot_comes_through_poles_by_vfh_over_himm() -> None:
    robot = sim.Robot((-4, 0.1, 0), 16, math.radians(22.5), 0.2)
    poles = [(-2, 0, 0.05), (0, 0.6, 0.05), (0, -0.5, 0.05), (2, 0.1, 0.05)]
    world = sim.Simulation(sim.Scene([[9, -9, 9, 9]], poles=poles, robots=[robot]))
    grid, vfh, nearest = nav.Himm(side=129), nav.Vfh(speed_max_m_s=0.6), math.inf
    while world.robots[0].pose[0] < 3.5 and world.time_s < 40:
        grid.enter(world.step(0.06))
        x, y, heading = world.robots[0].pose
        nearest = min(nearest, min(math.hypot(px - x, py - y) for px, py, _ in poles))
        world.set_velocity(0, *vfh.drive(grid, (x, y, heading), (5, 0)))
    assert world.robots[0].pose[0] >= 3.5
    assert nearest > 0.25


def test_a_blocked_robot_stands_and_looks_around() -> None:
    grid, vfh = nav.Himm(), nav.Vfh()
    for heading in np.arange(0, 2 * math.pi, 0.05):
        for _ in range(5):
            grid.echo((0.05, 0.05, heading), 0.5, near_m=0.45)
    assert vfh.steer(grid, (0.05, 0.05), (5, 0)) is None
    speed_m_s, turn_rad_s = vfh.drive(grid, (0.05, 0.05, 0.0), (5, 0))
    assert speed_m_s == 0.0
    assert turn_rad_s == pytest.approx(vfh.turn_max_rad_s / 2)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: nav.Himm(side=0), "side = 0; expected a whole number from 1 to 4096"),
        (lambda: nav.Himm(cell_m=0.0), "cell_m = 0.0; expected a number from 0.001"),
        (lambda: nav.Himm().echo((0, 0), 1.0), r"sensor = \(0, 0\); expected \(x, y, heading\)"),
        (lambda: nav.Himm().echo((0, 0, 0), math.nan), "range_m = nan; expected a number from 0 to 1000"),
        (lambda: ANY.Himm().move_to(3), "place = 3; expected a point"),
        (lambda: ANY.Himm().enter(3), "readings = 3; expected eeruf.sim.Readings"),
        (lambda: nav.Vfh(window=0), "window = 0; expected a whole number from 1 to 4096"),
        (lambda: ANY.Vfh().steer(3, (0, 0), (1, 0)), "grid = 3; expected an eeruf.nav.Himm"),
        (lambda: nav.Vfh().drive(nav.Himm(), (0, 0, 0), (1, math.inf)), r"target\[1\] = inf"),
    ],
)
def test_what_is_wrong_with_an_argument_of_a_grid_is_said(call: Any, message: str) -> None:
    with pytest.raises(eeruf.EerufError, match=message):
        call()

"""Paths of sound in a scene whose robots stand still."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from eeruf._types import HeardPaths
    from eeruf.sim import Robot, Scene

# Paths of the same order whose lengths differ by less count as one: a millimetre is 3 us of sound.
_ALIKE_M = 1e-3


def sensor_places(robot: Robot) -> NDArray[np.float64]:
    """Return the place of each sensor in the room: rows of x, y (m) and heading (rad)."""
    x, y, heading = robot.pose
    places = np.asarray(robot.sensor_poses, dtype=float).reshape(-1, 3)
    turn = np.array([[np.cos(heading), -np.sin(heading)], [np.sin(heading), np.cos(heading)]])
    return np.column_stack([places[:, :2] @ turn.T + (x, y), places[:, 2] + heading])


def way(scene: Scene, heard: HeardPaths, path: int) -> NDArray[np.float64] | None:
    """Return the corners of a reading's path, shape (n, 2), emitter first; None if the robots were
    elsewhere.
    """
    ends = []
    for robot, sensor in (("emitter_robot", "emitter"), ("receiver_robot", "receiver")):
        number = int(heard[robot][path])  # type: ignore[literal-required]
        index = int(heard[sensor][path])  # type: ignore[literal-required]
        if not 0 <= number < len(scene.robots) or index >= scene.robots[number].sensors:
            return None
        ends.append(sensor_places(scene.robots[number])[index, :2])
    order, length = int(heard["order"][path]), float(heard["length_m"][path])
    found = scene.paths(ends[0], [ends[1]], order, 1.01 * length + _ALIKE_M)
    alike = np.flatnonzero((np.asarray(found.order) == order) & (np.abs(found.length_m - length) < _ALIKE_M))
    return None if len(alike) == 0 else np.asarray(found.points(int(alike[0])))

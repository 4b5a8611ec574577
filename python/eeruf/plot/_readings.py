"""Figures of one sensor's readings."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from eeruf import _eeruf
from eeruf.plot._canvas import axes, bare, check_kind, check_whole, colours, legend_above

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from eeruf.sim import Readings


def readings(
    readings: Readings,
    *,
    sensor: int = 0,
    robot: int = 0,
    first: int = 0,
    count: int = 100,
    ax: Axes | None = None,
) -> Axes:
    """Draw one sensor's readings over time: accepted rightly, accepted wrongly, rejected, and the readings of the sensor alone.

    Args:
        readings: the readings from ``eeruf.sim.simulate``.
        sensor: index of the sensor on its ring, from 0.
        robot: index of the robot, from 0.
        first: the first of the sensor's readings to draw.
        count: how many to draw.
        ax: the axes to draw into; new ones by default.

    Returns:
        The axes: echo times in milliseconds over time in seconds. Readings without echo do not appear. A reading is wrong if it
        differs by more than 500 us from that of the sensor alone.

    Example:
        >>> import eeruf
        >>> robot = eeruf.sim.Robot((0, 0, 1.57), sensors=8, spacing_rad=0.26, radius_m=0.3)
        >>> scene = eeruf.sim.Scene([[5, 2, -5, 2]], robots=[robot])
        >>> ax = eeruf.plot.readings(eeruf.sim.simulate(scene, periods=50), sensor=3)
        >>> ax.get_ylabel()
        'echo time of sensor 4 (ms)'

    """
    check_kind("readings", readings, _eeruf.Readings, "eeruf.sim.Readings")
    check_whole("sensor", sensor, 0, int(readings.sensor.max(initial=0)))
    check_whole("robot", robot, 0, int(readings.robot.max(initial=0)))
    check_whole("first", first, 0, 2**32 - 1)
    check_whole("count", count, 1, 2**32 - 1)
    ax = axes(ax, width=8.0, height=3.6)
    its = colours(ax)
    mine = np.flatnonzero((np.asarray(readings.sensor) == sensor) & (np.asarray(readings.robot) == robot))
    mine = mine[first : first + count]
    at_s = np.asarray(readings.fired_s)[mine]
    echo_ms = np.asarray(readings.t_echo_us)[mine] / 1e3
    accepted = np.asarray(readings.is_accepted)[mine]
    alone_ms = np.asarray(readings.reference_us)[mine] / 1e3
    ax.step(at_s, alone_ms, where="mid", color=its.grey, linewidth=1.2, label="the sensor alone", zorder=1)
    wrong = readings.is_wrong()[mine]
    right, believed = accepted & ~wrong, accepted & wrong
    ax.plot(at_s[right], echo_ms[right], linestyle="", marker="o", markersize=4, color=its.blue, label="accepted")
    ax.plot(
        at_s[believed],
        echo_ms[believed],
        linestyle="",
        marker="D",
        markersize=5,
        color=its.vermilion,
        label="accepted, and wrong",
    )
    ax.plot(
        at_s[~accepted],
        echo_ms[~accepted],
        linestyle="",
        marker="x",
        markersize=5,
        color=its.grey,
        label="not accepted",
    )
    # Room for whole marks at the top.
    ax.set_ylim(0, 1.06 * ax.get_ylim()[1])
    ax.set_xlabel("time (s)")
    ax.set_ylabel(f"echo time of sensor {sensor + 1} (ms)")
    legend_above(ax)
    bare(ax)
    return ax

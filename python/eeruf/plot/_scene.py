"""A room from above, its robots, and the paths of sound."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from eeruf import _eeruf
from eeruf._eeruf import EerufError
from eeruf.plot._canvas import Colours, axes, bare, check_kind, check_whole, colours, legend_above, points, title
from eeruf.plot._ways import sensor_places, way

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from numpy.typing import ArrayLike

    from eeruf._eeruf import Paths, Readings, Scene


def scene(
    scene: Scene,
    paths: Paths | None = None,
    *,
    readings: Readings | None = None,
    source: ArrayLike | None = None,
    receivers: ArrayLike | None = None,
    most: int = 40,
    ax: Axes | None = None,
) -> Axes:
    """Draw walls, poles and robots from above, and the paths of sound between them (like the paper's Fig. 1).

    Walls that reflect less are thinner, and openings are dotted. Poles have their true size, with a ring round those that are too
    small to be seen. A short line shows the direction of each sensor.

    Args:
        scene: the walls, poles and robots.
        paths: the result of ``Scene.paths``; the shortest are drawn, stronger the fewer bounces they take.
        readings: the readings of a simulation of this scene, to draw the paths of foreign sound that was accepted: from the sensor
            that sent it to the sensor that it fooled, thicker the more often. Robots are drawn at their places in the scene, so
            paths of moving robots are left out.
        source: the source of the paths, (x, y) in metres, to mark it.
        receivers: the receivers of the paths, shape (n, 2) in metres, to mark them.
        most: how many paths to draw at most.
        ax: the axes to draw into; new ones by default.

    Returns:
        The axes, in metres, with equal scales in x and y.

    Example:
        >>> import eeruf
        >>> wall = eeruf.sim.Scene([[5, 2, -5, 2]])
        >>> paths = wall.paths(source=(0, 0), receivers=[(3, 0)], max_order=1)
        >>> ax = eeruf.plot.scene(wall, paths, source=(0, 0), receivers=[(3, 0)])
        >>> [text.get_text() for text in ax.get_legend().get_texts()]
        ['0 bounces', '1 bounce']

    """
    check_kind("scene", scene, _eeruf.Scene, "an eeruf.sim.Scene")
    if paths is not None:
        check_kind("paths", paths, _eeruf.Paths, "eeruf.typing.Paths")
    if readings is not None:
        check_kind("readings", readings, _eeruf.Readings, "eeruf.sim.Readings")
    check_whole("most", most, 0, 2**32 - 1)
    none = np.empty((0, 2))
    ends = none if source is None else points("source", source, "one point (x, y) in metres")
    if len(ends) > 1:
        raise EerufError(f"source = {source!r:.60}; expected one point (x, y) in metres")
    at = none if receivers is None else points("receivers", receivers, "an array of floats of shape (n, 2), in metres")
    ax = axes(ax, width=6.0, height=6.0)
    its = colours(ax)
    _room(ax, its, scene)
    _robots(ax, its, scene)
    if paths is not None:
        _paths(ax, paths, most)
    if readings is not None:
        _who_fooled_whom(ax, its, scene, readings, most)
    for x, y in at:
        ax.plot(x, y, marker="o", markersize=5, color=its.blue, zorder=4)
    for x, y in ends:
        ax.plot(x, y, marker="*", markersize=12, color=its.vermilion, markeredgecolor=ax.get_facecolor(), zorder=5)
    ax.set_aspect("equal")
    ax.set_xlabel("x (m)")
    ax.set_ylabel("y (m)")
    bare(ax)
    return ax


def _room(ax: Axes, its: Colours, scene: Scene) -> None:
    from matplotlib.patches import Circle

    openings = set(scene.open)
    for index, (wall, material) in enumerate(zip(np.asarray(scene.walls).reshape(-1, 4), scene.materials)):
        opening = index in openings
        ax.plot(
            wall[[0, 2]],
            wall[[1, 3]],
            color=its.grey if opening else its.ink,
            linewidth=0.8 if opening else 0.7 + 1.7 * material.reflection,
            linestyle=":" if opening else "-",
            solid_capstyle="round",
            zorder=3,
        )
    for x, y, radius in np.asarray(scene.poles).reshape(-1, 3):
        ax.add_patch(Circle((x, y), radius, color=its.ink, linewidth=0, zorder=3))
        # A pole of 8 mm would be invisible at its true size.
        ax.plot(x, y, marker="o", markersize=6, markerfacecolor="none", color=its.ink, linewidth=0.6, zorder=3)


def _robots(ax: Axes, its: Colours, scene: Scene) -> None:
    for number, robot in enumerate(scene.robots):
        places = sensor_places(robot)
        for x, y, heading in places:
            ends = np.array([[x, y], [x + 0.08 * np.cos(heading), y + 0.08 * np.sin(heading)]])
            ax.plot(ends[:, 0], ends[:, 1], color=its.orange, linewidth=2.0, solid_capstyle="butt", zorder=4)
        x, y, heading = robot.pose
        ax.plot(x, y, marker=(3, 0, np.degrees(heading) - 90), markersize=8, color=its.orange, zorder=4)
        if len(scene.robots) > 1:
            # Behind the robot, where no sensor covers the text.
            behind = (-13 * np.cos(heading), -13 * np.sin(heading))
            ax.annotate(
                f"{number + 1}",
                (x, y),
                xytext=behind,
                textcoords="offset points",
                ha="center",
                va="center",
                color=its.ink,
            )


def _paths(ax: Axes, paths: Paths, most: int) -> None:
    from matplotlib import colormaps

    orders = np.asarray(paths.order)
    # From the strongest contrast with the background to the faintest.
    ends = (1.0, 0.35) if colours(ax).dark else (0.05, 0.85)
    shades = colormaps["viridis"](np.linspace(*ends, int(orders.max(initial=0)) + 1))
    labelled: set[int] = set()
    for path in np.argsort(paths.length_m, kind="stable")[:most]:
        way, order = np.asarray(paths.points(int(path))), int(orders[path])
        label = None if order in labelled else f"{order} bounce{'s' * (order != 1)}"
        labelled.add(order)
        ax.plot(way[:, 0], way[:, 1], color=shades[order], linewidth=0.9, alpha=0.8, label=label)
    handles, labels = ax.get_legend_handles_labels()
    if handles:
        by_order = sorted(zip(labels, handles), key=lambda entry: int(entry[0].split()[0]))
        legend_above(ax, [handle for _, handle in by_order])


def _who_fooled_whom(ax: Axes, its: Colours, scene: Scene, readings: Readings, most: int) -> None:
    foreign = np.isin(readings.cause, [_eeruf.CAUSES.index(cause) for cause in ("crosstalk", "stale")])
    believed = np.asarray(readings.path)[readings.is_accepted & readings.is_wrong() & foreign]
    heard, times = np.unique(believed[believed >= 0], return_counts=True)
    drawn = 0
    for path, count in sorted(zip(heard, times), key=lambda entry: -entry[1])[:most]:
        line = way(scene, readings.paths, int(path))
        if line is None:
            continue
        width = 0.8 + 1.6 * count / times.max()
        ax.plot(line[:, 0], line[:, 1], color=its.vermilion, linewidth=width, alpha=0.8, zorder=2)
        # Towards the fooled sensor.
        ax.annotate(
            "",
            xy=line[-1],
            xytext=line[-2],
            arrowprops={"arrowstyle": "->", "color": its.vermilion, "linewidth": width, "shrinkA": 0, "shrinkB": 0},
            zorder=2,
        )
        drawn += 1
    wrong = int(times.sum())
    said = f"{readings.method}: {wrong:,} of {len(readings):,} readings are foreign sound that was believed"
    title(ax, said if drawn or not wrong else f"{said}; its ways are not drawn")

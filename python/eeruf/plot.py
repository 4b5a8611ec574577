"""Figures with matplotlib, which the extra ``eeruf[plot]`` installs.

Every function draws into ``ax``, or into new axes if there are none, and returns the axes. Sensors are printed from 1, as in the
paper; arguments count them from 0, as everywhere in code.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from eeruf import _eeruf
from eeruf._eeruf import EERUF_METHODS, ArgumentError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from matplotlib.axes import Axes
    from numpy.typing import ArrayLike, NDArray

    from eeruf import Schedule
    from eeruf.experiments import Run, SetTwo
    from eeruf.sim import Paths, Readings, Scene

__all__ = ["course", "methods", "readings", "scene", "timing"]

# Colours that also differ in grey and to the colour-blind (Okabe and Ito).
_BLUE, _VERMILION, _GREEN, _GREY = "#0072b2", "#d55e00", "#009e73", "#8c8c8c"
_ORANGE = "#e69f00"
_QUANTILES = ("p10", "median", "p90")
# Figures that are neither shares nor end in their unit.
_COUNTS = ("courses", "finished", "contacts", "timed_out", "phantom_echoes", "phantom_cells", "starved")
_TITLES = {
    "wrong_of_all": "wrong of all readings (%)",
    "crosstalk_of_all": "crosstalk of all readings (%)",
    "wrong_of_accepted": "wrong of accepted readings (%)",
    "rejected": "readings not accepted (%)",
    "good_lost": "good readings lost (%)",
    "wrong_before_filter": "wrong before any filter (%)",
    "readings_per_s": "accepted readings per second",
    "age_ms": "age of the last accepted reading (ms)",
    "age_p99_ms": "age of the last accepted reading, 99 % (ms)",
    "starved": "sensors with under 5 % of their readings accepted",
    "finished": "courses finished",
    "contacts": "courses with a contact",
    "timed_out": "courses out of time",
    "mean_speed_m_s": "mean speed (m/s)",
    "top_speed_m_s": "top speed (m/s)",
    "nearest_m": "nearest pole (m)",
    "poles_missed": "poles missed (%)",
    "phantom_echoes": "phantom echoes in a course",
    "phantom_cells": "phantom cells in a course",
}
_INK, _WINDOW, _FLOOR = "#1a1a1a", "#cfe3f1", "#f4f4f4"


def _axes(ax: Axes | None, *, width: float = 7.0, height: float = 4.0) -> Axes:
    if ax is not None:
        return ax
    try:
        import matplotlib.pyplot as plt
    except ImportError as error:
        raise ImportError("figures need matplotlib: pip install 'eeruf[plot]'") from error
    return plt.subplots(figsize=(width, height), layout="constrained")[1]


def _is(name: str, value: object, kind: type, expected: str) -> None:
    if not isinstance(value, kind):
        raise ArgumentError(f"{name} = {value!r:.60}; expected {expected}")


def _whole(name: str, value: object, least: int, most: int) -> None:
    if isinstance(value, bool) or not isinstance(value, (int, np.integer)) or not least <= value <= most:
        raise ArgumentError(f"{name} = {value!r:.60}; expected a whole number from {least} to {most}")


def _points(name: str, value: ArrayLike, expected: str) -> NDArray[np.float64]:
    try:
        return np.asarray(value, dtype=float).reshape(-1, 2)
    except (TypeError, ValueError):
        raise ArgumentError(f"{name} = {value!r:.60}; expected {expected}") from None


def _bare(ax: Axes) -> None:
    ax.spines[["top", "right"]].set_visible(False)


def timing(schedule: Schedule, *, window_us: int = 0, ax: Axes | None = None) -> Axes:
    """When each sensor fires in the two phases of a schedule (as the paper's Fig. 3).

    Args:
        schedule: whose firing times to draw.
        window_us: how long a sensor listens after it fired, in microseconds; 0 draws no windows.
        ax: where to draw.

    Returns:
        The axes; times in milliseconds over one period of phase a and one of phase b.

    Example:
        >>> import eeruf
        >>> ax = eeruf.plot.timing(eeruf.tables.TABLE_I_D, window_us=36_000)
        >>> ax.get_xlabel()
        'time (ms)'

    """
    _is("schedule", schedule, _eeruf.Schedule, "an eeruf.Schedule")
    _whole("window_us", window_us, 0, 2**32 - 1)
    sensors = schedule.sensors
    ax = _axes(ax, height=1.2 + 0.26 * sensors)
    period_ms = schedule.period_us / 1e3
    for phase, (times, colour) in enumerate(((schedule.t_fire_a_us, _BLUE), (schedule.t_fire_b_us, _VERMILION))):
        fires_ms = phase * period_ms + np.asarray(times) / 1e3
        if window_us > 0:
            # The windows that are open at the end are open at the beginning as well: the two phases repeat.
            for left in (fires_ms, fires_ms - 2 * period_ms):
                ax.barh(np.arange(1, sensors + 1), window_us / 1e3, left=left, height=0.62, color=_WINDOW, linewidth=0)
        name = "ab"[phase]
        ax.vlines(
            fires_ms, np.arange(1, sensors + 1) - 0.38, np.arange(1, sensors + 1) + 0.38, colors=colour, linewidth=2.2
        )
        ax.text((phase + 0.5) * period_ms, 0.25, f"phase {name}", color=colour, ha="center", va="bottom")
    for end in (period_ms, 2 * period_ms):
        ax.axvline(end, color=_GREY, linewidth=0.8, linestyle=(0, (4, 3)))
    ax.set_xlim(0, 2 * period_ms)
    ax.set_ylim(sensors + 0.6, 0.2)
    ax.set_yticks(range(1, sensors + 1))
    ax.tick_params(axis="y", length=0)
    ax.set_xlabel("time (ms)")
    ax.set_ylabel("sensor")
    _bare(ax)
    return ax


def scene(
    scene: Scene,
    paths: Paths | None = None,
    *,
    source: ArrayLike | None = None,
    receivers: ArrayLike | None = None,
    most: int = 40,
    ax: Axes | None = None,
) -> Axes:
    """Walls and poles from above, and the paths that sound takes between them (as the paper's Fig. 1).

    Args:
        scene: the walls and poles.
        paths: of ``Scene.paths``; the shortest are drawn, darker the fewer bounces they take.
        source: of the paths, (x, y) in metres, to mark it.
        receivers: of the paths, shape (n, 2) in metres, to mark them.
        most: how many paths to draw at most.
        ax: where to draw.

    Returns:
        The axes; metres, one as long in x as in y.

    Example:
        >>> import eeruf
        >>> wall = eeruf.sim.Scene([[5, 2, -5, 2]])
        >>> paths = wall.paths(source=(0, 0), receivers=[(3, 0)], max_order=1)
        >>> ax = eeruf.plot.scene(wall, paths, source=(0, 0), receivers=[(3, 0)])
        >>> [text.get_text() for text in ax.get_legend().get_texts()]
        ['0 bounces', '1 bounce']

    """
    _is("scene", scene, _eeruf.Scene, "an eeruf.sim.Scene")
    if paths is not None:
        _is("paths", paths, _eeruf.Paths, "eeruf.sim.Paths")
    _whole("most", most, 0, 2**32 - 1)
    none = np.empty((0, 2))
    ends = none if source is None else _points("source", source, "one point (x, y) in metres")
    if len(ends) > 1:
        raise ArgumentError(f"source = {source!r:.60}; expected one point (x, y) in metres")
    at = none if receivers is None else _points("receivers", receivers, "an array of floats of shape (n, 2), in metres")
    ax = _axes(ax, width=6.0, height=6.0)
    for wall in np.asarray(scene.walls).reshape(-1, 4):
        ax.plot(wall[[0, 2]], wall[[1, 3]], color=_INK, linewidth=2.2, solid_capstyle="round", zorder=3)
    for x, y, radius in np.asarray(scene.poles).reshape(-1, 3):
        # A pole of 8 mm would not be seen at its size.
        ax.plot(x, y, marker="o", markersize=max(4.0, 20.0 * radius), color=_INK, zorder=3)
    if paths is not None:
        from matplotlib import colormaps

        orders = np.asarray(paths.order)
        shades = colormaps["viridis"](np.linspace(0.05, 0.85, int(orders.max(initial=0)) + 1))
        labelled: set[int] = set()
        for path in np.argsort(paths.length_m, kind="stable")[:most]:
            points, order = np.asarray(paths.points(int(path))), int(orders[path])
            label = None if order in labelled else f"{order} bounce{'s' * (order != 1)}"
            labelled.add(order)
            ax.plot(points[:, 0], points[:, 1], color=shades[order], linewidth=0.9, alpha=0.8, label=label)
        handles, labels = ax.get_legend_handles_labels()
        if handles:
            by_order = sorted(zip(labels, handles), key=lambda entry: int(entry[0].split()[0]))
            ax.legend(
                [handle for _, handle in by_order],
                [label for label, _ in by_order],
                frameon=False,
                loc="upper left",
                bbox_to_anchor=(1.0, 1.0),
            )
    for x, y in at:
        ax.plot(x, y, marker="o", markersize=5, color=_BLUE, zorder=4)
    for x, y in ends:
        ax.plot(x, y, marker="*", markersize=12, color=_VERMILION, markeredgecolor="white", zorder=5)
    ax.set_aspect("equal")
    ax.set_xlabel("x (m)")
    ax.set_ylabel("y (m)")
    _bare(ax)
    return ax


def readings(
    readings: Readings,
    *,
    sensor: int = 0,
    robot: int = 0,
    first: int = 0,
    count: int = 100,
    ax: Axes | None = None,
) -> Axes:
    """What one sensor read over time: what the method accepted, what it rejected, and what the sensor reads alone.

    Args:
        readings: of ``eeruf.sim.simulate``.
        sensor: which sensor of the ring, from 0.
        robot: whose ring, from 0.
        first: the first of the sensor's readings to draw.
        count: how many to draw.
        ax: where to draw.

    Returns:
        The axes; echo times in milliseconds over time in seconds. Readings without echo do not appear.

    Example:
        >>> import eeruf
        >>> robot = eeruf.sim.Robot((0, 0, 1.57), sensors=8, spacing_rad=0.26, radius_m=0.3)
        >>> scene = eeruf.sim.Scene([[5, 2, -5, 2]], robots=[robot])
        >>> ax = eeruf.plot.readings(eeruf.sim.simulate(scene, periods=50), sensor=3)
        >>> ax.get_ylabel()
        'echo time of sensor 4 (ms)'

    """
    _is("readings", readings, _eeruf.Readings, "eeruf.sim.Readings")
    _whole("sensor", sensor, 0, int(readings.sensor.max(initial=0)))
    _whole("robot", robot, 0, int(readings.robot.max(initial=0)))
    _whole("first", first, 0, 2**32 - 1)
    _whole("count", count, 1, 2**32 - 1)
    ax = _axes(ax, width=8.0, height=3.6)
    mine = np.flatnonzero((np.asarray(readings.sensor) == sensor) & (np.asarray(readings.robot) == robot))
    mine = mine[first : first + count]
    at_s = np.asarray(readings.fired_s)[mine]
    echo_ms = np.asarray(readings.t_echo_us)[mine] / 1e3
    accepted = np.asarray(readings.is_accepted)[mine]
    alone_ms = np.asarray(readings.reference_us)[mine] / 1e3
    ax.step(at_s, alone_ms, where="mid", color=_GREY, linewidth=1.2, label="the sensor alone", zorder=1)
    ax.plot(at_s[accepted], echo_ms[accepted], linestyle="", marker="o", markersize=4, color=_BLUE, label="accepted")
    ax.plot(
        at_s[~accepted],
        echo_ms[~accepted],
        linestyle="",
        marker="x",
        markersize=5,
        color=_VERMILION,
        label="not accepted",
    )
    ax.set_ylim(bottom=0)
    ax.set_xlabel("time (s)")
    ax.set_ylabel(f"echo time of sensor {sensor + 1} (ms)")
    ax.legend(frameon=False, ncols=3, loc="lower left", bbox_to_anchor=(0.0, 1.0))
    _bare(ax)
    return ax


def methods(
    result: Mapping[str, Any],
    *,
    figure: str = "wrong_of_all",
    names: Sequence[str] | None = None,
    ax: Axes | None = None,
) -> Axes:
    """The firing methods side by side: the median over all geometries, and where eight in ten of them lie.

    Args:
        result: of ``eeruf.experiments.set_one`` or ``set_two``.
        figure: which figure to draw, such as "wrong_of_all", "rejected", "good_lost" or "readings_per_s".
        names: which methods, first on top; by default all, largest median on top.
        ax: where to draw.

    Returns:
        The axes; percent for shares of readings, else the figure's own unit.

    Raises:
        ArgumentError: no method has that figure, or there is no such method.

    Example:
        >>> import eeruf
        >>> table = eeruf.experiments.set_one(seeds=2, readings=400, methods=["eeruf", "conventional"])
        >>> ax = eeruf.plot.methods(table)
        >>> [label.get_text() for label in ax.get_yticklabels()]
        ['conventional', 'eeruf']

    """
    table = result.get("methods") if isinstance(result, Mapping) else None
    if not isinstance(table, Mapping) or not table or not all(isinstance(of, Mapping) for of in table.values()):
        raise ArgumentError(f"result = {result!r:.60}; expected what eeruf.experiments.set_one or set_two returns")
    figures = {
        name: method[figure]
        for name, method in table.items()
        if isinstance(figure, str) and figure in _TITLES and method.get(figure) is not None
    }
    if not figures:
        known = ", ".join(sorted(name for name in _TITLES if any(name in of for of in table.values())))
        raise ArgumentError(f"figure = {figure!r}; expected one of {known}")
    # Set II has one number for all courses.
    spreads = {name: of if isinstance(of, Mapping) else dict.fromkeys(_QUANTILES, of) for name, of in figures.items()}
    chosen = sorted(spreads, key=lambda name: -spreads[name]["median"])
    if names is not None:
        chosen = list(names) if isinstance(names, Iterable) else []
        strange = [name for name in chosen if not isinstance(name, str) or name not in spreads]
        if strange or not chosen:
            raise ArgumentError(f"names = {names!r:.60}; expected some of {', '.join(spreads)}")
    ax = _axes(ax, height=1.0 + 0.34 * len(chosen))
    share = not figure.endswith(("_ms", "_per_s", "_m_s", "_m")) and figure not in _COUNTS
    scale = 100.0 if share else 1.0
    low, median, high = (scale * np.array([spreads[name][key] for name in chosen]) for key in _QUANTILES)
    row = np.arange(len(chosen))
    colours = [_BLUE if name in EERUF_METHODS else _GREY for name in chosen]
    ax.barh(row, median, color=colours, height=0.6)
    if (low < high).any():
        ax.errorbar(median, row, xerr=[median - low, high - median], fmt="none", ecolor=_INK, elinewidth=1, capsize=3)
    for at, value, most in zip(row, median, high):
        ax.annotate(
            f"{value:.3g}", (most, at), xytext=(5, 0), textcoords="offset points", va="center", fontsize="small"
        )
    ax.set_yticks(row, [name.replace("_", " ") for name in chosen])
    ax.invert_yaxis()
    ax.set_xlim(0, 1.1 * float(high.max()) or 1.0)
    ax.tick_params(axis="y", length=0)
    ax.set_xlabel(_TITLES[figure])
    _bare(ax)
    return ax


def course(
    result: SetTwo | Run,
    *,
    method: str | None = None,
    course: int | None = None,
    ax: Axes | None = None,
) -> Axes:
    """One course of Set II from above: poles, walls, where the robot drove, and the grid that it made of its readings.

    The two walls that are drawn heavier are smooth and make the reflective corner; the others return half of the sound. The
    outline of the platform is drawn for every second.

    Args:
        result: of ``eeruf.experiments.set_two``, or one of its runs.
        method: whose run to draw; by default ``"eeruf"``, or the first method if it is not among them.
        course: the number of the course; by default the first.
        ax: where to draw.

    Returns:
        The axes; metres, one as long in x as in y.

    Raises:
        ArgumentError: the result has no such method or course.

    Example:
        >>> import eeruf
        >>> found = eeruf.experiments.set_two(seeds=1, methods=["eeruf"])
        >>> ax = eeruf.plot.course(found)
        >>> ax.get_title(loc="left")
        'eeruf, course 20000: finished after 8.3 s, 0 phantom echoes'

    """
    run, name, second_robot_m = _chosen(result, method, course)
    ax = _axes(ax, width=7.0, height=5.0)
    from matplotlib.collections import PatchCollection
    from matplotlib.patches import Circle, Polygon, Rectangle

    length, width = _eeruf._ROOM_M
    ax.add_patch(Rectangle((0, 0), length, width, facecolor=_FLOOR, zorder=0))
    cells = PatchCollection([Rectangle((x - 0.05, y - 0.05), 0.1, 0.1) for x, y, _ in run.grid], linewidth=0, zorder=1)
    cells.set(array=run.grid[:, 2], cmap="Greys", clim=(-3, 15))
    ax.add_collection(cells)
    ax.plot([0, 0, length], [width, 0, 0], color=_INK, linewidth=1.0, zorder=3)
    ax.plot([length, length, 0], [0, width, width], color=_INK, linewidth=3.5, zorder=3)
    if second_robot_m is not None:
        ax.add_patch(Circle(second_robot_m, 0.3, facecolor=_ORANGE, zorder=3, label="second robot"))
    seconds = np.arange(0.0, run.time_s, 1.0)
    for at in np.searchsorted(run.track[:, 0], seconds):
        if at < len(run.track):
            ax.add_patch(
                Polygon(_outline(run.track[at]), fill=False, edgecolor=_BLUE, linewidth=0.7, alpha=0.5, zorder=2)
            )
    ax.plot(run.track[:, 1], run.track[:, 2], color=_BLUE, linewidth=1.8, zorder=4, label="track, outline every second")
    finished = run.ending == "finished"
    last = Polygon(
        _outline(run.track[-1]), fill=False, edgecolor=_GREEN if finished else _VERMILION, linewidth=2, zorder=4
    )
    ax.add_patch(last)
    # A pole of 8 mm would not be seen at its size.
    ax.plot(
        run.poles[:, 0],
        run.poles[:, 1],
        linestyle="",
        marker="o",
        markersize=4.5,
        color=_VERMILION,
        zorder=5,
        label="pole",
    )
    cell = Rectangle((0, 0), 1, 1, facecolor="#6b6b6b", label="grid, darker: more certain")
    ax.legend(
        handles=[*ax.get_legend_handles_labels()[0], cell],
        frameon=False,
        ncols=4,
        loc="lower left",
        bbox_to_anchor=(-0.01, 1.0),
        borderaxespad=0.2,
        columnspacing=1.2,
        handlelength=1.4,
        fontsize="small",
    )
    ending = {"finished": "finished after", "contact": "touched something after"}.get(run.ending, "not through in")
    echoes = f"{run.phantom_echoes} phantom echo{'es' * (run.phantom_echoes != 1)}"
    title = f"course {run.course}: {ending} {run.time_s:.1f} s, {echoes}"
    # Above the legend.
    ax.set_title(title if name is None else f"{name}, {title}", loc="left", fontsize="medium", pad=24)
    ax.set_aspect("equal")
    ax.set_xlim(-0.06, length + 0.06)
    ax.set_ylim(-0.06, width + 0.06)
    ax.set_xlabel("x (m)")
    ax.set_ylabel("y (m)")
    ax.spines[:].set_visible(False)
    return ax


def _chosen(
    result: SetTwo | Run, method: str | None, course: int | None
) -> tuple[Run, str | None, tuple[float, float] | None]:
    """A run, its method and where the second robot stood, as far as the result says."""
    from eeruf.experiments import Run, SetTwo

    if isinstance(result, Run):
        return result, None, None
    if not isinstance(result, SetTwo):
        raise ArgumentError(
            f"result = {result!r:.60}; expected what eeruf.experiments.set_two returns, or one of its runs"
        )
    if method is None:
        method = "eeruf" if "eeruf" in result.runs else next(iter(result.runs))
    if not isinstance(method, str) or method not in result.runs:
        raise ArgumentError(f"method = {method!r}; expected one of {', '.join(result.runs)}")
    runs = {run.course: run for run in result.runs[method]}
    if course is None:
        course = min(runs)
    if not isinstance(course, int) or course not in runs:
        raise ArgumentError(f"course = {course!r}; expected {min(runs)} to {max(runs)}")
    return runs[course], method, result["second_robot_m"]


def _outline(place: NDArray[np.float64]) -> NDArray[np.float64]:
    """The corners of the platform at a place of a track."""
    _, x, y, heading, _ = place
    half = _eeruf._SIDE_M / 2
    ahead, aside = np.array([np.cos(heading), np.sin(heading)]), np.array([-np.sin(heading), np.cos(heading)])
    corners = [(1, 1), (-1, 1), (-1, -1), (1, -1)]
    return np.array([[x, y] + half * (along * ahead + side * aside) for along, side in corners])

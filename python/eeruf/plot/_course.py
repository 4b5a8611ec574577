"""A course of Set II from above."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from eeruf import _eeruf
from eeruf._eeruf import EerufError
from eeruf.plot._canvas import axes, colours, legend_above, title

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from numpy.typing import NDArray

    from eeruf._results import Run, SetTwo


def course(
    result: SetTwo | Run,
    *,
    method: str | None = None,
    course: int | None = None,
    ax: Axes | None = None,
) -> Axes:
    """Draw one course of Set II from above: poles, walls, the robot's way, and the grid made from its readings.

    The two thicker walls are smooth and form the reflective corner; the others return half of the sound. The outline of the
    platform is drawn for every second.

    Args:
        result: a result of ``eeruf.experiments.set_two``, or one of its runs.
        method: the method whose run to draw; by default ``"eeruf"`` if the result has it, or else the first method.
        course: the number of the course; by default the first.
        ax: the axes to draw into; new ones by default.

    Returns:
        The axes, in metres, with equal scales in x and y.

    Raises:
        EerufError: the result has no such method or course.

    Example:
        >>> import eeruf
        >>> found = eeruf.experiments.set_two(seeds=1, methods=["eeruf"])
        >>> ax = eeruf.plot.course(found)
        >>> ax.get_title(loc="left")
        'eeruf, course 20000: finished after 8.3 s, 0 phantom echoes'

    """
    run, name, second_robot_m = _chosen(result, method, course)
    ax = axes(ax, width=7.0, height=5.0)
    its = colours(ax)
    from matplotlib.collections import PatchCollection
    from matplotlib.patches import Circle, Polygon, Rectangle

    length, width = _eeruf._ROOM_M
    ax.add_patch(Rectangle((0, 0), length, width, facecolor=its.floor, zorder=0))
    cells = PatchCollection([Rectangle((x - 0.05, y - 0.05), 0.1, 0.1) for x, y, _ in run.grid], linewidth=0, zorder=1)
    cells.set(array=run.grid[:, 2], cmap="Greys_r" if its.dark else "Greys", clim=(-3, 15))
    ax.add_collection(cells)
    ax.plot([0, 0, length], [width, 0, 0], color=its.ink, linewidth=1.0, zorder=3)
    ax.plot([length, length, 0], [0, width, width], color=its.ink, linewidth=3.5, zorder=3)
    if second_robot_m is not None:
        ax.add_patch(Circle(second_robot_m, 0.3, facecolor=its.orange, zorder=3, label="second robot"))
    seconds = np.arange(0.0, run.time_s, 1.0)
    for at in np.searchsorted(run.track[:, 0], seconds):
        if at < len(run.track):
            ax.add_patch(
                Polygon(_outline(run.track[at]), fill=False, edgecolor=its.blue, linewidth=0.7, alpha=0.5, zorder=2)
            )
    ax.plot(
        run.track[:, 1], run.track[:, 2], color=its.blue, linewidth=1.8, zorder=4, label="track, outline every second"
    )
    finished = run.ending == "finished"
    last = Polygon(
        _outline(run.track[-1]), fill=False, edgecolor=its.green if finished else its.vermilion, linewidth=2, zorder=4
    )
    ax.add_patch(last)
    # A pole of 8 mm would be invisible at its true size.
    ax.plot(
        run.poles[:, 0],
        run.poles[:, 1],
        linestyle="",
        marker="o",
        markersize=4.5,
        color=its.vermilion,
        zorder=5,
        label="pole",
    )
    cell = Rectangle((0, 0), 1, 1, facecolor="#6b6b6b", label="grid, stronger: more certain")
    rows = legend_above(ax, [*ax.get_legend_handles_labels()[0], cell])
    ending = {"finished": "finished after", "contact": "touched something after"}.get(run.ending, "not through in")
    echoes = f"{run.phantom_echoes} phantom echo{'es' * (run.phantom_echoes != 1)}"
    said = f"course {run.course}: {ending} {run.time_s:.1f} s, {echoes}"
    title(ax, said if name is None else f"{name}, {said}", legend_rows=rows)
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
    """Return a run, its method and the second robot's place, if the result has it."""
    from eeruf._results import Run, SetTwo

    if isinstance(result, Run):
        return result, None, None
    if not isinstance(result, SetTwo):
        raise EerufError(
            f"result = {result!r:.60}; expected what eeruf.experiments.set_two returns, or one of its runs"
        )
    of_methods = {str(name): of for name, of in result.runs.items()}
    if method is None:
        method = "eeruf" if "eeruf" in of_methods else next(iter(of_methods))
    if not isinstance(method, str) or method not in of_methods:
        raise EerufError(f"method = {method!r}; expected one of {', '.join(of_methods)}")
    runs = {run.course: run for run in of_methods[method]}
    if course is None:
        course = min(runs)
    if not isinstance(course, int) or course not in runs:
        raise EerufError(f"course = {course!r}; expected {min(runs)} to {max(runs)}")
    return runs[course], method, result.second_robot_m


def _outline(place: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the corners of the platform at a place of a track."""
    _, x, y, heading, _ = place
    half = _eeruf._SIDE_M / 2
    ahead, aside = np.array([np.cos(heading), np.sin(heading)]), np.array([-np.sin(heading), np.cos(heading)])
    corners = [(1, 1), (-1, 1), (-1, -1), (1, -1)]
    return np.array([[x, y] + half * (along * ahead + side * aside) for along, side in corners])

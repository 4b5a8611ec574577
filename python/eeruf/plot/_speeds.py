"""The speed that each firing method sustains."""

from __future__ import annotations

from typing import TYPE_CHECKING

from eeruf._eeruf import EERUF_METHODS
from eeruf._results import SpeedSweep
from eeruf.plot._canvas import axes, bare, colours, legend_above

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_MARKERS = "osD^vPX*<>hd8"


def speeds(result: SpeedSweep, ax: Axes | None) -> Axes:
    """Draw the share of finished courses over the top speed, a line for each method."""
    steps = result.steps
    ax = axes(ax)
    its = colours(ax)
    hues = [its.blue, its.vermilion, its.green, its.orange, its.grey, its.ink]
    at = [step.speed_m_s for step in steps]
    for index, method in enumerate(steps[0].finished_of_all):
        ax.plot(
            at,
            [100.0 * step.finished_of_all[method] for step in steps],
            color=hues[index % len(hues)],
            linestyle="-" if method in EERUF_METHODS else "--",
            marker=_MARKERS[index % len(_MARKERS)],
            markersize=5,
            label=method.replace("_", " "),
        )
    ax.set_ylim(-3, 103)
    ax.set_xlabel("top speed (m/s)")
    ax.set_ylabel("courses finished (%)")
    legend_above(ax)
    bare(ax)
    return ax

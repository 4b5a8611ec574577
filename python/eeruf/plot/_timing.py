"""Timing diagrams of schedules."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from eeruf import _eeruf
from eeruf.plot._canvas import axes, bare, check_kind, check_whole, colours

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from eeruf import Schedule


def timing(schedule: Schedule, *, window_us: int = 0, ax: Axes | None = None) -> Axes:
    """Draw the firing times of each sensor in the two phases of a schedule (like the paper's Fig. 3).

    Args:
        schedule: the schedule to draw.
        window_us: how long a sensor listens after it fired, in microseconds; 0 draws no windows.
        ax: the axes to draw into; new ones by default.

    Returns:
        The axes: times in milliseconds over one period of phase a and one of phase b.

    Example:
        >>> import eeruf
        >>> ax = eeruf.plot.timing(eeruf.tables.TABLE_I_D, window_us=36_000)
        >>> ax.get_xlabel()
        'time (ms)'

    """
    check_whole("window_us", window_us, 0, 2**32 - 1)
    check_kind("schedule", schedule, _eeruf.Schedule, "an eeruf.Schedule")
    sensors = schedule.sensors
    ax = axes(ax, height=1.2 + 0.26 * sensors)
    its = colours(ax)
    period_ms = schedule.period_us / 1e3
    for phase, (times, colour) in enumerate(((schedule.t_fire_a_us, its.blue), (schedule.t_fire_b_us, its.vermilion))):
        fires_ms = phase * period_ms + np.asarray(times) / 1e3
        if window_us > 0:
            # Windows that are open at the end are also open at the beginning, since the two phases repeat.
            for left in (fires_ms, fires_ms - 2 * period_ms):
                ax.barh(
                    np.arange(1, sensors + 1), window_us / 1e3, left=left, height=0.62, color=its.window, linewidth=0
                )
        name = "ab"[phase]
        ax.vlines(
            fires_ms, np.arange(1, sensors + 1) - 0.38, np.arange(1, sensors + 1) + 0.38, colors=colour, linewidth=2.2
        )
        ax.text((phase + 0.5) * period_ms, 0.25, f"phase {name}", color=colour, ha="center", va="bottom")
    for end in (period_ms, 2 * period_ms):
        ax.axvline(end, color=its.grey, linewidth=0.8, linestyle=(0, (4, 3)))
    return _lanes(ax, sensors, end_ms=2 * period_ms, top=0.2)


def _lanes(ax: Axes, sensors: int, *, end_ms: float, top: float) -> Axes:
    """Draw a lane for each sensor, the first on top."""
    ax.set_xlim(0, end_ms)
    ax.set_ylim(sensors + 0.6, top)
    ax.set_yticks(range(1, sensors + 1))
    ax.tick_params(axis="y", length=0)
    ax.set_xlabel("time (ms)")
    ax.set_ylabel("sensor")
    bare(ax)
    return ax

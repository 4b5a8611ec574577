"""When the sensors fire."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from eeruf import _eeruf
from eeruf.plot._canvas import axes, bare, check_kind, check_whole, colours

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from eeruf import HoppingSchedule, Schedule


def timing(schedule: Schedule | HoppingSchedule, *, window_us: int = 0, ax: Axes | None = None) -> Axes:
    """When each sensor fires in the two phases of a schedule (as the paper's Fig. 3), or in the many of a hopping one.

    Args:
        schedule: whose firing times to draw.
        window_us: how long a sensor listens after it fired, in microseconds; 0 draws no windows.
        ax: where to draw.

    Returns:
        The axes; times in milliseconds over one period of phase a and one of phase b. Of many phases: over one period, and in each
        sensor's lane a line for each phase, the first on top.

    Example:
        >>> import eeruf
        >>> ax = eeruf.plot.timing(eeruf.tables.TABLE_I_D, window_us=36_000)
        >>> ax.get_xlabel()
        'time (ms)'

    """
    check_whole("window_us", window_us, 0, 2**32 - 1)
    if isinstance(schedule, _eeruf.HoppingSchedule):
        return _hopping(schedule, window_us, ax)
    check_kind("schedule", schedule, _eeruf.Schedule, "an eeruf.Schedule or an eeruf.HoppingSchedule")
    sensors = schedule.sensors
    ax = axes(ax, height=1.2 + 0.26 * sensors)
    its = colours(ax)
    period_ms = schedule.period_us / 1e3
    for phase, (times, colour) in enumerate(((schedule.t_fire_a_us, its.blue), (schedule.t_fire_b_us, its.vermilion))):
        fires_ms = phase * period_ms + np.asarray(times) / 1e3
        if window_us > 0:
            # The windows that are open at the end are open at the beginning as well: the two phases repeat.
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


def _hopping(schedule: HoppingSchedule, window_us: int, ax: Axes | None) -> Axes:
    """The phases of a hopping schedule, one below the other in each sensor's lane."""
    sensors, phases, period_ms = schedule.sensors, schedule.phases, schedule.period_us / 1e3
    ax = axes(ax, height=1.2 + 0.05 * sensors * phases)
    its = colours(ax)
    line = 0.76 / phases
    fires_ms = schedule.t_fire_us / 1e3
    tops = np.arange(1, sensors + 1) - 0.38 + line * np.arange(phases)[:, None]
    if window_us > 0:
        # The windows that are open at the end of a period are open at the beginning of the next, in the next phase.
        for left, top in ((fires_ms, tops), (np.roll(fires_ms, 1, axis=0) - period_ms, tops)):
            width = np.full(left.size, window_us / 1e3)
            ax.barh(top.ravel() + line / 2, width, left=left.ravel(), height=line, color=its.window, linewidth=0)
    ax.vlines(fires_ms.ravel(), tops.ravel(), tops.ravel() + line, colors=its.blue, linewidth=1.6)
    return _lanes(ax, sensors, end_ms=period_ms, top=0.4)


def _lanes(ax: Axes, sensors: int, *, end_ms: float, top: float) -> Axes:
    """A lane for each sensor, the first on top."""
    ax.set_xlim(0, end_ms)
    ax.set_ylim(sensors + 0.6, top)
    ax.set_yticks(range(1, sensors + 1))
    ax.tick_params(axis="y", length=0)
    ax.set_xlabel("time (ms)")
    ax.set_ylabel("sensor")
    bare(ax)
    return ax

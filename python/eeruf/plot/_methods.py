"""The firing methods side by side."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

import numpy as np

from eeruf._eeruf import EERUF_METHODS, EerufError
from eeruf._results import SetOne, SetTwo, SpeedSweep, Spread
from eeruf.plot._canvas import axes, bare, colours
from eeruf.plot._speeds import speeds

if TYPE_CHECKING:
    from collections.abc import Sequence

    from matplotlib.axes import Axes

_QUANTILES = ("p10", "median", "p90")
# Figures that are neither shares nor end in their unit.
_COUNTS = ("courses", "finished", "contacts", "timed_out", "phantom_echoes", "phantom_cells", "starved")
_TITLES = {
    "wrong_of_all": "wrong of all readings (%)",
    "crosstalk_of_all": "crosstalk of all readings (%)",
    "confirmed_wrong_of_all": "confirmed wrong of all readings (%)",
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


def _quantiles(figure: Spread | float) -> dict[str, float]:
    if isinstance(figure, Spread):
        return {name: getattr(figure, name) for name in _QUANTILES}
    return dict.fromkeys(_QUANTILES, figure)


def methods(
    result: SetOne | SetTwo | SpeedSweep,
    *,
    figure: str = "wrong_of_all",
    names: Sequence[str] | None = None,
    ax: Axes | None = None,
) -> Axes:
    """Draw the firing methods side by side: the median over all geometries, and the middle 80 % of them.

    Args:
        result: a result of ``eeruf.experiments.set_one`` or ``set_two``; or of ``speed_sweep``, for the share of finished courses
            over the top speed, full lines for EERUF's methods and dashed for others, regardless of ``figure`` and ``names``.
        figure: the figure to draw, such as "wrong_of_all", "rejected", "good_lost" or "readings_per_s".
        names: the methods to draw, first on top; by default all, largest median on top.
        ax: the axes to draw into; new ones by default.

    Returns:
        The axes; percent for shares of readings, else the figure's own unit.

    Raises:
        EerufError: no method has that figure, or a method is unknown.

    Example:
        >>> import eeruf
        >>> table = eeruf.experiments.set_one(seeds=2, readings=400, methods=["eeruf", "conventional"])
        >>> ax = eeruf.plot.methods(table)
        >>> [label.get_text() for label in ax.get_yticklabels()]
        ['conventional', 'eeruf']

    """
    if isinstance(result, SpeedSweep):
        return speeds(result, ax)
    if not isinstance(result, (SetOne, SetTwo)):
        expected = "what eeruf.experiments.set_one, set_two or speed_sweep returns"
        raise EerufError(f"result = {result!r:.60}; expected {expected}")
    known = isinstance(figure, str) and figure in _TITLES
    found = {name: getattr(of, figure, None) for name, of in result.methods.items()} if known else {}
    figures = {name: of for name, of in found.items() if of is not None}
    if not figures:
        has = (title for title in sorted(_TITLES) if any(hasattr(of, title) for of in result.methods.values()))
        raise EerufError(f"figure = {figure!r}; expected one of {', '.join(has)}")
    # Set II has one number for all courses.
    spreads: dict[str, dict[str, float]] = {name: _quantiles(of) for name, of in figures.items()}
    chosen = sorted(spreads, key=lambda name: -spreads[name]["median"])
    if names is not None:
        chosen = list(names) if isinstance(names, Iterable) else []
        strange = [name for name in chosen if not isinstance(name, str) or name not in spreads]
        if strange or not chosen:
            raise EerufError(f"names = {names!r:.60}; expected some of {', '.join(spreads)}")
    ax = axes(ax, height=1.0 + 0.34 * len(chosen))
    its = colours(ax)
    share = not figure.endswith(("_ms", "_per_s", "_m_s", "_m")) and figure not in _COUNTS
    scale = 100.0 if share else 1.0
    low, median, high = (scale * np.array([spreads[name][key] for name in chosen]) for key in _QUANTILES)
    row = np.arange(len(chosen))
    bars = [its.blue if name in EERUF_METHODS else its.grey for name in chosen]
    ax.barh(row, median, color=bars, height=0.6)
    spread = bool((low < high).any())
    if spread:
        ax.errorbar(
            median, row, xerr=[median - low, high - median], fmt="none", ecolor=its.ink, elinewidth=1, capsize=3
        )
    for at, value in zip(row, median):
        ax.annotate(
            f"{value:.3g}",
            (value, at),
            xytext=(3, 2),
            textcoords="offset points",
            va="bottom",
            fontsize="small",
            color=its.ink,
        )
    ax.set_yticks(row, [name.replace("_", " ") for name in chosen])
    ax.invert_yaxis()
    ax.set_xlim(0, 1.1 * float(high.max()) or 1.0)
    ax.tick_params(axis="y", length=0)
    ax.set_xlabel(_TITLES[figure])
    if spread:
        said = f"bar and number: median of {result.seeds} geometries\nwhisker: 10 % to 90 % of them"
        ax.set_title(said, loc="left", fontsize="small", color=its.grey)
    bare(ax)
    return ax

"""Common parts of all figures: axes, colours, and checks of arguments."""

from __future__ import annotations

import textwrap
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from eeruf._eeruf import EerufError

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from numpy.typing import ArrayLike, NDArray


@dataclass(frozen=True)
class Colours:
    """Colours that differ in grey and to the colour-blind (Okabe and Ito)."""

    ink: str
    blue: str
    vermilion: str
    green: str
    orange: str
    grey: str
    window: str
    floor: str
    dark: bool


_ON_LIGHT = Colours("#1a1a1a", "#0072b2", "#d55e00", "#009e73", "#e69f00", "#8c8c8c", "#cfe3f1", "#f4f4f4", False)
_ON_DARK = Colours("#e8e8e8", "#56b4e9", "#ff7f3f", "#2fd0a5", "#f0c14b", "#9a9a9a", "#24455c", "#262626", True)


def colours(ax: Axes) -> Colours:
    """Return the colours for the background of these axes."""
    from matplotlib.colors import to_rgb

    red, green, blue = to_rgb(ax.get_facecolor())
    return _ON_LIGHT if 0.2126 * red + 0.7152 * green + 0.0722 * blue > 0.5 else _ON_DARK


def axes(ax: Axes | None, *, width: float = 7.0, height: float = 4.0) -> Axes:
    """Return the given axes, or new ones of this size in inches."""
    if ax is not None:
        return ax
    try:
        import matplotlib.pyplot as plt
    except ImportError as error:
        raise ImportError("figures need matplotlib: pip install 'eeruf[plot]'") from error
    return plt.subplots(figsize=(width, height), layout="constrained")[1]


def _width_pt(ax: Axes) -> float:
    """Estimate the width of these axes, in points, before the layout is made."""
    return 72.0 * ax.figure.bbox.width / ax.figure.dpi * float(ax.get_position().width)


def title(ax: Axes, text: str, *, legend_rows: int = 0) -> None:
    """Set a title, in as many lines as the width requires, above a legend of this many rows."""
    ax.set_title(
        textwrap.fill(text, max(20, int(_width_pt(ax) / 5.8))),
        loc="left",
        fontsize="medium",
        pad=6.0 + 14.5 * legend_rows,
    )


def legend_above(ax: Axes, handles: list[Any] | None = None) -> int:
    """Put a legend above the axes, in as many columns as fit; return its number of rows."""
    shown = ax.get_legend_handles_labels()[0] if handles is None else handles
    if not shown:
        return 0
    longest = max(len(str(handle.get_label())) for handle in shown)
    columns = min(len(shown), max(1, int(_width_pt(ax) * 1.15 / (28.0 + 4.2 * longest))))
    ax.legend(
        handles=shown,
        frameon=False,
        ncols=columns,
        loc="lower left",
        bbox_to_anchor=(-0.01, 1.0),
        borderaxespad=0.2,
        columnspacing=1.2,
        handlelength=1.6,
        fontsize="small",
    )
    return -(-len(shown) // columns)


def bare(ax: Axes) -> None:
    """Remove the spines that carry no information."""
    ax.spines[["top", "right"]].set_visible(False)


def check_kind(name: str, value: object, kind: type, expected: str) -> None:
    """Refuse values of other types."""
    if not isinstance(value, kind):
        raise EerufError(f"{name} = {value!r:.60}; expected {expected}")


def check_whole(name: str, value: object, least: int, most: int) -> None:
    """Refuse values that are not whole numbers, or out of range."""
    if isinstance(value, bool) or not isinstance(value, (int, np.integer)) or not least <= value <= most:
        raise EerufError(f"{name} = {value!r:.60}; expected a whole number from {least} to {most}")


def points(name: str, value: ArrayLike, expected: str) -> NDArray[np.float64]:
    """Return points in the plane, a row each."""
    try:
        return np.asarray(value, dtype=float).reshape(-1, 2)
    except (TypeError, ValueError):
        raise EerufError(f"{name} = {value!r:.60}; expected {expected}") from None

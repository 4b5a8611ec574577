"""An animation of sound in flight, and of the readings that it causes."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from eeruf import _eeruf
from eeruf._eeruf import EerufError
from eeruf.plot._canvas import axes, check_kind, check_whole, colours
from eeruf.plot._scene import scene as draw_scene
from eeruf.plot._ways import way

if TYPE_CHECKING:
    from matplotlib.animation import FuncAnimation
    from matplotlib.axes import Axes
    from numpy.typing import NDArray

    from eeruf.sim import Readings, Scene


def animation(
    scene: Scene,
    readings: Readings,
    *,
    first: int = 0,
    periods: int = 2,
    frames: int = 160,
    ax: Axes | None = None,
) -> FuncAnimation:
    """Animate some periods in slow motion: each sensor fires, the sound that it hears travels its path, and the reading comes in.

    A dot is sound on its way to the sensor that hears it first. When it arrives a disc stays at the sensor for a while: blue for a
    reading that is right and accepted, vermilion for one that is wrong and accepted, open for one that is not accepted.

    Args:
        scene: a scene whose robots stand still.
        readings: the readings of a simulation of that scene.
        first: the first period, from 0. Methods need a few periods to settle.
        periods: how many of the first robot's periods, 1 to 20.
        frames: how many pictures, 2 to 5,000.
        ax: the axes to draw into; new ones by default.

    Returns:
        A matplotlib animation, for ``save("crosstalk.gif")`` (with ``writer="pillow"``) or ``to_jshtml()`` in a notebook. Keep it in a
        variable until it has been saved.

    Raises:
        EerufError: a number is out of range, a robot moves, or there are no readings of these periods.

    Example:
        >>> import eeruf
        >>> scene = eeruf.sim.Scene.from_toml(eeruf.example("scenes/two-hc-sr04.toml"))
        >>> film = eeruf.plot.animation(scene, eeruf.sim.simulate(scene, "simultaneous", periods=4), frames=40)
        >>> film.save("two.gif", writer="pillow")  # doctest: +SKIP

    """
    check_kind("scene", scene, _eeruf.Scene, "an eeruf.sim.Scene")
    check_kind("readings", readings, _eeruf.Readings, "eeruf.sim.Readings")
    check_whole("first", first, 0, 2**31 - 1)
    check_whole("periods", periods, 1, 20)
    check_whole("frames", frames, 2, 5000)
    period_s = scene.robots[0].period_us / 1e6 if scene.robots else 0.0
    begin, end = first * period_s, (first + periods) * period_s
    shown = np.flatnonzero((np.asarray(readings.fired_s) >= begin) & (np.asarray(readings.fired_s) < end))
    if len(shown) == 0:
        raise EerufError(f"first = {first}: no readings of {periods} periods from there; expected some of them")
    flights = _flights(scene, readings, shown)
    ax = axes(ax, width=6.0, height=6.0)
    its = colours(ax)
    draw_scene(scene, ax=ax)
    sound = ax.scatter([], [], s=22, color=its.green, zorder=6)
    heard = ax.scatter([], [], s=90, linewidths=1.6, zorder=5)
    # Reserves room for the later titles.
    title = ax.set_title(" ", loc="left", fontsize="medium")
    # An echo is shown for a third of a period after it came in, so that the eye can follow.
    stays = period_s / 3
    end = max(end, max(flight.arrives for flight in flights) + stays)
    times = np.linspace(begin, end, frames)
    edges = {"right": its.blue, "wrong": its.vermilion, "not accepted": its.grey}

    def picture(frame: int) -> tuple[object, ...]:
        now = times[frame]
        sound.set_offsets(
            np.array([flight.place(now) for flight in flights if flight.leaves <= now < flight.arrives]).reshape(-1, 2)
        )
        there = [flight for flight in flights if flight.arrives <= now < flight.arrives + stays]
        heard.set_offsets(np.array([flight.way[-1] for flight in there]).reshape(-1, 2))
        heard.set_edgecolor([edges[flight.verdict] for flight in there])
        heard.set_facecolor([edges[flight.verdict] if flight.verdict != "not accepted" else "none" for flight in there])
        title.set_text(f"{readings.method}: {1e3 * (now - begin):5.1f} ms")
        return sound, heard, title

    from matplotlib.animation import FuncAnimation

    assert ax.figure is not None
    return FuncAnimation(ax.get_figure(root=True), picture, frames=frames, interval=60)  # type: ignore[arg-type]


class _Flight:
    """Sound on its way from one sensor to the sensor that hears it, in seconds of the simulation."""

    def __init__(self, way: NDArray[np.float64], leaves: float, arrives: float, verdict: str) -> None:
        self.way, self.leaves, self.arrives, self.verdict = way, leaves, arrives, verdict
        self._along = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(way, axis=0).T))])

    def place(self, now: float) -> NDArray[np.float64]:
        """Position at this instant, between leaving and arriving."""
        share = (now - self.leaves) / (self.arrives - self.leaves)
        along = share * self._along[-1]
        return np.array([np.interp(along, self._along, self.way[:, axis]) for axis in (0, 1)])


def _flights(scene: Scene, readings: Readings, shown: NDArray[np.intp]) -> list[_Flight]:
    wrong, accepted = readings.is_wrong(), readings.is_accepted
    ways: dict[int, NDArray[np.float64] | None] = {}
    flights = []
    for reading in shown:
        path, echo_us = int(readings.path[reading]), float(readings.earliest_us[reading])
        if path < 0 or np.isnan(echo_us):
            continue
        if path not in ways:
            ways[path] = way(scene, readings.paths, path)
        line = ways[path]
        if line is None:
            raise EerufError(
                "scene: the readings came along other ways; expected their own scene, with robots that stand still"
            )
        verdict = "not accepted" if not accepted[reading] else "wrong" if wrong[reading] else "right"
        leaves, arrives = float(readings.emitted_s[reading]), float(readings.fired_s[reading]) + echo_us / 1e6
        flights.append(_Flight(line, leaves, arrives, verdict))
    if not flights:
        raise EerufError("readings: nothing was heard in these periods; expected some echo")
    return flights

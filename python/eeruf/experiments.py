"""The paper's experiments (Sec. 4): robots that stand before walls, and a robot that drives between poles.

What the tables say, and where the paper promises too much, stands in ``docs/experiments.md``; the program prints the same ones
(``eeruf experiment``).
"""

from __future__ import annotations

import json
from dataclasses import dataclass, field, fields
from typing import TYPE_CHECKING, Any, Literal

from eeruf import _eeruf

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    import numpy as np
    from numpy.typing import NDArray

    _Progress = bool | Callable[[float | None, str], object] | None
    from eeruf._eeruf import _Method as Method
    from eeruf._eeruf import _Physics

    _Corner = Literal["behind", "ahead"] | tuple[float, float] | None
    _Pilot = Literal["own", "shared", "published", "published-gro"]

__all__ = ["FIRST", "SPEEDS_M_S", "Run", "SetTwo", "set_one", "set_two", "speed_sweep"]

FIRST: int = 20_000
"""The number of the first alcove or course unless ``first`` says otherwise; parameters were tuned on numbers below 2,000."""

SPEEDS_M_S: tuple[float, ...] = (0.5, 0.75, 1.0, 1.25, 1.5, 1.75, 2.0)
"""The top speeds of :func:`speed_sweep` unless others are given, in m/s."""

# A method bears a speed at which this share of the courses is finished.
_BORNE = 0.95


def set_one(
    seeds: int = 200,
    *,
    readings: int = 8000,
    methods: Sequence[Method] | None = None,
    first: int = FIRST,
    physics: _Physics = "default",
    progress: _Progress = None,
) -> dict[str, Any]:
    """Set I: eight sensors before three walls at right angles, by every method, in many random alcoves.

    Runs on all cores; Ctrl-C ends it.

    Args:
        seeds: how many alcoves, 1 to 100,000.
        readings: about how many readings of each alcove and method, 1 or more.
        methods: names of ``eeruf.sim.METHODS``; all by default.
        first: the first alcove's number.
        physics: as the argument of ``eeruf.sim.Scene``.
        progress: True for a bar (tqdm if it is installed), or a callable that takes the share done and a text.

    Returns:
        What ``eeruf experiment set-one --json`` prints: ``{"methods": {NAME: {FIGURE: {"p10", "median", "p90"}}}}``. Shares are
        fractions of 1. The result does not depend on the number of threads.

    Raises:
        ArgumentError: a number is out of range, or there is no such method.
        ExperimentError: there are no methods.

    Example:
        >>> import eeruf
        >>> table = eeruf.experiments.set_one(seeds=2, readings=800, methods=["conventional", "eeruf"])
        >>> wrong = {name: method["wrong_of_all"]["median"] for name, method in table["methods"].items()}
        >>> wrong["eeruf"] < 0.1 < wrong["conventional"]
        True

    """
    table: dict[str, Any] = json.loads(_eeruf._set_one(seeds, first, readings, methods, progress, physics))
    return table


@dataclass(frozen=True, eq=False)
class Run:
    """What came of one course of Set II under one method. Equal runs have equal numbers throughout; runs pickle.

    Example:
        >>> import eeruf
        >>> run = eeruf.experiments.set_two(seeds=1, methods=["eeruf"]).runs["eeruf"][0]
        >>> run.ending, run.track.shape[1], run.track[0, 1:3].tolist()
        ('finished', 5, [1.0, 3.0])

    """

    course: int
    """The course's number: its poles are drawn from it."""
    ending: str
    """``"finished"``, ``"contact"`` (it touched a pole or a wall), or ``"time_out"``."""
    time_s: float
    """For how long the robot drove, in seconds."""
    way_m: float
    """How far it drove, in metres."""
    top_speed_m_s: float
    """Its highest speed, in m/s."""
    nearest_m: float
    """How near its outline came to a pole, in metres; infinite if it never came near one."""
    readings: int
    """How many readings its sensors took."""
    rejected: int
    """How many of them were not accepted."""
    wrong: int
    """How many were accepted and wrong."""
    phantom_echoes: int
    """How many echoes were entered into the grid where nothing is."""
    phantom_cells: int
    """How many cells of the grid are certain in the end though nothing is there."""
    poles_passed: int
    """How many poles the robot came within 1 m of."""
    poles_missed: int
    """How many of them never had an echo entered into the grid."""
    track: NDArray[np.float64] = field(repr=False)
    """Where it drove, every 30 ms: rows of time (s), x, y (m), heading (rad) and speed (m/s); shape (n, 5)."""
    grid: NDArray[np.float64] = field(repr=False)
    """The cells of 10 cm that are not empty in the end: rows of x, y (m) and certainty, 1 to 15; shape (m, 3)."""
    poles: NDArray[np.float64] = field(repr=False)
    """The course's poles: rows of x, y and radius in metres; shape (p, 3)."""

    def __eq__(self, other: object) -> bool:
        """Whether all fields are equal, arrays by their elements."""
        if not isinstance(other, Run):
            return NotImplemented
        import numpy as np

        return all(np.array_equal(getattr(self, name.name), getattr(other, name.name)) for name in fields(self))


class SetTwo(dict[str, Any]):
    """What ``eeruf experiment set-two --json`` prints, and beside it every run.

    The keys are ``first``, ``pilot``, ``physics``, ``bodies``, ``seeds``, ``second_robot_m``, ``speed_m_s`` and ``methods``:
    ``{NAME: {"courses", "finished", "finished_95", "contacts", "mean_speed_m_s", ...}}``. Shares are fractions of 1;
    ``finished_95`` is where the share of finished courses lies with 95 % confidence, by Wilson's interval.

    Example:
        >>> import eeruf
        >>> found = eeruf.experiments.set_two(seeds=1, methods=["eeruf"])
        >>> found["methods"]["eeruf"]["finished"], len(found.runs["eeruf"])
        (1, 1)

    """

    runs: dict[str, list[Run]]
    """For each method the runs, in the order of the courses."""

    def __init__(self, table: dict[str, Any], runs: dict[str, list[Run]]) -> None:
        """Keep a table and its runs."""
        super().__init__(table)
        self.runs = runs

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickle both."""
        return SetTwo, (dict(self), self.runs)


def set_two(
    seeds: int = 100,
    *,
    methods: Sequence[Method] | None = None,
    second_robot: _Corner = None,
    speed_m_s: float = 1.0,
    odometry: bool = True,
    t_delta_us: int | None = None,
    first: int = FIRST,
    pilot: _Pilot = "own",
    odometry_noise: bool = True,
    bodies: bool = False,
    physics: _Physics = "default",
    progress: _Progress = None,
) -> SetTwo:
    """Set II: a LabMate drives through random courses of 8 mm poles about 1.6 m apart, steered by what its ring reads.

    Accepted readings fill a histogram grid (HIMM), the vector field histogram steers. Every method drives the same courses,
    for at most 40 s each. Runs on all cores; Ctrl-C ends it.

    Args:
        seeds: how many courses, 1 to 100,000.
        methods: names of ``eeruf.sim.METHODS``; by default sequential, far_groups, conventional, comparison, eeruf,
            eeruf_best, adaptive, eeruf_hopping and multi_echo.
        second_robot: where another robot stands that fires 24 times in 80 ms: ``"behind"`` the start, ``"ahead"`` in the
            reflective corner that all sensors face, or a point (x, y) in metres of the lab, which is 10 m by 6 m.
        speed_m_s: the platform's highest speed, 0.1 to 5 m/s.
        odometry: whether the robot hands its ring the changes that its own motion should cause.
        t_delta_us: readings that differ by no more are near-identical; by default 150 with odometry and 500 without.
        first: the first course's number.
        pilot: who steers: ``"own"``, each method's own pilot, found by the same search for each; ``"shared"``, one for all that
            an earlier search found by the score of eeruf; ``"published"`` and ``"published-gro"``, the published settings
            without and with the growth rate operator.
        odometry_noise: whether wheels slip and are not measured quite right, so that the robot is off by some decimetre in the
            end; otherwise it knows exactly where it is.
        bodies: whether robots have bodies: the platform its square, with the ring on its edge, the second robot a disc, which is
            then an obstacle to sound and to the platform. The pilots were tuned without.
        physics: as the argument of ``eeruf.sim.Scene``.
        progress: True for a bar (tqdm if it is installed), or a callable that takes the share done and a text.

    Returns:
        The table, a dict, with the runs as ``.runs``; :func:`eeruf.plot.course` draws them. The result does not depend on the
        number of threads.

    Raises:
        ArgumentError: a number is out of range, or there is no such method.
        ExperimentError: there are no methods, or the second robot stands where it cannot.

    Example:
        >>> import eeruf
        >>> found = eeruf.experiments.set_two(seeds=2, methods=["conventional", "eeruf"])
        >>> {name: method["finished"] for name, method in found["methods"].items()}
        {'conventional': 2, 'eeruf': 1}

    """
    asked = _asked(seeds, methods, second_robot, speed_m_s, odometry, t_delta_us, first, pilot, odometry_noise, physics, bodies)
    table, runs = _eeruf._set_two(asked, progress)
    return SetTwo(json.loads(table), {method: [Run(**run) for run in of_method] for method, of_method in runs.items()})


def speed_sweep(
    speeds_m_s: Sequence[float] = SPEEDS_M_S,
    *,
    seeds: int = 100,
    methods: Sequence[Method] | None = None,
    second_robot: _Corner = None,
    odometry: bool = True,
    t_delta_us: int | None = None,
    first: int = FIRST,
    pilot: _Pilot = "own",
    odometry_noise: bool = True,
    bodies: bool = False,
    physics: _Physics = "default",
    progress: _Progress = None,
) -> dict[str, Any]:
    """Set II at several top speeds: which speed each method sustains. Ctrl-C ends it.

    Args:
        speeds_m_s: the platform's highest speeds, each 0.1 to 5 m/s.
        seeds: as in :func:`set_two`, and so all others.
        methods: as in :func:`set_two`.
        second_robot: as in :func:`set_two`.
        odometry: as in :func:`set_two`.
        t_delta_us: as in :func:`set_two`.
        first: as in :func:`set_two`.
        pilot: as in :func:`set_two`.
        odometry_noise: as in :func:`set_two`.
        bodies: as in :func:`set_two`.
        physics: as in :func:`set_two`.
        progress: as in :func:`set_two`.

    Returns:
        What ``eeruf experiment set-two --sweep --json`` prints: ``steps``, for each speed ``speed_m_s`` and by method the share
        ``finished`` and the ``mean_speed_m_s``; and by method ``borne_m_s``, the highest speed at which 95 % of the courses are
        finished, or None.

    Raises:
        ArgumentError: a number is out of range, or there is no such method.
        ExperimentError: there are no methods, or the second robot stands where it cannot.

    Example:
        >>> import eeruf
        >>> sweep = eeruf.experiments.speed_sweep([0.75, 1.0], seeds=2, methods=["eeruf"])
        >>> [step["finished"]["eeruf"] for step in sweep["steps"]], sweep["borne_m_s"]
        ([1.0, 0.5], {'eeruf': 0.75})

    """
    asked = _asked(seeds, methods, second_robot, 1.0, odometry, t_delta_us, first, pilot, odometry_noise, physics, bodies)
    sweep: dict[str, Any] = json.loads(_eeruf._speed_sweep(speeds_m_s, asked, progress))
    borne = {
        method: [step["speed_m_s"] for step in sweep["steps"] if step["finished"][method] >= _BORNE]
        for method in sweep["steps"][0]["finished"]
    }
    return {**sweep, "borne_m_s": {method: max(speeds, default=None) for method, speeds in borne.items()}}


def _asked(*values: Any) -> dict[str, Any]:
    names = (
        "seeds",
        "methods",
        "second_robot",
        "speed_m_s",
        "odometry",
        "t_delta_us",
        "first",
        "pilot",
        "odometry_noise",
        "physics",
        "bodies",
    )
    return dict(zip(names, values))

"""Answers of calls: frozen classes, made by the compiled part."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from eeruf._summary import Result, document

if TYPE_CHECKING:
    from typing import Literal

    from eeruf._eeruf import Schedule, _Condition, _Doubt, _Phase, _StateKind


@dataclass(frozen=True)
class Violation(Result):
    """One condition that a schedule does not meet.

    Example:
        >>> from eeruf.tables import TABLE_I_B
        >>> violation = TABLE_I_B.verify(t_delta_us=999, min_interval_us=15_000).violations[0]
        >>> violation.kind, violation.value_us < violation.required_us, violation.source
        ('interval', True, 'Sec. 3.1 c')

    """

    kind: _Condition
    """The condition; the last three only if sensors differ."""
    sensors: tuple[int, int]
    """The two sensors, from 0; the same one twice if the condition is about a single sensor."""
    phases: tuple[_Phase, _Phase]
    """The phases in which they fire."""
    value_us: int
    """Value of the schedule, in microseconds."""
    required_us: int
    """Value that the condition requires, in microseconds."""
    source: str
    """Source of the condition, such as ``"Eq. (13a)"``."""


@dataclass(frozen=True)
class Report(Result):
    """Findings of ``Schedule.verify``. It is true if all conditions hold.

    Example:
        >>> from eeruf.tables import TABLE_I_D
        >>> bool(TABLE_I_D.verify(t_delta_us=999)), bool(TABLE_I_D.verify(t_delta_us=1_000))
        (True, False)

    """

    separation_us: int | None
    """The smaller left side of (13a), (13b) for the pair that is closest to failing, in microseconds; None for one sensor."""
    max_t_delta_us: int | None
    """The largest ``T_delta`` at which (13a), (13b) (and the stale echo condition, if asked for) hold, in microseconds; None
    if none does."""
    min_interval_us: int | None
    """The smallest time between the firings of two neighbours, in microseconds; None without neighbours."""
    min_refire_us: int
    """The shortest time between two firings of one sensor, in microseconds."""
    violations: tuple[Violation, ...]
    """Every violation: first (13a), then (13b), stale echoes, intervals and windows."""

    @property
    def ok(self) -> bool:
        """True if every condition holds."""
        return not self.violations

    def to_dict(self) -> dict[str, object]:
        """Return the fields by their names, with ``ok`` before them and violations as dicts.

        Example:
            >>> from eeruf.tables import TABLE_I_D
            >>> report = TABLE_I_D.verify(t_delta_us=999, min_interval_us=15_000).to_dict()
            >>> report["ok"], report["min_interval_us"]
            (True, 17000)

        """
        return {"ok": self.ok, **super().to_dict()}

    def __bool__(self) -> bool:
        """Return true if every condition holds."""
        return self.ok


@dataclass(frozen=True)
class Found(Result):
    """The result of a search: the best schedule found, and whether it is proven to be the best.

    Example:
        >>> import eeruf
        >>> found = eeruf.design(sensors=4, t_delta_us=999, min_interval_us=15_000, window_us=36_000)
        >>> found.value_us, found.bound_us, found.proven
        (62000, 62000, True)

    """

    schedule: Schedule | None
    """The schedule; None if there is none, or none was found within the budget."""
    value_us: int | None
    """The optimised value, in microseconds: the period, the smallest interval or ``T_delta``; None without a schedule."""
    bound_us: int | None
    """Proven bound of the value, in microseconds; None if no schedule exists."""
    proven: bool
    """True if no better schedule exists (or none at all, without a schedule)."""
    nodes: int
    """Number of nodes that the search visited: the same on each machine."""
    seconds: float
    """Duration of the search, in seconds."""
    reason: str | None = None
    """The reason why the period is not shorter, in words; None from ``WaitSearch.best``."""
    certificate: str | None = field(default=None, repr=False)
    """A proof for :func:`~eeruf.check_certificate`; None unless requested from ``design``."""
    from_atlas: bool = field(default=False, repr=False)
    """True if the atlas of proven rings answered, and nothing was searched."""
    certified_us: int | None = None
    """The lower bound on the period that the certificate proves, in microseconds: if it is less than ``value_us``, the
    period is proven but not certified. None unless the atlas answered or ``design`` was asked for a certificate."""


@dataclass(frozen=True)
class Blind(Result):
    """A sensor that hears echoes, none of which was accepted for this many firings.

    Example:
        >>> import eeruf
        >>> eeruf.typing.Blind(sensor=3, firings=20).to_dict()
        {'sensor': 3, 'firings': 20}

    """

    sensor: int
    """The sensor, from 0."""
    firings: int
    """Number of firings with an echo that was not accepted."""


@dataclass(frozen=True)
class State(Result):
    """The state of the space in front of a sensor.

    Example:
        >>> import eeruf
        >>> eeruf.State("clear", age_us=51_200).to_dict()
        {'kind': 'clear', 't_echo_us': None, 'age_us': 51200, 'why': None, 'explained_by': None}

    """

    kind: _StateKind
    """The kind: ``"obstacle"``; ``"clear"``, nothing is in range; ``"too_close"``, something is closer than the sensor can
    measure; ``"unanswered"``, the sensor does not answer, or its line is stuck; or ``"unknown"``."""
    t_echo_us: int | None = None
    """The echo time of an obstacle, in microseconds; otherwise None."""
    age_us: int = 0
    """Microseconds since the state was last confirmed, or since when it has been unknown or unanswered; at most 2^31
    (36 minutes), which stands for all longer times."""
    why: _Doubt | None = None
    """The reason why nothing is known: ``"no_firing"``, ``"unsure"`` (one echo, or one silence), ``"rejected"``, ``"no_witness"``
    (silence that nothing confirms) or ``"ambiguous"``; None for other kinds."""
    explained_by: int | Literal["history"] | None = None
    """The sensor whose sound explains an ambiguous echo, or ``"history"``; None for other states."""


@dataclass(frozen=True)
class RobotState(Result):
    """The current state of a robot in a ``Simulation``.

    Example:
        >>> from eeruf import sim
        >>> robot = sim.Robot((1, 0, 0), sensors=8, spacing_rad=0.26, radius_m=0.3)
        >>> sim.Simulation(sim.Scene([[5, 2, -5, 2]], robots=[robot])).robots[0].pose
        (1.0, 0.0, 0.0)

    """

    pose: tuple[float, float, float]
    """The pose: (x, y, heading) in metres and radians."""
    velocity_m_s: tuple[float, float] = (0.0, 0.0)
    """Velocity along x and y, in m/s."""
    turn_rad_s: float = 0.0
    """Rate of turn, counter-clockwise, in rad/s."""
    touches: bool = False
    """True if the disc that holds its sensors touches a wall or a pole."""


@dataclass(frozen=True)
class Steering(Result):
    """The direction to steer in.

    Example:
        >>> from eeruf import nav
        >>> steering = nav.Vfh().steer(nav.Himm(), place=(0, 0), target=(0, 5))
        >>> round(steering.direction_rad, 3), steering.trapped
        (1.571, False)

    """

    direction_rad: float
    """The direction, in radians of the scene, counter-clockwise from the x axis."""
    valley: tuple[int, int] = (0, 72)
    """The chosen valley: its first sector and number of sectors; 72 if nothing is near."""
    trapped: bool = False
    """True if the direction leads away from the target, by more than 90 degrees: the robot is in a dead end, or soon will
    be."""


document({**globals()})

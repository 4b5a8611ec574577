"""Results of experiments, as frozen classes: a figure has the same name in each of them, and in the program's JSON."""

from __future__ import annotations

from dataclasses import dataclass, field, fields
from typing import TYPE_CHECKING, ClassVar, Literal

from eeruf._summary import Result, Summary, Table, document

if TYPE_CHECKING:
    from collections.abc import Mapping

    import numpy as np
    from numpy.typing import NDArray

    from eeruf._eeruf import _Physics

    _Ending = Literal["finished", "contact", "time_out"]
    _PilotName = Literal["own", "shared", "published", "published-gro"]


@dataclass(frozen=True)
class Spread(Result):
    """The spread of a figure over geometries.

    Example:
        >>> import eeruf
        >>> table = eeruf.experiments.set_one(seeds=2, readings=400, methods=["eeruf"])
        >>> spread = table.methods["eeruf"].rejected
        >>> spread.p10 <= spread.median <= spread.p90
        True

    """

    p10: float
    """The value that one geometry in ten does not exceed."""
    median: float
    """The median over the geometries."""
    p90: float
    """The value that nine geometries in ten do not exceed."""
    median_95: tuple[float, float]
    """95 % confidence interval of the median, by bootstrap."""
    p90_95: tuple[float, float]
    """95 % confidence interval of ``p90``."""
    mean: float
    """The mean over the geometries."""
    mean_95: tuple[float, float]
    """95 % confidence interval of ``mean``."""


@dataclass(frozen=True)
class Latency(Result):
    """The time until a sensor reads correctly again after a wall has moved.

    Example:
        >>> import eeruf
        >>> table = eeruf.experiments.set_one(seeds=2, readings=400, methods=["eeruf"])
        >>> table.methods["eeruf"].nearer.steps > 0
        True

    """

    steps: int
    """Number of steps of sensors."""
    median: int | None
    """The number of periods within which half of the steps are seen; None if more than half never are."""
    p90: int | None
    """The number of periods within which nine in ten steps are seen."""
    never: float
    """Share of the steps that are not seen within 64 periods."""
    never_95: tuple[float, float]
    """95 % confidence interval of ``never``, by bootstrap."""


@dataclass(frozen=True)
class NewStep(Result):
    """The time until a wall that comes nearer for the first time is read right, when remembered places do not help.

    Example:
        >>> import eeruf
        >>> table = eeruf.experiments.set_one(seeds=2, readings=400, methods=["sequential"])
        >>> table.methods["sequential"].new_step.median_ms < 400
        True

    """

    steps: int
    """Number of steps of sensors."""
    median_ms: float | None
    """The time within which half of the steps are seen, in milliseconds; None if more than half never are."""
    p90_ms: float | None
    """The time within which nine in ten steps are seen, in milliseconds."""
    p95_ms: float | None
    """The time within which nineteen in twenty steps are seen, in milliseconds."""
    never: float
    """Share of the steps that are not seen within 64 periods."""


@dataclass(frozen=True)
class SetOneFigures(Result):
    """A method's figures over the geometries of Set I: those of a :class:`~eeruf.typing.Summary`, as spreads.

    A spread is None where no geometry has the figure.

    Example:
        >>> import eeruf
        >>> table = eeruf.experiments.set_one(seeds=2, readings=400, methods=["conventional"])
        >>> table.methods["conventional"].wrong_of_all.median > 0.1
        True

    """

    wrong_of_all: Spread | None
    """Share of all readings that were accepted and wrong."""
    crosstalk_of_all: Spread | None
    """The part of ``wrong_of_all`` that foreign or stale sound caused."""
    confirmed_wrong_of_all: Spread | None
    """The part of ``wrong_of_all`` that was confirmed, not only tentative."""
    wrong_of_accepted: Spread | None
    """Share of the accepted readings that were wrong."""
    wrong_before_filter: Spread | None
    """Share of all readings that would have been wrong without a filter."""
    rejected: Spread | None
    """Share of all readings that were not accepted."""
    good_lost: Spread | None
    """Share of the good readings that were not accepted."""
    age_ms: Spread | None
    """Median age of the last accepted reading, in milliseconds."""
    age_p99_ms: Spread | None
    """The age that 99 % of the last accepted readings do not exceed, in milliseconds."""
    readings_per_s: Spread | None
    """Accepted readings per second, over all sensors."""
    belief_right: Spread | None
    """Share of the time in which the latest accepted reading, at most 0.6 s old, is right."""
    unknown: Spread | None
    """Share of the time without an accepted reading that is at most 0.6 s old."""
    phantom: Spread | None
    """Share of the time in which the latest accepted reading is foreign sound."""
    too_far: Spread | None
    """Share of the time in which a sensor's latest accepted reading is its own later echo, or silence despite one."""
    faint: Spread | None
    """Share of the time in which a sensor's latest accepted reading is its own nearer echo, faint but real."""
    right_echoes_per_s: Spread | None
    """Accepted echoes per second that were right, over all sensors."""
    starved: float
    """Mean number of sensors that had fewer than 5 % of their readings accepted."""
    starved_95: tuple[float, float]
    """95 % confidence interval of ``starved``, by bootstrap."""
    blind: float
    """Mean number of sensors that were right in fewer than 5 % of their firings."""
    starved_in_part: float
    """Mean number of starved sensors that read right in one phase and not in another."""
    nearer: Latency | None
    """The time until the back wall is read right again when it has come nearer."""
    farther: Latency | None
    """The time until the wall is read right after it has moved away by the same distance."""
    new_step: NewStep | None
    """The time until the wall is read right after it comes nearer for the first time."""


# The fields of a summary that are not figures.
_NOT_COMPARED = ("method", "readings", "accepted")


@dataclass(frozen=True)
class AlcoveRun(Result):
    """The result of one alcove of Set I under one method.

    Example:
        >>> import eeruf
        >>> run = eeruf.experiments.set_one(seeds=1, readings=400, methods=["eeruf"]).runs["eeruf"][0]
        >>> run.seed, run.summary.readings
        (20000, 400)

    """

    seed: int
    """The alcove's number, the seed of its random numbers."""
    summary: Summary
    """The figures of the unchanged alcove."""
    nearer: tuple[int | None, ...] = field(repr=False)
    """The period in which each sensor reads the back wall right, for each step nearer; None for never."""
    farther: tuple[int | None, ...] = field(repr=False)
    """The period in which each sensor reads the back wall right, for each step away; None for never."""
    new_ms: tuple[float | None, ...] = field(repr=False)
    """The time after which each sensor reads the first step nearer right, in milliseconds; None for never."""

    def figures(self) -> dict[str, float | None]:
        """Return the figures that :func:`~eeruf.experiments.compare` compares: the summary's, by name.

        Example:
            >>> import eeruf
            >>> run = eeruf.experiments.set_one(seeds=1, readings=400, methods=["eeruf"]).runs["eeruf"][0]
            >>> run.figures()["rejected"] == run.summary.rejected
            True

        """
        return {
            name.name: getattr(self.summary, name.name) for name in fields(Summary) if name.name not in _NOT_COMPARED
        }


@dataclass(frozen=True)
class PlacingRun(Result):
    """The result of one placing of Set III under one method, with the figures of :class:`SetThreeFigures`.

    Example:
        >>> import eeruf
        >>> found = eeruf.experiments.set_three(seeds=1, periods=20, methods=["eeruf"])
        >>> run = found.runs["eeruf"][0]
        >>> run.seed, 0 <= run.belief_right <= 1
        (20000, True)

    """

    seed: int
    """The placing's number, the seed of its random numbers."""
    others_of_accepted: float | None
    """Share of the accepted readings that are another robot's sound; None if none was accepted."""
    others_at_worst: float | None
    """The largest share of another robot's sound for one sensor, among those with five or more accepted readings."""
    foreign_of_accepted: float | None
    """Share of the accepted readings that are foreign sound."""
    good_lost: float | None
    """Share of the good readings that were not accepted."""
    right_echoes_per_s: float
    """Accepted echoes of one robot per second that were right."""
    belief_right: float
    """Share of the time in which the latest accepted reading, at most 0.6 s old, is right."""
    unknown: float
    """Share of the time without an accepted reading that is at most 0.6 s old."""
    phantom: float
    """Share of the time in which the latest accepted reading is foreign sound."""
    too_far: float
    """Share of the time in which a sensor's latest accepted reading is its own later echo, or silence despite one."""
    faint: float
    """Share of the time in which a sensor's latest accepted reading is its own nearer echo, faint but real."""
    blind: float
    """Number of sensors of one robot that were right in fewer than 5 % of their firings."""

    def figures(self) -> dict[str, float | None]:
        """Return the figures that :func:`~eeruf.experiments.compare` compares, by name.

        Example:
            >>> import eeruf
            >>> run = eeruf.experiments.set_three(seeds=1, periods=20, methods=["eeruf"]).runs["eeruf"][0]
            >>> run.figures()["blind"] == run.blind
            True

        """
        return {name.name: getattr(self, name.name) for name in fields(self) if name.name != "seed"}


@dataclass(frozen=True)
class Difference(Result):
    """The difference of a figure between two methods, scene by scene.

    Example:
        >>> import eeruf
        >>> runs = eeruf.experiments.set_one(seeds=6, readings=400, methods=["eeruf", "conventional"]).runs
        >>> found = eeruf.experiments.compare(runs["eeruf"], runs["conventional"])["wrong_of_all"]
        >>> found.pairs, found.less, found.median_95[1] < 0
        (6, 6, True)

    """

    pairs: int
    """Number of scenes in which both methods have the figure."""
    mean: float
    """Mean difference."""
    mean_95: tuple[float, float]
    """95 % confidence interval of the mean, by the percentile bootstrap over scenes."""
    median: float
    """Median difference."""
    median_95: tuple[float, float] | None
    """Interval of the median with at least 95 % confidence, from the sign test: exact for any distribution. None with
    fewer than six scenes."""
    less: int
    """Number of scenes in which the difference is below 0."""
    more: int
    """Number of scenes in which the difference is above 0."""
    p_sign: float
    """Two-sided p-value of the exact sign test over the scenes that differ."""


@dataclass(frozen=True)
class SetOne(Table):
    """The result of ``eeruf.experiments.set_one``; ``to_dict`` gives what ``eeruf lab experiment set-one --json`` prints.

    Example:
        >>> import eeruf
        >>> table = eeruf.experiments.set_one(seeds=2, readings=400, methods=["eeruf"])
        >>> table.seeds, table.sensors, list(table.methods)
        (2, 8, ['eeruf'])

    """

    _titles: ClassVar[dict[str, str]] = {
        "wrong_of_all": "wrong of all %",
        "rejected": "rejected %",
        "good_lost": "good lost %",
        "age_ms": "age, ms",
        "readings_per_s": "readings/s",
    }

    first: int
    """The first geometry's number."""
    seeds: int
    """Number of geometries."""
    physics: _Physics
    """The simulated effects of sound: a preset's name, or each effect."""
    sensors: int
    """Number of sensors of the ring."""
    period_us: int
    """The period, in microseconds."""
    periods: int
    """Number of periods for which each geometry was simulated."""
    methods: Mapping[str, SetOneFigures]
    """The figures of each method by its label, in the order asked for."""
    runs: Mapping[str, list[AlcoveRun]] = field(repr=False)
    """The runs of each method, in the order of the alcoves, as :func:`~eeruf.experiments.compare` takes them."""


@dataclass(frozen=True, eq=False)
class Run(Result):
    """The outcome of one course of Set II under one method. Runs pickle, and are equal if all their numbers are.

    Example:
        >>> import eeruf
        >>> run = eeruf.experiments.set_two(seeds=1, methods=["eeruf"]).runs["eeruf"][0]
        >>> run.ending, run.track.shape[1], run.track[0, 1:3].tolist()
        ('finished', 5, [1.0, 3.0])

    """

    course: int
    """The course's number, from which its poles are drawn."""
    ending: _Ending
    """The ending: ``"finished"``, ``"contact"`` (the robot touched a pole or a wall), or ``"time_out"``."""
    time_s: float
    """Time for which the robot drove, in seconds."""
    way_m: float
    """The distance that the robot drove, in metres."""
    top_speed_m_s: float
    """The highest speed, in m/s."""
    nearest_m: float
    """The least distance of the robot's outline from a pole, in metres; infinite if it never came near one."""
    readings: int
    """Number of readings of the robot's sensors."""
    rejected_readings: int
    """Number of readings that were not accepted."""
    wrong_readings: int
    """Number of readings that were accepted and wrong."""
    phantom_echoes: int
    """Number of echoes that were entered into the grid where nothing is."""
    phantom_cells: int
    """Number of cells of the grid that are certain at the end though nothing is there."""
    poles_passed: int
    """Number of poles that the robot came within 1 m of."""
    poles_unseen: int
    """Number of passed poles that never had an echo entered into the grid."""
    track: NDArray[np.float64] = field(repr=False)
    """Poses on the way, every 30 ms: rows of time (s), x, y (m), heading (rad) and speed (m/s); shape (n, 5)."""
    grid: NDArray[np.float64] = field(repr=False)
    """The cells of 10 cm that are not empty at the end: rows of x, y (m) and certainty, 1 to 15; shape (m, 3)."""
    poles: NDArray[np.float64] = field(repr=False)
    """The course's poles: rows of x, y and radius in metres; shape (p, 3)."""

    @property
    def seed(self) -> int:
        """The course's number, the seed of its random numbers."""
        return self.course

    def figures(self) -> dict[str, float | None]:
        """Return the figures that :func:`~eeruf.experiments.compare` compares: those of :class:`SetTwoFigures` for this course.

        ``finished`` and ``contacts`` are 1 or 0. A course without a pole nearby has no ``nearest_m``.

        Example:
            >>> import eeruf
            >>> run = eeruf.experiments.set_two(seeds=1, methods=["eeruf"]).runs["eeruf"][0]
            >>> run.figures()["finished"]
            1.0

        """

        def share(count: float, of: float) -> float | None:
            return count / of if of > 0 else None

        return {
            "finished": float(self.ending == "finished"),
            "contacts": float(self.ending == "contact"),
            "timed_out": float(self.ending == "time_out"),
            "time_s": self.time_s,
            "mean_speed_m_s": share(self.way_m, self.time_s),
            "top_speed_m_s": self.top_speed_m_s,
            "nearest_m": self.nearest_m if self.nearest_m < float("inf") else None,
            "wrong_of_all": share(self.wrong_readings, self.readings),
            "rejected": share(self.rejected_readings, self.readings),
            "phantom_echoes": float(self.phantom_echoes),
            "phantom_cells": float(self.phantom_cells),
            "poles_missed": share(self.poles_unseen, self.poles_passed),
            "readings_per_s": share(self.readings - self.rejected_readings, self.time_s),
        }

    def __eq__(self, other: object) -> bool:
        """Return true if all fields are equal, arrays by their elements."""
        if not isinstance(other, Run):
            return NotImplemented
        import numpy as np

        return all(np.array_equal(getattr(self, name.name), getattr(other, name.name)) for name in fields(self))


@dataclass(frozen=True)
class SetTwoFigures(Result):
    """A method's figures over the courses of Set II. Shares are fractions of 1.

    Example:
        >>> import eeruf
        >>> eeruf.experiments.set_two(seeds=1, methods=["eeruf"]).methods["eeruf"].finished
        1

    """

    courses: int
    """Number of courses."""
    finished: int
    """Number of courses finished without contact."""
    finished_95: tuple[float, float]
    """95 % confidence interval of the share of finished courses, by Wilson."""
    contacts: int
    """Number of courses in which the robot touched something."""
    timed_out: int
    """Number of courses in which the robot was stuck, or too slow."""
    mean_speed_m_s: float
    """Total distance divided by total time over all courses, in m/s."""
    top_speed_m_s: float
    """The highest speed in any course, in m/s."""
    nearest_m: float
    """The least distance of a pole from the robot's outline: the mean over the courses, in metres."""
    wrong_of_all: float
    """Share of all readings that were accepted and wrong."""
    rejected: float
    """Share of all readings that were not accepted."""
    phantom_echoes: float
    """Mean number of echoes per course that were entered into the grid where nothing is."""
    phantom_cells: float
    """Mean number of cells per course that are certain at the end though nothing is there."""
    poles_missed: float
    """Share of the poles within 1 m of the robot's way that it never saw."""
    readings_per_s: float
    """Accepted readings per second, over all sensors."""


@dataclass(frozen=True)
class SetTwo(Table):
    """The result of ``eeruf.experiments.set_two``; ``to_dict`` gives what ``eeruf lab experiment set-two --json`` prints, and the runs.

    Example:
        >>> import eeruf
        >>> found = eeruf.experiments.set_two(seeds=1, methods=["eeruf"])
        >>> found.methods["eeruf"].finished, len(found.runs["eeruf"])
        (1, 1)

    """

    _titles: ClassVar[dict[str, str]] = {
        "courses": "courses",
        "finished": "finished",
        "contacts": "contacts",
        "mean_speed_m_s": "mean speed, m/s",
        "wrong_of_all": "wrong of all %",
    }

    first: int
    """The first course's number."""
    pilot: _PilotName
    """The pilot that steered."""
    physics: _Physics
    """The simulated effects of sound: a preset's name, or each effect."""
    bodies: bool
    """True if robots had bodies."""
    seeds: int
    """Number of courses."""
    second_robot_m: tuple[float, float] | None
    """The place where another robot stood and fired, in metres."""
    speed_m_s: float
    """The platform's highest speed, in m/s."""
    methods: Mapping[str, SetTwoFigures]
    """The figures of each method by its label, in the order asked for."""
    runs: Mapping[str, list[Run]] = field(repr=False)
    """The runs of each method, in the order of the courses."""


@dataclass(frozen=True)
class SpeedStep(Result):
    """The result of Set II at one top speed.

    Example:
        >>> import eeruf
        >>> sweep = eeruf.experiments.speed_sweep([0.75], seeds=1, methods=["eeruf"])
        >>> sweep.steps[0].finished_of_all
        {'eeruf': 1.0}

    """

    speed_m_s: float
    """The platform's highest speed, in m/s."""
    finished_of_all: Mapping[str, float]
    """For each method, the share of all courses that were finished without contact."""
    finished_95: Mapping[str, tuple[float, float]]
    """95 % confidence interval of the finished share for each method, by Wilson."""
    mean_speed_m_s: Mapping[str, float]
    """Total distance divided by total time over all courses, for each method, in m/s."""


@dataclass(frozen=True)
class SpeedSweep(Table):
    """The result of ``eeruf.experiments.speed_sweep``.

    Example:
        >>> import eeruf
        >>> sweep = eeruf.experiments.speed_sweep([0.75, 1.0], seeds=2, methods=["eeruf"])
        >>> len(sweep.steps), sweep.borne_m_s
        (2, {'eeruf': 0.75})

    """

    first: int
    """The first course's number."""
    pilot: _PilotName
    """The pilot that steered."""
    physics: _Physics
    """The simulated effects of sound: a preset's name, or each effect."""
    bodies: bool
    """True if robots had bodies."""
    seeds: int
    """Number of courses."""
    second_robot_m: tuple[float, float] | None
    """The place where another robot stood and fired, in metres."""
    steps: tuple[SpeedStep, ...]
    """The outcome at each speed."""
    borne_m_s: Mapping[str, float | None]
    """For each method, the highest speed at which 95 % of the courses were finished; None if there is none."""

    def _rows(self) -> list[list[str]]:
        speeds = [f"{step.speed_m_s:g} m/s, finished %" for step in self.steps]
        shares = {name: [f"{100 * step.finished_of_all[name]:.0f}" for step in self.steps] for name in self.borne_m_s}
        return [["method", *speeds], *([name, *row] for name, row in shares.items())]


@dataclass(frozen=True)
class SetThreeFigures(Result):
    """A method's figures over the placings of Set III; figures that count sensors or seconds are for one robot.

    A spread is None where no placing has the figure.

    Example:
        >>> import eeruf
        >>> found = eeruf.experiments.set_three(seeds=2, periods=20, methods=["conventional"])
        >>> found.methods["conventional"].others_of_accepted.median >= 0
        True

    """

    others_of_accepted: Spread | None
    """Share of the accepted readings that are another robot's sound."""
    others_at_worst: Spread | None
    """The largest share of another robot's sound for one sensor, among those with five or more accepted readings."""
    foreign_of_accepted: Spread | None
    """Share of the accepted readings that are foreign sound, also of the robot's other sensors or an earlier firing."""
    good_lost: Spread | None
    """Share of the good readings that were not accepted."""
    right_echoes_per_s: Spread | None
    """Accepted echoes per second that were right."""
    belief_right: Spread | None
    """Share of the time in which the latest accepted reading, at most 0.6 s old, is right."""
    unknown: Spread | None
    """Share of the time without an accepted reading that is at most 0.6 s old."""
    phantom: Spread | None
    """Share of the time in which the latest accepted reading is foreign sound."""
    too_far: Spread | None
    """Share of the time in which a sensor's latest accepted reading is its own later echo, or silence despite one."""
    faint: Spread | None
    """Share of the time in which a sensor's latest accepted reading is its own nearer echo, faint but real."""
    blind: Spread | None
    """Number of sensors that were right in fewer than 5 % of their firings."""


@dataclass(frozen=True)
class SetThreeBrief(Result):
    """The figures for comparing groups of placings.

    Example:
        >>> import eeruf
        >>> found = eeruf.experiments.set_three(seeds=2, periods=20, methods=["flow"])
        >>> 0 <= found.groups[0].methods["flow"].belief_right.median <= 1
        True

    """

    others_of_accepted: Spread | None
    """Share of the accepted readings that are another robot's sound."""
    belief_right: Spread | None
    """Share of the time in which the latest accepted reading, at most 0.6 s old, is right."""


@dataclass(frozen=True)
class SetThreeGroup(Result):
    """A group of placings of Set III.

    Example:
        >>> import eeruf
        >>> found = eeruf.experiments.set_three(seeds=2, periods=20, methods=["eeruf"])
        >>> [(group.place, group.arrangement, group.robots) for group in found.groups]
        [('corridor', 'meeting', None), ('hall', 'meeting', None), (None, None, 5)]

    """

    placings: int
    """Number of placings in the group."""
    methods: Mapping[str, SetThreeBrief]
    """The figures of each method by its label, over these placings."""
    place: Literal["corridor", "hall"] | None = None
    """The place; None for all places."""
    arrangement: Literal["standing", "meeting", "following"] | None = None
    """The robots' arrangement; None for any."""
    robots: int | None = None
    """Number of robots; None for any."""


@dataclass(frozen=True)
class SetThree(Table):
    """The result of Set III over many placings of robots of the same make.

    Example:
        >>> import eeruf
        >>> found = eeruf.experiments.set_three(seeds=2, periods=20, methods=["sequential", "flow"], height="room")
        >>> list(found.methods), found.height
        (['sequential', 'flow'], 'room')

    """

    _titles: ClassVar[dict[str, str]] = {
        "others_of_accepted": "others of accepted %",
        "belief_right": "belief right %",
        "right_echoes_per_s": "right echoes/s",
    }

    first: int
    """The first placing's number."""
    seeds: int
    """Number of placings."""
    physics: _Physics
    """The simulated effects of sound: a preset's name, or each effect."""
    periods: int
    """Number of periods for which each placing was simulated."""
    methods: Mapping[str, SetThreeFigures]
    """The figures of each method by its label, over all placings."""
    groups: tuple[SetThreeGroup, ...]
    """Groups of placings, by place and arrangement, and by the number of robots."""
    runs: Mapping[str, list[PlacingRun]] = field(repr=False)
    """The runs of each method, in the order of the placings."""
    height: Literal["flat", "room"] = "flat"
    """``"room"`` if the rings heard floor and ceiling."""


document({**globals()})

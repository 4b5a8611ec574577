"""What simulations and experiments find, as frozen classes: a figure has the same name in each of them, and in the program's JSON."""

from __future__ import annotations

import json
from dataclasses import dataclass, field, fields, replace
from typing import TYPE_CHECKING, Literal, TypedDict, TypeVar, cast

from eeruf._eeruf import ArgumentError, _difference, _figures

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    import numpy as np
    from numpy.typing import NDArray

    from eeruf._eeruf import _MethodName as Method
    from eeruf._eeruf import _Physics

    _Ending = Literal["finished", "contact", "time_out"]
    _PilotName = Literal["own", "shared", "published", "published-gro"]


class _SummaryFields(TypedDict):
    method: Method
    readings: int
    accepted: int
    wrong_of_all: float
    crosstalk_of_all: float
    confirmed_wrong_of_all: float
    wrong_of_accepted: float | None
    rejected: float
    good_lost: float | None
    wrong_before_filter: float
    belief_right: float
    unknown: float
    phantom: float
    too_far: float
    faint: float
    right_echoes_per_s: float
    age_ms: float
    age_p99_ms: float
    readings_per_s: float
    starved: int
    blind: int
    starved_in_part: int


def _plain(value: object) -> object:
    """As numbers, texts, lists and dicts."""
    if isinstance(value, _Result):
        return value.to_dict()
    if isinstance(value, dict):
        return {name: _plain(of) for name, of in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(item) for item in value]
    tolist = getattr(value, "tolist", None)
    return value if tolist is None else tolist()


class _Result:
    """What all results can do."""

    def to_dict(self) -> dict[str, object]:
        """Return the fields by their names, with results as dicts and arrays as lists, for JSON and data frames.

        Example:
            >>> from eeruf.experiments import Spread
            >>> Spread(0.0, 0.1, 0.5, (0.0, 0.2), (0.4, 0.6), 0.2, (0.1, 0.3)).to_dict()["median_95"]
            [0.0, 0.2]

        """
        return {name.name: _plain(getattr(self, name.name)) for name in fields(self)}  # type: ignore[arg-type]


@dataclass(frozen=True)
class Summary(_Result):
    """How good a method was: the figures that are always reported together. Shares are fractions of 1.

    Example:
        >>> from eeruf import sim
        >>> robot = sim.Robot((0, 0, 1.57), sensors=8, spacing_rad=0.26, radius_m=0.3)
        >>> summary = sim.simulate(sim.Scene([[5, 2, -5, 2]], robots=[robot]), periods=100).summary()
        >>> summary.readings, summary.wrong_of_all < 0.01, summary.to_dict()["method"]
        (800, True, 'eeruf')

    """

    method: Method
    """The method, one of ``eeruf.sim.METHODS``."""
    readings: int
    """How many readings there were."""
    accepted: int
    """How many of them were accepted."""
    wrong_of_all: float
    """Share of all readings that were accepted and wrong: what does harm."""
    crosstalk_of_all: float
    """The part of ``wrong_of_all`` that foreign or stale sound caused."""
    confirmed_wrong_of_all: float
    """The part of ``wrong_of_all`` that was confirmed, not only tentative."""
    wrong_of_accepted: float | None
    """Share of the accepted readings that were wrong; None if none was accepted."""
    rejected: float
    """Share of all readings that were not accepted."""
    good_lost: float | None
    """Share of the good readings that were not accepted; None if no reading was good."""
    wrong_before_filter: float
    """Share of all readings that would have been wrong without any filter."""
    belief_right: float
    """Share of the time in which what was last believed, at most 0.6 s ago, is right."""
    unknown: float
    """The share in which nothing is believed."""
    phantom: float
    """The share in which it is foreign sound."""
    too_far: float
    """The share in which it is an own later echo, or silence where there is an echo."""
    faint: float
    """The share in which it is an own nearer echo: faint but real."""
    right_echoes_per_s: float
    """Accepted echoes that were right in a second, all sensors together."""
    age_ms: float
    """Age of a sensor's last accepted reading, in milliseconds: half of the time it is no older."""
    age_p99_ms: float
    """That age, 99 % of the time."""
    readings_per_s: float
    """Accepted readings in a second, all sensors together."""
    starved: int
    """How many sensors had fewer than 5 % of their readings accepted."""
    blind: int
    """How many sensors were right under 5 % of the times they fired."""
    starved_in_part: int
    """How many of the starved read right in one phase and not in another."""


@dataclass(frozen=True)
class Spread(_Result):
    """How a figure spreads over geometries.

    Example:
        >>> import eeruf
        >>> table = eeruf.experiments.set_one(seeds=2, readings=400, methods=["eeruf"])
        >>> spread = table.methods["eeruf"].rejected
        >>> spread.p10 <= spread.median <= spread.p90
        True

    """

    p10: float
    """One geometry in ten has no more."""
    median: float
    """Half of them have no more."""
    p90: float
    """Nine in ten have no more."""
    median_95: tuple[float, float]
    """Where the median lies with 95 % confidence, by bootstrap."""
    p90_95: tuple[float, float]
    """Where ``p90`` lies with 95 % confidence."""
    mean: float
    """The mean over the geometries."""
    mean_95: tuple[float, float]
    """Where ``mean`` lies with 95 % confidence."""


@dataclass(frozen=True)
class Latency(_Result):
    """How soon a sensor reads right again after a wall has moved.

    Example:
        >>> import eeruf
        >>> table = eeruf.experiments.set_one(seeds=2, readings=400, methods=["eeruf"])
        >>> table.methods["eeruf"].nearer.steps > 0
        True

    """

    steps: int
    """How many steps of sensors were counted."""
    median: int | None
    """Half of the steps are seen within as many periods; None if more than half never are."""
    p90: int | None
    """Nine in ten are."""
    never: float
    """Share of the steps that are not seen within 64 periods."""
    never_95: tuple[float, float]
    """Where ``never`` lies with 95 % confidence, by bootstrap."""


@dataclass(frozen=True)
class NewStep(_Result):
    """How soon a wall is read right that comes nearer for the first time, so that no memory of places helps.

    Example:
        >>> import eeruf
        >>> table = eeruf.experiments.set_one(seeds=2, readings=400, methods=["sequential"])
        >>> table.methods["sequential"].new_step.median_ms < 400
        True

    """

    steps: int
    """How many steps of sensors were counted."""
    median_ms: float | None
    """Half of the steps are seen within this time, in milliseconds; None if more than half never are."""
    p90_ms: float | None
    """Nine in ten are."""
    p95_ms: float | None
    """Nineteen in twenty are."""
    never: float
    """Share of the steps that are not seen within 64 periods."""


@dataclass(frozen=True)
class SetOneFigures(_Result):
    """A method's figures over the geometries of Set I; those of a :class:`~eeruf.sim.Summary`, spread.

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
    """The part of it that foreign or stale sound caused."""
    confirmed_wrong_of_all: Spread | None
    """The part of it that was confirmed, not only tentative."""
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
    """Accepted readings in a second, all sensors together."""
    belief_right: Spread | None
    """Share of the time in which what was last believed, at most 0.6 s ago, is right."""
    unknown: Spread | None
    """The share in which nothing is believed."""
    phantom: Spread | None
    """The share in which it is foreign sound."""
    too_far: Spread | None
    """The share in which it is an own later echo, or silence where there is an echo."""
    faint: Spread | None
    """The share in which it is an own nearer echo: faint but real."""
    right_echoes_per_s: Spread | None
    """Accepted echoes that were right in a second, all sensors together."""
    starved: float
    """Mean number of sensors that had fewer than 5 % of their readings accepted."""
    starved_95: tuple[float, float]
    """Where ``starved`` lies with 95 % confidence, by bootstrap."""
    blind: float
    """Mean number of sensors that were right under 5 % of the times they fired."""
    starved_in_part: float
    """Mean number of starved sensors that read right in one phase and not in another."""
    nearer: Latency | None
    """How soon the back wall is read right again when it has come nearer."""
    farther: Latency | None
    """How soon it is when it has gone away as far."""
    new_step: NewStep | None
    """How soon it is when it comes nearer for the first time."""


@dataclass(frozen=True)
class AlcoveRun(_Result):
    """The result of one alcove of Set I under one method.

    Example:
        >>> import eeruf
        >>> run = eeruf.experiments.set_one(seeds=1, readings=400, methods=["eeruf"]).runs["eeruf"][0]
        >>> run.seed, run.summary.readings
        (20000, 400)

    """

    seed: int
    """The alcove's number, which seeds all that is random."""
    summary: Summary
    """The figures of the alcove as it is."""
    nearer: tuple[int | None, ...] = field(repr=False)
    """For each step of the back wall nearer and each sensor, in which period it is read right; None for never."""
    farther: tuple[int | None, ...] = field(repr=False)
    """The same for the steps away."""
    new_ms: tuple[float | None, ...] = field(repr=False)
    """For the first step nearer, after how many milliseconds each sensor reads it right."""

    def figures(self) -> dict[str, float | None]:
        """Return what :func:`~eeruf.experiments.compare` compares: the summary's figures by name.

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
class PlacingRun(_Result):
    """The result of one placing of Set III under one method; the figures of :class:`SetThreeFigures`.

    Example:
        >>> import eeruf
        >>> found = eeruf.experiments.set_three(seeds=1, periods=20, methods=["eeruf"])
        >>> run = found.runs["eeruf"][0]
        >>> run.seed, 0 <= run.belief_right <= 1
        (20000, True)

    """

    seed: int
    """The placing's number, which seeds all that is random."""
    others_of_accepted: float | None
    """Share of the accepted readings that are another robot's sound; None if none was accepted."""
    others_at_worst: float | None
    """The same of the sensor that accepts the largest share of it, among those with five accepted readings."""
    foreign_of_accepted: float | None
    """Share of the accepted readings that are foreign sound."""
    good_lost: float | None
    """Share of the good readings that were not accepted."""
    right_echoes_per_s: float
    """Accepted echoes that were right in a second, of one robot."""
    belief_right: float
    """Share of the time in which what was last believed, at most 0.6 s ago, is right."""
    unknown: float
    """The share in which nothing is believed."""
    phantom: float
    """The share in which it is foreign sound."""
    too_far: float
    """The share in which it is an own later echo, or silence where there is an echo."""
    faint: float
    """The share in which it is an own nearer echo: faint but real."""
    blind: float
    """Sensors of one robot that were right under 5 % of the times they fired."""

    def figures(self) -> dict[str, float | None]:
        """Return what :func:`~eeruf.experiments.compare` compares: the figures by name.

        Example:
            >>> import eeruf
            >>> run = eeruf.experiments.set_three(seeds=1, periods=20, methods=["eeruf"]).runs["eeruf"][0]
            >>> run.figures()["blind"] == run.blind
            True

        """
        return {name.name: getattr(self, name.name) for name in fields(self) if name.name != "seed"}


@dataclass(frozen=True)
class Difference(_Result):
    """How a figure differs between two methods on the same scenes, scene by scene.

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
    """Where the mean lies with 95 % confidence, by the percentile bootstrap over scenes."""
    median: float
    """Median difference."""
    median_95: tuple[float, float] | None
    """Where the median lies with at least 95 % confidence: the sign test's interval, exact for any distribution. None below
    six scenes."""
    less: int
    """Number of scenes in which the difference is below 0."""
    more: int
    """Number of scenes in which it is above 0."""
    p_sign: float
    """Two-sided p-value of the exact sign test over the scenes that differ."""


@dataclass(frozen=True)
class SetOne(_Result):
    """What ``eeruf.experiments.set_one`` finds; ``to_dict`` is what ``eeruf experiment set-one --json`` prints.

    Example:
        >>> import eeruf
        >>> table = eeruf.experiments.set_one(seeds=2, readings=400, methods=["eeruf"])
        >>> table.seeds, table.sensors, list(table.methods)
        (2, 8, ['eeruf'])

    """

    first: int
    """The first geometry's number."""
    seeds: int
    """How many geometries."""
    physics: _Physics
    """Which effects of sound were computed: a preset's name, or each effect."""
    sensors: int
    """How many sensors the ring had."""
    period_us: int
    """The period, in microseconds."""
    periods: int
    """For how many periods each was simulated."""
    methods: Mapping[str, SetOneFigures]
    """The figures of each method by its label, in the order asked for."""
    runs: Mapping[str, list[AlcoveRun]] = field(repr=False)
    """For each method the result in each alcove, in their order: what :func:`~eeruf.experiments.compare` takes."""


@dataclass(frozen=True, eq=False)
class Run(_Result):
    """What came of one course of Set II under one method. Equal runs have equal numbers throughout; runs pickle.

    Example:
        >>> import eeruf
        >>> run = eeruf.experiments.set_two(seeds=1, methods=["eeruf"]).runs["eeruf"][0]
        >>> run.ending, run.track.shape[1], run.track[0, 1:3].tolist()
        ('finished', 5, [1.0, 3.0])

    """

    course: int
    """The course's number: its poles are drawn from it."""
    ending: _Ending
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
    rejected_readings: int
    """How many of them were not accepted."""
    wrong_readings: int
    """How many were accepted and wrong."""
    phantom_echoes: int
    """How many echoes were entered into the grid where nothing is."""
    phantom_cells: int
    """How many cells of the grid are certain in the end though nothing is there."""
    poles_passed: int
    """How many poles the robot came within 1 m of."""
    poles_unseen: int
    """How many of them never had an echo entered into the grid."""
    track: NDArray[np.float64] = field(repr=False)
    """Where it drove, every 30 ms: rows of time (s), x, y (m), heading (rad) and speed (m/s); shape (n, 5)."""
    grid: NDArray[np.float64] = field(repr=False)
    """The cells of 10 cm that are not empty in the end: rows of x, y (m) and certainty, 1 to 15; shape (m, 3)."""
    poles: NDArray[np.float64] = field(repr=False)
    """The course's poles: rows of x, y and radius in metres; shape (p, 3)."""

    @property
    def seed(self) -> int:
        """The course's number, which seeds all that is random."""
        return self.course

    def figures(self) -> dict[str, float | None]:
        """Return what :func:`~eeruf.experiments.compare` compares: the figures of :class:`SetTwoFigures` for this course.

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
        """Whether all fields are equal, arrays by their elements."""
        if not isinstance(other, Run):
            return NotImplemented
        import numpy as np

        return all(np.array_equal(getattr(self, name.name), getattr(other, name.name)) for name in fields(self))


@dataclass(frozen=True)
class SetTwoFigures(_Result):
    """A method's figures over the courses of Set II. Shares are fractions of 1.

    Example:
        >>> import eeruf
        >>> eeruf.experiments.set_two(seeds=1, methods=["eeruf"]).methods["eeruf"].finished
        1

    """

    courses: int
    """How many courses."""
    finished: int
    """How many were finished without contact."""
    finished_95: tuple[float, float]
    """Where the share of finished courses lies with 95 % confidence, by Wilson's interval."""
    contacts: int
    """In how many the robot touched something."""
    timed_out: int
    """In how many it was stuck, or too slow."""
    mean_speed_m_s: float
    """Way over time of all courses together, in m/s."""
    top_speed_m_s: float
    """The highest speed in any course, in m/s."""
    nearest_m: float
    """How near a pole came to the robot's outline: the mean over the courses, in metres."""
    wrong_of_all: float
    """Share of all readings that were accepted and wrong."""
    rejected: float
    """Share of all readings that were not accepted."""
    phantom_echoes: float
    """Echoes entered into the grid where nothing is, in each course on average."""
    phantom_cells: float
    """Cells of the grid that are certain in the end though nothing is there, in each course on average."""
    poles_missed: float
    """Share of the poles that the robot came within 1 m of that it never saw."""
    readings_per_s: float
    """Accepted readings in a second, all sensors together."""


@dataclass(frozen=True)
class SetTwo(_Result):
    """What ``eeruf.experiments.set_two`` finds; ``to_dict`` is what ``eeruf experiment set-two --json`` prints, and the runs.

    Example:
        >>> import eeruf
        >>> found = eeruf.experiments.set_two(seeds=1, methods=["eeruf"])
        >>> found.methods["eeruf"].finished, len(found.runs["eeruf"])
        (1, 1)

    """

    first: int
    """The first course's number."""
    pilot: _PilotName
    """Who steered."""
    physics: _Physics
    """Which effects of sound were computed: a preset's name, or each effect."""
    bodies: bool
    """Whether robots had bodies."""
    seeds: int
    """How many courses."""
    second_robot_m: tuple[float, float] | None
    """Where another robot stood and fired, in metres."""
    speed_m_s: float
    """The platform's highest speed, in m/s."""
    methods: Mapping[str, SetTwoFigures]
    """The figures of each method by its label, in the order asked for."""
    runs: Mapping[str, list[Run]] = field(repr=False)
    """For each method the runs, in the order of the courses."""


@dataclass(frozen=True)
class SpeedStep(_Result):
    """Set II at one top speed.

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
    """For each method, where that share lies with 95 % confidence, by Wilson's interval."""
    mean_speed_m_s: Mapping[str, float]
    """For each method, way over time of all courses together, in m/s."""


@dataclass(frozen=True)
class SpeedSweep(_Result):
    """What ``eeruf.experiments.speed_sweep`` finds.

    Example:
        >>> import eeruf
        >>> sweep = eeruf.experiments.speed_sweep([0.75, 1.0], seeds=2, methods=["eeruf"])
        >>> len(sweep.steps), sweep.borne_m_s
        (2, {'eeruf': 0.75})

    """

    first: int
    """The first course's number."""
    pilot: _PilotName
    """Who steered."""
    physics: _Physics
    """Which effects of sound were computed: a preset's name, or each effect."""
    bodies: bool
    """Whether robots had bodies."""
    seeds: int
    """How many courses."""
    second_robot_m: tuple[float, float] | None
    """Where another robot stood and fired, in metres."""
    steps: tuple[SpeedStep, ...]
    """What came of it at each speed."""
    borne_m_s: Mapping[str, float | None]
    """For each method the highest of the speeds at which 95 % of the courses were finished; None if there is none."""


@dataclass(frozen=True)
class SetThreeFigures(_Result):
    """A method's figures over the placings of Set III; what counts sensors or seconds is of one robot.

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
    """The same of the sensor that accepts the largest share of it, among those with five accepted readings."""
    foreign_of_accepted: Spread | None
    """Share of the accepted readings that are foreign sound, of the robot's other sensors or an earlier firing too."""
    good_lost: Spread | None
    """Share of the good readings that were not accepted."""
    right_echoes_per_s: Spread | None
    """Accepted echoes that were right in a second."""
    belief_right: Spread | None
    """Share of the time in which what was last believed, at most 0.6 s ago, is right."""
    unknown: Spread | None
    """The share in which nothing is believed."""
    phantom: Spread | None
    """The share in which it is foreign sound."""
    too_far: Spread | None
    """The share in which it is an own later echo, or silence where there is an echo."""
    faint: Spread | None
    """The share in which it is an own nearer echo: faint but real."""
    blind: Spread | None
    """Sensors that were right under 5 % of the times they fired."""


@dataclass(frozen=True)
class SetThreeBrief(_Result):
    """The figures that a group of placings is compared by.

    Example:
        >>> import eeruf
        >>> found = eeruf.experiments.set_three(seeds=2, periods=20, methods=["driving"])
        >>> 0 <= found.groups[0].methods["driving"].belief_right.median <= 1
        True

    """

    others_of_accepted: Spread | None
    """Share of the accepted readings that are another robot's sound."""
    belief_right: Spread | None
    """Share of the time in which what was last believed, at most 0.6 s ago, is right."""


@dataclass(frozen=True)
class SetThreeGroup(_Result):
    """Some of the placings of Set III.

    Example:
        >>> import eeruf
        >>> found = eeruf.experiments.set_three(seeds=2, periods=20, methods=["eeruf"])
        >>> [(group.place, group.arrangement, group.robots) for group in found.groups]
        [('corridor', 'meeting', None), ('hall', 'meeting', None), (None, None, 5)]

    """

    placings: int
    """How many placings these are."""
    methods: Mapping[str, SetThreeBrief]
    """By name, over these placings."""
    place: Literal["corridor", "hall"] | None = None
    """Where they are; None for anywhere."""
    arrangement: Literal["standing", "meeting", "following"] | None = None
    """How the robots are to each other; None for anyhow."""
    robots: int | None = None
    """How many robots there are; None for any number."""


@dataclass(frozen=True)
class SetThree(_Result):
    """Set III over many placings of robots of one make.

    Example:
        >>> import eeruf
        >>> found = eeruf.experiments.set_three(seeds=2, periods=20, methods=["sequential", "driving"], height="room")
        >>> list(found.methods), found.height
        (['sequential', 'driving'], 'room')

    """

    first: int
    """The first placing's number."""
    seeds: int
    """How many placings."""
    physics: _Physics
    """Which effects the rooms had."""
    periods: int
    """How many periods each was simulated for."""
    methods: Mapping[str, SetThreeFigures]
    """By name, over all placings; ``"driving"`` is time hopping by its settings for robots that drive."""
    groups: tuple[SetThreeGroup, ...]
    """The placings by place and arrangement, and by the number of robots."""
    runs: Mapping[str, list[PlacingRun]] = field(repr=False)
    """For each method the result in each placing, in their order."""
    height: Literal["flat", "room"] = "flat"
    """Whether the rings heard floor and ceiling."""


# A method bears a speed at which this share of the courses is finished.
_BORNE = 0.95

# What of a summary is no figure.
_NOT_COMPARED = ("method", "readings", "accepted")

_Fields = dict[str, object]


def _fields(text: str) -> _Fields:
    return cast("_Fields", json.loads(text))


def _pair(value: object) -> tuple[float, float] | None:
    return None if value is None else cast("tuple[float, float]", tuple(cast("list[float]", value)))


def _with_pairs(of: _Fields) -> _Fields:
    """Bounds of confidence as tuples."""
    return {name: _pair(value) if name.endswith("_95") else value for name, value in of.items()}


def summary(text: str) -> Summary:
    """Make a summary of what Rust says of it."""
    return Summary(**cast("_SummaryFields", _fields(text)))


def _spreads(of: _Fields) -> _Fields:
    """The figures of a method, with spreads for dicts."""
    made: _Fields = {}
    for name, value in _with_pairs(of).items():
        kind = {"nearer": Latency, "farther": Latency, "new_step": NewStep}.get(name, Spread)
        made[name] = kind(**_with_pairs(value)) if isinstance(value, dict) else value
    return made


def _alcove_run(of: _Fields) -> AlcoveRun:
    steps = {name: tuple(cast("list[None]", of[name])) for name in ("nearer", "farther", "new_ms")}
    summary = Summary(**cast("_SummaryFields", of["summary"]))
    return AlcoveRun(seed=cast("int", of["seed"]), summary=summary, **steps)


def _groups(of: object) -> tuple[SetThreeGroup, ...]:
    def group(of: _Fields) -> SetThreeGroup:
        methods = cast("dict[str, _Fields]", of["methods"])
        of["methods"] = {name: SetThreeBrief(**_spreads(brief)) for name, brief in methods.items()}  # type: ignore[arg-type]
        return SetThreeGroup(**of)  # type: ignore[arg-type]

    return tuple(group(of) for of in cast("list[_Fields]", of))


def _by_method(table: _Fields, runs: str) -> dict[str, list[_Fields]]:
    return dict(zip(cast("_Fields", table["methods"]), cast("list[list[_Fields]]", json.loads(runs))))


def set_one(text: str, runs: str) -> SetOne:
    """Make the result of Set I of its JSON and that of its runs."""
    table = _fields(text)
    table["runs"] = {name: [_alcove_run(of) for of in each] for name, each in _by_method(table, runs).items()}
    methods = cast("dict[str, _Fields]", table["methods"])
    table["methods"] = {name: SetOneFigures(**_spreads(of)) for name, of in methods.items()}  # type: ignore[arg-type]
    return SetOne(**table)  # type: ignore[arg-type]


def set_three(text: str, runs: str) -> SetThree:
    """Make the result of Set III of its JSON and that of its runs."""
    table = _fields(text)
    made = {name: [PlacingRun(**of) for of in each] for name, each in _by_method(table, runs).items()}  # type: ignore[arg-type]
    methods = cast("dict[str, _Fields]", table["methods"])
    table["methods"] = {name: SetThreeFigures(**_spreads(of)) for name, of in methods.items()}  # type: ignore[arg-type]
    table.update(groups=_groups(table["groups"]), runs=made)
    return SetThree(**table)  # type: ignore[arg-type]


def set_two(text: str, runs: Mapping[str, list[_Fields]]) -> SetTwo:
    """Make the result of Set II of its JSON and the fields of its runs."""
    table = _fields(text)
    figures = cast("dict[str, _Fields]", table["methods"])
    table["methods"] = {name: SetTwoFigures(**_with_pairs(of)) for name, of in figures.items()}  # type: ignore[arg-type]
    table["second_robot_m"] = _pair(table["second_robot_m"])
    table["runs"] = {name: [Run(**run) for run in of] for name, of in runs.items()}  # type: ignore[arg-type]
    return SetTwo(**table)  # type: ignore[arg-type]


# What of a run of Set II its figures need, under Rust's names.
_OF_COURSES = {
    "rejected_readings": "rejected",
    "wrong_readings": "wrong",
    "poles_unseen": "poles_missed",
    **{
        name: name
        for name in (
            "course",
            "ending",
            "time_s",
            "way_m",
            "top_speed_m_s",
            "nearest_m",
            "readings",
            "phantom_echoes",
            "phantom_cells",
            "poles_passed",
        )
    },
}


def _of_course(run: Run) -> _Fields:
    made = {theirs: getattr(run, ours) for ours, theirs in _OF_COURSES.items()}
    # JSON has no infinity.
    return {**made, "nearest_m": run.figures()["nearest_m"]}


Table = TypeVar("Table", SetOne, SetTwo, SetThree)


def concat(tables: Iterable[Table]) -> Table:
    """Put parts of one experiment together: the table is that of the undivided run, to the last bit.

    Args:
        tables: what :func:`set_one`, :func:`set_two` or :func:`set_three` returned for successive seeds, in any order.

    Raises:
        ArgumentError: tables of several kinds, settings or methods, or a seed that is missing or there twice.

    Example:
        >>> from eeruf import experiments
        >>> parts = [experiments.set_one(2, first=first, readings=400, methods=["eeruf"]) for first in (20_002, 20_000)]
        >>> experiments.concat(parts) == experiments.set_one(4, readings=400, methods=["eeruf"])
        True

    """
    try:
        parts = list(tables)
    except TypeError:
        parts = []
    expected = "tables of one of set_one, set_two and set_three"
    if not parts or not isinstance(parts[0], (SetOne, SetTwo, SetThree)):
        raise ArgumentError(f"tables = {tables!r:.60}; expected {expected}")
    for part in parts[1:]:
        if type(part) is not type(parts[0]):
            raise ArgumentError(f"tables: a {type(parts[0]).__name__} and a {type(part).__name__}; expected {expected}")
    parts.sort(key=lambda part: part.first)
    whole = parts[0]
    merged = {"first", "seeds", "methods", "runs", "groups"}
    for part, before in zip(parts[1:], parts):
        for name in (name.name for name in fields(part) if name.name not in merged):
            one, other = getattr(whole, name), getattr(part, name)
            if one != other:
                raise ArgumentError(f"tables: {name} = {one!r} and {other!r}; expected parts of one experiment")
        if list(part.runs) != list(whole.runs):
            raise ArgumentError(f"tables: methods {list(whole.runs)} and {list(part.runs)}; expected the same")
        if part.first != before.first + before.seeds:
            last, expected = before.first + before.seeds - 1, "each seed once, without a gap"
            raise ArgumentError(f"tables: seeds up to {last} and from {part.first} on; expected {expected}")
    runs = {name: [run for part in parts for run in part.runs[name]] for name in whole.runs}
    of = {SetOne: (1, _Result.to_dict), SetTwo: (2, _of_course), SetThree: (3, _Result.to_dict)}
    number, plain = of[type(whole)]
    pairs = [(name, [plain(run) for run in each]) for name, each in runs.items()]  # type: ignore[arg-type]
    found = _fields(_figures(number, json.dumps(pairs)))
    kind = {SetOne: SetOneFigures, SetTwo: SetTwoFigures, SetThree: SetThreeFigures}[type(whole)]
    methods = {name: kind(**_spreads(figures)) for name, figures in cast("list[tuple[str, _Fields]]", found["methods"])}
    changes: _Fields = {"seeds": sum(part.seeds for part in parts), "methods": methods, "runs": runs}
    if isinstance(whole, SetThree):
        changes["groups"] = _groups(found["groups"])
    return replace(whole, **changes)  # type: ignore[arg-type]


def compare(
    one: Iterable[AlcoveRun | Run | PlacingRun], other: Iterable[AlcoveRun | Run | PlacingRun]
) -> dict[str, Difference]:
    """Compare two methods scene by scene: each figure of ``one`` less that of ``other``, paired by seed.

    Scenes in which one of the two lacks a figure are left out of that figure.

    Args:
        one: runs of one method, such as ``table.runs["mine"]``.
        other: runs of the other on the same seeds.

    Returns:
        For each figure its :class:`Difference`: mean with the bootstrap's interval, median with the sign test's.

    Raises:
        ArgumentError: no runs, runs of different experiments, or different seeds.

    Example:
        >>> from eeruf import experiments
        >>> runs = experiments.set_one(4, readings=400, methods=["eeruf", "conventional"]).runs
        >>> experiments.compare(runs["eeruf"], runs["conventional"])["wrong_of_all"].mean < -0.2
        True

    """

    def by_seed(name: str, runs: Iterable[AlcoveRun | Run | PlacingRun]) -> dict[int, AlcoveRun | Run | PlacingRun]:
        given = list(runs) if isinstance(runs, (list, tuple)) else []
        if not given or not all(isinstance(run, (AlcoveRun, Run, PlacingRun)) for run in given):
            raise ArgumentError(f'{name} = {runs!r:.60}; expected runs of one method, such as table.runs["eeruf"]')
        return {run.seed: run for run in given}

    ours, theirs = by_seed("one", one), by_seed("other", other)
    if ours.keys() != theirs.keys():
        alone = sorted(ours.keys() ^ theirs.keys())
        raise ArgumentError(f"seed {alone[0]} and {len(alone) - 1} others are of one method only; expected equal seeds")
    pairs = [(ours[seed].figures(), theirs[seed].figures()) for seed in sorted(ours)]
    if pairs[0][0].keys() != pairs[0][1].keys():
        raise ArgumentError("runs of two experiments; expected those of one")
    found = {}
    for name in pairs[0][0]:
        values = [(first[name], second[name]) for first, second in pairs]
        text = _difference([first - second for first, second in values if first is not None and second is not None])
        if text is not None:
            found[name] = Difference(**_with_pairs(_fields(text)))  # type: ignore[arg-type]
    return found


def speed_sweep(text: str) -> SpeedSweep:
    """Make the result of a sweep over speeds of its JSON."""
    table = _fields(text)

    def made(step: _Fields) -> SpeedStep:
        bounds = cast("dict[str, list[float]]", step["finished_95"])
        pairs = {method: _pair(pair) for method, pair in bounds.items()}
        return SpeedStep(**{**step, "finished_95": pairs})  # type: ignore[arg-type]

    steps = tuple(made(step) for step in cast("list[_Fields]", table["steps"]))

    def borne_m_s(method: str) -> float | None:
        return max((step.speed_m_s for step in steps if step.finished_of_all[method] >= _BORNE), default=None)

    table.update(steps=steps, borne_m_s={method: borne_m_s(method) for method in steps[0].finished_of_all})
    table["second_robot_m"] = _pair(table["second_robot_m"])
    return SpeedSweep(**table)  # type: ignore[arg-type]

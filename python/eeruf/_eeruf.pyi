from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from os import PathLike
from typing import IO, Any, Final, Literal, SupportsIndex, TypedDict, TypeVar, final, overload, type_check_only

import numpy as np
import pandas as pd
import polars as pl
import xarray as xr
from numpy.typing import ArrayLike, NDArray
from typing_extensions import Unpack

from eeruf._summary import Summary
from eeruf._types import FlowSettings, HeardPaths, ReadingColumns
from eeruf.logs import Firings

# Whole numbers: Python's and NumPy's.
_Int = SupportsIndex
# One for all sensors, or one for each.
_Each = _Int | Iterable[_Int]
_Floats = NDArray[np.float64]
_Ints = NDArray[np.int64]
_Codes = NDArray[np.int8]
_Layout = Literal["line", "ring", "blocks"] | Iterable[tuple[_Int, _Int]]
_Criterion = Literal["exact", "paper"]
_Progress = bool | Callable[[float | None, str], object] | None
_Kind = Literal[
    "first",
    "accepted",
    "rejected",
    "repeated",
    "no_echo",
    "clear",
    "too_early",
    "late",
    "stuck",
    "tentative",
    "ambiguous",
    "unanswered",
]
_MethodName = Literal[
    "simultaneous",
    "sequential",
    "sequential_votes",
    "far_groups",
    "dither",
    "conventional",
    "comparison",
    "median",
    "eeruf_immediate",
    "eeruf",
    "eeruf_best",
    "adaptive",
    "eeruf_hopping",
    "flow",
    "multi_echo",
    "adaptive_hopping",
    "adaptive_multi_echo",
    "hopping_multi_echo",
    "flow_multi_echo",
    "in_turn",
    "arrays",
    "groups",
    "sync_line",
    "free_running",
    "table",
]
_Cause = Literal["nothing", "own", "stale", "crosstalk", "external"]
_Module = (
    Literal[
        "polaroid-6500",
        "hc-sr04",
        "hc-sr04-clone",
        "us-100",
        "jsn-sr04t",
        "a02yyuw",
        "ping",
        "mb1010",
        "mb1242",
        "srf08",
        # As older scenes have them.
        "polaroid_6500",
        "hc_sr04",
    ]
    | dict[str, float | str]
)
_Height = Literal["flat", "room"] | dict[str, float | _Surface]
_Beam = Literal["cut_at_90", "continuous"]
_Gain = Literal["constant", "square_root", "linear", "stepped", "polaroid_6500"]
_Physics = Literal["plain", "default"] | dict[str, bool | float | str]
_Body = float | tuple[float, float] | list[tuple[float, float]]
_Fault = dict[str, Any]
_Phase = Literal["a", "b"]
_StateKind = Literal["obstacle", "clear", "too_close", "unanswered", "unknown"]
_Doubt = Literal["no_firing", "unsure", "rejected", "ambiguous"]
_Condition = Literal[
    "crosstalk_a", "crosstalk_b", "stale_echo", "interval", "window", "shared_line", "refire", "together"
]
_Hopping = Literal["balanced", "quick", "driving", "maps"]
_Pose = tuple[float, float, float]

_Case = TypeVar("_Case")
_Result = TypeVar("_Result")

KINDS: Final[tuple[_Kind, ...]]
METHODS: Final[tuple[_MethodName, ...]]
EERUF_METHODS: Final[tuple[_MethodName, ...]]
CAUSES: Final[tuple[_Cause, ...]]
EXAMPLES: Final[tuple[str, ...]]
__version__: Final[str]

class EerufError(ValueError):
    """Something eeruf cannot do with what it was given; a ``ValueError``, and the base of all others.

    Example:
        >>> import eeruf
        >>> try:
        ...     eeruf.design(sensors=65, t_delta_us=999, min_interval_us=15_000, window_us=36_000)
        ... except eeruf.EerufError as error:
        ...     print(error)
        sensors = 65; expected a whole number from 1 to 64
    """

class EerufWarning(UserWarning):
    """Input that is legal and implausible, such as milliseconds for microseconds; a ``UserWarning``.

    Example:
        >>> import eeruf, warnings
        >>> with warnings.catch_warnings():
        ...     warnings.simplefilter("error", eeruf.EerufWarning)
        ...     eeruf.Ring(eeruf.tables.TABLE_I_D, t_delta_us=500, window_us=36)
        Traceback (most recent call last):
        eeruf.EerufWarning: window_us = 36; expected 1000 to 1000000; likely milliseconds: times are microseconds
    """

class ArgumentError(EerufError):
    """An argument of the wrong type, shape or range, which it names.

    Example:
        >>> import eeruf
        >>> eeruf.EchoFilter(sensors=0, t_delta_us=500)
        Traceback (most recent call last):
        eeruf.ArgumentError: sensors = 0; expected a whole number from 1 to 64
    """

class CertificateError(EerufError):
    """A certificate that proves nothing, or not that a period is the shortest; the message says why.

    Example:
        >>> import eeruf
        >>> eeruf.check_certificate("")
        Traceback (most recent call last):
        eeruf.CertificateError: line 1: found "", expected a line eeruf-certificate
    """

class ScheduleError(EerufError):
    """Numbers that make no schedule.

    Example:
        >>> import eeruf
        >>> eeruf.Schedule.from_firing(40_000, [0, 50_000], [0, 2_000])
        Traceback (most recent call last):
        eeruf.ScheduleError: sensor 1 fires 50 ms into phase a; expected less than the period of 40 ms
    """

class FilterError(EerufError):
    """A filter that cannot compare as asked.

    Example:
        >>> import eeruf
        >>> eeruf.EchoFilter(4, 500, consecutive=9)
        Traceback (most recent call last):
        eeruf.FilterError: 9 consecutive readings; expected 2 to 8
    """

class RingError(EerufError):
    """A ring that cannot listen as asked.

    Example:
        >>> import eeruf
        >>> eeruf.Ring(eeruf.tables.TABLE_I_D, 500, window_us=0)
        Traceback (most recent call last):
        eeruf.RingError: a blanking time of 0 us; expected less than the window of 0 us, and at most 65.535 ms
    """

class HoppingError(EerufError):
    """A ring that cannot hop as asked, or settings that contradict each other.

    Example:
        >>> import eeruf
        >>> eeruf.HoppingSchedule(8, 2_000, 240)
        Traceback (most recent call last):
        eeruf.HoppingError: a period of 2 ms; expected 2.161 ms to 268435.456 ms
    """

class LogError(EerufError):
    """A log that cannot be read, with its file, its line, and what is expected.

    Example:
        >>> import eeruf
        >>> eeruf.logs.read_log("no.bag")
        Traceback (most recent call last):
        eeruf.LogError: no.bag: No such file or directory (os error 2); expected a file that exists
    """

class SearchError(EerufError):
    """Needs that make no sense or are too large to search.

    Example:
        >>> import eeruf
        >>> eeruf.WaitSearch(4, 40_000, 8_000, tick_us=3_000, t_delta_us=999)
        Traceback (most recent call last):
        eeruf.SearchError: a lag of 10 ms; expected a whole number of ticks of 3 ms
    """

class SceneError(EerufError):
    """Walls, poles, robots or noise that make no scene.

    Example:
        >>> import eeruf
        >>> eeruf.sim.Scene([[0, 0, 0, 0]])
        Traceback (most recent call last):
        eeruf.SceneError: wall 0 is 0 m long; expected at least 0.000001 m
    """

class PathsError(EerufError):
    """Paths that cannot be found.

    Example:
        >>> import eeruf
        >>> eeruf.sim.Scene([[5, 2, -5, 2]]).paths((0, 0), (1, 0), max_order=1001)
        Traceback (most recent call last):
        eeruf.PathsError: paths up to order 1001; expected at most 1000
    """

class SimulationError(EerufError):
    """A simulation that cannot be run.

    Example:
        >>> import eeruf
        >>> robot = eeruf.sim.Robot((0, 0, 0), sensors=8, spacing_rad=0.26, radius_m=0.3, window_us=90_000)
        >>> scene = eeruf.sim.Scene([[5, 2, -5, 2]], robots=[robot])
        >>> eeruf.sim.simulate(scene)
        Traceback (most recent call last):
        eeruf.SimulationError: robot 0, method eeruf: a listening window of 90 ms; a sensor of this schedule fires again after 45.6 ms, expected a window no longer than that (T_wind)
    """

class ExperimentError(EerufError):
    """An experiment that cannot be run.

    Example:
        >>> import eeruf
        >>> eeruf.experiments.set_one(seeds=1, methods=[])
        Traceback (most recent call last):
        eeruf.ExperimentError: no methods; expected at least one
    """

@final
class Schedule:
    """When each sensor of a ring fires, in the two phases that alternate from period to period. Immutable; equal if all
    times are.

    Sensor ``x`` fires ``t_lag_us[x] + t_wait_a_us[x]`` after the beginning of an even period (phase a) and
    ``t_lag_us[x] + t_wait_b_us[x]`` after that of an odd one (phase b). Times are whole microseconds below 2^32;
    sensors count from 0, and are printed from 1. Schedules compare, hash and pickle, and their ``repr`` can be pasted
    back.

    Args:
        period_us: the period, ``T_p``.
        t_lag_us: ``T_lag`` of each sensor, 1 to 64 of them.
        t_wait_a_us: ``T_wait`` of each sensor in phase a.
        t_wait_b_us: ``T_wait`` of each sensor in phase b.

    Raises:
        ArgumentError: a time is not a whole number of microseconds, or negative.
        ScheduleError: the lengths differ, there are no or more than 64 sensors, or one would fire after its period's
            end.

    Example:
        >>> import eeruf
        >>> two = eeruf.Schedule(40_000, t_lag_us=[0, 20_000], t_wait_a_us=[0, 0], t_wait_b_us=[2_000, 5_000])
        >>> two.t_fire_b_us
        (2000, 25000)
    """
    def __new__(
        cls,
        period_us: _Int,
        t_lag_us: Iterable[_Int],
        t_wait_a_us: Iterable[_Int],
        t_wait_b_us: Iterable[_Int],
    ) -> Schedule: ...
    @staticmethod
    def from_firing(period_us: _Int, t_fire_a_us: Iterable[_Int], t_fire_b_us: Iterable[_Int]) -> Schedule:
        """Make a schedule of firing times instead of lags and waits.

        Args:
            period_us: the period, ``T_p``.
            t_fire_a_us: when each sensor fires in phase a, 1 to 64 times; below the period.
            t_fire_b_us: when each sensor fires in phase b, as many.

        Raises:
            ArgumentError: a time is not a whole number of microseconds, or negative.
            ScheduleError: as for ``Schedule``.

        Example:
            >>> from eeruf import Schedule
            >>> Schedule.from_firing(40_000, [0, 20_000], [2_000, 25_000]).sensors
            2
        """
    @staticmethod
    def congruence(
        sensors: _Int,
        period_us: _Int,
        step_us: _Int,
        phases: _Int = 5,
        t_lag_us: Iterable[_Int] | None = None,
    ) -> HoppingSchedule:
        """A schedule of many phases by a linear congruence: sensor ``x`` fires ``step_us * ((x + 1) * m % phases)`` after
        its lag in phase ``m``. For robots that stand: a robot that drives takes a :class:`HoppingSchedule`.

        Args:
            sensors: how many, 1 to 64.
            period_us: the period, ``T_p``.
            step_us: the least shift of crosstalk, 1 to 65535.
            phases: at least this many, 2 to 67; by default the 5 that confirm an echo.
            t_lag_us: the lag of each sensor; by default they are spread evenly over the period.

        Raises:
            ArgumentError: something of the wrong type or out of range.
            HoppingError: numbers that make no such schedule.

        Example:
            >>> from eeruf import Schedule
            >>> Schedule.congruence(sensors=8, period_us=60_000, step_us=240).t_fire_us[1, :3].tolist()
            [240, 7680, 15120]
        """
    @staticmethod
    def from_toml(text: str) -> Schedule:
        r"""Read a schedule as ``eeruf design --emit toml`` and :meth:`to_toml` write it.

        Args:
            text: the contents of a file: ``period_us``, and ``t_lag_us``, ``t_wait_a_us``, ``t_wait_b_us`` or
                ``t_fire_a_us``, ``t_fire_b_us``.

        Raises:
            ArgumentError: not a text.
            ScheduleError: the text is no TOML, a key is missing, or the numbers make no schedule.

        Example:
            >>> from eeruf import Schedule
            >>> Schedule.from_toml("period_us = 40000\nt_fire_a_us = [0]\nt_fire_b_us = [2000]").period_us
            40000
        """
    @staticmethod
    def read_toml(path: str | PathLike[str]) -> Schedule:
        """Read a schedule file, such as those in the folder ``rings``.

        Args:
            path: of the file.

        Raises:
            ArgumentError: not a path.
            ScheduleError: no such file, a file of another kind, or as for :meth:`from_toml`.

        Example:
            >>> import eeruf, pathlib, tempfile
            >>> file = pathlib.Path(tempfile.mkdtemp(), "ring.toml")
            >>> _ = file.write_text(eeruf.tables.TABLE_I_D.to_toml())
            >>> eeruf.Schedule.read_toml(file) == eeruf.tables.TABLE_I_D
            True
        """
    @staticmethod
    def from_json(text: str) -> Schedule:
        """Read a schedule as :meth:`to_json` writes it, with the keys of :meth:`from_toml`.

        Args:
            text: one JSON object.

        Raises:
            ArgumentError: not a text.
            ScheduleError: the text is no JSON, a key is missing, or the numbers make no schedule.

        Example:
            >>> from eeruf import Schedule
            >>> Schedule.from_json('{"period_us": 40000, "t_fire_a_us": [0], "t_fire_b_us": [2000]}').sensors
            1
        """
    @property
    def period_us(self) -> int:
        """The period ``T_p``, in microseconds."""
    @property
    def sensors(self) -> int:
        """Number of sensors that fire."""
    @property
    def t_lag_us(self) -> tuple[int, ...]:
        """``T_lag`` of each sensor, in microseconds; zeros if the schedule was made of firing times."""
    @property
    def t_wait_a_us(self) -> tuple[int, ...]:
        """``T_wait`` of each sensor in phase a, in microseconds."""
    @property
    def t_wait_b_us(self) -> tuple[int, ...]:
        """``T_wait`` of each sensor in phase b, in microseconds."""
    @property
    def t_fire_a_us(self) -> tuple[int, ...]:
        """When each sensor fires in phase a, in microseconds from the beginning of the period."""
    @property
    def t_fire_b_us(self) -> tuple[int, ...]:
        """When each sensor fires in phase b, in microseconds from the beginning of the period."""
    def scaled(self, num: _Int, den: _Int) -> Schedule:
        """Multiply all times by ``num / den`` (Sec. 3.1, proportional scaling), rounded to whole microseconds.

        Args:
            num: the numerator, 1 to 2^32 - 1.
            den: the denominator, 1 to 2^32 - 1.

        Returns:
            The schedule; verify it again, since ``T_delta`` and the intervals scale as well.

        Raises:
            ArgumentError: not whole numbers.
            ScheduleError: one is zero, or the times become too long.

        Example:
            >>> from eeruf.tables import TABLE_I_D
            >>> TABLE_I_D.scaled(3, 5).period_us
            60000
        """
    def verify(
        self,
        t_delta_us: _Each,
        min_interval_us: _Int = 0,
        neighbours: _Int = 4,
        layout: _Layout = "line",
        criterion: _Criterion = "exact",
        window_us: _Each = 0,
        stale_echo: bool = False,
        refire_us: _Each | None = None,
        intervals_us: Iterable[tuple[_Int, _Int, _Int]] | None = None,
        shared_lines: Iterable[Sequence[_Int]] | None = None,
        together: Iterable[Sequence[_Int]] | None = None,
    ) -> Report:
        """Check every condition of the paper, sensor by sensor.

        Args:
            t_delta_us: ``T_delta``: consecutive readings that differ by no more are near-identical (Eq. 11). One for
                all sensors or a sequence of one for each; two sensors need the separation of the larger.
            min_interval_us: the least time between the firings of two neighbours (Sec. 3.1 c).
            neighbours: how many sensors in a row count as neighbours, 1 to 64.
            layout: how they stand: ``"line"``, ``"ring"`` (the last beside the first), ``"blocks"`` of ``neighbours``,
                or pairs of neighbours, such as ``[(0, 1), (1, 2)]``.
            criterion: how to read Eqs. (13a), (13b): ``"exact"``, or as the ``"paper"`` prints them.
            window_us: ``T_wind``, for which a sensor listens: it must not fire again earlier. One for all, or a
                sequence.
            stale_echo: whether a sensor's own echo from the period before must be rejected too.
            refire_us: how soon a sensor may be triggered again, where that is later. One for all, or a sequence.
            intervals_us: pairs of sensors with the least time between their firings, whatever the layout says:
                ``[(0, 4, 9000)]``; 0 for none.
            shared_lines: groups of sensors on one echo line, ``[(0, 3), (1, 4)]``: none fires while another listens.
            together: groups of sensors that must fire at the same instants. No separation is asked between them.

        Returns:
            The report, which is true if all conditions hold.

        Raises:
            ArgumentError: something of the wrong type or out of range.

        Example:
            >>> from eeruf.tables import TABLE_I_D
            >>> report = TABLE_I_D.verify(t_delta_us=999, min_interval_us=15_000)
            >>> report.ok, report.min_interval_us, report.max_t_delta_us
            (True, 17000, 999)
        """
    def to_toml(self) -> str:
        """Write a schedule file, as the program reads it.

        Example:
            >>> from eeruf import Schedule, tables
            >>> Schedule.from_toml(tables.TABLE_I_D.to_toml()) == tables.TABLE_I_D
            True
        """
    def to_json(self) -> str:
        """Write one JSON object with the keys of the schedule file.

        Example:
            >>> import json
            >>> from eeruf.tables import TABLE_I_D
            >>> json.loads(TABLE_I_D.to_json())["period_us"]
            100000
        """
    def to_rust(
        self,
        t_delta_us: _Int | None = None,
        min_interval_us: _Int = 0,
        neighbours: _Int = 4,
        layout: _Layout = "line",
        criterion: _Criterion = "exact",
        window_us: _Int = 0,
        stale_echo: bool = False,
    ) -> str:
        """Write a Rust constant for firmware, which is checked when it is compiled.

        Args:
            t_delta_us: what the constant is checked for; by default the most that the schedule allows.
            min_interval_us: as in :meth:`verify`, and so all others.
            neighbours: as in :meth:`verify`.
            layout: as in :meth:`verify`.
            criterion: as in :meth:`verify`.
            window_us: as in :meth:`verify`.
            stale_echo: as in :meth:`verify`.

        Raises:
            ArgumentError: something of the wrong type or out of range.

        Example:
            >>> from eeruf.tables import TABLE_I_D
            >>> "schedule!" in TABLE_I_D.to_rust(min_interval_us=15_000)
            True
        """
    def to_c(
        self,
        t_delta_us: _Int | None = None,
        min_interval_us: _Int = 0,
        neighbours: _Int = 4,
        layout: _Layout = "line",
        criterion: _Criterion = "exact",
        window_us: _Int = 0,
        stale_echo: bool = False,
    ) -> str:
        """Write a C99 header with the firing times and what they were verified for.

        Args:
            t_delta_us: what the header says it was verified for; by default the most that the schedule allows.
            min_interval_us: as in :meth:`verify`, and so all others.
            neighbours: as in :meth:`verify`.
            layout: as in :meth:`verify`.
            criterion: as in :meth:`verify`.
            window_us: as in :meth:`verify`.
            stale_echo: as in :meth:`verify`.

        Raises:
            ArgumentError: something of the wrong type or out of range.

        Example:
            >>> from eeruf.tables import TABLE_I_D
            >>> "#include <stdint.h>" in TABLE_I_D.to_c(min_interval_us=15_000)
            True
        """
    def to_dict(self) -> dict[str, object]:
        """Its times by their names, as the arguments of ``Schedule``: a dict of plain values.

        Example:
            >>> from eeruf import Schedule, tables
            >>> Schedule(**tables.TABLE_I_D.to_dict()) == tables.TABLE_I_D
            True
        """
    def __eq__(self, other: object, /) -> bool: ...
    def __ne__(self, other: object, /) -> bool: ...
    def __hash__(self, /) -> int: ...

@final
class Violation:
    """One condition that a schedule does not meet.

    Example:
        >>> from eeruf.tables import TABLE_I_B
        >>> violation = TABLE_I_B.verify(t_delta_us=999, min_interval_us=15_000).violations[0]
        >>> violation.kind, violation.value_us < violation.required_us, violation.source
        ('interval', True, 'Sec. 3.1 c')
    """
    def __new__(
        cls,
        kind: _Condition,
        sensors: tuple[int, int],
        phases: tuple[_Phase, _Phase],
        value_us: _Int,
        required_us: _Int,
        source: str,
    ) -> Violation: ...
    @property
    def kind(self) -> _Condition:
        """The condition: ``"crosstalk_a"``, ``"crosstalk_b"``, ``"stale_echo"``, ``"interval"``, ``"window"``; where
        sensors are not all alike also ``"shared_line"``, ``"refire"`` or ``"together"``.
        """
    @property
    def sensors(self) -> tuple[int, int]:
        """The two sensors, from 0; the same one twice where a condition is about one alone."""
    @property
    def phases(self) -> tuple[_Phase, _Phase]:
        """The phases in which they fire, each ``"a"`` or ``"b"``."""
    @property
    def value_us(self) -> int:
        """Value of the schedule, in microseconds."""
    @property
    def required_us(self) -> int:
        """Value that the condition asks for, in microseconds."""
    @property
    def source(self) -> str:
        """Where the condition comes from, such as ``"Eq. (13a)"``."""
    def to_dict(self) -> dict[str, object]:
        """Its fields by their names: a dict of plain values.

        Example:
            >>> import eeruf
            >>> eeruf.Violation("window", (0, 0), ("a", "b"), 20_000, 36_000, "Sec. 3.1").to_dict()["sensors"]
            [0, 0]
        """
    def __eq__(self, other: object, /) -> bool: ...
    def __ne__(self, other: object, /) -> bool: ...
    def __hash__(self, /) -> int: ...

@final
class Report:
    """Findings of ``Schedule.verify``. It is true if all conditions hold.

    Example:
        >>> from eeruf.tables import TABLE_I_D
        >>> bool(TABLE_I_D.verify(t_delta_us=999)), bool(TABLE_I_D.verify(t_delta_us=1_000))
        (True, False)
    """
    def __new__(
        cls,
        separation_us: _Int | None,
        max_t_delta_us: _Int | None,
        min_interval_us: _Int | None,
        min_refire_us: _Int,
        violations: Sequence[Violation],
    ) -> Report: ...
    @property
    def ok(self) -> bool:
        """Returns true if every condition holds."""
    @property
    def separation_us(self) -> int | None:
        """The smaller left side of (13a), (13b) of the pair that is closest to failing, in microseconds; None for a single
        sensor.
        """
    @property
    def max_t_delta_us(self) -> int | None:
        """The largest ``T_delta`` at which (13a), (13b) (and the stale echo condition, if asked for) hold, in
        microseconds; None if none does.
        """
    @property
    def min_interval_us(self) -> int | None:
        """The smallest time between the firings of two neighbours, in microseconds; None without neighbours."""
    @property
    def min_refire_us(self) -> int:
        """The shortest time between two firings of one sensor, in microseconds."""
    @property
    def violations(self) -> tuple[Violation, ...]:
        """Every violation, as a tuple of ``Violation``: first (13a), then (13b), stale echoes, intervals and windows."""
    def to_dict(self) -> dict[str, object]:
        """Its fields by their names, violations as dicts too: a dict of plain values.

        Example:
            >>> from eeruf.tables import TABLE_I_D
            >>> report = TABLE_I_D.verify(t_delta_us=999, min_interval_us=15_000).to_dict()
            >>> report["ok"], report["min_interval_us"]
            (True, 17000)
        """
    def __bool__(self, /) -> bool: ...
    def __eq__(self, other: object, /) -> bool: ...
    def __ne__(self, other: object, /) -> bool: ...
    def __hash__(self, /) -> int: ...

@final
class Found:
    """The answer of a search: the best schedule it came to, and whether that is proven.

    Example:
        >>> import eeruf
        >>> found = eeruf.design(sensors=4, t_delta_us=999, min_interval_us=15_000, window_us=36_000)
        >>> found.value_us, found.bound_us, found.proven
        (62000, 62000, True)
    """
    def __new__(
        cls,
        schedule: Schedule | None,
        value_us: _Int | None,
        bound_us: _Int | None,
        proven: bool,
        nodes: _Int,
        seconds: float,
        reason: str | None = None,
        certificate: str | None = None,
        real_period_us: tuple[int, int] | None = None,
        real_proven: bool | None = None,
        from_atlas: bool = False,
        spare_us: tuple[int, int, int] | None = None,
        spare_proven: tuple[bool, bool, bool] | None = None,
    ) -> Found: ...
    @property
    def schedule(self) -> Schedule | None:
        """The schedule; None if there is none, or none was found within the budget."""
    @property
    def value_us(self) -> int | None:
        """The optimised value, in microseconds: the period, the smallest interval or ``T_delta``; None without a schedule."""
    @property
    def bound_us(self) -> int | None:
        """No schedule is better than this, in microseconds; None if it is proven that there is none at all."""
    @property
    def proven(self) -> bool:
        """True if no better schedule exists (or none at all, without a schedule)."""
    @property
    def nodes(self) -> int:
        """Number of nodes that the search visited: the same on each machine."""
    @property
    def seconds(self) -> float:
        """Duration of the search, in seconds."""
    @property
    def reason(self) -> str | None:
        """Why the period is not shorter, in words; None from ``WaitSearch.best``."""
    @property
    def certificate(self) -> str | None:
        """A proof for :func:`check_certificate`; None unless ``design`` was asked for one."""
    @property
    def real_period_us(self) -> tuple[int, int] | None:
        """The shortest period over the reals in microseconds, as numerator and denominator in lowest terms; None unless
        ``design`` was asked for it.
        """
    @property
    def real_proven(self) -> bool | None:
        """True if no real period is shorter; None without one."""
    @property
    def from_atlas(self) -> bool:
        """True if the atlas of proven rings answered, and nothing was searched."""
    @property
    def spare_us(self) -> tuple[int, int, int] | None:
        """Slack of the schedule beyond every ``t_delta``, then every interval and turn on a shared line, then every
        refire time, in microseconds; None unless the period is proven.
        """
    @property
    def spare_proven(self) -> tuple[bool, bool, bool] | None:
        """True if no schedule of this period has more, of each; None without them."""
    def to_dict(self) -> dict[str, object]:
        """Its fields by their names, the schedule as its times: a dict of plain values.

        Example:
            >>> import eeruf
            >>> found = eeruf.design(sensors=4, t_delta_us=999, min_interval_us=15_000, window_us=36_000).to_dict()
            >>> found["value_us"], found["schedule"]["period_us"]
            (62000, 62000)
        """
    def __eq__(self, other: object, /) -> bool: ...
    def __ne__(self, other: object, /) -> bool: ...

@final
class HoppingFound:
    """The answer of ``design`` with ``phases``: a schedule for a hopping ring, and how much shorter one could be.

    Example:
        >>> import eeruf
        >>> found = eeruf.design(8, t_delta_us=150, min_interval_us=0, window_us=36_000, phases=5)
        >>> found.schedule.phases, found.value_us, found.proven
        (11, 38107, True)
        >>> ring = eeruf.Ring.hopping(found.schedule, window_us=36_000)
    """
    def __new__(
        cls,
        schedule: HoppingSchedule,
        value_us: _Int,
        bound_us: _Int,
        proven: bool,
        reason: str,
        width_us: _Int,
        width_bound_us: _Int,
    ) -> HoppingFound: ...
    @property
    def schedule(self) -> HoppingSchedule:
        """The schedule: a linear congruence with lags, or Welch's sequence where stale echoes must be rejected."""
    @property
    def value_us(self) -> int:
        """Its period, in microseconds."""
    @property
    def bound_us(self) -> int:
        """No schedule of this many phases or more that separates sound of every age has a shorter period, in microseconds."""
    @property
    def proven(self) -> bool:
        """True if no such schedule is shorter."""
    @property
    def reason(self) -> str:
        """Reason of the bound, in words."""
    @property
    def width_us(self) -> int:
        """The longest wait of the code, in microseconds."""
    @property
    def width_bound_us(self) -> int:
        """No code that separates sound of every age is narrower than this, in microseconds."""
    def to_dict(self) -> dict[str, object]:
        """Its fields by their names, as ``eeruf design --phases M --json`` prints them: a dict of plain values.

        Example:
            >>> import eeruf
            >>> found = eeruf.design(8, t_delta_us=150, min_interval_us=0, window_us=36_000, phases=5).to_dict()
            >>> found["value_us"], found["schedule"]["step_us"]
            (38107, 301)
        """
    def __eq__(self, other: object, /) -> bool: ...
    def __ne__(self, other: object, /) -> bool: ...

@overload
def design(
    sensors: _Int,
    t_delta_us: _Each,
    min_interval_us: _Int,
    window_us: _Each,
    tick_us: _Int = 1000,
    neighbours: _Int = 4,
    layout: _Layout = "line",
    stale_echo: bool = False,
    budget: _Int | None = None,
    progress: _Progress = None,
    certificate: bool = False,
    time_limit_s: float | None = None,
    refire_us: _Each | None = None,
    intervals_us: Iterable[tuple[_Int, _Int, _Int]] | None = None,
    shared_lines: Iterable[Sequence[_Int]] | None = None,
    together: Iterable[Sequence[_Int]] | None = None,
    over_reals: bool = False,
    phases: None = None,
    margin_us: None = None,
    atlas: bool = True,
) -> Found:
    """Find the schedule with the shortest period for a ring, and prove that none is shorter.

    Firing times are free, on a grid of ticks. Among all schedules of the shortest period it prefers a larger
    ``T_delta``, then a larger smallest interval, then evener firing. It runs on one core, without the interpreter lock;
    Ctrl-C ends it.

    Args:
        sensors: how many, 1 to 64.
        t_delta_us: ``T_delta``: consecutive readings that differ by no more are near-identical (Eq. 11). One for all
            sensors or a sequence of one for each; two sensors need the separation of the larger.
        min_interval_us: the least time between the firings of two neighbours (Sec. 3.1 c).
        window_us: ``T_wind``, for which a sensor listens: it must not fire again earlier. 1 or more; one for all, or a
            sequence.
        tick_us: the grid of firing times and period, 1 or more.
        neighbours: how many sensors in a row count as neighbours, 1 to 64.
        layout: ``"line"``, ``"ring"``, ``"blocks"`` or pairs of neighbours, as in :meth:`Schedule.verify`.
        stale_echo: whether a sensor's own echo from the period before must be rejected too.
        budget: how many nodes to visit at most, 1 or more; 50 million by default.
        progress: True for a bar (tqdm if it is installed), or a callable that takes the share done (None: unknown) and
            a text.
        certificate: whether to prove the answer to :func:`check_certificate`, in ``Found.certificate``: that no period
            is shorter, or none below ``bound_us``, or below a lower bound that a million nodes suffice for.
        time_limit_s: how long the call may take before it gives the best schedule so far, above 0; the certificate has
            what time is left. No limit by default.
        refire_us: how soon a sensor may be triggered again, where that is later than its window. One for all, or a
            sequence.
        intervals_us: pairs of sensors with the least time between their firings, whatever the layout says:
            ``[(0, 4, 9000)]``; 0 for none.
        shared_lines: groups of sensors on one echo line, ``[(0, 3), (1, 4)]``: none fires while another listens.
        together: groups of sensors that fire at the same instants, declared not to hear each other.
        over_reals: whether to say what the tick costs: in ``Found.real_period_us`` the shortest period in
            ticks of any length, for the needs in exact microseconds, and in ``Found.real_proven`` whether
            none is shorter. Only where the period in ticks is proven.
        phases: at least this many, 2 to 67: a schedule for a :meth:`Ring.hopping`, as ``eeruf design --phases`` finds
            it. Then times are whole microseconds, of lists the largest counts, and nothing below ``stale_echo`` may be
            given but ``margin_us``.
        margin_us: with ``phases``: crosstalk need move by ``T_delta`` and this margin alone, which is all that jitter
            and lateness may use, instead of ``2 T_delta + 1``.
        atlas: whether the atlas of rings whose shortest period is known may answer, as that of the program does;
            ``Found.from_atlas`` says whether it did, and ``nodes`` is 0 then.

    Returns:
        A :class:`Found`: the shortest period in ``value_us``, or the best found within budget and time; ``proven`` says
        which. With ``phases`` a :class:`HoppingFound`.

    Raises:
        ArgumentError: something of the wrong type or out of range.
        SearchError: needs that make no sense, or too large a grid.
        HoppingError: no schedule of this many phases.

    Example:
        >>> import eeruf
        >>> found = eeruf.design(sensors=8, t_delta_us=999, min_interval_us=15_000, window_us=36_000)
        >>> found.value_us, found.proven
        (66000, True)
        >>> found = eeruf.design(12, 999, 15_000, 45_000, over_reals=True)
        >>> found.value_us, found.real_period_us, found.real_proven
        (70000, (69499, 1), True)
        >>> windows = [36_000, 36_000, 12_000, 12_000]
        >>> found = eeruf.design(4, [999, 999, 1500, 1500], 15_000, windows, shared_lines=[(0, 2)])
        >>> found.value_us, found.proven
        (59000, True)
        >>> eeruf.design(8, t_delta_us=150, min_interval_us=0, window_us=36_000, phases=5, margin_us=90).value_us
        37680
    """

@overload
def design(
    sensors: _Int,
    t_delta_us: _Each,
    min_interval_us: _Int,
    window_us: _Each,
    *,
    neighbours: _Int = 4,
    layout: _Layout = "line",
    stale_echo: bool = False,
    phases: _Int,
    margin_us: _Int | None = None,
) -> HoppingFound:
    """Find the schedule with the shortest period for a ring, and prove that none is shorter.

    Firing times are free, on a grid of ticks. Among all schedules of the shortest period it prefers a larger
    ``T_delta``, then a larger smallest interval, then evener firing. It runs on one core, without the interpreter lock;
    Ctrl-C ends it.

    Args:
        sensors: how many, 1 to 64.
        t_delta_us: ``T_delta``: consecutive readings that differ by no more are near-identical (Eq. 11). One for all
            sensors or a sequence of one for each; two sensors need the separation of the larger.
        min_interval_us: the least time between the firings of two neighbours (Sec. 3.1 c).
        window_us: ``T_wind``, for which a sensor listens: it must not fire again earlier. 1 or more; one for all, or a
            sequence.
        tick_us: the grid of firing times and period, 1 or more.
        neighbours: how many sensors in a row count as neighbours, 1 to 64.
        layout: ``"line"``, ``"ring"``, ``"blocks"`` or pairs of neighbours, as in :meth:`Schedule.verify`.
        stale_echo: whether a sensor's own echo from the period before must be rejected too.
        budget: how many nodes to visit at most, 1 or more; 50 million by default.
        progress: True for a bar (tqdm if it is installed), or a callable that takes the share done (None: unknown) and
            a text.
        certificate: whether to prove the answer to :func:`check_certificate`, in ``Found.certificate``: that no period
            is shorter, or none below ``bound_us``, or below a lower bound that a million nodes suffice for.
        time_limit_s: how long the call may take before it gives the best schedule so far, above 0; the certificate has
            what time is left. No limit by default.
        refire_us: how soon a sensor may be triggered again, where that is later than its window. One for all, or a
            sequence.
        intervals_us: pairs of sensors with the least time between their firings, whatever the layout says:
            ``[(0, 4, 9000)]``; 0 for none.
        shared_lines: groups of sensors on one echo line, ``[(0, 3), (1, 4)]``: none fires while another listens.
        together: groups of sensors that fire at the same instants, declared not to hear each other.
        over_reals: whether to say what the tick costs: in ``Found.real_period_us`` the shortest period in
            ticks of any length, for the needs in exact microseconds, and in ``Found.real_proven`` whether
            none is shorter. Only where the period in ticks is proven.
        phases: at least this many, 2 to 67: a schedule for a :meth:`Ring.hopping`, as ``eeruf design --phases`` finds
            it. Then times are whole microseconds, of lists the largest counts, and nothing below ``stale_echo`` may be
            given but ``margin_us``.
        margin_us: with ``phases``: crosstalk need move by ``T_delta`` and this margin alone, which is all that jitter
            and lateness may use, instead of ``2 T_delta + 1``.
        atlas: whether the atlas of rings whose shortest period is known may answer, as that of the program does;
            ``Found.from_atlas`` says whether it did, and ``nodes`` is 0 then.

    Returns:
        A :class:`Found`: the shortest period in ``value_us``, or the best found within budget and time; ``proven`` says
        which. With ``phases`` a :class:`HoppingFound`.

    Raises:
        ArgumentError: something of the wrong type or out of range.
        SearchError: needs that make no sense, or too large a grid.
        HoppingError: no schedule of this many phases.

    Example:
        >>> import eeruf
        >>> found = eeruf.design(sensors=8, t_delta_us=999, min_interval_us=15_000, window_us=36_000)
        >>> found.value_us, found.proven
        (66000, True)
        >>> found = eeruf.design(12, 999, 15_000, 45_000, over_reals=True)
        >>> found.value_us, found.real_period_us, found.real_proven
        (70000, (69499, 1), True)
        >>> windows = [36_000, 36_000, 12_000, 12_000]
        >>> found = eeruf.design(4, [999, 999, 1500, 1500], 15_000, windows, shared_lines=[(0, 2)])
        >>> found.value_us, found.proven
        (59000, True)
        >>> eeruf.design(8, t_delta_us=150, min_interval_us=0, window_us=36_000, phases=5, margin_us=90).value_us
        37680
    """

def fit(
    period_us: _Int,
    sensors: _Int,
    t_delta_us: _Each,
    min_interval_us: _Int,
    window_us: _Each,
    tick_us: _Int = 1000,
    neighbours: _Int = 4,
    layout: _Layout = "line",
    stale_echo: bool = False,
    budget: _Int | None = None,
    refire_us: _Each | None = None,
    intervals_us: Iterable[tuple[_Int, _Int, _Int]] | None = None,
    shared_lines: Iterable[Sequence[_Int]] | None = None,
    together: Iterable[Sequence[_Int]] | None = None,
) -> tuple[bool | None, Found]:
    """Find what fits into a period: whether the needs do, and the largest ``T_delta``. Ctrl-C ends it.

    Args:
        period_us: the period, in whole ticks.
        sensors: how many, 1 to 64.
        t_delta_us: as in :func:`design`, as are the arguments below but ``budget``.
        min_interval_us: the least time between the firings of two neighbours.
        window_us: how long a sensor listens; one for all, or a sequence.
        tick_us: the grid of firing times and period, 1 or more.
        neighbours: how many sensors in a row count as neighbours, 1 to 64.
        layout: ``"line"``, ``"ring"``, ``"blocks"`` or pairs of neighbours.
        stale_echo: whether a sensor's own echo from the period before must be rejected too.
        budget: how many nodes to visit at most, 1 or more; 50 million by default.
        refire_us: how soon a sensor may be triggered again, where that is later than its window.
        intervals_us: pairs of sensors with the least time between their firings.
        shared_lines: groups of sensors on one echo line.
        together: groups of sensors that fire at the same instants.

    Returns:
        Whether a schedule of this period meets all needs, None if that was not decided; and a :class:`Found` with the
        largest ``T_delta`` of this period in ``value_us``: of the sensor with the largest, where sensors have their own
        and each grows by the same. Its schedule is one that meets the needs, or else the one with that ``T_delta``.

    Raises:
        ArgumentError: something of the wrong type or out of range.
        SearchError: needs that make no sense, or a period that is no whole number of ticks.

    Example:
        >>> import eeruf
        >>> fits, found = eeruf.fit(100_000, 12, 999, 15_000, 30_000)
        >>> fits, found.value_us, found.proven
        (True, 2999, True)
    """

def curve(
    need: Literal["t_delta", "range", "interval"],
    sensors: _Int,
    t_delta_us: _Each,
    min_interval_us: _Int,
    window_us: _Each,
    tick_us: _Int = 1000,
    neighbours: _Int = 4,
    layout: _Layout = "line",
    stale_echo: bool = False,
    budget: _Int | None = None,
    refire_us: _Each | None = None,
    intervals_us: Iterable[tuple[_Int, _Int, _Int]] | None = None,
    shared_lines: Iterable[Sequence[_Int]] | None = None,
    together: Iterable[Sequence[_Int]] | None = None,
) -> list[tuple[int, int | None, int | None, bool]]:
    """Find the shortest period for 20 values of one need, from a tenth of the one given to twice as much. Ctrl-C ends it.

    Args:
        need: ``"t_delta"``, ``"range"`` (the window) or ``"interval"``.
        sensors: how many, 1 to 64.
        t_delta_us: as in :func:`design`, as are the arguments below but ``budget``. Where sensors or pairs have
            their own needs, all vary by the same factor.
        min_interval_us: the least time between the firings of two neighbours.
        window_us: how long a sensor listens; one for all, or a sequence.
        tick_us: the grid of firing times and period, 1 or more.
        neighbours: how many sensors in a row count as neighbours, 1 to 64.
        layout: ``"line"``, ``"ring"``, ``"blocks"`` or pairs of neighbours.
        stale_echo: whether a sensor's own echo from the period before must be rejected too.
        budget: how many nodes each point may cost, 1 or more; 20,000 by default.
        refire_us: how soon a sensor may be triggered again, where that is later than its window.
        intervals_us: pairs of sensors with the least time between their firings.
        shared_lines: groups of sensors on one echo line.
        together: groups of sensors that fire at the same instants.

    Returns:
        Tuples of the need's value, the shortest period found, the bound below which there is none, all in microseconds,
        and whether the period is proven the shortest.

    Raises:
        ArgumentError: something of the wrong type or out of range.
        SearchError: needs that make no sense, or too large a grid.

    Example:
        >>> import eeruf
        >>> curve = eeruf.curve("interval", 12, 999, 15_000, 30_000)
        >>> len(curve), curve[9]
        (20, (15000, 65000, 65000, True))
    """

def check_certificate(text: str) -> int:
    """Check a certificate: that its schedule keeps the requirements in it, and that no period is shorter.

    The checker shares nothing with the search; ``checker/check_period.py`` in the repository is another, in 300 lines
    of Python, and ``docs/reference/certificate.md`` has the format and the proof of each rule. A certificate speaks of
    the numbers that stand in it, and of nothing else.

    Args:
        text: the certificate, as in ``design(..., certificate=True).certificate``.

    Returns:
        The shortest period, in microseconds.

    Raises:
        ArgumentError: no text.
        CertificateError: the first line that is wrong; or the certificate proves a bound only, which it names.

    Example:
        >>> import eeruf
        >>> found = eeruf.design(4, 999, 15_000, 36_000, certificate=True)
        >>> eeruf.check_certificate(found.certificate)
        62000
        >>> eeruf.check_certificate(found.certificate.replace("period 62", "period 63"))
        Traceback (most recent call last):
        eeruf.CertificateError: no period below 62000 us; schedule of 63000 us (tick 1000 us)
    """

def example(name: str) -> str:
    """The text of an example file: a scene for :meth:`sim.Scene.from_toml`, or a ring for the command ``eeruf design``.

    ``eeruf examples DIR`` writes them all into a folder.

    Args:
        name: one of ``EXAMPLES``, as ``"scenes/alcove.toml"``.

    Raises:
        ArgumentError: there is no such example.

    Example:
        >>> import eeruf
        >>> eeruf.sim.Scene.from_toml(eeruf.example("scenes/alcove.toml"))
        <Scene: 3 walls, 0 poles, 1 robots>
    """

def _run_program(words: Sequence[str]) -> int: ...

@final
class WaitSearch:
    """The paper's question: lags are given, waits are sought on a grid so that crosstalk never repeats (Sec. 3.1).

    Args:
        sensors: how many, 1 to 64.
        period_us: ``T_p``, a whole number of ticks.
        wait_max_us: waits are 0, one tick, two ticks, up to this.
        tick_us: the grid, 1 or more.
        t_lag_us: ``T_lag`` of each sensor, in whole ticks; None spreads each group of ``neighbours`` over the period,
            as Table I-a.
        t_delta_us: ``T_delta``: consecutive readings that differ by no more are near-identical (Eq. 11).
        min_interval_us: the least time between the firings of two neighbours (Sec. 3.1 c).
        neighbours: how many adjacent sensors make a group, 1 to 64.
        layout: ``"line"``, ``"ring"``, ``"blocks"`` or pairs of neighbours, as in :meth:`Schedule.verify`.
        criterion: how to read Eqs. (13a), (13b): as the ``"paper"`` prints them, or ``"exact"``.

    Raises:
        ArgumentError: something of the wrong type or out of range.
        SearchError: needs that make no sense, or too large a grid.

    Example:
        >>> import eeruf
        >>> search = eeruf.WaitSearch(12, 100_000, 24_000, 1000, t_delta_us=999, min_interval_us=15_000)
        >>> search.best("interval").value_us
        19000
    """
    def __new__(
        cls,
        sensors: _Int,
        period_us: _Int,
        wait_max_us: _Int,
        tick_us: _Int,
        t_lag_us: Iterable[_Int] | None = None,
        *,
        t_delta_us: _Int,
        min_interval_us: _Int = 0,
        neighbours: _Int = 4,
        layout: _Layout = "line",
        criterion: _Criterion = "paper",
    ) -> WaitSearch: ...
    def first(self) -> Schedule | None:
        """One table of waits, the same each time, or None if there is none. Ctrl-C ends the search.

        Example:
            >>> import eeruf
            >>> table = eeruf.WaitSearch(2, 40_000, 4_000, 1000, t_delta_us=999).first()
            >>> table.t_wait_a_us, table.t_wait_b_us
            ((2000, 0), (0, 0))
        """
    def count(self, limit: _Int | None = None) -> int:
        """Number of tables, however many: counted without listing them where that is possible. Ctrl-C ends the search.

        Args:
            limit: where to stop counting, 1 or more; None counts all.

        Returns:
            The number of tables, or the limit if there are as many.

        Raises:
            ArgumentError: the limit is no such number.
            SearchError: more than can be counted.

        Example:
            >>> import eeruf
            >>> eeruf.WaitSearch(2, 40_000, 4_000, 1000, t_delta_us=999).count(limit=10)
            10
        """
    def all(self) -> WaitTables:
        """All tables in lexical order, as an iterator of ``Schedule``.

        Raises:
            SearchError: too large to search.

        Example:
            >>> import itertools, eeruf
            >>> search = eeruf.WaitSearch(2, 40_000, 4_000, 1000, t_delta_us=999)
            >>> [table.t_wait_b_us for table in itertools.islice(search.all(), 2)]
            [(0, 2000), (0, 3000)]
        """
    def best(self, objective: Literal["interval", "t_delta"] = "interval", budget: _Int | None = None) -> Found:
        """The best table: the one whose smallest interval between neighbours, or whose ``T_delta``, is largest. Ctrl-C
        ends the search.

        Args:
            objective: ``"interval"`` or ``"t_delta"``.
            budget: how many nodes to visit at most, 1 or more; unlimited by default.

        Returns:
            The table, with the interval or ``T_delta`` as ``value_us``.

        Raises:
            ArgumentError: no such objective or budget.
            SearchError: too large to search.

        Example:
            >>> import eeruf
            >>> found = eeruf.WaitSearch(4, 40_000, 8_000, 1000, t_delta_us=999).best("t_delta")
            >>> found.proven, found.schedule.verify(found.value_us).ok
            (True, True)
        """
    def pareto(self) -> list[tuple[Schedule, int, int | None]]:
        """The tables of which no other has a larger smallest interval without a smaller ``T_delta``, both at least what is
        asked for: from the largest interval to the largest ``T_delta``. Ctrl-C ends the search.

        Returns:
            Triples of table, smallest interval and ``T_delta``, in microseconds; ``T_delta`` is None if two readings of
            the table are alike.

        Raises:
            SearchError: too large to search.

        Example:
            >>> import eeruf
            >>> search = eeruf.WaitSearch(4, 40_000, 9_000, 1000, t_delta_us=99)
            >>> [(interval_us, t_delta_us) for _, interval_us, t_delta_us in search.pareto()]
            [(9000, 499), (8000, 999), (7000, 1499)]
        """

@final
class WaitTables(Iterator[Schedule]):
    """All tables of a ``WaitSearch``, one after the other: an iterator that Ctrl-C interrupts.

    Example:
        >>> import eeruf
        >>> tables = eeruf.WaitSearch(2, 40_000, 4_000, 1000, t_delta_us=999).all()
        >>> next(tables).sensors
        2
    """
    def __iter__(self, /) -> WaitTables: ...
    def __next__(self, /) -> Schedule: ...

@final
class EchoFilter:
    """Compares the consecutive readings of each sensor, and accepts those that are near-identical (Eq. 11).

    Args:
        sensors: how many, 1 to 64.
        t_delta_us: ``T_delta``: readings that differ by no more are near-identical.
        consecutive: how many readings in a row must agree, 2 to 8.
        echoes: how many echoes of one firing a sensor reports at most, 1 to 8; the earliest that repeats is accepted.

    Raises:
        ArgumentError: something of the wrong type or out of range.
        FilterError: fewer than 2 or more than 8 readings to compare.

    Example:
        >>> import eeruf
        >>> filter = eeruf.EchoFilter(sensors=1, t_delta_us=500)
        >>> [filter.push(0, us).kind for us in (9_000, 9_300, 12_000)]
        ['first', 'accepted', 'rejected']
    """
    def __new__(cls, sensors: _Int, t_delta_us: _Int, consecutive: _Int = 2, *, echoes: _Int = 1) -> EchoFilter: ...
    @property
    def sensors(self) -> int:
        """Number of sensors."""
    @property
    def t_delta_us(self) -> int:
        """``T_delta``, in microseconds."""
    @property
    def consecutive(self) -> int:
        """Number of readings in a row that must agree."""
    @property
    def echoes(self) -> int:
        """Number of echoes of one firing that count."""
    def push(self, sensor: _Int, t_echo_us: _Int | None, expected_change_us: _Int = 0) -> Reading:
        """Take in one firing of a sensor.

        Args:
            sensor: which one, from 0.
            t_echo_us: the time of its echo after firing in whole microseconds, or None for no echo.
            expected_change_us: expected change of a good reading from the one before, by the robot's own
                motion: ``-2 v dt / c`` for an object approached at ``v``.

        Returns:
            The reading, without phase and period, which a filter does not know.

        Raises:
            ArgumentError: no such sensor, or no such time.

        Example:
            >>> import eeruf
            >>> filter = eeruf.EchoFilter(1, 100)
            >>> [filter.push(0, us, expected_change_us=-400).kind for us in (9_000, 8_610)]
            ['first', 'accepted']
        """
    def push_echoes(self, sensor: _Int, t_echoes_us: Iterable[_Int], expected_change_us: _Int = 0) -> Reading:
        """Take in one firing of a sensor that reports several echoes.

        Args:
            sensor: which one, from 0.
            t_echoes_us: the times of its echoes after firing in whole microseconds, in any order; the earliest
                ``echoes`` count.
            expected_change_us: as for ``push``.

        Returns:
            The reading, without phase and period, which a filter does not know.

        Raises:
            ArgumentError: no such sensor, or no such times.

        Example:
            >>> import eeruf
            >>> filter = eeruf.EchoFilter(1, 100, echoes=8)
            >>> firings = [9_000, 14_000], [14_000, 9_000], [3_000, 9_000]
            >>> [filter.push_echoes(0, firing).t_echo_us for firing in firings]
            [9000, 9000, 9000]
        """
    def push_many(self, t_echo_us: ArrayLike) -> NDArray[np.int8]:
        """Take in many firings at once, without the interpreter lock.

        Args:
            t_echo_us: array of shape (periods, sensors): echo times in microseconds, rounded to whole ones; NaN for no
                echo. An array of contiguous float64 is read in place, anything else is converted first.

        Returns:
            Array of int8 of the same shape: indices into ``eeruf.KINDS``.

        Raises:
            ArgumentError: another shape, or a time that is negative or 2^32 or more; nothing has been taken in then.

        Example:
            >>> import eeruf, numpy
            >>> kinds = eeruf.EchoFilter(2, 500).push_many([[9_000, 7_000], [9_100, numpy.nan]])
            >>> [[eeruf.KINDS[kind] for kind in row] for row in kinds]
            [['first', 'first'], ['accepted', 'no_echo']]
        """
    def forget(self, sensor: _Int) -> None:
        """Forget the readings of a sensor, so that its next one is compared with nothing.

        Args:
            sensor: which one, from 0.

        Raises:
            ArgumentError: no such sensor.

        Example:
            >>> import eeruf
            >>> filter = eeruf.EchoFilter(1, 500)
            >>> kinds = [filter.push(0, 9_000).kind]
            >>> filter.forget(0)
            >>> kinds + [filter.push(0, 9_000).kind]
            ['first', 'first']
        """

@final
class HoppingSchedule:
    """When the sensors of a hopping ring fire: a code of many phases, for sensors that two phases leave blind. Immutable.

    The code is Welch's Costas sequence: the sensor that is ``i``th in the order of lags fires
    ``step_us * (a * g ** (m - i) % q - 1)`` after its lag in phase ``m``, with ``q`` the prime above the number of
    phases and ``g`` its least primitive root. Any path from one sensor to another moves by at least a step from each
    phase to each other, and few phases lie along any line, as a robot's own speed would draw it. Schedules compare,
    hash and pickle, and their ``repr`` can be pasted back.

    Args:
        sensors: how many, 1 to 64.
        period_us: the period, ``T_p``; it must exceed the width of the code.
        step_us: the least shift of crosstalk, 1 to 65535.
        phases: at least this many, 2 to 67, as far as there are; there are more than sensors, and one less than a
            prime. By default at least the 5 that confirm an echo.
        t_lag_us: the lag of each sensor; by default they are spread evenly over the period.
        first_multiplier: ``a``, below the number of phases, which are then exactly as many as asked for: one less than
            a prime, or a prime for the linear congruence ``(x + a) * m % phases`` of sensor ``x``.

    Raises:
        ArgumentError: something of the wrong type or out of range.
        HoppingError: numbers that make no such schedule, such as a period too short for the code.

    Example:
        >>> import eeruf
        >>> schedule = eeruf.HoppingSchedule(sensors=8, period_us=60_000, step_us=240)
        >>> schedule.phases, schedule.width_us, schedule.t_fire_us.shape
        (10, 2160, (10, 8))
    """
    def __new__(
        cls,
        sensors: _Int,
        period_us: _Int,
        step_us: _Int,
        phases: _Int = 5,
        t_lag_us: Iterable[_Int] | None = None,
        *,
        first_multiplier: _Int | None = None,
    ) -> HoppingSchedule: ...
    @staticmethod
    def from_toml(text: str) -> HoppingSchedule:
        r"""Read a schedule as ``eeruf design --phases M --emit toml`` and :meth:`to_toml` write it.

        Args:
            text: the contents of a file: ``period_us``, ``step_us``, ``phases`` and ``t_lag_us``.

        Raises:
            ArgumentError: not a text.
            HoppingError: the text is no TOML, a key is missing, the numbers make no schedule, or it is a table of
            firing
                times, which no ring hops by.

        Example:
            >>> from eeruf import HoppingSchedule
            >>> keys = "period_us = 60000\nstep_us = 240\nphases = 5\nt_lag_us = [0, 9000]"
            >>> HoppingSchedule.from_toml(keys).phases
            5
        """
    def scaled(self, num: _Int, den: _Int) -> HoppingSchedule:
        """Multiply the period and the lags by a fraction, each rounded to the nearest microsecond. The code stays, so
        a ring may change to it.

        Args:
            num: its numerator.
            den: its denominator. If the fraction is 1 or more, it keeps all that the schedule keeps.

        Raises:
            ArgumentError: no whole numbers.
            HoppingError: the times make no schedule, such as a period too short for the code.

        Example:
            >>> import eeruf
            >>> eeruf.HoppingSchedule(sensors=8, period_us=60_000, step_us=240).scaled(3, 2).period_us
            90000
        """
    def to_toml(self) -> str:
        """Write a schedule file, as the program reads it.

        Example:
            >>> from eeruf import HoppingSchedule
            >>> schedule = HoppingSchedule(sensors=8, period_us=60_000, step_us=240)
            >>> HoppingSchedule.from_toml(schedule.to_toml()) == schedule
            True
        """
    @property
    def period_us(self) -> int:
        """The period ``T_p``, in microseconds."""
    @property
    def sensors(self) -> int:
        """Number of sensors that fire."""
    @property
    def phases(self) -> int:
        """Number of phases a cycle has: one less than a prime, or a prime for a linear congruence."""
    @property
    def first_multiplier(self) -> int:
        """``a``: what the first sensor's wait is multiplied by."""
    @property
    def step_us(self) -> int:
        """The least shift of crosstalk from one phase to another, in microseconds."""
    @property
    def width_us(self) -> int:
        """The longest wait of the code, in microseconds."""
    @property
    def t_lag_us(self) -> tuple[int, ...]:
        """The lag of each sensor at the start, in microseconds; a ring may move them."""
    @property
    def t_fire_us(self) -> _Ints:
        """When each sensor fires, in microseconds from the beginning of the period: an array of int64 of shape
        (phases, sensors).
        """
    def to_dict(self) -> dict[str, object]:
        """The period and the code with its lags by their names: a dict of plain values.

        Example:
            >>> import eeruf
            >>> eeruf.HoppingSchedule(sensors=2, period_us=60_000, step_us=240, phases=5).to_dict()["t_lag_us"]
            [0, 29400]
        """
    def __eq__(self, other: object, /) -> bool: ...
    def __ne__(self, other: object, /) -> bool: ...
    def __hash__(self, /) -> int: ...

@type_check_only
class _HoppingChanges(TypedDict, total=False):
    t_delta_us: _Int
    near_us: _Int
    votes: _Int
    score_limit: _Int
    contradiction: _Int
    solo_contradiction: _Int
    tentative_votes: _Int
    tentative_within_us: _Int
    solo_rate: _Int
    solo_after: _Int
    solo_spacing: _Int
    shift_after: _Int
    shift_spacing: _Int
    shift_interval_us: _Int
    neighbours: _Int

@final
class HoppingSettings:
    """Settings by which a hopping ring, or its tracker alone, weighs readings and fires. Immutable; they compare, hash and
    pickle.

    Args:
        name: what to start from: ``"balanced"`` for most robots, ``"quick"`` for those that must stop early (a little
            more is wrong), ``"driving"`` for those that drive (no solo periods), ``"maps"`` for
            confirmed echoes alone.
        changes: whatever is to be different, by the names of the attributes; whole numbers.

    Raises:
        ArgumentError: no such name, or not such a number.
        HoppingError: settings that contradict each other.

    Example:
        >>> import eeruf
        >>> settings = eeruf.HoppingSettings("quick", shift_after=5)  # lags are redrawn
        >>> settings.votes, settings.shift_after
        (4, 5)
        >>> settings
        HoppingSettings('quick', shift_after=5)
    """
    def __new__(cls, name: _Hopping = "balanced", /, **changes: Unpack[_HoppingChanges]) -> HoppingSettings: ...
    @property
    def t_delta_us(self) -> int:
        """``T_delta``: a reading supports an echo that it differs from by no more, in microseconds; 1 to 65535."""
    @property
    def near_us(self) -> int:
        """A reading this near a confirmed echo is accepted, in microseconds; ``t_delta_us`` to 65535."""
    @property
    def votes(self) -> int:
        """Number of phases that must support an echo before it is confirmed, 2 to 15."""
    @property
    def score_limit(self) -> int:
        """The highest score of an echo, ``votes`` to 15: the higher, the longer it is believed."""
    @property
    def contradiction(self) -> int:
        """Score that a later reading takes from a confirmed echo, 1 to 15."""
    @property
    def solo_contradiction(self) -> int:
        """Score that it takes if the sensor fired alone, 1 to 15."""
    @property
    def tentative_votes(self) -> int:
        """Number of phases that must support an echo before it is tentative, 2 to 15; 0: none ever is."""
    @property
    def tentative_within_us(self) -> int:
        """Tolerance of agreement for that, in microseconds; 0 to ``t_delta_us``."""
    @property
    def solo_rate(self) -> int:
        """Credit per period towards a solo period, in 1/256, 0 to 255; 0: none is ever held."""
    @property
    def solo_after(self) -> int:
        """A sensor with nothing accepted for this many firings asks for a solo period."""
    @property
    def solo_spacing(self) -> int:
        """At least this many periods from one solo period to the next."""
    @property
    def shift_after(self) -> int:
        """After this many readings running that do not fit, a sensor draws a new lag; 0: lags stay."""
    @property
    def shift_spacing(self) -> int:
        """At least this many periods from one change of lags to the next."""
    @property
    def shift_interval_us(self) -> int:
        """Least interval between firings of neighbours when a lag is drawn, in microseconds."""
    @property
    def neighbours(self) -> int:
        """Number of adjacent sensors that are neighbours."""
    def __eq__(self, other: object, /) -> bool: ...
    def __ne__(self, other: object, /) -> bool: ...
    def __hash__(self, /) -> int: ...

@final
class EchoTracker:
    """Believes an echo that readings from several phases support: the filter of a hopping ring, alone.

    A path from another sensor repeats itself in its own phase for ever, but moves from phase to phase; so only support
    from different phases counts. Use it where the sensors fire by a :class:`HoppingSchedule`, or replay a log of such.

    Args:
        sensors: how many, 1 to 64.
        t_delta_us: ``T_delta``: a reading supports an echo that it differs from by no more, 1 to 65535; by default that
            of the settings. It must be less than the schedule's step.
        settings: a :class:`HoppingSettings`, or the name of one.

    Raises:
        ArgumentError: something of the wrong type or out of range.
        HoppingError: settings that contradict each other.

    Example:
        >>> import eeruf
        >>> tracker = eeruf.EchoTracker(sensors=1)
        >>> [tracker.push(0, phase, 9_000).kind for phase in range(6)]
        ['first', 'tentative', 'tentative', 'tentative', 'accepted', 'accepted']
        >>> {tracker.push(0, 3, 7_000).kind for _ in range(100)}  # one phase alone: crosstalk
        {'rejected'}
    """
    def __new__(
        cls, sensors: _Int, t_delta_us: _Int | None = None, *, settings: HoppingSettings | _Hopping = "balanced"
    ) -> EchoTracker: ...
    @property
    def sensors(self) -> int:
        """Number of sensors."""
    @property
    def t_delta_us(self) -> int:
        """``T_delta``, in microseconds."""
    def push(
        self,
        sensor: _Int,
        phase: _Int,
        t_echo_us: _Int | None,
        expected_change_us: _Int = 0,
        *,
        solo: bool = False,
        steady: bool = True,
    ) -> Reading:
        """Take in one firing of a sensor.

        Args:
            sensor: which one, from 0.
            phase: the phase in which it fired, 0 to 255.
            t_echo_us: the time of its echo after firing in whole microseconds, or None for no echo.
            expected_change_us: expected change of a good reading since this sensor's firing before, by
                the robot's own motion: ``-2 v dt / c`` for an object approached at ``v``.
            solo: whether no other sensor's sound could be heard.
            steady: whether firings were so punctual that crosstalk moved as the schedule says; else it supports
                nothing.

        Returns:
            The reading, without the period, which a tracker does not know.

        Raises:
            ArgumentError: no such sensor, phase or time.

        Example:
            >>> import eeruf
            >>> eeruf.EchoTracker(1).push(0, 0, 9_000, solo=True).kind
            'tentative'
        """
    def push_many(self, phase: Iterable[_Int], t_echo_us: ArrayLike) -> NDArray[np.int8]:
        """Take in many firings at once, without the interpreter lock.

        Args:
            phase: the phase of each period, 0 to 255.
            t_echo_us: array of shape (periods, sensors): echo times in microseconds, rounded to whole ones; NaN for no
                echo.

        Returns:
            Array of int8 of the same shape: indices into ``eeruf.KINDS``.

        Raises:
            ArgumentError: another shape, or a time that is negative or 2^32 or more; nothing has been taken in then.

        Example:
            >>> import eeruf, numpy
            >>> kinds = eeruf.EchoTracker(1).push_many(range(5), numpy.full((5, 1), 9_000.0))
            >>> eeruf.KINDS[kinds[-1, 0]]
            'accepted'
        """
    def confirmed_us(self, sensor: _Int) -> int | None:
        """The confirmed echo time of a sensor.

        Args:
            sensor: which one, from 0.

        Returns:
            Microseconds; None if none is confirmed, and where it is confirmed that nothing is in range (``is_clear``).

        Raises:
            ArgumentError: no such sensor.

        Example:
            >>> import eeruf
            >>> tracker = eeruf.EchoTracker(1)
            >>> kinds = [tracker.push(0, phase, 9_000).kind for phase in range(5)]
            >>> tracker.confirmed_us(0)
            9000
        """
    def is_clear(self, sensor: _Int) -> bool:
        """Returns true if it is confirmed that nothing is in a sensor's range.

        Args:
            sensor: which one, from 0.

        Raises:
            ArgumentError: no such sensor.

        Example:
            >>> import eeruf
            >>> tracker = eeruf.EchoTracker(1)
            >>> kinds = [tracker.push(0, phase, 9_000).kind for phase in range(5)]
            >>> tracker.is_clear(0)
            False
        """
    def forget(self, sensor: _Int) -> None:
        """Forget what is known of a sensor's echo. Its age goes on.

        Args:
            sensor: which one, from 0.

        Raises:
            ArgumentError: no such sensor.

        Example:
            >>> import eeruf
            >>> tracker = eeruf.EchoTracker(1)
            >>> kinds = [tracker.push(0, phase, 9_000).kind for phase in range(5)]
            >>> tracker.forget(0)
            >>> tracker.confirmed_us(0) is None
            True
        """
    def firing_changed(self) -> None:
        """Say that firing times have changed against each other otherwise than by the phase, such as by a new lag: what is
        not confirmed starts over.

        Example:
            >>> import eeruf
            >>> tracker = eeruf.EchoTracker(1)
            >>> kinds = [tracker.push(0, phase, 9_000).kind for phase in range(5)]
            >>> tracker.firing_changed()
            >>> tracker.confirmed_us(0)
            9000
        """

@final
class Fire:
    """The ring is to fire a sensor, now.

    Example:
        >>> import eeruf
        >>> eeruf.Ring(eeruf.tables.TABLE_I_D, t_delta_us=500, window_us=36_000).poll(24_000)
        Fire(sensor=0, phase=0, due_us=24000)
    """
    def __new__(cls, sensor: _Int, phase: _Int = 0, due_us: _Int = 0) -> Fire: ...
    @property
    def sensor(self) -> int:
        """The sensor, from 0."""
    @property
    def phase(self) -> int:
        """The phase that its wait belongs to: 0 for a, 1 for b; more in a hopping ring."""
    @property
    def due_us(self) -> int:
        """When it was due, on the ring's clock: before the time of the poll if that was late."""
    def to_dict(self) -> dict[str, object]:
        """Its fields by their names: a dict of plain values.

        Example:
            >>> import eeruf
            >>> eeruf.Fire(3, phase=1).to_dict()
            {'sensor': 3, 'phase': 1, 'due_us': 0}
        """
    def __eq__(self, other: object, /) -> bool: ...
    def __ne__(self, other: object, /) -> bool: ...
    def __hash__(self, /) -> int: ...

@final
class Reading:
    """The outcome of one firing of one sensor.

    Example:
        >>> import eeruf
        >>> reading = eeruf.EchoFilter(1, 500).push(0, 9_000)
        >>> reading.sensor, reading.kind, reading.t_echo_us, reading.explained_by
        (0, 'first', 9000, None)
    """
    def __new__(
        cls,
        sensor: _Int,
        kind: _Kind,
        t_echo_us: _Int | None = None,
        previous_us: _Int | None = None,
        age: _Int | None = None,
        phase: _Int | None = None,
        period: _Int | None = None,
        explained_by: _Int | Literal["history"] | None = None,
    ) -> Reading: ...
    @property
    def sensor(self) -> int:
        """The sensor, from 0."""
    @property
    def kind(self) -> _Kind:
        """The outcome, one of ``eeruf.KINDS``; ``"accepted"`` and ``"clear"`` (nothing in range) count; for
        ``"tentative"``, from a hopping ring, slow down.
        """
    @property
    def t_echo_us(self) -> int | None:
        """The time of the echo after firing, in microseconds; None without echo."""
    @property
    def previous_us(self) -> int | None:
        """The echo time it was compared with, in microseconds; None if with nothing."""
    @property
    def age(self) -> int | None:
        """Number of firings since the sensor's last accepted reading: 0 for this one, None if there never was one."""
    @property
    def phase(self) -> int | None:
        """The phase in which the sensor fired: 0 for a, 1 for b, more in a hopping ring; None from a filter alone."""
    @property
    def period(self) -> int | None:
        """The period in which the sensor fired, from 0; None from a filter alone."""
    @property
    def explained_by(self) -> int | Literal["history"] | None:
        """Why the reading is ambiguous: the sensor, from 0, whose sound explains it and the one before, or ``"history"``
        for a firing that is no longer remembered; None for every other kind.
        """
    def to_dict(self) -> dict[str, object]:
        """Its fields by their names: a dict of plain values.

        Example:
            >>> import eeruf
            >>> eeruf.EchoFilter(1, 500).push(0, 9_000).to_dict()["t_echo_us"]
            9000
        """
    def __eq__(self, other: object, /) -> bool: ...
    def __ne__(self, other: object, /) -> bool: ...
    def __hash__(self, /) -> int: ...

@final
class PeriodEnded:
    """A period of the ring has ended.

    Example:
        >>> import eeruf
        >>> ring = eeruf.Ring(eeruf.tables.TABLE_I_D, t_delta_us=500, window_us=36_000)
        >>> while not isinstance(event := ring.poll(ring.next_deadline_us), eeruf.PeriodEnded):
        ...     pass
        >>> event.period, event.phase, event.tally["no_echo"] <= 12
        (0, 0, True)
    """
    def __new__(
        cls,
        period: _Int,
        phase: _Int = 0,
        max_late_us: _Int = 0,
        sum_late_us: _Int = 0,
        tally: dict[str, int] = {},
    ) -> PeriodEnded: ...
    @property
    def period(self) -> int:
        """The period, from 0."""
    @property
    def phase(self) -> int:
        """Its phase: 0 for a, 1 for b; more in a hopping ring."""
    @property
    def max_late_us(self) -> int:
        """Largest delay with which its firings and its end were polled for, in microseconds, at most 65,535."""
    @property
    def sum_late_us(self) -> int:
        """The lateness of all its firings together, in microseconds, at most 65,535."""
    @property
    def tally(self) -> dict[str, int]:
        """Number of readings of each kind that were emitted since the period before ended: a dict by the names in
        ``eeruf.KINDS``.
        """
    def to_dict(self) -> dict[str, object]:
        """Its fields by their names: a dict of plain values.

        Example:
            >>> import eeruf
            >>> ring = eeruf.Ring(eeruf.tables.TABLE_I_D, t_delta_us=500, window_us=36_000)
            >>> ring.pause()
            >>> ring.poll(ring.next_deadline_us).to_dict()["max_late_us"]
            0
        """
    def __eq__(self, other: object, /) -> bool: ...
    def __ne__(self, other: object, /) -> bool: ...

@final
class Ring:
    """Plan and filter together, as the firmware runs them: the caller passes the time and gets back what to do.

    Moments are microseconds on a clock that wraps at 2^32, as on a small microcontroller; larger numbers are taken
    modulo that. ``Ring(schedule)`` fires by a schedule and compares two readings; :meth:`flow` and :meth:`hopping`
    give rings that fire otherwise and count votes.

    Args:
        schedule: when the sensors fire.
        t_delta_us: ``T_delta``: consecutive readings that differ by no more are near-identical (Eq. 11). One for all,
            or a sequence with one for each sensor.
        now_us: when the first period begins.
        window_us: ``T_wind``: how long a sensor listens after it has fired, 1 or more. One for all, or a sequence.
        blanking_us: edges sooner than this after firing are ringing of the transducer, not echoes.
        consecutive: the number of consecutive readings that must agree, 2 to 8.
        path_change_us: P: the largest change of a foreign sound's path from one reading to the next, at
            most 65,534; None for ``t_delta_us``. Less makes fewer readings ambiguous where firings are late.
        audible_us: R: how long sound is audible, at most 67 s; None for one period.
        refire_us: how soon a sensor may be triggered again, as for :func:`design`. With this, with those below or with
            a sequence above the ring is one of sensors that are not all alike: its schedule must keep what each needs,
            each listens and compares by its own numbers, and ``t_delta_us`` and ``window_us`` say the largest.
        intervals_us: pairs of sensors with the least time between their firings: ``[(0, 4, 9000)]``.
        shared_lines: groups of sensors on one echo line, ``[(0, 3), (1, 4)]``: none fires while another listens.
        together: groups of sensors that fire at the same instants, declared not to hear each other.
        several_echoes: each sensor reports several echoes of a firing; of up to eight the earliest that repeats is
            accepted.

    Raises:
        ArgumentError: something of the wrong type or out of range.
        RingError: the ring cannot listen like that, such as longer than the schedule lets it; or the schedule does not
            reject crosstalk at this ``t_delta_us`` (see ``Ring.unverified``), or breaks what a sensor needs.

    Example:
        >>> import eeruf
        >>> ring, kinds = eeruf.Ring(eeruf.tables.TABLE_I_D, t_delta_us=500, window_us=36_000), []
        >>> while len(kinds) < 24:
        ...     now_us = ring.next_deadline_us
        ...     while event := ring.poll(now_us):
        ...         if isinstance(event, eeruf.Fire):
        ...             ring.echo(event.sensor, now_us + 9_000)  # a wall 1.5 m away
        ...         elif isinstance(event, eeruf.Reading):
        ...             kinds.append(event.kind)
        >>> kinds == ["first"] * 12 + ["accepted"] * 12
        True
        >>> needs = dict(t_delta_us=[999, 999, 1500, 1500], window_us=[36_000, 36_000, 12_000, 12_000])
        >>> found = eeruf.design(4, min_interval_us=15_000, shared_lines=[(0, 2)], **needs)
        >>> ring = eeruf.Ring(found.schedule, shared_lines=[(0, 2)], **needs)
        >>> ring.t_delta_us, ring.window_us
        (1500, 36000)
    """
    def __new__(
        cls,
        schedule: Schedule,
        t_delta_us: _Each,
        now_us: _Int = 0,
        *,
        window_us: _Each,
        blanking_us: _Int = 0,
        consecutive: _Int = 2,
        path_change_us: _Int | None = None,
        audible_us: _Int | None = None,
        refire_us: _Each | None = None,
        intervals_us: Iterable[tuple[_Int, _Int, _Int]] | None = None,
        shared_lines: Iterable[Sequence[_Int]] | None = None,
        together: Iterable[Sequence[_Int]] | None = None,
        several_echoes: bool = False,
    ) -> Ring: ...
    @staticmethod
    def unverified(
        schedule: Schedule,
        t_delta_us: _Int,
        now_us: _Int = 0,
        *,
        window_us: _Int,
        blanking_us: _Int = 0,
        consecutive: _Int = 2,
        path_change_us: _Int | None = None,
        audible_us: _Int | None = None,
    ) -> Ring:
        """A ring whose schedule was not verified. Crosstalk that it repeats, as constant waits do, makes readings
        ``"ambiguous"``; none of it is accepted.

        Args:
            schedule: when the sensors fire.
            t_delta_us: as for ``Ring``, as are all others.
            now_us: when the first period begins.
            window_us: how long a sensor listens after it has fired, 1 or more.
            blanking_us: edges sooner than this after firing are no echoes.
            consecutive: the number of consecutive readings that must agree, 2 to 8.
            path_change_us: P, at most 65,534; None for ``t_delta_us``.
            audible_us: R, at most 67 s; None for one period.

        Raises:
            ArgumentError: something of the wrong type or out of range.
            RingError: the ring cannot listen like that.

        Example:
            >>> import eeruf
            >>> constant = eeruf.Schedule(60_000, [0, 15_000], [0, 0], [0, 0])
            >>> eeruf.Ring.unverified(constant, 500, window_us=36_000).poll(0)
            Fire(sensor=0, phase=0, due_us=0)
        """
    @staticmethod
    def hopping(
        schedule: HoppingSchedule,
        settings: HoppingSettings | _Hopping = "balanced",
        now_us: _Int = 0,
        *,
        window_us: _Each,
        blanking_us: _Int = 0,
        reach_us: _Int | None = None,
        seed: _Int = 1,
        t_delta_us: _Each | None = None,
        refire_us: _Each | None = None,
        intervals_us: Iterable[tuple[_Int, _Int, _Int]] | None = None,
        shared_lines: Iterable[Sequence[_Int]] | None = None,
        together: Iterable[Sequence[_Int]] | None = None,
        several_echoes: bool = False,
    ) -> Ring:
        """A ring that hops in time: its readings can also be ``"tentative"``, and no sensor stays blind.

        A sensor that hears nothing of its own gets a period in which it fires alone. ``docs/explanation/hopping.md``
        has the rules, what they bring, and what is not promised.

        Args:
            schedule: a :class:`HoppingSchedule`.
            settings: a :class:`HoppingSettings`, or the name of one.
            now_us: when the first period begins.
            window_us: ``T_wind``: how long a sensor listens after it has fired, 1 to 16,711,679; one for all, or each.
            blanking_us: edges sooner than this after firing are ringing of the transducer, not echoes.
            reach_us: after how long no sound is heard any more; by default the window.
            seed: of the draws of new lags, below 2^32.
            t_delta_us: for each sensor, where they are not all alike: at most the settings'.
            refire_us: as for ``Ring``, as are the next three: what the schedule must keep of each sensor.
            intervals_us: pairs with the least time between their firings.
            shared_lines: groups of sensors on one echo line.
            together: groups of sensors that fire at the same instants.
            several_echoes: each sensor reports several echoes of a firing, of which up to eight have votes.

        Raises:
            ArgumentError: something of the wrong type or out of range.
            RingError: the schedule breaks what a sensor needs.
            HoppingError: a ``T_delta`` that is not below the schedule's step, a period too short for window and code,
                a window that is too long or ends within the blanking time.

        Example:
            >>> import eeruf
            >>> schedule = eeruf.HoppingSchedule(sensors=8, period_us=60_000, step_us=240)
            >>> eeruf.Ring.hopping(schedule, "quick", window_us=36_000).poll(0)
            Fire(sensor=0, phase=0, due_us=0)
        """
    @staticmethod
    def flow(
        sensors: _Int,
        settings: FlowSettings | None = None,
        now_us: _Int = 0,
        *,
        window_us: _Int,
        blanking_us: _Int = 0,
        reach_us: _Int | None = None,
        several_echoes: bool = False,
    ) -> Ring:
        """A ring by flow: each sensor gets as much quiet around its firing as it has needed, and votes confirm an echo.
        ``docs/explanation/flow.md`` says for whom.

        Args:
            sensors: how many, 1 to 64.
            settings: a dict of what differs from the default, as :class:`eeruf.sim.Method` takes it.
            now_us: when the first cycle begins.
            window_us: as for :meth:`hopping`, as are the others.
            blanking_us: edges sooner than this after firing are no echoes.
            reach_us: after how long no sound is heard any more; by default the window.
            several_echoes: as for :meth:`hopping`.

        Raises:
            ArgumentError: something of the wrong type or out of range.
            HoppingError: settings that contradict each other or the window.

        Example:
            >>> import eeruf
            >>> ring = eeruf.Ring.flow(8, {"rest_us": 60_000}, window_us=36_000)
            >>> ring.poll(ring.next_deadline_us).sensor
            0
        """
    @property
    def t_lag_us(self) -> tuple[int, ...]:
        """The lag of each sensor as it is now, in microseconds; empty where a ring does not hop."""
    @property
    def solo(self) -> int | None:
        """The sensor that the present period belongs to alone, from 0; None if it belongs to all."""
    def confirmed_us(self, sensor: _Int) -> int | None:
        """The echo that votes have confirmed of a sensor, in microseconds; None for none, or where none are counted.

        Args:
            sensor: which one, from 0.

        Raises:
            ArgumentError: no such sensor.

        Example:
            >>> import eeruf
            >>> eeruf.Ring.flow(2, window_us=36_000).confirmed_us(0) is None  # nothing has been heard yet
            True
        """
    @property
    def schedule(self) -> Schedule:
        """Schedule of the present period, of a ring that fires by one."""
    def change_schedule(self, schedule: Schedule | HoppingSchedule) -> None:
        """Fire by another schedule when the present period ends; a ring that hops does once all sound from before died.
        ``t_delta_us`` and ``window_us`` stay, and so does what each sensor needs where they are not all alike.

        Args:
            schedule: of as many sensors; a :class:`HoppingSchedule` of the same code for a ring that hops.

        Raises:
            ArgumentError: no schedule, or not of as many sensors.
            HoppingError: another code, or a period that is too short to hop.
            RingError: a sensor would fire again while it still listens, or the schedule does not reject crosstalk at
                this ``t_delta_us``, or breaks what a sensor needs. The ring goes on as before.

        Example:
            >>> import eeruf
            >>> ring = eeruf.Ring(eeruf.tables.TABLE_I_D, t_delta_us=500, window_us=36_000)
            >>> ring.change_schedule(eeruf.tables.TABLE_I_D.scaled(4, 5))
            >>> while not isinstance(ring.poll(ring.next_deadline_us), eeruf.PeriodEnded):
            ...     pass
            >>> ring.schedule.period_us
            80000
        """
    @property
    def sensors(self) -> int:
        """The number of sensors."""
    @property
    def t_delta_us(self) -> int:
        """``T_delta``, in microseconds. It can be changed while the ring runs, if it fires by a :class:`Schedule`."""
    @t_delta_us.setter
    def t_delta_us(self, value: _Int, /) -> None:
        """``T_delta``, in microseconds. It can be changed while the ring runs, if it fires by a :class:`Schedule`."""
    @property
    def window_us(self) -> int:
        """``T_wind``, in microseconds. It can be changed while the ring runs, also for firings that are under way."""
    @window_us.setter
    def window_us(self, value: _Int, /) -> None:
        """``T_wind``, in microseconds. It can be changed while the ring runs, also for firings that are under way."""
    @property
    def blanking_us(self) -> int:
        """For how long after firing edges are no echoes, in microseconds. It can be changed while the ring runs."""
    @blanking_us.setter
    def blanking_us(self, value: _Int, /) -> None:
        """For how long after firing edges are no echoes, in microseconds. It can be changed while the ring runs."""
    @property
    def path_change_us(self) -> int:
        """P, the largest change of a foreign sound's path from one reading to the next, in microseconds, of a ring by a
        schedule. It can be changed while the ring runs: as the robot's speed changes, for example.
        """
    @path_change_us.setter
    def path_change_us(self, value: _Int, /) -> None:
        """P, the largest change of a foreign sound's path from one reading to the next, in microseconds, of a ring by a
        schedule. It can be changed while the ring runs: as the robot's speed changes, for example.
        """
    @property
    def audible_us(self) -> int:
        """R, how long sound is audible, in microseconds, of a ring by a schedule. It can be changed while the ring runs."""
    @audible_us.setter
    def audible_us(self, value: _Int, /) -> None:
        """R, how long sound is audible, in microseconds, of a ring by a schedule. It can be changed while the ring runs."""
    @property
    def report_after_us(self) -> int:
        """Earliest time after its firing at which a reading without an echo is emitted, in microseconds: for modules that
        report by a bus or a pulse's width after their window has closed. 0: when it closes.
        """
    @report_after_us.setter
    def report_after_us(self, value: _Int, /) -> None:
        """Earliest time after its firing at which a reading without an echo is emitted, in microseconds: for modules that
        report by a bus or a pulse's width after their window has closed. 0: when it closes.
        """
    def upcoming(self) -> list[Fire]:
        """The firings to come, up to the end of the next period: for hardware that fires by itself.

        They hold until one is late, or the ring is changed. The loop may then come late: for each firing poll at its
        instant until there is no event, so that ``Fire`` says what is done already; hand in echoes; last poll at the
        present.

        Example:
            >>> import eeruf
            >>> ring = eeruf.Ring(eeruf.tables.TABLE_I_D, t_delta_us=500, window_us=36_000)
            >>> [(fire.sensor, fire.due_us) for fire in ring.upcoming()[:4]]
            [(0, 24000), (4, 24000), (8, 24000), (1, 49000)]
        """
    @property
    def next_deadline_us(self) -> int:
        """When to poll next, in microseconds of the clock that wraps at 2^32; in the past if an event is pending."""
    def wait_us(self, now_us: _Int) -> int:
        """Time to wait before polling next, in microseconds: 0 if an event is pending.

        This is right across the wrap of the clock at 2^32, where ``next_deadline_us`` and a ``now_us`` that goes on
        growing no longer compare.

        Args:
            now_us: the present, 0 or more.

        Raises:
            ArgumentError: not such a time.

        Example:
            >>> import eeruf
            >>> ring = eeruf.Ring(eeruf.tables.TABLE_I_D, t_delta_us=500, window_us=36_000, now_us=2**32 - 1_000)
            >>> ring.wait_us(2**32 - 1_000), ring.wait_us(2**32 + 23_000)
            (24000, 0)
        """
    def poll(
        self, now_us: _Int, expected_change_us: Iterable[_Int] | None = None
    ) -> Fire | Reading | PeriodEnded | None:
        """The next event at a time. Call again until there is none, then wait until ``next_deadline_us``.

        Hand in the echoes you know of before you poll: one that comes after the poll that closed its window is not
        heard.

        Args:
            now_us: the present, 0 or more.
            expected_change_us: for each sensor, the expected change of a good reading from the one before, by the
                robot's own motion: ``-2 v dt / c`` for an object approached at ``v``. None for a robot that stands.

        Returns:
            A ``Fire``, a ``Reading``, a ``PeriodEnded``, or None if there is nothing to do now.

        Raises:
            ArgumentError: not such a time, or not one change for each sensor.

        Example:
            >>> import eeruf
            >>> ring = eeruf.Ring(eeruf.tables.TABLE_I_D, t_delta_us=500, window_us=36_000)
            >>> ring.poll(23_000)
            >>> ring.poll(24_000)
            Fire(sensor=0, phase=0, due_us=24000)
        """
    def echo(self, sensor: _Int, at_us: _Int) -> None:
        """An edge on the echo line of a sensor. Edges may come in any order, at any time, wanted or not.

        Args:
            sensor: which one, from 0.
            at_us: when, 0 or more.

        Raises:
            ArgumentError: no such sensor or time.

        Example:
            >>> import eeruf
            >>> ring = eeruf.Ring(eeruf.tables.TABLE_I_D, t_delta_us=500, window_us=36_000)
            >>> [ring.poll(24_000).sensor for _ in range(3)]  # one of each group of four
            [0, 4, 8]
            >>> ring.echo(0, 33_000)
            >>> ring.poll(33_000).t_echo_us
            9000
        """
    def fired(self, sensor: _Int, at_us: _Int) -> None:
        """Corrects when a sensor last fired: by what a timer captured, for example. Optional: echo times count from then,
        and if it is later than the poll, all later firings move by as much.

        Args:
            sensor: which one, from 0.
            at_us: when, 0 or more; a time that is not after the sensor's firing before is ignored.

        Raises:
            ArgumentError: no such sensor or time.

        Example:
            >>> import eeruf
            >>> ring = eeruf.Ring(eeruf.tables.TABLE_I_D, t_delta_us=500, window_us=36_000)
            >>> _ = [ring.poll(24_000) for _ in range(3)]  # one of each group of four fires
            >>> ring.fired(0, 24_100)
            >>> ring.echo(0, 33_000)
            >>> ring.poll(33_000).t_echo_us
            8900
        """
    def stuck(self, sensor: _Int) -> None:
        """The echo line of a sensor was already high when it was to fire: the firing just emitted counts as ``"stuck"``.

        Args:
            sensor: which one, from 0.

        Raises:
            ArgumentError: no such sensor.

        Example:
            >>> import eeruf
            >>> ring = eeruf.Ring(eeruf.tables.TABLE_I_D, t_delta_us=500, window_us=36_000)
            >>> _ = [ring.poll(24_000) for _ in range(3)]  # one of each group of four fires
            >>> ring.stuck(0)
            >>> while not isinstance(event := ring.poll(ring.next_deadline_us), eeruf.Reading):
            ...     pass
            >>> event.sensor, event.kind
            (0, 'stuck')
        """
    def expect_answers(self) -> None:
        """Ask silence for a witness, from the next firing on: a firing without an echo is then ``"unanswered"``, which is
        never free space, unless :meth:`answered` or :meth:`measured` says that the sensor listened.

        Example:
            >>> import eeruf
            >>> ring = eeruf.Ring(eeruf.tables.TABLE_I_D, t_delta_us=500, window_us=36_000)
            >>> ring.expect_answers()
            >>> while not isinstance(event := ring.poll(ring.next_deadline_us), eeruf.Reading):
            ...     pass
            >>> event.kind, ring.state(event.sensor).kind
            ('unanswered', 'unanswered')
        """
    def answered(self, sensor: _Int, answered: bool = True) -> None:
        """A sensor has shown that it listens for the echo of its last firing, such as by a line that rises.

        Args:
            sensor: which one, from 0.
            answered: False takes that back: it was a disturbance.

        Raises:
            ArgumentError: no such sensor.

        Example:
            >>> import eeruf
            >>> ring = eeruf.Ring(eeruf.tables.TABLE_I_D, t_delta_us=500, window_us=36_000)
            >>> ring.expect_answers()
            >>> while not isinstance(event := ring.poll(ring.next_deadline_us), eeruf.Reading):
            ...     if isinstance(event, eeruf.Fire):
            ...         ring.answered(event.sensor)
            >>> event.kind
            'no_echo'
        """
    def measured(self, sensor: _Int, t_echo_us: _Int | None) -> None:
        """Hand in what hardware or a protocol measured of a sensor's last firing, before its reading is emitted: see
        ``report_after_us``.

        Args:
            sensor: which one, from 0.
            t_echo_us: the echo time in microseconds, or None if it listened and heard nothing.

        Raises:
            ArgumentError: no such sensor or time.

        Example:
            >>> import eeruf
            >>> ring = eeruf.Ring(eeruf.tables.TABLE_I_D, t_delta_us=500, window_us=36_000)
            >>> _ = [ring.poll(24_000) for _ in range(3)]  # one of each group of four fires
            >>> ring.measured(4, 9_000)
            >>> ring.poll(40_000).t_echo_us
            9000
        """
    def forget(self, sensor: _Int) -> None:
        """Forget what is known of a sensor's echo, so that its next reading is compared with nothing: the last one was not
        what it seemed.

        Args:
            sensor: which one, from 0.

        Raises:
            ArgumentError: no such sensor.

        Example:
            >>> import eeruf
            >>> ring = eeruf.Ring(eeruf.tables.TABLE_I_D, t_delta_us=500, window_us=36_000)
            >>> ring.forget(3)
        """
    def state(self, sensor: _Int) -> State:
        """The state of the space before a sensor, at the time of the last poll.

        Args:
            sensor: which one, from 0.

        Returns:
            A ``State``: an obstacle, clear, too close, unanswered or unknown, for how long, and why.

        Raises:
            ArgumentError: no such sensor.

        Example:
            >>> import eeruf
            >>> ring = eeruf.Ring(eeruf.tables.TABLE_I_D, t_delta_us=500, window_us=36_000)
            >>> ring.state(3)
            State(kind='unknown', t_echo_us=None, age_us=0, why='no_firing', explained_by=None)
        """
    def disable(self, sensor: _Int) -> None:
        """Stop a sensor from firing. The reading of a firing that is under way is still emitted.

        Args:
            sensor: which one, from 0.

        Raises:
            ArgumentError: no such sensor.

        Example:
            >>> import eeruf
            >>> ring = eeruf.Ring(eeruf.tables.TABLE_I_D, t_delta_us=500, window_us=36_000)
            >>> ring.disable(0)
            >>> ring.is_enabled(0)
            False
        """
    def enable(self, sensor: _Int) -> None:
        """Let a sensor fire again, from its next turn on. Its readings from before are forgotten.

        Args:
            sensor: which one, from 0.

        Raises:
            ArgumentError: no such sensor.

        Example:
            >>> import eeruf
            >>> ring = eeruf.Ring(eeruf.tables.TABLE_I_D, t_delta_us=500, window_us=36_000)
            >>> ring.disable(0)
            >>> ring.enable(0)
            >>> ring.is_enabled(0)
            True
        """
    def is_enabled(self, sensor: _Int) -> bool:
        """Returns true if a sensor fires.

        Args:
            sensor: which one, from 0.

        Raises:
            ArgumentError: no such sensor.

        Example:
            >>> import eeruf
            >>> ring = eeruf.Ring(eeruf.tables.TABLE_I_D, t_delta_us=500, window_us=36_000)
            >>> ring.is_enabled(11)
            True
        """
    def pause(self) -> None:
        """Let no sensor fire until :meth:`resume`. Readings of firings under way are still emitted, and periods go on.

        Example:
            >>> import eeruf
            >>> ring = eeruf.Ring(eeruf.tables.TABLE_I_D, t_delta_us=500, window_us=36_000)
            >>> ring.pause()
            >>> type(ring.poll(ring.next_deadline_us)).__name__
            'PeriodEnded'
        """
    def resume(self) -> None:
        """Let sensors fire again, as of the next period. Readings from before are forgotten.

        Example:
            >>> import eeruf
            >>> ring = eeruf.Ring(eeruf.tables.TABLE_I_D, t_delta_us=500, window_us=36_000)
            >>> ring.pause()
            >>> ring.resume()
            >>> _ = ring.poll(ring.next_deadline_us)  # the period ends
            >>> type(ring.poll(ring.next_deadline_us)).__name__
            'Fire'
        """
    def restart(self, now_us: _Int) -> None:
        """Start again with phase a at a time, or as soon as the last firings allow: after a long sleep. Firings under way
        are dropped, and readings from before are forgotten.

        Args:
            now_us: the present, 0 or more.

        Raises:
            ArgumentError: not such a time.

        Example:
            >>> import eeruf
            >>> ring = eeruf.Ring(eeruf.tables.TABLE_I_D, t_delta_us=500, window_us=36_000)
            >>> ring.restart(3_600_000_000)
            >>> ring.wait_us(3_600_000_000)
            24000
        """

@final
class SensorWatch:
    """Watches the events of a ring, a hopping one too: what is known of the space before each sensor now, and which
    sensors hear echoes none of which is accepted.

    Args:
        sensors: how many, 1 to 64.
        blind_after: a sensor counts as blind when nothing was accepted for this many firings with an echo, 1 to 255;
            0: never.
        now_us: the present, 0 or more.

    Raises:
        ArgumentError: something of the wrong type or out of range.

    Example:
        >>> import eeruf
        >>> ring = eeruf.Ring(eeruf.tables.TABLE_I_D, t_delta_us=500, window_us=36_000)
        >>> watch, blind, far_us = eeruf.SensorWatch(sensors=12, blind_after=4), [], 0
        >>> for _ in range(400):
        ...     now_us = ring.next_deadline_us
        ...     while event := ring.poll(now_us):
        ...         if isinstance(event, eeruf.Fire):
        ...             far_us = (far_us + 700) % 9_000  # what sensor 5 hears moves on and on
        ...             ring.echo(event.sensor, now_us + 9_000 + (far_us if event.sensor == 5 else 0))
        ...         if found := watch.observe(event, now_us):
        ...             blind.append(found)
        >>> blind
        [Blind(sensor=5, firings=4)]
        >>> watch.state(4, now_us).t_echo_us, watch.state(5, now_us).kind
        (9000, 'unknown')
    """
    def __new__(cls, sensors: _Int, blind_after: _Int = 20, now_us: _Int = 0) -> SensorWatch: ...
    @property
    def sensors(self) -> int:
        """Number of sensors it watches."""
    def observe(self, event: Fire | Reading | PeriodEnded, now_us: _Int) -> Blind | None:
        """Take in what a poll returned. Observe every event, or at least readings and the ends of periods.

        Args:
            event: of ``Ring.poll``.
            now_us: the time of that poll, 0 or more.

        Returns:
            A ``Blind`` when a sensor has just become blind, once, and again only after something was accepted; else
            None.

        Raises:
            ArgumentError: no event, or not such a time.

        Example:
            >>> import eeruf
            >>> watch = eeruf.SensorWatch(sensors=12, blind_after=1)
            >>> watch.observe(eeruf.Reading(3, "rejected", 9_000, 7_000), now_us=100_000)
            Blind(sensor=3, firings=1)
        """
    def state(self, sensor: _Int, now_us: _Int) -> State:
        """The state of the space before a sensor.

        Args:
            sensor: which one, from 0.
            now_us: the present, 0 or more.

        Raises:
            ArgumentError: no such sensor or time.

        Example:
            >>> import eeruf
            >>> watch = eeruf.SensorWatch(sensors=12)
            >>> watch.observe(eeruf.Reading(3, "accepted", 9_000, 9_100), now_us=102_400)
            >>> watch.state(3, now_us=153_600)
            State(kind='obstacle', t_echo_us=9000, age_us=51200, why=None, explained_by=None)
        """

@final
class Blind:
    """A sensor that hears echoes, none of which was accepted for this many firings.

    Example:
        >>> import eeruf
        >>> eeruf.Blind(sensor=3, firings=20).to_dict()
        {'sensor': 3, 'firings': 20}
    """
    def __new__(cls, sensor: _Int, firings: _Int) -> Blind: ...
    @property
    def sensor(self) -> int:
        """The sensor, from 0."""
    @property
    def firings(self) -> int:
        """For how many firings with an echo nothing was accepted."""
    def to_dict(self) -> dict[str, object]:
        """Its fields by their names: a dict of plain values.

        Example:
            >>> import eeruf
            >>> eeruf.Blind(3, 20).to_dict()
            {'sensor': 3, 'firings': 20}
        """
    def __eq__(self, other: object, /) -> bool: ...
    def __ne__(self, other: object, /) -> bool: ...
    def __hash__(self, /) -> int: ...

@final
class State:
    """The state of the space before a sensor.

    Example:
        >>> import eeruf
        >>> eeruf.State("clear", age_us=51_200).to_dict()
        {'kind': 'clear', 't_echo_us': None, 'age_us': 51200, 'why': None, 'explained_by': None}
    """
    def __new__(
        cls,
        kind: _StateKind,
        t_echo_us: _Int | None = None,
        age_us: _Int = 0,
        why: _Doubt | None = None,
        explained_by: _Int | Literal["history"] | None = None,
    ) -> State: ...
    @property
    def kind(self) -> _StateKind:
        """``"obstacle"``: something stands there; ``"clear"``: nothing is in range; ``"too_close"``: closer than the
        sensor can measure; ``"unanswered"``: it does not answer, or its line is stuck; ``"unknown"``.
        """
    @property
    def t_echo_us(self) -> int | None:
        """The echo time of an obstacle, in microseconds; None for all else."""
    @property
    def age_us(self) -> int:
        """Microseconds since that was last confirmed, or for which nothing has been known or answered; at most 2^31
        (36 minutes), which stands for all longer times.
        """
    @property
    def why(self) -> _Doubt | None:
        """Why nothing is known: ``"no_firing"``, ``"unsure"`` (one echo, or one silence), ``"rejected"`` or
        ``"ambiguous"``; None for all else.
        """
    @property
    def explained_by(self) -> int | Literal["history"] | None:
        """The sensor whose sound explains an ambiguous echo, or ``"history"``; None for all else."""
    def to_dict(self) -> dict[str, object]:
        """Its fields by their names: a dict of plain values.

        Example:
            >>> import eeruf
            >>> eeruf.State("unanswered", age_us=1_000).to_dict()["kind"]
            'unanswered'
        """
    def __eq__(self, other: object, /) -> bool: ...
    def __ne__(self, other: object, /) -> bool: ...
    def __hash__(self, /) -> int: ...

@final
class Adaptation:
    """Adaptive scheduling (end of Sec. 3.1): fire more slowly where too much is rejected, and faster again when it is
    calm.

    It watches the rejection rate over windows of some periods. One noisy window moves one rung up, to a longer period;
    only several calm windows running move one rung down.

    Args:
        schedules: the rungs, of equally many sensors, from the shortest period to the longest, each a ``Schedule``; or,
            for a ring that hops, a ``HoppingSchedule`` of the same code. The ring begins with the first.
        t_delta_us: ``T_delta`` of the ring, at which each must reject crosstalk.
        noisy: above this rejection rate, a fraction of 1, it fires more slowly.
        calm: up to this rejection rate a window is calm.
        window_periods: how many periods a window has, 1 to 255.
        patience: how many calm windows running it takes to fire faster, 1 to 255.

    Raises:
        ArgumentError: something of the wrong type or out of range.
        RingError: a schedule does not reject crosstalk at this ``t_delta_us``.
        HoppingError: a step that is no more than ``t_delta_us``.
        ScheduleError: the schedules are no ladder.

    Example:
        >>> import eeruf
        >>> fast, slow = eeruf.tables.TABLE_I_D.scaled(3, 5), eeruf.tables.TABLE_I_D
        >>> ring = eeruf.Ring(fast, t_delta_us=500, window_us=36_000)
        >>> adaptation = eeruf.Adaptation([fast, slow], t_delta_us=500)
        >>> noise_us = 0
        >>> while adaptation.rung == 0:  # everything that is heard is noise
        ...     now_us = ring.next_deadline_us
        ...     while event := ring.poll(now_us):
        ...         if isinstance(event, eeruf.Fire):
        ...             noise_us = (noise_us + 7_000) % 30_000
        ...             ring.echo(event.sensor, now_us + 1_000 + noise_us)
        ...         _ = adaptation.adapt(ring, event)
        >>> adaptation.rejection_rate > 0.9, adaptation.schedule == slow
        (True, True)
    """
    def __new__(
        cls,
        schedules: Iterable[Schedule] | Iterable[HoppingSchedule],
        t_delta_us: _Int,
        *,
        noisy: float = 0.3,
        calm: float = 0.1,
        window_periods: _Int = 16,
        patience: _Int = 4,
    ) -> Adaptation: ...
    def adapt(self, ring: Ring, event: Fire | Reading | PeriodEnded) -> bool:
        """Take in an event of a ring, and change the ring to another schedule when the present one should be left. Only
        the ends of periods count.

        Args:
            ring: an ``eeruf.Ring`` that began with the first schedule.
            event: what its ``poll`` returned.

        Returns:
            Whether there was a change; the ring makes it when the present period ends.

        Raises:
            ArgumentError: no ring, no event, or a ring of other sensors.
            RingError: the ring refuses the schedule. Both then go on as before.
            HoppingError: the same of a ring that hops.

        Example:
            >>> import eeruf
            >>> ring = eeruf.Ring(eeruf.tables.TABLE_I_D, t_delta_us=500, window_us=36_000)
            >>> adaptation = eeruf.Adaptation([eeruf.tables.TABLE_I_D], t_delta_us=500)
            >>> adaptation.adapt(ring, ring.poll(ring.next_deadline_us))
            False
        """
    @property
    def rung(self) -> int:
        """The rung in use, 0 for the shortest period."""
    @property
    def schedule(self) -> Schedule | HoppingSchedule:
        """The schedule in use."""
    @property
    def rejection_rate(self) -> float | None:
        """The share of the readings that were compared and rejected in the last whole window; None before, or if nothing
        was compared in it.
        """
    def max_speed_m_s(self, t_delta_us: _Int, sound_m_s: float = 343.2) -> float:
        """The fastest motion, in m/s, at which good readings still pass on the rung in use: a reading changes by
        ``2 v dt / c`` (Sec. 3.1).

        Args:
            t_delta_us: ``T_delta`` of the ring.
            sound_m_s: the speed of sound, in m/s, 100 to 1000.

        Raises:
            ArgumentError: out of range.
            RingError: the ladder is one of a ring that hops: votes, not two readings, decide what passes.

        Example:
            >>> import eeruf
            >>> eeruf.Adaptation([eeruf.tables.TABLE_I_D], t_delta_us=999).max_speed_m_s(t_delta_us=999)
            1.382
        """

_Point = tuple[float, float] | Sequence[float] | NDArray[np.float64]
_Axis = _Pose | Sequence[float] | NDArray[np.float64]

@final
class Himm:
    """A certainty grid that range readings fill and clear while the robot drives: histogramic in-motion mapping
    (J. Borenstein and Y. Koren, IEEE T-RA 7(4), 1991).

    A reading counts only on the sensor's acoustic axis: the cell at the measured range gains 3, each cell on the way
    there loses 1, and values stay between 0 and 15. A real obstacle is met again and again and grows quickly; a phantom
    is met once and is cleared by the next readings that look past it.

    Args:
        side: how many cells the grid's window has on a side, 1 to 4096.
        cell_m: how wide a cell is, in metres, above 0.
        growth: whether cells beside certain ones grow faster (the paper's growth rate operator, for fast robots).

    Raises:
        ArgumentError: something of the wrong type or out of range.

    Example:
        >>> from eeruf import nav
        >>> grid = nav.Himm()
        >>> grid.echo((0.05, 0.05, 0.0), range_m=1.0)
        >>> grid.value((1.05, 0.05)), grid.value((9.0, 0.0))
        (3, None)
    """
    def __new__(cls, side: _Int = 33, cell_m: float = 0.1, *, growth: bool = False) -> Himm: ...
    @property
    def side(self) -> int:
        """Number of cells the window has on a side."""
    @property
    def cell_m(self) -> float:
        """Width of a cell, in metres."""
    @property
    def growth(self) -> bool:
        """Returns true if cells beside certain ones grow faster."""
    @property
    def extent_m(self) -> tuple[float, float, float, float]:
        """Extent of the window: (least x, greatest x, least y, greatest y) in metres, as ``imshow`` takes it."""
    def move_to(self, place: _Point) -> None:
        """Move the window so that a place is in its middle cell. Cells that leave it are forgotten, those that enter are
        empty.

        Args:
            place: (x, y) in metres.

        Raises:
            ArgumentError: no such place.

        Example:
            >>> from eeruf import nav
            >>> grid = nav.Himm()
            >>> grid.move_to((9.05, 0.05))
            >>> grid.value((9.0, 0.0)), grid.value((0.0, 0.0))
            (0, None)
        """
    def echo(self, sensor: _Axis, range_m: float, near_m: float = 0.0) -> None:
        """Enter an echo: an obstacle on a sensor's axis, and nothing before it.

        Args:
            sensor: its place and heading (x, y, heading) in metres and radians.
            range_m: how far the obstacle is, in metres, 0 to 1,000.
            near_m: cells nearer than this, where the sensor is deaf, are left as they are.

        Raises:
            ArgumentError: no such place or range.

        Example:
            >>> from eeruf import nav
            >>> grid = nav.Himm()
            >>> for _ in range(9):
            ...     grid.echo((0.0, 0.0, 1.57), range_m=1.0)
            >>> grid.cells().round(2).tolist()
            [[0.05, 0.95, 15.0]]
        """
    def clear(self, sensor: _Axis, range_m: float, near_m: float = 0.0) -> None:
        """Enter that nothing is on a sensor's axis.

        Args:
            sensor: its place and heading (x, y, heading) in metres and radians.
            range_m: as far as that, in metres, 0 to 1,000.
            near_m: cells nearer than this, where the sensor is deaf, are left as they are.

        Raises:
            ArgumentError: no such place or range.

        Example:
            >>> from eeruf import nav
            >>> grid = nav.Himm()
            >>> grid.echo((0.05, 0.05, 0.0), range_m=1.0)
            >>> grid.clear((0.05, 0.05, 0.0), range_m=1.5)
            >>> grid.value((1.05, 0.05))
            2
        """
    def enter(
        self,
        readings: Readings,
        range_m: float = 3.0,
        near_m: float = 0.0,
        *,
        robot: _Int = 0,
        sound_m_s: float = 343.2,
    ) -> None:
        """Enter what a simulation's ring reads, from where each sensor really stood: accepted echoes up to a range as
        obstacles; farther ones, and that nothing is there, clear the way.

        Args:
            readings: of ``Simulation.step``.
            range_m: how far the grid is filled, in metres, 0 to 1,000.
            near_m: cells nearer than this, where the sensors are deaf, are left as they are.
            robot: whose readings, from 0.
            sound_m_s: the speed of sound, in m/s, 100 to 1000.

        Raises:
            ArgumentError: no readings, or out of range.

        Example:
            >>> from eeruf import nav, sim
            >>> robot = sim.Robot((0, 0, 1.57), sensors=8, spacing_rad=0.26, radius_m=0.3)
            >>> world = sim.Simulation(sim.Scene([[5, 1.5, -5, 1.5]], robots=[robot]))
            >>> grid = nav.Himm()
            >>> grid.enter(world.step(1.0), range_m=2.0)
            >>> x, y, value = grid.cells().T
            >>> bool(1.4 < y[value == 15].min() <= y.max() < 1.7)
            True
        """
    def value(self, point: _Point) -> int | None:
        """The certainty of the cell that holds a point.

        Args:
            point: (x, y) in metres.

        Returns:
            0 to 15, or None outside the window.

        Raises:
            ArgumentError: no point.

        Example:
            >>> from eeruf import nav
            >>> nav.Himm().value((0.0, 0.0))
            0
        """
    def cells(self) -> NDArray[np.float64]:
        """The cells that are not empty.

        Returns:
            Array of shape (n, 3), float64: x, y (m) of the cell's middle, and its certainty, 1 to 15.

        Example:
            >>> from eeruf import nav
            >>> nav.Himm().cells().shape
            (0, 3)
        """
    def to_numpy(self) -> NDArray[np.int8]:
        """The whole window as a picture, for ``imshow(grid.to_numpy(), extent=grid.extent_m, origin="lower")``.

        Returns:
            Array of shape (side, side), int8: a row for each y, from the least; certainties 0 to 15.

        Example:
            >>> from eeruf import nav
            >>> grid = nav.Himm(side=3)
            >>> grid.echo((0.05, 0.05, 0.0), range_m=0.1)
            >>> grid.to_numpy().tolist()
            [[0, 0, 0], [0, 0, 3], [0, 0, 0]]
        """

@final
class Vfh:
    """The vector field histogram (J. Borenstein and Y. Koren, IEEE T-RA 7(3), 1991): from a certainty grid to where to
    steer and how fast to go.

    The cells around the robot become a histogram of obstacle density over 72 sectors of 5 degrees; among its valleys
    the one nearest the target is steered for. Directions are in the scene's frame, counter-clockwise.

    Args:
        window: how many cells the active window has on a side, 1 to 4096.
        smoothing: over how many sectors to either side the histogram is smoothed (the paper's l), 0 to 35.
        threshold: a sector with a lower density is free; densities are in units of a fully certain cell beside the
            robot. The default suits robots about 0.8 m wide; smaller ones want more.
        wide: a valley of more sectors is wide (s_max), 1 to 72.
        density_max: the density ahead at which the robot goes no faster than ``speed_min_m_s`` (h_m).
        speed_max_m_s: V_max, in m/s.
        speed_min_m_s: V_min, in m/s.
        turn_max_rad_s: the rate of turn at which it goes no faster than ``speed_min_m_s`` (Omega_max), in rad/s.

    Raises:
        ArgumentError: something of the wrong type or out of range.

    Example:
        >>> from eeruf import nav
        >>> grid = nav.Himm()
        >>> for _ in range(5):
        ...     grid.echo((0.05, 0.05, 0.0), range_m=0.6)  # something stands ahead
        >>> steering = nav.Vfh().steer(grid, place=(0.05, 0.05), target=(5.0, 0.0))
        >>> 0.3 < abs(steering.direction_rad) < 1.2, steering.trapped
        (True, False)
    """
    def __new__(
        cls,
        *,
        window: _Int = 33,
        smoothing: _Int = 5,
        threshold: float = 0.35,
        wide: _Int = 18,
        density_max: float = 3.0,
        speed_max_m_s: float = 1.0,
        speed_min_m_s: float = 0.04,
        turn_max_rad_s: float = 2.0943951023931953,
    ) -> Vfh: ...
    @property
    def window(self) -> int:
        """Number of cells the active window has on a side."""
    @property
    def smoothing(self) -> int:
        """Over how many sectors to either side the histogram is smoothed."""
    @property
    def threshold(self) -> float:
        """A sector with a lower density is free."""
    @property
    def wide(self) -> int:
        """A valley of more sectors is wide."""
    @property
    def density_max(self) -> float:
        """The density ahead at which the robot goes no faster than its lowest speed."""
    @property
    def speed_max_m_s(self) -> float:
        """The highest speed, in m/s."""
    @property
    def speed_min_m_s(self) -> float:
        """The lowest speed, in m/s."""
    @property
    def turn_max_rad_s(self) -> float:
        """The rate of turn at which it goes no faster than its lowest speed, in rad/s."""
    def histogram(self, grid: Himm, place: _Point) -> NDArray[np.float64]:
        """The smoothed histogram around a place.

        Args:
            grid: an ``eeruf.nav.Himm``.
            place: (x, y) in metres.

        Returns:
            Array of 72 densities, float64; sector k begins at k times 5 degrees.

        Raises:
            ArgumentError: no grid or no place.

        Example:
            >>> from eeruf import nav
            >>> grid = nav.Himm()
            >>> grid.echo((0.05, 0.05, 0.0), range_m=1.0)
            >>> int(nav.Vfh(smoothing=0).histogram(grid, (0.05, 0.0)).argmax())
            0
        """
    def steer(self, grid: Himm, place: _Point, target: _Point) -> Steering | None:
        """Where to steer from a place to come to a target.

        Args:
            grid: an ``eeruf.nav.Himm``.
            place: where the robot is, (x, y) in metres.
            target: where to, (x, y) in metres.

        Returns:
            A ``Steering``, or None if every direction is blocked.

        Raises:
            ArgumentError: no grid or no point.

        Example:
            >>> from eeruf import nav
            >>> nav.Vfh().steer(nav.Himm(), place=(0, 0), target=(5, 0))
            Steering(direction_rad=0.0, valley=(0, 72), trapped=False)
        """
    def drive(
        self, grid: Himm, pose: _Axis, target: _Point, turn_rad_s: float = 0.0, *, turn_gain: float = 3.0
    ) -> tuple[float, float]:
        """Drives from a pose to a target, for ``Simulation.set_velocity``: the farther off the heading, the slower. Where
        every way is blocked it stands and looks around.

        Args:
            grid: an ``eeruf.nav.Himm``.
            pose: where the robot is, (x, y, heading) in metres and radians.
            target: where to, (x, y) in metres.
            turn_rad_s: how fast it turns now, in rad/s, -50 to 50.
            turn_gain: what a steering error of a radian asks for, in rad/s, 0 to 100.

        Returns:
            The speed ahead in m/s, and the rate of turn in rad/s.

        Raises:
            ArgumentError: no grid, no pose, no point, or out of range.

        Example:
            >>> from eeruf import nav
            >>> nav.Vfh().drive(nav.Himm(), pose=(0, 0, 0), target=(5, 0))
            (1.0, 0.0)
        """

@final
class Steering:
    """Where to steer.

    Example:
        >>> from eeruf import nav
        >>> steering = nav.Vfh().steer(nav.Himm(), place=(0, 0), target=(0, 5))
        >>> round(steering.direction_rad, 3), steering.trapped
        (1.571, False)
    """
    def __new__(cls, direction_rad: float, valley: tuple[int, int] = (0, 72), trapped: bool = False) -> Steering: ...
    @property
    def direction_rad(self) -> float:
        """The direction, in radians of the scene, counter-clockwise from the x axis."""
    @property
    def valley(self) -> tuple[int, int]:
        """The valley that was chosen: its first sector, and how many it has; 72 if nothing is near."""
    @property
    def trapped(self) -> bool:
        """True if the direction leads away from the target, by more than 90 degrees: the robot is in a dead end, or soon
        will be.
        """
    def to_dict(self) -> dict[str, object]:
        """Its fields by their names: a dict of plain values.

        Example:
            >>> from eeruf import nav
            >>> nav.Vfh().steer(nav.Himm(), place=(0, 0), target=(5, 0)).to_dict()
            {'direction_rad': 0.0, 'valley': [0, 72], 'trapped': False}
        """
    def __eq__(self, other: object, /) -> bool: ...
    def __ne__(self, other: object, /) -> bool: ...

@final
class Material:
    """The surface of a wall or a pole.

    Args:
        reflection: the share of the pressure that a flat piece returns, 0 to 1.
        roughness_m: the root-mean-square height of the surface, in metres.

    Raises:
        ArgumentError: a number out of range.

    Example:
        >>> from eeruf import sim
        >>> sim.Scene([[5, 2, -5, 2]], materials=sim.Material(0.6, roughness_m=0.0002)).materials[0].reflection
        0.6
    """
    def __new__(cls, reflection: float, roughness_m: float = 0.0) -> Material: ...
    @property
    def reflection(self) -> float:
        """The share of the pressure that a flat piece returns."""
    @property
    def roughness_m(self) -> float:
        """The root-mean-square height of the surface, in metres."""
    def __eq__(self, other: object, /) -> bool: ...
    def __ne__(self, other: object, /) -> bool: ...

_Surface = Literal["smooth", "painted", "soft", "perfect"] | Material

@final
class Noise:
    """Noise of a scene.

    Args:
        fading_db_rms: rms change of each arrival's level, in dB, 0 to 20.
        jitter_us_rms: rms error of each arrival's time, in microseconds, 0 to 10,000.
        bursts_per_s: how many bursts from outside are heard in a second, 0 to 10,000.
        burst_db: how far they are above what is just heard, in dB, -200 to 200.

    Raises:
        ArgumentError: a number out of range.

    Example:
        >>> from eeruf import sim
        >>> sim.Scene([[5, 2, -5, 2]], noise=sim.Noise(bursts_per_s=5.0)).noise.bursts_per_s
        5.0
    """
    def __new__(
        cls,
        *,
        fading_db_rms: float = 1.5,
        jitter_us_rms: float = 15.0,
        bursts_per_s: float = 0.0,
        burst_db: float = 20.0,
    ) -> Noise: ...
    @property
    def fading_db_rms(self) -> float:
        """Fading of each arrival's level, root mean square, in dB."""
    @property
    def jitter_us_rms(self) -> float:
        """Jitter of each arrival, root mean square, in microseconds."""
    @property
    def bursts_per_s(self) -> float:
        """Number of bursts from outside that are heard in a second."""
    @property
    def burst_db(self) -> float:
        """Level above what is just heard, in dB."""
    def __eq__(self, other: object, /) -> bool: ...
    def __ne__(self, other: object, /) -> bool: ...

@type_check_only
class _RobotChanges(TypedDict, total=False):
    pose: _Pose
    sensors: _Int | Iterable[_Pose] | None
    spacing_rad: float | None
    radius_m: float | None
    module: _Module | Sequence[_Module]
    gain: _Gain
    period_us: _Int
    t_delta_us: _Int | Iterable[_Int]
    window_us: _Int | Iterable[_Int]
    blanking_us: _Int | Iterable[_Int] | None
    min_refire_us: _Int
    start_us: _Int
    schedule: Schedule | None
    neighbours: _Int
    consecutive: _Int
    odometry: bool
    velocity_m_s: tuple[float, float] | None
    turn_rad_s: float | None
    waypoints_m: ArrayLike | None
    speed_m_s: float | None
    clock_offset_us: _Int
    clock_drift_ppm: float
    body: _Body | None
    beam: _Beam | None
    coupling_db: float | None
    height_m: float | Iterable[float]
    together: Iterable[Iterable[_Int]]
    transducer: _Module | Sequence[_Module] | None
    audible_us: _Int | None
    path_change_us: _Int | None
    firing: dict[str, object] | None
    ring: str | PathLike[str] | None
    fleet_number: _Int

@final
class Robot:
    """A robot with a ring of sensors, on an arc whose middle is ahead or wherever you put them.

    Args:
        pose: (x, y, heading) in metres and radians, counter-clockwise from the x axis.
        sensors: how many on an arc, 1 to 64; or where each one is on the robot, as (x, y, heading). None where the ring
            file says it.
        spacing_rad: the angle from one sensor to the next on the arc, in radians.
        radius_m: the radius of the arc, in metres.
        module: of its sensors: a name such as ``"hc-sr04"``, a dict of what differs from one, such as
            ``{"like": "hc-sr04", "sees_to_m": 2.5}``, or a list of one for each sensor; docs/reference/modules.md has
    them all.
        gain: how the receiver's gain grows while it listens: ``"constant"``, ``"square_root"``, ``"linear"``,
            ``"stepped"`` or ``"polaroid_6500"``, the steps of that module's control circuit.
        beam: the pattern near 90 degrees off a sensor's axis: ``"cut_at_90"``, an endless baffle with nothing behind,
            or ``"continuous"``, a baffle that ends; None for the module's own, ``"cut_at_90"`` of the
            Polaroid 6500 and ``"continuous"`` of the HC-SR04.
        coupling_db: the level of the sound that the mounting carries straight from sensor to sensor, relative to two
            that face each other as far apart, -200 to 0; None for what the patterns say.
        height_m: of its sensors above the floor, one for all or one each, in metres; for scenes that are not flat.
        body: its outline, which others' sound is reflected and shaded by: the radius of a disc, (length, width) of a
            box, or 3 to 8 corners (x, y) of a convex polygon, counter-clockwise, all in metres; None for none.
        period_us: ``T_p`` of the methods that bring no schedule of their own; the schedule's if there is one.
        t_delta_us: ``T_delta``: consecutive readings that differ by no more are near-identical; one for all, or a list
            of one for each sensor, for the robot's own schedule.
        window_us: ``T_wind``: how long a sensor listens; one for all, or a list as well.
        together: sets of sensors that the robot's own schedule fires at once, such as ``[[8, 9], [10, 11]]``.
        blanking_us: how long a sensor is deaf after it has fired, one for all or a list; the module's own unless it is
            given.
        min_refire_us: with immediate refiring, how long a sensor rests between its echo and its next firing.
        audible_us: how long sound is heard after it was sent, as far as methods that fire one by one allow for it; what
            its modules say where ``module`` is given, or else no longer than sensors listen.
        path_change_us: P: the largest change of a foreign sound's path from one reading to the next, where
            a table fires the ring, at most 65,534 us; None for ``t_delta_us``.
        ring: the path of a ring file, for ``eeruf design``, that gives modules, windows, ``T_delta``, sensors that fire
            together, neighbours, ``path_change_us`` and ``audible_us``, unless these are given here.
        firing: a dict with the keys of ``[firing]`` in scene files, such as ``{"turn_us": 33_000}``, for the methods
            that fire as sketches and modules do.
        start_us: when the ring begins to fire, by its own clock.
        schedule: what the EERUF methods fire by; None for the paper's table, scaled to the period.
        neighbours: how many adjacent sensors must not fire close together, 1 to 64.
        consecutive: how many readings in a row must agree, 2 to 8.
        odometry: whether the robot hands its ring the changes that its own motion should cause.
        velocity_m_s: (x, y) in the scene's frame, which it keeps for ever, in m/s.
        turn_rad_s: the rate of turn that it keeps, in rad/s.
        waypoints_m: points (x, y) that it drives through in straight lines, instead of a velocity.
        speed_m_s: how fast it does so, in m/s.
        clock_offset_us: what its clock shows at the start.
        transducer: an older name of ``module``.
        clock_drift_ppm: rate error of its clock, positive if fast, in millionths.
        fleet_number: its number among robots of one make, 0 to 255, by which flow tells six of them apart.

    Raises:
        ArgumentError: something of the wrong type or out of range, or two kinds of motion at once.

    Example:
        >>> from eeruf import sim
        >>> sim.Robot((0.0, 0.0, 1.57), sensors=8, spacing_rad=0.26, radius_m=0.3).period_us
        60000
        >>> sim.Robot((0, 0, 0), sensors=[(0.1, 0.1, 0.5), (0.1, -0.1, -0.5)], module="hc-sr04").sensors
        2
    """
    def __new__(
        cls,
        pose: _Pose,
        sensors: _Int | Iterable[_Pose] | None = None,
        spacing_rad: float | None = None,
        radius_m: float | None = None,
        module: _Module | Sequence[_Module] = "polaroid-6500",
        *,
        gain: _Gain = "constant",
        period_us: _Int = 60000,
        t_delta_us: _Int | Iterable[_Int] = 500,
        window_us: _Int | Iterable[_Int] = 36000,
        blanking_us: _Int | Iterable[_Int] | None = None,
        min_refire_us: _Int = 36000,
        start_us: _Int = 0,
        schedule: Schedule | None = None,
        neighbours: _Int = 4,
        consecutive: _Int = 2,
        odometry: bool = False,
        velocity_m_s: tuple[float, float] | None = None,
        turn_rad_s: float | None = None,
        waypoints_m: ArrayLike | None = None,
        speed_m_s: float | None = None,
        clock_offset_us: _Int = 0,
        clock_drift_ppm: float = 0.0,
        body: _Body | None = None,
        beam: _Beam | None = None,
        coupling_db: float | None = None,
        height_m: float | Iterable[float] = 0.3,
        together: Iterable[Iterable[_Int]] = (),
        transducer: _Module | Sequence[_Module] | None = None,
        audible_us: _Int | None = None,
        path_change_us: _Int | None = None,
        firing: dict[str, object] | None = None,
        ring: str | PathLike[str] | None = None,
        fleet_number: _Int = 0,
    ) -> Robot: ...
    def replace(self, **changes: Unpack[_RobotChanges]) -> Robot:
        """The same robot, but for these arguments.

        Args:
            changes: arguments of ``Robot``, by name.

        Raises:
            ArgumentError: as for ``Robot``.

        Example:
            >>> from eeruf import sim
            >>> sim.Robot((0, 0, 0), 8, 0.26, 0.3).replace(t_delta_us=100).t_delta_us
            100
        """
    @property
    def pose(self) -> _Pose:
        """(x, y, heading) in metres and radians."""
    @property
    def sensors(self) -> int:
        """Number of sensors."""
    @property
    def sensor_poses(self) -> list[_Pose]:
        """Where each sensor is on the robot: (x, y, heading) in metres and radians."""
    @property
    def spacing_rad(self) -> float | None:
        """The angle from one sensor to the next, in radians; None for sensors at places of their own."""
    @property
    def radius_m(self) -> float | None:
        """The radius of the arc, in metres; None for sensors at places of their own."""
    @property
    def module(self) -> _Module | list[_Module]:
        """The module of its sensors: a name, a dict of figures, or a list of these, one for each sensor."""
    @property
    def together(self) -> list[list[int]]:
        """Sets of sensors that the robot's own schedule fires at once."""
    @property
    def gain(self) -> _Gain:
        """Growth of the receiver's gain while it listens; the first sensor's where they differ."""
    @property
    def beam(self) -> _Beam:
        """The pattern near 90 degrees off a sensor's axis."""
    @property
    def coupling_db(self) -> float | None:
        """The level of the sound that the mounting carries straight from sensor to sensor, in dB; None for what the
        patterns say.
        """
    @property
    def height_m(self) -> list[float]:
        """The height of its sensors above the floor in metres, one each."""
    @property
    def body(self) -> _Body | None:
        """Its outline: the radius of a disc, (length, width) of a box, or the corners of a polygon; None without."""
    @property
    def period_us(self) -> int:
        """``T_p`` of the methods that bring no schedule of their own, in microseconds."""
    @property
    def t_delta_us(self) -> int | list[int]:
        """``T_delta``, in microseconds; a list of one for each sensor where they have their own."""
    @property
    def window_us(self) -> int | list[int]:
        """Listening time of a sensor, in microseconds; a list of one for each sensor where they have their own."""
    @property
    def blanking_us(self) -> int | list[int]:
        """Deaf time of a sensor after it has fired, in microseconds; a list of one for each sensor where they differ."""
    @property
    def min_refire_us(self) -> int:
        """Rest of a sensor between its echo and its next firing, in microseconds."""
    @property
    def audible_us(self) -> int:
        """Time for which sound is heard after it was sent, in microseconds; 0 for as long as sensors listen."""
    @property
    def path_change_us(self) -> int | None:
        """Change of a foreign sound's path from one reading to the next, in microseconds; None for ``t_delta_us``."""
    @property
    def firing(self) -> dict[str, object]:
        """Firing by sketches and modules: a dict of what differs from the default."""
    @property
    def start_us(self) -> int:
        """When the ring begins to fire, in microseconds."""
    @property
    def schedule(self) -> Schedule | None:
        """Schedule of the EERUF methods; None for the paper's table."""
    @property
    def neighbours(self) -> int:
        """Number of adjacent sensors that must not fire close together."""
    @property
    def consecutive(self) -> int:
        """Number of readings in a row that must agree."""
    @property
    def odometry(self) -> bool:
        """Returns true if the ring knows by how much its own motion should change readings."""
    @property
    def velocity_m_s(self) -> tuple[float, float] | None:
        """The velocity that it keeps, (x, y) in m/s; None for a robot that stands or drives through waypoints."""
    @property
    def turn_rad_s(self) -> float | None:
        """The rate of turn that it keeps, in rad/s; None for a robot that stands or drives through waypoints."""
    @property
    def waypoints_m(self) -> list[tuple[float, float]] | None:
        """The points that it drives through, (x, y) in metres; None without."""
    @property
    def speed_m_s(self) -> float | None:
        """Speed through its waypoints, in m/s; None without."""
    @property
    def clock_offset_us(self) -> int:
        """Its clock at the start, in microseconds."""
    @property
    def clock_drift_ppm(self) -> float:
        """Drift of its clock (positive: too fast), in millionths."""
    @property
    def fleet_number(self) -> int:
        """Its number among robots of one make, by which flow tells them apart."""
    def __eq__(self, other: object, /) -> bool: ...
    def __ne__(self, other: object, /) -> bool: ...

@type_check_only
class _SceneChanges(TypedDict, total=False):
    walls: ArrayLike
    open: Iterable[_Int] | None
    two_sided: Iterable[_Int] | None
    poles: ArrayLike | None
    materials: _Surface | Iterable[_Surface] | None
    pole_materials: _Surface | Iterable[_Surface] | None
    temperature_c: float
    humidity_percent: float
    pressure_kpa: float
    robots: Sequence[Robot]
    noise: bool | Noise
    seed: _Int
    max_order: _Int
    physics: _Physics
    height: _Height
    faults: Iterable[_Fault]

@final
class Scene:
    """Walls, poles and robots from above, in metres. Immutable; scenes pickle.

    A wall reflects on its left side, seen from its first end to its second, and its back swallows: a room is a loop
    walked counter-clockwise, a pillar one walked clockwise.

    Args:
        walls: array of shape (n, 4): x, y of one end and x, y of the other.
        open: indices of openings, from which nothing comes back.
        two_sided: indices of walls that reflect on both sides.
        poles: array of shape (m, 3): x, y and radius.
        materials: of the walls, one for all or one each: ``"smooth"``, ``"painted"``, ``"soft"``, ``"perfect"`` or a
            :class:`Material`; smooth unless given.
        pole_materials: of the poles, likewise.
        temperature_c: of the air, in degrees Celsius, -100 to 100; the speed of sound depends on it.
        humidity_percent: of the air, 0 to 100.
        pressure_kpa: of the air.
        robots: the robots that :func:`simulate` drives.
        noise: True for a little jitter and fading, False for none, or a :class:`Noise`.
        seed: of the noise, 0 to 2^64 - 1.
        max_order: how many bounces :func:`simulate` follows; 6 unless it is given.
        physics: ``"plain"``, ``"default"``, or a dict of what differs from a ``preset``: ``shadows``, ``edges``,
            ``narrow_panels``, ``range_walk``, ``interference`` (each True or False), ``fading_time_s``; see
    ``docs/explanation/physics.md``.
        height: ``"flat"``, all sound in one plane; ``"room"``, between a floor and a ceiling at 2.6 m; or a dict of
            what differs from that room: ``ceiling_m``, and ``floor`` and ``ceiling`` as in ``materials``.
        faults: what goes wrong, dicts with the keys of ``[[fault]]`` in scene files, such as
            ``{"kind": "cut", "sensors": [2], "from_s": 3.0}``; docs/how-to/simulate.md has them all.

    Raises:
        ArgumentError: an array of the wrong shape, an index of no wall, something of the wrong type or out of range.
        SceneError: walls that cross, have no length or are not finite, or a robot where none can stand.

    Example:
        >>> from eeruf import sim
        >>> scene = sim.Scene([[0.85, 0, 0.85, 1.39], [0.85, 1.39, -0.85, 1.39], [-0.85, 1.39, -0.85, 0]])
        >>> scene
        <Scene: 3 walls, 0 poles, 0 robots>
    """
    def __new__(
        cls,
        walls: ArrayLike,
        open: Iterable[_Int] | None = None,
        two_sided: Iterable[_Int] | None = None,
        poles: ArrayLike | None = None,
        *,
        materials: _Surface | Iterable[_Surface] | None = None,
        pole_materials: _Surface | Iterable[_Surface] | None = None,
        temperature_c: float = 20.0,
        humidity_percent: float = 50.0,
        pressure_kpa: float = 101.325,
        robots: Sequence[Robot] = (),
        noise: bool | Noise = True,
        seed: _Int = 1,
        max_order: _Int = 6,
        physics: _Physics = "default",
        height: _Height = "flat",
        faults: Iterable[_Fault] = (),
    ) -> Scene: ...
    @staticmethod
    def read_toml(path: str | PathLike[str]) -> Scene:
        """Read a scene file, such as those in the folder ``scenes``.

        Args:
            path: of the file; a schedule that it names is looked for beside it.

        Raises:
            ArgumentError: not a path.
            SceneError: no such file, or it says something that makes no scene: by name, value and what is expected.

        Example:
            >>> import eeruf, pathlib, tempfile
            >>> file = pathlib.Path(tempfile.mkdtemp(), "alcove.toml")
            >>> _ = file.write_text(eeruf.example("scenes/alcove.toml"))
            >>> len(eeruf.sim.Scene.read_toml(file).walls)
            3
        """
    @staticmethod
    def from_toml(text: str) -> Scene:
        r"""A scene out of the text of a scene file, as :meth:`to_toml` writes it.

        Args:
            text: the contents of a file; a schedule that it names is looked for in the present folder.

        Raises:
            ArgumentError: not a text.
            SceneError: it says something that makes no scene: by name, value and what is expected.

        Example:
            >>> from eeruf import sim
            >>> sim.Scene.from_toml("[[pole]]\nat_m = [1, 2]\nradius_m = 0.05").poles.tolist()
            [[1.0, 2.0, 0.05]]
        """
    def to_toml(self) -> str:
        """Write a scene file that says all this: it gives the same readings, in Python and in the program.

        Example:
            >>> from eeruf import sim
            >>> scene = sim.Scene([[5, 2, -5, 2]], robots=[sim.Robot((0, 0, 1.57), 8, 0.26, 0.3)])
            >>> sim.Scene.from_toml(scene.to_toml()).to_toml() == scene.to_toml()
            True
        """
    def replace(self, **changes: Unpack[_SceneChanges]) -> Scene:
        """The same scene, but for these arguments.

        Args:
            changes: arguments of ``Scene``, by name. Other walls or poles have the default materials, unless those are
                given too, and no openings.

        Raises:
            ArgumentError: as for ``Scene``.
            SceneError: as for ``Scene``.

        Example:
            >>> from eeruf import sim
            >>> scene = sim.Scene([[5, 2, -5, 2]], seed=3).replace(temperature_c=0.0)
            >>> scene.temperature_c, scene.seed
            (0.0, 3)
        """
    @property
    def faults(self) -> list[_Fault]:
        """Faults: dicts with the keys of ``[[fault]]`` in scene files."""
    @property
    def walls(self) -> _Floats:
        """The walls: array of shape (n, 4), as given."""
    @property
    def open(self) -> list[int]:
        """The indices of the openings, from which nothing comes back."""
    @property
    def two_sided(self) -> list[int]:
        """The indices of the walls that reflect on both sides."""
    @property
    def poles(self) -> _Floats:
        """The poles: array of shape (m, 3) of x, y and radius in metres."""
    @property
    def materials(self) -> list[Material]:
        """The material of each wall, a list of ``Material``."""
    @property
    def pole_materials(self) -> list[Material]:
        """The material of each pole, a list of ``Material``."""
    @property
    def temperature_c(self) -> float:
        """The temperature of the air, in degrees Celsius."""
    @property
    def humidity_percent(self) -> float:
        """The humidity of the air, in percent."""
    @property
    def pressure_kpa(self) -> float:
        """The pressure of the air, in kilopascals."""
    @property
    def robots(self) -> tuple[Robot, ...]:
        """The robots, a tuple of ``Robot``."""
    @property
    def noise(self) -> Noise:
        """Its noise, a ``Noise``."""
    @property
    def seed(self) -> int:
        """Seed of all that is random."""
    @property
    def max_order(self) -> int:
        """Number of bounces that :func:`simulate` follows."""
    @property
    def physics(self) -> _Physics:
        """Effects that are simulated: a preset's name, or a dict."""
    @property
    def height(self) -> _Height:
        """Floor and ceiling: ``"flat"`` without, ``"room"`` for the default, or a dict."""
    def paths(
        self,
        source: ArrayLike,
        receivers: ArrayLike,
        max_order: _Int,
        max_length_m: float | None = None,
        *,
        progress: _Progress = None,
    ) -> Paths:
        """Every path from a source to some receivers, exactly, without the interpreter lock. Ctrl-C ends it.

        The paths are those that :func:`simulate` knows: under the scene's ``physics`` nothing runs through a thick
        pole, edges diffract, and narrow walls return less. With ``physics="plain"`` they are the specular ones alone.
        Amplitudes are for the first robot's transducers, or for a Polaroid 6500 where there is no robot.

        Args:
            source: (x, y) in metres, or (x, y, height) in a scene that is not flat; 0.3 m high unless it says so.
            receivers: array of shape (n, 2) or (n, 3), or one point, likewise.
            max_order: the most bounces, 0 to 1000; those at poles, floor and ceiling count. Of the last two a path has
                4 at most.
            max_length_m: the longest path, in metres, above 0; None for any length.
            progress: True for a bar (tqdm if it is installed), or a callable that takes None and a text now and then.

        Returns:
            The paths as arrays, sorted by receiver and then by length.

        Raises:
            ArgumentError: something of the wrong type, shape or range.
            PathsError: a point that is not finite, far from all walls or inside something solid, too high an order, or
                too many paths to keep.

        Example:
            >>> from eeruf import sim
            >>> wall = sim.Scene([[5, 2, -5, 2]], physics="plain")
            >>> paths = wall.paths(source=(0, 0), receivers=[(3, 0)], max_order=1)
            >>> paths.order.tolist(), paths.length_m.tolist()
            ([0, 1], [3.0, 5.0])
        """
    def _repr_svg_(self) -> str: ...

@final
class Paths:
    """Every path from a source to some receivers: arrays of equal length, sorted by receiver and then by length. The
    arrays are read-only.

    Example:
        >>> from eeruf import sim
        >>> paths = sim.Scene([[5, 2, -5, 2]], physics="plain").paths((0, 0), [(3, 0)], max_order=1)
        >>> len(paths), paths.walls
        (2, [(), (0,)])
    """
    @property
    def receiver(self) -> NDArray[np.int64]:
        """The index of the receiver: int64."""
    @property
    def length_m(self) -> NDArray[np.float64]:
        """The length in metres: float64."""
    @property
    def order(self) -> NDArray[np.int64]:
        """Number of bounces, those at poles included: int64."""
    @property
    def departure_rad(self) -> NDArray[np.float64]:
        """The direction in which the path leaves the source, in (-pi, pi]: float64."""
    @property
    def arrival_rad(self) -> NDArray[np.float64]:
        """The direction in which the receiver looks to see it, in (-pi, pi]: float64."""
    @property
    def amplitude(self) -> NDArray[np.float64]:
        """The amplitude relative to 1 m in free air, without the transducers' patterns: float64."""
    @property
    def departure_elevation_rad(self) -> NDArray[np.float64]:
        """The elevation at which the path leaves the source, in radians, upwards positive; 0 in a flat scene: float64."""
    @property
    def arrival_elevation_rad(self) -> NDArray[np.float64]:
        """The elevation at which the receiver looks to see it, in radians, upwards positive; 0 in a flat scene: float64."""
    @property
    def walls(self) -> list[tuple[int, ...]]:
        """For each path its bounces from source to receiver, a list of tuples: a wall by its index, a pole by -1 minus its
        index, an edge by 2^32 plus its index, the floor by 2^33 and the ceiling by one more. Those at floor and ceiling
        stand last, in their own order.
        """
    def points(self, path: _Int) -> NDArray[np.float64]:
        """The corners of a path in the plan, from source to receiver, those at floor and ceiling left out.

        Args:
            path: which one, from 0.

        Returns:
            Array of shape (n, 2), in metres; n is ``order + 2`` in a flat scene.

        Raises:
            ArgumentError: no such path.

        Example:
            >>> from eeruf import sim
            >>> wall = sim.Scene([[5, 2, -5, 2]], physics="plain")
            >>> wall.paths((0, 0), (3, 0), max_order=1).points(1).tolist()
            [[0.0, 0.0], [1.5, 2.0], [3.0, 0.0]]
        """
    def __len__(self, /) -> int: ...

@final
class Readings:
    """Every reading of a simulation: arrays of equal length, in the order in which the rings emitted them. Readings
    pickle.

    Each reading comes with what caused it and with what the sensor would have read alone. Times without a value are
    NaN. The arrays are read-only.

    Example:
        >>> from eeruf import sim
        >>> robot = sim.Robot((0, 0, 1.57), sensors=8, spacing_rad=0.26, radius_m=0.3)
        >>> readings = sim.simulate(sim.Scene([[5, 2, -5, 2]], robots=[robot]), periods=100)
        >>> len(readings), readings.summary().wrong_of_all < 0.01
        (800, True)
    """
    @property
    def method(self) -> _MethodName:
        """The method that was simulated, one of ``METHODS``."""
    @property
    def duration_s(self) -> float:
        """For how long, in seconds."""
    @property
    def sensors(self) -> int:
        """Number of sensors the scene has, of all robots together."""
    @property
    def robot(self) -> NDArray[np.int64]:
        """The robot, from 0: int64."""
    @property
    def sensor(self) -> NDArray[np.int64]:
        """The sensor on its ring, from 0: int64."""
    @property
    def period(self) -> NDArray[np.int64]:
        """The period in which it fired, from 0: int64."""
    @property
    def phase(self) -> NDArray[np.int64]:
        """The phase in which it fired, 0 for a and 1 for b: int64."""
    @property
    def fired_s(self) -> NDArray[np.float64]:
        """When it fired, in seconds: float64."""
    @property
    def x_m(self) -> NDArray[np.float64]:
        """Where the sensor stood when it fired, in metres of the scene: float64."""
    @property
    def y_m(self) -> NDArray[np.float64]:
        """Where the sensor stood when it fired, in metres of the scene: float64."""
    @property
    def heading_rad(self) -> NDArray[np.float64]:
        """The sensor's heading when it fired, in radians of the scene, counter-clockwise from the x axis: float64."""
    @property
    def kind(self) -> NDArray[np.int8]:
        """Verdict of the method, an index into ``eeruf.KINDS``: int8."""
    @property
    def t_echo_us(self) -> NDArray[np.float64]:
        """The echo time that the method reports, in microseconds: float64."""
    @property
    def earliest_us(self) -> NDArray[np.float64]:
        """The earliest echo of the firing, in microseconds: float64."""
    @property
    def reference_us(self) -> NDArray[np.float64]:
        """Reading of the sensor if it were alone in quiet air, in microseconds: float64."""
    @property
    def cause(self) -> NDArray[np.int8]:
        """Cause of ``t_echo_us``, an index into ``CAUSES``: int8."""
    @property
    def path(self) -> NDArray[np.int64]:
        """Along which of ``paths`` the sound came, an index, or -1 for none: int64."""
    @property
    def paths(self) -> HeardPaths:
        """Every path that some reading came along: a dict of arrays of equal length.

        ``emitter_robot``, ``emitter``, ``receiver_robot``, ``receiver`` count from 0; ``order`` is the number of
        bounces; ``length_m``, ``departure_rad`` and ``arrival_rad`` are in metres and radians of the scene; ``walls``
        is a list of tuples as in ``Paths``.
        """
    @property
    def emitted_s(self) -> NDArray[np.float64]:
        """When the sound behind ``t_echo_us`` was sent, in seconds: float64."""
    @property
    def expected_change_us(self) -> NDArray[np.int32]:
        """The change that odometry expects since the sensor's firing before, in microseconds; 0 without odometry: int32."""
    @property
    def is_accepted(self) -> NDArray[np.bool_]:
        """Returns true if the method accepts the reading, an echo or that nothing is in range: bool."""
    def is_wrong(self, tolerance_us: float = 500.0) -> NDArray[np.bool_]:
        """Returns true if what the reading says is wrong, accepted.

        Args:
            tolerance_us: largest difference from the reference, in microseconds.

        Returns:
            Array of bool.

        Raises:
            ArgumentError: the tolerance is negative or not a number.

        Example:
            >>> from eeruf import sim
            >>> robot = sim.Robot((0, 0, 1.57), sensors=8, spacing_rad=0.26, radius_m=0.3)
            >>> readings = sim.simulate(sim.Scene([[5, 2, -5, 2]], robots=[robot]), periods=100)
            >>> int(readings.is_wrong(tolerance_us=1e6).sum()) <= int(readings.is_wrong().sum())
            True
        """
    def summary(self, tolerance_us: float = 500.0) -> Summary:
        """The figures that are always reported together.

        Args:
            tolerance_us: largest difference of a reading from the reference, in microseconds.

        Returns:
            A ``Summary``.

        Raises:
            ArgumentError: the tolerance is negative or not a number.

        Example:
            >>> from eeruf import sim
            >>> robot = sim.Robot((0, 0, 1.57), sensors=8, spacing_rad=0.26, radius_m=0.3)
            >>> readings = sim.simulate(sim.Scene([[5, 2, -5, 2]], robots=[robot]), periods=100)
            >>> readings.summary().readings, readings.summary().wrong_of_all < 0.01
            (800, True)
        """
    def columns(self) -> dict[str, NDArray[np.float64 | np.int64 | np.int8]]:
        """All arrays, one entry for each reading, by their names: a dict.

        Example:
            >>> from eeruf import sim
            >>> robot = sim.Robot((0, 0, 1.57), sensors=8, spacing_rad=0.26, radius_m=0.3)
            >>> readings = sim.simulate(sim.Scene([[5, 2, -5, 2]], robots=[robot]), periods=100)
            >>> readings.columns()["t_echo_us"] is readings.t_echo_us
            True
        """
    def to_pandas(self) -> pd.DataFrame:
        """All arrays as a ``pandas.DataFrame``: ``kind`` and ``cause`` are categoricals with their names, ``path`` is null
        where there is none, and times without a value are NaN.

        Raises:
            ImportError: pandas is not installed.

        Example:
            >>> from eeruf import sim
            >>> robot = sim.Robot((0, 0, 1.57), sensors=8, spacing_rad=0.26, radius_m=0.3)
            >>> readings = sim.simulate(sim.Scene([[5, 2, -5, 2]], robots=[robot]), periods=100)
            >>> readings.to_pandas()["kind"].dtype.name
            'category'
        """
    def to_polars(self) -> pl.DataFrame:
        """All arrays as a ``polars.DataFrame``: ``kind`` and ``cause`` are enums with their names, and what has no value
        is null.

        Raises:
            ImportError: polars is not installed.

        Example:
            >>> from eeruf import sim
            >>> robot = sim.Robot((0, 0, 1.57), sensors=8, spacing_rad=0.26, radius_m=0.3)
            >>> readings = sim.simulate(sim.Scene([[5, 2, -5, 2]], robots=[robot]), periods=100)
            >>> readings.to_polars().columns[:3]
            ['robot', 'sensor', 'period']
        """
    def __arrow_c_stream__(self, requested_schema: object | None = None) -> object: ...
    def save(self, file: str | PathLike[str] | IO[bytes]) -> None:
        """Write everything into one file, from which :meth:`load` makes the same readings.

        Args:
            file: its path; NumPy's format ``.npz``, compressed.

        Raises:
            OSError: it cannot be written.

        Example:
            >>> import io
            >>> from eeruf import sim
            >>> robot = sim.Robot((0, 0, 1.57), sensors=8, spacing_rad=0.26, radius_m=0.3)
            >>> readings = sim.simulate(sim.Scene([[5, 2, -5, 2]], robots=[robot]), periods=100)
            >>> file = io.BytesIO()
            >>> readings.save(file)
            >>> _ = file.seek(0)
            >>> sim.Readings.load(file).summary() == readings.summary()
            True
        """
    @staticmethod
    def load(file: str | PathLike[str] | IO[bytes]) -> Readings:
        """Read what :meth:`save` wrote.

        Args:
            file: its path.

        Raises:
            OSError: it cannot be read.
            ArgumentError: it holds no readings.

        Example:
            >>> import pathlib, tempfile
            >>> from eeruf import sim
            >>> robot = sim.Robot((0, 0, 1.57), sensors=8, spacing_rad=0.26, radius_m=0.3)
            >>> file = pathlib.Path(tempfile.mkdtemp(), "readings.npz")
            >>> sim.simulate(sim.Scene([[5, 2, -5, 2]], robots=[robot]), periods=100).save(file)
            >>> len(sim.Readings.load(file))
            800
        """
    @staticmethod
    def concat(parts: Iterable[Readings]) -> Readings:
        """Join readings of consecutive steps or blocks, or of several robots' logs: all columns, and durations added up.

        Args:
            parts: readings of one method and of as many sensors each.

        Raises:
            ArgumentError: no readings, or of several methods or numbers of sensors.

        Example:
            >>> from eeruf import sim
            >>> robot = sim.Robot((0, 0, 1.57), sensors=8, spacing_rad=0.26, radius_m=0.3)
            >>> scene = sim.Scene([[5, 2, -5, 2]], robots=[robot])
            >>> blocks = sim.simulate_blocks(scene, periods=100, block_periods=30)
            >>> sim.Readings.concat(blocks).summary() == sim.simulate(scene, periods=100).summary()
            True
        """
    @staticmethod
    def from_arrays(
        sensor: ArrayLike,
        fired_s: ArrayLike,
        t_echo_us: ArrayLike,
        *,
        kind: ArrayLike | None = None,
        reference_us: ArrayLike | None = None,
        duration_s: float | None = None,
        sensors: _Int | None = None,
        method: _MethodName = "eeruf",
        **columns: Unpack[ReadingColumns],
    ) -> Readings:
        """Make readings of arrays of your own, such as those of a drive, so that they can be summed up and saved.

        Args:
            sensor: the sensor of each reading, from 0; others have as many entries.
            fired_s: when it fired, in seconds, in order.
            t_echo_us: the echo time, NaN for none.
            kind: what was made of it, indices into ``eeruf.KINDS``; by default echoes are accepted, silence is clear.
            reference_us: what the sensor reads alone; by default ``t_echo_us``, as if all were right.
            duration_s: for how long; by default until the last firing.
            sensors: how many sensors there are; by default one more than the last.
            method: one of ``METHODS``, as which they count.
            columns: any others of :meth:`columns`, by name.

        Raises:
            ArgumentError: no such column, arrays of several lengths, or values out of range.

        Example:
            >>> from eeruf import sim
            >>> found = sim.Readings.from_arrays([0, 1, 0], [0.0, 0.03, 0.06], [9_000, float("nan"), 9_040])
            >>> found.is_accepted.tolist(), found.sensors, found.summary().wrong_of_all
            ([True, True, True], 2, 0.0)
        """
    def to_xarray(self) -> xr.Dataset:
        """All arrays as an ``xarray.Dataset`` along ``reading``, with method, duration and sensors as attributes.

        Raises:
            ImportError: xarray is not installed.

        Example:
            >>> from eeruf import sim
            >>> robot = sim.Robot((0, 0, 1.57), sensors=8, spacing_rad=0.26, radius_m=0.3)
            >>> readings = sim.simulate(sim.Scene([[5, 2, -5, 2]], robots=[robot]), periods=100)
            >>> readings.to_xarray().sizes["reading"]
            800
        """
    def __getitem__(self, key: slice | ArrayLike, /) -> Readings: ...
    def __len__(self, /) -> int: ...

@final
class RobotState:
    """A robot of a ``Simulation``, now.

    Example:
        >>> from eeruf import sim
        >>> robot = sim.Robot((1, 0, 0), sensors=8, spacing_rad=0.26, radius_m=0.3)
        >>> sim.Simulation(sim.Scene([[5, 2, -5, 2]], robots=[robot])).robots[0].pose
        (1.0, 0.0, 0.0)
    """
    def __new__(
        cls,
        pose: tuple[float, float, float],
        velocity_m_s: tuple[float, float] = (0.0, 0.0),
        turn_rad_s: float = 0.0,
        touches: bool = False,
    ) -> RobotState: ...
    @property
    def pose(self) -> tuple[float, float, float]:
        """(x, y, heading) in metres and radians."""
    @property
    def velocity_m_s(self) -> tuple[float, float]:
        """Velocity along x and y, in m/s."""
    @property
    def turn_rad_s(self) -> float:
        """Rate of turn, counter-clockwise, in rad/s."""
    @property
    def touches(self) -> bool:
        """True if the disc that holds its sensors touches a wall or a pole."""
    def to_dict(self) -> dict[str, object]:
        """Its fields by their names: a dict of plain values.

        Example:
            >>> from eeruf import sim
            >>> robot = sim.Robot((1, 0, 0), sensors=8, spacing_rad=0.26, radius_m=0.3)
            >>> sim.Simulation(sim.Scene([[5, 2, -5, 2]], robots=[robot])).robots[0].to_dict()["pose"]
            [1.0, 0.0, 0.0]
        """
    def __eq__(self, other: object, /) -> bool: ...
    def __ne__(self, other: object, /) -> bool: ...

@final
class FiredReading:
    """Echoes that one firing of one sensor has heard, for a filter of one's own in a :class:`Simulation`.

    Example:
        >>> from eeruf import sim
        >>> heard = []
        >>> def believe(firing):
        ...     heard.append(firing)
        ...     return firing.reading
        >>> robot = sim.Robot((0, 0, 1.57), sensors=8, spacing_rad=0.26, radius_m=0.3)
        >>> _ = sim.Simulation(sim.Scene([[5, 2, -5, 2]], robots=[robot]), filter=believe).step(0.1)
        >>> heard[0].reading.sensor, len(heard[0].t_echoes_us), round(heard[0].fired_s, 3)
        (4, 1, 0.014)
    """
    def __new__(
        cls,
        reading: Reading,
        t_echoes_us: Iterable[_Int],
        fired_s: float = 0.0,
        expected_change_us: _Int = 0,
        levels_db: Iterable[float] = (),
    ) -> FiredReading: ...
    @property
    def reading(self) -> Reading:
        """The ring's own verdict on it, with the paper's filter: its sensor, phase and period too."""
    @property
    def t_echoes_us(self) -> tuple[int, ...]:
        """The times of its echoes after firing, in microseconds, earliest first: a tuple of one at most, but of up to
        eight under methods of several, such as ``"multi_echo"``.
        """
    @property
    def levels_db(self) -> tuple[float, ...]:
        """The levels of its echoes over the receiver's threshold at full gain, in dB, as a module reports them that has
        amplitudes: a tuple as long as ``t_echoes_us``, or empty where they are unknown.
        """
    @property
    def fired_s(self) -> float:
        """When it fired, in seconds."""
    @property
    def expected_change_us(self) -> int:
        """Change of a good reading since the sensor's firing before that odometry expects, in microseconds."""
    def to_dict(self) -> dict[str, object]:
        """Its fields by their names: a dict of plain values.

        Example:
            >>> import eeruf
            >>> reading = eeruf.EchoFilter(1, 500).push(0, 9_000)
            >>> eeruf.sim.FiredReading(reading, (9_000,)).to_dict()["t_echoes_us"]
            [9000]
        """
    def __eq__(self, other: object, /) -> bool: ...
    def __ne__(self, other: object, /) -> bool: ...

_Fires = Callable[[int], tuple[_Int, Iterable[tuple[_Int, _Int]]] | tuple[_Int, Iterable[tuple[_Int, _Int]], _Int]]
_Judges = Callable[[FiredReading], Reading | tuple[_Kind, float | None]]

_MakeFilter = Callable[[Robot], _Judges]
_MakeFiring = Callable[[Robot], _Fires]

@final
class Method:
    """A method as a value: plan, judge and settings under a label. :func:`simulate`, :class:`Simulation` and all
    experiments take one wherever they take a name. Immutable; methods compare, and pickle if their callables do.

    Args:
        name: one of ``METHODS``, which gives whatever the others do not; or ``"driving"``, time hopping by its settings
            for robots that drive.
        label: the name in results and tables; by default ``name``. No two methods of one experiment have the same.
        schedule: what the ring fires by: a ``Schedule`` for methods that fire by the robot's own, a ``HoppingSchedule``
            for those that hop. Its sensors must be as many as the robot's.
        settings: a ``HoppingSettings`` or its name for methods that hop; for ``flow`` a dict of what differs from its
            default: ``step_us``, ``shortest_gap_us``, ``masked_adds_us``, ``believed_takes_us``, ``unserved_adds_us``,
            ``unserved_after``, ``shortest_cycle_us``, ``rest_us``, ``lead_us``, ``longest_cycle_us``, ``travel_us``.
        sketch: a dict as the argument ``firing`` of :class:`Robot`, for methods that fire as sketches and modules do.
        make_filter: makes your own filter: called with the :class:`Robot` at the start of each simulation, it returns a
            callable as the argument ``filter`` of :class:`Simulation`. A class whose instances can be called will do.
        make_firing: makes your own firing in the same way, a callable as the argument ``firing`` of
            :class:`Simulation`.

    Raises:
        ArgumentError: no such method, or something that it does not take.

    Example:
        >>> from eeruf import sim
        >>> quick = sim.Method("eeruf_hopping", label="quick", settings="quick")
        >>> believing = sim.Method("eeruf", label="all", make_filter=lambda robot: lambda firing: ("accepted",
        ...     firing.t_echoes_us[0]) if firing.t_echoes_us else ("clear", None))
        >>> robot = sim.Robot((0, 0, 1.57), sensors=8, spacing_rad=0.26, radius_m=0.3)
        >>> scene = sim.Scene([[5, 2, -5, 2]], robots=[robot])
        >>> [round(float(sim.simulate(scene, method, 50).is_accepted.mean()), 2) for method in (believing, quick)]
        [1.0, 0.69]
    """
    def __new__(
        cls,
        name: _MethodName | Literal["driving"] = "eeruf",
        *,
        label: str | None = None,
        schedule: Schedule | HoppingSchedule | None = None,
        settings: HoppingSettings | _Hopping | FlowSettings | None = None,
        sketch: dict[str, object] | None = None,
        make_filter: _MakeFilter | None = None,
        make_firing: _MakeFiring | None = None,
    ) -> Method: ...
    @property
    def name(self) -> _MethodName:
        """The method that it is made of, one of ``METHODS``."""
    @property
    def label(self) -> str:
        """The name in results and tables."""
    def _arguments(self) -> dict[str, Any]: ...
    def __eq__(self, other: object, /) -> bool: ...
    def __hash__(self, /) -> int: ...

_Method = _MethodName | Literal["driving"] | Method

@final
class Simulation:
    """A world that goes on step by step: for your own controller, filter, or display.

    Its steps together give the readings of :func:`simulate`, bit for bit, and need little more memory than one of them.
    A copy, and one that was pickled, does again what was done since the beginning (about 30 bytes a call), and goes on
    alike.

    Args:
        scene: with one robot or more.
        method: one of ``METHODS``, or a :class:`Method`.
        seed: of the noise, 0 to 2^64 - 1; the scene's by default.
        firing: when the first robot's sensors fire, instead of by the method: a callable that takes the number of a
            period, from 0, and returns how long it lasts in microseconds and who fires when in it,
            ``(length_us, [(t_fire_us, sensor), ..])``, or the same with the phase, 0 to 7, as a third. A dict by robot
            for others. No sensor fires while it listens.
        filter: what is believed of the first robot's readings, instead of by the method: a callable that takes a
            :class:`FiredReading` and returns ``(kind, t_echo_us)``, or what :meth:`EchoFilter.push` returns. A dict by
            robot for others.
        mcap: a file that each step is written into, for Foxglove, Rerun and ROS 2: ranges, what is accepted, poses, the
            scene, each reading's path and each firing. :meth:`close` ends it, and so does ``with``.

    What these callables raise comes out of the step that called them, and so does an ArgumentError about what they
    return. They run within a step: the simulation itself cannot be asked or steered by them.

    Raises:
        ArgumentError: no such method, or something of the wrong type or out of range.
        SceneError: the scene has no robot.
        SimulationError: a ring cannot fire by the method as it should listen, or a period cannot be fired.
        LogError: the file cannot be written.

    Example:
        >>> from eeruf import sim
        >>> robot = sim.Robot((0, 0, 1.57), sensors=8, spacing_rad=0.26, radius_m=0.3)
        >>> world = sim.Simulation(sim.Scene([[5, 2, -5, 2]], robots=[robot]))
        >>> world.set_velocity(0, v_m_s=0.3, w_rad_s=0.0)
        >>> while not world.robots[0].touches:
        ...     readings = world.step(0.06)
        >>> round(world.robots[0].pose[1], 1)
        1.7
    """
    def __new__(
        cls,
        scene: Scene,
        method: _Method = "eeruf",
        *,
        seed: _Int | None = None,
        firing: _Fires | dict[int, _Fires] | None = None,
        filter: _Judges | dict[int, _Judges] | None = None,
        mcap: str | PathLike[str] | None = None,
    ) -> Simulation: ...
    def __enter__(self) -> Simulation: ...
    def __exit__(self, _kind: object, _error: object, _traceback: object, /) -> None: ...
    def close(self) -> None:
        """End the MCAP file, if one is being written; the simulation may go on.

        Raises:
            LogError: what was left could not be written.

        Example:
            >>> from eeruf import read_firings, sim
            >>> import pathlib, tempfile
            >>> file = pathlib.Path(tempfile.mkdtemp(), "wall.mcap")
            >>> robot = sim.Robot((0, 0, 1.57), sensors=8, spacing_rad=0.26, radius_m=0.3)
            >>> with sim.Simulation(sim.Scene([[5, 2, -5, 2]], robots=[robot]), mcap=file) as world:
            ...     readings = world.step(0.6)
            >>> len(read_firings(file)) == len(readings)
            True
        """
    def step(self, seconds: float) -> Readings:
        """Let time pass, without the interpreter lock. Ctrl-C ends it.

        Args:
            seconds: how long, 0 to 10^9.

        Returns:
            What was read meanwhile: the readings whose windows have closed.

        Raises:
            ArgumentError: no such time.
            SimulationError: a robot has moved out of the scene's reach.

        Example:
            >>> from eeruf import sim
            >>> robot = sim.Robot((0, 0, 1.57), sensors=8, spacing_rad=0.26, radius_m=0.3)
            >>> world = sim.Simulation(sim.Scene([[5, 2, -5, 2]], robots=[robot]))
            >>> len(world.step(0.6)) > 70, round(world.time_s, 6)
            (True, 0.6)
        """
    def step_to_reading(self, seconds: float) -> Readings:
        """Let time pass until the next reading comes, without the interpreter lock. Ctrl-C ends it.

        Args:
            seconds: how long at most, 0 to 10^9.

        Returns:
            What was read then: one reading, several of the same moment, or none if that time passed before.

        Raises:
            ArgumentError: no such time.
            SimulationError: a robot has moved out of the scene's reach.

        Example:
            >>> from eeruf import sim
            >>> robot = sim.Robot((0, 0, 1.57), sensors=8, spacing_rad=0.26, radius_m=0.3)
            >>> world = sim.Simulation(sim.Scene([[5, 2, -5, 2]], robots=[robot]))
            >>> len(world.step_to_reading(0.6)) >= 1, world.time_s < 0.6
            (True, True)
        """
    def set_velocity(self, robot: _Int, v_m_s: float, w_rad_s: float) -> None:
        """From now on a robot goes ahead and turns at these speeds, whatever its motion was.

        Args:
            robot: which one, from 0.
            v_m_s: the speed ahead in m/s, -50 to 50.
            w_rad_s: the rate of turn in rad/s, counter-clockwise, -50 to 50.

        Raises:
            ArgumentError: no such robot or speed.

        Example:
            >>> from eeruf import sim
            >>> robot = sim.Robot((0, 0, 1.57), sensors=8, spacing_rad=0.26, radius_m=0.3)
            >>> world = sim.Simulation(sim.Scene([[5, 2, -5, 2]], robots=[robot]))
            >>> world.set_velocity(0, v_m_s=0.5, w_rad_s=0.0)
            >>> _ = world.step(1.0)
            >>> round(world.robots[0].pose[1], 3)
            0.5
        """
    def set_pose(self, robot: _Int, pose: _Pose) -> None:
        """Put a robot at another place, whatever is in between. It goes on at the speeds set last, or else stands.

        A ring with odometry takes the leap for a drive. Whether the robot stands free is not checked: see
        ``RobotState.touches``.

        Args:
            robot: which one, from 0.
            pose: (x, y, heading) in metres and radians, up to 10^5.

        Raises:
            ArgumentError: no such robot or pose.

        Example:
            >>> from eeruf import sim
            >>> robot = sim.Robot((0, 0, 1.57), sensors=8, spacing_rad=0.26, radius_m=0.3)
            >>> world = sim.Simulation(sim.Scene([[5, 2, -5, 2]], robots=[robot]))
            >>> world.set_pose(0, (0.5, 1.0, 1.57))
            >>> world.robots[0].pose
            (0.5, 1.0, 1.57)
        """
    def reset(self, seed: _Int | None = None) -> None:
        """Begin again: time 0, robots at their first poses, the scene and the schedules of the start.

        Parts made by ``make_filter`` and ``make_firing`` are remade; callables that were arguments go on being
        called as they are. An MCAP file that is being written ends.

        Args:
            seed: of the noise from now on; the same as before by default.

        Raises:
            ArgumentError: no such seed.
            LogError: what was left of the file could not be written.

        Example:
            >>> from eeruf import sim
            >>> robot = sim.Robot((0, 0, 1.57), sensors=8, spacing_rad=0.26, radius_m=0.3)
            >>> world = sim.Simulation(sim.Scene([[5, 2, -5, 2]], robots=[robot]))
            >>> first = str(world.step(0.6).t_echo_us)
            >>> world.reset(seed=7)
            >>> other = str(world.step(0.6).t_echo_us)
            >>> world.reset(seed=1)
            >>> world.time_s, other != first, str(world.step(0.6).t_echo_us) == first
            (0.0, True, True)
        """
    def change_schedule(self, robot: _Int, schedule: Schedule) -> None:
        """From the end of its present period on a robot's ring fires by another schedule, as late as keeps the intervals
        of both. Readings before and after the change are not compared.

        Args:
            robot: which one, from 0.
            schedule: a ``Schedule`` of as many sensors.

        Raises:
            ArgumentError: no such robot, or something else than a schedule.
            SimulationError: a method without such a schedule (immediate refiring, dither, hopping, adaptive, a firing
                of one's own), a schedule of another number of sensors, or one by which a sensor would fire again while
                it listens. The ring then goes on as before.

        Example:
            >>> import eeruf
            >>> from eeruf import sim
            >>> fast, slow = eeruf.tables.TABLE_I_D.scaled(3, 5), eeruf.tables.TABLE_I_D
            >>> robot = sim.Robot((0, 0, 1.57), sensors=12, spacing_rad=0.26, radius_m=0.3, schedule=fast)
            >>> world = sim.Simulation(sim.Scene([[5, 2, -5, 2]], robots=[robot]))
            >>> before = len(world.step(1.2))
            >>> world.change_schedule(0, slow)
            >>> len(world.step(1.2)) < 0.75 * before
            True
        """
    def change_scene(self, scene: Scene) -> None:
        """From now on sound travels among these walls and poles and in this air: obstacles have moved. Sound that is on
        its way arrives as it would have before. Whether the robots stand free in it is not checked.

        Args:
            scene: whose robots, noise, seed, order and physics do not count: those of the simulation stay.

        Raises:
            ArgumentError: something else than a scene.
            SimulationError: a sensor is within something solid or out of the scene's reach. Everything then stays as it
                was; of a robot that moves it is said when it fires.

        Example:
            >>> from eeruf import sim
            >>> robot = sim.Robot((0, 0, 1.57), sensors=8, spacing_rad=0.26, radius_m=0.3)
            >>> near, far = sim.Scene([[5, 2, -5, 2]], robots=[robot]), sim.Scene([[5, 2.5, -5, 2.5]])
            >>> world = sim.Simulation(near)
            >>> before = min(world.step(0.6).reference_us)
            >>> world.change_scene(far)
            >>> bool(min(world.step(0.6).reference_us[-8:]) > before + 2_000)
            True
        """
    @property
    def robots(self) -> list[RobotState]:
        """The robots now: a list of ``RobotState``."""
    @property
    def time_s(self) -> float:
        """The time that has passed, in seconds."""

@final
class Batch:
    """Many simulations that go on together on all cores, without the interpreter lock: arrays in, arrays out. For
    reinforcement learning and sweeps; of each world the first robot is steered and looked at.

    A world's steps give the readings of :class:`Simulation`, bit for bit, on any number of threads. A world in which a
    sensor or a body goes into something solid stops at the beginning of that step and ``touches``, until :meth:`reset`.

    Args:
        scenes: one or more, each with a robot; all first robots have the same number of sensors.
        method: one of ``METHODS``, or a :class:`Method` without callables: those would hold the interpreter lock.
        seeds: of the noise of each world, 0 to 2^64 - 1; the scenes' by default.
        threads: how many to step on, 1 to 1024; by default one a core.

    Raises:
        ArgumentError: no scenes, no such method, or something of the wrong type or out of range.
        SceneError: a scene has no robot.
        SimulationError: a ring cannot fire by the method as it should listen, or the method has callables.

    Example:
        >>> from eeruf import sim
        >>> robot = sim.Robot((0, 0, 1.57), sensors=8, spacing_rad=0.26, radius_m=0.3)
        >>> batch = sim.Batch([sim.Scene([[5, y, -5, y]], robots=[robot]) for y in (1.5, 2.0, 2.5)])
        >>> state = batch.step(0.6, v_m_s=[0.0, 0.5, 1.0], w_rad_s=0.0)
        >>> state.t_echo_us.shape, [round(float(y), 1) for y in state.pose[:, 1]]
        ((3, 8), [0.0, 0.3, 0.6])
    """
    def __new__(
        cls,
        scenes: Iterable[Scene],
        method: _Method = "eeruf",
        *,
        seeds: Iterable[_Int] | None = None,
        threads: _Int | None = None,
    ) -> Batch: ...
    def __len__(self) -> int: ...
    @property
    def sensors(self) -> int:
        """Number of sensors of each world's first robot."""
    @property
    def state(self) -> BatchState:
        """The state of all worlds now.

        Example:
            >>> from eeruf import experiments, sim
            >>> sim.Batch(experiments.courses(0, 2)).state.pose.tolist()
            [[1.0, 3.0, 0.0], [1.0, 3.0, 0.0]]
        """
    def step(self, seconds: float, v_m_s: ArrayLike | None = None, w_rad_s: ArrayLike | None = None) -> BatchState:
        """Let time pass in all worlds, on all cores and without the interpreter lock. Ctrl-C ends it.

        Args:
            seconds: how long, 0 to 10^9.
            v_m_s: the first robots' speed ahead from now on, in m/s, -50 to 50: a number, or one for each world.
                Without it they go on as before.
            w_rad_s: their rate of turn, counter-clockwise, in rad/s; given together with ``v_m_s``.

        Returns:
            What all worlds look like then.

        Raises:
            ArgumentError: no such time or speeds.
            SimulationError: a robot has moved out of its scene's reach. Other worlds may have gone on; :meth:`reset`
                this one.

        Example:
            >>> from eeruf import experiments, sim
            >>> batch = sim.Batch(experiments.courses(0, 4), "flow")
            >>> state = batch.step(0.5, v_m_s=0.4, w_rad_s=[0.0, 0.1, 0.0, -0.1])
            >>> bool((state.accepted.sum(axis=1) > 10).all())
            True
        """
    def reset(
        self,
        worlds: ArrayLike | None = None,
        *,
        seeds: Iterable[_Int] | None = None,
        scenes: Iterable[Scene] | None = None,
        poses: ArrayLike | None = None,
    ) -> BatchState:
        """Begin again in some worlds: time 0, robots at their first poses.

        Args:
            worlds: which ones: a mask, or numbers from 0; all by default.
            seeds: of their noise from now on, one for each of them; the same as before by default.
            scenes: other scenes for them, one for each; their first robots have as many sensors.
            poses: where their first robots begin: an array of shape (n, 3), x, y and heading in metres and radians.

        Returns:
            What all worlds look like then.

        Raises:
            ArgumentError: no such worlds, or not one of a thing for each.
            SimulationError: a ring cannot fire by the method as it should listen.

        Example:
            >>> from eeruf import experiments, sim
            >>> batch = sim.Batch(experiments.courses(0, 3))
            >>> _ = batch.step(0.6, v_m_s=0.5, w_rad_s=0.0)
            >>> state = batch.reset([False, True, False], scenes=experiments.courses(7, 1), seeds=[7])
            >>> [round(float(time), 1) for time in state.time_s]
            [0.6, 0.0, 0.6]
        """

@final
class BatchState:
    """The worlds of a :class:`Batch` at one moment: arrays with a row for each world, and of what concerns sensors a
    column for each sensor of its first robot. The arrays are read-only.

    Example:
        >>> from eeruf import experiments, sim
        >>> state = sim.Batch(experiments.courses(0, 5)).step(0.6)
        >>> state.pose.shape, state.age_s.shape, bool(state.touches.any())
        ((5, 3), (5, 8), False)
    """
    def __len__(self) -> int: ...
    @property
    def time_s(self) -> _Floats:
        """The time that has passed in each world, in seconds: float64."""
    @property
    def pose(self) -> _Floats:
        """Where the first robots are, x, y and heading in metres and radians: float64 of shape (worlds, 3)."""
    @property
    def touches(self) -> NDArray[np.bool_]:
        """True where the disc that holds the first robot's sensors touches a wall or a pole: bool."""
    @property
    def t_echo_us(self) -> _Floats:
        """Echo times of the latest accepted readings, in microseconds, NaN where there is none or nothing was in range:
        float64 of shape (worlds, sensors).
        """
    @property
    def age_s(self) -> _Floats:
        """Time since the latest accepted reading fired, in seconds, infinite where there is none: float64 of shape
        (worlds, sensors).
        """
    @property
    def is_clear(self) -> NDArray[np.bool_]:
        """True where the latest accepted reading says that nothing is in range: bool of shape (worlds, sensors)."""
    @property
    def is_wrong(self) -> NDArray[np.bool_]:
        """True where the latest accepted reading is wrong, as :meth:`Readings.is_wrong` judges: bool of shape
        (worlds, sensors).
        """
    @property
    def readings(self) -> _Ints:
        """Number of readings in the last step: int64 of shape (worlds, sensors)."""
    @property
    def accepted(self) -> _Ints:
        """Number of accepted readings in the last step: int64 of shape (worlds, sensors)."""

@final
class ReadingBlocks(Iterator[Readings]):
    """The readings of a simulation block by block: an iterator that Ctrl-C interrupts.

    Example:
        >>> from eeruf import sim
        >>> robot = sim.Robot((0, 0, 1.57), sensors=8, spacing_rad=0.26, radius_m=0.3)
        >>> scene = sim.Scene([[5, 2, -5, 2]], robots=[robot])
        >>> blocks = list(sim.simulate_blocks(scene, periods=25, block_periods=10))
        >>> len(blocks), sum(map(len, blocks))
        (3, 200)
    """
    def __iter__(self, /) -> ReadingBlocks: ...
    def __next__(self, /) -> Readings: ...

def read_map(path: str | PathLike[str], *, tolerance_m: float | None = None) -> Scene:
    r"""A scene out of an occupancy grid, as the ROS ``map_server`` saves it: walls along the outlines of what is occupied.

    A cell is occupied if it is with a probability above the file's ``occupied_thresh``; one of which nothing is known
    is not. Add robots with :meth:`Scene.replace`.

    Args:
        path: of the YAML file, which names a PGM picture beside it.
        tolerance_m: how far walls may be from the edges of the occupied cells, in metres, 0 to 1000; one and a half
            cells if it is not given, which makes the stair straight that a slanted wall becomes in cells.

    Raises:
        ArgumentError: not a path, or no such tolerance.
        SceneError: no such file, or it says something that makes no map: by name, value and what is expected.

    Example:
        >>> from pathlib import Path
        >>> from tempfile import TemporaryDirectory
        >>> from eeruf import sim
        >>> with TemporaryDirectory() as folder:
        ...     _ = (Path(folder) / "room.pgm").write_text("P2 4 3 1  0 0 0 0  0 1 1 0  0 0 0 0")
        ...     text = "image: room.pgm\nresolution: 0.5\norigin: [0, 0, 0]"
        ...     _ = (Path(folder) / "room.yaml").write_text(text)
        ...     sim.read_map(Path(folder) / "room.yaml", tolerance_m=0)
        <Scene: 8 walls, 0 poles, 0 robots>
    """

def simulate_blocks(
    scene: Scene,
    method: _Method = "eeruf",
    periods: _Int = 1000,
    seed: _Int | None = None,
    *,
    block_periods: _Int = 10000,
    progress: _Progress = None,
) -> ReadingBlocks:
    """As :func:`simulate`, but block by block: however long it is, it needs no more memory than a block.

    Args:
        scene: as for :func:`simulate`, and so all others.
        method: as for :func:`simulate`.
        periods: for how many periods of the first robot, 1 or more.
        seed: as for :func:`simulate`.
        block_periods: how many periods a block has at most.
        progress: as for :func:`simulate`.

    Returns:
        An iterator of ``Readings``, which together are those of :func:`simulate`.

    Raises:
        ArgumentError: as for :func:`simulate`, and so all others.
        SceneError: as for :func:`simulate`.
        SimulationError: as for :func:`simulate`.
        MemoryError: a block does not fit into memory.

    Example:
        >>> from eeruf import sim
        >>> robot = sim.Robot((0, 0, 1.57), sensors=8, spacing_rad=0.26, radius_m=0.3)
        >>> scene = sim.Scene([[5, 2, -5, 2]], robots=[robot])
        >>> wrong = 0
        >>> for readings in sim.simulate_blocks(scene, periods=2_000, block_periods=500):
        ...     wrong += int((readings.is_accepted & readings.is_wrong()).sum())
        >>> wrong < 40
        True
    """

@final
class _Stop:
    def __new__(cls) -> _Stop: ...
    def stop(self) -> None: ...

def _until_stopped(switch: _Stop, function: Callable[[_Case], _Result], argument: _Case) -> _Result: ...
def simulate(
    scene: Scene,
    method: _Method = "eeruf",
    periods: _Int = 1000,
    seed: _Int | None = None,
    *,
    progress: _Progress = None,
) -> Readings:
    """Drive the rings of a scene through simulated time by a method: core's own plans and judges, as on the target.

    The same scene, method and seed give the same readings, bit for bit. It runs on one core, without the interpreter
    lock; Ctrl-C ends it.

    Args:
        scene: with one robot or more.
        method: one of ``METHODS``, or a :class:`Method`.
        periods: for how many periods of the first robot, 1 or more.
        seed: of the noise, 0 to 2^64 - 1; the scene's by default.
        progress: True for a bar (tqdm if it is installed), or a callable that takes the share done and a text.

    Returns:
        Every reading.

    Raises:
        ArgumentError: no such method, or something of the wrong type or out of range.
        SceneError: the scene has no robot.
        SimulationError: a ring cannot fire by the method as it should listen.
        MemoryError: the readings do not fit into memory; :func:`simulate_blocks` gives them bit by bit.

    Example:
        >>> from eeruf import sim
        >>> robot = sim.Robot((0, 0, 1.57), sensors=8, spacing_rad=0.26, radius_m=0.3)
        >>> scene = sim.Scene([[5, 2, -5, 2]], robots=[robot])
        >>> sim.simulate(scene, method="conventional", periods=10)
        <Readings: 80 of 8 sensors, conventional, 0.600 s>
    """

_ROOM_M: list[float]
_SIDE_M: float

def _set_one(
    seeds: _Int,
    first: _Int | None,
    readings: _Int | None,
    methods: Sequence[_Method] | None,
    progress: _Progress,
    physics: _Physics | None = None,
) -> tuple[str, str]: ...
def _set_three(
    seeds: int,
    first: int | None,
    periods: int | None,
    methods: Sequence[_Method] | None,
    progress: _Progress,
    physics: _Physics,
    height: object,
    numbered: bool,
) -> tuple[str, str]: ...
def _set_two(asked: dict[str, object], progress: _Progress) -> tuple[str, dict[str, list[dict[str, object]]]]: ...
def _figures(set: int, runs: str) -> str: ...
def _difference(differences: Sequence[float]) -> str | None: ...
def _alcove(number: _Int, physics: _Physics) -> Scene: ...
def _course(number: _Int, physics: _Physics) -> Scene: ...
def _room(
    kind: str, number: _Int, ring: str | PathLike[str], driving: bool, physics: _Physics, height: _Height
) -> Scene: ...
def _recommend(ring: str | PathLike[str], asked: dict[str, object], progress: _Progress) -> str: ...
def _speed_sweep(speeds_m_s: Sequence[float], asked: dict[str, object], progress: _Progress) -> str: ...
def _readings_from_columns(
    method: str,
    duration_s: float,
    sensors: _Int,
    columns: dict[str, NDArray[np.float64 | np.int64 | np.int8]],
    paths: dict[str, object],
) -> Readings: ...

@final
class _LogBlocks(Iterator[dict[str, Any]]):
    def __new__(
        cls,
        source: object,
        options: Mapping[str, object],
        judge: object,
        out: str | PathLike[str] | None,
        rows: _Int | None,
    ) -> _LogBlocks: ...
    def __next__(self, /) -> dict[str, Any]: ...

def _judge(ranges: object, judge: object, speed_of_sound: object) -> dict[str, Any]: ...
def _read_firings(source: object) -> dict[str, Any]: ...
def _replay(
    source: object, judge: object, out: str | PathLike[str] | None, speed_of_sound: object
) -> dict[str, Any]: ...
def _diagnose(firings: Firings, tolerance_us: _Int, max_travel_us: _Int) -> dict[str, Any]: ...
def _survey(firings: Firings, tolerance_us: _Int, until_us: _Int) -> dict[str, Any]: ...

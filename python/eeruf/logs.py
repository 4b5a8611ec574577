"""Logs of robots: the ranges of bags, MCAP and CSV files, and findings about a ring from its log of firings.

Everything is read by the same code as ``eeruf logs``, ``eeruf replay``, ``eeruf diagnose`` and ``eeruf survey``;
docs/how-to/logs.md lists the formats. A log is a path, a file object, or a URL that fsspec opens, such as
``"s3://bucket/drive.mcap"``. The URL of a ROS 2 bag's folder ends with ``/``; the folder is copied first.

Example:
    >>> import eeruf
    >>> log = eeruf.logs.Firings.of(sensor=[0, 1], fired_us=[0, 500], period=[0, 0], phase=[0, 0], t_echo_us=[7000.0, 8000.0])
    >>> eeruf.logs.diagnose(log).sender.tolist()  # two firings prove nothing
    [-1, -1]

"""

from __future__ import annotations

import contextlib
import os
from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, Any, ClassVar, Literal, TypeVar, overload

from eeruf import _eeruf
from eeruf._columns import Columns as _Columns, column as _column
from eeruf._eeruf import EerufError
from eeruf._opened import opened_log as _opened

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator
    from typing import Protocol, TypedDict, Union

    import numpy as np
    from matplotlib.axes import Axes
    from numpy.typing import ArrayLike, NDArray
    from typing_extensions import TypeAlias, Unpack

    _Block = TypeVar("_Block", bound="Ranges")

    class _File(Protocol):
        def read(self, size: int, /) -> bytes | str: ...

    class _Openable(Protocol):
        """Files as opened by ``fsspec.open``."""

        @property
        def fs(self) -> Any: ...
        @property
        def path(self) -> str: ...

    _Log: TypeAlias = Union[str, os.PathLike[str], _File, _Openable]

    class _Options(TypedDict, total=False):
        time: str | None
        time_unit: Literal["s", "ms", "us", "ns"] | None
        ranges: Iterable[str]
        range_unit: Literal["m", "cm", "mm", "in", "ft", "ms", "us"] | None
        sensor: str | None
        speed_of_sound: float
        no_echo_m: float
        no_echo: Iterable[str]
        columns: Iterable[str]
        topics: Iterable[str]
        fields: Iterable[tuple[str, str, str]]
        judged: bool


__all__ = ["Agree", "Firings", "Ranges", "blocks", "diagnose", "read_firings", "replay", "survey"]


@dataclass(frozen=True)
class Agree:
    """A judge of ranges: ``consecutive`` readings of a sensor, 2 to 8, must agree within ``t_delta_us``.

    Example:
        >>> import eeruf
        >>> eeruf.logs.Agree(500)
        Agree(t_delta_us=500, consecutive=2)

    """

    t_delta_us: int
    consecutive: int = 2


@dataclass(frozen=True)
class Crosstalk:
    """A verdict on whether the sensors of a log read each other's sound; docs/how-to/logs.md says how it is found.

    ``verdict`` is ``"crosstalk"``, ``"none seen"`` or ``"cannot tell"``, and ``reasons`` says why. ``fooled`` are the sensors that read
    foreign sound, ``pairs`` those that read each other's, and ``suspects`` those that may be fooled, each with the sensor whose sound
    it may read, or None. ``record`` says what to record if the log cannot tell, and ``notes`` are about single sensors. ``answer`` is
    all this in words, as ``eeruf logs`` prints it.

    Example:
        >>> import eeruf, io
        >>> log = eeruf.read_log(io.BytesIO(b"range" + bytes([10]) + b"1.716" + bytes([10])))
        >>> log.crosstalk.verdict
        'cannot tell'

    """

    verdict: Literal["crosstalk", "none seen", "cannot tell"]
    fooled: list[int]
    pairs: list[tuple[int, int]]
    reasons: list[str]
    record: str | None
    suspects: list[tuple[int, int | None]]
    notes: list[str]
    answer: str


@dataclass(frozen=True, eq=False)
class Ranges(_Columns):
    """The ranges of a log: arrays of equal length, in the order in which they were recorded.

    ``sensor`` is an index into ``names``, ``topics`` and ``frames``; ``at_ns`` is the header's time in nanoseconds, or -1
    where there is none. ``range_m`` is ``inf`` without an echo and ``-inf`` for too close, as in REP 117. ``variance`` is NaN where the
    message has none. ``damage`` says what could not be read, ``skipped`` which topics were left out, and why. ``form`` is the form
    of the file, ``guesses`` are triples of what was guessed, the guess, and the options of ``eeruf logs`` that override it;
    ``warnings`` name values that seem wrong. ``firing`` is how the sensors fire according to the times: ``at once``, ``in turn``,
    ``constant lags``, ``alternating``, ``several lags``, ``flow`` or ``unknown``; ``proves`` says what agreement proves for it, and
    ``crosstalk`` whether sensors read each other's sound.

    Example:
        >>> import eeruf, pathlib, tempfile
        >>> file = pathlib.Path(tempfile.mkdtemp()) / "log.csv"
        >>> size = file.write_text("range" + chr(10) + "1.716" + chr(10))
        >>> eeruf.read_log(file).echo_us(speed_of_sound=343.2).round(3).tolist()
        [10000.0]

    """

    sensor: NDArray[np.int64]
    at_ns: NDArray[np.int64]
    range_m: NDArray[np.float64]
    min_range_m: NDArray[np.float64]
    max_range_m: NDArray[np.float64]
    variance: NDArray[np.float64]
    names: list[str]
    topics: list[str]
    frames: list[str]
    damage: list[str]
    skipped: list[tuple[str, str]]
    form: str
    guesses: list[tuple[str, str, str]]
    warnings: list[str]
    firing: str
    proves: str
    crosstalk: Crosstalk

    _columns: ClassVar[tuple[str, ...]] = ("sensor", "at_ns", "range_m", "min_range_m", "max_range_m", "variance")

    def echo_us(self, *, speed_of_sound: float = 343.2) -> NDArray[np.float64]:
        """Return the times from firing to echo in microseconds; NaN without an echo, and for too close.

        Args:
            speed_of_sound: the speed of sound in m/s, above 0.

        Raises:
            EerufError: an invalid speed.

        Example:
            >>> import eeruf, pathlib, tempfile
            >>> file = pathlib.Path(tempfile.mkdtemp()) / "log.csv"
            >>> size = file.write_text("range" + chr(10) + "3.432" + chr(10))
            >>> eeruf.read_log(file).echo_us().round(3).tolist()
            [20000.0]

        """
        import numpy as np

        try:
            is_speed = 0 < float(speed_of_sound) < np.inf
        except (TypeError, ValueError, OverflowError):
            is_speed = False
        if not is_speed:
            raise EerufError(f"speed_of_sound = {speed_of_sound!r:.60}; expected a number above 0")
        seen = np.isfinite(self.range_m) & (self.range_m < self.max_range_m) & (self.range_m >= self.min_range_m)
        return np.where(seen, 2e6 * np.where(seen, self.range_m, 0.0) / speed_of_sound, np.nan)


@dataclass(frozen=True, eq=False)
class Checked:
    """The answer of :func:`check`; as text, it says in words what was found and what to do next.

    ``verdict`` is ``"crosstalk"``, ``"none seen"`` or ``"cannot tell"``, ``concerns`` are the names of the sensors that read
    another's sound or may do so, and ``sensors`` has ``readings``, ``echoes``, ``nearest_m`` and ``farthest_m`` for each name. ``log``
    has the readings, with all guesses.

    Example:
        >>> import eeruf
        >>> eeruf.check({"left": [0.40, 0.41, 0.40], "right": [0.80, 0.81, 0.80]}).sensors["left"]["echoes"]
        3

    """

    verdict: Literal["crosstalk", "none seen", "cannot tell"]
    concerns: list[str]
    sensors: dict[str, dict[str, float]]
    log: Ranges

    def __str__(self) -> str:
        """Return the answer as ``eeruf logs`` prints it."""
        return self.log.crosstalk.answer

    def figure(self, *, ax: Axes | None = None) -> Axes:
        """Draw the ranges of each sensor over time, or over its readings if the log has no times; ``concerns`` are in vermilion.

        Args:
            ax: the axes to draw into; new ones by default.

        Example:
            >>> import eeruf
            >>> eeruf.check({"left": [0.40, 0.41, 0.40]}).figure().get_ylabel()
            'range (m)'

        """
        import numpy as np

        from eeruf.plot._canvas import axes, bare, colours, legend_above

        ax = axes(ax, width=8.0)
        its = colours(ax)
        log, marks = self.log, "os^vD<>P"
        is_timed = bool(np.all(log.at_ns >= 0)) and bool(np.ptp(log.at_ns) > 0)
        for sensor, name in enumerate(log.names):
            (own,) = np.nonzero((log.sensor == sensor) & np.isfinite(log.range_m))
            at = (log.at_ns[own] - log.at_ns.min()) / 1e9 if is_timed else np.arange(len(own))
            colour = its.vermilion if name in self.concerns else (its.blue, its.green, its.orange, its.grey)[sensor % 4]
            ax.plot(at, log.range_m[own], marks[sensor % len(marks)], markersize=2.5, color=colour, label=name)
        ax.set(xlabel="time (s)" if is_timed else "reading", ylabel="range (m)")
        legend_above(ax)
        bare(ax)
        return ax


@dataclass(frozen=True, eq=False)
class Judged(Ranges):
    """The ranges of a log with a judge's verdicts: ``kind``, indices into ``eeruf.KINDS``, -1 for a non-number.

    For each sensor ``gaps`` counts pauses longer than 1 s and than five usual ones, and ``backwards`` counts readings whose time is
    before that of the previous one. A reading after either is not compared with earlier ones.

    Example:
        >>> import eeruf, io
        >>> text = chr(10).join(["front m", "1.20", "1.21", "0.40"])
        >>> judged = eeruf.logs.replay(io.StringIO(text), eeruf.logs.Agree(t_delta_us=500))
        >>> [eeruf.KINDS[kind] for kind in judged.kind]
        ['first', 'accepted', 'rejected']

    """

    kind: NDArray[np.int8]
    gaps: list[int]
    backwards: list[int]

    _columns = (*Ranges._columns, "kind")


@dataclass(frozen=True, eq=False)
class Firings(_Columns):
    """A ring's log of firings: arrays of equal length.

    ``t_echo_us`` is the raw time from firing to the first edge, NaN without one; ``rejected`` is 1 if the ring rejected the reading,
    0 if not, -1 if the log does not say; ``sends`` is false where a sensor only listened. ``clock`` names the clock of ``fired_us``,
    ``damage`` says which parts could not be read.

    Example:
        >>> import eeruf
        >>> log = eeruf.logs.Firings.of(sensor=[0], fired_us=[0], period=[0], phase=[0], t_echo_us=[7000.0])
        >>> len(log), log.rejected.tolist()
        (1, [-1])

    """

    sensor: NDArray[np.int64]
    fired_us: NDArray[np.int64]
    period: NDArray[np.int64]
    phase: NDArray[np.int64]
    t_echo_us: NDArray[np.float64]
    rejected: NDArray[np.int64]
    sends: NDArray[np.bool_]
    clock: str
    damage: str | None

    _columns = ("sensor", "fired_us", "period", "phase", "t_echo_us", "rejected", "sends")

    @classmethod
    def of(
        cls,
        *,
        sensor: ArrayLike,
        fired_us: ArrayLike,
        period: ArrayLike,
        phase: ArrayLike,
        t_echo_us: ArrayLike,
        rejected: ArrayLike | None = None,
        sends: ArrayLike | None = None,
    ) -> Firings:
        """Make a log from arrays, such as those of ``sim.Readings`` or the columns of a data frame.

        Args:
            sensor: the sensor, from 0.
            fired_us: when it fired, in microseconds of one clock.
            period: the period, from 0.
            phase: the phase, from 0.
            t_echo_us: the time from firing to the first edge, NaN without one.
            rejected: 1 if the ring rejected the reading, 0 if not, -1 if that is not known.
            sends: false where a sensor only listened.

        Raises:
            EerufError: a column is not a one-dimensional array of such numbers.

        """
        import numpy as np

        sensors = _column("sensor", sensor, np.int64)
        rows = len(sensors)
        return cls(
            sensor=sensors,
            fired_us=_column("fired_us", fired_us, np.int64),
            period=_column("period", period, np.int64),
            phase=_column("phase", phase, np.int64),
            t_echo_us=_column("t_echo_us", t_echo_us, np.float64),
            rejected=_column("rejected", np.full(rows, -1) if rejected is None else rejected, np.int64),
            sends=_column("sends", np.ones(rows) if sends is None else sends, np.bool_),
            clock="unnamed",
            damage=None,
        )


@dataclass(frozen=True, eq=False)
class Diagnosis:
    """A diagnosis of a ring from its log.

    ``paths`` are columns of equal length, by receiver, best supported first; a sensor's own echo is a path from itself. For each
    firing, ``sender`` is the sensor whose sound was read, or -1 if that is unsure, ``travel_us`` is the sound's travel time, and ``sure``
    the certainty of the sender. ``faults`` are ``("deaf", [sensor])``: others hear its sound, but it hears nothing. Sensors in ``silent``
    hear nothing, and the log cannot tell why. ``moved`` is true if the robot moved; no path is found then.
    ``most_offsets`` is the largest number of time offsets between the firings of two sensors; below about five, no sender can be named.

    Example:
        >>> import eeruf
        >>> log = eeruf.logs.Firings.of(sensor=[0], fired_us=[0], period=[0], phase=[0], t_echo_us=[7000.0])
        >>> eeruf.logs.diagnose(log).faults
        []

    """

    paths: dict[str, NDArray[np.float64 | np.int64 | np.bool_]]
    sender: NDArray[np.int64]
    travel_us: NDArray[np.float64]
    sure: NDArray[np.float64]
    faults: list[tuple[str, list[int]]]
    silent: list[int]
    moved: bool
    most_offsets: int


@dataclass(frozen=True, eq=False)
class Surveyed:
    """The result of a measuring run.

    ``paths`` is as in :class:`Diagnosis`; ``conflicts`` are ``(x, y, us)``: pairs that hear each other in time, and the longest such
    travel time. ``[(x, y) for x, y, _ in conflicts]`` is a ``layout`` for :func:`eeruf.design`.

    Example:
        >>> import eeruf
        >>> log = eeruf.logs.Firings.of(sensor=[0], fired_us=[0], period=[0], phase=[0], t_echo_us=[7000.0])
        >>> eeruf.logs.survey(log).conflicts
        []

    """

    paths: dict[str, NDArray[np.float64 | np.int64 | np.bool_]]
    conflicts: list[tuple[int, int, float]]


def read_log(
    log: _Log,
    *,
    time: str | None = None,
    time_unit: Literal["s", "ms", "us", "ns"] | None = None,
    ranges: Iterable[str] = (),
    range_unit: Literal["m", "cm", "mm", "in", "ft", "ms", "us"] | None = None,
    sensor: str | None = None,
    speed_of_sound: float = 343.2,
    no_echo_m: float = 5.0,
    no_echo: Iterable[str] = (),
    columns: Iterable[str] = (),
    topics: Iterable[str] = (),
    fields: Iterable[tuple[str, str, str]] = (),
    judged: bool = False,
) -> Ranges:
    """Read the ranges of an MCAP file, a ROS 2 bag (its folder), a ROS 1 bag, a table, lines of name and value, or JSON.

    Whatever is not given is guessed, and ``guesses`` lists it. A damaged file is read as far as possible; ``damage``
    names the rest. ``topics``, ``fields`` and ``judged`` are for bags, all other arguments for text.

    Args:
        log: a path, a URL or a file object.
        time: the column with the time.
        time_unit: the unit of the time.
        ranges: the columns with ranges; by default those whose name or unit says so.
        range_unit: the unit of the ranges; ``us`` are microseconds from firing to echo.
        sensor: the column with the sensor of each row.
        speed_of_sound: the speed of sound in m/s, for ranges in ``us``.
        no_echo_m: the range from which on a value means no echo.
        no_echo: values that mean no echo, as they stand in the log; by default ``0``, numbers below 0, and a repeated ceiling.
        columns: the names of the columns in their order, in place of a header; ``-`` leaves one out.
        topics: the topics to read, whatever their type.
        fields: triples of topic, field and unit, such as ``("/sonars", "distance_mm[]", "mm")``.
        judged: whether to read the output topics of a filter too, ``TOPIC/accepted`` and ``TOPIC/confirmed``.

    Raises:
        LogError: the log cannot be read, or holds no sensor.
        EerufError: an argument is wrong.

    Example:
        >>> import eeruf, pathlib, tempfile
        >>> file = pathlib.Path(tempfile.mkdtemp()) / "log.csv"
        >>> size = file.write_text(chr(10).join(["t,left,right", "0.00,1.20,", "0.06,1.21,2.50"]))
        >>> log = eeruf.read_log(file, time="t")
        >>> log.names, log.range_m.tolist()
        (['left', 'right'], [1.2, inf, 1.21, 2.5])

    """
    options = dict(locals())
    del options["log"]
    with _opened(log) as source:
        (found,) = _eeruf._LogBlocks(source, options, None, None, None)
    return _made(Ranges, found)


def check(log: object, **options: Unpack[_Options]) -> Checked:
    """Find out from any log of ranges whether its sensors read each other's sound, and what to do next.

    Args:
        log: a path, a URL, a file object or pasted text, as :func:`read_log` reads them; a DataFrame of pandas or polars; a
            dict of columns; an array of one column per sensor; ``Ranges``; or ``Readings`` of the simulator.
        options: as for :func:`read_log`.

    Raises:
        LogError: no ranges are found in the log.
        EerufError: an argument is wrong.

    Example:
        >>> import eeruf
        >>> text = chr(10).join(f"{40 * n},{n % 2},{1.0 + 0.001 * (n % 3):.3f}" for n in range(200))
        >>> checked = eeruf.check("ms,sensor,range_m" + chr(10) + text)
        >>> checked.verdict, print(checked)  # doctest: +ELLIPSIS
        No crosstalk seen...
        ('none seen', None)

    """
    import numpy as np

    read = log if isinstance(log, Ranges) else read_log(_as_log(log), **options)
    found = read.crosstalk
    concerned = {*found.fooled, *(sensor for sensor, _ in found.suspects)}
    sensors: dict[str, dict[str, float]] = {}
    for sensor, name in enumerate(read.names):
        own = read.range_m[read.sensor == sensor]
        echoes = own[np.isfinite(own)]
        nearest, farthest = (float(echoes.min()), float(echoes.max())) if len(echoes) else (np.nan, np.nan)
        sensors[name] = {"readings": len(own), "echoes": len(echoes), "nearest_m": nearest, "farthest_m": farthest}
    return Checked(found.verdict, [read.names[sensor] for sensor in sorted(concerned)], sensors, read)


def _as_log(log: object) -> _Log:
    """Convert tables and arrays to CSV, which :func:`read_log` reads."""
    import io

    import numpy as np

    if isinstance(log, str) and chr(10) in log:
        return io.StringIO(log)
    if isinstance(log, _eeruf.Readings):
        sender = log.sensor if log.robot.max(initial=0) == 0 else log.robot * log.sensors + log.sensor
        log = {"fired_us": log.fired_s * 1e6, "sensor": sender, "echo_us": log.t_echo_us}
    elif hasattr(log, "write_csv"):
        return io.StringIO(log.write_csv())
    elif hasattr(log, "to_csv"):
        # An index that only counts is not a column.
        return io.StringIO(log.to_csv(index=type(getattr(log, "index", None)).__name__ != "RangeIndex"))
    elif isinstance(log, (np.ndarray, list, tuple)):
        table = np.asarray(log, dtype=float)
        if table.ndim not in (1, 2):
            raise EerufError(f"log = {log!r:.60}; expected an array of one column per sensor")
        log = {f"range {n + 1}": column for n, column in enumerate(table.reshape(len(table), -1).T)}
    if not isinstance(log, dict):
        return log  # type: ignore[return-value]
    lengths = {name: len(column) for name, column in log.items()}
    if len({*lengths.values()}) != 1:
        raise EerufError(f"log has columns of {lengths} values; expected equal lengths")
    rows = [",".join(str(name) for name in log), *(",".join(map(str, row)) for row in zip(*log.values()))]
    return io.StringIO(chr(10).join(rows) + chr(10))


def _made(of: type[_Block], found: dict[str, Any]) -> _Block:
    return of(**{**found, "crosstalk": Crosstalk(**found["crosstalk"])})


@overload
def blocks(
    log: _Log, *, rows: int = ..., judge: None = ..., out: None = ..., **options: Unpack[_Options]
) -> Iterator[Ranges]: ...
@overload
def blocks(
    log: _Log,
    *,
    rows: int = ...,
    judge: Agree,
    out: str | os.PathLike[str] | None = ...,
    **options: Unpack[_Options],
) -> Iterator[Judged]: ...
def blocks(
    log: _Log,
    *,
    rows: int = 100_000,
    judge: Agree | None = None,
    out: str | os.PathLike[str] | None = None,
    **options: Unpack[_Options],
) -> Iterator[Ranges] | Iterator[Judged]:
    """Read a log of any length in little memory: block by block, in the order in which it was recorded.

    There is at least one block. A block has the names, guesses and damage that are known so far; only the last one has those of the
    whole log, and ``firing`` and ``crosstalk``.

    Args:
        log: a path, a URL or a file object.
        rows: how many readings a block has, 1 or more; the last one may have fewer.
        judge: the judge of each reading, if any; the blocks are then :class:`Judged`.
        out: with a judge, an MCAP file to write: each topic, and another one with its accepted readings.
        options: as for :func:`read_log`.

    Raises:
        LogError: the log cannot be read, or holds no sensor.
        EerufError: an argument is wrong.

    Example:
        >>> import eeruf, io
        >>> text = chr(10).join(["front m", *["1.20"] * 2_500])
        >>> [len(block) for block in eeruf.logs.blocks(io.StringIO(text), rows=1_000)]
        [1000, 1000, 500]

    """
    of = Ranges if judge is None else Judged
    with contextlib.ExitStack() as opened:
        reader = _eeruf._LogBlocks(opened.enter_context(_opened(log)), options, _range_judge(judge), out, rows)
        # Wrong arguments have raised errors by now, not with the first block.
        kept = opened.pop_all()
    return _each(of, reader, kept)


def _each(of: type[_Block], reader: _eeruf._LogBlocks, opened: contextlib.ExitStack) -> Iterator[_Block]:
    with opened:
        for found in reader:
            yield _made(of, found)


def _range_judge(judge: object) -> Agree | None:
    if judge is None or isinstance(judge, Agree):
        return judge
    raise EerufError(f"judge = {judge!r:.60}; expected an eeruf.logs.Agree")


def read_firings(log: _Log) -> Firings:
    """Read a ring's log of firings: text, MCAP or frames of the serial line. docs/how-to/diagnose.md has the format.

    Args:
        log: a path, a URL or a file object.

    Raises:
        LogError: the log cannot be read.
        EerufError: an argument is wrong.

    Example:
        >>> import eeruf, pathlib, tempfile
        >>> file = pathlib.Path(tempfile.mkdtemp()) / "log.csv"
        >>> lines = ["# clock: board", "sensor,fired_us,period,phase,t_echo_us", "0,15000,0,0,5872"]
        >>> size = file.write_text(chr(10).join(lines))
        >>> log = eeruf.logs.read_firings(file)
        >>> log.clock, log.t_echo_us.tolist()
        ('board', [5872.0])

    """
    with _opened(log) as source:
        return Firings(**_eeruf._read_firings(source))


def replay(
    log: Ranges | _Log,
    judge: Agree,
    *,
    out: str | os.PathLike[str] | None = None,
    **options: Unpack[_Options],
) -> Judged:
    """Judge the ranges of a log again.

    Args:
        log: a path, a URL or a file object; or ranges from :func:`read_log`.
        judge: an :class:`Agree`.
        out: an MCAP file to write: each topic, and another one with its accepted readings; not for ranges from :func:`read_log`.
        options: as for :func:`read_log`; only ``speed_of_sound`` for ranges from :func:`read_log`.

    Raises:
        LogError: the log cannot be read.
        EerufError: an argument is wrong.

    Example:
        >>> import eeruf, io
        >>> text = chr(10).join(["front m", "1.20", "1.21", "0.40"])
        >>> [eeruf.KINDS[kind] for kind in eeruf.logs.replay(io.StringIO(text), eeruf.logs.Agree(t_delta_us=500)).kind]
        ['first', 'accepted', 'rejected']

    """
    if not isinstance(judge, Agree):
        raise EerufError(f"judge = {judge!r:.60}; expected an eeruf.logs.Agree")
    if isinstance(log, Ranges):
        if out is not None:
            raise EerufError(f"out = {out!r:.60}; expected None where ranges were read before: give their log")
        found = _eeruf._judge(log, judge, _speed_of_sound(options))
        return Judged(**{field.name: getattr(log, field.name) for field in fields(Ranges)}, **found)
    with _opened(log) as source:
        (found,) = _eeruf._LogBlocks(source, options, judge, out, None)
    return _made(Judged, found)


def _speed_of_sound(options: _Options) -> float:
    for name, value in options.items():
        if name != "speed_of_sound":
            raise EerufError(f"{name} = {value!r:.60}; expected it only where a log of ranges is read")
    return options.get("speed_of_sound", 343.2)


def _firings(log: Firings | _Log) -> Firings:
    if isinstance(log, Firings):
        return log
    with _opened(log, "an eeruf.logs.Firings, or the path of a log, a URL or a file object") as source:
        return Firings(**_eeruf._read_firings(source))


def diagnose(log: Firings | _Log, *, tolerance_us: int = 75, max_travel_us: int = 80_000) -> Diagnosis:
    """Find from a log of firings which sensors fool each other, the sender of each reading, and faults.

    Args:
        log: firings, or a path, a URL or a file object.
        tolerance_us: largest difference of a reading from what a path predicts, about four times the jitter.
        max_travel_us: the longest travel time of sound to consider.

    Raises:
        LogError: the log cannot be read.
        EerufError: an argument is wrong.

    Example:
        >>> import eeruf, numpy as np
        >>> from eeruf import sim
        >>> scene = sim.Scene.from_toml(eeruf.example("scenes/alcove.toml"))
        >>> r = sim.simulate(scene, "dither", periods=300)
        >>> log = eeruf.logs.Firings.of(
        ...     sensor=r.sensor, fired_us=np.rint(1e6 * r.fired_s), period=r.period, phase=r.phase, t_echo_us=r.earliest_us
        ... )
        >>> bool((eeruf.logs.diagnose(log).sender >= 0).mean() > 0.3)
        True

    """
    return Diagnosis(**_eeruf._diagnose(_firings(log), tolerance_us=tolerance_us, max_travel_us=max_travel_us))


def survey(log: Firings | _Log, *, tolerance_us: int = 100, until_us: int = 15_000) -> Surveyed:
    """Find from a measuring run which sensors hear each other; docs/how-to/survey.md explains such a run.

    Args:
        log: firings, or a path, a URL or a file object.
        tolerance_us: largest difference between edges of one path, about four times the jitter.
        until_us: pairs that hear each other within this time are conflicts.

    Raises:
        LogError: the log cannot be read.
        EerufError: an argument is wrong.

    Example:
        >>> import eeruf
        >>> alone = eeruf.logs.Firings.of(
        ...     sensor=[0] * 9, fired_us=range(0, 900_000, 100_000), period=range(9), phase=[0] * 9, t_echo_us=[7000.0] * 9
        ... )
        >>> eeruf.logs.survey(alone).paths["travel_us"].tolist()
        [7000.0]

    """
    return Surveyed(**_eeruf._survey(_firings(log), tolerance_us=tolerance_us, until_us=until_us))

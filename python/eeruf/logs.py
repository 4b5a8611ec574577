"""Logs of robots: the ranges of bags, MCAP and CSV files, and what a ring's log of firings says about it.

Everything is read by the same code as ``eeruf replay``, ``eeruf diagnose`` and ``eeruf survey``; docs/how-to/logs.md
says what is read.

Example:
    >>> import eeruf
    >>> log = eeruf.logs.Firings.of(sensor=[0, 1], fired_us=[0, 500], period=[0, 0], phase=[0, 0], t_echo_us=[7000.0, 8000.0])
    >>> eeruf.diagnose(log).sender.tolist()  # two firings prove nothing
    [-1, -1]

"""

from __future__ import annotations

import os
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal, TypeVar

from eeruf import _eeruf
from eeruf._eeruf import ArgumentError, LogError

if TYPE_CHECKING:
    from collections.abc import Iterable

    import numpy as np
    import pandas as _pd
    import polars as _pl
    from numpy.typing import ArrayLike, NDArray

    _Number = TypeVar("_Number", bound=np.generic)

__all__ = [
    "Diagnosis",
    "Firings",
    "LogError",
    "Ranges",
    "Replayed",
    "Surveyed",
    "diagnose",
    "read_firings",
    "read_log",
    "replay",
    "survey",
]


def _column(name: str, values: ArrayLike, dtype: type[_Number]) -> NDArray[_Number]:
    """Make an array with one dimension of what may be a list, an array or a data frame's column."""
    import numpy as np

    try:
        # A non-number makes one that is refused when it is looked at.
        with np.errstate(invalid="ignore"):
            column = np.asarray(values).astype(dtype, order="C")
    except (TypeError, ValueError, OverflowError):
        raise ArgumentError(f"{name} = {values!r:.60}; expected numbers, one for each firing") from None
    if column.ndim != 1:
        raise ArgumentError(f"{name} has the shape {column.shape}; expected one number for each firing")
    return column


class _Columns:
    _columns: tuple[str, ...] = ()

    def columns(self) -> dict[str, NDArray[np.float64 | np.int64 | np.int8 | np.bool_]]:
        """Return the columns by their names.

        Example:
            >>> import eeruf
            >>> log = eeruf.logs.Firings.of(sensor=[0, 1], fired_us=[0, 500], period=[0, 0], phase=[0, 0], t_echo_us=[7000.0, 8000.0])
            >>> log.columns()["t_echo_us"].tolist()
            [7000.0, 8000.0]

        """
        return {name: getattr(self, name) for name in self._columns}

    def to_pandas(self) -> _pd.DataFrame:
        """Make a pandas data frame, a row for each reading.

        Example:
            >>> import eeruf
            >>> log = eeruf.logs.Firings.of(sensor=[0, 1], fired_us=[0, 500], period=[0, 0], phase=[0, 0], t_echo_us=[7000.0, 8000.0])
            >>> log.to_pandas()["sensor"].tolist()
            [0, 1]

        """
        import pandas as pd

        return pd.DataFrame(self.columns())

    def to_polars(self) -> _pl.DataFrame:
        """Make a polars data frame, a row for each reading.

        Example:
            >>> import eeruf
            >>> log = eeruf.logs.Firings.of(sensor=[0, 1], fired_us=[0, 500], period=[0, 0], phase=[0, 0], t_echo_us=[7000.0, 8000.0])
            >>> log.to_polars()["sensor"].to_list()
            [0, 1]

        """
        import polars as pl

        return pl.DataFrame(self.columns())

    def __len__(self) -> int:
        return len(getattr(self, self._columns[0]))


@dataclass(frozen=True, eq=False)
class Ranges(_Columns):
    """The ranges of a log: arrays of equal length, in the order in which they were recorded.

    ``sensor`` counts through ``names`` (also ``topics`` and ``frames``), ``at_ns`` is the header's time in nanoseconds, and -1
    where there is none. ``range_m`` is ``inf`` without an echo and ``-inf`` for too close, as in REP 117. ``variance`` is NaN where the
    message has none. ``damage`` says what could not be read, ``skipped`` which topics were left out, and why. ``form`` is the form
    of the file, ``guesses`` are triples of what was guessed, the guess, and the options of ``eeruf logs`` that override it;
    ``warnings`` name values that seem wrong. ``firing`` is how the sensors fire, by the times: ``at once``, ``in turn``,
    ``constant lags``, ``alternating``, ``hopping``, ``flow`` or ``unknown``; ``proves`` says what agreement proves for it.

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

    _columns = ("sensor", "at_ns", "range_m", "min_range_m", "max_range_m", "variance")

    def echo_us(self, *, speed_of_sound: float = 343.2) -> NDArray[np.float64]:
        """Return the times from firing to echo in microseconds; NaN without an echo, and for too close.

        Args:
            speed_of_sound: in m/s, above 0.

        Raises:
            ArgumentError: no such speed.

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
            raise ArgumentError(f"speed_of_sound = {speed_of_sound!r:.60}; expected a number above 0")
        seen = np.isfinite(self.range_m) & (self.range_m < self.max_range_m) & (self.range_m >= self.min_range_m)
        return np.where(seen, 2e6 * np.where(seen, self.range_m, 0.0) / speed_of_sound, np.nan)


@dataclass(frozen=True, eq=False)
class Firings(_Columns):
    """A ring's log of firings: arrays of equal length.

    ``t_echo_us`` is the raw time from firing to the first edge, NaN without one; ``rejected`` is 1 if the ring rejected the reading,
    0 if not, -1 if the log does not say; ``sends`` is false where a sensor only listened. ``clock`` names the clock of ``fired_us``,
    ``damage`` says what of the file could not be read.

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
        """Make a log of arrays, as of ``sim.Readings`` or of a data frame's columns.

        Args:
            sensor: the sensor, from 0.
            fired_us: when it fired, in microseconds of one clock.
            period: the period, from 0.
            phase: the phase, from 0.
            t_echo_us: from firing to the first edge, NaN without one.
            rejected: 1 if the ring rejected the reading, 0 if not, -1 if that is not known.
            sends: false where a sensor only listened.

        Raises:
            ArgumentError: a column that is no array of such numbers with one dimension.

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
    firing ``sender`` is whose sound its reading is, -1 where that is not sure, ``travel_us`` how long it travelled, ``sure`` how sure
    that is. ``faults`` are ``("deaf", [sensor])``, ``("losing", [sensor])``, ``("chattering", [sensor])``, ``("late", [sensor])`` and
    ``("swapped", [one, other])``. Sensors in ``silent`` hear nothing, those in ``missing`` miss echoes at random, and the log cannot
    tell why. ``moved`` is true if the robot moved; then no loss or chatter is named, and a path is a line of a second, of
    which ``paths["rate_us_s"]`` is the slope.
    ``most_offsets`` is at how many offsets two firings stand to each other at most; below about five nothing can be named.

    Example:
        >>> import eeruf
        >>> log = eeruf.logs.Firings.of(sensor=[0], fired_us=[0], period=[0], phase=[0], t_echo_us=[7000.0])
        >>> eeruf.diagnose(log).faults
        []

    """

    paths: dict[str, NDArray[np.float64 | np.int64 | np.bool_]]
    sender: NDArray[np.int64]
    travel_us: NDArray[np.float64]
    sure: NDArray[np.float64]
    faults: list[tuple[str, list[int]]]
    silent: list[int]
    missing: list[int]
    moved: bool
    most_offsets: int


@dataclass(frozen=True, eq=False)
class Replayed(_Columns):
    """A hopping ring's tracker over each firing of the ring's log: arrays of equal length, by time of firing.

    ``kind`` is an index into ``eeruf.KINDS``, as is ``logged``, what the log says that the ring made of it (-1 where it does not
    say). ``age`` is how many firings of the sensor ago a reading was last accepted, -1 if none was. ``damage`` says what of the file
    could not be read.

    Example:
        >>> import eeruf, pathlib, tempfile
        >>> file = pathlib.Path(tempfile.mkdtemp()) / "log.csv"
        >>> head = "sensor,fired_us,period,phase,t_echo_us,reading,solo,steady,changes"
        >>> rows = [f"0,{60_000 * n},{n},{n},7000,,0,1,0" for n in range(6)]
        >>> size = file.write_text(chr(10).join([head, *rows]))
        >>> eeruf.replay(file).age.tolist()
        [-1, 0, 0, 0, 0, 0]

    """

    sensor: NDArray[np.int64]
    fired_us: NDArray[np.int64]
    period: NDArray[np.int64]
    phase: NDArray[np.int64]
    t_echo_us: NDArray[np.float64]
    kind: NDArray[np.int8]
    age: NDArray[np.int64]
    logged: NDArray[np.int8]
    damage: str | None

    _columns = ("sensor", "fired_us", "period", "phase", "t_echo_us", "kind", "age", "logged")


@dataclass(frozen=True, eq=False)
class Surveyed:
    """The result of a measuring run.

    ``paths`` as in :class:`Diagnosis`; ``conflicts`` are ``(x, y, us)``: pairs that hear each other in time, and the longest such
    travel time. ``[(x, y) for x, y, _ in conflicts]`` is a ``layout`` for :func:`eeruf.design`.

    Example:
        >>> import eeruf
        >>> log = eeruf.logs.Firings.of(sensor=[0], fired_us=[0], period=[0], phase=[0], t_echo_us=[7000.0])
        >>> eeruf.survey(log).conflicts
        []

    """

    paths: dict[str, NDArray[np.float64 | np.int64 | np.bool_]]
    conflicts: list[tuple[int, int, float]]


def read_log(
    path: str | os.PathLike[str],
    *,
    time: str | None = None,
    time_unit: Literal["s", "ms", "us", "ns"] | None = None,
    ranges: Iterable[str] = (),
    range_unit: Literal["m", "cm", "mm", "in", "ft", "us"] | None = None,
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

    Whatever is not given is guessed, and ``guesses`` lists it. Of a damaged file what can be read is, and ``damage`` says what
    cannot. ``topics``, ``fields`` and ``judged`` are for bags, all other arguments for text.

    Args:
        path: the log.
        time: the column with the time.
        time_unit: its unit.
        ranges: the columns with ranges; if none is given, each column of numbers whose name does not say otherwise.
        range_unit: their unit; ``us`` are microseconds from firing to echo.
        sensor: the column that says whose reading a row is.
        speed_of_sound: in m/s, for ranges in ``us``.
        no_echo_m: from this range on there was no echo.
        no_echo: values that mean no echo, as they stand in the log; by default ``0``, numbers below 0, and a repeated ceiling.
        columns: the names of the columns in their order, in place of a header; ``-`` leaves one out.
        topics: the topics to read, whatever their type.
        fields: triples of topic, field and unit, as ``("/sonars", "distance_mm[]", "mm")``.
        judged: also read what a filter made of another topic, ``TOPIC/accepted`` and ``TOPIC/confirmed``.

    Raises:
        LogError: the log cannot be read, or holds no sensor.
        ArgumentError: an argument is wrong.

    Example:
        >>> import eeruf, pathlib, tempfile
        >>> file = pathlib.Path(tempfile.mkdtemp()) / "log.csv"
        >>> size = file.write_text(chr(10).join(["t,left,right", "0.00,1.20,", "0.06,1.21,2.50"]))
        >>> log = eeruf.read_log(file, time="t")
        >>> log.names, log.range_m.tolist()
        (['left', 'right'], [1.2, inf, 1.21, 2.5])

    """
    found = _eeruf._read_log(
        path,
        time,
        time_unit,
        ranges,
        range_unit,
        sensor,
        speed_of_sound,
        no_echo_m,
        no_echo,
        columns,
        topics,
        fields,
        judged,
    )
    return Ranges(**found)


def read_firings(path: str | os.PathLike[str]) -> Firings:
    """Read a ring's log of firings, CSV or MCAP; docs/how-to/diagnose.md has the format.

    Args:
        path: the log.

    Raises:
        LogError: the log cannot be read.
        ArgumentError: an argument is wrong.

    Example:
        >>> import eeruf, pathlib, tempfile
        >>> file = pathlib.Path(tempfile.mkdtemp()) / "log.csv"
        >>> lines = ["# clock: board", "sensor,fired_us,period,phase,t_echo_us", "0,15000,0,0,5872"]
        >>> size = file.write_text(chr(10).join(lines))
        >>> log = eeruf.read_firings(file)
        >>> log.clock, log.t_echo_us.tolist()
        ('board', [5872.0])

    """
    return Firings(**_eeruf._read_firings(path))


def replay(
    path: str | os.PathLike[str],
    t_delta_us: int | None = None,
    *,
    settings: _eeruf.HoppingSettings | str = "balanced",
) -> Replayed:
    """Run the tracker of a hopping ring again over the ring's own log of firings.

    With the settings of the ring, it accepts exactly what the ring accepted. The log says how each reading was weighed, as one that
    ``eeruf study --method eeruf_hopping --log`` writes does; docs/how-to/diagnose.md has the columns.

    Args:
        path: the log, CSV or MCAP.
        t_delta_us: another ``T_delta`` than that of the settings.
        settings: a :class:`HoppingSettings`, or the name of one.

    Raises:
        LogError: the log cannot be read, or does not say how readings were weighed.
        HoppingError: settings that contradict each other.
        ArgumentError: an argument is wrong.

    Example:
        >>> import eeruf, pathlib, tempfile
        >>> file = pathlib.Path(tempfile.mkdtemp()) / "log.csv"
        >>> head = "sensor,fired_us,period,phase,t_echo_us,reading,solo,steady,changes"
        >>> rows = [f"0,{60_000 * n},{n},{n},7000,,0,1,0" for n in range(6)]
        >>> size = file.write_text(chr(10).join([head, *rows]))
        >>> [eeruf.KINDS[kind] for kind in eeruf.replay(file).kind]
        ['first', 'tentative', 'tentative', 'tentative', 'accepted', 'accepted']

    """
    return Replayed(**_eeruf._replay(path, t_delta_us, settings))


def _firings(log: Firings | str | os.PathLike[str]) -> Firings:
    if isinstance(log, Firings):
        return log
    if isinstance(log, (str, os.PathLike)):
        return read_firings(log)
    raise ArgumentError(f"log = {log!r:.60}; expected an eeruf.logs.Firings or the path of a log")


def diagnose(
    log: Firings | str | os.PathLike[str], *, tolerance_us: int = 75, max_travel_us: int = 80_000
) -> Diagnosis:
    """Say from a log of firings which sensors fool each other, whose sound each reading is, and what is broken.

    Args:
        log: a file, or firings.
        tolerance_us: largest difference of a reading from what a path predicts, about four times the jitter.
        max_travel_us: for how long sound is followed.

    Raises:
        LogError: the log cannot be read.
        ArgumentError: an argument is wrong.

    Example:
        >>> import eeruf, numpy as np
        >>> from eeruf import sim
        >>> scene = sim.Scene.from_toml(eeruf.example("scenes/alcove.toml"))
        >>> r = sim.simulate(scene, "eeruf_hopping", periods=300)
        >>> log = eeruf.logs.Firings.of(
        ...     sensor=r.sensor, fired_us=np.rint(1e6 * r.fired_s), period=r.period, phase=r.phase, t_echo_us=r.earliest_us
        ... )
        >>> bool((eeruf.diagnose(log).sender >= 0).mean() > 0.3)
        True

    """
    return Diagnosis(**_eeruf._diagnose(_firings(log), tolerance_us=tolerance_us, max_travel_us=max_travel_us))


def survey(log: Firings | str | os.PathLike[str], *, tolerance_us: int = 100, until_us: int = 15_000) -> Surveyed:
    """Say from a measuring run who hears whom; docs/how-to/survey.md says how to make one.

    Args:
        log: a file, or firings.
        tolerance_us: largest difference between edges of one path, about four times the jitter.
        until_us: pairs that hear each other within this time are conflicts.

    Raises:
        LogError: the log cannot be read.
        ArgumentError: an argument is wrong.

    Example:
        >>> import eeruf
        >>> alone = eeruf.logs.Firings.of(
        ...     sensor=[0] * 9, fired_us=range(0, 900_000, 100_000), period=range(9), phase=[0] * 9, t_echo_us=[7000.0] * 9
        ... )
        >>> eeruf.survey(alone).paths["travel_us"].tolist()
        [7000.0]

    """
    return Surveyed(**_eeruf._survey(_firings(log), tolerance_us=tolerance_us, until_us=until_us))

"""Fire all ultrasonic sensors of a ring at once per period, and reject each other's echoes.

EERUF (J. Borenstein and Y. Koren, IEEE T-RA 11(1), 1995) lets every sensor wait a little before it fires, by one of two waits
that alternate and differ from sensor to sensor. A true echo is unaffected; crosstalk moves, and is rejected.

Times are whole microseconds (``_us``), lengths metres, angles radians. Sensors count from 0. What is wrong with an argument raises
an :class:`EerufError`, which is a ``ValueError``, with the name, the value and what is expected. ``KINDS`` are the kinds of readings,
of which arrays hold the indices. ``EXAMPLES`` are the scenes, rings and the checker that come along, see
:func:`example`.

Example:
    >>> import eeruf
    >>> found = eeruf.design(sensors=12, t_delta_us=999, min_interval_us=15_000, window_us=36_000)
    >>> found.value_us, found.proven
    (68000, True)
    >>> found.schedule.verify(t_delta_us=999, min_interval_us=15_000, window_us=36_000).ok
    True

"""

from __future__ import annotations

from eeruf import nav, sim, tables
from eeruf._eeruf import (
    EXAMPLES,
    KINDS,
    Adaptation,
    ArgumentError,
    CertificateError,
    EchoFilter,
    EerufError,
    EerufWarning,
    ExperimentError,
    FilterError,
    Fire,
    LogError,
    Needs,
    PathsError,
    PeriodEnded,
    Reading,
    Ring,
    RingError,
    SceneError,
    Schedule,
    ScheduleError,
    SearchError,
    SensorWatch,
    SimulationError,
    WaitSearch,
    WaitTables,
    __version__,
    check_certificate,
    curve,
    design,
    example,
    fit,
)

# Checkers take it for true, as the one of typing, which would cost more to import than all of eeruf.
TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing_extensions import TypeGuard

    from eeruf import experiments, logs, plot
    from eeruf._eeruf import _Kind
    from eeruf._records import Blind, Found, Report, State, Violation
    from eeruf.logs import check, diagnose, read_firings, read_log, replay, survey

__all__ = [
    "EXAMPLES",
    "KINDS",
    "Adaptation",
    "ArgumentError",
    "Blind",
    "CertificateError",
    "EchoFilter",
    "EerufError",
    "EerufWarning",
    "ExperimentError",
    "FilterError",
    "Fire",
    "Found",
    "LogError",
    "Needs",
    "PathsError",
    "PeriodEnded",
    "Reading",
    "Report",
    "Ring",
    "RingError",
    "SceneError",
    "Schedule",
    "ScheduleError",
    "SearchError",
    "SensorWatch",
    "SimulationError",
    "State",
    "Violation",
    "WaitSearch",
    "WaitTables",
    "__version__",
    "check",
    "check_certificate",
    "curve",
    "design",
    "diagnose",
    "example",
    "experiments",
    "fit",
    "is_kind",
    "logs",
    "nav",
    "plot",
    "read_firings",
    "read_log",
    "replay",
    "show_versions",
    "sim",
    "survey",
    "tables",
]


def is_kind(name: str) -> TypeGuard[_Kind]:
    """Return true for a kind of readings, so that a type checker takes it for one.

    Args:
        name: a text from elsewhere, such as a log.

    Example:
        >>> import eeruf
        >>> eeruf.is_kind("accepted"), eeruf.is_kind("acepted")
        (True, False)

    """
    return name in KINDS


def show_versions() -> None:
    """Print the versions of eeruf, Python and the packages that eeruf may use, for a report of a fault.

    Example:
        >>> import eeruf
        >>> eeruf.show_versions()  # doctest: +ELLIPSIS
        eeruf ...

    """
    import platform
    from importlib import metadata

    print("eeruf", __version__)
    print("python", platform.python_version(), platform.platform())
    for name in ("numpy", "matplotlib", "pandas", "polars", "pyarrow", "tqdm"):
        try:
            print(name, metadata.version(name))
        except metadata.PackageNotFoundError:
            print(name, "is not installed")


if not TYPE_CHECKING:
    # On first use: a program without them need not wait for them, or for what they import.
    _MODULES = ("experiments", "logs", "plot")
    _FROM = dict.fromkeys(
        ("check", "diagnose", "read_firings", "read_log", "replay", "survey"), "eeruf.logs"
    ) | dict.fromkeys(("Blind", "Found", "Report", "State", "Violation"), "eeruf._records")

    # What there was, and what does it now.
    _GONE = dict.fromkeys(
        ("EchoTracker", "HoppingFound", "HoppingSchedule", "HoppingSettings", "TrackerSettings"), "Ring.flow"
    ) | {"HoppingError": "RingError"}

    def __getattr__(name: str) -> object:
        from importlib import import_module

        if name in _MODULES:
            return import_module(f"eeruf.{name}")
        if name in _FROM:
            globals()[name] = found = getattr(import_module(_FROM[name]), name)
            return found
        if name in _GONE:
            raise AttributeError(f"eeruf.{name} is gone; eeruf.{_GONE[name]} does it")
        if name == "sweep":
            raise AttributeError("eeruf.sweep is gone; docs/how-to/cluster.md has what does it")
        raise AttributeError(f"module 'eeruf' has no attribute {name!r}")

    def __dir__() -> list[str]:
        return sorted({*globals(), *__all__})

"""Fire all ultrasonic sensors of a ring at once per period, and reject each other's echoes.

EERUF (J. Borenstein and Y. Koren, IEEE T-RA 11(1), 1995) lets every sensor wait a little before it fires, by one of two waits
that alternate and differ from sensor to sensor. A true echo is unaffected; crosstalk moves, and is rejected.

Times are whole microseconds (``_us``), lengths metres, angles radians. Sensors count from 0. A wrong argument raises
an :class:`EerufError`, which is a ``ValueError``, with the name, the value and what is expected. ``KINDS`` are the kinds of readings;
arrays hold indices into it. :mod:`eeruf.typing` has the types of results, for annotations.

Example:
    >>> import eeruf
    >>> found = eeruf.design(sensors=12, t_delta_us=999, min_interval_us=15_000, window_us=36_000)
    >>> found.value_us, found.proven
    (68000, True)
    >>> found.schedule.verify(t_delta_us=999, min_interval_us=15_000, window_us=36_000).ok
    True

"""

from __future__ import annotations

from eeruf import nav as nav, sim as sim, tables as tables
from eeruf._eeruf import (
    KINDS,
    Adaptation,
    CertificateError,
    EchoFilter,
    EerufError,
    EerufWarning,
    Fire,
    LogError,
    Needs,
    PeriodEnded,
    Reading,
    Ring,
    Schedule,
    SensorWatch,
    WaitSearch,
    __version__ as __version__,
    check_certificate,
    curve,
    design,
    example,
    fit,
)

# Type checkers take it for true, like that of typing, whose import would take longer than all of eeruf.
TYPE_CHECKING = False
if TYPE_CHECKING:
    from eeruf import experiments as experiments, logs as logs, plot as plot, typing as typing
    from eeruf._records import Found, Report, State
    from eeruf.logs import check, read_log

__all__ = [
    "KINDS",
    "Adaptation",
    "CertificateError",
    "EchoFilter",
    "EerufError",
    "EerufWarning",
    "Fire",
    "Found",
    "LogError",
    "Needs",
    "PeriodEnded",
    "Reading",
    "Report",
    "Ring",
    "Schedule",
    "SensorWatch",
    "State",
    "WaitSearch",
    "check",
    "check_certificate",
    "curve",
    "design",
    "example",
    "fit",
    "read_log",
    "show_versions",
]


def show_versions() -> None:
    """Print the versions of eeruf, Python and the packages that eeruf may use, for a bug report.

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
    # Imported on first use: other programs need not wait for these modules and their imports.
    _MODULES = ("experiments", "logs", "plot", "typing")
    _FROM = {"check": "logs", "read_log": "logs", "Found": "_records", "Report": "_records", "State": "_records"}

    # Removed names, and their replacements.
    _GONE = {
        **dict.fromkeys(("EchoTracker", "HoppingSchedule", "HoppingSettings", "TrackerSettings"), "Ring.flow"),
        **{name: f"logs.{name}" for name in ("diagnose", "read_firings", "replay", "survey")},
        **{name: f"typing.{name}" for name in ("Blind", "Violation", "WaitTables", "is_kind")},
        **dict.fromkeys(("ArgumentError", "RingError", "SceneError", "ScheduleError", "SearchError"), "EerufError"),
    }

    def __getattr__(name: str) -> object:
        from importlib import import_module

        if name in _MODULES:
            return import_module(f"eeruf.{name}")
        if name in _FROM:
            globals()[name] = found = getattr(import_module(f"eeruf.{_FROM[name]}"), name)
            return found
        if name in _GONE:
            raise AttributeError(f"eeruf.{name} is gone; eeruf.{_GONE[name]} does it")
        if name == "sweep":
            raise AttributeError("eeruf.sweep is gone; docs/how-to/cluster.md has what does it")
        raise AttributeError(f"module 'eeruf' has no attribute {name!r}")

    def __dir__() -> list[str]:
        return sorted({*globals(), *__all__, *_MODULES})

"""Readings as data frames and as files."""

from __future__ import annotations

from typing import IO, TYPE_CHECKING, Any

import numpy as np

from eeruf import _eeruf

if TYPE_CHECKING:
    from os import PathLike

    from numpy.typing import NDArray

    from eeruf._types import HeardPaths

_CODES = {"kind": _eeruf.KINDS, "cause": _eeruf.CAUSES}
# The format number at the beginning of a file, by which other versions can reject it.
_FORMAT = 2


def to_pandas(columns: dict[str, NDArray[Any]]) -> Any:
    """Make a data frame with names for codes."""
    import pandas as pd

    def converted(name: str, column: NDArray[Any]) -> Any:
        if name in _CODES:
            return pd.Categorical.from_codes(column, categories=list(_CODES[name]))  # type: ignore[arg-type]
        if name == "path":
            return pd.arrays.IntegerArray(column.copy(), column < 0)
        return column

    return pd.DataFrame({name: converted(name, column) for name, column in columns.items()})


def to_polars(columns: dict[str, NDArray[Any]]) -> Any:
    """Make a data frame with names for codes and nulls for missing values."""
    import polars as pl

    def converted(name: str, column: NDArray[Any]) -> Any:
        series = pl.Series(name, column)
        if name in _CODES:
            names = pl.Enum(_CODES[name])
            return pl.Series(name, _CODES[name], dtype=names)[series.cast(pl.UInt32)]
        if name == "path":
            return series.set(series < 0, None)
        return series.fill_nan(None) if column.dtype.kind == "f" else series

    return pl.DataFrame([converted(name, column) for name, column in columns.items()])


def to_xarray(columns: dict[str, NDArray[Any]], about: tuple[str, float, int]) -> Any:
    """Make a data set along one dimension."""
    import xarray as xr

    attributes = dict(zip(("method", "duration_s", "sensors"), about))
    return xr.Dataset({name: ("reading", column) for name, column in columns.items()}, attrs=attributes)


# The columns of readings, with their types and default values.
_DEFAULTS: dict[str, tuple[str, float]] = {
    "robot": ("int64", 0),
    "sensor": ("int64", 0),
    "period": ("int64", 0),
    "phase": ("int64", 0),
    "fired_s": ("float64", 0),
    "x_m": ("float64", 0),
    "y_m": ("float64", 0),
    "heading_rad": ("float64", 0),
    "kind": ("int8", 0),
    "t_echo_us": ("float64", 0),
    "earliest_us": ("float64", 0),
    "reference_us": ("float64", 0),
    "cause": ("int8", 0),
    "path": ("int64", -1),
    "emitted_s": ("float64", np.nan),
    "expected_change_us": ("int32", 0),
}


def from_arrays(
    sensor: Any,
    fired_s: Any,
    t_echo_us: Any,
    kind: Any,
    reference_us: Any,
    duration_s: float | None,
    sensors: int | None,
    method: str | None,
    columns: dict[str, Any] | None,
) -> _eeruf.Readings:
    """Make readings from arrays, with defaults for missing ones."""
    given: dict[str, Any] = {"sensor": sensor, "fired_s": fired_s, "t_echo_us": t_echo_us}
    given.update({name: value for name, value in (("kind", kind), ("reference_us", reference_us)) if value is not None})
    for name, value in (columns or {}).items():
        if name not in _DEFAULTS:
            raise _eeruf.EerufError(f"no column {name}; expected one of {', '.join(_DEFAULTS)}")
        given[name] = value
    arrays: dict[str, NDArray[Any]] = {}
    for name, value in given.items():
        dtype = _DEFAULTS[name][0]
        expected = f"an array of {dtype} with an entry for each reading"
        try:
            array = np.asarray(value)
            with np.errstate(invalid="ignore"):
                # An int8 from wider whole numbers is checked below.
                arrays[name] = array.astype(dtype, casting="unsafe" if dtype == "int8" else "same_kind")
        except (TypeError, ValueError) as error:
            raise _eeruf.EerufError(f"{name} = {value!r:.60}; expected {expected}") from error
        if arrays[name].shape != arrays["sensor"].shape or array.ndim != 1:
            raise _eeruf.EerufError(f"shape of {name} = {array.shape}; expected {arrays['sensor'].shape}")
        if dtype == "int8" and not np.array_equal(array, arrays[name]):
            raise _eeruf.EerufError(f"{name} = {value!r:.60}; expected {expected}")
    count, echoes = len(arrays["sensor"]), arrays["t_echo_us"]
    clear, accepted = _eeruf.KINDS.index("clear"), _eeruf.KINDS.index("accepted")
    arrays.setdefault("kind", np.where(np.isnan(echoes), clear, accepted).astype("int8"))
    arrays.setdefault("cause", np.where(np.isnan(echoes), 0, 1).astype("int8"))
    arrays.setdefault("earliest_us", echoes)
    arrays.setdefault("reference_us", echoes)
    for name, (dtype, default) in _DEFAULTS.items():
        arrays.setdefault(name, np.full(count, default, dtype=dtype))
    if (arrays["path"] >= 0).any():
        raise _eeruf.EerufError("path = an index; expected -1, since these readings have no paths")
    if duration_s is None:
        duration_s = float(arrays["fired_s"].max()) if count else 0.0
    if sensors is None:
        sensors = int(arrays["sensor"].max()) + 1 if count else 0
    none: dict[str, Any] = {name: np.empty(0, dtype="int64") for name in _PATHS_INT}
    none.update({name: np.empty(0) for name in _PATHS_FLOAT}, walls=[])
    return _eeruf._readings_from_columns(method or "eeruf", duration_s, sensors, arrays, none)


_PATHS_INT = ("emitter_robot", "emitter", "receiver_robot", "receiver", "order")
_PATHS_FLOAT = ("length_m", "departure_rad", "arrival_rad")


def save(
    file: str | PathLike[str] | IO[bytes],
    about: tuple[str, float, int],
    columns: dict[str, NDArray[Any]],
    paths: HeardPaths,
) -> None:
    """Write the parts of readings into one file."""
    walls = paths["walls"]
    method, duration_s, sensors = about
    parts: dict[str, Any] = {
        "format": _FORMAT,
        "method": method,
        "duration_s": duration_s,
        "sensors": sensors,
        **columns,
    }
    parts.update({f"paths.{name}": column for name, column in paths.items() if name != "walls"})
    parts["paths.wall_counts"] = np.array([len(wall) for wall in walls], dtype=np.int64)
    parts["paths.walls"] = np.array([bounce for wall in walls for bounce in wall], dtype=np.int64)
    try:
        np.savez_compressed(file, **parts)
    except (AttributeError, TypeError, ValueError) as error:
        raise _eeruf.EerufError(f"file = {file!r:.60}; expected a path, or a file that takes bytes") from error


def load(file: str | PathLike[str] | IO[bytes]) -> _eeruf.Readings:
    """Read a file that ``save`` wrote."""
    try:
        return _loaded(file)
    except (_eeruf.EerufError, OSError, MemoryError):
        raise
    except Exception as error:
        # A damaged file raises errors of several kinds, from NumPy, zipfile and zlib.
        raise _eeruf.EerufError(
            f"file = {file!r:.60}; expected what Readings.save wrote, in its format {_FORMAT}"
        ) from error


def _loaded(file: str | PathLike[str] | IO[bytes]) -> _eeruf.Readings:
    """Read a file that ``save`` wrote, or raise an error of any kind."""
    with np.load(file, allow_pickle=False) as parts:
        arrays = {name: parts[name] for name in parts.files}
    if int(arrays.pop("format")) != _FORMAT:
        raise ValueError("of another format")
    method, duration_s, sensors = (arrays.pop(name) for name in ("method", "duration_s", "sensors"))
    paths: dict[str, Any] = {name[6:]: arrays.pop(name) for name in list(arrays) if name.startswith("paths.")}
    counts, walls = paths.pop("wall_counts"), paths["walls"]
    paths["walls"] = [tuple(walls[end - count : end].tolist()) for end, count in zip(np.cumsum(counts), counts)]
    return _eeruf._readings_from_columns(str(method), float(duration_s), int(sensors), arrays, paths)

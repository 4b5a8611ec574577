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
# What a file begins with, so that another version can say that it does not know it.
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
    """Make a data frame with names for codes and nulls for what has no value."""
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
        raise _eeruf.ArgumentError(f"file = {file!r:.60}; expected a path, or a file that takes bytes") from error


def load(file: str | PathLike[str] | IO[bytes]) -> _eeruf.Readings:
    """Read what ``save`` wrote."""
    try:
        return _loaded(file)
    except (_eeruf.EerufError, OSError, MemoryError):
        raise
    except Exception as error:
        # Of the kinds that a damaged file ends in, NumPy, zipfile and zlib name some.
        raise _eeruf.ArgumentError(
            f"file = {file!r:.60}; expected what Readings.save wrote, in its format {_FORMAT}"
        ) from error


def _loaded(file: str | PathLike[str] | IO[bytes]) -> _eeruf.Readings:
    """Read what ``save`` wrote, or end in an error of any kind."""
    with np.load(file, allow_pickle=False) as parts:
        arrays = {name: parts[name] for name in parts.files}
    if int(arrays.pop("format")) != _FORMAT:
        raise ValueError("of another format")
    method, duration_s, sensors = (arrays.pop(name) for name in ("method", "duration_s", "sensors"))
    paths: dict[str, Any] = {name[6:]: arrays.pop(name) for name in list(arrays) if name.startswith("paths.")}
    counts, walls = paths.pop("wall_counts"), paths["walls"]
    paths["walls"] = [tuple(walls[end - count : end].tolist()) for end, count in zip(np.cumsum(counts), counts)]
    return _eeruf._readings_from_columns(str(method), float(duration_s), int(sensors), arrays, paths)

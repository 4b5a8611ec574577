"""Readings as data frames and as files."""

from __future__ import annotations

import zipfile
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
    np.savez_compressed(file, **parts)


def load(file: str | PathLike[str] | IO[bytes]) -> _eeruf.Readings:
    """Read what ``save`` wrote."""

    def refuse() -> _eeruf.ArgumentError:
        return _eeruf.ArgumentError(f"file = {file!r:.60}; expected what Readings.save wrote, in its format {_FORMAT}")

    try:
        loaded = np.load(file, allow_pickle=False)
        if not isinstance(loaded, np.lib.npyio.NpzFile):
            raise refuse()
        with loaded as parts:
            if int(parts["format"]) != _FORMAT:
                raise refuse()
            arrays = {name: parts[name] for name in parts.files}
    except (KeyError, ValueError, TypeError, zipfile.BadZipFile) as error:
        raise error if isinstance(error, _eeruf.EerufError) else refuse() from error
    about = [arrays.pop(name, None) for name in ("format", "method", "duration_s", "sensors")]
    paths: dict[str, Any] = {name[6:]: arrays.pop(name) for name in list(arrays) if name.startswith("paths.")}
    counts, walls = paths.pop("wall_counts", None), paths.get("walls")
    if any(part is None for part in (*about, counts, walls)):
        raise refuse()
    ends = np.cumsum(counts)
    paths["walls"] = [tuple(walls[end - count : end].tolist()) for end, count in zip(ends, counts)]  # type: ignore[index]
    try:
        return _eeruf._readings_from_columns(str(about[1]), float(about[2]), int(about[3]), arrays, paths)  # type: ignore[arg-type]
    except KeyError as error:
        raise refuse() from error

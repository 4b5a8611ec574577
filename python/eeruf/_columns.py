"""Columns of logs, and tables made from them."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar, TypeVar

from eeruf._eeruf import EerufError

if TYPE_CHECKING:
    import numpy as np
    import pandas as _pd
    import polars as _pl
    from numpy.typing import ArrayLike, NDArray

    _Number = TypeVar("_Number", bound=np.generic)


def column(name: str, values: ArrayLike, dtype: type[_Number]) -> NDArray[_Number]:
    """Make an array with one dimension from a list, an array or a data frame's column."""
    import numpy as np

    try:
        # The conversion of invalid values does not warn; a later check of the numbers refuses them.
        with np.errstate(invalid="ignore"):
            found = np.asarray(values).astype(dtype, order="C")
    except (TypeError, ValueError, OverflowError):
        raise EerufError(f"{name} = {values!r:.60}; expected numbers, one for each firing") from None
    if found.ndim != 1:
        raise EerufError(f"{name} has the shape {found.shape}; expected one number for each firing")
    return found


class Columns:
    """A table whose columns are attributes."""

    _columns: ClassVar[tuple[str, ...]] = ()

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

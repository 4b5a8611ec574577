"""The paper's tables: twelve sensors in groups of four, a period of 100 ms.

Example:
    >>> from eeruf import tables
    >>> tables.TABLE_I_D.verify(t_delta_us=999, min_interval_us=15_000).ok
    True

"""

from __future__ import annotations

from eeruf._eeruf import Schedule

# Type checkers take it for true, as in eeruf itself.
TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Final

_LAGS: Final = (0, 25_000, 50_000, 75_000) * 3
_A: Final = (24_000,) * 12


def _ms(*waits: int) -> tuple[int, ...]:
    return tuple(1000 * wait for wait in waits)


TABLE_I_A: Final = Schedule(100_000, _LAGS, (0,) * 12, (0,) * 12)
"""Lags alone: the conventional method."""

TABLE_I_B: Final = Schedule(100_000, _LAGS, _A, _ms(0, 2, 4, 6, 8, 10, 12, 14, 16, 18, 20, 22))
"""Waits in plain order, which let neighbours fire 1 ms apart."""

TABLE_I_C: Final = TABLE_I_B
"""The firing times of Table I-b."""

TABLE_I_D: Final = Schedule(100_000, _LAGS, _A, _ms(18, 12, 6, 0, 20, 14, 8, 2, 22, 16, 10, 4))
"""The waits of Table I-c rearranged, so that any four neighbours fire 15 ms apart or more."""

__all__ = ["TABLE_I_A", "TABLE_I_B", "TABLE_I_C", "TABLE_I_D"]

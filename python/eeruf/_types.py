"""What results hold, for type checkers."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypedDict

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


class HeardPaths(TypedDict):
    """Every path that some reading came along, as :attr:`Readings.paths` has them."""

    emitter_robot: NDArray[np.int64]
    emitter: NDArray[np.int64]
    receiver_robot: NDArray[np.int64]
    receiver: NDArray[np.int64]
    order: NDArray[np.int64]
    length_m: NDArray[np.float64]
    departure_rad: NDArray[np.float64]
    arrival_rad: NDArray[np.float64]
    walls: list[tuple[int, ...]]


class Age(TypedDict):
    """How old a sensor's last accepted reading is, in milliseconds."""

    median: float
    p99: float


class Summary(TypedDict):
    """The figures of :meth:`Readings.summary`; shares are fractions of 1."""

    method: str
    readings: int
    accepted: int
    wrong_of_all: float
    crosstalk_of_all: float
    wrong_of_accepted: float | None
    rejected: float
    good_lost: float | None
    wrong_before_filter: float
    age_ms: Age
    readings_per_s: float
    starved: int
    blind: int
    starved_in_part: int

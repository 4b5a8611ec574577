"""Types of what results hold."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypedDict

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import ArrayLike, NDArray


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


class FlowSettings(TypedDict, total=False):
    """Settings of the method ``flow`` that differ from its default, as :class:`eeruf.sim.Method` takes it."""

    step_us: int
    shortest_gap_us: int
    masked_adds_us: int
    believed_takes_us: int
    unserved_adds_us: int
    unserved_after: int
    shortest_cycle_us: int
    rest_us: int
    lead_us: int
    longest_cycle_us: int
    travel_us: int


class ReadingColumns(TypedDict, total=False):
    """The other columns that :meth:`eeruf.sim.Readings.from_arrays` takes."""

    robot: ArrayLike
    period: ArrayLike
    phase: ArrayLike
    x_m: ArrayLike
    y_m: ArrayLike
    heading_rad: ArrayLike
    earliest_us: ArrayLike
    cause: ArrayLike
    path: ArrayLike
    emitted_s: ArrayLike
    expected_change_us: ArrayLike

"""Types of the contents of results."""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal, TypedDict

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import ArrayLike, NDArray


class HeardPaths(TypedDict):
    """The paths of all readings, as in :attr:`Readings.paths`."""

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
    """Settings of :meth:`eeruf.Ring.flow`, and of the method ``flow``, that differ from the default."""

    least_us: int
    most_us: int
    rest_us: int
    dice_us: int
    seed: int
    t_delta_us: int
    near_us: int
    path_change_us: int
    memory: int
    hold: int
    top_speed_m_s: float
    alone: bool
    votes: Literal["by_motion", "two_in_a_row", "every_echo"]


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

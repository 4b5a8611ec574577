"""Rooms and robots: every critical path, and the ring in simulated time.

``METHODS`` are the firing methods that :func:`simulate` knows, ``EERUF_METHODS`` the paper's among them and what
follows from it; ``CAUSES`` is what ``Readings.cause`` counts through.
"""

from __future__ import annotations

from eeruf._eeruf import (
    CAUSES,
    EERUF_METHODS,
    METHODS,
    Batch,
    BatchState,
    FiredReading,
    Material,
    Method,
    Noise,
    Paths,
    ReadingBlocks,
    Readings,
    Robot,
    Scene,
    Simulation,
    read_map,
    simulate,
    simulate_blocks,
)

# As in eeruf itself.
TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing_extensions import TypeGuard

    from eeruf._eeruf import _MethodName
    from eeruf._records import RobotState
    from eeruf._summary import Summary
else:

    def __getattr__(name: str) -> object:
        # On first use: what makes its like is most of what importing eeruf would cost.
        if name in ("RobotState", "Summary"):
            from eeruf import _records, _summary

            return getattr(_records if name == "RobotState" else _summary, name)
        raise AttributeError(f"module 'eeruf.sim' has no attribute {name!r}")


def is_method(name: str) -> TypeGuard[_MethodName]:
    """Return true for a name that methods have, so that a type checker takes it for one.

    Args:
        name: a text from elsewhere, such as a command line.

    Example:
        >>> from eeruf import sim
        >>> sim.is_method("eeruf"), sim.is_method("eruf")
        (True, False)

    """
    return name in METHODS


__all__ = [
    "CAUSES",
    "EERUF_METHODS",
    "METHODS",
    "Batch",
    "BatchState",
    "FiredReading",
    "Material",
    "Method",
    "Noise",
    "Paths",
    "ReadingBlocks",
    "Readings",
    "Robot",
    "RobotState",
    "Scene",
    "Simulation",
    "Summary",
    "is_method",
    "read_map",
    "simulate",
    "simulate_blocks",
]

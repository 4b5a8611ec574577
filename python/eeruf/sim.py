"""Rooms and robots: every critical path, and the ring in simulated time.

``METHODS`` are the firing methods that :func:`simulate` knows, ``EERUF_METHODS`` the paper's among them and what
follows from it; ``CAUSES`` is what ``Readings.cause`` counts through.
"""

from __future__ import annotations

from eeruf._eeruf import (
    CAUSES,
    EERUF_METHODS,
    METHODS,
    FiredReading,
    Material,
    Method,
    Noise,
    Paths,
    ReadingBlocks,
    Readings,
    Robot,
    RobotState,
    Scene,
    Simulation,
    read_map,
    simulate,
    simulate_blocks,
)

# As in eeruf itself.
TYPE_CHECKING = False
if TYPE_CHECKING:
    from eeruf._results import Summary
else:

    def __getattr__(name: str) -> object:
        # On first use: what makes its like is most of what importing eeruf would cost.
        if name == "Summary":
            from eeruf._results import Summary

            return Summary
        raise AttributeError(f"module 'eeruf.sim' has no attribute {name!r}")


__all__ = [
    "CAUSES",
    "EERUF_METHODS",
    "METHODS",
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
    "read_map",
    "simulate",
    "simulate_blocks",
]

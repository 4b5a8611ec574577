"""Rooms and robots: every critical path, and the ring in simulated time.

``METHODS`` are the firing methods that :func:`simulate` knows, ``EERUF_METHODS`` the paper's among them and what
follows from it; ``CAUSES`` is what ``Readings.cause`` counts through.
"""

from eeruf._eeruf import (
    CAUSES,
    EERUF_METHODS,
    METHODS,
    Material,
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

__all__ = [
    "CAUSES",
    "EERUF_METHODS",
    "METHODS",
    "Material",
    "Noise",
    "Paths",
    "ReadingBlocks",
    "Readings",
    "Robot",
    "RobotState",
    "Scene",
    "Simulation",
    "read_map",
    "simulate",
    "simulate_blocks",
]

"""Rooms and robots: every critical path, and the ring in simulated time.

``METHODS`` are the firing methods that :func:`simulate` knows; ``eeruf.typing.CAUSES`` is what ``Readings.cause`` counts through.
"""

from __future__ import annotations

from eeruf._eeruf import (
    METHODS,
    Batch,
    Material,
    Method,
    Noise,
    Readings,
    Robot,
    Scene,
    Simulation,
    simulate,
    simulate_blocks,
)

__all__ = [
    "METHODS",
    "Batch",
    "Material",
    "Method",
    "Noise",
    "Readings",
    "Robot",
    "Scene",
    "Simulation",
    "simulate",
    "simulate_blocks",
]

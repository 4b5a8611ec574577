"""Rooms and robots: every critical path, and the ring in simulated time.

``METHODS`` are the firing methods that :func:`simulate` knows; ``Readings.cause`` indexes ``eeruf.typing.CAUSES``.
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

"""Rooms and robots: every critical path, and the ring in simulated time.

``METHODS`` are the firing methods that :func:`simulate` knows; ``CAUSES`` is what ``Readings.cause`` counts through.
"""

from eeruf._eeruf import CAUSES, METHODS, Paths, Readings, Robot, Scene, simulate

__all__ = ["CAUSES", "METHODS", "Paths", "Readings", "Robot", "Scene", "simulate"]

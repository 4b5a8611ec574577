"""Rooms and robots: every critical path, and the ring in simulated time."""

from eeruf._eeruf import CAUSES, METHODS, Paths, Readings, Robot, Scene, simulate

__all__ = ["CAUSES", "METHODS", "Paths", "Readings", "Robot", "Scene", "simulate"]

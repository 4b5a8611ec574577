"""Functions by which pickles make things again."""

from __future__ import annotations

from typing import Any

from eeruf import _eeruf


def scene(arguments: dict[str, Any]) -> _eeruf.Scene:
    """Make a scene of keyword arguments."""
    return _eeruf.Scene(**arguments)


def robot(arguments: dict[str, Any]) -> _eeruf.Robot:
    """Make a robot of keyword arguments."""
    return _eeruf.Robot(**arguments)


def method(arguments: dict[str, Any]) -> _eeruf.Method:
    """Make a method of keyword arguments."""
    return _eeruf.Method(**arguments)


def simulation(scene: _eeruf.Scene, method: Any, seed: int | None, done: list[tuple[Any, ...]]) -> _eeruf.Simulation:
    """Make a simulation and do again what was done."""
    world = _eeruf.Simulation(scene, method, seed=seed)
    for name, *arguments in done:
        getattr(world, name)(*arguments)
    return world


def noise(fading_db_rms: float, jitter_us_rms: float, bursts_per_s: float, burst_db: float) -> _eeruf.Noise:
    """Make noise of its numbers."""
    return _eeruf.Noise(
        fading_db_rms=fading_db_rms, jitter_us_rms=jitter_us_rms, bursts_per_s=bursts_per_s, burst_db=burst_db
    )

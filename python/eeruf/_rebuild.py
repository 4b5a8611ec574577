"""Functions that recreate objects from pickles."""

from __future__ import annotations

from typing import Any

from eeruf import _eeruf


def made(kind: type[Any], arguments: dict[str, Any]) -> object:
    """Make an object from keyword arguments."""
    return kind(**arguments)


def simulation(scene: _eeruf.Scene, method: Any, seed: int | None, done: list[tuple[Any, ...]]) -> _eeruf.Simulation:
    """Make a simulation and repeat the calls on it."""
    world = _eeruf.Simulation(scene, method, seed=seed)
    for name, *arguments in done:
        getattr(world, name)(*arguments)
    return world

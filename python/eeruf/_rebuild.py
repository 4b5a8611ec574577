"""Functions by which pickles make things again."""

from __future__ import annotations

from typing import Any

from eeruf import _eeruf


def made(kind: type[Any], arguments: dict[str, Any]) -> object:
    """Make an object of keyword arguments."""
    return kind(**arguments)


def simulation(scene: _eeruf.Scene, method: Any, seed: int | None, done: list[tuple[Any, ...]]) -> _eeruf.Simulation:
    """Make a simulation and do again what was done."""
    world = _eeruf.Simulation(scene, method, seed=seed)
    for name, *arguments in done:
        getattr(world, name)(*arguments)
    return world

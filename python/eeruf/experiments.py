"""The paper's experiments (Sec. 4)."""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import Any, Callable

from eeruf import _eeruf

__all__ = ["set_one"]


def set_one(
    seeds: int = 200,
    *,
    readings: int = 8000,
    methods: Sequence[str] | None = None,
    progress: bool | Callable[[float | None, str], Any] | None = None,
) -> dict[str, Any]:
    """Set I: eight sensors before three walls at right angles, by every method, in many random alcoves.

    Args:
        seeds: how many alcoves, 1 or more.
        readings: about how many readings of each alcove and method.
        methods: names of ``eeruf.sim.METHODS``; all by default.
        progress: True for a bar (tqdm if it is installed), or a callable that takes the share done and a text.

    Returns:
        What ``eeruf experiment set-one --json`` prints: ``{"methods": {NAME: {FIGURE: {"p10", "median", "p90"}}}}``. Shares are
        fractions of 1. The result does not depend on the number of threads.

    Raises:
        ArgumentError: a number is out of range, or there is no such method.
        ExperimentError: there are no methods.

    Example:
        >>> import eeruf
        >>> table = eeruf.experiments.set_one(seeds=2, readings=800, methods=["conventional", "eeruf"])
        >>> wrong = {name: method["wrong_of_all"]["median"] for name, method in table["methods"].items()}
        >>> wrong["eeruf"] < 0.1 < wrong["conventional"]
        True

    """
    chosen = None if methods is None else list(methods)
    table: dict[str, Any] = json.loads(_eeruf._set_one(seeds, readings, chosen, progress))
    return table

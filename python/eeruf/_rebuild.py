"""What pickles name to make things again."""

from __future__ import annotations

from typing import Any

from eeruf import _eeruf


def scene(made_of: dict[str, Any] | str, text: str | None = None) -> _eeruf.Scene:
    """Make a scene of keyword arguments, or of a file's name and text."""
    if text is not None:
        return _eeruf._scene_from_text(made_of, text)
    assert isinstance(made_of, dict)
    return _eeruf.Scene(**made_of)


def robot(
    pose: tuple[float, float, float],
    sensors: int,
    spacing_rad: float,
    radius_m: float,
    transducer: str,
    period_us: int,
    t_delta_us: int,
    window_us: int,
    schedule: _eeruf.Schedule | None,
    consecutive: int,
    patience: int,
) -> _eeruf.Robot:
    """Make a robot of what it was made of."""
    return _eeruf.Robot(
        pose,
        sensors,
        spacing_rad,
        radius_m,
        transducer,
        period_us=period_us,
        t_delta_us=t_delta_us,
        window_us=window_us,
        schedule=schedule,
        consecutive=consecutive,
        patience=patience,
    )

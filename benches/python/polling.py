#!/usr/bin/env python3
"""Compare sixteen sonars in four rooms with polling, the usual way of robots with two arrays: each array fires one sensor after
another, 40 ms apart. Prints right echoes per second as a multiple of polling's, the share of foreign sound among believed echoes,
and the number of blind sensors, for the median place and for the worst.

    cargo xtask python                          # makes target/python, with the wheel in it
    target/python/bin/python benches/python/polling.py [--places 15] [--first 20261125]
"""

from __future__ import annotations

import argparse
from typing import Any

import eeruf
import numpy as np
from eeruf import sim

# Front and rear left, then their mirror images, as in rings/round-16.toml: x and y in metres, heading in degrees.
FRONT = [(0.069, 0.136, 90), (0.114, 0.119, 50), (0.148, 0.078, 30), (0.166, 0.027, 10)]
REAR = [(-0.157, -0.136, -90), (-0.203, -0.119, -130), (-0.237, -0.078, -150), (-0.255, -0.027, -170)]
WAYS: list[Any] = ["polling", "sequential", "eeruf", "flow"]
CROSSTALK = eeruf.typing.CAUSES.index("crosstalk")


def mirrored(array: list[tuple[float, float, int]]) -> list[tuple[float, float, int]]:
    return [(x, -y, -angle) for x, y, angle in reversed(array)]


SENSORS = [(x, y, np.deg2rad(angle)) for x, y, angle in FRONT + mirrored(FRONT) + REAR + mirrored(REAR)]


def box(x: float, y: float, width: float, height: float, inside: bool = False) -> list[list[float]]:
    """Return the walls of a room, seen from inside, or of a cupboard."""
    corners = [(x, y), (x + width, y), (x + width, y + height), (x, y + height)]
    corners = corners if inside else corners[::-1]
    return [[*here, *there] for here, there in zip(corners, corners[1:] + corners[:1])]


CUPBOARDS = box(0.6, 0.6, 0.8, 1.6) + box(3.5, 6.0, 1.8, 0.8) + box(7.6, 2.5, 0.8, 1.6) + box(5.2, 0.5, 0.8, 0.8)
# Walls, and where the robot may stand; in metres.
ROOMS = {
    "corridor 16 x 1.8": (box(-8, -0.9, 16, 1.8, inside=True), (-4, -0.45, 4, 0.45)),
    "office 5 x 4": (box(0, 0, 5, 4, inside=True), (1, 1, 4, 3)),
    "hall 9 x 7": (box(0, 0, 9, 7, inside=True), (2, 2, 7, 5)),
    "with cupboards": (box(0, 0, 9, 7, inside=True) + CUPBOARDS, (2, 2.4, 7, 5)),
}


def polling(_period: int) -> tuple[int, list[tuple[int, int]], int]:
    return 320_000, sorted((40_000 * place, sensor) for place in range(8) for sensor in (place, 8 + place)), 0


def figures(way: Any, scene: sim.Scene, period_us: int) -> tuple[float, float, int]:
    """Return right echoes per second, the foreign share of believed echoes, and blind sensors, right in under 5 % of firings."""
    if way == "polling":
        got = sim.Simulation(scene, "conventional", firing=polling).step(20.0)
    else:
        got = sim.simulate(scene, way, periods=int(20e6 / period_us))
    echo, right = np.isfinite(got.t_echo_us), got.is_accepted & ~got.is_wrong()
    believed = got.is_accepted & echo
    foreign = (believed & (got.cause == CROSSTALK)).sum() / max(1, believed.sum())
    blind = sum(right[got.sensor == sensor].mean() < 0.05 for sensor in range(len(SENSORS)))
    return (right & echo).sum() / got.duration_s, float(foreign), blind


def main() -> None:
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("--places", type=int, default=15)
    options.add_argument("--first", type=int, default=20_261_125, help="seed of the places")
    asked = options.parse_args()
    needs: dict[str, Any] = {"t_delta_us": 500, "min_interval_us": 12_000, "window_us": 36_000}
    design = eeruf.design(sensors=16, layout="ring", neighbours=4, **needs)
    assert design.value_us is not None
    for gain in ("constant", "polaroid_6500"):
        print(
            f"\nGain `{gain}`: times polling's right echoes / foreign, % / blind of 16. Then the worst place: foreign, % / blind."
        )
        middle: dict[str, list[str]] = {way: [] for way in WAYS}
        worst: dict[str, list[str]] = {way: [] for way in WAYS}
        for walls, (left, low, right, high) in ROOMS.values():
            drawn, found = np.random.default_rng(asked.first), {way: np.zeros((asked.places, 3)) for way in WAYS}
            for place in range(asked.places):
                # Every other place is square to the walls.
                turned = drawn.uniform(-np.pi, np.pi) if place % 2 else place // 2 % 4 * np.pi / 2
                pose = (drawn.uniform(left, right), drawn.uniform(low, high), turned)
                for way in WAYS:
                    schedule = design.schedule if way == "eeruf" else None
                    robot = sim.Robot(
                        pose,
                        sensors=SENSORS,
                        gain=gain,
                        window_us=36_000,
                        t_delta_us=500,
                        period_us=design.value_us,
                        schedule=schedule,
                    )
                    scene = sim.Scene(walls, robots=[robot], max_order=5, seed=place, height="room")
                    found[way][place] = figures(way, scene, design.value_us)
            for way in WAYS:
                echoes, foreign, blind = np.median(found[way], axis=0)
                times = echoes / np.median(found["polling"][:, 0])
                middle[way].append(f"{times:.2f} / {100 * foreign:.1f} / {blind:.0f}")
                _, foreign, blind = found[way].max(axis=0)
                worst[way].append(f"{100 * foreign:.1f} / {blind:.0f}")
        for rows in (middle, worst):
            print("\n| way | " + " | ".join(ROOMS) + " |\n|---" + "|---" * len(ROOMS) + "|")
            for way in WAYS:
                print(f"| {way} | " + " | ".join(rows[way]) + " |")


if __name__ == "__main__":
    main()

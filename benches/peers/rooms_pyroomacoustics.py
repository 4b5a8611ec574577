#!/usr/bin/env python3
"""Compares paths of rooms with floor and ceiling with pyroomacoustics 0.10.1 in three dimensions, in one run.

    python3 -m venv VENV && VENV/bin/pip install pyroomacoustics==0.10.1 . && VENV/bin/python benches/peers/rooms_pyroomacoustics.py

200 boxes, corridors and L-shaped rooms, order 3, two receivers each: counts, lengths, and the time of the peer's
`image_source_model` relative to `Scene.paths`. Its core has single precision.
"""

from __future__ import annotations

import os
import time

for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ[name] = "1"

import numpy as np  # noqa: E402
import pyroomacoustics as pra  # noqa: E402
from eeruf import sim  # noqa: E402

ORDER = 3
ROOMS = 200
# Points keep this far from the lines on which corners lie, in metres.
MARGIN_M = 0.03


def corners_of(kind: int, rng: np.random.Generator) -> list[tuple[float, float]]:
    """Return the corners of a box, a corridor or an L, counter-clockwise."""
    if kind == 1:
        x, y = rng.uniform(1.2, 2.4), rng.uniform(6.0, 15.0)
    else:
        x, y = rng.uniform(2.0 + kind / 2, 7.0, 2)
    if kind < 2:
        return [(0, 0), (x, 0), (x, y), (0, y)]
    u, v = rng.uniform(0.3, 0.7) * x, rng.uniform(0.3, 0.7) * y
    return [(0, 0), (x, 0), (x, v), (u, v), (u, y), (0, y)]


def is_inside(point: tuple[float, float], corners: list[tuple[float, float]]) -> bool:
    """Return true if a point is in a polygon and away from the lines of its corners."""
    inside = False
    for (x1, y1), (x2, y2) in zip(corners, [*corners[1:], corners[0]]):
        if min(abs(point[0] - x1), abs(point[1] - y1)) < MARGIN_M:
            return False
        if (y1 > point[1]) != (y2 > point[1]) and point[0] < (x2 - x1) * (point[1] - y1) / (y2 - y1) + x1:
            inside = not inside
    return inside


def main() -> None:
    """Compare, and print one line."""
    rng = np.random.default_rng(1)
    paths = differing = 0
    worst_m = ours_s = peer_s = 0.0
    for number in range(ROOMS):
        corners = corners_of(number % 3, rng)
        ceiling_m = rng.uniform(2.2, 3.5)
        most = np.max(corners, axis=0)
        points: list[tuple[float, float, float]] = []
        while len(points) < 3:
            point = (float(rng.uniform(0, most[0])), float(rng.uniform(0, most[1])))
            if is_inside(point, corners):
                points.append((*point, float(rng.uniform(0.1, ceiling_m - 0.1))))
        walls = [[*start, *end] for start, end in zip(corners, [*corners[1:], corners[0]])]
        height = {"ceiling_m": ceiling_m, "floor": "perfect", "ceiling": "perfect"}
        scene = sim.Scene(walls, materials="perfect", physics="plain", height=height)
        begun = time.perf_counter()
        ours = scene.paths(points[0], points[1:], ORDER)
        ours_s += time.perf_counter() - begun
        room = pra.Room.from_corners(np.array(corners).T, max_order=ORDER, materials=pra.Material(0.0))
        room.extrude(ceiling_m, materials=pra.Material(0.0))
        room.add_source(points[0]).add_microphone_array(np.array(points[1:]).T)
        begun = time.perf_counter()
        room.image_source_model()
        peer_s += time.perf_counter() - begun
        for receiver in range(2):
            seen = room.visibility[0][receiver].astype(bool)
            far = np.linalg.norm(room.sources[0].images.T - np.array(points[1 + receiver]), axis=1)
            theirs, mine = np.sort(far[seen]), np.sort(ours.length_m[ours.receiver == receiver])
            paths += len(mine)
            if len(theirs) == len(mine):
                worst_m = max(worst_m, float(np.abs(theirs - mine).max()))
            else:
                differing += 1
                print(f"room {number}, receiver {receiver}: {len(mine)} paths here, {len(theirs)} there")
    print(f"{ROOMS} rooms, {paths} paths: {differing} of {2 * ROOMS} pairs differ in number; ", end="")
    print(f"the others by {worst_m:.1e} m at most; the peer takes {peer_s / ours_s:.1f} times as long")


main()

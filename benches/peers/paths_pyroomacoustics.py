#!/usr/bin/env python3
"""Times eeruf-sim's path finder against pyroomacoustics 0.10.1, both single thread, in one run.

    python3 -m venv VENV && VENV/bin/pip install pyroomacoustics==0.10.1
    cargo build --release -p eeruf-lab
    VENV/bin/python benches/peers/paths_pyroomacoustics.py

Core against core: pyroomacoustics' compiled `image_source_model` of one source with eight receivers against the images that
`Tracer::sight` finds. The whole answer of `Tracer::trace` (sorted, with wall sequences, angles and amplitudes, which the
peer's core does not give) is printed beside it. The path sets are compared as well: counts per scene and lengths.
Both programs can handle only rooms of one closed polygon.
"""

import argparse
import json
import os
import pathlib
import subprocess
import time

for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ[name] = "1"

import numpy as np  # noqa: E402
import pyroomacoustics as pra  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parents[2]
SCENES = [("rect4x3", 6, 10), ("lshape", 6, 50), ("alcove_t", 6, 150), ("star12", 6, 1500), ("star40", 4, 15000)]


def peer(case, order):
    """Best time of the peer's core in seconds, and the lengths per receiver that it finds."""
    corners = np.array([wall[:2] for wall in case["walls"]], dtype=float).T
    room = pra.Room.from_corners(corners, fs=16000, max_order=order, materials=pra.Material(0.1), air_absorption=False)
    room.add_microphone_array(np.array(case["receivers"], dtype=float).T)
    source = np.array(case["source"], dtype=float)
    room.add_source(source)
    engine = room.room_engine
    single = source.astype(np.float32)
    best, spent, runs = float("inf"), 0.0, 0
    while runs < 3 or (spent < 0.5 and runs < 2000):
        start = time.perf_counter()
        engine.image_source_model(single)
        took = time.perf_counter() - start
        best, spent, runs = min(best, took), spent + took, runs + 1
    images = np.array(engine.sources, dtype=float)
    visible = np.array(engine.visible_mics, dtype=bool)
    assert len(visible) == len(case["receivers"]), "each microphone once"
    receivers = np.array(case["receivers"], dtype=float)
    lengths = [np.sort(np.linalg.norm(images[:, seen].T - at, axis=1)) for at, seen in zip(receivers, visible)]
    return best, lengths


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--ours", default=ROOT / "target/release/eeruf-lab", help="the built lab")
    options = parser.parse_args()
    corpus = {case["id"]: case for case in json.loads((ROOT / "tests/data/critical-paths.json").read_text())["cases"]}
    ours = json.loads(subprocess.run([options.ours, "time-paths"], check=True, capture_output=True, text=True).stdout)
    print(
        f"pyroomacoustics {pra.__version__} against eeruf-sim, one source, 8 receivers, single thread, best of many runs"
    )
    print(
        f"{'scene':<10} {'order':>5} {'paths':>6} {'peer':>12} {'core':>10} {'ratio':>9} {'target':>7} {'whole':>10} {'ratio':>9}  lengths"
    )
    for scene, order, target in SCENES:
        seconds, lengths = peer(corpus[scene], order)
        truth = [sorted(p[0] for p in paths if p[1] <= order) for paths in corpus[scene]["paths"]]
        agree = all(len(a) == len(b) for a, b in zip(truth, lengths))
        worst = max(np.abs(np.array(a) - b).max() for a, b in zip(truth, lengths)) if agree else float("nan")
        mine = ours[f"{scene}@{order}"]
        core, whole = mine["core_us"] * 1e-6, mine["whole_us"] * 1e-6
        print(
            f"{scene:<10} {order:>5} {mine['paths']:>6} {seconds * 1e3:>9.3f} ms {core * 1e6:>7.1f} us {seconds / core:>8.0f}x"
            f" {target:>6}x {whole * 1e6:>7.1f} us {seconds / whole:>8.0f}x  {'same sets, worst %.1e m' % worst if agree else 'SETS DIFFER'}"
        )


if __name__ == "__main__":
    main()
